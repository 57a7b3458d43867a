/* Common robots as chains of axes: polar arms with and without a wrist, and SCARAs. They may stand on a
 * rail, have a column that tilts, and a wrist that turns its blade over.
 *
 *     base_from_effector = base_from_robot . Tx(rail) . Tz(Z) . Rx(tilt_x) . Ry(tilt_y) . Rz(theta) . ARM
 *                          . Rz(yaw) . FLIP
 *     ARM of polar arms  = Rz(arm_heading) . Tx(R) . Tz(height)
 *     ARM of a SCARA     = Tx(links[0]) . Rz(elbow) . Tx(links[1]) . Tz(height)
 *     FLIP               = Tz(flip_height) . Rx(flip) . Tz(-flip_height)
 *
 * A chain ends at one end-effector. A robot with two arms or two wrists is two chains with the same axes
 * before them. Lengths are mm, angles rad, counter-clockwise seen from the axis's tip; R is never negative.
 *
 * A chain is a plain struct. The caller fills it (all zero, then kind, travel, limits, home and its other
 * members), validates it once, and passes it by const pointer. No function keeps a reference. All functions
 * are reentrant. A TRZY chain at base's origin gives the numbers of motion/robot.h.
 */
#ifndef WH_MOTION_CHAIN_H
#define WH_MOTION_CHAIN_H

#include "../math/trig.h"
#include "robot.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(chain);

typedef enum WH_FOUR_BYTES {
    WH_CHAIN_TRZY, /* theta, R, Z, yaw */
    WH_CHAIN_TRZ,  /* theta, R, Z: the blade points along the arm */
    WH_CHAIN_SCARA /* shoulder (theta), elbow, Z, yaw at the wrist */
} wh_chain_kind_t;

/* The indices of a chain's axes in every q. Axes that a chain does not have stay 0. */
enum {
    WH_CHAIN_RAIL,   /* mm along the robot's x */
    WH_CHAIN_Z,      /* mm */
    WH_CHAIN_TILT_X, /* rad about x, then */
    WH_CHAIN_TILT_Y, /* rad about y, at the contact plane's height on theta's axis */
    WH_CHAIN_THETA,  /* rad */
    WH_CHAIN_REACH,  /* R, mm; a SCARA's elbow, rad: 0 is stretched, positive to the left */
    WH_CHAIN_YAW,    /* rad, relative to the arm's last link */
    WH_CHAIN_FLIP,   /* rad about the blade's x */
    WH_CHAIN_AXES
};

/* The tilts' largest travel, rad; at pi / 2 the arm would be vertical. */
#define WH_CHAIN_TILT_MAX WH_REAL(1.0)

typedef struct {
    wh_chain_kind_t kind;
    bool has_rail, has_tilt, has_flip;
    bool is_placed;            /* false: the robot's frame is base, to the last bit */
    wh_pose_t base_from_robot; /* counts if is_placed */
    wh_real_t arm_heading;     /* rad, polar arms: the direction of this arm when theta is 0 */
    wh_real_t height;          /* mm, of this arm's or wrist's contact plane above the first one's */
    wh_real_t flip_height;     /* mm, of the flip's axis above the contact plane */
    wh_real_t links[2];        /* mm, SCARA: shoulder to elbow, elbow to wrist */
    wh_travel_t travel[WH_CHAIN_AXES];
    wh_limits_t limits[WH_CHAIN_AXES];
    wh_real_t home[WH_CHAIN_AXES];
} wh_chain_t;

/* True if the chain has this axis. `axis` is below WH_CHAIN_AXES. */
bool wh_chain_has(const wh_chain_t *chain, size_t axis) WH_SYMBOL(wh_chain_has);

/* WH_OK, or
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_OUT_OF_RANGE  the kind; a heading beyond a turn; a height that is not finite; links of a SCARA
 *                           that are not finite and positive
 *   WH_STATUS_BAD_LIMITS    of an axis that the chain has: limits that wh_limits_validate refuses, travel
 *                           that is not finite with min < max, R's below 0, tilts' beyond WH_CHAIN_TILT_MAX,
 *                           an elbow's beyond half a turn, other angles' beyond WH_TRIG_MAX_RAD / 2; a home
 *                           outside the travel; a home other than 0 of an axis that it does not have
 *   the status of wh_pose_validate for base_from_robot.
 * The functions below expect a chain that passes. */
