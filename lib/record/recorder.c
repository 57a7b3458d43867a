#include "recorder.h"

#include "../text/array.h"
#include "dropped.h"
#include "seat.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void wh_recorder_open(wh_recorder_t *recorder, wh_record_t *record, const char *script) {
    memset(recorder, 0, sizeof *recorder);
    recorder->record = record;
    recorder->running = WH_NONE;
    record->script = wh_text_copy(script);
}

double wh_recorder_now(const wh_recorder_t *recorder) {
    return recorder->layout ? (double)(recorder->slice * recorder->layout->slice_us) / 1e6 : 0;
}

/* ------------------------------------------------------------------------------------------------- wafers */

static bool cell_complained(const wh_record_t *record) {
    bool complained = false;
    for (size_t i = 0; i < record->event_count; ++i) {
        complained = complained || wh_record_is_complaint(record->events[i].event.kind);
    }
    return complained;
}

/* The index of the running command's next event from `i` on, or the number of all events. */
static size_t next_event(const wh_recorder_t *recorder, size_t i) {
    const wh_record_t *record = recorder->record;
    while (i < record->event_count && record->events[i].command != recorder->running) {
        ++i;
    }
    return i;
}

static bool complained_of_command(const wh_recorder_t *recorder, size_t from) {
    const wh_record_t *record = recorder->record;
    bool complained = false;
    for (size_t i = next_event(recorder, from); i < record->event_count; i = next_event(recorder, i + 1)) {
        complained = complained || wh_record_is_complaint(record->events[i].event.kind);
    }
    return complained;
}

static bool is_known(const wh_record_t *record, size_t first, int32_t wafer) {
    bool known = false;
    for (size_t i = first; i < record->put_count; ++i) {
        known = known || record->puts[i].wafer == wafer;
    }
    return known;
}

/* A released wafer is put if it lies in a slot and only the chuck there may hold it. */
static void add_put(wh_recorder_t *recorder, int32_t w, const wh_wafer_t *wafer) {
    wh_place_t place;
    if (wh_cell_locate(recorder->cell, &wafer->base_from_wafer, &place) &&
        (wafer->holder == WH_NONE || wafer->holder == recorder->layout->places[place.station].chuck)) {
        wh_record_add_put(recorder->record,
                          &(wh_put_record_t){w, place.station, place.slot, recorder->slice});
    }
}

static void count_puts(wh_recorder_t *recorder, const wh_wafer_t wafers[]) {
    wh_record_t *record = recorder->record;
    const size_t from = record->commands[recorder->running].first_event;
    const size_t known = record->put_count;
    if (complained_of_command(recorder, from)) {
        return;
    }
    for (size_t i = next_event(recorder, from); i < record->event_count; i = next_event(recorder, i + 1)) {
        const wh_event_t *event = &record->events[i].event;
        const bool let_go = event->kind == WH_EVENT_RELEASED || event->kind == WH_EVENT_HANDED_OVER;
        if (let_go && !is_known(record, known, event->wafer)) {
            add_put(recorder, event->wafer, &wafers[event->wafer]);
        }
    }
}

/* ------------------------------------------------------------------------------------ commands and slices */

const wh_command_record_t *wh_recorder_begin(wh_recorder_t *recorder, int line, const char *text,
                                             double begin_s) {
    wh_record_t *record = recorder->record;
    wh_command_record_t *command = record->dropped.is_wanted
                                       ? wh_dropped_begin(record, recorder->layout, line, text, begin_s)
                                       : wh_record_add_command(record, line, text, begin_s);
    recorder->running = (int32_t)(command - record->commands);
    recorder->joined.count = 0; /* it may have the place of one that is over */
    command->task = recorder->number;
    return command;
}

const wh_command_record_t *wh_recorder_end(wh_recorder_t *recorder, double end_s, wh_status_t error,
                                           const char *message, const wh_wafer_t wafers[]) {
    if (recorder->running == WH_NONE) {
        return NULL;
    }
    wh_command_record_t *command = &recorder->record->commands[recorder->running];
    command->end_s = end_s;
    command->error = error;
    command->is_over = true;
    recorder->record->counted.commands += command->is_counted ? 1 : 0;
    if (error == WH_OK && !wh_record_is_teaching(recorder->record, recorder->running)) {
        count_puts(recorder, wafers);
    } else if (error != WH_OK) {
        command->message = wh_text_copy(message);
    }
    recorder->running = WH_NONE;
    return command;
}

