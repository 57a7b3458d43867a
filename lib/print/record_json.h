/* A run's record as JSON, for programs.
 *
 * One object, its lists with one element a line. The keys, in this order: format (1), ok, failure (only when
 * the run ended in one), script, layout (path or null), slices, missed, simulated_s, wall_s, hash (16 hex digits),
 *   throughput:   { wafers, seconds, wafers_per_hour, first_cycle, last_cycle (of the marked cycles that count, from 1;
 *                 null: the whole run counts), puts (all of the run), rule (which puts count, in words; null: there
 *                 are none) }: see record/throughput.h
 *   split:        { motion_s, of it loaded_s and empty_s, vacuum_s, handover_s (valves switching), waiting_s }: what the
 *                 run's time went into; motion, vacuum, handover and waiting add up to simulated_s
 * and the lists
 *   commands:     line, text, error (0: none), begin_s, end_s, split (of the command); message where there is one
 *   wafers:       name, holder (or null), station, slot, dx, dy, dz (mm), tilt_deg (all six null when it lies
 *                 in no slot), notch_deg (where its notch points, about the station's z from its x; in no slot
 *                 about base's), position [3] (mm), rotation [3][3] (row by row)
 *   events:       utime (us), kind, wafer, gripper (names or null), dr_proj_z, dr_proj_xy [3],
 *                 dr_proj_xy_norm (mm), n1_proj_n2, margins { projz, projxy, planar }, failed (a list of
 *                 "projz", "projxy", "planar"), measured_utime (us, null without a layout); and by kind:
 *                 from (handed_over: the gripper that let go), holder (contested), other (slot_occupied: the
 *                 wafer that lies there), height (released_unsupported, mm), status and message (bad_input,
 *                 whose measured values are null)
 *   clearances:   kind, gap, limit, utime, parts [2], at [3] (null where nothing was near; limit null: none): the smallest
 *                 gaps of a run whose collisions were checked
 *   clearance_curves: kind, times_s, gaps (mm; null: wider than 20): for the kinds that were ever near, the smallest gap
 *                 in each of at most 600 stretches of time, by when it ends; measured then, and the run's smallest
 *   expectations: line, text, ok
 *   cycles:       line, name (or null), begin_s, end_s, wafers: those that the script marked
 *   gantt:        resource ("robot", or "gripper", "valve" or "chuck" of a gripper), gripper (name or null), from_s,
 *                 to_s, what: the robot's and a chuck's time as "loaded" or "empty" (motion), "vacuum", "handover",
 *                 "waiting"; the wafer that a gripper holds; "open" for a valve; in the order of resource and time
 *   reach:        station, slot, axis ("theta", "r", "z", "yaw"), margin, at, end ("min" or "max"), unit ("mm" or "deg"):
 *                 how near each axis comes to an end of its travel in GET and PUT at the first and last slot of each
 *                 station, coming from home: the smaller end, where the axis then stands, and the slot
 *
 * Numbers have 17 significant digits where they need them: reading them back gives the same double, -0 and
 * denormals included. NaN and infinities, which JSON has not, are null. Text that is no UTF-8 gets U+FFFD for
 * each wrong byte.
 */
#ifndef WH_PRINT_RECORD_JSON_H
#define WH_PRINT_RECORD_JSON_H

#include <jansson.h>
#include <stdio.h>

#include "../record/record.h"

/* 0, or -1 if writing failed. Any LC_NUMERIC gives the same bytes. Cost: linear in the record, all of it in memory once
 * more. */
int wh_record_print_json(const wh_record_t *record, FILE *out);

/* The object itself; the caller releases it. */
json_t *wh_record_to_json(const wh_record_t *record);

#endif
