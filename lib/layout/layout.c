#include "layout.h"

#include <lauxlib.h>
#include <string.h>

#include "layout_internal.h"

/* The registry's list of all memory of layouts. It is never cleared, for a record may outlive a second
 * `cell`. */
static char owned_key;

void *wh_layout_memory(lua_State *L, size_t count, size_t size) {
    const size_t bytes = (count > 0 ? count : 1) * size;
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &owned_key) != LUA_TTABLE) {
        lua_pop(L, 1);
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &owned_key);
    }
    void *memory = lua_newuserdatauv(L, bytes, 0);
    memset(memory, 0, bytes);
    lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
    lua_pop(L, 1);
    return memory;
}

static char *copy_text(lua_State *L, const char *text) {
    const size_t size = strlen(text) + 1;
    char *copy = wh_layout_memory(L, size, 1);
    memcpy(copy, text, size);
    return copy;
}

/* The order matters: limits of later fields depend on earlier ones. Strokes are checked against the slice,
 * grippers name stations, wafers lie in them, and shapes follow the wafer's size. */
wh_layout_t *wh_layout_read(lua_State *L, const char *path) {
    wh_reader_t reader;
    wh_layout_t *layout = wh_layout_memory(L, 1, sizeof *layout);
    layout->path = copy_text(L, path);
    wh_reader_start(&reader, L, layout->path);
    if (!lua_istable(L, -1)) {
        wh_reader_fail(&reader, "what the file returns", "a table");
    }
    wh_reader_refuse_unknown(&reader,
                             "wafer tolerance near check slice seat settle placing collision "
                             "look_ahead robot homed chuck grippers stations wafers shapes obstacles "
                             "clearance vacuum pads faults study");
    wh_layout_read_checks(&reader, layout);
    wh_layout_read_physics(&reader, layout);
    wh_layout_read_robot(&reader, layout);
    wh_layout_read_stations(&reader, layout);
    wh_layout_read_grippers(&reader, layout);
    wh_layout_read_effectors(&reader, layout);
    wh_layout_read_wafers(&reader, layout);
    wh_layout_read_shapes(&reader, layout);
    wh_layout_read_world(&reader, layout);
    wh_layout_read_faults(&reader, layout);
    wh_layout_read_study(&reader, layout);
    return layout;
}

void wh_layout_place(wh_layout_t *layout) {
    layout->cell.stations = layout->places;
    layout->cell.count = layout->station_count;
    layout->cell.tolerance = layout->grasp.tolerance;
}

void wh_layout_read_trial_world(lua_State *L, wh_layout_t *trial_cell) {
    wh_reader_t reader;
    wh_reader_start(&reader, L, trial_cell->path);
    wh_layout_read_world(&reader, trial_cell);
}

void wh_layout_read_own_study(lua_State *L, const char *path, wh_layout_t *layout) {
    wh_reader_t reader;
    lua_createtable(L, 0, 1);
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, "study");
    wh_reader_start(&reader, L, path);
    wh_layout_read_study(&reader, layout);
    lua_pop(L, 1);
}

/* The index of the item with that name; each of them begins with its name. WH_NONE if there is none. */
static int32_t find(const void *items, size_t count, size_t size, const char *name) {
    for (size_t i = 0; i < count; ++i) {
        if (strcmp((const char *)items + i * size, name) == 0) {
            return (int32_t)i;
        }
    }
    return WH_NONE;
}

int32_t wh_layout_find_station(const wh_layout_t *layout, const char *name) {
    return find(layout->stations, layout->station_count, sizeof *layout->stations, name);
}

int32_t wh_layout_find_gripper(const wh_layout_t *layout, const char *name) {
    return find(layout->grippers, layout->machine.gripper_count, sizeof layout->grippers[0], name);
}

int32_t wh_layout_find_wafer(const wh_layout_t *layout, const char *name) {
    return find(layout->wafers, layout->wafer_count, sizeof *layout->wafers, name);
}

typedef struct {
    const char *path;
    const wh_layout_t *layout;
} load_t;

/* Runs protected; the argument is a load_t. */
static int load(lua_State *L) {
    load_t *job = lua_touserdata(L, 1);
    wh_sandbox_result_t result;
    if (!wh_sandbox_evaluate(L, job->path, &result)) {
        lua_pushstring(L, result.message);
        return lua_error(L);
    }
    job->layout = wh_layout_read(L, job->path);
    return 0;
}

const wh_layout_t *wh_layout_load(wh_sandbox_t *sandbox, const char *path, wh_sandbox_result_t *result) {
    load_t job = {path, NULL};
    return wh_sandbox_protect(wh_sandbox_state(sandbox), load, &job, result) ? job.layout : NULL;
}
