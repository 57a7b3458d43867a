/* The reach of a gripper's horizon, to the number: the margin for rounding, values that a word
 * cannot hold, and that it ends before any wafer matters. tests/property/horizon_random.c shows
 * that horizons change no result. */
#include "grasp/grasp_internal.h"
#include "grasp/horizon_internal.h"
#include "support/grasp.h"

#if defined(WH_FLOAT)
#define EPSILON FLT_EPSILON
#else
#define EPSILON DBL_EPSILON
#endif

/* In units: the longest horizon. */
#define LONGEST 536870912

typedef struct {
    cell_t cell;
    uint32_t buckets[WH_GRASP_BUCKETS(CELL_WAFERS, CELL_GRIPPERS)];
} fixture_t;

/* The tests ask about gripper G. */
enum { G = 1 };

static void begin(fixture_t *fixture, double projz, double projxy) {
    wh_grasp_config_t config = wh_grasp_config_default();
    config.tolerance.projz = WH_REAL(0.5);
    config.tolerance.projxy = WH_REAL(0.25);
    config.near_projz = WH_REAL(projz);
    config.near_projxy = WH_REAL(projxy);
    cell_begin(&fixture->cell, &config);
    wh_grasp_storage_t storage = fixture->cell.table.storage;
    memset(fixture->buckets, 0xa5, sizeof fixture->buckets);
    storage.buckets = fixture->buckets;
    storage.bucket_count = wh_grasp_buckets(CELL_WAFERS, CELL_GRIPPERS);
    assert_int_equal(wh_grasp_init(&fixture->cell.table, &config, &storage), WH_OK);
}

static wh_vec3_t vector(double x, double y, double z) {
    return (wh_vec3_t){WH_REAL(x), WH_REAL(y), WH_REAL(z)};
}

static uint32_t *words(const fixture_t *fixture) {
    return wh_horizon_words(&fixture->cell.table, G);
}

static void store(fixture_t *fixture, const wh_vec3_t *place, double gap) {
    const wh_horizon_t horizon = {.gap = WH_REAL(gap)};
    wh_horizon_store(&fixture->cell.table, G, place, &horizon);
}

static bool covers(const fixture_t *fixture, double x, double y, double z) {
    const wh_vec3_t place = vector(x, y, z);
    return wh_horizon_is_clear_at(&fixture->cell.table, G, &place);
}

static void words_are_each_grippers_own(void **state) {
    (void)state;
    fixture_t fixture;
    begin(&fixture, 4, 60);
    for (size_t g = 0; g < CELL_GRIPPERS; ++g) {
        assert_ptr_equal(wh_horizon_words(&fixture.cell.table, g), fixture.buckets + 8 + 4 * g);
        assert_int_equal(wh_horizon_words(&fixture.cell.table, g)[3], 0);
        assert_false(wh_horizon_is_clear(&fixture.cell.table, g));
    }
    wh_horizon_note(&fixture.cell.table, G, true);
    for (size_t g = 0; g < CELL_GRIPPERS; ++g) {
        assert_true(wh_horizon_is_clear(&fixture.cell.table, g) == (g == G));
        wh_horizon_words(&fixture.cell.table, g)[3] = UINT32_MAX;
    }
    uint32_t *next = &fixture.buckets[8 + 4 * CELL_GRIPPERS];
    const uint32_t others[4] = {7, 7, 7, 7};
    memcpy(next, others, sizeof others);
    wh_horizon_reset(&fixture.cell.table);
    for (size_t g = 0; g < CELL_GRIPPERS; ++g) {
        assert_int_equal(wh_horizon_words(&fixture.cell.table, g)[3], 0);
    }
    assert_memory_equal(next, others, sizeof others);
}

/* A table without buckets has no horizon. It notes if no wafer was near in this step, so that a
 * step looks at all of them once: they lie 1000 mm apart along x. */
