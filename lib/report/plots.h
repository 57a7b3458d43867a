/* The plots of a report for print; gnuplot draws what the page shows over time.
 *
 * Each gripper that came near a wafer has proximity_GRIPPER, (2) to (5) against their limits. The run has
 * valves_and_vacuum; holders; commands, with how the robot and the chucks spend their time; axes; and
 * offsets, how wafers lie in their slots at the end. A run that looked for collisions has clearances. Each
 * edge scan has edge_scan_NUMBER_CHUCK, with the estimate from it, and each centring on the way has
 * centring_NUMBER_STATION likewise. A plot without data is left out.
 */
#ifndef WH_REPORT_PLOTS_H
#define WH_REPORT_PLOTS_H

#include "document.h"

#define WH_PLOTS_MESSAGE_BYTES 600

/* Writes the plots into a folder and makes the folder if needed: NAME.svg, .gp and .dat of each
 * (report/gnuplot.h). Returns false, and the reason in `message`, when it cannot. All files are then as
 * they were, with one exception: the folder may fail while files are put into their places, each of them
 * whole. `document->run` is not looked at. It costs a tenth of a second and gnuplot's time. */
bool wh_plots_write(const wh_document_t *document, const char *folder, char message[WH_PLOTS_MESSAGE_BYTES]);

#endif
