/* A layout's robot, of any kind. */
#include <stdio.h>
#include <string.h>

#include "../layout/axes.h"
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

/* Likewise, within the row's range. */
static wh_real_t read_ranged(wh_reader_t *reader, const char *field, bool turns, wh_real_t fallback) {
    const wh_reader_field_t *row = wh_reader_row(reader, field);
    return read_quantity(reader, field, turns, fallback, row->least, row->most);
}

static const char *const limit_names[] = {"speed", "acceleration", "jerk"};

void wh_layout_read_axis_limits(wh_reader_t *reader, bool turns, wh_limits_t *limits) {
    limits->speed = read_ranged(reader, "speed", turns, limits->speed);
    limits->acceleration = read_ranged(reader, "acceleration", turns, limits->acceleration);
    limits->jerk = read_ranged(reader, "jerk", turns, limits->jerk);
}

wh_limits_t wh_layout_usual_limits(const wh_reader_field_t *rows, bool turns) {
    wh_real_t usual[3];
    for (size_t i = 0; i < 3; ++i) {
        usual[i] = (wh_real_t)wh_field_find(rows, limit_names[i])->usual;
        usual[i] = turns ? wh_rad_from_deg(usual[i]) : usual[i];
    }
    return (wh_limits_t){usual[0], usual[1], usual[2]};
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

/* The place into which the reader reads an axis. */
typedef struct {
    const char *name;
    bool turns;
    wh_real_t least, most; /* of its travel, in the layout's units */
    wh_travel_t *travel;
    wh_limits_t *limits;
    wh_real_t *home;
} axis_t;

static void read_axis(wh_reader_t *reader, const axis_t *axis) {
    wh_travel_t *travel = axis->travel;
    wh_reader_open_section(reader, axis->name,
                           axis->turns ? wh_layout_turning_axis_fields : wh_layout_straight_axis_fields);
    travel->min = read_quantity(reader, "min", axis->turns, travel->min, axis->least, axis->most);
    travel->max = read_quantity(reader, "max", axis->turns, travel->max, to_layout(axis->turns, travel->min),
                                axis->most);
    *axis->home = read_quantity(reader, "home", axis->turns, *axis->home, to_layout(axis->turns, travel->min),
                                to_layout(axis->turns, travel->max));
    check_travel(reader, axis->turns, travel, *axis->home);
    wh_layout_read_axis_limits(reader, axis->turns, axis->limits);
    wh_reader_leave(reader);
}

/* ------------------------------------------------------------------------------------- TRZY at the origin */

static void read_plain(wh_reader_t *reader, wh_robot_t *robot) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        const bool turns = i == WH_AXIS_THETA || i == WH_AXIS_YAW;
        const wh_real_t most = turns ? WH_REAL(1e6) : WH_REAL(1e5);
        const axis_t axis = {
            names[i],          turns,          i == WH_AXIS_R ? 0 : -most, most, &robot->travel[i],
            &robot->limits[i], &robot->home[i]};
        read_axis(reader, &axis);
    }
    if (wh_robot_validate(robot) != WH_OK) {
        wh_reader_fail(reader, NULL, "axes whose min is below max and whose home is between them");
    }
}

/* ------------------------------------------------------------------------------------------ other kinds */

void wh_layout_refuse_field(wh_reader_t *reader, const char *field, const char *expected) {
    if (wh_reader_has(reader, field)) {
        (void)wh_reader_push(reader, field);
        wh_reader_fail(reader, field, "%s", expected);
    }
}

static void refuse_scara(wh_reader_t *reader) {
    static const char *const of_scara[] = {"links", "elbow", "forearm", "wrists"};
    for (size_t i = 0; i < sizeof of_scara / sizeof of_scara[0]; ++i) {
        wh_layout_refuse_field(reader, of_scara[i], "nothing: this is of a robot of kind \"SCARA\"");
    }
}

/* Refuses fields that this kind does not have. */
static void refuse_others(wh_reader_t *reader, wh_chain_kind_t kind) {
    if (kind != WH_CHAIN_SCARA) {
        refuse_scara(reader);
    }
    if (kind != WH_CHAIN_TRZ) {
        wh_layout_refuse_field(reader, "arms", "nothing: this is of a robot of kind \"TRZ\"");
    }
    if (kind == WH_CHAIN_SCARA) {
        wh_layout_refuse_field(reader, "r", "nothing: a robot of kind \"SCARA\" has a forearm");
        wh_layout_refuse_field(reader, "transit",
                               "nothing: it is for a robot of kind \"TRZY\" or \"TRZ\"; `via` points "
                               "fold an elbow");
    } else if (kind == WH_CHAIN_TRZ) {
        wh_layout_refuse_field(reader, "yaw", "nothing: a robot of kind \"TRZ\" has no wrist");
    }
}

