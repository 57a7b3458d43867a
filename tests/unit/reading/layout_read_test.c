/* Layouts: every field's default and unit, and the refusals with their texts. */
#include "support/layout.h"

#include "layout/axes.h"
#include "layout/layout.h"
#include "math/status.h"
#include "math/trig.h"

#define GRIPPERS "grippers = { { name = 'EE' } }, "
#define STATIONS "stations = { A = { at = { 700, 0, 900 } } }, "

static void defaults_of_the_cell(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(GRIPPERS STATIONS);
    assert_string_equal(layout->path, "cell.lua");
    assert_string_equal(layout->tolerance_name, "paper");
    assert_near(layout->wafer_diameter, 300, 0);
    assert_near(layout->wafer_thickness, 0.775, 0);
    assert_near(layout->grasp.tolerance.projz, 0.5, 0);
    assert_near(layout->grasp.tolerance.projxy, 50, 0);
    assert_near(layout->grasp.tolerance.planar, 0.99, 0);
    assert_near(layout->grasp.near_projz, 4.5, 0);
    assert_near(layout->grasp.near_projxy, 100, 0);
    assert_int_equal(layout->grasp.check, WH_CHECK_SAMPLED);
    assert_false(layout->grasp.seat);
    assert_int_equal(layout->slice_us, 1000);
    assert_int_equal(layout->wafer_count, 0);
}

static void the_default_robot(void **state) {
    (void)state;
    wh_robot_t robot;
    wh_robot_default(&robot);
    const wh_machine_t *machine = &read_sound(GRIPPERS STATIONS)->machine;
    assert_memory_equal(&machine->robot, &robot, sizeof robot);
    assert_memory_equal(&machine->chuck_limits, &robot.limits[WH_AXIS_YAW], sizeof machine->chuck_limits);
    assert_int_equal(machine->axis_count, WH_ROBOT_AXES);
    assert_int_equal(machine->gripper_count, 1);
    assert_int_equal(machine->mounts[0].axis, WH_NONE);
    /* If they are written out, they make the same robot. */
    assert_null(machine->carrier);
    machine =
        &read_sound(GRIPPERS STATIONS "robot = { kind = 'TRZY', at = { 0, 0, 0 }, heading = 0 }")->machine;
    assert_null(machine->carrier);
    machine = &read_sound(GRIPPERS STATIONS "robot = { heading = 0.1 }")->machine;
    assert_non_null(machine->carrier);
}

static void defaults_of_a_station(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(GRIPPERS STATIONS);
    const wh_layout_station_t *station = &layout->stations[0];
    const wh_station_t *place = &layout->places[0];
    assert_int_equal(layout->station_count, 1);
    assert_string_equal(station->name, "A");
    assert_false(station->prealigner);
    assert_near(station->stroke, 6, 0);
    assert_near(station->offset, 3, 0);
    assert_near(station->retract, 300, 0);
    assert_near(station->pickup_speed, 20, 0);
    assert_near(station->release, -0.25, 0);
    assert_near(station->vacuum_delay, 0, 0);
    assert_near(station->timeout, 0.25, 0);
    assert_int_equal(station->handover, WH_HANDOVER_NEW_FIRST);
    assert_int_equal(place->slots, 1);
    assert_near(place->pitch, 10, 0);
    assert_int_equal(place->chuck, WH_NONE);
    const wh_pose_t level = {wh_mat3_identity(), {700, 0, 900}};
    assert_memory_equal(&place->base_from_station, &level, sizeof level);
}

static void defaults_that_follow_other_fields(void **state) {
    (void)state;
    static const struct {
        const char *diameter;
        double thickness, pitch;
    } rows[] = {{"100", 0.525, 4.76}, {"125", 0.625, 4.76}, {"150", 0.675, 4.76},
                {"200", 0.725, 6.35}, {"300", 0.775, 10},   {"299.5", 0.775, 10}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        char fields[200];
        snprintf(fields, sizeof fields, GRIPPERS STATIONS "wafer = { diameter = %s }", rows[i].diameter);
        const wh_layout_t *layout = read_sound(fields);
        assert_near(layout->wafer_thickness, rows[i].thickness, 0);
        assert_near(layout->places[0].pitch, rows[i].pitch, 0);
    }
    assert_near(read_sound(GRIPPERS STATIONS "seat = true")->stations[0].release, 0, 0);
    const wh_layout_t *layout = read_sound(GRIPPERS STATIONS "tolerance = { projz = 0.4, projxy = 7 }");
    assert_string_equal(layout->tolerance_name, "own");
    assert_near(layout->stations[0].release, -0.2, 0);
    assert_near(layout->grasp.near_projxy, 14, 0);
    assert_near(layout->grasp.tolerance.planar, 0.99, 0);
    assert_true(layout->tolerance_default[2] && !layout->tolerance_default[0] &&
                !layout->tolerance_default[1]);
}

static void only_wafers_from_200_mm_on_have_a_notch_by_themselves(void **state) {
    (void)state;
    assert_near(read_sound(GRIPPERS STATIONS "wafer = { diameter = 200 }")->notch_depth, 1, 0);
    assert_near(read_sound(GRIPPERS STATIONS "wafer = { diameter = 150 }")->notch_depth, 0, 0);
    assert_near(read_sound(GRIPPERS STATIONS "wafer = { diameter = 150, notch = {} }")->notch_depth, 1, 0);
}

static void every_field_of_the_cell_is_read(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(GRIPPERS STATIONS
                   "wafer = { diameter = 200, thickness = 0.7 }, tolerance = 'strict', check = 'swept', "
                   "near = { projz = 3, projxy = 60 }, slice = 0.00025, seat = true, collision = false");
    assert_near(layout->wafer_thickness, 0.7, 0);
    assert_string_equal(layout->tolerance_name, "strict");
    assert_near(layout->grasp.tolerance.projxy, 5, 0);
    assert_int_equal(layout->grasp.check, WH_CHECK_SWEPT);
    assert_near(layout->grasp.near_projz, 3, 0);
    assert_near(layout->grasp.near_projxy, 60, 0);
    assert_int_equal(layout->slice_us, 250);
    assert_true(layout->grasp.seat);
}

