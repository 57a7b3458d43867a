#include "broadcast.h"

#include <string.h>

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    wh_broadcast_t *broadcast = (wh_broadcast_t *)link;
    uint8_t encoded[2048];
    waferhand_command message;
    wh_link_command_to_message(command, &broadcast->identity, true, &message);
    const int size = waferhand_command_encode(encoded, 0, (int)sizeof encoded, &message);
    if (size > 0) {
        wh_link_seal(encoded, (size_t)size);
        (void)wh_node_publish(broadcast->node, WH_CHANNEL_COMMAND, encoded, (size_t)size);
    }
    wh_mcs_process_set_slice(&broadcast->control, &broadcast->identity, command);
    return wh_sim_process_step(&broadcast->simulation, &message, state);
}

static uint64_t last_hash(wh_link_t *link) {
    return wh_protocol_server_hash(&((wh_broadcast_t *)link)->simulation.server);
}

static int64_t missed_slices(wh_link_t *link) {
    (void)link;
    return 0;
}

static wh_link_t *connect_simulation(void *user, wh_mcs_t *mcs) {
    wh_broadcast_t *broadcast = user;
    const wh_status_t status =
        wh_sim_process_open(&broadcast->simulation, NULL, mcs->layout, broadcast->control.options.say,
                            broadcast->control.options.user);
    if (status != WH_OK) {
        return NULL;
    }
    wh_sim_process_publish_to(&broadcast->simulation, broadcast->node);
    broadcast->identity.run = wh_protocol_client_draw_run();
    broadcast->identity.layout_hash = broadcast->simulation.server.identity.layout_hash;
    broadcast->connected = true;
    return &broadcast->link;
}

static void watch(void *user, const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended) {
    wh_mcs_process_t *control = &((wh_broadcast_t *)user)->control;
    wh_mcs_process_partners(control).watch(control, mcs, command, ended);
}

bool wh_broadcast_open(wh_broadcast_t *broadcast, wh_node_t *node, void (*say)(void *user, const char *text),
                       void *user) {
    const wh_mcs_process_options_t options = {.say = say, .user = user};
    memset(broadcast, 0, sizeof *broadcast);
    broadcast->link.exchange = exchange;
    broadcast->link.hash = last_hash;
    broadcast->link.missed = missed_slices;
    broadcast->node = node;
    return wh_mcs_process_open(&broadcast->control, node, &options);
}

wh_mcs_partners_t wh_broadcast_partners(wh_broadcast_t *broadcast) {
    const wh_mcs_partners_t partners = {.connect = connect_simulation, .watch = watch, .user = broadcast};
    return partners;
}

void wh_broadcast_close(wh_broadcast_t *broadcast) {
    wh_mcs_process_finish(&broadcast->control);
    if (broadcast->connected) {
        wh_sim_process_close(&broadcast->simulation);
    }
}
