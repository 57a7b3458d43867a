#include "recorder.h"

#include "../text/array.h"

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

/* The events of the running command begin here. */
static size_t first_event(const wh_recorder_t *recorder) {
    size_t first = recorder->record->event_count;
    while (first > 0 && recorder->record->events[first - 1].command == recorder->running) {
        --first;
    }
    return first;
}

static bool cell_complained(const wh_record_t *record, size_t from) {
    bool complained = false;
    for (size_t i = from; i < record->event_count; ++i) {
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

/* A wafer that was let go is put if it lies in a slot, and nobody but the chuck there holds it. */
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
    const size_t from = first_event(recorder);
    const size_t known = record->put_count;
    if (cell_complained(record, from)) {
        return;
    }
    for (size_t i = from; i < record->event_count; ++i) {
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
    recorder->running = (int32_t)recorder->record->command_count;
    return wh_record_add_command(recorder->record, line, text, begin_s);
}

const wh_command_record_t *wh_recorder_end(wh_recorder_t *recorder, double end_s, wh_status_t error,
                                           const char *message, const wh_wafer_t wafers[]) {
    if (recorder->running == WH_NONE) {
        return NULL;
    }
    wh_command_record_t *command = &recorder->record->commands[recorder->running];
    command->end_s = end_s;
    command->error = error;
    if (error == WH_OK) {
        count_puts(recorder, wafers);
    } else {
        command->message = wh_text_copy(message);
    }
    recorder->running = WH_NONE;
    return command;
}

void wh_recorder_events(wh_recorder_t *recorder, const wh_state_t *state) {
    for (size_t i = 0; i < state->event_count; ++i) {
        wh_record_add_event(recorder->record, state->utime, recorder->running, &state->events[i]);
    }
}

void wh_recorder_slice(wh_recorder_t *recorder, const wh_command_t *command, const wh_state_t *state) {
    wh_record_t *record = recorder->record;
    recorder->slice = command->seq;
    const wh_share_t share =
        wh_activity_count(&record->activity, &recorder->layout->machine, &recorder->task, command, state);
    if (recorder->running != WH_NONE) {
        ++record->commands[recorder->running].shares[share];
    }
}

/* ------------------------------------------------------------------------------------------------ the end */

static bool is_as_wanted(const wh_record_t *record) {
    bool ok = record->failure == NULL && !cell_complained(record, 0);
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

void wh_recorder_finish(wh_recorder_t *recorder, const wh_recorder_end_t *end) {
    wh_record_t *record = recorder->record;
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
    record->checked = end->world != NULL;
    if (record->checked) {
        memcpy(record->clearances, wh_world_clearances(end->world), sizeof record->clearances);
        record->curves = wh_array_new(1, sizeof *record->curves);
        *record->curves = *wh_world_curves(end->world);
    }
    keep_wafers(recorder, end->wafers);
}
