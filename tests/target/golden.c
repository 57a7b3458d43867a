/* A long run whose bits have to be the same on every machine. It makes random steps of the grasp
 * table, and random calls of everything in lib/motion. It takes the bytes of a snapshot, random
 * numbers, and scans of rims with their circles, which are doubles in float as well. It tries both
 * faces of a wafer, an edge grip's path, and steps of mixed grips. Prints a hash of each: the lines
 * of tests/target/golden.txt for its number type, except the last, "transfer", which
 * tests/verify/bits makes.
 *
 * Needs nothing but the library, so that it can be built for a target of your own. */
#include <stdio.h>
#include <string.h>

#include <waferhand.h>

#include "support/random.h"

enum { WAFERS = 5, GRIPPERS = 3, STEPS = 25000, CALLS = 5000 };

static uint64_t state;
static uint64_t hash;

/* The number has 24 bits, so that it is exact in float too. An expression holds one call: C does
 * not fix the order of two. */
static wh_real_t uniform(wh_real_t lo, wh_real_t hi) {
    const wh_real_t share = (wh_real_t)(wh_test_splitmix(&state) >> 40) / WH_REAL(16777216);
    return lo + (hi - lo) * share;
}

static uint32_t below(uint32_t n) {
    return (uint32_t)((wh_test_splitmix(&state) >> 32) * n >> 32);
}

static void add(wh_real_t x) {
    hash = wh_hash_real(hash, x);
}

static wh_mat3_t turn_about(size_t axis, wh_real_t angle) {
    wh_mat3_t R = wh_mat3_identity();
    const size_t u = (axis + 1) % 3;
    const size_t v = (axis + 2) % 3;
    wh_sin_cos(angle, &R.m[v][u], &R.m[u][u]);
    R.m[v][v] = R.m[u][u];
    R.m[u][v] = -R.m[v][u];
    return R;
}

/* Poses near the wafers at the origin, more or less level. */
static wh_pose_t somewhere(wh_real_t reach, wh_real_t height) {
    wh_pose_t pose;
    const wh_mat3_t yaw = turn_about(2, uniform(-3, 3));
    const size_t axis = below(2);
    const wh_mat3_t tilt = turn_about(axis, uniform(WH_REAL(-0.15), WH_REAL(0.15)));
    pose.R = wh_mat3_multiply(&yaw, &tilt);
    pose.r.x = uniform(-reach, reach);
    pose.r.y = uniform(-reach, reach);
    pose.r.z = uniform(-height, height);
    return pose;
}

static void add_event(const wh_event_t *event) {
    const wh_proximity_t *p = &event->measured;
    hash = wh_hash_int(hash, (int32_t)event->kind);
    hash = wh_hash_word(hash, event->measured_slice);
    hash = wh_hash_int(hash, event->wafer);
    hash = wh_hash_int(hash, event->gripper);
    hash = wh_hash_int(hash, event->other);
    hash = wh_hash_int(hash, (int32_t)p->failed);
    add(p->dr_proj_xy_norm);
    add(p->margin_projz);
    add(p->margin_projxy);
    add(p->margin_planar);
}

static void draw_inputs(wh_gripper_input_t inputs[GRIPPERS]) {
    for (size_t g = 0; g < GRIPPERS; ++g) {
        if (below(2) == 0) {
            inputs[g].base_from_gripper = somewhere(60, 2);
        } else {
            inputs[g].base_from_gripper.r.z += uniform(-1, 1);
        }
        inputs[g].valve = below(4) == 0 ? 1 - inputs[g].valve : inputs[g].valve;
    }
}

static void draw_start(wh_wafer_t wafers[WAFERS], wh_gripper_input_t inputs[GRIPPERS]) {
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w].base_from_wafer = somewhere(60, 2);
    }
    for (size_t g = 0; g < GRIPPERS; ++g) {
        inputs[g].base_from_gripper = somewhere(60, 2);
        inputs[g].valve = WH_VALVE_CLOSED;
    }
}

