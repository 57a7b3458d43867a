/* The log of a flow, held against what no tool can break. It knows the descriptions of tool and plan, and what the
 * engine tells when something has ended; it shares no code with lib/flow. The first violation is kept as a text. */
#ifndef TESTS_SUPPORT_TOOL_LOG_H
#define TESTS_SUPPORT_TOOL_LOG_H

#include <stdarg.h>

#include "flow/figures.h"
#include "support/flow.h"

#define LOG_WAFERS 64
#define LOG_PLACES 128
#define LOG_STATIONS 24
#define LOG_ROBOTS 4

typedef struct {
    int32_t place, robot, arm, step, from;   /* from: the place out of which it was taken */
    bool is_born, is_over, is_lost, is_gone; /* gone: with the lot that was over, for the next one */
    int64_t placed_us;                       /* its door shut behind it */
    int64_t done_us;                         /* its process has ended; below 0: not yet */
    int64_t free_us;                         /* and the clean around it */
    int64_t stay_us;                         /* somebody begins to take it; below 0: nobody has */
} log_wafer_t;

typedef struct {
    int32_t wafer, since; /* since: wafers since the last clean */
    int64_t left_us;      /* the last blade is out, and the door shut */
    int64_t clean_us;
    bool was_cleaned; /* around its wafer */
} log_place_t;

typedef struct {
    int64_t free_us; /* the last blade is out, the door shut; the last pump has ended */
    wh_flow_side_t side;
    int32_t wafers;
} log_station_t;

typedef struct {
    int32_t at, arms[2];
    int64_t free_us, open_us, opened_us; /* its last door */
    int32_t open_at;
} log_robot_t;

typedef struct {
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    log_wafer_t wafers[LOG_WAFERS];
    log_place_t places[LOG_PLACES];
    log_station_t stations[LOG_STATIONS];
    log_robot_t robots[LOG_ROBOTS];
    int64_t now_us, started_us; /* the last start of a wafer, for takt */
    size_t late, placed;
    size_t
        untold; /* wafers in a clean around them at the end: the end of their process is told with its end */
    bool has_failed, goes_on; /* goes_on: somebody could, at the end */
    char text[400], going[200];
} tool_log_t;

__attribute__((format(printf, 3, 4))) static inline bool log_holds(tool_log_t *log, bool holds,
                                                                   const char *format, ...) {
    if (!holds && !log->has_failed) {
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(log->text, sizeof log->text, format, arguments);
        va_end(arguments);
        log->has_failed = true;
    }
    return holds;
}

static inline void log_open(tool_log_t *log, const flow_case_t *flow) {
    memset(log, 0, sizeof *log);
    log->tool = &flow->tool;
    log->plan = &flow->plan;
    log->started_us = -1;
    assert_true(flow->plan.wafer_count <= LOG_WAFERS && flow->tool.place_count <= LOG_PLACES);
    assert_true(flow->tool.station_count <= LOG_STATIONS && flow->tool.robot_count <= LOG_ROBOTS);
    for (size_t w = 0; w < flow->plan.wafer_count; ++w) {
        log->wafers[w] = (log_wafer_t){.place = -1, .robot = -1, .done_us = -1, .stay_us = -1};
    }
    for (size_t p = 0; p < flow->tool.place_count; ++p) {
        log->places[p].wafer = -1;
    }
    for (size_t s = 0; s < flow->tool.station_count; ++s) {
        log->stations[s].side = flow->tool.stations[s].side;
    }
    for (size_t r = 0; r < flow->tool.robot_count; ++r) {
        log->robots[r] = (log_robot_t){.at = flow->tool.robots[r].at, .arms = {-1, -1}, .open_at = -1};
    }
}

static inline const char *log_wafer_name(const tool_log_t *log, int32_t wafer) {
    return wafer < 0 ? "none" : log->plan->wafers[wafer].name;
}

static inline const char *log_station_name(const tool_log_t *log, int32_t station) {
    return log->tool->stations[station].name;
}

/* ----------------------------------------------------------------------------------------------- the route */

static inline const wh_flow_route_t *log_route(const tool_log_t *log, int32_t wafer) {
    return &log->plan->routes[log->plan->lots[log->plan->wafers[wafer].lot].route];
}

/* The number of its last step: one more where it goes back. */
static inline int32_t log_last(const tool_log_t *log, int32_t wafer) {
    return (int32_t)log_route(log, wafer)->step_count - 1 + (log->plan->wafers[wafer].goes_back ? 1 : 0);
}

