/* Logs with missing parts: each gap is reported, and nothing is read from beside the lists. */
#include "log/log_run.h"

#include <unistd.h>

#include "support/support.h"
#include "wire/messages.h"

static wh_log_run_t run;
static char path[WH_TEST_PATH];

static int set_up(void **state) {
    (void)state;
    const int file = mkstemp(wh_test_path(path, "log_run"));
    return file >= 0 ? close(file) : -1;
}

static int tear_down(void **state) {
    (void)state;
    return unlink(path);
}

static void put_number(FILE *file, uint64_t value, int bytes) {
    while (bytes-- > 0) {
        fputc((int)(value >> 8 * bytes & 0xFF), file);
    }
}

/* An event of LCM: a mark, number, time, sizes, channel, data. */
static void put_event(FILE *file, uint64_t number, const char *channel, const void *bytes, size_t size) {
    put_number(file, 0xEDA1DA01, 4);
    put_number(file, number, 8);
    put_number(file, 1000 * number, 8);
    put_number(file, strlen(channel), 4);
    put_number(file, size, 4);
    fputs(channel, file);
    fwrite(bytes, 1, size, file);
}

static void expect_nothing(size_t number, const char *reason) {
    const wh_log_run_options_t options = {.path = path, .number = number};
    assert_false(wh_log_run_read(&run, &options));
    if (!strstr(run.message, reason) || strncmp(run.message, path, strlen(path)) != 0) {
        fail_msg("\"%s\" is not in \"%s\"", reason, run.message);
    }
    wh_log_run_close(&run);
}

static void an_empty_file_is_no_log(void **state) {
    (void)state;
    expect_nothing(0, ": no LCM event log (expected one)");
}

static void text_is_no_log(void **state) {
    (void)state;
    FILE *file = fopen(path, "w");
    for (int i = 0; i < 1000; ++i) {
        fputs("GET A 1\n", file);
    }
    assert_int_equal(fclose(file), 0);
    expect_nothing(0, ": no LCM event log (expected one)");
}

static void a_file_that_is_not_there(void **state) {
    (void)state;
    char other[WH_TEST_PATH + 8];
    (void)snprintf(other, sizeof other, "%s.other", path);
    const wh_log_run_options_t options = {.path = other};
    assert_false(wh_log_run_read(&run, &options));
    assert_non_null(strstr(run.message, "(expected an LCM event log)"));
    wh_log_run_close(&run);
}

static void a_log_of_others_has_no_run(void **state) {
    (void)state;
    FILE *file = fopen(path, "w");
    put_event(file, 0, "CAMERA", "12345678", 8);
    put_event(file, 1, WH_CHANNEL_STATE, "no state", 8);
    assert_int_equal(fclose(file), 0);
    expect_nothing(0, ": no slice of a run in it, in 2 events: nothing to show");
    expect_nothing(1, ": no slice of a run in it, in 2 events: nothing to show");
    assert_null(strstr(run.message, "waferhand replay"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(an_empty_file_is_no_log, set_up, tear_down),
        cmocka_unit_test_setup_teardown(text_is_no_log, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_file_that_is_not_there, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_log_of_others_has_no_run, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
