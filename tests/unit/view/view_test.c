/* The cell as Drake's viewer gets it: the viewer recognises it and draws it at its place, and never
 * receives a message that makes it exit. */
#include "support/layout.h"
#include "support/support.h"

#include "math/trig.h"
#include "view/geometry.h"
#include "view/view.h"

/* ------------------------------------------------------------------------------------------------- messages */

/* Taken from pydrake 1.51.1: drake.lcmt_viewer_load_robot._get_packed_fingerprint() and so on. */
static void fingerprints_are_drakes(void **state) {
    (void)state;
    assert_true((uint64_t)__waferhand_viewer_geometry_get_hash() == UINT64_C(0x5d2e34cb3257db07));
    assert_true((uint64_t)__waferhand_viewer_link_get_hash() == UINT64_C(0x51252725af982a63));
    assert_true((uint64_t)__waferhand_viewer_load_get_hash() == UINT64_C(0x8987209b10aa2d39));
    assert_true((uint64_t)__waferhand_viewer_draw_get_hash() == UINT64_C(0x414f0bfe5b2f4244));
}

static wh_mat3_t matrix_of(const float wxyz[4]) {
    const double w = (double)wxyz[0], x = (double)wxyz[1], y = (double)wxyz[2], z = (double)wxyz[3];
    const wh_mat3_t R = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
    return R;
}

static void assert_unit(const float q[4]) {
    double square = 0;
    for (size_t i = 0; i < 4; ++i) {
        square += (double)q[i] * (double)q[i];
    }
    assert_near(sqrt(square), 1, 1e-6);
}

/* Rotations that a step accepts are off by up to 1e-6; a drawn one must be a rotation all the same. */
static void turns_are_of_length_one(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(100, 20000, 0.3);
    while (wh_round(&rounds)) {
        const int i = rounds.number;
        const double limit = i % 2 ? 180 : 1e-4;
        wh_pose_t pose;
        float position[3], quaternion[4];
        pose.R = wh_mat3_from_rpy_deg(wh_test_uniform(-limit, limit), wh_test_uniform(-90, 90) * (i % 3 == 0),
                                      wh_test_uniform(-180, 180));
        pose.R.m[wh_test_below(3)][wh_test_below(3)] += wh_test_uniform(-4e-7, 4e-7);
        pose.r = wh_vec3(wh_test_uniform(-2000, 2000), wh_test_uniform(-2000, 2000), 900);
        assert_int_equal(wh_pose_validate(&pose), WH_OK);
        wh_view_put_pose(&pose, position, quaternion);
        assert_unit(quaternion);
        const wh_mat3_t back = matrix_of(quaternion);
        for (size_t k = 0; k < 9; ++k) {
            assert_near(back.m[k / 3][k % 3], pose.R.m[k / 3][k % 3], 2e-6);
        }
        assert_near(position[0], pose.r.x / 1000, 1e-6);
        assert_near(position[1], pose.r.y / 1000, 1e-6);
        assert_near(position[2], 0.9, 1e-7);
    }
}

/* -------------------------------------------------------------------------------------------------- shapes */

static const wh_view_colour_t grey = {{0.5F, 0.5F, 0.5F, 1}};

static waferhand_viewer_geometry made(const wh_convex_t *convex, bool as_box) {
    waferhand_viewer_geometry geometry;
    assert_int_equal(wh_convex_validate(convex), WH_OK);
    wh_view_geometry_make(convex, &convex->body_from_shape, &grey, as_box, &geometry);
    assert_unit(geometry.quaternion);
    return geometry;
}

static void check_numbers(const wh_convex_t *convex, int type, size_t count, const double expected_m[]) {
    waferhand_viewer_geometry geometry = made(convex, false);
    assert_int_equal(geometry.type, type);
    assert_int_equal(geometry.num_float_data, count);
    for (size_t i = 0; i < count; ++i) {
        assert_near(geometry.float_data[i], expected_m[i], 1e-7 * expected_m[i]);
    }
    assert_string_equal(geometry.string_data, "");
    wh_view_geometry_free(&geometry);
}

