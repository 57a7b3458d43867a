#include "map.h"

#include <lauxlib.h>
#include <stdio.h>
#include <string.h>

#include "../script/reader.h"
#include "../text/nearest.h"

#define END                                                                                                  \
    { NULL, NULL, NULL, false }

#define COLUMN "string|{ [1]: string, scale: number? }|fun(row: table): string|number|nil"

static const wh_reader_field_t map_fields[] = {
    {"separator", "string", "one byte; a comma, or a tab if the first line has one and no comma", false},
    {"columns", "table", "by our column: theirs", false},
    {"actions", "table<string, string>", "by their word: ours", false},
    {"skip", "fun(row: table): boolean", "true: the row is left out", false},
    {"expand", "fun(row: table): table[]", "the rows that come of one, with our columns", false},
    END};

static const wh_reader_field_t column_fields[WH_SCHEDULE_COLUMNS + 1] = {
    {"robot", COLUMN, "", false},   {"action", COLUMN, "", false}, {"wafer", COLUMN, "", false},
    {"station", COLUMN, "", false}, {"slot", COLUMN, "", false},   {"begin_s", COLUMN, "", false},
    {"end_s", COLUMN, "", false},   {"arm", COLUMN, "", false},    {"wafer2", COLUMN, "", false},
    {"to", COLUMN, "", false},      {"value", COLUMN, "", false},  END};

/* One of our columns. */
typedef struct {
    bool is_there, is_function; /* a function is on the stack, at `index` */
    size_t field;
    double scale;
    int index;
} column_t;

typedef struct {
    wh_schedule_reader_t *schedule;
    const char *map, *path;
    char separator;
    column_t columns[WH_SCHEDULE_COLUMNS];
    char theirs[WH_SCHEDULE_COLUMNS][WH_SCHEDULE_NAME + 1];
    bool has_functions;
    int names, actions, skip, expand, common, row; /* places on the stack; 0: not there */
    bool *doubled, *used; /* columns whose names are there twice, and those that are read; on the stack */
    size_t fields;
    bool is_refused;
} map_t;

/* ------------------------------------------------------------------------------------------------ the map */

static int take_function(wh_reader_t *reader, map_t *map, const char *field) {
    const int type = wh_reader_push(reader, field);
    if (type == LUA_TNIL) {
        lua_pop(reader->L, 1);
        return 0;
    }
    if (type != LUA_TFUNCTION) {
        wh_reader_fail(reader, field, "a function of a row");
    }
    map->has_functions = true;
    lua_insert(reader->L, -2); /* below the table being read */
    return lua_gettop(reader->L) - 1;
}

static size_t find_field(wh_reader_t *reader, const map_t *map, const char *column, const char *name) {
    const wh_rows_t *rows = &map->schedule->rows;
    char meant[WH_NEAREST_TEXT];
    size_t found = rows->count;
    for (size_t i = 0; i < rows->count; ++i) {
        if (strcmp(rows->fields[i], name) == 0 && found < rows->count) {
            wh_reader_refuse(reader, column, name, "a column that is there once in the first line of %s",
                             map->path);
        }
        found = strcmp(rows->fields[i], name) == 0 ? i : found;
    }
    if (found < rows->count) {
        return found;
    }
    wh_reader_refuse(
        reader, column, name, "a column of the first line of %s%s", map->path,
        wh_text_did_you_mean(meant, "; ", "",
                             wh_text_nearest(name, (const char *const *)rows->fields, rows->count)));
}

/* Reads { NAME, scale = FACTOR }, the table at the top of the stack. */
static void take_scaled(wh_reader_t *reader, const char *field, column_t *taken, char name[]) {
    (void)wh_reader_enter(reader, field);
    if (lua_rawgeti(reader->L, -1, 1) != LUA_TSTRING) {
        wh_reader_fail(reader, "[1]", "the name of a column");
    }
    (void)snprintf(name, WH_SCHEDULE_NAME + 1, "%s", lua_tostring(reader->L, -1));
    lua_pop(reader->L, 1);
    for (lua_pushnil(reader->L); lua_next(reader->L, -2) != 0; lua_pop(reader->L, 1)) {
        const bool is_name = lua_isinteger(reader->L, -2) && lua_tointeger(reader->L, -2) == 1;
        const bool is_scale =
            lua_type(reader->L, -2) == LUA_TSTRING && strcmp(lua_tostring(reader->L, -2), "scale") == 0;
        if (!is_name && !is_scale) {
            wh_reader_fail(reader, NULL, "{ NAME, scale = FACTOR }");
        }
    }
    taken->scale = wh_reader_number(reader, "scale", 1, 1e-12, 1e12);
    wh_reader_leave(reader);
}

