/* Beams at a door: the times at which a carried wafer or blade breaks and frees them, compared with
 * closed forms and dense samples; the latches that result; and the way back from latches to the
 * wafer's centre. */
#include "support/heap.h"
#include "support/support.h"

#include "grasp/sweep_internal.h"
#include "math/rotation.h"
#include "sim/snapshot.h"

#define PI 3.14159265358979323846

/* The accuracy of a coordinate of base, mm, and of a place within a slice of 1 mm. */
static const double exact = sizeof(wh_real_t) == sizeof(double) ? 1e-7 : 1e-3;

/* One gripper with one wafer. */
static wh_gripper_t grippers[1];
static wh_wafer_t wafers[1];
static const wh_grasp_t table = {
    .storage = {.wafers = wafers, .wafer_count = 1, .grippers = grippers, .gripper_count = 1}};
static wh_rim_t rim;
static const wh_rim_t *const rims[1] = {&rim};
static wh_blade_outline_t blade;
static wh_door_beam_t beams[2];
static wh_faults_t faults; /* acting ones */
static const wh_latch_order_t keep = {WH_LATCH_KEEP, 0, 0};
static const wh_latch_order_t arm = {WH_LATCH_ARM, 0, 2};

static wh_pose_t at_x(double x) {
    wh_pose_t pose = wh_pose_identity();
    pose.r = wh_vec3((wh_real_t)x, 0, 50);
    return pose;
}

/* Beams at x = 0 and y = +60 and -110; the wafer lies on the gripper as `lies` says. */
static wh_latching_t set_up(const wh_pose_t *lies) {
    const wh_pose_t base = wh_pose_identity();
    const double y[2] = {60, -110};
    memset(beams, 0, sizeof beams);
    for (size_t b = 0; b < 2; ++b) {
        beams[b].beam = wh_beam_at(&base, 0, y[b], 0, 100);
        beams[b].seed = 7;
    }
    rim = wh_rim_nominal(150);
    rim.notch.direction = PI / 2;
    memset(&blade, 0, sizeof blade);
    memset(grippers, 0, sizeof grippers);
    grippers[0].wafer = 0;
    grippers[0].gripper_from_wafer = *lies;
    const wh_latching_t latching = {beams, 2, rims, &blade};
    return latching;
}

static void step(const wh_latching_t *latching, const wh_pose_t *from, const wh_pose_t *to, double slice_s,
                 const wh_latch_order_t *order, wh_latches_t *latches) {
    grippers[0].base_from_gripper = *to;
    wh_latching_step(latching, from, &table, &faults, (wh_real_t)slice_s, order, latches);
}

/* A drive along x from `from` on, `speed` mm/s: latches with their time since the begin, s, in `part`. */
static size_t drive(const wh_latching_t *latching, double from, double speed, double slice_s, int slices,
                    wh_latch_t *list) {
    wh_latches_t latches = {0};
    size_t count = 0;
    wh_pose_t before = at_x(from);
    step(latching, &before, &before, slice_s, &arm, &latches);
    for (int i = 1; i <= slices; ++i) {
        const wh_pose_t after = at_x(from + speed * slice_s * i);
        step(latching, &before, &after, slice_s, &keep, &latches);
        for (int32_t k = 0; k < latches.latch_count; ++k) {
            assert_int_equal(latches.latches[k].slice, i);
            list[count] = latches.latches[k];
            list[count].part = (i - 1 + latches.latches[k].part) * slice_s;
            assert_true(count == 0 || list[count].part >= list[count - 1].part);
            ++count;
        }
        before = after;
    }
    assert_int_equal(latches.lost, 0);
    assert_int_equal(latches.waiting_count, 0);
    return count;
}

/* ------------------------------------------------------------------------------------------- closed forms */

static void latches_come_when_the_rim_does_and_their_delay_later(void **state) {
    (void)state;
    wh_pose_t lies = wh_pose_identity();
    lies.r = wh_vec3(2, -1, 0);
    const wh_latching_t latching = set_up(&lies);
    beams[0].delay_on = 50e-6;
    beams[1].delay_off = 0.0071;
    wh_latch_t list[WH_LATCHES];
#if defined(WH_TEST_COUNTS_HEAP)
    const unsigned long before = calls;
#endif
    const size_t count = drive(&latching, -200, 1000, 0.001, 400, list);
#if defined(WH_TEST_COUNTS_HEAP)
    assert_int_equal(calls - before, 0);
#endif
    const double h0 = sqrt(150 * 150 - 61 * 61);
    const double h1 = sqrt(150 * 150 - 109 * 109);
    const struct {
        int32_t beam;
        wh_crossing_edge_t edge;
        double time;
    } wanted[4] = {{0, WH_CROSSING_IN, (198 - h0) / 1000 + 50e-6},
                   {1, WH_CROSSING_IN, (198 - h1) / 1000},
                   {1, WH_CROSSING_OUT, (198 + h1) / 1000 + 0.0071},
                   {0, WH_CROSSING_OUT, (198 + h0) / 1000}};
    assert_int_equal(count, 4);
    for (size_t i = 0; i < 4; ++i) {
        assert_int_equal(list[i].beam, wanted[i].beam);
        assert_int_equal(list[i].edge, wanted[i].edge);
        assert_near(list[i].part * 1000, wanted[i].time * 1000, exact);
    }
}

