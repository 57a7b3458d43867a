#include "figures.h"

#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"
#include "failed.h"
#include "history.h"
#include "transfer.h"
#include "waiting.h"

const char *const wh_flow_robot_class_names[WH_FLOW_ROBOT_CLASSES] = {
    "empty_way",   "loaded_way",  "pick",       "place",      "swap",        "door", "waits_wafer",
    "waits_place", "waits_clean", "waits_pump", "waits_down", "waits_robot", "idle"};
const char *const wh_flow_station_class_names[WH_FLOW_STATION_CLASSES] = {
    "process", "blocked", "handled", "stored", "clean", "pump", "down", "empty"};

const char *const wh_flow_fate_names[] = {"inside", "end", "shortened", "lost", "skipped"};

/* Cleans, pumps and failures of a place and its station, summed up to now. */
typedef struct {
    int64_t clean_us, pump_us, down_us;
} aside_t;

/* One place's time is counted up to here. */
typedef struct {
    int64_t since_us;
    aside_t aside;
    double *blamed; /* where the end of the last stay was counted */
    bool is_over;   /* the wafer in it is at its end */
} place_t;

struct wh_flow_measure {
    wh_flow_engine_t engine;
    wh_flow_figures_t *figures;
    place_t *places;
    aside_t *asides; /* by place */
    wh_flow_history_t history;
    wh_flow_log_t log;
    wh_flow_keep_t keeps;
};

typedef wh_flow_measure_t measure_t;

/* ----------------------------------------------------------------------------------------------- stations */

static void add(measure_t *measure, int32_t station, wh_flow_station_class_t which, int64_t us) {
    measure->figures->stations[station][which] += (double)us;
}

/* Goes on to `to_us` in one class. Cleans, pumps and failures within count as themselves if `which` is one
 * that gives way to them: those beside a process or a blade are not among the asides. */
static void go_to(measure_t *measure, const wh_flow_state_t *state, int32_t number, int64_t to_us,
                  wh_flow_station_class_t which) {
    place_t *place = &measure->places[number];
    const int32_t station = state->tool->place_stations[number];
    int64_t us = to_us - place->since_us;
    if (us <= 0) {
        return;
    }
    if (which != WH_FLOW_STATION_PROCESS && which != WH_FLOW_STATION_HANDLED) {
        const aside_t *now = &measure->asides[number];
        const int64_t parts[3] = {now->clean_us - place->aside.clean_us, now->pump_us - place->aside.pump_us,
                                  now->down_us - place->aside.down_us};
        for (size_t i = 0; i < 3; ++i) {
            const int64_t part_us = parts[i] < us ? parts[i] : us;
            add(measure, station, (wh_flow_station_class_t)(WH_FLOW_STATION_CLEAN + i), part_us);
            us -= part_us;
        }
        place->aside = *now;
    }
    add(measure, station, which, us);
    place->since_us = to_us;
}

/* The time of a wafer in a place up to now: shutting, process, and waiting. */
static void account_wafer(measure_t *measure, const wh_flow_state_t *state, int32_t wafer, int64_t now_us) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    if (at->step == 0) {
        go_to(measure, state, at->place, at->entered_us,
              measure->places[at->place].is_over ? WH_FLOW_STATION_STORED : WH_FLOW_STATION_EMPTY);
        go_to(measure, state, at->place, now_us, WH_FLOW_STATION_STORED);
        measure->places[at->place].is_over = false;
        return;
    }
    const int64_t processed_us = at->done_us - at->clean_us;
    const int64_t begin_us = processed_us - at->process_us;
    go_to(measure, state, at->place, begin_us < now_us ? begin_us : now_us, WH_FLOW_STATION_HANDLED);
    go_to(measure, state, at->place, processed_us < now_us ? processed_us : now_us, WH_FLOW_STATION_PROCESS);
    go_to(measure, state, at->place, at->done_us < now_us ? at->done_us : now_us, WH_FLOW_STATION_CLEAN);
    go_to(measure, state, at->place, now_us, WH_FLOW_STATION_BLOCKED);
}

