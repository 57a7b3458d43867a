/* A plot of the shares of time of a flow's stations and robots: each bar adds up to 100 %. */
#include "../flow/figures.h"
#include "lanes.h"

/* The classes in the order of the plot; what is not among them stays white. */
typedef struct {
    int stations[3], robots[4]; /* classes; -1: none */
    wh_plot_look_t look;
} kind_t;

static const kind_t kinds[] = {
    {{WH_FLOW_STATION_PROCESS, -1, -1},
     {WH_FLOW_ROBOT_PICK, WH_FLOW_ROBOT_PLACE, WH_FLOW_ROBOT_SWAP, -1},
     {"process; pick, place, swap", "#606060", "solid", true}},
    {{WH_FLOW_STATION_HANDLED, -1, -1},
     {WH_FLOW_ROBOT_LOADED_WAY, WH_FLOW_ROBOT_EMPTY_WAY, WH_FLOW_ROBOT_DOOR, -1},
     {"blade or door; move", "#a8a8a8", "solid", true}},
    {{WH_FLOW_STATION_CLEAN, WH_FLOW_STATION_PUMP, -1},
     {-1, -1, -1, -1},
     {"clean, pump", "#2b6b2b", "pattern 4", true}},
    {{WH_FLOW_STATION_BLOCKED, -1, -1},
     {WH_FLOW_ROBOT_WAITS_WAFER, WH_FLOW_ROBOT_WAITS_PLACE, WH_FLOW_ROBOT_WAITS_ROBOT, -1},
     {"waits", "#000000", "pattern 2", true}},
    {{WH_FLOW_STATION_DOWN, -1, -1},
     {WH_FLOW_ROBOT_WAITS_CLEAN, WH_FLOW_ROBOT_WAITS_PUMP, WH_FLOW_ROBOT_WAITS_DOWN, -1},
     {"down; waits for clean, pump, failure", "#9c1c1c", "pattern 5", true}},
    {{WH_FLOW_STATION_STORED, -1, -1}, {-1, -1, -1, -1}, {"holds wafers", "#e4e4e4", "solid", true}}};

#define KINDS (sizeof kinds / sizeof kinds[0])

static double sum(const double us[], const int classes[], size_t count, double all_us) {
    double percent = 0;
    for (size_t i = 0; i < count && classes[i] >= 0; ++i) {
        percent += 100 * us[classes[i]] / all_us;
    }
    return percent;
}

/* The kind's share of what a lane shows: stations first, then robots. */
static double share_of(const wh_flow_figures_t *figures, size_t lane, size_t kind) {
    const size_t stations = figures->tool->station_count;
    if (lane < stations) {
        const double all_us = (double)figures->end_us * figures->tool->stations[lane].slots;
        return sum(figures->stations[lane], kinds[kind].stations, 3, all_us);
    }
    return sum(figures->robots[lane - stations], kinds[kind].robots, 4, (double)figures->end_us);
}

static size_t put_kind(wh_plot_lanes_t *lanes, const wh_flow_figures_t *figures, size_t kind) {
    wh_plot_block(&lanes->plot, kinds[kind].look.text, "from (%), to (%), lane");
    for (size_t lane = 0; lane < lanes->count; ++lane) {
        double begin = 0;
        for (size_t before = 0; before < kind; ++before) {
            begin += share_of(figures, lane, before);
        }
        const double share = share_of(figures, lane, kind);
        if (share > 0) {
            wh_plot_lanes_bar(lanes, lane, begin, begin + share);
        }
    }
    return wh_plot_end_block(&lanes->plot);
}

static void draw(wh_plot_lanes_t *lanes, const wh_flow_figures_t *figures) {
    size_t blocks[KINDS];
    for (size_t s = 0; s < figures->tool->station_count; ++s) {
        wh_plot_lanes_name(lanes, figures->tool->stations[s].name, "");
    }
    for (size_t r = 0; r < figures->tool->robot_count; ++r) {
        wh_plot_lanes_name(lanes, figures->tool->robots[r].name, "");
    }
    wh_plot_lanes_begin(lanes, "Shares of the time of a flow's stations and robots");
    wh_plot_axis(&lanes->plot, "%");
    for (size_t kind = 0; kind < KINDS; ++kind) {
        blocks[kind] = put_kind(lanes, figures, kind);
    }
    for (size_t kind = 0; kind < KINDS; ++kind) {
        wh_plot_lanes_draw(lanes, blocks[kind], &kinds[kind].look);
    }
}

void wh_plots_shares(wh_plots_t *plots) {
    const wh_flow_t *flow = plots->document->record->flow;
    const double begin_s = plots->begin_s, end_s = plots->end_s;
    if (!flow || !flow->figures.tool || flow->figures.end_us == 0) {
        return;
    }
    wh_plot_lanes_t lanes;
    plots->begin_s = 0; /* the axis is not time */
    plots->end_s = 100;
    if (wh_plot_lanes_open(&lanes, plots, "shares",
                           flow->figures.tool->station_count + flow->figures.tool->robot_count)) {
        lanes.above = 44;
        draw(&lanes, &flow->figures);
        wh_plot_lanes_end(&lanes);
    }
    plots->begin_s = begin_s;
    plots->end_s = end_s;
}
