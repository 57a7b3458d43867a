/* The clock, only for waits and progress: no result depends on it. */
#ifndef WH_TEXT_CLOCK_H
#define WH_TEXT_CLOCK_H

#include <stdint.h>
#include <time.h>

/* us of CLOCK_REALTIME, or of CLOCK_MONOTONIC, which never goes back. */
static inline int64_t wh_clock_us(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

/* Seconds since some moment in the past; it never goes back. */
static inline double wh_clock_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
