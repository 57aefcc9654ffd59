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
    quat q;             /* next to its neighbours': their dot products are positive */
    double speed, turn; /* m/s, rad/s */
} imp_gltf_key;

typedef struct imp_gltf_way {
    double tolerance;
    double frame_rate; /* 1/s: of the scene in Blender that they are for */
} imp_gltf_way;

/* Keys of the body, in a block of the arena: lines and slerp between them meet the record within tolerance times the
 * body's size and tolerance rad, but where they stand as close as they may. *off is raised to what they are off by
 * there, at most, in the same units; to infinity where a body turns by more than a radian in that. NULL: out of memory.
 */
imp_gltf_key *imp_gltf_keys(imp_arena *arena, const impact_run *run, int body, const imp_gltf_way *way, int *count,
                            double *off);

#endif
