#include "textbook.h"

/* The most steps that process. */
#define MOST 16

/* One route, for one robot. Index 0 is where wafers come from, n + 1 where they end. */
typedef struct {
    const wh_flow_tool_t *tool;
    int32_t n;
    int32_t recipe;             /* of all wafers */
    int32_t stations[MOST + 2]; /* the first one of each step */
    int32_t places[MOST + 2], kept[MOST + 2];
    double process[MOST + 2], clean[MOST + 2]; /* us */
    double pick, place, move;                  /* us, if they are alike */
    bool is_alike, is_single;                  /* single: one place a step, no clean, none kept empty */
} line_t;

static double pick_us(const line_t *line, int32_t i) {
    return (double)line->tool->pick_us[line->stations[i]];
}

static double place_us(const line_t *line, int32_t i) {
    return (double)line->tool->place_us[line->stations[i]];
}

static double swap_us(const line_t *line, int32_t i) {
    return (double)line->tool->swap_us[line->stations[i]];
}

static double move_us(const line_t *line, int32_t from, int32_t to) {
    return (double)wh_flow_move_us(line->tool, 0, line->stations[from], line->stations[to]);
}

/* ------------------------------------------------------------------------------------------------ whether */

static const char *look_at_lots(const wh_flow_plan_t *plan) {
    for (size_t i = 0; i < plan->lot_count; ++i) {
        if (plan->lots[i].arrives_us > 0 || plan->lots[i].is_dummy) {
            return plan->lots[i].is_dummy ? "there are dummies" : "a lot arrives later";
        }
    }
    for (size_t w = 1; w < plan->wafer_count; ++w) {
        if (plan->wafers[w].recipe != plan->wafers[0].recipe) {
            return "wafers have several recipes";
        }
    }
    return NULL;
}

static const char *look_at_plan(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    if (tool->robot_count != 1) {
        return "there are several robots";
    }
    if (plan->rule != WH_FLOW_BACKWARD && plan->rule != WH_FLOW_SWAPPING) {
        return "the rule is neither backward nor swap";
    }
    if (plan->route_count != 1) {
        return "there are several routes";
    }
    if (plan->down_count > 0 || plan->takt_us > 0) {
        return plan->takt_us > 0                      ? "there is a takt"
               : plan->downs[0].robot == WH_FLOW_NONE ? "a station fails"
                                                      : "a robot is held";
    }
    return look_at_lots(plan);
}

/* True if a place is cleaned after each wafer of the recipe, or never. */
static bool is_cleaned_each(const wh_flow_station_t *of, int32_t recipe) {
    const wh_flow_treatment_t treatment = wh_flow_treatment(of, recipe);
    return treatment.clean_after <= 1 && treatment.idle_us == WH_FLOW_NEVER && of->idle_us == WH_FLOW_NEVER &&
           !of->cleans_full;
}

/* `recipe`: of the wafers that come there. */
static const char *look_at_station(const wh_flow_tool_t *tool, int32_t station, int32_t recipe) {
    const wh_flow_station_t *of = &tool->stations[station];
    const wh_flow_door_t *door = &tool->doors[station];
    if (of->has_carriers && of->is_absent) {
        return "carriers come while it goes on";
    }
    if (of->is_lock || door->open_us > 0 || door->close_us > 0) {
        return of->is_lock ? "there are load locks" : "there are doors";
    }
    return is_cleaned_each(of, recipe) ? NULL : "cleans come otherwise than after each wafer";
}

static int32_t recipe_in(const line_t *line, const wh_flow_step_t *step) {
    return step->recipe > 0 ? step->recipe : line->recipe;
}

static int32_t clean_after(const line_t *line, const wh_flow_step_t *step, const wh_flow_station_t *of) {
    return wh_flow_treatment(of, recipe_in(line, step)).clean_after;
}

/* Parallel stations take equally long. */
static const char *look_at_step(const line_t *line, const wh_flow_step_t *step) {
    const wh_flow_station_t *stations = line->tool->stations, *first = &stations[step->stations[0]];
    for (size_t k = 0; k < step->station_count; ++k) {
        const wh_flow_station_t *of = &stations[step->stations[k]];
        const char *why = look_at_station(line->tool, step->stations[k], recipe_in(line, step));
        if (why) {
            return why;
        }
        const bool is_as_first =
            wh_flow_step_us(step, of, line->recipe) == wh_flow_step_us(step, first, line->recipe) &&
            clean_after(line, step, of) == clean_after(line, step, first) && of->clean_us == first->clean_us;
        if (!is_as_first) {
            return "parallel stations take differently long";
        }
    }
    return step->second_arm ? "the second arm alone takes out of a step" : NULL;
}

/* True if a station of the step is in one before it. */
static bool is_back(const wh_flow_route_t *route, size_t index) {
    for (size_t i = 1; i < index; ++i) {
        for (size_t k = 0; k < route->steps[index].station_count; ++k) {
            if (wh_flow_step_has(&route->steps[i], route->steps[index].stations[k])) {
                return true;
            }
        }
    }
    return false;
}

