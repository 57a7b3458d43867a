#include "path.h"

#include <stdlib.h>

#include "../text/array.h"

const char *const wh_flow_path_words[WH_FLOW_PATH_WORDS] = {
    "move", "door", "pick", "place", "swap", "process", "clean", "pump", "down", "lot", "takt", "wait"};

void wh_flow_log_add(wh_flow_log_t *log, const wh_flow_event_t *event) {
    if (event->kind != WH_FLOW_EVENT_STAY && event->end_us > event->begin_us) {
        log->events = wh_array_grow(log->events, log->count, &log->capacity, sizeof *log->events);
        size_t at = log->count++;
        for (; at > 0 && log->events[at - 1].end_us > event->end_us; --at) {
            log->events[at] = log->events[at - 1];
        }
        log->events[at] = *event; /* a process with a clean around its wafer is told at the clean's end */
    }
}

typedef struct {
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    const wh_flow_log_t *log;
    wh_flow_part_t *parts;
    size_t count, capacity;
} path_t;

static const wh_flow_path_word_t words_of_events[] = {
    [WH_FLOW_EVENT_MOVE] = WH_FLOW_PATH_MOVE,   [WH_FLOW_EVENT_OPEN] = WH_FLOW_PATH_DOOR,
    [WH_FLOW_EVENT_PICK] = WH_FLOW_PATH_PICK,   [WH_FLOW_EVENT_PLACE] = WH_FLOW_PATH_PLACE,
    [WH_FLOW_EVENT_SWAP] = WH_FLOW_PATH_SWAP,   [WH_FLOW_EVENT_PROCESS] = WH_FLOW_PATH_PROCESS,
    [WH_FLOW_EVENT_CLEAN] = WH_FLOW_PATH_CLEAN, [WH_FLOW_EVENT_PUMP] = WH_FLOW_PATH_PUMP,
    [WH_FLOW_EVENT_DOWN] = WH_FLOW_PATH_DOWN,   [WH_FLOW_EVENT_STAY] = WH_FLOW_PATH_WAIT};

static void add_part(path_t *path, wh_flow_path_word_t word, int32_t robot, int32_t station, int64_t us) {
    for (size_t i = 0; i < path->count; ++i) {
        wh_flow_part_t *part = &path->parts[i];
        if (part->word == word && part->robot == robot && part->station == station) {
            part->us += us;
            return;
        }
    }
    path->parts = wh_array_grow(path->parts, path->count, &path->capacity, sizeof *path->parts);
    path->parts[path->count++] = (wh_flow_part_t){word, robot, station, us};
}

