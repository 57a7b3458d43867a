/* The reader of outputs.txt: every finding, every change of it, and the number of reports that it makes. */
#include "support/support.h"

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "link/outputs.h"
#include "support/outputs.h"

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

/* Each of them replaces the file, at once or by rename; none is opened. */
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

/* The file does not change, and yet it cannot be opened for a while; afterwards nothing is left open. */
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

/* If a slow reader finds the file torn each time, it does not see one bad state. */
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

/* ... but never before the settle time, however often it looks. */
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

/* Without an event and before the time the reader does not look, whatever happens beside the file. */
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

/* A change beyond the folder is found by looking every poll_us. */
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

/* No event reports it: the watched folder itself stays unchanged. */
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

/* Uses up the descriptors, so that there is none for inotify. */
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

/* On proc, for example, inotify reports nothing. */
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

/* There are more events than the kernel keeps, and the file's own are among the lost ones. Each
 * update takes only some. */
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

/* A path without a folder is in the working directory. */
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

/* ---------------------------------------------------------------------------------------------- the grammar */

/* The grammar of outputs.txt compared with a second reading of it, and the whole reader with random
 * contents. */

#define ROUNDS 10000

static wh_outputs_look_t parse(const char *text, size_t count, int32_t *valves) {
    return wh_outputs_parse(text, strlen(text), count, valves);
}

static void assert_good(const char *text, const char *valves) {
    int32_t values[WH_GRIPPERS];
    assert_int_equal(parse(text, strlen(valves), values).finding, WH_OUTPUTS_GOOD);
    for (size_t i = 0; valves[i] != '\0'; ++i) {
        assert_int_equal(values[i], valves[i] - '0');
    }
}

static void good_files(void **state) {
    (void)state;
    assert_good("0", "0");
    assert_good("1\n", "1");
    assert_good("0 1", "01");
    assert_good("0\n1\n", "01");
    assert_good("\r\n\t 1 \t\r\n0\r\n\r\n", "10");
    assert_good("0 1 1 0 1 0 0 1\n", "01101001");
}

static void assert_bad(const char *text, size_t count, wh_outputs_finding_t finding, size_t found) {
    int32_t values[WH_GRIPPERS];
    for (size_t i = 0; i < WH_GRIPPERS; ++i) {
        values[i] = 7;
    }
    const wh_outputs_look_t look = parse(text, count, values);
    assert_int_equal(look.finding, finding);
    assert_int_equal(look.found, found);
    for (size_t i = 0; i < WH_GRIPPERS; ++i) {
        assert_int_equal(values[i], 7);
    }
}

static void bad_files(void **state) {
    (void)state;
    static const char *const words[] = {
        "2",  "00",  "10", "-0", "+1", "0.", "0x0", "true", "O", "0,", "0;", "\"0\"", "\357\273\2770",
        "\v", "0\f", "#",  "1e0"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        char text[64];
        assert_bad(words[i], 1, WH_OUTPUTS_GARBLED, 0);
        snprintf(text, sizeof text, "0 1\n%s 1", words[i]);
        assert_bad(text, 2, WH_OUTPUTS_GARBLED, 2);
        assert_bad(text, 3, WH_OUTPUTS_GARBLED, 2);
        assert_bad(text, 8, WH_OUTPUTS_GARBLED, 2);
    }
    assert_bad("", 1, WH_OUTPUTS_EMPTY, 0);
    assert_bad("\n\n", 1, WH_OUTPUTS_EMPTY, 0);
    assert_bad("0", 2, WH_OUTPUTS_SHORT, 1);
    assert_bad("0 0 0 0 0 0 0", 8, WH_OUTPUTS_SHORT, 7);
    assert_bad("0 0", 1, WH_OUTPUTS_LONG, 2);
    assert_bad("0 0 0 0 0 0 0 0 0", 8, WH_OUTPUTS_LONG, 9);
    assert_bad("0 1", 0, WH_OUTPUTS_GARBLED, 0);
    assert_bad("0 1 0 1 0 1 0 1 0", WH_GRIPPERS + 1, WH_OUTPUTS_GARBLED, 0);
}

static void a_zero_byte_is_no_end(void **state) {
    (void)state;
    int32_t values[2] = {7, 7};
    assert_int_equal(wh_outputs_parse("0 1\0", 4, 2, values).finding, WH_OUTPUTS_GARBLED);
    assert_int_equal(wh_outputs_parse("0\0001", 3, 2, values).finding, WH_OUTPUTS_GARBLED);
    assert_int_equal(values[0], 7);
}

