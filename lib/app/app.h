/* The program's subcommands. Each takes the arguments from its own name on and returns the exit status. Their
 * table is in lua/README.md, and from there in the manual page. */
#ifndef WH_APP_APP_H
#define WH_APP_APP_H

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WH_EXIT_MET = 0, WH_EXIT_FAILED = 1, WH_EXIT_USAGE = 2, WH_EXIT_NO_ANSWER = 5 };

/* The words of each --help about the exit status. */
#define WH_HELP_EXIT "Exit status: see the manual page, waferhand(1), EXIT STATUS."

/* True if all output has been printed; else reports it on standard error. `status` is 0 if the output could
 * be made. */
static inline bool wh_app_is_printed(int status) {
    const bool printed = status == 0 && fflush(stdout) == 0 && !ferror(stdout);
    if (!printed) {
        fprintf(stderr, "standard output: %s\n", strerror(errno));
    }
    return printed;
}

int wh_app_run(int argc, char **argv);
int wh_app_mcs(int argc, char **argv);
int wh_app_replay(int argc, char **argv);
int wh_app_sim(int argc, char **argv);
int wh_app_report(int argc, char **argv);
int wh_app_layout(int argc, char **argv);
int wh_app_study(int argc, char **argv);
int wh_app_budget(int argc, char **argv);
int wh_app_sweep(int argc, char **argv);
int wh_app_test(int argc, char **argv);
int wh_app_diff(int argc, char **argv);
int wh_app_events(int argc, char **argv);
int wh_app_csv(int argc, char **argv);
int wh_app_check(int argc, char **argv);
int wh_app_estimate(int argc, char **argv);
int wh_app_definitions(int argc, char **argv);
int wh_app_new(int argc, char **argv);
int wh_app_serve(int argc, char **argv);
int wh_app_dialect(int argc, char **argv);
int wh_app_converse(int argc, char **argv);
int wh_app_schedule(int argc, char **argv);

#endif
