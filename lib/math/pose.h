/* Poses: the place of a body and its rotation.
 *
 * Names read as products: base_from_gripper * gripper_from_wafer = base_from_wafer. The rotation R has the
 * body's axes as columns, the position r is the body's origin (mm), both seen from the left-hand frame.
 */
#ifndef WH_MATH_POSE_H
#define WH_MATH_POSE_H

#include "status.h"
#include "vector.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(pose);

typedef struct {
    wh_mat3_t R;
    wh_vec3_t r;
} wh_pose_t;

static inline wh_pose_t wh_pose_identity(void) {
    wh_pose_t pose = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
    return pose;
}

/* a_from_b * b_from_c = a_from_c, written to memory that neither of them is in. Cost: 36 products. */
void wh_pose_compose_to(const wh_pose_t *a_from_b, const wh_pose_t *b_from_c, wh_pose_t *a_from_c)
    WH_SYMBOL(wh_pose_compose_to);

/* inverse(a_from_b) * a_from_c = b_from_c, written to memory that neither of them is in. The difference of
 * the positions is taken first: a round trip through wh_pose_compose_to keeps positions to rounding even far
 * from a's origin. Cost: 36 products. */
void wh_pose_relative_to(const wh_pose_t *a_from_b, const wh_pose_t *a_from_c, wh_pose_t *b_from_c)
    WH_SYMBOL(wh_pose_relative_to);

/* Returns the result by value, for 96 bytes (48 in float) more of stack. */
static inline wh_pose_t wh_pose_compose(const wh_pose_t *a_from_b, const wh_pose_t *b_from_c) {
    wh_pose_t a_from_c;
    wh_pose_compose_to(a_from_b, b_from_c, &a_from_c);
    return a_from_c;
}

static inline wh_pose_t wh_pose_relative(const wh_pose_t *a_from_b, const wh_pose_t *a_from_c) {
    wh_pose_t b_from_c;
    wh_pose_relative_to(a_from_b, a_from_c, &b_from_c);
    return b_from_c;
}

/* A point of b as seen from a. */
static inline wh_vec3_t wh_pose_point(const wh_pose_t *a_from_b, const wh_vec3_t *point) {
    const wh_vec3_t turned = wh_mat3_transform(&a_from_b->R, point);
    return wh_vec3_add(&turned, &a_from_b->r);
}

/* WH_STATUS_OK when all twelve numbers are finite, no entry of |R^T R - I| is above WH_ROTATION_TOLERANCE and
 * det R > 0; else WH_STATUS_NOT_FINITE or WH_STATUS_NOT_A_ROTATION. Cost: about 30 products. */
wh_status_t wh_pose_validate(const wh_pose_t *pose) WH_SYMBOL(wh_pose_validate);

/* True if no entry of |R^T R - I| is above WH_ROTATION_TOLERANCE: a rotation, or one of its mirror images.
 * False if a number is not finite. Cost: 18 products. */
bool wh_mat3_is_orthonormal(const wh_mat3_t *R) WH_SYMBOL(wh_mat3_is_orthonormal);

/* Brings an almost-rotation to the nearest rotation, in place, by one Newton step R (3 I - R^T R) / 2: an
 * error of e in R^T R becomes about e^2. R must pass wh_pose_validate. */
void wh_mat3_orthonormalise(wh_mat3_t *R) WH_SYMBOL(wh_mat3_orthonormalise);

WH_HEADER_END

#endif