/* Why a missing line feed is no sign of a torn read. */
static void the_beginning_of_a_good_file_says_the_same_or_is_short(void **state) {
    (void)state;
    static const char text[] = " 1\r\n0\t\n1 \n\n";
    for (size_t size = 0; size < sizeof text; ++size) {
        int32_t values[3];
        const wh_outputs_finding_t finding = wh_outputs_parse(text, size, 3, values).finding;
        if (finding == WH_OUTPUTS_GOOD) {
            assert_true(values[0] == 1 && values[1] == 0 && values[2] == 1);
        } else {
            assert_true(finding == WH_OUTPUTS_EMPTY || finding == WH_OUTPUTS_SHORT);
        }
    }
}

/* The grammar once more, by strtok: the text has no zero byte. */
static bool is_good_by_strtok(const char *text, size_t count, int32_t *values) {
    char copy[WH_OUTPUTS_BYTES + 1];
    size_t found = 0;
    snprintf(copy, sizeof copy, "%s", text);
    for (const char *word = strtok(copy, " \t\r\n"); word != NULL; word = strtok(NULL, " \t\r\n")) {
        if ((strcmp(word, "0") != 0 && strcmp(word, "1") != 0) || found == count) {
            return false;
        }
        values[found++] = *word - '0';
    }
    return found == count;
}

/* Random files, nearly valid as often as wild; no zero bytes. */
static size_t random_text(char *text, size_t most) {
    static const char usual[] = "01 \n\t\r01 \n2";
    const bool wild = wh_test_below(4) == 0;
    const size_t size = wh_test_below(wild ? (uint32_t)most : 8);
    for (size_t i = 0; i < size; ++i) {
        const uint32_t chance = wh_test_below(40);
        text[i] = usual[wh_test_below(wild || chance == 0 ? 11 : 10)];
        if (wild && chance < 20) {
            text[i] = (char)(1 + wh_test_below(255));
        }
    }
    text[size] = '\0';
    return size;
}

static void random_files_change_nothing_unless_they_are_good(void **state) {
    (void)state;
    (void)wh_test_seed();
    outputs_fixture_t f;
    outputs_begin(&f);
    int32_t wanted[2] = {0, 1};
    unsigned good = 0;
    for (int i = 0; i < ROUNDS; ++i) {
        char text[WH_OUTPUTS_BYTES];
        int32_t values[2];
        outputs_put_bytes(f.path, text, random_text(text, 300));
        if (is_good_by_strtok(text, 2, values)) {
            memcpy(wanted, values, sizeof wanted);
            ++good;
        }
        f.now_us += wh_test_below(WH_OUTPUTS_SETTLE_US * 2);
        (void)outputs_update(&f);
        assert_memory_equal(f.reader.valves, wanted, sizeof wanted);
    }
    assert_true(good > ROUNDS / 100);
    assert_int_equal(f.reader.counters.looks[WH_OUTPUTS_GOOD], good + 1);
    assert_int_equal(outputs_looks(&f.reader), ROUNDS + 1);
    outputs_teardown(&f);
}

/* Everything that can be at the path, in any order: the finding in force is the one that a person
 * would see. */
static void random_things_at_the_path(void **state) {
    (void)state;
    (void)wh_test_seed();
    outputs_fixture_t f;
    outputs_begin(&f);
    for (int i = 0; i < 2000; ++i) {
        static const char *const texts[] = {"", "1", "1 1 1", "x", "0 1", "1 0"};
        static const wh_outputs_finding_t findings[] = {
            WH_OUTPUTS_EMPTY, WH_OUTPUTS_SHORT,   WH_OUTPUTS_LONG,    WH_OUTPUTS_GARBLED,   WH_OUTPUTS_GOOD,
            WH_OUTPUTS_GOOD,  WH_OUTPUTS_NO_FILE, WH_OUTPUTS_MISSING, WH_OUTPUTS_UNREADABLE};
        const uint32_t what = wh_test_below(9);
        (void)remove(f.path);
        if (what < 6) {
            outputs_put(f.path, texts[what]);
        } else if (what == 6) {
            assert_int_equal(mkdir(f.path, 0777), 0);
        } else if (what == 8) {
            assert_int_equal(symlink("outputs.txt", f.path), 0);
        }
        (void)outputs_pass(&f, WH_OUTPUTS_POLL_US + WH_OUTPUTS_SETTLE_US);
        assert_int_equal(f.reader.finding, findings[what]);
    }
    outputs_teardown(&f);
}

/* ----------------------------------------------------------------------------------------------- the writer */

/* The writer of outputs.txt, and a reader beside writers that never stop. */

#define WRITES 10000

static const int32_t two[2] = {0, 1};

