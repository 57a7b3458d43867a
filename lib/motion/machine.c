#include "machine.h"

#include "../math/exact_internal.h"
#include "../math/trig.h"

/* Any tilt changes one of these entries; a turn about z alone changes none of them, even with rounding. */
static bool is_level(const wh_mat3_t *R) {
    return !(wh_real_abs(R->m[0][2]) > 0 || wh_real_abs(R->m[1][2]) > 0 || wh_real_abs(R->m[2][0]) > 0 ||
             wh_real_abs(R->m[2][1]) > 0 || wh_real_abs(R->m[2][2] - 1) > 0);
}

static wh_status_t validate_shift(const wh_mount_t *mount) {
    if (!mount->is_shifted) {
        return WH_OK;
    }
    const wh_status_t status = wh_pose_validate(&mount->effector_from_gripper);
    if (status != WH_OK) {
        return status;
    }
    return is_level(&mount->effector_from_gripper.R) ? WH_OK : WH_STATUS_NOT_LEVEL;
}

/* Checks a stage, whose travel goes to both sides, pins, which go up, or a flipper. */
static wh_status_t validate_slides(const wh_mount_t *mount) {
    const wh_travel_t *travel = &mount->travel;
    if (mount->kind == WH_MOUNT_CHUCK) {
        return WH_OK;
    }
    if (!wh_real_is_finite(travel->min) || !wh_real_is_finite(travel->max) ||
        !wh_real_is_finite(mount->height)) {
        return WH_STATUS_NOT_FINITE;
    }
    const bool good = mount->kind == WH_MOUNT_STAGE ? travel->max > 0 : travel->min < travel->max;
    return good ? wh_limits_validate(&mount->limits) : WH_STATUS_BAD_LIMITS;
}

static bool has_arm(const wh_machine_t *machine, const wh_mount_t *mount) {
    if (mount->robot >= wh_machine_robots(machine)) {
        return false;
    }
    const wh_carrier_t *carrier = wh_machine_carrier(machine, mount->robot, NULL);
    return mount->arm == 0 || (mount->arm == 1 && carrier && carrier->second);
}

static bool is_kind(wh_mount_kind_t kind) {
    return kind == WH_MOUNT_CHUCK || kind == WH_MOUNT_STAGE || kind == WH_MOUNT_PINS ||
           kind == WH_MOUNT_FLIPPER;
}

static wh_status_t validate_mount(const wh_machine_t *machine, const wh_mount_t *mount) {
    if (mount->axis == WH_NONE) {
        return has_arm(machine, mount) ? validate_shift(mount) : WH_STATUS_OUT_OF_RANGE;
    }
    if (!is_kind(mount->kind) || mount->axis < 0 || (size_t)mount->axis < wh_machine_robot_axes(machine) ||
        (size_t)mount->axis + wh_mount_axes(mount) > machine->axis_count - machine->door_count) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = validate_slides(mount);
    return status == WH_OK ? wh_pose_validate(&mount->base_from_station) : status;
}

wh_status_t wh_door_validate(const wh_door_t *door) {
    const wh_real_t off = wh_vec3_dot(&door->way, &door->way) - 1;
    if (!wh_real_is_finite(off) || !wh_real_is_finite(door->travel)) {
        return WH_STATUS_NOT_FINITE;
    }
    return door->travel > 0 && wh_real_abs(off) < WH_REAL(1e-5) ? wh_limits_validate(&door->limits)
                                                                : WH_STATUS_BAD_LIMITS;
}

static wh_status_t validate_doors(const wh_machine_t *machine) {
    if (machine->door_count > WH_DOORS ||
        wh_machine_robot_axes(machine) + machine->door_count > machine->axis_count) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_status_t status = machine->doors || machine->door_count == 0 ? WH_OK : WH_STATUS_NULL_ARGUMENT;
    for (size_t d = 0; d < machine->door_count && status == WH_OK; ++d) {
        status = wh_door_validate(&machine->doors[d]);
    }
    return status;
}

static bool are_counts_good(const wh_machine_t *machine) {
    return machine->axis_count >= wh_machine_robot_axes(machine) && machine->axis_count <= WH_AXES &&
           machine->gripper_count >= 1 && machine->gripper_count <= WH_GRIPPERS;
}

wh_status_t wh_machine_validate(const wh_machine_t *machine) {
    if (!machine) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!are_counts_good(machine)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_status_t status = WH_OK;
    if (!machine->carrier) {
        status = wh_robot_validate(&machine->robot);
    }
    if (status == WH_OK) {
        status = wh_limits_validate(&machine->chuck_limits);
    }
    if (status == WH_OK) {
        status = validate_doors(machine);
    }
    for (size_t g = 0; g < machine->gripper_count && status == WH_OK; ++g) {
        status = validate_mount(machine, &machine->mounts[g]);
    }
    return status;
}

