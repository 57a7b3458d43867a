#include "tally.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "../text/array.h"

void wh_tally_init(wh_tally_t *tally, size_t wafer_count) {
    memset(tally, 0, sizeof *tally);
    tally->wafer_count = wafer_count;
    tally->errors.by_text = true;
    tally->flow_at = SIZE_MAX;
    tally->wafers = wh_array_new(wafer_count, sizeof *tally->wafers);
}

static void free_rows(wh_tally_rows_t *rows) {
    for (size_t i = 0; i < rows->count; ++i) {
        free(rows->rows[i].text);
    }
    free(rows->rows);
}

void wh_tally_free(wh_tally_t *tally) {
    free_rows(&tally->expectations);
    free_rows(&tally->errors);
    free(tally->wafers);
    free(tally->flow);
    wh_relations_free(&tally->relations);
    wh_trial_lines_free(&tally->lines);
    memset(tally, 0, sizeof *tally);
}

wh_flow_sums_t *wh_tally_need_flow(wh_tally_t *tally) {
    tally->flow = tally->flow ? tally->flow : wh_array_new(1, sizeof *tally->flow);
    return tally->flow;
}

/* --------------------------------------------------------------------------------------------------- rows */

/* The search begins behind the last row found: most trials come to their rows in the same order. */
static wh_tally_row_t *find_row(wh_tally_rows_t *rows, const wh_tally_row_t *key, const char *text) {
    for (size_t i = 0; i < rows->count; ++i) {
        const size_t index = (rows->next + i) % rows->count;
        const wh_tally_row_t *row = &rows->rows[index];
        if (row->line == key->line && row->place == key->place && row->is_implied == key->is_implied &&
            (!rows->by_text || strcmp(row->text, text) == 0)) {
            rows->next = index + 1;
            return &rows->rows[index];
        }
    }
    return NULL;
}

bool wh_tally_is_told(const wh_tally_row_t *row) {
    return !row->is_implied || row->bad > 0;
}

wh_tally_row_t *wh_tally_row(wh_tally_rows_t *rows, const wh_tally_row_t *key, const char *text,
                             uint64_t named) {
    wh_tally_row_t *row = find_row(rows, key, text);
    if (!row) {
        rows->rows = wh_array_grow(rows->rows, rows->count, &rows->capacity, sizeof *rows->rows);
        row = &rows->rows[rows->count++];
        *row = (wh_tally_row_t){.line = key->line,
                                .is_implied = key->is_implied,
                                .place = key->place,
                                .named = WH_TALLY_NO_TRIAL,
                                .first = WH_TALLY_NO_TRIAL,
                                .last = WH_TALLY_NO_TRIAL};
    }
    if (!row->text || named < row->named) {
        free(row->text);
        row->text = wh_text_copy(text);
        row->named = named;
    }
    return row;
}

/* Counts each trial once, even if a loop reaches the line again. */
static void count_row(wh_tally_row_t *row, uint64_t trial, bool bad) {
    row->seen += row->last == trial ? 0 : 1;
    row->last = trial;
    if (bad) {
        ++row->bad;
        row->first = trial < row->first ? trial : row->first;
    }
}

/* How many expectations of its kind precede this one in its line. `before` is the place of the one before
 * it. */
static int place_of(const wh_expectation_record_t expected[], size_t index, int before) {
    const wh_expectation_record_t *it = &expected[index];
    if (index > 0 && it[-1].line == it->line && it[-1].is_implied == it->is_implied) {
        return before + 1;
    }
    int place = 0;
    for (size_t i = 0; i < index; ++i) {
        place += expected[i].line == it->line && expected[i].is_implied == it->is_implied ? 1 : 0;
    }
    return place;
}

/* The row of an expectation: its name tells nothing that one trial alone has found. */
static wh_tally_row_t *expectation_row(wh_tally_t *tally, const wh_tally_row_t *key,
                                       const wh_expectation_record_t *expected, uint64_t trial) {
    if (expected->name == 0) {
        return wh_tally_row(&tally->expectations, key, expected->text, trial);
    }
    char *name = wh_text_copy(expected->text);
    name[expected->name] = '\0';
    wh_tally_row_t *row = wh_tally_row(&tally->expectations, key, name, trial);
    free(name);
    return row;
}