static void slices_of_any_length_give_the_same_latches(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    rim.notch.direction = -47.2 * PI / 180; /* a beam enters it */
    beams[0].delay_on = beams[1].delay_off = 0.0015;
    wh_latch_t fine[WH_LATCHES];
    wh_latch_t coarse[WH_LATCHES];
    const size_t count = drive(&latching, -200, 500, 0.001, 900, fine);
    assert_int_equal(drive(&latching, -200, 500, 0.05, 18, coarse), count);
    for (size_t i = 0; i < count; ++i) {
        assert_int_equal(fine[i].beam, coarse[i].beam);
        assert_int_equal(fine[i].edge, coarse[i].edge);
        assert_near(500 * fine[i].part, 500 * coarse[i].part, exact);
    }
}

/* A blade that extends beyond the wafer at its rear: the beam stays broken until the blade has passed. */
static void a_blade_breaks_beams_as_well(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    const wh_blade_outline_t tail = {4, {-170, 20, 20, -170}, {50, 50, 70, 70}};
    blade = tail;
    wh_latch_t list[WH_LATCHES];
    assert_int_equal(drive(&latching, -200, 1000, 0.001, 400, list), 4);
    assert_int_equal(list[3].beam, 0);
    assert_near(list[3].part * 1000, 370, exact);
    grippers[0].wafer = WH_NONE;
    assert_int_equal(drive(&latching, -200, 1000, 0.001, 400, list), 2);
    assert_near(list[0].part * 1000, 180, exact);
    assert_near(list[1].part * 1000, 370, exact);
}

/* Nothing beyond the beam's end is seen; a body that moves down into the beam is. */
static void a_beam_has_two_ends(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    wh_latches_t latches = {0};
    wh_pose_t before = at_x(0);
    before.r.z = 101;
    wh_pose_t after = before;
    after.r.z = 98;
    step(&latching, &before, &before, 0.001, &arm, &latches);
    assert_int_equal(latches.broken, 0);
    step(&latching, &before, &after, 0.001, &keep, &latches);
    assert_int_equal(latches.latch_count, 2);
    assert_int_equal(latches.broken, 3);
    assert_near(latches.latches[0].part, 1.0 / 3, exact);
}

static void orders_arm_and_disarm(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    wh_latches_t latches = {0};
    const wh_pose_t out = at_x(-200);
    const wh_pose_t in = at_x(0);
    step(&latching, &out, &in, 0.001, &keep, &latches);
    assert_int_equal(latches.latch_count, 0);
    step(&latching, &in, &in, 0.001, &arm, &latches); /* broken while it is armed: no latch */
    step(&latching, &in, &in, 0.001, &keep, &latches);
    assert_int_equal(latches.broken, 3);
    assert_int_equal(latches.latch_count, 0);
    beams[0].delay_off = 0.005;
    step(&latching, &in, &out, 0.001, &keep, &latches);
    assert_int_equal(latches.latch_count, 1);
    assert_int_equal(latches.waiting_count, 1);
    wh_latches_t copy = latches; /* a copy continues as the original does */
    for (int i = 0; i < 5; ++i) {
        step(&latching, &out, &out, 0.001, &keep, &latches);
        step(&latching, &out, &out, 0.001, &keep, &copy);
        assert_memory_equal(&copy, &latches, sizeof copy);
    }
    assert_int_equal(latches.latch_count, 1);
    const wh_latch_order_t disarm = {WH_LATCH_DISARM, 0, 0};
    step(&latching, &out, &in, 0.001, &disarm, &latches);
    assert_false(latches.armed);
    step(&latching, &in, &out, 0.001, &keep, &latches);
    assert_int_equal(latches.latch_count, 0);
    assert_int_equal(latches.number, 1);
}

/* A latch that finds no place is counted. */
static void too_many_latches_are_lost_and_counted(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    beams[0].delay_on = beams[0].delay_off = beams[1].delay_on = beams[1].delay_off = 0.01;
    const wh_pose_t ends[2] = {at_x(-200), at_x(0)};
    wh_latches_t latches = {0};
    uint32_t given = 0;
    step(&latching, &ends[0], &ends[0], 0.001, &arm, &latches);
    for (int i = 0; i < 100; ++i) {
        step(&latching, &ends[i < 50 ? i % 2 : 0], &ends[i < 50 ? 1 - i % 2 : 0], 0.001, &keep, &latches);
        given += (uint32_t)latches.latch_count;
    }
    assert_int_equal(latches.crossings, 100);
    assert_true(latches.lost > 0);
    assert_int_equal(given + latches.lost, 100);
}

/* A turn of half a radian in a slice, the rotation as a quaternion that grows evenly. */
static void a_wide_turn_is_followed_and_a_steep_wafer_is_not_seen(void **state) {
    (void)state;
    wh_pose_t lies = wh_pose_identity();
    lies.r.x = 120;
    const wh_latching_t latching = set_up(&lies);
    wh_latches_t latches = {0};
    const wh_pose_t before = at_x(0);
    wh_pose_t after = before;
    const wh_mat3_t turn = {{{(wh_real_t)cos(0.5), (wh_real_t)sin(0.5), 0},
                             {-(wh_real_t)sin(0.5), (wh_real_t)cos(0.5), 0},
                             {0, 0, 1}}};
    after.R = turn;
    const double angle = asin((120. * 120 + 110. * 110 - 150. * 150) / (2 * 120 * 110));
    const double part = tan(angle / 2) / (sin(0.25) + tan(angle / 2) * (1 - cos(0.25)));
    step(&latching, &before, &before, 0.001, &arm, &latches);
    step(&latching, &before, &after, 0.001, &keep, &latches);
    assert_int_equal(latches.latch_count, 2);
    assert_int_equal(latches.latches[0].beam, 1);
    assert_near(120 * latches.latches[0].part, 120 * part, exact);
    assert_int_equal(latches.latches[1].beam, 0);
    assert_int_equal(latches.latches[1].edge, WH_CROSSING_OUT);
    const wh_mat3_t steep = {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}};
    after.R = steep;
    step(&latching, &before, &before, 0.001, &arm, &latches);
    assert_int_equal(latches.broken, 1);
    step(&latching, &before, &after, 0.001, &keep, &latches);
    assert_int_equal(latches.broken, 0);
}

