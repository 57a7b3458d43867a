/* Requests to motion control: which wait, which are turned away, and which answers are remembered. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../mcs/flow_held.h"
#include "../mcs/session.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "mcs_process_internal.h"

/* The bytes of a datagram besides the two texts of a message. */
#define MESSAGE_BYTES 128
/* Room for the reason why a request is turned away. */
#define REASON_BYTES 600
/* At most this number of messages is handled before the requests that wait are answered. */
#define MESSAGES_AT_ONCE 1000

static const wh_mcs_process_answer_t *find_answer(const wh_mcs_process_t *control, int64_t seq) {
    for (size_t i = 0; i < WH_CONTROL_ANSWERED; ++i) {
        if (control->requests.answered[i].message.request == seq) {
            return &control->requests.answered[i];
        }
    }
    return NULL;
}

/* The request that waits or is executed under this number; otherwise null. */
static const wh_mcs_process_request_t *find_pending(const wh_mcs_process_t *control, int64_t seq) {
    for (size_t i = 0; i < control->requests.waiting_count; ++i) {
        const wh_mcs_process_request_t *request =
            &control->requests.waiting[(control->requests.first_waiting + i) % WH_CONTROL_REQUESTS];
        if (request->seq == seq) {
            return request;
        }
    }
    return control->requests.executing.seq == seq ? &control->requests.executing : NULL;
}

/* If a text does not fit a datagram, the answer tells how much is left. */
static void remember(wh_mcs_process_t *control, const wh_mcs_process_request_t *request, wh_status_t error,
                     const char *text) {
    const int32_t phase = error == WH_OK ? WH_LINK_PHASE_DONE : WH_LINK_PHASE_FAILED;
    wh_mcs_process_answer_t *answer =
        &control->requests.answered[control->requests.answered_count++ % WH_CONTROL_ANSWERED];
    free(answer->text);
    snprintf(answer->line, sizeof answer->line, "%s", request->line);
    answer->run = request->run;
    const size_t room = WH_LINK_DATAGRAM - MESSAGE_BYTES - strlen(answer->line);
    const size_t length = strlen(text);
    const size_t kept = length <= room ? length : wh_utf8_cut(text, room - 60);
    answer->text = wh_array_new(kept + 80, 1);
    memcpy(answer->text, text, kept);
    if (kept < length) {
        snprintf(answer->text + kept, 80, "... (cut: the first %zu bytes of %zu)", kept, length);
    }
    answer->message = wh_mcs_process_message(control, request->seq, phase, error, answer->line, answer->text);
    wh_mcs_process_publish(control, &answer->message);
}

/* Sends an answer that is not remembered: if it comes again, the request may be taken. */
__attribute__((format(printf, 5, 6))) static void turn_away(wh_mcs_process_t *control, int64_t seq,
                                                            const char *line, wh_status_t error,
                                                            const char *format, ...) {
    char reason[REASON_BYTES];
    char text[2 * REASON_BYTES];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(reason, sizeof reason, format, values);
    va_end(values);
    wh_session_write_error(text, sizeof text, error, reason);
    wh_mcs_process_tell(control, seq, WH_LINK_PHASE_FAILED, 0, error, line, text);
}

/* True if the request is meant for another run or layout; its sender has then been told so. */
static bool turn_away_misdirected(wh_mcs_process_t *control, const wh_mcs_process_request_t *request,
                                  const char *line) {
    static const wh_link_identity_t nowhere = {0};
    const wh_link_identity_t *here = control->connected ? &control->client.identity : &nowhere;
    if (request->run != 0 && request->run != here->run) {
        turn_away(control, request->seq, line, WH_STATUS_UNKNOWN_RUN,
                  "the request is for run %016" PRIx64 " (expected this one, %016" PRIx64 ", or 0 for any)",
                  (uint64_t)request->run, (uint64_t)here->run);
        return true;
    }
    if (request->layout_hash != 0 && (uint64_t)request->layout_hash != here->layout_hash) {
        turn_away(control, request->seq, line, WH_STATUS_OTHER_LAYOUT,
                  "the request is for layout %016" PRIx64 " (expected this one, %016" PRIx64
                  ", or 0 for any)",
                  (uint64_t)request->layout_hash, here->layout_hash);
        return true;
    }
    return false;
}