/* Implied ones are counted from the record's `implied`, which also has those that were met. */
static void add_expectations(wh_tally_t *tally, uint64_t trial, const wh_expectation_record_t expected[],
                             size_t count, bool is_implied) {
    int place = 0;
    for (size_t i = 0; i < count; ++i) {
        place = place_of(expected, i, place);
        if (expected[i].is_implied == is_implied) {
            const wh_tally_row_t key = {.line = expected[i].line, .is_implied = is_implied, .place = place};
            wh_tally_row_t *row = expectation_row(tally, &key, &expected[i], trial);
            count_row(row, trial, !expected[i].ok);
        }
    }
}

static void add_errors(wh_tally_t *tally, const wh_outcome_t *outcome) {
    const wh_record_t *record = outcome->record;
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        if (command->error != WH_OK) {
            const wh_tally_row_t key = {.line = command->line, .place = (int)command->error};
            wh_tally_row_t *row = wh_tally_row(&tally->errors, &key, command->text, outcome->trial);
            count_row(row, outcome->trial, row->last != outcome->trial);
        }
    }
}

static void merge_rows(wh_tally_rows_t *rows, const wh_tally_rows_t *others) {
    for (size_t i = 0; i < others->count; ++i) {
        const wh_tally_row_t *other = &others->rows[i];
        wh_tally_row_t *row = wh_tally_row(rows, other, other->text, other->named);
        row->seen += other->seen;
        row->bad += other->bad;
        row->first = other->first < row->first ? other->first : row->first;
    }
}

static int compare_rows(const void *a, const void *b) {
    const wh_tally_row_t *one = a;
    const wh_tally_row_t *other = b;
    const int lines = (one->line > other->line) - (one->line < other->line);
    const int kinds = (int)other->is_implied - (int)one->is_implied;
    const int places = (one->place > other->place) - (one->place < other->place);
    return lines != 0 ? lines : kinds != 0 ? kinds : places != 0 ? places : strcmp(one->text, other->text);
}

static void sort_rows(wh_tally_rows_t *rows) {
    if (rows->count > 0) {
        qsort(rows->rows, rows->count, sizeof *rows->rows, compare_rows);
    }
}

void wh_tally_sort(wh_tally_t *tally) {
    sort_rows(&tally->expectations);
    sort_rows(&tally->errors);
    wh_trial_lines_sort(&tally->lines);
}

/* ------------------------------------------------------------------------------------------------- wafers */

static bool is_there(const wh_study_wafer_t *wafer, const wh_study_wafer_t *nominal) {
    return wafer->place.station == nominal->place.station && wafer->place.slot == nominal->place.slot &&
           wafer->holder == nominal->holder;
}

/* How far off the wafer ends; infinite if it is elsewhere. `ends` gets the values for the sums; false, and it
 * is unchanged, if there are none. */
static bool add_wafer(wh_tally_wafer_t *tally, const wh_study_wafer_t *wafer, const wh_study_wafer_t *nominal,
                      double ends[WH_TALLY_QUANTITIES], double *off) {
    *off = 0;
    if (!is_there(wafer, nominal)) {
        ++tally->elsewhere;
        *off = (double)INFINITY;
        return false;
    }
    const wh_place_t *place = &wafer->place;
    if (place->station == WH_NONE) {
        return false;
    }
    const double dx = place->dx - nominal->place.dx;
    const double dy = place->dy - nominal->place.dy;
    ends[WH_TALLY_DX] = dx;
    ends[WH_TALLY_DY] = dy;
    ends[WH_TALLY_DZ] = place->dz - nominal->place.dz;
    ends[WH_TALLY_TILT] = wh_deg_from_rad(place->tilt) - wh_deg_from_rad(nominal->place.tilt);
    ends[WH_TALLY_OFF] = *off = sqrt(dx * dx + dy * dy);
    for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
        wh_sum_add(&tally->of[q], ends[q]);
    }
    return true;
}

static void merge_wafers(wh_tally_t *tally, const wh_tally_t *other) {
    for (size_t w = 0; w < tally->wafer_count; ++w) {
        tally->wafers[w].elsewhere += other->wafers[w].elsewhere;
        for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
            wh_sum_merge(&tally->wafers[w].of[q], &other->wafers[w].of[q]);
        }
    }
}

/* -------------------------------------------------------------------------------------------------- worst */

/* The makespan of its flow; one without its end is the slowest. */
static double slowness_of(const wh_tally_trial_t *trial) {
    const double makespan_s = trial->flow[WH_FLOW_SUM_MAKESPAN];
    return isnan(makespan_s) ? HUGE_VAL : makespan_s;
}

