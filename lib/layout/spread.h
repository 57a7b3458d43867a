/* How an error of a study is spread: its width and shape, and a draw of it. */
#ifndef WH_LAYOUT_SPREAD_H
#define WH_LAYOUT_SPREAD_H

#include "../math/deviate.h"

typedef enum {
    WH_SHAPE_NORMAL, /* the width is the standard deviation */
    WH_SHAPE_UNIFORM /* evenly from -width to +width */
} wh_shape_t;

typedef struct {
    wh_real_t width; /* at least 0 */
    wh_shape_t shape;
} wh_spread_t;

/* A normal deviate stays below this many standard deviations: see math/deviate.h. */
#define WH_SPREAD_DEVIATIONS 8.6

/* The farthest that a draw may be off. */
double wh_spread_reach(const wh_spread_t *spread);

/* A draw; 0 if the width is 0. `field` is the purpose of the number: the first word of its counter. Never
 * renumber fields: the same seeds would give other trials. Cost: about 70 ns. */
wh_real_t wh_spread_draw(const wh_spread_t *spread, const wh_trial_t *trial, uint32_t field, size_t index);

#endif
