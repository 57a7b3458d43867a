/* The simulator as a process: commands come in over LCM, states go out, whoever watches gets the cell and the
 * proximity values. The protocol is link/protocol_server.h; this is the part that waits, speaks and keeps
 * time. */
#ifndef WH_LINK_SIM_PROCESS_H
#define WH_LINK_SIM_PROCESS_H

#include "node.h"
#include "protocol_server.h"

/* A motion control that has not sent a command for so long is called silent, us. */
#define WH_SIMULATION_SILENCE_US 500000
/* How often the cell is told again, us. */
#define WH_SIMULATION_CELL_US 1000000
/* How often the proximity values go out at most, us of wall-clock time; slices with events always tell
 * them. Those of the last slice always go out, in a tick if not before. */
#define WH_SIMULATION_PROXIMITY_US 5000

typedef struct {
    uint64_t garbage;  /* datagrams that are no message of ours */
    uint64_t silences; /* times that motion control fell silent */
    uint64_t unsent;   /* datagrams that the network refused */
} wh_sim_process_counters_t;

/* A script has one command at a time, and so has each of its tasks. */
#define WH_SIMULATION_COMMANDS 65

typedef struct {
    int32_t task; /* whose command it is */
    char line[WH_LINK_LINE];
} wh_sim_process_command_t;

typedef struct {
    wh_node_t *node;
    wh_protocol_server_t server;
    wh_link_cell_t cell;
    const int32_t *valves; /* from outputs.txt; null: the commands' own */
    int64_t last_command_us, last_cell_us, last_proximity_us;
    bool proximity_waits; /* of the last slice, until it may go out */
    int64_t other_run;    /* the last one that was turned away for its layout */
    bool running;         /* a run has begun and is not over */
    bool silent;          /* and motion control has fallen silent */
    wh_sim_process_command_t commands[WH_SIMULATION_COMMANDS]; /* that motion control says it executes */
    size_t command_count;
    char command[WH_LINK_LINE]; /* their lines, cut to that; empty: none */
    wh_sim_process_counters_t counters;
    uint8_t encoded[WH_LINK_DATAGRAM];
} wh_sim_process_t;

/* Subscribes to what the simulator hears and tells the cell. If it does not listen it is stepped by
 * wh_sim_process_step. WH_STATUS_BAD_CAPACITY for a layout that does not fit messages,
 * WH_STATUS_NO_NETWORK when LCM has no room. `layout` and `node` must outlive it. Must not be moved
 * afterwards. */
wh_status_t wh_sim_process_open(wh_sim_process_t *simulation, wh_node_t *node, const wh_layout_t *layout,
                                bool listens);

/* Steps a command as if it had come from the network, and publishes what comes of it. Returns the status that
 * the answer carries; `state` is a view of the simulator's memory. */
wh_status_t wh_sim_process_step(wh_sim_process_t *simulation, const waferhand_command *message,
                                wh_state_t *state);

/* Takes a state over as if it had come from the network, and publishes what comes of it. False if it is not
 * taken. */
bool wh_sim_process_restore(wh_sim_process_t *simulation, const waferhand_state *message);

/* What is due by the clock: the cell, the proximity values of a cell that rests, and the silence of motion
 * control. To be called at least every 100 ms. */
void wh_sim_process_tick(wh_sim_process_t *simulation);

/* The run is over: tells what has waited. Then its layout may go, if nothing but wh_sim_process_close
 * follows. */
void wh_sim_process_rest(wh_sim_process_t *simulation);

/* Before the node is closed. Tells what has waited, too. */
void wh_sim_process_close(wh_sim_process_t *simulation);

#endif
