/* The cell's report of a release, and of a chuck that takes a wafer over. */
#include "support/station.h"

enum { WAFERS = 3, GRIPPERS = 2, EVENTS = GRIPPERS * WH_EVENTS_PER_GRIPPER };

typedef struct {
    wh_grasp_t table;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    wh_event_t events[EVENTS];
    wh_event_list_t list;
} scene_t;

/* Gripper 0 has just released wafer 0 there; the others lie far away, free. */
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

static void a_release_in_a_free_slot_is_fine(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[0], 3);
    let_go(&scene, &slot);
    assert_int_equal(judge(&scene), 0);
    assert_int_equal(scene.list.count, 1);
}

static void only_releases_are_judged(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t in_air = wh_test_at(300, 300, 900);
    let_go(&scene, &in_air);
    static const wh_event_kind_t others[] = {WH_EVENT_PICKED, WH_EVENT_HANDED_OVER, WH_EVENT_NEAR_MISS,
                                             WH_EVENT_CONTESTED};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        scene.events[0].kind = others[i];
        assert_int_equal(judge(&scene), 0);
    }
    /* Entries beyond the list's end are none of its events. */
    scene.events[1] = scene.events[0];
    scene.events[1].kind = WH_EVENT_RELEASED;
    assert_int_equal(judge(&scene), 0);
    scene.events[0].kind = WH_EVENT_RELEASED;
    scene.list.count = 0;
    assert_int_equal(judge(&scene), 0);
}

static void an_unsupported_wafer_and_what_is_below_it(void **state) {
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
        {760, 0, 1500, 1500},  /* beside it along x alone */
        {700, 60, 1500, 1500}, /* along y alone */
        {760, 50, 1500, 1500}, /* along both */
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
static void a_station_below_bases_origin_supports_too(void **state) {
    (void)state;
    scene_t scene;
    stations[0] = station_at(700, 0, -400, 1, WH_NONE);
    const wh_pose_t wafer = wh_test_at(700, 0, -388);
    let_go(&scene, &wafer);
    assert_int_equal(judge(&scene), 1);
    expect_said(&scene, WH_EVENT_RELEASED_UNSUPPORTED, WH_NONE, 12);
}

/* Among the slots below a wafer the nearest counts, wherever its station stands in the list. */
static void the_nearest_slot_below_supports(void **state) {
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

/* A tilted wafer is in no slot, and yet is over the slot below its centre. */
static void a_leaning_wafer_is_above_what_is_below(void **state) {
    (void)state;
    static const double heights[][2] = {{0, 0}, {0.5, 0.5}, {-0.5, 899.5}, {-0.25, -0.25}, {4, 4}};
    for (size_t i = 0; i < 5; ++i) {
        scene_t scene;
        wh_pose_t wafer = wh_test_at(700, 0, 900 + heights[i][0]);
        wafer.R = wh_mat3_from_rpy_deg(30, 0, 0);
        let_go(&scene, &wafer);
        assert_int_equal(judge(&scene), 1);
        expect_said(&scene, WH_EVENT_RELEASED_UNSUPPORTED, WH_NONE, heights[i][1]);
        /* It lies in none because of its tilt, unless it is too far from all of them. */
        const bool is_near = heights[i][1] < 5;
        assert_near(scene.events[1].value, is_near ? WH_PI / 6 : 0, 1e-5);
    }
}

/* Entries of stations and wafers beyond the count are ignored. */
static void what_is_beyond_a_count_is_not_there(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[0], 3);
    let_go(&scene, &slot);
    scene.wafers[WAFERS - 1].base_from_wafer = slot;
    scene.table.storage.wafer_count = WAFERS - 1;
    assert_int_equal(judge(&scene), 0);
    stations[STATIONS - 1] = station_at(300, 300, 100, 1, WH_NONE);
    cell.count = STATIONS - 1;
    const wh_pose_t wafer = wh_test_at(300, 300, 120);
    let_go(&scene, &wafer);
    assert_int_equal(judge(&scene), 1);
    expect_said(&scene, WH_EVENT_RELEASED_UNSUPPORTED, WH_NONE, 120);
}

/* Each release has its own report. */
static void two_releases_are_judged_in_turn(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[0], 3);
    let_go(&scene, &slot);
    scene.wafers[0].base_from_wafer = wh_test_at(300, 300, 30);
    scene.wafers[1].base_from_wafer = scene.wafers[2].base_from_wafer = slot;
    scene.events[1] = scene.events[0];
    scene.events[1].gripper = 1;
    scene.events[1].wafer = 1;
    scene.list.count = 2;
    assert_int_equal(judge(&scene), 2);
    assert_int_equal(scene.events[2].kind, WH_EVENT_RELEASED_UNSUPPORTED);
    assert_near(scene.events[2].height, 30, 0);
    assert_int_equal(scene.events[3].kind, WH_EVENT_SLOT_OCCUPIED);
    assert_int_equal(scene.events[3].gripper, 1);
    assert_int_equal(scene.events[3].other, 2);
    /* The roles are exchanged: the wafer with the lower index lay there. */
    scene.events[0].wafer = 2;
    scene.wafers[0].base_from_wafer = slot;
    scene.wafers[1].base_from_wafer = wh_test_at(300, 300, 30);
    scene.list.count = 2;
    assert_int_equal(judge(&scene), 2);
    assert_int_equal(scene.events[2].other, 0);
    assert_near(scene.events[3].height, 30, 0);
}

