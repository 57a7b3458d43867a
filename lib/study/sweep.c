#include "sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../flow/waits.h"
#include "../record/throughput.h"
#include "../text/array.h"
#include "crew.h"

#define REASON_BYTES 1100

/* ------------------------------------------------------------------------------------------------- ranges */

static bool refuse_parameter(const char *parameter, const char *why) {
    fprintf(stderr, "--set %s: %s\n", parameter, why);
    return false;
}

bool wh_sweep_is_range(const char *parameter) {
    const char *value = strchr(parameter, '=');
    char *end = NULL;
    if (!value) {
        return false;
    }
    (void)strtod(value + 1, &end);
    return end != value + 1 && *end == ':' && strchr(end + 1, ':');
}

/* Three finite numbers with colons between them, and nothing else. */
static bool take_numbers(const char *text, double numbers[3]) {
    static const char after[] = {':', ':', '\0'};
    for (size_t i = 0; i < 3; ++i) {
        char *end = NULL;
        numbers[i] = strtod(text, &end);
        if (end == text || *end != after[i] || !isfinite(numbers[i])) {
            return false;
        }
        text = end + 1;
    }
    return true;
}

static bool add_axis(wh_script_sweep_t *sweep, const char *parameter) {
    const size_t length = strcspn(parameter, "=");
    double numbers[3];
    if (!take_numbers(parameter + length + 1, numbers)) {
        return refuse_parameter(parameter, "no range (expected NAME=START:STEP:END, three numbers)");
    }
    /* The end belongs to the range although a step such as 0.1 is rounded. */
    const double steps = floor((numbers[2] - numbers[0]) / numbers[1] + 1e-9);
    if (!isfinite(steps) || steps < 0) {
        return refuse_parameter(parameter, "the step does not lead to the end (expected one that does)");
    }
    if (steps >= WH_SWEEP_MOST) {
        return refuse_parameter(parameter, "too many values (expected at most 10000 runs)");
    }
    wh_sweep_axis_t *axis = &sweep->axes[sweep->axis_count++];
    *axis = (wh_sweep_axis_t){wh_text_copy(parameter), numbers[0], numbers[1], numbers[2],
                              (size_t)steps + 1,       NULL};
    axis->name[length] = '\0';
    return true;
}

/* ------------------------------------------------------------------------------------------------- values */

static bool refuse_each(const char *each, const char *why) {
    fprintf(stderr, "--each %s: %s\n", each, why);
    return false;
}

/* Splits the values behind the '='; false if there are none, or an empty one. */
static bool take_words(wh_sweep_axis_t *axis, const char *values) {
    char *text = wh_text_copy(values);
    bool is_sound = true;
    axis->words = wh_array_new(strlen(values) + 1, sizeof *axis->words);
    for (char *word = text; word && is_sound;) {
        char *comma = strchr(word, ',');
        if (comma) {
            *comma = '\0';
        }
        is_sound = word[0] != '\0';
        axis->words[axis->count++] = wh_text_copy(word);
        word = comma ? comma + 1 : NULL;
    }
    free(text);
    return is_sound;
}

static bool add_each(wh_script_sweep_t *sweep, const char *each) {
    const size_t length = strcspn(each, "=");
    if (length == 0 || each[length] == '\0') {
        return refuse_each(each, "no values (expected NAME=A,B,C)");
    }
    wh_sweep_axis_t *axis = &sweep->axes[sweep->axis_count++];
    *axis = (wh_sweep_axis_t){.name = wh_text_copy(each)};
    axis->name[length] = '\0';
    if (!take_words(axis, each + length + 1)) {
        return refuse_each(each, "an empty value (expected NAME=A,B,C)");
    }
    return true;
}

/* The axis that was added last makes so many more runs. */
static bool multiply(wh_script_sweep_t *sweep, const char *option, const char *text) {
    sweep->point_count *= sweep->axes[sweep->axis_count - 1].count;
    if (sweep->point_count > WH_SWEEP_MOST) {
        fprintf(stderr, "%s %s: too many combinations (expected at most 10000 runs)\n", option, text);
        return false;
    }
    return true;
}

/* One more axis has room. */
static bool has_room(const wh_script_sweep_t *sweep, const char *option, const char *text) {
    if (sweep->axis_count == WH_SWEEP_AXES) {
        fprintf(stderr, "%s %s: too many ranges (expected at most 4)\n", option, text);
    }
    return sweep->axis_count < WH_SWEEP_AXES;
}

static bool add_range(wh_script_sweep_t *sweep, const char *text) {
    return has_room(sweep, "--set", text) && add_axis(sweep, text) && multiply(sweep, "--set", text);
}

static bool add_values(wh_script_sweep_t *sweep, const char *text) {
    return has_room(sweep, "--each", text) && add_each(sweep, text) && multiply(sweep, "--each", text);
}

