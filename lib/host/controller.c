/* One port: its bytes in and out. */
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../text/array.h"
#include "../text/clock.h"
#include "../text/utf8.h"
#include "host.h"

int64_t wh_host_now(const wh_host_t *host) {
    const wh_track_t *track = &host->session->mcs.track;
    return host->played ? track->slice * track->slice_us + host->skipped_us : wh_clock_us(CLOCK_MONOTONIC);
}

/* --------------------------------------------------------------------------------------------- transcript */

void wh_host_note(wh_host_t *host, const wh_controller_t *controller, wh_transcript_kind_t kind,
                  const uint8_t *bytes, size_t size) {
    const wh_mcs_t *mcs = &host->session->mcs;
    const wh_transcript_entry_t entry = {
        .slice = mcs->track.slice,
        .time_us = mcs->track.slice * mcs->track.slice_us,
        .kind = kind,
        .port = controller->name,
        .bytes = bytes,
        .size = size < WH_TRANSCRIPT_BYTES ? size : WH_TRANSCRIPT_BYTES,
    };
    if (host->transcript) {
        (void)(host->writes_json ? wh_transcript_write_json : wh_transcript_write)(host->transcript, &entry);
    }
    if (host->played && !host->is_different) {
        host->is_different = !wh_transcript_compare(host->played, &entry);
    }
}

static void note(const wh_controller_t *controller, wh_transcript_kind_t kind, const uint8_t *bytes,
                 size_t size) {
    wh_host_note(controller->host, controller, kind, bytes, size);
}

/* -------------------------------------------------------------------------------------- frames on the way */

/* Frames leave in the order in which they were made. */
static void enqueue(wh_sent_t *sent, const uint8_t *bytes, size_t size, int64_t due_us) {
    wh_sent_frame_t *frame = wh_array_new(1, sizeof *frame + size);
    frame->due_us = sent->last && sent->last->due_us > due_us ? sent->last->due_us : due_us;
    frame->size = size;
    memcpy(frame->bytes, bytes, size);
    if (sent->last) {
        sent->last->next = frame;
    } else {
        sent->first = frame;
    }
    sent->last = frame;
}

/* The first one if it is due, the caller's to be freed; else null. */
static wh_sent_frame_t *take_due(wh_sent_t *sent, int64_t now_us) {
    wh_sent_frame_t *frame = sent->first;
    if (!frame || frame->due_us > now_us) {
        return NULL;
    }
    sent->first = frame->next;
    sent->last = frame->next ? sent->last : NULL;
    return frame;
}

/* A copy of a frame as chaos has left it. True if that is all of it. */
static bool enqueue_copy(wh_controller_t *controller, bool is_to_host, const uint8_t *frame, size_t size,
                         const uint8_t *left, size_t length, int64_t due_us) {
    if (is_to_host) {
        note(controller, WH_TRANSCRIPT_HEARD, left, length);
        ++controller->told;
    }
    if (!is_to_host || !controller->host->played) {
        enqueue(is_to_host ? &controller->out : &controller->in, left, length, due_us);
    }
    return length == size && memcmp(left, frame, size) == 0;
}

/* What chaos leaves of a frame of either direction. What goes to the host is noted as it is made: when it
 * arrives, a wall clock decides, and without one it arrives nowhere. */
static void enqueue_in_chaos(wh_controller_t *controller, bool is_to_host, const uint8_t *bytes, size_t size,
                             int64_t due_us, bool is_acknowledgement) {
    const wh_chaos_t *chaos = &controller->dialect.chaos;
    uint64_t *number = is_to_host ? &controller->frames_out : &controller->frames_in;
    const wh_chaos_place_t place = {controller->number, is_to_host, (*number)++};
    const wh_chaos_fate_t fate = wh_chaos_fate(chaos, place, is_acknowledgement);
    bool is_whole = false;
    for (size_t copy = 0; copy < fate.copies; ++copy) {
        uint8_t left[WH_CHAOS_BYTES];
        const size_t length = wh_chaos_garble(chaos, place, copy, bytes, size, left);
        is_whole |=
            enqueue_copy(controller, is_to_host, bytes, size, left, length, due_us + fate.later_us[copy]);
    }
    controller->broken += is_to_host && !is_whole ? 1 : 0;
}

