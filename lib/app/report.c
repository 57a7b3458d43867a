/* waferhand report RUN */
#include <stdio.h>
#include <string.h>

#include "app.h"
#include "log_arguments.h"
#include "run_arguments.h"
#include "watch.h"

typedef struct {
    wh_run_arguments_t run; /* run.run.script is RUN, of any kind */
    wh_log_more_t more;
    const char *layout;
    uint64_t number; /* 0: the last */
    bool watch;
} arguments_t;

static const wh_option_t options[] = {
    {"layout", 0, "FILE",
     "For a log: the file of its layout, if it is not where the log says; another layout is refused",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, layout)},
    {"run", 0, "N", "For a log: its N-th run that has slices (default: the last)", WH_OPTION_COUNT,
     .variable = offsetof(arguments_t, number), .least = 1},
    {"watch", 0, NULL, WH_WATCH_HELP, WH_OPTION_FLAG, .variable = offsetof(arguments_t, watch)},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL},
    {wh_log_more_options, offsetof(arguments_t, more), NULL, NULL},
    {wh_run_options, offsetof(arguments_t, run), NULL, wh_run_arguments_check},
    {wh_run_counting_options, offsetof(arguments_t, run), NULL, wh_run_counting_check},
    {wh_run_error_options, offsetof(arguments_t, run), NULL, wh_run_errors_check},
    {wh_run_files_options, offsetof(arguments_t, run.files), NULL, NULL},
    {wh_run_again_options, offsetof(arguments_t, run), NULL, wh_run_again_check},
    {0}};

static void check_report_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (!arguments->run.run.script) {
        argp_error(state, "of which run?");
    }
    const char *table = wh_run_table_wanted(&arguments->run);
    if (table) {
        argp_error(state, "%s: a report prints no table (waferhand run SCRIPT does)", table);
    }
    if (arguments->watch && arguments->run.plays_again) {
        argp_error(state, "--watch does not go with --live: both listen for what is read");
    }
    if (!wh_run_files_wanted(&arguments->run.files) && !arguments->run.segments_path &&
        !arguments->run.json) {
        argp_error(state, "into which file? (-o FILE, --gltf FILE, --data FILE, --svg DIR or, of a script, "
                          "--segments FILE; or --json)");
    }
}

static const wh_command_line_t command_line = {
    .name = "report",
    .synopsis = "RUN",
    .about = "Makes a page of a run, which is a script that is run again, or an LCM event log: the cell in "
             "motion, plots "
             "and tables, in one file that opens without a network; or its plots for print.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script),
    .operand_may_lack = true,
    .check = check_report_arguments};

static bool write_log(const arguments_t *arguments, wh_log_run_t *run) {
    const wh_script_run_options_t *given = &arguments->run.run;
    wh_log_run_options_t wanted = {.path = given->script,
                                   .number = (size_t)arguments->number,
                                   .layout = {arguments->layout, given->parameters, given->parameter_count}};
    wh_log_more_take(&arguments->more, &wanted);
    if (!wh_log_run_read(run, &wanted)) {
        fprintf(stderr, "%s\n", run->message);
        return false;
    }
    if (!wh_run_files_are_apart(&arguments->run, run->cell.layout->path)) {
        return false;
    }
    if (!wh_log_arguments_check_set(run, NULL)) {
        return false;
    }
    if (run->worth.reason[0] != '\0') {
        fprintf(stderr, "%s: %s: %s\n", given->script, run->worth.verdict, run->worth.reason);
    }
    const wh_document_t document = {.source = "log",
                                    .notes = run->notes.texts,
                                    .note_count = run->notes.count,
                                    .record = &run->record,
                                    .signals = &run->signals};
    return wh_run_files_write(&arguments->run, &document) &&
           wh_app_is_printed(wh_run_print(&arguments->run, &run->record));
}

/* The first option that needs a script. */
static const char *find_foreign(const wh_run_arguments_t *run) {
    return run->budget > 0         ? "--budget"
           : run->memory_mib > 0   ? "--memory"
           : run->run.limits.trust ? "--trust"
           : run->errors.count > 0 ? "--error"
           : run->counting.counted ? "--counted"
           : run->plays_again      ? "--live"
                                   : NULL;
}

static int report_log(const arguments_t *arguments) {
    static wh_log_run_t run;
    const char *foreign = find_foreign(&arguments->run);
    if (foreign) {
        fprintf(stderr, "%s goes with a script: %s is a log, of which nothing is played\n", foreign,
                arguments->run.run.script);
        return WH_EXIT_USAGE;
    }
    if (arguments->run.segments_path) {
        fprintf(stderr,
                "--segments %s: not written: %s is a log (expected a script, whose run has segments)\n",
                arguments->run.segments_path, arguments->run.run.script);
        return WH_EXIT_USAGE;
    }
    if (arguments->watch) {
        fprintf(stderr, "--watch goes with a script: %s is a log, which nobody edits\n",
                arguments->run.run.script);
        return WH_EXIT_USAGE;
    }
    const bool written = write_log(arguments, &run);
    wh_log_run_close(&run);
    return written ? WH_EXIT_MET : WH_EXIT_USAGE;
}

static int play(void *user) {
    wh_run_arguments_t *run = user;
    const int status = wh_run_and_print(run);
    return status == WH_EXIT_USAGE ? WH_EXIT_USAGE : WH_EXIT_MET;
}

static int report_script(arguments_t *arguments, bool is_text) {
    if (!is_text) {
        fprintf(stderr, "%s: no LCM event log and no script (expected one of them)\n",
                arguments->run.run.script);
        return WH_EXIT_USAGE;
    }
    const char *wanted = arguments->layout                ? "--layout"
                         : arguments->number > 0          ? "--run"
                         : arguments->more.is_alone       ? "--alone"
                         : arguments->more.then.count > 0 ? "--then"
                                                          : NULL;
    if (wanted) {
        fprintf(stderr, "%s: no LCM event log (expected one with %s)\n", arguments->run.run.script, wanted);
        return WH_EXIT_USAGE;
    }
    return arguments->watch ? wh_run_watch(&arguments->run, play, &arguments->run) : play(&arguments->run);
}

/* Reads how the run begins: a log begins with LCM's sync word or is compressed, and a script is text. */
static int report(arguments_t *arguments) {
    static const unsigned char sync[4] = {0xED, 0xA1, 0xDA, 0x01};
    char begin[512];
    const char *fault = NULL; /* which a script's reader tells */
    FILE *file = wh_log_file(arguments->run.run.script, &fault);
    const size_t size = file ? fread(begin, 1, sizeof begin, file) : 0;
    const bool is_empty = file && size == 0 && feof(file);
    if (file) {
        (void)fclose(file);
    }
    if (is_empty) {
        fprintf(stderr, "%s: empty (expected an LCM event log or a script)\n", arguments->run.run.script);
        return WH_EXIT_USAGE;
    }
    const bool is_log =
        wh_log_is_packed(begin, size) || (size >= sizeof sync && memcmp(begin, sync, sizeof sync) == 0);
    return is_log ? report_log(arguments) : report_script(arguments, !memchr(begin, '\0', size));
}

int wh_app_report(int argc, char **argv) {
    arguments_t arguments = {.run = {.quiet = true}};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    const int status = report(&arguments);
    wh_option_list_free(&arguments.more.then);
    wh_run_arguments_free(&arguments.run);
    return status;
}