/* The next request that waits becomes the one being executed. */
static bool take_waiting(wh_mcs_process_t *control) {
    if (control->requests.waiting_count == 0) {
        return false;
    }
    control->requests.executing = control->requests.waiting[control->requests.first_waiting];
    control->requests.first_waiting = (control->requests.first_waiting + 1) % WH_CONTROL_REQUESTS;
    --control->requests.waiting_count;
    return true;
}

/* Answers the requests that wait, without beginning them. */
void wh_mcs_process_clear(wh_mcs_process_t *control) {
    char text[REASON_BYTES];
    const wh_mcs_process_request_t executing = control->requests.executing;
    wh_session_write_error(text, sizeof text, WH_STATUS_STOPPED,
                           "the command was stopped before its end; it waited and was not begun");
    while (take_waiting(control)) {
        remember(control, &control->requests.executing, WH_STATUS_STOPPED, text);
    }
    control->requests.executing = executing;
}

/* Ends all requests and the running command. Between two commands of a script it ends the next one. */
static void stop_all(wh_mcs_process_t *control, const wh_mcs_process_request_t *request) {
    if (control->mcs && control->owner.stops) {
        control->owner.stops(control->owner.user);
    } else if (control->mcs && (control->script || control->running_count > 0)) {
        wh_mcs_stop(control->mcs);
        control->node->interrupted = true; /* ends also the wait for a silent simulator */
    } else if (control->mcs) {
        wh_mcs_give_up(control->mcs, WH_NONE);
    }
    wh_mcs_process_clear(control);
    remember(control, request, WH_OK, "OK");
}

/* Finds the name behind the word and a blank, plain or in quotes; false if the line is no such one. */
static bool find_named(const char *line, const char *word, char name[WH_LINK_LINE]) {
    const size_t word_length = strlen(word);
    line += strspn(line, " ");
    if (strncasecmp(line, word, word_length) != 0 || line[word_length] != ' ') {
        return false;
    }
    line += word_length + strspn(line + word_length, " ");
    size_t length = strlen(line);
    while (length > 0 && line[length - 1] == ' ') {
        --length;
    }
    const bool quoted = length > 2 && line[0] == '"' && line[length - 1] == '"';
    snprintf(name, WH_LINK_LINE, "%.*s", (int)(quoted ? length - 2 : length), quoted ? line + 1 : line);
    return name[0] != '\0';
}

static void stop_mechanism(wh_mcs_process_t *control, const wh_mcs_process_request_t *request,
                           const char *name) {
    char text[REASON_BYTES];
    char reason[REASON_BYTES - 100];
    if (!control->mcs || wh_mcs_stop_mechanism(control->mcs, name)) {
        remember(control, request, WH_OK, "OK");
        return;
    }
    snprintf(reason, sizeof reason, "mechanism: %.*s (expected robot, or a station with a chuck)",
             (int)wh_utf8_cut(name, 200), name);
    wh_session_write_error(text, sizeof text, WH_STATUS_BAD_ARGUMENT, reason);
    remember(control, request, WH_STATUS_BAD_ARGUMENT, text);
}

/* HOLD or CONTINUE of a flow's robots; `name` null: of all. */
static void hold_robot(wh_mcs_process_t *control, const wh_mcs_process_request_t *request, const char *name,
                       bool is_held) {
    char text[REASON_BYTES];
    char reason[WH_MCS_HOLD_BYTES] = "no flow carries wafers now";
    const wh_status_t error =
        control->mcs ? wh_mcs_hold_robot(control->mcs, name, is_held, reason) : WH_STATUS_NOT_IN_PHASE;
    if (error == WH_OK) {
        remember(control, request, WH_OK, "OK");
        return;
    }
    wh_session_write_error(text, sizeof text, error, reason);
    remember(control, request, error, text);
}

