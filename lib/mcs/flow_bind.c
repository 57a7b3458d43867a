/* The wafers of a flow in a cell with axes are those that lie there. */
#include <lauxlib.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/ports.h"
#include "../text/array.h"
#include "flow_played.h"

int32_t *wh_flow_find_lying(const wh_flow_played_t *played) {
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

static void name_wafer(const wh_flow_played_t *played, wh_flow_wafer_t *wafer, int32_t found) {
    const wh_layout_wafer_t *of = &played->mcs->layout->wafers[found];
    const int32_t number = (int32_t)(wafer - played->flow->plan.wafers);
    played->numbers[found] = number;
    if (played->aboard) {
        played->aboard[number] = (wh_flow_aboard_t){found, wh_pose_identity()};
    }
    free(wafer->name);
    wafer->name = wh_text_copy(of->name);
    wafer->recipe = wafer->recipe > 0 ? wafer->recipe : of->recipe;
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
    name_wafer(played, wafer, found);
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

/* True if a wafer of some lot, but for this one or WH_FLOW_NONE, may come into the place. */
static bool is_wanted(const wh_flow_played_t *played, int32_t place, int32_t but) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    bool is_wanted = is_gone_to(plan, played->tool->place_stations[place]);
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        is_wanted = is_wanted || (w != but && plan->wafers[w].back == place);
    }
    return is_wanted;
}

/* A wafer that no lot has, or none yet, would be in the way. Its own way back does not count: it has left by
 * then. */
static bool check_free(lua_State *L, const wh_flow_played_t *played, const int32_t lying[], size_t place) {
    const int32_t found = lying[place];
    if (found == WH_FLOW_NONE || is_known(played, found) ||
        !is_wanted(played, (int32_t)place, played->numbers[found])) {
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

/* The calls whose carriers stand open at their ports when the flow begins. */
static void find_calls(const wh_flow_played_t *played) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    for (size_t i = 0; i < plan->call_count; ++i) {
        const int32_t carrier = wh_flow_carrier_at(played, plan->calls[i].station);
        plan->calls[i].is_there = carrier != WH_NONE && wh_flow_is_first_call(plan, &plan->calls[i]) &&
                                  (plan->calls[i].carrier == 0 || plan->calls[i].carrier == carrier + 1);
        played->carriers[i] = plan->calls[i].is_there ? carrier : WH_NONE;
    }
}

/* True if the wafer lies in its first place when the flow begins. */
static bool is_there(const wh_flow_plan_t *plan, int32_t wafer) {
    const int32_t call = plan->lots[plan->wafers[wafer].lot].call;
    return call == 0 || plan->calls[call - 1].is_there;
}

/* True for a load port whose carrier is not open yet: it is looked at when it is. */
static bool is_to_come(const wh_flow_played_t *played, int32_t station) {
    return played->tool->stations[station].is_real_port && wh_flow_carrier_at(played, station) == WH_NONE;
}

/* True if the layout's wafer goes along a route of the flow now. */
static bool is_under_way(const wh_flow_played_t *played, int32_t found) {
    const int32_t wafer = played->numbers[found];
    return wafer != WH_FLOW_NONE && !played->engine->state.wafers[wafer].is_over;
}

bool wh_flow_bind_late(lua_State *L, const wh_flow_played_t *played, const int32_t lying[],
                       const wh_flow_wafer_t *wafer) {
    const int32_t found = lying[wafer->home];
    if (found != WH_FLOW_NONE && is_under_way(played, found)) {
        lua_pushfstring(L, "%s in %s is in two lots (expected one)", played->mcs->layout->wafers[found].name,
                        push_place(L, played->tool, wafer->home));
        lua_remove(L, -2);
        return false;
    }
    if (found != WH_FLOW_NONE) {
        name_wafer(played, &played->flow->plan.wafers[wafer - played->flow->plan.wafers], found);
    }
    return true;
}

bool wh_flow_check_stranger(lua_State *L, const wh_flow_played_t *played, const int32_t lying[],
                            int32_t place) {
    const int32_t found = lying[place];
    if (found == WH_FLOW_NONE || is_under_way(played, found) || !is_wanted(played, place, WH_FLOW_NONE)) {
        return true;
    }
    lua_pushfstring(L, "%s lies in %s, where wafers of lots go (expected no wafer)",
                    played->mcs->layout->wafers[found].name, push_place(L, played->tool, place));
    lua_remove(L, -2);
    return false;
}

/* How many wafers end in the station, whatever their slots. */
static size_t count_ends(const wh_flow_plan_t *plan, int32_t station) {
    size_t count = 0;
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        const wh_flow_step_t *last = wh_flow_step_of(plan, w, wh_flow_last_step(plan, w));
        count +=
            plan->wafers[w].back == WH_FLOW_NONE && last->station_count == 1 && last->stations[0] == station;
    }
    return count;
}

