#include "clocks.h"

#include <math.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "flow_played.h"
#include "ports.h"

/* --------------------------------------------------------------------------------------------- setting up */

static void *lua_memory(lua_State *L, size_t bytes) {
    void *memory = lua_newuserdatauv(L, bytes > 0 ? bytes : 1, 0);
    memset(memory, 0, bytes);
    lua_rawsetp(L, LUA_REGISTRYINDEX, memory);
    return memory;
}

/* A process of some time takes longer by the station's error, and some time yet. */
static int64_t err_us(const wh_clocked_t *of, int64_t us) {
    const int64_t longer_us = us + of->error_us;
    return us > 0 && longer_us < 1 ? 1 : us > 0 ? longer_us : us;
}

/* A trial draws how long the station's processes take: all are longer by the same. */
static void draw_process(const struct wh_clocks *clocks, wh_clocked_t *of) {
    const wh_mcs_t *mcs = clocks->mcs;
    if (mcs->wanted.trial && mcs->layout->errors && wh_flow_is_processing(&of->of)) {
        const int64_t usual_us = of->of.process_us;
        of->error_us = llround(
            (double)wh_errors_draw_process(mcs->layout->errors, mcs->wanted.trial, (size_t)of->station) *
            1e6);
        of->of.process_us = err_us(of, usual_us);
        of->error_us = usual_us > 0 ? of->of.process_us - usual_us : of->error_us;
        for (size_t i = 0; i < WH_FLOW_RECIPES; ++i) {
            of->of.by_recipe[i].process_us = err_us(of, of->of.by_recipe[i].process_us);
        }
    }
}

static void number_stations(struct wh_clocks *clocks, const wh_layout_t *real) {
    for (size_t s = 0; s < real->station_count; ++s) {
        const wh_layout_times_t *times = real->stations[s].times;
        clocks->by_station[s] = WH_NONE;
        if (times) {
            clocks->by_station[s] = (int32_t)clocks->count;
            clocks->of[clocks->count] =
                (wh_clocked_t){(int32_t)s, times, times->of, clocks->place_count, 0, false};
            draw_process(clocks, &clocks->of[clocks->count++]);
            clocks->place_count += (size_t)times->of.slots;
        }
    }
}

/* The arrays are of 8-byte words and then of smaller ones: all are aligned. */
static void make_state(lua_State *L, struct wh_clocks *clocks) {
    const size_t head = (sizeof *clocks->state + 7) / 8 * 8;
    const size_t of_clocks = clocks->count * sizeof *clocks->clocks;
    const size_t of_places = clocks->place_count * sizeof *clocks->places;
    clocks->state_bytes = head + of_clocks + of_places + clocks->place_count * sizeof *clocks->seen;
    char *block = lua_memory(L, clocks->state_bytes);
    clocks->state = (void *)block;
    clocks->clocks = (void *)(block + head);
    clocks->places = (void *)(block + head + of_clocks);
    clocks->seen = (void *)(block + head + of_clocks + of_places);
    for (size_t i = 0; i < WH_MCS_ROBOTS; ++i) {
        clocks->state->inside[i] = clocks->state->bringing[i] = WH_NONE;
    }
    for (size_t i = 0; i < clocks->place_count; ++i) {
        clocks->seen[i].wafer = WH_NONE;
    }
    for (size_t i = 0; i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        wh_clock_start(&of->of, &clocks->clocks[i], &clocks->places[of->first]);
    }
}

/* ----------------------------------------------------------------------------------------------- stepping */

int32_t wh_clocks_find_open_door(const wh_mcs_t *mcs, uint32_t doors) {
    for (size_t d = 0; d < mcs->layout->machine.door_count; ++d) {
        if ((doors >> d & 1U) != 0 && strcmp(wh_mcs_door_word(mcs, d), "shut") != 0) {
            return (int32_t)d;
        }
    }
    return WH_NONE;
}

