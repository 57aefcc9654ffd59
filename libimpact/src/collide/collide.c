/* SPDX-License-Identifier: MIT
 *
 * The door of the room: scales, picks a solver, looks at the answer's receipt, and climbs to better solvers where that
 * does not pass.
 */
#include "base/numbers.h"
#include "base/tolerances.h"
#include "collide/collide_check.h"
#include "collide/collide_cvode.h"
#include "collide/collide_direct.h"
#include "collide/collide_isotropic.h"
#include "collide/collide_receipt.h"
#include "collide/collide_report.h"
#include "collide/collide_second.h"
#include "collide/collide_series.h"
#include "collide/collide_tangential.h"
#include "collide/collide_units.h"

#include <float.h>

static void unchanged(const impact_collision *collision, impact_outcome *outcome, double value)
{
    *outcome = (impact_outcome){.impulse = {value, value, value}, .error = value};
    for (int i = 0; i < 2; i++) {
        outcome->velocity[i] = collision->body[i].velocity;
        outcome->omega[i] = collision->body[i].omega;
    }
    outcome->impulse_normal = outcome->impulse_tangential = outcome->compression_impulse = value;
    outcome->work_compression = outcome->work_restitution = outcome->work_friction = value;
    outcome->normal_before = outcome->normal_after = outcome->energy_before = outcome->energy_after = value;
    outcome->conditioning = value;
}

