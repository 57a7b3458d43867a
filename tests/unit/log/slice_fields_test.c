/* A slice as a row of numbers with names; and the slices that two recordings have in common. */
#include "log/compare.h"

#include "support/layout.h"

static const char cell[] =
    "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, "
    "stations = { A = { at = { 700, 0, 900 }, slots = 2 }, P = { kind = 'prealigner', at = { -600, 0, 950 } "
    "} }, "
    "wafers = { { name = 'W1', station = 'A', slot = 1 }, { name = 'W2', station = 'A', slot = 2%s } }";

static const wh_layout_t *read_cell(const char *more) {
    char fields[600];
    (void)snprintf(fields, sizeof fields, cell, more);
    return read_sound(fields);
}

static void names_stand_in_their_order(void **state) {
    (void)state;
    static const char *const names[] = {"axis theta rad",
                                        "axis R mm",
                                        "axis Z mm",
                                        "axis yaw rad",
                                        "axis PA chuck rad",
                                        "EE valve",
                                        "EE sensor",
                                        "EE vacuum",
                                        "EE nearest",
                                        "EE dr_proj_z mm",
                                        "EE dr_proj_xy mm",
                                        "EE n1_proj_n2",
                                        "PA valve",
                                        "PA sensor",
                                        "PA vacuum",
                                        "PA nearest",
                                        "PA dr_proj_z mm",
                                        "PA dr_proj_xy mm",
                                        "PA n1_proj_n2",
                                        "W1 holder",
                                        "W1 x mm",
                                        "W1 y mm",
                                        "W1 z mm",
                                        "W1 qx",
                                        "W1 qy",
                                        "W1 qz",
                                        "W1 qw",
                                        "W1 face down",
                                        "W1 held dx mm",
                                        "W1 held dy mm",
                                        "W1 held turn deg",
                                        "W1 held by front",
                                        "W2 holder",
                                        "W2 x mm",
                                        "W2 y mm",
                                        "W2 z mm",
                                        "W2 qx",
                                        "W2 qy",
                                        "W2 qz",
                                        "W2 qw",
                                        "W2 face down",
                                        "W2 held dx mm",
                                        "W2 held dy mm",
                                        "W2 held turn deg",
                                        "W2 held by front"};
    const wh_layout_t *layout = read_cell(", face = 'down'");
    assert_int_equal(wh_slice_field_count(layout), sizeof names / sizeof names[0]);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        char name[WH_SLICE_FIELD_NAME];
        const wh_slice_field_t kind = wh_slice_field_name(layout, i, name);
        assert_string_equal(name, names[i]);
        assert_int_equal(kind, strstr(name, "nearest")  ? WH_FIELD_WAFER
                               : strstr(name, "holder") ? WH_FIELD_GRIPPER
                                                        : WH_FIELD_NUMBER);
    }
    assert_int_equal(wh_slice_field_count(read_cell("")), sizeof names / sizeof names[0] - 10);
}

static void indices_have_words(void **state) {
    (void)state;
    const wh_layout_t *layout = read_cell("");
    assert_null(wh_slice_field_word(layout, WH_FIELD_NUMBER, 1));
    assert_string_equal(wh_slice_field_word(layout, WH_FIELD_WAFER, 0), "W1");
    assert_string_equal(wh_slice_field_word(layout, WH_FIELD_WAFER, 1), "W2");
    assert_string_equal(wh_slice_field_word(layout, WH_FIELD_WAFER, 2), "");
    assert_string_equal(wh_slice_field_word(layout, WH_FIELD_WAFER, -1), "");
    assert_string_equal(wh_slice_field_word(layout, WH_FIELD_GRIPPER, 1), "PA");
    assert_string_equal(wh_slice_field_word(layout, WH_FIELD_GRIPPER, 2), "");
    assert_string_equal(wh_slice_field_word(layout, WH_FIELD_WAFER, (double)NAN), "");
}

