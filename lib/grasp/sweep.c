#include "sweep_internal.h"

#include "grasp_internal.h"

/* Shepperd's method: it divides by the largest of the four, so that no digit is lost. */
static void quaternion_from_rotation(const wh_mat3_t *R, wh_real_t *w, wh_vec3_t *v) {
    const wh_real_t signals = R->m[0][0] + R->m[1][1] + R->m[2][2];
    size_t i = 0;
    for (size_t k = 1; k < 3; ++k) {
        i = R->m[k][k] > R->m[i][i] ? k : i;
    }
    wh_real_t q[3];
    if (signals > R->m[i][i]) {
        *w = wh_real_sqrt(wh_real_abs(1 + signals)) / 2;
        const wh_real_t f = 1 / (4 * *w);
        *v = wh_vec3(f * (R->m[2][1] - R->m[1][2]), f * (R->m[0][2] - R->m[2][0]),
                     f * (R->m[1][0] - R->m[0][1]));
        return;
    }
    const size_t j = (i + 1) % 3;
    const size_t k = (i + 2) % 3;
    q[i] = wh_real_sqrt(wh_real_abs(1 + R->m[i][i] - R->m[j][j] - R->m[k][k])) / 2;
    const wh_real_t f = 1 / (4 * q[i]);
    q[j] = f * (R->m[j][i] + R->m[i][j]);
    q[k] = f * (R->m[k][i] + R->m[i][k]);
    *w = f * (R->m[k][j] - R->m[j][k]);
    *v = wh_vec3(q[0], q[1], q[2]);
}

static wh_mat3_t rotation_from_quaternion(wh_real_t w, const wh_vec3_t *v) {
    const wh_real_t f = 2 / (w * w + wh_vec3_dot(v, v));
    const wh_real_t x = v->x;
    const wh_real_t y = v->y;
    const wh_real_t z = v->z;
    const wh_mat3_t R = {{{1 - f * (y * y + z * z), f * (x * y - w * z), f * (x * z + w * y)},
                          {f * (x * y + w * z), 1 - f * (x * x + z * z), f * (y * z - w * x)},
                          {f * (x * z - w * y), f * (y * z + w * x), 1 - f * (x * x + y * y)}}};
    return R;
}

void wh_sweep_between(const wh_pose_t *begin, const wh_pose_t *end, wh_sweep_t *sweep) {
    wh_mat3_t turn;
    wh_mat3_multiply_back_to(&begin->R, &end->R, &turn);
    sweep->begin = begin;
    sweep->end = end;
    sweep->travel = wh_vec3_subtract(&end->r, &begin->r);
    quaternion_from_rotation(&turn, &sweep->w, &sweep->v);
    if (sweep->w < 0) {
        sweep->w = -sweep->w;
        sweep->v = wh_vec3_scale(-1, &sweep->v);
    }
}

void wh_sweep_pose_at(const wh_sweep_t *sweep, wh_real_t t, wh_pose_t *pose) {
    if (t >= 1) {
        *pose = *sweep->end;
        return;
    }
    const wh_vec3_t along = wh_vec3_scale(t, &sweep->travel);
    const wh_vec3_t v = wh_vec3_scale(t, &sweep->v);
    const wh_mat3_t turn = rotation_from_quaternion(1 - t + t * sweep->w, &v);
    pose->r = wh_vec3_add(&sweep->begin->r, &along);
    wh_mat3_multiply_to(&sweep->begin->R, &turn, &pose->R);
}

static bool cut(wh_span_t *part, wh_real_t first, wh_real_t last) {
    part->first = first > part->first ? first : part->first;
    part->last = last < part->last ? last : part->last;
    return part->first <= part->last;
}

static bool cut_slab(wh_span_t *part, wh_real_t z, wh_real_t travel_z, wh_real_t limit) {
    if (travel_z == 0) {
        return wh_real_abs(z) <= limit;
    }
    const wh_real_t low = (-limit - z) / travel_z;
    const wh_real_t high = (limit - z) / travel_z;
    return low < high ? cut(part, low, high) : cut(part, high, low);
}

/* a t^2 + 2 b t + c <= 0, with a the squared travel in the plane */
static bool cut_cylinder(wh_span_t *part, wh_real_t a, wh_real_t b, wh_real_t c) {
    if (a == 0) {
        return c <= 0;
    }
    const wh_real_t discriminant = b * b - a * c;
    if (!(discriminant >= 0)) {
        return false;
    }
    const wh_real_t root = wh_real_sqrt(discriminant);
    const wh_real_t q = b > 0 ? -b - root : -b + root;
    if (q == 0) {
        return cut(part, 0, 0);
    }
    return b > 0 ? cut(part, q / a, c / q) : cut(part, c / q, q / a);
}

