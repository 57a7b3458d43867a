/* Moves. Oracle: each axis is planned alone, and the slowest decides. Ways: limits and the circle
 * are kept at each sample, and none of 200 inner positions is faster. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "math/trig.h"
#include "motion/move.h"
#include "motion/way.h"
#include "support/support.h"

#define MOVES (100000 / WH_TEST_SHARE)

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

/* To the last bit, also for axes that do not move or hardly move. */
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

/* An axis that takes extremely long and one that takes almost no time cannot move together, in
 * whatever order they stand and whatever stands between them. */
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

/* A move that takes exactly the longest time is accepted. */
static void a_move_that_takes_longer_than_it_may_changes_nothing(void **state) {
    (void)state;
    const wh_real_t from[2] = {0, 0};
    const wh_real_t to[2] = {100, 7};
    const wh_limits_t limits[2] = {{100, 500, 5000}, {10, 50, 500}};
    wh_move_t move;
    wh_move_t again;
    assert_int_equal(wh_move_plan(&move, 2, from, to, limits), WH_OK);
    const wh_real_t seconds = wh_move_duration(&move);
    assert_int_equal(wh_move_plan_within(&again, 2, from, to, limits, seconds), WH_OK);
    assert_near(wh_move_duration(&again), seconds, 0);
    const wh_move_t before = move;
    const wh_real_t less = seconds * WH_REAL(0.9999);
    assert_int_equal(wh_move_plan_within(&move, 2, from, to, limits, less), WH_STATUS_BAD_SEGMENT);
    assert_memory_equal(&move, &before, sizeof move);
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

/* ----------------------------------------------------------------------------------------------------------------- ways */

#define WAYS (400 / WH_TEST_SHARE)
#define SAMPLES 600

#if defined(WH_FLOAT)
#define WAY_TOLERANCE 2e-3
#else
#define WAY_TOLERANCE 1e-9
#endif

typedef struct {
    wh_robot_t robot;
    wh_real_t from[WH_ROBOT_AXES], to[WH_ROBOT_AXES];
    wh_real_t reach;
} transit_t;

static transit_t random_transit(int i) {
    transit_t t;
    wh_robot_default(&t.robot);
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        wh_limits_t *limits = &t.robot.limits[axis];
        limits->speed *= WH_REAL(wh_test_decades(0.3, 3));
        limits->acceleration *= WH_REAL(wh_test_decades(0.3, 3));
        limits->jerk *= WH_REAL(wh_test_decades(0.3, 3));
        const double min = (double)t.robot.travel[axis].min;
        const double max = (double)t.robot.travel[axis].max;
        const double share = axis == WH_AXIS_Z ? 0.2 : 1;
        t.from[axis] = WH_REAL(wh_test_uniform(min, max));
        t.to[axis] = t.from[axis] + WH_REAL(share * (wh_test_uniform(min, max) - (double)t.from[axis]));
    }
    t.reach = WH_REAL(i % 10 == 0 ? 300 : wh_test_uniform(300, 700));
    return t;
}

/* The axes at SAMPLES + 1 instants, and three more on each side. */
static double sample(const wh_way_t *way, wh_real_t q[SAMPLES + 7][WH_ROBOT_AXES]) {
    const double apart = (double)wh_way_duration(way) / SAMPLES;
    for (int k = 0; k < SAMPLES + 7; ++k) {
        wh_way_at(way, WH_REAL(apart * (k - 3)), q[k]);
    }
    return apart;
}

/* The largest divided difference of an order, 1 to 3, of an axis. */
static double difference(wh_real_t q[SAMPLES + 7][WH_ROBOT_AXES], size_t axis, int order, double apart) {
    double row[SAMPLES + 7];
    double most = 0;
    for (int k = 0; k < SAMPLES + 7; ++k) {
        row[k] = (double)q[k][axis];
    }
    for (int i = 0; i < order; ++i) {
        for (int k = 0; k + 1 < SAMPLES + 7 - i; ++k) {
            row[k] = (row[k + 1] - row[k]) / apart;
        }
    }
    for (int k = 0; k < SAMPLES + 7 - order; ++k) {
        most = fmax(most, fabs(row[k]));
    }
    return most;
}

static void assert_limits_kept(const transit_t *t, wh_real_t q[SAMPLES + 7][WH_ROBOT_AXES], double apart) {
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const wh_limits_t *limits = &t->robot.limits[axis];
        const double rounding = sizeof(wh_real_t) == 4 ? 1e-6 : 2.3e-16; /* also for a float's time */
        const double size = 1 + fabs((double)t->from[axis]) + fabs((double)t->to[axis]);
        assert_true(difference(q, axis, 1, apart) <=
                    (double)limits->speed * (1 + WAY_TOLERANCE) + 2 * rounding * size / apart);
        assert_true(difference(q, axis, 2, apart) <= (double)limits->acceleration * (1 + WAY_TOLERANCE) +
                                                         4 * rounding * size / (apart * apart));
        assert_true(difference(q, axis, 3, apart) <=
                    (double)limits->jerk * (1 + WAY_TOLERANCE) + 8 * rounding * size / pow(apart, 3));
    }
}

