/* The reader of outputs.txt: every finding, every change of it, and how many reports that makes. */
#include <poll.h>
#include <sys/resource.h>

#include "link/outputs.h"
#include "support/outputs.h"
#include "support/support.h"

#define SETTLE WH_OUTPUTS_SETTLE_US
#define SECOND 1000000

static void wrong_arguments_are_refused(void **state) {
    (void)state;
    static wh_outputs_t reader, before;
    static char path[WH_OUTPUTS_PATH + 2];
    const int32_t good[WH_GRIPPERS] = {0}, bad[2] = {0, 2};
    memset(&reader, 0x55, sizeof reader);
    before = reader;
    memset(path, 'p', WH_OUTPUTS_PATH);
    assert_int_equal(wh_outputs_open(NULL, "a", good, 1), EINVAL);
    assert_int_equal(wh_outputs_open(&reader, NULL, good, 1), EINVAL);
    assert_int_equal(wh_outputs_open(&reader, "a", NULL, 1), EINVAL);
    assert_int_equal(wh_outputs_open(&reader, "a", good, 0), EINVAL);
    assert_int_equal(wh_outputs_open(&reader, "a", good, WH_GRIPPERS + 1), EINVAL);
    assert_int_equal(wh_outputs_open(&reader, "a", bad, 2), EINVAL);
    assert_int_equal(wh_outputs_open(&reader, "", good, 1), EINVAL);
    assert_int_equal(wh_outputs_open(&reader, "a/", good, 1), EINVAL);
    assert_int_equal(wh_outputs_open(&reader, path, good, 1), ENAMETOOLONG);
    assert_memory_equal(&reader, &before, sizeof reader);
    assert_int_equal(wh_outputs_open(&reader, "a", good, 1), 0); /* whatever its memory held */
    assert_int_equal(reader.finding, WH_OUTPUTS_GOOD);
    assert_int_equal(reader.counters.spells + reader.counters.looks[0] + reader.suspect, 0);
    wh_outputs_close(&reader);
    assert_int_equal(reader.fd, -1);
    wh_outputs_close(&reader);
}

static void a_good_file_is_taken_at_once_and_says_nothing(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    outputs_put(f.path, "1\n0\n");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    outputs_assert_valves(&f, "10");
    outputs_put(f.path, "1 0");
    assert_int_equal(outputs_pass(&f, 10 * SECOND), 0);
    assert_string_equal(f.reader.report, "");
    assert_int_equal(f.reader.counters.switches, 2);
    outputs_teardown(&f);
}

/* Each bad content, put there by rename, and the report that it makes. */
static void each_bad_content_is_reported_once(void **state) {
    (void)state;
    static const struct {
        const char *text, *found;
        wh_outputs_finding_t finding;
    } cases[] = {
        {"", "empty", WH_OUTPUTS_EMPTY},
        {" \n\t\r\n", "empty", WH_OUTPUTS_EMPTY},
        {"1\n", "1 value", WH_OUTPUTS_SHORT},
        {"1 1 1", "3 values", WH_OUTPUTS_LONG},
        {"1 1\n1 1 0 0 1 1 1 1 1 1", "12 values", WH_OUTPUTS_LONG},
        {"0 x", "value 2 is \"x\"", WH_OUTPUTS_GARBLED},
        {"01", "value 1 is \"01\"", WH_OUTPUTS_GARBLED},
        {"1 1 1 2", "value 4 is \"2\"", WH_OUTPUTS_GARBLED},
        {"1,1", "value 1 is \"1,1\"", WH_OUTPUTS_GARBLED},
        {"0 \x01\xff", "value 2 is \"?\?\"", WH_OUTPUTS_GARBLED},
        {"a-long-word-without-an-end", "value 1 is \"a-long-word-wit\"", WH_OUTPUTS_GARBLED},
    };
    outputs_fixture_t f;
    outputs_begin(&f);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char report[512];
        outputs_put(outputs_path(&f, "new"), cases[i].text);
        assert_int_equal(rename(outputs_path(&f, "new"), f.path), 0);
        assert_int_equal(outputs_pass(&f, SETTLE - 1), 0);
        f.now_us += 1;
        assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED);
        assert_int_equal(f.reader.finding, cases[i].finding);
        snprintf(report, sizeof report, "%s: %s (expected 2 values, each 0 or 1); the valves stay 0 1",
                 f.path, cases[i].found);
        assert_string_equal(f.reader.report, report);
        assert_int_equal(outputs_pass(&f, 10 * SECOND), 0);
        outputs_assert_valves(&f, "01");
        outputs_put(f.path, "0 1\n");
        assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED);
        snprintf(report, sizeof report, "%s: good again, the valves are 0 1", f.path);
        assert_string_equal(f.reader.report, report);
    }
    assert_int_equal(f.reader.counters.recoveries, sizeof cases / sizeof cases[0]);
    outputs_teardown(&f);
}

