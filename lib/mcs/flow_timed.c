/* Robots that are times alone among robots with axes: their wafers leave the cell and come back by orders to
 * the simulator. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/ports.h"
#include "../text/array.h"
#include "flow_played.h"
#include "ports.h"

/* The simulator may lack room for an order for this number of slices. */
#define PATIENCE 1000

/* --------------------------------------------------------------------------------------------- setting up */

void wh_flow_timed_open(wh_flow_played_t *played) {
    played->aboard = wh_array_new(played->flow->plan.wafer_count, sizeof *played->aboard);
    for (size_t w = 0; w < played->mcs->layout->wafer_count; ++w) {
        if (played->numbers[w] != WH_FLOW_NONE) {
            played->aboard[played->numbers[w]] = (wh_flow_aboard_t){(int32_t)w, wh_pose_identity()};
        }
    }
}

void wh_flow_timed_close(wh_flow_played_t *played) {
    free(played->aboard);
    free(played->carried);
    played->aboard = NULL;
    played->carried = NULL;
}

/* ----------------------------------------------------------------------------------------------- accesses */

/* An action of a robot in a station: the wafer that it takes out of a place, and the one that it brings
 * there; WH_FLOW_NONE: none. */
typedef struct {
    int32_t robot, station, place, out, in;
    int64_t end_us;
} access_t;

/* True if the robot is times alone and takes or places now. */
static bool find_access(const wh_flow_played_t *played, int32_t robot, access_t *access) {
    const wh_flow_state_t *state = &played->engine->state;
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const bool picks = at->action == WH_FLOW_PICKING, swaps = at->action == WH_FLOW_SWAPS;
    if (played->tool->robots[robot].is_real || !(picks || swaps || at->action == WH_FLOW_PLACING)) {
        return false;
    }
    *access = (access_t){.robot = robot,
                         .station = at->station,
                         .place = picks ? at->from : at->to,
                         .out = picks   ? at->order.wafer
                                : swaps ? state->places[at->to].wafer
                                        : WH_FLOW_NONE,
                         .in = picks ? WH_FLOW_NONE : at->order.wafer,
                         .end_us = at->until_us};
    return true;
}

static void add_use(const wh_flow_played_t *played, const access_t *access, int32_t slot,
                    wh_flow_use_t *use) {
    const bool is_its = access->place == played->tool->stations[access->station].first_place + slot;
    use->is_inside = true;
    use->takes = use->takes || (is_its && access->out != WH_FLOW_NONE);
    use->brings = use->brings || (is_its && access->in != WH_FLOW_NONE);
}

/* The flow that runs in a cell of both kinds; else null. */
static wh_flow_played_t *flow_of(const wh_mcs_t *mcs) {
    return mcs->lanes && mcs->layout->timed ? mcs->lanes->flow : NULL;
}

wh_flow_use_t wh_flow_timed_use(const wh_mcs_t *mcs, int32_t station, int32_t slot) {
    const wh_flow_played_t *played = flow_of(mcs);
    wh_flow_use_t use = {false, false, false};
    access_t access;
    for (int32_t r = 0; played && r < (int32_t)played->tool->robot_count; ++r) {
        if (find_access(played, r, &access) && access.station == station &&
            access.end_us > wh_flow_played_now(played)) {
            add_use(played, &access, slot, &use);
        }
    }
    return use;
}

/* ------------------------------------------------------------------------------------------------- places */

static wh_pose_t slot_of(const wh_flow_played_t *played, const access_t *access) {
    return wh_station_slot(&played->mcs->real->places[access->station],
                           wh_flow_slot(played->tool, access->place));
}

/* It comes to lie as it lay in the slot before. */
static wh_pose_t place_in(const wh_flow_played_t *played, const access_t *access) {
    const wh_pose_t base_from_slot = slot_of(played, access);
    wh_pose_t base_from_wafer;
    wh_pose_compose_to(&base_from_slot, &played->aboard[access->in].slot_from_wafer, &base_from_wafer);
    if (wh_pose_validate(&base_from_wafer) != WH_OK) {
        wh_mat3_orthonormalise(&base_from_wafer.R);
    }
    return base_from_wafer;
}

static const wh_wafer_t *wafer_of(const wh_flow_played_t *played, int32_t wafer) {
    return &played->mcs->state.wafers[played->aboard[wafer].found];
}

static bool is_away(const wh_flow_played_t *played, int32_t wafer) {
    const wh_pose_t outside = wh_layout_outside((size_t)played->aboard[wafer].found);
    return wh_ports_is_same_place(&wafer_of(played, wafer)->base_from_wafer, &outside);
}

/* The layout's wafer that lies in the place, or WH_NONE; `but` is not looked at. */
static int32_t find_in(const wh_flow_played_t *played, const access_t *access, int32_t but) {
    const wh_state_t *state = &played->mcs->state;
    const int32_t slot = wh_flow_slot(played->tool, access->place);
    wh_place_t at;
    for (size_t w = 0; w < state->wafer_count; ++w) {
        const wh_wafer_t *wafer = &state->wafers[w];
        if ((int32_t)w != but && wafer->holder == WH_NONE &&
            wh_cell_locate(&played->mcs->real->cell, &wafer->base_from_wafer, &at) &&
            at.station == access->station && at.slot == slot) {
            return (int32_t)w;
        }
    }
    return WH_NONE;
}

