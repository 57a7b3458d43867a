#include "words_internal.h"

#include <string.h>

wh_words_t wh_words_begin(char *buffer, size_t size) {
    const wh_words_t words = {buffer, size, 0};
    if (size > 0) {
        buffer[0] = '\0';
    }
    return words;
}

static void put_character(wh_words_t *words, char c) {
    if (words->length + 1 < words->size) {
        words->buffer[words->length] = c;
        words->buffer[words->length + 1] = '\0';
    }
    ++words->length;
}

void wh_words_put(wh_words_t *words, const char *text) {
    for (; *text != '\0'; ++text) {
        put_character(words, *text);
    }
}

static uint64_t power_of_ten(int exponent) {
    uint64_t power = 1;
    for (; exponent > 0; --exponent) {
        power *= 10;
    }
    return power;
}

/* The most digits of a 64-bit number, whose highest power of ten has one less. */
#define DIGITS 20

static int count_digits(uint64_t value) {
    int count = 1;
    while (count < DIGITS && value >= power_of_ten(count)) {
        ++count;
    }
    return count;
}

/* Writes this number of a number's last digits. It subtracts, because small processors divide 64 bits by a
 * function of the compiler's. */
static void put_digits(wh_words_t *words, uint64_t value, int count) {
    for (int i = count - 1; i >= 0; --i) {
        const uint64_t unit = power_of_ten(i);
        char digit = '0';
        for (; value >= unit; value -= unit) {
            ++digit;
        }
        put_character(words, digit);
    }
}

static void put_natural(wh_words_t *words, uint64_t value) {
    put_digits(words, value, count_digits(value));
}

void wh_words_integer(wh_words_t *words, int64_t value) {
    if (value < 0) {
        put_character(words, '-');
    }
    put_natural(words, value < 0 ? ~(uint64_t)value + 1 : (uint64_t)value);
}

/* -------------------------------------------------------------------------------------------------- reals */

/* A number below 1e15 in magnitude: a whole part, and a fraction in units of 2^-128, the highest 32 bits
 * first. A number has at most 53 bits, so only a number below 2^-75 loses some, and 15 decimals show none
 * of those. */
#define PARTS 4U
typedef struct {
    uint64_t whole;
    uint32_t fraction[PARTS];
} fixed_t;

#define TOO_LARGE WH_REAL(1e15)

/* Bits of a number: those of the mantissa, and the bias of the exponent. */
#if defined(WH_FLOAT)
#define BITS 23
#define BIAS 127
#else
#define BITS 52
#define BIAS 1023
#endif

/* Magnitude = mantissa * 2^exponent. */
static uint64_t take_apart(wh_real_t magnitude, int *exponent) {
    wh_real_bits_t bits;
    memcpy(&bits, &magnitude, sizeof bits);
    const uint64_t low = (uint64_t)bits & ((UINT64_C(1) << BITS) - 1);
    const int field = (int)((uint64_t)bits >> BITS);
    *exponent = (field > 0 ? field : 1) - BIAS - BITS;
    return field > 0 ? low | UINT64_C(1) << BITS : low;
}

/* Bit `at` counts from the lowest bit of the fraction; the whole part begins at bit 128. */
static void set_bit(fixed_t *fixed, unsigned at) {
    if (at >= 32U * PARTS) {
        fixed->whole |= UINT64_C(1) << (at - 32U * PARTS);
    } else {
        fixed->fraction[PARTS - 1U - at / 32U] |= UINT32_C(1) << (at % 32U);
    }
}

static fixed_t to_fixed(wh_real_t magnitude) {
    fixed_t fixed = {0, {0, 0, 0, 0}};
    int exponent = 0;
    uint64_t mantissa = take_apart(magnitude, &exponent);
    for (int at = exponent + 128; mantissa != 0; ++at) {
        if ((mantissa & 1U) != 0 && at >= 0) {
            set_bit(&fixed, (unsigned)at);
        }
        mantissa >>= 1;
    }
    return fixed;
}

/* Takes the next decimal digit off the fraction. */
static uint32_t next_digit(fixed_t *fixed) {
    uint64_t carry = 0;
    for (size_t part = PARTS; part > 0; --part) {
        carry += (uint64_t)fixed->fraction[part - 1] * 10;
        fixed->fraction[part - 1] = (uint32_t)carry;
        carry >>= 32;
    }
    return (uint32_t)carry;
}