/* True if the wafer may lie in the place in this step. */
static inline bool log_fits(const tool_log_t *log, int32_t wafer, int32_t step, int32_t place) {
    const wh_flow_route_t *route = log_route(log, wafer);
    const int32_t back = log->plan->wafers[wafer].back;
    if (step == log_last(log, wafer) && back >= 0) {
        return place == back;
    }
    bool found = false;
    for (size_t i = 0; i < route->steps[step].station_count; ++i) {
        found = found || route->steps[step].stations[i] == log->tool->place_stations[place];
    }
    return found;
}

static inline bool log_failed(const tool_log_t *log, int32_t station, int64_t us) {
    bool failed = false;
    for (size_t i = 0; i < log->plan->down_count; ++i) {
        const wh_flow_down_t *down = &log->plan->downs[i];
        failed = failed || (down->station == station && down->for_us == WH_FLOW_FOR_EVER && down->at_us < us);
    }
    return failed;
}

/* True if none of the step's stations ever works again. */
static inline bool log_step_failed(const tool_log_t *log, int32_t wafer, int32_t step, int64_t us) {
    const wh_flow_route_t *route = log_route(log, wafer);
    if ((size_t)step == route->step_count) {
        return log_failed(log, log->plan->wafers[wafer].back_station, us);
    }
    bool failed = true;
    for (size_t i = 0; i < route->steps[step].station_count; ++i) {
        failed = failed && log_failed(log, route->steps[step].stations[i], us);
    }
    return failed;
}

/* The step behind `step` to which the wafer goes: those that have failed are left out, and one behind them in
 * whose place it lies already. Below 0: its route ends. */
static inline int32_t log_next(const tool_log_t *log, int32_t wafer, int32_t step, int32_t place,
                               int64_t us) {
    bool is_out = false;
    for (int32_t k = step + 1; k <= log_last(log, wafer); ++k) {
        const bool failed = log_step_failed(log, wafer, k, us);
        if (!failed && !(is_out && place >= 0 && log_fits(log, wafer, k, place))) {
            return k;
        }
        is_out = is_out || failed;
    }
    return -1;
}

static inline int64_t log_process_us(const tool_log_t *log, int32_t wafer, int32_t station) {
    const int32_t step = log->wafers[wafer].step;
    const wh_flow_route_t *route = log_route(log, wafer);
    const int64_t own_us = (size_t)step < route->step_count ? route->steps[step].process_us : -1;
    return own_us >= 0 ? own_us : log->tool->stations[station].process_us;
}

/* ---------------------------------------------------------------------------------------------- the places */

/* Nothing begins in a station that is down. */
static inline void log_up(tool_log_t *log, int32_t station, int64_t us, const char *what) {
    for (size_t i = 0; i < log->plan->down_count; ++i) {
        const wh_flow_down_t *down = &log->plan->downs[i];
        const int64_t end_us =
            down->for_us == WH_FLOW_FOR_EVER ? WH_FLOW_FOR_EVER : down->at_us + down->for_us;
        log_holds(log, down->station != station || us < down->at_us || us >= end_us,
                  "%s at %s at %lld us, while it is down", what, log_station_name(log, station),
                  (long long)us);
    }
}

/* It comes into its first place, of which nobody tells: nobody who is not at his end lies there. */
static inline void log_bear(tool_log_t *log, int32_t wafer, int64_t us) {
    const wh_flow_wafer_t *of = &log->plan->wafers[wafer];
    const int32_t other = log->places[of->home].wafer;
    log_holds(log, us >= log->plan->lots[of->lot].arrives_us, "%s before its lot", of->name);
    for (int32_t w = 0; w < (int32_t)log->plan->wafer_count; ++w) {
        const wh_flow_wafer_t *before = &log->plan->wafers[w];
        const bool is_earlier = before->lot < of->lot && before->home == of->home;
        log_holds(log, !is_earlier || log->wafers[w].is_born, "%s where %s still lies", of->name,
                  before->name);
    }
    if (other >= 0) {
        log_holds(log, log->wafers[other].is_over, "%s where %s lies", of->name, log_wafer_name(log, other));
        log->wafers[other].is_gone = true;
        log->wafers[other].place = -1;
        --log->stations[log->tool->place_stations[of->home]].wafers;
    }
    log->wafers[wafer].is_born = true;
    log->wafers[wafer].place = of->home;
    log->wafers[wafer].done_us = log->wafers[wafer].free_us = 0;
    log->places[of->home].wafer = wafer;
    ++log->stations[log->tool->place_stations[of->home]].wafers;
}

/* ---------------------------------------------------------------------------------------------- the robots */

