/* Counts the instructions of the library's calls on this machine's processor, one by one. Run it
 * under `valgrind --tool=callgrind`, to which each case is a dump with its name. The counts repeat
 * exactly; the cost around a call is taken off (the case `nothing`).
 * tests/end_to_end/instruction_counts compares them with instructions.txt.
 *
 * Tables have one gripper. idle: it moves by 0.4 mm and no wafer is near; turning: it turns as
 * well; near: it moves within a wafer's neighbourhood; take, carry, release: it does so; worst: all
 * wafers are ready, each nearer than those before. */
#include <stdio.h>
#include <stdlib.h>
#include <valgrind/callgrind.h>

#include "batch/batch.h"
#include "bench/ours.h"
#include "sim/simulator.h"

#define COUNT(name, statement)                                                                               \
    do {                                                                                                     \
        CALLGRIND_ZERO_STATS;                                                                                \
        statement;                                                                                           \
        CALLGRIND_DUMP_STATS_AT(name);                                                                       \
    } while (0)

/* Results go here, so that the compiler can leave out none of the calls. */
static volatile double sink;

static wh_pose_t at(double x, double y, double z) {
    wh_pose_t pose = wh_pose_identity();
    pose.r = wh_vec3(x, y, z);
    return pose;
}

static void must(bool right, const char *what) {
    if (!right) {
        (void)fprintf(stderr, "WRONG: %s\n", what);
        exit(1);
    }
}

/* ----------------------------------------------------------------------------------------------- the check */
static void count_check(const char *name, const wh_pose_t *gripper, bool wanted) {
    const wh_pose_t wafer = at(0, 0, 0);
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    bool ready = false;
    COUNT(name, ready = wh_proximity_ready(&wafer, gripper, &tolerance));
    must(ready == wanted, name);
}

static void count_checks(void) {
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    const wh_pose_t wafer = at(0, 0, 0);
    const wh_pose_t near = at(1, 2, 0.1);
    const wh_pose_t below = at(0, 0, -10);
    const wh_pose_t aside = at(60, 0, 0);
    wh_pose_t tilted = near;
    wh_proximity_t p = {0};
    wh_sin_cos(0.2, &tilted.R.m[2][1], &tilted.R.m[1][1]);
    tilted.R.m[2][2] = tilted.R.m[1][1];
    tilted.R.m[1][2] = -tilted.R.m[2][1];
    count_check("check too_high", &below, false);
    count_check("check too_far_aside", &aside, false);
    count_check("check too_tilted", &tilted, false);
    count_check("check accepted", &near, true);
    COUNT("measure", sink = wh_proximity_measure(&wafer, &near, &tolerance, &p));
    COUNT("validate a pose", sink = wh_pose_validate(&near));
    must(p.ready, "measure");
}

/* ------------------------------------------------------------------------------------------------- batches */
enum { WAFERS = 1000 };

static void count_batch(const char *name, wh_batch_code_t code) {
    static float numbers[WH_BATCH_NUMBERS(WAFERS)];
    static uint32_t bits[WH_BATCH_WORDS(WAFERS)];
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    wh_pose_t *wafers = bench_wafers(WAFERS, BENCH_COLUMN);
    wh_batch_t batch;
    must(wh_batch_init(&batch, wafers, WAFERS, numbers, WH_BATCH_NUMBERS(WAFERS)) == WH_OK, "a batch");
    if (wh_batch_use(&batch, code) == WH_OK) {
        const wh_pose_t gripper = at(0, 0, 50.1);
        COUNT(name, sink = (double)wh_batch_ready(&batch, &gripper, 1, &tolerance, bits));
        must(sink >= 1, name);
    }
    free(wafers);
}

/* ------------------------------------------------------------------------------------------------ the step */
static const char *named(const char *kind, size_t count, const char *what) {
    static char name[80];
    (void)snprintf(name, sizeof name, "step %s %zu %s", kind, count, what);
    return name;
}

static void step(bench_table_t *made, double x, double y, double z, int valve) {
    const wh_gripper_input_t input = {at(x, y, z), valve};
    must(wh_grasp_step(&made->table, &input, &made->list) == WH_OK, "a step");
}

static void count_input(bench_table_t *made, const char *name, wh_gripper_input_t input, int events) {
    COUNT(name, sink = wh_grasp_step(&made->table, &input, &made->list));
    must(sink == WH_OK && made->list.count == (size_t)events, name);
}

