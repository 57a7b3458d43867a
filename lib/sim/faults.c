#include "faults.h"

#include <string.h>

/* ------------------------------------------------------------------------------------------ what is valid */

const char *wh_fault_name(wh_fault_kind_t kind) {
    static const char *const names[WH_FAULT_KINDS] = {
        "no_vacuum",     "slow_vacuum",   "sensor_on",    "sensor_off",    "leak",
        "valve_stuck",   "axis_stopped",  "command_lost", "wafer_missing", "wafer_doubled",
        "wafer_crossed", "wafer_shifted", "wafer_tilted"};
    return (unsigned)kind < WH_FAULT_KINDS ? names[kind] : "unknown";
}

bool wh_fault_is_of_wafer(wh_fault_kind_t kind) {
    return kind >= WH_FAULT_WAFER_MISSING;
}

/* Below everything in a cell, mm. */
#define FAR_BELOW WH_REAL(-1e5)

wh_fault_t wh_fault_make(wh_fault_kind_t kind, int32_t target, wh_real_t value, int64_t from, int64_t until) {
    wh_fault_t fault;
    memset(&fault, 0, sizeof fault);
    fault.kind = kind;
    fault.target = kind == WH_FAULT_COMMAND_LOST ? WH_NONE : target;
    fault.other = WH_NONE;
    fault.value = kind == WH_FAULT_SLOW_VACUUM || kind == WH_FAULT_LEAK ? value : 0;
    fault.offset = wh_pose_identity();
    fault.offset.r.z = kind == WH_FAULT_WAFER_MISSING ? FAR_BELOW : 0;
    fault.from = from;
    fault.until = until;
    return fault;
}

static bool names_fit(const wh_fault_t *fault, size_t gripper_count, size_t wafer_count) {
    if (fault->kind == WH_FAULT_COMMAND_LOST) {
        return fault->target == WH_NONE && fault->other == WH_NONE;
    }
    if (!wh_is_index(fault->target, wh_fault_is_of_wafer(fault->kind) ? wafer_count : gripper_count)) {
        return false;
    }
    return fault->kind == WH_FAULT_WAFER_DOUBLED
               ? wh_is_index(fault->other, wafer_count) && fault->other != fault->target
               : fault->other == WH_NONE;
}

static bool value_fits(const wh_fault_t *fault) {
    if (fault->kind == WH_FAULT_SLOW_VACUUM) {
        return fault->value >= 0 && fault->value <= 3600;
    }
    if (fault->kind == WH_FAULT_LEAK) {
        return fault->value >= 0 && fault->value <= 1;
    }
    return fault->value == 0;
}

/* Small enough that adding it to any finite position stays finite. */
static bool offset_fits(const wh_vec3_t *r) {
    return wh_real_abs(r->x) <= WH_FAULT_REACH && wh_real_abs(r->y) <= WH_FAULT_REACH &&
           wh_real_abs(r->z) <= WH_FAULT_REACH;
}

wh_status_t wh_fault_validate(const wh_fault_t *fault, size_t gripper_count, size_t wafer_count) {
    if (!fault) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if ((unsigned)fault->kind >= WH_FAULT_KINDS || !names_fit(fault, gripper_count, wafer_count) ||
        !value_fits(fault) || fault->from < 1 || fault->until < 0) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = wh_pose_validate(&fault->offset);
    return status != WH_OK || offset_fits(&fault->offset.r) ? status : WH_STATUS_OUT_OF_RANGE;
}

static bool slot_fits(const wh_fault_slot_t *slot, size_t gripper_count, size_t wafer_count) {
    const bool moved = wh_fault_is_of_wafer(slot->fault.kind) && slot->phase == WH_FAULT_ACTING;
    if (slot->phase == WH_FAULT_FREE) {
        return true;
    }
    return (unsigned)slot->phase <= WH_FAULT_OVER &&
           wh_fault_validate(&slot->fault, gripper_count, wafer_count) == WH_OK &&
           (!moved || (wh_pose_validate(&slot->before) == WH_OK && wh_pose_validate(&slot->placed) == WH_OK));
}

