#include "urdf.h"

#include <math.h>
#include <string.h>

#include "../layout/arms.h"
#include "../layout/axes.h"
#include "../math/trig.h"
#include "urdf_internal.h"

/* ---------------------------------------------------------------------------------------------- the robot */

wh_urdf_robot_t wh_urdf_robot(const wh_urdf_map_t *map, const wh_layout_t *layout) {
    wh_urdf_robot_t robot;
    robot.carrier = wh_machine_carrier(&layout->machine, map->robot, &robot.first);
    robot.count = robot.carrier ? robot.carrier->axis_count : WH_ROBOT_AXES;
    robot.arm = 0;
    while (layout->arms[robot.arm].robot != (int32_t)map->robot) {
        ++robot.arm;
    }
    return robot;
}

static bool is_scara(const wh_urdf_robot_t *robot) {
    return robot->carrier && robot->carrier->chain.kind == WH_CHAIN_SCARA;
}

/* ---------------------------------------------------------------------------------------------- the links */

wh_real_t wh_urdf_joint(const wh_urdf_map_t *map, int32_t link, const wh_real_t sources[]) {
    const wh_urdf_link_t *at = &map->file->links[link];
    wh_real_t factor = 1;
    wh_real_t offset = 0;
    while (at->mimics >= 0) {
        offset += factor * at->offset;
        factor *= at->factor;
        link = at->mimics;
        at = &map->file->links[link];
    }
    const wh_urdf_drive_t *drive = &map->drives[link];
    const wh_real_t source = drive->source < 0 ? 0 : sources[drive->source];
    return factor * (drive->offset + drive->factor * source) + offset;
}

/* The turn by an angle about an axis of length 1. */
static wh_mat3_t turn_about(const wh_vec3_t *axis, wh_real_t angle) {
    const wh_vec3_t *a = axis;
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(angle, &s, &c);
    const wh_real_t v = 1 - c;
    const wh_mat3_t R = {{{c + v * a->x * a->x, v * a->x * a->y - s * a->z, v * a->x * a->z + s * a->y},
                          {v * a->y * a->x + s * a->z, c + v * a->y * a->y, v * a->y * a->z - s * a->x},
                          {v * a->z * a->x - s * a->y, v * a->z * a->y + s * a->x, c + v * a->z * a->z}}};
    return R;
}

/* Writes root_from_link of all links. */
static void place_links(const wh_urdf_map_t *map, const wh_real_t sources[], wh_pose_t poses[]) {
    poses[0] = wh_pose_identity();
    for (size_t i = 1; i < map->file->link_count; ++i) {
        const wh_urdf_link_t *link = &map->file->links[i];
        wh_pose_t moved = wh_pose_identity();
        if (link->motion != WH_URDF_FIXED) {
            const wh_real_t value = wh_urdf_joint(map, (int32_t)i, sources);
            if (link->motion == WH_URDF_TURNS) {
                moved.R = turn_about(&link->axis, value);
            } else {
                moved.r = wh_vec3_scale(value, &link->axis);
            }
        }
        const wh_pose_t joint = wh_pose_compose(&poses[link->parent], &link->parent_from_joint);
        poses[i] = wh_pose_compose(&joint, &moved);
    }
}

/* To whole multiples of 1 / per_one, so that decimal numbers of a file come back as they are written. */
static wh_real_t rounded(wh_real_t value, wh_real_t per_one) {
    const wh_real_t whole = rint(value * per_one);
    return whole == 0 ? 0 : whole / per_one;
}

static const wh_real_t per_mm = 1e9;
static const wh_real_t per_cosine = 1e12;

static wh_pose_t rounded_pose(const wh_pose_t *pose) {
    wh_pose_t made;
    for (size_t i = 0; i < 9; ++i) {
        made.R.m[i / 3][i % 3] = rounded(pose->R.m[i / 3][i % 3], per_cosine);
    }
    made.r = wh_vec3(rounded(pose->r.x, per_mm), rounded(pose->r.y, per_mm), rounded(pose->r.z, per_mm));
    return made;
}

