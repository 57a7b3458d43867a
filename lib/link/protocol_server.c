#include "protocol_server.h"

#include <stdlib.h>
#include <string.h>

#include "../grasp/restore.h"
#include "../layout/doors.h"
#include "../sim/snapshot.h"
#include "../text/array.h"

static void start_run(wh_protocol_server_t *server, int64_t run) {
    const wh_layout_t *layout = server->layout;
    wh_grasp_storage_t storage = {.wafers = server->arrays.wafers,
                                  .wafer_count = layout->wafer_count,
                                  .grippers = server->arrays.grippers,
                                  .gripper_count = layout->machine.gripper_count,
                                  .buckets = server->buckets,
                                  .bucket_count = wh_layout_buckets(layout)};
    if (layout->wafer_count > 0) {
        memcpy(server->arrays.wafers, layout->start, layout->wafer_count * sizeof *layout->start);
    }
    (void)wh_simulator_init(&server->simulator, &layout->grasp, &storage, &layout->cell);
    (void)wh_simulator_set_physics(&server->simulator, &layout->physics);
    const wh_scanning_t scanning = wh_layout_scanning(layout);
    (void)wh_simulator_set_scanning(&server->simulator, &scanning);
    const wh_latching_t latching = wh_layout_latching(layout);
    (void)wh_simulator_set_latching(&server->simulator, &latching);
    (void)wh_layout_give_doors(layout, &server->simulator);
    server->grips.seen = server->seen;
    (void)wh_layout_give_grips(layout, &server->simulator, &server->grips);
    if (server->collision.memory) {
        wh_collision_attach(&server->collision, layout, &server->simulator, server->collision.memory);
    }
    memset(&server->state, 0, sizeof server->state);
    wh_simulator_view(&server->simulator, &server->state);
    server->identity.run = run;
    server->seq = 0;
    server->missed = 0;
    server->encoded_size = 0;
}

wh_status_t wh_protocol_server_open(wh_protocol_server_t *server, const wh_layout_t *layout) {
    if (layout->wafer_count > WH_LINK_WAFERS) {
        return WH_STATUS_BAD_CAPACITY;
    }
    memset(server, 0, sizeof *server);
    server->layout = layout;
    server->identity.layout_hash = wh_layout_hash(layout);
    if (layout->collision) {
        server->collision.memory = wh_array_new(wh_collision_bytes(layout), 1);
    }
    start_run(server, 0);
    return WH_OK;
}

void wh_protocol_server_close(wh_protocol_server_t *server) {
    free(server->collision.memory);
    server->collision.memory = NULL;
}

uint64_t wh_protocol_server_hash(const wh_protocol_server_t *server) {
    return wh_simulator_hash(&server->simulator);
}

/* ------------------------------------------------------------------------------------------------ answers */

static void encode(wh_protocol_server_t *server, const wh_state_t *state,
                   const wh_link_identity_t *identity) {
    wh_link_state_to_message(state, identity, wh_protocol_server_hash(server), server->missed, &server->room);
    const int size =
        waferhand_state_encode(server->encoded, 0, (int)sizeof server->encoded, &server->room.message);
    server->encoded_size = size > 0 ? (size_t)size : 0;
    wh_link_seal(server->encoded, server->encoded_size);
}

/* Answers a command that is not stepped, with the server's own numbers and the reason, without wafers and
 * grippers. */
static wh_protocol_server_result_t turn_away(wh_protocol_server_t *server, const waferhand_command *message,
                                             wh_status_t reason) {
    const wh_state_t nothing = {.utime = message->utime, .seq = message->seq, .status = reason};
    const wh_link_identity_t identity = {message->run, server->identity.layout_hash};
    encode(server, &nothing, &identity);
    return WH_SERVER_ANSWERED;
}

void wh_protocol_server_encode(wh_protocol_server_t *server) {
    encode(server, &server->state, &server->identity);
}

void wh_protocol_server_tell(wh_protocol_server_t *server, uint64_t hash) {
    wh_link_state_to_message(&server->state, &server->identity, hash, server->missed, &server->room);
}

/* ----------------------------------------------------------------------------------------------- commands */

static bool is_past(const wh_protocol_server_t *server, int64_t run) {
    const size_t count =
        server->past_count < WH_SERVER_PAST_RUNS ? server->past_count : (size_t)WH_SERVER_PAST_RUNS;
    for (size_t i = 0; i < count; ++i) {
        if (server->past_runs[i] == run) {
            return true;
        }
    }
    return false;
}

/* Remembers the run, so that its late commands do not begin it again. */
static void leave_run(wh_protocol_server_t *server) {
    if (server->identity.run != 0) {
        server->past_runs[server->past_count++ % WH_SERVER_PAST_RUNS] = server->identity.run;
    }
}

