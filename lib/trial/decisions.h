/* The decisions of a run: everything that motion control commands, slice by slice, and everything that it
 * reads back.
 *
 * Motion control decides by what it reads: the vacuum sensors in a segment, which wafer a gripper holds,
 * whether a wafer lies where it is expected. If every such reading in a trial of a study is as in this run,
 * motion control would command the same in each slice. Then the simulator alone can play the trial, without
 * Lua: see wh_decisions_play. If a reading differs, motion control might decide otherwise, and the whole
 * script is run. The decisions are unfit if the script reads measured numbers (offset, proximity, MAP, ...)
 * or injects faults.
 */
#ifndef WH_TRIAL_DECISIONS_H
#define WH_TRIAL_DECISIONS_H

#include "../motion/track.h"
#include "trial_cell.h"

/* The most memory for the slices; a longer run is unfit. */
#define WH_DECISIONS_BYTES ((size_t)512 << 20)

/* The kind of reading, its index, and the answer. */
typedef enum {
    /* A segment begins: `index` is the gripper whose sensor it waits for, or WH_NONE. Bit g of `answer`:
     * gripper g may lose its wafer in it. */
    WH_DECISION_BEGIN,
    /* It has ended: `index` is the gripper that lost its wafer, or WH_NONE; `answer` 1: it ran to its end. */
    WH_DECISION_END,
    WH_DECISION_SENSOR, /* the sensor of gripper `index` */
    WH_DECISION_HELD,   /* the wafer that gripper `index` holds */
    WH_DECISION_HOLDER, /* the gripper that holds wafer `index` */
    WH_DECISION_CLAIM,  /* claim number `index`: the result of wh_decisions_judge */
    /* Slot number `index`: 1 if the wafer that was put there, or taken from there,
     * wh_decisions_is_elsewhere. */
    WH_DECISION_PUT,
    WH_DECISION_GET
} wh_decisions_kind_t;

/* A reading after slice `slice`. */
typedef struct {
    wh_decisions_kind_t kind;
    int32_t index, answer;
    int64_t slice;
} wh_decisions_entry_t;

/* A claim to judge: the wafer lies in this slot with this offset, mm, less than `height` above or below its
 * plane. */
typedef struct {
    int32_t wafer, station, slot;
    double dx, dy, tolerance, height;
} wh_decisions_claim_t;

/* A slot that a PUT put this wafer into, or a GET took one from with this gripper, by what they were told. */
typedef struct {
    int32_t wafer, gripper, station, slot;
} wh_decisions_asked_t;

/* A station that a robot went to, or asked the way to. */
typedef struct {
    int32_t station, robot;
} wh_decisions_visit_t;

/* Each once. */
typedef struct {
    wh_decisions_visit_t *items;
    size_t count, capacity;
} wh_decisions_visits_t;

/* The command to a gripper's valve from slice `slice` on. */
typedef struct {
    int64_t slice;
    int32_t valve;
} wh_decisions_valve_t;

/* A gripper's way in a stretch of slices, from the slice before it: the corners of a box around its
 * places, and its rotation. */
typedef struct {
    wh_vec3_t low, high;
    wh_mat3_t R; /* in the first slice */
    bool turns;  /* R is not the same in all slices */
} wh_decisions_way_t;

/* All zero before a run. Afterwards read-only, for any number of threads. */
typedef struct {
    const char *unfit; /* why the decisions cannot be played, a constant text; null: they can */
    size_t gripper_count, axis_count;
    int64_t slice_count;
    int64_t slice_capacity;
    wh_pose_t *poses;         /* gripper_count for each slice, slice 1 first */
    wh_real_t *axes;          /* axis_count for each slice */
    wh_decisions_way_t *ways; /* gripper_count for each stretch: see decisions_ways.h */
    wh_decisions_entry_t *entries;
    size_t entry_count, entry_capacity;
    wh_decisions_claim_t *claims;
    size_t claim_count, claim_capacity;
    wh_decisions_asked_t *asked;
    size_t asked_count, asked_capacity;
    wh_decisions_visits_t visits;
    int32_t *looked; /* wafers whose place was read, some more than once */
    size_t looked_count, looked_capacity;
    wh_decisions_valve_t *valves[WH_GRIPPERS]; /* where they change */
    size_t valve_count[WH_GRIPPERS], valve_capacity[WH_GRIPPERS];
} wh_decisions_t;

/* Finds the gripper that lost its wafer during a segment, from the vacuum sensors. */
typedef struct {
    uint32_t watched; /* bit g: gripper g's sensor was on before, and its wafer could be lost */
    uint32_t was_off; /* bit g: it was off in a slice since */
} wh_vacuum_watch_t;

void wh_vacuum_watch_slice(wh_vacuum_watch_t *watch, uint32_t sensors);

/* The first watched gripper whose sensor went off while its valve is commanded open, or WH_NONE. */
int32_t wh_vacuum_watch_lost(const wh_vacuum_watch_t *watch, const int32_t valves[], size_t gripper_count);

/* These functions keep decisions; they do nothing if `decisions` is null. They end the program if
 * out of memory. */
void wh_decisions_slice(wh_decisions_t *decisions, const wh_command_t *command);
void wh_decisions_read(wh_decisions_t *decisions, wh_decisions_kind_t kind, int32_t index, int32_t answer);
void wh_decisions_claim(wh_decisions_t *decisions, const wh_decisions_claim_t *claim, int32_t verdict);

void wh_decisions_asked(wh_decisions_t *decisions, wh_decisions_kind_t kind,
                        const wh_decisions_asked_t *asked, bool is_elsewhere);

/* A robot asked where this station is; the place of this wafer was read. Whoever reads the decisions then
 * knows what the run had to do with. */
void wh_decisions_visit(wh_decisions_t *decisions, int32_t station, int32_t robot);
void wh_decisions_look(wh_decisions_t *decisions, int32_t wafer);

/* The script has read something that a trial's errors change: `what` is a constant text. */
void wh_decisions_measured(wh_decisions_t *decisions, const char *what);

/* 0: the wafer does not lie in that slot; 1: it does; 2: it does, with that offset. */
int32_t wh_decisions_judge(const wh_decisions_claim_t *claim, const wh_cell_t *cell,
                           const wh_wafer_t wafers[]);

/* True if a wafer of this pose lies in another slot and not also in that one (stations may overlap). A null
 * pose is not known. */
bool wh_decisions_is_elsewhere(const wh_decisions_asked_t *asked, const wh_cell_t *cell,
                               const wh_pose_t *base_from_wafer);

void wh_decisions_free(wh_decisions_t *decisions);

/* ------------------------------------------------------------------------------------------------ Playing */

/* Gets the events of a slice of a trial that is played. Returns false when it has seen enough. */
typedef bool wh_decisions_watch_t(void *user, const wh_event_t events[], size_t count);

/* Plays the decisions of a run against the simulator of a trial in the same layout. The simulator was
 * initialised with `trial_cell` and not stepped. True if every reading is as in the run. The simulator is
 * then in the state in which running the script for that trial would leave it, and `watch` has seen each
 * event. False if a reading differs, if the simulator refused a slice, or if `watch` has seen enough: the
 * result is then void. Slices in which nothing can happen are skipped, with a plain vacuum, no pads, no
 * faults and no observer of the simulator. In these slices no valve changes, and each gripper is closed or
 * holds a wafer that goes through no slot (wh_cell_passes). */
bool wh_decisions_play(const wh_decisions_t *decisions, const wh_trial_cell_t *trial_cell,
                       wh_simulator_t *simulator, wh_decisions_watch_t *watch, void *user);

#endif
