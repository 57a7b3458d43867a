/* Segments: read from Lua, planned, and played slice by slice. */
#include <math.h>
#include <time.h>

#include "native.h"

/* The budget is charged for slices in portions, so that a long wait can be ended within one. A slice costs as much time
 * as some twenty instructions of Lua. */
#define SLICES_PER_CHARGE 1024
#define STEPS_PER_SLICE 20

/* ----------------------------------------------------------------------------------------------------- reading */

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
    lua_getfield(L, 1, "acceleration");
    segment->acceleration = luaL_optnumber(L, -1, 0);
    lua_pop(L, 2);
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

/* The segment table at stack index 1: one of axes, line (with speed and acceleration), valves, dwell, sensor (with timeout).
 * Raises if it is none. */
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

/* ---------------------------------------------------------------------------------------------------- planning */

/* A wafer could be lost from what the segment carries, and from a gripper on the robot in any segment. */
static uint32_t may_lose(const wh_machine_t *machine, const wh_task_t *task) {
    uint32_t grippers = task->carried;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        grippers |= machine->mounts[g].axis == WH_NONE ? 1U << g : 0;
    }
    return grippers;
}

/* Plans the segment table at stack index 1 from where the track stands, which has then begun it. Raises if it cannot be. */
static void plan_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned) {
    const wh_segment_t segment = read_segment(L, mcs);
    lua_getfield(L, 1, "vacuum");
    const bool for_vacuum = segment.kind == WH_SEGMENT_DWELL && lua_toboolean(L, -1) != 0;
    lua_pop(L, 1);
    planned->task = wh_activity_task(&mcs->track, &segment, for_vacuum);
    planned->may_lose = may_lose(mcs->track.machine, &planned->task);
    const wh_status_t status = wh_track_begin(&mcs->track, &segment);
    if (status != WH_OK) {
        wh_mcs_raise(L, mcs, status, NULL);
    }
    planned->track = mcs->track;
}

static void look_ahead(lua_State *L, wh_mcs_t *mcs) {
    const wh_rehearsal_t *rehearsal = &mcs->rehearsal;
    char reason[WH_REHEARSAL_REASON_BYTES] = "";
    if (rehearsal->is_judged && rehearsal->look_ahead) {
        if (rehearsal->look_ahead(rehearsal->look_ahead_user, &mcs->track, &mcs->state, rehearsal->count == 0,
                                  reason)) {
            wh_mcs_raise(L, mcs, WH_STATUS_COLLISION_AHEAD, reason);
        }
        wh_sandbox_charge(L, STEPS_PER_SLICE * (uint64_t)mcs->track.segment_slices);
    }
}

/* native.plan(segment): within a rehearsal; the number by which the segment can then be played as it was planned. */
static int plan(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_planned_t planned;
    luaL_argcheck(L, mcs->rehearsal.is_on, 1, "no rehearsal goes on");
    plan_segment(L, mcs, &planned);
    look_ahead(L, mcs);
    wh_track_skip(&mcs->track);
    wh_rehearsal_note_reach(&mcs->rehearsal, &mcs->track, mcs->recorder.record);
    wh_rehearsal_add(&mcs->rehearsal, &planned);
    lua_pushinteger(L, (lua_Integer)mcs->rehearsal.count);
    return 1;
}

/* native.rehearse(on, judged): from now on segments are only planned, and looked at for collisions if judged; off: everything is
 * where it was. */
static int rehearse(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_rehearsal_end(&mcs->rehearsal, &mcs->track);
    if (lua_toboolean(L, 1)) {
        wh_rehearsal_begin(&mcs->rehearsal, &mcs->track, lua_toboolean(L, 2) != 0);
    }
    return 0;
}

/* native.reach(station, slot): what is rehearsed from now on goes there; without arguments: the reach is no longer noted. */
static int set_reach(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const size_t stations = mcs->layout->station_count;
    mcs->rehearsal.reach_slot = (int32_t)luaL_optinteger(L, 2, 0);
    if (mcs->rehearsal.reach_slot != 0) {
        mcs->rehearsal.reach_station = wh_mcs_index(L, 1, stations);
        wh_record_begin_reach(mcs->recorder.record, stations);
    }
    return 0;
}

/* ----------------------------------------------------------------------------------------------------- playing */

