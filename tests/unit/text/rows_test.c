/* Rows of a text file: separators, quotes, comments, line ends. */
#include "text/rows.h"

#include <unistd.h>

#include "support/support.h"

static const wh_rows_form_t form = {.finds_tabs = true, .has_comments = true, .most_bytes = 1000};

/* Opens a file with this text, which is gone behind it. */
static bool open_text(wh_rows_t *rows, const wh_rows_form_t *how, const char *text) {
    char path[WH_TEST_PATH];
    const int file = mkstemp(wh_test_path(path, "rows"));
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), strlen(text));
    (void)close(file);
    const bool opened = wh_rows_open(rows, path, how);
    (void)unlink(path);
    rows->path = "rows";
    return opened;
}

static void expect_row(wh_rows_t *rows, size_t line, const char *joined) {
    char text[200] = "";
    assert_true(wh_rows_read(rows));
    for (size_t i = 0; i < rows->count; ++i) {
        (void)snprintf(text + strlen(text), sizeof text - strlen(text), "[%s]", rows->fields[i]);
    }
    assert_string_equal(text, joined);
    assert_int_equal(rows->line, line);
}

static void commas_quotes_and_comments(void **unused) {
    (void)unused;
    wh_rows_t rows = {.path = NULL};
    assert_true(open_text(&rows, &form, "\xef\xbb\xbf# first\r\n\r\n a , \"b,\"\"c\"\r\n#\n,\n\"#d\",e"));
    expect_row(&rows, 3, "[a][b,\"c]");
    expect_row(&rows, 5, "[][]");
    expect_row(&rows, 6, "[#d][e]");
    assert_false(wh_rows_read(&rows));
    assert_string_equal(rows.message, "");
    assert_false(rows.ends_whole);
    wh_rows_close(&rows);
}

static void tabs_where_the_first_row_has_no_comma(void **unused) {
    (void)unused;
    wh_rows_t rows = {.path = NULL};
    assert_true(open_text(&rows, &form, "# a,b\na\tb\n\tc,d\n"));
    expect_row(&rows, 2, "[a][b]");
    expect_row(&rows, 3, "[][c,d]");
    assert_true(rows.ends_whole);
    wh_rows_close(&rows);
    assert_true(open_text(&rows, &form, "a\tx,b\n"));
    expect_row(&rows, 1, "[a\tx][b]");
    wh_rows_close(&rows);
}

static void what_is_refused_is_told(void **unused) {
    (void)unused;
    const wh_rows_form_t few = {.separator = ';', .most_bytes = 5};
    wh_rows_t rows = {.path = NULL};
    assert_true(open_text(&rows, &few, "\"a\n"));
    assert_false(wh_rows_read(&rows));
    assert_string_equal(rows.message, "rows:1: a quote is not closed (expected a \" on this line)");
    assert_false(wh_rows_read(&rows));
    wh_rows_close(&rows);
    assert_true(open_text(&rows, &few, "\"a\"b"));
    assert_false(wh_rows_read(&rows));
    assert_string_equal(rows.message,
                        "rows:1: something stands behind a quote (expected a ; or the line's end)");
    wh_rows_close(&rows);
    assert_false(open_text(&rows, &few, "a;b;c;"));
    assert_non_null(strstr(rows.message, ": it has more than 5 bytes"));
    wh_rows_close(&rows);
}

static void numbers_and_names(void **unused) {
    (void)unused;
    static const char *const bad[] = {"",   "nan", "1x", "0x1", "1,5", "inf",
                                      "-1", "11",  " 1", "1 ",  "--1", "."};
    double value = 7;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        assert_false(wh_rows_number(bad[i], 0, 10, &value));
        assert_true(value > 6.9 && value < 7.1);
    }
    assert_true(wh_rows_number("+2.5e0", 0, 10, &value));
    assert_true(value > 2.49 && value < 2.51);
    assert_true(wh_rows_is_name("W\xc3\xa4", 3));
    assert_false(wh_rows_is_name("", 3));
    assert_false(wh_rows_is_name("abcd", 3));
    assert_false(wh_rows_is_name("a\x1b", 3));
    assert_false(wh_rows_is_name("a\xff", 3));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commas_quotes_and_comments), cmocka_unit_test(tabs_where_the_first_row_has_no_comma),
        cmocka_unit_test(what_is_refused_is_told), cmocka_unit_test(numbers_and_names)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
