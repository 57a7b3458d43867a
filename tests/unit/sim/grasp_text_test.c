/* Tables in words, and their differences: exact texts, and random changes, which are told exactly if the hash goes by them. */
#include "sim/grasp_text.h"

#include "math/trig.h"
#include "support/grasp.h"

#define LONG 40000

static char text[LONG];

static const char *find_name(const void *user, wh_name_kind_t kind, int32_t index) {
    (void)user;
    return kind == WH_NAME_WAFER && index == 0     ? "Wafer 1"
           : kind == WH_NAME_GRIPPER && index == 1 ? "EE"
                                                   : NULL;
}

static const wh_event_names_t names = {find_name, NULL, 0, NULL, NULL};

/* Writes the difference twice, to see that it has the length that it says. */
static const char *difference(const wh_grasp_t *expected, const wh_grasp_t *found) {
    const size_t length = wh_grasp_difference(expected, found, &names, text, sizeof text);
    assert_int_equal(length, strlen(text));
    assert_int_equal(wh_grasp_difference(expected, found, &names, NULL, 0), length);
    return text;
}

static void copy_cell(cell_t *to, const cell_t *from) {
    *to = *from;
    to->table.storage.wafers = to->wafer;
    to->table.storage.grippers = to->gripper;
}

/* Gripper 1 holds wafer 0, gripper 0 watches wafer 1, gripper 2 contests wafer 0. */
static void begin_busy(cell_t *cell) {
    wh_grasp_config_t config = wh_grasp_config_default();
    cell_begin(cell, &config);
    cell_move(cell, 1, 1, 2, 0, OPEN);
    cell_move(cell, 1, 1, 2, 0, OPEN);
    cell_set(cell, 0, 1000, 0, -3, OPEN);
    cell_move(cell, 2, 0, 3, 0, OPEN);
    assert_int_equal(cell->gripper[1].wafer, 0);
    assert_int_equal(cell->gripper[0].approach.wafer, 1);
    assert_int_equal(cell->gripper[2].contest.wafer, 0);
}

/* ------------------------------------------------------------------------------------------------- a table */

static void a_table_is_told_line_by_line(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    const size_t length = wh_grasp_text(&cell.table, &names, text, sizeof text);
    assert_int_equal(length, strlen(text));
    assert_string_equal(
        text,
        "slice 3\n"
        "Wafer 1: at 0.000, 0.000, 0.000 mm, turned 0.000 deg, tilted 0.000 deg: held by EE\n"
        "wafer 1: at 1000.000, 0.000, 0.000 mm, turned 0.000 deg, tilted 0.000 deg: free\n"
        "wafer 2: at 2000.000, 0.000, 0.000 mm, turned 0.000 deg, tilted 0.000 deg: free\n"
        "wafer 3: at 3000.000, 0.000, 0.000 mm, turned 0.000 deg, tilted 0.000 deg: free\n"
        "gripper 0: at 1000.000, 0.000, -3.000 mm, turned 0.000 deg, tilted 0.000 deg: open, follows wafer 1 "
        "(slice 3: |dr_proj_z| 3.000 mm, |dr_proj_xy| 0.000 mm, n1_proj_n2 1.000000)\n"
        "EE: at 1.000, 2.000, 0.000 mm, turned 0.000 deg, tilted 0.000 deg: open, holds Wafer 1\n"
        "gripper 2: at 0.000, 3.000, 0.000 mm, turned 0.000 deg, tilted 0.000 deg: open, contests Wafer 1 "
        "(slice 3: |dr_proj_z| 0.000 mm, |dr_proj_xy| 3.000 mm, n1_proj_n2 1.000000)\n");
}

static void rotations_are_told_as_turn_and_tilt(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    wh_pose_t pose = wh_test_at(0, 0, 0);
    pose.R = wh_mat3_from_rpy_deg(WH_REAL(0.5), 0, 90);
    assert_int_equal(wh_grasp_place(&cell.table, 0, &pose), WH_OK);
    pose.R = wh_mat3_from_rpy_deg(180, 0, -90);
    assert_int_equal(wh_grasp_place(&cell.table, 1, &pose), WH_OK);
    (void)wh_grasp_text(&cell.table, NULL, text, sizeof text);
    assert_non_null(
        strstr(text, "wafer 0: at 0.000, 0.000, 0.000 mm, turned 90.000 deg, tilted 0.500 deg: free\n"));
    assert_non_null(
        strstr(text, "wafer 1: at 0.000, 0.000, 0.000 mm, turned -90.000 deg, tilted 180.000 deg: free\n"));
}

