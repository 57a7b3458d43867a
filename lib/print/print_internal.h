/* Within the tables of a record: their parts, and the functions that they share. */
#ifndef WH_PRINT_PRINT_INTERNAL_H
#define WH_PRINT_PRINT_INTERNAL_H

#include "../layout/layout.h"
#include "../record/record.h"
#include "../text/grid.h"

/* The data that every part is given. */
typedef struct {
    const wh_record_t *record;
    const wh_style_t *style;
    FILE *out;
} wh_printer_t;

/* The part of a run that is shown: slices from the end of `begin` to the end of `end`, which is later. */
typedef struct {
    int64_t begin, end;
    bool is_whole; /* the run */
} wh_print_window_t;

/* The slice at whose end so many seconds have passed; beyond the run's end, its last slice. */
int64_t wh_print_slice_at(const wh_printer_t *printer, double seconds);

/* True if any of a command lies within. */
bool wh_print_is_within(const wh_printer_t *printer, const wh_print_window_t *window,
                        const wh_command_record_t *command);

/* The parts, each with the blank line before it. */
void wh_print_commands(const wh_printer_t *printer);
void wh_print_errors(const wh_printer_t *printer);
void wh_print_handovers(const wh_printer_t *printer);
void wh_print_stations(const wh_printer_t *printer);
void wh_print_wafers(const wh_printer_t *printer);
void wh_print_clearances(const wh_printer_t *printer);
void wh_print_gantt(const wh_printer_t *printer, const wh_print_window_t *window);
void wh_print_times(const wh_printer_t *printer, const wh_print_window_t *window);
void wh_print_cycle(const wh_printer_t *printer);
void wh_print_margins(const wh_printer_t *printer);
void wh_print_flow(const wh_printer_t *printer);

/* Prints wafers per hour, or why there is no such figure, without a line feed. True if there is one. */
bool wh_print_figure(const wh_printer_t *printer);

/* The throughput of the summary's line, with the parts of the time; nothing for a run without a slice. */
void wh_print_throughput(const wh_printer_t *printer);

/* A part's title, after a blank line. */
void wh_print_title(const wh_printer_t *printer, const char *title);

/* Prints a table under its title and frees it; prints nothing if it has no rows. */
void wh_print_titled(const wh_printer_t *printer, const char *title, wh_grid_t *grid);

/* Formatted text, with names and messages in it, made printable; its later lines are indented. */
__attribute__((format(printf, 2, 3))) void wh_print_say(const wh_printer_t *printer, const char *format, ...);

/* Names, never null: a dash for what has none. */
const char *wh_print_wafer(const wh_printer_t *printer, int32_t wafer);
const char *wh_print_gripper(const wh_printer_t *printer, int32_t gripper);

/* The columns of (3), the rim gap, (5) and (2), from `first` on; headings with their limits. */
enum { WH_PRINT_MEASURED_COLUMNS = 4 };
void wh_print_measured_columns(const wh_printer_t *printer, wh_grid_t *grid);

/* Fills them in for an event, failed values in red. */
void wh_print_measured(const wh_printer_t *printer, wh_grid_t *grid, size_t first, const wh_event_t *event);

/* Behind a limit of the tolerance: " (default)", if the layout gives others and not this one; else "". */
const char *wh_print_default(const wh_layout_t *layout, size_t limit);

/* The part of a layout's listing about shapes, links, obstacles and clearances. */
void wh_layout_print_bodies(const wh_printer_t *frame, const wh_layout_t *layout);

/* When picks are checked: before a slice's length. */
const char *wh_print_check(const wh_layout_t *layout);

/* How far the wafer's rim is from the gripper's contact plane, mm; the centre's distance hides it. */
double wh_print_rim_gap(const wh_printer_t *printer, const wh_event_t *event);

/* The angle, in degrees, between wafer and gripper whose cosine is (2). */
double wh_print_tilt_deg(double n1_proj_n2);

/* A count as people write it: 31,482, in `text`, which is returned; and with the name of the counted things,
 * in the singular or plural. */
#define WH_PRINT_NUMBER_SIZE 40
const char *wh_print_count(char text[WH_PRINT_NUMBER_SIZE], int64_t count);
void wh_print_counted(FILE *out, int64_t count, const char *one, const char *many);

/* True if an event is a complaint of the cell. */
bool wh_print_is_complaint(wh_event_kind_t kind);

/* A cell of a table by RFC 4180: a text, in quotes if it has a character that would end it; a number with the
 * digits that read back as the same double, nothing for NaN and infinities. */
void wh_print_csv_text(const char *text, FILE *out);
void wh_print_csv_number(double value, FILE *out);

#endif
