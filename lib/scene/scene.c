#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/arms.h"
#include "../layout/inks.h"
#include "../math/config.h"
#include "../record/quaternion.h"
#include "../text/array.h"
#include "gltf.h"

/* Keyframes under construction. */
typedef struct {
    wh_gltf_key_t *keys;
    size_t count, capacity;
    double last[4]; /* the last quaternion */
} keyframes_t;

/* Indices: grippers, then links, then doors. */
enum { FIRST_LINK = WH_GRIPPERS, FIRST_DOOR = FIRST_LINK + WH_SIGNALS_LINKS, PATHS = FIRST_DOOR + WH_DOORS };

/* A node's meshes, one for each ink, while its parts are collected. */
typedef struct {
    wh_mesh_t inks[WH_INKS];
} body_t;

typedef struct {
    const wh_signals_t *signals;
    const wh_layout_t *layout;
    wh_gltf_t gltf;
    bool animated;
    /* Poses of grippers and links at animated times, with straight lines between them. */
    wh_thin_t paths[PATHS];
    int32_t bodies[WH_SIGNALS_LINKS]; /* bodies of the links */
    size_t link_count;
} scene_t;

/* The initial tolerances, and the number of points beyond which they grow, for grippers and for links. */
#define GRIPPER_MM 0.05
#define GRIPPER_RAD 5e-4
#define GRIPPER_POINTS 60000
#define LINK_MM 0.5
#define LINK_RAD 2e-3
#define LINK_POINTS 30000

static void add_key(keyframes_t *motion, double seconds, const wh_vec3_t *r, const double q[4]) {
    const size_t i = motion->count;
    motion->keys = wh_array_grow(motion->keys, i, &motion->capacity, sizeof *motion->keys);
    /* Times must rise, and two slices may have equal times as floats. */
    if (i > 0 && !((float)seconds > motion->keys[i - 1].time)) {
        return;
    }
    motion->keys[i] = (wh_gltf_key_t){
        (float)seconds,
        {(float)(WH_GLTF_METRES * r->x), (float)(WH_GLTF_METRES * r->y), (float)(WH_GLTF_METRES * r->z)},
        {(float)q[0], (float)q[1], (float)q[2], (float)q[3]}};
    ++motion->count;
}

/* -------------------------------------------------------------------------------------------------- paths */

static void add_places(void *user, int64_t slice) {
    scene_t *scene = user;
    const wh_signals_t *signals = scene->signals;
    wh_pose_t links[WH_SIGNALS_LINKS];
    wh_pose_t gripper;
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        wh_signals_gripper(signals, g, slice, &gripper);
        wh_thin_add_pose(&scene->paths[g], slice, &gripper);
    }
    for (size_t d = 0; d < signals->layout->machine.door_count; ++d) {
        wh_pose_t door;
        wh_signals_door(signals, d, slice, &door);
        wh_thin_add_pose(&scene->paths[FIRST_DOOR + d], slice, &door);
    }
    if (wh_signals_links(signals, slice, links)) {
        for (size_t i = 0; i < scene->link_count; ++i) {
            wh_thin_add_pose(&scene->paths[FIRST_LINK + i], slice, &links[i]);
        }
    }
}

/* Cost: about 1 us for each place of wh_signals_walk. */
static void trace_paths(scene_t *scene) {
    for (size_t i = 0; i < PATHS; ++i) {
        const bool is_link = i >= FIRST_LINK && i < FIRST_DOOR;
        wh_thin_open(&scene->paths[i], 3, is_link ? LINK_MM : GRIPPER_MM, is_link ? LINK_RAD : GRIPPER_RAD,
                     is_link ? LINK_POINTS : GRIPPER_POINTS);
    }
    wh_signals_walk(scene->signals, add_places, scene);
    for (size_t i = 0; i < PATHS; ++i) {
        wh_thin_finish(&scene->paths[i]);
    }
}

/* ---------------------------------------------------------------------------------------------- keyframes */

static double seconds_of(const wh_signals_t *signals, double slice) {
    return slice * (double)signals->layout->slice_us / 1e6;
}