static void a_table_that_is_none_is_told(void **state) {
    (void)state;
    cell_t cell;
    const wh_grasp_t blank = {0};
    cell_begin_default(&cell);
    (void)wh_grasp_text(NULL, NULL, text, sizeof text);
    assert_string_equal(text, "the table is null\n");
    (void)wh_grasp_text(&blank, NULL, text, sizeof text);
    assert_string_equal(text, "the table is not initialised\n");
    assert_string_equal(difference(NULL, &cell.table), "the expected table is null\n");
    assert_string_equal(difference(&cell.table, &blank), "the table is not initialised\n");
    assert_string_equal(difference(NULL, NULL), "the expected table is null\nthe table is null\n");
}

/* The longest numbers that a table can have, and the longest names that the size is meant for. */
static const char *find_long(const void *user, wh_name_kind_t kind, int32_t index) {
    (void)kind;
    (void)index;
    return user;
}

static void the_longest_text_has_room(void **state) {
    (void)state;
    cell_t cell;
    char long_name[64];
    memset(long_name, 'n', 63);
    long_name[63] = '\0';
    const wh_event_names_t long_names = {find_long, long_name, 0, NULL, NULL};
    cell_begin_default(&cell);
    cell.table.slice = INT64_MAX;
    const wh_vec3_t far = wh_vec3(WH_REAL(-1e14), WH_REAL(-1e14), WH_REAL(-1e14));
    for (size_t w = 0; w < CELL_WAFERS; ++w) {
        cell.wafer[w].base_from_wafer.r = far;
        cell.wafer[w].base_from_wafer.R = wh_mat3_from_rpy_deg(179, 1, -179);
        cell.wafer[w].holder = 0;
    }
    for (size_t g = 0; g < CELL_GRIPPERS; ++g) {
        wh_gripper_t *gripper = &cell.gripper[g];
        gripper->base_from_gripper = cell.wafer[0].base_from_wafer;
        gripper->wafer = 0;
        gripper->approach.wafer = gripper->contest.wafer = 0;
        gripper->approach.slice = INT64_MAX;
        gripper->approach.measured.dr_proj_z = gripper->approach.measured.dr_proj_xy_norm = far.x;
        gripper->approach.measured.n1_proj_n2 = -1;
        gripper->contest.slice = gripper->approach.slice;
        gripper->contest.measured = gripper->approach.measured;
    }
    char exact[WH_GRASP_TEXT_SIZE(CELL_WAFERS, CELL_GRIPPERS)];
    const size_t length = wh_grasp_text(&cell.table, &long_names, exact, sizeof exact);
    assert_true(length < sizeof exact && strlen(exact) == length);
    assert_true(length > sizeof exact - 200);
}

static void texts_that_do_not_fit_are_cut_off(void **state) {
    (void)state;
    cell_t cell;
    cell_t other;
    begin_busy(&cell);
    cell_begin_default(&other);
    const size_t whole = wh_grasp_text(&cell.table, NULL, text, sizeof text);
    const size_t differing = wh_grasp_difference(&other.table, &cell.table, NULL, NULL, 0);
    assert_true(differing > 100);
    for (size_t size = 1; size < whole; size += 7) {
        char part[WH_GRASP_TEXT_SIZE(CELL_WAFERS, CELL_GRIPPERS)];
        memset(part, '#', sizeof part);
        assert_int_equal(wh_grasp_text(&cell.table, NULL, part, size), whole);
        assert_int_equal(strlen(part), size - 1);
        assert_memory_equal(part, text, size - 1);
        assert_int_equal(wh_grasp_difference(&other.table, &cell.table, NULL, part, size), differing);
        assert_true(strlen(part) <= size - 1);
    }
}

/* -------------------------------------------------------------------------------------------- a difference */

static void equal_tables_have_no_difference(void **state) {
    (void)state;
    cell_t cell;
    cell_t copy;
    begin_busy(&cell);
    copy_cell(&copy, &cell);
    assert_string_equal(difference(&cell.table, &copy.table), "");
    assert_int_equal(wh_grasp_difference(&cell.table, &cell.table, NULL, NULL, 0), 0);
}

