/* SPDX-License-Identifier: MIT
 *
 * dense: the polynomial of one step of the integrator, y(tau) = sum over j of c_j s^j, s = (tau - end)/h in [-1, 0]: of
 * the whole state of an island (motion_equations.h). The variable tau is time, or where the clock is slowed a variable
 * of its own with t = y[0]. Internal.
 */
#ifndef IMP_DENSE_H
#define IMP_DENSE_H

#include "world/world.h"

enum {
    IMP_DENSE_TERMS = 13, /* CVODE's Adams methods go to order 12 */
    IMP_DENSE_AT_ONCE = 6 /* components whose rates are asked for: a body's velocity and momentum */
};

/* What a body can do over [t, t + window], no less. */
typedef struct imp_bounds {
    qvec3 acceleration; /* at t, m/s^2 */
    qvec3 torque;       /* at t, N m */
    double speed;       /* |x'|, m/s */
    double jerk;        /* |x'''|, m/s^3 */
    double momentum;    /* |L|, N m s */
    double most_torque; /* |L'|, N m */
    double torque_rate; /* |L''|, N m/s */
} imp_bounds;

/* What was last asked of a body: every pair that it is near asks the same. */
typedef struct imp_dense_seen {
    double t, window; /* NaN: nothing so far */
    imp_bounds bounds;
} imp_dense_seen;

typedef struct imp_dense {
    double t0, t1;        /* s: the part of the step that the segment is */
    double end, h;        /* tau at the end of the step, and its length */
    int size, terms;      /* of y; of the polynomial */
    bool clocked;         /* tau is not time */
    bool stepped;         /* a pile's: what touches in it may overlap by what its steps err */
    bool fixed;           /* its length is not the motion's: no shorter behind an event */
    double *c;            /* terms x size */
    int room;             /* doubles that c has room for */
    imp_dense_seen *seen; /* of each body that moves; NULL: not kept */
    int seen_room;
} imp_dense;

/* Room for all terms of so many components, of so many bodies; what was there before is lost. */
impact_status imp_dense_reserve(imp_dense *dense, imp_arena *arena, int size, int bodies);

/* y at the time t, of the components first .. first + count - 1. */
void imp_dense_at(const imp_dense *dense, double t, int first, int count, double *y);
/* s at the time t; and y there. */
double imp_dense_place(const imp_dense *dense, double t);
void imp_dense_there(const imp_dense *dense, double s, int first, int count, double *y);
/* tau where y[0] = t. */
double imp_dense_tau(const imp_dense *dense, double t);
/* From the place s on, w of the step: [t, t + window], or up to the segment's end. */
typedef struct imp_dense_window {
    double s, w;
} imp_dense_window;
imp_dense_window imp_dense_window_of(const imp_dense *dense, double t, double window);
/* One component over a window, in tau: its value and rate at its start, and no less than the sizes of its value, rate
 * and second derivative over it, from the sums of the polynomial's terms about there. count <= IMP_DENSE_AT_ONCE. */
typedef struct imp_dense_rate {
    double value, rate, most, most_rate, most_second;
} imp_dense_rate;
void imp_dense_rates(const imp_dense *dense, imp_dense_window at, int first, int count, imp_dense_rate *rates);
/* dy/dt at s, no bounds: a third of the work. */
void imp_dense_slopes(const imp_dense *dense, double s, int first, int count, double *slopes);
/* y_i, its rate and its second at s, by t: of a step whose variable is time. */
void imp_dense_jet(const imp_dense *dense, double s, int i, double jet[3]);

#endif
