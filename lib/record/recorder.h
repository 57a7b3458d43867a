/* Keeps the record of a run as it goes on, for motion control that plays it, and for a reader of its log.
 *
 * Commands begin and end; between them each slice is counted for the running command, with its events. A
 * command that succeeded without complaint of the cell has put the wafers that it released and that lie in
 * a slot: see record/throughput.h.
 */
#ifndef WH_RECORD_RECORDER_H
#define WH_RECORD_RECORDER_H

#include "record.h"

/* One of several commands that run at once. */
typedef struct {
    int32_t command;   /* index in the record, or WH_NONE */
    wh_task_t task;    /* the task of its segment; `robot` only if the command has the robot */
    uint32_t grippers; /* bit g: events at gripper g belong to it */
} wh_recorder_part_t;

/* For the script and its tasks. */
#define WH_RECORDER_PARTS 65

/* The sum of the last slice's parts: most slices have the parts and wafers of the one before. */
typedef struct {
    size_t count; /* 0: not known */
    wh_recorder_part_t parts[WH_RECORDER_PARTS];
    uint8_t shares[WH_RECORDER_PARTS]; /* that of each part's command */
    int32_t held[WH_GRIPPERS];
    wh_task_t all;
} wh_recorder_joined_t;

/* Set `layout` and `cell` once they are known, and `task` when a segment begins; only read the rest. */
typedef struct {
    wh_record_t *record;
    const wh_layout_t *layout; /* null: none yet */
    const wh_cell_t *cell;     /* the true places of stations, which a trial's errors may have moved */
    int32_t running;           /* index of the running command in the record, or WH_NONE */
    int32_t number;            /* of the running task, which has that command; 0: the script itself */
    int64_t slice;             /* the last slice that was sent; 0 before the first */
    wh_task_t task;            /* of the running segment */
    /* All commands that run at once, set again for each slice; if none, `running` and `task` are used. */
    wh_recorder_part_t parts[WH_RECORDER_PARTS];
    size_t part_count;
    wh_recorder_joined_t joined;
} wh_recorder_t;

/* Begins a record of `script`, and keeps a copy of that text. `record` must be all zero and outlive the
 * recorder. */
void wh_recorder_open(wh_recorder_t *recorder, wh_record_t *record, const char *script);

/* Simulated seconds so far; 0 without a layout. */
double wh_recorder_now(const wh_recorder_t *recorder);

/* Begins a command; none may be running. The result is valid until the next command begins. */
const wh_command_record_t *wh_recorder_begin(wh_recorder_t *recorder, int line, const char *text,
                                             double begin_s);

/* Ends the running command: with WH_OK and the present `wafers`, or with an error and its message. Returns
 * null if none was running. */
const wh_command_record_t *wh_recorder_end(wh_recorder_t *recorder, double end_s, wh_status_t error,
                                           const char *message, const wh_wafer_t wafers[]);

/* The running task waits from now on for `what`, with its running command if there is one. It does nothing
 * if the task waits for that already. */
void wh_recorder_wait(wh_recorder_t *recorder, const char *what);

/* The running task no longer waits. A wait without a slice is not kept. */
void wh_recorder_go_on(wh_recorder_t *recorder);

/* Adds the events of a slice or of its refusal. */
void wh_recorder_events(wh_recorder_t *recorder, const wh_state_t *state);

/* Counts a slice in its share of time. It reads the command's `seq` and valves only. */
void wh_recorder_slice(wh_recorder_t *recorder, const wh_command_t *command, const wh_state_t *state);

/* Counts so many slices more, which are like the last one and were left out. */
void wh_recorder_repeat(wh_recorder_t *recorder, int64_t slices, const wh_state_t *state);

/* The end of a run with a layout. */
typedef struct {
    const wh_wafer_t *wafers;
    uint64_t hash;
    int64_t missed;          /* slices that never reached the simulator */
    const wh_world_t *world; /* null: collisions were not checked */
} wh_recorder_end_t;

/* Closes the record: verdict, slices, hash, wafers. `end` is ignored without a layout. */
void wh_recorder_finish(wh_recorder_t *recorder, const wh_recorder_end_t *end);

#endif