/* The running command that began first; WH_NONE: none runs. */
static int32_t first_command(const wh_recorder_t *recorder) {
    const wh_command_record_t *commands = recorder->record->commands;
    int32_t first = WH_NONE;
    for (size_t i = 0; i < recorder->part_count; ++i) {
        const int32_t command = recorder->parts[i].command;
        const bool is_earlier =
            command != WH_NONE && (first == WH_NONE || commands[command].number < commands[first].number);
        first = is_earlier ? command : first;
    }
    return first;
}

/* The command that has the gripper; otherwise a running one. */
static int32_t command_of(const wh_recorder_t *recorder, const wh_event_t *event) {
    for (size_t i = 0; event->gripper != WH_NONE && i < recorder->part_count; ++i) {
        if ((recorder->parts[i].grippers >> event->gripper & 1U) != 0) {
            return recorder->parts[i].command;
        }
    }
    return recorder->part_count > 0 ? first_command(recorder) : recorder->running;
}

void wh_recorder_events(wh_recorder_t *recorder, const wh_state_t *state) {
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_event_t *event = &state->events[i];
        const wh_seat_t seat = wh_seat_of(recorder->layout, state, event);
        wh_record_add_event(recorder->record, state->utime, command_of(recorder, event), event, &seat);
    }
    recorder->record->crowded += state->has_lost_events ? 1 : 0;
}

/* Adds another task's demands on the machine; the share stays. */
static void join(wh_task_t *all, const wh_task_t *task) {
    all->moves = all->moves || task->moves;
    all->robot = all->robot || task->robot;
    all->carried |= task->carried;
    all->doors |= task->doors;
    for (size_t r = 0; r < WH_BUSY_ROBOTS; ++r) {
        all->robots[r] = all->robots[r] != 0 ? all->robots[r] : task->robots[r];
    }
}

/* Each command has the share of its own segment. If the robot stands still, its command gives the share of
 * all; if no command has the robot, the first command does. */
static void join_parts(wh_recorder_t *recorder, const wh_state_t *state) {
    wh_recorder_joined_t *joined = &recorder->joined;
    const int32_t first = first_command(recorder);
    wh_task_t all = {.share = WH_SHARE_WAITING};
    for (size_t i = 0; i < recorder->part_count; ++i) {
        const wh_recorder_part_t *part = &recorder->parts[i];
        const bool tells = part->task.robot || (!all.robot && part->command == first && first != WH_NONE);
        all.share = tells ? part->task.share : all.share;
        join(&all, &part->task);
        joined->shares[i] = (uint8_t)wh_activity_share(&part->task, state);
    }
    joined->all = all;
    joined->count = recorder->part_count;
    memcpy(joined->parts, recorder->parts, recorder->part_count * sizeof recorder->parts[0]);
    for (size_t g = 0; g < state->gripper_count; ++g) {
        joined->held[g] = state->grippers[g].wafer;
    }
}

/* True if parts and wafers are those of the last slice. */
static bool are_joined(const wh_recorder_t *recorder, const wh_state_t *state) {
    const wh_recorder_joined_t *joined = &recorder->joined;
    bool same = joined->count == recorder->part_count &&
                memcmp(joined->parts, recorder->parts, joined->count * sizeof joined->parts[0]) == 0;
    for (size_t g = 0; same && g < state->gripper_count; ++g) {
        same = joined->held[g] == state->grippers[g].wafer;
    }
    return same;
}

/* If several commands run at once, each has one slice. */
static void count_parts(wh_recorder_t *recorder, const wh_state_t *state) {
    if (!are_joined(recorder, state)) {
        join_parts(recorder, state);
    }
    for (size_t i = 0; i < recorder->part_count; ++i) {
        const int32_t command = recorder->parts[i].command;
        if (command != WH_NONE) {
            ++recorder->record->commands[command].shares[recorder->joined.shares[i]];
        }
    }
    recorder->task = recorder->joined.all;
}

void wh_recorder_slice(wh_recorder_t *recorder, const wh_command_t *command, const wh_state_t *state) {
    wh_record_t *record = recorder->record;
    recorder->slice = command->seq;
    if (recorder->part_count > 0) {
        count_parts(recorder, state);
    }
    const wh_share_t share =
        wh_activity_count(&record->activity, &recorder->layout->machine, &recorder->task, command, state);
    if (recorder->running != WH_NONE && recorder->part_count == 0) {
        ++record->commands[recorder->running].shares[share];
    }
}

void wh_recorder_repeat(wh_recorder_t *recorder, int64_t slices, const wh_state_t *state) {
    wh_record_t *record = recorder->record;
    recorder->slice += slices;
    wh_activity_repeat(&record->activity, slices);
    for (size_t i = 0; i < recorder->part_count; ++i) {
        const wh_recorder_part_t *part = &recorder->parts[i];
        if (part->command != WH_NONE) {
            record->commands[part->command].shares[wh_activity_share(&part->task, state)] += slices;
            record->commands[part->command].is_counted = true;
        }
    }
    if (recorder->running != WH_NONE && recorder->part_count == 0) {
        record->commands[recorder->running].shares[record->activity.last.share] += slices;
        record->commands[recorder->running].is_counted = true;
    }
}

