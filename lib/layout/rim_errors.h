/* The errors of wafers' rims in a study: the width of each, and a trial's draw of it.
 *
 * A width describes what a trial adds to the wafer's own rim: to the true diameter, the shape of its notch,
 * the lengths of its flats, its bow and saddle. It may also add a chip, or glass; of these the size of the
 * draw counts. The places of the chip and of the saddle's high side are drawn evenly all round.
 */
#ifndef WH_LAYOUT_RIM_ERRORS_H
#define WH_LAYOUT_RIM_ERRORS_H

#include "../align/rim.h"
#include "../math/deviate.h"
#include "spread.h"

typedef enum {
    WH_RIM_DIAMETER,     /* mm */
    WH_RIM_NOTCH_DEPTH,  /* mm */
    WH_RIM_NOTCH_ANGLE,  /* deg, between the flanks */
    WH_RIM_NOTCH_BOTTOM, /* mm, radius */
    WH_RIM_NOTCH_CORNER, /* mm, radius */
    WH_RIM_FLAT,         /* mm, the primary flat's length */
    WH_RIM_SECOND_FLAT,  /* mm, the secondary flat's */
    WH_RIM_CHIP_DEPTH,   /* mm */
    WH_RIM_CHIP_WIDTH,   /* mm; without a width four times the depth */
    WH_RIM_BOW,          /* mm */
    WH_RIM_SADDLE,       /* mm */
    WH_RIM_GLASS,        /* part of the light */
    WH_RIM_CHIP_AT,      /* deg: drawn with a chip, no width of its own */
    WH_RIM_SADDLE_AT,    /* deg: drawn with a saddle */
    WH_RIM_DRAWS
} wh_rim_draw_t;

/* Those that have widths come first. */
#define WH_RIM_WIDTHS WH_RIM_CHIP_AT

typedef struct {
    wh_spread_t of[WH_RIM_WIDTHS];
} wh_rim_spreads_t;

/* Its field's name, "mm", "deg" or "" for a part, and the largest width, or the largest error that is given:
 * of directions, which have no width, 360. Names are constant texts. */
const char *wh_rim_draw_name(wh_rim_draw_t draw);
const char *wh_rim_draw_unit(wh_rim_draw_t draw);
double wh_rim_draw_most(wh_rim_draw_t draw);

/* True for an error whose size alone counts: it is never below 0. */
bool wh_rim_draw_is_size(wh_rim_draw_t draw);

/* True if a rim has what the draw changes: a notch, a flat, room for a chip. */
bool wh_rim_draw_concerns(wh_rim_draw_t draw, const wh_rim_t *rim);

/* The draws of a trial for a wafer with that rim: 0 where a width is 0 or the rim has no such feature. Each
 * draw depends on seed, trial, field and wafer alone. Cost: about 70 ns for each width that is not 0. */
void wh_rim_draw_all(const wh_rim_spreads_t *spreads, const wh_trial_t *trial, size_t wafer,
                     const wh_rim_t *rim, double drawn[WH_RIM_DRAWS]);

/* True if a rim that is changed by what was drawn is one that wh_rim_validate accepts, and has its notch and
 * its flats still. */
bool wh_rim_draw_leaves_rim(const double drawn[WH_RIM_DRAWS], const wh_rim_t *rim);

/* Changes a rim by what was drawn. False, and the rim is as it was, if nothing was. */
bool wh_rim_draw_apply(const double drawn[WH_RIM_DRAWS], wh_rim_t *rim);

/* The first width whose draw may give a rim that wh_rim_validate refuses, or WH_RIM_DRAWS. A normal draw may
 * be as far off as 8.6 standard deviations. Cost: 50 times wh_rim_validate. */
wh_rim_draw_t wh_rim_draw_too_wide(const wh_rim_spreads_t *spreads, const wh_rim_t *rim);

#endif