/* A done wafer was kept by the place where it goes, until that was or will be empty; then the robot. */
static void blame(measure_t *measure, const wh_flow_state_t *state, const wh_flow_event_t *stay) {
    const size_t stations = state->tool->station_count, robots = state->tool->robot_count;
    int64_t from_us = stay->begin_us;
    const int32_t to = state->robots[stay->robot].to;
    if (to != WH_FLOW_NONE && to != stay->place) {
        const wh_flow_place_t *place = &state->places[to];
        int64_t empty_us = place->wafer == WH_FLOW_NONE ? place->empty_us : stay->end_us;
        empty_us = empty_us > stay->end_us ? stay->end_us : empty_us;
        if (empty_us > from_us) {
            double *by_station =
                &measure->figures->blocked_by_station[(size_t)stay->station * stations +
                                                      (size_t)state->tool->place_stations[to]];
            *by_station += (double)(empty_us - from_us);
            measure->places[stay->place].blamed = by_station;
            from_us = empty_us;
        }
    }
    double *by_robot =
        &measure->figures->blocked_by_robot[(size_t)stay->station * robots + (size_t)stay->robot];
    *by_robot += (double)(stay->end_us - from_us);
    if (from_us < stay->end_us) {
        measure->places[stay->place].blamed = by_robot;
    }
}

/* ------------------------------------------------------------------------------------------------- events */

static void hear_stay(measure_t *measure, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    account_wafer(measure, state, event->wafer, event->end_us);
    if (event->step > 0) {
        blame(measure, state, event);
    }
    if (event->step > 0 && !state->tool->stations[event->station].is_real) {
        wh_flow_stays_add(&measure->figures->stays, state, event);
    }
    wh_flow_history_take(&measure->history, state, event);
}

static void hear_placing(measure_t *measure, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    const int32_t wafer = event->kind == WH_FLOW_EVENT_SWAP ? event->other : event->wafer;
    if (event->kind == WH_FLOW_EVENT_PLACE) {
        go_to(measure, state, event->place, event->begin_us,
              measure->places[event->place].is_over ? WH_FLOW_STATION_STORED : WH_FLOW_STATION_EMPTY);
    }
    go_to(measure, state, event->place, event->end_us, WH_FLOW_STATION_HANDLED);
    const int32_t step = state->wafers[wafer].toward;
    measure->places[event->place].is_over =
        wh_flow_following(state, wafer, step, event->place) == WH_FLOW_NONE;
    if (step > state->wafers[wafer].step + 1) {
        measure->figures->fates[wafer] = WH_FLOW_FATE_SHORTENED;
    }
    ++measure->figures->placed[event->station];
    wh_flow_history_place(&measure->history, state, event, wafer, measure->places[event->place].is_over);
}

/* A route ends where its wafer lies, lost or shortened. */
static void hear_end(measure_t *measure, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    const bool is_lost = state->wafers[event->wafer].is_lost;
    account_wafer(measure, state, event->wafer, event->end_us);
    measure->places[event->place].is_over = true;
    measure->figures->fates[event->wafer] = is_lost ? WH_FLOW_FATE_LOST : WH_FLOW_FATE_SHORTENED;
    if (!is_lost) {
        wh_flow_history_shorten(&measure->history, event->wafer);
    }
}

static uint64_t hash_event(uint64_t hash, const wh_flow_event_t *event) {
    const int64_t numbers[] = {(int64_t)event->kind, event->begin_us, event->end_us, event->robot,
                               event->wafer,         event->other,    event->place,  event->station};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        hash = wh_hash_word(hash, (uint64_t)numbers[i]);
    }
    return hash;
}

static void hear(void *context, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    measure_t *measure = context;
    measure->figures->hash = hash_event(measure->figures->hash, event);
    if (event->kind == WH_FLOW_EVENT_ENDS) {
        hear_end(measure, state, event);
        return;
    }
    if (event->kind == WH_FLOW_EVENT_STAY) {
        hear_stay(measure, state, event);
    } else if (event->kind == WH_FLOW_EVENT_LEFT) {
        wh_flow_stays_add(&measure->figures->stays, state, event);
    } else if (event->kind == WH_FLOW_EVENT_PICK) {
        go_to(measure, state, event->place, event->end_us, WH_FLOW_STATION_HANDLED);
    } else if (event->kind == WH_FLOW_EVENT_PLACE || event->kind == WH_FLOW_EVENT_SWAP) {
        hear_placing(measure, state, event);
    }
    if (measure->keeps != WH_FLOW_SUMS) {
        wh_flow_log_add(&measure->log, event);
    }
    if (measure->history.open) {
        wh_flow_history_hear(&measure->history, event);
    }
}

/* One of them at a time: a clean before a pump, a pump before a failure. */
static void add_aside(aside_t *aside, const wh_flow_station_state_t *station, bool is_cleaning, int64_t us) {
    if (is_cleaning) {
        aside->clean_us += us;
    } else if (station->pump_us != WH_FLOW_NEVER) {
        aside->pump_us += us;
    } else if (station->down_us != WH_FLOW_NEVER) {
        aside->down_us += us;
    }
}

