#include "simulator.h"

#include <string.h>

#include "setting_internal.h"

static wh_status_t exchange_by_call(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    return wh_simulator_step((wh_simulator_t *)(void *)link, command, state);
}

static uint64_t hash_by_call(wh_link_t *link) {
    return wh_simulator_hash((wh_simulator_t *)(void *)link);
}

static int64_t missed_by_call(wh_link_t *link) {
    (void)link;
    return 0;
}

static void take_physics(wh_simulator_t *simulator, const wh_physics_t *physics) {
    simulator->slice_s = physics->slice_s;
    simulator->vacuum = physics->vacuum;
    simulator->pads = physics->pads;
    const wh_doors_t doors = simulator->physics.doors; /* at home, if there are any */
    wh_physics_state_start(&simulator->physics, physics);
    simulator->physics.doors = doors;
    if (simulator->given.gripping) {
        (void)simulator->given.gripping->complete(simulator, simulator->table.storage.grippers,
                                                  simulator->physics.grips);
    }
}

static void begin(wh_simulator_t *simulator, const wh_cell_t *cell) {
    simulator->link.exchange = exchange_by_call;
    simulator->link.hash = hash_by_call;
    simulator->link.missed = missed_by_call;
    simulator->cell = *cell;
    simulator->slice_s = WH_SLICE_S;
    simulator->vacuum = wh_vacuum_ideal();
    simulator->pads = wh_pads_none();
    wh_physics_state_start(&simulator->physics, NULL);
    simulator->event_count = 0;
    simulator->observer = (wh_observer_t){NULL, NULL, NULL};
    memset(&simulator->given, 0, sizeof simulator->given);
    simulator->is_strict = false;
    simulator->has_last = false;
    simulator->last_seq = 0;
    simulator->last_utime = 0;
    simulator->mark = WH_SIMULATOR_MARK;
}

wh_status_t wh_simulator_init(wh_simulator_t *simulator, const wh_grasp_config_t *config,
                              const wh_grasp_storage_t *storage, const wh_cell_t *cell) {
    if (!simulator || !storage) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (storage->gripper_count > WH_GRIPPERS) {
        return WH_STATUS_BAD_CAPACITY;
    }
    wh_status_t status = wh_cell_validate(cell, storage->gripper_count);
    if (status == WH_OK) {
        status = wh_grasp_init(&simulator->table, config, storage);
    }
    if (status == WH_OK) {
        begin(simulator, cell);
    }
    return status;
}

wh_status_t wh_simulator_set_physics(wh_simulator_t *simulator, const wh_physics_t *physics) {
    wh_status_t status = wh_simulator_check_setting(simulator, physics);
    if (status != WH_OK) {
        return status;
    }
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    status = wh_physics_validate(physics, storage->gripper_count, storage->wafer_count);
    if (status == WH_OK && simulator->given.gripping &&
        !wh_is_slice(physics->slice_s, simulator->given.grips.parts.dt)) {
        status = WH_STATUS_OUT_OF_RANGE;
    }
    if (status == WH_OK) {
        take_physics(simulator, physics);
    }
    return status;
}

