/* SPDX-License-Identifier: MIT */
#include "collide_cases.h"

#include <quat/rotation.h>
#include "collide_extremes.h"

const char *case_name(case_class class_)
{
    static const char *const names[CASE_ALL] = {"plain",   "wild",     "rod",    "tangent",   "rest",
                                                "planar",  "sphere",   "smooth", "isotropic", "tilted",
                                                "slender", "slippery", "range"};
    return names[class_];
}

double case_random(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

static double both(uint64_t *g) { return 2 * case_random(g) - 1; }
static double decades(uint64_t *g, double low, double high) { return pow(10, low + (high - low) * case_random(g)); }

static qvec3 in_ball(uint64_t *g)
{
    for (;;) {
        const double x = both(g), y = both(g), z = both(g);
        const double n = x * x + y * y + z * z;
        if (n < 1 && n > 1e-3) return (qvec3){x, y, z};
    }
}

static quat any_turn(uint64_t *g)
{
    for (;;) {
        const double w = both(g), x = both(g), y = both(g), z = both(g);
        const quat q = {w, x, y, z};
        const double n = quat_dot(q, q);
        quat unit;
        if (n < 1 && n > 1e-3 && quat_normalize(q, &unit) == QUAT_OK) return unit;
    }
}

/* A solid ellipsoid of the longest semi-axis 1 and two shorter ones, of a mass 10^low ... 10^high, struck at a point on
 * it or, for rods, near the end of its longest axis. The first number drawn is a semi-axis, and so on: what it is does
 * not depend on the compiler. */
static impact_collider ellipsoid(uint64_t *g, double slim, double low, double high, bool at_end)
{
    const double shorter = decades(g, -slim, 0), short_too = decades(g, -slim, 0);
    const qvec3 axes = {shorter, short_too, 1};
    const double mass = low < high ? decades(g, low, high) : 1;
    impact_collider body = {.mass = mass};
    body.orientation = any_turn(g);
    body.velocity = in_ball(g);
    body.omega = in_ball(g);
    const double f = mass / 5, x = axes.x * axes.x, y = axes.y * axes.y, z = axes.z * axes.z;
    body.moments = (qvec3){f * (y + z), f * (x + z), f * (x + y)};
    qvec3 p = in_ball(g);
    if (at_end) p = (qvec3){0.1 * p.x, 0.1 * p.y, 1};
    const double n = sqrt(qvec3_dot(p, p));
    const quat q = body.orientation;
    const qvec3 local = {axes.x * p.x / n, axes.y * p.y / n, axes.z * p.z / n}, i = {q.x, q.y, q.z};
    const qvec3 t = qvec3_scale(qvec3_cross(i, local), 2);
    body.offset = qvec3_add(qvec3_axpy(q.w, t, local), qvec3_cross(i, t));
    const double size = sqrt(qvec3_dot(axes, axes));
    body.omega = qvec3_scale(body.omega, 1 / size);
    return body;
}

static const impact_collider still = {.mass = INFINITY, .orientation = {1, 0, 0, 0}};

static qvec3 contact_velocity(const impact_collision *c)
{
    const impact_collider *one = &c->body[0], *two = &c->body[1];
    return qvec3_sub(qvec3_add(one->velocity, qvec3_cross(one->omega, one->offset)),
                     qvec3_add(two->velocity, qvec3_cross(two->omega, two->offset)));
}

/* Changes the velocity of a body that moves so that the contact's becomes `u`. */
static void set_contact_velocity(impact_collision *c, qvec3 u)
{
    const qvec3 more = qvec3_sub(u, contact_velocity(c));
    if (isfinite(c->body[0].mass))
        c->body[0].velocity = qvec3_add(c->body[0].velocity, more);
    else
        c->body[1].velocity = qvec3_sub(c->body[1].velocity, more);
}

/* Two bodies of three equal moments J = y^2 m, struck off centre along x and along y: M_tt is the same both ways, to
 * the last bit for powers of two. */
static void isotropic(impact_collision *c, uint64_t *g)
{
    static const double powers[] = {0.25, 0.5, 1, 2, 4};
    double size[4];
    for (int i = 0; i < 4; i++) size[i] = powers[(int)(5 * case_random(g))];
    const double x = size[0], y = size[1], m = size[2], j = size[3];
    const double below = floor(16 * case_random(g)) / 8, above = floor(16 * case_random(g)) / 8;
    const qvec3 offset[2] = {{x, 0, -below}, {0, y, above}};
    const double moment[2] = {j * x * x, j * y * y};
    c->normal = (qvec3){0, 0, 1};
    for (int i = 0; i < 2; i++) {
        const qvec3 v = in_ball(g), w = in_ball(g);
        c->body[i] = (impact_collider){m, {moment[i], moment[i], moment[i]}, {1, 0, 0, 0}, offset[i], v, w};
    }
}

/* The whole scene turned; the normal stays of about its length. */
static void turn_all(impact_collision *c, quat q)
{
    c->normal = quat_rotate(q, c->normal);
    for (int i = 0; i < 2; i++) {
        impact_collider *body = &c->body[i];
        body->orientation = quat_mul(q, body->orientation);
        body->offset = quat_rotate(q, body->offset);
        body->velocity = quat_rotate(q, body->velocity);
        body->omega = quat_rotate(q, body->omega);
    }
}

static void make_bodies(impact_collision *c, case_class class_, uint64_t *g)
{
    const bool one_static = case_random(g) < 0.4;
    switch (class_) {
    case CASE_WILD:
        c->body[0] = ellipsoid(g, 2, -4, 4, false);
        c->body[1] = ellipsoid(g, 2, -4, 4, false);
        c->friction = decades(g, -3, 3);
        /* A light frame carries the point struck far outside: M of condition up to 1e8. */
        for (int i = 0; i < 2; i++)
            if (case_random(g) < 0.3) c->body[i].offset = qvec3_scale(c->body[i].offset, decades(g, 0, 3));
        break;
    case CASE_ROD:
        c->body[0] = ellipsoid(g, 2, 0, 0, true);
        c->body[1] = ellipsoid(g, 1, -1, 3, false);
        c->friction = decades(g, -1, 1);
        break;
    case CASE_PLANAR:
    case CASE_TILTED: {
        c->body[0] = ellipsoid(g, 1, 0, 0, false);
        c->body[1] = ellipsoid(g, 1, -1, 1, false);
        c->friction = decades(g, -1.5, 1);
        for (int i = 0; i < 2; i++) {
            impact_collider *body = &c->body[i];
            body->orientation = (quat){1, 0, 0, 0};
            body->offset.y = body->velocity.y = body->omega.x = body->omega.z = 0;
        }
        break;
    }
    case CASE_SPHERE:
        for (int i = 0; i < 2; i++) {
            const double r = decades(g, -1, 0), m = decades(g, -1, 1), j = 0.4 * m * r * r;
            const quat q = any_turn(g);
            const qvec3 v = in_ball(g), w = qvec3_scale(in_ball(g), 1 / r);
            const double along = (i == 0 ? -r : r) / sqrt(qvec3_dot(c->normal, c->normal));
            c->body[i] = (impact_collider){m, {j, j, j}, q, qvec3_scale(c->normal, along), v, w};
        }
        break;
    case CASE_ISOTROPIC: isotropic(c, g); return;
    default: c->body[0] = ellipsoid(g, 0.5, 0, 0, false); c->body[1] = ellipsoid(g, 0.5, -1, 1, false);
    }
    if (one_static) c->body[case_random(g) < 0.5] = still;
}

impact_collision case_make(case_class class_, uint64_t seed, uint64_t index)
{
    uint64_t state =
                 seed * 0x2545f4914f6cdd1du + index * 0x9e3779b97f4a7c15u * 64 + (uint64_t)class_ * 0xda942042e4dd58b5u,
             *g = &state;
    if (class_ >= CASE_CLASSES) return case_extreme(class_, g, (impact_law)(index % 3));
    impact_collision c = {.law = (impact_law)(index % 3)};
    c.normal = in_ball(g);
    if (class_ == CASE_PLANAR || class_ == CASE_TILTED) c.normal.y = 0;
    c.friction = case_random(g);
    const double pick = case_random(g);
    c.restitution = pick < 0.1 ? 0 : pick < 0.2 ? 1 : case_random(g);
    if (class_ == CASE_SMOOTH || (class_ != CASE_WILD && case_random(g) < 0.02)) c.friction = 0;
    make_bodies(&c, class_, g);
    const double n2 = qvec3_dot(c.normal, c.normal);
    qvec3 u = contact_velocity(&c);
    const double approach = qvec3_dot(u, c.normal) / n2;
    /* Mirror what separates; scale what slides. */
    qvec3 normal_part = qvec3_scale(c.normal, approach > 0 ? -approach : approach == 0 ? -1 : approach);
    qvec3 tangent = qvec3_sub(u, qvec3_scale(c.normal, approach));
    const bool far = class_ == CASE_ISOTROPIC && case_random(g) < 0.3;
    if (far) c.friction = decades(g, -3, 3);
    if (class_ == CASE_TANGENT || far) {
        const double s = sqrt(qvec3_dot(tangent, tangent)), z = sqrt(qvec3_dot(normal_part, normal_part));
        tangent = qvec3_scale(tangent, decades(g, -6, 6) * z / s);
    }
    if (class_ == CASE_REST) tangent = qvec3_scale(tangent, case_random(g) < 0.5 ? 0 : 1e-16);
    set_contact_velocity(&c, qvec3_add(normal_part, tangent));
    if (class_ == CASE_TILTED || (class_ == CASE_ISOTROPIC && case_random(g) < 0.5)) turn_all(&c, any_turn(g));
    return c;
}

double case_error(const impact_collision *c, const qvec3 v[2], const qvec3 w[2], const qvec3 wanted_v[2],
                  const qvec3 wanted_w[2])
{
    double off = 0, size = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &c->body[i];
        if (isinf(body->mass)) continue;
        /* rho^2: mean square radius of gyration. */
        const double rho2 = (body->moments.x + body->moments.y + body->moments.z) / (3 * body->mass);
        const qvec3 dv = qvec3_sub(v[i], wanted_v[i]), dw = qvec3_sub(w[i], wanted_w[i]);
        off += qvec3_dot(dv, dv) + rho2 * qvec3_dot(dw, dw);
        size += qvec3_dot(wanted_v[i], wanted_v[i]) + rho2 * qvec3_dot(wanted_w[i], wanted_w[i]);
    }
    return sqrt(off / size);
}