bool wh_sweep_open(wh_script_sweep_t *sweep) {
    bool is_sound = true;
    sweep->axes = wh_array_new(WH_SWEEP_AXES, sizeof *sweep->axes);
    sweep->point_count = 1;
    for (size_t i = 0; i < sweep->parameter_count && is_sound; ++i) {
        is_sound = !wh_sweep_is_range(sweep->parameters[i]) || add_range(sweep, sweep->parameters[i]);
    }
    for (size_t i = 0; i < sweep->each_count && is_sound; ++i) {
        is_sound = add_values(sweep, sweep->each[i]);
    }
    if (is_sound && sweep->axis_count == 0) {
        fprintf(stderr, "waferhand sweep: over which values? (expected --set NAME=START:STEP:END, "
                        "--each NAME=A,B,C or --by PERCENT)\n");
        is_sound = false;
    }
    sweep->points = is_sound ? wh_array_new(sweep->point_count, sizeof *sweep->points) : NULL;
    return is_sound;
}

void wh_sweep_close(wh_script_sweep_t *sweep) {
    for (size_t i = 0; i < sweep->axis_count; ++i) {
        for (size_t k = 0; sweep->axes[i].words && k < sweep->axes[i].count; ++k) {
            free(sweep->axes[i].words[k]);
        }
        free(sweep->axes[i].words);
        free(sweep->axes[i].name);
    }
    for (size_t i = 0; sweep->points && i < sweep->point_count; ++i) {
        wh_sweep_point_free(&sweep->points[i]);
    }
    free(sweep->axes);
    free(sweep->points);
}

/* The number of a run's value on an axis. */
static size_t index_of(const wh_script_sweep_t *sweep, size_t point, size_t axis) {
    for (size_t i = sweep->axis_count - 1; i > axis; --i) {
        point /= sweep->axes[i].count;
    }
    return point % sweep->axes[axis].count;
}

double wh_sweep_value(const wh_script_sweep_t *sweep, size_t point, size_t axis) {
    const wh_sweep_axis_t *of = &sweep->axes[axis];
    const size_t index = index_of(sweep, point, axis);
    char text[WH_SWEEP_VALUE];
    if (of->words) {
        return (double)index + 1;
    }
    wh_sweep_text(of->start + of->step * (double)index, text);
    return strtod(text, NULL);
}

void wh_sweep_text(double value, char text[WH_SWEEP_VALUE]) {
    (void)snprintf(text, WH_SWEEP_VALUE, "%.12g", fabs(value) > 0 ? value : 0.0);
}

const char *wh_sweep_word(const wh_script_sweep_t *sweep, size_t point, size_t axis,
                          char text[WH_SWEEP_VALUE]) {
    const wh_sweep_axis_t *of = &sweep->axes[axis];
    if (of->words) {
        return of->words[index_of(sweep, point, axis)];
    }
    wh_sweep_text(wh_sweep_value(sweep, point, axis), text);
    return text;
}

/* ------------------------------------------------------------------------------------------------ one run */

/* The parameters of a run: to be freed, each of them too. */
static char **parameters_of(const wh_script_sweep_t *sweep, size_t point, size_t *count) {
    char **made = wh_array_new(sweep->parameter_count + sweep->axis_count, sizeof *made);
    *count = 0;
    for (size_t i = 0; i < sweep->parameter_count; ++i) {
        if (!wh_sweep_is_range(sweep->parameters[i])) {
            made[(*count)++] = wh_text_copy(sweep->parameters[i]);
        }
    }
    for (size_t axis = 0; axis < sweep->axis_count; ++axis) {
        char number[WH_SWEEP_VALUE];
        const char *word = wh_sweep_word(sweep, point, axis, number);
        const size_t size = strlen(sweep->axes[axis].name) + strlen(word) + 2;
        made[*count] = wh_array_new(size, 1);
        (void)snprintf(made[(*count)++], size, "%s=%s", sweep->axes[axis].name, word);
    }
    return made;
}

/* How near the picks came to their limits. */
static void measure_picks(const wh_record_t *record, wh_sweep_point_t *point) {
    for (size_t i = 0; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        if (event->kind == WH_EVENT_PICKED) {
            const double projz = fabs(event->measured.dr_proj_z);
            const double projxy = event->measured.dr_proj_xy_norm;
            point->projz = isfinite(point->projz) ? fmax(point->projz, projz) : projz;
            point->projxy = isfinite(point->projxy) ? fmax(point->projxy, projxy) : projxy;
        }
    }
}

/* The words about the run that go beside its figures. */
static void note(const wh_record_t *record, wh_sweep_point_t *point) {
    point->checked = record->checked;
    point->never_came = record->never_came ? wh_text_copy(record->never_came) : NULL;
    point->is_timed = wh_record_is_timed(record);
    point->has_timed = record->times_alone != NULL;
    point->is_cut = record->flow && wh_flow_is_cut(record->flow);
    for (size_t i = 0; record->ok && i < record->command_count; ++i) {
        point->caught = point->caught || record->commands[i].error != WH_OK;
    }
}

