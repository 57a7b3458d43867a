/* Counts the instructions of the check, a step, the estimate of a scan, an edge grip and the begin of
 * a line, on a Cortex-M under emulation. With `-icount shift=6` each instruction lasts 64 ns, and SysTick counts at 25 MHz.
 * Prints "NAME COUNT" for each case; the count repeats exactly.
 *
 * The worst case of a step is the worst of 20,000 random steps and of some that are built on
 * purpose. */
#include <stdio.h>
#include <string.h>

#include <waferhand.h>

#include "bench/ours.h"
#include "support/random.h"

enum { WAFERS = 25, GRIPPERS = 2, STEPS = 20000 };

static volatile uint32_t *const systick = (volatile uint32_t *)0xe000e010; /* control, reload, value */
static uint32_t begin;
static uint32_t overhead;

static void start(void) {
    systick[1] = 0xffffff;
    systick[2] = 0;
    systick[0] = 5; /* on, at the processor's clock, without an interrupt */
    while (systick[2] == 0) {
        /* the value is loaded with the first tick */
    }
    begin = systick[2];
}

static uint32_t stop(void) {
    const uint32_t ticks = (begin - systick[2]) & 0xffffff;
    return (uint32_t)((uint64_t)ticks * 40 / 64) - overhead;
}

/* ----------------------------------------------------------------------------------------------- the check */
static wh_pose_t at(wh_real_t x, wh_real_t y, wh_real_t z) {
    wh_pose_t pose = wh_pose_identity();
    pose.r = wh_vec3(x, y, z);
    return pose;
}

/* It is not inlined: its caller knows the poses beforehand. */
static __attribute__((noinline)) bool check(const wh_pose_t *wafer, const wh_pose_t *gripper,
                                            const wh_tolerance_t *tolerance) {
    return wh_proximity_ready(wafer, gripper, tolerance);
}

static void count_check(const char *name, const wh_pose_t *gripper, bool wanted) {
    const wh_pose_t wafer = at(0, 0, 0);
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    start();
    const bool ready = check(&wafer, gripper, &tolerance);
    const uint32_t count = stop();
    printf("check %s %u%s\n", name, (unsigned)count, ready == wanted ? "" : " WRONG");
}

static void count_measure(void) {
    const wh_pose_t wafer = at(0, 0, 0);
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    wh_proximity_t p;
    start();
    const wh_status_t status = wh_proximity_measure(&wafer, &wafer, &tolerance, &p);
    const uint32_t count = stop();
    printf("measure %u%s\n", (unsigned)count, status == WH_OK ? "" : " WRONG");
}

/* ------------------------------------------------------------------------------------------------ the step */
static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_gripper_input_t inputs[GRIPPERS];
static wh_event_t events[GRIPPERS * WH_EVENTS_PER_GRIPPER];
static wh_grasp_t table;
static uint64_t state;

static wh_real_t uniform(wh_real_t lo, wh_real_t hi) {
    return lo + (hi - lo) * ((wh_real_t)(wh_test_splitmix(&state) >> 40) / WH_REAL(16777216));
}

static void begin_table(wh_check_t check, bool seat, wh_real_t pitch) {
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = check;
    config.seat = seat;
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w].base_from_wafer = at(0, 0, (wh_real_t)w * pitch);
    }
    for (size_t g = 0; g < GRIPPERS; ++g) {
        inputs[g].base_from_gripper = at(500, (wh_real_t)g, 0);
        inputs[g].valve = WH_VALVE_OPEN;
    }
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, NULL, 0};
    (void)wh_grasp_init(&table, &config, &storage);
}

static uint32_t step(void) {
    wh_event_list_t list = {events, GRIPPERS * WH_EVENTS_PER_GRIPPER, 0};
    start();
    const wh_status_t status = wh_grasp_step(&table, inputs, &list);
    const uint32_t count = stop();
    return status == WH_OK ? count : 0;
}

/* All wafers are far away, as in most slices. */
static void count_idle(const char *name, wh_check_t check) {
    begin_table(check, false, 10);
    (void)step();
    printf("step %s idle %u\n", name, (unsigned)step());
}

/* Both grippers are open between two slots of the stack, as on their way in. No wafer is near
 * enough to be watched. */
static void count_between(const char *name, wh_check_t check) {
    begin_table(check, false, 10);
    inputs[0].base_from_gripper = at(0, 0, 115);
    inputs[1].base_from_gripper = at(0, 1, 125);
    (void)step();
    printf("step %s between %u%s\n", name, (unsigned)step(),
           grippers[0].approach.wafer == WH_NONE && grippers[0].wafer == WH_NONE ? "" : " WRONG");
}

