/* Pairs of a wafer and a gripper on the limits of the check or near them. */
#ifndef WH_TESTS_SUPPORT_PROXIMITY_H
#define WH_TESTS_SUPPORT_PROXIMITY_H

#include "grasp/proximity.h"
#include "support/pose.h"

/* A number on a limit, a few units beside it, or anywhere. */
static inline wh_real_t wh_test_about(wh_real_t limit) {
    const int where = (int)wh_test_below(4);
    const wh_real_t sign = wh_test_below(2) ? -1 : 1;
    if (where < 2) {
        return sign * wh_test_ulps(limit, (int)wh_test_below(9) - 4);
    }
    return sign * limit * WH_REAL(where == 2 ? wh_test_uniform(0, 1) : wh_test_uniform(0.99, 1.01));
}

/* A gripper, and a wafer beside it at a point of the wafer's own frame that is on the limits or near them. */
static inline void wh_test_pair(const wh_tolerance_t *t, wh_pose_t *wafer, wh_pose_t *gripper) {
    const bool turned = wh_test_below(2) != 0;
    const bool far = wh_test_below(2) != 0;
    const double heading = wh_test_uniform(0, 2 * WH_TEST_PI);
    const wh_real_t radius = wh_test_about(t->projxy);
    const bool on_axis = wh_test_below(2) != 0;
    const double tilt = acos((double)t->planar) * (wh_test_below(2) ? 1 : wh_test_uniform(0, 1.01));
    wafer->R = turned ? wh_test_random_turn(WH_TEST_PI) : wh_mat3_identity();
    const wh_mat3_t tip = wh_test_rotation(cos(heading), sin(heading), 0, tilt);
    gripper->R = wh_mat3_multiply(&wafer->R, &tip);
    gripper->r = wh_vec3(0, 0, 0);
    if (far) {
        gripper->r = wh_test_random_pose(1000).r;
    }
    const wh_vec3_t beside = wh_vec3(on_axis ? radius : radius * WH_REAL(cos(heading)),
                                     on_axis ? 0 : radius * WH_REAL(sin(heading)), wh_test_about(t->projz));
    const wh_vec3_t dr = wh_mat3_transform(&wafer->R, &beside);
    wafer->r = wh_vec3_add(&gripper->r, &dr);
}

/* A preset, or one time in four a random tolerance. */
static inline wh_tolerance_t wh_test_tolerance(int pair) {
    wh_tolerance_t t = pair % 2 ? wh_tolerance_paper() : wh_tolerance_strict();
    if (pair % 4 == 0) {
        t.projz = WH_REAL(wh_test_uniform(1e-3, 5));
        t.projxy = WH_REAL(wh_test_uniform(1e-3, 300));
        t.planar = WH_REAL(wh_test_uniform(0, 0.9999));
    }
    return t;
}

#endif