static bool is_lively(const wh_grasp_counters_t *c) {
    return c->picked > 500 && c->released > 500 && c->handed_over > 30 && c->near_misses > 500 &&
           c->contested > 50;
}

/* One way of checking, with or without seating; false if a step was refused. */
static bool steps(wh_check_t check, bool seat) {
    static wh_wafer_t wafers[WAFERS];
    static wh_gripper_t grippers[GRIPPERS];
    static wh_grasp_t table;
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = check;
    config.seat = seat;
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, NULL, 0};
    wh_gripper_input_t inputs[GRIPPERS];
    wh_event_t events[GRIPPERS * WH_EVENTS_PER_GRIPPER];
    wh_event_list_t list = {events, GRIPPERS * WH_EVENTS_PER_GRIPPER, 0};
    draw_start(wafers, inputs);
    bool good = wh_grasp_init(&table, &config, &storage) == WH_OK;
    for (int step = 0; step < STEPS && good; ++step) {
        const size_t w = below(WAFERS);
        const wh_pose_t pose = somewhere(60, 2);
        if (wafers[w].holder == WH_NONE) {
            good = wh_grasp_place(&table, w, &pose) == WH_OK;
        }
        draw_inputs(inputs);
        good = good && wh_grasp_step(&table, inputs, &list) == WH_OK;
        for (size_t i = 0; i < list.count; ++i) {
            add_event(&events[i]);
        }
        hash = wh_hash_word(hash, wh_grasp_hash(&table));
    }
    return good && is_lively(&table.counters);
}

static void trigonometry(void) {
    wh_real_t sine;
    wh_real_t cosine;
    wh_sin_cos(uniform(-100, 100), &sine, &cosine);
    add(sine);
    add(cosine);
    wh_sin_cos_deg(uniform(-720, 720), &sine, &cosine);
    add(sine);
    add(cosine);
    const wh_real_t y = uniform(-10, 10);
    add(wh_atan2(y, uniform(-10, 10)));
    add(wh_cbrt(uniform(-1000, 1000)));
}

static void profiles(void) {
    wh_limits_t limits;
    limits.speed = uniform(1, 1000);
    limits.acceleration = uniform(10, 5000);
    limits.jerk = uniform(100, 50000);
    wh_profile_t profile;
    wh_motion_t motion;
    if (wh_profile_plan(&profile, uniform(-500, 500), &limits) == WH_OK) {
        (void)wh_profile_stretch(&profile, wh_profile_duration(&profile) * uniform(1, 2));
        wh_profile_at(&profile, wh_profile_duration(&profile) * uniform(0, 1), &motion);
        add(wh_profile_duration(&profile));
        add(motion.position);
        add(motion.speed);
        add(motion.acceleration);
    }
}

static void moves(const wh_robot_t *robot) {
    wh_real_t q[WH_ROBOT_AXES];
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        q[axis] = uniform(robot->travel[axis].min, robot->travel[axis].max);
    }
    wh_pose_t pose;
    wh_line_t line;
    wh_robot_forward(q, &pose);
    hash = wh_hash_pose(hash, &pose);
    wh_status_t status =
        wh_robot_inverse(robot, pose.r.x, pose.r.y, pose.r.z, uniform(-3, 3), robot->home, q);
    hash = wh_hash_int(hash, (int32_t)status);
    const wh_real_t dx = uniform(-200, 200);
    const wh_real_t dy = uniform(-200, 200);
    status = wh_line_plan(&line, robot, q, dx, dy, uniform(-20, 20), 0);
    hash = wh_hash_int(hash, (int32_t)status);
    if (status == WH_OK) {
        wh_line_at(&line, wh_line_duration(&line) * uniform(0, 1), q);
    }
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        add(q[axis]);
    }
}

/* The bytes of a snapshot, of a gripper that has just taken a wafer. They are the same for both
 * byte orders. False if the snapshot cannot be read back. */
