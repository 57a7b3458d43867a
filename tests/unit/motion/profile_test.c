/* Oracle: the optimal duration and its phases, computed again in long double from the limits alone,
 * and the position as the sum of the phases' polynomials. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "motion/profile.h"
#include "support/support.h"

#define SAMPLES 100000

#if defined(WH_FLOAT)
#define DURATION_TOLERANCE 2e-6
#define LIMIT_TOLERANCE 5e-6
#define ROUNDING 2e-6
#define SIZEABLE 3e38F
#else
#define DURATION_TOLERANCE 1e-14
#define LIMIT_TOLERANCE 1e-14
#define ROUNDING 5e-15
#define SIZEABLE 1.7e308
#endif

typedef struct {
    long double jerk, hold, cruise; /* the lengths of phase 1, 2 and 4 */
    long double duration;
} oracle_t;

/* Three tries: the speed limit is reached, else the acceleration limit, else neither. */
static oracle_t optimum(long double d, const wh_limits_t *limits) {
    const long double v = (long double)limits->speed;
    const long double a = (long double)limits->acceleration;
    const long double j = (long double)limits->jerk;
    oracle_t o = {a / j, v / a - a / j, 0, 0};
    if (v * j < a * a) {
        o.jerk = sqrtl(v / j);
        o.hold = 0;
    }
    o.cruise = d / v - (2 * o.jerk + o.hold);
    if (o.cruise < 0) {
        o.cruise = 0;
        o.jerk = a / j;
        /* a (tj + h) (2 tj + h) = d */
        o.hold = (sqrtl(o.jerk * o.jerk + 4 * d / a) - 3 * o.jerk) / 2;
        if (o.hold < 0) {
            o.hold = 0;
            o.jerk = cbrtl(d / (2 * j));
        }
    }
    o.duration = 4 * o.jerk + 2 * o.hold + o.cruise;
    return o;
}

static wh_limits_t random_limits(int i) {
    wh_limits_t limits = {(wh_real_t)wh_test_decades(1, 2000), (wh_real_t)wh_test_decades(10, 20000),
                          (wh_real_t)wh_test_decades(100, 200000)};
    if (i % 4 == 0) {
        limits.speed = (wh_real_t)wh_test_decades(1e-3, 1e6);
        limits.acceleration = (wh_real_t)wh_test_decades(1e-3, 1e6);
        limits.jerk = (wh_real_t)wh_test_decades(1e-3, 1e9);
    }
    return limits;
}

static wh_real_t random_distance(int i) {
    const double d = i % 2 == 0 ? wh_test_decades(1e-9, 1e5) : wh_test_uniform(1e-3, 1000);
    return (wh_real_t)(i % 3 == 0 ? -d : d);
}

static void assert_relative(wh_real_t got, long double want, double tolerance) {
    assert_near((double)((long double)got / want), 1, tolerance);
}

static wh_motion_t at(const wh_profile_t *profile, wh_real_t t) {
    wh_motion_t motion;
    wh_profile_at(profile, t, &motion);
    const wh_real_t position = wh_profile_position(profile, t);
    assert_memory_equal(&position, &motion.position, sizeof position);
    return motion;
}

static void duration_is_the_analytic_optimum(void **state) {
    (void)state;
    int cases[4] = {0, 0, 0, 0};
    for (int i = 0; i < SAMPLES; ++i) {
        const wh_limits_t limits = random_limits(i);
        const wh_real_t distance = random_distance(i);
        wh_profile_t profile;
        assert_int_equal(wh_profile_plan(&profile, distance, &limits), WH_OK);
        const oracle_t o = optimum((long double)wh_real_abs(distance), &limits);
        assert_relative(wh_profile_duration(&profile), o.duration, DURATION_TOLERANCE);
        ++cases[(o.cruise > 0) * 2 + (o.hold > 0)];
    }
    for (int k = 0; k < 4; ++k) {
        assert_true(cases[k] > SAMPLES / 100); /* every shape occurred */
    }
}

