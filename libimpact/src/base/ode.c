/* SPDX-License-Identifier: MIT */
#include "base/number.h"
#include "base/definition.h"
#include "base/ode_driver.h"
#include "base/parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of a fixed step the tolerances say nothing; of the others the step. */
static bool valid(const impact_ode_def *def)
{
    for (int i = 0; def->absolute_tolerances && i < def->size; i++)
        if (!(def->absolute_tolerances[i] >= 0)) return false;
    if (!(def->size >= 1 && def->roots >= 0 && def->rhs && (def->roots == 0 || def->root_functions))) return false;
    if (def->max_steps < 0) return false;
    switch (def->method) {
    case IMPACT_ODE_ADAMS:
    case IMPACT_ODE_BDF:
    case IMPACT_ODE_LOBATTO:
    case IMPACT_ODE_DOP853: return def->step == 0 && def->relative_tolerance > 0 && def->absolute_tolerance >= 0;
    case IMPACT_ODE_RK4: return def->step > 0 && isfinite(def->step);
    }
    return false;
}

static const imp_ode_driver *driver_of(impact_ode_method method)
{
    if (method == IMPACT_ODE_RK4) return &imp_ode_rk4;
    if (method == IMPACT_ODE_DOP853) return &imp_ode_dop853;
    return method == IMPACT_ODE_LOBATTO ? &imp_ode_lobatto : imp_cvode();
}

impact_status imp_ode_create_in(imp_arena *arena, const impact_ode_def *def, impact_ode **out)
{
    *out = NULL;
    if (!valid(def)) return IMPACT_EARGUMENT;
    const imp_ode_driver *driver = driver_of(def->method);
    if (!driver) return IMPACT_EABSENT;
    impact_ode *ode = imp_arena_take(arena, 1, driver->bytes);
    if (!ode) return IMPACT_ENOMEM;
    ode->driver = driver;
    ode->arena = arena;
    ode->def = *def;
    ode->def.allocator = NULL;
    if (ode->def.max_steps == 0) ode->def.max_steps = 100000;
    ode->size = def->size;
    ode->roots = def->roots;
    ode->roots_found = imp_arena_take(arena, (size_t)def->roots, sizeof *ode->roots_found);
    const impact_status status = ode->roots_found ? driver->open(ode) : IMPACT_ENOMEM;
    if (status != IMPACT_OK) {
        impact_ode_destroy(ode);
        return status;
    }
    ode->def.absolute_tolerances = NULL; /* the caller's array is not kept */
    *out = ode;
    return IMPACT_OK;
}

impact_status impact_ode_create(const impact_ode_def *given, impact_ode **out)
{
    imp_arena *arena;
    impact_ode_def own = {.struct_size = sizeof own};
    const impact_ode_def *def = &own;
    *out = NULL;
    if (imp_definition_refusal(given, sizeof own)) return IMPACT_EARGUMENT;
    imp_definition_take(given, &own, sizeof own);
    impact_status status = imp_arena_create(def->allocator, &arena);
    if (status != IMPACT_OK) return status;
    status = imp_ode_create_in(arena, def, out);
    if (status == IMPACT_OK)
        (*out)->owns_arena = true;
    else
        imp_arena_destroy(arena);
    return status;
}

void impact_ode_destroy(impact_ode *ode)
{
    if (!ode) return;
    imp_arena *arena = ode->arena;
    const bool owns_arena = ode->owns_arena;
    ode->driver->close(ode);
    imp_arena_give(arena, ode->roots_found);
    imp_arena_give(arena, ode);
    if (owns_arena) imp_arena_destroy(arena);
}

impact_status impact_ode_resize(impact_ode *ode, int size, int roots_now)
{
    if (size < 1 || size > ode->def.size || roots_now < 0 || roots_now > ode->def.roots) return IMPACT_EARGUMENT;
    ode->size = size;
    ode->roots = roots_now;
    ode->driver->resize(ode);
    return IMPACT_OK;
}

impact_memory impact_ode_memory(const impact_ode *ode) { return imp_arena_memory(ode->arena); }