static void without_buckets_it_is_noted_that_nothing_is_near(void **state) {
    (void)state;
    static const struct {
        double x, y, z;
        bool clear;
    } cases[] = {{500, 0, 0, true},   {0, 500, 0, true},  {-500, 0, 0, true}, {0, -500, 0, true},
                 {0, 0, 1000, true},  {0, 0, -5, true},   {0, 0, -4, false},  {70, 70, -1, false},
                 {3000, 0, 4, false}, {0, 0, 1e30, true}, {1e30, 0, 0, true}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        cell_t cell;
        cell_begin_default(&cell);
        const wh_pose_t pose = wh_test_at(cases[i].x, cases[i].y, cases[i].z);
        assert_int_equal(wh_grasp_find_ready(&cell.table, G, &pose), WH_NONE);
        assert_true(wh_horizon_is_clear(&cell.table, G) == cases[i].clear);
        assert_false(wh_horizon_is_clear_at(&cell.table, G, &pose.r));
    }
}

/* It holds for one step, and for a gripper that watches no wafer. */
static void the_note_is_over_with_the_step(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell.gripper[G].approach.holder = WH_HORIZON_CLEAR;
    cell_move(&cell, G, 0, 0, -4, OPEN);
    assert_int_equal(cell.gripper[G].approach.wafer, 0);
    assert_int_equal(cell.gripper[G].approach.holder, WH_NONE);
    wh_horizon_note(&cell.table, G, true);
    assert_int_equal(cell.gripper[G].approach.holder, WH_NONE);
    cell_move(&cell, G, 0, 0, -500, OPEN);
    cell_move(&cell, G, 0, 0, -500, OPEN);
    assert_int_equal(cell.gripper[G].approach.wafer, WH_NONE);
    assert_int_equal(cell.gripper[G].approach.holder, WH_NONE);
}

/* From the way of a slice, along several axes at once or against them, to the margin. */
static void expect_margin(fixture_t *fixture, double moved, double margin) {
    const double ways[][3] = {{moved, 0, 0},
                              {0, -moved, 0},
                              {0, 0, moved},
                              {-moved / 2, moved / 4, -moved / 4},
                              {moved / 4, -moved / 2, moved / 4}};
    for (size_t i = 0; i < 5; ++i) {
        const wh_vec3_t from = vector(8, -16, 4);
        const wh_vec3_t place = vector(8 + ways[i][0], -16 + ways[i][1], 4 + ways[i][2]);
        fixture->cell.gripper[G].base_from_gripper.r = from;
        assert_near(wh_horizon_margin(&fixture->cell.table, G, &place), margin, 0);
    }
}

/* 32 times the way, up to half of the neighbourhood, or to 8 mm; a 32nd of that at rest and after a jump. */
static void margin_goes_with_the_way(void **state) {
    (void)state;
    static const double wide[][2] = {
        {0, 1},        {1.0 / 64, 1}, {63.0 / 2048, 1},  {1.0 / 32, 1}, {65.0 / 2048, 65.0 / 64},
        {1.0 / 16, 2}, {0.5, 16},     {63.0 / 64, 31.5}, {1, 32},       {65.0 / 64, 32},
        {2, 32},       {16, 32},      {16.0078125, 1},   {31, 1},       {1000, 1}};
    static const double narrow[][2] = {{0, 0.25}, {1.0 / 256, 0.25}, {1.0 / 64, 0.5}, {0.125, 4},
                                       {0.25, 8}, {0.3125, 8},       {4, 8},          {4.0625, 0.25}};
    fixture_t fixture;
    begin(&fixture, 4, 60);
    for (size_t i = 0; i < sizeof wide / sizeof wide[0]; ++i) {
        expect_margin(&fixture, wide[i][0], wide[i][1]);
    }
    begin(&fixture, 1, 2);
    for (size_t i = 0; i < sizeof narrow / sizeof narrow[0]; ++i) {
        expect_margin(&fixture, narrow[i][0], narrow[i][1]);
    }
    /* Around 8 mm. */
    begin(&fixture, 2, 13);
    expect_margin(&fixture, 1, 8);
    begin(&fixture, 2, 15);
    expect_margin(&fixture, 1, 8.5);
}

