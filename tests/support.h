/* What the tests share: a seeded generator and a comparison of reals. Include it after <cmocka.h>. */
#ifndef WH_TESTS_SUPPORT_H
#define WH_TESTS_SUPPORT_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* The seed of this run: WH_SEED of the environment (decimal, or 0x...), else a fixed one. Printed when first
 * asked for, so that a failure can be had again. */
static inline uint64_t wh_test_seed(void) {
    static uint64_t seed;
    static int known;
    if (!known) {
        const char *text = getenv("WH_SEED");
        seed = text != NULL ? (uint64_t)strtoull(text, NULL, 0) : UINT64_C(20260415);
        known = 1;
        printf("seed %llu (set WH_SEED to repeat)\n", (unsigned long long)seed);
    }
    return seed;
}

/* The next 64 bits after *state (splitmix64): the same on every machine. */
static inline uint64_t wh_test_next(uint64_t *state) {
    *state += UINT64_C(0x9E3779B97F4A7C15);
    uint64_t bits = *state;
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94D049BB133111EB);
    return bits ^ (bits >> 31);
}

/* 64 random bits of this run. */
static inline uint64_t wh_test_bits(void) {
    static uint64_t state;
    static int begun;
    if (!begun) {
        state = wh_test_seed();
        begun = 1;
    }
    return wh_test_next(&state);
}

/* A random number in [lo, hi). */
static inline double wh_test_uniform(double lo, double hi) {
    return lo + (hi - lo) * ((double)(wh_test_bits() >> 11) * (1.0 / 9007199254740992.0));
}

/* A random number in [lo, hi), both > 0, every decade as likely as any other. */
static inline double wh_test_decades(double lo, double hi) {
    return exp(wh_test_uniform(log(lo), log(hi)));
}

static inline void wh_test_near(double a, double b, double tolerance, const char *text, const char *file,
                                int line) {
    if (!(fabs(a - b) <= tolerance)) {
        print_error("%s: %.17g and %.17g differ by %.3g, more than %.3g\n", text, a, b, fabs(a - b),
                    tolerance);
        _fail(file, line);
    }
}

/* |a - b| <= tolerance; NaN is near nothing. cmocka has no assertion for doubles. */
#define assert_near(a, b, tolerance)                                                                         \
    wh_test_near((double)(a), (double)(b), (double)(tolerance), #a " near " #b, __FILE__, __LINE__)

#endif
