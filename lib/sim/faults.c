#include "faults.h"

#include <string.h>

/* ------------------------------------------------------------------------------------------ what is valid */

const char *wh_fault_name(wh_fault_kind_t kind) {
    static const char *const names[WH_FAULT_KINDS] = {
        "no_vacuum",      "slow_vacuum",   "sensor_on",         "sensor_off",       "leak",
        "valve_stuck",    "axis_stopped",  "command_lost",      "wafer_missing",    "wafer_doubled",
        "wafer_crossed",  "wafer_shifted", "wafer_tilted",      "plunger_stuck",    "plunger_slow",
        "door_stuck",     "door_slow",     "beam_dark",         "beam_lit",         "beam_late",
        "probe_closed",   "probe_open",    "edge_sensor_stuck", "edge_sensor_late", "station_stuck",
        "station_slow",   "e84_stuck",     "e84_late",          "wafer_placed",     "power_lost",
        "emergency_stop", "servo_error"};
    return (unsigned)kind < WH_FAULT_KINDS ? names[kind] : "unknown";
}

bool wh_fault_is_of_wafer(wh_fault_kind_t kind) {
    return (kind >= WH_FAULT_WAFER_MISSING && kind <= WH_FAULT_WAFER_TILTED) || kind == WH_FAULT_WAFER_PLACED;
}

bool wh_fault_is_of_door(wh_fault_kind_t kind) {
    return kind == WH_FAULT_DOOR_STUCK || kind == WH_FAULT_DOOR_SLOW;
}

bool wh_fault_is_of_beam(wh_fault_kind_t kind) {
    return kind >= WH_FAULT_BEAM_DARK && kind <= WH_FAULT_BEAM_LATE;
}

bool wh_fault_is_of_station(wh_fault_kind_t kind) {
    return kind >= WH_FAULT_STATION_STUCK && kind <= WH_FAULT_E84_LATE;
}

bool wh_fault_is_of_controller(wh_fault_kind_t kind) {
    return kind >= WH_FAULT_POWER_LOST && kind <= WH_FAULT_SERVO_ERROR;
}

wh_real_t wh_fault_most(wh_fault_kind_t kind) {
    static const struct {
        wh_fault_kind_t kind;
        wh_real_t most;
    } limits[] = {
        {WH_FAULT_SLOW_VACUUM, WH_REAL(3600)},       {WH_FAULT_LEAK, WH_REAL(1)},
        {WH_FAULT_EDGE_SENSOR_STUCK, WH_REAL(1)},    {WH_FAULT_PLUNGER_SLOW, (wh_real_t)WH_PLUNGER_FAST},
        {WH_FAULT_DOOR_SLOW, WH_REAL(1e4)},          {WH_FAULT_BEAM_LATE, WH_REAL(0.01)},
        {WH_FAULT_EDGE_SENSOR_LATE, WH_REAL(0.001)}, {WH_FAULT_STATION_SLOW, WH_REAL(1000)},
        {WH_FAULT_E84_LATE, WH_REAL(3600)}};
    wh_real_t most = 0;
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; ++i) {
        most = limits[i].kind == kind ? limits[i].most : most;
    }
    return most;
}

/* Below every part of a cell, mm. */
#define FAR_BELOW WH_REAL(-1e5)

wh_fault_t wh_fault_make(wh_fault_kind_t kind, int32_t target, wh_real_t value, int64_t from, int64_t until) {
    wh_fault_t fault;
    memset(&fault, 0, sizeof fault);
    fault.kind = kind;
    fault.target = kind == WH_FAULT_COMMAND_LOST ? WH_NONE : target;
    fault.other = WH_NONE;
    fault.value = wh_fault_most(kind) > 0 ? value : 0;
    fault.offset = wh_pose_identity();
    fault.offset.r.z = kind == WH_FAULT_WAFER_MISSING ? FAR_BELOW : 0;
    fault.from = from;
    fault.until = until;
    return fault;
}

