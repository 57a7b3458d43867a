/* Motion control's side of the protocol: the slice interface (sim/slice.h) over LCM.
 *
 * In lockstep an exchange sends the command, waits for its state, and sends it again until that comes: first
 * after a few round trips, then less and less often. A simulator that was started anew gets the last state
 * back. Free-running, it sends one command each slice of wall-clock time and takes the states as they come;
 * the first slice is always in lockstep, and so is each that wh_protocol_client_await is called before.
 * Silence of the simulator is reported within a second, and its
 * return: it is silent only while it owes an answer. Two simulators that answer in turns are reported, too.
 * No state is taken whose hash is not the one that its own content has, nor one that no grasp table could
 * be in.
 */
#ifndef WH_LINK_PROTOCOL_CLIENT_H
#define WH_LINK_PROTOCOL_CLIENT_H

#include <signal.h>

#include "messages.h"
#include "node.h"

/* A simulator that has not answered for so long is called silent, us. */
#define WH_CLIENT_SILENCE_US 500000

typedef struct {
    uint64_t sent, repeated;     /* commands, and how many of them once more */
    uint64_t answers, unasked;   /* states taken; states of other runs and slices */
    uint64_t malformed;          /* datagrams that are no state, or whose hash is wrong */
    uint64_t restored, silences; /* times that the state was sent back; silences reported */
    uint64_t unwritten;          /* valves that the file could not be made of */
    uint64_t late;               /* free-running: slices sent more than a slice late */
} wh_protocol_client_counters_t;

typedef struct {
    const char *outputs;               /* write the valves to this file, too, before a slice; may be null */
    double rate;                       /* wall-clock rate of a free-running run; 0: lockstep */
    int64_t timeout_us;                /* wait so long for an answer; 0: for ever */
    const volatile sig_atomic_t *stop; /* not zero: send nothing more; may be null */
    bool (*interrupted)(void);         /* a signal came that is to end a wait for silence; may be null */
    void (*tick)(void *user);          /* called once a second of a long motion; may be null */
    /* Called each 2 ms while an answer is waited for; may be null. */
    void (*waits)(void *user);
    /* Called for each state that is taken for the first time, also for those between two exchanges of a free
     * run; may be null. */
    void (*taken)(void *user, const wh_state_t *state);
    void *user;
} wh_protocol_client_options_t;

/* Written by client*.c. Must not be moved once opened. */
typedef struct {
    wh_link_t link; /* first: &client->link is what the MCS talks to */
    wh_node_t *node;
    const wh_layout_t *layout; /* null: the run is over */
    wh_protocol_client_options_t options;
    wh_link_identity_t identity;
    waferhand_command command;    /* the last one sent */
    wh_state_t state;             /* the last one taken; status WH_OK */
    int32_t written[WH_GRIPPERS]; /* the valves in the outputs file; -1 before the first */
    bool pending;                 /* the last exchange ended before its answer came */
    bool awaited;                 /* the next exchange waits for its state, in a free run, too */
    bool has_state, answered, asked_for_state;
    wh_status_t refusal;        /* why the last command was not stepped */
    uint64_t other_layout_hash; /* with WH_STATUS_OTHER_LAYOUT: the simulator's */
    int64_t missed;             /* as the simulator counts */
    uint64_t hash;              /* of the last state */
    int64_t resend_us;          /* how long to wait before sending again */
    int64_t asked_us; /* when the first command went out that nothing was heard since; 0: no answer is owed */
    int64_t start_us, last_tick_us, restored_us;
    bool silent;
    int restores_most,
        restores;         /* so often the state is sent back to one that asks; 0: as often as it asks */
    bool timed_out;       /* an exchange waited longer than it may, and nothing was heard since */
    wh_senders_t senders; /* of states: simulators */
    wh_protocol_client_counters_t counters;
    wh_link_arrays_t arrays;
    wh_link_arrays_t spare;
    wh_event_t events[4 * WH_LINK_EVENTS]; /* of all states since the last exchange */
    size_t event_count, events_delivered;
    bool has_lost_events;              /* since the last exchange */
    uint8_t restore[WH_LINK_DATAGRAM]; /* the last state as it came, to be sent back */
    size_t restore_size;
} wh_protocol_client_t;

/* Subscribes to the states and begins a run with a random number other than 0. `layout` and `node`, which
 * says when the simulator is silent or back, must outlive it. False when LCM has no room. */
bool wh_protocol_client_open(wh_protocol_client_t *client, wh_node_t *node, const wh_layout_t *layout,
                             const wh_protocol_client_options_t *options);

/* To be called before the first slice after an exchange that failed: waits for the answer to a command that
 * was given up, since it may have arrived all the same, and the next one must not leave a gap. WH_OK if no
 * answer is owed, otherwise as an exchange. */
wh_status_t wh_protocol_client_resume(wh_protocol_client_t *client);

/* The last slice that was sent, unless it was refused: then the last whose state has come; 0: none. A slice
 * behind it has not gone out, and the next one takes its number. */
int64_t wh_protocol_client_reached(const wh_protocol_client_t *client);

/* The next exchange waits for its state, in a free run, too: to be called before the last slice of a motion,
 * if what comes next is decided by its state. */
void wh_protocol_client_await(wh_protocol_client_t *client);

/* What the run is after the last slice, as bytes for wh_protocol_client_restore: a command, and the state as
 * it came, of at most sizeof(waferhand_command) + WH_LINK_DATAGRAM bytes. Waits a little for that state;
 * returns how many bytes, 0 if it does not come. */
size_t wh_protocol_client_save(wh_protocol_client_t *client, uint8_t bytes[]);

/* Begins another run that goes on from there: the simulator gets the state sent back, as one does that was
 * started anew. `state` becomes that, without events; before a first slice it stays. If the simulator takes
 * it not, WH_STATUS_NOT_RESTORED, or as an exchange; then the run is the one before. */
wh_status_t wh_protocol_client_restore(wh_protocol_client_t *client, const uint8_t bytes[], size_t size,
                                       wh_state_t *state);

/* Hears a datagram with a state: what the channel brings, or what is to be taken for it. */
void wh_protocol_client_hear(wh_protocol_client_t *client, const void *data, size_t size);

/* Forgets the run and begins another one, of a layout that may be another. Counters stay. */
void wh_protocol_client_begin(wh_protocol_client_t *client, const wh_layout_t *layout);

/* The run is over, and its layout may go: each state that still comes, such as the second answer to a
 * command that was sent twice, counts as unasked. Until wh_protocol_client_begin nothing else may be asked
 * of the client. */
void wh_protocol_client_end(wh_protocol_client_t *client);

/* Sends a command. One that is lost is no error: whoever waits for the answer sends it again. */
void wh_protocol_client_publish(wh_node_t *node, const waferhand_command *command);

/* A random number for a run, other than 0. */
int64_t wh_protocol_client_draw_run(void);

/* Sends the last command again, so that the simulator knows that we are alive while nothing moves, and
 * notices by the answer whether it is. To be called now and then between commands; handles what has come. */
void wh_protocol_client_heartbeat(wh_protocol_client_t *client);

/* Waits up to so long for the state of the last command, so that what is asked next is asked of it. True when
 * it came, or when none is to come. */
bool wh_protocol_client_settle(wh_protocol_client_t *client, int64_t timeout_us);

#endif
