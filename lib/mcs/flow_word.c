#include "flow_word.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../flow/textbook.h"
#include "../flow/waits.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "../text/clock.h"
#include "../text/nearest.h"
#include "flow_own.h"
#include "flow_plan.h"

static double seconds(int64_t us) {
    return (double)us / 1e6;
}

static void set_seconds(lua_State *L, const char *name, int64_t us) {
    if (us != WH_FLOW_NEVER) {
        lua_pushnumber(L, seconds(us));
        lua_setfield(L, -2, name);
    }
}

/* Each wafer's stay that was longer than its station's window. */
static void push_late(lua_State *L, const wh_flow_figures_t *figures) {
    lua_createtable(L, (int)figures->stays.late_count, 0);
    for (size_t i = 0; i < figures->stays.late_count; ++i) {
        const wh_flow_stay_t *stay = &figures->stays.late[i];
        lua_createtable(L, 0, 5);
        wh_lua_set_text(L, "wafer", figures->plan->wafers[stay->wafer].name);
        wh_lua_set_text(L, "station", figures->tool->stations[stay->station].name);
        set_seconds(L, "done_s", stay->done_us);
        set_seconds(L, "stay_s", stay->taken_us - stay->done_us);
        set_seconds(L, "window_s", stay->window_us);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* The waits: robots' waits by cause, done wafers' by the robot or station that kept them. */
static void push_waits(lua_State *L, const wh_flow_figures_t *figures) {
    size_t count = 0;
    wh_flow_wait_t *waits = wh_flow_waits(figures, &count);
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; ++i) {
        const wh_flow_wait_t *wait = &waits[i];
        lua_createtable(L, 0, 3);
        wh_lua_set_text(L, "who", wait->cause ? "robots" : "wafers");
        wh_lua_set_text(L, "cause",
                        wait->cause                   ? wait->cause
                        : wait->robot != WH_FLOW_NONE ? figures->tool->robots[wait->robot].name
                                                      : figures->tool->stations[wait->station].name);
        lua_pushnumber(L, wait->us / 1e6);
        lua_setfield(L, -2, "seconds");
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    free(waits);
}

/* The smallest gap to a window, and the cycle of the textbook, where there is one. */
static void push_limits(lua_State *L, const wh_flow_figures_t *figures) {
    const wh_flow_textbook_t textbook = wh_flow_textbook(figures->tool, figures->plan);
    if (!textbook.why) {
        lua_pushnumber(L, textbook.cycle_us / 1e6);
        lua_setfield(L, -2, "textbook_s");
    }
    if (figures->stays.nearest_count > 0) {
        set_seconds(L, "gap_s", wh_flow_gap_us(&figures->stays.nearest[0]));
    }
}

/* By name, the share of the time in each class. */
static void push_shares(lua_State *L, const double times_us[], const char *const names[], size_t count,
                        double all_us) {
    lua_createtable(L, 0, (int)count);
    for (size_t i = 0; i < count; ++i) {
        lua_pushnumber(L, all_us > 0 ? times_us[i] / all_us : 0);
        lua_setfield(L, -2, names[i]);
    }
}

static void push_all_shares(lua_State *L, const wh_flow_figures_t *figures) {
    const wh_flow_tool_t *tool = figures->tool;
    lua_newtable(L);
    for (size_t r = 0; r < tool->robot_count; ++r) {
        push_shares(L, figures->robots[r], wh_flow_robot_class_names, WH_FLOW_ROBOT_CLASSES,
                    (double)figures->end_us);
        lua_setfield(L, -2, tool->robots[r].name);
    }
    lua_setfield(L, -2, "robots");
    lua_newtable(L);
    for (size_t s = 0; s < tool->station_count; ++s) {
        push_shares(L, figures->stations[s], wh_flow_station_class_names, WH_FLOW_STATION_CLASSES,
                    (double)figures->end_us * tool->stations[s].slots);
        lua_setfield(L, -2, tool->stations[s].name);
    }
    lua_setfield(L, -2, "stations");
}

/* The parts of the critical path. */
static void push_path(lua_State *L, const wh_flow_figures_t *figures) {
    lua_createtable(L, (int)figures->part_count, 0);
    for (size_t i = 0; i < figures->part_count; ++i) {
        const wh_flow_part_t *part = &figures->parts[i];
        lua_createtable(L, 0, 3);
        if (part->robot != WH_FLOW_NONE) {
            wh_lua_set_text(L, "of", figures->tool->robots[part->robot].name);
        } else if (part->station != WH_FLOW_NONE) {
            wh_lua_set_text(L, "of", figures->tool->stations[part->station].name);
        }
        wh_lua_set_text(L, "what", wh_flow_path_words[part->word]);
        set_seconds(L, "seconds", part->us);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* Each field that a result may have: a script asks for those that it has not with nil. */
static const char *const result_fields[] = {
    "end",        "why",    "makespan_s", "wafers",   "left",           "lost",  "skipped",
    "cycle_s",    "period", "per_hour",   "no_cycle", "longest_stay_s", "stays", "gap_s",
    "textbook_s", "waits",  "path",       "robots",   "stations",
};

#define RESULT_FIELDS (sizeof result_fields / sizeof *result_fields)

static bool is_result_field(const char *name) {
    for (size_t i = 0; i < RESULT_FIELDS; ++i) {
        if (strcmp(name, result_fields[i]) == 0) {
            return true;
        }
    }
    return false;
}

/* A field that the result has not: nil if there may be one. `path` was not kept, and is not empty. */
static int look_up(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    char meant[WH_NEAREST_TEXT], text[200];
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : luaL_tolstring(L, 2, NULL);
    if (mcs->wanted.keeps == WH_FLOW_SUMS && strcmp(name, "path") == 0) {
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT, "path: the critical path is not kept with --brief");
    }
    if (!is_result_field(name)) {
        const char *const nearest = wh_text_nearest(name, result_fields, RESULT_FIELDS);
        (void)snprintf(text, sizeof text, "what flow returned: there is no %.60s%s", name,
                       wh_text_did_you_mean(meant, "; ", "", nearest));
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT, text);
    }
    return 0;
}

/* The result on top of the stack raises an error where a field is read that no result has. */
static void set_fields_apart(lua_State *L, wh_mcs_t *mcs) {
    lua_createtable(L, 0, 1);
    lua_pushlightuserdata(L, mcs);
    lua_pushcclosure(L, look_up, 1);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
}

/* The word's result. */
static void push_result(lua_State *L, wh_mcs_t *mcs, const wh_flow_figures_t *figures) {
    static const char *const ends[] = {"done", "stuck", "broken", "cut"};
    const wh_flow_result_t *result = &figures->result;
    lua_createtable(L, 0, 16);
    wh_lua_set_text(L, "end", ends[result->end]);
    set_seconds(L, "makespan_s", result->makespan_us);
    wh_lua_set_integer(L, "wafers", (int64_t)result->over);
    wh_lua_set_integer(L, "left", (int64_t)result->left);
    wh_lua_set_integer(L, "lost", (int64_t)result->lost);
    wh_lua_set_integer(L, "skipped", (int64_t)result->skipped);
    if (result->period > 0) {
        lua_pushnumber(L, seconds(result->cycle_us) / result->period);
        lua_setfield(L, -2, "cycle_s");
        wh_lua_set_integer(L, "period", result->period);
        lua_pushnumber(L, 3600 * result->period / seconds(result->cycle_us));
        lua_setfield(L, -2, "per_hour");
    }
    if (result->no_cycle) {
        wh_lua_set_text(L, "no_cycle", result->no_cycle);
    }
    if (result->why) {
        wh_lua_set_text(L, "why", result->why);
    }
    set_seconds(L, "longest_stay_s", figures->stays.longest_us);
    push_limits(L, figures);
    push_late(L, figures);
    lua_setfield(L, -2, "stays");
    push_waits(L, figures);
    lua_setfield(L, -2, "waits");
    if (mcs->wanted.keeps != WH_FLOW_SUMS) {
        push_path(L, figures);
        lua_setfield(L, -2, "path");
    }
    push_all_shares(L, figures);
    set_fields_apart(L, mcs);
}

/* Wafers are not at their ends: why, however long these texts are. */
static void fail(wh_record_t *record, const char *word, const char *why, const char *error) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = wh_memory_need(open_memstream(&text, &size));
    fprintf(out, "every wafer at its end; %s%s%s%s", word, why ? why : "", error ? ": " : "",
            error ? error : "");
    (void)fclose(out);
    wh_record_add_implied(record, record->flow->line, text, false);
    free(text);
}

static void judge_end(wh_record_t *record, const wh_flow_t *flow, const char *error) {
    const wh_flow_result_t *result = &flow->figures.result;
    fail(record, result->end == WH_FLOW_STUCK ? "STUCK: " : "", result->why, error);
}

void wh_flow_fail_word(const wh_mcs_t *mcs, const char *why) {
    fail(mcs->recorder.record, "", why, NULL);
}

/* A study counts the windows of each station as one expectation, met or not. */
static void imply_windows(wh_record_t *record, const wh_flow_t *flow) {
    const wh_flow_figures_t *figures = &flow->figures;
    char text[600];
    for (size_t s = 0; s < figures->tool->station_count; ++s) {
        const wh_flow_window_t *window = &figures->stays.windows[s];
        if (window->count > 0) {
            (void)snprintf(text, sizeof text, "wafers out of %s within its window of %.6g s",
                           figures->tool->stations[s].name, seconds(window->nearest.window_us));
            wh_record_count_implied(record, flow->line, text, window->late == 0);
        }
    }
}

/* A flow that did not end well, and stays that were too long, fail the run as expectations do. A cut was
 * asked for: it is told, and is no expectation. `error`: of a function of the script, which may catch it; or
 * null. */
static void judge_flow(wh_mcs_t *mcs, const wh_flow_t *flow, const char *error) {
    const wh_flow_figures_t *figures = &flow->figures;
    wh_record_t *record = mcs->recorder.record;
    char text[600];
    if (figures->result.end == WH_FLOW_STUCK || figures->result.end == WH_FLOW_BROKEN) {
        judge_end(record, flow, error);
    } else if (figures->result.end == WH_FLOW_DONE && figures->result.lost == 0) {
        wh_record_count_implied(record, flow->line, "every wafer at its end", true);
    }
    for (size_t i = 0; i < figures->stays.late_count && !flow->is_lateness_told; ++i) {
        const wh_flow_stay_t *stay = &figures->stays.late[i];
        (void)snprintf(text, sizeof text, "%s out of %s at most %.6g s after its process; it stayed %.6g s",
                       figures->plan->wafers[stay->wafer].name, figures->tool->stations[stay->station].name,
                       seconds(stay->window_us), seconds(stay->taken_us - stay->done_us));
        wh_record_add_breach(record, flow->line, text);
    }
    if (!flow->is_lateness_told) {
        imply_windows(record, flow);
    }
}

wh_flow_t *wh_flow_read_word(lua_State *L, wh_mcs_t *mcs, const wh_flow_tool_t *tool) {
    wh_record_t *record = mcs->recorder.record;
    wh_reader_t reader;
    char where[300];
    if (record->flow) {
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT, "flow: there was one before (expected one in a run)");
    }
    if (!lua_istable(L, 1)) {
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT, "flow: a table was expected, as in flow { lots = ... }");
    }
    lua_settop(L, 1);
    record->flow = wh_array_new(1, sizeof *record->flow);
    record->flow->tool = tool;
    record->flow->line = wh_sandbox_line(L, mcs->script);
    (void)snprintf(where, sizeof where, "%.200s:%d: flow", mcs->script, record->flow->line);
    wh_reader_start(&reader, L, where);
    wh_flow_read(&reader, tool, mcs->layout, record->flow);
    return record->flow;
}

