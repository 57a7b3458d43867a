/* Plots of lanes over time: each lane has bars with texts, or a signal. A caller opens the plot, names its
 * lanes from the top, and begins; blocks of data and texts of bars come next, then the commands that draw
 * them, then the end. */
#ifndef WH_REPORT_LANES_H
#define WH_REPORT_LANES_H

#include "plots_internal.h"

/* A plot of lanes; wh_plot_lanes_open sets it up. */
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
} wh_plot_lanes_t;

/* The look of a block of bars: a colour, and solid or a pattern in gnuplot's words. `text` is for the key,
 * or null. Bars have a black edge. If there are so many bars that one would see little but edges, they have
 * none. Their colours then blend, each by its share of a pixel's time. Bars that must not be overlooked
 * keep the edge. */
typedef struct {
    const char *text, *colour, *fill;
    bool keeps_edge;
} wh_plot_look_t;

/* Opens `count` lanes. Returns false when the plot's files cannot be opened; then there is nothing to end. */
bool wh_plot_lanes_open(wh_plot_lanes_t *lanes, wh_plots_t *plots, const char *name, size_t count);

/* Names the next lane: two words, of which the second may be empty. */
void wh_plot_lanes_name(wh_plot_lanes_t *lanes, const char *name, const char *what);

/* Begins the script, once all lanes have names. */
void wh_plot_lanes_begin(wh_plot_lanes_t *lanes, const char *title);

/* Adds a row to a block of bars. */
void wh_plot_lanes_bar(wh_plot_lanes_t *lanes, size_t lane, double begin, double end);

/* Adds a bar's text, where there is room for it. */
void wh_plot_lanes_label(wh_plot_lanes_t *lanes, size_t lane, double begin, double end, const char *text,
                         bool on_dark);

/* Draws a block of bars; nothing for SIZE_MAX. */
void wh_plot_lanes_draw(wh_plot_lanes_t *lanes, size_t block, const wh_plot_look_t *look);

/* Draws a block that is a signal from 0 to 1, in gnuplot's style of this name; nothing for SIZE_MAX. */
void wh_plot_lanes_signal(wh_plot_lanes_t *lanes, size_t block, size_t lane, const char *style);

/* Ends the plot. */
void wh_plot_lanes_end(wh_plot_lanes_t *lanes);

#endif
