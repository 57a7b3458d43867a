/* Convex shapes: which shapes are valid, their farthest points, their ball and their box. */
#include "collision/convex.h"

#include "support/convex.h"
#include "support/support.h"

static wh_vec3_t points[WH_TEST_MESH_POINTS];

static wh_convex_t mesh_of(size_t count) {
    wh_convex_t mesh = wh_test_shape(WH_CONVEX_MESH, 0, 0, 0);
    mesh.points = points;
    mesh.point_count = count;
    return mesh;
}

/* ------------------------------------------------------------------------------------------------ validate */

static void sizes_are_looked_at(void **state) {
    (void)state;
    assert_int_equal(wh_convex_validate(NULL), WH_STATUS_NULL_ARGUMENT);
    static const struct {
        wh_convex_kind_t kind;
        double half[3];
        wh_status_t status;
    } cases[] = {
        {WH_CONVEX_BOX, {1, 2, 3}, WH_OK},
        {WH_CONVEX_BOX, {WH_CONVEX_THINNEST / 2, WH_CONVEX_LARGEST, 1}, WH_OK},
        {WH_CONVEX_BOX, {0, 2, 3}, WH_STATUS_OUT_OF_RANGE},
        {WH_CONVEX_BOX, {1, -2, 3}, WH_STATUS_OUT_OF_RANGE},
        {WH_CONVEX_BOX, {1, 2, 0.0049}, WH_STATUS_OUT_OF_RANGE},
        {WH_CONVEX_BOX, {1, 2, 1.1e5}, WH_STATUS_OUT_OF_RANGE},
        {WH_CONVEX_BOX, {1, (double)NAN, 3}, WH_STATUS_NOT_FINITE},
        {WH_CONVEX_CYLINDER, {1, (double)NAN, 3}, WH_OK},
        {WH_CONVEX_CYLINDER, {1, 0, 0}, WH_STATUS_OUT_OF_RANGE},
        {WH_CONVEX_CYLINDER, {(double)INFINITY, 0, 1}, WH_STATUS_NOT_FINITE},
        {WH_CONVEX_CAPSULE, {1, 0, 0}, WH_OK},
        {WH_CONVEX_CAPSULE, {1, 0, -1}, WH_STATUS_OUT_OF_RANGE},
        {WH_CONVEX_CAPSULE, {0, 0, 1}, WH_STATUS_OUT_OF_RANGE},
        {(wh_convex_kind_t)4, {1, 1, 1}, WH_STATUS_OUT_OF_RANGE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const double *half = cases[i].half;
        const wh_convex_t shape = wh_test_shape(cases[i].kind, half[0], half[1], half[2]);
        assert_int_equal(wh_convex_validate(&shape), cases[i].status);
    }
}

static void the_place_is_looked_at(void **state) {
    (void)state;
    wh_convex_t box = wh_test_shape(WH_CONVEX_BOX, 1, 2, 3);
    box.body_from_shape.r.x = (double)NAN;
    assert_int_equal(wh_convex_validate(&box), WH_STATUS_NOT_FINITE);
    box.body_from_shape.r.x = -1.1 * WH_CONVEX_LARGEST;
    assert_int_equal(wh_convex_validate(&box), WH_STATUS_OUT_OF_RANGE);
    box.body_from_shape = wh_pose_identity();
    box.body_from_shape.R.m[0][1] = 0.1;
    assert_int_equal(wh_convex_validate(&box), WH_STATUS_NOT_A_ROTATION);
}

/* Points that span no volume, in any order of growth. */
static void meshes_are_looked_at(void **state) {
    (void)state;
    static const double flat[6][3] = {{5, 5, 5}, {5, 5, 5}, {6, 5, 5}, {9, 5, 5}, {5, 7, 5}, {5, 5, 5.0099}};
    for (size_t i = 0; i < 6; ++i) {
        points[i] = wh_vec3(flat[i][0], flat[i][1], flat[i][2]);
    }
    wh_convex_t mesh = mesh_of(3);
    assert_int_equal(wh_convex_validate(&mesh), WH_STATUS_OUT_OF_RANGE);
    for (mesh.point_count = 4; mesh.point_count <= 6; ++mesh.point_count) {
        assert_int_equal(wh_convex_validate(&mesh), WH_STATUS_OUT_OF_RANGE);
    }
    mesh.point_count = 6;
    points[5].z = 5.0101;
    assert_int_equal(wh_convex_validate(&mesh), WH_OK);
    points[1] = points[2] = points[3] = points[4] = points[0];
    assert_int_equal(wh_convex_validate(&mesh), WH_STATUS_OUT_OF_RANGE);
    points[0].z = -(double)INFINITY;
    assert_int_equal(wh_convex_validate(&mesh), WH_STATUS_NOT_FINITE);
    points[0].z = 1.1 * WH_CONVEX_LARGEST;
    assert_int_equal(wh_convex_validate(&mesh), WH_STATUS_OUT_OF_RANGE);
    mesh.point_count = WH_CONVEX_POINTS + 1;
    assert_int_equal(wh_convex_validate(&mesh), WH_STATUS_OUT_OF_RANGE);
    mesh.points = NULL;
    assert_int_equal(wh_convex_validate(&mesh), WH_STATUS_NULL_ARGUMENT);
}

/* ------------------------------------------------------------------------------------- support, ball and box */

static double height(const wh_vec3_t *point, const wh_vec3_t *direction) {
    return (double)wh_vec3_dot(point, direction);
}

/* In base. */
static wh_vec3_t independent(const wh_convex_t *shape, const wh_pose_t *pose, const wh_vec3_t *direction) {
    const wh_vec3_t d = wh_mat3_transform_back(&pose->R, direction);
    const wh_vec3_t point = wh_test_farthest(shape, &d, 1e-12);
    const wh_vec3_t turned = wh_mat3_transform(&pose->R, &point);
    return wh_vec3_add(&turned, &pose->r);
}

static void the_farthest_point_is_found(void **state) {
    (void)state;
    for (int i = 0; i < 20000 / WH_TEST_SHARE; ++i) {
        const wh_convex_t shape = wh_test_random_shape((wh_convex_kind_t)(i % 4), points);
        const wh_pose_t pose = wh_test_random_pose(1000);
        const wh_vec3_t direction = wh_test_direction();
        const wh_vec3_t want = independent(&shape, &pose, &direction);
        const wh_vec3_t longer = wh_vec3_scale(wh_test_decades(1e-6, 1e6), &direction);
        const wh_vec3_t got = wh_convex_support(&shape, &pose, longer);
        assert_near(height(&got, &direction), height(&want, &direction), 1e-10);
        const wh_vec3_t apart = wh_vec3_subtract(&got, &want);
        assert_near(wh_vec3_norm(&apart), 0, 1e-6);
    }
}

/* At right angles to a face or an edge it is the middle of it; for a zero direction it is a point
 * of the shape. */
static void ties_have_their_middle(void **state) {
    (void)state;
    static const struct {
        wh_convex_kind_t kind;
        double half[3], direction[3], want[3];
    } cases[] = {
        {WH_CONVEX_BOX, {1, 2, 3}, {0, -5, 0}, {0, -2, 0}},
        {WH_CONVEX_BOX, {1, 2, 3}, {1, 0, 1}, {1, 0, 3}},
        {WH_CONVEX_BOX, {1, 2, 3}, {0, 0, 0}, {0, 0, 0}},
        {WH_CONVEX_CYLINDER, {4, 0, 3}, {0, 0, 1}, {0, 0, 3}},
        {WH_CONVEX_CYLINDER, {4, 0, 3}, {0, -2, 0}, {0, -4, 0}},
        {WH_CONVEX_CYLINDER, {4, 0, 3}, {0, 0, 0}, {0, 0, 0}},
        {WH_CONVEX_CAPSULE, {4, 0, 3}, {2, 0, 0}, {4, 0, 0}},
        {WH_CONVEX_CAPSULE, {4, 0, 3}, {0, 0, 0}, {0, 0, 0}},
    };
    const wh_pose_t here = wh_pose_identity();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const double *half = cases[i].half;
        const double *d = cases[i].direction;
        const wh_convex_t shape = wh_test_shape(cases[i].kind, half[0], half[1], half[2]);
        const wh_vec3_t point = wh_convex_support(&shape, &here, wh_vec3(d[0], d[1], d[2]));
        assert_near(point.x, cases[i].want[0], 0);
        assert_near(point.y, cases[i].want[1], 0);
        assert_near(point.z, cases[i].want[2], 0);
    }
}

