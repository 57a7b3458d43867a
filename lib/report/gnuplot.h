/* A plot for print, as three files: NAME.dat, what it shows; NAME.gp, which tells gnuplot how; NAME.svg,
 * which gnuplot makes of both.
 *
 * A plot is panels one above the other over a common axis of time. Data are blocks of rows, which a script
 * finds by their index. Lines are black or dark, and told apart by their dashes too; letters are 7.5 pt high
 * at whatever width. The bytes of all three depend on the run alone, those of the SVG on gnuplot's version
 * too.
 */
#ifndef WH_REPORT_GNUPLOT_H
#define WH_REPORT_GNUPLOT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "../record/signals.h"

#define WH_PLOT_NAME_BYTES 100

/* Pixels of 1/96 inch. `left` of the panels are numbers and names, `above` each of them is room for a key. */
typedef struct {
    size_t panels;
    int panel_height, left, above;
    bool keys_wrap; /* in one column */
    bool limits;    /* right of the panels is room for what limits are */
} wh_plot_frame_t;

/* Read script and name. */
typedef struct {
    char name[WH_PLOT_NAME_BYTES]; /* of its files */
    FILE *script, *data;
    wh_plot_frame_t frame;
    size_t panel;  /* panels begun */
    size_t blocks; /* of data that are whole */
    bool has_rows; /* in the block being written */
    bool is_gap;   /* before its next row */
} wh_plot_t;

/* How the script begins: `title` tells people what it is. Time runs from `begin` to `end`, s; with both 0 the
 * axis is not time, and is the caller's to describe. */
void wh_plot_begin(wh_plot_t *plot, const wh_plot_frame_t *frame, const char *title, double begin,
                   double end);

/* The next panel, its limits free, without labels. */
void wh_plot_panel(wh_plot_t *plot, const char *label);

/* What is below the panels. */
void wh_plot_axis(wh_plot_t *plot, const char *label);

/* A line for what must not be passed: its label, on which `side` of it values must be, '<' or '>'; and the
 * line itself, to follow other curves in a plot command. */
void wh_plot_limit_label(wh_plot_t *plot, char side, double limit, const char *unit);
void wh_plot_limit_curve(wh_plot_t *plot, double limit);

/* A label in the middle between two times, where there is room for it; how high, and how it looks, is to
 * follow. */
void wh_plot_fitting_label(wh_plot_t *plot, double begin, double end, const char *text);

/* Writes any text in quotes, so that gnuplot takes it as it is. Control characters become blanks, bytes that
 * are no UTF-8 question marks. */
void wh_plot_put_text(FILE *out, const char *text);

/* The same for a tic's label, in which gnuplot would look for conversions as of printf. */
void wh_plot_put_tic(FILE *out, const char *text);

/* A block of data: what is in it, its columns; rows; a gap in the curve. Returns the index of the block that
 * ends; a block without rows is none, and has SIZE_MAX. */
void wh_plot_block(wh_plot_t *plot, const char *of, const char *columns);
void wh_plot_row(wh_plot_t *plot, double at, const double values[], size_t count);
void wh_plot_gap(wh_plot_t *plot);
size_t wh_plot_end_block(wh_plot_t *plot);

/* How many rows a block may have, about. */
#define WH_PLOT_ROWS 30000

typedef struct {
    const wh_path_t *curves[WH_MEASURES]; /* a column each */
    size_t count;
    double scale;             /* what is 1 in the plot */
    bool slopes;              /* a second, instead of values */
    const wh_steps_t *wafers; /* null, or what the last column says; the curve has a gap where it changes */
} wh_plot_curves_t;

/* A block of curves over time, at `slice_s` a slice: their points, and between them so many more that
 * straight lines stay within the curves' tolerance, or what WH_PLOT_ROWS leave of it. Returns as
 * wh_plot_end_block does. */
size_t wh_plot_curves(wh_plot_t *plot, const wh_plot_curves_t *of, double slice_s);

#endif
