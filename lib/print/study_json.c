/* A study's result as JSON. */
#include <math.h>

#include "../text/json.h"
#include "record_print.h"
#include "study_causes.h"
#include "study_print.h"

static void put_rate(json_t *object, uint64_t hits, uint64_t trials) {
    const wh_confidence_t rate = wh_wilson_interval(hits, trials);
    (void)wh_json_set(object, "rate %g low %g high %g", rate.rate, rate.low, rate.high);
}

static json_int_t number_of(uint64_t trial) {
    return trial == WH_TALLY_NO_TRIAL ? WH_JSON_NONE : (json_int_t)trial;
}

/* --------------------------------------------------------------------------------------------------- rows */

/* Null for one that is not told. */
static json_t *expectation(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_row_t *row = &result->tally->expectations.rows[i];
    char expected[4096];
    if (!wh_tally_is_told(row)) {
        return NULL;
    }
    wh_study_expected(row->text, expected, sizeof expected);
    json_t *object = wh_json_set(json_object(), "line %d text %s seen %lld met %lld", row->line, expected,
                                 (json_int_t)row->seen, (json_int_t)(row->seen - row->bad));
    put_rate(object, row->seen - row->bad, row->seen);
    return wh_json_set(object, "first_missed %lld", number_of(row->first));
}

static json_t *error(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_row_t *row = &result->tally->errors.rows[i];
    json_t *object =
        wh_json_set(json_object(), "line %d text %s error %d name %s trials %lld", row->line, row->text,
                    row->place, wh_status_name((wh_status_t)row->place), (json_int_t)row->bad);
    put_rate(object, row->bad, result->tally->trials);
    return wh_json_set(object, "first %lld", number_of(row->first));
}

/* Null for a kind that never happened. */
static json_t *event(const void *subject, size_t kind) {
    const wh_study_result_t *result = subject;
    const wh_tally_event_t *counted = &result->tally->events[kind];
    if (counted->trials == 0) {
        return NULL;
    }
    json_t *object =
        wh_json_set(json_object(), "kind %s complaint %i trials %lld", wh_event_name((wh_event_kind_t)kind),
                    wh_record_is_complaint((wh_event_kind_t)kind), (json_int_t)counted->trials);
    put_rate(object, counted->trials, result->tally->trials);
    return wh_json_set(object, "total %lld", (json_int_t)counted->total);
}

/* ------------------------------------------------------------------------------------------------- wafers */

static json_t *figures(const wh_sum_t *sum, double nominal) {
    static const struct {
        const char *key;
        uint32_t permille;
    } quantiles[] = {{"p0_1", 1},  {"p1", 10},   {"p5", 50},    {"p50", 500},
                     {"p95", 950}, {"p99", 990}, {"p99_9", 999}};
    json_t *object = wh_json_set(json_object(), "mean %g deviation %g min %g", nominal + wh_sum_mean(sum),
                                 wh_sum_deviation(sum), nominal + wh_sum_least(sum));
    for (size_t i = 0; i < sizeof quantiles / sizeof quantiles[0]; ++i) {
        wh_json_put(object, quantiles[i].key,
                    wh_json_real(nominal + wh_sum_quantile(sum, quantiles[i].permille)));
    }
    return wh_json_set(object, "max %g", nominal + wh_sum_most(sum));
}

static json_t *wafer(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    static const char *const keys[] = {"dx", "dy", "dz", "tilt_deg", "off"};
    const wh_study_wafer_t *end = &result->study->wafers[i];
    const wh_tally_wafer_t *tally = &result->tally->wafers[i];
    const bool lies = end->place.station != WH_NONE;
    const wh_layout_t *layout = result->study->layout;
    json_t *object =
        wh_json_set(json_object(), "name %s station %s slot %lld holder %s elsewhere %lld count %lld",
                    layout->wafers[end->wafer].name, lies ? layout->stations[end->place.station].name : NULL,
                    lies ? end->place.slot : WH_JSON_NONE,
                    end->holder == WH_NONE ? NULL : layout->grippers[end->holder].name,
                    (json_int_t)tally->elsewhere, (json_int_t)tally->of[0].count);
    for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
        wh_json_put(object, keys[q],
                    tally->of[q].count > 0 ? figures(&tally->of[q], wh_study_nominal(end, q)) : json_null());
    }
    return object;
}

/* --------------------------------------------------------------------------------------------------- flow */

