#include "sim_process.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "../text/utf8.h"

/* ------------------------------------------------------------------------------------------------ sending */

static void publish(wh_sim_process_t *simulation, const char *channel, const void *data, int size) {
    if (size <= 0 || size > WH_LINK_DATAGRAM ||
        !wh_node_publish(simulation->node, channel, data, (size_t)size)) {
        ++simulation->counters.unsent;
    }
}

static void tell_cell(wh_sim_process_t *simulation) {
    waferhand_cell *cell = &simulation->cell.message;
    cell->utime = simulation->server.state.utime;
    cell->seq = simulation->server.seq;
    cell->run = simulation->server.identity.run;
    simulation->last_cell_us = wh_node_clock_us();
    publish(simulation, WH_CHANNEL_CELL, simulation->encoded,
            waferhand_cell_encode(simulation->encoded, 0, (int)sizeof simulation->encoded, cell));
}

static void tell_proximity(wh_sim_process_t *simulation) {
    waferhand_proximity message;
    simulation->proximity_waits = false;
    simulation->last_proximity_us = wh_node_clock_us();
    wh_link_proximity_to_message(&simulation->server.state, &simulation->server.identity,
                                 simulation->server.layout, &message);
    publish(simulation, WH_CHANNEL_PROXIMITY, simulation->encoded,
            waferhand_proximity_encode(simulation->encoded, 0, (int)sizeof simulation->encoded, &message));
}

static void tell_waiting_proximity(wh_sim_process_t *simulation, int64_t now) {
    if (simulation->proximity_waits && now - simulation->last_proximity_us >= WH_SIMULATION_PROXIMITY_US) {
        tell_proximity(simulation);
    }
}

/* ---------------------------------------------------------------------------------------------- receiving */

static void drop(wh_sim_process_t *simulation, const char *channel, size_t size) {
    if (simulation->counters.garbage++ == 0) {
        wh_node_warn(simulation->node,
                     "%s: a datagram of %zu bytes is no such message and was dropped; others will be dropped "
                     "without a word, and counted",
                     channel, size);
    }
}

static void heard_motion_control(wh_sim_process_t *simulation) {
    simulation->last_command_us = wh_node_clock_us();
    if (simulation->silent) {
        simulation->silent = false;
        wh_node_say(simulation->node, "motion control is back at slice %" PRId64, simulation->server.seq);
    }
}

static void act_on(wh_sim_process_t *simulation, wh_protocol_server_result_t result) {
    if (result == WH_SERVER_IGNORED) {
        return;
    }
    /* The state goes out first, because motion control waits for it. */
    publish(simulation, WH_CHANNEL_STATE, simulation->server.encoded, (int)simulation->server.encoded_size);
    if (result == WH_SERVER_RESTORED) {
        heard_motion_control(simulation);
    }
    if (result == WH_SERVER_NEW_RUN || result == WH_SERVER_RESTORED) {
        simulation->running = true;
        wh_node_say(simulation->node, "run %016" PRIx64 " %s slice %" PRId64,
                    (uint64_t)simulation->server.identity.run,
                    result == WH_SERVER_NEW_RUN ? "begins with" : "goes on from", simulation->server.seq);
        tell_cell(simulation);
    }
    if (result == WH_SERVER_ANSWERED) {
        return;
    }
    simulation->proximity_waits = true;
    if (simulation->server.state.event_count > 0) {
        tell_proximity(simulation);
    } else {
        tell_waiting_proximity(simulation, wh_node_clock_us());
    }
}

static void handle_command(wh_sim_process_t *simulation, const waferhand_command *message) {
    const int64_t missed = simulation->server.missed;
    const uint64_t others = simulation->server.counters.other_layout;
    const wh_protocol_server_result_t result =
        wh_protocol_server_command(&simulation->server, message, simulation->valves);
    /* It tells the cell before the first command of a run with another layout is turned away, so that its
     * sender can name this layout. */
    if (simulation->server.counters.other_layout > others && simulation->other_run != message->run) {
        simulation->other_run = message->run;
        tell_cell(simulation);
    }
    /* Late commands of an old run are no sign of life. */
    if (message->run == simulation->server.identity.run) {
        heard_motion_control(simulation);
    }
    if (simulation->server.missed > missed && missed == 0) {
        wh_node_warn(simulation->node,
                     "slices are missing, the first before slice %" PRId64 ": they are counted",
                     simulation->server.seq);
    }
    act_on(simulation, result);
}

/* True, and counted, if the message does not come from the process that has the simulator. */
static bool is_stranger(wh_sim_process_t *simulation) {
    const uint64_t sender = simulation->node->sender;
    const bool is_free =
        simulation->bound == 0 || wh_node_clock_us() - simulation->last_command_us > WH_SIMULATION_BOUND_US;
    if (!simulation->one_sender || sender == 0 || sender == simulation->bound) {
        return false;
    }
    if (is_free) {
        simulation->bound = sender;
        simulation->last_command_us = wh_node_clock_us();
        return false;
    }
    if (simulation->counters.strangers++ == 0) {
        wh_node_warn(simulation->node,
                     "another process sends commands while a run goes on: they are not taken "
                     "(--one-sender), and counted");
    }
    return true;
}

static void on_command(void *user, const void *data, size_t size) {
    wh_sim_process_t *simulation = user;
    waferhand_command message;
    if (wh_link_decode_command(data, size, &message)) {
        if (!is_stranger(simulation)) {
            handle_command(simulation, &message);
        }
    } else {
        drop(simulation, WH_CHANNEL_COMMAND, size);
    }
}