static void degrees_become_radians_and_lengths_stay(void **state) {
    (void)state;
    const wh_machine_t *machine =
        &read_sound(GRIPPERS STATIONS
                    "robot = { kind = 'TRZY', theta = { min = -90, max = 180, home = 45, speed = 30, "
                    "acceleration = 60, jerk = 600 }, r = { min = 200, max = 800, home = 250, speed = 500 }, "
                    "z = { home = 1000 } }, chuck = { speed = 90, acceleration = 180, jerk = 360 }")
             ->machine;
    const wh_travel_t *theta = &machine->robot.travel[WH_AXIS_THETA];
    assert_near(theta->min, -WH_PI / 2, 1e-15);
    assert_near(theta->max, WH_PI, 0);
    assert_near(machine->robot.home[WH_AXIS_THETA], WH_PI / 4, 1e-15);
    assert_near(machine->robot.limits[WH_AXIS_THETA].speed, WH_PI / 6, 1e-15);
    assert_near(machine->robot.limits[WH_AXIS_THETA].acceleration, WH_PI / 3, 1e-15);
    assert_near(machine->robot.limits[WH_AXIS_THETA].jerk, 10 * WH_PI / 3, 1e-14);
    assert_near(machine->robot.travel[WH_AXIS_R].min, 200, 0);
    assert_near(machine->robot.limits[WH_AXIS_R].speed, 500, 0);
    assert_near(machine->robot.limits[WH_AXIS_R].jerk, 50000, 0);
    assert_near(machine->robot.home[WH_AXIS_Z], 1000, 0);
    assert_near(machine->chuck_limits.speed, WH_PI / 2, 1e-15);
    assert_near(machine->chuck_limits.jerk, 2 * WH_PI, 1e-15);
}

static void every_field_of_a_station_is_read(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        "grippers = { { name = 'EE', on = 'robot', valve = 'v[0]' }, { name = 'PA', on = 'P' } }, "
        "stations = { Q = { at = { 700, 1, 900 }, rpy = { 0, 0, 90 }, slots = 13, pitch = 7, stroke = 8, "
        "offset = 2, retract = 250, pickup_speed = 15, release = -1, vacuum_delay = 0.1, timeout = 0.5, "
        "handover = 'same_slice' }, P = { kind = 'prealigner', at = { -600, 0, 950 } } }");
    assert_string_equal(layout->stations[0].name, "P");
    assert_true(layout->stations[0].prealigner);
    assert_int_equal(layout->places[0].chuck, 1);
    const wh_layout_station_t *station = &layout->stations[1];
    assert_string_equal(station->name, "Q");
    assert_int_equal(layout->places[1].slots, 13);
    assert_near(layout->places[1].pitch, 7, 0);
    assert_near(layout->places[1].base_from_station.R.m[1][0], 1, 0);
    assert_near(station->stroke, 8, 0);
    assert_near(station->offset, 2, 0);
    assert_near(station->retract, 250, 0);
    assert_near(station->pickup_speed, 15, 0);
    assert_near(station->release, -1, 0);
    assert_near(station->vacuum_delay, 0.1, 0);
    assert_near(station->timeout, 0.5, 0);
    assert_int_equal(station->handover, WH_HANDOVER_SAME_SLICE);
    assert_string_equal(layout->grippers[0].valve, "v[0]");
    assert_string_equal(layout->grippers[1].valve, "PA.valve");
    assert_int_equal(layout->grippers[1].station, 0);
    assert_int_equal(layout->machine.mounts[1].axis, WH_ROBOT_AXES);
    assert_int_equal(layout->machine.axis_count, 5);
    assert_int_equal(wh_layout_find_station(layout, "Q"), 1);
    assert_int_equal(wh_layout_find_station(layout, "q"), WH_NONE);
    assert_int_equal(wh_layout_find_gripper(layout, "PA"), 1);
}

/* A gripper without a place, or with the statement that it has none, is the end-effector: its
 * layout's hash is unchanged. */
static void what_a_station_asks_of_a_command_is_read(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        "homed = false, grippers = { { name = 'PA', on = 'P' }, { name = 'LOW' }, { name = 'HIGH' } }, "
        "stations = { P = { kind = 'prealigner', at = { -600, 0, 950 } }, "
        "Q = { at = { 700, 0, 900 }, taught = false, effector = 'HIGH', pickup_acceleration = 250, "
        "vacuum_check = 'put', retries = 3, wait = 0.5, map_speed = 80, check_map = true } }");
    const wh_layout_station_t *plain = &layout->stations[0];
    const wh_layout_station_t *station = &layout->stations[1];
    assert_false(layout->homed);
    assert_true(plain->taught);
    assert_false(plain->check_map);
    assert_int_equal(plain->effector, 1);
    assert_int_equal(plain->check, WH_VACUUM_CHECK_BOTH);
    assert_int_equal(plain->retries, 0);
    assert_near(plain->pickup_acceleration, 0, 0);
    assert_near(plain->wait, 0, 0);
    assert_near(plain->map_speed, 100, 0);
    assert_false(station->taught);
    assert_true(station->check_map);
    assert_int_equal(station->effector, 2);
    assert_int_equal(station->check, WH_VACUUM_CHECK_PUT);
    assert_int_equal(station->retries, 3);
    assert_near(station->pickup_acceleration, 250, 0);
    assert_near(station->wait, 0.5, 0);
    assert_near(station->map_speed, 80, 0);
}

static void assert_counting(const char *stations, const char *wanted) {
    char fields[2048];
    char counting[256] = "";
    (void)snprintf(fields, sizeof fields,
                   "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { "
                   "P = { kind = 'prealigner', at = { -600, 0, 900 } }, %s }",
                   stations);
    const wh_layout_t *layout = read_sound(fields);
    for (size_t s = 0; s < layout->station_count; ++s) {
        strcat(counting, layout->stations[s].counts ? layout->stations[s].name : "");
    }
    assert_string_equal(counting, wanted);
}

/* For stations that do not say it: FOUPs, else several slots, else one slot; a chuck only if it says so. */
static void stations_count_where_wafers_end_up_unless_they_say_it(void **state) {
    (void)state;
#define AT "at = { 700, 0, 900 }"
#define A "A = { " AT " }, "
#define B "B = { slots = 5, " AT " }, "
#define F "F = { kind = 'foup', " AT " }, "
    assert_counting("", "");
    assert_counting(A, "A");
    assert_counting(A B, "B");
    assert_counting(A B "C = { slots = 2, " AT " }", "BC");
    assert_counting(A B F "G = { kind = 'foup', slots = 1, " AT " }", "FG");
    assert_counting(A B F "LL = { kind = 'foup', counts = false, " AT " }", "F");
    assert_counting(A B "LL = { kind = 'foup', counts = false, " AT " }", "B");
    assert_counting(A B "C = { counts = true, " AT " }", "BC");
    assert_counting("A = { counts = false, " AT " }", "");
    assert_counting("Q = { kind = 'foup', counts = true, " AT " }, " A, "AQ");
    expect_refused("grippers = { { name = 'EE' } }, stations = { A = { counts = 1, " AT " } }",
                   "cell.lua: stations.A.counts: 1 (expected true or false)");
#undef AT
#undef A
#undef B
#undef F
}

static void a_blade_of_two_sits_where_it_says(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(STATIONS "grippers = { { name = 'LOWER', at = { 0, 0, 0 }, rpy = { 0, 0, 0 } }, "
                            "{ name = 'UPPER', at = { 1, 2, 15 }, rpy = { 0, 0, 180 } } }");
    const wh_mount_t *upper = &layout->machine.mounts[1];
    assert_false(layout->machine.mounts[0].is_shifted);
    assert_true(upper->is_shifted);
    assert_near(upper->effector_from_gripper.r.z, 15, 0);
    assert_near(upper->effector_from_gripper.R.m[0][0], -1, 0);
    assert_int_equal(wh_machine_validate(&layout->machine), WH_OK);
}

