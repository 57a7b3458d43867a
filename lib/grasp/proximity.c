#include "grasp_internal.h"

/* It copies member by member, because a compiler that saves bytes would copy a constant. */
static wh_tolerance_t tolerance_of(wh_real_t projz, wh_real_t projxy, wh_real_t planar) {
    wh_tolerance_t tolerance;
    tolerance.projz = projz;
    tolerance.projxy = projxy;
    tolerance.planar = planar;
    return tolerance;
}

wh_tolerance_t wh_tolerance_paper(void) {
    return tolerance_of(WH_REAL(0.5), 50, WH_REAL(0.99));
}

wh_tolerance_t wh_tolerance_strict(void) {
    return tolerance_of(WH_REAL(0.5), 5, WH_REAL(0.99998));
}

const char *wh_tolerance_preset(size_t index, wh_tolerance_t *tolerance) {
    switch (index) {
    case 0:
        *tolerance = wh_tolerance_paper();
        return "paper";
    case 1:
        *tolerance = wh_tolerance_strict();
        return "strict";
    default:
        return NULL;
    }
}

wh_status_t wh_tolerance_validate(const wh_tolerance_t *tolerance) {
    const bool good = tolerance->projz > 0 && tolerance->projz <= WH_REAL(1e6) &&
                      tolerance->projxy >= WH_REAL(1e-6) && tolerance->projxy <= WH_REAL(1e6) &&
                      tolerance->planar >= 0 && tolerance->planar < 1;
    return good ? WH_OK : WH_STATUS_BAD_TOLERANCE;
}

bool wh_proximity_is_ready(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                           const wh_tolerance_t *tolerance) {
    return wh_proximity_ready(base_from_wafer, base_from_gripper, tolerance);
}

void wh_proximity_judge(const wh_tolerance_t *tolerance, wh_proximity_t *p) {
    p->margin_projz = tolerance->projz - wh_real_abs(p->dr_proj_z);
    p->margin_projxy = tolerance->projxy - p->dr_proj_xy_norm;
    p->margin_planar = p->n1_proj_n2 - tolerance->planar;
    p->failed = 0;
    p->failed |= p->margin_projz > 0 ? 0U : (unsigned)WH_FAILED_PROJZ;
    p->failed |= p->margin_projxy > 0 ? 0U : (unsigned)WH_FAILED_PROJXY;
    p->failed |= p->margin_planar > 0 ? 0U : (unsigned)WH_FAILED_PLANAR;
    p->ready = p->failed == 0;
}

void wh_proximity_values(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                         const wh_tolerance_t *tolerance, wh_proximity_t *p) {
    const wh_vec3_t n1 = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_vec3_t n2 = wh_mat3_column(&base_from_gripper->R, 2);
    p->dr = wh_vec3_subtract(&base_from_wafer->r, &base_from_gripper->r);
    p->n1_proj_n2 = wh_vec3_dot(&n1, &n2);
    p->dr_proj_z = wh_vec3_dot(&p->dr, &n1);
    p->dr_proj_xy = wh_mat3_transform_back(&base_from_wafer->R, &p->dr);
    p->dr_proj_xy_norm = wh_real_sqrt(p->dr_proj_xy.x * p->dr_proj_xy.x + p->dr_proj_xy.y * p->dr_proj_xy.y);
    wh_proximity_judge(tolerance, p);
}

/* Each value is then finite, too; the half covers rotations that just pass. */
static bool is_square_finite(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper) {
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, &base_from_gripper->r);
    return wh_vec3_dot(&dr, &dr) <= WH_REAL_LARGEST / 2;
}

wh_status_t wh_proximity_measure(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                                 const wh_tolerance_t *tolerance, wh_proximity_t *result) {
    if (!base_from_wafer || !base_from_gripper || !tolerance || !result) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = wh_pose_validate(base_from_wafer);
    if (status == WH_OK) {
        status = wh_pose_validate(base_from_gripper);
    }
    if (status == WH_OK) {
        status = wh_tolerance_validate(tolerance);
    }
    if (status == WH_OK && !is_square_finite(base_from_wafer, base_from_gripper)) {
        status = WH_STATUS_NOT_FINITE;
    }
    if (status == WH_OK) {
        wh_proximity_values(base_from_wafer, base_from_gripper, tolerance, result);
    }
    return status;
}

wh_real_t wh_proximity_rim_gap(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                               wh_real_t radius) {
    const wh_vec3_t n1 = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_vec3_t n2 = wh_mat3_column(&base_from_gripper->R, 2);
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, &base_from_gripper->r);
    /* |n1 x n2| is the sine of the tilt and stays exact for small tilts, where sqrt(1 - cos^2) does not. */
    const wh_vec3_t sine = wh_vec3_cross(&n1, &n2);
    return wh_real_abs(wh_vec3_dot(&dr, &n2)) + radius * wh_vec3_norm(&sine);
}
