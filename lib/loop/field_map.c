#include "field_map.h"

#include <lauxlib.h>
#include <stdio.h>
#include <string.h>

#include "../layout/axes.h"
#include "../log/slice_fields.h"
#include "../script/reader.h"
#include "../text/nearest.h"

#define END                                                                                                  \
    { NULL, NULL, NULL, false }

static const wh_reader_field_t map_fields[] = {
    {"separator", "string", "one byte; a comma, or a tab if the first line has one and no comma", false},
    {"decimal", "string", "the mark in numbers; a point", false},
    {"time", "string|table", "the column of the time, s", true},
    {"axes", "table", "by axis: its column, or where it stands", true},
    {"valves", "table", "by gripper: its column, or true or false", true},
    {"sensors", "table", "by gripper: its column, or false", true},
    {"ignore", "string[]", "columns that nobody reads", false},
    END};

void wh_field_axis_name(const wh_layout_t *layout, size_t axis, char *name, size_t size) {
    char own[WH_NAME_SIZE * 2];
    if (axis < wh_machine_robot_axes(&layout->machine)) {
        (void)snprintf(name, size, "%s", wh_layout_axis_label(layout, axis, own, sizeof own));
    } else {
        wh_layout_name_axis(layout, axis, name, size);
    }
}

/* An axis that the robot has not, such as the yaw of an arm without a wrist, stands at 0 and is in no log. */
static bool is_absent(const wh_layout_t *layout, size_t axis) {
    return axis < wh_machine_robot_axes(&layout->machine) && !wh_axis_exists(&layout->machine, axis);
}

static const wh_field_source_t at_zero = {.is_told = true, .is_constant = true};

/* The column of this name; column_count: there is none. */
static size_t find_column(const wh_field_log_t *field, const char *name) {
    size_t column = 0;
    while (column < field->column_count && strcmp(field->names[column], name) != 0) {
        ++column;
    }
    return column;
}

static const char *suggest(const wh_field_log_t *field, const char *name, char meant[WH_NEAREST_TEXT]) {
    return wh_text_did_you_mean(
        meant, "; ", "", wh_text_nearest(name, (const char *const *)field->names, field->column_count));
}

/* -------------------------------------------------------------------------------------- the usual names */

static bool refuse_missing(wh_field_log_t *field, const char *name) {
    char meant[WH_NEAREST_TEXT];
    (void)snprintf(
        field->message, sizeof field->message,
        "%.300s:1: no column is named %s%s (expected those of `waferhand csv`, or a map: --columns)",
        field->path, name, suggest(field, name, meant));
    return false;
}

static bool take_usual(wh_field_log_t *field, const char *name, wh_field_source_t *source) {
    const size_t column = find_column(field, name);
    if (column == field->column_count) {
        return refuse_missing(field, name);
    }
    field->is_used[column] = true;
    source->is_told = true;
    source->column = column;
    source->scale = 1;
    return true;
}

static bool take_usual_axis(wh_field_log_t *field, size_t axis) {
    char name[WH_NAME_SIZE * 2];
    char column[WH_SLICE_FIELD_NAME];
    const char *unit = wh_layout_axis_unit(field->layout, axis);
    if (is_absent(field->layout, axis)) {
        field->axes[axis] = at_zero;
        return true;
    }
    wh_layout_name_axis(field->layout, axis, name, sizeof name);
    (void)snprintf(column, sizeof column, "axis %.60s %s", name, unit ? unit : "");
    field->axes[axis].is_angle_in_rad = true;
    return take_usual(field, column, &field->axes[axis]);
}

/* Valve 0 is open there. */
static bool take_usual_gripper(wh_field_log_t *field, size_t gripper) {
    char column[WH_SLICE_FIELD_NAME];
    const char *name = field->layout->grippers[gripper].name;
    (void)snprintf(column, sizeof column, "%.60s valve", name);
    field->valves[gripper].is_turned = true;
    if (!take_usual(field, column, &field->valves[gripper])) {
        return false;
    }
    (void)snprintf(column, sizeof column, "%.60s sensor", name);
    field->has_sensors |= 1U << gripper;
    return take_usual(field, column, &field->sensors[gripper]);
}

