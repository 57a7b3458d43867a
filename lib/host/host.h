/* Controllers at their ports: the tool's host software talks to them while a session plays what it asks for.
 *
 * Of each port one thing moves at a time; several ports move side by side. While a command runs, each of its
 * slices serves the ports: what a host asks
 * meanwhile is answered between two slices, and no client can hold one up. Simulated time passes only while a
 * command runs; then a slice lasts as long by the wall clock, times 1 / rate.
 *
 * One thread. Memory: about 150 kB for each port, beside its dialect's.
 */
#ifndef WH_HOST_HOST_H
#define WH_HOST_HOST_H

#include <signal.h>
#include <stdio.h>

#include "../mcs/session.h"
#include "dialect.h"
#include "mechanism.h"
#include "pace.h"
#include "port.h"
#include "transcript.h"

/* The most ports of a cell. */
#define WH_HOST_PORTS 8
/* So much Lua of dialects runs in a slice; what is left waits for the next one. */
#define WH_HOST_LUA_US 2000

typedef struct wh_host wh_host_t;

/* A frame on its way, and those of a direction, which never overtake. */
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
    uint64_t frames;   /* good ones that came */
    uint64_t bad;      /* others */
    uint64_t repeated; /* frames that came again, with their sequence number, and were answered as before */
    uint64_t actions;  /* begun */
    uint64_t busy;     /* refused as such, or ended so */
    uint64_t unacknowledged;
    uint64_t mistakes; /* of the dialect */
} wh_controller_counters_t;

/* One port. The first group is to be read. */
typedef struct {
    wh_dialect_t dialect;
    wh_port_t port;
    wh_port_mechanism_t mechanism;
    char name[WH_TRANSCRIPT_NAME + 1]; /* in messages and the transcript: robot, or VAC if that is named */
    wh_controller_counters_t counters;

    wh_host_t *host;
    bool is_open; /* the port */
    wh_framer_t framer;
    wh_pace_t in_pace, out_pace;
    wh_ring_t line;    /* of a paced line: what is due and not through */
    uint32_t number;   /* among the ports, from 0 */
    wh_sent_t out, in; /* `in`: of a line with chaos */
    wh_framer_t before_chaos;
    uint64_t frames_out, frames_in; /* so far, before chaos */
    uint64_t told, broken;          /* to the host, behind it: frames, and those of which no copy was whole */
    bool has_action;                /* one was taken on and has not ended */
    bool is_running;                /* and has begun */
    bool is_stopped;                /* it is to end, or not to begin */
    bool is_left;                   /* the client that asked for it has gone, and another one has come */
    uint64_t order;                 /* when, among all ports */
    int64_t since_us;
    wh_request_t request;
    wh_lines_t lines;
    size_t line_number;  /* of these, the one that is played */
    int64_t begin_slice; /* of the action */
    wh_status_t ended;   /* how the last line ended that was played, */
    char *ended_text;    /* and its answer; null: none */
    wh_status_t failed;  /* the last error of an action that was begun; WH_OK: none has failed */
    char failed_line[WH_DIALECT_LINE_BYTES];
    int64_t ackn_due_us;           /* INT64_MAX: none is owed */
    uint8_t last[WH_FRAMING_LINE]; /* the body of this client's last request with a sequence number */
    size_t last_size;
    wh_reply_t reply; /* to that */
    bool remembers;   /* the next reply is that */
    bool has_gone;    /* the client has, and what it left is not read yet */
} wh_controller_t;

struct wh_host {
    /* Set by the caller before wh_host_open. */
    wh_session_t *session; /* opened later, with wh_host_listener as its listener */
    double rate;           /* 0: no waiting for the wall clock */
    bool shows_one_run;    /* RESET, RESTORE and UNDO are refused */
    const volatile sig_atomic_t *stop;
    wh_mcs_listener_t next;   /* who else listens; may be all null */
    void (*tick)(void *user); /* called whenever ports were served, at least every 100 ms, but not within the
                                 link's exchange; may be null */
    void *tick_user;
    FILE *transcript; /* null: none */
    bool writes_json; /* the transcript has JSON lines */
    /* The host's side of this is played, in place of ports; null: there are ports. */
    wh_transcript_t *played;

    wh_controller_t *controllers[WH_HOST_PORTS];
    size_t count;
    wh_controller_t *running; /* whose action runs, of several the one that began last; null: none */
    wh_controller_t *holder;  /* whose HOLD it is */
    bool is_held;             /* by a HOLD */
    bool is_told_to_stop;     /* of what runs */
    uint64_t orders, turns;   /* actions taken on, and times that ports were served, so far */
    int64_t base_wall_us, base_run_us, last_served_us; /* of the running command */
    int64_t waited_slice, waited_us;                   /* of the last wh_host_wait, and when it was */
    int64_t lua_us;                                    /* used up in this slice */
    int64_t skipped_us;  /* where a transcript is played: what a clock that was set back had told */
    int64_t clock_slice; /* the slice as of wh_host_heed_clock */
    bool is_ended;       /* by the operator: nothing is begun any more */
    bool is_different;   /* what was heard is not what the transcript says: its message tells */
    wh_event_kind_t last_complaint; /* of the cell, where session->complaints says that there was one */
    uint64_t *shown; /* how often a host was told our error of this number, of WH_HOST_NUMBERS */
};