static void an_occupied_slot_names_the_lowest_wafer(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[0], 3);
    let_go(&scene, &slot);
    scene.wafers[1].base_from_wafer = wh_test_at(720, 10, 921);
    scene.wafers[2].base_from_wafer = slot;
    assert_int_equal(judge(&scene), 1);
    expect_said(&scene, WH_EVENT_SLOT_OCCUPIED, 1, 0);
}

static void a_neighbours_slot_is_not_this_one(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t slot = wh_station_slot(&stations[0], 3);
    let_go(&scene, &slot);
    scene.wafers[1].base_from_wafer = wh_station_slot(&stations[0], 4);
    scene.wafers[2].base_from_wafer = wh_station_slot(&stations[1], 3);
    assert_int_equal(judge(&scene), 0);
    scene.wafers[0].base_from_wafer = wh_station_slot(&stations[1], 3);
    scene.wafers[1].base_from_wafer = wh_station_slot(&stations[1], 2);
    scene.wafers[2].base_from_wafer = wh_station_slot(&stations[0], 3);
    assert_int_equal(judge(&scene), 0);
}

/* The wafer that the chuck holds lies there; the wafer that a blade carries over the chuck passes. */
static void a_chucks_wafer_occupies_it_and_a_blades_does_not(void **state) {
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
    scene.wafers[2].holder = WH_NONE;
    scene.list.count = 1;
    assert_int_equal(judge(&scene), 1);
    /* In a plain slot nothing holds a wafer. */
    const wh_pose_t plain = wh_station_slot(&stations[0], 2);
    scene.wafers[0].base_from_wafer = scene.wafers[2].base_from_wafer = plain;
    scene.wafers[2].holder = 0;
    scene.list.count = 1;
    assert_int_equal(judge(&scene), 0);
}

/* ---------------------------------------------------------------------------------------------- limits of placing */

static void limits_of_placing(void **state) {
    (void)state;
    scene_t scene;
    cell.off_centre = 5;
    cell.askew = WH_REAL(0.01);
    const wh_pose_t centred = wh_test_at(703, 4, 900);
    let_go(&scene, &centred);
    assert_int_equal(judge(&scene), 0); /* at the limit counts as within it */
    const wh_pose_t aside = wh_test_at(703, 4.01, 900);
    let_go(&scene, &aside);
    assert_int_equal(judge(&scene), 1);
    assert_int_equal(scene.events[1].kind, WH_EVENT_PLACED_OFF_CENTRE);
    assert_near(scene.events[1].limit, 5, 0);
    assert_true(scene.events[1].value > 5 && scene.events[1].value < 5.02);
    wh_pose_t tilted = wh_test_at(700, 6, 900);
    tilted.R = wh_mat3_from_rpy_deg(1, 0, 0);
    let_go(&scene, &tilted);
    assert_int_equal(judge(&scene), 2);
    assert_int_equal(scene.events[2].kind, WH_EVENT_PLACED_ASKEW);
    assert_near(scene.events[2].value, wh_rad_from_deg(1), 64 * WH_TEST_ROUNDING);
    for (int none = -1; none <= 0; ++none) {
        cell.off_centre = cell.askew = (wh_real_t)none;
        let_go(&scene, &tilted);
        assert_int_equal(judge(&scene), 0);
    }
    cell.off_centre = cell.askew = 0;
}

