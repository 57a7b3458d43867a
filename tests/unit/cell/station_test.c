/* Where wafers lie. */
#include "support/station.h"

static void expect_in(const wh_pose_t *wafer, int station, int slot) {
    wh_place_t place;
    assert_true(wh_cell_locate(&cell, wafer, &place));
    assert_int_equal(place.station, station);
    assert_int_equal(place.slot, slot);
}

static void expect_nowhere(const wh_pose_t *wafer) {
    wh_place_t place;
    wh_place_t before;
    memset(&place, 0x5a, sizeof place);
    before = place;
    assert_false(wh_cell_locate(&cell, wafer, &place));
    assert_memory_equal(&place, &before, sizeof place);
}

static void each_slot_is_found(void **state) {
    (void)state;
    for (size_t s = 0; s < STATIONS; ++s) {
        for (int slot = 1; slot <= stations[s].slots; ++slot) {
            const wh_pose_t slot_pose = wh_station_slot(&stations[s], slot);
            wh_place_t place;
            expect_in(&slot_pose, (int)s, slot);
            assert_true(wh_cell_locate(&cell, &slot_pose, &place));
            assert_near(place.dx, 0, 4096 * WH_TEST_ROUNDING);
            assert_near(place.dz, 0, 4096 * WH_TEST_ROUNDING);
            assert_near(place.tilt, 0, 8 * WH_TEST_ROUNDING);
        }
    }
}

static void offsets_are_measured_in_the_slots_frame(void **state) {
    (void)state;
    const wh_pose_t wafer = in_station(1, 13, -7, 42);
    wh_place_t place;
    assert_true(wh_cell_locate(&cell, &wafer, &place));
    assert_int_equal(place.slot, 5);
    assert_near(place.dx, 13, 4096 * WH_TEST_ROUNDING);
    assert_near(place.dy, -7, 4096 * WH_TEST_ROUNDING);
    assert_near(place.dz, 2, 4096 * WH_TEST_ROUNDING);
}

static void tilt_is_between_the_normals(void **state) {
    (void)state;
    wh_pose_t wafer = wh_test_at(700, 0, 900);
    wafer.R = wh_mat3_from_rpy_deg(WH_REAL(1.5), 0, 70);
    const wh_place_t place = wh_station_measure(&stations[0], 1, &wafer);
    assert_int_equal(place.station, WH_NONE);
    assert_near(place.tilt, 1.5 * WH_TEST_PI / 180, 16 * WH_TEST_ROUNDING);
}

/* Half a pitch up the pose is in neither of two slots; the next number below is in the lower one. */
static void the_limit_of_height_is_strict(void **state) {
    (void)state;
    const wh_real_t middle = 905;
    wh_pose_t wafer = wh_test_at(700, 0, 905);
    expect_nowhere(&wafer);
    wafer.r.z = wh_test_neighbour(middle, 900);
    expect_in(&wafer, 0, 1);
    wafer.r.z = wh_test_neighbour(middle, 910);
    expect_in(&wafer, 0, 2);
    wafer.r.z = 895;
    expect_nowhere(&wafer);
    wafer.r.z = 1145;
    expect_nowhere(&wafer);
    wafer.r.z = wh_test_neighbour(1145, 0);
    expect_in(&wafer, 0, 25);
}

static void the_limit_aside_is_strict(void **state) {
    (void)state;
    wh_pose_t wafer = wh_test_at(730, 40, 900);
    expect_nowhere(&wafer);
    wafer.r.y = WH_REAL(39.99);
    expect_in(&wafer, 0, 1);
}

static void the_limit_of_tilt_is_strict(void **state) {
    (void)state;
    wh_pose_t wafer = wh_test_at(700, 0, 900);
    cell.tolerance.planar = WH_REAL(0.5);
    wafer.R = wh_mat3_from_rpy_deg(WH_REAL(59.9), 0, 0);
    expect_in(&wafer, 0, 1);
    wafer.R = wh_mat3_from_rpy_deg(WH_REAL(60.1), 0, 0);
    expect_nowhere(&wafer);
    wafer.R = wh_mat3_from_rpy_deg(180, 0, 0);
    expect_nowhere(&wafer);
    cell.tolerance.planar = wh_mat3_from_rpy_deg(30, 0, 0).m[2][2];
    wafer.R = wh_mat3_from_rpy_deg(30, 0, 0);
    expect_nowhere(&wafer);
}

static void far_away_is_nowhere(void **state) {
    (void)state;
    static const double far[] = {1e6, 1e12, 1e18, 1e30};
    for (size_t i = 0; i < sizeof far / sizeof far[0]; ++i) {
        const wh_pose_t above = wh_test_at(700, 0, far[i]);
        const wh_pose_t below = wh_test_at(700, 0, -far[i]);
        const wh_pose_t aside = wh_test_at(far[i], -far[i], 900);
        expect_nowhere(&above);
        expect_nowhere(&below);
        expect_nowhere(&aside);
    }
}

static void the_nearer_of_two_stations_and_of_equal_ones_the_first(void **state) {
    (void)state;
    stations[1] = station_at(720, 0, 900, 1, WH_NONE);
    wh_pose_t wafer = wh_test_at(711, 0, 900);
    expect_in(&wafer, 1, 1);
    wafer.r.x = 709;
    expect_in(&wafer, 0, 1);
    wafer.r.x = 710;
    expect_in(&wafer, 0, 1);
    cell.count = 0;
    expect_nowhere(&wafer);
}

