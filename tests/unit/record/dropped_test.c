/* A record that drops rows tells what the same one with rows tells, whatever comes in which order. */
#include "support/support.h"

#include <stdlib.h>
#include <string.h>

#include "record/dropped.h"
#include "record/recorder.h"
#include "record/throughput.h"
#include "support/record.h"

enum { LANES = 4, STEPS = 600 };

/* Two records that hear the same: the first one keeps its rows. */
typedef struct {
    wh_record_t record;
    wh_recorder_t recorder;
    int32_t running[LANES];
} side_t;

static fixture_t f;
static side_t sides[2];
static int64_t slice;

static int below(int count) {
    return (int)wh_test_below((uint32_t)count);
}

static void open_sides(void) {
    fixture_begin(&f);
    f.stations[FIXTURE_A].counts = f.stations[FIXTURE_B].counts = true;
    slice = 0;
    for (size_t i = 0; i < 2; ++i) {
        side_t *side = &sides[i];
        memset(side, 0, sizeof *side);
        wh_recorder_open(&side->recorder, &side->record, "script.lua");
        side->recorder.layout = &f.layout;
        for (size_t lane = 0; lane < LANES; ++lane) {
            side->running[lane] = WH_NONE;
        }
    }
    wh_dropped_want(&sides[1].record);
}

static void begin_or_end(side_t *side, size_t lane, bool fails) {
    static const char *const texts[] = {"GET A 1", "PUT B 2", "WAIT 1", "TEACH A"};
    side->recorder.number = (int32_t)lane;
    side->recorder.running = side->running[lane];
    if (side->running[lane] == WH_NONE) {
        (void)wh_recorder_begin(&side->recorder, 1, texts[lane], (double)slice);
        side->running[lane] = side->recorder.running;
    } else {
        (void)wh_recorder_end(&side->recorder, (double)slice, fails ? WH_STATUS_WAFER_MISSING : WH_OK, "why",
                              NULL);
        side->running[lane] = WH_NONE;
    }
}

static void add_event(side_t *side, size_t lane, wh_event_kind_t kind) {
    const wh_event_t event = {
        .kind = kind, .slice = (uint64_t)slice, .wafer = (int32_t)lane % FIXTURE_WAFERS};
    const wh_seat_t seat = {.is_there = false};
    wh_record_add_event(&side->record, slice * 1000, side->running[lane], &event, &seat);
}

static void add_stay(side_t *side, int32_t station, int32_t wafer, wh_clock_kind_t kind) {
    const wh_station_event_record_t event = {.station = station,
                                             .event = {.kind = kind, .wafer = wafer, .us = slice}};
    wh_record_add_station_event(&side->record, &event);
}

/* One thing more, the same on both sides. */
static void take_step(void) {
    static const wh_event_kind_t kinds[] = {WH_EVENT_PICKED, WH_EVENT_NEAR_MISS, WH_EVENT_SETTLED,
                                            WH_EVENT_SLIPPED};
    static const wh_clock_kind_t clocks[] = {WH_CLOCK_PROCESS_BEGINS, WH_CLOCK_TAKEN, WH_CLOCK_UNPROCESSED,
                                             WH_CLOCK_PUMP_ENDS};
    const int what = below(12), number = below(4), lane = below(LANES), place = below(3), rare = below(20);
    slice += below(3);
    for (size_t i = 0; i < 2; ++i) {
        side_t *side = &sides[i];
        if (what < 6) {
            begin_or_end(side, (size_t)lane, rare == 0);
        } else if (what < 8) {
            add_event(side, (size_t)lane, kinds[rare == 0 ? 3 : number % 3]);
        } else if (what == 8) {
            wh_record_add_put(&side->record, &(wh_put_record_t){number % FIXTURE_WAFERS, place, 1, slice});
        } else if (what == 9) {
            wh_record_add_expectation(&side->record, 1, "it holds", rare > 0);
        } else if (what == 10) {
            add_stay(side, place, number % FIXTURE_WAFERS, clocks[lane % 4]);
        } else if (rare < 3) {
            wh_record_add_cycle(&side->record, 1, "", slice);
        }
    }
}

/* Cycles, wafers and reason are equal with and without rows. */
static void assert_same_throughput(void) {
    wh_throughput_t found[2];
    for (size_t i = 0; i < 2; ++i) {
        wh_record_t *record = &sides[i].record;
        record->layout = &f.layout;
        record->slices = slice;
        record->ok = true;
        found[i] = wh_throughput(record);
        record->layout = NULL;
    }
    assert_int_equal(found[0].figure, found[1].figure);
    assert_int_equal(found[0].puts, found[1].puts);
    assert_int_equal(found[0].wafers, found[1].wafers);
    assert_int_equal(found[0].slices, found[1].slices);
    assert_int_equal(found[0].first, found[1].first);
    assert_int_equal(found[0].last, found[1].last);
}

