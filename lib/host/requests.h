/* Decides about requests: which pass while something runs, which are begun, and which are refused. */
#ifndef WH_HOST_REQUESTS_H
#define WH_HOST_REQUESTS_H

#include "state.h"

/* Takes a frame that has come. */
void wh_controller_take(wh_controller_t *controller, const wh_frame_t *frame);

/* Requests that wait for controllers which are idle now go on. True if something did. */
bool wh_host_go_on(wh_host_t *host);

/* Does what is due by time. */
void wh_controller_tick(wh_controller_t *controller);

/* Stops waiting for the acknowledgement that is owed. If none is owed, the action that waits for its turn
 * ends. */
void wh_controller_give_up_waiting(wh_controller_t *controller);

#endif
