#include "protocol_client.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../text/output.h"
#include "outputs.h"
#include "protocol_client_internal.h"

#define SETTLE_US 1000000
#define TICK_US 1000000
/* The first wait before a command is sent again, and the shortest and longest later wait. */
#define FIRST_RESEND_US 1200
#define RESEND_LEAST_US INT64_C(300)
#define RESEND_MOST_US 50000
/* A command is sent again this number of times at the first pace. After that nobody seems to be there, and
 * the pace slows down. */
#define RESENDS_AT_FIRST_PACE 20
/* The longest single wait; between waits the client looks for silence and for a stop. */
#define WAIT_MOST_US 50000
/* The interval at which it tells that it still waits. */
#define WAITS_US 2000
/* After a stop it waits this long for the last answer, because the simulator has stepped that slice. */
#define STOP_GRACE_US 100000
/* A simulator that was started again may ask for its state several times; this is told once in this
 * time. */
#define RESTORE_SAID_US 1000000

static bool is_stopped(const wh_protocol_client_t *client) {
    return client->options.stop && *client->options.stop != 0;
}

/* ------------------------------------------------------------------------------------------------ sending */

void wh_protocol_client_publish(wh_node_t *node, const waferhand_command *command) {
    uint8_t encoded[4096];
    const int size = waferhand_command_encode(encoded, 0, (int)sizeof encoded, command);
    if (size > 0) {
        wh_link_seal(encoded, (size_t)size);
        (void)wh_node_publish(node, WH_CHANNEL_COMMAND, encoded, (size_t)size);
    }
}

/* Sends the last command. The simulator owes an answer from the first unanswered command on. */
static void send_command(wh_protocol_client_t *client) {
    if (client->silence.asked_us == 0) {
        client->silence.asked_us = wh_node_clock_us();
    }
    wh_protocol_client_publish(client->node, &client->command);
}

static void send_again(wh_protocol_client_t *client) {
    ++client->counters.repeated;
    send_command(client);
}

/* Sends the last state, then the command, if a simulator that was started again has asked for it. */
static void restore_simulator(wh_protocol_client_t *client) {
    const int64_t now = wh_node_clock_us();
    const bool asked = client->restoring.is_asked;
    client->restoring.is_asked = false;
    if (!asked || !client->taken.is_there) {
        return;
    }
    if (client->restoring.most > 0 && client->restoring.count++ == client->restoring.most) {
        client->refusal = WH_STATUS_NOT_RESTORED;
        return;
    }
    client->counters.restored += client->restoring.most > 0 ? 0 : 1; /* we asked for it, so it is no news */
    if (client->restoring.most == 0 && !client->senders.shared &&
        (client->restoring.told_us == 0 || now - client->restoring.told_us > RESTORE_SAID_US)) {
        client->restoring.told_us = now;
        wh_node_warn(client->node, "the simulator was started anew: it gets the state of slice %" PRId64,
                     client->taken.state.seq);
    }
    (void)wh_node_publish(client->node, WH_CHANNEL_RESTORE, client->restoring.bytes, client->restoring.size);
    send_again(client);
}

/* ------------------------------------------------------------------------------------------------ waiting */

/* The time since which the simulator has owed an answer. */
static int64_t owed_us(const wh_protocol_client_t *client) {
    return client->silence.asked_us == 0 ? 0 : wh_node_clock_us() - client->silence.asked_us;
}

/* Reports a silent simulator, once. */
static void notice_silence(wh_protocol_client_t *client) {
    if (client->silence.is_told || owed_us(client) <= WH_CLIENT_SILENCE_US) {
        return;
    }
    client->silence.is_told = true;
    ++client->counters.silences;
    if (client->taken.is_there) {
        wh_node_warn(client->node,
                     "no answer from the simulator: holding at slice %" PRId64 " until it returns",
                     client->command.seq);
    } else {
        wh_node_warn(client->node,
                     "no answer from the simulator: waiting until there is one (waferhand sim %s starts it)",
                     client->layout->path);
    }
}

static int64_t clamp(int64_t value, int64_t low, int64_t high) {
    if (value < low) {
        return low;
    }
    return value > high ? high : value;
}

