#include "script_run.h"

#include <stdio.h>
#include <string.h>

#include "../text/array.h"

static wh_script_run_outcome_t refuse(wh_script_run_t *run, const char *message) {
    snprintf(run->message, sizeof run->message, "%s", message);
    return WH_RUN_BAD_INPUT;
}

/* True if a numbered error ended the script: a result, not bad input, as a stop past all Lua is. */
static bool ended_by_numbered_error(lua_State *L) {
    wh_sandbox_push_error(L);
    bool numbered = false;
    if (lua_istable(L, -1)) {
        lua_pushliteral(L, "number");
        lua_rawget(L, -2);
        numbered = lua_isinteger(L, -1) != 0;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return numbered;
}

static wh_script_run_outcome_t conclude(wh_script_run_t *run, const wh_sandbox_result_t *result) {
    const bool stopped = result->status == WH_SANDBOX_STOPPED;
    bool is_bad_input = false;
    if (result->status != WH_SANDBOX_OK) {
        is_bad_input = !stopped && (result->status != WH_SANDBOX_ERROR ||
                                    !ended_by_numbered_error(wh_sandbox_state(run->sandbox)));
        run->record.failure = wh_text_copy(result->message);
    }
    if (stopped) {
        wh_mcs_cut_short(&run->mcs, WH_STATUS_STOPPED, result->message);
    }
    wh_mcs_finish(&run->mcs);
    if (is_bad_input) {
        return refuse(run, result->message);
    }
    return run->record.ok ? WH_RUN_MET : WH_RUN_FAILED;
}

wh_script_run_outcome_t wh_script_run(wh_script_run_t *run, const wh_script_run_options_t *options) {
    wh_sandbox_result_t result;
    memset(run, 0, sizeof *run);
    run->sandbox =
        wh_sandbox_new_with(&options->limits, options->parameters, options->parameter_count, &result);
    if (!run->sandbox || !wh_mcs_open(&run->mcs, run->sandbox, options->script, &run->record, &result)) {
        return refuse(run, result.message);
    }
    run->mcs.keep_segments = options->keep_segments;
    run->mcs.limits_missed = options->limits_missed;
    run->mcs.most_missed = options->most_missed;
    run->mcs.partners = options->partners;
    run->mcs.trial = options->trial;
    run->mcs.decisions = options->decisions;
    run->mcs.listener = options->listener;
    wh_sandbox_evaluate(wh_sandbox_state(run->sandbox), options->script, &result);
    return conclude(run, &result);
}

void wh_script_run_close(wh_script_run_t *run) {
    wh_mcs_close(&run->mcs);
    wh_record_free(&run->record);
    wh_sandbox_free(run->sandbox);
    run->sandbox = NULL;
}
