#include "mcs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../script/embedded.h"
#include "../script/wh_module.h"
#include "../script/wh_module_values.h"
#include "clocks.h"
#include "counted.h"
#include "native.h"

wh_mcs_t *wh_mcs_of(lua_State *L) {
    return lua_touserdata(L, lua_upvalueindex(1));
}

wh_mcs_t *wh_mcs_with_layout(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    if (!mcs->layout) {
        wh_mcs_raise(L, mcs, WH_STATUS_NO_LAYOUT, "begin the script with cell \"LAYOUT.lua\"");
    }
    return mcs;
}

int32_t wh_mcs_index(lua_State *L, int argument, size_t count) {
    const lua_Integer index = luaL_checkinteger(L, argument);
    luaL_argcheck(L, index >= 1 && index <= (lua_Integer)count, argument, "index out of range");
    return (int32_t)index - 1;
}

void wh_mcs_tell(const wh_mcs_t *mcs, wh_mcs_news_t news, const wh_command_record_t *command) {
    if (mcs->wanted.partners.tell) {
        mcs->wanted.partners.tell(mcs->wanted.partners.user, mcs, news, command);
    }
    if (mcs->wanted.listener.tell) {
        mcs->wanted.listener.tell(mcs->wanted.listener.user, mcs, news, command);
    }
}

void wh_mcs_listen(wh_mcs_t *mcs, wh_slice_listener_t *hear, void *user) {
    mcs->listeners.of[mcs->listeners.count].hear = hear;
    mcs->listeners.of[mcs->listeners.count++].user = user;
}

void wh_mcs_listen_first(wh_mcs_t *mcs, wh_slice_listener_t *hear, void *user) {
    memmove(mcs->listeners.of + 1, mcs->listeners.of, mcs->listeners.count * sizeof mcs->listeners.of[0]);
    ++mcs->listeners.count;
    mcs->listeners.of[0].hear = hear;
    mcs->listeners.of[0].user = user;
}

/* ---------------------------------------------------------------------------------------------- questions */

const wh_layout_t *wh_mcs_layout(const wh_mcs_t *mcs) {
    return mcs->layout;
}

const wh_layout_t *wh_mcs_true_layout(const wh_mcs_t *mcs) {
    return mcs->real;
}

wh_link_t *wh_mcs_link(const wh_mcs_t *mcs) {
    return mcs->link;
}

const wh_record_t *wh_mcs_record(const wh_mcs_t *mcs) {
    return mcs->recorder.record;
}

bool wh_mcs_is_script(const wh_mcs_t *mcs) {
    return mcs->wanted.is_file;
}

int64_t wh_mcs_utime(const wh_mcs_t *mcs) {
    return mcs->track.slice * mcs->track.slice_us;
}

int32_t wh_mcs_task(const wh_mcs_t *mcs) {
    return mcs->recorder.number;
}

const char *wh_mcs_running_text(const wh_mcs_t *mcs) {
    const wh_recorder_t *recorder = &mcs->recorder;
    return recorder->running != WH_NONE ? recorder->record->commands[recorder->running].text : NULL;
}

const wh_lane_t *wh_mcs_current_lane(const wh_mcs_t *mcs) {
    return &mcs->lanes->of[mcs->lanes->current];
}

const wh_mcs_measuring_t *wh_mcs_measuring(const wh_mcs_t *mcs) {
    return &mcs->measuring;
}

const wh_mcs_kept_t *wh_mcs_kept(const wh_mcs_t *mcs) {
    return &mcs->kept;
}

/* ---------------------------------------------------------------------------------------- numbered errors */

static int numbered_error_text(lua_State *L) {
    lua_getfield(L, 1, "message");
    return 1;
}

static void push_numbered_error_metatable(lua_State *L) {
    if (luaL_newmetatable(L, "wh.numbered_error")) {
        lua_pushcfunction(L, numbered_error_text);
        lua_setfield(L, -2, "__tostring");
        wh_lua_set_text(L, "__name", "numbered error");
        wh_lua_set_boolean(L, "__metatable", false);
    }
}

