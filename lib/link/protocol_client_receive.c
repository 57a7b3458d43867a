/* What the client takes: states of its run that are sound, refusals of its command. */
#include <string.h>

#include "../grasp/restore.h"
#include "protocol_client_internal.h"

static void heard(wh_protocol_client_t *client) {
    client->last_heard_us = wh_node_clock_us();
    if (client->silent) {
        client->silent = false;
        wh_protocol_client_say(client, "the simulator answers again");
    }
}

/* A table of the layout's rules, and of the state's counts and slice. */
static wh_grasp_t table_over(const wh_protocol_client_t *client, wh_link_arrays_t *arrays,
                             const wh_state_t *state, int64_t missed) {
    wh_grasp_t table;
    memset(&table, 0, sizeof table);
    table.config = client->options.layout->grasp;
    table.slice = (uint64_t)(state->seq - missed);
    table.storage.wafers = arrays->wafers;
    table.storage.wafer_count = state->wafer_count;
    table.storage.grippers = arrays->grippers;
    table.storage.gripper_count = state->gripper_count;
    return table;
}

/* Whether it is the state whose hash it carries, and one that a table could be in: then it is in client->arrays. */
static bool take_over(wh_protocol_client_t *client, const wh_state_t *state, const waferhand_state *message) {
    const wh_grasp_t as_told = table_over(client, &client->spare, state, message->missed);
    wh_grasp_t table = table_over(client, &client->arrays, state, message->missed);
    return wh_physics_state_validate(state->condition, state->gripper_count, state->wafer_count) == WH_OK &&
           wh_physics_state_hash(state->condition, &as_told) == (uint64_t)message->hash &&
           wh_grasp_restore(&table, as_told.slice, state->wafers, state->grippers) == WH_OK;
}

static bool is_sound(wh_protocol_client_t *client, const waferhand_state *message, wh_state_t *state) {
    const wh_layout_t *layout = client->options.layout;
    return wh_link_state_from_message(message, &layout->grasp.tolerance, &client->spare, state) == WH_OK &&
           state->wafer_count == layout->wafer_count &&
           state->gripper_count == layout->machine.gripper_count && message->missed >= 0 &&
           message->missed < message->seq && take_over(client, state, message);
}

static void keep_events(wh_protocol_client_t *client, const wh_state_t *state) {
    const size_t room = sizeof client->events / sizeof client->events[0] - client->event_count;
    const size_t count = state->event_count < room ? state->event_count : room;
    memcpy(client->events + client->event_count, state->events, count * sizeof *state->events);
    client->event_count += count;
}

static void take(wh_protocol_client_t *client, const waferhand_state *message, const wh_state_t *state,
                 const void *data, size_t size) {
    if (!client->has_state || state->seq != client->state.seq) {
        keep_events(client, state);
    }
    client->state = *state;
    client->state.wafers = client->arrays.wafers;
    client->state.grippers = client->arrays.grippers;
    client->arrays.condition = *state->condition;
    client->state.condition = &client->arrays.condition;
    client->has_state = true;
    client->missed = message->missed;
    client->hash = (uint64_t)message->hash;
    memcpy(client->restore, data, size);
    client->restore_size = size;
    ++client->counters.answers;
    client->answered = client->answered || state->seq == client->command.seq;
}

static void take_refusal(wh_protocol_client_t *client, const waferhand_state *message) {
    if (message->seq != client->command.seq) {
        ++client->counters.unasked;
    } else if (message->status == WH_STATUS_UNKNOWN_RUN) {
        client->asked_for_state = true;
    } else {
        client->refusal = (wh_status_t)message->status;
    }
}

static void take_message(wh_protocol_client_t *client, const waferhand_state *message, const void *data,
                         size_t size) {
    wh_state_t state;
    const bool wanted = message->seq == client->command.seq ||
                        (wh_protocol_client_is_free_running(client) && message->seq > client->state.seq &&
                         message->seq < client->command.seq);
    if (message->run != client->identity.run) {
        ++client->counters.unasked;
        return;
    }
    heard(client);
    if (message->status != WH_OK) {
        take_refusal(client, message);
    } else if (!wanted) {
        ++client->counters.unasked;
    } else if (!is_sound(client, message, &state)) {
        ++client->counters.malformed;
    } else {
        take(client, message, &state, data, size);
    }
}

void wh_protocol_client_on_state(void *user, const void *data, size_t size) {
    wh_protocol_client_t *client = user;
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        ++client->counters.malformed;
        return;
    }
    take_message(client, &message, data, size);
    (void)waferhand_state_decode_cleanup(&message);
}
