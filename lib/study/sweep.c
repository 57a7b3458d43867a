#include "sweep.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "../record/throughput.h"
#include "../text/array.h"
#include "../text/interrupt.h"

#define REASON_BYTES 1100

/* ------------------------------------------------------------------------------------------------- ranges */

static bool refuse(const char *parameter, const char *why) {
    fprintf(stderr, "--set %s: %s\n", parameter, why);
    return false;
}

/* True if the text is meant as a range: two colons behind the '=', the first after a number. */
static bool is_range(const char *parameter) {
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
        return refuse(parameter, "no range (expected NAME=START:STEP:END, three numbers)");
    }
    /* The end belongs to the range although a step such as 0.1 is rounded. */
    const double steps = floor((numbers[2] - numbers[0]) / numbers[1] + 1e-9);
    if (!isfinite(steps) || steps < 0) {
        return refuse(parameter, "the step does not lead to the end (expected one that does)");
    }
    if (steps >= WH_SWEEP_MOST) {
        return refuse(parameter, "too many values (expected at most 10000 runs)");
    }
    wh_sweep_axis_t *axis = &sweep->axes[sweep->axis_count++];
    *axis = (wh_sweep_axis_t){wh_text_copy(parameter), numbers[0], numbers[1], numbers[2], (size_t)steps + 1};
    axis->name[length] = '\0';
    return true;
}

bool wh_sweep_open(wh_script_sweep_t *sweep) {
    sweep->axes = wh_array_new(sweep->parameter_count, sizeof *sweep->axes);
    sweep->point_count = 1;
    for (size_t i = 0; i < sweep->parameter_count; ++i) {
        if (!is_range(sweep->parameters[i])) {
            continue;
        }
        if (sweep->axis_count == WH_SWEEP_AXES) {
            return refuse(sweep->parameters[i], "too many ranges (expected at most 4)");
        }
        if (!add_axis(sweep, sweep->parameters[i])) {
            return false;
        }
        sweep->point_count *= sweep->axes[sweep->axis_count - 1].count;
        if (sweep->point_count > WH_SWEEP_MOST) {
            return refuse(sweep->parameters[i], "too many combinations (expected at most 10000 runs)");
        }
    }
    if (sweep->axis_count == 0) {
        fprintf(stderr, "waferhand sweep: over which values? (expected --set NAME=START:STEP:END)\n");
        return false;
    }
    sweep->points = wh_array_new(sweep->point_count, sizeof *sweep->points);
    return true;
}

void wh_sweep_close(wh_script_sweep_t *sweep) {
    for (size_t i = 0; i < sweep->axis_count; ++i) {
        free(sweep->axes[i].name);
    }
    for (size_t i = 0; sweep->points && i < sweep->point_count; ++i) {
        free(sweep->points[i].reason);
        free(sweep->points[i].never_came);
    }
    free(sweep->axes);
    free(sweep->points);
}

double wh_sweep_value(const wh_script_sweep_t *sweep, size_t point, size_t axis) {
    for (size_t i = sweep->axis_count - 1; i > axis; --i) {
        point /= sweep->axes[i].count;
    }
    const wh_sweep_axis_t *of = &sweep->axes[axis];
    char text[WH_SWEEP_VALUE];
    wh_sweep_text(of->start + of->step * (double)(point % of->count), text);
    return strtod(text, NULL);
}

void wh_sweep_text(double value, char text[WH_SWEEP_VALUE]) {
    (void)snprintf(text, WH_SWEEP_VALUE, "%.12g", fabs(value) > 0 ? value : 0.0);
}

/* --------------------------------------------------------------------------------------------- one thread */

typedef struct {
    wh_script_sweep_t *sweep;
    size_t next; /* the first run that no thread has taken; an atomic */
} crew_t;

