#include "arm.h"

static wh_vec3_t wrist_of(const wh_arm_t *arm, const wh_pose_t *base_from_effector) {
    const wh_vec3_t x = wh_mat3_column(&base_from_effector->R, 0);
    const wh_vec3_t back = wh_vec3_scale(arm->reach, &x);
    return wh_vec3_subtract(&base_from_effector->r, &back);
}

bool wh_arm_reaches(const wh_arm_t *arm, const wh_pose_t *base_from_effector) {
    const wh_vec3_t wrist = wrist_of(arm, base_from_effector);
    return wrist.x * wrist.x + wrist.y * wrist.y <= 4 * arm->link * arm->link;
}

/* A level body at a point, its x along (x, y), which has length 1. */
static wh_pose_t level_at(const wh_vec3_t *r, wh_real_t x, wh_real_t y) {
    const wh_pose_t pose = {{{{x, -y, 0}, {y, x, 0}, {0, 0, 1}}}, *r};
    return pose;
}

/* A level body at `from` with its x towards `to`, or along `fallback` if the two points are one. */
static wh_pose_t level_towards(const wh_vec3_t *from, const wh_vec3_t *to, const wh_pose_t *fallback) {
    const wh_real_t dx = to->x - from->x;
    const wh_real_t dy = to->y - from->y;
    const wh_real_t length = wh_real_sqrt(dx * dx + dy * dy);
    if (!(length > WH_REAL(1e-9))) {
        return level_at(from, fallback->R.m[0][0], fallback->R.m[1][0]);
    }
    return level_at(from, dx / length, dy / length);
}

/* The elbow: half-way to the wrist, and aside by what is missing to the link's length. */
static wh_vec3_t elbow_of(const wh_arm_t *arm, const wh_pose_t *base_from_shoulder, wh_real_t distance) {
    const wh_real_t half = distance / 2;
    const wh_real_t rest = arm->link * arm->link - half * half;
    const wh_real_t aside = rest > 0 ? wh_real_sqrt(rest) : 0;
    const wh_vec3_t elbow = {half < arm->link ? half : arm->link, arm->right_handed ? -aside : aside, 0};
    return wh_pose_point(base_from_shoulder, &elbow);
}

void wh_arm_place(const wh_arm_t *arm, const wh_pose_t *base_from_effector, wh_pose_t bodies[]) {
    const wh_vec3_t wrist = wrist_of(arm, base_from_effector);
    const wh_vec3_t shoulder = {0, 0, base_from_effector->r.z};
    const wh_pose_t out = level_towards(&shoulder, &wrist, base_from_effector);
    const wh_vec3_t elbow = elbow_of(arm, &out, wh_real_sqrt(wrist.x * wrist.x + wrist.y * wrist.y));
    bodies[WH_ARM_BASE] = wh_pose_identity();
    bodies[WH_ARM_LIFT] = level_at(&shoulder, 1, 0);
    bodies[WH_ARM_UPPER] = level_towards(&shoulder, &elbow, &out);
    bodies[WH_ARM_FOREARM] = level_towards(&elbow, &wrist, &out);
    bodies[WH_ARM_HAND] = *base_from_effector;
    bodies[WH_ARM_HAND].r = wrist;
}
