#include "pool.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "../text/clock.h"

/* A worker shows its results when it is idle, and at this interval in seconds. */
#define SHOW_S 0.3

/* The most trials of a turn. */
#define MOST_TURN 4096

struct wh_pool_worker {
    wh_pool_t *pool;
    pthread_t thread;
    bool started;
    wh_worker_t player;
    wh_progress_t progress; /* since it was last shown */
    double shown;
    double cost_s; /* of a trial, as the last turn had it; 0: none yet */
};

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

/* Plays trials up to the first that is not usable, or until the pool must stop. Returns how many. */
static uint64_t play(wh_pool_worker_t *worker, wh_stretch_t turn) {
    char message[WH_SANDBOX_MESSAGE_BYTES] = "";
    for (uint64_t i = 0; i < turn.count; ++i) {
        if (is_stopped(worker->pool)) {
            return i;
        }
        if (!wh_worker_play(&worker->player, turn.first + i, &worker->progress.tally, message)) {
            fail(worker, turn.first + i, message);
            return i;
        }
    }
    return turn.count;
}

static void play_turn(wh_pool_worker_t *worker, wh_stretch_t turn) {
    const double begin = wh_clock_seconds();
    turn.count = play(worker, turn);
    (void)wh_stretches_add(&worker->progress.done, turn);
    if (turn.count > 0) {
        worker->cost_s = (wh_clock_seconds() - begin) / (double)turn.count;
    }
}

/* With the pool's lock held: how many trials to take. Before the first turn the cost of a trial is unknown.
 * At the end turns become shorter, so that no worker is left with many while the others wait. */
static uint64_t turn_length(wh_pool_worker_t *worker) {
    wh_pool_t *pool = worker->pool;
    const uint64_t share = pool->queue.trials / (2 * pool->worker_count) + 1;
    if (worker->cost_s > 0) {
        const double pace = WH_POOL_TURN_S / worker->cost_s;
        pool->pace = pace < 1 ? 1 : pace > MOST_TURN ? MOST_TURN : (uint64_t)pace;
    }
    return pool->pace < share ? pool->pace : share;
}

/* The next trials, or false when there will be none. */
static bool next_turn(wh_pool_worker_t *worker, wh_stretch_t *turn) {
    wh_pool_t *pool = worker->pool;
    pthread_mutex_lock(&pool->lock);
    --pool->working;
    if (pool->queue.trials == 0 || wh_clock_seconds() - worker->shown > SHOW_S) {
        show(worker);
    }
    pthread_cond_broadcast(&pool->changed);
    while (pool->queue.trials == 0 && !pool->closed && !is_stopped(pool)) {
        pthread_cond_wait(&pool->changed, &pool->lock);
    }
    const bool any = pool->queue.trials > 0 && !is_stopped(pool);
    if (any) {
        *turn = wh_stretches_take(&pool->queue, turn_length(worker));
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
    wh_stretch_t turn = {0, 0};
    worker->shown = wh_clock_seconds();
    while (next_turn(worker, &turn)) {
        play_turn(worker, turn);
    }
    return NULL;
}

/* ----------------------------------------------------------------------------------------------- the pool */

static bool start_worker(wh_pool_t *pool, wh_pool_worker_t *worker) {
    worker->pool = pool;
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
    pool->pace = 1;
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

void wh_pool_queue(wh_pool_t *pool, const wh_stretch_t stretches[], size_t count, bool closed) {
    pthread_mutex_lock(&pool->lock);
    for (size_t i = 0; i < count; ++i) {
        (void)wh_stretches_add(&pool->queue, stretches[i]);
    }
    pool->closed = closed;
    pthread_cond_broadcast(&pool->changed);
    pthread_mutex_unlock(&pool->lock);
}

wh_stretch_t wh_pool_take(wh_pool_t *pool, uint64_t most) {
    pthread_mutex_lock(&pool->lock);
    const wh_stretch_t taken = wh_stretches_take(&pool->queue, most);
    pthread_mutex_unlock(&pool->lock);
    return taken;
}

wh_pool_news_t wh_pool_look(wh_pool_t *pool) {
    pthread_mutex_lock(&pool->lock);
    const uint64_t queued = pool->queue.trials;
    const bool done = pool->working == 0 && (queued == 0 || is_stopped(pool));
    const wh_pool_news_t news = {pool->progress.tally.trials, queued, pool->pace, pool->failed,
                                 pool->failed || done};
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
        wh_progress_free(&worker->progress);
    }
    wh_stretches_free(&pool->queue);
    free(pool->workers);
    wh_progress_free(&pool->progress);
    pthread_cond_destroy(&pool->changed);
    pthread_mutex_destroy(&pool->lock);
}
