/* SPDX-License-Identifier: MIT
 *
 * The door of the room: scales, picks a solver, and turns a finished course into an outcome.
 */
#include "collide/collide_cvode.h"
#include "collide/collide_direct.h"
#include "collide/collide_isotropic.h"
#include "collide/collide_series.h"

#include <float.h>

/* Condition of M from which the last rounding is mended. */
static const double ill_conditioned = 100;

/* ---- from the caller's units to scaled ones and back ---- */

/* omega: local axes. */
static inline double energy(const imp_ready *ready, const imp_vectors *velocity, const imp_vectors *omega)
{
    const imp_vectors momentum = imp_vectors_weigh(&ready->moments, omega);
    const imp_pair each = 0.5 * (ready->mass * imp_vectors_dot(velocity, velocity) + imp_vectors_dot(&momentum, omega));
    return each[0] + each[1];
}

/* What an impulse on body 1, and its opposite on body 2, does to the velocities of both; and their energies. */
static void push(const imp_ready *ready, qvec3 impulse, impact_outcome *outcome)
{
    const imp_vectors each = imp_vectors_of(impulse, qvec3_neg(impulse)), there = imp_ready_local(ready, &each);
    const imp_vectors turn = imp_vectors_cross(&ready->offset, &there);
    const imp_vectors spin = imp_vectors_weigh(&ready->inverse_moments, &turn), out = imp_ready_world(ready, &spin);
    const imp_vectors velocity = imp_vectors_add(&ready->velocity, ready->inverse_mass, &each);
    const imp_vectors before = imp_ready_local(ready, &ready->omega);
    const imp_pair one = {1, 1};
    const imp_vectors after = imp_vectors_add(&before, one, &spin), omega = imp_vectors_add(&ready->omega, one, &out);
    outcome->energy_before = energy(ready, &ready->velocity, &before);
    outcome->energy_after = energy(ready, &velocity, &after);
    for (int i = 0; i < 2; i++) {
        outcome->velocity[i] = imp_vectors_at(&velocity, i);
        outcome->omega[i] = imp_vectors_at(&omega, i);
    }
}

/* M^-1 times a change of the contact's velocity. */
static qvec3 impulse_for(const imp_frame *frame, qvec3 du)
{
    const double ux = qvec3_dot(du, frame->t1), uy = qvec3_dot(du, frame->t2), uz = qvec3_dot(du, frame->n);
    const double z = (uz + frame->alpha * ux + frame->beta * uy) / frame->k;
    const double x_left = ux - frame->c * z, y_left = uy - frame->d * z;
    const double y = (y_left - frame->e / frame->a * x_left) / frame->schur, x = (x_left - frame->e * y) / frame->a;
    return qvec3_scale(qvec3_axpy(x, frame->t1, qvec3_axpy(y, frame->t2, qvec3_scale(frame->n, z))), 1 / frame->scale);
}

/* A contact that sticks must end with u = (0, 0, uz). Where M is ill-conditioned, rounding of the impulse turns the
 * bodies by more than that allows: what is missing is given to their velocities, not to the impulse, which is right to
 * its own rounding. */
static void refine(const imp_ready *ready, const imp_frame *frame, double uz, impact_outcome *outcome)
{
    imp_ready after = *ready;
    after.velocity = imp_vectors_of(outcome->velocity[0], outcome->velocity[1]);
    after.omega = imp_vectors_of(outcome->omega[0], outcome->omega[1]);
    const qvec3 missing = qvec3_axpy(uz, frame->n, qvec3_neg(imp_ready_velocity(&after)));
    const double before = outcome->energy_before;
    push(&after, impulse_for(frame, missing), outcome);
    outcome->energy_before = before;
}

static void unchanged(const impact_collision *collision, impact_outcome *outcome, double value)
{
    *outcome = (impact_outcome){.impulse = {value, value, value}};
    for (int i = 0; i < 2; i++) {
        outcome->velocity[i] = collision->body[i].velocity;
        outcome->omega[i] = collision->body[i].omega;
    }
    outcome->impulse_normal = outcome->impulse_tangential = outcome->compression_impulse = value;
    outcome->work_compression = outcome->work_restitution = outcome->work_friction = value;
    outcome->normal_before = outcome->normal_after = outcome->energy_before = outcome->energy_after = value;
    outcome->conditioning = value;
}