bool wh_sweep_within(const wh_sweep_t *sweep, const wh_pose_t *base_from_wafer, wh_real_t projz,
                     wh_real_t projxy, wh_span_t *part) {
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, &sweep->begin->r);
    const wh_vec3_t p = wh_mat3_transform_back(&base_from_wafer->R, &dr);
    const wh_vec3_t d = wh_mat3_transform_back(&base_from_wafer->R, &sweep->travel);
    part->first = 0;
    part->last = 1;
    return cut_slab(part, p.z, -d.z, projz) &&
           cut_cylinder(part, d.x * d.x + d.y * d.y, -(p.x * d.x + p.y * d.y),
                        p.x * p.x + p.y * p.y - projxy * projxy);
}

/* The instant from which n1_proj_n2 > limit: the part's beginning, or the root at which the quadratic c2
 * t^2 + c1 t + c0 = |Q|^2 (n1_proj_n2 - limit) rises through zero. */
static bool cut_planar(wh_span_t *part, const wh_sweep_t *sweep, const wh_pose_t *base_from_wafer,
                       wh_real_t limit) {
    const wh_vec3_t n1 = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_vec3_t m = wh_mat3_transform_back(&sweep->begin->R, &n1);
    const wh_vec3_t *v = &sweep->v;
    const wh_real_t k = 1 - sweep->w;
    const wh_real_t a = 2 * (v->y * m.x - v->x * m.y);
    const wh_real_t c0 = m.z - limit;
    const wh_real_t c1 = a - 2 * k * c0;
    const wh_real_t c2 = 2 * v->z * (v->x * m.x + v->y * m.y) +
                         m.z * (k * k + v->z * v->z - v->x * v->x - v->y * v->y) - k * a -
                         limit * (k * k + wh_vec3_dot(v, v));
    if ((c2 * part->first + c1) * part->first + c0 > 0) {
        return true;
    }
    const wh_real_t discriminant = c1 * c1 - 4 * c2 * c0;
    if (!(discriminant > 0)) {
        return false;
    }
    const wh_real_t root = wh_real_sqrt(discriminant);
    const wh_real_t rising = c1 > 0 ? -2 * c0 / (c1 + root) : (root - c1) / (2 * c2);
    const bool rises_later = rising >= part->first || 2 * c2 * part->first + c1 > 0;
    return rises_later && cut(part, rising, 1);
}

bool wh_sweep_first_ready(const wh_sweep_t *sweep, const wh_pose_t *base_from_wafer,
                          const wh_tolerance_t *tolerance, wh_real_t *t) {
    /* The limits (7) and (8) are strict, so exactly at their root the check fails by rounding; it also
     * tries a little later. */
    static const wh_real_t later[] = {0, WH_REAL(1.0 / 1048576), WH_REAL(1.0 / 1024), WH_REAL(0.5)};
    wh_span_t part;
    if (!wh_sweep_within(sweep, base_from_wafer, WH_SWEEP_INSIDE * tolerance->projz, tolerance->projxy,
                         &part) ||
        !cut_planar(&part, sweep, base_from_wafer, tolerance->planar)) {
        return false;
    }
    for (size_t i = 0; i < sizeof later / sizeof later[0]; ++i) {
        const wh_real_t instant = part.first + later[i] * (part.last - part.first);
        wh_pose_t base_from_gripper;
        wh_sweep_pose_at(sweep, instant, &base_from_gripper);
        if (wh_proximity_is_ready(base_from_wafer, &base_from_gripper, tolerance)) {
            *t = instant;
            return true;
        }
    }
    return false;
}

wh_real_t wh_sweep_closest(const wh_sweep_t *sweep, const wh_pose_t *base_from_wafer, const wh_span_t *part,
                           wh_real_t projz, wh_real_t projxy) {
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, &sweep->begin->r);
    const wh_vec3_t p = wh_mat3_transform_back(&base_from_wafer->R, &dr);
    const wh_vec3_t d = wh_mat3_transform_back(&base_from_wafer->R, &sweep->travel);
    const wh_real_t z = 1 / (projz * projz);
    const wh_real_t xy = 1 / (projxy * projxy);
    const wh_real_t squared = xy * (d.x * d.x + d.y * d.y) + z * d.z * d.z;
    const wh_real_t ahead = xy * (p.x * d.x + p.y * d.y) + z * p.z * d.z;
    const wh_real_t t = squared > 0 ? ahead / squared : part->last;
    if (t < part->first) {
        return part->first;
    }
    return t < part->last ? t : part->last;
}
