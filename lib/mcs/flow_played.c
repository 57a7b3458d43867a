/* The functions by which lua/mcs/flow.lua plays a flow in a cell with axes. */
#include "flow_played.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../flow/failed.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "flow_held.h"
#include "flow_own.h"
#include "flow_plan.h"
#include "flow_tool.h"
#include "flow_word.h"

/* The longest wait for what nobody can foretell, us. */
#define LOOK_US INT64_C(30000000)

/* --------------------------------------------------------------------------------------------- setting up */

/* The figures of a flow that did not come to its end tell nothing. */
static void drop(wh_flow_played_t *played, bool has_result) {
    if (played->measure) {
        played->engine->is_over = played->engine->is_over && has_result;
        wh_flow_measure_close(played->measure);
        played->measure = NULL;
    }
    free(played->numbers);
    free(played->is_mapped);
    free(played->is_taken);
    free(played->heard);
    wh_flow_timed_close(played);
    free(played->carriers);
    free(played->patience);
    played->numbers = played->carriers = NULL;
    played->patience = NULL;
    played->is_mapped = played->is_taken = NULL;
    played->heard = NULL;
}

static int collect(lua_State *L) {
    drop(lua_touserdata(L, 1), false);
    return 0;
}

/* It lives as long as the Lua state, or until it is dropped. */
static wh_flow_played_t *new_played(lua_State *L, wh_mcs_t *mcs) {
    wh_flow_played_t *played = lua_newuserdatauv(L, sizeof *played, 0);
    memset(played, 0, sizeof *played);
    played->mcs = mcs;
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, collect);
    lua_setfield(L, -2, "__gc");
    lua_setmetatable(L, -2);
    lua_rawsetp(L, LUA_REGISTRYINDEX, played);
    return played;
}

static wh_flow_played_t *played_of(lua_State *L) {
    return wh_mcs_with_layout(L)->lanes->flow;
}

static void make_room(wh_flow_played_t *played) {
    const size_t wafers = played->mcs->layout->wafer_count;
    played->numbers = wh_array_new(wafers, sizeof *played->numbers);
    for (size_t w = 0; w < wafers; ++w) {
        played->numbers[w] = WH_FLOW_NONE;
    }
    played->is_mapped = wh_array_new(played->flow->plan.lot_count, sizeof *played->is_mapped);
    played->carriers = wh_array_new(played->flow->plan.call_count + 1, sizeof *played->carriers);
    played->is_taken = wh_array_new(played->tool->station_count, sizeof *played->is_taken);
    played->patience = wh_array_new(played->tool->station_count, sizeof *played->patience);
    played->stall.station = WH_FLOW_NONE;
}

/* Doors that are not shut are shut first: each of the flow's stations begins with shut ones. */
static void shut_doors(wh_flow_played_t *played) {
    const wh_flow_tool_t *tool = played->tool;
    for (size_t s = 0; s < tool->station_count; ++s) {
        for (size_t r = 0; r < tool->robot_count; ++r) {
            const size_t of = wh_flow_of(tool, (int32_t)r, (int32_t)s);
            const wh_flow_door_t *door = &tool->doors[of];
            if (door->is_real && tool->serves[of] &&
                strcmp(wh_mcs_door_word(played->mcs, (size_t)door->number), "shut") != 0) {
                played->engine->state.stations[s].real.is_shutting = true;
            }
        }
    }
}

