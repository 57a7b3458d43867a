/* `run --lcm`: motion control and simulator in one process, coupled by calls, while all that would travel
 * between them is published for whoever watches, and recorded. */
#ifndef WH_LINK_BROADCAST_H
#define WH_LINK_BROADCAST_H

#include "mcs_process.h"
#include "sim_process.h"

/* Must not be moved once opened. */
typedef struct {
    wh_link_t link; /* first */
    wh_node_t *node;
    wh_mcs_process_t control; /* tells the commands; its client is not used */
    wh_sim_process_t simulation;
    wh_link_identity_t identity;
    bool connected;
} wh_broadcast_t;

/* False when LCM has no room. */
bool wh_broadcast_open(wh_broadcast_t *broadcast, wh_node_t *node, void (*say)(void *user, const char *text),
                       void *user);

/* The partners to hand to a run. */
wh_mcs_partners_t wh_broadcast_partners(wh_broadcast_t *broadcast);

/* Tells that the run is over and releases what was opened. */
void wh_broadcast_close(wh_broadcast_t *broadcast);

#endif
