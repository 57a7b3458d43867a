/* Centring on the way: where a wafer lies on a blade, from the moments at which its rim crossed beams.
 *
 * Beams of light stand upright at a station's door, beside the way of the blade. Each is broken when the rim
 * comes in and is free again when the rim has left: a crossing is the point of the blade's frame that was in
 * the beam at that moment. The rim is a circle of a known radius R, so two unknowns remain, x and y of its
 * centre. They minimise the squares of
 *
 *     (distance of the crossing from the centre - R) / (its standard deviation)
 *
 * where the deviation is that of the latch's time, times how fast the beam went through the rim. With two
 * beams at the distances d and -d from the way and sigma along the way for each of four crossings this gives
 * sd_x = sigma / 2 and sd_y = sigma h / (2 d), h = sqrt(R^2 - d^2): beams far apart tell y better.
 *
 * Notch. A crossing in the notch is up to 1.25 mm further in and must not count. Where the notch's direction
 * is known, crossings in its arc are left out. Where it is not, the crossings themselves tell: three that fit
 * one circle of radius R leave out the fourth. This takes beams at different distances from the way. With
 * equal ones, d and -d, two crossings that face each other across the centre explain a hit equally well, by
 * circles that are up to 1 mm apart: such a hit is WH_STATUS_CENTRE_NOT_SURE, with both candidates. With +60
 * and -110 at R = 150 all hits of 0.1 mm and more are told apart if sigma is up to 5 um; hits below 7 sigma
 * count as noise, and move the centre by less than that.
 *
 * The blade's own edges cross beams, too. A crossing that fits no rim, or whose direction (in or out) is not
 * the rim's, is left out as WH_CROSSING_OTHER. So is a crossing on a flat, if three others agree.
 *
 * Latency. A latch comes late by its delay, t_on at a beam that is broken, t_off at one that gets free. Who
 * makes the points takes off what is believed of the delays. What is not taken off moves a crossing by v t
 * the way the beam goes over the blade, 10 um for 10 us at 1 m/s. So one pass is off by v (t_on + t_off) / 2
 * along the way. Two passes at equal speeds, in and out, given together, cancel that: the front rim is then
 * off by v (t_on - t_off) / 2 and the rear rim by as much the other way. That leaves x right and makes the
 * chord too long or too short, as a wrong radius does: it enters y unless beams stand alike on both sides. A
 * radius that is wrong by 0.1 mm moves y by 0.08 mm with beams at +60 and -110: give sd_radius.
 *
 * A beam that stands elsewhere than believed by d moves the centre by up to d / 2 along the way and, with
 * beams at +60 and -110 and a radius that is not exact, by 0.6 d across it. Chords whose middles differ by
 * more than about 6 deviations contradict each other; with sd_radius three crossings and another radius may
 * still fit. Such a radius is believed up to 3 sd_radius, and by how much it may have moved the centre counts
 * in the deviations. For beams whose places are not known exactly there is sd_place.
 *
 * Lengths in mm, times in s, angles in rad, in the plane of the wafer and in the blade's frame. No heap, no
 * state; the same bits on every machine.
 */
#ifndef WH_ALIGN_CENTRING_H
#define WH_ALIGN_CENTRING_H

#include "rim.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(centring);

/* The most crossings of one estimate, and the fewest that tell a centre. */
#define WH_CROSSINGS 16
#define WH_CROSSINGS_LEAST 3

typedef enum WH_FOUR_BYTES {
    WH_CROSSING_IN, /* the beam is broken: it goes into the wafer */
    WH_CROSSING_OUT /* it is free again */
} wh_crossing_edge_t;

typedef struct {
    double x, y;   /* of the blade's frame, in the beam at that moment, -1e3 to 1e3 */
    double vx, vy; /* of the beam over the blade, mm/s, together 0.01 to 1e4 */
    int32_t beam;  /* which, 0 or more */
    wh_crossing_edge_t edge;
} wh_crossing_t;

/* What is known before. */
typedef struct {
    double radius;      /* of the wafer, 10 to 300 */
    double sd_radius;   /* 0: it is exact; up to 1: the estimate may change it, at the price of its checks */
    double x, y;        /* where the centre is expected, -300 to 300 */
    double reach;       /* and how far from there it may be, 0.1 to a third of the radius */
    double sd_time;     /* of a latch, 0 to 0.001 */
    double sd_place;    /* of a beam's or the blade's own place, each time anew, 0 to 1 */
    double notch_width; /* along the rim, 0 to 100; 0: no notch, and the other three do not count */
    double notch_depth; /* at most, 0 to 10 */
    bool notch_known;   /* if its direction is */
    double notch_direction, sd_notch; /* -2 pi to 2 pi; 0 to 1 */
    double agree; /* candidates this near to each other count as one, 0 to 1; 0: none do */
} wh_centring_t;

/* What became of a crossing. */
typedef enum WH_FOUR_BYTES {
    WH_CROSSING_USED,
    WH_CROSSING_NOTCH, /* left out: it met the notch, or may have met it */
    WH_CROSSING_OTHER  /* left out: it is none of the rim, but the blade's, say */
} wh_crossing_use_t;

typedef struct {
    double x, y, radius;
    double sd_x, sd_y;
    double sd_centre; /* in the direction in which it is largest */
    double mismatch;  /* sum of squares of what remains, in deviations; `used - 2` of them on average */
    int32_t used;
    wh_crossing_use_t use[WH_CROSSINGS]; /* of each crossing */
} wh_centre_t;

typedef struct {
    int32_t count;             /* of candidates, 0 to 2 */
    wh_centre_t candidates[2]; /* the likelier first */
} wh_centres_t;

/* A wafer whose centre is expected at (0, 0), up to 5 mm off: its radius exact, latches with 3 us, a notch
 * of 3.5 x 1.3 mm, the largest that SEMI M1 allows, in a direction that is not known; agree 0. Nothing is
 * checked. */
wh_centring_t wh_centring_nominal(double radius) WH_SYMBOL(wh_centring_nominal);

/* WH_OK; else `bad`, which may be null, tells the first wrong field as wh_rim_validate does. A null `known`
 * is WH_STATUS_NULL_ARGUMENT. */
wh_status_t wh_centring_validate(const wh_centring_t *known, wh_bad_field_t *bad)
    WH_SYMBOL(wh_centring_validate);

/* The centre, candidates[0]. WH_OK: there is no other, or one within `agree`, by whose distance sd_x, sd_y
 * and sd_centre have grown. WH_STATUS_CENTRE_NOT_SURE: two candidates explain the crossings about equally
 * well, or one does by a radius that is not likely (count 1), or none does (count 0); nothing should be
 * corrected. Errors, `centres` then unchanged:
 * WH_STATUS_NULL_ARGUMENT; what wh_centring_validate says; of the crossings WH_STATUS_NOT_FINITE and
 * WH_STATUS_OUT_OF_RANGE (of a number, of the edge, of the count); and WH_STATUS_TOO_FEW_SAMPLES: fewer than
 * WH_CROSSINGS_LEAST, or all of one beam, which the circle on its other side would explain as well.
 * Crossings may come in any order, of one pass or of several. Cost: 0.5 us for four crossings, 2 us if one
 * met the notch, 0.5 ms for the worst 16. */
wh_status_t wh_centring_solve(const wh_centring_t *known, const wh_crossing_t *crossings, size_t count,
                              wh_centres_t *centres) WH_SYMBOL(wh_centring_solve);

WH_HEADER_END

#endif
