#include "sensing.h"

#include "angle_internal.h"
#include "check_internal.h"

/* Names of the random numbers for a sample. */
#define DRAW_NOISE UINT32_C(0x534E0001)
#define DRAW_GLASS UINT32_C(0x534E0002)
#define DRAW_DEPTH UINT32_C(0x534E0003)

wh_sensor_t wh_sensor_nominal(double wafer_radius) {
    const wh_sensor_t sensor = {.middle = wafer_radius, .length = 28, .pixel = 0.007, .samples = 3600};
    return sensor;
}

wh_status_t wh_sensor_validate(const wh_sensor_t *sensor, wh_bad_field_t *bad) {
    if (sensor == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_field_check_t found = wh_field_check_begin();
    const double middle = sensor->middle;
    wh_field_check(&found, "direction", WH_NONE, sensor->direction, -WH_ALIGN_TURN, WH_ALIGN_TURN);
    wh_field_check(&found, "middle", WH_NONE, middle, 10, 300);
    wh_field_check(&found, "length", WH_NONE, sensor->length, 2, 2 * middle < 100 ? 2 * middle : 100);
    wh_field_check(&found, "pixel", WH_NONE, sensor->pixel, 0.001, 0.1);
    wh_field_check(&found, "samples", WH_NONE, sensor->samples, 90, WH_SENSOR_SAMPLES);
    wh_field_check(&found, "encoder", WH_NONE, sensor->encoder, sensor->encoder == 0 ? 0 : sensor->samples,
                   1e7);
    wh_field_check(&found, "noise", WH_NONE, sensor->noise, 0, 0.1);
    wh_field_check(&found, "tilt", WH_NONE, sensor->tilt, -0.5, 0.5);
    wh_field_check(&found, "error.offset", WH_NONE, sensor->error.offset, -1, 1);
    wh_field_check(&found, "error.zero", WH_NONE, sensor->error.zero, -1, 1);
    wh_field_check(&found, "error.gain", WH_NONE, sensor->error.gain, -0.01, 0.01);
    wh_field_check(&found, "error.latency", WH_NONE, sensor->error.latency, -0.001, 0.001);
    wh_field_check(&found, "hidden_count", WH_NONE, sensor->hidden_count, 0, WH_SENSOR_ARCS);
    for (int32_t i = 0; found.status == WH_OK && i < sensor->hidden_count; ++i) {
        wh_field_check(&found, "hidden.from", i, sensor->hidden[i].from, -WH_ALIGN_TURN, WH_ALIGN_TURN);
        wh_field_check(&found, "hidden.width", i, sensor->hidden[i].width, 1e-6, WH_ALIGN_TURN);
    }
    return wh_field_check_end(&found, bad);
}

int32_t wh_sensor_pixels(const wh_sensor_t *sensor) {
    return (int32_t)wh_align_nearest(sensor->length / sensor->pixel);
}

/* The whole number at or above x / y, for y above 0. */
static int64_t divide_up(int64_t x, int64_t y) {
    return x / y + (x % y > 0 ? 1 : 0);
}

double wh_sensor_angle(const wh_sensor_t *sensor, int64_t k) {
    if (sensor->encoder == 0) {
        return (double)k * (WH_ALIGN_TURN / sensor->samples);
    }
    return (double)divide_up(k * sensor->encoder, sensor->samples) * (WH_ALIGN_TURN / sensor->encoder);
}

/* The first sample that is due at this turn or after it. */
static int64_t first_from(const wh_sensor_t *sensor, double turn, bool after) {
    int64_t k = (int64_t)wh_align_nearest(turn * (sensor->samples / WH_ALIGN_TURN)) - 2;
    while (wh_sensor_angle(sensor, k) < turn || (after && wh_sensor_angle(sensor, k) <= turn)) {
        ++k;
    }
    return k;
}

size_t wh_sensor_due(const wh_sensor_t *sensor, double from, double to, int64_t *first) {
    const bool up = to >= from;
    /* Up: above `from`, up to `to`. Down: below `from` to `to`. */
    const int64_t low = first_from(sensor, up ? from : to, up);
    const int64_t end = first_from(sensor, up ? to : from, up);
    if (end <= low) {
        return 0;
    }
    *first = up ? low : end - 1;
    const int64_t due = end - low;
    return (size_t)due;
}

static bool is_hidden(const wh_sensor_t *sensor, double look) {
    for (int32_t i = 0; i < sensor->hidden_count; ++i) {
        const wh_arc_t *arc = &sensor->hidden[i];
        if (fabs(wh_align_wrap(look - arc->from - arc->width / 2)) <= arc->width / 2) {
            return true;
        }
    }
    return false;
}

/* The place where the wafer ends on the line, from the line's inner end. */
static double dark_length(const wh_sensor_t *sensor, const wh_rim_t *rim, const wh_placement_t *placement,
                          double look) {
    const double inner = sensor->middle - sensor->length / 2 + sensor->error.zero;
    double distance = wh_rim_distance(rim, placement, sensor->error.offset, look);
    if (sensor->tilt != 0 && (rim->bow != 0 || rim->saddle != 0)) {
        double s;
        double c;
        wh_align_sin_cos(sensor->tilt, &s, &c);
        distance += wh_rim_height(rim, look - placement->turn) * s / c;
    }
    return distance - inner;
}

static double disturbed(const wh_sensor_t *sensor, const wh_rim_t *rim, const wh_glance_t *glance,
                        double dark) {
    const double light = rim->transmission;
    if (light > 0 && wh_deviate_uniform(&glance->trial, DRAW_GLASS, glance->index) < light / 20) {
        return dark * wh_deviate_uniform(&glance->trial, DRAW_DEPTH, glance->index);
    }
    if (sensor->noise > 0) {
        dark += sensor->noise / (1 - light) * wh_deviate_normal(&glance->trial, DRAW_NOISE, glance->index);
    }
    return dark;
}

int32_t wh_sensor_read(const wh_sensor_t *sensor, const wh_rim_t *rim, const wh_placement_t *placement,
                       const wh_glance_t *glance) {
    const int32_t pixels = wh_sensor_pixels(sensor);
    const double look = sensor->direction - (glance->turn + glance->speed * sensor->error.latency);
    if (is_hidden(sensor, look)) {
        return pixels;
    }
    const double dark = disturbed(sensor, rim, glance, dark_length(sensor, rim, placement, look));
    const double count = dark / (sensor->pixel * (1 + sensor->error.gain));
    if (!(count >= 0)) {
        return 0;
    }
    return count < pixels ? (int32_t)count : pixels;
}

wh_rim_point_t wh_sensor_point(const wh_sensor_t *sensor, const wh_sensor_error_t *believed,
                               const wh_glance_t *glance, int32_t sample) {
    static const wh_sensor_error_t none;
    const wh_sensor_error_t *error = believed == NULL ? &none : believed;
    wh_rim_point_t point;
    point.angle = sensor->direction - (glance->turn + glance->speed * error->latency);
    point.sight = sample <= 0                          ? WH_SIGHT_NOTHING
                  : sample >= wh_sensor_pixels(sensor) ? WH_SIGHT_COVERED
                                                       : WH_SIGHT_RIM;
    /* A sample counts whole pixels, so on average the rim is half a pixel further out. */
    point.radius = sensor->middle - sensor->length / 2 + error->zero +
                   (sample + 0.5) * sensor->pixel * (1 + error->gain);
    return point;
}
