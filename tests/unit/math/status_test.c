/* The catalogue of statuses from the caller's side: each number has its own name and text, and
 * other numbers have none. */
#include "support/support.h"

#include "math/status.h"

static const struct {
    wh_status_t number;
    const char *name, *text;
} rows[] = {
#define WH_STATUS(number, name, text) {WH_STATUS_##name, #name, text},
#include "math/status.def"
#undef WH_STATUS
};
#define ROWS (sizeof rows / sizeof rows[0])

/* Functions of the library return these; the program answers with the others. */
static bool is_of_library(wh_status_t status) {
    return (int)status < 40 || ((int)status >= 70 && (int)status < 80);
}

static void each_number_has_its_name_and_the_librarys_own_have_texts(void **state) {
    (void)state;
    for (size_t i = 0; i < ROWS; ++i) {
        assert_string_equal(wh_status_name(rows[i].number), rows[i].name);
        assert_string_equal(wh_status_text(rows[i].number),
                            is_of_library(rows[i].number) ? rows[i].text : "unknown status");
        for (size_t k = 0; k < i; ++k) {
            assert_int_not_equal(rows[i].number, rows[k].number);
            assert_string_not_equal(rows[i].name, rows[k].name);
        }
    }
    assert_int_equal(WH_OK, 0);
    assert_string_equal(wh_status_name(WH_OK), "OK");
}

static void texts_are_sentences_without_a_stop(void **state) {
    (void)state;
    for (size_t i = 0; i < ROWS; ++i) {
        const size_t length = strlen(rows[i].text);
        assert_true(length > 1 && rows[i].text[length - 1] != '.');
    }
}

static bool is_in_catalogue(int number) {
    bool found = false;
    for (size_t i = 0; i < ROWS; ++i) {
        found = found || (int)rows[i].number == number;
    }
    return found;
}

static void other_numbers_are_unknown(void **state) {
    (void)state;
    for (int number = 0; number < 256; ++number) {
        const bool unknown = strcmp(wh_status_name((wh_status_t)number), "UNKNOWN") == 0;
        assert_int_equal(unknown, !is_in_catalogue(number));
        const bool silent = strcmp(wh_status_text((wh_status_t)number), "unknown status") == 0;
        assert_int_equal(silent, unknown || !is_of_library((wh_status_t)number));
    }
    /* If the compiler gives an enumeration no more bytes than it needs, some of these become other
     * numbers. */
    static const int none[] = {-1, 9999, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < 4; ++i) {
        const wh_status_t status = (wh_status_t)none[i];
        const bool unknown = !is_in_catalogue((int)status);
        assert_int_equal(unknown, strcmp(wh_status_name(status), "UNKNOWN") == 0);
        assert_int_equal(unknown || !is_of_library(status),
                         strcmp(wh_status_text(status), "unknown status") == 0);
    }
}

static void the_library_tells_the_version_of_its_headers(void **state) {
    (void)state;
    char numbers[32];
    (void)snprintf(numbers, sizeof numbers, "%d.%d.%d", WH_VERSION_MAJOR, WH_VERSION_MINOR, WH_VERSION_PATCH);
    assert_string_equal(wh_version(), WH_VERSION);
    assert_string_equal(wh_version(), numbers);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_number_has_its_name_and_the_librarys_own_have_texts),
        cmocka_unit_test(texts_are_sentences_without_a_stop),
        cmocka_unit_test(other_numbers_are_unknown),
        cmocka_unit_test(the_library_tells_the_version_of_its_headers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
