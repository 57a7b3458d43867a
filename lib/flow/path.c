#include "path_internal.h"

#include <stdlib.h>

#include "../text/array.h"

const char *const wh_flow_path_words[WH_FLOW_PATH_WORDS] = {"move",    "door",  "pick", "place", "swap",
                                                            "process", "clean", "pump", "down",  "lot",
                                                            "carrier", "takt",  "wait"};

void wh_flow_log_add(wh_flow_log_t *log, const wh_flow_event_t *event) {
    if (event->kind != WH_FLOW_EVENT_STAY && event->kind != WH_FLOW_EVENT_LEFT) {
        log->events = wh_array_grow(log->events, log->count, &log->capacity, sizeof *log->events);
        size_t at = log->count++;
        for (; at > 0 && log->events[at - 1].end_us > event->end_us; --at) {
            log->events[at] = log->events[at - 1];
        }
        log->events[at] = *event; /* a process with a clean around its wafer is told at the clean's end */
        if (event->kind == WH_FLOW_EVENT_SHUT) {
            log->events[at].robot = WH_FLOW_NONE; /* the robot goes on meanwhile */
        }
    }
}

static const wh_flow_path_word_t words_of_events[] = {
    [WH_FLOW_EVENT_MOVE] = WH_FLOW_PATH_MOVE,   [WH_FLOW_EVENT_OPEN] = WH_FLOW_PATH_DOOR,
    [WH_FLOW_EVENT_PICK] = WH_FLOW_PATH_PICK,   [WH_FLOW_EVENT_PLACE] = WH_FLOW_PATH_PLACE,
    [WH_FLOW_EVENT_SWAP] = WH_FLOW_PATH_SWAP,   [WH_FLOW_EVENT_PROCESS] = WH_FLOW_PATH_PROCESS,
    [WH_FLOW_EVENT_CLEAN] = WH_FLOW_PATH_CLEAN, [WH_FLOW_EVENT_PUMP] = WH_FLOW_PATH_PUMP,
    [WH_FLOW_EVENT_DOWN] = WH_FLOW_PATH_DOWN,   [WH_FLOW_EVENT_STAY] = WH_FLOW_PATH_WAIT,
    [WH_FLOW_EVENT_SHUT] = WH_FLOW_PATH_DOOR,   [WH_FLOW_EVENT_LEFT] = WH_FLOW_PATH_WAIT,
    [WH_FLOW_EVENT_HELD] = WH_FLOW_PATH_DOWN,   [WH_FLOW_EVENT_COMES] = WH_FLOW_PATH_CARRIER,
    [WH_FLOW_EVENT_GOES] = WH_FLOW_PATH_CARRIER};

static void add_part(wh_flow_path_t *path, wh_flow_path_word_t word, int32_t robot, int32_t station,
                     int64_t us) {
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

static void add_event(wh_flow_path_t *path, const wh_flow_event_t *event) {
    const int64_t us = event->end_us - event->begin_us - event->stood_us;
    if (us > 0) {
        add_part(path, words_of_events[event->kind], event->robot,
                 event->robot == WH_FLOW_NONE ? event->station : WH_FLOW_NONE, us);
    }
    if (event->stood_us > 0) {
        add_part(path, WH_FLOW_PATH_DOWN, event->robot, WH_FLOW_NONE, event->stood_us);
    }
}

/* Goes back from the begin of an event to what let it begin: adds the time between, and what that took
 * itself. Returns it, or null at the beginning. */
static const wh_flow_event_t *go_back(wh_flow_path_t *path, const wh_flow_event_t *event) {
    const int64_t us = event->begin_us;
    wh_flow_cause_t cause = wh_flow_cause_of(path, event);
    if (cause.rank == WH_FLOW_CAUSE_UNKNOWN) {
        const size_t first = wh_flow_first_ending(path->log, us, event);
        cause.event = first > 0 ? &path->log->events[first - 1] : NULL;
    }
    const int64_t from_us = !cause.event          ? 0
                            : cause.is_from_begin ? cause.event->begin_us
                                                  : cause.event->end_us;
    if (us > from_us) {
        add_part(path, cause.word, WH_FLOW_NONE, cause.station, us - from_us);
    }
    if (cause.event && !cause.is_from_begin) {
        add_event(path, cause.event);
    }
    return cause.event;
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

/* By their begins; of one instant in the order of the log. */
static int by_begin(const void *a, const void *b) {
    const wh_flow_event_t *one = ((const wh_flow_begin_t *)a)->event,
                          *other = ((const wh_flow_begin_t *)b)->event;
    return one->begin_us != other->begin_us ? (one->begin_us < other->begin_us ? -1 : 1)
           : one < other                    ? -1
                                            : one > other;
}

/* The log is in the order of ends: few begin far from where they stand. If many do, they are sorted as any
 * list is. */
static void sort_by_begins(wh_flow_begin_t *begins, size_t count) {
    size_t steps = 0;
    for (size_t i = 1; i < count && steps < 64 * count; ++i) {
        const wh_flow_begin_t one = begins[i];
        size_t at = i;
        while (at > 0 && by_begin(&one, &begins[at - 1]) < 0) {
            begins[at] = begins[at - 1];
            --at;
        }
        begins[at] = one;
        steps += i - at;
    }
    if (count > 0 && steps >= 64 * count) {
        qsort(begins, count, sizeof *begins, by_begin);
    }
}

const wh_flow_begin_t *wh_flow_begins(const wh_flow_path_t *path) {
    wh_flow_begins_t *begins = path->begins;
    if (!begins->of) {
        begins->of = wh_array_new(path->log->count, sizeof *begins->of);
        for (size_t i = 0; i < path->log->count; ++i) {
            begins->of[i].event = &path->log->events[i];
        }
        sort_by_begins(begins->of, path->log->count);
    }
    return begins->of;
}

static void find_longest_shutting(wh_flow_path_t *path) {
    const wh_flow_tool_t *tool = path->tool;
    for (size_t i = 0; i < tool->robot_count * tool->station_count; ++i) {
        const int64_t close_us = tool->doors[i].close_us;
        path->longest_shutting_us =
            close_us > path->longest_shutting_us ? close_us : path->longest_shutting_us;
    }
}

wh_flow_part_t *wh_flow_path(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const wh_flow_log_t *log,
                             size_t *count) {
    wh_flow_begins_t begins = {NULL};
    wh_flow_path_t path = {.tool = tool, .plan = plan, .log = log, .begins = &begins};
    const wh_flow_event_t *event = find_last(log);
    find_longest_shutting(&path);
    if (event) {
        add_event(&path, event);
    }
    while (event && event->begin_us > 0) {
        event = go_back(&path, event);
    }
    if (path.count > 0) {
        qsort(path.parts, path.count, sizeof *path.parts, by_time);
    }
    free(begins.of);
    *count = path.count;
    return path.parts;
}
