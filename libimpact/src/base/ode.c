/* SPDX-License-Identifier: MIT
 *
 * SUNDIALS 6.x and 7.x. What differs between them stands in the block below and nowhere else.
 * CVODE, the serial vectors and the solvers allocate by malloc when an integrator is created, and not again.
 */
#include <impact/ode.h>

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
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

struct impact_ode {
    impact_ode_def def;
    SUNContext sundials;
    void *cvode;
    N_Vector y;
    N_Vector tolerances; /* NULL when one absolute tolerance serves all */
    SUNNonlinearSolver nonlinear;
    SUNMatrix jacobian;
    SUNLinearSolver linear;
    int *roots_found;
    double step_begin, step_end;
    impact_ode_counts counts;
    char message[256];
};

static void note(impact_ode *ode, const char *function, const char *text)
{
    snprintf(ode->message, sizeof ode->message, "%s: %s", function ? function : "CVODE", text ? text : "failed");
}

#if SUNDIALS_VERSION_MAJOR == 6
static void on_error(int code, const char *module, const char *function, char *text, void *context)
{
    (void)module;
    if (code < 0) note(context, function, text);
}
static int open_context(SUNContext *context) { return SUNContext_Create(NULL, context); }
static int quiet(impact_ode *ode) { return CVodeSetErrHandlerFn(ode->cvode, on_error, ode); }
#else
static void on_error(int line, const char *function, const char *file, const char *text, SUNErrCode code, void *context,
                     SUNContext sundials)
{
    (void)line, (void)file, (void)sundials;
    if (code < 0) note(context, function, text);
}
static int open_context(SUNContext *context) { return SUNContext_Create(SUN_COMM_NULL, context); }
static int quiet(impact_ode *ode)
{
    SUNContext_ClearErrHandlers(ode->sundials);
    return SUNContext_PushErrHandler(ode->sundials, on_error, ode);
}
#endif

static int rhs(sunrealtype t, N_Vector y, N_Vector rate, void *context)
{
    impact_ode *ode = context;
    return ode->def.rhs(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rate), ode->def.context);
}

static int roots(sunrealtype t, N_Vector y, sunrealtype *value, void *context)
{
    impact_ode *ode = context;
    return ode->def.root_functions(t, N_VGetArrayPointer(y), value, ode->def.context);
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
    if (!ode->tolerances) ode->tolerances = N_VNew_Serial(ode->def.size, ode->sundials);
    if (!ode->tolerances) return false;
    memcpy(N_VGetArrayPointer(ode->tolerances), absolute, sizeof(double) * (size_t)ode->def.size);
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
    ode->jacobian = SUNDenseMatrix(ode->def.size, ode->def.size, ode->sundials);
    if (!ode->jacobian) return false;
    ode->linear = SUNLinSol_Dense(ode->y, ode->jacobian, ode->sundials);
    return ode->linear && CVodeSetLinearSolver(ode->cvode, ode->linear, ode->jacobian) == CV_SUCCESS;
}

static bool set_root_directions(impact_ode *ode)
{
    if (!ode->def.falling_roots_only || ode->def.roots == 0) return true;
    for (int i = 0; i < ode->def.roots; i++) ode->roots_found[i] = -1;
    return CVodeSetRootDirection(ode->cvode, ode->roots_found) == CV_SUCCESS; /* copies */
}

static bool build(impact_ode *ode)
{
    const impact_ode_def *def = &ode->def;
    ode->roots_found = calloc((size_t)(def->roots > 0 ? def->roots : 1), sizeof *ode->roots_found);
    if (!ode->roots_found || open_context(&ode->sundials) != 0) return false;
    ode->y = N_VNew_Serial(def->size, ode->sundials);
    ode->cvode = CVodeCreate(def->method == IMPACT_ODE_ADAMS ? CV_ADAMS : CV_BDF, ode->sundials);
    if (!ode->y || !ode->cvode) return false;
    N_VConst(0, ode->y);
    return quiet(ode) == 0 && CVodeInit(ode->cvode, rhs, 0, ode->y) == CV_SUCCESS && set_tolerances(ode) &&
           set_solver(ode) && CVodeSetUserData(ode->cvode, ode) == CV_SUCCESS &&
           CVodeSetNoInactiveRootWarn(ode->cvode) == CV_SUCCESS &&
           (def->roots == 0 || CVodeRootInit(ode->cvode, def->roots, roots) == CV_SUCCESS) && set_root_directions(ode);
}

