/* Accepts rotations that do not pass wh_pose_validate as they come: from integers such as Q15, from float,
 * from printed digits, or as quaternions.
 *
 * All other functions of the library accept a rotation only if no entry of |R^T R - I| is above
 * WH_ROTATION_TOLERANCE. The two functions here accept deviations up to WH_ROTATION_MENDABLE, and give the
 * nearest rotation, to rounding. Dividing a Q15 number by 32768 gives a real, so a whole matrix is
 *
 *     R.m[row][column] = WH_REAL(q15[row][column]) / 32768;   (nine times)
 *     status = wh_rotation_mend(&R);
 *
 * Q15 and float digits have errors of about 1e-4, eight bits (Q7) of up to 3e-2. Larger deviations do not
 * come from rounding but from a mistake: a wrong scale, rows of another matrix, degrees for radians. The
 * intended matrix cannot be known, so it is refused. Mending restores no digits: if each entry has an error
 * of e, the result is turned by up to 2.2 e (rad). For Q15 this is 0.02 mm at 300 mm from the origin. `R`
 * may be part of a pose.
 */
#ifndef WH_MATH_ROTATION_H
#define WH_MATH_ROTATION_H

#include "pose.h"

WH_HEADER_BEGIN

/* The largest entry of |R^T R - I|, or of | |q|^2 - 1 |, that is mended. */
#define WH_ROTATION_MENDABLE WH_REAL(5e-2)

/* Turns an almost-rotation into the nearest rotation (by the sum of the squares of the nine differences),
 * in place. Afterwards |R^T R - I| is at most 1e-14 (5e-6 in float), so it passes wh_pose_validate. A
 * rotation that already passes is mended too: its last digits may change. Errors, which leave *R unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_NOT_A_ROTATION  further off than WH_ROTATION_MENDABLE, or it mirrors (det R < 0)
 * Cost: five products of matrices at most. */
wh_status_t wh_rotation_mend(wh_mat3_t *R) WH_SYMBOL(wh_rotation_mend);

/* The rotation of the quaternion w + x i + y j + z k, which need not have unit length. q and -q are one
 * rotation. (1, 0, 0, 0) is no turn, (cos(a/2), 0, 0, sin(a/2)) a turn by a about z, counter-clockwise seen
 * from above. Mind the order: some libraries put w last. Errors, which leave *R unchanged:
 * WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE, WH_STATUS_NOT_A_ROTATION if w^2 + x^2 + y^2 + z^2 is
 * further from 1 than WH_ROTATION_MENDABLE. Cost: about 20 products and a division. */
wh_status_t wh_rotation_from_quaternion(wh_mat3_t *R, wh_real_t w, wh_real_t x, wh_real_t y, wh_real_t z)
    WH_SYMBOL(wh_rotation_from_quaternion);

WH_HEADER_END

#endif