wh_status_t wh_faults_validate(const wh_faults_t *faults, size_t gripper_count, size_t wafer_count) {
    if (!faults) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (faults->count > WH_FAULTS) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    bool good = true;
    for (size_t i = 0; good && i < faults->count; ++i) {
        good = slot_fits(&faults->slots[i], gripper_count, wafer_count);
    }
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

/* -------------------------------------------------------------------------------------------- taking them */

void wh_faults_clear(wh_faults_t *faults) {
    memset(faults, 0, sizeof *faults);
}

static bool is_same_pose(const wh_pose_t *a, const wh_pose_t *b) {
    bool same = a->r.x == b->r.x && a->r.y == b->r.y && a->r.z == b->r.z;
    for (size_t i = 0; i < 9; ++i) {
        same = same && a->R.m[i / 3][i % 3] == b->R.m[i / 3][i % 3];
    }
    return same;
}

/* Compares all but `until`. */
static bool is_same(const wh_fault_t *a, const wh_fault_t *b) {
    return a->kind == b->kind && a->target == b->target && a->other == b->other && a->from == b->from &&
           a->value == b->value && is_same_pose(&a->offset, &b->offset);
}

static bool may_take(const wh_faults_t *faults, const wh_fault_request_t *request) {
    if (!wh_is_index(request->index, WH_FAULTS)) {
        return false;
    }
    const wh_fault_slot_t *slot = &faults->slots[request->index];
    return (size_t)request->index >= faults->count || slot->phase == WH_FAULT_FREE ||
           slot->phase == WH_FAULT_OVER || is_same(&slot->fault, &request->fault);
}

wh_status_t wh_faults_check(const wh_faults_t *faults, const wh_fault_request_t requests[], size_t count,
                            size_t gripper_count, size_t wafer_count) {
    uint32_t named = 0;
    if (!faults || (!requests && count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    for (size_t i = 0; i < count; ++i) {
        const wh_fault_request_t *request = &requests[i];
        if (!may_take(faults, request) || (named >> (unsigned)request->index & 1U) != 0) {
            return WH_STATUS_OUT_OF_RANGE;
        }
        named |= 1U << (unsigned)request->index;
        const wh_status_t status = wh_fault_validate(&request->fault, gripper_count, wafer_count);
        if (status != WH_OK) {
            return status;
        }
    }
    return WH_OK;
}

static void take(wh_faults_t *faults, const wh_fault_request_t *request) {
    wh_fault_slot_t *slot = &faults->slots[request->index];
    if (slot->phase == WH_FAULT_WAITING || slot->phase == WH_FAULT_ACTING) {
        slot->fault.until = request->fault.until;
        return;
    }
    memset(slot, 0, sizeof *slot);
    slot->fault = request->fault;
    slot->phase = WH_FAULT_WAITING;
    if ((size_t)request->index >= faults->count) {
        faults->count = (size_t)request->index + 1;
    }
}

void wh_faults_take(wh_faults_t *faults, const wh_fault_request_t requests[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        take(faults, &requests[i]);
    }
}

/* -------------------------------------------------------------------------------------- beginning, ending */

/* False if the wafer is held: the fault must wait then. */
static bool move_wafer(wh_fault_slot_t *slot, wh_grasp_t *table) {
    const wh_fault_t *fault = &slot->fault;
    const wh_wafer_t *wafer = &table->storage.wafers[fault->target];
    const wh_wafer_t *from = fault->other == WH_NONE ? wafer : &table->storage.wafers[fault->other];
    if (wafer->holder != WH_NONE) {
        return false;
    }
    slot->before = wafer->base_from_wafer;
    wh_pose_compose_to(&from->base_from_wafer, &fault->offset, &slot->placed);
    if (wh_pose_validate(&slot->placed) != WH_OK) {
        wh_mat3_orthonormalise(&slot->placed.R);
    }
    (void)wh_grasp_place(table, (size_t)fault->target, &slot->placed);
    return true;
}

/* If another fault has moved the wafer since, gives it the place from before both: it will put the wafer back
 * there. */
static void hand_down(const wh_fault_slot_t *slot, wh_faults_t *faults) {
    for (size_t i = 0; i < faults->count; ++i) {
        wh_fault_slot_t *later = &faults->slots[i];
        if (later != slot && later->phase == WH_FAULT_ACTING && wh_fault_is_of_wafer(later->fault.kind) &&
            later->fault.target == slot->fault.target && is_same_pose(&later->before, &slot->placed)) {
            later->before = slot->before;
        }
    }
}

static void put_back(const wh_fault_slot_t *slot, wh_faults_t *faults, wh_grasp_t *table) {
    const wh_wafer_t *wafer = &table->storage.wafers[slot->fault.target];
    if (wafer->holder == WH_NONE && is_same_pose(&wafer->base_from_wafer, &slot->placed)) {
        (void)wh_grasp_place(table, (size_t)slot->fault.target, &slot->before);
    } else {
        hand_down(slot, faults);
    }
}

/* True if the fault begins to act. */
static bool begin(wh_fault_slot_t *slot, wh_grasp_t *table) {
    if (wh_fault_is_of_wafer(slot->fault.kind) && !move_wafer(slot, table)) {
        return false;
    }
    slot->phase = WH_FAULT_ACTING;
    return true;
}

/* True if the fault has acted until now. */
static bool end(wh_fault_slot_t *slot, wh_faults_t *faults, wh_grasp_t *table) {
    const bool acted = slot->phase == WH_FAULT_ACTING;
    if (acted && wh_fault_is_of_wafer(slot->fault.kind)) {
        put_back(slot, faults, table);
    }
    slot->phase = WH_FAULT_OVER;
    return acted;
}

wh_fault_changes_t wh_faults_advance(wh_faults_t *faults, wh_grasp_t *table, int64_t seq) {
    wh_fault_changes_t changes = {0, 0};
    for (size_t i = 0; i < faults->count; ++i) {
        wh_fault_slot_t *slot = &faults->slots[i];
        const bool alive = slot->phase == WH_FAULT_WAITING || slot->phase == WH_FAULT_ACTING;
        if (alive && seq >= slot->fault.until) {
            changes.cleared |= end(slot, faults, table) ? 1U << i : 0U;
        } else if (slot->phase == WH_FAULT_WAITING && seq >= slot->fault.from) {
            changes.armed |= begin(slot, table) ? 1U << i : 0U;
        }
    }
    return changes;
}

/* ------------------------------------------------------------------------------------------------- acting */

wh_vacuum_fault_t wh_faults_of_vacuum(const wh_faults_t *faults, size_t gripper) {
    wh_vacuum_fault_t sum = wh_vacuum_sound();
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_t *fault = &faults->slots[i].fault;
        if (faults->slots[i].phase != WH_FAULT_ACTING || fault->target != (int32_t)gripper) {
            continue;
        }
        if (fault->kind == WH_FAULT_NO_VACUUM) {
            sum.full = 0;
        } else if (fault->kind == WH_FAULT_LEAK && fault->value < sum.full) {
            sum.full = fault->value;
        } else if (fault->kind == WH_FAULT_SLOW_VACUUM && fault->value > sum.build) {
            sum.build = fault->value;
        }
    }
    return sum;
}

static void stop_gripper(const wh_grasp_t *table, size_t g, wh_gripper_input_t inputs[]) {
    if (table->slice > 0) {
        inputs[g].base_from_gripper = table->storage.grippers[g].base_from_gripper;
    }
}

static void lose_command(const wh_grasp_t *table, const wh_vacuum_t vacuum[], wh_gripper_input_t inputs[]) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        stop_gripper(table, g, inputs);
        inputs[g].valve = vacuum[g].command;
    }
}