/* The time at which to send an unanswered command again. */
typedef struct {
    int64_t pause, due; /* us */
    uint64_t before;    /* times that a command was sent again before this wait */
} resend_t;

static void resend_when_due(wh_protocol_client_t *client, resend_t *resend) {
    if (client->answered || wh_node_clock_us() < resend->due) {
        return;
    }
    send_again(client);
    if (client->counters.repeated - resend->before > RESENDS_AT_FIRST_PACE) {
        resend->pause = clamp(2 * resend->pause, RESEND_LEAST_US, RESEND_MOST_US);
    }
    resend->due = wh_node_clock_us() + resend->pause;
}

/* The node sees a signal only while it waits. */
static bool is_interrupted(const wh_protocol_client_t *client) {
    return client->node->interrupted || (client->options.interrupted && client->options.interrupted());
}

/* Returns WH_OK while an answer may come. Any signal ends a wait for a silent simulator; a program's own
 * handler is enough. `stopped_us` is the time when a stop was first seen, 0 before. */
static wh_status_t why_give_up(wh_protocol_client_t *client, int64_t *stopped_us) {
    const int64_t now = wh_node_clock_us();
    if (client->options.timeout_us > 0 && owed_us(client) > client->options.timeout_us) {
        client->silence.timed_out = true;
        return WH_STATUS_NO_ANSWER;
    }
    if (is_stopped(client) && *stopped_us == 0) {
        *stopped_us = now;
    }
    const bool waited = *stopped_us != 0 && (client->silence.is_told || now - *stopped_us > STOP_GRACE_US);
    return waited || (client->silence.is_told && is_interrupted(client)) ? WH_STATUS_STOPPED : WH_OK;
}

static int64_t longest_wait(const wh_protocol_client_t *client) {
    return client->options.waits ? WAITS_US : WAIT_MOST_US;
}

static void tell_wait(const wh_protocol_client_t *client, int64_t *told_us) {
    const int64_t now = wh_node_clock_us();
    if (client->options.waits && !client->answered && now - *told_us >= WAITS_US) {
        *told_us = now;
        client->options.waits(client->options.user);
    }
}

/* Waits for the answer to the last command, and sends it again and again. */
static wh_status_t await_answer(wh_protocol_client_t *client) {
    const int64_t begin = wh_node_clock_us();
    int64_t stopped_us = 0;
    int64_t told_us = begin;
    resend_t resend = {client->resend_us, begin + client->resend_us, client->counters.repeated};
    while (!client->answered && client->refusal == WH_OK) {
        const wh_status_t why = why_give_up(client, &stopped_us);
        if (why != WH_OK) {
            return why;
        }
        if (wh_node_wait(client->node, clamp(resend.due - wh_node_clock_us(), 0, longest_wait(client))) < 0) {
            return WH_STATUS_NO_NETWORK;
        }
        tell_wait(client, &told_us);
        restore_simulator(client);
        resend_when_due(client, &resend);
        notice_silence(client);
    }
    if (client->counters.repeated == resend.before) {
        client->resend_us = clamp(4 * (wh_node_clock_us() - begin), RESEND_LEAST_US, RESEND_MOST_US);
    }
    return client->refusal;
}

static bool is_silent_for_long(const wh_protocol_client_t *client) {
    const int64_t timeout = client->options.timeout_us;
    return owed_us(client) > (timeout > 0 && timeout < WH_CLIENT_SILENCE_US ? timeout : WH_CLIENT_SILENCE_US);
}

/* In a free run, waits for the last slice's state. After a long wait the slices are due from that time
 * on. */
static wh_status_t hold(wh_protocol_client_t *client) {
    const int64_t begin = wh_node_clock_us();
    const wh_status_t status = await_answer(client);
    if (wh_node_clock_us() - begin > WH_CLIENT_SILENCE_US) {
        client->start_us = 0;
    }
    return status;
}