static void a_blades_place_is_in_the_hash(void **state) {
    (void)state;
    const uint64_t plain = wh_layout_hash(read_sound(STATIONS "grippers = { { name = 'EE' } }"));
    const uint64_t nowhere =
        wh_layout_hash(read_sound(STATIONS "grippers = { { name = 'EE', at = { 0, 0, 0 } } }"));
    const uint64_t above =
        wh_layout_hash(read_sound(STATIONS "grippers = { { name = 'EE', at = { 0, 0, 1 } } }"));
    assert_true(plain == nowhere);
    assert_true(plain != above);
}

#define PREALIGNER(sensor)                                                                                   \
    "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { A = { at = { 700, 0, 900 }, "   \
    "slots = 3, pitch = 10 }, P = { kind = 'prealigner', at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, " sensor  \
    " } }, "
#define RIM(rim) "wafers = { { station = 'A', slot = 1 }, { station = 'A', slot = 2, rim = { " rim " } } }, "

static void assert_all_near(const double numbers[], const double wanted[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        assert_near(numbers[i], wanted[i], 1e-12);
    }
}

static void an_edge_sensor_and_the_rims_that_it_sees_are_read(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(PREALIGNER("sensor = { }") RIM(""));
    const wh_sensor_t nominal = wh_sensor_nominal(150);
    const wh_rim_t notched = wh_rim_nominal(150);
    assert_int_equal(layout->scanner_count, 1);
    assert_int_equal(layout->scanners[0].gripper, 1);
    assert_int_equal(layout->scanners[0].seed, 1);
    assert_memory_equal(&layout->scanners[0].base_from_station, &layout->places[1].base_from_station,
                        sizeof(wh_pose_t));
    assert_memory_equal(&layout->scanners[0].sensor, &nominal, sizeof nominal);
    assert_ptr_equal(layout->rims[0], layout->nominal_rim);
    assert_memory_equal(layout->rims[1], &notched, sizeof notched);
    layout = read_sound(PREALIGNER(
        "sensor = { samples = 1000, pixel = 0.01, noise = 0.005, length = 20, offset = 0.1, tilt = 2, "
        "latency = 2e-5, zero = -0.1, gain = 0.001, believed = { offset = 0.2, latency = 1e-5 }, at = 90, "
        "encoder = 20000, seed = 5, "
        "hidden = { { from = 45, width = 90 } } }") RIM("diameter = 299.9, notch = { at = 90, depth = 1.1, "
                                                        "angle = 92, bottom = 1, corner = 0.2 }, flats = { "
                                                        "{ at = 180, length = 20 } }, chips = { { at = 270, "
                                                        "width = 2, depth = 0.5 } }, bow = 0.1, saddle = "
                                                        "0.2, saddle_at = 180, glass = 0.5"));
    const wh_sensor_t *sensor = &layout->scanners[0].sensor;
    const wh_rim_t *rim = layout->rims[1];
    const double sensor_numbers[] = {sensor->samples,        sensor->pixel,          sensor->noise,
                                     sensor->length,         sensor->error.offset,   sensor->tilt,
                                     sensor->error.latency,  sensor->error.zero,     sensor->error.gain,
                                     sensor->direction,      sensor->encoder,        sensor->hidden_count,
                                     sensor->hidden[0].from, sensor->hidden[0].width};
    const double wanted_sensor[] = {1000, 0.01,  0.005,     20,    0.1, 2 * WH_PI / 180, 2e-5,
                                    -0.1, 0.001, WH_PI / 2, 20000, 1,   WH_PI / 4,       WH_PI / 2};
    const double rim_numbers[] = {rim->radius,
                                  rim->notch.direction,
                                  rim->notch.depth,
                                  rim->notch.opening,
                                  rim->notch.bottom,
                                  rim->notch.corner,
                                  rim->flats[0].direction,
                                  rim->flats[0].length,
                                  rim->flats[1].length,
                                  rim->chip_count,
                                  rim->chips[0].direction,
                                  rim->chips[0].width,
                                  rim->chips[0].depth,
                                  rim->bow,
                                  rim->saddle,
                                  rim->saddle_direction,
                                  rim->transmission};
    const double wanted_rim[] = {149.95, WH_PI / 2, 1.1, 92 * WH_PI / 180, 1, 0.2, WH_PI,
                                 20,     0,         1,   3 * WH_PI / 2,    2, 0.5, 0.1,
                                 0.2,    WH_PI,     0.5};
    assert_all_near(sensor_numbers, wanted_sensor, sizeof wanted_sensor / sizeof wanted_sensor[0]);
    assert_all_near(rim_numbers, wanted_rim, sizeof wanted_rim / sizeof wanted_rim[0]);
    assert_int_equal(layout->scanners[0].seed, 5);
    const wh_sensor_error_t believed = {0.2, 0, 0, 1e-5};
    assert_memory_equal(&layout->believed[0], &believed, sizeof believed);
}

/* Wafers of 150 mm have a flat in the notch's direction; without depth there is no mark at all. */
static void the_usual_rim_is_that_of_the_layouts_wafer(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(PREALIGNER("sensor = { }") "wafer = { diameter = 150, notch = { at = 90, depth = 0 } }");
    assert_near(layout->nominal_rim->flats[0].length, 57.5, 0);
    assert_near(layout->nominal_rim->flats[0].direction, WH_PI / 2, 1e-15);
    assert_near(layout->nominal_rim->notch.depth, 0, 0);
    layout = read_sound(PREALIGNER("sensor = { }") "wafer = { notch = { at = 90, depth = 1.2 } }");
    assert_near(layout->nominal_rim->notch.depth, 1.2, 0);
    assert_near(layout->nominal_rim->notch.direction, WH_PI / 2, 1e-15);
    layout = read_sound(PREALIGNER("sensor = { }") "wafer = { notch = { depth = 0 } }");
    assert_near(layout->nominal_rim->notch.depth, 0, 0);
}

static void sensors_and_rims_are_in_the_hash_once_there_is_a_sensor(void **state) {
    (void)state;
    const uint64_t without =
        wh_layout_hash(read_sound(PREALIGNER("") "wafers = { { station = 'A', slot = 2 } }"));
    const uint64_t usual =
        wh_layout_hash(read_sound(PREALIGNER("sensor = { }") "wafers = { { station = 'A', slot = 2 } }"));
    const uint64_t noisy = wh_layout_hash(
        read_sound(PREALIGNER("sensor = { noise = 0.001 }") "wafers = { { station = 'A', slot = 2 } }"));
    const uint64_t chipped = wh_layout_hash(read_sound(
        PREALIGNER("sensor = { }") "wafers = { { station = 'A', slot = 2, rim = { chips = { { at = 3, "
                                   "width = 1, depth = 1 } } } } }"));
    assert_true(without != usual && usual != noisy && usual != chipped && noisy != chipped);
}

