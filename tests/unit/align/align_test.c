/* A wafer's rim, a sensor's samples of it, and the circle found from them, compared with known answers. */
#include "support/heap.h"

#include "align/align.h"
#include "align/calibration.h"
#include "align/merge.h"

enum { SAMPLES = 3600 };

static wh_rim_point_t points[SAMPLES];
static wh_rim_ray_t rays[SAMPLES];

/* Samples of a wafer at (3, -4). */
static void sample(const wh_sensor_t *sensor, const wh_rim_t *rim, double turn, int from, int to) {
    const wh_placement_t placement = {3, -4, turn};
    for (int i = from; i < to; ++i) {
        const wh_glance_t glance = {wh_sensor_angle(sensor, i), 6, {1, 2}, (uint32_t)i};
        const int32_t dark = wh_sensor_read(sensor, rim, &placement, &glance);
        points[i] = wh_sensor_point(sensor, &sensor->error, &glance, dark);
    }
}

/* A whole turn of it. */
static wh_rim_scan_t scan_of_rim(const wh_sensor_t *sensor, const wh_rim_t *rim) {
    sample(sensor, rim, 0.7, 0, SAMPLES);
    const wh_rim_scan_t scan = {points, SAMPLES, sensor->error.offset, sensor->pixel};
    return scan;
}

static wh_rim_scan_t scan_of(const wh_sensor_t *sensor) {
    const wh_rim_t rim = wh_rim_nominal(150);
    return scan_of_rim(sensor, &rim);
}

static void a_notch_is_as_deep_and_as_wide_as_drawn(void **state) {
    (void)state;
    wh_rim_t rim = wh_rim_nominal(150);
    rim.notch.corner = 0;
    assert_true(fabs(wh_rim_radius(&rim, 0) - 149) < 1e-5);
    assert_true(wh_rim_radius(&rim, 0.5219 / 57.29578) < 150);
    assert_true(wh_rim_radius(&rim, 0.5221 / 57.29578) >= 150);
    wh_bad_field_t bad = {NULL, 0};
    rim.notch.bottom = 2;
    rim.notch.depth = 0.3;
    assert_int_equal(wh_rim_validate(&rim, &bad), WH_STATUS_OUT_OF_RANGE);
    assert_string_equal(bad.name, "notch.bottom");
    rim = wh_rim_nominal(75);
    rim.flats[1].length = (double)NAN;
    assert_int_equal(wh_rim_validate(&rim, &bad), WH_STATUS_NOT_FINITE);
    assert_string_equal(bad.name, "flats.length");
    assert_int_equal(bad.index, 1);
}

static void samples_are_due_once_whatever_the_slices(void **state) {
    (void)state;
    const wh_sensor_t sensor = wh_sensor_nominal(150);
    int64_t first = 0;
    int64_t wanted = 1;
    for (int i = 0; i < 1000; ++i) {
        const size_t due = wh_sensor_due(&sensor, i * 0.00613, (i + 1) * 0.00613, &first);
        assert_true(due == 0 || first == wanted);
        wanted += (int64_t)due;
    }
    assert_int_equal(wh_sensor_due(&sensor, 0.01, -0.01, &first), 11);
    assert_int_equal(first, 5);
}

static void the_centre_is_found_and_nothing_is_allocated(void **state) {
    (void)state;
    wh_sensor_t sensor = wh_sensor_nominal(150);
    sensor.noise = 0.005;
    sensor.error.offset = 0.1;
    sensor.hidden_count = 1;
    sensor.hidden[0].width = 2;
#if defined(WH_TEST_COUNTS_HEAP)
    const unsigned long before = calls;
#endif
    const wh_rim_scan_t scan = scan_of(&sensor);
    wh_circle_t circle;
    const wh_status_t status = wh_circle_fit(&scan, rays, &circle);
#if defined(WH_TEST_COUNTS_HEAP)
    assert_int_equal(calls - before, 0);
#endif
    assert_int_equal(status, WH_OK);
    assert_true(fabs(circle.x - 3) < 0.001 && fabs(circle.y + 4) < 0.001);
    assert_true(fabs(circle.x - 3) < 6 * circle.sd_x && fabs(circle.y + 4) < 6 * circle.sd_y);
}

