#include "geometry.h"

#include <stdlib.h>
#include <string.h>

#include "../link/messages.h"
#include "../record/quaternion.h"
#include "../text/array.h"
#include "mesh.h"

#define M_PER_MM 1e-3

void wh_view_put_pose(const wh_pose_t *pose, float position[3], float quaternion[4]) {
    double q[4];
    wh_quaternion_from_matrix(&pose->R, NULL, q);
    position[0] = (float)(pose->r.x * M_PER_MM);
    position[1] = (float)(pose->r.y * M_PER_MM);
    position[2] = (float)(pose->r.z * M_PER_MM);
    quaternion[0] = (float)q[3];
    quaternion[1] = (float)q[0];
    quaternion[2] = (float)q[1];
    quaternion[3] = (float)q[2];
}

/* `lengths` in mm. */
static void put_lengths(waferhand_viewer_geometry *geometry, int8_t type, const double lengths[],
                        size_t count) {
    geometry->type = type;
    geometry->num_float_data = (int32_t)count;
    geometry->float_data = wh_array_new(count, sizeof *geometry->float_data);
    for (size_t i = 0; i < count; ++i) {
        geometry->float_data[i] = (float)(lengths[i] * M_PER_MM);
    }
}

static void put_box(waferhand_viewer_geometry *geometry, const wh_vec3_t *edges) {
    const double lengths[] = {edges->x, edges->y, edges->z};
    put_lengths(geometry, WH_VIEW_BOX, lengths, 3);
}

static void put_round(waferhand_viewer_geometry *geometry, int8_t type, const wh_vec3_t *half) {
    const double lengths[] = {half->x, 2 * half->z};
    put_lengths(geometry, type, lengths, type == WH_VIEW_SPHERE ? 1 : 2);
}

/* -------------------------------------------------------------------------------------------------- hulls */

/* The index of a point, which is added if it is new. A hull's faces share their corners. */
static size_t index_of(float (*points)[3], size_t *count, const float at[3]) {
    for (size_t i = 0; i < *count; ++i) {
        if (points[i][0] == at[0] && points[i][1] == at[1] && points[i][2] == at[2]) {
            return i;
        }
    }
    memcpy(points[*count], at, sizeof points[0]);
    return (*count)++;
}

/* The message has the numbers of points and triangles, the points, and the triangles' corners. */
static void put_triangles(waferhand_viewer_geometry *geometry, const wh_mesh_t *mesh) {
    float(*points)[3] = wh_array_new(mesh->vertex_count, sizeof *points);
    float *corners = wh_array_new(mesh->index_count, sizeof *corners);
    const size_t triangles = mesh->index_count / 3;
    size_t count = 0;
    for (size_t i = 0; i < mesh->index_count; ++i) {
        corners[i] = (float)index_of(points, &count, mesh->vertices[mesh->indices[i]]);
    }
    geometry->type = WH_VIEW_TRIANGLES;
    geometry->num_float_data = (int32_t)(2 + 3 * count + mesh->index_count);
    geometry->float_data = wh_array_new((size_t)geometry->num_float_data, sizeof *geometry->float_data);
    geometry->float_data[0] = (float)count;
    geometry->float_data[1] = (float)triangles;
    for (size_t i = 0; i < 3 * count; ++i) {
        geometry->float_data[2 + i] = (float)((double)points[i / 3][i % 3] * M_PER_MM);
    }
    memcpy(geometry->float_data + 2 + 3 * count, corners, mesh->index_count * sizeof *corners);
    free(points);
    free(corners);
}

/* Draws the box around a mesh. The mesh need not lie around its shape's origin, so the pose moves. */
static void put_bounds(waferhand_viewer_geometry *geometry, const wh_convex_t *convex, wh_pose_t *pose) {
    const wh_pose_t here = wh_pose_identity();
    wh_vec3_t low, high;
    wh_convex_bounds(convex, &here, &low, &high);
    const wh_vec3_t edges = wh_vec3_subtract(&high, &low);
    const wh_vec3_t sum = wh_vec3_add(&high, &low);
    const wh_vec3_t middle = wh_vec3_scale(0.5, &sum);
    pose->r = wh_pose_point(pose, &middle);
    put_box(geometry, &edges);
}

static void put_hull(waferhand_viewer_geometry *geometry, const wh_convex_t *convex, bool as_box,
                     wh_pose_t *pose) {
    const wh_pose_t here = wh_pose_identity();
    wh_mesh_t mesh = {0};
    if (!as_box) {
        wh_mesh_add_hull(&mesh, convex, &here);
    }
    if (mesh.index_count > 0) {
        put_triangles(geometry, &mesh);
    } else {
        put_bounds(geometry, convex, pose);
    }
    wh_mesh_free(&mesh);
}

/* ------------------------------------------------------------------------------------------------- shapes */

void wh_view_geometry_make(const wh_convex_t *convex, const wh_pose_t *body_from_shape,
                           const wh_view_colour_t *colour, bool as_box, waferhand_viewer_geometry *geometry) {
    wh_pose_t pose = *body_from_shape;
    const wh_vec3_t edges = wh_vec3_scale(2, &convex->half);
    memset(geometry, 0, sizeof *geometry);
    switch (convex->kind) {
    case WH_CONVEX_BOX:
        put_box(geometry, &edges);
        break;
    case WH_CONVEX_CYLINDER:
        put_round(geometry, WH_VIEW_CYLINDER, &convex->half);
        break;
    case WH_CONVEX_CAPSULE:
        put_round(geometry, (float)(edges.z * M_PER_MM) > 0 ? WH_VIEW_CAPSULE : WH_VIEW_SPHERE,
                  &convex->half);
        break;
    case WH_CONVEX_MESH:
        put_hull(geometry, convex, as_box, &pose);
        break;
    }
    wh_view_put_pose(&pose, geometry->position, geometry->quaternion);
    memcpy(geometry->color, colour->rgba, sizeof geometry->color);
    geometry->string_data = wh_link_borrowed("");
}

void wh_view_geometry_free(waferhand_viewer_geometry *geometry) {
    free(geometry->float_data);
    geometry->float_data = NULL;
}
