/* Wafers per hour by the rules of record/throughput.h, steady cycles by those of record/steady.h,
 * and a whole run's figures compared with times computed by hand. */
#include "support/support.h"

#include <jansson.h>
#include <locale.h>
#include <string.h>

#include "mcs/script_run.h"
#include "print/record_print.h"
#include "record/steady.h"
#include "support/record.h"

/* -------------------------------------------------------------------------------------------------- rules */

static fixture_t f;
static wh_put_record_t made_puts[16];
static wh_cycle_record_t made_cycles[8];

/* A and B have 25 slots, P is a prealigner; slices of 1 ms. */
static void begin(int64_t slices) {
    fixture_begin(&f);
    f.places[FIXTURE_A].slots = f.places[FIXTURE_B].slots = 25;
    f.places[FIXTURE_P].slots = 1;
    f.stations[FIXTURE_P].prealigner = true;
    f.stations[FIXTURE_A].counts = f.stations[FIXTURE_B].counts = true;
    f.record.slices = slices;
    f.record.puts = made_puts;
    f.record.cycles = made_cycles;
}

static void add_put(int64_t slice, int32_t wafer, int32_t station, int32_t slot) {
    const wh_put_record_t put = {wafer, station, slot, slice};
    made_puts[f.record.put_count++] = put;
}

static void add_cycle(int64_t slice) {
    static char unnamed[] = "";
    const wh_cycle_record_t cycle = {1, unnamed, slice};
    made_cycles[f.record.cycle_count++] = cycle;
}

static void assert_throughput(wh_figure_t figure, size_t wafers, double seconds, size_t first, size_t last) {
    const wh_throughput_t found = wh_throughput(&f.record);
    assert_int_equal(found.figure, figure);
    assert_int_equal(wh_throughput_reason(figure) == NULL, figure == WH_FIGURE_GIVEN);
    assert_int_equal(found.puts, f.record.put_count);
    assert_int_equal(found.wafers, wafers);
    assert_true(found.seconds == seconds);
    assert_int_equal(found.first, first);
    assert_int_equal(found.last, last);
    assert_near(found.wafers_per_hour, figure == WH_FIGURE_GIVEN ? 3600 * (double)wafers / seconds : 0,
                1e-12);
}

static void a_record_of_nothing(void **state) {
    (void)state;
    fixture_empty(&f);
    assert_throughput(WH_FIGURE_NO_CELL, 0, 0, 0, 0);
    begin(0);
    assert_throughput(WH_FIGURE_NO_TIME, 0, 0, 0, 0);
    assert_true(wh_throughput(&f.record).wafers_per_hour == 0);
}

static void without_marks_every_put_counts(void **state) {
    (void)state;
    begin(9000);
    add_put(2000, 0, FIXTURE_B, 1);
    add_put(4000, 1, FIXTURE_B, 2);
    add_put(9000, 2, FIXTURE_A, 1);
    assert_throughput(WH_FIGURE_GIVEN, 3, 9, 0, 0);
    assert_near(wh_throughput(&f.record).wafers_per_hour, 1200, 1e-9);
}

static void what_is_on_its_way_does_not_count(void **state) {
    (void)state;
    begin(5000);
    add_put(1000, 0, FIXTURE_P, 1);
    assert_throughput(WH_FIGURE_NO_WAFER, 0, 5, 0, 0);
    f.stations[FIXTURE_P].counts = true;
    assert_throughput(WH_FIGURE_GIVEN, 1, 5, 0, 0);
    f.stations[FIXTURE_P].counts = false;
    f.stations[FIXTURE_A].counts = false;
    add_put(2000, 0, FIXTURE_A, 1);
    assert_throughput(WH_FIGURE_NO_WAFER, 0, 5, 0, 0);
    add_put(3000, 0, FIXTURE_B, 1);
    add_put(4000, 1, FIXTURE_B, 2);
    assert_throughput(WH_FIGURE_GIVEN, 2, 5, 0, 0);
    f.stations[FIXTURE_B].counts = false;
    assert_throughput(WH_FIGURE_NOWHERE, 0, 5, 0, 0);
}

/* A load lock that counts, with the FOUP behind it: the wafer would count twice. */
static void a_wafer_that_is_put_twice_gives_no_figure_without_marks(void **state) {
    (void)state;
    begin(9000);
    add_put(2000, 0, FIXTURE_B, 1);
    add_put(4000, 1, FIXTURE_B, 2);
    add_put(9000, 0, FIXTURE_A, 1);
    assert_throughput(WH_FIGURE_TWICE, 3, 9, 0, 0);
    f.stations[FIXTURE_A].counts = false;
    assert_throughput(WH_FIGURE_GIVEN, 2, 9, 0, 0);
    f.stations[FIXTURE_A].counts = true;
    add_cycle(0);
    assert_throughput(WH_FIGURE_GIVEN, 2, 9, 1, 1);
}

static void a_run_that_failed_or_whose_end_is_not_told_gives_no_figure(void **state) {
    (void)state;
    begin(9000);
    add_put(2000, 0, FIXTURE_B, 1);
    f.record.ok = false;
    assert_throughput(WH_FIGURE_FAILED, 1, 9, 0, 0);
    f.record.is_untold = true;
    assert_throughput(WH_FIGURE_UNTOLD, 1, 9, 0, 0);
    f.record.slices = 0;
    assert_throughput(WH_FIGURE_UNTOLD, 1, 0, 0, 0);
}

static void the_first_cycle_is_left_out(void **state) {
    (void)state;
    begin(26000);
    add_cycle(1000);
    add_put(10000, 0, FIXTURE_B, 1); /* at the very end of the first */
    add_cycle(10000);
    add_put(17000, 1, FIXTURE_B, 2);
    add_cycle(18000);
    add_put(26000, 2, FIXTURE_B, 3);
    assert_throughput(WH_FIGURE_GIVEN, 2, 16, 2, 3);
    assert_near(wh_throughput(&f.record).wafers_per_hour, 450, 1e-9);
    size_t *wafers = wh_throughput_cycle_wafers(&f.record);
    for (size_t i = 0; i < 3; ++i) {
        assert_int_equal(wafers[i], 1);
    }
    free(wafers);
    assert_true(wh_throughput_cycle_end(&f.record, 0) == 10000);
    assert_true(wh_throughput_cycle_end(&f.record, 2) == 26000);
}

