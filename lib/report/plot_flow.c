/* Plots of a flow: stations and robots over time with wafers' names, and the shares of their time. */
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "lanes.h"

/* A station with more places has one lane that tells how full it is. */
#define MOST_PLACES 6

enum { WAITS, CLEAN, PUMP, DOWN, CARRIED, PROCESS, HANDLED, LOOKS }; /* the later one is on top */

static const wh_plot_look_t looks[LOOKS] = {[WAITS] = {"waits", "#d0d0d0", "solid", false},
                                            [CARRIED] = {"is carried", "#909090", "solid", false},
                                            [PROCESS] = {"process", "#ffffff", "solid", false},
                                            [HANDLED] = {"blade or door", "#000000", "hatched", false},
                                            [CLEAN] = {"clean", "#2b6b2b", "crossed", false},
                                            [PUMP] = {"pump", "#404080", "hatched", false},
                                            [DOWN] = {"down", "#9c1c1c", "solid", true}};

typedef struct {
    int look;
    size_t lane;
    double begin, end;
    const char *text; /* or null */
} bar_t;

/* A wafer more or less in a place of a station with many. */
typedef struct {
    int32_t place, by;
    int64_t at_us;
} change_t;

typedef struct {
    const wh_flow_figures_t *figures;
    size_t *lanes;    /* by place its lane */
    size_t *arms;     /* by robot its first lane */
    int32_t *arm_max; /* by robot the arms that it used */
    int32_t *next;    /* by visit the wafer's next one, or WH_FLOW_NONE */
    bar_t *bars;
    size_t count, capacity, lane_count;
} flow_t;

static double seconds(int64_t us) {
    return (double)us / 1e6;
}

/* ------------------------------------------------------------------------------------------------- lanes */

static void number_lanes(flow_t *flow) {
    const wh_flow_tool_t *tool = flow->figures->tool;
    for (size_t s = 0; s < tool->station_count; ++s) {
        const wh_flow_station_t *of = &tool->stations[s];
        for (int32_t k = 0; k < of->slots; ++k) {
            flow->lanes[of->first_place + k] = flow->lane_count + (of->slots > MOST_PLACES ? 0 : (size_t)k);
        }
        flow->lane_count += of->slots > MOST_PLACES ? 1 : (size_t)of->slots;
    }
    for (size_t v = 0; v < flow->figures->visit_count; ++v) {
        const wh_flow_visit_t *visit = &flow->figures->visits[v];
        if (visit->arm + 1 > flow->arm_max[visit->robot]) {
            flow->arm_max[visit->robot] = visit->arm + 1;
        }
    }
    for (size_t r = 0; r < tool->robot_count; ++r) {
        flow->arm_max[r] = flow->arm_max[r] > 0 ? flow->arm_max[r] : 1;
        flow->arms[r] = flow->lane_count;
        flow->lane_count += (size_t)flow->arm_max[r];
    }
}

static void name_lanes(const flow_t *flow, wh_plot_lanes_t *lanes) {
    const wh_flow_tool_t *tool = flow->figures->tool;
    char number[16];
    for (size_t s = 0; s < tool->station_count; ++s) {
        const wh_flow_station_t *of = &tool->stations[s];
        for (int32_t k = 0; k < (of->slots > MOST_PLACES ? 1 : of->slots); ++k) {
            (void)snprintf(number, sizeof number, "%d", (int)k + 1);
            wh_plot_lanes_name(lanes, of->name, of->slots > 1 && of->slots <= MOST_PLACES ? number : "");
        }
    }
    for (size_t r = 0; r < tool->robot_count; ++r) {
        for (int32_t arm = 0; arm < flow->arm_max[r]; ++arm) {
            (void)snprintf(number, sizeof number, "%d", (int)arm + 1);
            wh_plot_lanes_name(lanes, tool->robots[r].name, flow->arm_max[r] > 1 ? number : "");
        }
    }
}

/* -------------------------------------------------------------------------------------------------- bars */

/* Times that have not come are the end. */
static void add_bar(flow_t *flow, int look, size_t lane, int64_t begin_us, int64_t end_us, const char *text) {
    const int64_t last_us = flow->figures->end_us;
    if (begin_us < last_us && end_us > begin_us) {
        flow->bars = wh_array_grow(flow->bars, flow->count, &flow->capacity, sizeof *flow->bars);
        flow->bars[flow->count++] =
            (bar_t){look, lane, seconds(begin_us), seconds(end_us < last_us ? end_us : last_us), text};
    }
}

static bool has_own_lane(const flow_t *flow, int32_t place) {
    const wh_flow_tool_t *tool = flow->figures->tool;
    return tool->stations[tool->place_stations[place]].slots <= MOST_PLACES;
}

