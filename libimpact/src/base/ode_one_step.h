/* SPDX-License-Identifier: MIT
 *
 * ode_one_step: what integrators share that choose their steps and remember none of those before: the step's length
 * and tolerances, its polynomial, and the roots on it. A method adds how a step is taken. Internal.
 */
#ifndef IMP_ODE_ONE_STEP_H
#define IMP_ODE_ONE_STEP_H

#include "base/ode_roots.h"

enum { IMP_ONE_STEP_TERMS = 9 };

typedef struct imp_one_step imp_one_step;

/* How a method takes its steps. */
typedef struct imp_one_step_method {
    int terms;   /* of its polynomial */
    int order;   /* its error goes as the length to that */
    int vectors; /* of its own, each as long as y; rates among them */
    /* A step from t as long as one->h and the limit let it be, t_stop not passed: y at its end, the rates at both, its
     * polynomial, and the next step's length. */
    impact_status (*take)(imp_one_step *one, double t, double t_stop, double *end);
} imp_one_step_method;

/* Its integrator begins with it. */
struct imp_one_step {
    impact_ode ode;
    const imp_one_step_method *method;
    double *memory;
    double *y, *before;               /* now; at the step's begin */
    double *first, *last;             /* rates there; the last is the next step's first */
    double *term[IMP_ONE_STEP_TERMS]; /* the last step's polynomial: y = sum_m term[m] s^m, s = (t - end)/h */
    double *absolute, *scale, *slope; /* slope: at a start, of the rate */
    const double *look;               /* up to which parts of a step roots are looked for, one after another */
    int looks;
    imp_ode_roots roots;
    double relative;
    double limit; /* of the step; 0: none */
    double h;     /* the next step's */
    bool fresh;   /* no step since the start: last and roots.value[1] are not those of y yet */
    bool at_root; /* the step was cut off: roots.state is the state now */
    impact_ode_counts counts;
};

/* Takes memory; its own vectors begin at *vectors. first, last and look are left to the method. */
impact_status imp_one_step_open(impact_ode *ode, const imp_one_step_method *method, double **vectors);

/* For a driver's table. */
void imp_one_step_close(impact_ode *ode);
void imp_one_step_resize(impact_ode *ode);
impact_status imp_one_step_start(impact_ode *ode, double t, const double *y);
bool imp_one_step_limit(impact_ode *ode, double max_step);
impact_status imp_one_step_set_tolerances(impact_ode *ode, double relative, const double *absolute, double same);
impact_status imp_one_step_go(impact_ode *ode, double t_stop, double *y, bool *found);
impact_status imp_one_step_interpolate(const impact_ode *ode, double t, int derivative, double *y);
impact_ode_counts imp_one_step_count(const impact_ode *ode);

/* For a method. */

typedef enum imp_one_step_outcome { IMP_STEP_STANDS, IMP_STEP_TOO_LONG, IMP_STEP_GAVE_UP } imp_one_step_outcome;

impact_status imp_one_step_gave_up(imp_one_step *one, double h);
/* A rounding of t is the shortest that a step can be. */
impact_status imp_one_step_too_short(imp_one_step *one);
/* f at t into rate. At t_stop, where it may jump, it is asked before that. */
imp_one_step_outcome imp_one_step_rate(imp_one_step *one, double t, double t_stop, const double *y, double *rate);
/* What counts in each component over a way h: the tolerance, but never what rounding makes of it. */
void imp_one_step_set_scale(imp_one_step *one, double h);
/* The greatest component, in scales. */
double imp_one_step_norm(const imp_one_step *one, const double *v);
/* The end of the step: t_stop, which a last step longer by a rounding reaches, no sliver being left over, or before. */
double imp_one_step_end(const imp_one_step *one, double t, double t_stop);
/* The polynomial's derivative at s, in t. At the end, s = 0, which is asked for most, that is one term. */
void imp_one_step_at(const imp_one_step *one, int derivative, double s, double h, double *y);

#endif
