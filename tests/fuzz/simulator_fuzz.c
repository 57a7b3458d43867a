/* Any bytes as a cell, physics and commands, to the public calls of lib/cell and lib/sim. Arrays
 * are as long as their counts say, in memory of their own, so that the sanitizer sees each read
 * beyond them.
 *
 * A refused call changes nothing. wh_simulator_init accepts the same cells as wh_cell_validate.
 * After each step that is not refused the table is consistent and poses are rotations. A second
 * simulator takes over the state with the same hash, and this one keeps step with the first. */
#include <math.h>
#include <string.h>

#include "fuzz.h"
#include "grasp/edge.h"
#include "grasp/grips.h"
#include "grasp/passive.h"
#include "grasp/restore.h"
#include "math/trig.h"
#include "sim/simulator.h"

#define WAFERS 6
#define GRIPPERS (WH_GRIPPERS + 2)
#define STATIONS 4

/* ------------------------------------------------------------------------------------------- reading bytes */

typedef struct {
    const uint8_t *at;
    size_t left;
} bytes_t;

static void take(bytes_t *in, void *to, size_t size) {
    const size_t count = size < in->left ? size : in->left;
    memset(to, 0, size);
    memcpy(to, in->at, count);
    in->at += count;
    in->left -= count;
}

static uint8_t take_byte(bytes_t *in) {
    uint8_t byte;
    take(in, &byte, 1);
    return byte;
}

static double take_bits(bytes_t *in) {
    double value;
    take(in, &value, sizeof value);
    return value;
}

/* Mostly a pose that a cell may have, near another one; now and then any pose. */
static double take_real(bytes_t *in) {
    static const double known[] = {0,          0.1,   -0.1,    0.4,      0.6,
                                   1,          5,     10,      50,       100,
                                   700,        -700,  3600,    1e6,      1.1e6,
                                   -1e6,       1e3,   1e-9,    5e-324,   1e155,
                                   1e18,       1e300, DBL_MAX, -DBL_MAX, (double)INFINITY,
                                   (double)NAN};
    const uint8_t kind = take_byte(in);
    if (kind < 128) {
        return (kind - 64) * 0.125;
    }
    return kind == 255 ? take_bits(in) : known[kind % (sizeof known / sizeof known[0])];
}

static int32_t take_int(bytes_t *in) {
    const uint8_t byte = take_byte(in);
    int32_t any;
    if (byte < 250) {
        return byte % 12 - 1;
    }
    take(in, &any, sizeof any);
    return any;
}

/* Around the first station, level or turned; now and then an invalid pose. */
static wh_pose_t take_pose(bytes_t *in) {
    wh_pose_t pose = wh_pose_identity();
    const uint8_t kind = take_byte(in);
    if (kind % 4 == 1) {
        pose.R = wh_mat3_from_rpy_deg(take_real(in), take_real(in), take_real(in));
    } else if (kind == 254) {
        take(in, &pose, sizeof pose);
    }
    pose.r = wh_vec3(take_real(in), take_real(in), take_real(in));
    return pose;
}

/* ----------------------------------------------------------------------------------------------- the input */

static wh_station_t take_station(bytes_t *in) {
    wh_station_t station = {.base_from_station = take_pose(in), .slots = 1 + take_byte(in) % 30};
    station.pitch = take_byte(in) % 8 ? 10 : take_real(in);
    station.chuck = take_byte(in) % 8 ? WH_NONE : take_int(in);
    if (take_byte(in) == 77) {
        station.slots = take_int(in) - 1;
    }
    return station;
}

static wh_grasp_config_t take_config(bytes_t *in) {
    wh_grasp_config_t config = wh_grasp_config_default();
    const uint8_t kind = take_byte(in);
    config.check = kind & 1 ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED;
    config.seat = (kind & 2) != 0;
    if (kind > 250) {
        config.tolerance = (wh_tolerance_t){take_real(in), take_real(in), take_real(in)};
        config.near_projz = take_real(in);
    }
    return config;
}

