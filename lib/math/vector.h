/* Vectors and matrices of three: structs passed by const pointer, results returned by value.
 *
 * Every sum runs left to right and every product is rounded by itself (build with -ffp-contract=off): equal
 * inputs give equal bits on every machine. No function here tests for NaN: it passes through.
 */
#ifndef WH_MATH_VECTOR_H
#define WH_MATH_VECTOR_H

#include <math.h>

#include "config.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(vector);

static inline wh_real_t wh_real_max(wh_real_t a, wh_real_t b) {
    return a > b ? a : b;
}

typedef struct {
    wh_real_t x, y, z;
} wh_vec3_t;

/* Row by row: m[row][column]. The columns of a rotation are the body's axes, seen from base. */
typedef struct {
    wh_real_t m[3][3];
} wh_mat3_t;

static inline wh_real_t wh_real_abs(wh_real_t a) {
#if defined(WH_FLOAT)
    return fabsf(a);
#else
    return fabs(a);
#endif
}

/* Correctly rounded, as IEEE 754 requires. */
static inline wh_real_t wh_real_sqrt(wh_real_t a) {
#if defined(WH_FLOAT)
    return sqrtf(a);
#else
    return sqrt(a);
#endif
}

/* True if the square root, rounded as above, is less than a limit in [1e-6, 1e6]. It takes the root only
 * near the limit, because a root costs more than two products. */
static inline bool wh_real_root_below(wh_real_t square, wh_real_t limit) {
#if !defined(WH_FLOAT)
    if (square < limit * limit * WH_REAL(0.999)) {
        return true;
    }
#endif
    return wh_real_sqrt(square) < limit;
}

/* The largest finite number. */
#if defined(WH_FLOAT)
#define WH_REAL_LARGEST FLT_MAX
#else
#define WH_REAL_LARGEST DBL_MAX
#endif

/* Neither NaN nor infinite. */
static inline bool wh_real_is_finite(wh_real_t a) {
    return a - a == 0;
}

static inline wh_vec3_t wh_vec3(wh_real_t x, wh_real_t y, wh_real_t z) {
    wh_vec3_t v = {x, y, z};
    return v;
}

static inline wh_vec3_t wh_vec3_add(const wh_vec3_t *a, const wh_vec3_t *b) {
    return wh_vec3(a->x + b->x, a->y + b->y, a->z + b->z);
}

static inline wh_vec3_t wh_vec3_subtract(const wh_vec3_t *a, const wh_vec3_t *b) {
    return wh_vec3(a->x - b->x, a->y - b->y, a->z - b->z);
}

static inline wh_vec3_t wh_vec3_scale(wh_real_t factor, const wh_vec3_t *a) {
    return wh_vec3(factor * a->x, factor * a->y, factor * a->z);
}

static inline wh_real_t wh_vec3_dot(const wh_vec3_t *a, const wh_vec3_t *b) {
    return a->x * b->x + a->y * b->y + a->z * b->z;
}

static inline wh_vec3_t wh_vec3_cross(const wh_vec3_t *a, const wh_vec3_t *b) {
    return wh_vec3(a->y * b->z - a->z * b->y, a->z * b->x - a->x * b->z, a->x * b->y - a->y * b->x);
}

static inline wh_real_t wh_vec3_norm(const wh_vec3_t *a) {
    return wh_real_sqrt(wh_vec3_dot(a, a));
}

/* True if all three numbers are finite. */
static inline bool wh_vec3_is_finite(const wh_vec3_t *a) {
    return (a->x - a->x) + (a->y - a->y) + (a->z - a->z) == 0;
}

static inline wh_mat3_t wh_mat3_identity(void) {
    wh_mat3_t i = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return i;
}

static inline wh_vec3_t wh_mat3_row(const wh_mat3_t *a, size_t row) {
    return wh_vec3(a->m[row][0], a->m[row][1], a->m[row][2]);
}

static inline wh_vec3_t wh_mat3_column(const wh_mat3_t *a, size_t column) {
    return wh_vec3(a->m[0][column], a->m[1][column], a->m[2][column]);
}

/* a * v */
static inline wh_vec3_t wh_mat3_transform(const wh_mat3_t *a, const wh_vec3_t *v) {
    return wh_vec3(a->m[0][0] * v->x + a->m[0][1] * v->y + a->m[0][2] * v->z,
                   a->m[1][0] * v->x + a->m[1][1] * v->y + a->m[1][2] * v->z,
                   a->m[2][0] * v->x + a->m[2][1] * v->y + a->m[2][2] * v->z);
}

/* transpose(a) * v */
static inline wh_vec3_t wh_mat3_transform_back(const wh_mat3_t *a, const wh_vec3_t *v) {
    return wh_vec3(a->m[0][0] * v->x + a->m[1][0] * v->y + a->m[2][0] * v->z,
                   a->m[0][1] * v->x + a->m[1][1] * v->y + a->m[2][1] * v->z,
                   a->m[0][2] * v->x + a->m[1][2] * v->y + a->m[2][2] * v->z);
}

/* a * b, into memory that is part of neither. */
static inline void wh_mat3_multiply_to(const wh_mat3_t *a, const wh_mat3_t *b, wh_mat3_t *product) {
    for (size_t row = 0; row < 3; ++row) {
        const wh_real_t x = a->m[row][0];
        const wh_real_t y = a->m[row][1];
        const wh_real_t z = a->m[row][2];
        product->m[row][0] = x * b->m[0][0] + y * b->m[1][0] + z * b->m[2][0];
        product->m[row][1] = x * b->m[0][1] + y * b->m[1][1] + z * b->m[2][1];
        product->m[row][2] = x * b->m[0][2] + y * b->m[1][2] + z * b->m[2][2];
    }
}

/* transpose(a) * b, into memory that is part of neither. */
static inline void wh_mat3_multiply_back_to(const wh_mat3_t *a, const wh_mat3_t *b, wh_mat3_t *product) {
    for (size_t row = 0; row < 3; ++row) {
        const wh_real_t x = a->m[0][row];
        const wh_real_t y = a->m[1][row];
        const wh_real_t z = a->m[2][row];
        product->m[row][0] = x * b->m[0][0] + y * b->m[1][0] + z * b->m[2][0];
        product->m[row][1] = x * b->m[0][1] + y * b->m[1][1] + z * b->m[2][1];
        product->m[row][2] = x * b->m[0][2] + y * b->m[1][2] + z * b->m[2][2];
    }
}

/* a * b */
static inline wh_mat3_t wh_mat3_multiply(const wh_mat3_t *a, const wh_mat3_t *b) {
    wh_mat3_t product;
    wh_mat3_multiply_to(a, b, &product);
    return product;
}

/* transpose(a) * b */
static inline wh_mat3_t wh_mat3_multiply_back(const wh_mat3_t *a, const wh_mat3_t *b) {
    wh_mat3_t product;
    wh_mat3_multiply_back_to(a, b, &product);
    return product;
}

WH_HEADER_END

#endif