static void push_names(lua_State *L, const wh_flow_played_t *played) {
    const wh_flow_tool_t *tool = played->tool;
    lua_createtable(L, (int)tool->robot_count, 0);
    for (size_t r = 0; r < tool->robot_count; ++r) {
        lua_pushstring(L, tool->robots[r].name);
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_createtable(L, (int)tool->station_count, 0);
    for (size_t s = 0; s < tool->station_count; ++s) {
        lua_pushstring(L, tool->stations[s].name);
        lua_rawseti(L, -2, (lua_Integer)s + 1);
    }
}

/* native.begin_flow(description): a flow begins at the current slice, once there are tasks. Returns the names
 * of the robots and of the stations, and its line. */
static int begin_flow(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    if (mcs->wanted.until_steady) {
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT,
                     "flow: --until-steady ends flows by times alone (expected robots that are times alone)");
    }
    wh_flow_played_t *played = new_played(L, mcs);
    played->tool = wh_flow_tool_of_layout(L, mcs->layout);
    played->flow = wh_flow_read_word(L, mcs, played->tool);
    played->flow->is_played = true;
    played->flow->began_us = mcs->track.slice * mcs->track.slice_us;
    make_room(played);
    wh_flow_bind_wafers(L, played);
    wh_flow_timed_open(played);
    played->outside = (wh_flow_outside_t){
        played,       wh_flow_hear,       wh_flow_look, wh_flow_pump_lock, wh_flow_hold_station,
        played->tool, mcs->track.slice_us};
    if (played->flow->is_lateness_told && mcs->clocks) {
        mcs->clocks->state->tells_late = true;
    }
    played->measure = wh_flow_measure_open(played->tool, &played->flow->plan, mcs->wanted.keeps,
                                           &played->outside, &played->flow->figures);
    played->engine = wh_flow_measure_engine(played->measure);
    shut_doors(played);
    wh_flow_own_open(L, played->tool, &played->flow->plan);
    mcs->lanes->flow = played;
    push_names(L, played);
    lua_pushinteger(L, played->flow->line);
    return 3;
}

/* ----------------------------------------------------------------------------------------------- stepping */

/* native.step_flow(): plays the flow's present instant. Returns s until the next one that can be foretold, at
 * most LOOK_US; nil: the flow is over. */
static int step_flow(lua_State *L) {
    wh_flow_played_t *played = played_of(L);
    wh_flow_engine_t *engine = played->engine;
    const int64_t now_us = wh_flow_played_now(played);
    if (engine->is_over) {
        return 0;
    }
    wh_flow_own_use(L, &played->flow->plan);
    played->is_due = false;
    wh_flow_timed_wait(played);
    const int64_t next_us = wh_flow_engine_step(engine, now_us);
    wh_flow_timed_begin(played);
    if (engine->is_over && engine->end == WH_FLOW_STUCK && wh_flow_find_unbegun(played, &engine->state)) {
        engine->is_over = false;
    }
    if (engine->is_over) {
        return 0;
    }
    const int64_t slice_us = played->outside.slice_us;
    const int64_t us = next_us - now_us < LOOK_US ? next_us - now_us : LOOK_US;
    const int64_t slices = (us + slice_us - 1) / slice_us;
    lua_pushnumber(L, (double)(slices * slice_us) / 1e6);
    return 1;
}

/* native.take_stall(): something in a station takes too long, or does not begin: its number and name,
 * "process", "clean" or "pump", and a text; once. Nothing: all goes on. */
static int take_stall(lua_State *L) {
    wh_flow_played_t *played = played_of(L);
    const int32_t station = played->stall.station;
    played->stall.station = WH_FLOW_NONE;
    if (station == WH_FLOW_NONE || played->engine->is_over) {
        return 0;
    }
    lua_pushinteger(L, station + 1);
    lua_pushstring(L, played->tool->stations[station].name);
    lua_pushstring(L, played->stall.action);
    lua_pushstring(L, played->stall.text);
    return 4;
}

/* native.wait_on(station): it is waited for as long again. False if that was so too often. */
static int wait_on(lua_State *L) {
    wh_flow_played_t *played = played_of(L);
    lua_pushboolean(L, wh_flow_wait_on(played, wh_mcs_index(L, 1, played->tool->station_count)));
    return 1;
}

/* native.is_flow_due(): whether something was told since the last step, or the flow is over; and whether it
 * is over. */
static int is_flow_due(lua_State *L) {
    const wh_flow_played_t *played = played_of(L);
    lua_pushboolean(L, played->is_due || played->engine->is_over);
    lua_pushboolean(L, played->engine->is_over);
    return 2;
}