void wh_machine_take_carrier(wh_machine_t *machine, const wh_carrier_t *carrier) {
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        machine->robot.travel[axis] = carrier->chain.travel[carrier->axes[axis]];
        machine->robot.limits[axis] = carrier->chain.limits[carrier->axes[axis]];
        machine->robot.home[axis] = carrier->chain.home[carrier->axes[axis]];
    }
    machine->carrier = carrier;
    machine->axis_count = wh_machine_robot_axes(machine);
}

size_t wh_machine_robots(const wh_machine_t *machine) {
    size_t count = machine->carrier ? 0 : 1;
    for (const wh_carrier_t *carrier = machine->carrier; carrier; carrier = carrier->next) {
        ++count;
    }
    return count;
}

const wh_carrier_t *wh_machine_carrier(const wh_machine_t *machine, size_t robot, size_t *first) {
    const wh_carrier_t *carrier = machine->carrier;
    size_t axis = 0;
    for (size_t before = robot; before > 0; --before) {
        axis += carrier->axis_count;
        carrier = carrier->next;
    }
    if (first) {
        *first = axis;
    }
    return carrier;
}

static const wh_carrier_t *arm_of(const wh_machine_t *machine, const wh_mount_t *mount, size_t *first) {
    const wh_carrier_t *carrier = wh_machine_carrier(machine, mount->robot, first);
    return mount->arm == 0 ? carrier : carrier->second;
}

const wh_carrier_t *wh_machine_arm(const wh_machine_t *machine, size_t gripper, size_t *first) {
    return arm_of(machine, &machine->mounts[gripper], first);
}

/* The carrier that has this axis; `axis` becomes its own index. Null: no carrier has it. */
static const wh_carrier_t *find_carrier(const wh_machine_t *machine, size_t *axis) {
    const wh_carrier_t *carrier = machine->carrier;
    while (carrier && *axis >= carrier->axis_count) {
        *axis -= carrier->axis_count;
        carrier = carrier->next;
    }
    return carrier;
}

int32_t wh_machine_robot_of(const wh_machine_t *machine, size_t axis, size_t *own) {
    size_t index = axis;
    int32_t robot = 0;
    const wh_carrier_t *has_it = find_carrier(machine, &index);
    if (axis >= wh_machine_robot_axes(machine)) {
        return WH_NONE;
    }
    for (const wh_carrier_t *carrier = machine->carrier; carrier != has_it; carrier = carrier->next) {
        ++robot;
    }
    *own = index;
    return robot;
}

/* The mount whose stage, pins or flipper this axis moves; null: none. */
static const wh_mount_t *find_slide(const wh_machine_t *machine, size_t axis) {
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        size_t turning = 1;
        if (mount->kind == WH_MOUNT_PINS || mount->kind == WH_MOUNT_FLIPPER) {
            turning = 0;
        }
        const size_t first = mount->axis == WH_NONE ? 0 : (size_t)mount->axis;
        if (axis >= first + turning && axis < first + wh_mount_axes(mount)) {
            return mount;
        }
    }
    return NULL;
}

/* The door that this axis moves; null: none. */
static const wh_door_t *find_door(const wh_machine_t *machine, size_t axis) {
    const size_t first = wh_machine_door_axis(machine, 0);
    return axis >= first && axis < machine->axis_count ? &machine->doors[axis - first] : NULL;
}

const wh_limits_t *wh_machine_limits(const wh_machine_t *machine, size_t axis) {
    size_t own = axis;
    const wh_carrier_t *carrier = find_carrier(machine, &own);
    if (carrier) {
        const wh_chain_t *chain = wh_carrier_axis(carrier, own, &own);
        return &chain->limits[own];
    }
    if (!machine->carrier && axis < WH_ROBOT_AXES) {
        return &machine->robot.limits[axis];
    }
    const wh_door_t *door = find_door(machine, axis);
    if (door) {
        return &door->limits;
    }
    const wh_mount_t *mount = find_slide(machine, axis);
    return mount ? &mount->limits : &machine->chuck_limits;
}

const wh_travel_t *wh_machine_travel(const wh_machine_t *machine, size_t axis) {
    size_t own = axis;
    const wh_carrier_t *carrier = find_carrier(machine, &own);
    if (carrier) {
        const wh_chain_t *chain = wh_carrier_axis(carrier, own, &own);
        return &chain->travel[own];
    }
    return machine->carrier || axis >= WH_ROBOT_AXES ? NULL : &machine->robot.travel[axis];
}

