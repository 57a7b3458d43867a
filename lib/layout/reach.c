#include "reach.h"

#include <stdio.h>
#include <string.h>

#include "../math/trig.h"
#include "arms.h"
#include "links.h"

bool wh_layout_tilts(const wh_layout_t *layout, size_t station) {
    const wh_mount_t *mount = &layout->machine.mounts[layout->stations[station].effector];
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, mount->robot, NULL);
    return carrier && carrier->chain.has_tilt;
}

/* The links of the robot that serves a station. */
static const wh_arm_t *lengths_at(const wh_layout_t *layout, size_t station) {
    const int32_t effector = layout->stations[station].effector;
    return wh_layout_arm_lengths(layout, layout->machine.mounts[effector].robot);
}

/* The station's index. For a station that is not the layout's own it is 0: one robot then serves all
 * stations. */
static size_t index_of(const wh_layout_t *layout, const wh_station_t *station) {
    size_t s = 0;
    while (s < layout->station_count && station != &layout->places[s]) {
        ++s;
    }
    return s < layout->station_count ? s : 0;
}

/* With several robots the one that serves the station comes in its own way. */
static void turn_in(const wh_layout_t *layout, const wh_station_t *station, wh_pose_t *base_from_slot) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_layout_station_t *of = &layout->stations[s];
        const size_t robot = layout->machine.mounts[of->effector].robot;
        if (of->by && station == &layout->places[s] && of->by[robot].is_turned) {
            base_from_slot->R = of->by[robot].R;
        }
    }
}

wh_pose_t wh_layout_come_level(const wh_layout_t *layout, const wh_station_t *station, int32_t slot) {
    wh_pose_t base_from_slot = wh_station_slot(station, slot);
    turn_in(layout, station, &base_from_slot);
    const wh_real_t x = base_from_slot.R.m[0][0];
    const wh_real_t y = base_from_slot.R.m[1][0];
    const wh_real_t length = wh_real_sqrt(x * x + y * y);
    const wh_pose_t level = {{{{x / length, -y / length, 0}, {y / length, x / length, 0}, {0, 0, 1}}},
                             base_from_slot.r};
    return wh_layout_tilts(layout, index_of(layout, station)) ? base_from_slot : level;
}

/* True also where the robot's axes cannot go: the survey reports that. */
static bool carrier_reaches(const wh_layout_t *layout, size_t station, const wh_pose_t *base_from_gripper) {
    const wh_layout_station_t *s = &layout->stations[station];
    const wh_chain_choice_t choice = {.rail = s->rail, .elbow = s->elbow};
    wh_pose_t bodies[WH_ARM_BODIES];
    wh_real_t axes[WH_AXES];
    size_t first;
    wh_machine_home(&layout->machine, axes);
    const wh_carrier_t *arm = wh_machine_arm(&layout->machine, (size_t)s->effector, &first);
    if (arm->chain.kind == WH_CHAIN_SCARA ||
        wh_machine_bring(&layout->machine, (size_t)s->effector, base_from_gripper, &choice, axes, axes) !=
            WH_OK) {
        return true;
    }
    wh_arm_place_carrier(lengths_at(layout, station), arm, &axes[first], NULL, bodies);
    const wh_vec3_t out = wh_vec3_subtract(&bodies[WH_ARM_HAND].r, &bodies[WH_ARM_UPPER].r);
    return wh_vec3_norm(&out) <= 2 * lengths_at(layout, station)->link;
}

/* Checks that the links reach with the station's gripper at this distance before a slot. They are stretched
 * most at one end of a way. */
static bool links_reach(const wh_layout_t *layout, size_t station, int32_t slot, wh_real_t before) {
    const wh_mount_t *mount = &layout->machine.mounts[layout->stations[station].effector];
    const wh_pose_t identity = wh_pose_identity();
    const wh_pose_t gripper_from_effector = wh_pose_relative(&mount->effector_from_gripper, &identity);
    wh_pose_t base_from_gripper = wh_layout_come_level(layout, &layout->places[station], slot);
    const wh_vec3_t in = wh_mat3_column(&base_from_gripper.R, 0);
    const wh_vec3_t way = wh_vec3_scale(before, &in);
    base_from_gripper.r = wh_vec3_subtract(&base_from_gripper.r, &way);
    if (layout->machine.carrier) {
        return carrier_reaches(layout, station, &base_from_gripper);
    }
    const wh_pose_t base_from_effector = wh_pose_compose(&base_from_gripper, &gripper_from_effector);
    return wh_arm_reaches(&layout->shapes.arm, &base_from_effector);
}

bool wh_layout_reaches(const wh_layout_t *layout, size_t station, size_t place, wh_unreached_t *unreached) {
    const wh_layout_station_t *s = &layout->stations[station];
    const int32_t slots = layout->places[station].slots;
    const bool is_before = place % 2 == 1;
    const int32_t slot = place < 2 ? 1 : slots;
    const bool is_another = place < 2 || slots > 1;
    if (!s->taught || !is_another || links_reach(layout, station, slot, is_before ? s->retract : 0)) {
        return true;
    }
    unreached->slot = slot;
    unreached->is_before = is_before;
    snprintf(unreached->text, sizeof unreached->text, "two links of %.4g mm do not reach the wrist",
             (double)lengths_at(layout, station)->link);
    return false;
}
