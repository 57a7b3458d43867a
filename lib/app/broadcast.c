#include "broadcast.h"

#include <stddef.h>
#include <string.h>

/* Records command and answer of a slice that fits no block. */
static void record_messages(wh_broadcast_t *broadcast, const waferhand_command *message) {
    const wh_protocol_server_t *server = &broadcast->simulation->server;
    wh_protocol_client_publish(&broadcast->node, message);
    wh_recording_message(&broadcast->record, WH_CHANNEL_STATE, server->encoded, server->encoded_size);
}

/* Steps the command for a record of slices alone: most slices need no message. */
static wh_status_t record(wh_broadcast_t *broadcast, const waferhand_command *message, wh_state_t *state) {
    wh_protocol_server_t *server = &broadcast->simulation->server;
    const wh_protocol_server_result_t result = wh_protocol_server_command(server, message, NULL);
    *state = server->state;
    if (result != WH_SERVER_STEPPED && result != WH_SERVER_NEW_RUN) {
        record_messages(broadcast, message);
        state->status = (wh_status_t)server->room.message.status;
        return state->status;
    }
    const wh_recorded_t recorded =
        wh_recording_slice(&broadcast->record, message, server->simulator.physics.told, server->missed,
                           wh_protocol_server_hash(server), server->state.event_count > 0);
    if (recorded != WH_RECORDED) {
        wh_protocol_server_encode(server);
    }
    if (recorded == WH_RECORDED_STATE) {
        wh_recording_state(&broadcast->record, server->encoded, server->encoded_size);
    } else if (recorded == WH_NOT_RECORDED) {
        record_messages(broadcast, message);
    }
    return state->status;
}

/* The command goes out as a client would send it, but the simulator is called, so that nothing can be lost
 * between the two. */
static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    wh_broadcast_t *broadcast = (wh_broadcast_t *)link;
    waferhand_command message;
    wh_link_command_to_message(command, &broadcast->identity, true, &message);
    broadcast->control.identity = broadcast->identity;
    broadcast->control.utime = command->utime;
    broadcast->control.seq = command->seq;
    if (!broadcast->is_watched) {
        return record(broadcast, &message, state);
    }
    wh_protocol_client_publish(&broadcast->node, &message);
    return wh_sim_process_step(broadcast->simulation, &message, state);
}

static uint64_t last_hash(wh_link_t *link) {
    return wh_protocol_server_hash(&((wh_broadcast_t *)link)->simulation->server);
}

static int64_t missed_slices(wh_link_t *link) {
    (void)link;
    return 0;
}

/* ----------------------------------------------------------------------------------------------- the runs */

/* `user` is the broadcast's motion control. */
static wh_broadcast_t *broadcast_of(void *user) {
    return (wh_broadcast_t *)(void *)((char *)user - offsetof(wh_broadcast_t, control));
}

/* Messages from now on tell the slice in which the run begins, not the last one of the run before. */
static void begin_run(wh_broadcast_t *broadcast) {
    broadcast->identity.run = wh_protocol_client_draw_run();
    broadcast->identity.layout_hash = broadcast->simulation->server.identity.layout_hash;
    broadcast->control.identity = broadcast->identity;
    broadcast->control.seq = 0;
    broadcast->control.utime = 0;
}

/* The earlier run stays as it is until this one can begin. */
static bool open_simulation(wh_broadcast_t *broadcast, const wh_layout_t *layout) {
    wh_sim_process_t *before = broadcast->simulation;
    wh_sim_process_t *simulation = &broadcast->rooms[broadcast->layouts % 2];
    if (wh_sim_process_open(simulation, &broadcast->node, layout, false) != WH_OK) {
        wh_protocol_server_close(&simulation->server);
        return false;
    }
    if (before) {
        wh_mcs_process_tell_over(&broadcast->control);
        wh_sim_process_close(before);
    }
    ++broadcast->layouts;
    broadcast->simulation = simulation;
    simulation->server.encodes_later = !broadcast->is_watched;
    return true;
}

static wh_link_t *connect_simulation(void *user, wh_mcs_t *mcs) {
    wh_broadcast_t *broadcast = broadcast_of(user);
    const wh_layout_t *layout = wh_mcs_layout(mcs);
    if (layout->wafer_count > WH_LINK_WAFERS) {
        fprintf(stderr, "%s: %zu wafers (expected at most %d, for messages and recordings carry no more)\n",
                layout->path, layout->wafer_count, WH_LINK_WAFERS);
        return NULL;
    }
    if (!open_simulation(broadcast, layout)) {
        return NULL;
    }
    begin_run(broadcast);
    wh_mcs_process_catch_up(&broadcast->control, mcs);
    return &broadcast->link;
}