static void read_links(wh_reader_t *reader, wh_real_t links[2]) {
    static const char expected[] =
        "a list of two lengths from 1 to 10000 mm: shoulder to elbow, elbow to wrist";
    const bool is_table = wh_reader_push(reader, "links") == LUA_TTABLE;
    bool sound = is_table && lua_rawlen(reader->L, -1) == 2;
    for (lua_Integer i = 0; sound && i < 2; ++i) {
        sound = lua_rawgeti(reader->L, -1, i + 1) == LUA_TNUMBER;
        links[i] = lua_tonumber(reader->L, -1);
        sound = sound && links[i] >= 1 && links[i] <= 10000;
        lua_pop(reader->L, 1);
    }
    if (!sound) {
        wh_reader_fail(reader, "links", "%s", expected);
    }
    lua_pop(reader->L, 1);
}

/* The usual size of what motion/robot.h does not have. */
static const wh_travel_t rail_travel = {-1000, 1000};
static const wh_limits_t rail_limits = {1000, 3000, 30000};

static wh_travel_t turn_travel(wh_real_t degrees) {
    const wh_travel_t travel = {wh_rad_from_deg(-degrees), wh_rad_from_deg(degrees)};
    return travel;
}

static void start_chain(wh_chain_t *chain, wh_chain_kind_t kind, bool is_left) {
    static const size_t axes[WH_ROBOT_AXES] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};
    const wh_limits_t tilt_limits = {wh_rad_from_deg(10), wh_rad_from_deg(50), wh_rad_from_deg(500)};
    wh_robot_t robot;
    wh_robot_default(&robot);
    chain->kind = kind;
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        chain->travel[axes[i]] = robot.travel[i];
        chain->limits[axes[i]] = robot.limits[i];
        chain->home[axes[i]] = robot.home[i];
    }
    chain->travel[WH_CHAIN_RAIL] = rail_travel;
    chain->limits[WH_CHAIN_RAIL] = rail_limits;
    for (size_t axis = WH_CHAIN_TILT_X; axis <= WH_CHAIN_TILT_Y; ++axis) {
        chain->travel[axis] = turn_travel(3);
        chain->limits[axis] = tilt_limits;
    }
    chain->travel[WH_CHAIN_FLIP].max = WH_PI;
    chain->limits[WH_CHAIN_FLIP] = wh_layout_usual_limits(wh_layout_flip_axis_fields, true);
    if (kind == WH_CHAIN_SCARA) { /* folded, the blade along the line from the shoulder */
        chain->travel[WH_CHAIN_REACH] = turn_travel(165);
        chain->limits[WH_CHAIN_REACH] = robot.limits[WH_AXIS_YAW];
        chain->home[WH_CHAIN_REACH] = wh_rad_from_deg(is_left ? -140 : 140);
        chain->home[WH_CHAIN_YAW] = wh_rad_from_deg(is_left ? 70 : -70);
    } else if (kind == WH_CHAIN_TRZ) {
        chain->travel[WH_CHAIN_YAW] = turn_travel(0);
    }
}

static void read_chain_axis(wh_reader_t *reader, wh_chain_t *chain, size_t axis, const char *name, bool turns,
                            wh_real_t least, wh_real_t most) {
    const axis_t read = {
        name, turns, least, most, &chain->travel[axis], &chain->limits[axis], &chain->home[axis]};
    read_axis(reader, &read);
}

static void read_arm(wh_reader_t *reader, wh_chain_t *chain) {
    const wh_real_t far = WH_REAL(1e5);
    const wh_real_t round = WH_REAL(1e6);
    read_chain_axis(reader, chain, WH_CHAIN_THETA, "theta", true, -round, round);
    if (chain->kind == WH_CHAIN_SCARA) {
        read_links(reader, chain->links);
        read_chain_axis(reader, chain, WH_CHAIN_REACH, "forearm", true, -180, 180);
    } else {
        read_chain_axis(reader, chain, WH_CHAIN_REACH, "r", false, 0, far);
    }
    read_chain_axis(reader, chain, WH_CHAIN_Z, "z", false, -far, far);
    if (chain->kind != WH_CHAIN_TRZ) {
        read_chain_axis(reader, chain, WH_CHAIN_YAW, "yaw", true, -round, round);
    }
}

