/* The functions by which lua/mcs and requests ask stations that take time. */
#include "../script/wh_module_values.h"
#include "clocks.h"
#include "ports.h"

static bool is_place_idle(const struct wh_clocks *clocks, const wh_clocked_t *of, int32_t slot) {
    const wh_clock_place_t *place = &clocks->places[of->first + (size_t)slot];
    return place->phase == WH_CLOCK_DONE ||
           (place->phase == WH_CLOCK_FREE && !wh_clock_is_clean_due(&of->of, place, clocks->state->utime));
}

bool wh_mcs_is_station_idle(const wh_mcs_t *mcs, int32_t station) {
    const int32_t number = wh_clocks_find(mcs, station);
    const int32_t port = wh_ports_find(mcs, station);
    if (port != WH_NONE) {
        return wh_ports_is_idle(mcs->clocks->ports, port);
    }
    if (number == WH_NONE) {
        return true;
    }
    const wh_clocked_t *of = &mcs->clocks->of[number];
    bool is_idle = !mcs->clocks->clocks[number].is_pumping;
    for (int32_t slot = 0; slot < of->of.slots; ++slot) {
        is_idle = is_idle && is_place_idle(mcs->clocks, of, slot);
    }
    return is_idle;
}

bool wh_mcs_is_pumping(const wh_mcs_t *mcs, int32_t station) {
    const int32_t number = wh_clocks_find(mcs, station);
    return number != WH_NONE && mcs->clocks->clocks[number].is_pumping;
}

const char *wh_mcs_station_word(const wh_mcs_t *mcs, int32_t station, double *left_us) {
    /* by phase: which one tells most */
    static const int ranks[] = {[WH_CLOCK_FREE] = 0,
                                [WH_CLOCK_DONE] = 1,
                                [WH_CLOCK_WAITING] = 2,
                                [WH_CLOCK_CLEANING] = 3,
                                [WH_CLOCK_PROCESSING] = 4};
    const int32_t number = wh_clocks_find(mcs, station);
    const int32_t port = wh_ports_find(mcs, station);
    *left_us = 0;
    if (port != WH_NONE) {
        const wh_load_port_t *clock = &mcs->clocks->ports->ports[port].clock;
        *left_us = clock->left_us;
        return wh_load_port_state_name(clock->is);
    }
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
    const int32_t number = wh_clocks_find(mcs, station);
    return number != WH_NONE && mcs->clocks->of[number].of.is_lock
               ? wh_flow_side_words[mcs->clocks->clocks[number].side]
               : NULL;
}

/* native.place(station, slot): nothing if the station takes no time; else what goes on there: "empty",
 * "waiting", "processing", "cleaning" or "done"; the wafer's name or nil; s until nothing runs there, by the
 * description; whether a clean comes when the wafer has left; and why no process may begin on the wafer, or
 * nil. */
static int read_place(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = wh_clocks_argument(L, mcs, 1);
    if (number == WH_NONE) {
        return 0;
    }
    const wh_clocked_t *of = &mcs->clocks->of[number];
    const int32_t slot = wh_mcs_index(L, 2, (size_t)of->of.slots);
    const wh_clock_place_t *place = &mcs->clocks->places[of->first + (size_t)slot];
    const int64_t now_us = mcs->clocks->state->utime;
    const bool is_due = wh_clock_is_clean_due(&of->of, place, now_us);
    lua_pushstring(L, is_due ? "cleaning" : wh_clock_phase_name(place->phase));
    lua_pushstring(L, place->wafer == WH_NONE ? NULL : mcs->layout->wafers[place->wafer].name);
    lua_pushnumber(L, wh_clock_left_us(&of->of, place, now_us) / 1e6);
    lua_pushboolean(L, !of->of.cleans_full && wh_clock_cleans_next(&of->of, place));
    char why[WH_CLOCKS_WHY_BYTES];
    lua_pushstring(L, wh_clocks_why_bad(mcs->clocks, of, slot, why));
    return 5;
}

/* native.pressure(station): nothing if it is no lock; else "vacuum" or "atmosphere", and if it pumps where to
 * and for how many s yet. */