/* The first event that ends at this time or later. */
static size_t first_ending(const wh_flow_log_t *log, int64_t us) {
    size_t low = 0, high = log->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (log->events[middle].end_us < us) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* How well the end of `before` explains the begin of `event`: 0 is best. */
static int rank(const wh_flow_event_t *before, const wh_flow_event_t *event) {
    if (event->robot != WH_FLOW_NONE && before->robot == event->robot) {
        return 0;
    }
    if (before->wafer != WH_FLOW_NONE && (before->wafer == event->wafer || before->other == event->wafer)) {
        return 1;
    }
    return before->station == event->station ? 2 : 3;
}

static bool is_access(const wh_flow_event_t *event) {
    return event->kind == WH_FLOW_EVENT_PICK || event->kind == WH_FLOW_EVENT_PLACE ||
           event->kind == WH_FLOW_EVENT_SWAP;
}

/* True if the event could wait for what a station did by itself: its robot goes into that place or station,
 * or brings its wafer there next. */
static bool could_wait_for(const path_t *path, const wh_flow_event_t *event, const wh_flow_event_t *doing) {
    if (event->robot == WH_FLOW_NONE) {
        return doing->station == event->station && doing->kind != WH_FLOW_EVENT_CLEAN;
    }
    const wh_flow_event_t *const end = path->log->events + path->log->count;
    for (const wh_flow_event_t *next = event; next < end; ++next) {
        if (next->robot != event->robot || !is_access(next)) {
            continue;
        }
        if (doing->kind == WH_FLOW_EVENT_CLEAN ? next->place == doing->place
                                               : next->station == doing->station) {
            return true;
        }
        if (next->kind != WH_FLOW_EVENT_PICK) {
            return false;
        }
    }
    return false;
}

static bool is_station_alone(const wh_flow_event_t *event) {
    return event->kind == WH_FLOW_EVENT_CLEAN || event->kind == WH_FLOW_EVENT_PUMP ||
           event->kind == WH_FLOW_EVENT_DOWN;
}

/* The event whose end lets this one begin, or null. */
static const wh_flow_event_t *find_before(const path_t *path, const wh_flow_event_t *event) {
    const wh_flow_event_t *best = NULL;
    for (size_t i = first_ending(path->log, event->begin_us);
         i < path->log->count && path->log->events[i].end_us == event->begin_us; ++i) {
        const wh_flow_event_t *before = &path->log->events[i];
        if (is_station_alone(before) && !could_wait_for(path, event, before)) {
            continue;
        }
        if (!best || rank(before, event) < rank(best, event)) {
            best = before;
        }
    }
    return best;
}

static int64_t longest_shutting_us(const wh_flow_tool_t *tool) {
    int64_t longest_us = 0;
    for (size_t i = 0; i < tool->robot_count * tool->station_count; ++i) {
        longest_us = tool->doors[i].close_us > longest_us ? tool->doors[i].close_us : longest_us;
    }
    return longest_us;
}

/* True if it is an access whose door is shut at this time. */
static bool is_shut_at(const wh_flow_tool_t *tool, const wh_flow_event_t *event, int64_t us) {
    return is_access(event) &&
           event->end_us + tool->doors[wh_flow_of(tool, event->robot, event->station)].close_us == us;
}

/* The access whose door is shut at the begin of this event, or null. */
static const wh_flow_event_t *find_shut(const path_t *path, const wh_flow_event_t *event) {
    const wh_flow_event_t *best = NULL;
    for (size_t i = first_ending(path->log, event->begin_us - longest_shutting_us(path->tool));
         i < path->log->count && path->log->events[i].end_us < event->begin_us; ++i) {
        const wh_flow_event_t *before = &path->log->events[i];
        if (is_shut_at(path->tool, before, event->begin_us) && (!best || before->station == event->station)) {
            best = before;
        }
    }
    return best;
}

static const wh_flow_lot_t *find_lot(const path_t *path, int64_t us) {
    for (size_t i = 0; i < path->plan->lot_count; ++i) {
        if (path->plan->lots[i].arrives_us == us) {
            return &path->plan->lots[i];
        }
    }
    return NULL;
}

/* The last event that ends before this time, or null. */
static const wh_flow_event_t *find_earlier(const path_t *path, int64_t us) {
    const size_t first = first_ending(path->log, us);
    return first > 0 ? &path->log->events[first - 1] : NULL;
}

/* Goes back over what nothing that ended explains: a door, a lot, takt. Returns the event behind it, or
 * null. */
static const wh_flow_event_t *go_back(path_t *path, const wh_flow_event_t *event) {
    const int64_t at_us = event->begin_us;
    const wh_flow_event_t *before = find_shut(path, event);
    if (before) {
        add_part(path, WH_FLOW_PATH_DOOR, WH_FLOW_NONE, before->station, at_us - before->end_us);
        return before;
    }
    if (find_lot(path, at_us)) {
        add_part(path, WH_FLOW_PATH_LOT, WH_FLOW_NONE, WH_FLOW_NONE, at_us);
        return NULL;
    }
    before = find_earlier(path, at_us);
    const bool is_start =
        (event->kind == WH_FLOW_EVENT_PICK || event->kind == WH_FLOW_EVENT_OPEN) && path->plan->takt_us > 0;
    add_part(path, is_start ? WH_FLOW_PATH_TAKT : WH_FLOW_PATH_WAIT, WH_FLOW_NONE, WH_FLOW_NONE,
             at_us - (before ? before->end_us : 0));
    return before;
}

static int by_time(const void *a, const void *b) {
    const wh_flow_part_t *one = a, *other = b;
    if (one->us != other->us) {
        return one->us > other->us ? -1 : 1;
    }
    return one->robot != other->robot       ? one->robot - other->robot
           : one->station != other->station ? one->station - other->station
                                            : (int)one->word - (int)other->word;
}

/* The last placing, or null. */
static const wh_flow_event_t *find_last(const wh_flow_log_t *log) {
    for (size_t i = log->count; i > 0; --i) {
        const wh_flow_event_kind_t kind = log->events[i - 1].kind;
        if (kind == WH_FLOW_EVENT_PLACE || kind == WH_FLOW_EVENT_SWAP) {
            return &log->events[i - 1];
        }
    }
    return NULL;
}

wh_flow_part_t *wh_flow_path(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const wh_flow_log_t *log,
                             size_t *count) {
    path_t path = {tool, plan, log, NULL, 0, 0};
    const wh_flow_event_t *event = find_last(log);
    while (event) {
        const bool is_robots = event->robot != WH_FLOW_NONE;
        add_part(&path, words_of_events[event->kind], event->robot, is_robots ? WH_FLOW_NONE : event->station,
                 event->end_us - event->begin_us);
        const wh_flow_event_t *before = event->begin_us > 0 ? find_before(&path, event) : NULL;
        event = before || event->begin_us == 0 ? before : go_back(&path, event);
    }
    if (path.count > 0) {
        qsort(path.parts, path.count, sizeof *path.parts, by_time);
    }
    *count = path.count;
    return path.parts;
}

/* -------------------------------------------------------------------------------------------------- gains */

static void shorten(int64_t times_us[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        times_us[i] -= (times_us[i] + 5) / 10;
    }
}

static void shorten_robot(wh_flow_tool_t *tool, int32_t robot) {
    const size_t of = wh_flow_of(tool, robot, 0), stations = tool->station_count;
    shorten(&tool->pick_us[of], stations);
    shorten(&tool->place_us[of], stations);
    shorten(&tool->swap_us[of], stations);
    shorten(&tool->move_us[of * stations], stations * stations);
}

static void shorten_station(wh_flow_tool_t *tool, int32_t station) {
    wh_flow_station_t *of = &tool->stations[station];
    of->is_shortened = true;
    shorten(&of->process_us, 1);
    shorten(&of->clean_us, 1);
    shorten(of->pump_us, 2);
    shorten(of->empty_pump_us, 2);
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        wh_flow_door_t *door = &tool->doors[wh_flow_of(tool, r, station)];
        shorten(&door->open_us, 1);
        shorten(&door->close_us, 1);
    }
}

wh_flow_gain_t *wh_flow_gains(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    const size_t robots = tool->robot_count, stations = tool->station_count;
    wh_flow_gain_t *gains = wh_array_new(robots + stations, sizeof *gains);
    for (size_t i = 0; i < robots + stations; ++i) {
        wh_flow_tool_t other;
        wh_flow_result_t result;
        const bool is_robot = i < robots;
        const int32_t number = (int32_t)(is_robot ? i : i - robots);
        wh_flow_tool_copy(&other, tool);
        if (is_robot) {
            shorten_robot(&other, number);
        } else {
            shorten_station(&other, number);
        }
        wh_flow_play(&other, plan, NULL, &result);
        gains[i] = (wh_flow_gain_t){is_robot ? number : WH_FLOW_NONE, is_robot ? WH_FLOW_NONE : number,
                                    result.end, result.makespan_us,
                                    result.period > 0 ? (double)result.cycle_us / result.period : -1};
        wh_flow_result_close(&result);
        wh_flow_tool_close(&other);
    }
    return gains;
}
