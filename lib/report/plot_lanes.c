/* Plots of lanes over time: signals, holders, commands, and how the time is spent. */
#include <stdlib.h>

#include "../record/packing.h"
#include "../record/throughput.h"
#include "../text/array.h"
#include "lanes.h"
#include "plots_internal.h"

/* ------------------------------------------------------------------------------------------------ signals */

/* Writes steps of 0 and 1. The last value goes on to the end. */
static size_t put_steps(wh_plot_lanes_t *lanes, const wh_steps_t *steps, bool inverted) {
    const wh_signals_t *signals = lanes->plots->document->signals;
    double value = 0;
    for (size_t i = 0; i < steps->count; ++i) {
        value = inverted ? 1 - steps->steps[i].value : steps->steps[i].value;
        wh_plot_row(&lanes->plot, wh_signals_seconds(signals, steps->steps[i].slice), &value, 1);
    }
    if (steps->count > 0) {
        wh_plot_row(&lanes->plot, lanes->plots->end_s, &value, 1);
    }
    return wh_plot_end_block(&lanes->plot);
}

static void put_gripper_signals(wh_plot_lanes_t *lanes, size_t g) {
    const wh_signals_t *signals = lanes->plots->document->signals;
    const wh_plot_curves_t level = {{&signals->vacuum[g]}, 1, 1, false, NULL};
    const char *name = signals->layout->grippers[g].name;
    wh_plot_block(&lanes->plot, name, "t (s), valve is open");
    wh_plot_lanes_signal(lanes, put_steps(lanes, &signals->valves[g], true), 3 * g, "steps");
    wh_plot_block(&lanes->plot, name, "t (s), vacuum from 0 to 1");
    wh_plot_lanes_signal(lanes, wh_plot_curves(&lanes->plot, &level, wh_signals_seconds(signals, 1)),
                         3 * g + 1, "lines");
    wh_plot_block(&lanes->plot, name, "t (s), vacuum sensor is on");
    wh_plot_lanes_signal(lanes, put_steps(lanes, &signals->sensors[g], false), 3 * g + 2, "steps");
}

void wh_plots_signals(wh_plots_t *plots) {
    const wh_layout_t *layout = plots->document->signals->layout;
    const size_t grippers = layout->machine.gripper_count;
    wh_plot_lanes_t lanes;
    if (!wh_plot_lanes_open(&lanes, plots, "valves_and_vacuum", 3 * grippers)) {
        return;
    }
    for (size_t g = 0; g < grippers; ++g) {
        wh_plot_lanes_name(&lanes, layout->grippers[g].name, "valve open");
        wh_plot_lanes_name(&lanes, layout->grippers[g].name, "vacuum");
        wh_plot_lanes_name(&lanes, layout->grippers[g].name, "sensor on");
    }
    wh_plot_lanes_begin(&lanes, "Valves, vacuum and its sensors: high is open, full, on");
    for (size_t g = 0; g < grippers; ++g) {
        put_gripper_signals(&lanes, g);
    }
    wh_plot_lanes_end(&lanes);
}

/* ------------------------------------------------------------------------------------------------ holders */

static void put_holds(wh_plot_lanes_t *lanes, size_t g) {
    const wh_layout_t *layout = lanes->plots->document->signals->layout;
    size_t count = 0;
    wh_plot_hold_t *holds = wh_plots_holds(lanes->plots, (int32_t)g, &count);
    for (size_t i = 0; i < count; ++i) {
        wh_plot_lanes_bar(lanes, g, holds[i].begin_s, holds[i].end_s);
        wh_plot_lanes_label(lanes, g, holds[i].begin_s, holds[i].end_s, layout->wafers[holds[i].wafer].name,
                            false);
    }
    free(holds);
}

void wh_plots_holders(wh_plots_t *plots) {
    static const wh_plot_look_t look = {NULL, "#d8d8d8", "solid", false};
    const wh_layout_t *layout = plots->document->signals->layout;
    const size_t grippers = layout->machine.gripper_count;
    wh_plot_lanes_t lanes;
    if (!wh_plot_lanes_open(&lanes, plots, "holders", grippers)) {
        return;
    }
    for (size_t g = 0; g < grippers; ++g) {
        wh_plot_lanes_name(&lanes, layout->grippers[g].name, "holds");
    }
    wh_plot_lanes_begin(&lanes, "Wafers and their holders");
    wh_plot_block(&lanes.plot, "holds", "from (s), to (s), lane");
    for (size_t g = 0; g < grippers; ++g) {
        put_holds(&lanes, g);
    }
    wh_plot_lanes_draw(&lanes, wh_plot_end_block(&lanes.plot), &look);
    wh_plot_lanes_end(&lanes);
}

/* ----------------------------------------------------------------------------------------------- commands */

/* Commands alternate between two looks, so that neighbours can be told apart; failed commands have a
 * third. */
enum { EVEN, ODD, FAILED, COMMANDS };

