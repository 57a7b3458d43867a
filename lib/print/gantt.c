/* The Gantt table of a run or of a part of it: the commands, then the busy times of each part, with time
 * along the line. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../record/throughput.h"
#include "../text/array.h"
#include "print_internal.h"

/* The number of columns for the time: as many as fit on the terminal, within these limits; PIPED_COLUMNS
 * without a terminal. */
#define LEAST_COLUMNS 20
#define MOST_COLUMNS 400
#define PIPED_COLUMNS 100

/* The least distance of ticks, in columns, so that their numbers fit. */
#define TICK_COLUMNS 10

#define LABEL_SIZE (WH_NAME_SIZE + 16)

/* A column of the row. */
typedef struct {
    const char *mark; /* one column wide, or null: blank */
    double taken;     /* how much of the column the mark's interval takes */
    char *text;       /* printed from here on instead of the marks, over `wide` columns */
    size_t wide;
} cell_t;

/* One row at a time, time along the line. */
typedef struct {
    const wh_printer_t *printer;
    size_t label_columns, columns;
    int64_t begin, end; /* slices: before the first column and in the last one; `end` is later */
    cell_t *cells;
} gantt_t;

/* -------------------------------------------------------------------------------------------------- marks */

/* The mark of a share, one column wide. */
static const char *share_mark(const wh_style_t *style, wh_share_t share) {
    static const char *const ascii[WH_SHARES] = {"#", "-", "v", "x", "."};
    static const char *const utf8[WH_SHARES] = {"█", "▒", "v", "x", "·"};
    return style->utf8 ? utf8[share] : ascii[share];
}

static const char *mark_of(const wh_style_t *style, const wh_busy_span_t *interval) {
    if (interval->who == WH_BUSY_WAFER) {
        return style->utf8 ? "━" : "=";
    }
    return interval->who == WH_BUSY_VALVE ? "o" : share_mark(style, (wh_share_t)(interval->what - 1));
}

/* --------------------------------------------------------------------------------------------------- rows */

/* A row with the width that the terminal leaves beside labels of this number of columns. */
static gantt_t open_gantt(const wh_printer_t *printer, const wh_print_window_t *window,
                          size_t label_columns) {
    const size_t width = printer->style->width;
    const size_t room = width > label_columns + LEAST_COLUMNS + 2 ? width - label_columns - 2 : LEAST_COLUMNS;
    const size_t columns = width == 0 ? PIPED_COLUMNS : room < MOST_COLUMNS ? room : MOST_COLUMNS;
    const gantt_t gantt = {printer,       label_columns, columns,
                           window->begin, window->end,   wh_array_new(columns, sizeof *gantt.cells)};
    return gantt;
}

/* The column in which a slice ends; the first one if that is before it. */
static size_t column_of(const gantt_t *gantt, int64_t slice) {
    const double share =
        slice < gantt->begin ? 0 : (double)(slice - gantt->begin) / (double)(gantt->end - gantt->begin);
    const size_t column = (size_t)(share * (double)gantt->columns);
    return column < gantt->columns ? column : gantt->columns - 1;
}

/* How much of a column's time lies within an interval, in columns. */
static double overlap(const gantt_t *gantt, size_t column, const wh_busy_span_t *interval) {
    const double slices = (double)(gantt->end - gantt->begin) / (double)gantt->columns;
    const double begin = (double)(interval->begin - gantt->begin) / slices;
    const double end = (double)(interval->end - gantt->begin) / slices;
    const double from = begin > (double)column ? begin : (double)column;
    const double to = end < (double)column + 1 ? end : (double)column + 1;
    return to > from ? to - from : 0;
}

/* A column shows what takes most of its time. */
static void draw_marks(gantt_t *gantt, const wh_busy_span_t *interval) {
    const size_t last = column_of(gantt, interval->end);
    for (size_t column = column_of(gantt, interval->begin); column <= last; ++column) {
        cell_t *cell = &gantt->cells[column];
        const double taken = overlap(gantt, column, interval);
        if (taken > cell->taken) {
            cell->taken = taken;
            cell->mark = mark_of(gantt->printer->style, interval);
        }
    }
}

