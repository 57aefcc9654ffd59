/* SPDX-License-Identifier: MIT
 *
 * The driver of CVODE: SUNDIALS 6.x and 7.x. What differs between them stands in the block below and nowhere else.
 *
 * Memory: the integrator, its vectors and matrices stand in an arena (ode_pool.c). SUNDIALS itself takes a few pieces
 * by malloc when an integrator is created, of a fixed size but for six arrays of one entry a root function, and none
 * after that. It answers a refusal of most of them; the first ones, within SUNContext_Create and CVodeCreate, it uses
 * without looking (6.4.1). Those are asked for beforehand, so that a process without memory hears of it here.
 */
#include "base/ode_driver.h"
#include "base/ode_pool.h"
#include "base/parts.h"

#include <stdint.h>
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

typedef struct cvode_ode {
    impact_ode ode;
    imp_ode_pool pool;
    SUNContext sundials;
    void *cvode;
    N_Vector y, outside; /* the state; a vector whose numbers stand in a caller's array */
    N_Vector tolerances; /* NULL when one absolute tolerance serves all */
    SUNNonlinearSolver nonlinear;
    int still;    /* steps in a row that did not change t */
    bool gave_up; /* the right-hand side did, in this start */
} cvode_ode;

static cvode_ode *cvode_of(const impact_ode *ode) { return (cvode_ode *)(uintptr_t)ode; }

/* SUNDIALS' own texts go nowhere: explain() has words for what it answers. */
#if SUNDIALS_VERSION_MAJOR == 6
static void on_error(int code, const char *module, const char *function, char *text, void *context)
{
    (void)code, (void)module, (void)function, (void)text, (void)context;
}
static int open_context(SUNContext *context) { return SUNContext_Create(NULL, context); }
static int quiet(cvode_ode *ode) { return CVodeSetErrHandlerFn(ode->cvode, on_error, ode); }
#else
static void on_error(int line, const char *function, const char *file, const char *text, SUNErrCode code, void *context,
                     SUNContext sundials)
{
    (void)line, (void)function, (void)file, (void)text, (void)code, (void)context, (void)sundials;
}
static int open_context(SUNContext *context) { return SUNContext_Create(SUN_COMM_NULL, context); }
static int quiet(cvode_ode *ode)
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

static impact_status explain_failure(cvode_ode *own, const char *why)
{
    double reached = own->ode.step_end, step = 0;
    if (CVodeGetCurrentTime(own->cvode, &reached) == CV_SUCCESS) CVodeGetCurrentStep(own->cvode, &step);
    return imp_ode_explain(&own->ode, reached, step, why);
}

static int rhs(sunrealtype t, N_Vector y, N_Vector rate, void *context)
{
    const impact_ode *ode = context;
    const int answer = ode->def.rhs(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rate), ode->def.context);
    if (answer < 0) cvode_of(ode)->gave_up = true; /* which fixed-point iteration takes for no more than a long step */
    return answer;
}

static int roots(sunrealtype t, N_Vector y, sunrealtype *value, void *context)
{
    const impact_ode *ode = context;
    for (int i = ode->roots; i < ode->def.roots; i++) value[i] = 1; /* those not at work never cross */
    return imp_ode_root_values(ode, t, N_VGetArrayPointer(y), value);
}

/* A tolerance for each component, copied; or one for all. */
static bool give_tolerances(cvode_ode *own, double relative, const double *absolute, double same)
{
    if (!absolute) return CVodeSStolerances(own->cvode, relative, same) == CV_SUCCESS;
    if (!own->tolerances) own->tolerances = imp_ode_pool_vector(&own->pool);
    memcpy(N_VGetArrayPointer(own->tolerances), absolute, sizeof(double) * (size_t)own->ode.size);
    return CVodeSVtolerances(own->cvode, relative, own->tolerances) == CV_SUCCESS;
}

static bool set_solver(cvode_ode *ode)
{
    if (ode->ode.def.method == IMPACT_ODE_ADAMS) {
        ode->nonlinear = SUNNonlinSol_FixedPoint(ode->y, 0, ode->sundials);
        return ode->nonlinear && CVodeSetNonlinearSolver(ode->cvode, ode->nonlinear) == CV_SUCCESS;
    }
    return CVodeSetLinearSolver(ode->cvode, &ode->pool.solver, imp_ode_pool_matrix(&ode->pool)) == CV_SUCCESS;
}

static bool set_root_directions(cvode_ode *ode)
{
    if (!ode->ode.def.falling_roots_only || ode->ode.def.roots == 0) return true;
    for (int i = 0; i < ode->ode.def.roots; i++) ode->ode.roots_found[i] = -1;
    return CVodeSetRootDirection(ode->cvode, ode->ode.roots_found) == CV_SUCCESS; /* copies */
}

static bool open_sundials(cvode_ode *ode)
{
    void *room = malloc(SUNDIALS_OWN);
    free(room);
    if (!room || open_context(&ode->sundials) != 0) return false;
    ode->cvode = CVodeCreate(ode->ode.def.method == IMPACT_ODE_ADAMS ? CV_ADAMS : CV_BDF, ode->sundials);
    return ode->cvode && quiet(ode) == 0;
}

static bool make_memory(cvode_ode *own)
{
    const impact_ode_def *def = &own->ode.def;
    const bool stiff = def->method == IMPACT_ODE_BDF;
    if (!imp_ode_pool_make(&own->pool, own->ode.arena, own->sundials, def->size, stiff ? VECTORS_BDF : VECTORS_ADAMS,
                           stiff))
        return false;
    own->y = imp_ode_pool_vector(&own->pool);
    own->outside = imp_ode_pool_vector(&own->pool);
    return true;
}