static void too_many_bytes_are_not_looked_into(void **state) {
    (void)state;
    static char text[WH_OUTPUTS_BYTES + 1];
    outputs_fixture_t f;
    outputs_begin(&f);
    memset(text, '\n', sizeof text);
    text[0] = '1';
    text[WH_OUTPUTS_BYTES - 1] = '1';
    outputs_put_bytes(f.path, text, WH_OUTPUTS_BYTES);
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    outputs_put_bytes(f.path, text, WH_OUTPUTS_BYTES + 1);
    assert_int_equal(outputs_pass(&f, SETTLE), WH_OUTPUTS_REPORTED);
    assert_int_equal(f.reader.finding, WH_OUTPUTS_LONG);
    assert_non_null(strstr(f.reader.report, ": more than 4096 bytes (expected"));
    outputs_teardown(&f);
}

static void a_missing_file_is_reported_and_found_when_it_comes(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    outputs_open(&f, f.path, "101");
    assert_int_equal(outputs_pass(&f, SETTLE), WH_OUTPUTS_REPORTED);
    assert_int_equal(f.reader.finding, WH_OUTPUTS_MISSING);
    assert_non_null(
        strstr(f.reader.report, ": missing (expected 3 values, each 0 or 1); the valves stay 1 0 1"));
    assert_int_equal(outputs_pass(&f, 10 * SECOND), 0);
    outputs_put(f.path, "1 1 1");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED | WH_OUTPUTS_SWITCHED);
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(outputs_pass(&f, SETTLE), WH_OUTPUTS_REPORTED);
    outputs_assert_valves(&f, "111");
    outputs_teardown(&f);
}

/* Each of them instead of the file, at once or by rename; none is opened. */
static void what_is_no_file_is_reported(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(mkdir(f.path, 0777), 0);
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_REPORTED);
    assert_int_equal(f.reader.finding, WH_OUTPUTS_NO_FILE);
    assert_non_null(strstr(f.reader.report, ": a directory (expected 2 values"));
    assert_int_equal(rmdir(f.path), 0);
    assert_int_equal(mkfifo(f.path, 0666), 0);
    assert_int_equal(outputs_pass(&f, SECOND), 0); /* still the same finding */
    assert_int_equal(unlink(f.path), 0);
    outputs_put(f.path, "0 0");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED | WH_OUTPUTS_SWITCHED);
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(mkfifo(f.path, 0666), 0);
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_REPORTED);
    assert_non_null(strstr(f.reader.report, ": not a regular file (expected"));
    assert_int_equal(open(f.path, O_WRONLY | O_NONBLOCK), -1); /* nobody has it open for reading */
    assert_int_equal(errno, ENXIO);
    outputs_teardown(&f);
}

static void an_unreadable_file_is_reported_with_the_reason(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(symlink("outputs.txt", f.path), 0);
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_REPORTED);
    assert_int_equal(f.reader.finding, WH_OUTPUTS_UNREADABLE);
    assert_non_null(
        strstr(f.reader.report, ": cannot be read: Too many levels of symbolic links (expected 2"));
    assert_int_equal(unlink(f.path), 0);
    outputs_put(f.path, "0 1");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED);
    if (geteuid() != 0) { /* root reads everything */
        assert_int_equal(chmod(f.path, 0), 0);
        assert_int_equal(outputs_pass(&f, SETTLE), WH_OUTPUTS_REPORTED);
        assert_int_equal(chmod(f.path, 0644), 0);
        assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED);
    }
    outputs_teardown(&f);
}

