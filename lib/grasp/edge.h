/* The edge grip: two fixed rests at the tip of a blade, and a plunger at its rear that pushes the wafer
 * onto them.
 *
 * The view is from above, in the gripper's frame, with x towards the tip. Each rest is a pin of radius rho
 * (`rest`) at +-alpha from x. It touches a nominal wafer of radius R0 whose centre is the gripper's origin:
 * the pins' centres are at (R0 + rho) (cos alpha, +-sin alpha). The plunger is also a pin, of radius
 * `plunger`. It moves along x; its coordinate s is 0 where it touches the nominal wafer, so its centre is
 * at x = s - R0 - plunger, y = 0. A wafer of true radius R = R0 + d begins with its centre at (x0, y0), and
 * keeps its rotation. The first rest is the one at +y if y0 > 0, otherwise the one at -y. xf is the x at
 * which the wafer touches it while y is y0.
 *
 * The path, as s grows from `retracted`:
 *   free       the plunger has not met the rim. The wafer stays at (x0, y0); if it lies on the first rest,
 *              x0 > xf, it slides off evenly, to be at (xf, y0) when the plunger meets it;
 *   pushed     plunger and rim touch: the wafer moves along the blade, its y stays y0, up to xf;
 *   rolling    the centre is where the circles about the first rest, R + rho, and about the plunger,
 *              R + plunger, meet, on the side of the other rest;
 *   sinking    both rests are met, but one is over the notch: the centre is where the circles about the other
 *              rest and about the plunger meet, on the side of the one over the notch;
 *   seated     both rests touch the wafer: it is done, and the plunger stands.
 * Each phase begins where the one before it ends, without a jump. Without a notch at a rest the seated
 * centre is displaced by
 *
 *     x = (R0 + rho) cos alpha - sqrt((R + rho)^2 - (R0 + rho)^2 sin^2 alpha),   y = 0
 *
 * A rest over the notch sinks in by its distance from the notch's outline, seen from the moved centre. The
 * seated centre has the distance R + rho from the other rest, and this rest touches the outline (a flank,
 * both flanks, or a corner). Both equations are solved together, to rounding. Before sinking the rim counts
 * as a circle. A notch at the plunger changes only s: the plunger is ahead by one constant amount on the
 * whole path, the amount at the path's end.
 *
 * A wafer that is off centre by sqrt(x0^2 + y0^2) <= clearance is taken in this way. Beyond it the plunger
 * stops where it meets the rim, s <= gripped_to: the wafer is jammed at its place, and `excess` is its
 * distance beyond the clearance. A wafer that lies over the open plunger is met at `retracted`. If the
 * plunger would meet the rim later than at gripped_to, it continues to `end`: missed.
 *
 * The windows of s, which a controller's sensors show, tested in this order:
 *   retracted  s <= retracted          gripped    s >= gripped_from
 *   overtravel s > gripped_to          short      all else
 * The wafer is held if it is seated and s is in the window gripped. Without a wafer the plunger comes to
 * overtravel. With a jam, and with a wafer that is much too large, it stops short. A jam beside the blade
 * can stop it in the window gripped; then the phase shows it. Each result is known at most (end -
 * retracted) / speed seconds after the begin.
 *
 * All numbers that come and go are double, also in a library of floats. It computes with its own numbers:
 * with floats a path is right to 5e-4 mm, and a processor without double takes no software for it. It uses
 * no heap and no state, and has equal bits on every machine. A firmware that calls none of these functions
 * does not link them.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_edge_at                      992   1048     568    560
 *     size of wh_edge_t                         80             80
 *     size of wh_edge_wafer_t                   64             64
 *     size of wh_edge_place_t                   48             48
 */
#ifndef WH_GRASP_EDGE_H
#define WH_GRASP_EDGE_H

#include "../math/status.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(edge);

/* The gripper. Lengths in mm. */
typedef struct {
    double radius;                   /* R0, radius of the nominal wafer, 10 to 300 */
    double rest, plunger;            /* radii of the pins, 0.1 to 20 */
    double alpha;                    /* rad, 25 to 60 degrees */
    double clearance;                /* clearance of the pocket, 0 to 10, at most a tenth of R0 */
    double retracted;                /* s of the open plunger, at most -(clearance + 1), -50 or more */
    double gripped_from, gripped_to; /* the window, from above `retracted`, -5 to 5 */
    double end;                      /* end of the stroke, above gripped_to, up to 10 */
    double speed;                    /* speed of the plunger, mm/s, 0.01 to 1e4 */
} wh_edge_t;

