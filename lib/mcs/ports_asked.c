/* The functions by which lua/mcs asks load ports, and tells them. */
#include <math.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "clocks.h"
#include "ports.h"

/* How far a wafer that a carrier brings askew lies beyond the limit at which it is told, mm. */
#define BEYOND 5

bool wh_mcs_does_port_stand(const wh_mcs_t *mcs, int32_t station) {
    const int32_t number = wh_ports_find(mcs, station);
    if (number == WH_NONE) {
        return true;
    }
    const wh_load_port_t clock = wh_ports_coming(mcs->clocks->ports, number, mcs->clocks->state->utime);
    return clock.step == WH_LOAD_PORT_STANDS;
}

bool wh_mcs_see_load_port(const wh_mcs_t *mcs, size_t station, wh_mcs_load_port_t *seen) {
    const int32_t number = wh_ports_find(mcs, (int32_t)station);
    if (number == WH_NONE) {
        return false;
    }
    const wh_load_port_now_t *port = &mcs->clocks->ports->ports[number];
    const wh_load_port_t *clock = &port->clock;
    *seen = (wh_mcs_load_port_t){.is = wh_load_port_state_name(clock->is)};
    if (clock->step != WH_LOAD_PORT_STANDS) {
        seen->does = wh_load_port_step_name(clock->step);
    }
    if (clock->failed != WH_LOAD_PORT_STANDS) {
        seen->failed = wh_load_port_step_name(clock->failed);
    }
    if (port->carrier != WH_NONE) {
        seen->carrier = mcs->layout->carriers[port->carrier].name;
    }
    return true;
}

static int32_t port_argument(lua_State *L, const wh_mcs_t *mcs, int argument) {
    return wh_ports_find(mcs, wh_mcs_index(L, argument, mcs->layout->station_count));
}

static struct wh_ports *need_port(lua_State *L, const wh_mcs_t *mcs, int argument, int32_t *number) {
    *number = port_argument(L, mcs, argument);
    luaL_argcheck(L, *number != WH_NONE, argument, "it is no load port");
    return mcs->clocks->ports;
}

static void push_name_or_nil(lua_State *L, const char *name, bool is_there) {
    if (is_there) {
        lua_pushstring(L, name);
    } else {
        lua_pushnil(L);
    }
}

/* native.port(station): nothing if it is no load port; else its state, the step that runs, or begins with the
 * next slice, or nil, s that it needs yet by the description, its carrier or nil, and the step that ended its
 * last handshake or nil. */
static int read_port(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = port_argument(L, mcs, 1);
    if (number == WH_NONE) {
        return 0;
    }
    const struct wh_ports *ports = mcs->clocks->ports;
    const wh_load_port_now_t *port = &ports->ports[number];
    const wh_load_port_t clock = wh_ports_coming(ports, number, mcs->clocks->state->utime);
    const bool has = port->carrier != WH_NONE;
    lua_pushstring(L, wh_load_port_state_name(clock.is));
    push_name_or_nil(L, wh_load_port_step_name(clock.step), clock.step != WH_LOAD_PORT_STANDS);
    lua_pushnumber(L, wh_load_port_left_us(&ports->of[number].of, &clock) / 1e6);
    push_name_or_nil(L, has ? mcs->layout->carriers[port->carrier].name : NULL, has);
    push_name_or_nil(L, wh_load_port_step_name(clock.failed), clock.failed != WH_LOAD_PORT_STANDS);
    return 5;
}

/* native.is_port_open(station): true unless it is a load port that is not open, or in which a step runs. */
static int read_open(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = port_argument(L, mcs, 1);
    lua_pushboolean(L, number == WH_NONE || wh_load_port_is_open(&mcs->clocks->ports->ports[number].clock));
    return 1;
}

/* native.port_map(station): how often its carrier was mapped or went, and the codes by slot of the carrier
 * that is there, or nil. */
static int read_map(lua_State *L) {
    int32_t number;
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const struct wh_ports *ports = need_port(L, mcs, 1, &number);
    const wh_station_t *place = &mcs->real->places[ports->of[number].station];
    lua_pushinteger(L, ports->ports[number].changes);
    if (!ports->ports[number].is_mapped) {
        return 1;
    }
    lua_createtable(L, place->slots, 0);
    for (int32_t slot = 0; slot < place->slots; ++slot) {
        lua_pushinteger(L, ports->codes[ports->of[number].first + (size_t)slot]);
        lua_rawseti(L, -2, slot + 1);
    }
    return 2;
}

/* ----------------------------------------------------------------------------------------------- carriers */

/* native.carrier(index): the name of the station where this carrier is, or to which it comes, or nil; and
 * if it is away two tables of wafers' names by slot: those in it, and those that were left out before. */
