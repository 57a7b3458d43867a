/* Plots of lanes over time: signals, who holds what, commands and what the time goes into. */
#include <stdlib.h>

#include "../record/throughput.h"
#include "document_internal.h"
#include "gnuplot_curves.h"
#include "gnuplot_lanes.h"

/* ------------------------------------------------------------------------------------------------- signals */

/* Of 0 and 1; the last value goes on to the end. */
static size_t put_steps(const wh_plots_t *plots, wh_plot_t *plot, const wh_steps_t *steps, bool inverted) {
    double value = 0;
    for (size_t i = 0; i < steps->count; ++i) {
        value = inverted ? 1 - steps->steps[i].value : steps->steps[i].value;
        wh_plot_row(plot, wh_document_seconds(plots->document->signals, steps->steps[i].slice), &value, 1);
    }
    if (steps->count > 0) {
        wh_plot_row(plot, wh_plots_end_s(plots), &value, 1);
    }
    return wh_plot_end_block(plot);
}

static void put_gripper_signals(const wh_plots_t *plots, wh_lanes_t *lanes, size_t g) {
    const wh_signals_t *signals = plots->document->signals;
    const wh_plot_curves_t level = {{&signals->vacuum[g]}, 1, 1, false, NULL};
    const char *name = signals->layout->grippers[g].name;
    wh_plot_block(lanes->plot, name, "t (s), valve is open");
    wh_lanes_draw_signal(lanes, put_steps(plots, lanes->plot, &signals->valves[g], true), 3 * g, "steps");
    wh_plot_block(lanes->plot, name, "t (s), vacuum from 0 to 1");
    wh_lanes_draw_signal(lanes, wh_plot_curves(lanes->plot, &level, wh_plots_slice_s(plots)), 3 * g + 1,
                         "lines");
    wh_plot_block(lanes->plot, name, "t (s), vacuum sensor is on");
    wh_lanes_draw_signal(lanes, put_steps(plots, lanes->plot, &signals->sensors[g], false), 3 * g + 2,
                         "steps");
}

void wh_plots_signals(wh_plots_t *plots) {
    const wh_layout_t *layout = plots->document->signals->layout;
    const size_t grippers = layout->machine.gripper_count;
    wh_lanes_t lanes;
    wh_plot_t plot;
    if (!wh_plots_open(plots, &plot, "valves_and_vacuum", NULL)) {
        return;
    }
    wh_lanes_open(&lanes, &plot, 3 * grippers);
    for (size_t g = 0; g < grippers; ++g) {
        wh_lanes_name(&lanes, layout->grippers[g].name, "valve open");
        wh_lanes_name(&lanes, layout->grippers[g].name, "vacuum");
        wh_lanes_name(&lanes, layout->grippers[g].name, "sensor on");
    }
    wh_lanes_begin(&lanes, plots, "Valves, vacuum and its sensors: high is open, full, on");
    for (size_t g = 0; g < grippers; ++g) {
        put_gripper_signals(plots, &lanes, g);
    }
    wh_lanes_end(&lanes);
    wh_plots_close(plots, &plot);
}

/* ------------------------------------------------------------------------------------------------- holders */

static void put_holds(const wh_plots_t *plots, wh_lanes_t *lanes, size_t g) {
    const wh_layout_t *layout = plots->document->signals->layout;
    size_t count = 0;
    wh_plot_hold_t *holds = wh_plots_holds(plots, (int32_t)g, &count);
    for (size_t i = 0; i < count; ++i) {
        wh_lanes_bar(lanes, g, holds[i].begin_s, holds[i].end_s);
        wh_lanes_label(lanes, g, holds[i].begin_s, holds[i].end_s, layout->wafers[holds[i].wafer].name,
                       false);
    }
    free(holds);
}

void wh_plots_holders(wh_plots_t *plots) {
    static const wh_lanes_look_t look = {NULL, "#d8d8d8", "solid", false};
    const wh_layout_t *layout = plots->document->signals->layout;
    const size_t grippers = layout->machine.gripper_count;
    wh_lanes_t lanes;
    wh_plot_t plot;
    if (!wh_plots_open(plots, &plot, "holders", NULL)) {
        return;
    }
    wh_lanes_open(&lanes, &plot, grippers);
    for (size_t g = 0; g < grippers; ++g) {
        wh_lanes_name(&lanes, layout->grippers[g].name, "holds");
    }
    wh_lanes_begin(&lanes, plots, "Who holds which wafer");
    wh_plot_block(&plot, "holds", "from (s), to (s), lane");
    for (size_t g = 0; g < grippers; ++g) {
        put_holds(plots, &lanes, g);
    }
    wh_lanes_draw_bars(&lanes, wh_plot_end_block(&plot), &look);
    wh_lanes_end(&lanes);
    wh_plots_close(plots, &plot);
}

/* ------------------------------------------------------------------------------------------------ commands */

/* Of commands: every other one, so that neighbours can be told apart, and those that failed. */
enum { EVEN, ODD, FAILED, COMMANDS };

