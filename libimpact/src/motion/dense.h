/* SPDX-License-Identifier: MIT
 *
 * dense: the polynomial of one step of the integrator, y(tau) = sum over j of c_j s^j, s = (tau - end)/h in [-1, 0]: of
 * the whole state of an island (motion_equations.h). The variable tau is time, or where the clock is slowed a variable
 * of its own with t = y[0]. Internal.
 */
#ifndef IMP_DENSE_H
#define IMP_DENSE_H

#include "world/world.h"

enum { IMP_DENSE_TERMS = 13 }; /* CVODE's Adams methods go to order 12 */

typedef struct imp_dense {
    double t0, t1;   /* s: the part of the step that the segment is */
    double end, h;   /* tau at the end of the step, and its length */
    int size, terms; /* of y; of the polynomial */
    bool clocked;    /* tau is not time */
    bool stepped;    /* a pile's: what touches in it may overlap by what its steps err */
    bool fixed;      /* its length is not the motion's: no shorter behind an event */
    double *c;       /* terms x size */
    int room;        /* doubles that c has room for */
} imp_dense;

/* Room for all terms of so many components; what was there before is lost. */
impact_status imp_dense_reserve(imp_dense *dense, imp_arena *arena, int size);

/* y at the time t, of the components first .. first + count - 1. */
void imp_dense_at(const imp_dense *dense, double t, int first, int count, double *y);
/* s at the time t; and y there. */
double imp_dense_place(const imp_dense *dense, double t);
void imp_dense_there(const imp_dense *dense, double s, int first, int count, double *y);
/* tau where y[0] = t. */
double imp_dense_tau(const imp_dense *dense, double t);
/* One component over [t, t + window], in tau: its value and rate at t, and no less than the sizes of its value, rate
 * and second derivative over the window, from the sums of the polynomial's terms about t. */
typedef struct imp_dense_rate {
    double value, rate, most, most_rate, most_second;
} imp_dense_rate;
void imp_dense_rates(const imp_dense *dense, double t, double window, int first, int count, imp_dense_rate *rates);
/* dy/dt at s, no bounds: a third of the work. */
void imp_dense_slopes(const imp_dense *dense, double s, int first, int count, double *slopes);

#endif
