/* The data of a host and its controllers: what the files of this room share, in the order that README.md
 * says.
 *
 * Memory: about 150 kB for each port, beside its dialect's.
 */
#ifndef WH_HOST_STATE_H
#define WH_HOST_STATE_H

#include <signal.h>
#include <stdio.h>

#include "../mcs/session.h"
#include "dialect.h"
#include "mechanism.h"
#include "pace.h"
#include "port.h"
#include "transcript.h"

/* The most ports of a cell, and their clients at a time. */
#define WH_HOST_PORTS 8
#define WH_HOST_CONTROLLERS (WH_HOST_PORTS * WH_DIALECT_SHARERS)
/* The time for Lua of dialects in a slice; the rest waits for the next slice. */
#define WH_HOST_LUA_US 2000
/* Above all numbers of errors. */
#define WH_HOST_NUMBERS 128
#define WH_STATUS(number, name, text)                                                                        \
    typedef char wh_host_has_room_for_##name[(number) < WH_HOST_NUMBERS ? 1 : -1];
#include "../math/status.def"
#undef WH_STATUS

typedef struct wh_host wh_host_t;
typedef struct wh_controller wh_controller_t;

/* A frame on its way, and the frames of a direction, which never overtake each other. */
typedef struct wh_sent_frame {
    struct wh_sent_frame *next;
    int64_t due_us;
    size_t size;
    uint8_t bytes[];
} wh_sent_frame_t;

typedef struct {
    wh_sent_frame_t *first, *last;
} wh_sent_t;

/* A frame's body, to be sent again. */
typedef struct {
    char *text; /* null: none */
    size_t size, start;
} wh_reply_t;

/* Since opening; of a port. */
typedef struct {
    uint64_t frames;                    /* good ones that came */
    uint64_t bad;                       /* others */
    uint64_t nobodys;                   /* for units that the line does not have */
    char nobody[WH_DIALECT_NAME_BYTES]; /* the address of the first of them */
    uint64_t repeated; /* frames that came again, with their sequence number, and were answered as before */
    uint64_t actions;  /* begun */
    uint64_t busy;     /* refused as such, or ended so */
    uint64_t unacknowledged;
    uint64_t mistakes; /* of the dialect */
} wh_controller_counters_t;

/* The bytes of a port, both ways. */
typedef struct {
    wh_port_t port;
    bool is_open;
    uint64_t heard;   /* bytes both ways, and clients, so far */
    int64_t heard_us; /* when that grew last */
    wh_framer_t framer, before_chaos;
    wh_pace_t in_pace, out_pace;
    wh_ring_t waiting;              /* of a paced line: bytes that are due and not through yet */
    wh_sent_t out, in;              /* `in`: of a line with chaos */
    uint64_t frames_out, frames_in; /* so far, before chaos */
    uint64_t told, broken;          /* frames to the host after chaos, and those without a whole copy */
    bool has_gone;                  /* the client has gone, and its last bytes are not read yet */
    bool is_parting;                /* and the dialect has not been told of it */
    bool closes;                    /* the client is to be closed once all was told */
    uint64_t client;                /* its number among those of the dialect */
} wh_port_line_t;

/* The action that a controller has accepted, from then to its end. */
typedef struct {
    bool is_there;    /* an action was accepted and has not ended */
    bool is_running;  /* and has begun */
    bool has_begun;   /* at some time */
    bool is_stopped;  /* it must end, or must not begin */
    bool is_left;     /* the client that asked for it has gone, and another one has come */
    bool is_answered; /* its host waits for nothing more */
    uint64_t order;   /* when, among all ports */
    int64_t since_us;
    wh_request_t request;
    wh_lines_t lines;
    size_t line_number;  /* of these, the one that is played */
    size_t line_command; /* the record's commands before that one */
    int64_t begin_slice;
    char wait_line[40]; /* the line behind a CLEAR */
    wh_status_t ended;  /* how the last line ended that was played, */
    char *ended_text;   /* and its answer; null: none */
    wh_status_t failed; /* the last error of an action that was begun; WH_OK: none has failed */
    char failed_line[WH_DIALECT_LINE_BYTES];
    uint64_t failed_order; /* when, among all ports */
} wh_action_t;

/* A request that waits behind the action that runs. */
typedef struct wh_pending {
    struct wh_pending *next;
    wh_controller_t *from;
    wh_request_t request;
    bool is_answered; /* its acknowledgement was told */
    wh_lines_t lines; /* of an action */
} wh_pending_t;

/* The acknowledgement that the host owes. */
typedef struct {
    int64_t due_us;                       /* INT64_MAX: none is owed */
    char sequence[WH_DIALECT_NAME_BYTES]; /* of the completion that it is owed for; empty: it had none */
} wh_owed_ackn_t;

/* The client's last request with a sequence number, and its reply, for a client that sends it again. */
typedef struct {
    uint8_t last[WH_FRAMING_LINE]; /* its body */
    size_t last_size, last_end;
    wh_reply_t reply;
    bool remembers; /* the next reply is that */
} wh_repeat_t;

