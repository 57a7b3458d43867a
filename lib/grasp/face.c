#include "face.h"

wh_face_t wh_face_towards(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper) {
    const wh_vec3_t e3 = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_vec3_t n2 = wh_mat3_column(&base_from_gripper->R, 2);
    return wh_vec3_dot(&e3, &n2) < 0 ? WH_FACE_FRONT : WH_FACE_BACK;
}

wh_vec3_t wh_face_centre(const wh_pose_t *base_from_wafer, wh_real_t thickness,
                         const wh_pose_t *base_from_gripper) {
    wh_vec3_t centre = base_from_wafer->r;
    if (wh_face_seen(base_from_wafer, thickness, base_from_gripper) == WH_FACE_FRONT) {
        const wh_vec3_t e3 = wh_mat3_column(&base_from_wafer->R, 2);
        const wh_vec3_t through = wh_vec3_scale(thickness, &e3);
        centre = wh_vec3_add(&centre, &through);
    }
    return centre;
}

void wh_face_frame(const wh_pose_t *base_from_wafer, wh_real_t thickness, wh_face_t face,
                   wh_pose_t *base_from_face) {
    *base_from_face = *base_from_wafer;
    if (face == WH_FACE_BACK) {
        return;
    }
    const wh_vec3_t e3 = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_vec3_t through = wh_vec3_scale(thickness, &e3);
    base_from_face->r = wh_vec3_add(&base_from_wafer->r, &through);
    for (size_t row = 0; row < 3; ++row) {
        base_from_face->R.m[row][1] = -base_from_wafer->R.m[row][1];
        base_from_face->R.m[row][2] = -base_from_wafer->R.m[row][2];
    }
}

static wh_status_t validate_thickness(wh_real_t thickness) {
    if (!wh_real_is_finite(thickness)) {
        return WH_STATUS_NOT_FINITE;
    }
    return thickness >= 0 && thickness <= WH_FACE_THICKEST ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

wh_status_t wh_face_measure(const wh_pose_t *base_from_wafer, wh_real_t thickness,
                            const wh_pose_t *base_from_gripper, const wh_tolerance_t *tolerance,
                            wh_face_t *face, wh_proximity_t *result) {
    if (!base_from_wafer || !base_from_gripper || !face) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = wh_pose_validate(base_from_wafer);
    if (status == WH_OK) {
        status = validate_thickness(thickness);
    }
    if (status != WH_OK) {
        return status;
    }
    wh_pose_t base_from_face;
    const wh_face_t towards = wh_face_towards(base_from_wafer, base_from_gripper);
    wh_face_frame(base_from_wafer, thickness, towards, &base_from_face);
    status = wh_proximity_measure(&base_from_face, base_from_gripper, tolerance, result);
    if (status == WH_OK) {
        *face = towards;
    }
    return status;
}

/* The axis is divided by its length, so that turning twice gives the old vector even if the length is not
 * quite 1. */
static void turn_about(const wh_vec3_t *axis, wh_vec3_t *v) {
    const wh_real_t twice = 2 * wh_vec3_dot(axis, v) / wh_vec3_dot(axis, axis);
    const wh_vec3_t along = wh_vec3_scale(twice, axis);
    *v = wh_vec3_subtract(&along, v);
}

void wh_face_turn_over(const wh_pose_t *base_from_axis, wh_pose_t *base_from_wafer) {
    const wh_vec3_t axis = wh_mat3_column(&base_from_axis->R, 0);
    wh_vec3_t from_axis = wh_vec3_subtract(&base_from_wafer->r, &base_from_axis->r);
    turn_about(&axis, &from_axis);
    base_from_wafer->r = wh_vec3_add(&base_from_axis->r, &from_axis);
    for (size_t column = 0; column < 3; ++column) {
        wh_vec3_t e = wh_mat3_column(&base_from_wafer->R, column);
        turn_about(&axis, &e);
        base_from_wafer->R.m[0][column] = e.x;
        base_from_wafer->R.m[1][column] = e.y;
        base_from_wafer->R.m[2][column] = e.z;
    }
}

wh_real_t wh_face_swept_radius(wh_real_t radius, wh_real_t thickness, wh_real_t height) {
    const wh_real_t farthest = wh_real_abs(height) + thickness / 2;
    return wh_real_sqrt(radius * radius + farthest * farthest);
}
