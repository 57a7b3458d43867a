/* A script's budget, for people and for programs.
 *
 * As JSON one object, format 1, its lists with one element a line:
 *   format, ok (false: it was ended before all was found; unknown values are missing), script, layout,
 *          trials (all in all), interrupted (true if not ok), limit_mm, limit_deg,
 *          collision (whether it was looked for), caught_errors (in a trial that passed, by the script),
 *          noise (of sensors: one sample of it, the same in all trials),
 *          capped (how many errors passed up to the limit, which is less than the tightest error's width),
 *   errors:  station, error (x, y, z, roll, pitch, yaw), unit (mm or deg), width (passes everywhere that was
 *            tried from -width to +width), at_least (nothing failed up to the limit, in neither direction),
 *            has_effect (in a trial something differed that is judged or told), rim_mm (how far the width
 *            moves the rim of a wafer; null if at_least), and for down and up: { inside, outside (with their
 *            signs; outside null: nothing failed up to the limit), inside_error, outside_error (values for
 *            run --error; null: none), trials, widest_step, why }
 *   all:     null if not ok; of all errors together: share (of each width), proved (false: nothing is), half
 *            (station, error, half: up and down), tried and tried_without_collisions (how many points of the
 *            box, by kind: alike, opposite, alone, corner, inside, beside), inside_errors, outside_errors
 *            (values for run --error), why
 *   tightest, next: station, error, width, rim_mm (null: none, or not ok)
 * and why is null or { name, error (its number, or null), line (or null), command (or ""), text }.
 */
#ifndef WH_PRINT_BUDGET_PRINT_H
#define WH_PRINT_BUDGET_PRINT_H

#include <stdio.h>

#include "../study/budget.h"
#include "../text/style.h"

/* 0, or -1 if writing failed. */
int wh_budget_print_table(const wh_budget_t *budget, FILE *out, const wh_style_t *style);
int wh_budget_print_json(const wh_budget_t *budget, FILE *out);

#endif
