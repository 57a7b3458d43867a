/* Curves: no sample between their points is off by more than the tolerance, and forced samples have
 * no error at all. */
#include "support/support.h"

#include "record/path.h"

#define SAMPLES 5000
#define FIRST 7

typedef struct {
    double value;
    bool is_there, forced, breaks;
} sample_t;

static sample_t samples[SAMPLES];

/* ------------------------------------------------------------------------------------------------- signals */

/* A rest or a move from a sample on: jerk-limited or not, sometimes with a jolt, or a gap. */
typedef struct {
    double from, way;
    size_t begin, length;
    bool is_gap;
} move_t;

static void begin_move(move_t *move, size_t begin, bool gaps) {
    static const double ways[] = {0, 0, 1e-3, 1, 400};
    move->from = begin > 0 && !move->is_gap ? samples[begin - 1].value : wh_test_uniform(-500, 500);
    move->begin = begin;
    move->length = 1 + wh_test_below(wh_test_below(2) == 0 ? 40 : 900);
    move->way = ways[wh_test_below(5)] * wh_test_uniform(-1, 1);
    move->is_gap = gaps && begin > 0 && wh_test_below(5) == 0;
}

/* Positions of a robot's moves, and of values that jump. */
static void make_signal(bool gaps, bool jolts) {
    move_t move = {.length = 0};
    for (size_t i = 0; i < SAMPLES; ++i) {
        if (i == move.begin + move.length) {
            begin_move(&move, i, gaps);
        }
        const double share = (double)(i - move.begin + 1) / (double)move.length;
        const double smooth = share * share * share * (10 + share * (6 * share - 15));
        samples[i].value = move.from + smooth * move.way + (jolts && wh_test_below(200) == 0 ? 1 : 0);
        samples[i].is_there = !move.is_gap;
        samples[i].forced = wh_test_below(60) == 0;
        samples[i].breaks = false;
    }
}

static void draw(wh_path_t *curve) {
    for (size_t i = 0; i < SAMPLES; ++i) {
        if (samples[i].is_there) {
            wh_path_add(curve, (int64_t)i + FIRST, samples[i].value);
        }
        if (samples[i].is_there && samples[i].forced) {
            wh_path_force(curve);
        }
        if (i + 1 < SAMPLES && samples[i].is_there && !samples[i + 1].is_there) {
            samples[i].breaks = true;
            wh_path_break(curve);
        }
    }
    wh_path_finish(curve);
}

/* ------------------------------------------------------------------------------------------------- judging */

static void assert_points(const wh_path_t *curve) {
    size_t exact = 0;
    for (size_t i = 0; i < curve->list.count; ++i) {
        const wh_point_t *point = &curve->list.points[i];
        const sample_t *sample = &samples[point->slice - FIRST];
        assert_true(i == 0 || point->slice > curve->list.points[i - 1].slice);
        assert_near(wh_path_value(curve, i), sample->value, 0);
        assert_int_equal(point->ends, sample->breaks);
        exact += point->exact ? 1 : 0;
    }
    assert_int_equal(exact, curve->list.exact_count);
    assert_int_equal(curve->list.points[0].slice, FIRST);
}

static void assert_within(const wh_path_t *curve) {
    for (size_t i = 0; i < SAMPLES; ++i) {
        const double read = wh_path_read(curve, (int64_t)i + FIRST, NULL);
        const sample_t *sample = &samples[i];
        if (sample->is_there) {
            assert_near(read, sample->value, sample->forced ? 0 : curve->list.tolerance * (1 + 1e-9));
        } else {
            assert_true(isnan(read));
        }
    }
}

static void check(bool gaps, bool jolts) {
    wh_path_t curve;
    wh_path_open(&curve, wh_test_decades(1e-4, 1), SIZE_MAX);
    make_signal(gaps, jolts);
    draw(&curve);
    assert_points(&curve);
    assert_within(&curve);
    wh_path_close(&curve);
}

