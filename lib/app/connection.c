#include "connection.h"

#include <inttypes.h>
#include <stdio.h>

volatile sig_atomic_t wh_stop_requested = 0;

static void request_stop(int signal_number) {
    (void)signal_number;
    wh_stop_requested = 1;
}

void wh_catch_signals(void) {
    const struct sigaction action = {.sa_handler = request_stop};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* --------------------------------------------------------------------------------------- motion control's */

bool wh_mcs_link_open(wh_mcs_link_t *link, const wh_mcs_link_options_t *options) {
    wh_catch_signals();
    wh_record_arguments_apply(&options->record, "mcs", false, &link->record);
    if (!wh_node_open(&link->node, options->url, &link->record)) {
        return false;
    }
    link->node.speaker = "mcs";
    if (!wh_mcs_process_open(&link->control, &link->node, &options->client)) {
        fprintf(stderr, "mcs: LCM takes no subscription\n");
        wh_node_close(&link->node);
        (void)wh_recording_close(&link->record);
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

bool wh_mcs_link_close(wh_mcs_link_t *link) {
    wh_mcs_process_finish(&link->control);
    if (link->control.connected) {
        print_counters(&link->control);
    }
    wh_node_close(&link->node);
    return wh_recording_close(&link->record) && link->control.client.counters.unwritten == 0;
}