static void measuring_begins_with_the_margin(void **state) {
    (void)state;
    fixture_t fixture;
    begin(&fixture, 4, 60);
    const uint32_t listed = 0;
    const wh_found_t some = {&listed, 1};
    const wh_found_t all = wh_index_all(&fixture.cell.table);
    wh_horizon_t horizon = wh_horizon_begin(&fixture.cell.table, G, &some, 5);
    assert_true(horizon.gap == 5);
    assert_true(horizon.limits.projz == 4 && horizon.limits.projxy == 60);
    fixture.cell.gripper[G].approach.wafer = 0;
    horizon = wh_horizon_begin(&fixture.cell.table, G, &all, 5);
    assert_true(horizon.gap == LONGEST);
    assert_true(horizon.limits.projz == WH_REAL(0.5) && horizon.limits.projxy == WH_REAL(0.25));
}

/* Within 4 mm along the wafer's axis and 60 mm across: the wafer's place, the gap before and after,
 * and whether the wafer is not ready. */
static void gaps_are_measured_from_the_neighbourhood(void **state) {
    (void)state;
    static const double cases[][6] = {{0, 0, 10, 100, 6, 1},        {0, 0, -10, 100, 6, 1},
                                      {48, 64, 0, 100, 20, 1},      {-48, -64, 3, 100, 20, 1},
                                      {48, -64, 10, 100, 20, 1},    {48, -64, 30, 100, 26, 1},
                                      {3, -4, 1, 100, 0, 0},        {0, 0, 10, 6, 6, 1},
                                      {0, 0, 10, 5, 5, 1},          {80, 0, 0, 5, 5, 1},
                                      {80, 0, 0, 20, 20, 1},        {60, 0, 0, 100, 0, 0},
                                      {0, 0, 4, 100, 0, 0},         {0, 0, 4, 0, 0, 1},
                                      {60.5, 0, 4, 9, 0.5, 1},      {0, 60.5, 4, 9, 0.5, 1},
                                      {0, 0, 4.5, 9, 0.5, 1},       {0, 0, 4.5, 0, 0, 1},
                                      {60.5, 0, 3.5, 0, 0, 1},      {0, 0, (double)NAN, 9, 0, 0},
                                      {(double)NAN, 0, 0, 9, 0, 0}, {0, (double)INFINITY, 0, 9, 0, 0},
                                      {0, 0, 1e30, 100, 100, 1}};
    /* Base's axes and the wafer's: equal, and turned into each other. */
    static const wh_mat3_t turns[] = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                      {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}}};
    for (size_t i = 0; i < 2 * (sizeof cases / sizeof cases[0]); ++i) {
        const double *c = cases[i / 2];
        const wh_vec3_t place = vector(8, -16, 4);
        const wh_vec3_t p = vector(c[0], c[1], c[2]);
        wh_pose_t wafer = {turns[i % 2], {0, 0, 0}};
        wafer.r = wh_mat3_transform(&wafer.R, &p);
        wafer.r = wh_vec3_add(&wafer.r, &place);
        wh_horizon_t horizon = {.limits = {4, 60}, .gap = WH_REAL(c[3])};
        assert_int_equal(wh_horizon_measure(&horizon, &wafer, &place), c[5] != 0);
        assert_near(horizon.gap, c[4], 0);
    }
}

/* The least gap for which this number of units is kept, by bisection. */
static wh_real_t least_gap(fixture_t *fixture, const wh_vec3_t *place, uint32_t units, wh_real_t enough) {
    wh_real_t low = 0;
    wh_real_t high = enough;
    for (wh_real_t middle = high / 2; middle > low && middle < high; middle = low + (high - low) / 2) {
        store(fixture, place, (double)middle);
        *(words(fixture)[3] >> 2 >= units ? &high : &low) = middle;
    }
    assert_true(high < enough);
    return high;
}

