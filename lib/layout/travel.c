#include "travel.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "../math/trig.h"
#include "axes.h"

#define NO_AXIS (-1)

bool wh_travel_passes_axis(const wh_line_t *line, wh_real_t *least_R) {
    const wh_real_t outward = line->direction.x;
    const wh_real_t level = outward * outward + line->direction.y * line->direction.y;
    const wh_real_t R = line->from[WH_AXIS_R];
    if (!(outward < 0 && -R * outward < level * line->path.distance)) {
        return false; /* such as a line straight up, whose level is 0 */
    }
    *least_R = R * wh_real_abs(line->direction.y) / wh_real_sqrt(level);
    return true;
}

/* -------------------------------------------------------------------------------------------------- words */

__attribute__((format(printf, 2, 3))) static void put(char text[WH_TRAVEL_BYTES], const char *format, ...) {
    const size_t length = strlen(text);
    va_list values;
    va_start(values, format);
    const int needed = vsnprintf(text + length, WH_TRAVEL_BYTES - length, format, values);
    va_end(values);
    if (needed < 0 || (size_t)needed >= WH_TRAVEL_BYTES - length) {
        text[length] = '\0';
    }
}

/* Writes a value beyond its limits with enough digits that it does not read as one of them. */
static void put_value(char text[WH_TRAVEL_BYTES], double value, double min, double max) {
    char said[40], least[40], most[40];
    int digits = 7;
    do {
        (void)snprintf(said, sizeof said, "%.*g", digits, value);
        (void)snprintf(least, sizeof least, "%.*g", digits, min);
        (void)snprintf(most, sizeof most, "%.*g", digits, max);
    } while (++digits <= 17 && (strcmp(said, least) == 0 || strcmp(said, most) == 0));
    put(text, "%s (expected %.7g to %.7g", said, min, max);
}

static void put_axis(char text[WH_TRAVEL_BYTES], const wh_machine_t *machine, size_t axis, wh_real_t value) {
    const wh_travel_t *travel = wh_machine_travel(machine, axis);
    put(text, "%s%s: ", text[0] ? ", " : "", wh_axis_name(machine, axis));
    if (wh_axis_turns(machine, axis)) {
        put_value(text, wh_deg_from_rad(value), wh_deg_from_rad(travel->min), wh_deg_from_rad(travel->max));
        put(text, " degrees)");
    } else {
        put_value(text, value, travel->min, travel->max);
        put(text, " mm)");
    }
}

/* ------------------------------------------------------------------------------------ one axis at a time */

/* A machine whose robot has the travel of one axis alone, or of none: the others have no ends. It must not
 * move: `machine` may point to `carrier`. */
typedef struct {
    wh_machine_t machine;
    wh_carrier_t carrier, second;
    size_t first, count; /* of the machine's axes, the robot's */
} alone_t;

static void set_carried(alone_t *alone, size_t axis, const wh_travel_t *travel) {
    wh_carrier_t *const arms[] = {&alone->carrier, &alone->second};
    for (size_t i = 0; i < (alone->carrier.second ? 2 : 1); ++i) {
        if (arms[i]->axes[axis] != WH_CARRIER_OTHERS) {
            arms[i]->chain.travel[arms[i]->axes[axis]] = *travel;
        }
    }
}

/* `axis` is one of this robot's own, from 0. */
static void set_travel_of(alone_t *alone, const wh_machine_t *machine, size_t robot, int32_t axis) {
    static const wh_travel_t endless = {(wh_real_t)-INFINITY, (wh_real_t)INFINITY};
    const wh_carrier_t *carrier = wh_machine_carrier(machine, robot, &alone->first);
    alone->machine = *machine;
    alone->count = carrier ? carrier->axis_count : WH_ROBOT_AXES;
    alone->machine.axis_count = alone->count;
    alone->machine.gripper_count = 0;
    if (carrier) {
        alone->carrier = *carrier;
        alone->carrier.next = NULL;
        alone->machine.carrier = &alone->carrier;
        if (alone->carrier.second) {
            alone->second = *alone->carrier.second;
            alone->carrier.second = &alone->second;
        }
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        alone->machine.mounts[g].robot = 0;
    }
    for (int32_t other = 0; other < (int32_t)alone->count; ++other) {
        const wh_travel_t *travel =
            other == axis ? wh_machine_travel(machine, alone->first + (size_t)other) : &endless;
        if (other < WH_ROBOT_AXES) {
            alone->machine.robot.travel[other] = *travel;
        }
        if (carrier) {
            set_carried(alone, (size_t)other, travel);
        }
    }
}