/* Between two ends outside the circle no turn happens outside it. */
static void assert_circle_kept(const transit_t *t, wh_real_t q[SAMPLES + 7][WH_ROBOT_AXES]) {
    const bool leads_in = t->from[WH_AXIS_R] > t->reach && t->to[WH_AXIS_R] > t->reach;
    for (int k = 1; leads_in && k < SAMPLES + 7; ++k) {
        const bool turns =
            q[k][WH_AXIS_THETA] != q[k - 1][WH_AXIS_THETA] || q[k][WH_AXIS_YAW] != q[k - 1][WH_AXIS_YAW];
        assert_false(turns && q[k][WH_AXIS_R] > t->reach && q[k - 1][WH_AXIS_R] > t->reach);
    }
}

static void ways_keep_limits_and_circle(void **state) {
    (void)state;
    int went_in = 0;
    for (int i = 0; i < WAYS; ++i) {
        const transit_t t = random_transit(i);
        static wh_real_t q[SAMPLES + 7][WH_ROBOT_AXES];
        wh_way_t way;
        assert_int_equal(wh_way_plan(&way, &t.robot, t.from, t.to, t.reach), WH_OK);
        const double apart = sample(&way, q);
        assert_memory_equal(q[0], t.from, sizeof t.from);
        assert_memory_equal(q[SAMPLES + 6], t.to, sizeof t.to);
        assert_limits_kept(&t, q, apart);
        assert_circle_kept(&t, q);
        went_in += t.from[WH_AXIS_R] > t.reach || t.to[WH_AXIS_R] > t.reach;
    }
    assert_true(went_in > WAYS / 2);
}

/* The time at which a leg from `begin` has come to `place`, by small steps and a straight line
 * between two of them. */
static double passes(const wh_profile_t *leg, double begin, double place) {
    const double duration = (double)wh_profile_duration(leg);
    double before = begin;
    for (int k = 1; k <= 20000; ++k) {
        const double now = begin + (double)wh_profile_position(leg, WH_REAL(duration * k / 20000));
        if ((before - place) * (now - place) <= 0 && now != before) {
            return duration * (k - 1 + (place - before) / (now - before)) / 20000;
        }
        before = now;
    }
    return duration;
}

/* The duration of the way over an inner position, from the header's definition. */
static double by_way_of(const transit_t *t, double inner, double turn) {
    wh_profile_t in;
    wh_profile_t out;
    const wh_limits_t *limits = &t->robot.limits[WH_AXIS_R];
    assert_int_equal(wh_profile_plan(&in, WH_REAL(inner) - t->from[WH_AXIS_R], limits), WH_OK);
    assert_int_equal(wh_profile_plan(&out, t->to[WH_AXIS_R] - WH_REAL(inner), limits), WH_OK);
    const double from = (double)t->from[WH_AXIS_R];
    const double to = (double)t->to[WH_AXIS_R];
    const double reach = (double)t->reach;
    const double begin = from > reach ? passes(&in, from, reach) : 0;
    const double end = to > reach ? passes(&out, inner, reach) : (double)out.duration;
    const double inside = (double)in.duration - begin + end;
    return (double)in.duration + (double)out.duration + fmax(0, turn - inside);
}

static void no_inner_position_is_faster(void **state) {
    (void)state;
    double worst = 0;
    for (int i = 0; i < 60 / WH_TEST_SHARE; ++i) {
        transit_t t = random_transit(i);
        t.to[WH_AXIS_Z] = t.from[WH_AXIS_Z];
        if (t.from[WH_AXIS_R] <= t.reach && t.to[WH_AXIS_R] <= t.reach) {
            continue;
        }
        wh_way_t way;
        wh_profile_t alone;
        assert_int_equal(wh_way_plan(&way, &t.robot, t.from, t.to, t.reach), WH_OK);
        double turn = 0;
        const size_t turns[] = {WH_AXIS_THETA, WH_AXIS_YAW};
        for (size_t k = 0; k < 2; ++k) {
            const size_t axis = turns[k];
            assert_int_equal(wh_profile_plan(&alone, t.to[axis] - t.from[axis], &t.robot.limits[axis]),
                             WH_OK);
            turn = fmax(turn, (double)alone.duration);
        }
        double least = 1e9;
        for (int k = 0; k < 200; ++k) {
            least = fmin(least, by_way_of(&t, (double)t.reach - ((double)t.reach - 300) * k / 199, turn));
        }
        worst = fmax(worst, (double)wh_way_duration(&way) / least - 1);
    }
    printf("at most %.4f %% above the best of 200\n", 100 * worst);
    assert_true(worst < 1e-3);
}

