#include "events_live.h"

#include <inttypes.h>
#include <stdio.h>

#include "../link/node.h"
#include "../record/seat.h"
#include "../wire/messages.h"
#include "app.h"
#include "connection.h"

/* How long a signal may have to wait, us. */
#define WAIT_US 100000

typedef struct {
    const wh_events_live_t *live;
    wh_told_layout_t cell;
    wh_link_arrays_t arrays;
    wh_record_t record;
    int64_t run, seq;
    int64_t runs; /* heard so far */
    bool ended;
} ear_t;

static void on_cell(void *user, const void *data, size_t size) {
    ear_t *ear = user;
    const wh_told_layout_options_t nothing = {NULL, NULL, 0};
    waferhand_cell message;
    if (!wh_link_decode_cell(data, size, &message)) {
        return;
    }
    if (!ear->cell.layout || ear->cell.hash != (uint64_t)message.layout_hash) {
        wh_told_layout_free(&ear->cell);
        if (wh_told_layout_make(&ear->cell, &message, &nothing)) {
            ear->ended = ear->ended || !ear->live->cell(ear->live->user, &ear->cell);
        }
    }
    (void)waferhand_cell_decode_cleanup(&message);
}

/* True if the slice was not heard before. */
static bool is_news(ear_t *ear, const waferhand_state *message) {
    const bool same_run = message->run == ear->run;
    if (same_run && message->seq > ear->seq + 1) {
        fprintf(stderr, "events: slices %" PRId64 " to %" PRId64 " were not heard\n", ear->seq + 1,
                message->seq - 1);
    }
    const bool news = !same_run || message->seq > ear->seq;
    ear->runs += ear->runs == 0 || !same_run ? 1 : 0;
    ear->run = message->run;
    ear->seq = news ? message->seq : ear->seq;
    return news;
}

/* A state of a run that was not heard before. */
static void tell_run(ear_t *ear, int64_t before, int64_t utime) {
    if (before > 0 && ear->runs > before && !ear->ended) {
        ear->ended = !ear->live->run(ear->live->user, ear->runs, utime);
    }
}

static void tell_state(ear_t *ear, const wh_state_t *state) {
    ear->record.layout = ear->cell.layout;
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_seat_t seat = wh_seat_of(ear->cell.layout, state, &state->events[i]);
        wh_record_add_event(&ear->record, state->utime, WH_NONE, &state->events[i], &seat);
    }
    for (size_t i = 0; !ear->ended && i < ear->record.event_count; ++i) {
        ear->ended = !ear->live->event(ear->live->user, &ear->record, i);
    }
    wh_record_forget(&ear->record);
}

static void on_state(void *user, const void *data, size_t size) {
    ear_t *ear = user;
    const int64_t runs = ear->runs;
    waferhand_state message;
    wh_state_t state;
    if (!wh_link_decode_state(data, size, &message)) {
        return;
    }
    if (ear->cell.layout && ear->cell.hash == (uint64_t)message.layout_hash && message.seq > 0 &&
        wh_link_state_is_sound(&message, ear->cell.layout, &ear->arrays, &state) && is_news(ear, &message)) {
        tell_run(ear, runs, state.utime);
        tell_state(ear, &state);
    }
    (void)waferhand_state_decode_cleanup(&message);
}

static int listen(wh_node_t *node, ear_t *ear) {
    int handled = 0;
    if (!wh_node_subscribe(node, WH_CHANNEL_CELL, on_cell, ear) ||
        !wh_node_subscribe(node, WH_CHANNEL_STATE, on_state, ear)) {
        fputs("events: LCM has no room\n", stderr);
        return WH_EXIT_USAGE;
    }
    while (!wh_stop_requested && !ear->ended && handled >= 0) {
        handled = wh_node_wait(node, WAIT_US);
    }
    return ear->ended ? WH_EXIT_USAGE : handled < 0 ? WH_EXIT_FAILED : WH_EXIT_MET;
}

int wh_events_live(const wh_events_live_t *live) {
    static ear_t ear;
    wh_node_t node;
    ear.live = live;
    wh_catch_signals();
    if (!wh_node_reaches_others(live->url) || !wh_node_open(&node, live->url, NULL)) {
        return WH_EXIT_USAGE;
    }
    const int status = listen(&node, &ear);
    wh_node_close(&node);
    wh_record_free(&ear.record);
    wh_told_layout_free(&ear.cell);
    return status;
}
