#include "reading.h"

#include <stdlib.h>

#include "../text/clock.h"
#include "events.h"
#include "journal.h"
#include "line.h"
#include "queue.h"
#include "requests.h"
#include "status.h"
#include "telling.h"

/* A frame that is too long is noted with the one byte that was too many. When it is read again, this byte
 * makes it too long again. */
static void take_frame(wh_controller_t *controller, const wh_frame_t *frame) {
    wh_host_note(controller->host, controller,
                 frame->kind == WH_FRAME_TIMEOUT ? WH_TRANSCRIPT_TIMED_OUT : WH_TRANSCRIPT_SAID, frame->bytes,
                 frame->size + (frame->is_over ? 1 : 0));
    wh_controller_take(controller, frame);
}

/* True if the client of this line waits for an answer of any of its units. */
static bool line_owes(const wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    bool owes = false;
    for (size_t i = 0; i < host->count && !owes; ++i) {
        owes = host->controllers[i]->carrier == controller && wh_controller_owes(host->controllers[i]);
    }
    return owes;
}

/* True if an action of any unit of this line has not ended. */
static bool line_acts(const wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    bool acts = false;
    for (size_t i = 0; i < host->count && !acts; ++i) {
        acts = host->controllers[i]->carrier == controller && host->controllers[i]->action.is_there;
    }
    return acts;
}

/* True if there is time for Lua in this slice, and no accepted action has yet to begin: frames behind such an
 * action are heard while it runs. Where answers come in order, nothing is heard before the last is told. */
static bool may_hear(const wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    const bool is_parked = controller->dialect->clients.in_order && line_owes(controller);
    return host->clock.lua_us < WH_HOST_LUA_US && (host->running || !wh_host_next_action(host)) &&
           !is_parked && !controller->line.closes;
}

/* Takes at least one frame out of these bytes, if there is one. Returns how many bytes were taken. */
static size_t feed_bytes(wh_controller_t *controller, const uint8_t *bytes, size_t size, int64_t now_us) {
    wh_frame_t frame = {.kind = WH_FRAME_GOOD};
    size_t at = 0;
    do {
        at += wh_framer_feed(&controller->line.framer, bytes + at, size - at, now_us, &frame);
        if (frame.kind != WH_FRAME_NONE) {
            take_frame(controller, &frame);
        }
    } while (frame.kind != WH_FRAME_NONE && may_hear(controller));
    return at;
}

/* Feeds a line with chaos: chaos changes whole frames, then the controller hears the bytes that are left. */
static size_t feed_chaos(wh_controller_t *controller, const uint8_t *bytes, size_t size, int64_t now_us) {
    wh_frame_t frame = {.kind = WH_FRAME_GOOD};
    size_t at = 0;
    while (frame.kind != WH_FRAME_NONE) {
        at += wh_framer_feed(&controller->line.before_chaos, bytes + at, size - at, now_us, &frame);
        if (frame.kind != WH_FRAME_NONE) {
            wh_controller_enqueue(controller, false, frame.bytes, frame.size, now_us, false);
        }
    }
    return at;
}

static void hear_due(wh_controller_t *controller, int64_t now_us) {
    wh_frame_t frame;
    if (wh_framer_wait(&controller->line.before_chaos, now_us, &frame)) {
        wh_controller_enqueue(controller, false, frame.bytes, frame.size, now_us, false);
    }
    while (may_hear(controller)) {
        wh_sent_frame_t *sent = wh_sent_take_due(&controller->line.in, now_us);
        if (!sent) {
            break;
        }
        for (size_t at = 0; at < sent->size;) { /* these bytes are heard whole */
            at += feed_bytes(controller, sent->bytes + at, sent->size - at, now_us);
        }
        free(sent);
    }
}

