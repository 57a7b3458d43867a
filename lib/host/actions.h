/* Actions that run: their clock, their STOP and their end. */
#ifndef WH_HOST_ACTIONS_H
#define WH_HOST_ACTIONS_H

#include "state.h"

/* The clock of the running action begins. */
void wh_host_begin_clock(wh_host_t *host, wh_controller_t *controller);

/* If ports move side by side: this controller's running action ends with this error. */
void wh_controller_end_job(wh_controller_t *controller, wh_status_t status, const char *why);

/* Actions that wait behind what runs end as STOPPED; queries go on waiting. */
void wh_controller_stop_queue(wh_controller_t *controller);

/* Actions that are answered when they begin, and have begun, are answered now. */
void wh_host_tell_begun(wh_host_t *host);

/* Ends this port's running action. */
void wh_controller_stop_running(wh_controller_t *controller);

/* A HOLD of this controller, if one stands, does so no more: what it holds is to stop where it stands. */
void wh_controller_release_to_stop(wh_controller_t *controller);

/* A STOP that comes from no port: running actions end, and waiting ones are not begun. */
void wh_host_stop(wh_host_t *host);

/* The operator's stop: ends running actions, and begins nothing more. */
void wh_host_end(wh_host_t *host);

/* Stops likewise if the status says that a signal has ended a command during a wait for a simulator. */
void wh_host_heed_stop(wh_host_t *host, wh_status_t status);

/* An action has ended, or was never begun: its host is told. */
void wh_controller_end(wh_controller_t *controller, wh_status_t number, const char *text, double seconds);
void wh_controller_end_unbegun(wh_controller_t *controller, wh_status_t number, const char *reason);

#endif
