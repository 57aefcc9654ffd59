/* SPDX-License-Identifier: MIT
 *
 * The time of impact of two bodies under constant accelerations that turn steadily: the search for contact (search.c)
 * over two free segments, of bodies whose three moments are 1, so that omega = L stays; and its receipt.
 */
#include <quat/rotation.h>
#include "base/floats.h"
#include "base/numbers.h"
#include "base/tolerances.h"
#include "gap/gap_solver.h"
#include "motion/search.h"

/* Of a solid that is no static body, whatever its mass. */
static imp_body body_of(const impact_solid *solid, double radius)
{
    const qvec3 one = {1, 1, 1};
    return (imp_body){.shape = solid->shape,
                      .moments = one,
                      .inverse_moments = one,
                      .spherical = true,
                      .radius = radius,
                      .turn = {1, 0, 0, 0}};
}

static imp_segment segment_of(const imp_body *body, const impact_solid *solid, const impact_motion *motion)
{
    const imp_state start = {
        .x = solid->position, .q = solid->orientation, .v = motion->velocity, .momentum = motion->omega};
    return imp_segment_fly(body, 0, &start, motion->acceleration, NULL);
}

impact_solid impact_motion_at(const impact_solid *body, const impact_motion *motion, double t)
{
    const imp_body of = body_of(body, 0);
    const imp_segment segment = segment_of(&of, body, motion);
    const imp_state state = imp_segment_at(&segment, &of, t);
    return (impact_solid){body->shape, state.x, state.q};
}

static bool plane(const impact_solid *body) { return body->shape.kind == IMPACT_PLANE; }

static bool still(const impact_motion *m)
{
    return qvec3_norm(m->velocity) == 0 && qvec3_norm(m->acceleration) == 0 && qvec3_norm(m->omega) == 0;
}

static impact_status check(const impact_solid *body, const impact_motion *motion)
{
    if (!imp_all_finite(motion->velocity) || !imp_all_finite(motion->acceleration) || !imp_all_finite(motion->omega))
        return IMPACT_EDOMAIN;
    return plane(body) && !still(motion) ? IMPACT_EARGUMENT : IMPACT_OK;
}

/* No less than the bounding radius: the longest of the round axes and all the boxy ones, end to end. */
static double outer_radius(const impact_shape *shape)
{
    const double axis[3] = {shape->a, shape->b, shape->c}, p[3] = {shape->r, shape->s, shape->t};
    double round = 0, boxy = 0;
    for (int i = 0; i < 3; i++) {
        if (p[i] <= 2)
            round = fmax(round, axis[i]);
        else
            boxy = hypot(boxy, axis[i]);
    }
    return hypot(round, boxy);
}

static double length_of(const impact_solid body[2])
{
    double length = 0;
    for (int k = 0; k < 2; k++)
        if (!plane(&body[k])) length = fmax(length, fmax(body[k].shape.a, fmax(body[k].shape.b, body[k].shape.c)));
    return length;
}

/* ---- the receipt ---- */

typedef struct moment {
    impact_solid body[2];
} moment;

static moment moment_at(const impact_solid body[2], const impact_motion motion[2], double t)
{
    return (moment){{impact_motion_at(&body[0], &motion[0], t), impact_motion_at(&body[1], &motion[1], t)}};
}

static double distance_of(const moment *m) { return qvec3_norm(qvec3_sub(m->body[0].position, m->body[1].position)); }

/* How far the unit n parts the bodies. */
static double parted_by(const moment *m, qvec3 n)
{
    double gap = qvec3_dot(n, qvec3_sub(m->body[0].position, m->body[1].position));
    for (int k = 0; k < 2; k++) {
        const qvec3 outward = quat_rotate_inverse(m->body[k].orientation, k ? n : qvec3_neg(n));
        qvec3 point;
        if (!plane(&m->body[k])) gap -= impact_shape_support(&m->body[k].shape, outward, &point);
    }
    return gap;
}

static double rate_at(const impact_motion motion[2], double t, const impact_contact *contact)
{
    const impact_motion *m1 = &motion[0], *m2 = &motion[1];
    return impact_gap_rate(contact, qvec3_axpy(t, m1->acceleration, m1->velocity), m1->omega,
                           qvec3_axpy(t, m2->acceleration, m2->velocity), m2->omega);
}

bool imp_toi_holds(const impact_solid body[2], const impact_motion motion[2], double t, const impact_contact *contact)
{
    const moment now = moment_at(body, motion, t);
    const double length = length_of(body), rate = fabs(rate_at(motion, t, contact)),
                 rounding = IMP_TOI_NEAR * IMP_TOI_ROUNDING * (length + distance_of(&now)),
                 room = fmax(rounding, IMP_TOI_TIME_NEAR * t * rate);
    if (!(fabs(contact->lower) <= room)) return false;
    const moment before = moment_at(body, motion, t - fmin(t, rate > 0 ? IMP_TOI_GLANCE_BACK * length / rate : 0));
    impact_contact other;
    return parted_by(&before, contact->normal) > -room ||
           (impact_gap(&before.body[0], &before.body[1], NULL, &other) >= 0 && other.upper > -room);
}

