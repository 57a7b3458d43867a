/* waferhand layout LAYOUT */
#include <argp.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/layout_report.h"
#include "app/layout_svg.h"
#include "script/layout_load.h"

enum { OPTION_JSON = 1000, OPTION_SVG, OPTION_SET };

typedef struct {
    const char *layout, *svg;
    const char **parameters; /* room for one for each argument */
    size_t parameter_count;
    bool json;
} arguments_t;

static const struct argp_option options[] = {
    {"json", OPTION_JSON, NULL, 0, "Print one JSON object instead of tables", 0},
    {"svg", OPTION_SVG, "FILE", 0, "Also draw the cell into FILE, from above and from the side", 0},
    {"set", OPTION_SET, "NAME=VALUE", 0, "Hand the layout a parameter: params.NAME", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state) {
    arguments_t *arguments = state->input;
    switch (key) {
    case OPTION_JSON:
        arguments->json = true;
        return 0;
    case OPTION_SVG:
        arguments->svg = argument;
        return 0;
    case OPTION_SET:
        arguments->parameters[arguments->parameter_count++] = argument;
        return 0;
    case ARGP_KEY_ARG:
        if (arguments->layout) {
            argp_error(state, "%s: one layout is enough", argument);
        }
        arguments->layout = argument;
        return 0;
    case ARGP_KEY_NO_ARGS:
        argp_error(state, "which layout?");
        return EINVAL;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static bool write_svg(const wh_layout_check_t *check, const char *path) {
    FILE *file = fopen(path, "w");
    bool written = file && wh_layout_print_svg(check, file) == 0;
    if (file) {
        written = fclose(file) == 0 && written;
    }
    if (!written) {
        fprintf(stderr, "%s: %s (expected a file that can be written)\n", path, strerror(errno));
    }
    return written;
}

static int print(const arguments_t *arguments, const wh_layout_check_t *check) {
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
    wh_layout_check_t check;
    int status = WH_EXIT_USAGE;
    if (!wh_layout_check(&check, layout)) {
        perror("waferhand");
    } else if (!arguments->svg || write_svg(&check, arguments->svg)) {
        status = print(arguments, &check);
    }
    wh_layout_check_free(&check);
    return status;
}

static int run(const arguments_t *arguments, wh_sandbox_t *sandbox) {
    wh_sandbox_result_t result;
    for (size_t i = 0; i < arguments->parameter_count; ++i) {
        if (!wh_sandbox_set_parameter(sandbox, arguments->parameters[i], &result)) {
            fprintf(stderr, "%s\n", result.message);
            return WH_EXIT_USAGE;
        }
    }
    const wh_layout_t *layout = wh_layout_load(sandbox, arguments->layout, &result);
    if (!layout) {
        fprintf(stderr, "%s\n", result.message);
        return WH_EXIT_USAGE;
    }
    return look_at(arguments, layout);
}

int wh_app_layout(int argc, char **argv) {
    static const struct argp argp = {
        options,
        parse,
        "LAYOUT",
        "Lists what a layout describes, checks it before anything moves, and draws it.\v"
        "Exit status: 0 if nothing is wrong with it, 1 if something is, 2 for wrong usage or a "
        "bad input file.",
        NULL,
        NULL,
        NULL};
    static char name[] = "waferhand layout";
    arguments_t arguments = {0};
    arguments.parameters = calloc((size_t)argc + 1, sizeof *arguments.parameters);
    wh_sandbox_t *sandbox = wh_sandbox_new(NULL);
    if (!arguments.parameters || !sandbox) {
        perror("waferhand");
        free(arguments.parameters);
        return WH_EXIT_USAGE;
    }
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &arguments);
    const int status = run(&arguments, sandbox);
    wh_sandbox_free(sandbox);
    free(arguments.parameters);
    return status;
}