static wh_fault_t take_fault(bytes_t *in) {
    wh_fault_t fault = {.other = WH_NONE, .offset = wh_pose_identity(), .until = WH_FAULT_FOREVER};
    const uint8_t kind = take_byte(in);
    fault.kind = (wh_fault_kind_t)(kind % (WH_FAULT_KINDS + 1));
    fault.target = take_int(in);
    fault.from = 1 + take_byte(in) % 16;
    if (kind & 64) {
        fault.until = take_byte(in);
    }
    if (kind & 128) {
        fault.value = take_real(in);
        fault.other = take_int(in);
        fault.offset = take_pose(in);
    }
    return fault;
}

static wh_physics_t take_physics(bytes_t *in) {
    wh_physics_t physics = wh_physics_default();
    const uint8_t kind = take_byte(in);
    if (kind & 1) {
        physics.vacuum = wh_vacuum_delayed();
    }
    if (kind & 2) {
        physics.pads = (wh_pads_t){take_real(in), take_real(in), take_real(in), 9.81};
    }
    if (kind & 4) {
        physics.vacuum.build = take_real(in);
        physics.slice_s = take_real(in);
    }
    physics.fault_count = kind & 8 ? take_byte(in) % (WH_FAULTS + 2) : 0;
    for (size_t i = 0; i < physics.fault_count && i < WH_FAULTS; ++i) {
        physics.faults[i] = take_fault(in);
    }
    return physics;
}

static wh_scan_order_t take_order(bytes_t *in) {
    wh_scan_order_t order;
    memset(&order, 0, sizeof order);
    order.kind = (wh_scan_order_kind_t)(take_byte(in) % 4);
    order.gripper = take_byte(in) % 4;
    order.count = take_int(in);
    take(in, &order.first, sizeof order.first);
    order.first %= order.count & 1 ? 10000 : INT64_MAX;
    return order;
}

static wh_command_t take_command(bytes_t *in, size_t gripper_count, int64_t seq) {
    wh_command_t command;
    memset(&command, 0, sizeof command);
    const uint8_t kind = take_byte(in);
    command.seq = seq;
    if (kind == 255) {
        take(in, &command.seq, sizeof command.seq);
    }
    command.utime = 1000 * seq;
    command.gripper_count = kind == 254 ? take_byte(in) : gripper_count;
    for (size_t g = 0; g < WH_GRIPPERS && g < gripper_count; ++g) {
        command.grippers[g].base_from_gripper = take_pose(in);
        command.grippers[g].valve = take_byte(in) % 16 == 15 ? take_int(in) : kind >> (g % 4) & 1;
    }
    if (kind & 64) {
        command.scan = take_order(in);
    }
    command.fault_count = kind & 32 ? take_byte(in) % (WH_COMMAND_FAULTS + 2) : 0;
    for (size_t i = 0; i < command.fault_count && i < WH_COMMAND_FAULTS; ++i) {
        command.faults[i].index = take_int(in);
        command.faults[i].fault = take_fault(in);
    }
    return command;
}

/* --------------------------------------------------------------------------------------------- properties */

/* A simulator and its arrays. */
typedef struct {
    wh_simulator_t simulator;
    wh_state_t state;
    wh_wafer_t *wafers;
    wh_gripper_t *grippers;
    uint32_t *buckets;
    wh_grasp_storage_t storage;
} run_t;

static run_t first, second;

static void *memory(size_t count, size_t size) {
    void *const allocated = calloc(count > 0 ? count : 1, size);
    REQUIRE(allocated != NULL);
    return allocated;
}

static void begin_run(run_t *run, size_t wafer_count, size_t gripper_count, bool indexed) {
    memset(run, 0, sizeof *run);
    run->wafers = memory(wafer_count, sizeof *run->wafers);
    run->grippers = memory(gripper_count, sizeof *run->grippers);
    const size_t buckets = indexed ? wh_grasp_buckets(wafer_count, gripper_count) : 0;
    run->buckets = memory(buckets, sizeof *run->buckets);
    run->storage = (wh_grasp_storage_t){
        run->wafers, wafer_count, run->grippers, gripper_count, indexed ? run->buckets : NULL, buckets};
}

static void end_run(run_t *run) {
    free(run->wafers);
    free(run->grippers);
    free(run->buckets);
}