static json_t *figure(const wh_study_result_t *result, wh_flow_sum_t which) {
    static const struct {
        const char *key;
        uint32_t permille;
    } quantiles[] = {{"p0_1", 1},  {"p1", 10},   {"p5", 50},    {"p50", 500},
                     {"p95", 950}, {"p99", 990}, {"p99_9", 999}};
    const wh_flow_sums_t *flow = result->tally->flow;
    const double *without = result->study->flow;
    const wh_flow_spread_t spread = wh_flow_sums_spread(flow, which, without);
    json_t *object =
        wh_json_set(json_object(), "without_errors %g count %lld mean %g deviation %g min %g", without[which],
                    (json_int_t)flow->of[which].count, spread.mean, spread.deviation, spread.least);
    for (size_t i = 0; i < sizeof quantiles / sizeof quantiles[0]; ++i) {
        const double value = wh_flow_sums_quantile(flow, which, without, quantiles[i].permille);
        wh_json_put(object, quantiles[i].key, wh_json_real(fmax(spread.least, fmin(spread.most, value))));
    }
    return wh_json_set(object, "max %g", spread.most);
}

static json_t *flow(const wh_study_result_t *result) {
    const wh_flow_sums_t *flow = result->tally->flow;
    json_t *object = wh_json_set(json_object(), "unfinished %lld unsteady %lld no_cycle %lld clipped %lld",
                                 (json_int_t)flow->unfinished, (json_int_t)flow->unsteady,
                                 (json_int_t)flow->no_cycle, (json_int_t)flow->clipped);
    for (int i = 0; i < WH_FLOW_SUM_FIGURES; ++i) {
        wh_json_put(object, wh_flow_sum_names[i],
                    flow->of[i].count > 0 ? figure(result, (wh_flow_sum_t)i) : json_null());
    }
    return object;
}

/* -------------------------------------------------------------------------------------------------- worst */

/* The draws of a trial; null for things without a draw. */
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
    const double late = wh_errors_draw_valve(layout->errors, &draw->trial, g);
    return wh_json_set(json_object(), "gripper %s slices %lld", layout->grippers[g].name,
                       (json_int_t)ceil(late * 1e6 / (double)layout->slice_us));
}

static json_t *drawn_rim(const void *subject, size_t w) {
    const draw_t *draw = subject;
    const wh_layout_t *layout = draw->layout;
    double drawn[WH_RIM_DRAWS];
    wh_errors_draw_rim(layout->errors, &draw->trial, w, layout->rims[w], drawn);
    json_t *rim = json_object();
    for (int i = 0; i < (int)WH_RIM_DRAWS; ++i) {
        if (drawn[i] != 0) {
            wh_json_put(rim, wh_rim_draw_name((wh_rim_draw_t)i), wh_json_real(drawn[i]));
        }
    }
    if (json_object_size(rim) == 0) {
        json_decref(rim);
        return NULL;
    }
    wh_json_put(rim, "name", wh_json_text(layout->wafers[w].name));
    return rim;
}

static json_t *drawn_beam(const void *subject, size_t b) {
    const draw_t *draw = subject;
    double drawn[WH_BEAM_DRAWS];
    wh_errors_draw_beam(draw->layout->errors, &draw->trial, b, drawn);
    if (drawn[WH_BEAM_DX] == 0 && drawn[WH_BEAM_DY] == 0 && drawn[WH_BEAM_LATE] == 0) {
        return NULL;
    }
    return wh_json_set(json_object(), "name %s dx %g dy %g late_s %g", draw->layout->beams[b].name,
                       drawn[WH_BEAM_DX], drawn[WH_BEAM_DY], drawn[WH_BEAM_LATE]);
}

/* The stations whose processes are drawn. */
static json_t *drawn_processes(const wh_study_t *study, const wh_trial_t *trial) {
    json_t *list = json_array();
    for (size_t i = 0; i < study->drawn_count; ++i) {
        const wh_cause_t *cause = &study->drawn[i];
        if (cause->kind == WH_CAUSE_PROCESS) {
            wh_json_append(
                list, wh_json_set(json_object(), "name %s process_s %g", wh_cause_of(cause, study->layout),
                                  wh_errors_draw_process(study->layout->errors, trial, cause->index)));
        }
    }
    return list;
}

