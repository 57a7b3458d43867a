#include "line.h"

#include <string.h>

#include "../math/trig.h"
#include "line_internal.h"

/* The horizontal line, seen from base's axis: its distance, and the least and the greatest distance on it
 * from the closest point. */
typedef struct {
    wh_real_t distance, nearest, farthest;
} passage_t;

/* Bounds of |dq/dc|, |d2q/dc2|, |d3q/dc3| of an axis over the line. */
typedef struct {
    wh_real_t first, second, third;
} bounds_t;

/* The axes after a step: mm outward, to the left and up, as the arm sees them at the start. */
static void axes_after(const wh_real_t from[WH_ROBOT_AXES], const wh_vec3_t *step,
                       wh_real_t q[WH_ROBOT_AXES]) {
    const wh_real_t outward = from[WH_AXIS_R] + step->x;
    /* Straight outward or up the arc tangent is that of a zero, and keeps its sign. */
    const bool straight = step->y == 0 && outward > 0;
    const wh_real_t turned = straight ? step->y : wh_atan2(step->y, outward);
    q[WH_AXIS_THETA] = from[WH_AXIS_THETA] + turned;
    q[WH_AXIS_R] = wh_real_sqrt(outward * outward + step->y * step->y);
    q[WH_AXIS_Z] = from[WH_AXIS_Z] + step->z;
    q[WH_AXIS_YAW] = from[WH_AXIS_YAW] - turned;
}

static wh_real_t clamp(wh_real_t x, const passage_t *passage) {
    if (x < passage->nearest) {
        return passage->nearest;
    }
    return x > passage->farthest ? passage->farthest : x;
}

/* R at the distance c from the closest point. */
static wh_real_t radius(const passage_t *passage, wh_real_t c) {
    return wh_real_sqrt(passage->distance * passage->distance + c * c);
}

/* `share` is the horizontal part of the direction. If it is 0, the line is a point when seen from above. */
static passage_t passage_of(const wh_line_t *line, wh_real_t share, wh_real_t length) {
    const wh_real_t R = line->from[WH_AXIS_R];
    passage_t passage = {0, R, R};
    if (share > 0) {
        const wh_real_t begin = R * (line->direction.x / share);
        const wh_real_t end = begin + share * length;
        const wh_real_t a = wh_real_abs(begin);
        const wh_real_t b = wh_real_abs(end);
        passage.distance = R * wh_real_abs(line->direction.y / share);
        passage.nearest = begin < 0 && end > 0 ? 0 : (a < b ? a : b);
        passage.farthest = a < b ? b : a;
    }
    return passage;
}

/* dR/dc = c/R grows with |c|; d2R/dc2 = d^2/R^3 falls; |d3R/dc3| = 3 d^2 |c|/R^5 is greatest at |c| = d/2. */
static bounds_t bounds_of_R(const passage_t *passage) {
    const wh_real_t d = passage->distance;
    const wh_real_t c = clamp(d / 2, passage);
    const wh_real_t R = radius(passage, c);
    const wh_real_t least = radius(passage, passage->nearest);
    const bounds_t bounds = {passage->farthest / radius(passage, passage->farthest),
                             d / least * (d / least) / least, 3 * (d / R) * (d / R) * (c / R) / (R * R)};
    return bounds;
}

/* |d3(theta)/dc3| = 2 d |3 c^2 - d^2| / R^6. */
static wh_real_t third_of_theta(const passage_t *passage, wh_real_t c) {
    const wh_real_t R = radius(passage, c);
    const wh_real_t cosine = c / R;
    const wh_real_t sine = passage->distance / R;
    return 2 * sine * wh_real_abs(3 * cosine * cosine - sine * sine) / (R * R * R);
}

/* d(theta)/dc = d/R^2 falls with |c|; |d2/dc2| = 2 d |c|/R^4 is greatest at |c| = d/sqrt(3); |d3/dc3| is
 * greatest where |c| is least or equal to d. */
static bounds_t bounds_of_theta(const passage_t *passage) {
    const wh_real_t d = passage->distance;
    const wh_real_t least = radius(passage, passage->nearest);
    const wh_real_t c = clamp(d * WH_REAL(0.57735026918962576451), passage);
    const wh_real_t R = radius(passage, c);
    const wh_real_t near_third = third_of_theta(passage, passage->nearest);
    const wh_real_t far_third = third_of_theta(passage, clamp(d, passage));
    const bounds_t bounds = {d / least / least, 2 * (d / R) * (c / R) / (R * R),
                             near_third > far_third ? near_third : far_third};
    return bounds;
}

/* The factor in time by which an axis with these bounds must be slowed if the effector moves horizontally
 * with up to `peak`: dq/dt = q' v, d2q/dt2 = q'' v^2 + q' a, d3q/dt3 = q''' v^3 + 3 q'' v a + q' j. */
static wh_real_t slowing(const bounds_t *q, const wh_limits_t *peak, const wh_limits_t *limits) {
    const wh_real_t v = peak->speed;
    const wh_real_t a = peak->acceleration;
    const wh_real_t speed = q->first * v;
    const wh_real_t acceleration = q->second * v * v + q->first * a;
    const wh_real_t jerk = q->third * v * v * v + 3 * q->second * v * a + q->first * peak->jerk;
    return wh_real_max(speed / limits->speed, wh_real_max(wh_real_sqrt(acceleration / limits->acceleration),
                                                          wh_cbrt(jerk / limits->jerk)));
}