/* A simulator that nobody has set up. */
static void check_blank(const wh_command_t *command) {
    static wh_simulator_t blank;
    wh_state_t state;
    REQUIRE(wh_simulator_step(&blank, command, &state) == WH_STATUS_NOT_INITIALISED);
    REQUIRE(state.status == WH_STATUS_NOT_INITIALISED && state.wafer_count == 0 && state.gripper_count == 0);
    REQUIRE(wh_simulator_hash(&blank) == 0);
}

static void check_places(const wh_cell_t *cell, const run_t *run) {
    for (size_t w = 0; w < run->storage.wafer_count; ++w) {
        wh_place_t place;
        if (wh_cell_locate(cell, &run->wafers[w].base_from_wafer, &place)) {
            REQUIRE(wh_is_index(place.station, cell->count));
            const wh_station_t *station = &cell->stations[place.station];
            REQUIRE(place.slot >= 1 && place.slot <= station->slots);
            REQUIRE(fabs(place.dz) < station->pitch / 2 && place.tilt >= 0 && place.tilt < 1.6);
            REQUIRE(hypot(place.dx, place.dy) <= cell->tolerance.projxy * (1 + 1e-9));
        }
    }
}

/* The rule of grasp/event.h: an index is valid, or WH_NONE. */
static void check_events(const run_t *run) {
    REQUIRE(run->state.event_count <= WH_SLICE_EVENTS);
    for (size_t i = 0; i < run->state.event_count; ++i) {
        const wh_event_t *event = &run->state.events[i];
        const bool of_wafers =
            event->kind == WH_EVENT_SLOT_OCCUPIED || event->kind == WH_EVENT_PUSHED_THROUGH;
        REQUIRE(strcmp(wh_event_name(event->kind), "unknown") != 0);
        REQUIRE(event->wafer == WH_NONE || wh_is_index(event->wafer, run->storage.wafer_count));
        REQUIRE(event->gripper == WH_NONE || wh_is_index(event->gripper, run->storage.gripper_count));
        REQUIRE(event->other == WH_NONE ||
                wh_is_index(event->other, of_wafers ? run->storage.wafer_count : run->storage.gripper_count));
        REQUIRE(wh_real_is_finite(event->value) && wh_real_is_finite(event->measured.dr_proj_z));
    }
}

static void check_state(const wh_cell_t *cell, const run_t *run) {
    const wh_grasp_t *table = &run->simulator.table;
    REQUIRE(wh_grasp_is_consistent(table));
    for (size_t w = 0; w < run->storage.wafer_count; ++w) {
        REQUIRE(wh_pose_validate(&run->wafers[w].base_from_wafer) == WH_OK);
    }
    REQUIRE(wh_physics_state_validate(&run->simulator.physics, run->storage.gripper_count,
                                      run->storage.wafer_count) == WH_OK);
    REQUIRE(run->state.sensors >> run->storage.gripper_count == 0);
    check_places(cell, run);
    check_events(run);
}

/* More grippers than there is room for are refused, whatever the state is. */
static void check_counts(const wh_physics_state_t *physics, size_t gripper_count, size_t wafer_count) {
    wh_physics_state_t *const alone = memory(1, sizeof *alone);
    memcpy(alone, physics, sizeof *alone);
    const wh_status_t status = wh_physics_state_validate(alone, gripper_count, wafer_count);
    REQUIRE((gripper_count <= WH_GRIPPERS) != (status == WH_STATUS_BAD_CAPACITY));
    REQUIRE(wh_physics_state_sensors(alone, gripper_count) >> WH_GRIPPERS == 0);
    free(alone);
}

/* ------------------------------------------------------------------------------------------------ running */

/* The second simulator takes over the state of the first one. */
static void hand_over(void) {
    REQUIRE(wh_grasp_restore(&second.simulator.table, first.simulator.table.slice, first.wafers,
                             first.grippers) == WH_OK);
    memcpy(&second.simulator.physics, &first.simulator.physics, sizeof first.simulator.physics);
    REQUIRE(wh_simulator_hash(&second.simulator) == wh_simulator_hash(&first.simulator));
}