impact_status impact_ode_create(const impact_ode_def *def, impact_ode **out)
{
    *out = NULL;
    if (!valid(def)) return IMPACT_EARGUMENT;
    impact_ode *ode = calloc(1, sizeof *ode);
    if (!ode) return IMPACT_ENOMEM;
    ode->def = *def;
    if (ode->def.max_steps == 0) ode->def.max_steps = 100000;
    if (!build(ode)) {
        impact_ode_destroy(ode);
        return IMPACT_ENOMEM;
    }
    *out = ode;
    return IMPACT_OK;
}

void impact_ode_destroy(impact_ode *ode)
{
    if (!ode) return;
    if (ode->cvode) CVodeFree(&ode->cvode);
    if (ode->nonlinear) SUNNonlinSolFree(ode->nonlinear);
    if (ode->linear) SUNLinSolFree(ode->linear);
    if (ode->jacobian) SUNMatDestroy(ode->jacobian);
    if (ode->tolerances) N_VDestroy(ode->tolerances);
    if (ode->y) N_VDestroy(ode->y);
    if (ode->sundials) SUNContext_Free(&ode->sundials);
    free(ode->roots_found);
    free(ode);
}

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
    for (int i = 0; i < ode->def.size; i++)
        if (!isfinite(y[i])) {
            snprintf(ode->message, sizeof ode->message, "start at t = %.17g: component %d is %g", t, i, y[i]);
            return IMPACT_EDOMAIN;
        }
    add_counts(ode, &ode->counts);
    ode->counts.starts++;
    memcpy(N_VGetArrayPointer(ode->y), y, sizeof(double) * (size_t)ode->def.size);
    ode->step_begin = ode->step_end = t;
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
    for (int i = 0; i < ode->def.size; i++)
        if (!(absolute[i] >= 0)) return IMPACT_EARGUMENT;
    return set_vector(ode, relative, absolute) ? IMPACT_OK : IMPACT_ENOMEM;
}

impact_status impact_ode_step(impact_ode *ode, double t_stop, double *t, double *y, int *roots_found, bool *found)
{
    *found = false;
    if (roots_found) memset(roots_found, 0, sizeof *roots_found * (size_t)ode->def.roots);
    if (ode->step_begin == ode->step_end && ode->step_end == t_stop) { /* no way to go, which CVODE would refuse */
        *t = t_stop;
        memcpy(y, N_VGetArrayPointer(ode->y), sizeof(double) * (size_t)ode->def.size);
        return IMPACT_OK;
    }
    if (CVodeSetStopTime(ode->cvode, t_stop) != CV_SUCCESS) return IMPACT_EINTEGRATOR;
    const int result = CVode(ode->cvode, t_stop, ode->y, t, CV_ONE_STEP);
    if (result < 0) {
        if (ode->message[0] == '\0')
            snprintf(ode->message, sizeof ode->message, "CVODE failed with %d at t = %.17g", result, *t);
        return IMPACT_EINTEGRATOR;
    }
    memcpy(y, N_VGetArrayPointer(ode->y), sizeof(double) * (size_t)ode->def.size);
    double last = 0;
    CVodeGetCurrentTime(ode->cvode, &ode->step_end);
    CVodeGetLastStep(ode->cvode, &last);
    ode->step_begin = ode->step_end - last;
    if (result == CV_ROOT_RETURN) {
        *found = true;
        CVodeGetRootInfo(ode->cvode, ode->roots_found);
        if (roots_found) memcpy(roots_found, ode->roots_found, sizeof *roots_found * (size_t)ode->def.roots);
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
    N_Vector out = N_VMake_Serial(ode->def.size, y, ode->sundials);
    if (!out) return IMPACT_ENOMEM;
    const int result = CVodeGetDky(ode->cvode, t, derivative, out);
    N_VDestroy(out);
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
