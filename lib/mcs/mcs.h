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
#include "../layout/grips.h"
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
    /* The task that goes on, the recorder's `number`, waits for `what`; null: it goes on, and its command, if
     * one runs, has the axes and grippers of its lane. From the first call on there are tasks. */
    void (*turn)(void *user, const wh_mcs_t *mcs, const char *what);
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
    wh_grips_room_t grips;
    wh_collision_t collision;
    wh_trial_cell_t *trial; /* null: the cell is as its layout says */
} wh_local_cell_t;

/* How many slices may be on their way in a free run for STATUS to tell the last one that has come back. */
#define WH_MCS_SENT 256

/* What STATUS tells of a slice. */
typedef struct {
    int64_t seq, utime; /* us */
    wh_real_t axes[WH_AXES];
    int32_t held[WH_GRIPPERS]; /* the wafer, or WH_NONE */
} wh_mcs_seen_t;

/* Where the axes were commanded to in a slice; seq 0: none. */
typedef struct {
    int64_t seq;
    wh_real_t axes[WH_AXES];
} wh_mcs_sent_t;

/* Room for the text of a command that is held, which is cut to that, and for the phase's name. */
#define WH_MCS_HELD_BYTES 1001
#define WH_MCS_PHASE_BYTES 12

/* The most robots of a cell. */
#define WH_MCS_ROBOTS (WH_AXES / WH_ROBOT_AXES)

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
    double *speeds;          /* of the chuck in the slice of each of them, rad/s */
    double turn, speed;      /* of the chuck, as the last state told that was of this scan */
    int64_t turn_seq;        /* that state's slice; 0: none yet */
    int32_t taken;           /* so many are there */
    int32_t missed;          /* of these, for no state brought them: WH_NONE */
    bool armed;              /* more are to come */
} wh_mcs_edge_t;

/* Turns of the same wafer that an estimate takes with the last one. */
typedef struct {
    wh_rim_point_t *points; /* turn after turn, each by the sample's number in the turn */
    size_t turns;
    int32_t samples; /* in a turn */
} wh_mcs_turns_t;

/* What a teaching has measured so far. */
#define WH_MCS_LESSONS 64
typedef struct {
    wh_teach_measurement_t lessons[WH_MCS_LESSONS];
    size_t count;
    wh_pose_t base_from_station; /* as it is believed to be when the teaching begins */
} wh_mcs_teaching_t;

/* How many tasks of a script may be alive, besides the script itself. */
#define WH_MCS_TASKS 64
#define WH_MCS_LANES (1 + WH_MCS_TASKS)

/* What a task plays, and what motion control keeps of its command while others go on. */
typedef struct {
    bool is_busy;     /* a segment runs */
    bool is_drawn;    /* the track stands at the end of the slice that comes */
    wh_track_t track; /* of its axes alone it tells anything */
    wh_awaited_t awaited;
    uint32_t axes, grippers; /* bits: of the mechanisms that the running command has */
    wh_vacuum_watch_t watch;
    wh_track_state_t state; /* how the last segment ended */
    wh_status_t status;     /* not WH_OK: it was given up */
    wh_task_t task;
    int32_t job;          /* whose lines the task plays; 0: none's */
    bool waits;           /* its command does, for what another one has */
    bool is_patient;      /* however long that takes */
    wh_status_t told;     /* not WH_OK: the job, or what waits, is to end with this, */
    const char *told_why; /* for this reason, a constant text */
    /* While another task goes on: */
    int32_t number;         /* of the task; 0: the script's own */
    int32_t running;        /* the record's command; WH_NONE: none */
    wh_plan_list_t planned; /* its segments */
    int callers[WH_MCS_CALLERS];
    char word[16];
} wh_lane_t;

typedef struct {
    int32_t current;        /* whose functions run */
    const char *stopped_by; /* why segments were given up, a constant text; null: the link refused a slice */
    size_t count;           /* no lane from here on has been a task's */
    wh_lane_t of[WH_MCS_LANES]; /* the script's own first */
} wh_lanes_t;

/* Where a prompt's lines come from that are played side by side. A job is a few lines, one after another; its
 * number is not 0. */
typedef struct {
    int32_t number;
    const char *line;    /* its first one */
    bool may_wait;       /* for what others have; else it ends as busy */
    int32_t robot;       /* it is of this one alone; WH_NONE: of any */
    const char *station; /* and of this station, its chuck and its pins alone; null: of any */
} wh_mcs_job_t;

