/* Calibrating an edge sensor with a known wafer: offset, zero, gain and latency from scans of it.
 *
 * The wafer's radius is known; its place may be unknown. It is scanned in two places or more, and in each
 * of them with the chuck turning in both directions. The distance from the first place is known: a robot or
 * a stage moved it. The four errors change the centre c and the radius of a scan:
 *
 *     latency t   turns c about the axis by the chuck's speed times t, the other way if it turns so
 *     offset d    turns c by -d / R, whichever way the chuck turns
 *     gain g      makes c shorter by the part g
 *     zero z      makes the radius smaller by z, and g by g times the rim's distance from the inner end
 *
 * So both directions of turning give the latency, and the way from place to place gives offset and gain:
 * its direction gives the offset, its length the gain. If a way has an error of w in a length of L, each
 * centre at an eccentricity e has an error of w e / L. So move the wafer far, for example from 7 mm on one
 * side of the axis to 7 mm on the other. The effects above are of first order; the scans are corrected and
 * fitted again until the result no longer changes.
 *
 * The result goes to the place where a controller keeps its assumptions: `believed` of wh_sensor_point, and
 * its offset into each wh_rim_scan_t. Lengths are in mm, times in s, angles in rad, in the chuck's frame,
 * which at turn 0 is the station's. If a way was made at another turn, turn it back by that. It uses no
 * heap and no state, and has equal bits on every machine.
 *
 * Bytes of stack on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12 (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_calibration_solve           2168   2040    2520   2320
 */
#ifndef WH_ALIGN_CALIBRATION_H
#define WH_ALIGN_CALIBRATION_H

#include "circle.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(calibration);

/* The most scans of a calibration, and the fewest: two places, with both directions of turning. */
#define WH_CALIBRATION_SCANS 32
#define WH_CALIBRATION_LEAST 4

/* The least difference of the ways, mm, and of the speeds, rad/s. */
#define WH_CALIBRATION_WAY 1
#define WH_CALIBRATION_SPEED 0.1

typedef struct {
    const wh_rim_point_t *points; /* as wh_sensor_point makes them without assumptions (null) */
    size_t count;                 /* up to WH_SENSOR_SAMPLES */
    double speed;                 /* of the chuck, constant; its sign is the direction; -100 to 100 */
    double way_x, way_y;          /* of the wafer from its place in the first scan, each up to 300 */
} wh_calibration_scan_t;

typedef struct {
    wh_sensor_error_t error;                        /* for the assumptions of wh_sensor_point */
    double sd_offset, sd_zero, sd_gain, sd_latency; /* without the radius' own error, a part of the zero's */
    double x, y;                                    /* of the wafer's centre in the first scan */
    double mismatch; /* sum of squared residuals, in deviations; on average 3 for each scan, less 6 */
} wh_calibration_t;

/* It uses the sensor's middle, length and pixel count. `radius` is the wafer's, 10 to 300. `sd_way` is the
 * standard deviation of each place's way, x and y alike, 0 to 1. Scans with equal ways are of one place.
 * `points` and `rays` are the caller's memory, each with the length of the longest scan.
 *
 * Returns WH_OK, or an error, which leaves `calibration` unchanged. WH_STATUS_NULL_ARGUMENT;
 * WH_STATUS_NOT_FINITE or WH_STATUS_OUT_OF_RANGE for a number. WH_STATUS_TOO_FEW_SAMPLES for fewer scans
 * than WH_CALIBRATION_LEAST. WH_STATUS_TOO_FEW_SAMPLES and WH_STATUS_BAD_SCAN from wh_circle_fit.
 * WH_STATUS_CENTRE_NOT_SURE for a scan without a circle, for ways or speeds that do not differ, for an
 * error out of the range of wh_sensor_error_t, and for scans that contradict each other as chance does once
 * in a million. *bad, which may be null, is the scan, or WH_NONE if it is not a single one. Cost: five
 * times wh_circle_fit for each scan. */
wh_status_t wh_calibration_solve(const wh_sensor_t *sensor, double radius, double sd_way,
                                 const wh_calibration_scan_t *scans, size_t count, wh_rim_point_t *points,
                                 wh_rim_ray_t *rays, wh_calibration_t *calibration, int32_t *bad)
    WH_SYMBOL(wh_calibration_solve);

WH_HEADER_END

#endif
