#include "controller.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "../text/nearest.h"
#include "native.h"

/* ------------------------------------------------------------------------------------------------- values */

/* A value that is a word: the first one refuses nothing. */
typedef struct {
    const char *name;
    const char *words[4];
    size_t offset;
} word_row_t;

static const word_row_t rows[] = {
    {"power", {"on", "off"}, offsetof(wh_mcs_controller_t, is_off)},
    {"brakes", {"released", "set"}, offsetof(wh_mcs_controller_t, is_braked)},
    {"estop", {"off", "on"}, offsetof(wh_mcs_controller_t, is_pressed)},
    {"servo", {"ok", "error"}, offsetof(wh_mcs_controller_t, has_failed)},
    {"mode", {"automatic", "manual", "remote"}, offsetof(wh_mcs_controller_t, mode)}};
enum { ROWS = sizeof rows / sizeof rows[0] };

#define LEAST_OVERRIDE 1e-3

/* All names, for messages. */
static const char *const names[] = {"power",    "brakes", "estop",    "servo", "mode",
                                    "exceeded", "at",     "override", NULL};
enum { NAMES = sizeof names / sizeof names[0] - 1 };

static int32_t *member_of(wh_mcs_controller_t *controller, const word_row_t *row) {
    return (int32_t *)(void *)((char *)controller + row->offset);
}

static int32_t value_of(const wh_mcs_controller_t *controller, const word_row_t *row) {
    wh_mcs_controller_t copy = *controller;
    copy.is_pressed = copy.is_pressed || copy.is_struck;
    return *member_of(&copy, row);
}

static bool is_pressed(const wh_mcs_controller_t *controller) {
    return controller->is_pressed != 0 || controller->is_struck != 0;
}

/* An axis as it is told: degrees or mm. */
static double told_place(const wh_machine_t *machine, size_t axis, double at) {
    return wh_axis_turns(machine, axis) ? (double)wh_deg_from_rad((wh_real_t)at) : at;
}

/* ------------------------------------------------------------------------------------------------ changes */

__attribute__((format(printf, 2, 3))) static wh_status_t refuse_change(char reason[WH_MCS_CHANGE_BYTES],
                                                                       const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(reason, WH_MCS_CHANGE_BYTES, format, arguments);
    va_end(arguments);
    return WH_STATUS_BAD_ARGUMENT;
}

static wh_status_t take_word(wh_mcs_controller_t *to, const word_row_t *row, const char *value,
                             char reason[WH_MCS_CHANGE_BYTES]) {
    char known[100] = "";
    for (int32_t i = 0; row->words[i]; ++i) {
        if (strcasecmp(value, row->words[i]) == 0) {
            *member_of(to, row) = i;
            return WH_OK;
        }
        (void)snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i > 0 ? ", " : "",
                       row->words[i]);
    }
    return refuse_change(reason, "%s: \"%.60s\" (expected %s)", row->name, value, known);
}

static bool read_number(const char *text, double *value) {
    char *end = NULL;
    *value = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*value);
}

static wh_status_t take_override(wh_mcs_controller_t *to, const char *value,
                                 char reason[WH_MCS_CHANGE_BYTES]) {
    double part = 0;
    if (!read_number(value, &part) || part < LEAST_OVERRIDE || part > 1) {
        return refuse_change(reason, "override: %.60s (expected a number from 0.001 to 1)", value);
    }
    to->override = part < 1 ? part : 0;
    return WH_OK;
}

/* The robot's axis of this name; WH_NONE, with the names that it has in `known`, if there is none. */
static int32_t find_axis(const wh_mcs_t *mcs, size_t robot, const char *name, char *known, size_t size) {
    const wh_machine_t *machine = &mcs->layout->machine;
    known[0] = '\0';
    for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
        size_t own = 0;
        if (wh_machine_robot_of(machine, axis, &own) != (int32_t)robot || !wh_axis_exists(machine, axis)) {
            continue;
        }
        if (strcmp(name, wh_axis_name(machine, axis)) == 0) {
            return (int32_t)axis;
        }
        (void)snprintf(known + strlen(known), size - strlen(known), "%s%s", known[0] ? ", " : "",
                       wh_axis_name(machine, axis));
    }
    return WH_NONE;
}