static keyframes_t keyframes_of_track(const wh_signals_t *signals, const wh_thin_t *thin) {
    keyframes_t motion = {0};
    for (size_t i = 0; i < thin->list.count; ++i) {
        const double *values = wh_points_numbers(&thin->list, i);
        const wh_vec3_t r = {values[0], values[1], values[2]};
        add_key(&motion, seconds_of(signals, (double)thin->list.points[i].slice), &r, values + 3);
    }
    return motion;
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void add_pose(keyframes_t *motion, const wh_signals_t *signals, double slice, const wh_pose_t *pose) {
    double q[4];
    wh_quaternion_from_matrix(&pose->R, motion->count > 0 ? motion->last : NULL, q);
    memcpy(motion->last, q, sizeof q);
    add_key(motion, seconds_of(signals, slice), &pose->r, q);
}

/* Adds keys between point `i` of its gripper and the next, at `share` of the way. */
static void add_held(keyframes_t *motion, const wh_signals_t *signals, const wh_stay_t *stay,
                     const wh_thin_t *thin, size_t i, double share) {
    const double *a = wh_points_numbers(&thin->list, i);
    const double *b = wh_points_numbers(&thin->list, i + 1);
    const int64_t from = thin->list.points[i].slice;
    const int64_t to = thin->list.points[i + 1].slice;
    wh_pose_t gripper;
    double q[4];
    gripper.r =
        wh_vec3(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]));
    wh_quaternion_slerp(a + 3, b + 3, share, q);
    wh_quaternion_to_matrix(q, &gripper.R);
    const wh_pose_t pose = wh_pose_compose(&gripper, &stay->pose);
    add_pose(motion, signals, (double)from + share * (double)(to - from), &pose);
}

/* The number of straight lines for a wafer that circles its gripper's origin: the chord of an angle a has
 * an error of r a^2 / 8. */
static int parts_of(const wh_stay_t *stay, const wh_thin_t *thin, size_t i) {
    double turn[3];
    wh_quaternion_turn(wh_points_numbers(&thin->list, i) + 3, wh_points_numbers(&thin->list, i + 1) + 3,
                       turn);
    const double square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    const double off = wh_vec3_norm(&stay->pose.r) * square / 8;
    int parts = 1;
    while ((parts * parts) * thin->list.tolerance < off && parts < 256) {
        ++parts;
    }
    return parts;
}

/* The place of a slice between point `i` of the list and the next, from 0 to 1. */
static double share_of(const wh_points_t *list, size_t i, int64_t slice) {
    const int64_t from = list->points[i].slice;
    const int64_t to = list->points[i + 1].slice;
    const double share = to > from ? (double)(slice - from) / (double)(to - from) : 1;
    return share < 0 ? 0 : share > 1 ? 1 : share;
}

/* Adds keys from the slice of the stay to `end`, also while the gripper stands still long before or
 * after. */
static void add_hold(keyframes_t *motion, const wh_signals_t *signals, const wh_thin_t *thin,
                     const wh_stay_t *stay, int64_t end) {
    const wh_points_t *list = &thin->list;
    for (size_t i = 0; i + 1 < list->count && list->points[i].slice < end; ++i) {
        const int64_t next = list->points[i + 1].slice;
        if (next <= stay->slice) {
            continue;
        }
        const double begin = share_of(list, i, stay->slice);
        const double stop = share_of(list, i, end);
        const int parts = parts_of(stay, thin, i);
        add_held(motion, signals, stay, thin, i, begin);
        for (int part = 1; part < parts; ++part) {
            const double share = (double)part / parts;
            if (share > begin && share < stop) {
                add_held(motion, signals, stay, thin, i, share);
            }
        }
        if (next >= end || i + 2 == list->count) {
            add_held(motion, signals, stay, thin, i, stop);
        }
    }
}

/* A held wafer moves with its gripper, with more keyframes where that turns. */
static keyframes_t keyframes_of_wafer(const scene_t *scene, int32_t wafer) {
    const wh_signals_t *signals = scene->signals;
    keyframes_t motion = {0};
    const wh_stay_t *stay = NULL;
    for (size_t i = 0; i <= signals->stay_count; ++i) {
        const bool over = i == signals->stay_count;
        if (!over && signals->stays[i].wafer != wafer) {
            continue;
        }
        const int64_t end = over ? signals->last : signals->stays[i].slice;
        if (stay && stay->holder != WH_NONE) {
            add_hold(&motion, signals, &scene->paths[stay->holder], stay, end);
        } else if (stay) {
            add_pose(&motion, signals, (double)stay->slice, &stay->pose);
            add_pose(&motion, signals, (double)end, &stay->pose);
        }
        stay = over ? stay : &signals->stays[i];
    }
    return motion;
}