/* -------------------------------------------------------------------------------------------------- waits */

/* The open wait of the running task, or the number of all waits. */
static size_t find_wait(const wh_recorder_t *recorder) {
    const wh_record_t *record = recorder->record;
    size_t i = record->wait_count;
    while (i > 0 && !(record->waits[i - 1].is_open && record->waits[i - 1].task == recorder->number)) {
        --i;
    }
    return i > 0 ? i - 1 : record->wait_count;
}

static void end_wait(wh_recorder_t *recorder, size_t i) {
    wh_record_t *record = recorder->record;
    wh_wait_record_t *wait = &record->waits[i];
    wait->is_open = false;
    wait->end = recorder->slice;
    if (wait->end == wait->begin || record->dropped.is_wanted) {
        free(wait->what);
        --record->wait_count;
        memmove(wait, wait + 1, (record->wait_count - i) * sizeof *wait);
    }
}

void wh_recorder_go_on(wh_recorder_t *recorder) {
    const size_t i = find_wait(recorder);
    if (i < recorder->record->wait_count) {
        end_wait(recorder, i);
    }
}

void wh_recorder_wait(wh_recorder_t *recorder, const char *what) {
    wh_record_t *record = recorder->record;
    const size_t i = find_wait(recorder);
    if (i == record->wait_count || strcmp(record->waits[i].what, what) != 0) {
        wh_recorder_go_on(recorder);
        wh_record_add_wait(record, recorder->number, recorder->running, what, recorder->slice);
    }
}

/* ------------------------------------------------------------------------------------------------ the end */

static bool is_as_wanted(const wh_record_t *record) {
    bool ok = record->failure == NULL && !cell_complained(record) && record->crowded == 0;
    for (size_t i = 0; i < record->expectation_count; ++i) {
        ok = ok && record->expectations[i].ok;
    }
    return ok;
}

static void keep_wafers(wh_recorder_t *recorder, const wh_wafer_t wafers[]) {
    const size_t count = recorder->layout->wafer_count;
    wh_wafer_record_t *kept = wh_array_new(count, sizeof *kept);
    for (size_t w = 0; w < count; ++w) {
        kept[w].base_from_wafer = wafers[w].base_from_wafer;
        kept[w].holder = wafers[w].holder;
        if (!wh_cell_locate(recorder->cell, &wafers[w].base_from_wafer, &kept[w].place)) {
            kept[w].place.station = WH_NONE;
        }
    }
    recorder->record->wafers = kept;
}

/* The names of the robots that are times alone; null: there are none. */
static char *name_timed(const wh_flow_tool_t *timed) {
    char *text = NULL;
    size_t size = 0;
    if (!timed) {
        return NULL;
    }
    FILE *out = wh_memory_need(open_memstream(&text, &size));
    for (size_t r = 0; r < timed->robot_count; ++r) {
        fprintf(out, "%s%s", r > 0 ? ", " : "", timed->robots[r].name);
    }
    (void)fclose(out);
    return text;
}

void wh_recorder_finish(wh_recorder_t *recorder, const wh_recorder_end_t *end) {
    wh_record_t *record = recorder->record;
    for (size_t i = record->wait_count; i > 0; --i) {
        if (record->waits[i - 1].is_open) {
            end_wait(recorder, i - 1);
        }
    }
    record->ok = is_as_wanted(record);
    record->layout = recorder->layout;
    if (!recorder->layout) {
        return;
    }
    record->slices = recorder->slice;
    wh_activity_end(&record->activity, record->slices);
    record->simulated_s = wh_recorder_now(recorder);
    record->hash = end->hash;
    record->missed = end->missed;
    if (record->flow && record->flow->figures.tool && !record->flow->is_played) {
        record->hash = record->flow->figures.hash;
        record->simulated_s = (double)record->flow->figures.end_us / 1e6;
    }
    record->times_alone = name_timed(recorder->layout->timed);
    record->unlooked = recorder->layout->tool        ? WH_RECORD_TIMES_ALONE
                       : recorder->layout->collision ? NULL
                                                     : WH_RECORD_UNLOOKED;
    record->checked = end->world != NULL;
    if (record->checked) {
        memcpy(record->clearances, wh_world_clearances(end->world), sizeof record->clearances);
        record->curves = wh_array_new(1, sizeof *record->curves);
        wh_world_copy_curves(end->world, record->curves);
    }
    keep_wafers(recorder, end->wafers);
}
