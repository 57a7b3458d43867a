/* Centring on the way: the beams at a station's door are armed with the next slice's command, the latches
 * that the states bring are collected, and the wafer's centre on its blade is found from them.
 *
 * From the arming on, motion control remembers the commanded places of the blade, slice by slice. */
#include "../script/wh_module_values.h"
#include "native.h"

/* ------------------------------------------------------------------------------------------- the estimate */

static double field_or(lua_State *L, const char *name, double fallback) {
    lua_getfield(L, 1, name);
    const double value = luaL_optnumber(L, -1, fallback);
    lua_pop(L, 1);
    return value;
}

/* The known values of the wafer: from the layout, or from the argument's fields. */
static wh_centring_t known_of(lua_State *L, const wh_mcs_t *mcs) {
    const double radius = field_or(L, "radius", mcs->layout->wafer_diameter / 2);
    wh_centring_t known = wh_centring_known(mcs->layout, &mcs->measuring.pass.order, radius);
    known.sd_radius = field_or(L, "sd_radius", known.sd_radius);
    known.sd_notch = field_or(L, "sd_notch", -1);
    known.notch_known = known.sd_notch >= 0;
    known.notch_direction = known.notch_known ? field_or(L, "notch", 0) : 0;
    known.sd_notch = known.notch_known ? known.sd_notch : 0;
    return known;
}

static void keep_centring(wh_mcs_t *mcs) {
    wh_centring_record_t *centring = &mcs->measuring.centring;
    centring->command = mcs->recorder.running;
    centring->wafer = mcs->state.grippers[centring->gripper].wafer;
    wh_record_add_centring(mcs->recorder.record, centring);
}

/* ------------------------------------------------------------------------------------------------ for Lua */

static void push_crossing(lua_State *L, const wh_mcs_t *mcs, size_t i) {
    const wh_pass_crossing_t *of = &mcs->measuring.centring.crossings[i];
    lua_createtable(L, 0, 6);
    const wh_latch_order_t all = wh_layout_beams_at(mcs->layout, (size_t)mcs->measuring.centring.station);
    wh_lua_set_integer(L, "beam", of->crossing.beam - all.first + 1);
    wh_lua_set_text(L, "edge", of->crossing.edge == WH_CROSSING_IN ? "in" : "out");
    wh_lua_set_number(L, "x", of->crossing.x);
    wh_lua_set_number(L, "y", of->crossing.y);
    wh_lua_set_number(L, "time", of->time);
    wh_lua_set_text(L, "use", wh_centring_use(&mcs->measuring.centring, 0, i));
}

static void push_centre(lua_State *L, const wh_centre_t *centre) {
    lua_createtable(L, 0, 8);
    wh_lua_set_number(L, "x", centre->x);
    wh_lua_set_number(L, "y", centre->y);
    wh_lua_set_number(L, "radius", centre->radius);
    wh_lua_set_number(L, "sd_x", centre->sd_x);
    wh_lua_set_number(L, "sd_y", centre->sd_y);
    wh_lua_set_number(L, "sd", centre->sd_centre);
    wh_lua_set_number(L, "mismatch", centre->mismatch);
    wh_lua_set_integer(L, "used", centre->used);
}

