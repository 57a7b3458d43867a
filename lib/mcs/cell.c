/* The cell: its layout is found, read and handed to Lua, and gets a simulator in this process. */
#include <stddef.h>
#include <string.h>

#include "../layout/axes.h"
#include "../layout/doors.h"
#include "../layout/given.h"
#include "../script/wh_module_values.h"
#include "../text/output.h"
#include "carrying.h"
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

/* The cell that a trial draws for the layout whose table is on top of the stack. */
static const wh_layout_t *make_reality(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
    if (!mcs->trial || !layout->errors) {
        return layout;
    }
    wh_trial_cell_t *trial_cell = lua_memory(L, sizeof *trial_cell);
    const wh_trial_room_t room = {lua_memory(L, layout->station_count * sizeof *room.places),
                                  lua_memory(L, layout->wafer_count * sizeof *room.start),
                                  lua_memory(L, layout->wafer_count * sizeof *room.rims),
                                  lua_memory(L, layout->wafer_count * sizeof(const wh_rim_t *)),
                                  lua_memory(L, layout->wafer_count * sizeof *room.edge_wafers),
                                  lua_memory(L, wh_layout_count_supports(layout) * sizeof *room.supports)};
    wh_trial_cell_fill(trial_cell, layout, mcs->trial, &room);
    if (layout->collision) {
        wh_layout_read_trial_world(L, &trial_cell->layout);
    }
    mcs->local.trial = trial_cell;
    return &trial_cell->layout;
}

/* Valves act late: in front of the simulator, with which the local cell begins. */
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

static void set_up_listeners(wh_mcs_t *mcs) {
    mcs->recorder.layout = mcs->layout;
    mcs->recorder.cell = &mcs->real->cell;
    wh_mcs_listen(mcs, hear_record, &mcs->recorder);
    if (mcs->layout->scanner_count + mcs->layout->beam_count > 0) {
        wh_mcs_listen(mcs, wh_mcs_hear_slice, mcs);
    }
    if (mcs->decisions) {
        wh_mcs_listen(mcs, hear_decisions, mcs->decisions);
    }
    if (mcs->listener.slice) {
        wh_mcs_listen(mcs, mcs->listener.slice, mcs->listener.user);
    }
}

static void set_up(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
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
    mcs->layout = layout;
    mcs->real = real;
    set_up_listeners(mcs);
    wh_mcs_start_faults(mcs);
}

/* ------------------------------------------------------------------------------------- the layout for Lua */

/* True if its slots are above one another to the last bit. */
static bool is_upright(const wh_station_t *place) {
    const wh_vec3_t up = wh_mat3_column(&place->base_from_station.R, 2);
    return !(wh_real_abs(up.x) > 0 || wh_real_abs(up.y) > 0);
}

/* robot: who serves it unless a command says otherwise, nil: a command must; by: of each robot the gripper
 * that serves it, or false. */
static void push_servers(lua_State *L, const wh_layout_t *layout, const wh_layout_station_t *station) {
    wh_lua_set_index(L, "robot", station->by ? station->robot : 0);
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const bool serves = !station->by || station->by[r].serves;
        if (serves) {
            lua_pushinteger(L, (station->by ? station->by[r].effector : station->effector) + 1);
        } else {
            lua_pushboolean(L, false);
        }
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -2, "by");
}

/* doors: by robot the door of the station, or false; nil: it has none. */
static void push_doors_of(lua_State *L, const wh_layout_t *layout, size_t station) {
    bool is_any = false;
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const int32_t door = wh_layout_door_of(layout, station, r);
        if (door == WH_NONE) {
            lua_pushboolean(L, false);
        } else {
            lua_pushinteger(L, door + 1);
        }
        lua_rawseti(L, -2, (lua_Integer)r + 1);
        is_any = is_any || door != WH_NONE;
    }
    if (!is_any) {
        lua_pop(L, 1);
        lua_pushnil(L);
    }
    lua_setfield(L, -2, "doors");
}

/* A point: of the robot's axes, by number from 1, those that the layout gives, rad and mm; and blend. */
static void push_via(lua_State *L, const wh_layout_via_t *via) {
    lua_createtable(L, WH_CARRIER_AXES, 1);
    for (size_t axis = 0; axis < WH_CARRIER_AXES; ++axis) {
        if (via->is_given[axis]) {
            lua_pushnumber(L, via->point.q[axis]);
            lua_rawseti(L, -2, (lua_Integer)axis + 1);
        }
    }
    wh_lua_set_number(L, "blend", via->point.blend);
}

