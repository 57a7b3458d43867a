/* The live page of a simulator that others command, over LCM or from a board: `sim --page`. */
#ifndef WH_APP_LIVE_SIM_H
#define WH_APP_LIVE_SIM_H

#include "../link/sim_process.h"
#include "live.h"

/* The most tasks whose commands are told to begin: those of a script, and the script itself. */
#define WH_LIVE_SIM_TASKS 65

/* Zero it to begin with; it must not be moved once opened. */
typedef struct {
    wh_live_t *live; /* null: no page is wanted */
    const wh_sim_process_t *simulation;
    wh_mcs_listener_t listener;
    wh_command_t command;             /* the axes of the last slice */
    int64_t run, seq;                 /* of the last slice that was handed on */
    int32_t begun[WH_LIVE_SIM_TASKS]; /* tasks whose command has been told to begin */
    size_t begun_count;
} wh_live_sim_t;

/* The one that commands the cell. */
typedef struct {
    bool is_board;
    double rate; /* of simulated time to the wall clock; 0: as fast as commands come */
} wh_live_sim_driver_t;

/* Opens the page, if one is wanted; the simulation must be open and outlive it. False, with a message: it
 * cannot be served. */
bool wh_live_sim_open(wh_live_sim_t *sim, const wh_live_arguments_t *arguments, wh_sim_process_t *simulation,
                      const wh_live_sim_driver_t *driver);

/* Hands the last slice on. Call it after each message, and each 100 ms. */
void wh_live_sim_tick(wh_live_sim_t *sim);

/* Call it before the simulation is closed. */
void wh_live_sim_close(wh_live_sim_t *sim);

#endif
