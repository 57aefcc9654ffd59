/* SPDX-License-Identifier: MIT
 *
 * memory: where scenes and workspaces take their memory from, and how much of it they may hold.
 */
#ifndef IMPACT_MEMORY_H
#define IMPACT_MEMORY_H

#include <stddef.h>
#include "export.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All zero: malloc and free, without a bound. Both functions or neither. A scene or workspace takes few, growing pieces
 * (each as large as all before it together) and releases every one of them when it is destroyed, in the thread that
 * destroys it. Called from whatever thread the scene or workspace is used in, and from no other. */
typedef struct impact_allocator {
    void *(*allocate)(size_t size, void *context); /* size > 0; aligned as malloc's; NULL: there is no more */
    void (*release)(void *piece, size_t size, void *context); /* what allocate gave, with the size it was asked for */
    void *context;
    size_t limit; /* bytes that one scene or workspace holds at most; 0: no bound */
} impact_allocator;

/* What a scene or workspace holds, bytes. SUNDIALS' own two pieces an integrator are beside it (see ode.h). */
typedef struct impact_memory {
    size_t held;   /* taken from the allocator */
    size_t used;   /* of it, handed out now */
    size_t most;   /* the largest `used` there was */
    size_t wanted; /* the request that was refused last; 0: none */
    long pieces;   /* taken from the allocator */
} impact_memory;

#ifdef __cplusplus
}
#endif

#endif
