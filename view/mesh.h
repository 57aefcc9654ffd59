/* SPDX-License-Identifier: MIT
 *
 * mesh: a body's surface as triangles of two kinds, so that turning is seen. Internal.
 */
#ifndef IMP_MESH_H
#define IMP_MESH_H

#include <impact/scene.h>
#include "run/text.h"

/* Counter-clockwise seen from outside, in the body's frame. Kind 0: the octants of the shape's axes of which an even
 * number are negative; 1: the others. */
typedef struct imp_mesh {
    imp_text points, normals; /* three floats each; normals are unit */
    imp_text index[2];        /* uint32_t, three a triangle */
} imp_mesh;

/* Of any shape but a plane, in memory of the arena. False: out of memory; either way to be freed. */
bool imp_mesh_of(imp_arena *arena, const impact_body_def *body, imp_mesh *mesh);
void imp_mesh_free(imp_mesh *mesh);

#endif
