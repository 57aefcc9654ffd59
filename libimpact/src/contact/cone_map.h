/* SPDX-License-Identifier: MIT
 *
 * cone_map: the problem without units, and its smoothed map. Internal to the cone solver.
 *
 * x = r d/(T Q), y = T û/Q, T = diag(1, mu, mu), d = tr W/3n, A = T W T/d, b = T q/Q: both cones become |x_t| <= x_n.
 * With z = x - y and lambda_1,2 = z_n -/+ |z_t|, f(lambda) = (lambda + sqrt(lambda² + 4 e²))/2:
 *
 *     x = f(z) in the cone's Jordan algebra, y = f(-z): x o y = e² 1 for every z        (Fukushima, Luo & Tseng 2002)
 *     F(z) = U(z) - A X(z) - b,   U = y - |y_t| n, as y_n - |y_t| = f(-lambda_2)
 *
 * A contact without friction is the number z_n alone. T has tau and rho for moments: of a contact with both friction of
 * its points (and spin) and of rolling, K is two such cones that share r_n, "lobes" 1 and 2, each with its z. With
 * s = f(-lambda_2) of each, they are tied by
 *
 *     x_n = (x1_n + x2_n)/2       u_n = s1 + s2       x1_n - x2_n = s1 - s2
 *
 * At e = 0 the last says both are equal, as s_i > 0 only where x_i = 0; and it never loses its rank.
 *
 * That path may begin, at e = 1, where it does not lead to e = 0: with friction F has several zeros there. On the path
 * where friction sets in, theta = 1 - e, from a b that z = 0 solves,
 *
 *     F(z) = y - theta |y_t| n - A X(z) - b(e),   b(e) = b + (1 - theta) l,   l: F(0) = 0 at e = 1
 *
 * there is but that zero: without |y_t| the problem is monotone. Where a motion takes the contacts apart, so that
 * x . A x >= c |x|² over the cones (encounter_wedge.c), x is bounded all along the path:
 *
 *     x . y = count e² = x . A x + x . b(e) + theta sum x_n |y_t|   =>   c |x|² <= count + |x| (|b| + |l|)
 *
 * and for almost every q the path is a smooth curve (Chow, Mallet-Paret & Yorke 1978): it ends at e = 0, in an answer.
 */
#ifndef IMP_CONE_MAP_H
#define IMP_CONE_MAP_H

#include "contact/cone.h"
#include "contact/held_linear.h"

typedef struct imp_cone_system {
    const imp_cone_problem *problem;
    int *order;      /* the problem's contacts in an order of their own */
    double d, size;  /* the scales, so that no units remain: the mean of W's diagonal; Q, the largest |q_c| */
    double eased;    /* alpha, what A's diagonal has too much */
    double end;      /* e, where paths end */
    bool kindles;    /* F is that of the path on which friction sets in */
    bool exact;      /* F is asked of the problem itself, in twice the precision */
    int count, n;    /* lobes, unknowns */
    int *start;      /* count + 1: each lobe's first unknown, its z_n; it has one to four */
    int *tied;       /* count: whether it shares its normal with the lobe before */
    int *row;        /* n: the problem's row of each unknown */
    double *scale;   /* n: its T */
    double *a, *b;   /* n^2 by rows, n */
    double *r, *own; /* of the problem: scratch */
    double *matrix, *spare, *scratch;
    int *rows, *columns;
    double *z, *trial, *step, *value, *x, *u, *rate, *kept, *tangent, *best, *lift; /* n each */
    int factorings, steps;
    double work;    /* multiplications of the factorings */
    int sign, rank; /* of the matrix taken apart last: of its determinant, 0 if singular */
} imp_cone_system;

/* X(z) and U(z). */
void imp_cone_values(const imp_cone_system *system, const double *z, double e, double *x, double *u);

/* F(z); returns its norm. */
double imp_cone_defect(imp_cone_system *system, const double *z, double e, double *value);

/* -dF/dz = A X' - U', taken apart: sign and rank. */
void imp_cone_factor(imp_cone_system *system, const double *z, double e);

/* Whether the work allowed is done: every path ends then. */
bool imp_cone_is_spent(const imp_cone_system *system);

/* The solution of it for a right-hand side, in place; of least norm where there are many. */
void imp_cone_back(imp_cone_system *system, double *right);

/* The problem's r of x. */
void imp_cone_reactions(const imp_cone_system *system, const double *x, double *r);

/* The problem's u = W r + q, each sum rounded once. */
void imp_cone_velocities(const imp_cone_problem *problem, const double *r, double *u);

/* dF/d(e²). */
void imp_cone_drift(imp_cone_system *system, const double *z, double e, double *rate);

/* Newton's steps at a fixed e from system->z until |F| <= wanted, each halved until |F| falls; false where that fails
 * within `most` steps, or where `positive` and a determinant is not above zero. The z of least |F| stays. */
bool imp_cone_newton(imp_cone_system *system, double e, double wanted, int most, bool positive);

/* Follows the central path from e = 1 down; the stage it took. What comes is as near the answer as the path led. */
imp_cone_stage imp_cone_follow(imp_cone_system *system);

/* The same by way of A + alpha 1: so much of it that contacts hardly feel each other down to e, there alpha to 0, then
 * on; false where that fails. */
bool imp_cone_follow_eased(imp_cone_system *system, double e);

/* Follows the path on which friction sets in; z is as near the answer as it led. */
void imp_cone_kindle(imp_cone_system *system);

/* Three times so many times over all contacts from r on, one after another; r[3 count] of points that do not resist
 * turning. How much of what r goes by at a sweep has changed since the last call, which lift (3 count) holds. */
double imp_cone_sweep(const imp_cone_system *system, long sweeps, double *r);

#endif
