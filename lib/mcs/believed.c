/* The believed places of slots, where motion control goes: from the layout, or from a host's later
 * command. */
#include "../layout/travel.h"
#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "native.h"

void wh_mcs_read_numbers(lua_State *L, int list, wh_real_t numbers[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        lua_rawgeti(L, list, (lua_Integer)i + 1);
        numbers[i] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
}

/* The slot's frame, displaced in its own axes by the numbers from stack index 3 on: dx, dy, dz. */
static wh_pose_t corrected_slot(lua_State *L, const wh_station_t *place, int32_t slot) {
    wh_pose_t base_from_slot = wh_station_slot(place, slot);
    const wh_vec3_t d = wh_vec3(luaL_checknumber(L, 3), luaL_checknumber(L, 4), luaL_checknumber(L, 5));
    if (wh_vec3_norm(&d) > 0) { /* else the slot's bits stay unchanged, also the sign of zeros */
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

/* A robot that tilts moves along the slot's own axes: `up` is its z, `rotation` the gripper's. */
static void push_tilted(lua_State *L, const wh_mat3_t *R, wh_real_t turn_deg) {
    const wh_vec3_t up = wh_mat3_column(R, 2);
    const wh_mat3_t turn = wh_mat3_from_rpy_deg(0, 0, turn_deg);
    const wh_mat3_t turned = wh_mat3_multiply(R, &turn);
    wh_lua_set_number(L, "dir_x", R->m[0][0]);
    wh_lua_set_number(L, "dir_y", R->m[1][0]);
    wh_lua_set_number(L, "dir_z", R->m[2][0]);
    wh_lua_push_numbers(L, &up.x, 3);
    lua_setfield(L, -2, "up");
    wh_lua_push_numbers(L, turned.m[0], 9);
    lua_setfield(L, -2, "rotation");
}

/* How a robot comes to a station; several robots come in different ways. */
typedef struct {
    double rail;
    wh_elbow_t elbow;
} approach_t;

/* Turns the slot towards the robot's way in, and moves it to the place that the robot was taught. */
static approach_t take_approach(const wh_layout_t *layout, size_t index, size_t robot,
                                wh_pose_t *base_from_slot) {
    const wh_layout_station_t *station = &layout->stations[index];
    if (!station->by) {
        return (approach_t){station->rail, station->elbow};
    }
    const wh_layout_approach_t *by = &station->by[robot];
    base_from_slot->R = by->is_turned ? by->R : base_from_slot->R;
    wh_taught_move(&layout->robots[robot].carrier.chain, by->rail, &by->aside, base_from_slot);
    return (approach_t){by->rail, by->elbow};
}

/* Chooses the axis that turns a set station: a robot that tilts moves along the slot's own axes, a level
 * one uses headings. */
static bool turns_in_slot(const wh_layout_t *layout, size_t robot) {
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, NULL);
    return carrier && carrier->chain.has_tilt;
}

/* Moves the slot with its station by the numbers { x, y, z, yaw } at this stack index, mm and rad. Yaw
 * turns it about the vertical through slot 1 as the robot was taught it; for a robot that tilts, about the
 * slot's z there. */
static void move_station(lua_State *L, int shift, const wh_layout_t *layout, size_t station, size_t robot,
                         wh_pose_t *base_from_slot) {
    wh_real_t by[4] = {0};
    wh_mcs_read_numbers(L, shift, by, 4);
    const bool in_slot = turns_in_slot(layout, robot);
    wh_pose_t first = wh_station_slot(&layout->places[station], 1);
    (void)take_approach(layout, station, robot, &first);
    const wh_mat3_t turn = wh_mat3_about_z(by[3]);
    const wh_mat3_t *R = &base_from_slot->R;
    wh_mat3_t turned = *R;
    wh_mat3_multiply_to(in_slot ? R : &turn, in_slot ? &turn : R, &turned);
    const wh_vec3_t off = wh_vec3_subtract(&base_from_slot->r, &first.r);
    const wh_vec3_t in = wh_mat3_transform_back(R, &off);
    const wh_vec3_t aside = wh_mat3_transform(&turned, &in);
    const wh_vec3_t to = wh_vec3(first.r.x + by[0], first.r.y + by[1], first.r.z + by[2]);
    base_from_slot->R = turned;
    base_from_slot->r = wh_vec3_add(&to, &aside);
}

wh_pose_t wh_mcs_believed_station(lua_State *L, int shift, const wh_mcs_t *mcs, size_t station,
                                  size_t robot) {
    const wh_station_t *place = &mcs->layout->places[station];
    const wh_vec3_t aside = wh_layout_aside(mcs->layout, station, robot);
    wh_pose_t believed = place->base_from_station;
    believed.r = wh_vec3_add(&believed.r, &aside);
    if (lua_istable(L, shift)) {
        move_station(L, shift, mcs->layout, station, robot, &believed);
    }
    return believed;
}

wh_vec3_t wh_mcs_drawn_aside(const wh_mcs_t *mcs, size_t station, size_t robot) {
    return mcs->local.trial ? wh_trial_cell_aside(mcs->local.trial, station, robot) : wh_vec3(0, 0, 0);
}

static void check_travel(lua_State *L, wh_mcs_t *mcs, const wh_real_t axes[]) {
    char reason[WH_TRAVEL_BYTES];
    const wh_status_t status = wh_machine_check_travel(&mcs->layout->machine, axes);
    if (status != WH_OK) {
        wh_travel_say_axes(mcs->layout, axes, reason);
        wh_mcs_raise(L, mcs, status, reason);
    }
}

/* native.shift(station, robot, gripper, axes, checked): { x, y, z, yaw }, mm and rad, the station's shift
 * from its place in the layout if the gripper stands in its slot 1 at these axes. With `checked` it
 * refuses axes beyond their travel. */
static int find_shift(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_layout_t *layout = mcs->layout;
    const size_t station = (size_t)wh_mcs_index(L, 1, layout->station_count);
    const size_t robot = (size_t)wh_mcs_index(L, 2, wh_machine_robots(&layout->machine));
    const int32_t gripper = wh_mcs_index(L, 3, layout->machine.gripper_count);
    wh_real_t axes[WH_AXES] = {0};
    wh_pose_t poses[WH_GRIPPERS];
    wh_mcs_read_numbers(L, 4, axes, layout->machine.axis_count);
    if (lua_toboolean(L, 5)) {
        check_travel(L, mcs, axes);
    }
    wh_pose_t slot = wh_station_slot(&layout->places[station], 1);
    (void)take_approach(layout, station, robot, &slot);
    wh_machine_grippers(&layout->machine, axes, poses);
    const wh_vec3_t by = wh_vec3_subtract(&poses[gripper].r, &slot.r);
    const wh_vec3_t was = wh_mat3_column(&slot.R, 0);
    const wh_vec3_t is = wh_mat3_column(&poses[gripper].R, 0);
    const wh_vec3_t up = turns_in_slot(layout, robot) ? wh_mat3_column(&slot.R, 2) : wh_vec3(0, 0, 1);
    const wh_vec3_t across = wh_vec3_cross(&was, &is);
    const wh_real_t along = wh_vec3_dot(&was, &is) - wh_vec3_dot(&was, &up) * wh_vec3_dot(&is, &up);
    const wh_real_t yaw = wh_atan2(wh_vec3_dot(&up, &across), along);
    const wh_real_t shift[] = {by.x, by.y, by.z, yaw};
    wh_lua_push_numbers(L, shift, 4);
    return 1;
}

/* native.slot(station, slot, dx, dy, dz, turn, robot, shift, undrawn): { x, y, z, dir_x, dir_y, heading }
 * of the gripper there, displaced in the slot's axes (mm) and turned about its z (degrees); of a station
 * that a host has moved by `shift`, see native.shift. The way in, projected to horizontal, is beside the
 * taught one and goes the same way: it is not turned. In a trial a robot was taught it elsewhere, unless
 * `undrawn`, or the layout's reach is judged: a draw does not make a layout unfit, but fails the command
 * that goes there. */
static int find_believed_slot(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const bool is_drawn = mcs->local.trial && !lua_toboolean(L, 9) && mcs->rehearsal.reach_slot == 0;
    const wh_station_t *place = &mcs->layout->places[station];
    const int32_t slot = wh_mcs_index(L, 2, (size_t)place->slots) + 1;
    const size_t robot = (size_t)luaL_optinteger(L, 7, 1) - 1;
    if (mcs->rehearsal.reach_slot == 0) {
        wh_decisions_visit(mcs->wanted.decisions, station, (int32_t)robot);
    }
    wh_pose_t base_from_slot = corrected_slot(L, place, slot);
    const approach_t way = take_approach(mcs->layout, (size_t)station, robot, &base_from_slot);
    if (mcs->layout->stations[station].by && is_drawn) {
        wh_trial_cell_teach(mcs->local.trial, (size_t)station, robot, way.rail, &base_from_slot);
    }
    if (lua_istable(L, 8)) {
        move_station(L, 8, mcs->layout, (size_t)station, robot, &base_from_slot);
    }
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
    if (mcs->layout->machine.carrier) {
        wh_lua_set_number(L, "rail", way.rail);
        wh_lua_set_integer(L, "elbow", (lua_Integer)way.elbow);
        if (wh_machine_carrier(&mcs->layout->machine, robot, NULL)->chain.has_tilt) {
            push_tilted(L, &base_from_slot.R, luaL_checknumber(L, 6));
        }
    }
    return 1;
}

const luaL_Reg wh_mcs_believed_functions[] = {
    {"slot", find_believed_slot}, {"shift", find_shift}, {NULL, NULL}};
