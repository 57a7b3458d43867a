#include "options.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "array.h"

#define MOST_OPTIONS 48

/* Keys of options without a letter begin here. */
#define FIRST_KEY 1000

typedef struct {
    const wh_command_line_t *line;
    char *arguments;
    struct argp_option known[MOST_OPTIONS]; /* as argp has them, headings among them */
    const wh_option_t *options[MOST_OPTIONS];
    void *variables[MOST_OPTIONS];
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

/* All 64 bits, which a double has not: only digits. */
static bool read_count(const wh_option_t *option, const char *text, uint64_t *value) {
    char *end = NULL;
    errno = 0;
    *value = strtoull(text, &end, 10);
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0 && (double)*value >= option->least;
}

static void refuse(const wh_option_t *option, const char *text, const char *expected,
                   const struct argp_state *state) {
    argp_error(state, "--%s: %s (expected %s)", option->name, text, expected);
}

static void take_number(const wh_option_t *option, void *variable, const char *text,
                        const struct argp_state *state) {
    double real = 0;
    uint64_t whole = 0;
    const bool taken =
        option->kind == WH_OPTION_COUNT ? read_count(option, text, &whole) : read_real(option, text, &real);
    if (!taken) {
        refuse(option, text, option->expected, state);
    }
    if (option->kind == WH_OPTION_REAL) {
        *(double *)variable = real;
        return;
    }
    if (option->kind == WH_OPTION_WHOLE) {
        whole = (uint64_t)real;
        if ((double)whole < real) {
            refuse(option, text, "a whole number", state);
        }
    }
    *(uint64_t *)variable = whole;
}

static void take(const wh_option_t *option, void *variable, char *text, const struct argp_state *state) {
    wh_option_list_t *list = variable;
    switch (option->kind) {
    case WH_OPTION_FLAG:
        *(bool *)variable = true;
        break;
    case WH_OPTION_TEXT:
        *(const char **)variable = text;
        break;
    case WH_OPTION_LIST:
        list->items = wh_array_grow(list->items, list->count, &list->capacity, sizeof *list->items);
        list->items[list->count++] = text;
        break;
    case WH_OPTION_REAL:
    case WH_OPTION_WHOLE:
    case WH_OPTION_COUNT:
        take_number(option, variable, text, state);
        break;
    }
}

static void take_operand(const parser_t *parser, char *text, const struct argp_state *state) {
    const char **operand = (const char **)(void *)(parser->arguments + parser->line->operand_variable);
    if (*operand) {
        argp_error(state, "%s: one %s is enough", text, parser->line->operand);
    }
    *operand = text;
}

static void check(const parser_t *parser, struct argp_state *state) {
    const char *operand = *(const char **)(void *)(parser->arguments + parser->line->operand_variable);
    if (parser->line->check) {
        parser->line->check(parser->arguments, state);
    } else if (!operand) {
        argp_error(state, "which %s?", parser->line->operand);
    }
}

static error_t parse(int key, char *text, struct argp_state *state) {
    const parser_t *parser = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        take_operand(parser, text, state);
        return 0;
    case ARGP_KEY_END:
        check(parser, state);
        return 0;
    default:
        break;
    }
    for (size_t i = 0; i < parser->count; ++i) {
        if (parser->options[i] && parser->known[i].key == key) {
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
                             option->argument, 0,
                             option->help,     0};
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
    (void)argp_parse(&argp, argc, argv, 0, NULL, &parser);
}