static void an_only_cycle_counts(void **state) {
    (void)state;
    begin(8000);
    add_put(1000, 1, FIXTURE_B, 1); /* before the mark */
    add_cycle(2000);
    add_put(8000, 0, FIXTURE_B, 2);
    assert_throughput(WH_FIGURE_GIVEN, 1, 6, 1, 1);
}

static void cycles_without_a_slice_are_none(void **state) {
    (void)state;
    begin(9000);
    add_cycle(0);
    add_cycle(0);
    add_put(4000, 0, FIXTURE_B, 1);
    add_cycle(5000);
    add_put(8000, 1, FIXTURE_B, 2);
    add_cycle(9000);
    assert_throughput(WH_FIGURE_GIVEN, 1, 4, 3, 3);
    begin(9000);
    add_cycle(9000);
    add_put(8000, 1, FIXTURE_B, 2);
    assert_throughput(WH_FIGURE_GIVEN, 1, 9, 0, 0);
}

static void a_wafer_counts_once_a_cycle(void **state) {
    (void)state;
    begin(30000);
    add_cycle(0);
    add_cycle(10000);
    add_put(12000, 0, FIXTURE_B, 1);
    add_put(14000, 1, FIXTURE_B, 2);
    add_put(18000, 0, FIXTURE_A, 1);
    add_cycle(20000);
    add_put(25000, 0, FIXTURE_P, 1);
    add_put(28000, 0, FIXTURE_A, 1);
    assert_throughput(WH_FIGURE_GIVEN, 3, 20, 2, 3);
}

/* ---------------------------------------------------------------------------------------------------- runs */

static wh_script_run_t run;

static int close_run(void **state) {
    (void)state;
    wh_script_run_close(&run);
    return 0;
}

/* `parameter`: which of the script's cases. */
static const wh_record_t *play(const char *parameter, wh_script_run_outcome_t outcome) {
    const wh_script_run_options_t options = {.script = "tests/end_to_end/data/figures.lua",
                                             .limits = {.print_to = stderr},
                                             .parameters = &parameter,
                                             .parameter_count = 1};
    assert_int_equal(wh_script_run(&run, &options), outcome);
    return &run.record;
}

static void assert_shares(const int64_t shares[WH_SHARES], int64_t loaded, int64_t empty, int64_t vacuum,
                          int64_t handover, int64_t waiting) {
    const int64_t wanted[WH_SHARES] = {loaded, empty, vacuum, handover, waiting};
    for (size_t share = 0; share < WH_SHARES; ++share) {
        assert_int_equal(shares[share], wanted[share]);
    }
}

/* In ms: 2000 to the other station, 1000 in, 174 of the stroke until the wafer is within 0.51 mm,
 * 226 more of it with the wafer, 1 for each valve, 100 of vacuum_delay, 1000 out; a PUT has strokes
 * of 250. */
static void split_of_a_cycle(void **state) {
    (void)state;
    const wh_record_t *record = play("case=cycles", WH_RUN_MET);
    assert_int_equal(record->command_count, 9);
    assert_shares(record->commands[0].shares, 226 + 1000, 1000 + 174, 100, 1, 0);
    assert_shares(record->commands[3].shares, 226 + 1000, 2000 + 1000 + 174, 100, 1, 0);
    assert_shares(record->commands[4].shares, 0, 0, 0, 0, 500);
    assert_shares(record->commands[5].shares, 2000 + 1000 + 250, 250 + 1000, 0, 1, 0);
    assert_shares(record->activity.shares, 3 * (1226 + 3250), 3 * (1174 + 1250) + 2 * 2000, 300, 6, 1500);
    int64_t sum = 0;
    for (size_t share = 0; share < WH_SHARES; ++share) {
        sum += record->activity.shares[share];
    }
    assert_true(sum == record->slices);
}

static void throughput_of_cycles(void **state) {
    (void)state;
    const wh_record_t *record = play("case=cycles", WH_RUN_MET);
    const wh_throughput_t found = wh_throughput(record);
    assert_int_equal(record->cycle_count, 4);
    assert_string_equal(record->cycles[1].name, "of slot 2");
    assert_int_equal(record->cycles[1].line, 8);
    assert_string_equal(record->cycles[3].name, "");
    assert_true(record->cycles[1].begin == 7502);
    assert_int_equal(found.puts, 3);
    assert_int_equal(found.wafers, 2);
    assert_int_equal(found.first, 2);
    assert_int_equal(found.last, 3);
    assert_near(found.seconds, 19.004, 1e-12);
    assert_near(found.wafers_per_hour, 2 * 3600 / 19.004, 1e-9);
}

static const wh_busy_span_t *interval(const wh_record_t *record, wh_busy_t who, int32_t gripper,
                                      size_t number) {
    for (size_t i = 0; i < record->activity.interval_count; ++i) {
        const wh_busy_span_t *found = &record->activity.intervals[i];
        if (found->who == who && found->gripper == gripper && number-- == 0) {
            return found;
        }
    }
    fail_msg("no such interval");
    return NULL;
}

static void assert_interval(const wh_busy_span_t *found, int32_t what, int64_t from, int64_t to) {
    assert_int_equal(found->what, what);
    assert_int_equal(found->begin, from);
    assert_int_equal(found->end, to);
}

