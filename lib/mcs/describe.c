/* Describes what motion control does in one line, for STATUS and VERSION. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "../text/utf8.h"
#include "clocks.h"
#include "flow_held.h"
#include "ports.h"

typedef struct {
    char *text; /* of WH_MCS_DESCRIPTION_BYTES */
    size_t length;
} description_t;

__attribute__((format(printf, 2, 3))) static void put(description_t *to, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const size_t room = WH_MCS_DESCRIPTION_BYTES - to->length;
    const int length = vsnprintf(to->text + to->length, room, format, arguments);
    va_end(arguments);
    to->length += length > 0 && (size_t)length < room ? (size_t)length : 0;
    to->text[to->length] = '\0';
}

/* True if a name needs no quotes. */
static bool is_plain(const char *name) {
    const char *plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./-";
    return name[0] != '\0' && name[strspn(name, plain)] == '\0' && strcasecmp(name, "none") != 0;
}

/* Writes a name as it can be typed, like tokens.spell of lua/mcs; null: none. */
static void put_name(description_t *to, const char *name) {
    if (!name || is_plain(name)) {
        put(to, "%s", name ? name : "none");
        return;
    }
    put(to, "\"");
    for (const char *c = name; *c; ++c) {
        put(to, *c == '"' || *c == '\\' ? "\\%c" : "%c", *c);
    }
    put(to, "\"");
}

/* The most bytes of a command's text, with a terminator. A script's command may be too long to show. */
enum { TASK_COMMAND = 101, SCRIPT_COMMAND = 1001 };

static void put_command(description_t *to, const char *text, size_t size) {
    char begin[SCRIPT_COMMAND];
    wh_utf8_clip(begin, size, text);
    put_name(to, begin);
}

/* The shortest decimals that read back as the same double. */
static void put_value(description_t *to, double value) {
    char text[40];
    for (int digits = 15; digits <= 17; ++digits) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    put(to, "=%s", text);
}

static void put_number(description_t *to, const char *name, double value) {
    put(to, " %s", name);
    put_value(to, value);
}

/* Copies the values of one slice from the state and these axes. */
static void see_slice(wh_mcs_seen_t *seen, const wh_state_t *state, const wh_real_t axes[WH_AXES]) {
    seen->seq = state->seq;
    seen->utime = state->utime;
    memcpy(seen->axes, axes, sizeof seen->axes);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        seen->held[g] = g < state->gripper_count ? state->grippers[g].wafer : WH_NONE;
    }
}

/* In a free run the state is of an earlier slice than the command. */
static void hear_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    wh_mcs_t *mcs = user;
    wh_mcs_sent_t *sent = &mcs->heard.sent[command->seq % WH_MCS_SENT];
    sent->seq = command->seq;
    memcpy(sent->axes, command->axes, sizeof sent->axes);
    const wh_mcs_sent_t *answered = &mcs->heard.sent[state->seq % WH_MCS_SENT];
    if (state->seq > mcs->heard.seen.seq && answered->seq == state->seq) {
        see_slice(&mcs->heard.seen, state, answered->axes);
    }
}

void wh_mcs_watch_slices(wh_mcs_t *mcs) {
    see_slice(&mcs->heard.seen, &mcs->state, mcs->track.axes);
    wh_mcs_listen_first(mcs, hear_slice, mcs); /* first, as another listener of the slice may ask
                                                * for STATUS */
}

/* "theta", or with several robots "VAC.theta". */
static void put_axis_name(description_t *to, const wh_layout_t *layout, size_t axis) {
    size_t own = 0;
    const int32_t robot = wh_machine_robot_of(&layout->machine, axis, &own);
    put(to, " ");
    if (layout->robot_count > 1) {
        put_name(to, layout->robots[robot].name);
        put(to, ".");
    }
    put(to, "%s", wh_axis_name(&layout->machine, axis));
}

/* By their encoders. */
static void put_robots(description_t *to, const wh_mcs_t *mcs, const wh_real_t axes[]) {
    const wh_layout_t *layout = mcs->layout;
    const wh_machine_t *machine = &layout->machine;
    for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
        const double at = (double)wh_mcs_encoder(mcs, axis, axes[axis]);
        if (wh_axis_exists(machine, axis)) {
            put_axis_name(to, layout, axis);
            put_value(to, wh_axis_turns(machine, axis) ? wh_deg_from_rad(at) : at);
        }
    }
}