/* "PM1 97.3 %". */
static char *tell_busiest(const wh_flow_t *flow) {
    const wh_flow_busy_t busiest = wh_flow_busiest(&flow->figures);
    char text[WH_NAME_SIZE + 20];
    if (busiest.robot == WH_FLOW_NONE && busiest.station == WH_FLOW_NONE) {
        return NULL;
    }
    (void)snprintf(text, sizeof text, "%s %.1f %%",
                   busiest.robot == WH_FLOW_NONE ? flow->tool->stations[busiest.station].name
                                                 : flow->tool->robots[busiest.robot].name,
                   100 * busiest.share);
    return wh_text_copy(text);
}

/* The steady rate, if there is one. */
static void measure_flow(const wh_flow_t *flow, wh_sweep_point_t *point) {
    const wh_flow_result_t *result = &flow->figures.result;
    point->busiest = tell_busiest(flow);
    if (result->period > 0) {
        point->wafers_per_hour = 3.6e9 * result->period / (double)result->cycle_us;
    }
}

/* Stays beyond windows: as stations in a cell with axes told them, or as the flow did. */
static void count_late(const wh_record_t *record, wh_sweep_point_t *point) {
    size_t told = 0;
    for (size_t i = 0; i < record->station_event_count; ++i) {
        told += record->station_events[i].event.kind == WH_CLOCK_LATE ? 1 : 0;
    }
    const size_t counted = record->flow ? record->flow->figures.stays.late_count : 0;
    point->late = counted > told ? counted : told;
    point->lost = record->flow ? record->flow->figures.result.lost : 0;
}

bool wh_sweep_may_lead(const wh_sweep_point_t *point) {
    return point->verdict == WH_SWEEP_OK && point->late == 0 && point->lost == 0 &&
           (!point->is_cut || isfinite(point->wafers_per_hour));
}

static void measure(const wh_record_t *record, wh_sweep_point_t *point) {
    const wh_throughput_t throughput = wh_throughput(record);
    point->simulated_s = record->simulated_s;
    point->hash = record->hash;
    if (record->flow) {
        measure_flow(record->flow, point);
    } else if (throughput.figure == WH_FIGURE_GIVEN) {
        point->wafers_per_hour = throughput.wafers_per_hour;
    }
    measure_picks(record, point);
    count_late(record, point);
    note(record, point);
    for (size_t kind = 0; record->checked && kind < WH_CLEARANCES; ++kind) {
        point->gap = record->clearances[kind].parts[0] == WH_NONE
                         ? point->gap
                         : fmin(point->gap, record->clearances[kind].gap);
    }
}

static void judge_point(const wh_script_run_t *run, wh_script_run_outcome_t outcome,
                        wh_sweep_point_t *point) {
    const wh_record_t *record = &run->record;
    char reason[REASON_BYTES] = "";
    if (outcome == WH_RUN_BAD_INPUT) {
        point->verdict = WH_SWEEP_BAD;
        (void)snprintf(reason, sizeof reason, "%.1023s", run->message);
    } else if (outcome == WH_RUN_FAILED) {
        point->verdict = WH_SWEEP_FAILED;
        wh_record_reason(record, reason, sizeof reason);
    } else if (wh_record_played_nothing(record) && record->expectation_count == 0) {
        point->verdict = WH_SWEEP_FAILED;
        (void)snprintf(reason, sizeof reason, "%s", WH_RECORD_IDLE);
    }
    point->reason = reason[0] != '\0' ? wh_text_copy(reason) : NULL;
}

void wh_sweep_point_play(const wh_script_run_options_t *options, wh_script_run_t *run,
                         wh_sweep_point_t *point) {
    const double none = HUGE_VAL;
    *point = (wh_sweep_point_t){
        .simulated_s = none, .wafers_per_hour = none, .projz = none, .projxy = none, .gap = none};
    const wh_script_run_outcome_t outcome = wh_script_run(run, options);
    if (outcome != WH_RUN_BAD_INPUT) {
        measure(&run->record, point);
    }
    judge_point(run, outcome, point);
}

void wh_sweep_point_free(wh_sweep_point_t *point) {
    free(point->reason);
    free(point->never_came);
    free(point->busiest);
}

static void play(void *user, size_t i, wh_script_run_t *run) {
    wh_script_sweep_t *sweep = user;
    wh_script_run_options_t options = sweep->run;
    size_t count = 0;
    char **parameters = parameters_of(sweep, i, &count);
    options.parameters = (const char *const *)parameters;
    options.parameter_count = count;
    wh_sweep_point_play(&options, run, &sweep->points[i]);
    wh_script_run_close(run);
    for (size_t k = 0; k < count; ++k) {
        free(parameters[k]);
    }
    free(parameters);
}

bool wh_sweep_play(wh_script_sweep_t *sweep, size_t threads) {
    for (size_t i = 0; i < sweep->point_count; ++i) {
        sweep->points[i].verdict = WH_SWEEP_UNDONE;
    }
    return wh_crew_play(sweep->point_count, threads, play, sweep);
}
