#include "dropped.h"

#include <stdlib.h>

#include "../text/array.h"

void wh_dropped_want(wh_record_t *record) {
    record->dropped.is_wanted = true;
    record->activity.drops_intervals = true;
}

/* ----------------------------------------------------------------------------------------- expectations */

void wh_dropped_expectation(wh_record_t *record) {
    const size_t count = record->expectation_count;
    if (record->dropped.is_wanted && count > 0 && record->expectations[count - 1].ok) {
        free(record->expectations[count - 1].text);
        --record->expectation_count;
        ++record->dropped.expectations;
    }
}

/* --------------------------------------------------------------------------------------- stations' events */

/* A script may ask how a wafer's last stay in a station ended. */
static bool ends_stay(const wh_station_event_record_t *event) {
    const wh_clock_kind_t kind = event->event.kind;
    return kind == WH_CLOCK_TAKEN || kind == WH_CLOCK_UNPROCESSED || kind == WH_CLOCK_PROCESS_CUT;
}

/* The stay before this one of the same wafer in the same station, or the event's own index. */
static size_t find_earlier(const wh_record_t *record, size_t last) {
    const wh_station_event_record_t *event = &record->station_events[last];
    size_t i = 0;
    while (i < last && (record->station_events[i].station != event->station ||
                        record->station_events[i].event.wafer != event->event.wafer)) {
        ++i;
    }
    return i;
}

void wh_dropped_station_event(wh_record_t *record) {
    if (!record->dropped.is_wanted || record->station_event_count == 0) {
        return;
    }
    const size_t last = record->station_event_count - 1;
    const bool stays = ends_stay(&record->station_events[last]);
    const size_t earlier = stays ? find_earlier(record, last) : last;
    record->station_events[earlier] = record->station_events[last];
    record->station_event_count = stays && earlier == last ? last + 1 : last;
}

/* --------------------------------------------------------------------------------------------------- puts */

/* The marked cycle to which a put belongs, from 1; 0: none has begun before it. */
static size_t cycle_of(const wh_record_t *record, const wh_put_record_t *put) {
    size_t cycle = record->cycle_count;
    while (cycle > 0 && record->cycles[cycle - 1].begin >= put->slice) {
        --cycle;
    }
    return cycle;
}

static void sum_put(wh_record_t *record, const wh_put_record_t *put) {
    wh_dropped_t *dropped = &record->dropped;
    wh_dropped_puts_t *of = &dropped->puts_of[put->wafer];
    const size_t cycle = cycle_of(record, put);
    dropped->is_twice = dropped->is_twice || of->is_put;
    of->is_put = true;
    ++dropped->wafers;
    if (cycle > 0 && of->cycle != cycle) {
        of->cycle = cycle;
        ++record->cycles[cycle - 1].wafers;
    }
}

static void drop_puts(wh_record_t *record, const wh_layout_t *layout) {
    wh_dropped_t *dropped = &record->dropped;
    if (record->put_count > 0 && !dropped->puts_of) {
        dropped->puts_of = wh_array_new(layout->wafer_count, sizeof *dropped->puts_of);
    }
    for (size_t i = 0; i < record->put_count; ++i) {
        if (layout->stations[record->puts[i].station].counts) {
            sum_put(record, &record->puts[i]);
        }
    }
    dropped->puts += record->put_count;
    record->put_count = 0;
}

/* ----------------------------------------------------------------------------------- commands and events */

/* The number of events before the first command that still runs began. */
static size_t find_least(const wh_record_t *record) {
    size_t least = record->event_count;
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        least = !command->is_over && command->first_event < least ? command->first_event : least;
    }
    return least;
}

/* Complaints go to the front. Events of commands that are over no longer name them: their rows are used
 * again. */
static void drop_events(wh_record_t *record) {
    const size_t least = find_least(record), before = record->event_count;
    size_t kept = record->dropped.complaints;
    for (size_t i = kept; i < before; ++i) {
        wh_event_record_t event = record->events[i];
        const bool is_old = i < least;
        if (is_old && !wh_record_is_complaint(event.event.kind)) {
            continue;
        }
        if (event.command != WH_NONE && record->commands[event.command].is_over) {
            event.command = WH_NONE;
        }
        record->events[kept++] = event;
        record->dropped.complaints += is_old ? 1 : 0;
    }
    record->event_count = kept;
    for (size_t i = 0; i < record->command_count; ++i) {
        record->commands[i].first_event -= record->commands[i].is_over ? 0 : before - kept;
    }
}

/* The row of a command that is over, which is free then; null: all of them run. */
static wh_command_record_t *free_row(wh_record_t *record) {
    for (size_t i = 0; i < record->command_count; ++i) {
        wh_command_record_t *command = &record->commands[i];
        if (command->is_over) {
            record->dropped.errors += command->error != WH_OK ? 1 : 0;
            ++record->dropped.commands;
            free(command->text);
            free(command->message);
            return command;
        }
    }
    return NULL;
}

wh_command_record_t *wh_dropped_begin(wh_record_t *record, const wh_layout_t *layout, int line,
                                      const char *text, double begin_s) {
    const size_t number = wh_record_commands(record);
    drop_puts(record, layout);
    drop_events(record);
    wh_command_record_t *row = free_row(record);
    if (!row) {
        row = wh_record_add_command(record, line, text, begin_s);
        row->number = number;
        return row;
    }
    *row = (wh_command_record_t){.line = line,
                                 .text = wh_text_copy(text),
                                 .begin_s = begin_s,
                                 .end_s = begin_s,
                                 .first_event = record->event_count,
                                 .number = number};
    return row;
}