wh_status_t wh_simulator_set_strict(wh_simulator_t *simulator, bool is_strict) {
    if (!simulator) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (simulator->mark != WH_SIMULATOR_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    simulator->is_strict = is_strict;
    return WH_OK;
}

/* ------------------------------------------------------------------------------------------------- events */

/* Returns null if there is no room. */
static wh_event_t *add_event(wh_simulator_t *simulator, wh_event_kind_t kind, int32_t wafer,
                             int32_t gripper) {
    static const wh_event_t blank = {.other = WH_NONE, .parts = {WH_NONE, WH_NONE}};
    if (simulator->event_count > WH_SLICE_EVENTS) {
        return NULL;
    }
    wh_event_t *event = &simulator->events[simulator->event_count];
    ++simulator->event_count;
    *event = blank;
    event->kind = kind;
    event->slice = simulator->table.slice;
    event->measured_slice = simulator->table.slice;
    event->wafer = wafer;
    event->gripper = gripper;
    return event;
}

static WH_OUT_OF_LINE void add_measured(wh_simulator_t *simulator, wh_event_kind_t kind, size_t g,
                                        wh_real_t value, wh_real_t limit) {
    wh_event_t *event = add_event(simulator, kind, simulator->table.storage.grippers[g].wafer, (int32_t)g);
    if (event) {
        event->value = value;
        event->limit = limit;
    }
}

static void report_faults(wh_simulator_t *simulator, uint32_t slots, wh_event_kind_t kind) {
    for (size_t i = 0; slots >> i != 0; ++i) {
        if ((slots >> i & 1U) == 0) {
            continue;
        }
        const wh_fault_t *fault = &simulator->physics.faults.slots[i].fault;
        const bool of_wafer = wh_fault_is_of_wafer(fault->kind);
        const bool of_gripper = !of_wafer && !wh_fault_is_of_door(fault->kind) &&
                                !wh_fault_is_of_beam(fault->kind) && !wh_fault_is_of_station(fault->kind) &&
                                !wh_fault_is_of_controller(fault->kind);
        wh_event_t *event = add_event(simulator, kind, of_wafer ? fault->target : WH_NONE,
                                      of_gripper ? fault->target : WH_NONE);
        if (event) {
            event->parts[0] = (int32_t)i;
            event->parts[1] = (int32_t)fault->kind;
        }
    }
}

/* ----------------------------------------------------------------------------------------------- stepping */

/* Faults may overrule an input, so all inputs are checked first. If one is bad, faults do nothing and the
 * grasp table refuses the command. */
static bool are_valid(const wh_command_t *command) {
    bool good = true;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        const wh_gripper_input_t *input = &command->grippers[g];
        good = good && (input->valve == WH_VALVE_OPEN || input->valve == WH_VALVE_CLOSED) &&
               wh_pose_validate(&input->base_from_gripper) == WH_OK;
    }
    return good;
}

/* True if no fault is in a slot or in the command, and the vacuum is ideal: every level is 0 or 1 at once.
 * The short path then has an equal result. A debounce takes the long one. */
static bool is_direct(const wh_simulator_t *simulator, const wh_command_t *command) {
    const wh_vacuum_config_t *vacuum = &simulator->vacuum;
    return simulator->physics.faults.count + command->fault_count == 0 &&
           vacuum->build + vacuum->vent + vacuum->idle == 0 && vacuum->debounce == 0;
}

static wh_fault_changes_t apply_faults(wh_simulator_t *simulator, const wh_command_t *command) {
    wh_fault_changes_t changes = {0, 0};
    wh_faults_t *faults = &simulator->physics.faults;
    if (faults->count + command->fault_count > 0 && are_valid(command)) {
        wh_faults_take(faults, command->faults, command->fault_count);
        changes = wh_faults_advance(faults, &simulator->table, command->seq);
        wh_faults_overrule(faults, &simulator->table, simulator->physics.vacuum, simulator->inputs);
    }
    return changes;
}

static bool holds(const wh_simulator_t *simulator, size_t g) {
    return simulator->table.storage.grippers[g].wafer != WH_NONE;
}

static bool has_vacuum(const wh_simulator_t *simulator, size_t g) {
    return (simulator->given.no_vacuum >> g & 1U) == 0;
}

/* True if a support gets the held wafer before this slice is over: the blade leaves the wafer there. */
static WH_OUT_OF_LINE bool is_set_down(const wh_simulator_t *simulator, size_t g) {
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    const wh_gripper_t *gripper = &storage->grippers[g];
    const int32_t wafer = gripper->wafer;
    wh_pose_t carried;
    if (wafer == WH_NONE) {
        return false;
    }
    wh_pose_compose_to(&simulator->inputs[g].base_from_gripper, &gripper->gripper_from_wafer, &carried);
    return wh_cell_stops(&simulator->cell, &storage->wafers[wafer].base_from_wafer, &carried);
}

