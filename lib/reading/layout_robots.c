/* A layout with several robots, and how robots come to its stations. */
#include "../math/trig.h"
#include "layout_internal.h"

/* ---------------------------------------------------------------------------------------- several robots */

/* Feet nearer to each other than this, mm, are at one place. */
#define FEET_APART 1

static void refuse_one_place(wh_reader_t *reader, const wh_layout_t *layout, size_t r) {
    for (size_t other = 0; other < r; ++other) {
        const wh_chain_t *one = &layout->robots[r].carrier.chain;
        const wh_chain_t *two = &layout->robots[other].carrier.chain;
        const wh_vec3_t between = wh_vec3_subtract(&one->base_from_robot.r, &two->base_from_robot.r);
        if (wh_real_sqrt(between.x * between.x + between.y * between.y) < FEET_APART) {
            (void)wh_reader_push(reader, "at");
            wh_reader_fail(reader, "at", "a place of its own: %s stands there", layout->robots[other].name);
        }
    }
}

void wh_layout_read_robots(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_reader_enter(reader, "robots")) {
        wh_reader_refuse(reader, "robots", NULL, "a table of robots by name");
    }
    wh_reader_leave(reader);
    wh_layout_refuse_field(reader, "robot", "nothing: `robots` has them all");
    (void)wh_reader_enter(reader, "robots");
    layout->robots =
        wh_layout_read_keys(reader, WH_LAYOUT_ROBOTS, sizeof *layout->robots, "robots", &layout->robot_count);
    if (layout->robot_count == 0) {
        wh_reader_fail(reader, NULL, "at least one robot by name");
    }
    size_t axes = 0;
    for (size_t r = 0; r < layout->robot_count; ++r) {
        wh_layout_robot_t *robot = &layout->robots[r];
        wh_reader_enter(reader, robot->name);
        wh_reader_refuse_unknown(reader, wh_layout_robot_fields);
        wh_layout_read_carrier(reader, robot);
        refuse_one_place(reader, layout, r);
        wh_layout_read_loaded(reader, &robot->loaded);
        wh_reader_leave(reader);
        axes += robot->carrier.axis_count;
    }
    if (axes > WH_AXES) {
        lua_pushinteger(reader->L, (lua_Integer)axes);
        wh_reader_fail(reader, NULL, "robots with at most %d axes together", WH_AXES);
    }
    wh_reader_leave(reader);
    wh_layout_take_carriers(layout);
}

/* --------------------------------------------------------------------------------------------- stations */

/* The rail's place and the elbow's side for the station, or the robot's own part of it, at which the reader
 * is. */
static void read_stand(wh_reader_t *reader, const wh_chain_t *chain, wh_elbow_t usual, double *rail,
                       wh_elbow_t *elbow) {
    *elbow = usual;
    if (chain && chain->has_rail) {
        const wh_travel_t *travel = &chain->travel[WH_CHAIN_RAIL];
        *rail = wh_reader_number(reader, "rail", chain->home[WH_CHAIN_RAIL], travel->min, travel->max);
    } else {
        wh_layout_refuse_field(reader, "rail", "nothing: the robot has no rail");
    }
    if (chain && chain->kind == WH_CHAIN_SCARA) {
        const double side = wh_reader_apart_from(reader, "elbow", usual == WH_ELBOW_RIGHT ? 1 : 0);
        *elbow = side > 0 ? WH_ELBOW_RIGHT : WH_ELBOW_LEFT;
    } else {
        wh_layout_refuse_field(reader, "elbow", "nothing: the robot is not of kind \"SCARA\"");
    }
}

/* A robot's own way in: turned about the station's z alone, because the slots lie along z. */
static void read_way_in(wh_reader_t *reader, const wh_station_t *place, wh_layout_approach_t *approach) {
    static const wh_vec3_t level = {0, 0, 0};
    approach->is_turned = wh_reader_has(reader, "rpy");
    if (approach->is_turned) {
        const wh_vec3_t rpy = wh_reader_vector(reader, "rpy", &level);
        approach->R = wh_mat3_from_rpy_deg(rpy.x, rpy.y, rpy.z);
        const wh_vec3_t up = wh_mat3_column(&approach->R, 2);
        const wh_vec3_t own = wh_mat3_column(&place->base_from_station.R, 2);
        const wh_vec3_t between = wh_vec3_subtract(&up, &own);
        if (wh_vec3_norm(&between) > WH_REAL(1e-9)) {
            (void)wh_reader_push(reader, "rpy");
            wh_reader_fail(reader, "rpy", "one whose z is the station's own: turned about that alone");
        }
    }
}