/* Writes a text over the marks from column `first` on if it fits before `last`; else nothing. */
static void write_over(gantt_t *gantt, size_t first, size_t last, const char *text) {
    char *printable = wh_style_printable(text);
    const size_t wide = wh_style_columns(printable);
    if (wide > 0 && first < gantt->columns && last <= gantt->columns && first + wide <= last &&
        !gantt->cells[first].text) {
        gantt->cells[first].text = printable;
        gantt->cells[first].wide = wide;
    } else {
        free(printable);
    }
}

/* Prints the row behind its label, and empties it. */
static void print_row(gantt_t *gantt, const char *label) {
    FILE *out = gantt->printer->out;
    char *printable = wh_style_printable(label);
    fputs(printable, out);
    /* Not yet printed: none at the line's end. */
    size_t blanks = gantt->label_columns - wh_style_columns(printable) + 2;
    free(printable);
    for (size_t i = 0; i < gantt->columns;) {
        const cell_t *cell = &gantt->cells[i];
        const char *shown = cell->text ? cell->text : cell->mark;
        if (shown) {
            fprintf(out, "%*s%s", (int)blanks, "", shown);
        }
        blanks = shown ? 0 : blanks + 1;
        i += cell->text ? cell->wide : 1;
    }
    fputc('\n', out);
    for (size_t i = 0; i < gantt->columns; ++i) {
        free(gantt->cells[i].text);
    }
    memset(gantt->cells, 0, gantt->columns * sizeof *gantt->cells);
}

/* ------------------------------------------------------------------------------------------- time's scale */

/* 1, 2 or 5 times a power of ten that is at least `least`. */
static double round_step(double least) {
    static const double steps[] = {1, 2, 5, 10};
    double power = 1e-6;
    while (power * 10 <= least) {
        power *= 10;
    }
    size_t i = 0;
    while (i < 3 && steps[i] * power < least) {
        ++i;
    }
    return steps[i] * power;
}

static void print_scale(gantt_t *gantt) {
    const double from = wh_throughput_seconds(gantt->printer->record, gantt->begin);
    const double seconds = wh_throughput_seconds(gantt->printer->record, gantt->end - gantt->begin);
    const double step = round_step(seconds * TICK_COLUMNS / (double)gantt->columns);
    for (int64_t i = (int64_t)ceil(from / step); (double)i * step <= from + seconds; ++i) {
        char text[WH_PRINT_NUMBER_SIZE];
        const size_t column = (size_t)(((double)i * step - from) / seconds * (double)gantt->columns);
        snprintf(text, sizeof text, "%.10g", (double)i * step);
        write_over(gantt, column,
                   column + TICK_COLUMNS < gantt->columns ? column + TICK_COLUMNS : gantt->columns, text);
    }
    print_row(gantt, "s");
}

/* ------------------------------------------------------------------------------------ commands and cycles */

int64_t wh_print_slice_at(const wh_printer_t *printer, double seconds) {
    const wh_record_t *record = printer->record;
    if (!record->layout || !(seconds > 0 && seconds < record->simulated_s)) {
        return seconds > 0 ? record->slices : 0;
    }
    return (int64_t)(seconds * 1e6 / (double)record->layout->slice_us + 0.5);
}

bool wh_print_is_within(const wh_printer_t *printer, const wh_print_window_t *window,
                        const wh_command_record_t *command) {
    return window->is_whole || (wh_print_slice_at(printer, command->begin_s) < window->end &&
                                wh_print_slice_at(printer, command->end_s) > window->begin);
}

/* A bar where it begins, and its text behind the bar if there is room up to its end. */
static void draw_span(gantt_t *gantt, int64_t begin, int64_t end, const char *text) {
    if (begin >= gantt->end || end <= gantt->begin) {
        return;
    }
    const size_t first = column_of(gantt, begin);
    const size_t last = end < gantt->end ? column_of(gantt, end) : gantt->columns;
    const bool has_bar = begin >= gantt->begin;
    if (has_bar) {
        gantt->cells[first].mark = gantt->printer->style->utf8 ? "│" : "|";
    }
    write_over(gantt, first + (has_bar ? 1 : 0), last, text);
}

