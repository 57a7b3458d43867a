/* The parts of a slice that lie within the limits, against their definition: inside at both ends and in between,
 * outside before and after. And which of several wafers is taken. */
#include "support/grasp.h"

#include "grasp/sweep_internal.h"

#define ROUNDS 20000
#define SAMPLES 200
#define SLACK 1e-7

typedef struct {
    wh_pose_t wafer, from, to;
    wh_real_t projz, projxy;
} slice_t;

/* Along any line, along z alone, within the plane alone, or not at all; the limits are met now and then. */
static void draw(slice_t *s) {
    const uint32_t kind = wh_test_below(5);
    const bool climbs = kind != 1 && kind != 2;
    const bool slides = kind != 0 && kind != 2;
    const double far = wh_test_below(2) ? 120 : wh_test_decades(1e-3, 10);
    const double x = wh_test_uniform(-60, 60);
    const double y = wh_test_uniform(-60, 60);
    const double z = wh_test_uniform(-3, 3);
    const wh_pose_t level = wh_test_at(wh_test_uniform(-100, 100), wh_test_uniform(-100, 100), 7);
    s->wafer = kind == 4 ? wh_test_random_pose(100) : level;
    wh_pose_t wafer_from = wh_test_at(x, y, z);
    s->from = wh_pose_compose(&s->wafer, &wafer_from);
    wafer_from.r.x += slides ? WH_REAL(wh_test_uniform(-far, far)) : 0;
    wafer_from.r.y += slides ? WH_REAL(wh_test_uniform(-far, far)) : 0;
    wafer_from.r.z += climbs ? WH_REAL(wh_test_uniform(-6, 6)) : 0;
    s->to = wh_pose_compose(&s->wafer, &wafer_from);
    s->projz = WH_REAL(wh_test_uniform(0.3, 2));
    s->projxy = WH_REAL(wh_test_uniform(20, 70));
}

/* By how much the gripper is within both limits at t; negative: it is not. */
static double room(const slice_t *s, double t) {
    double dr[3];
    double p[3] = {0, 0, 0};
    const wh_vec3_t *ends[] = {&s->wafer.r, &s->from.r, &s->to.r};
    for (int i = 0; i < 3; ++i) {
        const double w = (double)(&ends[0]->x)[i];
        const double a = (double)(&ends[1]->x)[i];
        const double b = (double)(&ends[2]->x)[i];
        dr[i] = w - (a + t * (b - a));
    }
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            p[k] += (double)s->wafer.R.m[i][k] * dr[i];
        }
    }
    return fmin((double)s->projz - fabs(p[2]), (double)s->projxy - sqrt(p[0] * p[0] + p[1] * p[1]));
}

/* Inside the part there is room, outside there is none. */
static void check_samples(const slice_t *s, double first, double last) {
    for (int k = 0; k <= SAMPLES; ++k) {
        const double t = (double)k / SAMPLES;
        const double r = room(s, t);
        assert_true(t < first || t > last ? r < SLACK : r > -SLACK);
    }
}

static void the_part_is_where_both_limits_hold(void **state) {
    (void)state;
    int found = 0;
    for (int i = 0; i < ROUNDS; ++i) {
        slice_t s;
        wh_sweep_t sweep;
        wh_span_t part;
        draw(&s);
        wh_sweep_between(&s.from, &s.to, &sweep);
        const bool within = wh_sweep_within(&sweep, &s.wafer, s.projz, s.projxy, &part);
        const double first = within ? (double)part.first : 2;
        const double last = within ? (double)part.last : -1;
        found += within;
        assert_true(!within || (first >= 0 && last <= 1 && first <= last));
        check_samples(&s, first, last);
        assert_true(!within || (room(&s, first) > -SLACK && room(&s, last) > -SLACK));
    }
    assert_true(found > ROUNDS / 5 && found < 4 * ROUNDS / 5);
}

static void poses_run_from_one_end_to_the_other(void **state) {
    (void)state;
    for (int i = 0; i < ROUNDS; ++i) {
        const wh_pose_t from = wh_test_random_pose(100);
        const wh_pose_t to = wh_test_random_pose(100);
        wh_sweep_t sweep;
        wh_pose_t pose;
        wh_sweep_between(&from, &to, &sweep);
        wh_sweep_pose_at(&sweep, 0, &pose);
        assert_near(wh_test_difference_R(&pose, &from), 0, 1e-12);
        assert_near(wh_test_difference_r(&pose, &from), 0, 0);
        wh_sweep_pose_at(&sweep, 1, &pose);
        assert_memory_equal(&pose, &to, sizeof pose);
        wh_sweep_pose_at(&sweep, 1 - WH_REAL(1e-9), &pose);
        assert_near(wh_test_difference_R(&pose, &to), 0, 1e-6);
        assert_near(wh_test_difference_r(&pose, &to), 0, 1e-6);
        wh_sweep_pose_at(&sweep, WH_REAL(wh_test_uniform(0, 1)), &pose);
        assert_int_equal(wh_pose_validate(&pose), WH_OK);
    }
}