/* The margin is 2 units, plus 16 roundings of all numbers in the sum, plus the most that the
 * tolerance of rotations may stretch. */
static void what_is_taken_off(void **state) {
    (void)state;
    static const double places[][5] = {{0, 0, 0, 4, 60},     {3e7, -3e7, 3e7, 4, 60}, {-3e7, 1, 2, 4, 60},
                                       {0, 3e7, 0, 4, 60},   {0, 0, -2e7, 4, 60},     {1, 2, 3, 1e6, 1e-3},
                                       {1, 2, 3, 1e-3, 1e6}, {0, 0, 0, 1e6, 1e6}};
    static const uint32_t units[] = {1, 2, 100, 6400, 1000000, 1 << 28};
    for (size_t i = 0; i < 8 * 6; ++i) {
        const double *p = places[i / 6];
        const uint32_t n = units[i % 6];
        const wh_vec3_t place = vector(p[0], p[1], p[2]);
        fixture_t fixture;
        begin(&fixture, p[3], p[4]);
        const double size = fabs(p[0]) + fabs(p[1]) + fabs(p[2]) + fmax(p[3], 0.5) + fmax(p[4], 0.25);
        const double gap =
            (n + 2.0) / 64 * (1 + 3 * (double)WH_ROTATION_TOLERANCE) + 16 * (double)EPSILON * size;
        assert_near(least_gap(&fixture, &place, n, WH_REAL(2 * gap)), gap, 16 * WH_TEST_ROUNDING * gap);
    }
}

static void distances_fit_their_word(void **state) {
    (void)state;
    static const double gaps[] = {8.4e6, 2e7, 4e7, 1e9, 1e30, (double)INFINITY};
    const wh_vec3_t place = vector(0, 0, 0);
    fixture_t fixture;
    begin(&fixture, 4, 60);
    for (size_t i = 0; i < 6; ++i) {
        store(&fixture, &place, gaps[i]);
        assert_int_equal(words(&fixture)[3], 4 * (uint32_t)LONGEST);
    }
    assert_true(covers(&fixture, 0, 8388000, 0));
    assert_false(covers(&fixture, 0, 8389000, 0));
    static const double none[] = {0,  0.75 / 64, 2.0 / 64,          2.99 / 64,
                                  -1, -1e9,      -(double)INFINITY, (double)NAN};
    for (size_t i = 0; i < 8; ++i) {
        store(&fixture, &place, none[i]);
        assert_int_equal(words(&fixture)[3], 0);
        assert_false(covers(&fixture, 0, 0, 0));
    }
}

/* A place that is rounded to units may be 1.73 of them away: one unit does not hold it for sure, two do. */
static void short_ones_do_not_hold(void **state) {
    (void)state;
    const wh_vec3_t place = vector(0, 0, 0);
    fixture_t fixture;
    begin(&fixture, 4, 60);
    store(&fixture, &place, 3.5 / 64);
    assert_int_equal(words(&fixture)[3], 4 * 1);
    store(&fixture, &place, 4.5 / 64);
    assert_int_equal(words(&fixture)[3], 4 * 2);
    fixture.cell.gripper[G].approach.wafer = 0;
    store(&fixture, &place, 3.5 / 64);
    assert_int_equal(words(&fixture)[3], 4 * 1 + WH_HORIZON_OF_TOLERANCE);
    store(&fixture, &place, 4.5 / 64);
    assert_int_equal(words(&fixture)[3], 4 * 2 + WH_HORIZON_OF_TOLERANCE);
    /* It is of use as long as this goes on. */
    assert_true(covers(&fixture, 0, 0, 0));
    fixture.cell.gripper[G].approach.wafer = WH_NONE;
    assert_false(covers(&fixture, 0, 0, 0));
}

