/* Slices stepped, and what comes of them compared with what was recorded. */
#include <stdio.h>
#include <string.h>

#include "replay_internal.h"

static void note_slice(wh_replay_t *replay) {
    wh_replay_run_t *run = replay->run;
    if (run->first_slice == 0) {
        run->first_slice = replay->server.seq;
    }
    run->last_slice = replay->server.seq;
    run->missed = replay->server.missed;
    run->hash = wh_protocol_server_hash(&replay->server);
}

/* ---------------------------------------------------------------------------------------------- comparing */

void wh_replay_tell(const wh_replay_t *replay, const waferhand_command *command,
                    const waferhand_state *message) {
    if (replay->listener) {
        replay->listener(replay->user, command, message);
    }
}

/* A block's last slice, whose whole state has not come. */
void wh_replay_tell_last(wh_replay_t *replay) {
    if (replay->has_last && replay->listener) {
        wh_protocol_server_encode(&replay->server);
        wh_replay_tell(replay, &replay->last, &replay->server.room.message);
    }
    replay->has_last = false;
}

static void note_difference(wh_replay_run_t *run, int64_t slice, const wh_replay_difference_t *difference) {
    if (run->differing++ == 0) {
        run->difference = *difference;
        run->difference.slice = slice;
    }
}

static int64_t count_collisions(const waferhand_state *message) {
    int64_t count = 0;
    for (int32_t i = 0; i < message->event_count; ++i) {
        count += wh_replay_is_collision(message->events[i].kind) ? 1 : 0;
    }
    return count;
}

/* Goes on from a recorded state. False if no simulator could have been in it. */
bool wh_replay_restore(wh_replay_t *replay, const waferhand_state *message) {
    if (replay->server.identity.run == message->run) {
        replay->server.identity.run = 0; /* else what is behind it is refused */
    }
    replay->is_unsure = false;
    replay->is_synchronous = wh_protocol_server_restore(&replay->server, message) == WH_SERVER_RESTORED;
    if (replay->is_synchronous) {
        note_slice(replay);
    }
    return replay->is_synchronous;
}

/* The recorded state with the server's. */
static bool is_same(wh_replay_t *replay, const waferhand_state *message, const uint8_t *bytes, size_t size,
                    wh_replay_difference_t *difference) {
    wh_protocol_server_t *server = &replay->server;
    wh_protocol_server_encode(server);
    replay->run->collisions += count_collisions(message);
    return (size == server->encoded_size && memcmp(bytes, server->encoded, size - 8) == 0) ||
           !wh_replay_differs(server->layout, message, &server->room.message, difference);
}

static void compare(wh_replay_t *replay, const waferhand_state *message, const uint8_t *bytes, size_t size) {
    wh_replay_run_t *run = replay->run;
    wh_replay_difference_t difference;
    ++run->compared;
    if (is_same(replay, message, bytes, size, &difference)) {
        replay->is_unsure = false;
    } else if (replay->is_unsure) {
        ++run->doubtful;
        (void)wh_replay_restore(replay, message);
    } else {
        note_difference(run, message->seq, &difference);
    }
}

/* A command that the simulator took and the replay refuses, or the other way round. */
void wh_replay_differ_in_status(wh_replay_run_t *run, int64_t slice, int32_t recorded, int32_t replayed) {
    wh_replay_difference_t difference = {.recorded = recorded, .replayed = replayed};
    (void)snprintf(difference.what, sizeof difference.what, "status");
    ++run->compared;
    note_difference(run, slice, &difference);
}

/* The valves in force as the state tells; null if they are the command's. */
static const int32_t *find_valves(const waferhand_command *command, const waferhand_state *message,
                                  int32_t valves[WH_GRIPPERS]) {
    bool outside = false;
    for (int32_t g = 0; g < message->gripper_count && g < command->gripper_count && g < WH_GRIPPERS; ++g) {
        valves[g] = message->grippers[g].valve_told;
        outside = outside || valves[g] != command->valve[g];
    }
    return outside ? valves : NULL;
}

void wh_replay_step(wh_replay_t *replay, const waferhand_command *command, const waferhand_state *message,
                    const uint8_t *bytes, size_t size) {
    int32_t told[WH_GRIPPERS] = {0};
    const int32_t *valves = find_valves(command, message, told);
    const wh_protocol_server_result_t result = wh_protocol_server_command(&replay->server, command, valves);
    if (result == WH_SERVER_STEPPED || result == WH_SERVER_NEW_RUN) {
        replay->is_synchronous = true;
        replay->run->outside_valves += valves ? 1 : 0;
        note_slice(replay);
        compare(replay, message, bytes, size);
    } else {
        wh_replay_differ_in_status(replay->run, message->seq, WH_OK, replay->server.room.message.status);
        (void)wh_replay_restore(replay, message);
    }
}

/* The whole state of the slice that went through last, in a block. */
void wh_replay_take_last_state(wh_replay_t *replay, const waferhand_state *message, const void *data,
                               size_t size) {
    wh_replay_difference_t difference;
    if (!is_same(replay, message, data, size, &difference) && !replay->last_differs) {
        note_difference(replay->run, message->seq, &difference);
    }
    wh_replay_tell(replay, &replay->last, message);
    replay->has_last = false;
}

/* A slice of a block: the hash stands for the state. */
void wh_replay_step_hashed(wh_replay_t *replay, const int32_t told[], uint64_t hash) {
    const waferhand_command *command = &replay->last;
    const bool outside = memcmp(told, command->valve, (size_t)command->gripper_count * sizeof *told) != 0;
    const wh_protocol_server_result_t result =
        wh_protocol_server_command(&replay->server, command, outside ? told : NULL);
    wh_replay_run_t *run = replay->run;
    replay->is_synchronous = result == WH_SERVER_STEPPED || result == WH_SERVER_NEW_RUN;
    replay->seq = command->seq;
    replay->last_differs = true;
    if (!replay->is_synchronous) {
        wh_replay_differ_in_status(run, command->seq, WH_OK, replay->server.room.message.status);
        return;
    }
    run->outside_valves += outside ? 1 : 0;
    note_slice(replay);
    ++run->compared;
    replay->has_last = true;
    replay->last_differs = hash != run->hash;
    if (!replay->last_differs) {
        replay->is_unsure = false;
    } else if (replay->is_unsure) {
        ++run->doubtful;
        replay->is_synchronous = false;
    } else {
        wh_replay_difference_t difference = {.recorded = (double)hash, .replayed = (double)run->hash};
        (void)snprintf(difference.what, sizeof difference.what, "hash");
        note_difference(run, command->seq, &difference);
    }
}

void wh_replay_step_alone(wh_replay_t *replay, const waferhand_command *command) {
    const wh_protocol_server_result_t result = wh_protocol_server_command(&replay->server, command, NULL);
    ++replay->run->unanswered;
    replay->is_unsure = true;
    replay->is_synchronous = result == WH_SERVER_STEPPED || result == WH_SERVER_NEW_RUN;
    if (replay->is_synchronous) {
        note_slice(replay);
    }
}
