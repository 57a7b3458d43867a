/* Calibrating an edge sensor with a known wafer: offset, zero, gain and latency from scans of it.
 *
 * The wafer's radius is known; where it lies need not be. It is scanned in two places or more, and in each of
 * them while the chuck turns either way. How far it was moved from the first place is known: a robot carried
 * it, or a stage. What the four errors do to the centre c and the radius that a scan tells:
 *
 *     latency t   turns c about the axis by the chuck's speed times t, the other way if it turns so
 *     offset d    turns c by -d / R, whichever way the chuck turns
 *     gain g      makes c shorter by the part g
 *     zero z      makes the radius smaller by z, and g by g times the rim's distance from the inner end
 *
 * So both ways of turning tell the latency, and the way from place to place tells offset and gain: its
 * direction the one, its length the other. A way that is wrong by w in a length of L makes each centre at an
 * eccentricity e wrong by w e / L: move the wafer far, say from 7 mm on one side of the axis to 7 mm on the
 * other. The effects above are of first order; the scans are corrected and fitted again until nothing moves.
 *
 * What was found goes where a controller keeps what it believes: `believed` of wh_sensor_point, and its
 * offset into each wh_rim_scan_t. Lengths in mm, times in s, angles in rad, in the chuck's frame, which at
 * turn 0 is the station's: a way that was made at another turn is to be turned back by that. No heap, no
 * state; the same bits on every machine.
 *
 * Bytes of stack on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12 (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_calibration_solve           2168   2040    2512   2328
 */
#ifndef WH_ALIGN_CALIBRATION_H
#define WH_ALIGN_CALIBRATION_H

#include "circle.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(calibration);

/* The most scans of a calibration, and the fewest: two places, both ways of turning. */
#define WH_CALIBRATION_SCANS 32
#define WH_CALIBRATION_LEAST 4

/* The ways differ by this at least, mm, and the speeds by this, rad/s. */
#define WH_CALIBRATION_WAY 1
#define WH_CALIBRATION_SPEED 0.1

typedef struct {
    const wh_rim_point_t *points; /* as wh_sensor_point makes them if nothing (null) is believed */
    size_t count;                 /* up to WH_SENSOR_SAMPLES */
    double speed;                 /* of the chuck, the same all the while, by its sign the way; -100 to 100 */
    double way_x, way_y;          /* of the wafer from where it lay in the first scan, each up to 300 */
} wh_calibration_scan_t;

typedef struct {
    wh_sensor_error_t error;                        /* as wh_sensor_point believes it */
    double sd_offset, sd_zero, sd_gain, sd_latency; /* without the radius' own error, which is the zero's */
    double x, y;                                    /* of the wafer's centre in the first scan */
    double mismatch; /* sum of squares of what remains, in deviations; 3 a scan, less 6, on average */
} wh_calibration_t;

/* Of the sensor middle, length and pixel count. `radius` is the wafer's, 10 to 300; `sd_way` the standard
 * deviation of each place's way, x and y alike, 0 to 1; scans with the same way are of one place. `points`
 * and `rays` are the caller's memory, each as many as the longest scan has.
 *
 * WH_OK; or, `calibration` then unchanged: WH_STATUS_NULL_ARGUMENT; WH_STATUS_NOT_FINITE or
 * WH_STATUS_OUT_OF_RANGE for a number; WH_STATUS_TOO_FEW_SAMPLES for fewer scans than WH_CALIBRATION_LEAST,
 * or for what wh_circle_fit says so, as WH_STATUS_BAD_SCAN is; WH_STATUS_CENTRE_NOT_SURE for a scan that
 * tells no circle, for ways or speeds that do not differ, for an error out of the range of wh_sensor_error_t,
 * and for scans that contradict each other as chance does once in a million. *bad, which may be null, is the
 * scan, or WH_NONE if it is none alone. Cost: wh_circle_fit five times a scan. */
wh_status_t wh_calibration_solve(const wh_sensor_t *sensor, double radius, double sd_way,
                                 const wh_calibration_scan_t *scans, size_t count, wh_rim_point_t *points,
                                 wh_rim_ray_t *rays, wh_calibration_t *calibration, int32_t *bad)
    WH_SYMBOL(wh_calibration_solve);

WH_HEADER_END

#endif