static size_t count_targets(wh_fault_kind_t kind, size_t gripper_count, size_t wafer_count) {
    return wh_fault_is_of_wafer(kind)        ? wafer_count
           : wh_fault_is_of_door(kind)       ? WH_DOORS
           : wh_fault_is_of_beam(kind)       ? WH_BEAMS
           : wh_fault_is_of_station(kind)    ? WH_FAULT_STATIONS
           : wh_fault_is_of_controller(kind) ? WH_FAULT_ROBOTS
                                             : gripper_count;
}

static bool other_fits(const wh_fault_t *fault, size_t wafer_count) {
    if (fault->kind == WH_FAULT_E84_STUCK || fault->kind == WH_FAULT_E84_LATE) {
        return fault->other >= 1 && fault->other <= WH_FAULT_E84_STEPS;
    }
    return fault->kind == WH_FAULT_WAFER_DOUBLED
               ? wh_is_index(fault->other, wafer_count) && fault->other != fault->target
               : fault->other == WH_NONE;
}

static bool names_fit(const wh_fault_t *fault, size_t gripper_count, size_t wafer_count) {
    const bool has_target =
        fault->kind == WH_FAULT_COMMAND_LOST
            ? fault->target == WH_NONE
            : wh_is_index(fault->target, count_targets(fault->kind, gripper_count, wafer_count));
    return has_target && other_fits(fault, wafer_count);
}

static bool value_fits(const wh_fault_t *fault) {
    return fault->value >= 0 && fault->value <= wh_fault_most(fault->kind);
}

/* Compares byte by byte: a pose has no gaps, and the hash sees equal bits. */
static bool is_same_pose(const wh_pose_t *a, const wh_pose_t *b) {
    const unsigned char *left = (const unsigned char *)a;
    const unsigned char *right = (const unsigned char *)b;
    size_t same = 0;
    while (same < sizeof *a && left[same] == right[same]) {
        ++same;
    }
    return same == sizeof *a;
}

static bool is_straight(const wh_mat3_t *R) {
    size_t same = 0;
    while (same < 9 && R->m[same / 3][same % 3] == (same % 4 == 0 ? 1 : 0)) {
        ++same;
    }
    return same == 9;
}

/* True if the offset of a wafer's fault is so small that adding it to any finite position stays finite. */
static bool offset_fits(const wh_fault_t *fault) {
    const bool of_wafer = wh_fault_is_of_wafer(fault->kind);
    const wh_real_t reach = of_wafer ? WH_FAULT_REACH : WH_REAL(0);
    const wh_vec3_t *r = &fault->offset.r;
    return wh_real_abs(r->x) <= reach && wh_real_abs(r->y) <= reach && wh_real_abs(r->z) <= reach &&
           (of_wafer || is_straight(&fault->offset.R));
}

