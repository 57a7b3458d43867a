/* The tables that a dialect's functions are given: of a result, and of what STATUS tells. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "../record/record.h"
#include "../script/wh_module_values.h"
#include "dialect_internal.h"
#include "values.h"

void wh_dialect_push(lua_State *L, const char *field, const char *within) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    lua_getfield(L, -1, field);
    lua_remove(L, -2);
    if (within) {
        lua_getfield(L, -1, within);
        lua_remove(L, -2);
    }
}

void wh_dialect_set_error(lua_State *L, const wh_dialect_t *dialect, wh_status_t number, const char *code) {
    wh_lua_set_boolean(L, "ok", number == WH_OK);
    wh_lua_set_integer(L, "number", number);
    if (number != WH_OK) {
        wh_lua_set_text(L, "name", wh_status_name(number));
        wh_lua_set_text(L, "code", code[0] != '\0' ? code : wh_dialect_code(dialect, number));
        wh_lua_set_text(L, "text", wh_record_error_text(number));
    }
}

/* Sets `state`, theirs, of the table on top of the stack. */
static void set_state(lua_State *L, const wh_result_t *result) {
    char phase[WH_DIALECT_NAME_BYTES];
    wh_value_copy(result->status, "phase", phase, sizeof phase);
    wh_dialect_push(L, "states", NULL);
    if (lua_istable(L, -1)) {
        lua_getfield(L, -1, result->is_held ? "held" : phase);
        lua_setfield(L, -3, "state");
    }
    lua_pop(L, 1);
}

/* The port's robot; the first robot if the port has none or stands for the whole cell. */
static size_t find_robot(const wh_result_t *result) {
    const wh_port_mechanism_t *mechanism = result->mechanism;
    const bool is_named = mechanism->kind == WH_MECHANISM_ROBOT && mechanism->name;
    return result->layout->robot_count > 1 && is_named ? (size_t)mechanism->index : 0;
}

/* The name of an axis in STATUS: with several robots its robot's name comes first. */
static void name_axis(const wh_result_t *result, const char *axis, char name[WH_DIALECT_LINE_BYTES]) {
    const wh_layout_t *layout = result->layout;
    char robot[WH_DIALECT_NAME_BYTES * (size_t)3] = "";
    const bool has_several = layout->robot_count > 1;
    if (has_several) {
        (void)wh_value_spell(layout->robots[find_robot(result)].name, robot, sizeof robot);
    }
    (void)snprintf(name, WH_DIALECT_LINE_BYTES, "%s%s%s", robot, has_several ? "." : "", axis);
}

/* The sign of an axis in their direction. */
static double sign_of(const wh_dialect_t *dialect, const char *axis) {
    static const char *const signed_axes[] = {"theta", "r", "z", "yaw"};
    for (size_t i = 0; i < sizeof signed_axes / sizeof signed_axes[0]; ++i) {
        if (strcmp(axis, signed_axes[i]) == 0) {
            return dialect->units.signs[i];
        }
    }
    return 1;
}

static void set_axis(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result, size_t axis) {
    const wh_machine_t *machine = &result->layout->machine;
    const char *own = wh_axis_name(machine, axis);
    const double unit = wh_axis_turns(machine, axis) ? dialect->units.angle : dialect->units.length;
    char name[WH_DIALECT_LINE_BYTES];
    name_axis(result, own, name);
    const double at = strtod(wh_value_begin(result->status, name), NULL);
    wh_lua_set_number(L, own, sign_of(dialect, own) * at / unit + 0.0); /* no -0 */
}

/* Sets only the axes that the robot has. */
static void set_position(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result) {
    const wh_machine_t *machine = result->layout ? &result->layout->machine : NULL;
    lua_createtable(L, 0, WH_CHAIN_AXES);
    for (size_t axis = 0; machine && axis < wh_machine_robot_axes(machine); ++axis) {
        size_t own;
        if (wh_machine_robot_of(machine, axis, &own) == (int32_t)find_robot(result) &&
            wh_axis_exists(machine, axis)) {
            set_axis(L, dialect, result, axis);
        }
    }
    lua_setfield(L, -2, "position");
}

