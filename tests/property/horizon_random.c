/* Two grasp tables with the same wafers and inputs, one with buckets and one without, agree to the
 * last bit. */
#include "grasp/grasp.h"
#include "grasp/horizon_internal.h"
#include "grasp/restore.h"
#include "support/pose.h"

#ifndef RUNS
#define RUNS 5000
#endif

/* Random cells and motions for the horizon: cases in which an unobserved wafer would be missed. */
enum { WAFERS = 70, GRIPPERS = 4 };

enum { STAND, GO, JUMP_AND_GO, JUMP, EDGE, KINDS };

/* The motion of a gripper for a while. */
typedef struct {
    int kind;
    uint32_t left;  /* slices */
    wh_pose_t next; /* for kind EDGE: just inside */
    wh_vec3_t way;  /* of one slice */
    int32_t valve;
} doing_t;

typedef struct {
    wh_grasp_config_t config;
    size_t wafers, grippers;
    wh_wafer_t wafer[WAFERS];
    double size;      /* half of the cell's edge, mm */
    wh_vec3_t centre; /* of the cell */
    double tilt;      /* the tilt of wafers and grippers */
    doing_t doing[GRIPPERS];
} scene_t;

static wh_real_t draw_one(const double choices[], uint32_t count) {
    return WH_REAL(choices[wh_test_below(count)]);
}

static wh_grasp_config_t draw_config(void) {
    static const double projz[] = {0.5, 0.5, 5, 0.01};
    static const double projxy[] = {50, 50, 5, 300};
    static const double planar[] = {0.99, 0.99, 0.99998, 0};
    static const double near_z[] = {4.5, 4.5, 4.5, 0.1, 60, 1e-3, 3e5};
    static const double near_xy[] = {100, 100, 100, 10, 1500, 1, 3e5};
    wh_grasp_config_t config = wh_grasp_config_default();
    config.tolerance.projz = draw_one(projz, 4);
    config.tolerance.projxy = draw_one(projxy, 4);
    config.tolerance.planar = draw_one(planar, 4);
    config.near_projz = draw_one(near_z, 7);
    config.near_projxy = draw_one(near_xy, 7);
    config.check = wh_test_below(2) ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED;
    config.seat = wh_test_below(4) == 0;
    return config;
}

static wh_mat3_t draw_turn(double tilt) {
    wh_mat3_t R = tilt > 0 ? wh_test_random_turn(tilt) : wh_mat3_identity();
    /* Columns as long or as short as is allowed. */
    if (wh_test_below(4) == 0) {
        const wh_real_t scale = 1 + WH_REAL(wh_test_uniform(-0.49, 0.49)) * WH_ROTATION_TOLERANCE;
        for (int k = 0; k < 9; ++k) {
            R.m[k / 3][k % 3] *= scale;
        }
    }
    return R;
}

static wh_vec3_t draw_place(const scene_t *scene) {
    return wh_vec3(scene->centre.x + WH_REAL(wh_test_uniform(-scene->size, scene->size)),
                   scene->centre.y + WH_REAL(wh_test_uniform(-scene->size, scene->size)),
                   scene->centre.z + WH_REAL(wh_test_uniform(-scene->size, scene->size)));
}

/* Columns of wafers 10 mm above each other, or single wafers, or a level grid on which distances
 * are equal. */
static void draw_wafers(scene_t *scene) {
    const uint32_t kind = wh_test_below(3);
    wh_pose_t slot = {draw_turn(scene->tilt), draw_place(scene)};
    for (size_t w = 0; w < scene->wafers; ++w) {
        if (kind == 0 && wh_test_below(12)) {
            slot.r.z += 10;
        } else {
            slot.r = draw_place(scene);
            slot.R = draw_turn(wh_test_below(3) ? scene->tilt : WH_TEST_PI);
        }
        if (kind == 1) {
            slot = wh_test_at((double)scene->centre.x + (int)wh_test_below(5) * 25,
                              (double)scene->centre.y + (int)wh_test_below(5) * 25,
                              (double)scene->centre.z + (int)wh_test_below(9) * 0.25);
        }
        scene->wafer[w].base_from_wafer = slot;
    }
}