/* -------------------------------------------------------------------------------------------------- nodes */

static bool differ(const float a[], const float b[], size_t count) {
    bool same = true;
    for (size_t i = 0; i < count; ++i) {
        same = same && !(a[i] < b[i]) && !(a[i] > b[i]);
    }
    return !same;
}

static bool rests(const keyframes_t *motion) {
    bool same = true;
    for (size_t i = 1; same && i < motion->count; ++i) {
        same = !differ(motion->keys[i].place, motion->keys->place, 3) &&
               !differ(motion->keys[i].turn, motion->keys->turn, 4);
    }
    return same;
}

/* Moves the node by the keyframes unless it rests; frees them. */
static void move_node(const keyframes_t *motion, wh_gltf_t *gltf, size_t node) {
    if (!rests(motion)) {
        wh_gltf_add_motion(gltf, node, motion->keys, motion->count);
    }
    free(motion->keys);
}

/* -------------------------------------------------------------------------------------------------- parts */

/* Adds all parts of some kinds with this owner. */
static void add_parts(const scene_t *scene, body_t *body, uint32_t kinds, int32_t owner,
                      const wh_pose_t *base_from_body) {
    const wh_world_config_t *world = &scene->layout->world;
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        if ((kinds >> (unsigned)part->kind & 1U) != 0 && part->owner == owner) {
            const wh_pose_t *at = &part->convex.body_from_shape;
            const wh_pose_t pose = base_from_body ? wh_pose_relative(base_from_body, at) : *at;
            wh_mesh_add_convex(&body->inks[wh_ink_of(part)], &part->convex, &pose);
        }
    }
}

/* Adds the collected mesh, frees it, and returns its index; SIZE_MAX if it is empty. */
static size_t finish_body(scene_t *scene, body_t *body, const char *name) {
    wh_gltf_primitive_t primitives[WH_INKS];
    size_t count = 0;
    for (size_t ink = 0; ink < WH_INKS; ++ink) {
        if (body->inks[ink].index_count > 0) {
            primitives[count].mesh = &body->inks[ink];
            primitives[count++].material = ink;
        }
    }
    const size_t mesh = count > 0 ? wh_gltf_add_mesh(&scene->gltf, name, primitives, count) : SIZE_MAX;
    for (size_t ink = 0; ink < WH_INKS; ++ink) {
        wh_mesh_free(&body->inks[ink]);
    }
    return mesh;
}

/* -------------------------------------------------------------------------------------------------- nodes */

static void add_base(scene_t *scene) {
    const wh_pose_t here = wh_pose_identity();
    body_t base = {0};
    if (!scene->layout->machine.carrier) { /* otherwise the column is a link */
        add_parts(scene, &base, 1U << WH_PART_ARM, WH_ARM_BASE, NULL);
    }
    (void)wh_gltf_add_node(&scene->gltf, "base", finish_body(scene, &base, "base"), &here, "base", 0);
}

/* Adds a node for each obstacle, because an obstacle has one part. */
static void add_obstacles(scene_t *scene) {
    const wh_world_config_t *world = &scene->layout->world;
    const wh_pose_t here = wh_pose_identity();
    size_t index = 0;
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        if (part->kind == WH_PART_FIXED && part->owner == WH_NONE) {
            const char *name = wh_layout_part_name(scene->layout, (int32_t)i);
            body_t body = {0};
            wh_mesh_add_convex(&body.inks[wh_ink_of(part)], &part->convex, &part->convex.body_from_shape);
            (void)wh_gltf_add_node(&scene->gltf, name, finish_body(scene, &body, name), &here, "obstacle",
                                   index++);
        }
    }
}