static int read_carrier(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t carrier = wh_mcs_index(L, 1, mcs->layout->carrier_count);
    const struct wh_ports *ports = mcs->clocks ? mcs->clocks->ports : NULL;
    if (!ports) {
        return luaL_argerror(L, 1, "there is no load port");
    }
    const int32_t port = ports->carriers[carrier].port;
    push_name_or_nil(L, port == WH_NONE ? NULL : mcs->layout->stations[ports->of[port].station].name,
                     port != WH_NONE);
    for (int out = 0; out < 2; ++out) {
        lua_newtable(L);
        for (size_t w = 0; w < mcs->layout->wafer_count; ++w) {
            if (ports->wafers[w].carrier == carrier && ports->wafers[w].stays == (out == 1)) {
                lua_pushstring(L, mcs->layout->wafers[w].name);
                lua_rawseti(L, -2, ports->wafers[w].slot);
            }
        }
    }
    return 3;
}

/* A wafer as a mapper would find it: turned about the slot's x, which is the way in, or too far out. */
static void lay(const wh_mcs_t *mcs, const wh_layout_port_t *port, int32_t station, const char *how,
                wh_carried_t *carried) {
    const wh_mapping_t *mapping = &port->mapping;
    const wh_real_t pitch = mcs->layout->places[station].pitch;
    const wh_real_t half = mcs->layout->wafer_diameter / 2;
    if (strcmp(how, "protruded") == 0) {
        carried->slot_from_wafer.r.x -= mapping->protruded + BEYOND;
    } else if (strcmp(how, "crossed") == 0) {
        const wh_real_t height = pitch < half ? pitch : half;
        const wh_real_t sine = height / (2 * half);
        const wh_real_t cosine = wh_real_sqrt(1 - sine * sine);
        const wh_pose_t tilt = {{{{1, 0, 0}, {0, cosine, -sine}, {0, sine, cosine}}}, {0, 0, height / 2}};
        carried->slot_from_wafer = wh_pose_compose(&tilt, &carried->slot_from_wafer);
    } else if (strcmp(how, "double") == 0) {
        carried->slot_from_wafer.r.z += mcs->layout->wafer_thickness;
        --carried->slot;
    }
    carried->stays = strcmp(how, "empty") == 0;
}

/* The wafers of the carrier are laid as the table at this stack index says, by slot. */
static void lay_all(lua_State *L, struct wh_ports *ports, int32_t carrier, int32_t station, int changes) {
    const wh_mcs_t *mcs = ports->mcs;
    for (size_t w = 0; w < mcs->layout->wafer_count; ++w) {
        wh_carried_t *carried = &ports->wafers[w];
        if (carried->carrier != carrier) {
            continue;
        }
        const bool is_said = lua_rawgeti(L, changes, carried->slot) == LUA_TSTRING;
        const char *how = is_said ? lua_tostring(L, -1) : "";
        if (is_said && (!carried->stays || strcmp(how, "in") == 0)) {
            lay(mcs, mcs->layout->stations[station].port, station, how, carried);
        }
        lua_pop(L, 1);
    }
}

/* native.bring(carrier, station, at, changes): the carrier, which is away, comes to this load port at this
 * time, in s, or as soon after as the port is free. `changes` has for slots how their wafers come: "empty"
 * if they stay away, "in" if one that had stayed away comes, "protruded", "crossed", or "double" if it lies
 * on that of the slot below. */
static int bring(lua_State *L) {
    int32_t number;
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t carrier = wh_mcs_index(L, 1, mcs->layout->carrier_count);
    struct wh_ports *ports = need_port(L, mcs, 2, &number);
    luaL_checktype(L, 4, LUA_TTABLE);
    lay_all(L, ports, carrier, ports->of[number].station, 4);
    ports->carriers[carrier] = (wh_carrier_now_t){number, true, llround(luaL_checknumber(L, 3) * 1e6)};
    ports->ports[number].is_told = true;
    wh_decisions_measured(mcs->wanted.decisions, "carriers that come");
    return 0;
}

/* native.send_port(station, state): from now on the load port goes to this state, "absent" until its
 * carrier is gone. False while there is no carrier, or one comes or goes. */
static int send_port(lua_State *L) {
    int32_t number;
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    struct wh_ports *ports = need_port(L, mcs, 1, &number);
    wh_ports_telling_t telling = {ports, number};
    const wh_load_port_teller_t teller = {wh_ports_tell, &telling};
    const int to = luaL_checkoption(L, 2, NULL, wh_load_port_state_names);
    ports->ports[number].is_told = false;
    lua_pushboolean(L, wh_load_port_go(&ports->of[number].of, &ports->ports[number].clock,
                                       (wh_load_port_state_t)to, mcs->clocks->state->utime, &teller));
    return 1;
}

/* native.tell_port(station): an error has told the handshake that failed there. */
static int note_told(lua_State *L) {
    int32_t number;
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    need_port(L, mcs, 1, &number)->ports[number].is_told = true;
    return 0;
}

const luaL_Reg wh_mcs_port_functions[] = {
    {"port", read_port}, {"is_port_open", read_open}, {"port_map", read_map},   {"carrier", read_carrier},
    {"bring", bring},    {"send_port", send_port},    {"tell_port", note_told}, {NULL, NULL}};