static bool is_closed(const struct wh_clocks *clocks, const wh_clocked_t *of) {
    bool is_free = !of->is_down;
    for (size_t r = 0; r < WH_MCS_ROBOTS; ++r) {
        is_free = is_free && clocks->state->inside[r] != of->station;
    }
    is_free = is_free && !wh_flow_timed_use(clocks->mcs, of->station, 0).is_inside;
    return is_free && wh_clocks_find_open_door(clocks->mcs, of->times->doors) == WH_NONE;
}

/* How fast what runs there goes on: faults make it slow, or stop it. */
static double rate_of(const wh_state_t *state, const wh_clocked_t *of) {
    const wh_physics_state_t *physics = state->physics;
    if (!physics || physics->faults.count == 0) {
        return 1;
    }
    if (wh_faults_find(&physics->faults, WH_FAULT_STATION_STUCK, of->station)) {
        return 0;
    }
    const wh_fault_t *slow = wh_faults_find(&physics->faults, WH_FAULT_STATION_SLOW, of->station);
    return slow && slow->value > 1 ? 1 / slow->value : 1;
}

/* `out`: the robot that has just come out of it, or WH_NONE. */
static void look(struct wh_clocks *clocks, size_t number, const wh_state_t *state, int32_t out) {
    const wh_clocked_t *of = &clocks->of[number];
    wh_clocks_telling_t telling = {clocks, of};
    const wh_clock_teller_t teller = {wh_clocks_tell, &telling};
    wh_clocks_see_places(clocks, of, state, out);
    wh_clock_look(&of->of, &clocks->clocks[number], &clocks->places[of->first], &clocks->seen[of->first],
                  is_closed(clocks, of), clocks->state->utime, &teller);
}

/* native.begin_clocks(): at time 0 wafers lie where the layout has them, and doors are at home. It is told
 * once the run has its link. */
static int begin_all_clocks(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    struct wh_clocks *clocks = mcs->clocks;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        look(clocks, i, &mcs->state, WH_NONE);
    }
    return 0;
}

/* True if a look at the station changes nothing, because its wafers rest and nobody brings one. */
static bool rests(const struct wh_clocks *clocks, const wh_clocked_t *of) {
    bool is_alone = !clocks->mcs->layout->timed;
    for (size_t r = 0; is_alone && r < WH_MCS_ROBOTS; ++r) {
        is_alone = clocks->state->bringing[r] == WH_NONE;
    }
    return is_alone && wh_clock_rests(&of->of, &clocks->places[of->first], &clocks->seen[of->first]);
}

/* A free run tells a state more than once, and misses others. */
static void hear(void *user, const wh_command_t *command, const wh_state_t *state) {
    struct wh_clocks *clocks = user;
    (void)command;
    if (state->status != WH_OK || state->seq <= clocks->state->seq) {
        return;
    }
    wh_clocks_see_wafers(clocks, state);
    const double us = (double)(state->utime - clocks->state->utime);
    clocks->state->seq = state->seq;
    clocks->state->utime = state->utime;
    for (size_t i = 0; i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        wh_clocks_telling_t telling = {clocks, of};
        const wh_clock_teller_t teller = {wh_clocks_tell, &telling};
        wh_clock_pass(&of->of, &clocks->clocks[i], &clocks->places[of->first], us, rate_of(state, of),
                      state->utime, &teller);
        if (!rests(clocks, of)) {
            look(clocks, i, state, WH_NONE);
        }
    }
    if (clocks->ports) {
        wh_ports_hear(clocks->ports, state, us);
    }
}

void wh_mcs_clocks_look(const wh_mcs_t *mcs, int32_t station) {
    const int32_t number = wh_clocks_find(mcs, station);
    if (number != WH_NONE) {
        look(mcs->clocks, (size_t)number, &mcs->state, WH_NONE);
    }
}

void wh_mcs_clocks_send(wh_mcs_t *mcs) {
    if (mcs->clocks && mcs->clocks->ports) {
        wh_ports_send(mcs->clocks->ports, &mcs->command);
    }
    wh_flow_timed_send(mcs);
}