static void what_is_no_scan_is_refused(void **state) {
    (void)state;
    const wh_sensor_t sensor = wh_sensor_nominal(150);
    wh_rim_scan_t scan = scan_of(&sensor);
    wh_circle_t circle = {.x = 7};
    scan.count = WH_SCAN_LEAST - 1;
    assert_int_equal(wh_circle_fit(&scan, rays, &circle), WH_STATUS_TOO_FEW_SAMPLES);
    scan.count = SAMPLES;
    points[9].radius = (double)NAN;
    assert_int_equal(wh_circle_fit(&scan, rays, &circle), WH_STATUS_BAD_SCAN);
    scan = scan_of(&sensor);
    points[9].sight = (wh_sight_t)99;
    assert_int_equal(wh_circle_fit(&scan, rays, &circle), WH_STATUS_BAD_SCAN);
    scan = scan_of(&sensor);
    assert_int_equal(wh_circle_fit(&scan, (wh_rim_ray_t *)(void *)&points[8], &circle), WH_STATUS_OVERLAP);
    points[9].angle = points[7].angle;
    assert_int_equal(wh_circle_fit(&scan, rays, &circle), WH_STATUS_BAD_SCAN);
    scan = scan_of(&sensor);
    for (int i = 0; i < SAMPLES; ++i) {
        points[i].radius = 150;
    }
    assert_int_equal(wh_circle_fit(&scan, rays, &circle), WH_STATUS_BAD_SCAN);
    for (int i = 0; i < SAMPLES; ++i) {
        points[i].sight = WH_SIGHT_NOTHING;
    }
    assert_int_equal(wh_circle_fit(&scan, rays, &circle), WH_STATUS_TOO_FEW_SAMPLES);
    assert_true(circle.x == 7);
}

/* The verdict on a whole turn of `rim`, evaluated as if it were `nominal`. */
static wh_align_result_t verdict_on(const wh_sensor_t *sensor, const wh_rim_t *rim, const wh_rim_t *nominal,
                                    const wh_align_limits_t *limits) {
    const wh_rim_scan_t scan = scan_of_rim(sensor, rim);
    wh_align_result_t result;
    assert_int_equal(wh_align_estimate(&scan, sensor, nominal, limits, rays, &result), WH_OK);
    return result;
}

static void each_verdict_has_its_cause(void **state) {
    (void)state;
    const wh_align_limits_t limits = wh_align_limits_default();
    const wh_rim_t nominal = wh_rim_nominal(150);
    wh_sensor_t sensor = wh_sensor_nominal(150);
    wh_align_result_t result = verdict_on(&sensor, &nominal, &nominal, &limits);
    assert_int_equal(result.verdict, WH_OK);
    assert_int_equal(result.mark, WH_ALIGN_MARK_NOTCH);
    assert_true(fabs(result.turn - 0.7) < 5e-5 && fabs(result.notch.depth - 1) < 0.02);
    assert_true(fabs(result.eccentricity - 5) < 0.001 && fabs(result.direction + 0.927295) < 1e-3);
    assert_true(result.masked > 5 && result.hidden == 0 && result.rms < 0.004);

    wh_align_limits_t other = limits;
    other.eccentricity = 4.9;
    assert_int_equal(verdict_on(&sensor, &nominal, &nominal, &other).verdict, WH_STATUS_TOO_ECCENTRIC);
    other = limits;
    other.sd_turn = 1e-9;
    assert_int_equal(verdict_on(&sensor, &nominal, &nominal, &other).verdict, WH_STATUS_NOTCH_NOT_SURE);
    wh_rim_t rim = nominal;
    rim.radius = 150.6;
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_STATUS_CENTRE_NOT_SURE);
    rim = nominal;
    rim.notch.depth = 0;
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_STATUS_NO_NOTCH);
    assert_int_equal(verdict_on(&sensor, &rim, &rim, &limits).mark, WH_ALIGN_MARK_NONE);
    sensor.hidden_count = 1;
    sensor.hidden[0] = (wh_arc_t){0.6, 0.2};
    assert_int_equal(verdict_on(&sensor, &nominal, &nominal, &limits).verdict, WH_STATUS_NOTCH_NOT_SURE);
    sensor = wh_sensor_nominal(150);
    sensor.length = 9;
    assert_int_equal(verdict_on(&sensor, &nominal, &nominal, &limits).verdict, WH_STATUS_OFF_SENSOR);
}

