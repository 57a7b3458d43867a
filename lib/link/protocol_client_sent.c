/* Finds out if the simulator did something that motion control has not asked for. */
#include <inttypes.h>
#include <stdio.h>

#include "../math/hash.h"
#include "protocol_client_internal.h"

static wh_protocol_client_sent_t *place_of(wh_protocol_client_t *client, int64_t seq) {
    return &client->sent[(uint64_t)seq % WH_CLIENT_SENT];
}

void wh_protocol_client_note_sent(wh_protocol_client_t *client) {
    const waferhand_command *command = &client->command;
    uint64_t hash = WH_HASH_START;
    for (int32_t g = 0; g < command->gripper_count; ++g) {
        hash = wh_hash_doubles(hash, command->gripper_position[g], 3);
        hash = wh_hash_doubles(hash, command->gripper_rotation[g], 9);
    }
    *place_of(client, command->seq) = (wh_protocol_client_sent_t){command->seq, hash};
}

/* True with faults that keep grippers from their targets. */
static bool may_stand(const waferhand_state *message) {
    bool may = false;
    for (int32_t i = 0; i < message->fault_count; ++i) {
        const int32_t kind = message->faults[i].it.kind;
        may = may || kind == WH_FAULT_AXIS_STOPPED || kind == WH_FAULT_COMMAND_LOST;
    }
    return may;
}

static void disturb(wh_protocol_client_t *client, const char *what, int64_t seq) {
    ++client->counters.disturbed;
    if (client->disturbance[0] == '\0') {
        (void)snprintf(client->disturbance, sizeof client->disturbance,
                       "%s at slice %" PRId64 " (expected one sender of commands at a URL)", what, seq);
        wh_node_warn(client->node, "%s", client->disturbance);
    }
}

void wh_protocol_client_compare(wh_protocol_client_t *client, const waferhand_state *message) {
    const wh_protocol_client_sent_t *sent = place_of(client, message->seq);
    uint64_t hash = WH_HASH_START;
    if (sent->seq != message->seq || may_stand(message)) {
        return;
    }
    for (int32_t g = 0; g < message->gripper_count; ++g) {
        hash = wh_hash_doubles(hash, message->grippers[g].position, 3);
        hash = wh_hash_doubles(hash, message->grippers[g].rotation, 9);
    }
    if (hash != sent->poses) {
        disturb(client, "the simulator's grippers are not where they were sent", message->seq);
    }
}

/* The first command of our run is our own, because nobody else knows its number before. An encoded command
 * begins with fingerprint, utime, seq, run. */
void wh_protocol_client_overhear(void *user, const void *data, size_t size) {
    wh_protocol_client_t *client = user;
    const uint8_t *bytes = data;
    const uint64_t sender = client->node->sender;
    if (sender == 0 || !client->layout || size < 32 ||
        wh_link_word(bytes + 24, 8) != (uint64_t)client->identity.run) {
        return;
    }
    client->own = client->own != 0 ? client->own : sender;
    if (sender != client->own) {
        disturb(client, "another process commands the simulator in this run, first",
                (int64_t)wh_link_word(bytes + 16, 8));
    }
}