/* How far out along `heading` an arm's end-effector is, folded by `quarters` of 90 degrees; 0: stretched. */
static wh_real_t outwards(const wh_urdf_map_t *map, size_t number, wh_real_t heading, wh_real_t quarters) {
    const wh_real_t fold = quarters * wh_rad_from_deg(90);
    wh_real_t sources[WH_URDF_SOURCES] = {0};
    wh_real_t *angles = &sources[number * WH_URDF_ANGLES];
    wh_pose_t poses[WH_URDF_LINKS];
    wh_real_t s;
    wh_real_t c;
    angles[WH_URDF_FOLD] = angles[WH_URDF_WRIST] = fold;
    angles[WH_URDF_SHOULDER] = heading + fold;
    angles[WH_URDF_ELBOW] = -2 * fold;
    place_links(map, sources, poses);
    wh_sin_cos(heading, &s, &c);
    return c * poses[map->tools[number]].r.x + s * poses[map->tools[number]].r.y;
}

void wh_urdf_arm(const wh_urdf_map_t *map, size_t number, const wh_layout_t *layout, wh_arm_t *arm) {
    const wh_urdf_robot_t robot = wh_urdf_robot(map, layout);
    const wh_carrier_t *carrier = wh_layout_arm(layout, robot.arm + number, NULL);
    const wh_real_t heading = carrier ? carrier->chain.arm_heading : 0;
    const wh_real_t folded = outwards(map, number, heading, arm->right_handed ? -1 : 1);
    arm->reach = rounded(folded, per_mm);
    arm->link = rounded((outwards(map, number, heading, 0) - folded) / 2, per_mm);
}

/* -------------------------------------------------------------------------------------------- the sources */

/* The angle by which a body's x is turned from another's, in the other's plane. Full turns are added to bring
 * it nearest to an angle. */
static wh_real_t turn_between(const wh_pose_t *from, const wh_pose_t *to, wh_real_t near) {
    const wh_pose_t turned = wh_pose_relative(from, to);
    const wh_real_t turn = wh_rad_from_deg(360);
    const wh_real_t angle = wh_atan2(turned.R.m[1][0], turned.R.m[0][0]);
    return angle + turn * rint((near - angle) / turn);
}

/* Only theta, R and yaw tell how the links lie: the others are left at 0. */
static void find_angles(const wh_urdf_robot_t *robot, const wh_layout_t *layout, const wh_real_t axes[],
                        wh_links_t *links) {
    static const char *const names[] = {"theta", "r", "yaw", "r2"};
    wh_real_t few[WH_AXES] = {0};
    for (size_t i = robot->first; i < robot->first + robot->count; ++i) {
        for (size_t k = 0; k < sizeof names / sizeof names[0]; ++k) {
            few[i] = strcmp(wh_axis_name(&layout->machine, i), names[k]) == 0 ? axes[i] : few[i];
        }
    }
    wh_links_at(links, layout, few);
}

size_t wh_urdf_radial_axis(const wh_urdf_robot_t *robot, size_t number) {
    return robot->first + (number == 0 ? (size_t)WH_AXIS_R : robot->count - 1);
}

/* How much of an arm's length is between shoulder and wrist. The hand may be higher than the links. */
static wh_real_t stretch_of(const wh_pose_t bodies[], const wh_arm_t *arm) {
    wh_vec3_t out = wh_vec3_subtract(&bodies[WH_ARM_HAND].r, &bodies[WH_ARM_UPPER].r);
    out.z = 0;
    return wh_vec3_norm(&out) / (2 * arm->link);
}

wh_real_t wh_urdf_axis(const wh_urdf_robot_t *robot, const wh_layout_t *layout, const wh_real_t axes[],
                       size_t axis) {
    const size_t at = robot->first + axis;
    return wh_axis_exists(&layout->machine, at) ? axes[at] : 0;
}