static void push_centring(lua_State *L, const wh_mcs_t *mcs) {
    const wh_centring_record_t *centring = &mcs->measuring.centring;
    lua_createtable(L, 0, 4);
    wh_lua_set_integer(L, "error", centring->status);
    wh_lua_set_integer(L, "missed", centring->missed);
    lua_createtable(L, (int)centring->count, 0);
    for (size_t i = 0; i < centring->count; ++i) {
        push_crossing(L, mcs, i);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "crossings");
    lua_createtable(L, centring->centres.count, 0);
    for (int32_t i = 0; i < centring->centres.count; ++i) {
        push_centre(L, &centring->centres.candidates[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "candidates");
}

/* The places of a station's beams as this gripper's robot believes them. If a host has moved the station,
 * they move with it by the shift at this stack index; its field `beams`, { x, y } in base, mm, is the further
 * offset that TEACH has found. In a trial they are drawn, too. */
static wh_pose_t believed_beams(lua_State *L, int shift, const wh_mcs_t *mcs, int32_t station,
                                int32_t gripper) {
    const size_t robot = mcs->layout->machine.mounts[gripper].robot;
    const wh_vec3_t drawn = wh_mcs_drawn_aside(mcs, (size_t)station, robot);
    wh_pose_t believed = wh_mcs_believed_station(L, shift, mcs, (size_t)station, robot);
    believed.r = wh_vec3_add(&believed.r, &drawn);
    if (lua_istable(L, shift) && lua_getfield(L, shift, "beams") == LUA_TTABLE) {
        wh_real_t beside[2] = {0};
        wh_mcs_read_numbers(L, lua_gettop(L), beside, 2);
        believed.r.x += beside[0];
        believed.r.y += beside[1];
    }
    return believed;
}

void wh_mcs_arm(wh_mcs_t *mcs, wh_latch_order_t order, int32_t station, int32_t gripper,
                const wh_pose_t *believed) {
    wh_pass_t *pass = &mcs->measuring.pass;
    wh_pass_free(pass);
    *pass = (wh_pass_t){.order = order,
                        .station = station,
                        .gripper = gripper,
                        .believed = *believed,
                        .before = pass->number,
                        .number = pass->number,
                        .seq = pass->seq,
                        .goes_on = true};
    mcs->command.latch = order;
}

/* The station at stack index 1, and the beams that the robot of the gripper at 2 passes there. */
static wh_latch_order_t read_pass(lua_State *L, const wh_mcs_t *mcs, int32_t *station, int32_t *gripper) {
    *station = wh_mcs_index(L, 1, mcs->layout->station_count);
    *gripper = wh_mcs_index(L, 2, mcs->layout->machine.gripper_count);
    const size_t robot = mcs->layout->machine.mounts[*gripper].robot;
    const wh_latch_order_t order = wh_layout_beams_of(mcs->layout, (size_t)*station, robot);
    luaL_argcheck(L, order.count > 0, 1, "no beams on the way in");
    return order;
}

/* native.arm_beams(station, gripper, shift): from the end of the next slice on, the beams that this
 * gripper passes on its way to the station latch each crossing, and its way is remembered. For a station
 * that a host has moved, see native.shift. Data collected before is deleted. */
static int arm_beams(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    int32_t station = 0;
    int32_t gripper = 0;
    const wh_latch_order_t order = read_pass(L, mcs, &station, &gripper);
    const wh_pose_t believed = believed_beams(L, 3, mcs, station, gripper);
    wh_mcs_arm(mcs, order, station, gripper, &believed);
    return 0;
}

/* native.disarm_beams(): with the next slice. */
static int disarm_beams(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    mcs->command.latch = (wh_latch_order_t){.kind = WH_LATCH_DISARM};
    mcs->measuring.pass.goes_on = false;
    return 0;
}

/* native.centre { notch = , sd_notch = , radius = , sd_radius = }: the wafer's centre on the blade that
 * passed the beams since arm_beams. The arguments, if they are known: the notch's direction in the blade's
 * frame, rad, with its deviation, and a radius other than the layout's, mm. Returns { error = the status, 0
 * if it is sure, missed = the number of latches that motion control did not get, crossings = in their order {
 * beam = from 1 at that station, edge = "in" or "out", x, y = on the blade, mm, time = s, use = "rim",
 * "notch" or "other" by the first candidate, "none" without one }, candidates = { x, y, radius, sd_x, sd_y,
 * sd, mismatch, used } }. */
static int centre_wafer(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    luaL_checktype(L, 1, LUA_TTABLE);
    luaL_argcheck(L, mcs->measuring.pass.order.count > 0, 1, "no beams were armed");
    wh_decisions_measured(mcs->wanted.decisions, "centring on the way");
    const wh_centring_t known = known_of(L, mcs);
    wh_centring_estimate(&mcs->measuring.pass, mcs->layout, &known, &mcs->measuring.centring);
    keep_centring(mcs);
    wh_mcs_tell(mcs, WH_MCS_CENTRED, NULL);
    push_centring(L, mcs);
    return 1;
}

/* native.beam(station, gripper, shift): { x, y } in base, mm: the believed place of the first beam that
 * this gripper passes on its way to the station, at the height of slot 1; and the beam's number there,
 * from 1. For a station that a host has moved, see native.shift. */
static int push_beam(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    int32_t station = 0;
    int32_t gripper = 0;
    const wh_latch_order_t order = read_pass(L, mcs, &station, &gripper);
    const wh_pose_t believed = believed_beams(L, 3, mcs, station, gripper);
    const wh_beam_t beam = wh_pass_beam(mcs->layout, order.first, &believed);
    lua_createtable(L, 0, 3);
    wh_lua_set_number(L, "x", beam.x);
    wh_lua_set_number(L, "y", beam.y);
    wh_lua_set_integer(L, "number", order.first - wh_layout_beams_at(mcs->layout, (size_t)station).first + 1);
    return 1;
}

const luaL_Reg wh_mcs_centring_functions[] = {{"beam", push_beam},
                                              {"arm_beams", arm_beams},
                                              {"disarm_beams", disarm_beams},
                                              {"centre", centre_wafer},
                                              {NULL, NULL}};
