/* A wafer's true rim: its distance from the wafer's centre in each direction.
 *
 * The rim is a circle of the wafer's own radius, minus a notch or flats as in SEMI M1, minus chips. A wafer
 * with bow or saddle looks smaller from above, because it is foreshortened. Directions are in the wafer's
 * frame: rad about e3 from e1, counter-clockwise seen from the front face, between -2 pi and 2 pi. Lengths
 * are in mm. All numbers of this room are double, also in a library of floats, because micrometres matter
 * here. It uses no heap and no state, and has equal bits on every machine.
 */
#ifndef WH_ALIGN_RIM_H
#define WH_ALIGN_RIM_H

#include "../math/status.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(rim);

#define WH_RIM_FLATS 2
#define WH_RIM_CHIPS 8

/* A notch: a V about a radius, rounded at its bottom and at its two corners with the rim. */
typedef struct {
    double direction; /* direction of its axis */
    double depth;     /* from the circle to its bottom, 0.2 to 3; 0: no notch, and the rest is ignored */
    double opening;   /* between the flanks, rad, 1 to 2.1 */
    double bottom;    /* radius of its bottom, 0 to 2 */
    double corner;    /* radius of its corners, 0 to 1 */
} wh_notch_shape_t;

/* A flat: a chord. */
typedef struct {
    double direction; /* direction of its middle */
    double length;    /* 2 to 1.4 times the wafer's radius; 0: no flat */
} wh_flat_shape_t;

/* A chip: a bite with the outline of a parabola. */
typedef struct {
    double direction; /* direction of its middle */
    double width;     /* along the rim, 0.01 to 30 */
    double depth;     /* at its middle, 0 to 5, at most its width */
} wh_chip_t;

typedef struct {
    double radius; /* true, 10 to 300 */
    wh_notch_shape_t notch;
    wh_flat_shape_t flats[WH_RIM_FLATS]; /* primary, secondary */
    wh_chip_t chips[WH_RIM_CHIPS];
    int32_t chip_count; /* 0 to WH_RIM_CHIPS */
    /* The rim's height over the centre, at a direction a: bow + saddle cos(2 (a - saddle_direction)). */
    double bow, saddle; /* -2 to 2 */
    double saddle_direction;
    double transmission; /* share of light through the wafer: 0 silicon, up to 0.9 for glass */
} wh_rim_t;

/* The first wrong field: its name as in the struct, such as "notch.depth", a constant string; the index of
 * the entry if it is in an array, otherwise WH_NONE. */
typedef struct {
    const char *name;
    int32_t index;
} wh_bad_field_t;

/* A wafer of this nominal radius: with a notch from 100 mm on (1.00 mm deep, 90 degrees, bottom 0.9, corners
 * 0.1), with the primary flat below. Its mark is in direction 0. Nothing is checked. */
wh_rim_t wh_rim_nominal(double radius) WH_SYMBOL(wh_rim_nominal);

/* Returns WH_OK; otherwise `bad`, which may be null, gives the first wrong field. WH_STATUS_NOT_FINITE or
 * WH_STATUS_OUT_OF_RANGE; the latter also with "notch.bottom" or "notch.corner", if the roundings leave no
 * straight flank. Null gives WH_STATUS_NULL_ARGUMENT. Entries of chips from chip_count on are ignored. */
wh_status_t wh_rim_validate(const wh_rim_t *rim, wh_bad_field_t *bad) WH_SYMBOL(wh_rim_validate);

/* The rim's distance from the centre in a direction, seen from above. Where features meet, the smallest
 * distance counts. wh_rim_validate must accept the rim; the direction must be finite and below 1e5. Cost:
 * about 20 ns, in a notch or flat 100 ns, with bow or saddle 30 ns more. */
double wh_rim_radius(const wh_rim_t *rim, double direction) WH_SYMBOL(wh_rim_radius);

/* The rim's height over the wafer's centre there: bow and saddle. */
double wh_rim_height(const wh_rim_t *rim, double direction) WH_SYMBOL(wh_rim_height);

/* A wafer's placement: its centre and the turn of its e1, in the frame of a chuck. */
typedef struct {
    double x, y; /* mm, each up to 1e3 */
    double turn; /* rad, -2 pi to 2 pi */
} wh_placement_t;

/* The distance at which a line leaves the wafer. The line is in the chuck's plane, points outwards in
 * direction `look` (rad, chuck's frame) and passes the chuck's axis at the distance `aside` (positive: to
 * the left of that direction). The distance counts from the point nearest to the axis. The line must pass
 * the wafer's centre by less than half its radius; otherwise the result is NaN or has no meaning. It is
 * exact to 1e-9 mm. Cost: wh_rim_radius, a sine and a square root; about 10 times that in a feature or with
 * a bow. */
double wh_rim_distance(const wh_rim_t *rim, const wh_placement_t *placement, double aside, double look)
    WH_SYMBOL(wh_rim_distance);

/* Continues a hash (math/hash.h) with the rim. Nothing is checked. Cost: 15 words, and three more for each
 * chip. */
uint64_t wh_rim_hash(const wh_rim_t *rim, uint64_t hash) WH_SYMBOL(wh_rim_hash);

WH_HEADER_END

#endif
