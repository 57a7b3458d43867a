/* Why nothing was taken: missed picks, and wafers that a chuck did not take over. */
#include <math.h>
#include <stdio.h>

#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "../sim/event_text.h"
#include "native.h"

/* ------------------------------------------------------------------------------------------------- valves */

void wh_mcs_hear_valves(void *user, const wh_command_t *command, const wh_state_t *state) {
    wh_mcs_valve_t *valves = user;
    for (size_t g = 0; state->status == WH_OK && g < state->gripper_count; ++g) {
        wh_mcs_valve_t *valve = &valves[g];
        if (command->grippers[g].valve == WH_VALVE_CLOSED) {
            valve->shut = 0;
        } else if (state->grippers[g].valve == WH_VALVE_CLOSED) {
            valve->from = valve->shut == 0 ? state->grippers[g].base_from_gripper.r : valve->from;
            ++valve->shut;
        }
    }
}

/* native.hindered(gripper): what keeps it from taking a wafer as it stands, whatever lies there: for how
 * many seconds its valve stood closed though it was told to open, 0: it opened at once; whether it stands
 * closed now; and the wafer for which it is ready, with the gripper that holds it, or nothing. */
static int find_hindrance(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const wh_gripper_t *state = &mcs->state.grippers[gripper];
    wh_mcs_valve_t *valve = &mcs->heard.valves[gripper];
    const bool has_valve = mcs->layout->grips[gripper].kind == WH_GRIP_VACUUM;
    valve->to = state->base_from_gripper;
    valve->late = valve->shut > 0;
    lua_pushnumber(L, has_valve ? (double)(valve->shut * mcs->layout->slice_us) / 1e6 : 0);
    lua_pushboolean(L, has_valve && valve->shut > 0 && state->valve == WH_VALVE_CLOSED);
    const wh_encounter_t *contest = &state->contest;
    if (contest->wafer == WH_NONE) {
        return 2;
    }
    lua_pushstring(L, mcs->layout->wafers[contest->wafer].name);
    lua_pushstring(L, mcs->layout->grippers[contest->holder].name);
    return 4;
}

/* -------------------------------------------------------------------------------------------- the reasons */

/* Pushes the reasons for the missed pick: all conditions that failed. */
static void push_reasons(lua_State *L, const wh_mcs_t *mcs, const wh_event_t *miss) {
    const wh_event_names_t names = {.first = 1, .tolerance = &mcs->layout->grasp.tolerance};
    char reason[WH_EVENT_TEXT_SIZE];
    luaL_Buffer text;
    luaL_buffinit(L, &text);
    for (size_t i = 0; wh_event_reason(miss, &names, i, reason, sizeof reason) > 0; ++i) {
        luaL_addstring(&text, i > 0 ? " and " : "");
        luaL_addstring(&text, reason);
    }
    if ((miss->measured.failed & WH_FAILED_PLANAR) != 0) { /* the last of the reasons: it tells the tilt */
        const double limit = wh_deg_from_rad(wh_acos(names.tolerance->planar));
        luaL_addlstring(&text, reason, (size_t)snprintf(reason, sizeof reason, " (limit %.3f deg)", limit));
    }
    luaL_pushresult(&text);
}

/* The running command's last event of this kind ; null: none. */
static const wh_event_t *last_event(const wh_mcs_t *mcs, wh_event_kind_t kind) {
    const wh_record_t *record = mcs->recorder.record;
    for (size_t i = record->event_count; i > 0; --i) {
        const wh_event_record_t *kept = &record->events[i - 1];
        if (kept->command != mcs->recorder.running) {
            break;
        }
        if (kept->event.kind == kind) {
            return &kept->event;
        }
    }
    return NULL;
}

/* How close it came, both distances in units of their tolerance, squared. */
static double closeness(const wh_mcs_t *mcs, const wh_event_t *miss) {
    const wh_tolerance_t *tolerance = &mcs->layout->grasp.tolerance;
    const double z = miss->measured.dr_proj_z / tolerance->projz;
    const double xy = miss->measured.dr_proj_xy_norm / tolerance->projxy;
    return z * z + xy * xy;
}

/* The running command's near miss of this gripper that came closest, of equal ones the last; null: none. */
static const wh_event_t *closest_miss(const wh_mcs_t *mcs, int32_t gripper) {
    const wh_record_t *record = mcs->recorder.record;
    const wh_event_t *closest = NULL;
    for (size_t i = record->event_count; i > 0; --i) {
        const wh_event_record_t *kept = &record->events[i - 1];
        if (kept->command != mcs->recorder.running) {
            break;
        }
        if (kept->event.kind == WH_EVENT_NEAR_MISS && kept->event.gripper == gripper &&
            (!closest || closeness(mcs, &kept->event) < closeness(mcs, closest))) {
            closest = &kept->event;
        }
    }
    return closest;
}

