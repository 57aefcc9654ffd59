/* SPDX-License-Identifier: MIT */
#include "base/ode_roots.h"
#include "base/bracket.h"

size_t imp_ode_roots_room(const impact_ode *ode) { return (size_t)ode->def.size + 3 * (size_t)ode->def.roots; }

double *imp_ode_roots_lay_out(const impact_ode *ode, imp_ode_roots *roots, double *room)
{
    roots->state = room;
    room += ode->def.size;
    for (int k = 0; k < 3; k++, room += ode->def.roots) roots->value[k] = room;
    return room;
}

impact_status imp_ode_roots_at(impact_ode *ode, imp_ode_roots *roots, double t, const double *y, double *value)
{
    if (ode->roots == 0) return IMPACT_OK;
    roots->calls++;
    return imp_ode_root_values(ode, t, y, value) == 0
               ? IMPACT_OK
               : imp_ode_explain(ode, ode->t, ode->step_end - ode->step_begin, "a root function gave up");
}

/* The way it crosses from before to after: -1, +1, or 0. What began at zero does not cross. */
static int crosses(const impact_ode *ode, double before, double after)
{
    if (before > 0 && after <= 0) return -1;
    return !ode->def.falling_roots_only && before < 0 && after >= 0 ? 1 : 0;
}

/* y at t of the step in state, all functions in value[2]. */
static impact_status look_at(impact_ode *ode, imp_ode_roots *roots, double t)
{
    const impact_status status = ode->driver->interpolate(ode, t, 0, roots->state);
    return status == IMPACT_OK ? imp_ode_roots_at(ode, roots, t, roots->state, roots->value[2]) : status;
}

/* The first t behind the root of function i, which crosses between low and *t. */
static impact_status find_root(impact_ode *ode, imp_ode_roots *roots, int i, double low, double after, double *t)
{
    imp_bracket b = {.low = low, .high = *t, .at_low = roots->value[0][i], .at_high = after};
    const int way = crosses(ode, b.at_low, b.at_high);
    for (int k = 0; k < IMP_BRACKET_MOST && b.at_high != 0; k++) {
        const double guess = imp_bracket_guess(&b);
        if (guess == b.low || guess == b.high) break;
        const impact_status status = look_at(ode, roots, guess);
        if (status != IMPACT_OK) return status;
        const double value = roots->value[2][i];
        imp_bracket_take(&b, guess, value, crosses(ode, roots->value[0][i], value) == way);
    }
    *t = b.high;
    return IMPACT_OK;
}

impact_status imp_ode_roots_first(impact_ode *ode, imp_ode_roots *roots, double low, double high, bool *found)
{
    double t = high;
    int last = 0;
    *found = false;
    for (int i = 0; i < ode->roots; i++) {
        const double after = *found ? roots->value[2][i] : roots->value[1][i];
        if (crosses(ode, roots->value[0][i], after) == 0) continue;
        *found = true;
        last = i;
        impact_status status = find_root(ode, roots, i, low, after, &t);
        if (status == IMPACT_OK) status = look_at(ode, roots, t);
        if (status != IMPACT_OK) return status;
    }
    if (!*found) return IMPACT_OK;
    for (int i = 0; i < ode->roots; i++) ode->roots_found[i] = crosses(ode, roots->value[0][i], roots->value[2][i]);
    /* Asked again, a function that is known to rounding may be on the other side of zero: the crossing was found. */
    ode->roots_found[last] = crosses(ode, roots->value[0][last], 0);
    ode->t = t;
    return IMPACT_OK;
}