/* From 700 mm to 700 mm with a circle of 400 mm: no way can be faster than t_in + T_theta + t_out. */
static void a_way_is_near_its_bound(void **state) {
    (void)state;
    wh_robot_t robot;
    wh_robot_default(&robot);
    wh_profile_t far;
    assert_int_equal(wh_profile_plan(&far, 1e6, &robot.limits[WH_AXIS_R]), WH_OK);
    const double passing = passes(&far, 0, 300);
    wh_profile_t near;
    assert_int_equal(wh_profile_plan(&near, 300, &robot.limits[WH_AXIS_R]), WH_OK);
    double worst = 0;
    for (int turn_deg = 30; turn_deg <= 180; turn_deg += 25) {
        const wh_real_t from[WH_ROBOT_AXES] = {0, 700, 900, 0};
        const wh_real_t to[WH_ROBOT_AXES] = {wh_rad_from_deg((wh_real_t)turn_deg), 700, 900, 0};
        wh_way_t way;
        wh_profile_t turn;
        assert_int_equal(wh_way_plan(&way, &robot, from, to, 400), WH_OK);
        assert_int_equal(wh_profile_plan(&turn, to[0], &robot.limits[WH_AXIS_THETA]), WH_OK);
        const double bound = 2 * passing + (double)turn.duration;
        const double stopping = 2 * (double)near.duration + (double)turn.duration;
        const double above = (double)wh_way_duration(&way) / bound - 1;
        printf("%3d degrees: %.2f %% above the bound, stop and turn %.2f %%\n", turn_deg, 100 * above,
               100 * (stopping / bound - 1));
        assert_true(above > -1e-3);
        worst = fmax(worst, above);
    }
    assert_true(worst <= 0.03);
}

static void a_way_inside_is_a_move(void **state) {
    (void)state;
    wh_robot_t robot;
    wh_robot_default(&robot);
    const wh_real_t from[WH_ROBOT_AXES] = {0, 400, 900, 0};
    const wh_real_t to[WH_ROBOT_AXES] = {2, 500, 950, -1};
    wh_way_t way;
    wh_move_t move;
    assert_int_equal(wh_way_plan(&way, &robot, from, to, 500), WH_OK);
    assert_int_equal(wh_move_plan(&move, WH_ROBOT_AXES, from, to, robot.limits), WH_OK);
    assert_near((double)wh_way_duration(&way), (double)wh_move_duration(&move), 1e-6);
    wh_real_t q[WH_ROBOT_AXES];
    wh_real_t want[WH_ROBOT_AXES];
    for (int k = 0; k <= 20; ++k) {
        const wh_real_t t = wh_move_duration(&move) * (wh_real_t)k / 20;
        wh_way_at(&way, t, q);
        wh_move_at(&move, t, want);
        for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
            assert_near((double)q[axis], (double)want[axis], 1e-9 * (sizeof(wh_real_t) == 4 ? 1e6 : 1));
        }
    }
}

static void bad_ways_are_refused(void **state) {
    (void)state;
    wh_robot_t robot;
    wh_robot_default(&robot);
    wh_real_t from[WH_ROBOT_AXES] = {0, 700, 900, 0};
    const wh_real_t to[WH_ROBOT_AXES] = {1, 700, 900, 0};
    wh_way_t way;
    memset(&way, 0x5a, sizeof way);
    const wh_way_t before = way;
    assert_int_equal(wh_way_plan(&way, NULL, from, to, 400), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_way_plan(&way, &robot, from, to, 299), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(wh_way_plan(&way, &robot, from, to, (wh_real_t)NAN), WH_STATUS_NOT_FINITE);
    from[2] = (wh_real_t)INFINITY;
    assert_int_equal(wh_way_plan(&way, &robot, from, to, 400), WH_STATUS_NOT_FINITE);
    from[2] = 900;
    robot.limits[WH_AXIS_YAW].speed = 0;
    assert_int_equal(wh_way_plan(&way, &robot, from, to, 400), WH_STATUS_BAD_LIMITS);
    assert_memory_equal(&way, &before, sizeof way);
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
        cmocka_unit_test(a_move_that_takes_longer_than_it_may_changes_nothing),
        cmocka_unit_test(bad_arguments_change_nothing),
        cmocka_unit_test(ways_keep_limits_and_circle),
        cmocka_unit_test(no_inner_position_is_faster),
        cmocka_unit_test(a_way_is_near_its_bound),
        cmocka_unit_test(a_way_inside_is_a_move),
        cmocka_unit_test(bad_ways_are_refused),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