static void assert_file(const char *path, const char *text) {
    char bytes[64] = "";
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    assert_true(fd >= 0);
    assert_true(read(fd, bytes, sizeof bytes - 1) >= 0);
    close(fd);
    assert_string_equal(bytes, text);
}

static mode_t mode_of(const char *path) {
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return status.st_mode & 07777;
}

static void it_writes_a_value_a_line(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
    assert_file(f.path, "0\n1\n");
    assert_int_equal(wh_outputs_write(f.path, (const int32_t[]){1, 1, 0, 1, 0, 0, 0, 1}, 8), 0);
    assert_file(f.path, "1\n1\n0\n1\n0\n0\n0\n1\n");
    assert_int_equal(outputs_files(&f), 1);
    outputs_teardown(&f);
}

static void permissions_are_kept_or_usual(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    const mode_t before = umask(027);
    assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
    assert_int_equal(mode_of(f.path), 0640);
    assert_int_equal(chmod(f.path, 0606), 0);
    assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
    assert_int_equal(mode_of(f.path), 0606);
    (void)umask(before);
    outputs_teardown(&f);
}

static void a_link_stays_a_link(void **state) {
    (void)state;
    outputs_fixture_t f;
    struct stat status;
    outputs_setup(&f);
    assert_int_equal(mkdir(outputs_path(&f, "there"), 0777), 0);
    outputs_put(outputs_path(&f, "there/real"), "1");
    assert_int_equal(symlink("there/real", f.path), 0);
    assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
    assert_int_equal(lstat(f.path, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_file(outputs_path(&f, "there/real"), "0\n1\n");
    outputs_teardown(&f);
}

static void what_is_refused_leaves_nothing_behind(void **state) {
    (void)state;
    const int32_t bad[2] = {0, -1};
    outputs_fixture_t f;
    outputs_setup(&f);
    assert_int_equal(wh_outputs_write(NULL, two, 2), EINVAL);
    assert_int_equal(wh_outputs_write(f.path, NULL, 2), EINVAL);
    assert_int_equal(wh_outputs_write(f.path, two, 0), EINVAL);
    assert_int_equal(wh_outputs_write(f.path, two, WH_GRIPPERS + 1), EINVAL);
    assert_int_equal(wh_outputs_write(f.path, bad, 2), EINVAL);
    assert_int_equal(wh_outputs_write(outputs_path(&f, "no/outputs.txt"), two, 2), ENOENT);
    assert_int_equal(wh_outputs_write(outputs_path(&f, ""), two, 2), EINVAL);
    assert_int_equal(outputs_files(&f), 0);
    assert_int_equal(mkdir(f.path, 0777), 0);
    assert_int_equal(wh_outputs_write(f.path, two, 2), EISDIR);
    assert_int_equal(rmdir(f.path), 0);
    assert_int_equal(mkfifo(f.path, 0666), 0); /* as /dev/null would be */
    assert_int_equal(wh_outputs_write(f.path, two, 2), EINVAL);
    assert_int_equal(wh_outputs_write(outputs_path(&f, "outputs.txt/x"), two, 2), ENOTDIR);
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(symlink("outputs.txt", f.path), 0);
    assert_int_equal(wh_outputs_write(f.path, two, 2), ELOOP);
    assert_int_equal(outputs_files(&f), 1);
    outputs_teardown(&f);
}

/* A limit on the size of files simulates a full disk. */
static void a_failed_write_leaves_the_old_file(void **state) {
    (void)state;
    outputs_fixture_t f;
    struct rlimit limit, none;
    outputs_setup(&f);
    outputs_put(f.path, "1 1");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    none = limit;
    for (rlim_t size = 0; size < 4; ++size) {
        none.rlim_cur = size;
        (void)signal(SIGXFSZ, SIG_IGN);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &none), 0);
        const int error = wh_outputs_write(f.path, two, 2);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        assert_int_equal(error, size == 0 ? EFBIG : ENOSPC);
        assert_file(f.path, "1 1");
        assert_int_equal(outputs_files(&f), 1);
    }
    outputs_teardown(&f);
}

/* Temporary files of killed writers do not stop it, up to a point. */
static void leftovers_are_stepped_over(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    for (int i = 0; i < 100; ++i) {
        char name[64];
        assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
        snprintf(name, sizeof name, ".waferhand-%ld-%d", (long)getpid(), i);
        outputs_put(outputs_path(&f, name), "");
    }
    assert_int_equal(wh_outputs_write(f.path, two, 2), EEXIST);
    assert_int_equal(outputs_files(&f), 101);
    outputs_teardown(&f);
}

/* ---- beside writers: eight valves, of which only four patterns are ever written, far from each other ----
 */

enum { VALVES = 8 };