#define DOOR(beams)                                                                                          \
    "stations = { A = { at = { 700, 0, 900 }, slots = 3, pitch = 10, beams = { " beams " } } }, "

static void beams_at_a_door_are_read(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        GRIPPERS DOOR("{ y = 60 }, { y = -110, x = -160, low = -5, high = 40, delay_on = 5e-5, delay_off = "
                      "8e-5, jitter = 3e-6, seed = 4, dx = 0.5, dy = -0.25, late = 1e-5, stuck = 'lit' }"));
    assert_int_equal(layout->beam_count, 2);
    const wh_layout_beam_t *usual = &layout->beams[0];
    const double usual_numbers[] = {usual->x,         usual->low,  usual->high,
                                    usual->dx,        usual->dy,   usual->delay_on,
                                    usual->delay_off, usual->late, layout->doors[0].jitter};
    const double wanted_usual[] = {-150, -30, 50, 0, 0, 0, 0, 0, 0};
    const wh_door_beam_t *door = &layout->doors[1];
    const double numbers[] = {door->beam.x,   door->beam.y,      door->beam.z,   door->beam.ez,
                              door->beam.low, door->beam.high,   door->delay_on, door->delay_off,
                              door->jitter,   (double)door->seed};
    const double wanted[] = {540.5, -110.25, 900, 1, -5, 40, 6e-5, 9e-5, 3e-6, 4};
    for (size_t i = 0; i < sizeof wanted_usual / sizeof wanted_usual[0]; ++i) {
        assert_near(usual_numbers[i], wanted_usual[i], 1e-12);
    }
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; ++i) {
        assert_near(numbers[i], wanted[i], 1e-12);
    }
    assert_int_equal(layout->doors[0].seed, 1);
    assert_int_equal(layout->doors[0].stuck, WH_BEAM_WORKS);
    assert_int_equal(door->stuck, WH_BEAM_LIT);
    assert_int_equal(layout->blades[0].count, 12);
    assert_near(layout->nominal_rim->radius, 150, 0);
    assert_int_equal(wh_layout_beams_at(layout, 0).count, 2);
    assert_false(layout->stations[0].centre);
}

/* Up to 30 mm above the last slot, which is 20 mm above the first; 60 mm high if it begins above that. */
static void how_high_a_beam_is_unless_it_is_said(void **state) {
    (void)state;
    static const double lows[] = {-30, 45, 49, 50, 60};
    static const double highs[] = {50, 50, 50, 110, 120};
    for (size_t i = 0; i < sizeof lows / sizeof lows[0]; ++i) {
        char fields[300];
        (void)snprintf(fields, sizeof fields, GRIPPERS DOOR("{ y = 60, low = %g }"), lows[i]);
        assert_near(read_sound(fields)->beams[0].high, highs[i], 0);
    }
}

static void beams_are_in_the_hash_once_there_are_some(void **state) {
    (void)state;
    const uint64_t none = wh_layout_hash(read_sound(GRIPPERS DOOR("")));
    const uint64_t plain = wh_layout_hash(
        read_sound(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, pitch = 10 } }, "));
    const uint64_t two = wh_layout_hash(read_sound(GRIPPERS DOOR("{ y = 60 }, { y = -110 }")));
    const uint64_t late = wh_layout_hash(read_sound(GRIPPERS DOOR("{ y = 60 }, { y = -110, late = 1e-6 }")));
    assert_true(none == plain);
    assert_true(none != two && two != late);
}

static void what_is_wrong_with_beams_is_named(void **state) {
    (void)state;
#define CENTRED(fields) "stations = { A = { at = { 700, 0, 900 }, centre = true, " fields " } }, "
    static const char *const rows[][2] = {
        {GRIPPERS DOOR("{ }"), "stations.A.beams[1].y: nothing"},
        {GRIPPERS DOOR("{ y = 149 }"), "stations.A.beams[1].y: 149 (expected a number from -148 to 148)"},
        {GRIPPERS DOOR("{ y = 60, z = 3 }"), "stations.A.beams[1].z: 3 (expected one of the fields x"},
        {GRIPPERS DOOR("{ y = 85 }, { y = -85 }"),
         "stations.A.beams[2].y: -85 (expected a distance from the way that differs by 5 mm or more"},
        {GRIPPERS DOOR("{ y = 60, low = 10, high = 5 }"), "beams[1].high: 5 (expected a number from 11"},
        {GRIPPERS DOOR("{ y = 60, delay_on = 0.02 }"), "beams[1].delay_on: 0.02 (expected a number from 0"},
        {GRIPPERS DOOR("{ y = 60, jitter = 0.1 }"), "beams[1].jitter: 0.1 (expected a number from 0"},
        {GRIPPERS CENTRED(""), "stations.A.centre: true (expected false, or two beams"},
        {GRIPPERS CENTRED("beams = { { y = 60 } }"), "stations.A.centre: true (expected false, or two"},
        {GRIPPERS CENTRED("beams = { { y = 60, x = -100 }, { y = -110 } }"),
         "stations.A.beams[1].x: -100 (expected from -157.523 to -142.477 mm, where all of a wafer passes"},
        {GRIPPERS DOOR("{ y = 60 }") "wafer = { diameter = 700, thickness = 1 }", "beams see wafers from 20"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        expect_refused(rows[i][0], rows[i][1]);
    }
}

static void wafers_lie_where_the_slots_frame_says(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        GRIPPERS "stations = { B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 3 } }, "
                 "wafers = { { station = 'B', slot = 1 }, { name = 'W', station = 'B', slot = 3, dx = 13.5, "
                 "dy = 7.25, dz = 0.5, rpy = { 0, 0, 90 } } }");
    assert_int_equal(layout->wafer_count, 2);
    assert_string_equal(layout->wafers[0].name, "Wafer 1");
    assert_int_equal(wh_layout_find_wafer(layout, "W"), 1);
    assert_int_equal(layout->wafers[1].slot, 3);
    const wh_pose_t usual = wh_station_slot(&layout->places[0], 1);
    assert_memory_equal(&layout->start[0].base_from_wafer, &usual, sizeof usual);
    const wh_pose_t *start = &layout->start[1].base_from_wafer;
    assert_near(start->r.x, -7.25, 1e-12);
    assert_near(start->r.y, 713.5, 1e-12);
    assert_near(start->r.z, 920.5, 1e-12);
    assert_near(start->R.m[0][0], -1, 0);
}

typedef struct {
    const char *fields, *message;
} wrong_t;

static void expect_all_refused(const wrong_t rows[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        expect_refused(rows[i].fields, rows[i].message);
    }
}

