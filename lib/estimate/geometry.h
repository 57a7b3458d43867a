/* A robot's geometry from points that it touched: where its column stands, how the column leans, what its
 * axes' zeros are off, and where on the wrist the point sits that touches.
 *
 * The robot is that of motion/robot.h, standing anywhere. With axes as its controller tells them, each times
 * its scale (1 unless it is fitted), the touching point is in the frame of the touched points at
 *
 *     (x, y, 0) + Rx(tilt_x) Ry(tilt_y) Rz(theta + zero) (r + zero + a, b, z + zero)
 *     with a and b of Rz(yaw) (tool_x, tool_y)
 *
 * so that (x, y) is where the column's axis meets z = 0. Three sums cannot be told apart by anything touched:
 *   zero of theta  has the heading of the base in it;
 *   zero of z      has the heights of the base and of the tool in it;
 *   zero of yaw    is how the tool is turned on the wrist. Only the tool's measured heading tells it.
 * The zero of r and tool_x are told apart by turns of yaw, the zero of theta and tool_y by lengths of r.
 *
 * The nine numbers (thirteen with scales) that come nearest to the points, in the sense of least squares, are
 * searched for from many starts with robust weights (Tukey's biweight). A touch that lies farther off than
 * WH_GEOMETRY_ASIDE_SDS standard deviations, its own pull on the fit counted, is set aside; the others count
 * alike. A direction of the Jacobian counts as not seen if its singular value is below 1e-8 of the largest.
 *
 * A number is determined only if it has no part in such a direction, if its standard deviation is below
 * the limits here, if an error of the touches does not count a hundredfold in it, and if all this holds
 * without any one of the touches: else a single wrong line could not be noticed. Of what is not
 * determined the estimate says which moves are missing. It finds them by trying: the touches that there
 * are, once more with an axis turned or moved, and looks which of them would tell it.
 *
 * Scales that are off by more than five standard deviations are refused unless they are fitted, for they
 * would shift all other numbers. Fitted ones are told by the touches alone; headings may go with an axis as
 * far as the deviation of its scale allows, and the zero of yaw is what they say where the axis is at 0.
 *
 * Lengths in mm, angles in rad. */
#ifndef WH_ESTIMATE_GEOMETRY_H
#define WH_ESTIMATE_GEOMETRY_H

#include "../motion/robot.h"
#include "value.h"

WH_HEADER_BEGIN

/* Touches needed at least, and the most that are looked at; and headings, where any are measured. */
#define WH_GEOMETRY_TOUCHES 8
#define WH_GEOMETRY_MOST_TOUCHES 1000
#define WH_GEOMETRY_HEADINGS 4

/* The largest part of the touches that may be set aside, and how far off they are then. */
#define WH_GEOMETRY_ASIDE 0.25
#define WH_GEOMETRY_ASIDE_SDS 6

/* The touches contradict a robot's geometry if the rms of their residuals is more than this part of the rms
 * distance from the column; or if the column seems to lean by more than this angle. */
#define WH_GEOMETRY_MISFIT 0.001
#define WH_GEOMETRY_MOST_TILT 0.2

/* A number whose standard deviation is larger is not determined: mm, rad (0.1 degrees), and of a scale. */
#define WH_GEOMETRY_LENGTH_SD 1.0
#define WH_GEOMETRY_ANGLE_SD 1.7453292519943296e-3
#define WH_GEOMETRY_SCALE_SD 1e-3

/* A touch, with the axes as the controller tells them. */
typedef struct {
    double axes[WH_ROBOT_AXES];
    wh_vec3_t touched; /* the point, in its frame */
    double heading;    /* of the tool, in that frame, from x towards y; NaN: not measured */
    bool is_set_aside, is_heading_set_aside; /* written */
} wh_touch_t;

/* The numbers. Zeros and scales are in the order of the axes; a zero is added to what the controller tells,
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
    wh_status_t status; /* as wh_geometry_estimate returns it; below: of no meaning unless WH_OK */
    wh_estimate_value_t values[WH_GEOMETRY_PARAMETERS];
    double fitted[WH_GEOMETRY_PARAMETERS]; /* what wh_geometry_residual takes; determined or not */
    bool has_scales;
    size_t used, set_aside, headings, headings_aside;
    double rms;     /* mm: root of the mean square length of the residuals that were used */
    double largest; /* of them */
    size_t largest_index;
    double heading_rms; /* rad; 0 unless headings were used */
    /* The base of a layout in the points' frame: its robot stands level at the origin, theta 0 along x, and z
     * is what the controller tells. Its yaw is that of rpy in layouts. */
    bool is_base_determined;
    wh_pose_t points_from_base;
    double base_rpy[3];
    char reason[WH_ESTIMATE_REASON]; /* what is wrong; or which moves are missing, if one is; else empty */
} wh_geometry_estimate_t;

/* Fits the geometry, and the axes' scales if asked to. `touches` and `estimate` must not be null. Returns
 *   WH_STATUS_NULL_ARGUMENT   nothing is written then
 *   WH_STATUS_BAD_CAPACITY    more than WH_GEOMETRY_MOST_TOUCHES
 *   WH_STATUS_OUT_OF_RANGE    a number is not finite, or beyond 1e6; or an angle is beyond WH_TRIG_MAX_RAD
 *   WH_STATUS_TOO_FEW_POINTS  fewer than WH_GEOMETRY_TOUCHES, also once some are set aside
 *   WH_STATUS_NO_FIT          too many were set aside, touches or headings; or see WH_GEOMETRY_MISFIT,
 *                             WH_GEOMETRY_MOST_TILT and scales above
 *   WH_STATUS_NOT_DETERMINED  no number is determined
 *   WH_OK                     at least one is
 * Cost: about 50 ms, and 0.1 ms a touch; 300 kB of stack. */
wh_status_t wh_geometry_estimate(wh_touch_t *touches, size_t count, bool with_scales,
                                 wh_geometry_estimate_t *estimate);

/* The name of a number: x, y, tilt_x, tilt_y, zero_theta and so on, tool_x, tool_y, scale_theta and so on. */
const char *wh_geometry_name(int number);

/* The touched point less where the fitted robot has it, mm. */
wh_vec3_t wh_geometry_residual(const wh_geometry_estimate_t *estimate, const wh_touch_t *touch);

/* Where a layout has a point of the points' frame; only if is_base_determined. */
wh_vec3_t wh_geometry_in_base(const wh_geometry_estimate_t *estimate, const wh_vec3_t *point);

WH_HEADER_END

#endif
