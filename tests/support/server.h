/* A server that is called directly: requests of motion control go to it as messages, without a
 * network. For one file of a test. */
#ifndef WH_TESTS_SUPPORT_SERVER_H
#define WH_TESTS_SUPPORT_SERVER_H

#include "support/support.h"

#include "link/protocol_server.h"
#include "wire/messages.h"

enum { TEST_RUN = 4711 };

/* The server that answers; a test may replace it in the middle of a run. */
static wh_protocol_server_t *server;

static inline waferhand_command message_of(const wh_command_t *command) {
    const wh_link_identity_t identity = {TEST_RUN, server->identity.layout_hash};
    waferhand_command message;
    wh_link_command_to_message(command, &identity, true, &message);
    return message;
}

/* Writes the bytes that a network would carry; returns how many there are. */
static inline size_t encode_command(const wh_command_t *command, uint8_t bytes[], size_t room) {
    const waferhand_command message = message_of(command);
    const int size = waferhand_command_encode(bytes, 0, (int)room, &message);
    assert_true(size > 0);
    wh_link_seal(bytes, (size_t)size);
    return (size_t)size;
}

static inline uint64_t hash_of_server(wh_link_t *link) {
    (void)link;
    return wh_protocol_server_hash(server);
}

static inline int64_t none_missed(wh_link_t *link) {
    (void)link;
    return 0;
}

#endif