/* One section for both tilts. */
static void read_tilt(wh_reader_t *reader, wh_chain_t *chain) {
    const wh_real_t most = 57;
    read_chain_axis(reader, chain, WH_CHAIN_TILT_X, "tilt", true, -most, most);
    chain->travel[WH_CHAIN_TILT_Y] = chain->travel[WH_CHAIN_TILT_X];
    chain->limits[WH_CHAIN_TILT_Y] = chain->limits[WH_CHAIN_TILT_X];
    chain->home[WH_CHAIN_TILT_Y] = chain->home[WH_CHAIN_TILT_X];
}

void wh_layout_read_seconds(wh_reader_t *reader, wh_real_t way, wh_limits_t *limits) {
    wh_profile_t profile;
    const wh_real_t seconds = wh_reader_apart(reader, "seconds");
    for (size_t i = 0; i < sizeof limit_names / sizeof limit_names[0]; ++i) {
        wh_layout_refuse_field(reader, limit_names[i], "nothing: `seconds` says how fast it goes");
    }
    if (wh_profile_plan(&profile, way, limits) == WH_OK) {
        const wh_real_t faster = wh_profile_duration(&profile) / seconds;
        limits->speed *= faster;
        limits->acceleration *= faster * faster;
        limits->jerk *= faster * faster * faster;
    }
}

static void read_flip(wh_reader_t *reader, wh_chain_t *chain) {
    wh_travel_t *travel = &chain->travel[WH_CHAIN_FLIP];
    wh_limits_t *limits = &chain->limits[WH_CHAIN_FLIP];
    wh_reader_open_section(reader, "flip", wh_layout_flip_axis_fields);
    travel->min = read_ranged(reader, "min", true, travel->min);
    travel->max = read_ranged(reader, "max", true, travel->max);
    chain->flip_height = wh_reader_apart(reader, "height");
    if (wh_reader_has(reader, "seconds")) {
        wh_layout_read_seconds(reader, WH_PI, limits);
    } else {
        wh_layout_read_axis_limits(reader, true, limits);
    }
    wh_reader_leave(reader);
}

static void read_foot(wh_reader_t *reader, wh_chain_t *chain) {
    static const wh_vec3_t origin = {0, 0, 0};
    const wh_vec3_t at = wh_reader_vector(reader, "at", &origin);
    const wh_real_t heading = wh_reader_apart(reader, "heading");
    chain->is_placed = wh_vec3_dot(&at, &at) > 0 || wh_real_abs(heading) > 0;
    chain->base_from_robot.r = at;
    chain->base_from_robot.R = wh_mat3_from_rpy_deg(0, 0, heading);
    chain->has_rail = wh_reader_has(reader, "rail");
    if (chain->has_rail) {
        read_chain_axis(reader, chain, WH_CHAIN_RAIL, "rail", false, WH_REAL(-1e5), WH_REAL(1e5));
    }
    chain->has_tilt = wh_reader_has(reader, "tilt");
    if (chain->has_tilt) {
        read_tilt(reader, chain);
    }
    chain->has_flip = wh_reader_has(reader, "flip");
    if (chain->has_flip) {
        read_flip(reader, chain);
    }
}

/* ------------------------------------------------------------------------------------------------- arms */

typedef struct {
    wh_real_t heading, height; /* rad, mm */
} arm_t;