/* The angles of a polar arm's links. Shoulder and wrist keep turning with theta and yaw. They differ from
 * these and the links' own fold by the direction of the wrist, seen from the shoulder, which is less than
 * half a turn. */
static void find_turns(const wh_urdf_robot_t *robot, const wh_layout_t *layout, const wh_real_t axes[],
                       size_t number, const wh_pose_t bodies[], wh_real_t angles[]) {
    const wh_arm_t *arm = wh_layout_arm_lengths(layout, (size_t)layout->arms[robot->arm].robot);
    const wh_carrier_t *carrier = wh_layout_arm(layout, robot->arm + number, NULL);
    const wh_real_t side = arm->right_handed ? -1 : 1;
    const wh_real_t fold = side * wh_acos(stretch_of(bodies, arm));
    const wh_real_t heading = carrier ? carrier->chain.arm_heading : 0;
    const wh_real_t out = axes[wh_urdf_radial_axis(robot, number)];
    angles[WH_URDF_FOLD] = side * wh_acos((out - arm->reach) / (2 * arm->link));
    angles[WH_URDF_SHOULDER] =
        turn_between(&bodies[WH_ARM_BASE], &bodies[WH_ARM_UPPER],
                     wh_urdf_axis(robot, layout, axes, WH_AXIS_THETA) + heading + fold);
    angles[WH_URDF_ELBOW] = turn_between(&bodies[WH_ARM_UPPER], &bodies[WH_ARM_FOREARM], -2 * fold);
    angles[WH_URDF_WRIST] = turn_between(&bodies[WH_ARM_FOREARM], &bodies[WH_ARM_HAND],
                                         wh_urdf_axis(robot, layout, axes, WH_AXIS_YAW) + fold);
}

void wh_urdf_sources(const wh_urdf_map_t *map, const wh_layout_t *layout, const wh_real_t axes[],
                     wh_real_t sources[], wh_real_t stretched[]) {
    const wh_urdf_robot_t robot = wh_urdf_robot(map, layout);
    const wh_arm_t *arm = wh_layout_arm_lengths(layout, map->robot);
    wh_links_t links;
    memset(sources, 0, WH_URDF_SOURCES * sizeof sources[0]);
    memcpy(sources, &axes[robot.first], robot.count * sizeof axes[0]);
    if (!is_scara(&robot)) {
        find_angles(&robot, layout, axes, &links);
    }
    for (size_t i = 0; i < map->arm_count; ++i) {
        const wh_pose_t *bodies = &links.bodies[(robot.arm + i) * WH_ARM_BODIES];
        stretched[i] = is_scara(&robot) ? WH_REAL(0.5) : stretch_of(bodies, arm);
        if (!is_scara(&robot)) {
            find_turns(&robot, layout, axes, i, bodies, &sources[i * WH_URDF_ANGLES]);
        }
    }
}

bool wh_urdf_is_reached(const wh_urdf_map_t *map, const wh_real_t stretched[]) {
    bool reached = true;
    for (size_t i = 0; i < map->arm_count; ++i) {
        reached = reached && !(map->folds[i] && stretched[i] > 1 + WH_REAL(1e-12));
    }
    return reached;
}

/* ------------------------------------------------------------------------------------- the configurations */

/* Home, then the ends of each axis with the others at home, then multiples of square roots of primes, whose
 * fractions lie evenly. */
static void configure(const wh_urdf_robot_t *robot, const wh_machine_t *machine, size_t number,
                      wh_real_t axes[]) {
    static const wh_real_t primes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
    memset(axes, 0, WH_AXES * sizeof axes[0]);
    wh_machine_home(machine, axes);
    for (size_t i = 0; i < robot->count; ++i) {
        const wh_travel_t *travel = wh_machine_travel(machine, robot->first + i);
        wh_real_t *axis = &axes[robot->first + i];
        if (number == 2 * i + 1) {
            *axis = travel->min;
        } else if (number == 2 * i + 2) {
            *axis = travel->max;
        } else if (number > 2 * robot->count) {
            const wh_real_t along = (wh_real_t)number * wh_real_sqrt(primes[i]);
            *axis = travel->min + (along - floor(along)) * (travel->max - travel->min);
        }
    }
}

