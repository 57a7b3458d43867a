/* The bytes that form characters, compared with jansson's own check, and the places at which a text
 * is cut; when there is colour, and how text is made fit to print. */
#include <fcntl.h>
#include <jansson.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "support/support.h"
#include "text/style.h"
#include "text/utf8.h"

/* Every text of up to three bytes, and those of four that begin with a lead byte for four and have
 * a last byte at an edge. */
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
    memset(clipped, 'x', sizeof clipped);
    wh_utf8_clip(clipped, sizeof clipped, "aµ");
    assert_string_equal(clipped, "aµ");
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

/* A terminal of 72 columns. Null if the system gives none. */
static FILE *open_terminal(int *leader) {
    const struct winsize size = {.ws_row = 24, .ws_col = 72};
    *leader = posix_openpt(O_RDWR | O_NOCTTY);
    if (*leader < 0 || grantpt(*leader) != 0 || unlockpt(*leader) != 0) {
        return NULL;
    }
    const int follower = open(ptsname(*leader), O_RDWR | O_NOCTTY);
    return follower >= 0 && ioctl(follower, TIOCSWINSZ, &size) == 0 ? fdopen(follower, "r+") : NULL;
}

static void expect_colour(FILE *terminal, const char *ranks, const char *forced, bool wanted) {
    unsetenv("OMPI_COMM_WORLD_SIZE");
    unsetenv("CLICOLOR_FORCE");
    if (ranks) {
        setenv("OMPI_COMM_WORLD_SIZE", ranks, 1);
    }
    if (forced) {
        setenv("CLICOLOR_FORCE", forced, 1);
    }
    const wh_style_t style = wh_style_of(terminal);
    assert_int_equal(style.colour, wanted);
    assert_int_equal(style.width, ranks && !wanted ? 0 : 72);
}

/* mpirun gives the first rank a terminal that nobody sees: there a user has to ask for colours. */
static void a_terminal_under_mpirun(void **state) {
    (void)state;
    int leader = -1;
    FILE *terminal = open_terminal(&leader);
    assert_non_null(terminal);
    unsetenv("NO_COLOR");
    setenv("TERM", "xterm", 1);
    expect_colour(terminal, NULL, NULL, true);
    expect_colour(terminal, "4", NULL, false);
    expect_colour(terminal, "4", "", false);
    expect_colour(terminal, "4", "0", false);
    expect_colour(terminal, "4", "1", true);
    expect_colour(terminal, "4", "00", true);
    unsetenv("OMPI_COMM_WORLD_SIZE");
    unsetenv("CLICOLOR_FORCE");
    setenv("NO_COLOR", "1", 1);
    assert_false(wh_style_of(terminal).colour);
    unsetenv("NO_COLOR");
    assert_int_equal(fclose(terminal), 0);
    close(leader);
}

static void inks_and_glyphs(void **state) {
    (void)state;
    static const char *const sequences[] = {"plain",    "\033[32m", "\033[31m",
                                            "\033[33m", "\033[2m",  "\033[1m"};
    static const char *const glyphs[][2] = {{"ok", "✓"}, {"x", "✗"}, {"->", "→"}, {" deg", "°"}};
    static const wh_ink_t inks[] = {WH_INK_PLAIN, WH_INK_GOOD, WH_INK_BAD,
                                    WH_INK_WARN,  WH_INK_DIM,  WH_INK_BOLD};
    static const wh_glyph_t kinds[] = {WH_GLYPH_TICK, WH_GLYPH_CROSS, WH_GLYPH_ARROW, WH_GLYPH_DEGREE};
    for (int on = 0; on < 2; ++on) {
        const wh_style_t style = {on == 1, on == 1, 0};
        for (size_t i = 0; i < sizeof inks / sizeof inks[0]; ++i) {
            char wanted[40], *text = NULL;
            size_t size = 0;
            const bool has_ink = on == 1 && i > 0;
            FILE *out = open_memstream(&text, &size);
            wh_style_print(&style, out, inks[i], "%d %s", 7, "µm");
            fclose(out);
            snprintf(wanted, sizeof wanted, "%s7 µm%s", has_ink ? sequences[i] : "",
                     has_ink ? "\033[0m" : "");
            assert_string_equal(text, wanted);
            free(text);
        }
        for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
            assert_string_equal(wh_style_glyph(&style, kinds[i]), glyphs[i][on]);
        }
    }
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
        cmocka_unit_test(a_terminal_under_mpirun),
        cmocka_unit_test(inks_and_glyphs),
        cmocka_unit_test(text_is_made_printable),
        cmocka_unit_test(plain_locale),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
