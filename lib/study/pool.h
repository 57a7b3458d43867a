/* Threads that play the trials of a study. */
#ifndef WH_STUDY_POOL_H
#define WH_STUDY_POOL_H

#include <pthread.h>

#include "progress.h"
#include "trial.h"

typedef struct wh_pool_worker wh_pool_worker_t;

/* A worker takes as many trials off the queue as it can play in about this time: one, if each takes
 * longer. */
#define WH_POOL_TURN_S 0.02

/* Fields are read and written under `lock`, except `stop`, which is read and written as an atomic. */
typedef struct {
    const wh_study_t *study;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    wh_stretches_t queue; /* trials to be played */
    uint64_t pace;        /* the number of trials that a worker plays in WH_POOL_TURN_S, as far as known */
    bool closed;          /* nothing more will be queued */
    bool failed;          /* a trial was not usable */
    size_t working;       /* workers that are not waiting */
    wh_progress_t progress;
    char message[WH_SANDBOX_MESSAGE_BYTES + 64];
    bool stop; /* leave everything and end: see wh_pool_stop */
    wh_pool_worker_t *workers;
    size_t worker_count;
} wh_pool_t;

/* Starts `threads` threads, without work yet; `study` must outlive them. Their signals are blocked. False
 * when there is no memory or thread for them; to be closed either way. */
bool wh_pool_open(wh_pool_t *pool, const wh_study_t *study, size_t threads);

/* Queues trials, none of which was queued before; with `closed` no more will come. */
void wh_pool_queue(wh_pool_t *pool, const wh_stretch_t stretches[], size_t count, bool closed);

/* Takes up to `most` trials off the queue, for someone else to play. */
wh_stretch_t wh_pool_take(wh_pool_t *pool, uint64_t most);

/* How things stand. */
typedef struct {
    uint64_t trials; /* done, as far as `progress` has them */
    uint64_t queued; /* trials */
    uint64_t pace;   /* as of the pool */
    bool failed;     /* a trial was not usable; `message` then says why */
    bool idle; /* it has failed; or the workers wait, all their results are in `progress`, and nothing is
                * queued */
} wh_pool_news_t;

wh_pool_news_t wh_pool_look(wh_pool_t *pool);

/* Makes the workers stop their present work. */
void wh_pool_stop(wh_pool_t *pool);

/* Waits up to this number of milliseconds for any change. */
void wh_pool_wait(wh_pool_t *pool, int milliseconds);

/* Ends the threads. Trials that they have not finished are given up. */
void wh_pool_close(wh_pool_t *pool);

#endif