void wh_machine_home(const wh_machine_t *machine, wh_real_t axes[]) {
    for (size_t axis = 0; axis < machine->axis_count; ++axis) {
        size_t own = axis;
        const wh_carrier_t *carrier = find_carrier(machine, &own);
        const bool is_usual = !machine->carrier && axis < WH_ROBOT_AXES;
        axes[axis] = is_usual ? machine->robot.home[axis] : 0;
        if (carrier) {
            const wh_chain_t *chain = wh_carrier_axis(carrier, own, &own);
            axes[axis] = chain->home[own];
        }
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if (mount->axis != WH_NONE && mount->kind == WH_MOUNT_PINS) {
            axes[mount->axis] = mount->travel.min;
        }
    }
    for (size_t d = 0; d < machine->door_count; ++d) {
        axes[wh_machine_door_axis(machine, d)] = wh_door_home(&machine->doors[d]);
    }
}

wh_travel_t wh_machine_beside(const wh_machine_t *machine, size_t axis) {
    const wh_door_t *door = find_door(machine, axis);
    if (door) {
        return (wh_travel_t){0, door->travel};
    }
    const wh_mount_t *mount = find_slide(machine, axis);
    if (!mount) {
        return (wh_travel_t){-WH_CHUCK_TRAVEL, WH_CHUCK_TRAVEL};
    }
    return mount->kind == WH_MOUNT_STAGE ? (wh_travel_t){-mount->travel.max, mount->travel.max}
                                         : mount->travel;
}

static wh_status_t check_robots(const wh_machine_t *machine, const wh_real_t axes[]) {
    const wh_real_t *own = axes;
    wh_status_t status = WH_OK;
    if (machine->carrier == NULL) {
        status = wh_robot_check_travel(&machine->robot, axes);
    }
    for (const wh_carrier_t *carrier = machine->carrier; carrier && status == WH_OK;
         carrier = carrier->next) {
        status = carrier->check_travel(carrier, own);
        own = &own[carrier->axis_count];
    }
    return status;
}

wh_status_t wh_machine_check_travel(const wh_machine_t *machine, const wh_real_t axes[]) {
    const wh_status_t status = check_robots(machine, axes);
    if (status != WH_OK) {
        return status;
    }
    for (size_t axis = wh_machine_robot_axes(machine); axis < machine->axis_count; ++axis) {
        if (!wh_real_is_finite(axes[axis])) {
            return WH_STATUS_NOT_FINITE;
        }
        const wh_travel_t travel = wh_machine_beside(machine, axis);
        if (axes[axis] < travel.min || axes[axis] > travel.max) {
            return WH_STATUS_LIMIT_EXCEEDED;
        }
    }
    return WH_OK;
}

/* -------------------------------------------------------------------------------------------------- poses */

/* Places a gripper on its robot. */
static void place_on_robot(const wh_mount_t *mount, const wh_pose_t *base_from_effector, wh_pose_t *pose) {
    if (mount->is_shifted) {
        wh_pose_compose_to(base_from_effector, &mount->effector_from_gripper, pose);
    } else {
        *pose = *base_from_effector;
    }
}

/* Turns it about the station's x, at the height of the flipper's axis. */
static WH_OUT_OF_LINE void turn_over(const wh_mount_t *mount, wh_real_t angle, wh_pose_t *pose) {
    const wh_pose_t *station = &mount->base_from_station;
    wh_real_t sine, cosine;
    wh_sin_cos(angle, &sine, &cosine);
    const wh_mat3_t turn = {{{1, 0, 0}, {0, cosine, -sine}, {0, sine, cosine}}};
    const wh_vec3_t at = wh_vec3(0, mount->height * sine, mount->height * (1 - cosine));
    wh_mat3_multiply_to(&station->R, &turn, &pose->R);
    pose->r = wh_pose_point(station, &at);
}

/* Places a gripper that is not on a robot, by its own axes. */
static void place_beside(const wh_mount_t *mount, const wh_real_t own[], wh_pose_t *pose) {
    const wh_pose_t *station = &mount->base_from_station;
    if (mount->kind == WH_MOUNT_PINS) {
        const wh_vec3_t up = wh_vec3(0, 0, own[0]);
        pose->R = station->R;
        pose->r = wh_pose_point(station, &up);
        return;
    }
    if (mount->kind == WH_MOUNT_FLIPPER) {
        turn_over(mount, own[0], pose);
        return;
    }
    const wh_mat3_t turn = wh_mat3_about_z(own[0]);
    wh_mat3_multiply_to(&station->R, &turn, &pose->R);
    pose->r = station->r;
    if (mount->kind == WH_MOUNT_STAGE) {
        const wh_vec3_t aside = wh_vec3(own[1], own[2], 0);
        pose->r = wh_pose_point(station, &aside);
    }
}