static inline const wh_flow_door_t *log_door(const tool_log_t *log, const wh_flow_event_t *event) {
    return &log->tool->doors[(size_t)event->robot * log->tool->station_count + (size_t)event->station];
}

/* The robot's action takes its time, after the one before. */
static inline void log_act(tool_log_t *log, const wh_flow_event_t *event, int64_t lasts_us,
                           const char *what) {
    log_robot_t *robot = &log->robots[event->robot];
    const char *name = log->tool->robots[event->robot].name;
    log_holds(log, event->begin_us >= robot->free_us, "%s: %s at %lld us, before the last action ends", name,
              what, (long long)event->begin_us);
    log_holds(log, event->end_us - event->begin_us == lasts_us, "%s: %s takes %lld us, not %lld", name, what,
              (long long)(event->end_us - event->begin_us), (long long)lasts_us);
    robot->free_us = event->end_us;
}

static inline void log_move(tool_log_t *log, const wh_flow_event_t *event) {
    log_robot_t *robot = &log->robots[event->robot];
    const size_t of = (size_t)event->robot * log->tool->station_count + (size_t)event->from;
    log_holds(log, event->from == robot->at, "%s goes from %s, and stands elsewhere",
              log->tool->robots[event->robot].name, log_station_name(log, event->from));
    log_act(log, event,
            event->from == event->station
                ? 0
                : log->tool->move_us[of * log->tool->station_count + (size_t)event->station],
            "move");
    robot->at = event->station;
}

static inline void log_opening(tool_log_t *log, const wh_flow_event_t *event) {
    log_robot_t *robot = &log->robots[event->robot];
    log_act(log, event, log_door(log, event)->open_us, "open");
    robot->open_at = event->station;
    robot->open_us = event->begin_us;
    robot->opened_us = event->end_us;
}

/* A blade in a station: the robot stands there and serves it; its pressure; nobody else is in it. Returns the
 * time at which its door begins to open. */
static inline int64_t log_enter(tool_log_t *log, const wh_flow_event_t *event, int64_t lasts_us,
                                const char *what) {
    const size_t of = (size_t)event->robot * log->tool->station_count + (size_t)event->station;
    log_robot_t *robot = &log->robots[event->robot];
    log_station_t *station = &log->stations[event->station];
    const wh_flow_station_t *described = &log->tool->stations[event->station];
    const bool has_door = log_door(log, event)->open_us > 0;
    const int64_t begin_us = has_door ? robot->open_us : event->begin_us;
    log_act(log, event, lasts_us, what);
    log_holds(log, robot->at == event->station && log->tool->place_stations[event->place] == event->station,
              "%s at %s, and the robot stands elsewhere", what, described->name);
    log_holds(log, log->tool->serves[of], "%s at %s by a robot that does not serve it", what,
              described->name);
    log_holds(log, !has_door || (robot->open_at == event->station && robot->opened_us == event->begin_us),
              "%s at %s through a shut door", what, described->name);
    log_holds(log, begin_us >= station->free_us, "two at once in %s at %lld us", described->name,
              (long long)begin_us);
    log_holds(log,
              !described->is_lock || log->tool->sides[of] == WH_FLOW_BOTH ||
                  log->tool->sides[of] == station->side,
              "%s at %s: wrong pressure at %lld us", what, described->name, (long long)begin_us);
    log_up(log, event->station, begin_us, what);
    robot->open_at = -1;
    station->free_us = event->end_us + log_door(log, event)->close_us;
    return begin_us;
}

/* ------------------------------------------------------------------------------------- wafers out and in */

/* It stayed longer than its window, from its process's end to the begin of its pick. */
static inline void log_stay(tool_log_t *log, int32_t wafer, int32_t station, int64_t until_us) {
    const int64_t window_us = log->tool->stations[station].window_us;
    const log_wafer_t *of = &log->wafers[wafer];
    log->late += of->step > 0 && window_us != WH_FLOW_NEVER && until_us - of->done_us > window_us ? 1 : 0;
}

/* It lies there, is done, and its clean around it was done. */
static inline void log_ready(tool_log_t *log, const wh_flow_event_t *event, int64_t begin_us) {
    const log_wafer_t *wafer = &log->wafers[event->wafer];
    const log_place_t *place = &log->places[event->place];
    const char *name = log_wafer_name(log, event->wafer), *where = log_station_name(log, event->station);
    log_holds(log, wafer->place == event->place && place->wafer == event->wafer,
              "%s is taken, and is not in %s", name, where);
    log_holds(log, !wafer->is_over, "%s is taken, and is at its end", name);
    log_holds(log, wafer->done_us >= 0 && begin_us >= wafer->free_us,
              "%s is taken out of %s at %lld us, not done", name, where, (long long)begin_us);
    log_holds(log, wafer->stay_us < 0 || wafer->stay_us == event->begin_us,
              "%s leaves at another time than told", name);
}

