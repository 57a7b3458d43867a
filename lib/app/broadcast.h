/* Motion control and simulator in one process, coupled by calls, while all messages between them are
 * published for observers, and recorded. `run` and `serve` use it. */
#ifndef WH_APP_BROADCAST_H
#define WH_APP_BROADCAST_H

#include "../link/sim_process.h"
#include "../log/recording.h"
#include "connection.h"

/* Must not be moved once opened. To be read: node, record and simulation. */
typedef struct {
    wh_link_t link; /* first */
    wh_node_t node;
    wh_recording_t record;
    bool is_watched;              /* the messages are wanted one by one, not slices in a record alone */
    wh_mcs_process_t control;     /* tells the commands; its client is not used */
    wh_sim_process_t *simulation; /* null before the run begins */
    wh_sim_process_t rooms[2];    /* the simulation uses one; after the layout is read anew, the next one uses
                                   * the other */
    uint64_t layouts;             /* the number of simulations so far */
    wh_link_identity_t identity;
} wh_broadcast_t;

/* Opens LCM at `url` (null: the default) if `is_lcm`, else a network within the process, and the
 * recording, by `program`, if one is wanted. False, with a line on standard error and nothing to close, if
 * that fails. */
bool wh_broadcast_open(wh_broadcast_t *broadcast, const char *program, const wh_record_arguments_t *record,
                       bool is_lcm, const char *url);

/* The partners of the run or session that is published. Each run of a session is published as a run of its
 * own. */
wh_mcs_partners_t wh_broadcast_partners(wh_broadcast_t *broadcast);

/* Does the work that is due by the clock while nothing moves. Call it at least every 100 ms if people
 * watch. */
void wh_broadcast_tick(wh_broadcast_t *broadcast);

/* Tells that the run is over. A script's run may be gone by now, a session not yet. False if the recording
 * failed, which standard error has said. */
bool wh_broadcast_close(wh_broadcast_t *broadcast);

#endif
