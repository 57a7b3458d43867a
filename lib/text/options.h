/* Options of a command line, each bound to a variable by one line of a table, over argp.
 *
 *     static const wh_option_t options[] = {
 *         {"json", 0, NULL, "Print JSON", WH_OPTION_FLAG, .variable = offsetof(arguments_t, json)},
 *         {"rate", 0, "FACTOR", "Run free at this factor of real time", WH_OPTION_REAL,
 *          .variable = offsetof(arguments_t, rate), 1e-3, 1e3},
 *         {0}};
 *
 * Variables are given by their offsets within a structure, so that tables are constant and commands can
 * share them. An option that is not given leaves its variable unchanged; one that is given twice is
 * refused, except flags and lists. Wrong usage ends the program, like in argp: "--rate: x (expected a
 * number from 0.001 to 1000)", "--rat: no such option (did you mean --rate?)".
 */
#ifndef WH_TEXT_OPTIONS_H
#define WH_TEXT_OPTIONS_H

#include <argp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
    WH_OPTION_FLAG, /* bool: becomes true */
    WH_OPTION_TEXT, /* const char * */
    /* const char *: what stands behind '=', or the next argument if that is an address in numbers, such as
     * 127.0.0.1:8000 or 8000; otherwise an empty text. Its `argument` is the text without the brackets that
     * --help shows. */
    WH_OPTION_ADDRESS,
    WH_OPTION_LIST,  /* wh_option_list_t: all, in order */
    WH_OPTION_REAL,  /* double, from `least` to `most` */
    WH_OPTION_WHOLE, /* uint64_t, from `least` to `most`, which a double must hold: 1000000 or 1e6 */
    WH_OPTION_COUNT  /* uint64_t of up to 64 bits in decimal digits, from `least` */
} wh_option_kind_t;

typedef struct {
    const char *name;     /* without its dashes; null ends a table */
    char letter;          /* its short name, or 0 */
    const char *argument; /* its name in --help; null for a flag */
    const char *help;
    wh_option_kind_t kind;
    size_t variable;      /* offset */
    double least, most;   /* of a number */
    const char *expected; /* the expected values in a message about another number; null: least and most */
} wh_option_t;

/* Texts given by a list's option; they live as long as argv. Free it by wh_option_list_free. */
typedef struct {
    const char **items;
    size_t count, capacity;
} wh_option_list_t;

void wh_option_list_free(wh_option_list_t *list);

/* One table of a command. */
typedef struct {
    const wh_option_t *options; /* null ends a list of tables */
    size_t base;                /* offset of the structure that it fills in, within the command's */
    const char *heading;        /* above these options in --help, or null */
    /* Checks the values of these options and refuses wrong combinations by argp_error, or null. */
    void (*check)(const void *filled, struct argp_state *state);
} wh_option_table_t;

typedef struct {
    const char *name;     /* the subcommand's, as in "waferhand run" */
    const char *synopsis; /* its operands, as in --help */
    const char *about;    /* its description; after \v, the text after the options */
    const wh_option_table_t *tables;
    const char *operand; /* the kind of the only argument, such as "script"; or of each of them */
    size_t operand_variable;
    bool operand_may_lack; /* `check` decides; otherwise it is required */
    size_t operands;       /* 0: there is one, a text; otherwise up to this number, a wh_option_list_t */
    /* Checks the combination of all values before the tables do, and refuses by argp_error; or null. */
    void (*check)(const void *arguments, struct argp_state *state);
} wh_command_line_t;

/* Fills in the arguments. */
void wh_options_parse(const wh_command_line_t *line, int argc, char **argv, void *arguments);

#endif
