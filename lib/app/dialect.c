/* waferhand dialect FILE */
#include <stdio.h>

#include "../host/host.h"
#include "../record/record.h"
#include "../text/options.h"
#include "app.h"
#include "dialect_say.h"

typedef struct {
    const char *path, *unit, *mechanism;
    wh_option_list_t said;
} arguments_t;

static const wh_option_t options[] = {{"say", 0, "[PORT:]FRAME",
                                       "Show what comes of this frame without a cell: its lines and what the "
                                       "host hears at once; a dialect with "
                                       "several ports needs PORT; may be given more than once",
                                       WH_OPTION_LIST, .variable = offsetof(arguments_t, said)},
                                      {"mechanism", 0, "NAME",
                                       "Try it as the controller of this robot or station", WH_OPTION_TEXT,
                                       .variable = offsetof(arguments_t, mechanism)},
                                      {"unit", 0, "ADDRESS", "Try it as the unit of this address",
                                       WH_OPTION_TEXT, .variable = offsetof(arguments_t, unit)},
                                      {0}};

static void check_dialect_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if ((arguments->mechanism || arguments->unit) && arguments->said.count == 0) {
        argp_error(state, "--mechanism and --unit go with --say");
    }
}

static const wh_option_table_t tables[] = {{options, 0, NULL, check_dialect_arguments}, {0}};

static const wh_command_line_t command_line = {
    .name = "dialect",
    .synopsis = "FILE",
    .about =
        "Checks a dialect of `waferhand serve` without a cell, and lists which of our commands, errors and "
        "status words it does not speak.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "dialect",
    .operand_variable = offsetof(arguments_t, path)};

/* True if a command of theirs does this word. */
static bool does(const wh_dialect_t *dialect, const wh_word_t *word) {
    for (size_t i = 0; i < dialect->command_count; ++i) {
        for (size_t j = 0; j < dialect->commands[i].does_count; ++j) {
            if (dialect->commands[i].does[j] == word) {
                return true;
            }
        }
    }
    return false;
}

static bool is_action_at_once(const wh_dialect_command_t *command) {
    return command->kind == WH_WORD_ACTION && command->when == WH_WHEN_AT_ONCE;
}

static bool is_answered_when_idle(const wh_dialect_command_t *command) {
    return command->when == WH_WHEN_IDLE;
}

/* Prints the commands that are answered at an unusual time. */
static void print_times(const wh_dialect_t *dialect, bool (*is_one)(const wh_dialect_command_t *command),
                        const char *time) {
    int count = 0;
    for (size_t i = 0; i < dialect->command_count; ++i) {
        if (is_one(&dialect->commands[i])) {
            printf("%s%s", count++ == 0 ? "" : ", ", dialect->commands[i].name);
        }
    }
    if (count > 0) {
        printf(": answered when %s\n", time);
    }
}

/* Prints what is unusual in the frames. */
static void print_framing(const wh_dialect_t *dialect) {
    const wh_framing_t *framing = &dialect->framing;
    const wh_framing_length_t *length = &framing->length;
    static const char *const counts[] = {"body", "body and its sum", "whole frame"};
    if (length->size > 0) {
        printf("frames tell their length: %zu %s of the %s\n", length->size,
               length->base == 256  ? "bytes"
               : length->base == 16 ? "hex digits"
                                    : "digits",
               counts[length->counts]);
    }
    if (framing->has_escape) {
        printf("a mark in a body has the byte %02X before it\n", framing->escape);
    }
    if (framing->sum_is_behind) {
        puts("the sum stands behind the end");
    }
}

static void print_order(const wh_dialect_t *dialect) {
    const wh_dialect_clients_t *clients = &dialect->clients;
    for (size_t i = 0; clients->port_count > 1 && i < clients->port_count; ++i) {
        printf("%s%s%s", i == 0 ? "ports that share it: " : ", ", clients->ports[i],
               i + 1 < clients->port_count ? "" : "\n");
    }
    if (clients->knows_units) {
        puts("a line may carry several of its units, by address");
    }
    if (clients->in_order) {
        puts("answers come in the order of the requests");
    }
    print_times(dialect, is_action_at_once, "they begin");
    print_times(dialect, is_answered_when_idle, "the controller is idle");
}

/* True if the controller could do the word: an ACKN only where one is awaited. */
static bool is_its_own(const wh_dialect_t *dialect, const wh_word_t *word) {
    return word->kind != WH_WORD_LOCAL && (word->kind != WH_WORD_ACKN || dialect->timing.ackn_s > 0) &&
           wh_mechanism_does(dialect->mechanism, word);
}

