#include "options.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "array.h"
#include "nearest.h"

#define MOST_OPTIONS 48

/* Keys of options without a letter begin here. */
#define FIRST_KEY 1000

typedef struct {
    const wh_command_line_t *line;
    char *arguments;
    struct argp_option known[MOST_OPTIONS]; /* in argp's form, including headings */
    const wh_option_t *options[MOST_OPTIONS];
    void *variables[MOST_OPTIONS];
    bool given[MOST_OPTIONS];
    size_t count;
} parser_t;

void wh_option_list_free(wh_option_list_t *list) {
    free(list->items);
    *list = (wh_option_list_t){NULL, 0, 0};
}

/* A number from `least` to `most` and nothing else. */
static bool read_real(const wh_option_t *option, const char *text, double *value) {
    char *end = NULL;
    *value = strtod(text, &end);
    return end != text && *end == '\0' && *value >= option->least && *value <= option->most;
}

/* It reads all 64 bits, more than a double has, so it accepts only digits. */
static bool read_count(const wh_option_t *option, const char *text, uint64_t *value) {
    char *end = NULL;
    errno = 0;
    *value = strtoull(text, &end, 10);
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0 && (double)*value >= option->least;
}

static void refuse_value(const wh_option_t *option, const char *text, const char *expected,
                         const struct argp_state *state) {
    argp_error(state, "--%s: %s (expected %s)", option->name, text[0] != '\0' ? text : "nothing", expected);
}

static void refuse_number(const wh_option_t *option, const char *text, const struct argp_state *state) {
    char expected[100];
    const char *kind = option->kind == WH_OPTION_REAL ? "number" : "whole number";
    if (option->kind == WH_OPTION_COUNT) {
        (void)snprintf(expected, sizeof expected, "a whole number from %.0f to %" PRIu64, option->least,
                       UINT64_MAX);
    } else {
        (void)snprintf(expected, sizeof expected, "a %s from %.10g to %.10g", kind, option->least,
                       option->most);
    }
    refuse_value(option, text, option->expected ? option->expected : expected, state);
}

static void take_number(const wh_option_t *option, void *variable, const char *text,
                        const struct argp_state *state) {
    double real = 0;
    uint64_t whole = 0;
    const bool taken =
        option->kind == WH_OPTION_COUNT ? read_count(option, text, &whole) : read_real(option, text, &real);
    if (!taken) {
        refuse_number(option, text, state);
    }
    if (option->kind == WH_OPTION_REAL) {
        *(double *)variable = real;
        return;
    }
    if (option->kind == WH_OPTION_WHOLE) {
        whole = (uint64_t)real;
        if ((double)whole < real) {
            refuse_number(option, text, state);
        }
    }
    *(uint64_t *)variable = whole;
}

static void add_item(wh_option_list_t *list, const char *text) {
    list->items = wh_array_grow(list->items, list->count, &list->capacity, sizeof *list->items);
    list->items[list->count++] = text;
}

/* True for a text such as 127.0.0.1:8000, [::1]:8000 or 8000. */
static bool is_address(const char *text) {
    return text && text[0] != '\0' && text[strspn(text, "0123456789abcdefABCDEF.:[]")] == '\0' &&
           strpbrk(text, "0123456789") && (strchr(text, ':') || !strpbrk(text, "abcdefABCDEF.[]"));
}

/* The value of an option that may lack it. argp hands out only what stands behind '='. */
static const char *take_address(const char *text, struct argp_state *state) {
    if (text || state->next >= state->argc || !is_address(state->argv[state->next])) {
        return text ? text : "";
    }
    return state->argv[state->next++];
}

