/* Digits against printf and strtod: text for text, where rounding is hardest too. */
#include "text/digits.h"

#include "support/support.h"

/* The fewest digits, as libc finds them. */
static void expect_digits(double value) {
    char digits[WH_DIGITS], expected[WH_DIGITS];
    wh_digits(value, digits);
    for (int precision = 15; precision <= 17; ++precision) {
        (void)snprintf(expected, sizeof expected, "%.*g", precision, value);
        if (strtod(expected, NULL) == value) {
            break;
        }
    }
    assert_string_equal(digits, expected);
}

/* The value, its neighbours, and all of them with the other sign. */
static void expect_around(double value) {
    double at = nextafter(nextafter(value, 0), 0);
    for (int i = 0; i < 5; ++i) {
        expect_digits(at);
        expect_digits(-at);
        at = nextafter(at, HUGE_VAL);
    }
}

static void measured_values_have_the_digits_of_printf(void **state) {
    (void)state;
    for (int i = 0; i < 40000 / WH_TEST_SHARE; ++i) {
        const double sign = wh_test_below(2) == 0 ? -1 : 1;
        expect_digits(sign * (double)wh_test_below(100000000) / 1000);
        expect_digits(sign * wh_test_decades(1e-40, 1e30));
        expect_digits(sign * wh_test_decades(1e-18, 1e-14));
    }
}

/* Next to a power of two doubles are half as far apart below it as above. */
static void values_at_powers_of_two_and_ten_have_them(void **state) {
    (void)state;
    for (int power = -130; power <= 70; ++power) {
        expect_around(ldexp(1, power));
        expect_around(ldexp(3, power));
    }
    for (int power = -38; power <= 20; ++power) {
        expect_around(pow(10, power));
        expect_around(5 * pow(10, power));
        expect_around(9.9999999999999995 * pow(10, power));
    }
}

/* Whole numbers and a half lie exactly between two shorter ones. */
static void ties_go_to_the_even_digit(void **state) {
    (void)state;
    for (int i = 0; i < 20000 / WH_TEST_SHARE; ++i) {
        const double whole = (double)wh_test_below(1U << 31) * (double)(1U << wh_test_below(20));
        expect_digits(whole + 0.5);
        expect_digits(ldexp(whole + 1, -100));
        expect_digits(whole / 4);
        expect_digits(whole);
    }
}

static void values_without_digits_are_those_of_printf(void **state) {
    (void)state;
    static const double values[] = {0.0, -0.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 1e15};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        expect_digits(values[i]);
    }
    expect_digits(HUGE_VAL);
    expect_digits(-HUGE_VAL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(measured_values_have_the_digits_of_printf),
        cmocka_unit_test(values_at_powers_of_two_and_ten_have_them),
        cmocka_unit_test(ties_go_to_the_even_digit),
        cmocka_unit_test(values_without_digits_are_those_of_printf),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
