#include "scene.h"

#include <stdio.h>

#include "../layout/inks.h"
#include "../math/config.h"
#include "gltf.h"
#include "keyframes.h"

/* A node's meshes, one for each ink, while its parts are gathered. */
typedef struct {
    wh_mesh_t inks[WH_INKS];
} body_t;

typedef struct {
    const wh_signals_t *signals;
    const wh_layout_t *layout;
    wh_gltf_t gltf;
    wh_paths_t paths; /* of what moves, where it is animated */
    bool animated;
} scene_t;

/* -------------------------------------------------------------------------------------------------- parts */

static void add_part(body_t *body, const wh_part_t *part, const wh_pose_t *base_from_body) {
    const wh_pose_t pose = base_from_body ? wh_pose_relative(base_from_body, &part->convex.body_from_shape)
                                          : part->convex.body_from_shape;
    wh_mesh_add_convex(&body->inks[wh_ink_of(part)], &part->convex, &pose);
}

/* Adds all parts of some kinds with this owner. */
static void add_parts(const scene_t *scene, body_t *body, uint32_t kinds, int32_t owner,
                      const wh_pose_t *base_from_body) {
    const wh_world_config_t *world = &scene->layout->world;
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        if ((kinds >> (unsigned)part->kind & 1U) != 0 && part->owner == owner) {
            add_part(body, part, base_from_body);
        }
    }
}

/* Adds the gathered mesh, frees it, and returns its index; SIZE_MAX if there is nothing. */
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

static void add_fixed(scene_t *scene) {
    const wh_pose_t here = wh_pose_identity();
    body_t base = {0};
    body_t obstacles = {0};
    add_parts(scene, &base, 1U << WH_PART_ARM, WH_ARM_BASE, NULL);
    (void)wh_gltf_add_node(&scene->gltf, "base", finish_body(scene, &base, "base"), &here, "base", 0);
    add_parts(scene, &obstacles, 1U << WH_PART_FIXED, WH_NONE, NULL);
    const size_t mesh = finish_body(scene, &obstacles, "obstacles");
    if (mesh != SIZE_MAX) {
        (void)wh_gltf_add_node(&scene->gltf, "obstacles", mesh, &here, "obstacles", 0);
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
        wh_keyframes_t motion = wh_keyframes_of_track(scene->signals, path);
        wh_keyframes_add(&motion, &scene->gltf, node);
    }
}

static void add_links(scene_t *scene) {
    static const char *const names[WH_SIGNALS_LINKS] = {"lift", "upper arm", "forearm", "hand"};
    wh_pose_t poses[WH_SIGNALS_LINKS];
    const bool is_there = wh_signals_links(scene->signals, scene->signals->first, poses);
    for (size_t i = 0; is_there && i < WH_SIGNALS_LINKS; ++i) {
        body_t body = {0};
        add_parts(scene, &body, 1U << WH_PART_ARM, (int32_t)(WH_ARM_LIFT + i), NULL);
        add_moving(scene, &poses[i], &scene->paths.links[i], &body, names[i], "link", i);
    }
}

static void add_grippers(scene_t *scene) {
    const wh_layout_t *layout = scene->layout;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        wh_pose_t pose;
        body_t body = {0};
        wh_signals_gripper(scene->signals, g, scene->signals->first, &pose);
        add_parts(scene, &body, 1U << WH_PART_BLADE | 1U << WH_PART_CHUCK, (int32_t)g, NULL);
        add_moving(scene, &pose, &scene->paths.grippers[g], &body, layout->grippers[g].name, "gripper", g);
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
            wh_keyframes_t motion = wh_keyframes_of_wafer(scene->signals, &scene->paths, (int32_t)w);
            wh_keyframes_add(&motion, &scene->gltf, node);
        }
    }
    wh_mesh_free(&body.inks[WH_INK_WAFER]);
}

json_t *wh_scene_make(const wh_signals_t *signals, const char *name, bool animated) {
    scene_t scene = {.signals = signals, .layout = signals->layout, .animated = animated};
    wh_gltf_open(&scene.gltf);
    if (animated) {
        scene.paths = wh_paths_of_signals(signals);
    }
    for (size_t ink = 0; ink < WH_INKS; ++ink) {
        (void)wh_gltf_add_material(&scene.gltf, &wh_ink_materials[ink]);
    }
    add_fixed(&scene);
    add_stations(&scene);
    add_links(&scene);
    add_grippers(&scene);
    add_wafers(&scene);
    wh_paths_free(&scene.paths);
    return wh_gltf_finish(&scene.gltf, name, "waferhand " WH_VERSION);
}
