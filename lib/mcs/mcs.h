/* Motion control in the host: what its Lua side (lua/mcs) stands on.
 *
 * Lua decides, this executes: it reads the layout, plans segments and plays them slice by slice against the
 * simulator, and has a recorder keep what comes of it. A slice is a command in and a state out, over a link:
 * of the cell motion control knows what the layout and the states tell. It reaches Lua as a table of
 * functions that only lua/mcs sees; scripts see the operator's words that lua/mcs/init.lua makes of them.
 */
#ifndef WH_MCS_MCS_H
#define WH_MCS_MCS_H

#include "../align/teaching.h"
#include "../layout/collision.h"
#include "../record/recorder.h"
#include "../script/sandbox.h"
#include "../sim/played.h"
#include "decisions.h"
#include "rehearsal.h"
#include "trial_cell.h"

typedef struct wh_mcs wh_mcs_t;

/* Room for what a partner saves. */
#define WH_MCS_SAVED_BYTES ((size_t)1 << 17)

/* Who else takes part in a run; each function may be null. */
typedef struct {
    /* Called once, after the cell was set up and found in reach and before the first slice: returns the link
     * that takes the place of the simulator in this process, or null if there is none, which ends the
     * script. */
    wh_link_t *(*connect)(void *user, wh_mcs_t *mcs);
    /* A command of the record begins (`ended` false) or has ended. */
    void (*watch)(void *user, const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended);
    /* A segment is about to begin: what is owed of a slice that was given up is waited for. With anything but
     * WH_OK no slice of the segment may go out. */
    wh_status_t (*resume)(void *user);
    /* The slice that goes out next is its segment's last: what comes next is decided by its state, so a link
     * waits for that, in a free run, too. */
    void (*await)(void *user);
    /* The last slice that has gone out and was not refused. Null: the last that was answered with WH_OK. */
    int64_t (*reached)(void *user);
    /* False while no state has come: nothing was seen of the cell yet. Null: there is always one. */
    bool (*is_heard)(void *user);
    /* Why the link answered a slice with this error, for its message: true until the next call. Null: the
     * error says it all. */
    const char *(*explain)(void *user, wh_status_t status);
    /* What the link's other side is after the last slice, as bytes: how many, 0 if that is not known. Null:
     * such a link cannot tell. Not during an exchange. */
    size_t (*save)(void *user, uint8_t bytes[WH_MCS_SAVED_BYTES]);
    /* Makes the link's other side that again, and `state` its answer, without events. With anything but WH_OK
     * it is as it was. */
    wh_status_t (*restore)(void *user, const uint8_t bytes[], size_t size, wh_state_t *state);
    /* The last expectation of the record was added, or its last cycle. */
    void (*expected)(void *user, const wh_mcs_t *mcs);
    void (*cycle)(void *user, const wh_mcs_t *mcs);
    /* The scan in mcs->edge has ended. */
    void (*edge)(void *user, const wh_mcs_t *mcs);
    /* mcs->centring is what a pass through beams has told. */
    void (*centring)(void *user, const wh_mcs_t *mcs);
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

/* Who hears of slices: decisions, recorder, the collected scan, what STATUS tells and a collision check
 * beside a simulator elsewhere, the run's listener. */
#define WH_MCS_LISTENERS 6

/* How many lines of a script are told that led to a command within functions. */
#define WH_MCS_CALLERS 4

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

/* How many slices may be on their way in a free run for STATUS to tell the last one that has come back. */
#define WH_MCS_SENT 256

/* What STATUS tells of a slice. */
typedef struct {
    int64_t seq, utime; /* us */
    wh_real_t axes[WH_ROBOT_AXES];
    int32_t held[WH_GRIPPERS]; /* the wafer, or WH_NONE */
} wh_mcs_seen_t;

/* Where the axes were commanded to in a slice; seq 0: none. */
typedef struct {
    int64_t seq;
    wh_real_t axes[WH_ROBOT_AXES];
} wh_mcs_sent_t;

/* Room for the text of a command that is held, which is cut to that, and for the phase's name. */
#define WH_MCS_HELD_BYTES 1001
#define WH_MCS_PHASE_BYTES 12

/* A command that has come to a phase of its way and stands still there, between two commands. */
typedef struct {
    char command[WH_MCS_HELD_BYTES]; /* empty: none */
    char phase[WH_MCS_PHASE_BYTES];  /* "extended" or "up" */
} wh_mcs_held_t;

/* A scan of a wafer's edge, as the states have brought it. */
typedef struct {
    wh_scan_order_t order;
    int64_t seq;             /* of the last state that was heard */
    uint32_t number, before; /* of the last scan that was heard of, now and when this one was armed */
    int32_t *samples;        /* as many as were ordered; null: none was */
    int32_t taken;           /* so many are there */
    int32_t missed;          /* of these, for no state brought them: WH_NONE */
    bool armed;              /* more are to come */
} wh_mcs_edge_t;

/* A blade's pass through the beams at a door, as the states have brought it. */
typedef struct {
    wh_latch_order_t order; /* count 0: none was armed */
    int32_t station, gripper;
    int64_t seq;             /* of the last state that was heard */
    uint32_t number, before; /* of the last arming that was heard of, now and when this one was ordered */
    int64_t armed_seq;       /* the slice whose command carried the order; 0: none yet */
    bool goes_on;            /* the blade's way is remembered */
    wh_pose_t *places;       /* where the gripper was commanded to, from the end of that slice on */
    size_t place_count, place_capacity;
    wh_latch_t latches[WH_CROSSINGS]; /* of these the first latch_count, as far as there is room */
    int64_t latch_count;
    int64_t missed; /* latches that no state brought */
    bool skipped;   /* the simulator has not had all slices */
} wh_mcs_pass_t;

/* A latch as a point of the blade. */
typedef struct {
    wh_crossing_t crossing;
    double time; /* of the crossing, s of the run */
} wh_mcs_crossing_t;

/* What the last pass told. */
typedef struct {
    int32_t station, gripper;
    wh_status_t status; /* WH_OK: the centre is centres.candidates[0] */
    int64_t missed;
    size_t count;
    wh_mcs_crossing_t crossings[WH_CROSSINGS];
    wh_centres_t centres;
} wh_mcs_centring_t;

/* What a teaching has measured so far. */
#define WH_MCS_LESSONS 64
typedef struct {
    wh_teach_measurement_t lessons[WH_MCS_LESSONS];
    size_t count;
} wh_mcs_teaching_t;

/* How many commands of a prompt UNDO takes back at most. */
#define WH_MCS_UNDONE 50

/* Written by lib/mcs only, but for `partners`, `listener`, `keep_segments`, `trial`, `errors`, `error_count`,
 * `without_collisions`, `decisions`, `is_file`, `limits_missed`, `most_missed` and `rehearsal.look_ahead`,
 * which may be set between opening and the cell.
 * Must not be moved once opened. */
struct wh_mcs {
    const char *script; /* as the user gave it; borrowed */
    bool is_file;       /* `script` is a file that is run: it is no layout */
    wh_sandbox_t *sandbox;

    /* The cell, from when the script names it. */
    bool reads_layout;         /* the layout's file is running */
    const wh_layout_t *layout; /* null until then */
    const wh_layout_t *real;   /* the same, or with a trial's errors: what simulator and reports go by */
    wh_link_t *link;           /* the local cell's, or whoever stands in; null until connected */

    /* What is commanded and answered. */
    wh_track_t track;
    wh_command_t command;            /* the last one sent */
    wh_machine_cache_t cache;        /* and what it was made of */
    wh_state_t state;                /* the answer to it */
    wh_mcs_seen_t seen;              /* over a caller's link: the last slice that a state has come for */
    wh_mcs_sent_t sent[WH_MCS_SENT]; /* and the last ones that were sent, by seq % WH_MCS_SENT */

    wh_mcs_edge_t edge;
    wh_mcs_pass_t pass;
    wh_mcs_centring_t centring;
    wh_mcs_teaching_t teaching;

    wh_rehearsal_t rehearsal;
    wh_vacuum_watch_t watch;     /* of the running segment */
    wh_mcs_held_t held;          /* what CONTINUE goes on with */
    int64_t stop_slice;          /* at which a STOP comes; INT64_MAX: none */
    bool stop_requested;         /* a STOP has come: see wh_mcs_stop */
    bool link_stopped;           /* the link has answered a slice with WH_STATUS_STOPPED */
    int callers[WH_MCS_CALLERS]; /* of the running command's line, the lines that called it; 0: no more */
    bool limits_missed;          /* the run fails if the simulator misses more slices than `most_missed` */
    int64_t most_missed;
    char word[16];                /* of the script, the last one: what an error outside of a command names */
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
    const char
        *unplayed; /* what it has commanded that segments do not tell, a constant text; null: nothing */
    wh_played_fault_t *kept_faults;
    size_t kept_fault_count, kept_fault_capacity;

    wh_local_cell_t local;
    const wh_trial_t *trial;   /* of a study, whose errors the cell then has; null: as its layout says */
    const char *const *errors; /* in a trial: what it has in place of what it would draw, if there are any */
    size_t error_count;
    bool without_collisions; /* nobody looks for them, whatever the layout says */
};

/* Opens the operator's words in a sandbox for one run of `script`. `mcs` and `record` must outlive the
 * sandbox. False, and the reason in `result`, if the sandbox has no room for it. */
bool wh_mcs_open(wh_mcs_t *mcs, wh_sandbox_t *sandbox, const char *script, wh_record_t *record,
                 wh_sandbox_result_t *result);

/* Leaves on the stack of L, within a protected call, what executes a typed line and what
 * completes one: two functions, see lua/mcs/prompt.lua and lua/mcs/completion.lua. */
void wh_mcs_push_prompt(lua_State *L);

/* A state that the link has taken, in the order in which they come; those of exchanges need not be told. */
void wh_mcs_hear(wh_mcs_t *mcs, const wh_state_t *state);

/* A STOP, from within the link's exchange or between two commands: the running command ends with
 * WH_STATUS_STOPPED after this slice, the next one before its first. A script can catch that error. */
void wh_mcs_stop(wh_mcs_t *mcs);

/* A STOP where no command runs and none is to come: a command that is held in a phase is given up, the arm
 * stands in the station, and RECOVER or HOME must bring it out. Without a held one nothing. */
void wh_mcs_give_up(wh_mcs_t *mcs);

/* Room for what wh_mcs_describe writes. */
#define WH_MCS_DESCRIPTION_BYTES 4096

/* What motion control does, as name=value with blanks between them, spelt as answers at the prompt are:
 * `phase`, idle, running or held, the `command` that runs or is held, and, if held, where it `stop`s; `seq`
 * and `time` (s) of the last slice that a state has come for, 0 before the first; in that slice, where the
 * robot's axes were commanded to, `theta` and `yaw` in degrees, `r` and `z` in mm, and for each gripper the
 * wafer that it `holds`; and `error`, the number of the last command's that failed in this run, with its
 * `error_name` and `error_command`, or 0. May be called from within the link's exchange. */
void wh_mcs_describe(const wh_mcs_t *mcs, char text[WH_MCS_DESCRIPTION_BYTES]);

/* The running command has ended with an error past all Lua. Without a running command nothing. */
void wh_mcs_cut_short(wh_mcs_t *mcs, wh_status_t error, const char *message);

/* A command is told and recorded that failed before its first slice. None may be running. */
void wh_mcs_refuse(wh_mcs_t *mcs, const char *text, wh_status_t error, const char *message);

/* Closes the record: wafers, slices, hash. The sandbox must still be there. */
void wh_mcs_finish(wh_mcs_t *mcs);

/* Frees what the run collected; the record is its owner's. */
void wh_mcs_close(wh_mcs_t *mcs);

#endif
