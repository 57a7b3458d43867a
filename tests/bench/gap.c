/* Measures the gap of a pair, in ns: when a guess proves that it is large enough, when a face
 * proves it, and in full. The result is the least of many rounds, since the machine may have other
 * work. */
#include <stdio.h>
#include <time.h>

#include "collision/gap.h"
#include "support/convex.h"

enum { ROUNDS = 200, CALLS = 200 };

typedef struct {
    const char *name;
    wh_convex_t a, b;
    wh_mat3_t turn;  /* of b */
    wh_vec3_t place; /* the place of b at gap 0, about */
    wh_vec3_t way;   /* to gaps */
} pair_t;

static double now_ns(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

/* b moves a little from call to call, as from slice to slice. */
static double cost_ns(const pair_t *pair, double gap, double enough, bool guessing, wh_gap_t *last) {
    double least = HUGE_VAL;
    const wh_pose_t here = wh_test_at(700, 0, 900);
    for (int round = 0; round < ROUNDS; ++round) {
        wh_pose_t there = here;
        const wh_vec3_t away = wh_vec3_scale(gap, &pair->way);
        there.R = pair->turn;
        there.r = wh_vec3_add(&there.r, &pair->place);
        there.r = wh_vec3_add(&there.r, &away);
        last->axis = guessing ? pair->way : wh_vec3(0, 0, 0);
        const double begin = now_ns();
        for (int call = 0; call < CALLS; ++call) {
            there.r.x += 1e-4;
            const wh_vec3_t guess = guessing ? last->axis : wh_vec3(0, 0, 0);
            wh_gap_measure(&pair->a, &here, &pair->b, &there, enough, guess, last);
        }
        least = fmin(least, (now_ns() - begin) / CALLS);
    }
    return least;
}

int main(void) {
    static wh_vec3_t points[WH_TEST_MESH_POINTS];
    const wh_mat3_t level = wh_mat3_identity();
    const wh_mat3_t tilted = wh_test_rotation(1, 2, 0, 0.026);
    const wh_mat3_t askew = wh_test_rotation(1, 2, 3, 1);
    const wh_convex_t wafer = wh_test_wafer();
    const wh_convex_t blade = wh_test_blade();
    const wh_convex_t link = wh_test_shape(WH_CONVEX_CAPSULE, 60, 0, 150);
    const wh_convex_t wall = wh_test_shape(WH_CONVEX_BOX, 1000, 5, 800);
    const wh_convex_t mesh = wh_test_random_shape(WH_CONVEX_MESH, points);
    const pair_t pairs[] = {
        {"blade and level wafer", blade, wafer, level, {10, 20, 1.8875}, {0, 0, 1}},
        {"blade and tilted wafer", blade, wafer, tilted, {10, 20, 4.38}, {0, 0, 1}},
        {"wafer and tilted wafer", wafer, wafer, tilted, {3, 5, 4.7}, {0, 0, 1}},
        {"link and wall", link, wall, level, {30, 65, 0}, {0, 1, 0}},
        {"two wafers askew", wafer, wafer, askew, {200, 200, 100}, {0.6, 0.6, 0.5}},
        {"blade and mesh of 24 points", blade, mesh, askew, {40, 20, 160}, {0, 0, 1}},
    };
    printf("%-28s %10s %10s %10s | %s\n", "ns a pair", "gap", "full", "with guess",
           "enough by guess, by faces");
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i) {
        static const double gaps[] = {0.1, 1, 100};
        for (size_t g = 0; g < 3; ++g) {
            wh_gap_t last;
            const double enough = cost_ns(&pairs[i], gaps[g], 0.01, true, &last);
            const double faces = cost_ns(&pairs[i], gaps[g], 0.01, false, &last);
            const double guessed = cost_ns(&pairs[i], gaps[g], 1e9, true, &last);
            const double full = cost_ns(&pairs[i], gaps[g], 1e9, false, &last);
            printf("%-28s %10.4f %10.0f %10.0f | %.0f, %.0f\n", pairs[i].name, (double)last.gap, full,
                   guessed, enough, faces);
        }
    }
    return 0;
}
