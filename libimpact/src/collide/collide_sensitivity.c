/* SPDX-License-Identifier: MIT
 *
 * How far the answer follows its data, by trying: cond(M) alone knows neither of slim bodies, nor of a velocity that
 * nearly vanishes, nor of events that are about to happen or not.
 */
#include <impact/collide.h>

#include <stdint.h>

/* Far above the rounding of an impact, far below what bends its answer. */
static const double nudge = 0x1p-36;
enum { TRIES = 8 };

/* x (1 + nudge) or x (1 - nudge), by one bit of the generator (splitmix64; Steele, Lea & Flood 2014). */
static double nudged(double x, uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return x + (z >> 63 ? nudge : -nudge) * x;
}

static qvec3 nudged3(qvec3 v, uint64_t *state)
{
    const double x = nudged(v.x, state), y = nudged(v.y, state), z = nudged(v.z, state);
    return (qvec3){x, y, z};
}

static void nudge_body(impact_collider *body, uint64_t *state)
{
    const qvec3 j = body->moments;
    body->offset = nudged3(body->offset, state);
    body->velocity = nudged3(body->velocity, state);
    body->omega = nudged3(body->omega, state);
    if (isinf(body->mass)) return;
    body->mass = nudged(body->mass, state);
    body->moments = nudged3(j, state);
    /* A round body stays round. */
    if (j.x == j.y && j.y == j.z) body->moments.y = body->moments.z = body->moments.x;
    quat *q = &body->orientation;
    q->w = nudged(q->w, state);
    q->x = nudged(q->x, state);
    q->y = nudged(q->y, state);
    q->z = nudged(q->z, state);
}

static void nudge_all(impact_collision *c, uint64_t *state)
{
    nudge_body(&c->body[0], state);
    nudge_body(&c->body[1], state);
    c->normal = nudged3(c->normal, state);
    c->friction = nudged(c->friction, state);
    const double eps = nudged(c->restitution, state);
    if (eps <= 1 || c->any_restitution) c->restitution = eps;
}

/* sum of |v|^2 + rho^2 |omega|^2 over the bodies that move, rho^2 the mean moment over the mass; of the difference to
 * `other` if given. */
static double size2(const impact_collision *c, const impact_outcome *o, const impact_outcome *other)
{
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &c->body[i];
        if (isinf(body->mass)) continue;
        const double rho2 = (body->moments.x + body->moments.y + body->moments.z) / (3 * body->mass);
        const qvec3 v = other ? qvec3_sub(o->velocity[i], other->velocity[i]) : o->velocity[i];
        const qvec3 w = other ? qvec3_sub(o->omega[i], other->omega[i]) : o->omega[i];
        sum += qvec3_dot(v, v) + rho2 * qvec3_dot(w, w);
    }
    return sum;
}

double impact_collide_sensitivity(const impact_collision *collision)
{
    impact_outcome outcome, other;
    if (impact_collide(collision, &outcome) < 0) return NAN;
    uint64_t state = 1;
    double worst = 0;
    for (int i = 0; i < TRIES; i++) {
        impact_collision c = *collision;
        nudge_all(&c, &state);
        if (impact_collide(&c, &other) < 0) return NAN;
        const double moved = size2(collision, &outcome, &other);
        if (moved > worst) worst = moved;
    }
    return worst == 0 ? 0 : sqrt(worst / size2(collision, &outcome, NULL)) / nudge;
}
