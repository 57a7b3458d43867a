#include "relation.h"

#include "trig.h"

/* It uses sine and cosine, because a cosine alone is inaccurate for small angles. */
static wh_real_t angle_between(const wh_vec3_t *a, const wh_vec3_t *b) {
    const wh_vec3_t normal = wh_vec3_cross(a, b);
    return wh_atan2(wh_vec3_norm(&normal), wh_vec3_dot(a, b));
}

/* For a rotation by t, the skew part is sin t times the axis, and the trace is 1 + 2 cos t. */
static wh_real_t angle_of(const wh_mat3_t *R) {
    const wh_vec3_t axis = wh_vec3(R->m[2][1] - R->m[1][2], R->m[0][2] - R->m[2][0], R->m[1][0] - R->m[0][1]);
    return wh_atan2(wh_vec3_norm(&axis), R->m[0][0] + R->m[1][1] + R->m[2][2] - 1);
}

wh_relation_t wh_relate(const wh_pose_t *first, const wh_pose_t *second) {
    const wh_pose_t first_from_second = wh_pose_relative(first, second);
    const wh_vec3_t apart = wh_vec3_subtract(&second->r, &first->r);
    const wh_vec3_t normal = wh_mat3_column(&first->R, 2);
    const wh_vec3_t other = wh_mat3_column(&second->R, 2);
    wh_relation_t relation;
    relation.distance = wh_vec3_norm(&apart);
    relation.r = first_from_second.r;
    relation.angle = angle_between(&normal, &other);
    relation.turn = angle_of(&first_from_second.R);
    return relation;
}
