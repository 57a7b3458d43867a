/* The program that Eva analyses for lib/cell and lib/sim: their public functions, with every bit pattern.
 *
 * Assumed, as in eva_main.c: pointers are null only if a function refuses null, a bool is 0 or 1,
 * arrays are as long as their counts say. If a header says that nothing is checked, the arguments
 * are ones that the checking function has accepted. The grasp table is not analysed again. For a
 * step, a placement and a set-up this file assumes the result of eva_main.c and of the table's
 * contracts: any wafer may be anywhere, held by any gripper or by none.
 *
 * Faults are checked here in any number and with any bits, but none acts. Each fault names parts of
 * the table; Eva loses this relation on the way. In tests/fuzz/simulator_fuzz.c they act.
 */
#include "eva_any.h"
#include "sim/simulator.h"

#define GRIPPERS 2
#define WAFERS 2
#define STATIONS 1

static volatile int64_t time;

static int32_t any_index(size_t count) {
    const int32_t index = integer;
    return wh_is_index(index, count) ? index : WH_NONE;
}

/* -------------------------------------------------------------------------- the grasp table, as it is proved */

static void change_wafers(wh_grasp_t *table) {
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        table->storage.wafers[w].base_from_wafer = any_pose();
        table->storage.wafers[w].holder = any_index(table->storage.gripper_count);
        table->storage.wafers[w].released_by = WH_NONE;
    }
}

static void change_grippers(wh_grasp_t *table) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        wh_gripper_t *gripper = &table->storage.grippers[g];
        gripper->base_from_gripper = any_pose();
        gripper->gripper_from_wafer = any_pose();
        gripper->wafer = any_index(table->storage.wafer_count);
        gripper->valve = any_bool() ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
    }
}

wh_status_t wh_grasp_init(wh_grasp_t *table, const wh_grasp_config_t *config,
                          const wh_grasp_storage_t *storage) {
    if (!config || any_bool()) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    table->config = *config;
    table->storage = *storage;
    table->slice = 0;
    table->counters.refused = word;
    table->mark = WH_GRASP_MARK;
    change_wafers(table);
    change_grippers(table);
    return WH_OK;
}

/* Without a release; the cell's report of a release is asked apart. */
static void add_event(const wh_grasp_t *table, wh_event_list_t *list) {
    const wh_proximity_t measured = {.dr_proj_z = real};
    wh_event_t *event = &list->events[list->count++];
    *event = (wh_event_t){.kind = WH_EVENT_PICKED, .measured = measured};
    event->gripper = any_bool() ? 0 : (int32_t)table->storage.gripper_count - 1;
    event->wafer = any_index(table->storage.wafer_count);
    if (event->wafer == WH_NONE) {
        event->wafer = 0;
    }
}

wh_status_t wh_grasp_step(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    list->count = 0;
    if (inputs[0].valve != WH_VALVE_OPEN && inputs[0].valve != WH_VALVE_CLOSED) {
        return WH_STATUS_BAD_VALVE;
    }
    change_wafers(table);
    change_grippers(table);
    table->slice = word;
    if (any_bool()) {
        add_event(table, list);
    }
    return WH_OK;
}

wh_grasp_config_t wh_grasp_config_default(void) {
    return (wh_grasp_config_t){.tolerance = {real, real, real}};
}

wh_status_t wh_grasp_place(wh_grasp_t *table, size_t wafer, const wh_pose_t *base_from_wafer) {
    if (wafer >= table->storage.wafer_count || any_bool()) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    table->storage.wafers[wafer].base_from_wafer = *base_from_wafer;
    return WH_OK;
}

uint64_t wh_grasp_hash(const wh_grasp_t *table) {
    return table->mark + word;
}

/* ------------------------------------------------------------------------------------------- cell and physics */

static wh_station_t any_station(void) {
    wh_station_t station = {.slots = integer, .pitch = real, .chuck = integer};
    station.base_from_station = any_pose();
    return station;
}

