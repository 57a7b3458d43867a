/* A batch compared with the check itself, pair by pair. The poses are on the limits and anywhere,
 * far from base's origin, with NaN and infinities, and invalid. The numbers of wafers leave a rest
 * of every length, and each code path that the processor has is run. */
#include "batch/batch.h"
#include "support/proximity.h"

enum { ROUNDS = 3000, MOST = 1100, GRIPPERS = 5 };

static wh_pose_t wafers[MOST];
static wh_pose_t grippers[GRIPPERS];
static float numbers[WH_BATCH_NUMBERS(MOST) + 1];
static uint32_t bits[GRIPPERS * WH_BATCH_WORDS(MOST)];
static int32_t list[MOST];
static size_t ready_pairs, ready_far, ready_invalid, spoiled_poses;

/* One time in ten one of its numbers is no number, or the pose is invalid: a column is too long, or
 * all are skewed. */
static void spoil(wh_pose_t *pose) {
    if (wh_test_below(10) == 0) {
        const wh_real_t none[] = {(wh_real_t)NAN, (wh_real_t)INFINITY, -(wh_real_t)INFINITY};
        const uint32_t at = wh_test_below(14);
        wh_real_t *number = at < 9     ? &pose->R.m[at / 3][at % 3]
                            : at == 9  ? &pose->r.x
                            : at == 10 ? &pose->r.y
                                       : &pose->r.z;
        if (at < 12) {
            *number = none[wh_test_below(3)];
        } else {
            const wh_real_t factor = WH_REAL(at == 12 ? 1e-3 : wh_test_uniform(0.9, 1.1));
            const size_t column = wh_test_below(3);
            for (size_t i = 0; i < 3; ++i) {
                pose->R.m[i][column] *= factor;
            }
        }
        ++spoiled_poses;
    }
}

/* Some wafers lie beside a gripper, on its limits; the others lie beside a gripper that is not
 * asked for: alternately, or many in a row. */
static void draw(size_t count, const wh_tolerance_t *tolerance) {
    /* the distance of both from the origin: float's rounding is from far below the limits to far
     * above them */
    const double far[] = {0, 0, 1e2, 1e5, 1e7, 1e10, 1e15, 1e16, 1e25, 1e36};
    const double distance = far[wh_test_below(10)];
    const wh_vec3_t away =
        wh_vec3(WH_REAL(wh_test_uniform(-distance, distance)), WH_REAL(wh_test_uniform(-distance, distance)),
                WH_REAL(wh_test_uniform(-distance, distance)));
    for (size_t g = 0; g < GRIPPERS; ++g) {
        wh_pose_t wafer;
        wh_test_pair(tolerance, &wafer, &grippers[g]);
        grippers[g].r = wh_vec3_add(&grippers[g].r, &away);
    }
    const size_t row = wh_test_below(2) ? 1 : 32;
    for (size_t w = 0, g = 0; w < count; ++w) {
        g = w % row == 0 ? wh_test_below(2 * GRIPPERS) : g;
        wh_pose_t gripper;
        wh_test_pair(tolerance, &wafers[w], &gripper);
        if (g < GRIPPERS) {
            const wh_pose_t gripper_from_wafer = wh_pose_relative(&gripper, &wafers[w]);
            wafers[w] = wh_pose_compose(&grippers[g], &gripper_from_wafer);
        }
        spoil(&wafers[w]);
    }
    /* one pair is on its limits to the last bit */
    if (count > 0) {
        wh_test_pair(tolerance, &wafers[wh_test_below((uint32_t)count)], &grippers[0]);
    }
    spoil(&grippers[wh_test_below(GRIPPERS)]);
}

/* Now and then at the largest value that a limit may have. */
static wh_tolerance_t draw_tolerance(int round) {
    wh_tolerance_t tolerance = wh_test_tolerance(round);
    if (round % 16 == 1) {
        tolerance.projz = WH_REAL(wh_test_below(2) ? 1e-9 : 1e6);
        tolerance.projxy = WH_REAL(wh_test_below(2) ? 1e-6 : 1e6);
    }
    return tolerance;
}

static wh_real_t distance(size_t w, size_t g) {
    const wh_vec3_t dr = wh_vec3_subtract(&wafers[w].r, &grippers[g].r);
    const wh_vec3_t n1 = wh_mat3_column(&wafers[w].R, 2);
    return wh_real_abs(wh_vec3_dot(&dr, &n1));
}

/* The plain loop's result for one gripper: its ready wafers in `list`, the best of them. */
static size_t expect(size_t count, size_t g, const wh_tolerance_t *tolerance, int32_t *best) {
    size_t ready = 0;
    *best = WH_NONE;
    for (size_t w = 0; w < count; ++w) {
        if (wh_proximity_ready(&wafers[w], &grippers[g], tolerance)) {
            list[ready++] = (int32_t)w;
            ready_far += wh_real_abs(wafers[w].r.x) > WH_REAL(1e6) ? 1 : 0;
            ready_invalid += wh_pose_validate(&wafers[w]) == WH_OK ? 0 : 1;
            if (*best == WH_NONE || distance(w, g) < distance((size_t)*best, g)) {
                *best = (int32_t)w;
            }
        }
    }
    return ready;
}

