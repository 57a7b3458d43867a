/* The mounts of a layout's grippers. */
#include <stdio.h>
#include <string.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "layout_internal.h"

void wh_layout_read_loaded(wh_reader_t *reader, wh_limits_t *loaded) {
    if (wh_reader_open(reader, "loaded", wh_layout_loaded_fields)) {
        loaded->speed = wh_reader_apart_from(reader, "speed", 0);
        loaded->acceleration = wh_reader_apart_from(reader, "acceleration", 0);
        loaded->jerk = wh_reader_apart_from(reader, "jerk", 0);
        wh_reader_leave(reader);
    }
}

void wh_layout_read_limits(wh_reader_t *reader, wh_limits_t *limits) {
    limits->speed = wh_reader_apart(reader, "speed");
    limits->acceleration = wh_reader_apart(reader, "acceleration");
    limits->jerk = wh_reader_apart(reader, "jerk");
}

/* Reads what the axes of a gripper on a prealigner do; by default it is a chuck that turns. */
static void read_kind(wh_reader_t *reader, wh_mount_t *mount) {
    mount->kind = WH_MOUNT_CHUCK;
    if (wh_reader_open(reader, "stage", wh_layout_stage_fields)) {
        mount->kind = WH_MOUNT_STAGE;
        mount->travel.max = wh_reader_apart(reader, "travel");
        mount->travel.min = -mount->travel.max;
        wh_layout_read_limits(reader, &mount->limits);
        wh_reader_leave(reader);
    }
    if (wh_reader_open(reader, "pins", wh_layout_pins_fields)) {
        if (mount->kind == WH_MOUNT_STAGE) {
            wh_reader_fail(reader, NULL,
                           "nothing: this gripper is a chuck on a stage, and pins are one of their own");
        }
        mount->kind = WH_MOUNT_PINS;
        mount->travel.min = -wh_reader_apart(reader, "down");
        mount->travel.max = wh_reader_apart(reader, "up");
        wh_layout_read_limits(reader, &mount->limits);
        wh_reader_leave(reader);
    }
}

/* A flipper's clamp, which turns over about the middle of a wafer. */
static void read_flipper(wh_reader_t *reader, const wh_layout_t *layout, wh_mount_t *mount) {
    wh_layout_refuse_field(reader, "stage", "nothing: the gripper of a flipper clamps and turns over");
    wh_layout_refuse_field(reader, "pins", "nothing: the gripper of a flipper clamps and turns over");
    mount->kind = WH_MOUNT_FLIPPER;
    mount->height = layout->wafer_thickness / 2;
    mount->travel.max = WH_PI;
    mount->limits = wh_layout_usual_limits(wh_layout_flipper_fields, true);
    wh_reader_open_section(reader, "flipper", wh_layout_flipper_fields);
    if (wh_reader_has(reader, "seconds")) {
        wh_layout_read_seconds(reader, WH_PI, &mount->limits);
    } else {
        wh_layout_read_axis_limits(reader, true, &mount->limits);
    }
    wh_reader_leave(reader);
}

static int32_t find_host(wh_reader_t *reader, const wh_layout_t *layout, const char *on) {
    const int32_t station = wh_layout_find_station(layout, on);
    if (station == WH_NONE || !(layout->stations[station].prealigner || layout->stations[station].flipper)) {
        wh_reader_refuse(reader, "on", on,
                         "%s or the name of a station of kind \"prealigner\" or \"flipper\"",
                         layout->robot_count > 1 ? "a robot's name" : "\"robot\"");
    }
    return station;
}

/* No prealigner or flipper has two grippers of one kind. */
static void check_alone(wh_reader_t *reader, const wh_layout_t *layout, int32_t station, bool is_pins) {
    const int32_t other = is_pins ? wh_layout_find_pins(layout, station) : layout->places[station].chuck;
    if (other != WH_NONE) {
        wh_reader_refuse(reader, "on", layout->stations[station].name,
                         "a %s without %s; grippers[%d] is on this one",
                         layout->stations[station].flipper ? "flipper" : "prealigner",
                         is_pins ? "pins" : "a gripper", (int)other + 1);
    }
}

