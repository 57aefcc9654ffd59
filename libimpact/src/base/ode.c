/* SPDX-License-Identifier: MIT
 *
 * SUNDIALS 6.x and 7.x. What differs between them stands in the block below and nowhere else.
 *
 * Memory: the integrator, its vectors and matrices stand in an arena (ode_pool.c). SUNDIALS itself takes a few pieces
 * by malloc when an integrator is created, of a fixed size but for six arrays of one entry a root function, and none
 * after that. It answers a refusal of most of them; the first ones, within SUNContext_Create and CVodeCreate, it uses
 * without looking (6.4.1). Those are asked for beforehand, so that a process without memory hears of it here.
 */
#include "base/ode_in.h"
#include "base/ode_pool.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <sundials/sundials_config.h>
#if SUNDIALS_VERSION_MAJOR < 6 || SUNDIALS_VERSION_MAJOR > 7
#error "SUNDIALS 6.x or 7.x is needed"
#endif
#if !defined(SUNDIALS_DOUBLE_PRECISION)
#error "SUNDIALS must be built for double"
#endif
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

enum {
    /* CVODE has 27 of Adams at once at most (order 12), 21 of BDF (order 5), by 6.4.1; for want of one a step answers
     * IMPACT_ENOMEM. */
    VECTORS_ADAMS = 32,
    VECTORS_BDF = 24,
    /* CVODE takes steps too short to change t, and calls them done: before a jump it comes to them by cutting its step,
     * and goes on, because they show no error and the step grows tenfold in 13 of them at most (order 12). A right-hand
     * side that jumps for good would hold it so for ever. */
    MAX_STILL = 100,
    SUNDIALS_OWN = 16384 /* bytes: several times what SUNContext_Create and CVodeCreate take: 208 + 1864 (6.4.1) */
};

struct impact_ode {
    impact_ode_def def; /* its size and roots are the most there can be */
    imp_arena *arena;
    bool owns_arena;
    imp_ode_pool pool;
    int size, roots; /* at work */
    SUNContext sundials;
    void *cvode;
    N_Vector y, outside; /* the state; a vector whose numbers stand in a caller's array */
    N_Vector tolerances; /* NULL when one absolute tolerance serves all */
    SUNNonlinearSolver nonlinear;
    int *roots_found;
    double t; /* as answered last; and how often in a row: */
    int still;
    double step_begin, step_end;
    impact_ode_counts counts;
    char message[256];
};

/* SUNDIALS' own texts go nowhere: explain() has words for what it answers. */
#if SUNDIALS_VERSION_MAJOR == 6
static void on_error(int code, const char *module, const char *function, char *text, void *context)
{
    (void)code, (void)module, (void)function, (void)text, (void)context;
}
static int open_context(SUNContext *context) { return SUNContext_Create(NULL, context); }
static int quiet(impact_ode *ode) { return CVodeSetErrHandlerFn(ode->cvode, on_error, ode); }
#else
static void on_error(int line, const char *function, const char *file, const char *text, SUNErrCode code, void *context,
                     SUNContext sundials)
{
    (void)line, (void)function, (void)file, (void)text, (void)code, (void)context, (void)sundials;
}
static int open_context(SUNContext *context) { return SUNContext_Create(SUN_COMM_NULL, context); }
static int quiet(impact_ode *ode)
{
    SUNContext_ClearErrHandlers(ode->sundials);
    return SUNContext_PushErrHandler(ode->sundials, on_error, ode);
}
#endif

static const char *reason(int result)
{
    switch (result) {
    case CV_TOO_MUCH_ACC: return "the tolerance asks for more than double precision holds";
    case CV_ERR_FAILURE: return "the error stays above the tolerance however short the step: a jump, or a singularity";
    case CV_CONV_FAILURE: return "the step's equations do not converge however short the step: too stiff, or a jump";
    case CV_LSETUP_FAIL:
    case CV_LSOLVE_FAIL: return "the step's linear equations have no solution";
    case CV_RHSFUNC_FAIL: return "the right-hand side gave up";
    case CV_FIRST_RHSFUNC_ERR: return "the right-hand side gave up at the start";
    case CV_REPTD_RHSFUNC_ERR: return "the right-hand side goes on asking for a shorter step";
    case CV_UNREC_RHSFUNC_ERR: return "the right-hand side asked for a shorter step where there is none";
    case CV_RTFUNC_FAIL: return "a root function gave up";
    case CV_ILL_INPUT: return "a component and its absolute tolerance are both zero, or no step is short enough";
    case CV_TOO_CLOSE: return "the stop is too near the start";
    default: return "it failed";
    }
}

