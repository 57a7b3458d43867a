/* Shared by convex.c, gap.c and nearest.c. It is not installed. */
#ifndef WH_COLLISION_GAP_INTERNAL_H
#define WH_COLLISION_GAP_INTERNAL_H

#include "gap.h"

/* A shape is a kernel and all points within `round` mm of it. A capsule's kernel is a line; every other
 * shape is its own kernel. The search finds the nearest points of two kernels in a few steps; curved
 * surfaces would need many. */
static inline wh_real_t wh_convex_round(const wh_convex_t *shape) {
    return shape->kind == WH_CONVEX_CAPSULE ? shape->half.x : 0;
}

/* wh_convex_support of the kernel, in the shape's frame. */
wh_vec3_t wh_convex_kernel_support(const wh_convex_t *shape, const wh_vec3_t *direction)
    WH_SYMBOL(wh_convex_kernel_support);

/* A point within the shape, in its frame: the mean of the points of a mesh, the origin of the others. */
wh_vec3_t wh_convex_centre(const wh_convex_t *shape) WH_SYMBOL(wh_convex_centre);

/* The two shapes. b is measured as if moved by `shift`. */
typedef struct {
    const wh_convex_t *a, *b;
    const wh_pose_t *base_from_a, *base_from_b;
    wh_vec3_t shift;
    wh_gap_start_t *start; /* the points with which the search begins, and which it leaves; null: none */
} wh_gap_pair_t;

/* The bounds of a pair, lower <= signed gap <= upper, each with its proof. */
typedef struct {
    wh_real_t lower, upper;
    wh_vec3_t axis; /* unit: lower = wh_gap_along it */
    wh_vec3_t at;   /* between the two points whose distance is `upper` */
} wh_gap_bounds_t;

/* The most work: steps of wh_nearest_bounds, and libccd's calls of the support function. */
typedef struct {
    int steps, supports;
} wh_gap_budget_t;

/* Narrows `bounds`. It starts with pair->start, otherwise at their axis. It ends when they are
 * WH_GAP_TIGHT, or lower is above `enough`, or no step helps any more. bounds->axis must be a unit vector;
 * bounds->upper may be infinite. */
void wh_nearest_bounds(const wh_gap_pair_t *pair, wh_real_t enough, int steps, wh_gap_bounds_t *bounds)
    WH_SYMBOL(wh_nearest_bounds);

/* wh_gap_measure within a budget, for tests. */
void wh_gap_measure_within(const wh_gap_pair_t *pair, wh_real_t enough, wh_vec3_t guess,
                           const wh_gap_budget_t *budget, wh_gap_t *gap) WH_SYMBOL(wh_gap_measure_within);

#endif
