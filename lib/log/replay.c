#include "replay.h"

#include <stdio.h>
#include <string.h>

#include "../link/messages.h"
#include "../math/hash.h"

/* --------------------------------------------------------------------------------------------------- runs */

/* The entry of a run, made if it is not there; null if there are too many. */
static wh_replay_run_t *entry(wh_replay_t *replay, int64_t run) {
    for (size_t i = replay->run_count; i > 0; --i) {
        if (replay->runs[i - 1].run == run) {
            return &replay->runs[i - 1];
        }
    }
    if (replay->run_count == WH_REPLAY_RUNS) {
        ++replay->runs_left_out;
        return NULL;
    }
    wh_replay_run_t *made = &replay->runs[replay->run_count++];
    memset(made, 0, sizeof *made);
    made->run = run;
    return made;
}

static void note_slice(wh_replay_t *replay, wh_replay_run_t *run) {
    if (run->first_slice == 0) {
        run->first_slice = replay->server.seq;
    }
    run->last_slice = replay->server.seq;
    run->missed = replay->server.missed;
    run->hash = wh_protocol_server_hash(&replay->server);
}

/* -------------------------------------------------------------------------------------------- differences */

static bool differs(wh_replay_difference_t *difference, const char *of, const char *what, double recorded,
                    double replayed) {
    /* By their bits: the hash tells -0 from 0, too. */
    if (wh_hash_real(WH_HASH_START, recorded) == wh_hash_real(WH_HASH_START, replayed)) {
        return false;
    }
    snprintf(difference->what, sizeof difference->what, "%s, %s", of, what);
    difference->recorded = recorded;
    difference->replayed = replayed;
    return true;
}

static bool pose_differs(wh_replay_difference_t *difference, const char *of, const wh_pose_t *recorded,
                         const wh_pose_t *replayed) {
    char entry[60];
    for (size_t i = 0; i < 9; ++i) {
        snprintf(entry, sizeof entry, "rotation %zu,%zu", i / 3 + 1, i % 3 + 1);
        if (differs(difference, of, entry, recorded->R.m[i / 3][i % 3], replayed->R.m[i / 3][i % 3])) {
            return true;
        }
    }
    return differs(difference, of, "position x", recorded->r.x, replayed->r.x) ||
           differs(difference, of, "position y", recorded->r.y, replayed->r.y) ||
           differs(difference, of, "position z", recorded->r.z, replayed->r.z);
}

static bool gripper_differs(wh_replay_difference_t *difference, const char *of, const wh_gripper_t *recorded,
                            const wh_gripper_t *replayed) {
    char held[120];
    snprintf(held, sizeof held, "%.60s, the held wafer in its frame", of);
    return pose_differs(difference, of, &recorded->base_from_gripper, &replayed->base_from_gripper) ||
           differs(difference, of, "valve", recorded->valve, replayed->valve) ||
           differs(difference, of, "index of the held wafer", recorded->wafer, replayed->wafer) ||
           (recorded->wafer != WH_NONE &&
            pose_differs(difference, held, &recorded->gripper_from_wafer, &replayed->gripper_from_wafer));
}

static bool condition_differs(wh_replay_difference_t *difference, const char *of, size_t g,
                              const wh_physics_state_t *recorded, const wh_physics_state_t *replayed) {
    return differs(difference, of, "vacuum level", recorded->vacuum[g].level, replayed->vacuum[g].level) ||
           differs(difference, of, "valve's command", recorded->vacuum[g].command,
                   replayed->vacuum[g].command) ||
           differs(difference, of, "vacuum sensor", recorded->vacuum[g].on, replayed->vacuum[g].on);
}

static void name_difference(wh_replay_t *replay, const wh_state_t *recorded,
                            wh_replay_difference_t *difference) {
    const wh_grasp_storage_t *storage = &replay->server.simulator.table.storage;
    difference->slice = recorded->seq;
    for (size_t w = 0; w < storage->wafer_count; ++w) {
        const char *name = replay->layout->wafers[w].name;
        if (pose_differs(difference, name, &recorded->wafers[w].base_from_wafer,
                         &storage->wafers[w].base_from_wafer) ||
            differs(difference, name, "index of the holder", recorded->wafers[w].holder,
                    storage->wafers[w].holder)) {
            return;
        }
    }
    for (size_t g = 0; g < storage->gripper_count; ++g) {
        if (gripper_differs(difference, replay->layout->grippers[g].name, &recorded->grippers[g],
                            &storage->grippers[g]) ||
            condition_differs(difference, replay->layout->grippers[g].name, g, recorded->physics,
                              &replay->server.simulator.physics)) {
            return;
        }
    }
    snprintf(difference->what, sizeof difference->what,
             "the closest approaches, the contests, the faults or the slices' count");
}

/* ----------------------------------------------------------------------------------------------- stepping */

static void take_up(wh_replay_t *replay, const waferhand_state *message) {
    wh_replay_run_t *run = entry(replay, message->run);
    if (run && wh_protocol_server_restore(&replay->server, message) == WH_SERVER_RESTORED) {
        ++run->taken_up;
        note_slice(replay, run);
    }
}

/* Steps the waiting command, with the valves in force if they are known. True if it was stepped. */
static bool step(wh_replay_t *replay, const int32_t valves[], wh_replay_run_t **run) {
    replay->has_command = false;
    const wh_protocol_server_result_t result =
        wh_protocol_server_command(&replay->server, &replay->command, valves);
    if (result != WH_SERVER_STEPPED && result != WH_SERVER_NEW_RUN) {
        return false;
    }
    *run = entry(replay, replay->command.run);
    if (*run) {
        note_slice(replay, *run);
    }
    return *run != NULL;
}

