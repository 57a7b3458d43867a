/* The prompt watches another descriptor while it waits, such as LCM's. */
#include "support/support.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "app/prompt/history.h"
#include "app/prompt/prompt.h"
#include "text/output.h"

static wh_session_t session;
static wh_prompt_t *prompt;
static int input[2], other[2], before;
static int calls, looks, stops;
static char answer[200];

static int open_all(void **state) {
    const wh_session_options_t options = {.layout = "lua/layouts/paper.lua", .limits = {.print_to = stderr}};
    (void)state;
    calls = looks = stops = 0;
    before = dup(STDIN_FILENO);
    if (pipe(input) != 0 || pipe(other) != 0 || dup2(input[0], STDIN_FILENO) < 0) {
        return -1;
    }
    fcntl(other[0], F_SETFL, O_NONBLOCK);
    return wh_session_open(&session, &options) ? 0 : -1;
}

static int close_all(void **state) {
    (void)state;
    wh_prompt_close(prompt);
    wh_session_close(&session);
    dup2(before, STDIN_FILENO);
    const int all[] = {before, input[0], input[1], other[0], other[1]};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
        close(all[i]);
    }
    return 0;
}

static void put(int fd, const char *text) {
    assert_int_equal(write(fd, text, strlen(text)), strlen(text));
}

/* A request from elsewhere is executed; the third one ends the prompt by a signal. */
static void take_request(void *user) {
    char byte;
    assert_ptr_equal(user, &calls);
    ++looks;
    if (read(other[0], &byte, 1) == 1) {
        wh_session_execute(&session, "WAIT 1", answer, sizeof answer);
        if (++calls == 3) {
            raise(SIGTERM);
        }
    }
}

static void count_stop(void *user) {
    (void)user;
    ++stops;
}

static void open_prompt(void) {
    const wh_prompt_watch_t watch = {other[0], -1, take_request, count_stop, &calls};
    prompt = wh_prompt_open(&session, &watch);
}

static void the_watch_is_called_while_it_waits(void **state) {
    (void)state;
    open_prompt();
    put(other[1], "123");
    put(input[1], "GET A");
    assert_int_equal(wh_prompt_run(prompt), 1);
    assert_int_equal(calls, 3);
    assert_string_equal(answer, "OK seconds=1");
    assert_int_equal(session.record.command_count, 3);
}

static void lines_and_requests_take_turns(void **state) {
    (void)state;
    open_prompt();
    put(other[1], "12");
    put(input[1], "GET A 1\nPUT B 2\n");
    close(input[1]);
    assert_int_equal(wh_prompt_run(prompt), 0);
    assert_true(calls >= 1);
    assert_int_equal(session.record.command_count, 2 + calls);
}

static void leave_at_the_third_look(void *user) {
    (void)user;
    if (++looks == 3) {
        raise(SIGTERM);
    }
}

/* Even if nothing comes, the watch is called every 100 ms. */
static void the_watch_is_called_in_silence(void **state) {
    const wh_prompt_watch_t watch = {other[0], -1, leave_at_the_third_look, count_stop, NULL};
    struct timespec begin, end;
    (void)state;
    prompt = wh_prompt_open(&session, &watch);
    clock_gettime(CLOCK_MONOTONIC, &begin);
    assert_int_equal(wh_prompt_run(prompt), 1);
    clock_gettime(CLOCK_MONOTONIC, &end);
    assert_int_equal(looks, 3);
    const double seconds = (double)(end.tv_sec - begin.tv_sec) + (double)(end.tv_nsec - begin.tv_nsec) / 1e9;
    assert_true(seconds > 0.29);
}

static int signal_descriptor;

static void take_signal(void *user) {
    struct signalfd_siginfo info;
    (void)user;
    if (read(signal_descriptor, &info, sizeof info) == sizeof info) {
        ++calls;
        assert_int_equal(info.ssi_signo, SIGTERM);
        close(input[1]);
    }
}

/* If a signal is blocked for a signalfd, it arrives there, also if it comes before the wait. */
static void a_signal_descriptor_wakes_it(void **state) {
    sigset_t mask;
    (void)state;
    sigemptyset(&mask);
    sigaddset(&mask, SIGTERM);
    sigprocmask(SIG_BLOCK, &mask, NULL);
    signal_descriptor = signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
    const wh_prompt_watch_t watch = {signal_descriptor, -1, take_signal, count_stop, NULL};
    prompt = wh_prompt_open(&session, &watch);
    raise(SIGTERM);
    assert_int_equal(wh_prompt_run(prompt), 0);
    assert_int_equal(calls, 1);
    close(signal_descriptor);
    wh_prompt_close(prompt); /* this restores the mask from before it */
    prompt = NULL;
    sigprocmask(SIG_UNBLOCK, &mask, NULL);
}

/* Without a signalfd the prompt takes the signal, also if it comes before the wait; then the mask
 * is as before. */
static void signal_before_the_wait(void **state) {
    struct sigaction action;
    (void)state;
    open_prompt();
    raise(SIGINT);
    assert_int_equal(wh_prompt_run(prompt), 1);
    wh_prompt_close(prompt);
    prompt = NULL;
    sigaction(SIGINT, NULL, &action);
    assert_true(action.sa_handler == SIG_DFL);
}

static void take_long_request(void *user) {
    char byte;
    (void)user;
    if (read(other[0], &byte, 1) == 1) {
        wh_session_execute(&session, "WAIT 40000", answer, sizeof answer);
    }
}

/* A signal also stops a watch's command, and then belongs to the prompt. The watch is told about it. */
static void signal_during_a_request(void **state) {
    const wh_prompt_watch_t watch = {other[0], -1, take_long_request, count_stop, NULL};
    const struct itimerspec soon = {{0, 0}, {0, 100000000}};
    struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGTERM};
    timer_t timer;
    (void)state;
    prompt = wh_prompt_open(&session, &watch);
    put(other[1], "1");
    assert_int_equal(timer_create(CLOCK_MONOTONIC, &event, &timer), 0);
    assert_int_equal(timer_settime(timer, 0, &soon, NULL), 0);
    assert_int_equal(wh_prompt_run(prompt), 1);
    assert_memory_equal(answer, "ERROR 52 STOPPED", 16);
    assert_int_equal(stops, 1); /* so that no other waiting work begins */
    timer_delete(timer);
}

/* -------------------------------------------------------------------------------------------------- history */

/* The prompt's history file: its place, the lines that are read from it, and how it is kept short
 * and private. The test also checks how a file of the program replaces an older one. */

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
#define IN_PIPES(test) cmocka_unit_test_setup_teardown(test, open_all, close_all)
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)
    const struct CMUnitTest tests[] = {
        IN_PIPES(the_watch_is_called_while_it_waits),
        IN_PIPES(lines_and_requests_take_turns),
        IN_PIPES(the_watch_is_called_in_silence),
        IN_PIPES(a_signal_descriptor_wakes_it),
        IN_PIPES(signal_before_the_wait),
        IN_PIPES(signal_during_a_request),
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
