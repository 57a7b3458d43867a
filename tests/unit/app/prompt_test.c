/* The prompt looks after another descriptor while it waits: as LCM's is. */
#include "support/support.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <time.h>
#include <unistd.h>

#include "app/prompt/prompt.h"

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

/* A request from elsewhere: executed; the third one ends the prompt by a signal. */
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
    const wh_prompt_watch_t watch = {other[0], take_request, count_stop, &calls};
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

/* Nothing comes: the watch is looked after all the same, every 100 ms. */
static void the_watch_is_called_in_silence(void **state) {
    const wh_prompt_watch_t watch = {other[0], leave_at_the_third_look, count_stop, NULL};
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

/* Who has blocked a signal for a signalfd gets it there, also when it comes before the wait. */
static void a_signal_descriptor_wakes_it(void **state) {
    sigset_t mask;
    (void)state;
    sigemptyset(&mask);
    sigaddset(&mask, SIGTERM);
    sigprocmask(SIG_BLOCK, &mask, NULL);
    signal_descriptor = signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
    const wh_prompt_watch_t watch = {signal_descriptor, take_signal, count_stop, NULL};
    prompt = wh_prompt_open(&session, &watch);
    raise(SIGTERM);
    assert_int_equal(wh_prompt_run(prompt), 0);
    assert_int_equal(calls, 1);
    close(signal_descriptor);
    wh_prompt_close(prompt); /* which brings back the mask from before it */
    prompt = NULL;
    sigprocmask(SIG_UNBLOCK, &mask, NULL);
}

/* Without one the prompt takes it, also when it comes before the wait; then all is as it was. */
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

/* A signal stops a watch's command, too, and is then the prompt's. The watch is told. */
static void signal_during_a_request(void **state) {
    const wh_prompt_watch_t watch = {other[0], take_long_request, count_stop, NULL};
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
    assert_int_equal(stops, 1); /* so that what else waits is not begun */
    timer_delete(timer);
}

int main(void) {
#define IN_PIPES(test) cmocka_unit_test_setup_teardown(test, open_all, close_all)
    const struct CMUnitTest tests[] = {
        IN_PIPES(the_watch_is_called_while_it_waits),
        IN_PIPES(lines_and_requests_take_turns),
        IN_PIPES(the_watch_is_called_in_silence),
        IN_PIPES(a_signal_descriptor_wakes_it),
        IN_PIPES(signal_before_the_wait),
        IN_PIPES(signal_during_a_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
