/* A script's run, for `run` and `mcs`, and the files that it is written to. */
#include "run_arguments.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../print/record_print.h"
#include "../report/page.h"
#include "../report/plots.h"
#include "../text/array.h"
#include "../text/output.h"
#include "../text/style.h"
#include "../view/scene.h"
#include "apart.h"
#include "app.h"
#include "segments.h"

const wh_option_t wh_run_options[] = {
    {"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, json)},
    {"gantt", 0, NULL, "Also print who was busy when, and what each command's time went into", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, gantt)},
    {"margins", 0, NULL, "Also print how near the axes come to the ends of their travel at each station",
     WH_OPTION_FLAG, .variable = offsetof(wh_run_arguments_t, margins)},
    {"segments", 0, "FILE",
     "Write the run as C source that a firmware test plays; its names begin with FILE's, in which all but "
     "ASCII "
     "letters and digits becomes _",
     WH_OPTION_TEXT, .variable = offsetof(wh_run_arguments_t, segments_path)},
    {"set", 0, "NAME=VALUE", "Hand the script a parameter: params.NAME", WH_OPTION_LIST,
     .variable = offsetof(wh_run_arguments_t, parameters)},
    {"trust", 0, NULL, "Let the script use all of Lua, files and native modules too", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, run.limits.trust)},
    {"budget", 0, "N", "End the script after N steps of Lua and simulated slices (default 1e9)",
     WH_OPTION_REAL, .variable = offsetof(wh_run_arguments_t, budget), 1, 1e18, "a number from 1 to 1e+18"},
    {"memory", 0, "MIB", "Let the script use so many MiB of memory (default 256)", WH_OPTION_REAL,
     .variable = offsetof(wh_run_arguments_t, memory_mib), 1, 1e6, "a number from 1 to 1e+06"},
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

bool wh_run_files_wanted(const wh_run_files_t *files) {
    return files->page || files->scene || files->document || files->plots;
}

/* ---------------------------------------------------------------------------------------------- listening */

static void on_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    if (state->status == WH_OK) {
        wh_signals_slice(user, command->axes, command->axis_count, state);
    }
}

static void on_boundary(void *user, const wh_layout_t *layout) {
    wh_signals_t *signals = user;
    if (!signals->layout) {
        wh_signals_begin(signals, layout, true);
    } else if (signals->last > 0) {
        wh_signals_mark(signals);
    }
}

/* ------------------------------------------------------------------------------------------------ command */

/* Writes a word so that a shell reads it back unchanged. */
static void write_word(FILE *out, const char *word) {
    const char *plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./=+,:@%";
    if (word[0] != '\0' && word[strspn(word, plain)] == '\0') {
        fputs(word, out);
        return;
    }
    fputc('\'', out);
    for (const char *c = word; *c; ++c) {
        if (*c == '\'') {
            fputs("'\\''", out);
        } else {
            fputc((unsigned char)*c, out);
        }
    }
    fputc('\'', out);
}

char *wh_run_files_command(const char *command, const char *file, const char *const parameters[],
                           size_t count) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = wh_memory_need(open_memstream(&text, &size));
    fprintf(out, "waferhand %s ", command);
    write_word(out, file);
    for (size_t i = 0; i < count; ++i) {
        fputs(" --set ", out);
        write_word(out, parameters[i]);
    }
    (void)fclose(out);
    return text;
}

/* ------------------------------------------------------------------------------------------------ writing */

typedef struct {
    const wh_document_t *document;
    char *text; /* the document's */
    size_t size;
    char message[WH_PAGE_MESSAGE_BYTES]; /* why a page was not written; empty: errno says it */
} content_t;

/* Writes one of the files. */
typedef bool writer_t(content_t *content, FILE *out);

static bool write_page(content_t *content, FILE *out) {
    return wh_page_write(out, content->document->title, content->text, content->size, content->message);
}

static bool write_scene(content_t *content, FILE *out) {
    json_t *scene = wh_scene_make(content->document->signals, content->document->title, true);
    const bool written = json_dumpf(scene, out, JSON_COMPACT | JSON_REAL_PRECISION(9)) == 0;
    json_decref(scene);
    return written && fputc('\n', out) != EOF;
}

static bool write_document(content_t *content, FILE *out) {
    return fwrite(content->text, 1, content->size, out) == content->size;
}

static bool write_file(content_t *content, const char *path, writer_t *writer) {
    wh_output_t output = {0};
    if (!path) {
        return true;
    }
    const bool written =
        wh_output_open(&output, path) && writer(content, output.file) && wh_output_commit(&output);
    const int reason = errno;
    wh_output_drop(&output);
    if (!written && content->message[0] != '\0') {
        fprintf(stderr, "%s: not written: %s\n", path, content->message);
    } else if (!written) {
        fprintf(stderr, "%s: %s (expected a file that can be written)\n", path, strerror(reason));
    }
    return written;
}

static bool write_plots(const wh_document_t *document, const char *folder) {
    char message[WH_PLOTS_MESSAGE_BYTES] = "";
    if (folder && !wh_plots_write(document, folder, message)) {
        fprintf(stderr, "%s: not written: %s\n", folder, message);
        return false;
    }
    return true;
}

