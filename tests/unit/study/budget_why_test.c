/* Why a run of a budget failed: all conditions of the miss that ended it, and none of a miss that did not. */
#include "support/support.h"

#include "study/budget_player.h"

static wh_layout_t layout;
static wh_command_record_t command;
static wh_event_record_t events[2];
static wh_record_t record;

static int set_up(void **state) {
    (void)state;
    static char text[] = "GET A 1", failure[] = "failed";
    memset(&layout, 0, sizeof layout);
    memset(events, 0, sizeof events);
    memset(&record, 0, sizeof record);
    layout.grasp.tolerance = wh_tolerance_paper();
    command = (wh_command_record_t){.line = 4, .text = text, .error = WH_STATUS_WAFER_MISSING};
    record.layout = &layout;
    record.commands = &command;
    record.command_count = 1;
    record.events = events;
    record.failure = failure;
    return 0;
}

/* A wafer that lies so far aside and so high, seen from a gripper in the middle. */
static void add_miss(double aside, double high) {
    const wh_pose_t gripper = wh_pose_identity();
    wh_pose_t wafer = wh_pose_identity();
    wh_event_t *event = &events[record.event_count++].event;
    wafer.r = wh_vec3(aside, 0, high);
    event->kind = WH_EVENT_NEAR_MISS;
    assert_int_equal(wh_proximity_measure(&wafer, &gripper, &layout.grasp.tolerance, &event->measured),
                     WH_OK);
}

static void assert_why(const char *name, const char *text) {
    wh_budget_why_t why;
    wh_budget_explain(&record, "", &why);
    assert_string_equal(why.name, name);
    assert_string_equal(why.text, text);
    assert_int_equal(why.line, 4);
}

static void one_condition_is_named(void **state) {
    (void)state;
    add_miss(60, 0);
    assert_why("WAFER_MISSING", "|dr_proj_xy| 60.000 is not below 50 (by 10.000 mm)");
}

static void two_conditions_are_both_named(void **state) {
    (void)state;
    add_miss(0, 0.6);
    add_miss(60, 0.75);
    assert_why("WAFER_MISSING",
               "|dr_proj_z| 0.750 is not below 0.5 (by 0.250 mm) and |dr_proj_xy| 60.000 is not below "
               "50 (by 10.000 mm)");
}

static void another_error_has_another_reason(void **state) {
    (void)state;
    add_miss(60, 0);
    command.error = WH_STATUS_OUT_OF_REACH;
    assert_why("OUT_OF_REACH", wh_record_error_text(WH_STATUS_OUT_OF_REACH));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(one_condition_is_named, set_up),
        cmocka_unit_test_setup(two_conditions_are_both_named, set_up),
        cmocka_unit_test_setup(another_error_has_another_reason, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