/* True if the step was accepted. A refused one leaves wafers, grippers and physics unchanged, byte
 * for byte. */
static bool step(run_t *run, const wh_command_t *command) {
    static wh_wafer_t wafers[WAFERS];
    static wh_gripper_t grippers[GRIPPERS];
    static wh_physics_state_t physics;
    const uint64_t hash = wh_simulator_hash(&run->simulator);
    const uint64_t slice = run->simulator.table.slice;
    const size_t wafer_bytes = run->storage.wafer_count * sizeof *wafers;
    const size_t gripper_bytes = run->storage.gripper_count * sizeof *grippers;
    memcpy(wafers, run->wafers, wafer_bytes);
    memcpy(grippers, run->grippers, gripper_bytes);
    memcpy(&physics, &run->simulator.physics, sizeof physics);
    const wh_status_t status = wh_simulator_step(&run->simulator, command, &run->state);
    REQUIRE(run->state.status == status && run->state.seq == command->seq);
    REQUIRE(run->simulator.table.slice == slice + (status == WH_OK ? 1 : 0));
    if (status != WH_OK) {
        REQUIRE(wh_simulator_hash(&run->simulator) == hash);
        REQUIRE(memcmp(wafers, run->wafers, wafer_bytes) == 0);
        REQUIRE(memcmp(grippers, run->grippers, gripper_bytes) == 0);
        REQUIRE(memcmp(&physics, &run->simulator.physics, sizeof physics) == 0);
    }
    return status == WH_OK;
}

static void run_commands(bytes_t *in, const wh_cell_t *cell) {
    for (int64_t seq = 1; in->left > 0 && seq < 100; ++seq) {
        const wh_command_t command = take_command(in, first.storage.gripper_count, seq);
        const bool taken = step(&first, &command);
        REQUIRE(step(&second, &command) == taken && first.state.status == second.state.status);
        REQUIRE(wh_simulator_hash(&first.simulator) == wh_simulator_hash(&second.simulator));
        REQUIRE(first.state.event_count == second.state.event_count);
        REQUIRE(first.state.sensors == second.state.sensors);
        check_state(cell, &first);
        if (seq % 4 == 0) {
            hand_over();
            check_counts(&first.simulator.physics, take_byte(in), first.storage.wafer_count);
        }
    }
}

/* An edge sensor at the last gripper; base is the station. */
static void set_up_scanning(run_t *run) {
    static wh_rim_t rim;
    static const wh_rim_t *rims[WAFERS];
    static wh_scanner_t scanner;
    const size_t grippers = run->storage.gripper_count;
    rim = wh_rim_nominal(150);
    for (size_t w = 0; w < WAFERS; ++w) {
        rims[w] = &rim;
    }
    scanner = (wh_scanner_t){wh_sensor_nominal(150), (int32_t)grippers - 1, 1, wh_pose_identity()};
    scanner.sensor.noise = 0.01;
    const wh_scanning_t scanning = {&scanner, grippers > 0 ? 1 : 0, rims};
    REQUIRE(wh_simulator_set_scanning(&run->simulator, &scanning) == WH_OK);
}

/* Vacuum that sees front faces, if the cell has a thickness. */
static void set_up_grips(run_t *run, const wh_cell_t *cell) {
    static const wh_grip_t vacuum[WH_GRIPPERS];
    static wh_grip_state_t states[WH_GRIPPERS];
    static wh_wafer_t seen[WAFERS];
    const wh_grips_parts_t parts = {
        .thickness = cell->thickness, .dt = 0.001, .grips = vacuum, .states = states, .seen = seen};
    if (cell->thickness > 0) {
        REQUIRE(wh_simulator_set_grips(&run->simulator, &parts) == WH_OK);
    }
}

