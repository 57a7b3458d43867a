#include "trial.h"

#include <stdlib.h>
#include <string.h>

#include "../bodies/parts.h"
#include "../layout/doors.h"
#include "../math/hash.h"
#include "../text/array.h"

void wh_worker_open(wh_worker_t *worker, const wh_study_t *study) {
    const wh_layout_t *layout = study->layout;
    memset(worker, 0, sizeof *worker);
    worker->study = study;
    worker->options = study->run;
    worker->options.unread_parameters = true;
    worker->room.places = wh_array_new(layout->station_count, sizeof *worker->room.places);
    worker->room.start = wh_array_new(layout->wafer_count, sizeof *worker->room.start);
    worker->room.rims = wh_array_new(layout->wafer_count, sizeof *worker->room.rims);
    worker->room.rim_of = wh_array_new(layout->wafer_count, sizeof(const wh_rim_t *));
    worker->room.edge_wafers = wh_array_new(layout->wafer_count, sizeof *worker->room.edge_wafers);
    worker->room.supports = wh_array_new(wh_layout_count_supports(layout), sizeof *worker->room.supports);
    worker->wafers = wh_array_new(layout->wafer_count, sizeof *worker->wafers);
    worker->grips.seen = wh_array_new(wh_layout_seen(layout), sizeof *worker->grips.seen);
}

void wh_worker_close(wh_worker_t *worker) {
    free(worker->room.places);
    free(worker->room.start);
    free(worker->room.rims);
    free(worker->room.rim_of);
    free(worker->room.edge_wafers);
    free(worker->room.supports);
    free(worker->wafers);
    free(worker->grips.seen);
    free(worker->world.parts);
    free(worker->world.names);
    free(worker->world.known);
    free(worker->world.memory);
}

static void begin_trial(wh_worker_t *worker, uint64_t trial) {
    wh_outcome_t *outcome = &worker->outcome;
    outcome->trial = trial;
    outcome->whole = outcome->complained = false;
    memset(outcome->events, 0, sizeof outcome->events);
}

/* ------------------------------------------------------------------------------------------ the decisions */

static bool watch(void *user, const wh_event_t events[], size_t count) {
    wh_worker_t *worker = user;
    wh_outcome_t *outcome = &worker->outcome;
    for (size_t i = 0; i < count; ++i) {
        ++outcome->events[events[i].kind];
        outcome->complained = outcome->complained || wh_record_is_complaint(events[i].kind);
    }
    return !outcome->complained || !worker->ends_at_complaint;
}

/* True if the station is where the layout has it, to the last bit. */
static bool stands_as_taught(const wh_worker_t *worker, int32_t station) {
    const wh_pose_t *real = &worker->room.places[station].base_from_station;
    const wh_pose_t *taught = &worker->study->layout->places[station].base_from_station;
    return wh_hash_pose(WH_HASH_START, real) == wh_hash_pose(WH_HASH_START, taught);
}

static bool part_is_known(const wh_worker_t *worker, const wh_part_t *part) {
    const wh_layout_t *layout = &worker->trial_cell.layout;
    const bool is_chuck = part->kind == WH_PART_CHUCK;
    const bool is_fixed = part->kind == WH_PART_FIXED || part->kind == WH_PART_LEDGE;
    const int32_t station = is_chuck   ? layout->grippers[part->owner].station
                            : is_fixed ? part->owner
                                       : WH_NONE;
    return station == WH_NONE || stands_as_taught(worker, station);
}

/* A wafer stays where it is let go, unless it is moved there: then its error moves with it. */
static bool wafers_stay(const wh_layout_t *layout) {
    const wh_physics_t *physics = &layout->physics;
    return !layout->grasp.seat && !layout->cell.settle && physics->vacuum.vent <= 0 &&
           physics->pads.mass <= 0;
}

static void find_known(wh_worker_t *worker) {
    const wh_layout_t *layout = &worker->trial_cell.layout;
    const wh_world_config_t *world = &layout->world;
    const bool stay = worker->grips_alike && !worker->trial_cell.chucks_moved && wafers_stay(layout);
    for (size_t i = 0; i < world->part_count; ++i) {
        worker->world.known[i] = part_is_known(worker, &world->parts[i]);
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        worker->world.known[world->part_count + w] =
            stay && stands_as_taught(worker, layout->wafers[w].station);
    }
}

static void set_up_world(wh_worker_t *worker) {
    wh_trial_world_t *room = &worker->world;
    wh_layout_t *layout = &worker->trial_cell.layout;
    const size_t most = layout->world.part_count + layout->station_count;
    if (!room->parts) {
        room->parts = wh_array_new(most, sizeof *room->parts);
        room->names = wh_array_new(most, sizeof *room->names);
        room->known = wh_array_new(most + layout->wafer_count, sizeof *room->known);
    }
    wh_layout_move_world(layout, room->parts, room->names);
    find_known(worker);
    layout->world.known = room->known;
    const size_t bytes = wh_collision_bytes(layout);
    if (bytes > room->bytes) {
        free(room->memory);
        room->memory = wh_array_new(bytes, 1);
        room->bytes = bytes;
    }
    wh_collision_attach(&room->collision, layout, &worker->simulator, room->memory);
}

