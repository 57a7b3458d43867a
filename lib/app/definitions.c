/* waferhand definitions */
#include <stdlib.h>

#include "../mcs/definitions.h"
#include "../text/options.h"
#include "apart.h"
#include "app.h"

typedef struct {
    const char *path, *operand;
} arguments_t;

static const wh_option_t options[] = {{"output", 'o', "FILE",
                                       "Write them into FILE instead of standard output", WH_OPTION_TEXT,
                                       .variable = offsetof(arguments_t, path)},
                                      {0}};

static const wh_option_table_t tables[] = {{options, 0, NULL, NULL}, {0}};

static void check_definitions_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (arguments->operand) {
        argp_error(state, "%s: one argument too many (expected none)", arguments->operand);
    }
}

static const wh_command_line_t command_line = {
    .name = "definitions",
    .synopsis = "",
    .about = "Prints what layouts and scripts may say, for editors that use the Lua language server: they "
             "complete fields and words, and underline what is none. A folder with this as definitions.lua, "
             "as waferhand new makes one, is enough.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "argument",
    .operand_variable = offsetof(arguments_t, operand),
    .operand_may_lack = true,
    .check = check_definitions_arguments};

static bool write_text(void *text, FILE *out) {
    return fputs(text, out) != EOF;
}

static bool hand_on(const arguments_t *arguments, char *text) {
    if (arguments->path) {
        return wh_file_write("-o", arguments->path, write_text, text, NULL);
    }
    return wh_app_is_printed(write_text(text, stdout) ? 0 : -1);
}

int wh_app_definitions(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_sandbox_result_t result;
    wh_options_parse(&command_line, argc, argv, &arguments);
    char *text = wh_definitions_make(&result);
    if (!text) {
        fprintf(stderr, "%s\n", result.message);
        return WH_EXIT_USAGE;
    }
    const bool written = hand_on(&arguments, text);
    free(text);
    return written ? WH_EXIT_MET : WH_EXIT_USAGE;
}