/* One slice: the command goes in, the state comes out, and whoever listens hears of both. */
static wh_status_t exchange(wh_mcs_t *mcs) {
    wh_command_from_track(&mcs->command, &mcs->cache, &mcs->track);
    const wh_status_t status = mcs->link->exchange(mcs->link, &mcs->command, &mcs->state);
    for (size_t i = 0; i < mcs->listener_count; ++i) {
        mcs->listeners[i].hear(mcs->listeners[i].user, &mcs->command, &mcs->state);
    }
    mcs->command.fault_count = 0;
    return status;
}

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool stop_has_come(const wh_mcs_t *mcs) {
    return mcs->track.slice >= mcs->stop_slice;
}

/* Plays up to SLICES_PER_CHARGE slices of the segment; fewer if the sandbox is to stop, for over a link at a
 * wall-clock rate a portion may take seconds. */
static wh_track_state_t play_portion(wh_mcs_t *mcs, wh_status_t *status) {
    wh_track_state_t state = WH_TRACK_MOVING;
    const double begin = seconds_now();
    for (int i = 0; i < SLICES_PER_CHARGE && *status == WH_OK && state == WH_TRACK_MOVING; ++i) {
        state = wh_track_next(&mcs->track, mcs->state.sensors);
        if (state == WH_TRACK_MOVING) {
            *status = exchange(mcs);
            wh_vacuum_watch_slice(&mcs->watch, mcs->state.sensors);
        }
        if (wh_sandbox_stopping(mcs->sandbox) || stop_has_come(mcs)) {
            break;
        }
    }
    mcs->recorder.record->wall_s += seconds_now() - begin;
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
        if (stop_has_come(mcs)) {
            mcs->stop_slice = INT64_MAX;
            wh_mcs_raise(L, mcs, WH_STATUS_STOPPED, "by stop_in");
        }
    }
    return state;
}

static void keep_segment(wh_mcs_t *mcs) {
    if (mcs->keep_segments) {
        mcs->segments =
            wh_record_grow(mcs->segments, mcs->segment_count, &mcs->segment_capacity, sizeof *mcs->segments);
        mcs->segments[mcs->segment_count++] = mcs->track.segment;
    }
}

/* A segment of the last rehearsal begins as it was planned there, in the slice that the track has come to. */
static void begin_planned(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned) {
    *planned = mcs->rehearsal.segments[wh_mcs_index(L, 1, mcs->rehearsal.count)];
    planned->track.slice = mcs->track.slice;
    mcs->track = planned->track;
}

/* native.play(segment or the number of a planned one): true if it ran to its end, false if its sensor did not come on in
 * time; then the gripper that lost its wafer meanwhile, or nil. */
static int play(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_planned_t planned;
    luaL_argcheck(L, !mcs->rehearsal.is_on, 1, "a rehearsal goes on");
    if (lua_isinteger(L, 1)) {
        begin_planned(L, mcs, &planned);
    } else {
        plan_segment(L, mcs, &planned);
    }
    keep_segment(mcs);
    mcs->recorder.task = planned.task;
    wh_vacuum_watch_begin(&mcs->watch, planned.may_lose & mcs->state.sensors);
    const wh_segment_t *segment = &mcs->track.segment;
    wh_decisions_read(mcs->decisions, WH_DECISION_BEGIN,
                      segment->kind == WH_SEGMENT_SENSOR ? segment->gripper : WH_NONE,
                      (int32_t)planned.may_lose);
    const bool done = play_through(L, mcs) == WH_TRACK_DONE;
    const int32_t lost = wh_vacuum_watch_lost(&mcs->watch, mcs->track.valves, mcs->state.gripper_count);
    wh_decisions_read(mcs->decisions, WH_DECISION_END, lost, done);
    lua_pushboolean(L, done);
    if (lost == WH_NONE) {
        return 1;
    }
    lua_pushinteger(L, lost + 1);
    return 2;
}

/* native.stop_in(seconds): a STOP comes at the first slice at or after so many simulated seconds from now. */
static int stop_in(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const double slices = ceil(luaL_checknumber(L, 1) * 1e6 / (double)mcs->track.slice_us);
    mcs->stop_slice = mcs->track.slice + (int64_t)slices;
    return 0;
}

const luaL_Reg wh_mcs_play_functions[] = {{"rehearse", rehearse}, {"plan", plan},       {"reach", set_reach},
                                          {"play", play},         {"stop_in", stop_in}, {NULL, NULL}};
