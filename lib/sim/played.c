#include "played.h"

#include <string.h>

#include "../math/hash.h"
#include "description_internal.h"
#include "played_internal.h"

/* --------------------------------------------------------------------------------------------- beginning */

static bool lacks(const void *array, size_t count) {
    return count > 0 && !array;
}

static bool lacks_arrays(const wh_played_t *run) {
    return !run->machine || lacks(run->wafers, run->wafer_count) || lacks(run->rows, run->row_count) ||
           lacks(run->faults, run->fault_count) || lacks(run->orders, run->order_count);
}

static bool lacks_room(const wh_played_t *run, const wh_played_room_t *room) {
    const size_t seen = run->parts.set_grips ? run->wafer_count : 0;
    return lacks(room->wafers, run->wafer_count) || lacks(room->motions, run->motion_count) ||
           lacks(room->seen, seen) || (run->parts.begin_slowly && !room->slow);
}

/* Faults come one after the other, in one slice no more than a command has room for. */
static bool are_faults_in_order(const wh_played_fault_t faults[], size_t count) {
    bool good = count == 0 || faults[0].seq >= 1;
    for (size_t i = 1; i < count; ++i) {
        good = good && faults[i].seq >= faults[i - 1].seq;
        good = good && (i < WH_COMMAND_FAULTS || faults[i].seq != faults[i - WH_COMMAND_FAULTS].seq);
    }
    return good;
}

static bool are_orders_in_order(const wh_played_order_t orders[], size_t count) {
    bool good = count == 0 || orders[0].seq >= 1;
    for (size_t i = 1; i < count; ++i) {
        good = good && orders[i].seq > orders[i - 1].seq;
    }
    return good;
}

/* The track counts in microseconds and the vacuum in seconds. False for NaN. */
static bool is_one_slice(int64_t slice_us, wh_real_t slice_s) {
    const wh_real_t us = (wh_real_t)slice_us;
    return wh_real_abs(slice_s * WH_REAL(1e6) - us) <= us * WH_REAL(1e-6);
}