static void intervals_add_up(void **state) {
    (void)state;
    const wh_record_t *record = play("case=cycles", WH_RUN_MET);
    assert_interval(interval(record, WH_BUSY_ROBOT, 0, 0), 1 + WH_SHARE_EMPTY, 0, 1000);
    assert_interval(interval(record, WH_BUSY_ROBOT, 0, 1), 1 + WH_SHARE_HANDOVER, 1000, 1001);
    assert_interval(interval(record, WH_BUSY_ROBOT, 0, 3), 1 + WH_SHARE_LOADED, 1175, 1401);
    assert_interval(interval(record, WH_BUSY_ROBOT, 0, 4), 1 + WH_SHARE_VACUUM, 1401, 1501);
    assert_interval(interval(record, WH_BUSY_ROBOT, 0, 6), 1 + WH_SHARE_WAITING, 2501, 3001);
    /* The valve closes with the slice after 3001 + 2000 + 1000 + 250. */
    assert_interval(interval(record, WH_BUSY_WAFER, 0, 0), 1 + 0, 1176, 6252);
    assert_interval(interval(record, WH_BUSY_VALVE, 0, 0), 1, 1001, 6252);
    assert_interval(interval(record, WH_BUSY_WAFER, 0, 1), 1 + 1, 7502 + 3176, 7502 + 2000 + 6252);
    assert_int_equal(record->put_count, 3);
    assert_int_equal(record->puts[2].wafer, 2);
    assert_int_equal(record->puts[2].slot, 3);
    assert_true(record->puts[2].slice == 26506);
}

/* Over the prealigner and back to its own slot counts as one wafer; a dropped wafer, or one that is
 * not taken, counts as none. */
static void prealigner_and_drop(void **state) {
    (void)state;
    const wh_record_t *record = play("case=prealigner", WH_RUN_FAILED);
    const wh_throughput_t found = wh_throughput(record);
    assert_int_equal(found.figure, WH_FIGURE_FAILED);
    assert_int_equal(record->put_count, 2);
    size_t *wafers = wh_throughput_cycle_wafers(record);
    assert_int_equal(wafers[0], 1);
    assert_int_equal(wafers[1], 0);
    free(wafers);
    assert_string_equal(record->layout->stations[record->puts[0].station].name, "P");
    /* The chuck turns with the wafer on it, and the robot stands: by 90 degrees in 0.6 s. */
    const wh_busy_span_t *turn = interval(record, WH_BUSY_CHUCK, 1, 0);
    assert_int_equal(turn->what, 1 + WH_SHARE_LOADED);
    assert_int_equal(turn->end - turn->begin, 600);
    assert_shares(record->commands[2].shares, 600, 0, 0, 0, 0);
    for (size_t i = 0; i < record->activity.interval_count; ++i) {
        const wh_busy_span_t *other = &record->activity.intervals[i];
        assert_true(other->who != WH_BUSY_ROBOT || other->end <= turn->begin || other->begin >= turn->end);
    }
}

/* A SWAP starts one wafer while another comes back: one wafer per cycle, not two. */
static void swap(void **state) {
    (void)state;
    const wh_record_t *record = play("case=swap", WH_RUN_MET);
    assert_int_equal(record->put_count, 5);
    size_t *wafers = wh_throughput_cycle_wafers(record);
    assert_int_equal(wafers[0], 1);
    assert_int_equal(wafers[1], 1);
    free(wafers);
    const wh_throughput_t found = wh_throughput(record);
    assert_int_equal(found.wafers, 1);
    assert_int_equal(found.first, 2);
    const double seconds = record->commands[7].end_s - record->commands[5].begin_s;
    assert_near(found.wafers_per_hour, 3600 / seconds, 1e-9);
}

/* -------------------------------------------------------------------------------------------------- reach */

static const wh_travel_margin_t *reach(const wh_record_t *record, const char *station, size_t axis) {
    return &record->reach[wh_layout_find_station(record->layout, station)].axes[axis];
}

static void assert_reach(const wh_travel_margin_t *found, double margin, double at, bool is_max,
                         int32_t slot) {
    assert_near(found->margin, margin, 1e-9);
    assert_near(found->at, at, 1e-9);
    assert_int_equal(found->is_max, is_max);
    assert_int_equal(found->slot, slot);
}

static void reach_is_the_margin_of_travel(void **state) {
    (void)state;
    const double pi = acos(-1.0);
    const wh_record_t *record = play("case=cycles", WH_RUN_MET);
    assert_reach(reach(record, "A", WH_AXIS_R), 100, 400, false, 1);
    assert_reach(reach(record, "A", WH_AXIS_Z), 297, 897, false, 1);
    assert_reach(reach(record, "B", WH_AXIS_THETA), 2.5 * pi, pi / 2, true, 1);
    assert_reach(reach(record, "B", WH_AXIS_YAW), 1.5 * pi, 0, false, 1);
    /* The line into C passes base's axis at 350 mm, from 461 mm to 461 mm. */
    assert_reach(reach(record, "C", WH_AXIS_R), 50, 350, false, 1);
    assert_reach(reach(record, "C", WH_AXIS_THETA), 3 * pi - (pi - atan2(350, 300)), -(pi - atan2(350, 300)),
                 false, 1);
    assert_reach(reach(record, "C", WH_AXIS_YAW), 1.5 * pi - (pi - atan2(350, 300)), pi - atan2(350, 300),
                 true, 1);
}

static void refused_marks(void **state) {
    (void)state;
    const wh_record_t *record = play("case=errors", WH_RUN_MET);
    assert_int_equal(record->expectation_count, 3);
    /* The level's name is looked up before the command begins, too. */
    assert_int_equal(record->cycle_count, 1);
}

