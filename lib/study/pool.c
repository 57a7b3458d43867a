#include "pool.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A hand shows what it has done when it is idle, and every so many seconds. */
#define SHOW_S 0.3

struct wh_hand {
    wh_crew_t *crew;
    pthread_t thread;
    bool started;
    wh_worker_t worker;
    wh_tally_t block;       /* of the running block */
    wh_progress_t progress; /* of the blocks since it was last shown */
    double shown;
};

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void wh_crew_stop(wh_crew_t *crew) {
    __atomic_store_n(&crew->stop, true, __ATOMIC_RELAXED);
}

static bool is_stopped(const wh_crew_t *crew) {
    return __atomic_load_n(&crew->stop, __ATOMIC_RELAXED);
}

uint64_t wh_crew_trials(const wh_crew_t *crew) {
    return __atomic_load_n(&crew->trials, __ATOMIC_RELAXED);
}

/* ----------------------------------------------------------------------------------------------------- one thread */

/* With the crew's lock held. */
static void show(wh_hand_t *hand) {
    if (hand->progress.done_count > 0) {
        wh_progress_merge(&hand->crew->progress, &hand->progress);
        wh_progress_clear(&hand->progress);
    }
    hand->shown = seconds_now();
}

static void fail(wh_hand_t *hand, uint64_t trial, const char *message) {
    wh_crew_t *crew = hand->crew;
    pthread_mutex_lock(&crew->lock);
    if (!crew->failed) {
        snprintf(crew->message, sizeof crew->message, "trial %llu: %s", (unsigned long long)trial, message);
    }
    crew->failed = true;
    pthread_mutex_unlock(&crew->lock);
    wh_crew_stop(crew);
}

/* A block that is not finished counts for nothing. */
static void play_block(wh_hand_t *hand, uint64_t block) {
    wh_crew_t *crew = hand->crew;
    const uint64_t trials = wh_study_block_trials(crew->study, block);
    char message[WH_SANDBOX_MESSAGE_BYTES] = "";
    for (uint64_t i = 0; i < trials; ++i) {
        const uint64_t trial = block * WH_STUDY_BLOCK + i;
        if (is_stopped(crew)) {
            return;
        }
        if (!wh_worker_play(&hand->worker, trial, &hand->block, message)) {
            fail(hand, trial, message);
            return;
        }
    }
    __atomic_fetch_add(&crew->trials, trials, __ATOMIC_RELAXED);
    wh_tally_merge(&hand->progress.tally, &hand->block);
    wh_tally_clear(&hand->block);
    wh_progress_note(&hand->progress, block);
}

/* The next block, or false when there will be none. */
static bool next_block(wh_hand_t *hand, uint64_t *block) {
    wh_crew_t *crew = hand->crew;
    pthread_mutex_lock(&crew->lock);
    --crew->working;
    if (crew->from == crew->to || seconds_now() - hand->shown > SHOW_S) {
        show(hand);
    }
    pthread_cond_broadcast(&crew->changed);
    while (crew->from == crew->to && !crew->closed && !is_stopped(crew)) {
        pthread_cond_wait(&crew->changed, &crew->lock);
    }
    const bool any = crew->from < crew->to && !is_stopped(crew);
    if (any) {
        *block = crew->queue[crew->from++];
        ++crew->working;
    } else {
        show(hand);
        pthread_cond_broadcast(&crew->changed);
    }
    pthread_mutex_unlock(&crew->lock);
    return any;
}

static void *work(void *argument) {
    wh_hand_t *hand = argument;
    uint64_t block = 0;
    hand->shown = seconds_now();
    while (next_block(hand, &block)) {
        play_block(hand, block);
    }
    return NULL;
}

/* ------------------------------------------------------------------------------------------------------ the crew */

