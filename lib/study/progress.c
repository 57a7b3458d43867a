#include <stdlib.h>
#include <string.h>

#include "pool.h"

void wh_progress_init(wh_progress_t *progress, const wh_study_t *study) {
    progress->block_count = wh_study_blocks(study);
    progress->done_count = 0;
    progress->done = calloc((size_t)progress->block_count / 8 + 1, 1);
    if (!progress->done) {
        abort();
    }
    wh_tally_init(&progress->tally, study->wafer_count);
}

void wh_progress_free(wh_progress_t *progress) {
    free(progress->done);
    progress->done = NULL;
    wh_tally_free(&progress->tally);
}

void wh_progress_clear(wh_progress_t *progress) {
    memset(progress->done, 0, (size_t)progress->block_count / 8 + 1);
    progress->done_count = 0;
    wh_tally_clear(&progress->tally);
}

bool wh_progress_has(const wh_progress_t *progress, uint64_t block) {
    return (progress->done[block / 8] >> block % 8 & 1) != 0;
}

void wh_progress_note(wh_progress_t *progress, uint64_t block) {
    if (!wh_progress_has(progress, block)) {
        progress->done[block / 8] = (unsigned char)(progress->done[block / 8] | 1U << block % 8);
        ++progress->done_count;
    }
}

void wh_progress_merge(wh_progress_t *progress, const wh_progress_t *other) {
    for (size_t i = 0; i <= (size_t)progress->block_count / 8; ++i) {
        progress->done[i] |= other->done[i];
    }
    progress->done_count += other->done_count;
    wh_tally_merge(&progress->tally, &other->tally);
}