static bool is_of_travel(wh_status_t status) {
    return status == WH_STATUS_OUT_OF_REACH || status == WH_STATUS_LIMIT_EXCEEDED;
}

/* Says that an axis of this gripper, which is not on the robot, is out of its travel, if so. */
static void put_beside(char text[WH_TRAVEL_BYTES], const wh_layout_t *layout, size_t g, size_t axis,
                       double at) {
    char name[WH_NAME_SIZE + 8];
    const wh_travel_t travel = wh_machine_beside(&layout->machine, axis);
    const bool turns = wh_layout_axis_turns(layout, axis);
    const double unit = turns ? wh_deg_from_rad(1) : 1;
    if (at < travel.min || at > travel.max) {
        wh_layout_name_axis(layout, axis, name, sizeof name);
        put(text, "%s%s%s: ", text[0] ? ", " : "", turns ? "the chuck of " : "",
            turns ? layout->grippers[g].name : name);
        put_value(text, unit * at, unit * travel.min, unit * travel.max);
        put(text, turns ? " degrees)" : " mm)");
    }
}

void wh_travel_say_axes(const wh_layout_t *layout, const wh_real_t axes[], char text[WH_TRAVEL_BYTES]) {
    const wh_machine_t *machine = &layout->machine;
    text[0] = '\0';
    for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
        size_t own = 0;
        const int32_t robot = wh_machine_robot_of(machine, axis, &own);
        alone_t alone;
        set_travel_of(&alone, machine, (size_t)robot, (int32_t)own);
        if (is_of_travel(wh_machine_check_travel(&alone.machine, &axes[alone.first]))) {
            put_axis(text, machine, axis, axes[axis]);
        }
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        for (size_t i = 0; i < wh_mount_axes(mount); ++i) {
            put_beside(text, layout, g, (size_t)mount->axis + i, axes[(size_t)mount->axis + i]);
        }
    }
}

static bool is_scara(const wh_machine_t *machine) {
    return machine->carrier && machine->carrier->chain.kind == WH_CHAIN_SCARA;
}

static wh_status_t bring(const wh_machine_t *machine, const wh_travel_goal_t *goal, const wh_real_t near_q[],
                         wh_real_t q[]) {
    return goal->pose ? wh_machine_bring(machine, goal->gripper, goal->pose, goal->choice, near_q, q)
                      : wh_machine_inverse(machine, goal->gripper, &goal->at, goal->heading, near_q, q);
}

wh_status_t wh_travel_find(const wh_layout_t *layout, const wh_travel_goal_t *goal, const wh_real_t near_q[],
                           wh_real_t q[]) {
    return bring(&layout->machine, goal, near_q, q);
}

