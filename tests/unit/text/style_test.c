/* Which bytes are characters, against jansson's own check, and where a text is cut; when there is colour, and how text
 * is made fit to print. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "text/style.h"
#include "text/utf8.h"

/* Every text of up to three bytes, and those of four that begin with a lead of four, whose last byte is at an edge. */
static void a_character_is_what_jansson_takes_for_one(void **state) {
    static const unsigned char edges[] = {0x00, 0x7F, 0x80, 0xBF, 0xC0, 0xFF};
    (void)state;
    for (unsigned code = 0; code < 1U << 24; code += code >= 0xF50000 || code < 0xC20000 ? 97 : 1) {
        for (size_t i = 0; i < sizeof edges; i += code < 0xF00000 ? sizeof edges : 1) {
            const char text[] = {(char)(code >> 16), (char)(code >> 8), (char)code, (char)edges[i], '\0'};
            const size_t bytes = wh_utf8_bytes(text);
            json_t *value = json_stringn(text, bytes);
            assert_true(bytes <= 4 && (bytes > 0 || value));
            assert_non_null(value);
            json_decref(value);
            for (size_t shorter = 1; bytes == 0 && shorter <= strlen(text); ++shorter) {
                assert_null(json_stringn(text, shorter));
            }
        }
    }
}

static void cuts_are_between_characters(void **state) {
    char clipped[8];
    (void)state;
    assert_int_equal(wh_utf8_count("aµ→𝄞"), 4);
    assert_int_equal(wh_utf8_cut("aµ→𝄞", 2), 1);
    assert_int_equal(wh_utf8_cut("aµ→𝄞", 3), 3);
    assert_int_equal(wh_utf8_cut("\x80\x80", 1), 0);
    wh_utf8_clip(clipped, sizeof clipped, "aµ→𝄞");
    assert_string_equal(clipped, "aµ...");
    wh_utf8_clip(clipped, sizeof clipped, "aµ→b");
    assert_string_equal(clipped, "aµ→b");
}

static void what_is_no_character_is_replaced(void **state) {
    (void)state;
    char *repaired = wh_utf8_repaired("a\xff\xc3µ\xed\xa0\x80");
    assert_string_equal(repaired, "a\xef\xbf\xbd\xef\xbf\xbdµ\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
    free(repaired);
}

static void control_characters_become_visible(void **state) {
    char text[40];
    (void)state;
    wh_utf8_visible(text, sizeof text, "a\x1b[31mµ\n\x7f");
    assert_string_equal(text, "a\\x1B[31mµ\\x0A\\x7F");
    wh_utf8_visible(text, sizeof text, "\xc2\x9b|\x9b|\xc3\x9b|\xc2\xa0|\xff");
    assert_string_equal(text, "\\xC2\\x9B|\\x9B|\xc3\x9b|\xc2\xa0|\xff");
    wh_utf8_visible(text, 8, "aµ→𝄞");
    assert_string_equal(text, "aµ...");
    wh_utf8_visible(text, 8, "abcd\x1b");
    assert_string_equal(text, "abcd...");
    for (size_t size = 4; size < 12; ++size) {
        wh_utf8_visible(text, size, "\x1b\x1b\x1b");
        assert_true(strlen(text) < size && strspn(text, "\\x1B.") == strlen(text));
    }
}

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
        cmocka_unit_test(a_character_is_what_jansson_takes_for_one),
        cmocka_unit_test(cuts_are_between_characters),
        cmocka_unit_test(what_is_no_character_is_replaced),
        cmocka_unit_test(control_characters_become_visible),
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