/* native.fail_flow(text): the flow ends with this cause. */
static int fail_flow(lua_State *L) {
    wh_flow_played_t *played = played_of(L);
    wh_flow_state_t *state = &played->engine->state;
    state->cause = state->cause ? state->cause : wh_text_copy(wh_lua_whole_text(L, 1));
    played->is_due = true;
    return 0;
}

/* ------------------------------------------------------------------------------------------------- robots */

static void set_place(lua_State *L, const wh_flow_played_t *played, int32_t place) {
    wh_lua_set_integer(L, "slot", wh_flow_slot(played->tool, place));
}

static void set_gripper(lua_State *L, const wh_flow_played_t *played, int32_t robot, int32_t arm) {
    const int32_t gripper = wh_flow_gripper_of(played->mcs->layout, played->tool->robots[robot].number, arm);
    wh_lua_set_text(L, "gripper", played->mcs->layout->grippers[gripper].name);
}

/* The wafer goes to a full place: the robot's other arm is empty, and takes first. */
static bool is_to_exchange(const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t place = at->order.place;
    const bool is_full = place != WH_FLOW_NONE && state->places[place].wafer != WH_FLOW_NONE &&
                         state->places[place].leaving_us == WH_FLOW_NEVER;
    return is_full && state->tool->robots[robot].arms > 1 &&
           (at->arms[0] == WH_FLOW_NONE || at->arms[1] == WH_FLOW_NONE);
}

/* The arm for the order's wafer, which is aboard, or for one that is still to come. */
static int32_t find_arm(const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const bool is_first = at->arms[0] == at->order.wafer;
    if (at->order.what == WH_FLOW_BRING && !is_to_exchange(state, robot)) {
        return is_first ? 0 : 1;
    }
    if (at->order.what == WH_FLOW_BRING || at->order.what == WH_FLOW_SWAP) {
        return is_first ? 1 : 0; /* the empty one takes first */
    }
    return at->arms[0] != WH_FLOW_NONE && state->tool->robots[robot].arms > 1 ? 1 : 0;
}

/* In front of which slot it goes, and with which gripper: that of the wafer which it brings, else the one
 * that takes. */
static void set_way(lua_State *L, const wh_flow_played_t *played, int32_t robot) {
    const wh_flow_state_t *state = &played->engine->state;
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const wh_flow_order_t *order = &at->order;
    int32_t place = at->to, arm = at->arm;
    if (place == WH_FLOW_NONE) {
        const bool takes = order->wafer != WH_FLOW_NONE && state->wafers[order->wafer].place != WH_FLOW_NONE;
        place = takes ? state->wafers[order->wafer].place : order->place;
        arm = takes ? wh_flow_free_arm(state, robot, order->wafer) : find_arm(state, robot);
        arm = arm == WH_FLOW_NONE ? 0 : arm;
    }
    if (place == WH_FLOW_NONE || state->tool->place_stations[place] != at->station) {
        place = state->tool->stations[at->station].first_place;
    }
    set_place(L, played, place);
    set_gripper(L, played, robot, arm);
}

static void set_step(lua_State *L, const wh_flow_played_t *played, int32_t wafer) {
    const int32_t next = wh_flow_next_step(&played->engine->state, wafer);
    const wh_flow_step_t *step = wh_flow_step_of(&played->flow->plan, wafer, next == WH_FLOW_NONE ? 0 : next);
    wh_lua_set_boolean(L, "centre", step->centres);
    wh_lua_set_boolean(L, "map", step->maps);
}

/* The first wafer of a lot is taken after a MAP, if the lot wants one. */
static void set_map(lua_State *L, const wh_flow_played_t *played, int32_t wafer) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    const int32_t lot = plan->wafers[wafer].lot;
    const bool maps =
        plan->lots[lot].is_mapped && !played->is_mapped[lot] && played->engine->state.wafers[wafer].step == 0;
    played->is_mapped[lot] = played->is_mapped[lot] || maps;
    wh_lua_set_boolean(L, "map", maps);
}

