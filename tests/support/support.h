/* Every test program needs this: cmocka in the order it wants, seeded random numbers, one assert
 * for reals. */
#ifndef WH_TESTS_SUPPORT_SUPPORT_H
#define WH_TESTS_SUPPORT_SUPPORT_H

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(__cplusplus)
extern "C" {
#endif
#include <setjmp.h>

#include <cmocka.h>
#if defined(__cplusplus)
}
#endif

#include "support/random.h"

/* In a program of many tests each test has a main with its own name: see support/together.h. */
#if defined(WH_TEST_MAIN)
int WH_TEST_MAIN(void);
#define main WH_TEST_MAIN
#endif

/* The divisor or stride of a long loop over fixed cases. Under sanitizers, which check how a thing
 * is done, a share of the cases is enough. It is also enough on a target under emulation, where the
 * same inputs give the same bits. Random rounds are cut by time: support/rounds.h. The script that
 * judges mutants under sanitizers sets it itself. */
#if !defined(WH_TEST_SHARE)
#if defined(__SANITIZE_ADDRESS__)
#define WH_TEST_SHARE 20
#elif !defined(__unix__)
#define WH_TEST_SHARE 10
#else
#define WH_TEST_SHARE 1
#endif
#endif

/* Room for the text that wh_test_path writes. */
#define WH_TEST_PATH 200

/* A template for mkstemp and mkdtemp, in TMPDIR if the environment has one. Returns `path`. */
static inline char *wh_test_path(char path[WH_TEST_PATH], const char *name) {
    const char *folder = getenv("TMPDIR");
    const int length = snprintf(path, WH_TEST_PATH, "%s/waferhand_%s_XXXXXX", folder ? folder : "/tmp", name);
    assert_in_range(length, 1, WH_TEST_PATH - 1);
    return path;
}

static uint64_t wh_test_state, wh_test_first;
static int wh_test_seeded;

/* The run's seed: WH_SEED from the environment, otherwise a fixed one. It is printed, so that a
 * failure can be repeated. Random numbers start afresh from it. */
static inline uint64_t wh_test_seed(void) {
    const char *text = getenv("WH_SEED");
    const uint64_t seed = text ? strtoull(text, NULL, 0) : UINT64_C(20240229);
    printf("WH_SEED=%llu\n", (unsigned long long)seed);
    (void)fflush(stdout); /* a sanitizer may end the program at once */
    wh_test_state = wh_test_first = seed;
    wh_test_seeded = 1;
    return seed;
}

/* The random numbers of the seed's n-th row, n > 0. */
static inline void wh_test_restart_at(uint64_t n) {
    if (!wh_test_seeded) {
        (void)wh_test_seed();
    }
    wh_test_state = wh_test_first ^ n * UINT64_C(0xd1342543de82ef95);
    wh_test_state = wh_test_splitmix(&wh_test_state);
}

/* 64 random bits of this run. */
static inline uint64_t wh_test_random(void) {
    if (!wh_test_seeded) {
        (void)wh_test_seed();
    }
    return wh_test_splitmix(&wh_test_state);
}

/* In [lo, hi). */
static inline double wh_test_uniform(double lo, double hi) {
    return lo + (hi - lo) * ((double)(wh_test_random() >> 11) * (1.0 / 9007199254740992.0));
}

/* In [lo, hi), both > 0, every decade as likely as any other. */
static inline double wh_test_decades(double lo, double hi) {
    return exp(wh_test_uniform(log(lo), log(hi)));
}

/* In 0 .. n-1; n > 0. */
static inline uint32_t wh_test_below(uint32_t n) {
    return (uint32_t)((wh_test_random() >> 32) * n >> 32);
}

#include "support/rounds.h"

/* Fails unless |a - b| <= tolerance, and for any NaN. */
#define assert_near(a, b, tolerance)                                                                         \
    wh_test_assert_near((double)(a), (double)(b), (double)(tolerance), __FILE__, __LINE__)

static inline void wh_test_assert_near(double a, double b, double tolerance, const char *file, int line) {
    if (!(fabs(a - b) <= tolerance)) {
        print_error("%.17g is not within %.17g of %.17g\n", a, tolerance, b);
        _fail(file, line);
    }
}

#endif
