/* The cell that hosts command through `serve`. This process simulates it, and may publish and record its
 * messages; or a simulator in another process does, over LCM. */
#ifndef WH_APP_SERVE_CELL_H
#define WH_APP_SERVE_CELL_H

#include "../host/host.h"
#include "broadcast.h"

/* Zero it to begin with. */
typedef struct {
    wh_record_arguments_t record;
    const char *url;  /* null: the default */
    double timeout_s; /* how long to wait for the other simulator; 0: for ever */
    bool lcm;
    bool sim; /* the simulator is another process */
} wh_serve_cell_arguments_t;

extern const wh_option_t wh_serve_cell_options[];
/* The check of their table: refuses options that do not go together. */
void wh_serve_cell_check(const void *arguments, struct argp_state *state);

/* All zero before it is opened. Must not be moved once opened. */
typedef struct {
    const wh_serve_cell_arguments_t *arguments;
    wh_host_t *host;
    wh_broadcast_t broadcast;
    wh_mcs_link_t link;
    bool is_broadcast, is_linked;      /* the broadcast is open, or the link */
    int64_t stopped_us, stopped_slice; /* since when a STOP waits for the answer to a slice, and to which */
} wh_serve_cell_t;

/* Opens what the arguments ask for; `partners` are for the session of `host`, whose tick it takes. False,
 * with a line on standard error, if that fails. To be closed either way. */
bool wh_serve_cell_open(wh_serve_cell_t *cell, const wh_serve_cell_arguments_t *arguments, wh_host_t *host,
                        wh_mcs_partners_t *partners);

/* Call it before the session is closed. False if the recording failed, which standard error has said. */
bool wh_serve_cell_close(wh_serve_cell_t *cell);

#endif
