/* SPDX-License-Identifier: MIT
 *
 * gap: the signed distance of two convex bodies, its normal and its witness points.
 */
#ifndef IMPACT_GAP_H
#define IMPACT_GAP_H

#include <quat/quat.h>
#include "shape.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A shape and where it stands: body to world is x_world = position + orientation x_body orientation*. */
typedef struct impact_solid {
    impact_shape shape;
    qvec3 position;   /* m, world */
    quat orientation; /* normalised on use; zero or NaN is refused */
} impact_solid;

/* Which road answered. */
typedef enum impact_gap_path {
    IMPACT_PATH_NONE,
    IMPACT_PATH_CLOSED_FORM,
    IMPACT_PATH_NEWTON, /* from the cached or the centre-line seed */
    IMPACT_PATH_GJK,    /* Newton from libccd's seed */
    IMPACT_PATH_FALLBACK,
    IMPACT_PATH_CCD /* libccd itself: impact_gap_ccd */
} impact_gap_path;

/* What the last query of one pair leaves for the next. Start from zeros; one per pair; never required (NULL). */
typedef struct impact_gap_cache {
    bool valid;
    qvec3 normal; /* world */
} impact_gap_cache;

typedef struct impact_contact {
    double gap;             /* m; > 0 separated, < 0 overlapping */
    qvec3 normal;           /* unit, world, from body 2 to body 1 */
    qvec3 point1, point2;   /* witness points, world, m */
    qvec3 offset1, offset2; /* the same relative to each body's position, exact when bodies are far from the origin */
    double stiffness; /* smallest eigenvalue of the gap's Hessian in the tangent plane, m; small: the witness points are
                         soft */
    double lower, upper; /* bracket of the gap, m; equal to gap when settled */
    impact_gap_path path;
} impact_contact;

/* The gap of two solids: any shapes but two planes (IMPACT_EARGUMENT, as for a shape that impact_shape_check refuses).
 * cache may be NULL. IMPACT_OK: settled, the bracket closed to 2e-14 (L + |c|) or better, L the largest semi-axis and c
 * between the positions; an overlap deeper than 5 % of the smallest semi-axis or of the radii at the contact, or of two
 * bodies with edges, is then proved the nearest way out, or one of several equally near. With an answer too:
 * IMPACT_DEEP, a way out that no other is nearer than by more than the bracket; IMPACT_BRACKET, the gap lies in [lower,
 * upper]. There too lower is g along the normal, so that body 1 moved by -lower along it has left an overlap; the
 * points are where the normal touches the bodies, on their surfaces and lower apart along it, but they need not face
 * each other (else point1 - point2 = gap normal, to the same 2e-14). Both brackets of an overlap are at most one per
 * cent of its depth wide, but where the work allowed is not enough: then upper is the distance of the centres or 0. Two
 * polytopes (boxes, polyhedra, capsules, octahedra, and spheres with them) are exact in any overlap. IMPACT_EDOMAIN: a
 * position that is not finite, an orientation that is zero or not finite. A negative status leaves every number of
 * *contact NaN. Method: docs/gap.md.
 */
IMPACT_API impact_status impact_gap(const impact_solid *body1, const impact_solid *body2, impact_gap_cache *cache,
                                    impact_contact *contact);

/* The gap as libccd has it, by GJK and EPA on the bodies' support functions: its own depth and direction, of the
 * bodies' difference inflated by a ball, so that it is seen apart too. tolerance, in [1e-7, 1e-2], is what EPA is asked
 * for, in units of the larger body's largest semi-axis; it keeps that of well-rounded bodies, but its normal only to
 * the root of it. The witness points are the support points along the normal; lower = upper = gap; stiffness is NaN.
 * Pairs with a plane, two spheres and two polytopes are answered in closed form, as impact_gap does. IMPACT_EUNSETTLED:
 * after several balls its answer is still 30 tolerances off the gap of its own normal, or took more than 600 support
 * points; *contact is then the last one. IMPACT_EABSENT: this build has no libccd; IMPACT_EARGUMENT: a tolerance out of
 * its range; else refuses what impact_gap does. libccd takes its polytope by malloc. Slower and less exact than
 * impact_gap: here to be compared with (docs/report.md). Source: van den Bergen, "Proximity queries and penetration
 * depth computation on 3D game objects", 2001. */
IMPACT_API impact_status impact_gap_ccd(const impact_solid *body1, const impact_solid *body2, double tolerance,
                                        impact_contact *contact);

/* Residuals of an answer in eps (L + |c|); of normal in eps. */
typedef struct impact_gap_residuals {
    double normal; /* |n| - 1; against a plane also its distance from the plane's normal */
    double dual;   /* lower against g(n) = n.c - h_2(n) - h_1(-n), which is no more than the gap */
    double primal; /* apart: the points' distance beyond upper; overlapping: n.(x_1 - x_2) beyond either end */
    double order;  /* of lower, gap and upper */
    double inside1, inside2; /* the witness points' distances outside their bodies, to first order */
} impact_gap_residuals;

/* Checks an answer by the solids and the contact alone, by none of the solver's formulas; the worst residual, infinite
 * for NaN. residuals may be NULL. Right answers (IMPACT_OK, and IMPACT_DEEP) stay below 20, and
 * impact_gap takes no others. Solids that impact_gap refuses have no receipt: the answer means nothing. */
IMPACT_API double impact_gap_receipt(const impact_solid *body1, const impact_solid *body2,
                                     const impact_contact *contact, impact_gap_residuals *residuals);

/* d(gap)/dt in m/s for the bodies' velocities (m/s, world, of the positions) and angular velocities (rad/s, world):
 * exactly normal . (u1 - u2), u the velocities of the witness points. */
IMPACT_API double impact_gap_rate(const impact_contact *contact, qvec3 velocity1, qvec3 omega1, qvec3 velocity2,
                                  qvec3 omega2);

#ifdef __cplusplus
}
#endif

#endif
