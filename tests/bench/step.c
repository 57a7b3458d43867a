/* Measures a whole slice through the public API with 2 and 100 wafers, against a step of Bullet and
 * MuJoCo. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/harness.h"
#include "bench/ours.h"
#include "bench/peers.h"

enum { POSES = 8192 };

typedef struct {
    const bench_world_t *world; /* null: ours */
    void *built;
    size_t at;
} side_t;

/* Empty and moving straight, or turning as well; or holding a wafer and moving straight. */
typedef enum { LOOKING, TURNING, CARRYING } kind_t;

static wh_pose_t poses[POSES];

static uint64_t run_ours(void *user, size_t repeats) {
    side_t *side = user;
    uint64_t events = 0;
    for (size_t done = 0; done < repeats; ++done) {
        events += bench_table_step(side->built, &poses[side->at++ % POSES]);
    }
    return events;
}

static uint64_t run_peer(void *user, size_t repeats) {
    side_t *side = user;
    uint64_t sum = 0;
    for (size_t done = 0; done < repeats; ++done) {
        sum += side->world->step(side->built, &poses[side->at++ % POSES]);
    }
    return sum;
}

/* The path leads there and back again, so that no slice has a jump. */
static void make_path(size_t wafers, bool turning) {
    const size_t column = wafers < BENCH_COLUMN ? wafers : BENCH_COLUMN;
    bench_path(poses, POSES / 2, bench_side(wafers, BENCH_COLUMN), column, turning);
    for (size_t i = 0; i < POSES / 2; ++i) {
        poses[POSES - 1 - i] = poses[i];
    }
}

/* MuJoCo's kinematics alone, and Bullet's step with all options that make it light. */
static double goal_of(const char *name, size_t wafers) {
    if (strcmp(name, "MuJoCo kinematics") == 0) {
        return wafers == 2 ? 5 : 100;
    }
    return strncmp(name, "Bullet", 6) == 0 ? (wafers == 2 ? 30 : 300) : 0;
}

static void enter(bench_contender_t *contenders, side_t *sides, size_t *count, const bench_step_peer_t *peer,
                  size_t wafers) {
    for (const bench_world_t *world = peer ? peer->worlds : NULL; world && world->name; ++world) {
        sides[*count] = (side_t){.world = world, .built = world->build(wafers)};
        contenders[*count] = (bench_contender_t){world->name, run_peer, &sides[*count], 1};
        *count += 1;
    }
}

static void race(const char *row, size_t wafer_count, kind_t kind, const bench_step_peer_t *peers[2]) {
    bench_contender_t contenders[BENCH_CONTENDERS];
    bench_result_t results[BENCH_CONTENDERS];
    side_t sides[BENCH_CONTENDERS];
    if (!bench_wanted(row)) {
        return;
    }
    make_path(wafer_count, kind == TURNING);
    wh_pose_t *wafers = bench_wafers(wafer_count, BENCH_COLUMN);
    bench_table_t *ours = bench_table(wafers, wafer_count, true);
    if (kind == CARRYING && bench_table_step(ours, &wafers[0]) != 1) {
        bench_differ("ours", "taking a wafer");
    }
    sides[0] = (side_t){.built = ours};
    contenders[0] = (bench_contender_t){"ours", run_ours, &sides[0], 1};
    size_t count = 1;
    if (kind == LOOKING) {
        enter(contenders, sides, &count, peers[0], wafer_count);
        enter(contenders, sides, &count, peers[1], wafer_count);
    }
    bench_race(contenders, count, results);
    bench_figure(row, "ns a slice", &results[0].ns, true, 50);
    for (size_t c = 1; c < count; ++c) {
        bench_row(row, contenders, results, c, goal_of(contenders[c].name, wafer_count));
        sides[c].world->drop(sides[c].built);
    }
    bench_table_free(ours);
    free(wafers);
}

int main(int argc, char **argv) {
    bench_begin("step", "ns/slice", argc, argv);
    bench_note("one open gripper in 0.4 mm slices: empty, straight or turning; with a wafer; wh_grasp_step "
               "with events");
    bench_note("Bullet does more: free discs are integrated, without contact or gravity; asleep: the blade "
               "alone moves");
    bench_note(
        "MuJoCo's kinematics do less than a slice: poses alone; its step, all off that can be, does more");
    const bench_step_peer_t *peers[2] = {bench_peer("bullet", "libbullet-dev"),
                                         bench_peer("mujoco", "the wheel of tests/bench/requirements.txt")};
    race("2 wafers, looking", 2, LOOKING, peers);
    race("2 wafers, turning", 2, TURNING, peers);
    race("2 wafers, carrying", 2, CARRYING, peers);
    race("100 wafers, looking", 100, LOOKING, peers);
    race("100 wafers, turning", 100, TURNING, peers);
    race("100 wafers, carrying", 100, CARRYING, peers);
    return bench_end();
}
