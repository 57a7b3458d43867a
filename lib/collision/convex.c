#include "gap_internal.h"

/* `half` with the sign of d; 0 for 0, for the middle of a face or of an edge. */
static wh_real_t towards(wh_real_t half, wh_real_t d) {
    if (d > 0) {
        return half;
    }
    return d < 0 ? -half : 0;
}

/* ----------------------------------------------------------------------------------------------- validate */

static bool is_within(const wh_vec3_t *v, wh_real_t limit) {
    return wh_real_abs(v->x) <= limit && wh_real_abs(v->y) <= limit && wh_real_abs(v->z) <= limit;
}

static bool is_half(wh_real_t half) {
    return half >= WH_CONVEX_THINNEST / 2 && half <= WH_CONVEX_LARGEST;
}

static wh_status_t validate_sizes(const wh_convex_t *shape) {
    const wh_vec3_t used = {shape->half.x, shape->kind == WH_CONVEX_BOX ? shape->half.y : shape->half.x,
                            shape->half.z};
    if (!wh_vec3_is_finite(&used)) {
        return WH_STATUS_NOT_FINITE;
    }
    const bool ball = shape->kind == WH_CONVEX_CAPSULE && used.z == 0;
    const bool good = is_half(used.x) && is_half(used.y) && (ball || is_half(used.z));
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

/* The kind of set that the earlier points span; it decides how far a point is outside of it. `along`: the
 * line, or the plane's normal. */
typedef enum { SPAN_POINT, SPAN_LINE, SPAN_PLANE } span_t;

static wh_real_t stick_out(const wh_vec3_t *from, span_t span, const wh_vec3_t *along) {
    const wh_vec3_t aside = span == SPAN_LINE ? wh_vec3_cross(along, from) : *from;
    return span == SPAN_PLANE ? wh_real_abs(wh_vec3_dot(along, from)) : wh_vec3_norm(&aside);
}

/* The point farthest outside of the span, as seen from the first point. */
static wh_vec3_t farthest_out(const wh_convex_t *mesh, span_t span, const wh_vec3_t *along, wh_real_t *most) {
    wh_vec3_t best = {0, 0, 0};
    *most = 0;
    for (size_t i = 1; i < mesh->point_count; ++i) {
        const wh_vec3_t from = wh_vec3_subtract(&mesh->points[i], &mesh->points[0]);
        const wh_real_t length = stick_out(&from, span, along);
        if (length > *most) {
            *most = length;
            best = from;
        }
    }
    return best;
}

static bool has_volume(const wh_convex_t *mesh) {
    wh_real_t most = 0;
    const wh_vec3_t none = {0, 0, 0};
    wh_vec3_t line = farthest_out(mesh, SPAN_POINT, &none, &most);
    if (!(most >= WH_CONVEX_THINNEST)) {
        return false;
    }
    line = wh_vec3_scale(1 / most, &line);
    const wh_vec3_t side = farthest_out(mesh, SPAN_LINE, &line, &most);
    if (!(most >= WH_CONVEX_THINNEST)) {
        return false;
    }
    wh_vec3_t normal = wh_vec3_cross(&line, &side);
    normal = wh_vec3_scale(1 / wh_vec3_norm(&normal), &normal);
    (void)farthest_out(mesh, SPAN_PLANE, &normal, &most);
    return most >= WH_CONVEX_THINNEST;
}

static wh_status_t validate_mesh(const wh_convex_t *mesh) {
    if (mesh->points == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (mesh->point_count < 4 || mesh->point_count > WH_CONVEX_POINTS) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_status_t status = WH_OK;
    for (size_t i = 0; i < mesh->point_count; ++i) {
        if (!wh_vec3_is_finite(&mesh->points[i])) {
            return WH_STATUS_NOT_FINITE;
        }
        status = is_within(&mesh->points[i], WH_CONVEX_LARGEST) ? status : WH_STATUS_OUT_OF_RANGE;
    }
    return status == WH_OK && !has_volume(mesh) ? WH_STATUS_OUT_OF_RANGE : status;
}

wh_status_t wh_convex_validate(const wh_convex_t *shape) {
    if (shape == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_status_t pose = wh_pose_validate(&shape->body_from_shape);
    if (pose != WH_OK) {
        return pose;
    }
    if (!is_within(&shape->body_from_shape.r, WH_CONVEX_LARGEST)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    switch (shape->kind) {
    case WH_CONVEX_BOX:
    case WH_CONVEX_CYLINDER:
    case WH_CONVEX_CAPSULE:
        return validate_sizes(shape);
    case WH_CONVEX_MESH:
        return validate_mesh(shape);
    default:
        return WH_STATUS_OUT_OF_RANGE;
    }
}

/* ------------------------------------------------------------------------------------------------ support */

static wh_vec3_t mesh_support(const wh_convex_t *mesh, const wh_vec3_t *direction) {
    const wh_vec3_t *best = &mesh->points[0];
    wh_real_t most = wh_vec3_dot(best, direction);
    for (size_t i = 1; i < mesh->point_count; ++i) {
        const wh_real_t height = wh_vec3_dot(&mesh->points[i], direction);
        if (height > most) {
            most = height;
            best = &mesh->points[i];
        }
    }
    return *best;
}

static wh_vec3_t cylinder_support(const wh_vec3_t *half, const wh_vec3_t *d) {
    const wh_real_t length = wh_real_sqrt(d->x * d->x + d->y * d->y);
    const wh_real_t f = length > 0 ? half->x / length : 0;
    return wh_vec3(f * d->x, f * d->y, towards(half->z, d->z));
}

wh_vec3_t wh_convex_kernel_support(const wh_convex_t *shape, const wh_vec3_t *direction) {
    const wh_vec3_t *half = &shape->half;
    switch (shape->kind) {
    case WH_CONVEX_CYLINDER:
        return cylinder_support(half, direction);
    case WH_CONVEX_CAPSULE:
        return wh_vec3(0, 0, towards(half->z, direction->z));
    case WH_CONVEX_MESH:
        return mesh_support(shape, direction);
    case WH_CONVEX_BOX:
    default:
        return wh_vec3(towards(half->x, direction->x), towards(half->y, direction->y),
                       towards(half->z, direction->z));
    }
}

wh_vec3_t wh_convex_support(const wh_convex_t *shape, const wh_pose_t *base_from_shape, wh_vec3_t direction) {
    const wh_vec3_t d = wh_mat3_transform_back(&base_from_shape->R, &direction);
    wh_vec3_t point = wh_convex_kernel_support(shape, &d);
    point = wh_pose_point(base_from_shape, &point);
    const wh_real_t round = wh_convex_round(shape);
    const wh_real_t length = round > 0 ? wh_vec3_norm(&direction) : 0;
    if (length > 0) {
        const wh_vec3_t out = wh_vec3_scale(round / length, &direction);
        point = wh_vec3_add(&point, &out);
    }
    return point;
}

wh_vec3_t wh_convex_centre(const wh_convex_t *shape) {
    wh_vec3_t sum = {0, 0, 0};
    if (shape->kind != WH_CONVEX_MESH) {
        return sum;
    }
    for (size_t i = 0; i < shape->point_count; ++i) {
        sum = wh_vec3_add(&sum, &shape->points[i]);
    }
    return wh_vec3_scale(1 / (wh_real_t)shape->point_count, &sum);
}

/* ------------------------------------------------------------------------------------------------- bounds */

static wh_real_t mesh_radius(const wh_convex_t *mesh, const wh_vec3_t *origin) {
    wh_real_t most = 0;
    for (size_t i = 0; i < mesh->point_count; ++i) {
        const wh_vec3_t from = wh_vec3_subtract(&mesh->points[i], origin);
        most = wh_real_max(most, wh_vec3_norm(&from));
    }
    return most;
}

wh_real_t wh_convex_radius(const wh_convex_t *shape) {
    const wh_pose_t *pose = &shape->body_from_shape;
    wh_vec3_t origin = wh_mat3_transform_back(&pose->R, &pose->r);
    origin = wh_vec3_scale(-1, &origin);
    if (shape->kind == WH_CONVEX_MESH) {
        return mesh_radius(shape, &origin);
    }
    const wh_vec3_t *half = &shape->half;
    const wh_real_t z = half->z + wh_real_abs(origin.z);
    if (shape->kind == WH_CONVEX_BOX) {
        const wh_vec3_t corner = {half->x + wh_real_abs(origin.x), half->y + wh_real_abs(origin.y), z};
        return wh_vec3_norm(&corner);
    }
    const wh_real_t beside = wh_real_sqrt(origin.x * origin.x + origin.y * origin.y);
    if (shape->kind == WH_CONVEX_CAPSULE) {
        return wh_real_sqrt(beside * beside + z * z) + half->x;
    }
    return wh_real_sqrt((beside + half->x) * (beside + half->x) + z * z);
}

/* The reach of a shape from its centre along one of base's axes, given as that row of its rotation. It is
 * not for meshes. */
static wh_real_t reach_along(const wh_convex_t *shape, const wh_vec3_t *row) {
    const wh_vec3_t *half = &shape->half;
    const wh_real_t z = wh_real_abs(row->z) * half->z;
    if (shape->kind == WH_CONVEX_BOX) {
        return wh_real_abs(row->x) * half->x + wh_real_abs(row->y) * half->y + z;
    }
    if (shape->kind == WH_CONVEX_CAPSULE) {
        return half->x + z;
    }
    return half->x * wh_real_sqrt(row->x * row->x + row->y * row->y) + z;
}

void wh_convex_bounds(const wh_convex_t *shape, const wh_pose_t *base_from_shape, wh_vec3_t *low,
                      wh_vec3_t *high) {
    wh_real_t from[3];
    wh_real_t to[3];
    for (size_t i = 0; i < 3; ++i) {
        const wh_vec3_t row = wh_mat3_row(&base_from_shape->R, i);
        if (shape->kind == WH_CONVEX_MESH) {
            const wh_vec3_t back = wh_vec3_scale(-1, &row);
            const wh_vec3_t first = mesh_support(shape, &back);
            const wh_vec3_t last = mesh_support(shape, &row);
            from[i] = wh_vec3_dot(&first, &row);
            to[i] = wh_vec3_dot(&last, &row);
        } else {
            to[i] = reach_along(shape, &row);
            from[i] = -to[i];
        }
    }
    const wh_vec3_t lowest = {from[0], from[1], from[2]};
    const wh_vec3_t highest = {to[0], to[1], to[2]};
    *low = wh_vec3_add(&lowest, &base_from_shape->r);
    *high = wh_vec3_add(&highest, &base_from_shape->r);
}