static void add_stations(scene_t *scene) {
    const wh_layout_t *layout = scene->layout;
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_pose_t *pose = &layout->places[s].base_from_station;
        char name[WH_NAME_SIZE + 16];
        body_t body = {0};
        (void)snprintf(name, sizeof name, "station %s", layout->stations[s].name);
        add_parts(scene, &body, 1U << WH_PART_FIXED | 1U << WH_PART_LEDGE, (int32_t)s, pose);
        (void)wh_gltf_add_node(&scene->gltf, name, finish_body(scene, &body, name), pose, "station", s);
    }
}

static void add_moving(scene_t *scene, const wh_pose_t *pose, const wh_thin_t *path, body_t *body,
                       const char *name, const char *kind, size_t index) {
    const size_t mesh = finish_body(scene, body, name);
    const size_t node = wh_gltf_add_node(&scene->gltf, name, mesh, pose, kind, index);
    if (scene->animated) {
        const keyframes_t motion = keyframes_of_track(scene->signals, path);
        move_node(&motion, &scene->gltf, node);
    }
}

static void add_links(scene_t *scene) {
    wh_pose_t poses[WH_SIGNALS_LINKS];
    const bool is_there = wh_signals_links(scene->signals, scene->signals->first, poses);
    for (size_t i = 0; is_there && i < scene->link_count; ++i) {
        char name[2 * WH_NAME_SIZE];
        body_t body = {0};
        wh_layout_name_body(scene->layout, (size_t)scene->bodies[i], "column", name, sizeof name);
        add_parts(scene, &body, 1U << WH_PART_ARM, scene->bodies[i], NULL);
        add_moving(scene, &poses[i], &scene->paths[FIRST_LINK + i], &body, name, "link", i);
    }
}

static void add_grippers(scene_t *scene) {
    const wh_layout_t *layout = scene->layout;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        wh_pose_t pose;
        body_t body = {0};
        wh_signals_gripper(scene->signals, g, scene->signals->first, &pose);
        add_parts(scene, &body, 1U << WH_PART_BLADE | 1U << WH_PART_CHUCK, (int32_t)g, NULL);
        add_moving(scene, &pose, &scene->paths[g], &body, layout->grippers[g].name, "gripper", g);
    }
}

static void add_doors(scene_t *scene) {
    const wh_layout_t *layout = scene->layout;
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        wh_pose_t pose;
        body_t body = {0};
        wh_signals_door(scene->signals, d, scene->signals->first, &pose);
        add_parts(scene, &body, 1U << WH_PART_DOOR, (int32_t)d, NULL);
        add_moving(scene, &pose, &scene->paths[FIRST_DOOR + d], &body, layout->door_list[d].name, "door", d);
    }
}

static void add_wafers(scene_t *scene) {
    const wh_layout_t *layout = scene->layout;
    body_t body = {0};
    wh_mesh_add_wafer(&body.inks[WH_INK_WAFER], layout->wafer_diameter / 2, layout->wafer_thickness,
                      layout->notch, layout->notch_depth);
    const size_t mesh = layout->wafer_count > 0 ? finish_body(scene, &body, "wafer") : SIZE_MAX;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const size_t node = wh_gltf_add_node(&scene->gltf, layout->wafers[w].name, mesh,
                                             &layout->start[w].base_from_wafer, "wafer", w);
        if (scene->animated) {
            const keyframes_t motion = keyframes_of_wafer(scene, (int32_t)w);
            move_node(&motion, &scene->gltf, node);
        }
    }
    wh_mesh_free(&body.inks[WH_INK_WAFER]);
}

json_t *wh_scene_make(const wh_signals_t *signals, const char *name, bool animated) {
    scene_t scene = {.signals = signals, .layout = signals->layout, .animated = animated};
    scene.link_count = wh_signals_link_bodies(scene.layout, scene.bodies);
    wh_gltf_open(&scene.gltf);
    if (animated) {
        trace_paths(&scene);
    }
    for (size_t ink = 0; ink < WH_INKS; ++ink) {
        (void)wh_gltf_add_material(&scene.gltf, &wh_ink_materials[ink]);
    }
    add_base(&scene);
    add_obstacles(&scene);
    add_stations(&scene);
    add_links(&scene);
    add_grippers(&scene);
    add_doors(&scene);
    add_wafers(&scene);
    for (size_t i = 0; i < PATHS; ++i) {
        wh_thin_close(&scene.paths[i]);
    }
    return wh_gltf_finish(&scene.gltf, name, "waferhand " WH_VERSION);
}
