/* Swept checking compared with brute force: the slice sampled at very many instants, with
 * quaternions written here. */
#include "grasp/sweep_internal.h"
#include "support/grasp.h"

#if defined(WH_FLOAT)
#define SLACK 2e-3
#define HALF_TURN (WH_TEST_PI - 1e-2)
#else
#define SLACK 1e-8
#define HALF_TURN (WH_TEST_PI - 1e-5)
#endif

typedef struct {
    double w, x, y, z;
} quaternion_t;

/* A slice: the gripper begins at `from` and turns by `turn` in its own frame while it travels. */
typedef struct {
    wh_pose_t from, to, wafer;
    quaternion_t turn;
    double travel[3];
    wh_grasp_config_t config;
} slice_t;

typedef struct {
    double n, z, xy, r[3];
    double e1[3], n2[3]; /* the gripper's first and third axes */
} values_t;

static quaternion_t times(quaternion_t a, quaternion_t b) {
    const quaternion_t c = {
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
    return c;
}

/* (2), (3) and (5) at instant t: the rotation (1 - t) 1 + t q, normalised, is applied as Q e3 Q*. */
static values_t values_at(const slice_t *s, double t) {
    values_t v;
    quaternion_t q = {1 - t + t * s->turn.w, t * s->turn.x, t * s->turn.y, t * s->turn.z};
    const double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    q.w /= length;
    q.x /= length;
    q.y /= length;
    q.z /= length;
    const quaternion_t e1 = {0, 1, 0, 0};
    const quaternion_t e3 = {0, 0, 0, 1};
    const quaternion_t back = {q.w, -q.x, -q.y, -q.z};
    const quaternion_t n = times(times(q, e3), back);
    const quaternion_t x = times(times(q, e1), back);
    const double from[3] = {(double)s->from.r.x, (double)s->from.r.y, (double)s->from.r.z};
    const double wafer[3] = {(double)s->wafer.r.x, (double)s->wafer.r.y, (double)s->wafer.r.z};
    double p[3] = {0, 0, 0};
    v.n = 0;
    for (int i = 0; i < 3; ++i) {
        v.n2[i] = (double)s->from.R.m[i][0] * n.x + (double)s->from.R.m[i][1] * n.y +
                  (double)s->from.R.m[i][2] * n.z;
        v.e1[i] = (double)s->from.R.m[i][0] * x.x + (double)s->from.R.m[i][1] * x.y +
                  (double)s->from.R.m[i][2] * x.z;
        v.n += v.n2[i] * (double)s->wafer.R.m[i][2];
        v.r[i] = from[i] + t * s->travel[i];
        for (int k = 0; k < 3; ++k) {
            p[k] += (double)s->wafer.R.m[i][k] * (wafer[i] - v.r[i]);
        }
    }
    v.z = p[2];
    v.xy = sqrt(p[0] * p[0] + p[1] * p[1]);
    return v;
}

/* The margin of readiness in units of the limits, positive if ready: 1 mm of z, 1 mm of xy and 0.01
 * of the cosine count alike. */
static double readiness(const slice_t *s, double t) {
    const values_t v = values_at(s, t);
    const wh_tolerance_t *limit = &s->config.tolerance;
    const double z = 0.998 * (double)limit->projz - fabs(v.z);
    return fmin(fmin(z, (double)limit->projxy - v.xy), (v.n - (double)limit->planar) * 100);
}

static double closeness(const slice_t *s, const values_t *v) {
    const double z = v->z / (double)s->config.tolerance.projz;
    const double xy = v->xy / (double)s->config.tolerance.projxy;
    return z * z + xy * xy;
}

/* A turn about any axis or one near n2; small, large, none, or a little less than half a revolution. */
static wh_mat3_t draw_turn(quaternion_t *turn) {
    const double spreads[] = {1, 0.2, 0};
    const double spread = spreads[wh_test_below(3)];
    const uint32_t kind = wh_test_below(8);
    double angle = wh_test_uniform(-0.3, 0.3);
    double a[3];
    for (int i = 0; i < 3; ++i) {
        a[i] = wh_test_uniform(-1, 1) * (i < 2 ? spread : 1);
    }
    if (kind < 3) {
        angle *= 10;
    } else if (kind == 3) {
        angle = a[0] < 0 ? HALF_TURN : -HALF_TURN;
    } else if (kind == 4) {
        angle = 0;
    }
    const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    turn->w = cos(angle / 2);
    turn->x = a[0] / length * sin(angle / 2);
    turn->y = a[1] / length * sin(angle / 2);
    turn->z = a[2] / length * sin(angle / 2);
    return wh_test_rotation(a[0], a[1], a[2], angle);
}

/* A wafer in any place, and a gripper that passes it: from one point to another in the wafer's frame. */
static void draw(slice_t *s) {
    memset(s, 0, sizeof *s);
    s->config = wh_grasp_config_default();
    s->config.check = WH_CHECK_SWEPT;
    s->wafer = wh_test_random_pose(100);
    const double reach = wh_test_below(2) ? 90 : 30;
    const double height = wh_test_below(2) ? 6 : 1;
    wh_pose_t ends[2];
    for (int i = 0; i < 2; ++i) {
        ends[i].R = wh_test_random_turn(0.25);
        ends[i].r.x = WH_REAL(wh_test_uniform(-reach, reach));
        ends[i].r.y = WH_REAL(wh_test_uniform(-reach, reach));
        ends[i].r.z = WH_REAL(wh_test_uniform(-height, height));
        ends[i] = wh_pose_compose(&s->wafer, &ends[i]);
    }
    const wh_mat3_t turn = draw_turn(&s->turn);
    s->from = ends[0];
    s->to.R = wh_mat3_multiply(&s->from.R, &turn);
    s->to.r = ends[1].r;
    s->travel[0] = (double)s->to.r.x - (double)s->from.r.x;
    s->travel[1] = (double)s->to.r.y - (double)s->from.r.y;
    s->travel[2] = (double)s->to.r.z - (double)s->from.r.z;
}

/* The wafer comes only when the gripper waits open at its beginning, so no earlier slice can take it. */
static void play(cell_t *cell, const slice_t *s) {
    cell_begin(cell, &s->config);
    cell->input[0].base_from_gripper = s->from;
    cell->input[0].valve = OPEN;
    cell_place(cell, 0, 5000, 0, 0);
    cell_step(cell);
    cell_expect_nothing(cell);
    assert_int_equal(wh_grasp_place(&cell->table, 0, &s->wafer), WH_OK);
    cell->input[0].base_from_gripper = s->to;
    cell_step(cell);
}

/* The instant at which the table took the wafer: the gripper's place on its way, from the event. */
static double instant_of(const slice_t *s, const wh_event_t *e) {
    const double at[3] = {(double)s->wafer.r.x - (double)e->measured.dr.x - (double)s->from.r.x,
                          (double)s->wafer.r.y - (double)e->measured.dr.y - (double)s->from.r.y,
                          (double)s->wafer.r.z - (double)e->measured.dr.z - (double)s->from.r.z};
    double along = 0;
    double square = 0;
    for (int i = 0; i < 3; ++i) {
        along += at[i] * s->travel[i];
        square += s->travel[i] * s->travel[i];
    }
    return along / square;
}

/* Taken at t: the pair is ready there, and the values and gripper_from_wafer are those of t. */
static void check_pick(const slice_t *s, const cell_t *cell, const wh_event_t *e, double t) {
    const values_t v = values_at(s, t);
    assert_true(readiness(s, t) > -SLACK * 100);
    assert_near(e->measured.dr_proj_z, v.z, SLACK);
    assert_near(e->measured.dr_proj_xy_norm, v.xy, SLACK);
    assert_near(e->measured.n1_proj_n2, v.n, SLACK);
    const wh_pose_t *g = &cell->gripper[0].gripper_from_wafer;
    double x = 0;
    double z = 0;
    double n = 0;
    double m = 0;
    const double dr[3] = {(double)s->wafer.r.x - v.r[0], (double)s->wafer.r.y - v.r[1],
                          (double)s->wafer.r.z - v.r[2]};
    for (int i = 0; i < 3; ++i) {
        x += dr[i] * v.e1[i];
        z += dr[i] * v.n2[i];
        m += v.e1[i] * (double)s->wafer.R.m[i][0];
        n += v.n2[i] * (double)s->wafer.R.m[i][0];
    }
    assert_near(g->r.x, x, 50 * SLACK);
    assert_near(g->R.m[0][0], m, SLACK);
    assert_near(g->r.z, z, SLACK);
    assert_near(g->R.m[2][0], n, SLACK);
    const wh_pose_t end = wh_pose_compose(&s->to, g);
    assert_near(wh_test_difference_r(&end, &cell->wafer[0].base_from_wafer), 0, SLACK);
}

/* The first of `count` instants at which it is ready by more than rounding; 2 if it never is. */
static double first_ready(const slice_t *s, int count) {
    for (int i = 0; i <= count; ++i) {
        const double t = (double)i / count;
        if (readiness(s, t) > SLACK * 10) {
            return t;
        }
    }
    return 2;
}

typedef struct {
    int inside, beginning, end, never, near;
} tally_t;

static void check_near_miss(const slice_t *s, const cell_t *cell, int count, tally_t *tally) {
    double least = 1e30;
    bool leaves = false;
    for (int i = 0; i <= count; ++i) {
        const values_t v = values_at(s, (double)i / count);
        const bool is_near = fabs(v.z) < (double)s->config.near_projz && v.xy < (double)s->config.near_projxy;
        least = is_near ? fmin(least, closeness(s, &v)) : least;
        leaves = !is_near;
    }
    const wh_event_t *e = leaves ? cell_event(cell, WH_EVENT_NEAR_MISS) : NULL;
    const wh_encounter_t *approach = &cell->gripper[0].approach;
    if (least > 1e29 || (leaves ? !e : approach->wafer != 0)) {
        assert_true(least > 1e29);
        return;
    }
    values_t seen;
    const wh_proximity_t *p = e ? &e->measured : &approach->measured;
    seen.z = (double)p->dr_proj_z;
    seen.xy = (double)p->dr_proj_xy_norm;
    assert_true(closeness(s, &seen) < least * (1 + SLACK) + SLACK);
    assert_near(sqrt(closeness(s, &seen)), sqrt(least), 40.0 / count + SLACK);
    assert_false(p->ready);
    ++tally->near;
}

static void compare(const slice_t *s, int count, tally_t *tally) {
    cell_t cell;
    play(&cell, s);
    const double expected = first_ready(s, count);
    const wh_event_t *e = cell_event(&cell, WH_EVENT_PICKED);
    if (!e) {
        assert_true(expected > 1);
        ++tally->never;
        check_near_miss(s, &cell, count, tally);
        return;
    }
    const double t = instant_of(s, e);
    if (expected > 1 && t > 1 - 1e-12) {
        ++tally->end;
        return;
    }
    check_pick(s, &cell, e, t);
    /* It is never later than the samples show. It may be earlier by one sample, or at an instant
     * that the samples miss; check_pick has tested that instant. */
    assert_true(t <= expected + SLACK * 100 + 1e-5);
    assert_true(expected > 1 || t >= expected - 1.0 / count - SLACK * 100 || readiness(s, t) > -SLACK * 100);
    ++*(t < 1e-9 ? &tally->beginning : &tally->inside);
}

static void picks_at_the_first_instant(void **state) {
    (void)state;
    tally_t tally = {0, 0, 0, 0, 0};
    wh_rounds_t rounds = WH_ROUNDS(150, 3040, 0.5);
    while (wh_round(&rounds)) {
        slice_t s;
        draw(&s);
        compare(&s, rounds.number % 76 == 0 ? 100000 : 1500, &tally);
    }
    printf("%d picked inside the slice, %d at its beginning, %d at its end; %d never, %d of them near\n",
           tally.inside, tally.beginning, tally.end, tally.never, tally.near);
    const int made = rounds.made;
    assert_true(tally.inside > made / 10 && tally.beginning > made / 100 && tally.never > made / 10 &&
                tally.near > made / 30);
}

/* ----------------------------------------------------------------------------------------- parts of a slice */

/* The parts of a slice within the limits, compared with their definition: inside at both ends and
 * in between, outside before and after. The test also checks which of several wafers is taken. */

#define ROUNDS 20000
#define SAMPLES 200
#define SLACK_PART 1e-7

typedef struct {
    wh_pose_t wafer, from, to;
    wh_real_t projz, projxy;
} slice_t_part;

/* Along any line, along z alone, within the plane alone, or at rest; now and then the limits are
 * met exactly. */
static void draw_part(slice_t_part *s) {
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

/* The margin of the gripper to both limits at t; negative: it is outside. */
static double room(const slice_t_part *s, double t) {
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

/* Inside the part the margin is positive, outside it is negative. */
static void check_samples(const slice_t_part *s, double first, double last) {
    for (int k = 0; k <= SAMPLES; ++k) {
        const double t = (double)k / SAMPLES;
        const double r = room(s, t);
        assert_true(t < first || t > last ? r < SLACK_PART : r > -SLACK_PART);
    }
}

static void the_part_is_where_both_limits_hold(void **state) {
    (void)state;
    int found = 0;
    wh_rounds_t rounds = WH_ROUNDS(200, ROUNDS, 0.15);
    while (wh_round(&rounds)) {
        slice_t_part s;
        wh_sweep_t sweep;
        wh_span_t part;
        draw_part(&s);
        wh_sweep_between(&s.from, &s.to, &sweep);
        const bool within = wh_sweep_within(&sweep, &s.wafer, s.projz, s.projxy, &part);
        const double first = within ? (double)part.first : 2;
        const double last = within ? (double)part.last : -1;
        found += within;
        assert_true(!within || (first >= 0 && last <= 1 && first <= last));
        check_samples(&s, first, last);
        assert_true(!within || (room(&s, first) > -SLACK_PART && room(&s, last) > -SLACK_PART));
    }
    assert_true(found > rounds.made / 5 && found < 4 * rounds.made / 5);
}

static void poses_run_from_one_end_to_the_other(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(200, ROUNDS, 0.15);
    while (wh_round(&rounds)) {
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

/* The turn is so slow that rounding hides for a while on which side of the limit it is. It is found
 * soon all the same. */
static void a_creeping_turn_is_found_soon(void **state) {
    (void)state;
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    const wh_pose_t wafer = wh_test_at(0, 0, 0);
    const double limit = acos((double)tolerance.planar);
    wh_rounds_t rounds = WH_ROUNDS(200, ROUNDS, 0.15);
    while (wh_round(&rounds)) {
        const double rate = wh_test_decades(1e-11, 1e-2);
        const double before = wh_test_uniform(0.1, 0.9) * rate;
        const wh_pose_t from = wh_test_pose(wh_test_rotation(1, 0, 0, limit + before), 1, 2, 0.1);
        const wh_pose_t to = wh_test_pose(wh_test_rotation(1, 0, 0, limit + before - rate), 1, 2, 0.1);
        wh_sweep_t sweep;
        wh_real_t t;
        wh_sweep_between(&from, &to, &sweep);
        assert_true(wh_sweep_first_ready(&sweep, &wafer, &tolerance, &t));
        /* A delay of a thousandth of the rest of the slice, and the effect of the poses' own
         * rounding on the crossing. */
        const double crossing = before / rate;
        assert_near(t, crossing, (1 - crossing) / 1000 + 1e-15 / rate + 1e-3 * rate);
    }
}

/* Gripper 0 passes the wafers. From below, some of them lie at one height; sideways, some come
 * within its reach at once but at different heights. */
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
    int wafer, ready; /* WH_NONE; the number that could be taken */
    double t, distance;
} choice_t;

/* The instant in the slice at which wafer w can be taken; 2: at the end only; 3: not at all. */
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

/* The earliest; among equally early ones the nearest; among equally near ones the first. */
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
    wh_rounds_t rounds = WH_ROUNDS(200, ROUNDS, 0.15);
    while (wh_round(&rounds)) {
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
    assert_true(several > rounds.made / 10);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picks_at_the_first_instant),
        cmocka_unit_test(the_part_is_where_both_limits_hold),
        cmocka_unit_test(poses_run_from_one_end_to_the_other),
        cmocka_unit_test(a_creeping_turn_is_found_soon),
        cmocka_unit_test(the_earliest_then_the_nearest_is_taken),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
