/* Convex shapes for tests: they are drawn at random, and their farthest points are found
 * independently of the library. */
#ifndef WH_TESTS_SUPPORT_CONVEX_H
#define WH_TESTS_SUPPORT_CONVEX_H

#include "collision/convex.h"
#include "support/pose.h"

#define WH_TEST_MESH_POINTS 24

static inline wh_convex_t wh_test_shape(wh_convex_kind_t kind, double x, double y, double z) {
    const wh_convex_t shape = {kind, {x, y, z}, NULL, 0, {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}}};
    return shape;
}

/* A wafer of 300 mm, and a blade. */
static inline wh_convex_t wh_test_wafer(void) {
    return wh_test_shape(WH_CONVEX_CYLINDER, 150, 0, 0.3875);
}

static inline wh_convex_t wh_test_blade(void) {
    return wh_test_shape(WH_CONVEX_BOX, 80, 75, 1.5);
}

/* A shape of any kind, some flat, some long; a mesh has its points (WH_TEST_MESH_POINTS of them) in
 * `points`. */
static inline wh_convex_t wh_test_random_shape(wh_convex_kind_t kind, wh_vec3_t *points) {
    const double x = wh_test_decades(1, 150);
    const double y = wh_test_decades(1, 150);
    wh_convex_t shape = wh_test_shape(kind, x, y, wh_test_decades(0.3, 150));
    if (kind == WH_CONVEX_MESH) {
        shape.points = points;
        shape.point_count = WH_TEST_MESH_POINTS;
        for (int i = 0; i < WH_TEST_MESH_POINTS; ++i) {
            points[i].x = wh_test_uniform(-x, x);
            points[i].y = wh_test_uniform(-y, y);
            points[i].z = wh_test_uniform(-shape.half.z, shape.half.z);
        }
    }
    return shape;
}

/* A unit vector of any direction. */
static inline wh_vec3_t wh_test_direction(void) {
    const wh_mat3_t R = wh_test_random_turn(WH_TEST_PI);
    return wh_mat3_column(&R, wh_test_below(3));
}

/* Half an extent with the sign of d; any point between the ends if d is nearly zero. */
static inline double wh_test_end(double half, double d, double flat) {
    if (fabs(d) < flat) {
        return wh_test_uniform(-half, half);
    }
    return d < 0 ? -half : half;
}

static inline wh_vec3_t wh_test_farthest_point(const wh_convex_t *mesh, const wh_vec3_t *d) {
    size_t best = 0;
    double most = -HUGE_VAL;
    for (size_t i = 0; i < mesh->point_count; ++i) {
        const wh_vec3_t *q = &mesh->points[i];
        const double height = d->x * q->x + d->y * q->y + d->z * q->z;
        best = height > most ? i : best;
        most = fmax(height, most);
    }
    return mesh->points[best];
}

/* The point of a shape farthest along the unit vector d, both in the shape's frame. If there are
 * many, one is drawn at random: faces and edges within `flat` of a right angle to d count as
 * perpendicular to it. */
static inline wh_vec3_t wh_test_farthest(const wh_convex_t *shape, const wh_vec3_t *d, double flat) {
    const wh_vec3_t *half = &shape->half;
    if (shape->kind == WH_CONVEX_MESH) {
        return wh_test_farthest_point(shape, d);
    }
    const double z = wh_test_end(half->z, d->z, flat);
    if (shape->kind == WH_CONVEX_BOX) {
        const double x = wh_test_end(half->x, d->x, flat);
        return wh_vec3(x, wh_test_end(half->y, d->y, flat), z);
    }
    if (shape->kind == WH_CONVEX_CAPSULE) {
        return wh_vec3(half->x * d->x, half->x * d->y, z + half->x * d->z);
    }
    const double across = hypot(d->x, d->y);
    if (across < flat) {
        const double angle = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
        const double radius = half->x * sqrt(wh_test_uniform(0, 1));
        return wh_vec3(radius * cos(angle), radius * sin(angle), z);
    }
    return wh_vec3(half->x * d->x / across, half->x * d->y / across, z);
}

#endif