static void drop_frames(wh_sent_t *sent) {
    while (sent->first) {
        free(take_due(sent, INT64_MAX));
    }
}

/* ---------------------------------------------------------------------------------------------- clients */

void wh_controller_forget_client(wh_controller_t *controller) {
    (void)wh_framer_init(&controller->framer, &controller->dialect.framing);
    (void)wh_framer_init(&controller->before_chaos, &controller->dialect.framing);
    drop_frames(&controller->in);
    drop_frames(&controller->out);
    wh_ring_drop(&controller->line, controller->line.count);
    free(controller->reply.text);
    controller->reply.text = NULL;
    controller->ackn_due_us = INT64_MAX;
    controller->has_gone = false;
    controller->is_left = controller->has_action;
}

/* What a client has left is told before that it went. */
static void note_going(wh_controller_t *controller) {
    if (controller->has_gone) {
        controller->has_gone = false;
        note(controller, WH_TRANSCRIPT_WENT, NULL, 0);
    }
}

static void note_port(wh_controller_t *controller, unsigned what) {
    if ((what & (WH_PORT_WENT | WH_PORT_CLOSED | WH_PORT_TAKEN)) != 0) {
        controller->has_gone = true;
    }
    if ((what & WH_PORT_CAME) != 0) {
        note_going(controller);
        wh_controller_forget_client(controller);
        note(controller, WH_TRANSCRIPT_CAME, NULL, 0);
    }
}

/* ------------------------------------------------------------------------------------------------ sending */

/* Onto the line, if it has a pace, else out. */
static void send_bytes(wh_controller_t *controller, const uint8_t *bytes, size_t size) {
    if (!controller->is_open) {
        return;
    }
    if (controller->dialect.baud == 0) {
        note_port(controller, wh_port_send(&controller->port, bytes, size));
    } else if (!wh_ring_put(&controller->line, bytes, size)) {
        controller->port.counters.lost += size;
    }
}

/* What of a paced line is through by now. */
static void send_paced(wh_controller_t *controller, int64_t now_us) {
    uint8_t bytes[4096];
    size_t through = wh_pace_take(&controller->out_pace, controller->line.count, now_us);
    while (through > 0) {
        const size_t size =
            wh_ring_take(&controller->line, bytes, through < sizeof bytes ? through : sizeof bytes);
        note_port(controller, wh_port_send(&controller->port, bytes, size));
        through -= size;
    }
}

static void send_due(wh_controller_t *controller, int64_t now_us) {
    for (wh_sent_frame_t *sent = take_due(&controller->out, now_us); sent;
         sent = take_due(&controller->out, now_us)) {
        send_bytes(controller, sent->bytes, sent->size);
        free(sent);
    }
    if (controller->dialect.baud > 0 && controller->is_open) {
        send_paced(controller, now_us);
    }
}

static void say_mistake(wh_controller_t *controller, const char *message) {
    ++controller->counters.mistakes;
    (void)fprintf(stderr, "serve: %s: %s\n", controller->name, message);
}

/* The next of a text's bodies, which begins at `*at`, as a frame; passes it. Its bytes; 0: it is none. */
static size_t take_body(const wh_controller_t *controller, const wh_reply_t *reply, size_t *at,
                        uint8_t frame[WH_FRAMING_LINE]) {
    const char *begin = reply->text + *at;
    const char *end = memchr(begin, 0, reply->size - *at);
    const size_t length = end ? (size_t)(end - begin) : reply->size - *at;
    *at += length + 1;
    return wh_framing_encode(&controller->dialect.replies, reply->start, (const uint8_t *)begin, length,
                             frame);
}