/* No peak is above its limit; a peak below its limit is so because another limit came first. */
static void each_phase_saturates_a_limit(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLES; ++i) {
        const wh_limits_t limits = random_limits(i);
        const wh_real_t distance = random_distance(i);
        wh_profile_t profile;
        assert_int_equal(wh_profile_plan(&profile, distance, &limits), WH_OK);
        const oracle_t o = optimum((long double)wh_real_abs(distance), &limits);
        const wh_real_t v = wh_profile_peak_speed(&profile) / limits.speed;
        const wh_real_t a = wh_profile_peak_acceleration(&profile) / limits.acceleration;
        const wh_real_t j = wh_profile_peak_jerk(&profile) / limits.jerk;
        assert_true((double)v <= 1 + LIMIT_TOLERANCE && (double)a <= 1 + LIMIT_TOLERANCE);
        assert_near(j, 1, LIMIT_TOLERANCE);
        if (o.hold > 0) {
            assert_near(a, 1, LIMIT_TOLERANCE);
        }
        if (o.cruise > 0) {
            assert_near(v, 1, LIMIT_TOLERANCE);
        }
    }
}

/* One phase further, by its own polynomial. */
static void advance(long double state[3], long double jerk, long double t) {
    state[0] += t * (state[1] + t * (state[2] / 2 + t * jerk / 6));
    state[1] += t * (state[2] + t * jerk / 2);
    state[2] += t * jerk;
}

/* At each phase's end and inside it: the sum of the phases up to there. */
static void states_are_the_sum_of_the_phases(void **state) {
    (void)state;
    static const int signs[7] = {1, 0, -1, 0, -1, 0, 1};
    for (int i = 0; i < SAMPLES; ++i) {
        const wh_limits_t limits = random_limits(i);
        const wh_real_t distance = random_distance(i);
        const long double sign = distance < 0 ? -1 : 1;
        wh_profile_t profile;
        assert_int_equal(wh_profile_plan(&profile, distance, &limits), WH_OK);
        const oracle_t o = optimum((long double)wh_real_abs(distance), &limits);
        const long double lengths[7] = {o.jerk, o.hold, o.jerk, o.cruise, o.jerk, o.hold, o.jerk};
        const double d = fabs((double)distance);
        const double v = (double)wh_profile_peak_speed(&profile);
        const double a = (double)wh_profile_peak_acceleration(&profile);
        /* An instant is rounded to the profile's length: the effect on each value is added. */
        const double t_round = (double)o.duration * ROUNDING;
        long double x[3] = {0, 0, 0};
        long double t = 0;
        for (int phase = 0; phase < 7; ++phase) {
            for (int half = 0; half < 2; ++half) {
                advance(x, sign * signs[phase] * (long double)limits.jerk, lengths[phase] / 2);
                t += lengths[phase] / 2;
                const wh_motion_t m = at(&profile, (wh_real_t)t);
                assert_near(m.position, (double)x[0], 4 * d * ROUNDING + v * t_round);
                assert_near(m.speed, (double)x[1], 4 * v * ROUNDING + a * t_round);
                assert_near(m.acceleration, (double)x[2], 4 * a * ROUNDING + (double)limits.jerk * t_round);
                if (half == 0 && lengths[phase] > 1e-3L * o.duration) {
                    const double jerk = (double)sign * signs[phase] * (double)wh_profile_peak_jerk(&profile);
                    assert_near(m.jerk, jerk, 0);
                }
            }
        }
        assert_near(d, (double)(x[0] * sign), d * 1e-12);
    }
}

