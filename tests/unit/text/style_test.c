/* When there is colour, and how text is made fit to print. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <locale.h>
#include <stdlib.h>

#include "text/style.h"

static void colour_is_for_terminals(void **state) {
    (void)state;
    assert_true(wh_style_wants_colour(true, NULL, "xterm"));
    assert_true(wh_style_wants_colour(true, "", "xterm"));
    assert_false(wh_style_wants_colour(true, "1", "xterm"));
    assert_false(wh_style_wants_colour(false, NULL, "xterm"));
    assert_false(wh_style_wants_colour(true, NULL, "dumb"));
    assert_false(wh_style_wants_colour(true, NULL, ""));
    assert_false(wh_style_wants_colour(true, NULL, NULL));
}

static void no_terminal(void **state) {
    char *text = NULL;
    size_t size = 0;
    (void)state;
    FILE *out = open_memstream(&text, &size);
    const wh_style_t style = wh_style_of(out);
    assert_false(style.colour);
    assert_true(style.utf8);
    assert_int_equal(style.width, 0);
    assert_null(wh_style_ink(&style, WH_INK_BAD));
    fclose(out);
    free(text);
}

static void assert_printable(const char *text, const char *wanted, size_t columns) {
    char *printable = wh_style_printable(text);
    assert_string_equal(printable, wanted);
    assert_int_equal(wh_style_columns(printable), columns);
    free(printable);
}

static void text_is_made_printable(void **state) {
    (void)state;
    assert_printable("", "", 0);
    assert_printable("Wäfer №3", "Wäfer №3", 8);
    assert_printable("晶圆", "晶圆", 4);
    assert_printable("a\nb\t\033[1m", "a\\x0ab\\x09\\x1b[1m", 17);
    assert_printable("\xff\xe2\x82", "\\xff\\xe2\\x82", 12);
    assert_printable("\xc2\x9b", "\\xc2\\x9b", 8);
    assert_printable("e\xcc\x81", "e\xcc\x81", 1);
}

static void plain_locale(void **state) {
    (void)state;
    assert_non_null(setlocale(LC_CTYPE, "C"));
    assert_false(wh_style_of(stdout).utf8);
    assert_printable("\xc3\xa4", "\\xc3\\xa4", 8);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colour_is_for_terminals),
        cmocka_unit_test(no_terminal),
        cmocka_unit_test(text_is_made_printable),
        cmocka_unit_test(plain_locale),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
