/* The MCS host's hands: setting up the cell, planning, and playing segments slice by slice. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "motion/trig.h"
#include "script/mcs_internal.h"

/* The budget is charged for slices in portions, so that a long wait can be ended within one. A slice costs as much time
 * as some twenty instructions of Lua. */
#define SLICES_PER_CHARGE 1024
#define STEPS_PER_SLICE 20

/* ------------------------------------------------------------------------------------------------ the cell
 */

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

static void set_up(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout) {
    const size_t bytes = layout->wafer_count * sizeof(wh_wafer_t);
    wh_grasp_storage_t storage = {0};
    storage.wafers = lua_memory(L, bytes);
    storage.wafer_count = layout->wafer_count;
    storage.gripper_count = layout->machine.gripper_count;
    storage.grippers = lua_memory(L, storage.gripper_count * sizeof(wh_gripper_t));
    if (bytes > 0) {
        memcpy(storage.wafers, layout->start, bytes);
    }
    const wh_cell_t cell = {layout->places, layout->station_count, layout->grasp.tolerance};
    wh_status_t status = wh_simulator_init(&mcs->simulator, &layout->grasp, &storage, &cell);
    if (status == WH_OK) {
        status = wh_track_init(&mcs->track, &layout->machine, layout->slice_us);
    }
    if (status != WH_OK) {
        luaL_error(L, "%s: %s", layout->path, wh_status_text(status));
    }
    mcs->link = &mcs->simulator.link;
    mcs->command.gripper_count = layout->machine.gripper_count;
    mcs->command.axis_count = layout->machine.axis_count;
    wh_simulator_view(&mcs->simulator, &mcs->state);
    mcs->layout = layout;
}

/* native.cell(path): reads the layout and sets up the run; returns the layout's path as it will be named. */
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
    set_up(L, mcs, wh_layout_read(L, path));
    lua_pushstring(L, mcs->layout->path);
    return 1;
}

/* ------------------------------------------------------------------------------------------------ planning
 */

static void push_axes(lua_State *L, const wh_mcs_t *mcs, const wh_real_t axes[]) {
    lua_createtable(L, (int)mcs->layout->machine.axis_count, 0);
    for (size_t axis = 0; axis < mcs->layout->machine.axis_count; ++axis) {
        lua_pushnumber(L, axes[axis]);
        lua_rawseti(L, -2, (lua_Integer)axis + 1);
    }
}

/* native.axes(): where all axes stand, rad and mm. */
static int read_axes(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    push_axes(L, mcs, mcs->track.axes);
    return 1;
}

/* native.inverse(x, y, z, heading): the axes with the end-effector there, from where they stand. */
static int find_axes(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const double x = luaL_checknumber(L, 1);
    const double y = luaL_checknumber(L, 2);
    const double z = luaL_checknumber(L, 3);
    wh_real_t axes[WH_AXES];
    memcpy(axes, mcs->track.axes, sizeof axes);
    const wh_status_t status =
        wh_robot_inverse(&mcs->layout->machine.robot, x, y, z, luaL_checknumber(L, 4), mcs->track.axes, axes);
    if (status != WH_OK) {
        char detail[120];
        snprintf(detail, sizeof detail, "x %.3f, y %.3f, z %.3f mm", x, y, z);
        wh_mcs_raise(L, mcs, status, detail);
    }
    push_axes(L, mcs, axes);
    return 1;
}