static void read_frames(wh_controller_t *controller, int64_t now_us) {
    const bool has_chaos = wh_chaos_is_on(&controller->dialect->chaos);
    wh_ring_t *input = &controller->line.port.input;
    const bool is_paced = controller->dialect->timing.baud > 0;
    size_t most = is_paced ? wh_pace_take(&controller->line.in_pace, input->count, now_us) : input->count;
    wh_frame_t frame;
    for (size_t taken = 1; most > 0 && taken > 0 && may_hear(controller); most -= taken) {
        size_t size = 0;
        const uint8_t *bytes = wh_ring_front(input, &size);
        size = size < most ? size : most;
        taken = (has_chaos ? feed_chaos : feed_bytes)(controller, bytes, size, now_us);
        wh_ring_drop(input, taken);
    }
    hear_due(controller, now_us);
    if (wh_framer_wait(&controller->line.framer, now_us, &frame)) {
        take_frame(controller, &frame);
    }
}

/* Nothing is on its way to the client or from it, and no answer is to come. */
static bool owes_nothing(const wh_controller_t *controller) {
    return !line_acts(controller) && !line_owes(controller) && !controller->line.has_gone &&
           !controller->line.out.first && !controller->line.in.first && controller->line.waiting.count == 0;
}

/* Reads the bytes of an entry as one frame again. True, with the frame, if they are one. */
static bool frame_again(wh_controller_t *controller, const wh_transcript_entry_t *entry, size_t *taken,
                        wh_frame_t *frame) {
    const int64_t now = wh_host_now(controller->host);
    const bool timed_out = entry->kind == WH_TRANSCRIPT_TIMED_OUT;
    const int64_t later = now + controller->dialect->framing.timeout_us;
    *taken = wh_framer_feed(&controller->line.framer, entry->bytes, entry->size, now, frame);
    return frame->kind != WH_FRAME_NONE ||
           (timed_out && wh_framer_wait(&controller->line.framer, later, frame)) ||
           wh_framer_finish(&controller->line.framer, frame);
}

/* Hears the frame of a transcript's entry. The bytes behind a line that was too long have no entry: the line
 * ends there. */
static void hear_entry(wh_controller_t *controller, const wh_transcript_entry_t *entry) {
    size_t at = 0;
    wh_frame_t frame = {.kind = WH_FRAME_NONE};
    if (!frame_again(controller, entry, &at, &frame)) {
        return;
    }
    const bool is_over = frame.is_over;
    const int64_t now = wh_host_now(controller->host);
    take_frame(controller, &frame);
    while (at < entry->size && !is_over) { /* such as the second byte of an end */
        at += wh_framer_feed(&controller->line.framer, entry->bytes + at, entry->size - at, now, &frame);
    }
    if (is_over) {
        (void)wh_framer_finish(&controller->line.framer, &frame);
    }
}

/* Tells the dialect of each unit of a line of a client that has gone, and of one that has come. */
static void heed_clients(wh_controller_t *controller, bool has_come) {
    const wh_host_t *host = controller->host;
    const bool is_parting = controller->line.is_parting;
    controller->line.is_parting = false;
    for (size_t i = 0; i < host->count && is_parting; ++i) {
        if (host->controllers[i]->carrier == controller) {
            wh_controller_part(host->controllers[i]);
        }
    }
    if (is_parting) {
        wh_host_tell_modes(controller->host);
    }
    for (size_t i = 0; i < host->count && has_come; ++i) {
        wh_controller_t *unit = host->controllers[i];
        if (unit->carrier == controller) {
            unit->line.client = ++unit->leader->guests;
            wh_controller_greet(unit);
        }
    }
}

/* A port that tells all gives whole frames, and says when a wait is over. */
static void heed_told(wh_controller_t *controller, unsigned what) {
    wh_controller_note_going(controller);
    if ((what & WH_PORT_ELAPSED) != 0) {
        wh_controller_give_up_waiting(controller);
    }
    if ((what & WH_PORT_FRAME) != 0) {
        hear_entry(controller, controller->line.port.entry);
    }
}

