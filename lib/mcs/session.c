#include "session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <lauxlib.h>

#include "../text/array.h"
#include "../text/utf8.h"

/* The record forgets its commands once it has this many. */
#define REMEMBERED_COMMANDS 1000

/* Registry keys: the three functions, and the list that keeps the last completion's texts alive. */
static char execute_key;
static char complete_key;
static char play_key;
static char candidates_key;

static bool refuse_session(wh_session_t *session, const char *message) {
    snprintf(session->message, sizeof session->message, "%s", message);
    return false;
}

/* ------------------------------------------------------------------------------------------------ opening */

/* Runs protected: the prompt, then cell(layout), which connects last: other failures come before the link
 * leaves an earlier run. */
static int open_cell(lua_State *L) {
    wh_mcs_push_prompt(L);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &play_key);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &complete_key);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &execute_key);
    lua_getglobal(L, "cell");
    lua_pushstring(L, *(const char **)lua_touserdata(L, 1));
    lua_call(L, 1, 0);
    return 0;
}

bool wh_session_open(wh_session_t *session, const wh_session_options_t *options) {
    wh_sandbox_result_t result;
    const char *layout = options->layout;
    memset(session, 0, sizeof *session);
    session->options = *options;
    /* A "script" without a folder: layouts are then looked for from the working directory. */
    session->sandbox =
        wh_sandbox_new_with(&options->limits, options->parameters, options->parameter_count, &result);
    if (!session->sandbox ||
        !wh_mcs_open(&session->mcs, session->sandbox, "prompt", &session->record, &result)) {
        return refuse_session(session, result.message);
    }
    session->mcs.wanted.refuses_unread = true;
    session->mcs.wanted.is_of_hosts = options->is_of_hosts;
    session->mcs.wanted.slows_down = options->slows_down;
    session->mcs.wanted.partners = options->partners;
    session->mcs.wanted.listener = options->listener;
    if (!wh_sandbox_protect(wh_sandbox_state(session->sandbox), open_cell, &layout, &result)) {
        return refuse_session(session, result.message);
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------- resetting */

bool wh_session_says(const char *line, const char *word) {
    const char *begin = line + strspn(line, " ");
    const size_t length = strlen(word);
    return strncasecmp(begin, word, length) == 0 && begin[length + strspn(begin + length, " ")] == '\0';
}

void wh_session_tell_untried(wh_session_t *session, wh_session_untried_t *untried, void *user) {
    session->options.untried = untried;
    session->options.untried_user = user;
}

/* Ends the run that RESET has left; the data that it shows is still there. */
static void leave(wh_session_t *before) {
    char *list = before->options.untried ? wh_mcs_tell_never_came(&before->mcs) : NULL;
    if (list) {
        before->options.untried(before->options.untried_user, list);
        free(list);
    }
    wh_mcs_close(&before->mcs);
    wh_record_free(&before->record);
    wh_sandbox_free(before->sandbox);
}

/* Puts the old session aside. If the new one cannot be opened, the old one comes back to its place, so
 * pointers to it stay valid. */
static bool reset_session(wh_session_t *session, char message[WH_SANDBOX_MESSAGE_BYTES]) {
    const wh_session_options_t options = session->options;
    wh_session_t *before = wh_array_new(1, sizeof *before);
    *before = *session;
    const bool opened = wh_session_open(session, &options);
    if (opened) {
        leave(before);
    } else {
        snprintf(message, WH_SANDBOX_MESSAGE_BYTES, "%s", session->message);
        if (options.listener.begins && session->mcs.layout) {
            options.listener.begins(options.listener.user, before->mcs.layout);
        }
        wh_session_close(session);
        *session = *before;
    }
    session->complaints = before->complaints;
    session->unmet = before->unmet;
    session->executing = before->executing;
    free(before);
    return opened;
}

void wh_session_close(wh_session_t *session) {
    wh_mcs_close(&session->mcs);
    wh_record_free(&session->record);
    wh_sandbox_free(session->sandbox);
    session->sandbox = NULL;
}

/* ---------------------------------------------------------------------------------------------- questions */

int64_t wh_session_slice(const wh_session_t *session) {
    return session->mcs.track.slice;
}

const wh_record_t *wh_session_record(const wh_session_t *session) {
    return &session->record;
}

int32_t wh_session_task(const wh_session_t *session) {
    return session->mcs.recorder.number;
}

int64_t wh_session_slice_us(const wh_session_t *session) {
    return session->mcs.track.slice_us;
}

int64_t wh_session_time_us(const wh_session_t *session) {
    return wh_mcs_utime(&session->mcs);
}

const wh_layout_t *wh_session_layout(const wh_session_t *session) {
    return session->mcs.layout;
}

uint64_t wh_session_hash(const wh_session_t *session) {
    return session->mcs.link->hash(session->mcs.link);
}

uint32_t wh_session_sensors(const wh_session_t *session) {
    return session->mcs.state.sensors;
}

void wh_session_grips(const wh_session_t *session, wh_grip_phase_t phases[WH_GRIPPERS]) {
    const wh_physics_state_t *physics = session->mcs.state.physics;
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        phases[g] = physics ? physics->grips[g].phase : WH_GRIP_OPEN;
    }
}

uint32_t wh_session_valves(const wh_session_t *session) {
    const wh_track_t *track = &session->mcs.track;
    uint32_t open = 0;
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        open |= track->valves[g] == WH_VALVE_OPEN ? 1U << g : 0;
    }
    return open;
}

