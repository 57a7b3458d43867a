/* wh.cell: a grasp table as a userdata, and its methods. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "wh_module_values.h"

/* ------------------------------------------------------------------------------------------ configuration */

static wh_check_t read_check(lua_State *L, const wh_field_t *of) {
    const wh_field_t at = wh_lua_field(of, "check");
    const int type = lua_getfield(L, 1, "check");
    const char *name = type == LUA_TSTRING ? wh_lua_word(L, -1) : "sampled";
    const bool swept = strcmp(name, "swept") == 0;
    if (type != LUA_TNIL && type != LUA_TSTRING) {
        wh_lua_refuse(L, &at, "string expected, got %s", luaL_typename(L, -1));
    }
    if (!swept && strcmp(name, "sampled") != 0) {
        wh_lua_refuse(L, &at, "\"%s\" (expected \"sampled\" or \"swept\")", wh_lua_whole_text(L, -1));
    }
    lua_pop(L, 1);
    return swept ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED;
}

static bool read_seat(lua_State *L, const wh_field_t *of, bool otherwise) {
    const wh_field_t at = wh_lua_field(of, "seat");
    const int type = lua_getfield(L, 1, "seat");
    const bool seat = type == LUA_TNIL ? otherwise : lua_toboolean(L, -1);
    if (type != LUA_TNIL && type != LUA_TBOOLEAN) {
        wh_lua_refuse(L, &at, "boolean expected, got %s", luaL_typename(L, -1));
    }
    lua_pop(L, 1);
    return seat;
}

static wh_grasp_config_t read_config(lua_State *L, const wh_field_t *of) {
    const wh_field_t tolerance = wh_lua_field(of, "tolerance");
    wh_grasp_config_t config = wh_grasp_config_default();
    lua_getfield(L, 1, "tolerance");
    config.tolerance = wh_lua_take_tolerance(L, &tolerance);
    config.check = read_check(L, of);
    config.seat = read_seat(L, of, config.seat);
    config.near_projz = wh_lua_get_number(L, 1, of, "near_projz", config.near_projz);
    config.near_projxy = wh_lua_get_number(L, 1, of, "near_projxy", 2 * config.tolerance.projxy);
    return config;
}

/* -------------------------------------------------------------------------------------------------- cells */

#define CELL_TYPE "wh.cell"

/* A cell has at most this many wafers. */
#define CELL_WAFERS 1000000

/* One userdata. It holds pointers into itself, and Lua never moves a userdata. */
typedef struct {
    wh_grasp_t table;
    uint64_t unread; /* calls of step and place whose arguments were refused before the table saw them */
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_wafer_t wafers[];
} cell_t;

/* The cell of a method that takes this number of arguments, including the cell. */
static cell_t *take_cell(lua_State *L, int arguments) {
    cell_t *cell = luaL_checkudata(L, 1, CELL_TYPE);
    wh_lua_take_at_most(L, arguments);
    return cell;
}

static size_t read_gripper_count(lua_State *L, const wh_field_t *of) {
    const wh_field_t at = wh_lua_field(of, "grippers");
    lua_getfield(L, 1, "grippers");
    return wh_lua_take_index(L, &at, WH_GRIPPERS) + 1;
}

/* Leaves the list of wafers on the stack. */
static size_t push_wafers(lua_State *L, const wh_field_t *at) {
    if (lua_getfield(L, 1, "wafers") != LUA_TTABLE) {
        wh_lua_refuse(L, at, "table expected, got %s", luaL_typename(L, -1));
    }
    const lua_Integer count = luaL_len(L, -1);
    if (count < 0 || count > CELL_WAFERS) {
        wh_lua_refuse(L, at, "%I entries (expected 0 to %d)", (LUAI_UACINT)count, CELL_WAFERS);
    }
    wh_lua_check_list(L, lua_gettop(L), at, count);
    return (size_t)count;
}

