/* Times that are valid and look as if they were in another unit. */
#include <stdlib.h>

#include "../text/array.h"
#include "check_internal.h"

/* Times are in another unit if the middle one of all picks, places and swaps is so many times as long as the
 * layout says, or the layout's is so many times as long. */
#define FAR_APART 200

/* Without a layout: no blade is in a place for so long, or so short a time, s. */
#define LONG_ACCESS 300
#define SHORT_ACCESS 0.02

/* Fewer tell nothing. */
#define FEWEST 2

static int by_size(const void *a, const void *b) {
    const double one = *(const double *)a, other = *(const double *)b;
    return one < other ? -1 : one > other;
}

static int64_t layout_us(const wh_schedule_state_t *check, const wh_schedule_row_t *row) {
    const size_t pair = wh_check_pair(check, row);
    return row->action == WH_SCHEDULE_PICK    ? check->tool->pick_us[pair]
           : row->action == WH_SCHEDULE_PLACE ? check->tool->place_us[pair]
                                              : check->tool->swap_us[pair];
}

/* The middle one of all accesses that take time, by the layout's time, or in s; 0: there are too few. */
static double find_middle(const wh_schedule_state_t *check) {
    double *lengths = wh_array_new(check->schedule->count + 1, sizeof *lengths);
    size_t count = 0;
    for (size_t i = 0; i < check->schedule->count; ++i) {
        const wh_schedule_row_t *row = &check->schedule->rows[i];
        if (wh_schedule_is_access(row->action) && row->end_us > row->begin_us) {
            const double us = (double)(row->end_us - row->begin_us);
            const double by = check->tool ? (double)layout_us(check, row) : 1e6;
            lengths[count] = by > 0 ? us / by : 0;
            count += by > 0;
        }
    }
    qsort(lengths, count, sizeof *lengths, by_size);
    const double middle = count >= FEWEST ? lengths[count / 2] : 0;
    free(lengths);
    return middle;
}

void wh_check_guess_unit(wh_schedule_state_t *check) {
    const double middle = find_middle(check);
    const double most = check->tool ? FAR_APART : LONG_ACCESS;
    const double least = check->tool ? 1.0 / FAR_APART : SHORT_ACCESS;
    check->report->scale = middle > most * 1000           ? 1e-6
                           : middle > most                ? 1e-3
                           : middle > 0 && middle < least ? 1e3
                                                          : 1;
}

const char *wh_schedule_unit(double scale) {
    return scale == 1 ? "s" : scale == 1e-3 ? "ms" : scale == 1e-6 ? "us" : "s by 1000";
}