int64_t wh_mcs_clocks_quiet(const wh_mcs_t *mcs) {
    const struct wh_clocks *clocks = mcs->clocks;
    double us = (double)INFINITY;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        us = fmin(us, wh_clock_quiet_us(&of->of, &clocks->clocks[i], &clocks->places[of->first],
                                        clocks->state->utime));
    }
    if (clocks && clocks->ports) {
        us = fmin(us, wh_ports_quiet_us(clocks->ports, clocks->state->utime));
    }
    const double slices = ceil(us / (double)mcs->layout->slice_us) - 1;
    return slices < 1e15 ? (int64_t)fmax(slices, 0) : INT64_MAX;
}

void wh_mcs_clocks_pass(const wh_mcs_t *mcs, int64_t slices) {
    const struct wh_clocks *clocks = mcs->clocks;
    const int64_t us = slices * mcs->layout->slice_us;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        static const wh_clock_teller_t nobody = {NULL, NULL};
        wh_clock_pass(&of->of, &clocks->clocks[i], &clocks->places[of->first], (double)us, 1,
                      clocks->state->utime + us, &nobody);
    }
    if (clocks && clocks->ports) {
        wh_ports_pass(clocks->ports, us, clocks->state->utime + us);
    }
    if (clocks) {
        clocks->state->seq += slices;
        clocks->state->utime += us;
    }
}

void wh_mcs_begin_clocks(lua_State *L, wh_mcs_t *mcs) {
    const wh_layout_t *real = mcs->real;
    if (!wh_layout_takes_time(real) && !wh_layout_has_ports(real) && !real->timed) {
        return;
    }
    struct wh_clocks *clocks = lua_memory(L, sizeof *clocks);
    clocks->mcs = mcs;
    clocks->of = lua_memory(L, real->station_count * sizeof *clocks->of);
    clocks->by_station = lua_memory(L, real->station_count * sizeof *clocks->by_station);
    clocks->found = lua_memory(L, real->wafer_count * sizeof *clocks->found);
    number_stations(clocks, real);
    make_state(L, clocks);
    mcs->clocks = clocks;
    clocks->ports = wh_ports_begin(L, mcs);
    wh_clocks_place_all(clocks, &mcs->state);
    wh_mcs_listen(mcs, hear, clocks);
    wh_decisions_measured(mcs->wanted.decisions, "stations that take time");
}

/* ------------------------------------------------------------------------------------------------ changes */

int32_t wh_clocks_find(const wh_mcs_t *mcs, int32_t station) {
    return mcs->clocks ? mcs->clocks->by_station[station] : WH_NONE;
}

int32_t wh_clocks_argument(lua_State *L, const wh_mcs_t *mcs, int argument) {
    return wh_clocks_find(mcs, wh_mcs_index(L, argument, mcs->layout->station_count));
}

/* native.stands_in(robot, station): the robot stands in this station from now on, nil: in none. */
static int set_inside(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t robot = wh_mcs_index(L, 1, WH_MCS_ROBOTS);
    struct wh_clocks *clocks = mcs->clocks;
    if (!clocks) {
        return 0;
    }
    const int32_t was = clocks->state->inside[robot];
    clocks->state->inside[robot] =
        lua_isnoneornil(L, 2) ? WH_NONE : wh_mcs_index(L, 2, mcs->layout->station_count);
    const int32_t number = was == WH_NONE ? WH_NONE : clocks->by_station[was];
    if (number != WH_NONE) {
        look(clocks, (size_t)number, &mcs->state, robot);
    }
    return 0;
}

/* native.brings(robot, station, slot): a command that was not refused brings a wafer there, nil: none does
 * any more. No clean begins there for its idle time. */
