/* The end of `sim --serial` and `--udp`: how the line was, and whether the run passed. */
#ifndef WH_APP_SIM_BOARD_TOLD_H
#define WH_APP_SIM_BOARD_TOLD_H

#include "../loop/cable.h"
#include "../loop/exchange.h"
#include "../loop/pacing.h"
#include "../loop/plant.h"
#include "../text/json.h"

/* An object of how often each kind of event was, and jams and misses of edge grips. */
json_t *wh_sim_board_counts(const wh_plant_found_t *found);

/* All pointers are borrowed. */
typedef struct {
    bool lenient, lockstep;
    bool is_gone, is_silent;    /* the line was gone; the board was silent for too long */
    bool is_cut;                /* a signal came before the seconds that were asked for */
    wh_status_t refusal;        /* by which the simulator ended the run; WH_OK: it did not */
    uint64_t strangers;         /* sound frames of others than the board */
    int64_t begun_us, ended_us; /* by the wall clock */
    const wh_exchange_t *exchange;
    wh_plant_t *plant;
    const wh_pacing_t *pacing;
    const wh_cable_t *line;
    const wh_board_gathered_t *in;
} wh_sim_board_told_t;

/* Says it by the plant's node, tells those who record that the run is over, and with `json` prints an object.
 * Returns the exit status: a run passes if each slice had an answer of its own and nothing was wrong with
 * frames, board, clock or cell. `lenient` passes over all but the cell, and refused numbers. */
int wh_sim_board_tell(wh_sim_board_told_t *told, bool json);

#endif
