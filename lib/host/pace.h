/* The pace of a serial line: how many of the waiting bytes are through by now.
 *
 * A byte takes `bits` of `baud`, in simulated time, to the microsecond and without drift. Each direction of a
 * port has a pace of its own. */
#ifndef WH_HOST_PACE_H
#define WH_HOST_PACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The slowest and the fastest line that can be asked for; bits of a byte with its start and stop bit. */
#define WH_PACE_LEAST 110
#define WH_PACE_MOST 4000000
#define WH_PACE_BITS 10

/* `baud` 0: no pace, all bytes are through at once. The rest zero to begin with. */
typedef struct {
    int64_t baud;
    bool is_busy; /* bytes are on the line since `begin_us`, without a gap */
    int64_t begin_us;
    uint64_t through; /* of them */
} wh_pace_t;

/* True for 0 and for WH_PACE_LEAST to WH_PACE_MOST. */
bool wh_pace_validate(int64_t baud);

/* How many of `waiting` bytes are through by `now_us`, which never goes back: the caller takes them off.
 * If the line is free, bytes begin at the first call that finds them waiting. So call it in each slice, with
 * 0 as well. */
size_t wh_pace_take(wh_pace_t *pace, size_t waiting, int64_t now_us);

#endif
