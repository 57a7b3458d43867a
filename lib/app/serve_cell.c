#include "serve_cell.h"

#include "../text/clock.h"

const wh_option_t wh_serve_cell_options[] = {
    {"sim", 0, NULL, "The simulator is another process: `waferhand sim LAYOUT`, at --lcm-url", WH_OPTION_FLAG,
     .variable = offsetof(wh_serve_cell_arguments_t, sim)},
    {"timeout", 0, "S",
     "Wait at most S seconds for that simulator when it falls silent: then the command fails (default: for "
     "ever)",
     WH_OPTION_REAL, .variable = offsetof(wh_serve_cell_arguments_t, timeout_s), 1e-3, 1e6},
    {"lcm", 0, NULL, "Publish over LCM what motion control and simulator would say to each other",
     WH_OPTION_FLAG, .variable = offsetof(wh_serve_cell_arguments_t, lcm)},
    {"lcm-url", 0, "URL", "Where LCM is (default " WH_NODE_URL "); goes with --sim or --lcm", WH_OPTION_TEXT,
     .variable = offsetof(wh_serve_cell_arguments_t, url)},
    {0}};

void wh_serve_cell_check(const void *given, struct argp_state *state) {
    const wh_serve_cell_arguments_t *arguments = given;
    if (arguments->sim && arguments->lcm) {
        argp_error(state, "--lcm: with --sim the simulator says it itself (expected `waferhand sim LAYOUT`)");
    }
    if (arguments->timeout_s > 0 && !arguments->sim) {
        argp_error(state, "--timeout: %g (goes with --sim)", arguments->timeout_s);
    }
    if (arguments->url && !arguments->sim && !arguments->lcm) {
        argp_error(state, "--lcm-url: %s (goes with --sim or --lcm)", arguments->url);
    }
}

static bool is_published(const wh_serve_cell_arguments_t *arguments) {
    return arguments->lcm || arguments->record.slices || arguments->record.all;
}

/* ------------------------------------------------------------------------------ simulated in this process */

/* Called at least every 100 ms. */
static void tick_broadcast(void *user) {
    wh_serve_cell_t *cell = user;
    wh_broadcast_tick(&cell->broadcast);
}

static bool open_broadcast(wh_serve_cell_t *cell, wh_mcs_partners_t *partners) {
    const wh_serve_cell_arguments_t *arguments = cell->arguments;
    cell->is_broadcast =
        wh_broadcast_open(&cell->broadcast, "serve", &arguments->record, arguments->lcm, arguments->url);
    if (!cell->is_broadcast) {
        return false;
    }
    *partners = wh_broadcast_partners(&cell->broadcast);
    cell->host->callbacks.tick = tick_broadcast;
    cell->host->callbacks.tick_user = cell;
    return true;
}

/* ---------------------------------------------------------------------------------------- over LCM */

static void tick_link(void *user) {
    wh_serve_cell_t *cell = user;
    wh_mcs_process_idle(&cell->link.control);
}

/* A STOP waits so long for the answer to the slice that is under way, us: then the motion slows down as in
 * one process. A simulator that takes longer is silent, and the motion ends where it is. */
#define SILENT_US 500000

/* True if all that runs is to stop, and the simulator has been silent since. */
static bool is_stopped_and_silent(wh_serve_cell_t *cell) {
    const wh_session_t *session = cell->host->session;
    const int64_t now = wh_clock_us(CLOCK_MONOTONIC);
    const bool is_stopped = wh_host_is_stopped(cell->host) || wh_mcs_is_to_end(&session->mcs);
    if (!is_stopped || cell->stopped_us == 0 || cell->stopped_slice != wh_session_slice(session)) {
        cell->stopped_us = is_stopped ? now : 0;
        cell->stopped_slice = wh_session_slice(session);
    }
    return is_stopped && now - cell->stopped_us > SILENT_US;
}

/* A host's STOP, or a signal, ends the wait for a simulator that is silent. */
static void wait_for_simulator(void *user) {
    wh_serve_cell_t *cell = user;
    wh_host_wait(cell->host);
    if (*cell->host->stop != 0) {
        wh_host_end(cell->host);
    }
    if (*cell->host->stop != 0 || is_stopped_and_silent(cell)) {
        cell->link.node.interrupted = true;
    }
}

static void stop_by_request(void *user) {
    wh_serve_cell_t *cell = user;
    wh_host_stop(cell->host);
}

/* A stop by a signal comes between two slices, as in one process: the client is not told of it. */
static bool open_link(wh_serve_cell_t *cell, wh_mcs_partners_t *partners) {
    const wh_serve_cell_arguments_t *arguments = cell->arguments;
    const wh_mcs_link_options_t options = {.url = arguments->url,
                                           .program = "serve",
                                           .record = arguments->record,
                                           .client = {.timeout_us = (int64_t)(arguments->timeout_s * 1e6)}};
    cell->is_linked = wh_mcs_link_open(&cell->link, &options);
    if (!cell->is_linked) {
        return false;
    }
    cell->link.control.owner = (wh_mcs_process_owner_t){
        .busy = "another command is being executed; hosts at ports command this cell",
        .stops = stop_by_request,
        .waits = wait_for_simulator,
        .user = cell};
    *partners = wh_mcs_process_partners(&cell->link.control);
    cell->host->callbacks.tick = tick_link;
    cell->host->callbacks.tick_user = cell;
    return true;
}

/* --------------------------------------------------------------------------------- opening and closing */

bool wh_serve_cell_open(wh_serve_cell_t *cell, const wh_serve_cell_arguments_t *arguments, wh_host_t *host,
                        wh_mcs_partners_t *partners) {
    cell->arguments = arguments;
    cell->host = host;
    if (arguments->sim) {
        return open_link(cell, partners);
    }
    return !is_published(arguments) || open_broadcast(cell, partners);
}

bool wh_serve_cell_close(wh_serve_cell_t *cell) {
    if (cell->is_linked) {
        return wh_mcs_link_close(&cell->link);
    }
    return !cell->is_broadcast || wh_broadcast_close(&cell->broadcast);
}
