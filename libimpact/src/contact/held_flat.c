/* SPDX-License-Identifier: MIT
 *
 * With the face's outward normal -n, the centre at height c, the centre of pressure at r = rho - c n, N = -F . n and f
 * the friction, no torque tips the body where (F, T: loads)
 *
 *   rho = rho0 - c f/N,   rho0 = -n x T/N.
 *
 * Sliding, f = -mu N d with d the direction of the slip u there. With w = v + omega n x rho0 the velocity at rho0 and
 * k = mu c omega:
 *
 *   u = |u| d = w + k n x d,   so that   |u|^2 = |w|^2 - k^2,   d = (|u| w + k n x w)/|w|^2.
 *
 * Sticking, rho is where the body's turning leaves no velocity, rho = n x v/omega, and f = -N (rho - rho0)/c; without
 * turning f is what holds the body. v and omega are relative to the plane's surface.
 */
#include "contact/held_flat.h"
#include "contact/held_spot.h"
#include "contact/held_system.h"
#include "world/world_gap.h"

/* A slide that ends in a pivot leaves friction that just suffices, and goes on doing so: what integration adds is not
 * to break it. */
static const double grip = 1 + IMP_FLAT_PIVOT;

static qvec3 plane_normal(const imp_pair *pair, const imp_state *states)
{
    return quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1});
}

static qvec3 across(qvec3 v, qvec3 n) { return qvec3_axpy(-qvec3_dot(v, n), n, v); }

/* The face that looks down: its axis 0, 1, 2, and the half length of it. */
static int face_below(const imp_body *body, const imp_state *state, qvec3 n, double *height, double *sign)
{
    const qvec3 down = quat_rotate_inverse(state->q, qvec3_neg(n));
    const double part[3] = {down.x, down.y, down.z}, axis[3] = {body->shape.a, body->shape.b, body->shape.c};
    int k = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(part[i]) > fabs(part[k])) k = i;
    *height = axis[k];
    *sign = part[k] < 0 ? -1 : 1;
    return k;
}

/* By how much a body has risen that stands on the point at foot of the face, body axes, m; infinite on what is no flat
 * face. With the other axes' u = x/a small, the support function is c (1 + sum |u|^p (p - 1)/p_face). Of a
 * superellipsoid the faces across x and y bend as |u|^r/r along the section and |u|^t/t along z, those across z as
 * K^t/t. */
static double rise(const impact_shape *shape, int face, qvec3 foot)
{
    const double flattest = 3; /* exponents below it make no face */
    const bool nested = shape->kind == IMPACT_SUPERELLIPSOID;
    const double p[3] = {shape->r, shape->s, shape->t}, axis[3] = {shape->a, shape->b, shape->c};
    const double u[3] = {foot.x / shape->a, foot.y / shape->b, foot.z / shape->c};
    double sum = 0;
    if (nested && face == 2) {
        const double k = pow(pow(fabs(u[0]), p[0]) + pow(fabs(u[1]), p[0]), 1 / p[0]);
        return p[2] < flattest ? INFINITY : axis[2] * pow(fmin(k, 2), p[2]) * (p[2] - 1) / p[2];
    }
    for (int i = 0; i < 3; i++) {
        if (i == face) continue;
        if (p[i] < flattest) return INFINITY;
        sum += pow(fmin(fabs(u[i]), 2), p[i]) * (p[i] - 1) / (nested ? p[i] : p[face]);
    }
    return axis[face] * sum;
}

bool imp_flat_suits(const imp_world *world, const imp_pair *pair)
{
    if (!imp_is_held(pair) || !imp_is_carried(pair) || world->bodies[pair->body1].shifted) return false;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *other = &world->pairs[p];
        if (other != pair && imp_is_held(other) && (other->body1 == pair->body1 || other->body2 == pair->body1))
            return false;
    }
    return true;
}

/* Of the motion that the face does not let a body have, J. */
static double rocking_energy(const imp_body *body, const imp_state *state, qvec3 n)
{
    const qvec3 tips = across(imp_omega(body, state), n);
    const double lifts = qvec3_dot(state->v, n);
    return 0.5 * body->mass * lifts * lifts + 0.5 * qvec3_dot(tips, imp_inertia(body, state->q, tips));
}

bool imp_flat_lies(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    return pair->footing.on == IMP_FOOT_FLAT && imp_flat_suits(world, pair) &&
           rocking_energy(&world->bodies[pair->body1], &states[pair->body1], plane_normal(pair, states)) <=
               pair->footing.lying;
}

/* ---- motion along the plane ---- */

