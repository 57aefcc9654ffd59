/* SPDX-License-Identifier: MIT
 *
 * ode in a build without CVODE: every call answers IMPACT_EABSENT.
 */
#include "base/ode_in.h"

impact_status imp_ode_create_in(imp_arena *arena, const impact_ode_def *def, impact_ode **ode)
{
    (void)arena, (void)def;
    *ode = NULL;
    return IMPACT_EABSENT;
}

impact_status impact_ode_create(const impact_ode_def *def, impact_ode **ode)
{
    (void)def;
    *ode = NULL;
    return IMPACT_EABSENT;
}

void impact_ode_destroy(impact_ode *ode) { (void)ode; }

impact_status impact_ode_resize(impact_ode *ode, int size, int roots)
{
    (void)ode, (void)size, (void)roots;
    return IMPACT_EABSENT;
}

impact_memory impact_ode_memory(const impact_ode *ode)
{
    (void)ode;
    return (impact_memory){0};
}

impact_status impact_ode_start(impact_ode *ode, double t, const double *y)
{
    (void)ode, (void)t, (void)y;
    return IMPACT_EABSENT;
}

impact_status impact_ode_set_tolerance(impact_ode *ode, double relative, double absolute)
{
    (void)ode, (void)relative, (void)absolute;
    return IMPACT_EABSENT;
}

impact_status impact_ode_set_tolerances(impact_ode *ode, double relative, const double *absolute)
{
    (void)ode, (void)relative, (void)absolute;
    return IMPACT_EABSENT;
}

impact_status impact_ode_limit_step(impact_ode *ode, double max_step)
{
    (void)ode, (void)max_step;
    return IMPACT_EABSENT;
}

impact_status impact_ode_step(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found, bool *found)
{
    (void)ode, (void)t_stop, (void)t, (void)y, (void)roots_found;
    *found = false;
    return IMPACT_EABSENT;
}

impact_status impact_ode_advance(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found, bool *found)
{
    return impact_ode_step(ode, t_stop, t, y, roots_found, found);
}

impact_status impact_ode_interpolate(const impact_ode *ode, double t, int derivative, double *y)
{
    (void)ode, (void)t, (void)derivative, (void)y;
    return IMPACT_EABSENT;
}

void impact_ode_last_step(const impact_ode *ode, double *begin, double *end)
{
    (void)ode;
    *begin = *end = 0;
}

impact_ode_counts impact_ode_count(const impact_ode *ode)
{
    (void)ode;
    return (impact_ode_counts){0};
}

const char *impact_ode_message(const impact_ode *ode)
{
    (void)ode;
    return "";
}