/* The text at the top of the stack, or in its first entry, is the name of one of their columns. */
static void take_field(wh_reader_t *reader, map_t *map, size_t number) {
    const char *column = wh_schedule_columns[number];
    column_t *taken = &map->columns[number];
    char *name = map->theirs[number];
    if (lua_istable(reader->L, -1)) {
        lua_pop(reader->L, 1); /* the reader enters it by its name */
        take_scaled(reader, column, taken, name);
        lua_pushnil(reader->L);
    } else {
        (void)snprintf(name, sizeof map->theirs[0], "%s", lua_tostring(reader->L, -1));
    }
    taken->field = find_field(reader, map, column, name);
    taken->is_there = true;
    map->schedule->theirs[number] = name;
}

static void read_columns(wh_reader_t *reader, map_t *map) {
    if (!wh_reader_open(reader, "columns", column_fields)) {
        if (map->expand == 0) {
            wh_reader_refuse(reader, "columns", NULL, "a table, unless `expand` makes the rows");
        }
        return;
    }
    for (size_t i = 0; i < WH_SCHEDULE_COLUMNS; ++i) {
        const char *field = wh_schedule_columns[i];
        const int type = wh_reader_push(reader, field);
        if (type == LUA_TSTRING || type == LUA_TTABLE) {
            take_field(reader, map, i);
        } else if (type == LUA_TFUNCTION) {
            map->columns[i] = (column_t){.is_there = true, .is_function = true};
            map->has_functions = true;
        } else if (type != LUA_TNIL) {
            wh_reader_fail(reader, field, "a column's name, { NAME, scale = }, or a function of a row");
        }
        lua_pop(reader->L, 1);
    }
    wh_reader_leave(reader);
}

/* Functions of columns stay below the map's table, in their order. */
static void keep_functions(lua_State *L, map_t *map) {
    for (size_t i = 0; i < WH_SCHEDULE_COLUMNS; ++i) {
        if (map->columns[i].is_function) {
            lua_getfield(L, -1, "columns");
            lua_getfield(L, -1, wh_schedule_columns[i]);
            lua_remove(L, -2);
            lua_insert(L, -2);
            map->columns[i].index = lua_gettop(L) - 1;
        }
    }
}

/* The table of the map is on top of the stack. */
static void read_map(lua_State *L, map_t *map) {
    wh_reader_t reader;
    if (!lua_istable(L, -1)) {
        luaL_error(L, "%s: a table was expected: return { columns = { ... } }", map->map);
    }
    wh_reader_start(&reader, L, map->map);
    wh_reader_refuse_unknown(&reader, map_fields);
    map->skip = take_function(&reader, map, "skip");
    map->expand = take_function(&reader, map, "expand");
    if (wh_reader_push(&reader, "actions") == LUA_TTABLE) {
        lua_insert(L, -2);
        map->actions = lua_gettop(L) - 1;
    } else {
        if (!lua_isnil(L, -1)) {
            wh_reader_fail(&reader, "actions", "a table from their words to ours");
        }
        lua_pop(L, 1);
    }
    read_columns(&reader, map);
    keep_functions(L, map);
}

/* Leaves what the map's file returns on the stack. */
static void evaluate(lua_State *L, const map_t *map) {
    wh_sandbox_result_t result;
    if (!wh_sandbox_evaluate(L, map->map, &result)) {
        lua_pushstring(L, result.message);
        (void)lua_error(L);
    }
}

/* Runs protected, before the file is opened. */
static int read_separator(lua_State *L) {
    map_t *map = lua_touserdata(L, 1);
    wh_reader_t reader;
    evaluate(L, map);
    if (!lua_istable(L, -1)) {
        return luaL_error(L, "%s: a table was expected: return { columns = { ... } }", map->map);
    }
    wh_reader_start(&reader, L, map->map);
    if (wh_reader_push(&reader, "separator") == LUA_TSTRING && strchr("\t,;|", lua_tostring(L, -1)[0]) &&
        lua_rawlen(L, -1) == 1) {
        map->separator = lua_tostring(L, -1)[0];
    } else if (!lua_isnil(L, -1)) {
        wh_reader_fail(&reader, "separator", "\",\", \";\", \"|\" or \"\\t\"");
    }
    return 0;
}

