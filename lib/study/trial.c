#include "trial.h"

#include <stdlib.h>
#include <string.h>

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
    worker->wafers = wh_array_new(layout->wafer_count, sizeof *worker->wafers);
}

void wh_worker_close(wh_worker_t *worker) {
    free(worker->room.places);
    free(worker->room.start);
    free(worker->room.rims);
    free(worker->room.rim_of);
    free(worker->wafers);
}

static void begin(wh_worker_t *worker, uint64_t trial) {
    wh_outcome_t *outcome = &worker->outcome;
    outcome->trial = trial;
    outcome->whole = outcome->complained = false;
    memset(outcome->events, 0, sizeof outcome->events);
}

/* ------------------------------------------------------------------------------------------ the decisions */

static void watch(void *user, const wh_event_t events[], size_t count) {
    wh_outcome_t *outcome = user;
    for (size_t i = 0; i < count; ++i) {
        ++outcome->events[events[i].kind];
        outcome->complained = outcome->complained || wh_record_is_complaint(events[i].kind);
    }
}

static bool set_up(wh_worker_t *worker) {
    const wh_layout_t *layout = &worker->trial_cell.layout;
    const wh_grasp_storage_t storage = {
        worker->wafers, layout->wafer_count, worker->grippers, layout->machine.gripper_count, NULL, 0};
    memcpy(worker->wafers, worker->room.start, layout->wafer_count * sizeof *worker->wafers);
    return wh_simulator_init(&worker->simulator, &layout->grasp, &storage, &layout->cell) == WH_OK &&
           wh_simulator_set_physics(&worker->simulator, &layout->physics) == WH_OK;
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

/* False if the trial reads back what the decisions have not: nothing is then counted. */
static bool replay(wh_worker_t *worker, uint64_t trial, wh_tally_t *tally) {
    const wh_study_t *study = worker->study;
    const wh_record_t *record = &study->nominal.record;
    const wh_trial_t name = {study->seed, trial};
    begin(worker, trial);
    wh_trial_cell_fill(&worker->trial_cell, study->layout, &name, &worker->room);
    if (!set_up(worker) || !wh_decisions_play(&study->decisions, &worker->trial_cell, &worker->simulator,
                                              watch, &worker->outcome)) {
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
    worker->options.trial = &name;
    begin(worker, trial);
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
