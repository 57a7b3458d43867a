#include "host.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <lauxlib.h>

#include "../record/record.h"
#include "../text/array.h"

/* Between two slices ports are looked at so often at most. */
#define SERVE_EACH_US 200
/* Without anything to do, so long a wait at most. */
#define LONGEST_WAIT_US 100000

/* ------------------------------------------------------------------------------------------------ waiting */

/* Each time another one comes first: it may use up the time that there is for Lua. */
static void serve_ports(wh_host_t *host) {
    ++host->turns;
    for (size_t i = 0; i < host->count; ++i) {
        wh_controller_serve(host->controllers[(i + (size_t)host->turns) % host->count]);
    }
    host->last_served_us = wh_host_now(host);
}

/* Waits for a client, at most until `until_us`, and serves all ports. */
static void serve(wh_host_t *host, int64_t until_us) {
    struct pollfd polls[WH_HOST_PORTS * WH_PORT_POLLS];
    size_t count = 0;
    const int64_t longest = wh_host_now(host) + LONGEST_WAIT_US;
    int64_t due = until_us < longest ? until_us : longest;
    for (size_t i = 0; i < host->count; ++i) {
        const int64_t at = wh_controller_due(host->controllers[i]);
        due = at < due ? at : due;
        count += wh_port_polls(&host->controllers[i]->port, polls + count);
    }
    const int64_t wait = due - wh_host_now(host);
    const struct timespec time = {wait > 0 ? (time_t)(wait / 1000000) : 0,
                                  wait > 0 ? (long)(wait % 1000000) * 1000 : 0};
    (void)ppoll(polls, (nfds_t)count, &time, NULL);
    serve_ports(host);
    if (host->tick) {
        host->tick(host->tick_user);
    }
}

void wh_host_wait(wh_host_t *host) {
    const int64_t slice = host->session->mcs.track.slice;
    const int64_t now = wh_host_now(host);
    host->base_wall_us += slice == host->waited_slice ? now - host->waited_us : 0;
    host->waited_slice = slice;
    host->waited_us = now;
    host->lua_us = 0;
    serve_ports(host);
}

/* By the wall clock, when the slice that was just played ends. */
static int64_t end_of_slice(const wh_host_t *host) {
    const wh_track_t *track = &host->session->mcs.track;
    const double run_us = (double)(track->slice * track->slice_us - host->base_run_us);
    return host->rate > 0 ? host->base_wall_us + (int64_t)(run_us / host->rate) : 0;
}

/* Stands still, and the clock with it. */
static void wait_held(wh_host_t *host) {
    const int64_t begin = wh_host_now(host);
    while (host->is_held && !*host->stop) {
        serve(host, wh_host_now(host) + LONGEST_WAIT_US);
        host->lua_us = 0;
    }
    host->base_wall_us += wh_host_now(host) - begin;
}

/* ------------------------------------------------------------------------------- what a clock cannot tell */

void wh_host_heed_clock(wh_host_t *host) {
    const wh_track_t *track = &host->session->mcs.track;
    const int64_t back = host->clock_slice - track->slice;
    if (back > 0) {
        host->skipped_us += back * track->slice_us;
        host->base_run_us = track->slice * track->slice_us;
        host->base_wall_us = wh_host_now(host);
        wh_host_note(host, host->running, WH_TRANSCRIPT_CLOCK, NULL, 0);
    }
    host->clock_slice = track->slice;
}

void wh_host_end(wh_host_t *host) {
    if (!host->is_ended) {
        host->is_ended = true;
        wh_host_note(host, host->running ? host->running : host->controllers[0], WH_TRANSCRIPT_STOPPED, NULL,
                     0);
    }
    wh_session_stop(host->session);
}

void wh_host_heed_stop(wh_host_t *host, wh_status_t status) {
    if (status == WH_STATUS_STOPPED && *host->stop) {
        wh_host_end(host);
    }
}

/* ------------------------------------------------------------------------------------------------- slices */

static void tell_events(wh_host_t *host, const wh_state_t *state) {
    for (size_t e = 0; e < state->event_count; ++e) {
        const wh_event_kind_t kind = state->events[e].kind;
        host->last_complaint = wh_record_is_complaint(kind) ? kind : host->last_complaint;
        for (size_t i = 0; i < host->count; ++i) {
            wh_controller_event(host->controllers[i], &state->events[e], (double)state->utime / 1e6);
        }
    }
}

/* Serves the ports until the slice's time is over. */
static void serve_slice(wh_host_t *host) {
    const int64_t end = end_of_slice(host);
    if (end > wh_host_now(host) || wh_host_now(host) - host->last_served_us >= SERVE_EACH_US) {
        do {
            serve(host, end);
            wait_held(host);
        } while (wh_host_now(host) < end_of_slice(host) && !*host->stop && !host->is_told_to_stop);
    }
    if (*host->stop) {
        wh_host_end(host);
    }
}

static void on_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    wh_host_t *host = user;
    if (host->next.slice) {
        host->next.slice(host->next.user, command, state);
    }
    if (!host->running) {
        return;
    }
    host->lua_us = 0;
    wh_host_heed_clock(host);
    tell_events(host, state);
    if (host->played) {
        wh_host_play_slice(host);
    } else {
        serve_slice(host);
    }
}

static void on_boundary(void *user, const wh_layout_t *layout) {
    const wh_host_t *host = user;
    if (host->next.boundary) {
        host->next.boundary(host->next.user, layout);
    }
}

wh_mcs_listener_t wh_host_listener(wh_host_t *host) {
    return (wh_mcs_listener_t){on_slice, on_boundary, host};
}

/* ---------------------------------------------------------------------------------------------- the whole */

