/* Convex shapes for tests: drawn at random, and with farthest points found independently of the library. */
#ifndef WH_TESTS_SUPPORT_CONVEX_H
#define WH_TESTS_SUPPORT_CONVEX_H

#include "collision/convex.h"
#include "support_pose.h"

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

/* Of some kind, some flat, some long; a mesh has its points (WH_TEST_MESH_POINTS of them) in `points`. */
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

static inline double wh_test_sign(double a) {
    return a < 0 ? -1 : 1;
}

/* The point of a shape farthest along `direction`, both in the shape's frame; where many are, one drawn at random: within
 * `flat` of the right angle a face or an edge counts as lying across. */
static inline wh_vec3_t wh_test_farthest(const wh_convex_t *shape, const wh_vec3_t *direction, double flat) {
    const double d[3] = {direction->x, direction->y, direction->z};
    double half[3] = {shape->half.x, shape->half.y, shape->half.z};
    double p[3] = {0, 0, 0};
    const double across = hypot(d[0], d[1]);
    if (shape->kind == WH_CONVEX_MESH) {
        size_t best = 0;
        double most = -HUGE_VAL;
        for (size_t i = 0; i < shape->point_count; ++i) {
            const wh_vec3_t *q = &shape->points[i];
            const double height = d[0] * q->x + d[1] * q->y + d[2] * q->z;
            best = height > most ? i : best;
            most = fmax(height, most);
        }
        return shape->points[best];
    }
    for (int i = shape->kind == WH_CONVEX_BOX ? 0 : 2; i < 3; ++i) {
        p[i] = half[i] * (fabs(d[i]) < flat ? wh_test_uniform(-1, 1) : wh_test_sign(d[i]));
    }
    if (shape->kind == WH_CONVEX_CAPSULE) {
        for (int i = 0; i < 3; ++i) {
            p[i] += half[0] * d[i];
        }
    } else if (shape->kind == WH_CONVEX_CYLINDER) {
        const double angle = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
        const double radius = half[0] * sqrt(wh_test_uniform(0, 1));
        p[0] = across < flat ? radius * cos(angle) : half[0] * d[0] / across;
        p[1] = across < flat ? radius * sin(angle) : half[0] * d[1] / across;
    }
    return wh_vec3(p[0], p[1], p[2]);
}

#endif