typedef struct gliding {
    qvec3 n;
    qvec3 v, surface_rate; /* velocity of the centre, over the surface's; and acceleration of the surface's point */
    double omega, spin;    /* over the surface's; and the surface's, 1/s */
} gliding;

static gliding glide(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    const imp_body *body = &world->bodies[pair->body1], *plane = &world->bodies[pair->body2];
    const imp_state *state = &states[pair->body1];
    gliding g = {.n = plane_normal(pair, states)};
    const qvec3 below = across(qvec3_sub(state->x, states[pair->body2].x), g.n);
    const qvec3 surface = imp_surface_velocity(plane, below);
    g.spin = plane->driven ? qvec3_dot(plane->spin, g.n) : 0;
    g.omega = qvec3_dot(imp_omega(body, state), g.n) - g.spin;
    g.v = qvec3_sub(across(state->v, g.n), surface);
    g.surface_rate = qvec3_scale(qvec3_cross(g.n, surface), g.spin);
    return g;
}

/* Whether the body turns over the surface fast enough to stand on a point of its own. Its centre then goes in circles,
 * at a speed of up to k and the rate g/(c omega): what is too slow to be seen turns in its place. */
static bool pivots(const imp_world *world, const imp_pair *pair, const gliding *g, double height)
{
    const double k = pair->law.friction * height * g->omega;
    return 0.5 * world->bodies[pair->body1].mass * k * k > pair->footing.lying;
}

void imp_flat_level(const imp_world *world, const imp_pair *pair, imp_state *states)
{
    const imp_body *body = &world->bodies[pair->body1];
    imp_state *state = &states[pair->body1];
    double height, sign;
    const gliding g = glide(world, pair, states);
    const int face = face_below(body, state, g.n, &height, &sign);
    const qvec3 outward = {face == 0 ? sign : 0, face == 1 ? sign : 0, face == 2 ? sign : 0};
    const qvec3 turn = qvec3_cross(quat_rotate(state->q, outward), qvec3_neg(g.n));
    quat_normalize(quat_mul(quat_from_rotation_vector(turn), state->q), &state->q);
    const double gap = qvec3_dot(qvec3_sub(state->x, states[pair->body2].x), g.n) - height;
    state->x = qvec3_axpy(-gap, g.n, state->x);
    const bool stands = pair->mode == IMP_STICK && !pivots(world, pair, &g, height);
    const qvec3 v = across(state->v, g.n);
    state->v = stands ? qvec3_sub(v, g.v) : v;
    state->momentum = imp_inertia(body, state->q, qvec3_scale(g.n, g.spin + g.omega));
}

/* ---- the balance ---- */

typedef struct balance {
    double pressure; /* N */
    qvec3 friction;  /* N */
    qvec3 foot;      /* the centre of pressure, from below the centre, m */
    qvec3 slip;      /* there, m/s */
    double speed;    /* of it; less what rounding leaves of it where it ends beside a pivot */
    qvec3 direction;
} balance;

static void slide(const imp_world *world, const imp_pair *pair, const gliding *g, double height, qvec3 shift,
                  balance *b)
{
    const double k = pair->law.friction * height * g->omega;
    const qvec3 w = qvec3_axpy(g->omega, qvec3_cross(g->n, shift), g->v);
    const double size = qvec3_norm(w), speed = sqrt(fmax(0, (size - fabs(k)) * (size + fabs(k))));
    qvec3 d = qvec3_axpy(speed, w, qvec3_scale(qvec3_cross(g->n, w), k));
    if (imp_is_incipient(pair) && !pivots(world, pair, g, height)) d = across(pair->slip.direction, g->n);
    if (!(qvec3_norm(d) > 0)) d = imp_tangent(g->n);
    b->direction = qvec3_scale(d, 1 / qvec3_norm(d));
    b->slip = qvec3_scale(size > 0 ? b->direction : (qvec3){0, 0, 0}, speed);
    b->speed = fmax(0, speed - IMP_FLAT_PIVOT * fabs(k));
    b->friction = qvec3_scale(b->direction, -pair->law.friction * b->pressure);
    b->foot = qvec3_axpy(height * pair->law.friction, b->direction, shift);
}

static void stick(const imp_world *world, const imp_pair *pair, const gliding *g, double height, qvec3 shift,
                  const imp_load *load, balance *b)
{
    if (pivots(world, pair, g, height)) {
        b->foot = qvec3_scale(qvec3_cross(g->n, g->v), 1 / g->omega);
        b->friction = qvec3_scale(qvec3_sub(b->foot, shift), -b->pressure / height);
        return;
    }
    b->friction = qvec3_sub(qvec3_scale(g->surface_rate, world->bodies[pair->body1].mass), across(load->force, g->n));
    b->foot = b->pressure > 0 ? qvec3_axpy(-height / b->pressure, b->friction, shift) : shift;
}

