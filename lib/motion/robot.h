/* The TRZY robot: a column that turns (theta), an arm that reaches out (R) and is lifted (Z), and a wrist
 * (yaw).
 *
 * It stands at base's origin and keeps its end-effector level. With axes q the end-effector's origin is at
 * (R cos theta, R sin theta, Z) in base; its x points along the heading theta + yaw (rad from base's x,
 * counter-clockwise seen from above); its z is base's z. R is positive: the arm never reaches through its
 * own column.
 *
 * A robot is a plain struct. The caller fills it (wh_robot_default, then changes), validates it once, and
 * passes it by const pointer. No function keeps a reference. All functions are reentrant.
 */
#ifndef WH_MOTION_ROBOT_H
#define WH_MOTION_ROBOT_H

#include "../math/pose.h"
#include "profile.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(robot);

#define WH_ROBOT_AXES 4

/* The indices of the axes in every q: theta (rad), R (mm), Z (mm), yaw at the wrist relative to the arm
 * (rad). */
enum { WH_AXIS_THETA, WH_AXIS_R, WH_AXIS_Z, WH_AXIS_YAW };

/* Travel is inclusive. An axis may be this far beyond it, because positions computed in another way differ
 * by rounding. */
#if defined(WH_FLOAT)
#define WH_SLACK_MM 1e-3F
#define WH_SLACK_RAD 1e-5F
#else
#define WH_SLACK_MM 1e-9
#define WH_SLACK_RAD 1e-9
#endif

/* Both ends of an axis's travel, mm or rad. */
typedef struct {
    wh_real_t min, max;
} wh_travel_t;

/* One entry for each axis; wh_move_plan takes `limits`. */
typedef struct {
    wh_travel_t travel[WH_ROBOT_AXES];
    wh_limits_t limits[WH_ROBOT_AXES];
    wh_real_t home[WH_ROBOT_AXES];
} wh_robot_t;

/* An atmospheric robot for 300 mm wafers; the figures are typical, and no maker's data:
 *
 *     axis    travel            home   speed        acceleration    jerk
 *     theta   -540..540 deg     0      300 deg/s    1000 deg/s^2    10000 deg/s^3
 *     R        300..900 mm      300    1000 mm/s    5000 mm/s^2     50000 mm/s^3
 *     Z        600..1300 mm     900    400 mm/s     2000 mm/s^2     20000 mm/s^3
 *     yaw     -270..270 deg     0      360 deg/s    1500 deg/s^2    15000 deg/s^3
 *
 * *robot must not be null. */
void wh_robot_default(wh_robot_t *robot) WH_SYMBOL(wh_robot_default);

/* Returns WH_OK if all limits are sound (wh_limits_validate), each travel is finite with min < max, R's
 * does not begin below 0, theta's and yaw's stay within WH_TRIG_MAX_RAD / 2, and home is within travel.
 * Otherwise it returns WH_STATUS_BAD_LIMITS, or WH_STATUS_NULL_ARGUMENT. The functions below expect a robot
 * that passes. */
wh_status_t wh_robot_validate(const wh_robot_t *robot) WH_SYMBOL(wh_robot_validate);

/* Checks that the axes are within their travel. Returns WH_OK, WH_STATUS_NULL_ARGUMENT,
 * WH_STATUS_NOT_FINITE, or else WH_STATUS_OUT_OF_REACH for R and WH_STATUS_LIMIT_EXCEEDED for another
 * axis. */
wh_status_t wh_robot_check_travel(const wh_robot_t *robot, const wh_real_t q[WH_ROBOT_AXES])
    WH_SYMBOL(wh_robot_check_travel);

/* base_from_effector at axes q, in travel or not. No pointer may be null. Numbers that are not finite, or
 * angles beyond WH_TRIG_MAX_RAD, give NaN entries. Cost: about 60 ns. */
void wh_robot_forward(const wh_real_t q[WH_ROBOT_AXES], wh_pose_t *base_from_effector)
    WH_SYMBOL(wh_robot_forward);

/* The axes that bring the end-effector to (x, y, z) mm in base with the given heading (rad, any number of
 * turns up to WH_TRIG_MAX_RAD), coming from axes near_q, of which only theta counts (also up to
 * WH_TRIG_MAX_RAD):
 *   theta  the shorter way round from near_q; half a turn (to WH_SLACK_RAD) goes positive. Where that leaves
 *          theta's travel and the other way round does not, the other way;
 *   yaw    heading - theta in (-pi, pi]; a value within WH_SLACK_RAD of -pi counts as pi, so that rounding
 *          never decides between the two.
 * Coming from theta or from theta + 2 pi n, R, Z and the reached point are equal to rounding.
 * wh_robot_forward of the result is the given point to 1e-12 mm (1e-3 in float). Errors, which leave q
 * unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_OUT_OF_RANGE    near_q's theta or the heading
 *   WH_STATUS_OUT_OF_REACH    R outside its travel, or a point on base's z axis, where no theta is right
 *   WH_STATUS_LIMIT_EXCEEDED  another axis outside its travel
 * q may be near_q. Cost: about 60 ns. */
wh_status_t wh_robot_inverse(const wh_robot_t *robot, wh_real_t x, wh_real_t y, wh_real_t z,
                             wh_real_t heading, const wh_real_t near_q[WH_ROBOT_AXES],
                             wh_real_t q[WH_ROBOT_AXES]) WH_SYMBOL(wh_robot_inverse);

WH_HEADER_END

#endif
