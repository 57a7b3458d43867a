/* One script from beginning to end: sandbox, motion control, simulator and record together. */
#ifndef WH_MCS_SCRIPT_RUN_H
#define WH_MCS_SCRIPT_RUN_H

#include "mcs.h"

typedef struct {
    const char *script; /* path */
    wh_sandbox_limits_t limits;
    const char *const *parameters; /* NAME=VALUE, as --set hands them over */
    size_t parameter_count;
    wh_mcs_partners_t partners; /* all null: the simulator in this process */
    wh_mcs_listener_t listener; /* all null: no listener */
    bool keep_segments;         /* run->mcs.kept then has what was played */
    bool drops_rows;            /* of what is over, see record/dropped.h */
    wh_flow_keep_t keeps;       /* of a flow, in run->record.flow; wh_schedule_write needs WH_FLOW_WAYS */
    bool limits_missed;         /* the run fails if the simulator misses more slices than `most_missed` */
    int64_t most_missed;
    bool unread_parameters;  /* are accepted: a trial may end before it reads them */
    const wh_trial_t *trial; /* a study's trial: the cell has its errors, if layout or script lists
                              * them */
    /* The cell's errors by name, for wh_layout_give_errors: with these it draws none. */
    const char *const *errors;
    size_t error_count;
    bool without_collisions; /* no collision check, whatever the layout says */
    bool until_steady;       /* a flow by times alone ends as soon as it is steady: it must have one */
    const char *needs_axes;  /* the option for which robots must have axes; null: none was given */
    wh_mcs_count_t counts;   /* whether slices are left out */
    uint64_t verify;         /* stretches of them that are played all the same */
    const size_t *faster;    /* the numbers of what takes less time, see wh_layout_hasten */
    size_t faster_count;
    double faster_share;       /* and by how much */
    wh_decisions_t *decisions; /* all zero at first: keeps commands and readings; null: they are not kept */
} wh_script_run_options_t;

/* The results when the script has ended. wh_script_run_close frees it. */
typedef struct {
    wh_sandbox_t *sandbox;
    wh_mcs_t mcs;
    wh_record_t record;
    char message[WH_SANDBOX_MESSAGE_BYTES]; /* why the input was bad */
    bool is_no_script; /* it returned something and set up no cell, so it is a layout or a module */
} wh_script_run_t;

typedef enum {
    WH_RUN_MET,    /* the script ended and all its expectations were met */
    WH_RUN_FAILED, /* an expectation, the cell, or an uncaught numbered error: see the record */
    /* Script, layout or parameter is not usable, the script set up no cell, or it ended without error and
     * never read a parameter: see `message`. The record has everything up to then, with the message as its
     * failure; its layout is null if there was no cell yet. */
    WH_RUN_BAD_INPUT
} wh_script_run_outcome_t;

/* Runs a script. `options` and what it points to must outlive the run. */
wh_script_run_outcome_t wh_script_run(wh_script_run_t *run, const wh_script_run_options_t *options);

void wh_script_run_close(wh_script_run_t *run);

#endif
