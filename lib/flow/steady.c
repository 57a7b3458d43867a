#include "flow.h"

#include <stdio.h>

#include "../text/array.h"

/* The longest period that is looked for, in wafers. */
#define LONGEST 24

/* True if the differences over k wafers differ by at most 1 us from the first of the middle third. */
static bool is_steady(const int64_t *ends_us, size_t begin, size_t end, size_t k) {
    const int64_t first_us = ends_us[begin + k] - ends_us[begin];
    for (size_t i = begin; i + k < end; ++i) {
        const int64_t off_us = ends_us[i + k] - ends_us[i] - first_us;
        if (off_us > 1 || off_us < -1) {
            return false;
        }
    }
    return true;
}

int32_t wh_flow_steady(const int64_t *ends_us, size_t count, int64_t *cycle_us) {
    const size_t begin = count / 3, end = count - count / 3;
    *cycle_us = WH_FLOW_NEVER;
    for (size_t k = 1; k <= LONGEST && begin + 3 * k < end; ++k) {
        if (is_steady(ends_us, begin, end, k)) {
            *cycle_us = ends_us[begin + k] - ends_us[begin];
            return (int32_t)k;
        }
    }
    return 0;
}

/* The least number of wafers among which a period of k is looked for. */
static size_t wafers_for(size_t k) {
    size_t count = 9 * k;
    while (count / 3 + 3 * k >= count - count / 3) {
        ++count;
    }
    return count;
}

/* A period for which there are too few wafers, and which ends show all the same; 0: there is none. */
static size_t find_likely(const int64_t *ends_us, size_t count, size_t shortest) {
    for (size_t k = shortest; k <= LONGEST && count / 3 + 2 * k <= count; ++k) {
        const size_t third = count - count / 3, twice = count / 3 + 2 * k;
        if (is_steady(ends_us, count / 3, twice > third ? twice : third, k)) {
            return k;
        }
    }
    return 0;
}

char *wh_flow_no_cycle_text(const int64_t *ends_us, size_t count) {
    char text[200];
    size_t shortest = 1;
    while (shortest <= LONGEST && wafers_for(shortest) <= count) {
        ++shortest;
    }
    const size_t likely = find_likely(ends_us, count, shortest);
    if (shortest > LONGEST) {
        return wh_text_copy("the wafers' ends do not repeat within their middle third");
    }
    if (likely > 0) {
        (void)snprintf(text, sizeof text,
                       "too few wafers: their ends seem to repeat every %zu, which %zu would show", likely,
                       wafers_for(likely));
    } else {
        (void)snprintf(text, sizeof text, "too few wafers: %zu would show any that repeats every 1 to %d",
                       wafers_for(LONGEST), LONGEST);
    }
    return wh_text_copy(text);
}
