/* The simulator's side of the protocol, without a network: a command message goes in, and an encoded state
 * comes out.
 *
 * There is one run at a time. A command with the next seq is stepped. A command with the current seq is
 * answered again and not stepped, and an older one is ignored. A command further on is stepped only in a
 * free run; the slices between count as missed. A new run begins with seq 1. A run that is not known, or
 * not known this far, is answered with UNKNOWN_RUN. The state then comes back as a restore, and the run
 * continues from it. `sim` and `replay` both use it, so `replay` repeats exactly what the simulator did.
 * Nothing is allocated after wh_protocol_server_open.
 */
#ifndef WH_LINK_PROTOCOL_SERVER_H
#define WH_LINK_PROTOCOL_SERVER_H

#include "../layout/collision.h"
#include "../layout/grips.h"
#include "../sim/simulator.h"
#include "../wire/messages.h"

/* The number of recent runs that are remembered, so that their late commands do not start them again. */
#define WH_SERVER_PAST_RUNS 64

/* Counts of messages by result; they add up to `commands` and `restores`. */
typedef struct {
    uint64_t commands; /* all commands */
    uint64_t stepped, repeated, stale, refused, unknown_run, other_layout, run_over, malformed;
    uint64_t restores; /* all restores */
    uint64_t restored, restore_ignored, restore_refused;
} wh_protocol_server_counters_t;

typedef struct {
    const wh_layout_t *layout;   /* borrowed */
    wh_link_identity_t identity; /* identity.run is 0 before the first run */
    wh_simulator_t simulator;
    wh_collision_t collision; /* without memory if the layout asks for no check */
    wh_state_t state;         /* after the last step */
    int64_t seq;              /* slice of the last step; 0: none yet */
    wh_real_t axes[WH_AXES];  /* axes of the last step's command */
    bool has_axes;            /* the command had all of the machine's axes */
    int64_t missed;           /* slices that never came, in a free run */
    bool encodes_later;       /* the caller sets it: wh_protocol_server_encode encodes the state of a step */
    int64_t past_runs[WH_SERVER_PAST_RUNS];
    size_t past_count;
    wh_protocol_server_counters_t counters;
    wh_link_arrays_t arrays; /* the table's memory */
    wh_grips_room_t grips;
    wh_wafer_t seen[WH_LINK_WAFERS]; /* wafers that grippers see in a step */
    uint32_t buckets[WH_GRASP_BUCKETS(WH_LINK_WAFERS, WH_GRIPPERS)];
    wh_link_arrays_t spare; /* memory in which a restore is tried first */
    wh_link_state_t room;
    uint8_t encoded[WH_LINK_DATAGRAM]; /* the answer */
    size_t encoded_size;
} wh_protocol_server_t;

/* Results of a message. */
typedef enum {
    WH_SERVER_IGNORED,  /* no answer is due */
    WH_SERVER_STEPPED,  /* a slice was stepped: `encoded` is its state */
    WH_SERVER_NEW_RUN,  /* as above, and it was the first of a run */
    WH_SERVER_ANSWERED, /* nothing was stepped: `encoded` repeats the state, or gives the reason */
    WH_SERVER_RESTORED  /* the state was taken over: `encoded` repeats it */
} wh_protocol_server_result_t;

/* Makes the server ready for a first run. Returns WH_STATUS_BAD_CAPACITY for a layout of more than
 * WH_LINK_WAFERS wafers. `layout` must outlive the server, which must not be moved afterwards. */
wh_status_t wh_protocol_server_open(wh_protocol_server_t *server, const wh_layout_t *layout);

/* Frees the memory of a layout with a collision check; otherwise there is nothing to free. */
void wh_protocol_server_close(wh_protocol_server_t *server);

/* Steps a command. `valves` replace the command's (outputs.txt); null: the command's own. */
wh_protocol_server_result_t wh_protocol_server_command(wh_protocol_server_t *server,
                                                       const waferhand_command *message,
                                                       const int32_t valves[]);

/* Takes a state over if its run is not known or not known this far, its layout is ours, it is consistent
 * and it has the hash that it carries. */
wh_protocol_server_result_t wh_protocol_server_restore(wh_protocol_server_t *server,
                                                       const waferhand_state *message);

/* Encodes the state after the last step, as an answer. */
void wh_protocol_server_encode(wh_protocol_server_t *server);

/* Writes the state after the last step as a message into `room`, without its check, for readers in this
 * process. `hash` is the result of wh_protocol_server_hash. */
void wh_protocol_server_tell(wh_protocol_server_t *server, uint64_t hash);

/* wh_simulator_hash. */
uint64_t wh_protocol_server_hash(const wh_protocol_server_t *server);

#endif
