/* The most that axes do to grippers in a slice, and which ones a segment moves. */
#include <string.h>

#include "quiet.h"

/* Rounding makes a way longer by less, as a share of it. */
#define SURE WH_REAL(1.001)

/* ------------------------------------------------------------------------------------------------- robots */

static bool is_length(const wh_chain_t *chain, size_t axis) {
    return axis == WH_CHAIN_RAIL || axis == WH_CHAIN_Z ||
           (axis == WH_CHAIN_REACH && chain->kind != WH_CHAIN_SCARA);
}

/* How far a point moves by a unit of an axis at most; it is `aside` of the effector's origin. */
static wh_real_t lever_of(const wh_chain_t *chain, size_t axis, wh_real_t aside) {
    const bool is_scara = chain->kind == WH_CHAIN_SCARA;
    if (is_length(chain, axis)) {
        return 1;
    }
    if (axis == WH_CHAIN_YAW || axis == WH_CHAIN_FLIP) {
        return aside;
    }
    if (axis == WH_CHAIN_REACH) {
        return chain->links[1] + aside;
    }
    const wh_real_t reach =
        is_scara ? chain->links[0] + chain->links[1] : chain->travel[WH_CHAIN_REACH].max + WH_SLACK_MM;
    return reach + wh_real_abs(chain->height) + aside;
}

static bool lifts(size_t axis) {
    return axis == WH_CHAIN_Z || axis == WH_CHAIN_TILT_X || axis == WH_CHAIN_TILT_Y || axis == WH_CHAIN_FLIP;
}

/* The robot of motion/robot.h as a chain, as far as it matters here. */
static wh_chain_t usual_chain(const wh_robot_t *robot) {
    static const size_t axes[WH_ROBOT_AXES] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};
    wh_chain_t chain;
    memset(&chain, 0, sizeof chain);
    chain.kind = WH_CHAIN_TRZY;
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        chain.travel[axes[i]] = robot->travel[i];
        chain.limits[axes[i]] = robot->limits[i];
    }
    return chain;
}

/* The axis of the chain that this one of a robot is; WH_CARRIER_OTHERS: one of the other arm. */
static size_t chain_axis(const wh_carrier_t *carrier, size_t own) {
    static const size_t usual[WH_ROBOT_AXES] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};
    return carrier ? carrier->axes[own] : usual[own];
}

static void bound_on_robot(wh_quiet_t *quiet, size_t g, wh_real_t slice_s) {
    const wh_machine_t *machine = quiet->machine;
    const wh_mount_t *mount = &machine->mounts[g];
    size_t first = 0;
    const wh_carrier_t *arm = machine->carrier ? wh_machine_arm(machine, g, &first) : NULL;
    const wh_chain_t chain = arm ? arm->chain : usual_chain(&machine->robot);
    const wh_vec3_t *shift = &mount->effector_from_gripper.r;
    const wh_real_t aside =
        (mount->is_shifted ? wh_vec3_norm(shift) : 0) + 2 * wh_real_abs(chain.flip_height);
    for (size_t own = 0; own < (arm ? arm->axis_count : WH_ROBOT_AXES); ++own) {
        const size_t axis = chain_axis(arm, own);
        if (axis == WH_CARRIER_OTHERS || !wh_chain_has(&chain, axis)) {
            continue;
        }
        const wh_real_t most = chain.limits[axis].speed * slice_s * SURE;
        quiet->by_axis[g][first + own] =
            (wh_quiet_axis_t){most * lever_of(&chain, axis, aside), is_length(&chain, axis) ? 0 : most};
        quiet->movers[g] |= UINT32_C(1) << (first + own);
        quiet->lifters[g] |= lifts(axis) ? UINT32_C(1) << (first + own) : 0;
    }
}

/* ------------------------------------------------------------------------------------ chucks and the rest */

static void bound_beside(wh_quiet_t *quiet, size_t g, wh_real_t slice_s) {
    const wh_mount_t *mount = &quiet->machine->mounts[g];
    const bool lifts_it = mount->kind == WH_MOUNT_PINS || mount->kind == WH_MOUNT_FLIPPER;
    quiet->movers[g] = wh_mount_moved_by(mount);
    quiet->lifters[g] = lifts_it ? quiet->movers[g] : 0;
    for (size_t i = 0; i < wh_mount_axes(mount); ++i) {
        const size_t axis = (size_t)mount->axis + i;
        const wh_real_t most = wh_machine_limits(quiet->machine, axis)->speed * slice_s * SURE;
        const bool turns = i == 0 && mount->kind != WH_MOUNT_PINS;
        const wh_real_t lever = mount->kind == WH_MOUNT_FLIPPER ? wh_real_abs(mount->height) : 0;
        quiet->by_axis[g][axis] = (wh_quiet_axis_t){most * (turns ? lever : 1), turns ? most : 0};
    }
}