/* The new userdata is on top of the stack, the list of wafers below it. */
static void read_wafers(lua_State *L, const wh_field_t *at, cell_t *cell, size_t count) {
    const int list = lua_gettop(L) - 1;
    for (size_t i = 0; i < count; ++i) {
        const wh_field_t entry = wh_lua_entry(at, (lua_Integer)i + 1);
        lua_geti(L, list, entry.index);
        wh_lua_take_valid_pose(L, &entry, &cell->wafers[i].base_from_wafer);
    }
}

/* Tolerance and wafers have been checked: only the neighbourhood can still be refused. */
static void init_cell(lua_State *L, const wh_field_t *at, cell_t *cell, const wh_grasp_config_t *config,
                      const wh_grasp_storage_t *storage) {
    cell->unread = 0;
    const wh_status_t status = wh_grasp_init(&cell->table, config, storage);
    if (status != WH_OK) {
        wh_lua_refuse(L, at, "near_projz %f, near_projxy %f (expected both in (0, 1e6]): %s [%d]",
                      config->near_projz, config->near_projxy, wh_status_text(status), (int)status);
    }
}

int wh_lua_cell(lua_State *L) {
    static const char *const names[] = {"grippers", "wafers",     "tolerance",   "check",
                                        "seat",     "near_projz", "near_projxy", NULL};
    const wh_field_t argument = wh_lua_argument("", 1);
    const wh_field_t wafers = wh_lua_field(&argument, "wafers");
    wh_lua_take_at_most(L, 1);
    wh_lua_check_record(L, 1, &argument, names);
    const wh_grasp_config_t config = read_config(L, &argument);
    wh_grasp_storage_t storage = {.gripper_count = read_gripper_count(L, &argument)};
    storage.wafer_count = push_wafers(L, &wafers);
    storage.bucket_count = wh_grasp_buckets(storage.wafer_count, storage.gripper_count);
    cell_t *cell = lua_newuserdatauv(L,
                                     sizeof *cell + storage.wafer_count * sizeof cell->wafers[0] +
                                         storage.bucket_count * sizeof storage.buckets[0],
                                     0);
    read_wafers(L, &wafers, cell, storage.wafer_count);
    storage.wafers = cell->wafers;
    storage.grippers = cell->grippers;
    storage.buckets = (uint32_t *)(cell->wafers + storage.wafer_count);
    init_cell(L, &argument, cell, &config, &storage);
    luaL_setmetatable(L, CELL_TYPE);
    return 1;
}

static void take_input(lua_State *L, const wh_field_t *at, wh_gripper_input_t *input) {
    static const char *const names[] = {"pose", "valve", NULL};
    const wh_field_t pose = wh_lua_field(at, "pose");
    const wh_field_t valve = wh_lua_field(at, "valve");
    const int table = lua_gettop(L);
    wh_lua_check_record(L, table, at, names);
    lua_getfield(L, table, "pose");
    wh_lua_take_pose(L, &pose, &input->base_from_gripper);
    lua_getfield(L, table, "valve");
    input->valve =
        (int32_t)wh_lua_take_integer(L, &valve, WH_VALVE_OPEN, WH_VALVE_CLOSED, "0, open, or 1, closed");
    lua_pop(L, 1);
}

