/* SPDX-License-Identifier: MIT */
#include "motion/lying.h"
#include "motion/motion_equations.h"
#include "contact/held_system.h"
#include "contact/points.h"
#include "world/world_gap.h"

#include <impact/face.h>
#include <string.h>

/* ---- the two faces ---- */

/* Of a face, in the world, from its body's centre of mass. */
static qvec3 corner_of(const imp_body *body, const imp_state *state, const impact_face *face, int i)
{
    return qvec3_add(imp_shape_offset(body, state), quat_rotate(imp_shape_axes(body, state), face->point[i]));
}

/* Outward, by Newell's sum over its sides. */
static qvec3 normal_of(const imp_body *body, const imp_state *state, const impact_face *face)
{
    qvec3 sum = {0, 0, 0};
    for (int i = 0; i < face->count; i++) {
        const qvec3 a = qvec3_sub(face->point[i], face->point[0]),
                    b = qvec3_sub(face->point[(i + 1) % face->count], face->point[0]);
        sum = qvec3_add(sum, qvec3_cross(a, b));
    }
    return quat_rotate(imp_shape_axes(body, state), qvec3_scale(sum, 1 / qvec3_norm(sum)));
}

static bool face_towards(const imp_body *body, const imp_state *state, qvec3 direction, double height,
                         impact_face *face)
{
    const qvec3 d = quat_rotate_inverse(imp_shape_axes(body, state), direction);
    const bool found = impact_shape_face(&body->shape, d, height, face) == 2;
    return found && face->count >= 3 && (face->disc > 0 || face->count <= IMP_FLAT_SIDES);
}

/* Its line along a, unit, through the centre of mass, about which all is alike: it turns about that as about a
 * principal axis, and the same across it. */
static bool is_round_about(const imp_body *body, const imp_state *state, qvec3 a)
{
    const qvec3 t = imp_tangent(a), b = qvec3_cross(a, t), offset = imp_shape_offset(body, state),
                Ia = imp_inertia(body, state->q, a), It = imp_inertia(body, state->q, t),
                Ib = imp_inertia(body, state->q, b);
    const double level = IMP_LEVEL * (qvec3_norm(It) + qvec3_norm(Ib));
    const double aslant = qvec3_norm(qvec3_cross(a, Ia)), apart = fabs(qvec3_dot(t, It) - qvec3_dot(b, Ib));
    return aslant <= level && apart <= level && fabs(qvec3_dot(t, Ib)) <= level &&
           qvec3_norm(qvec3_cross(a, offset)) <= IMP_LEVEL * body->radius;
}

/* The side line of a body that is round about its axis; along: that, unit, in the world. */
static bool line_towards(const imp_body *body, const imp_state *state, qvec3 direction, double height,
                         impact_face *face, qvec3 *along)
{
    const qvec3 d = quat_rotate_inverse(imp_shape_axes(body, state), direction);
    if (body->shape.kind != IMPACT_CAPSULE && body->shape.kind != IMPACT_CYLINDER) return false;
    if (impact_shape_face(&body->shape, d, height, face) != 1 || face->count != 2) return false;
    *along = quat_rotate(imp_shape_axes(body, state), (qvec3){0, 0, 1});
    return is_round_about(body, state, *along);
}

/* In the plane's axes over the size; about the normal the corners go the other way round where it looks against it. */
static void lay_out_face(const imp_lying *lying, const imp_body *body, const imp_state *state, qvec3 shift,
                         const impact_face *face, bool reversed, imp_flat_face *out)
{
    *out = (imp_flat_face){.count = face->disc > 0 ? 0 : face->count, .radius = face->disc / lying->size};
    for (int i = 0; i < face->count; i++) {
        const qvec3 c = qvec3_add(shift, corner_of(body, state, face, i));
        for (int k = 0; k < 2; k++) {
            const double x = qvec3_dot(c, lying->axis[k]) / lying->size;
            out->center[k] += x / face->count;
            if (out->count > 0) out->corner[reversed ? face->count - 1 - i : i][k] = x;
        }
    }
}

static void lay_out_line(const imp_lying *lying, const impact_face *face, imp_flat_face *out)
{
    double end[2];
    for (int i = 0; i < 2; i++)
        end[i] = qvec3_dot(lying->axis[0], corner_of(lying->body, &lying->level, face, i)) / lying->size;
    *out = (imp_flat_face){.count = IMP_FLAT_LINE,
                           .center = {0.5 * (end[0] + end[1]), 0},
                           .corner = {{fmin(end[0], end[1]), 0}, {fmax(end[0], end[1]), 0}}};
}

