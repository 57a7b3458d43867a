/* A sweep's result, for people and for programs.
 *
 * As JSON one object, its lists with one element a line:
 *   format (1), ok (each run is), interrupted (runs are missing), script,
 *   axes:   name, start, step, count
 *   runs:   values (one for each axis), verdict ("ok", "failed", "bad"), reason (or null), simulated_s,
 *           wafers_per_hour, dr_proj_z, dr_proj_xy (mm, the largest at picks), gap (mm, the smallest, if
 *           collisions are looked for), checked (for collisions), caught_errors (ok, though its script caught
 *           errors), hash; null: the run has none
 */
#ifndef WH_PRINT_SWEEP_PRINT_H
#define WH_PRINT_SWEEP_PRINT_H

#include "../study/sweep.h"
#include "../text/style.h"

/* How many runs are ok, and how many could not be used at all. */
size_t wh_sweep_count(const wh_script_sweep_t *sweep, wh_sweep_verdict_t verdict);

/* 0, or -1 if writing failed. */
int wh_sweep_print_table(const wh_script_sweep_t *sweep, FILE *out, const wh_style_t *style);
int wh_sweep_print_json(const wh_script_sweep_t *sweep, FILE *out);

#endif
