/* A script's run, for `run` and `mcs`, and the files that it is written to. */
#include "run_arguments.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../link/outputs.h"
#include "../play/run_document.h"
#include "../play/run_written.h"
#include "../print/flow_history.h"
#include "../print/segments.h"
#include "../report/plots.h"
#include "../schedule/write.h"
#include "../text/array.h"
#include "../text/output.h"
#include "../text/style.h"
#include "apart.h"
#include "app.h"
#include "watch.h"

/* Seconds: what --from and --to take. */
#define SOONEST 1e-6
#define LATEST 1e9

const wh_option_t wh_run_options[] = {
    {"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, json)},
    {"gantt", 0, NULL, "Also print who was busy when, and what each command's time went into", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, sections.gantt)},
    {"from", 0, "S", "With --gantt: from this time of the run on, in simulated seconds", WH_OPTION_REAL,
     .variable = offsetof(wh_run_arguments_t, sections.from_s), 0, LATEST},
    {"to", 0, "S", "With --gantt: up to this time", WH_OPTION_REAL,
     .variable = offsetof(wh_run_arguments_t, sections.to_s), SOONEST, LATEST},
    {"cycle", 0, NULL,
     "Also print the first steady cycle by itself: how long it takes, what is in it, its wafers per hour; or "
     "why there is none",
     WH_OPTION_FLAG, .variable = offsetof(wh_run_arguments_t, sections.cycle)},
    {"margins", 0, NULL, "Also print how near the axes come to the ends of their travel at each station",
     WH_OPTION_FLAG, .variable = offsetof(wh_run_arguments_t, sections.margins)},
    {"segments", 0, "FILE",
     "Write the run as C source that a firmware test plays; its names begin with FILE's, in which all but "
     "ASCII "
     "letters and digits becomes _",
     WH_OPTION_TEXT, .variable = offsetof(wh_run_arguments_t, segments_path)},
    {"set", 0, "NAME=VALUE",
     "Hand the script a parameter, params.NAME: a number if VALUE is one, true, false or text",
     WH_OPTION_LIST, .variable = offsetof(wh_run_arguments_t, parameters)},
    {"trust", 0, NULL, "Let the script use all of Lua, files and native modules too", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, run.limits.trust)},
    {"budget", 0, "N", "End the script after N steps: 1 each of Lua, 20 a slice (default 1e9)",
     WH_OPTION_REAL, .variable = offsetof(wh_run_arguments_t, budget), 1, 1e18},
    {"memory", 0, "MIB", "Let the script use so many MiB of memory (default 256)", WH_OPTION_REAL,
     .variable = offsetof(wh_run_arguments_t, memory_mib), 1, 1e6},
    {0}};

