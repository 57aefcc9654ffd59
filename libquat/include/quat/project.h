/* SPDX-License-Identifier: MIT
 *
 * project: spheres seen on the flat space below them, S^3 in space, S^2 on the plane, S^1 on the line; and S^3 over S^2
 * (Hopf). Conventions in quat.h. Points of S^3 keep their sign: q and -q are two points.
 *
 * The coordinate that is lost is w for S^3, z for S^2 and y for S^1; "north" is where it is 1, "south" where it is -1.
 * Points may have any finite non-zero length: it is p/|p| that is projected.
 */
#ifndef QUAT_PROJECT_H
#define QUAT_PROJECT_H

#include "rotation.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- stereographic: along the line from a pole, on the equator's flat space ---- */

/* The pole that is projected from. From the south pole the northern half falls inside the unit ball, the southern one
 * outside; from the north pole the other way round. The thesis takes the south pole for S^3 (its section 5.4.1 says
 * "north", but 1 goes to 0 there) and the north pole for S^1 and S^2 (figure 4). */
typedef enum quat_pole { QUAT_SOUTH_POLE = -1, QUAT_NORTH_POLE = 1 } quat_pole;

/* v/(1 + w) from the south pole -1, v/(1 - w) from the north pole 1; v the vector part of q/|q|. Every component to 5
 * rounding units of its own, also close to the pole, where v/(1 + w) as it stands keeps no digit. The pole itself gives
 * QUAT_AT_INFINITY and an image of infinities, and so does a q so close to it (1e-308) that the image overflows.
 * QUAT_EDOMAIN and *image = 0 for zero, infinite and NaN, QUAT_EARGUMENT and *image = 0 for an unknown pole. */
QUAT_API quat_status quat_stereographic(quat q, quat_pole pole, qvec3 *image);
/* The unit quaternion with this image: ((1 - r^2), 2 x)/(1 + r^2) from the south pole, r = |x|; w and each component to
 * 4 rounding units of its own, also close to the equator r = 1. An infinite component (and no NaN) gives the pole.
 * NaN for NaN and for an unknown pole. */
QUAT_API quat quat_from_stereographic(qvec3 image, quat_pole pole);

/* The same for S^2 on the plane z = 0: (x, y)/(1 - z) from the north pole. */
QUAT_API quat_status quat_stereographic_sphere(qvec3 p, quat_pole pole, qvec2 *image);
QUAT_API qvec3 quat_from_stereographic_sphere(qvec2 image, quat_pole pole);
/* The same for S^1 on the line y = 0: x/(1 - y) from the north pole. */
QUAT_API quat_status quat_stereographic_circle(qvec2 p, quat_pole pole, double *image);
QUAT_API qvec2 quat_from_stereographic_circle(double image, quat_pole pole);

/* ---- orthographic: straight down, the thesis' square-root method ---- */

/* The vector part of q/|q|, a point of the unit ball, and in *half (may be NULL) the sign of w, which the image does
 * not hold: 1, -1, or 0 on the boundary. QUAT_EDOMAIN, *image = 0 and *half = 0 for zero, infinite and NaN. */
QUAT_API quat_status quat_orthographic(quat q, qvec3 *image, int *half);
/* The unit quaternion (w, image) with w = half sqrt((1 - n)(1 + n)), n = |image|. The root is right to 2 rounding units
 * for the image as it is given; an image that was itself rounded knows w to 1e-16/w only. half = 0 asks for a point of
 * the boundary. An image outside the ball by no more than rounding (n^2 <= 1 + 2^-50) is put on the boundary, w = 0;
 * farther out, or with half = 0 farther in, it is put there too and the status is QUAT_EDOMAIN. QUAT_EDOMAIN and *q = 1
 * for infinite and NaN and for (0, 0, 0) with half = 0, QUAT_EARGUMENT and *q = 1 for another half than -1, 0 and 1. */
QUAT_API quat_status quat_from_orthographic(qvec3 image, int half, quat *q);

/* The same for S^2 on the plane (*half: the sign of z) and for S^1 on the line (the sign of y). With the errors that
 * give *q = 1 above, *p is the north pole. */
QUAT_API quat_status quat_orthographic_sphere(qvec3 p, qvec2 *image, int *half);
QUAT_API quat_status quat_from_orthographic_sphere(qvec2 image, int half, qvec3 *p);
QUAT_API quat_status quat_orthographic_circle(qvec2 p, double *image, int *half);
QUAT_API quat_status quat_from_orthographic_circle(double image, int half, qvec2 *p);

/* ---- arrays: each element as the function above gives it; n = 0 is allowed, with any pointers ---- */

/* The status is the gravest of all elements': a failure, else a reason, else QUAT_OK. *first (may be NULL) is the index
 * of the first element that has it; n when all are QUAT_OK. half may be NULL in quat_orthographic_array. */
QUAT_API quat_status quat_stereographic_array(size_t n, const quat q[], quat_pole pole, qvec3 image[], size_t *first);
QUAT_API void quat_from_stereographic_array(size_t n, const qvec3 image[], quat_pole pole, quat q[]);
QUAT_API quat_status quat_orthographic_array(size_t n, const quat q[], qvec3 image[], int half[], size_t *first);
QUAT_API quat_status quat_from_orthographic_array(size_t n, const qvec3 image[], const int half[], quat q[],
                                                  size_t *first);

/* ---- Hopf (1931): each point of S^2 has a great circle of S^3 above it ---- */

/* The point of S^2 below unit q: q k q*, where the rotation carries the z axis; the same for q exp(k t), whatever t. */
QUAT_INLINE qvec3 quat_hopf(quat q) { return quat_rotate(q, qvec3_make(0, 0, 1)); }
/* The point of the fibre over p (any finite non-zero length) at angle t (rad): q0 exp(k t), q0 the shortest rotation
 * from z to p; t = 0 ... 2 pi goes round once. Over -z every q0 is as short: j is taken, and the status is
 * QUAT_NOT_UNIQUE. QUAT_EDOMAIN and *q = 1 for zero, infinite and NaN. */
QUAT_API quat_status quat_hopf_fibre(qvec3 p, double t, quat *q);
/* The angle of unit q on its fibre, -pi ... pi: the t of quat_hopf_fibre, exp(k t) being q's twist about z. */
QUAT_API double quat_hopf_angle(quat q);

#ifdef __cplusplus
}
#endif

#endif