static void draw_scene(scene_t *scene) {
#if defined(WH_FLOAT)
    const double farthest = 1e6;
#else
    const double farthest = 1e12;
#endif
    static const double tilts[] = {0, 0.003, 0.026, 0.3, WH_TEST_PI};
    memset(scene, 0, sizeof *scene);
    scene->config = draw_config();
    scene->wafers = 1 + wh_test_below(wh_test_below(2) ? WAFERS : wh_test_below(2) ? 12 : 2);
    scene->grippers = 1 + wh_test_below(GRIPPERS);
    scene->tilt = tilts[wh_test_below(5)];
    scene->size = wh_test_decades(100, 5000);
    if (wh_test_below(6) == 0) {
        const double far = wh_test_decades(1000, farthest);
        scene->centre = wh_vec3(WH_REAL(far), WH_REAL(wh_test_uniform(-far, far)), WH_REAL(-far));
    }
    draw_wafers(scene);
}

/* Beside the wafer by these distances, give or take a few last places: on the edge of their limits. */
static wh_pose_t beside(const wh_pose_t *wafer, double z, double xy, double tilt) {
    const double angle = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
    const double edge = wh_test_below(2) ? 0 : wh_test_decades(1e-12, 0.1) * (wh_test_below(2) ? 1 : -1);
    const wh_vec3_t p = wh_vec3(WH_REAL((xy + edge) * cos(angle)), WH_REAL((xy + edge) * sin(angle)),
                                WH_REAL(wh_test_below(2) ? z + edge : -z - edge));
    const wh_vec3_t dr = wh_mat3_transform(&wafer->R, &p);
    const wh_mat3_t turn = draw_turn(tilt);
    wh_pose_t pose = {wh_mat3_multiply(&wafer->R, &turn), wh_vec3_subtract(&wafer->r, &dr)};
    if (wh_pose_validate(&pose) != WH_OK) {
        pose.R = wafer->R;
    }
    return pose;
}

/* Outside the neighbourhood or the tolerance, by up to as much again, and then the same way inside:
 * the largest step that a horizon may allow. */
static wh_pose_t draw_edge(const scene_t *scene, const wh_pose_t *wafer, wh_pose_t *inside) {
    const wh_grasp_config_t *config = &scene->config;
    const bool near = wh_test_below(2);
    const double z = (double)(near ? config->near_projz : config->tolerance.projz);
    const double xy = (double)(near ? config->near_projxy : config->tolerance.projxy);
    const double side = wh_test_below(2) ? 1 : -1;
    const double within = wh_test_decades(1e-9, 1e-2);
    const bool above = wh_test_below(2);
    const double size = above ? z : xy;
    const double gap = wh_test_below(4) ? wh_test_decades(0.03, 1 + size) : wh_test_uniform(0.3, 1) * size;
    const double angle = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
    wh_pose_t poses[2];
    for (int i = 0; i < 2; ++i) {
        const double off = i == 0 ? gap : -within;
        const double radius = above ? 0.3 * xy : xy + off;
        const wh_vec3_t p = wh_vec3(WH_REAL(radius * cos(angle)), WH_REAL(radius * sin(angle)),
                                    WH_REAL(side * (above ? z + off : 0.3 * z)));
        const wh_vec3_t dr = wh_mat3_transform(&wafer->R, &p);
        poses[i].R = wafer->R;
        poses[i].r = wh_vec3_subtract(&wafer->r, &dr);
    }
    *inside = poses[1];
    return poses[0];
}

/* Anywhere in the cell, or where a gripper would take or watch it, or very far away. */
static wh_pose_t draw_rest(const scene_t *scene, const wh_gripper_t grippers[]) {
    const wh_pose_t *gripper = &grippers[wh_test_below((uint32_t)scene->grippers)].base_from_gripper;
    wh_pose_t pose = {draw_turn(wh_test_below(3) ? scene->tilt : WH_TEST_PI), draw_place(scene)};
    switch (wh_test_below(4)) {
    case 0:
        return beside(gripper, (double)scene->config.tolerance.projz,
                      wh_test_uniform(0, (double)scene->config.tolerance.projxy), 0.05);
    case 1:
        return beside(gripper, (double)scene->config.near_projz, (double)scene->config.near_projxy, 0.05);
    case 2:
        pose.r.x *= WH_REAL(wh_test_decades(1, 1e30));
        return pose;
    default:
        return pose;
    }
}