static void what_is_wrong_is_named(void **state) {
    (void)state;
    static const wrong_t rows[] = {
        {"", "stations: nothing"},
        {STATIONS, "grippers: nothing"},
        {GRIPPERS STATIONS "colour = 3", "cell.lua: colour: 3 (expected one of the fields wafer"},
        {GRIPPERS STATIONS "['check slice'] = 1", "check slice: 1 (expected one of"},
        {GRIPPERS STATIONS "['check\\0'] = 'swept'", "expected one of the fields"},
        {GRIPPERS STATIONS "[''] = 1", "expected one of the fields"},
        {GRIPPERS STATIONS "5", "cell.lua: [1]: 5 (expected one of the fields"},
        {GRIPPERS STATIONS "slice = 0.0000015", "slice: 1.5e-06 (expected a whole number of microseconds"},
        {GRIPPERS STATIONS "slice = '0.001'", "slice: \"0.001\" (expected a number"},
        {GRIPPERS STATIONS "slice = 0/0", "(expected a number from"},
        {GRIPPERS STATIONS "tolerance = 'loose'", "tolerance: \"loose\" (expected \"paper\" or \"strict\")"},
        {GRIPPERS STATIONS "tolerance = 3", "tolerance: 3 (expected"},
        {GRIPPERS STATIONS "collision = 1", "true or false"},
        {GRIPPERS STATIONS "robot = { kind = 'SCARA' }", "robot.links: nothing (expected a list of two"},
        {GRIPPERS STATIONS "robot = { r = { min = 500, max = 400 } }", "robot.r.max: 400"},
        {GRIPPERS STATIONS "robot = { r = { min = 400 } }",
         "cell.lua: robot.r.home: 300 (expected a number from 400 to 900)"},
        {GRIPPERS "stations = { A = { at = { 1, 2 } } }",
         "cell.lua: stations.A.at: { 1, 2 } (expected a list of three numbers)"},
        {GRIPPERS "stations = { A = { } }", "stations.A.at: nothing"},
        {GRIPPERS "stations = { A = { at = { 1, 'x', 3 } } }", "stations.A.at[2]: \"x\""},
        {GRIPPERS "stations = { A = { at = { 1, 2, 3 }, rpy = { 50, 0, 0 } } }", "stations.A.rpy"},
        {GRIPPERS "stations = { A = { at = { 1, 2, 3 }, pickup_speed = 501 } }", "at most 500 mm/s"},
        {GRIPPERS "stations = { { at = { 1, 2, 3 } } }", "stations: 1 (expected stations by name"},
        {GRIPPERS "stations = { P = { kind = 'prealigner', at = { 1, 2, 3 } } }", "on = \"P\""},
        {STATIONS "grippers = { { name = 'E' }, { name = 'E' } }", "grippers[2].name: \"E\""},
        {STATIONS "grippers = { { name = 'E', on = 'A' } }", "grippers[1].on: \"A\""},
        {STATIONS "grippers = { }", "at least one gripper"},
        {STATIONS "grippers = { EE = { name = 'EE' } }",
         "cell.lua: grippers.EE: a table (expected a list: entries 1, 2, ... without names and gaps)"},
        {GRIPPERS STATIONS "wafers = { { station = 'A' } }", "wafers[1].slot: nothing"},
        {GRIPPERS STATIONS "wafers = { { station = 'A', slot = 2 } }", "wafers[1].slot: 2"},
        {GRIPPERS STATIONS "wafers = { { station = 'Z', slot = 1 } }", "wafers[1].station: \"Z\""},
        {GRIPPERS STATIONS "wafers = { { station = 'A', slot = 1 }, { station = 'A', slot = 1 } }",
         "wafers[2].slot: 1 (expected a slot of A of its own; \"Wafer 1\""},
        {GRIPPERS STATIONS "wafers = { w1 = { station = 'A', slot = 1 } }",
         "cell.lua: wafers.w1: a table (expected a list: entries 1, 2, ... without names and gaps)"},
        {GRIPPERS STATIONS "wafers = { [1] = { station = 'A', slot = 1 }, [3] = { } }",
         "cell.lua: wafers[3]: a table (expected a list: entries 1, 2, ... without names and gaps)"},
    };
    expect_all_refused(rows, sizeof rows / sizeof rows[0]);
}

static const wrong_t wrong_robots[] = {
    {GRIPPERS STATIONS "robot = { kind = 'SCARA', links = { 450, 0 } }",
     "robot.links: { 450, 0 } (expected a"},
    {GRIPPERS STATIONS "robot = { kind = 'SCARA', links = { 450, 450 }, r = {} }",
     "robot.r: a table (expected nothing: a robot of kind \"SCARA\" has a forearm)"},
    {GRIPPERS STATIONS "robot = { kind = 'SCARA', links = { 450, 450 }, elbow = 'up' }",
     "robot.elbow: \"up\""},
    {GRIPPERS STATIONS "robot = { kind = 'TRZ', yaw = {} }",
     "robot.yaw: a table (expected nothing: a robot of kind"},
    {GRIPPERS STATIONS "robot = { elbow = 'left' }", "robot.elbow: \"left\" (expected nothing: this is of"},
    {GRIPPERS STATIONS "robot = { tilt = {}, links = { 1, 2 } }", "robot.links: { 1, 2 } (expected nothing"},
    {GRIPPERS STATIONS "robot = { kind = 'SCARA', links = { 450, 450 }, transit = 500 }",
     "robot.transit: 500 (expected nothing: it is for a robot of kind \"TRZY\" or \"TRZ\"; `via` points "},
    {GRIPPERS STATIONS "robot = { kind = 'TRZ', arms = { {}, {}, {} } }", "robot.arms: "},
    {GRIPPERS STATIONS "robot = { kind = 'TRZ', arms = { {}, { heading = 400 } } }",
     "robot.arms[2].heading: 400 (expected a number from -360 to 360)"},
    {GRIPPERS STATIONS "robot = { kind = 'TRZ', arms = { {}, {} } }", "at least one gripper with arm = 2"},
    {STATIONS "grippers = { { name = 'E', arm = 2 } }",
     "grippers[1].arm: 2 (expected nothing: the robot does not have two arms)"},
    {STATIONS "robot = { kind = 'TRZ', arms = { {}, {} } }, grippers = { { name = 'E', arm = 3 } }",
     "grippers[1].arm: 3 (expected a whole number from 1 to 2)"},
    {GRIPPERS STATIONS "robot = { arms = { {}, {} } }", "robot.arms: a table (expected nothing: this is of"},
    {GRIPPERS STATIONS "robot = { kind = 'TRZ', wrists = { {}, {} } }",
     "robot.wrists: a table (expected nothing: this is of"},
    {GRIPPERS STATIONS "robot = { kind = 'SCARA', links = { 450, 450 }, transit = 500 }",
     "robot.transit: 500 (expected nothing"},
    {GRIPPERS STATIONS "robot = { kind = 'SCARA', links = { 450, 450 }, wrists = { {}, { heading = 300 } } }",
     "expected a second wrist whose home is within yaw's travel"},
    {GRIPPERS STATIONS "robot = { flip = { home = 180 } }", "robot.flip.home: 180 (expected one of"},
    {GRIPPERS STATIONS "robot = { flip = { max = 170 } }",
     "robot.flip.max: 170 (expected a number from 180 to 360)"},
    {GRIPPERS STATIONS "robot = { flip = { seconds = 1, jerk = 5 } }",
     "robot.flip.jerk: 5 (expected nothing: `seconds` says how fast it goes)"},
    {GRIPPERS STATIONS "robot = { flip = {}, transit = 0 }",
     "robot.transit: 0 (expected a number from 1 to 100000)"},
    {GRIPPERS STATIONS "robot = { kind = 'SCARA', links = { 450, 450 } }, shapes = { arm = { reach = 9 } }",
     "shapes.arm: a table (expected nothing: the links of a robot of kind \"SCARA\" are in its `links`)"},
    {GRIPPERS STATIONS "robot = { tilt = { max = 58 } }", "robot.tilt.max: 58 (expected a number from"},
    {GRIPPERS "robot = { tilt = {} }, stations = { A = { at = { 700, 0, 900 }, beams = { { y = 60 } } } }",
     "stations.A.beams: a table (expected nothing: beams are for"},
    {GRIPPERS "stations = { A = { at = { 700, 0, 900 }, rail = 5 } }",
     "stations.A.rail: 5 (expected nothing: the robot has no rail)"},
    {GRIPPERS "robot = { rail = {} }, stations = { A = { at = { 700, 0, 900 }, rail = 2000 } }",
     "stations.A.rail: 2000 (expected a number from -1000 to 1000)"},
    {GRIPPERS "stations = { A = { at = { 700, 0, 900 }, elbow = 'left' } }",
     "stations.A.elbow: \"left\" (expected nothing: the robot is not of kind"},
};

