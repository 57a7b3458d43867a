/* A restored grasp table continues with the same bits; data that cannot be a table's state are refused. */
#include "support/grasp.h"

#include "grasp/restore.h"

typedef struct {
    uint64_t slice;
    wh_wafer_t wafer[CELL_WAFERS];
    wh_gripper_t gripper[CELL_GRIPPERS];
} saved_t;

static cell_t origin;
static saved_t saved;
static cell_t copy;

/* Gripper 0 holds wafer 0, which gripper 1 contests; gripper 2 has come near wafer 2. */
static int set_up(void **state) {
    (void)state;
    cell_begin_default(&origin);
    cell_begin_default(&copy);
    cell_place(&origin, 1, 1000, 20, 3);
    cell_place(&origin, 3, 3000, 40, 5);
    cell_move(&origin, 0, 0, 0, -0.3, OPEN);
    cell_set(&origin, 1, 1, 2, -0.2, OPEN);
    cell_move(&origin, 2, 2003, 4, -2, OPEN);
    cell_step(&origin);
    cell_expect_held(&origin, 0, 0);
    assert_int_equal(origin.gripper[1].contest.wafer, 0);
    assert_int_equal(origin.gripper[2].approach.wafer, 2);
    saved.slice = origin.table.slice;
    memcpy(saved.wafer, origin.wafer, sizeof saved.wafer);
    memcpy(saved.gripper, origin.gripper, sizeof saved.gripper);
    return 0;
}

static wh_status_t restore(const saved_t *from) {
    return wh_grasp_restore(&copy.table, from->slice, from->wafer, from->gripper);
}

static void step_both(void) {
    for (int g = 0; g < CELL_GRIPPERS; ++g) {
        cell_set_randomly(&origin, g, 3, 6);
        copy.input[g] = origin.input[g];
    }
    cell_step(&origin);
    cell_step(&copy);
    assert_int_equal(origin.list.count, copy.list.count);
    assert_memory_equal(origin.event, copy.event, origin.list.count * sizeof origin.event[0]);
}

static void a_restored_table_goes_on_with_the_same_bits(void **state) {
    (void)state;
    assert_int_not_equal(wh_grasp_hash(&copy.table), wh_grasp_hash(&origin.table));
    assert_int_equal(restore(&saved), WH_OK);
    assert_int_equal(copy.table.slice, origin.table.slice);
    assert_memory_equal(copy.wafer, origin.wafer, sizeof copy.wafer);
    assert_memory_equal(copy.gripper, origin.gripper, sizeof copy.gripper);
    for (int i = 0; i < 2000; ++i) {
        step_both();
        assert_true(wh_grasp_hash(&copy.table) == wh_grasp_hash(&origin.table));
    }
    assert_true(copy.table.counters.handed_over > 0 && copy.table.counters.near_misses > 0);
}

/* At any slice of a run, again and again over the table's earlier state. */
static void every_state_of_a_run_is_restored(void **state) {
    (void)state;
    for (int i = 0; i < 500; ++i) {
        for (int g = 0; g < CELL_GRIPPERS; ++g) {
            cell_set_randomly(&origin, g, 3, 6);
        }
        cell_step(&origin);
        assert_int_equal(wh_grasp_restore(&copy.table, origin.table.slice, origin.wafer, origin.gripper),
                         WH_OK);
        assert_true(wh_grasp_hash(&copy.table) == wh_grasp_hash(&origin.table));
    }
}

static void counters_go_on_and_releases_are_forgotten(void **state) {
    (void)state;
    copy.table.counters.picked = 7;
    saved.wafer[1].released_by = copy.wafer[1].released_by = 2;
    assert_int_equal(restore(&saved), WH_OK);
    assert_int_equal(copy.table.counters.picked, 7);
    assert_int_equal(copy.table.counters.refused, 0);
    assert_int_equal(copy.wafer[1].released_by, WH_NONE);
}

