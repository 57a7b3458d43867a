#include "transit.h"

#include <math.h>
#include <stdio.h>

#include "../math/trig.h"
#include "outline.h"

/* What is looked for, over all corners. */
typedef struct {
    const wh_layout_t *layout;
    size_t robot;
    wh_real_t low, high; /* yaw, rad */
    wh_real_t reach;     /* the largest R so far that keeps all corners within the transit */
    wh_real_t outermost; /* of all corners, with R at its inner end */
} look_t;

/* The first axis of a robot. */
static size_t first_axis(const wh_layout_t *layout, size_t robot) {
    size_t first = 0;
    (void)wh_machine_carrier(&layout->machine, robot, &first);
    return first;
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

/* A corner of what is on the end-effector, in its frame. */
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

static void look_at_shape(look_t *look, wh_outline_t *outline, const wh_mount_t *mount,
                          const wh_convex_t *shape) {
    const bool polygonal = shape->kind == WH_CONVEX_BOX || shape->kind == WH_CONVEX_MESH;
    const wh_pose_t level = wh_pose_identity();
    const wh_pose_t *from = mount->is_shifted ? &mount->effector_from_gripper : &level;
    const wh_pose_t effector_from_shape = wh_pose_compose(from, &shape->body_from_shape);
    wh_outline_draw(outline, WH_VIEW_TOP, shape, &effector_from_shape);
    for (size_t i = 0; i < outline->count; ++i) {
        look_at(look, outline->spots[i].x, -outline->spots[i].y, polygonal ? 1 : ENCLOSING);
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

static look_t look_around(const wh_layout_t *layout, size_t robot, wh_real_t yaw_from, wh_real_t yaw_to) {
    look_t look = {layout, robot, yaw_from, yaw_to, (wh_real_t)FLT_MAX, 0};
    wh_outline_t outline = {NULL, 0, 0};
    if (yaw_to < yaw_from) {
        look.low = yaw_to;
        look.high = yaw_from;
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (layout->grippers[g].station == WH_NONE && layout->machine.mounts[g].robot == robot) {
            look_at_gripper(&look, &outline, (int32_t)g);
        }
    }
    wh_outline_free(&outline);
    return look;
}

wh_real_t wh_transit_reach(const wh_layout_t *layout, size_t robot, wh_real_t yaw_from, wh_real_t yaw_to) {
    return look_around(layout, robot, yaw_from, yaw_to).reach;
}

wh_real_t wh_transit_least(const wh_layout_t *layout, size_t robot, wh_real_t yaw_from, wh_real_t yaw_to) {
    return look_around(layout, robot, yaw_from, yaw_to).outermost;
}

/* ---------------------------------------------------------------------------------------------- segments */

static void keep_robot(const wh_layout_t *layout, size_t robot, const wh_real_t from[WH_ROBOT_AXES],
                       const wh_real_t to[WH_ROBOT_AXES], wh_segment_t *segment) {
    const bool turns = wh_real_abs(to[WH_AXIS_THETA] - from[WH_AXIS_THETA]) > 0 ||
                       wh_real_abs(to[WH_AXIS_YAW] - from[WH_AXIS_YAW]) > 0;
    if (turns) {
        const wh_real_t reach = wh_transit_reach(layout, robot, from[WH_AXIS_YAW], to[WH_AXIS_YAW]);
        if (from[WH_AXIS_R] > reach || to[WH_AXIS_R] > reach) {
            segment->kind = WH_SEGMENT_WAY;
            segment->reach = reach;
            segment->gripper = layout->robot_count > 1 ? wh_layout_first_gripper(layout, robot) : WH_NONE;
        }
    }
}

void wh_transit_keep(const wh_layout_t *layout, const wh_real_t from[WH_AXES], wh_segment_t *segment) {
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const size_t first = first_axis(layout, r);
        if (layout->robots[r].transit > 0) {
            keep_robot(layout, r, &from[first], &segment->target[first], segment);
        }
    }
}

void wh_transit_say(const wh_layout_t *layout, const wh_real_t from[WH_AXES], const wh_segment_t *segment,
                    char *text, size_t size) {
    const bool has_several = layout->robot_count > 1;
    const size_t robot = has_several ? layout->machine.mounts[segment->gripper].robot : 0;
    const size_t yaw = first_axis(layout, robot) + WH_AXIS_YAW;
    const wh_real_t least = wh_transit_least(layout, robot, from[yaw], segment->target[yaw]);
    (void)snprintf(text, size,
                   "`%s%s.transit` of %.10g mm leaves no room to turn: with r at %.10g mm, where its travel "
                   "begins, blades and wafers need %.1f mm",
                   has_several ? "robots." : "", layout->robots[robot].name, layout->robots[robot].transit,
                   inner_end(layout, robot), ceil(10 * least) / 10);
}
