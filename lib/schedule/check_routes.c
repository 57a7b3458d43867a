/* Routes: rules 15 and 17. */
#include "check_internal.h"

#include <stdio.h>

/* A wafer whose first place is known may go by each of the layout's routes. */
void wh_check_set_out(wh_schedule_state_t *check, int32_t wafer, int32_t place) {
    check->wafers[wafer].home = check->stations[check->schedule->places[place].station].tool;
    check->wafers[wafer].routes = UINT64_MAX;
    check->wafers[wafer].visits = 0;
    check->wafers[wafer].is_lost = false;
}

/* True if the route's step is this station, or the wafer goes home behind its last one. */
static bool is_next(const wh_schedule_state_t *check, const wh_flow_route_t *route,
                    const wh_check_wafer_t *wafer, int32_t station) {
    if ((size_t)wafer->visits < route->step_count) {
        return wh_flow_step_has(&route->steps[wafer->visits], station);
    }
    return (size_t)wafer->visits == route->step_count &&
           (station == wafer->home || check->tool->stations[station].is_load_port);
}

/* "route A: PM1 or PM2", the next step of a wafer there. */
static size_t name_step(const wh_schedule_state_t *check, const wh_flow_route_t *route, int32_t visits,
                        char text[], size_t size) {
    const bool is_step = (size_t)visits < route->step_count;
    size_t length = (size_t)snprintf(text, size, "route %s: ", route->name);
    const wh_flow_step_t *step = is_step ? &route->steps[visits] : NULL;
    for (size_t i = 0; is_step && i < step->station_count && length + 80 < size; ++i) {
        length += (size_t)snprintf(text + length, size - length, "%s%s", i > 0 ? " or " : "",
                                   check->tool->stations[step->stations[i]].name);
    }
    return is_step ? length : length + (size_t)snprintf(text + length, size - length, "its end");
}

static void name_steps(const wh_schedule_state_t *check, const wh_check_wafer_t *wafer,
                       wh_check_text_t *text) {
    const size_t size = sizeof text->text;
    size_t length = 0;
    text->text[0] = '\0';
    for (size_t r = 0; r < check->tool->route_count && length + 200 < size; ++r) {
        if ((wafer->routes >> r & 1U) != 0) {
            length += (size_t)snprintf(text->text + length, size - length, "%s", length > 0 ? "; " : "");
            length +=
                name_step(check, &check->tool->routes[r], wafer->visits, text->text + length, size - length);
        }
    }
}

/* Rule 15. The wafer is placed in the station of the row. */
void wh_check_visit(wh_schedule_state_t *check, int32_t row, int32_t number) {
    wh_check_text_t text;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_wafer_t *wafer = &check->wafers[number];
    const int32_t station = check->stations[of->station].tool;
    uint64_t routes = 0;
    ++wafer->visits;
    check->report->placed += wafer->visits == 1;
    if (!check->tool || check->tool->route_count == 0 || wafer->is_lost || wafer->routes == 0) {
        return;
    }
    for (size_t r = 0; r < check->tool->route_count; ++r) {
        const bool goes =
            (wafer->routes >> r & 1U) != 0 && is_next(check, &check->tool->routes[r], wafer, station);
        routes |= (uint64_t)goes << r;
    }
    if (routes == 0) {
        name_steps(check, wafer, &text);
        wh_check_found(check, WH_SCHEDULE_RULE_ROUTE, row, WH_CHECK_NO_ROW,
                       "station: %s (expected the next step of %s, %s)",
                       wh_schedule_text(&check->schedule->stations, of->station),
                       wh_schedule_text(&check->schedule->wafers, number), text.text);
        wafer->is_lost = true;
        return;
    }
    wafer->routes = routes;
}

static bool is_at_end(const wh_schedule_state_t *check, const wh_check_wafer_t *wafer) {
    for (size_t r = 0; r < check->tool->route_count; ++r) {
        if ((wafer->routes >> r & 1U) != 0 &&
            (size_t)wafer->visits + 1 >= check->tool->routes[r].step_count) {
            return true;
        }
    }
    return false;
}

/* True if the wafer was brought to where no route can end: that station processes, or is a load lock. */
static bool is_on_its_way(const wh_schedule_state_t *check, const wh_check_wafer_t *wafer) {
    if (wafer->where != WH_CHECK_LIES || wafer->visits == 0) {
        return false;
    }
    const wh_flow_station_t *station = wh_check_station(check, check->schedule->places[wafer->place].station);
    return station->process_us > 0 || station->is_lock;
}

/* True for a load lock of which the layout has one side alone: nobody could carry a wafer on from there. */
static bool is_outlet(const wh_schedule_state_t *check, int32_t place) {
    const wh_flow_tool_t *tool = check->tool;
    const wh_flow_station_t *lock = wh_check_station(check, check->schedule->places[place].station);
    bool has[2] = {false, false};
    for (size_t r = 0; r < tool->robot_count; ++r) {
        const size_t of = wh_flow_of(tool, (int32_t)r, (int32_t)(lock - tool->stations));
        has[0] = has[0] || (tool->serves[of] && tool->sides[of] != WH_FLOW_VACUUM);
        has[1] = has[1] || (tool->serves[of] && tool->sides[of] != WH_FLOW_ATMOSPHERE);
    }
    return lock->is_lock && has[0] != has[1];
}

/* The place where a wafer that lies should lie at last, by the layout; null: it is there, or nobody knows. */
static const char *find_last_place(const wh_schedule_state_t *check, const wh_check_wafer_t *wafer) {
    if (check->tool->route_count > 0) {
        return !wafer->is_lost && wafer->routes != 0 && !is_at_end(check, wafer) ? "at its route's end"
                                                                                 : NULL;
    }
    return is_on_its_way(check, wafer) && !is_outlet(check, wafer->place)
               ? "in a station that neither processes nor pumps"
               : NULL;
}

/* "a place", as is expected of a wafer at last; null: it is there, or nobody knows. */
static const char *find_last(const wh_schedule_state_t *check, const wh_check_wafer_t *wafer) {
    if (wafer->where == WH_CHECK_ABOARD) {
        return "a place";
    }
    return check->tool && wafer->where == WH_CHECK_LIES ? find_last_place(check, wafer) : NULL;
}

/* Rule 17. */
void wh_check_finish_route(wh_schedule_state_t *check, int32_t number) {
    wh_check_text_t text;
    const wh_check_wafer_t *wafer = &check->wafers[number];
    const char *last = wafer->row == WH_CHECK_NO_ROW ? NULL : find_last(check, wafer);
    if (last) {
        wh_check_found(check, WH_SCHEDULE_RULE_LEFT, wafer->row, WH_CHECK_NO_ROW,
                       "wafer: %s (expected %s at last: it %s)",
                       wh_schedule_text(&check->schedule->wafers, number), last,
                       wh_check_where(check, number, &text));
    }
}

void wh_check_finish_routes(wh_schedule_state_t *check) {
    for (int32_t w = 0; w < (int32_t)check->schedule->wafers.count; ++w) {
        wh_check_finish_route(check, w);
    }
}
