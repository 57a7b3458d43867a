/* Curves as rows of a plot's data. */
#ifndef WH_REPORT_GNUPLOT_CURVES_H
#define WH_REPORT_GNUPLOT_CURVES_H

#include "../record/signals.h"
#include "gnuplot_file.h"

/* How many rows a block may have, about. */
#define WH_PLOT_ROWS 30000

typedef struct {
    const wh_path_t *curves[WH_MEASURES]; /* a column each */
    size_t count;
    double scale;             /* what is 1 in the plot */
    bool slopes;              /* a second, instead of values */
    const wh_steps_t *wafers; /* null, or what the last column says; the curve has a gap where it changes */
} wh_plot_curves_t;

/* A block of curves over time, at `slice_s` a slice: their points, and between them so many more that straight lines
 * stay within the curves' tolerance, or what WH_PLOT_ROWS leave of it. Returns as wh_plot_end_block does. */
size_t wh_plot_curves(wh_plot_t *plot, const wh_plot_curves_t *of, double slice_s);

#endif
