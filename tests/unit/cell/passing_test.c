/* Held wafers that go through slots, against a plain model of planes. */
#include <math.h>

#include "support/station.h"

enum { WAFERS = 2, GRIPPERS = 3, EVENTS = GRIPPERS * WH_EVENTS_PER_GRIPPER };

static struct {
    wh_grasp_t table;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    wh_gripper_input_t inputs[GRIPPERS];
    wh_event_t events[EVENTS];
    wh_event_list_t list;
    wh_passing_t passing[GRIPPERS];
} scene;

/* The grippers whose empty blades are looked at. */
static uint32_t shut;

/* Gripper 0 holds wafer 0, whose centre is there. */
static void hold(const wh_pose_t *at) {
    memset(&scene, 0, sizeof scene);
    scene.wafers[0].base_from_wafer = *at;
    scene.wafers[1].base_from_wafer = wh_test_at(0, 5000, 0);
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {scene.wafers, WAFERS, scene.grippers, GRIPPERS, NULL, 0};
    assert_int_equal(wh_grasp_init(&scene.table, &config, &storage), WH_OK);
    for (int g = 0; g < GRIPPERS; ++g) {
        scene.inputs[g] =
            (wh_gripper_input_t){.base_from_gripper = wh_test_at(0, 9000, 0), .valve = WH_VALVE_CLOSED};
    }
    scene.inputs[0] = (wh_gripper_input_t){.base_from_gripper = *at, .valve = WH_VALVE_OPEN};
    scene.list = (wh_event_list_t){scene.events, EVENTS, 0};
    assert_int_equal(wh_grasp_step(&scene.table, scene.inputs, &scene.list), WH_OK);
    assert_int_equal(scene.grippers[0].wafer, 0);
}

/* The gripper goes there in one slice; returns how many wafers it pushed through. */
static size_t go(const wh_pose_t *to, int32_t valve) {
    scene.inputs[0].base_from_gripper = *to;
    scene.inputs[0].valve = valve;
    const bool passes = wh_cell_begin_passing(&cell, &scene.table, scene.inputs, shut, scene.passing);
    assert_int_equal(wh_grasp_step(&scene.table, scene.inputs, &scene.list), WH_OK);
    const size_t before = scene.list.count;
    if (passes) {
        wh_cell_end_passing(&cell, &scene.table, scene.passing, &scene.list);
    }
    return scene.list.count - before;
}

static wh_pose_t over_slot(int slot, double dx, double dz) {
    wh_pose_t pose = wh_station_slot(&stations[0], slot);
    pose.r.x += (wh_real_t)dx;
    pose.r.z += (wh_real_t)dz;
    return pose;
}

static void a_wafer_is_pushed_through_once(void **state) {
    (void)state;
    const wh_pose_t above = over_slot(2, 0, 3);
    size_t told = 0;
    hold(&above);
    for (int slice = 1; slice <= 60; ++slice) {
        const wh_pose_t to = over_slot(2, 0, 3 - 0.1 * slice);
        const size_t pushed = go(&to, WH_VALVE_OPEN);
        told += pushed;
        if (pushed > 0) {
            const wh_event_t *said = &scene.events[scene.list.count - 1];
            assert_int_equal(said->kind, WH_EVENT_PUSHED_THROUGH);
            assert_int_equal(said->wafer, 0);
            assert_int_equal(said->gripper, 0);
            assert_int_equal(said->slice, scene.table.slice);
            assert_near(said->limit, 0.5, 0);
            assert_true(said->value > said->limit && said->value < 0.6 + 1e-3);
        }
    }
    assert_int_equal(told, 1);
}

/* The slice in which the valve closes counts, and so does a jump of any size. */
static void a_release_and_a_jump_count(void **state) {
    (void)state;
    const wh_pose_t above = over_slot(1, 0, 0.1), below = over_slot(1, 0, -0.7),
                    floor = over_slot(1, 0, -300);
    hold(&above);
    assert_int_equal(go(&below, WH_VALVE_CLOSED), 1);
    hold(&above);
    assert_int_equal(go(&floor, WH_VALVE_OPEN), 1);
}

