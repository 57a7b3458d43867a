/* Slices counted one after another: every change from one to the next, alone or with others, is
 * noted in that very slice. The oracle looks at everything anew in each slice. */
#include "support/pose.h"

#include "record/activity.h"

enum { GRIPPERS = 3, SLICES = 20000, FIRST = WH_BUSY_ROBOTS };

typedef struct {
    int64_t shares[WH_SHARES];
    wh_busy_span_t intervals[4 * SLICES];
    size_t count;
    int32_t what[WH_RESOURCES];
    int64_t begin[WH_RESOURCES];
} oracle_t;

static oracle_t oracle;
static wh_activity_t activity;
static wh_machine_t machine;
static wh_command_t command;
static wh_gripper_t grippers[GRIPPERS];
static wh_state_t answer;
static wh_task_t task;

/* A gripper on the robot, two on chucks. */
static int set_up(void **state) {
    (void)state;
    memset(&oracle, 0, sizeof oracle);
    memset(&activity, 0, sizeof activity);
    memset(&machine, 0, sizeof machine);
    memset(&command, 0, sizeof command);
    memset(&task, 0, sizeof task);
    machine.axis_count = 6;
    machine.gripper_count = GRIPPERS;
    for (int32_t g = 0; g < GRIPPERS; ++g) {
        machine.mounts[g].axis = g == 0 ? WH_NONE : 3 + g;
        grippers[g].wafer = WH_NONE;
        command.grippers[g].valve = WH_VALVE_CLOSED;
    }
    answer.grippers = grippers;
    answer.gripper_count = GRIPPERS;
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    wh_activity_free(&activity);
    return 0;
}

/* The work of resource `r` in this slice of this share: the meaning of wh_busy_t. */
static int32_t busy(size_t r, wh_share_t share) {
    const size_t g = r >= FIRST ? (r - FIRST) / 3 : GRIPPERS;
    if (r == 0) {
        return task.robot ? 1 + (int32_t)share : 0;
    }
    if (g >= GRIPPERS) {
        return 0;
    }
    if (r == FIRST + 3 * g) {
        const bool turns = g > 0 && (task.carried >> g & 1U) != 0;
        const wh_share_t own = grippers[g].wafer == WH_NONE ? WH_SHARE_EMPTY : WH_SHARE_LOADED;
        return turns ? 1 + (int32_t)own : 0;
    }
    return r == FIRST + 1 + 3 * g ? 1 + grippers[g].wafer : command.grippers[g].valve == WH_VALVE_OPEN;
}

static wh_share_t share_now(void) {
    bool loaded = false;
    for (size_t g = 0; g < GRIPPERS; ++g) {
        loaded = loaded || ((task.carried >> g & 1U) != 0 && grippers[g].wafer != WH_NONE);
    }
    if (loaded) {
        return WH_SHARE_LOADED;
    }
    return task.moves ? WH_SHARE_EMPTY : task.share;
}

static bool is_state(size_t r) {
    return r >= FIRST && (r - FIRST) % 3 != 0;
}

static void keep(size_t r, int32_t what, int64_t slice) {
    /* The end of the slice that reports it, for a wafer and a valve; for moving parts the end of
     * the slice before. */
    const int64_t border = is_state(r) ? slice : slice - 1;
    if (oracle.what[r] == what) {
        return;
    }
    if (oracle.what[r] != 0) {
        wh_busy_span_t *kept = &oracle.intervals[oracle.count++];
        kept->who = r == 0 ? WH_BUSY_ROBOT : (wh_busy_t)(WH_BUSY_CHUCK + (r - FIRST) % 3);
        kept->gripper = r == 0 ? 0 : (int32_t)((r - FIRST) / 3);
        kept->what = oracle.what[r];
        kept->begin = oracle.begin[r];
        kept->end = border;
        oracle.count -= kept->end == kept->begin ? 1 : 0;
    }
    oracle.what[r] = what;
    oracle.begin[r] = border;
}

static void count(void) {
    ++command.seq;
    const wh_share_t share = share_now();
    assert_int_equal(wh_activity_count(&activity, &machine, &task, &command, &answer), share);
    ++oracle.shares[share];
    for (size_t r = 0; r < WH_RESOURCES; ++r) {
        keep(r, busy(r, share), command.seq);
    }
}