/* Immediately before and after each phase's end, and everywhere: continuous, within the limits, in order. */
static void motion_is_continuous_and_within_limits(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLES / 10; ++i) {
        const wh_limits_t limits = random_limits(i);
        const wh_real_t distance = random_distance(i);
        wh_profile_t p;
        assert_int_equal(wh_profile_plan(&p, distance, &limits), WH_OK);
        const wh_real_t ends[] = {p.jerk_end,
                                  p.hold_end,
                                  p.rise_end,
                                  p.duration / 2,
                                  p.duration - p.rise_end,
                                  p.duration - p.hold_end,
                                  p.duration - p.jerk_end};
        for (size_t k = 0; k < 7; ++k) {
            const wh_real_t step = p.duration * (wh_real_t)ROUNDING;
            const wh_motion_t before = at(&p, ends[k] - step);
            const wh_motion_t after = at(&p, ends[k] + step);
            assert_near(before.position, after.position,
                        5 * ROUNDING * ((double)p.duration * (double)limits.speed + fabs((double)distance)));
            assert_near(
                before.speed, after.speed,
                5 * ROUNDING *
                    (double)(p.duration * wh_profile_peak_acceleration(&p) + wh_profile_peak_speed(&p)));
            assert_near(before.acceleration, after.acceleration,
                        5 * ROUNDING * (double)(p.duration * limits.jerk));
        }
        for (int k = 0; k < 20; ++k) {
            const wh_motion_t m = at(&p, (wh_real_t)wh_test_uniform(0, (double)p.duration));
            assert_true((double)wh_real_abs(m.speed) <= (double)limits.speed * (1 + LIMIT_TOLERANCE));
            assert_true((double)wh_real_abs(m.acceleration) <=
                        (double)limits.acceleration * (1 + LIMIT_TOLERANCE));
            assert_true((double)wh_real_abs(m.jerk) <= (double)limits.jerk * (1 + LIMIT_TOLERANCE));
            assert_true(distance < 0 ? m.position <= 0 && m.speed <= 0 : m.position >= 0 && m.speed >= 0);
        }
    }
}

static void ends_are_exact(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLES / 10; ++i) {
        const wh_limits_t limits = random_limits(i);
        const wh_real_t distance = random_distance(i);
        wh_profile_t p;
        assert_int_equal(wh_profile_plan(&p, distance, &limits), WH_OK);
        const wh_real_t end = wh_profile_duration(&p);
        const wh_motion_t rest[] = {at(&p, 0),   at(&p, -1),      at(&p, (wh_real_t)NAN),
                                    at(&p, end), at(&p, 2 * end), at(&p, (wh_real_t)INFINITY)};
        for (size_t k = 0; k < 6; ++k) {
            assert_near(rest[k].position, k < 3 ? 0 : distance, 0);
            assert_true(rest[k].speed == 0 && rest[k].acceleration == 0 && rest[k].jerk == 0);
        }
        const wh_motion_t last = at(&p, end * (1 - (wh_real_t)ROUNDING));
        assert_near(last.position, distance, 2 * fabs((double)distance) * ROUNDING);
    }
}

static void a_small_profile_by_hand(void **state) {
    (void)state;
    /* tj = 1, ramp 2: rise 3, 6 mm up and 6 mm down, 8 mm of cruise at 2 mm/s. */
    const wh_limits_t limits = {2, 1, 1};
    wh_profile_t p;
    assert_int_equal(wh_profile_plan(&p, 14, &limits), WH_OK);
    assert_near(wh_profile_duration(&p), 10, 0);
    assert_near(at(&p, 1).position, 1.0 / 6, ROUNDING);
    assert_near(at(&p, 2).speed, 1.5, ROUNDING);
    assert_near(at(&p, 3).position, 3, 0);
    assert_near(at(&p, 5).position, 7, 0);
    assert_near(at(&p, 7).position, 11, 0);
    assert_near(at(&p, 9).acceleration, -1, 0);
    assert_near(at(&p, 9.5).jerk, 1, 0);
    /* Only jerk: 2 mm at 1 mm/s^3 takes four phases of 1 s. */
    const wh_limits_t wide = {100, 100, 1};
    assert_int_equal(wh_profile_plan(&p, -2, &wide), WH_OK);
    assert_near(wh_profile_duration(&p), 4, 0);
    assert_near(wh_profile_peak_speed(&p), 1, 0);
    assert_near(at(&p, 2).position, -1, 0);
    assert_near(at(&p, 2).speed, -1, 0);
}

