/* The cell: finds its layout, reads it, and starts a simulator in this process. */
#include <stddef.h>
#include <string.h>

#include "../layout/doors.h"
#include "../layout/faster.h"
#include "../layout/layout_fields.h"
#include "../layout/reach.h"
#include "../reading/layout_read.h"
#include "../script/wh_module_values.h"
#include "../text/output.h"
#include "../trial/given.h"
#include "carrying.h"
#include "clocks.h"
#include "counted.h"
#include "native.h"

/* Shortens "lua/examples/../layouts" to "lua/layouts", if that is the same file: a symbolic link may make it
 * another. */
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
    return wh_output_is_one_file(path, lua_tostring(L, -1)) ? lua_tostring(L, -1) : lua_pushstring(L, path);
}

const char *wh_mcs_push_path(lua_State *L, const wh_mcs_t *mcs, const char *name) {
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

/* The cell that a trial draws for the layout whose table is on top of the stack. */
static const wh_layout_t *make_reality(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
    if (!mcs->wanted.trial || !layout->errors) {
        return layout;
    }
    wh_trial_cell_t *trial_cell = lua_memory(L, sizeof *trial_cell);
    const wh_trial_room_t room = {lua_memory(L, layout->station_count * sizeof *room.places),
                                  lua_memory(L, layout->wafer_count * sizeof *room.start),
                                  lua_memory(L, layout->wafer_count * sizeof *room.rims),
                                  lua_memory(L, layout->wafer_count * sizeof(const wh_rim_t *)),
                                  lua_memory(L, layout->wafer_count * sizeof *room.edge_wafers),
                                  lua_memory(L, wh_layout_count_supports(layout) * sizeof *room.supports)};
    wh_trial_cell_fill(trial_cell, layout, mcs->wanted.trial, &room);
    if (layout->collision) {
        wh_layout_read_trial_world(L, &trial_cell->layout);
    }
    mcs->local.trial = trial_cell;
    return &trial_cell->layout;
}

/* Delays the valves, before the simulator that the local cell begins with. */
static wh_status_t exchange_late(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    wh_local_cell_t *local = (wh_local_cell_t *)(void *)link;
    wh_command_t late = *command;
    wh_trial_cell_delay(local->trial, &late);
    return wh_simulator_step(&local->simulator, &late, state);
}

static wh_status_t set_up_simulator(lua_State *L, wh_local_cell_t *local, const wh_layout_t *real) {
    wh_simulator_t *simulator = &local->simulator;
    const size_t bytes = real->wafer_count * sizeof(wh_wafer_t);
    wh_grasp_storage_t storage = {.wafer_count = real->wafer_count,
                                  .gripper_count = real->machine.gripper_count};
    storage.wafers = lua_memory(L, bytes);
    storage.grippers = lua_memory(L, storage.gripper_count * sizeof(wh_gripper_t));
    storage.bucket_count = wh_layout_buckets(real);
    storage.buckets = lua_memory(L, storage.bucket_count * sizeof(uint32_t));
    if (bytes > 0) {
        memcpy(storage.wafers, real->start, bytes);
    }
    const wh_scanning_t scanning = wh_layout_scanning(real);
    const wh_latching_t latching = wh_layout_latching(real);
    wh_status_t status = wh_simulator_init(simulator, &real->grasp, &storage, &real->cell);
    status = status == WH_OK ? wh_simulator_set_physics(simulator, &real->physics) : status;
    status = status == WH_OK ? wh_simulator_set_scanning(simulator, &scanning) : status;
    status = status == WH_OK ? wh_simulator_set_latching(simulator, &latching) : status;
    status = status == WH_OK ? wh_layout_give_doors(real, simulator) : status;
    local->grips.seen = lua_memory(L, wh_layout_seen(real) * sizeof(wh_wafer_t));
    return status == WH_OK ? wh_layout_give_grips(real, simulator, &local->grips) : status;
}

static void set_up_local(lua_State *L, wh_local_cell_t *local, const wh_layout_t *real) {
    const wh_status_t status = set_up_simulator(L, local, real);
    if (status != WH_OK) {
        luaL_error(L, "%s: %s", real->path, wh_record_error_text(status));
    }
    if (real->collision) {
        wh_collision_attach(&local->collision, real, &local->simulator,
                            lua_memory(L, wh_collision_bytes(real)));
        local->collision.is_told = !local->trial;
    }
    if (local->trial) {
        local->simulator.link.exchange = exchange_late;
    }
}

static void hear_nominal(void *user, const wh_command_t *command, const wh_state_t *state) {
    if (state->status == WH_OK) {
        wh_nominal_slice(user, command);
    }
}

static void set_up_look_ahead(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout,
                              const wh_layout_t *real) {
    wh_nominal_t *nominal = NULL;
    if (!layout->look_ahead || mcs->rehearsal.look_ahead) {
        return;
    }
    if (real != layout) {
        nominal = wh_nominal_begin(lua_memory(L, wh_nominal_bytes(layout)), layout, real);
        wh_mcs_listen(mcs, hear_nominal, nominal);
    }
    wh_rehearsal_look_ahead(&mcs->rehearsal, layout, nominal,
                            lua_memory(L, wh_rehearsal_ahead_bytes(layout)));
}

static void hear_decisions(void *user, const wh_command_t *command, const wh_state_t *state) {
    (void)state;
    wh_decisions_slice(user, command);
}

static void hear_record(void *user, const wh_command_t *command, const wh_state_t *state) {
    wh_recorder_events(user, state);
    if (state->status == WH_OK) {
        wh_recorder_slice(user, command, state);
    }
}

static void hear_origins(void *user, const wh_command_t *command, const wh_state_t *state) {
    (void)command;
    if (state->status == WH_OK) {
        wh_origins_hear(user, state);
    }
}

static void set_up_listeners(wh_mcs_t *mcs) {
    mcs->recorder.layout = mcs->layout;
    mcs->recorder.cell = &mcs->real->cell;
    wh_mcs_listen(mcs, hear_record, &mcs->recorder);
    wh_mcs_listen(mcs, hear_origins, &mcs->heard.origins);
    wh_mcs_listen(mcs, wh_mcs_hear_valves, mcs->heard.valves);
    if (mcs->layout->scanner_count + mcs->layout->beam_count > 0) {
        wh_mcs_listen(mcs, wh_mcs_hear_slice, mcs);
    }
    if (mcs->wanted.decisions) {
        wh_mcs_listen(mcs, hear_decisions, mcs->wanted.decisions);
    }
    if (mcs->wanted.listener.slice) {
        wh_mcs_listen(mcs, mcs->wanted.listener.slice, mcs->wanted.listener.user);
    }
}

static void set_up_run(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
    const wh_layout_t *real = make_reality(L, mcs, layout);
    set_up_local(L, &mcs->local, real);
    const wh_status_t status = wh_track_init(&mcs->track, &real->machine, layout->slice_us);
    if (status != WH_OK) {
        luaL_error(L, "%s: %s", layout->path, wh_record_error_text(status));
    }
    wh_track_take_ways(&mcs->track);
    wh_track_take_vias(&mcs->track);
    wh_carrying_start(&mcs->track, layout);
    set_up_look_ahead(L, mcs, layout, real);
    wh_simulator_view(&mcs->local.simulator, &mcs->state);
    wh_origins_begin(&mcs->heard.origins, layout, lua_memory(L, layout->wafer_count * sizeof(wh_pose_t)),
                     &mcs->state);
    mcs->layout = layout;
    mcs->real = real;
    set_up_listeners(mcs);
    wh_mcs_start_faults(mcs);
}

void wh_mcs_set_up(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
    set_up_run(L, mcs, layout);
    wh_mcs_push_layout(L, layout);
}

/* -------------------------------------------------------------------------------------------------- words */

/* Registry key of the script's own study. */
static const char study_key;

/* native.study(description): replaces the layout's study. */
static int set_study(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_of(L);
    luaL_checktype(L, 1, LUA_TTABLE);
    if (mcs->layout) {
        lua_pushfstring(L, "study: %s was set up already (expected study before cell)", mcs->layout->path);
        return lua_error(L);
    }
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &study_key) != LUA_TNIL) {
        lua_pushliteral(L, "study: given twice (expected one study a script)");
        return lua_error(L);
    }
    lua_settop(L, 1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &study_key);
    return 0;
}

