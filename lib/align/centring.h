/* Centring on the way: the place of a wafer on a blade, from the moments at which its rim crossed beams.
 *
 * Beams of light stand upright at a station's door, beside the way of the blade. The rim breaks each beam
 * when it comes in and frees it when it has left. A crossing is the point of the blade's frame that was in
 * the beam at that moment. The rim is a circle of a known radius R, so two unknowns remain, x and y of its
 * centre. They minimise the squares of
 *
 *     (distance of the crossing from the centre - R) / (its standard deviation)
 *
 * The deviation is that of the latch's time, multiplied by the speed of the beam through the rim. With two
 * beams at the distances d and -d from the way, and sigma along the way for each of four crossings, this
 * gives sd_x = sigma / 2 and sd_y = sigma h / (2 d), h = sqrt(R^2 - d^2). Beams far apart determine y
 * better.
 *
 * Notch. A crossing in the notch is up to 1.25 mm further in and must not count. If the notch's direction
 * is known, crossings in its arc are left out. If it is not known, the crossings themselves decide: three
 * that fit one circle of radius R leave out the fourth. This requires beams at different distances from the
 * way. With equal ones, d and -d, two crossings opposite each other across the centre explain a hit equally
 * well, by circles that are up to 1 mm apart. Such a hit gives WH_STATUS_CENTRE_NOT_SURE, with both
 * candidates. With +60 and -110 at R = 150 all hits of 0.1 mm and more are distinguished if sigma is up to
 * 5 um. Hits below 7 sigma count as noise, and move the centre by less than that.
 *
 * The blade's own edges cross beams, too. A crossing that fits no rim, or whose direction (in or out) is
 * not the rim's, is left out as WH_CROSSING_OTHER. A crossing on a flat is also left out, if three others
 * agree.
 *
 * Latency. A latch comes late by its delay: t_on when a beam breaks, t_off when it becomes free. The maker
 * of the points subtracts the assumed delays. A remaining delay moves a crossing by v t in the direction of
 * the beam over the blade: 10 um for 10 us at 1 m/s. So one pass has an error of v (t_on + t_off) / 2 along
 * the way. Two passes at equal speeds, in and out, given together, cancel that. The front rim then has an
 * error of v (t_on - t_off) / 2 and the rear rim as much in the other direction. This leaves x correct and
 * makes the chord too long or too short, like a wrong radius: it affects y unless beams stand alike on both
 * sides. A radius that is wrong by 0.1 mm moves y by 0.08 mm with beams at +60 and -110; so set sd_radius.
 *
 * If a beam stands at a distance d from its assumed place, the centre moves by up to d / 2 along the way.
 * With beams at +60 and -110 and an inexact radius it moves by 0.6 d across it. Chords whose middles differ
 * by more than about 6 deviations contradict each other; with sd_radius three crossings and another radius
 * may still fit. Such a radius is accepted up to 3 sd_radius, and the deviations include the centre's
 * possible shift. sd_place is for beams whose places are not known exactly.
 *
 * Lengths are in mm, times in s, angles in rad, in the plane of the wafer and in the blade's frame. It uses
 * no heap and no state, and has equal bits on every machine.
 */
#ifndef WH_ALIGN_CENTRING_H
#define WH_ALIGN_CENTRING_H

#include "rim.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(centring);

/* The most crossings of one estimate, and the fewest for a centre. */
#define WH_CROSSINGS 16
#define WH_CROSSINGS_LEAST 3

typedef enum WH_FOUR_BYTES {
    WH_CROSSING_IN, /* the beam breaks: it enters the wafer */
    WH_CROSSING_OUT /* it becomes free again */
} wh_crossing_edge_t;

typedef struct {
    double x, y;   /* of the blade's frame, in the beam at that moment, -1e3 to 1e3 */
    double vx, vy; /* of the beam over the blade, mm/s, together 0.01 to 1e4 */
    int32_t beam;  /* number of the beam, 0 or more */
    wh_crossing_edge_t edge;
} wh_crossing_t;

/* The values that are known before. */
typedef struct {
    double radius;      /* of the wafer, 10 to 300 */
    double sd_radius;   /* 0: it is exact; up to 1: the estimate may change it, and loses some checks */
    double x, y;        /* expected place of the centre, -300 to 300 */
    double reach;       /* its greatest distance from there, 0.1 to a third of the radius */
    double sd_time;     /* of a latch, 0 to 0.001 */
    double sd_place;    /* of a beam's or the blade's own place, independent each time, 0 to 1 */
    double notch_width; /* along the rim, 0 to 100; 0: no notch, and the other three are ignored */
    double notch_depth; /* at most, 0 to 10 */
    bool notch_known;   /* true if its direction is known */
    double notch_direction, sd_notch; /* -2 pi to 2 pi; 0 to 1 */
    double agree; /* candidates this near to each other count as one, 0 to 1; 0: none do */
} wh_centring_t;

/* The use of a crossing. */
typedef enum WH_FOUR_BYTES {
    WH_CROSSING_USED,
    WH_CROSSING_NOTCH, /* left out: it met the notch, or may have met it */
    WH_CROSSING_OTHER  /* left out: it is not of the rim, for example of the blade */
} wh_crossing_use_t;

typedef struct {
    double x, y, radius;
    double sd_x, sd_y;
    double sd_centre; /* in the direction in which it is largest */
    double mismatch;  /* sum of squares of the residuals, in deviations; `used - 2` on average */
    int32_t used;
    wh_crossing_use_t use[WH_CROSSINGS]; /* of each crossing */
} wh_centre_t;

typedef struct {
    int32_t count;             /* of candidates, 0 to 2 */
    wh_centre_t candidates[2]; /* the more likely one first */
} wh_centres_t;

/* A wafer whose centre is expected at (0, 0), up to 5 mm away. Its radius is exact, latches have 3 us, the
 * notch has 3.5 x 1.3 mm, the largest that SEMI M1 allows, in an unknown direction; agree is 0. Nothing is
 * checked. */
wh_centring_t wh_centring_nominal(double radius) WH_SYMBOL(wh_centring_nominal);

/* Returns WH_OK; otherwise `bad`, which may be null, gives the first wrong field, as for wh_rim_validate. A
 * null `known` gives WH_STATUS_NULL_ARGUMENT. */
wh_status_t wh_centring_validate(const wh_centring_t *known, wh_bad_field_t *bad)
    WH_SYMBOL(wh_centring_validate);

/* Computes the centre, candidates[0]. WH_OK: there is no other, or one within `agree`; sd_x, sd_y and
 * sd_centre have grown by its distance. WH_STATUS_CENTRE_NOT_SURE: two candidates explain the crossings
 * about equally well, or one does by an unlikely radius (count 1), or none does (count 0). Do not correct
 * anything then. Errors, which leave `centres` unchanged: WH_STATUS_NULL_ARGUMENT; the status of
 * wh_centring_validate; for the crossings WH_STATUS_NOT_FINITE and WH_STATUS_OUT_OF_RANGE (of a number, of
 * the edge, of the count). WH_STATUS_TOO_FEW_SAMPLES: fewer than WH_CROSSINGS_LEAST, or all of one beam,
 * because a circle on its other side would explain them as well. Crossings may come in any order, from one
 * pass or several. Cost: 0.5 us for four crossings, 2 us if one met the notch, 0.5 ms for the worst 16. */
wh_status_t wh_centring_solve(const wh_centring_t *known, const wh_crossing_t *crossings, size_t count,
                              wh_centres_t *centres) WH_SYMBOL(wh_centring_solve);

WH_HEADER_END

#endif
