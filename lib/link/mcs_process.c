#include "mcs_process_internal.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../mcs/session.h"
#include "../text/array.h"
#include "../text/style.h"
#include "../text/utf8.h"
#include "outputs.h"
#include "station_told.h"

#define HEARTBEAT_US 200000
/* The end of a free-running command waits this long for the state of its last slice. */
#define COMMAND_SETTLE_US 100000

/* ------------------------------------------------------------------------------------------------ telling */

void wh_mcs_process_publish(wh_mcs_process_t *control, const waferhand_mcs *message) {
    const int size = waferhand_mcs_encode(control->encoded, 0, (int)sizeof control->encoded, message);
    if (size > 0) {
        (void)wh_node_publish(control->node, WH_CHANNEL_MCS, control->encoded, (size_t)size);
    }
    const bool is_answer = message->request != 0 &&
                           (message->phase == WH_LINK_PHASE_DONE || message->phase == WH_LINK_PHASE_FAILED);
    if (is_answer && control->owner.answered) {
        control->owner.answered(control->owner.user, message);
    }
}

/* A message with the present state. `request` is the request that it answers or continues; 0: none. */
waferhand_mcs wh_mcs_process_message(wh_mcs_process_t *control, int64_t request, int32_t phase,
                                     wh_status_t error, const char *command, const char *text) {
    if (control->connected) {
        control->utime = control->client.command.utime;
        control->seq = control->client.command.seq;
        control->identity = control->client.identity;
    }
    return (waferhand_mcs){.utime = control->utime,
                           .seq = control->seq,
                           .run = control->identity.run,
                           .layout_hash = (int64_t)control->identity.layout_hash,
                           .phase = phase,
                           .request = request,
                           .error = (int32_t)error,
                           .command = wh_link_borrowed(command),
                           .text = wh_link_borrowed(text)};
}

void wh_mcs_process_tell(wh_mcs_process_t *control, int64_t request, int32_t phase, int line,
                         wh_status_t error, const char *command, const char *text) {
    waferhand_mcs message = wh_mcs_process_message(control, request, phase, error, command, text);
    message.line = line;
    wh_mcs_process_publish(control, &message);
}

/* The longest text of a script that is told in full, with its terminator. */
#define TEXT_BYTES 4000

/* Tells a text of the script; it may have any length. `number` counts the run's texts from 1. */
static void tell_text(wh_mcs_process_t *control, int32_t phase, int line, int64_t number, const char *text) {
    char cut[TEXT_BYTES];
    const size_t length = strlen(text);
    if (length >= sizeof cut) {
        snprintf(cut, sizeof cut, "%.*s... (%zu bytes, cut)", TEXT_BYTES - 60, text, length);
    }
    wh_mcs_process_tell(control, 0, phase, line, (wh_status_t)number, "", length < sizeof cut ? text : cut);
}

static void tell_expectation(wh_mcs_process_t *control, const wh_expectation_record_t *expectation) {
    ++control->outcome.expectations;
    control->outcome.met += expectation->ok ? 1 : 0;
    tell_text(control, expectation->ok ? WH_LINK_PHASE_MET : WH_LINK_PHASE_UNMET, expectation->line,
              control->outcome.expectations, expectation->text);
}

void wh_mcs_process_catch_up(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    const wh_record_t *record = wh_mcs_record(mcs);
    for (size_t i = (size_t)control->outcome.expectations; i < record->expectation_count; ++i) {
        tell_expectation(control, &record->expectations[i]);
    }
}

/* Before a run begins expectations are kept, because nobody could tell which run they belong to. */
static void tell_expected(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    if (control->identity.run != 0 || control->connected) {
        wh_mcs_process_catch_up(control, mcs);
    }
}

static void tell_cycle(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    const wh_record_t *record = wh_mcs_record(mcs);
    const wh_cycle_record_t *begun = &record->cycles[record->cycle_count - 1];
    ++control->outcome.cycles;
    tell_text(control, WH_LINK_PHASE_CYCLE, begun->line, control->outcome.cycles, begun->name);
}

