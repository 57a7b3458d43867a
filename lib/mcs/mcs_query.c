/* The MCS host's eyes: where wafers are and who holds them. */
#include <stdio.h>
#include <string.h>

#include "../math/relation.h"
#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "mcs_internal.h"

/* native.wafer(name): the wafer's index, or nil. */
static int find_wafer(lua_State *L) {
    const wh_layout_t *layout = wh_mcs_with_layout(L)->layout;
    wh_lua_push_index(L, wh_layout_find_wafer(layout, luaL_checkstring(L, 1)));
    return 1;
}

static const wh_wafer_t *wafer_argument(lua_State *L, const wh_mcs_t *mcs, int argument) {
    return &mcs->state.wafers[wh_mcs_index(L, argument, mcs->state.wafer_count)];
}

/* native.sensor(gripper): whether its vacuum sensor is on. */
static int read_sensor(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const bool on = (mcs->state.sensors >> gripper & 1U) != 0;
    wh_decisions_ask(mcs->decisions, WH_TAPE_SENSOR, gripper, on);
    lua_pushboolean(L, on);
    return 1;
}

/* native.is_open(gripper): whether its valve is. */
static int read_valve(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    lua_pushboolean(L, mcs->track.valves[gripper] == WH_VALVE_OPEN);
    return 1;
}

/* native.holder(wafer): the gripper's index, or nil. */
static int find_holder(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t wafer = wh_mcs_index(L, 1, mcs->state.wafer_count);
    const int32_t holder = mcs->state.wafers[wafer].holder;
    wh_decisions_ask(mcs->decisions, WH_TAPE_HOLDER, wafer, holder);
    wh_lua_push_index(L, holder);
    return 1;
}

/* native.measure(wafer, station, slot): dx, dy, dz, tilt_deg in that slot's frame. */
static int measure(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_wafer_t *wafer = wafer_argument(L, mcs, 1);
    const wh_station_t *station = &wh_mcs_real(mcs)->places[wh_mcs_index(L, 2, mcs->layout->station_count)];
    const int32_t slot = wh_mcs_index(L, 3, (size_t)station->slots) + 1;
    wh_decisions_measured(mcs->decisions, "offset");
    const wh_place_t place = wh_station_measure(station, slot, &wafer->base_from_wafer);
    lua_pushnumber(L, place.dx);
    lua_pushnumber(L, place.dy);
    lua_pushnumber(L, place.dz);
    lua_pushnumber(L, wh_deg_from_rad(place.tilt));
    return 4;
}

/* native.locate(wafer): station's name and slot, or nil when it lies in none. */
static int locate(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_place_t place;
    wh_decisions_measured(mcs->decisions, "where a wafer lies");
    if (!wh_cell_locate(&mcs->simulator.cell, &wafer_argument(L, mcs, 1)->base_from_wafer, &place)) {
        return 0;
    }
    lua_pushstring(L, mcs->layout->stations[place.station].name);
    lua_pushinteger(L, place.slot);
    return 2;
}

/* native.lies(wafer, station, slot, dx, dy, tolerance): 0 when it does not lie in that slot, 1 when it does, 2 when with that
 * offset, too; its offset there; and the name of the station and the slot that it lies in, or nothing. The first decides, the
 * others are for telling. */
static int judge_place(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_decisions_claim_t claim;
    claim.wafer = wh_mcs_index(L, 1, mcs->state.wafer_count);
    claim.station = wh_mcs_index(L, 2, mcs->layout->station_count);
    claim.slot = wh_mcs_index(L, 3, (size_t)mcs->layout->places[claim.station].slots) + 1;
    claim.dx = luaL_checknumber(L, 4);
    claim.dy = luaL_checknumber(L, 5);
    claim.tolerance = luaL_checknumber(L, 6);
    const int32_t verdict = wh_decisions_judge(&claim, &mcs->simulator.cell, mcs->state.wafers);
    wh_decisions_claim(mcs->decisions, &claim, verdict);
    const wh_pose_t *base_from_wafer = &mcs->state.wafers[claim.wafer].base_from_wafer;
    wh_place_t place =
        wh_station_measure(&mcs->simulator.cell.stations[claim.station], claim.slot, base_from_wafer);
    lua_pushinteger(L, verdict);
    lua_pushnumber(L, place.dx);
    lua_pushnumber(L, place.dy);
    if (!wh_cell_locate(&mcs->simulator.cell, base_from_wafer, &place)) {
        return 3;
    }
    lua_pushstring(L, mcs->layout->stations[place.station].name);
    lua_pushinteger(L, place.slot);
    return 5;
}

