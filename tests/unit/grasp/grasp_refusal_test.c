/* Wrong input is refused, and the state stays unchanged, byte for byte. */
#include "support/grasp.h"

#include "grasp/restore.h"

/* A cell in the middle of a run: a wafer held, an approach and a contest under way. */
static void begin_busy(cell_t *cell) {
    cell_begin_default(cell);
    cell_move(cell, 0, 0, 0, -0.25, OPEN);
    cell_place(cell, 1, 0, 0, 2);
    cell_move(cell, 1, 0, 0, 0, OPEN);
    assert_int_equal(cell->gripper[1].approach.wafer, 1);
    assert_int_equal(cell->gripper[1].contest.wafer, 0);
    cell_set(cell, 0, 0, 0, 30, CLOSED);
}

/* Only the count of refusals differs, and perhaps the event list. */
static void expect_unchanged(const cell_t *cell, const cell_t *before, uint64_t refusals) {
    cell_t expected;
    memcpy(&expected, before, sizeof expected);
    expected.table.counters.refused += refusals;
    assert_memory_equal(&cell->table, &expected.table, sizeof cell->table);
    assert_memory_equal(cell->wafer, before->wafer, sizeof cell->wafer);
    assert_memory_equal(cell->gripper, before->gripper, sizeof cell->gripper);
    assert_true(wh_grasp_hash(&cell->table) == wh_grasp_hash(&before->table));
}

static void refused_for_input(cell_t *cell, const cell_t *before, int gripper, wh_status_t status) {
    assert_int_equal(wh_grasp_step(&cell->table, cell->input, &cell->list), status);
    expect_unchanged(cell, before, 1);
    assert_int_equal(cell->list.count, 1);
    const wh_event_t *e = &cell->event[0];
    assert_int_equal(e->kind, WH_EVENT_BAD_INPUT);
    assert_int_equal(e->gripper, gripper);
    assert_int_equal(e->wafer, WH_NONE);
    assert_int_equal(e->other, WH_NONE);
    assert_int_equal(e->parts[0], WH_NONE);
    assert_int_equal(e->parts[1], WH_NONE);
    assert_int_equal(e->status, status);
    assert_int_equal(e->slice, before->table.slice + 1);
    assert_int_equal(e->measured_slice, before->table.slice + 1);
    /* Now without a list. */
    memcpy(cell, before, sizeof *cell);
}

/* The table points into its own cell, so a copy that is restored in place is the same table. */
static void each_number_of_a_pose_is_looked_at(void **state) {
    (void)state;
    const wh_real_t bad[] = {WH_REAL(NAN), WH_REAL(INFINITY), WH_REAL(-INFINITY)};
    cell_t cell;
    cell_t before;
    begin_busy(&cell);
    memcpy(&before, &cell, sizeof before);
    for (int i = 0; i < 3 * 12 * CELL_GRIPPERS; ++i) {
        const int g = i / 36;
        const int k = i / 3 % 12;
        wh_pose_t *p = &cell.input[g].base_from_gripper;
        *(k < 9 ? &p->R.m[k / 3][k % 3] : k == 9 ? &p->r.x : k == 10 ? &p->r.y : &p->r.z) = bad[i % 3];
        refused_for_input(&cell, &before, g, WH_STATUS_NOT_FINITE);
    }
}

static void rotations_and_valves_are_looked_at(void **state) {
    (void)state;
    cell_t cell;
    cell_t before;
    begin_busy(&cell);
    memcpy(&before, &cell, sizeof before);
    for (int g = 0; g < CELL_GRIPPERS; ++g) {
        cell.input[g].base_from_gripper.R.m[0][1] += 2 * WH_ROTATION_TOLERANCE;
        refused_for_input(&cell, &before, g, WH_STATUS_NOT_A_ROTATION);
        cell.input[g].base_from_gripper.R.m[2][2] *= -1;
        refused_for_input(&cell, &before, g, WH_STATUS_NOT_A_ROTATION);
        const int32_t valves[] = {2, -1, 256, INT32_MAX, INT32_MIN};
        for (size_t v = 0; v < 5; ++v) {
            cell.input[g].valve = valves[v];
            refused_for_input(&cell, &before, g, WH_STATUS_BAD_VALVE);
        }
    }
    /* If two are wrong, the first one is named. */
    cell.input[2].valve = 9;
    cell.input[1].base_from_gripper.r.x = WH_REAL(NAN);
    refused_for_input(&cell, &before, 1, WH_STATUS_NOT_FINITE);
    /* It counts without a list, too. */
    cell.input[2].valve = 9;
    assert_int_equal(wh_grasp_step(&cell.table, cell.input, NULL), WH_STATUS_BAD_VALVE);
    expect_unchanged(&cell, &before, 1);
}