wh_controller_t *wh_host_next_action(const wh_host_t *host) {
    wh_controller_t *next = NULL;
    for (size_t i = 0; i < host->count && !host->is_ended; ++i) {
        wh_controller_t *controller = host->controllers[i];
        if (controller->has_action && !controller->is_running && (!next || controller->order < next->order)) {
            next = controller;
        }
    }
    return next;
}

void wh_host_run(wh_host_t *host) {
    while (!*host->stop) {
        wh_controller_t *controller = wh_host_next_action(host);
        host->lua_us = 0;
        if (controller) {
            wh_controller_play(controller);
        }
        serve(host, controller ? 0 : wh_host_now(host) + LONGEST_WAIT_US);
    }
    wh_host_end(host);
}

/* False for a second one of a mechanism. */
static bool is_alone(const wh_host_t *host, wh_controller_t *controller) {
    for (size_t i = 0; i + 1 < host->count; ++i) {
        const wh_controller_t *other = host->controllers[i];
        if (wh_mechanisms_clash(&other->mechanism, &controller->mechanism)) {
            const char *name = controller->mechanism.name;
            char text[WH_SANDBOX_MESSAGE_BYTES];
            (void)snprintf(text, sizeof text, "mechanism: %.63s (expected one that no other port stands for)",
                           name ? name : wh_mechanism_names[controller->mechanism.kind]);
            wh_dialect_note(&controller->dialect, text);
            return false;
        }
    }
    return true;
}

/* False if the layout has none of that name. */
static bool find_mechanism(wh_controller_t *controller, const char *name) {
    wh_dialect_t *dialect = &controller->dialect;
    const wh_layout_t *layout = controller->host->session->mcs.layout;
    char problem[WH_MECHANISM_PROBLEM];
    controller->mechanism = wh_mechanism_all(dialect->mechanism, layout);
    if (!name || wh_mechanism_find(dialect->mechanism, name, layout, &controller->mechanism, problem)) {
        return true;
    }
    char text[WH_SANDBOX_MESSAGE_BYTES];
    (void)snprintf(text, sizeof text, "mechanism: %.600s", problem);
    wh_dialect_note(dialect, text);
    return false;
}

static bool is_name_taken(const wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    bool is_taken = false;
    for (size_t i = 0; i + 1 < host->count; ++i) {
        is_taken = is_taken || strcmp(host->controllers[i]->name, controller->name) == 0;
    }
    return is_taken;
}

/* What stands for itself in a transcript, and is no other port's. */
static void give_name(wh_controller_t *controller) {
    const wh_port_mechanism_t *mechanism = &controller->mechanism;
    const char *kind = wh_mechanism_names[mechanism->kind];
    (void)snprintf(controller->name, sizeof controller->name, "%s", mechanism->name ? mechanism->name : kind);
    for (char *c = controller->name; *c; ++c) {
        *c = isalnum((unsigned char)*c) || strchr("_-.", *c) ? *c : '_';
    }
    if (is_name_taken(controller)) {
        (void)snprintf(controller->name, sizeof controller->name, "%s-%u", kind, controller->number + 1);
    }
}

static bool open_port(wh_controller_t *controller, const wh_host_port_t *port) {
    char problem[WH_PORT_PROBLEM_BYTES];
    const wh_port_second_t second = controller->dialect.takes_over ? WH_PORT_TAKEOVER : WH_PORT_REFUSE;
    controller->is_open = port->is_pty ? wh_port_open_pty(&controller->port, port->address, problem)
                                       : wh_port_open_tcp(&controller->port, port->address, second, problem);
    if (!controller->is_open) {
        (void)snprintf(controller->dialect.message, sizeof controller->dialect.message, "%.1000s", problem);
    }
    return controller->is_open;
}

bool wh_host_add(wh_host_t *host, const wh_host_port_t *port) {
    host->shown = host->shown ? host->shown : wh_array_new(WH_HOST_NUMBERS, sizeof *host->shown);
    wh_controller_t *controller = wh_array_new(1, sizeof *controller);
    controller->number = (uint32_t)host->count;
    host->controllers[host->count++] = controller;
    controller->host = host;
    controller->ackn_due_us = INT64_MAX;
    controller->request = (wh_request_t){.reference = LUA_NOREF};
    const wh_layout_t *layout = host->session->mcs.layout;
    if (!wh_dialect_open(&controller->dialect, port->dialect) ||
        !find_mechanism(controller, port->mechanism) || !is_alone(host, controller) ||
        (layout && !wh_dialect_fits(&controller->dialect, layout))) {
        return false;
    }
    give_name(controller);
    controller->in_pace.baud = controller->out_pace.baud = controller->dialect.baud;
    (void)wh_framer_init(&controller->framer, &controller->dialect.framing);
    (void)wh_framer_init(&controller->before_chaos, &controller->dialect.framing);
    return !port->address || open_port(controller, port);
}

static void free_frames(wh_sent_t *sent) {
    while (sent->first) {
        wh_sent_frame_t *frame = sent->first;
        sent->first = frame->next;
        free(frame);
    }
}

static void close_controller(wh_controller_t *controller) {
    if (controller->is_open) {
        wh_port_close(&controller->port);
    }
    free_frames(&controller->out);
    free_frames(&controller->in);
    free(controller->reply.text);
    free(controller->ended_text);
    wh_dialect_close(&controller->dialect);
    free(controller);
}

void wh_host_close(wh_host_t *host) {
    for (size_t i = 0; i < host->count; ++i) {
        close_controller(host->controllers[i]);
    }
    free(host->shown);
    host->shown = NULL;
    host->count = 0;
}