void wh_travel_say_point(const wh_layout_t *layout, const wh_travel_goal_t *goal, const wh_real_t near_q[],
                         char text[WH_TRAVEL_BYTES]) {
    const wh_machine_t *machine = &layout->machine;
    const wh_vec3_t *at = goal->pose ? &goal->pose->r : &goal->at;
    const size_t robot = machine->mounts[goal->gripper].robot;
    wh_real_t found[WH_AXES], unused[WH_AXES];
    alone_t alone;
    text[0] = '\0';
    set_travel_of(&alone, machine, robot, NO_AXIS);
    near_q += alone.first;
    const wh_status_t status = bring(&alone.machine, goal, near_q, found);
    if (status == WH_STATUS_OUT_OF_REACH) {
        put(text, is_scara(&alone.machine) ? "forearm: no angle (expected a point that the links reach)"
                                           : "r: 0 (expected a point beside the robot's own axis)");
    } else if (status == WH_STATUS_NOT_ALONG_ARM) {
        put(text, "expected a way that leads straight away from theta's axis, also with its corrections, "
                  "given or of ALIGN");
    } else if (status != WH_OK) {
        return;
    }
    for (int32_t axis = 0; status == WH_OK && axis < (int32_t)alone.count; ++axis) {
        set_travel_of(&alone, machine, robot, axis);
        if (is_of_travel(bring(&alone.machine, goal, near_q, unused))) {
            put_axis(text, machine, alone.first + (size_t)axis, found[axis]);
        }
    }
    if (text[0]) {
        put(text, " with %s at x %.3f, y %.3f, z %.3f mm", layout->grippers[goal->gripper].name,
            (double)at->x, (double)at->y, (double)at->z);
    }
}

/* -------------------------------------------------------------------------------------------------- lines */

/* The end of a line, and its plan for the usual robot; for another robot the plan is not used. */
typedef struct {
    wh_real_t to[WH_AXES];
    wh_line_t path;
} planned_t;

static wh_status_t plan(const wh_machine_t *machine, bool is_second, const wh_real_t from_q[],
                        const wh_vec3_t *travel, wh_real_t share, planned_t *planned) {
    const wh_vec3_t way = wh_vec3_scale(share, travel);
    const wh_carrier_t *carrier = is_second ? machine->carrier->second : machine->carrier;
    if (!carrier) {
        const wh_status_t status =
            wh_line_plan(&planned->path, &machine->robot, from_q, way.x, way.y, way.z, 0);
        if (status == WH_OK) {
            memcpy(planned->to, planned->path.to, sizeof planned->path.to);
        }
        return status;
    }
    static const wh_line_caps_t none = {0, 0};
    wh_chain_line_t line;
    const wh_status_t status = carrier->plan_line(carrier, &line, from_q, &way, &none);
    if (status == WH_OK) {
        memcpy(planned->to, from_q, carrier->axis_count * sizeof from_q[0]);
        carrier->line_at(carrier, &line, wh_chain_line_duration(&line), planned->to);
        planned->path = line.path;
    }
    return status;
}

/* The share of the line after which this axis leaves its travel; 2: it does not. */
static wh_real_t find_end(const wh_machine_t *alone, bool is_second, const wh_real_t from_q[],
                          const wh_vec3_t *travel) {
    wh_real_t good = 0;
    wh_real_t bad = 1;
    planned_t line;
    if (!is_of_travel(plan(alone, is_second, from_q, travel, 1, &line))) {
        return 2;
    }
    while (bad - good > WH_REAL(1e-9)) {
        const wh_real_t middle = (good + bad) / 2;
        if (is_of_travel(plan(alone, is_second, from_q, travel, middle, &line))) {
            bad = middle;
        } else {
            good = middle;
        }
    }
    return good;
}

/* Where an axis leaves its travel on the line; R on its way past its axis, if not at the end. */
static wh_real_t farthest(const wh_machine_t *machine, const planned_t *line, int32_t axis) {
    wh_real_t value = line->to[axis];
    if (axis == WH_AXIS_R && !is_scara(machine) && value <= wh_machine_travel(machine, WH_AXIS_R)->max) {
        (void)wh_travel_passes_axis(&line->path, &value);
    }
    return value;
}

/* Says where the line comes too near to stretched or folded, or that it begins there. */
static void put_end_of_bend(char text[WH_TRAVEL_BYTES], double share, double length, double forearm) {
    const bool is_stretched = fabs(forearm) < 90;
    const double off = is_stretched ? fabs(forearm) : 180 - fabs(forearm);
    const char *where = is_stretched ? "stretched" : "folded";
    const wh_real_t sine = WH_CHAIN_LEAST_SINE;
    const double least = wh_deg_from_rad(wh_atan2(sine, wh_real_sqrt(1 - sine * sine)));
    if (share > 0) {
        put(text,
            "a line ends %.4g degrees before %s, and this one of %.7g mm is there after %.3f mm: end it "
            "before",
            least, where, length, share * length);
    } else {
        put(text,
            "a line begins %.4g degrees or more from %s, and it is at %.4g: MOVE it %.4g degrees away first",
            least, where, off, least - off);
    }
}

