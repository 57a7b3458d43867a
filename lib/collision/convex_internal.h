/* What gap.c and nearest.c need of shapes beyond convex.h. Not installed. */
#ifndef WH_COLLISION_CONVEX_INTERNAL_H
#define WH_COLLISION_CONVEX_INTERNAL_H

#include "convex.h"

/* A shape is a kernel and all points within `round` mm of it. A capsule's kernel is a line; every other shape
 * is its own kernel. The nearest points of two kernels are found in a few steps; curved surfaces would need
 * many. */
static inline wh_real_t wh_convex_round(const wh_convex_t *shape) {
    return shape->kind == WH_CONVEX_CAPSULE ? shape->half.x : 0;
}

/* wh_convex_support of the kernel, in the shape's frame. */
wh_vec3_t wh_convex_kernel_support(const wh_convex_t *shape, const wh_vec3_t *direction)
    WH_SYMBOL(wh_convex_kernel_support);

/* In the shape's frame, and within the shape: the mean of the points of a mesh, the origin of the others. */
wh_vec3_t wh_convex_centre(const wh_convex_t *shape) WH_SYMBOL(wh_convex_centre);

/* The directions of flat faces are columns of the rotation: from this one (a box 3 from x on, a cylinder 1,
 * which is z; the others none). */
static inline size_t wh_convex_first_face(const wh_convex_t *shape) {
    return shape->kind == WH_CONVEX_BOX ? 0 : 2;
}

static inline size_t wh_convex_faces_end(const wh_convex_t *shape) {
    return shape->kind == WH_CONVEX_BOX || shape->kind == WH_CONVEX_CYLINDER ? 3 : 2;
}

#endif