static bool has_come(const wh_flow_played_t *played, const access_t *access) {
    const wh_pose_t wanted = place_in(played, access);
    return wh_ports_is_same_place(&wafer_of(played, access->in)->base_from_wafer, &wanted);
}

/* ----------------------------------------------------------------------------------------------- problems */

/* The flow ends by this cause. */
static void fail(wh_flow_played_t *played, const access_t *access, wh_status_t status, const char *detail) {
    wh_flow_state_t *state = &played->engine->state;
    char text[600];
    (void)snprintf(
        text, sizeof text, "%s: %s at %s %d: error %d %s: %s", played->tool->robots[access->robot].name,
        access->out == WH_FLOW_NONE  ? "place"
        : access->in == WH_FLOW_NONE ? "pick"
                                     : "swap",
        played->tool->stations[access->station].name, (int)wh_flow_slot(played->tool, access->place),
        (int)status, wh_status_name(status), detail);
    state->cause = state->cause ? state->cause : wh_text_copy(text);
    played->is_due = true;
}

/* A robot with axes may have been left in the station by a script. */
static int32_t find_inside(const wh_flow_played_t *played, int32_t station) {
    const struct wh_clocks *clocks = played->mcs->clocks;
    for (size_t r = 0; clocks && r < played->mcs->layout->robot_count; ++r) {
        if (clocks->state->inside[r] == station) {
            return (int32_t)r;
        }
    }
    return WH_NONE;
}

static bool is_port_open(const wh_flow_played_t *played, int32_t station) {
    const int32_t port = wh_ports_find(played->mcs, station);
    return port == WH_NONE || wh_load_port_is_open(&played->mcs->clocks->ports->ports[port].clock);
}

/* False, with a cause: the way into the station is not free. */
static bool check_way(wh_flow_played_t *played, const access_t *access) {
    const wh_flow_door_t *door =
        &played->tool->doors[wh_flow_of(played->tool, access->robot, access->station)];
    const int32_t other = find_inside(played, access->station);
    const wh_layout_t *layout = played->mcs->layout;
    char text[200];
    if (!is_port_open(played, access->station)) {
        fail(played, access, WH_STATUS_PORT_NOT_OPEN, "a carrier that is open was expected");
    } else if (door->is_real && strcmp(wh_mcs_door_word(played->mcs, (size_t)door->number), "open") != 0) {
        (void)snprintf(text, sizeof text, "%s is not open", layout->door_list[door->number].name);
        fail(played, access, WH_STATUS_DOOR_SHUT, text);
    } else if (other != WH_NONE) {
        (void)snprintf(text, sizeof text, "%s stands in it", layout->robots[other].name);
        fail(played, access, WH_STATUS_BUSY, text);
    } else {
        return true;
    }
    return false;
}

/* A station takes wafers as its `face` says. */
static bool is_face_right(const wh_flow_played_t *played, const access_t *access) {
    const wh_station_face_t face = played->mcs->layout->stations[access->station].face;
    const bool is_down = played->aboard[access->in].slot_from_wafer.R.m[2][2] < 0;
    return face == WH_STATION_ANY_FACE || is_down == (face == WH_STATION_FACE_DOWN);
}

/* True if the place has what it must have before the access: the wafer that goes out, unless it is out
 * already; else none. */
static bool is_as_expected(const wh_flow_played_t *played, const access_t *access, int32_t out,
                           int32_t found) {
    return found == out || (out != WH_NONE && found == WH_NONE && is_away(played, access->out));
}

static int32_t found_of(const wh_flow_played_t *played, int32_t wafer) {
    return wafer == WH_FLOW_NONE ? WH_NONE : played->aboard[wafer].found;
}