typedef struct {
    /* A job that has come, which is begun with this call. False: none has. */
    bool (*take)(void *user, wh_mcs_job_t *job);
    /* A line of the job has ended, well if `status` is WH_OK. Returns its next line; null: the job is
     * over. */
    const char *(*ended)(void *user, int32_t job, wh_status_t status, const char *answer);
    void *user;
} wh_mcs_jobs_t;

/* How many commands of a prompt UNDO takes back at most. */
#define WH_MCS_UNDONE 50

/* How many errors may be armed at a time: fault { error = N }. Their numbers follow those of faults: from
 * WH_FAULTS + 1. */
#define WH_MCS_ALARMS 16

/* Written by lib/mcs only, but for `partners`, `listener`, `keep_segments`, `trial`, `errors`, `error_count`,
 * `without_collisions`, `decisions`, `is_file`, `limits_missed`, `most_missed`, `refuses_unread` and
 * `rehearsal.look_ahead`, which may be set between opening and the cell. Must not be moved once opened. */
struct wh_mcs {
    const char *script; /* as the user gave it; borrowed */
    wh_sandbox_t *sandbox;
    bool refuses_unread; /* no cell is connected while a parameter is unread */
    bool is_file;        /* `script` is a file that is run: it is no layout */

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
    wh_mcs_turns_t turns;
    wh_pass_t pass;                /* the last one through beams, or touches */
    wh_centring_record_t centring; /* what it told */
    wh_mcs_teaching_t teaching;

    wh_lanes_t *lanes;  /* null: there are no tasks; then `track` has the running segment */
    wh_mcs_jobs_t jobs; /* while they are played */

