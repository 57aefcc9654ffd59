/* SPDX-License-Identifier: MIT
 *
 * ode: y' = f(t, y) to the next root of g(t, y), by SUNDIALS' CVODE, by collocation, or by Runge-Kutta methods of order
 * 8, and of order 4 with a fixed step. Without IMPACT_WITH_CVODE, impact_ode_create answers IMPACT_EABSENT to the
 * methods of CVODE.
 */
#ifndef IMPACT_ODE_H
#define IMPACT_ODE_H

#include <stddef.h>
#include "memory.h"
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct impact_ode impact_ode; /* one integrator with its workspace; not shared between threads */

typedef enum impact_ode_method {
    IMPACT_ODE_ADAMS, /* CVODE, orders 1 to 12, with fixed-point iteration */
    IMPACT_ODE_BDF,   /* CVODE, orders 1 to 5, with Newton and a dense difference-quotient Jacobian */
    /* The classical method of order 4 with def.step throughout: no error is looked at, tolerances mean nothing, and a
     * right-hand side that asks for a smaller step ends it. Roots, and samples between the ends, by the step's cubic
     * Hermite polynomial, of order 4 too. */
    IMPACT_ODE_RK4,
    /* Collocation at Lobatto's eight nodes, of order 14, with a step of its own choice and fixed-point iteration: for
     * smooth problems that are not stiff; no memory of the steps before is needed, so that a start costs little. Roots
     * are looked for between the nodes; samples by the step's polynomial, of degree 8, to the tolerance. */
    IMPACT_ODE_LOBATTO,
    /* Dormand and Prince's explicit Runge-Kutta method of order 8 (Hairer's DOP853), with a step of its own choice: for
     * motion that is not smooth for long, or that asks for shorter and shorter steps. Roots are looked for in both
     * halves of a step; samples by its polynomial of order 7. */
    IMPACT_ODE_DOP853
} impact_ode_method;

/* y' into rate[n]. Return 0; > 0: try a smaller step; < 0: give up. */
typedef int impact_ode_rhs(double t, const double *y, double *rate, void *context);
/* g into value[roots], NaN where it does not cross. Return 0, or non-zero to give up. */
typedef int impact_ode_roots(double t, const double *y, double *value, void *context);

typedef struct impact_ode_def {
    size_t struct_size; /* sizeof(impact_ode_def): a later version may have more fields */
    int size;           /* n >= 1 */
    int roots;          /* >= 0 */
    impact_ode_rhs *rhs;
    impact_ode_roots *root_functions; /* may be NULL when roots = 0 */
    bool falling_roots_only;          /* report a root function only where it falls through zero */
    void *context;                    /* handed to both */
    impact_ode_method method;
    double step;                       /* of RK4, > 0; else 0 */
    double relative_tolerance;         /* > 0 */
    double absolute_tolerance;         /* >= 0, for every component; see also absolute_tolerances */
    const double *absolute_tolerances; /* n values, copied, or NULL */
    long max_steps;                    /* per advance; 0: 100000 */
    const impact_allocator *allocator; /* copied; NULL: malloc */
} impact_ode_def;

typedef struct impact_ode_counts {
    long steps, rhs_calls, root_calls, error_test_failures, starts;
} impact_ode_counts;

/* Copies the definition; *ode is NULL on failure. IMPACT_EARGUMENT: a number out of its range, or a function that is
 * missing. IMPACT_ENOMEM: the allocator, or malloc for SUNDIALS' own objects, has no more. IMPACT_EABSENT: this build
 * has not the method. After this call nothing is allocated, by either. */
IMPACT_API impact_status impact_ode_create(const impact_ode_def *def, impact_ode **ode);
IMPACT_API void impact_ode_destroy(impact_ode *ode); /* NULL is fine */

/* Fewer components and root functions (the first ones) from the next start on, at most those of the definition, with
 * the same memory and to the same bits as an integrator of that size; with absolute tolerances of their own those are
 * to be set anew. IMPACT_EARGUMENT: more than there were, or no component. */
IMPACT_API impact_status impact_ode_resize(impact_ode *ode, int size, int roots);

/* What its allocator gave; of an integrator that belongs to a scene or workspace: what that was given. */
IMPACT_API impact_memory impact_ode_memory(const impact_ode *ode);

/* (Re)starts at (t, y[n]); keeps the workspace. IMPACT_EDOMAIN, with a message, when a number is not finite. */
IMPACT_API impact_status impact_ode_start(impact_ode *ode, double t, const double *y);

/* Bounds the step from now on; 0: no bound. */
IMPACT_API impact_status impact_ode_limit_step(impact_ode *ode, double max_step);

/* Other tolerances from the next start on: one absolute tolerance for every component, or absolute[n], copied, one for
 * each. IMPACT_EARGUMENT for a negative one or NaN. */
IMPACT_API impact_status impact_ode_set_tolerance(impact_ode *ode, double relative, double absolute);
IMPACT_API impact_status impact_ode_set_tolerances(impact_ode *ode, double relative, const double *absolute);

/* One internal step towards t_stop, never past it. *t and y[n] are the new state: the end of the step, or the first
 * root in it. roots_found[roots]: -1 or +1 where the root function crosses falling or rising, else 0 (NULL: not
 * wanted). *found: whether a root ended the step. IMPACT_EINTEGRATOR: see impact_ode_message. */
IMPACT_API impact_status impact_ode_step(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found,
                                         bool *found);

/* Steps until t_stop or the first root; the rest as impact_ode_step. */
IMPACT_API impact_status impact_ode_advance(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found,
                                            bool *found);

/* The solution (derivative = 0) or its derivative at any t of the last step taken. */
IMPACT_API impact_status impact_ode_interpolate(const impact_ode *ode, double t, int derivative, double *y);
/* Where the last internal step began and ended. */
IMPACT_API void impact_ode_last_step(const impact_ode *ode, double *begin, double *end);

/* Totals since creation. */
IMPACT_API impact_ode_counts impact_ode_count(const impact_ode *ode);
/* The last failure since the last start in words, with numbers; "" when there was none. */
IMPACT_API const char *impact_ode_message(const impact_ode *ode);

#ifdef __cplusplus
}
#endif

#endif
