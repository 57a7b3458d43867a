#include "rotation.h"

#include <string.h>

/* Each Newton step takes an error e to less than e^2: 5e-2, 2.5e-3, 6e-6, 4e-11, rounding. */
#define STEPS 4

static bool is_finite(const wh_mat3_t *R) {
    bool finite = true;
    for (size_t row = 0; row < 3; ++row) {
        const wh_vec3_t entries = wh_mat3_row(R, row);
        finite = finite && wh_vec3_is_finite(&entries);
    }
    return finite;
}

static bool is_mendable(const wh_mat3_t *R) {
    wh_mat3_t square;
    bool mendable = true;
    wh_mat3_multiply_back_to(R, R, &square);
    for (size_t i = 0; i < 9; ++i) {
        const wh_real_t wanted = i % 4 == 0 ? WH_REAL(1) : WH_REAL(0);
        mendable = mendable && wh_real_abs(square.m[i / 3][i % 3] - wanted) <= WH_ROTATION_MENDABLE;
    }
    const wh_vec3_t e1 = wh_mat3_column(R, 0);
    const wh_vec3_t e2 = wh_mat3_column(R, 1);
    const wh_vec3_t e3 = wh_mat3_column(R, 2);
    const wh_vec3_t e1_cross_e2 = wh_vec3_cross(&e1, &e2);
    return mendable && wh_vec3_dot(&e1_cross_e2, &e3) > 0;
}

wh_status_t wh_rotation_mend(wh_mat3_t *R) {
    if (!R) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!is_finite(R)) {
        return WH_STATUS_NOT_FINITE;
    }
    if (!is_mendable(R)) {
        return WH_STATUS_NOT_A_ROTATION;
    }
    for (int step = 0; step < STEPS; ++step) {
        wh_mat3_orthonormalise(R);
    }
    return WH_OK;
}

wh_status_t wh_rotation_from_quaternion(wh_mat3_t *R, wh_real_t w, wh_real_t x, wh_real_t y, wh_real_t z) {
    if (!R) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_vec3_t v = wh_vec3(x, y, z);
    if (!wh_real_is_finite(w) || !wh_vec3_is_finite(&v)) {
        return WH_STATUS_NOT_FINITE;
    }
    const wh_real_t square = w * w + wh_vec3_dot(&v, &v);
    if (!(wh_real_abs(square - 1) <= WH_ROTATION_MENDABLE)) {
        return WH_STATUS_NOT_A_ROTATION;
    }
    const wh_real_t twice = 2 / square;
    const wh_real_t rows[3][3] = {
        {1 - twice * (y * y + z * z), twice * (x * y - w * z), twice * (x * z + w * y)},
        {twice * (x * y + w * z), 1 - twice * (x * x + z * z), twice * (y * z - w * x)},
        {twice * (x * z - w * y), twice * (y * z + w * x), 1 - twice * (x * x + y * y)}};
    memcpy(R->m, rows, sizeof rows);
    return WH_OK;
}