/* In any order if several end at once. */
static void compare(void) {
    assert_memory_equal(activity.shares, oracle.shares, sizeof oracle.shares);
    assert_int_equal(activity.interval_count, oracle.count);
    for (size_t i = 0; i < oracle.count; ++i) {
        const wh_busy_span_t *wanted = &oracle.intervals[i];
        size_t found = 0;
        const size_t from = i > WH_RESOURCES ? i - WH_RESOURCES : 0;
        for (size_t k = from; k < oracle.count && k < i + WH_RESOURCES; ++k) {
            const wh_busy_span_t *is = &activity.intervals[k];
            found += is->who == wanted->who && is->gripper == wanted->gripper && is->what == wanted->what &&
                             is->begin == wanted->begin && is->end == wanted->end
                         ? 1
                         : 0;
        }
        assert_int_equal(found, 1);
    }
}

static void end(void) {
    wh_activity_end(&activity, command.seq);
    for (size_t r = 0; r < WH_RESOURCES; ++r) {
        keep(r, 0, is_state(r) ? command.seq : command.seq + 1);
    }
}

static void change_something(uint64_t what, size_t g) {
    switch (what) {
    case 0:
        task.moves = !task.moves;
        break;
    case 1:
        task.robot = !task.robot;
        break;
    case 2:
        task.carried ^= 1U << g;
        break;
    case 3:
        task.share = (wh_share_t)(WH_SHARE_VACUUM + (int)wh_test_below(3));
        break;
    case 4:
        grippers[g].wafer = (int32_t)wh_test_below(4) - 1;
        break;
    case 5:
        command.grippers[g].valve = WH_VALVE_CLOSED - command.grippers[g].valve;
        break;
    default:
        break;
    }
}

static void each_change_alone(void **state) {
    (void)state;
    for (int i = 0; i < SLICES; ++i) {
        change_something(wh_test_below(12), wh_test_below(GRIPPERS));
        count();
    }
    end();
    compare();
}

static void several_changes_at_once(void **state) {
    (void)state;
    for (int i = 0; i < SLICES / 4; ++i) {
        for (uint64_t k = wh_test_below(5); k > 0; --k) {
            change_something(wh_test_below(6), wh_test_below(GRIPPERS));
        }
        count();
    }
    end();
    compare();
}

/* The end of the run ends all intervals, also those that just continue. */
static void what_goes_on_after_an_end_begins_anew(void **state) {
    (void)state;
    task.moves = task.robot = true;
    task.carried = 3;
    grippers[0].wafer = 2;
    command.grippers[0].valve = WH_VALVE_OPEN;
    for (int i = 0; i < 3; ++i) {
        count();
        count();
        end();
    }
    compare();
    assert_int_equal(activity.interval_count, 3 * 4); /* robot, chuck, wafer, valve */
}

/* A slice that resembles no other is counted, too, with its own state. */
static void the_first_slice_is_like_no_other(void **state) {
    (void)state;
    for (size_t g = 0; g < GRIPPERS; ++g) {
        grippers[g].wafer = 0;
        command.grippers[g].valve = WH_VALVE_OPEN;
    }
    count();
    count();
    end();
    compare();
    assert_int_equal(activity.interval_count, 2 * GRIPPERS);
}

/* ------------------------------------------------------------------------------------------------- tasks */

static void expect_task(const wh_segment_t *segment, bool for_vacuum, const wh_task_t *wanted) {
    const wh_track_t track = {.machine = &machine, .axes = {0.5, 400, 900, 0, 0.25, 0}};
    const wh_task_t found = wh_activity_task(&track, segment, for_vacuum);
    assert_int_equal(found.share, wanted->share);
    assert_int_equal(found.moves, wanted->moves);
    assert_int_equal(found.robot, wanted->robot);
    assert_int_equal(found.carried, wanted->carried);
}

/* The robot carries the first gripper; the others turn on chucks, axes 4 and 5. */
static void a_segment_keeps_busy_what_it_moves(void **state) {
    (void)state;
    wh_segment_t segment = {
        .kind = WH_SEGMENT_AXES, .gripper = WH_NONE, .target = {0.5, 400, 900, 0, 0.25, 0}};
    /* A motion of zero length is a motion, but makes nothing busy. */
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_WAITING, true, false, 0, 0, {0}});
    segment.target[1] = 401;
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_WAITING, true, true, 1, 0, {0}});
    segment.target[4] = 0.5;
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_WAITING, true, true, 3, 0, {0}});
    segment.target[1] = 400;
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_WAITING, true, false, 2, 0, {0}});
    segment.target[5] = -1;
    segment.kind = WH_SEGMENT_WAY;
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_WAITING, true, false, 6, 0, {0}});
    segment.kind = WH_SEGMENT_LINE;
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_WAITING, true, true, 1, 0, {0}});
}

