/* The calls, by MPI. */
#include <limits.h>

#include <mpi.h>

#include "ranks_calls.h"

#define TAG 1

static int open_ranks(int *rank, int *size) {
    int provided = 0;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS) {
        return -1;
    }
    if (provided < MPI_THREAD_FUNNELED) {
        MPI_Finalize();
        return -1;
    }
    return MPI_Comm_rank(MPI_COMM_WORLD, rank) | MPI_Comm_size(MPI_COMM_WORLD, size);
}

static int send_bytes(int to, const void *bytes, size_t size) {
    return size > INT_MAX ? -1 : MPI_Send(bytes, (int)size, MPI_BYTE, to, TAG, MPI_COMM_WORLD);
}

static int look(int *from, size_t *size) {
    int any = 0;
    int count = 0;
    MPI_Status status;
    if (MPI_Iprobe(MPI_ANY_SOURCE, TAG, MPI_COMM_WORLD, &any, &status) != MPI_SUCCESS) {
        return -1;
    }
    if (!any) {
        return 0;
    }
    MPI_Get_count(&status, MPI_BYTE, &count);
    *from = status.MPI_SOURCE;
    *size = (size_t)count;
    return 1;
}

static int receive(int from, void *bytes, size_t size) {
    return size > INT_MAX
               ? -1
               : MPI_Recv(bytes, (int)size, MPI_BYTE, from, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

static void close_ranks(void) {
    MPI_Finalize();
}

static void quit(int status) {
    MPI_Abort(MPI_COMM_WORLD, status);
}

const wh_ranks_calls_t wh_ranks_calls = {WH_RANKS_VERSION, open_ranks,  send_bytes, look,
                                         receive,          close_ranks, quit};