impact_ode_counts impact_ode_count(const impact_ode *ode)
{
    const impact_ode_counts now = ode->driver->count(ode);
    impact_ode_counts total = ode->counts;
    total.steps += now.steps;
    total.rhs_calls += now.rhs_calls;
    total.root_calls += now.root_calls;
    total.error_test_failures += now.error_test_failures;
    return total;
}

impact_status impact_ode_start(impact_ode *ode, double t, const double *y)
{
    ode->message[0] = '\0';
    if (!isfinite(t)) {
        snprintf(ode->message, sizeof ode->message, "start at t = %g", t);
        return IMPACT_EDOMAIN;
    }
    for (int i = 0; i < ode->size; i++)
        if (!isfinite(y[i])) {
            snprintf(ode->message, sizeof ode->message, "start at t = %s: component %d is %g", imp_number_of(t).text, i,
                     y[i]);
            return IMPACT_EDOMAIN;
        }
    ode->counts = impact_ode_count(ode);
    ode->counts.starts++;
    ode->t = ode->step_begin = ode->step_end = t;
    return ode->driver->start(ode, t, y);
}

impact_status impact_ode_limit_step(impact_ode *ode, double max_step)
{
    return ode->driver->limit_step(ode, max_step) ? IMPACT_OK : IMPACT_EARGUMENT;
}

impact_status impact_ode_set_tolerance(impact_ode *ode, double relative, double absolute)
{
    if (!(relative >= 0 && absolute >= 0 && relative < 1)) return IMPACT_EARGUMENT;
    return ode->driver->set_tolerances(ode, relative, NULL, absolute);
}

impact_status impact_ode_set_tolerances(impact_ode *ode, double relative, const double *absolute)
{
    if (!(relative >= 0 && relative < 1)) return IMPACT_EARGUMENT;
    for (int i = 0; i < ode->size; i++)
        if (!(absolute[i] >= 0)) return IMPACT_EARGUMENT;
    return ode->driver->set_tolerances(ode, relative, absolute, 0);
}

impact_status impact_ode_step(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found, bool *found)
{
    *found = false;
    if (roots_found) memset(roots_found, 0, sizeof *roots_found * (size_t)ode->roots);
    const impact_status status = ode->driver->step(ode, t_stop, y, found);
    *t = ode->t;
    if (status == IMPACT_OK && *found && roots_found)
        memcpy(roots_found, ode->roots_found, sizeof *roots_found * (size_t)ode->roots);
    return status;
}

impact_status impact_ode_advance(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found, bool *found)
{
    for (long step = 0; step < ode->def.max_steps; step++) {
        const impact_status status = impact_ode_step(ode, t_stop, t, y, roots_found, found);
        if (status != IMPACT_OK || *found || *t == t_stop) return status;
    }
    snprintf(ode->message, sizeof ode->message, "%ld steps did not reach t = %s; stopped at %s", ode->def.max_steps,
             imp_number_of(t_stop).text, imp_number_of(*t).text);
    return IMPACT_EINTEGRATOR;
}

impact_status impact_ode_interpolate(const impact_ode *ode, double t, int derivative, double *y)
{
    return ode->driver->interpolate(ode, t, derivative, y);
}

void impact_ode_last_step(const impact_ode *ode, double *begin, double *end)
{
    *begin = ode->step_begin;
    *end = ode->step_end;
}

const char *impact_ode_message(const impact_ode *ode) { return ode->message; }

int imp_ode_root_values(const impact_ode *ode, double t, const double *y, double *value)
{
    if (ode->roots == 0) return 0;
    const int answer = ode->def.root_functions(t, y, value, ode->def.context);
    for (int i = 0; i < ode->roots; i++)
        if (isnan(value[i])) value[i] = 1;
    return answer;
}

impact_status imp_ode_explain(impact_ode *ode, double reached, double step, const char *why)
{
    snprintf(ode->message, sizeof ode->message, "integration stopped at t = %s, step %.3g: %s",
             imp_number_of(reached).text, step, why);
    return IMPACT_EINTEGRATOR;
}
