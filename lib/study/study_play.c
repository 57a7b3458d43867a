#include "study_play.h"

#include <errno.h>
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../math/hash.h"
#include "../text/array.h"
#include "../text/clock.h"
#include "../text/guard.h"
#include "../text/interrupt.h"
#include "../text/output.h"
#include "../text/style.h"
#include "checkpoint.h"
#include "concerns.h"

/* The progress is kept at this interval in seconds, or less often, so that keeping takes at most a 20th of
 * the time. */
#define KEEP_S 1.0
#define KEEP_SHARE 20

#define MOST_THREADS 1024

/* The width of the bar. */
#define CELLS 30

/* ---------------------------------------------------------------------------------- what all trials share */

static bool refuse_script(const char *path, const char *text) {
    fprintf(stderr, "%s: %s\n", path, text);
    return false;
}

/* 0: it cannot be read. */
static uint64_t hash_file(const char *path) {
    FILE *file = fopen(path, "r");
    uint64_t hash = file ? WH_HASH_START : 0;
    if (file) {
        for (int c = fgetc(file); c != EOF; c = fgetc(file)) {
            hash = wh_hash_word(hash, (uint64_t)c);
        }
        fclose(file);
    }
    return hash;
}

static void add_input(void *user, const char *path) {
    wh_study_t *study = user;
    for (size_t i = 0; i < study->input_count; ++i) {
        if (strcmp(study->inputs[i].path, path) == 0) {
            return;
        }
    }
    study->inputs =
        wh_array_grow(study->inputs, study->input_count, &study->input_capacity, sizeof *study->inputs);
    study->inputs[study->input_count++] = (wh_study_input_t){wh_text_copy(path), hash_file(path)};
}

static bool is_known(const wh_study_t *study, int32_t wafer) {
    bool known = false;
    for (size_t i = 0; i < study->wafer_count; ++i) {
        known = known || study->wafers[i].wafer == wafer;
    }
    return known;
}

/* The wafers that the run without errors takes, in that order. */
static void choose_wafers(wh_study_t *study) {
    const wh_record_t *record = &study->nominal.record;
    for (size_t i = 0; i < record->event_count && study->wafer_count < WH_STUDY_WAFERS; ++i) {
        const wh_event_t *event = &record->events[i].event;
        if (event->kind == WH_EVENT_PICKED && event->wafer != WH_NONE && !is_known(study, event->wafer)) {
            const wh_wafer_record_t *end = &record->wafers[event->wafer];
            study->wafers[study->wafer_count++] = (wh_study_wafer_t){event->wafer, end->holder, end->place};
        }
    }
}

/* False, and standard error says so, if each trial's line is wanted and there would be too many. */
static bool choose_lines(wh_study_t *study) {
    const uint64_t each = study->wafer_count + 1;
    if (study->lines > WH_STUDY_MOST_LINES / each) {
        fprintf(stderr, "--csv: %llu trials (expected at most %llu, for a line has %zu wafer%s)\n",
                (unsigned long long)study->trials, (unsigned long long)(WH_STUDY_MOST_LINES / each),
                study->wafer_count, study->wafer_count == 1 ? "" : "s");
        return false;
    }
    const uint64_t some = each > 10 ? UINT64_C(10) * WH_STUDY_LINES / each : WH_STUDY_LINES;
    study->lines = study->lines > some ? study->lines : some;
    return true;
}

/* True if something of the cell was read that errors could change, or a gripper was told to take. */
static bool asks_the_cell(const wh_decisions_t *decisions) {
    bool asks = decisions->unfit || decisions->claim_count > 0;
    for (size_t i = 0; i < decisions->entry_count; ++i) {
        const wh_decisions_kind_t kind = decisions->entries[i].kind;
        asks = asks || (kind != WH_DECISION_BEGIN && kind != WH_DECISION_END);
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        asks = asks || decisions->valve_count[g] > 0;
    }
    return asks;
}

/* True if no trial could fail, whatever is drawn: no wafer is touched, and nothing is checked. */
static bool checks_nothing(const wh_study_t *study) {
    const wh_record_t *record = &study->nominal.record;
    return record->ok && record->event_count == 0 && !study->has_flow &&
           (record->expectation_count == 0 || !asks_the_cell(&study->decisions)) &&
           (record->slices == 0 || !study->layout->collision);
}

