/* The robots' own controllers, as requests change them: CONTROLLER power=off, also while something runs. */
#ifndef WH_HOST_CONDITIONS_H
#define WH_HOST_CONDITIONS_H

#include "state.h"

/* Takes the changes of these lines, CONTROLLER and options. WH_OK, or the first refusal with its reason; the
 * lines before it are taken then. */
wh_status_t wh_controller_change(wh_controller_t *controller, const wh_lines_t *lines,
                                 char reason[WH_MCS_CHANGE_BYTES]);

/* Writes what the port's robot has, as name=value pairs; with several robots and a port of all of them what
 * the first one has. */
void wh_controller_tell_conditions(const wh_controller_t *controller, char *text, size_t size);

/* Likewise, of this robot. */
void wh_host_tell_conditions(const wh_host_t *host, size_t robot, char *text, size_t size);

/* Takes what each dialect says in `begins`: at the start, and once a RESET has read the layout anew. False,
 * with the reason as the dialect's message, if a line was refused. */
bool wh_controller_begin_conditions(wh_controller_t *controller);

#endif
