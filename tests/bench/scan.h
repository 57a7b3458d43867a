/* A scan of a wafer with a notch, and its estimate, as the benches take them. */
#ifndef WH_TESTS_BENCH_SCAN_H
#define WH_TESTS_BENCH_SCAN_H

#include "align/align.h"

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