/* Hears the rest that a client had sent without an end before it went. */
static void hear_rest(wh_controller_t *controller) {
    wh_frame_t frame;
    if (wh_framer_finish(&controller->line.framer, &frame)) {
        take_frame(controller, &frame);
    }
}

static unsigned serve_port(wh_controller_t *controller) {
    wh_port_t *port = &controller->line.port;
    port->slice = wh_session_slice(controller->host->session);
    const unsigned what = wh_port_serve(port);
    if ((what & WH_PORT_CAME) != 0 && !port->tells_all) { /* the next client is there already */
        hear_rest(controller);
    }
    wh_controller_note_port(controller, what);
    heed_clients(controller, (what & WH_PORT_CAME) != 0);
    if (port->tells_all) {
        heed_told(controller, what);
        heed_clients(controller, false);
        return what;
    }
    read_frames(controller, wh_host_now(controller->host));
    if (!controller->line.has_gone || port->input.count > 0) {
        return what;
    }
    hear_rest(controller);
    wh_controller_note_going(controller);
    heed_clients(controller, false);
    return what;
}

/* Closes a client whose last answer is on its way. */
static void hang_up(wh_controller_t *controller) {
    wh_port_line_t *line = &controller->line;
    if (line->closes && line->is_open && !line->out.first && line->waiting.count == 0 &&
        !line_owes(controller)) {
        wh_controller_note_port(controller, wh_port_hang_up(&line->port));
    }
}

/* When a silent client is to be closed; never while a command runs or an answer is on its way. */
static int64_t idle_due(const wh_controller_t *controller) {
    const bool counts = controller->line.is_open && controller->dialect->timing.idle_s > 0 &&
                        wh_port_is_heard(&controller->line.port) && owes_nothing(controller);
    return counts ? controller->line.heard_us + (int64_t)(controller->dialect->timing.idle_s * 1e6)
                  : INT64_MAX;
}

static void end_idle(wh_controller_t *controller) {
    const wh_port_counters_t *counters = &controller->line.port.counters;
    const uint64_t heard = counters->received + counters->sent + counters->clients;
    if (heard != controller->line.heard) {
        controller->line.heard = heard;
        controller->line.heard_us = wh_clock_us(CLOCK_MONOTONIC);
    } else if (idle_due(controller) <= wh_clock_us(CLOCK_MONOTONIC)) {
        wh_controller_note_port(controller, wh_port_end_idle(&controller->line.port));
    }
}

unsigned wh_controller_serve(wh_controller_t *controller) {
    unsigned what = 0;
    if (controller->line.is_open) {
        what = serve_port(controller);
        end_idle(controller);
    }
    if (!controller->line.port.tells_all) {
        wh_controller_tick(controller);
    }
    wh_controller_send_due(controller, wh_host_now(controller->host));
    hang_up(controller);
    if (controller->line.is_open && owes_nothing(controller)) {
        wh_port_end_done(&controller->line.port);
    }
    return what;
}

static int64_t frame_due(const wh_sent_t *sent) {
    return sent->first ? sent->first->due_us : INT64_MAX;
}

static int64_t port_due(const wh_port_t *port, int64_t now) {
    if (port->tells_all) {
        return now;
    }
    return wh_port_asks(port) ? now + WH_PORT_ASK_US : INT64_MAX;
}

int64_t wh_controller_due(const wh_controller_t *controller) {
    const wh_port_line_t *line = &controller->line;
    int64_t due = wh_framer_due(&line->framer);
    const int64_t now = wh_host_now(controller->host);
    const bool is_busy = line->port.input.count > 0 || line->waiting.count > 0 || controller->action.is_there;
    const int64_t others[] = {frame_due(&line->out),
                              frame_due(&line->in),
                              wh_framer_due(&line->before_chaos),
                              controller->owed.due_us,
                              idle_due(controller),
                              is_busy ? now + 1000 : INT64_MAX,
                              line->is_open ? port_due(&line->port, now) : INT64_MAX};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        due = others[i] < due ? others[i] : due;
    }
    return due;
}