static void what_is_wrong_with_other_robots_is_named(void **state) {
    (void)state;
    expect_all_refused(wrong_robots, sizeof wrong_robots / sizeof wrong_robots[0]);
}

#define TWO "robots = { V = { kind = 'TRZ', at = { 2000, 0, 0 } }, A = {} }, "
#define ON_TWO "grippers = { { name = 'a', on = 'A' }, { name = 'v', on = 'V' } }, "
#define SHARED(by) TWO ON_TWO "stations = { S = { at = { 700, 0, 900 }, " by " } }, "

static void what_is_wrong_with_several_robots_is_named(void **state) {
    (void)state;
    static const wrong_t rows[] = {
        {TWO ON_TWO STATIONS "robot = {}", "robot: a table (expected nothing: `robots` has them all)"},
        {GRIPPERS STATIONS "robots = {}", "robots: a table (expected at least one robot by name)"},
        {GRIPPERS STATIONS
         "robots = { A = {}, B = {}, C = {}, D = {}, E = {}, F = {}, G = {}, H = {}, I = {} }",
         "robots: a table (expected at most 8 robots)"},
        {GRIPPERS STATIONS "robots = { A = {}, B = { at = { 0, 0, 50 } } }",
         "robots.B.at: { 0, 0, 50 } (expected a place of its own: A stands there)"},
        {GRIPPERS STATIONS "robots = { A = {}, B = { at = { 2000, 0, 0 } }, C = { at = { 4000, 0, 0 } }, "
                           "D = { at = { 6000, 0, 0 } }, E = { at = { 8000, 0, 0 } }, "
                           "F = { at = { 10000, 0, 0 } }, G = { at = { 12000, 0, 0 } }, "
                           "H = { at = { 14000, 0, 0 }, rail = {} } }",
         "robots: 33 (expected robots with at most 32 axes together)"},
        {GRIPPERS STATIONS "robots = { A = {}, B = { at = { 2000, 0, 0 }, reach = 5 } }",
         "robots.B.reach: 5 (expected one of the fields"},
        {GRIPPERS STATIONS "robots = { A = { transit = 400, kind = 'SCARA', links = { 450, 450 } } }",
         "robots.A.transit: 400 (expected nothing: it is for a robot of kind"},
        {GRIPPERS STATIONS "robots = { A = { urdf = 'a.urdf' } }",
         "robots.A.urdf: \"a.urdf\" (expected a URDF file: a.urdf: No such file or directory)"},
        {"robots = { V = { kind = 'TRZ', arms = { {}, {} }, at = { 2000, 0, 0 } }, A = {} }, " ON_TWO
         "stations = { S = { at = { 700, 0, 900 } } }",
         "(expected at least one gripper with arm = 2 on V)"},
        {TWO "grippers = { { name = 'a' } }, "
             "stations = { S = { at = { 700, 0, 900 } } }",
         "grippers[1].on: nothing"},
        {TWO "grippers = { { name = 'a', on = 'B' } }, "
             "stations = { S = { at = { 700, 0, 900 } } }",
         "grippers[1].on: \"B\" (expected a robot's name or the name of a station of kind"},
        {TWO "grippers = { { name = 'a', on = 'A' } }, "
             "stations = { S = { at = { 700, 0, 900 } } }",
         "(expected at least one gripper on = \"V\")"},
        {TWO ON_TWO "stations = { V = { at = { 700, 0, 900 } } }",
         "stations.V: a table (expected a name that no robot has)"},
        {SHARED("rail = 5"),
         "stations.S.rail: 5 (expected nothing: with several robots `by` says it of each)"},
        {SHARED("by = {}"), "stations.S.by: a table (expected at least one robot by name)"},
        {SHARED("by = { B = {} }"), "stations.S.by: \"B\" (expected robots of this layout by name)"},
        {SHARED("by = { A = { side = 1 } }"),
         "stations.S.by.A.side: 1 (expected nothing: the station has no `pump`)"},
        {SHARED("by = { A = { rail = 5 } }"),
         "stations.S.by.A.rail: 5 (expected nothing: the robot has no rail)"},
        {SHARED("by = { A = { rpy = { 2, 0, 0 } } }"),
         "stations.S.by.A.rpy: { 2, 0, 0 } (expected one whose z is the station's own"},
        {SHARED("effector = 'v', by = { A = {} }"),
         "stations.S.effector: \"v\" (expected a gripper on a robot that `by` names)"},
        {GRIPPERS "stations = { A = { at = { 700, 0, 900 }, by = {} } }",
         "stations.A.by: a table (expected nothing: it is for a layout with several robots)"},
        {"robots = { V = { kind = 'TRZ', tilt = {}, at = { 2000, 0, 0 } }, A = {} }, " ON_TWO
         "stations = { S = { at = { 1300, 0, 900 }, by = { V = { rpy = { 0, 0, 180 } } } } }, "
         "study = { teaching = { y = 0.25 } }",
         "study.teaching: 0.25 (expected 0 as x, y and z of S: V tilts, and its blade points along the arm)"},
        {SHARED("") "obstacles = { { name = 'o', on = 'forearm', box = { 9, 9, 9 } } }",
         "obstacles[1].on: \"forearm\" (expected \"base\", a gripper's name, or \"A lift\", \"A upper arm\""},
    };
    expect_all_refused(rows, sizeof rows / sizeof rows[0]);
}

