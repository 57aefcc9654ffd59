/* SPDX-License-Identifier: MIT
 *
 * collide, inside: turning slip by Taylor series in tau (d tau = dp / s), and the last way to u_t = 0 by a series at
 * its end.
 */
#ifndef IMPACT_COLLIDE_SERIES_H
#define IMPACT_COLLIDE_SERIES_H

#include "collide_course.h"

enum { IMPACT_SERIES_ORDER = 22, IMPACT_SERIES_MOST = 32 };

/* IMPACT_PAIR reads two numbers that stand side by side. */
typedef double impact_pair_anywhere __attribute__((vector_size(16), aligned(8), may_alias));
#define IMPACT_PAIR(from) ((impact_pair) * (const impact_pair_anywhere *)(from))

/* Coefficients to the order, and a zero after the last. */
enum { IMPACT_SERIES_ROOM = IMPACT_SERIES_MOST + 2 };

/* One Taylor step from the state of a course: coefficients of tau^k. The integrals (uz, p, work ...) start at 0 for tau
 * = 0. */
typedef struct impact_taylor {
    int order;
    double h;                                                                   /* how far the series may be used */
    double x[IMPACT_SERIES_ROOM], y[IMPACT_SERIES_ROOM], s[IMPACT_SERIES_ROOM]; /* u_t and |u_t| */
    double squared[IMPACT_SERIES_ROOM];                                         /* s^2, the rate of friction's work */
    double climb[IMPACT_SERIES_ROOM];                                           /* d uz / d tau */
} impact_taylor;

/* The polynomial at t, and its integral from 0 to t. */
double impact_taylor_value(const double *coefficient, int order, double t);
double impact_taylor_integral(const double *coefficient, int order, double t);

/* Fills a step of the given order; u_t != 0. */
void impact_taylor_make(impact_taylor *taylor, const impact_frame *frame, double mu, double ux, double uy, double s,
                        int order);

/* The whole way from (ux, uy, s), direction turning towards where T = 0 > T', R < 0, to u_t = 0. */
typedef struct impact_tail {
    double p, px, py;    /* impulse spent on the way, per M_zz / U as in the course */
    double rise;         /* change of uz */
    double work, work_f; /* of normal impulse, given uz at the start, and of friction */
} impact_tail;

/* False where the series does not converge to rounding (or the direction does not end there). */
bool impact_tail_make(impact_tail *tail, const impact_frame *frame, double mu, double ux, double uy, double s,
                      double uz);

/* The impact by series of the given order, straight pieces in one stride. False: not settled. */
bool impact_series_solve(impact_course *course, int order);

#endif
