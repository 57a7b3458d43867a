/* The wafers of a flow in a cell with axes are those that lie there. */
#include <lauxlib.h>
#include <stdlib.h>

#include "../text/array.h"
#include "flow_played.h"

/* By place of the tool the layout's wafer that lies there, or WH_FLOW_NONE. The caller frees it. */
static int32_t *find_lying(const wh_flow_played_t *played) {
    const wh_mcs_t *mcs = played->mcs;
    int32_t *lying = wh_array_new(played->tool->place_count, sizeof *lying);
    for (size_t p = 0; p < played->tool->place_count; ++p) {
        lying[p] = WH_FLOW_NONE;
    }
    for (size_t w = 0; w < mcs->state.wafer_count; ++w) {
        wh_place_t at;
        const wh_wafer_t *wafer = &mcs->state.wafers[w];
        if (wafer->holder == WH_NONE && wh_cell_locate(&mcs->layout->cell, &wafer->base_from_wafer, &at)) {
            lying[played->tool->stations[at.station].first_place + at.slot - 1] = (int32_t)w;
        }
    }
    return lying;
}

static const char *push_place(lua_State *L, const wh_flow_tool_t *tool, int32_t place) {
    return lua_pushfstring(L, "%s slot %d", tool->stations[tool->place_stations[place]].name,
                           (int)wh_flow_slot(tool, place));
}

/* Takes the wafer that lies in its first place. Pushes what is wrong; true: nothing is. */
static bool bind_wafer(lua_State *L, const wh_flow_played_t *played, const int32_t lying[], size_t number) {
    wh_flow_wafer_t *wafer = &played->flow->plan.wafers[number];
    const int32_t found = lying[wafer->home];
    const char *where = push_place(L, played->tool, wafer->home);
    if (found == WH_FLOW_NONE) {
        lua_pushfstring(L, "no wafer lies in %s (expected one: a lot has it)", where);
        return false;
    }
    const char *name = played->mcs->layout->wafers[found].name;
    if (played->numbers[found] != WH_FLOW_NONE) {
        lua_pushfstring(L, "%s in %s is in two lots (expected one)", name, where);
        return false;
    }
    played->numbers[found] = (int32_t)number;
    free(wafer->name);
    wafer->name = wh_text_copy(name);
    return true;
}

/* True if a wafer of some route may come to the station. */
static bool is_gone_to(const wh_flow_plan_t *plan, int32_t station) {
    bool is_any = false;
    for (size_t i = 0; i < plan->route_count; ++i) {
        for (size_t k = 1; k < plan->routes[i].step_count; ++k) {
            is_any = is_any || wh_flow_step_has(&plan->routes[i].steps[k], station);
        }
    }
    return is_any;
}

/* True if the engine knows of the layout's wafer when the flow begins. */
static bool is_known(const wh_flow_played_t *played, int32_t found) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    const int32_t wafer = played->numbers[found];
    return wafer != WH_FLOW_NONE && plan->lots[plan->wafers[wafer].lot].arrives_us == 0;
}

/* A wafer that no lot has, or none yet, would be in the way. */
static bool check_free(lua_State *L, const wh_flow_played_t *played, const int32_t lying[], size_t place) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    const int32_t found = lying[place];
    bool is_wanted = is_gone_to(plan, played->tool->place_stations[place]);
    for (size_t w = 0; w < plan->wafer_count; ++w) {
        is_wanted = is_wanted || plan->wafers[w].back == (int32_t)place;
    }
    if (found == WH_FLOW_NONE || !is_wanted || is_known(played, found)) {
        return true;
    }
    lua_pushfstring(
        L, "%s lies in %s, where wafers of lots go (expected no wafer, or one of a lot that is there)",
        played->mcs->layout->wafers[found].name, push_place(L, played->tool, (int32_t)place));
    return false;
}

/* Each robot must come with empty blades: nobody knows where else its wafer would go. */
static bool check_blades(lua_State *L, const wh_flow_played_t *played) {
    const wh_mcs_t *mcs = played->mcs;
    for (size_t g = 0; g < mcs->layout->machine.gripper_count; ++g) {
        const int32_t wafer = mcs->state.grippers[g].wafer;
        if (mcs->layout->grippers[g].station == WH_NONE && wafer != WH_NONE) {
            lua_pushfstring(L, "%s holds %s (expected empty blades when a flow begins)",
                            mcs->layout->grippers[g].name, mcs->layout->wafers[wafer].name);
            return false;
        }
    }
    return true;
}

void wh_flow_bind_wafers(lua_State *L, wh_flow_played_t *played) {
    int32_t *lying = find_lying(played);
    bool is_good = check_blades(L, played);
    for (size_t i = 0; i < played->flow->plan.wafer_count && is_good; ++i) {
        is_good = bind_wafer(L, played, lying, i);
        lua_remove(L, is_good ? -1 : -2);
    }
    for (size_t p = 0; p < played->tool->place_count && is_good; ++p) {
        is_good = check_free(L, played, lying, p);
    }
    free(lying);
    if (!is_good) {
        wh_mcs_raise(L, played->mcs, WH_STATUS_BAD_ARGUMENT,
                     lua_pushfstring(L, "flow: %s", lua_tostring(L, -1)));
    }
}
