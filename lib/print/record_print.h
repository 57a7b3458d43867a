/* A run's record, for people and for programs.
 *
 * The tables come in this order; empty ones are left out: the script, its tolerance, and the errors of the
 * cell; the commands, each with the wafers that it took and the values (2)-(5) of each pick beside their
 * limits; the messages of failed commands; each hand-over as the chuck saw it; misses and complaints in
 * plain words; what stations did by themselves; where the wafers are, and which of them a gripper carries
 * tilted; the expectations; wafers per hour; and the verdict.
 *
 * Lengths in mm, angles in degrees, times in simulated seconds. Numbers have enough decimals that rounding
 * never moves them onto a limit or across it; offsets show 1e-9 mm. Equal records give equal bytes, except
 * for the wall time in the last lines. Nothing is cut off at any width.
 *
 * As JSON, one object, its lists with one element a line. The keys, in this order: format (2), ok (null if
 * a log does not show it, and if no command came), nothing_moved (true, only when no command came),
 * failure (only when the run ended in one), errors (only when the cell was given some:
 * [NAME.FIELD=VALUE]), log (only when the run was read from one: { verdict, reason (null if it is the
 * same), id (16 hex digits; null: it is no recording of ours), part, is_part (true, only when other parts
 * were not read), notes [text] }), script, layout (path or null), slices, missed, simulated_s, wall_s,
 * hash (16 hex digits), not_looked_for (in words; null: nothing is known that was not),
 *   counted:      (only of counted time) { played, left_out (slices), moving (those left out in which
 *                 something moved), commands (of which slices were left out), not_looked_for (in
 *                 these slices, in words; null: nothing); with --verify
 *                 stretches (that could be left out), verified (those of them that were played) }
 *   steady_cycle: { wafers_per_hour (null: there is no figure), reason (why not, or why there is no such
 *                 cycle, in words, or null), found, begin_s, end_s, wafers, times (how many like it come in
 *                 a row), cycle (which of the marked ones it is, from 1; null: none is), first_command (its
 *                 index, from 0), commands (how many) }, all null but reason and found where there is none:
 *                 see record/steady.h
 *   throughput:   { wafers_per_hour (null: there is no figure), reason (why not, in words, or null),
 *                 wafers, seconds, first_cycle, last_cycle (of the marked cycles that count, from 1; null:
 *                 the whole run counts), puts (all of the run), counting (the names of the stations that
 *                 count) }: see record/throughput.h
 *   split:        { motion_s, of it loaded_s and empty_s, vacuum_s, handover_s (valves switching),
 *                 waiting_s }: what the run's time went into; motion, vacuum, handover and waiting add up
 *                 to simulated_s
 *   flow:         (only of a cell whose robots are times alone: see flow_json.c)
 * and the lists
 *   commands:     line, text, error (0: none), begin_s, end_s, split (of the command); message where there
 *                 is one
 *   wafers:       name, holder (or null), station, slot, dx, dy, dz (mm), tilt_deg (all six null when it
 *                 lies in no slot), notch_deg (where its notch points, by its own rim if it has one, about
 *                 the station's z from its x; in no slot about base's; null without a notch), position [3]
 *                 (mm), rotation [3][3] (row by row)
 *   events:       utime (us), kind, wafer, gripper (names or null), dr_proj_z, dr_proj_xy [3],
 *                 dr_proj_xy_norm (mm), n1_proj_n2, margins { projz, projxy, planar }, failed (a list of
 *                 "projz", "projxy", "planar"), measured_utime (us, null without a layout); and by kind:
 *                 from (handed_over: the gripper that let go), holder (contested), other (slot_occupied:
 *                 the wafer that lies there), height (released_unsupported, mm; if
 *                 it is for its tilt, that as value, degrees), status and message
 *                 (bad_input, whose measured values are null), seat { dx, dy, s (mm), held } (picked and
 *                 handed_over by an edge grip: where the wafer lies in the pocket, gripper's frame, once the
 *                 plunger has closed, and the plunger then)
 *   station_events: only if stations take time: utime (us), kind ("process_begins", "process_ends",
 *                 "process_cut", "taken", "clean_begins", "clean_ends", "pump_begins", "pump_ends",
 *                 "unprocessed", "late", "clean_missed", "clean_cut": flow/clock.h), station, slot and wafer
 *                 (or null), side (of a pump: "vacuum" or "atmosphere"; else null), seconds: how long what
 *                 begins takes, what ends took, how long a taken wafer stayed after its process, an
 *                 unprocessed one at all, how much a late one too long, and what was left of a missed clean
 *   clearances:   kind, gap, limit, utime, parts [2], at [3] (null where nothing was near; limit null:
 *                 none): the smallest gaps of a run whose collisions were checked
 *   clearance_curves: kind, times_s, gaps (mm; null: wider than 20): for the kinds that were ever near, the
 *                 smallest gap in each of at most 600 stretches of time, by when it ends; measured then,
 *                 and the run's smallest
 *   expectations: line, text, ok
 *   cycles:       line, name (or null), begin_s, end_s, wafers: those that the script marked
 *   gantt:        resource ("robot", or "gripper", "valve" or "chuck" of a gripper, or "door"), gripper
 *                 (its name, or that of the door, or of several robots the robot's; null: the only robot),
 *                 from_s, to_s, what: the robot's and a chuck's time as "loaded" or "empty" (motion),
 *                 "vacuum", "handover", "waiting"; the wafer that a gripper holds; "open" for a valve; in
 *                 the order of resource and time
 *   reach:        station, slot, axis ("theta", "r", "z", "yaw"), margin, at, end ("min" or "max"), unit
 *                 ("mm" or "deg"): how near each axis comes to an end of its travel in GET and PUT at the
 *                 first and last slot of each station, coming from home: the smaller end, where the axis
 *                 then stands, and the slot
 *   centrings:    only if the layout has beams: what they told of wafers on their way into a station
 *                 (record/centrings.h). at_s, command (its index; null: not told), station, gripper, wafer
 *                 (null: not told), error (0: none) and sure (both null of a log, which does not tell all
 *                 that motion control knew), missed (latches), skipped (the simulator has missed slices),
 *                 repeated (estimated again from a log, which
 *                 does not tell the notch's direction), lacking (slices of the pass that the log has not),
 *                 known { radius,
 *                 sd_radius, notch_deg, sd_notch_deg (on the blade; null: not known) }, crossings: [{ beam
 *                 (from 1 at the station), edge ("in" or "out"), use ("rim", "notch", "other", by the first
 *                 candidate; "none" without one), x, y (on the blade, mm), time }], candidates, the likelier
 *                 first: [{ x, y (on the blade), dx, dy (in the slot's frame; null: not told), radius,
 *                 sd_dx, sd_dy, sd (in the worst direction), mismatch, used, uses and residuals_um (of each
 *                 crossing, by this candidate) }], words: [text], the verdict first
 *
 * Numbers have 17 significant digits where they need them: reading them back gives the same double, -0 and
 * denormals included. NaN and infinities, which JSON has not, are null. Text that is no UTF-8 gets U+FFFD
 * for each wrong byte.
 */
