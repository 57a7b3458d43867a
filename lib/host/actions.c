#include "actions.h"

#include <stdio.h>
#include <string.h>

#include "../record/record.h"
#include "events.h"
#include "journal.h"
#include "queue.h"
#include "status.h"
#include "telling.h"

/* -------------------------------------------------------------------------------------------------- clock */

void wh_host_begin_clock(wh_host_t *host, wh_controller_t *controller) {
    const wh_session_t *session = host->session;
    host->running = controller;
    host->clock.last_served_us = 0; /* bytes behind this action are heard in its first slice */
    host->is_told_to_stop = false;
    host->clock.base_wall_us = wh_host_now(host);
    host->clock.base_run_us = wh_session_time_us(session);
    host->clock.slice = wh_session_slice(session);
    wh_host_look(host);
}

/* ----------------------------------------------------------------------------------------------- stopping */

void wh_controller_end_job(wh_controller_t *controller, wh_status_t status, const char *why) {
    wh_mcs_end_job(&controller->host->session->mcs, wh_controller_job(controller), status, why);
}

void wh_controller_stop_running(wh_controller_t *controller) {
    wh_host_t *host = controller->host;
    controller->action.is_stopped = true;
    if (wh_host_plays_jobs(host)) {
        wh_controller_end_job(controller, WH_STATUS_STOPPED, "by a request");
    } else {
        host->is_told_to_stop = true;
        wh_mcs_stop(&host->session->mcs);
    }
}

void wh_controller_release_to_stop(wh_controller_t *controller) {
    wh_host_t *host = controller->host;
    if (!controller->leader->is_held) {
        return;
    }
    wh_controller_tell_others(controller, WH_HOST_HOLD, 0);
    controller->leader->is_held = false;
    if (!wh_host_plays_jobs(host)) {
        wh_mcs_stop_standing(&host->session->mcs);
    }
}

/* An entry at the port whose action runs, else at the first one. Before the first port there is none: no
 * transcript is open yet. */
static void note_stop(wh_host_t *host, wh_transcript_kind_t kind) {
    if (host->count > 0) {
        wh_host_note(host, host->running ? host->running : host->controllers[0], kind, NULL, 0);
    }
}

static void tell_stopped(const wh_pending_t *pending) {
    char text[WH_SANDBOX_MESSAGE_BYTES];
    const bool is_at_once = pending->request.command->when == WH_WHEN_AT_ONCE;
    wh_session_write_error(text, sizeof text, WH_STATUS_STOPPED, "Stopped; it waited and was not begun");
    wh_controller_tell_result(pending->from, is_at_once ? WH_ENCODE_ANSWER : WH_ENCODE_COMPLETE,
                              &pending->request, WH_STATUS_STOPPED, text, 0);
}

void wh_controller_stop_queue(wh_controller_t *controller) {
    wh_pending_t *kept = NULL;
    wh_pending_t **end = &kept;
    for (wh_pending_t *at = wh_queue_take(controller); at; at = wh_queue_take(controller)) {
        if (at->request.command->kind == WH_WORD_ACTION) {
            tell_stopped(at);
            wh_queue_free(at);
        } else {
            *end = at;
            end = &at->next;
        }
    }
    controller->leader->pending = kept;
}

void wh_host_stop(wh_host_t *host) {
    note_stop(host, WH_TRANSCRIPT_HALTED);
    for (size_t i = 0; i < host->count; ++i) {
        wh_controller_t *controller = host->controllers[i];
        wh_controller_release_to_stop(controller);
        wh_controller_stop_queue(controller);
        controller->action.is_stopped = controller->action.is_there;
        if (controller->action.is_running) {
            wh_controller_stop_running(controller);
        }
    }
    if (!host->running) {
        wh_mcs_give_up(&host->session->mcs, WH_NONE);
    }
}

void wh_host_end(wh_host_t *host) {
    if (!host->is_ended) {
        host->is_ended = true;
        note_stop(host, WH_TRANSCRIPT_STOPPED);
    }
    wh_session_stop(host->session);
}

void wh_host_heed_stop(wh_host_t *host, wh_status_t status) {
    if (status == WH_STATUS_STOPPED && *host->stop) {
        wh_host_end(host);
    }
}

/* ------------------------------------------------------------------------------------------------- ending */

/* Tells the host of the end, unless it has had its only answer at the begin. True: it owes an ACKN. */
static bool tell_end(wh_controller_t *controller, wh_status_t number, const char *text, double seconds) {
    const wh_action_t *action = &controller->action;
    const bool is_at_once = action->request.command->when == WH_WHEN_AT_ONCE;
    if (action->is_left && !controller->dialect->clients.completes_to_next) {
        return false;
    }
    if (!is_at_once || !action->is_answered) { /* else it failed before its first slice, or has none */
        wh_controller_tell_result(controller, is_at_once ? WH_ENCODE_ANSWER : WH_ENCODE_COMPLETE,
                                  &action->request, number, text, seconds);
    }
    return !is_at_once && controller->dialect->timing.ackn_s > 0 && controller->dialect->text;
}

void wh_controller_end(wh_controller_t *controller, wh_status_t number, const char *text, double seconds) {
    wh_host_t *host = controller->host;
    const uint64_t before = controller->line.told;
    controller->counters.busy += number == WH_STATUS_BUSY ? 1 : 0;
    /* The encoder asks for the controller's state, so the action has ended before it is told. */
    controller->action.is_there = false;
    controller->action.is_running = false;
    wh_host_tell_load_ports(host); /* before the host hears that the action is over */
    wh_host_tell_modes(host);
    const bool is_owed = tell_end(controller, number, text, seconds);
    if (controller->line.told == before) { /* the host's next frame comes behind this end all the same */
        wh_host_note(host, controller, WH_TRANSCRIPT_ENDED, NULL, 0);
    }
    if (is_owed) {
        controller->owed.due_us = wh_host_now(host) + (int64_t)(controller->dialect->timing.ackn_s * 1e6);
        memcpy(controller->owed.sequence, controller->action.request.sequence,
               sizeof controller->owed.sequence);
    }
    if (controller->action.has_begun) {
        wh_controller_tell_others(controller, number == WH_OK ? WH_HOST_POSITION : WH_HOST_ERROR,
                                  number == WH_OK ? -1 : (int)number);
    }
    wh_dialect_forget(controller->dialect, &controller->action.request);
}

static bool has_begun_untold(const wh_controller_t *controller) {
    const wh_action_t *action = &controller->action;
    return action->is_running && !action->is_answered && action->request.command->when == WH_WHEN_AT_ONCE &&
           !wh_controller_waits(controller);
}

void wh_host_tell_begun(wh_host_t *host) {
    for (size_t i = 0; i < host->count; ++i) {
        wh_controller_t *controller = host->controllers[i];
        if (has_begun_untold(controller)) {
            controller->action.is_answered = true;
            if (!controller->action.is_left) {
                wh_controller_tell_result(controller, WH_ENCODE_ANSWER, &controller->action.request, WH_OK,
                                          "OK", 0);
            }
        }
    }
}

void wh_controller_end_unbegun(wh_controller_t *controller, wh_status_t number, const char *reason) {
    char text[WH_SANDBOX_MESSAGE_BYTES];
    char whole[WH_SANDBOX_MESSAGE_BYTES];
    (void)snprintf(whole, sizeof whole, "%s; %s", wh_record_error_text(number), reason);
    wh_session_write_error(text, sizeof text, number, whole);
    wh_controller_end(controller, number, text, 0);
}
