/* Our side of the races for a step: a grasp table with one open, empty gripper. */
#ifndef WH_TESTS_BENCH_TABLE_H
#define WH_TESTS_BENCH_TABLE_H

#include "bench/scene.h"

typedef struct {
    wh_grasp_t table;
    wh_gripper_t gripper;
    wh_event_t events[WH_EVENTS_PER_GRIPPER];
    wh_event_list_t list;
    int valve; /* open, unless changed */
} bench_table_t;

/* With an index, or the plain loop. The caller frees it, and hands the storage's arrays to free(). */
static inline bench_table_t *bench_table(const wh_pose_t *wafers, size_t count, bool indexed) {
    bench_table_t *made = calloc(1, sizeof *made);
    const wh_grasp_config_t config = wh_grasp_config_default();
    wh_grasp_storage_t storage = {calloc(count, sizeof *storage.wafers), count, &made->gripper, 1, NULL, 0};
    for (size_t w = 0; w < count; ++w) {
        storage.wafers[w].base_from_wafer = wafers[w];
    }
    if (indexed) {
        storage.bucket_count = wh_grasp_buckets(count, 1);
        storage.buckets = malloc(storage.bucket_count * sizeof *storage.buckets);
    }
    made->list = (wh_event_list_t){made->events, WH_EVENTS_PER_GRIPPER, 0};
    if (wh_grasp_init(&made->table, &config, &storage) != WH_OK) {
        exit(1);
    }
    return made;
}

static inline void bench_table_free(bench_table_t *made) {
    free(made->table.storage.wafers);
    free(made->table.storage.buckets);
    free(made);
}

/* One slice; how many events it had. */
static inline uint64_t bench_table_step(bench_table_t *made, const wh_pose_t *gripper) {
    const wh_gripper_input_t input = {.base_from_gripper = *gripper, .valve = made->valve};
    if (wh_grasp_step(&made->table, &input, &made->list) != WH_OK) {
        exit(1);
    }
    return made->list.count;
}

#endif