/* To the edge of the tolerance or of the neighbourhood of a wafer, or close by. */
static wh_pose_t jump(const scene_t *scene, const wh_pose_t *wafer) {
    const wh_grasp_config_t *config = &scene->config;
    const bool near = wh_test_below(2);
    const double z = (double)(near ? config->near_projz : config->tolerance.projz);
    const double xy = (double)(near ? config->near_projxy : config->tolerance.projxy);
    switch (wh_test_below(5)) {
    case 0:
        return beside(wafer, z, wh_test_uniform(0, xy), 0.05);
    case 1:
        return beside(wafer, wh_test_uniform(0, z), xy, 0.05);
    case 2:
        return beside(wafer, 0.3 * z, 0.3 * xy, 0.01);
    case 3:
        return beside(wafer, z * wh_test_decades(1, 30), wh_test_uniform(0, 2 * xy), 0.05);
    default:
        return wh_test_pose(draw_turn(scene->tilt), (double)draw_place(scene).x, (double)draw_place(scene).y,
                            (double)draw_place(scene).z);
    }
}

/* Straight away from a wafer, towards it or past it, in slices of a given length. */
static wh_vec3_t draw_way(const wh_pose_t *wafer, const wh_vec3_t *place) {
    static const double lengths[] = {0.4, 0.4, 0.02, 1, 5, 40};
    const double length = wh_test_below(2) ? lengths[wh_test_below(6)] : wh_test_decades(1e-4, 100);
    wh_vec3_t towards = wh_vec3_subtract(&wafer->r, place);
    const wh_real_t distance = wh_vec3_norm(&towards);
    const bool has_direction = distance > 0 && distance < WH_REAL(1e15);
    if (wh_test_below(3) == 0 || !has_direction) {
        const wh_mat3_t R = wh_test_random_turn(WH_TEST_PI);
        towards = wh_vec3_scale(WH_REAL(length), &(wh_vec3_t){R.m[0][0], R.m[0][1], R.m[0][2]});
        return towards;
    }
    return wh_vec3_scale(WH_REAL(length) / distance, &towards);
}

static void draw_doing(const scene_t *scene, const wh_wafer_t wafers[], const wh_gripper_t *gripper,
                       doing_t *doing) {
    const wh_wafer_t *wafer = &wafers[wh_test_below((uint32_t)scene->wafers)];
    doing->kind = (int)wh_test_below(KINDS);
    doing->left = doing->kind == EDGE ? 2 : 1 + wh_test_below(40);
    doing->way = draw_way(&wafer->base_from_wafer, &gripper->base_from_gripper.r);
    doing->valve = wh_test_below(4) ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
}

/* Two grippers at one wafer: one releases the wafer that it holds, or keeps it, while the other is ready. */
static void meet(const scene_t *scene, wh_gripper_input_t inputs[]) {
    const uint32_t count = (uint32_t)scene->grippers;
    const size_t g = wh_test_below(count);
    wh_gripper_input_t *other = &inputs[(g + 1 + wh_test_below(count)) % count];
    if (&inputs[g] != other) {
        other->base_from_gripper = inputs[g].base_from_gripper;
        other->base_from_gripper.r.z += WH_REAL(wh_test_uniform(-0.01, 0.01));
        other->valve = WH_VALVE_OPEN;
        inputs[g].valve = wh_test_below(2) ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
    }
}

static wh_pose_t draw_next(const scene_t *scene, doing_t *doing, const wh_pose_t *wafer, wh_pose_t pose,
                           bool first) {
    if (doing->kind == EDGE) {
        return first ? draw_edge(scene, wafer, &doing->next) : doing->next;
    }
    if (doing->kind == JUMP || (doing->kind == JUMP_AND_GO && first)) {
        return jump(scene, wafer);
    }
    if (doing->kind != STAND) {
        pose.r = wh_vec3_add(&pose.r, &doing->way);
    }
    return pose;
}