/* A seed gives the same numbers again; each arming has other numbers. */
static void jitter_is_as_wide_as_it_says(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    beams[0].delay_on = 50e-6;
    beams[0].jitter = 10e-6;
    const wh_pose_t out = at_x(-138);
    const wh_pose_t in = at_x(-137);
    wh_latches_t latches = {0};
    wh_latches_t again = {0};
    double sum = 0;
    double squares = 0;
    const int rounds = 2000;
    for (int i = 0; i < rounds; ++i) {
        step(&latching, &out, &out, 0.001, &arm, &latches);
        step(&latching, &out, &in, 0.001, &keep, &latches);
        step(&latching, &out, &out, 0.001, &arm, &again);
        step(&latching, &out, &in, 0.001, &keep, &again);
        assert_int_equal(latches.latch_count, 1);
        assert_memory_equal(&again, &latches, sizeof again);
        const double delay = latches.latches[0].part * 1e-3 - (138 - sqrt(150 * 150 - 60 * 60)) * 1e-3;
        sum += delay;
        squares += delay * delay;
    }
    const double mean = sum / rounds;
    assert_near(mean, 50e-6, 1e-6);
    assert_near(sqrt(squares / rounds - mean * mean), 10e-6, 1e-6);
}

/* --------------------------------------------------------------------------------------------- dense samples */

static bool is_broken(const wh_beam_t *beam, const wh_sweep_t *sweep, const wh_pose_t *lies, double part) {
    wh_pose_t gripper;
    wh_sweep_pose_at(sweep, (wh_real_t)part, &gripper);
    const wh_pose_t wafer = wh_pose_compose(&gripper, lies);
    const wh_vec3_t point = wh_vec3((wh_real_t)beam->x, (wh_real_t)beam->y, (wh_real_t)beam->z);
    const wh_vec3_t along = wh_vec3((wh_real_t)beam->ex, (wh_real_t)beam->ey, (wh_real_t)beam->ez);
    const wh_vec3_t from = wh_vec3_subtract(&point, &wafer.r);
    const wh_vec3_t normal = wh_mat3_column(&wafer.R, 2);
    const wh_real_t height = -wh_vec3_dot(&from, &normal) / wh_vec3_dot(&along, &normal);
    const wh_vec3_t way = wh_vec3_scale(height, &along);
    const wh_vec3_t met = wh_vec3_add(&from, &way);
    const wh_vec3_t at = wh_mat3_transform_back(&wafer.R, &met);
    const double distance = sqrt((double)(at.x * at.x + at.y * at.y));
    return (double)height > beam->low && (double)height < beam->high &&
           distance < wh_rim_radius(&rim, atan2((double)at.y, (double)at.x));
}

/* The instants of change, from this number of samples; returns how many. */
static size_t sample_changes(const wh_beam_t *beam, const wh_sweep_t *sweep, const wh_pose_t *lies,
                             int samples, double *list, size_t most) {
    size_t count = 0;
    bool was = is_broken(beam, sweep, lies, 0);
    for (int i = 1; i <= samples && count < most; ++i) {
        double before = (i - 1.0) / samples;
        double after = (double)i / samples;
        if (is_broken(beam, sweep, lies, after) != was) {
            for (int k = 0; k < 50; ++k) {
                const double middle = (before + after) / 2;
                if (is_broken(beam, sweep, lies, middle) == was) {
                    before = middle;
                } else {
                    after = middle;
                }
            }
            list[count++] = after;
            was = !was;
        }
    }
    return count;
}

/* A quaternion's vector is half of these. */
static wh_pose_t turned(double roll, double pitch, double yaw) {
    wh_pose_t pose = wh_pose_identity();
    const wh_status_t status = wh_rotation_from_quaternion(
        &pose.R, (wh_real_t)sqrt(1 - (roll * roll + pitch * pitch + yaw * yaw) / 4), (wh_real_t)roll / 2,
        (wh_real_t)pitch / 2, (wh_real_t)yaw / 2);
    assert_int_equal(status, WH_OK);
    return pose;
}

/* A rim with a notch and chips about the beam's place, and a body on its way. Notch and chips are
 * drawn such that some slices have several changes. */
