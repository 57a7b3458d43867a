#include "study_document.h"

#include <math.h>

#include "../math/config.h"
#include "../math/trig.h"
#include "../study/lines.h"
#include "../text/json.h"

/* The number of bars of a histogram. */
#define BARS 40

/* The most points of a cloud; more trials would only cover each other. */
#define MOST_POINTS 5000

/* A histogram of the sums, which are `scale` times as large beside the nominal value, from the smallest to
 * the largest one. A single value gets room around it. */
static json_t *histogram(const wh_sum_t *sum, double nominal, double scale) {
    double counts[BARS];
    const double low = wh_sum_least(sum);
    const double high = wh_sum_most(sum);
    const double room = high > low ? 0 : 1e-6;
    if (sum->count == 0) {
        return json_null();
    }
    wh_sum_histogram(sum, low - room, high + room, counts, BARS);
    json_t *list = json_array();
    for (size_t i = 0; i < BARS; ++i) {
        wh_json_append(list, wh_json_real(floor(10 * counts[i] + 0.5) / 10));
    }
    json_t *object =
        wh_json_set(json_object(), "low %g high %g", nominal + scale * low, nominal + scale * high);
    return wh_json_add(object, "counts", list, NULL);
}

/* The box that the script expects the wafer in; null if the claim is about another wafer or place. */
static json_t *limit(const wh_study_wafer_t *wafer, const wh_decisions_claim_t *claim) {
    const bool is_its = claim->wafer == wafer->wafer && claim->station == wafer->place.station &&
                        claim->slot == wafer->place.slot;
    return is_its ? wh_json_set(json_object(), "dx %g dy %g tolerance %g", claim->dx, claim->dy,
                                claim->tolerance)
                  : NULL;
}

static json_t *wafer(const void *subject, size_t w) {
    static const char *const keys[WH_TALLY_QUANTITIES] = {"dx", "dy", "dz", "tilt_deg", "off"};
    const wh_study_document_t *document = subject;
    const wh_study_wafer_t *end = &document->study->wafers[w];
    const wh_decisions_t *decisions = &document->study->decisions;
    const wh_place_t *place = &end->place;
    const double nominal[WH_TALLY_QUANTITIES] = {place->dx, place->dy, place->dz,
                                                 wh_deg_from_rad(place->tilt), 0};
    json_t *histograms = json_object();
    json_t *limits = json_array();
    for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
        wh_json_put(histograms, keys[q], histogram(&document->tally->wafers[w].of[q], nominal[q], 1));
    }
    for (size_t i = 0; i < decisions->claim_count; ++i) {
        json_t *made = limit(end, &decisions->claims[i]);
        if (made) {
            wh_json_append(limits, made);
        }
    }
    return wh_json_add(json_object(), "limits histograms", limits, histograms, NULL);
}

/* How the figures of the flow spread; null: no trial had one. */
static json_t *flow(const wh_study_document_t *document) {
    const wh_flow_sums_t *sums = document->tally->flow;
    json_t *histograms = sums ? json_object() : json_null();
    for (int f = 0; sums && f < WH_FLOW_SUM_FIGURES; ++f) {
        const double without = document->study->flow[f];
        wh_json_put(histograms, wh_flow_sum_names[f],
                    histogram(&sums->of[f], isnan(without) ? 0 : without, WH_FLOW_SUM_SCALE));
    }
    return histograms;
}

/* ------------------------------------------------------------------------------------------------- points */

static const wh_trial_line_t *line_of(const void *subject, size_t i) {
    return &((const wh_study_document_t *)subject)->tally->lines.lines[i];
}

static json_t *trial(const void *subject, size_t i) {
    return json_integer((json_int_t)line_of(subject, i)->trial);
}

static json_t *ok(const void *subject, size_t i) {
    return json_boolean(line_of(subject, i)->met);
}

/* Rounds to a nanometre, which a plot does not show. */
static double rounded(double value) {
    return floor(value * 1e6 + 0.5) / 1e6;
}

static json_t *why(const void *subject, size_t i) {
    char text[WH_TRIAL_LINE_WHY];
    wh_trial_line_why(line_of(subject, i), text, sizeof text);
    return wh_json_text(text);
}

static json_t *off(const void *subject, size_t i) {
    return wh_json_real(rounded(line_of(subject, i)->off));
}

static json_t *ends(const void *subject, size_t i) {
    const wh_trial_lines_t *lines = &((const wh_study_document_t *)subject)->tally->lines;
    json_t *list = json_array();
    for (size_t w = 0; w < lines->wafer_count; ++w) {
        const double *values = &lines->ends[(i * lines->wafer_count + w) * WH_TRIAL_LINE_ENDS];
        wh_json_append(list, wh_json_real(rounded(values[0])));
        wh_json_append(list, wh_json_real(rounded(values[1])));
    }
    return list;
}

int wh_study_document_write(const wh_study_document_t *document, FILE *out) {
    const wh_study_t *study = document->study;
    const size_t kept = document->tally->lines.count;
    const size_t count = kept < MOST_POINTS ? kept : MOST_POINTS;
    json_t *points =
        wh_json_add(json_object(), "trial ok why off ends", wh_json_list(trial, document, count),
                    wh_json_list(ok, document, count), wh_json_list(why, document, count),
                    wh_json_list(off, document, count), wh_json_list(ends, document, count), NULL);
    (void)wh_json_set(points, "of %lld", (json_int_t)document->tally->trials);
    json_t *root = wh_json_set(json_object(), "format %d title %s version %s command %s", 1,
                               study->run.script, WH_VERSION, document->command);
    (void)wh_json_add(root, "result wafers points flow", json_incref(document->result),
                      wh_json_list(wafer, document, study->wafer_count), points, flow(document), NULL);
    const int status = json_dumpf(root, out, JSON_COMPACT | JSON_REAL_PRECISION(9));
    json_decref(root);
    return status;
}
