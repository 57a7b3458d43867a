/* A sweep as a drawing: what each run measured over the first parameter; a colour for each combination of the
 * others. */
#ifndef WH_REPORT_SWEEP_PLOT_H
#define WH_REPORT_SWEEP_PLOT_H

#include "../study/sweep.h"

/* Writes SVG: a panel each for simulated time, wafers per hour, the largest distances at picks and the
 * smallest gap, of which any run has one; below them which runs are ok. Whether `out` took all is for its
 * owner to ask. */
void wh_sweep_plot(const wh_script_sweep_t *sweep, FILE *out);

#endif
