/* A study's result as JSON. */
#include <math.h>

#include "../text/json.h"
#include "study_print.h"

static void put_count(json_t *object, const char *key, uint64_t value) {
    wh_json_put_integer(object, key, (json_int_t)value);
}

static void put_rate(json_t *object, uint64_t hits, uint64_t trials) {
    const wh_confidence_t rate = wh_wilson_interval(hits, trials);
    (void)wh_json_add(object, "rate low high", wh_json_real(rate.rate), wh_json_real(rate.low),
                      wh_json_real(rate.high), NULL);
}

static void put_trial(json_t *object, const char *key, uint64_t trial) {
    wh_json_put(object, key, trial == WH_TALLY_NO_TRIAL ? json_null() : json_integer((json_int_t)trial));
}

/* --------------------------------------------------------------------------------------------------- rows */

static json_t *expectation(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_row_t *row = &result->tally->expectations.rows[i];
    char expected[4096];
    wh_study_expected(row->text, expected, sizeof expected);
    json_t *object = wh_json_add(json_object(), "line text seen met", json_integer(row->line),
                                 wh_json_text(expected), json_integer((json_int_t)row->seen),
                                 json_integer((json_int_t)(row->seen - row->bad)), NULL);
    put_rate(object, row->seen - row->bad, row->seen);
    put_trial(object, "first_missed", row->first);
    return object;
}

static json_t *error(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_row_t *row = &result->tally->errors.rows[i];
    json_t *object = wh_json_add(json_object(), "line text error name trials", json_integer(row->line),
                                 wh_json_text(row->text), json_integer(row->place),
                                 wh_json_text(wh_status_name((wh_status_t)row->place)),
                                 json_integer((json_int_t)row->bad), NULL);
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
    json_t *object =
        wh_json_add(json_object(), "kind trials", wh_json_text(wh_event_name((wh_event_kind_t)kind)),
                    json_integer((json_int_t)counted->trials), NULL);
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
    json_t *object =
        wh_json_add(json_object(), "mean deviation min", wh_json_real(nominal + wh_sum_mean(sum)),
                    wh_json_real(wh_sum_deviation(sum)), wh_json_real(nominal + wh_sum_least(sum)), NULL);
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
    json_t *object = wh_json_add(
        json_object(), "name station slot holder elsewhere count",
        wh_json_text(result->study->layout->wafers[end->wafer].name),
        wh_json_text(lies ? result->study->layout->stations[end->place.station].name : NULL),
        lies ? json_integer(end->place.slot) : json_null(),
        wh_json_text(end->holder == WH_NONE ? NULL : result->study->layout->grippers[end->holder].name),
        json_integer((json_int_t)tally->elsewhere), json_integer((json_int_t)tally->of[0].count), NULL);
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

static json_t *displacement(const char *keys, const char *name, const wh_displacement_t *drawn) {
    const wh_vec3_t *moved = &drawn->moved;
    const wh_real_t *turn = drawn->turn;
    if (!wh_displacement_is_any(drawn)) {
        return NULL;
    }
    return wh_json_add(json_object(), keys, wh_json_text(name), wh_json_real(moved->x),
                       wh_json_real(moved->y), wh_json_real(moved->z), wh_json_real(turn[0]),
                       wh_json_real(turn[1]), wh_json_real(turn[2]), NULL);
}

static json_t *drawn_wafer(const void *subject, size_t w) {
    const draw_t *draw = subject;
    const wh_displacement_t drawn = wh_errors_draw_wafer(draw->layout->errors, &draw->trial, w);
    return displacement("name dx dy dz tilt_x tilt_y turn", draw->layout->wafers[w].name, &drawn);
}

static json_t *drawn_station(const void *subject, size_t s) {
    const draw_t *draw = subject;
    const wh_displacement_t drawn = wh_errors_draw_station(draw->layout->errors, &draw->trial, s);
    return displacement("name x y z roll pitch yaw", draw->layout->stations[s].name, &drawn);
}

static json_t *drawn_valve(const void *subject, size_t g) {
    const draw_t *draw = subject;
    const wh_layout_t *layout = draw->layout;
    if (!(layout->errors->valves[g].width > 0)) {
        return NULL;
    }
    json_t *object = json_object();
    const double late = (double)wh_errors_draw_valve(layout->errors, &draw->trial, g);
    (void)wh_json_add(object, "gripper slices", wh_json_text(layout->grippers[g].name),
                      json_integer((json_int_t)ceil(late * 1e6 / (double)layout->slice_us)), NULL);
    return object;
}

static json_t *worst_trial(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_trial_t *worst = &result->tally->worst[i];
    const wh_layout_t *layout = result->study->layout;
    const draw_t draw = {layout, {result->study->seed, worst->trial}};
    json_t *object = json_object();
    json_t *drawn = json_object();
    (void)wh_json_add(object, "trial ok off", json_integer((json_int_t)worst->trial),
                      json_boolean(worst->met), wh_json_real(worst->off), NULL);
    (void)wh_json_add(drawn, "wafers stations valves vacuum_s",
                      wh_json_list(drawn_wafer, &draw, layout->wafer_count),
                      wh_json_list(drawn_station, &draw, layout->station_count),
                      wh_json_list(drawn_valve, &draw, layout->machine.gripper_count),
                      wh_json_real((double)wh_errors_draw_vacuum(layout->errors, &draw.trial)), NULL);
    wh_json_put(object, "drawn", drawn);
    return object;
}

/* ---------------------------------------------------------------------------------------------- all of it */

static json_t *run_without_errors(const wh_study_result_t *result) {
    const wh_record_t *record = &result->study->nominal.record;
    return wh_json_add(json_object(), "ok hash slices simulated_s", json_boolean(record->ok),
                       json_sprintf("%016llx", (unsigned long long)record->hash),
                       json_integer(record->slices), wh_json_real(record->simulated_s), NULL);
}

static void put_head(const wh_study_result_t *result, json_t *root) {
    json_t *success = json_object();
    wh_json_put_integer(root, "format", 1);
    wh_json_put(root, "ok", json_boolean(wh_study_is_kept(result)));
    wh_json_put_text(root, "script", result->study->run.script);
    wh_json_put_text(root, "layout", result->study->layout->path);
    put_count(root, "seed", result->study->seed);
    put_count(root, "trials", result->tally->trials);
    wh_json_put(root, "success", success);
    put_count(success, "met", result->tally->met);
    put_rate(success, result->tally->met, result->tally->trials);
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
