#include "history.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

void wh_flow_history_open(wh_flow_history_t *history, wh_flow_figures_t *figures, size_t wafers,
                          bool keeps_ways) {
    *history = (wh_flow_history_t){.figures = figures, .keeps_ways = keeps_ways};
    history->visits = wh_array_new(wafers, sizeof *history->visits);
    figures->came_us = wh_array_new(wafers, sizeof *figures->came_us);
    for (size_t w = 0; w < wafers; ++w) {
        figures->came_us[w] = WH_FLOW_NEVER;
    }
    history->open = wh_array_new(wafers, sizeof *history->open);
    memset(history->visits, 0xff, wafers * sizeof *history->visits);
}

void wh_flow_history_close(wh_flow_history_t *history) {
    free(history->visits);
    free(history->open);
    *history = (wh_flow_history_t){0};
}

/* ------------------------------------------------------------------------------------------------- visits */

/* A lot may arrive before its port is free; its wafers come when it is. */
static void note_coming(wh_flow_figures_t *figures, const wh_flow_state_t *state, int32_t wafer) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    if (at->step == 0 && at->place != WH_FLOW_NONE) {
        figures->came_us[wafer] = at->entered_us;
    }
}

void wh_flow_history_take(wh_flow_history_t *history, const wh_flow_state_t *state,
                          const wh_flow_event_t *stay) {
    if (!history->open) {
        return;
    }
    note_coming(history->figures, state, stay->wafer);
    history->open[stay->wafer] = (wh_flow_visit_t){.wafer = stay->wafer,
                                                   .step = stay->step + 1,
                                                   .robot = stay->robot,
                                                   .from = stay->place,
                                                   .place = WH_FLOW_NONE,
                                                   .pick_us = stay->end_us,
                                                   .picked_us = WH_FLOW_NEVER,
                                                   .place_us = WH_FLOW_NEVER,
                                                   .placed_us = WH_FLOW_NEVER,
                                                   .process_us = WH_FLOW_NEVER,
                                                   .done_us = WH_FLOW_NEVER};
}

static void keep_visit(wh_flow_history_t *history, int32_t wafer) {
    wh_flow_figures_t *figures = history->figures;
    figures->visits = wh_array_grow(figures->visits, figures->visit_count, &figures->visit_capacity,
                                    sizeof *figures->visits);
    history->visits[wafer] = (int32_t)figures->visit_count;
    figures->visits[figures->visit_count++] = history->open[wafer];
}

void wh_flow_history_place(wh_flow_history_t *history, const wh_flow_state_t *state,
                           const wh_flow_event_t *event, int32_t wafer, bool is_end) {
    if (!history->open) {
        return;
    }
    wh_flow_visit_t *visit = &history->open[wafer];
    visit->step = state->wafers[wafer].toward;
    visit->is_end = is_end;
    visit->place = event->place;
    visit->arm = event->arm;
    visit->place_us = event->begin_us;
    visit->placed_us = event->end_us;
    keep_visit(history, wafer);
    if (event->kind == WH_FLOW_EVENT_SWAP) {
        history->open[event->wafer].picked_us = event->end_us;
    }
}

void wh_flow_history_shorten(wh_flow_history_t *history, int32_t wafer) {
    if (history->open && history->visits[wafer] != WH_FLOW_NONE) {
        history->figures->visits[history->visits[wafer]].is_end = true;
    }
}

/* ------------------------------------------------------------------------------------------------- events */

static void note_process(wh_flow_history_t *history, const wh_flow_event_t *event) {
    if (history->visits[event->wafer] != WH_FLOW_NONE) {
        wh_flow_visit_t *visit = &history->figures->visits[history->visits[event->wafer]];
        visit->process_us = event->begin_us;
        visit->done_us = event->end_us;
    }
}

static void note_doing(wh_flow_figures_t *figures, const wh_flow_event_t *event) {
    figures->doings = wh_array_grow(figures->doings, figures->doing_count, &figures->doing_capacity,
                                    sizeof *figures->doings);
    figures->doings[figures->doing_count++] = (wh_flow_doing_t){
        event->kind, event->station, event->place, event->robot, event->side, event->begin_us, event->end_us};
}

static void note_way(wh_flow_history_t *history, const wh_flow_event_t *event) {
    wh_flow_ways_t *ways = &history->figures->ways;
    if (history->keeps_ways && event->end_us > event->begin_us && event->from != WH_FLOW_NONE) {
        ways->items = wh_array_grow(ways->items, ways->count, &ways->capacity, sizeof *ways->items);
        ways->items[ways->count++] =
            (wh_flow_way_t){event->robot, event->from, event->station, event->begin_us, event->end_us};
    }
}

