/* Controllers at their ports: the tool's host software talks to them while a session plays its requests.
 *
 * Each port moves one thing at a time; several ports move side by side. While a command runs, each of its
 * slices serves the ports: a host's requests are answered between two slices, and no client can delay a
 * slice. Simulated time passes only while a command runs; then a slice lasts as long by the wall clock, times
 * 1 / rate. One thread. The loop, and the file of each step:
 *
 *     until the operator ends it                                        host.c
 *         the oldest accepted action is played                          playing.c, jobs.c
 *             in each of its slices the ports are served, as below
 *         the ports are served, and waited for while nothing runs       host.c
 *             what has come at a port becomes frames                    reading.c, port.h, framing.h
 *                 a frame becomes a request                             dialect.h
 *                     it is answered, refused, stops what runs,
 *                     or is accepted as an action                       requests.c, actions.c
 *                         the answer becomes a frame                    telling.c, dialect.h
 *             frames leave when they are due                            line.c
 */
#ifndef WH_HOST_HOST_H
#define WH_HOST_HOST_H

#include "actions.h"
#include "state.h"
#include "status.h"

/* A port as the command line says it. */
typedef struct {
    const char *dialect;   /* its file */
    const char *mechanism; /* a robot or a station; null: as the dialect says, all of its kind */
    const char *address;   /* or a pty's link if `is_pty`; unused where a transcript is played */
    bool is_pty;
    const char *unit; /* its address on a line of several units; null: the line is its own */
    bool shares_line; /* its line is that of the dialect before it; it has no address then */
} wh_host_port_t;

/* Adds a controller, with its port. False, with the reason in `message` of the dialect, which is the last
 * controller's: host->controllers[host->count - 1]. */
bool wh_host_add(wh_host_t *host, const wh_host_port_t *port);

/* True if the last dialect has more ports than were opened: its `ports`. Then another one is added, of which
 * only the address counts. False, with the reason, as above. */
bool wh_host_needs_port(const wh_host_t *host);
bool wh_host_add_port(wh_host_t *host, const wh_host_port_t *port);

/* Adds the port of a tester beside the hosts: JSON lines, see lua/dialects/serving.md. False, with the
 * reason, as above. */
bool wh_host_add_control(wh_host_t *host, const char *address);

/* To be the session's listener. */
wh_mcs_listener_t wh_host_listener(wh_host_t *host);

/* Serves until *host->stop is set. */
void wh_host_run(wh_host_t *host);

/* Plays host->played to its end: each frame of the host at its slice. True if all answers are those of the
 * transcript, to the byte and slice; else host->played->message tells the first difference. */
bool wh_host_converse(wh_host_t *host);

/* For a simulator in another process, to be called while the answer to a slice is waited for: ports are
 * served, without `tick`, and time by the wall clock does not count. */
void wh_host_wait(wh_host_t *host);

/* Closes the ports and frees all. The session is the caller's. */
void wh_host_close(wh_host_t *host);

#endif
