#include "live_hold.h"

#include <stdio.h>
#include <time.h>

/* Looks again this often, us, and so many times. */
#define LOOK_US 2000
#define LOOKS 500

/* Nobody asks; the stepping thread may take it; it has; it has answered. */
enum { FREE, ASKED, TAKEN, ANSWERED };

static int stage_of(const wh_live_hold_t *hold) {
    return __atomic_load_n(&hold->stage, __ATOMIC_ACQUIRE);
}

/* True if it stood there and goes on to the next one. */
static bool pass(wh_live_hold_t *hold, int from, int to) {
    return __atomic_compare_exchange_n(&hold->stage, &from, to, false, __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE);
}

wh_status_t wh_live_hold_ask(wh_live_hold_t *hold, const char *robot, bool is_held,
                             char reason[WH_MCS_HOLD_BYTES]) {
    const struct timespec a_while = {0, LOOK_US * 1000L};
    hold->is_held = is_held;
    (void)snprintf(hold->robot, sizeof hold->robot, "%s", robot);
    (void)pass(hold, FREE, ASKED);
    for (int i = 0; i < LOOKS && stage_of(hold) != ANSWERED; ++i) {
        (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &a_while, NULL);
    }
    if (pass(hold, ASKED, FREE)) {
        (void)snprintf(reason, WH_MCS_HOLD_BYTES, "no slice of a flow is played now");
        return WH_STATUS_NOT_IN_PHASE;
    }
    while (!pass(hold, ANSWERED, FREE)) {
        (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &a_while, NULL);
    }
    (void)snprintf(reason, WH_MCS_HOLD_BYTES, "%s", hold->reason);
    return hold->status;
}

void wh_live_hold_take(wh_live_hold_t *hold, wh_mcs_t *mcs) {
    if (stage_of(hold) == ASKED && pass(hold, ASKED, TAKEN)) {
        hold->status =
            wh_mcs_hold_robot(mcs, hold->robot[0] ? hold->robot : NULL, hold->is_held, hold->reason);
        __atomic_store_n(&hold->stage, ANSWERED, __ATOMIC_RELEASE);
    }
}
