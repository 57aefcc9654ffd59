/* SPDX-License-Identifier: MIT
 *
 * The phases of an impact by CVODE in (ln s, theta): d ln s / dtau = R, dtheta / dtau = T are bounded and independent
 * of s where mu is constant, so the error control sees the last way to s = 0 as a straight line. Roots: uz = 0, Z = 0
 * (so that no pair of roots of uz can hide in one step), the end of restitution, and s small enough to go on along a
 * line.
 */
#include "collide/collide_cvode.h"

#include "base/tolerances.h"

enum { SLIP_LOG_S, SLIP_THETA, SLIP_P, SLIP_PX, SLIP_PY, SLIP_WORK, SLIP_FRICTION, SLIP_SIZE };
enum { ROOT_UZ, ROOT_CLIMB, ROOT_END, ROOT_STOP, ROOTS };

struct impact_collide_workspace {
    imp_arena *arena;
    bool owns_arena;
    impact_ode *ode;
    imp_compliant *compliant; /* made when first needed */
    double tolerance;
    impact_ode_method method;
    /* The impact at hand; the integrals in y count from the last start. */
    const imp_course *course;
    impact_friction_law *law;
    void *law_context;
    double speed, log_stop;
    long most_steps;    /* of the integrator, by the end of this impact */
    double climb_shift; /* keeps a zero of Z that was found from being found again */
};

static double friction_at(const impact_collide_workspace *ws, double s)
{
    return ws->law ? ws->law(s * ws->speed, ws->law_context) : ws->course->mu;
}

static double uz_of(const impact_collide_workspace *ws, const double *y)
{
    const imp_frame *frame = ws->course->frame;
    return ws->course->uz + (frame->c * y[SLIP_PX] + frame->d * y[SLIP_PY] + y[SLIP_P]);
}

static int slip_rates(double tau, const double *y, double *rate, void *context)
{
    (void)tau;
    const impact_collide_workspace *ws = context;
    const double s = exp(y[SLIP_LOG_S]), x = cos(y[SLIP_THETA]), z = sin(y[SLIP_THETA]), mu = friction_at(ws, s);
    if (!(mu >= 0 && isfinite(mu))) return -1;
    rate[SLIP_LOG_S] = imp_course_sliding(ws->course->frame, mu, x, z).R;
    rate[SLIP_THETA] = imp_course_turning(ws->course->frame, mu, x, z);
    rate[SLIP_P] = s;
    rate[SLIP_PX] = -mu * s * x;
    rate[SLIP_PY] = -mu * s * z;
    rate[SLIP_WORK] = s * uz_of(ws, y);
    rate[SLIP_FRICTION] = -mu * s * s;
    return 0;
}

static int slip_roots(double tau, const double *y, double *value, void *context)
{
    (void)tau;
    const impact_collide_workspace *ws = context;
    const imp_course *course = ws->course;
    const double mu = friction_at(ws, exp(y[SLIP_LOG_S]));
    value[ROOT_UZ] = uz_of(ws, y);
    value[ROOT_CLIMB] =
        ws->climb_shift + imp_course_sliding(course->frame, mu, cos(y[SLIP_THETA]), sin(y[SLIP_THETA])).Z;
    value[ROOT_STOP] = y[SLIP_LOG_S] - ws->log_stop;
    value[ROOT_END] = -1;
    if (course->compressing) return 0;
    switch (course->law) {
    case IMPACT_POISSON: value[ROOT_END] = y[SLIP_P] - imp_course_left_poisson(course); break;
    case IMPACT_NEWTON: value[ROOT_END] = value[ROOT_UZ] - imp_course_target_newton(course); break;
    case IMPACT_STRONGE: value[ROOT_END] = y[SLIP_WORK] - imp_course_left_stronge(course); break;
    }
    return 0;
}

impact_status imp_collide_workspace_in(imp_arena *arena, impact_ode_method method, double tolerance,
                                       impact_collide_workspace **workspace)
{
    *workspace = NULL;
    if (!impact_has(IMPACT_PART_CVODE)) return IMPACT_EABSENT;
    if (!(tolerance >= IMP_COLLIDE_CVODE_LEAST && tolerance <= IMP_COLLIDE_CVODE_MOST)) return IMPACT_EARGUMENT;
    impact_collide_workspace *ws = imp_arena_take(arena, 1, sizeof *ws);
    if (!ws) return IMPACT_ENOMEM;
    ws->arena = arena;
    ws->tolerance = tolerance;
    ws->method = method;
    const impact_ode_def def = {.struct_size = sizeof def,
                                .size = SLIP_SIZE,
                                .roots = ROOTS,
                                .rhs = slip_rates,
                                .root_functions = slip_roots,
                                .context = ws,
                                .method = method,
                                .relative_tolerance = tolerance,
                                .absolute_tolerance = tolerance,
                                .max_steps = IMP_COLLIDE_CVODE_STEPS};
    const impact_status status = imp_ode_create_in(arena, &def, &ws->ode);
    if (status != IMPACT_OK) {
        imp_arena_give(arena, ws);
        return status;
    }
    *workspace = ws;
    return IMPACT_OK;
}

