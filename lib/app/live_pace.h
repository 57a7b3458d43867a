/* The pace of a live page: slices wait for the wall clock, and what came of it. No result depends on it. */
#ifndef WH_APP_LIVE_PACE_H
#define WH_APP_LIVE_PACE_H

#include <stdbool.h>
#include <stdint.h>

/* The wall clock when the simulated time was `run_us`. */
typedef struct {
    bool is_set;
    int64_t run_us, wall_us;
} wh_live_pace_t;

/* Another run begins. */
void wh_live_pace_begin(wh_live_pace_t *pace);

/* Waits until `run_us` is due at that rate (0: no waiting). Time that was lost is not made up for beyond
 * WH_LIVE_PACE_BEHIND_US: then it counts on from here. */
#define WH_LIVE_PACE_BEHIND_US 100000
void wh_live_pace_wait(wh_live_pace_t *pace, double rate, int64_t run_us);

/* Measures the pace over about a second. At the beginning zero, with a pace below 0: it is not known. */
typedef struct {
    double pace;
    int64_t wall_us, run_us; /* since when it is measured; wall_us 0: not yet */
    int64_t moved_us;        /* the wall clock when the simulated time last went on */
    int64_t last_run_us;
    bool is_told; /* that it has stopped */
} wh_live_meter_t;

void wh_live_meter_add(wh_live_meter_t *meter, int64_t wall_us, int64_t run_us);

/* True once when the simulated time has stood still for a while. */
bool wh_live_meter_has_stopped(wh_live_meter_t *meter);

#endif
