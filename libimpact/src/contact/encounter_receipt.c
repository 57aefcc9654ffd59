/* SPDX-License-Identifier: MIT
 *
 * The receipt of an encounter, from the data, the velocities and the impulses alone:
 *
 *     m (V' - V) = sum +-P,   J (W' - W) = sum +-r x P         momentum and spin of each body that moves
 *     P_n >= 0,  |P_t| <= mu P_n                               cones
 *     E' - E = sum of works - sum +-P . (a static body's u)    power; by springs works of friction and all are <= 0
 *     P . (u + u')/2 summed: the same, by impulses             (E is a quadratic form)
 *     u_n' >= 0                                                nothing approaches
 *     u_n' >= b = eps max(-u_n, 0),  u_n' = b where P_n > 0    Newton's law, all at once
 *
 * each over the sizes of its own terms and the largest impulse or velocity that is there; of impulses what changes no
 * body's velocity by more than its rounding is none: of a blow of a nanometre a second on what slides at one a
 * centimetre a second its friction has ten digits less than its normal.
 */
#include "contact/encounter.h"

#include <quat/rotation.h>
#include "base/numbers.h"
#include "base/tolerances.h"

/* The largest of the encounter: what is as small as their rounding is none. */
typedef struct tally {
    double worst;
    double impulse, arm, speed;
} tally;

static void miss(tally *t, double off, double size) { t->worst = imp_worse(t->worst, off == 0 ? 0 : off / size); }

static void check_body(const impact_encounter *e, const impact_together_outcome *o, int b, tally *t)
{
    const impact_collider *body = &e->bodies[b];
    if (imp_encounter_is_static(body)) return;
    qvec3 push = {0, 0, 0}, turn = {0, 0, 0};
    double pushes = 0, turns = 0;
    for (int i = 0; i < e->meeting_count; i++) {
        const impact_meeting *m = &e->meetings[i];
        if (m->body1 != b && m->body2 != b) continue;
        const qvec3 p = m->body1 == b ? o->meetings[i].impulse : qvec3_neg(o->meetings[i].impulse);
        const qvec3 arm = m->body1 == b ? m->offset1 : m->offset2;
        push = qvec3_add(push, p);
        turn = qvec3_add(turn, qvec3_cross(arm, p));
        pushes += qvec3_norm(p);
        turns += qvec3_norm(arm) * qvec3_norm(p);
    }
    const double speeds = body->mass * (qvec3_norm(o->velocity[b]) + qvec3_norm(body->velocity));
    const qvec3 gained = qvec3_scale(qvec3_sub(o->velocity[b], body->velocity), body->mass);
    miss(t, qvec3_norm(qvec3_sub(gained, push)), pushes + speeds + t->impulse);
    const qvec3 j = body->moments, w = quat_rotate_inverse(body->orientation, o->omega[b]),
                w0 = quat_rotate_inverse(body->orientation, body->omega),
                by = quat_rotate_inverse(body->orientation, turn);
    const qvec3 spun = {j.x * (w.x - w0.x), j.y * (w.y - w0.y), j.z * (w.z - w0.z)};
    const qvec3 sizes = {j.x * (fabs(w.x) + fabs(w0.x)), j.y * (fabs(w.y) + fabs(w0.y)),
                         j.z * (fabs(w.z) + fabs(w0.z))};
    miss(t, qvec3_norm(qvec3_sub(spun, by)), turns + qvec3_norm(sizes) + t->impulse * t->arm);
}

/* The relative velocity of the contact points, and how large its terms are. */
static qvec3 slip_of(const impact_encounter *e, const impact_meeting *m, const qvec3 *velocity, const qvec3 *omega,
                     double *size)
{
    const int pair[2] = {m->body1, m->body2};
    const qvec3 arms[2] = {m->offset1, m->offset2};
    qvec3 u = {0, 0, 0};
    for (int s = 0; s < 2; s++) {
        const qvec3 v = velocity ? velocity[pair[s]] : e->bodies[pair[s]].velocity,
                    w = omega ? omega[pair[s]] : e->bodies[pair[s]].omega;
        const qvec3 part = qvec3_add(v, qvec3_cross(w, arms[s]));
        u = s == 0 ? qvec3_add(u, part) : qvec3_sub(u, part);
        *size += qvec3_norm(v) + qvec3_norm(w) * qvec3_norm(arms[s]);
    }
    return u;
}

