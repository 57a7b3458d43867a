#include "live_browser.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

extern char **environ;

/* A shell leaves the browser to itself, so that nobody has to wait for it. */
void wh_live_browse(const char *speaker, const char *place) {
    char url[200];
    (void)snprintf(url, sizeof url, "http://%s", place);
    const char *const words[] = {"sh", "-c", "command -v xdg-open >/dev/null && { xdg-open \"$1\" & }",
                                 "sh", url,  NULL};
    char *arguments[sizeof words / sizeof words[0]];
    memcpy(arguments, words, sizeof words);
    posix_spawn_file_actions_t actions;
    pid_t child = 0;
    int status = -1;
    (void)posix_spawn_file_actions_init(&actions);
    for (int fd = 0; fd < 3; ++fd) {
        (void)posix_spawn_file_actions_addopen(&actions, fd, "/dev/null", O_RDWR, 0);
    }
    if (posix_spawnp(&child, "sh", &actions, NULL, arguments, environ) == 0) {
        (void)waitpid(child, &status, 0);
    }
    (void)posix_spawn_file_actions_destroy(&actions);
    if (status != 0) {
        (void)fprintf(stderr, "%s: --open: not opened (expected xdg-open, of Debian's package xdg-utils)\n",
                      speaker);
    }
}