/* Reads where the robot was taught slot 1. The station stays where it is. */
static void read_taught(wh_reader_t *reader, const wh_station_t *place, wh_layout_approach_t *approach) {
    const wh_vec3_t *own = &place->base_from_station.r;
    const wh_vec3_t at = wh_reader_vector(reader, "at", own);
    approach->aside = wh_vec3_subtract(&at, own);
    const wh_vec3_t *aside = &approach->aside;
    if (!(wh_real_abs(aside->x) <= WH_LAYOUT_ASIDE && wh_real_abs(aside->y) <= WH_LAYOUT_ASIDE &&
          wh_real_abs(aside->z) <= WH_LAYOUT_ASIDE)) {
        (void)wh_reader_push(reader, "at");
        wh_reader_fail(reader, "at", "numbers up to %d mm beside the station's own `at`", WH_LAYOUT_ASIDE);
    }
}

static bool is_timed(const wh_layout_t *layout, const char *name) {
    return layout->timed && wh_flow_robot_named(layout->timed, name) != WH_FLOW_NONE;
}

/* Refuses names in `by` that no robot has, and a table without any. */
static void check_by(wh_reader_t *reader, const wh_layout_t *layout) {
    size_t count = 0;
    const wh_layout_robot_t *said =
        wh_layout_read_keys(reader, WH_LAYOUT_STATIONS, sizeof *said, "robots", &count);
    for (size_t i = 0; i < count; ++i) {
        if (wh_layout_find_robot(layout, said[i].name) == WH_NONE && !is_timed(layout, said[i].name)) {
            lua_pushstring(reader->L, said[i].name);
            wh_reader_fail(reader, NULL, "robots of this layout by name");
        }
    }
    if (count == 0) {
        wh_reader_fail(reader, NULL, "at least one robot by name");
    }
}

/* `by`: without it any robot may come. */
static void read_by(wh_reader_t *reader, const wh_layout_t *layout, size_t s) {
    wh_layout_station_t *station = &layout->stations[s];
    station->by = wh_layout_memory(reader->L, layout->robot_count, sizeof *station->by);
    wh_layout_refuse_field(reader, "rail", "nothing: with several robots `by` says it of each");
    wh_layout_refuse_field(reader, "elbow", "nothing: with several robots `by` says it of each");
    const bool is_said = wh_reader_enter(reader, "by");
    if (is_said) {
        check_by(reader, layout);
    }
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const wh_layout_robot_t *robot = &layout->robots[r];
        const wh_chain_t *chain = &robot->carrier.chain;
        wh_layout_approach_t *approach = &station->by[r];
        approach->rail = chain->home[WH_CHAIN_RAIL];
        approach->elbow = robot->elbow;
        if (is_said && wh_reader_open(reader, robot->name, wh_layout_approach_fields)) {
            approach->serves = true;
            wh_layout_check_taught(reader);
            if (station->by_axes) {
                wh_layout_refuse_field(reader, "at", "nothing: the station has no `at` that it is beside");
            }
            read_way_in(reader, &layout->places[s], approach);
            read_taught(reader, &layout->places[s], approach);
            read_stand(reader, chain, robot->elbow, &approach->rail, &approach->elbow);
            wh_reader_leave(reader);
        }
    }
    if (is_said) {
        wh_reader_leave(reader);
    }
}

