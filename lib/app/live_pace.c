#include "live_pace.h"

#include "../text/clock.h"

/* us of the wall clock. */
#define MEASURED_US 1000000
#define STOPPED_US 400000

void wh_live_pace_begin(wh_live_pace_t *pace) {
    pace->is_set = false;
}

void wh_live_pace_wait(wh_live_pace_t *pace, double rate, int64_t run_us) {
    if (!(rate > 0)) {
        return;
    }
    const int64_t now = wh_clock_us(CLOCK_MONOTONIC);
    const int64_t due = pace->wall_us + (int64_t)((double)(run_us - pace->run_us) / rate);
    if (!pace->is_set || run_us < pace->run_us || now - due > WH_LIVE_PACE_BEHIND_US) {
        *pace = (wh_live_pace_t){true, run_us, now};
        return;
    }
    if (due > now) {
        const struct timespec until = {(time_t)(due / 1000000), (long)(due % 1000000) * 1000};
        (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
    }
}

void wh_live_meter_add(wh_live_meter_t *meter, int64_t wall_us, int64_t run_us) {
    if (run_us != meter->last_run_us) {
        meter->moved_us = wall_us;
        meter->is_told = false;
    }
    if (meter->wall_us == 0 || run_us < meter->last_run_us || wall_us - meter->moved_us > STOPPED_US) {
        meter->pace = meter->wall_us != 0 && wall_us - meter->moved_us > STOPPED_US ? 0 : meter->pace;
        meter->wall_us = wall_us;
        meter->run_us = run_us;
    } else if (wall_us - meter->wall_us >= MEASURED_US) {
        meter->pace = (double)(run_us - meter->run_us) / (double)(wall_us - meter->wall_us);
        meter->wall_us = wall_us;
        meter->run_us = run_us;
    }
    meter->last_run_us = run_us;
}

bool wh_live_meter_has_stopped(wh_live_meter_t *meter) {
    const bool has = meter->wall_us != 0 && !meter->is_told && !(meter->pace > 0) && !(meter->pace < 0);
    meter->is_told = meter->is_told || has;
    return has;
}
