/* The plots of a report for print: what the page draws over time, made by gnuplot.
 *
 * Of each gripper that came near a wafer proximity_GRIPPER, (2) to (5) against their limits;
 * valves_and_vacuum; holders; commands, with what the robot's and the chucks' time goes into; axes; of a run
 * that looked for collisions clearances; offsets, how wafers lie in their slots at the end; and of each edge
 * scan edge_scan_NUMBER_CHUCK, with what the estimate makes of it; of each centring on the way
 * centring_NUMBER_STATION, likewise. Those of which a run has nothing are not there.
 */
#ifndef WH_REPORT_PLOTS_H
#define WH_REPORT_PLOTS_H

#include "document.h"

#define WH_PLOTS_MESSAGE_BYTES 600

/* Writes the plots into a folder, which is made unless it is there: NAME.svg, .gp and .dat of each
 * (report/gnuplot.h). False, and the reason in `message`, when they cannot be; then all files are as they
 * were, unless it was the folder that failed when they were put into their places, each of them whole.
 * `document->run` is not looked at. Cost: a tenth of a second and gnuplot's. */
bool wh_plots_write(const wh_document_t *document, const char *folder, char message[WH_PLOTS_MESSAGE_BYTES]);

#endif