static void count_step(bench_table_t *made, const char *name, double x, double z, int valve, int events) {
    const wh_gripper_input_t input = {at(x, 0, z), valve};
    count_input(made, name, input, events);
}

/* Turned a little since the slice before. */
static void count_turning(bench_table_t *made, const char *name, double x, double z) {
    const wh_vec3_t there = wh_vec3(x, 0, z);
    const wh_gripper_input_t input = {bench_level(0.001, &there), WH_VALVE_OPEN};
    count_input(made, name, input, 0);
}

/* Level columns of wafers; the gripper is outside, and then at the lowest wafer of the first column. */
static void count_steps(const char *kind, size_t count, bool indexed, wh_check_t check) {
    wh_pose_t *wafers = calloc(count, sizeof *wafers);
    for (size_t w = 0; w < count; ++w) {
        wafers[w] = at((double)(w / BENCH_COLUMN * BENCH_GRID), 0, (double)(w % BENCH_COLUMN * BENCH_PITCH));
    }
    bench_table_t *made = bench_table(wafers, count, indexed);
    made->table.config.check = check;
    step(made, -250, 0, -5, WH_VALVE_OPEN);
    step(made, -249.6, 0, -5, WH_VALVE_OPEN);
    count_step(made, named(kind, count, "idle"), -249.2, -5, WH_VALVE_OPEN, 0);
    count_turning(made, named(kind, count, "turning"), -248.8, -5);
    step(made, 0, 0, -5, WH_VALVE_OPEN);
    step(made, 0, 0, -2, WH_VALVE_OPEN);
    count_step(made, named(kind, count, "near"), 0.4, -2, WH_VALVE_OPEN, 0);
    count_step(made, named(kind, count, "take"), 0.4, -0.4, WH_VALVE_OPEN, 1);
    count_step(made, named(kind, count, "carry"), 0.8, -0.4, WH_VALVE_OPEN, 0);
    count_turning(made, named(kind, count, "carry turning"), 0.8, -0.4);
    count_step(made, named(kind, count, "release"), 0.8, -0.4, WH_VALVE_CLOSED, 1);
    COUNT(named(kind, count, "hash"), sink = (double)wh_grasp_hash(&made->table));
    bench_table_free(made);
    free(wafers);
}

static void count_worst(const char *kind, size_t count, bool indexed, wh_check_t check) {
    wh_pose_t *wafers = calloc(count, sizeof *wafers);
    for (size_t w = 0; w < count; ++w) {
        wafers[w] = at(0.01 * (double)w, 1, 0.48 - 0.4 * (double)w / (double)count);
    }
    bench_table_t *made = bench_table(wafers, count, indexed);
    made->table.config.check = check;
    made->table.config.seat = true;
    step(made, 500, 0, 0, WH_VALVE_OPEN);
    count_step(made, named(kind, count, "worst"), 0, 0, WH_VALVE_OPEN, 1);
    bench_table_free(made);
    free(wafers);
}

static void count_table(void) {
    static const size_t counts[] = {2, 25, 100, 1000};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i) {
        count_steps("plain", counts[i], false, WH_CHECK_SAMPLED);
        count_steps("indexed", counts[i], true, WH_CHECK_SAMPLED);
        count_steps("indexed swept", counts[i], true, WH_CHECK_SWEPT);
        count_worst("plain", counts[i], false, WH_CHECK_SAMPLED);
        count_worst("indexed", counts[i], true, WH_CHECK_SAMPLED);
        count_worst("indexed swept", counts[i], true, WH_CHECK_SWEPT);
    }
}

/* ---------------------------------------------------------------------------------------------------- motion */
static void count_plans(const wh_robot_t *robot) {
    const wh_real_t from[WH_ROBOT_AXES] = {0, 300, 900, 0};
    const wh_real_t to[WH_ROBOT_AXES] = {1, 700, 950, -1};
    wh_profile_t profile;
    wh_move_t move;
    COUNT("profile, long", sink = wh_profile_plan(&profile, 700, &robot->limits[WH_AXIS_R]));
    COUNT("profile, short", sink = wh_profile_plan(&profile, 1, &robot->limits[WH_AXIS_R]));
    COUNT("move of 4 axes", sink = wh_move_plan(&move, WH_ROBOT_AXES, from, to, robot->limits));
    must(wh_move_duration(&move) > 0, "a plan");
}

