/* The gap between two convex shapes: their distance, and whether they touch or hit.
 *
 * The signed gap is the largest separation along any direction: the maximum of wh_gap_along over all unit
 * axes. Above 0 it is their distance. Below 0 it is the depth by which one must move to separate them. So
 * every axis gives a lower bound, proved by two support calls, and every pair of points, one of each shape,
 * gives an upper bound. The two bounds approach each other step by step, until the gap is known:
 *
 *     CLEAR      an axis proves a gap above WH_GAP_TOUCH;
 *     TOUCHING   an axis proves it to be no deeper than WH_GAP_TOUCH, and two points that it is no wider
 *                (to WH_GAP_TIGHT);
 *     HIT        libccd finds that the shapes overlap with WH_GAP_TOUCH / 2 taken off the surface of each,
 *                which proves a depth of WH_GAP_TOUCH. Edges and corners recede more than faces, so this
 *                finds every overlap deeper than 1.74 WH_GAP_TOUCH. For those between, axes are turned until
 *                none proves less depth. If libccd finds an overlap with WH_GAP_CORE taken off each, so that
 *                no axis can, they hit as well;
 *     UNDECIDED  the bounded number of steps reached none of these, or an argument is not a pose. Never a
 *                guess.
 *
 * So a HIT is at least 2 WH_GAP_CORE deep, and at least WH_GAP_TOUCH if the turned axes found the least
 * depth. Thickness is taken off a mesh by shrinking it towards the mean of its points, until the farthest
 * point has moved by it. Faces nearer to the mean recede less. So a HIT of a mesh is proven only for a
 * depth above 0; beyond it the tried axes count.
 *
 * libccd gives yes or no, and an axis, which is checked like every other axis. Gap, axis and place of CLEAR
 * are our own sums, with equal bits on every machine.
 *
 * The steps are those of E. G. Gilbert, D. W. Johnson and S. S. Keerthi, A fast procedure for computing the
 * distance between complex objects in three-dimensional space, IEEE Journal of Robotics and Automation 4
 * (1988) 193-203. libccd's yes or no is portal refinement: G. Snethen, Complex collision made simple, Game
 * Programming Gems 7 (2008) 165-178.
 *
 * Units: mm. Poses are those of the shapes, base_from_shape. Shapes must pass wh_convex_validate; otherwise
 * the results have no meaning. Nothing is allocated, no argument is kept, and all functions are reentrant.
 * They exist in double only.
 */
#ifndef WH_COLLISION_GAP_H
#define WH_COLLISION_GAP_H

#include "convex.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(gap);

#if defined(WH_FLOAT)
#error "waferhand: lib/collision is there in double only"
#endif

/* Shapes whose gap is within this of 0 touch, mm. */
#define WH_GAP_TOUCH 1e-3
/* The gap of CLEAR is this close to the true one, for shapes within 1e4 mm of base's origin and of each
 * other. */
#define WH_GAP_TIGHT 5e-7
/* The greatest distance of a pose from base's origin. */
#define WH_GAP_FARTHEST 1e6
/* The thickness that is taken off each shape for the least proof of a HIT. 2 * sqrt(3) of it is still less
 * than WH_GAP_TOUCH. */
#define WH_GAP_CORE 0.28e-3

typedef enum WH_FOUR_BYTES { WH_GAP_CLEAR, WH_GAP_TOUCHING, WH_GAP_HIT, WH_GAP_UNDECIDED } wh_gap_state_t;

typedef struct {
    wh_gap_state_t state;
    /* CLEAR: a proven lower bound, within WH_GAP_TIGHT of the true gap unless it is above `enough`;
     * otherwise 0. */
    wh_real_t gap;
    /* Unit, base, from a to b. CLEAR: wh_gap_along this axis is `gap` to rounding. Otherwise the best axis
     * found; zero if an argument is not a pose. */
    wh_vec3_t axis;
    /* In base. It is the middle between two nearest points; if faces are parallel, between some nearest
     * points. If the gap is above `enough`, between the points farthest along the axis. HIT: a point of
     * both shapes, or the middle of an overlap of balls. UNDECIDED: the last point found. */
    wh_vec3_t at;
} wh_gap_t;

/* The points from which a search begins. Their distance was the gap of these two shapes shortly before;
 * they are in the shapes' frames. All zero: there are none. Any points of the shapes are valid; bad ones
 * only cost time. */
typedef struct {
    size_t count; /* at most 3 */
    wh_vec3_t on_a[3], on_b[3];
} wh_gap_start_t;

/* The signed separation of a and b along a unit axis (base, from a to b): min over b minus max over a of
 * axis.x. A value above 0 proves that they are apart by it. Cost: 20 ns, for a mesh linear in its
 * points. */
wh_real_t wh_gap_along(const wh_convex_t *a, const wh_pose_t *base_from_a, const wh_convex_t *b,
                       const wh_pose_t *base_from_b, wh_vec3_t axis) WH_SYMBOL(wh_gap_along);

/* `guess`: an axis to try first, of any length (zero: none), such as the last slice's. `enough` (mm, >= 0):
 * the exact size of a larger gap does not matter. If the shapes are swapped, the gap is equal to
 * WH_GAP_TIGHT. Cost: 70 ns if the guess proves enough, 0.3 us if a face does, otherwise 0.3 to 1 us, with
 * two curved edges up to 6 us. Overlaps take about 10 us, those less than 2 WH_GAP_TOUCH deep up to 0.2 ms.
 * The cost for a mesh is linear in its points. */
void wh_gap_measure(const wh_convex_t *a, const wh_pose_t *base_from_a, const wh_convex_t *b,
                    const wh_pose_t *base_from_b, wh_real_t enough, wh_vec3_t guess, wh_gap_t *gap)
    WH_SYMBOL(wh_gap_measure);

/* wh_gap_measure for two shapes that are followed during motion: the search begins with the points in
 * `start`, and leaves its final points there. They belong to the caller, for this pair alone. The gap is
 * equal to WH_GAP_TIGHT. Cost: about half of wh_gap_measure's if the shapes have moved little. */
void wh_gap_follow(const wh_convex_t *a, const wh_pose_t *base_from_a, const wh_convex_t *b,
                   const wh_pose_t *base_from_b, wh_real_t enough, wh_vec3_t guess, wh_gap_start_t *start,
                   wh_gap_t *gap) WH_SYMBOL(wh_gap_follow);

WH_HEADER_END

#endif
