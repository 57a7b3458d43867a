/* Between mcs_process.c, which tells, and mcs_requests.c, which answers. */
#ifndef WH_LINK_MCS_PROCESS_INTERNAL_H
#define WH_LINK_MCS_PROCESS_INTERNAL_H

#include "mcs_process.h"

/* A message as of now, which borrows the texts. `request` is the one that it answers or goes on with; 0:
 * none. */
waferhand_mcs wh_mcs_process_message(wh_mcs_process_t *control, int64_t request, int32_t phase,
                                     wh_status_t error, const char *command, const char *text);

void wh_mcs_process_publish(wh_mcs_process_t *control, const waferhand_mcs *message);

/* Both. `line`: of the script; 0: none. */
void wh_mcs_process_tell(wh_mcs_process_t *control, int64_t request, int32_t phase, int line,
                         wh_status_t error, const char *command, const char *text);

/* The scan in mcs->edge has ended: on WAFERHAND_EDGE_SCAN, with what the estimate says; `user` is the
 * control. */
void wh_mcs_process_tell_edge(void *user, const wh_mcs_t *mcs);
/* What mcs->centring is: on WAFERHAND_LATCH; likewise. */
void wh_mcs_process_tell_centring(void *user, const wh_mcs_t *mcs);

/* A datagram on WAFERHAND_REQUEST; `user` is the control. */
wh_node_handler_t wh_mcs_process_on_request;

/* Answers the requests that wait without beginning them. */
void wh_mcs_process_clear(wh_mcs_process_t *control);

#endif
