/* A recorded run, read from an LCM event log: what a report shows of it.
 *
 * Commands come from WAFERHAND_MCS, everything else from WAFERHAND_CELL, WAFERHAND_COMMAND and
 * WAFERHAND_STATE: what was recorded, not what stepping it again would give (that is `waferhand replay`'s). A
 * log does not tell what a script expected, its cycles, and why the robot stood still: it counts as waiting
 * for vacuum if a valve is open and its sensor off, in another command than WAIT.
 */
#ifndef WH_LOG_LOG_RUN_H
#define WH_LOG_LOG_RUN_H

#include "../layout/collision.h"
#include "../record/recorder.h"
#include "../record/signals.h"
#include "log_layout.h"
#include "logfile.h"

#define WH_LOG_NOTE_BYTES 240

typedef struct {
    const char *path;
    size_t number; /* which run of the log, from 1; 0: the last */
    wh_log_layout_options_t layout;
} wh_log_run_options_t;

/* A command that began before its run's first slice. */
typedef struct {
    bool is_there;
    int line;
    char text[200];
} wh_log_begin_t;

/* A slice with which a command begins or ends. */
typedef struct {
    int64_t run, seq;
} wh_log_boundary_t;

/* Zero it to begin with, or leave it static; must not be moved. Read record, trace, notes and message. */
typedef struct {
    wh_log_run_options_t options;
    wh_log_t log;
    wh_log_layout_t cell, next_cell; /* of the run; and told since, for the next one */
    wh_recorder_t recorder;          /* of the run; without a record until it begins */
    wh_record_t record;
    wh_state_t state; /* the last one */
    wh_collision_t collision;
    wh_signals_t signals;
    wh_link_arrays_t arrays;
    wh_log_boundary_t *boundaries; /* sorted: messages of them may come late */
    size_t boundary_count, boundary_capacity;
    waferhand_command command; /* the last one */
    bool has_command;
    wh_log_begin_t begin;
    int64_t run, seq; /* of the last state */
    bool is_wanted;   /* that run */
    int64_t refused;  /* seq of the last refusal */
    size_t run_count;
    uint64_t hash;
    int64_t missed;
    size_t gaps;       /* stretches of slices that are not in the log */
    wh_command_t told; /* in the last slice: its number, axes and valves */
    char text[4][WH_LOG_NOTE_BYTES];
    const char *notes[4];
    size_t note_count;
    char message[800]; /* why there is nothing to show */
} wh_log_run_t;

/* Reads the whole log. False, and the reason in `message`, if the file cannot be read, is no log, or has no
 * such run. A log that is cut off or damaged is read up to there, and a note says so. To be closed in any
 * case. */
bool wh_log_run_read(wh_log_run_t *run, const wh_log_run_options_t *options);

void wh_log_run_close(wh_log_run_t *run);

#endif