static void what_passes_nothing(void **state) {
    (void)state;
    const wh_pose_t above = over_slot(1, 0, 0.1), within = over_slot(1, 0, -0.4),
                    aside = over_slot(1, 51, 0.1), below = over_slot(1, 51, -3), under = over_slot(1, 0, -3);
    hold(&above); /* less than projz below, there a support stops it */
    assert_int_equal(go(&within, WH_VALVE_OPEN), 0);
    hold(&aside); /* beside the slot */
    assert_int_equal(go(&below, WH_VALVE_OPEN), 0);
    hold(&below); /* sideways */
    assert_int_equal(go(&under, WH_VALVE_OPEN), 0);
    hold(&above); /* its own chuck */
    stations[0].chuck = 0;
    assert_int_equal(go(&under, WH_VALVE_OPEN), 0);
    stations[0].chuck = 1; /* another's */
    hold(&above);
    assert_int_equal(go(&under, WH_VALVE_OPEN), 1);
    stations[0].chuck = WH_NONE;
}

/* Up through the ledges of the slot above, once; not in its own slot, nor beside it, nor on its own chuck. */
static void a_wafer_is_pushed_up_through_a_slot(void **state) {
    (void)state;
    const wh_pose_t own = over_slot(1, 0, 0);
    size_t told = 0;
    hold(&own);
    for (int slice = 1; slice <= 200; ++slice) {
        const wh_pose_t to = over_slot(1, 0, 0.1 * slice);
        const size_t pushed = go(&to, WH_VALVE_OPEN);
        told += pushed;
        if (pushed > 0) {
            const wh_event_t *said = &scene.events[scene.list.count - 1];
            assert_int_equal(said->kind, WH_EVENT_PUSHED_THROUGH);
            assert_near(said->limit, 1, 0);
            assert_true(said->value <= said->limit && said->value > 0.8);
        }
    }
    assert_int_equal(told, (size_t)(20 / stations[0].pitch));
    const wh_pose_t under = over_slot(1, 0, -3), aside = over_slot(1, 51, -3), over = over_slot(1, 51, 1);
    hold(&under);
    assert_int_equal(go(&own, WH_VALVE_OPEN), 1);
    hold(&aside);
    assert_int_equal(go(&over, WH_VALVE_OPEN), 0);
    stations[0].chuck = 0;
    hold(&under);
    assert_int_equal(go(&own, WH_VALVE_OPEN), 0);
    stations[0].chuck = WH_NONE;
}

/* A slice with a long way aside is judged where the wafer passes the plane, not where it ends. */
static void a_slanting_way_is_judged_at_the_plane(void **state) {
    (void)state;
    const wh_pose_t above = over_slot(1, 0, 1), far = over_slot(1, 80, -9), near = over_slot(1, 0, -1),
                    aside = over_slot(1, 120, 0);
    hold(&above); /* over the slot at the plane, beside it at the end */
    assert_int_equal(go(&far, WH_VALVE_OPEN), 1);
    hold(&aside); /* beside it at the plane, over it at the end */
    assert_int_equal(go(&near, WH_VALVE_OPEN), 0);
}

static void numbers_that_are_none_pass_nothing(void **state) {
    (void)state;
    const wh_pose_t above = over_slot(1, 0, 0.1);
    wh_passing_t passing = {7, 8, 9, false, 6};
    for (int axis = 0; axis < 3; ++axis) {
        wh_pose_t bad = over_slot(1, 0, -3);
        (&bad.r.x)[axis] = (wh_real_t)NAN;
        assert_false(wh_cell_passes(&cell, 0, &above, &bad, &passing));
        assert_false(wh_cell_passes(&cell, 0, &bad, &above, &passing));
    }
    assert_int_equal(passing.station, 8);
}

/* A wafer face down lies on its front: at height 0 its frame is a thickness above. */
static void a_wafer_face_down(void **state) {
    (void)state;
    wh_passing_t passing = {WH_NONE, WH_NONE, WH_NONE, false, WH_NONE};
    cell.thickness = WH_REAL(0.775);
    wh_pose_t above = over_slot(1, 0, 0.775), next = over_slot(1, 0, 0.775 - 0.51);
    above.R = next.R = wh_mat3_from_rpy_deg(180, 0, 0);
    assert_true(wh_cell_passes(&cell, 0, &above, &next, &passing));
    assert_int_equal(passing.slot, 1);
    next = over_slot(1, 0, 0.775 - 0.49);
    next.R = above.R;
    assert_false(wh_cell_passes(&cell, 0, &above, &next, &passing));
    cell.thickness = 0;
}

