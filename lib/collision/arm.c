#include "arm.h"

#include "../math/trig.h"

/* It ends at the first number that differs: most bodies that are asked for move. */
bool wh_arm_is_at(const wh_pose_t *body, const wh_pose_t *base_from_body) {
    const wh_vec3_t *a = &body->r, *b = &base_from_body->r;
    bool same = a->x == b->x && a->y == b->y && a->z == b->z;
    for (size_t i = 0; same && i < 9; ++i) {
        same = body->R.m[i / 3][i % 3] == base_from_body->R.m[i / 3][i % 3];
    }
    return same;
}

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

/* The elbow: half-way to the wrist, and sideways so that the links have their length. */
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

/* ---------------------------------------------------------------------------------------- of any kind */

/* A body that does not turn against another one, at a point of that one. */
static void shift(const wh_pose_t *base_from_body, wh_real_t x, wh_real_t z, wh_pose_t *shifted) {
    const wh_vec3_t point = wh_vec3(x, 0, z);
    shifted->R = base_from_body->R;
    shifted->r = wh_pose_point(base_from_body, &point);
}

/* The column's foot and its lift, in base. */
static void place_column(const wh_chain_t *chain, const wh_real_t q[], wh_pose_t bodies[]) {
    const wh_pose_t origin = wh_pose_identity();
    shift(chain->is_placed ? &chain->base_from_robot : &origin, q[WH_CHAIN_RAIL], 0, &bodies[WH_ARM_BASE]);
    shift(&bodies[WH_ARM_BASE], 0, q[WH_CHAIN_Z], &bodies[WH_ARM_LIFT]);
}

/* Turns the plane of the links by Rx(tilt_x) Ry(tilt_y). */
static void tilt(const wh_real_t q[], wh_pose_t *plane) {
    if (wh_real_abs(q[WH_CHAIN_TILT_X]) + wh_real_abs(q[WH_CHAIN_TILT_Y]) <= 0) {
        return;
    }
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(q[WH_CHAIN_TILT_X], &s, &c);
    const wh_mat3_t about_x = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    wh_sin_cos(q[WH_CHAIN_TILT_Y], &s, &c);
    const wh_mat3_t about_y = {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
    const wh_mat3_t both = wh_mat3_multiply(&about_x, &about_y);
    plane->R = wh_mat3_multiply(&plane->R, &both);
}

/* The links in the plane that the column carries, with the hand given in it. */
static void place_scara(const wh_chain_t *chain, const wh_real_t q[], const wh_pose_t *hand,
                        wh_pose_t links[]) {
    wh_vec3_t at = wh_vec3(0, 0, hand->r.z);
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(q[WH_CHAIN_THETA], &s, &c);
    links[WH_ARM_UPPER] = level_at(&at, c, s);
    at.x = chain->links[0] * c;
    at.y = chain->links[0] * s;
    wh_sin_cos(q[WH_CHAIN_THETA] + q[WH_CHAIN_REACH], &s, &c);
    links[WH_ARM_FOREARM] = level_at(&at, c, s);
    links[WH_ARM_HAND] = *hand;
}

void wh_arm_place_carrier(const wh_arm_t *arm, const wh_carrier_t *carrier, const wh_real_t axes[],
                          const wh_pose_t *known, wh_pose_t bodies[]) {
    const wh_chain_t *chain = &carrier->chain;
    wh_real_t q[WH_CHAIN_AXES] = {0};
    wh_pose_t effector;
    wh_pose_t links[WH_ARM_BODIES];
    for (size_t i = 0; i < carrier->axis_count; ++i) {
        if (carrier->axes[i] != WH_CARRIER_OTHERS) {
            q[carrier->axes[i]] = axes[i];
        }
    }
    q[WH_CHAIN_FLIP] = 0;
    if (known && !chain->has_flip) {
        effector = *known;
    } else {
        wh_chain_forward(chain, q, &effector);
    }
    place_column(chain, q, bodies);
    wh_pose_t plane = bodies[WH_ARM_LIFT];
    tilt(q, &plane);
    const wh_pose_t hand = wh_pose_relative(&plane, &effector);
    if (chain->kind == WH_CHAIN_SCARA) {
        place_scara(chain, q, &hand, links);
    } else {
        wh_arm_place(arm, &hand, links);
    }
    if (wh_real_abs(chain->height) > 0) { /* only the hand is higher */
        links[WH_ARM_UPPER].r.z -= chain->height;
        links[WH_ARM_FOREARM].r.z -= chain->height;
    }
    for (size_t i = WH_ARM_UPPER; i < WH_ARM_BODIES; ++i) {
        wh_pose_compose_to(&plane, &links[i], &bodies[i]);
    }
}
