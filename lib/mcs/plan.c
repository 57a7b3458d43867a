/* Geometry: where slots are, where the axes stand, and where they must go. */
#include <stdio.h>
#include <string.h>

#include "../math/trig.h"
#include "../script/wh_module_internal.h"
#include "native.h"

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

/* native.inverse(x, y, z, heading, gripper): the axes with that gripper of the robot there, from where they stand. */
static int find_axes(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_vec3_t at = wh_vec3(luaL_checknumber(L, 1), luaL_checknumber(L, 2), luaL_checknumber(L, 3));
    const int32_t gripper = wh_mcs_index(L, 5, mcs->layout->machine.gripper_count);
    wh_real_t axes[WH_AXES];
    memcpy(axes, mcs->track.axes, sizeof axes);
    const wh_status_t status = wh_machine_inverse(&mcs->layout->machine, (size_t)gripper, &at,
                                                  luaL_checknumber(L, 4), mcs->track.axes, axes);
    if (status != WH_OK) {
        char detail[120];
        snprintf(detail, sizeof detail, "x %.3f, y %.3f, z %.3f mm", at.x, at.y, at.z);
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
    lua_createtable(L, 0, 6);
    wh_lua_set_number(L, "x", base_from_slot.r.x);
    wh_lua_set_number(L, "y", base_from_slot.r.y);
    wh_lua_set_number(L, "z", base_from_slot.r.z);
    wh_lua_set_number(L, "dir_x", x / length);
    wh_lua_set_number(L, "dir_y", y / length);
    wh_lua_set_number(L, "heading", wh_atan2(y, x));
    return 1;
}

const luaL_Reg wh_mcs_plan_functions[] = {
    {"axes", read_axes}, {"inverse", find_axes}, {"slot", find_slot}, {NULL, NULL}};
