/* Stations that were taught: the axes with which a gripper stood in slot 1 say where that is. */
#include <math.h>
#include <string.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "layout_internal.h"

/* The field of one of the arm's axes; null: no axis of this arm, or one that does not say where a slot is. A
 * null arm is that of motion/robot.h. */
static const char *field_of(const wh_carrier_t *arm, size_t own) {
    static const uint8_t usual[WH_ROBOT_AXES] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};
    static const char *const names[WH_CHAIN_AXES] = {
        [WH_CHAIN_RAIL] = "rail",     [WH_CHAIN_Z] = "z",         [WH_CHAIN_TILT_X] = "tilt_x",
        [WH_CHAIN_TILT_Y] = "tilt_y", [WH_CHAIN_THETA] = "theta", [WH_CHAIN_REACH] = "r",
        [WH_CHAIN_YAW] = "yaw"};
    const size_t axis = arm ? arm->axes[own] : usual[own];
    if (axis == WH_CARRIER_OTHERS || (arm && !wh_chain_has(&arm->chain, axis))) {
        return NULL;
    }
    return axis == WH_CHAIN_REACH && arm && arm->chain.kind == WH_CHAIN_SCARA ? "forearm" : names[axis];
}

static size_t axes_of(const wh_carrier_t *arm) {
    return arm ? arm->axis_count : WH_ROBOT_AXES;
}

/* Refuses fields of axes that the arm does not have. */
static void refuse_others(wh_reader_t *reader, const wh_carrier_t *arm) {
    for (const wh_reader_field_t *field = wh_layout_axes_fields; field->name; ++field) {
        bool has = false;
        for (size_t own = 0; own < axes_of(arm); ++own) {
            const char *name = field_of(arm, own);
            has = has || (name && strcmp(name, field->name) == 0);
        }
        if (!has) {
            wh_layout_refuse_field(reader, field->name, "nothing: the arm that goes there has no such axis");
        }
    }
}

/* An end of travel as the layout says it, to 1e-9 degrees. */
static wh_real_t rounded_deg(wh_real_t angle) {
    return (wh_real_t)(round((double)wh_deg_from_rad(angle) * 1e9) / 1e9);
}

/* Within its travel, ends included; angles in degrees. */
static wh_real_t read_axis(wh_reader_t *reader, const wh_machine_t *machine, size_t axis, const char *name) {
    const wh_travel_t *travel = wh_machine_travel(machine, axis);
    if (!wh_axis_turns(machine, axis)) {
        return wh_reader_number(reader, name, WH_REAL(NAN), travel->min, travel->max);
    }
    const wh_real_t at = wh_rad_from_deg(
        wh_reader_number(reader, name, WH_REAL(NAN), rounded_deg(travel->min), rounded_deg(travel->max)));
    return wh_real_max(travel->min, at < travel->max ? at : travel->max);
}

/* A slot as taught, and what of the axes the pose does not say. */
typedef struct {
    wh_pose_t base_from_slot;
    double rail;
    wh_elbow_t elbow;
} taught_t;

/* The robot's own axes, as far as `axes` gives them; others keep their value, a blade lies face up. */
static void read_own(wh_reader_t *reader, const wh_machine_t *machine, const wh_carrier_t *arm, size_t first,
                     wh_real_t axes[]) {
    for (size_t own = 0; own < axes_of(arm); ++own) {
        const char *name = field_of(arm, own);
        if (name) {
            axes[first + own] = read_axis(reader, machine, first + own, name);
        } else if (arm && arm->axes[own] == WH_CHAIN_FLIP) {
            axes[first + own] = 0;
        }
    }
}

/* Where the rail stands, or 0. */
static double rail_of(const wh_carrier_t *arm, const wh_real_t own_axes[]) {
    for (size_t own = 0; arm && own < axes_of(arm); ++own) {
        if (arm->axes[own] == WH_CHAIN_RAIL) {
            return own_axes[own];
        }
    }
    return 0;
}