/* The parameters of a run: to be freed, each of them too. */
static char **parameters_of(const wh_script_sweep_t *sweep, size_t point) {
    char **made = wh_array_new(sweep->parameter_count, sizeof *made);
    size_t axis = 0;
    for (size_t i = 0; i < sweep->parameter_count; ++i) {
        if (!is_range(sweep->parameters[i])) {
            made[i] = wh_text_copy(sweep->parameters[i]);
            continue;
        }
        char value[WH_SWEEP_VALUE];
        const char *name = sweep->axes[axis].name;
        const size_t size = strlen(name) + sizeof value + 2;
        wh_sweep_text(wh_sweep_value(sweep, point, axis++), value);
        made[i] = wh_array_new(size, 1);
        (void)snprintf(made[i], size, "%s=%s", name, value);
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
    point->is_cut = record->flow && wh_flow_is_cut(record->flow);
    for (size_t i = 0; record->ok && i < record->command_count; ++i) {
        point->caught = point->caught || record->commands[i].error != WH_OK;
    }
}

static void measure(const wh_record_t *record, wh_sweep_point_t *point) {
    const wh_throughput_t throughput = wh_throughput(record);
    point->simulated_s = record->simulated_s;
    point->hash = record->hash;
    if (throughput.figure == WH_FIGURE_GIVEN) {
        point->wafers_per_hour = throughput.wafers_per_hour;
    }
    measure_picks(record, point);
    note(record, point);
    for (size_t kind = 0; record->checked && kind < WH_CLEARANCES; ++kind) {
        point->gap = record->clearances[kind].parts[0] == WH_NONE
                         ? point->gap
                         : fmin(point->gap, record->clearances[kind].gap);
    }
}

static void judge(const wh_script_run_t *run, wh_script_run_outcome_t outcome, wh_sweep_point_t *point) {
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

static void play(const wh_script_sweep_t *sweep, size_t i, wh_script_run_t *run) {
    wh_sweep_point_t *point = &sweep->points[i];
    wh_script_run_options_t options = sweep->run;
    char **parameters = parameters_of(sweep, i);
    options.parameters = (const char *const *)parameters;
    options.parameter_count = sweep->parameter_count;
    const double none = HUGE_VAL;
    *point = (wh_sweep_point_t){
        .simulated_s = none, .wafers_per_hour = none, .projz = none, .projxy = none, .gap = none};
    const wh_script_run_outcome_t outcome = wh_script_run(run, &options);
    if (outcome != WH_RUN_BAD_INPUT) {
        measure(&run->record, point);
    }
    judge(run, outcome, point);
    wh_script_run_close(run);
    for (size_t k = 0; k < sweep->parameter_count; ++k) {
        free(parameters[k]);
    }
    free(parameters);
}

static void *work(void *argument) {
    crew_t *crew = argument;
    wh_script_run_t *run = wh_array_new(1, sizeof *run);
    size_t i = __atomic_fetch_add(&crew->next, 1, __ATOMIC_RELAXED);
    while (i < crew->sweep->point_count && !wh_interrupt_came()) {
        play(crew->sweep, i, run);
        i = __atomic_fetch_add(&crew->next, 1, __ATOMIC_RELAXED);
    }
    free(run);
    return NULL;
}

bool wh_sweep_play(wh_script_sweep_t *sweep, size_t threads) {
    crew_t crew = {sweep, 0};
    const size_t wanted = threads < sweep->point_count ? threads : sweep->point_count;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        sweep->points[i].verdict = WH_SWEEP_UNDONE;
    }
    wh_interrupt_catch();
    pthread_t *started = wh_array_new(wanted, sizeof *started);
    size_t count = 0;
    while (count < wanted && pthread_create(&started[count], NULL, work, &crew) == 0) {
        ++count;
    }
    for (size_t i = 0; i < count; ++i) {
        pthread_join(started[i], NULL);
    }
    free(started);
    if (count == 0) {
        fprintf(stderr, "waferhand sweep: no thread for it\n");
    }
    return count > 0;
}
