#include "playing.h"

#include <stdio.h>

#include "actions.h"
#include "jobs.h"
#include "journal.h"
#include "status.h"

/* A fault ends with the next slice, and no slice comes while nothing moves. So it waits for one. */
static void end_faults(const wh_controller_t *controller) {
    char *text = controller->host->texts->ignored;
    char line[40];
    wh_session_t *session = controller->host->session;
    if (wh_word_of(controller->action.lines.lines[controller->action.lines.count - 1]) ==
        wh_word_of("CLEAR")) {
        (void)snprintf(line, sizeof line, "WAIT %.6f", (double)wh_session_slice_us(session) / 1e6);
        const wh_mcs_asker_t part = {.is_part = true}; /* UNDO takes it back with the CLEAR */
        (void)wh_session_execute_for(session, &part, line, text, WH_SESSION_ANSWER_BYTES);
    }
}

/* Another run of the cell has begun, or an earlier state has come back. */
static void forget_failures(wh_host_t *host) {
    for (size_t i = 0; i < host->count; ++i) {
        host->controllers[i]->action.failed = WH_OK;
    }
}

void wh_controller_play(wh_controller_t *controller) {
    wh_host_t *host = controller->host;
    char *text = host->texts->played;
    if (wh_host_plays_jobs(host) && !wh_controller_needs_all(controller)) {
        wh_host_play_jobs(host);
        return;
    }
    const wh_session_t *session = host->session;
    int64_t slices = 0; /* a RESET, RESTORE or UNDO may set the clock back */
    wh_status_t status = WH_OK;
    if (controller->action.is_stopped) {
        wh_controller_end_unbegun(controller, WH_STATUS_STOPPED, "it waited and was not begun");
        return;
    }
    wh_host_begin_clock(host, controller);
    controller->action.is_running = controller->action.has_begun = true;
    for (size_t i = 0; i < controller->action.lines.count && status == WH_OK; ++i) {
        const int64_t begin = wh_session_slice(session);
        status = wh_session_execute(host->session, controller->action.lines.lines[i], text,
                                    WH_SESSION_ANSWER_BYTES);
        wh_host_heed_clock(host);
        slices += wh_session_slice(session) > begin ? wh_session_slice(session) - begin : 0;
    }
    if (status == WH_OK) {
        end_faults(controller);
    }
    wh_host_heed_stop(host, status);
    if (status == WH_OK && wh_host_plays_jobs(host)) {
        forget_failures(host);
    }
    host->running = NULL;
    controller->leader->is_held = false;
    wh_controller_end(controller, status, text, (double)(slices * wh_session_slice_us(session)) / 1e6);
}
