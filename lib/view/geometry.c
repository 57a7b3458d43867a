#include "geometry.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/layout.h"
#include "../record/quaternion.h"
#include "../scene/mesh.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "../wire/messages.h"

#define M_PER_MM 1e-3

/* Room for a written name: each byte becomes at most three. */
#define WRITTEN_SIZE (3 * WH_NAME_SIZE)

wh_view_colour_t wh_view_colour(uint32_t hex, float opacity) {
    return (wh_view_colour_t){{(float)(hex >> 16 & 0xffU) / 255, (float)(hex >> 8 & 0xffU) / 255,
                               (float)(hex & 0xffU) / 255, opacity}};
}

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

/* The index of a point; a new point is added. A hull's faces share their corners. */
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

/* Draws the box around a mesh. The mesh's middle may differ from its shape's origin, so the pose moves. */
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

/* ----------------------------------------------------------------------------------------------- bodies */

/* The length of the character at `text` if it may stay unchanged; 0 if the viewer would read it as part of
 * a path, or could not read it. */
static size_t plain_bytes(const char *text) {
    const unsigned char first = (unsigned char)*text;
    if (first < ' ' || first == 0x7f || first == '/' || first == ':' || first == '%') {
        return 0;
    }
    return wh_utf8_bytes(text);
}

/* Writes other characters as %2F and so on. '%' is one of them, so two names never become equal. */
static void write_name(const char *name, char *written) {
    static const char digits[] = "0123456789ABCDEF";
    while (*name != '\0') {
        const size_t plain = plain_bytes(name);
        const char coded[3] = {'%', digits[(unsigned char)*name >> 4U], digits[(unsigned char)*name & 15U]};
        const size_t size = plain > 0 ? plain : sizeof coded;
        memcpy(written, plain > 0 ? name : coded, size);
        written += size;
        name += plain > 0 ? plain : 1;
    }
    *written = '\0';
}

static char *path_of(const char *folder, const char *name) {
    char written[WRITTEN_SIZE] = "";
    if (name) {
        write_name(name, written);
    }
    char *path = NULL;
    if (asprintf(&path, "%s%s%s", folder, name ? "::" : "", written) < 0) {
        wh_memory_out();
    }
    return path;
}

size_t wh_view_bodies_add(wh_view_bodies_t *bodies, const char *folder, const char *name) {
    waferhand_viewer_load *load = &bodies->load;
    load->link = wh_array_grow(load->link, (size_t)load->num_links, &bodies->capacity, sizeof *load->link);
    load->link[load->num_links] = (waferhand_viewer_link){.name = path_of(folder, name)};
    return (size_t)load->num_links++;
}

waferhand_viewer_geometry *wh_view_bodies_add_shape(wh_view_bodies_t *bodies) {
    waferhand_viewer_link *body = &bodies->load.link[bodies->load.num_links - 1];
    /* The message's type has no member for a capacity, so the array counts as full. */
    size_t capacity = (size_t)body->num_geom;
    body->geom = wh_array_grow(body->geom, capacity, &capacity, sizeof *body->geom);
    return memset(&body->geom[body->num_geom++], 0, sizeof *body->geom);
}

void wh_view_bodies_place(wh_view_bodies_t *bodies, size_t body, const wh_pose_t *base_from_body) {
    wh_view_put_pose(base_from_body, bodies->draw.position[body], bodies->draw.quaternion[body]);
}

void wh_view_bodies_open(wh_view_bodies_t *bodies) {
    const size_t count = (size_t)bodies->load.num_links;
    const wh_pose_t here = wh_pose_identity();
    waferhand_viewer_draw *draw = &bodies->draw;
    draw->num_links = bodies->load.num_links;
    draw->link_name = wh_array_new(count, sizeof *draw->link_name);
    draw->robot_num = wh_array_new(count, sizeof *draw->robot_num);
    draw->position = wh_array_new(count, sizeof *draw->position);
    draw->quaternion = wh_array_new(count, sizeof *draw->quaternion);
    bodies->places = wh_array_new(count, sizeof *bodies->places);
    for (size_t i = 0; i < count; ++i) {
        draw->link_name[i] = bodies->load.link[i].name;
        draw->position[i] = bodies->places[i];
        draw->quaternion[i] = bodies->places[i] + 3;
        wh_view_bodies_place(bodies, i, &here);
    }
}

void wh_view_bodies_free(wh_view_bodies_t *bodies) {
    for (int32_t i = 0; i < bodies->load.num_links; ++i) {
        waferhand_viewer_link *body = &bodies->load.link[i];
        for (int32_t k = 0; k < body->num_geom; ++k) {
            wh_view_geometry_free(&body->geom[k]);
        }
        free(body->geom);
        free(body->name);
    }
    free(bodies->load.link);
    free(bodies->draw.link_name);
    free(bodies->draw.robot_num);
    free(bodies->draw.position);
    free(bodies->draw.quaternion);
    free(bodies->places);
}
