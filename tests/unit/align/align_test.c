/* A wafer's rim, what a sensor sees of it, and the circle that this tells, from the answers that are known. */
#include "support/heap.h"

#include "align/circle.h"

enum { SAMPLES = 3600 };

static wh_rim_point_t points[SAMPLES];
static wh_rim_ray_t rays[SAMPLES];

/* A whole turn of a nominal 300 mm wafer that lies at (3, -4). */
static wh_rim_scan_t scan_of(const wh_sensor_t *sensor) {
    const wh_rim_t rim = wh_rim_nominal(150);
    const wh_placement_t placement = {3, -4, 0.7};
    for (int i = 0; i < SAMPLES; ++i) {
        const wh_glance_t glance = {wh_sensor_angle(sensor, i), 6, {1, 2}, (uint32_t)i};
        const int32_t sample = wh_sensor_read(sensor, &rim, &placement, &glance);
        points[i] = wh_sensor_point(sensor, &sensor->error, &glance, sample);
    }
    const wh_rim_scan_t scan = {points, SAMPLES, sensor->error.offset, sensor->pixel};
    return scan;
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(a_notch_is_as_deep_and_as_wide_as_drawn),
        cmocka_unit_test(samples_are_due_once_whatever_the_slices),
        cmocka_unit_test(the_centre_is_found_and_nothing_is_allocated),
        cmocka_unit_test(what_is_no_scan_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