/* One of the 24 rotations that map a cube onto itself: each row and column has one entry of 1 or
 * -1, so any two entries are equal in some of them. */
static wh_mat3_t cube_rotation(int number) {
    const int first = number / 8;
    const int second = (first + 1 + number / 4 % 2) % 3;
    wh_vec3_t e1 = {first == 0, first == 1, first == 2};
    wh_vec3_t e2 = {second == 0, second == 1, second == 2};
    e1 = wh_vec3_scale(number % 2 ? -1 : 1, &e1);
    e2 = wh_vec3_scale(number / 2 % 2 ? -1 : 1, &e2);
    const wh_vec3_t e3 = wh_vec3_cross(&e1, &e2);
    return (wh_mat3_t){{{e1.x, e2.x, e3.x}, {e1.y, e2.y, e3.y}, {e1.z, e2.z, e3.z}}};
}

/* An entry that differs from the last slice's is detected, whatever the others and the place are. */
static void each_entry_of_a_rotation_is_looked_at(void **state) {
    (void)state;
    for (int number = 0; number < 24 * 3; ++number) {
        cell_t cell;
        cell_begin_default(&cell);
        const double at = number / 24 - 1;
        const wh_pose_t last = {cube_rotation(number % 24), {(wh_real_t)at, (wh_real_t)at, (wh_real_t)at}};
        cell.input[0].base_from_gripper = last;
        cell_step(&cell);
        for (int k = 0; k < 9; ++k) {
            wh_pose_t *pose = &cell.input[0].base_from_gripper;
            *pose = last;
            pose->R.m[k / 3][k % 3] += 2 * WH_ROTATION_TOLERANCE;
            assert_int_equal(wh_grasp_step(&cell.table, cell.input, NULL), WH_STATUS_NOT_A_ROTATION);
        }
    }
}

/* An entry does not pass either because it equals another number of the pose, or a number beside it
 * in memory. */
static void no_entry_is_taken_for_another(void **state) {
    (void)state;
    for (int run = 0; run < 8; ++run) {
        cell_t cell;
        cell_begin_default(&cell);
        const wh_pose_t last = wh_test_pose(wh_test_rotation(run % 3 - 1, 2, run - 4, 0.7), 0.3, -0.2, 0.6);
        const wh_real_t number[] = {last.R.m[0][0], last.R.m[0][1], last.R.m[0][2], last.R.m[1][0],
                                    last.R.m[1][1], last.R.m[1][2], last.R.m[2][0], last.R.m[2][1],
                                    last.R.m[2][2], last.r.x,       last.r.y,       last.r.z};
        cell_place(&cell, CELL_WAFERS - 1, 0.3, -0.2, 0.6);
        cell.input[0].base_from_gripper = last;
        cell_step(&cell);
        for (int k = 0; k < 9 * 12; ++k) {
            wh_pose_t *pose = &cell.input[0].base_from_gripper;
            *pose = last;
            pose->R.m[k / 12 / 3][k / 12 % 3] = number[k % 12];
            const bool same = wh_real_abs(number[k / 12] - number[k % 12]) < WH_REAL(1e-6);
            assert_int_equal(wh_grasp_step(&cell.table, cell.input, NULL),
                             same ? WH_OK : WH_STATUS_NOT_A_ROTATION);
        }
    }
}

static void a_refused_step_changes_no_later_step(void **state) {
    (void)state;
    cell_t plain;
    cell_t disturbed;
    begin_busy(&plain);
    begin_busy(&disturbed);
    disturbed.input[2].valve = 7;
    assert_int_equal(wh_grasp_step(&disturbed.table, disturbed.input, &disturbed.list), WH_STATUS_BAD_VALVE);
    disturbed.input[2].valve = CLOSED;
    cell_step(&plain);
    cell_step(&disturbed);
    assert_true(wh_grasp_hash(&plain.table) == wh_grasp_hash(&disturbed.table));
    assert_int_equal(plain.list.count, disturbed.list.count);
}