/* A plane's bounds, if it has any; on sides without end far beyond all that matters. */
static bool plane_bounds(const imp_lying *lying, const imp_body *under, const imp_state *state, qvec3 apart,
                         imp_flat_face *out)
{
    const double far = IMP_WITHOUT_END * lying->size, a = fmin(under->shape.a, far), b = fmin(under->shape.b, far);
    const qvec3 corner[4] = {{-a, -b, 0}, {a, -b, 0}, {a, b, 0}, {-a, b, 0}};
    *out = (imp_flat_face){.count = 4};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++) {
            const qvec3 c = qvec3_sub(quat_rotate(state->q, corner[i]), apart);
            out->corner[i][k] = qvec3_dot(c, lying->axis[k]) / lying->size;
        }
    return isfinite(under->shape.a) || isfinite(under->shape.b);
}

/* ---- the body ---- */

static qvec3 across(qvec3 v, qvec3 n) { return qvec3_axpy(-qvec3_dot(n, v), n, v); }

/* What rocks as it lies down keeps the velocity that it has at the face, below its centre: where it sticks, none. That
 * is friction's doing: without it, or where it would drive the body, it is the centre that keeps its own. */
static void keep_sliding(imp_lying *lying, const imp_state *state, double friction)
{
    const qvec3 n = lying->normal, below = qvec3_scale(n, -lying->motion.height * lying->size),
                own = across(state->v, n), u = across(imp_point_velocity(lying->body, state, below), n);
    lying->level.v = friction > 0 && qvec3_dot(u, u) <= qvec3_dot(own, own) ? u : own;
}

static void level(imp_lying *lying, const imp_state *state, qvec3 outward)
{
    const imp_body *body = lying->body;
    const qvec3 n = lying->normal, turn = qvec3_cross(outward, qvec3_neg(n));
    lying->level = *state;
    quat_normalize(quat_mul(quat_from_rotation_vector(turn), state->q), &lying->level.q);
    lying->inertia = imp_inertia(body, lying->level.q, n);
    const qvec3 turns = imp_omega(body, state), tips = across(turns, n);
    /* n.L stays, for pressure has no moment about n */
    const double omega = qvec3_dot(n, turns) + qvec3_dot(lying->inertia, tips) / qvec3_dot(n, lying->inertia);
    lying->level.momentum = qvec3_scale(lying->inertia, omega);
    lying->axis[0] = imp_tangent(n), lying->axis[1] = qvec3_cross(n, lying->axis[0]);
    memset(lying->start, 0, sizeof lying->start);
    lying->start[IMP_FACE_W] = omega;
}

/* The same with a line, along `along` before: it keeps its roll, and the velocity of its centre. */
static void level_line(imp_lying *lying, const imp_state *state, qvec3 along)
{
    const imp_body *body = lying->body;
    const qvec3 n = lying->normal, outward = across(qvec3_neg(n), along);
    level(lying, state, qvec3_scale(outward, 1 / qvec3_norm(outward)));
    const qvec3 flat = across(along, n);
    lying->axis[0] = qvec3_scale(flat, 1 / qvec3_norm(flat)), lying->axis[1] = qvec3_cross(n, lying->axis[0]);
    const double own = qvec3_dot(lying->axis[0], imp_inertia(body, lying->level.q, lying->axis[0])),
                 roll = qvec3_dot(lying->axis[0], imp_omega(body, state));
    lying->rolled = qvec3_scale(lying->axis[0], own);
    lying->level.momentum = qvec3_axpy(roll, lying->rolled, lying->level.momentum);
    lying->level.v = across(state->v, n);
    lying->start[IMP_FACE_ROLL] = roll;
}

/* What is but rounding of the other is none. */
static double beside(double part, double whole) { return fabs(part) > IMP_LEVEL * fabs(whole) ? part : 0; }

static imp_face_load load_of(const imp_lying *lying, const imp_load *load)
{
    const qvec3 n = lying->normal, tips = qvec3_cross(n, load->torque);
    const double force = lying->body->mass * lying->size, unit = force * lying->size;
    imp_face_load out = {.press = -qvec3_dot(n, load->force) / force,
                         .turn = qvec3_dot(n, load->torque) / qvec3_dot(n, lying->inertia),
                         .power = load->work_rate / unit,
                         .damping = load->damping_rate / unit};
    for (int k = 0; k < 2; k++) {
        out.pull[k] = beside(qvec3_dot(lying->axis[k], load->force) / force, out.press);
        out.tip[k] = qvec3_dot(lying->axis[k], tips) / unit;
    }
    return out;
}

