/* A batch's memory, its refusals, and its answers for a few wafers, for which they are easy to see. */
#include "batch/batch.h"
#include "support/pose.h"

enum { WAFERS = 41, MANY = 2100 };

static wh_pose_t wafers[WAFERS];
static float numbers[WH_BATCH_NUMBERS(WAFERS)];

/* A stack at a pitch of 10 mm: wafer w is at z = 10 w. */
static wh_batch_t stack(size_t count) {
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w] = wh_test_at(0, 0, 10.0 * (double)w);
    }
    wh_batch_t batch;
    assert_int_equal(wh_batch_init(&batch, wafers, count, numbers, WH_BATCH_NUMBERS(count)), WH_OK);
    return batch;
}

static void sizes_are_whole_blocks(void **state) {
    (void)state;
    assert_int_equal(WH_BATCH_NUMBERS(0), 0);
    assert_int_equal(WH_BATCH_NUMBERS(1), 128 + 192);
    assert_int_equal(WH_BATCH_NUMBERS(32), 128 + 192);
    assert_int_equal(WH_BATCH_NUMBERS(33), 128 + 2 * 192);
    assert_int_equal(WH_BATCH_NUMBERS(1024), 128 + 32 * 192);
    assert_int_equal(WH_BATCH_NUMBERS(1025), 2 * 128 + 33 * 192);
    assert_int_equal(WH_BATCH_WORDS(0), 0);
    assert_int_equal(WH_BATCH_WORDS(32), 1);
    assert_int_equal(WH_BATCH_WORDS(33), 2);
}

/* The layout that the header shows; entries without a wafer are infinite. */
static void numbers_stand_where_the_header_says(void **state) {
    (void)state;
    for (size_t w = 0; w < 40; ++w) {
        wafers[w].R = wh_test_random_turn(WH_TEST_PI);
        wafers[w].r = wh_vec3(WH_REAL(w), WH_REAL(100 + w), WH_REAL(200 + w));
    }
    wh_batch_t batch;
    assert_int_equal(wh_batch_init(&batch, wafers, 40, numbers, WH_BATCH_NUMBERS(40)), WH_OK);
    for (size_t i = 0; i < 2 * 192; ++i) {
        const size_t w = i / 96 % 2 * 32 + i % 32;
        const size_t axis = i / 32 % 3;
        if (w >= 40) {
            assert_true(isinf(numbers[128 + i]));
        } else if (i < 192) {
            assert_near(numbers[128 + i], 100.0 * (double)axis + (double)w, 0);
        } else {
            assert_near(numbers[128 + i], (float)wafers[w].R.m[axis][2], 0);
        }
    }
    const double first[] = {15.5, 115.5, 215.5, 15.5 * sqrt(3)};
    const double second[] = {35.5, 135.5, 235.5, 3.5 * sqrt(3)};
    for (size_t i = 0; i < 4; ++i) {
        assert_near(numbers[32 * i], first[i], 1e-3);
        assert_near(numbers[32 * i + 1], second[i], 1e-3);
        assert_true(isinf(numbers[32 * i + 2]));
    }
    assert_true(numbers[96] > 26.8468F && numbers[97] > 6.0622F);
    assert_int_equal(wh_batch_init(&batch, wafers, 1, numbers, WH_BATCH_NUMBERS(1)), WH_OK);
    assert_near(numbers[96], 0, 0);
}

/* If every lane is left to the check, the lanes beyond the last wafer are not. */
static void wafers_beyond_the_last_are_not_asked(void **state) {
    (void)state;
    wh_batch_t batch = stack(9);
    const wh_tolerance_t paper = wh_tolerance_paper();
    const wh_pose_t far = wh_test_at(4e15, 0, 0);
    uint32_t bits = 0;
    wafers[9] = far;
    assert_int_equal(wh_batch_ready(&batch, &far, 1, &paper, &bits), 0);
    assert_int_equal(bits, 0);
    assert_int_equal(wh_batch_place(&batch, 8, &far), WH_OK);
    assert_int_equal(wh_batch_ready(&batch, &far, 1, &paper, &bits), 1);
    assert_int_equal(bits, 1U << 8);
}

/* If a wafer is left to the check, its numbers and those of its sphere are NaN until it is moved. */
static void what_cannot_be_sieved_is_left_to_the_check(void **state) {
    (void)state;
    wh_batch_t batch = stack(WAFERS);
    wh_pose_t bad[] = {wafers[5], wafers[5], wafers[5]};
    bad[0].R.m[0][0] = WH_REAL(1.1);
    bad[1].r = wh_vec3(0, WH_REAL(2e15), 0);
    bad[2].r.z = (wh_real_t)NAN;
    for (size_t i = 0; i < 3; ++i) {
        assert_int_equal(wh_batch_place(&batch, 5, &bad[i]), WH_OK);
        assert_memory_equal(&wafers[5], &bad[i], sizeof *bad);
        assert_true(isnan((double)numbers[0]) && isnan((double)numbers[128 + 5]));
        assert_true(isnan((double)numbers[128 + 192 + 5]) && !isnan((double)numbers[1]));
        const wh_pose_t good = wh_test_at(1, 2, 3);
        assert_int_equal(wh_batch_place(&batch, 5, &good), WH_OK);
        assert_near(numbers[128 + 5], 1, 0);
        assert_true(!isnan((double)numbers[0]));
    }
}

