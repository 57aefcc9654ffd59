/* SPDX-License-Identifier: MIT
 *
 * surface: parametric surfaces: quaternion frames and the curvature that follows from their derivatives, integrals,
 * quaternion Gauss maps on patches. In libquat, but for quat_surface_total, in the library quat_gsl. Conventions in
 * quat.h; ready-made surfaces in family.h.
 *
 * A frame's columns (body x, y, z axes in the world) are T1, T2, N: orthonormal, N = x_u x x_v/|x_u x x_v|. Its rates
 * are the body-frame vectors a and b of q_u = q (0, a)/2 and q_v = q (0, b)/2. With
 *   J = [[x_u.T1, x_v.T1], [x_u.T2, x_v.T2]]   and   M = [[a_y, b_y], [-a_x, -b_x]],
 * M J^-1 is the derivative dN of the normal in the basis T1, T2, whatever the parameters and whatever the frame's angle
 * about N: K = det M/det J, H = tr(M J^-1)/2. Sign: that of dN. A sphere of radius R with its normal outward has
 * principal curvatures +1/R and H = +1/R: the second fundamental form's with the sign turned (II/I gives -1/R). K has
 * no such choice.
 */
#ifndef QUAT_SURFACE_H
#define QUAT_SURFACE_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sets d[0] = x(u, v); for `known` >= 1 also d[1] = x_u, d[2] = x_v; for `known` = 2 also d[3] = x_uu, d[4] = x_uv,
 * d[5] = x_vv. False where there is no value: QUAT_EDOMAIN below, as for an infinite or NaN value. */
typedef bool (*quat_surface_function)(double u, double v, qvec3 d[6], void *context);

/* A surface over u0 <= u <= u1, v0 <= v <= v1; closed_u, closed_v: periodic with that period. The function is called
 * inside the rectangle only. Derivatives that are not known are taken by differences of the highest known ones. */
typedef struct quat_surface {
    quat_surface_function at;
    void *context;
    double u0, u1, v0, v1;
    bool closed_u, closed_v;
    int known; /* 0, 1, 2 */
} quat_surface;

/* ---- at a point ---- */

/* What the frame's rates say of the curvature. */
typedef struct quat_curvature {
    double gauss, mean;  /* K, H */
    double principal[2]; /* the larger first */
    qvec3 direction[2];  /* unit, in the world; direction[0] x direction[1] = N */
    double asymmetry;    /* |difference of the off-diagonal elements of M J^-1|: 0 for the frames of a surface */
} quat_curvature;

/* The curvature from a frame q in any gauge, its rates a and b, and the tangents x_u and x_v. QUAT_NOT_UNIQUE at an
 * umbilic (principal curvatures equal to rounding): the directions are T1 and T2 then. QUAT_EDOMAIN and all zero when
 * x_u and x_v are parallel, one is zero or 1e15 times the other, for infinite and NaN and a q that cannot be
 * normalised; QUAT_ERANGE and all zero when products overflow. */
QUAT_API quat_status quat_curvature_of_frame(quat q, qvec3 a, qvec3 b, qvec3 xu, qvec3 xv, quat_curvature *curvature);

/* The frame turned by `angle` about N, where the angle grows at angle_u and angle_v: q exp(k angle/2) and its rates. */
QUAT_API void quat_regauge(double angle, double angle_u, double angle_v, quat *q, qvec3 *a, qvec3 *b);

typedef struct quat_surface_point {
    qvec3 position, xu, xv;
    quat frame;       /* the coordinate gauge: T1 along x_u; w >= 0 */
    qvec3 a, b;       /* its rates */
    double first[3];  /* E, F, G of E du^2 + 2 F du dv + G dv^2 */
    double second[3]; /* L, M, N: x_uu.N, x_uv.N, x_vv.N */
    double area;      /* |x_u x x_v| */
    quat_curvature curvature;
    double error; /* an estimate of the error of the principal curvatures */
} quat_surface_point;

/* Everything at (u, v), through the frame's rates. QUAT_NOT_UNIQUE at an umbilic. QUAT_NOT_CONVERGED where `error`
 * comes to 1e-3 of the curvatures or of one over the surface's extent: beside a pole, when differences are all there
 * is, within about 1e-5 of it, otherwise within 1e-11. QUAT_EDOMAIN: outside an open range, infinite or NaN; no value;
 * a degenerate point (x_u x x_v = 0 to rounding, such as the pole of a sphere's angles): all zero then, frame = 1, but
 * for the position if there is one. QUAT_ERANGE: lengths outside 1e-100 ... 1e100, where products overflow or vanish.
 * QUAT_EARGUMENT: a surface without a function, empty or infinite ranges, `known` outside 0 ... 2. With differences of
 * x alone, errors of about 1e-10 of the curvature's size. */
QUAT_API quat_status quat_surface_at(const quat_surface *surface, double u, double v, quat_surface_point *point);

/* The largest component of a_v - b_u - a x b for the coordinate gauge, with a_v and b_u by differences: 0 for the
 * frames of a surface, to about 1e-10 of the rates' own size. It is the condition that the rates belong to a field of
 * frames at all; its z part is Gauss' K |x_u x x_v| = a_z,v - b_z,u. Statuses as above. */