/* How far the wafer is above a gripper at this place, along the blade's own direction as it was asked. */
static double height_over(const wh_mcs_t *mcs, const wh_mcs_valve_t *valve, int32_t wafer,
                          const wh_vec3_t *place) {
    const wh_vec3_t up = wh_mat3_column(&valve->to.R, 2);
    const wh_vec3_t way = wh_vec3_subtract(&mcs->state.wafers[wafer].base_from_wafer.r, place);
    return wh_vec3_dot(&up, &way);
}

/* True if the blade went up through the wafer's height before its valve opened: then the valve alone is the
 * reason that it was not there in time. */
static bool was_passed(const wh_mcs_t *mcs, const wh_mcs_valve_t *valve, int32_t wafer) {
    return valve->late && height_over(mcs, valve, wafer, &valve->from) >= 0 &&
           height_over(mcs, valve, wafer, &valve->to.r) <= 0;
}

/* The wafer that the blade met with its valve closed, as it stood when it was asked: among free ones beside
 * it the one that it came nearest to in height. WH_NONE: none was near. */
static int32_t find_met(const wh_mcs_t *mcs, const wh_mcs_valve_t *valve, wh_event_t *miss) {
    const wh_grasp_config_t *config = &mcs->layout->grasp;
    double least = config->near_projz;
    miss->wafer = WH_NONE;
    for (size_t w = 0; valve->late && w < mcs->state.wafer_count; ++w) {
        const wh_wafer_t *wafer = &mcs->state.wafers[w];
        wh_proximity_t found;
        const double height = fabs(height_over(mcs, valve, (int32_t)w, &valve->to.r));
        const double away = was_passed(mcs, valve, (int32_t)w) ? 0 : height;
        if (wafer->holder == WH_NONE && away < least &&
            wh_layout_measure(mcs->layout, &wafer->base_from_wafer, &valve->to, &found) == WH_OK &&
            found.dr_proj_xy_norm < config->near_projxy) {
            least = away;
            miss->measured = found;
            miss->wafer = (int32_t)w;
        }
    }
    return miss->wafer;
}

/* native.closest(gripper): for a running command in which this gripper took nothing, the name of the wafer
 * that came closest, and why it was not taken. Nothing if no wafer came near and left again, or if only the
 * valve was too late for it. */
static int find_closest(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const wh_mcs_valve_t *valve = &mcs->heard.valves[gripper];
    const wh_event_t *closest = closest_miss(mcs, gripper);
    wh_event_t miss = {.kind = WH_EVENT_NEAR_MISS, .gripper = gripper};
    wh_decisions_measured(mcs->wanted.decisions, "why a wafer was missed");
    if (closest) {
        miss = *closest;
    } else if (find_met(mcs, valve, &miss) == WH_NONE) {
        return 0;
    }
    if (was_passed(mcs, valve, miss.wafer)) {
        miss.measured.failed &= ~(unsigned)WH_FAILED_PROJZ;
    }
    if (miss.measured.failed == 0) {
        return 0;
    }
    lua_pushstring(L, mcs->layout->wafers[miss.wafer].name);
    push_reasons(L, mcs, &miss);
    return 2;
}

/* native.let_go(chuck): the last wafer that the running command let go, if no gripper holds it: its name, dx,
 * dy and dz against the chuck, and why the chuck did not take it (no reason if all conditions hold); or
 * nothing. */
static int find_let_go(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t chuck = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const int32_t station = mcs->layout->grippers[chuck].station;
    const wh_event_t *released = last_event(mcs, WH_EVENT_RELEASED);
    wh_decisions_measured(mcs->wanted.decisions, "why a wafer was lost");
    if (station == WH_NONE || !released || mcs->state.wafers[released->wafer].holder != WH_NONE) {
        return 0;
    }
    const wh_pose_t *pose = &mcs->state.wafers[released->wafer].base_from_wafer;
    const wh_place_t place = wh_cell_measure(&mcs->real->cell, &mcs->real->places[station], 1, pose);
    wh_event_t miss = *released;
    miss.kind = WH_EVENT_NEAR_MISS;
    miss.gripper = chuck;
    (void)wh_layout_measure(mcs->layout, pose, &mcs->state.grippers[chuck].base_from_gripper, &miss.measured);
    lua_pushstring(L, mcs->layout->wafers[released->wafer].name);
    lua_pushnumber(L, place.dx);
    lua_pushnumber(L, place.dy);
    lua_pushnumber(L, place.dz);
    if (miss.measured.failed == 0) {
        return 4;
    }
    push_reasons(L, mcs, &miss);
    return 5;
}

const luaL_Reg wh_mcs_miss_functions[] = {
    {"hindered", find_hindrance}, {"closest", find_closest}, {"let_go", find_let_go}, {NULL, NULL}};
