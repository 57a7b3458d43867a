/* A study from beginning to end: threads, ranks, the state that it goes on from, and its progress on a
 * terminal. */
#ifndef WH_STUDY_STUDY_PLAY_H
#define WH_STUDY_STUDY_PLAY_H

#include "pool.h"
#include "ranks.h"

typedef struct {
    /* Threads of this process. 0: one for each processor, shared with the other ranks on the machine. */
    size_t threads;
    const char *state; /* the file that keeps the progress; null: a place of its own, emptied at the end */
} wh_study_options_t;

typedef enum {
    WH_STUDY_DONE,        /* all is in `progress` */
    WH_STUDY_INTERRUPTED, /* by a signal; the progress is kept */
    WH_STUDY_FAILED,      /* the reason is on stderr */
    WH_STUDY_HELPED       /* another rank has the result */
} wh_study_end_t;

/* The number of threads: `wanted`, or if that is 0 one for each processor, shared with the other ranks on the
 * machine. */
size_t wh_study_threads(size_t wanted);

/* Plays the remaining trials of an opened study. `progress` is filled in, to be freed by wh_progress_free,
 * when the study is done. */
wh_study_end_t wh_study_play(const wh_study_t *study, const wh_study_options_t *options, wh_ranks_t *ranks,
                             wh_progress_t *progress);

#endif
