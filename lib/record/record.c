#include "record.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "dropped.h"

bool wh_record_is_timed(const wh_record_t *record) {
    return record->layout && record->layout->tool;
}

static bool has_flowed(const wh_record_t *record) {
    return record->flow && wh_flow_has_moved(record->flow);
}

bool wh_record_played_nothing(const wh_record_t *record) {
    return record->slices == 0 && !has_flowed(record);
}

bool wh_record_kept_still(const wh_record_t *record) {
    const int64_t *shares = record->activity.shares;
    return shares[WH_SHARE_LOADED] + shares[WH_SHARE_EMPTY] == 0 && !has_flowed(record);
}

bool wh_record_moved_nothing(const wh_record_t *record) {
    return record->ok && wh_record_commands(record) == 0 && wh_record_played_nothing(record);
}

const char *wh_record_error_text(wh_status_t status) {
    static const struct {
        wh_status_t number;
        const char *text;
    } catalogue[] = {
#define WH_STATUS(number, name, text) {WH_STATUS_##name, text},
#include "../math/status.def"
#undef WH_STATUS
    };
    for (size_t i = 0; i < sizeof catalogue / sizeof catalogue[0]; ++i) {
        if (catalogue[i].number == status) {
            return catalogue[i].text;
        }
    }
    return "unknown status";
}

size_t wh_record_commands(const wh_record_t *record) {
    return record->dropped.commands + record->command_count;
}

size_t wh_record_errors(const wh_record_t *record) {
    size_t errors = record->dropped.errors;
    for (size_t i = 0; i < record->command_count; ++i) {
        errors += record->commands[i].error != WH_OK ? 1 : 0;
    }
    return errors;
}

size_t wh_record_expectations(const wh_record_t *record) {
    return record->dropped.expectations + record->expectation_count;
}

wh_command_record_t *wh_record_add_command(wh_record_t *record, int line, const char *text, double begin_s) {
    record->commands = wh_array_grow(record->commands, record->command_count, &record->command_capacity,
                                     sizeof *record->commands);
    wh_command_record_t *command = &record->commands[record->command_count++];
    *command = (wh_command_record_t){.line = line,
                                     .text = wh_text_copy(text),
                                     .begin_s = begin_s,
                                     .end_s = begin_s,
                                     .first_event = record->event_count,
                                     .number = record->command_count - 1};
    return command;
}

void wh_record_add_event(wh_record_t *record, int64_t utime, int32_t command, const wh_event_t *event,
                         const wh_seat_t *seat) {
    record->events =
        wh_array_grow(record->events, record->event_count, &record->event_capacity, sizeof *record->events);
    record->events[record->event_count++] = (wh_event_record_t){utime, command, *event, *seat};
}

static wh_expectation_record_t *add_expectation(wh_record_t *record) {
    wh_dropped_expectation(record);
    record->expectations = wh_array_grow(record->expectations, record->expectation_count,
                                         &record->expectation_capacity, sizeof *record->expectations);
    return &record->expectations[record->expectation_count++];
}

void wh_record_add_expectation(wh_record_t *record, int line, const char *text, bool ok) {
    *add_expectation(record) = (wh_expectation_record_t){line, wh_text_copy(text), ok, false, 0};
}

/* The bytes of what is expected, before what came of it; 0: all of the text. */
static size_t name_in(const char *text) {
    const char *found = strstr(text, "; ");
    return found ? (size_t)(found - text) : 0;
}

void wh_record_count_implied(wh_record_t *record, int line, const char *text, bool ok) {
    if (record->dropped.is_wanted) {
        return; /* studies alone read them */
    }
    record->implied = wh_array_grow(record->implied, record->implied_count, &record->implied_capacity,
                                    sizeof *record->implied);
    record->implied[record->implied_count++] =
        (wh_expectation_record_t){line, wh_text_copy(text), ok, true, name_in(text)};
}

void wh_record_add_breach(wh_record_t *record, int line, const char *text) {
    *add_expectation(record) =
        (wh_expectation_record_t){line, wh_text_copy(text), false, true, name_in(text)};
}

void wh_record_add_implied(wh_record_t *record, int line, const char *text, bool ok) {
    wh_record_count_implied(record, line, text, ok);
    if (!ok) {
        wh_record_add_breach(record, line, text);
    }
}

void wh_record_name_expectation(wh_record_t *record, size_t bytes) {
    wh_expectation_record_t *last = &record->expectations[record->expectation_count - 1];
    last->name = bytes < strlen(last->text) ? bytes : 0;
}

void wh_record_add_put(wh_record_t *record, const wh_put_record_t *put) {
    record->puts =
        wh_array_grow(record->puts, record->put_count, &record->put_capacity, sizeof *record->puts);
    record->puts[record->put_count++] = *put;
}