/* The work that static bodies which move take up: their velocity times the impulse on them. */
static double driven_work(const impact_encounter *e, const impact_meeting *m, qvec3 impulse)
{
    double work = 0;
    const int pair[2] = {m->body1, m->body2};
    const qvec3 arms[2] = {m->offset1, m->offset2};
    for (int s = 0; s < 2; s++) {
        const impact_collider *body = &e->bodies[pair[s]];
        if (!imp_encounter_is_static(body)) continue;
        const double power = qvec3_dot(qvec3_add(body->velocity, qvec3_cross(body->omega, arms[s])), impulse);
        work += s == 0 ? power : -power;
    }
    return work;
}

typedef struct energies {
    double works, positive, by_impulses, driven, terms;
} energies;

static void check_meeting_of(const impact_encounter *e, const impact_together_outcome *o, int i, double most,
                             energies *sum, tally *t)
{
    const impact_meeting *m = &e->meetings[i];
    const impact_meeting_outcome *own = &o->meetings[i];
    qvec3 n;
    (void)qvec3_normalize(m->normal, &n);
    const double normal = qvec3_dot(n, own->impulse), across = qvec3_norm(qvec3_axpy(-normal, n, own->impulse));
    const double grain = IMP_ENCOUNTER_GRAIN * t->speed * fmin(e->bodies[m->body1].mass, e->bodies[m->body2].mass);
    miss(t, fmax(0, -normal - grain), most);
    miss(t, fmax(0, across - m->friction * normal - grain), most * fmax(1, m->friction));
    double size = 0;
    const qvec3 before = slip_of(e, m, NULL, NULL, &size), after = slip_of(e, m, o->velocity, o->omega, &size);
    miss(t, fmax(0, -qvec3_dot(n, after)), size + t->speed);
    if (e->law == IMPACT_TOGETHER_MOREAU && e->restitution == IMPACT_NEWTON && !own->merged) {
        const double over = qvec3_dot(n, after) - m->restitution * fmax(-qvec3_dot(n, before), 0);
        miss(t, normal > 0 ? fabs(over) : fmax(0, -over), size + t->speed);
    }
    sum->works += own->work_compression + own->work_restitution + own->work_friction;
    sum->terms += fabs(own->work_compression) + own->work_restitution + fabs(own->work_friction) +
                  size * qvec3_norm(own->impulse);
    sum->by_impulses += 0.5 * qvec3_dot(own->impulse, qvec3_add(before, after));
    sum->driven += driven_work(e, m, own->impulse);
    if (e->law == IMPACT_TOGETHER_SPRINGS) /* an impulse against the slip at its end may have been with it before */
        miss(t, fmax(0, own->work_friction), fabs(own->work_friction) + (size + t->speed) * qvec3_norm(own->impulse));
}

double imp_encounter_receipt(const impact_encounter *encounter, const impact_together_outcome *outcome)
{
    tally t = {0};
    energies sum = {0};
    for (int i = 0; i < encounter->meeting_count; i++) {
        const impact_meeting *m = &encounter->meetings[i];
        double size = 0;
        (void)slip_of(encounter, m, NULL, NULL, &size);
        t.impulse = fmax(t.impulse, qvec3_norm(outcome->meetings[i].impulse));
        t.arm = fmax(t.arm, fmax(qvec3_norm(m->offset1), qvec3_norm(m->offset2)));
        t.speed = fmax(t.speed, size);
    }
    for (int b = 0; b < encounter->body_count; b++) check_body(encounter, outcome, b, &t);
    for (int i = 0; i < encounter->meeting_count; i++) check_meeting_of(encounter, outcome, i, t.impulse, &sum, &t);
    const double change = outcome->energy_after - outcome->energy_before,
                 size = outcome->energy_after + outcome->energy_before + sum.terms;
    /* E' - E = P . (u + u')/2 less what goes into static bodies */
    miss(&t, fabs(change - (sum.works - sum.driven)), size);
    miss(&t, fabs(change - (sum.by_impulses - sum.driven)), size);
    if (encounter->law == IMPACT_TOGETHER_SPRINGS) miss(&t, fmax(0, sum.works), size);
    return t.worst;
}
