#include "pool.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "../text/clock.h"

/* A worker shows what it has done when it is idle, and every so many seconds. */
#define SHOW_S 0.3

struct wh_pool_worker {
    wh_pool_t *pool;
    pthread_t thread;
    bool started;
    wh_worker_t player;
    wh_tally_t block;       /* of the running block */
    wh_progress_t progress; /* of the blocks since it was last shown */
    double shown;
};

/* ----------------------------------------------------------------------------------------------- progress */

void wh_progress_init(wh_progress_t *progress, const wh_study_t *study) {
    progress->block_count = wh_study_blocks(study);
    progress->done = wh_array_new((size_t)progress->block_count / 8 + 1, 1);
    wh_tally_init(&progress->tally, study->wafer_count);
}

void wh_progress_free(wh_progress_t *progress) {
    free(progress->done);
    wh_tally_free(&progress->tally);
}

bool wh_progress_has(const wh_progress_t *progress, uint64_t block) {
    return (progress->done[block / 8] >> block % 8 & 1) != 0;
}

void wh_progress_note(wh_progress_t *progress, uint64_t block) {
    progress->done[block / 8] = (unsigned char)(progress->done[block / 8] | 1U << block % 8);
}

void wh_progress_merge(wh_progress_t *progress, const wh_progress_t *other) {
    for (size_t i = 0; i <= (size_t)progress->block_count / 8; ++i) {
        progress->done[i] |= other->done[i];
    }
    wh_tally_merge(&progress->tally, &other->tally);
}

/* ------------------------------------------------------------------------------------- asked from outside */

void wh_pool_stop(wh_pool_t *pool) {
    __atomic_store_n(&pool->stop, true, __ATOMIC_RELAXED);
}

static bool is_stopped(const wh_pool_t *pool) {
    return __atomic_load_n(&pool->stop, __ATOMIC_RELAXED);
}

/* --------------------------------------------------------------------------------------------- one thread */

/* With the pool's lock held. */
static void show(wh_pool_worker_t *worker) {
    if (worker->progress.tally.trials > 0) {
        wh_progress_merge(&worker->pool->progress, &worker->progress);
        wh_progress_free(&worker->progress);
        wh_progress_init(&worker->progress, worker->pool->study);
    }
    worker->shown = wh_clock_seconds();
}

static void fail(wh_pool_worker_t *worker, uint64_t trial, const char *message) {
    wh_pool_t *pool = worker->pool;
    pthread_mutex_lock(&pool->lock);
    if (!pool->failed) {
        snprintf(pool->message, sizeof pool->message, "trial %llu: %s", (unsigned long long)trial, message);
    }
    pool->failed = true;
    pthread_mutex_unlock(&pool->lock);
    wh_pool_stop(pool);
}

/* Plays a block. One that is not finished is not counted. */
static void play_block(wh_pool_worker_t *worker, uint64_t block) {
    wh_pool_t *pool = worker->pool;
    const uint64_t trials = wh_study_block_trials(pool->study, block);
    char message[WH_SANDBOX_MESSAGE_BYTES] = "";
    for (uint64_t i = 0; i < trials; ++i) {
        const uint64_t trial = block * WH_STUDY_BLOCK + i;
        if (is_stopped(pool)) {
            return;
        }
        if (!wh_worker_play(&worker->player, trial, &worker->block, message)) {
            fail(worker, trial, message);
            return;
        }
    }
    wh_tally_merge(&worker->progress.tally, &worker->block);
    wh_tally_clear(&worker->block);
    wh_progress_note(&worker->progress, block);
}

/* The next block, or false when there will be none. */
static bool next_block(wh_pool_worker_t *worker, uint64_t *block) {
    wh_pool_t *pool = worker->pool;
    pthread_mutex_lock(&pool->lock);
    --pool->working;
    if (pool->from == pool->to || wh_clock_seconds() - worker->shown > SHOW_S) {
        show(worker);
    }
    pthread_cond_broadcast(&pool->changed);
    while (pool->from == pool->to && !pool->closed && !is_stopped(pool)) {
        pthread_cond_wait(&pool->changed, &pool->lock);
    }
    const bool any = pool->from < pool->to && !is_stopped(pool);
    if (any) {
        *block = pool->queue[pool->from++];
        ++pool->working;
    } else {
        show(worker);
        pthread_cond_broadcast(&pool->changed);
    }
    pthread_mutex_unlock(&pool->lock);
    return any;
}