/* (3, 4, 5), except for one axis. */
static wh_vec3_t along(size_t axis, double value) {
    double at[3] = {3, 4, 5};
    at[axis] = value;
    return vector(at[0], at[1], at[2]);
}

/* There is none 33 km from base's origin along any axis; a little nearer there is one. */
static void far_away_there_is_none(void **state) {
    (void)state;
    static const double fars[] = {33554430, 33554434, 1e9, 1e30, (double)INFINITY, (double)NAN};
    fixture_t fixture;
    begin(&fixture, 4, 60);
    for (size_t i = 0; i < 6 * 6; ++i) {
        const size_t axis = i / 2 % 3;
        const double sign = i % 2 ? 1 : -1;
        const wh_vec3_t place = along(axis, sign * fars[i / 6]);
        words(&fixture)[3] = UINT32_MAX;
        store(&fixture, &place, 1000);
        assert_int_equal(words(&fixture)[3], 0);
        const wh_vec3_t nearer = along(axis, sign * 33554000);
        store(&fixture, &nearer, 1000);
        assert_true(wh_horizon_is_clear_at(&fixture.cell.table, G, &nearer));
    }
}

/* Places of either sign, up to the largest for which float has a resolution of 2 mm, in all three words. */
static void places_are_kept_as_signed_units(void **state) {
    (void)state;
    static const double places[] = {0, 16, -16, 4096.5, -4096.5, 16777216, -16777216};
    fixture_t fixture;
    begin(&fixture, 4, 60);
    for (size_t i = 0; i < 7 * 7 * 7; ++i) {
        const double x = places[i % 7];
        const double y = places[i / 7 % 7];
        const double z = places[i / 49];
        const wh_vec3_t place = vector(x, y, z);
        store(&fixture, &place, 1000);
        assert_int_equal(words(&fixture)[0], (uint32_t)(int32_t)(64 * x));
        assert_int_equal(words(&fixture)[1], (uint32_t)(int32_t)(64 * y));
        assert_int_equal(words(&fixture)[2], (uint32_t)(int32_t)(64 * z));
        words(&fixture)[3] = 4 * 6400;
        assert_true(covers(&fixture, x, y, z));
        assert_true(covers(&fixture, x + 98, y, z) && covers(&fixture, x - 98, y, z));
        assert_true(covers(&fixture, x, y + 98, z) && covers(&fixture, x, y - 98, z));
        assert_true(covers(&fixture, x, y, z + 98) && covers(&fixture, x, y, z - 98));
        assert_false(covers(&fixture, x + 100, y, z) || covers(&fixture, x - 100, y, z));
        assert_false(covers(&fixture, x, y + 100, z) || covers(&fixture, x, y - 100, z));
        assert_false(covers(&fixture, x, y, z + 100) || covers(&fixture, x, y, z - 100));
        assert_false(covers(&fixture, x + 60, y - 80, z) || covers(&fixture, x - 48, y + 64, z + 60));
        assert_true(covers(&fixture, x + 60, y - 78, z) && covers(&fixture, x - 48, y + 64, z + 58));
    }
    /* Rounded towards zero. */
    const wh_vec3_t place = vector(0.99 / 64, -0.99 / 64, -1.99 / 64);
    store(&fixture, &place, 1000);
    assert_int_equal(words(&fixture)[0], 0);
    assert_int_equal(words(&fixture)[1], 0);
    assert_int_equal(words(&fixture)[2], UINT32_MAX);
}

/* Every |R^T R - I| is just within the tolerance, and the columns are longer by it. */
static wh_mat3_t stretched(void) {
    const wh_mat3_t R = wh_test_random_turn(WH_TEST_PI);
    wh_mat3_t stretch = wh_mat3_identity();
    for (int i = 0; i < 9; ++i) {
        stretch.m[i / 3][i % 3] += WH_REAL(0.45) * WH_ROTATION_TOLERANCE;
    }
    return wh_mat3_multiply(&R, &stretch);
}

