/* The state of a run's motion control, by owner. */
#ifndef WH_MCS_STATE_H
#define WH_MCS_STATE_H

#include "../align/teaching.h"
#include "../layout/collision.h"
#include "../layout/grips.h"
#include "../record/recorder.h"
#include "../script/sandbox.h"
#include "../trial/decisions.h"
#include "../trial/origins.h"
#include "../trial/trial_cell.h"
#include "controller.h"
#include "kept.h"
#include "partners.h"
#include "ramp.h"
#include "rehearsal.h"

/* The listeners for slices: decisions, recorder, origins, the collected scan, the data of STATUS, a collision
 * check beside a remote simulator, the stations' clockwork, late valves, verified slices, and the run's
 * listener. */
#define WH_MCS_LISTENERS 10

/* The most lines of a script that are listed as calling lines, for a command within functions. */
#define WH_MCS_CALLERS 4

/* Room for a script's word, or for "the script's end". */
#define WH_MCS_WORD 20

/* The cell in this process: its simulator, and the collision check of it. */
typedef struct {
    wh_simulator_t simulator; /* first: its link is the cell's */
    wh_grips_room_t grips;
    wh_collision_t collision;
    wh_trial_cell_t *trial;     /* null: the cell is as in its layout */
    struct wh_counted *counted; /* time is counted, see counted.h; null: each slice is played */
} wh_local_cell_t;

/* In a free run STATUS can tell the last slice that has come back if at most this many are on their
 * way. */
#define WH_MCS_SENT 256

/* A slice, as STATUS shows it. */
typedef struct {
    int64_t seq, utime; /* us */
    wh_real_t axes[WH_AXES];
    int32_t held[WH_GRIPPERS]; /* the wafer, or WH_NONE */
} wh_mcs_seen_t;

/* The commanded places of the axes in a slice; seq 0: none. */
typedef struct {
    int64_t seq;
    wh_real_t axes[WH_AXES];
} wh_mcs_sent_t;

/* Room for the text of a held command, which is cut to that length, and for the phase's name. */
#define WH_MCS_HELD_BYTES 1001
#define WH_MCS_PHASE_BYTES 12

/* The most robots of a cell. */
#define WH_MCS_ROBOTS (WH_AXES / WH_ROBOT_AXES)

/* A command that stands still in a phase of its way, between two commands. */
typedef struct {
    char command[WH_MCS_HELD_BYTES]; /* empty: none */
    char phase[WH_MCS_PHASE_BYTES];  /* "extended" or "up" */
} wh_mcs_held_t;

/* A scan of a wafer's edge, as the states have brought it. */
typedef struct {
    wh_scan_order_t order;
    int64_t seq;             /* of the last state that came */
    uint32_t number, before; /* of the last scan that a state told, now and when this one was armed */
    int32_t *samples;        /* as many as were ordered; null: none was */
    double *speeds;          /* of the chuck in the slice of each of them, rad/s */
    double turn, speed;      /* of the chuck, from the last state of this scan */
    int64_t turn_seq;        /* that state's slice; 0: none yet */
    int32_t taken;           /* the number of samples so far */
    int32_t missed;          /* how many of these no state brought; they are WH_NONE */
    bool armed;              /* more are to come */
} wh_mcs_edge_t;

/* Turns of one wafer that an estimate uses together with the last turn. */
typedef struct {
    wh_rim_point_t *points; /* turn after turn, each by the sample's number in the turn */
    size_t turns;
    int32_t samples; /* in a turn */
} wh_mcs_turns_t;

/* The measurements of a teaching so far. */
#define WH_MCS_LESSONS 64
typedef struct {
    wh_teach_measurement_t lessons[WH_MCS_LESSONS];
    size_t count;
    wh_pose_t base_from_station; /* the believed pose when the teaching begins */
} wh_mcs_teaching_t;

/* The most tasks of a script that may be alive, besides the script itself. */
#define WH_MCS_TASKS 64
#define WH_MCS_LANES (1 + WH_MCS_TASKS)

/* A lane whose segment was stopped. */
typedef struct {
    wh_ramp_t ramp;    /* the segment slows down by it; then it ends with */
    wh_status_t after; /* this for its job, for the lane's told_why; WH_OK: with STOPPED */
} wh_lane_stop_t;

/* A task's segment, and the data of its command that motion control keeps while others go on. */
typedef struct {
    bool is_busy;     /* a segment runs */
    bool is_drawn;    /* the track stands at the end of the next slice */
    wh_track_t track; /* it is valid only for this lane's axes */
    wh_awaited_t awaited;
    uint32_t axes, grippers; /* bits: the mechanisms that the running command has */
    wh_vacuum_watch_t watch;
    size_t kept;            /* the segment's number among those kept, from 1; 0: none */
    wh_track_state_t state; /* how the last segment ended */
    wh_status_t status;     /* not WH_OK: it was given up */
    int32_t refused;        /* the robot, from 1, whose controller ended it; 0: none */
    wh_task_t task;
    int32_t job;     /* the job whose lines the task plays; 0: none */
    bool waits;      /* its command waits for something that another one has */
    bool is_patient; /* it waits without a limit */
    bool is_held;    /* its segment stands still for now */
    wh_lane_stop_t stop;
    wh_status_t told;     /* not WH_OK: the job, or the waiting command, must end with this, */
    const char *told_why; /* for this reason, a constant text */
    /* While another task goes on: */
    int32_t number;         /* of the task; 0: the script's own */
    int32_t running;        /* the record's command; WH_NONE: none */
    wh_plan_list_t planned; /* its segments */
    int callers[WH_MCS_CALLERS];
    char module[WH_SANDBOX_MODULE_BYTES];
    char word[WH_MCS_WORD];
} wh_lane_t;

