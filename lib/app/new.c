/* waferhand new NAME */
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <unistd.h>

#include "../text/options.h"
#include "../text/output.h"
#include "app.h"
#include "new_cell.h"

/* A number that was not given. */
#define NONE UINT64_MAX

typedef struct {
    const char *folder;
    wh_new_cell_t cell;
} arguments_t;

static const wh_option_t options[] = {
    {"wafer", 0, "MM", "The wafers' diameter: 100, 125, 150, 200 or 300 (default)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, cell.wafer), 100, 300, "100, 125, 150, 200 or 300"},
    {"foups", 0, "N", "Number of FOUPs, of cassettes below 200 mm, or of a tool's load ports (default 2)",
     WH_OPTION_WHOLE, .variable = offsetof(arguments_t, cell.foups), 1, WH_NEW_FOUPS},
    {"blades", 0, "N", "Number of blades on the robot; of a tool, of the one at the modules (default 1)",
     WH_OPTION_WHOLE, .variable = offsetof(arguments_t, cell.blades), 1, WH_NEW_BLADES},
    {"tool", 0, NULL, "A tool whose robots are times alone: a layout for flows", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, cell.tool)},
    {"modules", 0, "N", "With --tool: number of process modules (default 4)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, cell.modules), 1, WH_NEW_MODULES},
    {"locks", 0, "N", "With --tool: number of load locks (default 2); 0: one robot serves all",
     WH_OPTION_WHOLE, .variable = offsetof(arguments_t, cell.locks), 0, WH_NEW_LOCKS},
    {"aligner", 0, NULL, "A prealigner, too", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, cell.aligner)},
    {"collision", 0, NULL, "Look for collisions while stepping", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, cell.collision)},
    {0}};

static const wh_option_table_t tables[] = {{options, 0, NULL, NULL}, {0}};

static bool is_size(uint64_t wafer) {
    const uint64_t *size = wh_new_cell_sizes;
    while (*size != 0 && *size != wafer) {
        ++size;
    }
    return *size != 0;
}

/* The first option that is given and does not go with the others, or null. */
static const char *find_needless(const wh_new_cell_t *cell) {
    if (cell->tool) {
        return cell->wafer != NONE ? "--wafer" : cell->collision ? "--collision" : NULL;
    }
    return cell->modules != NONE ? "--modules" : cell->locks != NONE ? "--locks" : NULL;
}

static void check_new_arguments(const void *given, struct argp_state *state) {
    const wh_new_cell_t *cell = &((const arguments_t *)given)->cell;
    const char *needless = find_needless(cell);
    if (needless) {
        argp_error(state, "%s (expected %s --tool)", needless, cell->tool ? "without" : "with");
    }
    if (cell->wafer != NONE && !is_size(cell->wafer)) {
        argp_error(state, "--wafer: %" PRIu64 " (expected 100, 125, 150, 200 or 300)", cell->wafer);
    }
}

static const wh_command_line_t command_line = {
    .name = "new",
    .synopsis = "NAME",
    .about =
        "Makes the folder NAME with a cell or a tool to start from: a layout, a script that runs in it, and "
        "what editors that use the Lua language server need. At a terminal, without options, it asks what "
        "the "
        "cell shall have. Existing files are never overwritten.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "name",
    .operand_variable = offsetof(arguments_t, folder),
    .check = check_new_arguments};

/* ----------------------------------------------------------------------------------------------- asking */

/* A line without its end; false at the end of input. */
static bool ask(const char *question, char answer[80]) {
    printf("%s ", question);
    (void)fflush(stdout);
    if (!fgets(answer, 80, stdin)) {
        putchar('\n');
        return false;
    }
    answer[strcspn(answer, "\n")] = '\0';
    return true;
}

/* Asks until the answer is a number that fits, or nothing, which is `usual`. */
static bool ask_number(const char *question, uint64_t usual, bool (*fits)(uint64_t), uint64_t *number) {
    char answer[80];
    char *end = answer;
    do {
        if (!ask(question, answer)) {
            return false;
        }
        errno = 0;
        *number = answer[0] == '\0' ? usual : strtoul(answer, &end, 10);
    } while (answer[0] != '\0' && (*end != '\0' || answer[0] == '-' || errno != 0 || !fits(*number)));
    return true;
}

static bool ask_whether(const char *question, bool *is_wanted) {
    char answer[80];
    do {
        if (!ask(question, answer)) {
            return false;
        }
    } while (answer[0] != '\0' && strcmp(answer, "y") != 0 && strcmp(answer, "n") != 0);
    *is_wanted = answer[0] == 'y';
    return true;
}

static bool is_count_of_foups(uint64_t number) {
    return number >= 1 && number <= WH_NEW_FOUPS;
}

static bool is_count_of_blades(uint64_t number) {
    return number >= 1 && number <= WH_NEW_BLADES;
}

static bool ask_all(wh_new_cell_t *cell) {
    return ask_number("Wafers: 100, 125, 150, 200 or 300 mm? [300]", 300, is_size, &cell->wafer) &&
           ask_number("How many FOUPs or cassettes, 1 to 4? [2]", 2, is_count_of_foups, &cell->foups) &&
           ask_number("How many blades on the robot, 1 or 2? [1]", 1, is_count_of_blades, &cell->blades) &&
           ask_whether("A prealigner, y or n? [n]", &cell->aligner) &&
           ask_whether("Look for collisions, y or n? [n]", &cell->collision);
}

static bool is_given(const wh_new_cell_t *cell) {
    return cell->wafer != NONE || cell->foups != NONE || cell->blades != NONE || cell->aligner ||
           cell->collision || cell->tool;
}

static void set_usual(uint64_t *number, uint64_t usual) {
    *number = *number == NONE ? usual : *number;
}

static bool complete(wh_new_cell_t *cell) {
    if (!is_given(cell) && isatty(STDIN_FILENO) && isatty(STDOUT_FILENO)) {
        return ask_all(cell);
    }
    set_usual(&cell->wafer, 300);
    set_usual(&cell->foups, 2);
    set_usual(&cell->blades, 1);
    set_usual(&cell->modules, 4);
    set_usual(&cell->locks, 2);
    return true;
}

int wh_app_new(int argc, char **argv) {
    arguments_t arguments = {
        .cell = {.wafer = NONE, .foups = NONE, .blades = NONE, .modules = NONE, .locks = NONE}};
    wh_options_parse(&command_line, argc, argv, &arguments);
    if (!wh_new_cell_is_free(arguments.folder) || !complete(&arguments.cell) ||
        !wh_new_cell_make(&arguments.cell, arguments.folder)) {
        return WH_EXIT_USAGE;
    }
    char script[PATH_MAX];
    (void)snprintf(script, sizeof script, "%s/script.lua", arguments.folder);
    fputs("waferhand run ", stdout);
    wh_output_word(stdout, script);
    putchar('\n');
    return wh_app_is_printed(0) ? WH_EXIT_MET : WH_EXIT_USAGE;
}
