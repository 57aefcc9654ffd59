/* SPDX-License-Identifier: MIT
 *
 * An integrator asks a force at the ends of its steps, and its error test knows nothing of what lies between. There the
 * step's polynomial p is asked whether it is a solution: |p' - f(t, p)| h is the defect of the step, and of the size of
 * its error where f is smooth. (Enright, "A new error control for initial value solvers", 1989.)
 */
#include "motion/motion_guard.h"
#include "base/number.h"
#include "motion/motion_equations.h"

#include <stdio.h>
#include <string.h>

/* ---- steps ---- */

static double *state_before(const imp_motion *motion) { return motion->probe + 3 * motion->size; }

/* Of a step of the explicit method, part of the time in which slip that fades, as it does now, is gone: behind that its
 * friction turns round. */
static double fading_limit(const imp_motion *motion)
{
    double limit = INFINITY;
    if (motion->ode != motion->dop853) return limit; /* others go by a clock that slip slows */
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        const double fall = -qvec3_dot(contact->slip, contact->slip_rate);
        if (contact->mode == IMP_SLIDE && contact->friction > 0 && fall > 0)
            limit = fmin(limit, IMP_FADING_PART * contact->speed * contact->speed / fall);
    }
    return limit;
}

double imp_motion_step_limit(imp_motion *motion, const double *y)
{
    imp_motion_unpack(motion, y, motion->scratch);
    return fmin(fading_limit(motion), fmin(imp_field_step_limit(motion->world, motion->scratch, motion->loads),
                                           imp_field_custom_step_limit(motion->world, motion->scratch, motion->loads)));
}

bool imp_motion_has_custom_force(const imp_world *world)
{
    for (int k = 0; k < world->field_count; k++)
        if (world->fields[k].def.kind == IMPACT_FORCE_CUSTOM) return true;
    return false;
}

/* The last step's defect at tau, over the error that is allowed. */
static double defect(imp_motion *motion, double tau, double h)
{
    const int size = motion->size;
    double *p = motion->probe, *slope = p + size, *rate = slope + size, worst = 0;
    if (impact_ode_interpolate(motion->ode, tau, 0, p) != IMPACT_OK ||
        impact_ode_interpolate(motion->ode, tau, 1, slope) != IMPACT_OK || imp_motion_rates(tau, p, rate, motion) != 0)
        return 0; /* what a force refuses is told where the integrator meets it */
    for (int i = Y_BODIES; i < size; i++)
        worst = fmax(worst, fabs(slope[i] - rate[i]) * h / (motion->relative * fabs(p[i]) + motion->absolute[i]));
    return worst;
}

/* Asked at thirds of the step. Leaves the contacts as they are at the step's end. A fixed step is not asked. */
static bool step_is_seen(imp_motion *motion, double tau, const double *y)
{
    if (!imp_motion_has_custom_force(motion->world) || motion->method == IMPACT_MOTION_RK4) return true;
    double low, high;
    impact_ode_last_step(motion->ode, &low, &high);
    const double h = high - low;
    const bool seen = defect(motion, low + h / 3, h) <= IMP_DEFECT && defect(motion, high - h / 3, h) <= IMP_DEFECT;
    imp_motion_rates(tau, y, motion->probe, motion);
    return seen;
}

impact_status imp_motion_step(imp_motion *motion, double stop, double *tau, double *y, bool *found)
{
    enum { REFUSALS = 10 };
    const double tau_before = *tau;
    double *before = state_before(motion), part = 1;
    memcpy(before, y, sizeof *y * (size_t)motion->size);
    for (int refused = 0;; refused++, part *= 0.25) {
        const double limit = part * imp_motion_step_limit(motion, y);
        impact_status status = impact_ode_limit_step(motion->ode, isfinite(limit) ? limit : 0);
        if (status == IMPACT_OK) status = impact_ode_step(motion->ode, stop, tau, y, motion->found, found);
        if (status != IMPACT_OK || refused == REFUSALS || step_is_seen(motion, *tau, y)) return status;
        *tau = tau_before;
        memcpy(y, before, sizeof *y * (size_t)motion->size);
        status = impact_ode_start(motion->ode, tau_before, y);
        if (status != IMPACT_OK) return status;
    }
}

/* ---- losses ---- */

bool imp_motion_loss_falls(imp_motion *motion, const double *y)
{
    const double *before = state_before(motion);
    motion->last_fall = 0;
    if (motion->method == IMPACT_MOTION_RK4) return false; /* there is no other method to go on with */
    for (int k = Y_DAMPING; k <= Y_SLIDING; k++) {
        const double fall = before[k] - y[k];
        const double error = IMP_LOSS_ERRORS * (motion->relative * fabs(y[k]) + motion->absolute[k]);
        if (fall > error) motion->last_fall += fall;
    }
    motion->steady_steps = motion->last_fall > 0 ? 0 : motion->steady_steps + 1;
    motion->retried = motion->retried && motion->steady_steps < IMP_TRUSTED_STEPS;
    if (motion->last_fall == 0) return false;
    if (motion->fallen == 0) motion->fell_at = before[Y_TIME];
    motion->fallen += motion->last_fall;
    return true;
}

bool imp_motion_take_back(imp_motion *motion, double *y)
{
    motion->distrusted = !motion->retried;
    if (motion->retried) return false;
    motion->retried = true;
    memcpy(y, state_before(motion), sizeof *y * (size_t)motion->size);
    motion->fallen -= motion->last_fall;
    return true;
}

/* ---- time ---- */

bool imp_motion_finite_or_back(const imp_motion *motion, double *y)
{
    double sum = 0;
    for (int i = 0; i < motion->size; i++) sum += 0 * y[i];
    if (sum == 0) return true;
    memcpy(y, state_before(motion), sizeof *y * (size_t)motion->size);
    return false;
}

bool imp_motion_gains(imp_motion *motion, double t)
{
    enum { WINDOW = 100000 };
    if (++motion->pace_steps < WINDOW) return true;
    const bool gains = !(t - motion->pace_began < WINDOW * IMP_SHORTEST_STEP * fabs(t));
    motion->pace_steps = 0;
    motion->pace_began = t;
    return gains;
}

/* ---- words ---- */

/* How fast a body crosses its own size, 1/s. */
static double quickness(const imp_motion *motion, int i)
{
    const imp_body *body = &motion->world->bodies[i];
    const double push = qvec3_norm(motion->loads[i].force) * body->inverse_mass;
    return imp_motion_speed(body, &motion->scratch[i]) / body->radius + sqrt(push / body->radius);
}

impact_status imp_motion_stuck(imp_motion *motion, const char *what, double t)
{
    const imp_world *world = motion->world;
    int quickest = -1;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static && (quickest < 0 || !(quickness(motion, i) <= quickness(motion, quickest))))
            quickest = i;
    snprintf(motion->message, sizeof motion->message, "%s at t = %s, where body '%s' moves fastest for its size", what,
             imp_number_of(t).text, quickest < 0 ? "" : world->bodies[quickest].name);
    return IMPACT_EUNSETTLED;
}