/* All of the text's bodies as frames; false, and none is sent, if one of them is none. */
static bool send_body(wh_controller_t *controller, const wh_reply_t *reply, bool is_reply) {
    uint8_t frame[WH_FRAMING_LINE];
    const int64_t due_us =
        wh_host_now(controller->host) + (is_reply ? (int64_t)(controller->dialect.ack_s * 1e6) : 0);
    for (size_t at = 0; at <= reply->size;) {
        if (take_body(controller, reply, &at, frame) == 0) {
            return false;
        }
    }
    for (size_t at = 0; at <= reply->size;) {
        const size_t bytes = take_body(controller, reply, &at, frame);
        enqueue_in_chaos(controller, true, frame, bytes, due_us, is_reply);
    }
    send_due(controller, wh_host_now(controller->host));
    return true;
}

/* What a repeated request is answered. */
static void remember(wh_controller_t *controller) {
    const wh_dialect_t *dialect = &controller->dialect;
    if (controller->remembers) {
        controller->remembers = false;
        controller->reply.text = wh_array_new(dialect->text_size + 1, 1);
        controller->reply.size = dialect->text_size;
        controller->reply.start = dialect->text_start;
        memcpy(controller->reply.text, dialect->text, dialect->text_size);
    }
}

/* Encodes and sends. False: the dialect's mistake is told, and its host nothing yet. */
static bool tell(wh_controller_t *controller, wh_encoder_t encoder, const wh_told_t *told, bool is_reply) {
    wh_dialect_t *dialect = &controller->dialect;
    const int64_t begin = wh_host_now(controller->host);
    wh_failure_t failure;
    bool made = wh_dialect_encode(dialect, encoder, told);
    if (!made && encoder == WH_ENCODE_ANSWER && wh_dialect_refused(dialect, &failure)) {
        const wh_told_t refusal = {.request = told->request, .failure = &failure};
        made = wh_dialect_encode(dialect, WH_ENCODE_REFUSE, &refusal);
    }
    controller->host->lua_us += wh_host_now(controller->host) - begin;
    if (!made) {
        say_mistake(controller, dialect->message);
        return false;
    }
    const wh_reply_t reply = {dialect->text, dialect->text_size, dialect->text_start};
    if (reply.text && !send_body(controller, &reply, is_reply)) {
        (void)snprintf(
            dialect->message, sizeof dialect->message,
            "%.300s: encode.%s: its text of %zu bytes is no body of a frame (expected none of the marks of "
            "a start or an end, and no more than framing.longest, %zu, with all that a frame has)",
            dialect->path, wh_encoder_names[encoder], reply.size, dialect->framing.longest);
        say_mistake(controller, dialect->message);
        return false;
    }
    if (reply.text) {
        remember(controller);
    }
    return true;
}

/* A mistake in an encoder is refused with error 48; one in `refuse`, too, with nothing but its code. */
void wh_controller_tell(wh_controller_t *controller, wh_encoder_t encoder, const wh_told_t *told,
                        bool is_reply) {
    wh_failure_t failure = {.number = WH_STATUS_BAD_ARGUMENT};
    const wh_request_t none = {.reference = LUA_NOREF};
    const wh_told_t refusal = {.request = told->request ? told->request : &none, .failure = &failure};
    char code[WH_DIALECT_NAME_BYTES];
    if (tell(controller, encoder, told, is_reply) || encoder == WH_ENCODE_EVENT ||
        encoder == WH_ENCODE_UNACKNOWLEDGED) {
        return;
    }
    wh_utf8_visible(failure.detail, sizeof failure.detail, controller->dialect.message);
    (void)snprintf(code, sizeof code, "%s", wh_dialect_code(&controller->dialect, failure.number));
    const wh_reply_t bare = {code, strlen(code), 0};
    ++controller->host->shown[WH_STATUS_BAD_ARGUMENT];
    if (encoder == WH_ENCODE_REFUSE || !tell(controller, WH_ENCODE_REFUSE, &refusal, is_reply)) {
        (void)send_body(controller, &bare, is_reply);
    }
}