static impact_status cvode_open(impact_ode *ode)
{
    cvode_ode *own = cvode_of(ode);
    const impact_ode_def *def = &ode->def;
    const bool built =
        open_sundials(own) && make_memory(own) && CVodeInit(own->cvode, rhs, 0, own->y) == CV_SUCCESS &&
        give_tolerances(own, def->relative_tolerance, def->absolute_tolerances, def->absolute_tolerance) &&
        set_solver(own) && CVodeSetUserData(own->cvode, ode) == CV_SUCCESS &&
        CVodeSetNoInactiveRootWarn(own->cvode) == CV_SUCCESS &&
        (def->roots == 0 || CVodeRootInit(own->cvode, def->roots, roots) == CV_SUCCESS) && set_root_directions(own);
    return built ? IMPACT_OK : IMPACT_ENOMEM;
}

static void cvode_close(impact_ode *ode)
{
    cvode_ode *own = cvode_of(ode);
    if (own->cvode) CVodeFree(&own->cvode);
    if (own->nonlinear) SUNNonlinSolFree(own->nonlinear);
    imp_ode_pool_free(&own->pool, ode->arena);
    if (own->sundials) SUNContext_Free(&own->sundials);
}

static void cvode_resize(impact_ode *ode) { imp_ode_pool_resize(&cvode_of(ode)->pool, ode->size); }

/* CVODE's counters begin anew at each start. */
static impact_ode_counts cvode_count(const impact_ode *ode)
{
    void *cvode = cvode_of(ode)->cvode;
    impact_ode_counts now = {0};
    CVodeGetNumSteps(cvode, &now.steps);
    CVodeGetNumRhsEvals(cvode, &now.rhs_calls);
    CVodeGetNumErrTestFails(cvode, &now.error_test_failures);
    if (ode->def.roots > 0) CVodeGetNumGEvals(cvode, &now.root_calls);
    return now;
}

static impact_status cvode_start(impact_ode *ode, double t, const double *y)
{
    cvode_ode *own = cvode_of(ode);
    memcpy(N_VGetArrayPointer(own->y), y, sizeof(double) * (size_t)ode->size);
    own->still = 0;
    own->gave_up = false;
    return CVodeReInit(own->cvode, t, own->y) == CV_SUCCESS ? IMPACT_OK : IMPACT_EINTEGRATOR;
}

static bool cvode_limit_step(impact_ode *ode, double max_step)
{
    return CVodeSetMaxStep(cvode_of(ode)->cvode, max_step) == CV_SUCCESS;
}

static impact_status cvode_set_tolerances(impact_ode *ode, double relative, const double *absolute, double same)
{
    if (give_tolerances(cvode_of(ode), relative, absolute, same)) return IMPACT_OK;
    return absolute ? IMPACT_ENOMEM : IMPACT_EARGUMENT;
}

static impact_status cvode_step(impact_ode *ode, double t_stop, double *y, bool *found)
{
    cvode_ode *own = cvode_of(ode);
    if (ode->step_begin == ode->step_end && ode->step_end == t_stop) { /* no way to go, which CVODE would refuse */
        ode->t = t_stop;
        memcpy(y, N_VGetArrayPointer(own->y), sizeof(double) * (size_t)ode->size);
        return IMPACT_OK;
    }
    const double before = ode->t;
    if (CVodeSetStopTime(own->cvode, t_stop) != CV_SUCCESS) return IMPACT_EINTEGRATOR;
    int result = CVode(own->cvode, t_stop, own->y, &ode->t, CV_ONE_STEP);
    if (own->gave_up && (result >= 0 || result == CV_CONV_FAILURE)) result = CV_RHSFUNC_FAIL;
    if (own->pool.spent) return IMPACT_ENOMEM;
    if (result < 0) return explain_failure(own, reason(result));
    memcpy(y, N_VGetArrayPointer(own->y), sizeof(double) * (size_t)ode->size);
    own->still = ode->t == before && result == CV_SUCCESS ? own->still + 1 : 0;
    if (own->still > MAX_STILL)
        return explain_failure(own,
                               "no step is both short enough and long enough to change t: a jump, or a singularity");
    double last = 0;
    CVodeGetCurrentTime(own->cvode, &ode->step_end);
    CVodeGetLastStep(own->cvode, &last);
    ode->step_begin = ode->step_end - last;
    *found = result == CV_ROOT_RETURN;
    if (*found) CVodeGetRootInfo(own->cvode, ode->roots_found);
    return IMPACT_OK;
}

static impact_status cvode_interpolate(const impact_ode *ode, double t, int derivative, double *y)
{
    const cvode_ode *own = cvode_of(ode);
    double *numbers = N_VGetArrayPointer(own->outside);
    N_VSetArrayPointer(y, own->outside);
    const int result = CVodeGetDky(own->cvode, t, derivative, own->outside);
    N_VSetArrayPointer(numbers, own->outside);
    return result == CV_SUCCESS ? IMPACT_OK : IMPACT_EARGUMENT;
}

static const imp_ode_driver cvode_driver = {.bytes = sizeof(cvode_ode),
                                            .open = cvode_open,
                                            .close = cvode_close,
                                            .resize = cvode_resize,
                                            .start = cvode_start,
                                            .limit_step = cvode_limit_step,
                                            .set_tolerances = cvode_set_tolerances,
                                            .step = cvode_step,
                                            .interpolate = cvode_interpolate,
                                            .count = cvode_count};

const imp_ode_driver *imp_part_cvode(void) { return &cvode_driver; }
