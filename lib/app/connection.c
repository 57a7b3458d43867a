#include "connection.h"

#include <errno.h>
#include <inttypes.h>
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
        fprintf(stderr, "%s: %s\n", node->url, node->problem);
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

/* --------------------------------------------------------------------------------------- motion control's */

bool wh_mcs_link_open(wh_mcs_link_t *link, const wh_mcs_link_options_t *options) {
    static char name[] = "mcs";
    const wh_mcs_process_options_t control = {.rate = options->rate,
                                              .outputs = options->outputs,
                                              .stop = &wh_stop_requested,
                                              .say = wh_say_line,
                                              .user = name};
    wh_catch_signals();
    if (!wh_open_node(&link->node, options->url, options->record)) {
        return false;
    }
    if (!wh_mcs_process_open(&link->control, &link->node, &control)) {
        fprintf(stderr, "mcs: LCM takes no subscription\n");
        wh_node_close(&link->node);
        return false;
    }
    return true;
}

static void print_counters(const wh_mcs_process_t *control) {
    const wh_protocol_client_counters_t *c = &control->client.counters;
    /* Repeated commands alone are normal: nothing is printed. */
    if (control->options.rate <= 0 && c->malformed + c->restored + c->silences == 0) {
        return;
    }
    fprintf(stderr,
            "mcs: %" PRIu64 " slices sent, %" PRIu64 " commands repeated, %" PRIu64 " states taken, %" PRIu64
            " unasked, %" PRIu64 " malformed; %" PRIu64 " states sent back, %" PRIu64 " silences\n",
            c->sent, c->repeated, c->answers, c->unasked, c->malformed, c->restored, c->silences);
    if (control->options.rate > 0) {
        fprintf(stderr,
                "mcs: free-running: %" PRId64 " slices missed by the simulator, %" PRIu64 " sent late\n",
                control->client.missed, c->late);
    }
}

void wh_mcs_link_close(wh_mcs_link_t *link) {
    wh_mcs_process_finish(&link->control);
    if (link->control.connected) {
        print_counters(&link->control);
    }
    wh_node_close(&link->node);
}
