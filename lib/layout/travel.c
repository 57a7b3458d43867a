#include "travel.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "../math/trig.h"

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

/* A value beyond its limits. However near they are, it does not read as one of them. */
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

static void put_axis(char text[WH_TRAVEL_BYTES], const wh_robot_t *robot, size_t axis, wh_real_t value) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    const wh_travel_t *travel = &robot->travel[axis];
    put(text, "%s%s: ", text[0] ? ", " : "", names[axis]);
    if (axis == WH_AXIS_THETA || axis == WH_AXIS_YAW) {
        put_value(text, wh_deg_from_rad(value), wh_deg_from_rad(travel->min), wh_deg_from_rad(travel->max));
        put(text, " degrees)");
    } else {
        put_value(text, value, travel->min, travel->max);
        put(text, " mm)");
    }
}

/* ------------------------------------------------------------------------------------ one axis at a time */

/* The robot with the travel of one axis alone, or of none: the others have no ends. */
static wh_robot_t with_travel_of(const wh_robot_t *robot, int32_t axis) {
    static const wh_travel_t endless = {(wh_real_t)-INFINITY, (wh_real_t)INFINITY};
    wh_robot_t wide = *robot;
    for (int32_t other = 0; other < WH_ROBOT_AXES; ++other) {
        wide.travel[other] = other == axis ? robot->travel[other] : endless;
    }
    return wide;
}

static bool is_of_travel(wh_status_t status) {
    return status == WH_STATUS_OUT_OF_REACH || status == WH_STATUS_LIMIT_EXCEEDED;
}

void wh_travel_say_axes(const wh_layout_t *layout, const wh_real_t axes[], char text[WH_TRAVEL_BYTES]) {
    const wh_machine_t *machine = &layout->machine;
    text[0] = '\0';
    for (int32_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const wh_robot_t alone = with_travel_of(&machine->robot, axis);
        if (is_of_travel(wh_robot_check_travel(&alone, axes))) {
            put_axis(text, &machine->robot, (size_t)axis, axes[axis]);
        }
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const int32_t axis = machine->mounts[g].axis;
        if (axis != WH_NONE && wh_real_abs(axes[axis]) > WH_CHUCK_TRAVEL) {
            const double most = wh_deg_from_rad(WH_CHUCK_TRAVEL);
            put(text, "%sthe chuck of %s: ", text[0] ? ", " : "", layout->grippers[g].name);
            put_value(text, wh_deg_from_rad(axes[axis]), -most, most);
            put(text, " degrees)");
        }
    }
}

void wh_travel_say_point(const wh_layout_t *layout, size_t gripper, const wh_vec3_t *at, wh_real_t heading,
                         const wh_real_t near_q[WH_ROBOT_AXES], char text[WH_TRAVEL_BYTES]) {
    const wh_robot_t *robot = &layout->machine.robot;
    wh_machine_t alone = layout->machine;
    wh_real_t found[WH_ROBOT_AXES], unused[WH_ROBOT_AXES];
    text[0] = '\0';
    alone.robot = with_travel_of(robot, NO_AXIS);
    const wh_status_t status = wh_machine_inverse(&alone, gripper, at, heading, near_q, found);
    if (status == WH_STATUS_OUT_OF_REACH) {
        put(text, "r: 0 (expected a point beside the robot's own axis)");
    } else if (status != WH_OK) {
        return;
    }
    for (int32_t axis = 0; status == WH_OK && axis < WH_ROBOT_AXES; ++axis) {
        alone.robot = with_travel_of(robot, axis);
        if (is_of_travel(wh_machine_inverse(&alone, gripper, at, heading, near_q, unused))) {
            put_axis(text, robot, (size_t)axis, found[axis]);
        }
    }
    if (text[0]) {
        put(text, " with %s at x %.3f, y %.3f, z %.3f mm", layout->grippers[gripper].name, (double)at->x,
            (double)at->y, (double)at->z);
    }
}

/* -------------------------------------------------------------------------------------------------- lines */

static bool refuses(const wh_robot_t *robot, const wh_real_t from_q[], const wh_vec3_t *travel,
                    wh_real_t share, wh_line_t *line) {
    return is_of_travel(
        wh_line_plan(line, robot, from_q, share * travel->x, share * travel->y, share * travel->z, 0));
}

/* After which share of the line this axis leaves its travel; 2: it does not. */
static wh_real_t find_end(const wh_robot_t *alone, const wh_real_t from_q[], const wh_vec3_t *travel) {
    wh_line_t unused;
    wh_real_t good = 0, bad = 1;
    if (!refuses(alone, from_q, travel, 1, &unused)) {
        return 2;
    }
    while (bad - good > WH_REAL(1e-9)) {
        const wh_real_t middle = (good + bad) / 2;
        if (refuses(alone, from_q, travel, middle, &unused)) {
            bad = middle;
        } else {
            good = middle;
        }
    }
    return good;
}

void wh_travel_say_line(const wh_layout_t *layout, const wh_real_t from_q[WH_ROBOT_AXES],
                        const wh_vec3_t *travel, char text[WH_TRAVEL_BYTES]) {
    const wh_robot_t *robot = &layout->machine.robot;
    const wh_robot_t wide = with_travel_of(robot, NO_AXIS);
    const double length = wh_vec3_norm(travel);
    wh_real_t first = 2;
    wh_line_t line;
    text[0] = '\0';
    const wh_status_t status = wh_line_plan(&line, &wide, from_q, travel->x, travel->y, travel->z, 0);
    if (is_of_travel(status)) {
        put(text, "r: 0 (expected a line of %.7g mm beside the robot's own axis: move r off the axis first)",
            length);
        return;
    }
    for (int32_t axis = 0; status == WH_OK && axis < WH_ROBOT_AXES; ++axis) {
        const wh_robot_t alone = with_travel_of(robot, axis);
        const wh_real_t share = find_end(&alone, from_q, travel);
        wh_real_t value = line.to[axis];
        if (share <= 1) {
            if (axis == WH_AXIS_R && value <= robot->travel[axis].max) {
                (void)wh_travel_passes_axis(&line, &value);
            }
            put_axis(text, robot, (size_t)axis, value);
            first = share < first ? share : first;
        }
    }
    if (text[0]) {
        put(text, "; the line of %.7g mm comes to an end of travel after %.3f mm", length,
            (double)first * length);
    }
}