static void a_chip_is_told_from_a_notch_by_a_sharp_scan_alone(void **state) {
    (void)state;
    const wh_align_limits_t limits = wh_align_limits_default();
    const wh_rim_t nominal = wh_rim_nominal(150);
    wh_sensor_t sensor = wh_sensor_nominal(150);
    wh_rim_t rim = nominal;
    rim.chip_count = 1;
    rim.chips[0] = (wh_chip_t){2, 4, 1.5};
    const wh_align_result_t result = verdict_on(&sensor, &rim, &nominal, &limits);
    assert_int_equal(result.verdict, WH_OK);
    assert_true(fabs(result.turn - 0.7) < 5e-5);
    sensor.noise = 0.02;
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_STATUS_NOTCH_NOT_SURE);
    /* A dent narrower than a notch never was a notch. */
    rim.chips[0] = (wh_chip_t){2, 1.5, 1.4};
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_OK);
}

static void a_notch_is_sure_only_if_its_bottom_agrees(void **state) {
    (void)state;
    const wh_align_limits_t limits = wh_align_limits_default();
    wh_rim_t nominal = wh_rim_nominal(150);
    const wh_sensor_t sensor = wh_sensor_nominal(150);
    wh_rim_t rim = nominal;
    nominal.notch.bottom = 0.3;
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_STATUS_NOTCH_NOT_SURE);
    nominal.notch.bottom = 0.85;
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_OK);
    nominal = rim;
    rim.chip_count = 1;
    rim.chips[0] = (wh_chip_t){0.7 / 150, 1.9, 0.8};
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_STATUS_NOTCH_NOT_SURE);
}

enum { OF_REFERENCE = 360 };

/* Four scans of a known wafer, and room for one more: two places, with the chuck turning both ways. */
static void scan_reference(const wh_sensor_t *sensor, wh_calibration_scan_t scans[4]) {
    const wh_rim_t rim = wh_rim_nominal(150);
    for (size_t k = 0; k < 4; ++k) {
        const wh_placement_t placement = {k < 2 ? -6 : 6, k < 2 ? 1 : -4, 0.7};
        const double speed = k % 2 == 0 ? 6 : -6;
        wh_rim_point_t *own = &points[k * OF_REFERENCE];
        for (size_t i = 0; i < OF_REFERENCE; ++i) {
            const int64_t at = (int64_t)(speed > 0 ? i : OF_REFERENCE - i);
            const wh_glance_t glance = {wh_sensor_angle(sensor, at), speed, {1, k}, (uint32_t)i};
            own[i] =
                wh_sensor_point(sensor, NULL, &glance, wh_sensor_read(sensor, &rim, &placement, &glance));
        }
        scans[k] = (wh_calibration_scan_t){own, OF_REFERENCE, speed, k < 2 ? 0 : 12, k < 2 ? 0 : -5};
    }
}