/* Gripper `taker` has just taken wafer 0 over from the other one; the chuck is gripper 1. */
static void hand_over(scene_t *scene, int taker, const wh_pose_t *base_from_taker,
                      const wh_pose_t *base_from_wafer) {
    let_go(scene, base_from_wafer);
    scene->events[0].kind = WH_EVENT_HANDED_OVER;
    scene->events[0].gripper = taker;
    scene->events[0].other = 1 - taker;
    scene->grippers[taker].base_from_gripper = *base_from_taker;
    scene->wafers[0].holder = taker;
}

static void a_chuck_that_takes_a_wafer_over_is_judged(void **state) {
    (void)state;
    scene_t scene;
    cell.off_centre = 5;
    cell.askew = WH_REAL(0.01);
    const wh_pose_t chuck = wh_station_slot(&stations[2], 1);
    const wh_pose_t centred = in_station(2, 3, 4, 0.25);
    hand_over(&scene, 1, &chuck, &centred);
    assert_int_equal(judge(&scene), 0);
    wh_pose_t aside = in_station(2, 3, 4.5, 0);
    hand_over(&scene, 1, &chuck, &aside);
    assert_int_equal(judge(&scene), 1);
    assert_int_equal(scene.events[1].kind, WH_EVENT_PLACED_OFF_CENTRE);
    assert_int_equal(scene.events[1].gripper, 1);
    assert_near(scene.events[1].value, wh_real_sqrt(WH_REAL(29.25)), 4096 * WH_TEST_ROUNDING);
    aside.R = wh_mat3_from_rpy_deg(0, 1, 0);
    hand_over(&scene, 1, &chuck, &aside);
    assert_int_equal(judge(&scene), 2);
    assert_int_equal(scene.events[2].kind, WH_EVENT_PLACED_ASKEW);
    /* A stage has brought the chuck below the wafer; and a blade that takes it from the chuck sets nothing down. */
    aside = in_station(2, 3, 4.5, 0);
    hand_over(&scene, 1, &aside, &aside);
    assert_int_equal(judge(&scene), 0);
    hand_over(&scene, 0, &chuck, &aside);
    assert_int_equal(judge(&scene), 0);
    cell.off_centre = cell.askew = 0;
    hand_over(&scene, 1, &chuck, &aside);
    assert_int_equal(judge(&scene), 0);
}

/* Let go in the air, or too low, and beside its slot: each is told. */
static void an_unsupported_wafer_may_be_off_centre_too(void **state) {
    (void)state;
    scene_t scene;
    cell.off_centre = 2;
    cell.drop = 2;
    const wh_pose_t high = wh_test_at(703, 4, 902.25), low = wh_test_at(703, 4, 899);
    for (int i = 0; i < 2; ++i) {
        let_go(&scene, i == 0 ? &high : &low);
        assert_int_equal(judge(&scene), 2);
        assert_int_equal(scene.events[1].kind, WH_EVENT_RELEASED_UNSUPPORTED);
        assert_int_equal(scene.events[2].kind, WH_EVENT_PLACED_OFF_CENTRE);
        assert_near(scene.events[2].value, 5, 4096 * WH_TEST_ROUNDING);
    }
    cell.off_centre = cell.drop = 0;
}

/* Over its slot, but higher than the allowed fall. */
static void a_wafer_let_go_in_the_air(void **state) {
    (void)state;
    scene_t scene;
    cell.drop = 2;
    const wh_pose_t high = wh_test_at(703, 4, 902.25);
    let_go(&scene, &high);
    assert_int_equal(judge(&scene), 1);
    assert_int_equal(scene.events[1].kind, WH_EVENT_RELEASED_UNSUPPORTED);
    assert_near(scene.events[1].height, 2.25, 64 * WH_TEST_ROUNDING * 900);
    assert_near(scene.events[1].limit, 2, 0);
    const wh_pose_t low = wh_test_at(703, 4, 901.75);
    let_go(&scene, &low);
    assert_int_equal(judge(&scene), 0);
    cell.drop = 0;
    let_go(&scene, &high);
    assert_int_equal(judge(&scene), 0);
}

