/* Within motion control: counted time. Slices in which nothing can be decided are left out: neither the
 * simulator nor a listener sees them, and all that depends on them is as if they had been played. See
 * `run --counted`. */
#ifndef WH_MCS_COUNTED_H
#define WH_MCS_COUNTED_H

#include "../trial/quiet.h"
#include "native.h"
#include "verify.h"

struct wh_counted {
    wh_quiet_t quiet;
    int64_t again; /* nothing is asked before this slice has been played */
    wh_verify_t verify;
};

/* Time is counted from now on, if the caller wants it and nobody looks at each slice. */
void wh_mcs_begin_counting(lua_State *L, wh_mcs_t *mcs);

/* Leaves out next slices, `most` at most, between two slices of a portion. The slice after them is still to
 * be played, and so is each segment's last one. Returns their number; 0: the next slice must be played. */
int64_t wh_mcs_leave_out(wh_mcs_t *mcs, int64_t most);

/* How a verified stretch was not as it was counted; empty: all were. */
const char *wh_mcs_miscounted(const wh_mcs_t *mcs);

#endif
