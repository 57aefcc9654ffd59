/* SPDX-License-Identifier: MIT
 *
 * What every integrator has, and the functions that make one of it: a driver is one library's, or one method's. ode.c
 * calls them and knows no other difference. Internal.
 */
#ifndef IMP_ODE_DRIVER_H
#define IMP_ODE_DRIVER_H

#include "base/ode_in.h"

typedef struct imp_ode_driver {
    size_t bytes; /* of its integrator, which begins with a struct impact_ode */
    /* Takes memory and makes what it needs, by ode->def; what it has taken when it fails is closed too. */
    impact_status (*open)(impact_ode *ode);
    void (*close)(impact_ode *ode); /* everything but itself and roots_found */
    void (*resize)(impact_ode *ode);
    impact_status (*start)(impact_ode *ode, double t, const double *y); /* finite; t and step_* are set */
    bool (*limit_step)(impact_ode *ode, double max_step);
    /* absolute NULL: `same` for every component */
    impact_status (*set_tolerances)(impact_ode *ode, double relative, const double *absolute, double same);
    /* One step; t_stop is not where it stands. Sets t, step_begin, step_end, and where *found roots_found. */
    impact_status (*step)(impact_ode *ode, double t_stop, double *y, bool *found);
    impact_status (*interpolate)(const impact_ode *ode, double t, int derivative, double *y);
    impact_ode_counts (*count)(const impact_ode *ode); /* since the last start; starts 0 */
} imp_ode_driver;

struct impact_ode {
    const imp_ode_driver *driver;
    impact_ode_def def; /* its size and roots are the most there can be */
    imp_arena *arena;
    bool owns_arena;
    int size, roots; /* at work */
    int *roots_found;
    double t; /* as answered last */
    double step_begin, step_end;
    impact_ode_counts counts; /* up to the last start */
    char message[256];
};

extern const imp_ode_driver imp_ode_rk4, imp_ode_lobatto, imp_ode_dop853;

/* The root functions at work; not 0 where they give up. One that is NaN does not cross there: CVODE's secants would go
 * on for ever. */
int imp_ode_root_values(const impact_ode *ode, double t, const double *y, double *value);

/* "integration stopped at t = ..., step ...: why". IMPACT_EINTEGRATOR. */
impact_status imp_ode_explain(impact_ode *ode, double reached, double step, const char *why);

#endif
