#include "clock.h"

#include <math.h>
#include <string.h>

const char *wh_clock_kind_name(wh_clock_kind_t kind) {
    static const char *const names[WH_CLOCK_KINDS] = {
        "process_begins", "process_ends", "process_cut",  "taken",        "clean_begins", "clean_ends",
        "pump_begins",    "pump_ends",    "unprocessed",  "late",         "clean_missed", "clean_cut",
        "port_begins",    "port_ends",    "port_timeout", "carrier_came", "carrier_went"};
    return (unsigned)kind < WH_CLOCK_KINDS ? names[kind] : "unknown";
}

const char *wh_clock_phase_name(wh_clock_phase_t phase) {
    static const char *const names[] = {"empty", "waiting", "processing", "cleaning", "done"};
    return names[phase];
}

void wh_clock_start(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[]) {
    memset(clock, 0, sizeof *clock);
    clock->side = clock->pump_to = of->side;
    for (int32_t i = 0; i < of->slots; ++i) {
        memset(&places[i], 0, sizeof places[i]);
        places[i].wafer = WH_FLOW_NONE;
        places[i].own_us = WH_FLOW_NONE;
    }
}

/* ------------------------------------------------------------------------------------------------ telling */

static void tell_place(const wh_clock_teller_t *teller, wh_clock_kind_t kind, int32_t slot, int32_t wafer,
                       int64_t at_us, int64_t us) {
    const wh_clock_event_t event = {
        .kind = kind, .slot = slot, .wafer = wafer, .side = WH_FLOW_BOTH, .at_us = at_us, .us = us};
    teller->tell(teller->user, &event);
}

static void tell_pump(const wh_clock_teller_t *teller, wh_clock_kind_t kind, wh_flow_side_t side,
                      int64_t at_us, int64_t us) {
    const wh_clock_event_t event = {
        .kind = kind, .slot = WH_FLOW_NONE, .wafer = WH_FLOW_NONE, .side = side, .at_us = at_us, .us = us};
    teller->tell(teller->user, &event);
}

/* -------------------------------------------------------------------------------------------- time passes */

bool wh_clock_cleans_next(const wh_flow_station_t *of, const wh_clock_place_t *place) {
    return wh_flow_is_clean_due(of, place->recipe, place->since_clean);
}

static bool cleans_around(const wh_flow_station_t *of, const wh_clock_place_t *place) {
    return of->cleans_full && place->wafer != WH_FLOW_NONE && wh_clock_cleans_next(of, place);
}

static void begin_clean(const wh_flow_station_t *of, wh_clock_place_t *place, int32_t slot, int64_t now_us,
                        const wh_clock_teller_t *teller) {
    place->phase = WH_CLOCK_CLEANING;
    place->is_around = place->wafer != WH_FLOW_NONE;
    place->left_us = (double)of->clean_us;
    place->begun_us = now_us;
    tell_place(teller, WH_CLOCK_CLEAN_BEGINS, slot, place->wafer, now_us, of->clean_us);
}

static void end_process(const wh_flow_station_t *of, wh_clock_place_t *place, int32_t slot, int64_t now_us,
                        const wh_clock_teller_t *teller) {
    tell_place(teller, WH_CLOCK_PROCESS_ENDS, slot, place->wafer, now_us, now_us - place->begun_us);
    place->done_us = now_us;
    place->left_us = 0;
    if (cleans_around(of, place)) {
        begin_clean(of, place, slot, now_us, teller);
    } else {
        place->phase = WH_CLOCK_DONE;
    }
}

/* A wafer in a place: it waits for its process, or there is none for it. */
static void settle(const wh_flow_station_t *of, wh_clock_place_t *place) {
    place->phase =
        wh_clock_process_us(of, place) > 0 || cleans_around(of, place) ? WH_CLOCK_WAITING : WH_CLOCK_DONE;
}

/* A wafer around which a place was cleaned is still to leave. */
static void end_clean(const wh_flow_station_t *of, wh_clock_place_t *place, int32_t slot, int64_t now_us,
                      const wh_clock_teller_t *teller) {
    const bool is_around = place->is_around && place->wafer != WH_FLOW_NONE;
    tell_place(teller, WH_CLOCK_CLEAN_ENDS, slot, place->wafer, now_us, now_us - place->begun_us);
    place->is_clean_due = place->is_around = false;
    place->since_clean = is_around ? -1 : 0;
    place->left_us = 0;
    place->empty_us = now_us;
    if (is_around) {
        place->phase = WH_CLOCK_DONE;
    } else if (place->wafer != WH_FLOW_NONE) {
        settle(of, place);
    } else {
        place->phase = WH_CLOCK_FREE;
        place->empty_us = WH_FLOW_NEVER;
    }
}