wh_status_t wh_chain_validate(const wh_chain_t *chain) WH_SYMBOL(wh_chain_validate);

/* Checks that the axes are within their travel, and 0 if the chain does not have them. Returns WH_OK,
 * WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE, or else WH_STATUS_OUT_OF_REACH for R or the elbow, and
 * WH_STATUS_LIMIT_EXCEEDED for another axis. */
wh_status_t wh_chain_check_travel(const wh_chain_t *chain, const wh_real_t q[WH_CHAIN_AXES])
    WH_SYMBOL(wh_chain_check_travel);

/* base_from_effector at axes q, in travel or not. No pointer may be null. Numbers that are not finite, or
 * angles beyond WH_TRIG_MAX_RAD, give NaN entries. Cost: about 60 ns; 100 ns more for each of tilt, flip and
 * a robot that is placed. */
void wh_chain_forward(const wh_chain_t *chain, const wh_real_t q[WH_CHAIN_AXES],
                      wh_pose_t *base_from_effector) WH_SYMBOL(wh_chain_forward);

/* Turns a blade's rotation by `flip` (rad) about its x: *R becomes R . Rx(flip). Cost: about 40 ns. */
static inline void wh_chain_turn_over(wh_mat3_t *R, wh_real_t flip) {
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(flip, &s, &c);
    const wh_mat3_t about_x = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    *R = wh_mat3_multiply(R, &about_x);
}

/* The side of the line from shoulder to wrist on which a SCARA's elbow is, seen from above and looking
 * outward. A left elbow bends to the right: its axis is negative. */
typedef enum WH_FOUR_BYTES {
    WH_ELBOW_NEAR, /* the side in near_q; left if that is 0 */
    WH_ELBOW_LEFT,
    WH_ELBOW_RIGHT
} wh_elbow_t;

/* The choices that a pose alone leaves open. */
typedef struct {
    wh_real_t rail;   /* mm: a rail's position is taught, not solved */
    wh_real_t flip;   /* rad */
    wh_elbow_t elbow; /* SCARA */
} wh_chain_choice_t;

/* The axes that bring the end-effector to a pose in base, coming from near_q:
 *   theta   the shorter way round from near_q, as wh_robot_inverse has it;
 *   yaw     of TRZY within (-pi, pi]; of a SCARA the shorter way round from near_q, too;
 *   tilts   by the pose's normal n in the robot's frame: tilt_y = asin n_x, tilt_x = atan2(-n_y, n_z).
 * wh_chain_forward of the result is the given pose to 1e-9 mm and 1e-12 rad (1e-2 and 1e-4 in float). For a
 * SCARA this holds for |sin elbow| > 0.01: when the arm is nearly straight, a small step needs a large turn
 * of the elbow. Errors, q then unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_OUT_OF_RANGE    near_q's theta or yaw, or the choice's elbow
 *   WH_STATUS_NOT_LEVEL       without tilt: the pose is tilted by more than WH_SLACK_RAD; with tilt: it leans
 *                             by a quarter turn or more
 *   WH_STATUS_NOT_ALONG_ARM   TRZ: the blade does not point along the arm, to WH_SLACK_RAD
 *   WH_STATUS_OUT_OF_REACH    R or the elbow outside its travel, or no angle of the elbow is right, or the
 *                             point is on theta's axis
 *   WH_STATUS_LIMIT_EXCEEDED  another axis outside its travel, or a choice for an axis that it does not have
 * q may be near_q. Source: closed form; it solves the tilted plane's coordinates before the arm's. Cost:
 * about 100 ns, 300 ns with everything. */
wh_status_t wh_chain_inverse(const wh_chain_t *chain, const wh_pose_t *base_from_effector,
                             const wh_chain_choice_t *choice, const wh_real_t near_q[WH_CHAIN_AXES],
                             wh_real_t q[WH_CHAIN_AXES]) WH_SYMBOL(wh_chain_inverse);

WH_HEADER_END

#endif