static bool has_noise(const wh_layout_t *layout) {
    bool is_noisy = false;
    for (size_t i = 0; i < layout->scanner_count; ++i) {
        is_noisy = is_noisy || layout->scanners[i].sensor.noise > 0;
    }
    for (size_t w = 0; layout->scanner_count > 0 && w < layout->wafer_count; ++w) {
        is_noisy = is_noisy || layout->rims[w]->transmission > 0;
    }
    for (size_t b = 0; b < layout->beam_count; ++b) {
        is_noisy = is_noisy || layout->doors[b].jitter > 0 || layout->doors[b].noise > 0;
    }
    return is_noisy;
}

bool wh_study_has_noise(const wh_study_t *study) {
    return has_noise(study->layout) && study->decisions.unfit;
}

bool wh_study_is_of_noise(const wh_study_t *study) {
    return !study->draws_nothing && study->drawn_count == 0 && wh_study_has_noise(study);
}

/* Without widths all trials are alike, unless sensors with noise of their own are read. */
static bool draws_something(const wh_study_t *study) {
    const size_t drawn = study->layout->tool ? study->cause_count : study->drawn_count;
    return study->draws_nothing || drawn > 0 || wh_study_is_of_noise(study) ||
           refuse_script(
               study->layout->path,
               study->layout->tool
                   ? "study: nothing is drawn, so that all trials are alike (expected a width above 0, "
                     "as study = { timing = { process = 2 } }, and a process in the flow)"
                   : "study: nothing is drawn, so that all trials are alike (expected a width "
                     "above 0, as study = { placement = { dx = 0.3 } }, here or in the script)");
}

/* True if something is drawn, or given, that the cell can have; else standard error says why not. */
static bool has_errors(const wh_study_t *study) {
    const wh_layout_t *layout = study->layout;
    if (layout->tool && study->draws_nothing) {
        return refuse_script(
            layout->path,
            "its robots are times alone, and nothing stands anywhere (expected robots with axes)");
    }
    return layout->errors || study->draws_nothing ||
           refuse_script(layout->path,
                         layout->tool
                             ? "study: nil (expected what is drawn, as study = { timing = { process = "
                               "2 } }, here or in the script)"
                             : "study: nil (expected what is drawn, as study = { placement = { "
                               "dx = 0.3 } }, here or in the script)");
}

/* True if trials make sense; else standard error says why not. */
static bool is_fit(const wh_study_t *study) {
    if (!study->layout || (!study->nominal.record.wafers && !study->layout->tool)) {
        return refuse_script(study->run.script, "no cell (expected cell \"LAYOUT.lua\")");
    }
    if (!has_errors(study)) {
        return false;
    }
    if (checks_nothing(study)) {
        return refuse_script(study->run.script,
                             study->layout->tool
                                 ? "plays no flow, so that no trial could fail (expected flow)"
                                 : "takes no wafer and expects nothing of any, so that no trial could fail "
                                   "(expected get, put, or expect of where a wafer is)");
    }
    return true;
}

/* A tool of times alone draws processes: those of stations in which the flow has none tell nothing. */
static void forget_aside(wh_study_t *study) {
    if (study->layout->tool) {
        memcpy(study->drawn, study->causes, study->cause_count * sizeof *study->drawn);
        study->drawn_count = study->cause_count;
    }
}

/* True if errors could change where several robots go. */
static bool goes_elsewhere(const wh_study_t *study) {
    return study->layout->robot_count > 1 && !study->draws_nothing;
}

bool wh_study_open(wh_study_t *study) {
    wh_script_run_options_t options = study->run;
    options.decisions = &study->decisions;
    wh_output_hear_inputs(add_input, study);
    const wh_script_run_outcome_t outcome = wh_script_run(&study->nominal, &options);
    wh_output_hear_inputs(NULL, NULL);
    if (outcome == WH_RUN_BAD_INPUT) {
        fprintf(stderr, "%s\n", study->nominal.message);
        return false;
    }
    study->layout = wh_mcs_layout(&study->nominal.mcs);
    const wh_flow_t *flow = study->nominal.record.flow;
    study->has_flow = flow && flow->figures.tool;
    (void)wh_flow_sums_read(flow, study->flow);
    if (!is_fit(study)) {
        return false;
    }
    study->whole = study->layout->tool        ? "a flow"
                   : study->layout->collision ? "collisions are looked for"
                   : goes_elsewhere(study)    ? "where each robot was taught its stations"
                                              : study->decisions.unfit;
    choose_wafers(study);
    if (!study->draws_nothing) {
        study->drawn = wh_causes_of(study->layout, &study->drawn_count);
        study->causes = wh_concerns_choose(study, &study->cause_count);
        forget_aside(study);
    }
    return draws_something(study) && choose_lines(study);
}