/* A cell that wh_cell_validate accepts. */
static wh_station_t good_station(void) {
    wh_station_t station = any_station();
    station.slots = station.slots >= 1 && station.slots <= 1000 ? station.slots : 1;
    return station;
}

static wh_cell_t any_cell(const wh_station_t *stations, size_t count) {
    wh_cell_t cell = {.stations = stations, .count = count};
    cell.tolerance = (wh_tolerance_t){real, real, real};
    cell.off_centre = real;
    cell.askew = real;
    cell.thickness = real;
    cell.settle = any_bool();
    return cell;
}

static wh_fault_t any_fault(void) {
    wh_fault_t fault = wh_fault_make((wh_fault_kind_t)integer, integer, real, time, time);
    fault.kind = (wh_fault_kind_t)integer;
    fault.target = integer;
    fault.other = integer;
    fault.value = real;
    fault.offset = any_pose();
    fault.from = time;
    fault.until = time;
    return fault;
}

static void call_cell(void) {
    wh_station_t stations[STATIONS];
    for (size_t s = 0; s < STATIONS; ++s) {
        stations[s] = any_station();
    }
    const wh_cell_t any = any_cell(stations, STATIONS);
    const wh_cell_t none = any_cell(NULL, size);
    (void)wh_cell_validate(any_bool() ? &any : NULL, size);
    (void)wh_cell_validate(&none, size);
    for (size_t s = 0; s < STATIONS; ++s) {
        stations[s] = good_station();
    }
    const wh_pose_t wafer = any_pose();
    wh_place_t place;
    if (wh_cell_locate(&any, &wafer, &place)) {
        const wh_pose_t slot = wh_station_slot(&stations[0], place.slot);
        (void)wh_station_measure(&stations[0], place.slot, &slot);
    }
}

/* One release of any wafer, in a list with room for the cell's report, or without room. */
static void call_judge(void) {
    static wh_grasp_t table;
    static wh_wafer_t wafers[WAFERS];
    static wh_gripper_t grippers[GRIPPERS];
    static wh_station_t stations[STATIONS];
    static wh_event_t events[4];
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, NULL, 0};
    const wh_cell_t cell = any_cell(stations, STATIONS);
    wh_event_list_t list = {events, any_bool() ? 4 : 1, 1};
    stations[0] = good_station();
    events[0].kind = WH_EVENT_RELEASED;
    events[0].wafer = any_bool() ? 1 : 0;
    const wh_pose_t now = any_pose();
    const wh_pose_t next = any_pose();
    (void)wh_cell_stops(&cell, &now, &next);
    if (wh_grasp_init(&table, &config, &storage) == WH_OK) {
        (void)wh_cell_judge(&cell, &table, &list);
        wh_cell_settle(&cell, &table, &list);
    }
}

static void fill_physics(wh_physics_t *physics) {
    *physics = wh_physics_default();
    physics->slice_s = real;
    physics->vacuum = (wh_vacuum_config_t){real, real, real, real, real, real, integer};
    physics->pads = (wh_pads_t){real, real, real, real};
    physics->fault_count = size;
    for (size_t i = 0; i < WH_FAULTS; ++i) {
        physics->faults[i] = any_fault();
    }
}

/* A state of any bits, asked for any number of grippers. */
static void fill_state(wh_physics_state_t *state) {
    wh_physics_state_start(state, NULL);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        state->vacuum[g] = (wh_vacuum_t){real, integer, any_bool()};
        state->carry[g] = (wh_carry_t){{{real, real, real}, {real, real, real}}, integer, any_bool()};
        state->told[g] = integer;
    }
    state->faults.count = size;
    for (size_t i = 0; i < WH_FAULTS; ++i) {
        state->faults.slots[i].fault = any_fault();
        state->faults.slots[i].phase = (wh_fault_phase_t)integer;
        state->faults.slots[i].before = any_pose();
        state->faults.slots[i].placed = any_pose();
    }
}