/* True for another column of `csv`, which nobody reads here. */
static bool is_usual(const wh_field_log_t *field, const char *name) {
    char known[WH_SLICE_FIELD_NAME];
    bool is_known = strcmp(name, "slice") == 0;
    for (size_t i = 0; !is_known && i < wh_slice_field_count(field->layout); ++i) {
        (void)wh_slice_field_name(field->layout, i, known);
        is_known = strcmp(name, known) == 0;
    }
    return is_known;
}

static bool refuse_unknown(wh_field_log_t *field, const char *name) {
    (void)snprintf(field->message, sizeof field->message,
                   "%.300s:1: %.100s: nobody reads this column (expected only known ones; a map's `ignore` "
                   "names others)",
                   field->path, name);
    return false;
}

/* Refuses a column that nobody reads. */
static bool check_columns(wh_field_log_t *field) {
    for (size_t i = 0; i < field->column_count; ++i) {
        if (!field->is_used[i] && (field->map || !is_usual(field, field->names[i]))) {
            return refuse_unknown(field, field->names[i]);
        }
        field->ignored += field->is_used[i] ? 0 : 1;
    }
    return true;
}

/* Refuses a column that is there twice. */
static bool check_names(wh_field_log_t *field) {
    for (size_t i = 0; i < field->column_count; ++i) {
        if (find_column(field, field->names[i]) != i) {
            (void)snprintf(field->message, sizeof field->message,
                           "%.300s:1: %.100s: this column is there twice", field->path, field->names[i]);
            return false;
        }
    }
    return true;
}

bool wh_field_map_usual(wh_field_log_t *field) {
    bool good = check_names(field) && take_usual(field, "time s", &field->time);
    for (size_t axis = 0; good && axis < field->layout->machine.axis_count; ++axis) {
        good = take_usual_axis(field, axis);
    }
    for (size_t g = 0; good && g < field->layout->machine.gripper_count; ++g) {
        good = take_usual_gripper(field, g);
    }
    return good && check_columns(field);
}

/* ---------------------------------------------------------------------------------------------- the map */

typedef struct {
    wh_field_log_t *field;
    wh_reader_t reader;
    char separator;
} map_t;

static void use_column(map_t *map, const char *of, const char *name, wh_field_source_t *source) {
    char meant[WH_NEAREST_TEXT];
    wh_field_log_t *field = map->field;
    const size_t column = find_column(field, name);
    if (column == field->column_count) {
        wh_reader_refuse(&map->reader, of, name, "a column of the first line of %s%s", field->path,
                         suggest(field, name, meant));
    }
    if (field->is_used[column]) {
        wh_reader_refuse(&map->reader, of, name, "a column that nothing else is read from");
    }
    field->is_used[column] = true;
    source->is_told = true;
    source->column = column;
}

static const wh_reader_field_t axis_fields[] = {{"scale", "number", "", false},
                                                {"offset", "number", "", false},
                                                {"unit", "\"deg\"|\"rad\"|\"mm\"", "", false},
                                                END};
static const wh_reader_field_t time_fields[] = {
    {"scale", "number", "", false}, {"offset", "number", "", false}, END};
static const wh_reader_field_t bit_fields[] = {
    {"on", "string", "", false}, {"off", "string", "", false}, END};

/* Refuses names beside the column's in a table { NAME, ... }, which the reader has entered, and reads it. */
static void read_name(map_t *map, const char *of, const wh_reader_field_t *known, wh_field_source_t *source) {
    wh_reader_t *reader = &map->reader;
    lua_State *L = reader->L;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        bool is_known = lua_isinteger(L, -2) && lua_tointeger(L, -2) == 1;
        for (const wh_reader_field_t *row = known; row->name && lua_type(L, -2) == LUA_TSTRING; ++row) {
            is_known = is_known || strcmp(row->name, lua_tostring(L, -2)) == 0;
        }
        if (!is_known) {
            wh_reader_fail(reader, NULL, "{ NAME%s%s%s }", known[0].name ? ", " : "", known[0].name,
                           known[1].name ? " = ..., and the like" : " = ...");
        }
    }
    if (lua_rawgeti(L, -1, 1) != LUA_TSTRING) {
        wh_reader_fail(reader, "[1]", "the name of a column");
    }
    use_column(map, of, lua_tostring(L, -1), source);
    lua_pop(L, 1);
}

