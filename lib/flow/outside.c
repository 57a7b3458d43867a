#include "outside.h"

#include <math.h>

#include "calls.h"
#include "held.h"
#include "transfer.h"

/* --------------------------------------------------------------------------------------- between instants */

void wh_flow_tell_end(wh_flow_state_t *state, int32_t robot) {
    state->robots[robot].is_ended = true;
}

void wh_flow_tell_shut(wh_flow_state_t *state, int32_t station) {
    state->stations[station].real.has_shut = true;
}

void wh_flow_tell_worked(wh_flow_state_t *state, int32_t station) {
    state->stations[station].real.has_worked = true;
}

/* ---------------------------------------------------------------------------------------------- estimates */

/* Either way round, as far as nobody has gone the other one. */
static void learn_move(wh_flow_tool_t *tool, int32_t robot, int32_t from, int32_t to, int64_t us) {
    if (from == WH_FLOW_NONE || from == to) {
        return;
    }
    int64_t *const there = &tool->move_us[wh_flow_of(tool, robot, from) * tool->station_count + (size_t)to];
    int64_t *const back = &tool->move_us[wh_flow_of(tool, robot, to) * tool->station_count + (size_t)from];
    *there = us;
    *back = *back == 0 ? us : *back;
}

bool wh_flow_is_played(const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    return state->tool->robots[robot].is_real ||
           (at->action == WH_FLOW_OPENING &&
            state->tool->doors[wh_flow_of(state->tool, robot, at->station)].is_real);
}

void wh_flow_learn(wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    if (!state->outside || !wh_flow_is_played(state, robot)) {
        return;
    }
    wh_flow_tool_t *tool = state->outside->tool;
    const size_t of = wh_flow_of(tool, robot, at->station);
    const int64_t us = state->now_us - at->since_us - wh_flow_stood_us(state, robot);
    int64_t *const time_us = at->action == WH_FLOW_OPENING   ? &tool->doors[of].open_us
                             : at->action == WH_FLOW_PICKING ? &tool->pick_us[of]
                             : at->action == WH_FLOW_PLACING ? &tool->place_us[of]
                             : at->action == WH_FLOW_SWAPS   ? &tool->swap_us[of]
                                                             : NULL;
    if (time_us) {
        *time_us = us;
    } else {
        learn_move(tool, robot, at->from, at->station, us);
    }
}

static void end_shutting(wh_flow_state_t *state, int32_t number) {
    wh_flow_station_state_t *station = &state->stations[number];
    const bool is_seen = station->real.closed_us >= station->real.shutting_us;
    const int64_t end_us = is_seen ? station->real.closed_us : state->now_us;
    wh_flow_event_t shut =
        wh_flow_event_of_station(WH_FLOW_EVENT_SHUT, number, station->real.shutting_us, end_us);
    shut.robot = station->real.shutter;
    station->real.is_shutting = station->real.has_shut = false;
    if (station->real.shutter != WH_FLOW_NONE) {
        wh_flow_tool_t *tool = state->outside->tool;
        tool->doors[wh_flow_of(tool, station->real.shutter, number)].close_us =
            end_us - station->real.shutting_us;
    }
    wh_flow_tell(state, &shut);
}

/* An ALIGN or a FLIP is the process of its station. */
static void end_work(wh_flow_state_t *state, int32_t number) {
    wh_flow_station_state_t *station = &state->stations[number];
    const int32_t wafer = station->real.work_wafer;
    station->real.work_wafer = WH_FLOW_NONE;
    station->real.has_worked = false;
    state->wafers[wafer].done_us = state->now_us;
    state->outside->tool->stations[number].process_us = state->now_us - station->real.work_us;
    wh_flow_tell_process(state, wafer, station->real.work_us, state->now_us);
}

void wh_flow_end_told(wh_flow_state_t *state) {
    for (int32_t i = 0; i < (int32_t)state->tool->station_count; ++i) {
        wh_flow_station_state_t *station = &state->stations[i];
        if (station->real.has_shut) {
            end_shutting(state, i);
        }
        if (station->real.has_worked) {
            end_work(state, i);
        } else if (station->real.work_wafer != WH_FLOW_NONE) {
            const int64_t done_us = station->real.work_us + state->tool->stations[i].process_us;
            state->wafers[station->real.work_wafer].done_us =
                done_us > state->now_us ? done_us : state->now_us + 1;
        }
        if (station->user != WH_FLOW_NONE && station->busy_us <= state->now_us) {
            station->busy_us = state->now_us + 1;
        }
    }
}

static void await_process(wh_flow_state_t *state, int32_t wafer, int64_t process_us) {
    state->wafers[wafer].process_us = process_us;
    state->wafers[wafer].clean_us = 0;
    state->wafers[wafer].done_us = WH_FLOW_NEVER;
}

static void begin_work(wh_flow_state_t *state, int32_t wafer, int32_t number) {
    const int64_t process_us = state->tool->stations[number].process_us;
    await_process(state, wafer, process_us);
    state->stations[number].real.work_wafer = wafer;
    state->stations[number].real.work_us = state->now_us;
    state->wafers[wafer].done_us = state->now_us + (process_us > 0 ? process_us : 1);
}