/* Wafers since the last clean; one around the wafer has been before it is taken. */
static inline void log_count_clean(tool_log_t *log, const wh_flow_event_t *event) {
    const wh_flow_station_t *described = &log->tool->stations[event->station];
    log_place_t *place = &log->places[event->place];
    const bool is_due =
        described->cleans_full && described->clean_after > 0 && place->since + 1 >= described->clean_after;
    log_holds(log, !is_due || log->wafers[event->wafer].step == 0 || place->was_cleaned,
              "%s is taken out of %s without the clean around it", log_wafer_name(log, event->wafer),
              described->name);
    place->since = is_due ? 0 : place->since + 1;
}

static inline void log_take(tool_log_t *log, const wh_flow_event_t *event, int64_t begin_us, int32_t arm) {
    const int32_t w = event->wafer;
    log_wafer_t *wafer = &log->wafers[w];
    log_place_t *place = &log->places[event->place];
    int32_t *arms = log->robots[event->robot].arms;
    if (!wafer->is_born) {
        log_bear(log, w, begin_us);
    }
    if (wafer->step == 0) {
        log_holds(log, log->started_us < 0 || begin_us - log->started_us >= log->plan->takt_us,
                  "%s starts within the takt", log_wafer_name(log, w));
        log->started_us = begin_us;
    }
    log_ready(log, event, begin_us);
    log_holds(log, arm >= 0 && arm < log->tool->robots[event->robot].arms && arms[arm] < 0,
              "%s is taken with a full arm", log_wafer_name(log, w));
    log_stay(log, w, event->station, event->begin_us);
    log_count_clean(log, event);
    place->wafer = -1;
    place->left_us = event->end_us + log_door(log, event)->close_us;
    --log->stations[event->station].wafers;
    wafer->place = -1;
    wafer->from = event->place;
    wafer->robot = event->robot;
    wafer->arm = arm;
    wafer->stay_us = -1;
    arms[arm] = w;
}

/* The step in which it may come into this place: by what had failed when the placing began, or when it ended. Below
 * 0: there is none. */
static inline int32_t log_step_into(const tool_log_t *log, int32_t w, const wh_flow_event_t *event,
                                    int64_t begin_us) {
    const log_wafer_t *wafer = &log->wafers[w];
    for (int i = 0; i < 4; ++i) {
        const int32_t step =
            log_next(log, w, wafer->step, i % 2 == 0 ? wafer->from : -1, i < 2 ? begin_us : event->end_us);
        if (step > 0 && log_fits(log, w, step, event->place)) {
            return step;
        }
    }
    return -1;
}

static inline void log_put(tool_log_t *log, const wh_flow_event_t *event, int64_t begin_us, int32_t w) {
    log_wafer_t *wafer = &log->wafers[w];
    log_place_t *place = &log->places[event->place];
    const wh_flow_station_t *described = &log->tool->stations[event->station];
    const wh_flow_side_t side =
        log->tool->sides[(size_t)event->robot * log->tool->station_count + (size_t)event->station];
    const wh_flow_side_t slot = log->tool->slot_sides[event->place];
    log_holds(log, wafer->robot == event->robot && wafer->arm == event->arm,
              "%s is placed, and is not aboard", log_wafer_name(log, w));
    log_holds(log, place->wafer < 0, "%s is placed onto %s", log_wafer_name(log, w),
              log_wafer_name(log, place->wafer));
    log_holds(log, slot == WH_FLOW_BOTH || side == WH_FLOW_BOTH || slot == side,
              "%s is placed into a slot of the other side", log_wafer_name(log, w));
    log_holds(log, begin_us >= place->clean_us, "%s is placed into %s during a clean", log_wafer_name(log, w),
              described->name);
    log_holds(log,
              described->cleans_full || described->clean_after == 0 || place->since < described->clean_after,
              "%s is placed into %s without a clean", log_wafer_name(log, w), described->name);
    const int32_t step = log_step_into(log, w, event, begin_us);
    log_holds(log, step > 0, "%s is placed into %s, off its route", log_wafer_name(log, w), described->name);
    log->robots[event->robot].arms[wafer->arm] = -1;
    place->wafer = w;
    place->was_cleaned = false;
    place->left_us = event->end_us + log_door(log, event)->close_us;
    ++log->stations[event->station].wafers;
    wafer->place = event->place;
    wafer->robot = -1;
    wafer->step = step > 0 ? step : wafer->step;
    wafer->placed_us = wafer->free_us = place->left_us;
    wafer->is_over = log_next(log, w, wafer->step, event->place, event->end_us) < 0;
    wafer->done_us = log_process_us(log, w, event->station) > 0 ? -1 : wafer->placed_us;
    ++log->placed;
}