static void shapes_are_in_metres(void **state) {
    const wh_pose_t here = wh_pose_identity();
    const wh_convex_t box = {.kind = WH_CONVEX_BOX, .half = {10, 20, 30}, .body_from_shape = here};
    const wh_convex_t disc = {.kind = WH_CONVEX_CYLINDER, .half = {150, 7, 0.3875}, .body_from_shape = here};
    const wh_convex_t rod = {.kind = WH_CONVEX_CAPSULE, .half = {5, 7, 40}, .body_from_shape = here};
    const wh_convex_t ball = {.kind = WH_CONVEX_CAPSULE, .half = {5, 7, 0}, .body_from_shape = here};
    (void)state;
    check_numbers(&box, WH_VIEW_BOX, 3, (const double[]){0.02, 0.04, 0.06});
    check_numbers(&disc, WH_VIEW_CYLINDER, 2, (const double[]){0.15, 0.000775});
    check_numbers(&rod, WH_VIEW_CAPSULE, 2, (const double[]){0.005, 0.08});
    check_numbers(&ball, WH_VIEW_SPHERE, 1, (const double[]){0.005});
}

/* A box with a point inside, two points the same: 8 points and 12 triangles are left, which enclose
 * its volume. */
static const wh_vec3_t corners[] = {{0, 0, 0},    {100, 0, 0}, {0, 60, 0},    {0, 0, 40},   {100, 60, 0},
                                    {100, 0, 40}, {0, 60, 40}, {100, 60, 40}, {50, 30, 20}, {0, 0, 0}};

static wh_convex_t block(void) {
    wh_convex_t convex = {.kind = WH_CONVEX_MESH, .points = corners, .point_count = 10};
    convex.body_from_shape.R = wh_mat3_from_rpy_deg(0, 0, 90);
    convex.body_from_shape.r = wh_vec3(1000, 0, 0);
    return convex;
}

static wh_vec3_t point_of(const float *points, float index) {
    const float *at = points + 3 * (size_t)index;
    return wh_vec3((double)at[0], (double)at[1], (double)at[2]);
}

static void mesh_is_a_closed_hull(void **state) {
    const wh_convex_t convex = block();
    waferhand_viewer_geometry geometry = made(&convex, false);
    const float *points = geometry.float_data + 2;
    const float *triangle = points + 3 * 8;
    double volume = 0;
    (void)state;
    assert_int_equal(geometry.type, WH_VIEW_TRIANGLES);
    assert_int_equal(geometry.num_float_data, 2 + 3 * 8 + 3 * 12);
    assert_near(geometry.float_data[0], 8, 0);
    assert_near(geometry.float_data[1], 12, 0);
    for (size_t i = 0; i < 12; ++i, triangle += 3) {
        assert_true(triangle[0] < 8 && triangle[1] < 8 && triangle[2] < 8);
        const wh_vec3_t a = point_of(points, triangle[0]);
        const wh_vec3_t b = point_of(points, triangle[1]);
        const wh_vec3_t c = point_of(points, triangle[2]);
        const wh_vec3_t bc = wh_vec3_cross(&b, &c);
        volume += wh_vec3_dot(&a, &bc) / 6;
    }
    assert_near(volume, 0.1 * 0.06 * 0.04, 1e-9);
    assert_near(geometry.position[0], 1, 1e-7);
    wh_view_geometry_free(&geometry);
}

static void mesh_as_the_box_about_it(void **state) {
    const wh_convex_t convex = block();
    waferhand_viewer_geometry geometry = made(&convex, true);
    (void)state;
    assert_int_equal(geometry.type, WH_VIEW_BOX);
    assert_near(geometry.float_data[0], 0.1, 1e-7);
    assert_near(geometry.float_data[1], 0.06, 1e-7);
    assert_near(geometry.float_data[2], 0.04, 1e-7);
    assert_near(geometry.position[0], 1 - 0.03, 1e-6);
    assert_near(geometry.position[1], 0.05, 1e-6);
    assert_near(geometry.position[2], 0.02, 1e-6);
    wh_view_geometry_free(&geometry);
}

/* ---------------------------------------------------------------------------------------------------- cells */

#define CELL                                                                                                 \
    "tolerance = 'strict', collision = true, grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, "    \
    "stations = { A = { kind = 'foup', at = { 700, 0, 900 }, slots = 5 }, "                                  \
    "P = { kind = 'prealigner', at = { -600, 0, 950 }, rpy = { 0, 0, 180 } } }, "                            \
    "obstacles = { { name = 'ball', capsule = { radius = 20, height = 0 }, at = { 0, 900, 300 } }, "         \
    "{ name = 'wall', box = { 10, 900, 900 }, at = { -900, 0, 450 } } }, "                                   \
    "wafers = { { name = 'a/b%', station = 'A', slot = 1 }, { name = 'a::b', station = 'A', slot = 2 } }"

