/* One trial of a study, by replaying the decisions of the run without errors or by running the script
 * whole. */
#ifndef WH_STUDY_TRIAL_H
#define WH_STUDY_TRIAL_H

#include "tally.h"

/* The place for checking collisions of a replayed trial: a world with the trial's stations. Only its events
 * are known. */
typedef struct {
    wh_part_t *parts;
    char (*names)[WH_PART_NAME_SIZE];
    bool *known; /* of parts, then of wafers */
    void *memory;
    size_t bytes; /* of it */
    wh_collision_t collision;
} wh_trial_world_t;

/* The data of a thread for its trials. Each thread has its own. */
typedef struct {
    const wh_study_t *study;
    wh_trial_cell_t trial_cell;
    wh_trial_room_t room;
    wh_wafer_t *wafers;
    wh_grips_room_t grips;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_simulator_t simulator;
    wh_outcome_t outcome;
    wh_script_run_t run; /* while a script runs whole */
    wh_script_run_options_t options;
    uint64_t hash; /* of the last state that a whole run ended in */
    /* Replays check collisions of things that stand or lie elsewhere than in the run without errors. The run
     * without errors must be ok, and only stations may be off. */
    bool looks_for_collisions;
    bool grips_alike; /* also, without that check, it had the events of that run: wafers go where they went
                       * there */
    bool ends_at_complaint; /* the rest after an event that is a complaint need not be replayed */
    wh_trial_world_t world;
} wh_worker_t;

/* To be closed. If there is no memory, the program ends. */
void wh_worker_open(wh_worker_t *worker, const wh_study_t *study);
void wh_worker_close(wh_worker_t *worker);

/* Plays a trial and adds its result. False when the script turned out not to be usable in it: `message`, of
 * WH_SANDBOX_MESSAGE_BYTES, then says why. */
bool wh_worker_play(wh_worker_t *worker, uint64_t trial, wh_tally_t *tally, char *message);

#endif