static bool snapshot(void) {
    static wh_simulator_t simulator;
    static wh_wafer_t wafers[2];
    static wh_wafer_t room_wafers[2];
    static wh_gripper_t grippers[1];
    static wh_gripper_t room_grippers[1];
    static wh_snapshot_room_t room;
    static wh_command_t command;
    static uint8_t bytes[WH_SNAPSHOT_SIZE(2, 1)];
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, 2, grippers, 1, NULL, 0};
    const wh_cell_t cell = {NULL, 0, config.tolerance, 0, 0, false, 0, 0};
    wh_physics_t physics = wh_physics_default();
    wh_state_t answer;
    size_t size = 0;
    physics.vacuum = wh_vacuum_delayed();
    physics.faults[0] = wh_fault_make(WH_FAULT_WAFER_MISSING, 1, 0, 2, WH_FAULT_FOREVER);
    physics.fault_count = 1;
    wafers[0].base_from_wafer = somewhere(60, 2);
    wafers[1].base_from_wafer = somewhere(60, 2);
    command.gripper_count = 1;
    command.grippers[0].base_from_gripper = wafers[0].base_from_wafer;
    bool good = wh_simulator_init(&simulator, &config, &storage, &cell) == WH_OK &&
                wh_simulator_set_physics(&simulator, &physics) == WH_OK;
    for (command.seq = 1; command.seq <= 3; ++command.seq) {
        good = good && wh_simulator_step(&simulator, &command, &answer) == WH_OK;
    }
    good = good && wh_simulator_save(&simulator, bytes, sizeof bytes, &size) == WH_OK;
    for (size_t i = 0; i < size; ++i) {
        hash = wh_hash_word(hash, bytes[i]);
    }
    room.wafers = room_wafers;
    room.grippers = room_grippers;
    return good && grippers[0].wafer == 0 && wh_simulator_load(&simulator, bytes, size, &room) == WH_OK;
}

static void add_double(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    hash = wh_hash_word(hash, bits);
}

/* Random numbers, drawn by name and number, and the logarithm that the normal ones use. */
static void deviates(void) {
    wh_trial_t trial;
    trial.seed = wh_test_splitmix(&state);
    trial.trial = wh_test_splitmix(&state);
    const uint32_t field = below(1000);
    const uint32_t index = below(1000);
    add_double(wh_deviate_uniform(&trial, field, index));
    add_double(wh_deviate_normal(&trial, field, index));
    add_double(wh_ln((double)(1 + below(1U << 31)) / 1024));
}

/* A wafer with a notch and a chip, scanned with noise: its circle and, with enough samples, its
 * notch. False if the scan does not give them. */
static bool scan(int32_t samples) {
    static wh_rim_point_t points[3600];
    static wh_rim_ray_t rays[3600];
    const wh_chip_t chip = {1, 8, 2};
    const wh_trial_t trial = {state, below(1000)};
    wh_rim_t rim = wh_rim_nominal(150);
    wh_sensor_t sensor = wh_sensor_nominal(150);
    wh_align_limits_t limits = wh_align_limits_default();
    wh_align_result_t result = {0};
    rim.notch.direction = (double)below(6283) / 1000;
    rim.chips[0] = chip;
    rim.chip_count = 1;
    sensor.samples = samples;
    sensor.noise = 0.005;
    sensor.error.offset = 0.125;
    const wh_placement_t placement = {(double)below(9000) / 1000, -(double)below(9000) / 1000, 0.5};
    for (uint32_t i = 0; i < (uint32_t)samples; ++i) {
        const wh_glance_t glance = {wh_sensor_angle(&sensor, i), 6, trial, i};
        const int32_t sample = wh_sensor_read(&sensor, &rim, &placement, &glance);
        hash = wh_hash_int(hash, sample);
        add_double(wh_rim_distance(&rim, &placement, sensor.error.offset, -glance.turn));
        points[i] = wh_sensor_point(&sensor, &sensor.error, &glance, sample);
    }
    const wh_rim_scan_t whole = {points, (size_t)samples, sensor.error.offset, sensor.pixel};
    const bool good = wh_align_estimate(&whole, &sensor, &rim, &limits, rays, &result) == WH_OK;
    add_double(result.circle.x);
    add_double(result.circle.y);
    add_double(result.circle.radius);
    add_double(result.circle.sd_centre);
    add_double(result.circle.scatter);
    add_double(result.turn);
    add_double(result.sd_turn);
    hash = wh_hash_int(hash, result.verdict);
    return good && (samples < 3600 || result.verdict == WH_OK);
}