static void draw(wh_beam_t *beam, wh_pose_t *lies, wh_pose_t poses[2]) {
    rim = wh_rim_nominal(150);
    rim.notch.opening = wh_test_uniform(1, 2);
    rim.notch.bottom = wh_test_uniform(0, 0.3);
    rim.notch.corner = wh_test_uniform(0, 0.2);
    const double edge = wh_test_uniform(-PI, PI);
    rim.notch.direction = remainder(edge + wh_test_uniform(-0.02, 0.02), 2 * PI);
    rim.chip_count = 2;
    for (size_t i = 0; i < 2; ++i) {
        wh_chip_t chip = {remainder(edge + wh_test_uniform(-0.03, 0.03), 2 * PI), wh_test_uniform(0.3, 4), 0};
        chip.depth = chip.width * wh_test_uniform(0.1, 1);
        rim.chips[i] = chip;
    }
    *lies = turned(wh_test_uniform(-0.02, 0.02), wh_test_uniform(-0.02, 0.02), 0);
    lies->r = wh_vec3((wh_real_t)wh_test_uniform(-5, 5), (wh_real_t)wh_test_uniform(-5, 5), 0);
    poses[0] = turned(wh_test_uniform(-0.1, 0.1), wh_test_uniform(-0.1, 0.1), wh_test_uniform(-0.9, 0.9));
    poses[0].r = wh_vec3(700, (wh_real_t)wh_test_uniform(-300, 300), 900);
    const wh_pose_t turn =
        turned(wh_test_uniform(-0.001, 0.001), wh_test_uniform(-0.001, 0.001), wh_test_uniform(-0.04, 0.04));
    poses[1].R = wh_mat3_multiply(&poses[0].R, &turn.R);
    const wh_pose_t wafer = wh_pose_compose(&poses[0], lies);
    const double radius = 150 + wh_test_uniform(-2, 0.5);
    const wh_vec3_t place = wh_vec3((wh_real_t)(radius * cos(edge)), (wh_real_t)(radius * sin(edge)), 0);
    const wh_vec3_t in_base = wh_pose_point(&wafer, &place);
    /* Every other way is along the rim. */
    const double aside = wh_test_below(2) ? PI / 2 + wh_test_uniform(-0.3, 0.3) : wh_test_uniform(-PI, PI);
    const double far = wh_test_uniform(0, 8);
    const wh_vec3_t way =
        wh_vec3((wh_real_t)(far * cos(edge + aside)), (wh_real_t)(far * sin(edge + aside)), 0);
    const wh_vec3_t way_in_base = wh_mat3_transform(&wafer.R, &way);
    poses[1].r = wh_vec3_add(&poses[0].r, &way_in_base);
    poses[1].r.z += (wh_real_t)wh_test_uniform(-0.2, 0.2);
    wh_pose_t station =
        turned(wh_test_uniform(-0.03, 0.03), wh_test_uniform(-0.03, 0.03), wh_test_uniform(-1, 1));
    station.r = in_base;
    *beam = wh_beam_at(&station, 0, 0, -30, 30);
    assert_int_equal(wh_beam_validate(beam), WH_OK);
}

enum { CHANGES = 32 };

/* Pairs that are so near to each other that one side or the other may miss them are left out. */
static size_t drop_pairs(double *list, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        if (i + 1 < count && list[i + 1] - list[i] < 1e-3) {
            ++i;
        } else {
            list[kept++] = list[i];
        }
    }
    return kept;
}

static size_t find_changes(const wh_beam_t *beam, const wh_shade_t *shade, bool broken,
                           double list[CHANGES]) {
    size_t count = 0;
    double part = 0;
    while (wh_beam_next(beam, shade, 1, &part, &broken)) {
        assert_true(count < CHANGES && (count == 0 || part > list[count - 1]));
        list[count++] = part;
    }
    return count;
}

static void all_changes_are_where_dense_samples_find_them(void **state) {
    (void)state;
    (void)wh_test_seed();
    if (sizeof(wh_real_t) < sizeof(double)) {
        return; /* a float's own roundings are crossings */
    }
    size_t found = 0;
    size_t several = 0;
    double worst = 0;
    for (int trial = 0; trial < 5000 / WH_TEST_SHARE; ++trial) {
        wh_beam_t beam;
        wh_pose_t lies;
        wh_pose_t poses[2];
        wh_sweep_t sweep;
        double wanted[CHANGES];
        double got[CHANGES];
        draw(&beam, &lies, poses);
        wh_sweep_between(&poses[0], &poses[1], &sweep);
        const wh_shade_t shade = {wh_slice_motion_between(&poses[0], &poses[1]), &lies, &rim, NULL};
        size_t count = sample_changes(&beam, &sweep, &lies, 2000, wanted, CHANGES);
        const size_t other = find_changes(&beam, &shade, is_broken(&beam, &sweep, &lies, 0), got);
        count = drop_pairs(wanted, count);
        assert_int_equal(drop_pairs(got, other), count);
        for (size_t k = 0; k < count; ++k) {
            worst = fmax(worst, fabs(got[k] - wanted[k]));
        }
        found += count;
        several += count > 1 ? 1 : 0;
    }
    printf("%zu changes, %zu slices with several; off by at most %.1e of a slice of up to 8 mm\n", found,
           several, worst);
    assert_true(worst <= 1e-9);
    assert_true(found > 1600 / WH_TEST_SHARE);
    assert_true(several > 300 / WH_TEST_SHARE);
}

/* -------------------------------------------------------------------------------- from latches to the centre */

/* A controller that knows the delays and the positions of its axes, slice by slice. */
static size_t collect(const wh_latching_t *latching, const wh_pose_t path[], int slices,
                      wh_crossing_t *list) {
    wh_latches_t latches = {0};
    size_t count = 0;
    step(latching, &path[0], &path[0], 0.001, &arm, &latches);
    for (int i = 1; i <= slices; ++i) {
        step(latching, &path[i - 1], &path[i], 0.001, &keep, &latches);
        for (int32_t k = 0; k < latches.latch_count; ++k) {
            const wh_latch_t *latch = &latches.latches[k];
            const wh_door_beam_t *door = &beams[latch->beam];
            const double delay = latch->edge == WH_CROSSING_IN ? door->delay_on : door->delay_off;
            const double time = i - 1 + latch->part - delay / 0.001;
            const int slice = (int)time;
            const wh_slice_motion_t motion = wh_slice_motion_between(&path[slice], &path[slice + 1]);
            assert_true(wh_beam_crossing(&door->beam, &motion, time - slice, 0.001, &list[count]));
            list[count].beam = latch->beam;
            list[count].edge = latch->edge;
            ++count;
        }
    }
    return count;
}