static void no_number_is_written_beyond_the_room(void **state) {
    static const size_t counts[] = {1, 31, 32, 33, 1023, 1024, 1025, 2047, 2048};
    static wh_pose_t many[2048];
    static float room[WH_BATCH_NUMBERS(2048) + 256];
    (void)state;
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i) {
        const size_t last = WH_BATCH_NUMBERS(counts[i]);
        wh_batch_t batch;
        for (size_t k = 0; k < 256; ++k) {
            room[last + k] = 77;
        }
        assert_int_equal(wh_batch_init(&batch, many, counts[i], room, last), WH_OK);
        for (size_t k = 0; k < 256; ++k) {
            assert_near(room[last + k], 77, 0);
        }
    }
}

static void init_refuses_and_changes_nothing(void **state) {
    (void)state;
    wh_batch_t batch = stack(9);
    const wh_batch_t before = batch;
    float was[WH_BATCH_NUMBERS(WAFERS)];
    memcpy(was, numbers, sizeof was);
    wafers[0].r.x = 1;
    const size_t room = WH_BATCH_NUMBERS(9);
    assert_int_equal(wh_batch_init(NULL, wafers, 9, numbers, room), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_batch_init(&batch, NULL, 9, numbers, room), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_batch_init(&batch, wafers, 9, NULL, room), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_batch_init(&batch, wafers, 9, numbers, room - 1), WH_STATUS_BAD_CAPACITY);
    assert_int_equal(wh_batch_init(&batch, wafers, 1, numbers, 0), WH_STATUS_BAD_CAPACITY);
    assert_int_equal(wh_batch_init(&batch, wafers, (size_t)INT32_MAX + 1, numbers, SIZE_MAX),
                     WH_STATUS_BAD_CAPACITY);
    assert_int_equal(wh_batch_init(&batch, wafers, INT32_MAX, numbers, room), WH_STATUS_BAD_CAPACITY);
    assert_memory_equal(&batch, &before, sizeof batch);
    assert_memory_equal(was, numbers, sizeof was);
}

