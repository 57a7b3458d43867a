/* Measures a slice of an EFEM, and of a tool with two robots, with contact and smallest gaps
 * checked for all parts, against FCL and MuJoCo with the same convex parts; and whole runs against
 * real time. Start it at the root, after `make all`. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/harness.h"
#include "bench/peers.h"
#include "collision/gap.h"
#include "collision/world_internal.h"
#include "layout/collision.h"
#include "log/log_run.h"
#include "text/array.h"

enum {
    BLOCK = 16,
    ROUNDS = 9,
    PEERS = 8,
    STRIDE = 37,
    COMPARED = 211,
    FOUND = 64,
    ARM_GROUPS = 100,
    LOOSE_GROUPS = 200
};

#define EFEM "build/tests/bench/efem.lua"
#define TOOL "lua/examples/27_tool.lua"

/* A cell and a run in it. */
typedef struct {
    const char *row;
    const char *note;
    const char *script, *settings;
    const char *log;
    size_t slices; /* the slices that are measured, from the run's begin */
} scene_t;

/* The part of the tool's run in which both robots move and wafers come into vacuum and out again:
 * its slices are kept in memory. */
static const scene_t efem = {"a slice of the EFEM",
                             "all parts and wafers of lua/layouts/efem.lua on a run from FOUP to FOUP; "
                             "contact within the slice and the smallest gaps",
                             EFEM,
                             "",
                             "build/tests/bench/efem.lcm",
                             100000};
static const scene_t tool = {"a slice of the tool",
                             "all parts and wafers of lua/layouts/tool.lua on the first 40 s of " TOOL,
                             TOOL,
                             " --set process=5",
                             "build/tests/bench/tool.lcm",
                             40000};

/* One slice in the form that the world reads, and in the form for the peers. */
typedef struct {
    wh_wafer_t *wafers;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_links_t links;
    bench_mover_t *movers;
    size_t mover_count;
} slice_t;

typedef struct {
    const scene_t *scene;
    const wh_layout_t *layout;
    slice_t *slices;
    size_t count, capacity;
} run_t;

static double now_ns(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

/* --------------------------------------------------------------------------------------------- the run */

static void add_mover(const run_t *run, slice_t *slice, size_t shape, int32_t group, const wh_pose_t *body) {
    const wh_world_config_t *world = &run->layout->world;
    const wh_convex_t *convex = shape < world->part_count ? &world->parts[shape].convex : &world->wafer;
    const slice_t *before = run->count > 0 ? slice - 1 : slice;
    bench_mover_t *mover = &slice->movers[slice->mover_count++];
    mover->shape = (int32_t)shape;
    mover->group = group;
    mover->now = wh_pose_compose(body, &convex->body_from_shape);
    mover->before = mover->now;
    for (size_t i = 0; before != slice && i < before->mover_count; ++i) {
        mover->before = before->movers[i].shape == mover->shape ? before->movers[i].now : mover->before;
    }
}

/* A released wafer may settle; it is at the place where it was released. */
static bool has_moved(const run_t *run, const slice_t *slice, size_t wafer) {
    const wh_wafer_t *before = run->count > 0 ? &slice[-1].wafers[wafer] : NULL;
    return before && (before->holder != WH_NONE || memcmp(&slice->wafers[wafer].base_from_wafer,
                                                          &before->base_from_wafer, sizeof(wh_pose_t)) != 0);
}

static void add_movers(const run_t *run, slice_t *slice) {
    const wh_world_config_t *world = &run->layout->world;
    const wh_pose_t *arm = slice->links.bodies;
    slice->movers = wh_array_new(world->part_count + world->wafer_count, sizeof *slice->movers);
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        if (part->kind == WH_PART_ARM) {
            add_mover(run, slice, i, ARM_GROUPS + part->owner, &arm[part->owner]);
        } else if (part->kind == WH_PART_BLADE || part->kind == WH_PART_CHUCK) {
            add_mover(run, slice, i, part->owner, &slice->grippers[part->owner].base_from_gripper);
        }
    }
    for (size_t w = 0; w < world->wafer_count; ++w) {
        const int32_t holder = slice->wafers[w].holder;
        if (holder != WH_NONE || has_moved(run, slice, w)) {
            add_mover(run, slice, world->part_count + w,
                      holder != WH_NONE ? holder : LOOSE_GROUPS + (int32_t)w,
                      &slice->wafers[w].base_from_wafer);
        }
    }
}