/* True if the line is one of these, which is answered then. A prompt has a CONTINUE of its own. */
static bool take_hold(wh_mcs_process_t *control, const wh_mcs_process_request_t *request) {
    static const char *const words[] = {"CONTINUE", "HOLD"};
    char name[WH_LINK_LINE];
    for (size_t i = control->script ? 0 : 1; i < 2; ++i) {
        const bool is_plain = wh_session_says(request->line, words[i]);
        if (is_plain || find_named(request->line, words[i], name)) {
            hold_robot(control, request, is_plain ? NULL : name, i == 1);
            return true;
        }
    }
    return false;
}

/* A script's place cannot be kept, nor that of its flow. */
static const char *find_unkept(const char *line) {
    static const char *const words[] = {"SAVE", "RESTORE", "UNDO", "RESET"};
    char name[WH_LINK_LINE];
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        if (wh_session_says(line, words[i]) || find_named(line, words[i], name)) {
            return words[i];
        }
    }
    return NULL;
}

static void turn_away_of_script(wh_mcs_process_t *control, const wh_mcs_process_request_t *request) {
    static const char expected[] = "(expected STATUS, VERSION, STOP, or HOLD and CONTINUE in a flow)";
    const char *unkept = find_unkept(request->line);
    if (unkept) {
        turn_away(control, request->seq, request->line, WH_STATUS_BUSY,
                  "%s puts back a cell and a prompt; the script %.200s runs, and where it and its flow are "
                  "cannot be put back %s",
                  unkept, control->script, expected);
    } else {
        turn_away(control, request->seq, request->line, WH_STATUS_BUSY,
                  "another command is being executed; the script %.200s runs %s", control->script, expected);
    }
}

static void enqueue(wh_mcs_process_t *control, const wh_mcs_process_request_t *request) {
    if (control->requests.waiting_count == WH_CONTROL_REQUESTS) {
        turn_away(control, request->seq, request->line, WH_STATUS_BUSY,
                  "another command is being executed; %d requests wait (expected fewer)",
                  WH_CONTROL_REQUESTS);
        return;
    }
    control->requests.waiting[(control->requests.first_waiting + control->requests.waiting_count++) %
                              WH_CONTROL_REQUESTS] = *request;
}

/* Takes a new request for this run and layout. */
static void take_new(wh_mcs_process_t *control, const wh_mcs_process_request_t *request) {
    const char *line = request->line;
    char status[WH_MCS_DESCRIPTION_BYTES + 4] = "OK phase=over";
    char name[WH_LINK_LINE];
    if (wh_session_says(line, "STATUS")) {
        if (control->mcs) {
            wh_mcs_describe(control->mcs, status + 3);
        }
        wh_mcs_process_tell(control, request->seq, WH_LINK_PHASE_DONE, 0, WH_OK, line, status);
    } else if (wh_session_says(line, "VERSION")) {
        wh_mcs_process_tell(control, request->seq, WH_LINK_PHASE_DONE, 0, WH_OK, line,
                            "OK version=" WH_VERSION);
    } else if (wh_session_says(line, "STOP")) {
        stop_all(control, request);
    } else if (find_named(line, "STOP", name)) {
        stop_mechanism(control, request, name);
    } else if (take_hold(control, request)) {
        return;
    } else if (control->script) {
        turn_away_of_script(control, request);
    } else if (control->owner.busy) {
        turn_away(control, request->seq, line, WH_STATUS_BUSY, "%s (expected STATUS, VERSION or STOP)",
                  control->owner.busy);
    } else {
        enqueue(control, request);
    }
}

/* The number is known. A request that comes again is answered again but not executed again, because the
 * answer may have been lost. The run may have gone on meanwhile, by a RESET. */
