/* Motion control's end of LCM, as `mcs` opens it from its options. */
#ifndef WH_APP_MCS_LINK_H
#define WH_APP_MCS_LINK_H

#include "../link/mcs_process.h"
#include "link_options.h"

typedef struct {
    const char *url, *record, *outputs; /* null: the default, no record, no outputs.txt */
    double rate;                        /* 0: lockstep */
} wh_mcs_link_options_t;

/* Must not be moved once opened. */
typedef struct {
    wh_node_t node;
    wh_mcs_process_t control;
} wh_mcs_link_t;

/* Catches signals and opens LCM; says on standard error what is wrong. */
bool wh_mcs_link_open(wh_mcs_link_t *link, const wh_mcs_link_options_t *options);

/* Ends the run for all who listen, says what was lost on the way, and closes. */
void wh_mcs_link_close(wh_mcs_link_t *link);

#endif
