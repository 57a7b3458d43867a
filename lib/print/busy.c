/* The Gantt table: the commands, then who was busy when, time along the line. */
#include <stdlib.h>
#include <string.h>

#include "../record/throughput.h"
#include "gantt.h"

/* Ticks are at least so many columns apart: room for any of their numbers. */
#define TICK_COLUMNS 10

#define LABEL_SIZE (WH_NAME_SIZE + 16)

/* ---------------------------------------------------------------------------------------------- time's scale */

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

static int print_scale(wh_gantt_t *gantt) {
    const double seconds = wh_throughput_seconds(gantt->report->record, gantt->slices);
    const double step = round_step(seconds * TICK_COLUMNS / (double)gantt->columns);
    int status = 0;
    for (int i = 0; i * step <= seconds; ++i) {
        char text[WH_REPORT_NUMBER_SIZE];
        const size_t column = (size_t)(i * step / seconds * (double)gantt->columns);
        snprintf(text, sizeof text, "%.10g", i * step);
        status |= wh_gantt_write(
            gantt, column, column + TICK_COLUMNS < gantt->columns ? column + TICK_COLUMNS : gantt->columns,
            text);
    }
    return status | wh_gantt_print(gantt, "s");
}

/* ------------------------------------------------------------------------------------------------- commands */

static int64_t slice_at(const wh_record_t *record, double seconds) {
    if (!(seconds > 0 && seconds < record->simulated_s)) {
        return seconds > 0 ? record->slices : 0;
    }
    return (int64_t)(seconds * 1e6 / (double)record->layout->slice_us + 0.5);
}

static int print_commands(wh_gantt_t *gantt) {
    const wh_record_t *record = gantt->report->record;
    const char *bar = gantt->report->style->utf8 ? "│" : "|";
    int status = 0;
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        const size_t first = wh_gantt_column(gantt, slice_at(record, command->begin_s));
        const size_t last = command->end_s < record->simulated_s
                                ? wh_gantt_column(gantt, slice_at(record, command->end_s))
                                : gantt->columns;
        if (command->end_s > command->begin_s) {
            gantt->cells[first].mark = bar;
            status |= wh_gantt_write(gantt, first + 1, last, command->text ? command->text : "");
        }
    }
    return status | wh_gantt_print(gantt, "command");
}

/* --------------------------------------------------------------------------------------------------- cycles */

static int print_cycles(wh_gantt_t *gantt) {
    const wh_record_t *record = gantt->report->record;
    const char *bar = gantt->report->style->utf8 ? "│" : "|";
    int status = 0;
    for (size_t i = 0; i < record->cycle_count; ++i) {
        const int64_t end = wh_throughput_cycle_end(record, i);
        const size_t first = wh_gantt_column(gantt, record->cycles[i].begin);
        const size_t last = end < gantt->slices ? wh_gantt_column(gantt, end) : gantt->columns;
        char text[WH_REPORT_NUMBER_SIZE];
        snprintf(text, sizeof text, "%zu", i + 1);
        if (end > record->cycles[i].begin) {
            gantt->cells[first].mark = bar;
            status |= wh_gantt_write(gantt, first + 1, last,
                                     record->cycles[i].name[0] != '\0' ? record->cycles[i].name : text);
        }
    }
    return record->cycle_count > 0 ? status | wh_gantt_print(gantt, "cycle") : 0;
}

/* ------------------------------------------------------------------------------------------------ resources */

static void label_of(const wh_printer_t *report, const wh_busy_span_t *interval, char label[LABEL_SIZE]) {
    static const char *const does[] = {"", " turns", " holds", " valve"};
    const bool robot = interval->who == WH_BUSY_ROBOT;
    snprintf(label, LABEL_SIZE, "%s%s", robot ? "robot" : wh_print_gripper(report, interval->gripper),
             does[interval->who]);
}

static int draw(wh_gantt_t *gantt, const wh_busy_span_t *interval) {
    const size_t first = wh_gantt_column(gantt, interval->begin);
    const size_t last = wh_gantt_column(gantt, interval->end);
    wh_gantt_draw(gantt, interval);
    if (interval->who != WH_BUSY_WAFER) {
        return 0;
    }
    return wh_gantt_write(gantt, first + 1, last, wh_print_wafer(gantt->report, interval->what - 1));
}

static int print_resource(wh_gantt_t *gantt, size_t resource) {
    const wh_activity_t *activity = &gantt->report->record->activity;
    char label[LABEL_SIZE] = "";
    int status = 0;
    for (size_t i = 0; i < activity->interval_count; ++i) {
        const wh_busy_span_t *interval = &activity->intervals[i];
        if (wh_activity_resource(interval) == resource) {
            label_of(gantt->report, interval, label);
            status |= draw(gantt, interval);
        }
    }
    return label[0] != '\0' ? status | wh_gantt_print(gantt, label) : 0;
}

static size_t widest_label(const wh_printer_t *report) {
    size_t widest = strlen("command");
    for (size_t g = 0; g < report->record->layout->machine.gripper_count; ++g) {
        char *printable = wh_style_printable(report->record->layout->grippers[g].name);
        const size_t wide = printable ? wh_style_columns(printable) + strlen(" holds") : 0;
        widest = wide > widest ? wide : widest;
        free(printable);
    }
    return widest;
}

static void print_legend(const wh_printer_t *report) {
    static const char *const meanings[WH_SHARES] = {"moving with a wafer", "moving without",
                                                    "waiting for vacuum", "valves switching", "waiting"};
    const char *before = "";
    for (int share = 0; share < WH_SHARES; ++share) {
        if (report->record->activity.shares[share] > 0) {
            fprintf(report->out, "%s%s %s", before, wh_gantt_mark(report->style, (wh_share_t)share),
                    meanings[share]);
            before = ", ";
        }
    }
    fprintf(report->out, "%so vacuum on\n", before);
}

int wh_print_gantt(const wh_printer_t *report) {
    wh_gantt_t gantt;
    if (!report->record->layout || report->record->slices == 0) {
        return 0;
    }
    wh_print_title(report, "Gantt");
    int status = wh_gantt_open(&gantt, report, widest_label(report));
    if (status == 0) {
        status |= print_scale(&gantt);
        status |= print_cycles(&gantt);
        status |= print_commands(&gantt);
        for (size_t resource = 0; resource < WH_RESOURCES; ++resource) {
            status |= print_resource(&gantt, resource);
        }
        print_legend(report);
    }
    wh_gantt_close(&gantt);
    return status;
}
