#include "input.h"

#include <errno.h>
#include <poll.h>
#include <unistd.h>

#include "interrupt.h"

static void call_watches(wh_input_t *input, const struct pollfd *polled, size_t count) {
    wh_interrupt_stop_session(input->session);
    for (size_t i = 0; i < count && i < input->watch_count; ++i) {
        if (polled[i].revents != 0) {
            input->watches[i].ready(input->watches[i].user);
        }
    }
    wh_interrupt_stop_session(NULL);
}

wh_input_event_t wh_input_wait(wh_input_t *input) {
    struct pollfd polled[WH_PROMPT_WATCHES + 1];
    while (!input->leaving) {
        const size_t count = input->watch_count;
        for (size_t i = 0; i < count; ++i) {
            polled[i] = (struct pollfd){.fd = input->watches[i].fd, .events = POLLIN};
        }
        polled[count] = (struct pollfd){.fd = STDIN_FILENO, .events = POLLIN};
        if (ppoll(polled, count + 1, NULL, wh_interrupt_waiting()) < 0) {
            return errno == EINTR ? WH_INPUT_SIGNAL : WH_INPUT_BROKEN;
        }
        call_watches(input, polled, count);
        if (wh_interrupt_pending()) {
            return WH_INPUT_SIGNAL;
        }
        if (polled[count].revents != 0 && !input->leaving) {
            return WH_INPUT_READY;
        }
    }
    return WH_INPUT_LEAVE;
}