static void latches_give_back_the_wafers_centre(void **state) {
    (void)state;
    (void)wh_test_seed();
    static wh_pose_t path[801];
    for (int trial = 0; trial < 20; ++trial) {
        wh_pose_t lies = turned(0, 0, wh_test_uniform(-1, 1));
        lies.r = wh_vec3((wh_real_t)wh_test_uniform(-3, 3), (wh_real_t)wh_test_uniform(-3, 3), 0);
        const wh_latching_t latching = set_up(&lies);
        rim.notch.direction = wh_test_uniform(-PI, PI);
        for (size_t b = 0; b < 2; ++b) {
            beams[b].delay_on = wh_test_uniform(0, 100e-6);
            beams[b].delay_off = wh_test_uniform(0, 3e-3);
        }
        for (int i = 0; i <= 800; ++i) { /* faster and slower, and the blade turns */
            path[i] = turned(0, 0, 0.1 - 0.0002 * i);
            path[i].r =
                wh_vec3((wh_real_t)(-200 + 0.5 * i + 20 * sin(0.01 * i)), (wh_real_t)(3 - 0.005 * i), 50);
        }
        wh_crossing_t list[WH_CROSSINGS];
        wh_centres_t centres;
        const size_t count = collect(&latching, path, 800, list);
        const wh_centring_t known = wh_centring_nominal(150);
        assert_int_equal(wh_centring_solve(&known, list, count, &centres), WH_OK);
        assert_near(centres.candidates[0].x, lies.r.x, exact);
        assert_near(centres.candidates[0].y, lies.r.y, exact);
    }
}

/* --------------------------------------------------------------------------------------------- bad input */

static void what_is_no_beam_is_refused(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    wh_latching_t latching = set_up(&lies);
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_OK);
    assert_int_equal(wh_latching_validate(NULL, 1, 1), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_latching_validate(&latching, WH_GRIPPERS + 1, 1), WH_STATUS_BAD_CAPACITY);
    beams[1].jitter = (double)NAN;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_NOT_FINITE);
    beams[1].jitter = 0;
    beams[1].delay_on = -1e-6;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_OUT_OF_RANGE);
    beams[1].delay_on = 0;
    beams[1].beam.ez = 0.9;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_OUT_OF_RANGE);
    beams[1].beam.ez = (double)INFINITY;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_NOT_FINITE);
    beams[1].beam.ez = 1;
    blade.count = 2;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_OUT_OF_RANGE);
    blade.count = 3;
    blade.x[1] = (double)NAN;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_NOT_FINITE);
    blade.count = 0;
    rim.radius = 1;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_OUT_OF_RANGE);
    latching.rims = NULL;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_NULL_ARGUMENT);
    latching.beam_count = 0;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_OK);
    assert_int_equal(wh_latching_check(&latching, &keep), WH_OK);
    assert_int_equal(wh_latching_check(&latching, &arm), WH_STATUS_OUT_OF_RANGE);
    latching.beam_count = 2;
    assert_int_equal(wh_latching_check(&latching, &arm), WH_OK);
    const wh_latch_order_t wild = {WH_LATCH_ARM, 1, INT32_MAX};
    assert_int_equal(wh_latching_check(&latching, &wild), WH_STATUS_OUT_OF_RANGE);
}

/* ---------------------------------------------------------------------------------------------------- touches */

/* The ball of a probe below the gripper, and a face at x = 0 that looks towards -x. */
static wh_latching_t set_up_face(void) {
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    grippers[0].wafer = WH_NONE;
    const wh_touch_face_t face = {{0, 0, 40}, {-1, 0, 0}, {0, 1, 0}, 20, 5, {3, 0, -12}, 1.5};
    beams[0] = (wh_door_beam_t){.seed = 7, .kind = WH_DOOR_TOUCH, .touch = face};
    beams[1] = beams[0];
    return latching;
}

static const wh_latch_order_t arm_first = {WH_LATCH_ARM, 0, 1};

/* The places along x at which the switch closes and opens again, with the gripper `aside` along y,
 * on a way there and back in slices of 0.3 mm; the number of its latches. */
static size_t touch(const wh_latching_t *latching, double aside, uint32_t number, double at[2]) {
    wh_latches_t latches = {.number = number};
    size_t count = 0;
    wh_pose_t before = at_x(-9.07);
    before.r.y = (wh_real_t)aside;
    step(latching, &before, &before, 0.001, &arm_first, &latches);
    for (int i = 1; i <= 60; ++i) {
        wh_pose_t after = before;
        after.r.x += (wh_real_t)(i <= 30 ? 0.3 : -0.3);
        step(latching, &before, &after, 0.001, &keep, &latches);
        for (int32_t k = 0; k < latches.latch_count; ++k) {
            const wh_latch_t *latch = &latches.latches[k];
            assert_int_equal(latch->edge, count == 0 ? WH_CROSSING_IN : WH_CROSSING_OUT);
            assert_true(count < 2 && latch->slice == i);
            at[count] = (double)before.r.x + latch->part * ((double)after.r.x - (double)before.r.x);
            ++count;
        }
        before = after;
    }
    return count;
}

/* The switch acts where the ball meets the face, there and back. Noise makes both earlier or later
 * by the same amount, with the stated width; beside the face it never acts. */
static void a_probe_feels_a_face(void **state) {
    (void)state;
    const wh_latching_t latching = set_up_face();
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_OK);
    double at[2];
    assert_int_equal(touch(&latching, 0, 0, at), 2);
    assert_true(fabs(at[0] + 4.5) < exact && fabs(at[1] + 4.5) < exact);
    assert_int_equal(touch(&latching, 20.5, 0, at), 0);
    assert_int_equal(touch(&latching, -19.5, 0, at), 2);
    beams[0].noise = 0.005;
    double squares = 0;
    for (uint32_t number = 0; number < 400; ++number) {
        assert_int_equal(touch(&latching, 0, number, at), 2);
        assert_true(fabs(at[1] - at[0]) < exact);
        squares += (at[0] + 4.5) * (at[0] + 4.5) / 400;
    }
    assert_true(fabs(sqrt(squares) / 0.005 - 1) < 0.12);
    beams[0].stuck = WH_BEAM_DARK;
    assert_int_equal(touch(&latching, 0, 0, at), 0);
    wh_latches_t latches = {0};
    const wh_pose_t far = at_x(-100);
    step(&latching, &far, &far, 0.001, &arm_first, &latches);
    assert_int_equal(latches.broken, 1);
    beams[0].stuck = WH_BEAM_LIT;
    step(&latching, &far, &far, 0.001, &arm_first, &latches);
    assert_int_equal(latches.broken, 0);
}

