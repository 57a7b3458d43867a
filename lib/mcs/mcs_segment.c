/* The MCS host's ears: what Lua asks of the machine, read as segments of a track. */
#include "mcs_internal.h"

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

wh_segment_t wh_mcs_read_segment(lua_State *L, const wh_mcs_t *mcs) {
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