impact_status impact_collide_workspace_create_with(const impact_allocator *allocator, impact_ode_method method,
                                                   double tolerance, impact_collide_workspace **workspace)
{
    imp_arena *arena;
    *workspace = NULL;
    impact_status status = imp_arena_create(allocator, &arena);
    if (status != IMPACT_OK) return status;
    status = imp_collide_workspace_in(arena, method, tolerance, workspace);
    if (status == IMPACT_OK)
        (*workspace)->owns_arena = true;
    else
        imp_arena_destroy(arena);
    return status;
}

impact_status impact_collide_workspace_create(impact_ode_method method, double tolerance,
                                              impact_collide_workspace **workspace)
{
    return impact_collide_workspace_create_with(NULL, method, tolerance, workspace);
}

impact_status imp_cvode_workspace_like(const impact_collide_workspace *pattern, impact_collide_workspace **workspace)
{
    if (!pattern) return impact_collide_workspace_create(IMPACT_ODE_ADAMS, IMP_COLLIDE_CVODE_FINEST, workspace);
    return impact_collide_workspace_create(pattern->method, pattern->tolerance, workspace);
}

void impact_collide_workspace_destroy(impact_collide_workspace *workspace)
{
    if (!workspace) return;
    imp_arena *arena = workspace->arena;
    const bool owns_arena = workspace->owns_arena;
    impact_ode_destroy(workspace->ode);
    imp_compliant_destroy(arena, workspace->compliant);
    imp_arena_give(arena, workspace);
    if (owns_arena) imp_arena_destroy(arena);
}

impact_memory impact_collide_workspace_memory(const impact_collide_workspace *workspace)
{
    return imp_arena_memory(workspace->arena);
}

impact_ode_counts impact_collide_workspace_count(const impact_collide_workspace *workspace)
{
    return impact_ode_count(workspace->ode);
}

double imp_cvode_tolerance(const impact_collide_workspace *workspace)
{
    return workspace ? workspace->tolerance : IMP_COLLIDE_CVODE_FINEST;
}

/* Takes what was integrated since the last start into the course. */
static void take(imp_course *course, const impact_collide_workspace *ws, const double *y)
{
    const double uz = uz_of(ws, y);
    imp_course_phase(course, course->compressing ? IMPACT_SLIP_C : IMPACT_SLIP_R);
    imp_course_book(course, y[SLIP_P], y[SLIP_WORK], y[SLIP_FRICTION]);
    course->px += y[SLIP_PX];
    course->py += y[SLIP_PY];
    imp_course_reach(course, uz);
    course->s = exp(y[SLIP_LOG_S]);
    course->ux = course->s * cos(y[SLIP_THETA]);
    course->uy = course->s * sin(y[SLIP_THETA]);
}

static bool over_at_once(const imp_course *course)
{
    if (course->compressing) return false;
    switch (course->law) {
    case IMPACT_POISSON: return imp_course_left_poisson(course) <= 0;
    case IMPACT_NEWTON: return course->uz >= imp_course_target_newton(course);
    case IMPACT_STRONGE: return imp_course_left_stronge(course) <= 0;
    }
    return false;
}