/* True if the rest rounds the last digit up. */
static bool rounds_up(const fixed_t *rest, bool is_odd) {
    const uint32_t half = UINT32_C(1) << 31;
    const bool beyond = (rest->fraction[0] & ~half) != 0 || (rest->fraction[1] | rest->fraction[2]) != 0 ||
                        rest->fraction[3] != 0;
    return rest->fraction[0] >= half && (beyond || is_odd);
}

/* The first decimals, as one number; `fixed->whole` goes up if they round to a whole. */
static uint64_t round_decimals(fixed_t *fixed, int decimals) {
    uint64_t digits = 0;
    for (int i = 0; i < decimals; ++i) {
        digits = digits * 10 + next_digit(fixed);
    }
    const bool is_odd = ((decimals > 0 ? digits : fixed->whole) & 1U) != 0;
    digits += rounds_up(fixed, is_odd) ? 1 : 0;
    if (digits == power_of_ten(decimals)) {
        ++fixed->whole;
        digits = 0;
    }
    return digits;
}

/* Writes a number that has no digits to show; true if it did. */
static bool put_special(wh_words_t *words, wh_real_t value) {
    if (value != value) {
        wh_words_put(words, "nan");
    } else if (!(wh_real_abs(value) < TOO_LARGE)) {
        wh_words_put(words, value < 0 ? "less than -1e15" : "more than 1e15");
    } else {
        return false;
    }
    return true;
}

static void put_number(wh_words_t *words, wh_real_t value, fixed_t fixed, int decimals) {
    const uint64_t digits = round_decimals(&fixed, decimals);
    if (value < 0) {
        put_character(words, '-');
    }
    put_natural(words, fixed.whole);
    if (decimals > 0) {
        put_character(words, '.');
        put_digits(words, digits, decimals);
    }
}

void wh_words_fixed(wh_words_t *words, wh_real_t value, int decimals) {
    if (!put_special(words, value)) {
        put_number(words, value, to_fixed(wh_real_abs(value)), decimals);
    }
}

/* The number of decimals that show this number of significant digits. */
static int decimals_for(fixed_t fixed, int digits) {
    int decimals = fixed.whole > 0 ? digits - count_digits(fixed.whole) : digits;
    while (fixed.whole == 0 && decimals < WH_WORDS_DECIMALS && next_digit(&fixed) == 0) {
        ++decimals;
    }
    return decimals < 0 ? 0 : decimals > WH_WORDS_DECIMALS ? WH_WORDS_DECIMALS : decimals;
}

/* True if this number of decimals shows no more than one decimal fewer. */
static bool ends_in_zero(fixed_t fixed, int decimals) {
    fixed_t shorter = fixed;
    const uint64_t digits = round_decimals(&fixed, decimals);
    const uint64_t fewer = round_decimals(&shorter, decimals - 1);
    return fixed.whole == shorter.whole && digits == fewer * 10;
}

void wh_words_short(wh_words_t *words, wh_real_t value, int digits, int least) {
    if (put_special(words, value)) {
        return;
    }
    const fixed_t fixed = to_fixed(wh_real_abs(value));
    int decimals = decimals_for(fixed, digits);
    decimals = decimals < least ? least : decimals;
    while (decimals > 0 && ends_in_zero(fixed, decimals)) {
        --decimals;
    }
    put_number(words, value, fixed, decimals);
}

static bool is_too_large(wh_real_t value) {
    return !(wh_real_abs(value) < TOO_LARGE);
}

/* Rounding keeps the order, so if two texts differ, their order is right. */
bool wh_words_read_same(wh_real_t a, wh_real_t b, int decimals) {
    if (is_too_large(a) || is_too_large(b)) {
        return is_too_large(a) && is_too_large(b);
    }
    fixed_t one = to_fixed(wh_real_abs(a));
    fixed_t other = to_fixed(wh_real_abs(b));
    const uint64_t digits = round_decimals(&one, decimals);
    return digits == round_decimals(&other, decimals) && one.whole == other.whole;
}

int wh_words_apart(wh_real_t a, wh_real_t b, int least) {
    if (a == b || is_too_large(a) || is_too_large(b)) {
        return least;
    }
    int decimals = least;
    while (decimals < WH_WORDS_DECIMALS && wh_words_read_same(a, b, decimals)) {
        ++decimals;
    }
    return wh_words_read_same(a, b, decimals) ? least : decimals;
}
