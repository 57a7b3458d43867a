/* HOLD and CONTINUE of a flow's robots from a page: the page's thread asks, and the stepping thread carries
 * it out between two slices. */
#ifndef WH_APP_LIVE_HOLD_H
#define WH_APP_LIVE_HOLD_H

#include <stdbool.h>

#include "../mcs/flow_held.h"

/* Zero it to begin with. */
typedef struct {
    int stage; /* atomic: whose turn it is; the rest is theirs */
    bool is_held;
    char robot[WH_NAME_SIZE]; /* empty: all of them */
    wh_status_t status;
    char reason[WH_MCS_HOLD_BYTES];
} wh_live_hold_t;

/* The page's thread asks, and waits at most a second. WH_STATUS_NOT_IN_PHASE, with a reason, also if no slice
 * of a flow comes by then. */
wh_status_t wh_live_hold_ask(wh_live_hold_t *hold, const char *robot, bool is_held,
                             char reason[WH_MCS_HOLD_BYTES]);

/* The stepping thread carries out what was asked. */
void wh_live_hold_take(wh_live_hold_t *hold, wh_mcs_t *mcs);

#endif