/* False, with a cause: a wafer is not where it should be, or another one is. */
static bool check_wafers(wh_flow_played_t *played, const access_t *access) {
    const wh_layout_wafer_t *wafers = played->mcs->layout->wafers;
    const int32_t out = found_of(played, access->out), in = found_of(played, access->in);
    const int32_t found = find_in(played, access, in);
    char text[200];
    if (!is_as_expected(played, access, out, found)) {
        (void)snprintf(text, sizeof text, "%s lies there (expected %s)",
                       found == WH_NONE ? "no wafer" : wafers[found].name,
                       out == WH_NONE ? "none" : wafers[out].name);
        fail(played, access, out == WH_NONE ? WH_STATUS_WAFER_ALREADY_THERE : WH_STATUS_WAFER_MISSING, text);
        return false;
    }
    if (in != WH_NONE && !is_face_right(played, access)) {
        (void)snprintf(text, sizeof text, "%s lies the other way up", wafers[in].name);
        fail(played, access, WH_STATUS_WRONG_FACE, text);
        return false;
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------- orders */

static void take_out(const wh_flow_played_t *played, const access_t *access, wh_command_t *command) {
    wh_flow_aboard_t *aboard = &played->aboard[access->out];
    const wh_pose_t outside = wh_layout_outside((size_t)aboard->found);
    const wh_pose_t *is = &wafer_of(played, access->out)->base_from_wafer;
    const wh_pose_t base_from_slot = slot_of(played, access);
    if (is_away(played, access->out)) {
        return;
    }
    /* a wafer that lies in its slot to the last bit lies so in the next one */
    aboard->slot_from_wafer = wh_ports_is_same_place(is, &base_from_slot)
                                  ? wh_pose_identity()
                                  : wh_pose_relative(&base_from_slot, is);
    wh_ports_order(played->mcs, command, aboard->found, &outside);
}

static void bring_in(const wh_flow_played_t *played, const access_t *access, wh_command_t *command) {
    if (!has_come(played, access)) {
        const wh_pose_t wanted = place_in(played, access);
        wh_ports_order(played->mcs, command, played->aboard[access->in].found, &wanted);
    }
}

static void send(wh_flow_played_t *played, const access_t *access, wh_command_t *command) {
    if (!check_way(played, access) || !check_wafers(played, access)) {
        return;
    }
    if (access->out != WH_FLOW_NONE) {
        take_out(played, access, command);
    }
    if (access->in != WH_FLOW_NONE) {
        bring_in(played, access, command);
    }
}

void wh_flow_timed_send(wh_mcs_t *mcs) {
    wh_flow_played_t *played = flow_of(mcs);
    access_t access;
    for (int32_t r = 0; played && !played->engine->is_over && r < (int32_t)played->tool->robot_count; ++r) {
        if (find_access(played, r, &access) && access.end_us <= wh_flow_played_now(played)) {
            send(played, &access, &mcs->command);
        }
    }
}

static bool is_carried_out(const wh_flow_played_t *played, const access_t *access) {
    return (access->out == WH_FLOW_NONE || is_away(played, access->out)) &&
           (access->in == WH_FLOW_NONE || has_come(played, access));
}

static void keep(wh_flow_played_t *played, int32_t place, bool is_filled) {
    played->carried = wh_array_grow(played->carried, played->carried_count, &played->carried_capacity,
                                    sizeof *played->carried);
    played->carried[played->carried_count++] = (wh_flow_carried_t){place, is_filled};
}

/* Motion control's book of slots hears of what was carried out. */
static void keep_access(wh_flow_played_t *played, const access_t *access) {
    if (access->out != WH_FLOW_NONE) {
        keep(played, access->place, false);
    }
    if (access->in != WH_FLOW_NONE) {
        keep(played, access->place, true);
    }
    played->waited = 0;
}

void wh_flow_timed_wait(wh_flow_played_t *played) {
    wh_flow_state_t *state = &played->engine->state;
    const int64_t now_us = wh_flow_played_now(played), slice_us = played->outside.slice_us;
    access_t access;
    for (int32_t r = 0; played->mcs->layout->timed && r < (int32_t)played->tool->robot_count; ++r) {
        if (!find_access(played, r, &access) || access.end_us > now_us) {
            continue;
        } else if (is_carried_out(played, &access)) {
            keep_access(played, &access);
            continue;
        }
        if (++played->waited > PATIENCE) {
            fail(played, &access, WH_STATUS_BUSY, "the simulator's places for faults are all in use");
        }
        state->robots[r].until_us = now_us + slice_us;
    }
}

/* native.next_carried(): a place that a robot which is times alone has emptied or filled since it was asked
 * last: its station, slot, and whether a wafer lies there now; nothing: there is none left. */
static int next_carried(lua_State *L) {
    wh_flow_played_t *played = wh_mcs_with_layout(L)->lanes->flow;
    if (played->noted_count == played->carried_count) {
        played->noted_count = played->carried_count = 0;
        return 0;
    }
    const wh_flow_carried_t *carried = &played->carried[played->noted_count++];
    lua_pushstring(L, played->tool->stations[played->tool->place_stations[carried->place]].name);
    lua_pushinteger(L, wh_flow_slot(played->tool, carried->place));
    lua_pushboolean(L, carried->is_filled);
    return 3;
}

const luaL_Reg wh_mcs_flow_timed_functions[] = {{"next_carried", next_carried}, {NULL, NULL}};

/* A process of its step goes before the station's. */
void wh_flow_timed_begin(const wh_flow_played_t *played) {
    access_t access;
    for (int32_t r = 0; played->mcs->layout->timed && r < (int32_t)played->tool->robot_count; ++r) {
        const wh_flow_state_t *state = &played->engine->state;
        if (!played->engine->is_over && find_access(played, r, &access) &&
            state->robots[r].since_us == state->now_us) {
            if (access.in != WH_FLOW_NONE) {
                wh_flow_set_process(played, access.in, access.place);
            }
            wh_mcs_clocks_look(played->mcs, access.station);
        }
    }
}