/* Where the values of a robot's controller are told. */
typedef struct {
    description_t *to;
    const char *robot; /* null: there is one */
} controller_told_t;

static void put_condition(void *user, const char *name, const char *value, bool usual) {
    const controller_told_t *told = user;
    if (!usual) {
        put(told->to, " ");
        if (told->robot) {
            put_name(told->to, told->robot);
            put(told->to, ".");
        }
        put(told->to, "%s=%s", name, value);
    }
}

/* The values of the robots' controllers that are not as usual. */
static void put_controllers(description_t *to, const wh_mcs_t *mcs) {
    for (size_t robot = 0; robot < wh_machine_robots(&mcs->layout->machine); ++robot) {
        controller_told_t told = {to, mcs->layout->robot_count > 1 ? mcs->layout->robots[robot].name : NULL};
        wh_mcs_tell_controller(mcs, robot, put_condition, &told);
    }
}

static void put_hold(description_t *to, const wh_mcs_t *mcs, const char *robot) {
    if (wh_mcs_is_robot_held(mcs, robot)) {
        put(to, " ");
        put_name(to, robot);
        put(to, ".held=yes");
    }
}

/* The robots of a flow that requests hold. */
static void put_holds(description_t *to, const wh_mcs_t *mcs) {
    const wh_layout_t *layout = mcs->layout;
    for (size_t robot = 0; robot < layout->robot_count; ++robot) {
        put_hold(to, mcs, layout->robots[robot].name);
    }
    for (size_t robot = 0; layout->timed && robot < layout->timed->robot_count; ++robot) {
        put_hold(to, mcs, layout->timed->robots[robot].name);
    }
}

static void put_grippers(description_t *to, const wh_layout_t *layout, const int32_t held[]) {
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        put(to, " ");
        put_name(to, layout->grippers[g].name);
        put(to, ".holds=");
        put_name(to, held[g] == WH_NONE ? NULL : layout->wafers[held[g]].name);
    }
}

static void put_doors(description_t *to, const wh_mcs_t *mcs) {
    for (size_t d = 0; d < mcs->layout->machine.door_count; ++d) {
        put(to, " ");
        put_name(to, mcs->layout->door_list[d].name);
        put(to, ".door=%s", wh_mcs_door_word(mcs, d));
    }
}

/* The step that runs at a load port, the one that ended its last handshake, and its carrier. */
static void put_port(description_t *to, const wh_mcs_t *mcs, size_t s) {
    const int32_t number = wh_ports_find(mcs, (int32_t)s);
    const wh_load_port_now_t *port = number == WH_NONE ? NULL : &mcs->clocks->ports->ports[number];
    if (port && port->clock.step != WH_LOAD_PORT_STANDS) {
        put(to, " ");
        put_name(to, mcs->layout->stations[s].name);
        put(to, ".does=%s", wh_load_port_step_name(port->clock.step));
    }
    if (port && port->clock.failed != WH_LOAD_PORT_STANDS) {
        put(to, " ");
        put_name(to, mcs->layout->stations[s].name);
        put(to, ".failed=%s", wh_load_port_step_name(port->clock.failed));
    }
    if (port && port->carrier != WH_NONE) {
        put(to, " ");
        put_name(to, mcs->layout->stations[s].name);
        put(to, ".carrier=");
        put_name(to, mcs->layout->carriers[port->carrier].name);
    }
}

/* A process, clean or pump that runs with its rest in s; and a load lock's pressure. */
static void put_stations(description_t *to, const wh_mcs_t *mcs) {
    for (size_t s = 0; mcs->clocks && s < mcs->layout->station_count; ++s) {
        double left_us = 0;
        const char *word = wh_mcs_station_word(mcs, (int32_t)s, &left_us);
        const char *pressure = wh_mcs_pressure_word(mcs, (int32_t)s);
        if (word) {
            put(to, " ");
            put_name(to, mcs->layout->stations[s].name);
            put(to, ".is=%s", word);
        }
        if (word && left_us > 0) {
            put(to, " ");
            put_name(to, mcs->layout->stations[s].name);
            put(to, ".left");
            put_value(to, left_us / 1e6);
        }
        put_port(to, mcs, s);
        if (pressure) {
            put(to, " ");
            put_name(to, mcs->layout->stations[s].name);
            put(to, ".pressure=%s", pressure);
        }
    }
}