static void check_geometry(const waferhand_viewer_geometry *geometry) {
    static const int32_t counts[] = {0, 3, 1, 2, -1, 2};
    assert_in_range(geometry->type, WH_VIEW_BOX, WH_VIEW_CAPSULE);
    assert_int_equal(geometry->num_float_data, counts[geometry->type]);
    for (int32_t i = 0; i < geometry->num_float_data; ++i) {
        assert_true(geometry->float_data[i] > 0 && geometry->float_data[i] < 10);
    }
    for (size_t i = 0; i < 4; ++i) {
        assert_true(geometry->color[i] >= 0 && geometry->color[i] <= 1);
    }
    assert_unit(geometry->quaternion);
}

static void bodies_of_a_cell(void **state) {
    wh_view_cell_t cell;
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    wh_view_cell_open(&cell, layout, WH_VIEW_ALL);
    size_t shapes = 0;
    assert_int_equal(cell.bodies.load.num_links, 1 + 2 + WH_ARM_BODIES + 2 + 2 + 2);
    assert_int_equal(cell.bodies.draw.num_links, cell.bodies.load.num_links);
    for (int32_t i = 0; i < cell.bodies.load.num_links; ++i) {
        const waferhand_viewer_link *body = &cell.bodies.load.link[i];
        assert_string_equal(cell.bodies.draw.link_name[i], body->name);
        assert_int_equal(body->robot_num, 0);
        assert_int_equal(cell.bodies.draw.robot_num[i], 0);
        assert_unit(cell.bodies.draw.quaternion[i]);
        for (int32_t k = 0; k < i; ++k) {
            assert_string_not_equal(cell.bodies.load.link[k].name, body->name);
        }
        for (int32_t k = 0; k < body->num_geom; ++k, ++shapes) {
            check_geometry(&body->geom[k]);
        }
    }
    /* Every part, two covers, two wafers with their notches. */
    assert_int_equal(shapes, layout->world.part_count + 2 + 2 * 2);
    assert_string_equal(cell.bodies.load.link[0].name, "obstacles");
    assert_string_equal(cell.bodies.load.link[1].name, "stations::A");
    assert_string_equal(cell.bodies.load.link[cell.links + 3].name, "robot::forearm");
    assert_string_equal(cell.bodies.load.link[cell.grippers].name, "grippers::EE");
    assert_string_equal(cell.bodies.load.link[cell.covers + 1].name, "held::PA");
    assert_string_equal(cell.bodies.load.link[cell.wafers].name, "wafers::a%2Fb%25");
    assert_string_equal(cell.bodies.load.link[cell.wafers + 1].name, "wafers::a%3A%3Ab");
    wh_view_cell_free(&cell);
}

/* The viewer splits names at "::", and Drake itself at "/": a body is three steps deep, whatever
 * its name is. */
static void names_of_any_bytes(void **state) {
    static const char *const names[][2] = {{"\xff/\n", "wafers::%FF%2F%0A"},
                                           {"Gr\xc3\xbc\xc3\x9f", "wafers::Gr\xc3\xbc\xc3\x9f"},
                                           {"\xc3", "wafers::%C3"},
                                           {"100%", "wafers::100%25"}};
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        wh_layout_t own = *layout;
        wh_layout_wafer_t wafers[2];
        wh_view_cell_t cell;
        memcpy(wafers, layout->wafers, sizeof wafers);
        snprintf(wafers[0].name, sizeof wafers[0].name, "%s", names[i][0]);
        own.wafers = wafers;
        wh_view_cell_open(&cell, &own, WH_VIEW_ALL);
        assert_string_equal(cell.bodies.load.link[cell.wafers].name, names[i][1]);
        wh_view_cell_free(&cell);
    }
}

static void assert_at(const wh_view_cell_t *cell, size_t body, const wh_vec3_t *mm) {
    assert_near(cell->bodies.draw.position[body][0], mm->x / 1000, 2e-7);
    assert_near(cell->bodies.draw.position[body][1], mm->y / 1000, 2e-7);
    assert_near(cell->bodies.draw.position[body][2], mm->z / 1000, 2e-7);
}

static void assert_away(const wh_view_cell_t *cell, size_t body) {
    const wh_vec3_t away = {0, 0, -WH_VIEW_AWAY};
    assert_at(cell, body, &away);
}

