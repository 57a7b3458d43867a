/* Takes the simulator's states: each is checked, kept to restore a simulator by, and handed on. */
#include <inttypes.h>
#include <string.h>

#include "../grasp/restore.h"
#include "protocol_client_internal.h"

bool wh_protocol_client_is_free(const wh_protocol_client_t *client) {
    return client->options.rate > 0 && client->taken.is_there;
}

/* Notes that the simulator lives. */
static void heard(wh_protocol_client_t *client) {
    client->silence.asked_us = 0;
    client->silence.timed_out = false;
    if (client->silence.is_told) {
        client->silence.is_told = false;
        wh_node_say(client->node, "the simulator answers again");
    }
    if (wh_senders_hear(&client->senders, client->node->sender)) {
        wh_node_warn(client->node, "two simulators answer (expected one at a URL: stop the other one, or "
                                   "give it another --lcm-url)");
    }
}

/* Copies the state to client->arrays. Returns false if it is not sound, or no grasp table could be in
 * it. */
static bool take_over(wh_protocol_client_t *client, const waferhand_state *message, wh_state_t *state) {
    const wh_layout_t *layout = client->layout;
    if (!wh_link_state_is_sound(message, layout, &client->spare, state)) {
        return false;
    }
    wh_grasp_t table = wh_link_table(message, layout, &client->taken.arrays);
    return wh_grasp_restore(&table, table.slice, state->wafers, state->grippers) == WH_OK;
}

static void take(wh_protocol_client_t *client, const waferhand_state *message, const wh_state_t *state,
                 const void *data, size_t size) {
    const bool is_new = !client->taken.is_there || state->seq != client->taken.state.seq;
    if (is_new) {
        const size_t room =
            sizeof client->heard.events / sizeof client->heard.events[0] - client->heard.count;
        const size_t count = state->event_count < room ? state->event_count : room;
        memcpy(client->heard.events + client->heard.count, state->events, count * sizeof *state->events);
        client->heard.count += count;
        client->heard.has_lost =
            client->heard.has_lost || state->has_lost_events || count < state->event_count;
    }
    client->taken.state = *state;
    client->taken.state.wafers = client->taken.arrays.wafers;
    client->taken.state.grippers = client->taken.arrays.grippers;
    client->taken.arrays.physics = *state->physics;
    client->taken.state.physics = &client->taken.arrays.physics;
    client->taken.is_there = true;
    if (is_new) {
        wh_protocol_client_compare(client, message);
    }
    if (is_new && client->options.taken) {
        client->options.taken(client->options.user, &client->taken.state);
    }
    client->taken.missed = message->missed;
    client->taken.hash = (uint64_t)message->hash;
    memcpy(client->restoring.bytes, data, size);
    client->restoring.size = size;
    ++client->counters.answers;
    client->answered = client->answered || state->seq == client->command.seq;
}

/* True for a slice whose state has not come yet: the last one sent, and in a free run those before it. */
static bool is_awaited(const wh_protocol_client_t *client, int64_t seq) {
    return seq == client->command.seq ||
           (wh_protocol_client_is_free(client) && seq > client->taken.state.seq && seq < client->command.seq);
}

static void take_refusal(wh_protocol_client_t *client, const waferhand_state *message) {
    if (!is_awaited(client, message->seq)) {
        ++client->counters.unasked;
    } else if (message->status == WH_STATUS_UNKNOWN_RUN) {
        client->restoring.is_asked = true;
    } else {
        client->refusal = (wh_status_t)message->status;
        client->other_layout_hash = (uint64_t)message->layout_hash;
    }
}

/* A state that cannot be is no answer: the wait for one goes on, and ends as for a silent simulator. */
static void refuse_state(wh_protocol_client_t *client, int64_t seq) {
    if (client->counters.malformed++ == 0) {
        wh_node_warn(client->node,
                     "the simulator's state of slice %" PRId64 " cannot be one of this layout: it "
                     "is not taken (expected the states of one simulator of this version)",
                     seq);
    }
}

static void take_message(wh_protocol_client_t *client, const waferhand_state *message, const void *data,
                         size_t size) {
    wh_state_t state;
    if (!client->layout || message->run != client->identity.run) {
        ++client->counters.unasked;
        return;
    }
    const bool is_ours = message->status == WH_OK && is_awaited(client, message->seq);
    if (is_ours && !take_over(client, message, &state)) {
        refuse_state(client, message->seq);
        return;
    }
    heard(client);
    if (message->status != WH_OK) {
        take_refusal(client, message);
    } else if (!is_ours) {
        ++client->counters.unasked;
    } else {
        take(client, message, &state, data, size);
    }
}

void wh_protocol_client_hear(wh_protocol_client_t *client, const void *data, size_t size) {
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        ++client->counters.malformed;
        return;
    }
    take_message(client, &message, data, size);
    (void)waferhand_state_decode_cleanup(&message);
}
