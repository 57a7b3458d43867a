/* Held wafers and empty blades that go through other wafers. */
#include "station.h"

/* A place this near to a wafer's centre is within its rim, whatever its size: the smallest ones have a radius
 * of 25 mm. */
#define OVER WH_REAL(25)

/* Rounding moves wafers that touch by less, mm. */
#define SURE WH_REAL(1e-3)

/* The way of a body, seen from a wafer's centre; `up` is a normal. It goes through where it passes the height
 * `rise` on the way up, or `fall` on the way down. */
typedef struct {
    wh_vec3_t from, to, up;
    wh_real_t rise, fall, over;
} way_t;

static bool goes_across(const way_t *way, bool *goes_up) {
    const wh_real_t from = wh_vec3_dot(&way->up, &way->from), to = wh_vec3_dot(&way->up, &way->to);
    const wh_real_t plane = to > from ? way->rise : way->fall;
    if (!((from < plane && to >= plane) || (from > plane && to <= plane))) {
        return false;
    }
    const wh_vec3_t all = wh_vec3_subtract(&way->to, &way->from);
    const wh_vec3_t part = wh_vec3_scale((plane - from) / (to - from), &all);
    const wh_vec3_t at = wh_vec3_add(&way->from, &part);
    *goes_up = to > from;
    return wh_vec3_dot(&at, &at) - plane * plane < way->over * way->over;
}

static wh_real_t over_of(const wh_cell_t *cell) {
    return cell->tolerance.projxy > OVER ? cell->tolerance.projxy : OVER;
}

/* Half a thickness in front of the back face; where no thickness is known, all wafers lie alike. */
static wh_vec3_t middle_of(const wh_cell_t *cell, const wh_pose_t *base_from_wafer) {
    const wh_vec3_t n = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_vec3_t half = wh_vec3_scale(cell->thickness / 2, &n);
    return wh_vec3_add(&base_from_wafer->r, &half);
}

bool wh_cell_wafer_crosses(const wh_cell_t *cell, const wh_pose_t wafer[2], const wh_pose_t other[2],
                           bool *goes_up) {
    const wh_vec3_t ends[4] = {middle_of(cell, &wafer[0]), middle_of(cell, &wafer[1]),
                               middle_of(cell, &other[0]), middle_of(cell, &other[1])};
    const way_t way = {wh_vec3_subtract(&ends[0], &ends[2]),
                       wh_vec3_subtract(&ends[1], &ends[3]),
                       wh_mat3_column(&other[1].R, 2),
                       -SURE,
                       -cell->tolerance.projz,
                       over_of(cell)};
    return goes_across(&way, goes_up);
}

bool wh_cell_blade_crosses(const wh_cell_t *cell, const wh_pose_t blade[2], const wh_pose_t other[2],
                           bool *goes_up) {
    const wh_vec3_t ends[2] = {wh_face_centre(&other[0], cell->thickness, &blade[0]),
                               wh_face_centre(&other[1], cell->thickness, &blade[1])};
    const way_t way = {wh_vec3_subtract(&blade[0].r, &ends[0]),
                       wh_vec3_subtract(&blade[1].r, &ends[1]),
                       wh_mat3_column(&blade[1].R, 2),
                       cell->tolerance.projz,
                       cell->tolerance.projz,
                       over_of(cell)};
    return goes_across(&way, goes_up);
}

/* --------------------------------------------------------------------------------------------- in a slice */

/* The mover in a slice: the gripper g, with the wafer that it holds. */
typedef struct {
    const wh_cell_t *cell;
    const wh_grasp_t *table;
    const wh_gripper_input_t *inputs;
    size_t g;
    uint32_t shut;
    wh_real_t reach; /* farther wafers are not met */
} mover_t;

