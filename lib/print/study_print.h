/* A study's result, for people and for programs.
 *
 * As JSON one object, format 1, its lists with one element a line:
 *   format, ok (whether `require` is kept; true without it), script, layout, seed, trials,
 *   success:      { met, rate, low, high }: trials that met all expectations without an uncaught error or a
 *                 complaint of the cell; low and high are Wilson's interval at 95 % here and below
 *   require       (or null), ended (trials whose script ended by an uncaught error),
 *   whole         (trials that ran the script whole), whole_why (why all did, or null),
 *   noise_alone   (true if no error is drawn: trials differ in the noise of sensors alone),
 *   drawn_aside   (the number of drawn errors that are not in `drawn`: of wafers and stations that the run
 *                 without errors neither moves nor goes to),
 *   run_without_errors: { ok, hash, slices, simulated_s, throughput (as of a run), never_came (only if
 *                 faults or errors on purpose did not come: their list in words) }
 * and the lists
 *   expectations: line, text, seen (trials that came to it), met, rate, low, high, first_missed (the lowest
 *                 trial, or null); that of a PUT, or of the script's end, only if a trial did not meet it
 *   errors:       line, text (of the command: each has its own), error, name, trials (in which it
 *                 happened), rate, low, high, first
 *   events:       kind, complaint (of the cell), trials (with one or more), rate, low, high, total
 *   wafers:       name, station, slot, holder (where the run without errors leaves it; null: nowhere),
 *                 elsewhere (trials that leave it anywhere else; the figures are of the others), count, and
 *                 for dx, dy, dz (mm), tilt_deg, and off (mm, beside where the run without errors leaves
 *                 it): { mean, deviation, min, p0_1, p1, p5, p50, p95, p99, p99_9, max }
 *   flow:         of a script with a flow: unfinished (trials whose flow did not come to its end with all
 *                 wafers: without a makespan), unsteady (whose cycle is the mean over the middle third of the
 *                 wafers), no_cycle (with fewer than nine wafers: without one), clipped (that drew a
 *                 process shorter than 0 s, which took none), and makespan_s, cycle_s, per_hour,
 *                 robots_wait_s and wafers_wait_s (all of them together; of wafers that are done), late_stays
 *                 (their number, beyond windows; each null: no trial has it): { without_errors, count, mean,
 *                 deviation, min, p0_1, ..., max }
 *   drawn:        the errors that are drawn and concern the run (study/concerns.h), the one that goes with
 *                 failing most strongly first: kind (wafer, station, gripper, vacuum, rim, beam,
 *                 process), of (a name;
 *                 null: of all), what, unit, width,
 *                 failing: { by_size, by_value }, ends: of each wafer { wafer, dx, dy, dz, tilt_deg, off },
 *                 flow: of a script with one { makespan_s, cycle_s, per_hour }.
 *                 Each is { r, low, high }, a correlation with its interval (study/relations.h), or null: not
 *                 determined
 *   worst:        trial, ok, off (of the wafer farthest off; null: one is
 *                 elsewhere), why (it failed, in words; null: it is ok), of a script with a flow its
 *                 figures, as above, drawn: { wafers,
 *                 stations, rims, beams, valves, vacuum_s, processes (name, process_s) } what the trial
 *                 drew: of each wafer { name, dx, dy, dz, tilt_x, tilt_y, turn }, of each station { name,
 *                 x, y, z, roll, pitch, yaw } (mm, degrees), of each rim { name, diameter, ... }
 *                 (layout/rim_errors.h: mm, degrees), of each beam { name, dx, dy, late_s }, of each valve
 *                 { gripper, slices }, which act so late; only of what is drawn.
 *                 Failed trials come first, then the farther off, then the longer flow.
 * Equal studies give equal bytes, whatever threads, ranks and interruptions they had; a number read back
 * is the same double.
 */
#ifndef WH_PRINT_STUDY_PRINT_H
#define WH_PRINT_STUDY_PRINT_H

#include <jansson.h>

#include "../study/tally.h"
#include "../text/style.h"

typedef struct {
    const wh_study_t *study;
    const wh_tally_t *tally; /* of all trials, sorted */
    double require;          /* the rate that is required; 0: none */
    size_t worst;            /* how many of the worst trials are told */
} wh_study_result_t;

/* True if the success rate's interval begins at or above the required rate. */
bool wh_study_is_kept(const wh_study_result_t *result);

/* 0, or -1 if writing failed. */
int wh_study_print_table(const wh_study_result_t *result, FILE *out, const wh_style_t *style);
int wh_study_print_json(const wh_study_result_t *result, FILE *out);

/* The object that wh_study_print_json prints. */
json_t *wh_study_to_json(const wh_study_result_t *result);

/* Each trial as a line of CSV, by RFC 4180 but with lines that end with a line feed. The tally has the
 * lines of all trials. Columns: trial; ok, whole and ended, 1 or 0 as of the JSON; how many expectations
 * were missed, commands ended with an error, events of the cell were complaints, wafers are elsewhere; off
 * mm; of a script with a flow its figures, as in JSON; of each wafer dX, dY, dz (mm) and tilt
 * (deg) in its slot, empty if it is elsewhere; and what the trial drew, of each error whose width is not
 * 0, told as a cause or not. Numbers read back as the same double. 0, or -1 if writing failed. */
int wh_study_print_csv(const wh_study_result_t *result, FILE *out);

/* An expectation's text without what was found. Writes at most `size` bytes. */
void wh_study_expected(const char *text, char *expected, size_t size);

/* The wafer's value of a quantity without errors; `q` below WH_TALLY_OFF; degrees for the tilt. */
double wh_study_nominal(const wh_study_wafer_t *wafer, size_t q);

#endif
