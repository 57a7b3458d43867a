/* A study's result as JSON. */
#include <math.h>

#include "../study/wilson.h"
#include "../text/json_values.h"
#include "study_print.h"

/* `base` is first, so that the list's functions get at the rest. */
typedef struct {
    wh_json_writer_t base;
    const wh_study_print_t *report;
    const wh_tally_t *tally;
    const wh_layout_t *layout;
} writer_t;

static const writer_t *of(const wh_json_writer_t *writer) {
    return (const writer_t *)(const void *)writer;
}

static void put_count(wh_json_writer_t *writer, json_t *object, const char *key, uint64_t value) {
    wh_json_put(writer, object, key, json_integer((json_int_t)value));
}

static void put_real(wh_json_writer_t *writer, json_t *object, const char *key, double value) {
    wh_json_put(writer, object, key, wh_json_real(value));
}

static void put_text(wh_json_writer_t *writer, json_t *object, const char *key, const char *text) {
    wh_json_put(writer, object, key, wh_json_text(text));
}

static void put_rate(wh_json_writer_t *writer, json_t *object, uint64_t hits, uint64_t trials) {
    const wh_confidence_t rate = wh_wilson_interval(hits, trials);
    put_real(writer, object, "rate", rate.rate);
    put_real(writer, object, "low", rate.low);
    put_real(writer, object, "high", rate.high);
}

static void put_trial(wh_json_writer_t *writer, json_t *object, const char *key, uint64_t trial) {
    wh_json_put(writer, object, key,
                trial == WH_TALLY_NO_TRIAL ? json_null() : json_integer((json_int_t)trial));
}

/* --------------------------------------------------------------------------------------------------------- rows */

static json_t *expectation(wh_json_writer_t *writer, size_t i) {
    const wh_tally_row_t *row = &of(writer)->tally->expectations.rows[i];
    json_t *object = json_object();
    char expected[4096];
    wh_study_expected(row->text, expected, sizeof expected);
    wh_json_put(writer, object, "line", json_integer(row->line));
    put_text(writer, object, "text", expected);
    put_count(writer, object, "seen", row->seen);
    put_count(writer, object, "met", row->seen - row->bad);
    put_rate(writer, object, row->seen - row->bad, row->seen);
    put_trial(writer, object, "first_missed", row->first);
    return object;
}

static json_t *error(wh_json_writer_t *writer, size_t i) {
    const wh_tally_row_t *row = &of(writer)->tally->errors.rows[i];
    json_t *object = json_object();
    wh_json_put(writer, object, "line", json_integer(row->line));
    put_text(writer, object, "text", row->text);
    wh_json_put(writer, object, "error", json_integer(row->place));
    put_text(writer, object, "name", wh_status_name((wh_status_t)row->place));
    put_count(writer, object, "trials", row->bad);
    put_rate(writer, object, row->bad, of(writer)->tally->trials);
    put_trial(writer, object, "first", row->first);
    return object;
}

static json_t *event(wh_json_writer_t *writer, size_t kind) {
    const wh_tally_event_t *counted = &of(writer)->tally->events[kind];
    json_t *object = json_object();
    put_text(writer, object, "kind", wh_event_name((wh_event_kind_t)kind));
    put_count(writer, object, "trials", counted->trials);
    put_rate(writer, object, counted->trials, of(writer)->tally->trials);
    put_count(writer, object, "total", counted->total);
    return object;
}

/* Those that happened. */
static json_t *events(wh_json_writer_t *writer) {
    json_t *list = json_array();
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        if (of(writer)->tally->events[kind].trials > 0) {
            wh_json_append(writer, list, event(writer, kind));
        }
    }
    return list;
}

/* ------------------------------------------------------------------------------------------------------- wafers */