void wh_faults_overrule(const wh_faults_t *faults, const wh_grasp_t *table, const wh_vacuum_t vacuum[],
                        wh_gripper_input_t inputs[]) {
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_t *fault = &faults->slots[i].fault;
        if (faults->slots[i].phase != WH_FAULT_ACTING) {
            continue;
        }
        if (fault->kind == WH_FAULT_COMMAND_LOST) {
            lose_command(table, vacuum, inputs);
        } else if (fault->kind == WH_FAULT_AXIS_STOPPED) {
            stop_gripper(table, (size_t)fault->target, inputs);
        } else if (fault->kind == WH_FAULT_VALVE_STUCK) {
            inputs[fault->target].valve = vacuum[fault->target].command;
        }
    }
}

/* No bit for a gripper that no command has. */
static uint32_t sensor_of(int32_t gripper) {
    return wh_is_index(gripper, WH_GRIPPERS) ? UINT32_C(1) << (unsigned)gripper : 0;
}

uint32_t wh_faults_sensors(const wh_faults_t *faults, uint32_t sensors) {
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_t *fault = &faults->slots[i].fault;
        if (faults->slots[i].phase != WH_FAULT_ACTING) {
            continue;
        }
        if (fault->kind == WH_FAULT_SENSOR_ON) {
            sensors |= sensor_of(fault->target);
        } else if (fault->kind == WH_FAULT_SENSOR_OFF) {
            sensors &= ~sensor_of(fault->target);
        }
    }
    return sensors;
}
