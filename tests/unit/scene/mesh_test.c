/* Triangles of shapes: closed, outward, and of the right volume. */
#include "support/support.h"

#include "math/trig.h"
#include "scene/mesh.h"

#define CORNERS 48

static wh_pose_t some_pose(void) {
    wh_pose_t pose;
    pose.R = wh_mat3_from_rpy_deg(20, -35, 130);
    pose.r = wh_vec3(400, -20, 900);
    return pose;
}

static wh_vec3_t corner(const wh_mesh_t *mesh, size_t i) {
    const float *v = mesh->vertices[mesh->indices[i]];
    return wh_vec3((double)v[0], (double)v[1], (double)v[2]);
}

/* By the divergence theorem, about the first corner: exact for a closed surface, and negative if it
 * is inside out. */
static double volume(const wh_mesh_t *mesh) {
    const wh_vec3_t origin = corner(mesh, 0);
    double sum = 0;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        wh_vec3_t p[3];
        for (size_t k = 0; k < 3; ++k) {
            const wh_vec3_t at = corner(mesh, i + k);
            p[k] = wh_vec3_subtract(&at, &origin);
        }
        const wh_vec3_t cross = wh_vec3_cross(&p[1], &p[2]);
        sum += wh_vec3_dot(&p[0], &cross) / 6;
    }
    return sum;
}

/* For a closed surface the sum of all faces, as vectors, is zero; the vertices' normals have length
 * 1 and point to the faces' side. */
static void assert_closed(const wh_mesh_t *mesh, double area) {
    wh_vec3_t sum = {0, 0, 0};
    assert_int_equal(mesh->index_count % 3, 0);
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        const wh_vec3_t a = corner(mesh, i);
        const wh_vec3_t b = corner(mesh, i + 1);
        const wh_vec3_t c = corner(mesh, i + 2);
        const wh_vec3_t ab = wh_vec3_subtract(&b, &a);
        const wh_vec3_t ac = wh_vec3_subtract(&c, &a);
        const wh_vec3_t face = wh_vec3_cross(&ab, &ac);
        sum = wh_vec3_add(&sum, &face);
        for (size_t k = 0; k < 3; ++k) {
            assert_true(mesh->indices[i + k] < mesh->vertex_count);
            const float *v = mesh->vertices[mesh->indices[i + k]];
            const wh_vec3_t normal = {(double)v[3], (double)v[4], (double)v[5]};
            assert_near(wh_vec3_norm(&normal), 1, 1e-5);
            assert_true(wh_vec3_dot(&normal, &face) >= -1e-3 * wh_vec3_norm(&face));
        }
    }
    assert_near(wh_vec3_norm(&sum), 0, 1e-4 * area);
}

static void check(const wh_convex_t *convex, double expected, double tolerance) {
    const wh_pose_t pose = some_pose();
    wh_mesh_t mesh = {0};
    wh_mesh_add_convex(&mesh, convex, &pose);
    assert_near(volume(&mesh), expected, tolerance * expected);
    assert_closed(&mesh, pow(expected, 2.0 / 3));
    wh_mesh_free(&mesh);
}

/* The area of a polygon with this number of corners on the unit circle. */
static double polygon_area(int corners) {
    return corners * sin(2 * acos(-1.0) / corners) / 2;
}

static void a_box_becomes_triangles(void **state) {
    (void)state;
    const wh_convex_t box = {.kind = WH_CONVEX_BOX, .half = {10, 20, 30}};
    check(&box, 8 * 10 * 20 * 30, 1e-4);
}

static void a_cylinder_becomes_triangles(void **state) {
    (void)state;
    const wh_convex_t cylinder = {.kind = WH_CONVEX_CYLINDER, .half = {50, 0, 30}};
    check(&cylinder, polygon_area(CORNERS) * 2500 * 60, 1e-4);
}

