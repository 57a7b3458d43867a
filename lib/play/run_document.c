#include "run_document.h"

#include "../text/array.h"
#include "../text/output.h"

static void on_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    if (state->status == WH_OK) {
        wh_signals_slice(user, command->axes, command->axis_count, state);
    }
}

static void on_boundary(void *user, const wh_layout_t *layout) {
    wh_signals_t *signals = user;
    if (!signals->layout) {
        wh_signals_begin(signals, layout, true);
    } else if (signals->last > 0) {
        wh_signals_mark(signals);
    }
}

wh_mcs_listener_t wh_run_listener(wh_signals_t *signals) {
    return (wh_mcs_listener_t){.slice = on_slice, .boundary = on_boundary, .user = signals};
}

/* Robots that are times alone have a document, too, if there was a flow. */
static bool show_flow(const wh_record_t *record, wh_document_t *document, char *message) {
    const bool is_there = record->flow && record->flow->figures.tool;
    if (!is_there) {
        (void)snprintf(message, WH_SANDBOX_MESSAGE_BYTES,
                       "%.900s: nothing to show (expected a flow: the robots are times alone)",
                       record->layout->path);
    }
    *document = (wh_document_t){.source = "run", .record = record};
    return is_there;
}

bool wh_run_document(const wh_script_run_t *run, const char *script, wh_signals_t *signals,
                     wh_document_t *document, char message[WH_SANDBOX_MESSAGE_BYTES]) {
    const wh_record_t *record = &run->record;
    if (!record->layout) {
        (void)snprintf(message, WH_SANDBOX_MESSAGE_BYTES,
                       "%.900s: no cell (expected a script that names a layout: there is nothing to show)",
                       script);
        return false;
    }
    if (record->layout->tool) {
        return show_flow(record, document, message);
    }
    if (!signals->layout) {
        wh_signals_begin(signals, record->layout, true);
    }
    wh_signals_finish(signals);
    *document = (wh_document_t){.source = "run", .record = record, .signals = signals};
    return true;
}

char *wh_run_command(const char *subcommand, const wh_script_run_options_t *run) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = wh_memory_need(open_memstream(&text, &size));
    fprintf(out, "waferhand %s ", subcommand);
    wh_output_word(out, run->script);
    for (size_t i = 0; i < run->parameter_count; ++i) {
        fputs(" --set ", out);
        wh_output_word(out, run->parameters[i]);
    }
    for (size_t i = 0; i < run->error_count; ++i) {
        fputs(" --error ", out);
        wh_output_word(out, run->errors[i]);
    }
    if (run->counts != WH_MCS_COUNT_NONE) {
        fputs(run->counts == WH_MCS_COUNT_STRICT ? " --counted --strict" : " --counted", out);
    }
    (void)fclose(out);
    return text;
}