/* The next slice's inputs. */
static void draw_inputs(scene_t *scene, const wh_wafer_t wafers[], const wh_gripper_t grippers[],
                        wh_gripper_input_t inputs[]) {
    for (size_t g = 0; g < scene->grippers; ++g) {
        doing_t *doing = &scene->doing[g];
        const bool first = doing->left == 0;
        if (first) {
            draw_doing(scene, wafers, &grippers[g], doing);
        }
        --doing->left;
        const wh_pose_t *wafer = &wafers[wh_test_below((uint32_t)scene->wafers)].base_from_wafer;
        inputs[g].base_from_gripper = draw_next(scene, doing, wafer, grippers[g].base_from_gripper, first);
        inputs[g].valve = doing->kind == JUMP && wh_test_below(4) == 0 ? WH_VALVE_CLOSED : doing->valve;
    }
    if (wh_test_below(6) == 0) {
        meet(scene, inputs);
    }
}

enum { STEPS = 160, EVENTS = WH_EVENTS_PER_GRIPPER * GRIPPERS, GUARDS = 4 };

typedef struct {
    wh_grasp_t table;
    wh_wafer_t wafer[WAFERS];
    wh_gripper_t gripper[GRIPPERS];
    wh_event_t event[EVENTS];
    wh_event_list_t list;
} side_t;

/* A saved state of both. */
typedef struct {
    uint64_t slice;
    wh_wafer_t wafer[WAFERS];
    wh_gripper_t gripper[GRIPPERS];
} kept_t;

static uint32_t buckets[WH_GRASP_BUCKETS(WAFERS, GRIPPERS) + GUARDS];

/* The number of steps that were saved, over all runs: it shows that the test does what it says. */
static struct { unsigned long long looks, covered, listed, all; } tally;

static void begin(side_t *side, const scene_t *scene, bool with_buckets) {
    memset(side, 0, sizeof *side);
    memcpy(side->wafer, scene->wafer, sizeof side->wafer);
    wh_grasp_storage_t storage = {side->wafer, scene->wafers, side->gripper, scene->grippers, NULL, 0};
    if (with_buckets) {
        storage.buckets = buckets;
        storage.bucket_count = wh_grasp_buckets(scene->wafers, scene->grippers);
        for (size_t i = 0; i < sizeof buckets / sizeof buckets[0]; ++i) {
            buckets[i] = (uint32_t)wh_test_random();
        }
    }
    assert_int_equal(wh_grasp_init(&side->table, &scene->config, &storage), WH_OK);
    side->list.events = side->event;
    side->list.capacity = EVENTS;
}

static const char *difference(const side_t *a, const side_t *b) {
    if (wh_grasp_hash(&a->table) != wh_grasp_hash(&b->table)) {
        return "the hash";
    }
    if (a->list.count != b->list.count) {
        return "the number of events";
    }
    if (memcmp(a->event, b->event, a->list.count * sizeof a->event[0]) != 0) {
        return "an event";
    }
    if (memcmp(&a->table.counters, &b->table.counters, sizeof a->table.counters) != 0) {
        return "a counter";
    }
    if (memcmp(a->wafer, b->wafer, sizeof a->wafer) != 0) {
        return "a wafer";
    }
    return memcmp(a->gripper, b->gripper, sizeof a->gripper) != 0 ? "a gripper" : NULL;
}

static void count_looks(side_t *side, const wh_gripper_input_t input[]) {
    wh_grasp_t *table = &side->table;
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        if (input[g].valve == WH_VALVE_OPEN && table->storage.grippers[g].wafer == WH_NONE) {
            const wh_vec3_t *place = &input[g].base_from_gripper.r;
            const bool covered = wh_horizon_is_clear_at(table, g, place);
            const wh_found_t near = wh_index_near(table, g, place, place, 0);
            ++tally.looks;
            tally.covered += covered;
            *(near.listed ? &tally.listed : &tally.all) += !covered;
        }
    }
}

static void place_somewhere(side_t *plain, side_t *indexed, const scene_t *scene) {
    const size_t w = wh_test_below((uint32_t)scene->wafers);
    const wh_pose_t pose = draw_rest(scene, plain->gripper);
    assert_int_equal(wh_grasp_place(&plain->table, w, &pose), wh_grasp_place(&indexed->table, w, &pose));
}

