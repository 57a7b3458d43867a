/* Two grasp tables with the same wafers and inputs, one with buckets and one without, do the same to the last bit. */
#include "grasp/horizon_internal.h"
#include "grasp/restore.h"
#include "support/horizon_scene.h"

#ifndef RUNS
#define RUNS 5000
#endif

enum { STEPS = 160, EVENTS = WH_EVENTS_PER_GRIPPER * GRIPPERS, GUARDS = 4 };

typedef struct {
    wh_grasp_t table;
    wh_wafer_t wafer[WAFERS];
    wh_gripper_t gripper[GRIPPERS];
    wh_event_t event[EVENTS];
    wh_event_list_t list;
} side_t;

/* A state of both, to go back to. */
typedef struct {
    uint64_t slice;
    wh_wafer_t wafer[WAFERS];
    wh_gripper_t gripper[GRIPPERS];
} kept_t;

static uint32_t buckets[WH_GRASP_BUCKETS(WAFERS, GRIPPERS) + GUARDS];

/* How often there was something to save, over all runs: that the test is about what it says. */
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

/* To an earlier state, on one side only once in a while: then the other goes there from somewhere else. */
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
    (void)wh_test_seed();
    for (unsigned run = 0; run < RUNS; ++run) {
        draw_scene(&scene);
        play(&scene, run, &sum);
    }
    print_message("%llu picks, %llu releases, %llu hand-overs, %llu near misses, %llu contests\n",
                  (unsigned long long)sum.picked, (unsigned long long)sum.released,
                  (unsigned long long)sum.handed_over, (unsigned long long)sum.near_misses,
                  (unsigned long long)sum.contested);
    print_message("of %llu looks %llu were within the horizon, %llu in cells, %llu at all wafers\n",
                  tally.looks, tally.covered, tally.listed, tally.all);
    assert_true(sum.picked > RUNS && sum.released > RUNS && sum.near_misses > RUNS);
    assert_true(sum.handed_over > RUNS / 10 && sum.contested > RUNS / 10);
    assert_true(tally.covered > tally.looks / 10 && tally.listed > tally.looks / 50 &&
                tally.all > tally.looks / 50);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(buckets_change_no_bit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
