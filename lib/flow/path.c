#include "path.h"

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

typedef struct {
    const wh_flow_event_t *event;
} begin_t;

typedef struct {
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    const wh_flow_log_t *log;
    begin_t *begins; /* the log's events, by their begins */
    int64_t longest_shutting_us;
    wh_flow_part_t *parts;
    size_t count, capacity;
} path_t;

static const wh_flow_path_word_t words_of_events[] = {
    [WH_FLOW_EVENT_MOVE] = WH_FLOW_PATH_MOVE,   [WH_FLOW_EVENT_OPEN] = WH_FLOW_PATH_DOOR,
    [WH_FLOW_EVENT_PICK] = WH_FLOW_PATH_PICK,   [WH_FLOW_EVENT_PLACE] = WH_FLOW_PATH_PLACE,
    [WH_FLOW_EVENT_SWAP] = WH_FLOW_PATH_SWAP,   [WH_FLOW_EVENT_PROCESS] = WH_FLOW_PATH_PROCESS,
    [WH_FLOW_EVENT_CLEAN] = WH_FLOW_PATH_CLEAN, [WH_FLOW_EVENT_PUMP] = WH_FLOW_PATH_PUMP,
    [WH_FLOW_EVENT_DOWN] = WH_FLOW_PATH_DOWN,   [WH_FLOW_EVENT_STAY] = WH_FLOW_PATH_WAIT,
    [WH_FLOW_EVENT_SHUT] = WH_FLOW_PATH_DOOR,   [WH_FLOW_EVENT_LEFT] = WH_FLOW_PATH_WAIT,
    [WH_FLOW_EVENT_HELD] = WH_FLOW_PATH_DOWN,   [WH_FLOW_EVENT_COMES] = WH_FLOW_PATH_CARRIER,
    [WH_FLOW_EVENT_GOES] = WH_FLOW_PATH_CARRIER};

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

