#include "chain_line.h"

#include <string.h>

#include "elbow_line_internal.h"
#include "line_internal.h"
#include "plane_internal.h"

static const size_t plane_axes[WH_ROBOT_AXES] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};

static wh_status_t check_arguments(const wh_chain_line_t *line, const wh_chain_t *chain,
                                   const wh_real_t from_q[], const wh_vec3_t *travel,
                                   const wh_line_caps_t *caps) {
    if (line == NULL || chain == NULL || from_q == NULL || travel == NULL || caps == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!wh_real_is_finite(wh_vec3_dot(travel, travel))) {
        return WH_STATUS_NOT_FINITE;
    }
    const wh_status_t status = wh_line_check_caps(caps);
    return status == WH_OK ? wh_chain_check_travel(chain, from_q) : status;
}

/* The travel as a step within the column's plane, and along the column. */
static wh_vec3_t step_in_plane(const wh_chain_t *chain, const wh_real_t q[WH_CHAIN_AXES],
                               const wh_vec3_t *travel) {
    wh_vec3_t step = *travel;
    if (chain->is_placed) {
        step = wh_mat3_transform_back(&chain->base_from_robot.R, travel);
    }
    if (chain->has_tilt) {
        const wh_tilt_t tilt = wh_tilt_of(q);
        step = wh_tilt_solve(&tilt, &step);
    }
    return step;
}

/* Converts caps along the line in base to caps along the step, which a tilt makes longer or shorter. */
static wh_line_caps_t caps_of_step(const wh_line_caps_t *caps, const wh_vec3_t *travel, const wh_vec3_t *step,
                                   bool has_tilt) {
    wh_line_caps_t own = *caps;
    const wh_real_t length = wh_vec3_norm(travel);
    if (has_tilt && length > 0) {
        const wh_real_t ratio = wh_vec3_norm(step) / length;
        own.speed = caps->speed * ratio;
        own.acceleration = caps->acceleration * ratio;
    }
    return own;
}

/* The arm as a robot of motion/robot.h whose x points along `ahead`, theta's value there. */
static wh_robot_t robot_of(const wh_chain_t *chain, wh_real_t ahead) {
    wh_robot_t robot;
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        robot.travel[i] = chain->travel[plane_axes[i]];
        robot.limits[i] = chain->limits[plane_axes[i]];
        robot.home[i] = chain->home[plane_axes[i]];
    }
    robot.travel[WH_AXIS_THETA].min -= ahead;
    robot.travel[WH_AXIS_THETA].max -= ahead;
    if (chain->kind == WH_CHAIN_TRZ) {
        const wh_travel_t any = {-WH_PI, WH_PI};
        robot.travel[WH_AXIS_YAW] = any;
        robot.limits[WH_AXIS_YAW] = robot.limits[WH_AXIS_THETA];
    }
    return robot;
}

/* TRZ: the step is along the arm, and theta stays constant to the last bit. */
static wh_status_t plan_along_arm(wh_line_t *path, const wh_chain_t *chain, const wh_real_t from_q[],
                                  const wh_vec3_t *step, const wh_line_caps_t *caps) {
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(from_q[WH_CHAIN_THETA] + chain->arm_heading, &s, &c);
    if (wh_real_abs(step->y * c - step->x * s) > WH_SLACK_MM) {
        return WH_STATUS_NOT_ALONG_ARM;
    }
    const wh_robot_t robot = robot_of(chain, from_q[WH_CHAIN_THETA]);
    const wh_real_t from[WH_ROBOT_AXES] = {0, from_q[WH_CHAIN_REACH], from_q[WH_CHAIN_Z], 0};
    const wh_vec3_t along = wh_vec3(step->x * c + step->y * s, 0, step->z);
    const wh_status_t status = wh_line_plan_capped(path, &robot, from, &along, caps);
    if (status == WH_OK) {
        path->from[WH_AXIS_THETA] = from_q[WH_CHAIN_THETA];
        path->to[WH_AXIS_THETA] = from_q[WH_CHAIN_THETA];
        path->direction.y = 0;
    }
    return status;
}

/* TRZY: theta of the arm, which its heading is ahead of. */
static wh_status_t plan_with_wrist(wh_line_t *path, const wh_chain_t *chain, const wh_real_t from_q[],
                                   const wh_vec3_t *step, const wh_line_caps_t *caps) {
    const wh_robot_t robot = robot_of(chain, 0);
    wh_real_t from[WH_ROBOT_AXES];
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        from[i] = from_q[plane_axes[i]];
    }
    wh_vec3_t seen = *step;
    if (chain->arm_heading != 0) {
        const wh_mat3_t ahead = wh_mat3_about_z(chain->arm_heading);
        seen = wh_mat3_transform_back(&ahead, step);
    }
    return wh_line_plan_capped(path, &robot, from, &seen, caps);
}

static void write_axes(const wh_real_t polar[WH_ROBOT_AXES], wh_real_t q[WH_CHAIN_AXES]) {
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        q[plane_axes[i]] = polar[i];
    }
}

wh_status_t wh_chain_line_plan(wh_chain_line_t *line, const wh_chain_t *chain,
                               const wh_real_t from_q[WH_CHAIN_AXES], const wh_vec3_t *travel,
                               const wh_line_caps_t *caps) {
    wh_status_t status = check_arguments(line, chain, from_q, travel, caps);
    if (status != WH_OK) {
        return status;
    }
    wh_chain_line_t planned;
    memset(&planned, 0, sizeof planned);
    planned.kind = chain->kind;
    memcpy(planned.from, from_q, sizeof planned.from);
    memcpy(planned.to, from_q, sizeof planned.to);
    const wh_vec3_t step = step_in_plane(chain, from_q, travel);
    const wh_line_caps_t own = caps_of_step(caps, travel, &step, chain->has_tilt);
    if (chain->kind == WH_CHAIN_SCARA) {
        status = wh_elbow_line_plan(&planned, chain, &step, &own);
    } else {
        status = chain->kind == WH_CHAIN_TRZ ? plan_along_arm(&planned.path, chain, from_q, &step, &own)
                                             : plan_with_wrist(&planned.path, chain, from_q, &step, &own);
        if (status == WH_OK) {
            write_axes(planned.path.to, planned.to);
        }
    }
    if (status == WH_OK) {
        *line = planned;
    }
    return status;
}

void wh_chain_line_at(const wh_chain_line_t *line, wh_real_t t, wh_real_t q[WH_CHAIN_AXES]) {
    if (t >= wh_chain_line_duration(line)) {
        memcpy(q, line->to, sizeof line->to);
        return;
    }
    memcpy(q, line->from, sizeof line->from);
    if (!(t > 0)) {
        return;
    }
    if (line->kind == WH_CHAIN_SCARA) {
        wh_elbow_line_axes(line, wh_profile_position(&line->path.path, t), q);
    } else {
        wh_real_t polar[WH_ROBOT_AXES];
        wh_line_at(&line->path, t, polar);
        write_axes(polar, q);
    }
}
