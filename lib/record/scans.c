#include "scans.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "../text/array.h"

/* ------------------------------------------------------------------------------------------- collecting */

static size_t magnitude(int32_t count) {
    return count < 0 ? (size_t) - (int64_t)count : (size_t)count;
}

static void begin_scan(wh_edge_scans_t *scans, int64_t slice, const wh_scan_t *scan) {
    const size_t room = magnitude(scan->count);
    scans->number = scan->number;
    if (scans->left_out > 0 || room > WH_SCANS_SAMPLES - scans->samples) {
        ++scans->left_out;
        return;
    }
    scans->samples += room;
    scans->list = wh_array_grow(scans->list, scans->count, &scans->capacity, sizeof *scans->list);
    scans->list[scans->count++] = (wh_edge_scan_t){.first_slice = slice,
                                                   .last_slice = slice,
                                                   .number = scan->number,
                                                   .gripper = scan->gripper,
                                                   .count = scan->count,
                                                   .first = scan->first,
                                                   .samples = wh_array_new(room, sizeof(int32_t))};
}

static void collect(wh_edge_scan_t *into, int64_t slice, const wh_scan_t *scan) {
    const int32_t begins = scan->taken - scan->sample_count;
    for (; into->taken < begins; ++into->taken) {
        into->samples[into->taken] = WH_NONE;
        ++into->missed;
    }
    for (; into->taken < scan->taken; ++into->taken) {
        into->samples[into->taken] = scan->samples[into->taken - begins];
        into->last_slice = slice;
    }
}

static bool is_sound(const wh_scan_t *scan) {
    return scan->number > 0 && scan->taken >= 0 && (size_t)scan->taken <= magnitude(scan->count) &&
           magnitude(scan->count) <= (size_t)WH_SCAN_TURNS * WH_SENSOR_SAMPLES && scan->sample_count >= 0 &&
           scan->sample_count <= WH_SCAN_SLICE && scan->sample_count <= scan->taken;
}

void wh_edge_scans_hear(wh_edge_scans_t *scans, int64_t slice, const wh_scan_t *scan) {
    if (!is_sound(scan)) {
        return;
    }
    if (scan->number != scans->number) {
        begin_scan(scans, slice, scan);
    }
    wh_edge_scan_t *last = scans->count > 0 ? &scans->list[scans->count - 1] : NULL;
    if (last && last->number == scan->number && last->count == scan->count) {
        collect(last, slice, scan);
    }
}

void wh_edge_scans_close(wh_edge_scans_t *scans) {
    for (size_t i = 0; i < scans->count; ++i) {
        free(scans->list[i].samples);
    }
    free(scans->list);
    memset(scans, 0, sizeof *scans);
}

/* ------------------------------------------------------------------------------------ what was commanded */

wh_edge_wish_t wh_edge_wish_of(const char *command) {
    wh_edge_wish_t wish = {false, 0};
    const char *glass = command ? strstr(command, " glass=") : NULL;
    wish.without_mark = command && strstr(command, " mark=none");
    wish.glass = glass ? strtod(glass + strlen(" glass="), NULL) : 0;
    return wish;
}

wh_edge_wish_t wh_edge_wish_at(const wh_record_t *record, double begin_s) {
    const char *command = NULL;
    for (size_t c = 0; c < record->command_count && record->commands[c].begin_s <= begin_s; ++c) {
        command = record->commands[c].text;
    }
    return wh_edge_wish_of(command);
}

wh_rim_t wh_edge_wish_rim(const wh_rim_t *nominal, wh_edge_wish_t wish) {
    wh_rim_t rim = *nominal;
    rim.transmission = wish.glass;
    if (wish.without_mark) {
        rim.notch.depth = 0;
        memset(rim.flats, 0, sizeof rim.flats);
    }
    return rim;
}

/* ------------------------------------------------------------------------------------------- estimating */

/* Sample `i` of the scan as a point. A missing sample hides the rim there, as an obstacle on the line
 * would. */
static wh_rim_point_t point_of(const wh_edge_scan_t *scan, const wh_sensor_t *sensor, int32_t i) {
    const wh_glance_t glance = {.turn = wh_sensor_angle(sensor, scan->first + (scan->count < 0 ? -i : i))};
    const bool is_here = i < scan->taken && scan->samples[i] != WH_NONE;
    return wh_sensor_point(sensor, NULL, &glance, is_here ? scan->samples[i] : wh_sensor_pixels(sensor));
}

static void read_samples(const wh_edge_scan_t *scan, const wh_sensor_t *sensor, wh_edge_point_t samples[]) {
    for (int32_t i = 0; i < scan->taken; ++i) {
        const wh_rim_point_t point = point_of(scan, sensor, i);
        const double turns = point.angle / (2 * WH_PI);
        samples[i].angle = (turns - floor(turns)) * 2 * WH_PI;
        samples[i].radius = point.sight == WH_SIGHT_RIM ? point.radius : (double)NAN;
    }
}

static void keep_residuals(const wh_edge_scan_t *scan, const wh_rim_scan_t *turn, const wh_rim_ray_t rays[],
                           wh_edge_point_t samples[]) {
    for (size_t i = 0; i < turn->count && i < (size_t)scan->taken; ++i) {
        if (turn->points[i].sight == WH_SIGHT_RIM) {
            samples[i].residual = rays[i].residual;
            samples[i].counts = rays[i].weight > 0;
        }
    }
}

/* Estimates a whole turn, however much of it was seen, so that a notch outside of the seen part is not
 * called missing. */
static wh_status_t estimate(const wh_edge_scan_t *scan, const wh_rim_t *rim, const wh_sensor_t *sensor,
                            wh_edge_point_t samples[], wh_align_result_t *result) {
    const wh_align_limits_t limits = wh_align_limits_default();
    const size_t count = (size_t)sensor->samples;
    wh_rim_point_t *points = wh_array_new(count, sizeof *points);
    wh_rim_ray_t *rays = wh_array_new(count, sizeof *rays);
    const wh_rim_scan_t turn = {points, count, 0, sensor->pixel};
    read_samples(scan, sensor, samples);
    for (size_t i = 0; i < count; ++i) {
        points[i] = point_of(scan, sensor, (int32_t)i);
    }
    const wh_status_t status = wh_align_estimate(&turn, sensor, rim, &limits, rays, result);
    if (status == WH_OK && result->circle.radius > 0) {
        keep_residuals(scan, &turn, rays, samples);
    }
    free(points);
    free(rays);
    return status;
}

wh_status_t wh_edge_scan_estimate(const wh_edge_scan_t *scan, const wh_layout_t *layout, wh_edge_wish_t wish,
                                  wh_edge_point_t samples[], wh_align_result_t *result) {
    const wh_scanner_t *scanner = wh_layout_scanner(layout, scan->gripper);
    const double none = (double)NAN;
    memset(result, 0, sizeof *result);
    for (int32_t i = 0; i < scan->taken; ++i) {
        samples[i] = (wh_edge_point_t){none, none, none, false};
    }
    if (!scanner) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_rim_t rim = wh_edge_wish_rim(layout->nominal_rim, wish);
    return estimate(scan, &rim, &scanner->sensor, samples, result);
}
