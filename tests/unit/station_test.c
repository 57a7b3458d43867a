/* Where wafers lie, and what the cell says of a release. */
#include "support_pose.h"

#include "cell/station.h"
#include "motion/trig.h"

enum { STATIONS = 3, WAFERS = 3, GRIPPERS = 2, EVENTS = GRIPPERS * WH_EVENTS_PER_GRIPPER };

/* 0: 25 slots of 10 mm from (700, 0, 900) up; 1: tilted by 30 degrees; 2: the chuck of gripper 1. */
static wh_station_t stations[STATIONS];
static wh_cell_t cell;

static wh_station_t station_at(double x, double y, double z, int slots, int chuck) {
    wh_station_t station;
    station.base_from_station = wh_test_at(x, y, z);
    station.slots = slots;
    station.pitch = 10;
    station.chuck = chuck;
    return station;
}

static int set_up(void **state) {
    (void)state;
    stations[0] = station_at(700, 0, 900, 25, WH_NONE);
    stations[1] = station_at(0, 700, 900, 25, WH_NONE);
    stations[1].base_from_station.R = wh_mat3_from_rpy_deg(30, 0, 90);
    stations[2] = station_at(-600, 0, 950, 1, 1);
    cell.stations = stations;
    cell.count = STATIONS;
    cell.tolerance = wh_tolerance_paper();
    return 0;
}

/* A wafer at (x, y, z) in the frame of a station's slot 1. */
static wh_pose_t in_station(size_t station, double x, double y, double z) {
    const wh_pose_t station_from_wafer = wh_test_at(x, y, z);
    return wh_pose_compose(&stations[station].base_from_station, &station_from_wafer);
}

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

