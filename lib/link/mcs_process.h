/* Motion control as a process: a client for the slices, and what it tells all about its commands.
 *
 * Made to be the partners of a run (mcs/mcs.h): connect opens the client once the layout is known, watch
 * tells the commands on WAFERHAND_MCS. Requests from others are kept until a session has time for them, but
 * for three that are answered at once, also while a command runs:
 *
 *   STOP     the command that runs, and the requests that wait, end with WH_STATUS_STOPPED; with the name
 *            of a mechanism behind it: the command that has it, and no other
 *   STATUS   what wh_mcs_describe says
 *   VERSION  the program's
 *
 * A script takes no other requests: WH_STATUS_BUSY. In a script STOP ends the command that runs, or the next
 * one if it comes between two.
 */
#ifndef WH_LINK_MCS_PROCESS_H
#define WH_LINK_MCS_PROCESS_H

#include "../mcs/mcs.h"
#include "outcome.h"
#include "protocol_client.h"

/* Requests that wait; more are answered with "busy". */
#define WH_CONTROL_REQUESTS 16
/* So many answers are remembered: asked again with the same line and run, they are given again as they were,
 * also after a RESET. The run is the same if it is 0, the request's, or that of its answer. With another line
 * or run the number is taken: WH_STATUS_NUMBER_TAKEN. STATUS and VERSION change nothing: they are answered
 * anew each time and not remembered, nor is what was turned away without being executed. */
#define WH_CONTROL_ANSWERED 64

typedef struct {
    int64_t seq, run, layout_hash; /* as in the message */
    char line[WH_LINK_LINE];
} wh_mcs_process_request_t;

typedef struct {
    waferhand_mcs message; /* as it was told, with these texts; its request is 0: free */
    int64_t run;           /* as in the request */
    char line[WH_LINK_LINE];
    char *text; /* of its own */
} wh_mcs_process_answer_t;

/* Whose commands motion control plays, if neither a script nor an operator gives them: hosts at ports. Each
 * function may be null. */
typedef struct {
    const char *busy; /* why other requests than STATUS, VERSION and STOP are turned away; null: they wait */
    void (*stops)(void *user); /* a STOP has come, in place of ending what runs */
    void (*waits)(void *user); /* within an exchange, each 2 ms that the simulator is waited for */
    void *user;
} wh_mcs_process_owner_t;

/* A command that goes on, and what it has of the cell: bits as in the message. Of a task one at a time. */
typedef struct {
    int32_t task, line;
    uint32_t axes, grippers;
    char text[WH_LINK_LINE];
} wh_mcs_process_running_t;

/* Must not be moved once opened. */
typedef struct {
    wh_node_t *node;
    wh_mcs_process_owner_t owner; /* may be set between opening and connecting */
    wh_protocol_client_options_t options;
    wh_protocol_client_t client;
    bool connected;
    const char *script;          /* set by its owner, who keeps it; null: a session takes requests */
    wh_mcs_t *mcs;               /* of the run or session; null before it connects */
    wh_link_identity_t identity; /* of the run; and where it is (without a client, to be set): */
    int64_t utime, seq;
    wh_mcs_process_running_t running[WH_MCS_LANES]; /* in the order in which they began */
    size_t running_count;
    wh_status_t ended_with;             /* the last command, other than WH_OK if it failed */
    wh_mcs_process_request_t executing; /* seq 0: none */
    int64_t last_beat_us;
    wh_mcs_process_request_t waiting[WH_CONTROL_REQUESTS];
    size_t first_waiting, waiting_count;
    wh_mcs_process_answer_t answered[WH_CONTROL_ANSWERED];
    size_t answered_count;
    uint64_t garbage;                      /* datagrams on WAFERHAND_REQUEST that are no request */
    wh_senders_t speakers;                 /* on WAFERHAND_MCS: motion controls */
    wh_run_told_t outcome;                 /* what was told so far, and the verdict once there is one */
    char reason[WH_SANDBOX_MESSAGE_BYTES]; /* of the verdict */
    uint64_t simulator_layout; /* as the last cell told it: the hash, and the path, fit to print */
    char simulator_path[200];
    char explanation[700];
    uint8_t encoded[WH_LINK_DATAGRAM];
} wh_mcs_process_t;

/* Subscribes to requests. The options are the client's; `tick`, `taken` and `user` are set here. False when
 * LCM has no room. */
bool wh_mcs_process_open(wh_mcs_process_t *control, wh_node_t *node,
                         const wh_protocol_client_options_t *options);

/* The partners to hand to a run or a session. */
wh_mcs_partners_t wh_mcs_process_partners(wh_mcs_process_t *control);

/* While nothing moves, and between two slices that are far apart: heartbeat to the simulator, what has come
 * from others. To be called at least every 100 ms. */
void wh_mcs_process_idle(wh_mcs_process_t *control);

/* Takes the next request out of the queue, if there is one: it is then the one being executed, until
 * wh_mcs_process_answer. One that is for another run or layout by now is told so, and the next one taken. */
bool wh_mcs_process_next_request(wh_mcs_process_t *control, char line[WH_LINK_LINE]);

/* Answers the request being executed: error is 0 or its number, text what an operator would read. Of a text
 * that does not fit a datagram the answer tells how much was cut off. */
void wh_mcs_process_answer(wh_mcs_process_t *control, wh_status_t error, const char *text);

/* As a STOP does: all requests that wait, and those that have come by now, end with WH_STATUS_STOPPED without
 * being begun. */
void wh_mcs_process_stop_waiting(wh_mcs_process_t *control);

/* Tells what was expected before there was a run to tell it of. Call it once the identity is known, as
 * connecting by the partners does. */
void wh_mcs_process_catch_up(wh_mcs_process_t *control, const wh_mcs_t *mcs);

/* Tells that the run is over, which the identity is of: another one begins. For who has no client. */
void wh_mcs_process_tell_over(wh_mcs_process_t *control);

/* Answers the requests that wait and those that have come by now, and tells that the run is over, how it
 * ended, and how much was told of it (link/outcome.h). Run or session may be gone by now. */
void wh_mcs_process_finish(wh_mcs_process_t *control);

/* Frees the answers. One that was never opened must be all zero. */
void wh_mcs_process_close(wh_mcs_process_t *control);

#endif
