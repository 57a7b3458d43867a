/* Poses for tests, built with libm in double and independently of the library's own constructions. */
#ifndef WH_TESTS_SUPPORT_POSE_H
#define WH_TESTS_SUPPORT_POSE_H

#include <float.h>

#include "math/pose.h"
#include "support/support.h"

#define WH_TEST_PI 3.14159265358979323846

/* Half a unit in the last place of 1: the library's rounding error per operation; and its largest number. */
#if defined(WH_FLOAT)
#define WH_TEST_ROUNDING (1.0 / 16777216.0)
#define WH_TEST_LARGEST FLT_MAX
#else
#define WH_TEST_ROUNDING (1.0 / 9007199254740992.0)
#define WH_TEST_LARGEST DBL_MAX
#endif

/* The library's number next to `from` on the way to `to`. */
static inline wh_real_t wh_test_neighbour(wh_real_t from, wh_real_t to) {
#if defined(WH_FLOAT)
    return nextafterf(from, to);
#else
    return nextafter(from, to);
#endif
}

/* The number `steps` places further away from zero; negative steps: towards it. */
static inline wh_real_t wh_test_ulps(wh_real_t from, int steps) {
    for (; steps > 0; --steps) {
        from = wh_test_neighbour(from, from < 0 ? -WH_REAL(1e30) : WH_REAL(1e30));
    }
    for (; steps < 0; ++steps) {
        from = wh_test_neighbour(from, 0);
    }
    return from;
}

/* The rotation by `angle` about the axis (x, y, z), of any length but zero: Rodrigues' formula. */
static inline wh_mat3_t wh_test_rotation(double x, double y, double z, double angle) {
    const double length = sqrt(x * x + y * y + z * z);
    const double a[3] = {x / length, y / length, z / length};
    const double c = cos(angle);
    const double s = sin(angle);
    const double cross[3][3] = {{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}};
    wh_mat3_t R;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            R.m[i][j] = WH_REAL((i == j ? c : 0) + (1 - c) * a[i] * a[j] + s * cross[i][j]);
        }
    }
    return R;
}

/* A rotation by up to `angle` about an axis of any direction. */
static inline wh_mat3_t wh_test_random_turn(double angle) {
    double a[3];
    do {
        for (int i = 0; i < 3; ++i) {
            a[i] = wh_test_uniform(-1, 1);
        }
    } while (a[0] * a[0] + a[1] * a[1] + a[2] * a[2] < 0.01);
    return wh_test_rotation(a[0], a[1], a[2], wh_test_uniform(-angle, angle));
}

static inline wh_pose_t wh_test_pose(wh_mat3_t R, double x, double y, double z) {
    const wh_pose_t pose = {R, {WH_REAL(x), WH_REAL(y), WH_REAL(z)}};
    return pose;
}

/* A level pose at a place. */
static inline wh_pose_t wh_test_at(double x, double y, double z) {
    return wh_test_pose(wh_mat3_identity(), x, y, z);
}

/* A pose within `reach` of base's origin, with any rotation. */
static inline wh_pose_t wh_test_random_pose(double reach) {
    const wh_mat3_t R = wh_test_random_turn(WH_TEST_PI);
    const double x = wh_test_uniform(-reach, reach);
    const double y = wh_test_uniform(-reach, reach);
    return wh_test_pose(R, x, y, wh_test_uniform(-reach, reach));
}

/* The largest difference of two poses' entries, rotation and position apart. */
static inline double wh_test_difference_R(const wh_pose_t *a, const wh_pose_t *b) {
    double most = 0;
    for (int i = 0; i < 9; ++i) {
        most = fmax(most, fabs((double)a->R.m[i / 3][i % 3] - (double)b->R.m[i / 3][i % 3]));
    }
    return most;
}

static inline double wh_test_difference_r(const wh_pose_t *a, const wh_pose_t *b) {
    const double x = fabs((double)a->r.x - (double)b->r.x);
    const double y = fabs((double)a->r.y - (double)b->r.y);
    return fmax(fmax(x, y), fabs((double)a->r.z - (double)b->r.z));
}

#endif
