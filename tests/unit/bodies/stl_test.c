/* STL files of both formats, good and bad. */
#include "bodies/stl.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/support.h"

enum { ROOM = 1 << 17 };

static char bytes[ROOM];
static size_t length;
static char message[200];
static wh_vec3_t *points;
static size_t count;

/* A tetrahedron of edge 10, with the last corner at a given place. */
static const char tetrahedron[] = "solid thing of\tmany words\r\n"
                                  "facet normal 0 0 -1\n outer loop\n"
                                  "  vertex 0 0 0\n  vertex 0 10 0\n  vertex 10 0 0\n"
                                  " endloop\nendfacet\n"
                                  "facet normal nan nan nan\n outer loop\n"
                                  "  vertex 0 0 0\n  vertex 1e1 0 0\n  vertex 0 0 +10.0\n"
                                  " endloop\nendfacet\n"
                                  "FACET NORMAL -1 0 0\n OUTER LOOP\n"
                                  "  VERTEX 0 0 0\n  vertex 0 0 10\n  vertex 0 10 0\n"
                                  " ENDLOOP\nENDFACET\n"
                                  "facet normal 1 1 1\n outer loop\n"
                                  "  vertex 10 0 0\n  vertex 0 10 0\n  vertex 0 0 10\n"
                                  " endloop\nendfacet\n"
                                  "endsolid thing of many words\n";

static bool parse(double mm_per_unit) {
    points = NULL;
    count = 77;
    message[0] = '\0';
    return wh_stl_parse("part.stl", bytes, length, mm_per_unit, &points, &count, message, sizeof message);
}

static void text(const char *content) {
    length = strlen(content);
    assert_true(length < ROOM);
    memcpy(bytes, content, length);
}

/* The tetrahedron with one piece of it replaced. */
static void changed(const char *piece, const char *by) {
    const char *at = strstr(tetrahedron, piece);
    assert_non_null(at);
    char content[2 * sizeof tetrahedron];
    (void)snprintf(content, sizeof content, "%.*s%s%s", (int)(at - tetrahedron), tetrahedron, by,
                   at + strlen(piece));
    text(content);
}

static void add_little_endian(uint32_t value) {
    for (int i = 0; i < 4; ++i) {
        bytes[length++] = (char)(value >> 8 * i & 0xff);
    }
}

static void add_float(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    add_little_endian(bits);
}

static void begin_binary(const char *head, uint32_t facets) {
    memset(bytes, ' ', 80);
    memcpy(bytes, head, strlen(head));
    length = 80;
    add_little_endian(facets);
}

static void add_facet(const float *a, const float *b, const float *c) {
    const float normal[3] = {0, 0, 0};
    const float *const all[4] = {normal, a, b, c};
    for (int i = 0; i < 12; ++i) {
        add_float(all[i / 3][i % 3]);
    }
    length += 2;
}

/* A prism over a polygon in the plane, from z 0 to z 1; `corners` holds x and y. */
static void prism(const float *corners, uint32_t n, float height) {
    begin_binary("solid but binary", 2 * n + 2 * (n - 2));
    for (uint32_t i = 0; i < n; ++i) {
        const float *p = corners + 2 * (size_t)i;
        const float *q = corners + 2 * (size_t)((i + 1) % n);
        const float low_p[3] = {p[0], p[1], 0};
        const float low_q[3] = {q[0], q[1], 0};
        const float high_p[3] = {p[0], p[1], height};
        const float high_q[3] = {q[0], q[1], height};
        const float low_0[3] = {corners[0], corners[1], 0};
        const float high_0[3] = {corners[0], corners[1], height};
        add_facet(low_p, low_q, high_p);
        add_facet(high_p, low_q, high_q);
        if (i > 0 && i + 1 < n) {
            add_facet(low_0, low_q, low_p);
            add_facet(high_0, high_p, high_q);
        }
    }
}

static const float square[] = {-150, -75, 150, -75, 150, 75, -150, 75};
static const float horseshoe[] = {-150, -75, 150, -75, 150, -40, -50,  -40,
                                  -50,  40,  150, 40,  150, 75,  -150, 75};

