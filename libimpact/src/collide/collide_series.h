/* SPDX-License-Identifier: MIT
 *
 * collide, inside: turning slip by Taylor series in tau (d tau = dp / s), and the last way to u_t = 0 by a series at
 * its end.
 */
#ifndef IMP_COLLIDE_SERIES_H
#define IMP_COLLIDE_SERIES_H

#include "collide/collide_course.h"

enum { IMP_SERIES_ORDER = 22, IMP_SERIES_MOST = 32 };

/* IMP_PAIR reads two numbers that stand side by side. */
typedef double imp_pair_anywhere __attribute__((vector_size(16), aligned(8), may_alias));
#define IMP_PAIR(from) ((imp_pair) * (const imp_pair_anywhere *)(from))

/* Coefficients to the order, and a zero after the last. */
enum { IMP_SERIES_ROOM = IMP_SERIES_MOST + 2 };

/* One Taylor step from the state of a course: coefficients of tau^k. The integrals (uz, p, work ...) start at 0 for tau
 * = 0. */
typedef struct imp_taylor {
    int order;
    double h;                                                          /* how far the series may be used */
    double x[IMP_SERIES_ROOM], y[IMP_SERIES_ROOM], s[IMP_SERIES_ROOM]; /* u_t and |u_t| */
    double squared[IMP_SERIES_ROOM];                                   /* s^2, the rate of friction's work */
    double climb[IMP_SERIES_ROOM];                                     /* d uz / d tau */
} imp_taylor;

/* The polynomial at t, and its integral from 0 to t. */
double imp_taylor_value(const double *coefficient, int order, double t);
double imp_taylor_integral(const double *coefficient, int order, double t);

/* Fills a step of the given order; u_t != 0. */
void imp_taylor_make(imp_taylor *taylor, const imp_frame *frame, double mu, double ux, double uy, double s, int order);

/* The whole way from (ux, uy, s), direction turning towards where T = 0 > T', R < 0, to u_t = 0. */
typedef struct imp_tail {
    double p, px, py;    /* impulse spent on the way, per M_zz / U as in the course */
    double rise;         /* change of uz */
    double work, work_f; /* of normal impulse, given uz at the start, and of friction */
} imp_tail;

/* False where the series does not converge to rounding (or the direction does not end there). */
bool imp_tail_make(imp_tail *tail, const imp_frame *frame, double mu, double ux, double uy, double s, double uz);

/* The impact by series of the given order, straight pieces in one stride. False: not settled. */
bool imp_series_solve(imp_course *course, int order);

#endif
