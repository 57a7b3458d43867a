/* MuJoCo: free discs and a moving blade, with every option switched off. Measured are its
 * kinematics alone, which is less than a step, its step, and the contacts of a cell's shapes. C
 * code calls the wheel's library; no Python runs. */
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

/* ------------------------------------------------------------------------------------------------- a cell */

typedef struct {
    mjModel *model;
    mjData *data;
    const bool *neighbours;
    size_t count;
    int32_t *groups; /* the groups of shapes that move; WH_NONE: it rests */
    int32_t *bodies; /* the bodies of shapes that may move, from 1; 0: a part of MuJoCo's world */
    bool sorts;      /* leaves pairs out in which none moves */
} cell_t;

/* MuJoCo calls a function without an argument. */
static const cell_t *asked;

static const char cell_head[] = "<mujoco><size memory='256M'/><option gravity='0 0 0'/><worldbody>";

static void quaternion(double to[4], const wh_pose_t *pose) {
    double rotation[9];
    for (size_t i = 0; i < 9; ++i) {
        rotation[i] = pose->R.m[i / 3][i % 3];
    }
    mju_mat2Quat(to, rotation);
}

/* Each moving shape is a body of its own, which is put into its place in each slice. */
static int write_shape(char *text, size_t room, const bench_cell_t *from, size_t shape, double margin) {
    static const char *const kinds[] = {"box", "cylinder", "capsule"};
    static const wh_vec3_t origin = {0, 0, 0};
    const bool moves = from->moves[shape];
    const wh_convex_t *convex = from->convex[shape];
    const wh_vec3_t *r = moves ? &origin : &from->base_from_shape[shape].r;
    const double y = convex->kind == WH_CONVEX_BOX ? convex->half.y : convex->half.z;
    double q[4] = {1, 0, 0, 0};
    if (!moves) {
        quaternion(q, &from->base_from_shape[shape]);
    }
    return snprintf(text, room,
                    "%s<geom type='%s' size='%.17g %.17g %.17g' margin='%.17g' pos='%.17g %.17g %.17g' "
                    "quat='%.17g %.17g %.17g %.17g'/>%s",
                    moves ? "<body><freejoint/>" : "", kinds[convex->kind], 1e-3 * convex->half.x, 1e-3 * y,
                    1e-3 * convex->half.z, margin, 1e-3 * r->x, 1e-3 * r->y, 1e-3 * r->z, q[0], q[1], q[2],
                    q[3], moves ? "</body>" : "");
}

/* Geoms are numbered by their bodies, with the world's first. Shapes that never move stand first in
 * a cell. */
static mjModel *compile(const bench_cell_t *from, double margin) {
    const size_t room = sizeof cell_head + sizeof tail + from->count * 600;
    char *xml = malloc(room);
    char error[500] = "";
    size_t length = (size_t)snprintf(xml, room, "%s", cell_head);
    for (size_t i = 0; i < from->count; ++i) {
        length += (size_t)write_shape(xml + length, room - length, from, i, margin);
    }
    (void)snprintf(xml + length, room - length, "%s", tail);
    mjSpec *spec = mj_parseXMLString(xml, NULL, error, sizeof error);
    mjModel *model = spec ? mj_compile(spec, NULL) : NULL;
    if (!model) {
        (void)fprintf(stderr, "bench: MuJoCo does not take the cell: %s\n", error);
        exit(1);
    }
    mj_deleteSpec(spec);
    free(xml);
    return model;
}

static void put(const cell_t *cell, size_t shape, const wh_pose_t *pose) {
    double *qpos = &cell->data->qpos[7 * (cell->bodies[shape] - 1)];
    qpos[0] = 1e-3 * pose->r.x;
    qpos[1] = 1e-3 * pose->r.y;
    qpos[2] = 1e-3 * pose->r.z;
    quaternion(&qpos[3], pose);
}

/* MuJoCo leaves out pairs whose bits do not meet before it looks at them: resting shapes, if the
 * cell sorts. */
static void set_group(cell_t *cell, size_t shape, int32_t group) {
    const bool moves = group != WH_NONE || !cell->sorts;
    const int32_t body = cell->bodies[shape];
    cell->groups[shape] = group;
    cell->model->geom_contype[shape] = moves ? 2 : 1;
    cell->model->geom_conaffinity[shape] = moves ? 3 : 2;
    cell->model->body_contype[body] |= cell->model->geom_contype[shape];
    cell->model->body_conaffinity[body] |= cell->model->geom_conaffinity[shape];
}

