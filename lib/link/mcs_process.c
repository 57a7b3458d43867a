#include "mcs_process.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../mcs/session.h"
#include "../text/array.h"
#include "../text/style.h"
#include "../text/utf8.h"

#define HEARTBEAT_US 200000
/* What a datagram has besides the two texts of a message. */
#define MESSAGE_BYTES 128
#define TOO_LONG "the line is too long (expected at most 1000 bytes)"
/* How long the end of a free-running command waits for the state of its last slice. */
#define COMMAND_SETTLE_US 100000

/* ------------------------------------------------------------------------------------------------ telling */

/* `request` is the one that this answers or goes on with; 0: none. */
static void tell(wh_mcs_process_t *control, int64_t request, int32_t phase, int line, wh_status_t error,
                 const char *command, const char *text) {
    if (control->connected) {
        control->utime = control->client.command.utime;
        control->seq = control->client.command.seq;
        control->identity = control->client.identity;
    }
    const waferhand_mcs message = {.utime = control->utime,
                                   .seq = control->seq,
                                   .run = control->identity.run,
                                   .layout_hash = (int64_t)control->identity.layout_hash,
                                   .phase = phase,
                                   .request = request,
                                   .line = line,
                                   .error = (int32_t)error,
                                   .command = wh_link_borrowed(command),
                                   .text = wh_link_borrowed(text)};
    const int size = waferhand_mcs_encode(control->encoded, 0, (int)sizeof control->encoded, &message);
    if (size > 0) {
        (void)wh_node_publish(control->node, WH_CHANNEL_MCS, control->encoded, (size_t)size);
    }
}

/* The longest text of a script that is told whole, with its terminator. */
#define TEXT_BYTES 4000

/* Tells a text of the script's, which may be of any length. `number`: which one of the run it is, from 1. */
static void tell_text(wh_mcs_process_t *control, int32_t phase, int line, int64_t number, const char *text) {
    char cut[TEXT_BYTES];
    const size_t length = strlen(text);
    if (length >= sizeof cut) {
        snprintf(cut, sizeof cut, "%.*s... (%zu bytes, cut)", TEXT_BYTES - 60, text, length);
    }
    tell(control, 0, phase, line, (wh_status_t)number, "", length < sizeof cut ? text : cut);
}

static void tell_expectation(wh_mcs_process_t *control, const wh_expectation_record_t *expectation) {
    ++control->outcome.expectations;
    control->outcome.met += expectation->ok ? 1 : 0;
    tell_text(control, expectation->ok ? WH_LINK_PHASE_MET : WH_LINK_PHASE_UNMET, expectation->line,
              control->outcome.expectations, expectation->text);
}

void wh_mcs_process_catch_up(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    const wh_record_t *record = mcs->recorder.record;
    for (size_t i = (size_t)control->outcome.expectations; i < record->expectation_count; ++i) {
        tell_expectation(control, &record->expectations[i]);
    }
}

/* Before there is a run they are kept: nobody could tell whose they are. */
static void expected(void *user, const wh_mcs_t *mcs) {
    wh_mcs_process_t *control = user;
    if (control->identity.run != 0 || control->connected) {
        wh_mcs_process_catch_up(control, mcs);
    }
}

static void cycle(void *user, const wh_mcs_t *mcs) {
    wh_mcs_process_t *control = user;
    const wh_cycle_record_t *begun = &mcs->recorder.record->cycles[mcs->recorder.record->cycle_count - 1];
    ++control->outcome.cycles;
    tell_text(control, WH_LINK_PHASE_CYCLE, begun->line, control->outcome.cycles, begun->name);
}

static void finished(void *user, const wh_mcs_t *mcs) {
    wh_mcs_process_t *control = user;
    const wh_record_t *record = mcs->recorder.record;
    control->outcome.verdict = record->ok ? WH_OUTCOME_PASSED : WH_OUTCOME_FAILED;
    snprintf(control->reason, sizeof control->reason, "%s", record->failure ? record->failure : "");
}

/* The run is over; the next one, of a session, has its own counts. */
static void tell_over(wh_mcs_process_t *control) {
    char text[WH_OUTCOME_BYTES + sizeof control->reason];
    if (control->outcome.verdict == WH_OUTCOME_UNTOLD) {
        control->outcome.verdict = WH_OUTCOME_ENDED;
    }
    wh_outcome_write(&control->outcome, control->reason, text, sizeof text);
    tell(control, control->executing.seq, WH_LINK_PHASE_OVER, 0, WH_OK, "", text);
    memset(&control->outcome, 0, sizeof control->outcome);
    control->reason[0] = '\0';
}