static void push_events(lua_State *L, const wh_event_list_t *list) {
    lua_createtable(L, (int)list->count, 0);
    for (size_t i = 0; i < list->count; ++i) {
        wh_lua_push_event(L, &list->events[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* Inputs and events are locals, because an __index among the inputs may step this very cell while they are
 * read. */
static int cell_step(lua_State *L) {
    cell_t *cell = take_cell(L, 2);
    const wh_field_t at = wh_lua_argument("inputs", 2);
    const size_t count = cell->table.storage.gripper_count;
    wh_gripper_input_t inputs[WH_GRIPPERS];
    wh_event_t events[WH_GRIPPERS * WH_EVENTS_PER_GRIPPER];
    wh_event_list_t list = {events, sizeof events / sizeof events[0], 0};
    ++cell->unread;
    wh_lua_check_list(L, 2, &at, (lua_Integer)count);
    for (size_t i = 0; i < count; ++i) {
        const wh_field_t entry = wh_lua_entry(&at, (lua_Integer)i + 1);
        lua_geti(L, 2, entry.index);
        take_input(L, &entry, &inputs[i]);
    }
    --cell->unread;
    const wh_status_t status = wh_grasp_step(&cell->table, inputs, &list);
    if (status != WH_OK) {
        const wh_field_t entry = wh_lua_entry(&at, (lua_Integer)list.events[0].gripper + 1);
        const wh_field_t pose = wh_lua_field(&entry, "pose");
        return wh_lua_refuse_pose(L, &pose, &inputs[list.events[0].gripper].base_from_gripper, status);
    }
    push_events(L, &list);
    return 1;
}

static int cell_wafer(lua_State *L) {
    cell_t *cell = take_cell(L, 2);
    const wh_field_t at = wh_lua_argument("wafer", 2);
    wh_pose_t pose;
    int32_t holder;
    const size_t wafer = wh_lua_take_index(L, &at, cell->table.storage.wafer_count);
    wh_grasp_wafer(&cell->table, wafer, &pose, &holder);
    wh_lua_push_pose(L, &pose);
    wh_lua_push_index(L, holder);
    return 2;
}

static int cell_held(lua_State *L) {
    cell_t *cell = take_cell(L, 2);
    const wh_field_t at = wh_lua_argument("gripper", 2);
    int32_t wafer;
    const size_t gripper = wh_lua_take_index(L, &at, cell->table.storage.gripper_count);
    wh_grasp_held(&cell->table, gripper, &wafer);
    wh_lua_push_index(L, wafer);
    return 1;
}

static int cell_place(lua_State *L) {
    cell_t *cell = take_cell(L, 3);
    const wh_field_t wafer_at = wh_lua_argument("wafer", 2);
    const wh_field_t pose_at = wh_lua_argument("pose", 3);
    wh_pose_t pose;
    ++cell->unread;
    wh_lua_take_pose(L, &pose_at, &pose);
    const size_t wafer = wh_lua_take_index(L, &wafer_at, cell->table.storage.wafer_count);
    --cell->unread;
    const wh_status_t status = wh_grasp_place(&cell->table, wafer, &pose);
    if (status == WH_STATUS_HELD) {
        return wh_lua_refuse(L, &wafer_at, "%I (%s) [%d]", (LUAI_UACINT)wafer + 1, wh_status_text(status),
                             (int)status);
    }
    return status == WH_OK ? 0 : wh_lua_refuse_pose(L, &pose_at, &pose, status);
}

static int cell_hash(lua_State *L) {
    const cell_t *cell = take_cell(L, 1);
    char digits[17];
    snprintf(digits, sizeof digits, "%016" PRIx64, wh_grasp_hash(&cell->table));
    lua_pushstring(L, digits);
    return 1;
}

static int cell_counters(lua_State *L) {
    const cell_t *cell = take_cell(L, 1);
    const wh_grasp_counters_t *of = &cell->table.counters;
    const struct {
        const char *name;
        uint64_t value;
    } counters[] = {{"slices", cell->table.slice},    {"refused", of->refused + cell->unread},
                    {"picked", of->picked},           {"released", of->released},
                    {"handed_over", of->handed_over}, {"near_misses", of->near_misses},
                    {"contested", of->contested}};
    lua_newtable(L);
    for (size_t i = 0; i < sizeof counters / sizeof counters[0]; ++i) {
        wh_lua_set_integer(L, counters[i].name, (int64_t)counters[i].value);
    }
    return 1;
}

/* __metatable prevents a script from changing the methods of all cells. */
void wh_lua_open_cell(lua_State *L) {
    static const luaL_Reg methods[] = {
        {"step", cell_step}, {"wafer", cell_wafer},       {"held", cell_held}, {"place", cell_place},
        {"hash", cell_hash}, {"counters", cell_counters}, {NULL, NULL}};
    luaL_newmetatable(L, CELL_TYPE);
    luaL_newlib(L, methods);
    lua_setfield(L, -2, "__index");
    wh_lua_set_text(L, "__metatable", CELL_TYPE);
    lua_pop(L, 1);
}