static void bodies_are_where_they_are(void **state) {
    wh_view_cell_t cell;
    wh_pose_t grippers[2] = {wh_pose_identity(), wh_pose_identity()};
    wh_wafer_t wafers[2];
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    memcpy(wafers, layout->start, sizeof wafers);
    wh_view_cell_open(&cell, layout, WH_VIEW_ALL);
    assert_at(&cell, cell.wafers + 1, &layout->start[1].base_from_wafer.r);
    assert_at(&cell, 1, &layout->places[0].base_from_station.r);
    assert_near(cell.bodies.draw.position[cell.grippers][0], 0.3, 1e-7); /* at home */
    assert_away(&cell, cell.covers);
    assert_away(&cell, cell.covers + 1);

    grippers[0].r = wh_vec3(0, 500, 1000);
    grippers[0].R = wh_mat3_from_rpy_deg(0, 0, 90);
    grippers[1].r = wh_vec3(-600, 0, 950);
    wafers[1].base_from_wafer = grippers[0];
    wafers[1].base_from_wafer.r.z += 0.4;
    wafers[1].holder = 0;
    const wh_view_look_t look = {1234567, grippers, NULL, NULL, wafers};
    wh_view_cell_move(&cell, &look);
    assert_true(cell.bodies.draw.timestamp == 1234);
    assert_at(&cell, cell.grippers, &grippers[0].r);
    assert_at(&cell, cell.grippers + 1, &grippers[1].r);
    assert_at(&cell, cell.wafers, &wafers[0].base_from_wafer.r);
    assert_at(&cell, cell.wafers + 1, &wafers[1].base_from_wafer.r);
    assert_at(&cell, cell.covers, &wafers[1].base_from_wafer.r);
    assert_away(&cell, cell.covers + 1);
    /* The hand is behind the blade, along its x. */
    const wh_vec3_t hand = {0, 500 - layout->shapes.arm.reach, 1000};
    assert_at(&cell, cell.links + WH_ARM_HAND, &hand);
    assert_near(cell.bodies.draw.quaternion[cell.grippers][3], sqrt(0.5), 1e-7);
    wh_view_cell_free(&cell);
}

/* A wafer is drawn on its back face; its cover is larger, and the notch's mark is larger still. */
static void wafers_and_covers(void **state) {
    wh_view_cell_t cell;
    (void)state;
    wh_view_cell_open(&cell, read_sound(CELL ", wafer = { diameter = 200, thickness = 0.7 }"), WH_VIEW_ALL);
    const waferhand_viewer_link *wafer = &cell.bodies.load.link[cell.wafers];
    const waferhand_viewer_link *cover = &cell.bodies.load.link[cell.covers];
    assert_int_equal(wafer->num_geom, 2);
    assert_near(wafer->geom[0].float_data[0], 0.1, 1e-8);
    assert_near(wafer->geom[0].float_data[1], 0.0007, 1e-9);
    assert_near(wafer->geom[0].position[2], 0.00035, 1e-9);
    assert_near(cover->geom[0].float_data[0], 0.10025, 1e-8);
    assert_near(cover->geom[0].float_data[1], 0.0012, 1e-9);
    assert_near(cover->geom[0].position[2], 0.00035, 1e-9);
    assert_near(wafer->geom[1].float_data[2], 0.0017, 1e-9);
    assert_memory_not_equal(cover->geom[0].color, cell.bodies.load.link[cell.covers + 1].geom[0].color,
                            sizeof cover->geom[0].color);
    wh_view_cell_free(&cell);
}

/* ----------------------------------------------------------------------------------------------------- hits */

static const float *colour_of_body(const wh_view_cell_t *cell, size_t body, size_t shape) {
    return cell->bodies.load.link[body].geom[shape].color;
}

static bool is_red(const float rgba[4]) {
    return rgba[0] > 0.8F && rgba[1] < 0.1F && rgba[2] < 0.2F && rgba[3] >= 1;
}

static size_t count_red(const wh_view_cell_t *cell) {
    size_t count = 0;
    for (int32_t i = 0; i < cell->bodies.load.num_links; ++i) {
        for (int32_t k = 0; k < cell->bodies.load.link[i].num_geom; ++k) {
            count += is_red(colour_of_body(cell, (size_t)i, (size_t)k));
        }
    }
    return count;
}

/* The first part of a kind and owner. */
static int32_t part_of(const wh_layout_t *layout, wh_part_kind_t kind, int32_t owner) {
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        if (layout->world.parts[i].kind == kind && layout->world.parts[i].owner == owner) {
            return (int32_t)i;
        }
    }
    return WH_NONE;
}

