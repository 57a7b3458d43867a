/* The decisions of a run: what motion control commands, slice by slice, and all that it reads back.
 *
 * Motion control decides by what it reads: the vacuum sensors in a segment, which wafer a gripper holds, if a
 * wafer lies where it is expected. If every such reading in a trial of a study is as it was in this run,
 * motion control would command the same in each slice. Then the simulator alone can play the trial, without
 * Lua: see wh_decisions_play. If a reading differs, motion control might go another way, and the script is
 * run whole. A script that reads measured numbers (offset, proximity, MAP, ...) or makes faults on purpose
 * has decisions that are unfit for that.
 */
#ifndef WH_MCS_DECISIONS_H
#define WH_MCS_DECISIONS_H

#include "../motion/track.h"
#include "trial_cell.h"

/* So much memory the slices may take; a longer run is unfit. */
#define WH_DECISIONS_BYTES ((size_t)512 << 20)

/* What was read, of whom, and the answer. */
typedef enum {
    /* A segment begins: `index` is the gripper whose sensor it waits for, or WH_NONE; bit g of `answer`:
     * gripper g may lose its wafer in it. */
    WH_DECISION_BEGIN,
    /* It has ended: `index` is the gripper that lost its wafer, or WH_NONE; `answer` 1: it ran to its end. */
    WH_DECISION_END,
    WH_DECISION_SENSOR, /* the sensor of gripper `index` */
    WH_DECISION_HELD,   /* the wafer that gripper `index` holds */
    WH_DECISION_HOLDER, /* the gripper that holds wafer `index` */
    WH_DECISION_CLAIM   /* claim number `index`: what wh_decisions_judge says */
} wh_decisions_kind_t;

/* What was read after slice `slice`. */
typedef struct {
    wh_decisions_kind_t kind;
    int32_t index, answer;
    int64_t slice;
} wh_decisions_entry_t;

/* A claim to be judged: the wafer lies in this slot with this offset, mm, less than `height` above its plane
 * or below. */
typedef struct {
    int32_t wafer, station, slot;
    double dx, dy, tolerance, height;
} wh_decisions_claim_t;

/* From slice `slice` on a gripper's valve is told this. */
typedef struct {
    int64_t slice;
    int32_t valve;
} wh_decisions_valve_t;

/* All zero before a run. Afterwards only to be read, by any number of threads. */
typedef struct {
    const char *unfit; /* why they cannot be played, a constant text; null: they can */
    size_t gripper_count, axis_count;
    int64_t slice_count;
    int64_t slice_capacity;
    wh_pose_t *poses; /* gripper_count for each slice, slice 1 first */
    wh_real_t *axes;  /* axis_count for each slice */
    wh_decisions_entry_t *entries;
    size_t entry_count, entry_capacity;
    wh_decisions_claim_t *claims;
    size_t claim_count, claim_capacity;
    wh_decisions_valve_t *valves[WH_GRIPPERS]; /* where they change */
    size_t valve_count[WH_GRIPPERS], valve_capacity[WH_GRIPPERS];
} wh_decisions_t;

/* Which gripper lost its wafer during a segment, as its vacuum sensor tells. */
typedef struct {
    uint32_t watched; /* bit g: gripper g's sensor was on before, and its wafer could be lost */
    uint32_t was_off; /* bit g: it was off in a slice since */
} wh_vacuum_watch_t;

void wh_vacuum_watch_slice(wh_vacuum_watch_t *watch, uint32_t sensors);

/* The first of the watched whose sensor went off though its valve is told to be open, or WH_NONE. */
int32_t wh_vacuum_watch_lost(const wh_vacuum_watch_t *watch, const int32_t valves[], size_t gripper_count);

/* Keeping; all of these do nothing if `decisions` is null. They end the program if out of memory. */
void wh_decisions_slice(wh_decisions_t *decisions, const wh_command_t *command);
void wh_decisions_read(wh_decisions_t *decisions, wh_decisions_kind_t kind, int32_t index, int32_t answer);
void wh_decisions_claim(wh_decisions_t *decisions, const wh_decisions_claim_t *claim, int32_t verdict);

/* The script has read something that a trial's errors change: `what` is a constant text. */
void wh_decisions_measured(wh_decisions_t *decisions, const char *what);

/* 0: the wafer does not lie in that slot; 1: it does; 2: with that offset, too. */
int32_t wh_decisions_judge(const wh_decisions_claim_t *claim, const wh_cell_t *cell,
                           const wh_wafer_t wafers[]);

void wh_decisions_free(wh_decisions_t *decisions);

/* ------------------------------------------------------------------------------------------------ Playing */

/* What happened in a trial that is played: the events of a slice. False: enough was seen. */
typedef bool wh_decisions_watch_t(void *user, const wh_event_t events[], size_t count);

/* Plays the decisions of a run against the simulator of a trial in the same layout, which was initialised
 * with `trial_cell` and not stepped. True if all that is read back is as it was in the run: the simulator is
 * then in the very state in which running the script for that trial would leave it, and `watch` has seen each
 * event. False if something was read differently, if the simulator refused a slice, or if enough was seen:
 * all is then void. Slices in which nothing can happen are skipped: with a plain vacuum, no pads, no faults
 * and nobody looking, those in which each gripper keeps its valve and either is closed or holds a wafer. */
bool wh_decisions_play(const wh_decisions_t *decisions, const wh_trial_cell_t *trial_cell,
                       wh_simulator_t *simulator, wh_decisions_watch_t *watch, void *user);

#endif