static void call_physics(void) {
    static wh_physics_t physics;
    static wh_physics_state_t state;
    const size_t grippers = size;
    fill_physics(&physics);
    (void)wh_physics_validate(any_bool() ? &physics : NULL, grippers, size);
    fill_state(&state);
    (void)wh_physics_state_validate(any_bool() ? &state : NULL, grippers, size);
    state.faults.count = any_bool() ? WH_FAULTS : 0;
    (void)wh_physics_state_sensors(&state, size);
    (void)wh_faults_plunger(&state.faults, any_bool() ? 0 : WH_GRIPPERS - 1);
    (void)wh_faults_find(&state.faults, (wh_fault_kind_t)integer, integer);
    const wh_fault_t fault = any_fault();
    (void)wh_fault_validate(any_bool() ? &fault : NULL, size, size);
    (void)wh_fault_name((wh_fault_kind_t)integer);
    const wh_fault_request_t requests[2] = {{integer, any_fault()}, {integer, any_fault()}};
    wh_faults_clear(&state.faults);
    (void)wh_faults_check(any_bool() ? &state.faults : NULL, any_bool() ? requests : NULL, any_bool() ? 2 : 0,
                          size, size);
}

/* ------------------------------------------------------------------------------------------------ simulator */

static void fill_command(wh_command_t *command) {
    command->utime = time;
    command->seq = time;
    command->gripper_count = size;
    command->axis_count = size;
    command->fault_count = any_bool() ? 0 : WH_COMMAND_FAULTS + 1;
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        command->grippers[g].base_from_gripper = any_pose();
        command->grippers[g].valve = integer;
    }
    for (size_t i = 0; i < WH_COMMAND_FAULTS; ++i) {
        command->faults[i].index = integer;
        command->faults[i].fault = any_fault();
    }
}

static void call_simulator(wh_simulator_t *simulator) {
    static wh_command_t command;
    static wh_physics_t physics;
    wh_state_t state;
    while (any_bool()) {
        fill_command(&command);
        (void)wh_simulator_step(any_bool() ? simulator : NULL, any_bool() ? &command : NULL,
                                any_bool() ? &state : NULL);
        (void)simulator->link.exchange(&simulator->link, &command, &state);
        (void)simulator->link.missed(&simulator->link);
        (void)simulator->link.hash(&simulator->link);
        (void)wh_physics_state_hash(&simulator->physics, &simulator->table);
        wh_simulator_view(simulator, &state);
        if (any_bool()) {
            fill_physics(&physics);
            physics.fault_count = any_bool() ? 0 : WH_FAULTS + 1;
            (void)wh_simulator_set_physics(any_bool() ? simulator : NULL, any_bool() ? &physics : NULL);
        }
    }
}

/* A simulator of zeroes, or one that wh_simulator_init refuses. */
static void call_blank(void) {
    static wh_simulator_t blank;
    static wh_command_t command;
    wh_state_t state;
    fill_command(&command);
    (void)wh_simulator_step(&blank, &command, &state);
    wh_simulator_view(&blank, &state);
    (void)wh_simulator_hash(&blank);
}

int main(void) {
    static wh_simulator_t simulator;
    static wh_wafer_t wafers[WAFERS];
    static wh_gripper_t grippers[GRIPPERS];
    static wh_station_t stations[STATIONS];
    for (size_t s = 0; s < STATIONS; ++s) {
        stations[s] = good_station();
    }
    const wh_cell_t cell = any_cell(stations, STATIONS);
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, NULL, 0};
    call_cell();
    call_judge();
    call_physics();
    call_blank();
    if (wh_simulator_init(any_bool() ? &simulator : NULL, any_bool() ? &config : NULL,
                          any_bool() ? &storage : NULL, any_bool() ? &cell : NULL) == WH_OK) {
        (void)wh_simulator_set_strict(any_bool() ? &simulator : NULL, any_bool());
        call_simulator(&simulator);
    }
    return 0;
}