static void *work(void *argument) {
    wh_pool_worker_t *worker = argument;
    uint64_t block = 0;
    worker->shown = wh_clock_seconds();
    while (next_block(worker, &block)) {
        play_block(worker, block);
    }
    return NULL;
}

/* ----------------------------------------------------------------------------------------------- the pool */

static bool start_worker(wh_pool_t *pool, wh_pool_worker_t *worker) {
    worker->pool = pool;
    wh_tally_init(&worker->block, pool->study->wafer_count);
    wh_progress_init(&worker->progress, pool->study);
    wh_worker_open(&worker->player, pool->study);
    ++pool->working;
    worker->started = pthread_create(&worker->thread, NULL, work, worker) == 0;
    return worker->started;
}

bool wh_pool_open(wh_pool_t *pool, const wh_study_t *study, size_t threads) {
    sigset_t all;
    sigset_t before;
    memset(pool, 0, sizeof *pool);
    pool->study = study;
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->changed, NULL);
    wh_progress_init(&pool->progress, study);
    pool->queue = wh_array_new((size_t)pool->progress.block_count, sizeof *pool->queue);
    pool->workers = wh_array_new(threads, sizeof *pool->workers);
    bool started = true;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    pthread_mutex_lock(&pool->lock);
    for (size_t i = 0; i < threads && started; ++i) {
        ++pool->worker_count;
        started = start_worker(pool, &pool->workers[i]);
    }
    pthread_mutex_unlock(&pool->lock);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

void wh_pool_queue(wh_pool_t *pool, const uint64_t blocks[], size_t count, bool closed) {
    pthread_mutex_lock(&pool->lock);
    if (pool->from == pool->to) {
        pool->from = pool->to = 0;
    }
    memcpy(&pool->queue[pool->to], blocks, count * sizeof *blocks);
    pool->to += count;
    pool->closed = closed;
    pthread_cond_broadcast(&pool->changed);
    pthread_mutex_unlock(&pool->lock);
}

size_t wh_pool_take(wh_pool_t *pool, uint64_t blocks[], size_t most) {
    pthread_mutex_lock(&pool->lock);
    const size_t left = pool->to - pool->from;
    const size_t count = most < left ? most : left;
    memcpy(blocks, &pool->queue[pool->from], count * sizeof *blocks);
    pool->from += count;
    pthread_mutex_unlock(&pool->lock);
    return count;
}

wh_pool_news_t wh_pool_look(wh_pool_t *pool) {
    pthread_mutex_lock(&pool->lock);
    const size_t queued = pool->to - pool->from;
    const bool done = pool->working == 0 && (queued == 0 || is_stopped(pool));
    const wh_pool_news_t news = {pool->progress.tally.trials, queued, pool->failed, pool->failed || done};
    pthread_mutex_unlock(&pool->lock);
    return news;
}

void wh_pool_wait(wh_pool_t *pool, int milliseconds) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += (long)milliseconds * 1000000;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_mutex_lock(&pool->lock);
    pthread_cond_timedwait(&pool->changed, &pool->lock, &until);
    pthread_mutex_unlock(&pool->lock);
}

void wh_pool_close(wh_pool_t *pool) {
    pthread_mutex_lock(&pool->lock);
    wh_pool_stop(pool);
    pthread_cond_broadcast(&pool->changed);
    pthread_mutex_unlock(&pool->lock);
    for (size_t i = 0; i < pool->worker_count; ++i) {
        wh_pool_worker_t *worker = &pool->workers[i];
        if (worker->started) {
            pthread_join(worker->thread, NULL);
        }
        wh_worker_close(&worker->player);
        wh_tally_free(&worker->block);
        wh_progress_free(&worker->progress);
    }
    free(pool->queue);
    free(pool->workers);
    wh_progress_free(&pool->progress);
    pthread_cond_destroy(&pool->changed);
    pthread_mutex_destroy(&pool->lock);
}
