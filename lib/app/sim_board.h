/* `waferhand sim LAYOUT --serial DEVICE | --udp ADDRESS:PORT`: a controller's board drives the cell, slice by
 * slice, by the wall clock. lib/manual/board.md is its manual. */
#ifndef WH_APP_SIM_BOARD_H
#define WH_APP_SIM_BOARD_H

#include "../link/sim_process.h"
#include "../text/options.h"

/* Zero it to begin with. */
typedef struct {
    const char *serial, *udp;
    uint64_t baud, lag;
    wh_option_list_t allowed;
    double seconds, timeout_s;
    bool lockstep, lenient;
} wh_sim_board_arguments_t;

extern const wh_option_t wh_sim_board_options[];

/* The check of their table: refuses options that do not go together. */
void wh_sim_board_check(const void *filled, struct argp_state *state);

static inline bool wh_sim_board_is_wanted(const wh_sim_board_arguments_t *arguments) {
    return arguments->serial || arguments->udp;
}

/* The other work, due after each slice and at least each 100 ms. */
typedef struct {
    void (*tick)(void *user);
    void *user;
} wh_sim_board_ticks_t;

/* Serves the board until a signal, the end of `seconds`, or the end of the line; says what there was, and
 * with `json` prints it. The simulation must be open and not listening. Returns the exit status. */
int wh_sim_board_serve(const wh_sim_board_arguments_t *arguments, wh_sim_process_t *simulation,
                       const wh_sim_board_ticks_t *ticks, bool json);

#endif