/* A byte before the first slice; behind it stands the state as it would arrive. */
static size_t save(void *user, uint8_t bytes[WH_MCS_SAVED_BYTES]) {
    wh_protocol_server_t *server = &broadcast_of(user)->simulation->server;
    if (server->seq == 0) {
        bytes[0] = 0;
        return 1;
    }
    wh_protocol_server_encode(server);
    memcpy(bytes, server->encoded, server->encoded_size);
    return server->encoded_size;
}

/* The state goes out as a client would send it back. */
static bool put_back(wh_broadcast_t *broadcast, const uint8_t bytes[], size_t size) {
    static uint8_t encoded[WH_LINK_DATAGRAM];
    waferhand_state message;
    if (!wh_link_decode_state(bytes, size, &message)) {
        return false;
    }
    message.run = broadcast->identity.run;
    const int length = waferhand_state_encode(encoded, 0, (int)sizeof encoded, &message);
    wh_link_seal(encoded, length > 0 ? (size_t)length : 0);
    (void)wh_node_publish(&broadcast->node, WH_CHANNEL_RESTORE, encoded, length > 0 ? (size_t)length : 0);
    const bool is_taken = wh_sim_process_restore(broadcast->simulation, &message);
    (void)waferhand_state_decode_cleanup(&message);
    return is_taken;
}

/* Another run begins: the earlier one is over. */
static wh_status_t restore(void *user, const uint8_t bytes[], size_t size, wh_state_t *state) {
    wh_broadcast_t *broadcast = broadcast_of(user);
    if (size == 1) {
        const wh_layout_t *layout = broadcast->simulation->server.layout;
        if (!open_simulation(broadcast, layout)) {
            return WH_STATUS_NOT_RESTORED;
        }
        begin_run(broadcast);
        return WH_OK;
    }
    wh_mcs_process_tell_over(&broadcast->control);
    begin_run(broadcast);
    if (!put_back(broadcast, bytes, size)) {
        return WH_STATUS_NOT_RESTORED;
    }
    *state = broadcast->simulation->server.state;
    state->event_count = 0;
    broadcast->control.seq = state->seq;
    broadcast->control.utime = state->utime;
    return WH_OK;
}

/* Once a script's run has ended its layout is freed with it. */
static void tell_news(void *user, const wh_mcs_t *mcs, wh_mcs_news_t news,
                      const wh_command_record_t *command) {
    wh_broadcast_t *broadcast = broadcast_of(user);
    wh_mcs_process_partners(&broadcast->control).tell(user, mcs, news, command);
    if (news == WH_MCS_FINISHED && broadcast->simulation) {
        wh_sim_process_rest(broadcast->simulation);
    }
}

/* --------------------------------------------------------------------------------- opening and closing */

bool wh_broadcast_open(wh_broadcast_t *broadcast, const char *program, const wh_record_arguments_t *record,
                       bool is_lcm, const char *url) {
    const wh_protocol_client_options_t lockstep = {.rate = 0};
    const char *place = is_lcm ? url : "memq://";
    memset(broadcast, 0, sizeof *broadcast);
    broadcast->link = (wh_link_t){exchange, last_hash, missed_slices};
    broadcast->is_watched = is_lcm || record->all;
    wh_record_arguments_apply(record, program, true, &broadcast->record);
    if ((is_lcm && !wh_node_reaches_others(place)) ||
        !wh_recording_open_node(&broadcast->record, &broadcast->node, place)) {
        return false;
    }
    if (!wh_mcs_process_open(&broadcast->control, &broadcast->node, &lockstep)) {
        wh_node_close(&broadcast->node);
        (void)wh_recording_close(&broadcast->record);
        return false;
    }
    return true;
}

wh_mcs_partners_t wh_broadcast_partners(wh_broadcast_t *broadcast) {
    const wh_mcs_partners_t told = wh_mcs_process_partners(&broadcast->control);
    return (wh_mcs_partners_t){.connect = connect_simulation,
                               .save = save,
                               .restore = restore,
                               .tell = tell_news,
                               .turn = told.turn,
                               .user = told.user};
}

void wh_broadcast_tick(wh_broadcast_t *broadcast) {
    if (broadcast->simulation) {
        wh_sim_process_tick(broadcast->simulation);
    }
}

bool wh_broadcast_close(wh_broadcast_t *broadcast) {
    wh_mcs_process_finish(&broadcast->control);
    wh_mcs_process_close(&broadcast->control);
    if (broadcast->simulation) {
        wh_sim_process_close(broadcast->simulation);
    }
    wh_node_close(&broadcast->node);
    return wh_recording_close(&broadcast->record);
}
