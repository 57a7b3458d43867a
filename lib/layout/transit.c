#include "transit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../math/trig.h"
#include "outline.h"

/* The search over all corners of everything on one arm. */
typedef struct {
    const wh_layout_t *layout;
    size_t robot, arm;
    wh_real_t low, high; /* yaw, rad */
    bool flips;          /* the flip turns on the way; else: */
    wh_pose_t flipped;   /* effector_from_hand, the hand being where the blade is face up */
    wh_real_t flip_height;
    wh_real_t reach;     /* the largest R so far that keeps all corners within the transit */
    wh_real_t outermost; /* of all corners, with R at its inner end */
} look_t;

/* The first axis of a robot. */
static size_t first_axis(const wh_layout_t *layout, size_t robot) {
    size_t first = 0;
    (void)wh_machine_carrier(&layout->machine, robot, &first);
    return first;
}

/* The robot's own axis that is this one of its chain; 0: it has none. */
static size_t own_axis(const wh_layout_t *layout, size_t robot, uint8_t axis) {
    size_t first = 0;
    size_t found = 0;
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, &first);
    for (size_t own = 0; carrier && own < carrier->axis_count; ++own) {
        found = carrier->axes[own] == axis ? own : found;
    }
    return found;
}

/* The R of a second arm, which is the robot's last axis; 0: it has one arm. */
static size_t second_arm(const wh_layout_t *layout, size_t robot) {
    size_t first = 0;
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, &first);
    return carrier && carrier->second ? carrier->axis_count - 1 : 0;
}

/* Where the travel of the robot's R begins, mm. */
static wh_real_t inner_end(const wh_layout_t *layout, size_t robot) {
    return wh_machine_travel(&layout->machine, first_axis(layout, robot) + WH_AXIS_R)->min;
}

/* The largest cosine of `angle` + yaw: 1 if yaw passes where the point leads straight out. */
static wh_real_t largest_cosine(const look_t *look, wh_real_t angle) {
    const wh_real_t turn = 2 * WH_PI;
    wh_real_t from = angle + look->low;
    wh_real_t to = angle + look->high;
    const wh_real_t whole = turn * round(from / turn);
    from -= whole;
    to -= whole;
    const bool leads_out = (from <= 0 && to >= 0) || to >= turn;
    return leads_out ? 1 : wh_real_max(wh_cos(from), wh_cos(to));
}

/* A corner of a thing on the end-effector, in its frame. */
static void look_at(look_t *look, wh_real_t x, wh_real_t y, wh_real_t grown) {
    const wh_real_t d = wh_real_sqrt(x * x + y * y) * grown;
    const wh_real_t c = largest_cosine(look, wh_atan2(y, x));
    const wh_real_t transit = look->layout->robots[look->robot].transit;
    const wh_real_t R = inner_end(look->layout, look->robot);
    const wh_real_t square = transit * transit - d * d * (1 - c * c);
    const wh_real_t most = square > 0 ? wh_real_sqrt(square) - d * c : -1;
    look->reach = most < look->reach ? most : look->reach;
    look->outermost = wh_real_max(look->outermost, wh_real_sqrt(R * R + d * d + 2 * R * d * c));
}

/* An outline's corners lie on a circle; by this factor the polygon encloses it: 1 / cos(pi / 48). */
#define ENCLOSING WH_REAL(1.0021463)

/* The largest distance from the flip's axis that a shape has above or below it. */
static wh_real_t height_beside_axis(const look_t *look, wh_outline_t *outline, const wh_convex_t *shape,
                                    const wh_pose_t *effector_from_shape) {
    wh_real_t most = 0;
    wh_outline_draw(outline, WH_VIEW_SIDE, shape, effector_from_shape);
    for (size_t i = 0; i < outline->count; ++i) {
        most = wh_real_max(most, wh_real_abs(-outline->spots[i].y - look->flip_height));
    }
    return most;
}