/* -------------------------------------------------------------------------------------------------- a row */

/* The value at the top of the stack as a cell; it must stay on the stack while the cell is used. */
static void take_cell(lua_State *L, const map_t *map, size_t column, wh_schedule_cell_t *cell) {
    size_t length = 0;
    const int type = lua_type(L, -1);
    if (type == LUA_TNUMBER) {
        *cell = (wh_schedule_cell_t){.number = lua_tonumber(L, -1), .is_number = true};
    } else if (type == LUA_TSTRING) {
        *cell = (wh_schedule_cell_t){.text = lua_tolstring(L, -1, &length)};
    }
    if ((type != LUA_TNUMBER && type != LUA_TSTRING && type != LUA_TNIL) ||
        (cell->text && strlen(cell->text) != length)) {
        luaL_error(L, "%s: %s: a %s (expected text without a byte 0, a number or nil)", map->map,
                   wh_schedule_columns[column], luaL_typename(L, -1));
    }
}

/* Our word for theirs, if the map has one. It stays on the stack. */
static void translate_action(lua_State *L, const map_t *map, wh_schedule_cell_t *cell) {
    luaL_checkstack(L, 2, NULL);
    if (map->actions == 0 || !cell->text) {
        return;
    }
    lua_pushstring(L, cell->text);
    if (lua_rawget(L, map->actions) == LUA_TSTRING) {
        cell->text = lua_tostring(L, -1);
    }
}

/* A row's function reads a column that is not there, or there twice. */
static int refuse_column(lua_State *L, const map_t *map) {
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : luaL_typename(L, 2);
    char meant[WH_NEAREST_TEXT];
    const char **names = lua_newuserdatauv(L, (map->fields + 1) * sizeof *names, 0);
    for (size_t i = 0; i < map->fields; ++i) {
        lua_rawgeti(L, lua_upvalueindex(2), (lua_Integer)i + 1);
        names[i] = lua_tostring(L, -1);
        lua_pop(L, 1); /* the list keeps it */
        if (strcmp(names[i], name) == 0) {
            return luaL_error(L, "row.%s: this column is there twice", name);
        }
    }
    return luaL_error(L, "row.%s: no column of the first line of %s%s", name, map->path,
                      wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(name, names, map->fields)));
}

/* Upvalues of what rows have in common: the map, the names, the names' numbers. A row keeps its texts under
 * keys of the map's own, so that each reading by name comes here. */
static int read_field(lua_State *L) {
    const map_t *map = lua_touserdata(L, lua_upvalueindex(1));
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(3)) != LUA_TNUMBER) {
        return refuse_column(L, map);
    }
    const lua_Integer i = lua_tointeger(L, -1);
    map->used[i] = true;
    (void)lua_rawgetp(L, 1, &map->used[i]);
    return 1;
}

static int next_field(lua_State *L) {
    lua_settop(L, 2);
    return lua_next(L, 1) != 0 ? 2 : 0;
}

/* pairs(row): over its names and texts, all of which are read so. */
static int read_all(lua_State *L) {
    const map_t *map = lua_touserdata(L, lua_upvalueindex(1));
    lua_pushcfunction(L, next_field);
    lua_createtable(L, 0, (int)map->fields);
    for (size_t i = 0; i < map->fields; ++i) {
        if (!map->doubled[i]) {
            map->used[i] = true;
            lua_rawgeti(L, lua_upvalueindex(2), (lua_Integer)i + 1);
            (void)lua_rawgetp(L, 1, &map->used[i]);
            lua_rawset(L, -3);
        }
    }
    lua_pushnil(L);
    return 3;
}

static void make_common(lua_State *L, map_t *map, int numbers) {
    lua_createtable(L, 0, 2);
    map->common = lua_gettop(L);
    lua_pushlightuserdata(L, map);
    lua_pushvalue(L, map->names);
    lua_pushvalue(L, numbers);
    lua_pushcclosure(L, read_field, 3);
    lua_setfield(L, map->common, "__index");
    lua_pushlightuserdata(L, map);
    lua_pushvalue(L, map->names);
    lua_pushcclosure(L, read_all, 2);
    lua_setfield(L, map->common, "__pairs");
}

