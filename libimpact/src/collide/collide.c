/* SPDX-License-Identifier: MIT
 *
 * The door of the room: scales, picks a solver, and turns a finished course into an outcome.
 */
#include "base/tolerances.h"
#include "collide/collide_check.h"
#include "collide/collide_cvode.h"
#include "collide/collide_direct.h"
#include "collide/collide_isotropic.h"
#include "collide/collide_report.h"
#include "collide/collide_series.h"
#include "collide/collide_units.h"

#include <float.h>

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

static bool finite3(qvec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

/* An answer beyond double precision is none. */
static impact_status finish(const impact_collision *collision, impact_status status, impact_outcome *outcome)
{
    const bool finite = finite3(outcome->velocity[0]) && finite3(outcome->velocity[1]) && finite3(outcome->omega[0]) &&
                        finite3(outcome->omega[1]);
    return finite ? status : fail(collision, outcome, IMPACT_EDOMAIN);
}

/* |t|, how fast the contact points slide; 0 where that is but rounding. */
static double sliding_speed(const imp_ready *ready, qvec3 t)
{
    const double s2 = qvec3_dot(t, t), s = s2 > DBL_MIN && s2 < DBL_MAX ? sqrt(s2) : qvec3_norm(t);
    return s > rounding_of_velocity(ready) ? s : 0;
}

/* One impact of numbers near 1; u: the velocity of the contact, n: the unit normal. */
static impact_status collide(const impact_collision *collision, const imp_ready *ready, qvec3 n, qvec3 u,
                             impact_outcome *outcome)
{
    const double approach = qvec3_dot(u, n), speed = -approach;
    /* At right angles to n however small it is beside u. */
    const qvec3 t = qvec3_cross(n, qvec3_cross(u, n));
    const double s = sliding_speed(ready, t);
    if (approach < 0 && may_be_closed(collision) && imp_direct_solve(collision, ready, n, t, s, speed, outcome)) {
        imp_report_push(ready, outcome->impulse, outcome);
        return IMPACT_OK;
    }
    imp_frame frame;
    /* t2 along the slip: what lies across it is eliminated first. */
    imp_frame_make(n, s > 0 ? qvec3_cross(qvec3_scale(t, 1 / s), n) : imp_frame_across(n), ready, &frame);
    if (!(approach < 0)) {
        separate(collision, ready, approach, outcome);
        outcome->conditioning = frame.conditioning;
        return IMPACT_SEPARATING;
    }
    imp_course course;
    imp_course_start(&course, &frame, collision, 0, s / speed);
    const impact_status status = solve(collision, ready, &frame, &course, speed, outcome);
    if (status != IMPACT_OK) return fail(collision, outcome, status);
    imp_course_mark(&course);
    imp_report_course(collision, ready, &course, speed, outcome);
    return IMPACT_OK;
}

/* In units in which the numbers are near 1. A friction law knows its own. */
static impact_status collide_closely(const impact_collision *collision, impact_outcome *outcome)
{
    imp_ready ready;
    impact_status status = impact_collide_check(collision, NULL, 0);
    if (status != IMPACT_OK) return fail(collision, outcome, status);
    const imp_units units = collision->friction_law ? (imp_units){0, 0, 0} : imp_units_of(collision);
    const impact_collision scaled = imp_units_scaled(collision, units);
    imp_ready_make(&scaled, &ready);
    status = collide(&scaled, &ready, imp_frame_normal(&scaled), imp_ready_velocity(&ready), outcome);
    if (status < 0) return fail(collision, outcome, status);
    imp_units_restore(outcome, units);
    return finish(collision, status, outcome);
}

impact_status impact_collide(const impact_collision *collision, impact_outcome *outcome)
{
    imp_ready ready;
    if (!imp_collide_is_plain(collision)) return collide_closely(collision, outcome);
    imp_ready_make(collision, &ready);
    const qvec3 n = imp_frame_normal(collision), u = imp_ready_velocity(&ready);
    const double approach = qvec3_dot(u, n);
    if (approach < 0 && approach > -IMP_COLLIDE_ORDINARY_APPROACH) return collide_closely(collision, outcome);
    return collide(collision, &ready, n, u, outcome);
}
