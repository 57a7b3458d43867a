/* Oracle: each axis planned alone; the slowest decides. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "motion/move.h"
#include "support/support.h"

#define MOVES 100000

#if defined(WH_FLOAT)
#define TOLERANCE 5e-6
#define APART 1e17F
#else
#define TOLERANCE 1e-13
#define APART 1e287
#endif

typedef struct {
    size_t count;
    wh_real_t from[WH_AXES], to[WH_AXES];
    wh_limits_t limits[WH_AXES];
} task_t;

static task_t random_task(void) {
    task_t task;
    memset(&task, 0, sizeof task);
    task.count = 1 + (size_t)(wh_test_random() % WH_AXES);
    for (size_t axis = 0; axis < task.count; ++axis) {
        task.from[axis] = (wh_real_t)wh_test_uniform(-1000, 1000);
        task.to[axis] = (wh_real_t)wh_test_uniform(-1000, 1000);
        if (wh_test_random() % 4 == 0) {
            task.to[axis] = task.from[axis];
        } else if (wh_test_random() % 4 == 0) {
            task.to[axis] = task.from[axis] + (wh_real_t)wh_test_decades(1e-9, 1);
        }
        task.limits[axis].speed = (wh_real_t)wh_test_decades(1, 2000);
        task.limits[axis].acceleration = (wh_real_t)wh_test_decades(10, 20000);
        task.limits[axis].jerk = (wh_real_t)wh_test_decades(100, 200000);
    }
    return task;
}

static wh_move_t plan(const task_t *task) {
    wh_move_t move;
    assert_int_equal(wh_move_plan(&move, task->count, task->from, task->to, task->limits), WH_OK);
    return move;
}

static void the_slowest_axis_decides(void **state) {
    (void)state;
    for (int i = 0; i < MOVES; ++i) {
        const task_t task = random_task();
        const wh_move_t move = plan(&task);
        wh_real_t slowest = 0;
        for (size_t axis = 0; axis < task.count; ++axis) {
            wh_profile_t alone;
            assert_int_equal(wh_profile_plan(&alone, task.to[axis] - task.from[axis], &task.limits[axis]),
                             WH_OK);
            slowest = alone.duration > slowest ? alone.duration : slowest;
        }
        assert_near(wh_move_duration(&move), slowest, 0);
    }
}

/* To the last bit, axes that do not move or hardly so among them. */
static void each_axis_is_planned_alone_and_stretched(void **state) {
    (void)state;
    for (int i = 0; i < MOVES; ++i) {
        task_t task = random_task();
        if (i % 8 == 0) {
            task.from[0] = 0;
            task.to[0] = WH_PROFILE_TINY / 2;
        }
        const wh_move_t move = plan(&task);
        for (size_t axis = 0; axis < task.count; ++axis) {
            wh_profile_t alone;
            assert_int_equal(wh_profile_plan(&alone, task.to[axis] - task.from[axis], &task.limits[axis]),
                             WH_OK);
            assert_int_equal(wh_profile_stretch(&alone, wh_move_duration(&move)), WH_OK);
            assert_memory_equal(&move.profile[axis], &alone, sizeof alone);
        }
    }
}

static void no_axis_exceeds_its_limits(void **state) {
    (void)state;
    for (int i = 0; i < MOVES; ++i) {
        const task_t task = random_task();
        const wh_move_t move = plan(&task);
        for (size_t axis = 0; axis < task.count; ++axis) {
            const wh_profile_t *profile = &move.profile[axis];
            const wh_limits_t *limits = &task.limits[axis];
            assert_near(profile->duration, move.duration, 0);
            assert_true((double)wh_profile_peak_speed(profile) <= (double)limits->speed * (1 + TOLERANCE));
            assert_true((double)wh_profile_peak_acceleration(profile) <=
                        (double)limits->acceleration * (1 + TOLERANCE));
            assert_true((double)wh_profile_peak_jerk(profile) <= (double)limits->jerk * (1 + TOLERANCE));
        }
    }
}

static void ends_are_exact(void **state) {
    (void)state;
    for (int i = 0; i < MOVES; ++i) {
        const task_t task = random_task();
        const wh_move_t move = plan(&task);
        const size_t size = task.count * sizeof(wh_real_t);
        const wh_real_t begin[] = {0, -1, (wh_real_t)NAN};
        for (size_t k = 0; k < 3 && move.duration > 0; ++k) {
            wh_real_t position[WH_AXES];
            wh_move_at(&move, begin[k], position);
            assert_memory_equal(position, task.from, size);
        }
        const wh_real_t end[] = {move.duration, move.duration * 2 + 1, (wh_real_t)INFINITY};
        for (size_t k = 0; k < 3; ++k) {
            wh_real_t position[WH_AXES];
            wh_move_at(&move, end[k], position);
            assert_memory_equal(position, task.to, size);
        }
    }
}

static void axes_stay_between_their_ends(void **state) {
    (void)state;
    for (int i = 0; i < MOVES; ++i) {
        const task_t task = random_task();
        const wh_move_t move = plan(&task);
        wh_real_t position[WH_AXES];
        wh_move_at(&move, (wh_real_t)wh_test_uniform(0, (double)move.duration), position);
        for (size_t axis = 0; axis < task.count; ++axis) {
            const double from = (double)task.from[axis];
            const double to = (double)task.to[axis];
            const double middle = (from + to) / 2;
            assert_near(position[axis], middle, fabs(to - middle) + 1000 * TOLERANCE);
            if (task.from[axis] == task.to[axis]) {
                assert_near(position[axis], from, 0);
            }
        }
    }
}

