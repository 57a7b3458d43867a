/* Puts a run back to an earlier state: motion control's side. */
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "protocol_client.h"

/* It waits this long for the state of the last slice. */
#define SETTLE_US 100000
/* A simulator that asks for the state gets it this number of times. In a lossy network it asks several
 * times. */
#define RESTORES_MOST 20

size_t wh_protocol_client_save(wh_protocol_client_t *client, uint8_t bytes[]) {
    const bool has_begun = client->command.seq > 0;
    if (has_begun && (!wh_protocol_client_settle(client, SETTLE_US) || !client->taken.is_there)) {
        return 0;
    }
    memcpy(bytes, &client->command, sizeof client->command);
    memcpy(bytes + sizeof client->command, client->restoring.bytes, client->restoring.size);
    return sizeof client->command + client->restoring.size;
}

/* The client takes the state as if it came now, in its new run. */
static bool take_again(wh_protocol_client_t *client, const uint8_t bytes[], size_t size) {
    static uint8_t encoded[WH_LINK_DATAGRAM];
    waferhand_state message;
    if (!wh_link_decode_state(bytes, size, &message)) {
        return false;
    }
    message.run = client->identity.run;
    const int length = waferhand_state_encode(encoded, 0, (int)sizeof encoded, &message);
    (void)waferhand_state_decode_cleanup(&message);
    if (length <= 0) {
        return false;
    }
    wh_link_seal(encoded, (size_t)length);
    wh_protocol_client_hear(client, encoded, (size_t)length);
    return client->taken.is_there;
}

/* The taken state is no news, because the simulator has yet to get it. */
static wh_status_t hand_over(wh_protocol_client_t *client) {
    client->heard.count = 0;
    client->heard.has_lost = false;
    client->heard.delivered = 0;
    client->answered = false;
    client->pending = true;
    client->restoring.count = 0;
    client->restoring.most = RESTORES_MOST;
    const wh_status_t status = wh_protocol_client_resume(client);
    client->restoring.most = 0;
    return status;
}

static wh_status_t begin_there(wh_protocol_client_t *client, const uint8_t bytes[], size_t size) {
    const int64_t asked_us = client->silence.asked_us;
    wh_protocol_client_begin(client, client->layout);
    client->silence.asked_us = asked_us;
    const int64_t run = client->identity.run;
    if (size == sizeof client->command) {
        return WH_OK; /* before the first slice the run is at its beginning */
    }
    memcpy(&client->command, bytes, sizeof client->command);
    client->command.run = run;
    return take_again(client, bytes + sizeof client->command, size - sizeof client->command)
               ? hand_over(client)
               : WH_STATUS_NOT_RESTORED;
}

wh_status_t wh_protocol_client_restore(wh_protocol_client_t *client, const uint8_t bytes[], size_t size,
                                       wh_state_t *state) {
    wh_protocol_client_t *before = wh_array_new(1, sizeof *before);
    *before = *client;
    const wh_status_t status = begin_there(client, bytes, size);
    if (status != WH_OK) {
        const wh_protocol_client_counters_t counters = client->counters;
        *client = *before;
        client->counters = counters;
    } else if (client->taken.is_there) {
        *state = client->taken.state;
        state->event_count = 0;
    }
    free(before);
    return status;
}
