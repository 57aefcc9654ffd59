/* SPDX-License-Identifier: MIT
 *
 * Ranks by MPI: one counter in rank 0's window, which all fetch and add to; nobody is the master. All calls come from
 * one thread at a time.
 */
#include "sweep_extra.h"

#include <mpi.h>

static MPI_Win window;
static long *counter;
static bool opened;

static const char *begin(int *rank, int *count)
{
    int level;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &level) != MPI_SUCCESS) return "MPI did not start";
    if (level < MPI_THREAD_SERIALIZED) return "this MPI is without threads";
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, count);
    return NULL;
}

static void open_counter(void)
{
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Win_allocate(rank == 0 ? sizeof *counter : 0, sizeof *counter, MPI_INFO_NULL, MPI_COMM_WORLD, &counter,
                     &window);
    if (rank == 0) {
        MPI_Win_lock(MPI_LOCK_EXCLUSIVE, 0, 0, window);
        *counter = 0;
        MPI_Win_unlock(0, window);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(0, window);
    opened = true;
}

static long take(long count)
{
    long before;
    MPI_Fetch_and_op(&count, &before, MPI_LONG, 0, 0, MPI_SUM, window);
    MPI_Win_flush(0, window);
    return before;
}

static void poll(void)
{
    int there;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
}

static void meet(void) { MPI_Barrier(MPI_COMM_WORLD); }

static long sum(long value)
{
    long all = value;
    MPI_Reduce(&value, &all, 1, MPI_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
    return all;
}

static void end(int code)
{
    if (!opened) MPI_Abort(MPI_COMM_WORLD, code); /* others may wait for this rank */
    MPI_Win_unlock_all(window);
    MPI_Win_free(&window);
    MPI_Finalize();
}

__attribute__((visibility("default"))) extern const impact_sweep_ranks impact_sweep_mpi;
const impact_sweep_ranks impact_sweep_mpi = {begin, open_counter, take, poll, meet, sum, end};