/* vias: by robot the list of its points. */
static void push_vias(lua_State *L, const wh_layout_t *layout, size_t station) {
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const wh_layout_vias_t *vias = wh_layout_vias_of(layout, station, r);
        lua_createtable(L, (int)vias->count, 0);
        for (size_t i = 0; i < vias->count; ++i) {
            push_via(L, &vias->at[i]);
            lua_rawseti(L, -2, (lua_Integer)i + 1);
        }
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -2, "vias");
}

/* beams: by robot how many of the station's it passes on its way in; centres: if a PUT of it corrects by what
 * they say. */
static void push_beams_of(lua_State *L, const wh_layout_t *layout, size_t station) {
    lua_createtable(L, (int)layout->robot_count, 0);
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        lua_pushinteger(L, wh_layout_beams_of(layout, station, r).count);
        lua_rawseti(L, -3, (lua_Integer)r + 1);
        lua_pushboolean(L, wh_layout_centres(layout, station, r));
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -3, "centres");
    lua_setfield(L, -2, "beams");
}

static void push_station(lua_State *L, const wh_layout_t *layout, size_t index) {
    const wh_layout_station_t *station = &layout->stations[index];
    const wh_station_t *place = &layout->places[index];
    static const char *const modes[] = {"both", "get", "put", "none"};
    lua_createtable(L, 0, 30);
    wh_lua_set_number(L, "pitch", place->pitch);
    wh_lua_set_number(L, "stroke", station->stroke);
    wh_lua_set_number(L, "offset", station->offset);
    wh_lua_set_number(L, "retract", station->retract);
    wh_lua_set_number(L, "pickup_speed", station->pickup_speed);
    wh_lua_set_number(L, "pickup_acceleration", station->pickup_acceleration);
    wh_lua_set_number(L, "release", station->release);
    wh_lua_set_boolean(L, "release_default", station->release_default);
    wh_lua_set_number(L, "vacuum_delay", station->vacuum_delay);
    wh_lua_set_number(L, "timeout", station->timeout);
    wh_lua_set_number(L, "wait", station->wait);
    wh_lua_set_number(L, "map_speed", station->map_speed);
    wh_lua_set_number(L, "retries", station->retries);
    wh_lua_set_text(L, "name", station->name);
    wh_lua_set_index(L, "index", (int32_t)index);
    wh_lua_set_integer(L, "slots", place->slots);
    wh_lua_set_index(L, "chuck", place->chuck);
    wh_lua_set_index(L, "pins", wh_layout_find_pins(layout, (int32_t)index));
    wh_lua_set_index(L, "effector", station->effector);
    push_servers(L, layout, station);
    push_doors_of(L, layout, index);
    push_vias(L, layout, index);
    wh_lua_set_boolean(L, "upright", is_upright(place));
    wh_lua_set_boolean(L, "flipper", station->flipper);
    wh_lua_set_boolean(L, "taught", station->taught);
    wh_lua_set_boolean(L, "check_map", station->check_map);
    if (station->face != WH_STATION_ANY_FACE) {
        wh_lua_set_text(L, "face", wh_layout_face_name(station->face));
    }
    wh_lua_set_number(L, "radius", layout->wafer_diameter / 2);
    wh_lua_set_number(L, "notch", layout->notch);
    push_beams_of(L, layout, index);
    wh_lua_set_boolean(L, "block", station->block.is_there);
    wh_lua_set_text(L, "vacuum_check", modes[station->check]);
    wh_lua_set_text(L, "handover", station->handover == WH_HANDOVER_NEW_FIRST ? "new_first" : "same_slice");
    const wh_scanner_t *scanner = wh_layout_scanner(layout, place->chuck);
    if (scanner) {
        wh_mcs_push_edge_sensor(L, layout, scanner);
        lua_setfield(L, -2, "sensor");
    }
}

/* edge: { travel: of the whole stroke, s, clearance, mm, and where the plunger's window and its stroke end:
 * `to` and `stop`, mm }. */
static void push_edge(lua_State *L, const wh_edge_t *edge) {
    lua_createtable(L, 0, 4);
    wh_lua_set_number(L, "to", edge->gripped_to);
    wh_lua_set_number(L, "stop", edge->end);
    wh_lua_set_number(L, "travel", (edge->end - edge->retracted) / edge->speed);
    wh_lua_set_number(L, "clearance", edge->clearance);
    lua_setfield(L, -2, "edge");
}

