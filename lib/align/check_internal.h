/* Compares fields with their ranges and keeps the first wrong one; internal to the room. */
#ifndef WH_ALIGN_CHECK_INTERNAL_H
#define WH_ALIGN_CHECK_INTERNAL_H

#include "rim.h"

typedef struct {
    wh_status_t status;
    wh_bad_field_t bad;
} wh_field_check_t;

static inline wh_field_check_t wh_field_check_begin(void) {
    const wh_field_check_t begun = {WH_OK, {NULL, WH_NONE}};
    return begun;
}

/* Keeps the first finding; NaN counts as below each least value and above each greatest. */
static inline void wh_field_check(wh_field_check_t *check, const char *name, int32_t index, double value,
                                  double least, double most) {
    if (check->status == WH_OK && !(value >= least && value <= most)) {
        check->status = value - value == 0 ? WH_STATUS_OUT_OF_RANGE : WH_STATUS_NOT_FINITE;
        check->bad.name = name;
        check->bad.index = index;
    }
}

static inline wh_status_t wh_field_check_end(const wh_field_check_t *check, wh_bad_field_t *bad) {
    if (check->status != WH_OK && bad != NULL) {
        *bad = check->bad;
    }
    return check->status;
}

#endif