/* The size of the terms that the contact points' velocities are sums of. */
static double size_of_velocity(const imp_ready *ready)
{
    const imp_lanes each =
        imp_vectors_size(&ready->velocity) + imp_vectors_size(&ready->omega) * imp_vectors_size(&ready->arm);
    return each[0] + each[1];
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

static impact_status solve(const impact_collision *collision, const imp_ready *ready, imp_frame *frame,
                           imp_course *course, double speed, impact_outcome *outcome)
{
    if (may_be_closed(collision) && closed_form(course)) {
        outcome->solver = IMPACT_SOLVER_CLOSED_FORM;
        return course->ended ? IMPACT_OK : IMPACT_EUNSETTLED;
    }
    if (collision->solver == IMPACT_SOLVER_CLOSED_FORM) return IMPACT_EARGUMENT;
    imp_course_turn_frame(course, ready, frame);
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
    outcome->energy_before = outcome->energy_after = imp_report_energy(ready, &ready->velocity, &omega);
    outcome->normal_before = outcome->normal_after = approach;
}

/* An answer beyond double precision is none. */
static impact_status finish(const impact_collision *collision, impact_status status, impact_outcome *outcome)
{
    const impact_outcome *o = outcome;
    const double works = o->work_compression + o->work_restitution + o->work_friction;
    const bool finite = imp_all_finite(o->velocity[0]) && imp_all_finite(o->velocity[1]) &&
                        imp_all_finite(o->omega[0]) && imp_all_finite(o->omega[1]) && imp_all_finite(o->impulse) &&
                        isfinite(works + o->compression_impulse) && isfinite(o->energy_before + o->energy_after);
    return finite ? status : fail(collision, outcome, IMPACT_EDOMAIN);
}

/* |t|, how fast the contact points slide. What is left of larger velocities that cancel is 0: the contact rolls, and
 * starts from u_t = 0. */
static double sliding_speed(double size, qvec3 t)
{
    const double s2 = qvec3_dot(t, t), s = s2 > DBL_MIN && s2 < DBL_MAX ? sqrt(s2) : qvec3_norm(t);
    return s > DBL_MIN + IMP_COLLIDE_STANDS * size ? s : 0;
}

/* ---- one answer, and whether it stands ---- */

/* One impact of numbers near 1: the body's view of it, the unit normal, and how fast the contact points slide. */
typedef struct meeting {
    const impact_collision *collision;
    imp_ready ready;
    qvec3 n, u, t;            /* t: u across n */
    double approach, s, size; /* size: of the velocities' terms */
    bool checks;
} meeting;

/* By the kernel in double, all but what needs no frame. */
static impact_status answer(const meeting *m, impact_outcome *outcome)
{
    const imp_ready *ready = &m->ready;
    imp_frame frame;
    imp_course course;
    /* t2 along the slip: what lies across it is eliminated first. */
    const qvec3 t1 = m->s > 0 ? qvec3_cross(qvec3_scale(m->t, 1 / m->s), m->n) : imp_frame_across(m->n);
    imp_frame_make(m->n, t1, ready, &frame);
    if (!(m->approach < 0)) {
        separate(m->collision, ready, m->approach, outcome);
        outcome->conditioning = frame.conditioning;
        return IMPACT_SEPARATING;
    }
    imp_course_start(&course, &frame, m->collision, 0, m->s / -m->approach);
    const impact_status status = solve(m->collision, ready, &frame, &course, -m->approach, outcome);
    if (status != IMPACT_OK) return status;
    imp_course_mark(&course);
    imp_report_course(m->collision, ready, &course, -m->approach, outcome);
    outcome->second = false;
    outcome->error = 0;
    return IMPACT_OK;
}

/* What a receipt may show, in eps: CVODE answers to its tolerance. */
static double allowed(const impact_collision *collision, const impact_outcome *outcome)
{
    if (outcome->solver != IMPACT_SOLVER_CVODE) return IMP_COLLIDE_RECEIPT;
    return IMP_COLLIDE_RECEIPT * imp_cvode_tolerance(collision->workspace) / DBL_EPSILON;
}

/* Whether the contact gave no more work than it took, if the law has it so; of `most` eps. */
static bool gains_nothing(const impact_collision *collision, const impact_outcome *o, double works, double most)
{
    const bool may_gain = collision->law == IMPACT_NEWTON || collision->restitution > 1;
    return may_gain ? works < INFINITY : works <= most * DBL_EPSILON * -o->work_compression;
}

/* Finite, and without gain; whatever the receipt says. */
static bool is_sane(const impact_collision *collision, const impact_outcome *o)
{
    const double works = o->work_compression + o->work_restitution + o->work_friction;
    return imp_is_finite(works + o->energy_after) && gains_nothing(collision, o, works, allowed(collision, o));
}

/* Closed forms are looked at briefly where the conditioning (1 at least) cannot bring rounding to what is allowed. Over
 * that: at most 1 passes, and what is not finite does not. */
static double look_briefly(const meeting *m, impact_outcome *outcome)
{
    double works;
    const double worst = imp_receipt_brief(&m->ready, m->n, m->size, outcome, &works);
    if (!gains_nothing(m->collision, outcome, works, IMP_COLLIDE_RECEIPT)) return INFINITY;
    outcome->error = DBL_EPSILON * imp_larger(worst, 1) * outcome->conditioning;
    return worst * (1 / IMP_COLLIDE_RECEIPT);
}

static double worst_of(const meeting *m, const impact_outcome *outcome)
{
    static const imp_least none = {0, 0, 0, 0};
    impact_receipt receipt;
    /* The hodograph costs as much as all the rest. */
    const bool follows = m->collision->checking == IMPACT_CHECK_ALWAYS;
    const double worst = imp_receipt_make(m->collision, outcome, &none, follows, &receipt),
                 most = allowed(m->collision, outcome);
    if (outcome->solver == IMPACT_SOLVER_CVODE) return receipt.energy <= most ? worst : INFINITY;
    /* A NaN is no receipt, and imp_larger would drop it. Energy is held to a hundredth of the rest. */
    return receipt.energy <= most && !isnan(worst) ? imp_larger(worst, IMP_COLLIDE_ENERGY * receipt.energy) : INFINITY;
}

/* The receipt's worst over what is allowed: at most 1 passes. */
static double look(const meeting *m, impact_outcome *outcome)
{
    if (!m->checks) return is_sane(m->collision, outcome) ? 0 : INFINITY;
    if (outcome->solver == IMPACT_SOLVER_CLOSED_FORM && outcome->conditioning <= IMP_COLLIDE_BRIEF)
        return look_briefly(m, outcome);
    if (!is_sane(m->collision, outcome)) return INFINITY;
    const double worst = worst_of(m, outcome);
    /* Of 113 bits, double's 53 are what remains of a conditioning of 2^60. */
    const double spread = outcome->conditioning * (outcome->second ? IMP_COLLIDE_SECOND_SPREAD : 1);
    outcome->error = DBL_EPSILON * imp_larger(worst, 1) * imp_larger(spread, 1);
    return worst / allowed(m->collision, outcome);
}

/* ---- the ladder ---- */

/* The better of two answers, `worst` being that of the one in *outcome. */
static double keep_better(const meeting *m, impact_outcome *other, impact_outcome *outcome, double worst)
{
    const double its = look(m, other);
    if (!(its < worst || isnan(worst))) return worst;
    *outcome = *other;
    return its;
}

/* In 128 bits, then by CVODE, until the receipt passes; `worst` is that of *outcome. */
static impact_status climb(const meeting *m, double worst, impact_outcome *outcome)
{
    impact_outcome other = {0};
    const impact_collision *given = m->collision;
    if (!needs_cvode(given)) {
        const impact_status status = imp_second_collide(given, &other);
        other.second = true;
        if (status == IMPACT_SEPARATING) {
            separate(given, &m->ready, m->approach, outcome);
            return status;
        }
        if (status == IMPACT_OK) worst = keep_better(m, &other, outcome, worst);
        if (worst <= 1) return IMPACT_OK;
        impact_collision by_cvode = *given;
        meeting again = *m;
        by_cvode.solver = IMPACT_SOLVER_CVODE;
        again.collision = &by_cvode;
        if (impact_has(IMPACT_PART_CVODE) && answer(&again, &other) == IMPACT_OK)
            worst = keep_better(&again, &other, outcome, worst);
    }
    if (worst <= 1) return IMPACT_OK;
    return worst < INFINITY ? IMPACT_SOFT : IMPACT_EUNSETTLED;
}

static impact_status collide(const meeting *m, impact_outcome *outcome)
{
    const impact_collision *given = m->collision;
    const bool near = m->approach < 0 && may_be_closed(given);
    if (near && imp_direct_solve(given, &m->ready, m->n, m->t, m->s, -m->approach, outcome)) {
        imp_report_push(&m->ready, outcome->impulse, outcome);
        outcome->second = false;
        outcome->error = 0;
        const double worst = look(m, outcome);
        return worst <= 1 ? IMPACT_OK : climb(m, worst, outcome);
    }
    const impact_status status = answer(m, outcome);
    if (status == IMPACT_EUNSETTLED) return climb(m, INFINITY, outcome);
    if (status != IMPACT_OK) return status;
    const double worst = look(m, outcome);
    return worst <= 1 ? IMPACT_OK : climb(m, worst, outcome);
}

/* The collision's numbers are to be near 1. */
static void meet(const impact_collision *collision, bool checks, meeting *m)
{
    m->checks = checks;
    m->collision = collision;
    imp_ready_make(collision, &m->ready);
    m->n = imp_frame_normal(collision);
    m->u = imp_ready_velocity(&m->ready);
    m->approach = qvec3_dot(m->u, m->n);
    /* At right angles to n however small it is beside u. */
    m->t = qvec3_cross(m->n, qvec3_cross(m->u, m->n));
    m->size = size_of_velocity(&m->ready);
    m->s = sliding_speed(m->size, m->t);
}

/* In units in which the numbers are near 1. A friction law knows its own. */
static impact_status collide_closely(const impact_collision *collision, bool checks, impact_outcome *outcome)
{
    meeting m;
    impact_status status = impact_collide_check(collision, NULL, 0);
    if (status != IMPACT_OK) return fail(collision, outcome, status);
    const imp_units units = collision->friction_law ? (imp_units){0, 0, 0} : imp_units_of(collision);
    const impact_collision scaled = imp_units_scaled(collision, units);
    meet(&scaled, checks, &m);
    status = collide(&m, outcome);
    if (status < 0) return fail(collision, outcome, status);
    imp_units_restore(outcome, units);
    return finish(collision, status, outcome);
}

impact_status imp_collide(const impact_collision *collision, bool checks, impact_outcome *outcome)
{
    meeting m;
    if (!imp_collide_is_plain(collision)) return collide_closely(collision, checks, outcome);
    meet(collision, checks, &m);
    if (m.approach < 0 && m.approach > -IMP_COLLIDE_ORDINARY_APPROACH)
        return collide_closely(collision, checks, outcome);
    const impact_status status = collide(&m, outcome);
    return status < 0 ? fail(collision, outcome, status) : status;
}

impact_status impact_collide(const impact_collision *collision, impact_outcome *outcome)
{
    if (collision->pressed) return imp_collide_pressed(collision, outcome);
    return imp_collide(collision, collision->checking != IMPACT_CHECK_NEVER, outcome);
}