static void report(const impact_collision *collision, const imp_ready *ready, const imp_course *course, double speed,
                   impact_outcome *outcome)
{
    const imp_frame *frame = course->frame;
    const double unit = speed / frame->scale, joule = speed * unit;
    double px = course->px, py = course->py;
    /* Friction's direction rounds: the cone is kept to the last bit. */
    const double across2 = px * px + py * py, most = course->mu * course->p;
    if (!collision->friction_law && across2 > most * most) {
        const double f = most / sqrt(across2) * (1 - 1e-16);
        px *= f;
        py *= f;
    }
    const qvec3 n = qvec3_scale(frame->n, course->p * unit);
    const qvec3 t = qvec3_axpy(px * unit, frame->t1, qvec3_scale(frame->t2, py * unit));
    outcome->impulse = qvec3_add(n, t);
    outcome->impulse_normal = course->p * unit;
    outcome->impulse_tangential = sqrt(px * px + py * py) * unit;
    outcome->normal_before = -speed;
    outcome->normal_after = course->uz * speed;
    outcome->compression_impulse = course->p_c * unit;
    outcome->work_compression = course->work_c * joule;
    outcome->work_restitution = course->work_r * joule;
    outcome->work_friction = course->work_f * joule;
    outcome->compressions = course->compressions;
    outcome->jammed = course->jammed;
    outcome->phase_count = course->phase_count;
    for (int i = 0; i < course->phase_count; i++) outcome->phases[i] = course->phases[i];
    outcome->conditioning = frame->conditioning;
    outcome->energy_rose = course->work_c + course->work_r + course->work_f > -1e-12 * course->work_c;
    push(ready, outcome->impulse, outcome);
    const impact_phase last = course->phase_count > 0 ? course->phases[course->phase_count - 1] : IMPACT_SLIP_C;
    const bool sticks = (last == IMPACT_STICK_C || last == IMPACT_STICK_R) && outcome->solver != IMPACT_SOLVER_CVODE;
    if (sticks && frame->conditioning > ill_conditioned) refine(ready, frame, course->uz * speed, outcome);
}

/* A tangential velocity below this is what is left of larger ones that cancel: the contact rolls, and starts from u_t =
 * 0. */
static double rounding_of_velocity(const imp_ready *ready)
{
    const imp_pair each =
        imp_vectors_size(&ready->velocity) + imp_vectors_size(&ready->omega) * imp_vectors_size(&ready->arm);
    return DBL_MIN + 0x1p-51 * (each[0] + each[1]);
}

static impact_status fail(const impact_collision *collision, impact_outcome *outcome, impact_status status)
{
    unchanged(collision, outcome, NAN);
    return status;
}

static bool needs_cvode(const impact_collision *collision)
{
    const bool compliant = collision->tangential_compliance > 0 && collision->friction > 0;
    return collision->solver == IMPACT_SOLVER_CVODE || collision->friction_law || compliant;
}

static bool may_be_closed(const impact_collision *collision)
{
    const bool asked = collision->solver == IMPACT_SOLVER_AUTO || collision->solver == IMPACT_SOLVER_CLOSED_FORM;
    return asked && !needs_cvode(collision);
}

/* Solves what has a closed form: sliding that does not turn, or turns alike in all directions. */
static bool closed_form(imp_course *course)
{
    if (imp_course_straight(course)) return true;
    if (!imp_isotropic_is(course->frame)) return false;
    imp_isotropic_solve(course);
    return true;
}

/* Along the principal directions, which the series and CVODE ask for. */
static void turn_to_principal(const imp_ready *ready, imp_frame *frame, imp_course *course)
{
    const qvec3 t1 = frame->t1;
    imp_frame_turn(ready, frame);
    course->ux = course->s * qvec3_dot(t1, frame->t1);
    course->uy = course->s * qvec3_dot(t1, frame->t2);
}

