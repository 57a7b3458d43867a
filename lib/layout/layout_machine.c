/* A layout's robot, and the mounts of its grippers. */
#include <stdio.h>
#include <string.h>

#include "../math/trig.h"
#include "layout_internal.h"

/* Degrees in a layout, radians in the library; lengths are mm in both. */
static wh_real_t to_layout(bool turns, wh_real_t value) {
    return turns ? wh_deg_from_rad(value) : value;
}

/* Conversion to degrees and back would round: a field with the value that is shown keeps the default's
 * bits. */
static wh_real_t read_quantity(wh_reader_t *reader, const char *field, bool turns, wh_real_t fallback,
                               wh_real_t min, wh_real_t max) {
    const wh_real_t shown = to_layout(turns, fallback);
    const wh_real_t value = wh_reader_number(reader, field, shown, min, max);
    return value == shown ? fallback : turns ? wh_rad_from_deg(value) : value;
}

static void read_axis_limits(wh_reader_t *reader, bool turns, wh_limits_t *limits) {
    limits->speed = read_quantity(reader, "speed", turns, limits->speed, 1e-6, 1e6);
    limits->acceleration = read_quantity(reader, "acceleration", turns, limits->acceleration, 1e-6, 1e8);
    limits->jerk = read_quantity(reader, "jerk", turns, limits->jerk, 1e-6, 1e10);
}

/* Checks defaults too: a travel that the layout gives may exclude the default home. */
static void check_travel(wh_reader_t *reader, bool turns, const wh_travel_t *travel, wh_real_t home) {
    const double min = to_layout(turns, travel->min);
    const double max = to_layout(turns, travel->max);
    if (!(travel->min < travel->max)) {
        lua_pushnumber(reader->L, max);
        wh_reader_fail(reader, "max", "a number above min, which is %.12g", min);
    }
    if (!(home >= travel->min && home <= travel->max)) {
        lua_pushnumber(reader->L, to_layout(turns, home));
        wh_reader_fail(reader, "home", "a number from %.12g to %.12g", min, max);
    }
}

static void read_axis(wh_reader_t *reader, wh_robot_t *robot, size_t axis, const char *name) {
    const bool turns = axis == WH_AXIS_THETA || axis == WH_AXIS_YAW;
    const wh_real_t reach = turns ? WH_REAL(1e6) : WH_REAL(1e5);
    wh_travel_t *travel = &robot->travel[axis];
    wh_reader_open_section(reader, name,
                           turns ? wh_layout_turning_axis_fields : wh_layout_straight_axis_fields);
    travel->min = read_quantity(reader, "min", turns, travel->min, axis == WH_AXIS_R ? 0 : -reach, reach);
    travel->max = read_quantity(reader, "max", turns, travel->max, to_layout(turns, travel->min), reach);
    robot->home[axis] = read_quantity(reader, "home", turns, robot->home[axis], to_layout(turns, travel->min),
                                      to_layout(turns, travel->max));
    check_travel(reader, turns, travel, robot->home[axis]);
    read_axis_limits(reader, turns, &robot->limits[axis]);
    wh_reader_leave(reader);
}

static void read_robot(wh_reader_t *reader, wh_robot_t *robot, wh_real_t *transit) {
    static const char *const kinds[] = {"TRZY", NULL};
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    wh_reader_open_section(reader, "robot", wh_layout_robot_fields);
    wh_reader_choice(reader, "kind", 0, kinds);
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        read_axis(reader, robot, axis, names[axis]);
    }
    if (wh_robot_validate(robot) != WH_OK) {
        wh_reader_fail(reader, NULL, "axes whose min is below max and whose home is between them");
    }
    *transit = wh_reader_has(reader, "transit") ? wh_reader_number(reader, "transit", 0, 1, 1e5) : 0;
    wh_reader_leave(reader);
}

void wh_layout_read_robot(wh_reader_t *reader, wh_layout_t *layout) {
    wh_machine_t *machine = &layout->machine;
    wh_robot_default(&machine->robot);
    machine->axis_count = WH_ROBOT_AXES;
    machine->chuck_limits = machine->robot.limits[WH_AXIS_YAW];
    read_robot(reader, &machine->robot, &layout->transit);
    layout->homed = wh_reader_boolean(reader, "homed", true);
    wh_reader_open_section(reader, "chuck", wh_layout_chuck_fields);
    read_axis_limits(reader, true, &machine->chuck_limits);
    wh_reader_leave(reader);
}