static void a_full_list_takes_no_more(void **state) {
    (void)state;
    scene_t scene;
    cell.off_centre = 1;
    const wh_pose_t aside = wh_test_at(710, 0, 900);
    let_go(&scene, &aside);
    scene.list.capacity = 1;
    assert_int_equal(judge(&scene), 0);
    assert_int_equal(scene.list.count, 1);
    const wh_pose_t nowhere = wh_test_at(0, 0, 100);
    let_go(&scene, &nowhere);
    scene.list.capacity = 1;
    assert_int_equal(judge(&scene), 0);
    cell.off_centre = 0;
}

/* ------------------------------------------------------------------------------------------------------ settling */

/* Releases it there, and it settles; returns the number of events. */
static size_t settle(scene_t *scene, const wh_pose_t *base_from_wafer) {
    let_go(scene, base_from_wafer);
    cell.settle = true;
    wh_cell_settle(&cell, &scene->table, &scene->list);
    cell.settle = false;
    return scene->list.count - 1;
}

static void a_wafer_comes_to_lie_on_its_slot(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t base_from_slot = wh_station_slot(&stations[1], 3);
    wh_pose_t slot_from_wafer = wh_test_at(3, -2, 0.4);
    slot_from_wafer.R = wh_mat3_from_rpy_deg(1.5, -0.7, 40);
    const wh_pose_t start = wh_pose_compose(&base_from_slot, &slot_from_wafer);
    assert_int_equal(settle(&scene, &start), 1);
    assert_int_equal(scene.events[1].kind, WH_EVENT_SETTLED);
    assert_near(scene.events[1].value, 0.4, 4096 * WH_TEST_ROUNDING);
    const wh_place_t place = wh_station_measure(&stations[1], 3, &scene.wafers[0].base_from_wafer);
    assert_near(place.dx, 3, 4096 * WH_TEST_ROUNDING);
    assert_near(place.dy, -2, 4096 * WH_TEST_ROUNDING);
    assert_near(place.dz, 0, 4096 * WH_TEST_ROUNDING);
    /* The turn is the smallest, by the angle between the normals: no tilt is left, and x stays
     * within this angle. */
    const wh_vec3_t n = wh_mat3_column(&scene.wafers[0].base_from_wafer.R, 2);
    const wh_vec3_t up = wh_mat3_column(&base_from_slot.R, 2);
    assert_near(wh_vec3_dot(&n, &up), 1, 64 * WH_TEST_ROUNDING);
    const wh_vec3_t from = wh_mat3_column(&start.R, 2);
    wh_real_t signals = 0;
    for (size_t column = 0; column < 3; ++column) {
        const wh_vec3_t a = wh_mat3_column(&start.R, column);
        const wh_vec3_t b = wh_mat3_column(&scene.wafers[0].base_from_wafer.R, column);
        signals += wh_vec3_dot(&a, &b);
    }
    assert_near((signals - 1) / 2, wh_vec3_dot(&from, &up), 64 * WH_TEST_ROUNDING);
    assert_int_equal(wh_pose_validate(&scene.wafers[0].base_from_wafer), WH_OK);
}

/* A wafer that leans with its centre in the plane comes to lie flat, and has not sunk. */
static void a_leaning_wafer_in_its_plane_comes_to_lie(void **state) {
    (void)state;
    scene_t scene;
    wh_pose_t wafer = wh_test_at(700, 0, 900);
    wafer.R = wh_mat3_from_rpy_deg(1.5, 0, 0);
    assert_int_equal(settle(&scene, &wafer), 0);
    assert_near(scene.wafers[0].base_from_wafer.R.m[2][2], 1, 4 * WH_TEST_ROUNDING);
    assert_near(scene.wafers[0].base_from_wafer.r.z, 900, 0);
    let_go(&scene, &wafer);
    wh_cell_settle(&cell, &scene.table, &scene.list); /* not asked for */
    assert_memory_equal(&scene.wafers[0].base_from_wafer, &wafer, sizeof wafer);
}