/* A known wafer in two places, with the chuck turning either way: the offset of the sensor. False
 * if the scans do not give it. */
static bool calibrate(void) {
    static wh_rim_point_t points[5][180];
    static wh_rim_ray_t rays[180];
    const wh_rim_t rim = wh_rim_nominal(150);
    const wh_trial_t trial = {20240229, 7};
    wh_sensor_t sensor = wh_sensor_nominal(150);
    wh_calibration_scan_t scans[4];
    wh_calibration_t found = {{0, 0, 0, 0}, 0, 0, 0, 0, 0, 0, 0};
    sensor.samples = 180;
    sensor.noise = 0.005;
    sensor.error.offset = 0.0625;
    sensor.error.gain = -0.0005;
    sensor.error.latency = 0.00001;
    for (uint32_t k = 0; k < 4; ++k) {
        const double speed = k % 2 == 0 ? 6 : -6;
        const wh_placement_t placement = {k < 2 ? -7 : 5, k < 2 ? 2 : -3, 0.5};
        for (uint32_t i = 0; i < 180; ++i) {
            const wh_glance_t glance = {wh_sensor_angle(&sensor, speed > 0 ? i : 179 - i), speed, trial,
                                        180 * k + i};
            points[k][i] =
                wh_sensor_point(&sensor, NULL, &glance, wh_sensor_read(&sensor, &rim, &placement, &glance));
        }
        const wh_calibration_scan_t one = {points[k], 180, speed, k < 2 ? 0 : 12, k < 2 ? 0 : -5};
        scans[k] = one;
    }
    const wh_status_t status = wh_calibration_solve(&sensor, 150, 0, scans, 4, points[4], rays, &found, NULL);
    add_double(found.error.offset);
    add_double(found.error.zero);
    add_double(found.error.gain);
    add_double(found.error.latency);
    add_double(found.sd_gain);
    return status == WH_OK && fabs(found.error.offset - 0.0625) < 0.05;
}

/* A wafer on a gripper passes through two beams: the times, and the centre that follows from them.
 * False if they give no centre. */
static bool pass_beams(void) {
    const double across[2] = {60, -110};
    const wh_pose_t base = wh_pose_identity();
    const wh_centring_t known = wh_centring_nominal(150);
    wh_rim_t rim = wh_rim_nominal(150);
    wh_crossing_t crossings[WH_CROSSINGS];
    wh_centres_t centres = {0};
    wh_pose_t lies = base;
    size_t count = 0;
    rim.notch.direction = (double)below(6283) / 1000;
    lies.r.x = (wh_real_t)below(1000) / 500;
    lies.r.y = -(wh_real_t)below(1000) / 500;
    for (int32_t beam = 0; beam < 2; ++beam) {
        const wh_beam_t line = wh_beam_at(&base, 0, across[beam], -10, 10);
        bool broken = false;
        for (int slice = -25; slice < 25; ++slice) {
            wh_pose_t poses[2] = {base, base};
            poses[0].r.x = (wh_real_t)(8 * slice);
            poses[1].r.x = (wh_real_t)(8 * slice + 8);
            const wh_shade_t shade = {wh_slice_motion_between(&poses[0], &poses[1]), &lies, &rim, NULL};
            double part = 0;
            while (count < WH_CROSSINGS && wh_beam_next(&line, &shade, 1, &part, &broken)) {
                add_double(part);
                (void)wh_beam_crossing(&line, &shade.motion, part, 0.016, &crossings[count]);
                crossings[count].beam = beam;
                crossings[count++].edge = broken ? WH_CROSSING_IN : WH_CROSSING_OUT;
            }
        }
    }
    const wh_status_t status = wh_centring_solve(&known, crossings, count, &centres);
    add_double(centres.candidates[0].x);
    add_double(centres.candidates[0].y);
    add_double(centres.candidates[0].sd_centre);
    return status == WH_OK;
}

