/* The estimate of a scan, in words. */
#include <math.h>
#include <stdio.h>

#include "../math/trig.h"
#include "record.h"
#include "scans.h"

/* Standard deviations in um and degrees have this precision, and a least value, because none is 0. */
#define LEAST_UM 0.01
#define LEAST_DEG 1e-4

enum { VERDICT, CENTRE, MARK, RADIUS, SAMPLES };

static double um_of(double mm) {
    return fmax(1000 * mm, LEAST_UM);
}

/* Converts to 0 to 360 degrees, with 0 for a value that would print as 360. */
static double degrees_of(double rad) {
    const double turned = wh_deg_from_rad(rad) / 360;
    const double degrees = (turned - floor(turned)) * 360;
    return degrees < 359.99995 ? degrees : 0;
}

static bool is_not_sure(wh_status_t verdict) {
    return verdict == WH_STATUS_CENTRE_NOT_SURE || verdict == WH_STATUS_NOTCH_NOT_SURE;
}

/* True if the centre may be used, even if the turn may not. */
static bool is_centre_sure(wh_status_t verdict) {
    return verdict != WH_STATUS_OFF_SENSOR && verdict != WH_STATUS_CENTRE_NOT_SURE;
}

static void put_verdict(char *line, wh_status_t status, wh_status_t verdict) {
    const wh_status_t why = status != WH_OK ? status : verdict;
    const char *how = status != WH_OK ? "no estimate" : is_not_sure(verdict) ? "not sure" : "not to be used";
    if (why == WH_OK) {
        (void)snprintf(line, WH_SCAN_LINE_BYTES, "sure");
    } else {
        (void)snprintf(line, WH_SCAN_LINE_BYTES, "%s: %s (%d %s)", how, wh_record_error_text(why), (int)why,
                       wh_status_name(why));
    }
}

static void put_centre(char *line, const wh_align_result_t *result) {
    const wh_circle_t *circle = &result->circle;
    if (!(circle->radius > 0)) {
        (void)snprintf(line, WH_SCAN_LINE_BYTES, "centre: not told");
        return;
    }
    (void)snprintf(line, WH_SCAN_LINE_BYTES,
                   "centre%s: %.4f mm off the axis, towards %.3f\u00b0 (x %.4f, y %.4f mm), standard "
                   "deviation %.2f \u00b5m",
                   is_centre_sure(result->verdict) ? "" : ", not sure", result->eccentricity,
                   degrees_of(result->direction), circle->x, circle->y, um_of(circle->sd_centre));
}

static void put_mark(char *line, const wh_align_result_t *result) {
    const char *sure = result->verdict == WH_OK ? "" : ", not sure";
    const double sd = fmax(wh_deg_from_rad(result->sd_turn), LEAST_DEG);
    if (result->mark == WH_ALIGN_MARK_NONE) {
        (void)snprintf(line, WH_SCAN_LINE_BYTES, "notch or flat: %s",
                       result->verdict == WH_OK ? "not looked for" : "not told");
    } else if (result->mark == WH_ALIGN_MARK_NOTCH) {
        (void)snprintf(line, WH_SCAN_LINE_BYTES,
                       "notch%s: towards %.4f\u00b0, standard deviation %.4f\u00b0, %.3f mm deep", sure,
                       degrees_of(result->notch.direction), sd, result->notch.depth);
    } else {
        const bool is_first = result->mark == WH_ALIGN_MARK_PRIMARY_FLAT;
        const wh_flat_t *flat = &result->flats[is_first ? 0 : 1];
        (void)snprintf(line, WH_SCAN_LINE_BYTES,
                       "%s flat%s: towards %.4f\u00b0, standard deviation %.4f\u00b0, %.2f mm long",
                       is_first ? "primary" : "secondary", sure, degrees_of(flat->direction), sd,
                       flat->length);
    }
}

static void put_radius(char *line, const wh_circle_t *circle) {
    if (circle->radius > 0) {
        (void)snprintf(line, WH_SCAN_LINE_BYTES, "radius: %.4f mm, standard deviation %.2f \u00b5m",
                       circle->radius, um_of(circle->sd_radius));
    } else {
        (void)snprintf(line, WH_SCAN_LINE_BYTES, "radius: not told");
    }
}

static void put_samples(char *line, const wh_edge_scan_t *scan, const wh_align_result_t *result) {
    const int64_t ordered = scan->count < 0 ? -(int64_t)scan->count : scan->count;
    const int length = snprintf(line, WH_SCAN_LINE_BYTES, "samples: %d of %lld taken, %d of them missing",
                                (int)scan->taken, (long long)ordered, (int)scan->missed);
    if (result->circle.radius > 0) {
        (void)snprintf(line + length, (size_t)(WH_SCAN_LINE_BYTES - length),
                       "; %zu count, %zu are masked, the rim is not seen by %zu of the turn's; residuals "
                       "%.2f \u00b5m rms",
                       result->circle.used, result->masked, result->hidden, 1000 * result->rms);
    }
}

void wh_edge_scan_words(const wh_edge_scan_t *scan, wh_status_t status, const wh_align_result_t *result,
                        wh_scan_words_t *words) {
    words->is_sure = status == WH_OK && result->verdict == WH_OK;
    put_verdict(words->lines[VERDICT], status, result->verdict);
    put_centre(words->lines[CENTRE], result);
    put_mark(words->lines[MARK], result);
    put_radius(words->lines[RADIUS], &result->circle);
    put_samples(words->lines[SAMPLES], scan, result);
}

/* The mark lies on the wafer; the axis sees it at another angle than the wafer's centre does. */
double wh_edge_scan_mark_at(const wh_align_result_t *result) {
    if (result->mark == WH_ALIGN_MARK_NONE) {
        return (double)NAN;
    }
    const bool is_notch = result->mark == WH_ALIGN_MARK_NOTCH;
    const wh_flat_t *flat = &result->flats[result->mark == WH_ALIGN_MARK_PRIMARY_FLAT ? 0 : 1];
    const double radius = result->circle.radius;
    const double half = flat->length / 2;
    const double from_centre = is_notch ? radius - result->notch.depth : sqrt(radius * radius - half * half);
    const double direction = is_notch ? result->notch.direction : flat->direction;
    const double at = wh_atan2(result->circle.y + from_centre * wh_sin(direction),
                               result->circle.x + from_centre * wh_cos(direction));
    return at < 0 ? at + 2 * WH_PI : at;
}