static void what_does_not_settle(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t above = wh_test_at(700, 0, 900.25);
    let_go(&scene, &above);
    wh_cell_settle(&cell, &scene.table, &scene.list); /* not asked for */
    assert_int_equal(scene.list.count, 1);
    assert_near(scene.wafers[0].base_from_wafer.r.z, 900.25, 0);
    const wh_pose_t far_below = wh_test_at(700, 0, WH_REAL(899.4)); /* the tolerance is 0.5 */
    assert_int_equal(settle(&scene, &far_below), 0);
    assert_near(scene.wafers[0].base_from_wafer.r.z, 899.4, 1e-3);
    const wh_pose_t outside = wh_test_at(800, 0, 900.25);
    assert_int_equal(settle(&scene, &outside), 0);
    assert_near(scene.wafers[0].base_from_wafer.r.z, 900.25, 0);
    let_go(&scene, &above);
    scene.events[0].kind = WH_EVENT_HANDED_OVER;
    cell.settle = true;
    wh_cell_settle(&cell, &scene.table, &scene.list);
    cell.settle = false;
    assert_int_equal(scene.list.count, 1);
}

/* With settling and without: a wafer that was released a little too low has stayed on its ledges,
 * and nothing is reported. */
static void a_support_stops_what_was_let_go_below_it(void **state) {
    (void)state;
    scene_t scene;
    for (int i = 1; i < 10; ++i) {
        const wh_pose_t below = wh_test_at(700, 3, 900 - WH_REAL(0.05) * (wh_real_t)i);
        let_go(&scene, &below);
        cell.settle = i % 2 == 0;
        wh_cell_settle(&cell, &scene.table, &scene.list);
        cell.settle = false;
        assert_int_equal(scene.list.count, 1);
        assert_near(scene.wafers[0].base_from_wafer.r.x, 700, 1e-3);
        assert_near(scene.wafers[0].base_from_wafer.r.y, 3, 1e-3);
        assert_near(scene.wafers[0].base_from_wafer.r.z, 900, 1e-3);
    }
}

/* Each release of a list is judged, and none beyond its end. */
/* Releases a wafer that is turned over; its front face is at this pose. */
static wh_pose_t face_down(const wh_pose_t *base_from_front) {
    wh_pose_t wafer;
    wh_face_frame(base_from_front, WH_REAL(0.775), WH_FACE_FRONT, &wafer);
    return wafer;
}

static void a_wafer_face_down_lies_on_its_front_and_settles_on_it(void **state) {
    (void)state;
    scene_t scene;
    wh_place_t place;
    wh_pose_t front = in_station(1, 3, 2, 10.25);
    const wh_pose_t leaning = {wh_mat3_from_rpy_deg(1, -2, 40), {0, 0, 0}};
    front = wh_pose_compose(&front, &leaning);
    const wh_pose_t wafer = face_down(&front);
    assert_false(wh_cell_locate(&cell, &wafer, &place));
    cell.thickness = WH_REAL(0.775);
    assert_true(wh_cell_locate(&cell, &wafer, &place));
    assert_int_equal(place.face, WH_FACE_FRONT);
    assert_int_equal(place.slot, 2);
    assert_near(place.dx, 3, 1e5 * WH_TEST_ROUNDING);
    assert_near(place.dy, 2, 1e5 * WH_TEST_ROUNDING);
    assert_near(place.dz, 0.25, 1e5 * WH_TEST_ROUNDING);
    assert_int_equal(settle(&scene, &wafer), 1);
    assert_true(wh_cell_locate(&cell, &scene.wafers[0].base_from_wafer, &place));
    assert_int_equal(place.face, WH_FACE_FRONT);
    assert_near(place.dx, 3, 1e5 * WH_TEST_ROUNDING);
    assert_near(place.dz, 0, 1e5 * WH_TEST_ROUNDING);
    assert_near(place.tilt, 0, 1e5 * WH_TEST_ROUNDING);
    const wh_pose_t above = in_station(1, 0, 0, 0.25);
    const wh_pose_t on = in_station(1, 0, 0, 0);
    const wh_pose_t hangs = face_down(&above);
    const wh_pose_t lies = face_down(&on);
    assert_false(wh_cell_stops(&cell, &hangs, &hangs));
    assert_true(wh_cell_stops(&cell, &hangs, &lies));
    cell.thickness = -1;
    assert_int_equal(wh_cell_validate(&cell, 2), WH_STATUS_OUT_OF_RANGE);
    cell.thickness = WH_REAL(100.5);
    assert_int_equal(wh_cell_validate(&cell, 2), WH_STATUS_OUT_OF_RANGE);
    cell.thickness = 0;
}