/* Until when a process or a blade has the place in the time from now on; before now: neither has. */
static int64_t taken_until_us(const wh_flow_state_t *state, int32_t number, int64_t to_us) {
    const int32_t station = state->tool->place_stations[number], wafer = state->places[number].wafer;
    const int32_t user = state->stations[station].user;
    const bool is_in = user != WH_FLOW_NONE && state->robots[user].action != WH_FLOW_OPENING &&
                       (state->robots[user].from == number || state->robots[user].to == number);
    if (is_in) {
        return to_us;
    }
    return wafer != WH_FLOW_NONE && !state->wafers[wafer].is_over && state->wafers[wafer].step > 0
               ? state->wafers[wafer].done_us
               : -1;
}

/* Time in which the station was cleaned, pumped or had failed. */
static void account_aside(measure_t *measure, const wh_flow_state_t *state, int32_t number, int64_t to_us) {
    const wh_flow_station_state_t *station = &state->stations[number];
    const wh_flow_station_t *of = &state->tool->stations[number];
    const int64_t us = to_us - state->now_us;
    for (int32_t p = of->first_place; p < of->first_place + of->slots; ++p) {
        const int64_t taken_us = taken_until_us(state, p, to_us) - state->now_us;
        const int64_t left_us = taken_us <= 0 ? us : taken_us < us ? us - taken_us : 0;
        add_aside(&measure->asides[p], station, state->places[p].clean_us != WH_FLOW_NEVER, left_us);
    }
}

static void advance(void *context, const wh_flow_state_t *state, int64_t to_us) {
    measure_t *measure = context;
    const int64_t us = to_us - state->now_us;
    const int32_t robots = (int32_t)state->tool->robot_count;
    for (int32_t r = 0; r < robots; ++r) {
        measure->figures->robots[r][wh_flow_robot_class(state, r)] += (double)us;
    }
    for (size_t k = 0; k < state->ahead.aside_count; ++k) {
        account_aside(measure, state, state->ahead.aside[k], to_us);
    }
}

/* A stay is counted up to the pick when its door begins to open. The flow may end before that. */
static void take_back(measure_t *measure, const wh_flow_state_t *state, int32_t number) {
    place_t *place = &measure->places[number];
    const int32_t wafer = state->places[number].wafer, station = state->tool->place_stations[number];
    const int64_t ahead_us = place->since_us - state->now_us;
    if (ahead_us <= 0 || wafer == WH_FLOW_NONE) {
        return;
    }
    if (state->wafers[wafer].step > 0) {
        add(measure, station, WH_FLOW_STATION_BLOCKED, -ahead_us);
        *place->blamed -= (double)ahead_us;
    } else {
        add(measure, station, WH_FLOW_STATION_STORED, -ahead_us);
    }
    place->since_us = state->now_us;
}

/* Those that are lost on an arm are told at last. */
static void keep_fate(wh_flow_figures_t *figures, const wh_flow_state_t *state, int32_t wafer) {
    wh_flow_fate_t *fate = &figures->fates[wafer];
    if (state->plan->wafers[wafer].is_skipped) {
        *fate = WH_FLOW_FATE_SKIPPED;
    } else if (state->wafers[wafer].is_lost) {
        *fate = WH_FLOW_FATE_LOST;
    } else if (!state->wafers[wafer].is_over) {
        *fate = WH_FLOW_FATE_INSIDE;
    } else if (*fate == WH_FLOW_FATE_INSIDE) {
        *fate = WH_FLOW_FATE_END;
    }
}

/* Keeps how each wafer's route ended, and how long it has stayed. */
static void end_wafers(measure_t *measure, const wh_flow_state_t *state) {
    wh_flow_event_t stay;
    for (int32_t w = 0; w < (int32_t)state->plan->wafer_count; ++w) {
        if (wh_flow_open_stay(state, w, &stay) && !state->tool->stations[stay.station].is_real) {
            wh_flow_stays_add(&measure->figures->stays, state, &stay);
        }
        keep_fate(measure->figures, state, w);
    }
}

