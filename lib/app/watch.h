/* A command that is carried out again each time one of the files that it reads is saved: `--watch`.
 *
 * Each time it runs in a process of its own, which reports the files that it reads: a script, its modules,
 * its layout and the layout's modules, meshes. It also reports missing files, because an editor may be
 * replacing them. If a file is saved during a run, the run is given up.
 */
#ifndef WH_APP_WATCH_H
#define WH_APP_WATCH_H

#include <stddef.h>

typedef struct {
    int (*act)(void *user); /* carries it out; the exit status */
    void *user;
    const char *const *outputs; /* paths that it may write; null for one that is not wanted */
    size_t output_count;
} wh_watch_options_t;

/* The text about --watch in an option's table. */
#define WH_WATCH_HELP                                                                                        \
    "Do it again each time one of the files that are read is saved, until Ctrl-C; what is wrong is told, "   \
    "and it goes on"

/* Watches until SIGINT or SIGTERM ends it: then WH_EXIT_MET. WH_EXIT_USAGE, and a line on standard error, if
 * the system cannot watch files or start a process. From then on SIGINT and SIGTERM are ignored. */
int wh_watch(const wh_watch_options_t *options);

#endif