static void on_slice(void *user, const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                     uint64_t hash) {
    run_t *run = user;
    wh_pose_t grippers[WH_GRIPPERS];
    (void)hash;
    run->layout = layout;
    if (run->count == run->capacity) {
        return;
    }
    slice_t *slice = &run->slices[run->count];
    slice->wafers = wh_array_new(state->wafer_count, sizeof *slice->wafers);
    memcpy(slice->wafers, state->wafers, state->wafer_count * sizeof *slice->wafers);
    memcpy(slice->grippers, state->grippers, state->gripper_count * sizeof *slice->grippers);
    for (size_t g = 0; g < state->gripper_count; ++g) {
        grippers[g] = state->grippers[g].base_from_gripper;
    }
    wh_links_home(&slice->links, layout);
    wh_links_follow(&slice->links, layout, grippers, axes, NULL, WH_LINKS_SAME);
    add_movers(run, slice);
    ++run->count;
}

/* Moves a wafer from one FOUP over the aligner to the other FOUP. */
static void write_efem(void) {
    FILE *script = fopen(EFEM, "w");
    if (!script ||
        fputs("cell '../../../lua/layouts/efem.lua'\n"
              "get('FOUP1', 12) put('ALIGN', 1) get('ALIGN', 1) put('FOUP2', 7)\n",
              script) < 0 ||
        fclose(script) != 0) {
        bench_differ("the script", "a file that can be written");
    }
}

/* The program plays the run, and it is read from its recording. */
static void record(run_t *run, wh_log_run_t *log) {
    char line[400];
    (void)snprintf(line, sizeof line, "rm -f %s && build/waferhand run %s%s --record %s >/dev/null",
                   run->scene->log, run->scene->script, run->scene->settings, run->scene->log);
    if (system(line) != 0) {
        bench_differ("the program", "a run without a hit");
    }
    const wh_log_run_options_t options = {.path = run->scene->log, .listener = on_slice, .user = run};
    run->capacity = run->scene->slices;
    run->slices = wh_array_new(run->capacity, sizeof *run->slices);
    if (!wh_log_run_read(log, &options) || run->count < 1000) {
        bench_differ("the recording", log->message);
    }
}

/* ------------------------------------------------------------------------------------------------ answers */

static wh_world_t *begin(const run_t *run, void *memory, size_t bytes) {
    const slice_t *first = &run->slices[0];
    const wh_world_input_t input = {1, first->wafers, first->grippers, first->links.bodies, NULL};
    return wh_world_init(&run->layout->world, &input, memory, bytes);
}

/* Reads the data of the slice first: the program has just made them, so they are in the cache. */
static void warm(const void *memory, size_t bytes) {
    static volatile unsigned char sum;
    for (size_t at = 0; at < bytes; at += 64) {
        sum ^= ((const unsigned char *)memory)[at];
    }
}

static void warm_slice(const run_t *run, const slice_t *slice) {
    warm(slice->wafers, run->layout->wafer_count * sizeof *slice->wafers);
    warm(slice->grippers, sizeof slice->grippers);
    warm(slice->links.bodies, sizeof slice->links.bodies);
}

/* ns per slice, over the whole run. */
static double time_ours(const run_t *run, void *memory, size_t bytes) {
    wh_event_t events[16];
    wh_event_list_t list = {events, 16, 0};
    wh_world_t *world = begin(run, memory, bytes);
    double ns = 0;
    for (size_t first = 1; first < run->count; first += BLOCK) {
        const size_t end = first + BLOCK < run->count ? first + BLOCK : run->count;
        for (size_t i = first; i < end; ++i) {
            warm_slice(run, &run->slices[i]);
        }
        const double start = now_ns();
        for (size_t i = first; i < end; ++i) {
            const slice_t *slice = &run->slices[i];
            const wh_world_input_t input = {i + 1, slice->wafers, slice->grippers, slice->links.bodies, NULL};
            wh_world_step(world, &input, &list);
        }
        ns += now_ns() - start;
    }
    for (size_t i = 0; i < list.count; ++i) {
        if (events[i].kind == WH_EVENT_HIT || events[i].kind == WH_EVENT_UNDECIDED) {
            bench_differ("ours", "a run without a hit");
        }
    }
    return ns / (double)(run->count - 1);
}

