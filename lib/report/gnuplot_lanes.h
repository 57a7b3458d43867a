/* A plot of lanes over time, each with bars or a signal. */
#ifndef WH_REPORT_GNUPLOT_LANES_H
#define WH_REPORT_GNUPLOT_LANES_H

#include "plots_internal.h"

/* Half of what a bar or a signal takes of its lane. */
#define WH_LANES_HALF 0.34

/* Zeroed and given its plot by wh_lanes_open. */
typedef struct {
    wh_plot_t *plot;
    size_t count, named, letters;
    int above;  /* pixels above the lanes; more for a key */
    FILE *out;  /* of tics */
    char *tics; /* the lanes' names, for gnuplot */
    size_t size;
    size_t drawn; /* curves and blocks of bars in the plot command */
    size_t bars;  /* of all lanes */
    double duration;
} wh_lanes_t;

/* How a block of bars is filled: a colour, and solid or a pattern in gnuplot's words; `text` is for the key, or null. Bars have a
 * black edge, unless so many of them are shown that there would be little but edges: then their colours blend, each by its
 * share of a pixel's time. Bars that must not be overlooked keep it. */
typedef struct {
    const char *text, *colour, *fill;
    bool keeps_edge;
} wh_lanes_look_t;

/* `count` lanes, to be named from the top before they are begun. */
void wh_lanes_open(wh_lanes_t *lanes, wh_plot_t *plot, size_t count);
void wh_lanes_name(wh_lanes_t *lanes, const char *name, const char *what);

/* The script begins; next come blocks of data and bars' texts, then what draws them, then the end. */
void wh_lanes_begin(wh_lanes_t *lanes, const wh_plots_t *plots, const char *title);

/* A lane's height in the plot; the first is the highest. */
double wh_lanes_height(const wh_lanes_t *lanes, size_t lane);

/* A row of a block of bars; and a bar's text, where there is room for it. */
void wh_lanes_bar(wh_lanes_t *lanes, size_t lane, double begin, double end);
void wh_lanes_label(wh_lanes_t *lanes, size_t lane, double begin, double end, const char *text, bool on_dark);

/* Draws a block: of bars, or of a signal from 0 to 1, in gnuplot's style of this name. Nothing for SIZE_MAX. */
void wh_lanes_draw_bars(wh_lanes_t *lanes, size_t block, const wh_lanes_look_t *look);
void wh_lanes_draw_signal(wh_lanes_t *lanes, size_t block, size_t lane, const char *style);

void wh_lanes_end(wh_lanes_t *lanes);

#endif
