/* A customer's questions about a layout: wafers per hour, the parts of the time, reach. */
#include "../record/steady.h"

#include <math.h>
#include <string.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "print_internal.h"

/* ---------------------------------------------------------------------------------------- wafers per hour */

/* Prints the wafers per hour of a whole run, or of its marked cycles without the first. */
static void put_figure(const wh_printer_t *printer, const wh_throughput_t *throughput, const char *what) {
    fprintf(printer->out, "%.1f %s: %zu in %.3f s, ", throughput->wafers_per_hour, what, throughput->wafers,
            throughput->seconds);
    if (throughput->first == 0) {
        fputs("the whole run", printer->out);
    } else if (throughput->first == throughput->last) {
        fprintf(printer->out, "cycle %zu", throughput->first);
    } else {
        fprintf(printer->out, "cycles %zu to %zu", throughput->first, throughput->last);
    }
}

static void put_share(const wh_printer_t *printer, int64_t slices, const char *what, const char **before) {
    const double percent = 100 * (double)slices / (double)printer->record->slices;
    if (percent >= 0.05) {
        fprintf(printer->out, "%s%.1f %% %s", *before, percent, what);
        *before = ", ";
    }
}

/* A steady cycle first: what the run is with its start and its end comes behind it. A flow has told its own
 * one before. */
bool wh_print_figure(const wh_printer_t *printer) {
    const wh_throughput_t throughput = wh_throughput(printer->record);
    const wh_steady_cycle_t steady = wh_steady_cycle(printer->record);
    const bool is_steady =
        steady.found == WH_STEADY_FOUND && steady.figure == WH_FIGURE_GIVEN && printer->record->flow == NULL;
    if (is_steady) {
        fprintf(printer->out, "%.1f wafers per hour: %zu in %.3f s, the first steady cycle; ",
                steady.wafers_per_hour, steady.wafers, steady.seconds);
    }
    if (throughput.figure == WH_FIGURE_GIVEN) {
        put_figure(printer, &throughput, is_steady ? "in all" : "wafers per hour");
    } else {
        fprintf(printer->out, is_steady ? "none in all: %s" : "no wafers per hour: %s",
                wh_throughput_reason(throughput.figure));
    }
    return is_steady || throughput.figure == WH_FIGURE_GIVEN;
}

void wh_print_throughput(const wh_printer_t *printer) {
    const int64_t *shares = printer->record->activity.shares;
    const char *before = "; ";
    if (!printer->record->layout || printer->record->slices == 0) {
        return;
    }
    if (wh_print_figure(printer)) {
        put_share(printer, shares[WH_SHARE_LOADED] + shares[WH_SHARE_EMPTY], "motion", &before);
        put_share(printer, shares[WH_SHARE_VACUUM], "vacuum", &before);
        put_share(printer, shares[WH_SHARE_HANDOVER], "valves", &before);
        put_share(printer, shares[WH_SHARE_WAITING], "waiting", &before);
    }
    fputc('\n', printer->out);
}

/* -------------------------------------------------------------------------------------------------- times */

enum { LINE, COMMAND, SECONDS, FIRST_SHARE };

static void add_times(const wh_printer_t *printer, wh_grid_t *grid, const char *text,
                      const int64_t shares[WH_SHARES]) {
    int64_t slices = 0;
    wh_grid_text(grid, COMMAND, WH_INK_PLAIN, "%s", text);
    for (size_t share = 0; share < WH_SHARES; ++share) {
        slices += shares[share];
        if (shares[share] > 0) {
            wh_grid_number(grid, FIRST_SHARE + share, WH_INK_PLAIN,
                           wh_throughput_seconds(printer->record, shares[share]));
        }
    }
    wh_grid_number(grid, SECONDS, WH_INK_PLAIN, wh_throughput_seconds(printer->record, slices));
}

/* The commands that are shown are those of a window, which need not follow one another where several run at
 * once; and how long they took together. */
typedef struct {
    const wh_print_window_t *window;
    double seconds;
} shown_t;

static bool is_shown(const wh_printer_t *printer, const shown_t *shown, size_t command) {
    return wh_print_is_within(printer, shown->window, &printer->record->commands[command]);
}

