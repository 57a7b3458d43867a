/* Requests of a live page change what they may, and nothing else; lines on their way from one thread to the other. */
#include "support/support.h"

#include <poll.h>
#include <pthread.h>

#include "app/live_control.h"

/* ------------------------------------------------------------------------------------------------- requests */

static wh_live_control_t control;

static unsigned ask(const char *token, const char *request) {
    char body[2000];
    char *answer = NULL;
    (void)snprintf(body, sizeof body, "{\"token\":\"%s\",%s}", token, request);
    const unsigned status = wh_live_control_take(&control, body, strlen(body), &answer);
    assert_non_null(answer);
    assert_int_equal(strstr(answer, "\"ok\":true") != NULL, status < 400);
    free(answer);
    return status;
}

static void begin(wh_live_controlled_t controlled, bool paces) {
    memset(&control, 0, sizeof control);
    assert_true(wh_live_control_begin(&control, controlled, paces, 1));
}

static void a_wrong_token_changes_nothing(void **state) {
    (void)state;
    begin(WH_LIVE_PROMPT, true);
    assert_int_equal(strlen(control.token), WH_LIVE_TOKEN);
    for (size_t i = 0; i < WH_LIVE_TOKEN; ++i) {
        char wrong[WH_LIVE_TOKEN + 1];
        memcpy(wrong, control.token, sizeof wrong);
        wrong[i] = wrong[i] == '0' ? '1' : '0';
        assert_int_equal(ask(wrong, "\"line\":\"GET A 1\""), 403);
        assert_int_equal(ask(wrong, "\"pause\":true"), 403);
        wrong[i] = '\0'; /* too short */
        assert_int_equal(ask(wrong, "\"rate\":5"), 403);
    }
    assert_false(control.is_paused);
    assert_false(wh_live_lines_wait(&control.lines));
    assert_int_equal(control.rate_ppm, 1000000);
    wh_live_control_end(&control);
}

/* Viewers without a token see these numbers. */
static void numbers_tell_nothing_of_the_token(void **state) {
    unsigned same = 0;
    (void)state;
    for (int i = 0; i < 64; ++i) {
        unsigned first = 0;
        begin(WH_LIVE_TESTER, false);
        (void)sscanf(control.token, "%4x", &first);
        same += (control.base - 1000000000) / 1000 == first ? 1 : 0;
        wh_live_control_end(&control);
    }
    assert_true(same < 4);
}

static void each_kind_takes_its_own(void **state) {
    (void)state;
    begin(WH_LIVE_RUN, true);
    assert_int_equal(ask(control.token, "\"pause\":true"), 200);
    assert_true(control.is_paused);
    assert_int_equal(ask(control.token, "\"slices\":3"), 200);
    assert_int_equal(control.slices, 3);
    assert_int_equal(ask(control.token, "\"line\":\"STATUS\""), 400);
    assert_int_equal(ask(control.token, "\"complete\":\"ST\""), 400);
    wh_live_control_end(&control);
    begin(WH_LIVE_TESTER, true);
    assert_int_equal(ask(control.token, "\"pause\":true"), 400);
    assert_int_equal(ask(control.token, "\"complete\":\"ST\""), 400);
    assert_int_equal(ask(control.token, "\"line\":\"STATUS\""), 503); /* nobody listens */
    assert_false(control.is_paused);
    wh_live_control_end(&control);
    begin(WH_LIVE_PROMPT, false);
    assert_int_equal(ask(control.token, "\"pause\":true"), 400);
    assert_int_equal(ask(control.token, "\"slices\":1"), 400);
    assert_int_equal(ask(control.token, "\"rate\":2"), 400);
    assert_int_equal(ask(control.token, "\"line\":\"STATUS\""), 202);
    wh_live_control_end(&control);
}

static void a_stop_ends_a_pause(void **state) {
    wh_live_line_t line;
    (void)state;
    begin(WH_LIVE_PROMPT, true);
    assert_int_equal(ask(control.token, "\"pause\":true"), 200);
    assert_int_equal(ask(control.token, "\"complete\":\"STOP\""), 202);
    assert_int_equal(ask(control.token, "\"line\":\"STOPPING\""), 202);
    assert_true(control.is_paused);
    assert_int_equal(ask(control.token, "\"line\":\" stop \""), 202);
    assert_false(control.is_paused);
    for (int i = 1; i <= 3; ++i) {
        assert_true(wh_live_lines_take(&control.lines, &line));
        assert_int_equal(line.number, control.base + i);
        assert_int_equal(line.completes, i == 1);
    }
    wh_live_control_end(&control);
}

/* ---------------------------------------------------------------------------------------------------- lines */

#define LINES 20000

static void *put_all(void *user) {
    wh_live_lines_t *lines = user;
    for (int64_t number = 1; number <= LINES;) {
        char text[40];
        (void)snprintf(text, sizeof text, "line %lld", (long long)number);
        number += wh_live_lines_put(lines, number, number % 3 == 0, text) ? 1 : 0;
    }
    return NULL;
}

static void lines_come_once_and_in_order(void **state) {
    wh_live_lines_t lines;
    pthread_t thread;
    (void)state;
    assert_true(wh_live_lines_open(&lines));
    assert_int_equal(pthread_create(&thread, NULL, put_all, &lines), 0);
    for (int64_t number = 1; number <= LINES;) {
        struct pollfd ready = {.fd = lines.wake, .events = POLLIN};
        wh_live_line_t line;
        char text[40];
        assert_true(poll(&ready, 1, 20000) > 0 || wh_live_lines_wait(&lines));
        while (wh_live_lines_take(&lines, &line)) {
            (void)snprintf(text, sizeof text, "line %lld", (long long)number);
            assert_int_equal(line.number, number);
            assert_int_equal(line.completes, number % 3 == 0);
            assert_string_equal(line.text, text);
            ++number;
        }
    }
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_false(wh_live_lines_wait(&lines));
    wh_live_lines_close(&lines);
}

static void so_many_wait_and_no_more(void **state) {
    wh_live_lines_t lines;
    wh_live_line_t line;
    (void)state;
    assert_true(wh_live_lines_open(&lines));
    for (int i = 0; i < WH_LIVE_LINES; ++i) {
        assert_true(wh_live_lines_put(&lines, i + 1, false, "GET A 1"));
    }
    assert_false(wh_live_lines_put(&lines, 100, false, "GET A 1"));
    assert_true(wh_live_lines_take(&lines, &line));
    assert_int_equal(line.number, 1);
    assert_true(wh_live_lines_put(&lines, 101, false, "GET A 1"));
    wh_live_lines_close(&lines); /* frees those that nobody took */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wrong_token_changes_nothing), cmocka_unit_test(numbers_tell_nothing_of_the_token),
        cmocka_unit_test(each_kind_takes_its_own),       cmocka_unit_test(a_stop_ends_a_pause),
        cmocka_unit_test(lines_come_once_and_in_order),  cmocka_unit_test(so_many_wait_and_no_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