static impact_status explain_failure(impact_ode *ode, const char *why)
{
    double reached = ode->step_end, step = 0;
    if (CVodeGetCurrentTime(ode->cvode, &reached) == CV_SUCCESS) CVodeGetCurrentStep(ode->cvode, &step);
    snprintf(ode->message, sizeof ode->message, "integration stopped at t = %.17g, step %.3g: %s", reached, step, why);
    return IMPACT_EINTEGRATOR;
}

static int rhs(sunrealtype t, N_Vector y, N_Vector rate, void *context)
{
    impact_ode *ode = context;
    return ode->def.rhs(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rate), ode->def.context);
}

static int roots(sunrealtype t, N_Vector y, sunrealtype *value, void *context)
{
    impact_ode *ode = context;
    for (int i = ode->roots; i < ode->def.roots; i++) value[i] = 1; /* those not at work never cross */
    return ode->roots == 0 ? 0 : ode->def.root_functions(t, N_VGetArrayPointer(y), value, ode->def.context);
}

static bool valid(const impact_ode_def *def)
{
    for (int i = 0; def->absolute_tolerances && i < def->size; i++)
        if (!(def->absolute_tolerances[i] >= 0)) return false;
    return def->size >= 1 && def->roots >= 0 && def->rhs && (def->roots == 0 || def->root_functions) &&
           def->relative_tolerance > 0 && def->absolute_tolerance >= 0 && def->max_steps >= 0;
}

/* A tolerance for each component, copied. */
static bool set_vector(impact_ode *ode, double relative, const double *absolute)
{
    if (!ode->tolerances) ode->tolerances = imp_ode_pool_vector(&ode->pool);
    memcpy(N_VGetArrayPointer(ode->tolerances), absolute, sizeof(double) * (size_t)ode->size);
    return CVodeSVtolerances(ode->cvode, relative, ode->tolerances) == CV_SUCCESS;
}

static bool set_tolerances(impact_ode *ode)
{
    const impact_ode_def *def = &ode->def;
    if (!def->absolute_tolerances)
        return CVodeSStolerances(ode->cvode, def->relative_tolerance, def->absolute_tolerance) == CV_SUCCESS;
    const double *given = def->absolute_tolerances;
    ode->def.absolute_tolerances = NULL; /* the caller's array is not kept */
    return set_vector(ode, def->relative_tolerance, given);
}

static bool set_solver(impact_ode *ode)
{
    if (ode->def.method == IMPACT_ODE_ADAMS) {
        ode->nonlinear = SUNNonlinSol_FixedPoint(ode->y, 0, ode->sundials);
        return ode->nonlinear && CVodeSetNonlinearSolver(ode->cvode, ode->nonlinear) == CV_SUCCESS;
    }
    return CVodeSetLinearSolver(ode->cvode, &ode->pool.solver, imp_ode_pool_matrix(&ode->pool)) == CV_SUCCESS;
}

static bool set_root_directions(impact_ode *ode)
{
    if (!ode->def.falling_roots_only || ode->def.roots == 0) return true;
    for (int i = 0; i < ode->def.roots; i++) ode->roots_found[i] = -1;
    return CVodeSetRootDirection(ode->cvode, ode->roots_found) == CV_SUCCESS; /* copies */
}

static bool open_sundials(impact_ode *ode)
{
    void *room = malloc(SUNDIALS_OWN);
    free(room);
    if (!room || open_context(&ode->sundials) != 0) return false;
    ode->cvode = CVodeCreate(ode->def.method == IMPACT_ODE_ADAMS ? CV_ADAMS : CV_BDF, ode->sundials);
    return ode->cvode && quiet(ode) == 0;
}

