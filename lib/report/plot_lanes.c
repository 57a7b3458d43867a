/* Plots of lanes over time: signals, holders, commands, and how the time is spent. */
#include <stdlib.h>

#include "../record/packing.h"
#include "../record/throughput.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "plots_internal.h"

/* -------------------------------------------------------------------------------------------------- lanes */

/* Half of the height that a bar or a signal takes in its lane. */
#define HALF 0.34

/* A plot of lanes; open_lanes sets it up. */
typedef struct {
    wh_plots_t *plots;
    wh_plot_t plot;
    size_t count, named, letters;
    int above;  /* pixels above the lanes; more for a key */
    FILE *out;  /* the tics' text */
    char *tics; /* the lanes' names, for gnuplot */
    size_t size;
    size_t drawn; /* curves and blocks of bars in the plot command */
    size_t bars;  /* of all lanes */
    double duration;
} lanes_t;

/* The look of a block of bars: a colour, and solid or a pattern in gnuplot's words. `text` is for the key,
 * or null. Bars have a black edge. If there are so many bars that one would see little but edges, they have
 * none. Their colours then blend, each by its share of a pixel's time. Bars that must not be overlooked
 * keep the edge. */
typedef struct {
    const char *text, *colour, *fill;
    bool keeps_edge;
} look_t;

/* Pixels, except MOST_LETTERS: the number of letters of a name that have room. */
enum { ROW = 24, MOST_LETTERS = 28, LEAST_ABOVE = 6, LEAST_PITCH = 3 };

#define EDGED "using 1:3:1:2:($3-%g):($3+%g) with boxxyerror lw 0.6 dt 1 fc"
#define EDGE "border lc rgb '#000000'"

/* Opens `count` lanes; the caller names them from the top before it begins them. Returns false when the
 * plot's files cannot be opened; then there is nothing to end. */
static bool open_lanes(lanes_t *lanes, wh_plots_t *plots, const char *name, size_t count) {
    *lanes = (lanes_t){.plots = plots, .count = count, .above = LEAST_ABOVE};
    if (!wh_plots_open(plots, &lanes->plot, name, NULL)) {
        return false;
    }
    lanes->out = wh_memory_need(open_memstream(&lanes->tics, &lanes->size));
    return true;
}

/* A lane's height in the plot; the first lane is the highest. */
static double lane_height(const lanes_t *lanes, size_t lane) {
    return (double)(lanes->count - 1 - lane);
}

static void name_lane(lanes_t *lanes, const char *name, const char *what) {
    char text[WH_NAME_SIZE + 40];
    (void)snprintf(text, sizeof text, "%s%s%s", name, what[0] != '\0' ? " " : "", what);
    const size_t letters = wh_utf8_count(text);
    lanes->letters = letters > lanes->letters ? letters : lanes->letters;
    fputs(lanes->named > 0 ? ", " : "", lanes->out);
    wh_plot_put_tic(lanes->out, text);
    fprintf(lanes->out, " %g", lane_height(lanes, lanes->named++));
}

/* Begins the script. Next come blocks of data and texts of bars, then the commands that draw them, then the
 * end. */
static void begin_lanes(lanes_t *lanes, const char *title) {
    const size_t letters = lanes->letters < MOST_LETTERS ? lanes->letters : MOST_LETTERS;
    const wh_plot_frame_t frame = {.panels = 1,
                                   .panel_height = (int)lanes->count * ROW,
                                   .left = 14 + (int)(letters * 66 / 10),
                                   .above = lanes->above,
                                   .keys_wrap = lanes->above > LEAST_ABOVE};
    if (fclose(lanes->out) != 0) {
        wh_memory_out();
    }
    lanes->duration = lanes->plots->end_s - lanes->plots->begin_s;
    wh_plot_begin(&lanes->plot, &frame, title, lanes->plots->begin_s, lanes->plots->end_s);
    wh_plot_panel(&lanes->plot, "");
    fprintf(lanes->plot.script, "set yrange [-0.5:%zu.5]\nset ytics scale 0 (%s)\n", lanes->count - 1,
            lanes->tics);
    free(lanes->tics);
    lanes->tics = NULL;
}

