#include "chain.h"

#include "plane_internal.h"
#include "turns_internal.h"

bool wh_chain_has(const wh_chain_t *chain, size_t axis) {
    switch (axis) {
    case WH_CHAIN_RAIL:
        return chain->has_rail;
    case WH_CHAIN_TILT_X:
    case WH_CHAIN_TILT_Y:
        return chain->has_tilt;
    case WH_CHAIN_YAW:
        return chain->kind != WH_CHAIN_TRZ;
    case WH_CHAIN_FLIP:
        return chain->has_flip;
    default:
        return true;
    }
}

static bool is_length(const wh_chain_t *chain, size_t axis) {
    return axis == WH_CHAIN_RAIL || axis == WH_CHAIN_Z ||
           (axis == WH_CHAIN_REACH && chain->kind != WH_CHAIN_SCARA);
}

static bool is_in_travel(const wh_chain_t *chain, size_t axis, wh_real_t position) {
    if (!wh_chain_has(chain, axis)) {
        return position == 0;
    }
    static const wh_real_t slacks[] = {WH_SLACK_MM, WH_SLACK_RAD};
    const wh_real_t slack = slacks[is_length(chain, axis) ? 0 : 1];
    return wh_travel_has(&chain->travel[axis], slack, position);
}

/* ------------------------------------------------------------------------------------------ is it sound? */

static wh_real_t widest_travel(const wh_chain_t *chain, size_t axis) {
    if (is_length(chain, axis)) {
        return (wh_real_t)FLT_MAX;
    }
    if (axis == WH_CHAIN_TILT_X || axis == WH_CHAIN_TILT_Y) {
        return WH_CHAIN_TILT_MAX;
    }
    return axis == WH_CHAIN_REACH ? WH_PI : WH_TRIG_MAX_RAD / 2;
}

static bool axis_is_sound(const wh_chain_t *chain, size_t axis) {
    if (wh_chain_has(chain, axis) &&
        (wh_limits_validate(&chain->limits[axis]) != WH_OK ||
         !wh_travel_is_sound(&chain->travel[axis], widest_travel(chain, axis)))) {
        return false;
    }
    return is_in_travel(chain, axis, chain->home[axis]);
}

static bool axes_are_sound(const wh_chain_t *chain) {
    bool sound = chain->kind == WH_CHAIN_SCARA || chain->travel[WH_CHAIN_REACH].min >= 0;
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        sound = sound && axis_is_sound(chain, axis);
    }
    return sound;
}

/* The comparisons also fail for NaN. */
static bool shape_is_sound(const wh_chain_t *chain) {
    if (!(wh_real_abs(chain->arm_heading) <= 2 * WH_PI) || !wh_real_is_finite(chain->height) ||
        !wh_real_is_finite(chain->flip_height)) {
        return false;
    }
    for (size_t i = 0; chain->kind == WH_CHAIN_SCARA && i < 2; ++i) {
        if (!(chain->links[i] > 0) || !wh_real_is_finite(chain->links[i])) {
            return false;
        }
    }
    return chain->kind == WH_CHAIN_TRZY || chain->kind == WH_CHAIN_TRZ || chain->kind == WH_CHAIN_SCARA;
}