/* A turn so slow that rounding hides for a while on which side of the limit it is: found soon for all that. */
static void a_creeping_turn_is_found_soon(void **state) {
    (void)state;
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    const wh_pose_t wafer = wh_test_at(0, 0, 0);
    const double limit = acos((double)tolerance.planar);
    for (int i = 0; i < ROUNDS; ++i) {
        const double rate = wh_test_decades(1e-11, 1e-2);
        const double before = wh_test_uniform(0.1, 0.9) * rate;
        const wh_pose_t from = wh_test_pose(wh_test_rotation(1, 0, 0, limit + before), 1, 2, 0.1);
        const wh_pose_t to = wh_test_pose(wh_test_rotation(1, 0, 0, limit + before - rate), 1, 2, 0.1);
        wh_sweep_t sweep;
        wh_real_t t;
        wh_sweep_between(&from, &to, &sweep);
        assert_true(wh_sweep_first_ready(&sweep, &wafer, &tolerance, &t));
        /* A thousandth of the rest of the slice late, and what the poses' own rounding makes of the crossing. */
        const double crossing = before / rate;
        assert_near(t, crossing, (1 - crossing) / 1000 + 1e-15 / rate + 1e-3 * rate);
    }
}

/* Gripper 0 passes the wafers from below, some of which lie at one height, or sideways, some of which come within its reach
 * at once but at different heights. */
static void draw_wafers(cell_t *cell) {
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = WH_CHECK_SWEPT;
    const bool sideways = wh_test_below(2);
    const double begin = wh_test_below(2) ? -90 : -10;
    cell_begin(cell, &config);
    cell_move(cell, 0, sideways ? begin : 0, 5000, 0, OPEN);
    for (size_t w = 0; w < CELL_WAFERS; ++w) {
        if (sideways) {
            const double z = wh_test_uniform(-0.45, 0.45);
            const wh_mat3_t tilt = wh_test_random_turn(0.1);
            const wh_pose_t leaning = wh_test_pose(tilt, 10 * (int)wh_test_below(3), 5000, z);
            assert_int_equal(wh_grasp_place(&cell->table, w, &leaning), WH_OK);
        } else {
            const double z = 1 + (int)wh_test_below(5) + (wh_test_below(2) ? 0 : wh_test_uniform(-0.1, 0.1));
            cell_place(cell, w, wh_test_uniform(-20, 20), wh_test_below(4) ? 5000 : 5300, z);
        }
    }
    cell_set(cell, 0, sideways ? 90 : 9, 5000, sideways ? 0 : wh_test_uniform(0, 6), OPEN);
}

typedef struct {
    int wafer, ready; /* WH_NONE; how many could be taken */
    double t, distance;
} choice_t;

/* When, between the slices, wafer w can be taken; 2: at the end only; 3: not at all. */
static double instant(const cell_t *cell, int w, double *distance) {
    const wh_pose_t *wafer = &cell->wafer[w].base_from_wafer;
    const wh_tolerance_t *tolerance = &cell->table.config.tolerance;
    wh_pose_t then = cell->input[0].base_from_gripper;
    wh_sweep_t sweep;
    wh_real_t t;
    wh_sweep_between(&cell->gripper[0].base_from_gripper, &cell->input[0].base_from_gripper, &sweep);
    const bool between = wh_sweep_first_ready(&sweep, wafer, tolerance, &t);
    if (between) {
        wh_sweep_pose_at(&sweep, t, &then);
    }
    const wh_vec3_t dr = wh_vec3_subtract(&wafer->r, &then.r);
    const wh_vec3_t n1 = wh_mat3_column(&wafer->R, 2);
    *distance = fabs((double)wh_vec3_dot(&dr, &n1));
    return between ? (double)t : wh_proximity_ready(wafer, &then, tolerance) ? 2 : 3;
}

/* The earliest, of equally early ones the nearest, of equally near ones the first. */
static choice_t choose(const cell_t *cell) {
    choice_t best = {WH_NONE, 0, 3, 0};
    for (int w = 0; w < CELL_WAFERS; ++w) {
        double distance;
        const double t = instant(cell, w, &distance);
        best.ready += t < 3;
        if (t < best.t || (t < 3 && t <= best.t && distance < best.distance)) {
            best.wafer = w;
            best.t = t;
            best.distance = distance;
        }
    }
    return best;
}

static void the_earliest_then_the_nearest_is_taken(void **state) {
    (void)state;
    int several = 0;
    for (int i = 0; i < ROUNDS; ++i) {
        cell_t cell;
        draw_wafers(&cell);
        const choice_t best = choose(&cell);
        cell_step(&cell);
        cell_expect_held(&cell, best.wafer, 0);
        several += best.ready > 1;
        if (best.wafer != WH_NONE) {
            const wh_event_t *picked = cell_event(&cell, WH_EVENT_PICKED);
            assert_int_equal(picked->wafer, best.wafer);
            assert_near(fabs((double)picked->measured.dr_proj_z), best.distance, 1e-12);
        }
    }
    assert_true(several > ROUNDS / 10);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_part_is_where_both_limits_hold),
        cmocka_unit_test(poses_run_from_one_end_to_the_other),
        cmocka_unit_test(a_creeping_turn_is_found_soon),
        cmocka_unit_test(the_earliest_then_the_nearest_is_taken),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