static void what_collided_is_red_and_nothing_else(void **state) {
    static const int32_t none[2] = {WH_NONE, WH_NONE};
    wh_view_cell_t cell;
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    wh_view_cell_open(&cell, layout, WH_VIEW_ALL);
    const int size = waferhand_viewer_load_encoded_size(&cell.bodies.load);
    uint8_t *plain = calloc((size_t)size, 1), *again = calloc((size_t)size, 1);
    assert_non_null(plain);
    assert_non_null(again);
    assert_int_equal(waferhand_viewer_load_encode(plain, 0, size, &cell.bodies.load), size);
    assert_false(wh_view_cell_set_hit(&cell, none));
    for (int32_t part = 0; part < (int32_t)(layout->world.part_count + 2); ++part) {
        const int32_t parts[2] = {part, part_of(layout, WH_PART_BLADE, 0)};
        assert_true(wh_view_cell_set_hit(&cell, parts));
        assert_false(wh_view_cell_set_hit(&cell, parts));
        assert_int_equal(count_red(&cell), part == parts[1] ? 1 : 2);
        assert_true(is_red(colour_of_body(&cell, cell.grippers, 0)));
    }
    const int32_t beyond[2] = {(int32_t)(layout->world.part_count + 2), -7};
    assert_true(wh_view_cell_set_hit(&cell, beyond));
    assert_int_equal(waferhand_viewer_load_encode(again, 0, size, &cell.bodies.load), size);
    assert_memory_equal(plain, again, (size_t)size);
    free(plain);
    free(again);
    wh_view_cell_free(&cell);
}

/* Its cover would hide that it is red. */
static void a_red_wafer_is_not_covered(void **state) {
    wh_view_cell_t cell;
    const wh_pose_t grippers[2] = {wh_pose_identity(), wh_pose_identity()};
    wh_wafer_t wafers[2];
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    memcpy(wafers, layout->start, sizeof wafers);
    wafers[0].holder = WH_NONE;
    wafers[1].holder = 0;
    wh_view_cell_open(&cell, layout, WH_VIEW_ALL);
    const int32_t parts[2] = {WH_NONE, (int32_t)layout->world.part_count + 1};
    const wh_view_look_t look = {1000, grippers, NULL, NULL, wafers};
    wh_view_cell_move(&cell, &look);
    assert_at(&cell, cell.covers, &wafers[1].base_from_wafer.r);
    assert_true(wh_view_cell_set_hit(&cell, parts));
    wh_view_cell_move(&cell, &look);
    assert_away(&cell, cell.covers);
    assert_true(is_red(colour_of_body(&cell, cell.wafers + 1, 0)));
    wh_view_cell_free(&cell);
}

/* ---------------------------------------------------------------------------------------------------- board */

static const waferhand_viewer_link *body_of(const wh_view_board_t *board, const char *name) {
    for (int32_t i = 0; i < board->bodies.load.num_links; ++i) {
        assert_string_equal(board->bodies.load.link[i].name, board->bodies.draw.link_name[i]);
        if (strcmp(board->bodies.load.link[i].name, name) == 0) {
            return &board->bodies.load.link[i];
        }
    }
    fail_msg("no body %s", name);
    return NULL;
}

/* The text of a line, read back from the mesh alone: the state of each dot of each character. */
static void read_dots(const wh_view_board_t *board, const char *name, char *rows, size_t columns) {
    const waferhand_viewer_link *body = body_of(board, name);
    memset(rows, '.', 7 * columns);
    if (body->num_geom == 0) {
        return;
    }
    const float *numbers = body->geom[0].float_data;
    const size_t points = (size_t)numbers[0], triangles = (size_t)numbers[1];
    assert_int_equal(body->geom[0].num_float_data, 2 + 3 * points + 3 * triangles);
    assert_int_equal(points, 2 * triangles);
    for (size_t i = 0; i < 3 * triangles; ++i) {
        assert_in_range(numbers[2 + 3 * points + i], 0, points - 1);
    }
    for (size_t i = 0; i < points; i += 4) { /* left lower, right lower, right upper, left upper */
        const float *at = numbers + 2 + 3 * i;
        for (size_t row = 0; row < 7; ++row) {
            for (size_t column = 0; column < columns; ++column) {
                const double x = ((double)column + 0.5) * board->dot / 1000;
                const double y = -((double)row + 0.5) * board->dot / 1000;
                if (x > (double)at[0] && x < (double)at[3] && y > (double)at[1] && y < (double)at[7]) {
                    assert_int_equal(rows[row * columns + column], '.'); /* no dot twice */
                    rows[row * columns + column] = '#';
                }
            }
        }
    }
}