/* { name, on_robot, axis, grip, edge }; of a chuck on a stage, of pins and of a flipper's clamp also `kind`
 * and its travel, `low` and `high`. */
static void push_gripper(lua_State *L, const wh_layout_t *layout, size_t g) {
    const wh_mount_t *mount = &layout->machine.mounts[g];
    lua_createtable(L, 0, 3);
    wh_lua_set_text(L, "name", layout->grippers[g].name);
    wh_lua_set_boolean(L, "on_robot", layout->grippers[g].station == WH_NONE);
    if (layout->grippers[g].station == WH_NONE) {
        wh_lua_set_index(L, "robot", mount->robot);
    }
    wh_lua_set_index(L, "axis", mount->axis);
    wh_lua_set_index(L, "arm", mount->arm);
    wh_lua_set_text(L, "grip", wh_layout_grip_name(layout->grips[g].kind));
    if (layout->grips[g].kind == WH_GRIP_EDGE) {
        push_edge(L, &layout->grips[g].edge);
    }
    if (wh_mount_axes(mount) > 0 && mount->kind != WH_MOUNT_CHUCK) {
        static const char *const kinds[] = {"chuck", "stage", "pins", "flipper"};
        wh_lua_set_text(L, "kind", kinds[mount->kind]);
        wh_lua_set_number(L, "low", mount->travel.min);
        wh_lua_set_number(L, "high", mount->travel.max);
    }
}

/* { name, axis, travel, timeout }. */
static void push_door(lua_State *L, const wh_layout_t *layout, size_t door) {
    const wh_machine_t *machine = &layout->machine;
    lua_createtable(L, 0, 4);
    wh_lua_set_text(L, "name", layout->door_list[door].name);
    wh_lua_set_index(L, "axis", (int32_t)wh_machine_door_axis(machine, door));
    wh_lua_set_number(L, "travel", machine->doors[door].travel);
    wh_lua_set_number(L, "timeout", layout->door_list[door].timeout);
}

/* Of two arms or wrists: arms, the indices of their own axes; headings, where each arm points with theta at
 * 0; and if they come in before the robot turns. With a transit they come in on its ways. */
static void push_arms(lua_State *L, const wh_carrier_t *carrier, size_t first, bool has_transit) {
    const bool is_wrist = carrier->chain.kind == WH_CHAIN_SCARA;
    lua_createtable(L, 2, 0);
    lua_pushinteger(L, (lua_Integer)first + (is_wrist ? WH_AXIS_YAW : WH_AXIS_R) + 1);
    lua_rawseti(L, -2, 1);
    lua_pushinteger(L, (lua_Integer)first + (lua_Integer)carrier->axis_count);
    lua_rawseti(L, -2, 2);
    lua_setfield(L, -2, "arms");
    if (!is_wrist) {
        const wh_real_t headings[] = {carrier->chain.arm_heading, carrier->second->chain.arm_heading};
        wh_lua_push_numbers(L, headings, 2);
        lua_setfield(L, -2, "headings");
    }
    wh_lua_set_boolean(L, "retracts", !is_wrist && !has_transit);
}

/* { name, first: the index of the robot's first axis, home: by its own axes, axes: of those that it has
 * the name, the index and if it turns, in order }. */
static void push_robot(lua_State *L, const wh_layout_t *layout, size_t robot) {
    const wh_machine_t *machine = &layout->machine;
    size_t first;
    const wh_carrier_t *carrier = wh_machine_carrier(machine, robot, &first);
    const size_t count = carrier ? carrier->axis_count : WH_ROBOT_AXES;
    wh_real_t home[WH_AXES];
    wh_machine_home(machine, home);
    lua_createtable(L, 0, 4);
    wh_lua_set_text(L, "name", layout->robots[robot].name);
    wh_lua_set_index(L, "first", (int32_t)first);
    wh_lua_set_boolean(L, "is_usual", wh_layout_is_usual(layout, robot));
    wh_lua_push_numbers(L, &home[first], count);
    lua_setfield(L, -2, "home");
    lua_createtable(L, (int)count, 0);
    for (size_t axis = first; axis < first + count; ++axis) {
        if (wh_axis_exists(machine, axis)) {
            lua_createtable(L, 0, 3);
            wh_lua_set_text(L, "name", wh_axis_name(machine, axis));
            wh_lua_set_index(L, "index", (int32_t)axis);
            wh_lua_set_boolean(L, "turns", wh_axis_turns(machine, axis));
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        }
    }
    lua_setfield(L, -2, "axes");
    if (carrier && carrier->second) {
        push_arms(L, carrier, first, layout->robots[robot].transit > 0);
    }
}

