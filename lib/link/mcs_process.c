#include "mcs_process.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#define HEARTBEAT_US 200000
/* How long the end of a free-running command waits for the state of its last slice. */
#define COMMAND_SETTLE_US 100000

/* ------------------------------------------------------------------------------------------------ telling */

/* `request` is the one that this answers or goes on with; 0: none. */
static void tell(wh_mcs_process_t *control, int64_t request, int32_t phase, int line, wh_status_t error,
                 const char *command, const char *text) {
    waferhand_mcs message;
    memset(&message, 0, sizeof message);
    if (control->connected) {
        control->utime = control->client.command.utime;
        control->seq = control->client.command.seq;
        control->identity = control->client.identity;
    }
    message.utime = control->utime;
    message.seq = control->seq;
    message.run = control->identity.run;
    message.layout_hash = (int64_t)control->identity.layout_hash;
    message.phase = phase;
    message.request = request;
    message.line = line;
    message.error = (int32_t)error;
    message.command = wh_link_borrowed(command);
    message.text = wh_link_borrowed(text);
    const int size = waferhand_mcs_encode(control->encoded, 0, (int)sizeof control->encoded, &message);
    if (size > 0) {
        (void)wh_node_publish(control->node, WH_CHANNEL_MCS, control->encoded, (size_t)size);
    }
}