/* While the blade turns over, a point is aside by at most its distance from the flip's axis. */
static void look_at_shape(look_t *look, wh_outline_t *outline, const wh_mount_t *mount,
                          const wh_convex_t *shape) {
    const wh_real_t grown = shape->kind == WH_CONVEX_BOX || shape->kind == WH_CONVEX_MESH ? 1 : ENCLOSING;
    const wh_pose_t level = wh_pose_identity();
    const wh_pose_t *from = mount->is_shifted ? &mount->effector_from_gripper : &level;
    wh_pose_t effector_from_shape = wh_pose_compose(from, &shape->body_from_shape);
    if (own_axis(look->layout, look->robot, WH_CHAIN_FLIP) > 0 && !look->flips) {
        effector_from_shape = wh_pose_compose(&look->flipped, &effector_from_shape);
    }
    const wh_real_t height = look->flips ? height_beside_axis(look, outline, shape, &effector_from_shape) : 0;
    wh_outline_draw(outline, WH_VIEW_TOP, shape, &effector_from_shape);
    for (size_t i = 0; i < outline->count; ++i) {
        const wh_real_t x = outline->spots[i].x;
        const wh_real_t y = -outline->spots[i].y;
        if (look->flips) {
            const wh_real_t aside = wh_real_sqrt(y * y + height * height);
            look_at(look, x, aside, grown);
            look_at(look, x, -aside, grown);
        } else {
            look_at(look, x, y, grown);
        }
    }
}

static void look_at_gripper(look_t *look, wh_outline_t *outline, int32_t gripper) {
    const wh_layout_t *layout = look->layout;
    const wh_mount_t *mount = &layout->machine.mounts[gripper];
    look_at_shape(look, outline, mount, &layout->world.wafer);
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        const wh_part_t *part = &layout->world.parts[i];
        if (part->kind == WH_PART_BLADE && part->owner == gripper) {
            look_at_shape(look, outline, mount, &part->convex);
        }
    }
}

/* How the blade is turned over on the way. */
static void take_flip(look_t *look, const wh_real_t from[], const wh_real_t to[]) {
    const size_t flip = own_axis(look->layout, look->robot, WH_CHAIN_FLIP);
    if (flip > 0) {
        look->flip_height = look->layout->robots[look->robot].carrier.chain.flip_height;
        look->flips = wh_real_abs(to[flip] - from[flip]) > 0;
        wh_chain_turn_over(&look->flipped.R, from[flip]);
        const wh_vec3_t axis = wh_vec3(0, 0, look->flip_height);
        const wh_vec3_t turned = wh_mat3_transform(&look->flipped.R, &axis);
        look->flipped.r = wh_vec3_subtract(&axis, &turned);
    }
}

static look_t look_around(const wh_layout_t *layout, size_t robot, size_t arm, const wh_real_t from[],
                          const wh_real_t to[]) {
    const wh_real_t yaw_from = from[WH_AXIS_YAW];
    const wh_real_t yaw_to = to[WH_AXIS_YAW];
    look_t look = {.layout = layout,
                   .robot = robot,
                   .arm = arm,
                   .low = yaw_from,
                   .high = yaw_to,
                   .flipped = wh_pose_identity(),
                   .reach = (wh_real_t)FLT_MAX};
    wh_outline_t outline = {NULL, 0, 0};
    if (yaw_to < yaw_from) {
        look.low = yaw_to;
        look.high = yaw_from;
    }
    take_flip(&look, from, to);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_mount_t *mount = &layout->machine.mounts[g];
        if (layout->grippers[g].station == WH_NONE && mount->robot == robot && mount->arm == arm) {
            look_at_gripper(&look, &outline, (int32_t)g);
        }
    }
    wh_outline_free(&outline);
    return look;
}

wh_real_t wh_transit_reach(const wh_layout_t *layout, size_t robot, size_t arm, const wh_real_t from[],
                           const wh_real_t to[]) {
    return look_around(layout, robot, arm, from, to).reach;
}

wh_real_t wh_transit_least(const wh_layout_t *layout, size_t robot, const wh_real_t from[],
                           const wh_real_t to[]) {
    const wh_real_t least = look_around(layout, robot, 0, from, to).outermost;
    return second_arm(layout, robot) > 0
               ? wh_real_max(least, look_around(layout, robot, 1, from, to).outermost)
               : least;
}