void wh_record_add_cycle(wh_record_t *record, int line, const char *name, int64_t begin) {
    record->cycles =
        wh_array_grow(record->cycles, record->cycle_count, &record->cycle_capacity, sizeof *record->cycles);
    record->cycles[record->cycle_count++] = (wh_cycle_record_t){line, wh_text_copy(name), begin, 0};
}

void wh_record_add_station_event(wh_record_t *record, const wh_station_event_record_t *event) {
    wh_dropped_station_event(record);
    record->station_events = wh_array_grow(record->station_events, record->station_event_count,
                                           &record->station_event_capacity, sizeof *record->station_events);
    record->station_events[record->station_event_count++] = *event;
}

bool wh_record_is_teaching(const wh_record_t *record, int32_t command) {
    static const char teach[] = "TEACH ";
    return command != WH_NONE && strncmp(record->commands[command].text, teach, strlen(teach)) == 0;
}

void wh_record_add_centring(wh_record_t *record, const wh_centring_record_t *centring) {
    if (wh_record_is_teaching(record, centring->command)) {
        return;
    }
    if (record->centring_count == WH_RECORD_CENTRINGS) {
        ++record->centrings_left_out;
        return;
    }
    record->centrings = wh_array_grow(record->centrings, record->centring_count, &record->centring_capacity,
                                      sizeof *record->centrings);
    record->centrings[record->centring_count++] = *centring;
}

void wh_record_add_wait(wh_record_t *record, int32_t task, int32_t command, const char *what, int64_t begin) {
    record->waits =
        wh_array_grow(record->waits, record->wait_count, &record->wait_capacity, sizeof *record->waits);
    record->waits[record->wait_count++] =
        (wh_wait_record_t){task, command, wh_text_copy(what), begin, begin, true};
}

bool wh_record_is_complaint(wh_event_kind_t kind) {
    static const uint32_t complaints = 1U << WH_EVENT_RELEASED_UNSUPPORTED | 1U << WH_EVENT_SLOT_OCCUPIED |
                                       1U << WH_EVENT_BAD_INPUT | 1U << WH_EVENT_PLACED_OFF_CENTRE |
                                       1U << WH_EVENT_PLACED_ASKEW | 1U << WH_EVENT_HIT |
                                       1U << WH_EVENT_UNDECIDED | 1U << WH_EVENT_TOO_CLOSE |
                                       1U << WH_EVENT_SLIPPED | 1U << WH_EVENT_PUSHED_THROUGH;
    return (complaints >> (unsigned)kind & 1U) != 0;
}

bool wh_record_is_contact(wh_event_kind_t kind) {
    return kind == WH_EVENT_HIT || kind == WH_EVENT_UNDECIDED || kind == WH_EVENT_TOO_CLOSE;
}

bool wh_record_is_carried(const wh_event_t *event) {
    return event->kind == WH_EVENT_FAULT_ARMED && event->parts[1] == (int32_t)WH_FAULT_WAFER_PLACED;
}

/* The first expectation that was not met. Returns false if there is none. */
static bool find_unmet(const wh_record_t *record, char *reason, size_t size) {
    for (size_t i = 0; i < record->expectation_count; ++i) {
        const wh_expectation_record_t *expectation = &record->expectations[i];
        const char *text = expectation->text ? expectation->text : "not met";
        if (!expectation->ok && expectation->line > 0) {
            (void)snprintf(reason, size, "line %d: %.1000s", expectation->line, text);
        } else if (!expectation->ok) {
            (void)snprintf(reason, size, "%.1000s", text);
        }
        if (!expectation->ok) {
            return true;
        }
    }
    return false;
}

static void add_contact(const wh_record_t *record, const wh_event_t *event, char *text, size_t size) {
    const char *one = wh_layout_part_name(record->layout, event->parts[0]);
    const char *other = wh_layout_part_name(record->layout, event->parts[1]);
    (void)snprintf(text, size, ", %.200s and %.200s at %.3f s", one ? one : "a part",
                   other ? other : "others",
                   (double)((int64_t)event->slice * record->layout->slice_us) / 1e6);
}

/* The first complaint of the cell. Returns false if there is none. */
static bool find_complaint(const wh_record_t *record, char *reason, size_t size) {
    for (size_t i = 0; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        const char *name = wh_record_wafer_name(record, event->wafer);
        if (wh_record_is_complaint(event->kind)) {
            const int length = snprintf(reason, size, "the cell complained: %s%s%s",
                                        wh_event_name(event->kind), name ? ": " : "", name ? name : "");
            if (wh_record_is_contact(event->kind) && (size_t)length < size) {
                add_contact(record, event, reason + length, size - (size_t)length);
            }
            return true;
        }
    }
    return false;
}

