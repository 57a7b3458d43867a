#include "digits.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"

/* Values in this range are handled by whole numbers of 128 bits, without any rounding; those below some
 * 1e-15, such as what is left of a turn, by 64 bits more. */
#define LEAST 1e-36
#define BELOW 1e15

/* All values are brought to a whole part of so many digits, above this power of ten. */
enum { DIGITS = 17 };

/* With more powers of ten a product needs more than 128 bits. */
enum { MOST_TENS = 32 };

#define TEN_16 UINT64_C(10000000000000000)

/* Below this exponent printf's %g writes "1e-05". */
enum { LEAST_EXPONENT = -4 };

__extension__ typedef unsigned __int128 wide_t;

#define WIDEST ((wide_t)1 << 125)

/* The powers of five in 64 bits. */
enum { FIVES = 28 };
static const uint64_t fives[FIVES] = {1,
                                      5,
                                      25,
                                      125,
                                      625,
                                      3125,
                                      15625,
                                      78125,
                                      390625,
                                      1953125,
                                      9765625,
                                      48828125,
                                      244140625,
                                      1220703125,
                                      6103515625,
                                      30517578125,
                                      152587890625,
                                      762939453125,
                                      3814697265625,
                                      19073486328125,
                                      95367431640625,
                                      476837158203125,
                                      2384185791015625,
                                      11920928955078125,
                                      59604644775390625,
                                      298023223876953125,
                                      1490116119384765625,
                                      7450580596923828125};

/* A value times 10^(16 - exponent): product / 2^shift, whose whole part has 17 digits. */
typedef struct {
    wide_t product;
    uint64_t low; /* of a small value: 64 bits below the product */
    bool is_small;
    unsigned shift;
    int exponent;
    wide_t five;          /* a step to the next double's product, in units of its lowest bit */
    uint64_t significand; /* of 53 bits */
} scaled_t;

static uint64_t whole_of(const scaled_t *scaled) {
    return (uint64_t)(scaled->product >> scaled->shift);
}

/* From 5^33 on the product has more than 128 bits. Those above the lowest 64 fit: 5^27 has 63 bits, and
 * the rest of the power is at most 5^26. */
static scaled_t scale_small(uint64_t significand, int power, int exponent) {
    const int tens = DIGITS - 1 - exponent;
    const uint64_t rest = fives[tens - FIVES + 1];
    const wide_t first = (wide_t)significand * fives[FIVES - 1];
    const wide_t low = (wide_t)(uint64_t)first * rest;
    return (scaled_t){.product = (first >> 64) * rest + (low >> 64),
                      .low = (uint64_t)low,
                      .is_small = true,
                      .shift = (unsigned)(-power - tens - 64),
                      .exponent = exponent,
                      .five = (wide_t)fives[FIVES - 1] * rest,
                      .significand = significand};
}

/* The exponents in range need at most 5^32, of 75 bits, which still fits with the significand. */
static scaled_t scale_to(uint64_t significand, int power, int exponent) {
    const int tens = DIGITS - 1 - exponent;
    if (tens > MOST_TENS) {
        return scale_small(significand, power, exponent);
    }
    const wide_t five = tens < FIVES ? fives[tens] : (wide_t)fives[FIVES - 1] * fives[tens - FIVES + 1];
    return (scaled_t){.product = significand * five,
                      .shift = (unsigned)(-power - tens),
                      .exponent = exponent,
                      .five = five,
                      .significand = significand};
}

/* For a normal double above 0. */
static scaled_t scale(double value) {
    const uint64_t bits = wh_double_bits(value);
    const int power = (int)(bits >> 52) - 1023;
    const uint64_t significand = (bits & ((UINT64_C(1) << 52) - 1)) | UINT64_C(1) << 52;
    const int exponent = (power >= 0 ? power * 1233 : power * 1233 - 4095) / 4096; /* 1233 / 4096: log10(2) */
    const scaled_t scaled = scale_to(significand, power - 52, exponent);
    const uint64_t whole = whole_of(&scaled);
    const int off = whole < TEN_16 ? -1 : whole / 10 >= TEN_16 ? 1 : 0;
    return off == 0 ? scaled : scale_to(significand, power - 52, exponent + off);
}

/* The whole number nearest to the scaled value that is a multiple of `unit`; of two the even multiple. */
static inline uint64_t round_to(const scaled_t *scaled, uint64_t unit) {
    const uint64_t multiple = whole_of(scaled) / unit;
    const wide_t rest = scaled->product - ((wide_t)(multiple * unit) << scaled->shift);
    const wide_t half = (wide_t)unit << (scaled->shift - 1);
    const bool up = rest > half || (rest == half && (scaled->low > 0 || multiple % 2 == 1));
    return (multiple + (up ? 1 : 0)) * unit;
}

