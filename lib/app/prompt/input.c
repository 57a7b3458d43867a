#include "input.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

/* ------------------------------------------------------------------------------------------------ signals */

static const int held[] = {SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGWINCH};

#define HELD (sizeof held / sizeof held[0])
#define HELD_WITHOUT_TERMINAL 3

static struct {
    size_t count;
    struct sigaction before[HELD];
    sigset_t mask_before;
    sigset_t mask_held;
    sigset_t mask_running; /* does not hold the first three */
    volatile sig_atomic_t arrived[HELD];
    wh_session_t *volatile session; /* whose command runs now, or null */
} signals;

static void on_signal(int number) {
    for (size_t i = 0; i < HELD; ++i) {
        signals.arrived[i] |= held[i] == number;
    }
    if (signals.session) {
        wh_session_stop(signals.session);
    }
}

void wh_interrupt_hold(bool terminal) {
    const struct sigaction action = {.sa_handler = on_signal};
    memset(&signals, 0, sizeof signals);
    signals.count = terminal ? HELD : HELD_WITHOUT_TERMINAL;
    sigprocmask(SIG_BLOCK, NULL, &signals.mask_before);
    signals.mask_held = signals.mask_running = signals.mask_before;
    for (size_t i = 0; i < signals.count; ++i) {
        sigaddset(&signals.mask_held, held[i]);
        if (i >= HELD_WITHOUT_TERMINAL) {
            sigaddset(&signals.mask_running, held[i]);
        }
    }
    sigprocmask(SIG_SETMASK, &signals.mask_held, NULL);
    for (size_t i = 0; i < signals.count; ++i) {
        sigaction(held[i], NULL, &signals.before[i]);
        if (signals.before[i].sa_handler != SIG_IGN) {
            sigaction(held[i], &action, NULL);
        }
    }
}

void wh_interrupt_release(void) {
    for (size_t i = 0; i < signals.count; ++i) {
        sigaction(held[i], &signals.before[i], NULL);
    }
    sigprocmask(SIG_SETMASK, &signals.mask_before, NULL);
    signals.count = 0;
}

/* The first of those that have arrived, or signals.count. */
static size_t find_arrived(void) {
    size_t i = 0;
    while (i < signals.count && !signals.arrived[i]) {
        ++i;
    }
    return i;
}

int wh_interrupt_take(void) {
    const size_t i = find_arrived();
    if (i == signals.count) {
        return 0;
    }
    signals.arrived[i] = 0;
    return held[i];
}

bool wh_interrupt_is_due(void) {
    return signals.arrived[0] || signals.arrived[1] || signals.arrived[2];
}

void wh_interrupt_stop_session(wh_session_t *session) {
    if (session) {
        signals.session = session;
        sigprocmask(SIG_SETMASK, &signals.mask_running, NULL);
    } else {
        sigprocmask(SIG_SETMASK, &signals.mask_held, NULL);
        signals.session = NULL;
    }
}

/* ------------------------------------------------------------------------------------------------ waiting */

void wh_input_tell_stop(const wh_input_t *input) {
    if (wh_interrupt_is_due()) {
        input->watch.stop(input->watch.user);
    }
}

wh_input_event_t wh_input_wait(const wh_input_t *input) {
    static const struct timespec tenth = {0, 100000000};
    struct pollfd polled[] = {{.fd = input->watch.fd, .events = POLLIN},
                              {.fd = STDIN_FILENO, .events = POLLIN},
                              {.fd = input->watch.other, .events = POLLIN}};
    for (;;) {
        /* With the mask as it was before, so that ppoll ends with EINTR when a held signal arrives. */
        const int ready = ppoll(polled, 3, &tenth, &signals.mask_before);
        if (ready < 0) {
            return errno == EINTR ? WH_INPUT_SIGNAL : WH_INPUT_BROKEN;
        }
        wh_interrupt_stop_session(input->session);
        input->watch.look(input->watch.user);
        wh_interrupt_stop_session(NULL);
        wh_input_tell_stop(input);
        if (find_arrived() < signals.count) {
            return WH_INPUT_SIGNAL;
        }
        if (polled[1].revents != 0) {
            return WH_INPUT_READY;
        }
    }
}
