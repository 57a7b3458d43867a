/* Counts the instructions of the check, a step and the estimate of a scan, on a Cortex-M under
 * emulation. With `-icount shift=6` each instruction lasts 64 ns, and SysTick counts at 25 MHz.
 * Prints "NAME COUNT" for each case; the count repeats exactly.
 *
 * The worst case of a step is the worst of 20,000 random steps and of some that are built on
 * purpose. */
#include <stdio.h>

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
    return 0;
}