static void calls_on_one_wafer_refuse(void **state) {
    (void)state;
    wh_batch_t batch = stack(9);
    wh_pose_t pose = wh_pose_identity();
    assert_int_equal(wh_batch_place(NULL, 0, &pose), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_batch_place(&batch, 0, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_batch_place(&batch, 9, &pose), WH_STATUS_OUT_OF_RANGE);
    assert_near(wafers[0].r.z, 0, 0);
    pose.r.z = 85;
    assert_int_equal(wh_batch_place(&batch, 8, &pose), WH_OK);
    assert_near(wafers[8].r.z, 85, 0);
}

static void code_is_chosen_or_asked_for(void **state) {
    (void)state;
    wh_batch_t batch = stack(9);
    const wh_batch_code_t chosen = batch.code;
    assert_int_equal(wh_batch_use(NULL, WH_BATCH_PORTABLE), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_batch_use(&batch, (wh_batch_code_t)2), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(batch.code, chosen);
    const wh_status_t avx2 = wh_batch_use(&batch, WH_BATCH_AVX2);
    assert_int_equal(avx2, chosen == WH_BATCH_AVX2 ? WH_OK : WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_batch_use(&batch, WH_BATCH_PORTABLE), WH_OK);
    assert_int_equal(batch.code, WH_BATCH_PORTABLE);
}

static void no_wafer_is_no_answer(void **state) {
    (void)state;
    wh_batch_t batch;
    assert_int_equal(wh_batch_init(&batch, NULL, 0, NULL, 0), WH_OK);
    const wh_pose_t gripper = wh_pose_identity();
    const wh_tolerance_t paper = wh_tolerance_paper();
    uint32_t bits = 7;
    int32_t best = 7;
    assert_int_equal(wh_batch_ready(&batch, &gripper, 1, &paper, &bits), 0);
    assert_int_equal(wh_batch_list(&batch, &gripper, &paper, &best, 1), 0);
    assert_int_equal(bits, 7);
    assert_int_equal(best, 7);
    assert_int_equal(wh_batch_best(&batch, &gripper, 1, &paper, &best), 0);
    assert_int_equal(best, WH_NONE);
}

static void each_gripper_finds_its_wafer(void **state) {
    (void)state;
    wh_batch_t batch = stack(WAFERS);
    const wh_tolerance_t paper = wh_tolerance_paper();
    for (int code = 0; code < 2; ++code) {
        wh_pose_t grippers[WAFERS + 1];
        uint32_t bits[(WAFERS + 1) * WH_BATCH_WORDS(WAFERS)];
        int32_t best[WAFERS + 1];
        memcpy(grippers, wafers, sizeof wafers);
        grippers[WAFERS] = wh_test_at(0, 0, 5);
        assert_int_equal(wh_batch_ready(&batch, grippers, WAFERS + 1, &paper, bits), WAFERS);
        assert_int_equal(wh_batch_best(&batch, grippers, WAFERS + 1, &paper, best), WAFERS);
        for (size_t g = 0; g <= WAFERS; ++g) {
            assert_int_equal(bits[2 * g], g < 32 ? UINT32_C(1) << g : 0);
            assert_int_equal(bits[2 * g + 1], g >= 32 && g < WAFERS ? UINT32_C(1) << (g - 32) : 0);
            assert_int_equal(best[g], g < WAFERS ? (int32_t)g : WH_NONE);
        }
        assert_int_equal(wh_batch_use(&batch, WH_BATCH_PORTABLE), WH_OK);
    }
}

/* Beyond the first 1,024 wafers, which have spheres far away. */
static void each_of_many_is_found(void **state) {
    static wh_pose_t many[MANY];
    static float room[WH_BATCH_NUMBERS(MANY) + 63];
    const wh_tolerance_t paper = wh_tolerance_paper();
    (void)state;
    for (size_t w = 0; w < MANY; ++w) {
        many[w] = wh_test_at(0, 0, 10.0 * (double)w);
    }
    wh_batch_t batch;
    assert_int_equal(wh_batch_init(&batch, many, MANY, room, WH_BATCH_NUMBERS(MANY) + 63), WH_OK);
    assert_int_equal(wh_batch_init(&batch, many, MANY, room, SIZE_MAX), WH_OK);
    for (int code = 0; code < 2; ++code) {
        for (size_t w = 0; w < MANY; w += 7) {
            int32_t found = WH_NONE;
            assert_int_equal(wh_batch_list(&batch, &many[w], &paper, &found, 1), 1);
            assert_int_equal(found, w);
        }
        assert_int_equal(wh_batch_use(&batch, WH_BATCH_PORTABLE), WH_OK);
    }
}

/* Two wafers are nearest, one at either side of the gripper: the lower index counts. A list that is
 * too short is cut. */
static void best_is_the_nearest_then_the_first(void **state) {
    (void)state;
    wh_batch_t batch = stack(WAFERS);
    const wh_tolerance_t paper = wh_tolerance_paper();
    const double heights[] = {100.25, 99.875, 100.125, 99.75};
    for (size_t i = 0; i < 4; ++i) {
        const wh_pose_t pose = wh_test_at(20, 0, heights[i]);
        assert_int_equal(wh_batch_place(&batch, 7 + 10 * i, &pose), WH_OK);
    }
    const wh_pose_t gripper = wh_test_at(0, 0, 100);
    const int32_t ready[] = {7, 10, 17, 27, 37};
    int32_t list[6] = {-2, -2, -2, -2, -2, -2};
    int32_t best = 0;
    assert_int_equal(wh_batch_best(&batch, &gripper, 1, &paper, &best), 1);
    assert_int_equal(best, 10);
    const wh_pose_t away = wh_test_at(200, 0, 100);
    assert_int_equal(wh_batch_place(&batch, 10, &away), WH_OK);
    assert_int_equal(wh_batch_best(&batch, &gripper, 1, &paper, &best), 1);
    assert_int_equal(best, 17);
    assert_int_equal(wh_batch_place(&batch, 10, &gripper), WH_OK);
    assert_int_equal(wh_batch_list(&batch, &gripper, &paper, list, 3), 5);
    assert_memory_equal(list, ready, 3 * sizeof *list);
    assert_int_equal(list[3], -2);
    assert_int_equal(wh_batch_list(&batch, &gripper, &paper, NULL, 0), 5);
    assert_int_equal(wh_batch_list(&batch, &gripper, &paper, list, 6), 5);
    assert_memory_equal(list, ready, sizeof ready);
    assert_int_equal(list[5], -2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_are_whole_blocks),
        cmocka_unit_test(numbers_stand_where_the_header_says),
        cmocka_unit_test(wafers_beyond_the_last_are_not_asked),
        cmocka_unit_test(what_cannot_be_sieved_is_left_to_the_check),
        cmocka_unit_test(no_number_is_written_beyond_the_room),
        cmocka_unit_test(init_refuses_and_changes_nothing),
        cmocka_unit_test(calls_on_one_wafer_refuse),
        cmocka_unit_test(code_is_chosen_or_asked_for),
        cmocka_unit_test(no_wafer_is_no_answer),
        cmocka_unit_test(each_gripper_finds_its_wafer),
        cmocka_unit_test(each_of_many_is_found),
        cmocka_unit_test(best_is_the_nearest_then_the_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