/* ------------------------------------------------------------------------------------------------------ good */

static void a_text_is_read(void **state) {
    (void)state;
    text(tetrahedron);
    assert_true(parse(25.4));
    assert_int_equal(count, 4);
    const double want[4][3] = {{0, 0, 0}, {0, 0, 254}, {0, 254, 0}, {254, 0, 0}};
    for (size_t i = 0; i < 4; ++i) {
        assert_near(points[i].x, want[i][0], 1e-12);
        assert_near(points[i].y, want[i][1], 1e-12);
        assert_near(points[i].z, want[i][2], 1e-12);
    }
    free(points);
}

static void a_binary_is_read_whatever_its_head_says(void **state) {
    (void)state;
    prism(square, 4, 3);
    assert_true(parse(1));
    assert_int_equal(count, 8);
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH,
                              .points = points,
                              .point_count = count,
                              .body_from_shape = wh_pose_identity()};
    assert_int_equal(wh_convex_validate(&mesh), WH_OK);
    assert_near(wh_convex_radius(&mesh), sqrt(150 * 150 + 75 * 75 + 9), 1e-12);
    free(points);
}

/* Rounded to single floats, far from the origin, as drawing programs write it. */
static void a_fine_polygon_is_convex(void **state) {
    (void)state;
    float corners[2 * 360];
    for (size_t i = 0; i < 360; ++i) {
        corners[2 * i] = 700 + 150 * (float)cos((double)i * 0.017453292519943295);
        corners[2 * i + 1] = 150 * (float)sin((double)i * 0.017453292519943295);
    }
    for (float height = 0.05F; height < 30; height *= 2) {
        prism(corners, 360, height);
        assert_true(parse(1));
        assert_int_equal(count, 720);
        free(points);
    }
}

static void a_file_is_read(void **state) {
    (void)state;
    char path[WH_TEST_PATH];
    const int descriptor = mkstemp(wh_test_path(path, "stl"));
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, tetrahedron, sizeof tetrahedron - 1), sizeof tetrahedron - 1);
    assert_int_equal(close(descriptor), 0);
    assert_true(wh_stl_read(path, 1, &points, &count, message, sizeof message));
    assert_int_equal(count, 4);
    free(points);
    assert_int_equal(unlink(path), 0);
    assert_false(wh_stl_read(path, 1, &points, &count, message, sizeof message));
    assert_non_null(strstr(message, path));
    assert_non_null(strstr(message, "No such file"));
    assert_false(wh_stl_read("/", 1, &points, &count, message, sizeof message));
    assert_string_equal(message, "/: it is no regular file");
}

/* The reader would wait for a pipe without a writer, and a device has no end. */
static void pipes_and_devices_are_not_read(void **state) {
    (void)state;
    char pipe[WH_TEST_PATH];
    assert_non_null(mkdtemp(wh_test_path(pipe, "stl")));
    assert_int_equal(rmdir(pipe), 0);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    assert_false(wh_stl_read(pipe, 1, &points, &count, message, sizeof message));
    assert_non_null(strstr(message, ": it is no regular file"));
    assert_int_equal(unlink(pipe), 0);
    assert_false(wh_stl_read("/dev/zero", 1, &points, &count, message, sizeof message));
    assert_string_equal(message, "/dev/zero: it is no regular file");
}

/* ------------------------------------------------------------------------------------------------------- bad */

static void assert_refused(double mm_per_unit, const char *why) {
    assert_false(parse(mm_per_unit));
    assert_string_equal(message, why);
    assert_null(points);
    assert_int_equal(count, 77);
}

