/* Ranks: the processes of one program that mpirun has started, on one machine or many.
 *
 * The program itself does not depend on MPI: the calls are in a shared object of their own, which is loaded
 * only under mpirun. It exports one symbol, wh_ranks_calls. All calls are to be made by one thread.
 */
#ifndef WH_STUDY_RANKS_CALLS_H
#define WH_STUDY_RANKS_CALLS_H

#include <stddef.h>

/* The version: it changes with the declarations below. */
#define WH_RANKS_VERSION 1

typedef struct {
    int version; /* WH_RANKS_VERSION */
    /* Begins; ranks are 0 to size - 1. 0, or not when MPI does not start. */
    int (*open)(int *rank, int *size);
    /* Sends some bytes; they may be reused when it returns. Up to INT_MAX of them. 0, or not. */
    int (*send)(int to, const void *bytes, size_t size);
    /* Looks for a message without waiting. Returns 1, its sender and its size; 0 if there is none; below 0 on
     * failure. */
    int (*look)(int *from, size_t *size);
    /* Takes a message that `look` has found. 0, or not. */
    int (*receive)(int from, void *bytes, size_t size);
    /* Ends, once all ranks do. */
    void (*close)(void);
    /* Ends all ranks at once with this exit status. */
    void (*quit)(int status);
} wh_ranks_calls_t;

extern const wh_ranks_calls_t wh_ranks_calls;

#endif