void wh_layout_read_approach(wh_reader_t *reader, const wh_layout_t *layout, size_t s) {
    wh_layout_station_t *station = &layout->stations[s];
    const wh_chain_t *chain = layout->machine.carrier ? &layout->carrier.chain : NULL;
    const bool is_robot =
        wh_layout_find_robot(layout, station->name) != WH_NONE || is_timed(layout, station->name);
    if (is_robot && wh_layout_is_shared(layout)) {
        wh_reader_fail(reader, NULL, "a name that no robot has");
    }
    if (wh_layout_is_shared(layout)) {
        station->elbow = layout->elbow;
        read_by(reader, layout, s);
    } else {
        wh_layout_refuse_field(reader, "by", "nothing: it is for a layout with several robots");
        read_stand(reader, chain, layout->elbow, &station->rail, &station->elbow);
    }
}

/* The gripper in a slot of the station, or `before` it, mm. */
static bool reaches_slot(const wh_layout_t *layout, size_t s, const wh_layout_approach_t *approach,
                         int32_t slot, wh_real_t before) {
    const wh_machine_t *machine = &layout->machine;
    const size_t robot = machine->mounts[approach->effector].robot;
    wh_pose_t base_from_gripper = wh_station_slot(&layout->places[s], slot);
    base_from_gripper.R = approach->is_turned ? approach->R : base_from_gripper.R;
    if (!layout->robots[robot].carrier.chain.has_tilt) {
        base_from_gripper.R =
            wh_mat3_about_z(wh_atan2(base_from_gripper.R.m[1][0], base_from_gripper.R.m[0][0]));
    }
    const wh_vec3_t in = wh_mat3_column(&base_from_gripper.R, 0);
    const wh_vec3_t way = wh_vec3_scale(before, &in);
    base_from_gripper.r = wh_vec3_subtract(&base_from_gripper.r, &way);
    const wh_chain_choice_t choice = {approach->rail, 0, approach->elbow};
    wh_real_t axes[WH_AXES];
    wh_machine_home(machine, axes);
    return wh_machine_bring(machine, (size_t)approach->effector, &base_from_gripper, &choice, axes, axes) ==
           WH_OK;
}

static bool reaches(const wh_layout_t *layout, size_t s, const wh_layout_approach_t *approach) {
    const int32_t last = layout->places[s].slots;
    const wh_real_t retract = layout->stations[s].retract;
    return reaches_slot(layout, s, approach, 1, 0) && reaches_slot(layout, s, approach, last, 0) &&
           reaches_slot(layout, s, approach, 1, retract) && reaches_slot(layout, s, approach, last, retract);
}

/* How many robots serve the station; the last of them becomes its robot. */
static size_t find_servers(wh_reader_t *reader, const wh_layout_t *layout, size_t s) {
    wh_layout_station_t *station = &layout->stations[s];
    const uint8_t named = layout->machine.mounts[station->effector].robot;
    const bool is_by = wh_reader_has(reader, "by");
    size_t count = 0;
    for (size_t r = 0; r < layout->robot_count; ++r) {
        wh_layout_approach_t *approach = &station->by[r];
        const bool is_named = wh_reader_has(reader, "effector") && named == r;
        approach->effector = is_named ? station->effector : wh_layout_first_gripper(layout, r);
        approach->serves = is_by ? approach->serves : reaches(layout, s, approach);
        count += approach->serves ? 1 : 0;
        station->robot = approach->serves ? (int32_t)r : station->robot;
    }
    return count;
}

/* Finds the robot that serves a station: the one with the effector that the station names, else the only
 * robot in `by`, else the only one that comes there. */
void wh_layout_read_server(wh_reader_t *reader, wh_layout_t *layout, size_t s) {
    wh_layout_station_t *station = &layout->stations[s];
    if (!station->by) {
        return;
    }
    const uint8_t named = layout->machine.mounts[station->effector].robot;
    const size_t count = find_servers(reader, layout, s);
    if (wh_reader_has(reader, "effector")) {
        station->robot = named;
        if (wh_reader_has(reader, "by") && !station->by[named].serves) {
            wh_reader_refuse(reader, "effector", layout->grippers[station->effector].name,
                             "a gripper on a robot that `by` names");
        }
    } else if (count > 1) {
        station->robot = WH_NONE;
    }
    station->taught = station->taught && wh_layout_is_served(layout, s);
    const int32_t robot = station->robot == WH_NONE ? 0 : station->robot;
    station->effector = station->by[robot].effector;
    station->rail = station->by[robot].rail;
    station->elbow = station->by[robot].elbow;
}
