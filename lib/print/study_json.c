/* A study's result as JSON. */
#include <math.h>

#include "../study/wilson.h"
#include "../text/json.h"
#include "study_print.h"

static void put_count(json_t *object, const char *key, uint64_t value) {
    wh_json_put_integer(object, key, (json_int_t)value);
}

static void put_rate(json_t *object, uint64_t hits, uint64_t trials) {
    const wh_confidence_t rate = wh_wilson_interval(hits, trials);
    wh_json_put_real(object, "rate", rate.rate);
    wh_json_put_real(object, "low", rate.low);
    wh_json_put_real(object, "high", rate.high);
}

static void put_trial(json_t *object, const char *key, uint64_t trial) {
    wh_json_put(object, key, trial == WH_TALLY_NO_TRIAL ? json_null() : json_integer((json_int_t)trial));
}

/* --------------------------------------------------------------------------------------------------- rows */

static json_t *expectation(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_row_t *row = &result->tally->expectations.rows[i];
    json_t *object = json_object();
    char expected[4096];
    wh_study_expected(row->text, expected, sizeof expected);
    wh_json_put_integer(object, "line", row->line);
    wh_json_put_text(object, "text", expected);
    put_count(object, "seen", row->seen);
    put_count(object, "met", row->seen - row->bad);
    put_rate(object, row->seen - row->bad, row->seen);
    put_trial(object, "first_missed", row->first);
    return object;
}

static json_t *error(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_row_t *row = &result->tally->errors.rows[i];
    json_t *object = json_object();
    wh_json_put_integer(object, "line", row->line);
    wh_json_put_text(object, "text", row->text);
    wh_json_put_integer(object, "error", row->place);
    wh_json_put_text(object, "name", wh_status_name((wh_status_t)row->place));
    put_count(object, "trials", row->bad);
    put_rate(object, row->bad, result->tally->trials);
    put_trial(object, "first", row->first);
    return object;
}

/* Null for a kind that never happened. */
static json_t *event(const void *subject, size_t kind) {
    const wh_study_result_t *result = subject;
    const wh_tally_event_t *counted = &result->tally->events[kind];
    if (counted->trials == 0) {
        return NULL;
    }
    json_t *object = json_object();
    wh_json_put_text(object, "kind", wh_event_name((wh_event_kind_t)kind));
    put_count(object, "trials", counted->trials);
    put_rate(object, counted->trials, result->tally->trials);
    put_count(object, "total", counted->total);
    return object;
}

/* ------------------------------------------------------------------------------------------------- wafers */

static json_t *figures(const wh_sum_t *sum, double nominal) {
    static const struct {
        const char *key;
        uint32_t permille;
    } quantiles[] = {{"p0_1", 1},  {"p1", 10},   {"p5", 50},    {"p50", 500},
                     {"p95", 950}, {"p99", 990}, {"p99_9", 999}};
    json_t *object = json_object();
    wh_json_put_real(object, "mean", nominal + wh_sum_mean(sum));
    wh_json_put_real(object, "deviation", wh_sum_deviation(sum));
    wh_json_put_real(object, "min", nominal + wh_sum_least(sum));
    for (size_t i = 0; i < sizeof quantiles / sizeof quantiles[0]; ++i) {
        wh_json_put_real(object, quantiles[i].key, nominal + wh_sum_quantile(sum, quantiles[i].permille));
    }
    wh_json_put_real(object, "max", nominal + wh_sum_most(sum));
    return object;
}

static json_t *wafer(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    static const char *const keys[] = {"dx", "dy", "dz", "tilt_deg", "off"};
    const wh_study_wafer_t *end = &result->study->wafers[i];
    const wh_tally_wafer_t *tally = &result->tally->wafers[i];
    const bool lies = end->place.station != WH_NONE;
    json_t *object = json_object();
    wh_json_put_text(object, "name", result->study->layout->wafers[end->wafer].name);
    wh_json_put_text(object, "station",
                     lies ? result->study->layout->stations[end->place.station].name : NULL);
    wh_json_put(object, "slot", lies ? json_integer(end->place.slot) : json_null());
    wh_json_put_text(object, "holder",
                     end->holder == WH_NONE ? NULL : result->study->layout->grippers[end->holder].name);
    put_count(object, "elsewhere", tally->elsewhere);
    put_count(object, "count", tally->of[0].count);
    for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
        wh_json_put(object, keys[q],
                    tally->of[q].count > 0 ? figures(&tally->of[q], wh_study_nominal(end, q)) : json_null());
    }
    return object;
}

/* -------------------------------------------------------------------------------------------------- worst */

/* What a trial drew. What it drew nothing for is null. */
typedef struct {
    const wh_layout_t *layout;
    wh_trial_t trial;
} draw_t;

