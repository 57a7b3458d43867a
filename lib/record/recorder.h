/* Keeps the record of a run as it goes on: for motion control that plays it, and for whoever follows it from
 * a log.
 *
 * Commands begin and end; in between each slice is counted for the running command, with its events. A
 * command that succeeded, and of which the cell had no complaint, has put the wafers that it let go and that
 * lie in a slot: see record/throughput.h.
 */
#ifndef WH_RECORD_RECORDER_H
#define WH_RECORD_RECORDER_H

#include "record.h"

/* One of several commands that run at once. */
typedef struct {
    int32_t command;   /* index in the record, or WH_NONE */
    wh_task_t task;    /* of its segment; `robot` only if the command has the robot */
    uint32_t grippers; /* bit g: what happens at gripper g is its */
} wh_recorder_part_t;

/* Of the script and its tasks. */
#define WH_RECORDER_PARTS 65

/* Set `layout` and `cell` once they are known, and `task` when a segment begins; the rest is only to be
 * read. */
typedef struct {
    wh_record_t *record;
    const wh_layout_t *layout; /* null: none yet */
    const wh_cell_t *cell;     /* where stations really stand, which a trial's errors may have moved */
    int32_t running;           /* index of the running command in the record, or WH_NONE */
    int32_t number;            /* of the task that goes on, whose command that is; 0: the script itself */
    int64_t slice;             /* the last one that was sent; 0 before the first */
    wh_task_t task;            /* of the running segment */
    /* Where several commands run at once, all of them, for each slice anew; none: `running` and `task` say
     * it. */
    wh_recorder_part_t parts[WH_RECORDER_PARTS];
    size_t part_count;
} wh_recorder_t;

/* Begins a record of `script`, of which a copy is kept. `record` must be all zero and outlive the
 * recorder. */
void wh_recorder_open(wh_recorder_t *recorder, wh_record_t *record, const char *script);

/* Simulated seconds so far; 0 without a layout. */
double wh_recorder_now(const wh_recorder_t *recorder);

/* A command begins; none may be running. It is valid until the next one begins. */
const wh_command_record_t *wh_recorder_begin(wh_recorder_t *recorder, int line, const char *text,
                                             double begin_s);

/* The running command has ended: with WH_OK, and `wafers` where they are, or with an error and its message.
 * Null if none was running. */
const wh_command_record_t *wh_recorder_end(wh_recorder_t *recorder, double end_s, wh_status_t error,
                                           const char *message, const wh_wafer_t wafers[]);

/* The task that goes on waits from now on for `what`, with the running command if there is one. Nothing if it
 * waits for that already. */
void wh_recorder_wait(wh_recorder_t *recorder, const char *what);

/* The task that goes on waits no more. What took no slice is not kept. */
void wh_recorder_go_on(wh_recorder_t *recorder);

/* The events of a slice or of its refusal. */
void wh_recorder_events(wh_recorder_t *recorder, const wh_state_t *state);

/* Counts a slice: what its time went into. Of the command it reads `seq` and the valves. */
void wh_recorder_slice(wh_recorder_t *recorder, const wh_command_t *command, const wh_state_t *state);

/* How a run ended that had a layout. */
typedef struct {
    const wh_wafer_t *wafers;
    uint64_t hash;
    int64_t missed;          /* slices that never reached the simulator */
    const wh_world_t *world; /* null: collisions were not looked for */
} wh_recorder_end_t;

/* Closes the record: verdict, slices, hash, wafers. `end` is not looked at without a layout. */
void wh_recorder_finish(wh_recorder_t *recorder, const wh_recorder_end_t *end);

#endif
