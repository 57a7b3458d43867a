#include "flow_held.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "../flow/held.h"
#include "flow_played.h"

static wh_flow_played_t *flow_of(const wh_mcs_t *mcs) {
    return mcs->lanes ? mcs->lanes->flow : NULL;
}

/* Bits of its axes; a robot that is times alone has none. */
static uint32_t axes_of(const wh_flow_played_t *played, size_t robot) {
    const wh_flow_robot_t *of = &played->tool->robots[robot];
    return of->is_real ? wh_mcs_robot_axes(&played->mcs->layout->machine, (size_t)of->number) : 0;
}

static bool is_held(const wh_flow_played_t *played, size_t robot) {
    return played->engine->state.robots[robot].asked.is_wanted;
}

static void hold(const wh_flow_played_t *played, size_t robot, bool holds) {
    uint32_t *const held = &played->mcs->lanes->held_axes;
    const uint32_t axes = axes_of(played, robot);
    *held = holds ? *held | axes : *held & ~axes;
    wh_flow_tell_hold(&played->engine->state, (int32_t)robot, holds);
}

/* The page shows it at once; the flow's next instant is now. */
static void tell(wh_flow_played_t *played) {
    wh_mcs_t *mcs = played->mcs;
    char names[WH_MCS_HOLD_BYTES];
    wh_mcs_name_held(mcs, names);
    played->is_due = true;
    wh_mcs_call(mcs);
    if (mcs->wanted.listener.tell) {
        mcs->wanted.listener.tell(mcs->wanted.listener.user, mcs, names[0] ? WH_MCS_HELD : WH_MCS_NOT_HELD,
                                  NULL);
    }
}

/* -------------------------------------------------------------------------------------------- requests */

static size_t add_name(char text[WH_MCS_HOLD_BYTES], size_t length, const char *name) {
    const int more =
        snprintf(text + length, WH_MCS_HOLD_BYTES - length, "%s%s", length > 0 ? ", " : "", name);
    const size_t wanted = length + (more > 0 ? (size_t)more : 0);
    return wanted < WH_MCS_HOLD_BYTES ? wanted : WH_MCS_HOLD_BYTES - 1;
}

static wh_status_t refuse_name(const wh_flow_played_t *played, const char *name,
                               char reason[WH_MCS_HOLD_BYTES]) {
    char names[WH_MCS_HOLD_BYTES] = "";
    size_t length = 0;
    for (size_t r = 0; r < played->tool->robot_count; ++r) {
        length = add_name(names, length, played->tool->robots[r].name);
    }
    (void)snprintf(reason, WH_MCS_HOLD_BYTES, "%.100s is no robot of the flow (expected %.200s)", name,
                   names);
    return WH_STATUS_NO_SUCH_ROBOT;
}

static wh_status_t refuse_state(const char *name, bool holds, char reason[WH_MCS_HOLD_BYTES]) {
    (void)snprintf(reason, WH_MCS_HOLD_BYTES, "%.100s %s", name ? name : "each robot",
                   holds  ? "is held already (expected CONTINUE)"
                   : name ? "is not held (expected HOLD before)"
                          : "goes on: none is held (expected HOLD before)");
    return WH_STATUS_NOT_IN_PHASE;
}

wh_status_t wh_mcs_hold_robot(wh_mcs_t *mcs, const char *name, bool holds, char reason[WH_MCS_HOLD_BYTES]) {
    wh_flow_played_t *played = flow_of(mcs);
    bool is_known = !name, has_changed = false;
    reason[0] = '\0';
    if (!played) {
        (void)snprintf(reason, WH_MCS_HOLD_BYTES, "no flow carries wafers now");
        return WH_STATUS_NOT_IN_PHASE;
    }
    for (size_t r = 0; r < played->tool->robot_count; ++r) {
        const bool is_meant = !name || strcasecmp(name, played->tool->robots[r].name) == 0;
        is_known = is_known || is_meant;
        if (is_meant && is_held(played, r) != holds) {
            hold(played, r, holds);
            has_changed = true;
        }
    }
    if (!is_known) {
        return refuse_name(played, name, reason);
    }
    if (!has_changed) {
        return refuse_state(name, holds, reason);
    }
    tell(played);
    return WH_OK;
}

bool wh_mcs_is_robot_held(const wh_mcs_t *mcs, const char *name) {
    const wh_flow_played_t *played = flow_of(mcs);
    const int32_t robot = played ? wh_flow_robot_named(played->tool, name) : WH_FLOW_NONE;
    return robot != WH_FLOW_NONE && is_held(played, (size_t)robot);
}

void wh_mcs_name_held(const wh_mcs_t *mcs, char text[WH_MCS_HOLD_BYTES]) {
    const wh_flow_played_t *played = flow_of(mcs);
    size_t length = 0;
    text[0] = '\0';
    for (size_t r = 0; played && r < played->tool->robot_count; ++r) {
        if (is_held(played, r)) {
            length = add_name(text, length, played->tool->robots[r].name);
        }
    }
}

/* -------------------------------------------------------------------------------------------- segments */

bool wh_mcs_is_held_back(const wh_mcs_t *mcs, const wh_lane_t *lane) {
    return (lane->axes & mcs->lanes->held_axes) != 0 && lane->is_busy && lane->track.segment_slice == 0;
}

void wh_mcs_note_held_back(const wh_mcs_t *mcs, const wh_lane_t *lane) {
    wh_flow_played_t *played = flow_of(mcs);
    if (!wh_mcs_is_held_back(mcs, lane)) {
        return;
    }
    for (size_t r = 0; played && r < played->tool->robot_count; ++r) {
        if ((axes_of(played, r) & lane->axes) != 0) {
            wh_flow_tell_standing(&played->engine->state, (int32_t)r);
            played->is_due = true;
        }
    }
}

void wh_mcs_release_stopped(wh_mcs_t *mcs, uint32_t axes) {
    wh_flow_played_t *played = flow_of(mcs);
    bool has_changed = false;
    for (size_t r = 0; played && r < played->tool->robot_count; ++r) {
        if (is_held(played, r) && (axes == WH_MCS_ALL || (axes_of(played, r) & axes) != 0)) {
            hold(played, r, false);
            has_changed = true;
        }
    }
    if (has_changed) {
        tell(played);
    }
}
