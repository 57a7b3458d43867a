/* Centrings in a record: the values that scripts get, and texts that claim no more than is known. */
#include "support/support.h"

#include <unistd.h>

#include "mcs/script_run.h"
#include "record/centring_words.h"

static wh_script_run_t run;

static int close_run(void **state) {
    (void)state;
    wh_script_run_close(&run);
    return 0;
}

static void play(const char *script) {
    const wh_script_run_options_t options = {.script = script, .limits = {.print_to = stderr}};
    assert_int_not_equal(wh_script_run(&run, &options), WH_RUN_BAD_INPUT);
}

/* A script in a folder of its own; `%s` in it is the current folder. */
static void play_text(const char *text) {
    char folder[WH_TEST_PATH], path[WH_TEST_PATH + 50], here[4000];
    assert_non_null(mkdtemp(wh_test_path(folder, "centrings")));
    assert_non_null(getcwd(here, sizeof here));
    (void)snprintf(path, sizeof path, "%s/script.lua", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "cell '%s/lua/layouts/centring.lua'\n%s", here, text);
    assert_int_equal(fclose(file), 0);
    play(path);
    unlink(path);
    rmdir(folder);
}

static const char *words_of(size_t i, size_t line, bool *is_sure) {
    static wh_centring_words_t words;
    assert_true(i < run.record.centring_count);
    wh_centring_words(&run.record, &run.record.centrings[i], &words);
    *is_sure = words.is_sure;
    return words.lines[line];
}

/* --------------------------------------------------------------------------------------------------- values */

static const char *const told =
    "local function tell()\n"
    "  local c = centring()\n"
    "  local t = { c.error, c.used, c.missed, #c.crossings, #c.candidates, c.dx or 0, c.dy or 0, c.sd_dx or "
    "0, c.sd_dy or 0,\n"
    "    c.sd or 0, c.radius or 0 }\n"
    "  for _, k in ipairs(c.candidates) do t[#t + 1] = k.dx t[#t + 1] = k.dy t[#t + 1] = k.sd end\n"
    "  for _, k in ipairs(c.crossings) do t[#t + 1] = k.x t[#t + 1] = k.y t[#t + 1] = k.time t[#t + 1] = "
    "k.beam\n"
    "    t[#t + 1] = ({ rim = 0, notch = 1, other = 2 })[k.use] t[#t + 1] = k.edge == 'in' and 0 or 1 end\n"
    "  for i, value in ipairs(t) do t[i] = ('%.17g'):format(value) end\n"
    "  expect(true, table.concat(t, ' '))\n"
    "end\n";

/* The number behind the next place at which this text occurs. */
static double next(const char **text) {
    char *end = NULL;
    const double value = strtod(*text, &end);
    assert_ptr_not_equal(end, *text);
    *text = end;
    return value;
}

static void assert_told(const wh_centring_record_t *centring, const char *text) {
    const bool is_sure = centring->status == WH_OK;
    const wh_centring_offset_t offset = wh_centring_offset(centring, 0);
    const wh_centre_t *best = &centring->centres.candidates[0];
    assert_int_equal((int)next(&text), centring->status);
    assert_int_equal((int)next(&text), best->used);
    assert_int_equal((int)next(&text), centring->missed);
    assert_int_equal((int)next(&text), centring->count);
    assert_int_equal((int)next(&text), centring->centres.count);
    const double values[] = {offset.dx, offset.dy, offset.sd_dx, offset.sd_dy, best->sd_centre, best->radius};
    for (size_t i = 0; i < sizeof values / sizeof *values; ++i) {
        assert_near(next(&text), is_sure ? values[i] : 0, 1e-9);
    }
    for (int32_t i = 0; i < centring->centres.count; ++i) {
        const wh_centring_offset_t of = wh_centring_offset(centring, i);
        assert_near(next(&text), of.dx, 1e-9);
        assert_near(next(&text), of.dy, 1e-9);
        assert_near(next(&text), centring->centres.candidates[i].sd_centre, 0);
    }
    for (size_t k = 0; k < centring->count; ++k) {
        const wh_crossing_t *at = &centring->crossings[k].crossing;
        const wh_latch_order_t order = wh_layout_beams_at(run.record.layout, (size_t)centring->station);
        assert_near(next(&text), at->x, 0);
        assert_near(next(&text), at->y, 0);
        assert_near(next(&text), centring->crossings[k].time, 0);
        assert_int_equal((int)next(&text), at->beam - order.first + 1);
        assert_int_equal((int)next(&text), best->use[k]);
        assert_int_equal((int)next(&text), at->edge);
    }
    assert_string_equal(text, "");
}

