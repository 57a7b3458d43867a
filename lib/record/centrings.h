/* Centrings on the way: what the beams at a station's door told of a wafer that passed them, as motion
 * control estimated it; of a log, as its states tell it again.
 *
 * A log has the latches and the blade's places. It has not what motion control knew of the notch's direction,
 * which ALIGN may have found; there the direction counts as not known, and `repeated` says so.
 */
#ifndef WH_RECORD_CENTRINGS_H
#define WH_RECORD_CENTRINGS_H

#include "passes.h"

/* The most centrings that a record keeps; later ones are only counted. */
#define WH_RECORD_CENTRINGS 500

/* x and y are on the blade, in the gripper's frame, mm. */
typedef struct {
    int64_t slice;   /* the last one that was heard before the estimate */
    int32_t command; /* index in the record, or WH_NONE */
    int32_t station, gripper;
    int32_t wafer;      /* that the gripper held, or WH_NONE */
    wh_status_t status; /* WH_OK: the centre is centres.candidates[0] */
    int64_t missed;     /* latches without a crossing */
    size_t count;
    wh_pass_crossing_t crossings[WH_CROSSINGS];
    wh_centring_t known; /* what the estimate went by */
    wh_centres_t centres;
    double slot_from_blade[2][2]; /* x and y on the blade, as seen in the slot's frame; NaN: not told */
    bool skipped;                 /* the simulator has not had all slices of the pass */
    bool repeated;                /* estimated again from a log's states */
    int64_t lacking;              /* slices of the pass that this log has not */
} wh_centring_record_t;

/* What motion control knows of a wafer of this radius that passes these beams: from the layout. The notch's
 * direction is not known. */
wh_centring_t wh_centring_known(const wh_layout_t *layout, const wh_latch_order_t *order, double radius);

/* What the latches so far tell. Fills in all but command, wafer, repeated and lacking, which become WH_NONE,
 * false and 0. `status` is what wh_centring_solve says, or WH_STATUS_TOO_FEW_SAMPLES if a latch has no
 * crossing or the simulator has missed slices. The slot's x is the way on which the blade came in. */
void wh_centring_estimate(const wh_pass_t *pass, const wh_layout_t *layout, const wh_centring_t *known,
                          wh_centring_record_t *centring);

/* How far candidate `i` is off in the slot's frame, mm; NaN without one. */
typedef struct {
    double dx, dy;
    double sd_dx, sd_dy; /* standard deviations */
} wh_centring_offset_t;

wh_centring_offset_t wh_centring_offset(const wh_centring_record_t *centring, int32_t i);

/* How far crossing `k` is outside of the circle of candidate `i`, mm; NaN without one. */
double wh_centring_residual(const wh_centring_record_t *centring, int32_t i, size_t k);

/* What crossing `k` was taken for by candidate `i`: "rim", "notch" or "other"; "none" without one. */
const char *wh_centring_use(const wh_centring_record_t *centring, int32_t i, size_t k);

#endif