static void values_stay_within_the_tolerance(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(6, 80, 0.3);
    while (wh_round(&rounds)) {
        check(false, rounds.number % 2 == 0);
    }
}

static void a_break_is_a_break(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(6, 80, 0.3);
    while (wh_round(&rounds)) {
        check(true, rounds.number % 2 == 0);
    }
}

/* The tolerance grows, is reported, and holds; forced samples stay, and so do rests. */
static void a_limit_is_kept_and_the_tolerance_told(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(6, 80, 0.3);
    while (wh_round(&rounds)) {
        wh_path_t curve;
        const size_t limit = 20 + wh_test_below(100);
        wh_path_open(&curve, wh_test_decades(1e-5, 1e-2), limit);
        make_signal(rounds.number % 2 == 0, rounds.number % 3 == 0);
        draw(&curve);
        assert_points(&curve);
        assert_within(&curve);
        assert_true(curve.list.limit > limit || curve.list.count - curve.list.exact_count <= limit);
        wh_path_close(&curve);
    }
}

/* Three times the third power of a time: a single cubic with a known slope. */
static void a_cubic_has_two_points(void **state) {
    (void)state;
    wh_path_t curve;
    double slope;
    wh_path_open(&curve, 1e-3, SIZE_MAX);
    for (int64_t i = 0; i <= 1000; ++i) {
        const double t = (double)i / 1000 - 0.5;
        wh_path_add(&curve, i, 3 * t * t * t);
    }
    wh_path_finish(&curve);
    assert_true(curve.list.count <= 3);
    assert_near(wh_path_read(&curve, 500, &slope), 0, 1e-3);
    assert_near(wh_path_read(&curve, 300, &slope), -0.024, 1e-3);
    assert_near(slope * 1000, 0.36, 0.02);
    assert_near(wh_path_read(&curve, 5000, &slope), 0.375, 1e-12);
    assert_near(slope, 0, 0);
    assert_true(isnan(wh_path_read(&curve, -1, NULL)));
    wh_path_close(&curve);
}

/* However long it is, forced samples within it add no point. */
static void a_rest_has_two_points(void **state) {
    (void)state;
    wh_path_t curve;
    wh_path_open(&curve, 0.01, SIZE_MAX);
    for (int64_t i = 0; i <= 100000; ++i) {
        wh_path_add(&curve, i, i < 99999 ? 5 : 6);
        if (i % 1000 == 500) {
            wh_path_force(&curve);
        }
    }
    wh_path_finish(&curve);
    assert_int_equal(curve.list.count, 4);
    assert_int_equal(curve.list.points[1].slice, 99998);
    assert_true(curve.list.points[0].exact && curve.list.points[1].exact);
    assert_near(wh_path_read(&curve, 54321, NULL), 5, 0);
    assert_true(curve.sample_capacity <= 256);
    wh_path_close(&curve);
}

static void a_sample_is_inserted(void **state) {
    (void)state;
    wh_path_t curve;
    wh_path_open(&curve, 10, SIZE_MAX);
    for (int64_t i = 0; i <= 20; ++i) {
        wh_path_add(&curve, i, (double)(i % 2));
    }
    wh_path_break(&curve);
    wh_path_add(&curve, 30, 4);
    wh_path_insert(&curve, 5, 1);
    wh_path_insert(&curve, 5, 1);  /* there already */
    wh_path_insert(&curve, 25, 1); /* in a break */
    wh_path_insert(&curve, 99, 1);
    assert_near(wh_path_read(&curve, 5, NULL), 1, 0);
    assert_int_equal(curve.list.count, 4);
    assert_int_equal(curve.list.points[1].slice, 5);
    assert_true(curve.list.points[1].exact);
    wh_path_close(&curve);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_stay_within_the_tolerance),
        cmocka_unit_test(a_break_is_a_break),
        cmocka_unit_test(a_limit_is_kept_and_the_tolerance_told),
        cmocka_unit_test(a_cubic_has_two_points),
        cmocka_unit_test(a_rest_has_two_points),
        cmocka_unit_test(a_sample_is_inserted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