const wh_option_t wh_run_trials_options[] = {
    {"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, json)},
    {"set", 0, "NAME=VALUE",
     "Hand script and layout a parameter, params.NAME: a number if VALUE is one, true, false or text",
     WH_OPTION_LIST, .variable = offsetof(wh_run_arguments_t, parameters)},
    {"budget", 0, "N", "End a trial's script after N steps: 1 each of Lua, 20 a slice (default 1e9)",
     WH_OPTION_REAL, .variable = offsetof(wh_run_arguments_t, budget), 1, 1e18},
    {"memory", 0, "MIB", "Let a script use so many MiB of memory (default 256)", WH_OPTION_REAL,
     .variable = offsetof(wh_run_arguments_t, memory_mib), 1, 1e6},
    {0}};

const wh_option_t wh_run_files_options[] = {
    {"report", 'o', "FILE", "Write a page to look at and to mail: the cell in motion, plots and tables",
     WH_OPTION_TEXT, .variable = offsetof(wh_run_files_t, page)},
    {"gltf", 0, "FILE", "Write the cell in motion as glTF 2.0, for Blender and other viewers", WH_OPTION_TEXT,
     .variable = offsetof(wh_run_files_t, scene)},
    {"data", 0, "FILE", "Write the page's data alone, as JSON", WH_OPTION_TEXT,
     .variable = offsetof(wh_run_files_t, document)},
    {"svg", 0, "DIR",
     "Write the plots into this folder, for print: each as SVG, with the data and the gnuplot script that it "
     "is made of",
     WH_OPTION_TEXT, .variable = offsetof(wh_run_files_t, plots)},
    {0}};

void wh_run_arguments_check(const void *filled, struct argp_state *state) {
    const wh_run_arguments_t *arguments = filled;
    const wh_record_sections_t *sections = &arguments->sections;
    const bool is_window = sections->from_s > 0 || sections->to_s > 0;
    if (is_window && (!sections->gantt || arguments->json)) {
        argp_error(state, "%s: %g (goes with --gantt%s)", sections->from_s > 0 ? "--from" : "--to",
                   sections->from_s > 0 ? sections->from_s : sections->to_s,
                   arguments->json ? ", not with --json, which has all times" : "");
    }
    if (sections->to_s > 0 && sections->to_s <= sections->from_s) {
        argp_error(state, "--to: %g (expected a time after --from, %g)", sections->to_s, sections->from_s);
    }
}

const char *wh_run_table_wanted(const wh_run_arguments_t *arguments) {
    const wh_record_sections_t *sections = &arguments->sections;
    return sections->gantt ? "--gantt" : sections->cycle ? "--cycle" : sections->margins ? "--margins" : NULL;
}

bool wh_run_files_wanted(const wh_run_files_t *files) {
    return files->page || files->scene || files->document || files->plots;
}

/* ------------------------------------------------------------------------------------------------- errors */

const wh_option_t wh_run_error_options[] = {
    {"error", 0, "NAME.FIELD=VALUE",
     "Play in a cell that is off by this, such as A.x=0.12: a station's x, y, z, roll, pitch, yaw, a wafer's "
     "dx, "
     "dy, dz, tilt_x, tilt_y, turn, of its rim diameter and what else a study draws, a gripper's valve, or "
     "vacuum; may be given again",
     WH_OPTION_LIST, .variable = offsetof(wh_run_arguments_t, errors)},
    {0}};

/* The length of the text before the last equals sign. */
static size_t name_length(const char *error) {
    const char *equals = strrchr(error, '=');
    return equals ? (size_t)(equals - error) : strlen(error);
}

static bool is_of_one(const char *error, const char *other) {
    const size_t length = name_length(error);
    return length == name_length(other) && strncmp(error, other, length) == 0;
}

void wh_run_errors_check(const void *filled, struct argp_state *state) {
    const wh_run_arguments_t *arguments = filled;
    const wh_option_list_t *errors = &arguments->errors;
    if (errors->count > 0 && arguments->segments_path) {
        argp_error(state, WH_RUN_ERRORS_ALONE, "--segments");
    }
    for (size_t i = 1; i < errors->count; ++i) {
        for (size_t j = 0; j < i; ++j) {
            if (is_of_one(errors->items[i], errors->items[j])) {
                argp_error(state, "--error %s: given twice", errors->items[i]);
            }
        }
    }
}

/* --------------------------------------------------------------------------------------- playing it again */

const wh_option_t wh_run_again_options[] = {
    {"live", 0, NULL,
     "With --report: the page plays the run again with other values of its params, by the engine that `make "
     "playground` builds, and carries all that it takes",
     WH_OPTION_FLAG, .variable = offsetof(wh_run_arguments_t, plays_again)},
    {0}};

/* The first option that a page's engine does not have; null: none is given. */
static const char *find_native(const wh_run_arguments_t *arguments) {
    return arguments->run.limits.trust   ? "--trust"
           : arguments->memory_mib > 0   ? "--memory"
           : arguments->counting.counted ? "--counted"
           : arguments->run.until_steady ? "--until-steady"
           : arguments->errors.count > 0 ? "--error"
                                         : NULL;
}

void wh_run_again_check(const void *filled, struct argp_state *state) {
    const wh_run_arguments_t *arguments = filled;
    const char *native = find_native(arguments);
    if (arguments->plays_again && !arguments->files.page) {
        argp_error(state, "--live: in which page? (goes with --report FILE)");
    }
    if (arguments->plays_again && native) {
        argp_error(state, "--live does not go with %s, which a page does not have", native);
    }
}

/* ----------------------------------------------------------------------------------------------- counting */

const wh_option_t wh_run_counting_options[] = {
    {"counted", 0, NULL,
     "Leave out slices in which nothing can be decided; collisions are not looked for while something moves "
     "in them",
     WH_OPTION_FLAG, .variable = offsetof(wh_run_arguments_t, counting.counted)},
    {"strict", 0, NULL, "With --counted: refuse a cell with collision = true", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, counting.strict)},
    {"verify", 0, "N",
     "With --counted: play at least N stretches of the slices that could be left out, from all of the run, "
     "and "
     "fail if something is decided in them",
     WH_OPTION_WHOLE, .variable = offsetof(wh_run_arguments_t, counting.verify), 1, 1000000000},
    {0}};

