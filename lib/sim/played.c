#include "played.h"

#include <string.h>

static bool lacks_arrays(const wh_played_t *run, const wh_grasp_storage_t *storage) {
    return !run->machine || (run->wafer_count > 0 && (!run->wafers || !storage->wafers)) ||
           (run->segment_count > 0 && !run->segments) || (run->fault_count > 0 && !run->faults);
}

/* Faults come one after the other, in one slice no more than a command has room for. */
static bool is_in_order(const wh_played_fault_t faults[], size_t count) {
    bool good = count == 0 || faults[0].seq >= 1;
    for (size_t i = 1; i < count; ++i) {
        good = good && faults[i].seq >= faults[i - 1].seq;
        good = good && (i < WH_COMMAND_FAULTS || faults[i].seq != faults[i - WH_COMMAND_FAULTS].seq);
    }
    return good;
}

/* The track counts in microseconds and the vacuum in seconds. False for NaN. */
static bool is_one_slice(int64_t slice_us, wh_real_t slice_s) {
    const wh_real_t us = (wh_real_t)slice_us;
    return wh_real_abs(slice_s * WH_REAL(1e6) - us) <= us * WH_REAL(1e-6);
}

static wh_status_t check_run(const wh_played_t *run, const wh_grasp_storage_t *storage) {
    if (lacks_arrays(run, storage)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (storage->wafer_count != run->wafer_count || storage->gripper_count != run->machine->gripper_count) {
        return WH_STATUS_BAD_CAPACITY;
    }
    const bool good =
        is_in_order(run->faults, run->fault_count) && is_one_slice(run->slice_us, run->physics.slice_s);
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

static wh_status_t set_up(wh_player_t *player, const wh_grasp_storage_t *storage) {
    const wh_played_t *run = player->run;
    wh_status_t status = wh_track_init(&player->track, run->machine, run->slice_us);
    if (status == WH_OK && run->take_ways != NULL) {
        run->take_ways(&player->track);
    }
    for (size_t w = 0; w < run->wafer_count; ++w) {
        storage->wafers[w].base_from_wafer = run->wafers[w];
    }
    if (status == WH_OK) {
        status = wh_simulator_init(&player->simulator, &run->config, storage, &run->cell);
    }
    if (status == WH_OK) {
        status = wh_simulator_set_physics(&player->simulator, &run->physics);
    }
    if (status == WH_OK) {
        wh_simulator_view(&player->simulator, &player->state);
    }
    return status;
}

wh_status_t wh_player_init(wh_player_t *player, const wh_played_t *run, const wh_grasp_storage_t *storage) {
    if (!player) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    memset(player, 0, sizeof *player);
    player->run = run;
    player->status = run && storage ? check_run(run, storage) : WH_STATUS_NULL_ARGUMENT;
    if (player->status == WH_OK) {
        player->status = set_up(player, storage);
    }
    return player->status;
}

/* Brings the faults of the slice that the track has reached. */
static void bring_faults(wh_player_t *player) {
    const wh_played_t *run = player->run;
    wh_command_t *command = &player->command;
    command->fault_count = 0;
    while (player->fault < run->fault_count && run->faults[player->fault].seq <= command->seq &&
           command->fault_count < WH_COMMAND_FAULTS) {
        command->faults[command->fault_count] = run->faults[player->fault].request;
        ++command->fault_count;
        ++player->fault;
    }
}

static void step(wh_player_t *player) {
    wh_command_from_track(&player->command, &player->cache, &player->track);
    bring_faults(player);
    player->status = wh_simulator_step(&player->simulator, &player->command, &player->state);
}

static void begin_segment(wh_player_t *player) {
    const wh_played_segment_t *next = &player->run->segments[player->segment];
    player->status = wh_track_begin(&player->track, &next->segment);
    player->is_moving = player->status == WH_OK;
    player->left = next->slices;
    ++player->segment;
}

/* Plays one slice of the running segment; false if it needs no more. */
static bool go_on(wh_player_t *player) {
    if (wh_track_next(&player->track, player->state.sensors) != WH_TRACK_MOVING) {
        player->is_moving = false;
        return false;
    }
    step(player);
    if (player->left > 0) {
        --player->left;
        player->is_moving = player->left > 0;
    }
    return true;
}

bool wh_player_next(wh_player_t *player) {
    if (player->simulator.mark != WH_SIMULATOR_MARK) {
        player->status = player->status == WH_OK ? WH_STATUS_NOT_INITIALISED : player->status;
        return false;
    }
    while (player->status == WH_OK) {
        if (player->is_moving) {
            if (go_on(player)) {
                return player->status == WH_OK;
            }
        } else if (player->segment < player->run->segment_count) {
            begin_segment(player);
        } else {
            return false;
        }
    }
    return false;
}
