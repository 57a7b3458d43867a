#include "mcs_process.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define HEARTBEAT_US 200000
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

static void watch(void *user, const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended) {
    wh_mcs_process_t *control = user;
    control->sandbox = mcs->sandbox;
    control->outcome.commands += ended ? 0 : 1;
    snprintf(control->running, sizeof control->running, "%s", ended ? "" : command->text);
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

static void remember(wh_mcs_process_t *control, int64_t seq, wh_status_t error, const char *line,
                     const char *text) {
    wh_mcs_process_answer_t *answer = &control->answered[control->answered_count++ % WH_CONTROL_ANSWERED];
    answer->seq = seq;
    answer->error = (int32_t)error;
    snprintf(answer->line, sizeof answer->line, "%s", line);
    snprintf(answer->text, sizeof answer->text, "%s", text);
    tell_answer(control, answer);
}

/* True for STOP in any case, with blanks around it. */
static bool is_stop(const char *line) {
    const size_t blanks = strspn(line, " ");
    return strncasecmp(line + blanks, "STOP", 4) == 0 &&
           line[blanks + 4 + strspn(line + blanks + 4, " ")] == '\0';
}

/* Ends the running command, and answers the waiting ones without beginning them. */
static void stop_all(wh_mcs_process_t *control, const waferhand_request *message) {
    char line[WH_LINK_LINE];
    const wh_mcs_process_request_t executing = control->executing;
    wh_sandbox_stop(control->sandbox);
    control->node->interrupted = true; /* also a wait for a simulator that is silent */
    while (wh_mcs_process_next_request(control, line)) {
        remember(control, control->executing.seq, WH_STATUS_STOPPED, line,
                 wh_record_error_text(WH_STATUS_STOPPED));
    }
    control->executing = executing;
    remember(control, message->seq, WH_OK, message->command_line, "OK");
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
    } else if (!pending && control->running[0] != '\0' && is_stop(message->command_line)) {
        stop_all(control, message);
    } else if (!pending) {
        enqueue(control, message);
    }
}

static void on_request(void *user, const void *data, size_t size) {
    wh_mcs_process_t *control = user;
    waferhand_request message;
    if (!wh_link_decode_request(data, size, &message)) {
        if (control->garbage++ == 0) {
            wh_node_say(control->node,
                        WH_CHANNEL_REQUEST ": a datagram is no such message: dropped, like all that follow");
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

static wh_link_t *connect_client(void *user, wh_mcs_t *mcs) {
    wh_mcs_process_t *control = user;
    if (mcs->layout->wafer_count > WH_LINK_WAFERS) {
        wh_node_say(control->node, "the layout has more wafers than a message carries (256)");
        return NULL;
    }
    control->connected =
        wh_protocol_client_open(&control->client, control->node, mcs->layout, &control->options);
    if (control->connected) {
        wh_mcs_process_catch_up(control, mcs);
    }
    return control->connected ? &control->client.link : NULL;
}

/* Subscribed only so that the record holds the cell: it can then be replayed without the layout's file. */
static void on_cell(void *user, const void *data, size_t size) {
    (void)user;
    (void)data;
    (void)size;
}

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
    char text[WH_OUTCOME_BYTES + sizeof control->reason];
    if (control->outcome.verdict == WH_OUTCOME_UNTOLD) {
        control->outcome.verdict = WH_OUTCOME_ENDED;
    }
    wh_outcome_write(&control->outcome, control->reason, text, sizeof text);
    tell(control, control->executing.seq, WH_LINK_PHASE_OVER, 0, WH_OK, "", text);
}