wh_status_t wh_chain_validate(const wh_chain_t *chain) {
    if (chain == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!shape_is_sound(chain)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (!axes_are_sound(chain)) {
        return WH_STATUS_BAD_LIMITS;
    }
    return chain->is_placed ? wh_pose_validate(&chain->base_from_robot) : WH_OK;
}

wh_status_t wh_chain_check_travel(const wh_chain_t *chain, const wh_real_t q[WH_CHAIN_AXES]) {
    if (chain == NULL || q == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    bool others = true;
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        if (!wh_real_is_finite(q[axis])) {
            return WH_STATUS_NOT_FINITE;
        }
        others = others && (axis == WH_CHAIN_REACH || is_in_travel(chain, axis, q[axis]));
    }
    if (!is_in_travel(chain, WH_CHAIN_REACH, q[WH_CHAIN_REACH])) {
        return WH_STATUS_OUT_OF_REACH;
    }
    return others ? WH_OK : WH_STATUS_LIMIT_EXCEEDED;
}

/* ----------------------------------------------------------------------------------------------- forward */

static wh_plane_t plane_at(const wh_chain_t *chain, const wh_real_t q[WH_CHAIN_AXES]) {
    const bool is_scara = chain->kind == WH_CHAIN_SCARA;
    const wh_real_t last = q[WH_CHAIN_THETA] + (is_scara ? q[WH_CHAIN_REACH] : chain->arm_heading);
    const wh_real_t reach = is_scara ? chain->links[1] : q[WH_CHAIN_REACH];
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(last, &s, &c);
    wh_plane_t plane = {reach * c, reach * s, last + q[WH_CHAIN_YAW]};
    if (is_scara) {
        wh_sin_cos(q[WH_CHAIN_THETA], &s, &c);
        plane.x += chain->links[0] * c;
        plane.y += chain->links[0] * s;
    }
    return plane;
}

static void turn(wh_pose_t *pose, const wh_mat3_t *R) {
    pose->R = wh_mat3_multiply(R, &pose->R);
    pose->r = wh_mat3_transform(R, &pose->r);
}

/* Turns the blade by `flip` about its x at the flip's height. */
static void flip_blade(const wh_chain_t *chain, wh_real_t flip, wh_pose_t *pose) {
    const wh_vec3_t up = wh_vec3(0, 0, chain->flip_height);
    const wh_vec3_t before = wh_mat3_transform(&pose->R, &up);
    wh_chain_turn_over(&pose->R, flip);
    const wh_vec3_t after = wh_mat3_transform(&pose->R, &up);
    const wh_vec3_t shift = wh_vec3_subtract(&before, &after);
    pose->r = wh_vec3_add(&pose->r, &shift);
}

void wh_chain_forward(const wh_chain_t *chain, const wh_real_t q[WH_CHAIN_AXES],
                      wh_pose_t *base_from_effector) {
    const wh_plane_t plane = plane_at(chain, q);
    wh_pose_t pose = {wh_mat3_about_z(plane.heading), {plane.x, plane.y, chain->height}};
    if (chain->has_tilt) {
        const wh_tilt_t tilt = wh_tilt_of(q);
        const wh_mat3_t R = wh_tilt_matrix(&tilt);
        turn(&pose, &R);
    }
    pose.r.x += q[WH_CHAIN_RAIL];
    pose.r.z += q[WH_CHAIN_Z];
    if (chain->has_flip) {
        flip_blade(chain, q[WH_CHAIN_FLIP], &pose);
    }
    if (chain->is_placed) {
        wh_pose_compose_to(&chain->base_from_robot, &pose, base_from_effector);
    } else {
        *base_from_effector = pose;
    }
}

/* ----------------------------------------------------------------------------------------------- inverse */

static bool input_is_finite(const wh_pose_t *pose, const wh_chain_choice_t *choice,
                            const wh_real_t near_q[WH_CHAIN_AXES]) {
    bool finite = wh_vec3_is_finite(&pose->r) && wh_real_is_finite(choice->rail + choice->flip);
    for (size_t i = 0; i < 9; ++i) {
        finite = finite && wh_real_is_finite(pose->R.m[i / 3][i % 3]);
    }
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        finite = finite && wh_real_is_finite(near_q[axis]);
    }
    return finite;
}