/* ----------------------------------------------------------------------------------------- faults on purpose */

static void act(wh_fault_kind_t kind, int32_t target, double value) {
    memset(&faults, 0, sizeof faults);
    faults.count = 1;
    faults.slots[0].fault = wh_fault_make(kind, target, (wh_real_t)value, 1, WH_FAULT_FOREVER);
    faults.slots[0].phase = WH_FAULT_ACTING;
}

static int heal(void **state) {
    (void)state;
    memset(&faults, 0, sizeof faults);
    return 0;
}

static void latches_of_a_fault_are_late_by_as_much(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    beams[1].delay_on = 0.009;
    wh_latch_t sound[WH_LATCHES];
    wh_latch_t late[WH_LATCHES];
    assert_int_equal(drive(&latching, -200, 1000, 0.001, 400, sound), 4);
    act(WH_FAULT_BEAM_LATE, 1, 0.01);
    assert_int_equal(drive(&latching, -200, 1000, 0.001, 400, late), 4);
    for (size_t i = 0; i < 4; ++i) {
        for (size_t k = 0; k < 4; ++k) {
            if (sound[i].beam == late[k].beam && sound[i].edge == late[k].edge) {
                assert_near(1000 * (late[k].part - sound[i].part), sound[i].beam == 1 ? 10 : 0, exact);
            }
        }
    }
}

/* The sensor's output changes as the fault begins and as it ends, and each change is latched. In
 * between there is no change, and a sensor that is armed in that time finds the faulty output. */
static void a_beam_that_a_fault_breaks_down_says_so(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    beams[0].delay_on = 0.0004;
    const wh_pose_t out = at_x(-200);
    const wh_pose_t in = at_x(0);
    wh_latches_t latches = {0};
    step(&latching, &out, &out, 0.001, &arm, &latches);
    act(WH_FAULT_BEAM_DARK, 0, 0);
    step(&latching, &out, &out, 0.001, &keep, &latches);
    assert_int_equal(latches.broken, 1);
    assert_int_equal(latches.latch_count, 1);
    assert_int_equal(latches.latches[0].edge, WH_CROSSING_IN);
    assert_near(latches.latches[0].part, 0.4, sizeof(wh_real_t) == sizeof(double) ? 1e-9 : 1e-6);
    step(&latching, &out, &in, 0.001, &keep, &latches);
    assert_int_equal(latches.latch_count, 1); /* from the other beam */
    step(&latching, &in, &out, 0.001, &keep, &latches);
    assert_int_equal(latches.broken, 1);
    (void)heal(NULL);
    step(&latching, &out, &out, 0.001, &keep, &latches);
    assert_int_equal(latches.latch_count, 1);
    assert_int_equal(latches.latches[0].edge, WH_CROSSING_OUT);
    assert_near(latches.latches[0].part, 0, 1e-9);
    assert_int_equal(latches.broken, 0);
    act(WH_FAULT_BEAM_LIT, 1, 0);
    step(&latching, &in, &in, 0.001, &arm, &latches);
    assert_int_equal(latches.broken, 1);
    beams[0].stuck = WH_BEAM_LIT; /* its own breakdown has priority over a fault's */
    act(WH_FAULT_BEAM_DARK, 0, 0);
    step(&latching, &in, &in, 0.001, &arm, &latches);
    assert_int_equal(latches.broken, 2);
}

static void a_switch_that_a_fault_breaks_down_says_so(void **state) {
    (void)state;
    const wh_latching_t latching = set_up_face();
    const wh_pose_t far = at_x(-100);
    wh_latches_t latches = {0};
    double at[2];
    act(WH_FAULT_BEAM_DARK, 0, 0); /* of no switch */
    assert_int_equal(touch(&latching, 0, 0, at), 2);
    act(WH_FAULT_PROBE_OPEN, 0, 0);
    assert_int_equal(touch(&latching, 0, 0, at), 0);
    act(WH_FAULT_PROBE_CLOSED, 0, 0);
    assert_int_equal(touch(&latching, 0, 0, at), 0);
    step(&latching, &far, &far, 0.001, &arm_first, &latches);
    assert_int_equal(latches.broken, 1);
    (void)heal(NULL);
    step(&latching, &far, &far, 0.001, &keep, &latches);
    assert_int_equal(latches.latch_count, 1);
    assert_int_equal(latches.latches[0].edge, WH_CROSSING_OUT);
}

static void what_is_no_face_is_refused(void **state) {
    (void)state;
    const wh_latching_t latching = set_up_face();
    wh_touch_face_t *face = &beams[1].touch;
    const struct {
        double *number;
        double wrong;
    } cases[] = {{&face->middle[1], 1.1e5}, {&face->normal[0], -0.9}, {&face->edge[1], 0.9},
                 {&face->edge[0], 0.1},     {&face->along, 0},        {&face->aside, 1001},
                 {&face->ball[2], -1001},   {&face->radius, -0.1},    {&beams[1].noise, 0.11}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const double good = *cases[i].number;
        *cases[i].number = cases[i].wrong;
        assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_OUT_OF_RANGE);
        *cases[i].number = (double)NAN;
        assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_NOT_FINITE);
        *cases[i].number = good;
    }
    assert_int_equal(wh_touch_validate(NULL), WH_STATUS_NULL_ARGUMENT);
    beams[1].gripper = 1;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_OUT_OF_RANGE);
    beams[1].gripper = 0;
    beams[1].kind = (wh_door_kind_t)2;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_OUT_OF_RANGE);
    beams[1].kind = WH_DOOR_TOUCH;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_OK);
    const wh_pose_t over = at_x(-4.5);
    assert_true(fabs(wh_touch_gap(face, &over)) < exact);
}

