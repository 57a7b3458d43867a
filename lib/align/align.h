/* A wafer in a scan: the place of its centre, its turn, and whether both are sure.
 *
 * One call does everything: the circle (circle.h), the notch or the flats of the nominal wafer (marks.h),
 * and the verdict. The wafer's e1 is the direction to which its nominal marks refer: with a nominal notch
 * in direction 0 the turn is the notch's direction. Each number has its standard deviation, and none is
 * called sure if its deviation exceeds the limits.
 *
 * A notch needs WH_NOTCH_FLANK_LEAST samples on each flank (marks.h has the number for a turn). A scan with
 * fewer is NOTCH_NOT_SURE, by chance or always; a second notch in it is never missed.
 *
 * Bytes of stack on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12 (tests/verify/footprint);
 * the caller's memory is 56 bytes for each sample:
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_align_estimate              2680   2692    3136   3016
 */
#ifndef WH_ALIGN_ALIGN_H
#define WH_ALIGN_ALIGN_H

#include "marks.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(align);

/* The limits of a sure result. All are above 0. */
typedef struct {
    double eccentricity; /* of the centre, mm */
    double radius_off;   /* deviation from the nominal radius, mm */
    double sd_centre;    /* mm */
    double sd_turn;      /* rad */
} wh_align_limits_t;

/* The marks that gave the turn. */
typedef enum WH_FOUR_BYTES {
    WH_ALIGN_MARK_NONE,
    WH_ALIGN_MARK_NOTCH,
    WH_ALIGN_MARK_PRIMARY_FLAT,
    WH_ALIGN_MARK_SECONDARY_FLAT
} wh_align_mark_t;

typedef struct {
    /* WH_OK, or the reason why the result must not be used as it is. It is the first of these:
     * WH_STATUS_OFF_SENSOR, WH_STATUS_CENTRE_NOT_SURE, WH_STATUS_TOO_ECCENTRIC, WH_STATUS_NO_NOTCH,
     * WH_STATUS_TWO_NOTCHES, WH_STATUS_NOTCH_NOT_SURE. The centre is valid from TOO_ECCENTRIC on, the turn
     * only with WH_OK. */
    wh_status_t verdict;
    wh_circle_t circle;  /* all 0 if there is none */
    double eccentricity; /* of the circle's centre, mm */
    double direction;    /* direction of the centre from the axis, chuck's frame, -pi to pi */
    double rms;          /* of the residuals of the samples that count, mm */
    size_t hidden;       /* samples that do not see the rim */
    size_t masked;       /* samples that see the rim but do not count: marks, chips, light through glass */
    wh_align_mark_t mark;
    double turn, sd_turn;          /* turn of the wafer's e1, chuck's frame, -pi to pi; 0 without a mark */
    wh_notch_t notch;              /* its depth is 0 without one */
    wh_notch_seen_t notch_seen;    /* all 0 unless a notch was looked for */
    wh_flat_t flats[WH_RIM_FLATS]; /* the length is 0 if it was not seen */
} wh_align_result_t;

/* Eccentricity 13, radius 0.5, centre 0.002, turn 0.008 degrees. An error of six of these deviations is
 * 0.012 mm and 0.05 degrees. */
wh_align_limits_t wh_align_limits_default(void) WH_SYMBOL(wh_align_limits_default);

/* Estimates centre and turn of the wafer in the scan. It uses the sensor's middle and length. `nominal` is
 * the expected wafer: its radius, its notch if the depth is above 0, else its flats if there are any, and its
 * transmission. `rays` are the caller's memory, one a point; afterwards they hold each sample's residual, for
 * a plot. Returns WH_OK if there is a verdict. Else `result` is unchanged: WH_STATUS_NULL_ARGUMENT,
 * WH_STATUS_NOT_FINITE or WH_STATUS_OUT_OF_RANGE (the nominal wafer, the sensor, the limits, or the scan's
 * offset, pixel or count), WH_STATUS_BAD_SCAN, WH_STATUS_TOO_FEW_SAMPLES, WH_STATUS_OVERLAP (rays among the
 * points). Cost for 3600 samples: about 250 us. */
wh_status_t wh_align_estimate(const wh_rim_scan_t *scan, const wh_sensor_t *sensor, const wh_rim_t *nominal,
                              const wh_align_limits_t *limits, wh_rim_ray_t *rays, wh_align_result_t *result)
    WH_SYMBOL(wh_align_estimate);

WH_HEADER_END

#endif