/* Leaves the result of the layout's file on the stack, or raises its error. */
static void evaluate_layout(lua_State *L, wh_mcs_t *mcs, const char *path) {
    wh_sandbox_result_t result;
    if (mcs->wanted.is_file && wh_output_is_one_file(path, mcs->script)) {
        lua_pushfstring(L, "cell: %s is this script (expected a layout)", path);
        (void)lua_error(L);
    }
    mcs->reads_layout = true;
    const bool evaluated = wh_sandbox_evaluate(L, path, &result);
    mcs->reads_layout = false;
    if (!evaluated) {
        lua_pushstring(L, result.message);
        (void)lua_error(L);
    }
}

/* An option does not go with this cell. */
static void refuse_unwanted(lua_State *L, const wh_mcs_t *mcs, const wh_layout_t *layout) {
    if (layout->tool && mcs->wanted.needs_axes) {
        (void)luaL_error(L, "%s: its robots are times alone (expected robots with axes for %s)", layout->path,
                         mcs->wanted.needs_axes);
    }
    if (layout->collision && !mcs->wanted.without_collisions && mcs->wanted.counts == WH_MCS_COUNT_STRICT) {
        (void)luaL_error(L,
                         "%s: collision = true (--counted does not look for collisions in slices that it "
                         "leaves out: expected a run without --strict, or without --counted)",
                         layout->path);
    }
}