static wh_status_t set_up(run_t *run, const wh_grasp_config_t *config, const wh_cell_t *cell,
                          const wh_physics_t *physics) {
    static wh_simulator_t before;
    memcpy(&before, &run->simulator, sizeof before);
    run->storage.bucket_count = cell->thickness > 0 ? 0 : run->storage.bucket_count;
    const wh_status_t status = wh_simulator_init(&run->simulator, config, &run->storage, cell);
    if (status != WH_OK) {
        REQUIRE(memcmp(&before, &run->simulator, sizeof before) == 0);
        return status;
    }
    REQUIRE(wh_cell_validate(cell, run->storage.gripper_count) == WH_OK);
    set_up_scanning(run);
    set_up_grips(run, cell);
    const uint64_t hash = wh_simulator_hash(&run->simulator);
    const wh_status_t refusal = wh_simulator_set_physics(&run->simulator, physics);
    const wh_status_t validity =
        wh_physics_validate(physics, run->storage.gripper_count, run->storage.wafer_count);
    /* With grips it also refuses slices of another length than theirs. */
    REQUIRE(refusal == validity ||
            (cell->thickness > 0 && validity == WH_OK && refusal == WH_STATUS_OUT_OF_RANGE &&
             wh_real_abs(physics->slice_s - WH_SLICE_S) > 0));
    REQUIRE(refusal == WH_OK || wh_simulator_hash(&run->simulator) == hash);
    return WH_OK;
}

static wh_cell_t take_cell(bytes_t *in, wh_station_t stations[], size_t count) {
    wh_cell_t cell = {.stations = stations, .count = count, .tolerance = wh_tolerance_paper()};
    const uint8_t kind = take_byte(in);
    cell.settle = (kind & 1) != 0;
    cell.off_centre = kind & 2 ? 1 : 0;
    cell.askew = kind & 4 ? 0.01 : 0;
    cell.thickness = kind & 8 ? 0.775 : 0;
    if (kind > 250) {
        cell.tolerance = (wh_tolerance_t){take_real(in), take_real(in), take_real(in)};
        cell.off_centre = take_real(in);
        cell.askew = take_real(in);
        cell.thickness = take_real(in);
    }
    for (size_t s = 0; s < count; ++s) {
        stations[s] = take_station(in);
    }
    return cell;
}

/* ------------------------------------------------------------------------------------------- the grips beside the table */

/* Numbers near valid ones, or any numbers. */
static void take_doubles(bytes_t *in, double *numbers[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        *numbers[i] += take_byte(in) < 200 ? (take_byte(in) - 128) / 1024.0 : take_real(in);
    }
}

static void check_edge(bytes_t *in) {
    wh_edge_t edge = wh_edge_default(take_byte(in) < 128 ? 150 : 100);
    wh_edge_wafer_t wafer = wh_edge_wafer_nominal(edge.radius);
    wh_edge_place_t place;
    wh_edge_place_t before;
    double s = take_byte(in) / 16.0 - 8;
    double *numbers[] = {&edge.rest, &edge.alpha, &edge.clearance, &edge.gripped_to, &wafer.radius,
                         &wafer.x,   &wafer.y,    &wafer.depth,    &wafer.opening,   &wafer.bottom,
                         &s};
    take_doubles(in, numbers, sizeof numbers / sizeof numbers[0]);
    memset(&place, 0, sizeof place);
    before = place;
    if (wh_edge_at(&edge, &wafer, s, &place) != WH_OK) {
        REQUIRE(memcmp(&place, &before, sizeof place) == 0);
        return;
    }
    REQUIRE(fabs(place.x) < 60 && fabs(place.y) < 60 && place.s <= edge.end && place.s <= s);
    REQUIRE(!place.held || (place.phase == WH_EDGE_SEATED && place.window == WH_EDGE_GRIPPED));
    REQUIRE((place.excess > 0) == (place.phase == WH_EDGE_JAMMED));
}

static void check_passive(bytes_t *in) {
    const wh_passive_t passive = {wh_tolerance_paper(), (wh_check_t)(take_byte(in) % 3),
                                  WH_REAL(take_real(in))};
    const wh_pose_t begin = take_pose(in);
    const wh_pose_t end = take_pose(in);
    const wh_pose_t support = take_pose(in);
    wh_passive_wafer_t wafer = {take_pose(in), take_pose(in), take_byte(in) % 2 == 0};
    const wh_passive_wafer_t before = wafer;
    wh_passive_change_t change = WH_PASSIVE_STAYS;
    if (wh_passive_step(&passive, &begin, &end, &support, &wafer, &change) != WH_OK) {
        REQUIRE(memcmp(&wafer.base_from_wafer, &before.base_from_wafer, sizeof wafer.base_from_wafer) == 0);
        REQUIRE(wafer.carried == before.carried);
        return;
    }
    REQUIRE(wh_mat3_is_orthonormal(&wafer.base_from_wafer.R));
    REQUIRE(wafer.carried == (change == WH_PASSIVE_TAKEN || (before.carried && change == WH_PASSIVE_STAYS)));
}