/* The elbow to which the forearm is bent; a stretched one is the usual. */
static wh_elbow_t elbow_of(const wh_carrier_t *arm, wh_real_t bent, wh_elbow_t usual) {
    if (!arm || arm->chain.kind != WH_CHAIN_SCARA || !(wh_real_abs(bent) > 0)) {
        return usual;
    }
    return bent < 0 ? WH_ELBOW_LEFT : WH_ELBOW_RIGHT;
}

/* Reads `axes` of the table at which the reader is. The other axes of the robot stand at home. */
static taught_t read_axes(wh_reader_t *reader, const wh_layout_t *layout, int32_t gripper, wh_elbow_t usual) {
    const wh_machine_t *machine = &layout->machine;
    size_t first = 0;
    const wh_carrier_t *arm = machine->carrier ? wh_machine_arm(machine, (size_t)gripper, &first) : NULL;
    wh_real_t axes[WH_AXES];
    wh_pose_t poses[WH_GRIPPERS];
    wh_machine_home(machine, axes);
    (void)wh_reader_open(reader, "axes", wh_layout_axes_fields);
    refuse_others(reader, arm);
    read_own(reader, machine, arm, first, axes);
    wh_machine_grippers(machine, axes, poses);
    const taught_t taught = {poses[gripper], rail_of(arm, axes + first),
                             elbow_of(arm, axes[first + WH_AXIS_R], usual)};
    if (taught.base_from_slot.R.m[2][2] < WH_REAL(0.7)) {
        wh_reader_fail(reader, NULL, "axes at which the gripper is tilted by less than 45 degrees");
    }
    wh_reader_leave(reader);
    return taught;
}

/* ---------------------------------------------------------------------------------------- before grippers */

static bool has_by(wh_reader_t *reader, const wh_layout_t *layout) {
    bool has = false;
    if (wh_reader_enter(reader, "by")) {
        for (size_t r = 0; r < layout->robot_count; ++r) {
            if (wh_reader_enter(reader, layout->robots[r].name)) {
                has = has || wh_reader_has(reader, "axes");
                wh_reader_leave(reader);
            }
        }
        wh_reader_leave(reader);
    }
    return has;
}

void wh_layout_check_taught(wh_reader_t *reader) {
    static const char *const others[] = {"at", "rpy", "rail", "elbow"};
    for (size_t i = 0; wh_reader_has(reader, "axes") && i < sizeof others / sizeof others[0]; ++i) {
        wh_layout_refuse_field(reader, others[i], "nothing: `axes` says where slot 1 is");
    }
}

bool wh_layout_is_taught(wh_reader_t *reader, const wh_layout_t *layout) {
    if (!wh_layout_is_shared(layout)) {
        wh_layout_check_taught(reader);
        return wh_reader_has(reader, "axes");
    }
    wh_layout_refuse_field(reader, "axes", "nothing: with several robots `by` says it of each");
    if (wh_reader_has(reader, "at") || !has_by(reader, layout)) {
        return false;
    }
    wh_layout_refuse_field(reader, "rpy", "nothing: `axes` in `by` says where slot 1 is");
    return true;
}

/* ----------------------------------------------------------------------------------------- after grippers */

/* The gripper of the robot that goes to the station at which the reader is. */
static int32_t find_gripper(wh_reader_t *reader, const wh_layout_t *layout, size_t robot) {
    if (wh_reader_has(reader, "effector")) {
        const int32_t named =
            wh_layout_read_gripper_name(reader, layout, "effector", "the name of a gripper on a robot");
        if (layout->grippers[named].station == WH_NONE && layout->machine.mounts[named].robot == robot) {
            return named;
        }
    }
    return wh_layout_first_gripper(layout, robot);
}