static void take(const wh_option_t *option, void *variable, char *text, struct argp_state *state) {
    switch (option->kind) {
    case WH_OPTION_ADDRESS:
        *(const char **)variable = take_address(text, state);
        break;
    case WH_OPTION_FLAG:
        *(bool *)variable = true;
        break;
    case WH_OPTION_TEXT:
        if (text[0] == '\0') {
            refuse_value(option, text, option->argument, state);
        }
        *(const char **)variable = text;
        break;
    case WH_OPTION_LIST:
        add_item(variable, text);
        break;
    case WH_OPTION_REAL:
    case WH_OPTION_WHOLE:
    case WH_OPTION_COUNT:
        take_number(option, variable, text, state);
        break;
    }
}

static void *operand_of(const parser_t *parser) {
    return parser->arguments + parser->line->operand_variable;
}

static void take_operand(const parser_t *parser, char *text, const struct argp_state *state) {
    const wh_command_line_t *line = parser->line;
    const char **operand = operand_of(parser);
    wh_option_list_t *list = operand_of(parser);
    if (text[0] == '\0') {
        argp_error(state, "%s: nothing (expected a file)", line->operand);
    } else if (line->operands == 0 && *operand) {
        argp_error(state, "%s: one %s is enough", text, line->operand);
    } else if (line->operands > 0 && list->count == line->operands) {
        argp_error(state, "%s: %zu %ss are enough", text, line->operands, line->operand);
    }
    if (line->operands > 0) {
        add_item(list, text);
    } else {
        *operand = text;
    }
}

static bool has_operand(const parser_t *parser) {
    const wh_option_list_t *list = operand_of(parser);
    return parser->line->operands > 0 ? list->count > 0 : *(const char **)operand_of(parser) != NULL;
}

