/* Random numbers of a trial: their generator, their moments, their bits, and the logarithm that they need. */
#include <math.h>
#include <string.h>

#include "math/deviate.h"
#include "math/philox.h"
#include "math/trig.h"
#include "support/support.h"

/* The vectors that were published with the generator. */
static void philox_has_its_known_answers(void **state) {
    (void)state;
    static const struct {
        uint32_t counter[4], key[2], answer[4];
    } known[] = {
        {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
        {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
         {0xffffffff, 0xffffffff},
         {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
        {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
         {0xa4093822, 0x299f31d0},
         {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
        const wh_philox_t bits = wh_philox(known[i].counter, known[i].key);
        assert_memory_equal(bits.words, known[i].answer, sizeof bits.words);
    }
}

static void the_logarithm_is_libms_to_the_last_digits(void **state) {
    (void)state;
    for (int exponent = -1021; exponent < 1023; ++exponent) {
        for (int i = 0; i < 40; ++i) {
            const double x = ldexp(1 + i / 40.0, exponent);
            assert_true(fabs(wh_ln(x) - log(x)) <= 1e-15 * fabs(log(x)) + 1e-17);
        }
    }
    for (double u = 1 - 0x1p-20; u < 1; u += 0x1p-27) {
        assert_true(fabs(wh_ln(u) - log(u)) <= 1e-15 * fabs(log(u)) + 1e-17);
    }
    assert_true(wh_ln(1) == 0);
    assert_true(isnan(wh_ln(0x1p-1023)) && !isnan(wh_ln(0x1p-1022)));
    assert_true(isnan(wh_ln(0)) && isnan(wh_ln(-1)) && isnan(wh_ln((double)INFINITY)));
}

/* A number depends only on its name: neighbours in any of the four parts differ, and no call
 * changes another. */
static void a_deviate_depends_on_its_name(void **state) {
    (void)state;
    const wh_trial_t trial = {7, 11};
    const wh_trial_t others[] = {
        {8, 11}, {7, 12}, {7 + (UINT64_C(1) << 32), 11}, {7, 11 + (UINT64_C(1) << 32)}};
    const double u = wh_deviate_uniform(&trial, 3, 5);
    const double n = wh_deviate_normal(&trial, 3, 5);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        assert_true(wh_deviate_uniform(&others[i], 3, 5) != u);
        assert_true(wh_deviate_normal(&others[i], 3, 5) != n);
    }
    assert_true(wh_deviate_uniform(&trial, 4, 5) != u && wh_deviate_uniform(&trial, 3, 6) != u);
    assert_true(wh_deviate_uniform(&trial, 3, 5) == u && wh_deviate_normal(&trial, 3, 5) == n);
}

/* Moments of n values are off by their standard errors; an error of six of them never occurs. */
static void deviates_have_their_moments(void **state) {
    (void)state;
    const double N = 200000;
    double uniform[2] = {0, 0};
    double normal[4] = {0, 0, 0, 0};
    for (uint64_t i = 0; (double)i < N; ++i) {
        const wh_trial_t trial = {1, i};
        const double u = wh_deviate_uniform(&trial, 0, 0);
        const double x = wh_deviate_normal(&trial, 0, 0);
        assert_true(u > 0 && u < 1 && fabs(x) < 8.6);
        uniform[0] += u;
        uniform[1] += u * u;
        normal[0] += x;
        normal[1] += x * x;
        normal[2] += x * x * x;
        normal[3] += x * x * x * x;
    }
    const double root = sqrt(N);
    assert_true(fabs(uniform[0] / N - 0.5) < 6 * sqrt(1 / 12.0) / root);
    assert_true(fabs(uniform[1] / N - 1 / 3.0) < 6 * sqrt(4 / 45.0) / root);
    assert_true(fabs(normal[0] / N) < 6 / root);
    assert_true(fabs(normal[1] / N - 1) < 6 * sqrt(2.0) / root);
    assert_true(fabs(normal[2] / N) < 6 * sqrt(15.0) / root);
    assert_true(fabs(normal[3] / N - 3) < 6 * sqrt(96.0) / root);
}

/* The bits are the same on every machine: these are from x86-64. In float the cosine is another. */
static void deviates_keep_their_bits(void **state) {
    (void)state;
    uint64_t hash = 0;
    for (uint64_t i = 0; i < 10000; ++i) {
        const wh_trial_t trial = {42, i};
        const double x = wh_deviate_normal(&trial, 1, 2);
        uint64_t bits;
        memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
    }
    assert_int_equal(hash, sizeof(wh_real_t) == sizeof(float) ? UINT64_C(0xd7a48fb8099df0a1)
                                                              : UINT64_C(0xc9c8a8cb81354ca7));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(philox_has_its_known_answers),
        cmocka_unit_test(the_logarithm_is_libms_to_the_last_digits),
        cmocka_unit_test(a_deviate_depends_on_its_name),
        cmocka_unit_test(deviates_have_their_moments),
        cmocka_unit_test(deviates_keep_their_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