/* Applies the valves to the vacuum. The result goes into `vacuum`, because the table may still refuse the
 * step. A valve that closes while its vacuum still holds acts once a support has the wafer. */
static void switch_valves(wh_simulator_t *simulator, wh_vacuum_t vacuum[]) {
    for (size_t g = 0; g < simulator->table.storage.gripper_count; ++g) {
        const wh_vacuum_fault_t fault = wh_faults_of_vacuum(&simulator->physics.faults, g);
        int32_t *valve = &simulator->inputs[g].valve;
        const bool is_let_go = *valve == WH_VALVE_CLOSED;
        vacuum[g] = simulator->physics.vacuum[g];
        if (!has_vacuum(simulator, g)) {
            vacuum[g].command = *valve;
            continue;
        }
        *valve = wh_vacuum_before(&simulator->vacuum, &fault, *valve, holds(simulator, g), simulator->slice_s,
                                  &vacuum[g]);
        if (is_let_go && *valve == WH_VALVE_OPEN && is_set_down(simulator, g)) {
            *valve = WH_VALVE_CLOSED;
        }
    }
}

static void update_vacuum(wh_simulator_t *simulator, const wh_command_t *command,
                          const wh_vacuum_t vacuum[]) {
    for (size_t g = 0; g < simulator->table.storage.gripper_count; ++g) {
        const wh_vacuum_fault_t fault = wh_faults_of_vacuum(&simulator->physics.faults, g);
        wh_vacuum_t *now = &simulator->physics.vacuum[g];
        *now = vacuum[g];
        simulator->physics.told[g] = command->grippers[g].valve;
        if (has_vacuum(simulator, g) &&
            wh_vacuum_after(&simulator->vacuum, &fault, holds(simulator, g), simulator->slice_s, now)) {
            add_measured(simulator, WH_EVENT_VACUUM_LOST, g, now->level, simulator->vacuum.off);
        }
    }
}

/* Sets the vacuum if is_direct: it follows from the wafers alone. */
static void take_vacuum(wh_simulator_t *simulator, const wh_command_t *command) {
    wh_physics_state_t *condition = &simulator->physics;
    for (size_t g = 0; g < simulator->table.storage.gripper_count; ++g) {
        const bool on = holds(simulator, g);
        condition->vacuum[g].level = on ? 1 : 0;
        condition->vacuum[g].command = command->grippers[g].valve;
        condition->vacuum[g].on = on;
        condition->told[g] = command->grippers[g].valve;
    }
}

static bool carries(wh_simulator_t *simulator, size_t g, wh_hold_t *hold) {
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    const wh_gripper_t *gripper = &storage->grippers[g];
    const wh_vec3_t *centre =
        gripper->wafer == WH_NONE ? NULL : &storage->wafers[gripper->wafer].base_from_wafer.r;
    return wh_carry_update(&simulator->physics.carry[g], &simulator->pads, simulator->physics.vacuum[g].level,
                           &gripper->base_from_gripper.R, centre, simulator->slice_s, hold);
}

static WH_OUT_OF_LINE void watch_grippers(wh_simulator_t *simulator) {
    const wh_gripping_calls_t *gripping = simulator->given.gripping;
    if (gripping) {
        gripping->sense(simulator);
    }
    for (size_t g = 0; g < simulator->table.storage.gripper_count; ++g) {
        wh_hold_t hold;
        if (gripping ? gripping->carries(simulator, g, &hold) : carries(simulator, g, &hold)) {
            add_measured(simulator, WH_EVENT_SLIPPED, g, hold.asked, hold.carried);
        }
    }
}

/* After a step: the sensors of other grips, and the wafers that slip. */
static void watch_holding(wh_simulator_t *simulator) {
    if (simulator->given.gripping || simulator->pads.mass > 0) {
        watch_grippers(simulator);
    }
}

