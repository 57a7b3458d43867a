#include "faster.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "times.h"

/* One of the mechanisms and stations: the first of these that is not WH_NONE; none: the chucks. */
typedef struct {
    int32_t robot, gripper, door, station;
    int32_t timed; /* a robot that is times alone beside robots with axes */
} paced_t;

static const paced_t nothing = {WH_NONE, WH_NONE, WH_NONE, WH_NONE, WH_NONE};

static bool has_chuck(const wh_machine_t *machine) {
    bool has = false;
    for (size_t axis = wh_machine_robot_axes(machine); axis < machine->axis_count; ++axis) {
        has = has || wh_machine_limits(machine, axis) == &machine->chuck_limits;
    }
    return has;
}

/* Stages, pins and flippers have limits of their own. */
static bool has_own(const wh_machine_t *machine, size_t gripper) {
    const wh_mount_t *mount = &machine->mounts[gripper];
    return mount->axis != WH_NONE && mount->kind != WH_MOUNT_CHUCK;
}

/* Numbers one more, and keeps it if it is the wanted one. */
static void count(size_t *number, size_t wanted, const paced_t *one, paced_t *found) {
    if ((*number)++ == wanted) {
        *found = *one;
    }
}

static size_t find_in_tool(const wh_flow_tool_t *tool, size_t wanted, paced_t *found) {
    size_t number = 0;
    paced_t one = nothing;
    for (one.robot = 0; one.robot < (int32_t)tool->robot_count; ++one.robot) {
        count(&number, wanted, &one, found);
    }
    one = nothing;
    for (one.station = 0; one.station < (int32_t)tool->station_count; ++one.station) {
        count(&number, wanted, &one, found);
    }
    return number;
}

static size_t find_mechanism(const wh_layout_t *layout, size_t wanted, paced_t *found) {
    const wh_machine_t *machine = &layout->machine;
    size_t number = 0;
    paced_t one = nothing;
    for (one.robot = 0; one.robot < (int32_t)layout->robot_count; ++one.robot) {
        count(&number, wanted, &one, found);
    }
    if (has_chuck(machine)) {
        count(&number, wanted, &nothing, found);
    }
    one = nothing;
    for (one.gripper = 0; one.gripper < (int32_t)machine->gripper_count; ++one.gripper) {
        if (has_own(machine, (size_t)one.gripper)) {
            count(&number, wanted, &one, found);
        }
    }
    one = nothing;
    for (one.door = 0; one.door < (int32_t)machine->door_count; ++one.door) {
        count(&number, wanted, &one, found);
    }
    return number;
}

/* Number `wanted` in `found`; returns how many there are. */
static size_t find(const wh_layout_t *layout, size_t wanted, paced_t *found) {
    if (layout->tool) {
        return find_in_tool(layout->tool, wanted, found);
    }
    size_t number = find_mechanism(layout, wanted, found);
    paced_t one = nothing;
    for (one.station = 0; one.station < (int32_t)layout->station_count; ++one.station) {
        if (layout->stations[one.station].times) {
            count(&number, wanted, &one, found);
        }
    }
    one = nothing;
    for (one.timed = 0; layout->timed && one.timed < (int32_t)layout->timed->robot_count; ++one.timed) {
        count(&number, wanted, &one, found);
    }
    return number;
}

size_t wh_layout_paced(const wh_layout_t *layout) {
    paced_t found;
    return find(layout, SIZE_MAX, &found);
}

size_t wh_layout_paced_station(const wh_layout_t *layout, size_t station) {
    const size_t count = wh_layout_paced(layout);
    for (size_t i = 0; i < count; ++i) {
        paced_t of = nothing;
        (void)find(layout, i, &of);
        const bool is_station = of.robot == WH_NONE && of.gripper == WH_NONE && of.door == WH_NONE;
        if (is_station && of.station == (int32_t)station) {
            return i;
        }
    }
    return SIZE_MAX;
}