/* How a wafer's last stay ended; 0: it did not. */
static int64_t last_stay(const wh_record_t *record, int32_t station, int32_t wafer) {
    for (size_t i = record->station_event_count; i > 0; --i) {
        const wh_station_event_record_t *event = &record->station_events[i - 1];
        const wh_clock_kind_t kind = event->event.kind;
        if (event->station == station && event->event.wafer == wafer &&
            (kind == WH_CLOCK_TAKEN || kind == WH_CLOCK_UNPROCESSED)) {
            return event->event.us * 2 + (kind == WH_CLOCK_TAKEN);
        }
    }
    return 0;
}

static size_t count_complaints(const wh_record_t *record) {
    size_t count = 0;
    for (size_t i = 0; i < record->event_count; ++i) {
        count += wh_record_is_complaint(record->events[i].event.kind) ? 1 : 0;
    }
    return count;
}

static size_t count_unmet(const wh_record_t *record) {
    size_t count = 0;
    for (size_t i = 0; i < record->expectation_count; ++i) {
        count += record->expectations[i].ok ? 0 : 1;
    }
    return count;
}

/* The command that runs in a lane has its number, its text, and its own events in order. */
static void assert_same_command(size_t lane) {
    size_t at[2];
    for (size_t i = 0; i < 2; ++i) {
        assert_int_equal(sides[i].running[lane] == WH_NONE, sides[0].running[lane] == WH_NONE);
    }
    if (sides[0].running[lane] == WH_NONE) {
        return;
    }
    const wh_command_record_t *rows = &sides[0].record.commands[sides[0].running[lane]];
    const wh_command_record_t *brief = &sides[1].record.commands[sides[1].running[lane]];
    assert_int_equal(rows->number, brief->number);
    assert_string_equal(rows->text, brief->text);
    at[0] = rows->first_event;
    at[1] = brief->first_event;
    for (bool more = true; more;) {
        for (size_t i = 0; i < 2; ++i) {
            const wh_record_t *record = &sides[i].record;
            while (at[i] < record->event_count && record->events[at[i]].command != sides[i].running[lane]) {
                ++at[i];
            }
        }
        more = at[0] < sides[0].record.event_count;
        assert_int_equal(more, at[1] < sides[1].record.event_count);
        if (more) {
            const wh_event_record_t *one = &sides[0].record.events[at[0]++];
            const wh_event_record_t *other = &sides[1].record.events[at[1]++];
            assert_int_equal(one->event.kind, other->event.kind);
            assert_int_equal(one->utime, other->utime);
        }
    }
}

static void assert_same(void) {
    const wh_record_t *rows = &sides[0].record, *brief = &sides[1].record;
    assert_int_equal(wh_record_commands(rows), wh_record_commands(brief));
    assert_int_equal(wh_record_errors(rows), wh_record_errors(brief));
    assert_int_equal(wh_record_expectations(rows), wh_record_expectations(brief));
    assert_int_equal(count_unmet(rows), count_unmet(brief));
    assert_int_equal(count_complaints(rows), count_complaints(brief));
    for (size_t lane = 0; lane < LANES; ++lane) {
        assert_same_command(lane);
    }
    for (int32_t station = 0; station < FIXTURE_STATIONS; ++station) {
        for (int32_t wafer = 0; wafer < FIXTURE_WAFERS; ++wafer) {
            assert_int_equal(last_stay(rows, station, wafer), last_stay(brief, station, wafer));
        }
    }
    assert_same_throughput();
}

static void close_sides(void) {
    for (size_t i = 0; i < 2; ++i) {
        wh_record_free(&sides[i].record);
    }
}

static void sums_are_those_of_all_rows(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(20, 400, 1);
    while (wh_round(&rounds)) {
        open_sides();
        for (int i = 0; i < STEPS; ++i) {
            take_step();
            if (i % 16 == 0) {
                assert_same();
            }
        }
        assert_same();
        const wh_record_t *brief = &sides[1].record;
        assert_true(brief->command_count <= LANES && brief->put_count < sides[0].record.put_count);
        assert_true(brief->station_event_count <= FIXTURE_STATIONS * FIXTURE_WAFERS + 1);
        assert_true(sides[0].record.command_count > 20 * LANES);
        close_sides();
    }
}

static void nothing_is_dropped_unasked(void **state) {
    (void)state;
    open_sides();
    for (int i = 0; i < STEPS; ++i) {
        take_step();
    }
    assert_int_equal(wh_record_commands(&sides[0].record), sides[0].record.command_count);
    assert_int_equal(sides[0].record.dropped.commands, 0);
    close_sides();
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_are_those_of_all_rows),
        cmocka_unit_test(nothing_is_dropped_unasked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
