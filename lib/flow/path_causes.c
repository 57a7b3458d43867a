/* Why something of a flow began when it did: what ended then, and was needed most. */
#include "path_internal.h"

/* The ranks of causes: its place was emptied just in time; needed by the same robot, by what begins, by what
 * follows on that, by another robot that begins with it; or it ended at that time. */
enum { EMPTIED, NEEDED_FIRST, NEEDED, NEEDED_ONWARD, NEEDED_BESIDE, ENDED };

/* All events before `low` end before that time, none from `high` on does. */
static size_t first_between(const wh_flow_log_t *log, int64_t us, size_t low, size_t high) {
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

size_t wh_flow_first_ending(const wh_flow_log_t *log, int64_t us, const wh_flow_event_t *near) {
    const wh_flow_event_t *const events = log->events;
    size_t low = (size_t)(near - events), high = low, step = 1;
    for (; low > 0 && events[low - 1].end_us >= us; step *= 2) {
        high = low - 1;
        low = high > step ? high - step : 0;
    }
    for (; high < log->count && events[high].end_us < us; step *= 2) {
        low = high + 1;
        high = log->count - low > step ? low + step : log->count;
    }
    return first_between(log, us, low, high);
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
static int64_t shut_us(const wh_flow_path_t *path, const wh_flow_event_t *access) {
    const size_t of = wh_flow_of(path->tool, access->robot, access->station);
    return access->end_us + path->tool->doors[of].close_us;
}

/* ---------------------------------------------------------------------------------------- the robot's aim */

/* The access for which a robot does something, and, if it takes a wafer there, the one that brings it on.
 * Each may be null. */
typedef struct {
    const wh_flow_event_t *access, *placing;
} aim_t;

static const wh_flow_event_t *next_access(const wh_flow_path_t *path, const wh_flow_event_t *from,
                                          int32_t robot, bool (*is_meant)(const wh_flow_event_t *)) {
    const wh_flow_event_t *const end = path->log->events + path->log->count;
    for (const wh_flow_event_t *next = from; next < end; ++next) {
        if (next->robot == robot && is_meant(next)) {
            return next;
        }
    }
    return NULL;
}

static aim_t aim_of(const wh_flow_path_t *path, const wh_flow_event_t *event) {
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

static void offer(wh_flow_cause_t *best, const wh_flow_cause_t *cause) {
    *best = cause->rank < best->rank ? *cause : *best;
}

static void offer_end(wh_flow_cause_t *best, int rank, const wh_flow_event_t *ended) {
    offer(best, &(wh_flow_cause_t){rank, WH_FLOW_PATH_WORDS, WH_FLOW_NONE, ended, false});
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

/* True if a list brings a wafer into a place as another robot has emptied it: the transfer began so that both
 * end at one time. */
static bool is_just_emptied(const wh_flow_path_t *path, const aim_t *aim, int32_t robot,
                            const wh_flow_event_t *ended, int64_t us) {
    const wh_flow_event_t *access = aim->access;
    return path->plan->rule == WH_FLOW_LISTS && takes(ended) && ended->robot != robot && access &&
           access->kind == WH_FLOW_EVENT_PLACE && access->begin_us == us && access->place == ended->place;
}

static void offer_ends(const wh_flow_path_t *path, const aim_t *aim, int32_t robot, int64_t us,
                       const wh_flow_event_t *near, wh_flow_cause_t *best) {
    for (size_t i = wh_flow_first_ending(path->log, us, near);
         i < path->log->count && path->log->events[i].end_us == us; ++i) {
        const wh_flow_event_t *ended = &path->log->events[i];
        if (ended->begin_us < us) {
            offer_end(best,
                      is_just_emptied(path, aim, robot, ended, us) ? EMPTIED : need_of_end(aim, robot, ended),
                      ended);
        }
    }
}

static void offer_doors(const wh_flow_path_t *path, const aim_t *aim, int64_t us, const wh_flow_event_t *near,
                        wh_flow_cause_t *best) {
    for (size_t i = wh_flow_first_ending(path->log, us - path->longest_shutting_us, near);
         i < path->log->count && path->log->events[i].end_us < us; ++i) {
        const wh_flow_event_t *before = &path->log->events[i];
        if (is_access(before) && shut_us(path, before) == us) {
            offer(best, &(wh_flow_cause_t){is_at(aim->access, before->station) ? NEEDED : ENDED,
                                           WH_FLOW_PATH_DOOR, before->station, before, false});
        }
    }
}

static void offer_lots(const wh_flow_path_t *path, const aim_t *aim, int64_t us, wh_flow_cause_t *best) {
    const wh_flow_event_t *access = aim->access;
    for (size_t i = 0; i < path->plan->lot_count; ++i) {
        if (path->plan->lots[i].arrives_us == us) {
            const bool is_own = access && takes(access) && access->step == 0 &&
                                path->plan->wafers[access->wafer].lot == (int32_t)i;
            offer(best,
                  &(wh_flow_cause_t){is_own ? NEEDED : ENDED, WH_FLOW_PATH_LOT, WH_FLOW_NONE, NULL, false});
        }
    }
}

/* The first of those that began at this time or later, by their begins. */
static size_t first_beginning(const wh_flow_path_t *path, int64_t us) {
    const wh_flow_begin_t *begins = wh_flow_begins(path);
    size_t low = 0, high = path->log->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (begins[middle].event->begin_us < us) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* The next that began at this time, or null; `at` counts on. */
static const wh_flow_event_t *next_begun(const wh_flow_path_t *path, int64_t us, size_t *at) {
    const wh_flow_begin_t *begins = wh_flow_begins(path);
    return *at < path->log->count && begins[*at].event->begin_us == us ? begins[(*at)++].event : NULL;
}

/* True if the aim is to take a wafer out of its first place. */
static bool is_start(const aim_t *aim) {
    return aim->access && takes(aim->access) && aim->access->step == 0;
}

/* A wafer's start keeps others back from its begin on, its door's opening included. */
static void offer_takt(const wh_flow_path_t *path, const aim_t *aim, int64_t us, wh_flow_cause_t *best) {
    const int64_t begin_us = us - path->plan->takt_us;
    if (path->plan->takt_us == 0) {
        return;
    }
    size_t at = first_beginning(path, begin_us);
    for (const wh_flow_event_t *begun = next_begun(path, begin_us, &at); begun;
         begun = next_begun(path, begin_us, &at)) {
        const bool is_entering = begun->kind == WH_FLOW_EVENT_OPEN || takes(begun);
        const aim_t of_begun = aim_of(path, begun);
        if (is_entering && is_start(&of_begun)) {
            offer(best, &(wh_flow_cause_t){is_start(aim) ? NEEDED : ENDED, WH_FLOW_PATH_TAKT, WH_FLOW_NONE,
                                           begun, true});
        }
    }
}

/* A station fails at a time that is given. */
static void offer_failures(const wh_flow_path_t *path, int64_t us, wh_flow_cause_t *best) {
    for (size_t i = 0; i < path->plan->down_count; ++i) {
        if (path->plan->downs[i].at_us == us) {
            offer(best, &(wh_flow_cause_t){ENDED, WH_FLOW_PATH_WAIT, WH_FLOW_NONE, NULL, false});
        }
    }
}

/* All for which the event may have begun when it did. */
static void offer_all(const wh_flow_path_t *path, const aim_t *aim, const wh_flow_event_t *event,
                      wh_flow_cause_t *best) {
    const int64_t us = event->begin_us;
    offer_ends(path, aim, event->robot, us, event, best);
    offer_doors(path, aim, us, event, best);
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
static aim_t aim_of_lock(const wh_flow_path_t *path, const wh_flow_event_t *pump) {
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
static wh_flow_cause_t cause_of_choice(const wh_flow_path_t *path, const wh_flow_event_t *event, int depth) {
    const int64_t us = event->begin_us;
    wh_flow_cause_t best = {
        .rank = WH_FLOW_CAUSE_UNKNOWN, .word = WH_FLOW_PATH_WAIT, .station = WH_FLOW_NONE};
    const aim_t aim = event->kind == WH_FLOW_EVENT_PUMP ? aim_of_lock(path, event) : aim_of(path, event);
    offer_all(path, &aim, event, &best);
    if (best.rank < NEEDED_BESIDE || depth == DEEPEST) {
        return best;
    }
    size_t at = first_beginning(path, us);
    for (const wh_flow_event_t *begun = next_begun(path, us, &at); begun; begun = next_begun(path, us, &at)) {
        const aim_t of_begun = aim_of(path, begun);
        if (begun != event && could_follow(event, &aim, begun, &of_begun)) {
            wh_flow_cause_t other = cause_of_choice(path, begun, depth + 1);
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
static void offer_shut(const wh_flow_event_t *event, const wh_flow_event_t *shut, wh_flow_cause_t *best) {
    if (shut->end_us == event->begin_us) {
        offer_end(best, shut->station == event->station ? NEEDED : WH_FLOW_CAUSE_UNKNOWN, shut);
    }
}

/* Something that ended before a process, or before the clean around its wafer, and let that begin. */
static void offer_before_process(const wh_flow_path_t *path, const wh_flow_event_t *event,
                                 const wh_flow_event_t *before, wh_flow_cause_t *best) {
    const int64_t us = event->begin_us;
    if (before->kind == WH_FLOW_EVENT_SHUT) {
        offer_shut(event, before, best);
        return;
    }
    const int32_t placed = before->kind == WH_FLOW_EVENT_SWAP ? before->other : before->wafer;
    if (brings(before) && placed == event->wafer && shut_us(path, before) == us) {
        offer(best, &(wh_flow_cause_t){NEEDED, WH_FLOW_PATH_DOOR, event->station, before, false});
    }
    if (before->end_us == us) {
        const bool is_failure = before->kind == WH_FLOW_EVENT_DOWN && before->station == event->station;
        offer_end(best,
                  is_own_process(before, event) ? NEEDED_FIRST
                  : is_failure                  ? NEEDED_ONWARD
                                                : WH_FLOW_CAUSE_UNKNOWN,
                  before);
    }
}

/* A process begins behind its wafer's placing and its door, or a failure. */
static wh_flow_cause_t cause_of_process(const wh_flow_path_t *path, const wh_flow_event_t *event) {
    wh_flow_cause_t best = {
        .rank = WH_FLOW_CAUSE_UNKNOWN, .word = WH_FLOW_PATH_WAIT, .station = WH_FLOW_NONE};
    for (size_t i = wh_flow_first_ending(path->log, event->begin_us - path->longest_shutting_us, event);
         i < path->log->count && path->log->events[i].end_us <= event->begin_us; ++i) {
        if (&path->log->events[i] != event) {
            offer_before_process(path, event, &path->log->events[i], &best);
        }
    }
    return best;
}

/* The access that took the last wafer out of the place before an event there began, or null. */
static const wh_flow_event_t *last_taking(const wh_flow_path_t *path, const wh_flow_event_t *event) {
    for (size_t i = wh_flow_first_ending(path->log, event->begin_us + 1, event); i > 0; --i) {
        const wh_flow_event_t *before = &path->log->events[i - 1];
        if (takes(before) && before->place == event->place) {
            return before;
        }
    }
    return NULL;
}

/* How long the place stays empty before a clean. */
static int64_t idle_of(const wh_flow_path_t *path, const wh_flow_event_t *event,
                       const wh_flow_event_t *taking) {
    const int32_t recipe = taking ? wh_flow_recipe_of(path->plan, taking->wafer, taking->step) : 0;
    return wh_flow_treatment(&path->tool->stations[event->station], recipe).idle_us;
}

/* A clean of an empty place begins when the door is shut behind its wafer, when a failure ends, or when no
 * wafer came for so long. */
static wh_flow_cause_t cause_of_clean(const wh_flow_path_t *path, const wh_flow_event_t *event) {
    wh_flow_cause_t best = {
        .rank = WH_FLOW_CAUSE_UNKNOWN, .word = WH_FLOW_PATH_WAIT, .station = WH_FLOW_NONE};
    const wh_flow_event_t *taking = last_taking(path, event);
    const int64_t us = event->begin_us, idle_us = idle_of(path, event, taking);
    const wh_flow_event_t out = {
        .kind = WH_FLOW_EVENT_PLACE, .station = event->station, .place = event->place};
    const aim_t aim = {&out, NULL};
    if (event->wafer != WH_FLOW_NONE) {
        return cause_of_process(path, event);
    }
    offer_ends(path, &aim, WH_FLOW_NONE, us, event, &best);
    offer_doors(path, &aim, us, event, &best);
    if (best.rank == NEEDED || idle_us >= us) {
        return best.rank == NEEDED ? best
                                   : (wh_flow_cause_t){.rank = WH_FLOW_CAUSE_UNKNOWN,
                                                       .word = WH_FLOW_PATH_WAIT,
                                                       .station = WH_FLOW_NONE};
    }
    return taking && taking->end_us == us - idle_us
               ? (wh_flow_cause_t){NEEDED, WH_FLOW_PATH_WAIT, WH_FLOW_NONE, taking, false}
               : best;
}

wh_flow_cause_t wh_flow_cause_of(const wh_flow_path_t *path, const wh_flow_event_t *event) {
    if (event->kind == WH_FLOW_EVENT_PROCESS) {
        return cause_of_process(path, event);
    }
    if (event->kind == WH_FLOW_EVENT_CLEAN) {
        return cause_of_clean(path, event);
    }
    const bool is_given = event->kind == WH_FLOW_EVENT_DOWN || event->kind == WH_FLOW_EVENT_HELD;
    return is_given ? (wh_flow_cause_t){NEEDED, WH_FLOW_PATH_WAIT, WH_FLOW_NONE, NULL, false}
                    : cause_of_choice(path, event, 0);
}
