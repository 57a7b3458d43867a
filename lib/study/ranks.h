/* A study on several ranks: rank 0 hands out trials and gathers what came of them. */
#ifndef WH_STUDY_RANKS_H
#define WH_STUDY_RANKS_H

#include "pool.h"
#include "ranks_calls.h"

/* Alone: rank 0 of 1, without calls. */
typedef struct {
    void *library;
    const wh_ranks_calls_t *calls; /* null: alone */
    int rank, size;
    int ended; /* rank 0: how many others have told all */
} wh_ranks_t;

/* How many ranks mpirun has started on this machine; 1 without it. */
int wh_ranks_here(void);

/* Joins the others when mpirun has started more than one, else alone. False, and the reason on stderr, when
 * the part of the program that speaks MPI is missing or does not start. */
bool wh_ranks_open(wh_ranks_t *ranks);

/* Rank 0: takes what has come, adds it to the pool's progress, and sends trials off its queue to who wants
 * some. False when a rank failed: the reason is on stderr. */
bool wh_ranks_serve(wh_ranks_t *ranks, wh_pool_t *pool);

/* Any other rank: plays what rank 0 sends, until there is no more. False when a trial was not usable, which
 * rank 0 then tells. */
bool wh_ranks_help(wh_ranks_t *ranks, wh_pool_t *pool, bool (*interrupted)(void));

/* `status` other than 0 ends all ranks at once with it, when there are others. */
void wh_ranks_close(wh_ranks_t *ranks, int status);

#endif