/* --------------------------------------------------------------------------------------------- in a simulator */

/* A simulator of one wafer that its gripper carries along x. */
typedef struct {
    wh_simulator_t simulator;
    wh_wafer_t wafers[1];
    wh_gripper_t grippers[1];
    wh_command_t command;
    wh_state_t state;
} run_t;

static run_t run, twin;
static const wh_station_t nowhere = {.slots = 1, .pitch = 10, .chuck = WH_NONE};

static void begin(run_t *of, const wh_latching_t *latching) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {of->wafers, 1, of->grippers, 1, NULL, 0};
    wh_station_t station = nowhere;
    station.base_from_station = wh_pose_identity();
    static wh_station_t stations[1];
    stations[0] = station;
    const wh_cell_t cell = {stations, 1, wh_tolerance_paper(), 0, 0, false, 0, 0};
    memset(of, 0, sizeof *of);
    of->wafers[0].base_from_wafer = at_x(-200);
    assert_int_equal(wh_simulator_init(&of->simulator, &config, &storage, &cell), WH_OK);
    if (latching) {
        assert_int_equal(wh_simulator_set_latching(&of->simulator, latching), WH_OK);
    }
    of->command.gripper_count = 1;
}

/* Moves to x in the next slice, with the vacuum on. */
static wh_status_t go(run_t *of, double x, wh_latch_order_t order) {
    ++of->command.seq;
    of->command.grippers[0].base_from_gripper = at_x(x);
    of->command.grippers[0].valve = WH_VALVE_OPEN;
    of->command.latch = order;
    return wh_simulator_step(&of->simulator, &of->command, &of->state);
}

static void a_simulator_gives_the_latches_of_what_it_carries(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    const double h[2] = {sqrt(150 * 150 - 60 * 60), sqrt(150 * 150 - 110 * 110)};
    const double wanted[4] = {-h[0], -h[1], h[1], h[0]};
    size_t count = 0;
    beams[1].delay_off = 0.002;
    begin(&run, &latching);
    assert_int_equal(go(&run, -200, arm), WH_OK);
    assert_int_equal(run.grippers[0].wafer, 0);
    assert_int_equal(run.state.physics->latches.number, 1);
    for (int i = 1; i <= 800; ++i) {
        assert_int_equal(go(&run, -200 + 0.5 * i, keep), WH_OK);
        const wh_latches_t *latches = &run.state.physics->latches;
        for (int32_t k = 0; k < latches->latch_count; ++k) {
            const double delay =
                latches->latches[k].beam == 1 && latches->latches[k].edge == WH_CROSSING_OUT ? 2 : 0;
            const double slices = i - 1 + latches->latches[k].part - delay;
            /* within 1 us: at 0.5 mm a slice of 1 ms */
            assert_near((-200 + 0.5 * slices - wanted[count]) / 0.5, 0, exact);
            ++count;
        }
    }
    assert_int_equal(count, 4);
}

static void a_stuck_beam_gives_no_latch(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    wh_latch_t list[WH_LATCHES];
    for (int stuck = WH_BEAM_DARK; stuck <= WH_BEAM_LIT; ++stuck) {
        beams[0].stuck = (wh_beam_stuck_t)stuck;
        assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_OK);
        assert_int_equal(drive(&latching, -200, 1000, 0.001, 400, list), 2);
        assert_int_equal(list[0].beam, 1);
        assert_int_equal(list[1].beam, 1);
        begin(&run, &latching);
        assert_int_equal(go(&run, -200, arm), WH_OK);
        assert_int_equal(run.state.physics->latches.broken, stuck == WH_BEAM_DARK ? 1 : 0);
    }
    beams[0].stuck = (wh_beam_stuck_t)3;
    assert_int_equal(wh_latching_validate(&latching, 1, 1), WH_STATUS_OUT_OF_RANGE);
}