/* The data that a session forgets, and the work that continues in the meantime. */
static void forgetting(void **state) {
    (void)state;
    static wh_record_t record;
    static const wh_put_record_t put = {0, 1, 1, 5};
    static wh_gripper_t gripper = {.wafer = 7};
    static wh_machine_t machine = {.axis_count = 4, .gripper_count = 1};
    static wh_command_t command;
    const wh_state_t answer = {.grippers = &gripper, .gripper_count = 1};
    const wh_task_t moving = {WH_SHARE_WAITING, true, true, 1, 0, {0}};
    const wh_task_t standing = {WH_SHARE_WAITING, false, true, 0, 0, {0}};
    machine.mounts[0].axis = WH_NONE;
    command.seq = 1;
    assert_int_equal(wh_activity_count(&record.activity, &machine, &moving, &command, &answer),
                     WH_SHARE_LOADED);
    command.seq = 2;
    assert_int_equal(wh_activity_count(&record.activity, &machine, &standing, &command, &answer),
                     WH_SHARE_WAITING);
    wh_record_add_put(&record, &put);
    wh_record_add_cycle(&record, 1, "name", 0);
    assert_int_equal(record.activity.interval_count, 1);
    wh_record_forget(&record);
    assert_int_equal(record.put_count + record.cycle_count + record.activity.interval_count, 0);
    assert_shares(record.activity.shares, 1, 0, 0, 0, 1);
    wh_activity_end(&record.activity, 2);
    assert_interval(interval(&record, WH_BUSY_ROBOT, 0, 0), 1 + WH_SHARE_WAITING, 1, 2);
    assert_interval(interval(&record, WH_BUSY_WAFER, 0, 0), 1 + 7, 1, 2);
    wh_record_free(&record);
}

/* ---------------------------------------------------------------------------------------- steady cycles */

static wh_command_record_t listed[40];
static char texts[40][20];

/* One command behind the other. */
static void add_command(const char *text, double seconds) {
    const size_t i = f.record.command_count++;
    const double at = i == 0 ? 0 : listed[i - 1].end_s;
    strcpy(texts[i], text);
    listed[i] = (wh_command_record_t){.text = texts[i], .begin_s = at, .end_s = at + seconds};
    f.record.slices = (int64_t)(listed[i].end_s * 1000 + 0.5);
}

static void begin_commands(void) {
    begin(0);
    f.record.commands = listed;
}

/* GETs of one slot after the other, the first from home; each wafer is put down at the end. */
static void add_transfers(size_t count) {
    static const char *const gets[] = {"GET A 1", "GET A 2", "GET A 3", "GET A 4"};
    for (size_t i = 0; i < count; ++i) {
        add_command(gets[i], i == 0 ? 3 : 2);
        add_command("PUT B 7", 1);
        add_put(f.record.slices, (int32_t)(i % FIXTURE_WAFERS), FIXTURE_B, 7);
    }
}

static void assert_unsteady(wh_steady_t reason) {
    const wh_steady_cycle_t found = wh_steady_cycle(&f.record);
    assert_int_equal(found.found, reason);
    assert_non_null(wh_steady_reason(reason));
    assert_int_equal(found.count + found.times + found.mark + found.wafers, 0);
    assert_true(found.seconds == 0 && found.wafers_per_hour == 0);
    assert_int_equal(found.begin + found.end, 0);
}

static void assert_steady(size_t first, size_t count, int64_t from, int64_t to, size_t times) {
    const wh_steady_cycle_t found = wh_steady_cycle(&f.record);
    assert_int_equal(found.found, WH_STEADY_FOUND);
    assert_null(wh_steady_reason(found.found));
    assert_int_equal(found.first, first);
    assert_int_equal(found.count, count);
    assert_int_equal(found.begin, from);
    assert_int_equal(found.end, to);
    assert_int_equal(found.times, times);
    assert_near(found.seconds, (double)(to - from) / 1000, 1e-12);
    assert_near(found.wafers_per_hour,
                found.figure == WH_FIGURE_GIVEN ? 3600 * (double)found.wafers / found.seconds : 0, 1e-9);
}

static void a_cycle_is_found_without_marks(void **state) {
    (void)state;
    begin_commands();
    assert_unsteady(WH_STEADY_NO_COMMANDS);
    add_transfers(4);
    assert_steady(2, 2, 4000, 7000, 3);
    assert_int_equal(wh_steady_cycle(&f.record).figure, WH_FIGURE_GIVEN);
    assert_int_equal(wh_steady_cycle(&f.record).wafers, 1);
    assert_int_equal(wh_steady_cycle(&f.record).mark, 0);
    /* Commands before and after do not belong to it. */
    begin_commands();
    add_command("HOME", 1);
    add_transfers(4);
    add_command("WAIT 5", 5);
    assert_steady(3, 2, 5000, 8000, 3);
}

static void a_longer_cycle_is_not_what_repeats_within_it(void **state) {
    static const char *const cycle[] = {"GET A 1", "PUT B 1", "GET A 2", "PUT B 2", "ROTATE P 90"};
    (void)state;
    begin_commands();
    for (size_t i = 0; i < 15; ++i) {
        add_command(cycle[i % 5], 1);
    }
    assert_steady(0, 5, 0, 5000, 3);
    assert_int_equal(wh_steady_cycle(&f.record).figure, WH_FIGURE_NO_WAFER);
}

static void what_does_not_repeat_is_no_cycle(void **state) {
    (void)state;
    begin_commands();
    add_transfers(2);
    assert_unsteady(WH_STEADY_NO_CYCLES);
    /* Three equal cycles that are less than half of the run. */
    begin_commands();
    add_transfers(3);
    static const char *const others[] = {"GET B 1", "WAIT 1",  "ROTATE P 1", "HOME",
                                         "MOVE 1",  "PUT A 1", "STOP"};
    for (size_t i = 0; i < 7; ++i) {
        add_command(others[i], 1);
    }
    assert_unsteady(WH_STEADY_NO_CYCLES);
}

/* Each of these differs from its neighbours by slightly more than a hundredth, has an error, or has
 * another number of wafers. */
static void cycles_that_differ_are_not_steady(void **state) {
    (void)state;
    begin_commands();
    for (size_t i = 0; i < 5; ++i) {
        add_command("GET A 1", i % 2 ? 1 : 1.011);
    }
    assert_unsteady(WH_STEADY_UNLIKE);
    listed[3].end_s += 0.002; /* 1.011, 1.002 and 1.009: within a hundredth */
    listed[4].begin_s += 0.002;
    assert_steady(2, 1, 2011, 3022, 3);
    listed[3].error = WH_STATUS_BAD_ARGUMENT;
    assert_unsteady(WH_STEADY_UNLIKE);
    begin_commands();
    add_transfers(3);
    listed[0].end_s = listed[1].begin_s = 2; /* then all are alike */
    made_puts[1].slice = 7500;               /* in the third cycle, with another one */
    assert_unsteady(WH_STEADY_UNLIKE);
}

