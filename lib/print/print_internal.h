/* Within the report: its parts, and what they share. */
#ifndef WH_PRINT_PRINT_INTERNAL_H
#define WH_PRINT_PRINT_INTERNAL_H

#include "../text/grid.h"
#include "names.h"

/* What every part is given. */
typedef struct {
    const wh_record_t *record;
    const wh_style_t *style;
    FILE *out;
} wh_printer_t;

/* The parts, each with the blank line before it. 0, or -1 when memory is out. */
int wh_print_commands(const wh_printer_t *report);
int wh_print_errors(const wh_printer_t *report);
int wh_print_handovers(const wh_printer_t *report);
int wh_print_complaints(const wh_printer_t *report);
int wh_print_clearances(const wh_printer_t *report);
int wh_print_curves(const wh_printer_t *report);
int wh_print_wafers(const wh_printer_t *report);
int wh_print_expectations(const wh_printer_t *report);
int wh_print_gantt(const wh_printer_t *report);
int wh_print_times(const wh_printer_t *report);
int wh_print_margins(const wh_printer_t *report);
int wh_print_summary(const wh_printer_t *report);

/* The summary's line of wafers per hour, when there are any. */
void wh_print_throughput(const wh_printer_t *report);

/* A part's title, after a blank line. */
void wh_print_title(const wh_printer_t *report, const char *title);

/* Text of a script, made printable; its later lines are indented. "" for null. -1 when memory is out. */
int wh_print_put(const wh_printer_t *report, const char *text);

/* Names, never null: a dash for what has none. */
const char *wh_print_wafer(const wh_printer_t *report, int32_t wafer);
const char *wh_print_gripper(const wh_printer_t *report, int32_t gripper);

/* What a kind of clearance is between, in words: a constant of at most 24 letters. */
const char *wh_print_clearance(size_t kind);

/* The columns of (3), the rim gap, (5) and (2), from `first` on; headings with their limits. */
enum { WH_REPORT_MEASURED_COLUMNS = 4 };
void wh_print_measured_columns(const wh_printer_t *report, wh_grid_t *grid);

/* Fills them in for an event, what failed in red. */
void wh_print_measured(const wh_printer_t *report, wh_grid_t *grid, size_t first, const wh_event_t *event);

/* A column's rule: times in s, shown to the us where a slice is no whole ms; and offsets. */
wh_grid_digits_t wh_print_seconds(void);
wh_grid_digits_t wh_print_millimetres(void);

/* The angle, in degrees, between wafer and gripper whose cosine is (2). */
double wh_print_tilt_deg(double n1_proj_n2);

/* How far the wafer's rim is from the gripper's contact plane, mm; the centre's distance hides it. */
double wh_print_rim_gap(const wh_printer_t *report, const wh_event_t *event);

/* A limit or a whole number as one would write it: 0.5, 50, 0.99; and a count as 31,482. */
#define WH_REPORT_NUMBER_SIZE 40
void wh_print_limit(char text[WH_REPORT_NUMBER_SIZE], double limit);
void wh_print_count(char text[WH_REPORT_NUMBER_SIZE], int64_t count);

/* Whether an event belongs among the misses, and whether it is a complaint of the cell. */
bool wh_print_is_miss(wh_event_kind_t kind);
bool wh_print_is_complaint(wh_event_kind_t kind);

#endif
