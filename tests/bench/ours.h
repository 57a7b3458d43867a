/* Our side of the benches: a grasp table with one open, empty gripper, and a scan of a wafer with
 * its estimate. */
#ifndef WH_TESTS_BENCH_OURS_H
#define WH_TESTS_BENCH_OURS_H

#include "align/align.h"
#include "bench/scene.h"

typedef struct {
    wh_grasp_t table;
    wh_gripper_t gripper;
    wh_event_t events[WH_EVENTS_PER_GRIPPER];
    wh_event_list_t list;
    int valve; /* open, unless changed */
} bench_table_t;

/* With an index, or with the plain loop. The caller frees it, and hands the storage's arrays to free(). */
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

/* One slice; returns the number of its events. */
static inline uint64_t bench_table_step(bench_table_t *made, const wh_pose_t *gripper) {
    const wh_gripper_input_t input = {.base_from_gripper = *gripper, .valve = made->valve};
    if (wh_grasp_step(&made->table, &input, &made->list) != WH_OK) {
        exit(1);
    }
    return made->list.count;
}

/* A scan of a wafer with a notch. */
typedef struct {
    wh_rim_point_t points[3600];
    wh_rim_ray_t rays[3600];
    wh_rim_t rim;
    wh_sensor_t sensor;
} bench_scan_t;

/* 5 mm off the axis, with noise of 5 um. */
static inline void bench_scan_make(bench_scan_t *made) {
    const wh_placement_t placement = {3, -4, 0.7};
    made->rim = wh_rim_nominal(150);
    made->sensor = wh_sensor_nominal(150);
    made->sensor.noise = 0.005;
    for (uint32_t i = 0; i < 3600; ++i) {
        const wh_glance_t glance = {wh_sensor_angle(&made->sensor, i), 6, {1, 2}, i};
        const int32_t dark = wh_sensor_read(&made->sensor, &made->rim, &placement, &glance);
        made->points[i] = wh_sensor_point(&made->sensor, NULL, &glance, dark);
    }
}

/* Its verdict. */
static inline wh_status_t bench_scan_estimate(bench_scan_t *made) {
    const wh_rim_scan_t scan = {made->points, 3600, 0, made->sensor.pixel};
    const wh_align_limits_t limits = wh_align_limits_default();
    wh_align_result_t result;
    const wh_status_t status =
        wh_align_estimate(&scan, &made->sensor, &made->rim, &limits, made->rays, &result);
    return status == WH_OK ? result.verdict : status;
}

#endif