static void what_no_beam_can_take_is_refused(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    wh_latching_t latching = set_up(&lies);
    begin(&run, NULL);
    const uint64_t hash = wh_simulator_hash(&run.simulator);
    assert_int_equal(go(&run, -200, arm), WH_STATUS_OUT_OF_RANGE);
    assert_true(wh_simulator_hash(&run.simulator) == hash);
    assert_int_equal(run.simulator.table.counters.refused, 1);
    assert_int_equal(wh_simulator_set_latching(NULL, &latching), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_set_latching(&run.simulator, NULL), WH_STATUS_NULL_ARGUMENT);
    memset(&twin, 0, sizeof twin);
    assert_int_equal(wh_simulator_set_latching(&twin.simulator, &latching), WH_STATUS_NOT_INITIALISED);
    beams[0].jitter = -1;
    assert_int_equal(wh_simulator_set_latching(&run.simulator, &latching), WH_STATUS_OUT_OF_RANGE);
    beams[0].jitter = 0;
    assert_int_equal(wh_simulator_set_latching(&run.simulator, &latching), WH_OK);
    const wh_latch_order_t third = {WH_LATCH_ARM, 1, 2};
    assert_int_equal(go(&run, -200, third), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(go(&run, -200, arm), WH_OK);
    assert_int_equal(wh_simulator_set_latching(&run.simulator, &latching), WH_STATUS_OUT_OF_RANGE);
}

/* Beams that are not armed change nothing. */
static void a_run_hashes_beams_once_they_were_armed(void **state) {
    (void)state;
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    begin(&run, &latching);
    begin(&twin, NULL);
    for (int i = 0; i < 100; ++i) {
        assert_int_equal(go(&run, -200 + i, keep), WH_OK);
        assert_int_equal(go(&twin, -200 + i, keep), WH_OK);
        assert_true(wh_simulator_hash(&run.simulator) == wh_simulator_hash(&twin.simulator));
    }
    assert_int_equal(go(&run, -100, arm), WH_OK);
    assert_int_equal(go(&twin, -100, keep), WH_OK);
    assert_true(wh_simulator_hash(&run.simulator) != wh_simulator_hash(&twin.simulator));
}

static void expect_unsound(const wh_physics_state_t *physics) {
    assert_int_equal(wh_physics_state_validate(physics, 1, 1), WH_STATUS_OUT_OF_RANGE);
}

/* A state with one latch to come. */
static void no_other_latches_are_sound(const wh_physics_state_t *sound) {
    assert_int_equal(wh_physics_state_validate(sound, 1, 1), WH_OK);
    wh_physics_state_t broken = *sound;
    broken.latches.waiting[0].slice = broken.latches.slice;
    expect_unsound(&broken);
    broken = *sound;
    broken.latches.waiting[0].part = (double)NAN;
    expect_unsound(&broken);
    broken = *sound;
    broken.latches.waiting[0].beam = 2;
    expect_unsound(&broken);
    broken = *sound;
    broken.latches.waiting_count = WH_LATCHES + 1;
    expect_unsound(&broken);
    broken = *sound;
    broken.latches.latch_count = 1; /* of no slice */
    memset(&broken.latches.latches[0], 0, sizeof broken.latches.latches[0]);
    expect_unsound(&broken);
    broken = *sound;
    broken.latches.broken = 4;
    expect_unsound(&broken);
    broken = *sound;
    broken.latches.count = WH_BEAMS + 1;
    expect_unsound(&broken);
    broken = *sound;
    broken.latches.number = 0;
    expect_unsound(&broken);
}

/* With latches that are on their way. */
static void a_saved_pass_goes_on_bit_for_bit(void **state) {
    (void)state;
    static uint8_t bytes[WH_SNAPSHOT_SIZE(1, 1)];
    static wh_wafer_t room_wafers[1];
    static wh_gripper_t room_grippers[1];
    static wh_snapshot_room_t room = {.wafers = room_wafers, .grippers = room_grippers};
    const wh_pose_t lies = wh_pose_identity();
    const wh_latching_t latching = set_up(&lies);
    size_t size = 0;
    beams[0].delay_on = 0.005;
    beams[0].jitter = 1e-4;
    begin(&run, &latching);
    begin(&twin, &latching);
    assert_int_equal(go(&run, -200, arm), WH_OK);
    assert_int_equal(go(&run, -140, keep), WH_OK);
    for (int i = 1; i <= 3; ++i) {
        assert_int_equal(go(&run, -140 + i, keep), WH_OK);
    }
    assert_int_equal(run.state.physics->latches.waiting_count, 1);
    assert_int_equal(wh_simulator_save(&run.simulator, bytes, sizeof bytes, &size), WH_OK);
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_OK);
    twin.command.seq = run.command.seq;
    int latches = 0;
    for (int i = 4; i <= 280; ++i) {
        assert_int_equal(go(&run, -140 + i, keep), WH_OK);
        assert_int_equal(go(&twin, -140 + i, keep), WH_OK);
        assert_true(wh_simulator_hash(&run.simulator) == wh_simulator_hash(&twin.simulator));
        latches += twin.state.physics->latches.latch_count;
    }
    assert_int_equal(latches, 4);
    beams[0].jitter = 2e-4;
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_STATUS_OTHER_SNAPSHOT);
    beams[0].jitter = 1e-4;
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_OK);
    no_other_latches_are_sound(&twin.simulator.physics);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(latches_come_when_the_rim_does_and_their_delay_later),
        cmocka_unit_test(slices_of_any_length_give_the_same_latches),
        cmocka_unit_test(a_blade_breaks_beams_as_well),
        cmocka_unit_test(a_beam_has_two_ends),
        cmocka_unit_test(orders_arm_and_disarm),
        cmocka_unit_test(too_many_latches_are_lost_and_counted),
        cmocka_unit_test(a_wide_turn_is_followed_and_a_steep_wafer_is_not_seen),
        cmocka_unit_test(jitter_is_as_wide_as_it_says),
        cmocka_unit_test(all_changes_are_where_dense_samples_find_them),
        cmocka_unit_test(latches_give_back_the_wafers_centre),
        cmocka_unit_test(what_is_no_beam_is_refused),
        cmocka_unit_test(a_probe_feels_a_face),
        cmocka_unit_test_teardown(latches_of_a_fault_are_late_by_as_much, heal),
        cmocka_unit_test_teardown(a_beam_that_a_fault_breaks_down_says_so, heal),
        cmocka_unit_test_teardown(a_switch_that_a_fault_breaks_down_says_so, heal),
        cmocka_unit_test(what_is_no_face_is_refused),
        cmocka_unit_test(a_simulator_gives_the_latches_of_what_it_carries),
        cmocka_unit_test(a_stuck_beam_gives_no_latch),
        cmocka_unit_test(what_no_beam_can_take_is_refused),
        cmocka_unit_test(a_run_hashes_beams_once_they_were_armed),
        cmocka_unit_test(a_saved_pass_goes_on_bit_for_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
