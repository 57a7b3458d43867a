/* Motion control's side of the protocol: the slice interface (sim/slice.h) over LCM.
 *
 * In lockstep an exchange sends the command and waits for its state. It sends the command again until the
 * state comes: first after a few round trips, then less and less often. A simulator that was started again
 * gets the last state back. In a free run it sends one command in each slice of wall-clock time and takes
 * the states as they come. The first slice is always in lockstep, and so is each slice after a call of
 * wh_protocol_client_await. It reports the simulator's silence within a second, and its return. The
 * simulator is silent only while it owes an answer. It also reports two simulators that answer in turns. It
 * compares each slice's answer with what was sent: the grippers must stand there, unless a fault stops
 * them. It also hears commands of this run that another process sends. Each of both is told once, and
 * counted (`disturbed`), because the simulator then did something that was not asked. It takes no state
 * whose hash does not match its content, and no state that no grasp table could be in.
 */
#ifndef WH_LINK_PROTOCOL_CLIENT_H
#define WH_LINK_PROTOCOL_CLIENT_H

#include <signal.h>

#include "../wire/messages.h"
#include "node.h"

/* A simulator that has not answered for this time is called silent, us. */
#define WH_CLIENT_SILENCE_US 500000

typedef struct {
    uint64_t sent, repeated;     /* commands, and repetitions of commands */
    uint64_t answers, unasked;   /* states taken; states of other runs and slices */
    uint64_t malformed;          /* datagrams that are no state, or whose hash is wrong */
    uint64_t restored, silences; /* times that the state was sent back; silences reported */
    uint64_t unwritten;          /* valves that could not be written to the file */
    uint64_t late;               /* free-running: slices sent more than a slice late */
    uint64_t disturbed; /* commands of another sender, and states that none of our commands asked for */
} wh_protocol_client_counters_t;

typedef struct {
    const char *outputs;               /* write the valves to this file, too, before a slice; may be null */
    double rate;                       /* wall-clock rate of a free-running run; 0: lockstep */
    int64_t timeout_us;                /* wait this long for an answer; 0: for ever */
    const volatile sig_atomic_t *stop; /* not zero: send nothing more; may be null */
    bool (*interrupted)(void);         /* true if a signal came that ends a long wait; may be null */
    void (*tick)(void *user);          /* called once a second of a long motion; may be null */
    /* Called each 2 ms while it waits for an answer; may be null. */
    void (*waits)(void *user);
    /* Called for each state that is taken for the first time, also for states between two exchanges of a
     * free run; may be null. */
    void (*taken)(void *user, const wh_state_t *state);
    void *user;
} wh_protocol_client_options_t;

/* The client keeps the grippers' targets for this many slices, because a free run's states come later. */
#define WH_CLIENT_SENT 1024
#define WH_CLIENT_DISTURBANCE 160

/* The grippers' targets in a slice. */
typedef struct {
    int64_t seq; /* 0: none */
    uint64_t poses;
} wh_protocol_client_sent_t;

/* The last state that was taken. */
typedef struct {
    bool is_there;
    wh_state_t state; /* status WH_OK */
    wh_link_arrays_t arrays;
    uint64_t hash;
    int64_t missed; /* the simulator's count */
} wh_protocol_client_taken_t;

/* The events of all states since the last exchange. */
typedef struct {
    wh_event_t events[4 * WH_LINK_EVENTS];
    size_t count, delivered;
    bool has_lost; /* some were lost since */
} wh_protocol_client_heard_t;

/* A simulator that was started again asks for the last state, and gets it back. */
typedef struct {
    bool is_asked;
    int most, count; /* times that one gets it; most 0: no limit */
    int64_t told_us;
    uint8_t bytes[WH_LINK_DATAGRAM]; /* of the last state */
    size_t size;
} wh_protocol_client_restoring_t;

/* How long nothing has been heard. */
typedef struct {
    int64_t asked_us; /* time of the first command since then; 0: no answer is owed */
    bool is_told;
    bool timed_out; /* an exchange waited longer than it may, and nothing was heard since */
} wh_protocol_client_silence_t;

