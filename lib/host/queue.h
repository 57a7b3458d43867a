/* Requests that wait behind the action that runs: queued actions, and queries that are answered when their
 * controller is idle. They belong to the leader of the ports that share a dialect. */
#ifndef WH_HOST_QUEUE_H
#define WH_HOST_QUEUE_H

#include "state.h"

/* The port whose action was accepted and has not ended, among those that share this one's dialect; null:
 * none. */
wh_controller_t *wh_controller_acting(const wh_controller_t *controller);

/* Appends a request, which belongs to the queue from here on, with its lines; null: it has none yet. */
wh_pending_t *wh_queue_append(wh_controller_t *from, wh_request_t *request, const wh_lines_t *lines);

/* How many actions wait. */
int wh_queue_actions(const wh_controller_t *controller);

/* Takes the first one off; null: none waits. It goes to wh_queue_free. */
wh_pending_t *wh_queue_take(wh_controller_t *controller);
void wh_queue_free(wh_pending_t *pending);

/* Drops what this port's client has asked for. */
void wh_queue_drop_client(wh_controller_t *from);

/* True if this port's client waits for an answer. */
bool wh_controller_owes(const wh_controller_t *controller);

#endif