/* It prints two halves: newlib-nano prints no integer of 64 bits. */
static int report(const char *what, bool good) {
    printf("%s %s %08lx%08lx\n", sizeof(wh_real_t) == sizeof(double) ? "double" : "float", what,
           (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffU));
    if (!good) {
        printf("%s: refused, or not enough of each event\n", what);
    }
    return good ? 0 : 1;
}

static bool scans(void) {
    bool good = true;
    for (int wafer = 0; wafer < 10; ++wafer) {
        good = scan(wafer == 0 ? 3600 : 180) && good;
    }
    return calibrate() && good;
}

/* A robot of each kind, with all options that it may have. */
static wh_chain_t chain_of(wh_chain_kind_t kind) {
    const wh_limits_t limits = {uniform(1, 9), uniform(10, 90), uniform(100, 900)};
    wh_chain_t chain;
    memset(&chain, 0, sizeof chain);
    chain.kind = kind;
    chain.has_rail = chain.has_tilt = chain.has_flip = chain.is_placed = true;
    chain.base_from_robot = somewhere(900, 100);
    chain.base_from_robot.R = turn_about(2, uniform(-3, 3));
    chain.flip_height = uniform(-10, 10);
    chain.links[0] = uniform(200, 400);
    chain.links[1] = uniform(200, 400);
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        const bool is_tilt = axis == WH_CHAIN_TILT_X || axis == WH_CHAIN_TILT_Y;
        const wh_real_t most = is_tilt ? WH_REAL(0.1) : WH_REAL(3.0);
        const wh_travel_t travel = {-most, most};
        chain.travel[axis] = travel;
        chain.limits[axis] = limits;
    }
    if (kind != WH_CHAIN_SCARA) {
        const wh_travel_t reach = {100, 900};
        chain.travel[WH_CHAIN_REACH] = reach;
        chain.home[WH_CHAIN_REACH] = 100;
    }
    return chain;
}

static bool chains(uint32_t call) {
    static const wh_chain_kind_t kinds[] = {WH_CHAIN_TRZY, WH_CHAIN_TRZ, WH_CHAIN_SCARA};
    static const wh_line_caps_t caps = {300, 0};
    const wh_chain_t chain = chain_of(kinds[call % 3]);
    wh_real_t q[WH_CHAIN_AXES];
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        q[axis] = uniform(chain.travel[axis].min, chain.travel[axis].max);
        q[axis] = wh_chain_has(&chain, axis) ? q[axis] : 0;
    }
    wh_pose_t pose;
    wh_chain_forward(&chain, q, &pose);
    hash = wh_hash_pose(hash, &pose);
    const wh_chain_choice_t choice = {q[WH_CHAIN_RAIL], q[WH_CHAIN_FLIP], WH_ELBOW_NEAR};
    bool good = wh_chain_validate(&chain) == WH_OK;
    good = wh_chain_inverse(&chain, &pose, &choice, q, q) == WH_OK && good;
    wh_vec3_t step;
    step.x = uniform(-50, 50);
    step.y = uniform(-50, 50);
    step.z = uniform(-1, 1);
    wh_chain_line_t line;
    const wh_status_t status = wh_chain_line_plan(&line, &chain, q, &step, &caps);
    hash = wh_hash_int(hash, (int32_t)status);
    if (status == WH_OK) {
        add(wh_chain_line_duration(&line));
        wh_chain_line_at(&line, wh_chain_line_duration(&line) * uniform(0, 1), q);
    }
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        add(q[axis]);
    }
    return good;
}