static void read_scale(map_t *map, wh_field_source_t *source) {
    source->scale = wh_reader_number(&map->reader, "scale", 1, -1e12, 1e12);
    source->offset = wh_reader_number(&map->reader, "offset", 0, -1e9, 1e9);
    if (source->scale == 0) {
        wh_reader_refuse(&map->reader, "scale", "0", "a number that is not 0");
    }
}

static void read_on(map_t *map, wh_field_source_t *source) {
    source->scale = 1;
    wh_reader_text(&map->reader, "on", "", source->on, sizeof source->on);
    wh_reader_text(&map->reader, "off", "", source->off, sizeof source->off);
    if (source->off[0] != '\0' && (source->on[0] == '\0' || strcmp(source->on, source->off) == 0)) {
        wh_reader_refuse(&map->reader, "off", source->off, "a text beside `on`, and another one");
    }
}

/* An axis's unit; that of an axis that shifts is mm. */
static void read_unit(map_t *map, size_t axis, wh_field_source_t *source) {
    static const char *const turning[] = {"deg", "rad", NULL};
    static const char *const shifting[] = {"mm", NULL};
    const bool turns = wh_layout_axis_turns(map->field->layout, axis);
    const int unit = wh_reader_choice(&map->reader, "unit", 0, turns ? turning : shifting);
    source->is_angle_in_rad = unit == 1;
}

/* A value of a table of axes or grippers, by its name. */
typedef struct {
    const char *name;
    size_t number; /* of the axis or gripper */
    wh_field_source_t *source;
} entry_t;

static void read_axis(map_t *map, const entry_t *entry) {
    wh_reader_t *reader = &map->reader;
    if (is_absent(map->field->layout, entry->number) && !wh_reader_has(reader, entry->name)) {
        *entry->source = at_zero;
        return;
    }
    switch (wh_reader_push(reader, entry->name)) {
    case LUA_TNUMBER:
        lua_pop(reader->L, 1);
        *entry->source = (wh_field_source_t){.is_told = true,
                                             .is_constant = true,
                                             .offset = wh_reader_number(reader, entry->name, 0, -1e6, 1e6)};
        return;
    case LUA_TSTRING:
        use_column(map, entry->name, lua_tostring(reader->L, -1), entry->source);
        entry->source->scale = 1;
        lua_pop(reader->L, 1);
        return;
    case LUA_TTABLE:
        lua_pop(reader->L, 1);
        (void)wh_reader_enter(reader, entry->name);
        read_name(map, NULL, axis_fields, entry->source);
        read_scale(map, entry->source);
        read_unit(map, entry->number, entry->source);
        wh_reader_leave(reader);
        return;
    default:
        wh_reader_fail(reader, entry->name,
                       "a column's name, { NAME, scale =, offset =, unit = }, or where it stands");
    }
}

static void read_bit(map_t *map, const entry_t *entry) {
    wh_reader_t *reader = &map->reader;
    switch (wh_reader_push(reader, entry->name)) {
    case LUA_TBOOLEAN:
        *entry->source = (wh_field_source_t){
            .is_told = true, .is_constant = true, .offset = lua_toboolean(reader->L, -1) ? 1 : 0};
        lua_pop(reader->L, 1);
        return;
    case LUA_TSTRING:
        use_column(map, entry->name, lua_tostring(reader->L, -1), entry->source);
        lua_pop(reader->L, 1);
        return;
    case LUA_TTABLE:
        lua_pop(reader->L, 1);
        (void)wh_reader_enter(reader, entry->name);
        read_name(map, NULL, bit_fields, entry->source);
        read_on(map, entry->source);
        wh_reader_leave(reader);
        return;
    default:
        wh_reader_fail(reader, entry->name,
                       "a column's name, { NAME, on = TEXT, off = TEXT }, true or false");
    }
}