/* Sets fields by our name of a gripper, as it is typed. */
static void set_sensors(lua_State *L, const wh_result_t *result) {
    const wh_layout_t *layout = result->layout;
    char spelt[WH_DIALECT_LINE_BYTES];
    lua_newtable(L);
    for (size_t g = 0; layout && g < layout->machine.gripper_count; ++g) {
        const bool is_its_own = (result->mechanism->grippers >> g & 1U) != 0;
        if (is_its_own && wh_value_spell(layout->grippers[g].name, spelt, sizeof spelt)) {
            wh_lua_set_boolean(L, spelt, (result->sensors >> g & 1U) != 0);
        }
    }
    lua_setfield(L, -2, "sensors");
}

/* Sets one number of a pose in their unit. */
static void set_turned(lua_State *L, const char *name, double value, double unit, double sign) {
    wh_lua_set_number(L, name, sign * value / unit + 0.0); /* no -0 */
}

/* Pushes a gripper's pose: its origin in base, the direction of its x axis, and its robot's elbow, if it has
 * one: 1 right, 2 left. */
static void push_pose(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result, size_t g) {
    const wh_pose_t *pose = &result->poses[g];
    const wh_machine_t *machine = &result->layout->machine;
    const double degrees = 180 / WH_PI;
    lua_createtable(L, 0, 5);
    set_turned(L, "x", pose->r.x, dialect->units.length, 1);
    set_turned(L, "y", pose->r.y, dialect->units.length, 1);
    set_turned(L, "z", pose->r.z, dialect->units.length, dialect->units.signs[2]);
    set_turned(L, "yaw", degrees * wh_atan2(pose->R.m[1][0], pose->R.m[0][0]), dialect->units.angle, 1);
    for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
        size_t own;
        char name[WH_DIALECT_LINE_BYTES];
        const char *word = wh_axis_name(machine, axis);
        const bool is_own = wh_machine_robot_of(machine, axis, &own) == (int32_t)find_robot(result);
        if (is_own && strcmp(word, "forearm") == 0) {
            name_axis(result, word, name);
            wh_lua_set_integer(L, "elbow", strtod(wh_value_begin(result->status, name), NULL) < 0 ? 2 : 1);
        }
    }
}

/* Sets the poses of the port's blades by our names, as they are typed. */
static void set_poses(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result) {
    const wh_layout_t *layout = result->layout;
    char spelt[WH_DIALECT_LINE_BYTES];
    lua_newtable(L);
    for (size_t g = 0; layout && result->poses && g < layout->machine.gripper_count; ++g) {
        const bool is_its_own =
            (result->mechanism->grippers >> g & 1U) != 0 && layout->grippers[g].station == WH_NONE;
        if (is_its_own && wh_value_spell(layout->grippers[g].name, spelt, sizeof spelt)) {
            push_pose(L, dialect, result, g);
            lua_setfield(L, -2, spelt);
        }
    }
    lua_setfield(L, -2, "poses");
}

/* Sets what its robot's own controller has; an empty table without a cell. */
static void set_controller(lua_State *L, const wh_result_t *result) {
    wh_push_values(L, result->controller ? result->controller : "");
    lua_setfield(L, -2, "controller");
}

static void set_status(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result) {
    set_controller(L, result);
    wh_lua_set_boolean(L, "is_held", result->is_held);
    wh_push_values(L, result->status);
    lua_setfield(L, -2, "status");
    set_state(L, result);
    set_position(L, dialect, result);
    set_sensors(L, result);
}

void wh_dialect_push_now(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *now) {
    lua_newtable(L);
    set_status(L, dialect, now);
    set_poses(L, dialect, now);
}

void wh_dialect_push_result(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result) {
    lua_newtable(L);
    wh_dialect_set_error(L, dialect, result->number, "");
    wh_lua_set_text(L, "answer", result->answer);
    wh_lua_set_number(L, "seconds", result->seconds);
    wh_push_values(L, result->answer);
    lua_setfield(L, -2, "values");
    set_status(L, dialect, result);
    set_poses(L, dialect, result);
}