/* The poses of a wafer as the slice begins and, if its gripper still holds it, as it ends. */
static void poses_of(const mover_t *mover, int32_t wafer, wh_pose_t poses[2]) {
    const wh_grasp_storage_t *storage = &mover->table->storage;
    const int32_t holder = storage->wafers[wafer].holder;
    poses[0] = storage->wafers[wafer].base_from_wafer;
    poses[1] = poses[0];
    if (wh_is_index(holder, storage->gripper_count)) {
        wh_pose_compose_to(&mover->inputs[holder].base_from_gripper,
                           &storage->grippers[holder].gripper_from_wafer, &poses[1]);
    }
}

/* False for most wafers: they are too far away along one axis. */
static bool is_in_reach(const mover_t *mover, const wh_vec3_t *place, size_t w) {
    const wh_wafer_t *wafer = &mover->table->storage.wafers[w];
    return wafer->holder != WH_NONE || (wh_real_abs(wafer->base_from_wafer.r.x - place->x) < mover->reach &&
                                        wh_real_abs(wafer->base_from_wafer.r.y - place->y) < mover->reach &&
                                        wh_real_abs(wafer->base_from_wafer.r.z - place->z) < mover->reach);
}

static WH_OUT_OF_LINE bool meets(const mover_t *mover, wh_passing_t *passing) {
    const wh_grasp_storage_t *storage = &mover->table->storage;
    const wh_gripper_t *gripper = &storage->grippers[mover->g];
    const int32_t held = gripper->wafer;
    wh_pose_t own[2] = {gripper->base_from_gripper, mover->inputs[mover->g].base_from_gripper}, other[2];
    bool found = false;
    if (held != WH_NONE) {
        poses_of(mover, held, own);
    }
    for (size_t w = 0; w < storage->wafer_count && !found; ++w) {
        if ((int32_t)w == held || !is_in_reach(mover, &own[0].r, w)) {
            continue;
        }
        poses_of(mover, (int32_t)w, other);
        found = held != WH_NONE ? wh_cell_wafer_crosses(mover->cell, own, other, &passing->goes_up)
                                : wh_cell_blade_crosses(mover->cell, own, other, &passing->goes_up);
        passing->other = found ? (int32_t)w : WH_NONE;
    }
    return found;
}

/* True if another gripper that holds a wafer or looks for one goes the same way. Two blades of one wrist may
 * be described in one place though they point away from each other. */
static bool has_partner(const mover_t *mover, const wh_vec3_t *way) {
    const wh_grasp_storage_t *storage = &mover->table->storage;
    bool found = false;
    for (size_t g = 0; g < storage->gripper_count && !found; ++g) {
        const wh_vec3_t its = wh_vec3_subtract(&mover->inputs[g].base_from_gripper.r,
                                               &storage->grippers[g].base_from_gripper.r);
        const wh_vec3_t apart = wh_vec3_subtract(&its, way);
        found = g != mover->g && (mover->shut >> g & 1U) == 0 && wh_vec3_dot(&apart, &apart) < SURE * SURE;
    }
    return found;
}

bool wh_cell_meets(const wh_cell_t *cell, const wh_grasp_t *table, const wh_gripper_input_t inputs[],
                   uint32_t shut, size_t gripper, wh_passing_t *passing) {
    const wh_pose_t *from = &table->storage.grippers[gripper].base_from_gripper;
    const wh_pose_t *to = &inputs[gripper].base_from_gripper;
    const wh_vec3_t up = wh_mat3_column(&to->R, 2);
    const wh_vec3_t all = wh_vec3_subtract(&to->r, &from->r);
    const wh_real_t rise = wh_vec3_dot(&up, &all);
    const wh_real_t way = wh_real_abs(all.x) + wh_real_abs(all.y) + wh_real_abs(all.z);
    const mover_t mover = {cell, table, inputs, gripper, shut, way + over_of(cell) + 2 * cell->thickness + 1};
    const bool is_blade = table->storage.grippers[gripper].wafer == WH_NONE;
    return (is_blade ? rise : wh_real_abs(rise)) > SURE * SURE && table->slice > 0 &&
           !(is_blade && has_partner(&mover, &all)) && meets(&mover, passing);
}