/* A wafer before a gripper, either face towards it, and turned over; on passive pads; on its way in
 * an edge grip, with the notch at some angles to a rest. False if a call is refused, or a gripped
 * wafer is not held. */
static bool grips(void) {
    static const double along[4] = {-8, -2, -0.125, 4};
    const wh_pose_t gripper = somewhere(60, 2);
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    const wh_edge_t edge = wh_edge_default(150);
    wh_pose_t wafer = somewhere(60, 2);
    wh_face_t face = WH_FACE_BACK;
    wh_proximity_t p;
    if (below(2) == 0) {
        wh_face_turn_over(&gripper, &wafer);
    }
    bool good = wh_face_measure(&wafer, WH_REAL(0.775), &gripper, &tolerance, &face, &p) == WH_OK;
    hash = wh_hash_pose(hash, &wafer);
    hash = wh_hash_int(hash, (int32_t)face);
    add(p.dr_proj_z);
    add(p.dr_proj_xy_norm);
    add(wh_face_swept_radius(150, WH_REAL(0.775), p.dr_proj_z));
    const wh_passive_t passive = {tolerance, below(2) == 0 ? WH_CHECK_SAMPLED : WH_CHECK_SWEPT,
                                  WH_REAL(0.775)};
    const wh_pose_t support = somewhere(10, 0);
    wh_pose_t begin = somewhere(10, 2);
    wh_passive_wafer_t lying = {support, support, false};
    for (int slice = 0; slice < 3; ++slice) {
        const wh_pose_t end = somewhere(10, 2);
        wh_passive_change_t change = WH_PASSIVE_STAYS;
        good = wh_passive_step(&passive, &begin, &end, &support, &lying, &change) == WH_OK && good;
        hash = wh_hash_pose(wh_hash_int(hash, (int32_t)change), &lying.base_from_wafer);
        begin = end;
    }
    wh_edge_wafer_t lies = wh_edge_wafer_nominal(150 + ((double)below(200) - 100) / 1000);
    const double tangent = 0.5773 + ((double)below(100) - 50) / 5000;
    lies.notch_x = 1 / sqrt(1 + tangent * tangent);
    lies.notch_y = tangent * lies.notch_x;
    lies.x = ((double)below(3000) - 1500) / 1000;
    lies.y = ((double)below(3000) - 1500) / 1000;
    for (size_t i = 0; i < 4; ++i) {
        wh_edge_place_t place = {WH_EDGE_FREE, WH_EDGE_SHORT, false, 0, 0, 0, 0};
        good = wh_edge_at(&edge, &lies, along[i], &place) == WH_OK && good;
        hash = wh_hash_int(hash, (int32_t)place.phase);
        add_double(place.s);
        add_double(place.x);
        add_double(place.y);
        good = good && (i < 3 || place.held);
    }
    return good;
}

/* 200 of them. */
static int report_grips(void) {
    bool good = true;
    hash = WH_HASH_START;
    for (int wafer = 0; wafer < 200; ++wafer) {
        good = grips() && good;
    }
    return report("grips", good);
}

static void place_wafers(wh_wafer_t wafers[WAFERS], wh_edge_wafer_t shapes[WAFERS],
                         const wh_pose_t *support) {
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w].base_from_wafer = somewhere(20, 2);
        shapes[w] = wh_edge_wafer_nominal(150);
        if (w % 2 == 1) {
            wh_face_turn_over(support, &wafers[w].base_from_wafer);
        }
    }
}

static void redraw_inputs(wh_gripper_input_t inputs[GRIPPERS], bool all) {
    for (size_t g = 0; g < GRIPPERS; ++g) {
        if (all || below(4) == 0) {
            inputs[g].base_from_gripper = somewhere(3, 2);
            inputs[g].valve = (int32_t)below(2);
        }
    }
}