/* The distance of a small value's product from another one, in units of its lowest bit; WIDEST: beyond all
 * steps between doubles. */
static wide_t distance_small(const scaled_t *scaled, wide_t read, bool is_below) {
    const wide_t high =
        is_below ? scaled->product - read : read - scaled->product - (scaled->low > 0 ? 1 : 0);
    const uint64_t low = is_below ? scaled->low : 0 - scaled->low;
    return high >> 60 > 0 ? WIDEST : high << 64 | low;
}

/* True if the decimal number is nearest to this double of all doubles. Below a power of two they are twice as
 * dense. */
static bool reads_back(const scaled_t *scaled, uint64_t decimal) {
    const wide_t read = (wide_t)decimal << scaled->shift;
    const bool is_below = read < scaled->product || (read == scaled->product && scaled->low > 0);
    const wide_t off = scaled->is_small ? distance_small(scaled, read, is_below)
                       : is_below       ? scaled->product - read
                                        : read - scaled->product;
    const bool is_dense = is_below && scaled->significand == UINT64_C(1) << 52;
    const wide_t steps = off * (is_dense ? 4 : 2);
    return steps < scaled->five || (steps == scaled->five && scaled->significand % 2 == 0);
}

/* Writes 0.000123 or 12.3 from the digits. */
static char *put_plain(char *end, const char digits[DIGITS], int count, int exponent) {
    if (exponent < 0) {
        *end++ = '0';
        *end++ = '.';
        memset(end, '0', (size_t)(-1 - exponent));
        end += -1 - exponent;
    }
    for (int i = 0; i < count || i <= exponent; ++i) {
        *end++ = digits[i]; /* those beyond the count are zeros */
        if (i == exponent && i + 1 < count) {
            *end++ = '.';
        }
    }
    return end;
}

/* Writes 1.23e-05. */
static char *put_small(char *end, const char digits[DIGITS], int count, int exponent) {
    end = put_plain(end, digits, count, 0);
    *end++ = 'e';
    *end++ = '-';
    *end++ = (char)('0' + -exponent / 10);
    *end++ = (char)('0' + -exponent % 10);
    return end;
}

/* By two halves, so that the divisions do not wait for each other. */
static void put_eight(char digits[8], uint32_t number) {
    uint32_t high = number / 10000;
    uint32_t low = number % 10000;
    for (int i = 3; i >= 0; --i) {
        digits[i] = (char)('0' + high % 10);
        digits[i + 4] = (char)('0' + low % 10);
        high /= 10;
        low /= 10;
    }
}

static void put_decimal(char *end, uint64_t decimal, int exponent) {
    char digits[DIGITS];
    int count = DIGITS;
    if (decimal / 10 == TEN_16) { /* rounded up to the next power */
        decimal /= 10;
        ++exponent;
    }
    put_eight(digits + 9, (uint32_t)(decimal % 100000000));
    put_eight(digits + 1, (uint32_t)(decimal / 100000000 % 100000000));
    digits[0] = (char)('0' + decimal / TEN_16);
    while (count > 1 && digits[count - 1] == '0') {
        --count;
    }
    end = exponent < LEAST_EXPONENT ? put_small(end, digits, count, exponent)
                                    : put_plain(end, digits, count, exponent);
    *end = '\0';
}

static void put_any(double value, char digits[WH_DIGITS]) {
    for (int precision = 15; precision <= DIGITS; ++precision) {
        (void)snprintf(digits, WH_DIGITS, "%.*g", precision, value);
        if (strtod(digits, NULL) == value) {
            break;
        }
    }
}

void wh_digits(double value, char digits[WH_DIGITS]) {
    const double size = fabs(value);
    if (size == 0) {
        (void)strcpy(digits, signbit(value) ? "-0" : "0");
        return;
    }
    if (!(size >= LEAST && size < BELOW)) {
        put_any(value, digits);
        return;
    }
    const scaled_t scaled = scale(size);
    uint64_t decimal = round_to(&scaled, 100);
    if (!reads_back(&scaled, decimal)) {
        decimal = round_to(&scaled, 10);
    }
    if (!reads_back(&scaled, decimal)) {
        decimal = round_to(&scaled, 1);
    }
    if (value < 0) {
        *digits++ = '-';
    }
    put_decimal(digits, decimal, scaled.exponent);
}