/* True if a body begins or ends to move in this slice: peers must not miss it. */
static bool is_turn(const run_t *run, size_t i) {
    const slice_t *slice = &run->slices[i];
    bool same = slice->mover_count == slice[-1].mover_count;
    for (size_t k = 0; same && k < slice->mover_count; ++k) {
        same = slice->movers[k].shape == slice[-1].movers[k].shape &&
               slice->movers[k].group == slice[-1].movers[k].group;
    }
    return !same;
}

static bench_slice_t asked_of(const run_t *run, size_t i) {
    return (bench_slice_t){run->slices[i].movers, run->slices[i].mover_count};
}

/* ns per slice, for each STRIDEth slice. */
static double time_peer(const run_t *run, const bench_collider_t *peer, void *built, size_t first) {
    bench_near_t found[FOUND];
    size_t looked = 0;
    double ns = 0;
    for (size_t i = 1; i < run->count; ++i) {
        const bench_slice_t slice = asked_of(run, i);
        if (i % STRIDE == first) {
            warm(slice.movers, slice.count * sizeof *slice.movers);
            const double start = now_ns();
            (void)peer->look(built, &slice, found, FOUND);
            ns += now_ns() - start;
            ++looked;
        } else if (is_turn(run, i)) {
            (void)peer->look(built, &slice, found, FOUND);
        }
    }
    return ns / (double)looked;
}

/* The gaps of all pairs of a slice, one by one. */
typedef struct {
    const run_t *run;
    const bench_cell_t *cell;
    wh_pose_t *base_from_shape;
    int32_t *groups;
} plain_t;

static void take_slice(const plain_t *plain, const slice_t *slice) {
    const wh_world_config_t *world = &plain->run->layout->world;
    for (size_t i = 0; i < plain->cell->count; ++i) {
        plain->groups[i] = WH_NONE;
        plain->base_from_shape[i] = plain->cell->base_from_shape[i];
    }
    for (size_t w = 0; w < world->wafer_count; ++w) {
        plain->base_from_shape[world->part_count + w] =
            wh_pose_compose(&slice->wafers[w].base_from_wafer, &world->wafer.body_from_shape);
    }
    for (size_t i = 0; i < slice->mover_count; ++i) {
        plain->groups[slice->movers[i].shape] = slice->movers[i].group;
        plain->base_from_shape[slice->movers[i].shape] = slice->movers[i].now;
    }
}

static wh_gap_t gap_of(const plain_t *plain, size_t a, size_t b) {
    wh_gap_t gap;
    wh_gap_measure(plain->cell->convex[a], &plain->base_from_shape[a], plain->cell->convex[b],
                   &plain->base_from_shape[b], 20, wh_vec3(0, 0, 0), &gap);
    return gap;
}

static bool is_found(const bench_near_t found[], size_t count, size_t a, size_t b) {
    for (size_t i = 0; i < count; ++i) {
        const size_t one = (size_t)found[i].a;
        const size_t two = (size_t)found[i].b;
        if ((one == a && two == b) || (one == b && two == a)) {
            return true;
        }
    }
    return false;
}

static double lesser(double a, double b) {
    return a < b ? a : b;
}

static bool is_pair(const plain_t *plain, size_t a, size_t b) {
    return plain->groups[a] != plain->groups[b] && !plain->cell->neighbours[a * plain->cell->count + b];
}

/* Deep overlaps must be found, and clear gaps must give no contact. Between them, for faces that
 * touch, each side may decide. */
static bool is_wrong(const wh_gap_t *gap, bool is_hit) {
    return is_hit ? gap->state == WH_GAP_CLEAR && gap->gap > 0.05 : gap->state == WH_GAP_HIT;
}

/* Peers that report the least gap must report the same; the others must report the same contacts. */
static void compare_slice(const plain_t *plain, const bench_collider_t *peer, void *built,
                          const slice_t *slice) {
    bench_near_t found[FOUND];
    const bench_slice_t asked = {slice->movers, slice->mover_count};
    const size_t count = peer->look(built, &asked, found, FOUND);
    double least = 20;
    take_slice(plain, slice);
    for (size_t a = 0; a < plain->cell->count; ++a) {
        for (size_t b = 0; b < a; ++b) {
            if (is_pair(plain, a, b)) {
                const wh_gap_t gap = gap_of(plain, a, b);
                least = lesser(least, gap.state == WH_GAP_CLEAR ? gap.gap : 0);
                if (!peer->is_nearest && is_wrong(&gap, is_found(found, count, a, b))) {
                    bench_differ(peer->name, "contacts");
                }
            }
        }
    }
    const double theirs = count > 0 ? lesser(fmax(found[0].gap, 0), 20) : 20;
    if (peer->is_nearest && fabs(theirs - least) > 0.02) {
        bench_differ(peer->name, "the smallest gap");
    }
}

