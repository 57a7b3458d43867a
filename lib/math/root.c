/* wh_cbrt: scales to [1, 8) by powers of eight, starts from a cubic and takes two steps of Halley's method,
 * the second from an exact residual. So one rounding decides the result. */
#include "exact_internal.h"
#include "trig.h"

/* 8^(2^k) and its root 2^(2^k), largest first. */
typedef struct {
    wh_real_t cube, root;
} power_t;

#if defined(WH_FLOAT)
static const power_t powers[] = {{0x1p+96F, 0x1p+32F}, {0x1p+48F, 0x1p+16F}, {0x1p+24F, 0x1p+8F},
                                 {0x1p+12F, 0x1p+4F},  {0x1p+6F, 0x1p+2F},   {0x1p+3F, 0x1p+1F}};
#else
static const power_t powers[] = {{0x1p+768, 0x1p+256}, {0x1p+384, 0x1p+128}, {0x1p+192, 0x1p+64},
                                 {0x1p+96, 0x1p+32},   {0x1p+48, 0x1p+16},   {0x1p+24, 0x1p+8},
                                 {0x1p+12, 0x1p+4},    {0x1p+6, 0x1p+2},     {0x1p+3, 0x1p+1}};
#endif
#define POWERS (sizeof powers / sizeof powers[0])

/* value = scaled * root_scale^3, scaled in [1, 8), for a finite value > 0; exact. */
typedef struct {
    wh_real_t scaled, root_scale;
} scaled_t;

static scaled_t scale(wh_real_t value) {
    scaled_t s = {value, 1};
    const bool small = value < 1;
    for (size_t k = 0; k < POWERS; ++k) {
        if (small && s.scaled * powers[k].cube < 8) {
            s.scaled *= powers[k].cube;
            s.root_scale /= powers[k].root;
        } else if (!small && s.scaled >= powers[k].cube) {
            s.scaled /= powers[k].cube;
            s.root_scale *= powers[k].root;
        }
    }
    return s;
}

/* The root of m in [1, 8). The cubic is the minimax fit of relative error 2^-7.6 (Remez exchange,
 * coefficients rounded to float); Halley's step cubes that error each time. */
static wh_real_t root_of(wh_real_t m) {
    wh_real_t root =
        ((WH_REAL(0x1.2f3764p-9) * m + WH_REAL(-0x1.62d026p-5)) * m + WH_REAL(0x1.7548fap-2)) * m +
        WH_REAL(0x1.5d04b4p-1);
    const wh_real_t cube = root * root * root;
    root += root * (m - cube) / (2 * cube + m);
    const wh_exact_t square = wh_exact_product(root, root);
    const wh_exact_t product = wh_exact_product(square.hi, root);
    const wh_real_t residual = ((m - product.hi) - product.lo) - square.lo * root;
    return root + root * residual / (2 * product.hi + m);
}

wh_real_t wh_cbrt(wh_real_t x) {
    if (x == 0 || !wh_real_is_finite(x)) {
        return x;
    }
    const scaled_t s = scale(wh_real_abs(x));
    const wh_real_t root = root_of(s.scaled) * s.root_scale;
    return x < 0 ? -root : root;
}