static void push_action(lua_State *L, const wh_flow_played_t *played, int32_t robot) {
    static const char *const words[] = {
        [WH_FLOW_MOVING] = "move",   [WH_FLOW_OPENING] = "open",  [WH_FLOW_PICKING] = "pick",
        [WH_FLOW_CARRYING] = "move", [WH_FLOW_PLACING] = "place", [WH_FLOW_SWAPS] = "swap"};
    const wh_flow_robot_state_t *at = &played->engine->state.robots[robot];
    lua_createtable(L, 0, 6);
    wh_lua_set_text(L, "what", words[at->action]);
    wh_lua_set_text(L, "station", played->tool->stations[at->station].name);
    if (at->action == WH_FLOW_OPENING) {
        const wh_flow_door_t *door = &played->tool->doors[wh_flow_of(played->tool, robot, at->station)];
        wh_lua_set_text(L, "door", played->mcs->layout->door_list[door->number].name);
    } else if (at->action == WH_FLOW_MOVING || at->action == WH_FLOW_CARRYING) {
        set_way(L, played, robot);
    } else {
        const bool is_pick = at->action == WH_FLOW_PICKING;
        set_place(L, played, is_pick ? at->from : at->to);
        set_gripper(L, played, robot, at->arm);
        if (is_pick) {
            set_map(L, played, at->order.wafer);
        } else {
            set_step(L, played, at->order.wafer);
            wh_flow_set_process(played, at->order.wafer, at->to);
        }
    }
}

/* native.take_action(robot): the action that the flow has begun for it, once: { what = "move", "open",
 * "pick", "place" or "swap", station, slot, gripper, door, centre, map }; nil: none; false: the flow is
 * over. A robot that is times alone has "open" alone. */
static int take_action(lua_State *L) {
    const wh_flow_played_t *played = played_of(L);
    const int32_t robot = wh_mcs_index(L, 1, played->tool->robot_count);
    wh_flow_robot_state_t *at = &played->engine->state.robots[robot];
    const bool has_action = at->is_begun && at->action != WH_FLOW_IDLE && at->action != WH_FLOW_WAITING;
    if (played->engine->is_over) {
        lua_pushboolean(L, false);
        return 1;
    }
    if (!has_action) {
        return 0;
    }
    at->is_begun = false;
    push_action(L, played, robot);
    return 1;
}

/* native.end_action(robot): its action has ended. */
static int end_action(lua_State *L) {
    wh_flow_played_t *played = played_of(L);
    wh_flow_tell_end(&played->engine->state, wh_mcs_index(L, 1, played->tool->robot_count));
    played->is_due = true;
    return 0;
}

static int64_t now_of(const void *played) {
    return wh_flow_played_now(played);
}

/* native.begin_on_error(): the function on_error and the tool, which it can read until native.end_on_error();
 * nothing: there is none. */
static int begin_on_error(lua_State *L) {
    const wh_flow_played_t *played = played_of(L);
    return wh_flow_own_push_on_error(L, &played->flow->plan, &played->engine->state, now_of, played) ? 2 : 0;
}

/* native.end_on_error(): it has answered. */
static int end_on_error(lua_State *L) {
    wh_flow_own_end_on_error(&played_of(L)->flow->plan);
    return 0;
}

/* ----------------------------------------------------------------------------------------------- stations */

/* Robots may share one. */
static void push_doors(lua_State *L, const wh_flow_played_t *played, int32_t station) {
    const wh_layout_t *layout = played->mcs->layout;
    uint32_t doors = 0;
    for (int32_t r = 0; r < (int32_t)played->tool->robot_count; ++r) {
        const wh_flow_door_t *door = &played->tool->doors[wh_flow_of(played->tool, r, station)];
        doors |= door->is_real ? UINT32_C(1) << door->number : 0;
    }
    lua_newtable(L);
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        if ((doors >> d & 1U) != 0 && strcmp(wh_mcs_door_word(played->mcs, d), "shut") != 0) {
            lua_pushstring(L, layout->door_list[d].name);
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        }
    }
}

/* native.take_shutting(station): the names of its doors that are to be shut, once; nil: none; false: the flow
 * is over. */