/* An axis beyond its soft limit. `place` null: it was not said. */
static wh_status_t take_exceeded(const wh_mcs_t *mcs, size_t robot, wh_mcs_controller_t *to, const char *name,
                                 const char *place, char reason[WH_MCS_CHANGE_BYTES]) {
    const wh_machine_t *machine = &mcs->layout->machine;
    char known[200];
    double at = 0;
    to->exceeded = 0;
    to->at = 0;
    if (strcmp(name, "none") == 0) {
        return place ? refuse_change(reason, "at: %.60s (expected none beside exceeded = none)", place)
                     : WH_OK;
    }
    const int32_t axis = find_axis(mcs, robot, name, known, sizeof known);
    if (axis == WH_NONE) {
        return refuse_change(reason, "exceeded: \"%.60s\" (expected none or an axis: %s)", name, known);
    }
    const bool turns = wh_axis_turns(machine, (size_t)axis);
    if (!place || !read_number(place, &at) || fabs(at) > 1e6) {
        return refuse_change(reason, "at: %.60s (expected where %s stands, a number of %s)",
                             place ? place : "nothing", name, turns ? "degrees" : "mm");
    }
    to->exceeded = axis + 1;
    to->at = turns ? (double)wh_rad_from_deg((wh_real_t)at) : at;
    return WH_OK;
}

static const char *find_value(const wh_mcs_change_t changes[], size_t count, const char *name) {
    const char *value = NULL;
    for (size_t i = 0; i < count; ++i) {
        value = strcmp(changes[i].name, name) == 0 ? changes[i].value : value;
    }
    return value;
}

static wh_status_t refuse_name(const char *name, char reason[WH_MCS_CHANGE_BYTES]) {
    char known[200] = "";
    char meant[WH_NEAREST_TEXT];
    for (size_t i = 0; i < NAMES; ++i) {
        (void)snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i > 0 ? ", " : "",
                       names[i]);
    }
    return refuse_change(reason, "%.60s: no such field (expected %s%s)", name, known,
                         wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(name, names, NAMES)));
}

static const word_row_t *find_row(const char *name) {
    for (size_t i = 0; i < ROWS; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return &rows[i];
        }
    }
    return NULL;
}

static wh_status_t take_change(const wh_mcs_t *mcs, size_t robot, wh_mcs_controller_t *to,
                               const wh_mcs_change_t changes[], size_t count, const wh_mcs_change_t *change,
                               char reason[WH_MCS_CHANGE_BYTES]) {
    const word_row_t *row = find_row(change->name);
    const char *place = find_value(changes, count, "at");
    if (row) {
        return take_word(to, row, change->value, reason);
    }
    if (strcmp(change->name, "override") == 0) {
        return take_override(to, change->value, reason);
    }
    if (strcmp(change->name, "exceeded") == 0) {
        return take_exceeded(mcs, robot, to, change->value, place, reason);
    }
    if (strcmp(change->name, "at") != 0) {
        return refuse_name(change->name, reason);
    }
    return find_value(changes, count, "exceeded")
               ? WH_OK
               : refuse_change(reason, "at: %.60s (expected `exceeded`, its axis, beside it)", change->value);
}

/* The fault of this kind that acts on the robot in this slice; 0: none; else its number. */
static size_t find_fault(const wh_mcs_t *mcs, wh_fault_kind_t kind, size_t robot, int64_t slice) {
    for (size_t i = 0; i < mcs->armed.fault_count; ++i) {
        const wh_fault_t *fault = &mcs->armed.faults[i];
        if (fault->kind == kind && fault->target == (int32_t)robot && fault->from <= slice &&
            slice < fault->until) {
            return i + 1;
        }
    }
    return 0;
}

/* A condition that a fault causes is not cleared while the fault lasts. */
static wh_status_t check_faults(const wh_mcs_t *mcs, size_t robot, const wh_mcs_change_t changes[],
                                size_t count, char reason[WH_MCS_CHANGE_BYTES]) {
    static const struct {
        const char *name, *value;
        wh_fault_kind_t kind;
        wh_status_t status;
    } clears[] = {{"power", "on", WH_FAULT_POWER_LOST, WH_STATUS_NO_POWER},
                  {"estop", "off", WH_FAULT_EMERGENCY_STOP, WH_STATUS_EMERGENCY_STOP},
                  {"servo", "ok", WH_FAULT_SERVO_ERROR, WH_STATUS_SERVO_ERROR}};
    for (size_t i = 0; i < sizeof clears / sizeof clears[0]; ++i) {
        const char *value = find_value(changes, count, clears[i].name);
        const size_t number = find_fault(mcs, clears[i].kind, robot, mcs->track.slice + 1);
        if (value && strcmp(value, clears[i].value) == 0 && number > 0) {
            (void)refuse_change(reason, "%s: %s (expected the end of fault %zu, %s, first)", clears[i].name,
                                value, number, wh_fault_name(clears[i].kind));
            return clears[i].status;
        }
    }
    return WH_OK;
}