static void the_board_writes_capitals(void **state) {
    static wh_view_board_t board;
    char rows[7 * 12], same[7 * 12];
    (void)state;
    wh_view_board_open(&board, read_sound(CELL));
    assert_true(wh_view_board_write(&board, WH_VIEW_HIT, "T\xc3\xa9"));
    read_dots(&board, "board::hit", rows, 12);
    assert_memory_equal(rows,
                        "#####.#####."
                        "..#...#...#."
                        "..#...#...#."
                        "..#...#...#."
                        "..#...#...#."
                        "..#...#...#."
                        "..#...#####.",
                        sizeof rows);
    assert_false(wh_view_board_write(&board, WH_VIEW_HIT, "T\xc3\xa9"));
    for (int c = ' '; c < 127; ++c) { /* no two characters look alike, except for capitals and boxes */
        const char text[2] = {(char)c, '\0'};
        (void)wh_view_board_write(&board, WH_VIEW_HIT, text);
        (void)wh_view_board_write(&board, WH_VIEW_HIT_WITH, "x");
        read_dots(&board, "board::hit", rows, 12);
        read_dots(&board, "board::with", same, 12);
        assert_int_equal(memcmp(rows, same, sizeof rows) == 0, c == 'x' || c == 'X');
        assert_int_equal(body_of(&board, "board::hit")->num_geom, c != ' ');
    }
    wh_view_board_free(&board);
}

/* However long and odd the lines are, the message has room for them. */
static void a_line_is_cut_off_at_the_edge(void **state) {
    static wh_view_board_t board;
    char text[400];
    (void)state;
    wh_view_board_open(&board, read_sound(CELL));
    wh_rounds_t rounds = WH_ROUNDS(4 * WH_VIEW_LINES, 2000, 0.5);
    while (wh_round(&rounds)) {
        const int i = rounds.number;
        const size_t length = wh_test_below(sizeof text - 1);
        for (size_t k = 0; k < length; ++k) {
            text[k] = (char)(i / WH_VIEW_LINES % 20 == 0 ? '%' : 1 + (int)wh_test_below(255));
        }
        text[length] = '\0';
        (void)wh_view_board_write(&board, (wh_view_line_t)(i % WH_VIEW_LINES), text);
        assert_in_range(waferhand_viewer_load_encoded_size(&board.bodies.load), 1,
                        wh_view_board_room(&board));
        assert_true(strlen(board.lines[i % WH_VIEW_LINES]) <= WH_VIEW_COLUMNS);
    }
    assert_in_range(wh_view_board_room(&board), 1, WH_VIEW_BYTES);
    assert_in_range(waferhand_viewer_draw_encoded_size(&board.bodies.draw), 1, WH_LINK_DATAGRAM);
    wh_view_board_free(&board);
}

/* Bit s of each digit: whether its segment s is visible. */
static void segments_of(const wh_view_board_t *board, unsigned digits[WH_VIEW_DIGITS]) {
    memset(digits, 0, WH_VIEW_DIGITS * sizeof *digits);
    for (int32_t i = 0; i < board->bodies.draw.num_links; ++i) {
        const char *name = board->bodies.draw.link_name[i];
        assert_unit(board->bodies.draw.quaternion[i]);
        if (strncmp(name, "board::time ", 12) == 0 && board->bodies.draw.position[i][2] > -100) {
            digits[name[12] - '1'] |= 1U << (unsigned)(name[13] - 'a');
        }
    }
}

static void the_board_shows_the_time(void **state) {
    static const unsigned shapes[10] = {0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f};
    static const int64_t tenths[] = {0, 1, 82, 99, 100, 12345, 999999, 1000000, 1234567};
    static wh_view_board_t board;
    unsigned digits[WH_VIEW_DIGITS];
    char text[32];
    (void)state;
    wh_view_board_open(&board, read_sound(CELL));
    for (size_t i = 0; i < sizeof tenths / sizeof tenths[0]; ++i) {
        assert_int_equal(wh_view_board_set_time(&board, tenths[i] * 100000), tenths[i] > 0);
        assert_false(wh_view_board_set_time(&board, tenths[i] * 100000 + 99999));
        assert_true(board.bodies.draw.timestamp == tenths[i] * 100 + 99);
        segments_of(&board, digits);
        snprintf(text, sizeof text, "%6lld", (long long)(tenths[i] % 1000000));
        for (size_t k = 0; k < WH_VIEW_DIGITS; ++k) {
            const bool is_blank = tenths[i] % 1000000 < 10 ? k < 4 : text[k] == ' ';
            const unsigned digit = text[k] == ' ' ? 0 : (unsigned)(text[k] - '0');
            assert_int_equal(digits[k], is_blank ? 0 : shapes[digit]);
        }
    }
    wh_view_board_free(&board);
}