/* A wafer in its place: it is placed, its door shuts, it is processed, it waits, it is picked. */
static void add_stay(flow_t *flow, const wh_flow_visit_t *visit, const wh_flow_visit_t *next) {
    const char *name = flow->figures->plan->wafers[visit->wafer].name;
    const size_t lane = flow->lanes[visit->place];
    const int64_t taken_us = next ? next->pick_us : WH_FLOW_NEVER;
    const bool is_processed = visit->process_us != WH_FLOW_NEVER;
    const int64_t begun_us = is_processed ? visit->process_us : visit->placed_us;
    const int64_t free_us = is_processed ? visit->done_us : visit->placed_us;
    add_bar(flow, HANDLED, lane, visit->place_us, begun_us, NULL);
    add_bar(flow, PROCESS, lane, begun_us, free_us, name);
    add_bar(flow, WAITS, lane, free_us, taken_us, is_processed ? NULL : name);
    if (next) {
        add_bar(flow, HANDLED, lane, taken_us, next->picked_us, NULL);
    }
}

static void add_visits(flow_t *flow) {
    const wh_flow_figures_t *figures = flow->figures;
    for (size_t v = 0; v < figures->visit_count; ++v) {
        const wh_flow_visit_t *visit = &figures->visits[v];
        const size_t lane = flow->arms[visit->robot] + (size_t)visit->arm;
        const char *name = figures->plan->wafers[visit->wafer].name;
        add_bar(flow, HANDLED, lane, visit->pick_us, visit->picked_us, NULL);
        add_bar(flow, CARRIED, lane, visit->picked_us, visit->place_us, name);
        add_bar(flow, HANDLED, lane, visit->place_us, visit->placed_us, NULL);
        if (visit->place != WH_FLOW_NONE && has_own_lane(flow, visit->place)) {
            const int32_t next = flow->next[v];
            add_stay(flow, visit, next == WH_FLOW_NONE ? NULL : &figures->visits[next]);
        }
    }
}

static void add_doings(flow_t *flow) {
    const wh_flow_figures_t *figures = flow->figures;
    for (size_t i = 0; i < figures->doing_count; ++i) {
        const wh_flow_doing_t *doing = &figures->doings[i];
        const wh_flow_station_t *of = &figures->tool->stations[doing->station];
        if (doing->kind == WH_FLOW_EVENT_COMES || doing->kind == WH_FLOW_EVENT_GOES) {
            continue;
        }
        const int look = doing->kind == WH_FLOW_EVENT_CLEAN  ? CLEAN
                         : doing->kind == WH_FLOW_EVENT_DOWN ? DOWN
                                                             : PUMP;
        for (int32_t place = of->first_place; place < of->first_place + of->slots; ++place) {
            const bool is_here = doing->place == WH_FLOW_NONE || doing->place == place;
            if (is_here && has_own_lane(flow, place)) {
                add_bar(flow, look, flow->lanes[place], doing->begin_us, doing->end_us, NULL);
            }
        }
    }
}

/* Visits are in the order in which they end, so those of a wafer are in order. */
static void find_next(flow_t *flow) {
    const wh_flow_figures_t *figures = flow->figures;
    int32_t *last = wh_array_new(figures->plan->wafer_count + 1, sizeof *last);
    memset(last, 0xff, (figures->plan->wafer_count + 1) * sizeof *last);
    for (size_t v = 0; v < figures->visit_count; ++v) {
        const int32_t wafer = figures->visits[v].wafer;
        flow->next[v] = WH_FLOW_NONE;
        if (last[wafer] != WH_FLOW_NONE) {
            flow->next[last[wafer]] = (int32_t)v;
        }
        last[wafer] = (int32_t)v;
    }
    free(last);
}

/* ------------------------------------------------------------------------------------------------ levels */

static int by_time(const void *a, const void *b) {
    const change_t *one = a, *other = b;
    if (one->at_us != other->at_us) {
        return one->at_us < other->at_us ? -1 : 1;
    }
    return one->by != other->by ? one->by - other->by : one->place - other->place;
}

/* All comings and goings in places of this station. */
static change_t *list_changes(const flow_t *flow, int32_t station, size_t *count) {
    const wh_flow_figures_t *figures = flow->figures;
    const int32_t *stations = figures->tool->place_stations;
    change_t *changes =
        wh_array_new(2 * figures->visit_count + figures->plan->wafer_count + 1, sizeof *changes);
    *count = 0;
    for (size_t w = 0; w < figures->plan->wafer_count; ++w) {
        const int32_t home = figures->plan->wafers[w].home;
        if (stations[home] == station && figures->came_us[w] != WH_FLOW_NEVER) {
            changes[(*count)++] = (change_t){home, 1, figures->came_us[w]};
        }
    }
    for (size_t v = 0; v < figures->visit_count; ++v) {
        const wh_flow_visit_t *visit = &figures->visits[v];
        if (stations[visit->from] == station && visit->picked_us != WH_FLOW_NEVER) {
            changes[(*count)++] = (change_t){visit->from, -1, visit->picked_us};
        }
        if (visit->place != WH_FLOW_NONE && stations[visit->place] == station &&
            visit->placed_us != WH_FLOW_NEVER) {
            changes[(*count)++] = (change_t){visit->place, 1, visit->placed_us};
        }
    }
    qsort(changes, *count, sizeof *changes, by_time);
    return changes;
}