void wh_mcs_find_callers(lua_State *L, wh_mcs_t *mcs) {
    int *callers = mcs->running.callers;
    int lines[2 * WH_MCS_CALLERS];
    const size_t count = wh_sandbox_lines(L, mcs->script, lines, sizeof lines / sizeof *lines);
    size_t kept = 0;
    for (size_t i = 1; i < count && kept < WH_MCS_CALLERS; ++i) {
        if (lines[i] != lines[i - 1]) {
            callers[kept++] = lines[i];
        }
    }
    memset(callers + kept, 0, (WH_MCS_CALLERS - kept) * sizeof *callers);
    wh_sandbox_module_place(L, mcs->script, mcs->running.module);
}

/* Pushes "; in moves.lua:4; called from line 9, 20", or what there is of it. */
static void push_callers(lua_State *L, const wh_mcs_running_t *running) {
    const int *callers = running->callers;
    lua_pushfstring(L, "%s%s%s", running->module[0] ? "; in " : "", running->module,
                    callers[0] > 0 ? "; called from line " : "");
    for (size_t i = 0; i < WH_MCS_CALLERS && callers[i] > 0; ++i) {
        lua_pushfstring(L, i > 0 ? ", %d" : "%d", callers[i]);
        lua_concat(L, 2);
    }
}

int wh_mcs_raise(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *detail) {
    /* Within a pattern L is the pattern's coroutine, and the script is not on its stack: the command has the
     * line. */
    const wh_recorder_t *recorder = &mcs->recorder;
    const bool runs = recorder->running != WH_NONE;
    const int line =
        runs ? recorder->record->commands[recorder->running].line : wh_sandbox_line(L, mcs->script);
    const char *command = runs ? recorder->record->commands[recorder->running].text : mcs->running.word;
    lua_createtable(L, 0, 4);
    wh_lua_set_integer(L, "number", status);
    wh_lua_set_text(L, "name", wh_status_name(status));
    wh_lua_set_integer(L, "line", line);
    if (!runs) {
        wh_mcs_find_callers(L, mcs);
    }
    push_callers(L, &mcs->running);
    lua_pushfstring(L, "error %d %s: %s%s%s%s", (int)status, wh_status_name(status),
                    wh_record_error_text(status), detail ? "; " : "", detail ? detail : "",
                    lua_tostring(L, -1));
    lua_remove(L, -2);
    lua_pushfstring(L, "%s:%d: %s%s%s", mcs->script, line, command, command[0] ? ": " : "",
                    lua_tostring(L, -1));
    lua_setfield(L, -3, "message");
    lua_setfield(L, -2, "text");
    push_numbered_error_metatable(L);
    lua_setmetatable(L, -2);
    lua_error(L);
    abort(); /* lua_error does not return, but its declaration does not say so */
}

/* ------------------------------------------------------------------------------------------------ opening */

/* native.module(name): returns the result of an embedded file of lua/mcs. */
static int load_module(lua_State *L) {
    const char *name = luaL_checkstring(L, 1);
    wh_sandbox_result_t result;
    for (size_t i = 0; i < wh_embedded_count; ++i) {
        const wh_embedded_t *file = &wh_embedded[i];
        if (strcmp(file->name, name) == 0) {
            const char *chunk = lua_pushfstring(L, "%s%s", WH_INNER_CHUNK, name);
            if (!wh_sandbox_evaluate_code(L, chunk, file->text, file->size, &result)) {
                return luaL_error(L, "%s", result.message);
            }
            return 1;
        }
    }
    return luaL_error(L, "no embedded file %s", name);
}

static void hear_collisions(void *user, const wh_command_t *command, const wh_state_t *state) {
    if (state->status == WH_OK) {
        wh_collision_observe(user, command->axes, state);
    }
}

/* native.connect(): the cell is set up; from now on slices go over the caller's link, if it has one. */
static int connect_cell(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    char unread[WH_SANDBOX_MESSAGE_BYTES];
    /* Patterns read theirs as they are played. */
    if (mcs->wanted.refuses_unread && !mcs->layout->patterns &&
        wh_sandbox_find_unread(mcs->sandbox, unread)) {
        return luaL_error(L, "%s: %s", mcs->layout->path, unread);
    }
    mcs->link = &mcs->local.simulator.link;
    if (mcs->wanted.partners.connect) {
        wh_mcs_watch_slices(mcs);
        mcs->link = mcs->wanted.partners.connect(mcs->wanted.partners.user, mcs);
    }
    if (!mcs->link) {
        return luaL_error(L, "%s: no link to the simulator", mcs->layout->path);
    }
    if (mcs->local.collision.memory && mcs->link != &mcs->local.simulator.link) {
        wh_mcs_listen(mcs, hear_collisions, &mcs->local.collision);
    }
    if (mcs->wanted.listener.begins) {
        mcs->wanted.listener.begins(mcs->wanted.listener.user, mcs->layout);
    }
    return 0;
}