static void each_difference_is_told_with_both_values(void **state) {
    (void)state;
    cell_t cell;
    cell_t other;
    begin_busy(&cell);
    copy_cell(&other, &cell);
    cell_move(&other, 1, 1, 2, WH_REAL(-0.25), CLOSED);
    assert_string_equal(
        difference(&cell.table, &other.table),
        "slice 4 (expected 3)\n"
        "Wafer 1: held by gripper 2 (expected EE), z -0.250 mm (expected 0.000 mm)\n"
        "EE: closed (expected open), holds none (expected Wafer 1), z -0.250 mm (expected 0.000 mm)\n"
        "gripper 2: holds Wafer 1 (expected none), contests none (expected Wafer 1)\n");
}

static void what_is_alike_to_the_eye_is_told_too(void **state) {
    (void)state;
    cell_t cell;
    cell_t other;
    begin_busy(&cell);
    copy_cell(&other, &cell);
    other.wafer[1].base_from_wafer.r.x += WH_REAL(0.0625) / 256;
    assert_string_equal(difference(&cell.table, &other.table),
                        "wafer 1: x 1000.0002 mm (expected 1000.0000 mm)\n");
    copy_cell(&other, &cell);
    other.wafer[2].base_from_wafer.r.y = WH_REAL(-0.0);
    assert_string_equal(difference(&cell.table, &other.table),
                        "wafer 2: y 0.000 mm (expected 0.000 mm, of other bits)\n");
    other.wafer[2].base_from_wafer.r.y = WH_REAL(-1e-30);
    assert_string_equal(difference(&cell.table, &other.table), "wafer 2: y -0.000 mm (expected 0.000 mm)\n");
    copy_cell(&other, &cell);
    other.wafer[3].base_from_wafer.R = wh_mat3_about_z(WH_REAL(0.001));
    (void)difference(&cell.table, &other.table);
    assert_non_null(strstr(text, "wafer 3: turned by 0.0573 deg from where it was expected\n"));
    copy_cell(&other, &cell);
    other.wafer[3].base_from_wafer.R.m[0][1] = WH_REAL(1e-30);
    assert_string_equal(difference(&cell.table, &other.table),
                        "wafer 3: a rotation of other bits than expected\n");
}

static void tables_of_other_counts_are_not_compared(void **state) {
    (void)state;
    cell_t cell;
    cell_t other;
    cell_begin_default(&cell);
    copy_cell(&other, &cell);
    other.table.storage.wafer_count = 1;
    other.table.storage.gripper_count = 2;
    other.table.slice = 7;
    assert_string_equal(difference(&cell.table, &other.table),
                        "wafers: 1 (expected 4)\ngrippers: 2 (expected 3)\n");
}

/* A bit anywhere in the arrays is another one. The text is empty exactly if the hash stays. */
static void the_difference_goes_by_what_the_hash_goes_by(void **state) {
    (void)state;
    size_t told = 0;
    size_t untold = 0;
    cell_t cell;
    begin_busy(&cell);
    const uint64_t hash = wh_grasp_hash(&cell.table);
    for (size_t byte = 0; byte < sizeof cell.wafer + sizeof cell.gripper; ++byte) {
        for (unsigned bit = 0; bit < 8; bit += 3) {
            cell_t other;
            copy_cell(&other, &cell);
            unsigned char *bytes = byte < sizeof cell.wafer
                                       ? (unsigned char *)other.wafer + byte
                                       : (unsigned char *)other.gripper + (byte - sizeof cell.wafer);
            *bytes ^= (unsigned char)(1U << bit);
            const bool differs = wh_grasp_hash(&other.table) != hash;
            assert_int_equal(difference(&cell.table, &other.table)[0] != '\0', differs);
            told += differs ? 1 : 0;
            untold += differs ? 0 : 1;
        }
    }
    assert_true(told > 1000 / WH_TEST_SHARE && untold > 100);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_table_is_told_line_by_line),
        cmocka_unit_test(rotations_are_told_as_turn_and_tilt),
        cmocka_unit_test(a_table_that_is_none_is_told),
        cmocka_unit_test(the_longest_text_has_room),
        cmocka_unit_test(texts_that_do_not_fit_are_cut_off),
        cmocka_unit_test(equal_tables_have_no_difference),
        cmocka_unit_test(each_difference_is_told_with_both_values),
        cmocka_unit_test(what_is_alike_to_the_eye_is_told_too),
        cmocka_unit_test(tables_of_other_counts_are_not_compared),
        cmocka_unit_test(the_difference_goes_by_what_the_hash_goes_by),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