/* native.wafer_pose(wafer): { r, R }, as the module wh takes it. */
static int read_wafer_pose(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_decisions_measured(mcs->decisions, "a wafer's pose");
    wh_lua_push_pose(L, &wafer_argument(L, mcs, 1)->base_from_wafer);
    return 1;
}

static wh_pose_t commanded_pose(const wh_mcs_t *mcs, int32_t gripper) {
    wh_pose_t poses[WH_GRIPPERS];
    if (mcs->layout->grippers[gripper].station != WH_NONE) {
        wh_decisions_measured(mcs->decisions, "a chuck's pose");
    }
    wh_machine_grippers(&wh_mcs_real(mcs)->machine, mcs->track.axes, poses);
    return poses[gripper];
}

/* native.gripper_pose(gripper): where motion control has it, also before the first slice. */
static int read_gripper_pose(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_pose_t pose = commanded_pose(mcs, wh_mcs_index(L, 1, mcs->state.gripper_count));
    wh_lua_push_pose(L, &pose);
    return 1;
}

/* native.real_gripper_pose(gripper): where it is, which a fault may keep from where motion control has it. */
static int read_real_gripper_pose(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    wh_pose_t pose = commanded_pose(mcs, gripper);
    if (mcs->state.seq > 0) {
        pose = mcs->state.grippers[gripper].base_from_gripper;
    }
    wh_lua_push_pose(L, &pose);
    return 1;
}

/* native.slot_pose(station, slot): where that slot really is. */
static int read_slot_pose(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_station_t *station = &wh_mcs_real(mcs)->places[wh_mcs_index(L, 1, mcs->layout->station_count)];
    const wh_pose_t pose = wh_station_slot(station, wh_mcs_index(L, 2, (size_t)station->slots) + 1);
    wh_decisions_measured(mcs->decisions, "where a slot is");
    wh_lua_push_pose(L, &pose);
    return 1;
}

/* native.relate(first, second): how the second of two poses lies as seen from the first: distance, dx, dy, dz, and the angle
 * and the whole turn in degrees. */
static int relate(lua_State *L) {
    const wh_field_t arguments[] = {wh_lua_argument("first", 1), wh_lua_argument("second", 2)};
    wh_pose_t poses[2];
    for (int i = 0; i < 2; ++i) {
        lua_pushvalue(L, i + 1);
        wh_lua_take_valid_pose(L, &arguments[i], &poses[i]);
    }
    const wh_relation_t relation = wh_relate(&poses[0], &poses[1]);
    lua_pushnumber(L, relation.distance);
    lua_pushnumber(L, relation.r.x);
    lua_pushnumber(L, relation.r.y);
    lua_pushnumber(L, relation.r.z);
    lua_pushnumber(L, wh_deg_from_rad(relation.angle));
    lua_pushnumber(L, wh_deg_from_rad(relation.turn));
    return 6;
}

const luaL_Reg wh_mcs_query_functions[] = {{"wafer", find_wafer},
                                           {"sensor", read_sensor},
                                           {"is_open", read_valve},
                                           {"holder", find_holder},
                                           {"measure", measure},
                                           {"locate", locate},
                                           {"lies", judge_place},
                                           {"wafer_pose", read_wafer_pose},
                                           {"gripper_pose", read_gripper_pose},
                                           {"real_gripper_pose", read_real_gripper_pose},
                                           {"slot_pose", read_slot_pose},
                                           {"relate", relate},
                                           {NULL, NULL}};