/* native.parameters(function): the number of its parameters, and true if it takes any number more. */
static int count_parameters(lua_State *L) {
    lua_Debug function;
    luaL_checktype(L, 1, LUA_TFUNCTION);
    lua_settop(L, 1);
    (void)lua_getinfo(L, ">u", &function);
    lua_pushinteger(L, function.nparams);
    lua_pushboolean(L, function.isvararg);
    return 2;
}

/* native.outside(text): a message without a place in a file of lua/mcs. */
static int strip_place(lua_State *L) {
    lua_pushstring(L, wh_sandbox_skip_inner(wh_lua_whole_text(L, 1)));
    return 1;
}

static const luaL_Reg module_functions[] = {{"module", load_module},
                                            {"connect", connect_cell},
                                            {"parameters", count_parameters},
                                            {"outside", strip_place},
                                            {NULL, NULL}};

/* Registry keys of the functions that lua/mcs/init.lua returned: they open the prompt, open a survey,
 * make definitions, and wait for tasks. */
static char prompt_key;
static char survey_key;
static char definitions_key;
static char tasks_key;

/* Runs protected: pushes the native table and hands it to lua/mcs/init.lua, which sets the globals. */
static int open_words(lua_State *L) {
    wh_mcs_t *mcs = lua_touserdata(L, 1);
    const luaL_Reg *const groups[] = {
        module_functions,           wh_mcs_cell_functions,        wh_mcs_command_functions,
        wh_mcs_miss_functions,      wh_mcs_fault_functions,       wh_mcs_describe_functions,
        wh_mcs_plan_functions,      wh_mcs_play_functions,        wh_mcs_query_functions,
        wh_mcs_scan_functions,      wh_mcs_definition_functions,  wh_mcs_saved_functions,
        wh_mcs_edge_functions,      wh_mcs_align_functions,       wh_mcs_calibration_functions,
        wh_mcs_arrival_functions,   wh_mcs_centring_functions,    wh_mcs_teaching_functions,
        wh_mcs_lane_functions,      wh_mcs_job_functions,         wh_mcs_believed_functions,
        wh_mcs_flow_functions,      wh_mcs_flow_played_functions, wh_mcs_flow_timed_functions,
        wh_mcs_flow_call_functions, wh_mcs_own_functions,         wh_mcs_clock_functions,
        wh_mcs_clock_questions,     wh_mcs_port_functions,        wh_mcs_controller_functions,
        wh_mcs_kind_functions};
    luaopen_wh(L);
    lua_setglobal(L, "wh");
    lua_pushcfunction(L, load_module);
    lua_pushliteral(L, "mcs/init.lua");
    lua_call(L, 1, 1);
    lua_newtable(L);
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; ++i) {
        lua_pushlightuserdata(L, mcs);
        luaL_setfuncs(L, groups[i], 1);
    }
    lua_call(L, 1, 4);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &tasks_key);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &definitions_key);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &survey_key);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &prompt_key);
    return 0;
}

void wh_mcs_push_prompt(lua_State *L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &prompt_key);
    lua_call(L, 0, 3);
}

void wh_mcs_push_survey(lua_State *L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &survey_key);
}

int wh_mcs_wait_for_tasks(lua_State *L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &tasks_key);
    lua_call(L, 0, 0);
    return 0;
}

void wh_mcs_push_definitions(lua_State *L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &definitions_key);
}

bool wh_mcs_open(wh_mcs_t *mcs, wh_sandbox_t *sandbox, const char *script, wh_record_t *record,
                 wh_sandbox_result_t *result) {
    memset(mcs, 0, sizeof *mcs);
    mcs->script = script;
    mcs->sandbox = sandbox;
    mcs->stop.at_slice = INT64_MAX;
    wh_recorder_open(&mcs->recorder, record, script);
    /* Nothing of it is garbage. */
    (void)lua_gc(wh_sandbox_state(sandbox), LUA_GCSTOP);
    const bool opened = wh_sandbox_protect(wh_sandbox_state(sandbox), open_words, mcs, result);
    (void)lua_gc(wh_sandbox_state(sandbox), LUA_GCRESTART);
    return opened;
}

