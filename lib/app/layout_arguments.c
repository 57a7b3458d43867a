#include "layout_arguments.h"

#include <stdio.h>

const wh_option_t wh_layout_options[] = {{"set", 0, "NAME=VALUE", "Hand the layout a parameter: params.NAME",
                                          WH_OPTION_LIST,
                                          .variable = offsetof(wh_layout_arguments_t, parameters)},
                                         {0}};

const wh_layout_t *wh_layout_arguments_load(wh_layout_arguments_t *arguments) {
    wh_sandbox_result_t result;
    arguments->sandbox = wh_sandbox_new(NULL);
    if (!arguments->sandbox) {
        perror("waferhand");
        return NULL;
    }
    bool taken = true;
    for (size_t i = 0; taken && i < arguments->parameters.count; ++i) {
        taken = wh_sandbox_set_parameter(arguments->sandbox, arguments->parameters.items[i], &result);
    }
    const wh_layout_t *layout = taken ? wh_layout_load(arguments->sandbox, arguments->path, &result) : NULL;
    if (!layout) {
        fprintf(stderr, "%s\n", result.message);
    }
    return layout;
}

void wh_layout_arguments_free(wh_layout_arguments_t *arguments) {
    wh_sandbox_free(arguments->sandbox);
    wh_option_list_free(&arguments->parameters);
}
