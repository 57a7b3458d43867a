/* A session: an operator's lines, executed one by one in a cell that a layout file describes.
 *
 * The prompt and WAFERHAND_REQUEST both stand on it. A line is what lua/README.md says in "At the prompt"; it
 * is read and never run as Lua. Its command goes the way of a script's: recorded, timed, and against the
 * simulator in this process or whatever `connect` put in its place.
 *
 * One thread at a time. A command that fails, is stopped or needs too much leaves the session usable: the
 * robot stands where it has come to.
 */
#ifndef WH_MCS_SESSION_H
#define WH_MCS_SESSION_H

#include <signal.h>

#include "mcs.h"

/* Longest line, without its terminator; a longer one is refused. */
#define WH_SESSION_LINE_BYTES 1000

/* Room for any answer; one that does not fit a smaller array ends in "...". */
#define WH_SESSION_ANSWER_BYTES 65536

/* How many candidates a completion gives at most. */
#define WH_SESSION_CANDIDATES 200

/* Called before a command is executed, with a null answer, and after it with the answer. Must not execute
 * commands. For publishing on WAFERHAND_MCS. */
typedef void wh_session_report_t(void *user, const char *line, wh_status_t status, const char *answer);

/* True if the line is this word, in upper or lower case, and nothing else but blanks. */
bool wh_session_says(const char *line, const char *word);

/* Zero or null fields mean their default. */
typedef struct {
    const char *layout;            /* path, relative to the working directory */
    wh_sandbox_limits_t limits;    /* the instructions are of one command */
    const char *const *parameters; /* NAME=VALUE, for the layout's `params` */
    size_t parameter_count;
    wh_mcs_partners_t partners; /* see mcs/mcs.h */
    wh_mcs_listener_t listener; /* the same, of each run of the session */
    bool keeps_all;             /* the record forgets no command */
    wh_session_report_t *report;
    void *report_user;
} wh_session_options_t;

/* Read `mcs`, `record`, `message` and `complaints`; the rest is the session's own. Must not be moved while it
 * is open. */
typedef struct {
    wh_sandbox_t *sandbox;
    wh_mcs_t mcs;
    wh_record_t record; /* of the last commands: a session without an end forgets the oldest */
    char message[WH_SANDBOX_MESSAGE_BYTES]; /* why it could not be opened */
    size_t complaints;                      /* how many events were complaints: see wh_record_is_complaint */
    wh_session_options_t options;
    volatile sig_atomic_t executing;
} wh_session_t;

/* Reads the layout, sets up the cell and connects. `options` may go afterwards, but what it points to may
 * not. False, and the reason in `message`, when layout, parameter or link is not
 * usable. To be closed either way. */
bool wh_session_open(wh_session_t *session, const wh_session_options_t *options);

/* Executes a line with a fresh budget. RESET reads the layout anew and begins another run, with its wafers
 * and a slot book that knows nothing; if the layout is no longer usable, that is an error, and the session
 * goes on as it was, with a command RESET that failed in its record. `answer`, of at least 8 bytes, gets one
 * line of printable text without its end: "OK" and values, or "ERROR 42 WAFER_MISSING: ..."; control
 * characters stand in it as \xNN. Returns the error's number. Called from within a command (a link's
 * exchange, a report) it answers WH_STATUS_BUSY. */
wh_status_t wh_session_execute(wh_session_t *session, const char *line, char *answer, size_t size);

/* Plays lines side by side, each job's one after another, until there is none left; first of all those
 * that have come by now. None may be RESET, SAVE, RESTORE or UNDO. Returns WH_OK, or why all jobs that had
 * not ended
 * were given up, with `answer` as wh_session_execute writes it. */
wh_status_t wh_session_play(wh_session_t *session, const wh_mcs_jobs_t *jobs, char *answer, size_t size);

/* A fresh budget, for a job that begins while others are played. Not behind a stop: it would take that
 * back. */
void wh_session_renew(wh_session_t *session);

/* The record has so many commands that it forgets them before the next one is begun while none runs. */
bool wh_session_is_full(const wh_session_t *session);

/* Writes an error as it is answered: "ERROR 54 BUSY: " and the reason, on one line, cut like an answer. A
 * session's own reasons begin with the catalogue's text: wh_record_error_text. */
void wh_session_write_error(char *answer, size_t size, wh_status_t status, const char *reason);

/* Ends the running command with WH_STATUS_STOPPED; without one, nothing. For signal handlers of the thread
 * that executes. Over a link it takes effect when the exchange that is waited for returns, whatever its
 * status. */
void wh_session_stop(wh_session_t *session);

/* What the word at the end of a text may become. */
typedef struct {
    size_t start; /* where the word begins */
    size_t count;
    const char *texts[WH_SESSION_CANDIDATES]; /* each replaces all from `start`; until the next call */
} wh_candidates_t;

/* Completes `before`, the line up to the cursor: a command, or by its position a station, gripper or wafer,
 * an option or its value. No candidates while a command is being executed. */
void wh_session_complete(wh_session_t *session, const char *before, wh_candidates_t *candidates);

/* Frees everything; a session that was never opened must be all zero. */
void wh_session_close(wh_session_t *session);

#endif
