/* A plot for print, as three files. NAME.dat has the data, NAME.gp tells gnuplot how to draw them, and
 * gnuplot makes NAME.svg of both.
 *
 * A plot has panels one above the other, over a common axis of time. The data are blocks of rows; a script
 * finds a block by its index. Lines are black or dark, and their dashes tell them apart too. Letters are
 * 7.5 pt high at any width. The bytes of all three files depend on the run alone; those of the SVG also
 * depend on gnuplot's version.
 */
#ifndef WH_REPORT_GNUPLOT_H
#define WH_REPORT_GNUPLOT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "../record/signals.h"

#define WH_PLOT_NAME_BYTES 100

/* Pixels of 1/96 inch. `left` of the panels there are numbers and names; `above` each panel there is room
 * for a key. */
typedef struct {
    size_t panels;
    int panel_height, left, above;
    bool keys_wrap; /* the key has one column */
    bool limits;    /* right of the panels there is room for the limits' labels */
} wh_plot_frame_t;

/* Callers only read script and name. */
typedef struct {
    char name[WH_PLOT_NAME_BYTES]; /* of the plot's files */
    FILE *script, *data;
    wh_plot_frame_t frame;
    size_t panel;  /* panels that have begun */
    size_t blocks; /* blocks of data that are complete */
    bool has_rows; /* the block being written has rows */
    bool is_gap;   /* a gap comes before the next row */
} wh_plot_t;

/* Begins the script; `title` tells people what the plot is. Time runs from `begin` to `end`, s. With both 0
 * the axis is not time, and the caller describes it. */
void wh_plot_begin(wh_plot_t *plot, const wh_plot_frame_t *frame, const char *title, double begin,
                   double end);

/* Begins the next panel. Its limits are free, and it has no labels. */
void wh_plot_panel(wh_plot_t *plot, const char *label);

/* Labels the axis below the panels. */
void wh_plot_axis(wh_plot_t *plot, const char *label);

/* A line for a limit. The label says on which `side` of it values must be, '<' or '>'. The line itself
 * follows other curves in a plot command. */
void wh_plot_limit_label(wh_plot_t *plot, char side, double limit, const char *unit);
void wh_plot_limit_curve(wh_plot_t *plot, double limit);

/* Begins a label in the middle between two times, where there is room for it. The caller adds its height
 * and look. */
void wh_plot_fitting_label(wh_plot_t *plot, double begin, double end, const char *text);

/* Writes any text in quotes, so that gnuplot takes it as it is. Control characters become blanks, bytes that
 * are no UTF-8 question marks. */
void wh_plot_put_text(FILE *out, const char *text);

/* Writes a tic's label likewise; gnuplot would look for printf conversions in it. */
void wh_plot_put_tic(FILE *out, const char *text);

/* A block of data: its content and its columns, then rows, and gaps in the curve. The end returns the index
 * of the block; a block without rows is none, and has SIZE_MAX. */
void wh_plot_block(wh_plot_t *plot, const char *of, const char *columns);
void wh_plot_row(wh_plot_t *plot, double at, const double values[], size_t count);
void wh_plot_gap(wh_plot_t *plot);
size_t wh_plot_end_block(wh_plot_t *plot);

/* The number of rows that a block may have, about. */
#define WH_PLOT_ROWS 30000

typedef struct {
    const wh_path_t *curves[WH_MEASURES]; /* a column for each */
    size_t count;
    double scale;             /* this value is 1 in the plot */
    bool slopes;              /* null, or the last column; the curve has a gap where it changes */
    const wh_steps_t *wafers; /* null, or the content of the last column; the curve has a gap where it
                               * changes */
} wh_plot_curves_t;

/* Writes a block of curves over time, at `slice_s` a slice. It has their points, and enough points between
 * them that straight lines stay within the curves' tolerance. WH_PLOT_ROWS limits their number. Returns as
 * wh_plot_end_block does. */
size_t wh_plot_curves(wh_plot_t *plot, const wh_plot_curves_t *of, double slice_s);

#endif