/* The power goes with the emergency stop. */
static wh_status_t check_power(wh_mcs_controller_t *to, const wh_mcs_change_t changes[], size_t count,
                               char reason[WH_MCS_CHANGE_BYTES]) {
    const char *power = find_value(changes, count, "power");
    if (!is_pressed(to)) {
        return WH_OK;
    }
    to->is_off = 1;
    if (power && strcmp(power, "on") == 0) {
        (void)refuse_change(reason, "power: on (expected estop = off first)");
        return WH_STATUS_EMERGENCY_STOP;
    }
    return WH_OK;
}

wh_status_t wh_mcs_change_controller(wh_mcs_t *mcs, size_t robot, const wh_mcs_change_t changes[],
                                     size_t count, char reason[WH_MCS_CHANGE_BYTES]) {
    wh_mcs_controller_t to = mcs->armed.controllers[robot];
    wh_status_t status = check_faults(mcs, robot, changes, count, reason);
    for (size_t i = 0; i < count && status == WH_OK; ++i) {
        status = take_change(mcs, robot, &to, changes, count, &changes[i], reason);
    }
    status = status == WH_OK ? check_power(&to, changes, count, reason) : status;
    if (status == WH_OK) {
        wh_decisions_measured(mcs->wanted.decisions, "a controller's own state");
        mcs->armed.controllers[robot] = to;
        wh_mcs_end_refused_motion(mcs, robot);
    }
    return status;
}

/* ---------------------------------------------------------------------------------------- what it refuses */

/* "robot R1: " of several. */
static const char *name_robot(const wh_mcs_t *mcs, size_t robot, char text[2 * WH_NAME_SIZE]) {
    const bool is_one = mcs->layout->robot_count < 2;
    (void)snprintf(text, (size_t)(2 * WH_NAME_SIZE), "%s%s%s", is_one ? "" : "robot ",
                   is_one ? "" : mcs->layout->robots[robot].name, is_one ? "" : ": ");
    return text;
}

static wh_status_t refuse_exceeded(const wh_mcs_t *mcs, const wh_mcs_controller_t *controller,
                                   const char *who, char reason[WH_MCS_CHANGE_BYTES]) {
    const wh_machine_t *machine = &mcs->layout->machine;
    const size_t axis = (size_t)controller->exceeded - 1;
    (void)refuse_change(reason, "%s%s stands at %.10g, beyond its soft limit: HOME comes first", who,
                        wh_axis_name(machine, axis), told_place(machine, axis, controller->at));
    return WH_STATUS_SOFT_LIMIT;
}

/* In manual mode no host moves the robot, in remote mode nobody else does. */
static wh_status_t refuse_mode(const wh_mcs_t *mcs, int32_t mode, const char *who,
                               char reason[WH_MCS_CHANGE_BYTES]) {
    const bool is_remote = mode == WH_MODE_REMOTE;
    if (mode == WH_MODE_AUTOMATIC || is_remote == mcs->wanted.is_of_hosts) {
        return WH_OK;
    }
    (void)refuse_change(reason, "%smode is %s (expected automatic%s)", who, is_remote ? "remote" : "manual",
                        is_remote ? ": only hosts move the robot" : " or remote, for a host's command");
    return WH_STATUS_WRONG_MODE;
}

wh_status_t wh_mcs_refusal(const wh_mcs_t *mcs, size_t robot, bool homes, char reason[WH_MCS_CHANGE_BYTES]) {
    const wh_mcs_controller_t *controller = &mcs->armed.controllers[robot];
    char who[2 * WH_NAME_SIZE];
    reason[0] = '\0';
    (void)name_robot(mcs, robot, who);
    if (is_pressed(controller)) {
        (void)refuse_change(reason, "%sestop = off and power = on come first", who);
        return WH_STATUS_EMERGENCY_STOP;
    }
    if (controller->is_off) {
        (void)refuse_change(reason, "%spower = on comes first", who);
        return WH_STATUS_NO_POWER;
    }
    if (controller->is_braked) {
        (void)refuse_change(reason, "%sbrakes = released comes first", who);
        return WH_STATUS_BRAKES_SET;
    }
    if (controller->has_failed) {
        (void)refuse_change(reason, "%sservo = ok comes first", who);
        return WH_STATUS_SERVO_ERROR;
    }
    if (controller->exceeded && !homes) {
        return refuse_exceeded(mcs, controller, who, reason);
    }
    return refuse_mode(mcs, controller->mode, who, reason);
}