/* How many arms or wrists are given: 0 to 2. */
static size_t read_arms(wh_reader_t *reader, wh_chain_kind_t kind, arm_t arms[2]) {
    const bool is_scara = kind == WH_CHAIN_SCARA;
    if (kind == WH_CHAIN_TRZY || !wh_reader_enter(reader, is_scara ? "wrists" : "arms")) {
        return 0;
    }
    const size_t count = wh_reader_list(reader);
    if (count < 1 || count > 2) {
        wh_reader_fail(reader, NULL, "one or two");
    }
    for (size_t i = 0; i < count; ++i) {
        wh_reader_enter_item(reader, (lua_Integer)i + 1);
        wh_reader_refuse_unknown(reader,
                                 is_scara ? wh_layout_robot_wrist_fields : wh_layout_robot_arm_fields);
        arms[i].heading = wh_rad_from_deg(wh_reader_apart(reader, "heading"));
        arms[i].height = wh_reader_apart(reader, "height");
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
    return count;
}

static void take_first_arm(wh_chain_t *chain, const arm_t *arm) {
    chain->height = arm->height;
    if (chain->kind == WH_CHAIN_SCARA) {
        chain->home[WH_CHAIN_YAW] += arm->heading;
    } else {
        chain->arm_heading = arm->heading;
    }
}

static void add_second_arm(wh_reader_t *reader, wh_carrier_t *carrier, const arm_t arms[2]) {
    wh_carrier_t *second = wh_layout_memory(reader->L, 1, sizeof *second);
    const bool is_scara = carrier->chain.kind == WH_CHAIN_SCARA;
    const wh_real_t heading = arms[1].heading - (is_scara ? arms[0].heading : 0);
    if (wh_carrier_add(carrier, second, heading, arms[1].height) != WH_OK) {
        wh_reader_fail(reader, NULL, "a second wrist whose home is within yaw's travel");
    }
}

static void read_transit(wh_reader_t *reader, wh_layout_robot_t *robot) {
    robot->transit = wh_reader_apart_from(reader, "transit", 0);
}

static void read_chain(wh_reader_t *reader, wh_layout_robot_t *robot, wh_chain_kind_t kind) {
    wh_chain_t chain;
    memset(&chain, 0, sizeof chain);
    refuse_others(reader, kind);
    if (kind == WH_CHAIN_SCARA) {
        robot->elbow = wh_reader_apart(reader, "elbow") > 0 ? WH_ELBOW_RIGHT : WH_ELBOW_LEFT;
    }
    start_chain(&chain, kind, robot->elbow == WH_ELBOW_LEFT);
    read_arm(reader, &chain);
    read_foot(reader, &chain);
    arm_t arms[2] = {{0, 0}, {0, 0}};
    const size_t arm_count = read_arms(reader, kind, arms);
    take_first_arm(&chain, &arms[0]);
    if (wh_carrier_init(&robot->carrier, &chain) != WH_OK) {
        wh_reader_fail(reader, NULL, "axes whose min is below max and whose home is between them");
    }
    if (arm_count == 2) {
        add_second_arm(reader, &robot->carrier, arms);
    }
    read_transit(reader, robot);
}

void wh_layout_read_carrier(wh_reader_t *reader, wh_layout_robot_t *robot) {
    read_chain(reader, robot, (wh_chain_kind_t)wh_reader_apart(reader, "kind"));
}

void wh_layout_take_carriers(wh_layout_t *layout) {
    for (size_t r = 1; r < layout->robot_count; ++r) {
        layout->robots[r - 1].carrier.next = &layout->robots[r].carrier;
    }
    layout->carrier = layout->robots[0].carrier;
    layout->elbow = layout->robots[0].elbow;
    wh_machine_take_carrier(&layout->machine, &layout->carrier);
}

/* --------------------------------------------------------------------------------------------------- both */

static bool is_at_origin(wh_reader_t *reader) {
    static const wh_vec3_t origin = {0, 0, 0};
    const wh_vec3_t at = wh_reader_vector(reader, "at", &origin);
    const wh_real_t heading = wh_reader_apart(reader, "heading");
    return !(wh_vec3_dot(&at, &at) > 0) && !(wh_real_abs(heading) > 0);
}

/* A default that is written out makes no other robot. */
static bool is_plain(wh_reader_t *reader, wh_chain_kind_t kind) {
    return kind == WH_CHAIN_TRZY && is_at_origin(reader) && !wh_reader_has(reader, "rail") &&
           !wh_reader_has(reader, "tilt") && !wh_reader_has(reader, "flip");
}

static void read_robot(wh_reader_t *reader, wh_layout_t *layout) {
    layout->robot_count = 1;
    layout->robots = wh_layout_memory(reader->L, 1, sizeof *layout->robots);
    snprintf(layout->robots[0].name, sizeof layout->robots[0].name, "robot");
    wh_reader_open_section(reader, "robot", wh_layout_robot_fields);
    const wh_chain_kind_t kind = (wh_chain_kind_t)wh_reader_apart(reader, "kind");
    if (!is_plain(reader, kind)) {
        read_chain(reader, &layout->robots[0], kind);
        wh_layout_take_carriers(layout);
    } else {
        read_plain(reader, &layout->machine.robot);
        refuse_scara(reader);
        wh_layout_refuse_field(reader, "arms", "nothing: this is of a robot of kind \"TRZ\"");
        read_transit(reader, &layout->robots[0]);
    }
    wh_layout_read_loaded(reader, &layout->robots[0].loaded);
    wh_reader_leave(reader);
}

void wh_layout_read_robot(wh_reader_t *reader, wh_layout_t *layout) {
    wh_machine_t *machine = &layout->machine;
    wh_robot_default(&machine->robot);
    machine->axis_count = WH_ROBOT_AXES;
    machine->chuck_limits = machine->robot.limits[WH_AXIS_YAW];
    if (wh_reader_has(reader, "robots")) {
        wh_layout_read_robots(reader, layout);
    } else {
        read_robot(reader, layout);
    }
    wh_reader_open_section(reader, "chuck", wh_layout_chuck_fields);
    wh_layout_read_axis_limits(reader, true, &machine->chuck_limits);
    wh_reader_leave(reader);
}