/* Any grips, any poses: a refused step changes nothing, and after each accepted one the table is
 * consistent. */
static void check_grips(bytes_t *in) {
    enum { MIXED = 2 };
    wh_wafer_t wafers[MIXED] = {0};
    wh_wafer_t seen[MIXED];
    wh_gripper_t grippers[MIXED];
    wh_grip_state_t states[MIXED];
    wh_event_t events[WH_EVENTS_PER_GRIPPER * MIXED];
    wh_event_list_t list = {events, WH_EVENTS_PER_GRIPPER * MIXED, 0};
    wh_gripper_input_t inputs[MIXED];
    wh_grip_t kinds[MIXED];
    wh_edge_wafer_t shapes[MIXED];
    for (size_t i = 0; i < MIXED; ++i) {
        wafers[i].base_from_wafer = take_pose(in);
        kinds[i].kind = (wh_grip_kind_t)(take_byte(in) % 4);
        kinds[i].edge = wh_edge_default(150);
        shapes[i] = wh_edge_wafer_nominal(150 + (take_byte(in) - 128) / 256.0);
    }
    const wh_pose_t support = take_pose(in);
    const wh_grips_parts_t parts = {
        WH_REAL(0.775), take_byte(in) / 256.0, kinds, shapes, &support, 1, states, seen, NULL};
    const wh_grasp_storage_t storage = {wafers, MIXED, grippers, MIXED, NULL, 0};
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = (wh_check_t)(take_byte(in) % 2);
    wh_grasp_t table;
    wh_grips_t grips;
    if (wh_grasp_init(&table, &config, &storage) != WH_OK || wh_grips_init(&grips, &parts, &table) != WH_OK) {
        return;
    }
    for (int step = 0; step < 8; ++step) {
        const uint64_t before = wh_grips_hash(&grips);
        for (size_t g = 0; g < MIXED; ++g) {
            inputs[g].base_from_gripper = take_pose(in);
            inputs[g].valve = take_byte(in) % 3;
        }
        const wh_status_t status = wh_grips_step(&grips, inputs, &list);
        REQUIRE(status == WH_OK || wh_grips_hash(&grips) == before);
        REQUIRE(wh_grasp_is_consistent(&table));
        REQUIRE(wh_grips_support(&grips, 0) == WH_NONE || wafers[0].holder == WH_NONE);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bytes_t in = {data, size};
    const size_t wafer_count = take_byte(&in) % (WAFERS + 1);
    const uint8_t counts = take_byte(&in);
    const size_t gripper_count = counts % (GRIPPERS + 1);
    const size_t station_count = take_byte(&in) % (STATIONS + 1);
    wh_station_t *const stations = memory(station_count, sizeof *stations);
    const wh_cell_t cell = take_cell(&in, stations, station_count);
    const wh_grasp_config_t config = take_config(&in);
    const wh_physics_t physics = take_physics(&in);
    begin_run(&first, wafer_count, gripper_count, counts >= 128);
    begin_run(&second, wafer_count, gripper_count, counts < 128);
    for (size_t w = 0; w < wafer_count; ++w) {
        first.wafers[w].base_from_wafer = second.wafers[w].base_from_wafer = take_pose(&in);
    }
    const wh_status_t status = set_up(&first, &config, &cell, &physics);
    REQUIRE(set_up(&second, &config, &cell, &physics) == status);
    if (status == WH_OK) {
        run_commands(&in, &cell);
    } else {
        const wh_command_t command = take_command(&in, gripper_count, 1);
        check_blank(&command);
    }
    check_edge(&in);
    check_passive(&in);
    check_grips(&in);
    end_run(&first);
    end_run(&second);
    free(stations);
    return 0;
}