/* Timed ones open and shut in the times of the tool. */
static bool is_real_door(const wh_flow_tool_t *tool, const wh_flow_event_t *event) {
    return event->kind == WH_FLOW_EVENT_SHUT ||
           (event->kind == WH_FLOW_EVENT_OPEN &&
            tool->doors[wh_flow_of(tool, event->robot, event->station)].is_real);
}

/* True if a station, or a real door, did it. */
static bool is_doing(const wh_flow_tool_t *tool, const wh_flow_event_t *event) {
    return event->kind == WH_FLOW_EVENT_CLEAN || event->kind == WH_FLOW_EVENT_PUMP ||
           event->kind == WH_FLOW_EVENT_DOWN || event->kind == WH_FLOW_EVENT_COMES ||
           event->kind == WH_FLOW_EVENT_GOES || is_real_door(tool, event);
}

void wh_flow_history_hear(wh_flow_history_t *history, const wh_flow_event_t *event) {
    if (!history->open) {
        return;
    }
    if (event->kind == WH_FLOW_EVENT_PICK) {
        history->open[event->wafer].picked_us = event->end_us;
    } else if (event->kind == WH_FLOW_EVENT_PROCESS) {
        note_process(history, event);
    } else if (event->kind == WH_FLOW_EVENT_MOVE) {
        note_way(history, event);
    } else if (is_doing(history->figures->tool, event)) {
        note_doing(history->figures, event);
    }
}

/* ------------------------------------------------------------------------------------------------- ending */

/* A real door opens for the robot that takes the wafer. */
static bool is_real_door_opening(const wh_flow_state_t *state, const wh_flow_wafer_state_t *wafer) {
    const wh_flow_robot_state_t *robot = &state->robots[wafer->taker];
    return robot->action == WH_FLOW_OPENING &&
           state->tool->doors[wh_flow_of(state->tool, wafer->taker, robot->station)].is_real;
}

/* Those of wafers that are under way when the flow ends; a door that opens is no visit yet. */
static void keep_open_visits(wh_flow_history_t *history, const wh_flow_state_t *state) {
    for (int32_t w = 0; w < (int32_t)state->plan->wafer_count; ++w) {
        const wh_flow_wafer_state_t *wafer = &state->wafers[w];
        note_coming(history->figures, state, w);
        const bool is_taken = wafer->taker != WH_FLOW_NONE && history->open[w].pick_us <= state->now_us;
        if (is_taken && !(wafer->robot == WH_FLOW_NONE && is_real_door_opening(state, wafer))) {
            history->open[w].step = wafer->toward != WH_FLOW_NONE ? wafer->toward : wafer->step + 1;
            history->open[w].arm =
                wafer->robot != WH_FLOW_NONE ? wafer->arm : state->robots[wafer->taker].arm;
            keep_visit(history, w);
        }
    }
}

static void keep_running(wh_flow_runnings_t *running, int32_t place, int32_t wafer, int64_t begin_us) {
    running->items =
        wh_array_grow(running->items, running->count, &running->capacity, sizeof *running->items);
    running->items[running->count++] = (wh_flow_running_t){place, wafer, begin_us};
}

/* Keeps what goes on in the place: nobody tells its end. */
static void note_running(wh_flow_figures_t *figures, const wh_flow_state_t *state, int32_t number) {
    const wh_flow_place_t *place = &state->places[number];
    const wh_flow_station_t *of = &state->tool->stations[state->tool->place_stations[number]];
    const int32_t wafer = place->wafer;
    if (of->is_real) {
        return;
    }
    if (place->clean_us != WH_FLOW_NEVER) {
        keep_running(&figures->running, number, WH_FLOW_NONE, place->clean_us - of->clean_us);
    }
    if (wafer == WH_FLOW_NONE || state->wafers[wafer].is_over ||
        state->wafers[wafer].done_us <= state->now_us) {
        return;
    }
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const int64_t processed_us = at->done_us - at->clean_us;
    if (at->process_us > 0 && processed_us - at->process_us <= state->now_us) {
        keep_running(&figures->running, number, wafer, processed_us - at->process_us);
    }
}

void wh_flow_history_end(wh_flow_history_t *history, const wh_flow_state_t *state) {
    if (!history->open) {
        return;
    }
    keep_open_visits(history, state);
    for (size_t p = 0; p < state->tool->place_count; ++p) {
        note_running(history->figures, state, (int32_t)p);
    }
}
