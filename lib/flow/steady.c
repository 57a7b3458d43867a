#include "flow.h"

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
