/* SPDX-License-Identifier: MIT
 *
 * A contact that gives in the tangent too: Stronge's bilinear springs (Stronge 2000, chapter 5; Jia 2013 in three
 * dimensions), by CVODE.
 *
 * Unit of stiffness: the normal spring while loading, so that the unit of time drops out of the answer. Normal force
 * F' = -uz while loading, F' = -uz / eps^2 while unloading, and loading again up to the greatest F there was (F itself
 * is integrated: told from the indentation it would have that's rounding over eps^2); sticking       f' = -k u_t, k = 1
 * / eta^2, as long as |f| <= mu F; sliding        f = -mu F (cos phi, sin phi), mu F phi' = k u_t . (-sin phi, cos
 * phi), at the speed v = u_t . (cos phi, sin phi) - mu F' / k, as long as v > 0.
 */
#include "base/tolerances.h"
#include "collide/collide_cvode.h"

/* (A, B): f while sticking, phi in A while sliding. */
enum { SPRING_FORCE, SPRING_A, SPRING_B, SPRING_P, SPRING_PX, SPRING_PY, SPRING_WORK, SPRING_FRICTION, SPRING_SIZE };
enum { EVENT_UZ, EVENT_OFF, EVENT_RELOAD, EVENT_GRIP, EVENTS };

struct imp_compliant {
    impact_ode *ode;
    const imp_frame *frame;
    double mu, eps2, k;
    double u[3]; /* before the impact */
    double most; /* the force where unloading began */
    bool loading, sliding;
};

static void velocity(const imp_compliant *c, const double *y, double *u)
{
    const imp_frame *m = c->frame;
    u[0] = c->u[0] + (m->a * y[SPRING_PX] + m->c * y[SPRING_P]);
    u[1] = c->u[1] + (m->b * y[SPRING_PY] + m->d * y[SPRING_P]);
    u[2] = c->u[2] + (m->c * y[SPRING_PX] + m->d * y[SPRING_PY] + y[SPRING_P]);
}

static double force_rate(const imp_compliant *c, double uz) { return c->loading ? -uz : -uz / c->eps2; }

static void tangential(const imp_compliant *c, const double *y, double F, double *f)
{
    f[0] = c->sliding ? -c->mu * F * cos(y[SPRING_A]) : y[SPRING_A];
    f[1] = c->sliding ? -c->mu * F * sin(y[SPRING_A]) : y[SPRING_B];
}

static double slide_speed(const imp_compliant *c, const double *y, const double *u)
{
    return u[0] * cos(y[SPRING_A]) + u[1] * sin(y[SPRING_A]) - c->mu * force_rate(c, u[2]) / c->k;
}

static int spring_rates(double t, const double *y, double *rate, void *context)
{
    (void)t;
    const imp_compliant *c = context;
    double u[3], f[2];
    velocity(c, y, u);
    const double F = y[SPRING_FORCE];
    tangential(c, y, F, f);
    rate[SPRING_FORCE] = force_rate(c, u[2]);
    rate[SPRING_P] = F;
    rate[SPRING_PX] = f[0];
    rate[SPRING_PY] = f[1];
    rate[SPRING_WORK] = F * u[2];
    rate[SPRING_FRICTION] = f[0] * u[0] + f[1] * u[1];
    if (c->sliding) {
        /* Where the force is small phi follows u_t at once; the rate is bounded. */
        const double least = IMP_COMPLIANT_FOLLOWS * c->k * hypot(u[0], u[1]) + IMP_COMPLIANT_LEAST;
        rate[SPRING_A] = c->k * (u[1] * cos(y[SPRING_A]) - u[0] * sin(y[SPRING_A])) / fmax(c->mu * F, least);
        rate[SPRING_B] = 0;
    } else {
        rate[SPRING_A] = -c->k * u[0];
        rate[SPRING_B] = -c->k * u[1];
    }
    return 0;
}

static int spring_events(double t, const double *y, double *value, void *context)
{
    (void)t;
    const imp_compliant *c = context;
    double u[3];
    velocity(c, y, u);
    const double F = y[SPRING_FORCE];
    value[EVENT_UZ] = u[2];
    value[EVENT_OFF] = c->loading ? 1 : F - IMP_COMPLIANT_OFF * c->most;
    value[EVENT_RELOAD] = c->loading ? -1 : F - c->most;
    value[EVENT_GRIP] = c->sliding ? slide_speed(c, y, u)
                                   : c->mu * c->mu * F * F - (y[SPRING_A] * y[SPRING_A] + y[SPRING_B] * y[SPRING_B]);
    return 0;
}

static impact_status make(imp_arena *arena, double tolerance, imp_compliant **out)
{
    imp_compliant *c = imp_arena_take(arena, 1, sizeof *c);
    *out = NULL;
    if (!c) return IMPACT_ENOMEM;
    const impact_ode_def def = {.struct_size = sizeof def,
                                .size = SPRING_SIZE,
                                .roots = EVENTS,
                                .rhs = spring_rates,
                                .root_functions = spring_events,
                                .context = c,
                                .method = IMPACT_ODE_BDF,
                                .relative_tolerance = tolerance,
                                .absolute_tolerance = 0.1 * tolerance};
    const impact_status status = imp_ode_create_in(arena, &def, &c->ode);
    if (status != IMPACT_OK) {
        imp_arena_give(arena, c);
        return status;
    }
    *out = c;
    return IMPACT_OK;
}

void imp_compliant_destroy(imp_arena *arena, imp_compliant *c)
{
    if (!c) return;
    impact_ode_destroy(c->ode);
    imp_arena_give(arena, c);
}