static void compare_effector(const wh_pose_t *effector, const wh_real_t axes[], size_t arm,
                             const wh_pose_t *base_from_tool, wh_urdf_findings_t *findings) {
    wh_real_t squares = 0;
    const wh_vec3_t off = wh_vec3_subtract(&base_from_tool->r, &effector->r);
    for (size_t i = 0; i < 9; ++i) {
        const wh_real_t entry = base_from_tool->R.m[i / 3][i % 3] - effector->R.m[i / 3][i % 3];
        squares += entry * entry;
    }
    const wh_real_t mm = wh_vec3_norm(&off);
    const wh_real_t sine = wh_real_sqrt(squares / 8); /* of half the angle between them */
    const wh_real_t rad = 2 * wh_atan2(sine, wh_real_sqrt(wh_real_max(1 - sine * sine, 0)));
    const wh_real_t before = wh_real_max(findings->mm / WH_URDF_SAME_MM, findings->rad / WH_URDF_SAME_RAD);
    if (!(wh_real_max(mm / WH_URDF_SAME_MM, rad / WH_URDF_SAME_RAD) <= before)) {
        findings->arm = arm;
        findings->mm = mm;
        findings->rad = rad;
        findings->is = base_from_tool->r;
        findings->should = effector->r;
        memcpy(findings->axes, axes, sizeof findings->axes);
    }
}

static void compare_effectors(const wh_urdf_map_t *map, const wh_layout_t *layout, const wh_real_t axes[],
                              const wh_pose_t base_from_links[], wh_urdf_findings_t *findings) {
    const wh_urdf_robot_t robot = wh_urdf_robot(map, layout);
    for (size_t i = 0; i < map->arm_count; ++i) {
        wh_pose_t effector;
        if (i == 0) {
            wh_machine_effector(&layout->machine, map->robot, axes, &effector);
        } else {
            robot.carrier->second->forward(robot.carrier->second, &axes[robot.first], &effector);
        }
        compare_effector(&effector, axes, i, &base_from_links[map->tools[i]], findings);
    }
}

/* --------------------------------------------------------------------------------------------- the bodies */

/* By link and body, with the bodies of a second arm behind those of the first: the link's first place seen
 * from the body, and whether it has always been there. */
typedef struct {
    size_t body_count;
    bool is_first;
    bool rests[WH_URDF_LINKS][WH_URDF_ARMS * WH_ARM_BODIES];
    wh_pose_t body_from_link[WH_URDF_LINKS][WH_URDF_ARMS * WH_ARM_BODIES];
} rests_t;

/* Two places of a link that moves with a body may differ by more than the end-effector may from the robot's.
 * Each place may be off by as much as the end-effector, plus its reach of up to 2000 mm times the allowed
 * angle. This sum is 3e-6 mm, and the two may be in opposite directions. A link that does not move with the
 * body is off by far more. */
static bool is_same(const wh_pose_t *a, const wh_pose_t *b) {
    const wh_real_t room = 10;
    const wh_vec3_t off = wh_vec3_subtract(&a->r, &b->r);
    bool same = wh_vec3_norm(&off) <= room * WH_URDF_SAME_MM;
    for (size_t i = 0; same && i < 9; ++i) {
        same = wh_real_abs(a->R.m[i / 3][i % 3] - b->R.m[i / 3][i % 3]) <= room * WH_URDF_SAME_RAD;
    }
    return same;
}

