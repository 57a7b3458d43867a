/* A hash of many gaps, with state, axis and place, of random pairs, near, touching and overlapping:
 * two builds must print the same. Poses are drawn with libm, so two machines may differ. */
#include "collision/gap.h"
#include "math/hash.h"
#include "support/convex.h"

enum { PAIRS = 40000 };

int main(void) {
    static wh_vec3_t points[2][WH_TEST_MESH_POINTS];
    static const wh_vec3_t none = {0, 0, 0};
    uint64_t hash = WH_HASH_START;
    int states[4] = {0, 0, 0, 0};
    (void)wh_test_seed();
    for (int i = 0; i < PAIRS; ++i) {
        const wh_convex_t a = wh_test_random_shape((wh_convex_kind_t)(i % 4), points[0]);
        const wh_convex_t b = wh_test_random_shape((wh_convex_kind_t)(i / 4 % 4), points[1]);
        const wh_pose_t here = wh_test_random_pose(60);
        wh_pose_t there = wh_test_random_pose(60);
        wh_gap_t gap;
        wh_gap_measure(&a, &here, &b, &there, 1e9, none, &gap);
        if (gap.state == WH_GAP_CLEAR && i % 3 != 0) {
            /* Moved until they touch, or a little into each other. */
            const wh_vec3_t way = wh_vec3_scale(gap.gap + (i % 3 - 1) * 0.0015, &gap.axis);
            there.r = wh_vec3_subtract(&there.r, &way);
            wh_gap_measure(&a, &here, &b, &there, 1e9, none, &gap);
        }
        ++states[gap.state];
        hash = wh_hash_int(hash, (int32_t)gap.state);
        hash = wh_hash_real(hash, gap.gap);
        hash = wh_hash_vec3(wh_hash_vec3(hash, &gap.axis), &gap.at);
    }
    printf("%016llx: %d clear, %d touching, %d hit, %d undecided\n", (unsigned long long)hash, states[0],
           states[1], states[2], states[3]);
    return 0;
}