static json_t *figures(wh_json_writer_t *writer, const wh_sum_t *sum, double nominal) {
    static const struct {
        const char *key;
        uint32_t permille;
    } quantiles[] = {{"p0_1", 1},  {"p1", 10},   {"p5", 50},    {"p50", 500},
                     {"p95", 950}, {"p99", 990}, {"p99_9", 999}};
    json_t *object = json_object();
    put_real(writer, object, "mean", nominal + wh_sum_mean(sum));
    put_real(writer, object, "deviation", wh_sum_deviation(sum));
    put_real(writer, object, "min", nominal + wh_sum_least(sum));
    for (size_t i = 0; i < sizeof quantiles / sizeof quantiles[0]; ++i) {
        put_real(writer, object, quantiles[i].key, nominal + wh_sum_quantile(sum, quantiles[i].permille));
    }
    put_real(writer, object, "max", nominal + wh_sum_most(sum));
    return object;
}

static json_t *wafer(wh_json_writer_t *writer, size_t i) {
    static const char *const keys[] = {"dx", "dy", "dz", "tilt_deg", "off"};
    const writer_t *all = of(writer);
    const wh_study_wafer_t *end = &all->report->study->wafers[i];
    const wh_tally_wafer_t *tally = &all->tally->wafers[i];
    const bool lies = end->place.station != WH_NONE;
    json_t *object = json_object();
    put_text(writer, object, "name", all->layout->wafers[end->wafer].name);
    put_text(writer, object, "station", lies ? all->layout->stations[end->place.station].name : NULL);
    wh_json_put(writer, object, "slot", lies ? json_integer(end->place.slot) : json_null());
    put_text(writer, object, "holder",
             end->holder == WH_NONE ? NULL : all->layout->grippers[end->holder].name);
    put_count(writer, object, "elsewhere", tally->elsewhere);
    put_count(writer, object, "count", tally->of[0].count);
    for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
        wh_json_put(writer, object, keys[q],
                    tally->of[q].count > 0 ? figures(writer, &tally->of[q], wh_study_nominal(end, q))
                                           : json_null());
    }
    return object;
}

/* -------------------------------------------------------------------------------------------------------- worst */

static json_t *displacement(wh_json_writer_t *writer, const char *name, const wh_displacement_t *drawn,
                            const char *const keys[6]) {
    const double values[] = {(double)drawn->moved.x, (double)drawn->moved.y, (double)drawn->moved.z,
                             (double)drawn->turn[0], (double)drawn->turn[1], (double)drawn->turn[2]};
    json_t *object = json_object();
    put_text(writer, object, "name", name);
    for (size_t i = 0; i < 6; ++i) {
        put_real(writer, object, keys[i], values[i]);
    }
    return object;
}

static json_t *drawn_wafers(wh_json_writer_t *writer, const wh_trial_t *trial) {
    static const char *const keys[6] = {"dx", "dy", "dz", "tilt_x", "tilt_y", "turn"};
    const wh_layout_t *layout = of(writer)->layout;
    json_t *list = json_array();
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const wh_displacement_t drawn = wh_errors_draw_wafer(layout->errors, trial, w);
        if (wh_displacement_is_any(&drawn)) {
            wh_json_append(writer, list, displacement(writer, layout->wafers[w].name, &drawn, keys));
        }
    }
    return list;
}

static json_t *drawn_stations(wh_json_writer_t *writer, const wh_trial_t *trial) {
    static const char *const keys[6] = {"x", "y", "z", "roll", "pitch", "yaw"};
    const wh_layout_t *layout = of(writer)->layout;
    json_t *list = json_array();
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_displacement_t drawn = wh_errors_draw_station(layout->errors, trial, s);
        if (wh_displacement_is_any(&drawn)) {
            wh_json_append(writer, list, displacement(writer, layout->stations[s].name, &drawn, keys));
        }
    }
    return list;
}

static json_t *drawn_valves(wh_json_writer_t *writer, const wh_trial_t *trial) {
    const wh_layout_t *layout = of(writer)->layout;
    json_t *list = json_array();
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (layout->errors->valves[g].width > 0) {
            json_t *object = json_object();
            const double late = (double)wh_errors_draw_valve(layout->errors, trial, g);
            put_text(writer, object, "gripper", layout->grippers[g].name);
            wh_json_put(writer, object, "slices",
                        json_integer((json_int_t)ceil(late * 1e6 / (double)layout->slice_us)));
            wh_json_append(writer, list, object);
        }
    }
    return list;
}