static bool start_hand(wh_crew_t *crew, wh_hand_t *hand) {
    hand->crew = crew;
    wh_tally_init(&hand->block, crew->study->wafer_count);
    wh_progress_init(&hand->progress, crew->study);
    if (!wh_worker_open(&hand->worker, crew->study)) {
        return false;
    }
    ++crew->working;
    hand->started = pthread_create(&hand->thread, NULL, work, hand) == 0;
    return hand->started;
}

bool wh_crew_open(wh_crew_t *crew, const wh_study_t *study, size_t threads) {
    sigset_t all;
    sigset_t before;
    memset(crew, 0, sizeof *crew);
    crew->study = study;
    pthread_mutex_init(&crew->lock, NULL);
    pthread_cond_init(&crew->changed, NULL);
    wh_progress_init(&crew->progress, study);
    crew->queue = calloc((size_t)crew->progress.block_count + 1, sizeof *crew->queue);
    crew->hands = calloc(threads, sizeof *crew->hands);
    bool started = crew->queue && crew->hands;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    pthread_mutex_lock(&crew->lock);
    for (size_t i = 0; i < threads && started; ++i) {
        ++crew->hand_count;
        started = start_hand(crew, &crew->hands[i]);
    }
    pthread_mutex_unlock(&crew->lock);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

void wh_crew_queue(wh_crew_t *crew, const uint64_t blocks[], size_t count, bool closed) {
    pthread_mutex_lock(&crew->lock);
    if (crew->from == crew->to) {
        crew->from = crew->to = 0;
    }
    memcpy(&crew->queue[crew->to], blocks, count * sizeof *blocks);
    crew->to += count;
    crew->closed = closed;
    pthread_cond_broadcast(&crew->changed);
    pthread_mutex_unlock(&crew->lock);
}

size_t wh_crew_take(wh_crew_t *crew, uint64_t blocks[], size_t most) {
    pthread_mutex_lock(&crew->lock);
    const size_t left = crew->to - crew->from;
    const size_t count = most < left ? most : left;
    memcpy(blocks, &crew->queue[crew->from], count * sizeof *blocks);
    crew->from += count;
    pthread_mutex_unlock(&crew->lock);
    return count;
}

size_t wh_crew_queued(wh_crew_t *crew) {
    pthread_mutex_lock(&crew->lock);
    const size_t count = crew->to - crew->from;
    pthread_mutex_unlock(&crew->lock);
    return count;
}

bool wh_crew_failed(wh_crew_t *crew) {
    pthread_mutex_lock(&crew->lock);
    const bool failed = crew->failed;
    pthread_mutex_unlock(&crew->lock);
    return failed;
}

bool wh_crew_is_idle(wh_crew_t *crew) {
    pthread_mutex_lock(&crew->lock);
    const bool idle = crew->failed || (crew->working == 0 && (crew->from == crew->to || is_stopped(crew)));
    pthread_mutex_unlock(&crew->lock);
    return idle;
}

void wh_crew_wait(wh_crew_t *crew, int milliseconds) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += (long)milliseconds * 1000000;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_mutex_lock(&crew->lock);
    pthread_cond_timedwait(&crew->changed, &crew->lock, &until);
    pthread_mutex_unlock(&crew->lock);
}

void wh_crew_close(wh_crew_t *crew) {
    pthread_mutex_lock(&crew->lock);
    wh_crew_stop(crew);
    pthread_cond_broadcast(&crew->changed);
    pthread_mutex_unlock(&crew->lock);
    for (size_t i = 0; i < crew->hand_count; ++i) {
        wh_hand_t *hand = &crew->hands[i];
        if (hand->started) {
            pthread_join(hand->thread, NULL);
        }
        wh_worker_close(&hand->worker);
        wh_tally_free(&hand->block);
        wh_progress_free(&hand->progress);
    }
    free(crew->queue);
    free(crew->hands);
    wh_progress_free(&crew->progress);
    pthread_cond_destroy(&crew->changed);
    pthread_mutex_destroy(&crew->lock);
}