/* imp_face_loads: what else moves in the world does not act on it. */
static bool loads_at(const void *context, const double *y, imp_face_load *load)
{
    const imp_lying *lying = context;
    imp_motion *motion = lying->moves;
    motion->scratch[lying->index] = imp_lying_state(lying, y);
    if (!imp_motion_load(motion, lying->t0 + y[IMP_FACE_TIME], motion->scratch)) return false;
    *load = load_of(lying, &motion->loads[lying->index]);
    return true;
}

static bool set_motion(imp_lying *lying, const imp_pair *pair, const imp_state *states)
{
    imp_face_motion *m = &lying->motion;
    imp_motion *motion = lying->moves;
    const imp_world *world = motion->world;
    const imp_body *body = lying->body;
    const qvec3 n = lying->normal;
    const double L = lying->size, spin = qvec3_dot(n, lying->inertia), unit = lying->body->mass * L * L;
    memcpy(motion->scratch, states, (size_t)world->body_count * sizeof *states);
    m->friction = pair->law.friction;
    m->context = lying, m->clock = 0;
    m->loads = world->field_count > 0 || body->linear_rate != 0 || body->angular_rate != 0 ? loads_at : NULL;
    m->turning = unit / spin;
    m->rolling = qvec3_norm(lying->rolled) / unit;
    if (!loads_at(lying, lying->start, &m->load)) return false;
    m->longest = fmin(imp_field_step_limit(world, motion->scratch, motion->loads),
                      imp_field_custom_step_limit(world, motion->scratch, motion->loads));
    for (int k = 0; k < 2; k++) {
        m->aside[k] = beside(qvec3_dot(lying->axis[k], lying->inertia), spin) / unit;
        lying->start[IMP_FACE_V + k] = qvec3_dot(lying->axis[k], lying->level.v) / L;
    }
    if (m->rolling > 0) lying->start[IMP_FACE_V + 1] += m->height * lying->start[IMP_FACE_ROLL];
    imp_face_prepare(m);
    m->gyration = sqrt((m->moments[1][1] + m->moments[2][2]) / m->moments[0][0]);
    return m->load.press > 0;
}

static double farthest(const imp_lying *lying, const impact_face *face)
{
    double most = 0;
    for (int i = 0; i < face->count; i++) {
        const qvec3 c = corner_of(lying->body, &lying->level, face, i);
        most = fmax(most, hypot(qvec3_dot(c, lying->axis[0]), qvec3_dot(c, lying->axis[1])));
    }
    return most;
}

/* Whether bodies that move attract each other. */
static bool is_attracted(const imp_world *world)
{
    for (int k = 0; k < world->field_count; k++)
        if (world->fields[k].def.kind == IMPACT_FORCE_ATTRACTION) return true;
    return false;
}

/* By how much more the centre rises as a body comes to stand on a place of its flat than that place is off its plane:
 * |u|^p (p - 1)/p of a flat that bends as |u|^p/p, at the most (held_flat.c: rise). */
static double lift_of(const imp_body *body)
{
    const impact_shape *s = &body->shape;
    const bool curved = s->kind == IMPACT_SUPERQUADRIC || s->kind == IMPACT_SUPERELLIPSOID;
    return curved ? fmax(1, fmax(s->r, fmax(s->s, s->t)) - 1) : 1;
}

