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
    if (!wh_node_reaches_others(options->url) || !wh_node_open(&link->node, options->url, &link->record)) {
        return false;
    }
    link->node.speaker = "mcs";
    link->node.log_time = options->log_time;
    if (!wh_mcs_process_open(&link->control, &link->node, &options->client)) {
        wh_node_warn(&link->node, "LCM takes no subscription");
        wh_node_close(&link->node);
        (void)wh_recording_close(&link->record);
        return false;
    }
    return true;
}

static void print_counters(const wh_mcs_link_t *link) {
    const wh_mcs_process_t *control = &link->control;
    const wh_protocol_client_counters_t *c = &control->client.counters;
    /* Repeated commands alone are normal: nothing is printed. */
    if (control->options.rate <= 0 && c->malformed + c->restored + c->silences == 0) {
        return;
    }
    wh_node_say(
        &link->node,
        "%" PRIu64 " slice%s sent, %" PRIu64 " command%s repeated, %" PRIu64 " state%s taken, %" PRIu64
        " unasked, %" PRIu64 " malformed; %" PRIu64 " state%s sent back, %" PRIu64 " silence%s",
        c->sent, WH_PLURAL(c->sent), c->repeated, WH_PLURAL(c->repeated), c->answers, WH_PLURAL(c->answers),
        c->unasked, c->malformed, c->restored, WH_PLURAL(c->restored), c->silences, WH_PLURAL(c->silences));
    if (control->options.rate > 0) {
        wh_node_say(&link->node,
                    "free-running: %" PRId64 " slice%s missed by the simulator, %" PRIu64 " sent late",
                    control->client.missed, WH_PLURAL(control->client.missed), c->late);
    }
}

bool wh_mcs_link_close(wh_mcs_link_t *link) {
    wh_mcs_process_finish(&link->control);
    if (link->control.connected) {
        print_counters(link);
    }
    wh_mcs_process_close(&link->control);
    wh_node_close(&link->node);
    return wh_recording_close(&link->record) && link->control.client.counters.unwritten == 0;
}
