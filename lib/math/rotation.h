/* A way in for rotations that do not pass wh_pose_validate as they come: from integers such as Q15, from
 * float, from printed digits, or as quaternions.
 *
 * All other functions of the library take a rotation only if no entry of |R^T R - I| is above
 * WH_ROTATION_TOLERANCE. The two functions here accept what is up to WH_ROTATION_MENDABLE off, and give the
 * nearest rotation, to rounding. A number of Q15 becomes a real by a division by 32768, so a whole matrix is
 *
 *     R.m[row][column] = WH_REAL(q15[row][column]) / 32768;   (nine times)
 *     status = wh_rotation_mend(&R);
 *
 * Q15 and float digits are off by about 1e-4, eight bits (Q7) by up to 3e-2. More than the limit is no
 * rounding, but a mistake: a wrong scale, rows of another matrix, degrees for radians. What such a matrix is
 * meant to be cannot be told, so it is refused. Mending brings no digits back: if each entry is off by e, the
 * result is turned by up to 2.2 e (rad). For Q15 this is 0.02 mm at 300 mm from the origin. `R` may be part
 * of a pose.
 */
#ifndef WH_MATH_ROTATION_H
#define WH_MATH_ROTATION_H

#include "pose.h"

WH_HEADER_BEGIN

/* The largest entry of |R^T R - I|, or of | |q|^2 - 1 |, that is mended. */
#define WH_ROTATION_MENDABLE WH_REAL(5e-2)

/* Turns an almost-rotation into the rotation nearest to it (in the sum of the squares of the nine
 * differences), in place. Afterwards |R^T R - I| is at most 1e-14 (5e-6 in float), so it passes
 * wh_pose_validate. A rotation that passes already is mended too: its last digits may change. Errors, *R then
 * unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_NOT_A_ROTATION  further off than WH_ROTATION_MENDABLE, or it mirrors (det R < 0)
 * Cost: five products of matrices at most. */
wh_status_t wh_rotation_mend(wh_mat3_t *R) WH_SYMBOL(wh_rotation_mend);

/* The rotation of the quaternion w + x i + y j + z k, which need not be of unit length: q and -q are the same
 * rotation. (1, 0, 0, 0) is no turn, (cos(a/2), 0, 0, sin(a/2)) a turn by a about z, counter-clockwise seen
 * from above. Mind the order: some write w last. Errors, *R then unchanged: WH_STATUS_NULL_ARGUMENT,
 * WH_STATUS_NOT_FINITE, WH_STATUS_NOT_A_ROTATION if w^2 + x^2 + y^2 + z^2 is further from 1 than
 * WH_ROTATION_MENDABLE. Cost: about 20 products and a division. */
wh_status_t wh_rotation_from_quaternion(wh_mat3_t *R, wh_real_t w, wh_real_t x, wh_real_t y, wh_real_t z)
    WH_SYMBOL(wh_rotation_from_quaternion);

WH_HEADER_END

#endif
