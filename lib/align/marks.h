/* The marks of a wafer in a scan whose circle is known: a notch by both of its flanks, flats by their chords.
 *
 * A notch is a V: its axis, the depth of its apex and its opening are fitted to the samples from 0.08 to 0.70
 * of its depth, on both flanks together, so that neither the roundings of its corners nor its bottom count.
 * The opening is known beforehand: the nominal one and 1.5 degrees, give or take 1.5. Then flanks and bottom
 * are held against one V with a rounded bottom (the nominal radius, give or take 0.08): a chip in a flank may
 * look like a flank, but the bottom is not where that says. If they are off together by more than the noise,
 * the standard deviation is enlarged by as much, and where it cannot be chance it is no notch. A dent is none
 * if its rim stands where a notch, chipped or not, would have none; what remains, such as a chip wider and
 * deeper than a notch, leaves the verdict open, unless the notch was seen so well (a scatter up to 8 um) that
 * it cannot be a chip itself. Where the notch is hidden, a chip that is as all of this says is taken for it:
 * of a scatter of 10 um and more, one some 2.7 mm wide and 1 mm deep. A flat is a chord: rho(a) = h / cos(a),
 * of the length 2 sqrt(R^2 - h^2).
 */
#ifndef WH_ALIGN_MARKS_H
#define WH_ALIGN_MARKS_H

#include "circle.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(marks);

typedef struct {
    double direction;    /* of its axis, chuck's frame, from the circle's centre, -pi to pi */
    double sd_direction; /* with the circle's own */
    double depth;        /* of its bottom, if that is rounded as the nominal one, mm */
    double opening;      /* rad */
    size_t used;         /* samples on both flanks that count */
} wh_notch_t;

typedef struct {
    double direction;    /* of its middle, as a notch's */
    double sd_direction; /* with the circle's own */
    double length;       /* mm */
    size_t used;
} wh_flat_t;

/* The notch of a scan, as wh_circle_fit left rays and circle; `nominal` is a notch that wh_rim_validate
 * accepts, whose direction does not count. `glass`: single samples may see through the wafer.
 * WH_OK; WH_STATUS_NOTCH_NOT_SURE: a dent could be the notch or another one, or not all of the rim was seen
 * and no notch; WH_STATUS_NO_NOTCH; WH_STATUS_TWO_NOTCHES. If it fails, `notch` is unchanged. Nothing is
 * checked. Cost for 3600 samples: about 15 us. */
wh_status_t wh_notch_find(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_circle_t *circle,
                          const wh_notch_shape_t *nominal, bool glass, wh_notch_t *notch)
    WH_SYMBOL(wh_notch_find);

/* The flats of a scan, by their lengths, give or take 3.5 mm: flats[f] is the one of nominal[f]; its length
 * is 0 if it was not seen. A nominal length of 0: there is none.
 * WH_OK: at least one was found, and nothing that contradicts it; WH_STATUS_NOTCH_NOT_SURE: its length is not
 * of one nominal flat alone, or two lie otherwise than the nominal ones by more than 5 degrees, or not all of
 * the rim was seen and no flat; WH_STATUS_NO_NOTCH: no flat. If it fails, `flats` are unchanged. Nothing is
 * checked. Cost: about 40 us. */
wh_status_t wh_flats_find(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_circle_t *circle,
                          const wh_flat_shape_t nominal[WH_RIM_FLATS], wh_flat_t flats[WH_RIM_FLATS])
    WH_SYMBOL(wh_flats_find);

WH_HEADER_END

#endif
