/* A sweep as a drawing: the measurements of each run over the first parameter, with a colour for each
 * combination of the others. */
#ifndef WH_REPORT_SWEEP_PLOT_H
#define WH_REPORT_SWEEP_PLOT_H

#include "../study/sweep.h"

/* Writes SVG. It has a panel each for simulated time, wafers per hour, the largest distances at picks and
 * the smallest gap, if any run has one. Below them it shows which runs are ok. The owner of `out` asks
 * whether it took all. */
void wh_sweep_plot(const wh_script_sweep_t *sweep, FILE *out);

#endif