/* To the next root, or to where the direction no longer turns (a stiff straight line: *settled). */
static impact_status to_root(const imp_course *course, impact_collide_workspace *ws, double *y, int *found,
                             bool *settled)
{
    const imp_frame *frame = course->frame;
    const double mu = friction_at(ws, course->s);
    const double rate = fabs(frame->c) + fabs(frame->d) + mu * fmax(frame->a, frame->b);
    y[SLIP_LOG_S] = log(course->s);
    y[SLIP_THETA] = atan2(course->uy, course->ux);
    for (int i = SLIP_P; i < SLIP_SIZE; i++) y[i] = 0;
    *settled = false;
    impact_status status = impact_ode_start(ws->ode, 0, y);
    double tau = 0;
    bool any = false;
    for (double stop = 100 / (rate + course->s); status == IMPACT_OK && !any && !*settled; stop *= 4) {
        if (stop > IMP_COLLIDE_CVODE_LONGEST / (rate + course->s) || impact_ode_count(ws->ode).steps > ws->most_steps)
            return IMPACT_EUNSETTLED;
        status = impact_ode_advance(ws->ode, stop, &tau, y, found, &any);
        *settled = !any && !ws->law &&
                   fabs(imp_course_turning(frame, mu, cos(y[SLIP_THETA]), sin(y[SLIP_THETA]))) <= ws->tolerance * rate;
    }
    return status;
}

/* The rest of a slip along a line, at the friction of its end. */
static void straight(imp_course *course, impact_collide_workspace *ws)
{
    const double mu = friction_at(ws, 0);
    const double held = course->mu;
    course->mu = mu;
    imp_course_slide(course, course->ux / course->s, course->uy / course->s);
    course->mu = held;
}

/* One slip to its stop or to the end of the impact. */
static impact_status slide(imp_course *course, impact_collide_workspace *ws)
{
    ws->climb_shift = 0;
    /* Between its roots of Z (two at most), of u_z and of the end a slip has few pieces. */
    for (int pieces = 0; pieces < 4 * IMPACT_MAX_PHASES && !course->ended && course->s > 0; pieces++) {
        if (over_at_once(course)) {
            course->ended = true;
            return IMPACT_OK;
        }
        double y[SLIP_SIZE];
        int found[ROOTS];
        bool settled;
        const impact_status status = to_root(course, ws, y, found, &settled);
        if (status != IMPACT_OK) return status;
        take(course, ws, y);
        if (settled || found[ROOT_STOP] < 0)
            straight(course, ws);
        else if (found[ROOT_END] > 0)
            course->ended = true;
        else if (found[ROOT_UZ] && course->compressing == (found[ROOT_UZ] > 0))
            imp_course_turn(course);
        if (found[ROOT_CLIMB]) ws->climb_shift = IMP_COLLIDE_CLIMB * found[ROOT_CLIMB];
    }
    return IMPACT_OK;
}

static impact_status follow_slips(imp_course *course, impact_collide_workspace *ws)
{
    for (int slips = 0; slips < 16; slips++) {
        if (course->s > 0) {
            const impact_status status = slide(course, ws);
            if (status != IMPACT_OK || course->ended) return status;
        }
        const double mu = friction_at(ws, 0);
        if (!(mu >= 0 && isfinite(mu))) return IMPACT_EDOMAIN;
        const imp_line line = imp_course_from_rest(course->frame, mu);
        if (!line.stick && course->phase_count > 0) imp_course_phase(course, IMPACT_REVERSAL);
        if (line.stick || !ws->law) {
            course->mu = mu;
            imp_course_line(course, &line, INFINITY);
            return IMPACT_OK;
        }
        /* mu will change as the slip gathers speed: on by CVODE from a speed that is nothing. */
        course->s = IMP_COLLIDE_CVODE_ONSET * exp(ws->log_stop);
        course->ux = -line.gx / mu * course->s;
        course->uy = -line.gy / mu * course->s;
    }
    return IMPACT_EUNSETTLED;
}

impact_status imp_cvode_solve(imp_course *course, const impact_collision *collision, double speed)
{
    impact_collide_workspace *ws = collision->workspace;
    if (!ws) {
        const impact_status status = imp_cvode_workspace_like(NULL, &ws);
        if (status != IMPACT_OK) return status;
    }
    ws->course = course;
    ws->law = collision->friction_law;
    ws->law_context = collision->friction_context;
    ws->speed = speed;
    ws->most_steps = impact_ode_count(ws->ode).steps + IMP_COLLIDE_CVODE_STEPS;
    ws->log_stop = log(IMP_COLLIDE_CVODE_STOP * ws->tolerance * (course->s > 0 ? fmin(course->s, 1) : 1));
    impact_status status =
        collision->tangential_compliance > 0
            ? imp_compliant_solve(ws->arena, course, collision->tangential_compliance, ws->tolerance, &ws->compliant)
            : follow_slips(course, ws);
    if (status == IMPACT_OK && !course->ended) status = IMPACT_EUNSETTLED;
    ws->course = NULL;
    if (!collision->workspace) impact_collide_workspace_destroy(ws);
    return status;
}