/* A text, and the length of the part that names a kind of command. A command that goes on after a phase
 * counts with the kind of the command that it continues. */
typedef struct {
    const char *text; /* null: none */
    size_t length;
    bool goes_on;
} kind_t;

/* The command that a CONTINUE continues: the last one before it, of its task, that stopped in a phase. */
static const char *find_phased(const wh_record_t *record, size_t command) {
    for (size_t i = command; i-- > 0;) {
        const wh_command_record_t *before = &record->commands[i];
        if (before->task == record->commands[command].task && before->text && strstr(before->text, "stop=")) {
            return before->text;
        }
    }
    return NULL;
}

static kind_t kind_of(const wh_record_t *record, size_t command) {
    kind_t kind = {record->commands[command].text, 0, false};
    if (kind.text && strcmp(kind.text, "CONTINUE") == 0) {
        const char *phased = find_phased(record, command);
        kind.goes_on = phased != NULL;
        kind.text = phased ? phased : kind.text;
    }
    kind.length = kind.text ? wh_steady_kind_length(kind.text) : 0;
    return kind;
}

static bool is_same(const kind_t *a, const kind_t *b) {
    return a->text && b->text && a->goes_on == b->goes_on && a->length == b->length &&
           memcmp(a->text, b->text, a->length) == 0;
}

enum { KIND, COUNT, FAILED, MEAN, LEAST, MOST, SHARE };

/* Commands of one kind together, from command `first` on, which is the first of them. */
static void add_total(const wh_printer_t *printer, wh_grid_t *grid, const shown_t *shown, size_t first) {
    const wh_record_t *record = printer->record;
    const kind_t kind = kind_of(record, first);
    double sum = 0;
    double least = HUGE_VAL;
    double most = 0;
    size_t count = 0;
    size_t failed = 0;
    for (size_t i = first; i < record->command_count; ++i) {
        const kind_t other = kind_of(record, i);
        if (is_shown(printer, shown, i) && is_same(&kind, &other)) {
            const double seconds = record->commands[i].end_s - record->commands[i].begin_s;
            sum += seconds;
            least = seconds < least ? seconds : least;
            most = seconds > most ? seconds : most;
            failed += record->commands[i].error != WH_OK ? 1 : 0;
            ++count;
        }
    }
    wh_grid_row(grid);
    wh_grid_text(grid, KIND, WH_INK_PLAIN, "%s%.*s", kind.goes_on ? "CONTINUE of " : "", (int)kind.length,
                 kind.text);
    wh_grid_number(grid, COUNT, WH_INK_PLAIN, (double)count);
    if (failed > 0) {
        wh_grid_number(grid, FAILED, WH_INK_BAD, (double)failed);
    }
    const double values[] = {sum / (double)count, least, most, 100 * sum / shown->seconds};
    wh_grid_numbers(grid, MEAN, values, sizeof values / sizeof *values);
}

/* True if no command that is shown before this one is of its kind. */
static bool is_first_of_kind(const wh_printer_t *printer, const shown_t *shown, size_t command) {
    const wh_record_t *record = printer->record;
    const kind_t kind = kind_of(record, command);
    for (size_t i = 0; i < command; ++i) {
        const kind_t other = kind_of(record, i);
        if (is_shown(printer, shown, i) && is_same(&kind, &other)) {
            return false;
        }
    }
    return kind.text != NULL && is_shown(printer, shown, command);
}

/* Prints totals, which the rows of a long run do not show at a glance. */
static void print_totals(const wh_printer_t *printer, const shown_t *shown, const char *of) {
    char title[100];
    wh_grid_t *grid = wh_grid_new(printer->style, 1,
                                  "command;count{0};failed{0};mean s{3};least s{3};most s{3};share %{1}");
    for (size_t i = 0; i < printer->record->command_count; ++i) {
        if (is_first_of_kind(printer, shown, i)) {
            add_total(printer, grid, shown, i);
        }
    }
    (void)snprintf(title, sizeof title, "Totals: commands of one kind at one station, and their share of %s",
                   of);
    wh_print_titled(printer, title, grid);
}