/* Slot 1 is the lowest, whatever is below it. */
static void there_is_no_slot_below_the_first(void **state) {
    (void)state;
    for (int tenths = 50; tenths <= 400; ++tenths) {
        const wh_pose_t below = in_station(0, 0, 0, -0.1 * tenths);
        const wh_pose_t above = in_station(0, 0, 0, 240 + 0.1 * tenths);
        expect_nowhere(&below);
        expect_nowhere(&above);
    }
}

enum { GRIPPERS = 2 };

/* Gives `number` each bad value in turn, and expects the refusal. */
static void refuse_numbers(wh_real_t *number, const double bad[], size_t count, wh_status_t status) {
    const wh_real_t good = *number;
    for (size_t i = 0; i < count; ++i) {
        *number = WH_REAL(bad[i]);
        assert_int_equal(wh_cell_validate(&cell, GRIPPERS), status);
    }
    *number = good;
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_OK);
}

static void a_cell_has_its_ranges(void **state) {
    (void)state;
    static const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, -1, 1.1e6, -1e-30, 0};
    refuse_numbers(&stations[1].pitch, bad, 7, WH_STATUS_OUT_OF_RANGE);
    refuse_numbers(&cell.off_centre, bad, 6, WH_STATUS_OUT_OF_RANGE);
    refuse_numbers(&cell.askew, bad, 6, WH_STATUS_OUT_OF_RANGE);
    refuse_numbers(&cell.drop, bad, 6, WH_STATUS_OUT_OF_RANGE);
    refuse_numbers(&cell.tolerance.projz, bad, 7, WH_STATUS_BAD_TOLERANCE);
    refuse_numbers(&cell.tolerance.projxy, bad, 7, WH_STATUS_BAD_TOLERANCE);
    refuse_numbers(&cell.tolerance.planar, bad, 6, WH_STATUS_BAD_TOLERANCE);
    refuse_numbers(&stations[2].base_from_station.r.z, bad, 3, WH_STATUS_NOT_FINITE);
    refuse_numbers(&stations[2].base_from_station.R.m[1][1], bad + 3, 2, WH_STATUS_NOT_A_ROTATION);
    cell.off_centre = WH_REAL(1e6);
    cell.askew = 10;
    stations[0].pitch = WH_REAL(1e6);
    stations[1].pitch = WH_REAL(1e-30);
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_OK);
}

static void a_station_has_slots_and_perhaps_a_chuck(void **state) {
    (void)state;
    static const int32_t slots[] = {0, -1, INT32_MIN, 1001, INT32_MAX};
    static const int32_t chucks[] = {-2, INT32_MIN, GRIPPERS, INT32_MAX};
    for (size_t i = 0; i < 5; ++i) {
        stations[0].slots = slots[i];
        assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_STATUS_OUT_OF_RANGE);
    }
    stations[0].slots = 1000;
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_OK);
    for (size_t i = 0; i < 4; ++i) {
        stations[2].chuck = chucks[i];
        assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_STATUS_OUT_OF_RANGE);
    }
    stations[2].chuck = 0;
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_OK);
    assert_int_equal(wh_cell_validate(&cell, 0), WH_STATUS_OUT_OF_RANGE);
}

static void a_cell_needs_the_stations_that_it_counts(void **state) {
    (void)state;
    assert_int_equal(wh_cell_validate(NULL, GRIPPERS), WH_STATUS_NULL_ARGUMENT);
    cell.count = (size_t)INT32_MAX + 1;
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_STATUS_BAD_CAPACITY);
    cell.count = 1;
    cell.stations = NULL;
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_STATUS_NULL_ARGUMENT);
    cell.count = 0;
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_OK);
    memset(&cell.tolerance, 0, sizeof cell.tolerance); /* then this tolerance judges nothing */
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_OK);
}

/* The largest numbers that a cell may have neither trap nor count as near. */
static void huge_cells_are_cells(void **state) {
    (void)state;
    const double far = (double)WH_TEST_LARGEST;
    stations[0].base_from_station.r = wh_vec3(WH_REAL(far), WH_REAL(-far), WH_REAL(far));
    stations[0].slots = 1000;
    stations[0].pitch = WH_REAL(1e6);
    stations[1].pitch = WH_REAL(1e-30);
    assert_int_equal(wh_cell_validate(&cell, GRIPPERS), WH_OK);
    const wh_pose_t opposite = wh_test_at(-far, far, -far);
    expect_nowhere(&opposite);
    const wh_pose_t there = stations[0].base_from_station;
    expect_in(&there, 0, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(each_slot_is_found, set_up),
        cmocka_unit_test_setup(offsets_are_measured_in_the_slots_frame, set_up),
        cmocka_unit_test_setup(tilt_is_between_the_normals, set_up),
        cmocka_unit_test_setup(the_limit_of_height_is_strict, set_up),
        cmocka_unit_test_setup(the_limit_aside_is_strict, set_up),
        cmocka_unit_test_setup(the_limit_of_tilt_is_strict, set_up),
        cmocka_unit_test_setup(far_away_is_nowhere, set_up),
        cmocka_unit_test_setup(there_is_no_slot_below_the_first, set_up),
        cmocka_unit_test_setup(a_cell_has_its_ranges, set_up),
        cmocka_unit_test_setup(a_station_has_slots_and_perhaps_a_chuck, set_up),
        cmocka_unit_test_setup(a_cell_needs_the_stations_that_it_counts, set_up),
        cmocka_unit_test_setup(huge_cells_are_cells, set_up),
        cmocka_unit_test_setup(the_nearer_of_two_stations_and_of_equal_ones_the_first, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