static json_t *displacement(const char *name, const wh_displacement_t *drawn, const char *const keys[6]) {
    const double values[] = {(double)drawn->moved.x, (double)drawn->moved.y, (double)drawn->moved.z,
                             (double)drawn->turn[0], (double)drawn->turn[1], (double)drawn->turn[2]};
    if (!wh_displacement_is_any(drawn)) {
        return NULL;
    }
    json_t *object = json_object();
    wh_json_put_text(object, "name", name);
    for (size_t i = 0; i < 6; ++i) {
        wh_json_put_real(object, keys[i], values[i]);
    }
    return object;
}

static json_t *drawn_wafer(const void *subject, size_t w) {
    static const char *const keys[6] = {"dx", "dy", "dz", "tilt_x", "tilt_y", "turn"};
    const draw_t *draw = subject;
    const wh_displacement_t drawn = wh_errors_draw_wafer(draw->layout->errors, &draw->trial, w);
    return displacement(draw->layout->wafers[w].name, &drawn, keys);
}

static json_t *drawn_station(const void *subject, size_t s) {
    static const char *const keys[6] = {"x", "y", "z", "roll", "pitch", "yaw"};
    const draw_t *draw = subject;
    const wh_displacement_t drawn = wh_errors_draw_station(draw->layout->errors, &draw->trial, s);
    return displacement(draw->layout->stations[s].name, &drawn, keys);
}

static json_t *drawn_valve(const void *subject, size_t g) {
    const draw_t *draw = subject;
    const wh_layout_t *layout = draw->layout;
    if (!(layout->errors->valves[g].width > 0)) {
        return NULL;
    }
    json_t *object = json_object();
    const double late = (double)wh_errors_draw_valve(layout->errors, &draw->trial, g);
    wh_json_put_text(object, "gripper", layout->grippers[g].name);
    wh_json_put_integer(object, "slices", (json_int_t)ceil(late * 1e6 / (double)layout->slice_us));
    return object;
}

static json_t *worst_trial(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_trial_t *worst = &result->tally->worst[i];
    const wh_layout_t *layout = result->study->layout;
    const draw_t draw = {layout, {result->study->seed, worst->trial}};
    json_t *object = json_object();
    json_t *drawn = json_object();
    put_count(object, "trial", worst->trial);
    wh_json_put(object, "ok", json_boolean(worst->met));
    wh_json_put_real(object, "off", worst->off);
    wh_json_put(drawn, "wafers", wh_json_list(drawn_wafer, &draw, layout->wafer_count));
    wh_json_put(drawn, "stations", wh_json_list(drawn_station, &draw, layout->station_count));
    wh_json_put(drawn, "valves", wh_json_list(drawn_valve, &draw, layout->machine.gripper_count));
    wh_json_put_real(drawn, "vacuum_s", (double)wh_errors_draw_vacuum(layout->errors, &draw.trial));
    wh_json_put(object, "drawn", drawn);
    return object;
}

/* ---------------------------------------------------------------------------------------------- all of it */

static json_t *success(const wh_study_result_t *result) {
    json_t *object = json_object();
    put_count(object, "met", result->tally->met);
    put_rate(object, result->tally->met, result->tally->trials);
    return object;
}

static json_t *run_without_errors(const wh_study_result_t *result) {
    const wh_record_t *record = &result->study->nominal.record;
    json_t *object = json_object();
    wh_json_put(object, "ok", json_boolean(record->ok));
    wh_json_put(object, "hash", json_sprintf("%016llx", (unsigned long long)record->hash));
    wh_json_put_integer(object, "slices", record->slices);
    wh_json_put_real(object, "simulated_s", record->simulated_s);
    return object;
}

static void put_head(const wh_study_result_t *result, json_t *root) {
    wh_json_put_integer(root, "format", 1);
    wh_json_put(root, "ok", json_boolean(wh_study_is_kept(result)));
    wh_json_put_text(root, "script", result->study->run.script);
    wh_json_put_text(root, "layout", result->study->layout->path);
    put_count(root, "seed", result->study->seed);
    put_count(root, "trials", result->tally->trials);
    wh_json_put(root, "success", success(result));
    wh_json_put(root, "require", result->require > 0 ? wh_json_real(result->require) : json_null());
    put_count(root, "ended", result->tally->ended);
    put_count(root, "whole", result->tally->whole);
    wh_json_put_text(root, "whole_why", result->study->whole);
    wh_json_put(root, "run_without_errors", run_without_errors(result));
}

int wh_study_print_json(const wh_study_result_t *result, FILE *out) {
    json_t *root = json_object();
    const size_t worst =
        result->worst < result->tally->worst_count ? result->worst : result->tally->worst_count;
    put_head(result, root);
    wh_json_put(root, "expectations", wh_json_list(expectation, result, result->tally->expectations.count));
    wh_json_put(root, "errors", wh_json_list(error, result, result->tally->errors.count));
    wh_json_put(root, "events", wh_json_list(event, result, WH_EVENT_KINDS));
    wh_json_put(root, "wafers", wh_json_list(wafer, result, result->tally->wafer_count));
    wh_json_put(root, "worst", wh_json_list(worst_trial, result, worst));
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
