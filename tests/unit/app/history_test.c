/* The prompt's history file: where it is, what is taken from it, how it is kept short and private. And how any file of
 * the program replaces the one before it. */
#include "support/support.h"

#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/prompt/history.h"
#include "text/output.h"

static char folder[WH_TEST_PATH];
static char path[WH_TEST_PATH + 50];
static char loaded[WH_HISTORY_LINES * 2][1100];
static size_t count;

static int make_folder(void **state) {
    (void)state;
    count = 0;
    if (!mkdtemp(wh_test_path(folder, "history"))) {
        return -1;
    }
    snprintf(path, sizeof path, "%s/waferhand/history", folder);
    return 0;
}

static int remove_folder(void **state) {
    char command[WH_TEST_PATH + 20];
    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static void take(void *user, const char *text) {
    assert_ptr_equal(user, &count);
    assert_true(count < sizeof loaded / sizeof loaded[0]);
    snprintf(loaded[count++], sizeof loaded[0], "%s", text);
}

static void load(void) {
    count = 0;
    wh_history_load(path, take, &count);
}

static void write_file(const char *text, size_t size) {
    wh_history_append(path, "x");
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_int_equal(fwrite(text, 1, size, out), size);
    fclose(out);
}

static void where_it_is(void **state) {
    char text[100];
    (void)state;
    setenv("HOME", "/home/operator", 1);
    setenv("XDG_STATE_HOME", "/state", 1);
    wh_output_state_path("history", text, sizeof text);
    assert_string_equal(text, "/state/waferhand/history");
    setenv("XDG_STATE_HOME", "relative", 1);
    wh_output_state_path("history", text, sizeof text);
    assert_string_equal(text, "/home/operator/.local/state/waferhand/history");
    wh_output_state_path("history", text, 20);
    assert_string_equal(text, "");
    unsetenv("HOME");
    wh_output_state_path("history", text, sizeof text);
    assert_string_equal(text, "");
}

static void lines_come_back(void **state) {
    struct stat about;
    (void)state;
    load();
    assert_int_equal(count, 0);
    wh_history_append(path, "GET A 1");
    wh_history_append(path, "PUT \"\xC3\xA4\" 2");
    load();
    assert_int_equal(count, 2);
    assert_string_equal(loaded[0], "GET A 1");
    assert_string_equal(loaded[1], "PUT \"\xC3\xA4\" 2");
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0600);
}

static void what_is_no_line_is_left_out(void **state) {
    static char text[2000];
    (void)state;
    const int head = snprintf(text, sizeof text, "GET A 1\n\n\033[2J\nA\tB\n%s", "PUT B 2\n");
    memset(text + head, 'x', 1001);
    write_file(text, (size_t)head + 1001);
    wh_history_append(path, "with\nline end");
    wh_history_append(path, "");
    load();
    assert_int_equal(count, 2);
    assert_string_equal(loaded[1], "PUT B 2");
}

static void a_long_file_is_cut(void **state) {
    struct stat about;
    (void)state;
    for (int i = 1; i <= 2 * WH_HISTORY_LINES; ++i) {
        char line[30];
        snprintf(line, sizeof line, "WAIT %d", i);
        wh_history_append(path, line);
    }
    load();
    assert_int_equal(count, WH_HISTORY_LINES);
    assert_string_equal(loaded[0], "WAIT 501");
    assert_string_equal(loaded[count - 1], "WAIT 1000");
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_size, 499 * 9 + 10);
    assert_int_equal(about.st_mode & 0777, 0600);
    load();
    assert_int_equal(count, WH_HISTORY_LINES);
}

static void a_huge_file_is_cut(void **state) {
    static char text[WH_HISTORY_BYTES + 5000];
    struct stat about;
    (void)state;
    memset(text, 'x', sizeof text);
    memcpy(text + sizeof text - 9, "\nGET A 1\n", 9);
    write_file(text, sizeof text);
    load();
    assert_int_equal(count, 1);
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_size, 8);
}

static void what_is_no_file_does_no_harm(void **state) {
    (void)state;
    wh_history_append(path, "x");
    unlink(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    load();
    wh_history_append(path, "GET A 1");
    unlink(path);
    assert_int_equal(mkdir(path, 0700), 0);
    load();
    wh_history_append(path, "GET A 1");
    wh_history_append("", "GET A 1");
    wh_history_append("/dev/null/history", "GET A 1");
    assert_int_equal(count, 0);
}

static void a_file_is_replaced_whole_and_a_link_stays(void **state) {
    char link[WH_TEST_PATH + 60];
    struct stat about;
    wh_output_t output = {0};
    (void)state;
    write_file("old", 3);
    snprintf(link, sizeof link, "%s-link", path);
    assert_int_equal(chmod(path, 0604), 0);
    assert_int_equal(symlink(path, link), 0);
    for (int kept = 0; kept < 2; ++kept) {
        assert_true(wh_output_open(&output, link));
        fputs("newer", output.file);
        assert_int_equal(stat(path, &about), 0);
        assert_int_equal(about.st_size, 3);
        if (kept) {
            assert_true(wh_output_commit(&output));
        }
        wh_output_drop(&output);
    }
    assert_int_equal(lstat(link, &about), 0);
    assert_true(S_ISLNK(about.st_mode));
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_size, 5);
    assert_int_equal(about.st_mode & 0777, 0604);
    snprintf(link, sizeof link, "test $(ls -A '%s/waferhand' | wc -l) = 2", folder);
    assert_int_equal(system(link), 0);
}

static void what_is_no_plain_file_is_written_at_once(void **state) {
    wh_output_t output = {0};
    (void)state;
    assert_true(wh_output_open(&output, "/dev/null"));
    fputs("nowhere", output.file);
    assert_true(wh_output_commit(&output));
    assert_false(wh_output_open(&output, folder));
    assert_int_equal(errno, EISDIR);
    snprintf(path, sizeof path, "%s/none/file", folder);
    assert_false(wh_output_open(&output, path));
    assert_int_equal(errno, ENOENT);
}

int main(void) {
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(where_it_is),
        IN_FOLDER(lines_come_back),
        IN_FOLDER(what_is_no_line_is_left_out),
        IN_FOLDER(a_long_file_is_cut),
        IN_FOLDER(a_huge_file_is_cut),
        IN_FOLDER(what_is_no_file_does_no_harm),
        IN_FOLDER(a_file_is_replaced_whole_and_a_link_stays),
        IN_FOLDER(what_is_no_plain_file_is_written_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
