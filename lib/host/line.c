#include "line.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "journal.h"
#include "queue.h"

static void note_line(const wh_controller_t *controller, wh_transcript_kind_t kind, const uint8_t *bytes,
                      size_t size) {
    wh_host_note(controller->host, controller, kind, bytes, size);
}

/* -------------------------------------------------------------------------------------- frames on the way */

/* Frames leave in the order in which they were made. */
static void append_frame(wh_sent_t *sent, const uint8_t *bytes, size_t size, int64_t due_us) {
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

wh_sent_frame_t *wh_sent_take_due(wh_sent_t *sent, int64_t now_us) {
    wh_sent_frame_t *frame = sent->first;
    if (!frame || frame->due_us > now_us) {
        return NULL;
    }
    sent->first = frame->next;
    sent->last = frame->next ? sent->last : NULL;
    return frame;
}

/* A copy of a frame after chaos. True if the copy is whole. */
static bool enqueue_copy(wh_controller_t *controller, bool is_to_host, const uint8_t *frame, size_t size,
                         const uint8_t *left, size_t length, int64_t due_us) {
    wh_port_line_t *line = &controller->carrier->line;
    if (is_to_host) {
        note_line(controller, WH_TRANSCRIPT_HEARD, left, length);
        ++controller->line.told;
    }
    append_frame(is_to_host ? &line->out : &line->in, left, length, due_us);
    return length == size && memcmp(left, frame, size) == 0;
}

void wh_controller_enqueue(wh_controller_t *controller, bool is_to_host, const uint8_t *bytes, size_t size,
                           int64_t due_us, bool is_acknowledgement) {
    const wh_chaos_t *chaos = &controller->dialect->chaos;
    uint64_t *number = is_to_host ? &controller->line.frames_out : &controller->line.frames_in;
    const wh_chaos_place_t place = {controller->number, is_to_host, (*number)++};
    const wh_chaos_fate_t fate = wh_chaos_fate(chaos, place, is_acknowledgement);
    bool is_whole = false;
    for (size_t copy = 0; copy < fate.copies; ++copy) {
        uint8_t left[WH_CHAOS_BYTES];
        const size_t length = wh_chaos_garble(chaos, place, copy, bytes, size, left);
        is_whole |=
            enqueue_copy(controller, is_to_host, bytes, size, left, length, due_us + fate.later_us[copy]);
    }
    controller->line.broken += is_to_host && !is_whole ? 1 : 0;
}

void wh_sent_drop(wh_sent_t *sent) {
    while (sent->first) {
        free(wh_sent_take_due(sent, INT64_MAX));
    }
}

/* ------------------------------------------------------------------------------------------------ clients */

static void forget_requests(wh_controller_t *controller) {
    free(controller->repeat.reply.text);
    controller->repeat.reply.text = NULL;
    controller->owed.due_us = INT64_MAX;
    controller->action.is_left = controller->action.is_there;
    wh_queue_drop_client(controller);
}

void wh_controller_forget_client(wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    (void)wh_framer_init(&controller->line.framer, &controller->dialect->framing);
    (void)wh_framer_init(&controller->line.before_chaos, &controller->dialect->framing);
    wh_sent_drop(&controller->line.in);
    wh_sent_drop(&controller->line.out);
    wh_ring_drop(&controller->line.waiting, controller->line.waiting.count);
    controller->line.has_gone = false;
    controller->line.closes = false;
    for (size_t i = 0; i < host->count; ++i) {
        if (host->controllers[i]->carrier == controller) {
            forget_requests(host->controllers[i]);
        }
    }
}

void wh_controller_note_going(wh_controller_t *controller) {
    if (controller->line.has_gone) {
        controller->line.has_gone = false;
        controller->line.is_parting = true;
        note_line(controller, WH_TRANSCRIPT_WENT, NULL, 0);
    }
}

void wh_controller_note_port(wh_controller_t *controller, unsigned what) {
    if ((what & (WH_PORT_WENT | WH_PORT_CLOSED | WH_PORT_TAKEN)) != 0) {
        controller->line.has_gone = true;
    }
    if ((what & WH_PORT_CAME) != 0) {
        wh_controller_note_going(controller);
        wh_controller_forget_client(controller);
        note_line(controller, WH_TRANSCRIPT_CAME, NULL, 0);
    }
}

/* ------------------------------------------------------------------------------------------------ sending */

/* Puts bytes onto the line if it has a pace, else sends them. */
static void send_bytes(wh_controller_t *controller, const uint8_t *bytes, size_t size) {
    if (!controller->line.is_open) {
        return;
    }
    if (controller->dialect->timing.baud == 0) {
        wh_controller_note_port(controller, wh_port_send(&controller->line.port, bytes, size));
    } else if (!wh_ring_put(&controller->line.waiting, bytes, size)) {
        controller->line.port.counters.lost += size;
    }
}

/* Sends the bytes of a paced line that are through by now. */
static void send_paced(wh_controller_t *controller, int64_t now_us) {
    uint8_t bytes[4096];
    size_t through = wh_pace_take(&controller->line.out_pace, controller->line.waiting.count, now_us);
    while (through > 0) {
        const size_t size =
            wh_ring_take(&controller->line.waiting, bytes, through < sizeof bytes ? through : sizeof bytes);
        wh_controller_note_port(controller, wh_port_send(&controller->line.port, bytes, size));
        through -= size;
    }
}

void wh_controller_send_due(wh_controller_t *unit, int64_t now_us) {
    wh_controller_t *controller = unit->carrier;
    for (wh_sent_frame_t *sent = wh_sent_take_due(&controller->line.out, now_us); sent;
         sent = wh_sent_take_due(&controller->line.out, now_us)) {
        send_bytes(controller, sent->bytes, sent->size);
        free(sent);
    }
    if (controller->dialect->timing.baud > 0 && controller->line.is_open) {
        send_paced(controller, now_us);
    }
}
