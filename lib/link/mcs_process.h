/* Motion control as a process: a client for the slices, which also tells everybody about its commands.
 *
 * It serves as the partners of a run (mcs/partners.h): connect opens the client once the layout is known,
 * tell publishes the commands on WAFERHAND_MCS. Requests from others wait until a session has time for
 * them. Three are answered at once, also while a command runs:
 *
 *   STOP     the command that runs, and the requests that wait, end with WH_STATUS_STOPPED; with the name
 *            of a mechanism behind it: the command that has it, and no other
 *   STATUS   the text of wh_mcs_describe
 *   VERSION  the program's
 *
 * A script refuses other requests: WH_STATUS_BUSY. In a script STOP ends the command that runs; between
 * two commands it ends the next one.
 */
#ifndef WH_LINK_MCS_PROCESS_H
#define WH_LINK_MCS_PROCESS_H

#include "../mcs/mcs.h"
#include "outcome.h"
#include "protocol_client.h"

/* The number of requests that may wait; more are answered with "busy". */
#define WH_CONTROL_REQUESTS 16
/* The number of answers that are remembered. A request that comes again with the same line and run gets the
 * same answer again, also after a RESET. The run is the same if it is 0, the request's, or that of its
 * answer. If the line or run differs, the number is taken: WH_STATUS_NUMBER_TAKEN. STATUS and VERSION
 * change nothing: they are answered anew each time and not remembered. A request that was turned away
 * without being executed is not remembered either. */
#define WH_CONTROL_ANSWERED 64

typedef struct {
    int64_t seq, run, layout_hash; /* as in the message */
    char line[WH_LINK_LINE];
} wh_mcs_process_request_t;

typedef struct {
    waferhand_mcs message; /* as it was told, with these texts; if its request is 0, the place is free */
    int64_t run;           /* as in the request */
    char line[WH_LINK_LINE];
    char *text; /* of its own */
} wh_mcs_process_answer_t;

/* The owner of the commands that motion control plays, if neither a script nor an operator gives them:
 * hosts at ports. Each function may be null. */
typedef struct {
    const char *busy; /* why requests other than STATUS, VERSION and STOP are refused; null: they wait */
    void (*stops)(void *user); /* called at a STOP, which then does not end the running command */
    void (*waits)(void *user); /* called within an exchange, each 2 ms of waiting for the simulator */
    void (*asked)(void *user, int64_t request, const char *line); /* a new request has come */
    void (*answered)(void *user, const waferhand_mcs *message);   /* one is answered */
    void *user;
} wh_mcs_process_owner_t;

/* A command that goes on, and the parts of the cell that it has, as bits like in the message. A task has
 * one command at a time. */
typedef struct {
    int32_t task, line;
    uint32_t axes, grippers;
    char text[WH_LINK_LINE];
} wh_mcs_process_running_t;

/* Requests that came, and answers that may be asked for again. */
typedef struct {
    wh_mcs_process_request_t executing; /* seq 0: none */
    wh_mcs_process_request_t waiting[WH_CONTROL_REQUESTS];
    size_t first_waiting, waiting_count;
    wh_mcs_process_answer_t answered[WH_CONTROL_ANSWERED];
    size_t answered_count;
    uint64_t garbage; /* datagrams on WAFERHAND_REQUEST that are no request */
} wh_mcs_process_requests_t;

/* It must not be moved once opened. */
typedef struct {
    wh_node_t *node;
    wh_mcs_process_owner_t owner; /* may be set between opening and connecting */
    wh_protocol_client_options_t options;
    wh_protocol_client_t client;
    bool connected;
    const char *script;          /* the owner sets and keeps it; null: a session takes requests */
    wh_mcs_t *mcs;               /* of the run or session; null before it connects */
    wh_link_identity_t identity; /* identity and place of the run; without a client the caller sets them */
    int64_t utime, seq;
    wh_mcs_process_running_t running[WH_MCS_LANES]; /* in the order in which they began */
    size_t running_count;
    wh_status_t ended_with; /* the last command's status; other than WH_OK if it failed */
    int64_t last_beat_us;
    wh_mcs_process_requests_t requests;
    wh_senders_t speakers;                 /* motion controls on WAFERHAND_MCS */
    int32_t stations_told;                 /* what stations did by themselves, in this run */
    wh_run_told_t outcome;                 /* the messages so far, and the verdict once there is one */
    char reason[WH_SANDBOX_MESSAGE_BYTES]; /* of the verdict */
    uint64_t simulator_layout;             /* as the last cell gave them: the hash, and the path, printable */
    char simulator_path[200];
    char explanation[700];
    uint8_t encoded[WH_LINK_DATAGRAM];
} wh_mcs_process_t;

/* Subscribes to requests. The options are the client's; `tick`, `taken` and `user` are set here. Returns
 * false when LCM has no room. */
bool wh_mcs_process_open(wh_mcs_process_t *control, wh_node_t *node,
                         const wh_protocol_client_options_t *options);

/* The partners to hand to a run or a session. */
wh_mcs_partners_t wh_mcs_process_partners(wh_mcs_process_t *control);

/* Sends a heartbeat to the simulator and handles messages from others. It is for times when nothing moves,
 * and between two slices that are far apart. Call it at least every 100 ms. */
void wh_mcs_process_idle(wh_mcs_process_t *control);

/* Takes a request of this process, for any run, as if it had come on WAFERHAND_REQUEST. `number` is not 0. */
void wh_mcs_process_ask(wh_mcs_process_t *control, int64_t number, const char *line);

/* Takes the next request out of the queue, if there is one. This request is then being executed, until
 * wh_mcs_process_answer. A request for another run or layout is told so, and the next one is taken. */
bool wh_mcs_process_next_request(wh_mcs_process_t *control, char line[WH_LINK_LINE]);

/* Answers the request being executed: `error` is 0 or its number, `text` is the text for an operator. If
 * the text does not fit a datagram, the answer tells how much was cut off. */
void wh_mcs_process_answer(wh_mcs_process_t *control, wh_status_t error, const char *text);

/* Acts like a STOP: all requests that wait, and those that have come by now, end with WH_STATUS_STOPPED
 * before they begin. */
void wh_mcs_process_stop_waiting(wh_mcs_process_t *control);

/* Tells the expectations that came before the run began. Call it once the identity is known; the partners'
 * connect does so. */
void wh_mcs_process_catch_up(wh_mcs_process_t *control, const wh_mcs_t *mcs);

/* Tells that the run of the identity is over, because another one begins. It is for callers without a
 * client. */
void wh_mcs_process_tell_over(wh_mcs_process_t *control);

/* Answers the requests that wait and those that have come by now. It then tells that the run is over, how
 * it ended, and how much was told of it (link/outcome.h). Run or session may no longer exist. */
void wh_mcs_process_finish(wh_mcs_process_t *control);

/* Frees the answers. A process that was never opened must be all zero. */
void wh_mcs_process_close(wh_mcs_process_t *control);

#endif