static const float *segment_at(const wh_view_board_t *board, char segment) {
    char name[] = "board::time 1a";
    name[sizeof name - 2] = segment;
    const waferhand_viewer_link *body = body_of(board, name);
    assert_int_equal(body->num_geom, 1);
    return body->geom[0].position;
}

/* Three that lie above each other, and a pair with one on either side of the upper and the lower half. */
static void a_digits_segments_are_mirror_images(void **state) {
    static wh_view_board_t board;
    (void)state;
    wh_view_board_open(&board, read_sound(CELL));
    const float *middle = segment_at(&board, 'g');
    const struct {
        char one, other;
        int axis; /* the axis along which the middle is between them */
    } pairs[] = {{'a', 'd', 1}, {'b', 'f', 0}, {'c', 'e', 0}, {'b', 'c', 1}, {'f', 'e', 1}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i) {
        const float *one = segment_at(&board, pairs[i].one), *other = segment_at(&board, pairs[i].other);
        const int axis = pairs[i].axis;
        assert_near((double)(one[axis] + other[axis]) / 2, (double)middle[axis], 1e-6);
        assert_near((double)one[1 - axis], (double)other[1 - axis], 1e-6);
        assert_true(fabsf(one[axis] - other[axis]) > 0.01F);
    }
    assert_near((double)segment_at(&board, 'a')[0], (double)middle[0], 1e-6);
    wh_view_board_free(&board);
}

/* Behind and above all bodies, and readable from the camera's start. */
static void the_board_stands_behind_the_cell(void **state) {
    static wh_view_board_t board;
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    wh_view_board_open(&board, layout);
    const wh_pose_t *pose = &board.base_from_board;
    assert_int_equal(wh_pose_validate(pose), WH_OK);
    const wh_vec3_t normal = wh_mat3_column(&pose->R, 2), up = wh_mat3_column(&pose->R, 1);
    assert_true(wh_vec3_dot(&normal, &wh_view_from) > 0 && up.z > 0.999);
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_vec3_t from_board =
            wh_vec3_subtract(&layout->places[s].base_from_station.r, &board.base_from_board.r);
        assert_true(wh_vec3_dot(&from_board, &normal) > 0 && from_board.z < 0);
    }
    wh_view_board_free(&board);
}

/* ----------------------------------------------------------------------------------------------- large cells */

/* A cell with this many parts of one kind, and how many of them were shown; WH_VIEW_DETAILS: refused. */
static wh_view_detail_t detail_with(wh_part_kind_t kind, size_t count, const wh_convex_t *convex) {
    wh_layout_t own = *read_sound(CELL);
    wh_part_t *parts = calloc(count, sizeof *parts);
    static wh_viewer_t view;
    assert_non_null(parts);
    for (size_t i = 0; i < count; ++i) {
        parts[i].kind = kind;
        parts[i].owner = kind == WH_PART_LEDGE ? 0 : WH_NONE;
        parts[i].convex = *convex;
    }
    own.world.parts = parts;
    own.world.part_count = count;
    wh_view_detail_t detail = WH_VIEW_DETAILS;
    if (wh_viewer_open(&view, NULL, &own) == WH_OK) {
        detail = view.cell.detail;
        assert_true(view.cell_bytes.load_size <= WH_VIEW_BYTES);
        wh_viewer_close(&view);
    }
    free(parts);
    return detail;
}

static void what_a_large_cell_leaves_out(void **state) {
    const wh_convex_t mesh = block();
    const wh_convex_t box = {.kind = WH_CONVEX_BOX, .half = {1, 1, 1}, .body_from_shape = wh_pose_identity()};
    (void)state;
    assert_int_equal(detail_with(WH_PART_LEDGE, 2000, &box), WH_VIEW_ALL);
    if (WH_TEST_SHARE > 10) {
        return; /* the others do the same, with more parts */
    }
    assert_int_equal(detail_with(WH_PART_LEDGE, 20000, &box), WH_VIEW_NO_LEDGES);
    assert_int_equal(detail_with(WH_PART_FIXED, 600, &mesh), WH_VIEW_ALL);
    assert_int_equal(detail_with(WH_PART_FIXED, 1000, &mesh), WH_VIEW_BOXES);
    assert_int_equal(detail_with(WH_PART_FIXED, 20000, &box), WH_VIEW_DETAILS);
}

/* ------------------------------------------------------------------------------------------------- sending */

static void step_once(wh_protocol_server_t *server) {
    ++server->seq;
}

