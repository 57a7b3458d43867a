#include "host.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <lauxlib.h>

#include "../record/record.h"
#include "../text/array.h"
#include "conditions.h"
#include "events.h"
#include "journal.h"
#include "line.h"
#include "playing.h"
#include "queue.h"
#include "reading.h"
#include "requests.h"
#include "telling.h"

/* The most times that the ports are checked between two slices. */
#define SERVE_EACH_US 200
/* The longest wait if there is nothing to do. */
#define LONGEST_WAIT_US 100000

/* ------------------------------------------------------------------------------------------------ waiting */

/* Serves a controller; a transcript tells of the operator's stops, too. */
static unsigned serve_controller(wh_host_t *host, wh_controller_t *controller) {
    const unsigned what = wh_controller_serve(controller);
    if ((what & WH_PORT_ENDED) != 0) {
        wh_host_end(host);
    }
    if ((what & WH_PORT_HALTED) != 0) {
        wh_host_stop(host);
    }
    return what & WH_PORT_TOLD;
}

/* Each time another port comes first, because the first one may use up the time for Lua. A transcript tells
 * all that it has for this slice. False: nothing more can come before the next slice. */
static bool serve_ports(wh_host_t *host) {
    bool goes_on = wh_host_go_on(host) || !host->played; /* a client may always come */
    unsigned told = 0;
    do {
        told = 0;
        ++host->so_far.turns;
        for (size_t i = 0; i < host->count; ++i) {
            told |= serve_controller(host, host->controllers[(i + (size_t)host->so_far.turns) % host->count]);
        }
        goes_on = goes_on || told != 0;
    } while (told != 0);
    host->clock.last_served_us = wh_host_now(host);
    return goes_on;
}

/* Waits for a client, at most until `until_us`, and serves all ports. False: nothing more can come. */
static bool wait_and_serve(wh_host_t *host, int64_t until_us) {
    struct pollfd polls[WH_HOST_CONTROLLERS * WH_PORT_POLLS];
    size_t count = 0;
    const int64_t longest = wh_host_now(host) + LONGEST_WAIT_US;
    int64_t due = until_us < longest ? until_us : longest;
    for (size_t i = 0; i < host->count; ++i) {
        const int64_t at = wh_controller_due(host->controllers[i]);
        due = at < due ? at : due;
        if (host->controllers[i]->line.is_open) {
            count += wh_port_polls(&host->controllers[i]->line.port, polls + count);
        }
    }
    const int64_t wait = due - wh_host_now(host);
    const struct timespec time = {wait > 0 ? (time_t)(wait / 1000000) : 0,
                                  wait > 0 ? (long)(wait % 1000000) * 1000 : 0};
    (void)ppoll(polls, (nfds_t)count, &time, NULL);
    const bool goes_on = serve_ports(host);
    if (host->callbacks.tick) {
        host->callbacks.tick(host->callbacks.tick_user);
    }
    return goes_on;
}

/* Nothing moves for now. */
static void tell_standstill(const wh_host_t *host) {
    if (host->next.tell) {
        host->next.tell(host->next.user, &host->session->mcs,
                        wh_host_is_held(host) ? WH_MCS_HELD : WH_MCS_NOT_HELD, NULL);
    }
}

void wh_host_wait(wh_host_t *host) {
    const int64_t slice = wh_session_slice(host->session);
    const int64_t now = wh_host_now(host);
    host->clock.base_wall_us += slice == host->clock.waited_slice ? now - host->clock.waited_us : 0;
    host->clock.waited_slice = slice;
    host->clock.waited_us = now;
    host->clock.lua_us = 0;
    (void)serve_ports(host);
    tell_standstill(host);
}

/* The time by the wall clock when the slice that was just played ends. */
static int64_t end_of_slice(const wh_host_t *host) {
    const wh_session_t *session = host->session;
    const double run_us = (double)(wh_session_time_us(session) - host->clock.base_run_us);
    return host->rate > 0 ? host->clock.base_wall_us + (int64_t)(run_us / host->rate) : 0;
}