static void a_move_to_nowhere_takes_no_time(void **state) {
    (void)state;
    const wh_real_t here[2] = {3, -4};
    const wh_limits_t limits[2] = {{1, 1, 1}, {1, 1, 1}};
    wh_move_t move;
    assert_int_equal(wh_move_plan(&move, 2, here, here, limits), WH_OK);
    assert_near(wh_move_duration(&move), 0, 0);
    for (int t = -1; t <= 1; ++t) {
        wh_real_t position[2];
        wh_move_at(&move, (wh_real_t)t, position);
        assert_memory_equal(position, here, sizeof here);
    }
}

static void a_move_goes_on_from_the_last_ones_end(void **state) {
    (void)state;
    task_t task = random_task();
    wh_move_t move = plan(&task);
    wh_real_t further[WH_AXES] = {1, 2, 3, 4, 5, 6, 7, 8};
    assert_int_equal(wh_move_plan(&move, task.count, move.to, further, task.limits), WH_OK);
    memcpy(task.from, task.to, sizeof task.from);
    memcpy(task.to, further, sizeof task.to);
    const wh_move_t want = plan(&task);
    assert_near(move.duration, want.duration, 0);
    for (size_t axis = 0; axis < task.count; ++axis) {
        assert_near(move.from[axis], task.from[axis], 0);
        assert_near(move.to[axis], further[axis], 0);
        assert_near(move.profile[axis].jerk, want.profile[axis].jerk, 0);
    }
}

/* An axis that takes ages and one that takes no time to speak of cannot go together, in whatever order they stand and
 * whatever stands between them. */
static void durations_too_far_apart_are_refused(void **state) {
    (void)state;
    enum { AGES, INSTANT, USUAL, STILL, KINDS };
    static const wh_limits_t kinds[KINDS] = {
        {WH_REAL(1e-20), 1, 1}, {WH_REAL(1e20), WH_REAL(1e25), WH_REAL(1e30)}, {1, 1, 1}, {1, 1, 1}};
    static const wh_real_t distances[KINDS] = {APART, WH_REAL(1e-9), 1, 0};
    for (int order = 0; order < 256; ++order) {
        const wh_real_t from[4] = {0};
        wh_real_t to[4];
        wh_limits_t limits[4];
        int count[KINDS] = {0};
        for (int axis = 0; axis < 4; ++axis) {
            const int kind = order >> (2 * axis) & 3;
            limits[axis] = kinds[kind];
            to[axis] = distances[kind];
            ++count[kind];
        }
        wh_move_t move;
        const bool apart = count[AGES] > 0 && count[INSTANT] > 0;
        assert_int_equal(wh_move_plan(&move, 4, from, to, limits), apart ? WH_STATUS_BAD_LIMITS : WH_OK);
    }
}

static void bad_arguments_change_nothing(void **state) {
    (void)state;
    const task_t task = random_task();
    wh_move_t move = plan(&task);
    wh_move_t before;
    memcpy(&before, &move, sizeof move);
    const wh_real_t from[WH_AXES + 1] = {0};
    wh_real_t to[WH_AXES + 1] = {1, 1};
    wh_limits_t limits[WH_AXES + 1] = {{1, 1, 1}, {1, 1, 1}};
    assert_int_equal(wh_move_plan(NULL, 2, from, to, limits), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_move_plan(&move, 2, NULL, to, limits), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_move_plan(&move, 2, from, NULL, limits), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_move_plan(&move, 2, from, to, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_move_plan(&move, 0, from, to, limits), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_move_plan(&move, WH_AXES + 1, from, to, limits), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_move_plan(&move, 3, from, to, limits), WH_STATUS_BAD_LIMITS);
    const wh_limits_t apart[2] = {{WH_REAL(1e-20), 1, 1}, {WH_REAL(1e20), WH_REAL(1e25), WH_REAL(1e30)}};
    const wh_real_t far_off[2] = {APART, WH_REAL(1e-9)};
    assert_int_equal(wh_move_plan(&move, 2, from, far_off, apart), WH_STATUS_BAD_LIMITS);
    to[1] = (wh_real_t)NAN;
    assert_int_equal(wh_move_plan(&move, 2, from, to, limits), WH_STATUS_NOT_FINITE);
    assert_memory_equal(&move, &before, sizeof move);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_slowest_axis_decides),
        cmocka_unit_test(each_axis_is_planned_alone_and_stretched),
        cmocka_unit_test(no_axis_exceeds_its_limits),
        cmocka_unit_test(ends_are_exact),
        cmocka_unit_test(axes_stay_between_their_ends),
        cmocka_unit_test(a_move_to_nowhere_takes_no_time),
        cmocka_unit_test(a_move_goes_on_from_the_last_ones_end),
        cmocka_unit_test(durations_too_far_apart_are_refused),
        cmocka_unit_test(bad_arguments_change_nothing),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