static void test_each_slot_is_found(void **state) {
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

static void test_offsets_are_measured_in_the_slots_frame(void **state) {
    (void)state;
    const wh_pose_t wafer = in_station(1, 13, -7, 42);
    wh_place_t place;
    assert_true(wh_cell_locate(&cell, &wafer, &place));
    assert_int_equal(place.slot, 5);
    assert_near(place.dx, 13, 4096 * WH_TEST_ROUNDING);
    assert_near(place.dy, -7, 4096 * WH_TEST_ROUNDING);
    assert_near(place.dz, 2, 4096 * WH_TEST_ROUNDING);
}

static void test_tilt_is_between_the_normals(void **state) {
    (void)state;
    wh_pose_t wafer = wh_test_at(700, 0, 900);
    wafer.R = wh_mat3_from_rpy_deg(WH_REAL(1.5), 0, 70);
    const wh_place_t place = wh_station_measure(&stations[0], 1, &wafer);
    assert_int_equal(place.station, WH_NONE);
    assert_near(place.tilt, 1.5 * WH_TEST_PI / 180, 16 * WH_TEST_ROUNDING);
}

/* Half a pitch up is in neither of two slots; the next number below is in the lower one. */
static void test_the_limit_of_height_is_strict(void **state) {
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

static void test_the_limit_aside_is_strict(void **state) {
    (void)state;
    wh_pose_t wafer = wh_test_at(730, 40, 900);
    expect_nowhere(&wafer);
    wafer.r.y = WH_REAL(39.99);
    expect_in(&wafer, 0, 1);
}

static void test_the_limit_of_tilt_is_strict(void **state) {
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

static void test_far_away_is_nowhere(void **state) {
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

static void test_the_nearer_of_two_stations_and_of_equal_ones_the_first(void **state) {
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

/* ----------------------------------------------------------------------------------------------- judging */

typedef struct {
    wh_grasp_t table;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    wh_event_t events[EVENTS];
    wh_event_list_t list;
} scene_t;

/* Wafer 0 was just let go of by gripper 0 there; the others lie far away, free. */
static void let_go(scene_t *scene, const wh_pose_t *base_from_wafer) {
    memset(scene, 0, sizeof *scene);
    for (int w = 0; w < WAFERS; ++w) {
        scene->wafers[w].base_from_wafer = wh_test_at(0, 5000 + 1000 * w, 0);
    }
    scene->wafers[0].base_from_wafer = *base_from_wafer;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {scene->wafers, WAFERS, scene->grippers, GRIPPERS, NULL, 0};
    assert_int_equal(wh_grasp_init(&scene->table, &config, &storage), WH_OK);
    scene->list.events = scene->events;
    scene->list.capacity = EVENTS;
    scene->list.count = 1;
    scene->events[0].kind = WH_EVENT_RELEASED;
    scene->events[0].slice = 17;
    scene->events[0].other = WH_NONE;
}

static size_t judge(scene_t *scene) {
    return wh_cell_judge(&cell, &scene->table, &scene->list);
}

static void expect_said(const scene_t *scene, wh_event_kind_t kind, int other, double height) {
    const wh_event_t *said = &scene->events[1];
    assert_int_equal(scene->list.count, 2);
    assert_int_equal(said->kind, kind);
    assert_int_equal(said->wafer, 0);
    assert_int_equal(said->gripper, 0);
    assert_int_equal(said->slice, 17);
    assert_int_equal(said->other, other);
    assert_near(said->height, height, 4096 * WH_TEST_ROUNDING);
}

static void test_a_release_in_a_free_slot_is_fine(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[0], 3);
    let_go(&scene, &slot);
    assert_int_equal(judge(&scene), 0);
    assert_int_equal(scene.list.count, 1);
}

static void test_only_releases_are_judged(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t in_air = wh_test_at(300, 300, 900);
    let_go(&scene, &in_air);
    scene.events[0].kind = WH_EVENT_HANDED_OVER;
    assert_int_equal(judge(&scene), 0);
    scene.list.count = 0;
    assert_int_equal(judge(&scene), 0);
}

static void test_an_unsupported_wafer_and_what_is_below_it(void **state) {
    (void)state;
    static const struct {
        double x, y, z, height;
    } rows[] = {
        {300, 300, 900, 900},  /* the floor */
        {700, 0, 1145, 5},     /* between slots: half a pitch above the top one */
        {700, 0, 1500, 360},   /* above the stack */
        {700, 0, 905, 5},      /* between two slots */
        {700, 0, 895, 895},    /* below the stack: the floor */
        {700, 50, 1500, 1500}, /* just beside the stack: the limit is strict */
        {300, 300, -25, -25},  /* under the floor */
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        scene_t scene;
        const wh_pose_t wafer = wh_test_at(rows[i].x, rows[i].y, rows[i].z);
        let_go(&scene, &wafer);
        assert_int_equal(judge(&scene), 1);
        expect_said(&scene, WH_EVENT_RELEASED_UNSUPPORTED, WH_NONE, rows[i].height);
    }
}

/* Base's origin may be high up in the machine. */
static void test_a_station_below_bases_origin_supports_too(void **state) {
    (void)state;
    scene_t scene;
    stations[0] = station_at(700, 0, -400, 1, WH_NONE);
    const wh_pose_t wafer = wh_test_at(700, 0, -388);
    let_go(&scene, &wafer);
    assert_int_equal(judge(&scene), 1);
    expect_said(&scene, WH_EVENT_RELEASED_UNSUPPORTED, WH_NONE, 12);
}

/* Of the slots below a wafer the nearest counts, wherever its station stands in the list. */
static void test_the_nearest_slot_below_supports(void **state) {
    (void)state;
    for (size_t lower = 0; lower < 2; ++lower) {
        scene_t scene;
        stations[lower] = station_at(700, 0, 100, 2, WH_NONE);
        stations[1 - lower] = station_at(700, 30, 300, 2, WH_NONE);
        const wh_pose_t wafer = wh_test_at(700, 10, 350);
        let_go(&scene, &wafer);
        assert_int_equal(judge(&scene), 1);
        expect_said(&scene, WH_EVENT_RELEASED_UNSUPPORTED, WH_NONE, 40);
    }
}

static void test_an_occupied_slot_names_the_lowest_wafer(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[0], 3);
    let_go(&scene, &slot);
    scene.wafers[1].base_from_wafer = wh_test_at(720, 10, 921);
    scene.wafers[2].base_from_wafer = slot;
    assert_int_equal(judge(&scene), 1);
    expect_said(&scene, WH_EVENT_SLOT_OCCUPIED, 1, 0);
}

static void test_a_neighbours_slot_is_not_this_one(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[0], 3);
    let_go(&scene, &slot);
    scene.wafers[1].base_from_wafer = wh_station_slot(&stations[0], 4);
    scene.wafers[2].base_from_wafer = wh_station_slot(&stations[1], 3);
    assert_int_equal(judge(&scene), 0);
}

/* What the chuck holds lies there; what a blade carries over the chuck passes. */
static void test_a_chucks_wafer_occupies_it_and_a_blades_does_not(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[2], 1);
    let_go(&scene, &slot);
    scene.wafers[2].base_from_wafer = slot;
    scene.wafers[2].holder = 0;
    assert_int_equal(judge(&scene), 0);
    scene.wafers[2].holder = stations[2].chuck;
    assert_int_equal(judge(&scene), 1);
    expect_said(&scene, WH_EVENT_SLOT_OCCUPIED, 2, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_each_slot_is_found, set_up),
        cmocka_unit_test_setup(test_offsets_are_measured_in_the_slots_frame, set_up),
        cmocka_unit_test_setup(test_tilt_is_between_the_normals, set_up),
        cmocka_unit_test_setup(test_the_limit_of_height_is_strict, set_up),
        cmocka_unit_test_setup(test_the_limit_aside_is_strict, set_up),
        cmocka_unit_test_setup(test_the_limit_of_tilt_is_strict, set_up),
        cmocka_unit_test_setup(test_far_away_is_nowhere, set_up),
        cmocka_unit_test_setup(test_the_nearer_of_two_stations_and_of_equal_ones_the_first, set_up),
        cmocka_unit_test_setup(test_a_release_in_a_free_slot_is_fine, set_up),
        cmocka_unit_test_setup(test_only_releases_are_judged, set_up),
        cmocka_unit_test_setup(test_an_unsupported_wafer_and_what_is_below_it, set_up),
        cmocka_unit_test_setup(test_a_station_below_bases_origin_supports_too, set_up),
        cmocka_unit_test_setup(test_the_nearest_slot_below_supports, set_up),
        cmocka_unit_test_setup(test_an_occupied_slot_names_the_lowest_wafer, set_up),
        cmocka_unit_test_setup(test_a_neighbours_slot_is_not_this_one, set_up),
        cmocka_unit_test_setup(test_a_chucks_wafer_occupies_it_and_a_blades_does_not, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