/* EE 3 mm below W1 and 4 mm beside it; PA far away from all; W2 held by PA and turned by 90 degrees. */
static void values_are_the_slice_s(void **state) {
    (void)state;
    const wh_layout_t *layout = read_cell("");
    static wh_physics_state_t physics;
    wh_wafer_t wafers[2] = {{.base_from_wafer = wh_pose_identity(), .holder = WH_NONE},
                            {.base_from_wafer = wh_pose_identity(), .holder = 1}};
    wh_gripper_t grippers[2] = {{.base_from_gripper = wh_pose_identity(), .wafer = WH_NONE},
                                {.base_from_gripper = wh_pose_identity(), .wafer = WH_NONE}};
    const wh_mat3_t turned = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
    wafers[0].base_from_wafer.r = wh_vec3(700, 0, 900);
    wafers[1].base_from_wafer.r = wh_vec3(1, 2, 3);
    wafers[1].base_from_wafer.R = turned;
    grippers[0].base_from_gripper.r = wh_vec3(704, 0, 897);
    grippers[1].base_from_gripper.r = wh_vec3(-600, 0, 950);
    physics.told[0] = WH_VALVE_OPEN;
    physics.told[1] = WH_VALVE_CLOSED;
    physics.vacuum[0].level = 0.5;
    physics.vacuum[1].level = 0.25;
    const wh_state_t slice = {.seq = 7,
                              .physics = &physics,
                              .sensors = 2,
                              .wafers = wafers,
                              .wafer_count = 2,
                              .grippers = grippers,
                              .gripper_count = 2};
    const double axes[] = {0.1, 400, 900, 0.2, 0.3}, none = (double)NAN, half = sqrt(0.5);
    const double wanted[] = {0.1,  400, 900, 0.2, 0.3, 0, 0, 0.5, 0, 3, 4, 1, 1, 1, 0.25, -1,   none, none,
                             none, -1,  700, 0,   900, 0, 0, 0,   1, 1, 1, 2, 3, 0, 0,    half, half};
    double values[sizeof wanted / sizeof wanted[0] + 1];
    values[sizeof wanted / sizeof wanted[0]] = 99;
    for (int has_axes = 0; has_axes < 2; ++has_axes) {
        wh_slice_fields(layout, has_axes ? axes : NULL, &slice, values);
        for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; ++i) {
            const bool is_none = isnan(wanted[i]) || (!has_axes && i < 5);
            assert_true(is_none ? (bool)isnan(values[i]) : fabs(values[i] - wanted[i]) < 1e-12);
        }
        assert_true(values[sizeof wanted / sizeof wanted[0]] == 99);
    }
}

static double value_of(const wh_layout_t *layout, const wh_state_t *slice, const char *wanted) {
    double values[80];
    size_t found = sizeof values / sizeof values[0];
    wh_slice_fields(layout, NULL, slice, values);
    for (size_t i = 0; i < wh_slice_field_count(layout); ++i) {
        char name[WH_SLICE_FIELD_NAME];
        (void)wh_slice_field_name(layout, i, name);
        found = strcmp(name, wanted) == 0 ? i : found;
    }
    assert_true(found < sizeof values / sizeof values[0]);
    return values[found];
}

/* EE is turned by 90 degrees and looks up at the front of W1, whose x is turned by 30 degrees more.
 * Seen from below its y points the other way. W2 lies. */