static void a_list_is_large_enough_or_null(void **state) {
    (void)state;
    cell_t cell;
    cell_t before;
    begin_busy(&cell);
    memcpy(&before, &cell, sizeof before);
    wh_event_list_t list = cell.list;
    list.capacity = CELL_GRIPPERS * WH_EVENTS_PER_GRIPPER - 1;
    list.count = 5;
    assert_int_equal(wh_grasp_step(&cell.table, cell.input, &list), WH_STATUS_BAD_CAPACITY);
    assert_int_equal(list.count, 0);
    expect_unchanged(&cell, &before, 1);
    list.events = NULL;
    list.capacity = 100;
    list.count = 5;
    assert_int_equal(wh_grasp_step(&cell.table, cell.input, &list), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(list.count, 0);
    expect_unchanged(&cell, &before, 2);
    list.count = 5;
    assert_int_equal(wh_grasp_step(&cell.table, NULL, &list), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(list.count, 0);
    expect_unchanged(&cell, &before, 3);
    assert_int_equal(wh_grasp_step(NULL, cell.input, &list), WH_STATUS_NULL_ARGUMENT);
    expect_unchanged(&cell, &before, 3);
    assert_int_equal(wh_grasp_step(&cell.table, cell.input, NULL), WH_OK);
}

/* With and without a list the state changes in the same way. */
static void a_list_changes_nothing(void **state) {
    (void)state;
    cell_t with;
    cell_t without;
    begin_busy(&with);
    begin_busy(&without);
    for (int i = 0; i < 50; ++i) {
        for (int g = 0; g < CELL_GRIPPERS; ++g) {
            cell_set_randomly(&with, g, 80, 2);
            without.input[g] = with.input[g];
        }
        cell_step(&with);
        assert_int_equal(wh_grasp_step(&without.table, without.input, NULL), WH_OK);
        assert_true(wh_grasp_hash(&with.table) == wh_grasp_hash(&without.table));
        assert_memory_equal(&with.table.counters, &without.table.counters, sizeof with.table.counters);
    }
    assert_true(with.table.counters.picked > 5);
}

static void place_refuses(void **state) {
    (void)state;
    cell_t cell;
    cell_t before;
    begin_busy(&cell);
    memcpy(&before, &cell, sizeof before);
    const wh_pose_t pose = wh_test_at(1, 2, 3);
    wh_pose_t bad = pose;
    assert_int_equal(wh_grasp_place(&cell.table, 0, &pose), WH_STATUS_HELD);
    expect_unchanged(&cell, &before, 1);
    assert_int_equal(wh_grasp_place(&cell.table, CELL_WAFERS, &pose), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_grasp_place(&cell.table, SIZE_MAX, &pose), WH_STATUS_OUT_OF_RANGE);
    expect_unchanged(&cell, &before, 3);
    assert_int_equal(wh_grasp_place(&cell.table, 1, NULL), WH_STATUS_NULL_ARGUMENT);
    bad.r.z = WH_REAL(NAN);
    assert_int_equal(wh_grasp_place(&cell.table, 1, &bad), WH_STATUS_NOT_FINITE);
    bad = pose;
    bad.R.m[1][1] = -1;
    assert_int_equal(wh_grasp_place(&cell.table, 1, &bad), WH_STATUS_NOT_A_ROTATION);
    expect_unchanged(&cell, &before, 6);
    assert_int_equal(wh_grasp_place(NULL, 1, &pose), WH_STATUS_NULL_ARGUMENT);
}

static void questions_are_checked(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    int32_t index = 77;
    wh_pose_t pose = wh_test_at(7, 7, 7);
    assert_int_equal(wh_grasp_wafer(&cell.table, CELL_WAFERS, &pose, &index), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_grasp_wafer(NULL, 0, &pose, &index), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grasp_held(&cell.table, CELL_GRIPPERS, &index), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_grasp_held(&cell.table, 0, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grasp_held(NULL, 0, &index), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(index, 77);
    assert_true(pose.r.x == 7);
    assert_int_equal(wh_grasp_wafer(&cell.table, 0, NULL, NULL), WH_OK);
}

/* No byte of the table changes, and none of its supposed arrays is read. */
static void expect_not_initialised(wh_grasp_t *table) {
    const wh_gripper_input_t input = {wh_pose_identity(), OPEN};
    const wh_pose_t pose = wh_test_at(7, 7, 7);
    wh_pose_t where = pose;
    int32_t index = 77;
    wh_event_list_t list = {NULL, 0, 9};
    wh_wafer_t wafer = {pose, WH_NONE, WH_NONE};
    wh_gripper_t gripper;
    wh_grasp_t before;
    memset(&gripper, 0, sizeof gripper);
    memcpy(&before, table, sizeof before);
    assert_int_equal(wh_grasp_step(table, &input, &list), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(list.count, 0);
    assert_int_equal(wh_grasp_step(table, NULL, NULL), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(wh_grasp_place(table, 0, &pose), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(wh_grasp_restore(table, 1, &wafer, &gripper), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(wh_grasp_wafer(table, 0, &where, &index), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(wh_grasp_held(table, 0, &index), WH_STATUS_NOT_INITIALISED);
    assert_false(wh_grasp_is_consistent(table));
    assert_int_equal(index, 77);
    assert_true(where.r.x == 7);
    assert_memory_equal(table, &before, sizeof before);
}

static void a_table_that_was_never_initialised_is_refused(void **state) {
    (void)state;
    static const int bytes[] = {0, 0xff, 0x5a, 0x77, 1};
    wh_grasp_t table;
    for (size_t i = 0; i < sizeof bytes / sizeof bytes[0]; ++i) {
        memset(&table, bytes[i], sizeof table);
        expect_not_initialised(&table);
    }
    for (int i = 0; i < 1000; ++i) {
        uint8_t noise[sizeof table];
        for (size_t k = 0; k < sizeof noise; ++k) {
            noise[k] = (uint8_t)wh_test_random();
        }
        memcpy(&table, noise, sizeof table);
        expect_not_initialised(&table);
    }
    wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t nothing = {NULL, 0, NULL, 0, NULL, 0};
    config.near_projz = -1;
    memset(&table, 0, sizeof table);
    assert_int_equal(wh_grasp_init(&table, &config, &nothing), WH_STATUS_BAD_TOLERANCE);
    expect_not_initialised(&table);
}

static void empty_tables_work(void **state) {
    (void)state;
    wh_grasp_t table;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t nothing = {NULL, 0, NULL, 0, NULL, 0};
    wh_event_list_t list = {NULL, 0, 9};
    assert_int_equal(wh_grasp_init(&table, &config, &nothing), WH_OK);
    assert_int_equal(wh_grasp_step(&table, NULL, &list), WH_OK);
    assert_int_equal(wh_grasp_step(&table, NULL, NULL), WH_OK);
    assert_int_equal(list.count, 0);
    assert_int_equal(table.slice, 2);
    wh_gripper_t gripper;
    const wh_grasp_storage_t no_wafers = {NULL, 0, &gripper, 1, NULL, 0};
    const wh_gripper_input_t input = {wh_pose_identity(), OPEN};
    assert_int_equal(wh_grasp_init(&table, &config, &no_wafers), WH_OK);
    assert_int_equal(wh_grasp_step(&table, &input, NULL), WH_OK);
    /* A count of one instead of none. */
    assert_int_equal(wh_grasp_step(&table, NULL, NULL), WH_STATUS_NULL_ARGUMENT);
    list.capacity = 1;
    assert_int_equal(wh_grasp_step(&table, &input, &list), WH_STATUS_NULL_ARGUMENT);
}

/* The largest numbers neither trap nor count as near. */
static void huge_numbers_are_far_away(void **state) {
    (void)state;
#if defined(WH_FLOAT)
    const double huge = (double)FLT_MAX;
#else
    const double huge = DBL_MAX;
#endif
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = SWEPT_IF_BUILT;
    cell_t cell;
    cell_begin(&cell, &config);
    cell_place(&cell, 0, huge, huge, huge);
    cell_place(&cell, 1, -huge, -huge, -huge);
    for (int i = 0; i < 8; ++i) {
        cell_move(&cell, 0, i & 1 ? huge : -huge, i & 2 ? huge : -huge, i & 4 ? huge : -huge / 2, OPEN);
        if (i != 7) {
            cell_expect_nothing(&cell);
        }
    }
    cell_expect_held(&cell, 0, 0);
    cell_move(&cell, 0, 0, 0, 0, OPEN);
    cell_move(&cell, 0, 0, 0, 0, CLOSED);
    assert_int_equal(wh_pose_validate(&cell.wafer[0].base_from_wafer), WH_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_number_of_a_pose_is_looked_at),
        cmocka_unit_test(rotations_and_valves_are_looked_at),
        cmocka_unit_test(each_entry_of_a_rotation_is_looked_at),
        cmocka_unit_test(no_entry_is_taken_for_another),
        cmocka_unit_test(a_refused_step_changes_no_later_step),
        cmocka_unit_test(a_list_is_large_enough_or_null),
        cmocka_unit_test(a_list_changes_nothing),
        cmocka_unit_test(place_refuses),
        cmocka_unit_test(questions_are_checked),
        cmocka_unit_test(a_table_that_was_never_initialised_is_refused),
        cmocka_unit_test(empty_tables_work),
        cmocka_unit_test(huge_numbers_are_far_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
