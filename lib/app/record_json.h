/* A run's record as JSON, for programs.
 *
 * One object, its lists with one element a line. The keys, in this order: format (1), ok, failure (only when
 * the run ended in one), script, layout (path or null), slices, missed, simulated_s, wall_s, hash (16 hex digits),
 * and the lists
 *   commands:     line, text, error (0: none), begin_s, end_s; message where there is one
 *   wafers:       name, holder (or null), station, slot, dx, dy, dz (mm), tilt_deg (all six null when it lies
 *                 in no slot), position [3] (mm), rotation [3][3] (row by row)
 *   events:       utime (us), kind, wafer, gripper (names or null), dr_proj_z, dr_proj_xy [3],
 *                 dr_proj_xy_norm (mm), n1_proj_n2, margins { projz, projxy, planar }, failed (a list of
 *                 "projz", "projxy", "planar"), measured_utime (us, null without a layout); and by kind:
 *                 from (handed_over: the gripper that let go), holder (contested), other (slot_occupied: the
 *                 wafer that lies there), height (released_unsupported, mm), status and message (bad_input,
 *                 whose measured values are null)
 *   expectations: line, text, ok
 *
 * Numbers have 17 significant digits where they need them: reading them back gives the same double, -0 and
 * denormals included. NaN and infinities, which JSON has not, are null. Text that is no UTF-8 gets U+FFFD for
 * each wrong byte.
 */
#ifndef WH_APP_RECORD_JSON_H
#define WH_APP_RECORD_JSON_H

#include <stdio.h>

#include "script/record.h"

/* 0, or -1 when memory is out (nothing is then printed) or writing failed. Needs LC_NUMERIC "C" no more than
 * any other locale. Cost: linear in the record, all of it in memory once more. */
int wh_record_print_json(const wh_record_t *record, FILE *out);

#endif