static void end(void *context, const wh_flow_state_t *state) {
    measure_t *measure = context;
    end_wafers(measure, state);
    for (size_t p = 0; p < state->tool->place_count; ++p) {
        const int32_t wafer = state->places[p].wafer;
        take_back(measure, state, (int32_t)p);
        if (wafer != WH_FLOW_NONE && !state->wafers[wafer].is_over) {
            account_wafer(measure, state, wafer, state->now_us);
        } else {
            go_to(measure, state, (int32_t)p, state->now_us,
                  measure->places[p].is_over ? WH_FLOW_STATION_STORED : WH_FLOW_STATION_EMPTY);
        }
    }
    wh_flow_history_end(&measure->history, state);
    measure->figures->end_us = state->now_us;
}

/* -------------------------------------------------------------------------------------------------- whole */

static void open_figures(wh_flow_figures_t *figures, const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    const size_t robots = tool->robot_count, stations = tool->station_count;
    *figures = (wh_flow_figures_t){
        .tool = tool,
        .plan = plan,
        .hash = WH_HASH_START,
        .robots = wh_array_new(robots, sizeof *figures->robots),
        .stations = wh_array_new(stations, sizeof *figures->stations),
        .blocked_by_robot = wh_array_new(stations * robots, sizeof *figures->blocked_by_robot),
        .blocked_by_station = wh_array_new(stations * stations, sizeof *figures->blocked_by_station),
        .placed = wh_array_new(stations, sizeof *figures->placed),
        .fates = wh_array_new(plan->wafer_count, sizeof *figures->fates),
    };
    wh_flow_stays_open(&figures->stays, tool);
}

wh_flow_measure_t *wh_flow_measure_open(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan,
                                        wh_flow_keep_t keeps, const wh_flow_outside_t *outside,
                                        wh_flow_figures_t *figures) {
    measure_t *measure = wh_array_new(1, sizeof *measure);
    *measure = (measure_t){.figures = figures,
                           .keeps = keeps,
                           .places = wh_array_new(tool->place_count, sizeof *measure->places),
                           .asides = wh_array_new(tool->place_count, sizeof *measure->asides)};
    open_figures(figures, tool, plan);
    if (keeps == WH_FLOW_VISITS || keeps == WH_FLOW_WAYS) {
        wh_flow_history_open(&measure->history, figures, plan->wafer_count, keeps == WH_FLOW_WAYS);
    }
    const wh_flow_listener_t listener = {measure, hear, advance, end};
    wh_flow_engine_open(&measure->engine, tool, plan, &listener, outside);
    return measure;
}

wh_flow_engine_t *wh_flow_measure_engine(wh_flow_measure_t *measure) {
    return &measure->engine;
}

void wh_flow_measure_close(wh_flow_measure_t *measure) {
    wh_flow_figures_t *figures = measure->figures;
    if (measure->engine.is_over) {
        wh_flow_engine_result(&measure->engine, &figures->result);
        figures->parts = wh_flow_path(figures->tool, figures->plan, &measure->log, &figures->part_count);
    }
    wh_flow_engine_close(&measure->engine);
    free(measure->log.events);
    free(measure->places);
    free(measure->asides);
    wh_flow_history_close(&measure->history);
    free(measure);
}

void wh_flow_measure(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, wh_flow_keep_t keeps,
                     wh_flow_figures_t *figures) {
    measure_t *measure = wh_flow_measure_open(tool, plan, keeps, NULL, figures);
    for (int64_t next_us = 0; !measure->engine.is_over;) {
        next_us = wh_flow_engine_step(&measure->engine, next_us);
    }
    wh_flow_measure_close(measure);
}

void wh_flow_figures_close(wh_flow_figures_t *figures) {
    free(figures->robots);
    free(figures->stations);
    free(figures->blocked_by_robot);
    free(figures->blocked_by_station);
    free(figures->placed);
    free(figures->fates);
    wh_flow_stays_close(&figures->stays);
    free(figures->parts);
    free(figures->gains);
    free(figures->visits);
    free(figures->doings);
    free(figures->ways.items);
    free(figures->running.items);
    free(figures->came_us);
    wh_flow_result_close(&figures->result);
    memset(figures, 0, sizeof *figures);
}

void wh_flow_close(wh_flow_t *flow) {
    wh_flow_plan_close(&flow->plan, flow->tool);
    wh_flow_figures_close(&flow->figures);
}

bool wh_flow_has_moved(const wh_flow_t *flow) {
    size_t placed = 0;
    for (size_t s = 0; flow->figures.tool && s < flow->figures.tool->station_count; ++s) {
        placed += flow->figures.placed[s];
    }
    return placed > 0;
}

bool wh_flow_is_cut(const wh_flow_t *flow) {
    return flow->figures.tool && flow->figures.result.end == WH_FLOW_CUT;
}
