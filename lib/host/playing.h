/* Plays accepted actions. */
#ifndef WH_HOST_PLAYING_H
#define WH_HOST_PLAYING_H

#include "state.h"

/* Plays the accepted action to its end; with several ports, also all actions that come meanwhile. */
void wh_controller_play(wh_controller_t *controller);

#endif
