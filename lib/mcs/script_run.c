#include "script_run.h"

#include <stdio.h>
#include <string.h>

#include "../record/dropped.h"
#include "../text/array.h"
#include "../text/utf8.h"

static wh_script_run_outcome_t refuse_run(wh_script_run_t *run, const char *message) {
    snprintf(run->message, sizeof run->message, "%s", message);
    return WH_RUN_BAD_INPUT;
}

/* True if a numbered error ended the script: a result, not bad input, like a stop outside of Lua. */
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

/* True for a table with a field that only layouts have. */
static bool is_layout(lua_State *L) {
    static const char *const fields[] = {"stations", "grippers", "robot", "wafers"};
    for (size_t i = 0; i < sizeof fields / sizeof *fields; ++i) {
        lua_pushstring(L, fields[i]);
        const int type = lua_rawget(L, -2);
        lua_pop(L, 1);
        if (type == LUA_TTABLE) {
            return true;
        }
    }
    return false;
}

/* The fault of a script that set up its cell: it has not done what an option asks for, or did not read a
 * parameter. */
static bool find_undone(const wh_script_run_t *run, const wh_script_run_options_t *options,
                        char text[WH_SANDBOX_MESSAGE_BYTES]) {
    if (options->until_steady && !run->record.flow) {
        (void)snprintf(text, WH_SANDBOX_MESSAGE_BYTES, "no flow (expected one for --until-steady)");
        return true;
    }
    return !options->unread_parameters && wh_sandbox_find_unread(run->sandbox, text);
}

/* Finds the fault of a script that ended without error: it set up no cell, or did not read a parameter. Its
 * result is on top of the stack. False if there is no fault. */
static bool find_fault(wh_script_run_t *run, const wh_script_run_options_t *options,
                       wh_sandbox_result_t *result) {
    lua_State *L = wh_sandbox_state(run->sandbox);
    const char *script = options->script;
    char text[WH_SANDBOX_MESSAGE_BYTES] =
        "no cell (expected cell \"LAYOUT.lua\" as the script's first command)";
    char whole[2 * WH_SANDBOX_MESSAGE_BYTES];
    run->is_no_script = !run->mcs.layout && !lua_isnil(L, -1);
    if (!run->mcs.layout && lua_istable(L, -1) && is_layout(L)) {
        (void)snprintf(text, sizeof text, "a layout: waferhand layout %.900s", script);
    } else if (!run->mcs.layout && lua_istable(L, -1)) {
        (void)snprintf(text, sizeof text,
                       "no script: it returns a table and sets up no cell (expected cell \"LAYOUT.lua\"; "
                       "scripts have the use of modules by require)");
    } else if (run->mcs.layout && !find_undone(run, options, text)) {
        return false;
    }
    (void)snprintf(whole, sizeof whole, "%s: %s", script, text);
    wh_utf8_visible(result->message, sizeof result->message, whole);
    result->status = WH_SANDBOX_ERROR;
    return true;
}

/* Names the option that allows more. */
static void name_option(wh_sandbox_result_t *result) {
    const size_t length = strlen(result->message);
    if (result->status == WH_SANDBOX_BUDGET) {
        (void)snprintf(result->message + length, sizeof result->message - length,
                       " (expected fewer steps, or more with --budget)");
    }
}

static wh_script_run_outcome_t conclude_run(wh_script_run_t *run, const wh_script_run_options_t *options,
                                            wh_sandbox_result_t *result) {
    lua_State *L = wh_sandbox_state(run->sandbox);
    const bool ended = result->status == WH_SANDBOX_OK;
    const bool is_unusable = ended && find_fault(run, options, result);
    const bool stopped = result->status == WH_SANDBOX_STOPPED;
    bool is_bad_input = false;
    name_option(result);
    if (result->status != WH_SANDBOX_OK) {
        is_bad_input =
            !stopped && (is_unusable || result->status != WH_SANDBOX_ERROR || !ended_by_numbered_error(L));
        run->record.failure = wh_text_copy(result->message);
    }
    if (stopped) {
        wh_mcs_cut_short(&run->mcs, WH_STATUS_STOPPED, result->message);
    }
    if (!ended) {
        wh_mcs_stop_tasks(&run->mcs);
    }
    wh_mcs_finish(&run->mcs);
    if (is_bad_input) {
        return refuse_run(run, result->message);
    }
    return run->record.ok ? WH_RUN_MET : WH_RUN_FAILED;
}

/* With given errors every trial is the same. */
static const wh_trial_t any_trial = {0, 0};

wh_script_run_outcome_t wh_script_run(wh_script_run_t *run, const wh_script_run_options_t *options) {
    wh_sandbox_result_t result;
    memset(run, 0, sizeof *run);
    run->sandbox =
        wh_sandbox_new_with(&options->limits, options->parameters, options->parameter_count, &result);
    if (!run->sandbox) {
        return refuse_run(run, result.message);
    }
    if (!wh_mcs_open(&run->mcs, run->sandbox, options->script, &run->record, &result)) {
        name_option(&result);
        (void)refuse_run(run, "");
        (void)snprintf(run->message, sizeof run->message, "%.500s: %.500s", options->script, result.message);
        return WH_RUN_BAD_INPUT;
    }
    run->mcs.wanted.is_file = true;
    run->mcs.wanted.keeps_segments = options->keep_segments;
    run->mcs.wanted.keeps = options->keeps;
    if (options->drops_rows) {
        wh_dropped_want(&run->record);
    }
    run->mcs.wanted.limits_missed = options->limits_missed;
    run->mcs.wanted.most_missed = options->most_missed;
    run->mcs.wanted.partners = options->partners;
    run->mcs.wanted.trial = options->error_count > 0 && !options->trial ? &any_trial : options->trial;
    run->mcs.wanted.errors = options->errors;
    run->mcs.wanted.error_count = options->error_count;
    run->record.errors = options->errors;
    run->record.error_count = options->error_count;
    run->record.trial = options->error_count > 0 ? NULL : options->trial;
    run->mcs.wanted.without_collisions = options->without_collisions;
    run->mcs.wanted.until_steady = options->until_steady;
    run->mcs.wanted.needs_axes = options->needs_axes;
    run->mcs.wanted.counts = options->counts;
    run->mcs.wanted.verify = options->verify;
    run->mcs.wanted.faster = options->faster;
    run->mcs.wanted.faster_count = options->faster_count;
    run->mcs.wanted.faster_share = options->faster_share;
    run->mcs.wanted.decisions = options->decisions;
    run->mcs.wanted.listener = options->listener;
    wh_sandbox_evaluate(wh_sandbox_state(run->sandbox), options->script, &result);
    if (result.status == WH_SANDBOX_OK && run->mcs.lanes) {
        (void)wh_sandbox_protect(wh_sandbox_state(run->sandbox), wh_mcs_wait_for_tasks, NULL, &result);
    }
    return conclude_run(run, options, &result);
}

void wh_script_run_close(wh_script_run_t *run) {
    wh_mcs_close(&run->mcs);
    wh_record_free(&run->record);
    wh_sandbox_free(run->sandbox);
    run->sandbox = NULL;
}