void wh_run_counting_check(const void *filled, struct argp_state *state) {
    const wh_run_counting_t *counting = &((const wh_run_arguments_t *)filled)->counting;
    if ((counting->strict || counting->verify > 0) && !counting->counted) {
        argp_error(state, "%s goes with --counted", counting->strict ? "--strict" : "--verify");
    }
}

static wh_mcs_count_t counts_of(const wh_run_counting_t *counting) {
    return !counting->counted ? WH_MCS_COUNT_NONE : counting->strict ? WH_MCS_COUNT_STRICT : WH_MCS_COUNT;
}

/* ------------------------------------------------------------------------------------------------ writing */

static bool write_plots(const wh_document_t *document, const char *folder) {
    char message[WH_PLOTS_MESSAGE_BYTES] = "";
    if (folder && !wh_plots_write(document, folder, message)) {
        fprintf(stderr, "--svg %s: not written: %s\n", folder, message);
        return false;
    }
    return true;
}

bool wh_run_files_are_apart(const wh_run_arguments_t *arguments, const char *input) {
    const wh_run_files_t *files = &arguments->files;
    const bool is_told = arguments->recording && !wh_recording_is_sound(arguments->recording);
    const char *record = is_told ? NULL : arguments->record;
    const wh_named_file_t named[] = {{"the input", arguments->run.script, false},
                                     {"the layout", input, false},
                                     {"--report", files->page, true},
                                     {"--gltf", files->scene, true},
                                     {"--data", files->document, true},
                                     {"--svg", files->plots, true},
                                     {"--segments", arguments->segments_path, true},
                                     {"--history", arguments->history_path, true},
                                     {"--schedule", arguments->schedule_path, true},
                                     {arguments->record_option, record, true},
                                     {"--outputs", arguments->outputs, true}};
    return wh_files_are_apart(named, sizeof named / sizeof named[0], arguments->json || !arguments->quiet);
}

const char *wh_run_subcommand(const wh_run_arguments_t *arguments) {
    return arguments->command ? arguments->command : "run";
}

bool wh_run_files_write(const wh_run_arguments_t *arguments, const wh_document_t *document) {
    const wh_run_files_t *files = &arguments->files;
    const bool is_log = strcmp(document->source, "log") == 0;
    wh_run_written_t whole;
    if (!wh_run_files_wanted(files)) {
        return true;
    }
    wh_run_written_open(&whole, document, &arguments->run, is_log ? "replay" : wh_run_subcommand(arguments));
    whole.cell = arguments->reel.cell;
    whole.engine = arguments->reel.engine;
    const bool written = wh_file_write("--data", files->document, wh_run_written_document, &whole, NULL) &&
                         wh_file_write("--gltf", files->scene, wh_run_written_scene, &whole, NULL) &&
                         wh_file_write("--report", files->page, wh_run_written_page, &whole, whole.message) &&
                         write_plots(&whole.document, files->plots);
    wh_run_written_close(&whole);
    return written;
}

/* -------------------------------------------------------------------------------------------------- a run */

int wh_run_print(const wh_run_arguments_t *arguments, const wh_record_t *record) {
    if (arguments->json) {
        return wh_record_print_json(record, stdout);
    }
    if (arguments->quiet) {
        return 0;
    }
    const wh_style_t style = wh_style_of(stdout);
    return wh_record_print_table(record, stdout, &style, &arguments->sections);
}

/* Robots that are times alone have no scene. */
static bool write_report(const wh_run_arguments_t *arguments, const wh_script_run_t *run,
                         wh_signals_t *signals) {
    char message[WH_SANDBOX_MESSAGE_BYTES];
    wh_document_t document;
    const wh_layout_t *layout = run->record.layout;
    if (!wh_run_files_wanted(&arguments->files)) {
        return true;
    }
    if (layout && layout->tool && arguments->files.scene) {
        fprintf(stderr,
                "%s: nothing to show (expected robots with axes for --gltf: here they are times alone)\n",
                layout->path);
        return false;
    }
    if (!wh_run_document(run, arguments->run.script, signals, &document, message)) {
        fprintf(stderr, "%s\n", message);
        return false;
    }
    return wh_run_files_write(arguments, &document);
}

typedef struct {
    const wh_run_arguments_t *arguments;
    const wh_flow_figures_t *figures;
} history_t;

/* False, with a message, for a run that cannot be played again. */
static bool make_segments(const wh_run_arguments_t *arguments, const wh_mcs_t *mcs, wh_segments_t *segments) {
    const char *path = arguments->segments_path;
    const char *expected = path ? wh_segments_make(segments, mcs, path) : NULL;
    if (expected) {
        fprintf(stderr, "--segments: %s: not written (expected %s)\n", path, expected);
    }
    return !expected;
}

