/* Shared by mcs_process.c, which tells, and mcs_requests.c, which answers. */
#ifndef WH_LINK_MCS_PROCESS_INTERNAL_H
#define WH_LINK_MCS_PROCESS_INTERNAL_H

#include "mcs_process.h"

/* A message with the present state, which borrows the texts. `request` is the request that it answers or
 * continues; 0: none. */
waferhand_mcs wh_mcs_process_message(wh_mcs_process_t *control, int64_t request, int32_t phase,
                                     wh_status_t error, const char *command, const char *text);

void wh_mcs_process_publish(wh_mcs_process_t *control, const waferhand_mcs *message);

/* Makes and publishes such a message. `line` is the script's; 0: none. */
void wh_mcs_process_tell(wh_mcs_process_t *control, int64_t request, int32_t phase, int line,
                         wh_status_t error, const char *command, const char *text);

/* Tells on WAFERHAND_EDGE_SCAN that the scan has ended, with the estimate. */
void wh_mcs_process_tell_edge(wh_mcs_process_t *control, const wh_mcs_t *mcs);
/* Tells the centring by beams on WAFERHAND_LATCH. */
void wh_mcs_process_tell_centring(wh_mcs_process_t *control, const wh_mcs_t *mcs);

/* Handles a datagram on WAFERHAND_REQUEST; `user` is the control. */
wh_node_handler_t wh_mcs_process_on_request;

/* Answers the requests that wait, without beginning them. */
void wh_mcs_process_clear(wh_mcs_process_t *control);

#endif
