/* A robot's geometry from points that it touched: the place of its column, the column's tilt, the errors of
 * its axes' zeros, and the place of the touching point on the wrist.
 *
 * The robot is that of motion/robot.h, at any place. The controller gives the axes; each is multiplied by
 * its scale (1 unless it is fitted). The touching point is then in the frame of the touched points at
 *
 *     (x, y, 0) + Rx(tilt_x) Ry(tilt_y) Rz(theta + zero) (r + zero + a, b, z + zero)
 *     with a and b of Rz(yaw) (tool_x, tool_y)
 *
 * so that (x, y) is the point where the column's axis meets z = 0. No touch can separate three sums:
 *   zero of theta  has the heading of the base in it;
 *   zero of z      has the heights of the base and of the tool in it;
 *   zero of yaw    is the turn of the tool on the wrist. Only the tool's measured heading gives it.
 * Turns of yaw separate the zero of r and tool_x; lengths of r separate the zero of theta and tool_y.
 *
 * The search finds the nine numbers (thirteen with scales) that come nearest to the points by least
 * squares. It begins at many starts with robust weights (Tukey's biweight). A touch whose distance exceeds
 * WH_GEOMETRY_ASIDE_SDS standard deviations, including its own pull on the fit, is set aside; the others
 * count equally. A direction of the Jacobian counts as not seen if its singular value is below 1e-8 of the
 * largest.
 *
 * A number is determined only if it has no part in such a direction, if its standard deviation is below the
 * limits here, and if an error of the touches does not enlarge a hundredfold in it. All this must hold
 * without any single touch; otherwise a single wrong line could not be noticed. For a number that is not
 * determined the estimate says which moves are missing. It finds them by trial: it repeats the present
 * touches with an axis turned or moved, and checks which of them would determine the number.
 *
 * Scales that are wrong by more than five standard deviations are refused unless they are fitted, because
 * they would shift all other numbers. The touches alone determine fitted scales. Headings may change with
 * an axis as far as the deviation of its scale allows; the zero of yaw is their value where the axis is at
 * 0.
 *
 * Lengths are in mm, angles in rad. */
#ifndef WH_ESTIMATE_GEOMETRY_H
#define WH_ESTIMATE_GEOMETRY_H

#include "../motion/robot.h"
#include "value.h"

WH_HEADER_BEGIN

/* The least number of touches, and the most that are used; and of headings, if any are measured. */
#define WH_GEOMETRY_TOUCHES 8
#define WH_GEOMETRY_MOST_TOUCHES 1000
#define WH_GEOMETRY_HEADINGS 4

/* The largest part of the touches that may be set aside, and their least distance. */
#define WH_GEOMETRY_ASIDE 0.25
#define WH_GEOMETRY_ASIDE_SDS 6

/* The touches contradict a robot's geometry if the rms of their residuals exceeds this part of the rms
 * distance from the column, or if the column seems to lean by more than this angle. */
#define WH_GEOMETRY_MISFIT 0.001
#define WH_GEOMETRY_MOST_TILT 0.2

/* A number whose standard deviation is larger is not determined: mm, rad (0.1 degrees), and of a scale. */
#define WH_GEOMETRY_LENGTH_SD 1.0
#define WH_GEOMETRY_ANGLE_SD 1.7453292519943296e-3
#define WH_GEOMETRY_SCALE_SD 1e-3

/* A touch, with the axes as the controller gives them. */
typedef struct {
    double axes[WH_ROBOT_AXES];
    wh_vec3_t touched; /* the point, in its frame */
    double heading;    /* of the tool, in that frame, from x towards y; NaN: not measured */
    bool is_set_aside, is_heading_set_aside; /* outputs */
} wh_touch_t;

/* The numbers. Zeros and scales are in the order of the axes; a zero is added to the controller's value
 * times its scale. */
enum {
    WH_GEOMETRY_X,
    WH_GEOMETRY_Y,
    WH_GEOMETRY_TILT_X,
    WH_GEOMETRY_TILT_Y,
    WH_GEOMETRY_ZERO, /* of theta, r, z, yaw */
    WH_GEOMETRY_TOOL_X = WH_GEOMETRY_ZERO + WH_ROBOT_AXES,
    WH_GEOMETRY_TOOL_Y,
    WH_GEOMETRY_SCALE, /* of theta, r, z, yaw */
    WH_GEOMETRY_PARAMETERS = WH_GEOMETRY_SCALE + WH_ROBOT_AXES
};

typedef struct {
    wh_status_t status; /* as wh_geometry_estimate returns it; the rest has no meaning unless WH_OK */
    wh_estimate_value_t values[WH_GEOMETRY_PARAMETERS];
    double fitted[WH_GEOMETRY_PARAMETERS]; /* input of wh_geometry_residual; determined or not */
    bool has_scales;
    size_t used, set_aside, headings, headings_aside;
    double rms;     /* mm: root of the mean square length of the residuals that were used */
    double largest; /* the largest of them */
    size_t largest_index;
    double heading_rms; /* rad; 0 unless headings were used */
    /* The base of a layout in the points' frame: its robot stands level at the origin, with theta 0 along
     * x, and z is the controller's value. Its yaw is that of rpy in layouts. */
    bool is_base_determined;
    wh_pose_t points_from_base;
    double base_rpy[3];
    char reason[WH_ESTIMATE_REASON]; /* the error; or the missing moves, if any; else empty */
} wh_geometry_estimate_t;

/* Fits the geometry, and with `with_scales` the axes' scales. `touches` and `estimate` must not be null.
 * Returns
 *   WH_STATUS_NULL_ARGUMENT   nothing is written then
 *   WH_STATUS_BAD_CAPACITY    more than WH_GEOMETRY_MOST_TOUCHES
 *   WH_STATUS_OUT_OF_RANGE    a number is not finite, or beyond 1e6; or an angle is beyond WH_TRIG_MAX_RAD
 *   WH_STATUS_TOO_FEW_POINTS  fewer than WH_GEOMETRY_TOUCHES, also once some are set aside
 *   WH_STATUS_NO_FIT          too many were set aside, touches or headings; or see WH_GEOMETRY_MISFIT,
 *                             WH_GEOMETRY_MOST_TILT and scales above
 *   WH_STATUS_NOT_DETERMINED  no number is determined
 *   WH_OK                     at least one is
 * Cost: about 50 ms, and 0.1 ms for each touch; 300 kB of stack. */
wh_status_t wh_geometry_estimate(wh_touch_t *touches, size_t count, bool with_scales,
                                 wh_geometry_estimate_t *estimate);

/* The name of a number: x, y, tilt_x, tilt_y, zero_theta and so on, tool_x, tool_y, scale_theta and so on. */
const char *wh_geometry_name(int number);

/* The touched point minus its place by the fitted robot, mm. */
wh_vec3_t wh_geometry_residual(const wh_geometry_estimate_t *estimate, const wh_touch_t *touch);

/* The place of a point of the points' frame in a layout; only if is_base_determined. */
wh_vec3_t wh_geometry_in_base(const wh_geometry_estimate_t *estimate, const wh_vec3_t *point);

WH_HEADER_END

#endif