static const int32_t patterns[4][VALVES] = {
    {0, 0, 0, 0, 0, 0, 0, 0}, {1, 1, 1, 1, 0, 0, 0, 0}, {0, 0, 1, 1, 1, 1, 0, 0}, {1, 1, 0, 0, 1, 1, 1, 1}};

static void write_by_rename(const char *path, const int32_t *valves) {
    if (wh_outputs_write(path, valves, VALVES) != 0) {
        _exit(1);
    }
}

/* A program with a buffer truncates, and writes once. */
static void write_at_once(const char *path, const int32_t *valves) {
    char text[2 * VALVES];
    for (size_t i = 0; i < VALVES; ++i) {
        text[2 * i] = (char)('0' + valves[i]);
        text[2 * i + 1] = '\n';
    }
    const int fd = open(path, O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (write(fd, text, sizeof text) != (ssize_t)sizeof text || close(fd) != 0) {
        _exit(1);
    }
}

/* A program without a buffer truncates, and writes each value and each line feed on its own. */
static void write_by_byte(const char *path, const int32_t *valves) {
    const int fd = open(path, O_WRONLY | O_TRUNC | O_CLOEXEC);
    for (size_t i = 0; i < VALVES; ++i) {
        const char digit = (char)('0' + valves[i]);
        if (write(fd, &digit, 1) != 1 || write(fd, "\n", 1) != 1) {
            _exit(1);
        }
    }
    close(fd);
}

typedef void (*writer_t)(const char *path, const int32_t *valves);

static pid_t start(writer_t writer, const char *path) {
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        for (int i = 0; i < WRITES; ++i) {
            writer(path, patterns[i % 4]);
        }
        _exit(0);
    }
    return child;
}

static void assert_is_a_pattern(const int32_t *valves) {
    for (size_t i = 0; i < 4; ++i) {
        if (memcmp(valves, patterns[i], sizeof patterns[i]) == 0) {
            return;
        }
    }
    fail_msg("valves that were never written");
}

static bool has_ended(pid_t child) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    assert_true(ended == 0 || (ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0));
    return ended == child;
}

/* The clock stands still: whatever the machine does in the meantime, no bad state lasts. */
static void hammer(writer_t writer, const char *name) {
    outputs_fixture_t f;
    outputs_setup(&f);
    outputs_put(f.path, "0 0 0 0 0 0 0 0");
    outputs_open(&f, f.path, "00000000");
    assert_int_equal(outputs_update(&f), 0);
    const pid_t child = start(writer, f.path);
    for (bool ended = false; !ended;) {
        struct pollfd waiting = {.fd = f.reader.fd, .events = POLLIN};
        (void)poll(&waiting, 1, 10);
        ended = has_ended(child);
        do {
            (void)outputs_update(&f);
            assert_is_a_pattern(f.reader.valves);
        } while (ended && poll(&waiting, 1, 0) == 1);
    }
    assert_memory_equal(f.reader.valves, patterns[(WRITES - 1) % 4], sizeof patterns[0]);
    assert_int_equal(f.reader.counters.reports, 0);
    const uint64_t looks = outputs_looks(&f.reader), good = f.reader.counters.looks[WH_OUTPUTS_GOOD];
    printf("%s: %llu looks, %.1f %% torn\n", name, (unsigned long long)looks,
           100.0 * (double)(looks - good) / (double)looks);
    assert_true(good > 1 && (writer != write_by_rename || looks == good));
    outputs_teardown(&f);
}

static void writers_by_rename_are_never_torn(void **state) {
    (void)state;
    hammer(write_by_rename, "rename");
}

static void writers_in_place_are_never_believed_half_way(void **state) {
    (void)state;
    hammer(write_at_once, "in place, at once");
    hammer(write_by_byte, "in place, by byte");
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
        cmocka_unit_test(good_files),
        cmocka_unit_test(bad_files),
        cmocka_unit_test(a_zero_byte_is_no_end),
        cmocka_unit_test(the_beginning_of_a_good_file_says_the_same_or_is_short),
        cmocka_unit_test(random_files_change_nothing_unless_they_are_good),
        cmocka_unit_test(random_things_at_the_path),
        cmocka_unit_test(it_writes_a_value_a_line),
        cmocka_unit_test(permissions_are_kept_or_usual),
        cmocka_unit_test(a_link_stays_a_link),
        cmocka_unit_test(what_is_refused_leaves_nothing_behind),
        cmocka_unit_test(a_failed_write_leaves_the_old_file),
        cmocka_unit_test(leftovers_are_stepped_over),
        cmocka_unit_test(writers_by_rename_are_never_torn),
        cmocka_unit_test(writers_in_place_are_never_believed_half_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