static void compare_gripper(const wh_batch_t *batch, size_t g, const wh_tolerance_t *tolerance, int32_t best,
                            size_t *total) {
    int32_t wanted = 0;
    const size_t ready = expect(batch->wafer_count, g, tolerance, &wanted);
    int32_t got[MOST];
    assert_int_equal(wh_batch_list(batch, &grippers[g], tolerance, got, MOST), ready);
    assert_memory_equal(got, list, ready * sizeof *list);
    assert_int_equal(best, wanted);
    const uint32_t *words = bits + g * WH_BATCH_WORDS(batch->wafer_count);
    size_t next = 0;
    for (size_t w = 0; w < 32 * WH_BATCH_WORDS(batch->wafer_count); ++w) {
        const bool is_listed = next < ready && list[next] == (int32_t)w;
        assert_int_equal(words[w / 32] >> w % 32 & 1U, is_listed);
        next += is_listed ? 1 : 0;
    }
    *total += ready;
}

static void compare(const wh_batch_t *batch, const wh_tolerance_t *tolerance) {
    int32_t best[GRIPPERS];
    memset(bits, 0xff, sizeof bits);
    const size_t ready = wh_batch_ready(batch, grippers, GRIPPERS, tolerance, bits);
    const size_t found = wh_batch_best(batch, grippers, GRIPPERS, tolerance, best);
    size_t total = 0;
    size_t some = 0;
    for (size_t g = 0; g < GRIPPERS; ++g) {
        compare_gripper(batch, g, tolerance, best[g], &total);
        some += best[g] != WH_NONE ? 1 : 0;
    }
    assert_int_equal(ready, total);
    assert_int_equal(found, some);
    ready_pairs += ready;
}

static void verdicts_are_the_checks(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(400, ROUNDS, 0.5);
    while (wh_round(&rounds)) {
        const int round = rounds.number;
        const wh_tolerance_t tolerance = draw_tolerance(round);
        const size_t count = wh_test_below(round % 20 ? 80 : MOST);
        draw(count, &tolerance);
        wh_batch_t batch;
        /* at any alignment */
        float *memory = numbers + wh_test_below(2);
        assert_int_equal(wh_batch_init(&batch, wafers, count, memory, WH_BATCH_NUMBERS(count)), WH_OK);
        compare(&batch, &tolerance);
        if (count > 0) {
            const size_t moved = wh_test_below((uint32_t)count);
            wh_test_pair(&tolerance, &wafers[moved], &grippers[1]);
            assert_int_equal(wh_batch_place(&batch, moved, &wafers[moved]), WH_OK);
        }
        assert_int_equal(wh_batch_use(&batch, WH_BATCH_PORTABLE), WH_OK);
        compare(&batch, &tolerance);
        if (wh_batch_use(&batch, WH_BATCH_AVX2) == WH_OK) {
            compare(&batch, &tolerance);
        }
    }
    printf("%lu ready pairs, %lu spoiled poses, ready far away %lu, with a pose that is none %lu\n",
           (unsigned long)ready_pairs, (unsigned long)spoiled_poses, (unsigned long)ready_far,
           (unsigned long)ready_invalid);
    assert_true(ready_pairs > 1000 && spoiled_poses > 1000 && ready_far > 100 && ready_invalid > 10);
}

/* This limit is far below float's resolution at the distances that the other limit allows. All
 * wafers held back here must not be ready, and all wafers here are held back. In float so fine a
 * limit is below the check's own rounding, and few wafers are ready. */
static void what_is_rounded_is_left_room_for(void **state) {
    const wh_tolerance_t tolerance = {WH_REAL(1e-3), WH_REAL(1e6), 0};
    size_t ready = 0;
    (void)state;
    grippers[0] = wh_pose_identity();
    wh_rounds_t rounds = WH_ROUNDS(5, 100, 0.3);
    while (wh_round(&rounds)) {
        for (size_t w = 0; w < MOST; ++w) {
            wafers[w].R = wh_test_random_turn(1.5);
            const double turn = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
            const double far = wh_test_uniform(0.8e6, 0.999e6);
            const wh_vec3_t place = wh_vec3(WH_REAL(far * cos(turn)), WH_REAL(far * sin(turn)),
                                            WH_REAL(wh_test_below(2) ? 0.99e-3 : -0.99e-3));
            wafers[w].r = wh_mat3_transform(&wafers[w].R, &place);
        }
        wh_batch_t batch;
        assert_int_equal(wh_batch_init(&batch, wafers, MOST, numbers, WH_BATCH_NUMBERS(MOST)), WH_OK);
        size_t expected = 0;
        for (size_t w = 0; w < MOST; ++w) {
            expected += wh_proximity_ready(&wafers[w], &grippers[0], &tolerance) ? 1 : 0;
        }
        assert_int_equal(wh_batch_ready(&batch, grippers, 1, &tolerance, bits), expected);
        assert_int_equal(wh_batch_use(&batch, WH_BATCH_PORTABLE), WH_OK);
        assert_int_equal(wh_batch_ready(&batch, grippers, 1, &tolerance, bits), expected);
        ready += expected;
    }
    assert_true(ready > (sizeof(wh_real_t) < sizeof(double) ? 1 : (size_t)rounds.made * MOST * 99 / 100));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(verdicts_are_the_checks),
        cmocka_unit_test(what_is_rounded_is_left_room_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