bool wh_flow_begin_real(wh_flow_state_t *state, int32_t wafer, int32_t station) {
    const bool works =
        wh_flow_step_of(state->plan, wafer, state->wafers[wafer].step)->work != WH_FLOW_WORK_NONE;
    if (state->tool->stations[station].is_real) {
        await_process(state, wafer, wh_flow_process_us(state, wafer, station));
    } else if (works) {
        begin_work(state, wafer, station);
    }
    return works || state->tool->stations[station].is_real;
}

bool wh_flow_pump_real(wh_flow_state_t *state, int32_t station, wh_flow_side_t side) {
    const bool is_real = state->tool->stations[station].is_real;
    const bool pumps = !is_real || state->outside->pump(state->outside->context, station, side);
    state->stations[station].real.runs = state->stations[station].real.runs || (is_real && pumps);
    return pumps;
}

void wh_flow_set_down(const wh_flow_state_t *state, int32_t station, bool is_down) {
    if (state->tool->stations[station].is_real) {
        state->outside->down(state->outside->context, station, is_down);
    }
}

/* True if a carrier is still to call at the station. */
static bool is_to_come(const wh_flow_state_t *state, int32_t station) {
    bool is_any = false;
    for (size_t i = 0; i < state->plan->call_count; ++i) {
        is_any = is_any || (state->plan->calls[i].station == station &&
                            state->calls.of[i].phase == WH_FLOW_CALL_AWAITED);
    }
    return is_any;
}

/* True if a lot of this call is not over. */
static bool has_open_lot(const wh_flow_state_t *state, int32_t call) {
    bool has_any = false;
    for (size_t i = 0; i < state->plan->lot_count; ++i) {
        has_any = has_any || (state->plan->lots[i].call == call && !wh_flow_is_lot_over(state, (int32_t)i));
    }
    return has_any;
}

bool wh_flow_is_port_needed(const wh_flow_state_t *state, int32_t station) {
    const int32_t call = state->stations[station].call;
    return (call > 0 && has_open_lot(state, call)) ||
           ((call > 0 || !is_to_come(state, station)) && wh_flow_is_awaited(state, station));
}

/* A carrier comes or goes, or somebody is to open the port. */
static bool is_port_busy(const wh_flow_state_t *state, int32_t station) {
    const int32_t call = state->stations[station].call;
    if (!state->tool->stations[station].is_real_port) {
        return false;
    }
    return (call > 0 && (state->calls.of[call - 1].phase == WH_FLOW_CALL_COMING ||
                         state->calls.of[call - 1].phase == WH_FLOW_CALL_GOING)) ||
           (state->stations[station].real.is_port_shut && wh_flow_is_port_needed(state, station));
}

void wh_flow_tell_call(wh_flow_state_t *state, int32_t station) {
    const int32_t call = state->stations[station].call;
    if (call > 0) {
        state->calls.of[call - 1].is_told = true;
    }
}

void wh_flow_see_port(wh_flow_state_t *state, int32_t station, bool is_open, bool has_carrier, bool runs) {
    state->stations[station].real.is_port_shut = !is_open;
    state->stations[station].real.has_carrier = has_carrier;
    state->stations[station].real.runs = runs;
}

bool wh_flow_is_real_busy(const wh_flow_state_t *state) {
    bool is_busy = wh_flow_is_any_asked(state);
    for (size_t i = 0; i < state->tool->station_count; ++i) {
        const wh_flow_station_state_t *station = &state->stations[i];
        is_busy = is_busy || is_port_busy(state, (int32_t)i) || station->real.runs ||
                  station->real.is_shutting || station->real.work_wafer != WH_FLOW_NONE;
    }
    for (size_t r = 0; r < state->tool->robot_count; ++r) {
        const wh_flow_action_t action = state->robots[r].action;
        is_busy = is_busy || (wh_flow_is_played(state, (int32_t)r) && action != WH_FLOW_IDLE &&
                              action != WH_FLOW_WAITING);
    }
    return is_busy;
}

/* ------------------------------------------------------------------------------------------------ looking */

void wh_flow_tell_process(wh_flow_state_t *state, int32_t wafer, int64_t begin_us, int64_t end_us) {
    wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const int32_t station = wh_flow_station_of(state, wafer);
    wh_flow_event_t ended = wh_flow_event_of_station(WH_FLOW_EVENT_PROCESS, station, begin_us, end_us);
    ended.wafer = wafer;
    ended.place = at->place;
    ended.step = at->step;
    at->process_us = end_us - begin_us;
    wh_flow_tell(state, &ended);
}

void wh_flow_tell_clean(wh_flow_state_t *state, int32_t place, int32_t wafer, int64_t begin_us,
                        int64_t end_us) {
    wh_flow_event_t ended =
        wh_flow_event_of_station(WH_FLOW_EVENT_CLEAN, state->tool->place_stations[place], begin_us, end_us);
    ended.wafer = wafer;
    ended.place = place;
    wh_flow_tell(state, &ended);
}