void wh_machine_effector(const wh_machine_t *machine, size_t robot, const wh_real_t axes[],
                         wh_pose_t *base_from_effector) {
    size_t first;
    const wh_carrier_t *carrier = wh_machine_carrier(machine, robot, &first);
    if (carrier) {
        carrier->forward(carrier, &axes[first], base_from_effector);
    } else {
        wh_robot_forward(axes, base_from_effector);
    }
}

static WH_OUT_OF_LINE void place_on_other(const wh_machine_t *machine, const wh_mount_t *mount,
                                          const wh_real_t axes[], wh_pose_t *pose) {
    size_t first;
    const wh_carrier_t *arm = arm_of(machine, mount, &first);
    wh_pose_t base_from_effector;
    arm->forward(arm, &axes[first], &base_from_effector);
    place_on_robot(mount, &base_from_effector, pose);
}

void wh_machine_grippers(const wh_machine_t *machine, const wh_real_t axes[], wh_pose_t poses[]) {
    wh_pose_t base_from_effector;
    if (machine->carrier) {
        machine->carrier->forward(machine->carrier, axes, &base_from_effector);
    } else {
        wh_robot_forward(axes, &base_from_effector);
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if (mount->axis != WH_NONE) {
            place_beside(mount, &axes[mount->axis], &poses[g]);
        } else if (mount->robot == 0 && mount->arm == 0) {
            place_on_robot(mount, &base_from_effector, &poses[g]);
        } else {
            place_on_other(machine, mount, axes, &poses[g]);
        }
    }
}

/* Compares bits: 0 and -0 differ, and NaN equals itself. */
static bool is_same(wh_real_t a, wh_real_t b) {
    return wh_bits(a) == wh_bits(b);
}

/* Keeps the axes in the cache. Returns bit a for each axis a that has moved since the last call. */
static uint32_t take_axes(const wh_machine_t *machine, const wh_real_t axes[], wh_machine_cache_t *cache) {
    uint32_t moved = 0;
    for (size_t axis = 0; axis < machine->axis_count; ++axis) {
        moved |= cache->is_taken && is_same(axes[axis], cache->axes[axis]) ? 0 : 1U << axis;
        cache->axes[axis] = axes[axis];
    }
    return moved;
}

static bool has_moved(uint32_t moved, size_t axis) {
    return (moved >> axis & 1U) != 0;
}

/* wh_robot_forward with the sines of the cache. */
static void move_effector(const wh_real_t q[], uint32_t moved, wh_machine_cache_t *cache) {
    const wh_real_t heading = q[WH_AXIS_THETA] + q[WH_AXIS_YAW];
    wh_pose_t *effector = &cache->base_from_effector;
    if (has_moved(moved, WH_AXIS_THETA)) {
        wh_sin_cos(q[WH_AXIS_THETA], &cache->sine, &cache->cosine);
    }
    effector->r = wh_vec3(q[WH_AXIS_R] * cache->cosine, q[WH_AXIS_R] * cache->sine, q[WH_AXIS_Z]);
    if (!cache->is_taken || !is_same(heading, cache->heading)) {
        effector->R = is_same(heading, q[WH_AXIS_THETA]) ? wh_mat3_turn_z(cache->sine, cache->cosine)
                                                         : wh_mat3_about_z(heading);
    }
    cache->heading = heading;
}

/* Places the grippers on one arm, which may be null. */
static void move_arm(const wh_machine_t *machine, const wh_carrier_t *arm, const wh_real_t axes[],
                     size_t robot, uint8_t number, wh_gripper_input_t grippers[]) {
    wh_pose_t base_from_effector;
    if (arm) {
        arm->forward(arm, axes, &base_from_effector);
    }
    for (size_t g = 0; arm && g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if (mount->axis == WH_NONE && mount->robot == robot && mount->arm == number) {
            place_on_robot(mount, &base_from_effector, &grippers[g].base_from_gripper);
        }
    }
}

