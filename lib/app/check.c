/* waferhand check LOG CHECKS.lua */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include <jansson.h>
#include <lauxlib.h>

#include "../log/slice_fields.h"
#include "../math/hash.h"
#include "../print/record_print.h"
#include "../script/sandbox.h"
#include "../text/array.h"
#include "../text/style.h"
#include "apart.h"
#include "app.h"
#include "check_values.h"
#include "log_arguments.h"

typedef struct {
    wh_log_arguments_t log; /* its path is the first operand */
    wh_option_list_t paths;
} arguments_t;

static void check_arguments_of_check(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (arguments->paths.count != 2) {
        argp_error(state, "by what is %s checked? (expected a log and a file of checks)",
                   arguments->paths.items[0]);
    }
}

static const wh_option_table_t tables[] = {{wh_log_options, offsetof(arguments_t, log), NULL, NULL},
                                           {wh_log_more_options, offsetof(arguments_t, log.more), NULL, NULL},
                                           {0}};

static const wh_command_line_t command_line = {
    .name = "check",
    .synopsis = "LOG CHECKS.lua",
    .about = "Holds a recorded run against what a Lua file expects of it: its events, times, wafers and "
             "slices.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "file",
    .operand_variable = offsetof(arguments_t, paths),
    .operands = 2,
    .check = check_arguments_of_check};

/* The run as the checks see it. */
typedef struct {
    const char *path; /* of the checks */
    wh_log_run_t run;
    json_t *result; /* the record, as `run --json` has it */
    /* Each slice has the values that differ from those of the slice before; each KEY-th one has all. */
    struct {
        int64_t seq;
        size_t changes; /* the number of changes of it and of all slices before it */
    } * slices;
    size_t count, capacity;
    struct {
        uint32_t field;
        double value;
    } * changes;
    size_t change_count, change_capacity;
    double *values;     /* of the slice that was read or asked for last */
    wh_slice_row_t row; /* of the slice that was read last */
    wh_sandbox_t *sandbox;
    size_t expected, unmet;
} checked_t;

/* --------------------------------------------------------------------------------------------- the slices */

/* The distance between slices whose values are all kept. */
#define KEY 256

static void add_change(checked_t *checked, size_t field, double value) {
    checked->changes = wh_array_grow(checked->changes, checked->change_count, &checked->change_capacity,
                                     sizeof *checked->changes);
    checked->changes[checked->change_count].field = (uint32_t)field;
    checked->changes[checked->change_count++].value = value;
}

static void keep(void *user, const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                 uint64_t hash) {
    checked_t *checked = user;
    const size_t count = wh_slice_field_count(layout);
    (void)hash;
    wh_slice_row_take(&checked->row, layout, axes, state);
    if (!checked->values) {
        checked->values = wh_array_new(count, sizeof *checked->values);
    }
    const double *values = checked->row.values;
    for (size_t i = 0; i < count; ++i) {
        if (checked->count % KEY == 0 || wh_double_bits(values[i]) != wh_double_bits(checked->values[i])) {
            add_change(checked, i, values[i]);
        }
    }
    memcpy(checked->values, values, count * sizeof *values);
    checked->slices =
        wh_array_grow(checked->slices, checked->count, &checked->capacity, sizeof *checked->slices);
    checked->slices[checked->count].seq = state->seq;
    checked->slices[checked->count++].changes = checked->change_count;
}

/* All values of slice number `index` among those that are kept. */
static const double *values_of(checked_t *checked, size_t index) {
    const size_t key = index - index % KEY;
    for (size_t i = key > 0 ? checked->slices[key - 1].changes : 0; i < checked->slices[index].changes; ++i) {
        checked->values[checked->changes[i].field] = checked->changes[i].value;
    }
    return checked->values;
}