static void watch(void *user, const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended) {
    wh_mcs_process_t *control = user;
    (void)mcs;
    control->outcome.commands += ended ? 0 : 1;
    wh_utf8_clip(control->running, sizeof control->running, ended ? "" : command->text);
    control->running_line = command->line;
    if (!ended) {
        tell(control, control->executing.seq, WH_LINK_PHASE_BEGINS, command->line, WH_OK, command->text, "");
        return;
    }
    if (control->connected) {
        (void)wh_protocol_client_settle(&control->client, COMMAND_SETTLE_US);
    }
    /* Not as the request's answer: that carries its result, and wh_mcs_process_answer sends it. */
    tell(control, 0, command->error == WH_OK ? WH_LINK_PHASE_DONE : WH_LINK_PHASE_FAILED, command->line,
         command->error, command->text, command->message ? command->message : "");
}

/* ----------------------------------------------------------------------------------------------- requests */

static const wh_mcs_process_answer_t *find_answer(const wh_mcs_process_t *control, int64_t seq) {
    for (size_t i = 0; i < WH_CONTROL_ANSWERED; ++i) {
        if (control->answered[i].seq == seq) {
            return &control->answered[i];
        }
    }
    return NULL;
}

/* The line of the request that waits or is executed under this number, else null. */
static const char *find_pending(const wh_mcs_process_t *control, int64_t seq) {
    for (size_t i = 0; i < control->waiting_count; ++i) {
        const wh_mcs_process_request_t *request =
            &control->waiting[(control->first_waiting + i) % WH_CONTROL_REQUESTS];
        if (request->seq == seq) {
            return request->line;
        }
    }
    return control->executing.seq == seq ? control->executing.line : NULL;
}

static void tell_answer(wh_mcs_process_t *control, const wh_mcs_process_answer_t *answer) {
    tell(control, answer->seq, answer->error == WH_OK ? WH_LINK_PHASE_DONE : WH_LINK_PHASE_FAILED, 0,
         (wh_status_t)answer->error, answer->line, answer->text);
}

/* A copy, of which a datagram takes all; else it tells how much is left. */
static char *copy_text(const char *text, size_t room) {
    const size_t length = strlen(text);
    if (length <= room) {
        return wh_text_copy(text);
    }
    char *copy = wh_array_new(room + 1, 1);
    const size_t kept = wh_utf8_cut(text, room - 60);
    snprintf(copy, room + 1, "%.*s... (cut: the first %zu bytes of %zu)", (int)kept, text, kept, length);
    return copy;
}

static void remember(wh_mcs_process_t *control, int64_t seq, wh_status_t error, const char *line,
                     const char *text) {
    wh_mcs_process_answer_t *answer = &control->answered[control->answered_count++ % WH_CONTROL_ANSWERED];
    free(answer->text);
    answer->seq = seq;
    answer->error = (int32_t)error;
    snprintf(answer->line, sizeof answer->line, "%s", line);
    answer->text = copy_text(text, WH_LINK_DATAGRAM - MESSAGE_BYTES - strlen(answer->line));
    tell_answer(control, answer);
}

/* Answers the requests that wait without beginning them. */
static void stop_waiting(wh_mcs_process_t *control) {
    char line[WH_LINK_LINE];
    const wh_mcs_process_request_t executing = control->executing;
    while (wh_mcs_process_next_request(control, line)) {
        remember(control, control->executing.seq, WH_STATUS_STOPPED, line,
                 wh_record_error_text(WH_STATUS_STOPPED));
    }
    control->executing = executing;
}

/* Ends the running command, too. */
static void stop_all(wh_mcs_process_t *control, const waferhand_request *message) {
    if (control->mcs) {
        wh_mcs_stop(control->mcs);
    }
    control->node->interrupted = true; /* also a wait for a simulator that is silent */
    stop_waiting(control);
    remember(control, message->seq, WH_OK, message->command_line, "OK");
}

static void tell_status(wh_mcs_process_t *control, const waferhand_request *message) {
    char text[WH_MCS_DESCRIPTION_BYTES + 4] = "OK phase=over";
    if (control->mcs) {
        wh_mcs_describe(control->mcs, text + 3);
    }
    tell(control, message->seq, WH_LINK_PHASE_DONE, 0, WH_OK, message->command_line, text);
}

/* An answer that is not remembered: asked again, the request may be taken. */
static void turn_away(wh_mcs_process_t *control, const waferhand_request *message, wh_status_t error,
                      const char *text) {
    tell(control, message->seq, WH_LINK_PHASE_FAILED, 0, error, message->command_line, text);
}

static void turn_away_number(wh_mcs_process_t *control, const waferhand_request *message, const char *taken) {
    char text[400];
    snprintf(text, sizeof text, "%s: %" PRId64 " was \"%.200s\" (expected a number of its own for each line)",
             wh_record_error_text(WH_STATUS_NUMBER_TAKEN), message->seq, taken);
    turn_away(control, message, WH_STATUS_NUMBER_TAKEN, text);
}