/* s: from a valve's closing until its gripper lets go. */
static double time_to_vent(const wh_vacuum_config_t *vacuum) {
    return vacuum->vent > 0 ? -vacuum->vent * wh_ln(vacuum->release) : 0;
}

/* { path, slice, sampled, homed, seat, thickness, vent, tolerance, robots in order, corrections: the
 * largest ones by the field of a command, its turn in degrees, grippers and doors in order, stations by
 * name }:
 * lengths in mm, other angles in rad, times in s. */
static void push_layout(lua_State *L, const wh_layout_t *layout) {
    lua_createtable(L, 0, 9);
    wh_lua_set_text(L, "path", layout->path);
    wh_lua_set_number(L, "slice", (double)layout->slice_us / 1e6);
    wh_lua_set_boolean(L, "sampled", layout->grasp.check == WH_CHECK_SAMPLED);
    wh_lua_set_boolean(L, "homed", layout->homed);
    wh_lua_set_boolean(L, "seat", layout->grasp.seat);
    wh_lua_set_number(L, "thickness", layout->wafer_thickness);
    wh_lua_set_number(L, "vent", time_to_vent(&layout->physics.vacuum));
    wh_lua_push_tolerance(L, &layout->grasp.tolerance);
    lua_setfield(L, -2, "tolerance");
    lua_createtable(L, 0, (int)layout->station_count);
    for (size_t s = 0; s < layout->station_count; ++s) {
        push_station(L, layout, s);
        lua_setfield(L, -2, layout->stations[s].name);
    }
    lua_setfield(L, -2, "stations");
    lua_createtable(L, (int)layout->machine.gripper_count, 0);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        push_gripper(L, layout, g);
        lua_rawseti(L, -2, (lua_Integer)g + 1);
    }
    lua_setfield(L, -2, "grippers");
    lua_createtable(L, (int)layout->machine.door_count, 0);
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        push_door(L, layout, d);
        lua_rawseti(L, -2, (lua_Integer)d + 1);
    }
    lua_setfield(L, -2, "doors");
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        push_robot(L, layout, r);
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -2, "robots");
    lua_createtable(L, 0, 4);
    wh_lua_set_number(L, "dx", layout->corrections.x);
    wh_lua_set_number(L, "dy", layout->corrections.y);
    wh_lua_set_number(L, "dz", layout->corrections.z);
    wh_lua_set_number(L, "turn", layout->corrections.turn_deg);
    lua_setfield(L, -2, "corrections");
}

void wh_mcs_set_up(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
    set_up(L, mcs, layout);
    push_layout(L, layout);
}

/* -------------------------------------------------------------------------------------------------- words */

/* Registry key of the script's own study. */
static const char study_key;

/* native.study(description): takes the place of the layout's. */
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

/* Leaves what the layout's file returns, or raises what is wrong. */
static void evaluate_layout(lua_State *L, wh_mcs_t *mcs, const char *path) {
    wh_sandbox_result_t result;
    if (mcs->is_file && wh_output_is_one_file(path, mcs->script)) {
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
    const char *path = push_layout_path(L, mcs, name);
    evaluate_layout(L, mcs, path);
    wh_layout_t *layout = wh_layout_read(L, path);
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &study_key) == LUA_TTABLE) {
        wh_layout_read_own_study(L, mcs->script, layout);
    }
    lua_pop(L, 1);
    if (mcs->error_count > 0) {
        wh_layout_give_errors(L, layout, mcs->errors, mcs->error_count);
    }
    layout->collision = layout->collision && !mcs->without_collisions;
    wh_mcs_set_up(L, mcs, layout);
    return 1;
}

/* native.ranges(): the station parameters that are numbers, by name: { least, most, unit }. */
static int list_ranges(lua_State *L) {
    lua_newtable(L);
    for (const wh_station_range_t *range = wh_station_ranges; range->name; ++range) {
        lua_createtable(L, 3, 0);
        lua_pushnumber(L, range->least);
        lua_rawseti(L, -2, 1);
        lua_pushnumber(L, range->most);
        lua_rawseti(L, -2, 2);
        lua_pushstring(L, range->unit);
        lua_rawseti(L, -2, 3);
        lua_setfield(L, -2, range->name);
    }
    return 1;
}

const luaL_Reg wh_mcs_cell_functions[] = {
    {"cell", set_up_cell}, {"study", set_study}, {"ranges", list_ranges}, {NULL, NULL}};