static balance find_balance(const imp_world *world, const imp_pair *pair, const gliding *g, double height,
                            const imp_load *load)
{
    balance b = {.pressure = -qvec3_dot(load->force, g->n), .direction = imp_tangent(g->n)};
    const qvec3 tips = qvec3_cross(g->n, load->torque);
    const qvec3 shift = b.pressure > 0 ? qvec3_scale(tips, -1 / b.pressure) : (qvec3){0, 0, 0};
    if (pair->mode == IMP_SLIDE)
        slide(world, pair, g, height, shift, &b);
    else
        stick(world, pair, g, height, shift, load, &b);
    return b;
}

qvec3 imp_flat_holding(const imp_world *world, int p, const imp_state *states, const imp_load *loads)
{
    imp_pair stuck = world->pairs[p];
    double height, sign;
    stuck.mode = IMP_STICK;
    const gliding g = glide(world, &stuck, states);
    face_below(&world->bodies[stuck.body1], &states[stuck.body1], g.n, &height, &sign);
    const balance b = find_balance(world, &stuck, &g, height, &loads[stuck.body1]);
    return qvec3_axpy(b.pressure, g.n, b.friction);
}

imp_held_contact imp_flat_contact(const imp_world *world, int p, const imp_state *states, const imp_load *loads)
{
    const imp_pair *pair = &world->pairs[p];
    const imp_body *body = &world->bodies[pair->body1];
    const imp_state *state = &states[pair->body1];
    const imp_load *load = &loads[pair->body1];
    double height, sign;
    const gliding g = glide(world, pair, states);
    const int face = face_below(body, state, g.n, &height, &sign);
    const balance b = find_balance(world, pair, &g, height, load);
    imp_held_contact contact = {.pair = p,
                                .body1 = pair->body1,
                                .body2 = pair->body2,
                                .mode = pair->mode,
                                .friction = pair->law.friction * (pair->mode == IMP_STICK ? grip : 1),
                                .normal = g.n,
                                .r1 = qvec3_axpy(-height, g.n, b.foot),
                                .foot = IMP_FOOT_FLAT,
                                .slip = b.slip,
                                .speed = b.speed,
                                .direction = b.direction,
                                .incipient = pair->mode == IMP_SLIDE && imp_is_incipient(pair) &&
                                             !pivots(world, pair, &g, height)};
    contact.r2 = qvec3_add(qvec3_sub(state->x, states[pair->body2].x), contact.r1);
    contact.spare = 1 - rise(&body->shape, face, quat_rotate_inverse(state->q, b.foot)) / world->flat_height;
    const qvec3 force = qvec3_axpy(b.pressure, g.n, b.friction);
    contact.bias = qvec3_neg(imp_system_response(world, states, &contact, &contact, force));
    if (pair->mode == IMP_SLIDE) { /* what the system leaves across the normal is the slip's acceleration */
        const qvec3 pushed = qvec3_add(b.friction, across(load->force, g.n));
        const qvec3 rate = qvec3_axpy(-body->mass, g.surface_rate, pushed);
        contact.bias = qvec3_axpy(qvec3_dot(rate, b.direction) * body->inverse_mass, b.direction, contact.bias);
    }
    return contact;
}

/* ---- lying down, and tipping ---- */

/* Whether the friction would hold the body where it is. */
static bool is_held_fast(const imp_world *world, const imp_pair *pair, const imp_state *states, const imp_load *load,
                         double height)
{
    gliding g = glide(world, pair, states);
    imp_pair stuck = *pair;
    g.v = (qvec3){0, 0, 0};
    g.omega = 0;
    stuck.mode = IMP_STICK;
    const balance b = find_balance(world, &stuck, &g, height, load);
    return qvec3_norm(b.friction) < pair->law.friction * b.pressure;
}

/* A body on its face whose energy does not lift it, and that friction holds, is stopped. */
static bool stops(const imp_world *world, imp_pair *pair, imp_state *states, const imp_load *load, double height)
{
    const imp_body *body = &world->bodies[pair->body1];
    imp_state *state = &states[pair->body1];
    const gliding g = glide(world, pair, states);
    const double moment = qvec3_dot(g.n, imp_inertia(body, state->q, g.n));
    const double moving = 0.5 * (body->mass * qvec3_dot(g.v, g.v) + moment * g.omega * g.omega);
    if ((moving == 0 && pair->mode == IMP_STICK) || !(moving <= pair->footing.lying) || !(pair->law.friction > 0))
        return false;
    if (!is_held_fast(world, pair, states, load, height)) return false;
    pair->mode = IMP_STICK;
    imp_end_incipient(pair);
    state->v = qvec3_sub(state->v, g.v);
    state->momentum = imp_inertia(body, state->q, qvec3_scale(g.n, g.spin));
    return true;
}

