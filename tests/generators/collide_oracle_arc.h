/* SPDX-License-Identifier: MIT
 *
 * The closed hodograph of turning slip in 128-bit arithmetic: s(theta) as a product of powers of sines of the distances
 * to the roots of T, and the integrals of s/T and s^2/T over theta.
 */
#ifndef COLLIDE_ORACLE_ARC_H
#define COLLIDE_ORACLE_ARC_H

#include <quadmath.h>
#include <stdbool.h>

typedef __float128 real;
typedef __complex128 complex_real;

enum { X, Y, N };

/* M = [[a, 0, c], [0, b, d], [c, d, m]] in the principal tangential frame, friction, and the velocity u at
 * the start. */
typedef struct slip {
    real a, b, c, d, m, mu, u[3];
} slip;

enum { ARC_NODES = 24, ARC_MOST_PANELS = 4000 };

/* Integrals of s/T and of s^2/T from the start of the arc to the place x. */
typedef struct arc_edge {
    real x, p, ss;
} arc_edge;

/* theta runs from theta0 in the sense of `sign` through `span` to the root `end` of T. A place is named by
 * x = log(way / left), way + left = span, so that both ends are as sharp as the middle. */
typedef struct arc {
    const slip *flow;
    int count, end;            /* of roots: 4, or 2 where a = b */
    complex_real offset[4];    /* of the roots from theta0, the end's being sign span */
    complex_real exponent[4];  /* gamma = R / T' */
    complex_real cotangent[4]; /* of half the distance from root to theta0 */
    int times[4];              /* 1 for a real root; 2 and 0 for the two of a conjugate pair */
    real theta0, sign, span, s0, T0, gamma_end;
    real node[ARC_NODES], weight[ARC_NODES]; /* Gauss-Legendre on [-1, 1] */
    real highest[2][ARC_NODES];              /* weights of the highest two Legendre coefficients */
    arc_edge least;                          /* integrals of this size matter */
    arc_edge *edge;
    int edges;
    bool complete; /* the last edge is the end itself: nothing is left beyond it */
} arc;

typedef struct arc_place {
    real s, theta, p, ss;
    real rate; /* dp/dx */
} arc_place;

/* T at theta0 is nothing but rounding of 128 bits: the slip is straight. */
bool arc_is_straight(const slip *flow);

/* False: a double root of T. arc_free after it in any case. */
bool arc_make(arc *ar, const slip *flow);
void arc_free(arc *ar);

/* Integrates on to at least x, or until nothing is left (gamma_end > 0 only). False: too far. */
bool arc_extend(arc *ar, real x);

/* At x, within what has been integrated. */
arc_place arc_at(const arc *ar, real x);

/* The place x at which theta - theta0 = sign way, 0 < way < span. */
real arc_place_of(const arc *ar, real way);

/* The edge in the middle of those strictly between x1 and x2; false when there is none. */
bool arc_edge_between(const arc *ar, real x1, real x2, real *x);

/* An angle into [0, 2 pi). */
real arc_wrapped(real angle);

#endif