/* Nothing about the file changes, and yet it cannot be opened for a while; nothing is left open by it all. */
static void running_out_of_descriptors_is_survived(void **state) {
    (void)state;
    outputs_fixture_t f;
    struct rlimit limit, none;
    outputs_begin(&f);
    const int next = dup(0);
    assert_int_equal(close(next), 0);
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
    none = limit;
    none.rlim_cur = 0;
    assert_int_equal(outputs_pass(&f, SECOND), 0);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &none), 0);
    f.now_us += SECOND;
    const unsigned at_once = outputs_update(&f), later = outputs_pass(&f, SETTLE);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
    assert_int_equal(at_once, 0);
    assert_int_equal(later, WH_OUTPUTS_REPORTED);
    assert_non_null(strstr(f.reader.report, ": cannot be read: Too many open files (expected"));
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_REPORTED);
    assert_int_equal(dup(0), next);
    assert_int_equal(close(next), 0);
    outputs_teardown(&f);
}

static void a_torn_read_is_counted_not_reported(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    for (int i = 1; i <= 100; ++i) {
        outputs_put(f.path, i % 2 ? "" : "1");
        assert_int_equal(outputs_pass(&f, SETTLE - 1), 0);
        outputs_put(f.path, i % 2 ? "1 0" : "0 1");
        assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
        assert_int_equal(f.reader.counters.torn, i);
    }
    assert_int_equal(f.reader.counters.reports, 0);
    outputs_teardown(&f);
}

/* A slow reader that finds the file torn each time is not looking at one bad state. */
static void a_change_starts_the_settle_time_anew(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    for (int i = 0; i < 10; ++i) {
        outputs_put(f.path, "0 1");
        outputs_put(f.path, "");
        assert_int_equal(outputs_update(&f), 0);
        f.now_us += 5 * SETTLE;
    }
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED);
    outputs_teardown(&f);
}

static void a_file_that_never_rests_is_reported_after_64_bad_looks(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    for (int i = 0; i < 63; ++i) {
        outputs_put(f.path, "garbage");
        assert_int_equal(outputs_update(&f), 0);
        f.now_us += SETTLE / 2;
    }
    outputs_put(f.path, "garbage");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED);
    outputs_teardown(&f);
}

/* ... but never before the settle time, however often it is looked at. */
static void many_looks_are_no_substitute_for_time(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    for (int i = 0; i < 1000; ++i) {
        outputs_put(f.path, "1");
        assert_int_equal(outputs_update(&f), 0);
    }
    outputs_put(f.path, "1 1");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    assert_int_equal(f.reader.counters.torn, 1);
    outputs_teardown(&f);
}

static void from_one_bad_finding_to_another_is_one_report_each(void **state) {
    (void)state;
    static const char *const texts[] = {"", "1", "1 1 1", "x"};
    outputs_fixture_t f;
    outputs_begin(&f);
    for (unsigned i = 0; i < 20; ++i) {
        outputs_put(f.path, texts[i % 4]);
        assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_REPORTED);
        assert_int_equal(f.reports, i + 1);
    }
    outputs_put(f.path, "");                           /* another bad state, ... */
    assert_int_equal(outputs_pass(&f, SETTLE / 2), 0); /* ... not for long, ... */
    outputs_put(f.path, "x");                          /* ... and back */
    assert_int_equal(outputs_pass(&f, SECOND), 0);
    assert_int_equal(f.reader.counters.torn, 1);
    outputs_put(f.path, "0 1");
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_REPORTED);
    assert_int_equal(f.reports, 21);
    outputs_teardown(&f);
}

/* Without an event and before the time nothing is looked at, whatever happens beside the file. */
static void neighbours_make_no_looks(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    assert_int_equal(outputs_looks(&f.reader), 1);
    assert_int_equal(f.reader.due_us, f.now_us + WH_OUTPUTS_CHECK_US);
    for (int i = 0; i < 100; ++i) {
        outputs_put(outputs_path(&f, "outputs.txt.bak"), "1 1");
        assert_int_equal(outputs_update(&f), 0);
    }
    assert_int_equal(outputs_looks(&f.reader), 1);
    outputs_teardown(&f);
}