static void watch(void *user, const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended) {
    wh_mcs_process_t *control = user;
    control->sandbox = mcs->sandbox;
    snprintf(control->running, sizeof control->running, "%s", ended ? "" : command->text);
    control->running_line = command->line;
    if (!ended) {
        tell(control, control->request, WH_LINK_PHASE_BEGINS, command->line, WH_OK, command->text, "");
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

static bool is_waiting(const wh_mcs_process_t *control, int64_t seq) {
    for (size_t i = 0; i < control->waiting_count; ++i) {
        if (control->waiting[(control->first_waiting + i) % WH_CONTROL_REQUESTS].seq == seq) {
            return true;
        }
    }
    return control->request == seq;
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
    const int64_t executing = control->request;
    wh_sandbox_stop(control->sandbox);
    control->node->interrupted = true; /* also a wait for a simulator that is silent */
    while (wh_mcs_process_next_request(control, line)) {
        remember(control, control->request, WH_STATUS_STOPPED, line, wh_record_error_text(WH_STATUS_STOPPED));
    }
    control->request = executing;
    remember(control, message->seq, WH_OK, message->command_line, "OK");
}

static void enqueue(wh_mcs_process_t *control, const waferhand_request *message) {
    if (control->waiting_count == WH_CONTROL_REQUESTS) {
        /* Not remembered: asked again, the request may find room. */
        wh_mcs_process_answer_t busy = {.seq = message->seq, .error = WH_STATUS_BUSY};
        snprintf(busy.line, sizeof busy.line, "%s", message->command_line);
        snprintf(busy.text, sizeof busy.text, "%s", wh_record_error_text(WH_STATUS_BUSY));
        tell_answer(control, &busy);
        return;
    }
    wh_mcs_process_request_t *request =
        &control->waiting[(control->first_waiting + control->waiting_count++) % WH_CONTROL_REQUESTS];
    request->seq = message->seq;
    snprintf(request->line, sizeof request->line, "%s", message->command_line);
}

static bool is_for_us(const wh_mcs_process_t *control, const waferhand_request *message) {
    const wh_link_identity_t *identity = &control->client.identity;
    const bool run = message->run == 0 || (control->connected && message->run == identity->run);
    const bool layout = message->layout_hash == 0 ||
                        (control->connected && (uint64_t)message->layout_hash == identity->layout_hash);
    return message->seq != 0 && run && layout && strlen(message->command_line) < WH_LINK_LINE;
}

static void on_request(void *user, const void *data, size_t size) {
    wh_mcs_process_t *control = user;
    waferhand_request message;
    if (!wh_link_decode_request(data, size, &message)) {
        ++control->garbage;
        if (!control->named_garbage) {
            control->named_garbage = true;
            wh_node_say(control->options.say, control->options.user,
                        WH_CHANNEL_REQUEST ": a datagram is no such message: dropped, like all that follow");
        }
        return;
    }
    ++control->requests;
    if (is_for_us(control, &message) && !is_waiting(control, message.seq)) {
        /* A request that comes again is answered again, not executed again: the answer may have been lost. */
        const wh_mcs_process_answer_t *answer = find_answer(control, message.seq);
        if (answer) {
            tell_answer(control, answer);
        } else if (control->running[0] != '\0' && is_stop(message.command_line)) {
            stop_all(control, &message);
        } else {
            enqueue(control, &message);
        }
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
    control->request = request->seq;
    snprintf(line, WH_LINK_LINE, "%s", request->line);
    return true;
}

void wh_mcs_process_answer(wh_mcs_process_t *control, wh_status_t error, const char *line, const char *text) {
    const int64_t seq = control->request;
    control->request = 0;
    remember(control, seq, error, line, text);
}

/* ------------------------------------------------------------------------------------------------ the run */

static void tell_progress(void *user) {
    wh_mcs_process_t *control = user;
    if (control->running[0] != '\0') {
        tell(control, control->request, WH_LINK_PHASE_GOES_ON, control->running_line, WH_OK, control->running,
             "");
    }
}

static wh_link_t *connect_client(void *user, wh_mcs_t *mcs) {
    wh_mcs_process_t *control = user;
    const wh_protocol_client_options_t options = {.layout = mcs->layout,
                                                  .outputs = control->options.outputs,
                                                  .rate = control->options.rate,
                                                  .stop = control->options.stop,
                                                  .say = control->options.say,
                                                  .user = control->options.user,
                                                  .tick = tell_progress,
                                                  .tick_user = control};
    if (mcs->layout->wafer_count > WH_LINK_WAFERS) {
        wh_node_say(control->options.say, control->options.user,
                    "the layout has more wafers than a message carries (256)");
        return NULL;
    }
    control->connected = wh_protocol_client_open(&control->client, control->node, &options);
    return control->connected ? &control->client.link : NULL;
}

/* Subscribed only so that the record holds the cell: it can then be replayed without the layout's file. */
static void on_cell(void *user, const void *data, size_t size) {
    (void)user;
    (void)data;
    (void)size;
}

bool wh_mcs_process_open(wh_mcs_process_t *control, wh_node_t *node,
                         const wh_mcs_process_options_t *options) {
    memset(control, 0, sizeof *control);
    control->node = node;
    control->options = *options;
    return wh_node_subscribe(node, WH_CHANNEL_REQUEST, on_request, control) &&
           wh_node_subscribe(node, WH_CHANNEL_CELL, on_cell, control);
}

wh_mcs_partners_t wh_mcs_process_partners(wh_mcs_process_t *control) {
    const wh_mcs_partners_t partners = {.connect = connect_client, .watch = watch, .user = control};
    return partners;
}

void wh_mcs_process_idle(wh_mcs_process_t *control) {
    const int64_t now = wh_node_clock_us();
    if (now - control->last_beat_us < HEARTBEAT_US) {
        (void)wh_node_drain(control->node, 64);
        return;
    }
    control->last_beat_us = now;
    if (control->connected) {
        wh_protocol_client_heartbeat(&control->client);
    } else {
        (void)wh_node_drain(control->node, 64);
    }
    tell(control, control->request, WH_LINK_PHASE_IDLE, 0, WH_OK, "", "");
}

void wh_mcs_process_set_slice(wh_mcs_process_t *control, const wh_link_identity_t *identity,
                              const wh_command_t *command) {
    control->identity = *identity;
    control->utime = command->utime;
    control->seq = command->seq;
}

void wh_mcs_process_finish(wh_mcs_process_t *control) {
    tell(control, control->request, WH_LINK_PHASE_OVER, 0, WH_OK, "", "");
}