static void check_option_tables(const parser_t *parser, struct argp_state *state) {
    if (!has_operand(parser) && !parser->line->operand_may_lack) {
        argp_error(state, "which %s?", parser->line->operand);
    }
    if (parser->line->check) {
        parser->line->check(parser->arguments, state);
    }
    for (const wh_option_table_t *table = parser->line->tables; table->options; ++table) {
        if (table->check) {
            table->check(parser->arguments + table->base, state);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- names */

/* The options that argp adds. */
static const char *const own_names[] = {"help", "usage", "version"};

#define OWN_NAMES (sizeof own_names / sizeof own_names[0])

static void refuse_name(const parser_t *parser, const char *text, struct argp_state *state) {
    const char *names[MOST_OPTIONS + OWN_NAMES];
    char word[WH_NEAREST_BYTES + 2];
    char meant[WH_NEAREST_TEXT];
    size_t count = 0;
    for (size_t i = 0; i < parser->count; ++i) {
        if (parser->known[i].name) {
            names[count++] = parser->known[i].name;
        }
    }
    memcpy(names + count, own_names, sizeof own_names);
    (void)snprintf(word, sizeof word, "%.*s", (int)strcspn(text + 2, "="), text + 2);
    const char *near = wh_text_nearest(word, names, count + OWN_NAMES);
    state->name = state->argv[0]; /* which argp sets later */
    argp_error(state, "%s: no such option%s%s", text, wh_text_did_you_mean(meant, " (", "--", near),
               near ? ")" : "");
}

/* The option with this name, or otherwise with a name that begins so; null if there is none. */
static const struct argp_option *find_name(const parser_t *parser, const char *name, size_t length) {
    const struct argp_option *found = NULL;
    for (size_t i = 0; i < parser->count; ++i) {
        const struct argp_option *option = &parser->known[i];
        if (option->name && strncmp(option->name, name, length) == 0) {
            found = found && option->name[length] != '\0' ? found : option;
        }
    }
    return found;
}

static bool is_own_name(const char *name, size_t length) {
    bool is_own = false;
    for (size_t i = 0; i < OWN_NAMES; ++i) {
        is_own = is_own || strncmp(own_names[i], name, length) == 0;
    }
    return is_own;
}

/* True if "-o" is an option whose value is the next argument. */
static bool takes_next(const parser_t *parser, const char *text) {
    for (size_t i = 0; i < parser->count; ++i) {
        if (parser->options[i] && parser->known[i].arg && parser->known[i].key == text[1]) {
            return text[2] == '\0';
        }
    }
    return false;
}

/* True if the value of the option "--name" is the next argument. It does not return if there is no such
 * name. */
static bool check_name(const parser_t *parser, const char *text, struct argp_state *state) {
    const size_t length = strcspn(text + 2, "=");
    const struct argp_option *option = find_name(parser, text + 2, length);
    if (!option && !is_own_name(text + 2, length)) {
        refuse_name(parser, text, state);
    }
    return option && option->arg && option->flags == 0 && text[2 + length] == '\0';
}

/* Refuses an unknown name before argp does, because argp suggests no other. */
static void check_names(const parser_t *parser, struct argp_state *state) {
    for (int i = 1; i < state->argc && strcmp(state->argv[i], "--") != 0; ++i) {
        const char *text = state->argv[i];
        if (strncmp(text, "--", 2) == 0) {
            i += check_name(parser, text, state) ? 1 : 0;
        } else if (text[0] == '-') {
            i += takes_next(parser, text) ? 1 : 0;
        }
    }
}

/* ----------------------------------------------------------------------------------------------- parsing */

/* Refuses the second value of an option that has one: otherwise the first would be lost without a
 * message. */
static void note_given(parser_t *parser, size_t i, const struct argp_state *state) {
    const wh_option_kind_t kind = parser->options[i]->kind;
    if (parser->given[i] && kind != WH_OPTION_FLAG && kind != WH_OPTION_LIST) {
        argp_error(state, "--%s: given twice", parser->options[i]->name);
    }
    parser->given[i] = true;
}

static error_t parse(int key, char *text, struct argp_state *state) {
    parser_t *parser = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        check_names(parser, state);
        return 0;
    case ARGP_KEY_ARG:
        take_operand(parser, text, state);
        return 0;
    case ARGP_KEY_END:
        check_option_tables(parser, state);
        return 0;
    default:
        break;
    }
    for (size_t i = 0; i < parser->count; ++i) {
        if (parser->options[i] && parser->known[i].key == key) {
            note_given(parser, i, state);
            take(parser->options[i], parser->variables[i], text, state);
            return 0;
        }
    }
    return ARGP_ERR_UNKNOWN;
}

static void add(parser_t *parser, const wh_option_t *option, char *base) {
    const size_t i = parser->count++;
    if (parser->count == MOST_OPTIONS) {
        abort();
    }
    parser->options[i] = option;
    parser->variables[i] = base + option->variable;
    parser->known[i] =
        (struct argp_option){option->name,     option->letter != '\0' ? option->letter : FIRST_KEY + (int)i,
                             option->argument, option->kind == WH_OPTION_ADDRESS ? OPTION_ARG_OPTIONAL : 0,
                             option->help,     0};
}

/* True while argp parses: argp ends the program after --help, and output may not have been written. */
static bool is_parsing;

static void check_help(void) {
    if (is_parsing && (fflush(stdout) != 0 || ferror(stdout))) {
        fprintf(stderr, "standard output: %s\n", strerror(errno));
        _exit(argp_err_exit_status);
    }
}

void wh_options_parse(const wh_command_line_t *line, int argc, char **argv, void *arguments) {
    static char name[64];
    parser_t parser = {.line = line, .arguments = arguments};
    for (const wh_option_table_t *table = line->tables; table->options; ++table) {
        if (table->heading) {
            parser.known[parser.count++].doc = table->heading;
        }
        for (const wh_option_t *option = table->options; option->name; ++option) {
            add(&parser, option, parser.arguments + table->base);
        }
    }
    const struct argp argp = {parser.known, parse, line->synopsis, line->about, NULL, NULL, NULL};
    (void)snprintf(name, sizeof name, "waferhand %s", line->name);
    argv[0] = name;
    is_parsing = atexit(check_help) == 0;
    (void)argp_parse(&argp, argc, argv, 0, NULL, &parser);
    is_parsing = false;
}