static void what_stands_still_has_its_share(void **state) {
    (void)state;
    wh_segment_t segment = {.kind = WH_SEGMENT_DWELL, .gripper = WH_NONE, .target = {9, 9, 9, 9, 9, 9}};
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_WAITING, false, true, 0, 0, {0}});
    expect_task(&segment, true, &(wh_task_t){WH_SHARE_VACUUM, false, true, 0, 0, {0}});
    segment.kind = WH_SEGMENT_SENSOR;
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_VACUUM, false, true, 0, 0, {0}});
    /* The track's valves are open. A valve that is told its own state does not switch: a log could
     * not tell. */
    segment.kind = WH_SEGMENT_VALVES;
    expect_task(&segment, false, &(wh_task_t){WH_SHARE_WAITING, false, true, 0, 0, {0}});
    segment.valves[0] = WH_NONE;
    expect_task(&segment, true, &(wh_task_t){WH_SHARE_VACUUM, false, true, 0, 0, {0}});
    segment.valves[GRIPPERS - 1] = WH_VALVE_CLOSED;
    expect_task(&segment, true, &(wh_task_t){WH_SHARE_HANDOVER, false, true, 0, 0, {0}});
}

/* ---------------------------------------------------------------------------------------- several robots */

static wh_carrier_t carriers[2];

/* Two robots of four axes: the first has gripper 0, the second grippers 1 and 2. */
static int set_up_two(void **state) {
    (void)set_up(state);
    memset(carriers, 0, sizeof carriers);
    carriers[0].axis_count = carriers[1].axis_count = 4;
    carriers[0].next = &carriers[1];
    machine.carrier = carriers;
    machine.axis_count = 8;
    for (int g = 0; g < GRIPPERS; ++g) {
        machine.mounts[g].axis = WH_NONE;
        machine.mounts[g].robot = g > 0;
    }
    return 0;
}

static void step_with(const wh_task_t *now) {
    ++command.seq;
    (void)wh_activity_count(&activity, &machine, now, &command, &answer);
}

static void expect_span(size_t i, int32_t robot, wh_share_t share, int64_t begin, int64_t last) {
    const wh_busy_span_t *span = &activity.intervals[i];
    assert_int_equal(span->who, WH_BUSY_ROBOT);
    assert_int_equal(span->gripper, robot);
    assert_int_equal(span->what, 1 + (int32_t)share);
    assert_int_equal(span->begin, begin);
    assert_int_equal(span->end, last);
}

/* One moves loaded while the other one stands for vacuum: each has its own share. */
static void each_of_several_robots_is_busy_by_itself(void **state) {
    (void)state;
    bool moving[WH_AXES] = {false};
    const bool still[WH_AXES] = {false};
    moving[5] = true;
    wh_task_t goes = wh_activity_motion(&machine, moving, WH_SHARE_WAITING);
    wh_task_t stands = wh_activity_motion(&machine, still, WH_SHARE_VACUUM);
    wh_activity_narrow(&goes, &machine, 0xF0);
    wh_activity_narrow(&stands, &machine, 0x0F);
    assert_true(goes.robot && stands.robot && goes.carried == 6);
    grippers[2].wafer = 1;
    wh_task_t both = goes;
    both.robots[0] = stands.robots[0];
    step_with(&both);
    step_with(&both);
    step_with(&stands);
    end();
    expect_span(0, 1, WH_SHARE_LOADED, 0, 2);
    expect_span(1, 0, WH_SHARE_VACUUM, 0, 3);
}

/* If nobody owns a motion, the robots that moved last stand for it; a motion without a robot makes
 * none busy. */
static void those_stand_that_went_last(void **state) {
    (void)state;
    bool moving[WH_AXES] = {false};
    const bool still[WH_AXES] = {false};
    const wh_task_t waits = wh_activity_motion(&machine, still, WH_SHARE_WAITING);
    wh_task_t nobodys = waits;
    wh_activity_narrow(&nobodys, &machine, 0);
    step_with(&waits); /* nobody has moved yet */
    moving[4] = true;
    const wh_task_t goes = wh_activity_motion(&machine, moving, WH_SHARE_WAITING);
    step_with(&goes);
    step_with(&waits);
    step_with(&nobodys);
    end();
    assert_int_equal(activity.interval_count, 2);
    expect_span(0, 1, WH_SHARE_EMPTY, 1, 2);
    expect_span(1, 1, WH_SHARE_WAITING, 2, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_change_alone, set_up, tear_down),
        cmocka_unit_test_setup_teardown(several_changes_at_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_goes_on_after_an_end_begins_anew, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_first_slice_is_like_no_other, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_segment_keeps_busy_what_it_moves, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_stands_still_has_its_share, set_up, tear_down),
        cmocka_unit_test_setup_teardown(each_of_several_robots_is_busy_by_itself, set_up_two, tear_down),
        cmocka_unit_test_setup_teardown(those_stand_that_went_last, set_up_two, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