static const wh_plot_look_t command_looks[COMMANDS] = {{NULL, "#ffffff", "solid", false},
                                                       {NULL, "#e4e4e4", "solid", false},
                                                       {"failed", "#9c1c1c", "solid", true}};

static int look_of(const wh_record_t *record, size_t command) {
    return record->commands[command].error != WH_OK ? FAILED : command % 2 == 0 ? EVEN : ODD;
}

/* The order of lanes. Commands come first, one lane for each of several robots. Then come waits, with as
 * many lanes as overlap, then the robots. Then each chuck that turns and each door that moves has a lane;
 * SIZE_MAX: it does not. */
typedef struct {
    wh_packed_t *commands, *waits;
    size_t own_lanes, command_lanes, wait_lanes, first_robot; /* own_lanes are among the command_lanes */
    size_t of[WH_GRIPPERS], of_door[WH_DOORS];
    size_t count;
} rows_t;

static size_t put_commands(wh_plot_lanes_t *lanes, const wh_record_t *record, const rows_t *rows, int look) {
    wh_plot_block(&lanes->plot, look == FAILED ? "commands that failed" : "commands",
                  "from (s), to (s), lane");
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_packed_t *span = &rows->commands[i];
        if (look_of(record, i) == look) {
            wh_plot_lanes_bar(lanes, span->lane, span->begin, span->end);
            wh_plot_lanes_label(lanes, span->lane, span->begin, span->end, record->commands[i].text,
                                look == FAILED);
        }
    }
    return wh_plot_end_block(&lanes->plot);
}

static size_t put_waits(wh_plot_lanes_t *lanes, const wh_record_t *record, const rows_t *rows) {
    wh_plot_block(&lanes->plot, "waits", "from (s), to (s), lane");
    for (size_t i = 0; i < record->wait_count; ++i) {
        const wh_packed_t *span = &rows->waits[i];
        wh_plot_lanes_bar(lanes, rows->command_lanes + span->lane, span->begin, span->end);
        wh_plot_lanes_label(lanes, rows->command_lanes + span->lane, span->begin, span->end,
                            record->waits[i].what, false);
    }
    return wh_plot_end_block(&lanes->plot);
}

static const wh_plot_look_t share_looks[WH_SHARES] = {
    [WH_SHARE_LOADED] = {"loaded", "#606060", "solid", false},
    [WH_SHARE_EMPTY] = {"empty", "#c8c8c8", "solid", false},
    [WH_SHARE_VACUUM] = {"vacuum", "#000000", "hatched", false},
    [WH_SHARE_HANDOVER] = {"hand-over", "#2b6b2b", "crossed", false},
    [WH_SHARE_WAITING] = {"waiting", "#ffffff", "solid", false}};

/* Packs the commands of no robot; each robot has the lane of its number. */
static void pack_commands(rows_t *rows, const wh_record_t *record) {
    wh_packed_t *packed = wh_array_new(record->command_count, sizeof *packed);
    size_t count = 0;
    rows->commands = wh_array_new(record->command_count, sizeof *rows->commands);
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        const int32_t robot = wh_record_robot(record, command);
        rows->commands[i] =
            (wh_packed_t){command->begin_s, command->end_s, robot == WH_NONE ? 0 : (size_t)robot};
        if (robot == WH_NONE) {
            packed[count++] = rows->commands[i];
        }
    }
    const size_t lanes = wh_packing(packed, count);
    rows->own_lanes = record->layout->robot_count > 1 ? record->layout->robot_count : 0;
    for (size_t i = record->command_count; i-- > 0;) {
        if (wh_record_robot(record, &record->commands[i]) == WH_NONE) {
            rows->commands[i].lane = rows->own_lanes + packed[--count].lane;
        }
    }
    rows->command_lanes = rows->own_lanes + (lanes > 0 ? lanes : 1);
    free(packed);
}

static void pack_waits(rows_t *rows, const wh_record_t *record) {
    rows->waits = wh_array_new(record->wait_count, sizeof *rows->waits);
    for (size_t i = 0; i < record->wait_count; ++i) {
        rows->waits[i].begin = wh_throughput_seconds(record, record->waits[i].begin);
        rows->waits[i].end = wh_throughput_seconds(record, record->waits[i].end);
    }
    rows->wait_lanes = wh_packing(rows->waits, record->wait_count);
}

static bool is_busy(const wh_activity_t *activity, wh_busy_t who, size_t index) {
    size_t i = 0;
    while (i < activity->interval_count &&
           (activity->intervals[i].who != who || activity->intervals[i].gripper != (int32_t)index)) {
        ++i;
    }
    return i < activity->interval_count;
}

static size_t row_of(const rows_t *rows, const wh_busy_span_t *interval) {
    return interval->who == WH_BUSY_ROBOT  ? rows->first_robot + (size_t)interval->gripper
           : interval->who == WH_BUSY_DOOR ? rows->of_door[interval->gripper]
                                           : rows->of[interval->gripper];
}