void wh_quiet_begin(wh_quiet_t *quiet, const wh_machine_t *machine, wh_real_t slice_s) {
    memset(quiet, 0, sizeof *quiet);
    quiet->machine = machine;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        if (machine->mounts[g].axis == WH_NONE) {
            bound_on_robot(quiet, g, slice_s);
        } else {
            bound_beside(quiet, g, slice_s);
        }
    }
    for (size_t d = 0; d < machine->door_count; ++d) {
        quiet->doors |= UINT32_C(1) << wh_machine_door_axis(machine, d);
    }
}

/* ----------------------------------------------------------------------------------------------- segments */

static uint32_t axes_between(const wh_real_t from[], const wh_real_t to[], size_t count) {
    uint32_t axes = 0;
    for (size_t axis = 0; axis < count; ++axis) {
        axes |= from[axis] < to[axis] || from[axis] > to[axis] ? UINT32_C(1) << axis : 0;
    }
    return axes;
}

/* `own` is the axis of the robot, `axis` that of its chain. */
typedef bool is_one_t(const wh_track_t *track, size_t own, size_t axis);

/* Those axes of the robot that goes a line, a way or by points. */
static uint32_t axes_of_robot(const wh_track_t *track, is_one_t *is_one) {
    const wh_machine_t *machine = track->machine;
    const int32_t g = track->segment.gripper;
    const bool is_said = g != WH_NONE && machine->mounts[g].axis == WH_NONE;
    size_t first = 0;
    const wh_carrier_t *carrier = wh_machine_carrier(machine, is_said ? machine->mounts[g].robot : 0, &first);
    uint32_t axes = 0;
    for (size_t own = 0; own < (carrier ? carrier->axis_count : WH_ROBOT_AXES); ++own) {
        axes |= is_one(track, own, chain_axis(carrier, own)) ? UINT32_C(1) << (first + own) : 0;
    }
    return axes;
}

static bool is_in_line(const wh_track_t *track, size_t own, size_t axis) {
    (void)own;
    const bool goes_up = track->segment.travel.z < 0 || track->segment.travel.z > 0;
    return axis == WH_CHAIN_THETA || axis == WH_CHAIN_REACH || axis == WH_CHAIN_YAW ||
           axis == WH_CARRIER_OTHERS || (axis == WH_CHAIN_Z && goes_up);
}

/* An arm comes in and goes out again even if it ends where it began. */
static bool is_in_way(const wh_track_t *track, size_t own, size_t axis) {
    const wh_way_t *way = &track->plan.way;
    return axis == WH_CHAIN_REACH || axis == WH_CARRIER_OTHERS || way->from[own] < way->to[own] ||
           way->from[own] > way->to[own];
}

static bool is_any(const wh_track_t *track, size_t own, size_t axis) {
    (void)track;
    (void)own;
    (void)axis;
    return true;
}

static bool is_beside_z(const wh_track_t *track, size_t own, size_t axis) {
    return axis != WH_CHAIN_Z && is_in_line(track, own, axis);
}

uint32_t wh_quiet_still(const wh_track_t *track) {
    const wh_vec3_t *travel = &track->segment.travel;
    const bool goes_aside = travel->x < 0 || travel->x > 0 || travel->y < 0 || travel->y > 0;
    return track->segment.kind == WH_SEGMENT_LINE && !goes_aside ? axes_of_robot(track, is_beside_z) : 0;
}

uint32_t wh_quiet_axes(const wh_track_t *track) {
    switch (track->segment.kind) {
    case WH_SEGMENT_AXES:
        return axes_between(track->plan.move.from, track->plan.move.to, track->plan.move.count);
    case WH_SEGMENT_LINE:
        return axes_of_robot(track, is_in_line);
    case WH_SEGMENT_WAY:
        return axes_of_robot(track, is_in_way);
    case WH_SEGMENT_VIA:
        return axes_of_robot(track, is_any);
    case WH_SEGMENT_VALVES:
    case WH_SEGMENT_DWELL:
    case WH_SEGMENT_SENSOR:
        break;
    }
    return 0;
}