static void marked_cycles_go_before_what_repeats(void **state) {
    (void)state;
    begin_commands();
    add_transfers(4);
    add_cycle(0);
    assert_unsteady(WH_STEADY_NO_CYCLES);
    add_cycle(7000);
    add_cycle(10000);
    add_cycle(13000);
    assert_steady(4, 2, 7000, 10000, 2);
    assert_int_equal(wh_steady_cycle(&f.record).mark, 2);
    assert_int_equal(wh_steady_cycle(&f.record).figure, WH_FIGURE_GIVEN);
    made_cycles[2].begin = 9000;
    assert_unsteady(WH_STEADY_UNLIKE);
}

/* One wafer is put down twice in a cycle: with a mark it counts as one, without it nobody can tell. */
static void a_wafer_put_twice_in_a_cycle(void **state) {
    (void)state;
    begin_commands();
    for (size_t i = 0; i < 3; ++i) {
        add_command("GET A 1", 1);
        add_command("PUT B 1", 1);
        add_put(f.record.slices, 0, FIXTURE_B, 1);
        add_command("GET B 1", 1);
        add_command("PUT A 1", 1);
        add_put(f.record.slices, 0, FIXTURE_A, 1);
    }
    assert_steady(0, 4, 0, 4000, 3);
    assert_int_equal(wh_steady_cycle(&f.record).figure, WH_FIGURE_TWICE);
    add_cycle(0);
    add_cycle(4000);
    add_cycle(8000);
    assert_steady(0, 4, 0, 4000, 3);
    assert_int_equal(wh_steady_cycle(&f.record).wafers, 1);
    assert_int_equal(wh_steady_cycle(&f.record).figure, WH_FIGURE_GIVEN);
    f.record.ok = false;
    assert_int_equal(wh_steady_cycle(&f.record).figure, WH_FIGURE_FAILED);
}

static void a_kind_is_what_and_where(void **state) {
    (void)state;
    assert_int_equal(wh_steady_kind_length("GET A 1"), 5);
    assert_int_equal(wh_steady_kind_length("GET \"load port\" 1"), 15);
    assert_int_equal(wh_steady_kind_length("WAIT -2"), 4);
    assert_int_equal(wh_steady_kind_length("HOME"), 4);
    assert_int_equal(wh_steady_kind_length(""), 0);
}

/* ------------------------------------------------------------------------------------- as reports have them */

/* The figures as a report prints them and as JSON contains them. */

static fixture_t f_report;
static wh_busy_span_t intervals[16];
static wh_station_reach_t reach_report[FIXTURE_STATIONS];
static wh_put_record_t made_puts_report[4];
static wh_cycle_record_t made_cycles_report[4];

static void add_interval(wh_busy_t who, int32_t gripper, int32_t what, int64_t from, int64_t to) {
    const wh_busy_span_t interval = {who, gripper, what, from, to};
    intervals[f_report.record.activity.interval_count++] = interval;
}

static void add_cycle_report(int line, char *name, int64_t slice) {
    const wh_cycle_record_t cycle = {line, name, slice};
    made_cycles_report[f_report.record.cycle_count++] = cycle;
}

static void fill_shares(int64_t shares[WH_SHARES], int64_t loaded, int64_t empty, int64_t vacuum,
                        int64_t handover, int64_t waiting) {
    const int64_t values[WH_SHARES] = {loaded, empty, vacuum, handover, waiting};
    memcpy(shares, values, sizeof values);
}

/* 10 s in slices of 1 ms: a GET of 4 s, a WAIT of 1 s, a PUT onto the prealigner of 5 s. */
static void begin_report(void) {
    fixture_begin(&f_report);
    f_report.record.simulated_s = 10;
    f_report.record.slices = 10000;
    f_report.record.activity.intervals = intervals;
    f_report.record.puts = made_puts_report;
    f_report.record.cycles = made_cycles_report;
    f_report.stations[FIXTURE_P].prealigner = f_report.stations[FIXTURE_P].counts = true;
    fill_shares(fixture_command(&f_report, 3, "GET B 1", 0, 4)->shares, 2000, 1500, 499, 1, 0);
    fill_shares(fixture_command(&f_report, 4, "WAIT 1", 4, 5)->shares, 0, 0, 0, 0, 1000);
    fill_shares(fixture_command(&f_report, 5, "PUT P 1", 5, 10)->shares, 4000, 998, 0, 2, 0);
    fill_shares(f_report.record.activity.shares, 6000, 2498, 499, 3, 1000);
    add_interval(WH_BUSY_ROBOT, 0, 1 + WH_SHARE_EMPTY, 0, 1500);
    add_interval(WH_BUSY_ROBOT, 0, 1 + WH_SHARE_VACUUM, 1500, 2000);
    add_interval(WH_BUSY_ROBOT, 0, 1 + WH_SHARE_LOADED, 2000, 4000);
    add_interval(WH_BUSY_ROBOT, 0, 1 + WH_SHARE_WAITING, 4000, 5000);
    add_interval(WH_BUSY_ROBOT, 0, 1 + WH_SHARE_LOADED, 5000, 9000);
    add_interval(WH_BUSY_WAFER, FIXTURE_EE, 1 + 2, 1500, 9000);
    add_interval(WH_BUSY_CHUCK, FIXTURE_PA, 1 + WH_SHARE_LOADED, 9500, 10000);
    add_interval(WH_BUSY_ROBOT, 0, 1 + WH_SHARE_EMPTY, 9000, 9500);
    add_interval(WH_BUSY_WAFER, FIXTURE_PA, 1 + 1, 9000, 10000);
    add_interval(WH_BUSY_VALVE, FIXTURE_EE, 1, 1400, 9010);
}

/* ---------------------------------------------------------------------------------------------------- table */