int wh_flow_return_word(lua_State *L, wh_mcs_t *mcs, bool has_failed) {
    wh_flow_t *flow = mcs->recorder.record->flow;
    judge_flow(mcs, flow, has_failed && lua_isstring(L, -1) ? lua_tostring(L, -1) : NULL);
    if (has_failed) {
        return lua_error(L);
    }
    push_result(L, mcs, &flow->figures);
    return 1;
}

/* native.flow(description): plays it by times alone, and returns its figures. */
static int play_flow(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_flow_tool_t *tool = mcs->layout->tool;
    wh_flow_t *flow = wh_flow_read_word(L, mcs, tool);
    flow->plan.ends_steady = flow->asks_steady = mcs->wanted.until_steady;
    const double begin = wh_clock_seconds();
    wh_flow_own_open(L, tool, &flow->plan);
    wh_flow_measure(tool, &flow->plan, mcs->wanted.keeps, &flow->figures);
    const bool has_failed = wh_flow_own_close(L, &flow->plan);
    flow->plan.ends_steady = false;
    if (flow->has_gains && !has_failed) {
        flow->figures.gains = wh_flow_gains(tool, &flow->plan);
    }
    mcs->recorder.record->wall_s += wh_clock_seconds() - begin;
    return wh_flow_return_word(L, mcs, has_failed);
}

const luaL_Reg wh_mcs_flow_functions[] = {{"flow", play_flow}, {NULL, NULL}};
