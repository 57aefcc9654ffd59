/* SPDX-License-Identifier: MIT
 *
 * Many impacts at once. Each is a pure function of its own input, so that the threads only share the work out: in
 * blocks, by an atomic counter.
 */
#include "collide/collide_check.h"
#include "collide/collide_cvode.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

enum { BLOCK = 256, MOST_THREADS = 256 };

typedef struct batch {
    const impact_collision *collisions;
    size_t count;
    impact_outcome *outcomes;
    impact_status *statuses;
    atomic_size_t next;
    _Atomic size_t first_failure;
    _Atomic int failure;
    pthread_mutex_t lock;
} batch;

static void note_failure(batch *b, size_t index, impact_status status)
{
    pthread_mutex_lock(&b->lock);
    if (index < b->first_failure) {
        b->first_failure = index;
        b->failure = (int)status;
    }
    pthread_mutex_unlock(&b->lock);
}

/* This thread's own workspace, of the same kind as the one given. */
typedef struct own_workspace {
    const impact_collide_workspace *pattern;
    impact_collide_workspace *workspace;
} own_workspace;

/* By CVODE, as the collision has it or with this thread's own workspace in place of the pattern. */
static impact_status by_cvode(own_workspace *own, impact_collision c, bool checks, impact_outcome *outcome)
{
    if (!own->workspace || own->pattern != c.workspace) {
        impact_collide_workspace_destroy(own->workspace);
        own->pattern = c.workspace;
        /* Without one, the call says what is wrong. */
        if (imp_cvode_workspace_like(c.workspace, &own->workspace) != IMPACT_OK) own->workspace = NULL;
    }
    c.workspace = own->workspace;
    return imp_collide(&c, checks, outcome);
}

static void one(batch *b, size_t i, own_workspace *own)
{
    const impact_collision *c = &b->collisions[i];
    const bool cvode = c->solver == IMPACT_SOLVER_CVODE || c->friction_law || c->tangential_compliance > 0;
    const bool checks = c->checking == IMPACT_CHECK_ALWAYS;
    const impact_status status =
        cvode ? by_cvode(own, *c, checks, &b->outcomes[i]) : imp_collide(c, checks, &b->outcomes[i]);
    if (b->statuses) b->statuses[i] = status;
    if (status < 0) note_failure(b, i, status);
}

static void *work(void *context)
{
    batch *b = context;
    own_workspace own = {0};
    for (;;) {
        const size_t from = atomic_fetch_add(&b->next, BLOCK);
        if (from >= b->count) break;
        const size_t to = from + BLOCK < b->count ? from + BLOCK : b->count;
        for (size_t i = from; i < to; i++) one(b, i, &own);
    }
    impact_collide_workspace_destroy(own.workspace);
    return NULL;
}

/* One where the system does not say how many it has. */
static int machine_threads(void)
{
#if defined(_SC_NPROCESSORS_ONLN)
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
#else
    const long n = 1;
#endif
    return n < 1 ? 1 : n > MOST_THREADS ? MOST_THREADS : (int)n;
}

impact_status impact_collide_many(const impact_collision *collisions, size_t count, int threads,
                                  impact_outcome *outcomes, impact_status *statuses)
{
    if (threads < 0 || threads > MOST_THREADS) return IMPACT_EARGUMENT;
    if (threads == 0) threads = machine_threads();
    batch b = {.collisions = collisions, .count = count, .outcomes = outcomes, .statuses = statuses};
    atomic_init(&b.next, 0);
    atomic_init(&b.first_failure, SIZE_MAX);
    atomic_init(&b.failure, IMPACT_OK);
    if (pthread_mutex_init(&b.lock, NULL) != 0) return IMPACT_ENOMEM;
    pthread_t others[MOST_THREADS];
    int started = 0;
    /* A thread that cannot be had leaves its share to the others. */
    while (started < threads - 1 && pthread_create(&others[started], NULL, work, &b) == 0) started++;
    work(&b);
    for (int i = 0; i < started; i++) pthread_join(others[i], NULL);
    pthread_mutex_destroy(&b.lock);
    return (impact_status)b.failure;
}