    wh_rehearsal_t rehearsal;
    wh_awaited_t awaited;              /* by the running segment */
    wh_vacuum_watch_t watch;           /* of the running segment */
    wh_mcs_held_t held[WH_MCS_ROBOTS]; /* what CONTINUE goes on with, of each robot */
    int64_t stop_slice;                /* at which a STOP comes; INT64_MAX: none */
    bool is_called;                    /* a job has come, or one is to end: Lua goes on behind this slice */
    bool stop_requested;               /* a STOP has come: see wh_mcs_stop */
    bool link_stopped;                 /* the link has answered a slice with WH_STATUS_STOPPED */
    bool limits_missed;          /* the run fails if the simulator misses more slices than `most_missed` */
    uint32_t stopped_axes;       /* bits: it ends commands that have one of these, WH_MCS_ALL any */
    uint32_t stop_slice_axes;    /* likewise, of the STOP that comes at `stop_slice` */
    bool stop_is_asked;          /* that one: by an operator, not by stop_in */
    uint32_t held_axes;          /* bits: what the running command has, while there are no tasks */
    int callers[WH_MCS_CALLERS]; /* of the running command's line, the lines that called it; 0: no more */
    int64_t most_missed;
    char word[16];                /* of the script, the last one: what an error outside of a command names */
    wh_fault_t faults[WH_FAULTS]; /* by slot, as the simulator has them or is about to */
    size_t fault_count;
    wh_status_t alarms[WH_MCS_ALARMS]; /* the errors that wait for a command; WH_OK: a free place */
    int32_t alarm_jobs[WH_MCS_ALARMS]; /* of the job of this number; 0: of any */
    bool is_part;                      /* the line belongs to the one before it: set by who has it executed */
    int32_t asking_robot;              /* that of a robot's own controller, from 1, while it asks; 0: none */
    int32_t asking;                    /* whose question is answered, likewise: set by who asks */

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
    wh_via_point_t via_points[WH_VIA_POINTS]; /* of the segment that is being planned */
    const char *unplayed; /* what it commanded that segments do not tell, a constant text; null: nothing */
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

/* Leaves on the stack of L, within a protected call, what executes a typed line, what
 * completes one, and what plays jobs: see lua/mcs/prompt.lua, lua/mcs/completion.lua and
 * lua/mcs/tasks.lua. */
void wh_mcs_push_prompt(lua_State *L);

/* To be called protected where a script has come to its end: the run's comes when all its tasks are over.
 * Raises the error of one that failed and that no other has heard of. */
int wh_mcs_wait_for_tasks(lua_State *L);

/* A script has failed: the commands that its tasks run end where they are. */
void wh_mcs_stop_tasks(wh_mcs_t *mcs);

/* A state that the link has taken, in the order in which they come; those of exchanges need not be told. */
void wh_mcs_hear(wh_mcs_t *mcs, const wh_state_t *state);

/* A STOP, from within the link's exchange or between two commands: the running command ends with
 * WH_STATUS_STOPPED after this slice, the next one before its first. A script can catch that error. */
void wh_mcs_stop(wh_mcs_t *mcs);

#define WH_MCS_ALL UINT32_MAX

/* Bits of the axes that are a robot's. */
uint32_t wh_mcs_robot_axes(const wh_machine_t *machine, size_t robot);

/* The axes, bits, of a mechanism by its name: robot, which is all of several, or a robot's name, or that of a
 * chuck's gripper or of its station. False if the cell has none of that name. */
bool wh_mcs_find_mechanism(const wh_mcs_t *mcs, const char *name, uint32_t *axes);

/* A STOP of that mechanism: the command that has it ends as by wh_mcs_stop, and no other. Without one
 * nothing. False if there is no such mechanism. */
bool wh_mcs_stop_mechanism(wh_mcs_t *mcs, const char *name);

/* A STOP where no command runs and none is to come: what this robot holds in a phase is given up, the arm
 * stands in the station, and RECOVER or HOME must bring it out. Without a held one nothing. WH_NONE: of all
 * robots. */
void wh_mcs_give_up(wh_mcs_t *mcs, int32_t robot);

/* What this robot holds in a phase; WH_NONE: the first that any does. Null: nothing. */
const wh_mcs_held_t *wh_mcs_find_held(const wh_mcs_t *mcs, int32_t robot);

/* A job has come while others are played: from within a slice. */
void wh_mcs_call(wh_mcs_t *mcs);

/* The job's command ends behind this slice with `status`, for the reason `why`, a constant text. Its next
 * line is not played. What is not being played stays as it is. */
void wh_mcs_end_job(wh_mcs_t *mcs, int32_t job, wh_status_t status, const char *why);

/* True while the job waits for what another one has, and may not for ever. */
bool wh_mcs_job_waits(const wh_mcs_t *mcs, int32_t job);

/* True if this error was armed, by fault { error = N } of this job or of none; then it no longer is. For
 * whoever answers in place of motion control: a port that is busy. */
bool wh_mcs_take_alarm(wh_mcs_t *mcs, wh_status_t error, int32_t job);

/* Room for what wh_mcs_describe writes. */
#define WH_MCS_DESCRIPTION_BYTES 24576

/* What motion control does, as name=value with blanks between them, spelt as answers at the prompt are:
 * `phase`, idle, running or held, the `command` that runs or is held, of task n as `taskn.command`, and,
 * if held, where it `stop`s; `seq`
 * and `time` (s) of the last slice that a state has come for, 0 before the first; in that slice, where the
 * robot's axes were commanded to, `theta` and `yaw` in degrees, `r` and `z` in mm, and for each gripper the
 * wafer that it `holds`; and `error`, the number of the last command's that failed in this run, with its
 * `error_name` and `error_command`, or 0. May be called from within the link's exchange. */
void wh_mcs_describe(const wh_mcs_t *mcs, char text[WH_MCS_DESCRIPTION_BYTES]);

/* Room for what wh_mcs_name_mechanisms writes. */
#define WH_MCS_MECHANISMS_BYTES ((WH_LAYOUT_ROBOTS + WH_GRIPPERS + WH_DOORS) * (WH_NAME_SIZE + 2))

/* The names of the mechanisms that have these axes, bits: the robots, then each chuck's gripper, with commas
 * between them; empty for none. */
void wh_mcs_name_mechanisms(const wh_mcs_t *mcs, uint32_t axes, char text[WH_MCS_MECHANISMS_BYTES]);

/* The running command has ended with an error past all Lua. Without a running command nothing. */
void wh_mcs_cut_short(wh_mcs_t *mcs, wh_status_t error, const char *message);

/* A command is told and recorded that failed before its first slice. None may be running. */
void wh_mcs_refuse(wh_mcs_t *mcs, const char *text, wh_status_t error, const char *message);

/* Closes the record: wafers, slices, hash. The sandbox must still be there. */
void wh_mcs_finish(wh_mcs_t *mcs);

/* Frees what the run collected; the record is its owner's. */
void wh_mcs_close(wh_mcs_t *mcs);

#endif
