#include "quaternion.h"

#include "../math/trig.h"

/* Below this angle, rad, the sine equals the angle, to rounding. */
#define SMALL 1e-9

static double dot(const double a[4], const double b[4]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

static void scale(double factor, double q[4]) {
    for (size_t i = 0; i < 4; ++i) {
        q[i] *= factor;
    }
}

/* Shepperd's method: the largest of the four comes first, because the others are divided by it. */
void wh_quaternion_from_matrix(const wh_mat3_t *R, const double near[4], double q[4]) {
    const wh_real_t(*m)[3] = R->m;
    const double squares[4] = {1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2],
                               1 - m[0][0] - m[1][1] + m[2][2], 1 + m[0][0] + m[1][1] + m[2][2]};
    const double sums[4][4] = {
        {squares[0], m[1][0] + m[0][1], m[0][2] + m[2][0], m[2][1] - m[1][2]},
        {m[1][0] + m[0][1], squares[1], m[2][1] + m[1][2], m[0][2] - m[2][0]},
        {m[0][2] + m[2][0], m[2][1] + m[1][2], squares[2], m[1][0] - m[0][1]},
        {m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], squares[3]},
    };
    size_t largest = 3;
    for (size_t i = 0; i < 3; ++i) {
        largest = squares[i] > squares[largest] ? i : largest;
    }
    for (size_t i = 0; i < 4; ++i) {
        q[i] = sums[largest][i];
    }
    const bool other = near ? dot(q, near) < 0 : q[3] < 0;
    scale((other ? -1 : 1) / wh_real_sqrt(dot(q, q)), q);
}

void wh_quaternion_to_matrix(const double q[4], wh_mat3_t *R) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const wh_mat3_t made = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
    *R = made;
}

/* conjugate(a) * b */
static void relative(const double a[4], const double b[4], double q[4]) {
    q[0] = a[3] * b[0] - a[0] * b[3] - a[1] * b[2] + a[2] * b[1];
    q[1] = a[3] * b[1] - a[1] * b[3] - a[2] * b[0] + a[0] * b[2];
    q[2] = a[3] * b[2] - a[2] * b[3] - a[0] * b[1] + a[1] * b[0];
    q[3] = dot(a, b);
}

void wh_quaternion_turn(const double a[4], const double b[4], double turn[3]) {
    double q[4];
    relative(a, b, q);
    scale(q[3] < 0 ? -1 : 1, q);
    const double sine = wh_real_sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    const double factor = sine < SMALL ? 2 : 2 * wh_atan2(sine, q[3]) / sine;
    for (size_t i = 0; i < 3; ++i) {
        turn[i] = factor * q[i];
    }
}

void wh_quaternion_slerp(const double a[4], const double b[4], double share, double q[4]) {
    double turn[3];
    wh_quaternion_turn(a, b, turn);
    const double angle = wh_real_sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    const double sign = dot(a, b) < 0 ? -1 : 1;
    double from = 1 - share;
    double to = share;
    if (angle > SMALL) {
        const double whole = wh_sin(angle / 2);
        from = wh_sin((1 - share) * angle / 2) / whole;
        to = wh_sin(share * angle / 2) / whole;
    }
    for (size_t i = 0; i < 4; ++i) {
        q[i] = from * a[i] + sign * to * b[i];
    }
    scale(1 / wh_real_sqrt(dot(q, q)), q);
}
