/* The MCS host's cell: finding its layout, and memory for what the layout describes. */
#include <stddef.h>
#include <string.h>
#include <sys/stat.h>

#include "ahead.h"
#include "mcs_internal.h"

static bool is_same_file(const char *a, const char *b) {
    struct stat one;
    struct stat two;
    return stat(a, &one) == 0 && stat(b, &two) == 0 && one.st_dev == two.st_dev && one.st_ino == two.st_ino;
}

/* "lua/examples/../layouts" reads better as "lua/layouts": if that is the same file, symbolic links considered. */
static const char *push_short_path(lua_State *L, const char *path) {
    const char *up = strstr(path, "/../");
    const char *start = up;
    while (start && start > path && start[-1] != '/') {
        --start;
    }
    if (!up || strncmp(start, "..", 2) == 0) {
        return lua_pushstring(L, path);
    }
    lua_pushlstring(L, path, (size_t)(start - path));
    lua_pushstring(L, up + 4);
    lua_concat(L, 2);
    return is_same_file(path, lua_tostring(L, -1)) ? lua_tostring(L, -1) : lua_pushstring(L, path);
}

/* The layout's path relative to the script's own folder. */
static const char *push_layout_path(lua_State *L, const wh_mcs_t *mcs, const char *name) {
    const char *slash = strrchr(mcs->script, '/');
    if (name[0] == '/' || !slash) {
        return lua_pushstring(L, name);
    }
    lua_pushlstring(L, mcs->script, (size_t)(slash - mcs->script) + 1);
    lua_pushstring(L, name);
    lua_concat(L, 2);
    return push_short_path(L, lua_tostring(L, -1));
}

static void *lua_memory(lua_State *L, size_t bytes) {
    void *memory = lua_newuserdatauv(L, bytes > 0 ? bytes : 1, 0);
    lua_rawsetp(L, LUA_REGISTRYINDEX, memory);
    return memory;
}

const wh_layout_t *wh_mcs_real(const wh_mcs_t *mcs) {
    return mcs->trial_cell ? &mcs->trial_cell->layout : mcs->layout;
}

/* What a trial draws for the layout whose table is on top of the stack. */
static const wh_layout_t *make_reality(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
    if (!mcs->trial || !layout->errors) {
        return layout;
    }
    wh_trial_cell_t *trial_cell = lua_memory(L, sizeof *trial_cell);
    wh_trial_cell_fill(trial_cell, layout, mcs->trial,
                       lua_memory(L, layout->station_count * sizeof *layout->places),
                       lua_memory(L, layout->wafer_count * sizeof *layout->start));
    if (layout->collision) {
        wh_layout_read_trial_world(L, &trial_cell->layout);
    }
    mcs->trial_cell = trial_cell;
    return &trial_cell->layout;
}

/* Valves act late: in front of the simulator, which is part of the MCS's host. */
static wh_status_t exchange_late(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    wh_simulator_t *simulator = (wh_simulator_t *)(void *)link;
    wh_mcs_t *mcs = (wh_mcs_t *)(void *)((char *)simulator - offsetof(wh_mcs_t, simulator));
    wh_command_t late = *command;
    wh_trial_cell_delay(mcs->trial_cell, &late);
    return wh_simulator_step(simulator, &late, state);
}

static void set_up(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
    const size_t bytes = layout->wafer_count * sizeof(wh_wafer_t);
    const wh_layout_t *real = make_reality(L, mcs, layout);
    wh_grasp_storage_t storage = {0};
    storage.wafers = lua_memory(L, bytes);
    storage.wafer_count = layout->wafer_count;
    storage.gripper_count = layout->machine.gripper_count;
    storage.grippers = lua_memory(L, storage.gripper_count * sizeof(wh_gripper_t));
    storage.bucket_count = wh_grasp_buckets(storage.wafer_count, storage.gripper_count);
    storage.buckets = lua_memory(L, storage.bucket_count * sizeof(uint32_t));
    if (bytes > 0) {
        memcpy(storage.wafers, real->start, bytes);
    }
    wh_status_t status = wh_simulator_init(&mcs->simulator, &layout->grasp, &storage, &real->cell);
    if (status == WH_OK) {
        status = wh_simulator_set_physics(&mcs->simulator, &real->physics);
    }
    if (status == WH_OK) {
        status = wh_track_init(&mcs->track, &real->machine, layout->slice_us);
    }
    if (status != WH_OK) {
        luaL_error(L, "%s: %s", layout->path, wh_status_text(status));
    }
    if (layout->collision) {
        wh_collision_attach(&mcs->collision, real, &mcs->simulator, lua_memory(L, wh_collision_bytes(real)));
    }
    if (layout->look_ahead && !mcs->ahead) {
        wh_ahead_t *ahead = lua_memory(L, sizeof *ahead);
        wh_ahead_init(ahead, layout, lua_memory(L, wh_ahead_bytes(layout)));
        mcs->ahead = wh_ahead_judge;
        mcs->ahead_user = ahead;
    }
    mcs->link = &mcs->simulator.link;
    if (mcs->trial_cell) {
        mcs->link->exchange = exchange_late;
    }
    wh_simulator_view(&mcs->simulator, &mcs->state);
    mcs->layout = layout;
    wh_mcs_start_faults(mcs);
}

/* Registry key of the script's own study. */
static const char study_key;

/* native.study(description): takes the place of the layout's. */
static int set_study(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_of(L);
    luaL_checktype(L, 1, LUA_TTABLE);
    if (mcs->layout) {
        return luaL_error(L, "study: %s was set up already (expected study before cell)", mcs->layout->path);
    }
    lua_settop(L, 1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &study_key);
    return 0;
}

/* native.cell(path): reads the layout and sets up the run; returns the layout as a table. */
static int set_up_cell(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    const char *name = luaL_checkstring(L, 1);
    wh_sandbox_result_t result;
    if (mcs->layout) {
        lua_pushfstring(L, "cell: %s was set up already (expected one cell a script)", mcs->layout->path);
        return lua_error(L);
    }
    const char *path = push_layout_path(L, mcs, name);
    if (!wh_sandbox_evaluate(L, path, &result)) {
        lua_pushstring(L, result.message);
        return lua_error(L);
    }
    wh_layout_t *layout = wh_layout_read(L, path);
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &study_key) == LUA_TTABLE) {
        wh_layout_read_own_study(L, mcs->script, layout);
    }
    lua_pop(L, 1);
    set_up(L, mcs, layout);
    wh_mcs_push_layout(L, layout);
    return 1;
}

const luaL_Reg wh_mcs_cell_functions[] = {{"cell", set_up_cell}, {"study", set_study}, {NULL, NULL}};