static json_t *worst_trial(const void *subject, size_t i) {
    const wh_study_result_t *result = subject;
    const wh_tally_trial_t *worst = &result->tally->worst[i];
    const wh_layout_t *layout = result->study->layout;
    const draw_t draw = {layout, {result->study->seed, worst->trial}};
    char why[WH_TRIAL_LINE_WHY];
    wh_trial_line_why(worst, why, sizeof why);
    json_t *drawn = wh_json_add(json_object(), "wafers stations rims beams valves vacuum_s",
                                wh_json_list(drawn_wafer, &draw, layout->wafer_count),
                                wh_json_list(drawn_station, &draw, layout->station_count),
                                wh_json_list(drawn_rim, &draw, layout->wafer_count),
                                wh_json_list(drawn_beam, &draw, layout->beam_count),
                                wh_json_list(drawn_valve, &draw, layout->machine.gripper_count),
                                wh_json_real(wh_errors_draw_vacuum(layout->errors, &draw.trial)), NULL);
    if (layout->errors->debounce.width > 0) {
        wh_json_put(drawn, "debounce_s", wh_json_real(wh_errors_draw_debounce(layout->errors, &draw.trial)));
    }
    if (layout->errors->process.width > 0) {
        wh_json_put(drawn, "processes", drawn_processes(result->study, &draw.trial));
    }
    json_t *object = wh_json_set(json_object(), "trial %lld ok %i off %g why %s", (json_int_t)worst->trial,
                                 worst->met, worst->off, why[0] ? why : NULL);
    for (size_t f = 0; result->study->has_flow && f < WH_FLOW_SUM_FIGURES; ++f) {
        wh_json_put(object, wh_flow_sum_names[f], wh_json_real(worst->flow[f]));
    }
    return wh_json_add(object, "drawn", drawn, NULL);
}

/* ---------------------------------------------------------------------------------------------- all of it */

static json_t *run_without_errors(const wh_study_result_t *result) {
    const wh_record_t *record = &result->study->nominal.record;
    json_t *object =
        wh_json_set(json_object(), "ok %i hash %llx slices %lld simulated_s %g", record->ok,
                    (unsigned long long)record->hash, (json_int_t)record->slices, record->simulated_s);
    if (record->never_came) {
        wh_json_put(object, "never_came", wh_json_text(record->never_came));
    }
    return wh_json_add(object, "throughput", wh_throughput_to_json(record), NULL);
}

static void put_head(const wh_study_result_t *result, json_t *root) {
    const wh_tally_t *tally = result->tally;
    const wh_study_t *study = result->study;
    json_t *success = wh_json_set(json_object(), "met %lld", (json_int_t)tally->met);
    put_rate(success, tally->met, tally->trials);
    (void)wh_json_set(root, "format %d ok %i script %s layout %s seed %lld trials %lld", 1,
                      wh_study_is_kept(result), study->run.script, study->layout->path,
                      (json_int_t)study->seed, (json_int_t)tally->trials);
    wh_json_put(root, "success", success);
    (void)wh_json_set(root, "require %g ended %lld whole %lld whole_why %s",
                      result->require > 0 ? result->require : HUGE_VAL, (json_int_t)tally->ended,
                      (json_int_t)tally->whole, study->whole);
    wh_json_put(root, "noise_alone", json_boolean(wh_study_is_of_noise(study)));
    (void)wh_json_set(root, "drawn_aside %lld", (json_int_t)(study->drawn_count - study->cause_count));
    wh_json_put(root, "run_without_errors", run_without_errors(result));
}

json_t *wh_study_to_json(const wh_study_result_t *result) {
    json_t *root = json_object();
    const size_t worst =
        result->worst < result->tally->worst_count ? result->worst : result->tally->worst_count;
    put_head(result, root);
    wh_json_put(root, "expectations", wh_json_list(expectation, result, result->tally->expectations.count));
    wh_json_put(root, "errors", wh_json_list(error, result, result->tally->errors.count));
    wh_json_put(root, "events", wh_json_list(event, result, WH_EVENT_KINDS));
    wh_json_put(root, "wafers", wh_json_list(wafer, result, result->tally->wafer_count));
    if (result->tally->flow) {
        wh_json_put(root, "flow", flow(result));
    }
    wh_json_put(root, "drawn", wh_causes_to_json(result));
    wh_json_put(root, "worst", wh_json_list(worst_trial, result, worst));
    return root;
}

int wh_study_print_json(const wh_study_result_t *result, FILE *out) {
    json_t *root = wh_study_to_json(result);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
