#include "link_options.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

volatile sig_atomic_t wh_stop_requested = 0;

static void request_stop(int signal_number) {
    (void)signal_number;
    wh_stop_requested = 1;
}

void wh_catch_signals(void) {
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = request_stop;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

bool wh_open_node(wh_node_t *node, const char *url, const char *record_path) {
    if (!wh_node_open(node, url)) {
        fprintf(stderr,
                "%s: LCM is not to be had at this URL (expected a multicast route, as by `ip route add "
                "224.0.0.0/4 "
                "dev lo`, or another URL)\n",
                url ? url : WH_NODE_URL);
        return false;
    }
    if (record_path && !wh_node_record(node, record_path)) {
        fprintf(stderr, "%s: %s (expected a file that can be written)\n", record_path, strerror(errno));
        wh_node_close(node);
        return false;
    }
    return true;
}

void wh_say_line(void *user, const char *text) {
    fprintf(stderr, "%s: %s\n", (const char *)user, text);
}