void wh_clock_pass(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[], double us,
                   double rate, int64_t now_us, const wh_clock_teller_t *teller) {
    for (int32_t i = 0; i < of->slots; ++i) {
        wh_clock_place_t *place = &places[i];
        if (place->phase != WH_CLOCK_PROCESSING && place->phase != WH_CLOCK_CLEANING) {
            continue;
        }
        place->left_us -= us * rate;
        if (place->left_us <= 0 && place->phase == WH_CLOCK_PROCESSING) {
            end_process(of, place, i, now_us, teller);
        } else if (place->left_us <= 0) {
            end_clean(of, place, i, now_us, teller);
        }
    }
    clock->left_us -= clock->is_pumping ? us * rate : 0;
    if (clock->is_pumping && clock->left_us <= 0) {
        clock->is_pumping = false;
        clock->left_us = 0;
        clock->side = clock->pump_to;
        tell_pump(teller, WH_CLOCK_PUMP_ENDS, clock->side, now_us, now_us - clock->begun_us);
    }
}

/* True if the empty place is cleaned for want of wafers, now or later: once until the next wafer has left. */
static bool has_idle_clean(const wh_flow_station_t *of, const wh_clock_place_t *place) {
    return place->phase == WH_CLOCK_FREE && of->clean_us > 0 && place->empty_us != WH_FLOW_NEVER &&
           wh_flow_treatment(of, place->recipe).idle_us != WH_FLOW_NEVER;
}

/* Until a clean of an empty place is due; INFINITY: never. */
static double until_idle_clean(const wh_flow_station_t *of, const wh_clock_place_t *place, int64_t now_us) {
    const int64_t idle_us = wh_flow_treatment(of, place->recipe).idle_us;
    return has_idle_clean(of, place) ? (double)(idle_us - (now_us - place->empty_us)) : (double)INFINITY;
}

double wh_clock_quiet_us(const wh_flow_station_t *of, const wh_clock_t *clock,
                         const wh_clock_place_t places[], int64_t now_us) {
    double us = clock->is_pumping ? clock->left_us : (double)INFINITY;
    for (int32_t i = 0; i < of->slots; ++i) {
        const bool runs = places[i].phase == WH_CLOCK_PROCESSING || places[i].phase == WH_CLOCK_CLEANING;
        const double own_us = runs ? places[i].left_us : until_idle_clean(of, &places[i], now_us);
        us = places[i].is_away ? 0 : fmin(us, own_us);
    }
    return us;
}

/* ------------------------------------------------------------------------------------ wafers come and go */

static bool is_idle_clean_due(const wh_flow_station_t *of, const wh_clock_place_t *place, int64_t now_us) {
    return has_idle_clean(of, place) &&
           now_us - place->empty_us >= wh_flow_treatment(of, place->recipe).idle_us;
}

bool wh_clock_is_clean_due(const wh_flow_station_t *of, const wh_clock_place_t *place, int64_t now_us) {
    return place->phase == WH_CLOCK_FREE && (place->is_clean_due || is_idle_clean_due(of, place, now_us));
}

/* A wafer that is awaited has ended the idle time. */
static bool is_due_unless(const wh_flow_station_t *of, const wh_clock_place_t *place, bool is_awaited,
                          int64_t now_us) {
    return (place->is_clean_due || !is_awaited) && wh_clock_is_clean_due(of, place, now_us);
}

/* A process or a clean around the wafer is cut at once; all else waits until the wafer has left. */
static void lift(wh_clock_place_t *place, int32_t slot, int64_t now_us, const wh_clock_teller_t *teller) {
    if (place->phase == WH_CLOCK_PROCESSING) {
        tell_place(teller, WH_CLOCK_PROCESS_CUT, slot, place->wafer, now_us, now_us - place->begun_us);
        place->phase = WH_CLOCK_WAITING;
        place->is_cut = true;
        place->left_us = 0;
    } else if (place->phase == WH_CLOCK_CLEANING && place->is_around) {
        tell_place(teller, WH_CLOCK_CLEAN_CUT, slot, place->wafer, now_us, now_us - place->begun_us);
        place->phase = WH_CLOCK_DONE;
        place->is_around = false;
        place->left_us = 0;
    }
}