/* ------------------------------------------------------------------------------------- stations by themselves */

static inline void log_process(tool_log_t *log, const wh_flow_event_t *event) {
    log_wafer_t *wafer = &log->wafers[event->wafer];
    log_holds(log, wafer->place == event->place && !wafer->is_over, "%s is processed, and does not lie there",
              log_wafer_name(log, event->wafer));
    log_holds(log, event->end_us - event->begin_us == log_process_us(log, event->wafer, event->station),
              "%s is processed for %lld us", log_wafer_name(log, event->wafer),
              (long long)(event->end_us - event->begin_us));
    log_holds(log,
              event->begin_us >= wafer->placed_us &&
                  (log->plan->down_count > 0 || event->begin_us == wafer->placed_us),
              "%s is processed from %lld us on, placed at %lld", log_wafer_name(log, event->wafer),
              (long long)event->begin_us, (long long)wafer->placed_us);
    if (event->end_us > event->begin_us) {
        log_up(log, event->station, event->begin_us, "a process");
    }
    wafer->done_us = event->end_us;
    wafer->free_us = wafer->free_us > event->end_us ? wafer->free_us : event->end_us;
}

static inline void log_clean(tool_log_t *log, const wh_flow_event_t *event) {
    const wh_flow_station_t *described = &log->tool->stations[event->station];
    log_place_t *place = &log->places[event->place];
    log_holds(log, event->end_us - event->begin_us == described->clean_us, "a clean of %s takes %lld us",
              described->name, (long long)(event->end_us - event->begin_us));
    log_holds(log, event->begin_us >= place->left_us && event->begin_us >= place->clean_us,
              "a clean of %s at %lld us, with a blade or another clean in it", described->name,
              (long long)event->begin_us);
    if (event->wafer < 0) { /* one around a wafer goes on from its process */
        log_up(log, event->station, event->begin_us, "a clean");
    }
    if (event->wafer >= 0) {
        log_holds(log, place->wafer == event->wafer && log->wafers[event->wafer].done_us == event->begin_us,
                  "a clean of %s around %s, which is not done", described->name,
                  log_wafer_name(log, event->wafer));
        log->wafers[event->wafer].free_us = event->end_us;
        place->was_cleaned = true;
    } else {
        log_holds(log, place->wafer < 0, "a clean of %s, where %s lies", described->name,
                  log_wafer_name(log, place->wafer));
        place->since = 0;
    }
    place->clean_us = event->end_us;
}

static inline void log_pump(tool_log_t *log, const wh_flow_event_t *event) {
    const wh_flow_station_t *described = &log->tool->stations[event->station];
    log_station_t *station = &log->stations[event->station];
    const bool is_empty = station->wafers == 0;
    const int64_t lasts_us =
        is_empty ? described->empty_pump_us[event->side] : described->pump_us[event->side];
    log_holds(log, described->is_lock && station->side != event->side, "%s pumps to where it is",
              described->name);
    log_holds(log, event->begin_us >= station->free_us, "%s pumps at %lld us with an open door",
              described->name, (long long)event->begin_us);
    log_holds(log, event->end_us - event->begin_us == lasts_us, "%s pumps for %lld us, not %lld",
              described->name, (long long)(event->end_us - event->begin_us), (long long)lasts_us);
    log_up(log, event->station, event->begin_us, "a pump");
    station->side = event->side;
    station->free_us = event->end_us;
}

static inline void log_end_of_route(tool_log_t *log, const wh_flow_event_t *event) {
    log_wafer_t *wafer = &log->wafers[event->wafer];
    if (!wafer->is_born) {
        log_bear(log, event->wafer, event->end_us);
    }
    const bool is_lost = log_failed(log, event->station, event->end_us + 1);
    log_holds(log, wafer->place == event->place && !wafer->is_over, "%s ends, and does not lie there",
              log_wafer_name(log, event->wafer));
    log_holds(log, is_lost || log_next(log, event->wafer, wafer->step, event->place, event->end_us + 1) < 0,
              "%s ends in %s, and could go on", log_wafer_name(log, event->wafer),
              log_station_name(log, event->station));
    wafer->is_over = true;
    wafer->is_lost = is_lost;
}

#endif