/* The first instant, in closed form: the springs are loaded in proportion to time. */
static void begin(imp_compliant *c, const imp_course *course, double *y)
{
    const double t = IMP_COMPLIANT_BEGIN;
    c->frame = course->frame;
    c->mu = course->mu;
    c->eps2 = course->eps * course->eps;
    c->u[0] = course->ux;
    c->u[1] = course->uy;
    c->u[2] = course->uz;
    c->loading = true;
    c->sliding = c->k * course->s > c->mu;
    c->most = 0;
    const double x = course->s > 0 ? course->ux / course->s : 1, z = course->s > 0 ? course->uy / course->s : 0;
    const double pull = c->sliding ? c->mu : c->k * course->s;
    for (int i = 0; i < SPRING_SIZE; i++) y[i] = 0;
    y[SPRING_FORCE] = t;
    y[SPRING_A] = c->sliding ? atan2(z, x) : -pull * x * t;
    y[SPRING_B] = c->sliding ? 0 : -pull * z * t;
    y[SPRING_P] = t * t / 2;
    y[SPRING_PX] = -pull * x * y[SPRING_P];
    y[SPRING_PY] = -pull * z * y[SPRING_P];
    y[SPRING_WORK] = -y[SPRING_P];
    y[SPRING_FRICTION] = -pull * course->s * y[SPRING_P];
}

/* Takes what came since the last event into the course. */
static void book(imp_course *course, const imp_compliant *c, const double *y, double *before)
{
    double u[3];
    velocity(c, y, u);
    const bool cp = course->compressing;
    imp_course_phase(course,
                     c->sliding ? (cp ? IMPACT_SLIP_C : IMPACT_SLIP_R) : (cp ? IMPACT_STICK_C : IMPACT_STICK_R));
    imp_course_book(course, y[SPRING_P] - before[SPRING_P], y[SPRING_WORK] - before[SPRING_WORK],
                    y[SPRING_FRICTION] - before[SPRING_FRICTION]);
    course->px = y[SPRING_PX];
    course->py = y[SPRING_PY];
    course->ux = u[0];
    course->uy = u[1];
    course->s = hypot(u[0], u[1]);
    imp_course_reach(course, u[2]);
    for (int i = 0; i < SPRING_SIZE; i++) before[i] = y[i];
}

/* Lets go of what little force is left: impulse F^2 / (2 |F'|), at the edge of the cone. */
static void let_go(imp_course *course, imp_compliant *c, double *y, double *before)
{
    double u[3], f[2];
    velocity(c, y, u);
    const double F = fmax(y[SPRING_FORCE], 0), dp = u[2] > 0 ? F * F * c->eps2 / (2 * u[2]) : 0;
    tangential(c, y, F, f);
    y[SPRING_P] += dp;
    y[SPRING_WORK] += u[2] * dp;
    if (F > 0) {
        y[SPRING_PX] += f[0] / F * dp;
        y[SPRING_PY] += f[1] / F * dp;
    }
    book(course, c, y, before);
    course->ended = true;
}

static void change_grip(imp_compliant *c, double *y)
{
    if (c->sliding) {
        const double F = y[SPRING_FORCE], x = cos(y[SPRING_A]), z = sin(y[SPRING_A]);
        y[SPRING_A] = -c->mu * F * x;
        y[SPRING_B] = -c->mu * F * z;
    } else {
        y[SPRING_A] = atan2(-y[SPRING_B], -y[SPRING_A]);
        y[SPRING_B] = 0;
    }
    c->sliding = !c->sliding;
}

static impact_status follow_springs(imp_course *course, imp_compliant *c)
{
    double y[SPRING_SIZE], before[SPRING_SIZE] = {0}, t = 0;
    const long most_steps = impact_ode_count(c->ode).steps + IMP_COLLIDE_COMPLIANT_STEPS;
    begin(c, course, y);
    for (int events = 0; events < 200; events++) {
        int found[EVENTS];
        bool any = false;
        impact_status status = impact_ode_start(c->ode, t, y);
        for (double stop = t + 10; status == IMPACT_OK && !any; stop += 10) {
            status = impact_ode_advance(c->ode, stop, &t, y, found, &any);
            if (stop > IMP_COMPLIANT_LONGEST || impact_ode_count(c->ode).steps > most_steps) return IMPACT_EUNSETTLED;
        }
        if (status != IMPACT_OK) return status;
        book(course, c, y, before);
        if (found[EVENT_OFF] < 0) {
            let_go(course, c, y, before);
            return IMPACT_OK;
        }
        if (found[EVENT_UZ] && course->compressing == (found[EVENT_UZ] > 0)) {
            imp_course_turn(course);
            if (c->eps2 == 0) {
                course->ended = true;
                return IMPACT_OK;
            }
            if (c->loading) {
                c->most = y[SPRING_FORCE];
                c->loading = false;
            }
        }
        /* Past the greatest force the virgin line goes on from where it was left. */
        if (found[EVENT_RELOAD] > 0 && course->compressing) c->loading = true;
        if (found[EVENT_GRIP] < 0) change_grip(c, y);
    }
    return IMPACT_EUNSETTLED;
}

impact_status imp_compliant_solve(imp_arena *arena, imp_course *course, double compliance, double tolerance,
                                  imp_compliant **keep)
{
    if (!*keep) {
        const impact_status status = make(arena, tolerance, keep);
        if (status != IMPACT_OK) return status;
    }
    (*keep)->k = 1 / compliance;
    return follow_springs(course, *keep);
}