/* A name of a list that may be empty. */
static void list(int *count, const char *name) {
    printf("%s%s", *count == 0 ? " " : ", ", name);
    ++*count;
}

static void end_list(int count) {
    puts(count == 0 ? " none" : "");
}

static void print_commands(const wh_dialect_t *dialect, bool of_simulation) {
    int count = 0;
    printf("commands that %sit does not speak:", of_simulation ? "no controller has, and " : "");
    for (size_t i = 0; i < wh_word_count; ++i) {
        if (wh_words[i].is_of_simulation == of_simulation && is_its_own(dialect, &wh_words[i]) &&
            !does(dialect, &wh_words[i])) {
            list(&count, wh_words[i].name);
        }
    }
    end_list(count);
}

/* True for a status with which a command can answer: those of motion, of motion control and of its link,
 * without those that only a script or firmware meets. All from FLIP_TIMEOUT on are a mechanism's. */
static bool is_answered(wh_status_t status) {
    static const wh_status_t ranges[][2] = {{WH_STATUS_BAD_VALVE, WH_STATUS_BAD_VALVE},
                                            {WH_STATUS_RUN_OVER, WH_STATUS_RUN_OVER},
                                            {WH_STATUS_BAD_LIMITS, WH_STATUS_BAD_SCAN},
                                            {WH_STATUS_NO_ANSWER, WH_STATUS_NOT_TOUCHED},
                                            {WH_STATUS_FLIP_TIMEOUT, WH_HOST_NUMBERS - 1}};
    bool is_answered = false;
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; ++i) {
        is_answered = is_answered || (status >= ranges[i][0] && status <= ranges[i][1]);
    }
    return is_answered && status != WH_STATUS_BAD_SEGMENT && status != WH_STATUS_NO_LAYOUT &&
           strcmp(wh_status_name(status), "UNKNOWN") != 0;
}

static void print_errors(const wh_dialect_t *dialect) {
    int count = 0;
    printf("errors that it tells as %s:", dialect->other_code);
    for (int number = 1; number < WH_HOST_NUMBERS; ++number) {
        const wh_status_t status = (wh_status_t)number;
        if (is_answered(status) && !wh_dialect_speaks(dialect, status)) {
            list(&count, wh_status_name(status));
        }
    }
    end_list(count);
}

/* A host cannot tell these apart; the code raises only the first of them. */
static void print_shared(const wh_dialect_t *dialect) {
    int count = 0;
    fputs("codes of several errors:", stdout);
    for (size_t i = 0; i < dialect->code_count; ++i) {
        for (size_t other = i + 1; other < dialect->code_count; ++other) {
            if (strcmp(dialect->codes[i].code, dialect->codes[other].code) == 0) {
                char text[200];
                (void)snprintf(text, sizeof text, "%.60s (%s and %s)", dialect->codes[i].code,
                               wh_status_name(dialect->codes[i].number),
                               wh_status_name(dialect->codes[other].number));
                list(&count, text);
            }
        }
    }
    end_list(count);
}

static void print_states(const wh_dialect_t *dialect) {
    static const char *const states[] = {"idle", "running", "held"};
    int count = 0;
    fputs("status words that it does not speak:", stdout);
    for (size_t i = 0; i < sizeof states / sizeof states[0]; ++i) {
        if (!dialect->states[i]) {
            list(&count, states[i]);
        }
    }
    end_list(count);
}

int wh_app_dialect(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_dialect_t dialect;
    int status = WH_EXIT_USAGE;
    wh_options_parse(&command_line, argc, argv, &arguments);
    if (!wh_dialect_open(&dialect, arguments.path, arguments.unit)) {
        fprintf(stderr, "%s\n", dialect.message);
    } else if (arguments.said.count > 0) {
        dialect.place.stands_for = arguments.mechanism;
        status =
            wh_dialect_say(&dialect, &arguments.said) && wh_app_is_printed(0) ? WH_EXIT_MET : WH_EXIT_USAGE;
    } else {
        printf("%s, for the %s: %zu commands\n", dialect.name, wh_mechanism_names[dialect.mechanism],
               dialect.command_count);
        print_framing(&dialect);
        print_order(&dialect);
        print_commands(&dialect, false);
        print_commands(&dialect, true);
        print_errors(&dialect);
        print_shared(&dialect);
        print_states(&dialect);
        status = wh_app_is_printed(0) ? WH_EXIT_MET : WH_EXIT_USAGE;
    }
    wh_dialect_close(&dialect);
    wh_option_list_free(&arguments.said);
    return status;
}
