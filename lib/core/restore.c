#include "core/restore.h"

static bool is_index(int32_t index, size_t count) {
    return index >= 0 && (size_t)index < count;
}

static bool is_index_or_none(int32_t index, size_t count) {
    return index == WH_NONE || is_index(index, count);
}

/* Every number finite: a sum of differences that are each zero, or NaN. */
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

static wh_status_t check_encounter(const wh_grasp_t *table, const wh_encounter_t *encounter, uint64_t slice) {
    if (encounter->wafer == WH_NONE) {
        return WH_OK;
    }
    if (!is_index(encounter->wafer, table->storage.wafer_count) ||
        !is_index_or_none(encounter->holder, table->storage.gripper_count) || encounter->slice > slice) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return measured_is_finite(&encounter->measured) ? WH_OK : WH_STATUS_NOT_FINITE;
}

static wh_status_t check_wafer(const wh_grasp_t *table, size_t w, const wh_wafer_t wafers[],
                               const wh_gripper_t grippers[]) {
    const int32_t holder = wafers[w].holder;
    if (!is_index_or_none(holder, table->storage.gripper_count) ||
        (holder != WH_NONE && grippers[holder].wafer != (int32_t)w)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return wh_pose_validate(&wafers[w].base_from_wafer);
}

static wh_status_t check_held(const wh_grasp_t *table, size_t g, const wh_wafer_t wafers[],
                              const wh_gripper_t *gripper) {
    if (gripper->wafer == WH_NONE) {
        return WH_OK;
    }
    if (!is_index(gripper->wafer, table->storage.wafer_count) || gripper->valve != WH_VALVE_OPEN ||
        wafers[gripper->wafer].holder != (int32_t)g) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return wh_pose_validate(&gripper->gripper_from_wafer);
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
        status = check_encounter(table, &gripper->approach, slice);
    }
    if (status == WH_OK) {
        status = check_encounter(table, &gripper->contest, slice);
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
    const wh_status_t status = check_grippers(table, slice, wafers, grippers);
    return status == WH_OK ? check_wafers(table, wafers, grippers) : status;
}

wh_status_t wh_grasp_restore(wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                             const wh_gripper_t grippers[]) {
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_status_t status = check_all(table, slice, wafers, grippers);
    if (status != WH_OK) {
        ++table->counters.refused;
        return status;
    }
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        table->storage.wafers[w] = wafers[w];
        table->storage.wafers[w].released_by = WH_NONE;
    }
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        table->storage.grippers[g] = grippers[g];
    }
    table->slice = slice;
    return WH_OK;
}
