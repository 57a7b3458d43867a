/* Thinned signals: between their points no value is off by more than the tolerance, and forced
 * samples have no error at all. */
#include "support/support.h"

#include "record/quaternion.h"
#include "record/record.h"
#include "record/thin.h"

#define SAMPLES 4000

typedef struct {
    double values[WH_THIN_WIDTH];
    bool forced;
} sample_t;

static sample_t samples[SAMPLES];

/* ------------------------------------------------------------------------------------------------- signals */

static void turn_by(const double axis[3], double angle, double q[4]) {
    const double norm = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (size_t i = 0; i < 3; ++i) {
        q[i] = sin(angle / 2) * axis[i] / norm;
    }
    q[3] = cos(angle / 2);
}

static void multiply(const double a[4], const double b[4], double q[4]) {
    q[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
    q[1] = a[3] * b[1] + a[1] * b[3] + a[2] * b[0] - a[0] * b[2];
    q[2] = a[3] * b[2] + a[2] * b[3] + a[0] * b[1] - a[1] * b[0];
    q[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
}

/* A rest or a smooth move from a sample on. */
typedef struct {
    double from[WH_THIN_WIDTH], way[3], axis[3], angle;
    size_t begin, length;
} move_t;

static void begin_move(move_t *move, size_t begin) {
    const bool rests = wh_test_below(3) == 0;
    if (begin > 0) {
        memcpy(move->from, samples[begin - 1].values, sizeof move->from);
    }
    move->begin = begin;
    move->length = 1 + wh_test_below(300);
    for (size_t k = 0; k < 3; ++k) {
        move->way[k] = rests ? 0 : wh_test_uniform(-300, 300);
        move->axis[k] = wh_test_uniform(-1, 1);
    }
    move->angle = rests ? 0 : wh_test_uniform(-4, 4);
}

static void make_sample(const move_t *move, size_t i, size_t width, bool turns) {
    const double share = (double)(i - move->begin + 1) / (double)move->length;
    const double smooth = share * share * (3 - 2 * share);
    sample_t *sample = &samples[i];
    for (size_t k = 0; k < width; ++k) {
        sample->values[k] = move->from[k] + smooth * move->way[k] + (wh_test_below(500) == 0 ? 1 : 0);
    }
    if (turns) {
        double q[4];
        turn_by(move->axis, smooth * move->angle, q);
        multiply(move->from + width, q, sample->values + width);
    }
    sample->forced = wh_test_below(50) == 0;
}

/* Rests and smooth moves of random lengths, as a robot makes them, sometimes with a jolt; the moves
 * turn about random axes. */
static void make_signal(size_t width, bool turns) {
    move_t move = {.from = {0, 0, 0, 0, 0, 0, 1}, .length = 0};
    for (size_t i = 0; i < SAMPLES; ++i) {
        if (i == move.begin + move.length) {
            begin_move(&move, i);
        }
        make_sample(&move, i, width, turns);
    }
}

static void thin_signal(wh_thin_t *thin) {
    for (size_t i = 0; i < SAMPLES; ++i) {
        wh_thin_add(thin, (int64_t)i + 7, samples[i].values);
        if (samples[i].forced) {
            wh_thin_force(thin);
        }
    }
    wh_thin_finish(thin);
}

/* ------------------------------------------------------------------------------------------------- judging */

static double angle_between(const double a[4], const double b[4]) {
    double turn[3];
    wh_quaternion_turn(a, b, turn);
    return sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
}

/* The greatest error of the numbers, and of the rotation, at one sample. */
static void assert_within(const wh_thin_t *thin, size_t i, size_t width) {
    double read[WH_THIN_WIDTH];
    const double factor = samples[i].forced ? 0 : 1;
    wh_thin_read(thin, (int64_t)i + 7, read);
    for (size_t k = 0; k < width; ++k) {
        assert_near(read[k], samples[i].values[k], factor * thin->list.tolerance * (1 + 1e-9));
    }
    if (thin->turns) {
        assert_near(angle_between(read + width, samples[i].values + width), 0,
                    factor * thin->turn + 1e-7 /* the rounding of the angle itself, near 0 */);
    }
}

static void assert_points(const wh_thin_t *thin) {
    for (size_t i = 0; i < thin->list.count; ++i) {
        const wh_point_t *point = &thin->list.points[i];
        const sample_t *sample = &samples[point->slice - 7];
        assert_true(i == 0 || point->slice > thin->list.points[i - 1].slice);
        assert_memory_equal(wh_points_numbers(&thin->list, i), sample->values,
                            thin->list.width * sizeof(double));
    }
    assert_int_equal(thin->list.points[0].slice, 7);
    assert_int_equal(thin->list.points[thin->list.count - 1].slice, SAMPLES + 6);
    assert_int_equal(thin->of, SAMPLES);
}

static void check(size_t width, bool turns, size_t limit) {
    wh_thin_t thin;
    wh_thin_open(&thin, width, wh_test_decades(1e-4, 10), turns ? wh_test_decades(1e-5, 0.1) : 0, limit);
    make_signal(width, turns);
    thin_signal(&thin);
    assert_points(&thin);
    for (size_t i = 0; i < SAMPLES; ++i) {
        assert_within(&thin, i, width);
    }
    assert_true(limit == SIZE_MAX || thin.list.count - thin.list.exact_count <= limit);
    wh_thin_close(&thin);
}

static void numbers_stay_within_the_tolerance(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(4, 60, 0.3);
    while (wh_round(&rounds)) {
        check(1 + wh_test_below(3), false, SIZE_MAX);
    }
}

static void poses_stay_within_both_tolerances(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(4, 60, 0.3);
    while (wh_round(&rounds)) {
        check(3, true, SIZE_MAX);
    }
}

/* The tolerance grows, is reported, and holds. */
static void a_limit_is_kept_and_the_tolerance_told(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(4, 60, 0.3);
    while (wh_round(&rounds)) {
        check(3, wh_test_below(2) == 0, 20 + wh_test_below(200));
    }
}

/* -------------------------------------------------------------------------------------------------- by hand */

static void a_straight_line_has_two_points(void **state) {
    (void)state;
    wh_thin_t thin;
    wh_thin_open(&thin, 1, 1e-3, 0, SIZE_MAX);
    for (int64_t i = 0; i < 1000; ++i) {
        const double value = 3 + 0.25 * (double)i;
        wh_thin_add(&thin, i, &value);
    }
    wh_thin_finish(&thin);
    assert_int_equal(thin.list.count, 2);
    double read;
    wh_thin_read(&thin, 400, &read);
    assert_near(read, 103, 1e-12);
    wh_thin_read(&thin, -5, &read);
    assert_near(read, 3, 0);
    wh_thin_read(&thin, 5000, &read);
    assert_near(read, 252.75, 0);
    wh_thin_close(&thin);
}

/* A forced sample within a rest adds no point, and the rest stays exact. */
static void a_rest_has_two_points(void **state) {
    (void)state;
    wh_thin_t thin;
    wh_thin_open(&thin, 1, 0.5, 0, SIZE_MAX);
    for (int64_t i = 0; i <= 20; ++i) {
        const double value = i <= 10 ? 5 : 5 + 0.1 * (double)(i - 10);
        wh_thin_add(&thin, i, &value);
        if (i == 3) {
            wh_thin_force(&thin);
        }
    }
    wh_thin_finish(&thin);
    assert_int_equal(thin.list.count, 3);
    assert_int_equal(thin.list.points[1].slice, 10);
    wh_thin_close(&thin);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_stay_within_the_tolerance),
        cmocka_unit_test(poses_stay_within_both_tolerances),
        cmocka_unit_test(a_limit_is_kept_and_the_tolerance_told),
        cmocka_unit_test(a_straight_line_has_two_points),
        cmocka_unit_test(a_rest_has_two_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
