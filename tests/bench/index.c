/* Measures a slice of one open, empty gripper among many resting wafers, against nanoflann's and
 * FCL's trees. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench/harness.h"
#include "bench/ours.h"
#include "bench/peers.h"

enum { POSES = 16384, COMPARED = 200, PEERS = 3, SIZES = 4, TURNS = 2 };

/* One side of a race: along a path and back again, over and over. */
typedef struct {
    const bench_index_peer_t *peer; /* null: ours */
    void *built;
    const wh_pose_t *poses;
    size_t at;
    bool back;
} side_t;

static const bench_index_peer_t *peers[PEERS];
static size_t column;
static wh_pose_t poses[POSES];

/* ------------------------------------------------------------------------------------------------- racing */
static const wh_pose_t *next(side_t *side) {
    const wh_pose_t *pose = &side->poses[side->at];
    if (side->at + 1 == POSES && !side->back) {
        side->back = true;
    } else if (side->at == 0 && side->back) {
        side->back = false;
    } else {
        side->at += side->back ? SIZE_MAX : 1;
    }
    return pose;
}

static uint64_t run_ours(void *user, size_t repeats) {
    side_t *side = user;
    uint64_t events = 0;
    for (size_t done = 0; done < repeats; ++done) {
        events += bench_table_step(side->built, next(side));
    }
    return events;
}

static uint64_t run_peer(void *user, size_t repeats) {
    side_t *side = user;
    uint64_t seen = 0;
    for (size_t done = 0; done < repeats; ++done) {
        seen += side->peer->look(side->built, next(side), 1);
    }
    return seen;
}

/* --------------------------------------------------------------------------------------- the same answers */
/* Compares peers with all wafers one by one. */
static void compare_peer(const bench_index_peer_t *peer, void *built, const wh_pose_t *wafers, size_t count) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    for (size_t i = 0; i < COMPARED; ++i) {
        const wh_pose_t *gripper = &poses[i * (POSES / COMPARED)];
        uint64_t seen = 0;
        for (size_t w = 0; w < count; ++w) {
            seen += bench_look(&wafers[w], gripper, &config);
        }
        if (peer->look(built, gripper, 1) != seen) {
            bench_differ(peer->name, "which wafers are near and which are ready");
        }
    }
}

/* Compares our index with the plain loop: the whole state, after slices in a row. */
static void compare_ours(const wh_pose_t *wafers, size_t count) {
    bench_table_t *with = bench_table(wafers, count, true);
    bench_table_t *without = bench_table(wafers, count, false);
    for (size_t i = 0; i < COMPARED; ++i) {
        const uint64_t events = bench_table_step(with, &poses[i]);
        if (bench_table_step(without, &poses[i]) != events) {
            bench_differ("the plain loop", "how many events there are");
        }
    }
    if (wh_grasp_hash(&with->table) != wh_grasp_hash(&without->table) || with->table.counters.picked > 0) {
        bench_differ("the plain loop", "the grasp table's state");
    }
    bench_table_free(with);
    bench_table_free(without);
}

/* -------------------------------------------------------------------------------------------------- rows */
static double goal_of(const char *peer, bool far) {
    const bool tree = peer[0] == 'F';
    return far ? (tree ? 0 : 1 / 1.3) : (tree ? 30 : 3);
}

static void race(const char *row, size_t count, bool far) {
    bench_contender_t contenders[1 + PEERS];
    bench_result_t results[1 + PEERS];
    side_t sides[1 + PEERS];
    if (!bench_wanted(row)) {
        return;
    }
    const wh_grasp_config_t config = wh_grasp_config_default();
    wh_pose_t *wafers = bench_wafers(count, column);
    if (far) {
        bench_teleport(poses, POSES, bench_side(count, column), column);
    } else {
        bench_path(poses, POSES, bench_side(count, column), column, TURNS);
    }
    compare_ours(wafers, count);
    bench_table_t *ours = bench_table(wafers, count, true);
    sides[0] = (side_t){.built = ours, .poses = poses};
    contenders[0] = (bench_contender_t){"ours", run_ours, &sides[0], 1};
    size_t entered = 1;
    for (size_t p = 0; p < PEERS; ++p) {
        if (peers[p]) {
            sides[entered] = (side_t){peers[p], peers[p]->build(wafers, count, &config), poses, 0, false};
            compare_peer(peers[p], sides[entered].built, wafers, count);
            contenders[entered] = (bench_contender_t){peers[p]->name, run_peer, &sides[entered], 1};
            ++entered;
        }
    }
    bench_race(contenders, entered, results);
    for (size_t c = 1; c < entered; ++c) {
        bench_row(row, contenders, results, c, goal_of(contenders[c].name, far));
        sides[c].peer->drop(sides[c].built);
    }
    bench_table_free(ours);
    free(wafers);
}