static bool write_history(void *user, FILE *out) {
    const wh_run_arguments_t *arguments = ((const history_t *)user)->arguments;
    const char *end = strrchr(arguments->history_path, '.');
    return wh_flow_history_write(((const history_t *)user)->figures, end && strcmp(end, ".csv") == 0, out);
}

static bool write_schedule(void *user, FILE *out) {
    return wh_schedule_write(((const history_t *)user)->figures, out);
}

static bool is_flow_played(const wh_record_t *record) {
    return record->flow && record->flow->figures.tool;
}

/* False, with a message, for a run without the flow that the file of an option tells of. A flow that was
 * refused has failed the run: its file is not written, either. */
static bool has_flow(const char *option, const char *path, const wh_record_t *record) {
    if (path && !is_flow_played(record)) {
        fprintf(stderr, "%s: %s: not written (expected a %s)\n", option, path,
                record->flow ? "flow that is played" : "script with a flow");
    }
    return !path || record->flow;
}

/* Nothing is written of a flow that is not there, which `has_flow` has told. */
static bool write_flow_files(const wh_run_arguments_t *arguments, const wh_record_t *record) {
    if (!is_flow_played(record)) {
        return true;
    }
    history_t history = {arguments, &record->flow->figures};
    return wh_file_write("--history", arguments->history_path, write_history, &history, NULL) &&
           wh_file_write("--schedule", arguments->schedule_path, write_schedule, &history, NULL);
}

static bool write_files(const wh_run_arguments_t *arguments, const wh_script_run_t *run,
                        wh_signals_t *signals) {
    const char *layout = run->record.layout ? run->record.layout->path : NULL;
    wh_segments_t segments = {0};
    const bool good =
        wh_run_files_are_apart(arguments, layout) && make_segments(arguments, &run->mcs, &segments) &&
        has_flow("--history", arguments->history_path, &run->record) &&
        has_flow("--schedule", arguments->schedule_path, &run->record) &&
        write_flow_files(arguments, &run->record) &&
        wh_file_write("--segments", arguments->segments_path, wh_segments_write, &segments, NULL) &&
        write_report(arguments, run, signals);
    wh_segments_free(&segments);
    return good;
}

/* Handles a script that ends with an error of its own: the run before it is shown, if it has a slice,
 * together with the error. */
static int hand_on_bad(const wh_run_arguments_t *arguments, const wh_script_run_t *run,
                       wh_signals_t *signals) {
    fprintf(stderr, "%s\n", run->message);
    if (run->record.layout && run->record.slices > 0 &&
        wh_run_files_are_apart(arguments, run->record.layout->path) &&
        write_report(arguments, run, signals) && arguments->json) {
        (void)wh_app_is_printed(wh_run_print(arguments, &run->record));
    }
    return WH_EXIT_USAGE;
}

/* A run is not reported as good if its recording failed, or if the valves were not written. Returns true if
 * it failed so. */
static bool note_unwritten(const wh_run_arguments_t *arguments, wh_record_t *record) {
    char text[PATH_MAX + 100] = "";
    if (arguments->recording && !wh_recording_is_sound(arguments->recording)) {
        (void)snprintf(text, sizeof text, "%s %s: the recording failed", arguments->record_option,
                       arguments->record);
    } else if (arguments->unwritten && *arguments->unwritten > 0) {
        (void)snprintf(text, sizeof text, WH_OUTPUTS_UNWRITTEN, arguments->outputs);
    } else if (arguments->disturbance) {
        (void)snprintf(text, sizeof text, "%s", arguments->disturbance);
    }
    if (text[0] == '\0') {
        return false;
    }
    record->ok = false;
    record->failure = record->failure ? record->failure : wh_text_copy(text);
    return true;
}

static int hand_on(const wh_run_arguments_t *arguments, wh_script_run_t *run, wh_signals_t *signals,
                   wh_script_run_outcome_t outcome) {
    if (outcome == WH_RUN_BAD_INPUT) {
        return hand_on_bad(arguments, run, signals);
    }
    const bool is_told = note_unwritten(arguments, &run->record);
    if (!write_files(arguments, run, signals) || !wh_app_is_printed(wh_run_print(arguments, &run->record))) {
        return WH_EXIT_USAGE;
    }
    /* The table ends with the failure. Without a terminal nobody sees the table, so it goes to standard
     * error, too. */
    if (run->record.failure && !is_told && (arguments->json || !isatty(STDOUT_FILENO))) {
        fprintf(stderr, "%s\n", run->record.failure);
    }
    return outcome == WH_RUN_MET ? WH_EXIT_MET : WH_EXIT_FAILED;
}

