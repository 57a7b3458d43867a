#include "protocol_client.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>

#include "outputs.h"
#include "protocol_client_internal.h"

#define SETTLE_US 1000000
#define TICK_US 1000000

void wh_protocol_client_say(const wh_protocol_client_t *client, const char *format, ...) {
    char text[200];
    va_list arguments;
    if (!client->options.say) {
        return;
    }
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    client->options.say(client->options.user, text);
}

bool wh_protocol_client_is_stopped(const wh_protocol_client_t *client) {
    return client->options.stop && *client->options.stop != 0;
}

bool wh_protocol_client_is_free_running(const wh_protocol_client_t *client) {
    return client->options.rate > 0 && client->has_state;
}

/* The file is there before the command is sent: a simulator that reads it has the valves in time. */
static void write_outputs(wh_protocol_client_t *client) {
    const size_t count = (size_t)client->command.gripper_count;
    if (!client->options.outputs ||
        memcmp(client->written, client->command.valve, count * sizeof(int32_t)) == 0) {
        return;
    }
    const int problem = wh_outputs_write(client->options.outputs, client->command.valve, count);
    if (problem == 0) {
        memcpy(client->written, client->command.valve, count * sizeof(int32_t));
    } else if (client->counters.unwritten++ == 0) {
        wh_protocol_client_say(client, "%s: %s (expected a file that can be written)",
                               client->options.outputs, strerror(problem));
    }
}

/* What came since the last exchange, while somebody waited for a late state, is still to be handed over. */
static void forget_delivered_events(wh_protocol_client_t *client) {
    const size_t left = client->event_count - client->events_delivered;
    memmove(client->events, client->events + client->events_delivered, left * sizeof *client->events);
    client->event_count = left;
    client->events_delivered = 0;
}

/* Before the first answer the caller's own view of the beginning stays. */
static void hand_over(wh_protocol_client_t *client, wh_state_t *state, wh_status_t status) {
    if (client->has_state) {
        *state = client->state;
    }
    state->events = client->events;
    state->event_count = client->event_count;
    client->events_delivered = client->event_count;
    state->status = status;
}

/* A command that was given up may or may not have arrived: it is seen through before the next one. */
static wh_status_t see_through(wh_protocol_client_t *client) {
    if (!client->pending) {
        return WH_OK;
    }
    wh_protocol_client_send_again(client);
    const wh_status_t status = wh_protocol_client_await_answer(client);
    client->pending = !client->answered;
    return status;
}

static void tick(wh_protocol_client_t *client) {
    const int64_t now = wh_node_clock_us();
    if (client->options.tick && now - client->last_tick_us >= TICK_US) {
        client->last_tick_us = now;
        client->options.tick(client->options.tick_user);
    }
}

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    wh_protocol_client_t *client = (wh_protocol_client_t *)link;
    const bool free_running = wh_protocol_client_is_free_running(client);
    client->node->interrupted = false;
    client->refusal = WH_OK;
    const wh_status_t before = see_through(client);
    if (before != WH_OK) {
        hand_over(client, state, before);
        return before;
    }
    wh_link_command_to_message(command, &client->identity, !free_running, &client->command);
    client->answered = false;
    client->asked_for_state = false;
    client->refusal = WH_OK;
    forget_delivered_events(client);
    write_outputs(client);
    ++client->counters.sent;
    wh_protocol_client_send(client);
    tick(client);
    const wh_status_t status =
        free_running ? wh_protocol_client_await_due_time(client) : wh_protocol_client_await_answer(client);
    client->pending = !free_running && !client->answered && client->refusal == WH_OK;
    hand_over(client, state, status);
    return status;
}

/* Free-running, the last states may be on their way still. */
static uint64_t last_hash(wh_link_t *link) {
    wh_protocol_client_t *client = (wh_protocol_client_t *)link;
    if (!wh_protocol_client_settle(client, SETTLE_US)) {
        wh_protocol_client_say(client,
                               "the state of the last slice did not come: the hash is of slice %" PRId64,
                               client->state.seq);
    }
    return client->hash;
}

static int64_t missed_slices(wh_link_t *link) {
    return ((wh_protocol_client_t *)link)->missed;
}

void wh_protocol_client_heartbeat(wh_protocol_client_t *client) {
    if (client->counters.sent > 0) {
        wh_protocol_client_send_again(client);
    }
    (void)wh_node_drain(client->node, 64);
    wh_protocol_client_restore(client);
    wh_protocol_client_notice_silence(client, client->last_heard_us);
}

bool wh_protocol_client_settle(wh_protocol_client_t *client, int64_t timeout_us) {
    const int64_t end = wh_node_clock_us() + timeout_us;
    while (client->counters.sent > 0 && client->state.seq != client->command.seq &&
           !wh_protocol_client_is_stopped(client)) {
        if (wh_node_clock_us() > end || wh_node_wait(client->node, 1000) < 0) {
            return false;
        }
    }
    return true;
}

int64_t wh_protocol_client_draw_run(void) {
    uint64_t bits = 0;
    while (bits == 0) {
        if (getrandom(&bits, sizeof bits, 0) != (ssize_t)sizeof bits) {
            bits = (uint64_t)wh_node_wall_us();
        }
        bits >>= 1;
    }
    return (int64_t)bits;
}

bool wh_protocol_client_open(wh_protocol_client_t *client, wh_node_t *node,
                             const wh_protocol_client_options_t *options) {
    memset(client, 0, sizeof *client);
    client->link.exchange = exchange;
    client->link.hash = last_hash;
    client->link.missed = missed_slices;
    client->node = node;
    client->options = *options;
    client->identity.run = wh_protocol_client_draw_run();
    client->identity.layout_hash = wh_layout_hash(options->layout);
    client->resend_us = WH_CLIENT_FIRST_RESEND_US;
    memset(client->written, 0xff, sizeof client->written);
    return wh_node_subscribe(node, WH_CHANNEL_STATE, wh_protocol_client_on_state, client);
}
