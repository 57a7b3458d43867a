/* When a slice is due by the wall clock. Times are microseconds of a clock that never jumps.
 *
 * A slice that begins later than an eighth of its length moves all later ones by as much: so a board has at
 * least seven eighths of a slice for its answer, and slices that were missed are not hurried through.
 */
#ifndef WH_LOOP_PACING_H
#define WH_LOOP_PACING_H

#include <stdint.h>

typedef struct {
    int64_t slice_us, base_us;
    int64_t passed;              /* slices */
    int64_t late;                /* of them, those that began later than half their length */
    int64_t latest_us, moved_us; /* the latest begin, after its time; by how much slices were moved in all */
} wh_pacing_t;

static inline void wh_pacing_begin(wh_pacing_t *pacing, int64_t slice_us, int64_t now_us) {
    const wh_pacing_t begun = {slice_us, now_us, 0, 0, 0, 0};
    *pacing = begun;
}

/* When the next slice is due. */
static inline int64_t wh_pacing_due(const wh_pacing_t *pacing) {
    return pacing->base_us + (pacing->passed + 1) * pacing->slice_us;
}

/* The next slice begins now. */
static inline void wh_pacing_pass(wh_pacing_t *pacing, int64_t now_us) {
    const int64_t after_us = now_us - wh_pacing_due(pacing);
    ++pacing->passed;
    if (after_us > pacing->slice_us / 8) {
        pacing->base_us += after_us;
        pacing->moved_us += after_us;
    }
    pacing->late += after_us > pacing->slice_us / 2 ? 1 : 0;
    pacing->latest_us = after_us > pacing->latest_us ? after_us : pacing->latest_us;
}

#endif