static wh_status_t check_run(const wh_played_t *run, const wh_played_room_t *room) {
    if (lacks_arrays(run) || lacks_room(run, room)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (room->wafer_count != run->wafer_count || room->gripper_count != run->machine->gripper_count ||
        room->motion_count < run->motion_count) {
        return WH_STATUS_BAD_CAPACITY;
    }
    const bool good = are_faults_in_order(run->faults, run->fault_count) &&
                      are_orders_in_order(run->orders, run->order_count) &&
                      is_one_slice(run->slice_us, run->physics.slice_s);
    return good ? wh_played_check_rows(run) : WH_STATUS_OUT_OF_RANGE;
}

static wh_status_t give_grips(wh_player_t *player) {
    wh_grips_parts_t grips = player->run->parts.grips;
    grips.states = player->simulator.physics.grips;
    grips.seen = player->room.seen;
    return player->run->parts.set_grips(&player->simulator, &grips);
}

static wh_status_t give_parts(wh_player_t *player) {
    const wh_played_parts_t *parts = &player->run->parts;
    const wh_machine_t *machine = player->run->machine;
    wh_status_t status = WH_OK;
    if (parts->set_scanning) {
        status = parts->set_scanning(&player->simulator, &parts->scanning);
    }
    if (status == WH_OK && parts->set_latching) {
        status = parts->set_latching(&player->simulator, &parts->latching);
    }
    if (status == WH_OK && parts->set_doors) {
        const wh_door_set_t set = {machine->doors, machine->door_count, wh_machine_door_axis(machine, 0)};
        status = parts->set_doors(&player->simulator, &set);
    }
    return status == WH_OK && parts->set_grips ? give_grips(player) : status;
}

static wh_status_t set_up_track(wh_player_t *player) {
    const wh_played_parts_t *parts = &player->run->parts;
    const wh_status_t status = wh_track_init(&player->track, player->run->machine, player->run->slice_us);
    if (status == WH_OK && parts->take_ways) {
        parts->take_ways(&player->track);
    }
    if (status == WH_OK && parts->take_vias) {
        parts->take_vias(&player->track);
    }
    return status;
}

static wh_status_t set_up_simulator(wh_player_t *player) {
    const wh_played_t *run = player->run;
    const wh_played_room_t *room = &player->room;
    const wh_grasp_storage_t storage = {
        room->wafers, room->wafer_count, room->grippers, room->gripper_count, NULL, 0};
    for (size_t w = 0; w < run->wafer_count; ++w) {
        room->wafers[w].base_from_wafer = run->wafers[w];
    }
    wh_status_t status = wh_simulator_init(&player->simulator, &run->config, &storage, &run->cell);
    if (status == WH_OK) {
        status = wh_simulator_set_physics(&player->simulator, &run->physics);
    }
    return status == WH_OK ? give_parts(player) : status;
}

/* -------------------------------------------------------------------------------------- what has gone in */

static uint64_t hash_fault(uint64_t hash, const wh_fault_t *fault) {
    hash = wh_hash_int(hash, (int32_t)fault->kind);
    hash = wh_hash_int(hash, fault->target);
    hash = wh_hash_int(hash, fault->other);
    hash = wh_hash_real(hash, fault->value);
    hash = wh_hash_pose(hash, &fault->offset);
    hash = wh_hash_word(hash, (uint64_t)fault->from);
    return wh_hash_word(hash, (uint64_t)fault->until);
}

static void note_description(wh_player_t *player) {
    const wh_played_t *run = player->run;
    uint64_t hash = wh_simulator_describe(&player->simulator);
    for (size_t w = 0; w < run->wafer_count; ++w) {
        hash = wh_hash_pose(hash, &run->wafers[w]);
    }
    for (size_t i = 0; i < run->physics.fault_count; ++i) {
        hash = hash_fault(hash, &run->physics.faults[i]);
    }
    player->inputs = hash;
}

static void note_row(wh_player_t *player, const wh_played_row_t *row) {
    uint64_t hash = wh_hash_word(player->inputs, (uint64_t)row->after);
    hash = wh_hash_word(hash, (uint64_t)row->slices);
    hash = wh_hash_int(hash, (int32_t)row->kind);
    hash = wh_hash_int(hash, row->is_cut ? 1 : 0);
    hash = wh_hash_int(hash, row->gripper);
    hash = wh_hash_word(hash, row->bits);
    for (size_t i = 0; i < WH_PLAYED_VALUES; ++i) {
        hash = wh_hash_real(hash, row->values[i]);
    }
    player->inputs = hash;
}

static void note_order(wh_player_t *player, const wh_played_order_t *order) {
    uint64_t hash = wh_hash_word(player->inputs, (uint64_t)order->seq);
    hash = wh_hash_int(hash, (int32_t)order->scan.kind);
    hash = wh_hash_int(hash, order->scan.gripper);
    hash = wh_hash_int(hash, order->scan.count);
    hash = wh_hash_word(hash, (uint64_t)order->scan.first);
    hash = wh_hash_int(hash, (int32_t)order->latch.kind);
    hash = wh_hash_int(hash, order->latch.first);
    player->inputs = wh_hash_int(hash, order->latch.count);
}

static void note_axes(wh_player_t *player) {
    for (size_t axis = 0; axis < player->run->machine->axis_count; ++axis) {
        player->inputs = wh_hash_real(player->inputs, player->track.axes[axis]);
    }
}

wh_status_t wh_player_init(wh_player_t *player, const wh_played_t *run, const wh_played_room_t *room) {
    if (!player) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    memset(player, 0, sizeof *player);
    player->run = run;
    player->status = run && room ? check_run(run, room) : WH_STATUS_NULL_ARGUMENT;
    if (player->status != WH_OK) {
        return player->status;
    }
    player->room = *room;
    for (size_t i = 0; i < room->motion_count; ++i) {
        player->room.motions[i].left = 0;
    }
    player->status = set_up_track(player);
    if (player->status == WH_OK) {
        player->status = set_up_simulator(player);
    }
    if (player->status == WH_OK) {
        note_description(player);
        wh_simulator_view(&player->simulator, &player->state);
    }
    return player->status;
}

/* ----------------------------------------------------------------------------------------------- playing */

static wh_status_t begin_motion(wh_player_t *player, wh_played_motion_t *motion) {
    const wh_played_row_t *first = &player->run->rows[player->row];
    wh_played_plan_t plan;
    wh_status_t status = wh_played_read(player->run, &player->track, &player->row, &plan);
    motion->track = player->track;
    motion->bits = first->bits;
    motion->is_cut = first->is_cut;
    if (status == WH_OK && !plan.is_slow) {
        status = wh_track_begin(&motion->track, &plan.segment);
    } else if (status == WH_OK) {
        status = player->run->parts.begin_slowly
                     ? player->run->parts.begin_slowly(&motion->track, &plan.segment, &plan.slowness,
                                                       player->room.slow)
                     : WH_STATUS_OUT_OF_RANGE;
    }
    motion->left = status == WH_OK ? first->slices : 0;
    return status;
}

static wh_status_t begin_any_motion(wh_player_t *player) {
    for (size_t i = 0; i < player->room.motion_count; ++i) {
        if (player->room.motions[i].left == 0) {
            return begin_motion(player, &player->room.motions[i]);
        }
    }
    return WH_STATUS_BAD_CAPACITY;
}

static wh_status_t switch_valves(wh_player_t *player) {
    const uint32_t bits = player->run->rows[player->row].bits;
    const size_t count = player->run->machine->gripper_count;
    if (bits >> count != 0) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    for (size_t g = 0; g < count; ++g) {
        player->track.valves[g] = (bits >> g & 1U) != 0 ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
    }
    ++player->row;
    return WH_OK;
}

/* Axes stand where somebody else than a track put them. */
static wh_status_t place_axes(wh_player_t *player) {
    wh_played_plan_t plan;
    wh_status_t status = wh_played_read(player->run, &player->track, &player->row, &plan);
    if (status == WH_OK) {
        status = wh_machine_check_travel(player->run->machine, plan.segment.target);
    }
    if (status == WH_OK) {
        memcpy(player->track.axes, plan.segment.target, sizeof player->track.axes);
    }
    return status;
}

static wh_status_t take_row(wh_player_t *player, wh_played_kind_t kind) {
    if (kind == WH_PLAYED_VALVES) {
        return switch_valves(player);
    }
    return kind == WH_PLAYED_PLACE ? place_axes(player) : begin_any_motion(player);
}

/* Takes the rows that begin with the next slice. */
static void take_rows(wh_player_t *player) {
    const wh_played_t *run = player->run;
    while (player->status == WH_OK && player->row < run->row_count &&
           run->rows[player->row].after <= player->track.slice) {
        const size_t first = player->row;
        player->status = take_row(player, run->rows[first].kind);
        for (size_t i = first; player->status == WH_OK && i < player->row; ++i) {
            note_row(player, &run->rows[i]);
        }
    }
}

/* The last slice of a motion that nothing stopped is at its end, also in float, which may have planned one
 * slice more or less. */
static void move_axes(wh_player_t *player) {
    for (size_t i = 0; i < player->room.motion_count; ++i) {
        wh_played_motion_t *motion = &player->room.motions[i];
        if (motion->left == 0) {
            continue;
        }
        if (motion->left == 1 && !motion->is_cut) {
            wh_track_skip(&motion->track);
        } else {
            (void)wh_track_next(&motion->track, 0);
        }
        --motion->left;
        for (size_t axis = 0; axis < player->run->machine->axis_count; ++axis) {
            if ((motion->bits >> axis & 1U) != 0) {
                player->track.axes[axis] = motion->track.axes[axis];
            }
        }
    }
}

/* Brings the faults and the orders of the slice that the track has reached. */
static void bring_rest(wh_player_t *player) {
    const wh_played_t *run = player->run;
    wh_command_t *command = &player->command;
    command->fault_count = 0;
    command->scan.kind = WH_SCAN_KEEP;
    command->latch.kind = WH_LATCH_KEEP;
    while (player->fault < run->fault_count && run->faults[player->fault].seq <= command->seq &&
           command->fault_count < WH_COMMAND_FAULTS) {
        const wh_fault_request_t *request = &run->faults[player->fault].request;
        command->faults[command->fault_count] = *request;
        ++command->fault_count;
        ++player->fault;
        player->inputs = hash_fault(wh_hash_int(player->inputs, request->index), &request->fault);
    }
    if (player->order < run->order_count && run->orders[player->order].seq <= command->seq) {
        command->scan = run->orders[player->order].scan;
        command->latch = run->orders[player->order].latch;
        note_order(player, &run->orders[player->order]);
        ++player->order;
    }
}

bool wh_player_next(wh_player_t *player) {
    if (player->simulator.mark != WH_SIMULATOR_MARK) {
        player->status = player->status == WH_OK ? WH_STATUS_NOT_INITIALISED : player->status;
        return false;
    }
    if (player->status != WH_OK || player->track.slice >= player->run->slices) {
        return false;
    }
    take_rows(player);
    if (player->status != WH_OK) {
        return false;
    }
    ++player->track.slice;
    move_axes(player);
    note_axes(player);
    wh_command_from_track(&player->command, &player->cache, &player->track);
    bring_rest(player);
    player->status = wh_simulator_step(&player->simulator, &player->command, &player->state);
    return player->status == WH_OK;
}

bool wh_player_is_as_recorded(const wh_player_t *player) {
    return player->simulator.mark == WH_SIMULATOR_MARK && player->status == WH_OK &&
           player->track.slice == player->run->slices &&
           wh_simulator_hash(&player->simulator) == player->run->hash &&
           player->inputs == player->run->inputs;
}
