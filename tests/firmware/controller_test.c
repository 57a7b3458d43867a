/* A firmware test to copy: your controller moves axes and switches a valve; the library says who holds the
 * wafer, where it was put down, and why a pick failed. Needs libwaferhand.a and cmocka, nothing else.
 *
 * To make it yours: replace `controller` by your own registers, `gripper_pose` by your robot's kinematics,
 * and let `slice` be called wherever your firmware closes its control loop. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <waferhand.h>

/* The hardware as the firmware sees it: four axis registers (mm, degrees) and one valve output, 0 = vacuum
 * on. */
enum { THETA, R, Z, YAW, AXES };
static struct {
    double axis[AXES];
    int valve;
} controller;

/* The library's side: the arrays are yours, so nothing is ever allocated. */
static wh_grasp_t table;
static wh_wafer_t wafers[1];
static wh_gripper_t grippers[1];
static wh_event_t events[WH_EVENTS_PER_GRIPPER * 1];
static wh_event_list_t list = {events, WH_EVENTS_PER_GRIPPER, 0};

/* From axes to the gripper's pose: R out along theta, up to Z, the hand turned by theta + yaw, always level.
 */
static wh_pose_t gripper_pose(void) {
    const double degree = 3.14159265358979323846 / 180;
    const double theta = controller.axis[THETA] * degree;
    const double heading = (controller.axis[THETA] + controller.axis[YAW]) * degree;
    wh_pose_t pose = wh_pose_identity();
    pose.R.m[0][0] = pose.R.m[1][1] = WH_REAL(cos(heading));
    pose.R.m[1][0] = WH_REAL(sin(heading));
    pose.R.m[0][1] = -pose.R.m[1][0];
    pose.r.x = WH_REAL(controller.axis[R] * cos(theta));
    pose.r.y = WH_REAL(controller.axis[R] * sin(theta));
    pose.r.z = WH_REAL(controller.axis[Z]);
    return pose;
}

/* One tick of the control loop: hand the library this slice's pose and valve. */
static void slice(void) {
    const wh_gripper_input_t input = {gripper_pose(), controller.valve};
    assert_int_equal(wh_grasp_step(&table, &input, &list), WH_OK);
}

/* The firmware under test moves one axis, 1 ms a slice. Stops at the first slice with an event, as a test may
 * want to look at it, and returns that event; null when nothing happened on the way. */
static const wh_event_t *move(int axis, double target, double speed) {
    const double step = speed * 0.001;
    while (controller.axis[axis] != target) {
        const double left = target - controller.axis[axis];
        controller.axis[axis] = fabs(left) <= step ? target : controller.axis[axis] + copysign(step, left);
        slice();
        if (list.count > 0) {
            return &events[0];
        }
    }
    return NULL;
}

static const wh_event_t *valve(int level) {
    controller.valve = level;
    slice();
    return list.count > 0 ? &events[0] : NULL;
}

/* Before each test: a wafer in a slot at (700, 0, 900), 2 mm off centre; the arm retracted, below it, vacuum
 * off. */
static int set_up(void **state) {
    (void)state;
    const wh_grasp_config_t config = wh_grasp_config_default(); /* 0.5 mm, 50 mm, 0.99; sampled */
    const wh_grasp_storage_t storage = {wafers, 1, grippers, 1, NULL, 0};
    wafers[0].base_from_wafer = wh_pose_identity();
    wafers[0].base_from_wafer.r = wh_vec3(700, 2, 900);
    controller.axis[THETA] = controller.axis[YAW] = 0;
    controller.axis[R] = 300;
    controller.axis[Z] = 897;
    controller.valve = 1;
    return wh_grasp_init(&table, &config, &storage) == WH_OK ? 0 : -1;
}

/* GET here, PUT a quarter turn further on: who holds it, and where does it end up? */
static void get_and_put(void **state) {
    (void)state;
    int32_t holder;
    wh_pose_t wafer;

    assert_null(move(R, 700, 1000)); /* extend below the wafer */
    assert_null(valve(0));           /* vacuum on */
    const wh_event_t *event = move(Z, 903, 20);
    assert_non_null(event); /* the stroke up takes it ... */
    assert_int_equal(event->kind, WH_EVENT_PICKED);
    assert_true(event->measured.dr_proj_z < WH_REAL(0.5)); /* ... as soon as it is within 0.5 mm */
    assert_null(move(Z, 903, 20));
    assert_int_equal(wh_grasp_wafer(&table, 0, NULL, &holder), WH_OK);
    assert_int_equal(holder, 0);

    assert_null(move(R, 300, 1000)); /* carry it to the other station */
    assert_null(move(THETA, 90, 180));
    assert_null(move(R, 700, 1000));
    assert_null(move(Z, 899.5, 20));
    event = valve(1); /* vacuum off: it stays here */
    assert_non_null(event);
    assert_int_equal(event->kind, WH_EVENT_RELEASED);
    assert_null(move(Z, 897, 20));

    assert_int_equal(wh_grasp_wafer(&table, 0, &wafer, &holder), WH_OK);
    assert_int_equal(holder, WH_NONE);
    assert_true(fabs((double)wafer.r.x - -2) < 0.001); /* still 2 mm off centre, turned with the arm */
    assert_true(fabs((double)wafer.r.y - 700) < 0.001);
    assert_true(fabs((double)wafer.r.z - 900) < 0.05); /* the height within a slice's travel */
}

/* The slot was taught 55 mm short: the stroke goes past the wafer, and the event says what was wrong. */
static void a_badly_taught_slot_is_explained(void **state) {
    (void)state;
    assert_null(move(R, 645, 1000));
    assert_null(valve(0));
    assert_null(move(Z, 903, 20)); /* nothing was taken on the way */
    const wh_event_t *event = valve(1);
    assert_non_null(event);
    assert_int_equal(event->kind, WH_EVENT_NEAR_MISS);
    assert_int_equal(event->wafer, 0);
    assert_int_equal(event->measured.failed,
                     WH_FAILED_PROJXY);              /* height and tilt were good, the centre was not: */
    assert_true(event->measured.margin_projxy < -5); /* by 5 mm more than the 50 that are allowed */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(get_and_put, set_up),
        cmocka_unit_test_setup(a_badly_taught_slot_is_explained, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
