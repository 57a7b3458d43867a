/* A session: an operator's lines, executed one by one in a cell that a layout file describes.
 *
 * The prompt and WAFERHAND_REQUEST both use it. "At the prompt" in lua/README.md describes a line; it is read
 * and never run as Lua. Its command runs like a script's: recorded, timed, and against the simulator in this
 * process or the link that `connect` returned.
 *
 * One thread at a time. A command that fails, is stopped or exceeds a limit leaves the session usable: the
 * robot stays where it stopped.
 */
#ifndef WH_MCS_SESSION_H
#define WH_MCS_SESSION_H

#include <signal.h>

#include "mcs.h"

/* Longest line, without its terminator; a longer one is refused. */
#define WH_SESSION_LINE_BYTES 1000

/* Room for any answer; an answer that does not fit a smaller array ends in "...". */
#define WH_SESSION_ANSWER_BYTES 65536

/* The most candidates of a completion. */
#define WH_SESSION_CANDIDATES 200

/* Called before a command is executed, with a null answer, and after it with the answer. Must not execute
 * commands. For publishing on WAFERHAND_MCS. */
typedef void wh_session_report_t(void *user, const char *line, wh_status_t status, const char *answer);

/* True if the line has only this word, in upper or lower case, and blanks. */
bool wh_session_says(const char *line, const char *word);

/* Called when a RESET has ended a run in which faults or errors on purpose had not come: `list` names them,
 * as wh_mcs_tell_never_came does. */
typedef void wh_session_untried_t(void *user, const char *list);

/* Zero or null fields mean their default. */
typedef struct {
    const char *layout;            /* path, relative to the working directory */
    wh_sandbox_limits_t limits;    /* the instructions are for one command */
    const char *const *parameters; /* NAME=VALUE, for the layout's `params` */
    size_t parameter_count;
    wh_mcs_partners_t partners; /* see mcs/partners.h */
    wh_mcs_listener_t listener; /* likewise, for each run of the session */
    bool keeps_all;             /* the record forgets no command */
    bool is_of_hosts;           /* its lines come from hosts: see wh_mcs_wanted_t; */
    bool slows_down;            /* likewise, what a STOP does */
    wh_session_report_t *report;
    void *report_user;
    wh_session_untried_t *untried;
    void *untried_user;
} wh_session_options_t;

/* Read `mcs`, `record`, `message`, `complaints` and `unmet`; the rest is internal. Must not be moved while it
 * is open. */
typedef struct {
    wh_sandbox_t *sandbox;
    wh_mcs_t mcs;
    wh_record_t record;                     /* of the last commands: a long session forgets the oldest */
    char message[WH_SANDBOX_MESSAGE_BYTES]; /* the reason why it could not be opened */
    size_t complaints;                      /* how many events were complaints: see wh_record_is_complaint */
    size_t unmet;                           /* how many PUTs ended in another slot than they said */
    wh_session_options_t options;
    volatile sig_atomic_t executing;
} wh_session_t;

/* Reads the layout, sets up the cell and connects. `options` need not outlive the call, but the data that
 * it points to must. False, and the reason in `message`, if layout, parameter or link is not usable.
 * Close it in either case. */
bool wh_session_open(wh_session_t *session, const wh_session_options_t *options);

/* Calls `untried` from now on; null: nobody. */
void wh_session_tell_untried(wh_session_t *session, wh_session_untried_t *untried, void *user);

/* The slices of this run so far, and the length of one, us. */
int64_t wh_session_slice(const wh_session_t *session);
int64_t wh_session_slice_us(const wh_session_t *session);

/* The record of the last commands, and the number of the current task among them. */
const wh_record_t *wh_session_record(const wh_session_t *session);
int32_t wh_session_task(const wh_session_t *session);

/* The time of the run so far: that many slices. */
int64_t wh_session_time_us(const wh_session_t *session);

/* The cell's layout; null: it has not been read yet. */
const wh_layout_t *wh_session_layout(const wh_session_t *session);

/* The hash of the run so far, as its link tells it. Only while connected. */
uint64_t wh_session_hash(const wh_session_t *session);

/* The vacuum sensors after the last slice: bit g of gripper g. */
uint32_t wh_session_sensors(const wh_session_t *session);

/* The valves that are open by the last command, or as the run begins: bit g of gripper g. */
uint32_t wh_session_valves(const wh_session_t *session);

/* The phases of edge grips in the slice that came back last, or as the run begins. */
void wh_session_grips(const wh_session_t *session, wh_grip_phase_t phases[WH_GRIPPERS]);

/* The grippers' commanded poses in the slice of which STATUS tells, base_from_gripper; without a cell
 * nothing is written. */
void wh_session_poses(const wh_session_t *session, wh_pose_t poses[WH_GRIPPERS]);

/* True if a STOP has come that no command has taken yet. */
bool wh_session_has_stop(const wh_session_t *session);

/* Executes a line with a fresh budget. RESET reads the layout again and begins another run, with its wafers
 * and an empty slot book. If the layout is no longer usable, that is an error: the session goes on as
 * before, with a failed command RESET in its record. `answer`, of at least 8 bytes, gets one line of
 * printable text without its end: "OK" and values, or "ERROR 42 WAFER_MISSING: ..."; control characters
 * stand in it as \xNN. Returns the error's number. Called from within a command (a link's exchange, a
 * report) it answers WH_STATUS_BUSY. */
wh_status_t wh_session_execute(wh_session_t *session, const char *line, char *answer, size_t size);

/* Likewise, for the controller that asks. */
wh_status_t wh_session_execute_for(wh_session_t *session, const wh_mcs_asker_t *asker, const char *line,
                                   char *answer, size_t size);

/* Plays lines side by side, each job's lines one after another, until none is left. It starts with all
 * jobs that have come by now. No line may be RESET, SAVE, RESTORE or UNDO. Returns WH_OK, or the reason
 * why all unfinished jobs were given up, with `answer` as wh_session_execute writes it. */
wh_status_t wh_session_play(wh_session_t *session, const wh_mcs_jobs_t *jobs, char *answer, size_t size);

/* Renews the budget, for a job that begins while others are played. Not after a stop: it would cancel
 * that. */
void wh_session_renew(wh_session_t *session);

/* True if the record is full of commands: it forgets them before the next command begins while none
 * runs. */
bool wh_session_is_full(const wh_session_t *session);

/* Writes an error as an answer: "ERROR 54 BUSY: " and the reason, on one line, cut like an answer. A
 * session's own reasons begin with the catalogue's text: wh_record_error_text. */
void wh_session_write_error(char *answer, size_t size, wh_status_t status, const char *reason);

/* Ends the running command with WH_STATUS_STOPPED; without one it does nothing. For signal handlers of the
 * thread that executes. Over a link it takes effect when the exchange that is waited for returns, whatever
 * its status. */
void wh_session_stop(wh_session_t *session);

/* The candidates for the word at the end of a text. */
typedef struct {
    size_t start; /* where the word begins */
    size_t count;
    const char *texts[WH_SESSION_CANDIDATES]; /* each replaces all from `start`; valid until the next
                                               * call */
} wh_candidates_t;

/* Completes `before`, the line up to the cursor: a command, or by its position a station, gripper or wafer,
 * an option or its value. No candidates while a command is being executed. */
void wh_session_complete(wh_session_t *session, const char *before, wh_candidates_t *candidates);

/* Frees everything; a session that was never opened must be all zero. */
void wh_session_close(wh_session_t *session);

#endif
