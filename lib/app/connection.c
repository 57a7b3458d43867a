#include "connection.h"

#include <inttypes.h>

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

/* --------------------------------------------------------------------------------------------- recordings */

const wh_option_t wh_record_options[] = {
    {"record", 0, "FILE",
     "Record slices into an LCM event log: what `replay` and `report` need; compressed if the name ends in "
     ".zst",
     WH_OPTION_TEXT, .variable = offsetof(wh_record_arguments_t, slices)},
    {"record-all", 0, "FILE", "Record every message instead, as lcm-spy wants it", WH_OPTION_TEXT,
     .variable = offsetof(wh_record_arguments_t, all)},
    {"record-size", 0, "MB", "Go on in a new file (run.part2.log) when one is so large", WH_OPTION_REAL,
     .variable = offsetof(wh_record_arguments_t, part_mb), 0.01, 1e6},
    {0}};

void wh_record_arguments_check(const void *given, struct argp_state *state) {
    const wh_record_arguments_t *arguments = given;
    if (arguments->slices && arguments->all) {
        argp_error(state, "--record-all: %s (--record is given, too: one recording at a time)",
                   arguments->all);
    }
    if (arguments->part_mb > 0 && !arguments->slices && !arguments->all) {
        argp_error(state, "--record-size goes with --record or --record-all");
    }
}

const char *wh_record_arguments_path(const wh_record_arguments_t *arguments, const char **option) {
    *option = arguments->all ? "--record-all" : "--record";
    return arguments->all ? arguments->all : arguments->slices;
}

void wh_record_arguments_apply(const wh_record_arguments_t *arguments, const char *program, bool replaces,
                               wh_recording_t *recording) {
    const char *option = NULL;
    recording->options = (wh_recording_options_t){.path = wh_record_arguments_path(arguments, &option),
                                                  .program = program,
                                                  .all = arguments->all != NULL,
                                                  .replaces = replaces,
                                                  .part_mb = arguments->part_mb};
}

/* --------------------------------------------------------------------------------------- motion control's */

bool wh_mcs_link_open(wh_mcs_link_t *link, const wh_mcs_link_options_t *options) {
    const char *program = options->program ? options->program : "mcs";
    wh_catch_signals();
    wh_record_arguments_apply(&options->record, program, false, &link->record);
    if (!wh_node_reaches_others(options->url) ||
        !wh_recording_open_node(&link->record, &link->node, options->url)) {
        return false;
    }
    link->node.speaker = program;
    link->node.log_time = options->log_time;
    if (!wh_mcs_process_open(&link->control, &link->node, &options->client)) {
        wh_node_warn(&link->node, "LCM takes no subscription");
        wh_node_close(&link->node);
        (void)wh_recording_close(&link->record);
        return false;
    }
    return true;
}

static void print_counters(wh_mcs_link_t *link) {
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
        const int64_t missed = link->control.client.link.missed(&link->control.client.link);
        wh_node_say(&link->node,
                    "free-running: %" PRId64 " slice%s missed by the simulator, %" PRIu64 " sent late",
                    missed, WH_PLURAL(missed), c->late);
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
