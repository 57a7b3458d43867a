/* A sweep's result, for people and for programs.
 *
 * As JSON one object, its lists with one element a line:
 *   format (1), ok (each run is), interrupted (runs are missing), script,
 *   axes:   name, start, step, count; or name, values (words)
 *   runs:   values (one for each axis), verdict ("ok", "failed", "bad"), reason (or null), simulated_s,
 *           wafers_per_hour, dr_proj_z, dr_proj_xy (mm, the largest at picks), gap (mm, the smallest, if
 *           collisions are looked for), checked (for collisions), caught_errors (ok, though its script caught
 *           errors), busiest (of a flow alone: the robot or station with the most work, and its share), cut
 *           (true: with wafers not at their ends), late and lost (stays beyond windows, and wafers lost in a
 *           flow: where there are any), hash; null: the run has none
 * Of wh_paces_t: format, ok, interrupted, script, saved (the share of time),
 *   base:   the members of a run but values
 *   faster: likewise, with name and gain (0.02: 2 % more; null: one of both is not ok), the greatest first
 */
#ifndef WH_PRINT_SWEEP_PRINT_H
#define WH_PRINT_SWEEP_PRINT_H

#include "../study/paces.h"
#include "../text/json.h"
#include "../text/style.h"

/* How many runs are ok, and how many could not be used at all. */
size_t wh_sweep_count(const wh_script_sweep_t *sweep, wh_sweep_verdict_t verdict);

/* 0, or -1 if writing failed. */
int wh_sweep_print_table(const wh_script_sweep_t *sweep, FILE *out, const wh_style_t *style);
int wh_sweep_print_json(const wh_script_sweep_t *sweep, FILE *out);
int wh_paces_print_table(const wh_paces_t *paces, FILE *out, const wh_style_t *style);
int wh_paces_print_json(const wh_paces_t *paces, FILE *out);

/* The members of a run that both have, into an object, which is returned. */
json_t *wh_sweep_put_run(const wh_sweep_point_t *point, json_t *object);

/* "ok", "failed", "undone" or "bad". */
const char *wh_sweep_verdict(const wh_sweep_point_t *point);

#endif