QUAT_API quat_status quat_surface_integrability(const quat_surface *surface, double u, double v, double *residual);

/* ---- over the surface ---- */

typedef struct quat_surface_totals {
    double area;
    double gauss;   /* integral of K over the area; 2 pi chi for a closed surface (Gauss, Bonnet) */
    double mean;    /* integral of H */
    double bending; /* integral of H^2: 4 pi or more for a closed surface (Willmore) */
} quat_surface_totals;

/* Of the library quat_gsl. Product rules of 16, 32, 64 points each way until two in a row agree to `tolerance`
 * (relative; at least 1e-14): Gauss-Legendre across an open range, equal steps around a closed one. Where they do not,
 * the worst of up to 500 rectangles (50 when x alone is known) is halved until all agree with their halves. Degenerate
 * edges (poles) do no harm; they are not asked. QUAT_NOT_CONVERGED with the last values otherwise, also when the
 * points' own errors leave more than `tolerance`. QUAT_ERANGE when one overflows. Other statuses as quat_surface_at's,
 * and QUAT_ENOMEM. */
QUAT_API quat_status quat_surface_total(const quat_surface *surface, double tolerance, quat_surface_totals *totals);

/* ---- quaternion Gauss maps ---- */

/* Over each point of a patch lies a circle of frames, q exp(k phi/2), that share the normal q k q*. A quaternion Gauss
 * map takes one from each. Which one:
 *   QUAT_SHORTEST        the shortest rotations from a frame of the normals' mean over the area; or, when the patch
 *                        covers the opposite of that and it gives fewer whirls, frames carried from node 0 along edges,
 *                        ring after ring
 *   QUAT_MINIMAL_LENGTH  least sum over the triangles' edges of cot(opposite angle)/2 |q_i - q_j|^2: a discrete
 *                        Dirichlet energy, which approaches the integral of |q_1|^2 + |q_2|^2, the squared stretch on
 *                        S^3 in two perpendicular directions, over the patch
 *   QUAT_MINIMAL_AREA    from there on, least sum of the areas of the triangles q_i q_j q_k in R^4; where that gains
 *                        less than 1e-9 of it, as before. It knows the surface by its normals alone */
typedef enum quat_gauge { QUAT_SHORTEST, QUAT_MINIMAL_LENGTH, QUAT_MINIMAL_AREA } quat_gauge;

typedef struct quat_gauge_report {
    double energy; /* of lengths, as above */
    double area;   /* of the image on S^3, by flat triangles */
    size_t rounds; /* of the minimisation */
    size_t torn;   /* edges whose ends lie on opposite sides of S^3, by a hole in the mesh or a whirl; 0 is good */
} quat_gauge_report;

/* Chooses frames over a connected triangle mesh of n nodes at x[i] and m triangles, three indices each; q[i] comes in
 * as any frame with the node's normal as its z axis and goes out as chosen, continuous on S^3. q[0] stays as it is: all
 * frames together can be turned about their normals without any cost. report may be NULL. QUAT_EARGUMENT: no nodes or
 * triangles, an index out of range, a mesh in several parts. QUAT_EDOMAIN: a q that cannot be normalised, infinite or
 * NaN. QUAT_NOT_UNIQUE: two neighbours with opposite normals. QUAT_NOT_CONVERGED with the best frames. QUAT_ENOMEM. */
QUAT_API quat_status quat_choose_frames(size_t n, const qvec3 x[], size_t m, const size_t triangles[], quat_gauge gauge,
                                        quat q[], quat_gauge_report *report);

/* A rectangle of a surface as a mesh for quat_choose_frames: rows x columns nodes (at least 2 each), u along the rows,
 * at equal steps from u0 to u1 and v0 to v1; node [i * columns + j] with position x[] and coordinate frame q[], and 2
 * (rows - 1) (columns - 1) triangles, three indices each. QUAT_EARGUMENT for fewer nodes or an empty rectangle;
 * QUAT_EDOMAIN where quat_surface_at has it: keep off the poles. */
QUAT_API quat_status quat_surface_patch(const quat_surface *surface, double u0, double u1, double v0, double v1,
                                        size_t rows, size_t columns, qvec3 x[], quat q[], size_t triangles[]);

/* How two Gauss maps of the same normals differ along a seam of n points: s = q2* q1 = exp(k angle/2), the angle of
 * q1's frame in q2's. (t = q1 q2*, the thesis' form, turns about the normal, which moves; s stays on one fixed circle.)
 * angle[i] (may be NULL) is continuous, the first in -pi ... pi. *turns (may be NULL) is how often the angle goes round
 * from first to last: for a closed seam, with the last point the first again, a whole number; -2 around the equator of
 * a sphere from the northern to the southern patch, counter-clockwise seen from north: minus its Euler number. *off
 * (may be NULL) is the largest angle between the normals. QUAT_NOT_UNIQUE when the angle goes by more than 3/8 of a
 * turn from one point to the next: half a turn could be either way, take more points. QUAT_EARGUMENT for n < 1;
 * QUAT_EDOMAIN when normals differ by more than 1e-6 rad or a quaternion cannot be normalised. */
QUAT_API quat_status quat_transition(size_t n, const quat q1[], const quat q2[], double angle[], double *turns,
                                     double *off);

#ifdef __cplusplus
}
#endif

#endif