static void turn_away_in_script(wh_mcs_process_t *control, const waferhand_request *message) {
    char text[400];
    snprintf(text, sizeof text, "%s: the script %.200s runs (expected STATUS, VERSION or STOP)",
             wh_record_error_text(WH_STATUS_BUSY), control->script);
    turn_away(control, message, WH_STATUS_BUSY, text);
}

static void enqueue(wh_mcs_process_t *control, const waferhand_request *message) {
    if (control->waiting_count == WH_CONTROL_REQUESTS) {
        turn_away(control, message, WH_STATUS_BUSY, wh_record_error_text(WH_STATUS_BUSY));
        return;
    }
    wh_mcs_process_request_t *request =
        &control->waiting[(control->first_waiting + control->waiting_count++) % WH_CONTROL_REQUESTS];
    request->seq = message->seq;
    snprintf(request->line, sizeof request->line, "%s", message->command_line);
}

/* Null if the request is meant for this run and layout and fits; else why it is not taken. */
static const char *misdirected(const wh_mcs_process_t *control, const waferhand_request *message,
                               wh_status_t *error) {
    const wh_link_identity_t *identity = &control->client.identity;
    if (message->run != 0 && !(control->connected && message->run == identity->run)) {
        *error = WH_STATUS_UNKNOWN_RUN;
        return "the request is for another run (expected this one, or 0 for any)";
    }
    if (message->layout_hash != 0 &&
        !(control->connected && (uint64_t)message->layout_hash == identity->layout_hash)) {
        *error = WH_STATUS_OTHER_LAYOUT;
        return "the request is for another layout (expected this one, or 0 for any)";
    }
    *error = WH_STATUS_BAD_ARGUMENT;
    return strlen(message->command_line) < WH_LINK_LINE ? NULL : TOO_LONG;
}

/* One that has not come before. */
static void take_new(wh_mcs_process_t *control, const waferhand_request *message) {
    const char *line = message->command_line;
    const bool stoppable = control->script || control->running[0] != '\0';
    if (wh_session_says(line, "STATUS")) {
        tell_status(control, message);
    } else if (wh_session_says(line, "VERSION")) {
        tell(control, message->seq, WH_LINK_PHASE_DONE, 0, WH_OK, line, "OK version=" WH_VERSION);
    } else if (stoppable && wh_session_says(line, "STOP")) {
        stop_all(control, message);
    } else if (control->script) {
        turn_away_in_script(control, message);
    } else {
        enqueue(control, message);
    }
}

/* A request that comes again is answered again, not executed again: the answer may have been lost. */
static void take_request(wh_mcs_process_t *control, const waferhand_request *message) {
    wh_status_t error;
    const char *reason = misdirected(control, message, &error);
    const wh_mcs_process_answer_t *answer = find_answer(control, message->seq);
    const char *pending = find_pending(control, message->seq);
    const char *line = answer ? answer->line : pending;
    if (reason) {
        turn_away(control, message, error, reason);
    } else if (line && strcmp(line, message->command_line) != 0) {
        turn_away_number(control, message, line);
    } else if (answer) {
        tell_answer(control, answer);
    } else if (!pending) {
        take_new(control, message);
    }
}

static void on_request(void *user, const void *data, size_t size) {
    wh_mcs_process_t *control = user;
    waferhand_request message;
    if (!wh_link_decode_request(data, size, &message)) {
        if (control->garbage++ == 0) {
            wh_node_warn(control->node,
                         WH_CHANNEL_REQUEST ": a datagram of %zu bytes is no request and was dropped; "
                                            "others will be dropped without a word",
                         size);
        }
        return;
    }
    ++control->requests;
    /* Nobody could tell the answer to 0 from what is told without a request. */
    if (message.seq != 0) {
        take_request(control, &message);
    }
    (void)waferhand_request_decode_cleanup(&message);
}

bool wh_mcs_process_next_request(wh_mcs_process_t *control, char line[WH_LINK_LINE]) {
    if (control->waiting_count == 0) {
        return false;
    }
    const wh_mcs_process_request_t *request = &control->waiting[control->first_waiting];
    control->first_waiting = (control->first_waiting + 1) % WH_CONTROL_REQUESTS;
    --control->waiting_count;
    control->executing = *request;
    snprintf(line, WH_LINK_LINE, "%s", request->line);
    return true;
}

void wh_mcs_process_answer(wh_mcs_process_t *control, wh_status_t error, const char *line, const char *text) {
    const int64_t seq = control->executing.seq;
    control->executing.seq = 0;
    remember(control, seq, error, line, text);
}

/* ------------------------------------------------------------------------------------------------ the run */