/* Adds a row to a block of bars. */
static void add_bar(lanes_t *lanes, size_t lane, double begin, double end) {
    const double values[] = {end, lane_height(lanes, lane)};
    wh_plot_row(&lanes->plot, begin, values, 2);
    ++lanes->bars;
}

/* Adds a bar's text, where there is room for it. */
static void add_label(lanes_t *lanes, size_t lane, double begin, double end, const char *text, bool on_dark) {
    wh_plot_fitting_label(&lanes->plot, begin, end, text);
    fprintf(lanes->plot.script, ", %g center front%s\n", lane_height(lanes, lane),
            on_dark ? " textcolor rgb '#ffffff'" : "");
}

/* Begins the next part of the plot command. */
static void put_part(lanes_t *lanes) {
    fputs(lanes->drawn++ == 0 ? "plot " : ", \\\n  ", lanes->plot.script);
}

/* Defines how bars are drawn: as boxes, or as strokes as wide as a lane. Strokes are used if the bars of a
 * lane are nearer to each other than LEAST_PITCH pixels on average. A box without an edge counts for a
 * pixel only if it covers the pixel's middle; strokes blend. */
static void put_styles(const lanes_t *lanes) {
    FILE *out = lanes->plot.script;
    fprintf(out,
            "dense = %d * %zu * abs(to_s - from_s) > (W - %d) * %.12g\n"
            "bars = dense ? \"using 1:3:($2-$1):(0) with vectors nohead lw %g dt 1 lc\" : \"",
            LEAST_PITCH, lanes->bars, lanes->plot.frame.left + 10, lanes->duration * (double)lanes->count,
            2 * HALF * ROW);
    fprintf(out, EDGED "\"\n", HALF, HALF);
    fputs("solid = dense ? '' : \"fs solid " EDGE "\"\n"
          "hatched = dense ? '' : \"fs pattern 4 " EDGE "\"\n"
          "crossed = dense ? '' : \"fs pattern 2 " EDGE "\"\n",
          out);
}

/* Draws a block of bars; nothing for SIZE_MAX. */
static void draw_bars(lanes_t *lanes, size_t block, const look_t *look) {
    if (block == SIZE_MAX) {
        return;
    }
    if (lanes->drawn == 0) {
        put_styles(lanes);
    }
    put_part(lanes);
    fprintf(lanes->plot.script, "'%s.dat' index %zu ", lanes->plot.name, block);
    if (look->keeps_edge) {
        fprintf(lanes->plot.script, EDGED " rgb '%s' fs %s " EDGE " ", HALF, HALF, look->colour, look->fill);
    } else {
        fprintf(lanes->plot.script, "@bars rgb '%s' @%s ", look->colour, look->fill);
    }
    if (look->text) {
        fprintf(lanes->plot.script, "title '%s'", look->text);
    } else {
        fputs("notitle", lanes->plot.script);
    }
}

/* Draws a block that is a signal from 0 to 1, in gnuplot's style of this name; nothing for SIZE_MAX. */
static void draw_signal(lanes_t *lanes, size_t block, size_t lane, const char *style) {
    if (block == SIZE_MAX) {
        return;
    }
    put_part(lanes);
    fprintf(lanes->plot.script, "'%s.dat' index %zu using 1:(%g+%g*$2) with %s lt 1 notitle",
            lanes->plot.name, block, lane_height(lanes, lane) - HALF, 2 * HALF, style);
}

/* Ends the plot; gnuplot draws the empty lanes with NaN, since it refuses a plot command without
 * anything. */
static void end_lanes(lanes_t *lanes) {
    fputs(lanes->drawn == 0 ? "plot NaN notitle\n" : "\n", lanes->plot.script);
    wh_plots_close(lanes->plots, &lanes->plot);
}

/* ------------------------------------------------------------------------------------------------ signals */

