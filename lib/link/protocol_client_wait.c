/* How the client waits: for an answer, for a slice's time, and for a simulator that is silent. */
#include <inttypes.h>

#include "protocol_client_internal.h"

#define RESEND_LEAST_US INT64_C(300)
#define RESEND_MOST_US 50000
/* So often a command is sent again at the first pace; then, for nobody seems to be there, less and less often. */
#define RESENDS_AT_FIRST_PACE 20
/* How long a wait may be, so that silence and a stop are noticed in time. */
#define WAIT_MOST_US 50000

void wh_protocol_client_notice_silence(wh_protocol_client_t *client, int64_t since_us) {
    const int64_t last = client->last_heard_us > since_us ? client->last_heard_us : since_us;
    if (!client->silent && wh_node_clock_us() - last > WH_CLIENT_SILENCE_US) {
        client->silent = true;
        ++client->counters.silences;
        wh_protocol_client_say(client,
                               "no answer from the simulator: holding at slice %" PRId64 " until it returns",
                               client->command.seq);
    }
}

static int64_t clamp(int64_t value, int64_t low, int64_t high) {
    if (value < low) {
        return low;
    }
    return value > high ? high : value;
}

/* When a command whose answer does not come is sent again. */
typedef struct {
    int64_t pause, due; /* us */
    uint64_t before;    /* sent again before this wait */
} resend_t;

static void resend_when_due(wh_protocol_client_t *client, resend_t *resend) {
    if (client->answered || wh_node_clock_us() < resend->due) {
        return;
    }
    wh_protocol_client_send_again(client);
    if (client->counters.repeated - resend->before > RESENDS_AT_FIRST_PACE) {
        resend->pause = clamp(2 * resend->pause, RESEND_LEAST_US, RESEND_MOST_US);
    }
    resend->due = wh_node_clock_us() + resend->pause;
}

/* Whoever has signals of his own stops a wait for a silent simulator by any of them. */
static bool is_given_up(const wh_protocol_client_t *client) {
    return wh_protocol_client_is_stopped(client) || (client->silent && client->node->interrupted);
}

wh_status_t wh_protocol_client_await_answer(wh_protocol_client_t *client) {
    const int64_t begin = wh_node_clock_us();
    resend_t resend = {client->resend_us, begin + client->resend_us, client->counters.repeated};
    while (!client->answered && client->refusal == WH_OK) {
        if (is_given_up(client)) {
            return WH_STATUS_STOPPED;
        }
        if (wh_node_wait(client->node, clamp(resend.due - wh_node_clock_us(), 0, WAIT_MOST_US)) < 0) {
            return WH_STATUS_NO_NETWORK;
        }
        wh_protocol_client_restore(client);
        resend_when_due(client, &resend);
        wh_protocol_client_notice_silence(client, begin);
    }
    if (client->counters.repeated == resend.before) {
        client->resend_us = clamp(4 * (wh_node_clock_us() - begin), RESEND_LEAST_US, RESEND_MOST_US);
    }
    return client->refusal;
}

wh_status_t wh_protocol_client_await_due_time(wh_protocol_client_t *client) {
    const double period_us = (double)client->options.layout->slice_us / client->options.rate;
    if (client->start_us == 0) {
        client->start_us = wh_node_clock_us() - (int64_t)((double)(client->command.seq - 1) * period_us);
    }
    const int64_t due = client->start_us + (int64_t)((double)client->command.seq * period_us);
    client->counters.late += wh_node_clock_us() > due ? 1 : 0;
    for (int64_t now = wh_node_clock_us(); now < due && !wh_protocol_client_is_stopped(client);
         now = wh_node_clock_us()) {
        if (wh_node_wait(client->node, clamp(due - now, 0, WAIT_MOST_US)) < 0) {
            return WH_STATUS_NO_NETWORK;
        }
    }
    (void)wh_node_drain(client->node, 64);
    if (client->asked_for_state || wh_node_clock_us() - client->last_heard_us > WH_CLIENT_SILENCE_US) {
        client->start_us = 0;
        return wh_protocol_client_await_answer(client);
    }
    return wh_protocol_client_is_stopped(client) ? WH_STATUS_STOPPED : client->refusal;
}
