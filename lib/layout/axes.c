#include "axes.h"

#include <stdio.h>

#include "../math/trig.h"

/* The chain that has this axis of a robot; null: the usual one. `own` becomes the axis of the chain. */
static const wh_chain_t *chain_of(const wh_machine_t *machine, size_t axis, size_t *own) {
    static const size_t usual[WH_ROBOT_AXES] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};
    size_t index = 0;
    const int32_t robot = wh_machine_robot_of(machine, axis, &index);
    const wh_carrier_t *carrier = robot == WH_NONE ? NULL : wh_machine_carrier(machine, (size_t)robot, NULL);
    *own = usual[index % WH_ROBOT_AXES];
    if (carrier) {
        (void)wh_carrier_axis(carrier, index, own);
    }
    return carrier ? &carrier->chain : NULL;
}

static bool is_scara(const wh_chain_t *chain) {
    return chain && chain->kind == WH_CHAIN_SCARA;
}

const char *wh_axis_name(const wh_machine_t *machine, size_t axis) {
    static const char *const names[WH_CHAIN_AXES] = {
        [WH_CHAIN_RAIL] = "rail",     [WH_CHAIN_Z] = "z",         [WH_CHAIN_TILT_X] = "tilt_x",
        [WH_CHAIN_TILT_Y] = "tilt_y", [WH_CHAIN_THETA] = "theta", [WH_CHAIN_REACH] = "r",
        [WH_CHAIN_YAW] = "yaw",       [WH_CHAIN_FLIP] = "flip"};
    size_t own, index = 0;
    const wh_chain_t *chain = chain_of(machine, axis, &own);
    const int32_t robot = wh_machine_robot_of(machine, axis, &index);
    const wh_carrier_t *carrier = robot == WH_NONE ? NULL : wh_machine_carrier(machine, (size_t)robot, NULL);
    if (carrier && carrier->axes[index] == WH_CARRIER_OTHERS) {
        return own == WH_CHAIN_REACH ? "r2" : "yaw2";
    }
    return own == WH_CHAIN_REACH && is_scara(chain) ? "forearm" : names[own];
}

bool wh_axis_turns(const wh_machine_t *machine, size_t axis) {
    size_t own;
    const wh_chain_t *chain = chain_of(machine, axis, &own);
    const bool shifts = own == WH_CHAIN_RAIL || own == WH_CHAIN_Z || own == WH_CHAIN_REACH;
    return !shifts || (own == WH_CHAIN_REACH && is_scara(chain));
}

bool wh_axis_exists(const wh_machine_t *machine, size_t axis) {
    size_t own;
    const wh_chain_t *chain = chain_of(machine, axis, &own);
    return !chain || wh_chain_has(chain, own);
}

/* From the shoulder, by the law of cosines. */
static wh_real_t reach_of(const wh_real_t links[2], wh_real_t elbow) {
    return wh_real_sqrt(links[0] * links[0] + links[1] * links[1] + 2 * links[0] * links[1] * wh_cos(elbow));
}

wh_travel_t wh_axis_reach(const wh_machine_t *machine, size_t robot) {
    size_t first, own;
    (void)wh_machine_carrier(machine, robot, &first);
    wh_travel_t reach = *wh_machine_travel(machine, first + WH_AXIS_R);
    const wh_chain_t *chain = chain_of(machine, first, &own);
    if (is_scara(chain)) {
        const wh_real_t *links = chain->links;
        const wh_real_t low = wh_real_abs(reach.min);
        const wh_real_t high = wh_real_abs(reach.max);
        const bool stretches = reach.min <= 0 && reach.max >= 0;
        const wh_real_t least = low < high ? low : high;
        reach.min = reach_of(links, wh_real_max(low, high));
        reach.max = reach_of(links, stretches ? 0 : least);
    }
    return reach;
}

bool wh_layout_is_scara(const wh_layout_t *layout, size_t robot) {
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, NULL);
    return carrier && is_scara(&carrier->chain);
}

