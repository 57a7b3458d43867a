/* Processes, windows and cleans: rules 8, 9, 10, and 16 of a process. */
#include "check_internal.h"

static const char *name_of(const wh_schedule_state_t *check, int32_t wafer) {
    return wh_schedule_text(&check->schedule->wafers, wafer);
}

/* The process of a route's step; in the route's last station, and behind it, there is none of its own. */
static int64_t step_us(const wh_flow_route_t *route, int32_t visits, const wh_flow_station_t *station,
                       int32_t recipe) {
    return (size_t)visits < route->step_count ? wh_flow_step_us(&route->steps[visits], station, recipe) : 0;
}

int32_t wh_check_recipe(const wh_schedule_state_t *check, const wh_schedule_row_t *row) {
    return row->recipe == 0 || !check->tool
               ? 0
               : wh_flow_recipe_named(&check->tool->recipes,
                                      wh_schedule_text(&check->schedule->recipes, row->recipe - 1));
}

/* True if one process comes before another one, or before WH_FLOW_NEVER: the longest up to `most_us`, else
 * the shortest. */
static bool is_before(int64_t us, int64_t other_us, int64_t most_us) {
    return us <= most_us ? other_us > most_us || us > other_us : us < other_us;
}

/* The time for which the layout processes a wafer where it lies: of the routes that it may go the longest up
 * to `most_us`, else the shortest. */
static int64_t process_us(const wh_schedule_state_t *check, int32_t number, int64_t most_us) {
    const wh_check_wafer_t *wafer = &check->wafers[number];
    if (!check->tool || wafer->place == WH_FLOW_NONE || wafer->visits == 0) {
        return 0;
    }
    const wh_flow_station_t *station = wh_check_station(check, check->schedule->places[wafer->place].station);
    int64_t found_us = WH_FLOW_NEVER;
    for (size_t r = 0; r < check->tool->route_count && !wafer->is_lost; ++r) {
        if ((wafer->routes >> r & 1U) != 0) {
            const int64_t us = step_us(&check->tool->routes[r], wafer->visits, station, wafer->stay_recipe);
            found_us = is_before(us, found_us, most_us) ? us : found_us;
        }
    }
    return found_us == WH_FLOW_NEVER ? wh_flow_treatment(station, wafer->stay_recipe).process_us : found_us;
}

int64_t wh_check_process_us(const wh_schedule_state_t *check, int32_t number) {
    return process_us(check, number, -1);
}

/* ---------------------------------------------------------------------------------------------- processes */

/* Rule 8. A wafer has one process at a time, and no more of it than the layout says. */
static void check_again(wh_schedule_state_t *check, int32_t row, const wh_check_wafer_t *wafer,
                        int32_t number) {
    const int64_t needed_us = wh_check_process_us(check, number);
    if (wafer->process_row == WH_CHECK_NO_ROW ||
        wh_check_is_early(check, WH_SCHEDULE_RULE_PROCESS, row, wafer->done_us, wafer->process_row)) {
        return;
    }
    if (check->tool && needed_us > 0 && !wh_check_is_behind(needed_us, wafer->processed_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_PROCESS, row, wafer->process_row,
                       "wafer: %s (expected one that is not processed yet: its %.10g s here are over)",
                       name_of(check, number), wh_check_seconds(needed_us));
    }
    check->report->repeated += check->tool ? 0 : 1;
}

/* The layout's process is over when rows have lasted as long; they may last longer. While the wafer may go by
 * several routes, it is the longest process that the rows are enough for. */
static void note_whole(const wh_schedule_state_t *check, const wh_schedule_row_t *of, wh_check_wafer_t *wafer,
                       int32_t number) {
    const int64_t told_us = wafer->processed_us + of->end_us - of->begin_us + WH_SCHEDULE_INSTANT_US;
    const int64_t left_us = process_us(check, number, told_us) - wafer->processed_us;
    const int64_t whole_us = of->begin_us + (left_us > 0 ? left_us : 0);
    if (check->tool && wafer->whole_us == WH_FLOW_NEVER && whole_us <= of->end_us) {
        wafer->whole_us = whole_us;
    }
}

void wh_check_begin_process(wh_schedule_state_t *check, int32_t row) {
    wh_check_text_t text, place;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const int32_t number = of->wafer != WH_FLOW_NONE ? of->wafer : check->places[of->place].head;
    if (number == WH_FLOW_NONE) {
        return; /* without a wafer, as for conditioning */
    }
    wh_check_wafer_t *wafer = &check->wafers[number];
    if (wafer->where != WH_CHECK_LIES || wafer->place != of->place) {
        wh_check_found(check, WH_SCHEDULE_RULE_TWO_PLACES, row, wafer->row,
                       "wafer: %s (expected one that lies in %s: it %s)", name_of(check, number),
                       wh_check_place_name(check, of->place, &place), wh_check_where(check, number, &text));
        return;
    }
    const bool is_first = wafer->process_row == WH_CHECK_NO_ROW;
    if (wh_check_recipe(check, of) > 0) {
        wafer->stay_recipe = check->places[of->place].recipe = wh_check_recipe(check, of);
    }
    wh_check_process_door(check, row, wafer);
    check_again(check, row, wafer, number);
    note_whole(check, of, wafer, number);
    wafer->done_us = is_first || of->end_us > wafer->done_us ? of->end_us : wafer->done_us;
    wafer->processed_us += of->end_us - of->begin_us;
    wafer->process_row = row;
}