/* A number that float has, too, and no plane. */
static double height_below(double most) {
    return floor(wh_test_uniform(-1, 1) * most * 64) / 64;
}

/* The first slot through whose plane, or on the way up through the lower end of what stops it, the wafer goes; 0:
 * none. */
static int32_t first_passed(wh_real_t from, wh_real_t to) {
    for (int32_t slot = 1; slot <= stations[0].slots; ++slot) {
        const wh_real_t plane = wh_station_slot(&stations[0], slot).r.z - cell.tolerance.projz;
        const wh_real_t rising = plane - cell.tolerance.projz;
        if ((from >= plane && to < plane) || (from < rising && to >= rising)) {
            return slot;
        }
    }
    return 0;
}

/* A way in random steps passes as many planes as a list of them says, wherever its slices end. */
static void random_ways_pass_what_a_list_of_planes_says(void **state) {
    (void)state;
    for (int round = 0; round < 2000; ++round) {
        double height = 30.0078125 + height_below(50);
        wh_pose_t at = over_slot(1, 0, height);
        wh_passing_t passing = {WH_NONE, WH_NONE, WH_NONE, false, WH_NONE};
        for (int slice = 0; slice < 20; ++slice) {
            height += height_below(4) - 0.25;
            const wh_pose_t next = over_slot(1, 0, height);
            const bool goes_up = next.r.z > at.r.z;
            const int32_t first = first_passed(at.r.z, next.r.z);
            assert_int_equal(wh_cell_passes(&cell, 0, &at, &next, &passing), first > 0);
            assert_true(first == 0 || (passing.slot == first && passing.goes_up == goes_up));
            at = next;
        }
    }
}

/* -------------------------------------------------------------------------------------------------- wafers */

/* Gripper 0 goes from here to there in steps of 0.1 mm; how often it is told to go through wafer 1. */
static int go_straight(double from, double to) {
    const int steps = (int)(fabs(to - from) * 10 + 0.5);
    int told = 0;
    for (int i = 1; i <= steps; ++i) {
        const wh_pose_t next = over_slot(1, 0, from + (to - from) * i / steps);
        const size_t pushed = go(&next, scene.inputs[0].valve);
        for (size_t e = scene.list.count - pushed; e < scene.list.count; ++e) {
            assert_int_equal(scene.events[e].kind, WH_EVENT_PUSHED_THROUGH);
            assert_int_equal(scene.events[e].wafer, scene.grippers[0].wafer);
            assert_int_equal(scene.events[e].gripper, 0);
            told += scene.events[e].other == 1;
        }
    }
    return told;
}

/* Gripper 0 holds wafer 0 at this height over slot 1, where wafer 1 lies so far aside at another height. */
static void hold_beside(double height, double dx, double dz) {
    const wh_pose_t at = over_slot(1, 0, height);
    hold(&at);
    scene.wafers[1].base_from_wafer = over_slot(1, dx, dz);
    wh_grasp_place(&scene.table, 1, &scene.wafers[1].base_from_wafer);
}

static void the_lower_wafer_of_a_double_goes_through_the_upper_one(void **state) {
    (void)state;
    hold_beside(0, 3, 0.8);
    assert_int_equal(go_straight(0, 3), 1);
    hold_beside(3, 3, 0); /* and down again, onto one and through it */
    assert_int_equal(go_straight(3, 0), 0);
    assert_int_equal(go_straight(0, -0.4), 0);
    assert_int_equal(go_straight(-0.4, -3), 1);
}

static void a_wafer_beside_or_above_is_not_met(void **state) {
    (void)state;
    hold_beside(0, 51, 0.8);
    assert_int_equal(go_straight(0, 3), 0);
    hold_beside(0, 0, 4);
    assert_int_equal(go_straight(0, 3), 0);
    hold_beside(0, 0, 0.8); /* sideways */
    wh_pose_t aside = over_slot(1, 60, 0);
    assert_int_equal(go(&aside, WH_VALVE_OPEN), 0);
}

/* With a tolerance of 2 mm, too, a wafer whose centre is within 25 mm is met. */
static void a_narrow_tolerance_changes_nothing(void **state) {
    (void)state;
    cell.tolerance.projxy = 2;
    hold_beside(0, 24, 0.8);
    assert_int_equal(go_straight(0, 3), 1);
    hold_beside(0, 26, 0.8);
    assert_int_equal(go_straight(0, 3), 0);
}

