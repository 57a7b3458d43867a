/* Carriers that come and go in a flow with axes: the functions by which lua/mcs/flow_ports.lua has load ports
 * do as the engine wants. */
#include <stdlib.h>
#include <string.h>

#include "../flow/calls.h"
#include "../script/wh_module_values.h"
#include "flow_played.h"
#include "ports.h"

static const wh_load_port_now_t *port_of(const wh_flow_played_t *played, int32_t station) {
    const int32_t number = wh_ports_find(played->mcs, station);
    return number == WH_NONE ? NULL : &played->mcs->clocks->ports->ports[number];
}

int32_t wh_flow_carrier_at(const wh_flow_played_t *played, int32_t station) {
    const wh_load_port_now_t *port = port_of(played, station);
    return port && wh_load_port_is_open(&port->clock) ? port->carrier : WH_NONE;
}

void wh_flow_look_at_ports(const wh_flow_played_t *played, wh_flow_state_t *state) {
    for (int32_t s = 0; s < (int32_t)played->tool->station_count; ++s) {
        const wh_load_port_now_t *port = port_of(played, s);
        if (port) {
            const bool is_idle = wh_ports_is_idle(played->mcs->clocks->ports, wh_ports_find(played->mcs, s));
            wh_flow_see_port(state, s, wh_load_port_is_open(&port->clock),
                             port->clock.is != WH_LOAD_PORT_ABSENT || !is_idle, !is_idle);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- wanted */

/* Once each wafer is at its end, carriers go that their lots have go. */
static const char *find_last(wh_flow_played_t *played, int32_t station) {
    wh_flow_state_t *state = &played->engine->state;
    const int32_t call = state->stations[station].call;
    const bool goes = played->engine->end == WH_FLOW_DONE && call > 0 &&
                      played->flow->plan.calls[call - 1].leaves &&
                      (state->calls.of[call - 1].phase == WH_FLOW_CALL_THERE ||
                       state->calls.of[call - 1].phase == WH_FLOW_CALL_GOING);
    return goes ? "goes" : NULL;
}

static const char *find_next(const wh_flow_played_t *played, int32_t station) {
    const wh_flow_state_t *state = &played->engine->state;
    const int32_t call = state->stations[station].call;
    const wh_flow_call_phase_t phase = call > 0 ? state->calls.of[call - 1].phase : WH_FLOW_CALL_AWAITED;
    if (call > 0 && state->calls.of[call - 1].is_told) {
        return NULL; /* the engine has not taken it up yet */
    } else if (call > 0 && phase == WH_FLOW_CALL_COMING) {
        return "comes";
    } else if (call > 0 && phase == WH_FLOW_CALL_GOING) {
        return "goes";
    }
    return !wh_load_port_is_open(&port_of(played, station)->clock) && wh_flow_is_port_needed(state, station)
               ? "shut"
               : NULL;
}

/* native.take_call(station): the doing of its load port that is next, once: "comes", and the name of the
 * carrier that is to, or nil; "goes"; "shut" if it should be open, and the carrier that should be there, or
 * nil. nil: nothing; false: the flow is over. */
static int take_call(lua_State *L) {
    wh_flow_played_t *played = wh_mcs_with_layout(L)->lanes->flow;
    const wh_layout_t *layout = played->mcs->layout;
    const int32_t station = wh_mcs_index(L, 1, played->tool->station_count);
    const int32_t call = played->engine->state.stations[station].call;
    if (played->is_taken[station]) {
        return 0;
    }
    const char *what = played->engine->is_over ? find_last(played, station) : find_next(played, station);
    if (!what) {
        lua_pushboolean(L, false);
        return played->engine->is_over ? 1 : 0;
    }
    played->is_taken[station] = true;
    lua_pushstring(L, what);
    const int32_t said = call > 0 ? played->flow->plan.calls[call - 1].carrier - 1 : WH_NONE;
    const int32_t carrier = strcmp(what, "shut") == 0 && call > 0 ? played->carriers[call - 1] : said;
    lua_pushstring(L, carrier == WH_NONE ? NULL : layout->carriers[carrier].name);
    return 2;
}

/* native.end_call(station): that was done. */
static int end_call(lua_State *L) {
    wh_flow_played_t *played = wh_mcs_with_layout(L)->lanes->flow;
    wh_flow_state_t *state = &played->engine->state;
    const int32_t station = wh_mcs_index(L, 1, played->tool->station_count);
    const int32_t call = state->stations[station].call;
    played->is_taken[station] = false;
    if (played->engine->is_over && call > 0) {
        state->calls.of[call - 1].phase = WH_FLOW_CALL_GONE;
    } else if (call > 0 && state->calls.of[call - 1].phase != WH_FLOW_CALL_THERE) {
        wh_flow_tell_call(state, station);
    }
    wh_flow_look_at_ports(played, state);
    played->is_due = true;
    return 0;
}

/* ------------------------------------------------------------------------------------------------- wafers */

static wh_flow_wafer_t *find_wafer(const wh_flow_played_t *played, int32_t station, int32_t slot) {
    const wh_flow_plan_t *plan = &played->flow->plan;
    const int32_t call = played->engine->state.stations[station].call;
    const int32_t home = played->tool->stations[station].first_place + slot - 1;
    for (size_t w = 0; w < plan->wafer_count; ++w) {
        if (plan->wafers[w].home == home && plan->lots[plan->wafers[w].lot].call == call) {
            return &plan->wafers[w];
        }
    }
    return NULL;
}

/* native.bind_call(station): the carrier that has come is open. Lots' wafers get the names of those that lie
 * in their slots. Returns a list of { slot = , is_there = , text = }: is_there: a wafer lies there; text: why
 * this cannot be, or nil. */
static int bind_call(lua_State *L) {
    wh_flow_played_t *played = wh_mcs_with_layout(L)->lanes->flow;
    const int32_t station = wh_mcs_index(L, 1, played->tool->station_count);
    const wh_flow_station_t *of = &played->tool->stations[station];
    const int32_t call = played->engine->state.stations[station].call;
    int32_t *lying = wh_flow_find_lying(played);
    played->carriers[call - 1] = wh_flow_carrier_at(played, station);
    lua_newtable(L);
    for (int32_t slot = 1; slot <= of->slots; ++slot) {
        const int32_t place = of->first_place + slot - 1;
        const wh_flow_wafer_t *wafer = find_wafer(played, station, slot);
        lua_createtable(L, 0, 3);
        wh_lua_set_integer(L, "slot", slot);
        wh_lua_set_boolean(L, "is_there", lying[place] != WH_FLOW_NONE);
        const bool is_bad = wafer ? !wh_flow_bind_late(L, played, lying, wafer)
                                  : !wh_flow_check_stranger(L, played, lying, place);
        if (is_bad) {
            lua_setfield(L, -2, "text");
        }
        if (wafer || is_bad) {
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        } else {
            lua_pop(L, 1);
        }
    }
    free(lying);
    return 1;
}

/* native.skip_wafer(station, slot): the lot's wafer there is left where it lies. */
static int skip_wafer(lua_State *L) {
    const wh_flow_played_t *played = wh_mcs_with_layout(L)->lanes->flow;
    const int32_t station = wh_mcs_index(L, 1, played->tool->station_count);
    const int32_t slot = wh_mcs_index(L, 2, (size_t)played->tool->stations[station].slots);
    wh_flow_wafer_t *wafer = find_wafer(played, station, slot + 1);
    if (wafer) {
        wafer->is_skipped = true;
    }
    return 0;
}

const luaL_Reg wh_mcs_flow_call_functions[] = {{"take_call", take_call},
                                               {"end_call", end_call},
                                               {"bind_call", bind_call},
                                               {"skip_wafer", skip_wafer},
                                               {NULL, NULL}};
