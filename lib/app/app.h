/* The program's subcommands. Each takes the arguments from its own name on and returns the exit status:
 * 0 all expectations met, 1 not so, 2 wrong usage or a bad input file. */
#ifndef WH_APP_APP_H
#define WH_APP_APP_H

enum { WH_EXIT_MET = 0, WH_EXIT_FAILED = 1, WH_EXIT_USAGE = 2 };

int wh_app_run(int argc, char **argv);
int wh_app_mcs(int argc, char **argv);
int wh_app_replay(int argc, char **argv);
int wh_app_sim(int argc, char **argv);
int wh_app_report(int argc, char **argv);
int wh_app_layout(int argc, char **argv);
int wh_app_study(int argc, char **argv);

#endif
