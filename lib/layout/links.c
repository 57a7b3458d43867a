#include "links.h"

#include <stdio.h>
#include <string.h>

#include "arms.h"

/* How far a point 1 mm from the end-effector's origin may be off, in mm for each mm of slack. */
#define SLACK_PER_MM WH_REAL(0.01)

/* The first gripper on the arm, which tells where its end-effector is; WH_NONE: there is none on it. */
static int32_t find_gripper(const wh_layout_t *layout, size_t arm) {
    const wh_machine_t *machine = &layout->machine;
    const bool is_in_list = arm > 0 && arm < WH_WORLD_ARMS;
    const int32_t robot = is_in_list ? layout->arms[arm].robot : 0;
    const bool is_second = is_in_list && layout->arms[arm].own != WH_ARM_BASE;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if (mount->axis == WH_NONE && mount->robot == robot && (mount->arm > 0) == is_second) {
            return (int32_t)g;
        }
    }
    return WH_NONE;
}

/* The end-effector of that gripper; of a shifted one it is written to `room`. */
static const wh_pose_t *effector_of(const wh_mount_t *mount, const wh_pose_t *base_from_gripper,
                                    wh_pose_t *room) {
    if (!mount->is_shifted) {
        return base_from_gripper;
    }
    const wh_pose_t identity = wh_pose_identity();
    const wh_pose_t gripper_from_effector = wh_pose_relative(&mount->effector_from_gripper, &identity);
    *room = wh_pose_compose(base_from_gripper, &gripper_from_effector);
    return room;
}

/* `known` is where the carrier has the end-effector at the arm's axes; null: not known. */
static void place(wh_links_t *links, const wh_layout_t *layout, size_t arm, const wh_pose_t *known) {
    const wh_carrier_t *carrier = wh_layout_arm(layout, arm, NULL);
    const wh_arm_t *lengths = wh_layout_arm_lengths(layout, arm == 0 ? 0 : (size_t)layout->arms[arm].robot);
    wh_pose_t *bodies = &links->bodies[arm * WH_ARM_BODIES];
    if (carrier) {
        wh_arm_place_carrier(lengths, carrier, links->arms[arm].axes, known, bodies);
    } else {
        wh_arm_place(lengths, &links->arms[arm].base_from_effector, bodies);
    }
}

void wh_links_at(wh_links_t *links, const wh_layout_t *layout, const wh_real_t axes[]) {
    memset(links, 0, sizeof *links);
    for (size_t arm = 0; arm < wh_layout_arms(layout); ++arm) {
        size_t first;
        const wh_carrier_t *carrier = wh_layout_arm(layout, arm, &first);
        wh_links_arm_t *at = &links->arms[arm];
        if (carrier) {
            memcpy(at->axes, &axes[first], carrier->axis_count * sizeof axes[0]);
            carrier->forward(carrier, at->axes, &at->base_from_effector);
        } else {
            wh_machine_effector(&layout->machine, 0, axes, &at->base_from_effector);
        }
        place(links, layout, arm, carrier ? &at->base_from_effector : NULL);
    }
}

void wh_links_home(wh_links_t *links, const wh_layout_t *layout) {
    wh_real_t home[WH_AXES];
    wh_machine_home(&layout->machine, home);
    wh_links_at(links, layout, home);
}

/* True if the arm's robot has the same axes in both. */
static bool keeps(const wh_carrier_t *carrier, size_t first, const wh_real_t from[], const wh_real_t to[]) {
    const size_t count = carrier ? carrier->axis_count : WH_ROBOT_AXES;
    return memcmp(&from[first], &to[first], count * sizeof to[0]) == 0;
}

bool wh_links_reach(const wh_layout_t *layout, const wh_real_t from[], const wh_real_t to[],
                    char reason[WH_LINKS_BYTES]) {
    wh_links_t links;
    wh_links_at(&links, layout, to);
    for (size_t arm = 0; arm < wh_layout_arms(layout); ++arm) {
        size_t first = 0;
        const wh_carrier_t *carrier = wh_layout_arm(layout, arm, &first);
        const wh_pose_t *bodies = &links.bodies[arm * WH_ARM_BODIES];
        const size_t robot = arm == 0 ? 0 : (size_t)layout->arms[arm].robot;
        const wh_real_t link = wh_layout_arm_lengths(layout, robot)->link;
        const wh_vec3_t out = wh_vec3_subtract(&bodies[WH_ARM_HAND].r, &bodies[WH_ARM_UPPER].r);
        if ((!carrier || carrier->chain.kind != WH_CHAIN_SCARA) && !keeps(carrier, first, from, to) &&
            wh_vec3_norm(&out) > 2 * link + WH_LINKS_SAME) {
            (void)snprintf(reason, WH_LINKS_BYTES, "two links of %.4g mm do not reach the wrist",
                           (double)link);
            return false;
        }
    }
    return true;
}