static void put_error(description_t *to, const wh_record_t *record) {
    size_t i = record->command_count;
    while (i > 0 && record->commands[i - 1].error == WH_OK) {
        --i;
    }
    put(to, " error=%d", i > 0 ? (int)record->commands[i - 1].error : 0);
    if (i > 0) {
        put(to, " error_name=%s error_command=", wh_status_name(record->commands[i - 1].error));
        put_command(to, record->commands[i - 1].text, SCRIPT_COMMAND);
    }
}

uint32_t wh_mcs_robot_axes(const wh_machine_t *machine, size_t robot) {
    uint32_t axes = 0;
    for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
        size_t own;
        axes |= wh_machine_robot_of(machine, axis, &own) == (int32_t)robot ? 1U << axis : 0;
    }
    return axes;
}

static size_t name_one(char text[WH_MCS_MECHANISMS_BYTES], size_t length, const char *name) {
    const size_t size = (size_t)(WH_MCS_MECHANISMS_BYTES);
    return length + (size_t)snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "", name);
}

/* True if one of these axes is that of a gripper at a station. */
static bool turns_gripper(const wh_machine_t *machine, size_t g, uint32_t axes) {
    return machine->mounts[g].axis != WH_NONE && (axes >> machine->mounts[g].axis & 1U) != 0;
}

void wh_mcs_name_mechanisms(const wh_mcs_t *mcs, uint32_t axes, char text[WH_MCS_MECHANISMS_BYTES]) {
    const wh_layout_t *layout = mcs->layout;
    const wh_machine_t *machine = &layout->machine;
    size_t length = 0;
    text[0] = '\0';
    for (size_t robot = 0; robot < wh_machine_robots(machine); ++robot) {
        if ((axes & wh_mcs_robot_axes(machine, robot)) != 0) {
            length = name_one(text, length, layout->robots[robot].name);
        }
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        if (turns_gripper(machine, g, axes)) {
            length = name_one(text, length, layout->grippers[g].name);
        }
    }
    for (size_t d = 0; d < machine->door_count; ++d) {
        if ((axes >> wh_machine_door_axis(machine, d) & 1U) != 0) {
            length = name_one(text, length, layout->door_list[d].name);
        }
    }
}

/* The axis, as a bit, that turns or lifts the gripper of this name, or the gripper at a station of this
 * name; 0: none. */
static uint32_t find_gripper_axis(const wh_layout_t *layout, size_t g, const char *name) {
    const wh_layout_gripper_t *gripper = &layout->grippers[g];
    const int32_t axis = layout->machine.mounts[g].axis;
    const bool is_station =
        gripper->station != WH_NONE && strcasecmp(name, layout->stations[gripper->station].name) == 0;
    const bool is_it = is_station || strcasecmp(name, gripper->name) == 0;
    return is_it && axis != WH_NONE ? 1U << axis : 0;
}

bool wh_mcs_find_mechanism(const wh_mcs_t *mcs, const char *name, uint32_t *axes) {
    const wh_machine_t *machine = &mcs->layout->machine;
    *axes = strcasecmp(name, "robot") == 0 ? wh_machine_robot_bits(machine) : 0;
    for (size_t robot = 0; robot < wh_machine_robots(machine); ++robot) {
        const bool is_it = strcasecmp(name, mcs->layout->robots[robot].name) == 0;
        *axes |= is_it ? wh_mcs_robot_axes(machine, robot) : 0;
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        *axes |= find_gripper_axis(mcs->layout, g, name);
    }
    for (size_t d = 0; d < machine->door_count; ++d) {
        const bool is_it = strcasecmp(name, mcs->layout->door_list[d].name) == 0;
        *axes |= is_it ? 1U << wh_machine_door_axis(machine, d) : 0;
    }
    return *axes != 0;
}