static void bad_words_are_named(void **state) {
    (void)state;
    changed("vertex 0 10 0", "vertx 0 10 0");
    assert_refused(1, "part.stl:5: \"vertx\" (expected vertex)");
    changed("vertex 0 10 0", "vertex 0 1O 0");
    assert_refused(1, "part.stl:5: \"1O\" (expected a number)");
    changed("vertex 0 10 0", "vertex 0 inf 0");
    assert_refused(1, "part.stl:5: \"inf\" (expected a number)");
    changed("vertex 0 10 0", "vertex 0 \x01\xff 0");
    assert_refused(1, "part.stl:5: \"??\" (expected a number)");
    changed(" endloop", " vertex 1 1 1");
    assert_refused(1, "part.stl:7: \"vertex\" (expected endloop)");
    changed("FACET", "solid");
    assert_refused(1, "part.stl:16: \"solid\" (expected facet or endsolid)");
    changed("thing of many words\n", "\nsolid two");
    assert_refused(1, "part.stl:31: \"solid\" (expected the end of the file: one solid)");
    text("");
    assert_refused(
        1, "part.stl: 0 bytes (expected the word solid, or 80 bytes, a count of facets, and 50 bytes for "
           "each)");
}

/* A file that is cut off is refused, except within the name at its end. */
static void a_cut_text_is_refused(void **state) {
    (void)state;
    text(tetrahedron);
    const size_t whole = length;
    for (length = 0; length < whole - strlen(" thing of many words\n"); ++length) {
        assert_false(parse(1));
        assert_non_null(strstr(message, "part.stl:"));
    }
}

static void a_cut_binary_is_refused(void **state) {
    (void)state;
    prism(square, 4, 3);
    memcpy(bytes, "other", 5);
    const size_t whole = length;
    for (length = 0; length < whole; ++length) {
        assert_false(parse(1));
        assert_non_null(strstr(message, "expected the word solid"));
    }
}

static void numbers_out_of_range_are_named(void **state) {
    (void)state;
    text(tetrahedron);
    assert_refused(0, "part.stl: 0 mm a unit (expected a positive number)");
    assert_refused((double)NAN, "part.stl: nan mm a unit (expected a positive number)");
    assert_refused(1e5, "part.stl:5: a coordinate of 10 times 100000 mm (expected -100000 to 100000 mm)");
    prism(square, 4, 3);
    memset(bytes + 84 + 50 + 12, 0xff, 4);
    assert_false(parse(1));
    assert_non_null(strstr(message, "part.stl: byte 146: a coordinate of "));
    begin_binary("", WH_STL_FACETS + 1);
    static char large[80 + 4 + 50 * (WH_STL_FACETS + 1)];
    memcpy(large, bytes, length);
    assert_false(wh_stl_parse("x", large, sizeof large, 1, &points, &count, message, sizeof message));
    assert_string_equal(message, "x: more than 1000000 facets");
}

static void what_is_no_convex_body_is_refused(void **state) {
    (void)state;
    for (float height = 0.05F; height < 300; height *= 2) {
        prism(horseshoe, 8, height);
        assert_false(parse(1));
        assert_non_null(strstr(message, "mm off its plane, on either side (expected a convex body)"));
    }
    prism(square, 4, 0.001F);
    assert_refused(1,
                   "part.stl: 12 facets with 8 different corners (expected a body, at least 0.01 mm thick)");
    text("solid\nendsolid");
    assert_refused(1,
                   "part.stl: 0 facets with 0 different corners (expected a body, at least 0.01 mm thick)");
}

static void a_short_message_is_cut(void **state) {
    (void)state;
    text("no");
    assert_false(wh_stl_parse("part.stl", bytes, length, 1, &points, &count, message, 12));
    assert_string_equal(message, "part.stl: 2");
    assert_false(wh_stl_parse("part.stl", bytes, length, 1, &points, &count, message, 5));
    assert_string_equal(message, "part");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_text_is_read),
        cmocka_unit_test(a_binary_is_read_whatever_its_head_says),
        cmocka_unit_test(a_fine_polygon_is_convex),
        cmocka_unit_test(a_file_is_read),
        cmocka_unit_test(pipes_and_devices_are_not_read),
        cmocka_unit_test(bad_words_are_named),
        cmocka_unit_test(a_cut_text_is_refused),
        cmocka_unit_test(a_cut_binary_is_refused),
        cmocka_unit_test(numbers_out_of_range_are_named),
        cmocka_unit_test(what_is_no_convex_body_is_refused),
        cmocka_unit_test(a_short_message_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