void wh_flow_tell_pump(wh_flow_state_t *state, int32_t station, int64_t begin_us, int64_t end_us) {
    wh_flow_event_t ended = wh_flow_event_of_station(WH_FLOW_EVENT_PUMP, station, begin_us, end_us);
    ended.side = state->stations[station].side;
    wh_flow_tell(state, &ended);
}

void wh_flow_tell_closed(wh_flow_state_t *state, int32_t station, int64_t at_us) {
    state->stations[station].real.closed_us = at_us;
}

void wh_flow_tell_left(wh_flow_state_t *state, int32_t wafer, int64_t done_us, int64_t lifted_us) {
    const int32_t station = wh_flow_station_of(state, wafer), robot = state->wafers[wafer].taker;
    if (station == WH_FLOW_NONE || state->wafers[wafer].is_over) {
        return;
    }
    const int64_t free_us =
        done_us + state->wafers[wafer].clean_us; /* a stay begins with a clean around it */
    wh_flow_event_t left = wh_flow_event_of_station(WH_FLOW_EVENT_LEFT, station, free_us, lifted_us);
    left.robot = robot;
    left.wafer = wafer;
    left.place = state->wafers[wafer].place;
    left.step = state->wafers[wafer].step;
    wh_flow_tell(state, &left);
    const int64_t over_us = wh_flow_over_window_us(state, &left);
    if (over_us > 0) {
        const wh_flow_problem_t late = {WH_FLOW_LATE, robot, wafer, station, over_us};
        wh_flow_tell_problem(state, &late);
    }
}

/* Something that runs has more than nothing left. */
static int64_t ends_us(const wh_flow_state_t *state, double left_us) {
    return state->now_us + (left_us > 1 ? (int64_t)ceil(left_us) : 1);
}

/* A wafer around which its place was cleaned is done at the end of that. */
static void see_wafer(wh_flow_state_t *state, int32_t wafer, const wh_flow_station_t *of,
                      const wh_clock_place_t *clock, int64_t began_us) {
    wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const bool was_cleaned = of->cleans_full && clock->since_clean < 0;
    if (clock->is_away || clock->wafer == WH_FLOW_NONE) {
        return; /* a blade has it */
    }
    if (clock->phase != WH_CLOCK_DONE) {
        const int64_t clock_us = state->now_us + began_us;
        at->clean_us = clock->phase == WH_CLOCK_CLEANING ? of->clean_us : at->clean_us;
        at->done_us = ends_us(state, wh_clock_left_us(of, clock, clock_us));
    } else if (was_cleaned) {
        at->done_us = clock->empty_us - began_us;
        at->clean_us = clock->empty_us - clock->done_us;
    } else {
        at->done_us = clock->done_us - began_us;
    }
}

static int64_t sooner(int64_t a_us, int64_t b_us) {
    return a_us < b_us ? a_us : b_us;
}

static void see_place(wh_flow_state_t *state, int32_t number, const wh_flow_station_t *of,
                      const wh_clock_place_t *clock, int64_t began_us) {
    const int64_t clock_us = state->now_us + began_us;
    wh_flow_place_t *place = &state->places[number];
    wh_flow_station_state_t *station = &state->stations[state->tool->place_stations[number]];
    const bool is_cleaning = clock->phase == WH_CLOCK_CLEANING;
    place->since_clean = clock->since_clean;
    place->is_clean_due = wh_clock_is_clean_due(of, clock, clock_us);
    place->clean_us = is_cleaning && !clock->is_around ? ends_us(state, clock->left_us) : WH_FLOW_NEVER;
    station->clean_us = sooner(place->clean_us, station->clean_us);
    station->has_due = station->has_due || place->is_clean_due;
    station->real.runs = station->real.runs || is_cleaning || clock->phase == WH_CLOCK_PROCESSING;
    if (place->wafer != WH_FLOW_NONE && !state->wafers[place->wafer].is_over) {
        see_wafer(state, place->wafer, of, clock, began_us);
        const int64_t done_us = state->wafers[place->wafer].done_us;
        station->done_us = done_us > state->now_us ? sooner(done_us, station->done_us) : station->done_us;
    }
}

void wh_flow_see_station(wh_flow_state_t *state, int32_t number, const wh_flow_station_t *of,
                         const wh_clock_t *clock, const wh_clock_place_t places[], int64_t began_us) {
    wh_flow_station_state_t *station = &state->stations[number];
    const int32_t first = state->tool->stations[number].first_place;
    station->real.runs = clock->is_pumping;
    station->side = clock->side;
    station->pump_us = clock->is_pumping ? ends_us(state, clock->left_us) : WH_FLOW_NEVER;
    station->pump_to = clock->pump_to;
    station->done_us = station->clean_us = WH_FLOW_NEVER;
    station->has_due = false;
    for (int32_t i = 0; i < of->slots; ++i) {
        see_place(state, first + i, of, &places[i], began_us);
    }
}
