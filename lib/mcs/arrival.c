/* The end switches of mechanisms tell whether a door, or a gripper's carrier, is where motion control has
 * commanded it. A state tells their true places; the switches are good to a tenth of a millimetre and of a
 * degree. */
#include "../script/wh_module_values.h"
#include "clocks.h"
#include "native.h"
#include "playing.h"

#define SWITCH_MM WH_REAL(0.1)
#define SWITCH_RAD WH_REAL(0.0017)

/* True before the first slice, when everything is at home. */
static bool is_door_there(const wh_mcs_t *mcs, int32_t door, wh_real_t at) {
    const wh_physics_state_t *physics = mcs->state.physics;
    const wh_door_t *of = &mcs->layout->machine.doors[door];
    const bool is_told = physics && door < physics->doors.count;
    const wh_real_t is_at = is_told ? physics->doors.at[door] : wh_door_home(of);
    return wh_real_abs(is_at - at) <= SWITCH_MM;
}

static bool is_gripper_there(const wh_mcs_t *mcs, int32_t gripper) {
    wh_pose_t poses[WH_GRIPPERS];
    if (mcs->state.seq == 0) {
        return true;
    }
    wh_machine_grippers(&mcs->real->machine, mcs->track.axes, poses);
    const wh_pose_t *is = &mcs->state.grippers[gripper].base_from_gripper;
    const wh_vec3_t apart = wh_vec3_subtract(&is->r, &poses[gripper].r);
    bool same = wh_vec3_norm(&apart) <= SWITCH_MM;
    for (size_t i = 0; same && i < 9; ++i) {
        same = wh_real_abs(is->R.m[i / 3][i % 3] - poses[gripper].R.m[i / 3][i % 3]) <= SWITCH_RAD;
    }
    return same;
}

static bool has_arrived(const wh_mcs_t *mcs, const wh_awaited_t *awaited) {
    if (awaited->kind == WH_AWAITED_DOOR) {
        const size_t axis = wh_machine_door_axis(&mcs->layout->machine, (size_t)awaited->index);
        return is_door_there(mcs, awaited->index, mcs->track.axes[axis]);
    }
    if (awaited->kind == WH_AWAITED_STATION) {
        return wh_mcs_is_station_idle(mcs, awaited->index);
    }
    if (awaited->kind == WH_AWAITED_LOCK) {
        return !wh_mcs_is_pumping(mcs, awaited->index);
    }
    if (awaited->kind == WH_AWAITED_PORT) {
        return wh_mcs_does_port_stand(mcs, awaited->index);
    }
    return is_gripper_there(mcs, awaited->index);
}

uint32_t wh_mcs_sensors(const wh_mcs_t *mcs, const wh_awaited_t *awaited) {
    if (awaited->kind == WH_AWAITED_VACUUM) {
        return mcs->state.sensors;
    }
    return has_arrived(mcs, awaited) ? UINT32_MAX : 0;
}

void wh_mcs_await_arrival(lua_State *L, wh_mcs_t *mcs, wh_segment_t *segment, wh_awaited_t *awaited) {
    const wh_machine_t *machine = &mcs->layout->machine;
    const struct {
        const char *field;
        wh_awaited_kind_t kind;
        size_t count;
    } kinds[] = {{"door", WH_AWAITED_DOOR, machine->door_count},
                 {"gripper", WH_AWAITED_GRIPPER, machine->gripper_count},
                 {"station", WH_AWAITED_STATION, mcs->layout->station_count},
                 {"lock", WH_AWAITED_LOCK, mcs->layout->station_count},
                 {"port", WH_AWAITED_PORT, mcs->layout->station_count}};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        if (lua_getfield(L, -1, kinds[i].field) != LUA_TNIL) {
            awaited->kind = kinds[i].kind;
            awaited->index = wh_mcs_index(L, -1, kinds[i].count);
        }
        lua_pop(L, 1);
    }
    lua_getfield(L, 1, "timeout");
    segment->kind = WH_SEGMENT_SENSOR;
    segment->gripper = 0; /* any gripper: all sensor bits are on, or none */
    segment->seconds = luaL_checknumber(L, -1);
    lua_pop(L, 1);
    wh_decisions_measured(mcs->wanted.decisions, "if a mechanism has arrived");
}

/* native.door(door): "open", "shut" or "moving", by its switches; and its opening, mm. */
static int read_door(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t door = wh_mcs_index(L, 1, mcs->layout->machine.door_count);
    const wh_door_t *of = &mcs->layout->machine.doors[door];
    const bool is_told = mcs->state.physics && door < mcs->state.physics->doors.count;
    wh_decisions_measured(mcs->wanted.decisions, "where a door is");
    lua_pushstring(L, wh_mcs_door_word(mcs, (size_t)door));
    lua_pushnumber(L, is_told ? mcs->state.physics->doors.at[door] : wh_door_home(of));
    return 2;
}

const char *wh_mcs_door_word(const wh_mcs_t *mcs, size_t door) {
    if (is_door_there(mcs, (int32_t)door, mcs->layout->machine.doors[door].travel)) {
        return "open";
    }
    return is_door_there(mcs, (int32_t)door, 0) ? "shut" : "moving";
}

/* native.arrived(gripper): true if its carrier is where motion control has commanded it. Without a running
 * command, a pattern is only tried or planned, and the answer is true. */
static int read_arrived(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->layout->machine.gripper_count);
    wh_decisions_measured(mcs->wanted.decisions, "where a flipper is");
    lua_pushboolean(L, mcs->recorder.running == WH_NONE || is_gripper_there(mcs, gripper));
    return 1;
}

const luaL_Reg wh_mcs_arrival_functions[] = {{"door", read_door}, {"arrived", read_arrived}, {NULL, NULL}};