/* The test plays the clock by changing the noted time. */
static void what_is_due_when(void **state) {
    static wh_protocol_server_t server;
    static wh_viewer_t view;
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    assert_int_equal(wh_protocol_server_open(&server, layout), WH_OK);
    assert_int_equal(wh_viewer_open(&view, NULL, layout), WH_OK);
    wh_viewer_tick(&view, &server);
    assert_true(view.loads == 1 && view.draws == 1);
    wh_viewer_tick(&view, &server); /* nothing has moved */
    assert_true(view.loads == 1 && view.draws == 1);

    step_once(&server);
    view.last_draw_us = wh_node_clock_us();
    view.last_load_us = view.last_draw_us;
    wh_viewer_tick(&view, &server); /* too early */
    assert_true(view.loads == 1 && view.draws == 1);
    view.last_draw_us -= WH_VIEW_DRAW_US;
    wh_viewer_tick(&view, &server); /* late, but told */
    assert_true(view.loads == 1 && view.draws == 2);
    view.last_draw_us -= WH_VIEW_DRAW_US;
    wh_viewer_tick(&view, &server);
    assert_true(view.loads == 1 && view.draws == 2);

    view.last_load_us -= WH_VIEW_LOAD_US;
    wh_viewer_tick(&view, &server); /* at rest: both, for viewers that came later */
    assert_true(view.loads == 2 && view.draws == 3);
    ++server.identity.run;
    view.last_draw_us -= WH_VIEW_DRAW_US;
    wh_viewer_tick(&view, &server); /* the same slice of another run */
    assert_true(view.loads == 2 && view.draws == 4);
    assert_true(view.unsent == 0);
    wh_viewer_close(&view);
    wh_protocol_server_close(&server);
}

/* A hit is sent at once, stays, and is removed with the next run; so is the command. */
static void hits_and_commands_go_out(void **state) {
    static wh_protocol_server_t server;
    static wh_viewer_t view;
    static wh_event_t events[1] = {{.kind = WH_EVENT_HIT}};
    char command[] = "GET A 1";
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    assert_int_equal(wh_protocol_server_open(&server, layout), WH_OK);
    assert_int_equal(wh_viewer_open(&view, NULL, layout), WH_OK);
    view.command = command;
    wh_viewer_tick(&view, &server);
    assert_true(view.loads == 1);
    assert_string_equal(view.board.lines[WH_VIEW_COMMAND], "GET A 1");

    events[0].parts[0] = part_of(layout, WH_PART_BLADE, 0);
    events[0].parts[1] = (int32_t)layout->world.part_count + 1;
    const wh_event_t *const own = server.state.events;
    server.state.events = events;
    server.state.event_count = 1;
    step_once(&server);
    wh_viewer_tick(&view, &server); /* too early to be sent, but it is not forgotten */
    server.state.events = own;
    server.state.event_count = 0;
    assert_true(view.loads == 1 && count_red(&view.cell) == 2);
    assert_string_equal(view.board.lines[WH_VIEW_HIT_WITH], "and a::b");
    view.last_draw_us -= WH_VIEW_DRAW_US;
    wh_viewer_tick(&view, &server);
    assert_true(view.loads == 2 && view.draws == 2);
    view.last_draw_us -= WH_VIEW_DRAW_US;
    wh_viewer_tick(&view, &server);
    assert_true(view.loads == 2 && view.draws == 2);

    ++server.identity.run;
    command[0] = '\0';
    view.last_draw_us -= WH_VIEW_DRAW_US;
    wh_viewer_tick(&view, &server);
    assert_true(view.loads == 3 && count_red(&view.cell) == 0);
    assert_string_equal(view.board.lines[WH_VIEW_HIT], "");
    assert_string_equal(view.board.lines[WH_VIEW_COMMAND], "");
    wh_viewer_close(&view);
    wh_protocol_server_close(&server);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fingerprints_are_drakes),
        cmocka_unit_test(turns_are_of_length_one),
        cmocka_unit_test(shapes_are_in_metres),
        cmocka_unit_test(mesh_is_a_closed_hull),
        cmocka_unit_test(mesh_as_the_box_about_it),
        cmocka_unit_test_setup_teardown(bodies_of_a_cell, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(names_of_any_bytes, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(bodies_are_where_they_are, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(wafers_and_covers, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(what_collided_is_red_and_nothing_else, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(a_red_wafer_is_not_covered, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(the_board_writes_capitals, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(a_line_is_cut_off_at_the_edge, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(the_board_shows_the_time, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(a_digits_segments_are_mirror_images, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(the_board_stands_behind_the_cell, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(hits_and_commands_go_out, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(what_a_large_cell_leaves_out, open_sandbox, close_sandbox),
        cmocka_unit_test_setup_teardown(what_is_due_when, open_sandbox, close_sandbox),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