/* Above all numbers of errors. */
#define WH_HOST_NUMBERS 128

/* A port as the command line says it. */
typedef struct {
    const char *dialect;   /* its file */
    const char *mechanism; /* a robot or a station; null: as the dialect says, all of its kind */
    const char *address;   /* or a pty's link if `is_pty`; null: it has no port */
    bool is_pty;
} wh_host_port_t;

/* Adds a controller. False, with the reason in
 * `message` of the dialect, which is the last controller's: host->controllers[host->count - 1]. */
bool wh_host_add(wh_host_t *host, const wh_host_port_t *port);

/* To be the session's listener. */
wh_mcs_listener_t wh_host_listener(wh_host_t *host);

/* Serves until *host->stop is set. */
void wh_host_run(wh_host_t *host);

/* Plays host->played to its end: each frame of the host's at its slice. True if all that was heard is what
 * the transcript says, to the byte and slice; else host->played->message tells the first difference. */
bool wh_host_converse(wh_host_t *host);

/* A STOP of who is at no port: what runs ends, and what waits is not begun. */
void wh_host_stop(wh_host_t *host);

/* True if what runs was stopped, all of it. */
bool wh_host_is_stopped(const wh_host_t *host);

/* For a simulator in another process, to be called while the answer to a slice is waited for: ports are
 * served, but for `tick`, and time by the wall clock does not count. */
void wh_host_wait(wh_host_t *host);

/* Closes the ports and frees all. The session is the caller's. */
void wh_host_close(wh_host_t *host);

/* ------------------------------------------------------------------------- between the files of this room */

/* us of the clock by which answers are late or come in time: the wall clock, or, where a transcript is
 * played, the simulated one, and what was passed over while nothing ran. */
int64_t wh_host_now(const wh_host_t *host);

/* Writes an entry of this slice into the transcript, or compares it with the one that is played. */
void wh_host_note(wh_host_t *host, const wh_controller_t *controller, wh_transcript_kind_t kind,
                  const uint8_t *bytes, size_t size);
/* Notes it if the running command has set the clock back, which counts on from there. Called before anything
 * else that looks at the time, in each slice and after each line of a command. */
void wh_host_heed_clock(wh_host_t *host);
/* Ends what runs, and begins nothing more: the operator's stop. */
void wh_host_end(wh_host_t *host);
/* The same if a command has ended so by a signal, in a wait for a simulator. */
void wh_host_heed_stop(wh_host_t *host, wh_status_t status);

/* An entry of the host's side, as if it had come over the port. */
void wh_controller_hear(wh_controller_t *controller, const wh_transcript_entry_t *entry);
/* Takes what has come and sends what is due. */
void wh_controller_serve(wh_controller_t *controller);
/* The next time at which wh_controller_serve has something to do by itself; INT64_MAX: none. */
int64_t wh_controller_due(const wh_controller_t *controller);
/* Encodes and sends. `is_reply`: to the request that has just come, as late as its timing says. */
void wh_controller_tell(wh_controller_t *controller, wh_encoder_t encoder, const wh_told_t *told,
                        bool is_reply);
/* Another client: nothing of what the last one sent, or was owed, is left. */
void wh_controller_forget_client(wh_controller_t *controller);
/* The same bytes as a reply before. */
void wh_controller_tell_again(wh_controller_t *controller, const wh_reply_t *reply);

/* A frame has come, and what is owed by time. */
void wh_controller_take(wh_controller_t *controller, const wh_frame_t *frame);
void wh_controller_tick(wh_controller_t *controller);
/* The acknowledgement that is owed is not waited for any longer; where none is, the action ends that waits
 * for its turn. */
void wh_controller_give_up_waiting(wh_controller_t *controller);
/* Plays the action that was taken on, to its end; where there are several ports, all that come meanwhile,
 * too. */
void wh_controller_play(wh_controller_t *controller);
/* The action that was taken on first and has not begun; null: none. */
wh_controller_t *wh_host_next_action(const wh_host_t *host);
/* True if ports move side by side: there are several, or the one is not the cell's. */
bool wh_host_plays_jobs(const wh_host_t *host);
/* Then: plays what was taken on. */
void wh_host_play_jobs(wh_host_t *host);
/* Likewise: what runs of this controller ends with this error. */
void wh_controller_end_job(wh_controller_t *controller, wh_status_t status, const char *why);
bool wh_controller_waits(const wh_controller_t *controller);
/* An action has ended, or was never begun: its host is told. */
void wh_controller_end(wh_controller_t *controller, wh_status_t number, const char *text, double seconds);
void wh_controller_end_unbegun(wh_controller_t *controller, wh_status_t number, const char *reason);
/* As wh_mcs_describe, but what runs and what has failed is this controller's own where there are several. */
void wh_controller_describe(const wh_controller_t *controller, char text[WH_MCS_DESCRIPTION_BYTES]);
/* The clock of the running action begins. */
void wh_host_begin_clock(wh_host_t *host, wh_controller_t *controller);
/* A slice of a transcript that is played. */
void wh_host_play_slice(wh_host_t *host);
/* An event of this slice. */
void wh_controller_event(wh_controller_t *controller, const wh_event_t *event, double seconds);

#endif
