/* A record's centrings on the way, as JSON. */
#include <math.h>

#include "../math/trig.h"
#include "../record/centring_words.h"
#include "../record/throughput.h"
#include "../text/json.h"
#include "record_print.h"

typedef struct {
    const wh_record_t *record;
    const wh_centring_record_t *centring;
} subject_t;

static json_t *crossing(const void *given, size_t k) {
    const subject_t *subject = given;
    const wh_pass_crossing_t *from = &subject->centring->crossings[k];
    const wh_layout_t *layout = subject->record->layout;
    const wh_latch_order_t order = wh_layout_beams_at(layout, (size_t)subject->centring->station);
    return wh_json_set(
        json_object(), "beam %d edge %s use %s x %g y %g time %g", from->crossing.beam - order.first + 1,
        from->crossing.edge == WH_CROSSING_IN ? "in" : "out", wh_centring_use(subject->centring, 0, k),
        from->crossing.x, from->crossing.y, from->time);
}

static json_t *residuals(const wh_centring_record_t *centring, int32_t i) {
    json_t *list = json_array();
    for (size_t k = 0; k < centring->count; ++k) {
        wh_json_append(list, wh_json_real(1000 * wh_centring_residual(centring, i, k)));
    }
    return list;
}

static json_t *uses(const wh_centring_record_t *centring, int32_t i) {
    json_t *list = json_array();
    for (size_t k = 0; k < centring->count; ++k) {
        wh_json_append(list, wh_json_text(wh_centring_use(centring, i, k)));
    }
    return list;
}

static json_t *candidate(const void *given, size_t i) {
    const subject_t *subject = given;
    const wh_centre_t *from = &subject->centring->centres.candidates[i];
    const wh_centring_offset_t offset = wh_centring_offset(subject->centring, (int32_t)i);
    json_t *object = wh_json_set(
        json_object(), "x %g y %g dx %g dy %g radius %g sd_dx %g sd_dy %g sd %g mismatch %g used %d", from->x,
        from->y, offset.dx, offset.dy, from->radius, offset.sd_dx, offset.sd_dy, from->sd_centre,
        from->mismatch, from->used);
    return wh_json_add(object, "uses residuals_um", uses(subject->centring, (int32_t)i),
                       residuals(subject->centring, (int32_t)i), NULL);
}

static json_t *line(const void *given, size_t i) {
    return wh_json_text(((const wh_centring_words_t *)given)->lines[i]);
}

static json_t *known(const wh_centring_record_t *centring) {
    const wh_centring_t *from = &centring->known;
    const bool has_notch = from->notch_width > 0;
    json_t *object = wh_json_set(json_object(), "radius %g sd_radius %g", from->radius, from->sd_radius);
    return wh_json_set(object, "notch_deg %g sd_notch_deg %g",
                       has_notch && from->notch_known ? wh_deg_from_rad(from->notch_direction) : HUGE_VAL,
                       has_notch && from->notch_known ? wh_deg_from_rad(from->sd_notch) : HUGE_VAL);
}

json_t *wh_centring_to_json(const void *given, size_t i) {
    const wh_record_t *record = given;
    const wh_centring_record_t *from = &record->centrings[i];
    const subject_t subject = {record, from};
    wh_centring_words_t words;
    wh_centring_words(record, from, &words);
    json_t *object = wh_json_set(
        json_object(), "at_s %g command %lld station %s gripper %s wafer %s error %d sure %i",
        wh_throughput_seconds(record, from->slice),
        from->command != WH_NONE ? (json_int_t)from->command : WH_JSON_NONE,
        wh_record_station_name(record, from->station), wh_record_gripper_name(record, from->gripper),
        wh_record_wafer_name(record, from->wafer), (int)words.verdict, words.is_sure);
    if (from->repeated) { /* the data that motion control used is not in the log */
        (void)wh_json_add(object, "error sure", json_null(), json_null(), NULL);
    }
    (void)wh_json_set(object, "missed %lld skipped %i repeated %i lacking %lld", (json_int_t)from->missed,
                      from->skipped, from->repeated, (json_int_t)from->lacking);
    return wh_json_add(object, "known crossings candidates words", known(from),
                       wh_json_list(crossing, &subject, from->count),
                       wh_json_list(candidate, &subject, (size_t)from->centres.count),
                       wh_json_list(line, &words, WH_CENTRING_LINES), NULL);
}