/* ------------------------------------------------------------------------------------------ a motion ends */

/* True while a segment of a command that has this robot is played. */
static bool is_moving(const wh_mcs_t *mcs, uint32_t axes) {
    bool has = !mcs->lanes && mcs->recorder.running != WH_NONE && (mcs->running.axes & axes) != 0;
    for (size_t i = 0; mcs->lanes && i < mcs->lanes->count; ++i) {
        has = has || (mcs->lanes->of[i].is_busy && (mcs->lanes->of[i].axes & axes) != 0);
    }
    return has;
}

/* A mode, like an encoder, refuses only commands that begin later. */
static bool ends_motion(const wh_mcs_t *mcs, size_t robot) {
    char reason[WH_MCS_CHANGE_BYTES];
    const wh_status_t status = wh_mcs_refusal(mcs, robot, true, reason);
    return status != WH_OK && status != WH_STATUS_WRONG_MODE;
}

void wh_mcs_end_refused_motion(wh_mcs_t *mcs, size_t robot) {
    const uint32_t axes = wh_mcs_robot_axes(&mcs->layout->machine, robot);
    if (ends_motion(mcs, robot) && is_moving(mcs, axes)) {
        mcs->stop.refused |= 1U << robot;
    }
}

void wh_mcs_raise_condition(lua_State *L, wh_mcs_t *mcs, size_t robot) {
    char reason[WH_MCS_CHANGE_BYTES];
    wh_status_t status = wh_mcs_refusal(mcs, robot, true, reason);
    mcs->stop.refused &= ~(1U << robot);
    mcs->stop.was_cut = true;
    if (status == WH_OK || status == WH_STATUS_WRONG_MODE) { /* it has gone within the same slice */
        status = WH_STATUS_STOPPED;
        (void)snprintf(reason, sizeof reason, "by its controller");
    }
    wh_mcs_raise(L, mcs, status, reason);
}

void wh_mcs_check_segment(lua_State *L, wh_mcs_t *mcs, const wh_segment_t *segment, uint32_t axes) {
    const bool moves = segment->kind == WH_SEGMENT_AXES || segment->kind == WH_SEGMENT_LINE ||
                       segment->kind == WH_SEGMENT_WAY || segment->kind == WH_SEGMENT_VIA;
    for (size_t robot = 0; moves && robot < wh_machine_robots(&mcs->layout->machine); ++robot) {
        if ((axes & wh_mcs_robot_axes(&mcs->layout->machine, robot)) != 0 && ends_motion(mcs, robot)) {
            wh_mcs_raise_condition(L, mcs, robot);
        }
    }
}

static void look_at(wh_mcs_t *mcs, size_t robot, int64_t slice) {
    wh_mcs_controller_t *controller = &mcs->armed.controllers[robot];
    const wh_mcs_controller_t before = *controller;
    controller->is_struck = find_fault(mcs, WH_FAULT_EMERGENCY_STOP, robot, slice) > 0 ? 1 : 0;
    if (controller->is_struck || find_fault(mcs, WH_FAULT_POWER_LOST, robot, slice) > 0) {
        controller->is_off = 1;
    }
    if (find_fault(mcs, WH_FAULT_SERVO_ERROR, robot, slice) > 0) {
        controller->has_failed = 1;
    }
    if (memcmp(&before, controller, sizeof before) != 0) {
        wh_decisions_measured(mcs->wanted.decisions, "a controller's own state");
        wh_mcs_end_refused_motion(mcs, robot);
    }
}

void wh_mcs_look_at_controllers(wh_mcs_t *mcs, int64_t slice) {
    if (mcs->armed.fault_count == 0) {
        return;
    }
    for (size_t robot = 0; robot < wh_machine_robots(&mcs->layout->machine); ++robot) {
        look_at(mcs, robot, slice);
    }
}

/* ------------------------------------------------------------------------------------------------ telling */

void wh_mcs_tell_controller(const wh_mcs_t *mcs, size_t robot, wh_mcs_tell_value_t *tell, void *user) {
    const wh_mcs_controller_t *controller = &mcs->armed.controllers[robot];
    const double part = controller->override > 0 ? controller->override : 1;
    char number[40];
    for (size_t i = 0; i < ROWS; ++i) {
        const int32_t value = value_of(controller, &rows[i]);
        tell(user, rows[i].name, rows[i].words[value], value == 0);
    }
    if (controller->exceeded) {
        tell(user, "exceeded", wh_axis_name(&mcs->layout->machine, (size_t)controller->exceeded - 1), false);
    }
    (void)snprintf(number, sizeof number, "%.15g", part);
    tell(user, "override", number, part == 1);
}