/* Both grippers hold a wafer and move on. */
static void count_carry(void) {
    begin_table(WH_CHECK_SAMPLED, false, 10);
    inputs[0].base_from_gripper = at(0, 0, 0);
    inputs[1].base_from_gripper = at(0, 0, 10);
    (void)step();
    inputs[0].base_from_gripper = at(0, 100, 0);
    inputs[1].base_from_gripper = at(0, 100, 10);
    printf("step sampled carry %u%s\n", (unsigned)step(), table.counters.picked == 2 ? "" : " WRONG");
}

/* Both grippers reach all 25 wafers, and the last is the best. Each check runs through, and each
 * wafer is better than the one before. */
static uint32_t crowded(wh_check_t check, bool seat) {
    begin_table(check, seat, 0);
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w].base_from_wafer = at((wh_real_t)w, 1, WH_REAL(0.48) - WH_REAL(0.01) * (wh_real_t)w);
    }
    (void)step();
    inputs[0].base_from_gripper = at(0, 0, 0);
    inputs[1].base_from_gripper = at(3, 0, 0);
    return step();
}

static void draw_inputs(void) {
    for (size_t g = 0; g < GRIPPERS; ++g) {
        wh_real_t s;
        wh_real_t c;
        wh_sin_cos(uniform(-3, 3), &s, &c);
        wh_pose_t *pose = &inputs[g].base_from_gripper;
        *pose = at(uniform(-20, 20), uniform(-20, 20), uniform(-1, 1));
        pose->R.m[0][0] = pose->R.m[1][1] = c;
        pose->R.m[1][0] = s;
        pose->R.m[0][1] = -s;
        inputs[g].valve = wh_test_splitmix(&state) >> 62 == 0 ? WH_VALVE_CLOSED : WH_VALVE_OPEN;
    }
}

static void count_worst(const char *name, wh_check_t check) {
    uint32_t worst = crowded(check, true);
    const uint32_t other = crowded(check, false);
    worst = other > worst ? other : worst;
    begin_table(check, true, WH_REAL(0.04));
    state = 1;
    for (int i = 0; i < STEPS; ++i) {
        draw_inputs();
        const uint32_t count = step();
        worst = count > worst ? count : worst;
    }
    printf("step %s worst %u\n", name, (unsigned)worst);
}

/* -------------------------------------------------------------------------------------------- grips, and lines */

static const wh_edge_t edge = {150, 1.5, 1.5, 3.14159265358979323846 / 6, 2.5, -8, -0.25, 1.3, 4, 40};

/* The plunger at s, with a wafer 1 mm off centre whose notch's axis is at (x, y). */
static void count_edge(const char *name, double x, double y, double s, wh_edge_phase_t wanted) {
    wh_edge_wafer_t wafer = wh_edge_wafer_nominal(150);
    wh_edge_place_t place;
    wafer.y = 1;
    wafer.notch_x = x;
    wafer.notch_y = y;
    start();
    const wh_status_t status = wh_edge_at(&edge, &wafer, s, &place);
    const uint32_t count = stop();
    printf("edge %s %u%s\n", name, (unsigned)count, status == WH_OK && place.phase == wanted ? "" : " WRONG");
}

/* A gripper of each kind holds a wafer, and the edge grip's plunger is on its way. */
static void count_grips(void) {
    static wh_edge_wafer_t shapes[WAFERS];
    static wh_wafer_t seen[WAFERS];
    static wh_grip_state_t states[GRIPPERS];
    static const wh_grip_t kinds[GRIPPERS] = {
        {WH_GRIP_EDGE, {150, 1.5, 1.5, 3.14159265358979323846 / 6, 2.5, -8, -0.25, 1.3, 4, 40}},
        {WH_GRIP_VACUUM, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}};
    const wh_grips_parts_t parts = {0, 0.001, kinds, shapes, NULL, 0, states, seen, NULL};
    static wh_grips_t grips;
    wh_event_list_t list = {events, GRIPPERS * WH_EVENTS_PER_GRIPPER, 0};
    begin_table(WH_CHECK_SAMPLED, false, 10);
    for (size_t w = 0; w < WAFERS; ++w) {
        shapes[w] = wh_edge_wafer_nominal(150);
    }
    inputs[0].base_from_gripper = at(0, 1, 0);
    inputs[1].base_from_gripper = at(0, 0, 10);
    wh_status_t status = wh_grips_init(&grips, &parts, &table);
    for (int slice = 0; slice < 100 && status == WH_OK; ++slice) {
        status = wh_grips_step(&grips, inputs, &list);
    }
    start();
    status = status == WH_OK ? wh_grips_step(&grips, inputs, &list) : status;
    const uint32_t count = stop();
    const bool good = status == WH_OK && states[0].phase == WH_GRIP_CLOSING && table.counters.picked == 2;
    printf("step grips carry %u%s\n", (unsigned)count, good ? "" : " WRONG");
}