/* The last slice that ends at this number or before, counted from 1; 0: there is none. Cost: log n. */
static size_t find_slice(const checked_t *checked, int64_t seq) {
    size_t low = 0;
    size_t high = checked->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (checked->slices[middle].seq <= seq) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* ---------------------------------------------------------------------------------------------------- Lua */

static checked_t *checked_of(lua_State *L) {
    return lua_touserdata(L, lua_upvalueindex(1));
}

/* Refuses surplus arguments: the author may think that they count, but nothing reads them. */
static void refuse_surplus(lua_State *L, const char *name, int most) {
    if (lua_gettop(L) > most) {
        luaL_error(L, "%s: %d arguments (expected at most %d)", name, lua_gettop(L), most);
    }
}

/* expect(condition, text) */
static int expect(lua_State *L) {
    checked_t *checked = checked_of(L);
    const int type = lua_type(L, 1);
    const char *text = luaL_optstring(L, 2, "an expectation");
    refuse_surplus(L, "expect", 2);
    if (lua_gettop(L) == 0 || (type != LUA_TBOOLEAN && type != LUA_TNIL)) {
        return luaL_error(L, "expect: %s (expected true, false or nil)",
                          lua_gettop(L) == 0 ? "nothing" : luaL_typename(L, 1));
    }
    ++checked->expected;
    if (!lua_toboolean(L, 1)) {
        ++checked->unmet;
        wh_style_put(stdout, checked->path);
        printf(":%d: not met: ", wh_sandbox_line(L, checked->path));
        wh_style_put(stdout, text);
        putchar('\n');
    }
    return 0;
}

static int64_t slice_at(lua_State *L, const checked_t *checked) {
    const double seconds = luaL_checknumber(L, 1);
    const double slice = floor(seconds * 1e6 / (double)checked->run.cell.layout->slice_us + 1e-6);
    luaL_argcheck(L, slice >= 0 && slice < 9e15, 1, "expected a time of the run in seconds");
    if (slice > (double)checked->run.taken.seq) {
        luaL_error(L, "at: %f s (expected a time of the run, which ends at %f s)", seconds,
                   wh_log_run_end(&checked->run));
    }
    return (int64_t)slice;
}

/* Sets a field of the table below the one at the top, which has the fields that are nil. */
static void set_field(lua_State *L, const char *name, const char *word, double value) {
    if (isnan(value) || (word && word[0] == '\0')) {
        wh_check_set_name(L, name);
        return;
    }
    if (word) {
        lua_pushstring(L, word);
    } else {
        lua_pushnumber(L, value);
    }
    lua_setfield(L, -3, name);
}

/* at(seconds): the slice that ends then, as a table from the names of its fields to their values. */
static int at(lua_State *L) {
    checked_t *checked = checked_of(L);
    const wh_layout_t *layout = checked->run.cell.layout;
    refuse_surplus(L, "at", 1);
    const size_t found = find_slice(checked, slice_at(L, checked));
    if (found == 0) {
        return luaL_error(L, "at: %f s (expected a time from %f s on, where the log begins)",
                          lua_tonumber(L, 1), (double)(checked->slices[0].seq * layout->slice_us) / 1e6);
    }
    const double *values = values_of(checked, found - 1);
    const int64_t seq = checked->slices[found - 1].seq;
    lua_newtable(L);
    lua_pushinteger(L, seq);
    lua_setfield(L, -2, "slice");
    lua_pushnumber(L, (double)(seq * layout->slice_us) / 1e6);
    lua_setfield(L, -2, "time s");
    lua_newtable(L);
    for (size_t i = 0; i < wh_slice_field_count(layout); ++i) {
        char name[WH_SLICE_FIELD_NAME];
        const wh_slice_field_t kind = wh_slice_field_name(layout, i, name);
        set_field(L, name, wh_slice_field_word(layout, kind, values[i]), values[i]);
    }
    wh_check_make_strict(L);
    return 1;
}

/* Kinds of events as keys: true, or why there can be none in the log. */
static void push_kinds(lua_State *L, const checked_t *checked) {
    lua_newtable(L);
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        const char *why = wh_told_layout_lacks(&checked->run.cell, (wh_event_kind_t)kind);
        if (why) {
            lua_pushstring(L, why);
        } else {
            lua_pushboolean(L, true);
        }
        lua_setfield(L, -2, wh_event_name((wh_event_kind_t)kind));
    }
}