/* Sure with four crossings and with three, into stations that lie differently, and not sure. */
static void a_record_has_what_scripts_are_told(void **state) {
    (void)state;
    char text[3000];
    (void)snprintf(text, sizeof text,
                   "%sget('A', 1) put('LL', 1) tell()\nget('A', 2) put('LL', 2) tell()\n"
                   "get('A', 3) pcall(put, 'OLD', 1) tell()\n",
                   told);
    play_text(text);
    const wh_record_t *record = &run.record;
    assert_int_equal(record->centring_count, 3);
    assert_int_equal(record->centrings_left_out, 0);
    static const wh_status_t statuses[] = {WH_OK, WH_OK, WH_STATUS_CENTRE_NOT_SURE};
    static const char *const commands[] = {"PUT LL 1", "PUT LL 2", "PUT OLD 1"};
    for (size_t i = 0; i < 3; ++i) {
        const wh_centring_record_t *centring = &record->centrings[i];
        assert_int_equal(centring->status, statuses[i]);
        assert_int_equal(centring->wafer, i);
        assert_string_equal(record->commands[centring->command].text, commands[i]);
        assert_false(centring->repeated || centring->skipped);
        assert_told(centring, record->expectations[i].text);
    }
    assert_near(wh_centring_residual(&record->centrings[1], 0, 0), -0.9, 0.1); /* in the notch */
    assert_string_equal(wh_centring_use(&record->centrings[1], 0, 0), "notch");
    assert_string_equal(wh_centring_use(&record->centrings[2], 0, 2), "notch");
    assert_string_equal(wh_centring_use(&record->centrings[2], 1, 2), "rim");
    assert_string_equal(wh_centring_use(&record->centrings[1], 1, 0), "none");
    assert_true(isnan(wh_centring_residual(&record->centrings[1], 1, 0)));
}

/* ---------------------------------------------------------------------------------------------------- words */

static void words_tell_the_verdict(void **state) {
    (void)state;
    play("lua/examples/13_centring.lua");
    bool sure = false;
    assert_string_equal(words_of(0, 0, &sure), "sure");
    assert_true(sure);
    assert_memory_equal(words_of(0, 1, &sure), "centre: dX 1.", strlen("centre: dX 1."));
    assert_string_equal(words_of(0, 2, &sure), "radius: 150.0000 mm, taken as exact");
    assert_non_null(strstr(words_of(1, 3, &sure), "used: 3 of the rim"));
    assert_non_null(strstr(words_of(1, 3, &sure), "left out: 1 for the notch, 0 as none of the rim"));
    assert_string_equal(words_of(1, 5, &sure), "command: PUT LL 2, done");
    assert_string_equal(words_of(2, 0, &sure),
                        "not sure: the centre is not told for sure (75 CENTRE_NOT_SURE)");
    assert_false(sure);
    assert_memory_equal(words_of(2, 1, &sure), "centre, not sure: dX 0.", strlen("centre, not sure: dX 0."));
    assert_non_null(strstr(words_of(2, 1, &sure), " mm or dX 0."));
    assert_string_equal(words_of(2, 5, &sure), "command: PUT OLD 1, failed with 75 CENTRE_NOT_SURE");
}

/* The estimate is sure, but motion control does not use it. */
static void a_wafer_that_is_too_far_off_is_not_called_sure(void **state) {
    (void)state;
    play_text("get('A', 1) pcall(put, 'LL', 1, { dx = -4.5 })\n");
    bool sure = true;
    assert_int_equal(run.record.centring_count, 1);
    assert_int_equal(run.record.centrings[0].status, WH_OK);
    assert_memory_equal(words_of(0, 0, &sure), "not to be used: ", strlen("not to be used: "));
    assert_non_null(strstr(words_of(0, 0, &sure), "(64 CORRECTION_TOO_LARGE)"));
    assert_false(sure);
}

/* A record from a log claims no more than the log contains. */
static void words_of_a_log_say_what_it_does_not_tell(void **state) {
    (void)state;
    play("lua/examples/13_centring.lua");
    bool sure = true;
    for (size_t i = 0; i < 3; ++i) {
        run.record.centrings[i].repeated = true;
        assert_non_null(strstr(words_of(i, 4, &sure), "a log does not tell if motion control knew"));
        assert_non_null(strstr(words_of(i, 5, &sure), "estimated again from the log's states"));
    }
    assert_memory_equal(words_of(0, 0, &sure), "not told: this log's states alone", 33);
    assert_false(sure);
    run.record.commands[run.record.centrings[0].command].error = WH_STATUS_CENTRE_NOT_SURE;
    assert_string_equal(words_of(0, 0, &sure), "not told: this log's states alone give 0 OK, but the command "
                                               "ended with 75 CENTRE_NOT_SURE");
    assert_false(sure);
    run.record.commands[run.record.centrings[2].command].error = WH_OK;
    assert_string_equal(words_of(2, 0, &sure),
                        "not told: this log's states alone give 75 CENTRE_NOT_SURE, but "
                        "the command was done: motion control knew more");
    assert_false(sure);
    run.record.centrings[1].lacking = 7;
    run.record.centrings[1].skipped = true;
    run.record.centrings[1].command = WH_NONE;
    assert_non_null(strstr(words_of(1, 3, &sure),
                           "; the simulator has missed slices of the pass; this log lacks 7 slices"));
    assert_string_equal(words_of(1, 5, &sure), "command: not told; estimated again from the log's states");
}

