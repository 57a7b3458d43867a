/* The simulator as a process: commands come in over LCM, states go out, and every watcher gets the cell and
 * the proximity values. link/protocol_server.h has the protocol; this part waits, speaks and keeps time. */
#ifndef WH_LINK_SIM_PROCESS_H
#define WH_LINK_SIM_PROCESS_H

#include "node.h"
#include "protocol_server.h"

/* A motion control that has not sent a command for this time is called silent, us. */
#define WH_SIMULATION_SILENCE_US 500000
/* The interval at which the cell is told again, us. */
#define WH_SIMULATION_CELL_US 1000000
/* The shortest interval of proximity values, us of wall-clock time; slices with events always tell them.
 * The values of the last slice always go out, at the latest in a tick. */
#define WH_SIMULATION_PROXIMITY_US 5000

typedef struct {
    uint64_t garbage;   /* datagrams that are no message of ours */
    uint64_t silences;  /* times that motion control fell silent */
    uint64_t unsent;    /* datagrams that the network refused */
    uint64_t strangers; /* commands and states of senders other than the one that has the simulator */
} wh_sim_process_counters_t;

/* With `one_sender` the process whose command came first has the simulator, until its run is over or it has
 * been silent for this time. */
#define WH_SIMULATION_BOUND_US 10000000

typedef struct {
    wh_node_t *node;
    wh_protocol_server_t server;
    wh_link_cell_t cell;
    bool one_sender;       /* take commands and states of one sender alone; the caller sets it */
    uint64_t bound;        /* that sender; 0: whoever comes first */
    const int32_t *valves; /* values of outputs.txt; null: the commands' own */
    int64_t last_command_us, last_cell_us, last_proximity_us;
    bool proximity_waits; /* the last slice's values wait until they may go out */
    int64_t other_run;    /* the last run that was turned away for its layout */
    bool running;         /* a run has begun and is not over */
    bool silent;          /* motion control has fallen silent in it */
    /* Called with what motion control says of the present run; may be null. */
    void (*heard)(void *user, const waferhand_mcs *message);
    void *heard_user;
    wh_sim_process_counters_t counters;
    uint8_t encoded[WH_LINK_DATAGRAM];
} wh_sim_process_t;

/* Subscribes to the simulator's channels and tells the cell. If it does not listen, the caller steps it by
 * wh_sim_process_step. Returns WH_STATUS_BAD_CAPACITY for a layout that does not fit messages,
 * WH_STATUS_NO_NETWORK when LCM has no room. `layout` and `node` must outlive it. It must not be moved
 * afterwards. */
wh_status_t wh_sim_process_open(wh_sim_process_t *simulation, wh_node_t *node, const wh_layout_t *layout,
                                bool listens);

/* Steps a command as if it had come from the network, and publishes the results. Returns the status in the
 * answer; `state` is a view of the simulator's memory. */
wh_status_t wh_sim_process_step(wh_sim_process_t *simulation, const waferhand_command *message,
                                wh_state_t *state);

/* Takes a state over as if it had come from the network, and publishes the results. Returns false if it is
 * not taken. */
bool wh_sim_process_restore(wh_sim_process_t *simulation, const waferhand_state *message);

/* Does what is due by the clock: tells the cell and the proximity values of a cell that rests, and notices
 * the silence of motion control. Call it at least every 100 ms. */
void wh_sim_process_tick(wh_sim_process_t *simulation);

/* Ends the run: tells the values that have waited. The layout may then go, if only wh_sim_process_close
 * follows. */
void wh_sim_process_rest(wh_sim_process_t *simulation);

/* Call it before the node is closed. It tells the values that have waited, too. */
void wh_sim_process_close(wh_sim_process_t *simulation);

#endif