static int set_bringing(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t robot = wh_mcs_index(L, 1, WH_MCS_ROBOTS);
    const int32_t number = lua_isnoneornil(L, 2) || !mcs->clocks ? WH_NONE : wh_clocks_argument(L, mcs, 2);
    if (mcs->clocks) {
        mcs->clocks->state->bringing[robot] = WH_NONE;
    }
    if (number != WH_NONE) {
        const wh_clocked_t *of = &mcs->clocks->of[number];
        mcs->clocks->state->bringing[robot] = (int32_t)of->first + wh_mcs_index(L, 3, (size_t)of->of.slots);
    }
    return 0;
}

/* native.takes_by_force(station, slot): a command may take the wafer there, though its process has not
 * begun. */
static int set_forced(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = wh_clocks_argument(L, mcs, 1);
    luaL_argcheck(L, number != WH_NONE, 1, "it takes no time");
    const wh_clocked_t *of = &mcs->clocks->of[number];
    mcs->clocks->places[of->first + (size_t)wh_mcs_index(L, 2, (size_t)of->of.slots)].is_forced = true;
    return 0;
}

/* native.sets_out(robot): a command of the robot begins. A wafer that it holds within a station is lifted
 * anew: until now it stayed there. */
static int lift_anew(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t robot = wh_mcs_index(L, 1, WH_MCS_ROBOTS);
    struct wh_clocks *clocks = mcs->clocks;
    for (size_t i = 0; clocks && i < clocks->place_count; ++i) {
        wh_clock_place_t *place = &clocks->places[i];
        if (place->is_away && wh_clocks_robot_of(mcs, &mcs->state.wafers[place->wafer]) == robot) {
            wh_clock_lift_anew(place, clocks->state->utime);
        }
    }
    return 0;
}

static bool pump_lock(const struct wh_clocks *clocks, int32_t number, wh_flow_side_t to) {
    const wh_clocked_t *of = &clocks->of[number];
    wh_clocks_telling_t telling = {clocks, of};
    const wh_clock_teller_t teller = {wh_clocks_tell, &telling};
    return wh_clock_pump(&of->of, &clocks->clocks[number], &clocks->places[of->first], to,
                         clocks->state->utime, &teller);
}

/* native.pump(station, "vacuum" or "atmosphere"): the lock begins to pump there. True, unless it is on its
 * way to the other one. */
static int begin_pump(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = wh_clocks_argument(L, mcs, 1);
    luaL_argcheck(L, number != WH_NONE, 1, "no lock");
    const bool is_vacuum = strcmp(luaL_checkstring(L, 2), "vacuum") == 0;
    lua_pushboolean(L, pump_lock(mcs->clocks, number, is_vacuum ? WH_FLOW_VACUUM : WH_FLOW_ATMOSPHERE));
    return 1;
}

bool wh_mcs_pump(const wh_mcs_t *mcs, int32_t station, wh_flow_side_t to) {
    const int32_t number = wh_clocks_find(mcs, station);
    return number != WH_NONE && is_closed(mcs->clocks, &mcs->clocks->of[number]) &&
           pump_lock(mcs->clocks, number, to);
}

void wh_mcs_set_down(const wh_mcs_t *mcs, int32_t station, bool is_down) {
    const int32_t number = wh_clocks_find(mcs, station);
    if (number != WH_NONE) {
        mcs->clocks->of[number].is_down = is_down;
        look(mcs->clocks, (size_t)number, &mcs->state, WH_NONE);
    }
}

/* native.tell_late(tells): stays beyond windows fail the run, or not. */
static int set_late(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    if (mcs->clocks) {
        mcs->clocks->state->tells_late = lua_toboolean(L, 1);
    }
    return 0;
}

const luaL_Reg wh_mcs_clock_functions[] = {{"begin_clocks", begin_all_clocks},
                                           {"stands_in", set_inside},
                                           {"brings", set_bringing},
                                           {"takes_by_force", set_forced},
                                           {"sets_out", lift_anew},
                                           {"pump", begin_pump},
                                           {"tell_late", set_late},
                                           {NULL, NULL}};