static void stretching_slows_everything_alike(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLES / 10; ++i) {
        const wh_limits_t limits = random_limits(i);
        wh_profile_t p;
        assert_int_equal(wh_profile_plan(&p, random_distance(i), &limits), WH_OK);
        wh_profile_t q = p;
        const double k = wh_test_decades(1, 1000);
        const wh_real_t duration = p.duration * (wh_real_t)k;
        assert_int_equal(wh_profile_stretch(&q, duration), WH_OK);
        assert_near(wh_profile_duration(&q), duration, 0);
        assert_relative(q.speed * (wh_real_t)k, (long double)p.speed, 3 * LIMIT_TOLERANCE);
        assert_relative(q.acceleration * (wh_real_t)(k * k), (long double)p.acceleration,
                        3 * LIMIT_TOLERANCE);
        assert_relative(q.jerk * (wh_real_t)(k * k * k), (long double)p.jerk, 3 * LIMIT_TOLERANCE);
        const wh_real_t t = (wh_real_t)wh_test_uniform(0, (double)p.duration);
        assert_near(at(&q, t * (wh_real_t)k).position, at(&p, t).position,
                    20 * ROUNDING * (fabs((double)p.distance) + fabs((double)(p.speed * p.duration))));
        assert_near(at(&q, duration).position, p.distance, 0);
    }
}

/* Limits and distances for which a time or the jerk exceeds the range of numbers. */
static void what_cannot_be_represented_is_refused(void **state) {
    (void)state;
    static const struct {
        wh_real_t distance;
        wh_limits_t limits;
    } rows[] = {
        {SIZEABLE / WH_REAL(1e8), {SIZEABLE, WH_REAL(1e-10), 1}}, /* the rise */
        {SIZEABLE, {WH_REAL(1e-10), 1, 1}},                       /* the cruise */
        {SIZEABLE, {SIZEABLE, SIZEABLE, WH_REAL(1e-30)}},         /* the jerk's time */
    };
    wh_profile_t p;
    memset(&p, 0x5a, sizeof p);
    const wh_profile_t before = p;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        assert_int_equal(wh_profile_plan(&p, rows[i].distance, &rows[i].limits), WH_STATUS_BAD_LIMITS);
    }
    assert_memory_equal(&p, &before, sizeof p);
}

