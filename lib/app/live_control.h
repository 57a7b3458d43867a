/* --page-control: who has the token may pause, step and pace a run, may be a tester of `serve`, or an
 * operator beside the prompt.
 *
 * A run is only held up: no request changes its commands or its hash, but a HOLD of a flow's robot, which
 * changes when they come. A tester's requests go to the tester's port of `serve` as JSON lines, so a
 * transcript has them and plays them again. An operator's lines become requests to motion control, like those
 * on WAFERHAND_REQUEST, so a recording has them.
 */
#ifndef WH_APP_LIVE_CONTROL_H
#define WH_APP_LIVE_CONTROL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "live_hold.h"
#include "live_lines.h"
#include "live_pace.h"
#include "live_tester.h"

/* Hex digits of a token. */
#define WH_LIVE_TOKEN 32

typedef enum {
    WH_LIVE_NO_CONTROL,
    WH_LIVE_RUN,    /* slices wait here */
    WH_LIVE_TESTER, /* a tester's port takes lines */
    WH_LIVE_PROMPT  /* motion control takes an operator's lines */
} wh_live_controlled_t;

/* Zero it to begin with. The stepping thread reads what is atomic; the rest is the page's. */
typedef struct {
    wh_live_controlled_t controlled;
    bool paces; /* slices wait here, so that pauses, steps and a rate are possible */
    char token[WH_LIVE_TOKEN + 1];
    bool is_paused;       /* atomic: it is to stand still */
    bool stands;          /* atomic: it does */
    bool ends_at_command; /* atomic: pause when a command has ended */
    wh_live_hold_t hold;
    int64_t slices;   /* atomic: that may pass while it is paused */
    int64_t rate_ppm; /* atomic: the rate, times 1e6; 0: no waiting */
    wh_live_tester_t tester;
    wh_live_lines_t lines; /* an operator's */
    int64_t base;          /* requests have greater numbers */
    int64_t requests;      /* the last one's number */
} wh_live_control_t;

/* Draws a token. False: the system has no random numbers, or no descriptors. */
bool wh_live_control_begin(wh_live_control_t *control, wh_live_controlled_t controlled, bool paces,
                           double rate);
void wh_live_control_end(wh_live_control_t *control);

/* The stepping thread's: a slice of the run's time `run_us` is over; waits while it is paused, and for the
 * pace. While it is paused `idle` is called at once, and each 2 ms. */
void wh_live_control_slice(wh_live_control_t *control, wh_live_pace_t *pace, int64_t run_us,
                           void (*idle)(void *user), void *user);

/* The stepping thread's: a command has ended; waits likewise. */
void wh_live_control_command(wh_live_control_t *control, void (*idle)(void *user), void *user);

/* Ends a pause. */
void wh_live_control_go_on(wh_live_control_t *control);

/* Takes a request of the page, JSON of `size` bytes, { token, and one of: pause (true or false), slices,
 * command (true), rate, line, complete, hold or continue (a robot's name, or true: all) }. Returns HTTP's
 * status, and the answer as JSON in `answer`, to be freed. */
unsigned wh_live_control_take(wh_live_control_t *control, const char *body, size_t size, char **answer);

#endif