/* The own doing of a station is told with its slice. */
static void tell_station(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    char text[WH_STATION_TOLD_BYTES];
    const wh_record_t *record = wh_mcs_record(mcs);
    const wh_station_event_record_t *event = &record->station_events[record->station_event_count - 1];
    ++control->stations_told;
    wh_station_told_write(event, text);
    wh_mcs_process_tell(control, 0, WH_LINK_PHASE_STATION, 0, (wh_status_t)control->stations_told,
                        wh_mcs_layout(mcs)->stations[event->station].name, text);
}

static void judge_run(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    const wh_record_t *record = wh_mcs_record(mcs);
    const bool is_written = control->client.counters.unwritten == 0;
    const char *disturbance = control->client.disturbance;
    control->outcome.verdict =
        record->ok && is_written && disturbance[0] == '\0' ? WH_OUTCOME_PASSED : WH_OUTCOME_FAILED;
    if (record->failure || is_written) {
        snprintf(control->reason, sizeof control->reason, "%s",
                 record->failure ? record->failure : disturbance);
    } else {
        snprintf(control->reason, sizeof control->reason, WH_OUTPUTS_UNWRITTEN, control->options.outputs);
    }
}

/* Tells that the run is over; a session's next run has its own counts. */
void wh_mcs_process_tell_over(wh_mcs_process_t *control) {
    char text[WH_OUTCOME_BYTES + sizeof control->reason];
    if (control->outcome.verdict == WH_OUTCOME_UNTOLD) {
        control->outcome.verdict = WH_OUTCOME_ENDED;
    }
    wh_outcome_write(&control->outcome, control->reason, text, sizeof text);
    wh_mcs_process_tell(control, 0, WH_LINK_PHASE_OVER, 0, WH_OK, "", text);
    memset(&control->outcome, 0, sizeof control->outcome);
    control->stations_told = 0;
    control->reason[0] = '\0';
}

/* ----------------------------------------------------------------------------------------------- commands */

/* The command of this task, or null. */
static wh_mcs_process_running_t *find_running(wh_mcs_process_t *control, int32_t task) {
    wh_mcs_process_running_t *found = NULL;
    for (size_t i = 0; i < control->running_count; ++i) {
        found = control->running[i].task == task ? &control->running[i] : found;
    }
    return found;
}

static void forget_running(wh_mcs_process_t *control, int32_t task) {
    wh_mcs_process_running_t *gone = find_running(control, task);
    if (gone) {
        --control->running_count;
        const size_t behind = control->running_count - (size_t)(gone - control->running);
        memmove(gone, gone + 1, behind * sizeof *gone);
    }
}

/* The prompt executes requests, a task does not. */
static void tell_running(wh_mcs_process_t *control, const wh_mcs_process_running_t *running, int32_t phase,
                         const char *command, const char *text) {
    const bool goes_on = phase == WH_LINK_PHASE_BEGINS || phase == WH_LINK_PHASE_GOES_ON;
    const int64_t request = goes_on && running->task == 0 ? control->requests.executing.seq : 0;
    waferhand_mcs message = wh_mcs_process_message(control, request, phase, WH_OK, command, text);
    message.task = running->task;
    message.line = running->line;
    message.axes = (int32_t)running->axes;
    message.grippers = (int32_t)running->grippers;
    wh_mcs_process_publish(control, &message);
}

static void tell_begin(wh_mcs_process_t *control, const wh_command_record_t *command) {
    forget_running(control, command->task);
    wh_mcs_process_running_t *running = &control->running[control->running_count++];
    *running = (wh_mcs_process_running_t){.task = command->task, .line = command->line};
    wh_utf8_clip(running->text, sizeof running->text, command->text);
    ++control->outcome.commands;
    tell_running(control, running, WH_LINK_PHASE_BEGINS, command->text, "");
}

/* This is not the request's answer; that carries the result, and wh_mcs_process_answer sends it. */
static void tell_end(wh_mcs_process_t *control, const wh_command_record_t *command) {
    const int32_t phase = command->error == WH_OK ? WH_LINK_PHASE_DONE : WH_LINK_PHASE_FAILED;
    waferhand_mcs message = wh_mcs_process_message(control, 0, phase, command->error, command->text,
                                                   command->message ? command->message : "");
    message.task = command->task;
    message.line = command->line;
    wh_mcs_process_publish(control, &message);
}

static void tell_ended(wh_mcs_process_t *control, const wh_command_record_t *command) {
    forget_running(control, command->task);
    control->ended_with = command->error;
    if (control->connected) {
        (void)wh_protocol_client_settle(&control->client, COMMAND_SETTLE_US);
    }
    tell_end(control, command);
}

