/* Circle, marks, verdict. */
#include "align.h"

#include <string.h>

#include "angle_internal.h"

/* With this number of samples whose rim is beyond the line's ends it is no chance. */
#define BEYOND 5

wh_align_limits_t wh_align_limits_default(void) {
    const wh_align_limits_t limits = {13, 0.5, 0.002, 0.008 * WH_ALIGN_PI / 180};
    return limits;
}

static wh_status_t check(const wh_sensor_t *sensor, const wh_rim_t *nominal,
                         const wh_align_limits_t *limits) {
    const double each[4] = {limits->eccentricity, limits->radius_off, limits->sd_centre, limits->sd_turn};
    for (size_t i = 0; i < 4; ++i) {
        if (!wh_align_is_finite(each[i])) {
            return WH_STATUS_NOT_FINITE;
        }
        if (!(each[i] > 0)) {
            return WH_STATUS_OUT_OF_RANGE;
        }
    }
    const wh_status_t status = wh_sensor_validate(sensor, NULL);
    return status == WH_OK ? wh_rim_validate(nominal, NULL) : status;
}

/* Counts samples that do not see the rim though nothing hides it, because the circle leaves the line
 * there. */
static bool is_off_sensor(const wh_rim_scan_t *scan, const wh_sensor_t *sensor, const wh_rim_ray_t *rays,
                          const wh_circle_t *circle) {
    size_t beyond = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        if (scan->points[i].sight != WH_SIGHT_RIM) {
            const double rho = wh_circle_radius(circle, scan->offset, rays[i].cosine, rays[i].sine);
            beyond += fabs(rho - sensor->middle) > sensor->length / 2 ? 1 : 0;
        }
    }
    return beyond > BEYOND;
}

static void describe(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, wh_align_result_t *result) {
    const wh_circle_t *circle = &result->circle;
    result->eccentricity = sqrt(circle->x * circle->x + circle->y * circle->y);
    result->direction = wh_align_atan2(circle->y, circle->x);
    result->hidden = scan->count - circle->seen;
    result->masked = circle->seen - circle->used;
    double squares = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        squares += rays[i].weight > 0 ? rays[i].residual * rays[i].residual : 0;
    }
    result->rms = sqrt(squares / (double)circle->used);
}

static wh_status_t judge_centre(const wh_align_result_t *result, const wh_rim_t *nominal,
                                const wh_align_limits_t *limits) {
    const bool is_its_size = fabs(result->circle.radius - nominal->radius) <= limits->radius_off;
    if (!is_its_size || !(result->circle.sd_centre <= limits->sd_centre)) {
        return WH_STATUS_CENTRE_NOT_SURE;
    }
    return result->eccentricity <= limits->eccentricity ? WH_OK : WH_STATUS_TOO_ECCENTRIC;
}

static void turn_by(wh_align_result_t *result, wh_align_mark_t mark, double direction, double nominal,
                    double sd) {
    result->mark = mark;
    result->turn = wh_align_wrap(direction - nominal);
    result->sd_turn = sd;
}

static wh_status_t find_marks(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_rim_t *nominal,
                              wh_align_result_t *result) {
    const wh_flat_shape_t *shapes = nominal->flats;
    if (nominal->notch.depth > 0) {
        const wh_status_t status =
            wh_notch_find(scan, rays, &result->circle, &nominal->notch, nominal->transmission > 0,
                          &result->notch, &result->notch_seen);
        if (status == WH_OK) {
            turn_by(result, WH_ALIGN_MARK_NOTCH, result->notch.direction, nominal->notch.direction,
                    result->notch.sd_direction);
        }
        return status;
    }
    if (shapes[0].length == 0 && shapes[1].length == 0) {
        return WH_OK;
    }
    const wh_status_t status = wh_flats_find(scan, rays, &result->circle, shapes, result->flats);
    if (status == WH_OK) {
        const size_t f = result->flats[0].length > 0 ? (size_t)0 : (size_t)1;
        turn_by(result, f == 0 ? WH_ALIGN_MARK_PRIMARY_FLAT : WH_ALIGN_MARK_SECONDARY_FLAT,
                result->flats[f].direction, shapes[f].direction, result->flats[f].sd_direction);
    }
    return status;
}

static wh_status_t judge(const wh_rim_scan_t *scan, const wh_sensor_t *sensor, const wh_rim_t *nominal,
                         const wh_align_limits_t *limits, const wh_rim_ray_t *rays,
                         wh_align_result_t *result) {
    if (is_off_sensor(scan, sensor, rays, &result->circle)) {
        return WH_STATUS_OFF_SENSOR;
    }
    const wh_status_t centre = judge_centre(result, nominal, limits);
    if (centre != WH_OK) {
        return centre;
    }
    const wh_status_t mark = find_marks(scan, rays, nominal, result);
    if (mark != WH_OK) {
        return mark;
    }
    return result->sd_turn <= limits->sd_turn ? WH_OK : WH_STATUS_NOTCH_NOT_SURE;
}

wh_status_t wh_align_estimate(const wh_rim_scan_t *scan, const wh_sensor_t *sensor, const wh_rim_t *nominal,
                              const wh_align_limits_t *limits, wh_rim_ray_t *rays,
                              wh_align_result_t *result) {
    if (sensor == NULL || nominal == NULL || limits == NULL || result == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = check(sensor, nominal, limits);
    if (status != WH_OK) {
        return status;
    }
    wh_align_result_t found;
    (void)memset(&found, 0, sizeof found);
    status = wh_circle_fit(scan, rays, &found.circle);
    if (status == WH_OK) {
        describe(scan, rays, &found);
        found.verdict = judge(scan, sensor, nominal, limits, rays, &found);
    } else if (status == WH_STATUS_CENTRE_NOT_SURE) {
        found.verdict = status;
    } else {
        return status;
    }
    *result = found;
    return WH_OK;
}