/* native.slot(station, slot): { x, y, z, dir_x, dir_y, heading }, the way in projected to horizontal. */
static int find_slot(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const wh_station_t *place = &mcs->layout->places[station];
    const int32_t slot = wh_mcs_index(L, 2, (size_t)place->slots) + 1;
    const wh_pose_t base_from_slot = wh_station_slot(place, slot);
    const wh_real_t x = base_from_slot.R.m[0][0];
    const wh_real_t y = base_from_slot.R.m[1][0];
    const wh_real_t length = wh_real_sqrt(x * x + y * y);
    const struct {
        const char *name;
        double value;
    } fields[] = {{"x", base_from_slot.r.x}, {"y", base_from_slot.r.y}, {"z", base_from_slot.r.z},
                  {"dir_x", x / length},     {"dir_y", y / length},     {"heading", wh_atan2(y, x)}};
    lua_createtable(L, 0, 6);
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        lua_pushnumber(L, fields[i].value);
        lua_setfield(L, -2, fields[i].name);
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------- playing
 */

static void keep_events(wh_mcs_t *mcs) {
    for (size_t i = 0; i < mcs->state.event_count; ++i) {
        wh_record_add_event(mcs->record, mcs->state.utime, mcs->running, &mcs->state.events[i]);
    }
}

static wh_status_t exchange(wh_mcs_t *mcs) {
    wh_command_t *command = &mcs->command;
    wh_pose_t poses[WH_GRIPPERS];
    wh_machine_grippers(&mcs->layout->machine, mcs->track.axes, poses);
    for (size_t g = 0; g < command->gripper_count; ++g) {
        command->grippers[g].base_from_gripper = poses[g];
        command->grippers[g].valve = mcs->track.valves[g];
    }
    memcpy(command->axes, mcs->track.axes, sizeof command->axes);
    command->seq = mcs->track.slice;
    command->utime = mcs->track.slice * mcs->track.slice_us;
    const wh_status_t status = mcs->link->exchange(mcs->link, command, &mcs->state);
    if (mcs->state.event_count > 0) {
        keep_events(mcs);
    }
    return status;
}

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Plays up to SLICES_PER_CHARGE slices of the segment; fewer when the sandbox is to stop, for over a link at a
 * wall-clock rate a portion may take seconds. */
static wh_track_state_t play_portion(wh_mcs_t *mcs, wh_status_t *status) {
    wh_track_state_t state = WH_TRACK_MOVING;
    const double begin = seconds_now();
    for (int i = 0; i < SLICES_PER_CHARGE && *status == WH_OK && state == WH_TRACK_MOVING; ++i) {
        state = wh_track_next(&mcs->track, mcs->state.sensors);
        if (state == WH_TRACK_MOVING) {
            *status = exchange(mcs);
        }
        if (wh_sandbox_stopping(mcs->sandbox)) {
            break;
        }
    }
    mcs->record->wall_s += seconds_now() - begin;
    return state;
}

static wh_track_state_t play_through(lua_State *L, wh_mcs_t *mcs) {
    wh_status_t status = WH_OK;
    wh_track_state_t state = WH_TRACK_MOVING;
    while (state == WH_TRACK_MOVING) {
        const int64_t before = mcs->track.slice;
        state = play_portion(mcs, &status);
        /* First, for a link that gave up waiting because of a stop returns with some status too. */
        wh_sandbox_charge(L, STEPS_PER_SLICE * (uint64_t)(mcs->track.slice - before));
        if (status != WH_OK) {
            wh_mcs_raise(L, mcs, status, "the simulator refused a slice");
        }
    }
    return state;
}

/* ------------------------------------------------------------------------------------------------ segments
 */

static void read_axes_field(lua_State *L, const wh_mcs_t *mcs, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_AXES;
    for (size_t axis = 0; axis < mcs->layout->machine.axis_count; ++axis) {
        lua_rawgeti(L, -1, (lua_Integer)axis + 1);
        segment->target[axis] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
}

static void read_line_field(lua_State *L, wh_segment_t *segment) {
    wh_real_t *const parts[] = {&segment->travel.x, &segment->travel.y, &segment->travel.z};
    segment->kind = WH_SEGMENT_LINE;
    for (int i = 0; i < 3; ++i) {
        lua_rawgeti(L, -1, i + 1);
        *parts[i] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
    lua_getfield(L, 1, "speed");
    segment->speed = luaL_optnumber(L, -1, 0);
    lua_pop(L, 1);
}

static void read_valves_field(lua_State *L, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_VALVES;
    for (int g = 0; g < WH_GRIPPERS; ++g) {
        lua_rawgeti(L, -1, g + 1);
        segment->valves[g] = (int32_t)luaL_optinteger(L, -1, WH_NONE);
        lua_pop(L, 1);
    }
}

static void read_sensor_field(lua_State *L, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_SENSOR;
    segment->gripper = (int32_t)luaL_checkinteger(L, -1) - 1;
    lua_getfield(L, 1, "timeout");
    segment->seconds = luaL_checknumber(L, -1);
    lua_pop(L, 1);
}

/* The segment table at stack index 1: one of axes, line (with speed), valves, dwell, sensor (with timeout).
 */
static wh_segment_t read_segment(lua_State *L, const wh_mcs_t *mcs) {
    static const char *const kinds[] = {"axes", "line", "valves", "dwell", "sensor"};
    wh_segment_t segment = wh_track_blank(&mcs->track);
    size_t kind = 0;
    luaL_checktype(L, 1, LUA_TTABLE);
    while (kind < 5 && lua_getfield(L, 1, kinds[kind]) == LUA_TNIL) {
        lua_pop(L, 1);
        ++kind;
    }
    switch (kind) {
    case 0:
        read_axes_field(L, mcs, &segment);
        break;
    case 1:
        read_line_field(L, &segment);
        break;
    case 2:
        read_valves_field(L, &segment);
        break;
    case 3:
        segment.seconds = luaL_checknumber(L, -1);
        break;
    case 4:
        read_sensor_field(L, &segment);
        break;
    default:
        luaL_error(L, "a segment needs one of axes, line, valves, dwell, sensor");
    }
    lua_settop(L, 1);
    return segment;
}

static void keep_segment(wh_mcs_t *mcs, const wh_segment_t *segment) {
    mcs->segments =
        wh_record_grow(mcs->segments, mcs->segment_count, &mcs->segment_capacity, sizeof *mcs->segments);
    mcs->segments[mcs->segment_count++] = *segment;
}

/* native.play(segment): true when it ran to its end, false when its sensor did not come on in time. */
static int play(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_segment_t segment = read_segment(L, mcs);
    const wh_status_t status = wh_track_begin(&mcs->track, &segment);
    if (status != WH_OK) {
        wh_mcs_raise(L, mcs, status, NULL);
    }
    wh_track_state_t state = WH_TRACK_DONE;
    if (mcs->rehearsing) {
        wh_track_skip(&mcs->track);
    } else {
        if (mcs->keep_segments) {
            keep_segment(mcs, &segment);
        }
        state = play_through(L, mcs);
    }
    lua_pushboolean(L, state == WH_TRACK_DONE);
    return 1;
}

/* native.rehearse(on): from now on segments are only planned; off: everything is where it was. */
static int rehearse(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const bool on = lua_toboolean(L, 1) != 0;
    if (on) {
        mcs->kept = mcs->track;
    } else if (mcs->rehearsing) {
        mcs->track = mcs->kept;
    }
    mcs->rehearsing = on;
    return 0;
}

const luaL_Reg wh_mcs_play_functions[] = {{"cell", set_up_cell}, {"axes", read_axes}, {"inverse", find_axes},
                                          {"slot", find_slot},   {"play", play},      {"rehearse", rehearse},
                                          {NULL, NULL}};