/* Whoever comes to a station turns about its z alone, because the slots lie along it. */
static void check_up(wh_reader_t *reader, const wh_mat3_t *R, const wh_pose_t *place) {
    const wh_vec3_t up = wh_mat3_column(R, 2);
    const wh_vec3_t own = wh_mat3_column(&place->R, 2);
    const wh_vec3_t between = wh_vec3_subtract(&up, &own);
    if (wh_vec3_norm(&between) > WH_REAL(1e-9)) {
        wh_reader_fail(reader, NULL, "a way in whose z is the station's own: turned about that alone");
    }
}

/* A robot's own axes: they give the station its place if nothing else has, else where this robot was taught
 * it. */
static void take_own(wh_reader_t *reader, wh_layout_t *layout, size_t s, size_t r, int32_t gripper,
                     bool *is_placed) {
    wh_layout_approach_t *by = &layout->stations[s].by[r];
    wh_pose_t *place = &layout->places[s].base_from_station;
    const taught_t taught = read_axes(reader, layout, gripper, by->elbow);
    by->rail = taught.rail;
    by->elbow = taught.elbow;
    if (!*is_placed) {
        *place = taught.base_from_slot;
        *is_placed = true;
        return;
    }
    by->is_turned = true;
    by->R = taught.base_from_slot.R;
    by->aside = wh_vec3_subtract(&taught.base_from_slot.r, &place->r);
    const wh_vec3_t *aside = &by->aside;
    if (!(wh_real_abs(aside->x) <= WH_LAYOUT_ASIDE && wh_real_abs(aside->y) <= WH_LAYOUT_ASIDE &&
          wh_real_abs(aside->z) <= WH_LAYOUT_ASIDE)) {
        (void)wh_reader_push(reader, "axes");
        wh_reader_fail(reader, "axes",
                       "axes that bring %s up to %d mm beside the station; it stands %.6g, %.6g, %.6g mm "
                       "beside it",
                       layout->grippers[gripper].name, WH_LAYOUT_ASIDE, (double)aside->x, (double)aside->y,
                       (double)aside->z);
    }
}

static void place_by(wh_reader_t *reader, wh_layout_t *layout, size_t s) {
    wh_layout_station_t *station = &layout->stations[s];
    bool is_placed = !station->by_axes;
    station->by_axes = false;
    int32_t grippers[WH_LAYOUT_ROBOTS];
    for (size_t r = 0; r < layout->robot_count; ++r) {
        grippers[r] = find_gripper(reader, layout, r);
    }
    (void)wh_reader_enter(reader, "by");
    for (size_t r = 0; r < layout->robot_count; ++r) {
        if (wh_reader_enter(reader, layout->robots[r].name)) {
            if (wh_reader_has(reader, "axes")) {
                take_own(reader, layout, s, r, grippers[r], &is_placed);
                station->by_axes = true;
            }
            wh_reader_leave(reader);
        }
    }
    for (size_t r = 0; station->by_axes && r < layout->robot_count; ++r) {
        if (station->by[r].is_turned) {
            check_up(reader, &station->by[r].R, &layout->places[s].base_from_station);
        }
    }
    wh_reader_leave(reader);
}

static void place_alone(wh_reader_t *reader, wh_layout_t *layout, size_t s) {
    wh_layout_station_t *station = &layout->stations[s];
    const int32_t gripper = find_gripper(reader, layout, 0);
    const taught_t taught = read_axes(reader, layout, gripper, station->elbow);
    layout->places[s].base_from_station = taught.base_from_slot;
    station->rail = taught.rail;
    station->elbow = taught.elbow;
}

void wh_layout_read_taught(wh_reader_t *reader, wh_layout_t *layout) {
    (void)wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        (void)wh_reader_enter(reader, layout->stations[s].name);
        if (wh_layout_is_shared(layout) && wh_reader_has(reader, "by")) {
            place_by(reader, layout, s);
        } else if (layout->stations[s].by_axes) {
            place_alone(reader, layout, s);
        }
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

void wh_layout_move_chucks(wh_layout_t *layout) {
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const int32_t station = layout->grippers[g].station;
        if (station != WH_NONE) {
            layout->machine.mounts[g].base_from_station = layout->places[station].base_from_station;
        }
    }
}
