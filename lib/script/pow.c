/* The `^` of scripts: liblua calls pow, and the linker finds this one before libm's.
 *
 * Whole-number exponents are computed by repeated squaring, with equal bits on every machine. A script that
 * asks for a fractional exponent is stopped at its next instruction. All other callers get the rounded
 * result of libm's powl; this library itself never calls pow.
 *
 * The program links liblua5.4.a statically. Build this file with -fno-builtin-pow. The linker of the
 * playground hands each call of pow to __wrap_pow, for its C library's powl calls pow.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "sandbox_internal.h"

static __thread wh_sandbox_t *strict_sandbox = NULL;

wh_sandbox_t *wh_pow_set_strict(wh_sandbox_t *sandbox) {
    wh_sandbox_t *const before = strict_sandbox;
    strict_sandbox = sandbox;
    return before;
}

/* Exponents of 2^64 and more are even: x^y is 0, 1 or infinite. */
static double power_huge(double x) {
    const double size = fabs(x);
    if (size == 1) {
        return 1;
    }
    return size > 1 ? HUGE_VAL : size < 1 ? 0 : x;
}

static double power_of_count(double x, uint64_t count) {
    double result = 1;
    double square = x;
    while (count != 0) {
        if (count & 1) {
            result *= square;
        }
        square *= square;
        count >>= 1;
    }
    return result;
}

/* A single division of 1 at the end has the smallest rounding error. If the divisor is not a normal number,
 * two factors keep the quotient: for example 2^-1074 is a number although 2^1074 is not. */
static double power_of_negative(double x, uint64_t count) {
    const double whole = power_of_count(x, count);
    if (fabs(whole) >= DBL_MIN && fabs(whole) <= DBL_MAX) {
        return 1 / whole;
    }
    return 1 / power_of_count(x, count / 2) * (1 / power_of_count(x, count - count / 2));
}

static double power_whole(double x, double y) {
    const double size = fabs(y);
    if (size >= 0x1p64) {
        const double result = power_huge(x);
        return y > 0 ? result : 1 / result;
    }
    return y >= 0 ? power_of_count(x, (uint64_t)size) : power_of_negative(x, (uint64_t)size);
}

/* True if Lua code calls it, and not a C function of the host; it keeps the place for the message. The
 * count hook keeps the line current. */
static bool lua_asks(wh_sandbox_t *sandbox) {
    lua_Debug frame;
    if (sandbox->running == NULL || !lua_getstack(sandbox->running, 0, &frame) ||
        !lua_getinfo(sandbox->running, "Sl", &frame) || strcmp(frame.what, "C") == 0) {
        return false;
    }
    sandbox->power_line = frame.currentline;
    memcpy(sandbox->power_source, frame.short_src, sizeof sandbox->power_source);
    return true;
}

#if defined(__EMSCRIPTEN__)
double __real_pow(double x, double y);
double __wrap_pow(double x, double y);
#define pow __wrap_pow
#define ROUNDED_POWER(x, y) __real_pow(x, y)
#else
#define ROUNDED_POWER(x, y) (double)powl((long double)(x), (long double)(y))
#endif

double pow(double x, double y) {
    if (y - y == 0 && y == floor(y)) {
        return power_whole(x, y);
    }
    wh_sandbox_t *const sandbox = strict_sandbox;
    if (sandbox != NULL && sandbox->loading > 0) {
        return (double)NAN; /* the compiler does not fold NaN, so the running script calls again */
    }
    if (sandbox == NULL || !lua_asks(sandbox)) {
        return ROUNDED_POWER(x, y);
    }
    sandbox->power_exponent = y;
    sandbox->power_pending = true;
    wh_sandbox_spend(sandbox, WH_SANDBOX_GRANULE);
    wh_sandbox_alarm(sandbox);
    return (double)NAN;
}