/* The robot turns theta or yaw, or goes along its rail. */
static bool turns(const wh_layout_t *layout, size_t robot, const wh_real_t from[], const wh_real_t to[]) {
    const size_t rail = own_axis(layout, robot, WH_CHAIN_RAIL);
    return wh_real_abs(to[WH_AXIS_THETA] - from[WH_AXIS_THETA]) > 0 ||
           wh_real_abs(to[WH_AXIS_YAW] - from[WH_AXIS_YAW]) > 0 ||
           (rail > 0 && wh_real_abs(to[rail] - from[rail]) > 0);
}

bool wh_transit_leaves(const wh_layout_t *layout, size_t robot, const wh_real_t from[], const wh_real_t to[],
                       wh_transit_t *transit) {
    const size_t second = second_arm(layout, robot);
    const size_t axes[] = {WH_AXIS_R, second};
    bool leaves = false;
    if (!(layout->robots[robot].transit > 0) || !turns(layout, robot, from, to)) {
        return false;
    }
    for (size_t arm = 0; arm < (second > 0 ? 2 : 1); ++arm) {
        const wh_real_t most = wh_real_max(from[axes[arm]], to[axes[arm]]);
        transit->reach[arm] = wh_transit_reach(layout, robot, arm, from, to);
        if (most > transit->reach[arm] && !leaves) {
            transit->r = most;
            leaves = true;
        }
    }
    return leaves;
}

bool wh_transit_corner(const wh_layout_t *layout, size_t robot, const wh_real_t from[],
                       const wh_real_t point[], const wh_real_t to[], wh_real_t reach[WH_POLAR_ARMS]) {
    if (!(layout->robots[robot].transit > 0) ||
        !(turns(layout, robot, from, point) || turns(layout, robot, point, to))) {
        return false;
    }
    /* Yaw as it may be with a part of either leg done. */
    wh_real_t low[WH_CARRIER_AXES] = {0};
    wh_real_t high[WH_CARRIER_AXES] = {0};
    const wh_real_t before = from[WH_AXIS_YAW] - point[WH_AXIS_YAW];
    const wh_real_t after = to[WH_AXIS_YAW] - point[WH_AXIS_YAW];
    size_t first = 0;
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, &first);
    const size_t count = carrier ? carrier->axis_count : WH_ROBOT_AXES;
    memcpy(low, from, count * sizeof *from);
    memcpy(high, to, count * sizeof *to);
    low[WH_AXIS_YAW] = point[WH_AXIS_YAW] - wh_real_max(-before, 0) - wh_real_max(-after, 0);
    high[WH_AXIS_YAW] = point[WH_AXIS_YAW] + wh_real_max(before, 0) + wh_real_max(after, 0);
    for (size_t arm = 0; arm < WH_POLAR_ARMS; ++arm) {
        reach[arm] = wh_transit_reach(layout, robot, arm, low, high);
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------- segments */

void wh_transit_keep(const wh_layout_t *layout, const wh_real_t from[WH_AXES], wh_segment_t *segment) {
    for (size_t robot = 0; robot < layout->robot_count; ++robot) {
        const size_t first = first_axis(layout, robot);
        wh_transit_t transit = {{0, 0}, 0};
        if (wh_transit_leaves(layout, robot, &from[first], &segment->target[first], &transit)) {
            segment->kind = WH_SEGMENT_WAY;
            segment->reach = transit.reach[0];
            segment->reach2 = transit.reach[1];
            segment->gripper = layout->robot_count > 1 ? wh_layout_first_gripper(layout, robot) : WH_NONE;
        }
    }
}

void wh_transit_say(const wh_layout_t *layout, const wh_real_t from[WH_AXES], const wh_segment_t *segment,
                    char *text, size_t size) {
    const bool has_several = layout->robot_count > 1;
    const size_t robot = has_several ? layout->machine.mounts[segment->gripper].robot : 0;
    const size_t first = first_axis(layout, robot);
    const wh_real_t least = wh_transit_least(layout, robot, &from[first], &segment->target[first]);
    (void)snprintf(text, size,
                   "`%s%s.transit` of %.10g mm leaves no room to turn: with r at %.10g mm, where its travel "
                   "begins, blades and wafers need %.1f mm",
                   has_several ? "robots." : "", layout->robots[robot].name, layout->robots[robot].transit,
                   inner_end(layout, robot), ceil(10 * least) / 10);
}