static bool set_up(wh_worker_t *worker) {
    const wh_layout_t *layout = &worker->trial_cell.layout;
    const wh_grasp_storage_t storage = {
        worker->wafers, layout->wafer_count, worker->grippers, layout->machine.gripper_count, NULL, 0};
    memcpy(worker->wafers, worker->room.start, layout->wafer_count * sizeof *worker->wafers);
    return wh_simulator_init(&worker->simulator, &layout->grasp, &storage, &layout->cell) == WH_OK &&
           wh_simulator_set_physics(&worker->simulator, &layout->physics) == WH_OK &&
           wh_layout_give_doors(layout, &worker->simulator) == WH_OK &&
           wh_layout_give_grips(layout, &worker->simulator, &worker->grips) == WH_OK;
}

static bool met_but_for_complaints(const wh_record_t *record) {
    bool met = !record->failure;
    for (size_t i = 0; i < record->expectation_count; ++i) {
        met = met && record->expectations[i].ok;
    }
    return met;
}

static void look_at_wafers(wh_worker_t *worker) {
    for (size_t i = 0; i < worker->study->wafer_count; ++i) {
        const int32_t w = worker->study->wafers[i].wafer;
        wh_study_wafer_t *wafer = &worker->outcome.wafers[i];
        wafer->wafer = w;
        wafer->holder = worker->wafers[w].holder;
        if (!wh_cell_locate(&worker->simulator.cell, &worker->wafers[w].base_from_wafer, &wafer->place)) {
            wafer->place = (wh_place_t){.station = WH_NONE};
        }
    }
}

/* False if the trial reads back values that the decisions do not have: nothing is then counted. */
static bool replay(wh_worker_t *worker, uint64_t trial, wh_tally_t *tally) {
    const wh_study_t *study = worker->study;
    const wh_record_t *record = &study->nominal.record;
    const wh_trial_t name = {study->seed, trial};
    begin_trial(worker, trial);
    wh_trial_cell_fill(&worker->trial_cell, study->layout, &name, &worker->room);
    if (!set_up(worker)) {
        return false;
    }
    if (worker->looks_for_collisions) {
        set_up_world(worker);
    }
    const bool played =
        wh_decisions_play(&study->decisions, &worker->trial_cell, &worker->simulator, watch, worker);
    if (!played && !(worker->outcome.complained && worker->ends_at_complaint)) {
        return false;
    }
    worker->outcome.record = record;
    worker->outcome.met = met_but_for_complaints(record) && !worker->outcome.complained;
    look_at_wafers(worker);
    wh_tally_add(tally, study, &worker->outcome);
    return true;
}

/* --------------------------------------------------------------------------------------------- the script */

static void take_record(wh_worker_t *worker, const wh_record_t *record) {
    wh_outcome_t *outcome = &worker->outcome;
    outcome->record = record;
    outcome->met = record->ok;
    outcome->whole = true;
    for (size_t i = 0; i < record->event_count; ++i) {
        ++outcome->events[record->events[i].event.kind];
    }
    for (size_t i = 0; i < worker->study->wafer_count; ++i) {
        const int32_t w = worker->study->wafers[i].wafer;
        outcome->wafers[i] = (wh_study_wafer_t){w, record->wafers[w].holder, record->wafers[w].place};
    }
}

static bool run_whole(wh_worker_t *worker, uint64_t trial, wh_tally_t *tally, char *message) {
    const wh_trial_t name = {worker->study->seed, trial};
    /* Errors by name are given, not drawn: without any it is the plain run. */
    worker->options.trial = worker->options.errors ? NULL : &name;
    begin_trial(worker, trial);
    const wh_script_run_outcome_t outcome = wh_script_run(&worker->run, &worker->options);
    const bool usable = outcome != WH_RUN_BAD_INPUT && worker->run.record.wafers;
    if (usable) {
        take_record(worker, &worker->run.record);
        wh_tally_add(tally, worker->study, &worker->outcome);
        worker->hash = worker->run.record.hash;
    } else {
        memcpy(message, worker->run.message, WH_SANDBOX_MESSAGE_BYTES);
    }
    wh_script_run_close(&worker->run);
    return usable;
}

bool wh_worker_play(wh_worker_t *worker, uint64_t trial, wh_tally_t *tally, char *message) {
    return (!worker->study->whole && replay(worker, trial, tally)) ||
           run_whole(worker, trial, tally, message);
}
