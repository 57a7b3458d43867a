/* A quantity along a way with its first three derivatives by the way's length; internal to the room. */
#ifndef WH_MOTION_JET_INTERNAL_H
#define WH_MOTION_JET_INTERNAL_H

#include "profile.h"

typedef struct {
    wh_real_t value, first, second, third;
} wh_jet_t;

static inline wh_jet_t wh_jet_sum(wh_jet_t a, wh_jet_t b) {
    const wh_jet_t sum = {a.value + b.value, a.first + b.first, a.second + b.second, a.third + b.third};
    return sum;
}

static inline wh_jet_t wh_jet_scaled(wh_real_t factor, wh_jet_t a) {
    const wh_jet_t scaled = {factor * a.value, factor * a.first, factor * a.second, factor * a.third};
    return scaled;
}

/* Leibniz's rule. */
static inline wh_jet_t wh_jet_product(wh_jet_t a, wh_jet_t b) {
    const wh_jet_t product = {a.value * b.value, a.value * b.first + a.first * b.value,
                              a.value * b.second + 2 * a.first * b.first + a.second * b.value,
                              a.value * b.third + 3 * (a.first * b.second + a.second * b.first) +
                                  a.third * b.value};
    return product;
}

/* a / b, from a = quotient * b. */
static inline wh_jet_t wh_jet_quotient(wh_jet_t a, wh_jet_t b) {
    wh_jet_t q;
    q.value = a.value / b.value;
    q.first = (a.first - q.value * b.first) / b.value;
    q.second = (a.second - 2 * q.first * b.first - q.value * b.second) / b.value;
    q.third = (a.third - 3 * (q.first * b.second + q.second * b.first) - q.value * b.third) / b.value;
    return q;
}

/* The root, from a = root * root. */
static inline wh_jet_t wh_jet_root(wh_jet_t a) {
    wh_jet_t r;
    r.value = wh_real_sqrt(a.value);
    r.first = a.first / (2 * r.value);
    r.second = (a.second - 2 * r.first * r.first) / (2 * r.value);
    r.third = (a.third - 6 * r.first * r.second) / (2 * r.value);
    return r;
}

/* The derivatives of the angle of (x, y), whose value is given: angle' = (x y' - y x') / (x^2 + y^2).
 * Numerator and denominator are needed only up to their second derivatives. */
static inline wh_jet_t wh_jet_angle(wh_real_t value, wh_jet_t x, wh_jet_t y) {
    const wh_jet_t dx = {x.first, x.second, x.third, 0};
    const wh_jet_t dy = {y.first, y.second, y.third, 0};
    const wh_jet_t numerator = wh_jet_sum(wh_jet_product(x, dy), wh_jet_scaled(-1, wh_jet_product(y, dx)));
    const wh_jet_t square = wh_jet_sum(wh_jet_product(x, x), wh_jet_product(y, y));
    const wh_jet_t slope = wh_jet_quotient(numerator, square);
    const wh_jet_t angle = {value, slope.value, slope.first, slope.second};
    return angle;
}

/* Converts derivatives by length to derivatives by time, along a way whose position, speed and so on are
 * `along` (Faa di Bruno). */
static inline wh_motion_t wh_jet_in_time(wh_jet_t by_length, const wh_motion_t *along) {
    const wh_real_t v = along->speed;
    const wh_real_t a = along->acceleration;
    const wh_motion_t motion = {
        by_length.value, by_length.first * v, by_length.second * v * v + by_length.first * a,
        by_length.third * v * v * v + 3 * by_length.second * v * a + by_length.first * along->jerk};
    return motion;
}

#endif
