/* Threads that play the blocks of a study. */
#ifndef WH_STUDY_POOL_H
#define WH_STUDY_POOL_H

#include <pthread.h>

#include "trial.h"

/* What is kept of a study's progress: which blocks are done, and what came of them. */
typedef struct {
    uint64_t block_count;
    unsigned char *done; /* bit b % 8 of byte b / 8 */
    wh_tally_t tally;
} wh_progress_t;

/* Memory that runs out ends the program. */
void wh_progress_init(wh_progress_t *progress, const wh_study_t *study);
void wh_progress_free(wh_progress_t *progress);
bool wh_progress_has(const wh_progress_t *progress, uint64_t block);
void wh_progress_note(wh_progress_t *progress, uint64_t block);

/* Adds what another has done, none of it done twice. */
void wh_progress_merge(wh_progress_t *progress, const wh_progress_t *other);

typedef struct wh_pool_worker wh_pool_worker_t;

/* Fields are read and written under `lock`, but for `stop`, which is read and written as an atomic. */
typedef struct {
    const wh_study_t *study;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    uint64_t *queue; /* blocks to be played, `from` up to `to` */
    size_t from, to;
    bool closed;    /* nothing more will be queued */
    bool failed;    /* a trial was not usable */
    size_t working; /* workers that are not waiting */
    wh_progress_t progress;
    char message[WH_SANDBOX_MESSAGE_BYTES + 64];
    bool stop; /* leave everything and end: see wh_pool_stop */
    wh_pool_worker_t *workers;
    size_t worker_count;
} wh_pool_t;

/* Starts `threads` threads, without work yet; `study` must outlive them. Their signals are blocked. False
 * when there is no memory or thread for them; to be closed either way. */
bool wh_pool_open(wh_pool_t *pool, const wh_study_t *study, size_t threads);

/* Queues blocks; with `closed` no more will come. */
void wh_pool_queue(wh_pool_t *pool, const uint64_t blocks[], size_t count, bool closed);

/* Takes up to `most` blocks off the queue, for someone else to play. Returns how many. */
size_t wh_pool_take(wh_pool_t *pool, uint64_t blocks[], size_t most);

/* How things stand. */
typedef struct {
    uint64_t trials; /* done, as far as `progress` has them */
    size_t queued;   /* blocks */
    bool failed;     /* a trial was not usable; `message` then says why */
    bool idle; /* it has failed; or the workers wait, all they did is in `progress`, and nothing is queued */
} wh_pool_news_t;

wh_pool_news_t wh_pool_look(wh_pool_t *pool);

/* Makes the workers leave what they are at. */
void wh_pool_stop(wh_pool_t *pool);

/* Waits up to so many milliseconds for anything to change. */
void wh_pool_wait(wh_pool_t *pool, int milliseconds);

/* Ends the threads. Blocks that they have not finished are given up. */
void wh_pool_close(wh_pool_t *pool);

#endif