static void compare(wh_replay_t *replay, wh_replay_run_t *run, const waferhand_state *message) {
    wh_state_t recorded;
    if (run->differs) {
        return;
    }
    ++run->compared;
    if ((uint64_t)message->hash == run->hash) {
        return;
    }
    run->differs = true;
    if (wh_link_state_from_message(message, &replay->layout->grasp.tolerance, &replay->recorded, &recorded) ==
        WH_OK) {
        name_difference(replay, &recorded, &run->difference);
    }
}

static void resolve(wh_replay_t *replay, const waferhand_state *message) {
    const waferhand_command *command = &replay->command;
    int32_t valves[WH_GRIPPERS] = {0};
    bool outside = false;
    wh_replay_run_t *run = NULL;
    for (int32_t g = 0; g < message->gripper_count && g < command->gripper_count; ++g) {
        valves[g] = message->grippers[g].valve_told;
        outside = outside || valves[g] != command->valve[g];
    }
    if (!step(replay, outside ? valves : NULL, &run)) {
        take_up(replay, message);
        return;
    }
    run->outside_valves += outside ? 1 : 0;
    compare(replay, run, message);
}

/* ----------------------------------------------------------------------------------------------- messages */

static void on_cell(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_cell message;
    if (!wh_link_decode_cell(data, size, &message)) {
        ++replay->garbage;
        return;
    }
    ++replay->messages;
    if (!replay->layout || replay->server.identity.layout_hash != (uint64_t)message.layout_hash) {
        wh_layout_t *layout = wh_link_layout_from_cell(&message);
        if (layout) {
            wh_replay_finish(replay);
            wh_link_layout_free(replay->layout);
            replay->layout = layout;
            (void)wh_protocol_server_open(&replay->server, layout);
            replay->server.identity.layout_hash = (uint64_t)message.layout_hash;
        } else {
            ++replay->garbage;
        }
    }
    (void)waferhand_cell_decode_cleanup(&message);
}

static bool is_new(const wh_replay_t *replay, int64_t run, int64_t seq) {
    return run != replay->server.identity.run || seq > replay->server.seq;
}

/* True if this command waits for its state. */
static bool is_waiting(const wh_replay_t *replay, int64_t run, int64_t seq) {
    return replay->has_command && replay->command.run == run && replay->command.seq == seq;
}

/* A state that came before its command. */
static bool is_held(const wh_replay_t *replay, int64_t run, int64_t seq) {
    return replay->state_size > 0 && replay->state_run == run && replay->state_seq == seq;
}

static void on_command(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_command message;
    waferhand_state state;
    if (!wh_link_decode_command(data, size, &message)) {
        ++replay->garbage;
        return;
    }
    ++replay->messages;
    if (!replay->layout) {
        ++replay->homeless;
        return;
    }
    if (!is_new(replay, message.run, message.seq) || is_waiting(replay, message.run, message.seq)) {
        return;
    }
    wh_replay_finish(replay);
    replay->command = message;
    replay->has_command = true;
    if (is_held(replay, message.run, message.seq) &&
        wh_link_decode_state(replay->state, replay->state_size, &state)) {
        replay->state_size = 0;
        resolve(replay, &state);
        (void)waferhand_state_decode_cleanup(&state);
    }
}

static void hold_state(wh_replay_t *replay, const waferhand_state *message, const void *data, size_t size) {
    memcpy(replay->state, data, size);
    replay->state_size = size;
    replay->state_run = message->run;
    replay->state_seq = message->seq;
}

static void on_state(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        ++replay->garbage;
        return;
    }
    ++replay->messages;
    if (!replay->layout) {
        ++replay->homeless;
    } else if (message.status != WH_OK || !is_new(replay, message.run, message.seq)) {
        /* A refusal, or an answer once more. */
    } else if (is_waiting(replay, message.run, message.seq)) {
        resolve(replay, &message);
    } else if (message.run == replay->server.identity.run && message.seq == replay->server.seq + 1) {
        hold_state(replay, &message, data, size);
    } else {
        wh_replay_finish(replay);
        take_up(replay, &message);
    }
    (void)waferhand_state_decode_cleanup(&message);
}

static void on_mcs(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_mcs message;
    if (!wh_link_decode_mcs(data, size, &message)) {
        ++replay->garbage;
        return;
    }
    ++replay->messages;
    if (message.phase == WH_LINK_PHASE_OVER && message.run != 0) {
        wh_replay_finish(replay);
        wh_replay_run_t *run = entry(replay, message.run);
        if (run) {
            run->over = true;
        }
    }
    (void)waferhand_mcs_decode_cleanup(&message);
}

/* ---------------------------------------------------------------------------------------------- the whole */

void wh_replay_event(wh_replay_t *replay, const char *channel, const void *data, size_t size) {
    static const struct {
        const char *channel;
        void (*handle)(wh_replay_t *replay, const void *data, size_t size);
    } handlers[] = {{WH_CHANNEL_CELL, on_cell},
                    {WH_CHANNEL_COMMAND, on_command},
                    {WH_CHANNEL_STATE, on_state},
                    {WH_CHANNEL_MCS, on_mcs}};
    for (size_t i = 0; i < sizeof handlers / sizeof handlers[0]; ++i) {
        if (size <= WH_LINK_DATAGRAM && strcmp(handlers[i].channel, channel) == 0) {
            handlers[i].handle(replay, data, size);
        }
    }
}

void wh_replay_finish(wh_replay_t *replay) {
    wh_replay_run_t *run = NULL;
    if (replay->has_command && step(replay, NULL, &run)) {
        ++run->unanswered;
    }
}

void wh_replay_close(wh_replay_t *replay) {
    wh_link_layout_free(replay->layout);
    replay->layout = NULL;
}
