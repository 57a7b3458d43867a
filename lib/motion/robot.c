#include "robot.h"

#include "turns_internal.h"

void wh_robot_default(wh_robot_t *robot) {
    const wh_robot_t standard = {
        .travel = {{wh_rad_from_deg(-540), wh_rad_from_deg(540)},
                   {300, 900},
                   {600, 1300},
                   {wh_rad_from_deg(-270), wh_rad_from_deg(270)}},
        .limits = {{wh_rad_from_deg(300), wh_rad_from_deg(1000), wh_rad_from_deg(10000)},
                   {1000, 5000, 50000},
                   {400, 2000, 20000},
                   {wh_rad_from_deg(360), wh_rad_from_deg(1500), wh_rad_from_deg(15000)}},
        .home = {0, 300, 900, 0},
    };
    *robot = standard;
}

static bool is_angle(size_t axis) {
    return axis == WH_AXIS_THETA || axis == WH_AXIS_YAW;
}

static bool is_in_travel(const wh_robot_t *robot, size_t axis, wh_real_t position) {
    static const wh_real_t slacks[] = {WH_SLACK_MM, WH_SLACK_RAD};
    const wh_real_t slack = slacks[is_angle(axis) ? 1 : 0];
    return wh_travel_has(&robot->travel[axis], slack, position);
}

static bool axis_is_sound(const wh_robot_t *robot, size_t axis) {
    const wh_travel_t *travel = &robot->travel[axis];
    const wh_real_t widest = is_angle(axis) ? WH_TRIG_MAX_RAD / 2 : (wh_real_t)FLT_MAX;
    return wh_limits_validate(&robot->limits[axis]) == WH_OK && wh_travel_is_sound(travel, widest) &&
           is_in_travel(robot, axis, robot->home[axis]);
}

wh_status_t wh_robot_validate(const wh_robot_t *robot) {
    if (robot == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    bool sound = robot->travel[WH_AXIS_R].min >= 0;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        sound = sound && axis_is_sound(robot, axis);
    }
    return sound ? WH_OK : WH_STATUS_BAD_LIMITS;
}

wh_status_t wh_robot_check_travel(const wh_robot_t *robot, const wh_real_t q[WH_ROBOT_AXES]) {
    if (robot == NULL || q == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    bool others = true;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        if (!wh_real_is_finite(q[axis])) {
            return WH_STATUS_NOT_FINITE;
        }
        others = others && (axis == WH_AXIS_R || is_in_travel(robot, axis, q[axis]));
    }
    if (!is_in_travel(robot, WH_AXIS_R, q[WH_AXIS_R])) {
        return WH_STATUS_OUT_OF_REACH;
    }
    return others ? WH_OK : WH_STATUS_LIMIT_EXCEEDED;
}

void wh_robot_forward(const wh_real_t q[WH_ROBOT_AXES], wh_pose_t *base_from_effector) {
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(q[WH_AXIS_THETA], &s, &c);
    base_from_effector->r = wh_vec3(q[WH_AXIS_R] * c, q[WH_AXIS_R] * s, q[WH_AXIS_Z]);
    base_from_effector->R = wh_mat3_about_z(q[WH_AXIS_THETA] + q[WH_AXIS_YAW]);
}

/* Checks that the input is finite and within the range of the angle reductions. */
static wh_status_t check_target(wh_real_t x, wh_real_t y, wh_real_t z, wh_real_t heading, wh_real_t now) {
    if (!wh_real_is_finite(x) || !wh_real_is_finite(y) || !wh_real_is_finite(z) ||
        !wh_real_is_finite(heading) || !wh_real_is_finite(now)) {
        return WH_STATUS_NOT_FINITE;
    }
    const bool in_range = wh_real_abs(heading) <= WH_TRIG_MAX_RAD && wh_real_abs(now) <= WH_TRIG_MAX_RAD;
    return in_range ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

wh_status_t wh_robot_inverse(const wh_robot_t *robot, wh_real_t x, wh_real_t y, wh_real_t z,
                             wh_real_t heading, const wh_real_t near_q[WH_ROBOT_AXES],
                             wh_real_t q[WH_ROBOT_AXES]) {
    if (robot == NULL || near_q == NULL || q == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = check_target(x, y, z, heading, near_q[WH_AXIS_THETA]);
    if (status != WH_OK) {
        return status;
    }
    const wh_real_t R = wh_real_sqrt(x * x + y * y);
    if (!(R > 0) || !is_in_travel(robot, WH_AXIS_R, R)) {
        return WH_STATUS_OUT_OF_REACH;
    }
    const wh_real_t theta =
        wh_turns_nearest(&robot->travel[WH_AXIS_THETA], wh_atan2(y, x), near_q[WH_AXIS_THETA]);
    const wh_real_t found[WH_ROBOT_AXES] = {theta, R, z, wh_turns_between(theta, heading)};
    status = wh_robot_check_travel(robot, found);
    for (size_t axis = 0; status == WH_OK && axis < WH_ROBOT_AXES; ++axis) {
        q[axis] = found[axis];
    }
    return status;
}
