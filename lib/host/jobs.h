/* Several ports: their actions are played side by side, as jobs of a session. */
#ifndef WH_HOST_JOBS_H
#define WH_HOST_JOBS_H

#include "state.h"

/* Plays the accepted actions, and all that come meanwhile. */
void wh_host_play_jobs(wh_host_t *host);

#endif
