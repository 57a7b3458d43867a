#include "centrings.h"

#include <math.h>
#include <string.h>

/* The least error of a latch's time and of a wafer's place, s and mm. */
#define LEAST_SD_TIME 1e-6
#define BEYOND_CORRECTIONS 5
/* Two places of a wafer this near to each other count as one, mm. */
#define AGREE 0.02
/* The shortest way that gives a direction, mm. */
#define LEAST_WAY 1

/* It does not use hypot, whose last bit differs between systems. */
static double length_of(double x, double y) {
    return sqrt(x * x + y * y);
}

/* ----------------------------------------------------------------------------------------------- estimate */

wh_centring_t wh_centring_known(const wh_layout_t *layout, const wh_latch_order_t *order, double radius) {
    wh_centring_t known = wh_centring_nominal(radius);
    known.sd_radius = layout->wafer_spread / 2;
    const double far = length_of(layout->corrections.x, layout->corrections.y) + BEYOND_CORRECTIONS;
    known.reach = far < known.radius / 3 ? far : known.radius / 3;
    known.sd_time = LEAST_SD_TIME;
    known.agree = AGREE;
    for (int32_t b = order->first; b < order->first + order->count; ++b) {
        const double jitter = layout->doors[b].jitter;
        known.sd_time = jitter > known.sd_time ? jitter : known.sd_time;
        /* Both crossings of a beam share one error; it is modelled as a larger error for each. */
        const double place = M_SQRT2 * layout->beams[b].sd;
        known.sd_place = place > known.sd_place ? place : known.sd_place;
    }
    if (!(layout->nominal_rim->notch.depth > 0)) {
        known.notch_width = 0;
    }
    return known;
}

static void find_slot(const wh_pass_t *pass, double slot_from_blade[2][2]) {
    const double none = (double)NAN;
    const wh_pose_t *last = pass->place_count > 0 ? &pass->places[pass->place_count - 1] : NULL;
    const wh_vec3_t way = last ? wh_vec3_subtract(&last->r, &pass->places[0].r) : wh_vec3(0, 0, 0);
    const double length = length_of(way.x, way.y);
    for (size_t axis = 0; axis < 2; ++axis) {
        slot_from_blade[0][axis] = slot_from_blade[1][axis] = none;
        if (last && length > LEAST_WAY) {
            const wh_vec3_t in_base = wh_mat3_column(&last->R, axis);
            slot_from_blade[0][axis] = (in_base.x * way.x + in_base.y * way.y) / length;
            slot_from_blade[1][axis] = (in_base.y * way.x - in_base.x * way.y) / length;
        }
    }
}

static wh_status_t solve(wh_centring_record_t *centring) {
    wh_crossing_t crossings[WH_CROSSINGS];
    for (size_t i = 0; i < centring->count; ++i) {
        crossings[i] = centring->crossings[i].crossing;
    }
    if (centring->skipped || centring->missed > 0) {
        return WH_STATUS_TOO_FEW_SAMPLES;
    }
    return wh_centring_solve(&centring->known, crossings, centring->count, &centring->centres);
}

void wh_centring_estimate(const wh_pass_t *pass, const wh_layout_t *layout, const wh_centring_t *known,
                          wh_centring_record_t *centring) {
    memset(centring, 0, sizeof *centring);
    centring->slice = pass->seq;
    centring->station = pass->station;
    centring->gripper = pass->gripper;
    centring->command = centring->wafer = WH_NONE;
    centring->known = *known;
    centring->skipped = pass->skipped;
    centring->count = wh_pass_crossings(pass, layout, centring->crossings, &centring->missed);
    centring->status = solve(centring);
    find_slot(pass, centring->slot_from_blade);
}

/* ------------------------------------------------------------------------------------------------ reading */

wh_centring_offset_t wh_centring_offset(const wh_centring_record_t *centring, int32_t i) {
    const double none = (double)NAN;
    if (!wh_is_index(i, (size_t)centring->centres.count)) {
        return (wh_centring_offset_t){none, none, none, none};
    }
    const wh_centre_t *centre = &centring->centres.candidates[i];
    const double(*m)[2] = centring->slot_from_blade;
    return (wh_centring_offset_t){m[0][0] * centre->x + m[0][1] * centre->y,
                                  m[1][0] * centre->x + m[1][1] * centre->y,
                                  length_of(m[0][0] * centre->sd_x, m[0][1] * centre->sd_y),
                                  length_of(m[1][0] * centre->sd_x, m[1][1] * centre->sd_y)};
}

double wh_centring_residual(const wh_centring_record_t *centring, int32_t i, size_t k) {
    if (!wh_is_index(i, (size_t)centring->centres.count)) {
        return (double)NAN;
    }
    const wh_crossing_t *crossing = &centring->crossings[k].crossing;
    const wh_centre_t *centre = &centring->centres.candidates[i];
    return length_of(crossing->x - centre->x, crossing->y - centre->y) - centre->radius;
}

const char *wh_centring_use(const wh_centring_record_t *centring, int32_t i, size_t k) {
    static const char *const uses[] = {"rim", "notch", "other"};
    const bool is_there = wh_is_index(i, (size_t)centring->centres.count);
    return is_there ? uses[centring->centres.candidates[i].use[k]] : "none";
}