/* Fields without effect may have any value. */
static void only_what_counts_is_looked_at(void **state) {
    (void)state;
    saved.gripper[1].gripper_from_wafer.r.x = (wh_real_t)NAN; /* it holds none */
    saved.gripper[0].approach.holder = 99;
    saved.gripper[0].approach.measured.dr.x = (wh_real_t)NAN;
    saved.gripper[0].approach.slice = saved.slice + 9;
    saved.gripper[1].contest.slice = saved.slice;
    saved.gripper[2].approach.slice = 0;
    assert_int_equal(restore(&saved), WH_OK);
}

static void expect_refused(const saved_t *bad, wh_status_t status) {
    cell_t before;
    memcpy(&before, &copy, sizeof before);
    assert_int_equal(restore(bad), status);
    ++before.table.counters.refused;
    assert_memory_equal(&copy, &before, sizeof copy);
}

static void null_is_refused(void **state) {
    (void)state;
    assert_int_equal(wh_grasp_restore(NULL, 3, saved.wafer, saved.gripper), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grasp_restore(&copy.table, 3, NULL, saved.gripper), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grasp_restore(&copy.table, 3, saved.wafer, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(copy.table.counters.refused, 2);
    assert_int_equal(copy.table.slice, 0);
    copy.table.storage.wafer_count = copy.table.storage.gripper_count = 1;
    assert_int_equal(wh_grasp_restore(&copy.table, 3, NULL, saved.gripper), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grasp_restore(&copy.table, 3, saved.wafer, NULL), WH_STATUS_NULL_ARGUMENT);
}

static void nothing_is_restored_from_nothing(void **state) {
    (void)state;
    wh_grasp_t table;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t none = {NULL, 0, NULL, 0, NULL, 0};
    assert_int_equal(wh_grasp_init(&table, &config, &none), WH_OK);
    assert_int_equal(wh_grasp_restore(&table, 12, NULL, NULL), WH_OK);
    assert_int_equal(table.slice, 12);
    const wh_grasp_storage_t wafers_alone = {copy.wafer, CELL_WAFERS, NULL, 0, NULL, 0};
    assert_int_equal(wh_grasp_init(&table, &config, &wafers_alone), WH_OK);
    assert_int_equal(wh_grasp_restore(&table, 12, copy.wafer, NULL), WH_OK);
}

/* Indices outside the range, and indices within it that contradict each other. */
static void indices_must_agree(void **state) {
    (void)state;
    static const int32_t outside[] = {-2, INT32_MIN, CELL_WAFERS, INT32_MAX};
    for (size_t i = 0; i < 4; ++i) {
        int32_t *const field[] = {&saved.wafer[1].holder,           &saved.gripper[0].wafer,
                                  &saved.gripper[1].contest.wafer,  &saved.gripper[1].contest.holder,
                                  &saved.gripper[2].approach.wafer, &saved.gripper[2].approach.holder};
        for (size_t k = 0; k < sizeof field / sizeof field[0]; ++k) {
            const int32_t good = *field[k];
            *field[k] = outside[i];
            expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
            *field[k] = good;
        }
    }
    static const struct {
        int32_t *field, value;
    } rows[] = {
        {&saved.wafer[1].holder, CELL_GRIPPERS},           /* one too many */
        {&saved.gripper[1].contest.holder, CELL_GRIPPERS}, /* likewise */
        {&saved.gripper[1].contest.holder, WH_NONE},       /* then it is none */
        {&saved.gripper[2].approach.holder, 0},            /* nor is this, of a wafer that is held */
        {&saved.wafer[0].holder, WH_NONE},                 /* but gripper 0 names it */
        {&saved.wafer[0].holder, 1},                       /* likewise */
        {&saved.wafer[1].holder, 1},                       /* which holds nothing */
        {&saved.wafer[1].holder, 0},                       /* which holds another */
        {&saved.gripper[0].wafer, WH_NONE},                /* but wafer 0 names it */
        {&saved.gripper[0].wafer, 1},                      /* which is free */
        {&saved.gripper[1].wafer, 0},                      /* which another holds */
        {&saved.gripper[0].valve, CLOSED},                 /* and holds for all that */
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        const int32_t good = *rows[i].field;
        *rows[i].field = rows[i].value;
        expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
        *rows[i].field = good;
    }
    assert_int_equal(restore(&saved), WH_OK);
}

static void an_encounter_lies_in_the_past(void **state) {
    (void)state;
    saved.gripper[2].approach.slice = saved.slice + 1;
    expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
    saved.gripper[2].approach.slice = saved.slice;
    saved.gripper[1].contest.slice = UINT64_MAX;
    expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
}

static void valves_and_poses_are_looked_at(void **state) {
    (void)state;
    static const int32_t bad[] = {-1, 2, INT32_MAX};
    for (size_t i = 0; i < 3; ++i) {
        saved.gripper[2].valve = bad[i];
        expect_refused(&saved, WH_STATUS_BAD_VALVE);
    }
    saved.gripper[2].valve = OPEN;
    wh_pose_t *const pose[] = {&saved.wafer[3].base_from_wafer, &saved.gripper[2].base_from_gripper,
                               &saved.gripper[0].gripper_from_wafer};
    for (size_t i = 0; i < 3; ++i) {
        const wh_pose_t good = *pose[i];
        pose[i]->r.z = (wh_real_t)NAN;
        expect_refused(&saved, WH_STATUS_NOT_FINITE);
        *pose[i] = good;
        pose[i]->R.m[1][2] += WH_REAL(0.01);
        expect_refused(&saved, WH_STATUS_NOT_A_ROTATION);
        *pose[i] = good;
    }
    assert_int_equal(restore(&saved), WH_OK);
}

static void each_measured_value_is_looked_at(void **state) {
    (void)state;
    wh_encounter_t *const encounter[] = {&saved.gripper[1].contest, &saved.gripper[2].approach};
    for (size_t i = 0; i < 2; ++i) {
        wh_proximity_t *const p = &encounter[i]->measured;
        wh_real_t *const value[] = {&p->dr.x,         &p->dr.y,         &p->dr.z,
                                    &p->n1_proj_n2,   &p->dr_proj_z,    &p->dr_proj_xy.x,
                                    &p->dr_proj_xy.y, &p->dr_proj_xy.z, &p->dr_proj_xy_norm};
        for (size_t k = 0; k < 9; ++k) {
            const wh_real_t good = *value[k];
            *value[k] = k % 2 == 0 ? (wh_real_t)NAN : (wh_real_t)INFINITY;
            expect_refused(&saved, WH_STATUS_NOT_FINITE);
            *value[k] = good;
        }
    }
    assert_int_equal(restore(&saved), WH_OK);
}

/* Puts wafer 0 at the place to which gripper 0 carries it. */
static void carry_saved(void) {
    saved.wafer[0].base_from_wafer =
        wh_pose_compose(&saved.gripper[0].base_from_gripper, &saved.gripper[0].gripper_from_wafer);
}

/* Each number of its pose, off by more than rounding and by less. */
static void a_held_wafer_is_where_its_gripper_carries_it(void **state) {
    (void)state;
    saved.gripper[0].base_from_gripper = wh_test_random_pose(1000);
    carry_saved();
    assert_int_equal(restore(&saved), WH_OK);
    wh_pose_t *const pose = &saved.wafer[0].base_from_wafer;
    const wh_pose_t good = *pose;
    wh_real_t *const part[] = {&pose->r.x, &pose->r.y, &pose->r.z};
    for (size_t i = 0; i < 3; ++i) {
        static const double off[] = {1000, 1, 0.3, -0.3, -1e6};
        for (size_t k = 0; k < 5; ++k) {
            *part[i] += WH_REAL(off[k]);
            expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
            *pose = good;
        }
        *part[i] += WH_ROTATION_TOLERANCE;
        assert_int_equal(restore(&saved), WH_OK);
        *pose = good;
    }
    for (size_t i = 0; i < 3; ++i) {
        const wh_mat3_t turn = wh_test_rotation(i == 0, i == 1, i == 2, 0.01);
        pose->R = wh_mat3_multiply(&turn, &good.R);
        expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
    }
}

/* Grippers and wafers with any rotation, just within the tolerance: such a state of a table can be
 * restored. */
static void every_carried_wafer_is_restored(void **state) {
    (void)state;
    for (int i = 0; i < 3000; ++i) {
        wh_pose_t then = wh_test_random_pose(2000);
        wh_pose_t wafer = then;
        for (int k = 0; k < 9; ++k) {
            const double off = 0.3 * (double)WH_ROTATION_TOLERANCE;
            then.R.m[k / 3][k % 3] += WH_REAL(wh_test_uniform(-off, off));
            wafer.R.m[k / 3][k % 3] += WH_REAL(wh_test_uniform(-off, off));
        }
        wafer.r.x += WH_REAL(wh_test_uniform(-0.2, 0.2));
        cell_begin_default(&origin);
        origin.table.config.seat = i % 2 == 0;
        if (wh_grasp_place(&origin.table, 0, &wafer) != WH_OK || wh_pose_validate(&then) != WH_OK) {
            continue;
        }
        origin.input[0] = (wh_gripper_input_t){then, OPEN};
        cell_step(&origin);
        cell_expect_held(&origin, 0, 0);
        assert_int_equal(wh_grasp_restore(&copy.table, 1, origin.wafer, origin.gripper), WH_OK);
        origin.input[0].base_from_gripper = wh_test_random_pose(2000);
        cell_step(&origin);
        assert_int_equal(wh_grasp_restore(&copy.table, 2, origin.wafer, origin.gripper), WH_OK);
    }
}

/* Steps are counted on from there, and seq of a slice is an int64_t. */
static void slices_have_an_end(void **state) {
    (void)state;
    saved.slice = UINT64_MAX;
    expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
    saved.slice = (uint64_t)INT64_MAX + 1;
    expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
    saved.slice = INT64_MAX;
    assert_int_equal(restore(&saved), WH_OK);
    cell_step(&copy);
    assert_true(copy.table.slice == (uint64_t)INT64_MAX + 1);
}

/* If it were farther from its gripper than any check takes one, a wafer could be carried out of the
 * range of numbers. */
static void a_held_wafer_is_within_reach(void **state) {
    (void)state;
    wh_vec3_t *const r = &saved.gripper[0].gripper_from_wafer.r;
    const wh_vec3_t good = *r;
    const wh_real_t reach = 2 * (origin.table.config.tolerance.projz + origin.table.config.tolerance.projxy);
    wh_real_t *const part[] = {&r->x, &r->y, &r->z};
    for (size_t i = 0; i < 6; ++i) {
        const wh_real_t sign = i < 3 ? 1 : -1;
        *part[i % 3] = sign * reach * WH_REAL(1.001);
        expect_refused(&saved, WH_STATUS_OUT_OF_RANGE);
        *part[i % 3] = sign * reach;
        carry_saved();
        assert_int_equal(restore(&saved), WH_OK);
        *r = good;
    }
    *r = wh_vec3(reach, -reach, reach);
    carry_saved();
    assert_int_equal(restore(&saved), WH_OK);
    copy.input[0].base_from_gripper.r = wh_vec3(WH_TEST_LARGEST, -WH_TEST_LARGEST, WH_TEST_LARGEST);
    cell_step(&copy);
    assert_int_equal(wh_pose_validate(&copy.wafer[0].base_from_wafer), WH_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_restored_table_goes_on_with_the_same_bits, set_up),
        cmocka_unit_test_setup(every_state_of_a_run_is_restored, set_up),
        cmocka_unit_test_setup(counters_go_on_and_releases_are_forgotten, set_up),
        cmocka_unit_test_setup(only_what_counts_is_looked_at, set_up),
        cmocka_unit_test_setup(null_is_refused, set_up),
        cmocka_unit_test_setup(nothing_is_restored_from_nothing, set_up),
        cmocka_unit_test_setup(indices_must_agree, set_up),
        cmocka_unit_test_setup(an_encounter_lies_in_the_past, set_up),
        cmocka_unit_test_setup(valves_and_poses_are_looked_at, set_up),
        cmocka_unit_test_setup(each_measured_value_is_looked_at, set_up),
        cmocka_unit_test_setup(a_held_wafer_is_where_its_gripper_carries_it, set_up),
        cmocka_unit_test_setup(every_carried_wafer_is_restored, set_up),
        cmocka_unit_test_setup(slices_have_an_end, set_up),
        cmocka_unit_test_setup(a_held_wafer_is_within_reach, set_up),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