#ifndef WH_PRINT_RECORD_PRINT_H
#define WH_PRINT_RECORD_PRINT_H

#include <jansson.h>

#include "../record/record.h"
#include "../text/style.h"

/* Sections that are printed when asked for, before the expectations. Zero it to begin with. */
typedef struct {
    /* The busy times of each part, with time along the line, as wide as the terminal; and the parts of each
     * command's time. */
    bool gantt;
    double from_s, to_s; /* the stretch of the run that this section shows; to_s 0: up to the end */
    /* The Gantt section of the first steady cycle alone, with its duration and its wafers per hour; or why
     * there is none (record/steady.h). */
    bool cycle;
    /* How near the axes come to the ends of their travel at each station. */
    bool margins;
    /* Sums alone: no rows of commands, stations and wafers. The record may have dropped them. */
    bool brief;
} wh_record_sections_t;

/* With these sections; null: with none. 0, or -1 if writing failed (then what is printed may be incomplete).
 * `style` is usually wh_style_of(out). Cost: linear in the record. */
int wh_record_print_table(const wh_record_t *record, FILE *out, const wh_style_t *style,
                          const wh_record_sections_t *sections);

/* 0, or -1 if writing failed. Any LC_NUMERIC gives the same bytes. Cost: linear in the record, all of it in
 * memory once more. */
int wh_record_print_json(const wh_record_t *record, FILE *out);

/* The object itself, and its `throughput` alone; the caller releases it. */
json_t *wh_throughput_to_json(const wh_record_t *record);
json_t *wh_record_to_json(const wh_record_t *record);
json_t *wh_flow_to_json(const wh_flow_t *flow);

/* One element of `events`, of `station_events`, and of `centrings`; the caller releases it. `record` is a
 * wh_record_t. */
json_t *wh_event_to_json(const void *record, size_t i);
json_t *wh_station_event_to_json(const void *record, size_t i);
json_t *wh_centring_to_json(const void *record, size_t i);

/* The names of two parts that touch or come near. */
json_t *wh_parts_to_json(const wh_record_t *record, const int32_t parts[2]);

#endif