static void take_step(line_t *line, int32_t index, const wh_flow_step_t *step) {
    const wh_flow_station_t *first = &line->tool->stations[step->stations[0]];
    line->stations[index] = step->stations[0];
    line->places[index] = 0;
    for (size_t k = 0; k < step->station_count; ++k) {
        line->places[index] += line->tool->stations[step->stations[k]].slots;
    }
    line->kept[index] = step->kept_empty;
    line->process[index] = (double)wh_flow_step_us(step, first, line->recipe);
    line->clean[index] = clean_after(line, step, first) > 0 ? (double)first->clean_us : 0;
}

/* The one station from which all lots come, or to which they go. */
static const char *take_end(line_t *line, int32_t index, int32_t station) {
    const char *why = look_at_station(line->tool, station, line->recipe);
    if (line->stations[index] != WH_FLOW_NONE && line->stations[index] != station) {
        return "lots come from several stations, or end in several ones";
    }
    line->stations[index] = station;
    return why ? why
           : wh_flow_treatment(&line->tool->stations[station], line->recipe).clean_after > 0
               ? "a first or last place is cleaned"
               : NULL;
}

static const char *take_ends(line_t *line, const wh_flow_plan_t *plan, bool goes_back) {
    const char *why = NULL;
    for (size_t w = 0; w < plan->wafer_count && !why; ++w) {
        const int32_t home = line->tool->place_stations[plan->wafers[w].home];
        why = take_end(line, 0, home);
        if (!why && goes_back) {
            why = take_end(line, line->n + 1, plan->wafers[w].back_station);
        }
    }
    return why;
}

/* Lots of one route either all go back, or none does. */
static bool do_all_alike(const wh_flow_plan_t *plan) {
    for (size_t w = 1; w < plan->wafer_count; ++w) {
        if (plan->wafers[w].goes_back != plan->wafers[0].goes_back) {
            return false;
        }
    }
    return true;
}

static const char *take_steps(line_t *line, const wh_flow_route_t *route) {
    for (int32_t i = 1; i < (int32_t)route->step_count; ++i) {
        const wh_flow_step_t *step = &route->steps[i];
        const char *why = look_at_step(line, step);
        if (why || is_back(route, (size_t)i)) {
            return why ? why : "the route comes back to a station";
        }
        take_step(line, i, step);
    }
    return NULL;
}

static const char *take_route(line_t *line, const wh_flow_plan_t *plan) {
    const wh_flow_route_t *route = &plan->routes[0];
    const bool goes_back = plan->wafers[0].goes_back;
    line->n = (int32_t)route->step_count - (goes_back ? 1 : 2);
    if (line->n < 1 || line->n > MOST) {
        return line->n < 1 ? "the route has no step that processes" : "the route has more than 16 steps";
    }
    if (!do_all_alike(plan)) {
        return "lots end in several ways";
    }
    if (!goes_back && route->steps[line->n + 1].station_count > 1) {
        return "wafers end in several stations";
    }
    line->stations[0] = line->stations[line->n + 1] = WH_FLOW_NONE;
    const char *why = take_steps(line, route);
    return why ? why : take_ends(line, plan, goes_back);
}

/* -------------------------------------------------------------------------------------------------- alike */

/* The route's stations, at most this many. */
#define MOST_STATIONS 256

/* Lists each station where the route goes; 0: there are too many. */
static size_t list_stations(const line_t *line, const wh_flow_route_t *route, int32_t list[]) {
    size_t count = 0;
    list[count++] = line->stations[0];
    list[count++] = line->stations[line->n + 1];
    for (int32_t i = 1; i <= line->n; ++i) {
        for (size_t k = 0; k < route->steps[i].station_count; ++k) {
            if (count == MOST_STATIONS) {
                return 0;
            }
            list[count++] = route->steps[i].stations[k];
        }
    }
    return count;
}

static bool is_as(const line_t *line, int32_t station, int32_t other) {
    const wh_flow_tool_t *tool = line->tool;
    const bool moves_so = station == other || wh_flow_move_us(tool, 0, station, other) == (int64_t)line->move;
    return moves_so && tool->pick_us[station] == tool->pick_us[other] &&
           tool->place_us[station] == tool->place_us[other] && tool->swap_us[station] == tool->swap_us[other];
}

/* True if all of the robot's times are the same at all stations where the route goes. */
static bool is_alike(const line_t *line, const wh_flow_route_t *route) {
    int32_t list[MOST_STATIONS];
    const size_t count = list_stations(line, route, list);
    for (size_t a = 0; a < count; ++a) {
        for (size_t b = 0; b < count; ++b) {
            if (!is_as(line, list[a], list[b])) {
                return false;
            }
        }
    }
    return count > 0;
}

/* True if no step is cleaned or has places that stay empty. */
static bool is_plain(const line_t *line) {
    for (int32_t i = 1; i <= line->n; ++i) {
        if (line->clean[i] > 0 || line->kept[i] > 0) {
            return false;
        }
    }
    return true;
}

