/* Outlines of parts: the contour of a shape from above and from the side, and labels that make room
 * for each other. */
#include "support/support.h"

#include <string.h>

#include "layout/inks.h"
#include "layout/outline.h"
#include "math/trig.h"
#include "text/svg.h"

static wh_outline_t outline;

static int free_outline(void **state) {
    (void)state;
    wh_outline_free(&outline);
    return 0;
}

static void draw(wh_projection_t view, const wh_convex_t *convex, const wh_pose_t *pose) {
    wh_outline_draw(&outline, view, convex, pose);
}

/* Twice the area, positive for one direction: every corner of a hull turns the same way. */
static double area(void) {
    double twice = 0;
    for (size_t i = 0; i < outline.count; ++i) {
        const wh_spot_t a = outline.spots[i];
        const wh_spot_t b = outline.spots[(i + 1) % outline.count];
        const wh_spot_t c = outline.spots[(i + 2) % outline.count];
        assert_true((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) > 0);
        twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
}

static void expect_bounds(double x0, double x1, double y0, double y1) {
    double low_x = (double)INFINITY, high_x = -(double)INFINITY, low_y = (double)INFINITY,
           high_y = -(double)INFINITY;
    for (size_t i = 0; i < outline.count; ++i) {
        low_x = fmin(low_x, outline.spots[i].x);
        high_x = fmax(high_x, outline.spots[i].x);
        low_y = fmin(low_y, outline.spots[i].y);
        high_y = fmax(high_y, outline.spots[i].y);
    }
    assert_near(low_x, x0, 1e-9);
    assert_near(high_x, x1, 1e-9);
    assert_near(low_y, y0, 1e-9);
    assert_near(high_y, y1, 1e-9);
}

static wh_pose_t at(double x, double y, double z, double roll, double pitch, double yaw) {
    const wh_pose_t pose = {wh_mat3_from_rpy_deg(roll, pitch, yaw), {x, y, z}};
    return pose;
}

static void boxes(void **state) {
    (void)state;
    const wh_convex_t box = {.kind = WH_CONVEX_BOX, .half = {10, 20, 30}};
    const wh_pose_t level = at(100, 200, 300, 0, 0, 0);
    draw(WH_VIEW_TOP, &box, &level);
    assert_int_equal(outline.count, 4);
    expect_bounds(90, 110, -220, -180);
    assert_near(area(), 20 * 40, 1e-9);
    draw(WH_VIEW_SIDE, &box, &level);
    expect_bounds(90, 110, -330, -270);
    assert_near(area(), 20 * 60, 1e-9);
    /* A cube that stands on a corner shows six. */
    const wh_pose_t tumbled = at(0, 0, 0, 30, 40, 50);
    draw(WH_VIEW_TOP, &box, &tumbled);
    assert_int_equal(outline.count, 6);
    const wh_vec3_t n = wh_mat3_row(&tumbled.R, 2);
    assert_near(area(), 8 * (20 * 30 * fabs(n.x) + 10 * 30 * fabs(n.y) + 10 * 20 * fabs(n.z)) / 2, 1e-6);
}

static void round_shapes(void **state) {
    (void)state;
    const wh_convex_t disc = {.kind = WH_CONVEX_CYLINDER, .half = {150, 0, 0.5}};
    const wh_pose_t level = at(0, 0, 10, 0, 0, 0);
    draw(WH_VIEW_TOP, &disc, &level);
    assert_int_equal(outline.count, 48);
    expect_bounds(-150, 150, -150, 150);
    draw(WH_VIEW_SIDE, &disc, &level);
    assert_int_equal(outline.count, 4);
    expect_bounds(-150, 150, -10.5, -9.5);
    const wh_convex_t hose = {.kind = WH_CONVEX_CAPSULE, .half = {5, 0, 20}};
    const wh_pose_t lying = at(0, 0, 0, 0, 90, 0);
    draw(WH_VIEW_TOP, &hose, &lying);
    expect_bounds(-25, 25, -5, 5);
    const wh_pose_t standing = at(0, 0, 0, 0, 0, 0);
    draw(WH_VIEW_TOP, &hose, &standing);
    expect_bounds(-5, 5, -5, 5);
    assert_int_equal(outline.count, 48);
}

static void meshes(void **state) {
    (void)state;
    wh_vec3_t points[200];
    for (size_t i = 0; i < 200; ++i) {
        points[i] = wh_vec3(wh_test_uniform(-1, 1), wh_test_uniform(-1, 1), wh_test_uniform(-1, 1));
    }
    points[50] = wh_vec3(-2, -2, 0);
    points[100] = wh_vec3(2, -2, 0);
    points[150] = wh_vec3(0, 3, 0);
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH, .points = points, .point_count = 200};
    const wh_pose_t level = at(0, 0, 0, 0, 0, 0);
    draw(WH_VIEW_TOP, &mesh, &level);
    expect_bounds(-2, 2, -3, 2);
    assert_true(area() >= 4.0 * 5 / 2);
}