static json_t *worst_trial(wh_json_writer_t *writer, size_t i) {
    const writer_t *all = of(writer);
    const wh_tally_trial_t *worst = &all->tally->worst[i];
    const wh_trial_t trial = {all->report->study->seed, worst->trial};
    json_t *object = json_object();
    json_t *drawn = json_object();
    put_count(writer, object, "trial", worst->trial);
    wh_json_put(writer, object, "ok", json_boolean(worst->met));
    put_real(writer, object, "off", worst->off);
    wh_json_put(writer, drawn, "wafers", drawn_wafers(writer, &trial));
    wh_json_put(writer, drawn, "stations", drawn_stations(writer, &trial));
    wh_json_put(writer, drawn, "valves", drawn_valves(writer, &trial));
    put_real(writer, drawn, "vacuum_s", (double)wh_errors_draw_vacuum(all->layout->errors, &trial));
    wh_json_put(writer, object, "drawn", drawn);
    return object;
}

/* ---------------------------------------------------------------------------------------------------- all of it */

static json_t *success(wh_json_writer_t *writer) {
    json_t *object = json_object();
    put_count(writer, object, "met", of(writer)->tally->met);
    put_rate(writer, object, of(writer)->tally->met, of(writer)->tally->trials);
    return object;
}

static json_t *run_without_errors(wh_json_writer_t *writer) {
    const wh_record_t *record = &of(writer)->report->study->nominal.record;
    json_t *object = json_object();
    wh_json_put(writer, object, "ok", json_boolean(record->ok));
    wh_json_put(writer, object, "hash", json_sprintf("%016llx", (unsigned long long)record->hash));
    wh_json_put(writer, object, "slices", json_integer(record->slices));
    put_real(writer, object, "simulated_s", record->simulated_s);
    return object;
}

static void put_head(wh_json_writer_t *writer, json_t *root) {
    const wh_study_print_t *report = of(writer)->report;
    wh_json_put(writer, root, "format", json_integer(1));
    wh_json_put(writer, root, "ok", json_boolean(wh_study_is_kept(report)));
    put_text(writer, root, "script", report->study->run.script);
    put_text(writer, root, "layout", report->study->layout->path);
    put_count(writer, root, "seed", report->study->seed);
    put_count(writer, root, "trials", report->tally->trials);
    wh_json_put(writer, root, "success", success(writer));
    wh_json_put(writer, root, "require", report->require > 0 ? wh_json_real(report->require) : json_null());
    put_count(writer, root, "ended", report->tally->ended);
    put_count(writer, root, "whole", report->tally->whole);
    put_text(writer, root, "whole_why", report->study->whole);
    wh_json_put(writer, root, "run_without_errors", run_without_errors(writer));
}

int wh_study_print_json(const wh_study_print_t *report, FILE *out) {
    writer_t all = {{&report->study->nominal.record, false}, report, report->tally, report->study->layout};
    wh_json_writer_t *writer = &all.base;
    json_t *root = json_object();
    const size_t worst =
        report->worst < report->tally->worst_count ? report->worst : report->tally->worst_count;
    put_head(writer, root);
    wh_json_put(writer, root, "expectations",
                wh_json_list(writer, expectation, report->tally->expectations.count));
    wh_json_put(writer, root, "errors", wh_json_list(writer, error, report->tally->errors.count));
    wh_json_put(writer, root, "events", events(writer));
    wh_json_put(writer, root, "wafers", wh_json_list(writer, wafer, report->tally->wafer_count));
    wh_json_put(writer, root, "worst", wh_json_list(writer, worst_trial, worst));
    const int status = writer->failed ? -1 : wh_json_print(root, out);
    json_decref(root);
    return status;
}
