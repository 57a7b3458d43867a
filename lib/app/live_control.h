/* --page-control: who has the token may pause, step and pace a run, or is a tester of `serve`.
 *
 * A run is only held up: no request changes its commands or its hash, but a HOLD of a flow's robot, which
 * changes when they come. A tester's requests go to the tester's
 * port of `serve` as JSON lines, so a transcript has them and plays them again.
 */
#ifndef WH_APP_LIVE_CONTROL_H
#define WH_APP_LIVE_CONTROL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "live_hold.h"
#include "live_pace.h"

/* Hex digits of a token. */
#define WH_LIVE_TOKEN 32

typedef enum {
    WH_LIVE_NO_CONTROL,
    WH_LIVE_RUN,   /* slices wait here */
    WH_LIVE_TESTER /* a tester's port takes lines */
} wh_live_controlled_t;

/* Zero it to begin with. The stepping thread reads what is atomic; the rest is the page's. */
typedef struct {
    wh_live_controlled_t controlled;
    char token[WH_LIVE_TOKEN + 1];
    bool is_paused;       /* atomic */
    bool ends_at_command; /* atomic: pause when a command has ended */
    wh_live_hold_t hold;
    int64_t slices;   /* atomic: that may pass while it is paused */
    int64_t rate_ppm; /* atomic: the rate, times 1e6; 0: no waiting */
    char tester[80];  /* the address of the tester's port */
    int fd;           /* the connection to it */
    bool is_connected;
    uint64_t requests; /* so far */
} wh_live_control_t;

/* Draws a token. False: the system has no random numbers. */
bool wh_live_control_begin(wh_live_control_t *control, wh_live_controlled_t controlled, double rate);
void wh_live_control_end(wh_live_control_t *control);

/* The stepping thread's: a slice of the run's time `run_us` is over; waits while it is paused, and for the
 * pace. `rest` is called before it waits for long. */
void wh_live_control_slice(wh_live_control_t *control, wh_live_pace_t *pace, int64_t run_us,
                           void (*rest)(void *user), void *user);

/* The stepping thread's: a command has ended; waits likewise. */
void wh_live_control_command(wh_live_control_t *control, void (*rest)(void *user), void *user);

/* Takes a request of the page, JSON of `size` bytes, { token, and one of: pause (true or false), slices,
 * command (true), rate, line, hold or continue (a robot's name, or true: all) }. Returns HTTP's status, and
 * the answer as JSON in `answer`, to be freed. */
unsigned wh_live_control_take(wh_live_control_t *control, const char *body, size_t size, char **answer);

/* Reads what the tester's port has answered, which comes back as its frames. */
void wh_live_control_drain(wh_live_control_t *control);

#endif