/* Only a blade that is to take nothing is looked at: one with an open valve takes the wafer, or misses it. */
static void an_empty_blade_goes_through_a_wafer(void **state) {
    (void)state;
    for (uint32_t told = 0; told < 2; ++told) {
        const wh_pose_t start = over_slot(1, 0, -40), below = over_slot(1, 0, -3);
        hold(&start);
        (void)go(&start, WH_VALVE_CLOSED);
        wh_pose_t away = wh_test_at(0, 5000, 50);
        wh_grasp_place(&scene.table, 0, &away);
        (void)go(&below, WH_VALVE_CLOSED);
        wh_pose_t there = over_slot(1, 0, 0);
        wh_grasp_place(&scene.table, 1, &there);
        shut = told;
        assert_int_equal(go_straight(-3, 3), told);
        assert_int_equal(go_straight(3, -3), 0); /* nothing lies on a blade that comes down */
        shut = 0;
    }
}

/* A wafer that another gripper carries along is not met, and one that it holds still is. */
static void a_wafer_that_is_held_is_met(void **state) {
    (void)state;
    for (int still = 0; still < 2; ++still) {
        hold_beside(0, 3, 0.8);
        scene.inputs[2] =
            (wh_gripper_input_t){.base_from_gripper = over_slot(1, 3, 0.8), .valve = WH_VALVE_OPEN};
        (void)go(&scene.inputs[0].base_from_gripper, WH_VALVE_OPEN);
        assert_int_equal(scene.grippers[2].wafer, 1);
        int told = 0;
        for (int i = 1; i <= 30; ++i) {
            const wh_pose_t next = over_slot(1, 0, 0.1 * i);
            scene.inputs[2].base_from_gripper = over_slot(1, 3, 0.8 + (still ? 0 : 0.1 * i));
            told += (int)go(&next, WH_VALVE_OPEN);
        }
        assert_int_equal(told, still);
    }
}

/* From beside a wafer straight up to the end of the range of numbers: the height has no number. */
static void a_height_without_a_number_is_not_told(void **state) {
    (void)state;
    wh_pose_t to = wh_test_at(WH_REAL_LARGEST, WH_REAL_LARGEST, WH_REAL_LARGEST);
    to.R = wh_test_rotation(1, -1, 0, 0.9);
    hold_beside(0, 3, 0.8);
    scene.wafers[1].base_from_wafer.R = to.R;
    wh_grasp_place(&scene.table, 1, &scene.wafers[1].base_from_wafer);
    (void)go(&to, WH_VALVE_OPEN);
    stations[0].base_from_station.R = to.R;
    const wh_pose_t below = over_slot(1, 0, -3);
    to.r = wh_vec3_scale(-WH_REAL_LARGEST, &(wh_vec3_t){0, 0, 1});
    hold(&below);
    (void)go(&to, WH_VALVE_OPEN);
    for (size_t i = 0; i < scene.list.count; ++i) {
        assert_true(wh_real_is_finite(scene.events[i].value));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(the_lower_wafer_of_a_double_goes_through_the_upper_one, set_up),
        cmocka_unit_test_setup(a_wafer_beside_or_above_is_not_met, set_up),
        cmocka_unit_test_setup(a_narrow_tolerance_changes_nothing, set_up),
        cmocka_unit_test_setup(an_empty_blade_goes_through_a_wafer, set_up),
        cmocka_unit_test_setup(a_wafer_that_is_held_is_met, set_up),
        cmocka_unit_test_setup(a_height_without_a_number_is_not_told, set_up),
        cmocka_unit_test_setup(a_wafer_is_pushed_through_once, set_up),
        cmocka_unit_test_setup(a_release_and_a_jump_count, set_up),
        cmocka_unit_test_setup(what_passes_nothing, set_up),
        cmocka_unit_test_setup(a_wafer_is_pushed_up_through_a_slot, set_up),
        cmocka_unit_test_setup(a_slanting_way_is_judged_at_the_plane, set_up),
        cmocka_unit_test_setup(numbers_that_are_none_pass_nothing, set_up),
        cmocka_unit_test_setup(a_wafer_face_down, set_up),
        cmocka_unit_test_setup(random_ways_pass_what_a_list_of_planes_says, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