/* The first option that shows, or plays, what robots of times alone do not have; null: none is given. */
static const char *find_axes_option(const wh_run_arguments_t *arguments) {
    const char *table = wh_run_table_wanted(arguments);
    const wh_run_counting_t *counting = &arguments->counting;
    return table                         ? table
           : counting->strict            ? "--strict"
           : counting->verify > 0        ? "--verify"
           : arguments->segments_path    ? "--segments"
           : arguments->files.scene      ? "--gltf"
           : arguments->errors.count > 0 ? "--error"
                                         : NULL;
}

void wh_run_arguments_take(wh_run_arguments_t *arguments) {
    arguments->run.parameters = arguments->parameters.items;
    arguments->run.parameter_count = arguments->parameters.count;
    arguments->run.errors = arguments->errors.items;
    arguments->run.error_count = arguments->errors.count;
    arguments->run.limits.instructions = (uint64_t)arguments->budget;
    arguments->run.limits.memory_bytes = (size_t)(arguments->memory_mib * 1048576);
    arguments->run.counts = counts_of(&arguments->counting);
    arguments->run.verify = arguments->counting.verify;
    arguments->run.needs_axes = find_axes_option(arguments);
}

void wh_run_arguments_free(wh_run_arguments_t *arguments) {
    wh_option_list_free(&arguments->parameters);
    wh_option_list_free(&arguments->errors);
}

/* Takes along what its page needs to play the run again, if that is wanted. */
static bool open_reel(wh_run_arguments_t *arguments) {
    char message[WH_PAGE_MESSAGE_BYTES];
    if (!arguments->plays_again) {
        return true;
    }
    if (!wh_reel_open(&arguments->reel, message)) {
        fprintf(stderr, "--live: %s\n", message);
        return false;
    }
    wh_reel_hear(&arguments->reel);
    return true;
}

static bool may_begin(wh_run_arguments_t *arguments) {
    return wh_run_files_are_apart(arguments, NULL) && open_reel(arguments);
}

static wh_script_run_outcome_t play(wh_run_arguments_t *arguments, wh_script_run_t *run) {
    const wh_script_run_outcome_t outcome = wh_script_run(run, &arguments->run);
    if (arguments->plays_again) {
        wh_reel_pack(&arguments->reel, &arguments->run);
    }
    return outcome;
}

int wh_run_and_print(wh_run_arguments_t *arguments) {
    wh_script_run_t run;
    wh_signals_t signals = {0};
    if (!may_begin(arguments)) {
        return WH_EXIT_USAGE;
    }
    if (wh_run_files_wanted(&arguments->files)) {
        arguments->run.listener = wh_run_listener(&signals);
    }
    arguments->run.listener = wh_live_listener(arguments->live, &arguments->run.listener);
    arguments->run.keep_segments = arguments->segments_path != NULL;
    arguments->run.drops_rows = arguments->sections.brief;
    arguments->run.keeps = arguments->sections.brief ? WH_FLOW_SUMS
                           : arguments->schedule_path || wh_run_files_wanted(&arguments->files)
                               ? WH_FLOW_WAYS
                               : WH_FLOW_VISITS;
    arguments->run.limits.print_to = arguments->json ? stderr : stdout;
    const wh_script_run_outcome_t outcome = play(arguments, &run);
    int status = hand_on(arguments, &run, &signals, outcome);
    if (run.record.layout && wh_live_shows(arguments->live, run.record.layout)) {
        wh_live_stay(arguments->live);
    } else if (arguments->live) {
        status = WH_EXIT_USAGE;
    }
    wh_live_close(arguments->live); /* it has the run's layout */
    arguments->live = NULL;
    wh_signals_close(&signals);
    wh_script_run_close(&run);
    wh_reel_close(&arguments->reel);
    return status;
}

int wh_run_watch(const wh_run_arguments_t *arguments, int (*act)(void *user), void *user) {
    const char *const outputs[] = {
        arguments->files.page,    arguments->files.scene,  arguments->files.document, arguments->files.plots,
        arguments->segments_path, arguments->history_path, arguments->schedule_path};
    const wh_watch_options_t options = {act, user, outputs, sizeof outputs / sizeof outputs[0]};
    return wh_watch(&options);
}
