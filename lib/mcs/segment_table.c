/* A segment as lua/mcs asks for it: a table, which is read and checked. */
#include <stdio.h>
#include <string.h>

#include "../layout/transit.h"
#include "../layout/travel.h"
#include "playing.h"

void wh_mcs_refuse_request(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *reason) {
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

static void read_axes_field(lua_State *L, const wh_mcs_t *mcs, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_AXES;
    wh_mcs_read_numbers(L, lua_gettop(L), segment->target, mcs->layout->machine.axis_count);
}

/* A leg that turns must lie wholly within the transit: on a way with via points no arm retracts by
 * itself. */
static void check_legs(lua_State *L, wh_mcs_t *mcs, size_t robot, const wh_segment_t *segment) {
    const wh_layout_t *layout = mcs->layout;
    size_t first = 0;
    (void)wh_machine_carrier(&layout->machine, robot, &first);
    const wh_real_t *from = &mcs->track.axes[first];
    for (size_t i = 0; i <= segment->point_count; ++i) {
        const wh_real_t *to = i < segment->point_count ? segment->points[i].q : &segment->target[first];
        wh_transit_t transit;
        if (wh_transit_leaves(layout, robot, from, to, &transit)) {
            char reason[WH_TRAVEL_BYTES];
            snprintf(
                reason, sizeof reason,
                "leg %zu by `via` turns with r at %.6g mm: beyond `%s%s.transit` of %.10g mm nothing may",
                i + 1, transit.r, layout->robot_count > 1 ? "robots." : "", layout->robots[robot].name,
                layout->robots[robot].transit);
            wh_mcs_refuse_request(L, mcs, WH_STATUS_OUT_OF_REACH, reason);
        }
        from = to;
    }
}

/* If the robot turns before or after a point, the arm must be within the circle before it goes on. */
static void limit_corners(wh_mcs_t *mcs, size_t robot, const wh_segment_t *segment) {
    const wh_layout_t *layout = mcs->layout;
    size_t first = 0;
    (void)wh_machine_carrier(&layout->machine, robot, &first);
    const wh_real_t *from = &mcs->track.axes[first];
    for (size_t i = 0; i < segment->point_count; ++i) {
        wh_via_point_t *point = &mcs->running.via_points[i];
        const bool is_last = i + 1 == segment->point_count;
        const wh_real_t *to = is_last ? &segment->target[first] : mcs->running.via_points[i + 1].q;
        memset(point->reach, 0, sizeof point->reach);
        if (wh_transit_corner(layout, robot, from, point->q, to, point->reach)) {
            point->reach[0] = wh_real_max(point->reach[0], WH_SLACK_MM);
            point->reach[1] = wh_real_max(point->reach[1], WH_SLACK_MM);
        }
        from = point->q;
    }
}

/* Reads a point at the top of the stack: the robot's own axes in order, and `blend`. */
static void read_point(lua_State *L, wh_via_point_t *point, size_t axis_count) {
    for (size_t axis = 0; axis < axis_count; ++axis) {
        lua_rawgeti(L, -1, (lua_Integer)axis + 1);
        point->q[axis] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
    lua_getfield(L, -1, "blend");
    point->blend = luaL_checknumber(L, -1);
    lua_pop(L, 1);
}

/* Reads the request's `via`, a list of points, and the `robot` that goes by them. False: there is
 * no `via`. */
static bool read_vias(lua_State *L, wh_mcs_t *mcs, wh_segment_t *segment) {
    lua_settop(L, 1);
    if (lua_getfield(L, 1, "via") != LUA_TTABLE) {
        return false;
    }
    lua_getfield(L, 2, "robot");
    const size_t robot = (size_t)wh_mcs_index(L, -1, mcs->layout->robot_count);
    lua_settop(L, 2);
    size_t first;
    const wh_carrier_t *carrier = wh_machine_carrier(&mcs->layout->machine, robot, &first);
    segment->kind = WH_SEGMENT_VIA;
    segment->gripper = wh_layout_first_gripper(mcs->layout, robot);
    segment->points = mcs->running.via_points;
    const size_t count = (size_t)lua_rawlen(L, -1);
    segment->point_count = count < WH_VIA_POINTS ? count : WH_VIA_POINTS;
    for (size_t i = 0; i < segment->point_count; ++i) {
        lua_rawgeti(L, 2, (lua_Integer)i + 1);
        read_point(L, &mcs->running.via_points[i], carrier ? carrier->axis_count : WH_ROBOT_AXES);
        lua_pop(L, 1);
    }
    lua_settop(L, 1);
    check_legs(L, mcs, robot, segment);
    limit_corners(mcs, robot, segment);
    return true;
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
    lua_getfield(L, 1, "gripper");
    segment->gripper = (int32_t)luaL_optinteger(L, -1, 0) - 1;
    lua_pop(L, 3);
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

/* Moves by via points, within the transit, or straight. */
static void read_motion(lua_State *L, wh_mcs_t *mcs, wh_segment_t *segment) {
    read_axes_field(L, mcs, segment);
    if (!read_vias(L, mcs, segment) && lua_getfield(L, 1, "stays") != LUA_TBOOLEAN) {
        wh_transit_keep(mcs->layout, mcs->track.axes, segment);
    }
}

wh_segment_t wh_mcs_read_segment(lua_State *L, wh_mcs_t *mcs, wh_awaited_t *awaited) {
    static const char *const kinds[] = {"axes", "line", "valves", "dwell", "sensor", "arrives"};
    wh_segment_t segment = wh_track_blank(&mcs->track);
    size_t kind = 0;
    luaL_checktype(L, 1, LUA_TTABLE);
    while (kind < 6 && lua_getfield(L, 1, kinds[kind]) == LUA_TNIL) {
        lua_pop(L, 1);
        ++kind;
    }
    switch (kind) {
    case 0:
        read_motion(L, mcs, &segment);
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
    case 5:
        wh_mcs_await_arrival(L, mcs, &segment, awaited);
        break;
    default:
        luaL_error(L, "a segment needs one of axes, line, valves, dwell, sensor, arrives");
    }
    lua_settop(L, 1);
    return segment;
}