bool wh_run_files_are_apart(const wh_run_arguments_t *arguments, const char *input) {
    const wh_run_files_t *files = &arguments->files;
    const wh_named_file_t named[] = {{"the input", arguments->run.script, false},
                                     {"the layout", input, false},
                                     {"--report", files->page, true},
                                     {"--gltf", files->scene, true},
                                     {"--data", files->document, true},
                                     {"--svg", files->plots, true},
                                     {"--segments", arguments->segments_path, true},
                                     {"the recording", arguments->record, false}};
    return wh_files_are_apart(named, sizeof named / sizeof named[0], arguments->json || !arguments->quiet);
}

bool wh_run_files_write(const wh_run_files_t *files, const wh_document_t *document) {
    wh_document_t whole = *document;
    content_t content = {.document = &whole};
    FILE *out = wh_memory_need(open_memstream(&content.text, &content.size));
    whole.run = wh_record_to_json(document->record);
    const bool made = wh_document_write(&whole, out) == 0;
    if (fclose(out) != 0 || !made) {
        wh_memory_out();
    }
    const bool written = write_file(&content, files->document, write_document) &&
                         write_file(&content, files->scene, write_scene) &&
                         write_file(&content, files->page, write_page) && write_plots(&whole, files->plots);
    free(content.text);
    json_decref(whole.run);
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
    const unsigned sections =
        (arguments->gantt ? WH_TABLE_GANTT : 0U) | (arguments->margins ? WH_TABLE_MARGINS : 0U);
    return wh_record_print_table(record, stdout, &style, sections);
}

static bool write_segments(const wh_run_arguments_t *arguments, const wh_script_run_t *run) {
    if (arguments->segments_path && wh_segments_write(&run->mcs, arguments->segments_path) != 0) {
        fprintf(stderr, "%s: %s (expected a file that can be written)\n", arguments->segments_path,
                strerror(errno));
        return false;
    }
    return true;
}

static bool write_report(const wh_run_arguments_t *arguments, const wh_script_run_t *run,
                         wh_signals_t *signals) {
    const wh_script_run_options_t *script = &arguments->run;
    if (!wh_run_files_wanted(&arguments->files)) {
        return true;
    }
    if (!run->record.layout) {
        fprintf(stderr, "%s: no cell (expected a script that names a layout: there is nothing to show)\n",
                script->script);
        return false;
    }
    if (!signals->layout) {
        wh_signals_begin(signals, run->record.layout, true);
    }
    wh_signals_finish(signals);
    char *command = wh_run_files_command(arguments->command ? arguments->command : "run", script->script,
                                         script->parameters, script->parameter_count);
    const wh_document_t document = {.title = script->script,
                                    .reproduce = command,
                                    .source = "run",
                                    .parameters = script->parameters,
                                    .parameter_count = script->parameter_count,
                                    .record = &run->record,
                                    .signals = signals};
    const bool written = wh_run_files_write(&arguments->files, &document);
    free(command);
    return written;
}

static bool write_files(const wh_run_arguments_t *arguments, const wh_script_run_t *run,
                        wh_signals_t *signals) {
    const char *layout = run->record.layout ? run->record.layout->path : NULL;
    return wh_run_files_are_apart(arguments, layout) && write_segments(arguments, run) &&
           write_report(arguments, run, signals);
}

/* A script that ends with an error of its own: what came before is shown, if a slice did, and the error with
 * it. */
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

static int hand_on(const wh_run_arguments_t *arguments, const wh_script_run_t *run, wh_signals_t *signals,
                   wh_script_run_outcome_t outcome) {
    if (outcome == WH_RUN_BAD_INPUT) {
        return hand_on_bad(arguments, run, signals);
    }
    if (!write_files(arguments, run, signals) || !wh_app_is_printed(wh_run_print(arguments, &run->record))) {
        return WH_EXIT_USAGE;
    }
    /* The table ends with the failure. Without a terminal nobody sees the table, so it goes to standard
     * error, too. */
    if (run->record.failure && (arguments->json || !isatty(STDOUT_FILENO))) {
        fprintf(stderr, "%s\n", run->record.failure);
    }
    return outcome == WH_RUN_MET ? WH_EXIT_MET : WH_EXIT_FAILED;
}

void wh_run_arguments_take(wh_run_arguments_t *arguments) {
    arguments->run.parameters = arguments->parameters.items;
    arguments->run.parameter_count = arguments->parameters.count;
    arguments->run.limits.instructions = (uint64_t)arguments->budget;
    arguments->run.limits.memory_bytes = (size_t)(arguments->memory_mib * 1048576);
}

void wh_run_arguments_free(wh_run_arguments_t *arguments) {
    wh_option_list_free(&arguments->parameters);
}

int wh_run_and_print(wh_run_arguments_t *arguments) {
    wh_script_run_t run;
    wh_signals_t signals = {0};
    if (!wh_run_files_are_apart(arguments, NULL)) {
        return WH_EXIT_USAGE;
    }
    if (wh_run_files_wanted(&arguments->files)) {
        arguments->run.listener = (wh_mcs_listener_t){on_slice, on_boundary, &signals};
    }
    arguments->run.keep_segments = arguments->segments_path != NULL;
    arguments->run.limits.print_to = arguments->json ? stderr : stdout;
    const wh_script_run_outcome_t outcome = wh_script_run(&run, &arguments->run);
    const int status = hand_on(arguments, &run, &signals, outcome);
    wh_signals_close(&signals);
    wh_script_run_close(&run);
    return status;
}