void wh_session_poses(const wh_session_t *session, wh_pose_t poses[WH_GRIPPERS]) {
    wh_mcs_see_grippers(&session->mcs, poses);
}

bool wh_session_has_stop(const wh_session_t *session) {
    return session->mcs.stop.is_requested;
}

/* ------------------------------------------------------------------------------------------------ answers */

void wh_session_write_error(char *answer, size_t size, wh_status_t status, const char *reason) {
    char text[WH_SANDBOX_MESSAGE_BYTES + 200];
    snprintf(text, sizeof text, "ERROR %d %s: %s", (int)status, wh_status_name(status), reason);
    wh_utf8_visible(answer, size, text);
}

/* With the catalogue's text before the detail. */
static void write_error(char *answer, size_t size, wh_status_t status, const char *detail) {
    char reason[WH_SANDBOX_MESSAGE_BYTES + 150];
    snprintf(reason, sizeof reason, "%s%s%s", wh_record_error_text(status), detail[0] ? "; " : "", detail);
    wh_session_write_error(answer, size, status, reason);
}

/* ---------------------------------------------------------------------------------------------- executing */

typedef struct {
    const char *line;
    char *answer;
    size_t size;
    wh_status_t status;
} request_t;

/* Runs protected. */
static int execute_line(lua_State *L) {
    request_t *request = lua_touserdata(L, 1);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &execute_key);
    lua_pushstring(L, request->line);
    lua_call(L, 1, 2);
    if (!lua_isstring(L, -1)) {
        return luaL_error(L, "the answer is no text"); /* a layout has changed the string library */
    }
    request->status = (wh_status_t)lua_tointeger(L, -2);
    wh_utf8_visible(request->answer, request->size, lua_tostring(L, -1));
    return 0;
}

bool wh_session_is_full(const wh_session_t *session) {
    return !session->options.keeps_all && session->record.command_count >= REMEMBERED_COMMANDS;
}

static wh_status_t status_of(wh_sandbox_reason_t reason) {
    if (reason == WH_SANDBOX_STOPPED) {
        return WH_STATUS_STOPPED;
    }
    const bool spent = reason == WH_SANDBOX_BUDGET || reason == WH_SANDBOX_MEMORY;
    return spent ? WH_STATUS_OUT_OF_BUDGET : WH_STATUS_BAD_ARGUMENT;
}

static void count_complaints(wh_session_t *session, size_t from, size_t expectations) {
    for (size_t i = from; i < session->record.event_count; ++i) {
        session->complaints += wh_record_is_complaint(session->record.events[i].event.kind) ? 1 : 0;
    }
    for (size_t i = expectations; i < session->record.expectation_count; ++i) {
        session->unmet += session->record.expectations[i].ok ? 0 : 1;
    }
}

static void perform_reset(wh_session_t *session, request_t *request) {
    char message[WH_SANDBOX_MESSAGE_BYTES];
    if (reset_session(session, message)) {
        request->status = WH_OK;
        wh_utf8_visible(request->answer, request->size, "OK");
    } else {
        request->status = WH_STATUS_BAD_ARGUMENT;
        write_error(request->answer, request->size, request->status, message);
        wh_mcs_refuse(&session->mcs, "RESET", request->status, message);
    }
}

static void forget_old(wh_session_t *session) {
    if (wh_session_is_full(session)) {
        wh_record_forget_old(&session->record);
    }
}

static void perform_request(wh_session_t *session, request_t *request) {
    wh_sandbox_result_t result;
    if (wh_session_says(request->line, "RESET")) {
        perform_reset(session, request);
        return;
    }
    forget_old(session);
    const size_t events = session->record.event_count;
    const size_t expectations = session->record.expectation_count;
    if (!wh_sandbox_protect(wh_sandbox_state(session->sandbox), execute_line, request, &result)) {
        request->status = status_of(result.status);
        write_error(request->answer, request->size, request->status,
                    request->status == WH_STATUS_STOPPED ? "" : result.message);
        /* An exhausted limit ends a command outside of Lua: its record is closed here. */
        wh_mcs_cut_short(&session->mcs, request->status, result.message);
    }
    count_complaints(session, events, expectations);
}