/* The list of the columns' names, and what rows have in common, at map->names and map->common. */
static void make_names(lua_State *L, map_t *map) {
    const wh_rows_t *rows = &map->schedule->rows;
    map->fields = rows->count;
    map->doubled = lua_newuserdatauv(L, map->fields + 1, 0);
    map->used = lua_newuserdatauv(L, map->fields + 1, 0);
    lua_createtable(L, (int)map->fields, 0);
    map->names = lua_gettop(L);
    lua_createtable(L, 0, (int)map->fields);
    for (size_t i = 0; i < map->fields; ++i) {
        map->doubled[i] = map->used[i] = false;
        for (size_t k = 0; k < map->fields; ++k) {
            map->doubled[i] = map->doubled[i] || (k != i && strcmp(rows->fields[k], rows->fields[i]) == 0);
        }
        lua_pushstring(L, rows->fields[i]);
        lua_pushvalue(L, -1);
        lua_rawseti(L, map->names, (lua_Integer)i + 1);
        if (map->doubled[i]) {
            lua_pop(L, 1);
        } else {
            lua_pushinteger(L, (lua_Integer)i);
            lua_rawset(L, map->names + 1);
        }
    }
    make_common(L, map, map->names + 1);
    for (size_t i = 0; i < WH_SCHEDULE_COLUMNS && map->expand == 0; ++i) {
        if (map->columns[i].is_there && !map->columns[i].is_function) {
            map->used[map->columns[i].field] = true;
        }
    }
}

/* Columns of the file that the map has not read, and those of which no row needs what it has read. */
static void note_unused(lua_State *L, const map_t *map) {
    for (size_t i = 0; i < map->fields; ++i) {
        if (!map->used[i]) {
            lua_rawgeti(L, map->names, (lua_Integer)i + 1);
            const char *name = lua_tostring(L, -1);
            (void)wh_schedule_name(&map->schedule->schedule->unused, name[0] != '\0' ? name : "(no name)");
            lua_pop(L, 1);
        }
    }
    wh_schedule_note_unused(map->schedule);
}

/* The file's row, at map->row. A column that is there twice is left out. */
static void make_row(lua_State *L, const map_t *map) {
    const wh_rows_t *rows = &map->schedule->rows;
    lua_createtable(L, 0, (int)map->fields);
    for (size_t i = 0; i < map->fields; ++i) {
        if (!map->doubled[i]) {
            lua_pushstring(L, rows->fields[i]);
            lua_rawsetp(L, -2, &map->used[i]);
        }
    }
    lua_pushvalue(L, map->common);
    lua_setmetatable(L, -2);
    lua_replace(L, map->row);
}

static void call_row(lua_State *L, const map_t *map, int function) {
    lua_pushvalue(L, function);
    lua_pushvalue(L, map->row);
    lua_call(L, 1, 1);
}

static void add_cells(lua_State *L, map_t *map) {
    wh_schedule_cell_t cells[WH_SCHEDULE_COLUMNS] = {{NULL, 0, false, 0}};
    for (size_t i = 0; i < WH_SCHEDULE_COLUMNS; ++i) {
        const column_t *column = &map->columns[i];
        if (column->is_function) {
            call_row(L, map, column->index);
            take_cell(L, map, i, &cells[i]);
        } else if (column->is_there) {
            cells[i] = (wh_schedule_cell_t){.text = map->schedule->rows.fields[column->field],
                                            .scale = column->scale};
        }
    }
    translate_action(L, map, &cells[WH_SCHEDULE_ACTION]);
    map->is_refused = !wh_schedule_add(map->schedule, cells);
}

/* One of the rows that `expand` has returned, at the top of the stack. */
static void add_expanded(lua_State *L, map_t *map) {
    wh_schedule_cell_t cells[WH_SCHEDULE_COLUMNS] = {{NULL, 0, false, 0}};
    wh_reader_t reader;
    const int table = lua_gettop(L);
    if (!lua_istable(L, table)) {
        luaL_error(L, "%s: expand: a %s (expected a list of rows)", map->map, luaL_typename(L, table));
    }
    wh_reader_start(&reader, L, map->map);
    wh_reader_refuse_unknown(&reader, column_fields);
    for (size_t i = 0; i < WH_SCHEDULE_COLUMNS; ++i) {
        lua_pushstring(L, wh_schedule_columns[i]);
        lua_rawget(L, table);
        take_cell(L, map, i, &cells[i]);
    }
    translate_action(L, map, &cells[WH_SCHEDULE_ACTION]);
    map->is_refused = !wh_schedule_add(map->schedule, cells);
}

