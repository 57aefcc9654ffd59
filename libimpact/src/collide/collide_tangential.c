/* SPDX-License-Identifier: MIT
 *
 * A contact that slides at u_n = 0, impulses p(n - mu e), e = u_t/|u_t|:
 *
 *     du_n/dp = n . M (n - mu e) < 0
 *
 * Whatever presses is made more by its own reaction: no pressure holds it (Painleve 1895), and any spring is compressed
 * faster than it slows (Lecornu 1905; Genot & Brogliato 1999). The limit of stiff springs is an impact from u_n = -0:
 * since du_n/dp < 0 from the beginning it does not matter from how little it begins, and a seed of 2^-48 of the speeds
 * there is followed by the ordinary equations, then taken away again.
 */
#include "collide/collide_tangential.h"

#include <math.h>
#include <quat/rotation.h>
#include "base/tolerances.h"

/* The acceleration of the body's point under the force there. */
static qvec3 respond(const impact_collider *b, qvec3 force)
{
    if (isinf(b->mass)) return (qvec3){0, 0, 0};
    const qvec3 own = quat_rotate_inverse(b->orientation, qvec3_cross(b->offset, force)), j = b->moments;
    const qvec3 spin = quat_rotate(b->orientation, (qvec3){own.x / j.x, own.y / j.y, own.z / j.z});
    return qvec3_axpy(1 / b->mass, force, qvec3_cross(spin, b->offset));
}

/* The contact's motion; size: of the terms that u is a sum of. */
typedef struct contact_motion {
    qvec3 n, slip;
    double approach, size;
} contact_motion;

static bool find_motion(const impact_collision *c, contact_motion *m)
{
    qvec3 u = {0, 0, 0};
    m->size = 0;
    for (int k = 0; k < 2; k++) {
        const impact_collider *b = &c->body[k];
        const qvec3 own = qvec3_add(b->velocity, qvec3_cross(b->omega, b->offset));
        u = k == 0 ? qvec3_add(u, own) : qvec3_sub(u, own);
        m->size += qvec3_norm(b->velocity) + qvec3_norm(b->omega) * qvec3_norm(b->offset);
    }
    if (qvec3_normalize(c->normal, &m->n) != QUAT_OK) return false;
    m->approach = qvec3_dot(u, m->n);
    m->slip = qvec3_axpy(-m->approach, m->n, u);
    return fabs(m->approach) <= IMP_COLLIDE_SEED * m->size;
}

static bool draws(const impact_collision *c, const contact_motion *m)
{
    qvec3 e;
    if (qvec3_normalize(m->slip, &e) != QUAT_OK) return false;
    const qvec3 force = qvec3_axpy(-c->friction, e, m->n);
    return qvec3_dot(m->n, qvec3_add(respond(&c->body[0], force), respond(&c->body[1], force))) < 0;
}

bool imp_collide_draws(const impact_collision *collision)
{
    contact_motion m;
    return find_motion(collision, &m) && draws(collision, &m);
}

impact_status imp_collide_pressed(const impact_collision *collision, impact_outcome *outcome)
{
    impact_collision seeded = *collision;
    contact_motion m;
    seeded.pressed = false;
    if (impact_collide_check(collision, NULL, 0) != IMPACT_OK || !find_motion(collision, &m))
        return impact_collide(&seeded, outcome);
    const bool begins = draws(collision, &m);
    const int moved = isinf(collision->body[0].mass) ? 1 : 0;
    const double seed = IMP_COLLIDE_SEED * m.size, wanted = begins ? -seed : seed;
    const qvec3 shift = qvec3_scale(m.n, (moved == 0 ? 1 : -1) * (wanted - m.approach));
    seeded.body[moved].velocity = qvec3_add(seeded.body[moved].velocity, shift);
    const impact_status status = impact_collide(&seeded, outcome);
    if (status < 0) return status;
    outcome->normal_before = m.approach;
    if (begins) {
        outcome->velocity[moved] = qvec3_sub(outcome->velocity[moved], shift);
        outcome->phases[0] = IMPACT_TANGENTIAL;
    } else {
        outcome->velocity[moved] = collision->body[moved].velocity;
        outcome->normal_after = m.approach;
    }
    return status;
}