static void what_is_wrong_with_their_shapes_is_named(void **state) {
    (void)state;
    static const wrong_t rows[] = {
        {SHARED("") "shapes = { arm = { reach = 200 } }",
         "shapes.arm: a table (expected nothing: with several robots `arms` has each one's by name)"},
        {SHARED("") "shapes = { arms = { B = {} } }",
         "shapes.arms: \"B\" (expected robots of this layout by name)"},
        {SHARED("") "shapes = { arms = { A = { link = 5 } } }",
         "shapes.arms.A.link: 5 (expected a number from 10 to 5000)"},
        {GRIPPERS STATIONS "shapes = { arms = {} }",
         "shapes.arms: a table (expected nothing: it is for a layout with several robots; this has `arm`)"},
        {"robots = { V = { kind = 'SCARA', links = { 450, 450 }, at = { 2000, 0, 0 } }, A = {} }, " ON_TWO
         "stations = { S = { at = { 700, 0, 900 } } }, shapes = { arms = { V = {} } }",
         "shapes.arms.V: a table (expected nothing: the links of a robot of kind"},
    };
    expect_all_refused(rows, sizeof rows / sizeof rows[0]);
}

/* The robot that serves a station: the only one in `by`, the effector's robot, or the only one that
 * comes there. */
static void the_layout_says_who_serves_a_station(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        TWO ON_TWO "stations = { Both = { at = { 1000, 0, 900 }, by = { A = {}, V = { rpy = { 0, "
                   "0, 180 } } } }, Left = { at = { -700, 0, 900 }, rpy = { 0, 0, 180 } }, Named = "
                   "{ at = { 1000, 0, 900 }, effector = 'v', by = { A = {}, V = {} } }, "
                   "One = { at = { 1000, 0, 900 }, by = { V = { rpy = { 0, 0, 180 } } } } }");
    static const int32_t robots[] = {WH_NONE, 0, 1, 1};
    assert_int_equal(layout->robot_count, 2);
    assert_string_equal(layout->robots[0].name, "A");
    assert_int_equal(layout->machine.axis_count, 8);
    assert_int_equal(layout->machine.mounts[1].robot, 1);
    for (size_t s = 0; s < 4; ++s) {
        assert_int_equal(layout->stations[s].robot, robots[s]);
    }
    assert_true(layout->stations[0].by[1].is_turned);
    assert_near(layout->stations[0].by[1].R.m[0][0], -1, 1e-12);
    assert_false(layout->stations[0].by[0].is_turned);
    assert_false(layout->stations[1].by[1].serves);
    assert_int_equal(layout->stations[3].effector, 1);
    char name[WH_NAME_SIZE];
    wh_layout_name_axis(layout, 5, name, sizeof name);
    assert_string_equal(name, "V r");
}

static void what_is_wrong_with_sensors_and_rims_is_named(void **state) {
    (void)state;
    static const wrong_t rows[] = {
        {GRIPPERS "stations = { A = { at = { 700, 0, 900 }, sensor = { } } }",
         "stations.A.sensor: a table (expected nothing: only a station of kind \"prealigner\""},
        {PREALIGNER("sensor = { pixels = 3 }"), "stations.P.sensor.pixels: 3 (expected one of the fields"},
        {PREALIGNER("sensor = { believed = { offset = 2 } }"),
         "stations.P.sensor.believed.offset: 2 (expected a number from -1 to 1"},
        {PREALIGNER("sensor = { believed = { tilt = 2 } }"),
         "stations.P.sensor.believed.tilt: 2 (expected one of the fields"},
        {PREALIGNER("sensor = { samples = 89 }"),
         "stations.P.sensor.samples: 89 (expected a whole number from 90"},
        {PREALIGNER("sensor = { samples = 36000 }") "chuck = { speed = 720 }",
         "stations.P.sensor.samples: 36000 (expected at most 31000: the chuck turns by up to 0.72 degrees in "
         "a"},
        {PREALIGNER("sensor = { }") "chuck = { speed = 6000 }",
         "(expected a slower chuck: chuck.speed at most 5729.58"},
        {PREALIGNER("sensor = { }") "slice = 0.5, check = 'swept'",
         "(expected a slower chuck: chuck.speed at most 343.775"},
        {PREALIGNER("sensor = { encoder = 3000 }"),
         "sensor.encoder: 3000 (expected 0, or a whole number from samples"},
        {PREALIGNER("sensor = { hidden = { { from = 3 } } }"), "sensor.hidden[1].width: nothing"},
        {PREALIGNER("sensor = { }") "wafer = { diameter = 700, thickness = 1 }",
         "an edge sensor sees wafers from 20"},
        {PREALIGNER("sensor = { }") "wafer = { notch = { depth = 5 } }",
         "wafer.notch.depth: 5 (expected 0, or a depth"},
        {PREALIGNER("") RIM(""),
         "wafers[2].rim: a table (expected nothing: no prealigner of this layout has"},
        {PREALIGNER("sensor = { }") RIM("radius = 3"), "wafers[2].rim.radius: 3 (expected one of the fields"},
        {PREALIGNER("sensor = { }") RIM("glass = 1"),
         "wafers[2].rim.glass: 1 (expected a number from 0 to 0.9"},
        {PREALIGNER("sensor = { }") RIM("notch = { depth = 0.3, bottom = 2 }"),
         "wafers[2].rim.notch.bottom: 2 (expected a notch of depth 0"},
        {PREALIGNER("sensor = { }") RIM("flats = { { at = 0, length = 300 } }"),
         "wafers[2].rim.flats[1].length: 300 (expected a number from 2 to 210"},
        {PREALIGNER("sensor = { }") RIM("chips = { { at = 0, width = 1, depth = 2 } }"),
         "wafers[2].rim.chips[1].depth: 2 (expected a number from 0 to 1"},
        {PREALIGNER("sensor = { }") RIM("chips = { {}, {}, {}, {}, {}, {}, {}, {}, {} }"),
         "wafers[2].rim.chips: a table (expected at most 8 of them"},
    };
    expect_all_refused(rows, sizeof rows / sizeof rows[0]);
}

/* If several fields are unknown, the same one is named in every run, whatever Lua's order. */
static void the_first_unknown_field_by_name_is_reported(void **state) {
    (void)state;
    expect_refused(GRIPPERS STATIONS "zeta = 1, beta = 2, omega = 3, kappa = 4", "cell.lua: beta: 2");
}

/* ------------------------------------------------------------------------------- what a study draws of rims */

#define SENSOR                                                                                               \
    "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { A = { slots = 5, at = { 700, "  \
    "0, "                                                                                                    \
    "900 } }, P = { kind = 'prealigner', at = { -600, 0, 900 }, sensor = {} } }, "
#define RIMS                                                                                                 \
    SENSOR                                                                                                   \
    "wafers = { { name = 'W1', station = 'A', slot = 1, rim = { notch = { depth = 1.125, angle = 92 } "      \
    "} }, { name = 'W2', station = 'A', slot = 2, rim = { notch = { depth = 0 }, flats = { { at = 0, "       \
    "length = 57 } } } }, { name = 'W3', station = 'A', slot = 3, rim = { chips = { "                        \
    "{ at = 0, width = 1, depth = 0 }, { at = 1, width = 1, depth = 0 }, { at = 2, width = 1, "              \
    "depth = 0 }, { at = 3, width = 1, depth = 0 }, { at = 4, width = 1, depth = 0 }, "                      \
    "{ at = 5, width = 1, depth = 0 }, { at = 6, width = 1, depth = 0 }, { at = 7, width = 1, "              \
    "depth = 0 } } } } }, "