/* The wafer is taken out too soon: before its process is over, rule 8; where it has none, before the door
 * behind it is shut, rule 13. */
static void check_begin(wh_schedule_state_t *check, int32_t row, const wh_check_wafer_t *wafer,
                        int32_t number) {
    const bool is_told = wafer->process_row != WH_CHECK_NO_ROW;
    const bool is_door = !is_told && wafer->done_us <= wafer->placed_us;
    if (wh_check_is_behind(wafer->done_us, wh_check_row(check, row)->begin_us)) {
        wh_check_found(
            check, is_door ? WH_SCHEDULE_RULE_DOOR : WH_SCHEDULE_RULE_PROCESS, row,
            is_told ? wafer->process_row : wafer->row,
            is_door ? "begin_s: %.10g (expected %.10g or later, when the door behind the place of %s is shut)"
                    : "begin_s: %.10g (expected %.10g or later, when the process of %s is over)",
            wh_check_seconds(wh_check_row(check, row)->begin_us), wh_check_seconds(wafer->done_us),
            name_of(check, number));
    }
}

/* Rule 8. The row that takes the wafer out is `row`; WH_CHECK_NO_ROW: it stays until the end. */
static void check_process(wh_schedule_state_t *check, int32_t row, const wh_check_wafer_t *wafer,
                          int32_t number) {
    const int64_t needed_us = wh_check_process_us(check, number);
    const bool is_told = wafer->process_row != WH_CHECK_NO_ROW;
    if (is_told && wh_check_is_behind(needed_us, wafer->processed_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_PROCESS, wafer->process_row, row,
                       "end_s: %.10g (expected %.10g or later: %s is processed for %.10g s here)",
                       wh_check_seconds(wh_check_row(check, wafer->process_row)->end_us),
                       wh_check_seconds(wh_check_row(check, wafer->process_row)->end_us + needed_us -
                                        wafer->processed_us),
                       name_of(check, number), wh_check_seconds(needed_us));
    } else if (row != WH_CHECK_NO_ROW) {
        check_begin(check, row, wafer, number);
    }
}

/* Rule 9. A clean around the wafer belongs to its stay. */
static void check_window(wh_schedule_state_t *check, int32_t row, int32_t number, int64_t until_us) {
    const wh_check_wafer_t *wafer = &check->wafers[number];
    const int32_t of = check->schedule->places[wafer->place].station;
    const wh_flow_station_t *station = wh_check_station(check, of);
    if (!station || station->window_us == WH_FLOW_NEVER || wafer->visits == 0) {
        return;
    }
    const int64_t last_us = wafer->done_us - wafer->around_us;
    const int64_t done_us = wafer->whole_us < last_us ? wafer->whole_us : last_us;
    if (!wh_check_is_behind(until_us, done_us + station->window_us)) {
        return;
    }
    if (row == wafer->row) {
        wh_check_found(
            check, WH_SCHEDULE_RULE_WINDOW, row, WH_CHECK_NO_ROW,
            "wafer: %s (expected a pick of it until %.10g s: it may stay for %.10g s behind its process, and "
            "lies there at the end, at %.10g s)",
            name_of(check, number), wh_check_seconds(done_us + station->window_us),
            wh_check_seconds(station->window_us), wh_check_seconds(until_us));
    } else {
        wh_check_found(
            check, WH_SCHEDULE_RULE_WINDOW, row, wafer->row,
            "begin_s: %.10g (expected %.10g or sooner: %s may stay for %.10g s behind its process)",
            wh_check_seconds(until_us), wh_check_seconds(done_us + station->window_us),
            name_of(check, number), wh_check_seconds(station->window_us));
    }
}