/* Chooses the commands of a window: whole ones, also those that it cuts. */
static shown_t choose(const wh_printer_t *printer, const wh_print_window_t *window) {
    const wh_record_t *record = printer->record;
    shown_t shown = {window, 0};
    for (size_t i = 0; i < record->command_count; ++i) {
        const double seconds = record->commands[i].end_s - record->commands[i].begin_s;
        shown.seconds += is_shown(printer, &shown, i) ? seconds : 0;
    }
    shown.seconds = window->is_whole ? record->simulated_s : shown.seconds;
    return shown;
}

void wh_print_times(const wh_printer_t *printer, const wh_print_window_t *window) {
    const wh_record_t *record = printer->record;
    if (!record->layout || record->slices == 0) {
        return;
    }
    const shown_t shown = choose(printer, window);
    int64_t shares[WH_SHARES] = {0};
    wh_grid_t *grid = wh_grid_new(printer->style, 2,
                                  "line{0};command;s{3,6};with wafer{3,6};without{3,6};vacuum{3,6};"
                                  "valves{3,6};waiting{3,6}");
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        if (!is_shown(printer, &shown, i)) {
            continue;
        }
        for (size_t share = 0; share < WH_SHARES; ++share) {
            shares[share] += command->shares[share];
        }
        wh_grid_row(grid);
        if (command->line > 0) {
            wh_grid_number(grid, LINE, WH_INK_DIM, command->line);
        }
        add_times(printer, grid, command->text ? command->text : "", command->shares);
    }
    wh_grid_row(grid);
    add_times(printer, grid, "all", window->is_whole ? record->activity.shares : shares);
    wh_print_titled(
        printer, "Time: motion with and without a wafer, standing still for vacuum, valves, waiting", grid);
    print_totals(printer, &shown, window->is_whole ? "the run" : "those that are shown");
}

/* -------------------------------------------------------------------------------------------------- reach */

/* The least margin, in mm or degrees, that one can rely on. */
#define SLENDER 1.0

static void add_reach(const wh_printer_t *printer, wh_grid_t *grid, size_t station) {
    wh_grid_named_row(grid, printer->record->layout->stations[station].name);
    const wh_machine_t *machine = &printer->record->layout->machine;
    size_t column = 1;
    for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
        const wh_travel_margin_t *reach = &printer->record->reach[station].axes[axis];
        const double margin = (wh_axis_turns(machine, axis) ? wh_deg_from_rad(reach->margin) : reach->margin);
        if (reach->slot != 0 && wh_axis_exists(machine, axis)) {
            wh_grid_number(grid, column, margin < SLENDER ? WH_INK_WARN : WH_INK_PLAIN, margin);
            wh_grid_text(grid, column + 1, WH_INK_DIM, "%s, slot %d", reach->is_max ? "max" : "min",
                         (int)reach->slot);
        }
        column += wh_axis_exists(machine, axis) ? 2 : 0;
    }
}

void wh_print_margins(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    if (!record->layout || !record->reach) {
        return;
    }
    const wh_machine_t *machine = &record->layout->machine;
    char columns[40 * WH_GRID_COLUMNS] = "station";
    for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
        if (wh_axis_exists(machine, axis)) {
            const size_t length = strlen(columns);
            size_t own = 0;
            char robot[16] = ""; /* names may have characters that a column's heading cannot have */
            if (record->layout->robot_count > 1) {
                (void)snprintf(robot, sizeof robot, "%d ", (int)wh_machine_robot_of(machine, axis, &own) + 1);
            }
            (void)snprintf(columns + length, sizeof columns - length, ";%s%s %s{1,3};+from", robot,
                           wh_axis_name(machine, axis), wh_axis_turns(machine, axis) ? "deg" : "mm");
        }
    }
    wh_grid_t *grid = wh_grid_new(printer->style, 1, columns);
    for (size_t station = 0; station < record->layout->station_count; ++station) {
        add_reach(printer, grid, station);
    }
    wh_print_titled(printer,
                    "Reach: how far GET and PUT, coming from home, stay from the ends of the axes' travel",
                    grid);
}