static void each_release_settles_in_turn(void **state) {
    (void)state;
    scene_t scene;
    cell.settle = true;
    const wh_pose_t nowhere = wh_test_at(300, 300, 900);
    let_go(&scene, &nowhere);
    for (int w = 1; w < WAFERS; ++w) {
        scene.wafers[w].base_from_wafer = wh_test_at(700, 0, 900.25 + 10 * w);
        scene.events[w] = scene.events[0];
        scene.events[w].wafer = w;
    }
    scene.list.count = 2;
    wh_cell_settle(&cell, &scene.table, &scene.list);
    assert_int_equal(scene.list.count, 3);
    assert_near(scene.wafers[1].base_from_wafer.r.z, 910, 4096 * WH_TEST_ROUNDING);
    assert_near(scene.wafers[2].base_from_wafer.r.z, 920.25, 0);
    let_go(&scene, &nowhere);
    scene.wafers[2].base_from_wafer = wh_test_at(700, 0, 920.25);
    scene.events[1] = scene.events[0];
    scene.events[1].wafer = 2;
    wh_cell_settle(&cell, &scene.table, &scene.list);
    assert_int_equal(scene.list.count, 1);
    assert_near(scene.wafers[2].base_from_wafer.r.z, 920.25, 0);
    cell.settle = false;
}

/* The wafer settles even if there is no room for another report. A wafer that a gripper holds stays there. */
static void settling_without_room_or_while_held(void **state) {
    (void)state;
    scene_t scene;
    const wh_pose_t above = wh_test_at(700, 0, 900.25);
    cell.settle = true;
    let_go(&scene, &above);
    scene.list.capacity = 1;
    wh_cell_settle(&cell, &scene.table, &scene.list);
    assert_int_equal(scene.list.count, 1);
    assert_near(scene.wafers[0].base_from_wafer.r.z, 900, 4096 * WH_TEST_ROUNDING);
    let_go(&scene, &above);
    scene.wafers[0].holder = 0;
    wh_cell_settle(&cell, &scene.table, &scene.list);
    assert_int_equal(scene.list.count, 1);
    assert_near(scene.wafers[0].base_from_wafer.r.z, 900.25, 0);
    cell.settle = false;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_release_in_a_free_slot_is_fine, set_up),
        cmocka_unit_test_setup(only_releases_are_judged, set_up),
        cmocka_unit_test_setup(an_unsupported_wafer_and_what_is_below_it, set_up),
        cmocka_unit_test_setup(a_station_below_bases_origin_supports_too, set_up),
        cmocka_unit_test_setup(the_nearest_slot_below_supports, set_up),
        cmocka_unit_test_setup(a_leaning_wafer_is_above_what_is_below, set_up),
        cmocka_unit_test_setup(what_is_beyond_a_count_is_not_there, set_up),
        cmocka_unit_test_setup(two_releases_are_judged_in_turn, set_up),
        cmocka_unit_test_setup(an_occupied_slot_names_the_lowest_wafer, set_up),
        cmocka_unit_test_setup(a_neighbours_slot_is_not_this_one, set_up),
        cmocka_unit_test_setup(a_chucks_wafer_occupies_it_and_a_blades_does_not, set_up),
        cmocka_unit_test_setup(limits_of_placing, set_up),
        cmocka_unit_test_setup(a_chuck_that_takes_a_wafer_over_is_judged, set_up),
        cmocka_unit_test_setup(an_unsupported_wafer_may_be_off_centre_too, set_up),
        cmocka_unit_test_setup(a_wafer_let_go_in_the_air, set_up),
        cmocka_unit_test_setup(a_full_list_takes_no_more, set_up),
        cmocka_unit_test_setup(a_wafer_comes_to_lie_on_its_slot, set_up),
        cmocka_unit_test_setup(a_leaning_wafer_in_its_plane_comes_to_lie, set_up),
        cmocka_unit_test_setup(what_does_not_settle, set_up),
        cmocka_unit_test_setup(a_support_stops_what_was_let_go_below_it, set_up),
        cmocka_unit_test_setup(a_wafer_face_down_lies_on_its_front_and_settles_on_it, set_up),
        cmocka_unit_test_setup(each_release_settles_in_turn, set_up),
        cmocka_unit_test_setup(settling_without_room_or_while_held, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
