/* Rotations as unit quaternions (x, y, z, w): for files and pages. */
#ifndef WH_RECORD_QUATERNION_H
#define WH_RECORD_QUATERNION_H

#include "../math/pose.h"

/* The quaternion of a rotation, with the sign that is nearer to `near` (null: the one with w >= 0). */
void wh_quaternion_from_matrix(const wh_mat3_t *R, const double near[4], double q[4]);

void wh_quaternion_to_matrix(const double q[4], wh_mat3_t *R);

/* The turn from a to b by the shorter way: its axis in a's frame times its angle (0 to pi, rad). */
void wh_quaternion_turn(const double a[4], const double b[4], double turn[3]);

/* From a (share 0) to b (share 1) at a constant rate, by the shorter way. */
void wh_quaternion_slerp(const double a[4], const double b[4], double share, double q[4]);

#endif