/* What is changed beyond the folder is found by looking every poll_us. */
static void a_symbolic_link_is_followed(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    assert_int_equal(mkdir(outputs_path(&f, "there"), 0777), 0);
    outputs_put(outputs_path(&f, "there/real"), "0 1");
    assert_int_equal(symlink("there/real", f.path), 0);
    outputs_open(&f, f.path, "11");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    outputs_put(outputs_path(&f, "there/real"), "1 0");
    assert_int_equal(outputs_pass(&f, WH_OUTPUTS_POLL_US), WH_OUTPUTS_SWITCHED);
    outputs_put(outputs_path(&f, "there/real"), "");
    assert_int_equal(outputs_pass(&f, WH_OUTPUTS_POLL_US + SETTLE), WH_OUTPUTS_REPORTED);
    outputs_teardown(&f);
}

static void a_hard_link_elsewhere_is_noticed_within_a_second(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_begin(&f);
    assert_int_equal(mkdir(outputs_path(&f, "there"), 0777), 0);
    assert_int_equal(link(f.path, outputs_path(&f, "there/other")), 0);
    assert_int_equal(outputs_update(&f), 0);
    outputs_put(outputs_path(&f, "there/other"), "1 1");
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_SWITCHED);
    outputs_teardown(&f);
}

static void a_folder_may_come_go_and_be_exchanged(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    char path[256];
    snprintf(path, sizeof path, "%s", outputs_path(&f, "in/outputs.txt"));
    outputs_open(&f, path, "11");
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_REPORTED);
    assert_int_equal(f.reader.finding, WH_OUTPUTS_MISSING);
    assert_int_equal(mkdir(outputs_path(&f, "in"), 0777), 0);
    outputs_put(path, "0 1");
    assert_int_equal(outputs_pass(&f, WH_OUTPUTS_POLL_US), WH_OUTPUTS_SWITCHED | WH_OUTPUTS_REPORTED);
    outputs_put(path, "1 0"); /* from here on without delay */
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    assert_int_equal(rename(outputs_path(&f, "in"), outputs_path(&f, "out")), 0);
    assert_int_equal(outputs_pass(&f, WH_OUTPUTS_POLL_US), WH_OUTPUTS_REPORTED);
    assert_int_equal(f.reader.finding, WH_OUTPUTS_MISSING);
    outputs_put(outputs_path(&f, "out/outputs.txt"), "0 0"); /* no longer ours */
    assert_int_equal(outputs_pass(&f, SECOND), 0);
    assert_int_equal(rename(outputs_path(&f, "out"), outputs_path(&f, "in")), 0);
    assert_int_equal(outputs_pass(&f, WH_OUTPUTS_POLL_US), WH_OUTPUTS_SWITCHED | WH_OUTPUTS_REPORTED);
    outputs_put(path, "1 1");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    outputs_teardown(&f);
}

/* No event tells of it: the watched folder itself stays what it was. */
static void a_folder_exchanged_further_up_is_noticed_within_a_second(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(mkdir(outputs_path(&f, i ? "b" : "a"), 0777), 0);
        assert_int_equal(mkdir(outputs_path(&f, i ? "b/in" : "a/in"), 0777), 0);
        outputs_put(outputs_path(&f, i ? "b/in/o" : "a/in/o"), i ? "1 1" : "0 1");
    }
    outputs_open(&f, outputs_path(&f, "a/in/o"), "00");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    assert_int_equal(rename(outputs_path(&f, "a"), outputs_path(&f, "c")), 0);
    assert_int_equal(rename(outputs_path(&f, "b"), outputs_path(&f, "a")), 0);
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_SWITCHED);
    outputs_put(outputs_path(&f, "a/in/o"), "1 0");
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    outputs_teardown(&f);
}

/* As many descriptors as are open now, so that there is none for inotify. */
static void without_inotify_the_reader_polls(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    outputs_put(f.path, "0 1");
    struct rlimit limit, none;
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
    none = limit;
    none.rlim_cur = 0;
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &none), 0);
    outputs_open(&f, f.path, "11");
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
    assert_int_equal(f.reader.fd, -1);
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    for (int i = 0; i < 10; ++i) {
        outputs_put(f.path, i % 2 ? "0 1" : "1 0");
        assert_int_equal(outputs_pass(&f, WH_OUTPUTS_POLL_US), WH_OUTPUTS_SWITCHED);
    }
    assert_int_equal(outputs_looks(&f.reader), 11);
    outputs_teardown(&f);
}

