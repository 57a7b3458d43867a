/* Events to hosts and testers: what befalls wafers, grippers, doors, load ports, robots' own controllers, and
 * actions. Each goes to the ports that it concerns, if their dialect asks for its kind. */
#ifndef WH_HOST_EVENTS_H
#define WH_HOST_EVENTS_H

#include "state.h"

/* An action begins. The state at the begin of a run is no event; a change between two actions is one. */
void wh_host_look(wh_host_t *host);

/* All that this slice has brought. */
void wh_host_tell_slice(wh_host_t *host, const wh_command_t *command, const wh_state_t *state);

/* Tells which load ports do something else than when they were told last; at first they are only seen. */
void wh_host_tell_load_ports(wh_host_t *host);

/* Tells which robots' own controllers have changed since they were told last. */
void wh_host_tell_modes(wh_host_t *host);

/* This controller's action has ended, or its HOLD begins or ends: told at its own ports and to testers. */
void wh_controller_tell_others(const wh_controller_t *controller, wh_host_event_kind_t kind, int value);

#endif