void wh_check_finish_stays(wh_schedule_state_t *check) {
    for (int32_t w = 0; w < (int32_t)check->schedule->wafers.count; ++w) {
        const wh_check_wafer_t *wafer = &check->wafers[w];
        if (wafer->where == WH_CHECK_LIES && wafer->row != WH_CHECK_NO_ROW) {
            check_process(check, WH_CHECK_NO_ROW, wafer, w);
            check_window(check, wafer->row, w, check->report->end_us);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- cleans */

/* A clean with the wafer inside, that is due before the wafer leaves. */
static void check_clean_inside(wh_schedule_state_t *check, int32_t row, wh_check_wafer_t *wafer) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_flow_station_t *station = wh_check_station(check, of->station);
    wh_check_place_t *place = &check->places[of->place];
    if (!station || !station->cleans_full || wafer->visits == 0 ||
        !wh_flow_is_clean_due(station, place->recipe, place->since)) {
        return;
    }
    const int32_t after = wh_flow_treatment(station, place->recipe).clean_after;
    place->since = -1; /* this wafer leaves behind it */
    if (check->has_cleans) {
        if (place->cleaned_us < wafer->placed_us) {
            wh_check_found(check, WH_SCHEDULE_RULE_CLEAN, row, WH_CHECK_NO_ROW,
                           "begin_s: %.10g (expected a clean before: one is due behind %d %s)",
                           wh_check_seconds(of->begin_us), (int)after, after == 1 ? "wafer" : "wafers");
        }
    } else {
        wafer->done_us += station->clean_us;
        wafer->around_us = station->clean_us;
    }
}

/* The wafer is taken out of its place. */
void wh_check_leave(wh_schedule_state_t *check, int32_t row, int32_t number) {
    wh_check_wafer_t *wafer = &check->wafers[number];
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_check_place_t *place = &check->places[of->place];
    check_clean_inside(check, row, wafer);
    check_process(check, row, wafer, number);
    check_window(check, row, number, of->begin_us);
    if (wh_check_is_behind(place->clean_us, of->begin_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_CLEAN, row, place->clean_row,
                       "begin_s: %.10g (expected %.10g or later, when the clean is over)",
                       wh_check_seconds(of->begin_us), wh_check_seconds(place->clean_us));
    }
}

void wh_check_begin_clean(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_flow_station_t *station = wh_check_station(check, of->station);
    wh_check_place_t *place = &check->places[of->place];
    const bool is_full = place->count > 0;
    (void)wh_check_is_early(check, WH_SCHEDULE_RULE_CLEAN, row, place->clean_us, place->clean_row);
    if (!wh_check_is_early(check, WH_SCHEDULE_RULE_CLEAN, row, place->placing_us, place->placing_row) &&
        station && is_full && !station->cleans_full) {
        wh_check_found(check, WH_SCHEDULE_RULE_CLEAN, row, check->wafers[place->head].row,
                       "begin_s: %.10g (expected a time when nothing lies there: %s does)",
                       wh_check_seconds(of->begin_us), name_of(check, place->head));
    }
    if (station && wh_flow_is_cleaned(station)) {
        wh_check_length(check, row, station->clean_us);
    }
    place->cleaned_us = of->begin_us;
    place->clean_us = of->end_us;
    place->clean_row = row;
    place->since = is_full ? place->since : 0;
}

/* Since when a clean must have run before this placing; WH_FLOW_NEVER: none is due. */
static int64_t clean_due_us(const wh_schedule_state_t *check, int32_t row, int32_t leaving) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_flow_station_t *station = wh_check_station(check, of->station);
    const wh_check_place_t *place = &check->places[of->place];
    if (!station->cleans_full && wh_flow_is_clean_due(station, place->recipe, place->since + leaving - 1)) {
        return place->empty_us;
    }
    const int64_t idle_us = wh_flow_treatment(station, place->recipe).idle_us;
    if (idle_us == WH_FLOW_NEVER || leaving > 0 || place->count > 0 ||
        (place->cleaned_us >= 0 && place->cleaned_us >= place->empty_us)) {
        return WH_FLOW_NEVER;
    }
    const int64_t begin_us = of->begin_us - check->tool->doors[wh_check_pair(check, of)].open_us;
    return wh_check_is_behind(begin_us, place->empty_us + idle_us) ? place->empty_us + idle_us
                                                                   : WH_FLOW_NEVER;
}

/* A wafer is placed there: no clean runs, and none that is due was left out. */
void wh_check_enter(wh_schedule_state_t *check, int32_t row, int32_t leaving) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_flow_station_t *station = wh_check_station(check, of->station);
    wh_check_place_t *place = &check->places[of->place];
    if (wh_check_is_behind(place->clean_us, of->begin_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_CLEAN, row, place->clean_row,
                       "begin_s: %.10g (expected %.10g or later, when the clean is over)",
                       wh_check_seconds(of->begin_us), wh_check_seconds(place->clean_us));
    }
    const int64_t due_us = station ? clean_due_us(check, row, leaving) : WH_FLOW_NEVER;
    if (due_us == WH_FLOW_NEVER) {
        return;
    }
    place->since = 0;
    const bool is_implied =
        !check->has_cleans && !wh_check_is_behind(due_us + station->clean_us, of->begin_us);
    if (!is_implied) {
        wh_check_found(check, WH_SCHEDULE_RULE_CLEAN, row, WH_CHECK_NO_ROW,
                       "begin_s: %.10g (expected a clean of %.10g s before: one is due since %.10g)",
                       wh_check_seconds(of->begin_us), wh_check_seconds(station->clean_us),
                       wh_check_seconds(due_us));
    }
}