bool imp_lying_find(imp_motion *motion, const imp_pair *given, double t, const imp_state *states, imp_lying *lying)
{
    imp_world *world = motion->world;
    imp_pair pair = *given;
    const imp_body *body = &world->bodies[pair.body1], *under = &world->bodies[pair.body2];
    const imp_state *state = &states[pair.body1], *below = &states[pair.body2];
    impact_contact contact;
    impact_face face, ground;
    qvec3 along;
    if (!under->is_static || under->driven || pair.law.torsional > 0 || is_attracted(world)) return false;
    imp_world_gap(world, &pair, states, &contact);
    /* what rocks by less lies; of a superquadric that height is what its flat place is of */
    const double touching = imp_has_faces(body) ? imp_world_touching_distance(world, &pair, states) : 0,
                 height = touching + world->flat_height / fmax(lift_of(body), lift_of(under));
    const bool on_plane = under->shape.kind == IMPACT_PLANE;
    const bool line = line_towards(body, state, qvec3_neg(contact.normal), height, &face, &along);
    if (line && (pair.law.rolling > 0 || !(pair.law.friction > 0))) return false;
    if (!line && !face_towards(body, state, qvec3_neg(contact.normal), height, &face)) return false;
    if (!on_plane && !face_towards(under, below, contact.normal, height, &ground)) return false;
    lying->body = body;
    lying->moves = motion, lying->t0 = t, lying->index = pair.body1;
    lying->normal = on_plane ? quat_rotate(below->q, (qvec3){0, 0, 1}) : normal_of(under, below, &ground);
    lying->rolled = (qvec3){0, 0, 0};
    if (line)
        level_line(lying, state, along);
    else
        level(lying, state, normal_of(body, state, &face));
    const qvec3 n = lying->normal, low = corner_of(body, &lying->level, &face, 0);
    const double ground_level = on_plane ? 0 : qvec3_dot(n, corner_of(under, below, &ground, 0));
    const double gap = qvec3_dot(n, qvec3_sub(state->x, below->x)) + qvec3_dot(n, low) - ground_level;
    lying->level.x = qvec3_axpy(-gap, n, state->x);
    lying->size = farthest(lying, &face);
    lying->motion.height = -qvec3_dot(n, low) / lying->size;
    if (!line) keep_sliding(lying, state, pair.law.friction);
    if (line)
        lay_out_line(lying, &face, &lying->motion.face);
    else
        lay_out_face(lying, body, &lying->level, (qvec3){0, 0, 0}, &face, true, &lying->motion.face);
    const qvec3 apart = qvec3_sub(lying->level.x, below->x);
    lying->motion.bounded = !on_plane || plane_bounds(lying, under, below, apart, &lying->motion.under);
    if (!on_plane) lay_out_face(lying, under, below, qvec3_neg(apart), &ground, false, &lying->motion.under);
    return set_motion(lying, &pair, states);
}

/* ---- its state and step ---- */

static qvec3 in_plane(const imp_lying *lying, double x, double y)
{
    return qvec3_add(qvec3_scale(lying->axis[0], lying->size * x), qvec3_scale(lying->axis[1], lying->size * y));
}

/* Rolled about its line first. */
static void roll_on(const imp_lying *lying, const double *y, quat turn, imp_state *state)
{
    const quat roll = quat_from_rotation_vector(qvec3_scale(lying->axis[0], y[IMP_FACE_ROLLED]));
    double v[2];
    imp_face_center_velocity(&lying->motion, y, v);
    state->v = in_plane(lying, v[0], v[1]);
    state->q = quat_unit(quat_mul(turn, quat_mul(roll, lying->level.q)));
    state->momentum = qvec3_axpy(y[IMP_FACE_ROLL], quat_rotate(turn, lying->rolled), state->momentum);
}

imp_state imp_lying_state(const imp_lying *lying, const double *y)
{
    const quat turn = quat_from_rotation_vector(qvec3_scale(lying->normal, y[IMP_FACE_ANGLE]));
    imp_state state = {.x = qvec3_add(lying->level.x, in_plane(lying, y[IMP_FACE_X], y[IMP_FACE_X + 1])),
                       .v = in_plane(lying, y[IMP_FACE_V], y[IMP_FACE_V + 1]),
                       .q = quat_unit(quat_mul(turn, lying->level.q))};
    state.momentum = qvec3_scale(quat_rotate(turn, lying->inertia), y[IMP_FACE_W]);
    if (imp_lies_on_line(lying)) roll_on(lying, y, turn, &state);
    return state;
}

void imp_lying_force(const imp_lying *lying, const double *y, const imp_face_balance *b, qvec3 *force, qvec3 *arm,
                     double *moment)
{
    const quat turn = quat_from_rotation_vector(qvec3_scale(lying->normal, y[IMP_FACE_ANGLE]));
    const imp_face_motion *m = &lying->motion;
    const double weight = lying->body->mass * m->load.press; /* over the size */
    const qvec3 along = quat_rotate(turn, in_plane(lying, b->force[0], b->force[1]));
    *force = qvec3_axpy(weight * lying->size, lying->normal, qvec3_scale(along, weight));
    const qvec3 below = quat_rotate(turn, in_plane(lying, b->center[0], b->center[1]));
    *arm = qvec3_axpy(-m->height * lying->size, lying->normal, below);
    const double about = b->center[0] * b->force[1] - b->center[1] * b->force[0];
    *moment = weight * lying->size * lying->size * (b->moment - about);
}

