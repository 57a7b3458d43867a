/* MuJoCo: free discs and a blade that is moved, with everything switched off that can be: its kinematics alone, which is less
 * than a step, and its step. The library of the wheel is called from C; no Python runs. */
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/peers.h"

typedef struct {
    mjModel *model;
    mjData *data;
} world_t;

static const char head[] =
    "<mujoco><option timestep='0.001' gravity='0 0 0'><flag constraint='disable' equality='disable'"
    " frictionloss='disable' limit='disable' contact='disable' spring='disable' damper='disable'"
    " gravity='disable' clampctrl='disable' warmstart='disable' filterparent='disable'"
    " actuation='disable' refsafe='disable' sensor='disable' midphase='disable'"
    " eulerdamp='disable' autoreset='disable'/></option><worldbody>"
    "<body mocap='true' pos='0 0 -1'><geom type='box' size='0.04 0.09 0.0015' contype='0'"
    " conaffinity='0'/></body>";
static const char wafer[] =
    "<body pos='%zu 0 0'><freejoint/><geom type='cylinder' size='0.15 0.0004' mass='0.1' contype='0'"
    " conaffinity='0'/></body>";
static const char tail[] = "</worldbody></mujoco>";

static void *build(size_t wafers) {
    const size_t room = sizeof head + sizeof tail + wafers * (sizeof wafer + 20);
    char *xml = malloc(room);
    char error[500] = "";
    size_t length = (size_t)snprintf(xml, room, "%s", head);
    for (size_t w = 0; w < wafers; ++w) {
        length += (size_t)snprintf(xml + length, room - length, wafer, w);
    }
    (void)snprintf(xml + length, room - length, "%s", tail);
    mjSpec *spec = mj_parseXMLString(xml, NULL, error, sizeof error);
    mjModel *model = spec ? mj_compile(spec, NULL) : NULL;
    if (!model) {
        (void)fprintf(stderr, "bench: MuJoCo does not take its world: %s\n", error);
        exit(1);
    }
    mj_deleteSpec(spec);
    free(xml);
    world_t *world = malloc(sizeof *world);
    *world = (world_t){model, mj_makeData(model)};
    return world;
}

static void place(const world_t *world, const wh_pose_t *gripper) {
    world->data->mocap_pos[0] = 1e-3 * gripper->r.x;
    world->data->mocap_pos[1] = 1e-3 * gripper->r.y;
    world->data->mocap_pos[2] = 1e-3 * gripper->r.z;
}

static uint64_t kinematics(void *world_, const wh_pose_t *gripper) {
    const world_t *world = world_;
    place(world, gripper);
    mj_kinematics(world->model, world->data);
    return (uint64_t)(world->data->xpos[3] > 1e9);
}

static uint64_t step(void *world_, const wh_pose_t *gripper) {
    const world_t *world = world_;
    place(world, gripper);
    mj_step(world->model, world->data);
    return (uint64_t)(world->data->xpos[3] > 1e9);
}

static void drop(void *world_) {
    world_t *world = world_;
    mj_deleteData(world->data);
    mj_deleteModel(world->model);
    free(world);
}

BENCH_PEER bench_step_peer_t bench_peer = {
    {{"MuJoCo kinematics", build, kinematics, drop}, {"MuJoCo step", build, step, drop}, {0}}};