static const wh_record_sections_t with_gantt = {.gantt = true};

static char *print(const wh_style_t *style, const wh_record_sections_t *sections) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_int_equal(wh_record_print_table(&f_report.record, out, style, sections), 0);
    fclose(out);
    return text;
}

static void assert_says(const char *text, const char *wanted) {
    if (!strstr(text, wanted)) {
        fprintf(stderr, "not found: %s\nin:\n%s", wanted, text); /* print_error cuts */
        fail();
    }
}

/* 49 columns and a label of 8: 40 columns of 250 slices. */
static void gantt_shows_the_commands(void **state) {
    const wh_style_t style = {false, true, 50};
    (void)state;
    begin_report();
    char *text = print(&style, &with_gantt);
    assert_says(
        text,
        "\nGantt\n"
        "s         0                   5\n"
        "command   │GET B 1        │   │PUT P 1\n"
        "robot     ▒▒▒▒▒▒vv████████····████████████████▒▒\n"
        "EE holds        ━Wäfer №3━━━━━━━━━━━━━━━━━━━━━\n"
        "EE valve       oooooooooooooooooooooooooooooooo\n"
        "PA turns                                        ██\n"
        "PA holds                                      ━━━━\n"
        "█ moving with a wafer, ▒ moving without, v waiting for vacuum, x valves switching, · waiting, o "
        "vacuum on\n");
    free(text);
}

static void gantt_in_ascii(void **state) {
    const wh_style_t style = {false, false, 50};
    (void)state;
    begin_report();
    strcpy(f_report.layout_wafers[2].name, "W3");
    add_cycle_report(2, f_report.texts[7], 0);
    strcpy(f_report.texts[6], "put it there");
    add_cycle_report(4, f_report.texts[6], 5000);
    char *text = print(&style, &with_gantt);
    assert_says(text, "\ncycle     |1                  |put it there\n"
                      "command   |GET B 1        |   |PUT P 1\n"
                      "robot     ------vv########....################--\n"
                      "EE holds        =W3===========================\n");
    for (const char *c = text; *c != '\0'; ++c) {
        assert_true((unsigned char)*c < 128);
    }
    free(text);
}

/* Without a terminal it has 100 columns, on the narrowest one 20, and no line ends with a blank. */
static void gantt_at_any_width(void **state) {
    (void)state;
    begin_report();
    for (size_t width = 0; width < 200; ++width) {
        const wh_style_t style = {false, false, width};
        const size_t columns = width == 0 ? 100 : width > 30 ? width - 10 : 20;
        char *text = print(&style, &with_gantt);
        const char *row = strstr(text, "\nPA turns ");
        assert_non_null(row);
        assert_int_equal(strcspn(row + 1, "\n"), 10 + columns);
        assert_null(strstr(strstr(text, "\nGantt"), " \ncommand"));
        free(text);
    }
}

/* From 2 s to 7 s, 40 columns of 125 slices: intervals that began before have no bar, and those
 * outside have no row. */
static void gantt_of_a_window(void **state) {
    const wh_style_t style = {false, true, 50};
    const wh_record_sections_t window = {.gantt = true, .from_s = 2, .to_s = 7};
    const wh_record_sections_t beyond = {.gantt = true, .from_s = 10};
    (void)state;
    begin_report();
    char *text = print(&style, &window);
    assert_says(text, "\nGantt\n"
                      "s         2               4               6\n"
                      "command   GET B 1         │WAIT 1 │PUT P 1\n"
                      "robot     ████████████████········████████████████\n"
                      "EE holds  ━Wäfer №3━━━━━━━━━━━━━━━━━━━━━━━━━━━━━━━\n"
                      "EE valve  oooooooooooooooooooooooooooooooooooooooo\n"
                      "█ moving with a wafer");
    assert_says(text, "   3  GET B 1   4.000");
    assert_says(text, "  all      10.000");
    free(text);
    text = print(&style, &beyond);
    assert_says(text, "\nGantt\nnothing: no slice of the run, which took 10.000 s, lies there\n");
    assert_null(strstr(text, "Totals"));
    free(text);
}

/* A CONTINUE is listed with the command that it continues, and failures are counted. */
static void totals_of_phases(void **state) {
    const wh_style_t style = {false, false, 120};
    (void)state;
    begin_report();
    fixture_command(&f_report, 6, "GET B 2 stop=up", 10, 12)->error = WH_STATUS_WAFER_MISSING;
    fixture_command(&f_report, 7, "CONTINUE", 12, 15);
    fixture_command(&f_report, 8, "CONTINUE", 15, 16);
    f_report.record.slices = 16000;
    f_report.record.simulated_s = 16;
    char *text = print(&style, &with_gantt);
    assert_says(text, "\ncommand            count  failed  mean s  least s  most s  share %\n"
                      "GET B                  2       1   3.000    2.000   4.000     37.5\n"
                      "WAIT                   1           1.000    1.000   1.000      6.2\n"
                      "PUT P                  1           5.000    5.000   5.000     31.2\n"
                      "CONTINUE of GET B      2           2.000    1.000   3.000     25.0\n");
    free(text);
    /* A WAIT in between does not change that. */
    fixture_command(&f_report, 9, "WAIT 2", 16, 18);
    fixture_command(&f_report, 10, "CONTINUE", 18, 20);
    f_report.record.slices = 20000;
    f_report.record.simulated_s = 20;
    text = print(&style, &with_gantt);
    assert_says(text, "CONTINUE of GET B      3           2.000    1.000   3.000     30.0\n");
    assert_null(strstr(text, "CONTINUE of WAIT"));
    free(text);
}

