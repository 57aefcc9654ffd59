/* SPDX-License-Identifier: MIT
 *
 * collide, inside: turning slip by Taylor series in sigma (d sigma = Lambda dp / s), and the last way to u_t = 0 by a
 * series at its end.
 */
#ifndef IMP_COLLIDE_SERIES_H
#define IMP_COLLIDE_SERIES_H

#include "collide/collide_course.h"

/* The order itself, and the largest that can be asked for; steps of one impact: three are many, but where the slip
 * slows down and turns at rates far apart (slender bodies), as many as their ratio. */
#ifdef IMP_SECOND
enum { IMP_SERIES_ORDER = 40, IMP_SERIES_MOST = 40, IMP_SERIES_STEPS = 400 };
#else
enum { IMP_SERIES_ORDER = 22, IMP_SERIES_MOST = 32, IMP_SERIES_STEPS = 4000 };
#endif

/* IMP_LANES reads two numbers that stand side by side. */
typedef imp_real imp_lanes_anywhere
    __attribute__((vector_size(2 * sizeof(imp_real)), aligned(sizeof(imp_real)), may_alias));
#define IMP_LANES(from) ((imp_lanes) * (const imp_lanes_anywhere *)(from))

/* Coefficients to the order, and a zero after the last. */
enum { IMP_SERIES_ROOM = IMP_SERIES_MOST + 2 };

/* One Taylor step from the state of a course: coefficients of sigma^k. The integrals (uz, p, work ...) start at 0 for
 * sigma = 0; those of s and u_t are to be taken times `rate`. */
typedef struct imp_taylor {
    int order;
    imp_real h;                                                          /* how far the series may be used */
    imp_real rate;                                                       /* d tau / d sigma = 1 / Lambda */
    imp_real x[IMP_SERIES_ROOM], y[IMP_SERIES_ROOM], s[IMP_SERIES_ROOM]; /* u_t and |u_t| */
    imp_real squared[IMP_SERIES_ROOM];                                   /* s^2, the rate of friction's work */
    imp_real climb[IMP_SERIES_ROOM];                                     /* d uz / d sigma */
} imp_taylor;

/* The polynomial at t, and its integral from 0 to t. */
imp_real imp_taylor_value(const imp_real *coefficient, int order, imp_real t);
imp_real imp_taylor_integral(const imp_real *coefficient, int order, imp_real t);

/* Fills a step of the given order; u_t != 0. */
void imp_taylor_make(imp_taylor *taylor, const imp_frame *frame, imp_real mu, imp_real ux, imp_real uy, imp_real s,
                     int order);

/* The whole way from (ux, uy, s), direction turning towards where T = 0 > T', R < 0, to u_t = 0. */
typedef struct imp_tail {
    imp_real p, px, py;    /* impulse spent on the way, per M_zz / U as in the course */
    imp_real rise;         /* change of uz */
    imp_real work, work_f; /* of normal impulse, given uz at the start, and of friction */
} imp_tail;

/* False where the series does not converge to rounding (or the direction does not end there). */
bool imp_tail_make(imp_tail *tail, const imp_frame *frame, imp_real mu, imp_real ux, imp_real uy, imp_real s,
                   imp_real uz);

/* The impact by series of the given order, straight pieces in one stride. False: not settled. */
bool imp_series_solve(imp_course *course, int order);

#endif