/* The number of slices per 100 of the path in which a wafer is in the neighbourhood. */
static double percent_near(bench_table_t *made, const wh_pose_t *path) {
    size_t near = 0;
    for (size_t i = 0; i < POSES; ++i) {
        (void)bench_table_step(made, &path[i]);
        near += made->gripper.approach.wafer != WH_NONE;
    }
    return 100.0 * (double)near / POSES;
}

/* All sizes in one race: how the cost of a slice grows with the wafers that rest elsewhere. */
static void race_growth(const char *row) {
    static const size_t counts[SIZES] = {1000, 10000, 100000, 1000000};
    static const char *const names[SIZES] = {"1e3", "1e4", "1e5", "1e6"};
    static wh_pose_t paths[SIZES][POSES];
    bench_contender_t contenders[SIZES + 1];
    bench_result_t results[SIZES + 1];
    side_t sides[SIZES + 1];
    if (!bench_wanted(row)) {
        return;
    }
    for (size_t i = 0; i <= SIZES; ++i) {
        const size_t size = i % SIZES;
        wh_pose_t *wafers = bench_wafers(counts[size], column);
        bench_path(paths[size], POSES, bench_side(counts[size], column), column, TURNS);
        bench_table_t *made = bench_table(wafers, counts[size], true);
        made->valve = i < SIZES ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
        sides[i] = (side_t){.built = made, .poses = paths[size]};
        contenders[i] = (bench_contender_t){i < SIZES ? names[i] : "closed", run_ours, &sides[i], 1};
        free(wafers);
    }
    bench_race(contenders, SIZES + 1, results);
    const bench_spread_t *ratio = &results[SIZES - 1].faster;
    const bench_spread_t exponent = {log(ratio->low) / log(1000), log(ratio->median) / log(1000),
                                     log(ratio->high) / log(1000)};
    bench_figure(row, "exponent, 1e3 to 1e6", &exponent, true, 0.05);
    bench_note("ours, ns a slice: 1e3 %.1f, 1e4 %.1f, 1e5 %.1f, 1e6 %.1f", results[0].ns.median,
               results[1].ns.median, results[2].ns.median, results[3].ns.median);
    bench_note("with the valve closed, when a step looks for nothing, it takes %.1f of these",
               results[SIZES].ns.median);
    bench_note("a wafer is near in %.0f %% of the slices with 1e3, %.0f %% with 1e6",
               percent_near(sides[0].built, paths[0]),
               percent_near(sides[SIZES - 1].built, paths[SIZES - 1]));
    for (size_t i = 0; i <= SIZES; ++i) {
        bench_table_free(sides[i].built);
    }
}

static void race_all(const char *kind, size_t in_column) {
    static const char *const counts[SIZES] = {"1e3", "1e4", "1e5", "1e6"};
    char row[40];
    column = in_column;
    double count = 1000;
    for (size_t i = 0; i < SIZES; ++i, count *= 10) {
        (void)snprintf(row, sizeof row, "%s, %s wafers", kind, counts[i]);
        race(row, (size_t)count, false);
    }
    (void)snprintf(row, sizeof row, "%s, growth", kind);
    race_growth(row);
    count = 1000;
    for (size_t i = 0; i < SIZES; ++i, count *= 10) {
        (void)snprintf(row, sizeof row, "%s, jumping, %s", kind, counts[i]);
        if (i != 1) {
            race(row, (size_t)count, true);
        }
    }
}

int main(int argc, char **argv) {
    bench_begin("index", "ns/slice", argc, argv);
    bench_note("one open, empty gripper in 0.4 mm slices among the wafers, half of them turning, or jumping");
    bench_note("columns: 25 wafers 10 mm apart, each 500 mm; single: one wafer each 500 mm; it takes none");
    bench_note(
        "ours is wh_grasp_step: poses checked, events; peers only look up and check the neighbourhood");
    peers[0] = bench_peer("nanoflann_O2", "libnanoflann-dev");
    peers[1] = bench_peer("nanoflann_native", "libnanoflann-dev");
    peers[2] = bench_peer("fcl_tree", "libfcl-dev");
    race_all("columns", BENCH_COLUMN);
    race_all("single", 1);
    return bench_end();
}