static int take_shutting(lua_State *L) {
    const wh_flow_played_t *played = played_of(L);
    const int32_t station = wh_mcs_index(L, 1, played->tool->station_count);
    const wh_flow_station_state_t *at = &played->engine->state.stations[station];
    if (at->real.is_shutting && !at->real.has_shut && !played->is_taken[station]) {
        played->is_taken[station] = true;
        push_doors(L, played, station);
        return 1;
    }
    lua_pushboolean(L, false);
    return played->engine->is_over ? 1 : 0;
}

/* native.end_shutting(station): they are shut. */
static int end_shutting(lua_State *L) {
    wh_flow_played_t *played = played_of(L);
    const int32_t station = wh_mcs_index(L, 1, played->tool->station_count);
    played->is_taken[station] = false;
    wh_flow_tell_shut(&played->engine->state, station);
    played->is_due = true;
    return 0;
}

/* native.take_work(station): what is to be done with the wafer in it, once: "align" and the degrees, or
 * "flip"; nil: nothing; false: the flow is over. */
static int take_work(lua_State *L) {
    const wh_flow_played_t *played = played_of(L);
    const int32_t station = wh_mcs_index(L, 1, played->tool->station_count);
    const wh_flow_station_state_t *at = &played->engine->state.stations[station];
    const int32_t wafer = at->real.work_wafer;
    if (wafer == WH_FLOW_NONE || at->real.has_worked || played->is_taken[station]) {
        lua_pushboolean(L, false);
        return played->engine->is_over ? 1 : 0;
    }
    const wh_flow_step_t *step =
        wh_flow_step_of(&played->flow->plan, wafer, played->engine->state.wafers[wafer].step);
    played->is_taken[station] = true;
    lua_pushstring(L, step->work == WH_FLOW_WORK_ALIGN ? "align" : "flip");
    lua_pushnumber(L, step->align_deg);
    return 2;
}

/* native.end_work(station): that has ended. */
static int end_work(lua_State *L) {
    wh_flow_played_t *played = played_of(L);
    const int32_t station = wh_mcs_index(L, 1, played->tool->station_count);
    played->is_taken[station] = false;
    wh_flow_tell_worked(&played->engine->state, station);
    played->is_due = true;
    return 0;
}

/* ------------------------------------------------------------------------------------------------- ending */

/* native.end_flow(problem): all robots stand. Returns the figures, or raises the error of a function of
 * the flow. With a problem, an error's text, they are dropped, nothing is returned, and the run fails,
 * whoever catches that error. */
static int end_flow(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_flow_played_t *played = mcs->lanes->flow;
    const bool is_good = lua_isnoneornil(L, 1) && played->engine->is_over;
    wh_mcs_release_stopped(mcs, WH_MCS_ALL);
    mcs->lanes->flow = NULL;
    for (size_t s = 0; s < played->tool->station_count; ++s) {
        wh_mcs_set_down(mcs, (int32_t)s, false);
    }
    wh_flow_forget_processes(played);
    const bool has_failed = wh_flow_own_close(L, &played->flow->plan);
    drop(played, is_good);
    if (!is_good) {
        wh_flow_figures_close(&played->flow->figures);
        wh_flow_fail_word(mcs, luaL_optstring(L, 1, "the flow did not come to its end"));
        return 0;
    }
    return wh_flow_return_word(L, mcs, has_failed);
}

const luaL_Reg wh_mcs_flow_played_functions[] = {{"begin_flow", begin_flow},
                                                 {"step_flow", step_flow},
                                                 {"take_stall", take_stall},
                                                 {"wait_on", wait_on},
                                                 {"is_flow_due", is_flow_due},
                                                 {"fail_flow", fail_flow},
                                                 {"take_action", take_action},
                                                 {"end_action", end_action},
                                                 {"begin_on_error", begin_on_error},
                                                 {"end_on_error", end_on_error},
                                                 {"take_shutting", take_shutting},
                                                 {"end_shutting", end_shutting},
                                                 {"take_work", take_work},
                                                 {"end_work", end_work},
                                                 {"end_flow", end_flow},
                                                 {NULL, NULL}};
