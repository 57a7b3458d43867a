/* A study on several ranks: rank 0 hands out trials and gathers their results. */
#ifndef WH_STUDY_RANKS_H
#define WH_STUDY_RANKS_H

#include "pool.h"
#include "ranks_calls.h"

/* Alone: rank 0 of 1, without calls. */
typedef struct {
    void *library;
    const wh_ranks_calls_t *calls; /* null: alone */
    int rank, size;
    int ended; /* rank 0: how many other ranks have told everything */
} wh_ranks_t;

/* How many ranks mpirun has started on this machine; 1 without it. */
int wh_ranks_here(void);

/* Joins the others when mpirun has started more than one, else alone. False, and the reason on stderr, when
 * the part of the program that speaks MPI is missing or does not start. */
bool wh_ranks_open(wh_ranks_t *ranks);

/* Rank 0: takes the messages that have come, adds them to the pool's progress, and sends trials off its queue
 * to ranks that want some. False when a rank failed: the reason is on stderr. */
bool wh_ranks_serve(wh_ranks_t *ranks, wh_pool_t *pool);

/* Any other rank: plays the trials that rank 0 sends, until there are no more. False when a trial was not
 * usable, which rank 0 then tells. */
bool wh_ranks_help(wh_ranks_t *ranks, wh_pool_t *pool, bool (*interrupted)(void));

/* A `status` other than 0 ends all ranks at once with that status, if there are others. */
void wh_ranks_close(wh_ranks_t *ranks, int status);

#endif