void wh_layout_name_paced(const wh_layout_t *layout, size_t i, char name[WH_LAYOUT_PACED_BYTES]) {
    const wh_flow_tool_t *tool = layout->tool;
    paced_t of = nothing;
    (void)find(layout, i, &of);
    const char *text =
        of.robot != WH_NONE     ? (tool ? tool->robots[of.robot].name : layout->robots[of.robot].name)
        : of.gripper != WH_NONE ? layout->grippers[of.gripper].name
        : of.door != WH_NONE    ? layout->door_list[of.door].name
        : of.timed != WH_NONE   ? layout->timed->robots[of.timed].name
        : of.station != WH_NONE ? (tool ? tool->stations[of.station].name : layout->stations[of.station].name)
                                : "chucks";
    (void)snprintf(name, WH_LAYOUT_PACED_BYTES, "%s", text);
}

/* ------------------------------------------------------------------------------------------------- faster */

/* A way in so much of its time: speed, acceleration and jerk go with its first, second and third power. */
static void hasten(wh_limits_t *limits, double share) {
    const double faster = 1 / (1 - share);
    limits->speed *= (wh_real_t)faster;
    limits->acceleration *= (wh_real_t)(faster * faster);
    limits->jerk *= (wh_real_t)(faster * faster * faster);
}

/* The layout hands its parts on by const pointer; here it is still being made. */
static void hasten_axis(const wh_machine_t *machine, size_t axis, double share) {
    const wh_limits_t *limits = wh_machine_limits(machine, axis);
    wh_limits_t *own = NULL;
    memcpy(&own, &limits, sizeof(void *));
    hasten(own, share);
}

static void hasten_robot(wh_layout_t *layout, int32_t robot, double share) {
    wh_machine_t *machine = &layout->machine;
    const size_t axes = wh_machine_robot_axes(machine);
    for (size_t axis = 0; axis < axes; ++axis) {
        size_t own = 0;
        if (wh_machine_robot_of(machine, axis, &own) == robot) {
            hasten_axis(machine, axis, share);
        }
    }
    hasten(&layout->robots[robot].loaded, share);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        if (machine->mounts[g].axis == WH_NONE && machine->mounts[g].robot == robot) {
            hasten(&layout->grippers[g].loaded, share);
        }
    }
}

static void hasten_station(const wh_layout_t *layout, int32_t station, double share) {
    wh_layout_times_t *times = NULL;
    const int32_t ppm = (int32_t)lround(1e6 * share);
    memcpy(&times, &layout->stations[station].times, sizeof(void *));
    times->of.less_ppm = ppm;
    times->of.process_us = wh_flow_less_us(times->of.process_us, ppm);
    wh_flow_hasten_recipes(&times->of, ppm);
    times->of.clean_us = wh_flow_less_us(times->of.clean_us, ppm);
    for (size_t side = 0; side < 2; ++side) {
        times->of.pump_us[side] = wh_flow_less_us(times->of.pump_us[side], ppm);
        times->of.empty_pump_us[side] = wh_flow_less_us(times->of.empty_pump_us[side], ppm);
    }
}

static void hasten_in_tool(const wh_layout_t *layout, const paced_t *of, double share) {
    wh_flow_tool_t *tool = NULL;
    memcpy(&tool, &layout->tool, sizeof(void *));
    wh_flow_shorten(tool, of->robot, of->station, (int32_t)lround(1e6 * share));
}

void wh_layout_hasten(wh_layout_t *layout, size_t i, double share) {
    paced_t of = nothing;
    (void)find(layout, i, &of);
    if (layout->tool) {
        hasten_in_tool(layout, &of, share);
    } else if (of.robot != WH_NONE) {
        hasten_robot(layout, of.robot, share);
    } else if (of.gripper != WH_NONE) {
        hasten(&layout->machine.mounts[of.gripper].limits, share);
    } else if (of.door != WH_NONE) {
        hasten_axis(&layout->machine, wh_machine_door_axis(&layout->machine, (size_t)of.door), share);
    } else if (of.timed != WH_NONE) {
        wh_flow_shorten(layout->timed, of.timed, WH_FLOW_NONE, (int32_t)lround(1e6 * share));
    } else if (of.station != WH_NONE) {
        hasten_station(layout, of.station, share);
    } else {
        hasten(&layout->machine.chuck_limits, share);
    }
}
