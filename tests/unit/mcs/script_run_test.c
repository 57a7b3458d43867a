/* The examples, run as the program runs them: the paper's results, to the last digit. */
#include "support/support.h"

#include <math.h>

#include "mcs/script_run.h"

static wh_script_run_t run;

static int close_run(void **state) {
    (void)state;
    wh_script_run_close(&run);
    return 0;
}

static wh_script_run_outcome_t play(const char *script) {
    const wh_script_run_options_t options = {.script = script, .limits = {.print_to = stderr}};
    return wh_script_run(&run, &options);
}

static const wh_wafer_record_t *wafer(const char *name) {
    const int32_t index = wh_layout_find_wafer(run.record.layout, name);
    assert_int_not_equal(index, WH_NONE);
    return &run.record.wafers[index];
}

static void assert_lies_in(const char *name, const char *station, int slot) {
    const wh_place_t *place = &wafer(name)->place;
    assert_int_not_equal(place->station, WH_NONE);
    assert_string_equal(run.record.layout->stations[place->station].name, station);
    assert_int_equal(place->slot, slot);
}

static const wh_event_t *event(wh_event_kind_t kind, size_t number) {
    for (size_t i = 0; i < run.record.event_count; ++i) {
        if (run.record.events[i].event.kind == kind && number-- == 0) {
            return &run.record.events[i].event;
        }
    }
    fail_msg("no such event");
    return NULL;
}

static size_t count_events(wh_event_kind_t kind) {
    size_t count = 0;
    for (size_t i = 0; i < run.record.event_count; ++i) {
        count += run.record.events[i].event.kind == kind ? 1 : 0;
    }
    return count;
}

static void transfer_run(void **state) {
    (void)state;
    assert_int_equal(play("lua/examples/01_transfer.lua"), WH_RUN_MET);
    assert_lies_in("Wafer 1", "B", 2);
    assert_near(wafer("Wafer 1")->place.dx, 0, 1e-9);
    assert_near(wafer("Wafer 1")->place.dy, 0, 1e-9);
    assert_near(wafer("Wafer 1")->place.tilt, 1.5 * acos(-1.0) / 180, 1e-12);
    assert_lies_in("Wafer 2", "B", 10);
    assert_near(wafer("Wafer 2")->place.dx, 13.794, 1e-9);
    assert_near(wafer("Wafer 2")->place.dy, 7.2385, 1e-9);
    assert_near(wafer("Wafer 2")->place.tilt, 0, 1e-12);
    assert_int_equal(run.record.command_count, 4);
    assert_int_equal(count_events(WH_EVENT_PICKED), 2);
    assert_int_equal(count_events(WH_EVENT_RELEASED), 2);
    assert_int_equal(run.record.event_count, 4);
    assert_near(event(WH_EVENT_PICKED, 0)->measured.n1_proj_n2, cos(1.5 * acos(-1.0) / 180), 1e-12);
}

static void prealigner_run(void **state) {
    (void)state;
    assert_int_equal(play("lua/examples/02_prealigner.lua"), WH_RUN_MET);
    assert_int_equal(count_events(WH_EVENT_HANDED_OVER), 3);
    assert_int_equal(count_events(WH_EVENT_CONTESTED), 0);
    assert_int_equal(count_events(WH_EVENT_NEAR_MISS), 0);
    for (size_t i = 0; i < 3; ++i) {
        const wh_proximity_t *p = &event(WH_EVENT_HANDED_OVER, i)->measured;
        assert_true(p->ready);
        assert_true(p->margin_projz > 0.2);
        assert_true(p->margin_projxy > 0);
        assert_true(p->margin_planar > 0);
    }
    const wh_wafer_record_t *wafer_2 = wafer("Wafer 2");
    assert_string_equal(run.record.layout->grippers[wafer_2->holder].name, "PA");
    const double x = wafer_2->base_from_wafer.r.x + 600;
    const double y = wafer_2->base_from_wafer.r.y;
    assert_near(sqrt(x * x + y * y), sqrt(13.794 * 13.794 + 7.2385 * 7.2385), 1e-9);
    assert_near(wafer_2->place.dx, -7.2385, 1e-9);
    assert_near(wafer_2->place.dy, 13.794, 1e-9);
}

static void missed_pick_run(void **state) {
    (void)state;
    assert_int_equal(play("lua/examples/03_missed_pick.lua"), WH_RUN_MET);
    assert_int_equal(run.record.commands[0].error, WH_STATUS_WAFER_MISSING);
    assert_non_null(
        strstr(run.record.commands[0].message, "|dr_proj_xy| 54.083 is not below 50 (by 4.083 mm)"));
    const wh_event_t *miss = event(WH_EVENT_NEAR_MISS, 0);
    assert_int_equal(miss->measured.failed, WH_FAILED_PROJXY);
    assert_near(miss->measured.dr_proj_xy_norm, sqrt(30.0 * 30.0 + 45.0 * 45.0), 1e-9);
    assert_int_equal(count_events(WH_EVENT_NEAR_MISS), 1);
}

/* The arm stands before the station when the map is known, and is still there after the refusals. */
static void cross_slotted_run(void **state) {
    (void)state;
    assert_int_equal(play("lua/examples/06_cross_slotted.lua"), WH_RUN_MET);
    assert_string_equal(run.record.commands[0].text, "MAP A");
    for (size_t c = 1; c <= 4; ++c) {
        assert_int_equal(run.record.commands[c].error, WH_STATUS_BAD_SLOT);
        assert_near(run.record.commands[c].end_s, run.record.commands[0].end_s, 0);
    }
    assert_int_equal(wafer("Crossed")->holder, WH_NONE);
    assert_near(wafer("Crossed")->base_from_wafer.r.z, 935, 0);
    assert_int_equal(count_events(WH_EVENT_PICKED), 2);
    assert_int_equal(run.record.event_count, 4);
}

static void same_script_gives_same_hash(void **state) {
    (void)state;
    assert_int_equal(play("lua/examples/01_transfer.lua"), WH_RUN_MET);
    const uint64_t hash = run.record.hash;
    wh_script_run_close(&run);
    assert_int_equal(play("lua/examples/01_transfer.lua"), WH_RUN_MET);
    assert_true(run.record.hash == hash);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(transfer_run, close_run),
        cmocka_unit_test_teardown(prealigner_run, close_run),
        cmocka_unit_test_teardown(missed_pick_run, close_run),
        cmocka_unit_test_teardown(cross_slotted_run, close_run),
        cmocka_unit_test_teardown(same_script_gives_same_hash, close_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