wh_status_t wh_fault_validate(const wh_fault_t *fault, size_t gripper_count, size_t wafer_count) {
    if (!fault) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if ((unsigned)fault->kind >= WH_FAULT_KINDS || !value_fits(fault) || fault->from < 1 ||
        fault->until < 0 || !names_fit(fault, gripper_count, wafer_count)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = wh_pose_validate(&fault->offset);
    return status != WH_OK || offset_fits(fault) ? status : WH_STATUS_OUT_OF_RANGE;
}

/* True if the fault has moved a wafer and puts it back when it ends. */
static bool has_moved(const wh_fault_slot_t *slot) {
    return slot->phase == WH_FAULT_ACTING && wh_fault_is_of_wafer(slot->fault.kind);
}

static bool slot_fits(const wh_fault_slot_t *slot, size_t gripper_count, size_t wafer_count) {
    if (slot->phase == WH_FAULT_FREE) {
        return true;
    }
    return (unsigned)slot->phase <= WH_FAULT_TAKEN &&
           (slot->phase != WH_FAULT_TAKEN || wh_fault_is_of_wafer(slot->fault.kind)) &&
           wh_fault_validate(&slot->fault, gripper_count, wafer_count) == WH_OK &&
           (!has_moved(slot) ||
            (wh_pose_validate(&slot->before) == WH_OK && wh_pose_validate(&slot->placed) == WH_OK));
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

/* Compares everything but `until`. */
static bool is_same(const wh_fault_t *a, const wh_fault_t *b) {
    return a->kind == b->kind && a->target == b->target && a->other == b->other && a->from == b->from &&
           a->value == b->value && is_same_pose(&a->offset, &b->offset);
}

/* True if the fault has not ended yet. */
static bool is_alive(const wh_fault_slot_t *slot) {
    return slot->phase != WH_FAULT_FREE && slot->phase != WH_FAULT_OVER;
}

static bool may_take(const wh_faults_t *faults, const wh_fault_request_t *request) {
    if (!wh_is_index(request->index, WH_FAULTS)) {
        return false;
    }
    const wh_fault_slot_t *slot = &faults->slots[request->index];
    return (size_t)request->index >= faults->count || !is_alive(slot) ||
           is_same(&slot->fault, &request->fault);
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
    if (is_alive(slot)) {
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

/* False if the wafer, or the one that it must lie on, is held: the fault must then wait. */
static bool move_wafer(wh_fault_slot_t *slot, wh_grasp_t *table) {
    const wh_fault_t *fault = &slot->fault;
    const wh_wafer_t *wafer = &table->storage.wafers[fault->target];
    const wh_wafer_t *from = fault->other == WH_NONE ? wafer : &table->storage.wafers[fault->other];
    if (wafer->holder != WH_NONE || from->holder != WH_NONE) {
        return false;
    }
    slot->before = wafer->base_from_wafer;
    slot->placed = fault->offset;
    if (fault->kind != WH_FAULT_WAFER_PLACED) {
        wh_pose_compose_to(&from->base_from_wafer, &fault->offset, &slot->placed);
    }
    if (wh_pose_validate(&slot->placed) != WH_OK) {
        wh_mat3_orthonormalise(&slot->placed.R);
    }
    (void)wh_grasp_place(table, (size_t)fault->target, &slot->placed);
    return true;
}

/* The fault that acts on this wafer and has put it there, or (not `placed`) has found it there. */
static wh_fault_slot_t *find_move(wh_faults_t *faults, int32_t wafer, const wh_pose_t *there, bool placed) {
    wh_fault_slot_t *found = NULL;
    for (size_t i = 0; !found && i < faults->count; ++i) {
        wh_fault_slot_t *slot = &faults->slots[i];
        if (has_moved(slot) && slot->fault.target == wafer &&
            is_same_pose(placed ? &slot->placed : &slot->before, there)) {
            found = slot;
        }
    }
    return found;
}

/* If another fault has moved the wafer since, that other fault puts it back, to its place before both. */
static void put_back(const wh_fault_slot_t *slot, wh_faults_t *faults, wh_grasp_t *table) {
    const int32_t wafer = slot->fault.target;
    wh_fault_slot_t *later = find_move(faults, wafer, &slot->placed, false);
    if (is_same_pose(&table->storage.wafers[wafer].base_from_wafer, &slot->placed)) {
        (void)wh_grasp_place(table, (size_t)wafer, &slot->before);
    } else if (later) {
        later->before = slot->before;
    }
}

/* True if the fault begins to act. */
static bool begin(wh_fault_slot_t *slot, wh_grasp_t *table) {
    if (wh_fault_is_of_wafer(slot->fault.kind) && !move_wafer(slot, table)) {
        return false;
    }
    slot->phase = slot->fault.kind == WH_FAULT_WAFER_PLACED ? WH_FAULT_OVER : WH_FAULT_ACTING;
    return true;
}

/* True if the fault has acted until now. */
static bool end(wh_fault_slot_t *slot, wh_faults_t *faults, wh_grasp_t *table) {
    const bool acted = slot->phase != WH_FAULT_WAITING;
    const bool moved = has_moved(slot);
    slot->phase = WH_FAULT_OVER;
    if (moved) {
        put_back(slot, faults, table);
    }
    return acted;
}

/* A wafer that was taken or moved since the last slice no longer belongs to a fault. It is held for at
 * least one slice, so that every taking is seen. */
static void give_up(wh_faults_t *faults, const wh_grasp_t *table) {
    for (size_t i = 0; i < faults->count; ++i) {
        wh_fault_slot_t *slot = &faults->slots[i];
        if (has_moved(slot)) {
            const int32_t target = slot->fault.target;
            const wh_wafer_t *wafer = &table->storage.wafers[target];
            const bool is_there = find_move(faults, target, &wafer->base_from_wafer, true) != NULL;
            slot->phase = is_there && wafer->holder == WH_NONE ? WH_FAULT_ACTING : WH_FAULT_TAKEN;
        }
    }
}

wh_fault_changes_t wh_faults_advance(wh_faults_t *faults, wh_grasp_t *table, int64_t seq) {
    wh_fault_changes_t changes = {0, 0};
    give_up(faults, table);
    for (size_t i = 0; i < faults->count; ++i) {
        wh_fault_slot_t *slot = &faults->slots[i];
        if (is_alive(slot) && seq >= slot->fault.until) {
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
        if (faults->slots[i].phase != WH_FAULT_ACTING || fault->target < 0 ||
            (size_t)fault->target != gripper) {
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

const wh_fault_t *wh_faults_find(const wh_faults_t *faults, wh_fault_kind_t kind, int32_t target) {
    const wh_fault_t *found = NULL;
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_t *fault = &faults->slots[i].fault;
        if (faults->slots[i].phase == WH_FAULT_ACTING && fault->kind == kind && fault->target == target &&
            (!found || fault->value > found->value)) {
            found = fault;
        }
    }
    return found;
}

double wh_faults_plunger(const wh_faults_t *faults, size_t gripper) {
    wh_real_t speed = WH_PLUNGER_FAST;
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_t *fault = &faults->slots[i].fault;
        if (faults->slots[i].phase != WH_FAULT_ACTING || fault->target != (int32_t)gripper) {
            continue;
        }
        if (fault->kind == WH_FAULT_PLUNGER_STUCK) {
            speed = 0;
        } else if (fault->kind == WH_FAULT_PLUNGER_SLOW && fault->value < speed) {
            speed = fault->value;
        }
    }
    return (double)speed;
}

static void overrule(const wh_fault_t *fault, const wh_grasp_t *table, size_t g, int32_t valve,
                     wh_gripper_input_t *input) {
    const bool is_lost = fault->kind == WH_FAULT_COMMAND_LOST;
    const bool is_its = is_lost || fault->target == (int32_t)g;
    if (is_its && (is_lost || fault->kind == WH_FAULT_AXIS_STOPPED) && table->slice > 0) {
        input->base_from_gripper = table->storage.grippers[g].base_from_gripper;
    }
    if (is_its && (is_lost || fault->kind == WH_FAULT_VALVE_STUCK)) {
        input->valve = valve;
    }
}

void wh_faults_overrule(const wh_faults_t *faults, const wh_grasp_t *table, const wh_vacuum_t vacuum[],
                        wh_gripper_input_t inputs[]) {
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_slot_t *slot = &faults->slots[i];
        for (size_t g = 0; slot->phase == WH_FAULT_ACTING && g < table->storage.gripper_count; ++g) {
            overrule(&slot->fault, table, g, vacuum[g].command, &inputs[g]);
        }
    }
}

/* Returns no bit for a gripper that no command has. */
static uint32_t sensor_of(int32_t gripper) {
    return wh_is_index(gripper, WH_GRIPPERS) ? UINT32_C(1) << (unsigned)gripper : 0;
}

uint32_t wh_faults_sensors(const wh_faults_t *faults, uint32_t sensors) {
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_t *fault = &faults->slots[i].fault;
        const uint32_t sensor = faults->slots[i].phase == WH_FAULT_ACTING ? sensor_of(fault->target) : 0;
        if (fault->kind == WH_FAULT_SENSOR_ON) {
            sensors |= sensor;
        } else if (fault->kind == WH_FAULT_SENSOR_OFF) {
            sensors &= ~sensor;
        }
    }
    return sensors;
}