/* A straight line of 300 mm that begins: of the arm of motion/robot.h, and of a SCARA. */
static void count_line(const char *name, const wh_carrier_t *scara) {
    static wh_machine_t machine;
    static wh_track_t track;
    memset(&machine, 0, sizeof machine);
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[3];
    machine.carrier = scara;
    machine.axis_count = 4;
    machine.gripper_count = 1;
    machine.mounts[0].axis = WH_NONE;
    machine.mounts[0].effector_from_gripper = wh_pose_identity();
    wh_status_t status = wh_track_init(&track, &machine, 1000);
    wh_segment_t segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_LINE;
    segment.travel = wh_vec3(scara ? 0 : 300, scara ? 300 : 0, 0);
    start();
    status = status == WH_OK ? wh_track_begin(&track, &segment) : status;
    const uint32_t count = stop();
    printf("begin line %s %u%s\n", name, (unsigned)count, status == WH_OK ? "" : " WRONG");
}

static void count_lines(void) {
    static wh_chain_t chain;
    static wh_carrier_t scara;
    wh_robot_t robot;
    wh_robot_default(&robot);
    chain.kind = WH_CHAIN_SCARA;
    chain.links[0] = chain.links[1] = 400;
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        chain.limits[axis] = robot.limits[0];
        chain.travel[axis] = robot.travel[0];
    }
    chain.limits[WH_CHAIN_Z] = robot.limits[2];
    chain.travel[WH_CHAIN_Z] = robot.travel[2];
    chain.travel[WH_CHAIN_REACH].min = WH_REAL(-3);
    chain.travel[WH_CHAIN_REACH].max = WH_REAL(3);
    chain.home[WH_CHAIN_Z] = robot.travel[2].min;
    chain.home[WH_CHAIN_REACH] = 2;
    const wh_status_t status = wh_carrier_init(&scara, &chain);
    count_line("polar", NULL);
    if (!WH_REAL_IS_SLOW) { /* in software it takes longer than the counter can count */
        count_line(status == WH_OK ? "scara" : "scara WRONG", &scara);
    }
}

#if defined(__ARM_FP) && (__ARM_FP & 8) != 0
/* Here the processor has double in hardware. */
static void count_estimate(void) {
    static bench_scan_t made;
    bench_scan_make(&made);
    start();
    const wh_status_t verdict = bench_scan_estimate(&made);
    const uint32_t count = stop();
    printf("estimate 3600 %u%s\n", (unsigned)count, verdict == WH_OK ? "" : " WRONG");
}
#endif

int main(void) {
    start();
    overhead = stop();
    const wh_pose_t near = at(1, 2, WH_REAL(0.1));
    const wh_pose_t below = at(0, 0, -10);
    const wh_pose_t aside = at(60, 0, 0);
    wh_pose_t tilted = near;
    wh_sin_cos(WH_REAL(0.2), &tilted.R.m[2][1], &tilted.R.m[1][1]);
    tilted.R.m[2][2] = tilted.R.m[1][1];
    tilted.R.m[1][2] = -tilted.R.m[2][1];
    count_check("too_high", &below, false);
    count_check("too_far_aside", &aside, false);
    count_check("too_tilted", &tilted, false);
    count_check("accepted", &near, true);
    count_measure();
#if defined(__ARM_FP) && (__ARM_FP & 8) != 0
    count_estimate();
#endif
    count_idle("sampled", WH_CHECK_SAMPLED);
    count_idle("swept", WH_CHECK_SWEPT);
    count_between("sampled", WH_CHECK_SAMPLED);
    count_between("swept", WH_CHECK_SWEPT);
    count_carry();
    count_worst("sampled", WH_CHECK_SAMPLED);
    count_worst("swept", WH_CHECK_SWEPT);
    count_edge("rolling", 0, 1, -0.5, WH_EDGE_ROLLING);
    count_edge("over_notch", 0.86602540378443865, 0.5, -0.5, WH_EDGE_ROLLING);
    count_grips();
    count_lines();
    return 0;
}