static wh_real_t slowing_of_line(const wh_line_t *line, const passage_t *passage, wh_real_t share,
                                 const wh_robot_t *robot) {
    const wh_limits_t peak = {share * wh_profile_peak_speed(&line->path),
                              share * wh_profile_peak_acceleration(&line->path),
                              share * wh_profile_peak_jerk(&line->path)};
    const bounds_t R = bounds_of_R(passage);
    const bounds_t theta = bounds_of_theta(passage);
    const wh_real_t arm = wh_real_max(slowing(&R, &peak, &robot->limits[WH_AXIS_R]),
                                      slowing(&theta, &peak, &robot->limits[WH_AXIS_THETA]));
    return wh_real_max(arm, slowing(&theta, &peak, &robot->limits[WH_AXIS_YAW]));
}

/* The limit of a quantity along the line: R's for its horizontal share or Z's for its vertical one,
 * whichever is lower. */
static wh_real_t binding(wh_real_t R_limit, wh_real_t horizontal, wh_real_t Z_limit, wh_real_t vertical) {
    return R_limit * vertical <= Z_limit * horizontal ? R_limit / horizontal : Z_limit / vertical;
}

static wh_limits_t path_limits(const wh_robot_t *robot, wh_real_t share, wh_real_t up,
                               const wh_line_caps_t *caps) {
    const wh_limits_t *R = &robot->limits[WH_AXIS_R];
    const wh_limits_t *Z = &robot->limits[WH_AXIS_Z];
    const wh_real_t rise = wh_real_abs(up);
    wh_limits_t limits = {binding(R->speed, share, Z->speed, rise),
                          binding(R->acceleration, share, Z->acceleration, rise),
                          binding(R->jerk, share, Z->jerk, rise)};
    if (caps->speed > 0 && caps->speed < limits.speed) {
        limits.speed = caps->speed;
    }
    if (caps->acceleration > 0 && caps->acceleration < limits.acceleration) {
        limits.acceleration = caps->acceleration;
    }
    return limits;
}

static wh_status_t check_arguments(const wh_line_t *line, const wh_robot_t *robot, const wh_real_t from_q[],
                                   const wh_vec3_t *step, const wh_line_caps_t *caps) {
    if (line == NULL || robot == NULL || from_q == NULL || step == NULL || caps == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!wh_real_is_finite(wh_vec3_dot(step, step))) {
        return WH_STATUS_NOT_FINITE;
    }
    const wh_status_t status = wh_line_check_caps(caps);
    return status == WH_OK ? wh_robot_check_travel(robot, from_q) : status;
}

/* The step in base as the arm sees it at the start. */
static wh_vec3_t seen_from_arm(wh_real_t theta, const wh_vec3_t *step) {
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(theta, &s, &c);
    return wh_vec3(step->x * c + step->y * s, step->y * c - step->x * s, step->z);
}

/* Checks travel at the end and at the closest point. Theta, Z and yaw move in one direction, and R is
 * greatest at an end. */
static wh_status_t check_travel(const wh_line_t *line, const wh_robot_t *robot, const passage_t *passage) {
    const wh_real_t least = radius(passage, passage->nearest);
    if (!(least > 0) || least < robot->travel[WH_AXIS_R].min - WH_SLACK_MM) {
        return WH_STATUS_OUT_OF_REACH;
    }
    return wh_robot_check_travel(robot, line->to);
}

wh_status_t wh_line_plan(wh_line_t *line, const wh_robot_t *robot, const wh_real_t from_q[WH_ROBOT_AXES],
                         wh_real_t dx, wh_real_t dy, wh_real_t dz, wh_real_t speed_cap) {
    const wh_vec3_t travel = wh_vec3(dx, dy, dz);
    const wh_line_caps_t caps = {speed_cap, 0};
    return wh_line_plan_capped(line, robot, from_q, &travel, &caps);
}

wh_status_t wh_line_plan_capped(wh_line_t *line, const wh_robot_t *robot,
                                const wh_real_t from_q[WH_ROBOT_AXES], const wh_vec3_t *travel,
                                const wh_line_caps_t *caps) {
    wh_status_t status = check_arguments(line, robot, from_q, travel, caps);
    if (status != WH_OK) {
        return status;
    }
    wh_line_t planned;
    const wh_vec3_t seen = seen_from_arm(from_q[WH_AXIS_THETA], travel);
    const wh_real_t length = wh_vec3_norm(travel);
    /* A line without length is planned as one outward, of length 0. */
    const bool moves = length > 0;
    planned.direction = moves ? wh_vec3(seen.x / length, seen.y / length, seen.z / length) : wh_vec3(1, 0, 0);
    const wh_real_t share =
        moves ? wh_real_sqrt(travel->x * travel->x + travel->y * travel->y) / length : WH_REAL(1);
    memcpy(planned.from, from_q, sizeof planned.from);
    axes_after(from_q, &seen, planned.to);
    const passage_t passage = passage_of(&planned, share, length);
    status = check_travel(&planned, robot, &passage);
    if (status != WH_OK) {
        return status;
    }
    const wh_limits_t limits = path_limits(robot, share, planned.direction.z, caps);
    status = wh_profile_plan(&planned.path, length, &limits);
    if (status == WH_OK) {
        status = wh_line_slow_down(&planned, slowing_of_line(&planned, &passage, share, robot));
    }
    if (status == WH_OK) {
        *line = planned;
    }
    return status;
}

void wh_line_at(const wh_line_t *line, wh_real_t t, wh_real_t q[WH_ROBOT_AXES]) {
    if (t >= wh_line_duration(line)) {
        memcpy(q, line->to, sizeof line->to);
    } else if (!(t > 0)) {
        memcpy(q, line->from, sizeof line->from);
    } else {
        const wh_vec3_t step = wh_vec3_scale(wh_profile_position(&line->path, t), &line->direction);
        axes_after(line->from, &step, q);
    }
}
