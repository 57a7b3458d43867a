#include "progress.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

void wh_stretches_free(wh_stretches_t *stretches) {
    free(stretches->items);
    memset(stretches, 0, sizeof *stretches);
}

static uint64_t end_of(const wh_stretch_t *stretch) {
    return stretch->first + stretch->count;
}

/* The first stretch that ends behind this trial. */
static size_t find(const wh_stretches_t *stretches, uint64_t trial) {
    size_t i = stretches->count;
    while (i > 0 && end_of(&stretches->items[i - 1]) > trial) {
        --i;
    }
    return i;
}

static void insert(wh_stretches_t *stretches, size_t at, wh_stretch_t stretch) {
    stretches->items =
        wh_array_grow(stretches->items, stretches->count, &stretches->capacity, sizeof *stretches->items);
    memmove(&stretches->items[at + 1], &stretches->items[at],
            (stretches->count - at) * sizeof *stretches->items);
    stretches->items[at] = stretch;
    ++stretches->count;
}

static void remove_at(wh_stretches_t *stretches, size_t at) {
    --stretches->count;
    memmove(&stretches->items[at], &stretches->items[at + 1],
            (stretches->count - at) * sizeof *stretches->items);
}

/* Puts a stretch before the one at `at`, as one with those that it touches. */
static void join(wh_stretches_t *stretches, size_t at, wh_stretch_t stretch) {
    wh_stretch_t *items = stretches->items;
    const bool after = at > 0 && end_of(&items[at - 1]) == stretch.first;
    const bool before = at < stretches->count && items[at].first == end_of(&stretch);
    if (after) {
        items[at - 1].count += stretch.count + (before ? items[at].count : 0);
    } else if (before) {
        items[at].first = stretch.first;
        items[at].count += stretch.count;
    } else {
        insert(stretches, at, stretch);
    }
    if (after && before) {
        remove_at(stretches, at);
    }
}

bool wh_stretches_add(wh_stretches_t *stretches, wh_stretch_t stretch) {
    const size_t at = find(stretches, stretch.first);
    if (stretch.count == 0 || (at < stretches->count && stretches->items[at].first < end_of(&stretch))) {
        return false;
    }
    join(stretches, at, stretch);
    stretches->trials += stretch.count;
    return true;
}

wh_stretch_t wh_stretches_take(wh_stretches_t *stretches, uint64_t most) {
    wh_stretch_t taken = {0, 0};
    if (stretches->count == 0) {
        return taken;
    }
    wh_stretch_t *front = &stretches->items[0];
    taken = (wh_stretch_t){front->first, most < front->count ? most : front->count};
    front->first += taken.count;
    front->count -= taken.count;
    stretches->trials -= taken.count;
    if (front->count == 0) {
        remove_at(stretches, 0);
    }
    return taken;
}

uint64_t wh_stretches_below(const wh_stretches_t *stretches, uint64_t trial) {
    uint64_t below = 0;
    for (size_t i = 0; i < stretches->count && stretches->items[i].first < trial; ++i) {
        const uint64_t left = trial - stretches->items[i].first;
        below += left < stretches->items[i].count ? left : stretches->items[i].count;
    }
    return below;
}

void wh_stretches_rest(wh_stretches_t *rest, const wh_stretches_t *done, uint64_t trials) {
    uint64_t from = 0;
    for (size_t i = 0; i <= done->count; ++i) {
        const uint64_t to = i < done->count ? done->items[i].first : trials;
        const wh_stretch_t stretch = {from, to > from ? to - from : 0};
        (void)wh_stretches_add(rest, stretch);
        from = i < done->count ? end_of(&done->items[i]) : to;
    }
}

/* ----------------------------------------------------------------------------------------------- progress */

void wh_progress_init(wh_progress_t *progress, const wh_study_t *study) {
    memset(&progress->done, 0, sizeof progress->done);
    wh_tally_init(&progress->tally, study->wafer_count);
}

void wh_progress_free(wh_progress_t *progress) {
    wh_stretches_free(&progress->done);
    wh_tally_free(&progress->tally);
}

void wh_progress_merge(wh_progress_t *progress, const wh_progress_t *other) {
    for (size_t i = 0; i < other->done.count; ++i) {
        (void)wh_stretches_add(&progress->done, other->done.items[i]);
    }
    wh_tally_merge(&progress->tally, &other->tally);
}
