/* One wafer is never two to MAP, for all diameters, pitches, places of the beams and ways to lean. */
#include "support/support.h"

#include "math/trig.h"
#include "mcs/slot_codes.h"

#define SLOTS 13

typedef struct {
    wh_mapping_t mapping;
    wh_slot_beams_t beams;
    double thickness;
    int slot; /* from 0: where the wafer belongs */
} cell_t;

static double between(double least, double most) {
    return wh_test_uniform(least, most);
}

static void draw_cell(cell_t *cell) {
    static const double diameters[] = {100, 150, 200, 300, 450};
    const double diameter = diameters[(int)between(0, 4.999)] + between(-0.5, 0.5);
    const double pitch = between(diameter / 60, diameter / 8);
    const double x = between(0, 0.8);
    cell->thickness = between(0.1, 0.1 * pitch);
    cell->mapping = (wh_mapping_t){.x = x,
                                   .y = between(0.1, sqrt(0.95 - x * x)),
                                   .crossed = between(0.2, 0.5),
                                   .level = between(0, 1) < 0.5 ? 0 : between(0.1, 1) * pitch,
                                   .protruded = diameter / 10,
                                   .thinnest = cell->thickness / 2,
                                   .thickest = 1.5 * cell->thickness};
    cell->beams = (wh_slot_beams_t){&cell->mapping, SLOTS, pitch, diameter / 2};
    cell->slot = 4 + (int)between(0, 4.999);
}

static int count_code(const int codes[], int code) {
    int count = 0;
    for (int slot = 0; slot < SLOTS; ++slot) {
        count += codes[slot] == code ? 1 : 0;
    }
    return count;
}

/* A wafer over the middle of its slot, `high` above it and leaning so much (rad) about an axis in its plane. */
static void map_one(const cell_t *cell, double high, double lean, double about, int codes[SLOTS]) {
    const wh_mat3_t turn = wh_mat3_from_rpy_deg(0, 0, about * 180 / WH_PI);
    const wh_mat3_t back = wh_mat3_from_rpy_deg(0, 0, -about * 180 / WH_PI);
    const wh_mat3_t roll = wh_mat3_from_rpy_deg(lean * 180 / WH_PI, 0, 0);
    const wh_mat3_t turned = wh_mat3_multiply(&turn, &roll);
    const wh_pose_t pose = {wh_mat3_multiply(&turned, &back), {0, 0, cell->slot * cell->beams.pitch + high}};
    memset(codes, 0, SLOTS * sizeof codes[0]);
    wh_slot_codes_add(&cell->beams, &pose, cell->thickness, codes);
}

static void assert_one(const cell_t *cell, const int codes[SLOTS]) {
    const int crossed = count_code(codes, WH_SLOT_CROSSED);
    const int empty = count_code(codes, WH_SLOT_EMPTY);
    const int single = count_code(codes, WH_SLOT_SINGLE);
    if (!(single == 1 ? empty == SLOTS - 1 : crossed >= 1 && crossed + empty == SLOTS)) {
        fail_msg("%d crossed, %d empty, %d single: pitch %g, radius %g, beams %g %g", crossed, empty, single,
                 cell->beams.pitch, cell->beams.radius, cell->mapping.x, cell->mapping.y);
    }
}

/* One edge in the slot's plane, the other up to three pitches higher: single while it lies level enough, and
 * crossed from there on. */
static void one_that_leans_is_one(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(200, 100000, 0.5);
    int crossed = 0;
    while (wh_round(&rounds)) {
        cell_t cell;
        draw_cell(&cell);
        const double about = between(0, 2 * WH_PI);
        bool was_crossed = false;
        for (int step = 0; step <= 30; ++step) {
            const double high = step * cell.beams.pitch / 10;
            const double lean = atan2(high, 2 * cell.beams.radius);
            int codes[SLOTS];
            map_one(&cell, high / 2, lean, about, codes);
            assert_one(&cell, codes);
            const bool is_crossed = count_code(codes, WH_SLOT_CROSSED) > 0;
            assert_true(step > 0 || codes[cell.slot] == WH_SLOT_SINGLE);
            was_crossed = was_crossed || is_crossed;
        }
        crossed += was_crossed ? 1 : 0;
    }
    assert_true(crossed > rounds.made / 2);
}

