/* Internals of motion control's side of the protocol: what it hears, and checks that nobody else commands. */
#ifndef WH_LINK_PROTOCOL_CLIENT_INTERNAL_H
#define WH_LINK_PROTOCOL_CLIENT_INTERNAL_H

#include "protocol_client.h"

/* True from the second slice of a free-running run on. Its first slice is in lockstep. */
bool wh_protocol_client_is_free(const wh_protocol_client_t *client);

/* Keeps the grippers' targets of the command that is about to be sent. */
void wh_protocol_client_note_sent(wh_protocol_client_t *client);

/* Counts and tells it if the state's grippers are not at their targets of its slice. */
void wh_protocol_client_compare(wh_protocol_client_t *client, const waferhand_state *message);

/* Hears the commands' channel, our own commands included. It counts and tells commands of our run that
 * another process sends. */
void wh_protocol_client_overhear(void *user, const void *data, size_t size);

#endif
