/* A transcript's host, played again: each of its frames at its slice. */
#include <stdio.h>
#include <string.h>

#include "host.h"

static wh_controller_t *find_controller(const wh_host_t *host, const char *name) {
    for (size_t i = 0; i < host->count; ++i) {
        if (strcmp(host->controllers[i]->name, name) == 0) {
            return host->controllers[i];
        }
    }
    return NULL;
}

/* Plays what the host said up to this slice, each entry once all before it has been heard. True if there was
 * something. */
static bool hear(wh_host_t *host) {
    const int64_t slice = host->session->mcs.track.slice;
    wh_transcript_t *played = host->played;
    bool has_heard = false;
    while (!host->is_different && played->heard >= played->said) {
        const wh_transcript_entry_t *entry = wh_transcript_next(played, slice);
        wh_controller_t *controller = entry ? find_controller(host, entry->port) : NULL;
        if (!controller) {
            break;
        }
        has_heard = true;
        if (entry->kind == WH_TRANSCRIPT_STOPPED) {
            wh_host_end(host);
        } else if (entry->kind == WH_TRANSCRIPT_HALTED) {
            wh_host_stop(host);
        } else {
            wh_controller_hear(controller, entry);
        }
    }
    return has_heard;
}

static void serve_all(const wh_host_t *host) {
    for (size_t i = 0; i < host->count; ++i) {
        wh_controller_serve(host->controllers[i]);
    }
}

/* Nothing would end a HOLD that the transcript does not end. */
void wh_host_play_slice(wh_host_t *host) {
    serve_all(host);
    bool goes_on = hear(host);
    while (host->is_held && goes_on) {
        serve_all(host);
        goes_on = hear(host);
    }
    if (host->is_held || host->is_different || *host->stop) {
        wh_session_stop(host->session);
    }
}

/* An action, what is due, or what the host says next. False: there is none of them. */
static bool go_on(wh_host_t *host) {
    wh_controller_t *controller = wh_host_next_action(host);
    if (controller) {
        wh_controller_play(controller);
    }
    serve_all(host);
    return controller || hear(host);
}

bool wh_host_converse(wh_host_t *host) {
    wh_transcript_t *played = host->played;
    while (!host->is_different && !*host->stop && go_on(host)) {
    }
    if (host->is_different || !wh_transcript_compare_end(played)) {
        return false;
    }
    if (played->said < played->count) {
        (void)snprintf(played->message, sizeof played->message,
                       "%.300s:%zu: slice %lld is not reached: the run ends at slice %lld", played->path,
                       played->entries[played->said].line, (long long)played->entries[played->said].slice,
                       (long long)host->session->mcs.track.slice);
    }
    return played->said >= played->count;
}
