/* SPDX-License-Identifier: MIT
 *
 * The door of the room: scales, picks a solver, and turns a finished course into an outcome.
 */
#include "collide_cvode.h"
#include "collide_direct.h"
#include "collide_isotropic.h"
#include "collide_series.h"

/* Condition of M from which the last rounding is mended. */
static const double ill_conditioned = 100;

/* ---- from the caller's units to scaled ones and back ---- */

/* omega: local axes. */
static inline double energy(const impact_collider *body, qvec3 velocity, qvec3 omega)
{
    const qvec3 j = body->moments;
    return 0.5 * (body->mass * qvec3_dot(velocity, velocity) +
                  (j.x * omega.x * omega.x + j.y * omega.y * omega.y + j.z * omega.z * omega.z));
}

static double energy_before(const impact_collision *collision, const impact_ready ready[2])
{
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &collision->body[i];
        if (ready[i].inverse_mass != 0) sum += energy(body, body->velocity, impact_ready_local(&ready[i], body->omega));
    }
    return sum;
}

/* The velocities of one body after an impulse, and its energies. */
static inline void push(const impact_collider *body, const impact_ready *ready, qvec3 impulse, int i,
                        impact_outcome *outcome)
{
    if (ready->inverse_mass == 0) {
        outcome->velocity[i] = body->velocity;
        outcome->omega[i] = body->omega;
        return;
    }
    const qvec3 turn = qvec3_cross(ready->offset, impact_ready_local(ready, impulse));
    const qvec3 spin = impact_ready_spin(ready, turn), before = impact_ready_local(ready, body->omega);
    const qvec3 velocity = qvec3_axpy(ready->inverse_mass, impulse, body->velocity);
    outcome->energy_before += energy(body, body->velocity, before);
    outcome->energy_after += energy(body, velocity, qvec3_add(before, spin));
    outcome->velocity[i] = velocity;
    outcome->omega[i] = qvec3_add(body->omega, impact_ready_world(ready, spin));
}

/* What the outcome's impulse does to both. */
static void apply(const impact_collision *collision, const impact_ready ready[2], impact_outcome *outcome)
{
    const qvec3 impulse = outcome->impulse;
    outcome->energy_before = outcome->energy_after = 0;
    push(&collision->body[0], &ready[0], impulse, 0, outcome);
    push(&collision->body[1], &ready[1], qvec3_neg(impulse), 1, outcome);
}

/* M^-1 times a change of the contact's velocity. */
static qvec3 impulse_for(const impact_frame *frame, qvec3 du)
{
    const double ux = qvec3_dot(du, frame->t1), uy = qvec3_dot(du, frame->t2), uz = qvec3_dot(du, frame->n);
    const double z = (uz - frame->c / frame->a * ux - frame->d / frame->b * uy) / frame->k;
    const double x = (ux - frame->c * z) / frame->a, y = (uy - frame->d * z) / frame->b;
    return qvec3_scale(qvec3_axpy(x, frame->t1, qvec3_axpy(y, frame->t2, qvec3_scale(frame->n, z))), 1 / frame->scale);
}

/* A contact that sticks must end with u = (0, 0, uz). Where M is ill-conditioned, rounding of the impulse turns the bodies by more than
 * that allows: what is missing is given to their velocities, not to the impulse, which is right to its own rounding. */
static void refine(const impact_collision *collision, const impact_ready ready[2], const impact_frame *frame, double uz,
                   impact_outcome *outcome)
{
    impact_collision after = *collision;
    for (int i = 0; i < 2; i++) {
        after.body[i].velocity = outcome->velocity[i];
        after.body[i].omega = outcome->omega[i];
    }
    const qvec3 missing = qvec3_axpy(uz, frame->n, qvec3_neg(impact_frame_velocity(&after)));
    const double before = outcome->energy_before;
    const qvec3 impulse = impulse_for(frame, missing);
    outcome->energy_after = 0;
    push(&after.body[0], &ready[0], impulse, 0, outcome);
    push(&after.body[1], &ready[1], qvec3_neg(impulse), 1, outcome);
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

static void report(const impact_collision *collision, const impact_ready ready[2], const impact_course *course,
                   double speed, impact_outcome *outcome)
{
    const impact_frame *frame = course->frame;
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
    apply(collision, ready, outcome);
    const impact_phase last = course->phase_count > 0 ? course->phases[course->phase_count - 1] : IMPACT_SLIP_C;
    const bool sticks = (last == IMPACT_STICK_C || last == IMPACT_STICK_R) && outcome->solver != IMPACT_SOLVER_CVODE;
    if (sticks && frame->conditioning > ill_conditioned) refine(collision, ready, frame, course->uz * speed, outcome);
}

static double sum_of_sizes(qvec3 v) { return fabs(v.x) + fabs(v.y) + fabs(v.z); }

/* A tangential velocity below this is what is left of larger ones that cancel: the contact rolls, and starts from u_t = 0. */
static double rounding_of_velocity(const impact_collision *collision)
{
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &collision->body[i];
        sum += sum_of_sizes(body->velocity) + sum_of_sizes(body->omega) * sum_of_sizes(body->offset);
    }
    return 0x1p-52 * sum;
}