/* A ball of facets is a little smaller than the ball. */
static void a_capsule_becomes_triangles(void **state) {
    (void)state;
    const double ball = 4.0 / 3 * acos(-1.0) * 8000;
    const wh_convex_t capsule = {.kind = WH_CONVEX_CAPSULE, .half = {20, 0, 40}};
    check(&capsule, ball + acos(-1.0) * 400 * 80, 0.03);
    const wh_convex_t sphere = {.kind = WH_CONVEX_CAPSULE, .half = {20, 0, 0}};
    check(&sphere, ball, 0.04);
}

/* The hull of a box's corners with points inside and on its faces is the box. */
static void a_hull_becomes_triangles(void **state) {
    (void)state;
    wh_vec3_t points[60];
    for (size_t i = 0; i < 60; ++i) {
        if (i < 8) {
            points[i] = wh_vec3(i & 1U ? 10 : -10, i & 2U ? 20 : -20, i & 4U ? 30 : -30);
        } else {
            points[i] = wh_vec3(wh_test_uniform(-10, 10), wh_test_uniform(-20, 20),
                                i % 2 ? 30 : wh_test_uniform(-30, 30));
        }
    }
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH, .points = points, .point_count = 60};
    check(&mesh, 8 * 10 * 20 * 30, 1e-4);
}

/* This many points are thinned to the outermost ones. */
static void hull_of_many_points(void **state) {
    (void)state;
    static wh_vec3_t points[5000];
    for (size_t i = 0; i < 5000; ++i) {
        const double z = wh_test_uniform(-1, 1);
        const double angle = wh_test_uniform(0, 6.28);
        const double wide = sqrt(1 - z * z);
        points[i] = wh_vec3(40 * wide * cos(angle), 40 * wide * sin(angle), 40 * z);
    }
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH, .points = points, .point_count = 5000};
    check(&mesh, 4.0 / 3 * acos(-1.0) * 64000, 0.04);
}

/* Points in a plane have no hull: nothing is drawn. */
static void flat_points(void **state) {
    (void)state;
    const wh_vec3_t points[5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.2, 0}};
    const wh_convex_t flat = {.kind = WH_CONVEX_MESH, .points = points, .point_count = 5};
    const wh_pose_t here = wh_pose_identity();
    wh_mesh_t mesh = {0};
    wh_mesh_add_convex(&mesh, &flat, &here);
    assert_int_equal(mesh.index_count, 0);
    wh_mesh_free(&mesh);
}

static void wafer(void **state) {
    (void)state;
    wh_mesh_t plain = {0};
    wh_mesh_t notched = {0};
    wh_mesh_add_wafer(&plain, 150, 0.775, 0.3, 0);
    wh_mesh_add_wafer(&notched, 150, 0.775, 0.3, 10);
    assert_near(volume(&plain), polygon_area(96) * 22500 * 0.775, 1);
    assert_closed(&plain, 22500);
    /* A right angle, 10 deep: about 100 square mm are missing. */
    assert_near(volume(&plain) - volume(&notched), 100 * 0.775, 12);
    assert_closed(&notched, 22500);
    double nearest = 149;
    for (size_t i = 1; i < notched.vertex_count; ++i) {
        const double x = (double)notched.vertices[i][0];
        const double y = (double)notched.vertices[i][1];
        const double r = sqrt(x * x + y * y);
        if (r > 1 && r < nearest) {
            nearest = r;
            assert_near(atan2(y, x), 0.3, 1e-6);
        }
    }
    assert_near(nearest, 140, 1e-3);
    wh_mesh_free(&plain);
    wh_mesh_free(&notched);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_becomes_triangles),
        cmocka_unit_test(a_cylinder_becomes_triangles),
        cmocka_unit_test(a_capsule_becomes_triangles),
        cmocka_unit_test(a_hull_becomes_triangles),
        cmocka_unit_test(hull_of_many_points),
        cmocka_unit_test(flat_points),
        cmocka_unit_test(wafer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