static bool find_crowd(const wh_record_t *record, char *reason, size_t size) {
    if (record->crowded > 0) {
        (void)snprintf(reason, size, "%lld slice%s had more than %zu events, and the rest is not told",
                       (long long)record->crowded, record->crowded == 1 ? "" : "s", WH_SLICE_EVENTS);
    }
    return record->crowded > 0;
}

void wh_record_reason(const wh_record_t *record, char *reason, size_t size) {
    if (record->failure || (!find_unmet(record, reason, size) && !find_complaint(record, reason, size) &&
                            !find_crowd(record, reason, size))) {
        (void)snprintf(reason, size, "%.1000s", record->failure ? record->failure : "failed");
    }
}

void wh_record_begin_reach(wh_record_t *record, size_t stations) {
    if (!record->reach) {
        record->reach = wh_array_new(stations + 1, sizeof *record->reach);
    }
}

void wh_record_forget(wh_record_t *record) {
    for (size_t i = 0; i < record->command_count; ++i) {
        free(record->commands[i].text);
        free(record->commands[i].message);
    }
    for (size_t i = 0; i < record->expectation_count; ++i) {
        free(record->expectations[i].text);
    }
    for (size_t i = 0; i < record->implied_count; ++i) {
        free(record->implied[i].text);
    }
    for (size_t i = 0; i < record->cycle_count; ++i) {
        free(record->cycles[i].name);
    }
    for (size_t i = 0; i < record->wait_count; ++i) {
        free(record->waits[i].what);
    }
    record->command_count = record->event_count = 0;
    record->expectation_count = record->implied_count = 0;
    record->put_count = record->cycle_count = record->wait_count = record->station_event_count = 0;
    record->centring_count = record->centrings_left_out = 0;
    record->activity.interval_count = 0;
}

void wh_record_forget_old(wh_record_t *record) {
    wh_command_record_t failed = {.error = WH_OK};
    for (size_t i = 0; i < record->command_count; ++i) {
        if (record->commands[i].error != WH_OK) {
            free(failed.text);
            free(failed.message);
            failed = record->commands[i];
            record->commands[i].text = record->commands[i].message = NULL;
        }
    }
    wh_record_forget(record);
    if (failed.error != WH_OK) {
        failed.first_event = 0;
        record->commands[record->command_count++] = failed;
    }
}

void wh_record_free(wh_record_t *record) {
    wh_record_forget(record);
    free(record->commands);
    free(record->events);
    free(record->expectations);
    free(record->implied);
    free(record->puts);
    free(record->cycles);
    free(record->waits);
    free(record->station_events);
    free(record->centrings);
    free(record->dropped.puts_of);
    free(record->reach);
    free(record->wafers);
    wh_activity_free(&record->activity);
    free(record->curves);
    if (record->flow) {
        wh_flow_close(record->flow);
    }
    free(record->flow);
    free(record->script);
    free(record->failure);
    free(record->times_alone);
    free(record->never_came);
    memset(record, 0, sizeof *record);
}

const char *wh_record_wafer_name(const wh_record_t *record, int32_t wafer) {
    const wh_layout_t *layout = record->layout;
    return layout && wh_is_index(wafer, layout->wafer_count) ? layout->wafers[wafer].name : NULL;
}

const char *wh_record_gripper_name(const wh_record_t *record, int32_t gripper) {
    const wh_layout_t *layout = record->layout;
    return layout && wh_is_index(gripper, layout->machine.gripper_count) ? layout->grippers[gripper].name
                                                                         : NULL;
}

/* True if a text ends with this robot's name, which may be quoted. */
static bool ends_with(const char *text, const char *name) {
    const size_t length = strlen(name);
    const bool quoted = text[0] == '"';
    text += quoted ? 1 : 0;
    return strncmp(text, name, length) == 0 && strcmp(text + length, quoted ? "\"" : "") == 0;
}

int32_t wh_record_robot(const wh_record_t *record, const wh_command_record_t *command) {
    static const char word[] = " robot=";
    const wh_layout_t *layout = record->layout;
    const char *said = NULL;
    for (const char *next = command->text; next && (next = strstr(next, word)) != NULL;) {
        next += strlen(word);
        said = next;
    }
    for (size_t r = 0; said && layout && layout->robot_count > 1 && r < layout->robot_count; ++r) {
        if (ends_with(said, layout->robots[r].name)) {
            return (int32_t)r;
        }
    }
    return WH_NONE;
}

const char *wh_record_station_name(const wh_record_t *record, int32_t station) {
    const wh_layout_t *layout = record->layout;
    return layout && wh_is_index(station, layout->station_count) ? layout->stations[station].name : NULL;
}