/* Refuses names of the table being read that are none of the entries. */
static void refuse_others(map_t *map, const entry_t entries[], size_t count, const char *kind) {
    wh_reader_t *reader = &map->reader;
    char meant[WH_NEAREST_TEXT];
    const char *names[WH_AXES > WH_GRIPPERS ? WH_AXES : WH_GRIPPERS];
    for (size_t i = 0; i < count; ++i) {
        names[i] = entries[i].name;
    }
    for (lua_pushnil(reader->L); lua_next(reader->L, -2) != 0; lua_pop(reader->L, 1)) {
        const char *name = lua_type(reader->L, -2) == LUA_TSTRING ? lua_tostring(reader->L, -2) : "";
        bool is_known = false;
        for (size_t i = 0; i < count; ++i) {
            is_known = is_known || strcmp(names[i], name) == 0;
        }
        if (!is_known) {
            wh_reader_fail(reader, name, "%s of the layout%s", kind,
                           wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(name, names, count)));
        }
    }
}

static void read_axes(map_t *map) {
    const wh_layout_t *layout = map->field->layout;
    const size_t count = layout->machine.axis_count;
    char names[WH_AXES][WH_NAME_SIZE * 2];
    entry_t entries[WH_AXES] = {{NULL, 0, NULL}};
    if (!wh_reader_enter(&map->reader, "axes")) {
        wh_reader_refuse(&map->reader, "axes", NULL, "a table by axis");
    }
    for (size_t axis = 0; axis < count; ++axis) {
        wh_field_axis_name(layout, axis, names[axis], sizeof names[axis]);
        entries[axis] = (entry_t){names[axis], axis, &map->field->axes[axis]};
    }
    refuse_others(map, entries, count, "an axis");
    for (size_t axis = 0; axis < count; ++axis) {
        read_axis(map, &entries[axis]);
    }
    wh_reader_leave(&map->reader);
}

static void read_bits(map_t *map, const char *table, wh_field_source_t sources[]) {
    const wh_layout_t *layout = map->field->layout;
    const size_t count = layout->machine.gripper_count;
    entry_t entries[WH_GRIPPERS] = {{NULL, 0, NULL}};
    if (!wh_reader_enter(&map->reader, table)) {
        wh_reader_refuse(&map->reader, table, NULL, "a table by gripper");
    }
    for (size_t g = 0; g < count; ++g) {
        entries[g] = (entry_t){layout->grippers[g].name, g, &sources[g]};
    }
    refuse_others(map, entries, count, "a gripper");
    for (size_t g = 0; g < count; ++g) {
        read_bit(map, &entries[g]);
    }
    wh_reader_leave(&map->reader);
}

static void read_time(map_t *map) {
    wh_reader_t *reader = &map->reader;
    wh_field_source_t *source = &map->field->time;
    const int type = wh_reader_push(reader, "time");
    if (type == LUA_TSTRING) {
        use_column(map, "time", lua_tostring(reader->L, -1), source);
        source->scale = 1;
        lua_pop(reader->L, 1);
        return;
    }
    if (type != LUA_TTABLE) {
        wh_reader_fail(reader, "time", "a column's name, or { NAME, scale =, offset = }");
    }
    lua_pop(reader->L, 1);
    (void)wh_reader_enter(reader, "time");
    read_name(map, NULL, time_fields, source);
    read_scale(map, source);
    wh_reader_leave(reader);
}

/* A sensor that the log has not is false; a constant of it would be compared with nothing that was seen. */
static void note_sensors(map_t *map) {
    wh_field_log_t *field = map->field;
    for (size_t g = 0; g < field->layout->machine.gripper_count; ++g) {
        if (field->sensors[g].is_constant && field->sensors[g].offset != 0) {
            wh_reader_refuse(&map->reader, "sensors", field->layout->grippers[g].name,
                             "a column, or false for a sensor that the log has not");
        }
        field->has_sensors |= field->sensors[g].is_constant ? 0 : 1U << g;
    }
}