/* The polynomial through the values at so many places in [-1, 0], by divided differences. */
static void interpolate(const double *s, const double *value, double *c)
{
    double d[IMP_DENSE_TERMS];
    memcpy(d, value, sizeof d);
    for (int k = 1; k < IMP_DENSE_TERMS; k++)
        for (int i = IMP_DENSE_TERMS - 1; i >= k; i--) d[i] = (d[i] - d[i - 1]) / (s[i] - s[i - k]);
    memset(c, 0, IMP_DENSE_TERMS * sizeof *c);
    for (int k = IMP_DENSE_TERMS - 1; k >= 0; k--) {
        for (int j = IMP_DENSE_TERMS - 1; j > 0; j--) c[j] = c[j - 1] - s[k] * c[j];
        c[0] = d[k] - s[k] * c[0];
    }
}

static void put(imp_dense *dense, int i, const double *c)
{
    for (int k = 0; k < IMP_DENSE_TERMS; k++) dense->c[k * dense->size + i] = c[k];
}

/* first + scale y_n over the path. */
static void put_of_path(imp_dense *dense, int i, const imp_face_path *path, int n, double first, double scale)
{
    double c[IMP_DENSE_TERMS] = {0};
    for (int k = 0; k < IMP_FACE_TERMS; k++) c[k] = scale * path->c[k][n];
    c[0] += first;
    put(dense, i, c);
}

static void put_in_plane(imp_dense *dense, int i, const imp_lying *lying, const imp_face_path *path, int n, qvec3 first)
{
    const qvec3 a = qvec3_scale(lying->axis[0], lying->size), b = qvec3_scale(lying->axis[1], lying->size);
    const double from[3] = {first.x, first.y, first.z}, x[3] = {a.x, a.y, a.z}, y[3] = {b.x, b.y, b.z};
    for (int k = 0; k < 3; k++) {
        double c[IMP_DENSE_TERMS] = {0};
        for (int j = 0; j < IMP_FACE_TERMS; j++) c[j] = x[k] * path->c[j][n] + y[k] * path->c[j][n + 1];
        c[0] += from[k];
        put(dense, i + k, c);
    }
}

/* What turns is no polynomial: one through Chebyshev's places. So does the velocity of what rolls. */
static void put_turning(imp_dense *dense, int first, const imp_lying *lying, const imp_face_path *path)
{
    enum { TURNING = 10 };
    const int count = imp_lies_on_line(lying) ? TURNING : TURNING - 3;
    double s[IMP_DENSE_TERMS], value[TURNING][IMP_DENSE_TERMS], c[IMP_DENSE_TERMS];
    for (int k = 0; k < IMP_DENSE_TERMS; k++) {
        double y[IMP_FACE_STATE];
        s[k] = -0.5 * (1 - cos(acos(-1) * k / (IMP_DENSE_TERMS - 1)));
        imp_face_at(path, s[k], y);
        const imp_state at = imp_lying_state(lying, y);
        const double now[TURNING] = {at.q.w,        at.q.x,        at.q.y, at.q.z, at.momentum.x,
                                     at.momentum.y, at.momentum.z, at.v.x, at.v.y, at.v.z};
        for (int n = 0; n < count; n++) value[n][k] = now[n];
    }
    for (int n = 0; n < count; n++) {
        interpolate(s, value[n], c);
        put(dense, first + (n < 4 ? 3 + n : n < 7 ? Y_VELOCITY + 3 + n - 4 : Y_VELOCITY + n - 7), c);
    }
}

/* ---- where forces change ---- */

/* Below zero beyond an edge that the body was within, or without, when the step began. */
static double nearest_edge(const imp_lying *lying, const imp_face_path *path, double s, int *edge)
{
    imp_motion *motion = lying->moves;
    double y[IMP_FACE_STATE], least = INFINITY;
    imp_face_at(path, s, y);
    motion->scratch[lying->index] = imp_lying_state(lying, y);
    for (int k = 0; k < imp_field_edge_count(motion->world); k++) {
        const double value = imp_field_edge(motion->world, lying->t0 + y[IMP_FACE_TIME], motion->scratch, k);
        if (value < least) least = value, *edge = k;
    }
    return least;
}