static bool is_axis_of(const wh_mount_t *mount, size_t axis) {
    return (wh_mount_moved_by(mount) >> axis & 1U) != 0;
}

/* The door that the axis moves, or WH_NONE. */
static int32_t find_door(const wh_machine_t *machine, size_t axis) {
    const size_t first = wh_machine_door_axis(machine, 0);
    return axis >= first && axis < machine->axis_count ? (int32_t)(axis - first) : WH_NONE;
}

bool wh_layout_axis_turns(const wh_layout_t *layout, size_t axis) {
    const wh_machine_t *machine = &layout->machine;
    if (find_door(machine, axis) != WH_NONE) {
        return false;
    }
    if (layout->axes_untold) {
        return true;
    }
    if (axis < wh_machine_robot_axes(machine)) {
        return wh_axis_turns(machine, axis);
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        if (is_axis_of(&machine->mounts[g], axis)) {
            return machine->mounts[g].kind != WH_MOUNT_PINS && machine->mounts[g].axis == (int32_t)axis;
        }
    }
    return true;
}

/* True if the layout was not told what this axis moves. */
static bool is_untold(const wh_layout_t *layout, size_t axis) {
    return layout->axes_untold && find_door(&layout->machine, axis) == WH_NONE;
}

const char *wh_layout_axis_unit(const wh_layout_t *layout, size_t axis) {
    return is_untold(layout, axis) ? NULL : wh_layout_axis_turns(layout, axis) ? "rad" : "mm";
}

/* With several robots, whose axis it is. */
static const char *owner_of(const wh_layout_t *layout, size_t axis) {
    size_t own;
    const int32_t robot = wh_machine_robot_of(&layout->machine, axis, &own);
    return robot == WH_NONE || layout->robot_count < 2 ? NULL : layout->robots[robot].name;
}

static void name_robot_axis(const wh_layout_t *layout, size_t axis, char *name, size_t size) {
    static const char *const usual[WH_ROBOT_AXES] = {"theta", "R", "Z", "yaw"};
    const char *owner = owner_of(layout, axis);
    const bool is_usual =
        !owner && axis < WH_ROBOT_AXES && !(axis == WH_AXIS_R && wh_layout_is_scara(layout, 0));
    (void)snprintf(name, size, "%s%s%s", owner ? owner : "", owner ? " " : "",
                   is_usual ? usual[axis] : wh_axis_name(&layout->machine, axis));
}

void wh_layout_name_axis(const wh_layout_t *layout, size_t axis, char *name, size_t size) {
    if (is_untold(layout, axis)) {
        (void)snprintf(name, size, "axis %zu", axis + 1);
        return;
    }
    if (axis < wh_machine_robot_axes(&layout->machine)) {
        name_robot_axis(layout, axis, name, size);
        return;
    }
    const int32_t door = find_door(&layout->machine, axis);
    if (door != WH_NONE) {
        (void)snprintf(name, size, "%s door", layout->door_list[door].name);
        return;
    }
    (void)snprintf(name, size, "chuck");
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_mount_t *mount = &layout->machine.mounts[g];
        if (is_axis_of(mount, axis)) {
            static const char *const of_stage[] = {"chuck", "stage x", "stage y"};
            const size_t of_mount = axis - (size_t)mount->axis;
            (void)snprintf(name, size, "%s %s", layout->grippers[g].name,
                           mount->kind == WH_MOUNT_PINS      ? "pins"
                           : mount->kind == WH_MOUNT_FLIPPER ? "flipper"
                                                             : of_stage[of_mount]);
        }
    }
}

const char *wh_layout_axis_label(const wh_layout_t *layout, size_t axis, char *name, size_t size) {
    if (layout->robot_count < 2) {
        return wh_axis_name(&layout->machine, axis);
    }
    wh_layout_name_axis(layout, axis, name, size);
    return name;
}
