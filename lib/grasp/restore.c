#include "restore.h"

#include "grasp_internal.h"
#include "index_internal.h"

static bool is_index_or_none(int32_t index, size_t count) {
    return index == WH_NONE || wh_is_index(index, count);
}

/* True if every number is finite. */
static bool measured_is_finite(const wh_proximity_t *p) {
    const wh_real_t values[] = {p->dr.x,         p->dr.y,         p->dr.z,
                                p->n1_proj_n2,   p->dr_proj_z,    p->dr_proj_xy.x,
                                p->dr_proj_xy.y, p->dr_proj_xy.z, p->dr_proj_xy_norm};
    bool finite = true;
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        finite = finite && wh_real_is_finite(values[i]);
    }
    return finite;
}

/* A contested wafer has a holder, an approached one has none. */
static wh_status_t check_encounter(const wh_grasp_t *table, const wh_encounter_t *encounter, bool contested,
                                   uint64_t slice) {
    if (encounter->wafer == WH_NONE) {
        return WH_OK;
    }
    const bool holder_fits = contested ? wh_is_index(encounter->holder, table->storage.gripper_count)
                                       : encounter->holder == WH_NONE;
    const bool face_fits = encounter->face == WH_FACE_BACK || encounter->face == WH_FACE_FRONT;
    if (!wh_is_index(encounter->wafer, table->storage.wafer_count) || !holder_fits || !face_fits ||
        encounter->slice > slice) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return measured_is_finite(&encounter->measured) ? WH_OK : WH_STATUS_NOT_FINITE;
}

/* True if the difference of the numbers can come from rounding and from rotations that just pass
 * wh_pose_validate; `size` is the largest number that went in. Returns false if a number is not finite. */
static bool is_same(wh_real_t a, wh_real_t b, wh_real_t size) {
    return wh_real_abs(a - b) <= 16 * WH_ROTATION_TOLERANCE * size;
}

static bool is_same_place(const wh_vec3_t *a, const wh_vec3_t *b, wh_real_t reach) {
    return is_same(a->x, b->x, reach + wh_real_abs(b->x)) && is_same(a->y, b->y, reach + wh_real_abs(b->y)) &&
           is_same(a->z, b->z, reach + wh_real_abs(b->z));
}

/* True if a held wafer is where its gripper carries it. */
static bool is_carried(const wh_tolerance_t *tolerance, const wh_wafer_t *wafer,
                       const wh_gripper_t *gripper) {
    wh_pose_t carried;
    wh_pose_compose_to(&gripper->base_from_gripper, &gripper->gripper_from_wafer, &carried);
    bool same = is_same_place(&wafer->base_from_wafer.r, &carried.r, tolerance->projz + tolerance->projxy);
    for (size_t i = 0; i < 9; ++i) {
        same = same && is_same(wafer->base_from_wafer.R.m[i / 3][i % 3], carried.R.m[i / 3][i % 3], 1);
    }
    return same;
}

