/* What the client sends: commands, again and again, and the state to a simulator that has none. */
#include <inttypes.h>

#include "checksum.h"
#include "protocol_client_internal.h"

void wh_protocol_client_send(wh_protocol_client_t *client) {
    const int size =
        waferhand_command_encode(client->encoded, 0, (int)sizeof client->encoded, &client->command);
    if (size > 0) {
        wh_link_seal(client->encoded, (size_t)size);
        (void)wh_node_publish(client->node, WH_CHANNEL_COMMAND, client->encoded, (size_t)size);
    }
}

void wh_protocol_client_send_again(wh_protocol_client_t *client) {
    ++client->counters.repeated;
    wh_protocol_client_send(client);
}

void wh_protocol_client_restore(wh_protocol_client_t *client) {
    const bool asked = client->asked_for_state;
    client->asked_for_state = false;
    if (!asked || !client->has_state) {
        return;
    }
    ++client->counters.restored;
    wh_protocol_client_say(client, "the simulator was started anew: it gets the state of slice %" PRId64,
                           client->state.seq);
    (void)wh_node_publish(client->node, WH_CHANNEL_RESTORE, client->restore, client->restore_size);
    wh_protocol_client_send_again(client);
}