void wh_study_close(wh_study_t *study) {
    for (size_t i = 0; i < study->input_count; ++i) {
        free(study->inputs[i].path);
    }
    free(study->inputs);
    wh_decisions_free(&study->decisions);
    free(study->drawn);
    free(study->causes);
    wh_script_run_close(&study->nominal);
}

/* -------------------------------------------------------------------------------------------------- state */

/* Where progress is kept, and when it was kept last. */
typedef struct {
    char *path; /* null: nowhere */
    bool named; /* by the user: then the file stays, and a failed write is a failure */
    double kept;
    double pause; /* s until the next time */
} keeper_t;

static bool keep(keeper_t *keeper, wh_pool_t *pool) {
    const double begin = keeper->kept = wh_clock_seconds();
    if (!keeper->path) {
        return true;
    }
    pthread_mutex_lock(&pool->lock);
    char *text = wh_checkpoint_text(pool->study, &pool->progress);
    pthread_mutex_unlock(&pool->lock);
    const bool saved = text && wh_checkpoint_save(keeper->path, text);
    if (!saved && keeper->named) {
        wh_output_tell("--state", keeper->path, errno);
    } else if (!saved) {
        free(keeper->path);
        keeper->path = NULL;
    }
    free(text);
    keeper->kept = wh_clock_seconds();
    keeper->pause = fmax(KEEP_S, KEEP_SHARE * (keeper->kept - begin));
    return saved || !keeper->named;
}

static bool open_keeper(keeper_t *keeper, const wh_study_options_t *options, wh_pool_t *pool) {
    keeper->named = options->state != NULL;
    keeper->path = keeper->named ? wh_text_copy(options->state) : wh_checkpoint_default_path(pool->study);
    keeper->kept = wh_clock_seconds();
    keeper->pause = KEEP_S;
    if (!keeper->path) {
        return true;
    }
    const wh_checkpoint_found_t found = wh_checkpoint_load(keeper->path, pool->study, &pool->progress);
    return found != WH_CHECKPOINT_REFUSED &&
           (found == WH_CHECKPOINT_READ || !keeper->named || keep(keeper, pool));
}

static void close_keeper(keeper_t *keeper, bool done) {
    if (keeper->path && !keeper->named && done) {
        unlink(keeper->path);
    }
    free(keeper->path);
}

/* ---------------------------------------------------------------------------------------------------- bar */

/* How far the study is, as a line on a terminal; nothing anywhere else. */
typedef struct {
    FILE *out; /* null: no terminal */
    wh_style_t style;
    uint64_t total, begun; /* trials, and those done before */
    double start, shown;   /* s */
} bar_t;

/* Drawn at most ten times a second. */
static void bar_show(bar_t *bar, uint64_t done) {
    const double now = wh_clock_seconds();
    if (!bar->out || now - bar->shown < 0.1) {
        return;
    }
    bar->shown = now;
    const int full = (int)((double)CELLS * (double)done / (double)bar->total);
    fputs("\r\033[K[", bar->out);
    for (int cell = 0; cell < CELLS; ++cell) {
        fputs(cell < full ? (bar->style.utf8 ? "█" : "#") : " ", bar->out);
    }
    fprintf(bar->out, "] %.1f %% of %llu trials", 100 * (double)done / (double)bar->total,
            (unsigned long long)bar->total);
    if (done > bar->begun && now - bar->start > 1) {
        const double left = (now - bar->start) * (double)(bar->total - done) / (double)(done - bar->begun);
        fprintf(bar->out, ", %d:%02d left", (int)(left / 60), (int)left % 60);
    }
    fflush(bar->out);
}

static void bar_close(const bar_t *bar) {
    if (bar->out) {
        fputs("\r\033[K", bar->out);
        fflush(bar->out);
    }
}

/* ------------------------------------------------------------------------------------------------ playing */

size_t wh_study_threads(size_t wanted) {
    cpu_set_t processors;
    if (wanted > 0) {
        return wanted;
    }
    if (sched_getaffinity(0, sizeof processors, &processors) != 0) {
        return 1;
    }
    const int count = CPU_COUNT(&processors) / wh_ranks_here();
    return count < 1 ? 1 : count > MOST_THREADS ? MOST_THREADS : (size_t)count;
}