/* On proc, say, inotify tells nothing. */
static void on_other_file_systems_the_reader_polls(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    outputs_open(&f, "/proc/self/outputs.txt", "1");
    assert_int_equal(outputs_update(&f), 0);
    f.now_us += SETTLE;
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_REPORTED);
    assert_int_equal(f.reader.due_us, f.now_us + WH_OUTPUTS_POLL_US);
    outputs_teardown(&f);
}

/* More events than the kernel keeps, and the file's own among the lost ones. Each update takes only some. */
static void lost_events_lose_nothing(void **state) {
    (void)state;
    outputs_fixture_t f;
    unsigned result = 0, updates = 0;
    outputs_begin(&f);
    for (int i = 0; i < 20000; ++i) {
        outputs_put(outputs_path(&f, i % 2 ? "a" : "b"), "");
    }
    outputs_put(f.path, "1 0");
    struct pollfd waiting = {.fd = f.reader.fd, .events = POLLIN};
    for (; poll(&waiting, 1, 0) == 1; ++updates) {
        result |= outputs_update(&f);
    }
    assert_int_equal(result, WH_OUTPUTS_SWITCHED);
    assert_true(updates > 1 && outputs_looks(&f.reader) == 2);
    outputs_teardown(&f);
}

static void a_report_is_one_bounded_line_whatever_the_path(void **state) {
    (void)state;
    outputs_fixture_t f;
    char path[1024], name[200];
    outputs_setup(&f);
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    snprintf(path, sizeof path, "%s/%s/%s/evil\nname\x7f", f.folder, name, name);
    outputs_open(&f, path, "11111111");
    assert_int_equal(outputs_pass(&f, SECOND), WH_OUTPUTS_REPORTED);
    assert_memory_equal(f.reader.report, "...nnn", 6);
    assert_non_null(strstr(f.reader.report,
                           "nn/evil?name?: missing (expected 8 values, each 0 or 1); the valves "
                           "stay 1 1 1 1 1 1 1 1"));
    assert_null(strchr(f.reader.report, '\n'));
    outputs_teardown(&f);
}

/* A path without a folder is the working directory's. */
static void a_bare_name_works(void **state) {
    (void)state;
    outputs_fixture_t f;
    char before[4096];
    assert_non_null(getcwd(before, sizeof before));
    outputs_setup(&f);
    assert_int_equal(chdir(f.folder), 0);
    outputs_open(&f, "outputs.txt", "1");
    assert_int_equal(outputs_update(&f), 0);
    assert_int_equal(wh_outputs_write("outputs.txt", (const int32_t[]){0}, 1), 0);
    assert_int_equal(outputs_update(&f), WH_OUTPUTS_SWITCHED);
    assert_int_equal(outputs_files(&f), 1);
    assert_int_equal(chdir(before), 0);
    outputs_teardown(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(a_good_file_is_taken_at_once_and_says_nothing),
        cmocka_unit_test(each_bad_content_is_reported_once),
        cmocka_unit_test(too_many_bytes_are_not_looked_into),
        cmocka_unit_test(a_missing_file_is_reported_and_found_when_it_comes),
        cmocka_unit_test(what_is_no_file_is_reported),
        cmocka_unit_test(an_unreadable_file_is_reported_with_the_reason),
        cmocka_unit_test(running_out_of_descriptors_is_survived),
        cmocka_unit_test(a_torn_read_is_counted_not_reported),
        cmocka_unit_test(a_change_starts_the_settle_time_anew),
        cmocka_unit_test(a_file_that_never_rests_is_reported_after_64_bad_looks),
        cmocka_unit_test(many_looks_are_no_substitute_for_time),
        cmocka_unit_test(from_one_bad_finding_to_another_is_one_report_each),
        cmocka_unit_test(neighbours_make_no_looks),
        cmocka_unit_test(a_symbolic_link_is_followed),
        cmocka_unit_test(a_hard_link_elsewhere_is_noticed_within_a_second),
        cmocka_unit_test(a_folder_may_come_go_and_be_exchanged),
        cmocka_unit_test(a_folder_exchanged_further_up_is_noticed_within_a_second),
        cmocka_unit_test(without_inotify_the_reader_polls),
        cmocka_unit_test(on_other_file_systems_the_reader_polls),
        cmocka_unit_test(lost_events_lose_nothing),
        cmocka_unit_test(a_report_is_one_bounded_line_whatever_the_path),
        cmocka_unit_test(a_bare_name_works),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
