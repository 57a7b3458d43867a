/* Questions about what runs, waits and is held. They change nothing. */
#ifndef WH_HOST_STATUS_H
#define WH_HOST_STATUS_H

#include "state.h"

/* True if ports move side by side: there are several, or the one is not the cell's. */
bool wh_host_plays_jobs(const wh_host_t *host);

/* The number of a controller's job is one more than that of the first port of its dialect. */
int32_t wh_controller_job(const wh_controller_t *controller);

/* True if this controller has a port of its own, and no further client's of a port that several share. */
bool wh_host_is_first_of_port(const wh_host_t *host, size_t i);

/* The action that was accepted first and has not begun; null: none. */
wh_controller_t *wh_host_next_action(const wh_host_t *host);

/* True if its action is one of the whole cell that nothing may go beside: RESET, SAVE, RESTORE or UNDO. */
bool wh_controller_needs_all(const wh_controller_t *controller);

/* True if the running action waits for something that another port has. */
bool wh_controller_waits(const wh_controller_t *controller);

/* True while a HOLD of this controller stands; to a tester, of any. */
bool wh_controller_is_held(const wh_controller_t *controller);

/* True while a HOLD stands and all else that runs waits: then the run stands still. */
bool wh_host_is_held(const wh_host_t *host);

/* True if all running actions were stopped. */
bool wh_host_is_stopped(const wh_host_t *host);

/* Like wh_mcs_describe, but with several controllers the running command and the last failure are this
 * controller's own; a tester is told the latest failure of any, with `error_port`. */
void wh_controller_describe(const wh_controller_t *controller, char text[WH_MCS_DESCRIPTION_BYTES]);

/* A port's name in events and in a tester's STATUS: its mechanism's name, or kind. */
const char *wh_controller_known_as(const wh_controller_t *controller);

#endif