static rows_t find_rows(const wh_record_t *record, size_t grippers) {
    rows_t rows = {.count = 0};
    pack_commands(&rows, record);
    pack_waits(&rows, record);
    rows.first_robot = rows.command_lanes + rows.wait_lanes;
    rows.count = rows.first_robot + (rows.own_lanes > 0 ? rows.own_lanes : 1);
    for (size_t g = 0; g < grippers; ++g) {
        rows.of[g] = is_busy(&record->activity, WH_BUSY_CHUCK, g) ? rows.count++ : SIZE_MAX;
    }
    for (size_t d = 0; d < WH_DOORS; ++d) {
        rows.of_door[d] = is_busy(&record->activity, WH_BUSY_DOOR, d) ? rows.count++ : SIZE_MAX;
    }
    return rows;
}

static size_t put_shares(wh_plot_lanes_t *lanes, const wh_record_t *record, const rows_t *rows, int share) {
    wh_plot_block(&lanes->plot, share_looks[share].text, "from (s), to (s), lane");
    for (size_t i = 0; i < record->activity.interval_count; ++i) {
        const wh_busy_span_t *interval = &record->activity.intervals[i];
        const bool moves =
            interval->who == WH_BUSY_ROBOT || interval->who == WH_BUSY_CHUCK || interval->who == WH_BUSY_DOOR;
        if (moves && interval->what == 1 + share) {
            wh_plot_lanes_bar(lanes, row_of(rows, interval), wh_throughput_seconds(record, interval->begin),
                              wh_throughput_seconds(record, interval->end));
        }
    }
    return wh_plot_end_block(&lanes->plot);
}

/* Writes the blocks first, then what draws them: labels must not come within a plot command. */
static void draw_commands(wh_plot_lanes_t *lanes, const wh_record_t *record, const rows_t *rows) {
    static const wh_plot_look_t waits = {NULL, "#ffffff", "solid", false};
    size_t blocks[COMMANDS + WH_SHARES];
    for (int look = 0; look < COMMANDS; ++look) {
        blocks[look] = put_commands(lanes, record, rows, look);
    }
    for (int share = 0; share < WH_SHARES; ++share) {
        blocks[COMMANDS + share] = put_shares(lanes, record, rows, share);
    }
    const size_t waited = record->wait_count > 0 ? put_waits(lanes, record, rows) : SIZE_MAX;
    for (int i = 0; i < COMMANDS + WH_SHARES; ++i) {
        wh_plot_lanes_draw(lanes, blocks[i], i < COMMANDS ? &command_looks[i] : &share_looks[i - COMMANDS]);
    }
    wh_plot_lanes_draw(lanes, waited, &waits);
}

/* Names `count` lanes; only the first has this name. */
static void name_alike(wh_plot_lanes_t *lanes, const char *name, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        wh_plot_lanes_name(lanes, i == 0 ? name : "beside them", "");
    }
}

/* Names a lane for each of several robots. */
static void name_robots(wh_plot_lanes_t *lanes, const wh_layout_t *layout, const char *what) {
    for (size_t r = 0; layout->robot_count > 1 && r < layout->robot_count; ++r) {
        wh_plot_lanes_name(lanes, layout->robots[r].name, what);
    }
}

static void name_rows(wh_plot_lanes_t *lanes, const wh_layout_t *layout, const rows_t *rows) {
    name_robots(lanes, layout, "commands");
    name_alike(lanes, "commands", rows->command_lanes - rows->own_lanes);
    name_alike(lanes, "waits", rows->wait_lanes);
    name_robots(lanes, layout, "");
    name_alike(lanes, "robot", rows->own_lanes > 0 ? 0 : 1);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (rows->of[g] != SIZE_MAX) {
            wh_plot_lanes_name(lanes, layout->grippers[g].name, "chuck");
        }
    }
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        if (rows->of_door[d] != SIZE_MAX) {
            wh_plot_lanes_name(lanes, layout->door_list[d].name, "door");
        }
    }
}

void wh_plots_commands(wh_plots_t *plots) {
    const wh_record_t *record = plots->document->record;
    const wh_layout_t *layout = plots->document->signals->layout;
    const bool has_any = record->command_count > 0 || record->activity.interval_count > 0;
    if (!has_any) {
        return;
    }
    const rows_t rows = find_rows(record, layout->machine.gripper_count);
    wh_plot_lanes_t lanes;
    if (wh_plot_lanes_open(&lanes, plots, "commands", rows.count)) {
        lanes.above = 20;
        name_rows(&lanes, layout, &rows);
        wh_plot_lanes_begin(&lanes, "Commands, and what the robot's and the chucks' time goes into");
        draw_commands(&lanes, record, &rows);
        wh_plot_lanes_end(&lanes);
    }
    free(rows.commands);
    free(rows.waits);
}