static bool is_at(const wh_pose_t *a, const wh_pose_t *b, wh_real_t slack) {
    const wh_vec3_t way = wh_vec3_subtract(&a->r, &b->r);
    bool same = wh_vec3_norm(&way) <= slack;
    for (size_t i = 0; same && i < 9; ++i) {
        same = wh_real_abs(a->R.m[i / 3][i % 3] - b->R.m[i / 3][i % 3]) <= SLACK_PER_MM * slack;
    }
    return same;
}

/* Where the robot's axes have the end-effector: an unshifted gripper is there, too. */
static void find_there(const wh_carrier_t *carrier, const wh_real_t own[], const wh_pose_t *told,
                       wh_pose_t *there) {
    if (told) {
        *there = *told;
    } else {
        carrier->forward(carrier, own, there);
    }
}

/* Sets the arm's axes. `own` are its robot's; null: not known. True if the arm is at these, and its
 * end-effector `there`; `told` says where these bring it; null: not known. */
static bool find_axes(wh_links_arm_t *arm, const wh_carrier_t *carrier, const wh_real_t own[],
                      const wh_pose_t *told, wh_real_t slack, wh_pose_t *there) {
    const wh_pose_t *effector = &arm->base_from_effector;
    if (own) {
        find_there(carrier, own, told, there);
        if (is_at(there, effector, slack)) {
            memcpy(arm->axes, own, carrier->axis_count * sizeof own[0]);
            return true;
        }
    }
    const wh_chain_choice_t choice = wh_carrier_choice(carrier, arm->axes);
    (void)carrier->inverse(carrier, effector, &choice, arm->axes, arm->axes);
    return false;
}

/* True if the arm stands at these axes already, and its end-effector with it: nothing need be placed. The
 * usual robot has no carrier, and its links follow from the end-effector alone. */
static bool stands(const wh_links_arm_t *arm, const wh_pose_t *effector, const wh_real_t own[],
                   const wh_carrier_t *carrier) {
    return (!carrier || (own && memcmp(own, arm->axes, carrier->axis_count * sizeof own[0]) == 0)) &&
           wh_arm_is_at(effector, &arm->base_from_effector);
}

/* Places an arm's links, whose end-effector gripper `g` has told; WH_NONE: it has no gripper. */
static void move_arm(wh_links_t *links, const wh_layout_t *layout, size_t i, int32_t g, const wh_real_t own[],
                     const wh_gripper_input_t told[], wh_real_t slack) {
    const wh_carrier_t *carrier = wh_layout_arm(layout, i, NULL);
    const bool is_known = told && g != WH_NONE && !layout->machine.mounts[g].is_shifted;
    const wh_pose_t *known = is_known ? &told[g].base_from_gripper : NULL;
    wh_pose_t there;
    const bool is_there =
        g != WH_NONE && carrier && find_axes(&links->arms[i], carrier, own, known, slack, &there);
    place(links, layout, i, is_there ? &there : NULL);
}

/* True if this was told before, and all arms stood. */
static bool still_stand(const wh_links_told_t *told, const wh_machine_t *machine,
                        const wh_pose_t base_from_grippers[], const wh_real_t axes[]) {
    return told->is_known && axes && memcmp(told->axes, axes, machine->axis_count * sizeof axes[0]) == 0 &&
           memcmp(told->base_from_grippers, base_from_grippers,
                  machine->gripper_count * sizeof base_from_grippers[0]) == 0;
}

static void remember(wh_links_told_t *told, const wh_machine_t *machine, const wh_pose_t base_from_grippers[],
                     const wh_real_t axes[]) {
    memcpy(told->axes, axes, machine->axis_count * sizeof axes[0]);
    memcpy(told->base_from_grippers, base_from_grippers,
           machine->gripper_count * sizeof base_from_grippers[0]);
    told->is_known = true;
}

void wh_links_follow(wh_links_t *links, const wh_layout_t *layout, const wh_pose_t base_from_grippers[],
                     const wh_real_t axes[], const wh_gripper_input_t told[], wh_real_t slack) {
    const size_t count = wh_layout_arms(layout);
    bool all_stand = true;
    if (still_stand(&links->standing, &layout->machine, base_from_grippers, axes)) {
        return;
    }
    for (size_t i = 0; i < count; ++i) {
        wh_links_arm_t *arm = &links->arms[i];
        size_t first;
        const wh_carrier_t *carrier = wh_layout_arm(layout, i, &first);
        const wh_real_t *own = axes ? &axes[first] : NULL;
        wh_pose_t room;
        const int32_t g = find_gripper(layout, i);
        const wh_pose_t *effector =
            g == WH_NONE ? &arm->base_from_effector
                         : effector_of(&layout->machine.mounts[g], &base_from_grippers[g], &room);
        if (stands(arm, effector, own, carrier)) {
            continue;
        }
        all_stand = false;
        arm->base_from_effector = *effector;
        move_arm(links, layout, i, g, own, told, slack);
    }
    links->standing.is_known = false;
    if (all_stand && axes) {
        remember(&links->standing, &layout->machine, base_from_grippers, axes);
    }
}
