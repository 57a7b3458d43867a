/* Centrings on the way. The beams at a station's door measure a wafer that passes them, and motion control
 * estimates its place from them; a log's states give the estimate again.
 *
 * A log contains the latches and the blade's places. It does not contain what motion control knew of the
 * notch's direction, which ALIGN may have found. The direction then counts as not known, and `repeated`
 * says so.
 */
#ifndef WH_RECORD_CENTRINGS_H
#define WH_RECORD_CENTRINGS_H

#include "passes.h"

/* The most centrings that a record keeps; later ones are only counted. */
#define WH_RECORD_CENTRINGS 500

/* x and y are on the blade, in the gripper's frame, mm. */
typedef struct {
    int64_t slice;   /* the last slice that was heard before the estimate */
    int32_t command; /* index in the record, or WH_NONE */
    int32_t station, gripper;
    int32_t wafer;      /* the wafer that the gripper held, or WH_NONE */
    wh_status_t status; /* WH_OK: the centre is centres.candidates[0] */
    int64_t missed;     /* latches without a crossing */
    size_t count;
    wh_pass_crossing_t crossings[WH_CROSSINGS];
    wh_centring_t known; /* the known values that the estimate used */
    wh_centres_t centres;
    double slot_from_blade[2][2]; /* x and y of the blade, in the slot's frame; NaN: not told */
    bool skipped;                 /* the simulator has not had all slices of the pass */
    bool repeated;                /* estimated again from a log's states */
    int64_t lacking;              /* slices of the pass that this log does not have */
} wh_centring_record_t;

/* The values that motion control knows, from the layout, of a wafer of this radius that passes these beams.
 * The notch's direction is not known. */
wh_centring_t wh_centring_known(const wh_layout_t *layout, const wh_latch_order_t *order, double radius);

/* Estimates from the latches so far. Fills in everything except command, wafer, repeated and lacking, which
 * become WH_NONE, false and 0. `status` is the result of wh_centring_solve, or WH_STATUS_TOO_FEW_SAMPLES if
 * a latch has no crossing or the simulator has missed slices. The slot's x is the direction in which the
 * blade came in. */
void wh_centring_estimate(const wh_pass_t *pass, const wh_layout_t *layout, const wh_centring_t *known,
                          wh_centring_record_t *centring);

/* The deviation of candidate `i` in the slot's frame, mm; NaN without one. */
typedef struct {
    double dx, dy;
    double sd_dx, sd_dy; /* standard deviations */
} wh_centring_offset_t;

wh_centring_offset_t wh_centring_offset(const wh_centring_record_t *centring, int32_t i);

/* The distance of crossing `k` outside of the circle of candidate `i`, mm; NaN without one. */
double wh_centring_residual(const wh_centring_record_t *centring, int32_t i, size_t k);

/* The role of crossing `k` for candidate `i`: "rim", "notch" or "other"; "none" without one. */
const char *wh_centring_use(const wh_centring_record_t *centring, int32_t i, size_t k);

#endif
