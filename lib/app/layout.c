/* waferhand layout LAYOUT */
#include <errno.h>
#include <string.h>

#include "../layout/drawing.h"
#include "../print/layout_print.h"
#include "../text/output.h"
#include "app.h"
#include "layout_arguments.h"

/* -------------------------------------------------------------------------------------- what sim has, too */

const wh_option_t wh_layout_options[] = {{"set", 0, "NAME=VALUE", "Hand the layout a parameter: params.NAME",
                                          WH_OPTION_LIST,
                                          .variable = offsetof(wh_layout_arguments_t, parameters)},
                                         {0}};

const wh_layout_t *wh_layout_arguments_load(wh_layout_arguments_t *arguments) {
    wh_sandbox_result_t result;
    wh_sandbox_t *sandbox =
        wh_sandbox_new_with(NULL, arguments->parameters.items, arguments->parameters.count, &result);
    const wh_layout_t *layout = sandbox ? wh_layout_load(sandbox, arguments->path, &result) : NULL;
    arguments->sandbox = sandbox;
    if (!layout) {
        fprintf(stderr, "%s\n", result.message);
    }
    return layout;
}

void wh_layout_arguments_free(wh_layout_arguments_t *arguments) {
    wh_sandbox_free(arguments->sandbox);
    wh_option_list_free(&arguments->parameters);
}

/* ------------------------------------------------------------------------------------------------- layout */

typedef struct {
    wh_layout_arguments_t layout;
    const char *svg;
    bool json;
} arguments_t;

static const wh_option_t options[] = {{"json", 0, NULL, "Print one JSON object instead of tables",
                                       WH_OPTION_FLAG, .variable = offsetof(arguments_t, json)},
                                      {"svg", 0, "FILE",
                                       "Also draw the cell into FILE, from above and from the side",
                                       WH_OPTION_TEXT, .variable = offsetof(arguments_t, svg)},
                                      {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL}, {wh_layout_options, offsetof(arguments_t, layout), NULL}, {0}};

static const wh_command_line_t command_line = {
    .name = "layout",
    .synopsis = "LAYOUT",
    .about = "Lists what a layout describes, checks it before anything moves, and draws it.\v"
             "Exit status: 0 if nothing is wrong with it, 1 if something is, 2 for wrong usage or a bad "
             "input file.",
    .tables = tables,
    .operand = "layout",
    .operand_variable = offsetof(arguments_t, layout.path)};

static bool write_svg(const wh_feasibility_t *check, const char *path) {
    wh_output_t output = {0};
    const bool written = wh_output_open(&output, path) && wh_layout_print_svg(check, output.file) == 0 &&
                         wh_output_commit(&output);
    if (!written) {
        fprintf(stderr, "%s: %s (expected a file that can be written)\n", path, strerror(errno));
    }
    wh_output_drop(&output);
    return written;
}

static int print(const arguments_t *arguments, const wh_feasibility_t *check) {
    const wh_style_t style = wh_style_of(stdout);
    const int status =
        arguments->json ? wh_layout_print_json(check, stdout) : wh_layout_print_table(check, stdout, &style);
    if (!wh_app_is_printed(status)) {
        return WH_EXIT_USAGE;
    }
    return check->count > 0 ? WH_EXIT_FAILED : WH_EXIT_MET;
}

static int look_at(const arguments_t *arguments, const wh_layout_t *layout) {
    wh_feasibility_t check;
    int status = WH_EXIT_USAGE;
    wh_feasibility(&check, layout);
    if (!arguments->svg || write_svg(&check, arguments->svg)) {
        status = print(arguments, &check);
    }
    wh_feasibility_free(&check);
    return status;
}

int wh_app_layout(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    const wh_layout_t *layout = wh_layout_arguments_load(&arguments.layout);
    const int status = layout ? look_at(&arguments, layout) : WH_EXIT_USAGE;
    wh_layout_arguments_free(&arguments.layout);
    return status;
}