/* What stands still on its face, where friction would not hold it, slides there, whatever it would do about the point
 * at which it was held. */
static void let_slide(const imp_world *world, imp_pair *pair, const imp_state *states, const imp_load *load,
                      double height)
{
    const gliding g = glide(world, pair, states);
    const qvec3 pulled = qvec3_axpy(-world->bodies[pair->body1].mass, g.surface_rate, across(load->force, g.n));
    const double pull = qvec3_norm(pulled);
    if (pair->mode != IMP_STICK || !(pull > 0) || qvec3_norm(g.v) > world->slip_speed || g.omega != 0) return;
    if (is_held_fast(world, pair, states, load, height)) return;
    pair->mode = IMP_SLIDE;
    pair->slip.stage = pair->law.friction > 0 ? IMP_SLIP_INCIPIENT : IMP_SLIP_GROSS;
    pair->slip.direction = qvec3_scale(pulled, 1 / pull);
}

/* What cannot lie, for its centre of pressure would be beyond the flat place, tips about that place's border there. */
static void lean(const imp_world *world, imp_pair *pair, const imp_state *state, int face, qvec3 foot, qvec3 n)
{
    enum { HALVINGS = 60 };
    const impact_shape *shape = &world->bodies[pair->body1].shape;
    const qvec3 out = quat_rotate_inverse(state->q, foot), down = quat_rotate_inverse(state->q, qvec3_neg(n));
    double inside = 0, outside = 1;
    for (int i = 0; i < HALVINGS; i++) {
        const double part = 0.5 * (inside + outside);
        *(rise(shape, face, qvec3_scale(out, part)) <= world->flat_height ? &inside : &outside) = part;
    }
    const double axis[3] = {shape->a, shape->b, shape->c};
    imp_spot_on(shape, qvec3_axpy(axis[face], down, qvec3_scale(out, inside)), pair->footing.spot);
}

static bool lay_flat(const imp_world *world, imp_pair *pair, imp_state *states, const imp_load *load)
{
    const imp_body *body = &world->bodies[pair->body1];
    imp_state *state = &states[pair->body1];
    const qvec3 n = plane_normal(pair, states);
    double height, sign;
    const int face = face_below(body, state, n, &height, &sign);
    const double pressure = -qvec3_dot(load->force, n), enough = pressure * world->flat_height;
    if (pair->footing.on == IMP_FOOT_FLAT) return stops(world, pair, states, load, height);
    const imp_spot spot = imp_spot_at(&body->shape, pair->footing.spot);
    const double lifted = qvec3_dot(spot.point, spot.normal) - height;
    const double rocking = rocking_energy(body, state, n) + pressure * fmax(lifted, 0);
    if (!(rocking <= enough) || !(rise(&body->shape, face, spot.point) <= world->flat_height)) return false;
    const imp_pair pair_before = *pair;
    const imp_state state_before = *state;
    pair->footing.lying = enough;
    stops(world, pair, states, load, height);
    let_slide(world, pair, states, load, height);
    const gliding g = glide(world, pair, states);
    const balance b = find_balance(world, pair, &g, height, load);
    if (!(rise(&body->shape, face, quat_rotate_inverse(state->q, b.foot)) <= 0.5 * world->flat_height)) {
        *pair = pair_before;
        *state = state_before;
        lean(world, pair, state, face, b.foot, n);
        return true;
    }
    pair->footing.on = IMP_FOOT_FLAT;
    imp_flat_level(world, pair, states);
    imp_spot_find(&body->shape, quat_rotate_inverse(state->q, qvec3_neg(n)), pair->footing.spot);
    return true;
}

bool imp_flat_lay(imp_world *world, imp_state *states, const imp_load *loads)
{
    bool any = false;
    for (int p = 0; p < world->pair_count; p++)
        if (imp_flat_suits(world, &world->pairs[p]))
            any = lay_flat(world, &world->pairs[p], states, &loads[world->pairs[p].body1]) || any;
    return any;
}

void imp_flat_tip(const imp_world *world, imp_pair *pair, const imp_state *states, const imp_held_contact *contact)
{
    const impact_shape *shape = &world->bodies[pair->body1].shape;
    const qvec3 at = quat_rotate_inverse(states[pair->body1].q, contact->r1);
    imp_spot_on(shape, at, pair->footing.spot);
    pair->footing.on = IMP_FOOT_SPOT;
}
