#include <argp.h>
#include <locale.h>
#include <stdio.h>
#include <string.h>

#include "../math/config.h"
#include "../text/guard.h"
#include "../text/nearest.h"
#include "app.h"

static const struct {
    const char *name, *purpose;
    int (*act)(int argc, char **argv);
} subcommands[] = {
    {"run", "play a motion script against the simulator", wh_app_run},
    {"mcs", "motion control over LCM, for a script or at a prompt", wh_app_mcs},
    {"sim", "simulate a cell for whoever sends commands over LCM", wh_app_sim},
    {"serve", "let a tool's host software talk to a cell, in its own dialect", wh_app_serve},
    {"converse", "play a host's side again, and compare what it hears", wh_app_converse},
    {"dialect", "check a dialect, and tell what it does not speak", wh_app_dialect},
    {"replay", "step a recording again and compare it", wh_app_replay},
    {"report", "make a page of a run: the cell in motion, plots, tables", wh_app_report},
    {"layout", "list, check and draw a cell", wh_app_layout},
    {"study", "play a script many times, each time a little off", wh_app_study},
    {"budget", "tell how far stations may be off, and which one allows least", wh_app_budget},
    {"sweep", "run a script for each value of a parameter", wh_app_sweep},
    {"test", "play many scripts and tell which ended well", wh_app_test},
    {"diff", "compare two recordings, or two results", wh_app_diff},
    {"events", "print a recording's events, a line of JSON each", wh_app_events},
    {"csv", "print a recording's slices as a table", wh_app_csv},
    {"check", "hold a recording against what a Lua file expects of it", wh_app_check},
    {"estimate", "fit frames, limits and robots to measurements", wh_app_estimate},
    {"schedule", "hold a schedule of others against what no tool can break", wh_app_schedule},
    {"new", "make a cell to start from: a layout and a script", wh_app_new},
    {"definitions", "print what layouts and scripts may say, for editors", wh_app_definitions},
};

#define SUBCOMMANDS (sizeof subcommands / sizeof subcommands[0])

static void print_help(FILE *out) {
    fputs("Usage: waferhand COMMAND [OPTION...] [ARGUMENT...]\n"
          "Run, test and judge wafer handling robots before any robot moves.\n\nCommands:\n",
          out);
    for (size_t i = 0; i < SUBCOMMANDS; ++i) {
        fprintf(out, "  %-11s %s\n", subcommands[i].name, subcommands[i].purpose);
    }
    fputs(
        "\n  waferhand COMMAND --help    tells the options of a command, and so does waferhand help COMMAND\n"
        "  waferhand --version         prints the version\n\n" WH_HELP_EXIT "\n",
        out);
}

/* `waferhand help` is `--help`, and `waferhand help COMMAND` is `COMMAND --help`. */
static void take_help(int *argc, char *argv[]) {
    static char option[] = "--help";
    if (*argc >= 2 && strcmp(argv[1], "help") == 0) {
        argv[1] = *argc >= 3 ? argv[2] : option;
        argv[2] = *argc >= 3 ? option : argv[2];
        *argc = *argc >= 3 ? 3 : 2;
    }
}

static void refuse_subcommand(const char *word) {
    const char *names[SUBCOMMANDS + 2] = {[SUBCOMMANDS] = "--help", [SUBCOMMANDS + 1] = "--version"};
    for (size_t i = 0; i < SUBCOMMANDS; ++i) {
        names[i] = subcommands[i].name;
    }
    char meant[WH_NEAREST_TEXT];
    fprintf(stderr, "waferhand: %s: no such command (see waferhand --help%s)\n", word,
            wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(word, names, SUBCOMMANDS + 2)));
}

int main(int argc, char **argv) {
    /* The locale says which bytes are characters. Numbers and sorting stay those of the "C" locale. */
    setlocale(LC_CTYPE, "");
    wh_guard_stderr();
    argp_err_exit_status = WH_EXIT_USAGE;
    argp_program_version = "waferhand " WH_VERSION;
    take_help(&argc, argv);
    if (argc < 2) {
        print_help(stderr);
        return WH_EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-?") == 0) {
        print_help(stdout);
        return wh_app_is_printed(0) ? WH_EXIT_MET : WH_EXIT_USAGE;
    }
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
        puts(argp_program_version);
        return wh_app_is_printed(0) ? WH_EXIT_MET : WH_EXIT_USAGE;
    }
    for (size_t i = 0; i < SUBCOMMANDS; ++i) {
        if (strcmp(argv[1], subcommands[i].name) == 0) {
            return subcommands[i].act(argc - 1, argv + 1);
        }
    }
    refuse_subcommand(argv[1]);
    return WH_EXIT_USAGE;
}
