#include "arms.h"

#include <stdio.h>
#include <string.h>

static void add_arm(wh_layout_t *layout, size_t robot, wh_arm_body_t own) {
    layout->arms[layout->arm_count++] = (wh_world_arm_t){(int32_t)robot, own};
}

/* The arm of a gripper that is on a robot. */
static uint8_t carrier_of(const wh_layout_t *layout, const wh_mount_t *mount) {
    size_t arm = 0;
    while (layout->arms[arm].robot != mount->robot) {
        ++arm;
    }
    return (uint8_t)(arm + mount->arm);
}

void wh_layout_find_arms(wh_layout_t *layout) {
    const wh_machine_t *machine = &layout->machine;
    layout->arm_count = 0;
    for (size_t robot = 0; robot < wh_machine_robots(machine); ++robot) {
        const wh_carrier_t *carrier = wh_machine_carrier(machine, robot, NULL);
        add_arm(layout, robot, WH_ARM_BASE);
        if (carrier && carrier->second) {
            add_arm(layout, robot, carrier->chain.kind == WH_CHAIN_SCARA ? WH_ARM_HAND : WH_ARM_UPPER);
        }
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        layout->carried_by[g] = mount->axis == WH_NONE ? carrier_of(layout, mount) : WH_WORLD_NO_ARM;
    }
    layout->world.arm_count = layout->arm_count > 1 ? layout->arm_count : 0;
    layout->world.arms = layout->arms;
    layout->world.carried_by = layout->carried_by;
}

size_t wh_layout_arms(const wh_layout_t *layout) {
    return layout->world.arm_count > 0 ? layout->world.arm_count : 1;
}

const wh_carrier_t *wh_layout_arm(const wh_layout_t *layout, size_t arm, size_t *first) {
    const bool is_in_list = arm > 0 && arm < WH_WORLD_ARMS;
    const size_t robot = is_in_list ? (size_t)layout->arms[arm].robot : 0;
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, first);
    return is_in_list && layout->arms[arm].own != WH_ARM_BASE ? carrier->second : carrier;
}

const wh_arm_t *wh_layout_arm_lengths(const wh_layout_t *layout, size_t robot) {
    return robot == 0 ? &layout->shapes.arm : &layout->robots[robot].arm;
}

wh_real_t wh_layout_lowest(const wh_layout_t *layout, size_t robot) {
    return robot == 0 ? layout->shapes.lowest : layout->robots[robot].lowest;
}

bool wh_layout_has_body(const wh_layout_t *layout, size_t number) {
    const size_t arm = number / WH_ARM_BODIES;
    return arm == 0 || number % WH_ARM_BODIES >= (size_t)layout->arms[arm].own;
}

void wh_layout_name_body(const wh_layout_t *layout, size_t number, const char *foot, char *name,
                         size_t size) {
    static const char *const bodies[WH_ARM_BODIES] = {NULL, "lift", "upper arm", "forearm", "hand"};
    const size_t arm = number / WH_ARM_BODIES;
    const char *body = bodies[number % WH_ARM_BODIES];
    const bool is_second = arm > 0 && layout->arms[arm].own != WH_ARM_BASE;
    const char *robot = layout->robot_count > 1 ? layout->robots[layout->arms[arm].robot].name : "";
    (void)snprintf(name, size, "%s%s%s%s", robot, robot[0] != '\0' ? " " : "", body ? body : foot,
                   is_second ? " 2" : "");
}