static void how_a_wafer_is_held(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        "grippers = { { name = 'EE', grip = 'edge' } }, stations = { A = { at = { 700, 0, 900 }, slots = 2 } "
        "}, "
        "wafers = { { name = 'W1', station = 'A', slot = 1, face = 'down' }, { name = 'W2', station = 'A', "
        "slot = 2 } }");
    static wh_physics_state_t physics;
    const wh_pose_t held = {{{{sqrt(0.75), 0.5, 0}, {0.5, -sqrt(0.75), 0}, {0, 0, -1}}}, {0.25, -1.5, 0.775}};
    wh_gripper_t grippers[1] = {
        {.base_from_gripper = {{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, {10, 20, 30}}, .wafer = 0}};
    wh_wafer_t wafers[2] = {
        {.base_from_wafer = wh_pose_compose(&grippers[0].base_from_gripper, &held), .holder = 0},
        {.base_from_wafer = wh_pose_identity(), .holder = WH_NONE}};
    physics.grips[0].s = -3.25;
    const wh_state_t slice = {
        .physics = &physics, .wafers = wafers, .wafer_count = 2, .grippers = grippers, .gripper_count = 1};
    assert_near(value_of(layout, &slice, "EE plunger mm"), -3.25, 0);
    assert_near(value_of(layout, &slice, "W1 held dx mm"), 0.25, 1e-12);
    assert_near(value_of(layout, &slice, "W1 held dy mm"), -1.5, 1e-12);
    assert_near(value_of(layout, &slice, "W1 held turn deg"), 30, 1e-12);
    assert_near(value_of(layout, &slice, "W1 held by front"), 1, 0);
    assert_near(value_of(layout, &slice, "W1 face down"), 1, 0);
    assert_true(isnan(value_of(layout, &slice, "W2 held dx mm")));
    assert_true(isnan(value_of(layout, &slice, "W2 held by front")));
    assert_near(value_of(layout, &slice, "W2 face down"), 0, 0);
}

/* ---------------------------------------------------------------------------------------------- two lists */

static wh_compare_t compare(struct wh_log_digest *one, size_t one_count, struct wh_log_digest *other,
                            size_t other_count) {
    static wh_log_run_t runs[2];
    wh_compare_t found;
    const wh_layout_t *layout = read_cell("");
    wh_log_run_t *const both[] = {&runs[0], &runs[1]};
    const wh_log_digests_t digests[] = {{one, one_count, one_count, {.values = NULL}},
                                        {other, other_count, other_count, {.values = NULL}}};
    runs[0].cell.layout = runs[1].cell.layout = layout;
    assert_true(wh_compare_runs(both, digests, &found));
    return found;
}

static void equal_lists_do_not_differ(void **state) {
    (void)state;
    struct wh_log_digest slices[] = {{1, 10}, {2, 20}, {5, 50}};
    const wh_compare_t found = compare(slices, 3, slices, 3);
    assert_true(found.common == 3 && found.differing == 0 && found.only[0] == 0 && found.only[1] == 0 &&
                found.slice == 0);
    assert_string_equal(found.field, "");
    assert_true(found.time_s == 0);
}

static void slices_that_one_alone_has(void **state) {
    (void)state;
    struct wh_log_digest one[] = {{1, 10}, {2, 20}, {4, 40}, {5, 51}},
                         other[] = {{1, 10}, {3, 30}, {4, 40}, {5, 50}, {6, 60}, {7, 70}};
    wh_compare_t found = compare(one, 4, other, 6);
    assert_true(found.common == 3 && found.differing == 1 && found.only[0] == 1 && found.only[1] == 3);
    assert_int_equal(found.slice, 2);
    assert_near(found.time_s, 0.002, 1e-15);
    assert_string_equal(found.field, "slice");
    assert_string_equal(found.values[0], "there");
    assert_string_equal(found.values[1], "not there");
    found = compare(other, 6, one, 4);
    assert_true(found.only[0] == 3 && found.only[1] == 1 && found.slice == 2);
    assert_string_equal(found.values[0], "not there");
    assert_string_equal(found.values[1], "there");
    found = compare(one, 0, other, 2);
    assert_true(found.common == 0 && found.only[1] == 2 && found.slice == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_stand_in_their_order), cmocka_unit_test(indices_have_words),
        cmocka_unit_test(values_are_the_slice_s),     cmocka_unit_test(how_a_wafer_is_held),
        cmocka_unit_test(equal_lists_do_not_differ),  cmocka_unit_test(slices_that_one_alone_has),
    };
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