static bool make_memory(impact_ode *ode)
{
    const impact_ode_def *def = &ode->def;
    const bool stiff = def->method == IMPACT_ODE_BDF;
    ode->size = def->size;
    ode->roots = def->roots;
    ode->roots_found = imp_arena_take(ode->arena, (size_t)def->roots, sizeof *ode->roots_found);
    if (!ode->roots_found || !imp_ode_pool_make(&ode->pool, ode->arena, ode->sundials, def->size,
                                                stiff ? VECTORS_BDF : VECTORS_ADAMS, stiff))
        return false;
    ode->y = imp_ode_pool_vector(&ode->pool);
    ode->outside = imp_ode_pool_vector(&ode->pool);
    return true;
}

static bool build(impact_ode *ode)
{
    const impact_ode_def *def = &ode->def;
    return open_sundials(ode) && make_memory(ode) && CVodeInit(ode->cvode, rhs, 0, ode->y) == CV_SUCCESS &&
           set_tolerances(ode) && set_solver(ode) && CVodeSetUserData(ode->cvode, ode) == CV_SUCCESS &&
           CVodeSetNoInactiveRootWarn(ode->cvode) == CV_SUCCESS &&
           (def->roots == 0 || CVodeRootInit(ode->cvode, def->roots, roots) == CV_SUCCESS) && set_root_directions(ode);
}

impact_status imp_ode_create_in(imp_arena *arena, const impact_ode_def *def, impact_ode **out)
{
    *out = NULL;
    if (!valid(def)) return IMPACT_EARGUMENT;
    impact_ode *ode = imp_arena_take(arena, 1, sizeof *ode);
    if (!ode) return IMPACT_ENOMEM;
    ode->arena = arena;
    ode->def = *def;
    ode->def.allocator = NULL;
    if (ode->def.max_steps == 0) ode->def.max_steps = 100000;
    if (!build(ode)) {
        impact_ode_destroy(ode);
        return IMPACT_ENOMEM;
    }
    *out = ode;
    return IMPACT_OK;
}

impact_status impact_ode_create(const impact_ode_def *def, impact_ode **out)
{
    imp_arena *arena;
    *out = NULL;
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
    if (ode->cvode) CVodeFree(&ode->cvode);
    if (ode->nonlinear) SUNNonlinSolFree(ode->nonlinear);
    imp_ode_pool_free(&ode->pool, arena);
    if (ode->sundials) SUNContext_Free(&ode->sundials);
    imp_arena_give(arena, ode->roots_found);
    imp_arena_give(arena, ode);
    if (owns_arena) imp_arena_destroy(arena);
}

impact_status impact_ode_resize(impact_ode *ode, int size, int roots_now)
{
    if (size < 1 || size > ode->def.size || roots_now < 0 || roots_now > ode->def.roots) return IMPACT_EARGUMENT;
    ode->size = size;
    ode->roots = roots_now;
    imp_ode_pool_resize(&ode->pool, size);
    return IMPACT_OK;
}

impact_memory impact_ode_memory(const impact_ode *ode) { return imp_arena_memory(ode->arena); }

/* CVODE's counters begin anew at each start; the totals are kept here. */
static void add_counts(const impact_ode *ode, impact_ode_counts *total)
{
    long steps = 0, calls = 0, root_calls = 0, failures = 0;
    CVodeGetNumSteps(ode->cvode, &steps);
    CVodeGetNumRhsEvals(ode->cvode, &calls);
    CVodeGetNumErrTestFails(ode->cvode, &failures);
    if (ode->def.roots > 0) CVodeGetNumGEvals(ode->cvode, &root_calls);
    total->steps += steps;
    total->rhs_calls += calls;
    total->root_calls += root_calls;
    total->error_test_failures += failures;
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
            snprintf(ode->message, sizeof ode->message, "start at t = %.17g: component %d is %g", t, i, y[i]);
            return IMPACT_EDOMAIN;
        }
    add_counts(ode, &ode->counts);
    ode->counts.starts++;
    memcpy(N_VGetArrayPointer(ode->y), y, sizeof(double) * (size_t)ode->size);
    ode->t = ode->step_begin = ode->step_end = t;
    ode->still = 0;
    return CVodeReInit(ode->cvode, t, ode->y) == CV_SUCCESS ? IMPACT_OK : IMPACT_EINTEGRATOR;
}

