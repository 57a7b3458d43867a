#include "waits.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* The robots' classes of waiting, whose names begin so. */
#define FIRST_WAIT WH_FLOW_ROBOT_WAITS_WAFER
#define LAST_WAIT WH_FLOW_ROBOT_WAITS_ROBOT
#define WAITS "waits_"

static int by_length(const void *a, const void *b) {
    const wh_flow_wait_t *one = a, *other = b;
    if ((one->cause == NULL) != (other->cause == NULL)) {
        return one->cause ? -1 : 1;
    }
    if (one->us > other->us || one->us < other->us) {
        return one->us > other->us ? -1 : 1;
    }
    if (one->cause) {
        return strcmp(one->cause, other->cause);
    }
    return one->robot != other->robot ? other->robot - one->robot : one->station - other->station;
}

static void add(wh_flow_wait_t *waits, size_t *count, const wh_flow_wait_t *wait) {
    if (wait->us > 0) {
        waits[(*count)++] = *wait;
    }
}

wh_flow_wait_t *wh_flow_waits(const wh_flow_figures_t *figures, size_t *count) {
    const size_t robots = figures->tool->robot_count, stations = figures->tool->station_count;
    wh_flow_wait_t *waits = wh_array_new(WH_FLOW_ROBOT_CLASSES + robots + stations, sizeof *waits);
    *count = 0;
    for (int i = FIRST_WAIT; i <= LAST_WAIT; ++i) {
        wh_flow_wait_t wait = {wh_flow_robot_class_names[i] + strlen(WAITS), WH_FLOW_NONE, WH_FLOW_NONE, 0};
        for (size_t r = 0; r < robots; ++r) {
            wait.us += figures->robots[r][i];
        }
        add(waits, count, &wait);
    }
    for (size_t of = 0; of < robots + stations; ++of) {
        const bool is_robot = of < robots;
        wh_flow_wait_t wait = {NULL, is_robot ? (int32_t)of : WH_FLOW_NONE,
                               is_robot ? WH_FLOW_NONE : (int32_t)(of - robots), 0};
        for (size_t s = 0; s < stations; ++s) {
            wait.us += is_robot ? figures->blocked_by_robot[s * robots + of]
                                : figures->blocked_by_station[s * stations + of - robots];
        }
        add(waits, count, &wait);
    }
    qsort(waits, *count, sizeof *waits, by_length);
    return waits;
}

static void take(wh_flow_busy_t *busiest, int32_t robot, int32_t station, double share) {
    if (share > busiest->share) {
        *busiest = (wh_flow_busy_t){robot, station, share};
    }
}

wh_flow_busy_t wh_flow_busiest(const wh_flow_figures_t *figures) {
    const wh_flow_tool_t *tool = figures->tool;
    const double end_us = (double)figures->end_us;
    wh_flow_busy_t busiest = {WH_FLOW_NONE, WH_FLOW_NONE, 0};
    for (int32_t r = 0; r < (int32_t)tool->robot_count && end_us > 0; ++r) {
        double idle_us = figures->robots[r][WH_FLOW_ROBOT_IDLE];
        for (int i = FIRST_WAIT; i <= LAST_WAIT; ++i) {
            idle_us += figures->robots[r][i];
        }
        take(&busiest, r, WH_FLOW_NONE, 1 - idle_us / end_us);
    }
    for (int32_t s = 0; s < (int32_t)tool->station_count && end_us > 0; ++s) {
        const double *us = figures->stations[s];
        const double busy_us = us[WH_FLOW_STATION_PROCESS] + us[WH_FLOW_STATION_HANDLED] +
                               us[WH_FLOW_STATION_CLEAN] + us[WH_FLOW_STATION_PUMP];
        take(&busiest, WH_FLOW_NONE, s, busy_us / end_us / tool->stations[s].slots);
    }
    return busiest;
}
