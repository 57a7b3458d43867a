/* A run as one JSON object: what the page of a report shows, and what other programs may read.
 *
 * Lengths in mm, angles in rad, times in s from the run's begin; poses are r [x, y, z] and the quaternion q
 * [x, y, z, w]; indices are from 0, slots from 1. The members:
 *   format (2), title, version, reproduce (the command that makes the run again), parameters { name: value }
 *   source       "run", "log", "session" or "live"; notes: [text], what a log did not tell, and what was
 *                not looked at or for
 *   run          what `run --json` prints, whole (print/record_print.h), with centrings on the way; of a log
 *                what it holds
 *   slice_s, slices, begin_s (0 but for a log that begins within a run), duration_s. A flow by times alone
 *                has no slices, and ends here
 *   names        wafers, grippers, stations, doors (only if there are any): [name]; axes: [{ name, unit "mm"
 *                or "rad", low, high, speed }] (nulls: not known)
 *   wafer        diameter, thickness, notch (about its z from its x; only if it has one)
 *   limits       projz, projxy, planar, near_projz, near_projxy
 *   slots        [{ station, slot, r, q }]: base_from_slot
 *   machine      grippers [{ axis, r, q }]: for a chuck the axis that turns it and base_from_station, on the
 *                robot null and effector_from_gripper; doors [{ axis, way }]: base_from_door is the position
 *                of its axis along `way`, in base; links: names of the arm's links; arm { reach, link,
 *                right_handed } (collision/arm.h)
 *   thinning     the largest errors of the tracks: mm, rad (axes), gripper_mm, gripper_rad, vacuum, projz,
 *                projxy, planar; `of` samples, `kept` of them. At events and at the begin and end of each
 *                command there is no error
 *   tracks       axes [curve]. A curve is { t, v, slope } (slope per second). Between two points it is the
 *                cubic with the value and the slope of both. If v and slope are null, there is no curve from
 *                there to the next point, as before the first point; after the last point nothing changes.
 *                The slope of an axis is its speed
 *                grippers [{ t, r, q }]: base_from_gripper from the first of these points on, r linear and q
 *                the shorter slerp. Before it, and without points, base_from_gripper follows from the axes
 *                (motion/machine.h): on the robot, whose axes are theta, R, Z and yaw, from an end-effector
 *                at (R cos theta, R sin theta, Z), turned about z by theta + yaw; for a chuck, turned about
 *                the station's z by its axis. Links follow from the end-effector
 *                wafers [[{ t, holder (gripper or null), r, q }]]: from t on gripper_from_wafer or
 *                base_from_wafer
 *                valves (0: open), sensors (1: on), nearest (a wafer or null), for each gripper [{ t, v }]:
 *                from t on
 *                vacuum [curve], 0 to 1
 *                proximity [{ dr_proj_z, dr_proj_xy, n1_proj_n2 }]: curves, the first two as absolute values:
 *                each gripper against `nearest`: the wafer that it holds, or otherwise the one nearest to the
 *                three limits together (record/counterpart.h), while it is within 20 mm and twice
 *                near_projxy
 *                clearances [{ pair, limit (null: none), t, gap (null: wider than 20 mm) }]; none of
 *                counted time, which does not look for them in slices left out
 *   marks        [{ t, kind, text, at (null: nowhere) }]: events that get a mark in the cell
 *   scans        edge scans (record/scans.h), in the chuck's frame: [{ number, begin_s, end_s, gripper,
 *                station (or null), count (ordered; below 0 clockwise), taken, missed (of them), verdict
 *                (math/status.def; 0: sure), sure, words [text], circle { x, y, radius, sd_centre,
 *                sd_radius } (null: none), mark { kind, at (direction from the axis), turn, sd_turn } (null:
 *                none), and for each taken sample theta (direction of the sensor), rho (null: missing, or no
 *                rim), residual (rho minus the circle's; null: no circle), counts (1; 0: not for the
 *                circle) }]
 *   scans_left_out   the number of further scans, more than a document holds
 *   scene        glTF 2.0 (scene/scene.h), without animation
 *   now          only of a run that goes on: the last sample of each curve (report/tracks_document.h). Its
 *                source is "live"; thinning is null, as the curves are samples some 60 times a second;
 *                `run` has the lists alone
 */
#ifndef WH_REPORT_DOCUMENT_H
#define WH_REPORT_DOCUMENT_H

#include <jansson.h>
#include <stdio.h>

#include "../record/record.h"
#include "../record/signals.h"

typedef struct {
    const char *title, *reproduce;
    const char *source;            /* "run", "log" or "session" */
    const char *const *parameters; /* NAME=VALUE */
    size_t parameter_count;
    const char *const *notes;
    size_t note_count;
    json_t *run;                 /* borrowed */
    const wh_record_t *record;   /* for its curves and limits; its layout is the signals' */
    const wh_signals_t *signals; /* finished, unless is_live; null: of a flow by times alone */
    bool is_live;                /* the run goes on; its signals are samples now and then */
} wh_document_t;

/* 0, or -1 when `out` does not take it. Ends the program if out of memory. */
int wh_document_write(const wh_document_t *document, FILE *out);

#endif