/* One port's controller. Others read only the first group. */
struct wh_controller {
    wh_dialect_t *dialect; /* the leader's */
    wh_port_mechanism_t mechanism;
    char name[WH_TRANSCRIPT_NAME + 1]; /* in messages and the transcript: robot, or its name if given, such as
                                        * VAC */
    wh_controller_counters_t counters;
    wh_port_line_t line;

    wh_host_t *host;
    uint32_t number;          /* among the ports, from 0 */
    wh_controller_t *leader;  /* of the ports that share a dialect and its mechanism: the first one */
    const char *role;         /* its name in the dialect's `ports` */
    bool is_tester;           /* it stands for no mechanism: a tester beside the hosts */
    const char *unit;         /* its address among the units of its line; null: the line is its own */
    wh_controller_t *carrier; /* whose port and line it has: its own, or those of its line's first unit */
    wh_pending_t *pending;    /* of the leader: what waits, in its order */
    bool is_held;             /* of the leader: a HOLD of its own stands */
    uint64_t guests;          /* of the leader: clients at its dialect's ports, so far */
    wh_action_t action;
    wh_owed_ackn_t owed;
    wh_repeat_t repeat;
    wh_status_t refused_as; /* why the last answer was refused as it was encoded; WH_OK: it was not */
};

/* The run's time beside the wall clock's. */
typedef struct {
    int64_t base_wall_us, base_run_us, last_served_us; /* of the running command */
    int64_t rest_us;                 /* ports that the slice's end does not wait for rest so long */
    int64_t waited_slice, waited_us; /* of the last wh_host_wait, and when it was */
    int64_t lua_us;                  /* used up in this slice */
    int64_t skipped_us; /* where a transcript is played: the time of the clock before it was set back */
    int64_t slice;      /* as of wh_host_heed_clock */
    int64_t wall_us, run_us, held_us; /* of all commands: by the wall clock, simulated, and of HOLDs */
} wh_host_clock_t;

/* Room for texts that are made anew for each use. */
typedef struct {
    char played[WH_SESSION_ANSWER_BYTES];  /* the answer to the action's line */
    char ignored[WH_SESSION_ANSWER_BYTES]; /* the answer to the wait behind a CLEAR */
    char asked[WH_SESSION_ANSWER_BYTES];   /* the answer to a query */
    char told[WH_MCS_DESCRIPTION_BYTES + 4];
    char status[WH_MCS_DESCRIPTION_BYTES], own_status[WH_MCS_DESCRIPTION_BYTES];
    char controller[400], mode[400]; /* what a robot's own has: in an answer, and in an event */
    char load_port[4 * WH_NAME_SIZE + 100];
    wh_lines_t lines;             /* of the request that has come */
    wh_lines_t conditions;        /* of a client that has gone, or of a tester */
    wh_pose_t poses[WH_GRIPPERS]; /* of the blades, now */
} wh_host_texts_t;

/* The caller's functions; each may be null. */
typedef struct {
    /* Called with each entry of a transcript, whether one is written or not. */
    void (*heard)(void *user, const wh_transcript_entry_t *entry);
    void *heard_user;
    /* Called whenever ports were served, at least every 100 ms, but not within the link's exchange. */
    void (*tick)(void *user);
    void *tick_user;
} wh_host_callbacks_t;

/* Counts since opening. */
typedef struct {
    uint64_t orders;   /* accepted actions */
    uint64_t turns;    /* the times that ports were served */
    uint64_t failures; /* of actions that were begun */
    uint64_t rates;    /* that a tester has set */
} wh_host_counts_t;

/* The cell as the host saw it last. */
typedef struct {
    uint32_t sensors, valves; /* of the last slice, by gripper: on, open */
    uint32_t open, shut;      /* by door: the switches */
    wh_grip_phase_t grips[WH_GRIPPERS];
    wh_mcs_controller_t controllers[WH_LAYOUT_ROBOTS];
    wh_mcs_load_port_t *ports; /* of the layout's stations; null: not looked at yet */
    wh_event_kind_t complaint; /* the last one, where session->complaints says that there was one */
} wh_host_seen_t;

struct wh_host {
    /* Set by the caller before wh_host_add. */
    wh_session_t *session; /* opened later, with wh_host_listener as its listener */
    double rate;           /* 0: no waiting for the wall clock */
    bool shows_one_run;    /* RESET, RESTORE and UNDO are refused */
    const volatile sig_atomic_t *stop;
    wh_mcs_listener_t next; /* who else listens; may be all null */
    wh_host_callbacks_t callbacks;
    const wh_allow_t *allow; /* who may connect from another machine; null: all */
    FILE *transcript;        /* null: none */
    bool writes_json;        /* the transcript has JSON lines */
    /* Its host's side is every port, and its clock is the run's; null: ports as the command line says. */
    wh_transcript_t *played;

    wh_controller_t *controllers[WH_HOST_CONTROLLERS];
    size_t count, leaders;
    wh_controller_t *running; /* the controller whose action runs; with several, the one that began last;
                               * null: none */
    bool is_told_to_stop;     /* of what runs */
    bool is_ended;            /* the operator ended it: nothing is begun any more */
    wh_host_counts_t so_far;
    wh_host_clock_t clock;
    wh_host_seen_t seen;
    uint64_t *shown; /* how often a host was told our error of this number, of WH_HOST_NUMBERS */
    wh_host_texts_t *texts;
};

#endif