static void compare(const run_t *run, const bench_cell_t *cell, const bench_collider_t *peer, void *built) {
    const plain_t plain = {run, cell, wh_array_new(cell->count, sizeof(wh_pose_t)),
                           wh_array_new(cell->count, sizeof(int32_t))};
    for (size_t i = 1; i < run->count; ++i) {
        if (i % COMPARED == 0 || is_turn(run, i)) {
            compare_slice(&plain, peer, built, &run->slices[i]);
        }
    }
    free(plain.base_from_shape);
    free(plain.groups);
}

/* ------------------------------------------------------------------------------------------------- racing */

/* All bodies at rest as the run begins. Parts of the arm that follow each other are neighbours. */
static bench_cell_t cell_of(const run_t *run) {
    const wh_world_config_t *world = &run->layout->world;
    const size_t count = world->part_count + world->wafer_count;
    const wh_convex_t **convex = wh_array_new(count, sizeof *convex);
    wh_pose_t *poses = wh_array_new(count, sizeof *poses);
    bool *neighbours = wh_array_new(count * count, sizeof *neighbours);
    bool *moves = wh_array_new(count, sizeof *moves);
    for (size_t i = 0; i < count; ++i) {
        const bool is_part = i < world->part_count;
        moves[i] =
            !is_part || (world->parts[i].kind != WH_PART_FIXED && world->parts[i].kind != WH_PART_LEDGE);
        convex[i] = is_part ? &world->parts[i].convex : &world->wafer;
        poses[i] = is_part ? convex[i]->body_from_shape
                           : wh_pose_compose(&run->slices[0].wafers[i - world->part_count].base_from_wafer,
                                             &world->wafer.body_from_shape);
        for (size_t k = 0; k < count; ++k) {
            neighbours[i * count + k] = is_part && k < world->part_count &&
                                        wh_world_belong_together(world, &world->parts[i], &world->parts[k]);
        }
    }
    return (bench_cell_t){convex, poses, neighbours, moves, count};
}

static void race(const run_t *run, const bench_cell_t *cell, const bench_collider_t *peer, double goal) {
    static double ours[ROUNDS];
    static double theirs[ROUNDS];
    static double faster[ROUNDS];
    const size_t bytes = wh_world_bytes(&run->layout->world);
    void *memory = wh_array_new(bytes, 1);
    void *built = peer->build(cell);
    compare(run, cell, peer, built);
    for (size_t round = 0; round < ROUNDS; ++round) {
        ours[round] = time_ours(run, memory, bytes);
        theirs[round] = time_peer(run, peer, built, round % STRIDE);
        faster[round] = theirs[round] / ours[round];
    }
    const bench_contender_t contenders[] = {{.name = "ours"}, {.name = peer->name}};
    const bench_result_t results[] = {{.ns = bench_spread(ours, ROUNDS)},
                                      {bench_spread(theirs, ROUNDS), bench_spread(faster, ROUNDS)}};
    bench_row(run->scene->row, contenders, results, 1, goal);
    peer->drop(built);
    free(memory);
}

static double goal_of(const bench_collider_t *peer) {
    if (strncmp(peer->name, "MuJoCo", 6) == 0) {
        return strcmp(peer->name, "MuJoCo, contacts") == 0   ? 40
               : strcmp(peer->name, "MuJoCo, to 20 mm") == 0 ? 300
                                                             : 0;
    }
    return 10;
}

static void race_all(const run_t *run, const bench_cell_t *cell, const bench_collider_t *peers) {
    for (const bench_collider_t *peer = peers; peer && peer->name; ++peer) {
        race(run, cell, peer, goal_of(peer));
    }
}