static void steady_cycles_by_themselves(void **state) {
    const wh_style_t style = {false, false, 50};
    const wh_record_sections_t wanted = {.cycle = true};
    (void)state;
    begin_report();
    char *text = print(&style, &wanted);
    assert_says(text, "\nFirst steady cycle\nno steady cycle: no two cycles are marked");
    assert_null(strstr(text, "\nGantt\n"));
    free(text);
    fixture_command(&f_report, 6, "PUT P 1", 10, 15);
    f_report.record.slices = 15000;
    f_report.record.simulated_s = 15;
    add_cycle_report(2, f_report.texts[7], 5000);
    strcpy(f_report.texts[6], "again");
    add_cycle_report(2, f_report.texts[6], 10000);
    text = print(&style, &wanted);
    assert_says(text,
                "\nFirst steady cycle\n5.000 s, from 5.000 s to 10.000 s, with 1 command: cycle 1; 2 like it "
                "in a row, to 1 %\nno wafers per hour: no wafer was put into a station that counts\n");
    assert_says(text, "\ncycle     |1\ncommand   |PUT P 1\n");
    free(text);
}

static void times(void **state) {
    const wh_style_t style = {false, true, 0};
    (void)state;
    begin_report();
    char *text = print(&style, &with_gantt);
    assert_says(text, "line  command       s  with wafer  without  vacuum  valves  waiting\n"
                      "   3  GET B 1   4.000       2.000    1.500   0.499   0.001\n"
                      "   4  WAIT 1    1.000                                         1.000\n"
                      "   5  PUT P 1   5.000       4.000    0.998           0.002\n"
                      "      all      10.000       6.000    2.498   0.499   0.003    1.000\n");
    free(text);
}

static void sections_are_asked_for(void **state) {
    const wh_style_t style = {false, true, 0};
    (void)state;
    begin_report();
    f_report.record.reach = reach_report;
    char *text = print(&style, 0);
    assert_null(strstr(text, "Gantt"));
    assert_null(strstr(text, "Time"));
    assert_null(strstr(text, "Reach"));
    assert_says(text, "\nno wafers per hour: no wafer was put into a station that counts\nhash");
    free(text);
}

static void wafers_per_hour_are_counted(void **state) {
    const wh_style_t style = {false, true, 0};
    const wh_put_record_t put = {1, FIXTURE_P, 1, 10000};
    const wh_put_record_t early = {0, FIXTURE_P, 1, 4000};
    (void)state;
    begin_report();
    made_puts_report[f_report.record.put_count++] = early;
    made_puts_report[f_report.record.put_count++] = put;
    char *text = print(&style, 0);
    assert_says(text,
                "720.0 wafers per hour: 2 in 10.000 s, the whole run; 85.0 % motion, 5.0 % vacuum, 10.0 % "
                "waiting\nhash");
    free(text);
    add_cycle_report(2, f_report.texts[7], 0);
    text = print(&style, 0);
    assert_says(text, "\n720.0 wafers per hour: 2 in 10.000 s, cycle 1; ");
    free(text);
    add_cycle_report(2, f_report.texts[7], 5000);
    add_cycle_report(2, f_report.texts[7], 8000);
    text = print(&style, 0);
    assert_says(text, "\n720.0 wafers per hour: 1 in 5.000 s, cycles 2 to 3; ");
    free(text);
}

static void set_reach(int32_t station, size_t axis, double margin, double at, bool is_max, int32_t slot) {
    const wh_travel_margin_t made = {margin, at, is_max, slot};
    reach_report[station].axes[axis] = made;
}

static void fill_reach(void) {
    memset(reach_report, 0, sizeof reach_report);
    set_reach(FIXTURE_A, WH_AXIS_THETA, 9 * WH_PI, 0, false, 1);
    set_reach(FIXTURE_A, WH_AXIS_R, 100, 400, false, 1);
    set_reach(FIXTURE_A, WH_AXIS_Z, 157.25, 1142.75, true, 25);
    set_reach(FIXTURE_A, WH_AXIS_YAW, WH_PI, WH_PI / 2, true, 1);
    f_report.record.reach = reach_report;
}

static void margins(void **state) {
    const wh_style_t style = {false, true, 0};
    (void)state;
    begin_report();
    fill_reach();
    char *text = print(&style, &(wh_record_sections_t){.margins = true});
    assert_says(
        text,
        "station  theta deg  from          r mm  from           z mm  from          yaw deg  from\n"
        "A           1620.0  min, slot 1  100.0  min, slot 1  157.25  max, slot 25    180.0  max, slot 1\n"
        "\n3 commands");
    free(text);
}

/* ----------------------------------------------------------------------------------------------------- JSON */

static json_t *reread(void) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_int_equal(wh_record_print_json(&f_report.record, out), 0);
    fclose(out);
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(root);
    free(text);
    return root;
}

/* A member or element equals this JSON text, with the keys in the same order. */
static void assert_json(const json_t *value, const char *wanted) {
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(17));
    assert_non_null(text);
    assert_string_equal(text, wanted);
    free(text);
}

static const json_t *element(const json_t *root, const char *list, size_t i) {
    return json_array_get(json_object_get(root, list), i);
}

static void json_sums(void **state) {
    const wh_put_record_t put = {1, FIXTURE_P, 1, 10000};
    (void)state;
    begin_report();
    made_puts_report[f_report.record.put_count++] = put;
    add_cycle_report(2, f_report.texts[7], 0);
    strcpy(f_report.texts[6], "second");
    add_cycle_report(4, f_report.texts[6], 5000);
    json_t *root = reread();
    assert_json(json_object_get(root, "throughput"), "{\"wafers_per_hour\": 720.0, \"reason\": null, "
                                                     "\"wafers\": 1, \"seconds\": 5.0, "
                                                     "\"first_cycle\": 2, \"last_cycle\": 2, "
                                                     "\"puts\": 1, \"counting\": [\"P\"]}");
    assert_json(json_object_get(root, "split"),
                "{\"motion_s\": 8.4979999999999993, \"loaded_s\": 6.0, \"empty_s\": 2.4980000000000002, "
                "\"vacuum_s\": "
                "0.499, \"handover_s\": 0.0030000000000000001, \"waiting_s\": 1.0}");
    assert_json(
        json_object_get(element(root, "commands", 1), "split"),
        "{\"motion_s\": 0.0, \"loaded_s\": 0.0, \"empty_s\": 0.0, \"vacuum_s\": 0.0, \"handover_s\": 0.0, "
        "\"waiting_s\": 1.0}");
    assert_json(json_object_get(root, "cycles"),
                "[{\"line\": 2, \"name\": null, \"begin_s\": 0.0, \"end_s\": 5.0, \"wafers\": 0}, "
                "{\"line\": 4, \"name\": \"second\", \"begin_s\": 5.0, \"end_s\": 10.0, \"wafers\": 1}]");
    json_decref(root);
}

