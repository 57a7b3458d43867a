/* The clock, for waits and progress alone: no result depends on it. */
#ifndef WH_TEXT_CLOCK_H
#define WH_TEXT_CLOCK_H

#include <time.h>

/* Seconds since some moment in the past; never goes back. */
static inline double wh_clock_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