/* ---- the time ---- */

static impact_status contact_at(const impact_solid body[2], const impact_motion motion[2], double t,
                                impact_contact *contact)
{
    const moment m = moment_at(body, motion, t);
    return impact_gap(&m.body[0], &m.body[1], NULL, contact);
}

/* A time in closed form, to the last digit: one step of Newton's, if the gap is less there. */
static void trim(const impact_solid body[2], const impact_motion motion[2], double *t, impact_contact *contact)
{
    const double next = *t - contact->lower / rate_at(motion, *t, contact);
    impact_contact there;
    if (!(next >= 0) || contact_at(body, motion, next, &there) < 0) return;
    if (fabs(there.lower) < fabs(contact->lower)) *t = next, *contact = there;
}

/* Whether the bodies touch or overlap as they begin. */
static bool begins(const impact_solid body[2], impact_contact *contact, impact_status *status)
{
    const double reach = (plane(&body[1]) ? INFINITY : outer_radius(&body[1].shape)) + outer_radius(&body[0].shape),
                 distance = qvec3_norm(qvec3_sub(body[0].position, body[1].position));
    if (distance > reach) return false;
    *status = impact_gap(&body[0], &body[1], NULL, contact);
    return *status < 0 || contact->lower <= IMP_TOI_ROUNDING * (length_of(body) + distance);
}

static imp_found search(const impact_solid solid[2], const impact_motion motion[2], double t_max,
                        impact_contact *contact)
{
    imp_body body[2];
    imp_segment segment[2];
    impact_usage usage = {0};
    for (int k = 0; k < 2; k++) {
        body[k] = body_of(&solid[k], plane(&solid[k]) ? INFINITY : outer_radius(&solid[k].shape));
        segment[k] = segment_of(&body[k], &solid[k], &motion[k]);
        segment[k].t1 = t_max;
    }
    const imp_search s = {
        .body = {&body[0], &body[1]}, .segment = {&segment[0], &segment[1]}, .usage = &usage, .contact = contact};
    return imp_search_contact(&s, 0, INFINITY);
}

/* Of bodies of which the first is no plane. */
static impact_status first_contact(const impact_solid body[2], const impact_motion motion[2], double t_max, double *t,
                                   impact_contact *contact)
{
    impact_status status = IMPACT_OK;
    *t = 0;
    if (begins(body, contact, &status)) return status < 0 ? status : IMPACT_OK;
    contact->path = IMPACT_PATH_NONE;
    const imp_found found = search(body, motion, t_max, contact);
    *t = fmin(found.t, t_max);
    const bool closed_form = contact->path == IMPACT_PATH_NONE;
    if (!found.touches || closed_form) status = contact_at(body, motion, *t, contact);
    if (status < 0) return status;
    if (found.touches && closed_form) trim(body, motion, t, contact);
    if (!found.touches) return isfinite(found.t) ? IMPACT_EUNSETTLED : IMPACT_NO_CONTACT;
    if (imp_toi_holds(body, motion, *t, contact)) return IMPACT_OK;
    *t = 0;
    return IMPACT_EUNSETTLED;
}

impact_status impact_toi(const impact_solid *body1, const impact_motion *motion1, const impact_solid *body2,
                         const impact_motion *motion2, double t_max, double *time, impact_contact *contact)
{
    *time = NAN;
    const bool swap = plane(body1);
    const impact_motion motion[2] = {swap ? *motion2 : *motion1, swap ? *motion1 : *motion2};
    impact_solid body[2] = {swap ? *body2 : *body1, swap ? *body1 : *body2};
    impact_status status = check(body1, motion1);
    if (status == IMPACT_OK) status = check(body2, motion2);
    if (status == IMPACT_OK && !isfinite(t_max)) status = IMPACT_EDOMAIN;
    if (status == IMPACT_OK && t_max < 0) status = IMPACT_EARGUMENT;
    if (status == IMPACT_OK) status = imp_gap_check(&body[0], &body[0].orientation, &body[1], &body[1].orientation);
    if (status != IMPACT_OK) return status;
    const imp_floats floats = imp_floats_hold();
    impact_contact found;
    double t;
    status = first_contact(body, motion, t_max, &t, &found);
    imp_floats_give_back(&floats);
    if (contact) *contact = swap ? imp_contact_swapped(found) : found;
    if (status >= 0 || status == IMPACT_EUNSETTLED) *time = t;
    return status;
}