static void tell_late(const wh_flow_station_t *of, const wh_clock_place_t *place, int32_t slot,
                      int64_t stay_us, int64_t now_us, const wh_clock_teller_t *teller) {
    if (of->window_us != WH_FLOW_NEVER && stay_us > of->window_us) {
        tell_place(teller, WH_CLOCK_LATE, slot, place->wafer, now_us, stay_us - of->window_us);
    }
}

static void leave(const wh_flow_station_t *of, wh_clock_place_t *place, int32_t slot, int64_t now_us,
                  const wh_clock_teller_t *teller) {
    const int64_t stay_us = place->lifted_us - place->done_us;
    if (place->phase == WH_CLOCK_DONE) {
        tell_place(teller, WH_CLOCK_TAKEN, slot, place->wafer, now_us, stay_us);
        tell_late(of, place, slot, stay_us, now_us, teller);
    } else if (place->phase == WH_CLOCK_WAITING && !place->is_cut) {
        tell_place(teller, WH_CLOCK_UNPROCESSED, slot, place->wafer, now_us, stay_us);
    }
    place->is_clean_due = !of->cleans_full && wh_clock_cleans_next(of, place);
    ++place->since_clean;
    place->wafer = WH_FLOW_NONE;
    place->is_away = false;
    place->empty_us = now_us;
    if (place->phase != WH_CLOCK_CLEANING) {
        place->phase = WH_CLOCK_FREE;
        place->left_us = 0;
    }
}

/* A wafer that comes into a running clean waits for its end. */
static void enter(const wh_flow_station_t *of, wh_clock_place_t *place, int32_t slot,
                  const wh_clock_seen_t *seen, int64_t now_us, const wh_clock_teller_t *teller) {
    const bool is_due = is_due_unless(of, place, seen->is_awaited, now_us);
    place->wafer = seen->wafer;
    place->done_us = now_us;
    place->is_cut = place->is_forced = false;
    place->own_us = place->has_next ? place->next_us : WH_FLOW_NONE;
    place->recipe = place->has_next ? place->next_recipe : seen->recipe;
    place->has_next = false;
    if (place->phase == WH_CLOCK_CLEANING) {
        tell_place(teller, WH_CLOCK_CLEAN_MISSED, slot, place->wafer, now_us, (int64_t)place->left_us);
    } else {
        if (is_due) {
            tell_place(teller, WH_CLOCK_CLEAN_MISSED, slot, place->wafer, now_us, of->clean_us);
        }
        settle(of, place);
    }
}

static void begin(const wh_flow_station_t *of, wh_clock_place_t *place, int32_t slot, bool is_awaited,
                  int64_t now_us, const wh_clock_teller_t *teller) {
    const bool may_begin = place->phase == WH_CLOCK_WAITING && !place->is_away && !place->is_bad;
    const int64_t process_us = wh_clock_process_us(of, place);
    if (may_begin && process_us > 0) {
        place->phase = WH_CLOCK_PROCESSING;
        place->is_cut = false;
        place->left_us = (double)process_us;
        place->begun_us = now_us;
        tell_place(teller, WH_CLOCK_PROCESS_BEGINS, slot, place->wafer, now_us, process_us);
    } else if (may_begin || is_due_unless(of, place, is_awaited, now_us)) {
        begin_clean(of, place, slot, now_us, teller);
    }
}

/* The wafer of the place lies there, well or not, or is away. */
static void see_own(const wh_flow_station_t *of, wh_clock_place_t *place, int32_t slot,
                    const wh_clock_seen_t *seen, int64_t now_us, const wh_clock_teller_t *teller) {
    const bool lies = place->wafer == seen->wafer && !seen->is_lifted;
    if ((!lies || seen->is_bad) && !place->is_away) {
        lift(place, slot, now_us, teller);
        place->lifted_us = now_us;
    }
    place->is_away = !lies;
    if (place->wafer != seen->wafer && (!seen->keeps || seen->wafer != WH_FLOW_NONE)) {
        leave(of, place, slot, now_us, teller);
    }
}

