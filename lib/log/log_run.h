/* A recorded run, read from an LCM event log, with the data for a report.
 *
 * Commands, expectations, cycles and the verdict come from WAFERHAND_MCS. They are ordered by the slices
 * that they name, not by their places in the log. Everything else comes from the slices' states, in the
 * order of a replay (log/replay.h): commands beside their states, whichever came first. A log does not tell
 * why the robot stood still. It counts as waiting for vacuum if, within one command, a valve has opened
 * since an axis other than Z moved. A log also does not tell the known direction of a notch: centrings on
 * the way are estimated again without it (record/centrings.h).
 */
#ifndef WH_LOG_LOG_RUN_H
#define WH_LOG_LOG_RUN_H

#include "../layout/collision.h"
#include "../record/recorder.h"
#include "../record/signals.h"
#include "../wire/told_layout.h"
#include "reading.h"

#define WH_LOG_NOTE_BYTES 240
#define WH_LOG_NOTES 12

/* Gets each accepted slice of the run, in order. `axes` has the machine's axis_count numbers; null if
 * they are not known. `hash` is the state's. All of it is valid until the call returns. */
typedef void wh_log_run_listener_t(void *user, const wh_layout_t *layout, const double axes[],
                                   const wh_state_t *state, uint64_t hash);

typedef struct {
    const char *path;
    const char *const *then; /* the logs after it: log/log_files.h */
    size_t then_count;
    bool is_alone; /* only this part of a recording in parts */
    size_t number; /* the number of the run among those with slices, from 1; 0: the last */
    wh_told_layout_options_t layout;
    bool only_slices; /* for the listener and the verdict alone: no record, signals and notes */
    wh_log_run_listener_t *listener; /* null: no listener */
    void *user;
} wh_log_run_options_t;

/* The activity of a task of the script, or of the script itself, from the messages. */
typedef struct {
    int32_t task;            /* its number */
    int32_t running;         /* index of its command in the record, or WH_NONE */
    uint32_t axes, grippers; /* bits: the command's mechanisms */
    bool has_opened_valve;   /* one of these grippers' valves, in the running command, since they were
                              * carried */
} wh_log_lane_t;

/* A message of motion control about a run. */
typedef struct {
    waferhand_mcs message;
    size_t order; /* in the log */
} wh_log_told_t;

/* Messages of motion control, sorted by their slices, and how the run ended by them. */
typedef struct {
    wh_log_told_t *items;
    size_t count, capacity, next;
    wh_run_told_t outcome;
    int32_t last_expectation, last_cycle, last_station; /* the highest numbers in them */
} wh_log_told_list_t;

/* The slices that were taken. */
typedef struct {
    bool is_any;
    int64_t seq; /* of the last one */
    uint64_t hash;
    int64_t missed;
    size_t gaps;           /* the number of stretches of slices that are not in the log */
    wh_command_t last;     /* the last one: its number, axes and valves */
    bool has_opened_valve; /* in the running command, since an axis other than Z moved */
} wh_log_taken_t;

/* Passes through beams of the grippers that had a wafer when beams were last armed. */
typedef struct {
    wh_pass_t of[WH_GRIPPERS];
    bool are_any;    /* there may be some */
    uint32_t number; /* of that arming */
} wh_log_passes_t;

/* Notes, in words. */
typedef struct {
    char room[WH_LOG_NOTES][WH_LOG_NOTE_BYTES];
    const char *texts[WH_LOG_NOTES];
    size_t count;
} wh_log_notes_t;

/* Zero it at first, or leave it static; must not be moved. Read record, signals, notes, worth and message. */
typedef struct {
    wh_log_run_options_t options;
    wh_log_t log;
    wh_replay_t replay;
    wh_reading_t reading;
    size_t file_count;
    wh_link_identity_t *runs;
    size_t run_count, run_capacity;
    const wh_link_identity_t *wanted;
    wh_log_told_list_t told;
    wh_told_layout_t cell;
    wh_recorder_t recorder;
    wh_record_t record;
    wh_state_t state; /* the last one */
    wh_collision_t collision;
    wh_signals_t signals;
    wh_link_arrays_t arrays;
    wh_log_taken_t taken;
    wh_log_lane_t lanes[WH_RECORDER_PARTS]; /* once there are tasks, in the order of their first messages */
    size_t lane_count;
    wh_log_passes_t passes;
    wh_log_notes_t notes;
    char reason[WH_READING_REASON]; /* the reason of the log's verdict */
    wh_record_log_t worth;          /* the record's `log` */
    char message[1200];             /* the reason why there is nothing to show */
} wh_log_run_t;

/* Reads the whole log. False, and the reason in `message`, if the file cannot be read, is not a log, or has
 * no such run, or the layout that the options name is not its layout. Notes list damaged and missing parts.
 * The record's `log` has the verdict of a replay of the whole log (wh_reading_judge, not lenient). The record
 * says that the run passed only if the log tells it and the verdict is WH_READING_SAME: else it is untold.
 * Close it in either case. */
bool wh_log_run_read(wh_log_run_t *run, const wh_log_run_options_t *options);

/* The end of the last slice of a run that was read, s. */
static inline double wh_log_run_end(const wh_log_run_t *run) {
    return (double)(run->taken.seq * run->cell.layout->slice_us) / 1e6;
}

/* True if the first or the last part of a recording in parts was not read. */
static inline bool wh_log_run_is_part(const wh_log_run_t *run) {
    const wh_replay_recording_t *recording = &run->replay.recording;
    return recording->first_part > 1 || recording->closed == WH_RECORDING_GOES_ON;
}

void wh_log_run_close(wh_log_run_t *run);

#endif
