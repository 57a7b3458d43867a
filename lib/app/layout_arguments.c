#include "layout_arguments.h"

#include <errno.h>
#include <stdlib.h>

#include "app.h"

enum { OPTION_SET = 3000 };

static const struct argp_option options[] = {
    {"set", OPTION_SET, "NAME=VALUE", 0, "Hand the layout a parameter: params.NAME", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state) {
    wh_layout_arguments_t *arguments = state->input;
    switch (key) {
    case OPTION_SET:
        arguments->parameters[arguments->parameter_count++] = argument;
        return 0;
    case ARGP_KEY_ARG:
        if (arguments->path) {
            argp_error(state, "%s: one layout is enough", argument);
        }
        arguments->path = argument;
        return 0;
    case ARGP_KEY_NO_ARGS:
        argp_error(state, "which layout?");
        return EINVAL;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp wh_layout_argp = {options, parse, "LAYOUT", NULL, NULL, NULL, NULL};

void wh_layout_arguments_init(wh_layout_arguments_t *arguments, int argc) {
    arguments->parameters = calloc((size_t)argc + 1, sizeof *arguments->parameters);
    arguments->sandbox = wh_sandbox_new(NULL);
    if (!arguments->parameters || !arguments->sandbox) {
        perror("waferhand");
        exit(WH_EXIT_USAGE);
    }
}

void wh_layout_arguments_free(wh_layout_arguments_t *arguments) {
    wh_sandbox_free(arguments->sandbox);
    free(arguments->parameters);
}

const wh_layout_t *wh_layout_arguments_load(const wh_layout_arguments_t *arguments) {
    wh_sandbox_result_t result;
    bool taken = true;
    for (size_t i = 0; taken && i < arguments->parameter_count; ++i) {
        taken = wh_sandbox_set_parameter(arguments->sandbox, arguments->parameters[i], &result);
    }
    const wh_layout_t *layout = taken ? wh_layout_load(arguments->sandbox, arguments->path, &result) : NULL;
    if (!layout) {
        fprintf(stderr, "%s\n", result.message);
    }
    return layout;
}
