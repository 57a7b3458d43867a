#include "study_causes.h"

#include <math.h>
#include <stdlib.h>

#include "../text/array.h"
#include "../text/json.h"

static double strength_of(const wh_correlation_t *found) {
    return found->determined ? fabs(found->r) : -1;
}

/* The wafers that draws are related with; a flow is not among them. */
static size_t count_wafers(const wh_tally_t *tally) {
    const size_t all = tally->relations.wafer_count;
    return tally->flow_at < all ? tally->flow_at : all;
}

static void find_end(const wh_study_result_t *result, wh_cause_told_t *told) {
    const wh_tally_t *tally = result->tally;
    for (size_t w = 0; w < count_wafers(tally); ++w) {
        for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
            const wh_correlation_t end =
                wh_relations_end(&tally->relations, told->index, w, q, &tally->wafers[w].of[q]);
            if (strength_of(&end) > strength_of(&told->end)) {
                told->end = end;
                told->wafer = w;
                told->quantity = q;
            }
        }
    }
    for (size_t f = 0; f < WH_FLOW_SUM_RELATED; ++f) {
        const wh_correlation_t end = wh_tally_relate(tally, told->index, (wh_flow_sum_t)f);
        if (strength_of(&end) > strength_of(&told->end)) {
            told->end = end;
            told->is_flow = true;
            told->quantity = f;
        }
    }
}

static wh_cause_told_t look(const wh_study_result_t *result, size_t i) {
    const wh_tally_t *tally = result->tally;
    const uint64_t failed = tally->trials - tally->met;
    wh_cause_told_t told = {.cause = &result->study->causes[i], .index = i};
    if (tally->relations.cause_count > i) {
        told.by_size = wh_relations_failing(&tally->relations, i, true, tally->trials, failed);
        if (wh_cause_has_sign(told.cause)) {
            told.by_value = wh_relations_failing(&tally->relations, i, false, tally->trials, failed);
        }
        find_end(result, &told);
    }
    return told;
}

static int compare_doubles(double one, double other) {
    return (one < other) - (one > other);
}

static int compare(const void *a, const void *b) {
    const wh_cause_told_t *one = a;
    const wh_cause_told_t *other = b;
    const int failing = compare_doubles(fmax(strength_of(&one->by_size), strength_of(&one->by_value)),
                                        fmax(strength_of(&other->by_size), strength_of(&other->by_value)));
    const int ends = compare_doubles(strength_of(&one->end), strength_of(&other->end));
    return failing != 0 ? failing
           : ends != 0  ? ends
                        : (one->index > other->index) - (one->index < other->index);
}

wh_cause_told_t *wh_causes_told(const wh_study_result_t *result) {
    const size_t count = result->study->cause_count;
    wh_cause_told_t *told = wh_array_new(count, sizeof *told);
    for (size_t i = 0; i < count; ++i) {
        told[i] = look(result, i);
    }
    qsort(told, count, sizeof *told, compare);
    return told;
}

void wh_cause_name(const wh_cause_t *cause, const wh_layout_t *layout, char name[WH_CAUSE_NAME]) {
    const char *of = wh_cause_of(cause, layout);
    const char *robot = wh_cause_robot(cause, layout);
    char what[20];
    wh_text_words(what, sizeof what, wh_cause_what(cause));
    const char *unit = wh_cause_unit(cause);
    (void)snprintf(name, WH_CAUSE_NAME, "%s%s%s%s%s%s%s", robot ? robot : "", robot ? " at " : "",
                   of ? of : "", of ? " " : "", what, *unit ? " " : "", unit);
}

/* --------------------------------------------------------------------------------------------------- JSON */

static json_t *correlation(const wh_correlation_t *found) {
    return found->determined
               ? wh_json_set(json_object(), "r %g low %g high %g", found->r, found->low, found->high)
               : json_null();
}

typedef struct {
    const wh_study_result_t *result;
    const wh_cause_told_t *told;
} subject_t;

static json_t *end(const void *subject, size_t w) {
    static const char *const keys[WH_TALLY_QUANTITIES] = {"dx", "dy", "dz", "tilt_deg", "off"};
    const subject_t *of = subject;
    const wh_study_t *study = of->result->study;
    const wh_tally_t *tally = of->result->tally;
    json_t *object =
        wh_json_set(json_object(), "wafer %s", study->layout->wafers[study->wafers[w].wafer].name);
    for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
        const wh_correlation_t found =
            wh_relations_end(&tally->relations, of->told->index, w, q, &tally->wafers[w].of[q]);
        wh_json_put(object, keys[q], correlation(&found));
    }
    return object;
}

static json_t *flow_ends(const wh_tally_t *tally, size_t cause) {
    json_t *object = json_object();
    for (size_t f = 0; f < WH_FLOW_SUM_RELATED; ++f) {
        const wh_correlation_t found = wh_tally_relate(tally, cause, (wh_flow_sum_t)f);
        wh_json_put(object, wh_flow_sum_names[f], correlation(&found));
    }
    return object;
}

static json_t *drawn(const void *subject, size_t i) {
    const subject_t *of = subject;
    const wh_cause_told_t *told = &of->told[i];
    const wh_cause_t *cause = told->cause;
    static const char *const kinds[] = {"wafer", "station", "gripper",  "vacuum", "rim",
                                        "beam",  "process", "debounce", "port"};
    const subject_t one = {of->result, told};
    json_t *object = wh_json_set(json_object(), "kind %s of %s what %s unit %s width %g", kinds[cause->kind],
                                 wh_cause_of(cause, of->result->study->layout), wh_cause_what(cause),
                                 wh_cause_unit(cause), cause->width);
    const char *robot = wh_cause_robot(cause, of->result->study->layout);
    if (robot) {
        wh_json_put(object, "robot", json_string(robot));
    }
    json_t *failing = wh_json_add(json_object(), "by_size by_value", correlation(&told->by_size),
                                  correlation(&told->by_value), NULL);
    (void)wh_json_add(object, "failing ends", failing,
                      wh_json_list(end, &one, count_wafers(of->result->tally)), NULL);
    if (of->result->tally->flow) {
        wh_json_put(object, "flow", flow_ends(of->result->tally, told->index));
    }
    return object;
}

json_t *wh_causes_to_json(const wh_study_result_t *result) {
    wh_cause_told_t *told = wh_causes_told(result);
    const subject_t subject = {result, told};
    json_t *list = wh_json_list(drawn, &subject, result->study->cause_count);
    free(told);
    return list;
}