/* Why a SCARA's forearm may not go along the line, whatever its travel; `status` is that of its plan. */
static void put_forearm(char text[WH_TRAVEL_BYTES], const alone_t *alone, wh_status_t status, bool is_second,
                        const wh_real_t from_q[], const wh_vec3_t *travel) {
    const wh_real_t *links = alone->carrier.chain.links;
    const wh_real_t share = find_end(&alone->machine, is_second, from_q, travel);
    wh_real_t forearm = from_q[WH_AXIS_R];
    planned_t line;
    if (share > 0 && plan(&alone->machine, is_second, from_q, travel, share, &line) == WH_OK) {
        forearm = line.to[WH_AXIS_R];
    }
    if (status == WH_STATUS_OUT_OF_REACH) {
        put(text, "forearm: no angle (expected a wrist %.7g to %.7g mm from the shoulder); ",
            (double)wh_real_abs(links[0] - links[1]), (double)(links[0] + links[1]));
    } else {
        put(text, "forearm: the links reach, but near stretched or folded no joint follows a line; ");
    }
    put_end_of_bend(text, share, wh_vec3_norm(travel), wh_deg_from_rad(forearm));
}

/* Without a gripper, the first robot's only arm. */
static wh_mount_t mount_of(const wh_machine_t *machine, int32_t gripper) {
    static const wh_mount_t usual = {0};
    return gripper == WH_NONE ? usual : machine->mounts[gripper];
}

/* Tells each axis of the robot whose travel ends on the line. Returns the share of the line up to the first
 * of these ends, or 2. */
static wh_real_t put_axes(char text[WH_TRAVEL_BYTES], const wh_machine_t *machine, int32_t gripper,
                          const wh_real_t from_q[], const wh_vec3_t *travel, const planned_t *line) {
    const wh_mount_t mount = mount_of(machine, gripper);
    wh_real_t first = 2;
    alone_t alone;
    set_travel_of(&alone, machine, mount.robot, NO_AXIS);
    for (int32_t axis = 0; axis < (int32_t)alone.count; ++axis) {
        set_travel_of(&alone, machine, mount.robot, axis);
        const wh_real_t share = find_end(&alone.machine, mount.arm == 1, from_q, travel);
        if (share <= 1) {
            put_axis(text, machine, alone.first + (size_t)axis, farthest(&alone.machine, line, axis));
            first = share < first ? share : first;
        }
    }
    return first;
}

void wh_travel_say_line(const wh_layout_t *layout, int32_t gripper, const wh_real_t from_q[],
                        const wh_vec3_t *travel, char text[WH_TRAVEL_BYTES]) {
    const wh_machine_t *machine = &layout->machine;
    const wh_mount_t mount = mount_of(machine, gripper);
    const bool is_second = mount.arm == 1;
    const double length = wh_vec3_norm(travel);
    planned_t line;
    alone_t alone;
    text[0] = '\0';
    set_travel_of(&alone, machine, mount.robot, NO_AXIS);
    from_q += alone.first;
    const wh_status_t status = plan(&alone.machine, is_second, from_q, travel, 1, &line);
    if (is_of_travel(status) && is_scara(&alone.machine)) {
        put_forearm(text, &alone, status, is_second, from_q, travel);
        return;
    }
    if (is_of_travel(status)) {
        put(text, "r: 0 (expected a line of %.7g mm beside the robot's own axis: move r off the axis first)",
            length);
        return;
    }
    if (status != WH_OK) {
        return;
    }
    const double first = (double)put_axes(text, machine, gripper, from_q, travel, &line);
    if (text[0]) {
        put(text, "; the line of %.7g mm comes to an end of travel after %.3f mm", length, first * length);
    }
}