/* { kind = , wafer = , gripper = , last = , list = }: the existing names of each, as keys, the end of the
 * run, and what makes a list of a table. It is called `events` until the function of that name has taken
 * it. */
static void push_names(lua_State *L, const checked_t *checked) {
    const wh_layout_t *layout = checked->run.cell.layout;
    lua_createtable(L, 0, 3);
    push_kinds(L, checked);
    lua_setfield(L, -2, "kind");
    lua_newtable(L);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        wh_check_set_name(L, layout->wafers[w].name);
    }
    lua_setfield(L, -2, "wafer");
    lua_newtable(L);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        wh_check_set_name(L, layout->grippers[g].name);
    }
    lua_setfield(L, -2, "gripper");
    lua_pushnumber(L, wh_log_run_end(&checked->run));
    lua_setfield(L, -2, "last");
    lua_pushcfunction(L, wh_check_make_list);
    lua_setfield(L, -2, "list");
    lua_setglobal(L, "events");
}

/* In the sandbox's protection: memory may run out. */
static int set_up(lua_State *L) {
    checked_t *checked = lua_touserdata(L, 1);
    const luaL_Reg functions[] = {{"expect", expect}, {"at", at}, {"ipairs", wh_check_ipairs}};
    push_names(L, checked);
    lua_pushglobaltable(L);
    wh_check_push(L, checked->result);
    lua_setfield(L, -2, "run");
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; ++i) {
        lua_pushlightuserdata(L, checked);
        lua_pushcclosure(L, functions[i].func, 1);
        lua_setfield(L, -2, functions[i].name);
    }
    return 0;
}

/* events{kind = , wafer = , gripper = , from = , to = }: the events that match all of it, in order. */
static const char events_text[] =
    "local known = { kind = 'string', wafer = 'string', gripper = 'string', from = 'number', to = 'number' "
    "}\n"
    "local insert, next, type, error, tostring, select = table.insert, next, type, error, tostring, select\n"
    "local list, names, rawget = run.events, events, rawget\n"
    "function events(wanted, ...)\n"
    "  if select('#', ...) > 0 then\n"
    "    error('events: ' .. 1 + select('#', ...) .. ' arguments (expected one table)', 2)\n"
    "  end\n"
    "  if wanted ~= nil and type(wanted) ~= 'table' then\n"
    "    error('events: ' .. type(wanted) .. ' (expected a table)', 2)\n"
    "  end\n"
    "  for name, value in next, wanted or {} do\n"
    "    if type(value) ~= known[name] or value ~= value then\n"
    "      error('events: ' .. tostring(name) .. ' (expected kind, wafer and gripper as texts, from and to "
    "as numbers)', 2)\n"
    "    end\n"
    "    local is = type(value) ~= 'string' or names[name][value]\n"
    "    if is ~= true then\n"
    "      error('events: ' .. name .. ': ' .. value .. (is and ': ' .. is or ' (there is none of that "
    "name)'), 2)\n"
    "    end\n"
    "  end\n"
    "  local found, w = {}, wanted or {}\n"
    "  local late = w.from and w.from > names.last and 'from' or w.to and w.to > names.last and 'to'\n"
    "  if late then\n"
    "    error('events: ' .. late .. ' ' .. w[late] .. ' (expected a time of the run, which ends at ' .. "
    "names.last .. ' s)', 2)\n"
    "  end\n"
    "  if w.from and w.to and w.from > w.to then\n"
    "    error('events: from ' .. w.from .. ' to ' .. w.to .. ' (expected one that is not before)', 2)\n"
    "  end\n"
    "  for i = 1, #list do\n"
    "    local event = list[i]\n"
    "    local t = event.utime / 1e6\n"
    "    if (w.kind or event.kind) == event.kind and (w.wafer == nil or w.wafer == rawget(event, 'wafer'))\n"
    "      and (w.gripper == nil or w.gripper == rawget(event, 'gripper'))\n"
    "      and t >= (w.from or t) and t <= (w.to or t) then\n"
    "      insert(found, event)\n"
    "    end\n"
    "  end\n"
    "  return names.list(found)\n"
    "end\n";