/* Draws one row of the robot's remaining commands (WH_NONE: commands of no robot): the first one, then the
 * first one after its end, and so on. True if any are left then. */
static bool draw_commands(gantt_t *gantt, int32_t robot, bool is_drawn[]) {
    const wh_record_t *record = gantt->printer->record;
    double free_from = 0;
    bool is_left = false;
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        if (is_drawn[i] || !(command->end_s > command->begin_s) ||
            wh_record_robot(record, command) != robot) {
            continue;
        }
        is_drawn[i] = command->begin_s >= free_from;
        is_left = is_left || !is_drawn[i];
        if (is_drawn[i]) {
            free_from = command->end_s;
            draw_span(gantt, wh_print_slice_at(gantt->printer, command->begin_s),
                      wh_print_slice_at(gantt->printer, command->end_s), command->text ? command->text : "");
        }
    }
    return is_left;
}

/* Several at once have a row each, and so has each of several robots. */
static void print_commands(gantt_t *gantt) {
    const wh_layout_t *layout = gantt->printer->record->layout;
    bool *is_drawn = wh_array_new(gantt->printer->record->command_count, sizeof *is_drawn);
    for (size_t r = 0; layout->robot_count > 1 && r < layout->robot_count; ++r) {
        char label[LABEL_SIZE];
        snprintf(label, sizeof label, "%s command", layout->robots[r].name);
        (void)draw_commands(gantt, (int32_t)r, is_drawn);
        print_row(gantt, label);
    }
    bool is_left = draw_commands(gantt, WH_NONE, is_drawn);
    print_row(gantt, "command");
    while (is_left) {
        is_left = draw_commands(gantt, WH_NONE, is_drawn);
        print_row(gantt, "beside");
    }
    free(is_drawn);
}

/* Draws the marks of waiting behind a bar, and over them who waits for what if there is room. */
static void draw_wait(gantt_t *gantt, const wh_wait_record_t *wait) {
    char who[32] = "script";
    const wh_busy_span_t span = {WH_BUSY_ROBOT, WH_NONE, 1 + (int32_t)WH_SHARE_WAITING, wait->begin,
                                 wait->end};
    if (wait->task > 0) {
        snprintf(who, sizeof who, "task %d", (int)wait->task);
    }
    char *text = wh_array_new(strlen(who) + strlen(wait->what) + 3, 1);
    snprintf(text, strlen(who) + strlen(wait->what) + 3, "%s: %s", who, wait->what);
    if (wait->begin < gantt->end && wait->end > gantt->begin) {
        draw_marks(gantt, &span);
    }
    draw_span(gantt, wait->begin, wait->end, text);
    free(text);
}

/* Several at once have a row each. */
static void print_waits(gantt_t *gantt) {
    const wh_record_t *record = gantt->printer->record;
    bool *is_drawn = wh_array_new(record->wait_count, sizeof *is_drawn);
    for (size_t left = record->wait_count; left > 0;) {
        int64_t free_from = 0;
        for (size_t i = 0; i < record->wait_count; ++i) {
            const wh_wait_record_t *wait = &record->waits[i];
            if (!is_drawn[i] && wait->begin >= free_from) {
                is_drawn[i] = true;
                free_from = wait->end;
                draw_wait(gantt, wait);
                --left;
            }
        }
        print_row(gantt, "waits");
    }
    free(is_drawn);
}

static void print_cycles(gantt_t *gantt) {
    const wh_record_t *record = gantt->printer->record;
    for (size_t i = 0; i < record->cycle_count; ++i) {
        const wh_cycle_record_t *cycle = &record->cycles[i];
        const int64_t end = wh_throughput_cycle_end(record, i);
        char text[WH_PRINT_NUMBER_SIZE];
        snprintf(text, sizeof text, "%zu", i + 1);
        if (end > cycle->begin) {
            draw_span(gantt, cycle->begin, end, cycle->name[0] != '\0' ? cycle->name : text);
        }
    }
    if (record->cycle_count > 0) {
        print_row(gantt, "cycle");
    }
}