static void tell_news(void *user, const wh_mcs_t *mcs, wh_mcs_news_t news,
                      const wh_command_record_t *command) {
    wh_mcs_process_t *control = user;
    switch ((int)news) {
    case WH_MCS_COMMAND_BEGINS:
        tell_begin(control, command);
        break;
    case WH_MCS_COMMAND_ENDED:
        tell_ended(control, command);
        break;
    case WH_MCS_EXPECTED:
        tell_expected(control, mcs);
        break;
    case WH_MCS_CYCLE_BEGINS:
        tell_cycle(control, mcs);
        break;
    case WH_MCS_STATION_TOLD:
        tell_station(control, mcs);
        break;
    case WH_MCS_EDGE_SCANNED:
        wh_mcs_process_tell_edge(control, mcs);
        break;
    case WH_MCS_CENTRED:
        wh_mcs_process_tell_centring(control, mcs);
        break;
    case WH_MCS_FINISHED:
        if (wh_mcs_is_script(mcs)) {
            judge_run(control, mcs);
        }
        break;
    }
}

static void turn(void *user, const wh_mcs_t *mcs, const char *what) {
    wh_mcs_process_t *control = user;
    const wh_lane_t *lane = wh_mcs_current_lane(mcs);
    wh_mcs_process_running_t none = {.task = lane->number};
    wh_mcs_process_running_t *running = find_running(control, lane->number);
    char names[WH_MCS_MECHANISMS_BYTES];
    wh_mcs_name_mechanisms(mcs, lane->axes, names);
    running = running ? running : &none;
    running->axes = what ? 0 : lane->axes;
    running->grippers = what ? 0 : lane->grippers;
    tell_running(control, running, what ? WH_LINK_PHASE_WAITS : WH_LINK_PHASE_ON, running->text,
                 what ? what : names);
}

/* ------------------------------------------------------------------------------------------------ the run */

static void tell_progress(void *user) {
    wh_mcs_process_t *control = user;
    for (size_t i = 0; i < control->running_count; ++i) {
        const wh_mcs_process_running_t *running = &control->running[i];
        tell_running(control, running, WH_LINK_PHASE_GOES_ON, running->text, "");
    }
}

static void tell_wait(void *user) {
    const wh_mcs_process_t *control = user;
    control->owner.waits(control->owner.user);
}

/* A second call is for another run of a session: the run before is over. */
static wh_link_t *connect_client(void *user, wh_mcs_t *mcs) {
    wh_mcs_process_t *control = user;
    const wh_layout_t *layout = wh_mcs_layout(mcs);
    if (layout->wafer_count > WH_LINK_WAFERS) {
        wh_node_warn(control->node, "%s: %zu wafers (expected at most %d, for messages carry no more)",
                     layout->path, layout->wafer_count, WH_LINK_WAFERS);
        return NULL;
    }
    control->mcs = mcs;
    control->options.waits = control->owner.waits ? tell_wait : NULL;
    if (control->connected) {
        wh_mcs_process_tell_over(control);
        wh_protocol_client_begin(&control->client, layout);
        return &control->client.link;
    }
    control->connected = wh_protocol_client_open(&control->client, control->node, layout, &control->options);
    if (control->connected) {
        wh_mcs_process_catch_up(control, mcs);
    }
    return control->connected ? &control->client.link : NULL;
}

static wh_status_t resume(void *user) {
    wh_mcs_process_t *control = user;
    return wh_protocol_client_resume(&control->client);
}

static void await(void *user) {
    wh_mcs_process_t *control = user;
    wh_protocol_client_await(&control->client);
}

static int64_t reached(void *user) {
    const wh_mcs_process_t *control = user;
    return wh_protocol_client_reached(&control->client);
}

typedef char saves_fit[sizeof(waferhand_command) + WH_LINK_DATAGRAM <= WH_MCS_SAVED_BYTES ? 1 : -1];

static size_t save(void *user, uint8_t bytes[WH_MCS_SAVED_BYTES]) {
    wh_mcs_process_t *control = user;
    return wh_protocol_client_save(&control->client, bytes);
}