wh_status_t wh_session_execute(wh_session_t *session, const char *line, char *answer, size_t size) {
    request_t request = {line, answer, size, WH_STATUS_BUSY};
    if (session->executing) {
        write_error(answer, size, WH_STATUS_BUSY, "");
        return WH_STATUS_BUSY;
    }
    wh_sandbox_renew(session->sandbox); /* before a stop may come: it would cancel that */
    session->executing = 1;
    if (session->options.report) {
        session->options.report(session->options.report_user, line, WH_OK, NULL);
    }
    perform_request(session, &request);
    if (session->options.report) {
        session->options.report(session->options.report_user, line, request.status, answer);
    }
    session->executing = 0;
    return request.status;
}

wh_status_t wh_session_execute_for(wh_session_t *session, const wh_mcs_asker_t *asker, const char *line,
                                   char *answer, size_t size) {
    if (session->executing) {
        return wh_session_execute(session, line, answer, size);
    }
    session->mcs.wanted.asker = *asker;
    const wh_status_t status = wh_session_execute(session, line, answer, size);
    session->mcs.wanted.asker = (wh_mcs_asker_t){0};
    return status;
}

/* -------------------------------------------------------------------------------------------------- jobs */

/* Runs protected. */
static int play_jobs(lua_State *L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &play_key);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &execute_key);
    lua_call(L, 1, 0);
    return 0;
}

wh_status_t wh_session_play(wh_session_t *session, const wh_mcs_jobs_t *jobs, char *answer, size_t size) {
    wh_sandbox_result_t result;
    wh_status_t status = WH_OK;
    wh_sandbox_renew(session->sandbox);
    session->executing = 1;
    forget_old(session);
    const size_t events = session->record.event_count;
    const size_t expectations = session->record.expectation_count;
    session->mcs.jobs = *jobs;
    if (!wh_sandbox_protect(wh_sandbox_state(session->sandbox), play_jobs, NULL, &result)) {
        status = status_of(result.status);
        write_error(answer, size, status, status == WH_STATUS_STOPPED ? "" : result.message);
        wh_mcs_cut_short(&session->mcs, status, result.message);
        wh_mcs_stop_tasks(&session->mcs);
    }
    session->mcs.jobs = (wh_mcs_jobs_t){0};
    count_complaints(session, events, expectations);
    session->executing = 0;
    return status;
}

void wh_session_renew(wh_session_t *session) {
    wh_sandbox_renew(session->sandbox);
}

void wh_session_stop(wh_session_t *session) {
    if (session->executing) {
        wh_sandbox_stop(session->sandbox);
    }
}

/* --------------------------------------------------------------------------------------------- completing */

typedef struct {
    const char *before;
    wh_candidates_t *candidates;
} completion_t;

/* Runs protected. The texts live as long as the list, which the registry keeps. */
static int complete_line(lua_State *L) {
    const completion_t *completion = lua_touserdata(L, 1);
    wh_candidates_t *candidates = completion->candidates;
    lua_rawgetp(L, LUA_REGISTRYINDEX, &complete_key);
    lua_pushstring(L, completion->before);
    lua_call(L, 1, 2);
    const lua_Integer start = lua_tointeger(L, -2);
    if (start < 1 || (size_t)start > candidates->start + 1) {
        return luaL_error(L, "the word begins nowhere in the line");
    }
    candidates->start = (size_t)start - 1;
    luaL_checktype(L, -1, LUA_TTABLE);
    const size_t count = lua_rawlen(L, -1);
    for (size_t i = 0; i < count && i < WH_SESSION_CANDIDATES; ++i) {
        lua_rawgeti(L, -1, (lua_Integer)i + 1);
        luaL_checktype(L, -1, LUA_TSTRING);
        candidates->texts[candidates->count++] = lua_tostring(L, -1);
        lua_pop(L, 1);
    }
    lua_rawsetp(L, LUA_REGISTRYINDEX, &candidates_key);
    return 0;
}

void wh_session_complete(wh_session_t *session, const char *before, wh_candidates_t *candidates) {
    completion_t completion = {before, candidates};
    candidates->start = strlen(before);
    candidates->count = 0;
    if (session->executing || candidates->start > WH_SESSION_LINE_BYTES) {
        return;
    }
    wh_sandbox_renew(session->sandbox);
    if (!wh_sandbox_protect(wh_sandbox_state(session->sandbox), complete_line, &completion, NULL)) {
        candidates->count = 0;
    }
}