static void queue_rest(wh_pool_t *pool) {
    wh_stretches_t rest = {0};
    pthread_mutex_lock(&pool->lock);
    wh_stretches_rest(&rest, &pool->progress.done, pool->study->trials);
    pthread_mutex_unlock(&pool->lock);
    wh_pool_queue(pool, rest.items, rest.count, true);
    wh_stretches_free(&rest);
}

static bool is_over(wh_pool_t *pool, const wh_ranks_t *ranks) {
    return wh_pool_look(pool).idle && ranks->ended == ranks->size - 1;
}

/* Every 50 ms: takes the messages of other ranks, and keeps the progress. False if that failed. */
static bool attend(wh_pool_t *pool, wh_ranks_t *ranks, keeper_t *keeper) {
    wh_pool_wait(pool, 50);
    return wh_ranks_serve(ranks, pool) &&
           (wh_clock_seconds() - keeper->kept < keeper->pause || keep(keeper, pool));
}

static wh_study_end_t lead(wh_pool_t *pool, wh_ranks_t *ranks, keeper_t *keeper) {
    bar_t bar = {.out = isatty(STDERR_FILENO) == 1 ? wh_guard_terminal() : NULL,
                 .style = wh_style_of(wh_guard_terminal()),
                 .total = pool->study->trials,
                 .begun = wh_pool_look(pool).trials,
                 .start = wh_clock_seconds()};
    bool sound = true;
    queue_rest(pool);
    while (sound && !wh_pool_look(pool).failed && !wh_interrupt_came() && !is_over(pool, ranks)) {
        sound = attend(pool, ranks, keeper);
        bar_show(&bar, wh_pool_look(pool).trials);
    }
    bar_close(&bar);
    if (wh_pool_look(pool).failed) {
        fprintf(stderr, "%s\n", pool->message);
        sound = false;
    }
    const bool left_off = wh_interrupt_came() && !is_over(pool, ranks);
    return !sound ? WH_STUDY_FAILED : left_off ? WH_STUDY_INTERRUPTED : WH_STUDY_DONE;
}

static void tell_interruption(const keeper_t *keeper, wh_pool_t *pool) {
    fprintf(stderr, "interrupted: %llu of %llu trials are done",
            (unsigned long long)wh_pool_look(pool).trials, (unsigned long long)pool->study->trials);
    fprintf(stderr, keeper->path ? ", and kept in %s; the same command goes on from there\n" : "%s\n",
            keeper->path ? keeper->path : "");
}

static wh_study_end_t play_first(wh_pool_t *pool, const wh_study_options_t *options, wh_ranks_t *ranks) {
    keeper_t keeper;
    wh_study_end_t end = WH_STUDY_FAILED;
    if (open_keeper(&keeper, options, pool)) {
        end = lead(pool, ranks, &keeper);
        wh_pool_stop(pool);
        while (!wh_pool_look(pool).idle) { /* until all their results are in the progress */
            wh_pool_wait(pool, 5);
        }
        const bool used = keeper.named || end == WH_STUDY_INTERRUPTED;
        if (used && !keep(&keeper, pool) && end == WH_STUDY_DONE) {
            end = WH_STUDY_FAILED;
        }
        if (end == WH_STUDY_INTERRUPTED) {
            tell_interruption(&keeper, pool);
        }
    }
    close_keeper(&keeper, end == WH_STUDY_DONE);
    return end;
}

wh_study_end_t wh_study_play(const wh_study_t *study, const wh_study_options_t *options, wh_ranks_t *ranks,
                             wh_progress_t *progress) {
    wh_pool_t pool;
    wh_study_end_t end = WH_STUDY_FAILED;
    wh_interrupt_catch();
    if (!wh_pool_open(&pool, study, wh_study_threads(options->threads))) {
        fprintf(stderr, "waferhand study: no memory or threads (expected fewer with --threads)\n");
    } else if (ranks->rank > 0) {
        end = wh_ranks_help(ranks, &pool, wh_interrupt_came) ? WH_STUDY_HELPED : WH_STUDY_FAILED;
    } else {
        end = play_first(&pool, options, ranks);
    }
    if (end == WH_STUDY_DONE) {
        wh_progress_init(progress, study);
        wh_progress_merge(progress, &pool.progress);
        wh_tally_sort(&progress->tally);
    }
    wh_pool_close(&pool);
    return end;
}