static void a_sensor_is_calibrated_by_a_known_wafer(void **state) {
    (void)state;
    wh_sensor_t sensor = wh_sensor_nominal(150);
    wh_calibration_scan_t scans[4];
    wh_calibration_t found = {.mismatch = 7};
    int32_t bad = 7;
    sensor.samples = OF_REFERENCE;
    sensor.pixel = 0.001;
    sensor.error = (wh_sensor_error_t){0.1, -0.2, 1e-3, 20e-6};
    scan_reference(&sensor, scans);
    wh_rim_point_t *room = &points[4 * OF_REFERENCE];
    assert_int_equal(wh_calibration_solve(&sensor, 150, 0, scans, 3, room, rays, &found, &bad),
                     WH_STATUS_TOO_FEW_SAMPLES);
    assert_int_equal(wh_calibration_solve(&sensor, 150, 0, scans, 4, room, NULL, &found, &bad),
                     WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_calibration_solve(&sensor, (double)NAN, 0, scans, 4, room, rays, &found, &bad),
                     WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_calibration_solve(&sensor, 150, 1.1, scans, 4, room, rays, &found, &bad),
                     WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(bad, WH_NONE);
    scans[2].speed = 101;
    assert_int_equal(wh_calibration_solve(&sensor, 150, 0, scans, 4, room, rays, &found, &bad),
                     WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(bad, 2);
    assert_true(found.mismatch == 7);
    scans[2].speed = 6;
    assert_int_equal(wh_calibration_solve(&sensor, 150, 0, scans, 4, room, rays, &found, NULL), WH_OK);
    assert_true(fabs(found.error.offset - 0.1) < 0.002 && fabs(found.error.zero + 0.2) < 2e-4);
    assert_true(fabs(found.error.gain - 1e-3) < 1e-5 && fabs(found.error.latency - 20e-6) < 1e-6);
    assert_true(fabs(found.x + 6) < 2e-4 && fabs(found.y - 1) < 2e-4);
    assert_true(found.sd_gain > 0 && found.sd_offset > 0 && found.sd_latency > 0 && found.sd_zero > 0);
}

static void two_notches_are_told_from_one(void **state) {
    (void)state;
    const wh_align_limits_t limits = wh_align_limits_default();
    const wh_rim_t nominal = wh_rim_nominal(150);
    const wh_sensor_t sensor = wh_sensor_nominal(150);
    const wh_rim_scan_t scan = scan_of(&sensor);
    /* Sample i looks in direction -i: the notch is in one of the last 1,800. */
    sample(&sensor, &nominal, -0.7, 0, SAMPLES / 2);
    wh_align_result_t result;
    assert_int_equal(wh_align_estimate(&scan, &sensor, &nominal, &limits, rays, &result), WH_OK);
    assert_int_equal(result.verdict, WH_STATUS_TWO_NOTCHES);
    assert_int_equal(result.mark, WH_ALIGN_MARK_NONE);
}

/* The message has what a notch was judged by, and what it lacked. */
static void what_was_most_like_a_notch_is_told(void **state) {
    (void)state;
    const wh_align_limits_t limits = wh_align_limits_default();
    const wh_rim_t nominal = wh_rim_nominal(150);
    const wh_sensor_t sensor = wh_sensor_nominal(150);
    wh_align_result_t result = verdict_on(&sensor, &nominal, &nominal, &limits);
    assert_true(result.notch_seen.depth == result.notch.depth && result.notch_seen.off == 0);
    assert_true(fabs(result.notch_seen.depth_least - 0.85) < 1e-12 &&
                fabs(result.notch_seen.depth_most - 1.4) < 1e-12);
    assert_true(result.notch_seen.flanks[0] >= WH_NOTCH_FLANK_LEAST &&
                result.notch_seen.flanks[1] >= WH_NOTCH_FLANK_LEAST);
    wh_rim_t rim = nominal;
    rim.notch.depth = 0.83;
    result = verdict_on(&sensor, &rim, &nominal, &limits);
    assert_int_equal(result.verdict, WH_STATUS_NOTCH_NOT_SURE);
    assert_true(fabs(result.notch_seen.depth - 0.83) < 0.02 && result.notch_seen.narrow_at > 0);
    assert_true(result.notch_seen.width < result.notch_seen.width_least);
    rim.notch.depth = 0.6; /* no dent that could be one: its depth is told all the same */
    result = verdict_on(&sensor, &rim, &nominal, &limits);
    assert_int_equal(result.verdict, WH_STATUS_NO_NOTCH);
    assert_true(fabs(result.notch_seen.depth - 0.6) < 0.1 && result.notch_seen.flanks[0] == 0);
}

static void flats_are_told_by_their_lengths(void **state) {
    (void)state;
    const wh_align_limits_t limits = wh_align_limits_default();
    wh_rim_t nominal = wh_rim_nominal(75);
    nominal.flats[1].length = 37.5;
    nominal.flats[1].direction = 1.5;
    wh_sensor_t sensor = wh_sensor_nominal(75);
    wh_align_result_t result = verdict_on(&sensor, &nominal, &nominal, &limits);
    assert_int_equal(result.verdict, WH_OK);
    assert_int_equal(result.mark, WH_ALIGN_MARK_PRIMARY_FLAT);
    assert_true(fabs(result.turn - 0.7) < 5e-5);
    assert_true(fabs(result.flats[0].length - 57.5) < 0.01 && fabs(result.flats[1].length - 37.5) < 0.01);
    assert_true(fabs(result.flats[1].direction - 2.2) < 5e-5);
    wh_rim_t rim = nominal;
    rim.flats[0].length = 0;
    result = verdict_on(&sensor, &rim, &nominal, &limits);
    assert_int_equal(result.mark, WH_ALIGN_MARK_SECONDARY_FLAT);
    assert_true(fabs(result.turn - 0.7) < 5e-5);
    rim.flats[1].length = 30;
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_STATUS_NOTCH_NOT_SURE);
    rim.flats[1].length = 0;
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_STATUS_NO_NOTCH);
    rim = nominal;
    rim.flats[1].direction = 1.3;
    assert_int_equal(verdict_on(&sensor, &rim, &nominal, &limits).verdict, WH_STATUS_NOTCH_NOT_SURE);
}