static wh_status_t check_wafer(const wh_grasp_t *table, size_t w, const wh_wafer_t wafers[],
                               const wh_gripper_t grippers[]) {
    const int32_t holder = wafers[w].holder;
    if (!is_index_or_none(holder, table->storage.gripper_count) ||
        (holder != WH_NONE && grippers[holder].wafer != (int32_t)w)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = wh_pose_validate(&wafers[w].base_from_wafer);
    const bool placed = status != WH_OK || holder == WH_NONE ||
                        is_carried(&table->config.tolerance, &wafers[w], &grippers[holder]);
    return placed ? status : WH_STATUS_OUT_OF_RANGE;
}

/* A wafer is taken within the tolerances; one that shows its front is taken by a frame that is farther by
 * its thickness. A wafer held from much farther away could be carried beyond all finite numbers. */
static bool is_within_reach(const wh_tolerance_t *tolerance, const wh_pose_t *gripper_from_wafer) {
    const wh_vec3_t *r = &gripper_from_wafer->r;
    const wh_real_t through = gripper_from_wafer->R.m[2][2] < 0 ? WH_FACE_THICKEST : 0;
    const wh_real_t reach = 2 * (tolerance->projz + tolerance->projxy) + through;
    return wh_real_abs(r->x) <= reach && wh_real_abs(r->y) <= reach && wh_real_abs(r->z) <= reach;
}

static wh_status_t check_held(const wh_grasp_t *table, size_t g, const wh_wafer_t wafers[],
                              const wh_gripper_t *gripper) {
    if (gripper->wafer == WH_NONE) {
        return WH_OK;
    }
    /* Passive pads, and a plunger that is stuck, hold with a closed valve too. */
    const bool holds = gripper->valve == WH_VALVE_OPEN || table->grips != 0;
    if (!wh_is_index(gripper->wafer, table->storage.wafer_count) || !holds ||
        wafers[gripper->wafer].holder != (int32_t)g) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = wh_pose_validate(&gripper->gripper_from_wafer);
    const bool reached =
        status != WH_OK || is_within_reach(&table->config.tolerance, &gripper->gripper_from_wafer);
    return reached ? status : WH_STATUS_OUT_OF_RANGE;
}

static wh_status_t check_gripper(const wh_grasp_t *table, size_t g, const wh_wafer_t wafers[],
                                 const wh_gripper_t *gripper, uint64_t slice) {
    if (gripper->valve != WH_VALVE_OPEN && gripper->valve != WH_VALVE_CLOSED) {
        return WH_STATUS_BAD_VALVE;
    }
    wh_status_t status = wh_pose_validate(&gripper->base_from_gripper);
    if (status == WH_OK) {
        status = check_held(table, g, wafers, gripper);
    }
    if (status == WH_OK) {
        status = check_encounter(table, &gripper->approach, false, slice);
    }
    if (status == WH_OK) {
        status = check_encounter(table, &gripper->contest, true, slice);
    }
    return status;
}

static wh_status_t check_grippers(const wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                                  const wh_gripper_t grippers[]) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        const wh_status_t status = check_gripper(table, g, wafers, &grippers[g], slice);
        if (status != WH_OK) {
            return status;
        }
    }
    return WH_OK;
}

static wh_status_t check_wafers(const wh_grasp_t *table, const wh_wafer_t wafers[],
                                const wh_gripper_t grippers[]) {
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        const wh_status_t status = check_wafer(table, w, wafers, grippers);
        if (status != WH_OK) {
            return status;
        }
    }
    return WH_OK;
}

static wh_status_t check_all(const wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                             const wh_gripper_t grippers[]) {
    if ((!wafers && table->storage.wafer_count > 0) || (!grippers && table->storage.gripper_count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!wh_grasp_is_built(&table->config, table->storage.bucket_count)) {
        return WH_STATUS_NOT_BUILT;
    }
    if (slice > INT64_MAX) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = check_grippers(table, slice, wafers, grippers);
    return status == WH_OK ? check_wafers(table, wafers, grippers) : status;
}

static void copy_wafers(wh_wafer_t to[], const wh_wafer_t from[], size_t count) {
    for (size_t w = 0; w < count; ++w) {
        to[w].base_from_wafer = from[w].base_from_wafer;
        to[w].holder = from[w].holder;
        to[w].released_by = WH_NONE;
    }
}

static void copy_encounter(wh_encounter_t *to, const wh_encounter_t *from) {
    to->measured = from->measured;
    to->slice = from->slice;
    to->face = from->face;
    to->holder = from->holder;
    to->wafer = from->wafer;
}

static void copy_gripper(wh_gripper_t *to, const wh_gripper_t *from) {
    to->base_from_gripper = from->base_from_gripper;
    to->gripper_from_wafer = from->gripper_from_wafer;
    copy_encounter(&to->approach, &from->approach);
    copy_encounter(&to->contest, &from->contest);
    to->valve = from->valve;
    to->wafer = from->wafer;
}

static void copy_grippers(wh_gripper_t to[], const wh_gripper_t from[], size_t count) {
    for (size_t g = 0; g < count; ++g) {
        copy_gripper(&to[g], &from[g]);
    }
}

static void take_over(wh_grasp_t *table, const wh_wafer_t wafers[], const wh_gripper_t grippers[]) {
    copy_wafers(table->storage.wafers, wafers, table->storage.wafer_count);
    copy_grippers(table->storage.grippers, grippers, table->storage.gripper_count);
}

wh_status_t wh_grasp_restore(wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                             const wh_gripper_t grippers[]) {
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (table->mark != WH_GRASP_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    const wh_status_t status = check_all(table, slice, wafers, grippers);
    if (status != WH_OK) {
        ++table->counters.refused;
        return status;
    }
    table->slice = slice;
    take_over(table, wafers, grippers);
    wh_index_build(table);
    WH_ASSERT_CONSISTENT(table);
    return WH_OK;
}