typedef struct {
    int32_t current;        /* the lane whose functions run */
    const char *stopped_by; /* why segments were given up, a constant text; null: the link refused a slice */
    struct wh_flow_played *flow; /* whose robots' commands are played in them, see flow_played.h; or null */
    uint32_t held_axes;          /* bits: of robots that requests hold, whose segments do not begin */
    size_t count;                /* lanes from here on were never used */
    wh_lane_t of[WH_MCS_LANES];  /* the script's own first */
} wh_lanes_t;

/* The number of a job whose faults and errors on purpose are for any job: a tester's. */
#define WH_MCS_NOBODYS_JOB (-1)

/* The source of a prompt's lines that are played side by side. A job is a few lines, one after another; its
 * number is not 0. */
typedef struct {
    int32_t number;
    const char *line;    /* its first one */
    bool may_wait;       /* for something that others have; else it ends as busy */
    int32_t robot;       /* only this robot; WH_NONE: any */
    const char *station; /* and only this station, its chuck and its pins; null: any */
} wh_mcs_job_t;

typedef struct {
    /* Takes a job that has come; the job begins with this call. False: none has come. */
    bool (*take)(void *user, wh_mcs_job_t *job);
    /* A line of the job has ended, without error if `status` is WH_OK. Returns its next line; null:
     * the job is over. */
    const char *(*ended)(void *user, int32_t job, wh_status_t status, const char *answer);
    void *user;
} wh_mcs_jobs_t;

/* The most commands of a prompt that UNDO takes back. */
#define WH_MCS_UNDONE 50

/* The most errors that may be armed at a time: fault { error = N }. Their numbers follow those of the
 * faults, from WH_FAULTS + 1. */
#define WH_MCS_ALARMS 16

/* Whether slices in which nothing can be decided are left out: see counted.h. */
typedef enum {
    WH_MCS_COUNT_NONE,   /* each slice is played */
    WH_MCS_COUNT,        /* they are, also where collisions are looked for in the slices that are played */
    WH_MCS_COUNT_STRICT, /* likewise; a cell with collision = true is refused */
    WH_MCS_COUNT_BLIND   /* likewise; a cell with collision = true is played in full */
} wh_mcs_count_t;

/* The controller that asks for a line, for its own answers and errors. Zero: none. */
typedef struct {
    int32_t controller;  /* from 1, the one whose question is answered */
    int32_t robot;       /* from 1, the robot whose own controller asks */
    const char *station; /* whose own controller asks; null: no station's */
    bool is_part;        /* the line belongs to the one before it */
} wh_mcs_asker_t;

/* The caller's wishes for a run; all may be zero. */
typedef struct {
    bool refuses_unread;     /* the cell is not connected while a parameter is unread */
    bool is_file;            /* `script` is a file that is run, not a layout */
    bool is_of_hosts;        /* lines come from hosts, not from an operator or a script */
    bool slows_down;         /* a STOP does, unless the layout says otherwise: see ramp.h */
    bool keeps_segments;     /* collect what goes into the simulator, for --segments: kept.h */
    wh_flow_keep_t keeps;    /* of a flow beside its sums */
    bool without_collisions; /* no collision check, whatever the layout says */
    bool until_steady;       /* a flow by times alone ends as soon as it is steady */
    const char *needs_axes;  /* the option for which robots must have axes; null: none was given */
    wh_mcs_count_t counts;
    uint64_t verify;      /* so many stretches of slices that could be left out are played, see verify.h */
    const size_t *faster; /* the numbers of what takes less time, see wh_layout_hasten */
    size_t faster_count;
    double faster_share;
    bool limits_missed; /* the run fails if the simulator misses more slices than `most_missed` */
    int64_t most_missed;
    wh_mcs_partners_t partners;
    wh_mcs_listener_t listener;
    wh_decisions_t *decisions; /* keeps commands and readings; null: they are not kept */
    const wh_trial_t *trial;   /* a study's trial, whose errors the cell has; null: as in its layout */
    const char *const *errors; /* in a trial: the errors it has instead of drawn ones, if any */
    size_t error_count;
    wh_mcs_asker_t asker; /* of the line that is executed */
} wh_mcs_wanted_t;