static int read_pressure(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = wh_clocks_argument(L, mcs, 1);
    if (number == WH_NONE || !mcs->clocks->of[number].of.is_lock) {
        return 0;
    }
    const wh_clock_t *clock = &mcs->clocks->clocks[number];
    lua_pushstring(L, wh_flow_side_words[clock->side]);
    if (!clock->is_pumping) {
        return 1;
    }
    lua_pushstring(L, wh_flow_side_words[clock->pump_to]);
    lua_pushnumber(L, clock->left_us / 1e6);
    return 3;
}

/* native.open_door(station): the index of a door of it that is not shut, or nil. */
static int find_station_door(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t number = wh_clocks_argument(L, mcs, 1);
    wh_lua_push_index(
        L, number == WH_NONE ? WH_NONE : wh_clocks_find_open_door(mcs, mcs->clocks->of[number].times->doors));
    return 1;
}

/* native.rest(station): s until nothing runs or is to run in it, by the description; nil: nothing is. */
static int read_rest(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const int32_t number = wh_clocks_find(mcs, station);
    if (wh_mcs_is_station_idle(mcs, station)) {
        return 0;
    }
    const int32_t port = wh_ports_find(mcs, station);
    if (port != WH_NONE) {
        lua_pushnumber(L, wh_ports_rest_us(mcs->clocks->ports, port, mcs->clocks->state->utime) / 1e6);
        return 1;
    }
    const wh_clocked_t *of = &mcs->clocks->of[number];
    double rest_us = mcs->clocks->clocks[number].left_us;
    for (int32_t slot = 0; slot < of->of.slots; ++slot) {
        const double left_us = wh_clock_left_us(&of->of, &mcs->clocks->places[of->first + (size_t)slot],
                                                mcs->clocks->state->utime);
        rest_us = left_us > rest_us ? left_us : rest_us;
    }
    lua_pushnumber(L, rest_us / 1e6);
    return 1;
}

/* The place of the station in which the wafer has come and not left, or null. */
static const wh_clock_place_t *find_place(const wh_mcs_t *mcs, int32_t number, int32_t wafer) {
    const wh_clocked_t *of = &mcs->clocks->of[number];
    for (int32_t slot = 0; slot < of->of.slots; ++slot) {
        const wh_clock_place_t *place = &mcs->clocks->places[of->first + (size_t)slot];
        if (place->wafer == wafer) {
            return place;
        }
    }
    return NULL;
}

static int push_stay(lua_State *L, int64_t us, bool is_there) {
    lua_pushnumber(L, (double)us / 1e6);
    lua_pushboolean(L, is_there);
    return 2;
}

static int push_unended(lua_State *L) {
    lua_pushnil(L);
    lua_pushboolean(L, false);
    return 2;
}

/* A stay that ended: the last event of the wafer there tells how. */
static int push_ended(lua_State *L, const wh_record_t *record, int32_t station, int32_t wafer) {
    for (size_t i = record->station_event_count; i > 0; --i) {
        const wh_station_event_record_t *event = &record->station_events[i - 1];
        const wh_clock_kind_t kind = event->event.kind;
        const bool is_its = event->station == station && event->event.wafer == wafer;
        if (is_its && kind == WH_CLOCK_TAKEN) {
            return push_stay(L, event->event.us, false);
        } else if (is_its && (kind == WH_CLOCK_UNPROCESSED || kind == WH_CLOCK_PROCESS_CUT)) {
            return push_unended(L);
        }
    }
    return 0;
}

/* native.stay(wafer, station): s that the wafer's last stay there lasted from its process's end until it was
 * taken, or until now, and true if it still lies there; nil and false: its process did not end; nil: there
 * was no stay. */
static int read_stay(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t wafer = wh_mcs_index(L, 1, mcs->layout->wafer_count);
    const int32_t station = wh_mcs_index(L, 2, mcs->layout->station_count);
    const int32_t number = wh_clocks_find(mcs, station);
    const wh_clock_place_t *place = number == WH_NONE ? NULL : find_place(mcs, number, wafer);
    if (!place) {
        return push_ended(L, mcs->recorder.record, station, wafer);
    }
    return place->phase == WH_CLOCK_DONE || place->is_around
               ? push_stay(L, mcs->clocks->state->utime - place->done_us, true)
               : push_unended(L);
}

const luaL_Reg wh_mcs_clock_questions[] = {
    {"place", read_place}, {"pressure", read_pressure}, {"open_door", find_station_door},
    {"rest", read_rest},   {"stay", read_stay},         {NULL, NULL}};