static void bad_numbers_change_nothing(void **state) {
    (void)state;
    const wh_rim_t nominal = wh_rim_nominal(150);
    const wh_sensor_t sensor = wh_sensor_nominal(150);
    const wh_rim_scan_t scan = scan_of(&sensor);
    wh_align_limits_t limits = wh_align_limits_default();
    wh_align_result_t result = {.turn = 7};
    limits.sd_centre = 0;
    assert_int_equal(wh_align_estimate(&scan, &sensor, &nominal, &limits, rays, &result),
                     WH_STATUS_OUT_OF_RANGE);
    limits.sd_centre = (double)NAN;
    assert_int_equal(wh_align_estimate(&scan, &sensor, &nominal, &limits, rays, &result),
                     WH_STATUS_NOT_FINITE);
    limits = wh_align_limits_default();
    assert_int_equal(wh_align_estimate(&scan, NULL, &nominal, &limits, rays, &result),
                     WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_align_estimate(&scan, &sensor, &nominal, &limits, NULL, &result),
                     WH_STATUS_NULL_ARGUMENT);
    wh_rim_t rim = nominal;
    rim.radius = 5;
    assert_int_equal(wh_align_estimate(&scan, &sensor, &rim, &limits, rays, &result), WH_STATUS_OUT_OF_RANGE);
    points[3].radius = (double)NAN;
    assert_int_equal(wh_align_estimate(&scan, &sensor, &nominal, &limits, rays, &result), WH_STATUS_BAD_SCAN);
    assert_true(result.turn == 7);
}

/* The mean of the pixels that see the rim, without errors from light; and the pixels that do not
 * see it, if these are the most. */
static void turns_are_merged(void **state) {
    (void)state;
    const wh_rim_point_t of_turns[5] = {{1, 150.01, WH_SIGHT_RIM},
                                        {7, 149.99, WH_SIGHT_RIM},
                                        {1, 143, WH_SIGHT_RIM},
                                        {1, 150.03, WH_SIGHT_RIM},
                                        {1, 0, WH_SIGHT_COVERED}};
    wh_rim_point_t merged = wh_rim_points_merge(of_turns, 5);
    assert_int_equal(merged.sight, WH_SIGHT_RIM);
    assert_true(fabs(merged.radius - 150.01) < 1e-12 && fabs(merged.angle - 1) <= 0);
    merged = wh_rim_points_merge(of_turns, 1);
    assert_true(fabs(merged.radius - 150.01) <= 0);
    merged = wh_rim_points_merge(&of_turns[3], 2);
    assert_true(merged.sight == WH_SIGHT_RIM && fabs(merged.radius - 150.03) <= 0);
    const wh_rim_point_t covered[3] = {of_turns[0], of_turns[4], of_turns[4]};
    merged = wh_rim_points_merge(covered, 3);
    assert_int_equal(merged.sight, WH_SIGHT_COVERED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(turns_are_merged),
        cmocka_unit_test(a_notch_is_as_deep_and_as_wide_as_drawn),
        cmocka_unit_test(samples_are_due_once_whatever_the_slices),
        cmocka_unit_test(the_centre_is_found_and_nothing_is_allocated),
        cmocka_unit_test(what_is_no_scan_is_refused),
        cmocka_unit_test(each_verdict_has_its_cause),
        cmocka_unit_test(a_chip_is_told_from_a_notch_by_a_sharp_scan_alone),
        cmocka_unit_test(a_notch_is_sure_only_if_its_bottom_agrees),
        cmocka_unit_test(a_sensor_is_calibrated_by_a_known_wafer),
        cmocka_unit_test(two_notches_are_told_from_one),
        cmocka_unit_test(what_was_most_like_a_notch_is_told),
        cmocka_unit_test(flats_are_told_by_their_lengths),
        cmocka_unit_test(bad_numbers_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