static void add_event(path_t *path, const wh_flow_event_t *event) {
    if (event->end_us > event->begin_us) {
        add_part(path, words_of_events[event->kind], event->robot,
                 event->robot == WH_FLOW_NONE ? event->station : WH_FLOW_NONE,
                 event->end_us - event->begin_us);
    }
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

static bool is_access(const wh_flow_event_t *event) {
    return event->kind == WH_FLOW_EVENT_PICK || event->kind == WH_FLOW_EVENT_PLACE ||
           event->kind == WH_FLOW_EVENT_SWAP;
}

/* True if it takes a wafer out. */
static bool takes(const wh_flow_event_t *event) {
    return event->kind == WH_FLOW_EVENT_PICK || event->kind == WH_FLOW_EVENT_SWAP;
}

/* True if it brings a wafer in. */
static bool brings(const wh_flow_event_t *event) {
    return event->kind == WH_FLOW_EVENT_PLACE || event->kind == WH_FLOW_EVENT_SWAP;
}

/* When the door behind an access is shut. */
static int64_t shut_us(const path_t *path, const wh_flow_event_t *access) {
    const size_t of = wh_flow_of(path->tool, access->robot, access->station);
    return access->end_us + path->tool->doors[of].close_us;
}

/* ---------------------------------------------------------------------------------------- the robot's aim */

/* The access for which a robot does something, and, if it takes a wafer there, the one that brings it on.
 * Each may be null. */
typedef struct {
    const wh_flow_event_t *access, *placing;
} aim_t;

static const wh_flow_event_t *next_access(const path_t *path, const wh_flow_event_t *from, int32_t robot,
                                          bool (*is_meant)(const wh_flow_event_t *)) {
    const wh_flow_event_t *const end = path->log->events + path->log->count;
    for (const wh_flow_event_t *next = from; next < end; ++next) {
        if (next->robot == robot && is_meant(next)) {
            return next;
        }
    }
    return NULL;
}

static aim_t aim_of(const path_t *path, const wh_flow_event_t *event) {
    aim_t aim = {NULL, NULL};
    if (event->robot != WH_FLOW_NONE) {
        aim.access = next_access(path, event, event->robot, is_access);
        aim.placing =
            aim.access && takes(aim.access) ? next_access(path, aim.access + 1, event->robot, brings) : NULL;
    }
    return aim;
}

static bool is_at(const wh_flow_event_t *access, int32_t station) {
    return access && access->station == station;
}

/* ------------------------------------------------------------------------------------------------- causes */

/* Why something began at an instant. */
typedef struct {
    int rank;                     /* 0 is best; UNKNOWN: nothing ended */
    wh_flow_path_word_t word;     /* of the time up to the instant, if it is not the event's own */
    int32_t station;              /* likewise */
    const wh_flow_event_t *event; /* before it; null: nothing, the time is from the beginning on */
    bool is_from_begin;           /* the time is from the event's begin on, not from its end */
} cause_t;

enum { NEEDED_FIRST, NEEDED, NEEDED_ONWARD, NEEDED_BESIDE, ENDED, UNKNOWN };

static void offer(cause_t *best, const cause_t *cause) {
    *best = cause->rank < best->rank ? *cause : *best;
}

static void offer_end(cause_t *best, int rank, const wh_flow_event_t *ended) {
    offer(best, &(cause_t){rank, WH_FLOW_PATH_WORDS, WH_FLOW_NONE, ended, false});
}

/* True if the wafer that the access takes had to wait for that, or the place into which it brings one. */
static bool is_for_access(const wh_flow_event_t *access, int32_t robot, const wh_flow_event_t *ended) {
    const bool takes_it = (takes(access) || robot == WH_FLOW_NONE) && ended->wafer == access->wafer;
    return ended->kind == WH_FLOW_EVENT_PROCESS
               ? takes_it
               : takes_it || (brings(access) && ended->place == access->place);
}

/* True if it keeps others out of its station. */
static bool is_in_station(const wh_flow_event_t *event) {
    return event->kind != WH_FLOW_EVENT_MOVE && event->kind != WH_FLOW_EVENT_OPEN;
}

/* How much an aim needed that this ended. */
static int need_of_end(const aim_t *aim, int32_t robot, const wh_flow_event_t *ended) {
    if (robot != WH_FLOW_NONE && ended->robot == robot) {
        return NEEDED_FIRST;
    }
    if (!aim->access || !is_in_station(ended)) {
        return ENDED;
    }
    if (ended->kind == WH_FLOW_EVENT_PROCESS || ended->kind == WH_FLOW_EVENT_CLEAN) {
        return is_for_access(aim->access, robot, ended) ? NEEDED : ENDED;
    }
    return ended->station == aim->access->station ? NEEDED
           : is_at(aim->placing, ended->station)  ? NEEDED_ONWARD
                                                  : ENDED;
}

static void offer_ends(const path_t *path, const aim_t *aim, int32_t robot, int64_t us, cause_t *best) {
    for (size_t i = first_ending(path->log, us); i < path->log->count && path->log->events[i].end_us == us;
         ++i) {
        const wh_flow_event_t *ended = &path->log->events[i];
        if (ended->begin_us < us) {
            offer_end(best, need_of_end(aim, robot, ended), ended);
        }
    }
}

static void offer_doors(const path_t *path, const aim_t *aim, int64_t us, cause_t *best) {
    for (size_t i = first_ending(path->log, us - path->longest_shutting_us);
         i < path->log->count && path->log->events[i].end_us < us; ++i) {
        const wh_flow_event_t *before = &path->log->events[i];
        if (is_access(before) && shut_us(path, before) == us) {
            offer(best, &(cause_t){is_at(aim->access, before->station) ? NEEDED : ENDED, WH_FLOW_PATH_DOOR,
                                   before->station, before, false});
        }
    }
}

static void offer_lots(const path_t *path, const aim_t *aim, int64_t us, cause_t *best) {
    const wh_flow_event_t *access = aim->access;
    for (size_t i = 0; i < path->plan->lot_count; ++i) {
        if (path->plan->lots[i].arrives_us == us) {
            const bool is_own = access && takes(access) && access->step == 0 &&
                                path->plan->wafers[access->wafer].lot == (int32_t)i;
            offer(best, &(cause_t){is_own ? NEEDED : ENDED, WH_FLOW_PATH_LOT, WH_FLOW_NONE, NULL, false});
        }
    }
}

/* The first of those that began at this time or later, by their begins. */
static size_t first_beginning(const path_t *path, int64_t us) {
    size_t low = 0, high = path->log->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (path->begins[middle].event->begin_us < us) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* The next that began at this time, or null; `at` counts on. */
static const wh_flow_event_t *next_begun(const path_t *path, int64_t us, size_t *at) {
    return *at < path->log->count && path->begins[*at].event->begin_us == us ? path->begins[(*at)++].event
                                                                             : NULL;
}

/* True if the aim is to take a wafer out of its first place. */
static bool is_start(const aim_t *aim) {
    return aim->access && takes(aim->access) && aim->access->step == 0;
}

/* A wafer's start keeps others back from its begin on, its door's opening included. */
static void offer_takt(const path_t *path, const aim_t *aim, int64_t us, cause_t *best) {
    const int64_t begin_us = us - path->plan->takt_us;
    size_t at = first_beginning(path, begin_us);
    if (path->plan->takt_us == 0) {
        return;
    }
    for (const wh_flow_event_t *begun = next_begun(path, begin_us, &at); begun;
         begun = next_begun(path, begin_us, &at)) {
        const bool is_entering = begun->kind == WH_FLOW_EVENT_OPEN || takes(begun);
        const aim_t of_begun = aim_of(path, begun);
        if (is_entering && is_start(&of_begun)) {
            offer(best,
                  &(cause_t){is_start(aim) ? NEEDED : ENDED, WH_FLOW_PATH_TAKT, WH_FLOW_NONE, begun, true});
        }
    }
}

/* A station fails at a time that is given. */
static void offer_failures(const path_t *path, int64_t us, cause_t *best) {
    for (size_t i = 0; i < path->plan->down_count; ++i) {
        if (path->plan->downs[i].at_us == us) {
            offer(best, &(cause_t){ENDED, WH_FLOW_PATH_WAIT, WH_FLOW_NONE, NULL, false});
        }
    }
}

static void offer_all(const path_t *path, const aim_t *aim, int32_t robot, int64_t us, cause_t *best) {
    offer_ends(path, aim, robot, us, best);
    offer_doors(path, aim, us, best);
    offer_takt(path, aim, us, best);
    offer_lots(path, aim, us, best);
    offer_failures(path, us, best);
}

/* True if what another robot began at the same instant could let this begin: it empties a place, or brings
 * a wafer to a lock that turns. */
static bool could_follow(const wh_flow_event_t *event, const aim_t *aim, const wh_flow_event_t *begun,
                         const aim_t *of_begun) {
    if (!of_begun->access || begun->robot == event->robot) {
        return false;
    }
    if (event->robot == WH_FLOW_NONE) {
        return is_at(of_begun->access, event->station) || is_at(of_begun->placing, event->station);
    }
    const bool is_entering = begun->kind == WH_FLOW_EVENT_OPEN || takes(begun);
    return is_entering && takes(of_begun->access) &&
           (is_at(aim->access, of_begun->access->station) || is_at(aim->placing, of_begun->access->station));
}

/* A lock turns for the access that comes next. */
static aim_t aim_of_lock(const path_t *path, const wh_flow_event_t *pump) {
    for (const wh_flow_event_t *next = pump; next < path->log->events + path->log->count; ++next) {
        if (is_access(next) && next->station == pump->station) {
            return (aim_t){next, NULL};
        }
    }
    return (aim_t){NULL, NULL};
}

/* Robots that begin at one instant, each because another one did. */
#define DEEPEST 4

/* The best for this of all that ended at the instant; else for another robot that began with it, and let it
 * begin. */
static cause_t cause_of_choice(const path_t *path, const wh_flow_event_t *event, int depth) {
    const int64_t us = event->begin_us;
    cause_t best = {.rank = UNKNOWN, .word = WH_FLOW_PATH_WAIT, .station = WH_FLOW_NONE};
    const aim_t aim = event->kind == WH_FLOW_EVENT_PUMP ? aim_of_lock(path, event) : aim_of(path, event);
    offer_all(path, &aim, event->robot, us, &best);
    if (best.rank < NEEDED_BESIDE || depth == DEEPEST) {
        return best;
    }
    size_t at = first_beginning(path, us);
    for (const wh_flow_event_t *begun = next_begun(path, us, &at); begun; begun = next_begun(path, us, &at)) {
        const aim_t of_begun = aim_of(path, begun);
        if (begun != event && could_follow(event, &aim, begun, &of_begun)) {
            cause_t other = cause_of_choice(path, begun, depth + 1);
            other.rank = other.rank < NEEDED_BESIDE ? NEEDED_BESIDE : other.rank;
            offer(&best, &other);
        }
    }
    return best;
}

static bool is_own_process(const wh_flow_event_t *before, const wh_flow_event_t *event) {
    return before->kind == WH_FLOW_EVENT_PROCESS && before->wafer == event->wafer;
}

/* A real door, behind which something began. */
static void offer_shut(const wh_flow_event_t *event, const wh_flow_event_t *shut, cause_t *best) {
    if (shut->end_us == event->begin_us) {
        offer_end(best, shut->station == event->station ? NEEDED : UNKNOWN, shut);
    }
}

/* Something that ended before a process, or before the clean around its wafer, and let that begin. */
static void offer_before_process(const path_t *path, const wh_flow_event_t *event,
                                 const wh_flow_event_t *before, cause_t *best) {
    const int64_t us = event->begin_us;
    if (before->kind == WH_FLOW_EVENT_SHUT) {
        offer_shut(event, before, best);
        return;
    }
    const int32_t placed = before->kind == WH_FLOW_EVENT_SWAP ? before->other : before->wafer;
    if (brings(before) && placed == event->wafer && shut_us(path, before) == us) {
        offer(best, &(cause_t){NEEDED, WH_FLOW_PATH_DOOR, event->station, before, false});
    }
    if (before->end_us == us) {
        const bool is_failure = before->kind == WH_FLOW_EVENT_DOWN && before->station == event->station;
        offer_end(best,
                  is_own_process(before, event) ? NEEDED_FIRST
                  : is_failure                  ? NEEDED_ONWARD
                                                : UNKNOWN,
                  before);
    }
}

/* A process begins behind its wafer's placing and its door, or a failure. */
static cause_t cause_of_process(const path_t *path, const wh_flow_event_t *event) {
    cause_t best = {.rank = UNKNOWN, .word = WH_FLOW_PATH_WAIT, .station = WH_FLOW_NONE};
    for (size_t i = first_ending(path->log, event->begin_us - path->longest_shutting_us);
         i < path->log->count && path->log->events[i].end_us <= event->begin_us; ++i) {
        if (&path->log->events[i] != event) {
            offer_before_process(path, event, &path->log->events[i], &best);
        }
    }
    return best;
}

/* The access that took the last wafer out of the place before an event there began, or null. */
static const wh_flow_event_t *last_taking(const path_t *path, const wh_flow_event_t *event) {
    for (size_t i = first_ending(path->log, event->begin_us + 1); i > 0; --i) {
        const wh_flow_event_t *before = &path->log->events[i - 1];
        if (takes(before) && before->place == event->place) {
            return before;
        }
    }
    return NULL;
}

/* How long the place stays empty before a clean. */
static int64_t idle_of(const path_t *path, const wh_flow_event_t *event, const wh_flow_event_t *taking) {
    const int32_t recipe = taking ? wh_flow_recipe_of(path->plan, taking->wafer, taking->step) : 0;
    return wh_flow_treatment(&path->tool->stations[event->station], recipe).idle_us;
}

/* A clean of an empty place begins when the door is shut behind its wafer, when a failure ends, or when no
 * wafer came for so long. */
static cause_t cause_of_clean(const path_t *path, const wh_flow_event_t *event) {
    cause_t best = {.rank = UNKNOWN, .word = WH_FLOW_PATH_WAIT, .station = WH_FLOW_NONE};
    const wh_flow_event_t *taking = last_taking(path, event);
    const int64_t us = event->begin_us, idle_us = idle_of(path, event, taking);
    const wh_flow_event_t out = {
        .kind = WH_FLOW_EVENT_PLACE, .station = event->station, .place = event->place};
    const aim_t aim = {&out, NULL};
    if (event->wafer != WH_FLOW_NONE) {
        return cause_of_process(path, event);
    }
    offer_ends(path, &aim, WH_FLOW_NONE, us, &best);
    offer_doors(path, &aim, us, &best);
    if (best.rank == NEEDED || idle_us >= us) {
        return best.rank == NEEDED
                   ? best
                   : (cause_t){.rank = UNKNOWN, .word = WH_FLOW_PATH_WAIT, .station = WH_FLOW_NONE};
    }
    return taking && taking->end_us == us - idle_us
               ? (cause_t){NEEDED, WH_FLOW_PATH_WAIT, WH_FLOW_NONE, taking, false}
               : best;
}

static cause_t cause_of(const path_t *path, const wh_flow_event_t *event) {
    if (event->kind == WH_FLOW_EVENT_PROCESS) {
        return cause_of_process(path, event);
    }
    if (event->kind == WH_FLOW_EVENT_CLEAN) {
        return cause_of_clean(path, event);
    }
    const bool is_given = event->kind == WH_FLOW_EVENT_DOWN || event->kind == WH_FLOW_EVENT_HELD;
    return is_given ? (cause_t){NEEDED, WH_FLOW_PATH_WAIT, WH_FLOW_NONE, NULL, false}
                    : cause_of_choice(path, event, 0);
}

/* Goes back from the begin of an event to what let it begin: adds the time between, and what that took
 * itself. Returns it, or null at the beginning. */
static const wh_flow_event_t *go_back(path_t *path, const wh_flow_event_t *event) {
    const int64_t us = event->begin_us;
    cause_t cause = cause_of(path, event);
    if (cause.rank == UNKNOWN) {
        const size_t first = first_ending(path->log, us);
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
    const wh_flow_event_t *one = ((const begin_t *)a)->event, *other = ((const begin_t *)b)->event;
    return one->begin_us != other->begin_us ? (one->begin_us < other->begin_us ? -1 : 1)
           : one < other                    ? -1
                                            : one > other;
}

/* The log is in the order of ends: few begin far from where they stand. If many do, they are sorted as any
 * list is. */
static void sort_by_begins(begin_t *begins, size_t count) {
    size_t steps = 0;
    for (size_t i = 1; i < count && steps < 64 * count; ++i) {
        const begin_t one = begins[i];
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

static void open_path(path_t *path) {
    const wh_flow_tool_t *tool = path->tool;
    path->begins = wh_array_new(path->log->count, sizeof *path->begins);
    for (size_t i = 0; i < path->log->count; ++i) {
        path->begins[i].event = &path->log->events[i];
    }
    sort_by_begins(path->begins, path->log->count);
    for (size_t i = 0; i < tool->robot_count * tool->station_count; ++i) {
        const int64_t close_us = tool->doors[i].close_us;
        path->longest_shutting_us =
            close_us > path->longest_shutting_us ? close_us : path->longest_shutting_us;
    }
}

wh_flow_part_t *wh_flow_path(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const wh_flow_log_t *log,
                             size_t *count) {
    path_t path = {.tool = tool, .plan = plan, .log = log};
    const wh_flow_event_t *event = find_last(log);
    open_path(&path);
    if (event) {
        add_event(&path, event);
    }
    while (event && event->begin_us > 0) {
        event = go_back(&path, event);
    }
    if (path.count > 0) {
        qsort(path.parts, path.count, sizeof *path.parts, by_time);
    }
    free(path.begins);
    *count = path.count;
    return path.parts;
}