static void tell_progress(void *user) {
    wh_mcs_process_t *control = user;
    if (control->running[0] != '\0') {
        tell(control, control->executing.seq, WH_LINK_PHASE_GOES_ON, control->running_line, WH_OK,
             control->running, "");
    }
}

/* A second time, for another run of a session: the one before is over. */
static wh_link_t *connect_client(void *user, wh_mcs_t *mcs) {
    wh_mcs_process_t *control = user;
    if (mcs->layout->wafer_count > WH_LINK_WAFERS) {
        wh_node_warn(control->node, "the layout has more wafers than a message carries (256)");
        return NULL;
    }
    control->mcs = mcs;
    if (control->connected) {
        tell_over(control);
        wh_protocol_client_begin(&control->client, mcs->layout);
        return &control->client.link;
    }
    control->connected =
        wh_protocol_client_open(&control->client, control->node, mcs->layout, &control->options);
    if (control->connected) {
        wh_mcs_process_catch_up(control, mcs);
    }
    return control->connected ? &control->client.link : NULL;
}

/* ------------------------------------------------------------------------------------------- explanations */

static void explain_layout(wh_mcs_process_t *control) {
    const wh_protocol_client_t *client = &control->client;
    const uint64_t other = client->other_layout_hash;
    const bool known = control->simulator_path[0] != '\0' && control->simulator_layout == other;
    snprintf(control->explanation, sizeof control->explanation,
             "%s%shash %016" PRIx64 " (expected %.200s, hash %016" PRIx64 ")",
             known ? control->simulator_path : "", known ? ", " : "", other, client->layout->path,
             client->identity.layout_hash);
}

static const char *explain(void *user, wh_status_t status) {
    wh_mcs_process_t *control = user;
    switch ((int)status) {
    case WH_STATUS_STOPPED:
        return "by a signal";
    case WH_STATUS_OTHER_LAYOUT:
        explain_layout(control);
        return control->explanation;
    case WH_STATUS_NO_ANSWER:
        snprintf(control->explanation, sizeof control->explanation, "none for %g s, slice %" PRId64 " waits",
                 (double)control->options.timeout_us / 1e6, control->client.command.seq);
        return control->explanation;
    case WH_STATUS_RUN_OVER:
    case WH_STATUS_NO_NETWORK:
        return NULL;
    default:
        return "the simulator refused a slice";
    }
}

/* The record holds the cell, so that it can be replayed without the layout's file. */
static void on_cell(void *user, const void *data, size_t size) {
    wh_mcs_process_t *control = user;
    waferhand_cell message;
    if (!wh_link_decode_cell(data, size, &message)) {
        return;
    }
    if (control->simulator_path[0] == '\0' || control->simulator_layout != (uint64_t)message.layout_hash) {
        char *path = wh_style_printable(message.layout);
        wh_utf8_clip(control->simulator_path, sizeof control->simulator_path, path);
        free(path);
        control->simulator_layout = (uint64_t)message.layout_hash;
    }
    (void)waferhand_cell_decode_cleanup(&message);
}

/* ------------------------------------------------------------------------------------ opening and closing */

bool wh_mcs_process_open(wh_mcs_process_t *control, wh_node_t *node,
                         const wh_protocol_client_options_t *options) {
    memset(control, 0, sizeof *control);
    control->node = node;
    control->options = *options;
    control->options.tick = tell_progress;
    control->options.user = control;
    return wh_node_subscribe(node, WH_CHANNEL_REQUEST, on_request, control) &&
           wh_node_subscribe(node, WH_CHANNEL_CELL, on_cell, control);
}

wh_mcs_partners_t wh_mcs_process_partners(wh_mcs_process_t *control) {
    return (wh_mcs_partners_t){.connect = connect_client,
                               .watch = watch,
                               .explain = explain,
                               .expected = expected,
                               .cycle = cycle,
                               .finished = finished,
                               .user = control};
}

void wh_mcs_process_idle(wh_mcs_process_t *control) {
    const int64_t now = wh_node_clock_us();
    (void)wh_node_drain(control->node, 64);
    if (now - control->last_beat_us < HEARTBEAT_US) {
        return;
    }
    control->last_beat_us = now;
    if (control->connected) {
        wh_protocol_client_heartbeat(&control->client);
    }
    tell(control, control->executing.seq, WH_LINK_PHASE_IDLE, 0, WH_OK, "", "");
}

void wh_mcs_process_finish(wh_mcs_process_t *control) {
    control->mcs = NULL;
    stop_waiting(control);
    tell_over(control);
}

void wh_mcs_process_close(wh_mcs_process_t *control) {
    for (size_t i = 0; i < WH_CONTROL_ANSWERED; ++i) {
        free(control->answered[i].text);
        control->answered[i].text = NULL;
    }
}