static void time_run(const scene_t *scene) {
    double times[41];
    char command[300];
    (void)snprintf(command, sizeof command, "build/waferhand run %s --json", scene->script);
    for (size_t i = 0; i < sizeof times / sizeof times[0]; ++i) {
        FILE *answer = popen(command, "r");
        char line[400];
        double simulated = 0;
        double wall = 0;
        while (answer && fgets(line, sizeof line, answer)) {
            (void)(sscanf(line, " \"simulated_s\": %lf", &simulated) ||
                   sscanf(line, " \"wall_s\": %lf", &wall));
        }
        if (!answer || pclose(answer) != 0) {
            bench_differ("the program", "a run that ends well");
        }
        times[i] = simulated / wall;
    }
    const bench_spread_t spread = bench_spread(times, sizeof times / sizeof times[0]);
    bench_figure("the EFEM, real time", "x real time", &spread, false, 1000);
}

/* The number of robots that move in a slice. */
static size_t count_moving(const run_t *run, size_t i) {
    const wh_pose_t *now = run->slices[i].links.bodies;
    const wh_pose_t *before = run->slices[i - 1].links.bodies;
    bool moves[WH_WORLD_ARMS] = {false};
    size_t count = 0;
    for (size_t arm = 0; arm < run->layout->world.arm_count; ++arm) {
        const size_t first = arm * WH_ARM_BODIES;
        bool *own = &moves[run->layout->world.arms[arm].robot];
        const bool has_moved = memcmp(&now[first], &before[first], (size_t)WH_ARM_BODIES * sizeof *now) != 0;
        count += has_moved && !*own ? 1 : 0;
        *own = *own || has_moved;
    }
    return count;
}

/* The cost of a slice in which two robots move, against one in which one moves. */
static double grow(const run_t *run, void *memory, size_t bytes) {
    wh_event_t events[16];
    wh_event_list_t list = {events, 16, 0};
    double ns[3] = {0};
    size_t count[3] = {0};
    wh_world_t *world = begin(run, memory, bytes);
    for (size_t i = 1; i < run->count; ++i) {
        const slice_t *slice = &run->slices[i];
        const wh_world_input_t input = {i + 1, slice->wafers, slice->grippers, slice->links.bodies, NULL};
        const size_t moving = count_moving(run, i);
        const double start = now_ns();
        wh_world_step(world, &input, &list);
        ns[moving] += now_ns() - start;
        ++count[moving];
    }
    if (count[1] < 1000 || count[2] < 1000) {
        bench_differ("the tool's run", "slices in which one robot moves, and two");
    }
    return ns[2] / (double)count[2] / (ns[1] / (double)count[1]);
}

static void time_growth(const run_t *run) {
    double times[ROUNDS];
    const size_t bytes = wh_world_bytes(&run->layout->world);
    void *memory = wh_array_new(bytes, 1);
    for (size_t i = 0; i < ROUNDS; ++i) {
        times[i] = grow(run, memory, bytes);
    }
    const bench_spread_t spread = bench_spread(times, ROUNDS);
    bench_figure("the tool, 2 robots move", "x one that moves", &spread, true, 2);
    free(memory);
}

/* To be dropped. */
static run_t *race_scene(const scene_t *scene, wh_log_run_t *log) {
    run_t *run = wh_array_new(1, sizeof *run);
    run->scene = scene;
    bench_note("%s", scene->note);
    record(run, log);
    const bench_cell_t cell = cell_of(run);
    race_all(run, &cell, bench_peer_symbol("fcl_tree", "bench_cell", "libfcl-dev"));
    race_all(run, &cell,
             bench_peer_symbol("mujoco", "bench_cell", "the wheel of tests/bench/requirements.txt"));
    return run;
}

static void drop(run_t *run, wh_log_run_t *log) {
    for (size_t i = 0; i < run->count; ++i) {
        free(run->slices[i].wafers);
        free(run->slices[i].movers);
    }
    free(run->slices);
    free(run);
    wh_log_run_close(log);
}

int main(int argc, char **argv) {
    static wh_log_run_t log;
    bench_begin("collide", "ns/slice", argc, argv);
    write_efem();
    bench_note("peers do less: contact at one instant, or the one smallest gap; FCL's continuous: contact "
               "within the slice alone");
    run_t *run = race_scene(&efem, &log);
    time_run(&efem);
    drop(run, &log);
    run = race_scene(&tool, &log);
    time_growth(run);
    drop(run, &log);
    return bench_end();
}
