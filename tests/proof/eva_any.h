/* Values of any kind, for the programs that Eva analyses. For Eva, a read from a volatile object
 * gives any value of its type, including NaN and infinities. */
#ifndef WH_TESTS_PROOF_EVA_ANY_H
#define WH_TESTS_PROOF_EVA_ANY_H

#include "math/pose.h"

static volatile wh_real_t real;
static volatile int32_t integer;
static volatile size_t size;
static volatile uint64_t word;

static bool any_bool(void) {
    return (integer & 1) != 0;
}

static wh_pose_t any_pose(void) {
    wh_pose_t pose;
    for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) {
            pose.R.m[i][j] = real;
        }
    }
    pose.r = wh_vec3(real, real, real);
    return pose;
}

#endif