/* ---------------------------------------------------------------------------------------------- finishing */

static void add_expectation(wh_mcs_t *mcs, const char *text, bool ok) {
    wh_record_add_expectation(mcs->recorder.record, 0, text, ok);
    wh_mcs_tell(mcs, WH_MCS_EXPECTED, NULL);
}

/* A free-running simulator may miss some slices, but no more than the user allows. */
static void judge_missed(wh_mcs_t *mcs, int64_t missed) {
    char text[100];
    if (mcs->wanted.limits_missed) {
        snprintf(text, sizeof text, "at most %lld missed slices; the simulator missed %lld",
                 (long long)mcs->wanted.most_missed, (long long)missed);
        add_expectation(mcs, text, missed <= mcs->wanted.most_missed);
    }
}

/* If no state has come, a script's commands and expectations saw only the layout: they prove nothing. */
static void judge_heard(wh_mcs_t *mcs) {
    const wh_record_t *record = mcs->recorder.record;
    const bool asked = wh_record_expectations(record) + wh_record_commands(record) > 0;
    const wh_mcs_partners_t *partners = &mcs->wanted.partners;
    if (asked && partners->lossy && !partners->lossy->is_heard(partners->user)) {
        add_expectation(mcs, "a simulator that answers; no state has come from one", false);
    }
}

/* Slices that counted time would leave out were played, and something was decided in them. */
static void judge_counted(wh_mcs_t *mcs) {
    char text[WH_VERIFY_BYTES + 100];
    wh_counted_record_t *counted = &mcs->recorder.record->counted;
    if (mcs->local.counted) {
        counted->stretches = mcs->local.counted->verify.stretches;
        counted->verified = mcs->local.counted->verify.verified;
    }
    if (wh_mcs_miscounted(mcs)[0] != '\0') {
        (void)snprintf(text, sizeof text, "nothing to decide in slices that counted time leaves out; %s",
                       wh_mcs_miscounted(mcs));
        add_expectation(mcs, text, false);
    }
}

/* A script that ends while a command is held has left the robot in a station. One that failed says why. */
static void judge_held(wh_mcs_t *mcs) {
    char text[WH_MCS_HELD_BYTES + 100];
    wh_record_t *record = mcs->recorder.record;
    const wh_mcs_held_t *held = wh_mcs_find_held(mcs, WH_NONE);
    if (record->failure) {
        return;
    }
    if (!held) {
        wh_record_add_implied(record, 0, "CONTINUE or STOP after each command that stops on its way", true);
        return;
    }
    snprintf(text, sizeof text, "CONTINUE or STOP after %s; at the script's end it is held, %s",
             held->command, held->phase);
    wh_record_add_implied(record, 0, text, false);
    wh_mcs_tell(mcs, WH_MCS_EXPECTED, NULL);
}

void wh_mcs_finish(wh_mcs_t *mcs) {
    wh_recorder_end_t end = {.wafers = mcs->state.wafers};
    if (mcs->link) {
        end.hash = mcs->link->hash(mcs->link);
        end.missed = mcs->link->missed(mcs->link);
        end.world = mcs->local.collision.world;
        judge_missed(mcs, end.missed);
        judge_heard(mcs);
    }
    judge_counted(mcs);
    judge_held(mcs);
    wh_mcs_judge_stays(mcs);
    if (!mcs->recorder.record->failure && mcs->layout) {
        free(mcs->recorder.record->never_came);
        mcs->recorder.record->never_came = wh_mcs_tell_never_came(mcs);
    }
    wh_recorder_finish(&mcs->recorder, &end);
    if (mcs->layout) {
        wh_mcs_tell(mcs, WH_MCS_FINISHED, NULL);
    }
}

void wh_mcs_close(wh_mcs_t *mcs) {
    wh_mcs_free_kept(&mcs->kept);
    wh_mcs_free_lanes(mcs);
    wh_mcs_free_edge(&mcs->measuring.edge);
    wh_mcs_free_turns(&mcs->measuring.turns);
    wh_pass_free(&mcs->measuring.pass);
    wh_rehearsal_free(&mcs->rehearsal);
}
