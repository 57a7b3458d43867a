/* waferhand layout LAYOUT */
#include <errno.h>
#include <string.h>

#include "../layout/drawing.h"
#include "../print/layout_print.h"
#include "../text/output.h"
#include "app.h"
#include "layout_arguments.h"

enum { OPTION_JSON = 1000, OPTION_SVG };

typedef struct {
    wh_layout_arguments_t layout;
    const char *svg;
    bool json;
} arguments_t;

static const struct argp_option options[] = {
    {"json", OPTION_JSON, NULL, 0, "Print one JSON object instead of tables", 0},
    {"svg", OPTION_SVG, "FILE", 0, "Also draw the cell into FILE, from above and from the side", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state) {
    arguments_t *arguments = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &arguments->layout;
        return 0;
    case OPTION_JSON:
        arguments->json = true;
        return 0;
    case OPTION_SVG:
        arguments->svg = argument;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

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
    if (status != 0 || fflush(stdout) != 0) {
        fprintf(stderr, "standard output: %s\n", strerror(errno));
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

static int run(const arguments_t *arguments) {
    const wh_layout_t *layout = wh_layout_arguments_load(&arguments->layout);
    return layout ? look_at(arguments, layout) : WH_EXIT_USAGE;
}

int wh_app_layout(int argc, char **argv) {
    static const struct argp_child children[] = {{&wh_layout_argp, 0, NULL, 0}, {0}};
    static const struct argp argp = {
        options,
        parse,
        NULL,
        "Lists what a layout describes, checks it before anything moves, and draws it.\v"
        "Exit status: 0 if nothing is wrong with it, 1 if something is, 2 for wrong usage or a "
        "bad input file.",
        children,
        NULL,
        NULL};
    static char name[] = "waferhand layout";
    arguments_t arguments = {0};
    wh_layout_arguments_init(&arguments.layout, argc);
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &arguments);
    const int status = run(&arguments);
    wh_layout_arguments_free(&arguments.layout);
    return status;
}