/* A wafer at its place on the blade. Directions are in the gripper's frame. */
typedef struct {
    double radius;  /* true, within 1 mm of the gripper's */
    double x, y;    /* its centre, each up to 50 from 0, and up to half of R0 */
    double depth;   /* of its notch, to its bottom, 0.2 to a fiftieth of R0; 0: it has none */
    double opening; /* between the notch's flanks, rad, 85 to 120 degrees */
    double bottom; /* radius of the notch's bottom, 0 to that of a pin; 0.01 mm of each flank stay straight */
    double notch_x, notch_y; /* of the notch's axis; of length 1 to within 1e-6 */
} wh_edge_wafer_t;

typedef enum WH_FOUR_BYTES {
    WH_EDGE_FREE,
    WH_EDGE_PUSHED,
    WH_EDGE_ROLLING,
    WH_EDGE_SINKING,
    WH_EDGE_SEATED,
    WH_EDGE_JAMMED,
    WH_EDGE_MISSED
} wh_edge_phase_t;

typedef enum WH_FOUR_BYTES {
    WH_EDGE_RETRACTED,
    WH_EDGE_SHORT,
    WH_EDGE_GRIPPED,
    WH_EDGE_OVERTRAVEL
} wh_edge_window_t;

/* The place of the plunger and the wafer. */
typedef struct {
    wh_edge_phase_t phase;
    wh_edge_window_t window; /* the window that s is in */
    bool held;               /* seated, and gripped */
    double s;                /* the plunger's place; it goes no farther than possible */
    double x, y;             /* the wafer's centre, gripper's frame */
    double excess;           /* JAMMED: mm beyond the clearance, otherwise 0 */
} wh_edge_place_t;

/* The nominal wafer's gripper: rests and plunger of 1.5 mm, alpha 30 degrees, clearance 2.5, retracted at -8,
 * gripped from -0.25 to 1.3, end at 4, 40 mm/s. Nothing is checked. */
wh_edge_t wh_edge_default(double radius) WH_SYMBOL(wh_edge_default);

/* A wafer of this radius at its nominal place. From 100 mm on it has SEMI M1's notch: 1 mm deep, 90
 * degrees, bottom 0.9, its axis (0, 1). Nothing is checked. */
wh_edge_wafer_t wh_edge_wafer_nominal(double radius) WH_SYMBOL(wh_edge_wafer_nominal);

/* Returns WH_OK; WH_STATUS_NULL_ARGUMENT; WH_STATUS_NOT_FINITE if a number is NaN or infinite;
 * WH_STATUS_OUT_OF_RANGE if one is out of the ranges above. A wafer is validated together with the gripper
 * that takes it. */
wh_status_t wh_edge_validate(const wh_edge_t *edge) WH_SYMBOL(wh_edge_validate);
wh_status_t wh_edge_wafer_validate(const wh_edge_t *edge, const wh_edge_wafer_t *wafer)
    WH_SYMBOL(wh_edge_wafer_validate);

/* The wafer's place when the plunger has reached s, or its stop if that is before s. If `wafer` is null,
 * there is none, and the place is (0, 0). It refuses, and leaves `place` unchanged: what the two functions
 * above refuse, a null `place` (WH_STATUS_NULL_ARGUMENT), an s that is NaN or infinite
 * (WH_STATUS_NOT_FINITE). Cost: about 10 square roots, 120 more with the notch over a pin. */
wh_status_t wh_edge_at(const wh_edge_t *edge, const wh_edge_wafer_t *wafer, double s, wh_edge_place_t *place)
    WH_SYMBOL(wh_edge_at);

/* True if a pin whose centre is there, gripper's frame, is over the wafer's notch: its direction from the
 * wafer's centre is between the notch's two corners. It serves layouts that keep a notch away from rests,
 * pins and beams. Nothing is checked. */
bool wh_edge_meets_notch(const wh_edge_wafer_t *wafer, double pin_x, double pin_y)
    WH_SYMBOL(wh_edge_meets_notch);

WH_HEADER_END

#endif