static bool prepare(const arguments_t *arguments, checked_t *checked, wh_sandbox_result_t *result) {
    const wh_sandbox_limits_t limits = {0};
    checked->sandbox = wh_sandbox_new_with(&limits, arguments->log.parameters.items,
                                           arguments->log.parameters.count, result);
    if (!checked->sandbox) {
        return false;
    }
    lua_State *L = wh_sandbox_state(checked->sandbox);
    const bool is_set =
        wh_sandbox_protect(L, set_up, checked, result) &&
        wh_sandbox_evaluate_text(L, WH_INNER_CHUNK "check", events_text, sizeof events_text - 1, result);
    if (is_set) {
        lua_pop(L, 1);
    }
    return is_set;
}

/* -------------------------------------------------------------------------------------------- the verdict */

/* A log that is not whole cannot show that all went well. */
static int judge_checked(const arguments_t *arguments, const checked_t *checked) {
    const int whole = wh_log_arguments_judge(&arguments->log, &checked->run);
    if (checked->expected == 0) {
        fprintf(stderr, "%s: it expects nothing (expected calls of expect)\n", checked->path);
        return WH_EXIT_USAGE;
    }
    if (checked->unmet > 0) {
        printf("failed: %zu of %zu expectations met\n", checked->expected - checked->unmet,
               checked->expected);
    } else {
        printf("%s: %zu %s met\n", whole == WH_EXIT_MET ? "ok" : "failed: the log is not whole",
               checked->expected, checked->expected == 1 ? "expectation" : "expectations");
    }
    return checked->unmet > 0 ? WH_EXIT_FAILED : whole;
}

static int play(const arguments_t *arguments, checked_t *checked) {
    wh_sandbox_result_t result;
    if (!prepare(arguments, checked, &result) ||
        !wh_sandbox_evaluate(wh_sandbox_state(checked->sandbox), checked->path, &result)) {
        fprintf(stderr, "%s\n", result.message);
        return WH_EXIT_USAGE;
    }
    if (!wh_log_arguments_check_set(&checked->run, checked->sandbox)) {
        return WH_EXIT_USAGE;
    }
    const int status = judge_checked(arguments, checked);
    return wh_app_is_printed(0) ? status : WH_EXIT_USAGE;
}

static void close_checked(checked_t *checked) {
    wh_sandbox_free(checked->sandbox);
    json_decref(checked->result);
    free(checked->slices);
    free(checked->changes);
    free(checked->values);
    wh_slice_row_free(&checked->row);
    wh_log_run_close(&checked->run);
}

static int check_log(arguments_t *arguments) {
    static checked_t checked;
    const wh_named_file_t named[] = {{"the log", arguments->paths.items[0], false},
                                     {"the checks", arguments->paths.items[1], false},
                                     {"the layout", arguments->log.layout, false}};
    int status = WH_EXIT_USAGE;
    if (!wh_files_are_apart(named, 3, true)) {
        return status;
    }
    arguments->log.path = arguments->paths.items[0];
    checked.path = arguments->paths.items[1];
    if (wh_log_arguments_read(&arguments->log, keep, &checked, &checked.run)) {
        checked.result = wh_record_to_json(&checked.run.record);
        status = play(arguments, &checked);
    }
    close_checked(&checked);
    return status;
}

int wh_app_check(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    const int status = arguments.paths.count == 2 ? check_log(&arguments) : WH_EXIT_USAGE;
    wh_option_list_free(&arguments.paths);
    wh_option_list_free(&arguments.log.parameters);
    wh_option_list_free(&arguments.log.more.then);
    return status;
}