/* Shows the observer the wafers that faults have moved, then the step. */
static void show(wh_simulator_t *simulator, const wh_command_t *command, const wh_gripper_input_t inputs[],
                 uint32_t changed, wh_event_list_t *list) {
    const wh_observer_t *observer = &simulator->observer;
    const wh_faults_t *faults = &simulator->physics.faults;
    for (size_t i = 0; observer->placed && i < faults->count; ++i) {
        const wh_fault_t *fault = &faults->slots[i].fault;
        if ((changed >> i & 1U) != 0 && wh_fault_is_of_wafer(fault->kind)) {
            observer->placed(observer->user, &simulator->table, fault->target);
        }
    }
    if (observer->look) {
        observer->look(observer->user, command, inputs, &simulator->table, list);
    }
}

/* The blades that are to take nothing: vacuum whose valve is told to be closed. One that looks for a wafer
 * tells its misses. */
static uint32_t shut_blades(const wh_simulator_t *simulator, const wh_command_t *command) {
    uint32_t shut = 0;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        shut |= command->grippers[g].valve == WH_VALVE_CLOSED && has_vacuum(simulator, g) ? 1U << g : 0;
    }
    return shut;
}

static wh_status_t step_cell(wh_simulator_t *simulator, const wh_command_t *command,
                             const wh_gripper_input_t inputs[], uint32_t changed) {
    wh_event_list_t list = {simulator->events, WH_SLICE_EVENTS + 1, 0};
    wh_passing_t passing[WH_GRIPPERS];
    const bool passes = wh_cell_begin_passing(&simulator->cell, &simulator->table, inputs,
                                              shut_blades(simulator, command), passing);
    const wh_status_t status = simulator->given.gripping
                                   ? simulator->given.gripping->step(simulator, inputs, &list)
                                   : wh_grasp_step(&simulator->table, inputs, &list);
    if (status == WH_OK && list.count > 0) {
        (void)wh_cell_judge(&simulator->cell, &simulator->table, &list);
        wh_cell_settle(&simulator->cell, &simulator->table, &list);
    }
    if (status == WH_OK && passes) {
        wh_cell_end_passing(&simulator->cell, &simulator->table, passing, &list);
    }
    if (status == WH_OK) {
        show(simulator, command, inputs, changed, &list);
    }
    simulator->event_count = list.count;
    return status;
}

static wh_status_t step_direct(wh_simulator_t *simulator, const wh_command_t *command) {
    const wh_status_t status = step_cell(simulator, command, command->grippers, 0);
    if (status == WH_OK) {
        take_vacuum(simulator, command);
        watch_holding(simulator);
    }
    return status;
}

static wh_status_t step_with_faults(wh_simulator_t *simulator, const wh_command_t *command) {
    wh_vacuum_t vacuum[WH_GRIPPERS];
    memcpy(simulator->inputs, command->grippers, command->gripper_count * sizeof command->grippers[0]);
    const wh_fault_changes_t changes = apply_faults(simulator, command);
    switch_valves(simulator, vacuum);
    const wh_status_t status =
        step_cell(simulator, command, simulator->inputs, changes.armed | changes.cleared);
    if (status == WH_OK) {
        update_vacuum(simulator, command, vacuum);
        watch_holding(simulator);
        report_faults(simulator, changes.armed, WH_EVENT_FAULT_ARMED);
        report_faults(simulator, changes.cleared, WH_EVENT_FAULT_CLEARED);
    }
    return status;
}

/* Checks the counts and, if strict, the times. */
static bool goes_on(const wh_simulator_t *simulator, const wh_command_t *command) {
    return command->gripper_count == simulator->table.storage.gripper_count &&
           command->axis_count <= WH_AXES &&
           (!simulator->is_strict || !simulator->has_last ||
            (command->seq > simulator->last_seq && command->utime > simulator->last_utime));
}