static wh_status_t check_input(const wh_pose_t *pose, const wh_chain_choice_t *choice,
                               const wh_real_t near_q[WH_CHAIN_AXES]) {
    if (!input_is_finite(pose, choice, near_q)) {
        return WH_STATUS_NOT_FINITE;
    }
    const bool in_range = wh_real_abs(near_q[WH_CHAIN_THETA]) <= WH_TRIG_MAX_RAD &&
                          wh_real_abs(near_q[WH_CHAIN_YAW]) <= WH_TRIG_MAX_RAD &&
                          wh_real_abs(choice->flip) <= WH_TRIG_MAX_RAD;
    const bool is_elbow =
        choice->elbow == WH_ELBOW_NEAR || choice->elbow == WH_ELBOW_LEFT || choice->elbow == WH_ELBOW_RIGHT;
    return in_range && is_elbow ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

/* The wrist's pose in the robot's frame, at rail 0. */
static wh_pose_t wrist_of(const wh_chain_t *chain, const wh_pose_t *base_from_effector,
                          const wh_chain_choice_t *choice) {
    wh_pose_t wrist = *base_from_effector;
    if (chain->is_placed) {
        wh_pose_relative_to(&chain->base_from_robot, base_from_effector, &wrist);
    }
    if (chain->has_flip) {
        flip_blade(chain, -choice->flip, &wrist);
    }
    wrist.r.x -= choice->rail;
    return wrist;
}

/* Sets tilts and Z and returns the wrist's place in the plane; false if the wrist is not level. */
static bool find_plane(const wh_chain_t *chain, const wh_pose_t *wrist, wh_real_t q[WH_CHAIN_AXES],
                       wh_plane_t *plane) {
    const wh_vec3_t normal = wh_mat3_column(&wrist->R, 2);
    const wh_real_t leaning = wh_real_sqrt(normal.x * normal.x + normal.y * normal.y);
    if (!(normal.z > 0) || (!chain->has_tilt && leaning > WH_SLACK_RAD)) {
        return false;
    }
    if (!chain->has_tilt) {
        plane->x = wrist->r.x;
        plane->y = wrist->r.y;
        plane->heading = wh_atan2(wrist->R.m[1][0], wrist->R.m[0][0]);
        q[WH_CHAIN_Z] = wrist->r.z - chain->height;
        return true;
    }
    q[WH_CHAIN_TILT_X] = wh_atan2(-normal.y, normal.z);
    q[WH_CHAIN_TILT_Y] = wh_atan2(normal.x, wh_real_sqrt(normal.y * normal.y + normal.z * normal.z));
    const wh_tilt_t tilt = wh_tilt_of(q);
    const wh_mat3_t T = wh_tilt_matrix(&tilt);
    const wh_vec3_t height = wh_vec3(0, 0, chain->height);
    const wh_vec3_t raised = wh_mat3_transform(&T, &height);
    const wh_vec3_t point = wh_vec3_subtract(&wrist->r, &raised);
    const wh_vec3_t solved = wh_tilt_solve(&tilt, &point);
    const wh_mat3_t flat = wh_mat3_multiply_back(&T, &wrist->R);
    plane->x = solved.x;
    plane->y = solved.y;
    plane->heading = wh_atan2(flat.m[1][0], flat.m[0][0]);
    q[WH_CHAIN_Z] = solved.z;
    return true;
}

static wh_status_t find_polar(const wh_chain_t *chain, const wh_plane_t *plane,
                              const wh_real_t near_q[WH_CHAIN_AXES], wh_real_t q[WH_CHAIN_AXES]) {
    const wh_real_t R = wh_real_sqrt(plane->x * plane->x + plane->y * plane->y);
    if (!(R > 0)) {
        return WH_STATUS_OUT_OF_REACH;
    }
    const wh_real_t there = wh_atan2(plane->y, plane->x) - chain->arm_heading;
    q[WH_CHAIN_REACH] = R;
    q[WH_CHAIN_THETA] = wh_turns_nearest(&chain->travel[WH_CHAIN_THETA], there, near_q[WH_CHAIN_THETA]);
    const wh_real_t yaw = wh_turns_between(q[WH_CHAIN_THETA] + chain->arm_heading, plane->heading);
    if (chain->kind == WH_CHAIN_TRZ) {
        return wh_real_abs(yaw) <= WH_SLACK_RAD ? WH_OK : WH_STATUS_NOT_ALONG_ARM;
    }
    q[WH_CHAIN_YAW] = yaw;
    return WH_OK;
}

static bool elbow_is_left(wh_elbow_t elbow, wh_real_t now) {
    return elbow == WH_ELBOW_LEFT || (elbow == WH_ELBOW_NEAR && now <= 0);
}

static wh_status_t find_scara(const wh_chain_t *chain, const wh_plane_t *plane, wh_elbow_t elbow,
                              const wh_real_t near_q[WH_CHAIN_AXES], wh_real_t q[WH_CHAIN_AXES]) {
    const wh_bend_t bend = wh_bend_for(chain->links, plane->x, plane->y);
    if (!(bend.above >= 0) || !(bend.below >= 0) || (plane->x == 0 && plane->y == 0)) {
        return WH_STATUS_OUT_OF_REACH;
    }
    const wh_real_t size = wh_bend_angle(&bend);
    q[WH_CHAIN_REACH] = elbow_is_left(elbow, near_q[WH_CHAIN_REACH]) ? -size : size;
    const wh_real_t there = wh_atan2(plane->y, plane->x) - wh_bend_lead(chain->links, q[WH_CHAIN_REACH]);
    q[WH_CHAIN_THETA] = wh_turns_nearest(&chain->travel[WH_CHAIN_THETA], there, near_q[WH_CHAIN_THETA]);
    const wh_real_t yaw = plane->heading - (q[WH_CHAIN_THETA] + q[WH_CHAIN_REACH]);
    q[WH_CHAIN_YAW] = wh_turns_nearest(&chain->travel[WH_CHAIN_YAW], yaw, near_q[WH_CHAIN_YAW]);
    return WH_OK;
}

static wh_status_t find(const wh_chain_t *chain, const wh_pose_t *base_from_effector,
                        const wh_chain_choice_t *choice, const wh_real_t near_q[WH_CHAIN_AXES],
                        wh_real_t q[WH_CHAIN_AXES]) {
    const wh_pose_t wrist = wrist_of(chain, base_from_effector, choice);
    wh_plane_t plane;
    if (!find_plane(chain, &wrist, q, &plane)) {
        return WH_STATUS_NOT_LEVEL;
    }
    const wh_status_t status = chain->kind == WH_CHAIN_SCARA
                                   ? find_scara(chain, &plane, choice->elbow, near_q, q)
                                   : find_polar(chain, &plane, near_q, q);
    return status == WH_OK ? wh_chain_check_travel(chain, q) : status;
}

wh_status_t wh_chain_inverse(const wh_chain_t *chain, const wh_pose_t *base_from_effector,
                             const wh_chain_choice_t *choice, const wh_real_t near_q[WH_CHAIN_AXES],
                             wh_real_t q[WH_CHAIN_AXES]) {
    if (chain == NULL || base_from_effector == NULL || choice == NULL || near_q == NULL || q == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = check_input(base_from_effector, choice, near_q);
    if (status != WH_OK) {
        return status;
    }
    wh_real_t found[WH_CHAIN_AXES] = {0};
    found[WH_CHAIN_RAIL] = choice->rail;
    found[WH_CHAIN_FLIP] = choice->flip;
    status = find(chain, base_from_effector, choice, near_q, found);
    for (size_t axis = 0; status == WH_OK && axis < WH_CHAIN_AXES; ++axis) {
        q[axis] = found[axis];
    }
    return status;
}