void wh_controller_tell_again(wh_controller_t *controller, const wh_reply_t *reply) {
    if (reply->text) {
        (void)send_body(controller, reply, true);
    }
}

/* ------------------------------------------------------------------------------------------------ reading */

/* Of a frame that is too long the byte goes with it that was too many: it tells so when it is read again. */
static void take_frame(wh_controller_t *controller, const wh_frame_t *frame) {
    note(controller, frame->kind == WH_FRAME_TIMEOUT ? WH_TRANSCRIPT_TIMED_OUT : WH_TRANSCRIPT_SAID,
         frame->bytes, frame->size + (frame->is_over ? 1 : 0));
    wh_controller_take(controller, frame);
}

/* There is time for Lua in this slice, and no action was taken on that has yet to begin: what comes behind it
 * is heard while it runs. */
static bool may_hear(const wh_host_t *host) {
    return host->lua_us < WH_HOST_LUA_US && (host->running || !wh_host_next_action(host));
}

/* One frame at least out of these bytes, if there is one. Returns how many bytes were taken. */
static size_t feed(wh_controller_t *controller, const uint8_t *bytes, size_t size, int64_t now_us) {
    wh_frame_t frame = {.kind = WH_FRAME_GOOD};
    size_t at = 0;
    do {
        at += wh_framer_feed(&controller->framer, bytes + at, size - at, now_us, &frame);
        if (frame.kind != WH_FRAME_NONE) {
            take_frame(controller, &frame);
        }
    } while (frame.kind != WH_FRAME_NONE && may_hear(controller->host));
    return at;
}

/* The same of a line with chaos: whole frames meet it, then the controller hears what is left. */
static size_t feed_chaos(wh_controller_t *controller, const uint8_t *bytes, size_t size, int64_t now_us) {
    wh_frame_t frame = {.kind = WH_FRAME_GOOD};
    size_t at = 0;
    while (frame.kind != WH_FRAME_NONE) {
        at += wh_framer_feed(&controller->before_chaos, bytes + at, size - at, now_us, &frame);
        if (frame.kind != WH_FRAME_NONE) {
            enqueue_in_chaos(controller, false, frame.bytes, frame.size, now_us, false);
        }
    }
    return at;
}

static void hear_due(wh_controller_t *controller, int64_t now_us) {
    wh_frame_t frame;
    if (wh_framer_wait(&controller->before_chaos, now_us, &frame)) {
        enqueue_in_chaos(controller, false, frame.bytes, frame.size, now_us, false);
    }
    while (may_hear(controller->host)) {
        wh_sent_frame_t *sent = take_due(&controller->in, now_us);
        if (!sent) {
            break;
        }
        for (size_t at = 0; at < sent->size;) { /* these bytes are heard whole */
            at += feed(controller, sent->bytes + at, sent->size - at, now_us);
        }
        free(sent);
    }
}

static void read_frames(wh_controller_t *controller, int64_t now_us) {
    const bool has_chaos = wh_chaos_is_on(&controller->dialect.chaos);
    wh_ring_t *input = &controller->port.input;
    const bool is_paced = controller->dialect.baud > 0;
    size_t most = is_paced ? wh_pace_take(&controller->in_pace, input->count, now_us) : input->count;
    wh_frame_t frame;
    for (size_t taken = 1; most > 0 && taken > 0 && may_hear(controller->host); most -= taken) {
        size_t size = 0;
        const uint8_t *bytes = wh_ring_front(input, &size);
        size = size < most ? size : most;
        taken = (has_chaos ? feed_chaos : feed)(controller, bytes, size, now_us);
        wh_ring_drop(input, taken);
    }
    hear_due(controller, now_us);
    if (wh_framer_wait(&controller->framer, now_us, &frame)) {
        take_frame(controller, &frame);
    }
}

