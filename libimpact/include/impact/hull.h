/* SPDX-License-Identifier: MIT
 *
 * hull: convex polyhedra from points. A hull never changes once it is made; any number of shapes and threads share it.
 */
#ifndef IMPACT_HULL_H
#define IMPACT_HULL_H

#include <stddef.h>
#include <quat/quat.h>
#include "memory.h"
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct impact_hull impact_hull;

enum { IMPACT_HULL_POINTS = 256 }; /* at most */

/* The convex hull of 4 to 256 points (m), all their edges and corners rounded outwards by a ball of that radius (m, >=
 * 0). Which points are corners is decided exactly (Shewchuk 1997); triangles whose corners lie within 64 roundings of
 * their size in one plane are one face, and what is then no corner of three faces is dropped. The hull is held in the
 * frame of the centroid and the principal axes of the rounded body of one density; points about theirs to rounding
 * stay as they are.
 * allocator: used until impact_hull_destroy; NULL: malloc. message: when not NULL, up to size bytes of a sentence that
 * names what is wrong. IMPACT_EARGUMENT: fewer than 4 points or more than 256, a rounding < 0, points in one plane (but
 * for 64 roundings); IMPACT_EDOMAIN: a number that is not finite; IMPACT_ENOMEM. On failure *hull is NULL. */
IMPACT_API impact_status impact_hull_create(const qvec3 *points, size_t count, double rounding,
                                            const impact_allocator *allocator, impact_hull **hull, char *message,
                                            size_t size);
/* One more holder of the hull, from any thread: it lives until each has destroyed it. */
IMPACT_API impact_hull *impact_hull_share(const impact_hull *hull);
/* Ends the caller's hold; the last one's frees it, when no shape may use it any more. NULL is fine. */
IMPACT_API void impact_hull_destroy(impact_hull *hull);

typedef struct impact_hull_info {
    int vertices, edges, faces; /* Euler: vertices - edges + faces = 2 */
    int dropped;                /* points given that are no vertices */
    double rounding;            /* m */
    qvec3 center;               /* the hull's origin and axes in the frame of the points given: m, */
    quat axes;                  /* and hull to points */
} impact_hull_info;

IMPACT_API impact_hull_info impact_hull_describe(const impact_hull *hull);

/* Vertex 0 <= i < vertices, in the hull's frame, m; NaN for any other. */
IMPACT_API qvec3 impact_hull_vertex(const impact_hull *hull, int i);

/* The corners of face 0 <= i < faces, counter-clockwise seen from outside: how many (0 for another i); vertex, when not
 * NULL, has room for IMPACT_HULL_POINTS. *normal (NULL: not wanted): outward, unit. */
IMPACT_API int impact_hull_face(const impact_hull *hull, int i, int *vertex, qvec3 *normal);

#ifdef __cplusplus
}
#endif

#endif
