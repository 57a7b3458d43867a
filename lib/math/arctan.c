/* wh_atan2: the ratio is brought to |t| <= 1/4 about one of three angles, and everything but one small
 * polynomial is carried in two numbers, so that one rounding decides the result. */
#include "exact_internal.h"
#include "trig.h"

/* atan t = t + t^3 P(t^2) on |t| <= 1/4, minimax (Remez exchange in 70 digits, then each coefficient
 * rounded): relative error of atan 2^-61.3 in double, 2^-31.0 in float. Angles are in two numbers. `big`
 * bounds the magnitudes within which products are exact, `scale` brings larger and smaller ones there; below
 * the ratio `flat` atan t is t. */
#if defined(WH_FLOAT)
#define TERMS 4
static const wh_real_t terms[TERMS] = {-0x1.55555p-2F, 0x1.9992a6p-3F, -0x1.233d68p-3F, 0x1.92ed6p-4F};
static const wh_exact_t centre_angle[3] = {
    {0, 0}, {0x1.dac67p-2F, 0x1.586ed4p-28F}, {0x1.921fb6p-1F, -0x1.777a5cp-26F}};
static const wh_exact_t quarter_turn = {0x1.921fb6p+0F, -0x1.777a5cp-25F};
static const wh_exact_t half_turn = {0x1.921fb6p+1F, -0x1.777a5cp-24F};
static const wh_real_t big = 0x1p+40F;
static const wh_real_t small = 0x1p-40F;
static const wh_real_t scale = 0x1p+80F;
static const wh_real_t flat = 0x1p-60F;
#else
#define TERMS 9
static const wh_real_t terms[TERMS] = {-0x1.5555555555553p-2, 0x1.9999999998d7cp-3,  -0x1.24924923ea273p-3,
                                       0x1.c71c7137ed9ccp-4,  -0x1.745cf4b83cd18p-4, 0x1.3b0ea41ecf15ep-4,
                                       -0x1.109bfc3cc89dfp-4, 0x1.d4f7bf70b4747p-5,  -0x1.47a246c6d0bf5p-5};
static const wh_exact_t centre_angle[3] = {
    {0, 0}, {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56}, {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
static const wh_exact_t quarter_turn = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
static const wh_exact_t half_turn = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
static const wh_real_t big = 0x1p+400;
static const wh_real_t small = 0x1p-400;
static const wh_real_t scale = 0x1p+700;
static const wh_real_t flat = 0x1p-500;
#endif

/* The sign bit, also of zeros. */
static bool is_negative(wh_real_t x) {
    return wh_bits(x) >> (8 * sizeof(wh_bits_t) - 1) != 0;
}

/* 0, 1/2 or 1, in halves: the centre nearest to low/high. high - centre * low and its like are then exact. */
static int nearest_centre(wh_real_t low, wh_real_t high) {
    if (4 * low < high) {
        return 0;
    }
    return 4 * low < 3 * high ? 1 : 2;
}

/* atan(low / high) for flat * high <= low <= high, brought to magnitudes whose products are exact. */
static wh_exact_t arctan(wh_real_t low, wh_real_t high) {
    const int halves = nearest_centre(low, high);
    const wh_real_t centre = (wh_real_t)halves / 2;
    const wh_real_t over = low - centre * high;
    const wh_exact_t under = wh_exact_sum(high, centre * low);
    const wh_real_t t = over / under.hi;
    const wh_exact_t back = wh_exact_product(t, under.hi);
    const wh_real_t t_lost = (((over - back.hi) - back.lo) - t * under.lo) / under.hi;
    const wh_real_t z = t * t;
    wh_real_t sum = terms[TERMS - 1];
    for (int term = TERMS - 2; term >= 0; --term) {
        sum = sum * z + terms[term];
    }
    wh_exact_t angle = wh_exact_sum(centre_angle[halves].hi, t);
    angle.lo += t * z * sum + (t_lost + centre_angle[halves].lo);
    return angle;
}

/* whole + sign * angle */
static wh_exact_t from_axis(wh_exact_t whole, wh_real_t sign, wh_exact_t angle) {
    wh_exact_t sum = wh_exact_sum(whole.hi, sign * angle.hi);
    sum.lo += whole.lo + sign * angle.lo;
    return sum;
}

/* The angle in [0, pi/4] to the nearer axis; *cross is 1 when that is the y axis. */
static wh_exact_t first_quadrant(wh_real_t y, wh_real_t x, wh_real_t *cross) {
    const bool steep = y > x;
    wh_real_t low = steep ? x : y;
    wh_real_t high = steep ? y : x;
    *cross = steep ? WH_REAL(1) : WH_REAL(0);
    if (high == 0 || low < flat * high) {
        const wh_exact_t angle = {high == 0 ? high : low / high, 0};
        return angle;
    }
    if (high > big) {
        low /= scale;
        high /= scale;
    } else if (high < small) {
        low *= scale;
        high *= scale;
    }
    return arctan(low, high);
}

wh_real_t wh_atan2(wh_real_t y, wh_real_t x) {
    if (!(y == y) || !(x == x)) {
        return (wh_real_t)NAN;
    }
    wh_real_t steep;
    const bool diagonal = !wh_real_is_finite(y) && !wh_real_is_finite(x); /* C99: 45 degrees */
    wh_exact_t angle =
        diagonal ? first_quadrant(1, 1, &steep) : first_quadrant(wh_real_abs(y), wh_real_abs(x), &steep);
    const bool back = is_negative(x);
    if (steep != 0) {
        angle = from_axis(quarter_turn, back ? WH_REAL(1) : WH_REAL(-1), angle);
    } else if (back) {
        angle = from_axis(half_turn, -1, angle);
    }
    const wh_real_t result = angle.hi + angle.lo;
    return is_negative(y) ? -result : result;
}

wh_real_t wh_acos(wh_real_t cosine) {
    const wh_real_t square = (1 - cosine) * (1 + cosine);
    return wh_atan2(wh_real_sqrt(square > 0 ? square : 0), cosine);
}