/* The text that is written, with at most this number of bytes. */
static void expect_text(const char *text, const char *wanted) {
    char written[128] = "";
    FILE *out = fmemopen(written, sizeof written, "w");
    assert_non_null(out);
    wh_svg_text(out, text);
    assert_int_equal(fclose(out), 0);
    assert_string_equal(written, wanted);
}

static void text_is_drawn(void **state) {
    (void)state;
    expect_text("a < b & c > \"d\"", "a &lt; b &amp; c &gt; &quot;d&quot;");
    expect_text("Wäfer №3", "Wäfer №3");
    expect_text("\xff|\xe2\x82|\x01", "\xef\xbf\xbd|\xef\xbf\xbd\xef\xbf\xbd|\xef\xbf\xbd");
    expect_text("\xef\xbf\xbf", "\xef\xbf\xbd");
}

static void labels_make_room(void **state) {
    (void)state;
    char written[512] = "";
    FILE *out = fmemopen(written, sizeof written, "w");
    assert_non_null(out);
    wh_svg_labels_t labels = {.out = out, .size = 10, .left = 0, .right = 200};
    wh_svg_label(&labels, 100, 50, "one");
    wh_svg_label(&labels, 105, 52, "two");
    wh_svg_label(&labels, 199, 50, "right");
    wh_svg_label(&labels, 1, 50, "left");
    assert_int_equal(fclose(out), 0);
    assert_non_null(strstr(written, "x=\"100.0\" y=\"50.0\">one<"));
    assert_non_null(strstr(written, "x=\"105.0\" y=\"63.5\">two<"));
    assert_non_null(strstr(written, "x=\"185.0\" y=\"50.0\">right<"));
    assert_non_null(strstr(written, "x=\"12.0\" y=\"50.0\">left<"));
}

/* ----------------------------------------------------------------------------------------------------- inks */

/* The formula of IEC 61966-2-1. */
static double linear_of(uint32_t part) {
    const double share = (double)(part & 0xffU) / 255;
    return share <= 0.04045 ? share / 12.92 : pow((share + 0.055) / 1.055, 2.4);
}

static void gltf_has_the_drawings_colours_in_linear_light(void **state) {
    (void)state;
    for (size_t ink = 0; ink < WH_INKS; ++ink) {
        const uint32_t drawn = wh_ink_looks[ink].drawn.light;
        assert_near(wh_ink_materials[ink].red, linear_of(drawn >> 16), 0.01);
        assert_near(wh_ink_materials[ink].green, linear_of(drawn >> 8), 0.01);
        assert_near(wh_ink_materials[ink].blue, linear_of(drawn), 0.01);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(boxes, free_outline),
        cmocka_unit_test_teardown(round_shapes, free_outline),
        cmocka_unit_test_teardown(meshes, free_outline),
        cmocka_unit_test(text_is_drawn),
        cmocka_unit_test(labels_make_room),
        cmocka_unit_test(gltf_has_the_drawings_colours_in_linear_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