/* Mounts a gripper on the chuck of a prealigner, and gives the chuck an axis. */
static void mount_on_chuck(wh_reader_t *reader, wh_layout_t *layout, size_t g, const char *on) {
    wh_machine_t *machine = &layout->machine;
    const int32_t station = wh_layout_find_station(layout, on);
    if (station == WH_NONE || !layout->stations[station].prealigner) {
        wh_reader_refuse(reader, "on", on, "\"robot\" or the name of a station of kind \"prealigner\"");
    }
    if (layout->places[station].chuck != WH_NONE) {
        wh_reader_refuse(reader, "on", on, "a prealigner without a gripper; grippers[%d] is on this one",
                         (int)layout->places[station].chuck + 1);
    }
    if (machine->axis_count == WH_AXES) {
        wh_reader_refuse(reader, "on", on, "at most %d grippers on prealigners", WH_AXES - WH_ROBOT_AXES);
    }
    layout->places[station].chuck = (int32_t)g;
    layout->grippers[g].station = station;
    machine->mounts[g].axis = (int32_t)machine->axis_count++;
    machine->mounts[g].base_from_station = layout->places[station].base_from_station;
}

static void fail_at_vector(wh_reader_t *reader, const char *field, const char *expected) {
    (void)wh_reader_push(reader, field);
    wh_reader_fail(reader, field, "%s", expected);
}

/* The place of a blade on the end-effector. Without `at` and `rpy` the gripper is the end-effector itself. */
static void read_shift(wh_reader_t *reader, wh_mount_t *mount) {
    static const wh_vec3_t none = {0, 0, 0};
    const wh_vec3_t at = wh_reader_vector(reader, "at", &none);
    const wh_vec3_t rpy = wh_reader_vector(reader, "rpy", &none);
    if (wh_real_abs(rpy.x) > 0 || wh_real_abs(rpy.y) > 0) {
        fail_at_vector(reader, "rpy", "{ 0, 0, yaw }: a blade is as level as the arm");
    }
    mount->is_shifted = wh_real_abs(rpy.z) > 0 || wh_vec3_dot(&at, &at) > 0;
    if (mount->is_shifted) {
        mount->effector_from_gripper.r = at;
        mount->effector_from_gripper.R = wh_mat3_from_rpy_deg(0, 0, rpy.z);
    }
}

static void refuse_shift(wh_reader_t *reader) {
    static const char *const fields[] = {"at", "rpy"};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        if (wh_reader_has(reader, fields[i])) {
            fail_at_vector(reader, fields[i], "nothing: a chuck sits where its station is");
        }
    }
}

static void read_mount(wh_reader_t *reader, wh_layout_t *layout, size_t g) {
    char on[WH_NAME_SIZE];
    wh_reader_text(reader, "on", "robot", on, sizeof on);
    layout->grippers[g].station = WH_NONE;
    layout->machine.mounts[g].axis = WH_NONE;
    layout->machine.mounts[g].base_from_station = wh_pose_identity();
    layout->machine.mounts[g].effector_from_gripper = wh_pose_identity();
    if (strcmp(on, "robot") == 0) {
        read_shift(reader, &layout->machine.mounts[g]);
    } else {
        refuse_shift(reader);
        mount_on_chuck(reader, layout, g, on);
    }
}

static void read_gripper(wh_reader_t *reader, wh_layout_t *layout) {
    const size_t g = layout->machine.gripper_count;
    wh_layout_gripper_t *gripper = &layout->grippers[g];
    char valve[WH_NAME_SIZE];
    wh_reader_refuse_unknown(reader, wh_layout_gripper_fields);
    wh_reader_text(reader, "name", NULL, gripper->name, sizeof gripper->name);
    snprintf(valve, sizeof valve, "%.40s.valve", gripper->name);
    wh_reader_text(reader, "valve", valve, gripper->valve, sizeof gripper->valve);
    if (wh_layout_find_gripper(layout, gripper->name) != WH_NONE) {
        wh_reader_refuse(reader, "name", gripper->name, "a name that no other gripper has");
    }
    for (size_t other = 0; other < g; ++other) {
        if (strcmp(layout->grippers[other].valve, gripper->valve) == 0) {
            wh_reader_refuse(reader, "valve", gripper->valve, "an output that switches no other gripper");
        }
    }
    read_mount(reader, layout, g);
    ++layout->machine.gripper_count;
}

static void check_grippers(wh_reader_t *reader, const wh_layout_t *layout) {
    bool on_robot = false;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        on_robot = on_robot || layout->grippers[g].station == WH_NONE;
    }
    if (!on_robot) {
        wh_reader_fail(reader, NULL, "at least one gripper on = \"robot\"");
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->stations[s].prealigner && layout->places[s].chuck == WH_NONE) {
            wh_reader_fail(reader, NULL, "a gripper on = \"%s\", which is a prealigner",
                           layout->stations[s].name);
        }
    }
}

void wh_layout_read_grippers(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_reader_enter(reader, "grippers")) {
        wh_reader_refuse(reader, "grippers", NULL, "a list of grippers");
    }
    const size_t count = wh_reader_list(reader);
    if (count > WH_GRIPPERS) {
        wh_reader_fail(reader, NULL, "at most %d grippers", WH_GRIPPERS);
    }
    for (size_t g = 0; g < count; ++g) {
        wh_reader_enter_item(reader, (lua_Integer)g + 1);
        read_gripper(reader, layout);
        wh_reader_leave(reader);
    }
    check_grippers(reader, layout);
    wh_reader_leave(reader);
}