/* A STOP, and what else must end a portion of slices. */
typedef struct {
    bool is_requested;   /* a STOP has come: see wh_mcs_stop */
    uint32_t axes;       /* bits: it ends commands that have one of these axes; WH_MCS_ALL: any */
    int64_t at_slice;    /* at which a STOP comes; INT64_MAX: none */
    uint32_t slice_axes; /* likewise, for the STOP that comes at `at_slice` */
    bool is_asked;       /* that STOP came from an operator, not from stop_in */
    bool is_by_link;     /* the link has answered a slice with WH_STATUS_STOPPED */
    bool is_called;      /* a job has come, or one must end: Lua goes on after this slice */
    uint32_t refused;    /* bits: robots whose controllers end their motion */
    bool stands;         /* what the STOP ends stood still already */
    bool was_cut;        /* the last error of a motion was such an end */
} wh_mcs_stop_t;

/* The segment that is planned or runs, and its command, while there are no tasks. */
typedef struct {
    wh_via_point_t via_points[WH_VIA_POINTS]; /* of the segment that is being planned */
    wh_awaited_t awaited;                     /* what the running segment waits for */
    wh_vacuum_watch_t watch;                  /* of the running segment */
    size_t kept;                              /* its number in `kept`, from 1; 0: none */
    uint32_t axes;                            /* bits: the axes of the running command */
    bool slows_down;                          /* the running segment: a STOP has come */
    int callers[WH_MCS_CALLERS];          /* the lines that called the running command's line; 0: no more */
    char module[WH_SANDBOX_MODULE_BYTES]; /* the place in a module where that line led; empty: none */
    char word[WH_MCS_WORD]; /* the script's last word, which an error outside of a command names */
} wh_mcs_running_t;

/* Faults, errors on purpose, and what robots' own controllers have, which faults change. */
typedef struct {
    wh_fault_t faults[WH_FAULTS]; /* by slot, as the simulator has or will have them */
    size_t fault_count;
    wh_status_t alarms[WH_MCS_ALARMS]; /* the errors that wait for a command; WH_OK: a free place */
    int32_t alarm_jobs[WH_MCS_ALARMS]; /* for the job of this number; 0: for any */
    bool alarm_tried[WH_MCS_ALARMS];   /* something broke for it, and its command ended otherwise */
    wh_mcs_controller_t controllers[WH_MCS_ROBOTS];
} wh_mcs_armed_t;

/* Measurements of wafers' edges and of stations, from states. */
typedef struct {
    wh_mcs_edge_t edge;
    wh_mcs_turns_t turns;
    wh_pass_t pass;                /* the last one through beams, or touches */
    wh_centring_record_t centring; /* its result */
    wh_mcs_teaching_t teaching;
} wh_mcs_measuring_t;

/* A valve that did not open with its command. */
typedef struct {
    int64_t shut;   /* the slices in which it stood closed, since it was told to open */
    wh_vec3_t from; /* where the gripper was in the first of them */
    wh_pose_t to;   /* where it was when it was asked for its wafer */
    bool late;      /* some had been, by then */
} wh_mcs_valve_t;

/* Over a caller's link: the slices that went out and came back. */
typedef struct {
    wh_mcs_seen_t seen;              /* the last slice that a state has come for */
    wh_mcs_sent_t sent[WH_MCS_SENT]; /* the last ones that were sent, by seq % WH_MCS_SENT */
    wh_origins_t origins;            /* where the grippers' wafers lay */
    wh_mcs_valve_t valves[WH_GRIPPERS];
} wh_mcs_heard_t;

typedef struct {
    struct {
        wh_slice_listener_t *hear;
        void *user;
    } of[WH_MCS_LISTENERS];
    size_t count;
} wh_mcs_listeners_t;

/* Private to lib/mcs, but for `wanted` and `rehearsal.look_ahead`, which may be set between opening and the
 * cell. Others ask the functions of mcs.h. Must not be moved once opened. */
struct wh_mcs {
    const char *script; /* as the user gave it; borrowed */
    wh_sandbox_t *sandbox;
    wh_mcs_wanted_t wanted;

    /* The cell, from when the script names it. */
    bool reads_layout;         /* the layout's file is running */
    const wh_layout_t *layout; /* null until then */
    const wh_layout_t *real;   /* the same, or with a trial's errors: for the simulator and reports */
    wh_local_cell_t local;
    struct wh_clocks *clocks; /* of stations that take time, see clocks.h; null: there are none */
    wh_link_t *link;          /* the local cell's, or its replacement; null until connected */

    /* A slice. */
    wh_track_t track;
    wh_command_t command;     /* the last one sent */
    wh_machine_cache_t cache; /* and the cache for making it */
    wh_state_t state;         /* the answer to it */
    wh_mcs_heard_t heard;

    /* A command. */
    wh_rehearsal_t rehearsal;
    wh_mcs_running_t running;
    wh_mcs_held_t held[WH_MCS_ROBOTS]; /* each robot's command that CONTINUE goes on with */
    wh_mcs_stop_t stop;
    wh_mcs_armed_t armed;
    wh_lanes_t *lanes;  /* null: there are no tasks; then `track` has the running segment */
    wh_mcs_jobs_t jobs; /* while they are played */

    /* The results. */
    wh_mcs_measuring_t measuring;
    wh_recorder_t recorder;
    wh_mcs_listeners_t listeners;
    wh_mcs_kept_t kept;
};

#endif