/* A gripper at `from` looks at wafer 0 alone. */
static void look(fixture_t *fixture, const wh_vec3_t *from) {
    const wh_found_t all = wh_index_all(&fixture->cell.table);
    wh_horizon_t horizon = wh_horizon_begin(&fixture->cell.table, G, &all, 0);
    (void)wh_horizon_measure(&horizon, &fixture->cell.wafer[0].base_from_wafer, from);
    wh_horizon_store(&fixture->cell.table, G, from, &horizon);
}

/* The last place on the way from one to another that is within the horizon of the first. */
static wh_vec3_t last_covered(const fixture_t *fixture, const wh_vec3_t *from, const wh_vec3_t *way) {
    wh_vec3_t place = *from;
    for (wh_real_t step = 1; step > WH_TEST_ROUNDING; step /= 2) {
        const wh_vec3_t part = wh_vec3_scale(step, way);
        const wh_vec3_t next = wh_vec3_add(&place, &part);
        if (wh_horizon_is_clear_at(&fixture->cell.table, G, &next)) {
            place = next;
        }
    }
    return place;
}

/* True if a table without buckets, which looks at all wafers, finds one at this place. */
static bool matters(const wh_pose_t *base_from_wafer, const wh_vec3_t *place) {
    cell_t cell;
    wh_grasp_config_t config = wh_grasp_config_default();
    config.near_projz = 4;
    config.near_projxy = 60;
    cell_begin(&cell, &config);
    assert_int_equal(wh_grasp_place(&cell.table, 0, base_from_wafer), WH_OK);
    cell.input[G].base_from_gripper.r = *place;
    cell.input[G].valve = OPEN;
    cell_step(&cell);
    return cell.gripper[G].wafer == 0 || cell.gripper[G].approach.wafer == 0;
}

/* A gripper has looked from any distance, and then comes straight along the wafer's axis or across
 * it. It is no longer within its horizon at the place where a table that looks at all wafers finds
 * this one. */
static void it_ends_before_a_wafer_matters(void **state) {
    (void)state;
    for (int run = 0; run < 2000 / WH_TEST_SHARE; ++run) {
        fixture_t fixture;
        begin(&fixture, 4, 60);
        const double reach = run % 4 == 0 ? 1e7 : 1e4;
        const double far = wh_test_uniform(100, run % 8 < 4 ? 4e6 : 1e4);
        wh_pose_t wafer = wh_test_random_pose(reach);
        wafer.R = stretched();
        assert_int_equal(wh_grasp_place(&fixture.cell.table, 0, &wafer), WH_OK);
        const wh_vec3_t axis = run % 2 ? vector(0, 0, 1) : vector(0.7071, 0.7071, 0);
        const wh_vec3_t away = wh_mat3_transform(&wafer.R, &axis);
        const wh_vec3_t way = wh_vec3_scale(WH_REAL(-far), &away);
        const wh_vec3_t from = wh_vec3_subtract(&wafer.r, &way);
        look(&fixture, &from);
        const wh_vec3_t last = last_covered(&fixture, &from, &way);
        assert_false(matters(&wafer, &last));
        assert_false(wh_horizon_is_clear_at(&fixture.cell.table, G, &wafer.r));
    }
}

int main(void) {
    (void)wh_test_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_are_each_grippers_own),
        cmocka_unit_test(without_buckets_it_is_noted_that_nothing_is_near),
        cmocka_unit_test(the_note_is_over_with_the_step),
        cmocka_unit_test(margin_goes_with_the_way),
        cmocka_unit_test(measuring_begins_with_the_margin),
        cmocka_unit_test(gaps_are_measured_from_the_neighbourhood),
        cmocka_unit_test(what_is_taken_off),
        cmocka_unit_test(distances_fit_their_word),
        cmocka_unit_test(short_ones_do_not_hold),
        cmocka_unit_test(far_away_there_is_none),
        cmocka_unit_test(places_are_kept_as_signed_units),
        cmocka_unit_test(it_ends_before_a_wafer_matters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
