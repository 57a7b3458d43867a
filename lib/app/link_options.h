/* What `sim` and `mcs` have in common: LCM's URL, the record, signals, lines for people. */
#ifndef WH_APP_LINK_OPTIONS_H
#define WH_APP_LINK_OPTIONS_H

#include <signal.h>

#include "../link/node.h"

/* Set by SIGINT and SIGTERM once wh_catch_signals was called. */
extern volatile sig_atomic_t wh_stop_requested;

/* From now on SIGINT and SIGTERM ask for an end instead of making one, and interrupt waits. */
void wh_catch_signals(void);

/* Opens the node, and the record when a path is given. On failure says so on standard error. */
bool wh_open_node(wh_node_t *node, const char *url, const char *record_path);

/* Prints "NAME: text" on standard error; `user` is the name. */
void wh_say_line(void *user, const char *text);

#endif