/* How full the station is. A carrier may be taken away, and others come into its places. */
static size_t put_level(const flow_t *flow, wh_plot_lanes_t *lanes, int32_t station) {
    const wh_flow_station_t *of = &flow->figures->tool->stations[station];
    bool *is_full = wh_array_new((size_t)of->slots, sizeof *is_full);
    size_t count = 0;
    double level = 0;
    change_t *changes = list_changes(flow, station, &count);
    wh_plot_block(&lanes->plot, of->name, "t (s), share of its places that are full");
    wh_plot_row(&lanes->plot, 0, &level, 1);
    for (size_t i = 0; i < count; ++i) {
        bool *at = &is_full[changes[i].place - of->first_place];
        if (*at != (changes[i].by > 0)) {
            level += (double)changes[i].by / of->slots;
            *at = changes[i].by > 0;
            wh_plot_row(&lanes->plot, seconds(changes[i].at_us), &level, 1);
        }
    }
    wh_plot_row(&lanes->plot, seconds(flow->figures->end_us), &level, 1);
    free(changes);
    free(is_full);
    return wh_plot_end_block(&lanes->plot);
}

/* ------------------------------------------------------------------------------------------------- whole */

static size_t put_bars(const flow_t *flow, wh_plot_lanes_t *lanes, int look) {
    wh_plot_block(&lanes->plot, looks[look].text, "from (s), to (s), lane");
    for (size_t i = 0; i < flow->count; ++i) {
        const bar_t *bar = &flow->bars[i];
        if (bar->look == look) {
            wh_plot_lanes_bar(lanes, bar->lane, bar->begin, bar->end);
            if (bar->text) {
                wh_plot_lanes_label(lanes, bar->lane, bar->begin, bar->end, bar->text, false);
            }
        }
    }
    return wh_plot_end_block(&lanes->plot);
}

/* Blocks come first, then what draws them. */
static void draw(const flow_t *flow, wh_plot_lanes_t *lanes) {
    const wh_flow_tool_t *tool = flow->figures->tool;
    size_t blocks[LOOKS];
    size_t *levels = wh_array_new(tool->station_count, sizeof *levels);
    for (int look = 0; look < LOOKS; ++look) {
        blocks[look] = put_bars(flow, lanes, look);
    }
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        levels[s] = tool->stations[s].slots > MOST_PLACES ? put_level(flow, lanes, s) : SIZE_MAX;
    }
    for (int look = 0; look < LOOKS; ++look) {
        wh_plot_lanes_draw(lanes, blocks[look], &looks[look]);
    }
    for (size_t s = 0; s < tool->station_count; ++s) {
        wh_plot_lanes_signal(lanes, levels[s], flow->lanes[tool->stations[s].first_place], "steps");
    }
    free(levels);
}

void wh_plots_flow(wh_plots_t *plots) {
    const wh_flow_t *of = plots->document->record->flow;
    if (!of || !of->figures.tool || !of->figures.came_us || of->figures.end_us == 0) {
        return;
    }
    const wh_flow_figures_t *figures = &of->figures;
    flow_t flow = {.figures = figures,
                   .lanes = wh_array_new(figures->tool->place_count, sizeof *flow.lanes),
                   .arms = wh_array_new(figures->tool->robot_count, sizeof *flow.arms),
                   .arm_max = wh_array_new(figures->tool->robot_count, sizeof *flow.arm_max),
                   .next = wh_array_new(figures->visit_count + 1, sizeof *flow.next)};
    wh_plot_lanes_t lanes;
    number_lanes(&flow);
    find_next(&flow);
    add_visits(&flow);
    add_doings(&flow);
    if (wh_plot_lanes_open(&lanes, plots, "flow", flow.lane_count)) {
        lanes.above = 44;
        name_lanes(&flow, &lanes);
        wh_plot_lanes_begin(&lanes, "Stations and robots of a flow, with wafers' names");
        draw(&flow, &lanes);
        wh_plot_lanes_end(&lanes);
    }
    free(flow.lanes);
    free(flow.arms);
    free(flow.arm_max);
    free(flow.next);
    free(flow.bars);
}