/* Back to an earlier state, now and then on one side only; then the other gets there from another state. */
static void keep_or_restore(side_t *plain, side_t *indexed, kept_t *kept) {
    if (kept->slice == 0 || wh_test_below(2)) {
        kept->slice = plain->table.slice;
        memcpy(kept->wafer, plain->wafer, sizeof kept->wafer);
        memcpy(kept->gripper, plain->gripper, sizeof kept->gripper);
    }
    assert_int_equal(wh_grasp_restore(&plain->table, kept->slice, kept->wafer, kept->gripper), WH_OK);
    assert_int_equal(wh_grasp_restore(&indexed->table, kept->slice, kept->wafer, kept->gripper), WH_OK);
}

static void disturb(side_t *plain, side_t *indexed, const scene_t *scene, kept_t *kept) {
    switch (wh_test_below(60)) {
    case 0:
        keep_or_restore(plain, indexed, kept);
        break;
    case 1:
    case 2:
        place_somewhere(plain, indexed, scene);
        break;
    default:
        break;
    }
}

static void fail_at(const scene_t *scene, unsigned run, size_t step, const char *what) {
    print_error("run %u, step %zu: %s (%zu wafers, %zu grippers, %s; near %g %g)\n", run, step, what,
                scene->wafers, scene->grippers, scene->config.check == WH_CHECK_SWEPT ? "swept" : "sampled",
                (double)scene->config.near_projz, (double)scene->config.near_projxy);
    fail();
}

static void play(scene_t *scene, unsigned run, wh_grasp_counters_t *sum) {
    static side_t plain, indexed;
    static kept_t kept;
    wh_gripper_input_t input[GRIPPERS];
    kept.slice = 0;
    begin(&plain, scene, false);
    begin(&indexed, scene, true);
    const uint32_t *guards = buckets + indexed.table.storage.bucket_count;
    uint32_t before[GUARDS];
    memcpy(before, guards, sizeof before);
    for (size_t step = 0; step < STEPS; ++step) {
        disturb(&plain, &indexed, scene, &kept);
        draw_inputs(scene, plain.wafer, plain.gripper, input);
        count_looks(&indexed, input);
        const wh_status_t status = wh_grasp_step(&plain.table, input, &plain.list);
        assert_int_equal(status, wh_grasp_step(&indexed.table, input, &indexed.list));
        const char *what = difference(&plain, &indexed);
        if (what) {
            fail_at(scene, run, step, what);
        }
    }
    assert_memory_equal(guards, before, sizeof before);
    sum->picked += plain.table.counters.picked;
    sum->released += plain.table.counters.released;
    sum->handed_over += plain.table.counters.handed_over;
    sum->near_misses += plain.table.counters.near_misses;
    sum->contested += plain.table.counters.contested;
}

static void buckets_change_no_bit(void **state) {
    (void)state;
    static scene_t scene;
    wh_grasp_counters_t sum = {0};
    wh_rounds_t rounds = WH_ROUNDS(50, RUNS, 1);
    while (wh_round(&rounds)) {
        draw_scene(&scene);
        play(&scene, (unsigned)rounds.number, &sum);
    }
    print_message("%llu picks, %llu releases, %llu hand-overs, %llu near misses, %llu contests\n",
                  (unsigned long long)sum.picked, (unsigned long long)sum.released,
                  (unsigned long long)sum.handed_over, (unsigned long long)sum.near_misses,
                  (unsigned long long)sum.contested);
    print_message("of %llu looks %llu were within the horizon, %llu in cells, %llu at all wafers\n",
                  tally.looks, tally.covered, tally.listed, tally.all);
    const uint64_t runs = (uint64_t)rounds.made;
    assert_true(sum.picked > runs && sum.released > runs && sum.near_misses > runs);
    assert_true(sum.handed_over > runs / 10 && sum.contested > runs / 10);
    assert_true(tally.covered > tally.looks / 10 && tally.listed > tally.looks / 50 &&
                tally.all > tally.looks / 50);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(buckets_change_no_bit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