static bool is_worse(const wh_tally_trial_t *one, const wh_tally_trial_t *other) {
    if (one->met != other->met) {
        return !one->met;
    }
    if (one->off > other->off || one->off < other->off) {
        return one->off > other->off;
    }
    const double one_s = slowness_of(one), other_s = slowness_of(other);
    if (one_s > other_s || one_s < other_s) {
        return one_s > other_s;
    }
    return one->trial < other->trial;
}

void wh_tally_note_worst(wh_tally_t *tally, const wh_tally_trial_t *trial) {
    if (tally->worst_count == WH_STUDY_WORST && !is_worse(trial, &tally->worst[WH_STUDY_WORST - 1])) {
        return;
    }
    size_t place = tally->worst_count < WH_STUDY_WORST ? tally->worst_count++ : WH_STUDY_WORST - 1;
    while (place > 0 && is_worse(trial, &tally->worst[place - 1])) {
        tally->worst[place] = tally->worst[place - 1];
        --place;
    }
    tally->worst[place] = *trial;
}

/* --------------------------------------------------------------------------------------------------- flow */

/* A flow counts as two wafers more, behind the others: one has its makespan for an end, the other one cycle
 * and rate. */
#define FLOW_ENDS 2

void wh_tally_need_relations(wh_tally_t *tally, const wh_study_t *study) {
    const size_t aside = study->has_flow ? FLOW_ENDS : 0;
    const size_t wafers = wh_relations_wafers(study->cause_count, study->wafer_count + aside);
    tally->flow_at = aside > 0 && wafers == study->wafer_count + aside ? study->wafer_count : SIZE_MAX;
    wh_relations_need(&tally->relations, study->cause_count, wafers);
}

static void relate_flow(wh_tally_t *tally, const wh_study_t *study, const double figures[]) {
    double ends[FLOW_ENDS][WH_RELATION_ENDS] = {{0}};
    if (tally->flow_at == SIZE_MAX) {
        return;
    }
    for (size_t i = 0; i < WH_FLOW_SUM_RELATED; ++i) {
        const size_t end = i == WH_FLOW_SUM_MAKESPAN ? 0 : 1;
        ends[end][i - end] = wh_flow_sums_aside(figures, study->flow, (wh_flow_sum_t)i);
    }
    for (size_t i = 0; i < FLOW_ENDS; ++i) {
        if (!isnan(ends[i][0])) {
            wh_relations_add_wafer(&tally->relations, tally->flow_at + i, ends[i]);
        }
    }
}

wh_correlation_t wh_tally_relate(const wh_tally_t *tally, size_t cause, wh_flow_sum_t figure) {
    const wh_correlation_t unknown = {false, 0, 0, 0};
    const size_t end = figure == WH_FLOW_SUM_MAKESPAN ? 0 : 1;
    return tally->flow && tally->flow_at != SIZE_MAX && cause < tally->relations.cause_count
               ? wh_relations_end(&tally->relations, cause, tally->flow_at + end, (size_t)figure - end,
                                  &tally->flow->of[figure])
               : unknown;
}

/* ------------------------------------------------------------------------------------------- all together */

static void add_events(wh_tally_t *tally, const wh_outcome_t *outcome) {
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        tally->events[kind].trials += outcome->events[kind] > 0 ? 1 : 0;
        tally->events[kind].total += outcome->events[kind];
    }
}

static void add_wafers(wh_tally_t *tally, const wh_study_t *study, const wh_outcome_t *outcome,
                       wh_trial_line_t *line) {
    for (size_t w = 0; w < study->wafer_count; ++w) {
        double ends[WH_TALLY_QUANTITIES];
        double off;
        const bool is_there =
            add_wafer(&tally->wafers[w], &outcome->wafers[w], &study->wafers[w], ends, &off);
        if (w < tally->relations.wafer_count && is_there) {
            wh_relations_add_wafer(&tally->relations, w, ends);
        }
        line->off = off > line->off ? off : line->off;
        line->elsewhere += isfinite(off) ? 0 : 1;
    }
}

/* The error that ends a trial is its last one. */
static void note_error(const wh_command_record_t *command, wh_trial_line_t *line) {
    if (line->ended || line->error == 0) {
        line->error = (uint32_t)command->error;
        line->error_line = (uint32_t)command->line;
    }
}