static void compare_times(line_t *line, const wh_flow_route_t *route) {
    line->pick = pick_us(line, 0);
    line->place = place_us(line, 0);
    line->move = move_us(line, 0, 1);
    line->is_alike = is_alike(line, route);
    line->is_single = is_plain(line);
    for (int32_t i = 1; i <= line->n; ++i) {
        line->is_single = line->is_single && line->places[i] == 1;
    }
}

/* -------------------------------------------------------------------------------------------------- forms */

static void take_bound(wh_flow_textbook_t *found, double cycle_us, int32_t step) {
    if (cycle_us > found->cycle_us) {
        found->cycle_us = cycle_us;
        found->step = step;
    }
}

/* One arm, one place a step, all times as they are. */
static void find_single(const line_t *line, wh_flow_textbook_t *found) {
    double robot = move_us(line, 1, line->n);
    for (int32_t i = 0; i <= line->n; ++i) {
        robot += pick_us(line, i) + move_us(line, i, i + 1) + place_us(line, i + 1);
        robot += i > 0 ? move_us(line, i + 1, i - 1) : 0;
    }
    take_bound(found, robot, 0);
    for (int32_t i = 1; i <= line->n; ++i) {
        const double out = pick_us(line, i) + move_us(line, i, i + 1) + place_us(line, i + 1);
        const double in = pick_us(line, i - 1) + move_us(line, i - 1, i) + place_us(line, i);
        take_bound(found, line->process[i] + out + move_us(line, i + 1, i - 1) + in, i);
    }
}

/* True if no two neighbours are among the steps whose bits are set. */
static bool are_apart(uint32_t steps) {
    return (steps & (steps >> 1)) == 0;
}

/* One arm, all of the robot's times alike. */
static void find_alike(const line_t *line, wh_flow_textbook_t *found) {
    const double handled = line->pick + line->place, trip = handled + 2 * line->move;
    take_bound(found, (line->n + 1) * trip, 0);
    for (int32_t i = 1; i <= line->n; ++i) {
        take_bound(found, (line->process[i] + line->clean[i] + handled) / line->places[i], i);
        take_bound(found,
                   (line->process[i] + 2 * handled + 3 * line->move) / (line->places[i] - line->kept[i]), i);
    }
    for (uint32_t set = 1; set < (uint32_t)1 << line->n; ++set) {
        double busy = (line->n + 1) * trip, kept = 1;
        for (int32_t i = 1; i <= line->n && are_apart(set); ++i) {
            if (set >> (i - 1) & 1U) {
                busy += handled + line->move + line->clean[i] - 2 * trip;
                kept += line->kept[i];
            }
        }
        take_bound(found, are_apart(set) ? busy / kept : 0, 0);
    }
}

static void find_swap(const line_t *line, wh_flow_textbook_t *found) {
    double robot = pick_us(line, 0) + place_us(line, line->n + 1) + move_us(line, line->n + 1, 0);
    for (int32_t i = 0; i <= line->n; ++i) {
        robot += move_us(line, i, i + 1) + (i > 0 ? swap_us(line, i) : 0);
    }
    take_bound(found, robot, 0);
    for (int32_t i = 1; i <= line->n; ++i) {
        take_bound(found, (line->process[i] + swap_us(line, i)) / line->places[i], i);
    }
}

/* True if each step has one place in each of its stations. */
static bool has_single_slots(const line_t *line, const wh_flow_route_t *route) {
    for (int32_t i = 1; i <= line->n; ++i) {
        if (line->places[i] != (int32_t)route->steps[i].station_count) {
            return false;
        }
    }
    return true;
}

/* With one arm. */
static const char *find_backward(const line_t *line, const wh_flow_plan_t *plan, wh_flow_textbook_t *found) {
    const bool comes_back = line->stations[0] == line->stations[line->n + 1];
    if (line->is_single) {
        find_single(line, found);
    } else if (line->n == 1 && (comes_back || !has_single_slots(line, &plan->routes[0]))) {
        return "the one step has several slots, or wafers go back to where they came from";
    } else {
        find_alike(line, found);
    }
    return NULL;
}

static const char *find_form(const line_t *line, const wh_flow_plan_t *plan, wh_flow_textbook_t *found) {
    const bool swaps = plan->rule == WH_FLOW_SWAPPING && line->tool->robots[0].arms > 1;
    if (swaps && !is_plain(line)) {
        return "with swap there are cleans, or places that stay empty";
    }
    if (!line->is_single && !line->is_alike) {
        return "times differ by station, and steps have several places, or cleans";
    }
    if (!swaps) {
        return find_backward(line, plan, found);
    }
    find_swap(line, found);
    return NULL;
}

wh_flow_textbook_t wh_flow_textbook(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    line_t line = {.tool = tool, .recipe = plan->wafer_count > 0 ? plan->wafers[0].recipe : 0};
    wh_flow_textbook_t found = {.cycle_us = -1};
    found.why = look_at_plan(tool, plan);
    found.why = found.why ? found.why : take_route(&line, plan);
    if (!found.why) {
        compare_times(&line, &plan->routes[0]);
        found.why = find_form(&line, plan, &found);
    }
    if (!found.why && found.cycle_us <= 0) {
        found.why = "all times are 0";
    }
    if (found.why) {
        found.cycle_us = -1;
    }
    return found;
}