/* ---------------------------------------------------------------------------------------------- resources */

static void label_of(const wh_printer_t *printer, const wh_busy_span_t *interval, char label[LABEL_SIZE]) {
    static const char *const does[] = {"", " turns", " holds", " valve", " door"};
    const bool robot = interval->who == WH_BUSY_ROBOT;
    const wh_layout_t *layout = printer->record->layout;
    const char *name = robot ? (layout->robot_count > 1 ? layout->robots[interval->gripper].name : "robot")
                       : interval->who == WH_BUSY_DOOR ? layout->door_list[interval->gripper].name
                                                       : wh_print_gripper(printer, interval->gripper);
    snprintf(label, LABEL_SIZE, "%s%s", name, does[interval->who]);
}

static void draw(gantt_t *gantt, const wh_busy_span_t *interval) {
    const size_t first = column_of(gantt, interval->begin);
    const size_t last = column_of(gantt, interval->end);
    draw_marks(gantt, interval);
    if (interval->who == WH_BUSY_WAFER) {
        write_over(gantt, first + 1, last, wh_print_wafer(gantt->printer, interval->what - 1));
    }
}

static void print_resource(gantt_t *gantt, size_t resource) {
    const wh_activity_t *activity = &gantt->printer->record->activity;
    char label[LABEL_SIZE] = "";
    for (size_t i = 0; i < activity->interval_count; ++i) {
        const wh_busy_span_t *interval = &activity->intervals[i];
        const bool is_shown = interval->begin < gantt->end && interval->end > gantt->begin;
        if (is_shown && wh_activity_resource(interval) == resource) {
            label_of(gantt->printer, interval, label);
            draw(gantt, interval);
        }
    }
    if (label[0] != '\0') {
        print_row(gantt, label);
    }
}

/* The columns of a name with a word behind it, or `least`. */
static size_t wide_label(const char *name, const char *word, size_t least) {
    char *printable = wh_style_printable(name);
    const size_t wide = wh_style_columns(printable) + strlen(word);
    free(printable);
    return wide > least ? wide : least;
}

static size_t widest_label(const wh_printer_t *printer) {
    const wh_layout_t *layout = printer->record->layout;
    size_t widest = strlen("command");
    for (size_t r = 0; layout->robot_count > 1 && r < layout->robot_count; ++r) {
        widest = wide_label(layout->robots[r].name, " command", widest);
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        widest = wide_label(layout->grippers[g].name, " holds", widest);
    }
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        widest = wide_label(layout->door_list[d].name, " door", widest);
    }
    return widest;
}

static void print_legend(const wh_printer_t *printer) {
    static const char *const meanings[WH_SHARES] = {"moving with a wafer", "moving without",
                                                    "waiting for vacuum", "valves switching", "waiting"};
    const char *before = "";
    for (int share = 0; share < WH_SHARES; ++share) {
        if (printer->record->activity.shares[share] > 0) {
            fprintf(printer->out, "%s%s %s", before, share_mark(printer->style, (wh_share_t)share),
                    meanings[share]);
            before = ", ";
        }
    }
    fprintf(printer->out, "%so vacuum on\n", before);
}

void wh_print_gantt(const wh_printer_t *printer, const wh_print_window_t *window) {
    if (!printer->record->layout || printer->record->slices == 0) {
        return;
    }
    wh_print_title(printer, "Gantt");
    gantt_t gantt = open_gantt(printer, window, widest_label(printer));
    print_scale(&gantt);
    print_cycles(&gantt);
    print_commands(&gantt);
    print_waits(&gantt);
    for (size_t resource = 0; resource < WH_RESOURCES; ++resource) {
        print_resource(&gantt, resource);
    }
    print_legend(printer);
    free(gantt.cells);
}