const wh_mcs_controller_t *wh_mcs_controller(const wh_mcs_t *mcs, size_t robot) {
    return &mcs->armed.controllers[robot];
}

bool wh_mcs_is_to_end(const wh_mcs_t *mcs) {
    return mcs->stop.refused != 0;
}

wh_real_t wh_mcs_encoder(const wh_mcs_t *mcs, size_t axis, wh_real_t at) {
    for (size_t robot = 0; robot < WH_MCS_ROBOTS; ++robot) {
        if (mcs->armed.controllers[robot].exceeded == (int32_t)axis + 1) {
            return (wh_real_t)mcs->armed.controllers[robot].at;
        }
    }
    return at;
}

/* ---------------------------------------------------------------------------------------------- functions */

static size_t robot_at(lua_State *L, const wh_mcs_t *mcs) {
    return (size_t)wh_mcs_index(L, 1, wh_machine_robots(&mcs->layout->machine));
}

/* native.change_controller(robot, changes): takes all of them, names and texts, or raises. */
static int change_controller(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_mcs_change_t changes[WH_MCS_CHANGES];
    char reason[WH_MCS_CHANGE_BYTES];
    size_t count = 0;
    luaL_checktype(L, 2, LUA_TTABLE);
    for (lua_pushnil(L); lua_next(L, 2) != 0 && count < WH_MCS_CHANGES; lua_pop(L, 1)) {
        changes[count++] = (wh_mcs_change_t){luaL_checkstring(L, -2), luaL_checkstring(L, -1)};
    }
    const wh_status_t status = wh_mcs_change_controller(mcs, robot_at(L, mcs), changes, count, reason);
    if (status != WH_OK) {
        wh_mcs_raise(L, mcs, status, reason);
    }
    return 0;
}

static void set_value(void *user, const char *name, const char *value, bool usual) {
    lua_State *L = user;
    (void)usual;
    if (strcmp(name, "override") == 0) {
        wh_lua_set_number(L, name, strtod(value, NULL));
    } else {
        wh_lua_set_text(L, name, value);
    }
}

/* native.controller(robot): its state by name; with an axis beyond its soft limit `at`, degrees or mm. */
static int push_controller(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const size_t robot = robot_at(L, mcs);
    const wh_mcs_controller_t *controller = &mcs->armed.controllers[robot];
    lua_newtable(L);
    wh_mcs_tell_controller(mcs, robot, set_value, L);
    if (controller->exceeded) {
        wh_lua_set_number(
            L, "at", told_place(&mcs->layout->machine, (size_t)controller->exceeded - 1, controller->at));
    }
    return 1;
}

/* native.override(robot): the part of all its speeds. */
static int push_override(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const double part = mcs->armed.controllers[robot_at(L, mcs)].override;
    lua_pushnumber(L, part > 0 ? part : 1);
    return 1;
}

/* native.check_controller(robot, homes): raises what refuses the robot's motion; an axis beyond its soft
 * limit does not refuse one that `homes`. */
static int check_controller(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    char reason[WH_MCS_CHANGE_BYTES];
    const size_t robot = robot_at(L, mcs);
    wh_mcs_look_at_controllers(mcs, mcs->track.slice + 1);
    const wh_status_t status = wh_mcs_refusal(mcs, robot, lua_toboolean(L, 2) != 0, reason);
    if (status != WH_OK) {
        wh_mcs_raise(L, mcs, status, reason);
    }
    return 0;
}

/* native.mend_controller(robot): it was homed, and its encoders tell where it stands. */
static int mend_controller(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_mcs_controller_t *controller = &mcs->armed.controllers[robot_at(L, mcs)];
    controller->exceeded = 0;
    controller->at = 0;
    return 0;
}

/* native.was_cut(): true, once, if a motion has ended by its controller. */
static int push_was_cut(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    lua_pushboolean(L, mcs->stop.was_cut);
    mcs->stop.was_cut = false;
    return 1;
}

const luaL_Reg wh_mcs_controller_functions[] = {{"change_controller", change_controller},
                                                {"controller", push_controller},
                                                {"override", push_override},
                                                {"check_controller", check_controller},
                                                {"mend_controller", mend_controller},
                                                {"was_cut", push_was_cut},
                                                {NULL, NULL}};
