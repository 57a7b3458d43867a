/* Planning: where slots are and where the axes must go, segments as Lua asks for them, and rehearsals. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/transit.h"
#include "../layout/travel.h"
#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "native.h"

/* native.axes(): where all axes stand, rad and mm. */
static int read_axes(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lua_push_numbers(L, mcs->track.axes, mcs->layout->machine.axis_count);
    return 1;
}

/* Raises the error of a request, the table at stack index 1. Its `where` and its `target` say where the arm
 * would be: "on the way into A slot 3". */
static void refuse(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *reason) {
    lua_getfield(L, 1, "where");
    if (lua_isstring(L, -1) && lua_getfield(L, 1, "target") == LUA_TTABLE) {
        lua_getfield(L, -1, "station");
        lua_getfield(L, -2, "slot");
        lua_pushfstring(L, "%s %s slot %d%s%s", lua_tostring(L, -4), lua_tostring(L, -2),
                        (int)lua_tointeger(L, -1), reason[0] ? ": " : "", reason);
        reason = lua_tostring(L, -1);
    }
    wh_mcs_raise(L, mcs, status, reason[0] ? reason : NULL);
}

/* native.inverse(request): the axes with the gripper of request.to there, from where they stand. */
static int find_axes(lua_State *L) {
    static const char *const fields[] = {"x", "y", "z", "heading"};
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_machine_t *machine = &mcs->layout->machine;
    wh_real_t to[4], axes[WH_AXES];
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 1);
    lua_getfield(L, 1, "to");
    for (size_t i = 0; i < 4; ++i) {
        lua_getfield(L, 2, fields[i]);
        to[i] = luaL_checknumber(L, -1);
    }
    lua_getfield(L, 2, "gripper");
    const size_t gripper = (size_t)wh_mcs_index(L, -1, machine->gripper_count);
    const wh_vec3_t at = wh_vec3(to[0], to[1], to[2]);
    memcpy(axes, mcs->track.axes, sizeof axes);
    const wh_status_t status = wh_machine_inverse(machine, gripper, &at, to[3], mcs->track.axes, axes);
    if (status != WH_OK) {
        char reason[WH_TRAVEL_BYTES];
        wh_travel_say_point(mcs->layout, gripper, &at, to[3], mcs->track.axes, reason);
        refuse(L, mcs, status, reason);
    }
    wh_lua_push_numbers(L, axes, machine->axis_count);
    return 1;
}

/* The slot's frame, displaced in its own axes by the numbers from stack index 3 on: dx, dy, dz. */
static wh_pose_t corrected_slot(lua_State *L, const wh_station_t *place, int32_t slot) {
    wh_pose_t base_from_slot = wh_station_slot(place, slot);
    const wh_vec3_t d = wh_vec3(luaL_checknumber(L, 3), luaL_checknumber(L, 4), luaL_checknumber(L, 5));
    if (wh_vec3_norm(&d) > 0) { /* else the very bits of the slot, zeros of either sign, too */
        const wh_vec3_t by = wh_mat3_transform(&base_from_slot.R, &d);
        base_from_slot.r = wh_vec3_add(&base_from_slot.r, &by);
    }
    return base_from_slot;
}

/* The heading of the slot's x axis, turned about its z. */
static wh_real_t corrected_heading(const wh_mat3_t *R, wh_real_t turn_deg) {
    wh_real_t sine, cosine;
    if (!(wh_real_abs(turn_deg) > 0)) {
        return wh_atan2(R->m[1][0], R->m[0][0]);
    }
    wh_sin_cos_deg(turn_deg, &sine, &cosine);
    return wh_atan2(cosine * R->m[1][0] + sine * R->m[1][1], cosine * R->m[0][0] + sine * R->m[0][1]);
}

/* native.slot(station, slot, dx, dy, dz, turn): { x, y, z, dir_x, dir_y, heading } of the gripper there,
 * displaced in the slot's axes (mm) and turned about its z (degrees). The way in, projected to horizontal, is
 * beside the taught one and goes the same way: it is not turned. */
static int find_slot(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const wh_station_t *place = &mcs->layout->places[station];
    const int32_t slot = wh_mcs_index(L, 2, (size_t)place->slots) + 1;
    const wh_pose_t base_from_slot = corrected_slot(L, place, slot);
    const wh_real_t x = base_from_slot.R.m[0][0];
    const wh_real_t y = base_from_slot.R.m[1][0];
    const wh_real_t length = wh_real_sqrt(x * x + y * y);
    lua_createtable(L, 0, 6);
    wh_lua_set_number(L, "x", base_from_slot.r.x);
    wh_lua_set_number(L, "y", base_from_slot.r.y);
    wh_lua_set_number(L, "z", base_from_slot.r.z);
    wh_lua_set_number(L, "dir_x", x / length);
    wh_lua_set_number(L, "dir_y", y / length);
    wh_lua_set_number(L, "heading", corrected_heading(&base_from_slot.R, luaL_checknumber(L, 6)));
    return 1;
}

/* ------------------------------------------------------------------------------------------------ reading */