static void serve_port(wh_controller_t *controller) {
    wh_frame_t frame;
    note_port(controller, wh_port_serve(&controller->port));
    read_frames(controller, wh_host_now(controller->host));
    if (!controller->has_gone || controller->port.input.count > 0) {
        return;
    }
    if (wh_framer_finish(&controller->framer, &frame)) {
        take_frame(controller, &frame);
    }
    note_going(controller);
}

/* What was told as one frame is one again. True, and the frame, if it is one. */
static bool frame_again(wh_controller_t *controller, const wh_transcript_entry_t *entry, size_t *taken,
                        wh_frame_t *frame) {
    const int64_t now = wh_host_now(controller->host);
    const bool timed_out = entry->kind == WH_TRANSCRIPT_TIMED_OUT;
    const int64_t later = now + controller->dialect.framing.timeout_us;
    *taken = wh_framer_feed(&controller->framer, entry->bytes, entry->size, now, frame);
    return frame->kind != WH_FRAME_NONE || (timed_out && wh_framer_wait(&controller->framer, later, frame)) ||
           wh_framer_finish(&controller->framer, frame);
}

/* What followed a line that was too long is no entry: an end stands for it. */
void wh_controller_hear(wh_controller_t *controller, const wh_transcript_entry_t *entry) {
    const wh_framing_mark_t *end = &controller->dialect.framing.ends[0];
    size_t at = 0;
    wh_frame_t frame = {.kind = WH_FRAME_NONE};
    if (entry->kind == WH_TRANSCRIPT_CAME) {
        wh_controller_forget_client(controller);
    }
    if (entry->kind == WH_TRANSCRIPT_ELAPSED) {
        wh_controller_give_up_waiting(controller);
        return;
    }
    if (entry->kind != WH_TRANSCRIPT_SAID && entry->kind != WH_TRANSCRIPT_TIMED_OUT) {
        note(controller, entry->kind, NULL, 0);
        return;
    }
    if (!frame_again(controller, entry, &at, &frame)) {
        return;
    }
    const bool is_over = frame.is_over;
    const int64_t now = wh_host_now(controller->host);
    take_frame(controller, &frame);
    while (at < entry->size && !is_over) { /* such as the second byte of an end */
        at += wh_framer_feed(&controller->framer, entry->bytes + at, entry->size - at, now, &frame);
    }
    if (is_over) {
        (void)wh_framer_feed(&controller->framer, end->bytes, end->size, now, &frame);
    }
}

void wh_controller_serve(wh_controller_t *controller) {
    if (controller->is_open) {
        serve_port(controller);
    }
    if (!controller->host->played) { /* else the transcript tells when a time is over */
        wh_controller_tick(controller);
    }
    send_due(controller, wh_host_now(controller->host));
}

int64_t wh_controller_due(const wh_controller_t *controller) {
    int64_t due = wh_framer_due(&controller->framer);
    const int64_t now = wh_host_now(controller->host);
    const bool is_open = controller->is_open;
    const int64_t others[] = {controller->out.first ? controller->out.first->due_us : INT64_MAX,
                              controller->in.first ? controller->in.first->due_us : INT64_MAX,
                              wh_framer_due(&controller->before_chaos),
                              controller->ackn_due_us,
                              controller->port.input.count > 0 ? now + 1000 : INT64_MAX,
                              controller->line.count > 0 ? now + 1000 : INT64_MAX,
                              controller->has_action ? now + 1000 : INT64_MAX,
                              is_open && wh_port_asks(&controller->port) ? now + WH_PORT_ASK_US : INT64_MAX};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        due = others[i] < due ? others[i] : due;
    }
    return due;
}