/* Returns false if there is no network any more. */
static bool wait_until_due(wh_protocol_client_t *client) {
    const double period_us = (double)client->layout->slice_us / client->options.rate;
    if (client->start_us == 0) {
        client->start_us = wh_node_clock_us() - (int64_t)((double)(client->command.seq - 1) * period_us);
    }
    const int64_t due = client->start_us + (int64_t)((double)client->command.seq * period_us);
    client->counters.late += wh_node_clock_us() > due ? 1 : 0;
    for (int64_t now = wh_node_clock_us(); now < due && !is_stopped(client); now = wh_node_clock_us()) {
        if (wh_node_wait(client->node, clamp(due - now, 0, WAIT_MOST_US)) < 0) {
            return false;
        }
    }
    (void)wh_node_drain(client->node, 64);
    return true;
}

/* In a free run, waits until the next slice is due. It waits longer if the simulator has fallen silent or
 * its state is awaited. */
static wh_status_t await_due_time(wh_protocol_client_t *client) {
    if (!wait_until_due(client)) {
        return WH_STATUS_NO_NETWORK;
    }
    if (client->refusal != WH_OK || is_stopped(client)) {
        return client->refusal != WH_OK ? client->refusal : WH_STATUS_STOPPED;
    }
    return client->restoring.is_asked || client->awaited || is_silent_for_long(client) ? hold(client) : WH_OK;
}

/* ------------------------------------------------------------------------------------ the slice interface */

/* It runs before the command is sent, so that a simulator that reads the file has the valves in time. */
static void write_outputs(wh_protocol_client_t *client) {
    const size_t count = (size_t)client->command.gripper_count;
    if (!client->options.outputs ||
        memcmp(client->written, client->command.valve, count * sizeof(int32_t)) == 0) {
        return;
    }
    const char *path = client->options.outputs;
    const int problem =
        wh_output_is_kept(path) ? EEXIST : wh_outputs_write(path, client->command.valve, count);
    if (problem == 0) {
        memcpy(client->written, client->command.valve, count * sizeof(int32_t));
    } else if (client->counters.unwritten++ == 0) {
        wh_node_warn(client->node, "--outputs %s: %s (expected a file that can be written)", path,
                     problem == EEXIST   ? "this is an input or another output"
                     : problem == EINVAL ? "it is no regular file"
                                         : strerror(problem));
    }
}

/* Before the first answer the caller's state stays at its initial value. */
static void hand_over(wh_protocol_client_t *client, wh_state_t *state, wh_status_t status) {
    if (client->taken.is_there) {
        *state = client->taken.state;
    }
    state->events = client->heard.events;
    state->event_count = client->heard.count;
    client->heard.delivered = client->heard.count;
    state->has_lost_events = client->heard.has_lost;
    client->heard.has_lost = false;
    state->status = status;
}

wh_status_t wh_protocol_client_resume(wh_protocol_client_t *client) {
    if (!client->pending || client->answered) {
        return WH_OK;
    }
    if (is_stopped(client)) {
        return WH_STATUS_STOPPED;
    }
    if (client->silence.timed_out) {
        client->silence.asked_us = 0; /* it may take its full time again */
    }
    client->node->interrupted = false;
    client->refusal = WH_OK;
    const wh_status_t status = hold(client);
    client->pending = !client->answered && client->refusal == WH_OK;
    return status;
}

void wh_protocol_client_await(wh_protocol_client_t *client) {
    client->awaited = true;
}

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    wh_protocol_client_t *client = (wh_protocol_client_t *)link;
    const bool free_running = wh_protocol_client_is_free(client);
    client->node->interrupted = false;
    /* Events that came with a late state, after the last exchange, remain to be handed over. */
    client->heard.count -= client->heard.delivered;
    memmove(client->heard.events, client->heard.events + client->heard.delivered,
            client->heard.count * sizeof *client->heard.events);
    client->heard.delivered = 0;
    if (is_stopped(client)) {
        hand_over(client, state, WH_STATUS_STOPPED);
        return WH_STATUS_STOPPED;
    }
    client->refusal = WH_OK;
    client->silence.asked_us =
        client->silence.timed_out ? 0 : client->silence.asked_us; /* it may take its full time again */
    wh_link_command_to_message(command, &client->identity, !free_running, &client->command);
    client->answered = false;
    client->restoring.is_asked = false;
    wh_protocol_client_note_sent(client);
    write_outputs(client);
    ++client->counters.sent;
    send_command(client);
    const int64_t now = wh_node_clock_us();
    if (client->options.tick && now - client->last_tick_us >= TICK_US) {
        client->last_tick_us = now;
        client->options.tick(client->options.user);
    }
    const wh_status_t status = free_running ? await_due_time(client) : await_answer(client);
    client->pending = !client->answered && client->refusal == WH_OK;
    client->awaited = false;
    hand_over(client, state, status);
    return status;
}

