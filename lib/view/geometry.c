#include "geometry.h"

#include <stdlib.h>
#include <string.h>

#include "../link/messages.h"
#include "../record/quaternion.h"
#include "../text/array.h"
#include "mesh.h"

#define M_PER_MM 1e-3

/* A hull's points and triangles. The message has one list after the other. */
typedef struct {
    float (*points)[3];
    size_t point_count;
    uint32_t *corners;
    size_t corner_count;
} triangles_t;

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
static uint32_t index_of(triangles_t *triangles, const float at[3]) {
    for (size_t i = 0; i < triangles->point_count; ++i) {
        const float *point = triangles->points[i];
        if (point[0] == at[0] && point[1] == at[1] && point[2] == at[2]) {
            return (uint32_t)i;
        }
    }
    memcpy(triangles->points[triangles->point_count], at, sizeof triangles->points[0]);
    return (uint32_t)triangles->point_count++;
}

static triangles_t triangles_of(const wh_convex_t *convex) {
    const wh_pose_t here = wh_pose_identity();
    wh_mesh_t mesh = {0};
    triangles_t triangles = {0};
    wh_mesh_add_hull(&mesh, convex, &here);
    triangles.points = wh_array_new(mesh.vertex_count, sizeof *triangles.points);
    triangles.corners = wh_array_new(mesh.index_count, sizeof *triangles.corners);
    for (size_t i = 0; i < mesh.index_count; ++i) {
        triangles.corners[triangles.corner_count++] = index_of(&triangles, mesh.vertices[mesh.indices[i]]);
    }
    wh_mesh_free(&mesh);
    return triangles;
}

static void put_triangles(waferhand_viewer_geometry *geometry, const triangles_t *triangles) {
    const size_t count = 2 + 3 * triangles->point_count + triangles->corner_count;
    const size_t triangle_count = triangles->corner_count / 3;
    float *to = wh_array_new(count, sizeof *to);
    geometry->type = WH_VIEW_TRIANGLES;
    geometry->num_float_data = (int32_t)count;
    geometry->float_data = to;
    *to++ = (float)triangles->point_count;
    *to++ = (float)triangle_count;
    for (size_t i = 0; i < triangles->point_count; ++i) {
        for (size_t axis = 0; axis < 3; ++axis) {
            *to++ = (float)((double)triangles->points[i][axis] * M_PER_MM);
        }
    }
    for (size_t i = 0; i < triangles->corner_count; ++i) {
        *to++ = (float)triangles->corners[i];
    }
}

/* Draws the box around a mesh. The mesh need not lie around its shape's origin, so the pose moves. */
static void put_bounds(waferhand_viewer_geometry *geometry, const wh_convex_t *convex, wh_pose_t *pose) {
    const wh_pose_t here = wh_pose_identity();
    wh_vec3_t low, high;
    wh_convex_bounds(convex, &here, &low, &high);
    const wh_vec3_t edges = wh_vec3_subtract(&high, &low);
    const wh_vec3_t sum = wh_vec3_add(&high, &low);
    const wh_vec3_t middle = wh_vec3_scale(0.5, &sum);
    const wh_vec3_t turned = wh_mat3_transform(&pose->R, &middle);
    pose->r = wh_vec3_add(&pose->r, &turned);
    put_box(geometry, &edges);
}

static void put_hull(waferhand_viewer_geometry *geometry, const wh_convex_t *convex, bool as_box,
                     wh_pose_t *pose) {
    triangles_t triangles = {0};
    if (!as_box) {
        triangles = triangles_of(convex);
    }
    if (triangles.corner_count > 0) {
        put_triangles(geometry, &triangles);
    } else {
        put_bounds(geometry, convex, pose);
    }
    free(triangles.points);
    free(triangles.corners);
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
    geometry->color[0] = colour->red;
    geometry->color[1] = colour->green;
    geometry->color[2] = colour->blue;
    geometry->color[3] = colour->opacity;
    geometry->string_data = wh_link_borrowed("");
}

void wh_view_geometry_free(waferhand_viewer_geometry *geometry) {
    free(geometry->float_data);
    geometry->float_data = NULL;
}
