/* SPDX-License-Identifier: MIT
 *
 * gltf_keys: a body's motion by straight lines and slerp. Internal.
 */
#ifndef IMP_GLTF_KEYS_H
#define IMP_GLTF_KEYS_H

#include <impact/run.h>
#include "base/arena.h"

typedef struct imp_gltf_key {
    double t;
    qvec3 x;
    quat q;      /* next to its neighbours': their dot products are positive */
    double turn; /* rad/s */
} imp_gltf_key;

/* Keys of the body, in a block of the arena: lines and slerp between them meet the record within tolerance times the
 * body's size and tolerance rad, but where they stand least_step apart. NULL: out of memory. */
imp_gltf_key *imp_gltf_keys(imp_arena *arena, const impact_run *run, int body, double tolerance, int *count);

#endif