int64_t wh_protocol_client_reached(const wh_protocol_client_t *client) {
    const int64_t answered = client->taken.is_there ? client->taken.state.seq : 0;
    return client->refusal == WH_OK ? client->command.seq : answered;
}

/* The slice whose state has not come yet; 0: none. */
static int64_t owed_slice(const wh_protocol_client_t *client) {
    const bool owed = client->refusal == WH_OK && client->taken.state.seq != client->command.seq;
    return owed ? client->command.seq : 0;
}

/* It waits a little, because in a free run the last states may still be on their way. */
static uint64_t last_hash(wh_link_t *link) {
    wh_protocol_client_t *client = (wh_protocol_client_t *)link;
    const bool settled = wh_protocol_client_settle(client, is_stopped(client) ? STOP_GRACE_US : SETTLE_US);
    if (!settled && client->taken.is_there) {
        wh_node_warn(client->node,
                     "the state of slice %" PRId64 " did not come: the hash is of slice %" PRId64,
                     client->command.seq, client->taken.state.seq);
    } else if (!settled) {
        wh_node_warn(client->node, "no state has come: the run has no hash");
    }
    return client->taken.hash;
}

/* Slices at the end that no state tells of count as missed, because nobody has seen that they arrived. */
static int64_t missed_slices(wh_link_t *link) {
    const wh_protocol_client_t *client = (wh_protocol_client_t *)link;
    return client->taken.missed +
           (client->options.rate > 0 ? client->command.seq - client->taken.state.seq : 0);
}

void wh_protocol_client_heartbeat(wh_protocol_client_t *client) {
    if (client->command.seq > 0) {
        send_again(client);
    }
    (void)wh_node_drain(client->node, 64);
    restore_simulator(client);
    notice_silence(client);
}

bool wh_protocol_client_settle(wh_protocol_client_t *client, int64_t timeout_us) {
    const int64_t end = wh_node_clock_us() + timeout_us;
    (void)wh_node_drain(client->node, 64);
    while (owed_slice(client) != 0) {
        if (wh_node_clock_us() > end || wh_node_wait(client->node, 1000) < 0) {
            return false;
        }
    }
    return true;
}

int64_t wh_protocol_client_draw_run(void) {
    int64_t run = 0;
    while (run == 0) {
        arc4random_buf(&run, sizeof run);
        run &= INT64_MAX;
    }
    return run;
}

void wh_protocol_client_begin(wh_protocol_client_t *client, const wh_layout_t *layout) {
    wh_node_t *const node = client->node;
    const wh_protocol_client_options_t options = client->options;
    const wh_protocol_client_counters_t counters = client->counters;
    const uint64_t own = client->own;
    memset(client, 0, sizeof *client);
    client->own = own;
    client->link.exchange = exchange;
    client->link.hash = last_hash;
    client->link.missed = missed_slices;
    client->node = node;
    client->layout = layout;
    client->options = options;
    client->counters = counters;
    client->identity.run = wh_protocol_client_draw_run();
    client->identity.layout_hash = wh_layout_hash(layout);
    client->resend_us = FIRST_RESEND_US;
    memset(client->written, 0xff, sizeof client->written);
}

void wh_protocol_client_end(wh_protocol_client_t *client) {
    client->layout = NULL;
}

static void on_state(void *user, const void *data, size_t size) {
    wh_protocol_client_hear(user, data, size);
}

bool wh_protocol_client_open(wh_protocol_client_t *client, wh_node_t *node, const wh_layout_t *layout,
                             const wh_protocol_client_options_t *options) {
    client->node = node;
    client->options = *options;
    memset(&client->counters, 0, sizeof client->counters);
    client->own = 0;
    wh_protocol_client_begin(client, layout);
    return wh_node_subscribe(node, WH_CHANNEL_STATE, on_state, client) &&
           wh_node_overhear(node, WH_CHANNEL_COMMAND, wh_protocol_client_overhear, client);
}
