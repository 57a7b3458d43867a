#include "sweep_best.h"

#include <stdlib.h>
#include <unistd.h>

#include "../flow/flow.h"
#include "../print/best_print.h"
#include "../text/array.h"
#include "../text/guard.h"
#include "app.h"

/* On a terminal alone. */
static void show(void *user, double share) {
    FILE *terminal = user;
    if (terminal) {
        fprintf(terminal, "\r\033[K%.0f %% of the search", 100 * share);
        (void)fflush(terminal);
    }
}

static void search(const wh_best_result_t *result, size_t width, wh_flow_best_t *best) {
    FILE *terminal = isatty(STDERR_FILENO) == 1 ? wh_guard_terminal() : NULL;
    wh_flow_best(result->tool, result->plan, width, show, terminal, best);
    if (terminal) {
        fputs("\r\033[K", terminal);
        (void)fflush(terminal);
    }
}

/* A schedule is none until the engine has played it. */
static bool is_played(const wh_best_result_t *result) {
    wh_flow_plan_t plan = *result->plan;
    wh_flow_result_t played;
    plan.rule = WH_FLOW_LISTS;
    plan.lists = result->best->lists;
    plan.on_problem = NULL;
    wh_flow_play(result->tool, &plan, NULL, &played);
    const bool is_same = played.end == WH_FLOW_DONE && played.makespan_us == result->best->makespan_us;
    if (!is_same) {
        fprintf(stderr, "--best: played, the schedule takes %.6f s, not %.6f s\n",
                (double)played.makespan_us / 1e6, (double)result->best->makespan_us / 1e6);
    }
    wh_flow_result_close(&played);
    return is_same;
}

static int hand_on(const wh_run_arguments_t *arguments, const wh_best_result_t *of, size_t width) {
    const wh_style_t style = wh_style_of(stdout);
    wh_flow_best_t best;
    wh_best_result_t found = *of;
    const wh_best_result_t *result = &found;
    int status = WH_EXIT_USAGE;
    search(of, width, &best);
    found.best = &best;
    if (!best.lists || is_played(result)) {
        const int printed = arguments->json ? wh_best_print_json(result, stdout)
                                            : wh_best_print_table(result, stdout, &style);
        status = !wh_app_is_printed(printed)                       ? WH_EXIT_USAGE
                 : best.lists && best.makespan_us <= best.bound_us ? WH_EXIT_MET
                                                                   : WH_EXIT_FAILED;
    }
    wh_flow_best_close(&best, result->tool);
    return status;
}

static int find(const wh_run_arguments_t *arguments, const wh_script_run_t *run, size_t width) {
    const wh_flow_t *flow = run->record.flow;
    if (!flow || !flow->figures.tool) {
        fprintf(stderr, "%s: no flow was played (expected one for --best)\n", arguments->run.script);
        return WH_EXIT_USAGE;
    }
    char *why = wh_flow_best_refuses(flow->tool, &flow->plan);
    if (why) {
        fprintf(stderr, "%s:%d: flow: --best: %s\n", arguments->run.script, flow->line, why);
        free(why);
        return WH_EXIT_USAGE;
    }
    const wh_best_result_t result = {
        arguments->run.script, flow->tool, &flow->plan,
        flow->figures.result.end == WH_FLOW_DONE ? flow->figures.result.makespan_us : WH_FLOW_NEVER, NULL};
    return hand_on(arguments, &result, width);
}

int wh_app_sweep_best(const wh_run_arguments_t *arguments, size_t width, FILE *nowhere) {
    wh_script_run_t *run = wh_array_new(1, sizeof *run);
    wh_script_run_options_t options = arguments->run;
    options.limits.print_to = nowhere;
    int status = WH_EXIT_USAGE;
    if (wh_script_run(run, &options) == WH_RUN_BAD_INPUT) {
        fprintf(stderr, "%s\n", run->message);
    } else {
        status = find(arguments, run, width);
    }
    wh_script_run_close(run);
    free(run);
    return status;
}
