#include "live_lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "../text/array.h"

bool wh_live_lines_open(wh_live_lines_t *lines) {
    *lines = (wh_live_lines_t){.wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
    return lines->wake >= 0;
}

bool wh_live_lines_put(wh_live_lines_t *lines, int64_t number, bool completes, const char *text) {
    const uint64_t one = 1;
    if (__atomic_load_n(&lines->waiting, __ATOMIC_ACQUIRE) >= WH_LIVE_LINES) {
        return false;
    }
    wh_live_line_t *line = wh_array_new(1, sizeof *line);
    line->number = number;
    line->completes = completes;
    (void)snprintf(line->text, sizeof line->text, "%s", text);
    (void)__atomic_add_fetch(&lines->waiting, 1, __ATOMIC_ACQ_REL);
    line->next = __atomic_load_n(&lines->newest, __ATOMIC_RELAXED);
    while (!__atomic_compare_exchange_n(&lines->newest, &line->next, line, true, __ATOMIC_RELEASE,
                                        __ATOMIC_RELAXED)) {
    }
    (void)!write(lines->wake, &one, sizeof one);
    return true;
}

bool wh_live_lines_wait(const wh_live_lines_t *lines) {
    return __atomic_load_n(&lines->waiting, __ATOMIC_RELAXED) > 0;
}

/* A line that comes in between wakes once more, and is taken then. */
static void take_all(wh_live_lines_t *lines) {
    uint64_t count = 0;
    (void)!read(lines->wake, &count, sizeof count);
    wh_live_line_t *newest = __atomic_exchange_n(&lines->newest, NULL, __ATOMIC_ACQUIRE);
    while (newest) {
        wh_live_line_t *next = newest->next;
        newest->next = lines->taken;
        lines->taken = newest;
        newest = next;
    }
}

bool wh_live_lines_take(wh_live_lines_t *lines, wh_live_line_t *line) {
    if (!lines->taken) {
        take_all(lines);
    }
    wh_live_line_t *first = lines->taken;
    if (!first) {
        return false;
    }
    lines->taken = first->next;
    *line = *first;
    line->next = NULL;
    free(first);
    (void)__atomic_sub_fetch(&lines->waiting, 1, __ATOMIC_ACQ_REL);
    return true;
}

void wh_live_lines_close(wh_live_lines_t *lines) {
    wh_live_line_t line;
    while (wh_live_lines_take(lines, &line)) {
    }
    if (lines->wake >= 0) {
        (void)close(lines->wake);
    }
    lines->wake = -1;
}