static void on_restore(void *user, const void *data, size_t size) {
    wh_sim_process_t *simulation = user;
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        drop(simulation, WH_CHANNEL_RESTORE, size);
        return;
    }
    if (!is_stranger(simulation)) {
        act_on(simulation, wh_protocol_server_restore(&simulation->server, &message));
    }
    (void)waferhand_state_decode_cleanup(&message);
}

static void on_mcs(void *user, const void *data, size_t size) {
    wh_sim_process_t *simulation = user;
    waferhand_mcs message;
    if (!wh_link_decode_mcs(data, size, &message)) {
        drop(simulation, WH_CHANNEL_MCS, size);
        return;
    }
    const bool is_ours = message.run == simulation->server.identity.run;
    if (simulation->heard && (is_ours || message.run == 0)) {
        simulation->heard(simulation->heard_user, &message);
    }
    if (is_ours && message.phase == WH_LINK_PHASE_OVER && simulation->running && !is_stranger(simulation)) {
        simulation->running = false;
        simulation->bound = 0;
        wh_node_say(simulation->node, "run %016" PRIx64 " is over at slice %" PRId64 ", hash %016" PRIx64,
                    (uint64_t)message.run, simulation->server.seq,
                    wh_protocol_server_hash(&simulation->server));
    }
    (void)waferhand_mcs_decode_cleanup(&message);
}

/* It is subscribed only so that the record contains whole scans. */
static void on_edge_scan(void *user, const void *data, size_t size) {
    wh_sim_process_t *simulation = user;
    waferhand_edge_scan message;
    if (!wh_link_decode_edge_scan(data, size, &message)) {
        drop(simulation, WH_CHANNEL_EDGE_SCAN, size);
        return;
    }
    (void)waferhand_edge_scan_decode_cleanup(&message);
}

/* It is subscribed only so that the record contains what beams told. */
static void on_latch(void *user, const void *data, size_t size) {
    wh_sim_process_t *simulation = user;
    waferhand_centring message;
    if (!wh_link_decode_centring(data, size, &message)) {
        drop(simulation, WH_CHANNEL_LATCH, size);
        return;
    }
    (void)waferhand_centring_decode_cleanup(&message);
}

/* It is subscribed only so that the record contains requests. Motion control answers them. */
static void on_request(void *user, const void *data, size_t size) {
    wh_sim_process_t *simulation = user;
    waferhand_request message;
    if (!wh_link_decode_request(data, size, &message)) {
        drop(simulation, WH_CHANNEL_REQUEST, size);
        return;
    }
    (void)waferhand_request_decode_cleanup(&message);
}

/* ------------------------------------------------------------------------------------------------ opening */

static bool subscribe(wh_sim_process_t *simulation) {
    static const struct {
        const char *channel;
        void (*hear)(void *user, const void *data, size_t size);
    } heard[] = {{WH_CHANNEL_COMMAND, on_command}, {WH_CHANNEL_RESTORE, on_restore},
                 {WH_CHANNEL_MCS, on_mcs},         {WH_CHANNEL_EDGE_SCAN, on_edge_scan},
                 {WH_CHANNEL_LATCH, on_latch},     {WH_CHANNEL_REQUEST, on_request}};
    bool good = true;
    for (size_t i = 0; good && i < sizeof heard / sizeof heard[0]; ++i) {
        good = wh_node_subscribe(simulation->node, heard[i].channel, heard[i].hear, simulation);
    }
    return good;
}

wh_status_t wh_sim_process_open(wh_sim_process_t *simulation, wh_node_t *node, const wh_layout_t *layout,
                                bool listens) {
    memset(simulation, 0, sizeof *simulation);
    simulation->node = node;
    if (wh_protocol_server_open(&simulation->server, layout) != WH_OK ||
        !wh_link_cell_from_layout(layout, &simulation->server.identity, &simulation->cell) ||
        waferhand_cell_encoded_size(&simulation->cell.message) > WH_LINK_DATAGRAM) {
        return WH_STATUS_BAD_CAPACITY;
    }
    if (listens && !subscribe(simulation)) {
        return WH_STATUS_NO_NETWORK;
    }
    tell_cell(simulation);
    return WH_OK;
}

wh_status_t wh_sim_process_step(wh_sim_process_t *simulation, const waferhand_command *message,
                                wh_state_t *state) {
    handle_command(simulation, message);
    *state = simulation->server.state;
    state->status = (wh_status_t)simulation->server.room.message.status;
    return state->status;
}

bool wh_sim_process_restore(wh_sim_process_t *simulation, const waferhand_state *message) {
    const wh_protocol_server_result_t result = wh_protocol_server_restore(&simulation->server, message);
    act_on(simulation, result);
    return result == WH_SERVER_RESTORED;
}

void wh_sim_process_tick(wh_sim_process_t *simulation) {
    const int64_t now = wh_node_clock_us();
    if (now - simulation->last_cell_us >= WH_SIMULATION_CELL_US) {
        tell_cell(simulation);
    }
    tell_waiting_proximity(simulation, now);
    if (simulation->running && !simulation->silent &&
        now - simulation->last_command_us > WH_SIMULATION_SILENCE_US) {
        simulation->silent = true;
        ++simulation->counters.silences;
        wh_node_warn(simulation->node,
                     "motion control has fallen silent: holding the state of slice %" PRId64,
                     simulation->server.seq);
    }
}

void wh_sim_process_rest(wh_sim_process_t *simulation) {
    if (simulation->proximity_waits) {
        tell_proximity(simulation);
    }
}

void wh_sim_process_close(wh_sim_process_t *simulation) {
    wh_sim_process_rest(simulation);
    wh_protocol_server_close(&simulation->server);
}