/* Mounts a gripper on a prealigner, as its chuck or as its pins, or on a flipper, and gives it axes. */
static void mount_on_station(wh_reader_t *reader, wh_layout_t *layout, size_t g, const char *on) {
    wh_machine_t *machine = &layout->machine;
    wh_mount_t *mount = &machine->mounts[g];
    const int32_t station = find_host(reader, layout, on);
    if (layout->stations[station].flipper) {
        read_flipper(reader, layout, mount);
    } else {
        wh_layout_refuse_field(reader, "flipper", "nothing: this is of a gripper on a station of that kind");
        read_kind(reader, mount);
    }
    const bool is_pins = mount->kind == WH_MOUNT_PINS;
    check_alone(reader, layout, station, is_pins);
    mount->axis = (int32_t)machine->axis_count;
    mount->base_from_station = layout->places[station].base_from_station;
    machine->axis_count += wh_mount_axes(mount);
    if (machine->axis_count > WH_AXES) {
        wh_reader_refuse(
            reader, "on", on,
            "at most %d axes at stations: a chuck has one, on a stage three, pins and a flipper have one",
            (int)(WH_AXES - wh_machine_robot_axes(machine)));
    }
    layout->grippers[g].station = station;
    if (!is_pins) {
        layout->places[station].chuck = (int32_t)g;
    }
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

/* Which arm or wrist of a robot that has two. */
static void read_arm(wh_reader_t *reader, const wh_machine_t *machine, wh_mount_t *mount) {
    static const char *const fields[] = {"arm", "wrist"};
    const wh_carrier_t *carrier = wh_machine_carrier(machine, mount->robot, NULL);
    const wh_carrier_t *second = carrier ? carrier->second : NULL;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        if (second && (second->chain.kind == WH_CHAIN_SCARA) == (i == 1)) {
            mount->arm = (uint8_t)(wh_reader_apart(reader, fields[i]) - 1);
        } else if (wh_reader_has(reader, fields[i])) {
            (void)wh_reader_push(reader, fields[i]);
            wh_reader_fail(reader, fields[i], "nothing: the robot does not have two %ss", fields[i]);
        }
    }
}

static void refuse_fields(wh_reader_t *reader, const char *const fields[], size_t count,
                          const char *expected) {
    for (size_t i = 0; i < count; ++i) {
        if (wh_reader_has(reader, fields[i])) {
            fail_at_vector(reader, fields[i], expected);
        }
    }
}

static void read_mount(wh_reader_t *reader, wh_layout_t *layout, size_t g) {
    char on[WH_NAME_SIZE];
    wh_reader_text(reader, "on", layout->robot_count > 1 ? NULL : layout->robots[0].name, on, sizeof on);
    const int32_t robot = wh_layout_find_robot(layout, on);
    layout->grippers[g].station = WH_NONE;
    layout->machine.mounts[g].axis = WH_NONE;
    layout->machine.mounts[g].base_from_station = wh_pose_identity();
    layout->machine.mounts[g].effector_from_gripper = wh_pose_identity();
    if (robot != WH_NONE) {
        static const char *const of_station[] = {"stage", "pins", "flipper"};
        refuse_fields(reader, of_station, 3, "nothing: this is of a gripper at a station");
        layout->machine.mounts[g].robot = (uint8_t)robot;
        read_shift(reader, &layout->machine.mounts[g]);
        read_arm(reader, &layout->machine, &layout->machine.mounts[g]);
    } else {
        static const char *const of_robot[] = {"at", "rpy", "arm", "wrist"};
        refuse_fields(reader, of_robot, 4, "nothing: a chuck sits where its station is");
        mount_on_station(reader, layout, g, on);
    }
}

static void read_gripper(wh_reader_t *reader, wh_layout_t *layout) {
    const size_t g = layout->machine.gripper_count;
    wh_layout_gripper_t *gripper = &layout->grippers[g];
    char valve[sizeof gripper->valve];
    wh_reader_refuse_unknown(reader, wh_layout_gripper_fields);
    wh_reader_text(reader, "name", NULL, gripper->name, sizeof gripper->name);
    snprintf(valve, sizeof valve, "%s.valve", gripper->name);
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
    wh_layout_read_loaded(reader, &gripper->loaded);
    wh_layout_read_grip(reader, layout, g);
    ++layout->machine.gripper_count;
}

static void check_robot(wh_reader_t *reader, const wh_layout_t *layout, size_t robot) {
    bool on_robot = false;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        on_robot =
            on_robot || (layout->grippers[g].station == WH_NONE && layout->machine.mounts[g].robot == robot);
    }
    if (!on_robot) {
        wh_reader_fail(reader, NULL, "at least one gripper on = \"%s\"", layout->robots[robot].name);
    }
}

static bool has_gripper_on_second(const wh_layout_t *layout, size_t robot) {
    bool has = false;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_mount_t *mount = &layout->machine.mounts[g];
        has = has || (layout->grippers[g].station == WH_NONE && mount->robot == robot && mount->arm == 1);
    }
    return has;
}

static void check_second_arm(wh_reader_t *reader, const wh_layout_t *layout, size_t robot) {
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, NULL);
    const bool is_named = layout->robot_count > 1;
    if (carrier && carrier->second && !has_gripper_on_second(layout, robot)) {
        wh_reader_fail(reader, NULL, "at least one gripper with %s = 2%s%s",
                       carrier->chain.kind == WH_CHAIN_SCARA ? "wrist" : "arm", is_named ? " on " : "",
                       is_named ? layout->robots[robot].name : "");
    }
}

static void check_grippers(wh_reader_t *reader, const wh_layout_t *layout) {
    for (size_t robot = 0; robot < layout->robot_count; ++robot) {
        check_robot(reader, layout, robot);
        check_second_arm(reader, layout, robot);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        const bool is_flipper = layout->stations[s].flipper;
        if ((layout->stations[s].prealigner || is_flipper) && layout->places[s].chuck == WH_NONE) {
            wh_reader_fail(reader, NULL, "a gripper on = \"%s\", which is a %s", layout->stations[s].name,
                           is_flipper ? "flipper" : "prealigner");
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