/* Places the grippers on robots with carriers, for those robots that have moved. */
static WH_OUT_OF_LINE void move_carried(const wh_machine_t *machine, const wh_real_t axes[], uint32_t moved,
                                        wh_gripper_input_t grippers[]) {
    const wh_real_t *own = axes;
    uint32_t own_moved = moved; /* bit 0: own[0] has moved */
    size_t robot = 0;
    for (const wh_carrier_t *carrier = machine->carrier; carrier; carrier = carrier->next) {
        if ((own_moved & ((1U << carrier->axis_count) - 1)) != 0) {
            move_arm(machine, carrier, own, robot, 0, grippers);
            move_arm(machine, carrier->second, own, robot, 1, grippers);
        }
        own = &own[carrier->axis_count];
        own_moved >>= carrier->axis_count;
        ++robot;
    }
}

void wh_machine_update(const wh_machine_t *machine, const wh_real_t axes[], wh_machine_cache_t *cache,
                       wh_gripper_input_t grippers[]) {
    const uint32_t moved = take_axes(machine, axes, cache);
    const bool robot = !machine->carrier && (moved & ((1U << WH_ROBOT_AXES) - 1)) != 0;
    if (machine->carrier) {
        move_carried(machine, axes, moved, grippers);
    } else if (robot) {
        move_effector(axes, moved, cache);
    }
    for (size_t g = 0; moved != 0 && g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if ((moved & wh_mount_moved_by(mount)) != 0) {
            place_beside(mount, &axes[mount->axis], &grippers[g].base_from_gripper);
        } else if (mount->axis == WH_NONE && robot) {
            place_on_robot(mount, &cache->base_from_effector, &grippers[g].base_from_gripper);
        }
    }
    cache->is_taken = true;
}

wh_status_t wh_machine_bring(const wh_machine_t *machine, size_t gripper, const wh_pose_t *base_from_gripper,
                             const wh_chain_choice_t *choice, const wh_real_t near_q[], wh_real_t q[]) {
    const wh_mount_t *mount = &machine->mounts[gripper];
    size_t first;
    const wh_carrier_t *carrier = arm_of(machine, mount, &first);
    wh_pose_t effector = *base_from_gripper;
    if (mount->is_shifted) {
        const wh_pose_t identity = wh_pose_identity();
        const wh_pose_t back = wh_pose_relative(&mount->effector_from_gripper, &identity);
        effector = wh_pose_compose(base_from_gripper, &back);
    }
    return carrier->inverse(carrier, &effector, choice, &near_q[first], &q[first]);
}

/* Level except for the flip; rail, flip and elbow keep their positions. */
static wh_status_t bring_level(const wh_machine_t *machine, size_t gripper, const wh_vec3_t *at,
                               wh_real_t heading, const wh_real_t near_q[], wh_real_t q[]) {
    if (!(wh_real_abs(heading) <= WH_TRIG_MAX_RAD)) {
        return wh_real_is_finite(heading) ? WH_STATUS_OUT_OF_RANGE : WH_STATUS_NOT_FINITE;
    }
    size_t first;
    const wh_carrier_t *carrier = wh_machine_carrier(machine, machine->mounts[gripper].robot, &first);
    const wh_chain_choice_t as_it_is = wh_carrier_choice(carrier, &near_q[first]);
    wh_pose_t pose;
    pose.R = wh_mat3_about_z(heading);
    pose.r = *at;
    if (carrier->chain.has_flip) {
        wh_chain_turn_over(&pose.R, as_it_is.flip);
    }
    return wh_machine_bring(machine, gripper, &pose, &as_it_is, near_q, q);
}

wh_status_t wh_machine_inverse(const wh_machine_t *machine, size_t gripper, const wh_vec3_t *at,
                               wh_real_t heading, const wh_real_t near_q[], wh_real_t q[]) {
    const wh_mount_t *mount = &machine->mounts[gripper];
    if (machine->carrier) {
        return bring_level(machine, gripper, at, heading, near_q, q);
    }
    if (!mount->is_shifted) {
        return wh_robot_inverse(&machine->robot, at->x, at->y, at->z, heading, near_q, q);
    }
    const wh_pose_t *shift = &mount->effector_from_gripper;
    const wh_real_t turned = heading - wh_atan2(shift->R.m[1][0], shift->R.m[0][0]);
    if (!(wh_real_abs(turned) <= WH_TRIG_MAX_RAD)) {
        return wh_real_is_finite(turned) ? WH_STATUS_OUT_OF_RANGE : WH_STATUS_NOT_FINITE;
    }
    const wh_mat3_t turn = wh_mat3_about_z(turned);
    const wh_vec3_t reach = wh_mat3_transform(&turn, &shift->r);
    const wh_vec3_t effector = wh_vec3_subtract(at, &reach);
    return wh_robot_inverse(&machine->robot, effector.x, effector.y, effector.z, turned, near_q, q);
}