static void watch(rests_t *rests, const wh_pose_t base_from_link[], size_t link_count,
                  const wh_pose_t bodies[]) {
    for (size_t i = 0; i < link_count; ++i) {
        for (size_t body = 0; body < rests->body_count; ++body) {
            const wh_pose_t now = wh_pose_relative(&bodies[body], &base_from_link[i]);
            if (rests->is_first) {
                rests->rests[i][body] = true;
                rests->body_from_link[i][body] = now;
            } else if (rests->rests[i][body]) {
                rests->rests[i][body] = is_same(&rests->body_from_link[i][body], &now);
            }
        }
    }
    rests->is_first = false;
}

/* Chooses the first one of several bodies. `first` is the number of the robot's first body. */
static void choose_bodies(const rests_t *rests, const wh_layout_t *layout, size_t first, size_t link_count,
                          wh_urdf_findings_t *findings) {
    for (size_t i = 0; i < link_count; ++i) {
        findings->body[i] = -1;
        for (size_t body = rests->body_count; !rests->is_first && body-- > 0;) {
            if (rests->rests[i][body] && wh_layout_has_body(layout, first + body)) {
                findings->body[i] = (int32_t)(first + body);
                findings->body_from_link[i] = rounded_pose(&rests->body_from_link[i][body]);
            }
        }
    }
}

void wh_urdf_shape_place(const wh_pose_t *body_from_link, wh_convex_t *convex) {
    const wh_pose_t body_from_shape = wh_pose_compose(body_from_link, &convex->body_from_shape);
    convex->body_from_shape = rounded_pose(&body_from_shape);
    convex->half.x = rounded(convex->half.x, per_mm);
    convex->half.y = rounded(convex->half.y, per_mm);
    convex->half.z = rounded(convex->half.z, per_mm);
}

static bool is_clear(const wh_urdf_map_t *map, const wh_real_t stretched[]) {
    bool clear = true;
    for (size_t i = 0; i < map->arm_count; ++i) {
        clear = clear && stretched[i] > WH_REAL(1e-3) && stretched[i] < WH_REAL(0.999);
    }
    return clear;
}

void wh_urdf_examine(const wh_urdf_map_t *map, const wh_layout_t *layout, wh_urdf_findings_t *findings) {
    const wh_urdf_robot_t robot = wh_urdf_robot(map, layout);
    const wh_chain_t *chain = robot.carrier ? &robot.carrier->chain : NULL;
    const wh_pose_t root = chain && chain->is_placed ? chain->base_from_robot : wh_pose_identity();
    const size_t first_body = robot.arm * WH_ARM_BODIES;
    rests_t rests = {.is_first = true, .body_count = map->arm_count * WH_ARM_BODIES};
    wh_urdf_extremes_t extremes = {0};
    memset(findings, 0, sizeof *findings);
    findings->beyond = -1;
    for (size_t number = 0; number < WH_URDF_CONFIGURATIONS; ++number) {
        wh_real_t axes[WH_AXES];
        wh_real_t sources[WH_URDF_SOURCES];
        wh_real_t stretched[WH_URDF_ARMS];
        wh_pose_t poses[WH_URDF_LINKS];
        wh_links_t links;
        configure(&robot, &layout->machine, number, axes);
        wh_urdf_sources(map, layout, axes, sources, stretched);
        if (!wh_urdf_is_reached(map, stretched)) {
            continue;
        }
        ++findings->reached;
        place_links(map, sources, poses);
        for (size_t i = 0; i < map->file->link_count; ++i) {
            poses[i] = wh_pose_compose(&root, &poses[i]);
        }
        compare_effectors(map, layout, axes, poses, findings);
        wh_urdf_note_extremes(map, axes, sources, &extremes);
        if (is_clear(map, stretched)) {
            wh_links_at(&links, layout, axes);
            watch(&rests, poses, map->file->link_count, &links.bodies[first_body]);
        }
    }
    choose_bodies(&rests, layout, first_body, map->file->link_count, findings);
    if (findings->reached > 0) {
        wh_urdf_check_limits(map, layout, &extremes, findings);
    }
}
