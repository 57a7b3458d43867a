#include "pose.h"

static bool pose_is_finite(const wh_pose_t *pose) {
    /* A sum of differences that are each zero, or NaN if one number is not finite. */
    wh_real_t zero = (pose->r.x - pose->r.x) + (pose->r.y - pose->r.y) + (pose->r.z - pose->r.z);
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 3; ++column) {
            zero += pose->R.m[row][column] - pose->R.m[row][column];
        }
    }
    return zero == 0;
}

static bool near(wh_real_t value, wh_real_t wanted) {
    return wh_real_abs(value - wanted) <= WH_ROTATION_TOLERANCE;
}

bool wh_mat3_is_orthonormal(const wh_mat3_t *R) {
    const wh_vec3_t e1 = wh_mat3_column(R, 0);
    const wh_vec3_t e2 = wh_mat3_column(R, 1);
    const wh_vec3_t e3 = wh_mat3_column(R, 2);
    return near(wh_vec3_dot(&e1, &e1), 1) && near(wh_vec3_dot(&e2, &e2), 1) &&
           near(wh_vec3_dot(&e3, &e3), 1) && near(wh_vec3_dot(&e1, &e2), 0) &&
           near(wh_vec3_dot(&e1, &e3), 0) && near(wh_vec3_dot(&e2, &e3), 0);
}

/* Returns false for numbers that are not finite. */
static bool is_rotation(const wh_mat3_t *R) {
    const wh_vec3_t e1 = wh_mat3_column(R, 0);
    const wh_vec3_t e2 = wh_mat3_column(R, 1);
    const wh_vec3_t e3 = wh_mat3_column(R, 2);
    const wh_vec3_t e1_cross_e2 = wh_vec3_cross(&e1, &e2);
    return wh_mat3_is_orthonormal(R) && wh_vec3_dot(&e1_cross_e2, &e3) > 0;
}

/* The numbers of a rotation are finite, so they need no separate tests. */
wh_status_t wh_pose_validate(const wh_pose_t *pose) {
    if (is_rotation(&pose->R)) {
        return wh_vec3_is_finite(&pose->r) ? WH_OK : WH_STATUS_NOT_FINITE;
    }
    return pose_is_finite(pose) ? WH_STATUS_NOT_A_ROTATION : WH_STATUS_NOT_FINITE;
}

void wh_pose_compose_to(const wh_pose_t *a_from_b, const wh_pose_t *b_from_c, wh_pose_t *a_from_c) {
    const wh_vec3_t turned = wh_mat3_transform(&a_from_b->R, &b_from_c->r);
    a_from_c->r = wh_vec3_add(&turned, &a_from_b->r);
    wh_mat3_multiply_to(&a_from_b->R, &b_from_c->R, &a_from_c->R);
}

void wh_pose_relative_to(const wh_pose_t *a_from_b, const wh_pose_t *a_from_c, wh_pose_t *b_from_c) {
    const wh_vec3_t between = wh_vec3_subtract(&a_from_c->r, &a_from_b->r);
    b_from_c->r = wh_mat3_transform_back(&a_from_b->R, &between);
    wh_mat3_multiply_back_to(&a_from_b->R, &a_from_c->R, &b_from_c->R);
}

void wh_mat3_orthonormalise(wh_mat3_t *R) {
    wh_mat3_t correction;
    wh_mat3_multiply_back_to(R, R, &correction);
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 3; ++column) {
            const wh_real_t identity = row == column ? WH_REAL(3) : WH_REAL(0);
            correction.m[row][column] = (identity - correction.m[row][column]) / 2;
        }
    }
    for (size_t row = 0; row < 3; ++row) {
        const wh_vec3_t almost = wh_mat3_row(R, row);
        const wh_vec3_t turned = wh_mat3_transform_back(&correction, &almost);
        R->m[row][0] = turned.x;
        R->m[row][1] = turned.y;
        R->m[row][2] = turned.z;
    }
}