/* SEMI M1's notch is 1.00 mm deep, + 0.25, - 0, and has 90 degrees, + 5, - 1. */
#define WIDTHS                                                                                               \
    "study = { rim = { shape = 'uniform', diameter = 0.2, notch_depth = 0.125, notch_angle = 3, "            \
    "notch_bottom "                                                                                          \
    "= 0.05, notch_corner = 0.02, flat = 2, chip_depth = 0.4, chip_width = 3, bow = 0.3, saddle = 0.2, "     \
    "glass "                                                                                                 \
    "= 0.3 }, rims = { W2 = { flat = 0.5, chip_width = 0 } } }"

static bool is_near(double value, double middle, double width) {
    return fabs(value - middle) <= width + 1e-12;
}

static void assert_within_widths(const wh_rim_t *rim, const wh_rim_t *own, size_t w) {
    assert_int_equal(wh_rim_validate(rim, NULL), WH_OK);
    assert_true(is_near(rim->radius, 150, 0.1) && is_near(rim->bow, 0, 0.3));
    assert_true(is_near(rim->saddle, 0, 0.2) && rim->transmission >= 0 && rim->transmission <= 0.3);
    assert_true(is_near(rim->notch.depth, own->notch.depth, own->notch.depth > 0 ? 0.125 : 0));
    assert_true(is_near(rim->flats[0].length, own->flats[0].length, own->flats[0].length > 0 ? 0.5 : 0));
    assert_int_equal(rim->chip_count, w == 2 ? WH_RIM_CHIPS : 1);
    assert_true(w == 2 || (rim->chips[0].depth <= 0.4 && rim->chips[0].width >= rim->chips[0].depth));
    assert_true(w != 1 || is_near(rim->chips[0].width, 4 * rim->chips[0].depth, 0.01));
}

/* Every trial's rim is valid, within the widths; marks that a wafer does not have are not drawn. */
static void every_rim_that_is_drawn_is_one(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(RIMS WIDTHS);
    const wh_errors_t *errors = layout->errors;
    double least = 9;
    double most = 0;
    for (uint64_t n = 0; n < 3000; ++n) {
        const wh_trial_t trial = {7, n};
        for (size_t w = 0; w < 3; ++w) {
            const wh_rim_t *own = layout->rims[w];
            wh_rim_t rim = *own;
            double drawn[WH_RIM_DRAWS];
            wh_errors_draw_rim(errors, &trial, w, own, drawn);
            assert_true(wh_rim_draw_apply(drawn, &rim));
            assert_within_widths(&rim, own, w);
            least = fmin(least, w == 0 ? rim.notch.depth : least);
            most = fmax(most, w == 0 ? rim.notch.depth : most);
        }
    }
    assert_true(least < 1.001 && most > 1.249);
}

static void assert_draw_refused(const char *study, const char *message) {
    char fields[4000];
    (void)snprintf(fields, sizeof fields, "%s study = { %s }", RIMS, study);
    expect_refused(fields, message);
}

static void a_width_that_leaves_no_rim_is_named(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(RIMS "study = { rim = { notch_depth = 0.08 } }");
    assert_non_null(layout->errors);
    assert_draw_refused("rim = { notch_depth = 0.2 }",
                        "cell.lua: study.rim.notch_depth: 0.2 (expected a width that leaves W1 a rim, "
                        "whatever is drawn: 8.6 standard deviations of it either way)");
    assert_draw_refused("rims = { W2 = { shape = 'uniform', flat = 5, glass = 0.91 } }",
                        "cell.lua: study.rims.W2.glass: 0.91 (expected a number from 0 to 0.9)");
    assert_draw_refused("rims = { W1 = { notch_bottom = 1, shape = 'uniform' } }",
                        "cell.lua: study.rims.W1.notch_bottom: 1 (expected a width that leaves W1 a rim, "
                        "whatever is drawn: all of it either way)");
    assert_draw_refused("rims = { W1 = { flat = 1 } }",
                        "cell.lua: study.rims.W1.flat: 1 (expected 0: no wafer here has such a flat)");
    assert_draw_refused("rims = { W2 = { notch_depth = 0.01 } }",
                        "cell.lua: study.rims.W2.notch_depth: 0.01 (expected 0: no wafer here has a notch)");
    assert_draw_refused(
        "rims = { W3 = { chip_depth = 0.1 } }",
        "cell.lua: study.rims.W3.chip_depth: 0.1 (expected 0: no wafer here has room for a chip more)");
    assert_draw_refused("rim = { chip_width = 1 }",
                        "cell.lua: study.rim.chip_depth: 0 (expected a width above 0 beside chip_width)");
    assert_draw_refused("rim = { bow = -1 }", "cell.lua: study.rim.bow: -1 (expected a number from 0 to 2)");
    expect_refused(
        GRIPPERS STATIONS "study = { rim = { bow = 1 } }",
        "cell.lua: study.rim: a table (expected nothing: no prealigner of this layout has a "
        "`sensor` that would see it, no station `beams`, no gripper an edge grip that would meet it)");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(defaults_of_the_cell, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(the_default_robot, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(defaults_of_a_station, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(defaults_that_follow_other_fields, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(only_wafers_from_200_mm_on_have_a_notch_by_themselves, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(every_field_of_the_cell_is_read, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(degrees_become_radians_and_lengths_stay, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(every_field_of_a_station_is_read, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(what_a_station_asks_of_a_command_is_read, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(stations_count_where_wafers_end_up_unless_they_say_it, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(a_blade_of_two_sits_where_it_says, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(a_blades_place_is_in_the_hash, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(an_edge_sensor_and_the_rims_that_it_sees_are_read, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(the_usual_rim_is_that_of_the_layouts_wafer, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(beams_at_a_door_are_read, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(how_high_a_beam_is_unless_it_is_said, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(beams_are_in_the_hash_once_there_are_some, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(what_is_wrong_with_beams_is_named, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(sensors_and_rims_are_in_the_hash_once_there_is_a_sensor, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(wafers_lie_where_the_slots_frame_says, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(what_is_wrong_is_named, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(what_is_wrong_with_other_robots_is_named, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(what_is_wrong_with_their_shapes_is_named, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(what_is_wrong_with_several_robots_is_named, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(the_layout_says_who_serves_a_station, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(what_is_wrong_with_sensors_and_rims_is_named, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(the_first_unknown_field_by_name_is_reported, open_sandbox,
                                        close_sandbox),
        cmocka_unit_test_setup_teardown(every_rim_that_is_drawn_is_one, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(a_width_that_leaves_no_rim_is_named, open_sandbox, close_sandbox),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