static double time_at(const imp_lying *lying, const imp_face_path *path, double s)
{
    double y[IMP_FACE_STATE];
    imp_face_at(path, s, y);
    return lying->t0 + y[IMP_FACE_TIME];
}

double imp_lying_end(const imp_lying *lying, const imp_face_path *path, imp_end *end)
{
    enum { HALVINGS = 60 };
    int edge = 0;
    double s = 0, t_end = lying->moves->stride.t_end;
    *end = (imp_end){IMP_END_TIME, 0};
    if (lying->moves->world->field_count == 0) return s;
    if (time_at(lying, path, s) > t_end) {
        double early = -1;
        for (int i = 0; i < HALVINGS; i++) {
            const double middle = 0.5 * (early + s);
            *(time_at(lying, path, middle) < t_end ? &early : &s) = middle;
        }
        end->kind = IMP_END_RENEWAL;
    }
    if (!(nearest_edge(lying, path, s, &edge) < 0)) return s;
    double within = -1;
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (within + s);
        *(nearest_edge(lying, path, middle, &edge) < 0 ? &s : &within) = middle;
    }
    (void)nearest_edge(lying, path, s, &edge);
    *end = (imp_end){IMP_END_EDGE, edge};
    return s;
}

double imp_lying_until_edge(const imp_lying *lying, const imp_face_path *path)
{
    enum { HALVINGS = 20 };
    int edge;
    double s = 2, within = 0;
    if (lying->moves->world->field_count == 0 || path->clock > 0 || !(nearest_edge(lying, path, s, &edge) < 0))
        return INFINITY;
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (within + s);
        *(nearest_edge(lying, path, middle, &edge) < 0 ? &s : &within) = middle;
    }
    return path->length * s * 2 / (1 + imp_face_last_node);
}

impact_status imp_motion_next_lying(imp_motion *motion, const imp_lying *lying, const imp_face_path *path, double s,
                                    imp_state *states)
{
    imp_dense *dense = &motion->dense;
    imp_stride *stride = &motion->stride;
    imp_works *works = &motion->works;
    impact_status status = imp_motion_make_room(motion);
    if (status == IMPACT_OK)
        status = imp_dense_reserve(dense, motion->world->arena, motion->size, motion->world->body_count);
    if (status != IMPACT_OK) return status;
    const double unit = lying->body->mass * lying->size * lying->size, t0 = stride->t;
    double end[IMP_FACE_STATE];
    imp_face_at(path, s, end);
    memset(motion->found, 0, sizeof *motion->found * (size_t)motion->roots); /* no integrator's */
    *dense = (imp_dense){.t0 = t0,
                         .t1 = t0 + end[IMP_FACE_TIME],
                         .h = 1,
                         .size = motion->size,
                         .terms = IMP_DENSE_TERMS,
                         .clocked = true,
                         .c = dense->c,
                         .room = dense->room,
                         .seen = dense->seen,
                         .seen_room = dense->seen_room};
    memset(dense->c, 0, sizeof *dense->c * IMP_DENSE_TERMS * (size_t)dense->size);
    put_of_path(dense, Y_TIME, path, IMP_FACE_TIME, t0, 1);
    put_of_path(dense, Y_SLIDING, path, IMP_FACE_WORK, works->sliding, unit);
    put_of_path(dense, Y_FORCE_WORK, path, IMP_FACE_PUSHED, works->force, unit);
    put_of_path(dense, Y_DAMPING, path, IMP_FACE_DAMPED, works->damping, unit);
    put_in_plane(dense, Y_BODIES, lying, path, IMP_FACE_X, lying->level.x);
    put_in_plane(dense, Y_BODIES + Y_VELOCITY, lying, path, IMP_FACE_V, (qvec3){0, 0, 0});
    put_turning(dense, Y_BODIES, lying, path);
    works->sliding += unit * end[IMP_FACE_WORK];
    works->force += unit * end[IMP_FACE_PUSHED];
    works->damping += unit * end[IMP_FACE_DAMPED];
    stride->t = dense->t1;
    stride->restart = true;
    for (int i = 0; i < motion->world->body_count; i++)
        if (!motion->world->bodies[i].is_static) states[i] = imp_lying_state(lying, end);
    return IMPACT_OK;
}
