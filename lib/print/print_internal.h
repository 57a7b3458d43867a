/* Within the tables of a record: their parts, and what they share. */
#ifndef WH_PRINT_PRINT_INTERNAL_H
#define WH_PRINT_PRINT_INTERNAL_H

#include "../record/record.h"
#include "../text/grid.h"

/* What every part is given. */
typedef struct {
    const wh_record_t *record;
    const wh_style_t *style;
    FILE *out;
} wh_printer_t;

/* The parts, each with the blank line before it. */
void wh_print_commands(const wh_printer_t *printer);
void wh_print_errors(const wh_printer_t *printer);
void wh_print_handovers(const wh_printer_t *printer);
void wh_print_complaints(const wh_printer_t *printer);
void wh_print_clearances(const wh_printer_t *printer);
void wh_print_curves(const wh_printer_t *printer);
void wh_print_wafers(const wh_printer_t *printer);
void wh_print_gantt(const wh_printer_t *printer);
void wh_print_times(const wh_printer_t *printer);
void wh_print_margins(const wh_printer_t *printer);

/* The summary's line of wafers per hour, when there are any. */
void wh_print_throughput(const wh_printer_t *printer);

/* A part's title, after a blank line. */
void wh_print_title(const wh_printer_t *printer, const char *title);

/* Prints a table under its title and frees it; prints nothing if it has no rows. */
void wh_print_titled(const wh_printer_t *printer, const char *title, wh_grid_t *grid);

/* Text of a script, made printable; its later lines are indented. "" for null. */
void wh_print_put(const wh_printer_t *printer, const char *text);

/* Names, never null: a dash for what has none. */
const char *wh_print_wafer(const wh_printer_t *printer, int32_t wafer);
const char *wh_print_gripper(const wh_printer_t *printer, int32_t gripper);

/* The columns of (3), the rim gap, (5) and (2), from `first` on; headings with their limits. */
enum { WH_PRINT_MEASURED_COLUMNS = 4 };
void wh_print_measured_columns(const wh_printer_t *printer, wh_grid_t *grid);

/* Fills them in for an event, what failed in red. */
void wh_print_measured(const wh_printer_t *printer, wh_grid_t *grid, size_t first, const wh_event_t *event);

/* A column's rule: times in s, shown to the us where a slice is no whole ms; and offsets. */
static const wh_grid_digits_t wh_print_seconds = {3, 6, false, 0};
static const wh_grid_digits_t wh_print_millimetres = {4, 9, false, 0};

/* The angle, in degrees, between wafer and gripper whose cosine is (2). */
double wh_print_tilt_deg(double n1_proj_n2);

/* How far the wafer's rim is from the gripper's contact plane, mm; the centre's distance hides it. */
double wh_print_rim_gap(const wh_printer_t *printer, const wh_event_t *event);

/* A count as one would write it: 31,482; and with what is counted, one of it or many. */
#define WH_PRINT_NUMBER_SIZE 40
void wh_print_count(char text[WH_PRINT_NUMBER_SIZE], int64_t count);
void wh_print_counted(FILE *out, int64_t count, const char *one, const char *many);

/* True if an event belongs among the misses; true if it is a complaint of the cell. */
bool wh_print_is_miss(wh_event_kind_t kind);
bool wh_print_is_complaint(wh_event_kind_t kind);

#endif