/* The command that the task of a lane runs: an index in the record, or WH_NONE. Without tasks the first lane
 * has the running command. */
static int32_t running_in(const wh_mcs_t *mcs, size_t lane) {
    const wh_lanes_t *lanes = mcs->lanes;
    return !lanes || (size_t)lanes->current == lane ? mcs->recorder.running : lanes->of[lane].running;
}

/* Writes each running command, those of tasks with the task's number. False if none runs. */
static bool put_running(description_t *to, const wh_mcs_t *mcs) {
    bool is_any = false;
    for (size_t i = 0; i < (mcs->lanes ? WH_MCS_LANES : 1); ++i) {
        const int32_t running = running_in(mcs, i);
        if (running != WH_NONE) {
            const wh_command_record_t *command = &mcs->recorder.record->commands[running];
            put(to, "%s", is_any ? " " : "phase=running ");
            if (command->task > 0) {
                put(to, "task%d.", (int)command->task);
            }
            put(to, "command=");
            put_command(to, command->text, command->task > 0 ? TASK_COMMAND : SCRIPT_COMMAND);
            is_any = true;
        }
    }
    return is_any;
}

/* With a robot's name, the name stands before the command. */
static void put_held(description_t *to, const wh_mcs_held_t *held, const char *robot) {
    static const char *const parts[] = {"command", "stop"};
    for (size_t i = 0; i < 2; ++i) {
        put(to, " ");
        if (robot) {
            put_name(to, robot);
            put(to, ".");
        }
        put(to, "%s=", parts[i]);
        put_command(to, i == 0 ? held->command : held->phase, SCRIPT_COMMAND);
    }
}

/* Writes the running commands, or else the held ones. */
static void put_phases(description_t *to, const wh_mcs_t *mcs) {
    if (put_running(to, mcs)) {
        return;
    }
    const wh_mcs_held_t *first = wh_mcs_find_held(mcs, WH_NONE);
    put(to, first ? "phase=held" : "phase=idle");
    for (int32_t robot = 0; robot < WH_MCS_ROBOTS; ++robot) {
        const wh_mcs_held_t *held = wh_mcs_find_held(mcs, robot);
        if (held) {
            put_held(to, held, held == first ? NULL : mcs->layout->robots[robot].name);
        }
    }
}

void wh_mcs_describe(const wh_mcs_t *mcs, char text[WH_MCS_DESCRIPTION_BYTES]) {
    description_t to = {text, 0};
    wh_mcs_seen_t seen = mcs->heard.seen;
    if (!mcs->wanted.partners.connect) {
        see_slice(&seen, &mcs->state, mcs->track.axes);
    }
    put_phases(&to, mcs);
    put(&to, " seq=%lld", (long long)seen.seq);
    put_number(&to, "time", (double)seen.utime / 1e6);
    if (mcs->layout) {
        put_robots(&to, mcs, seen.axes);
        put_controllers(&to, mcs);
        put_holds(&to, mcs);
        put_grippers(&to, mcs->layout, seen.held);
        put_doors(&to, mcs);
        put_stations(&to, mcs);
    }
    put_error(&to, mcs->recorder.record);
}

void wh_mcs_see_grippers(const wh_mcs_t *mcs, wh_pose_t poses[WH_GRIPPERS]) {
    const wh_real_t *axes = mcs->wanted.partners.connect ? mcs->heard.seen.axes : mcs->track.axes;
    if (mcs->layout) {
        wh_machine_grippers(&mcs->layout->machine, axes, poses);
    }
}

/* native.status(): the text of wh_mcs_describe. */
static int push_description(lua_State *L) {
    char text[WH_MCS_DESCRIPTION_BYTES];
    wh_mcs_describe(wh_mcs_of(L), text);
    lua_pushstring(L, text);
    return 1;
}

/* native.version(): the program's. */
static int tell_version(lua_State *L) {
    lua_pushliteral(L, WH_VERSION);
    return 1;
}

const luaL_Reg wh_mcs_describe_functions[] = {
    {"status", push_description}, {"version", tell_version}, {NULL, NULL}};
