/* SPDX-License-Identifier: MIT */
#include "collide_extremes.h"

#include <quat/rotation.h>

static double both(uint64_t *g) { return 2 * case_random(g) - 1; }
static double decades(uint64_t *g, double low, double high) { return pow(10, low + (high - low) * case_random(g)); }

static qvec3 in_cube(uint64_t *g)
{
    const double x = both(g), y = both(g), z = both(g);
    return (qvec3){x, y, z};
}

static quat turned(uint64_t *g)
{
    const double w = both(g), x = both(g), y = both(g), z = both(g);
    const quat q = {w, x, y, z};
    quat unit;
    return quat_normalize(q, &unit) == QUAT_OK ? unit : quat_identity();
}

static qvec3 contact_velocity(const impact_collision *c)
{
    const impact_collider *one = &c->body[0], *two = &c->body[1];
    return qvec3_sub(qvec3_add(one->velocity, qvec3_cross(one->omega, one->offset)),
                     qvec3_add(two->velocity, qvec3_cross(two->omega, two->offset)));
}

/* The normal that way round in which the bodies approach. */
static void face(impact_collision *c)
{
    if (qvec3_dot(contact_velocity(c), c->normal) > 0) c->normal = qvec3_neg(c->normal);
}

/* A slim body: along one of its axes it is long and of the moment r. way: 0, struck on its surface; 1, anywhere; 2 and
 * 3, the same with the axes the world's. */
static impact_collider slim_body(uint64_t *g, double r, int way, bool thin_z)
{
    impact_collider body = {.mass = decades(g, -2, 2)};
    const double j = 0.3 * body.mass, one = case_random(g), two = case_random(g), along = both(g);
    const double thick = way % 2 ? 1 : sqrt(r), x = thick * both(g), y = thick * both(g);
    body.moments =
        thin_z ? (qvec3){j * (0.5 + one), j * (0.5 + two), j * r} : (qvec3){j * r, j * (0.5 + one), j * (0.5 + two)};
    body.orientation = way < 2 ? turned(g) : quat_identity();
    body.offset = quat_rotate(body.orientation, thin_z ? (qvec3){x, y, along} : (qvec3){along, x, y});
    body.velocity = in_cube(g);
    body.omega = in_cube(g);
    return body;
}

static impact_collision slender(uint64_t *g, double r, impact_law law)
{
    impact_collision c = {.law = law, .normal = in_cube(g)};
    const int way = (int)(4 * case_random(g));
    c.friction = case_random(g);
    c.restitution = case_random(g);
    const bool thin_z = case_random(g) < 0.5, alone = case_random(g) < 0.4;
    if (way == 3) c.normal = (qvec3){0, 0, 1};
    c.body[0] = slim_body(g, r, way, thin_z);
    c.body[1] = slim_body(g, r, way, !thin_z);
    if (alone) c.body[1] = (impact_collider){.mass = INFINITY, .orientation = {1, 0, 0, 0}};
    face(&c);
    return c;
}

static void change_units(impact_collision *c, double mass, double length, double speed)
{
    for (int i = 0; i < 2; i++) {
        impact_collider *body = &c->body[i];
        body->mass *= mass;
        body->moments = qvec3_scale(body->moments, mass * length * length);
        body->offset = qvec3_scale(body->offset, length);
        body->velocity = qvec3_scale(body->velocity, speed);
        body->omega = qvec3_scale(body->omega, speed / length);
    }
}

static impact_collision slippery(uint64_t *g, impact_law law)
{
    const double r = decades(g, -9, 0);
    impact_collision c = slender(g, case_random(g) < 0.5 ? 1 : r, law);
    c.friction = decades(g, -300, -8);
    /* Nearly above the contact: M_tz is small too. */
    const double off = decades(g, -9, 0);
    for (int i = 0; i < 2; i++) {
        const qvec3 n = qvec3_scale(c.normal, 1 / qvec3_norm(c.normal)), r1 = c.body[i].offset;
        const double along = qvec3_dot(r1, n);
        c.body[i].offset = qvec3_axpy(along, n, qvec3_scale(qvec3_axpy(-along, n, r1), off));
    }
    const double mass = decades(g, -8, 8), length = decades(g, -8, 8), speed = decades(g, -8, 8);
    change_units(&c, mass, length, speed);
    face(&c);
    return c;
}

static double spread(uint64_t *g, double span)
{
    const double size = decades(g, -span, span), sign = case_random(g);
    return sign < 0.1 ? 0 : sign < 0.55 ? -size : size;
}

static qvec3 spread3(uint64_t *g, double span)
{
    const double x = spread(g, span), y = spread(g, span), z = spread(g, span);
    return (qvec3){x, y, z};
}

static impact_collision range(uint64_t *g, impact_law law)
{
    static const double spans[] = {3, 10, 30, 100};
    impact_collision c = {.law = law};
    const double span = spans[(int)(4 * case_random(g))];
    c.normal = in_cube(g);
    c.friction = decades(g, -span, span);
    c.restitution = case_random(g);
    for (int i = 0; i < 2; i++) {
        impact_collider *body = &c.body[i];
        body->mass = decades(g, -fmin(span, 8), fmin(span, 8));
        const double j = body->mass * decades(g, -span, span / 10);
        const double x = decades(g, -6, 6), y = decades(g, -6, 6), z = decades(g, -6, 6);
        body->moments = (qvec3){j * x, j * y, j * z};
        body->orientation = turned(g);
        body->offset = spread3(g, span / 10);
        body->velocity = spread3(g, span / 4);
        body->omega = spread3(g, span / 4);
    }
    if (case_random(g) < 0.3)
        c.body[case_random(g) < 0.5] = (impact_collider){.mass = INFINITY, .orientation = {1, 0, 0, 0}};
    const double mass = decades(g, -span, span), length = decades(g, -span / 4, span / 4),
                 speed = decades(g, -span / 4, span / 4);
    change_units(&c, mass, length, speed);
    face(&c);
    return c;
}

impact_collision case_extreme(case_class class_, uint64_t *g, impact_law law)
{
    const double r = decades(g, -9, -1);
    switch (class_) {
    case CASE_SLENDER: return slender(g, r, law);
    case CASE_SLIPPERY: return slippery(g, law);
    default: return range(g, law);
    }
}

impact_collision case_slender(uint64_t seed, uint64_t index, double r)
{
    uint64_t state = seed * 0x2545f4914f6cdd1du + index * 0x9e3779b97f4a7c15u * 64;
    return slender(&state, r, (impact_law)(index % 3));
}