static void expand_row(lua_State *L, map_t *map) {
    call_row(L, map, map->expand);
    const int list = lua_gettop(L);
    if (!lua_istable(L, list)) {
        luaL_error(L, "%s: expand: a %s (expected a list of rows)", map->map, luaL_typename(L, list));
    }
    const lua_Integer count = (lua_Integer)lua_rawlen(L, list);
    lua_pushnil(L);
    if (count == 0 && lua_next(L, list) != 0) { /* one row, say, in place of a list of them */
        luaL_error(L, "%s: expand: a table with names (expected a list of rows, { row })", map->map);
    }
    lua_settop(L, list);
    for (lua_Integer i = 1; i <= count && !map->is_refused; ++i) {
        lua_rawgeti(L, list, i);
        add_expanded(L, map);
        lua_settop(L, list);
    }
}

/* Runs protected; the file is open, and its first line is read. */
static int read_rows(lua_State *L) {
    map_t *map = lua_touserdata(L, 1);
    luaL_checkstack(L, 64, NULL);
    evaluate(L, map);
    read_map(L, map);
    make_names(L, map);
    lua_pushnil(L);
    map->row = lua_gettop(L);
    while (!map->is_refused && wh_schedule_next(map->schedule, map->fields)) {
        wh_sandbox_charge(L, map->fields);
        if (map->has_functions) {
            make_row(L, map);
        }
        if (map->skip != 0) {
            call_row(L, map, map->skip);
        }
        const bool is_skipped = map->skip != 0 && lua_toboolean(L, -1);
        lua_settop(L, map->row);
        if (!is_skipped && map->expand != 0) {
            expand_row(L, map);
        } else if (!is_skipped) {
            add_cells(L, map);
        }
        lua_settop(L, map->row);
    }
    note_unused(L, map);
    return 0;
}

/* -------------------------------------------------------------------------------------------------- whole */

/* An error of the map while it reads a row is told with that row. */
static void tell_error(const map_t *map, const wh_sandbox_result_t *result, char message[1600]) {
    if (map->row != 0) {
        (void)snprintf(message, 1600, "%.300s:%zu: %s", map->path, map->schedule->rows.line, result->message);
    } else {
        (void)snprintf(message, 1600, "%s", result->message);
    }
}

static bool read_by(wh_sandbox_t *sandbox, map_t *map, wh_schedule_t *schedule, char message[1600]) {
    wh_sandbox_result_t result;
    lua_State *L = wh_sandbox_state(sandbox);
    wh_schedule_reader_t *reader = map->schedule;
    if (!wh_sandbox_protect(L, read_separator, map, &result)) {
        tell_error(map, &result, message);
        return false;
    }
    const bool opened = wh_schedule_open(reader, schedule, map->path, map->separator);
    if (opened && !wh_sandbox_protect(L, read_rows, map, &result)) {
        tell_error(map, &result, message);
        return false;
    }
    if (opened && reader->message[0] == '\0' && schedule->count == 0) {
        (void)snprintf(message, 1600, "%.300s: by %.300s it has no rows", map->path, map->map);
        return false;
    }
    (void)snprintf(message, 1600, "%s", reader->message);
    return message[0] == '\0';
}

bool wh_schedule_read_mapped(wh_schedule_t *schedule, const char *path, const char *map_path,
                             const wh_sandbox_limits_t *limits, char message[1600]) {
    wh_schedule_reader_t reader = {.schedule = schedule};
    map_t map = {.schedule = &reader, .map = map_path, .path = path};
    wh_sandbox_t *sandbox = wh_sandbox_new(limits);
    if (!sandbox) {
        (void)snprintf(message, 1600, "%.300s: not enough memory", map_path);
        return false;
    }
    const bool read = read_by(sandbox, &map, schedule, message);
    if (read) {
        wh_schedule_finish(schedule);
    }
    wh_rows_close(&reader.rows);
    wh_sandbox_free(sandbox);
    return read;
}