static double farthest_part(const wh_vec3_t *v) {
    return fmax(fmax((double)v->x, (double)v->y), (double)v->z);
}

/* The distance of the farthest of many points from the body's origin; each must be within the box.
 * The farther out a point is, the closer the next direction is to it. */
static double farthest_within(const wh_convex_t *shape, const wh_vec3_t *low, const wh_vec3_t *high) {
    double farthest = 0;
    wh_vec3_t towards = {1, 0, 0};
    for (int i = 0; i < 3000; ++i) {
        const wh_vec3_t jitter = wh_test_direction();
        towards = i % 30 == 0 ? jitter : wh_vec3_add(&towards, &jitter);
        const wh_vec3_t point = wh_convex_support(shape, &shape->body_from_shape, towards);
        towards = wh_vec3_scale(4 / (double)wh_vec3_norm(&point), &point);
        farthest = fmax(farthest, (double)wh_vec3_norm(&point));
        const wh_vec3_t below = wh_vec3_subtract(low, &point);
        const wh_vec3_t above = wh_vec3_subtract(&point, high);
        assert_true(farthest_part(&below) <= 1e-9 && farthest_part(&above) <= 1e-9);
    }
    return farthest;
}

/* Random points of a shape come close to the ball, and are within ball and box; the box ends at the
 * shape's ends. */
static void ball_and_box_fit(void **state) {
    (void)state;
    const wh_vec3_t ends[6] = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 400 / WH_TEST_SHARE; ++i) {
        wh_convex_t shape = wh_test_random_shape((wh_convex_kind_t)(i % 4), points);
        shape.body_from_shape = wh_test_random_pose(i % 8 < 4 ? 200 : 0);
        const double radius = (double)wh_convex_radius(&shape);
        wh_vec3_t box[2];
        wh_convex_bounds(&shape, &shape.body_from_shape, &box[0], &box[1]);
        const double farthest = farthest_within(&shape, &box[0], &box[1]);
        assert_true(farthest <= radius + 1e-9 && farthest >= 0.99 * radius);
        for (int k = 0; k < 6; ++k) {
            const wh_vec3_t end = independent(&shape, &shape.body_from_shape, &ends[k]);
            assert_near(height(&box[k / 3], &ends[k]), height(&end, &ends[k]), 1e-9);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_are_looked_at),    cmocka_unit_test(the_place_is_looked_at),
        cmocka_unit_test(meshes_are_looked_at),   cmocka_unit_test(the_farthest_point_is_found),
        cmocka_unit_test(ties_have_their_middle), cmocka_unit_test(ball_and_box_fit),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