impact_status impact_ode_limit_step(impact_ode *ode, double max_step)
{
    return CVodeSetMaxStep(ode->cvode, max_step) == CV_SUCCESS ? IMPACT_OK : IMPACT_EARGUMENT;
}

impact_status impact_ode_set_tolerance(impact_ode *ode, double relative, double absolute)
{
    if (!(relative >= 0 && absolute >= 0 && relative < 1)) return IMPACT_EARGUMENT;
    return CVodeSStolerances(ode->cvode, relative, absolute) == CV_SUCCESS ? IMPACT_OK : IMPACT_EARGUMENT;
}

impact_status impact_ode_set_tolerances(impact_ode *ode, double relative, const double *absolute)
{
    if (!(relative >= 0 && relative < 1)) return IMPACT_EARGUMENT;
    for (int i = 0; i < ode->size; i++)
        if (!(absolute[i] >= 0)) return IMPACT_EARGUMENT;
    return set_vector(ode, relative, absolute) ? IMPACT_OK : IMPACT_ENOMEM;
}

impact_status impact_ode_step(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found, bool *found)
{
    *found = false;
    if (roots_found) memset(roots_found, 0, sizeof *roots_found * (size_t)ode->roots);
    if (ode->step_begin == ode->step_end && ode->step_end == t_stop) { /* no way to go, which CVODE would refuse */
        *t = t_stop;
        memcpy(y, N_VGetArrayPointer(ode->y), sizeof(double) * (size_t)ode->size);
        return IMPACT_OK;
    }
    if (CVodeSetStopTime(ode->cvode, t_stop) != CV_SUCCESS) return IMPACT_EINTEGRATOR;
    const int result = CVode(ode->cvode, t_stop, ode->y, t, CV_ONE_STEP);
    if (ode->pool.spent) return IMPACT_ENOMEM;
    if (result < 0) return explain_failure(ode, reason(result));
    memcpy(y, N_VGetArrayPointer(ode->y), sizeof(double) * (size_t)ode->size);
    ode->still = *t == ode->t && result == CV_SUCCESS ? ode->still + 1 : 0;
    if (ode->still > MAX_STILL)
        return explain_failure(ode,
                               "no step is both short enough and long enough to change t: a jump, or a singularity");
    ode->t = *t;
    double last = 0;
    CVodeGetCurrentTime(ode->cvode, &ode->step_end);
    CVodeGetLastStep(ode->cvode, &last);
    ode->step_begin = ode->step_end - last;
    if (result == CV_ROOT_RETURN) {
        *found = true;
        CVodeGetRootInfo(ode->cvode, ode->roots_found);
        if (roots_found) memcpy(roots_found, ode->roots_found, sizeof *roots_found * (size_t)ode->roots);
    }
    return IMPACT_OK;
}

impact_status impact_ode_advance(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found, bool *found)
{
    for (long step = 0; step < ode->def.max_steps; step++) {
        const impact_status status = impact_ode_step(ode, t_stop, t, y, roots_found, found);
        if (status != IMPACT_OK || *found || *t == t_stop) return status;
    }
    snprintf(ode->message, sizeof ode->message, "%ld steps did not reach t = %.17g; stopped at %.17g",
             ode->def.max_steps, t_stop, *t);
    return IMPACT_EINTEGRATOR;
}

impact_status impact_ode_interpolate(const impact_ode *ode, double t, int derivative, double *y)
{
    double *own = N_VGetArrayPointer(ode->outside);
    N_VSetArrayPointer(y, ode->outside);
    const int result = CVodeGetDky(ode->cvode, t, derivative, ode->outside);
    N_VSetArrayPointer(own, ode->outside);
    return result == CV_SUCCESS ? IMPACT_OK : IMPACT_EARGUMENT;
}

void impact_ode_last_step(const impact_ode *ode, double *begin, double *end)
{
    *begin = ode->step_begin;
    *end = ode->step_end;
}

impact_ode_counts impact_ode_count(const impact_ode *ode)
{
    impact_ode_counts total = ode->counts;
    add_counts(ode, &total);
    return total;
}

const char *impact_ode_message(const impact_ode *ode) { return ode->message; }