/* A load port in which routes end has one carrier for all of them, if no lot comes there. */
static bool check_ends(lua_State *L, const wh_flow_played_t *played) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    for (int32_t s = 0; s < (int32_t)played->tool->station_count; ++s) {
        const wh_flow_station_t *station = &played->tool->stations[s];
        bool is_called = !station->is_real_port || plan->until_us != WH_FLOW_NEVER;
        for (size_t i = 0; i < plan->call_count; ++i) {
            is_called = is_called || plan->calls[i].station == s;
        }
        const size_t count = is_called ? 0 : count_ends(plan, s);
        if (count > (size_t)station->slots) {
            lua_pushfstring(L,
                            "%d wafers end in %s, whose carrier has %d slots and is not changed (expected at "
                            "most so many, several load ports, or `back`)",
                            (int)count, station->name, (int)station->slots);
            return false;
        }
    }
    return true;
}

/* True if a wafer whose carrier is still to come has this name: by the carrier and the slot, or, where
 * nobody has said which carrier that will be, by the lot. */
static bool is_called(const wh_flow_played_t *played, int32_t wafer, const char *name) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    const wh_flow_wafer_t *of = &plan->wafers[wafer];
    const int32_t carrier = plan->calls[plan->lots[of->lot].call - 1].carrier;
    char called[2 * WH_NAME_SIZE];
    if (carrier == 0) {
        return strcmp(of->name, name) == 0;
    }
    (void)snprintf(called, sizeof called, "%s.%d", played->mcs->layout->carriers[carrier - 1].name,
                   (int)wh_flow_slot(played->tool, of->home));
    return strcmp(called, name) == 0;
}

/* The lots' wafer of this name, or WH_FLOW_NONE. One that lies there goes before one that is to come. */
static int32_t find_named(const wh_flow_played_t *played, const char *name) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    int32_t late = WH_FLOW_NONE;
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        if (is_there(plan, w)) {
            if (strcmp(plan->wafers[w].name, name) == 0) {
                return w;
            }
        } else if (late == WH_FLOW_NONE && is_called(played, w, name)) {
            late = w;
        }
    }
    return late;
}

/* The wafers of lists' lines, by the names that they have now. Pushes what is wrong; true: nothing is. */
static bool find_asked(lua_State *L, const wh_flow_played_t *played) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    int32_t *found = wh_array_new(plan->asked.count + 1, sizeof *found);
    bool is_good = true;
    for (size_t i = 0; i < plan->asked.count; ++i) {
        found[i] = find_named(played, plan->asked.items[i]);
    }
    for (size_t r = 0; plan->lists && r < played->tool->robot_count && is_good; ++r) {
        for (size_t i = 0; i < plan->lists[r].count && is_good; ++i) {
            wh_flow_line_t *line = &plan->lists[r].lines[i];
            const int32_t number = WH_FLOW_ASKED(line->wafer);
            if (number >= 0 && number < (int32_t)plan->asked.count) {
                line->wafer = found[number];
                is_good = line->wafer != WH_FLOW_NONE;
            }
            if (!is_good) {
                lua_pushfstring(L, "rule.order.%s[%d][3]: \"%s\" (expected a wafer of the lots by name)",
                                played->tool->robots[r].name, (int)i + 1, plan->asked.items[number]);
            }
        }
    }
    free(found);
    return is_good;
}

static bool check_all_free(lua_State *L, const wh_flow_played_t *played, const int32_t lying[]) {
    bool is_good = true;
    for (size_t p = 0; p < played->tool->place_count && is_good; ++p) {
        is_good = is_to_come(played, played->tool->place_stations[p]) || check_free(L, played, lying, p);
    }
    return is_good;
}

void wh_flow_bind_wafers(lua_State *L, wh_flow_played_t *played) {
    int32_t *lying = wh_flow_find_lying(played);
    bool is_good = check_blades(L, played) && check_ends(L, played);
    find_calls(played);
    for (size_t i = 0; i < played->flow->plan.wafer_count && is_good; ++i) {
        if (is_there(&played->flow->plan, (int32_t)i)) {
            is_good = bind_wafer(L, played, lying, i);
            lua_remove(L, is_good ? -1 : -2);
        }
    }
    is_good = is_good && check_all_free(L, played, lying) && find_asked(L, played);
    free(lying);
    if (!is_good) {
        wh_mcs_raise(L, played->mcs, WH_STATUS_BAD_ARGUMENT,
                     lua_pushfstring(L, "flow: %s", lua_tostring(L, -1)));
    }
}
