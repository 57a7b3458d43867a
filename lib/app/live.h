/* --page: the page of a cell while it moves. `run`, `sim`, `mcs` and `serve` offer it.
 *
 * A thread of its own serves the page (view/http.h). Some 60 times a second it asks the thread that steps the
 * cell for a look (view/showing.h), adds it to signals of its own, and tells browsers what is new. A
 * browser that comes later gets the whole past. The stepping thread hears of none of this.
 */
#ifndef WH_APP_LIVE_H
#define WH_APP_LIVE_H

#include "../host/transcript.h"
#include "../mcs/partners.h"
#include "../text/options.h"
#include "../view/showing.h"
#include "live_control.h"

/* Zero it to begin with. */
typedef struct {
    const char *address; /* null: no page is wanted; empty: the usual one */
    bool opens;          /* in a browser */
    bool controls;       /* who has the token may command */
} wh_live_arguments_t;

/* --page, --page-control and --open, into a wh_live_arguments_t; the check of their table. */
extern const wh_option_t wh_live_options[];
void wh_live_check(const void *filled, struct argp_state *state);

/* The page says this of the program. All texts are borrowed. */
typedef struct {
    const char *speaker;             /* the subcommand, which says where the page is */
    const char *title;               /* the script's or layout's path */
    const char *reproduce;           /* the command that makes the run again; null: none does */
    const char *uncontrolled;        /* why --page-control is not offered; null: it is */
    wh_live_controlled_t controlled; /* what it then commands */
    double rate;                     /* of simulated time to the wall clock; 0: as fast as it goes */
    bool stays;                      /* the page stays when a script's run has ended, until a signal comes */
    bool paces;                      /* slices wait for that rate here; otherwise somebody else sees to it */
} wh_live_options_t;

/* The most requests of a page. */
#define WH_LIVE_NUMBERS (1LL << 40)

/* An open page; null where none is wanted, which every function takes. */
typedef struct wh_live wh_live_t;

/* Opens the page and says on standard error where it is. False, with the reason there, if that fails. */
bool wh_live_open(wh_live_t **live, const wh_live_arguments_t *arguments, const wh_live_options_t *options);

/* The listener of a run or a session: the page, after `next`, who may be all null. Without a page it is
 * `next`. */
wh_mcs_listener_t wh_live_listener(wh_live_t *live, const wh_mcs_listener_t *next);

/* Tells the page news; it takes them over. */
void wh_live_tell(wh_live_t *live, wh_news_t *news);

/* Shows what was said at a port; `user` is the wh_live_t. */
void wh_live_heard(void *user, const wh_transcript_entry_t *entry);

/* Nothing moves for now: what moved last is shown. `user` is the wh_live_t. The stepping thread's. */
void wh_live_rest(void *user);

/* A page that commands a prompt: all of these are the stepping thread's. `attend` is called when lines wait
 * while slices are played, and each 2 ms of a pause; it must not execute commands. */
void wh_live_set_attendant(wh_live_t *live, void (*attend)(void *user), void *user);

/* A descriptor that can be read when a line has come; -1: none comes. */
int wh_live_descriptor(const wh_live_t *live);

/* Takes the next line that has come; false: there is none. */
bool wh_live_take_line(wh_live_t *live, wh_live_line_t *line);

/* True if a request with this number is a page's. */
bool wh_live_has_asked(const wh_live_t *live, int64_t number);

/* Ends a pause. */
void wh_live_go_on(wh_live_t *live);

/* The tester's port, once it listens, where a page commands that. */
void wh_live_set_tester(wh_live_t *live, const char *address);

/* False if a page is wanted of this cell, and it has nothing to show; standard error says so. */
bool wh_live_shows(const wh_live_t *live, const wh_layout_t *layout);

/* Keeps the page of a run that has ended open until SIGINT or SIGTERM, if it stays; says so on standard
 * error. */
void wh_live_stay(const wh_live_t *live);

/* Call it before the layout goes. */
void wh_live_close(wh_live_t *live);

#endif