static void count_troubles(const wh_outcome_t *outcome, wh_trial_line_t *line) {
    const wh_record_t *record = outcome->record;
    for (size_t i = 0; i < record->expectation_count; ++i) {
        if (!record->expectations[i].ok) {
            line->missed_line =
                line->missed == 0 ? (uint32_t)record->expectations[i].line : line->missed_line;
            ++line->missed;
        }
    }
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        if (command->error != WH_OK) {
            ++line->errors;
            note_error(command, line);
        }
    }
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        if (wh_record_is_complaint((wh_event_kind_t)kind) && outcome->events[kind] > 0) {
            line->complaints += outcome->events[kind];
            line->kinds |= UINT32_C(1) << kind;
        }
    }
}

static void add_line(wh_tally_t *tally, const wh_study_t *study, const wh_outcome_t *outcome,
                     const wh_trial_line_t *line) {
    double *ends = wh_trial_lines_add(&tally->lines, line, study->wafer_count);
    for (size_t w = 0; w < study->wafer_count; ++w) {
        const wh_place_t *place = &outcome->wafers[w].place;
        const bool lies = is_there(&outcome->wafers[w], &study->wafers[w]) && place->station != WH_NONE;
        const double values[WH_TRIAL_LINE_ENDS] = {place->dx, place->dy, place->dz,
                                                   wh_deg_from_rad(place->tilt)};
        for (size_t e = 0; e < WH_TRIAL_LINE_ENDS; ++e) {
            ends[w * WH_TRIAL_LINE_ENDS + e] = lies ? values[e] : (double)NAN;
        }
    }
}

static bool is_any_clipped(const wh_study_t *study, const wh_flow_t *flow, const double drawn[]) {
    bool is_any = false;
    for (size_t i = 0; i < study->cause_count; ++i) {
        is_any = is_any || (study->causes[i].kind == WH_CAUSE_PROCESS &&
                            wh_flow_sums_clips(flow, study->causes[i].index, drawn[i]));
    }
    return is_any;
}

void wh_tally_add(wh_tally_t *tally, const wh_study_t *study, const wh_outcome_t *outcome) {
    const wh_record_t *record = outcome->record;
    wh_trial_line_t line = {.trial = outcome->trial,
                            .met = outcome->met,
                            .whole = outcome->whole,
                            .ended = record->failure != NULL};
    const bool is_steady = wh_flow_sums_read(record->flow, line.flow);
    const wh_trial_t name = {study->seed, outcome->trial};
    ++tally->trials;
    tally->met += line.met ? 1 : 0;
    tally->whole += line.whole ? 1 : 0;
    tally->ended += line.ended ? 1 : 0;
    add_events(tally, outcome);
    add_expectations(tally, outcome->trial, record->expectations, record->expectation_count, false);
    add_expectations(tally, outcome->trial, record->implied, record->implied_count, true);
    add_errors(tally, outcome);
    wh_tally_need_relations(tally, study);
    wh_causes_draw(study->causes, study->cause_count, study->layout, &name, tally->relations.drawn);
    wh_relations_add(&tally->relations, !line.met);
    add_wafers(tally, study, outcome, &line);
    if (study->has_flow) {
        wh_flow_sums_add(wh_tally_need_flow(tally), line.flow, study->flow, is_steady,
                         is_any_clipped(study, record->flow, tally->relations.drawn));
        relate_flow(tally, study, line.flow);
    }
    count_troubles(outcome, &line);
    if (outcome->trial < study->lines) {
        add_line(tally, study, outcome, &line);
    }
    wh_tally_note_worst(tally, &line);
}

void wh_tally_merge(wh_tally_t *tally, const wh_tally_t *other) {
    tally->trials += other->trials;
    tally->met += other->met;
    tally->ended += other->ended;
    tally->whole += other->whole;
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        tally->events[kind].trials += other->events[kind].trials;
        tally->events[kind].total += other->events[kind].total;
    }
    merge_rows(&tally->expectations, &other->expectations);
    merge_rows(&tally->errors, &other->errors);
    merge_wafers(tally, other);
    if (other->flow) {
        wh_flow_sums_merge(wh_tally_need_flow(tally), other->flow);
    }
    tally->flow_at = other->flow_at != SIZE_MAX ? other->flow_at : tally->flow_at;
    wh_relations_merge(&tally->relations, &other->relations);
    wh_trial_lines_merge(&tally->lines, &other->lines);
    for (size_t i = 0; i < other->worst_count; ++i) {
        wh_tally_note_worst(tally, &other->worst[i]);
    }
}