static impact_status solve(const impact_collision *collision, const imp_ready *ready, imp_frame *frame,
                           imp_course *course, double speed, impact_outcome *outcome)
{
    if (may_be_closed(collision) && closed_form(course)) {
        outcome->solver = IMPACT_SOLVER_CLOSED_FORM;
        return course->ended ? IMPACT_OK : IMPACT_EUNSETTLED;
    }
    if (collision->solver == IMPACT_SOLVER_CLOSED_FORM) return IMPACT_EARGUMENT;
    turn_to_principal(ready, frame, course);
    if (needs_cvode(collision)) {
        outcome->solver = IMPACT_SOLVER_CVODE;
        return imp_cvode_solve(course, collision, speed);
    }
    outcome->solver = IMPACT_SOLVER_SERIES;
    const int order = collision->series_order == 0 ? IMP_SERIES_ORDER : collision->series_order;
    return imp_series_solve(course, order) ? IMPACT_OK : IMPACT_EUNSETTLED;
}

/* Nothing happens, and says so. */
static void separate(const impact_collision *collision, const imp_ready *ready, double approach,
                     impact_outcome *outcome)
{
    unchanged(collision, outcome, 0);
    const imp_vectors omega = imp_ready_local(ready, &ready->omega);
    outcome->energy_before = outcome->energy_after = energy(ready, &ready->velocity, &omega);
    outcome->normal_before = outcome->normal_after = approach;
}

static bool finite3(qvec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

/* An answer beyond double precision is none; only such speeds can lead to it. */
static impact_status finish(const impact_collision *collision, double speed, impact_outcome *outcome)
{
    if (speed < 1e200) return IMPACT_OK;
    const bool finite = finite3(outcome->velocity[0]) && finite3(outcome->velocity[1]) && finite3(outcome->omega[0]) &&
                        finite3(outcome->omega[1]);
    return finite ? IMPACT_OK : fail(collision, outcome, IMPACT_EDOMAIN);
}

/* |t|, how fast the contact points slide; 0 where that is but rounding. */
static double sliding_speed(const imp_ready *ready, qvec3 t)
{
    const double s2 = qvec3_dot(t, t), s = s2 > DBL_MIN && s2 < DBL_MAX ? sqrt(s2) : qvec3_norm(t);
    return s > rounding_of_velocity(ready) ? s : 0;
}

impact_status impact_collide(const impact_collision *collision, impact_outcome *outcome)
{
    impact_status status = impact_collide_check(collision, NULL, 0);
    if (status != IMPACT_OK) return fail(collision, outcome, status);
    imp_ready ready;
    imp_ready_make(collision, &ready);
    const qvec3 n = imp_frame_normal(collision), u = imp_ready_velocity(&ready);
    const double approach = qvec3_dot(u, n), speed = -approach;
    /* At right angles to n however small it is beside u. */
    const qvec3 t = qvec3_cross(n, qvec3_cross(u, n));
    if (!isfinite(approach) || !isfinite(t.x + t.y + t.z)) return fail(collision, outcome, IMPACT_EDOMAIN);
    const double s = sliding_speed(&ready, t);
    if (approach < 0 && may_be_closed(collision) && imp_direct_solve(collision, &ready, n, t, s, speed, outcome)) {
        push(&ready, outcome->impulse, outcome);
        return finish(collision, speed + s, outcome);
    }
    imp_frame frame;
    imp_frame_make(n, s > 0 ? qvec3_scale(t, 1 / s) : imp_frame_across(n), &ready, &frame);
    if (!(approach < 0)) {
        separate(collision, &ready, approach, outcome);
        outcome->conditioning = frame.conditioning;
        return IMPACT_SEPARATING;
    }
    imp_course course;
    imp_course_start(&course, &frame, collision, s / speed, 0);
    status = solve(collision, &ready, &frame, &course, speed, outcome);
    if (status != IMPACT_OK) return fail(collision, outcome, status);
    report(collision, &ready, &course, speed, outcome);
    return finish(collision, speed + s, outcome);
}
