/* Declarations within the plots. */
#ifndef WH_REPORT_PLOTS_INTERNAL_H
#define WH_REPORT_PLOTS_INTERNAL_H

#include "gnuplot.h"
#include "plots.h"

/* Plots in progress, in a folder of their own. */
typedef struct {
    const wh_document_t *document;
    const char *folder; /* the folder in which they are made */
    char (*names)[WH_PLOT_NAME_BYTES];
    size_t count, capacity;
    double begin_s, end_s; /* begin and end of the run */
    int error;             /* errno of the first file that could not be written; after it no file is */
} wh_plots_t;

/* Opens a plot's files. `name` names them, with those characters of `of` (unless null) that a file's name
 * may have. Returns false when they cannot be opened; then there is nothing to close. */
bool wh_plots_open(wh_plots_t *plots, wh_plot_t *plot, const char *name, const char *of);
void wh_plots_close(wh_plots_t *plots, wh_plot_t *plot);

/* The times at which a gripper holds a wafer. */
typedef struct {
    double begin_s, end_s;
    int32_t wafer;
} wh_plot_hold_t;

/* All holds of a gripper, in order; the caller frees them. */
wh_plot_hold_t *wh_plots_holds(const wh_plots_t *plots, int32_t gripper, size_t *count);

/* The plots, by subject; each adds none if it has nothing to show. */
void wh_plots_proximity(wh_plots_t *plots);
void wh_plots_axes(wh_plots_t *plots);
void wh_plots_signals(wh_plots_t *plots);
void wh_plots_holders(wh_plots_t *plots);
void wh_plots_commands(wh_plots_t *plots);
void wh_plots_clearances(wh_plots_t *plots);
void wh_plots_offsets(wh_plots_t *plots);
void wh_plots_scans(wh_plots_t *plots);
void wh_plots_centrings(wh_plots_t *plots);
void wh_plots_flow(wh_plots_t *plots);
void wh_plots_shares(wh_plots_t *plots);

#endif
