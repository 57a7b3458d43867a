/* Steps slices, and compares the results with the recorded ones. */
#include <string.h>

#include "replay_internal.h"

static void note_slice(wh_replay_t *replay) {
    wh_replay_run_t *run = replay->run;
    if (run->first_slice == 0) {
        run->first_slice = replay->server.seq;
    }
    run->last_slice = replay->server.seq;
    run->slices.missed = replay->server.missed;
    run->hash = wh_protocol_server_hash(&replay->server);
}

/* True if the simulator accepts the command; `valves` null: with its own valves. */
static bool step(wh_replay_t *replay, const waferhand_command *command, const int32_t valves[]) {
    const wh_protocol_server_result_t result = wh_protocol_server_command(&replay->server, command, valves);
    replay->is_synchronous = result == WH_SERVER_STEPPED || result == WH_SERVER_NEW_RUN;
    if (replay->is_synchronous) {
        replay->run->slices.outside_valves += valves ? 1 : 0;
        note_slice(replay);
    }
    return replay->is_synchronous;
}

void wh_replay_tell(const wh_replay_t *replay, const waferhand_command *command,
                    const waferhand_state *message) {
    if (replay->given.listener) {
        replay->given.listener(replay->given.user, command, message);
    }
}

/* Calls the listener for a block's last slice, whose whole state has not come. */
void wh_replay_tell_last(wh_replay_t *replay) {
    if (replay->block.is_there && replay->given.stepped && !replay->block.differs) {
        replay->given.stepped(replay->given.user, &replay->block.last, &replay->server);
    } else if (replay->block.is_there && replay->given.listener) {
        wh_protocol_server_tell(&replay->server, replay->run->hash);
        wh_replay_tell(replay, &replay->block.last, &replay->server.room.message);
    }
    replay->block.is_there = false;
}

static void note_difference(wh_replay_run_t *run, int64_t slice, const wh_replay_difference_t *difference) {
    if (run->slices.differing++ == 0) {
        run->difference = *difference;
        run->difference.slice = slice;
    }
}

/* Counts a slice that was compared; null: it is equal. False if the result is unsure because its valves
 * are not known. */
static bool count_compared(wh_replay_t *replay, int64_t slice, const wh_replay_difference_t *difference) {
    ++replay->run->slices.compared;
    if (difference && replay->is_unsure) {
        ++replay->run->slices.doubtful;
        return false;
    }
    if (difference) {
        note_difference(replay->run, slice, difference);
    }
    replay->is_unsure = false;
    return true;
}

/* Goes on from a recorded state. False if no simulator could have been in it. */
bool wh_replay_restore(wh_replay_t *replay, const waferhand_state *message) {
    if (replay->server.identity.run == message->run) {
        replay->server.identity.run = 0; /* else later slices are refused */
    }
    replay->is_unsure = false;
    replay->is_synchronous = wh_protocol_server_restore(&replay->server, message) == WH_SERVER_RESTORED;
    if (replay->is_synchronous) {
        note_slice(replay);
    }
    return replay->is_synchronous;
}

/* Compares the recorded state with the server's. */
static bool is_same(wh_replay_t *replay, const waferhand_state *message, const uint8_t *bytes, size_t size,
                    wh_replay_difference_t *difference) {
    wh_protocol_server_t *server = &replay->server;
    wh_protocol_server_encode(server);
    for (int32_t i = 0; i < message->event_count; ++i) {
        replay->run->collisions += wh_replay_is_collision(message->events[i].kind) ? 1 : 0;
    }
    return (size == server->encoded_size && memcmp(bytes, server->encoded, size - 8) == 0) ||
           !wh_replay_states_differ(server->layout, message, &server->room.message, difference);
}

/* Counts a command that the simulator accepted and the replay refuses, or the reverse. */
void wh_replay_differ_in_status(wh_replay_run_t *run, int64_t slice, int32_t recorded, int32_t replayed) {
    const wh_replay_difference_t difference = {.what = "status", .recorded = recorded, .replayed = replayed};
    ++run->slices.compared;
    note_difference(run, slice, &difference);
}

/* Finds the valves in force from the state; null if they are the command's. */
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
    wh_replay_difference_t difference;
    bool known = false;
    wh_replay_remember_state(replay, message->seq, bytes, size);
    if (step(replay, command, find_valves(command, message, told))) {
        const bool same = is_same(replay, message, bytes, size, &difference);
        known = count_compared(replay, message->seq, same ? NULL : &difference);
        if (same) {
            wh_replay_pass_slice(replay);
        }
    } else {
        wh_replay_differ_in_status(replay->run, message->seq, WH_OK, replay->server.room.message.status);
    }
    if (!known) {
        (void)wh_replay_restore(replay, message);
    }
}

/* Compares the whole state of the last slice, in a block. */
void wh_replay_take_last_state(wh_replay_t *replay, const waferhand_state *message, const void *data,
                               size_t size) {
    wh_replay_difference_t difference;
    if (!is_same(replay, message, data, size, &difference) && !replay->block.differs) {
        note_difference(replay->run, message->seq, &difference);
    }
    wh_replay_tell(replay, &replay->block.last, message);
    replay->block.is_there = false;
}

/* Compares the first state of another file of the log: that of the last slice. */
void wh_replay_take_first_state(wh_replay_t *replay, const waferhand_state *message, const void *data,
                                size_t size) {
    wh_replay_difference_t difference;
    const int64_t collisions = replay->run->collisions; /* its events are counted already */
    replay->files.file_begins = false;
    if (!is_same(replay, message, data, size, &difference)) {
        note_difference(replay->run, message->seq, &difference);
    }
    replay->run->collisions = collisions;
}

/* Steps a slice of a block: the hash is compared instead of the state. */
void wh_replay_step_hashed(wh_replay_t *replay, const int32_t told[], uint64_t hash) {
    const waferhand_command *command = &replay->block.last;
    const bool outside = memcmp(told, command->valve, (size_t)command->gripper_count * sizeof *told) != 0;
    wh_replay_run_t *run = replay->run;
    replay->seq = command->seq;
    replay->block.differs = true;
    if (!step(replay, command, outside ? told : NULL)) {
        wh_replay_differ_in_status(run, command->seq, WH_OK, replay->server.room.message.status);
        return;
    }
    const wh_replay_difference_t difference = {
        .what = "hash", .recorded = (double)hash, .replayed = (double)run->hash};
    replay->block.is_there = true;
    replay->block.differs = hash != run->hash;
    replay->is_synchronous = count_compared(replay, command->seq, replay->block.differs ? &difference : NULL);
    if (!replay->block.differs) {
        wh_replay_pass_slice(replay);
    }
}

void wh_replay_step_alone(wh_replay_t *replay, const waferhand_command *command) {
    ++replay->run->slices.unanswered;
    replay->is_unsure = true;
    (void)step(replay, command, NULL);
}
