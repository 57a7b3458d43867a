/* Motion control in the host: what its Lua side (lua/mcs) stands on.
 *
 * Lua decides, this executes: it reads the layout, plans segments and plays them slice by slice against the
 * simulator, and has a recorder keep what comes of it. A slice is a command in and a state out, over a link:
 * of the cell motion control knows what the layout and the states tell. It reaches Lua as a table of
 * functions that only lua/mcs sees; scripts see the operator's words that lua/mcs/init.lua makes of them.
 */
#ifndef WH_MCS_MCS_H
#define WH_MCS_MCS_H

#include "../layout/collision.h"
#include "../record/recorder.h"
#include "../script/sandbox.h"
#include "../sim/played.h"
#include "decisions.h"
#include "rehearsal.h"
#include "trial_cell.h"

typedef struct wh_mcs wh_mcs_t;

/* Who else takes part in a run; each function may be null. */
typedef struct {
    /* Called once, after the cell was set up and found in reach and before the first slice: returns the link
     * that takes the place of the simulator in this process, or null if there is none, which ends the
     * script. */
    wh_link_t *(*connect)(void *user, wh_mcs_t *mcs);
    /* A command of the record begins (`ended` false) or has ended. */
    void (*watch)(void *user, const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended);
    /* Why the link answered a slice with this error, for its message: true until the next call. Null: the
     * error says it all. */
    const char *(*explain)(void *user, wh_status_t status);
    /* The last expectation of the record was added, or its last cycle. */
    void (*expected)(void *user, const wh_mcs_t *mcs);
    void (*cycle)(void *user, const wh_mcs_t *mcs);
    /* The record is closed: the run has ended, also by an error. Not called without a cell, nor at a
     * prompt. */
    void (*finished)(void *user, const wh_mcs_t *mcs);
    void *user;
} wh_mcs_partners_t;

/* Hears of each slice that was sent: the command, and the state that came back. state->status tells if it was
 * accepted. */
typedef void wh_slice_listener_t(void *user, const wh_command_t *command, const wh_state_t *state);

/* Who listens to a run, whoever its partners are; each function may be null. */
typedef struct {
    wh_slice_listener_t *slice;
    /* A command of the record begins or has ended. Called before the first slice. */
    void (*boundary)(void *user, const wh_layout_t *layout);
    void *user;
} wh_mcs_listener_t;

/* Who hears of slices: decisions, recorder, a collision check beside a simulator elsewhere, the run's
 * listener. */
#define WH_MCS_LISTENERS 5

/* A segment that was played, and the command of the record that asked for it (or WH_NONE). */
typedef struct {
    wh_segment_t segment;
    int64_t slices; /* that it took */
    bool ended;     /* not cut off */
    int32_t command;
} wh_kept_segment_t;

/* The cell in this process: its simulator, and the collision check of it. */
typedef struct {
    wh_simulator_t simulator; /* first: its link is the cell's */
    wh_collision_t collision;
    wh_trial_cell_t *trial; /* null: the cell is as its layout says */
} wh_local_cell_t;

/* Written by lib/mcs only, but for `partners`, `listener`, `keep_segments`, `trial`, `decisions`,
 * `limits_missed`, `most_missed` and `rehearsal.look_ahead`, which may be set between opening and the cell.
 * Must not be moved once opened. */
struct wh_mcs {
    const char *script; /* as the user gave it; borrowed */
    wh_sandbox_t *sandbox;

    /* The cell, from when the script names it. */
    const wh_layout_t *layout; /* null until then */
    const wh_layout_t *real;   /* the same, or with a trial's errors: what simulator and reports go by */
    wh_link_t *link;           /* the local cell's, or whoever stands in; null until connected */

    /* What is commanded and answered. */
    wh_track_t track;
    wh_command_t command;     /* the last one sent */
    wh_machine_cache_t cache; /* and what it was made of */
    wh_state_t state;         /* the answer to it */

    wh_rehearsal_t rehearsal;
    wh_vacuum_watch_t watch; /* of the running segment */
    int64_t stop_slice;      /* at which a STOP comes; INT64_MAX: none */
    bool stop_requested;     /* a STOP has come: see wh_mcs_stop */
    bool link_stopped;       /* the link has answered a slice with WH_STATUS_STOPPED */
    bool limits_missed;      /* the run fails if the simulator misses more slices than `most_missed` */
    int64_t most_missed;
    wh_fault_t faults[WH_FAULTS]; /* by slot, as the simulator has them or is about to */
    size_t fault_count;

    /* Who is told. */
    wh_recorder_t recorder;
    wh_mcs_partners_t partners;
    wh_mcs_listener_t listener;
    struct {
        wh_slice_listener_t *hear;
        void *user;
    } listeners[WH_MCS_LISTENERS];
    size_t listener_count;
    wh_decisions_t *decisions; /* keeps what is commanded and read back; null: nobody does */
    bool keep_segments;        /* collect what is played, for --segments */
    wh_kept_segment_t *segments;
    size_t segment_count, segment_capacity;
    wh_played_fault_t *kept_faults;
    size_t kept_fault_count, kept_fault_capacity;

    wh_local_cell_t local;
    const wh_trial_t *trial; /* of a study, whose errors the cell then has; null: as its layout says */
};

/* Opens the operator's words in a sandbox for one run of `script`. `mcs` and `record` must outlive the
 * sandbox. False, and the reason in `result`, if the sandbox has no room for it. */
bool wh_mcs_open(wh_mcs_t *mcs, wh_sandbox_t *sandbox, const char *script, wh_record_t *record,
                 wh_sandbox_result_t *result);

/* Leaves on the stack of L, within a protected call, what executes a typed line and what
 * completes one: two functions, see lua/mcs/prompt.lua and lua/mcs/completion.lua. */
void wh_mcs_push_prompt(lua_State *L);

/* A STOP, from within the link's exchange or between two commands: the running command ends with
 * WH_STATUS_STOPPED after this slice, the next one before its first. A script can catch that error. */
void wh_mcs_stop(wh_mcs_t *mcs);

/* Room for what wh_mcs_describe writes. */
#define WH_MCS_DESCRIPTION_BYTES 4096

/* What motion control does, as name=value with blanks between them, spelt as answers at the prompt are:
 * `phase`, idle or running, and the running `command`; `seq` and `time` (s) of the last slice; where the
 * robot's axes are commanded to, `theta` and `yaw` in degrees, `r` and `z` in mm; for each gripper the wafer
 * that it `holds`, as the last state tells; and `error`, the number of the last command's that failed in this
 * run, with its `error_name` and `error_command`, or 0. May be called from within the link's exchange. */
void wh_mcs_describe(const wh_mcs_t *mcs, char text[WH_MCS_DESCRIPTION_BYTES]);

/* The running command has ended with an error past all Lua. Without a running command nothing. */
void wh_mcs_cut_short(wh_mcs_t *mcs, wh_status_t error, const char *message);

/* Closes the record: wafers, slices, hash. The sandbox must still be there. */
void wh_mcs_finish(wh_mcs_t *mcs);

/* Frees what the run collected; the record is its owner's. */
void wh_mcs_close(wh_mcs_t *mcs);

#endif
