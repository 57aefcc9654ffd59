/* SPDX-License-Identifier: MIT
 *
 * The first root of a one-step method's last step, on the polynomial that its driver interpolates by. Internal.
 */
#ifndef IMP_ODE_ROOTS_H
#define IMP_ODE_ROOTS_H

#include "base/ode_driver.h"

typedef struct imp_ode_roots {
    double
        *value[3]; /* the functions: where the last stretch looked at began, where it ended, where a root is sought */
    double *state; /* y there */
    long calls;
} imp_ode_roots;

/* Doubles that its arrays take, and the arrays out of them; the first behind them. */
size_t imp_ode_roots_room(const impact_ode *ode);
double *imp_ode_roots_lay_out(const impact_ode *ode, imp_ode_roots *roots, double *room);

/* The functions at (t, y) into value. */
impact_status imp_ode_roots_at(impact_ode *ode, imp_ode_roots *roots, double t, const double *y, double *value);
/* The first crossing in [low, high] of the last step, where the functions are value[0] and value[1]: *found, and then
 * ode->t and roots->state behind it by a rounding, and which functions have crossed by then in ode->roots_found. */
impact_status imp_ode_roots_first(impact_ode *ode, imp_ode_roots *roots, double low, double high, bool *found);

#endif
