#include "clocks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../script/wh_module_values.h"

/* --------------------------------------------------------------------------------------------- setting up */

static void *lua_memory(lua_State *L, size_t bytes) {
    void *memory = lua_newuserdatauv(L, bytes > 0 ? bytes : 1, 0);
    memset(memory, 0, bytes);
    lua_rawsetp(L, LUA_REGISTRYINDEX, memory);
    return memory;
}

/* A trial draws how long the station's process takes. */
static void draw_process(const struct wh_clocks *clocks, wh_clocked_t *of) {
    const wh_mcs_t *mcs = clocks->mcs;
    if (mcs->wanted.trial && mcs->layout->errors && of->of.process_us > 0) {
        const wh_real_t s =
            wh_errors_draw_process(mcs->layout->errors, mcs->wanted.trial, (size_t)of->station);
        of->of.process_us += llround((double)s * 1e6);
        of->of.process_us = of->of.process_us > 1 ? of->of.process_us : 1;
    }
}

static void number_stations(struct wh_clocks *clocks, const wh_layout_t *real) {
    for (size_t s = 0; s < real->station_count; ++s) {
        const wh_layout_times_t *times = real->stations[s].times;
        clocks->by_station[s] = WH_NONE;
        if (times) {
            clocks->by_station[s] = (int32_t)clocks->count;
            clocks->of[clocks->count] = (wh_clocked_t){(int32_t)s, times, times->of, clocks->place_count};
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
    clocks->state_bytes = head + of_clocks + of_places + clocks->place_count * sizeof *clocks->lying;
    char *block = lua_memory(L, clocks->state_bytes);
    clocks->state = (void *)block;
    clocks->clocks = (void *)(block + head);
    clocks->places = (void *)(block + head + of_clocks);
    clocks->lying = (void *)(block + head + of_clocks + of_places);
    for (size_t i = 0; i < WH_MCS_ROBOTS; ++i) {
        clocks->state->inside[i] = WH_NONE;
    }
    for (size_t i = 0; i < clocks->place_count; ++i) {
        clocks->lying[i] = WH_NONE;
    }
    for (size_t i = 0; i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        wh_clock_start(&of->of, &clocks->clocks[i], &clocks->places[of->first]);
    }
}

/* ------------------------------------------------------------------------------------------------ telling */

static const char *station_name(const struct wh_clocks *clocks, const wh_clocked_t *of) {
    return clocks->mcs->layout->stations[of->station].name;
}

static const char *wafer_name(const struct wh_clocks *clocks, int32_t wafer) {
    return clocks->mcs->layout->wafers[wafer].name;
}

static void imply(const wh_mcs_t *mcs, const char *text, bool ok) {
    wh_record_add_implied(mcs->recorder.record, 0, text, ok);
    if (!ok) {
        wh_mcs_tell(mcs, WH_MCS_EXPECTED, NULL);
    }
}

static void judge_stay(const struct wh_clocks *clocks, const wh_clocked_t *of, int32_t wafer,
                       double stay_us) {
    char text[400];
    if (of->of.window_us == WH_FLOW_NEVER || clocks->state->tells_late) {
        return;
    }
    const double over_us = stay_us - (double)of->of.window_us;
    const int length =
        snprintf(text, sizeof text, "%s leaves %s at most %.10g s after its process",
                 wafer_name(clocks, wafer), station_name(clocks, of), (double)of->of.window_us / 1e6);
    if (over_us > 0) {
        snprintf(text + length, sizeof text - (size_t)length, "; it stayed %.10g s, %.10g s too long",
                 stay_us / 1e6, over_us / 1e6);
    }
    imply(clocks->mcs, text, over_us <= 0);
}

static void judge_cut(const struct wh_clocks *clocks, const wh_clocked_t *of, const wh_clock_event_t *event) {
    char text[400];
    snprintf(text, sizeof text,
             "the process of %s in %s comes to its end; the wafer was taken after %.10g of %.10g s",
             wafer_name(clocks, event->wafer), station_name(clocks, of), (double)event->us / 1e6,
             (double)of->of.process_us / 1e6);
    imply(clocks->mcs, text, false);
}

typedef struct {
    const struct wh_clocks *clocks;
    const wh_clocked_t *of;
} telling_t;

static void tell(void *user, const wh_clock_event_t *event) {
    const telling_t *telling = user;
    const wh_mcs_t *mcs = telling->clocks->mcs;
    wh_record_add_station_event(mcs->recorder.record,
                                &(wh_station_event_record_t){telling->of->station, *event});
    wh_mcs_tell(mcs, WH_MCS_STATION_TOLD, NULL);
    if (event->kind == WH_CLOCK_TAKEN) {
        judge_stay(telling->clocks, telling->of, event->wafer, (double)event->us);
    } else if (event->kind == WH_CLOCK_PROCESS_CUT) {
        judge_cut(telling->clocks, telling->of, event);
    }
}

void wh_mcs_judge_stays(const wh_mcs_t *mcs) {
    const struct wh_clocks *clocks = mcs->clocks;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        for (int32_t slot = 0; slot < of->of.slots; ++slot) {
            const wh_clock_place_t *place = &clocks->places[of->first + (size_t)slot];
            const double stay_us = (double)(clocks->state->utime - place->done_us);
            if (place->phase == WH_CLOCK_DONE && stay_us > (double)of->of.window_us) {
                judge_stay(clocks, of, place->wafer, stay_us);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------- what is seen */

static void forget_wafer(struct wh_clocks *clocks, int32_t wafer) {
    for (size_t i = 0; i < clocks->place_count; ++i) {
        clocks->lying[i] = clocks->lying[i] == wafer ? WH_NONE : clocks->lying[i];
    }
}

/* Finds the place in which a wafer lies that nobody holds. The first of two in one slot counts. */
static void place_wafer(struct wh_clocks *clocks, const wh_state_t *state, int32_t wafer) {
    const wh_wafer_t *is = &state->wafers[wafer];
    wh_place_t place;
    forget_wafer(clocks, wafer);
    if (is->holder != WH_NONE || !wh_cell_locate(&clocks->mcs->real->cell, &is->base_from_wafer, &place) ||
        clocks->by_station[place.station] == WH_NONE) {
        return;
    }
    const wh_clocked_t *of = &clocks->of[clocks->by_station[place.station]];
    int32_t *lying = &clocks->lying[of->first + (size_t)place.slot - 1];
    *lying = *lying == WH_NONE ? wafer : *lying;
}

static void place_all(struct wh_clocks *clocks, const wh_state_t *state) {
    for (size_t w = 0; w < state->wafer_count; ++w) {
        place_wafer(clocks, state, (int32_t)w);
    }
}

/* Wafers come and go with events; all are looked for where a state may have been missed. */
static void see_wafers(struct wh_clocks *clocks, const wh_state_t *state) {
    if (state->seq != clocks->state->seq + 1 || state->has_lost_events) {
        place_all(clocks, state);
        return;
    }
    for (size_t i = 0; i < state->event_count; ++i) {
        if (wh_is_index(state->events[i].wafer, state->wafer_count)) {
            place_wafer(clocks, state, state->events[i].wafer);
        }
    }
}

/* A door of the station that is not shut, or WH_NONE. */
static int32_t find_open_door(const wh_mcs_t *mcs, uint32_t doors) {
    for (size_t d = 0; d < mcs->layout->machine.door_count; ++d) {
        if ((doors >> d & 1U) != 0 && strcmp(wh_mcs_door_word(mcs, d), "shut") != 0) {
            return (int32_t)d;
        }
    }
    return WH_NONE;
}

static bool is_closed(const struct wh_clocks *clocks, const wh_clocked_t *of) {
    bool is_free = true;
    for (size_t r = 0; r < WH_MCS_ROBOTS; ++r) {
        is_free = is_free && clocks->state->inside[r] != of->station;
    }
    return is_free && find_open_door(clocks->mcs, of->times->doors) == WH_NONE;
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

/* ----------------------------------------------------------------------------------------------- stepping */

static void look(struct wh_clocks *clocks, size_t number) {
    const wh_clocked_t *of = &clocks->of[number];
    telling_t telling = {clocks, of};
    const wh_clock_teller_t teller = {tell, &telling};
    wh_clock_look(&of->of, &clocks->clocks[number], &clocks->places[of->first], &clocks->lying[of->first],
                  is_closed(clocks, of), clocks->state->utime, &teller);
}

/* native.begin_clocks(): at time 0 wafers lie where the layout has them, and doors are at home. It is told
 * once the run has its link. */
static int begin(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    struct wh_clocks *clocks = mcs->clocks;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        look(clocks, i);
    }
    return 0;
}

/* A free run tells a state more than once, and misses others. */
static void hear(void *user, const wh_command_t *command, const wh_state_t *state) {
    struct wh_clocks *clocks = user;
    (void)command;
    if (state->status != WH_OK || state->seq <= clocks->state->seq) {
        return;
    }
    see_wafers(clocks, state);
    const double us = (double)(state->utime - clocks->state->utime);
    clocks->state->seq = state->seq;
    clocks->state->utime = state->utime;
    for (size_t i = 0; i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        telling_t telling = {clocks, of};
        const wh_clock_teller_t teller = {tell, &telling};
        wh_clock_pass(&of->of, &clocks->clocks[i], &clocks->places[of->first], us, rate_of(state, of),
                      state->utime, &teller);
        look(clocks, i);
    }
}

int64_t wh_mcs_clocks_quiet(const wh_mcs_t *mcs) {
    const struct wh_clocks *clocks = mcs->clocks;
    double us = (double)INFINITY;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        us = fmin(us, wh_clock_quiet_us(&of->of, &clocks->clocks[i], &clocks->places[of->first],
                                        clocks->state->utime));
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
    if (clocks) {
        clocks->state->seq += slices;
        clocks->state->utime += us;
    }
}

void wh_mcs_begin_clocks(lua_State *L, wh_mcs_t *mcs) {
    const wh_layout_t *real = mcs->real;
    if (!wh_layout_takes_time(real)) {
        return;
    }
    struct wh_clocks *clocks = lua_memory(L, sizeof *clocks);
    clocks->mcs = mcs;
    clocks->of = lua_memory(L, real->station_count * sizeof *clocks->of);
    clocks->by_station = lua_memory(L, real->station_count * sizeof *clocks->by_station);
    number_stations(clocks, real);
    make_state(L, clocks);
    mcs->clocks = clocks;
    place_all(clocks, &mcs->state);
    wh_mcs_listen(mcs, hear, clocks);
    wh_decisions_measured(mcs->wanted.decisions, "stations that take time");
}

/* ---------------------------------------------------------------------------------------------- questions */

static bool is_place_idle(const wh_clock_place_t *place) {
    return place->phase == WH_CLOCK_DONE || (place->phase == WH_CLOCK_FREE && !place->is_clean_due);
}

static int32_t number_of(const wh_mcs_t *mcs, int32_t station) {
    return mcs->clocks ? mcs->clocks->by_station[station] : WH_NONE;
}

bool wh_mcs_is_station_idle(const wh_mcs_t *mcs, int32_t station) {
    const int32_t number = number_of(mcs, station);
    if (number == WH_NONE) {
        return true;
    }
    const wh_clocked_t *of = &mcs->clocks->of[number];
    bool is_idle = !mcs->clocks->clocks[number].is_pumping;
    for (int32_t slot = 0; slot < of->of.slots; ++slot) {
        is_idle = is_idle && is_place_idle(&mcs->clocks->places[of->first + (size_t)slot]);
    }
    return is_idle;
}

bool wh_mcs_is_pumping(const wh_mcs_t *mcs, int32_t station) {
    const int32_t number = number_of(mcs, station);
    return number != WH_NONE && mcs->clocks->clocks[number].is_pumping;
}

const char *wh_mcs_station_word(const wh_mcs_t *mcs, int32_t station, double *left_us) {
    /* by phase: which one tells most */
    static const int ranks[] = {[WH_CLOCK_FREE] = 0,
                                [WH_CLOCK_DONE] = 1,
                                [WH_CLOCK_WAITING] = 2,
                                [WH_CLOCK_CLEANING] = 3,
                                [WH_CLOCK_PROCESSING] = 4};
    const int32_t number = number_of(mcs, station);
    *left_us = 0;
    if (number == WH_NONE) {
        return NULL;
    }
    const wh_clocked_t *of = &mcs->clocks->of[number];
    wh_clock_phase_t phase = WH_CLOCK_FREE;
    for (int32_t slot = 0; slot < of->of.slots; ++slot) {
        const wh_clock_place_t *place = &mcs->clocks->places[of->first + (size_t)slot];
        phase = ranks[place->phase] > ranks[phase] ? place->phase : phase;
        *left_us = place->left_us > *left_us ? place->left_us : *left_us;
    }
    if (mcs->clocks->clocks[number].is_pumping) {
        *left_us = mcs->clocks->clocks[number].left_us;
        return "pumping";
    }
    return wh_clock_phase_name(phase);
}

const char *wh_mcs_pressure_word(const wh_mcs_t *mcs, int32_t station) {
    const int32_t number = number_of(mcs, station);
    return number != WH_NONE && mcs->clocks->of[number].of.is_lock
               ? wh_clock_side_name(mcs->clocks->clocks[number].side)
               : NULL;
}

/* The number of the station at this stack index; WH_NONE: it takes no time. */
static int32_t clocked_argument(lua_State *L, const wh_mcs_t *mcs, int argument) {
    return number_of(mcs, wh_mcs_index(L, argument, mcs->layout->station_count));
}

/* native.place(station, slot): nothing if the station takes no time; else what goes on there: "empty",
 * "waiting", "processing", "cleaning" or "done"; the wafer's name or nil; s until nothing runs there, by the
 * description; and whether a clean comes when the wafer has left. */
static int read_place(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = clocked_argument(L, mcs, 1);
    if (number == WH_NONE) {
        return 0;
    }
    const wh_clocked_t *of = &mcs->clocks->of[number];
    const int32_t slot = wh_mcs_index(L, 2, (size_t)of->of.slots);
    const wh_clock_place_t *place = &mcs->clocks->places[of->first + (size_t)slot];
    const bool is_due = place->phase == WH_CLOCK_FREE && place->is_clean_due;
    lua_pushstring(L, is_due ? "cleaning" : wh_clock_phase_name(place->phase));
    lua_pushstring(L, place->wafer == WH_NONE ? NULL : wafer_name(mcs->clocks, place->wafer));
    lua_pushnumber(L, wh_clock_left_us(&of->of, place) / 1e6);
    lua_pushboolean(L, !of->of.cleans_full && wh_clock_cleans_next(&of->of, place));
    return 4;
}

/* native.pressure(station): nothing if it is no lock; else "vacuum" or "atmosphere", and if it pumps where to
 * and for how many s yet. */
static int read_pressure(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = clocked_argument(L, mcs, 1);
    if (number == WH_NONE || !mcs->clocks->of[number].of.is_lock) {
        return 0;
    }
    const wh_clock_t *clock = &mcs->clocks->clocks[number];
    lua_pushstring(L, wh_clock_side_name(clock->side));
    if (!clock->is_pumping) {
        return 1;
    }
    lua_pushstring(L, wh_clock_side_name(clock->pump_to));
    lua_pushnumber(L, clock->left_us / 1e6);
    return 3;
}

/* native.open_door(station): the index of a door of it that is not shut, or nil. */
static int find_station_door(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = clocked_argument(L, mcs, 1);
    wh_lua_push_index(L, number == WH_NONE ? WH_NONE
                                           : find_open_door(mcs, mcs->clocks->of[number].times->doors));
    return 1;
}

/* native.rest(station): s until nothing runs or is to run in it, by the description; nil: nothing is. */
static int read_rest(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const int32_t number = number_of(mcs, station);
    if (wh_mcs_is_station_idle(mcs, station)) {
        return 0;
    }
    const wh_clocked_t *of = &mcs->clocks->of[number];
    double rest_us = mcs->clocks->clocks[number].left_us;
    for (int32_t slot = 0; slot < of->of.slots; ++slot) {
        const double left_us = wh_clock_left_us(&of->of, &mcs->clocks->places[of->first + (size_t)slot]);
        rest_us = left_us > rest_us ? left_us : rest_us;
    }
    lua_pushnumber(L, rest_us / 1e6);
    return 1;
}

/* True if the wafer lies there and may be taken; then since when. */
static bool find_stay(const wh_mcs_t *mcs, int32_t number, int32_t wafer, int64_t *since_us) {
    const wh_clocked_t *of = &mcs->clocks->of[number];
    for (int32_t slot = 0; slot < of->of.slots; ++slot) {
        const wh_clock_place_t *place = &mcs->clocks->places[of->first + (size_t)slot];
        if (place->phase == WH_CLOCK_DONE && place->wafer == wafer) {
            *since_us = place->done_us;
            return true;
        }
    }
    return false;
}

/* native.stay(wafer, station): s that the wafer's last stay there lasted from its process's end until it was
 * taken, or until now; nil: there was none; then true if it still lies there. */
static int read_stay(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t wafer = wh_mcs_index(L, 1, mcs->layout->wafer_count);
    const int32_t station = wh_mcs_index(L, 2, mcs->layout->station_count);
    const int32_t number = number_of(mcs, station);
    const wh_record_t *record = mcs->recorder.record;
    int64_t since_us = 0;
    if (number != WH_NONE && find_stay(mcs, number, wafer, &since_us)) {
        lua_pushnumber(L, (double)(mcs->clocks->state->utime - since_us) / 1e6);
        lua_pushboolean(L, true);
        return 2;
    }
    for (size_t i = record->station_event_count; i > 0; --i) {
        const wh_station_event_record_t *event = &record->station_events[i - 1];
        if (event->station == station && event->event.wafer == wafer && event->event.kind == WH_CLOCK_TAKEN) {
            lua_pushnumber(L, (double)event->event.us / 1e6);
            lua_pushboolean(L, false);
            return 2;
        }
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ changes */

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
        look(clocks, (size_t)number);
    }
    return 0;
}

/* native.pump(station, "vacuum" or "atmosphere"): the lock begins to pump there. True, unless it is on its
 * way to the other one. */
static int begin_pump(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = clocked_argument(L, mcs, 1);
    luaL_argcheck(L, number != WH_NONE, 1, "no lock");
    struct wh_clocks *clocks = mcs->clocks;
    const wh_clocked_t *of = &clocks->of[number];
    const bool is_vacuum = strcmp(luaL_checkstring(L, 2), "vacuum") == 0;
    telling_t telling = {clocks, of};
    const wh_clock_teller_t teller = {tell, &telling};
    lua_pushboolean(L, wh_clock_pump(&of->of, &clocks->clocks[number], &clocks->places[of->first],
                                     is_vacuum ? WH_FLOW_VACUUM : WH_FLOW_ATMOSPHERE, clocks->state->utime,
                                     &teller));
    return 1;
}

/* native.tell_late(tells): stays beyond windows fail the run, or not. */
static int set_late(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    if (mcs->clocks) {
        mcs->clocks->state->tells_late = lua_toboolean(L, 1);
    }
    return 0;
}

const luaL_Reg wh_mcs_clock_functions[] = {{"begin_clocks", begin},     {"place", read_place},
                                           {"pressure", read_pressure}, {"open_door", find_station_door},
                                           {"rest", read_rest},         {"stay", read_stay},
                                           {"stands_in", set_inside},   {"pump", begin_pump},
                                           {"tell_late", set_late},     {NULL, NULL}};