static void words_tell_what_was_known_before(void **state) {
    (void)state;
    play("lua/examples/13_centring.lua");
    bool sure = false;
    wh_centring_t *known = &run.record.centrings[0].known;
    known->notch_known = true;
    known->notch_direction = 0.5;
    known->sd_notch = 0.001;
    known->sd_radius = 0.05;
    assert_string_equal(
        words_of(0, 4, &sure),
        "notch: towards 28.6479\u00b0 on the blade, by ALIGN, standard deviation 0.0573\u00b0");
    assert_string_equal(words_of(0, 2, &sure),
                        "radius: 150.0000 mm found, 150.0000 mm expected with a standard "
                        "deviation of 50.0 \u00b5m");
    known->notch_width = 0;
    assert_string_equal(words_of(0, 4, &sure), "notch: by the layout wafers have none");
    run.record.centrings[0].centres.count = 0;
    assert_string_equal(words_of(0, 1, &sure), "centre: not told");
}

/* ---------------------------------------------------------------------------------------------------- passes */

/* A latch whose place is behind a gap has no crossing; then no centre is reported. */
static void latches_without_places_are_missed(void **state) {
    (void)state;
    play("lua/examples/13_centring.lua");
    const wh_layout_t *layout = run.record.layout;
    wh_pass_t pass = {.order = wh_layout_beams_at(layout, 0), .armed_seq = 10, .goes_on = true, .seq = 30};
    wh_pose_t place = wh_pose_identity();
    pass.station = layout->beams[0].station;
    pass.believed = wh_pass_station(layout, pass.station, 0);
    pass.order = wh_layout_beams_at(layout, (size_t)pass.station);
    for (int64_t seq = 10; seq < 30; ++seq) {
        if (seq != 20) {
            wh_pass_stand(&pass, seq, &place);
        }
    }
    assert_int_equal(pass.place_count, 10);
    pass.latches[0] = (wh_latch_t){pass.order.first, WH_CROSSING_IN, 5, 0.5};
    pass.latches[1] = (wh_latch_t){pass.order.first, WH_CROSSING_OUT, 15, 0.5};
    pass.latch_count = 2;
    const wh_centring_t known = wh_centring_known(layout, &pass.order, 150);
    wh_centring_record_t centring;
    wh_centring_estimate(&pass, layout, &known, &centring);
    assert_int_equal(centring.missed, 1);
    assert_int_equal(centring.count, 1);
    assert_int_equal(centring.status, WH_STATUS_TOO_FEW_SAMPLES);
    assert_int_equal(centring.centres.count, 0);
    assert_true(isnan(wh_centring_offset(&centring, 0).dx));
    assert_true(isnan(centring.slot_from_blade[0][0])); /* it has not moved */
    wh_pass_free(&pass);
}

static void passes_of_a_teaching_are_none(void **state) {
    (void)state;
    play("lua/examples/14_teach.lua");
    assert_int_equal(run.record.centring_count, 0);
}

static void more_than_a_record_keeps_are_counted(void **state) {
    (void)state;
    wh_record_t record = {0};
    const wh_centring_record_t centring = {.command = WH_NONE};
    for (size_t i = 0; i < WH_RECORD_CENTRINGS + 3; ++i) {
        wh_record_add_centring(&record, &centring);
    }
    assert_int_equal(record.centring_count, WH_RECORD_CENTRINGS);
    assert_int_equal(record.centrings_left_out, 3);
    wh_record_forget(&record);
    assert_int_equal(record.centring_count + record.centrings_left_out, 0);
    wh_record_free(&record);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(a_record_has_what_scripts_are_told, close_run),
        cmocka_unit_test_teardown(words_tell_the_verdict, close_run),
        cmocka_unit_test_teardown(a_wafer_that_is_too_far_off_is_not_called_sure, close_run),
        cmocka_unit_test_teardown(words_of_a_log_say_what_it_does_not_tell, close_run),
        cmocka_unit_test_teardown(words_tell_what_was_known_before, close_run),
        cmocka_unit_test_teardown(latches_without_places_are_missed, close_run),
        cmocka_unit_test_teardown(passes_of_a_teaching_are_none, close_run),
        cmocka_unit_test(more_than_a_record_keeps_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
