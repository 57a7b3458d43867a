/* Addition of doubles for a Cortex-M4. libgcc's addition (gcc 12) rounds wrongly in rare cases: the
 * exponents differ by 33 and the difference loses a bit, as in 1 - 0x1.83cdf608367dep-33.
 * Everything else in libgcc's software arithmetic is correctly rounded, as far as our runs show. */
#include <stdint.h>
#include <string.h>

#define SOFT __attribute__((pcs("aapcs")))

SOFT double __aeabi_dadd(double a, double b);
SOFT double __aeabi_dsub(double a, double b);
SOFT double __aeabi_drsub(double a, double b);

enum { GUARD = 10 }; /* bits kept below the last place, the lowest of them for whatever is lost */

#define SIGN (UINT64_C(1) << 63)
#define INFINITE UINT64_C(0x7ff0000000000000)
#define HIDDEN (UINT64_C(1) << 52)
#define TOP (HIDDEN << GUARD)

static int exponent(uint64_t magnitude) {
    const int e = (int)(magnitude >> 52);
    return e > 0 ? e : 1;
}

static uint64_t significand(uint64_t magnitude) {
    const uint64_t m = magnitude & (HIDDEN - 1);
    return (magnitude >> 52 ? m | HIDDEN : m) << GUARD;
}

static uint64_t shift_right(uint64_t m, int places) {
    if (places > 62) {
        return m != 0;
    }
    return m >> places | ((m & ((UINT64_C(1) << places) - 1)) != 0);
}

/* Round to nearest, ties to even; a carry correctly runs into the exponent. */
static uint64_t pack(uint64_t m, int e) {
    const uint64_t half = UINT64_C(1) << (GUARD - 1);
    const uint64_t rest = m & (2 * half - 1);
    uint64_t bits = m >> GUARD;
    bits = bits >= HIDDEN ? bits + ((uint64_t)(e - 1) << 52) : bits;
    bits += rest > half || (rest == half && (bits & 1) != 0);
    return bits < INFINITE ? bits : INFINITE;
}

/* |a| >= |b|, a finite. */
static uint64_t add_smaller(uint64_t a, uint64_t b) {
    const uint64_t sign = a & SIGN;
    int e = exponent(a & ~SIGN);
    const uint64_t small = shift_right(significand(b & ~SIGN), e - exponent(b & ~SIGN));
    uint64_t m = significand(a & ~SIGN);
    m = ((a ^ b) & SIGN) != 0 ? m - small : m + small;
    if (m == 0) {
        return a & b & SIGN;
    }
    if (m >= 2 * TOP) {
        m = shift_right(m, 1);
        ++e;
    }
    while (m < TOP && e > 1) {
        m <<= 1;
        --e;
    }
    return sign | pack(m, e);
}

static uint64_t add(uint64_t a, uint64_t b) {
    const uint64_t size_a = a & ~SIGN;
    const uint64_t size_b = b & ~SIGN;
    if (size_a > INFINITE || size_b > INFINITE) {
        return size_a > INFINITE ? a : b;
    }
    if (size_a == INFINITE || size_b == INFINITE) {
        const int opposite = size_a == size_b && a != b;
        return opposite ? INFINITE | HIDDEN >> 1 : (size_a == INFINITE ? a : b);
    }
    return size_a >= size_b ? add_smaller(a, b) : add_smaller(b, a);
}

static double sum(double a, double b, uint64_t flip_a, uint64_t flip_b) {
    uint64_t bits_a;
    uint64_t bits_b;
    memcpy(&bits_a, &a, sizeof bits_a);
    memcpy(&bits_b, &b, sizeof bits_b);
    const uint64_t bits = add(bits_a ^ flip_a, bits_b ^ flip_b);
    double result;
    memcpy(&result, &bits, sizeof result);
    return result;
}

SOFT double __aeabi_dadd(double a, double b) {
    return sum(a, b, 0, 0);
}

SOFT double __aeabi_dsub(double a, double b) {
    return sum(a, b, 0, SIGN);
}

SOFT double __aeabi_drsub(double a, double b) {
    return sum(a, b, SIGN, 0);
}