/* Anywhere between two slots, and as steep as can be: one, or crossed, never nothing. */
static void one_that_lies_anywhere_is_one(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(1000, 1000000, 0.4);
    while (wh_round(&rounds)) {
        cell_t cell;
        draw_cell(&cell);
        int codes[SLOTS];
        const double lean = (between(0, 1) < 0.5 ? 0.02 : 1.57) * between(-1, 1);
        map_one(&cell, between(-1, 1) * cell.beams.pitch, lean, between(0, 6.28), codes);
        assert_one(&cell, codes);
    }
}

/* Beside each other and in one slot: two are two. */
static void two_are_two(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(200, 100000, 0.1);
    while (wh_round(&rounds)) {
        cell_t cell;
        int codes[SLOTS];
        draw_cell(&cell);
        map_one(&cell, 0, 0, 0, codes);
        wh_pose_t pose = {wh_mat3_identity(), {0, 0, cell.slot * cell.beams.pitch + cell.thickness}};
        wh_slot_codes_add(&cell.beams, &pose, cell.thickness, codes);
        assert_int_equal(codes[cell.slot], WH_SLOT_DOUBLE);
        map_one(&cell, 0, 0, 0, codes);
        pose.r.z = (cell.slot + 1) * cell.beams.pitch;
        wh_slot_codes_add(&cell.beams, &pose, cell.thickness, codes);
        assert_int_equal(count_code(codes, WH_SLOT_SINGLE), 2);
    }
}

/* Each threshold from both of its sides. */
static void each_code_has_its_limit(void **state) {
    (void)state;
    static const struct {
        double out, high, thickness, rise; /* mm; `rise`: of one edge over the other, along the beams */
        int code;
    } cases[] = {{29.9, 0, 0.8, 0, WH_SLOT_SINGLE}, {30.1, 0, 0.8, 0, WH_SLOT_PROTRUDED},
                 {-20, 0, 0.8, 0, WH_SLOT_SINGLE},  {0, 3.9, 0.8, 0, WH_SLOT_SINGLE},
                 {0, 4.1, 0.8, 0, WH_SLOT_CROSSED}, {0, 0, 1.19, 0, WH_SLOT_SINGLE},
                 {0, 0, 1.21, 0, WH_SLOT_THICK},    {0, 0, 0.41, 0, WH_SLOT_SINGLE},
                 {0, 0, 0.39, 0, WH_SLOT_THIN},     {0, 0, 0.8, 3.3, WH_SLOT_SINGLE},
                 {0, 0, 0.8, 3.4, WH_SLOT_CROSSED}, {31, 0, 2, 0, WH_SLOT_PROTRUDED}};
    const wh_mapping_t mapping = {0.6, 0.6, 0.4, 2, 30, 0.4, 1.2};
    const wh_slot_beams_t beams = {&mapping, 3, 10, 150};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        int codes[3] = {0};
        const double lean = asin(cases[i].rise / 300) * 180 / WH_PI;
        const wh_pose_t pose = {wh_mat3_from_rpy_deg(lean, 0, 0), {-cases[i].out, 0, 10 + cases[i].high}};
        wh_slot_codes_add(&beams, &pose, cases[i].thickness, codes);
        if (codes[1] != cases[i].code || codes[0] != 0 || codes[2] != 0) {
            fail_msg("case %zu: %d%d%d", i, codes[0], codes[1], codes[2]);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_that_leans_is_one),
        cmocka_unit_test(one_that_lies_anywhere_is_one),
        cmocka_unit_test(two_are_two),
        cmocka_unit_test(each_code_has_its_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