static int is_not_asked(const mjModel *model, mjData *data, int a, int b) {
    (void)model;
    (void)data;
    const bool is_rigid =
        asked->groups[a] == asked->groups[b] && (asked->sorts || asked->groups[a] != WH_NONE);
    return is_rigid || asked->neighbours[(size_t)a * asked->count + (size_t)b];
}

static void *build_cell(const bench_cell_t *from, double margin, bool sorts) {
    cell_t *cell = malloc(sizeof *cell);
    mjModel *model = compile(from, margin);
    int32_t *groups = malloc(from->count * sizeof *groups);
    int32_t *bodies = malloc(from->count * sizeof *bodies);
    int32_t count = 0;
    *cell = (cell_t){model, mj_makeData(model), from->neighbours, from->count, groups, bodies, sorts};
    for (size_t i = 0; i < from->count; ++i) {
        bodies[i] = from->moves[i] ? ++count : 0;
        set_group(cell, i, WH_NONE);
        if (bodies[i] > 0) {
            put(cell, i, &from->base_from_shape[i]);
        }
    }
    return cell;
}

static void *build_contacts(const bench_cell_t *from) {
    return build_cell(from, 0, false);
}

static void *build_sorted_contacts(const bench_cell_t *from) {
    return build_cell(from, 0, true);
}

/* Both shapes of a pair have the margin, and MuJoCo takes the larger one. */
static void *build_margins(const bench_cell_t *from) {
    return build_cell(from, 0.02, false);
}

static void *build_sorted_margins(const bench_cell_t *from) {
    return build_cell(from, 0.02, true);
}

static void move(cell_t *cell, const bench_slice_t *slice) {
    for (size_t i = 0; i < cell->count; ++i) {
        cell->groups[i] = cell->groups[i] == WH_NONE ? WH_NONE : -2;
    }
    for (size_t i = 0; i < slice->count; ++i) {
        const bench_mover_t *mover = &slice->movers[i];
        set_group(cell, (size_t)mover->shape, mover->group);
        put(cell, (size_t)mover->shape, &mover->now);
    }
    for (size_t i = 0; i < cell->count; ++i) {
        if (cell->groups[i] == -2) {
            set_group(cell, i, WH_NONE);
        }
    }
    asked = cell;
    mjcb_contactfilter = is_not_asked;
    mj_kinematics(cell->model, cell->data);
    mj_collision(cell->model, cell->data);
    mjcb_contactfilter = NULL;
}

static size_t look_for_contacts(void *built, const bench_slice_t *slice, bench_near_t found[],
                                size_t capacity) {
    cell_t *cell = built;
    size_t count = 0;
    move(cell, slice);
    for (int i = 0; i < cell->data->ncon; ++i) {
        const mjContact *contact = &cell->data->contact[i];
        const bool moves =
            cell->groups[contact->geom[0]] != WH_NONE || cell->groups[contact->geom[1]] != WH_NONE;
        if (moves && contact->dist <= 0 && count < capacity) {
            found[count++] = (bench_near_t){contact->geom[0], contact->geom[1], 1e3 * contact->dist};
        }
    }
    return count;
}

static size_t look_for_nearest(void *built, const bench_slice_t *slice, bench_near_t found[],
                               size_t capacity) {
    cell_t *cell = built;
    double least = 20;
    size_t count = 0;
    move(cell, slice);
    for (int i = 0; i < cell->data->ncon && capacity > 0; ++i) {
        const mjContact *contact = &cell->data->contact[i];
        const bool moves =
            cell->groups[contact->geom[0]] != WH_NONE || cell->groups[contact->geom[1]] != WH_NONE;
        if (moves && 1e3 * contact->dist < least) {
            least = 1e3 * contact->dist;
            found[0] = (bench_near_t){contact->geom[0], contact->geom[1], least};
            count = 1;
        }
    }
    return count;
}

static void drop_cell(void *built) {
    cell_t *cell = built;
    mj_deleteData(cell->data);
    mj_deleteModel(cell->model);
    free(cell->groups);
    free(cell->bodies);
    free(cell);
}

BENCH_PEER bench_collider_t bench_cell[] = {
    {"MuJoCo, contacts", false, build_contacts, look_for_contacts, drop_cell},
    {"MuJoCo, of what moves", false, build_sorted_contacts, look_for_contacts, drop_cell},
    {"MuJoCo, to 20 mm", true, build_margins, look_for_nearest, drop_cell},
    {"MuJoCo, 20 mm, moving", true, build_sorted_margins, look_for_nearest, drop_cell},
    {0}};
