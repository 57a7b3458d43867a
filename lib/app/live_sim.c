#include "live_sim.h"

/* The kind of news that a phase of motion control is; false: the page does not show it. */
static bool kind_of(int32_t phase, wh_news_kind_t *kind) {
    switch (phase) {
    case WH_LINK_PHASE_BEGINS:
    case WH_LINK_PHASE_GOES_ON:
        *kind = WH_NEWS_COMMAND_BEGINS;
        return true;
    case WH_LINK_PHASE_DONE:
    case WH_LINK_PHASE_FAILED:
        *kind = WH_NEWS_COMMAND_ENDED;
        return true;
    case WH_LINK_PHASE_MET:
    case WH_LINK_PHASE_UNMET:
        *kind = WH_NEWS_EXPECTED;
        return true;
    case WH_LINK_PHASE_WAITS:
        *kind = WH_NEWS_WAITS;
        return true;
    case WH_LINK_PHASE_ON:
        *kind = WH_NEWS_GOES_ON;
        return true;
    default:
        return false;
    }
}

static bool does_begin(const waferhand_mcs *message) {
    return message->phase == WH_LINK_PHASE_BEGINS || message->phase == WH_LINK_PHASE_GOES_ON;
}

static bool does_end(const waferhand_mcs *message) {
    return message->phase == WH_LINK_PHASE_DONE || message->phase == WH_LINK_PHASE_FAILED;
}

/* Forgets the task's command, which has ended or begins; at the run's end all. True if one was known. */
static bool forget(wh_live_sim_t *sim, const waferhand_mcs *message) {
    size_t kept = 0;
    const size_t count = sim->begun_count;
    for (size_t i = 0; i < count; ++i) {
        if (message->phase != WH_LINK_PHASE_OVER && sim->begun[i] != message->task) {
            sim->begun[kept++] = sim->begun[i];
        }
    }
    sim->begun_count = kept;
    return kept < count;
}

/* True if the message is news. The first command of a run begins before the simulator knows the run: so it is
 * told by the message that it goes on. An answer, such as that of STATUS, ends no command. */
static bool is_news(wh_live_sim_t *sim, const waferhand_mcs *message) {
    const bool begins = does_begin(message);
    const bool ends = does_end(message);
    if (ends && message->request != 0) {
        return false;
    }
    if (!begins && !ends && message->phase != WH_LINK_PHASE_OVER) {
        return true;
    }
    const bool was_known = forget(sim, message);
    if (begins && sim->begun_count < WH_LIVE_SIM_TASKS) {
        sim->begun[sim->begun_count++] = message->task;
    }
    return message->phase != WH_LINK_PHASE_GOES_ON || !was_known;
}

static void hear(void *user, const waferhand_mcs *message) {
    wh_live_sim_t *sim = user;
    wh_news_kind_t kind;
    if (!is_news(sim, message) || !kind_of(message->phase, &kind)) {
        return;
    }
    const bool is_command = kind == WH_NEWS_COMMAND_BEGINS || kind == WH_NEWS_COMMAND_ENDED;
    wh_news_t *news = wh_news_make(kind, message->utime, is_command ? message->command : message->text,
                                   message->phase == WH_LINK_PHASE_FAILED ? message->text : NULL);
    news->task = message->task;
    news->line = message->line;
    news->begin_s = news->end_s = (double)message->utime / 1e6;
    news->error = is_command ? (wh_status_t)message->error : WH_OK;
    news->good = message->phase == WH_LINK_PHASE_MET;
    wh_live_tell(sim->live, news);
}

bool wh_live_sim_open(wh_live_sim_t *sim, const wh_live_arguments_t *arguments, wh_sim_process_t *simulation,
                      const wh_live_sim_driver_t *driver) {
    const wh_mcs_listener_t nobody = {0};
    const wh_live_options_t wanted = {
        .speaker = "sim",
        .title = simulation->server.layout->path,
        .uncontrolled = driver->is_board
                            ? "a board commands this cell (expected run, mcs or serve)"
                            : "motion control commands this cell over LCM (expected run, mcs or serve)",
        .rate = driver->rate};
    if (!wh_live_open(&sim->live, arguments, &wanted)) {
        return false;
    }
    if (sim->live) {
        sim->simulation = simulation;
        sim->listener = wh_live_listener(sim->live, &nobody);
        sim->listener.begins(sim->listener.user, simulation->server.layout);
        simulation->heard = hear;
        simulation->heard_user = sim;
    }
    return true;
}

void wh_live_sim_tick(wh_live_sim_t *sim) {
    if (!sim->live) {
        return;
    }
    const wh_protocol_server_t *server = &sim->simulation->server;
    if (server->identity.run != sim->run && sim->run != 0) {
        sim->listener.begins(sim->listener.user, server->layout);
        sim->seq = 0;
    }
    sim->run = server->identity.run;
    if (server->seq == sim->seq) {
        wh_live_rest(sim->live);
        return;
    }
    sim->seq = server->seq;
    sim->command.axis_count = server->has_axes ? server->layout->machine.axis_count : 0;
    for (size_t axis = 0; axis < sim->command.axis_count; ++axis) {
        sim->command.axes[axis] = server->axes[axis];
    }
    sim->listener.slice(sim->listener.user, &sim->command, &server->state);
}

void wh_live_sim_close(wh_live_sim_t *sim) {
    wh_live_close(sim->live);
    sim->live = NULL;
}
