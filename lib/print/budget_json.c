/* A budget as JSON. */
#include <math.h>

#include "../text/json.h"
#include "budget_print.h"

static double number_of(int32_t thousandths) {
    return (double)thousandths / WH_BUDGET_UNIT;
}

static const char *unit_of(size_t axis) {
    return axis < 3 ? "mm" : "deg";
}

static json_t *why_of(bool fails, const wh_budget_why_t *why) {
    if (!fails) {
        return json_null();
    }
    return wh_json_set(json_object(), "name %s error %lld line %lld command %s text %s", why->name,
                       why->error != WH_OK ? (json_int_t)why->error : WH_JSON_NONE,
                       why->line > 0 ? (json_int_t)why->line : WH_JSON_NONE, why->command, why->text);
}

/* ----------------------------------------------------------------------------------------- each by itself */

static json_t *error_text(const wh_budget_t *budget, size_t station, size_t axis, int32_t value) {
    char text[WH_BUDGET_TEXT];
    if (value == 0) {
        return json_null();
    }
    wh_budget_text(text, budget->study->layout, station, axis, value);
    return wh_json_text(text);
}

static json_t *side_of(const wh_budget_t *budget, size_t station, size_t axis, int way) {
    const wh_budget_side_t *side = &budget->stations[station].errors[axis].sides[way];
    const int32_t sign = way == 0 ? -1 : 1;
    json_t *object = wh_json_set(json_object(), "inside %g outside %g", number_of(sign * side->inside),
                                 side->outside > 0 ? number_of(sign * side->outside) : HUGE_VAL);
    return wh_json_add(
        wh_json_set(object, "trials %lld widest_step %g", (json_int_t)side->trials, number_of(side->widest)),
        "inside_error outside_error why", error_text(budget, station, axis, sign * side->inside),
        error_text(budget, station, axis, sign * side->outside), why_of(side->outside > 0, &side->why), NULL);
}

static json_t *error(const void *subject, size_t i) {
    const wh_budget_t *budget = subject;
    const size_t station = i / WH_SPREADS;
    const size_t axis = i % WH_SPREADS;
    const wh_budget_error_t *found = &budget->stations[station].errors[axis];
    if (!budget->stations[station].wanted || !found->known) {
        return NULL;
    }
    json_t *object = wh_json_set(
        json_object(), "station %s error %s unit %s width %g at_least %i has_effect %i rim_mm %g",
        budget->study->layout->stations[station].name, wh_errors_teaching_name(axis), unit_of(axis),
        number_of(found->width), found->sides[0].outside == 0 && found->sides[1].outside == 0,
        found->has_effect, wh_budget_rim(budget, station, axis));
    return wh_json_add(object, "down up", side_of(budget, station, axis, 0),
                       side_of(budget, station, axis, 1), NULL);
}

/* ----------------------------------------------------------------------------------------------- together */

static json_t *half(const void *subject, size_t i) {
    const wh_budget_t *budget = subject;
    if (!budget->stations[i / WH_SPREADS].wanted) {
        return NULL;
    }
    return wh_json_set(json_object(), "station %s error %s half %g",
                       budget->study->layout->stations[i / WH_SPREADS].name,
                       wh_errors_teaching_name(i % WH_SPREADS), number_of(budget->box.half[i]));
}

typedef struct {
    const wh_budget_t *budget;
    const int32_t *point;
} witness_t;

static json_t *part(const void *subject, size_t i) {
    const witness_t *witness = subject;
    return witness->point[i] == 0
               ? NULL
               : error_text(witness->budget, i / WH_SPREADS, i % WH_SPREADS, witness->point[i]);
}

static json_t *witness_of(const wh_budget_t *budget, const int32_t *point) {
    const witness_t witness = {budget, point};
    return point ? wh_json_list(part, &witness, WH_SPREADS * budget->study->layout->station_count)
                 : json_null();
}

static json_t *counts_of(const uint64_t tried[WH_BOX_KINDS]) {
    return wh_json_set(
        json_object(), "alike %lld opposite %lld alone %lld corner %lld inside %lld beside %lld",
        (json_int_t)tried[WH_BOX_ALIKE], (json_int_t)tried[WH_BOX_OPPOSITE], (json_int_t)tried[WH_BOX_ALONE],
        (json_int_t)tried[WH_BOX_CORNER], (json_int_t)tried[WH_BOX_INSIDE], (json_int_t)tried[WH_BOX_BESIDE]);
}

static json_t *all_of(const wh_budget_t *budget) {
    const wh_budget_box_t *box = &budget->box;
    const double share = box->whole > 0 ? (double)box->share / (double)box->whole : 0;
    return wh_json_add(wh_json_set(json_object(), "share %g proved %i", share, false),
                       "half tried tried_without_collisions inside_errors outside_errors why",
                       wh_json_list(half, budget, WH_SPREADS * budget->study->layout->station_count),
                       counts_of(box->tried), counts_of(box->tried_without), witness_of(budget, box->inside),
                       witness_of(budget, box->outside), why_of(box->outside != NULL, &box->why), NULL);
}

static json_t *station_of(const wh_budget_t *budget, int32_t station) {
    if (station == WH_NONE) {
        return json_null();
    }
    const size_t axis = wh_budget_tightest_axis(budget, (size_t)station);
    return wh_json_set(json_object(), "station %s error %s width %g rim_mm %g",
                       budget->study->layout->stations[station].name, wh_errors_teaching_name(axis),
                       number_of(budget->stations[station].errors[axis].width),
                       wh_budget_tightness(budget, (size_t)station));
}

int wh_budget_print_json(const wh_budget_t *budget, FILE *out) {
    const wh_study_t *study = budget->study;
    const bool ok = !budget->incomplete;
    json_t *root = wh_json_set(json_object(), "format %d ok %i script %s layout %s trials %lld", 1, ok,
                               study->run.script, study->layout->path, (json_int_t)budget->trials);
    (void)wh_json_set(root, "interrupted %i limit_mm %g limit_deg %g collision %i caught_errors %i noise %i",
                      budget->incomplete, number_of(budget->options.most[0]),
                      number_of(budget->options.most[1]), study->layout->collision, budget->caught,
                      wh_study_has_noise(study));
    (void)wh_json_set(root, "capped %lld", (json_int_t)wh_budget_capped(budget));
    (void)wh_json_add(root, "errors all tightest next",
                      wh_json_list(error, budget, WH_SPREADS * study->layout->station_count),
                      ok ? all_of(budget) : json_null(), station_of(budget, ok ? budget->tightest : WH_NONE),
                      station_of(budget, ok ? budget->next : WH_NONE), NULL);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
