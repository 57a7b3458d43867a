/* waferhand layout LAYOUT */
#include <stdlib.h>

#include "../print/drawing.h"
#include "../print/layout_print.h"
#include "../reading/layout_read.h"
#include "../survey/survey.h"
#include "../text/array.h"
#include "apart.h"
#include "app.h"
#include "layout_arguments.h"
#include "teller.h"
#include "watch.h"

/* -------------------------------------------------------------------------------------- what sim has, too */

const wh_option_t wh_layout_options[] = {
    {"set", 0, "NAME=VALUE",
     "Hand the layout a parameter, params.NAME: a number if VALUE is one, true, false or text",
     WH_OPTION_LIST, .variable = offsetof(wh_layout_arguments_t, parameters)},
    {"memory", 0, "MIB", "Let the layout use so many MiB of memory (default 256)", WH_OPTION_REAL,
     .variable = offsetof(wh_layout_arguments_t, memory_mib), 1, 1e6},
    {0}};

/* True if a parameter that nobody read is refused: standard error then says so. */
static bool is_unread_refused(const wh_layout_arguments_t *arguments) {
    char unread[WH_SANDBOX_MESSAGE_BYTES];
    const bool is_refused = arguments->refuses_unread && wh_sandbox_find_unread(arguments->sandbox, unread);
    if (is_refused) {
        fprintf(stderr, "%s: %s\n", arguments->path, unread);
    }
    return is_refused;
}

const wh_layout_t *wh_layout_arguments_load(wh_layout_arguments_t *arguments) {
    wh_sandbox_result_t result;
    const wh_sandbox_limits_t limits = {.memory_bytes = (size_t)(arguments->memory_mib * 1048576)};
    wh_sandbox_t *sandbox =
        wh_sandbox_new_with(&limits, arguments->parameters.items, arguments->parameters.count, &result);
    const wh_layout_t *layout = !sandbox ? NULL
                                : arguments->is_timed
                                    ? wh_layout_load_timed(sandbox, arguments->path, &result)
                                    : wh_layout_load(sandbox, arguments->path, &result);
    arguments->sandbox = sandbox;
    if (!layout) {
        fprintf(stderr, "%s\n", result.message);
    } else if (!layout->patterns && is_unread_refused(arguments)) {
        return NULL;
    } else if (!layout->patterns) {
        wh_layout_arguments_note(arguments);
    }
    return layout;
}

void wh_layout_arguments_note(const wh_layout_arguments_t *arguments) {
    char unread[WH_SANDBOX_MESSAGE_BYTES];
    if (wh_sandbox_find_unread(arguments->sandbox, unread)) {
        fprintf(stderr, "%s: note: %s\n", arguments->path, unread);
    }
}

void wh_layout_arguments_free(wh_layout_arguments_t *arguments) {
    wh_sandbox_free(arguments->sandbox);
    wh_option_list_free(&arguments->parameters);
}

/* ------------------------------------------------------------------------------------------------- layout */

typedef struct {
    wh_layout_arguments_t layout;
    const char *svg;
    bool json, watch;
} arguments_t;

static const wh_option_t options[] = {
    {"json", 0, NULL, "Print one JSON object instead of tables", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, json)},
    {"svg", 0, "FILE", "Also draw the cell into FILE, from above and from the side", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, svg)},
    {"watch", 0, NULL, WH_WATCH_HELP, WH_OPTION_FLAG, .variable = offsetof(arguments_t, watch)},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL}, {wh_layout_options, offsetof(arguments_t, layout), NULL, NULL}, {0}};

static const wh_command_line_t command_line = {
    .name = "layout",
    .synopsis = "LAYOUT",
    .about = "Lists what a layout describes, checks it before anything moves, and draws it.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "layout",
    .operand_variable = offsetof(arguments_t, layout.path)};

static bool write_svg(void *check, FILE *out) {
    return wh_layout_print_svg(check, out) == 0;
}

/* Checked after the layout is read, because then all files that it reads are known. */
static bool is_apart(const arguments_t *arguments) {
    const wh_named_file_t named[] = {{"the layout", arguments->layout.path, false},
                                     {"--svg", arguments->svg, true}};
    return wh_files_are_apart(named, 2, true) &&
           (!arguments->svg || wh_file_is_free("--svg", arguments->svg));
}

static int print(const arguments_t *arguments, const wh_feasibility_t *check) {
    const wh_style_t style = wh_style_of(stdout);
    const int status =
        arguments->json ? wh_layout_print_json(check, stdout) : wh_layout_print_table(check, stdout, &style);
    if (!wh_app_is_printed(status)) {
        return WH_EXIT_USAGE;
    }
    return check->wrong > 0 ? WH_EXIT_FAILED : WH_EXIT_MET;
}

static void tell_progress(void *user, const char *what, size_t done, size_t total) {
    wh_teller_tell(user, what, done, total);
}

/* Adds what a run would refuse. */
static bool survey(const arguments_t *arguments, const wh_layout_t *layout, wh_feasibility_t *check) {
    wh_sandbox_result_t result;
    wh_survey_t *planned = wh_array_new(1, sizeof *planned);
    wh_teller_t teller;
    wh_teller_begin(&teller, "layout");
    planned->tell = tell_progress;
    planned->user = &teller;
    const bool good = wh_survey_open(planned, arguments->layout.sandbox, layout, check, &result);
    wh_teller_end(&teller);
    if (!good) {
        fprintf(stderr, "%s\n", result.message);
    }
    wh_survey_close(planned);
    free(planned);
    return good;
}

static int look_at(const arguments_t *arguments, const wh_layout_t *layout) {
    wh_feasibility_t check;
    int status = WH_EXIT_USAGE;
    wh_feasibility(&check, layout);
    const bool good = is_apart(arguments) && survey(arguments, layout, &check);
    if (good && layout->patterns) {
        wh_layout_arguments_note(&arguments->layout);
    }
    if (good && wh_file_write("--svg", arguments->svg, write_svg, &check, NULL)) {
        status = print(arguments, &check);
    }
    wh_feasibility_free(&check);
    return status;
}

static int act(void *user) {
    arguments_t *arguments = user;
    const wh_layout_t *layout = wh_layout_arguments_load(&arguments->layout);
    return layout ? look_at(arguments, layout) : WH_EXIT_USAGE;
}

int wh_app_layout(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    const wh_watch_options_t watch = {act, &arguments, &arguments.svg, 1};
    const int status = arguments.watch ? wh_watch(&watch) : act(&arguments);
    wh_layout_arguments_free(&arguments.layout);
    return status;
}