static void read_ignored(map_t *map) {
    wh_reader_t *reader = &map->reader;
    if (!wh_reader_enter(reader, "ignore")) {
        return;
    }
    const size_t count = wh_reader_list(reader);
    for (size_t i = 1; i <= count; ++i) {
        wh_field_source_t nobody;
        if (lua_rawgeti(reader->L, -1, (lua_Integer)i) != LUA_TSTRING) {
            wh_reader_fail(reader, NULL, "a list of columns' names");
        }
        use_column(map, NULL, lua_tostring(reader->L, -1), &nobody);
        lua_pop(reader->L, 1);
    }
    map->field->ignored = count;
    wh_reader_leave(reader);
}

/* Leaves the map's table on the stack, and begins to read it. */
static void begin_map(lua_State *L, map_t *map) {
    wh_sandbox_result_t result;
    const char *path = map->field->map;
    luaL_checkstack(L, 40, NULL);
    if (!wh_sandbox_evaluate(L, path, &result)) {
        lua_pushstring(L, result.message);
        (void)lua_error(L);
    }
    if (!lua_istable(L, -1)) {
        luaL_error(L, "%s: a table was expected: return { time = ..., axes = { ... } }", path);
    }
    wh_reader_start(&map->reader, L, path);
    wh_reader_refuse_unknown(&map->reader, map_fields);
}

static void read_decimal(map_t *map) {
    static const char *const marks[] = {".", ",", NULL};
    map->field->has_commas = wh_reader_choice(&map->reader, "decimal", 0, marks) == 1;
    if (map->field->has_commas && map->separator == ',') {
        wh_reader_refuse(&map->reader, "decimal", ",", "another one than the separator");
    }
}

static int read_separator(lua_State *L) {
    map_t *map = lua_touserdata(L, 1);
    begin_map(L, map);
    if (wh_reader_push(&map->reader, "separator") == LUA_TSTRING && lua_rawlen(L, -1) == 1 &&
        strchr("\t,;|", lua_tostring(L, -1)[0])) {
        map->separator = lua_tostring(L, -1)[0];
    } else if (!lua_isnil(L, -1)) {
        wh_reader_fail(&map->reader, "separator", "\",\", \";\", \"|\" or \"\\t\"");
    }
    lua_pop(L, 1);
    read_decimal(map);
    return 0;
}

static int read_map(lua_State *L) {
    map_t *map = lua_touserdata(L, 1);
    begin_map(L, map);
    read_time(map);
    read_axes(map);
    read_bits(map, "valves", map->field->valves);
    read_bits(map, "sensors", map->field->sensors);
    note_sensors(map);
    read_ignored(map);
    return 0;
}

/* Runs it in a sandbox of its own. */
static bool run_map(map_t *map, const wh_sandbox_limits_t *limits, lua_CFunction read) {
    wh_field_log_t *field = map->field;
    wh_sandbox_result_t result;
    wh_sandbox_t *sandbox = wh_sandbox_new(limits);
    if (!sandbox) {
        (void)snprintf(field->message, sizeof field->message, "%.300s: not enough memory", field->map);
        return false;
    }
    const bool good = wh_sandbox_protect(wh_sandbox_state(sandbox), read, map, &result);
    if (!good) {
        (void)snprintf(field->message, sizeof field->message, "%s", result.message);
    }
    wh_sandbox_free(sandbox);
    return good;
}

bool wh_field_map_separator(wh_field_log_t *field, const wh_sandbox_limits_t *limits, char *separator) {
    map_t map = {.field = field};
    const bool good = run_map(&map, limits, read_separator);
    *separator = map.separator;
    return good;
}

bool wh_field_map_read(wh_field_log_t *field, const wh_sandbox_limits_t *limits) {
    map_t map = {.field = field};
    return check_names(field) && run_map(&map, limits, read_map) && check_columns(field);
}
