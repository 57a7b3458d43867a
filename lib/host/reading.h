/* From the bytes of a port to frames, which become requests. */
#ifndef WH_HOST_READING_H
#define WH_HOST_READING_H

#include "state.h"

/* Takes the bytes that have come and sends those that are due. Returns what happened at the port. */
unsigned wh_controller_serve(wh_controller_t *controller);

/* The next time at which wh_controller_serve has something to do by itself; INT64_MAX: none. */
int64_t wh_controller_due(const wh_controller_t *controller);

#endif