/* Writes steps of 0 and 1. The last value goes on to the end. */
static size_t put_steps(lanes_t *lanes, const wh_steps_t *steps, bool inverted) {
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

static void put_gripper_signals(lanes_t *lanes, size_t g) {
    const wh_signals_t *signals = lanes->plots->document->signals;
    const wh_plot_curves_t level = {{&signals->vacuum[g]}, 1, 1, false, NULL};
    const char *name = signals->layout->grippers[g].name;
    wh_plot_block(&lanes->plot, name, "t (s), valve is open");
    draw_signal(lanes, put_steps(lanes, &signals->valves[g], true), 3 * g, "steps");
    wh_plot_block(&lanes->plot, name, "t (s), vacuum from 0 to 1");
    draw_signal(lanes, wh_plot_curves(&lanes->plot, &level, wh_signals_seconds(signals, 1)), 3 * g + 1,
                "lines");
    wh_plot_block(&lanes->plot, name, "t (s), vacuum sensor is on");
    draw_signal(lanes, put_steps(lanes, &signals->sensors[g], false), 3 * g + 2, "steps");
}

void wh_plots_signals(wh_plots_t *plots) {
    const wh_layout_t *layout = plots->document->signals->layout;
    const size_t grippers = layout->machine.gripper_count;
    lanes_t lanes;
    if (!open_lanes(&lanes, plots, "valves_and_vacuum", 3 * grippers)) {
        return;
    }
    for (size_t g = 0; g < grippers; ++g) {
        name_lane(&lanes, layout->grippers[g].name, "valve open");
        name_lane(&lanes, layout->grippers[g].name, "vacuum");
        name_lane(&lanes, layout->grippers[g].name, "sensor on");
    }
    begin_lanes(&lanes, "Valves, vacuum and its sensors: high is open, full, on");
    for (size_t g = 0; g < grippers; ++g) {
        put_gripper_signals(&lanes, g);
    }
    end_lanes(&lanes);
}

/* ------------------------------------------------------------------------------------------------ holders */

static void put_holds(lanes_t *lanes, size_t g) {
    const wh_layout_t *layout = lanes->plots->document->signals->layout;
    size_t count = 0;
    wh_plot_hold_t *holds = wh_plots_holds(lanes->plots, (int32_t)g, &count);
    for (size_t i = 0; i < count; ++i) {
        add_bar(lanes, g, holds[i].begin_s, holds[i].end_s);
        add_label(lanes, g, holds[i].begin_s, holds[i].end_s, layout->wafers[holds[i].wafer].name, false);
    }
    free(holds);
}

void wh_plots_holders(wh_plots_t *plots) {
    static const look_t look = {NULL, "#d8d8d8", "solid", false};
    const wh_layout_t *layout = plots->document->signals->layout;
    const size_t grippers = layout->machine.gripper_count;
    lanes_t lanes;
    if (!open_lanes(&lanes, plots, "holders", grippers)) {
        return;
    }
    for (size_t g = 0; g < grippers; ++g) {
        name_lane(&lanes, layout->grippers[g].name, "holds");
    }
    begin_lanes(&lanes, "Wafers and their holders");
    wh_plot_block(&lanes.plot, "holds", "from (s), to (s), lane");
    for (size_t g = 0; g < grippers; ++g) {
        put_holds(&lanes, g);
    }
    draw_bars(&lanes, wh_plot_end_block(&lanes.plot), &look);
    end_lanes(&lanes);
}

/* ----------------------------------------------------------------------------------------------- commands */

/* Commands alternate between two looks, so that neighbours can be told apart; failed commands have a
 * third. */
enum { EVEN, ODD, FAILED, COMMANDS };

static const look_t command_looks[COMMANDS] = {{NULL, "#ffffff", "solid", false},
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

static size_t put_commands(lanes_t *lanes, const wh_record_t *record, const rows_t *rows, int look) {
    wh_plot_block(&lanes->plot, look == FAILED ? "commands that failed" : "commands",
                  "from (s), to (s), lane");
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_packed_t *span = &rows->commands[i];
        if (look_of(record, i) == look) {
            add_bar(lanes, span->lane, span->begin, span->end);
            add_label(lanes, span->lane, span->begin, span->end, record->commands[i].text, look == FAILED);
        }
    }
    return wh_plot_end_block(&lanes->plot);
}

static size_t put_waits(lanes_t *lanes, const wh_record_t *record, const rows_t *rows) {
    wh_plot_block(&lanes->plot, "waits", "from (s), to (s), lane");
    for (size_t i = 0; i < record->wait_count; ++i) {
        const wh_packed_t *span = &rows->waits[i];
        add_bar(lanes, rows->command_lanes + span->lane, span->begin, span->end);
        add_label(lanes, rows->command_lanes + span->lane, span->begin, span->end, record->waits[i].what,
                  false);
    }
    return wh_plot_end_block(&lanes->plot);
}

static const look_t share_looks[WH_SHARES] = {
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

static size_t put_shares(lanes_t *lanes, const wh_record_t *record, const rows_t *rows, int share) {
    wh_plot_block(&lanes->plot, share_looks[share].text, "from (s), to (s), lane");
    for (size_t i = 0; i < record->activity.interval_count; ++i) {
        const wh_busy_span_t *interval = &record->activity.intervals[i];
        const bool moves =
            interval->who == WH_BUSY_ROBOT || interval->who == WH_BUSY_CHUCK || interval->who == WH_BUSY_DOOR;
        if (moves && interval->what == 1 + share) {
            add_bar(lanes, row_of(rows, interval), wh_throughput_seconds(record, interval->begin),
                    wh_throughput_seconds(record, interval->end));
        }
    }
    return wh_plot_end_block(&lanes->plot);
}

/* Writes the blocks first, then what draws them: labels must not come within a plot command. */
static void draw_commands(lanes_t *lanes, const wh_record_t *record, const rows_t *rows) {
    static const look_t waits = {NULL, "#ffffff", "solid", false};
    size_t blocks[COMMANDS + WH_SHARES];
    for (int look = 0; look < COMMANDS; ++look) {
        blocks[look] = put_commands(lanes, record, rows, look);
    }
    for (int share = 0; share < WH_SHARES; ++share) {
        blocks[COMMANDS + share] = put_shares(lanes, record, rows, share);
    }
    const size_t waited = record->wait_count > 0 ? put_waits(lanes, record, rows) : SIZE_MAX;
    for (int i = 0; i < COMMANDS + WH_SHARES; ++i) {
        draw_bars(lanes, blocks[i], i < COMMANDS ? &command_looks[i] : &share_looks[i - COMMANDS]);
    }
    draw_bars(lanes, waited, &waits);
}

/* Names `count` lanes; only the first has this name. */
static void name_alike(lanes_t *lanes, const char *name, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        name_lane(lanes, i == 0 ? name : "beside them", "");
    }
}

/* Names a lane for each of several robots. */
static void name_robots(lanes_t *lanes, const wh_layout_t *layout, const char *what) {
    for (size_t r = 0; layout->robot_count > 1 && r < layout->robot_count; ++r) {
        name_lane(lanes, layout->robots[r].name, what);
    }
}

static void name_rows(lanes_t *lanes, const wh_layout_t *layout, const rows_t *rows) {
    name_robots(lanes, layout, "commands");
    name_alike(lanes, "commands", rows->command_lanes - rows->own_lanes);
    name_alike(lanes, "waits", rows->wait_lanes);
    name_robots(lanes, layout, "");
    name_alike(lanes, "robot", rows->own_lanes > 0 ? 0 : 1);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (rows->of[g] != SIZE_MAX) {
            name_lane(lanes, layout->grippers[g].name, "chuck");
        }
    }
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        if (rows->of_door[d] != SIZE_MAX) {
            name_lane(lanes, layout->door_list[d].name, "door");
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
    lanes_t lanes;
    if (open_lanes(&lanes, plots, "commands", rows.count)) {
        lanes.above = 20;
        name_rows(&lanes, layout, &rows);
        begin_lanes(&lanes, "Commands, and what the robot's and the chucks' time goes into");
        draw_commands(&lanes, record, &rows);
        end_lanes(&lanes);
    }
    free(rows.commands);
    free(rows.waits);
}