static const wh_lanes_look_t command_looks[COMMANDS] = {{NULL, "#ffffff", "solid", false},
                                                        {NULL, "#e4e4e4", "solid", false},
                                                        {"failed", "#000000", "solid", true}};

static int look_of(const wh_record_t *record, size_t command) {
    return record->commands[command].error != WH_OK ? FAILED : command % 2 == 0 ? EVEN : ODD;
}

static size_t put_commands(wh_lanes_t *lanes, const wh_record_t *record, int look) {
    wh_plot_block(lanes->plot, look == FAILED ? "commands that failed" : "commands",
                  "from (s), to (s), lane");
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        if (look_of(record, i) == look) {
            wh_lanes_bar(lanes, 0, command->begin_s, command->end_s);
            wh_lanes_label(lanes, 0, command->begin_s, command->end_s, command->text, look == FAILED);
        }
    }
    return wh_plot_end_block(lanes->plot);
}

static const wh_lanes_look_t share_looks[WH_SHARES] = {
    [WH_SHARE_LOADED] = {"loaded", "#606060", "solid", false},
    [WH_SHARE_EMPTY] = {"empty", "#c8c8c8", "solid", false},
    [WH_SHARE_VACUUM] = {"vacuum", "#000000", "hatched", false},
    [WH_SHARE_HANDOVER] = {"hand-over", "#000000", "crossed", false},
    [WH_SHARE_WAITING] = {"waiting", "#ffffff", "solid", false}};

/* The robot has the lane below the commands', then come the chucks that turn. SIZE_MAX: none. */
typedef struct {
    size_t of[WH_GRIPPERS];
    size_t count;
} chuck_lanes_t;

static chuck_lanes_t find_chucks(const wh_activity_t *activity, size_t grippers) {
    chuck_lanes_t lanes = {.count = 0};
    for (size_t g = 0; g < grippers; ++g) {
        lanes.of[g] = SIZE_MAX;
        for (size_t i = 0; i < activity->interval_count && lanes.of[g] == SIZE_MAX; ++i) {
            const wh_busy_span_t *interval = &activity->intervals[i];
            if (interval->who == WH_BUSY_CHUCK && interval->gripper == (int32_t)g) {
                lanes.of[g] = 2 + lanes.count++;
            }
        }
    }
    return lanes;
}

static size_t put_shares(wh_lanes_t *lanes, const wh_record_t *record, const chuck_lanes_t *chucks,
                         int share) {
    wh_plot_block(lanes->plot, share_looks[share].text, "from (s), to (s), lane");
    for (size_t i = 0; i < record->activity.interval_count; ++i) {
        const wh_busy_span_t *interval = &record->activity.intervals[i];
        const bool moves = interval->who == WH_BUSY_ROBOT || interval->who == WH_BUSY_CHUCK;
        if (moves && interval->what == 1 + share) {
            const size_t lane = interval->who == WH_BUSY_ROBOT ? 1 : chucks->of[interval->gripper];
            wh_lanes_bar(lanes, lane, wh_throughput_seconds(record, interval->begin),
                         wh_throughput_seconds(record, interval->end));
        }
    }
    return wh_plot_end_block(lanes->plot);
}

/* Blocks first, then what draws them: labels must not come within a plot command. */
static void draw_commands(wh_lanes_t *lanes, const wh_record_t *record, const chuck_lanes_t *chucks) {
    size_t blocks[COMMANDS + WH_SHARES];
    for (int look = 0; look < COMMANDS; ++look) {
        blocks[look] = put_commands(lanes, record, look);
    }
    for (int share = 0; share < WH_SHARES; ++share) {
        blocks[COMMANDS + share] = put_shares(lanes, record, chucks, share);
    }
    for (int i = 0; i < COMMANDS + WH_SHARES; ++i) {
        wh_lanes_draw_bars(lanes, blocks[i], i < COMMANDS ? &command_looks[i] : &share_looks[i - COMMANDS]);
    }
}

void wh_plots_commands(wh_plots_t *plots) {
    const wh_record_t *record = plots->document->record;
    const wh_layout_t *layout = plots->document->signals->layout;
    const chuck_lanes_t chucks = find_chucks(&record->activity, layout->machine.gripper_count);
    const bool has_any = record->command_count > 0 || record->activity.interval_count > 0;
    wh_lanes_t lanes;
    wh_plot_t plot;
    if (!has_any || !wh_plots_open(plots, &plot, "commands", NULL)) {
        return;
    }
    wh_lanes_open(&lanes, &plot, 2 + chucks.count);
    lanes.above = 20;
    wh_lanes_name(&lanes, "commands", "");
    wh_lanes_name(&lanes, "robot", "");
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (chucks.of[g] != SIZE_MAX) {
            wh_lanes_name(&lanes, layout->grippers[g].name, "chuck");
        }
    }
    wh_lanes_begin(&lanes, plots, "Commands, and what the robot's and the chucks' time goes into");
    draw_commands(&lanes, record, &chucks);
    wh_lanes_end(&lanes);
    wh_plots_close(plots, &plot);
}
