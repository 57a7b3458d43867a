/* A chain's arm in the plane that its column carries; internal to the room. */
#ifndef WH_MOTION_PLANE_INTERNAL_H
#define WH_MOTION_PLANE_INTERNAL_H

#include "../math/trig.h"
#include "chain.h"

/* The wrist in the plane: mm, and the blade's heading in rad. */
typedef struct {
    wh_real_t x, y, heading;
} wh_plane_t;

/* The parts of Rx(tilt_x) Ry(tilt_y). */
typedef struct {
    wh_real_t sin_x, cos_x, sin_y, cos_y;
} wh_tilt_t;

static inline wh_tilt_t wh_tilt_of(const wh_real_t q[WH_CHAIN_AXES]) {
    wh_tilt_t tilt;
    wh_sin_cos(q[WH_CHAIN_TILT_X], &tilt.sin_x, &tilt.cos_x);
    wh_sin_cos(q[WH_CHAIN_TILT_Y], &tilt.sin_y, &tilt.cos_y);
    return tilt;
}

static inline wh_mat3_t wh_tilt_matrix(const wh_tilt_t *t) {
    const wh_mat3_t R = {{{t->cos_y, 0, t->sin_y},
                          {t->sin_x * t->sin_y, t->cos_x, -(t->sin_x * t->cos_y)},
                          {-(t->cos_x * t->sin_y), t->sin_x, t->cos_x * t->cos_y}}};
    return R;
}

/* The step x, y in the tilted plane and z along the column whose sum is `step` in the robot's frame. */
static inline wh_vec3_t wh_tilt_solve(const wh_tilt_t *t, const wh_vec3_t *step) {
    const wh_real_t x = step->x / t->cos_y;
    const wh_real_t y = (step->y - x * (t->sin_x * t->sin_y)) / t->cos_x;
    return wh_vec3(x, y, step->z + x * (t->cos_x * t->sin_y) - y * t->sin_x);
}

/* The cosine of a SCARA's elbow whose wrist is at the distance R from the shoulder, as tan^2(elbow / 2) =
 * above / below. It is out of reach if one of them is negative. */
typedef struct {
    wh_real_t above, below;
} wh_bend_t;

static inline wh_bend_t wh_bend_for(const wh_real_t links[2], wh_real_t x, wh_real_t y) {
    const wh_real_t R = wh_real_sqrt(x * x + y * y);
    const wh_real_t sum = links[0] + links[1];
    const wh_real_t difference = wh_real_abs(links[0] - links[1]);
    const wh_bend_t bend = {(sum - R) * (sum + R), (R - difference) * (R + difference)};
    return bend;
}

/* The angle, 0 to pi. */
static inline wh_real_t wh_bend_angle(const wh_bend_t *bend) {
    return 2 * wh_atan2(wh_real_sqrt(bend->above), wh_real_sqrt(bend->below));
}

/* The angle from the first link to the line from shoulder to wrist, rad. */
static inline wh_real_t wh_bend_lead(const wh_real_t links[2], wh_real_t elbow) {
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(elbow, &s, &c);
    return wh_atan2(links[1] * s, links[0] + links[1] * c);
}

#endif