/* Only client*.c write it. It must not be moved once opened. */
typedef struct {
    wh_link_t link; /* first: the MCS talks to &client->link */
    wh_node_t *node;
    const wh_layout_t *layout; /* null: the run is over */
    wh_protocol_client_options_t options;
    wh_link_identity_t identity;
    waferhand_command command;    /* the last command sent */
    int32_t written[WH_GRIPPERS]; /* the valves in the outputs file; -1 before the first */
    bool pending;                 /* the last exchange ended before its answer came */
    bool awaited;                 /* the next exchange waits for its state, also in a free run */
    bool answered;
    wh_status_t refusal;        /* the reason why the last command was not stepped */
    uint64_t other_layout_hash; /* the simulator's hash, with WH_STATUS_OTHER_LAYOUT */
    int64_t resend_us;          /* the wait before sending again */
    int64_t start_us, last_tick_us;
    wh_protocol_client_taken_t taken;
    wh_protocol_client_heard_t heard;
    wh_protocol_client_restoring_t restoring;
    wh_protocol_client_silence_t silence;
    wh_senders_t senders;                    /* of states: the simulators */
    uint64_t own;                            /* our own sender; 0: not known yet */
    char disturbance[WH_CLIENT_DISTURBANCE]; /* the other sender of commands, in words; empty: none */
    wh_protocol_client_sent_t sent[WH_CLIENT_SENT];
    wh_protocol_client_counters_t counters;
    wh_link_arrays_t spare;
} wh_protocol_client_t;

/* Subscribes to the states and begins a run with a random number other than 0. `layout` and `node` must
 * outlive it; the node tells when the simulator is silent or back. Returns false when LCM has no room. */
bool wh_protocol_client_open(wh_protocol_client_t *client, wh_node_t *node, const wh_layout_t *layout,
                             const wh_protocol_client_options_t *options);

/* Call it before the first slice after an exchange that failed. It waits for the answer to the command that
 * was given up. The command may have arrived after all, and the next one must not leave a gap. Returns
 * WH_OK if no answer is owed, otherwise the status of an exchange. */
wh_status_t wh_protocol_client_resume(wh_protocol_client_t *client);

/* The last slice that was sent. If it was refused, the last slice whose state has come; 0: none. A later
 * slice was not sent, and the next one takes its number. */
int64_t wh_protocol_client_reached(const wh_protocol_client_t *client);

/* Makes the next exchange wait for its state, also in a free run. Call it before the last slice of a motion
 * if its state decides what comes next. */
void wh_protocol_client_await(wh_protocol_client_t *client);

/* Saves the run after the last slice as bytes for wh_protocol_client_restore. They are a command and the
 * bytes of the state, at most sizeof(waferhand_command) + WH_LINK_DATAGRAM. It waits a little for that
 * state, and returns the number of bytes, 0 if the state does not come. */
size_t wh_protocol_client_save(wh_protocol_client_t *client, uint8_t bytes[]);

/* Begins another run that continues from there. It sends the simulator the state back, as to one that was
 * started again. `state` becomes that state, without events; before a first slice it stays unchanged. If
 * the simulator refuses, it returns WH_STATUS_NOT_RESTORED, or the status of an exchange; then the run
 * before goes on. */
wh_status_t wh_protocol_client_restore(wh_protocol_client_t *client, const uint8_t bytes[], size_t size,
                                       wh_state_t *state);

/* Hears a datagram with a state, from the channel or from the caller. */
void wh_protocol_client_hear(wh_protocol_client_t *client, const void *data, size_t size);

/* Forgets the run and begins another one, perhaps of another layout. Counters keep their values. */
void wh_protocol_client_begin(wh_protocol_client_t *client, const wh_layout_t *layout);

/* Ends the run; its layout may go. Each later state counts as unasked, such as the second answer to a
 * command that was sent twice. Until wh_protocol_client_begin no other function of the client may be
 * called. */
void wh_protocol_client_end(wh_protocol_client_t *client);

/* Sends a command. A lost command is no error, because whoever waits for the answer sends it again. */
void wh_protocol_client_publish(wh_node_t *node, const waferhand_command *command);

/* A random number for a run, other than 0. */
int64_t wh_protocol_client_draw_run(void);

/* Sends the last command again, so that the simulator knows that we are alive while nothing moves. The
 * answer shows whether the simulator is. Call it now and then between commands; it handles the messages
 * that have come. */
void wh_protocol_client_heartbeat(wh_protocol_client_t *client);

/* Waits up to `timeout_us` for the state of the last command, so that later questions are about that state.
 * Returns true when it came, or when none is due. */
bool wh_protocol_client_settle(wh_protocol_client_t *client, int64_t timeout_us);

#endif