/* Some of the cell takes less time than the layout says; a trial draws the processes of a tool of times
 * alone. */
static void change_times(const wh_mcs_t *mcs, wh_layout_t *layout) {
    for (size_t i = 0; i < mcs->wanted.faster_count; ++i) {
        wh_layout_hasten(layout, mcs->wanted.faster[i], mcs->wanted.faster_share);
    }
    if (layout->tool && layout->errors && mcs->wanted.trial) {
        wh_trial_draw_tool(layout, mcs->wanted.trial);
    }
}

/* native.cell(path): reads the layout and sets up the run; returns the layout as a table. */
static int set_up_cell(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    const char *name = wh_lua_word(L, 1);
    if (!name[0]) {
        lua_pushfstring(L, "cell: \"%s\" (expected a layout's path)", wh_lua_whole_text(L, 1));
        return lua_error(L);
    }
    if (mcs->layout) {
        lua_pushfstring(L, "cell: %s was set up already (expected one cell a script)", mcs->layout->path);
        return lua_error(L);
    }
    if (mcs->reads_layout) {
        lua_pushfstring(L, "cell: \"%s\", called while a layout is read (expected in a script alone)", name);
        return lua_error(L);
    }
    const char *path = wh_mcs_push_path(L, mcs, name);
    evaluate_layout(L, mcs, path);
    wh_layout_t *layout = wh_layout_read(L, path);
    refuse_unwanted(L, mcs, layout);
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &study_key) == LUA_TTABLE) {
        wh_layout_read_own_study(L, mcs->script, layout);
    }
    lua_pop(L, 1);
    if (mcs->wanted.error_count > 0) {
        wh_layout_give_errors(L, layout, mcs->wanted.errors, mcs->wanted.error_count);
    }
    layout->collision = layout->collision && !mcs->wanted.without_collisions;
    change_times(mcs, layout);
    set_up_run(L, mcs, layout);
    wh_mcs_begin_clocks(L, mcs);
    wh_mcs_begin_counting(L, mcs);
    wh_mcs_push_layout(L, layout);
    return 1;
}

/* native.unreached(station): the first slot to which the links of the robot that serves it do not reach, and
 * why; nothing if they reach all. */
static int find_unreached(lua_State *L) {
    const wh_layout_t *layout = wh_mcs_with_layout(L)->layout;
    const size_t station = (size_t)wh_mcs_index(L, 1, layout->station_count);
    for (size_t place = 0; place < WH_REACH_PLACES; ++place) {
        wh_unreached_t unreached;
        if (!wh_layout_reaches(layout, station, place, &unreached)) {
            lua_pushinteger(L, unreached.slot);
            lua_pushfstring(L, "%s%s", unreached.is_before ? "on the way in " : "", unreached.text);
            return 2;
        }
    }
    return 0;
}

/* Pushes { least, most, unit } of a number, { values } of an enumeration; false for any other field. */
static bool push_range(lua_State *L, const wh_reader_field_t *row) {
    char unit[WH_FIELD_UNIT_BYTES];
    if (wh_field_is_number(row)) {
        wh_field_unit(row, unit);
        wh_lua_push_numbers(L, (const wh_real_t[]){row->least, row->most}, 2);
        lua_pushstring(L, unit);
        lua_rawseti(L, -2, 3);
        return true;
    }
    if (row->kind == WH_SCALAR_WORD) {
        lua_createtable(L, 0, 1);
        lua_newtable(L);
        for (lua_Integer i = 0; row->words[i]; ++i) {
            lua_pushstring(L, row->words[i]);
            lua_rawseti(L, -2, i + 1);
        }
        lua_setfield(L, -2, "values");
        return true;
    }
    return false;
}

/* native.ranges(): the station parameters that a command may set, by name. */
static int list_ranges(lua_State *L) {
    lua_newtable(L);
    for (const wh_reader_field_t *row = wh_layout_station_fields; row->name; ++row) {
        if (push_range(L, row)) {
            lua_setfield(L, -2, row->name);
        }
    }
    return 1;
}

const luaL_Reg wh_mcs_cell_functions[] = {{"cell", set_up_cell},
                                          {"study", set_study},
                                          {"unreached", find_unreached},
                                          {"ranges", list_ranges},
                                          {NULL, NULL}};