/* Times are valid even if their squares, products and quotients are out of range. */
static void what_can_be_represented_is_planned(void **state) {
    (void)state;
    const wh_real_t large = sizeof(wh_real_t) == 4 ? WH_REAL(1e18) : WH_REAL(1e153);
    static const wh_real_t steep = WH_REAL(1e30);
    const struct {
        wh_real_t distance;
        wh_limits_t limits;
    } rows[] = {
        {8 * large, {1, 1, 1 / large / large}}, /* jerk and cruise, extremely long */
        {1000, {10, 1, steep}},                 /* almost no jerk phase */
        {1000 * steep, {10 * steep, steep, steep * WH_REAL(1e3)}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        wh_profile_t p;
        assert_int_equal(wh_profile_plan(&p, rows[i].distance, &rows[i].limits), WH_OK);
        const oracle_t o = optimum((long double)rows[i].distance, &rows[i].limits);
        assert_relative(wh_profile_duration(&p), o.duration, DURATION_TOLERANCE);
    }
}

/* At the largest possible jerk, only rounding decides whether the profile's own jerk is still a number. */
static void the_jerk_is_always_a_number(void **state) {
    (void)state;
    const wh_real_t most = sizeof(wh_real_t) == 4 ? (wh_real_t)FLT_MAX : (wh_real_t)DBL_MAX;
    const wh_real_t v = WH_REAL(1e30);
    const wh_limits_t limits = {v, v, most};
    int refused = 0;
    for (int i = 0; i < 1000; ++i) {
        wh_profile_t p;
        const wh_status_t status = wh_profile_plan(&p, v * (wh_real_t)wh_test_uniform(2, 9), &limits);
        assert_true(status == WH_STATUS_BAD_LIMITS || (status == WH_OK && wh_real_is_finite(p.jerk)));
        refused += status != WH_OK;
    }
    assert_true(refused > 0 && refused < 1000);
}

static void stretching_refuses_less_time(void **state) {
    (void)state;
    const wh_limits_t limits = {2, 1, 1};
    wh_profile_t p;
    assert_int_equal(wh_profile_plan(&p, 14, &limits), WH_OK);
    const wh_profile_t before = p;
    assert_int_equal(wh_profile_stretch(&p, WH_REAL(9.99)), WH_STATUS_OUT_OF_RANGE);
    wh_profile_t brief;
    const wh_limits_t wild = {WH_REAL(1e20), WH_REAL(1e25), WH_REAL(1e30)};
    assert_int_equal(wh_profile_plan(&brief, WH_REAL(1e-9), &wild), WH_OK);
    assert_int_equal(wh_profile_stretch(&brief, SIZEABLE), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_profile_stretch(&p, (wh_real_t)NAN), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_profile_stretch(&p, (wh_real_t)INFINITY), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_profile_stretch(NULL, 20), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_profile_stretch(&p, 10), WH_OK);
    assert_memory_equal(&p, &before, sizeof p);
}

static void no_distance_takes_no_time(void **state) {
    (void)state;
    const wh_limits_t limits = {2, 1, 1};
    wh_profile_t least;
    assert_int_equal(wh_profile_plan(&least, WH_PROFILE_TINY, &limits), WH_OK);
    assert_true(wh_profile_duration(&least) > 0);
    static const wh_real_t none[] = {0, WH_PROFILE_TINY / 2, -WH_PROFILE_TINY / 2};
    for (size_t i = 0; i < 3; ++i) {
        wh_profile_t p;
        assert_int_equal(wh_profile_plan(&p, none[i], &limits), WH_OK);
        assert_near(wh_profile_duration(&p), 0, 0);
        assert_near(at(&p, 0).position, none[i], 0);
        assert_int_equal(wh_profile_stretch(&p, 3), WH_OK);
        assert_near(wh_profile_duration(&p), 3, 0);
        assert_near(at(&p, 1).position, 0, 0);
        assert_near(at(&p, 3).position, none[i], 0);
        assert_int_equal(wh_profile_stretch(&p, 2), WH_STATUS_OUT_OF_RANGE);
        assert_near(wh_profile_duration(&p), 3, 0);
    }
}

static void bad_arguments_change_nothing(void **state) {
    (void)state;
    const wh_limits_t good = {2, 1, 1};
    wh_profile_t p;
    assert_int_equal(wh_profile_plan(&p, 14, &good), WH_OK);
    const wh_profile_t before = p;
    static const double bad[] = {0, -1, (double)NAN, (double)INFINITY};
    for (size_t i = 0; i < 12; ++i) {
        wh_limits_t limits = good;
        wh_real_t *const field[] = {&limits.speed, &limits.acceleration, &limits.jerk};
        *field[i / 4] = (wh_real_t)bad[i % 4];
        assert_int_equal(wh_limits_validate(&limits), WH_STATUS_BAD_LIMITS);
        assert_int_equal(wh_profile_plan(&p, 14, &limits), WH_STATUS_BAD_LIMITS);
        assert_int_equal(wh_profile_plan(&p, 0, &limits), WH_STATUS_BAD_LIMITS);
    }
    const wh_limits_t absurd = {WH_PROFILE_TINY * WH_PROFILE_TINY, 1 / WH_PROFILE_TINY, 1 / WH_PROFILE_TINY};
    assert_int_equal(wh_profile_plan(&p, 14, &absurd), WH_STATUS_BAD_LIMITS);
    assert_int_equal(wh_profile_plan(&p, (wh_real_t)NAN, &good), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_profile_plan(&p, -(wh_real_t)INFINITY, &good), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_profile_plan(NULL, 1, &good), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_profile_plan(&p, 1, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_limits_validate(NULL), WH_STATUS_NULL_ARGUMENT);
    assert_memory_equal(&p, &before, sizeof p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(duration_is_the_analytic_optimum),
        cmocka_unit_test(each_phase_saturates_a_limit),
        cmocka_unit_test(states_are_the_sum_of_the_phases),
        cmocka_unit_test(motion_is_continuous_and_within_limits),
        cmocka_unit_test(ends_are_exact),
        cmocka_unit_test(a_small_profile_by_hand),
        cmocka_unit_test(stretching_slows_everything_alike),
        cmocka_unit_test(what_cannot_be_represented_is_refused),
        cmocka_unit_test(what_can_be_represented_is_planned),
        cmocka_unit_test(the_jerk_is_always_a_number),
        cmocka_unit_test(stretching_refuses_less_time),
        cmocka_unit_test(no_distance_takes_no_time),
        cmocka_unit_test(bad_arguments_change_nothing),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