static wh_protocol_server_result_t step(wh_protocol_server_t *server, const waferhand_command *message,
                                        const int32_t valves[]) {
    wh_command_t command;
    if (wh_link_command_from_message(message, &command) != WH_OK) {
        ++server->counters.malformed;
        return WH_SERVER_IGNORED;
    }
    for (size_t g = 0; valves && g < command.gripper_count; ++g) {
        command.grippers[g].valve = valves[g];
    }
    const int64_t gap = message->seq - server->seq - 1;
    wh_state_t state;
    if (wh_simulator_step(&server->simulator, &command, &state) != WH_OK) {
        ++server->counters.refused;
        server->state.event_count = 0; /* the simulator's events now belong to the refusal */
        encode(server, &state, &server->identity);
        return WH_SERVER_ANSWERED;
    }
    ++server->counters.stepped;
    server->state = state;
    server->missed += gap;
    server->seq = message->seq;
    memcpy(server->axes, command.axes, sizeof server->axes);
    server->has_axes = command.axis_count == server->layout->machine.axis_count;
    if (!server->encodes_later) {
        wh_protocol_server_encode(server);
    }
    return WH_SERVER_STEPPED;
}

static wh_protocol_server_result_t go_on(wh_protocol_server_t *server, const waferhand_command *message,
                                         const int32_t valves[]) {
    const bool gap = message->seq > server->seq + 1;
    if (message->seq < server->seq) {
        ++server->counters.stale;
        return WH_SERVER_IGNORED;
    }
    if (message->seq == server->seq) {
        ++server->counters.repeated;
        wh_protocol_server_encode(server);
        return WH_SERVER_ANSWERED;
    }
    /* In lockstep no slice is skipped: this simulator was started again and lacks the slices between. */
    if (gap && message->lockstep != 0) {
        ++server->counters.unknown_run;
        return turn_away(server, message, WH_STATUS_UNKNOWN_RUN);
    }
    return step(server, message, valves);
}

wh_protocol_server_result_t wh_protocol_server_command(wh_protocol_server_t *server,
                                                       const waferhand_command *message,
                                                       const int32_t valves[]) {
    ++server->counters.commands;
    if (message->run == 0 || message->seq < 1 || message->seq > WH_LINK_SLICES) {
        ++server->counters.malformed;
        return WH_SERVER_IGNORED;
    }
    if ((uint64_t)message->layout_hash != server->identity.layout_hash) {
        ++server->counters.other_layout;
        return turn_away(server, message, WH_STATUS_OTHER_LAYOUT);
    }
    if (message->run == server->identity.run) {
        return go_on(server, message, valves);
    }
    if (is_past(server, message->run)) {
        ++server->counters.run_over;
        return turn_away(server, message, WH_STATUS_RUN_OVER);
    }
    if (message->seq == 1) {
        leave_run(server);
        start_run(server, message->run);
        const wh_protocol_server_result_t result = step(server, message, valves);
        return result == WH_SERVER_STEPPED ? WH_SERVER_NEW_RUN : result;
    }
    ++server->counters.unknown_run;
    return turn_away(server, message, WH_STATUS_UNKNOWN_RUN);
}

/* ---------------------------------------------------------------------------------------------- restoring */

static bool is_wanted(const wh_protocol_server_t *server, const waferhand_state *message) {
    const bool further = message->run != server->identity.run || message->seq > server->seq;
    return message->run != 0 && message->missed >= 0 && message->missed < message->seq && message->seq >= 1 &&
           message->seq <= WH_LINK_SLICES && message->status == WH_OK &&
           (uint64_t)message->layout_hash == server->identity.layout_hash && further &&
           !is_past(server, message->run);
}

static bool take_over(wh_protocol_server_t *server, const waferhand_state *message, const wh_state_t *state) {
    if (wh_grasp_restore(&server->simulator.table, (uint64_t)(message->seq - message->missed), state->wafers,
                         state->grippers) != WH_OK) {
        return false;
    }
    if (server->collision.memory) {
        wh_collision_attach(&server->collision, server->layout, &server->simulator, server->collision.memory);
    }
    server->simulator.physics = *state->physics;
    memcpy(server->simulator.events, state->events, state->event_count * sizeof *state->events);
    server->simulator.event_count = state->event_count;
    server->state.utime = state->utime;
    server->state.seq = state->seq;
    server->state.status = WH_OK;
    wh_simulator_view(&server->simulator, &server->state);
    return true;
}

wh_protocol_server_result_t wh_protocol_server_restore(wh_protocol_server_t *server,
                                                       const waferhand_state *message) {
    wh_state_t state;
    ++server->counters.restores;
    if (!is_wanted(server, message)) {
        ++server->counters.restore_ignored;
        return WH_SERVER_IGNORED;
    }
    if (!wh_link_state_is_sound(message, server->layout, &server->spare, &state) ||
        !wh_simulator_may_have(&server->simulator, state.physics) || !take_over(server, message, &state)) {
        ++server->counters.restore_refused;
        return WH_SERVER_IGNORED;
    }
    if (message->run != server->identity.run) {
        leave_run(server);
    }
    server->identity.run = message->run;
    server->seq = message->seq;
    server->has_axes = false;
    server->missed = message->missed;
    ++server->counters.restored;
    encode(server, &server->state, &server->identity);
    return WH_SERVER_RESTORED;
}