static void see(const wh_flow_station_t *of, wh_clock_place_t *place, int32_t slot,
                const wh_clock_seen_t *seen, int64_t now_us, const wh_clock_teller_t *teller) {
    place->is_bad = seen->wafer != WH_FLOW_NONE && seen->is_bad;
    if (place->wafer != WH_FLOW_NONE) {
        see_own(of, place, slot, seen, now_us, teller);
    }
    if (place->wafer == WH_FLOW_NONE && seen->wafer != WH_FLOW_NONE) {
        enter(of, place, slot, seen, now_us, teller);
    }
}

void wh_clock_look(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[],
                   const wh_clock_seen_t seen[], bool is_closed, int64_t now_us,
                   const wh_clock_teller_t *teller) {
    for (int32_t i = 0; i < of->slots; ++i) {
        see(of, &places[i], i, &seen[i], now_us, teller);
        if (is_closed && !clock->is_pumping) {
            begin(of, &places[i], i, seen[i].is_awaited, now_us, teller);
        }
    }
}

/* True if a process or a clean waits for its begin. */
static bool waits(const wh_flow_station_t *of, const wh_clock_place_t *place) {
    return place->phase == WH_CLOCK_WAITING ||
           (place->phase == WH_CLOCK_FREE && (place->is_clean_due || has_idle_clean(of, place)));
}

/* True if the place's wafer lies there well, or there is none, and nobody comes for it. */
static bool is_left_alone(const wh_clock_place_t *place, const wh_clock_seen_t *seen) {
    const bool is_bad = place->is_bad || (seen->wafer != WH_FLOW_NONE && seen->is_bad);
    return place->wafer == seen->wafer && !place->is_away && !is_bad && !seen->keeps && !seen->is_lifted &&
           !seen->is_awaited;
}

bool wh_clock_rests(const wh_flow_station_t *of, const wh_clock_place_t places[],
                    const wh_clock_seen_t seen[]) {
    bool rests = true;
    for (int32_t i = 0; rests && i < of->slots; ++i) {
        rests = is_left_alone(&places[i], &seen[i]) && !waits(of, &places[i]);
    }
    return rests;
}

void wh_clock_lift_anew(wh_clock_place_t *place, int64_t now_us) {
    place->lifted_us = place->is_away ? now_us : place->lifted_us;
}

int64_t wh_clock_judge(const wh_flow_station_t *of, const wh_clock_place_t *place, int32_t slot, bool lies,
                       int64_t now_us, const wh_clock_teller_t *teller) {
    if (place->phase != WH_CLOCK_DONE && !(place->phase == WH_CLOCK_CLEANING && place->is_around)) {
        return -1;
    }
    const int64_t stay_us = (lies ? now_us : place->lifted_us) - place->done_us;
    tell_late(of, place, slot, stay_us, now_us, teller);
    return stay_us;
}

/* ----------------------------------------------------------------------------------------------- pumping */

static bool is_empty(const wh_flow_station_t *of, const wh_clock_place_t places[]) {
    bool is_empty = true;
    for (int32_t i = 0; i < of->slots; ++i) {
        is_empty = is_empty && places[i].wafer == WH_FLOW_NONE;
    }
    return is_empty;
}

bool wh_clock_pump(const wh_flow_station_t *of, wh_clock_t *clock, const wh_clock_place_t places[],
                   wh_flow_side_t to, int64_t now_us, const wh_clock_teller_t *teller) {
    if (clock->is_pumping || clock->side == to) {
        return clock->is_pumping ? clock->pump_to == to : true;
    }
    const int64_t us = wh_flow_pump_us(of, to, is_empty(of, places));
    clock->is_pumping = true;
    clock->pump_to = to;
    clock->left_us = (double)us;
    clock->begun_us = now_us;
    tell_pump(teller, WH_CLOCK_PUMP_BEGINS, to, now_us, us);
    return true;
}

double wh_clock_left_us(const wh_flow_station_t *of, const wh_clock_place_t *place, int64_t now_us) {
    const double around = cleans_around(of, place) ? (double)of->clean_us : 0;
    switch (place->phase) {
    case WH_CLOCK_WAITING:
        return (double)wh_clock_process_us(of, place) + around;
    case WH_CLOCK_PROCESSING:
        return place->left_us + around;
    case WH_CLOCK_CLEANING:
        return place->left_us;
    case WH_CLOCK_FREE:
        return wh_clock_is_clean_due(of, place, now_us) ? (double)of->clean_us : 0;
    case WH_CLOCK_DONE:
        break;
    }
    return 0;
}