/* Steps of a table with vacuum, an edge grip and passive pads. Some wafers lie face down. Slices
 * are long enough for plungers to reach their ends. False if a call is refused. */
static bool mix(wh_check_t check, bool seat) {
    static wh_wafer_t wafers[WAFERS];
    static wh_wafer_t seen[WAFERS];
    static wh_edge_wafer_t shapes[WAFERS];
    static wh_gripper_t grippers[GRIPPERS];
    static wh_grip_state_t states[GRIPPERS];
    static wh_event_t events[WH_EVENTS_PER_GRIPPER * GRIPPERS];
    const wh_grip_t kinds[GRIPPERS] = {{WH_GRIP_VACUUM, wh_edge_default(150)},
                                       {WH_GRIP_EDGE, wh_edge_default(150)},
                                       {WH_GRIP_PASSIVE, wh_edge_default(150)}};
    const wh_pose_t supports[2] = {somewhere(10, 1), somewhere(10, 1)};
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, NULL, 0};
    const wh_grips_parts_t parts = {WH_REAL(0.775), 0.0625, kinds, shapes, supports, 2, states, seen, NULL};
    wh_grasp_config_t config = wh_grasp_config_default();
    wh_gripper_input_t inputs[GRIPPERS];
    wh_event_list_t list = {events, sizeof events / sizeof events[0], 0};
    wh_grasp_t table;
    wh_grips_t grips;
    config.check = check;
    config.seat = seat;
    place_wafers(wafers, shapes, &supports[0]);
    bool good = wh_grasp_init(&table, &config, &storage) == WH_OK;
    good = wh_grips_init(&grips, &parts, &table) == WH_OK && good;
    for (int step = 0; step < 1000; ++step) {
        redraw_inputs(inputs, step == 0);
        good = wh_grips_step(&grips, inputs, &list) == WH_OK && good;
        for (size_t i = 0; i < list.count; ++i) {
            add_event(&events[i]);
            hash = wh_hash_int(hash, (int32_t)events[i].face);
        }
        hash = wh_hash_word(hash, wh_grips_hash(&grips));
        hash = wh_hash_int(hash, wh_grips_support(&grips, (size_t)step % WAFERS));
    }
    return good && table.counters.picked > 0;
}

static int report_mixed(void) {
    bool good = true;
    hash = WH_HASH_START;
    for (int way = 0; way < 4; ++way) {
        good = mix(way < 2 ? WH_CHECK_SAMPLED : WH_CHECK_SWEPT, way % 2 != 0) && good;
    }
    return report("mixed", good);
}

int main(void) {
    state = 20240229;
    hash = WH_HASH_START;
    bool good = true;
    for (int way = 0; way < 4; ++way) {
        good = steps(way < 2 ? WH_CHECK_SAMPLED : WH_CHECK_SWEPT, way % 2 != 0) && good;
    }
    int failed = report("steps", good);
    wh_robot_t robot;
    wh_robot_default(&robot);
    hash = WH_HASH_START;
    for (int call = 0; call < CALLS; ++call) {
        trigonometry();
        profiles();
        moves(&robot);
    }
    failed += report("motion", true);
    hash = WH_HASH_START;
    good = snapshot();
    failed += report("snapshot", good);
    state = 20240229;
    hash = WH_HASH_START;
    add_double(wh_ln(3));
    for (int call = 0; call < CALLS; ++call) {
        deviates();
    }
    failed += report("deviate", true);
    hash = WH_HASH_START;
    good = scans();
    failed += report("scan", good);
    hash = WH_HASH_START;
    good = true;
    for (int wafer = 0; wafer < 20; ++wafer) {
        good = pass_beams() && good;
    }
    failed += report("beams", good);
    hash = WH_HASH_START;
    good = true;
    for (uint32_t call = 0; call < 300; ++call) {
        good = chains(call) && good;
    }
    failed += report("chains", good);
    failed += report_grips();
    failed += report_mixed();
    return failed;
}
