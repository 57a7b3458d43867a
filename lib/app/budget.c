/* waferhand budget SCRIPT */
#include <math.h>
#include <stdlib.h>

#include "../print/budget_print.h"
#include "../study/budget_player.h"
#include "../study/study_play.h"
#include "../text/array.h"
#include "../text/interrupt.h"
#include "../text/nearest.h"
#include "apart.h"
#include "app.h"
#include "run_arguments.h"
#include "teller.h"

typedef struct {
    wh_run_arguments_t run; /* the script, its parameters and limits, and --json */
    wh_option_list_t stations;
    double limit_mm, limit_deg;
    uint64_t steps, samples, seed, threads;
} arguments_t;

static const wh_option_t options[] = {
    {"station", 0, "NAME",
     "Look at this station alone; the others stand where they were taught. May be given again",
     WH_OPTION_LIST, .variable = offsetof(arguments_t, stations)},
    {"limit", 0, "MM", "How far x, y and z may be off at most (default 100)", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, limit_mm), 0.001, WH_ERRORS_MOST_MM},
    {"limit-deg", 0, "DEG", "How far roll, pitch and yaw may be off at most (default 45)", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, limit_deg), 0.001, WH_ERRORS_MOST_DEG},
    {"steps", 0, "N",
     "Look for failures in at least N steps to the limit (default 100; with collisions by what they cost)",
     WH_OPTION_WHOLE, .variable = offsetof(arguments_t, steps), 1, 100000},
    {"samples", 0, "N", "Try N corners and N points by chance of all errors together (default 256)",
     WH_OPTION_WHOLE, .variable = offsetof(arguments_t, samples), 1, 1000000},
    {"seed", 0, "S", "Which ones (default 1)", WH_OPTION_COUNT, .variable = offsetof(arguments_t, seed)},
    {"threads", 0, "N", "On so many threads (default: one for each processor)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, threads), 1, 1024},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL}, {wh_run_trials_options, offsetof(arguments_t, run), NULL, NULL}, {0}};

static const wh_command_line_t command_line = {
    .name = "budget",
    .synopsis = "SCRIPT",
    .about = "Tells how far each station may stand from where it was taught before the script fails: each "
             "error alone and all together, what fails just beyond, and which station must be taught "
             "best.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script)};

/* ------------------------------------------------------------------------------------------------ finding */

static int32_t thousandths(double value) {
    return (int32_t)lround(value * WH_BUDGET_UNIT);
}

/* The most names that are told. */
#define TOLD 20

static void tell_no_station(const wh_layout_t *layout, const char *name) {
    const char **names = wh_array_new(layout->station_count + 1, sizeof *names);
    char meant[WH_NEAREST_TEXT];
    fprintf(stderr, "--station %s: no such station (expected", name);
    for (size_t s = 0; s < layout->station_count; ++s) {
        names[s] = layout->stations[s].name;
        if (s < TOLD) {
            fprintf(stderr, "%s %s", s == 0 ? "" : s + 1 == layout->station_count ? " or" : ",", names[s]);
        }
    }
    if (layout->station_count > TOLD) {
        fprintf(stderr, " or one of %zu others of %s", layout->station_count - TOLD, layout->path);
    }
    fprintf(stderr, "%s)\n",
            wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(name, names, layout->station_count)));
    free(names);
}

/* Marks the stations that were named. False, with a line on standard error, if a name has no station. */
static bool choose_stations(const arguments_t *arguments, const wh_layout_t *layout, bool wanted[]) {
    for (size_t i = 0; i < arguments->stations.count; ++i) {
        const int32_t station = wh_layout_find_station(layout, arguments->stations.items[i]);
        if (station == WH_NONE) {
            tell_no_station(layout, arguments->stations.items[i]);
            return false;
        }
        wanted[station] = true;
    }
    return true;
}

static void tell_progress(void *user, const char *what, size_t done, size_t total) {
    wh_teller_tell(user, what, done, total);
}

static int find(const arguments_t *arguments, const wh_study_t *study, const bool wanted[]) {
    wh_teller_t teller;
    const wh_style_t style = wh_style_of(stdout);
    const wh_budget_options_t how = {
        .threads = wh_study_threads((size_t)arguments->threads),
        .most = {thousandths(arguments->limit_mm), thousandths(arguments->limit_deg)},
        .steps = arguments->steps,
        .samples = arguments->samples,
        .seed = arguments->seed,
        .wanted = arguments->stations.count > 0 ? wanted : NULL,
        .tell = tell_progress,
        .user = &teller,
        .is_enough = wh_interrupt_came};
    wh_budget_t budget;
    int status = WH_EXIT_USAGE;
    wh_interrupt_catch();
    wh_teller_begin(&teller, "budget");
    const bool found = wh_budget_find(&budget, study, &how);
    wh_teller_end(&teller);
    if (found || budget.incomplete) {
        const int printed = arguments->run.json ? wh_budget_print_json(&budget, stdout)
                                                : wh_budget_print_table(&budget, stdout, &style);
        status = !wh_app_is_printed(printed) ? WH_EXIT_USAGE : found ? WH_EXIT_MET : WH_EXIT_FAILED;
    }
    wh_budget_free(&budget);
    return status;
}

/* A script that fails without any error has no budget. */
static bool passes_without_errors(const wh_study_t *study) {
    wh_budget_why_t why;
    if (study->nominal.record.ok) {
        return true;
    }
    wh_budget_explain(&study->nominal.record, study->nominal.message, &why);
    fprintf(stderr, "%s: fails without any errors, so it has no budget: %s%s%s", study->run.script, why.name,
            why.command[0] ? " in " : "", why.command);
    if (why.line > 0) {
        fprintf(stderr, " (line %d)", why.line);
    }
    fprintf(stderr, ": %s\n", why.text);
    return false;
}

static int find_of(const arguments_t *arguments, const wh_study_t *study) {
    bool *wanted = wh_array_new(study->layout->station_count + 1, sizeof *wanted);
    int status = WH_EXIT_USAGE;
    if (choose_stations(arguments, study->layout, wanted)) {
        status = passes_without_errors(study) ? find(arguments, study, wanted) : WH_EXIT_FAILED;
    }
    free(wanted);
    return status;
}

/* Scripts print into /dev/null: the output of many trials would be mixed. */
static int budget_of(const arguments_t *arguments) {
    static wh_study_t study;
    int status = WH_EXIT_USAGE;
    FILE *nowhere = fopen("/dev/null", "w");
    if (!nowhere) {
        perror("/dev/null");
        return status;
    }
    study = (wh_study_t){.run = arguments->run.run, .trials = 1, .draws_nothing = true};
    study.run.limits.print_to = nowhere;
    if (wh_study_open(&study)) {
        status = find_of(arguments, &study);
    }
    wh_study_close(&study);
    fclose(nowhere);
    return status;
}

int wh_app_budget(int argc, char **argv) {
    arguments_t arguments = {
        .limit_mm = WH_ERRORS_MOST_MM, .limit_deg = WH_ERRORS_MOST_DEG, .samples = 256, .seed = 1};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    const wh_named_file_t named[] = {{"the script", arguments.run.run.script, false}};
    const int status = wh_files_are_apart(named, 1, true) ? budget_of(&arguments) : WH_EXIT_USAGE;
    wh_run_arguments_free(&arguments.run);
    wh_option_list_free(&arguments.stations);
    return status;
}
