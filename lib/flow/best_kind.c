/* The kind of flow for which the best schedule is searched. */
#include <stdio.h>
#include <stdlib.h>

#include "../text/array.h"
#include "best_internal.h"

/* `name`: of what is not of the kind; null: the whole is not. */
static char *refuse(const char *name, const char *why) {
    char text[300];
    (void)snprintf(text, sizeof text, "%s%sa search takes %s", name ? name : "", name ? ": " : "", why);
    return wh_text_copy(text);
}

static bool has_door(const wh_flow_tool_t *tool, int32_t station) {
    bool has = false;
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        const wh_flow_door_t *door = &tool->doors[wh_flow_of(tool, r, station)];
        has = has || door->open_us > 0 || door->close_us > 0;
    }
    return has;
}

static size_t count_robots(const wh_flow_tool_t *tool, int32_t station) {
    size_t robots = 0;
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        robots += tool->serves[wh_flow_of(tool, r, station)] ? 1 : 0;
    }
    return robots;
}

static char *refuse_stations(const wh_flow_tool_t *tool) {
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        const wh_flow_station_t *station = &tool->stations[s];
        if (station->has_carriers) {
            return refuse(station->name, "load ports without `port`");
        }
        if (station->is_lock || wh_flow_is_cleaned(station) || station->window_us != WH_FLOW_NEVER) {
            return refuse(station->name, "stations without pump, clean and window");
        }
        if (has_door(tool, s)) {
            return refuse(station->name, "stations without a door");
        }
        if (station->slots > 1 && count_robots(tool, s) > 1) {
            return refuse(station->name, "stations of one slot where several robots come");
        }
    }
    return NULL;
}

int32_t wh_best_places(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, bool used[]) {
    int32_t count = 0;
    for (size_t i = 0; i < plan->route_count; ++i) {
        for (size_t k = 1; k < plan->routes[i].step_count; ++k) {
            const wh_flow_step_t *step = &plan->routes[i].steps[k];
            for (size_t s = 0; s < step->station_count; ++s) {
                used[step->stations[s]] = used[step->stations[s]] || k + 1 < plan->routes[i].step_count;
            }
        }
    }
    for (size_t s = 0; s < tool->station_count; ++s) {
        count += used[s] ? tool->stations[s].slots : 0;
    }
    return count;
}

static char *refuse_wafers(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const bool used[]) {
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        const wh_flow_step_t *end = wh_flow_step_of(plan, w, wh_flow_last_step(plan, w));
        const int32_t home = tool->place_stations[plan->wafers[w].home];
        bool has_room = end->station_count == 1 && !used[end->stations[0]] && !used[home] &&
                        tool->stations[end->stations[0]].slots >= (int32_t)plan->wafer_count;
        if (!has_room || plan->wafers[w].back != WH_FLOW_NONE || end->stations[0] == home) {
            return refuse(
                plan->wafers[w].name,
                "routes that begin in one station and end in another, which has room for all wafers");
        }
        if (plan->lots[plan->wafers[w].lot].arrives_us > 0) {
            return refuse(plan->wafers[w].name, "lots that are there at 0 s");
        }
    }
    return NULL;
}

static char *refuse_steps(const wh_flow_plan_t *plan) {
    for (size_t i = 0; i < plan->route_count; ++i) {
        for (size_t k = 1; k < plan->routes[i].step_count; ++k) {
            const wh_flow_step_t *step = &plan->routes[i].steps[k];
            if (step->kept_empty > 0 || step->second_arm) {
                return refuse(plan->routes[i].name, "routes without `partial` and `hot`");
            }
        }
    }
    return NULL;
}

static char *refuse_size(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, int32_t places) {
    if (plan->wafer_count > WH_BEST_WAFERS || tool->robot_count > WH_BEST_ROBOTS || places > WH_BEST_PLACES ||
        tool->station_count > INT16_MAX) {
        return refuse(NULL, "at most 8 wafers, 4 robots and 24 places");
    }
    if (wh_flow_has_real(tool)) {
        return refuse(NULL, "robots that are times alone: how long those with axes take is not known");
    }
    if (plan->down_count > 0 || plan->takt_us > 0 || plan->until_us != WH_FLOW_NEVER) {
        return refuse(NULL, "flows without `down`, `takt` and `until_s`");
    }
    return NULL;
}

char *wh_flow_best_refuses(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    bool *used = wh_array_new(tool->station_count, sizeof *used);
    char *why = refuse_size(tool, plan, wh_best_places(tool, plan, used));
    why = why ? why : refuse_stations(tool);
    why = why ? why : refuse_steps(plan);
    why = why ? why : refuse_wafers(tool, plan, used);
    free(used);
    return why;
}