static void count_kinematics(const wh_machine_t *machine) {
    const wh_real_t axes[WH_AXES] = {0.3, 700, 900, -0.2};
    wh_pose_t poses[WH_GRIPPERS];
    wh_real_t q[WH_ROBOT_AXES];
    COUNT("forward", wh_robot_forward(axes, &poses[0]));
    COUNT("inverse", sink = wh_robot_inverse(&machine->robot, 600, 100, 900, 0.1, axes, q));
    COUNT("grippers of a machine", wh_machine_grippers(machine, axes, poses));
    sink = poses[0].r.x + q[0];
}

static void count_track(const wh_machine_t *machine) {
    wh_track_t track;
    must(wh_track_init(&track, machine, 1000) == WH_OK, "a track");
    wh_segment_t segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_AXES;
    segment.target[WH_AXIS_R] = 700;
    segment.target[WH_AXIS_THETA] = 1;
    COUNT("track begins a move", sink = wh_track_begin(&track, &segment));
    (void)wh_track_next(&track, 0);
    COUNT("track's slice of a move", sink = wh_track_next(&track, 0));
    wh_track_skip(&track);
    segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_LINE;
    segment.travel = wh_vec3(50, 20, 0);
    COUNT("track begins a line", sink = wh_track_begin(&track, &segment));
    (void)wh_track_next(&track, 0);
    COUNT("track's slice of a line", sink = wh_track_next(&track, 0));
    must(sink == WH_TRACK_MOVING, "a line");
}

static void count_motion(void) {
    wh_machine_t machine = {.axis_count = WH_ROBOT_AXES, .gripper_count = 1};
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[WH_AXIS_YAW];
    machine.mounts[0].axis = WH_NONE;
    count_plans(&machine.robot);
    count_kinematics(&machine);
    count_track(&machine);
}

/* ------------------------------------------------------------------------------------------------- simulator */
static void count_simulator(void) {
    static wh_simulator_t simulator;
    static wh_wafer_t wafers[2];
    static wh_gripper_t gripper;
    static wh_command_t command;
    wh_state_t state;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, 2, &gripper, 1, NULL, 0};
    wh_station_t station = {.base_from_station = at(0, 0, 0), .slots = 2, .pitch = 10, .chuck = WH_NONE};
    const wh_cell_t cell = {.stations = &station, .count = 1, .tolerance = config.tolerance};
    wafers[0].base_from_wafer = at(0, 0, 0);
    wafers[1].base_from_wafer = at(0, 0, 10);
    must(wh_simulator_init(&simulator, &config, &storage, &cell) == WH_OK, "a simulator");
    command = (wh_command_t){.gripper_count = 1, .axis_count = WH_ROBOT_AXES};
    command.grippers[0] = (wh_gripper_input_t){at(500, 0, 0), WH_VALVE_OPEN};
    for (command.seq = 1; command.seq < 4; ++command.seq) {
        command.utime = 1000 * command.seq;
        COUNT("simulator's slice, idle", sink = wh_simulator_step(&simulator, &command, &state));
    }
    command.grippers[0].base_from_gripper = at(0, 0, 0.1);
    COUNT("simulator's slice, take", sink = wh_simulator_step(&simulator, &command, &state));
    must(state.event_count >= 1 && state.grippers[0].wafer == 0, "a simulator takes");
    ++command.seq;
    COUNT("simulator's slice, carry", sink = wh_simulator_step(&simulator, &command, &state));
    COUNT("simulator's hash", sink = (double)wh_simulator_hash(&simulator));
}

static void count_estimate(void) {
    static bench_scan_t made;
    wh_status_t verdict = WH_STATUS_BAD_SCAN;
    bench_scan_make(&made);
    COUNT("estimate 3600", verdict = bench_scan_estimate(&made));
    must(verdict == WH_OK, "an estimate");
}

int main(void) {
    COUNT("nothing", (void)0);
    count_checks();
    count_batch("batch portable 1000", WH_BATCH_PORTABLE);
    count_batch("batch avx2 1000", WH_BATCH_AVX2);
    count_table();
    count_motion();
    count_simulator();
    count_estimate();
    return 0;
}
