#include "touch.h"

#include "check_internal.h"

/* The distance of a ball that is not over the face, mm. */
#define ASIDE 1e9
/* A switch keeps its state up to this distance beyond its change, because the place of a change is
 * rounded. */
#define PLAY 1e-9

wh_status_t wh_touch_validate(const wh_touch_face_t *touch) {
    if (touch == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    double square = 0;
    double edge = 0;
    double across = 0;
    for (size_t i = 0; i < 3; ++i) {
        square += touch->normal[i] * touch->normal[i];
        edge += touch->edge[i] * touch->edge[i];
        across += touch->normal[i] * touch->edge[i];
    }
    wh_field_check_t found = wh_field_check_begin();
    wh_field_check(&found, "normal", WH_NONE, square, 1 - 2e-5, 1 + 2e-5);
    wh_field_check(&found, "edge", WH_NONE, edge, 1 - 2e-5, 1 + 2e-5);
    wh_field_check(&found, "edge", WH_NONE, across, -1e-5, 1e-5);
    wh_field_check(&found, "along", WH_NONE, touch->along, 0.1, 1e3);
    wh_field_check(&found, "aside", WH_NONE, touch->aside, 0.1, 1e3);
    for (int32_t i = 0; i < 3; ++i) {
        wh_field_check(&found, "middle", i, touch->middle[i], -1e5, 1e5);
        wh_field_check(&found, "ball", i, touch->ball[i], -1e3, 1e3);
    }
    wh_field_check(&found, "radius", WH_NONE, touch->radius, 0, 50);
    return found.status;
}

/* A ball against a face: its distance outside of it less its radius, and its distances from the middle
 * along both edges. */
typedef struct {
    double gap, along, aside;
} ball_t;

static ball_t hold_against(const wh_touch_face_t *touch, const wh_pose_t *pose) {
    const double place[3] = {(double)pose->r.x - touch->middle[0], (double)pose->r.y - touch->middle[1],
                             (double)pose->r.z - touch->middle[2]};
    const double *n = touch->normal;
    const double *u = touch->edge;
    ball_t against = {-touch->radius, 0, 0};
    for (size_t i = 0; i < 3; ++i) {
        const wh_real_t *row = pose->R.m[i];
        const double from = place[i] + (double)row[0] * touch->ball[0] + (double)row[1] * touch->ball[1] +
                            (double)row[2] * touch->ball[2];
        const size_t j = (i + 1) % 3;
        const size_t k = (i + 2) % 3;
        against.gap += from * n[i];
        against.along += from * u[i];
        against.aside += from * (n[j] * u[k] - n[k] * u[j]);
    }
    return against;
}

static bool is_over(const wh_touch_face_t *touch, const ball_t *at) {
    return fabs(at->along) <= touch->along && fabs(at->aside) <= touch->aside;
}

/* The state of a switch that was closed or open before. */
static bool is_closed(const wh_touch_face_t *touch, const ball_t *at, double early, bool was) {
    return at->gap <= (was ? early + PLAY : early - PLAY) && is_over(touch, at);
}

static ball_t between(const ball_t *begin, const ball_t *end, double part) {
    const ball_t at = {begin->gap + part * (end->gap - begin->gap),
                       begin->along + part * (end->along - begin->along),
                       begin->aside + part * (end->aside - begin->aside)};
    return at;
}

double wh_touch_gap(const wh_touch_face_t *touch, const wh_pose_t *base_from_gripper) {
    const ball_t at = hold_against(touch, base_from_gripper);
    return is_over(touch, &at) ? at.gap : ASIDE;
}

bool wh_touch_next(const wh_touch_face_t *touch, const wh_pose_t *begin, const wh_pose_t *end, double early,
                   double *part, bool *closed) {
    const ball_t from = hold_against(touch, begin);
    const ball_t to = hold_against(touch, end);
    const ball_t here = between(&from, &to, *part);
    if (is_closed(touch, &here, early, *closed) != *closed) {
        *closed = !*closed;
        return true;
    }
    if (is_closed(touch, &to, early, *closed) == *closed) {
        return false;
    }
    const bool meets = (here.gap <= early) != (to.gap <= early);
    const double at = meets ? (early - from.gap) / (to.gap - from.gap) : 1;
    *part = at > *part ? at : *part;
    *closed = !*closed;
    return true;
}