/* Another run begins, so the run before is over. */
static wh_status_t restore(void *user, const uint8_t bytes[], size_t size, wh_state_t *state) {
    wh_mcs_process_t *control = user;
    control->utime = control->client.command.utime;
    control->seq = control->client.command.seq;
    control->identity = control->client.identity;
    const wh_status_t status = wh_protocol_client_restore(&control->client, bytes, size, state);
    if (status == WH_OK) {
        control->connected = false; /* so that it is told of the run before */
        wh_mcs_process_tell_over(control);
        control->connected = true;
    }
    return status;
}

static bool is_heard(void *user) {
    const wh_mcs_process_t *control = user;
    return control->client.taken.is_there;
}

/* ------------------------------------------------------------------------------------------- explanations */

static const char *explain(void *user, wh_status_t status) {
    wh_mcs_process_t *control = user;
    const wh_protocol_client_t *client = &control->client;
    const uint64_t other = client->other_layout_hash;
    const bool known = control->simulator_path[0] != '\0' && control->simulator_layout == other;
    switch ((int)status) {
    case WH_STATUS_STOPPED:
        return control->owner.stops ? NULL : "by a signal";
    case WH_STATUS_OTHER_LAYOUT:
        snprintf(control->explanation, sizeof control->explanation,
                 "%s%shash %016" PRIx64 " (expected %.200s, hash %016" PRIx64 ")",
                 known ? control->simulator_path : "", known ? ", " : "", other, client->layout->path,
                 client->identity.layout_hash);
        return control->explanation;
    case WH_STATUS_NO_ANSWER:
        snprintf(control->explanation, sizeof control->explanation,
                 "none for %g s, slice %" PRId64 " waits (waferhand sim %.200s starts it; --timeout)",
                 (double)control->options.timeout_us / 1e6, control->client.command.seq,
                 control->client.layout->path);
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

/* States contain samples of an edge scan and latches of beams; a free run takes several states from one
 * exchange to the next. */
static void hear_state(void *user, const wh_state_t *state) {
    const wh_mcs_process_t *control = user;
    if (control->mcs) {
        wh_mcs_hear(control->mcs, state);
    }
}

/* All messages on our own channel are ours, unless there is another motion control. */
static void on_mcs(void *user, const void *data, size_t size) {
    wh_mcs_process_t *control = user;
    (void)data;
    (void)size;
    if (wh_senders_hear(&control->speakers, control->node->sender)) {
        wh_node_warn(control->node,
                     "two motion controls are at this URL and answer the same requests (expected "
                     "one: stop the other one, or give it another --lcm-url)");
    }
}

/* ------------------------------------------------------------------------------------ opening and closing */

bool wh_mcs_process_open(wh_mcs_process_t *control, wh_node_t *node,
                         const wh_protocol_client_options_t *options) {
    memset(control, 0, sizeof *control);
    control->node = node;
    control->options = *options;
    control->options.tick = tell_progress;
    control->options.taken = hear_state;
    control->options.user = control;
    return wh_node_subscribe(node, WH_CHANNEL_REQUEST, wh_mcs_process_on_request, control) &&
           wh_node_subscribe(node, WH_CHANNEL_CELL, on_cell, control) &&
           wh_node_overhear(node, WH_CHANNEL_MCS, on_mcs, control);
}

wh_mcs_partners_t wh_mcs_process_partners(wh_mcs_process_t *control) {
    static const wh_mcs_lossy_t lossy = {resume, await, reached, is_heard, explain};
    return (wh_mcs_partners_t){.connect = connect_client,
                               .lossy = &lossy,
                               .save = save,
                               .restore = restore,
                               .tell = tell_news,
                               .turn = turn,
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
    tell_progress(control);
    if (control->running_count == 0) {
        wh_mcs_process_tell(control, control->requests.executing.seq, WH_LINK_PHASE_IDLE, 0, WH_OK, "", "");
    }
}

void wh_mcs_process_finish(wh_mcs_process_t *control) {
    control->mcs = NULL;
    wh_protocol_client_end(&control->client);
    wh_mcs_process_stop_waiting(control);
    wh_mcs_process_tell_over(control);
}

void wh_mcs_process_close(wh_mcs_process_t *control) {
    for (size_t i = 0; i < WH_CONTROL_ANSWERED; ++i) {
        free(control->requests.answered[i].text);
        control->requests.answered[i].text = NULL;
    }
}
