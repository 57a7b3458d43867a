/* Touch: a ball on a gripper, such as the tip of a pin, meets a flat face of a station, and a switch
 * closes.
 *
 * A face is a rectangle. The ball's switch is closed while its centre is over the face and its surface is
 * no farther outside of it than the switch's own error. Within a slice the ball moves straight from its
 * place at the begin to its place at the end. For a gripper that keeps its heading, as it does when it
 * touches, this is exact.
 *
 * Coordinates are in base, in mm; numbers are double also in a library of floats. It uses no heap and no
 * state, and has equal bits on every machine.
 */
#ifndef WH_ALIGN_TOUCH_H
#define WH_ALIGN_TOUCH_H

#include "../math/pose.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(touch);

typedef struct {
    double middle[3];    /* of the face, -1e5 to 1e5 */
    double normal[3];    /* outwards, a unit vector */
    double edge[3];      /* along one of its edges, a unit vector, perpendicular to the normal */
    double along, aside; /* its extent from the middle along that edge and across it, 0.1 to 1e3 */
    double ball[3];      /* centre of the ball in the gripper's frame, -1e3 to 1e3 */
    double radius;       /* of the ball, 0 to 50 */
} wh_touch_face_t;

/* Returns WH_OK, WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE, or WH_STATUS_OUT_OF_RANGE: a number is
 * beyond its range, or normal and edge are not perpendicular unit vectors to 1e-5. */
wh_status_t wh_touch_validate(const wh_touch_face_t *touch) WH_SYMBOL(wh_touch_validate);

/* The distance of the ball outside of the face, below 0 if it is in it; 1e9 where it is not over the face.
 * Nothing is checked. */
double wh_touch_gap(const wh_touch_face_t *touch, const wh_pose_t *base_from_gripper) WH_SYMBOL(wh_touch_gap);

/* The next change of the switch within a slice, from *part on. At the call *closed is its state before *part.
 * The switch closes `early` before the ball meets the face, or after it if `early` is below 0. The poses are
 * the gripper's at the slice's begin and end. True: *part is the instant of the change, and *closed is
 * inverted. False: nothing changes up to the slice's end. A touch that begins and ends within a slice is not
 * seen; a ball that comes from beside the face closes the switch at the slice's end. Cost: twice
 * wh_touch_gap. */
bool wh_touch_next(const wh_touch_face_t *touch, const wh_pose_t *begin, const wh_pose_t *end, double early,
                   double *part, bool *closed) WH_SYMBOL(wh_touch_next);

WH_HEADER_END

#endif
