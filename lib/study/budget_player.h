/* Trials of a budget: the script with given errors. */
#ifndef WH_STUDY_BUDGET_PLAYER_H
#define WH_STUDY_BUDGET_PLAYER_H

#include "budget.h"
#include "trial.h"

/* How much of a trial is played. */
typedef enum {
    WH_BUDGET_WITHOUT, /* collisions are not looked for */
    WH_BUDGET_WITH     /* all of it */
} wh_budget_level_t;

/* True if a run that fails without collisions also fails with them, because no decision depends on them, and
 * if checking them takes long. */
bool wh_budget_has_two_ways(const wh_study_t *study);

/* The data of a thread. Each thread has its own. A point has WH_SPREADS numbers for each station, in
 * thousandths. */
typedef struct {
    const wh_study_t *shared;
    wh_study_t own; /* with the layout below */
    wh_layout_t layout;
    wh_errors_t errors;
    wh_given_t given;
    wh_worker_t worker;
    wh_tally_t tally;
    size_t point_size;
    int32_t *point;                /* room for one, all 0 */
    char (*texts)[WH_BUDGET_TEXT]; /* of the errors that are not 0 */
    const char **errors_by_name;
    uint32_t events[WH_EVENT_KINDS]; /* of the run without errors */
    uint64_t trials;
    size_t caught_nominally; /* errors of commands, by line and number, of the run without errors */
    bool caught;             /* a trial passed that had more of them */
    bool two_ways;
    bool by_script;     /* set by the caller: trials with collisions are the script itself, not replayed */
    bool differs;       /* the last trial had another event than that run, or left a wafer elsewhere */
    bool events_differ; /* it had another event */
} wh_budget_player_t;

/* To be closed. `study` must outlive it. If there is no memory, the program ends. */
void wh_budget_player_open(wh_budget_player_t *player, const wh_study_t *study);
void wh_budget_player_close(wh_budget_player_t *player);

/* True if the script, played with these errors, ends as `run` with 0. It ends at the first complaint. */
bool wh_budget_passes(wh_budget_player_t *player, const int32_t point[], wh_budget_level_t level);

/* Plays likewise, but always by the script itself, and tells why it fails. */
bool wh_budget_run(wh_budget_player_t *player, const int32_t point[], wh_budget_why_t *why);

/* Why a run failed: its first complaint, the error that ended it, or its unmet expectation. */
void wh_budget_explain(const wh_record_t *record, const char *message, wh_budget_why_t *why);

#endif
