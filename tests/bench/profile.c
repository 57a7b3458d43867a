/* Measures the planning of a move from rest to rest, against ruckig. */
#include <math.h>
#include <stdlib.h>

#include "bench/harness.h"
#include "bench/peers.h"
#include "bench/scene.h"

enum { MOVES = 512, AXES = 4 };

typedef struct {
    const bench_profile_peer_t *peer; /* null: ours */
    void *planner;
    size_t axes, at;
} side_t;

static wh_limits_t limits[AXES];
static double from[MOVES][AXES];
static double to[MOVES][AXES];

static double ours(size_t axes, size_t move) {
    if (axes == 1) {
        wh_profile_t profile;
        const wh_status_t status = wh_profile_plan(&profile, to[move][0] - from[move][0], &limits[0]);
        return status == WH_OK ? wh_profile_duration(&profile) : -1;
    }
    wh_move_t plan;
    const wh_status_t status = wh_move_plan(&plan, axes, from[move], to[move], limits);
    return status == WH_OK ? wh_move_duration(&plan) : -1;
}

static double duration(const side_t *side, size_t move) {
    return side->peer ? side->peer->plan(side->planner, from[move], to[move]) : ours(side->axes, move);
}

static uint64_t run(void *user, size_t repeats) {
    side_t *side = user;
    double sum = 0;
    for (size_t done = 0; done < repeats; ++done) {
        sum += duration(side, side->at++ % MOVES);
    }
    return (uint64_t)sum;
}

/* The default robot's axes anywhere in their travel, the first in mm: a quarter of the moves are short. */
static void draw(void) {
    static const size_t order[AXES] = {WH_AXIS_R, WH_AXIS_THETA, WH_AXIS_Z, WH_AXIS_YAW};
    uint64_t state = 5;
    wh_robot_t robot;
    wh_robot_default(&robot);
    for (size_t i = 0; i < AXES; ++i) {
        const wh_travel_t *travel = &robot.travel[order[i]];
        limits[i] = robot.limits[order[i]];
        for (size_t m = 0; m < MOVES; ++m) {
            const double reach = (m % 4 == 0 ? 0.01 : 1) * (travel->max - travel->min);
            from[m][i] = bench_uniform(&state, travel->min, travel->max);
            to[m][i] = travel->min + bench_uniform(&state, 0, reach);
            to[m][i] = m % 4 == 0 ? fmin(from[m][i] + (to[m][i] - travel->min), travel->max) : to[m][i];
        }
    }
}

static void compare(const side_t *a, const side_t *b) {
    for (size_t m = 0; m < MOVES; ++m) {
        if (!(fabs(duration(a, m) - duration(b, m)) <= 1e-9)) {
            bench_differ(b->peer->name, "how long a move takes, to 1e-9 s");
        }
    }
}

static void race(const char *row, size_t axes, const bench_profile_peer_t *peer) {
    bench_result_t results[2];
    if (!bench_wanted(row)) {
        return;
    }
    side_t sides[2] = {{NULL, NULL, axes, 0}, {peer, peer ? peer->build(axes, limits) : NULL, axes, 0}};
    const bench_contender_t contenders[2] = {{"ours", run, &sides[0], 1},
                                             {peer ? peer->name : "", run, &sides[1], 1}};
    if (!peer) {
        bench_race(contenders, 1, results);
        bench_figure(row, "ns a plan", &results[0].ns, true, 0);
        return;
    }
    compare(&sides[0], &sides[1]);
    bench_race(contenders, 2, results);
    bench_row(row, contenders, results, 1, 4);
    peer->drop(sides[1].planner);
}

int main(int argc, char **argv) {
    bench_begin("profile", "ns/plan", argc, argv);
    bench_note("same durations as ruckig's to 1e-9 s, compared first; its library as built for its wheel, "
               "its headers");
    bench_note("at -O3 -march=native. ruckig does more: it begins and ends in any motion, of which rest is "
               "one case");
    const bench_profile_peer_t *peer = bench_peer("ruckig", "the wheel of tests/bench/requirements.txt");
    draw();
    race("1 axis, rest to rest", 1, peer);
    race("4 axes, synchronised", AXES, peer);
    return bench_end();
}
