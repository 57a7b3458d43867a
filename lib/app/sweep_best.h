/* `waferhand sweep SCRIPT --best`: the best schedule of the script's flow, by searching. */
#ifndef WH_APP_SWEEP_BEST_H
#define WH_APP_SWEEP_BEST_H

#include "run_arguments.h"

/* Runs the script, searches with this number of nodes a level, plays what was found, and prints it. Returns
 * the exit status: 0 if it is optimal, 1 if it is not proved to be. */
int wh_app_sweep_best(const wh_run_arguments_t *arguments, size_t width, FILE *nowhere);

#endif
