/* The marks of a wafer in a scan whose circle is known: a notch by both of its flanks, flats by their
 * chords.
 *
 * A notch is a V: its axis, the depth of its apex and its opening are fitted to the samples from 0.08 to 0.70
 * of its depth, on both flanks together, so that neither the roundings of its corners nor its bottom count.
 * The opening is known beforehand: the nominal one plus 1.5 degrees, with a deviation of 1.5. Then flanks and
 * bottom are compared with one V with a rounded bottom (the nominal radius, with a deviation of 0.08): a chip
 * in a flank may look like a flank, but then the bottom is at another place. If they deviate together by more
 * than the noise, the standard deviation grows by that factor; if that cannot be chance, the dent is not a
 * notch. A dent is also not a notch if it has rim at a place where a notch, chipped or not, has none. Any
 * other dent, such as a chip wider and deeper than a notch, leaves the verdict open, unless the notch was
 * seen so well (a scatter up to 8 um) that it cannot be a chip itself. A dent with too few samples always
 * leaves it open: each flank needs two; if light comes through, both together need three. If the notch is
 * hidden, a chip that fits all of this is taken for it: with a scatter of 10 um and more, one about 2.7 mm
 * wide and 1 mm deep. A flat is a chord: rho(a) = h / cos(a), of the length 2 sqrt(R^2 - h^2).
 */
#ifndef WH_ALIGN_MARKS_H
#define WH_ALIGN_MARKS_H

#include "circle.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(marks);

typedef struct {
    double direction;    /* direction of its axis, chuck's frame, from the circle's centre, -pi to pi */
    double sd_direction; /* includes the circle's own */
    double depth;        /* depth of its bottom, if that is rounded like the nominal bottom, mm */
    double opening;      /* rad */
    size_t used;         /* samples on both flanks that count */
} wh_notch_t;

/* The samples that a notch needs on each flank. A flank is straight for 0.62 of the notch's depth. A SEMI
 * notch 1 mm deep always has two samples there if samples are at most 0.31 mm apart on the rim: 3,041 in a
 * turn for 300 mm, 2,028 for 200 mm, and 2 % more for a centre that is 2 % of the radius off the chuck's.
 * With fewer samples it depends on their places. */
#define WH_NOTCH_FLANK_LEAST 2

/* The dent of a scan most like the notch: a dent judged a notch, else one that may be a notch, else the
 * deepest. */
typedef struct {
    double depth; /* of its V's bottom, or of the dent if no V fits, mm; 0: no dent at all */
    double depth_least, depth_most; /* of a notch, mm */
    size_t flanks[2]; /* its samples on the V's flanks, clockwise from its axis and counter-clockwise */
    size_t off;       /* samples in it and beside it that do not fit a notch, or see no rim */
    /* A place where it is narrower than any notch: the distance below the circle, its width there, and
     * the least width of a notch, mm; all 0: nowhere. Such a dent gets no V: flanks and off are 0. */
    double narrow_at, width, width_least;
} wh_notch_seen_t;

typedef struct {
    double direction;    /* direction of its middle, as for a notch */
    double sd_direction; /* includes the circle's own */
    double length;       /* mm */
    size_t used;
} wh_flat_t;

/* Finds the notch of a scan, with rays and circle from wh_circle_fit; `nominal` is a notch that
 * wh_rim_validate accepts, whose direction does not count. `glass`: single samples may see through the
 * wafer. Returns WH_OK; WH_STATUS_NOTCH_NOT_SURE: a dent could be the notch or another one, or the rim
 * was not fully seen and there is no notch; WH_STATUS_NO_NOTCH; WH_STATUS_TWO_NOTCHES. If it fails,
 * `notch` is unchanged; `seen` is always set. Nothing is checked. Cost for 3600 samples: about 15 us. */
wh_status_t wh_notch_find(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_circle_t *circle,
                          const wh_notch_shape_t *nominal, bool glass, wh_notch_t *notch,
                          wh_notch_seen_t *seen) WH_SYMBOL(wh_notch_find);

/* Finds the flats of a scan by their lengths, to 3.5 mm: flats[f] is the one of nominal[f]; its length is 0
 * if it was not seen. A nominal length of 0: there is none. Returns WH_OK: at least one was found, and
 * nothing contradicts it. WH_STATUS_NOTCH_NOT_SURE: its length fits more than one nominal flat, or the
 * angle between two differs from the nominal one by more than 5 degrees, or the rim was not fully seen and
 * there is no flat. WH_STATUS_NO_NOTCH: no flat. If it fails, `flats` are unchanged. Nothing is checked.
 * Cost: about 40 us. */
wh_status_t wh_flats_find(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_circle_t *circle,
                          const wh_flat_shape_t nominal[WH_RIM_FLATS], wh_flat_t flats[WH_RIM_FLATS])
    WH_SYMBOL(wh_flats_find);

WH_HEADER_END

#endif
