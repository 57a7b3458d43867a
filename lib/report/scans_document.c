#include "scans_document.h"

#include <math.h>
#include <stdlib.h>

#include "../text/array.h"

enum { DECIMALS_RAD = 6, DECIMALS_MM = 4, DECIMALS_RESIDUAL = 6 };

typedef double number_t(const wh_edge_point_t *sample);

static double angle_of(const wh_edge_point_t *sample) {
    return sample->angle;
}

static double radius_of(const wh_edge_point_t *sample) {
    return sample->radius;
}

static double residual_of(const wh_edge_point_t *sample) {
    return sample->residual;
}

static double counts_of(const wh_edge_point_t *sample) {
    return sample->counts ? 1 : 0;
}

static void put_column(wh_json_text_t *text, const char *key, const wh_edge_scan_t *scan,
                       const wh_edge_point_t samples[], number_t *number, int decimals) {
    wh_json_text_begin(text, key, '[');
    for (int32_t i = 0; i < scan->taken; ++i) {
        wh_json_text_number(text, NULL, number(&samples[i]), decimals, false);
    }
    wh_json_text_end(text, ']');
}

static void put_circle(wh_json_text_t *text, const wh_circle_t *circle) {
    if (!(circle->radius > 0)) {
        wh_json_text_value(text, "circle", json_null());
        return;
    }
    wh_json_text_begin(text, "circle", '{');
    wh_json_text_number(text, "x", circle->x, 0, true);
    wh_json_text_number(text, "y", circle->y, 0, true);
    wh_json_text_number(text, "radius", circle->radius, 0, true);
    wh_json_text_number(text, "sd_centre", circle->sd_centre, 0, true);
    wh_json_text_number(text, "sd_radius", circle->sd_radius, 0, true);
    wh_json_text_end(text, '}');
}

static void put_mark(wh_json_text_t *text, const wh_align_result_t *result) {
    static const char *const names[] = {"", "notch", "primary flat", "secondary flat"};
    if (result->mark == WH_ALIGN_MARK_NONE) {
        wh_json_text_value(text, "mark", json_null());
        return;
    }
    wh_json_text_begin(text, "mark", '{');
    wh_json_text_string(text, "kind", names[result->mark]);
    wh_json_text_number(text, "at", wh_edge_scan_mark_at(result), 0, true);
    wh_json_text_number(text, "turn", result->turn, 0, true);
    wh_json_text_number(text, "sd_turn", result->sd_turn, 0, true);
    wh_json_text_end(text, '}');
}

static void put_estimate(wh_json_text_t *text, const wh_edge_scan_t *scan, wh_status_t status,
                         const wh_align_result_t *result) {
    wh_scan_words_t words;
    wh_edge_scan_words(scan, status, result, &words);
    wh_json_text_integer(text, "verdict", status != WH_OK ? status : result->verdict);
    wh_json_text_value(text, "sure", json_boolean(words.is_sure));
    wh_json_text_begin(text, "words", '[');
    for (size_t i = 0; i < WH_SCAN_LINES; ++i) {
        wh_json_text_string(text, NULL, words.lines[i]);
    }
    wh_json_text_end(text, ']');
    put_circle(text, &result->circle);
    put_mark(text, result);
}

/* Writes the chuck's station, or null. */
static void put_station(wh_json_text_t *text, const wh_layout_t *layout, int32_t gripper) {
    size_t s = 0;
    while (s < layout->station_count && layout->places[s].chuck != gripper) {
        ++s;
    }
    if (s < layout->station_count) {
        wh_json_text_integer(text, "station", (long long)s);
    } else {
        wh_json_text_value(text, "station", json_null());
    }
}

static void put_scan(wh_json_text_t *text, const wh_signals_t *signals, const wh_record_t *record,
                     const wh_edge_scan_t *scan) {
    wh_edge_point_t *samples = wh_array_new((size_t)scan->taken + 1, sizeof *samples);
    wh_align_result_t result;
    const wh_edge_wish_t wish = wh_edge_wish_at(record, wh_signals_seconds(signals, scan->first_slice));
    const wh_status_t status = wh_edge_scan_estimate(scan, signals->layout, wish, samples, &result);
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_integer(text, "number", scan->number);
    wh_json_text_number(text, "begin_s", wh_signals_seconds(signals, scan->first_slice), 6, false);
    wh_json_text_number(text, "end_s", wh_signals_seconds(signals, scan->last_slice), 6, false);
    wh_json_text_integer(text, "gripper", scan->gripper);
    put_station(text, signals->layout, scan->gripper);
    wh_json_text_integer(text, "count", scan->count);
    wh_json_text_integer(text, "taken", scan->taken);
    wh_json_text_integer(text, "missed", scan->missed);
    put_estimate(text, scan, status, &result);
    put_column(text, "theta", scan, samples, angle_of, DECIMALS_RAD);
    put_column(text, "rho", scan, samples, radius_of, DECIMALS_MM);
    put_column(text, "residual", scan, samples, residual_of, DECIMALS_RESIDUAL);
    put_column(text, "counts", scan, samples, counts_of, 0);
    wh_json_text_end(text, '}');
    free(samples);
}

void wh_scans_document_put(wh_json_text_t *text, const wh_signals_t *signals, const wh_record_t *record) {
    wh_json_text_begin(text, "scans", '[');
    for (size_t i = 0; i < signals->scans.count; ++i) {
        put_scan(text, signals, record, &signals->scans.list[i]);
    }
    wh_json_text_end(text, ']');
    wh_json_text_integer(text, "scans_left_out", (long long)signals->scans.left_out);
}