static void read_axes_field(lua_State *L, const wh_mcs_t *mcs, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_AXES;
    for (size_t axis = 0; axis < mcs->layout->machine.axis_count; ++axis) {
        lua_rawgeti(L, -1, (lua_Integer)axis + 1);
        segment->target[axis] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
}

/* A turn with R beyond the layout's transit, at one of its ends, is a way that comes in first. */
static void keep_within_transit(const wh_mcs_t *mcs, wh_segment_t *segment) {
    const wh_real_t *from = mcs->track.axes;
    const wh_real_t *to = segment->target;
    const bool turns = wh_real_abs(to[WH_AXIS_THETA] - from[WH_AXIS_THETA]) > 0 ||
                       wh_real_abs(to[WH_AXIS_YAW] - from[WH_AXIS_YAW]) > 0;
    if (mcs->layout->transit > 0 && turns) {
        const wh_real_t reach = wh_transit_reach(mcs->layout, from[WH_AXIS_YAW], to[WH_AXIS_YAW]);
        if (from[WH_AXIS_R] > reach || to[WH_AXIS_R] > reach) {
            segment->kind = WH_SEGMENT_WAY;
            segment->reach = reach;
        }
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

/* The segment table at stack index 1: one of axes, line (with speed and acceleration), valves, dwell, sensor
 * (with timeout). Raises if it is none. */
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
        if (lua_getfield(L, 1, "stays") != LUA_TBOOLEAN) {
            keep_within_transit(mcs, &segment);
        }
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

/* ----------------------------------------------------------------------------------------------- planning */

/* A wafer could be lost from what the segment carries, and from a gripper on the robot in any segment. */
static uint32_t may_lose(const wh_machine_t *machine, const wh_task_t *task) {
    uint32_t grippers = task->carried;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        grippers |= machine->mounts[g].axis == WH_NONE ? 1U << g : 0;
    }
    return grippers;
}

static void say_way(const wh_mcs_t *mcs, const wh_segment_t *segment, char reason[WH_TRAVEL_BYTES]) {
    wh_travel_say_axes(mcs->layout, segment->target, reason);
    if (reason[0] == '\0') {
        const wh_real_t least =
            wh_transit_least(mcs->layout, mcs->track.axes[WH_AXIS_YAW], segment->target[WH_AXIS_YAW]);
        snprintf(reason, WH_TRAVEL_BYTES,
                 "`robot.transit` of %.10g mm leaves no room to turn: with r at %.10g mm, where its travel "
                 "begins, blades and wafers need %.1f mm",
                 mcs->layout->transit, mcs->layout->machine.robot.travel[WH_AXIS_R].min,
                 ceil(10 * least) / 10);
    }
}

static void refuse_segment(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const wh_segment_t *segment) {
    char reason[WH_TRAVEL_BYTES] = "";
    if (status == WH_STATUS_BAD_SEGMENT) {
        snprintf(reason, sizeof reason, "it would take more than 1e6 s");
    } else if (segment->kind == WH_SEGMENT_AXES) {
        wh_travel_say_axes(mcs->layout, segment->target, reason);
    } else if (segment->kind == WH_SEGMENT_WAY) {
        say_way(mcs, segment, reason);
    } else if (segment->kind == WH_SEGMENT_LINE) {
        wh_travel_say_line(mcs->layout, mcs->track.axes, &segment->travel, reason);
    }
    refuse(L, mcs, status, reason);
}

void wh_mcs_plan_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned) {
    const wh_segment_t segment = read_segment(L, mcs);
    lua_getfield(L, 1, "vacuum");
    const bool for_vacuum = segment.kind == WH_SEGMENT_DWELL && lua_toboolean(L, -1) != 0;
    lua_pop(L, 1);
    planned->task = wh_activity_task(&mcs->track, &segment, for_vacuum);
    planned->may_lose = may_lose(mcs->track.machine, &planned->task);
    const wh_status_t status = wh_track_begin(&mcs->track, &segment);
    if (status != WH_OK) {
        refuse_segment(L, mcs, status, &segment);
    }
    planned->track = mcs->track;
}

static void look_ahead(lua_State *L, wh_mcs_t *mcs) {
    const wh_rehearsal_t *rehearsal = &mcs->rehearsal;
    char reason[WH_REHEARSAL_REASON_BYTES] = "";
    if (rehearsal->is_judged && rehearsal->look_ahead) {
        if (rehearsal->look_ahead(rehearsal->look_ahead_user, &mcs->track, &mcs->state, rehearsal->count == 0,
                                  reason)) {
            refuse(L, mcs, WH_STATUS_COLLISION_AHEAD, reason);
        }
        wh_sandbox_charge(L, wh_mcs_steps(mcs->track.segment_slices));
    }
}

/* native.plan(segment): within a rehearsal; the number by which the segment can then be played as it was
 * planned. */
static int plan(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_planned_t planned;
    luaL_argcheck(L, mcs->rehearsal.is_on, 1, "no rehearsal goes on");
    wh_mcs_plan_segment(L, mcs, &planned);
    look_ahead(L, mcs);
    wh_track_skip(&mcs->track);
    wh_rehearsal_note_reach(&mcs->rehearsal, &mcs->track, mcs->recorder.record);
    wh_rehearsal_add(&mcs->rehearsal, &planned);
    lua_pushinteger(L, (lua_Integer)mcs->rehearsal.count);
    return 1;
}

/* native.rehearse(on, judged): from now on segments are only planned, and looked at for collisions if judged;
 * off: everything is where it was. */
static int rehearse(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_rehearsal_end(&mcs->rehearsal, &mcs->track);
    if (lua_toboolean(L, 1)) {
        wh_rehearsal_begin(&mcs->rehearsal, &mcs->track, lua_toboolean(L, 2) != 0);
    }
    return 0;
}

/* native.reach(station, slot): what is rehearsed from now on goes there; without arguments: the reach is no
 * longer noted. */
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

const luaL_Reg wh_mcs_plan_functions[] = {
    {"axes", read_axes}, {"inverse", find_axes}, {"slot", find_slot}, {"rehearse", rehearse},
    {"plan", plan},      {"reach", set_reach},   {NULL, NULL}};