/* While all that runs is held the run stands still, and the clock with it. False: nothing can end this
 * HOLD. */
static bool wait_held(wh_host_t *host) {
    if (!wh_host_is_held(host)) {
        return true;
    }
    const int64_t begin = wh_host_now(host);
    bool goes_on = true;
    tell_standstill(host);
    while (wh_host_is_held(host) && !*host->stop && goes_on) {
        goes_on = wait_and_serve(host, wh_host_now(host) + LONGEST_WAIT_US);
        host->clock.lua_us = 0;
    }
    host->clock.base_wall_us += wh_host_now(host) - begin;
    host->clock.held_us += wh_host_now(host) - begin;
    tell_standstill(host);
    return goes_on || !wh_host_is_held(host);
}

/* ------------------------------------------------------------------------------------------------- slices */

/* Serves the ports until the slice's time is over. */
static void serve_slice(wh_host_t *host) {
    const int64_t end = end_of_slice(host);
    bool goes_on = true;
    if (end > wh_host_now(host) || wh_host_now(host) - host->clock.last_served_us >= host->clock.rest_us) {
        do {
            (void)wait_and_serve(host, end);
            goes_on = wait_held(host);
        } while (wh_host_now(host) < end_of_slice(host) && !*host->stop && !host->is_told_to_stop);
    }
    if (*host->stop) {
        wh_host_end(host);
    } else if (!goes_on || wh_host_differs(host)) {
        wh_session_stop(host->session);
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
    host->clock.lua_us = 0;
    wh_host_heed_clock(host);
    wh_host_tell_slice(host, command, state);
    wh_host_tell_begun(host);
    serve_slice(host);
}

static void on_boundary(void *user, const wh_layout_t *layout) {
    const wh_host_t *host = user;
    for (size_t i = 0; i < host->count; ++i) {
        wh_dialect_show(host->controllers[i]->dialect, layout);
    }
    if (host->next.boundary) {
        host->next.boundary(host->next.user, layout);
    }
}

static void on_begin(void *user, const wh_layout_t *layout) {
    wh_host_t *host = user;
    free(host->seen.ports); /* its names were those of the layout before */
    host->seen.ports = NULL;
    for (size_t i = 0; i < host->count; ++i) { /* they were taken when the ports were opened */
        (void)wh_controller_begin_conditions(host->controllers[i]);
    }
    if (host->next.begins) {
        host->next.begins(host->next.user, layout);
    }
}

static void on_set_back(void *user, const wh_command_t *command, const wh_state_t *state) {
    const wh_host_t *host = user;
    if (host->next.set_back) {
        host->next.set_back(host->next.user, command, state);
    }
}

static void on_news(void *user, const wh_mcs_t *mcs, wh_mcs_news_t news, const wh_command_record_t *command) {
    const wh_host_t *host = user;
    if (host->next.tell) {
        host->next.tell(host->next.user, mcs, news, command);
    }
}

static void on_turn(void *user, const wh_mcs_t *mcs, const char *what) {
    const wh_host_t *host = user;
    if (host->next.turn) {
        host->next.turn(host->next.user, mcs, what);
    }
}

wh_mcs_listener_t wh_host_listener(wh_host_t *host) {
    return (wh_mcs_listener_t){.slice = on_slice,
                               .boundary = on_boundary,
                               .begins = on_begin,
                               .set_back = on_set_back,
                               .tell = on_news,
                               .turn = on_turn,
                               .user = host};
}

/* ---------------------------------------------------------------------------------------------- the whole */

/* Plays it, and adds up the time that it takes. A RESET, which sets the clock back, counts as none. */
static void play_action(wh_controller_t *action) {
    wh_host_t *host = action->host;
    const int64_t wall = wh_host_now(host);
    const int64_t run = wh_session_time_us(host->session);
    wh_controller_play(action);
    const int64_t passed = wh_session_time_us(host->session) - run;
    host->clock.wall_us += passed > 0 ? wh_host_now(host) - wall : 0;
    host->clock.run_us += passed > 0 ? passed : 0;
}

static void run_loop(wh_host_t *host) {
    bool goes_on = true;
    while (goes_on && !*host->stop && !wh_host_differs(host)) {
        wh_controller_t *action = wh_host_next_action(host);
        host->clock.lua_us = 0;
        if (action) {
            play_action(action);
        }
        goes_on = wait_and_serve(host, action ? 0 : wh_host_now(host) + LONGEST_WAIT_US) || action;
    }
}

void wh_host_run(wh_host_t *host) {
    run_loop(host);
    wh_host_end(host);
}

bool wh_host_converse(wh_host_t *host) {
    run_loop(host);
    return wh_transcript_is_over(host->played, wh_session_slice(host->session));
}

/* False for a second one of a mechanism. */
static bool is_alone(const wh_host_t *host, wh_controller_t *controller) {
    for (size_t i = 0; i + 1 < host->count; ++i) {
        const wh_controller_t *other = host->controllers[i];
        if (other->leader != controller->leader && !other->leader->is_tester &&
            wh_mechanisms_clash(&other->mechanism, &controller->mechanism)) {
            const char *name = controller->mechanism.name;
            char text[WH_SANDBOX_MESSAGE_BYTES];
            (void)snprintf(text, sizeof text, "mechanism: %.63s (expected one that no other port stands for)",
                           name ? name : wh_mechanism_names[controller->mechanism.kind]);
            wh_dialect_note(controller->dialect, text);
            return false;
        }
    }
    return true;
}

/* False if the layout has none of that name. */
static bool find_mechanism(wh_controller_t *controller, const char *name) {
    wh_dialect_t *dialect = controller->dialect;
    const wh_layout_t *layout = wh_session_layout(controller->host->session);
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

/* Gives the port a name that needs no quotes in a transcript, and that no other port has: its mechanism's,
 * with its own name in `ports` and, for a further client of a shared port, a number. */
static void give_name(wh_controller_t *controller, size_t client) {
    const wh_port_mechanism_t *mechanism = &controller->mechanism;
    const bool is_tester = controller->leader->is_tester;
    const char *kind = is_tester ? "control" : wh_mechanism_names[mechanism->kind];
    char text[4 * WH_DIALECT_NAME_BYTES];
    (void)snprintf(text, sizeof text, "%.40s%s%.15s", mechanism->name ? mechanism->name : kind,
                   controller->role[0] != '\0' ? "." : "", controller->role);
    (void)snprintf(controller->name, sizeof controller->name, client > 1 ? "%s.%zu" : "%s", text, client);
    for (char *c = controller->name; *c; ++c) {
        *c = isalnum((unsigned char)*c) || strchr("_-.", *c) ? *c : '_';
    }
    if (is_name_taken(controller)) {
        (void)snprintf(controller->name, sizeof controller->name, "%s-%u", kind, controller->number + 1);
    }
}

/* Opens the port that was asked for; where a transcript is played, its host's side is the port. `beside`: the
 * port of the client before it where several share a place; null: this is the first one. */
static bool open_port(wh_controller_t *controller, const wh_host_port_t *asked, const wh_port_t *beside) {
    char problem[WH_PORT_PROBLEM_BYTES];
    wh_port_line_t *line = &controller->line;
    wh_transcript_t *played = controller->host->played;
    if (played) {
        wh_port_open_transcript(&line->port, played, controller->name);
        line->is_open = true;
    } else if (controller->carrier != controller) {
        return true;
    } else if (beside) {
        line->is_open = wh_port_open_beside(&line->port, beside, problem);
    } else {
        line->is_open = asked->is_pty ? wh_port_open_pty(&line->port, asked->address, problem)
                                      : wh_port_open_tcp(&line->port, asked->address,
                                                         controller->dialect->clients.second, problem);
    }
    if (!line->is_open) {
        (void)snprintf(controller->dialect->message, sizeof controller->dialect->message, "%.1000s", problem);
    }
    line->port.allow = controller->host->allow;
    return line->is_open;
}

/* A controller without a port yet; `leader` null: it leads, and its dialect is still to be opened. */
static wh_controller_t *append_controller(wh_host_t *host, wh_controller_t *leader) {
    wh_controller_t *controller = wh_array_new(1, sizeof *controller);
    controller->number = (uint32_t)host->count;
    host->controllers[host->count++] = controller;
    controller->host = host;
    controller->leader = leader ? leader : controller;
    controller->carrier = controller;
    controller->dialect = leader ? leader->dialect : wh_array_new(1, sizeof *controller->dialect);
    controller->mechanism = controller->leader->mechanism;
    controller->role = "";
    controller->owed.due_us = INT64_MAX;
    controller->action.request = (wh_request_t){.reference = LUA_NOREF};
    return controller;
}

static void begin_line(wh_controller_t *controller, const char *role, size_t client) {
    controller->role = role;
    give_name(controller, client);
    controller->line.in_pace.baud = controller->line.out_pace.baud = controller->dialect->timing.baud;
    (void)wh_framer_init(&controller->line.framer, &controller->dialect->framing);
    (void)wh_framer_init(&controller->line.before_chaos, &controller->dialect->framing);
}

/* Opens this controller's port and, where clients share one, a controller for each further client. */
static bool open_ports(wh_controller_t *controller, const wh_host_port_t *port, const char *role) {
    wh_host_t *host = controller->host;
    const bool is_shared = controller->dialect->clients.second == WH_PORT_SHARE && !port->is_pty;
    begin_line(controller, role, 1);
    bool good = open_port(controller, port, NULL);
    const wh_port_t *before = &controller->line.port;
    for (size_t client = 2; good && is_shared && client <= WH_DIALECT_SHARERS; ++client) {
        wh_controller_t *other = append_controller(host, controller->leader);
        begin_line(other, role, client);
        good = open_port(other, port, before);
        before = &other->line.port;
    }
    return good;
}

/* How many of the last dialect's ports are open. */
static size_t count_ports(const wh_host_t *host, const wh_controller_t *leader) {
    size_t count = 0;
    const char *last = NULL;
    for (size_t i = leader->number; i < host->count; ++i) {
        count += host->controllers[i]->role != last ? 1 : 0;
        last = host->controllers[i]->role;
    }
    return count;
}

bool wh_host_needs_port(const wh_host_t *host) {
    const wh_controller_t *leader = host->count > 0 ? host->controllers[host->count - 1]->leader : NULL;
    return leader && count_ports(host, leader) < leader->dialect->clients.port_count;
}

bool wh_host_add_port(wh_host_t *host, const wh_host_port_t *port) {
    wh_controller_t *leader = host->controllers[host->count - 1]->leader;
    const char *role = leader->dialect->clients.ports[count_ports(host, leader)];
    return open_ports(append_controller(host, leader), port, role);
}

static void begin_host(wh_host_t *host) {
    if (!host->shown) {
        host->shown = wh_array_new(WH_HOST_NUMBERS, sizeof *host->shown);
        host->texts = wh_array_new(1, sizeof *host->texts);
        host->clock.rest_us = host->played ? 0 : SERVE_EACH_US;
    }
}

static bool refuse_unit(const wh_controller_t *controller, const char *unit, const char *expected) {
    char text[WH_SANDBOX_MESSAGE_BYTES];
    (void)snprintf(text, sizeof text, "--unit %.63s: expected %s", unit, expected);
    wh_dialect_note(controller->dialect, text);
    return false;
}

static bool has_unit(const wh_controller_t *carrier, const char *unit) {
    const wh_host_t *host = carrier->host;
    bool has = false;
    for (size_t i = 0; i + 1 < host->count; ++i) {
        has = has ||
              (host->controllers[i]->carrier == carrier && strcmp(host->controllers[i]->unit, unit) == 0);
    }
    return has;
}

/* The line is that of the dialect before it. */
static bool share_line(wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    wh_controller_t *carrier = host->count > 1 ? host->controllers[host->count - 2]->carrier : NULL;
    if (!carrier || !carrier->unit || strcmp(carrier->dialect->path, controller->dialect->path) != 0) {
        return refuse_unit(
            controller, controller->unit,
            "a port of its own, or before it a --dialect of this file with a --unit, whose line "
            "it shares");
    }
    if (has_unit(carrier, controller->unit)) {
        return refuse_unit(controller, controller->unit, "an address that its line does not have yet");
    }
    controller->carrier = carrier;
    return true;
}

/* Gives the controller its address and, if it shares one, its line. */
static bool join_line(wh_controller_t *controller, const wh_host_port_t *port) {
    const wh_dialect_clients_t *clients = &controller->dialect->clients;
    controller->unit = port->unit;
    if (!port->unit) {
        return true;
    }
    if (port->unit[0] == '\0' || strlen(port->unit) >= WH_DIALECT_NAME_BYTES) {
        return refuse_unit(controller, port->unit, "an address of 1 to 63 bytes");
    }
    if (!clients->knows_units || clients->port_count > 1 || clients->second == WH_PORT_SHARE) {
        return refuse_unit(controller, port->unit,
                           "a dialect with a function `unit_of` and one port that no clients share");
    }
    return !port->shares_line || share_line(controller);
}

bool wh_host_add(wh_host_t *host, const wh_host_port_t *port) {
    begin_host(host);
    wh_controller_t *controller = append_controller(host, NULL);
    ++host->leaders;
    const wh_layout_t *layout = wh_session_layout(host->session);
    if (!wh_dialect_open(controller->dialect, port->dialect, port->unit) || !join_line(controller, port) ||
        !find_mechanism(controller, port->mechanism) || !is_alone(host, controller) ||
        (layout && !wh_dialect_fits(controller->dialect, layout))) {
        return false;
    }
    wh_dialect_show(controller->dialect, layout);
    controller->dialect->place.stands_for = controller->mechanism.name;
    if (!controller->mechanism.name && layout) {
        controller->dialect->place.stands_for = wh_mechanism_only(controller->mechanism.kind, layout);
    }
    return wh_controller_begin_conditions(controller) &&
           open_ports(controller, port, controller->dialect->clients.ports[0]);
}

bool wh_host_add_control(wh_host_t *host, const char *address) {
    const wh_host_port_t port = {.dialect = WH_DIALECT_CONTROL, .address = address};
    const wh_layout_t *layout = wh_session_layout(host->session);
    begin_host(host);
    wh_controller_t *controller = append_controller(host, NULL);
    ++host->leaders;
    controller->is_tester = true;
    controller->mechanism = wh_mechanism_all(WH_MECHANISM_CELL, layout);
    if (!wh_dialect_open(controller->dialect, port.dialect, NULL)) {
        return false;
    }
    wh_dialect_show(controller->dialect, layout);
    return open_ports(controller, &port, controller->dialect->clients.ports[0]);
}

static void close_controller(wh_controller_t *controller) {
    if (controller->line.is_open) {
        wh_port_close(&controller->line.port);
    }
    wh_sent_drop(&controller->line.out);
    wh_sent_drop(&controller->line.in);
    wh_queue_drop_client(controller);
    free(controller->repeat.reply.text);
    free(controller->action.ended_text);
}

void wh_host_close(wh_host_t *host) {
    for (size_t i = 0; i < host->count; ++i) {
        close_controller(host->controllers[i]);
    }
    for (size_t i = host->count; i > 0; --i) {
        wh_controller_t *controller = host->controllers[i - 1];
        if (controller->leader == controller) {
            wh_dialect_close(controller->dialect);
            free(controller->dialect);
        }
        free(controller);
    }
    free(host->shown);
    free(host->texts);
    free(host->seen.ports);
    host->seen.ports = NULL;
    host->shown = NULL;
    host->texts = NULL;
    host->count = host->leaders = 0;
}