static impact_status fail(const impact_collision *collision, impact_outcome *outcome, impact_status status)
{
    unchanged(collision, outcome, NAN);
    return status;
}

/* Solves what has a closed form: sliding that does not turn, or turns alike in all directions. */
static bool closed_form(impact_course *course)
{
    if (impact_course_straight(course)) return true;
    if (!impact_isotropic_is(course->frame)) return false;
    impact_isotropic_solve(course);
    return true;
}

static impact_status solve(const impact_collision *collision, impact_course *course, double speed,
                           impact_outcome *outcome)
{
    const bool any = collision->solver == IMPACT_SOLVER_AUTO;
    const bool compliant = collision->tangential_compliance > 0 && course->mu > 0;
    if (collision->solver == IMPACT_SOLVER_CVODE || collision->friction_law || compliant) {
        outcome->solver = IMPACT_SOLVER_CVODE;
        return impact_cvode_solve(course, collision, speed);
    }
    if ((any || collision->solver == IMPACT_SOLVER_CLOSED_FORM) && closed_form(course)) {
        outcome->solver = IMPACT_SOLVER_CLOSED_FORM;
        return course->ended ? IMPACT_OK : IMPACT_EUNSETTLED;
    }
    if (collision->solver == IMPACT_SOLVER_CLOSED_FORM) return IMPACT_EARGUMENT;
    outcome->solver = IMPACT_SOLVER_SERIES;
    const int order = collision->series_order == 0 ? IMPACT_SERIES_ORDER : collision->series_order;
    return impact_series_solve(course, order) ? IMPACT_OK : IMPACT_EUNSETTLED;
}

/* Nothing happens, and says so. */
static void separate(const impact_collision *collision, const impact_ready ready[2], double approach,
                     impact_outcome *outcome)
{
    unchanged(collision, outcome, 0);
    outcome->energy_before = outcome->energy_after = energy_before(collision, ready);
    outcome->normal_before = outcome->normal_after = approach;
}

static bool may_be_direct(const impact_collision *collision)
{
    const bool closed = collision->solver == IMPACT_SOLVER_AUTO || collision->solver == IMPACT_SOLVER_CLOSED_FORM;
    const bool compliant = collision->tangential_compliance > 0 && collision->friction > 0;
    return closed && !compliant && !collision->friction_law;
}

impact_status impact_collide(const impact_collision *collision, impact_outcome *outcome)
{
    impact_status status = impact_collide_check(collision, NULL, 0);
    if (status != IMPACT_OK) return fail(collision, outcome, status);
    impact_ready ready[2];
    for (int i = 0; i < 2; i++) impact_ready_make(&collision->body[i], &ready[i]);
    const qvec3 n = impact_frame_normal(collision), u = impact_frame_velocity(collision);
    const double approach = qvec3_dot(u, n), rounding = rounding_of_velocity(collision);
    if (!isfinite(approach)) return fail(collision, outcome, IMPACT_EDOMAIN);
    if (approach < 0 && may_be_direct(collision) &&
        impact_direct_solve(collision, ready, n, u, approach, rounding, outcome)) {
        apply(collision, ready, outcome);
        return IMPACT_OK;
    }
    impact_frame frame;
    impact_frame_make(n, ready, &frame);
    if (!(approach < 0)) {
        separate(collision, ready, approach, outcome);
        outcome->conditioning = frame.conditioning;
        return IMPACT_SEPARATING;
    }
    const double speed = -approach;
    double ux = qvec3_dot(u, frame.t1), uy = qvec3_dot(u, frame.t2);
    if (fabs(ux) + fabs(uy) <= rounding) ux = uy = 0;
    impact_course course;
    impact_course_start(&course, &frame, collision, ux / speed, uy / speed);
    status = solve(collision, &course, speed, outcome);
    if (status != IMPACT_OK) return fail(collision, outcome, status);
    report(collision, ready, &course, speed, outcome);
    return IMPACT_OK;
}