static void json_gantt(void **state) {
    (void)state;
    begin_report();
    json_t *root = reread();
    assert_int_equal(json_array_size(json_object_get(root, "gantt")), 10);
    assert_json(element(root, "gantt", 1),
                "{\"resource\": \"robot\", \"gripper\": null, \"from_s\": 1.5, \"to_s\": "
                "2.0, \"what\": \"vacuum\"}");
    assert_json(element(root, "gantt", 5),
                "{\"resource\": \"robot\", \"gripper\": null, \"from_s\": 9.0, \"to_s\": "
                "9.5, \"what\": \"empty\"}");
    assert_json(element(root, "gantt", 6),
                "{\"resource\": \"gripper\", \"gripper\": \"EE\", \"from_s\": 1.5, "
                "\"to_s\": 9.0, \"what\": \"Wäfer №3\"}");
    assert_json(element(root, "gantt", 7),
                "{\"resource\": \"valve\", \"gripper\": \"EE\", \"from_s\": "
                "1.3999999999999999, \"to_s\": 9.0099999999999998, \"what\": \"open\"}");
    assert_json(element(root, "gantt", 8),
                "{\"resource\": \"chuck\", \"gripper\": \"PA\", \"from_s\": 9.5, \"to_s\": "
                "10.0, \"what\": \"loaded\"}");
    json_decref(root);
}

static void json_reach(void **state) {
    (void)state;
    begin_report();
    fill_reach();
    json_t *root = reread();
    assert_int_equal(json_array_size(json_object_get(root, "reach")), 4);
    assert_json(element(root, "reach", 0),
                "{\"station\": \"A\", \"slot\": 1, \"axis\": \"theta\", \"margin\": 1620.0, "
                "\"at\": 0.0, \"end\": \"min\", \"unit\": \"deg\"}");
    assert_json(element(root, "reach", 2),
                "{\"station\": \"A\", \"slot\": 25, \"axis\": \"z\", \"margin\": 157.25, "
                "\"at\": 1142.75, \"end\": \"max\", \"unit\": \"mm\"}");
    json_decref(root);
}

static void json_of_nothing(void **state) {
    (void)state;
    fixture_empty(&f_report);
    json_t *root = reread();
    assert_json(
        json_object_get(root, "throughput"),
        "{\"wafers_per_hour\": null, \"reason\": \"there is no cell\", \"wafers\": 0, \"seconds\": 0.0, "
        "\"first_cycle\": null, \"last_cycle\": null, \"puts\": 0, \"counting\": []}");
    assert_json(json_object_get(root, "gantt"), "[]");
    assert_json(json_object_get(root, "reach"), "[]");
    json_decref(root);
}

/* The library's wh_status_text leaves out statuses that only the program uses. */
static void every_status_has_its_text(void **state) {
    (void)state;
#define WH_STATUS(number, name, text) assert_string_equal(wh_record_error_text(WH_STATUS_##name), text);
#include "math/status.def"
#undef WH_STATUS
    assert_string_equal(wh_record_error_text((wh_status_t)255), "unknown status");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_record_of_nothing),
        cmocka_unit_test(without_marks_every_put_counts),
        cmocka_unit_test(what_is_on_its_way_does_not_count),
        cmocka_unit_test(a_wafer_that_is_put_twice_gives_no_figure_without_marks),
        cmocka_unit_test(a_run_that_failed_or_whose_end_is_not_told_gives_no_figure),
        cmocka_unit_test(the_first_cycle_is_left_out),
        cmocka_unit_test(an_only_cycle_counts),
        cmocka_unit_test(cycles_without_a_slice_are_none),
        cmocka_unit_test(a_wafer_counts_once_a_cycle),
        cmocka_unit_test(a_cycle_is_found_without_marks),
        cmocka_unit_test(a_longer_cycle_is_not_what_repeats_within_it),
        cmocka_unit_test(what_does_not_repeat_is_no_cycle),
        cmocka_unit_test(cycles_that_differ_are_not_steady),
        cmocka_unit_test(marked_cycles_go_before_what_repeats),
        cmocka_unit_test(a_wafer_put_twice_in_a_cycle),
        cmocka_unit_test(a_kind_is_what_and_where),
        cmocka_unit_test_teardown(split_of_a_cycle, close_run),
        cmocka_unit_test_teardown(throughput_of_cycles, close_run),
        cmocka_unit_test_teardown(intervals_add_up, close_run),
        cmocka_unit_test_teardown(prealigner_and_drop, close_run),
        cmocka_unit_test_teardown(swap, close_run),
        cmocka_unit_test_teardown(reach_is_the_margin_of_travel, close_run),
        cmocka_unit_test_teardown(refused_marks, close_run),
        cmocka_unit_test(forgetting),
        cmocka_unit_test(gantt_shows_the_commands),
        cmocka_unit_test(gantt_in_ascii),
        cmocka_unit_test(gantt_at_any_width),
        cmocka_unit_test(gantt_of_a_window),
        cmocka_unit_test(totals_of_phases),
        cmocka_unit_test(steady_cycles_by_themselves),
        cmocka_unit_test(times),
        cmocka_unit_test(sections_are_asked_for),
        cmocka_unit_test(wafers_per_hour_are_counted),
        cmocka_unit_test(margins),
        cmocka_unit_test(json_sums),
        cmocka_unit_test(json_gantt),
        cmocka_unit_test(json_reach),
        cmocka_unit_test(every_status_has_its_text),
        cmocka_unit_test(json_of_nothing),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