static wh_status_t check_command(const wh_simulator_t *simulator, const wh_command_t *command) {
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    if (!goes_on(simulator, command)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (command->scan.kind != WH_SCAN_KEEP &&
        (!simulator->given.scans ||
         simulator->given.scans->check(&simulator->given.scanning, &command->scan) != WH_OK)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (command->latch.kind != WH_LATCH_KEEP &&
        (!simulator->given.beams ||
         simulator->given.beams->check(&simulator->given.latching, &command->latch) != WH_OK)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (command->fault_count == 0) {
        return WH_OK;
    }
    return command->fault_count > WH_COMMAND_FAULTS
               ? WH_STATUS_OUT_OF_RANGE
               : wh_faults_check(&simulator->physics.faults, command->faults, command->fault_count,
                                 storage->gripper_count, storage->wafer_count);
}

/* Steps everything but the beams. */
static wh_status_t step_rest(void *of, const void *by) {
    wh_simulator_t *simulator = of;
    const wh_command_t *command = by;
    const wh_status_t status = is_direct(simulator, command) ? step_direct(simulator, command)
                                                             : step_with_faults(simulator, command);
    if (status == WH_OK && simulator->given.scans) {
        simulator->given.scans->step(simulator, command);
    }
    if (status == WH_OK && simulator->given.moving) {
        simulator->given.moving->step(simulator, command);
    }
    return status;
}

static wh_status_t step_table(wh_simulator_t *simulator, const wh_command_t *command) {
    const wh_status_t status = check_command(simulator, command);
    if (status != WH_OK) {
        ++simulator->table.counters.refused;
        simulator->event_count = 0;
        return status;
    }
    const wh_status_t stepped = simulator->given.beams
                                    ? simulator->given.beams->around(simulator, command, step_rest)
                                    : step_rest(simulator, command);
    if (stepped == WH_OK) {
        simulator->has_last = true;
        simulator->last_seq = command->seq;
        simulator->last_utime = command->utime;
    }
    return stepped;
}

static void view_nothing(wh_state_t *state) {
    state->wafers = NULL;
    state->wafer_count = 0;
    state->grippers = NULL;
    state->gripper_count = 0;
    state->events = NULL;
    state->event_count = 0;
    state->has_lost_events = false;
    state->sensors = 0;
    state->physics = NULL;
}

void wh_simulator_view(const wh_simulator_t *simulator, wh_state_t *state) {
    if (simulator->mark != WH_SIMULATOR_MARK) {
        view_nothing(state);
        return;
    }
    const wh_grasp_t *table = &simulator->table;
    state->wafers = table->storage.wafers;
    state->wafer_count = table->storage.wafer_count;
    state->grippers = table->storage.grippers;
    state->gripper_count = table->storage.gripper_count;
    state->events = simulator->events;
    state->has_lost_events = simulator->event_count > WH_SLICE_EVENTS;
    state->event_count = state->has_lost_events ? WH_SLICE_EVENTS : simulator->event_count;
    state->sensors = wh_physics_state_sensors(&simulator->physics, table->storage.gripper_count);
    state->physics = &simulator->physics;
}

wh_status_t wh_simulator_step(wh_simulator_t *simulator, const wh_command_t *command, wh_state_t *state) {
    if (!simulator || !command || !state) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    state->status =
        simulator->mark == WH_SIMULATOR_MARK ? step_table(simulator, command) : WH_STATUS_NOT_INITIALISED;
    state->utime = command->utime;
    state->seq = command->seq;
    wh_simulator_view(simulator, state);
    return state->status;
}

uint64_t wh_simulator_hash(const wh_simulator_t *simulator) {
    if (simulator->mark != WH_SIMULATOR_MARK) {
        return 0;
    }
    const uint64_t hash = wh_physics_state_hash_plain(&simulator->physics, &simulator->table);
    return simulator->given.hash
               ? simulator->given.hash(&simulator->physics, simulator->table.storage.gripper_count, hash)
               : hash;
}