static void take_again(wh_mcs_process_t *control, const waferhand_request *message,
                       const wh_mcs_process_answer_t *answer, const wh_mcs_process_request_t *pending) {
    const char *line = answer ? answer->line : pending->line;
    const int64_t run = answer ? answer->run : pending->run;
    const int64_t told_run = answer ? answer->message.run : control->client.identity.run;
    const bool same_run = message->run == 0 || message->run == run || message->run == told_run;
    if (strcmp(line, message->command_line) != 0 || !same_run) {
        turn_away(control, message->seq, message->command_line, WH_STATUS_NUMBER_TAKEN,
                  "the request's number was another request's; %" PRId64 " was \"%.*s\" in run %016" PRIx64
                  " (expected a number of its own for each "
                  "line and run)",
                  message->seq, (int)wh_utf8_cut(line, 200), line, (uint64_t)(run != 0 ? run : told_run));
    } else if (answer) {
        wh_mcs_process_publish(control, &answer->message);
    }
}

static void take_request(wh_mcs_process_t *control, const waferhand_request *message) {
    wh_mcs_process_request_t request = {message->seq, message->run, message->layout_hash, ""};
    const wh_mcs_process_answer_t *answer = find_answer(control, message->seq);
    const wh_mcs_process_request_t *pending = find_pending(control, message->seq);
    if (answer || pending) {
        take_again(control, message, answer, pending);
        return;
    }
    if (control->owner.asked) {
        control->owner.asked(control->owner.user, message->seq, message->command_line);
    }
    if (turn_away_misdirected(control, &request, message->command_line)) {
        return;
    } else if (strlen(message->command_line) >= sizeof request.line) {
        turn_away(control, message->seq, message->command_line, WH_STATUS_BAD_ARGUMENT,
                  "the line is longer than %zu bytes", sizeof request.line - 1);
    } else {
        snprintf(request.line, sizeof request.line, "%s", message->command_line);
        take_new(control, &request);
    }
}

void wh_mcs_process_ask(wh_mcs_process_t *control, int64_t number, const char *line) {
    const waferhand_request message = {.seq = number, .command_line = wh_link_borrowed(line)};
    take_request(control, &message);
}

/* The sender learns of it if the request's number can be read. */
static void drop(wh_mcs_process_t *control, const void *data, size_t size) {
    const int64_t seq = wh_link_request_number(data, size);
    if (seq != 0) {
        turn_away(
            control, seq, "", WH_STATUS_BAD_ARGUMENT,
            "a datagram of %zu bytes is no whole request (expected a line without a byte 0 but its last)",
            size);
    }
    if (control->requests.garbage++ == 0) {
        wh_node_warn(control->node,
                     WH_CHANNEL_REQUEST ": a datagram of %zu bytes is no request and was dropped; "
                                        "others will be dropped without a word here",
                     size);
    }
}

void wh_mcs_process_on_request(void *user, const void *data, size_t size) {
    wh_mcs_process_t *control = user;
    waferhand_request message;
    if (!wh_link_decode_request(data, size, &message)) {
        drop(control, data, size);
        return;
    }
    /* An answer to number 0 would look like a message without a request. */
    if (message.seq != 0) {
        take_request(control, &message);
    }
    (void)waferhand_request_decode_cleanup(&message);
}

/* An earlier RESET may have begun another run since the request came. */
bool wh_mcs_process_next_request(wh_mcs_process_t *control, char line[WH_LINK_LINE]) {
    while (take_waiting(control)) {
        if (!turn_away_misdirected(control, &control->requests.executing, control->requests.executing.line)) {
            snprintf(line, WH_LINK_LINE, "%s", control->requests.executing.line);
            return true;
        }
        control->requests.executing.seq = 0;
    }
    return false;
}

void wh_mcs_process_answer(wh_mcs_process_t *control, wh_status_t error, const char *text) {
    const wh_mcs_process_request_t executed = control->requests.executing;
    control->requests.executing.seq = 0;
    remember(control, &executed, error, text);
}

void wh_mcs_process_stop_waiting(wh_mcs_process_t *control) {
    (void)wh_node_drain(control->node, MESSAGES_AT_ONCE);
    wh_mcs_process_clear(control);
}
