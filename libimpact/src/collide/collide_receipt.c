/* SPDX-License-Identifier: MIT
 *
 * The receipt of an impact: identities between what was given and what was answered, from the bodies themselves. No
 * slip is followed: whatever the solver did, these must hold.
 *
 *   momentum  m (V - v) = +-P                        spin  J_k (W - w)_k = +-(r x P)_k on each principal axis
 *   cone      P_n >= 0, |P_t| <= mu P_n              energy  E+ <= E-, W_f <= 0
 *   power     E+ - E- - D = P.(u- + u+)/2 = W_c + W_r + W_f (M is symmetric); D: work of a static body that moves
 *   law       P_n = (1 + eps) p_c; u_n+ = -eps u_n-; W_r = eps^2 |W_c| (compressed once)
 *   approach  u_n- and u_n+ as reported, u_n+ >= 0   stick  u_t+ = 0 where the last phase sticks
 *   path      the same of each phase: its impulse in the cone, u_t = 0 while it sticks, u_n = 0 where compression
 *             turns to restitution and back, all phases together P
 *   hodograph a slip that turns: |u_t| against its direction, in closed form (collide_hodograph.h)
 *
 * Each is divided by the sizes of its own terms, in eps: what rounding of the answer alone would leave is about 1. What
 * the caller's units make smaller than DBL_MIN is rounded as if it were of that size, and counts so.
 */
#include "collide/collide_receipt.h"

#include <float.h>
#include <math.h>
#include "base/tolerances.h"
#include "collide/collide_check.h"
#include "collide/collide_hodograph.h"
#include "collide/collide_units.h"

/* |x| over its terms' sizes, in eps; 0 of nothing. */
static inline double off(double x, double size) { return x == 0 ? 0 : fabs(x) / (DBL_EPSILON * size); }

/* Only what is below 0 counts. */
static inline double below(double x, double size) { return x >= 0 ? 0 : off(x, size); }

/* A NaN is the worst, and stays. */
static inline void note(double *field, double value)
{
    if (!(value <= *field || isnan(*field))) *field = value;
}

/* The same as note of off, without its division where the field is worse already. */
static inline void note_off(double *field, double x, double size)
{
    if (!(fabs(x) <= *field * (DBL_EPSILON * size))) note(field, off(x, size));
}

/* An impulse may be 1e-200 in an impact's units (approach and moments 1e-100), and a static body that is touched at its
 * centre turn at 1e200: the square is none. */
static inline double length(qvec3 v)
{
    const double n2 = qvec3_dot(v, v);
    if (n2 > 1 / IMP_COLLIDE_SQUARES && n2 < IMP_COLLIDE_SQUARES) return sqrt(n2);
    return v.x == 0 && v.y == 0 && v.z == 0 ? 0 : qvec3_norm(v);
}

/* One body: its principal axes, and an impulse's sign. */
typedef struct part {
    const impact_collider *body;
    qvec3 axis[3];
    double sign, arm, v[2], w[2];               /* v, w: the sizes of both velocities, before and after */
    double inverse_mass, inverse_j[3], largest; /* largest: of M's terms */
    bool moves;
} part;

typedef struct view {
    const impact_collision *c;
    const impact_outcome *o;
    imp_least least;
    part part[2];
    qvec3 n, before, after;                  /* unit normal; u- and u+ */
    double size_before, size_after, impulse; /* impulse: its size */
    double drive, drive_size;                /* work of static bodies that are moved, on the other */
} view;

static void make_part(part *p, const impact_collider *body, double sign)
{
    const quat q = body->orientation;
    p->body = body;
    p->sign = sign;
    p->arm = length(body->offset);
    p->moves = body->mass < INFINITY;
    if (!p->moves) return;
    const qvec3 j = body->moments;
    p->inverse_mass = 1 / body->mass;
    p->inverse_j[0] = 1 / j.x;
    p->inverse_j[1] = 1 / j.y;
    p->inverse_j[2] = 1 / j.z;
    const double least = j.x < j.y ? j.x : j.y;
    p->largest = p->inverse_mass + p->arm * p->arm / (least < j.z ? least : j.z);
    const double f = 2 / quat_dot(q, q), w = q.w, x = q.x, y = q.y, z = q.z;
    p->axis[0] = (qvec3){1 - f * (y * y + z * z), f * (x * y + w * z), f * (x * z - w * y)};
    p->axis[1] = (qvec3){f * (x * y - w * z), 1 - f * (x * x + z * z), f * (y * z + w * x)};
    p->axis[2] = (qvec3){f * (x * z + w * y), f * (y * z - w * x), 1 - f * (x * x + y * y)};
}

static inline qvec3 contact_velocity(view *s, const qvec3 v[2], const qvec3 w[2], int after, double *size)
{
    qvec3 u[2];
    *size = 0;
    for (int i = 0; i < 2; i++) {
        part *p = &s->part[i];
        u[i] = qvec3_add(v[i], qvec3_cross(w[i], p->body->offset));
        p->v[after] = length(v[i]);
        p->w[after] = length(w[i]);
        *size += p->v[after] + s->least.velocity + (p->w[after] + s->least.omega) * p->arm;
    }
    return qvec3_sub(u[0], u[1]);
}

static inline double impulse_size(const view *s, qvec3 P) { return length(P) + s->least.impulse; }

/* A static body's point of contact moves by u_s throughout. */
static void make_drive(view *s)
{
    s->drive = s->drive_size = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *b = &s->c->body[i];
        const qvec3 u = qvec3_add(b->velocity, qvec3_cross(b->omega, b->offset));
        if (s->part[i].moves) continue;
        s->drive -= s->part[i].sign * qvec3_dot(s->o->impulse, u);
        s->drive_size += s->impulse * (s->part[i].v[0] + s->part[i].w[0] * s->part[i].arm);
    }
}

static void make_view(view *s, const impact_collision *c, const impact_outcome *o, const imp_least *least)
{
    const qvec3 v[2] = {c->body[0].velocity, c->body[1].velocity}, w[2] = {c->body[0].omega, c->body[1].omega};
    s->c = c;
    s->o = o;
    s->least = *least;
    make_part(&s->part[0], &c->body[0], 1);
    make_part(&s->part[1], &c->body[1], -1);
    s->n = qvec3_scale(c->normal, 1 / length(c->normal));
    s->impulse = impulse_size(s, o->impulse);
    s->before = contact_velocity(s, v, w, 0, &s->size_before);
    s->after = contact_velocity(s, o->velocity, o->omega, 1, &s->size_after);
    make_drive(s);
}

/* ---- the bodies ---- */

static inline double entry(qvec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

/* Kinetic energies before and after, and the sizes of their terms: of J_k W_k^2 it is J_k |W_k| |W|, since W_k comes
 * from world axes. */
typedef struct energies {
    double before, after, size;
} energies;

/* Momentum and spin of one body, and its share of the energies. */
static void examine_body(const view *s, int i, impact_receipt *r, energies *energy)
{
    const part *p = &s->part[i];
    if (!p->moves) return;
    const impact_collider *b = p->body;
    const qvec3 P = s->o->impulse, V = s->o->velocity[i], W = s->o->omega[i];
    const double m = b->mass, size = s->impulse, speed = p->v[1] + p->v[0] + s->least.velocity;
    const qvec3 dv = qvec3_axpy(-p->sign / m, P, qvec3_sub(V, b->velocity));
    note_off(&r->momentum, m * length(dv), size + m * speed);
    const qvec3 torque = qvec3_cross(b->offset, P), dw = qvec3_sub(W, b->omega);
    const double w0 = p->w[0], w1 = p->w[1], turning = w0 + w1 + s->least.omega;
    double before = m * qvec3_dot(b->velocity, b->velocity), after = m * qvec3_dot(V, V), sum = before + after;
    for (int k = 0; k < 3; k++) {
        const double j = entry(b->moments, k), from = qvec3_dot(p->axis[k], b->omega), to = qvec3_dot(p->axis[k], W);
        const double rest = j * qvec3_dot(p->axis[k], dw) - p->sign * qvec3_dot(p->axis[k], torque);
        note_off(&r->spin, rest, j * turning + p->arm * size);
        before += j * from * from;
        after += j * to * to;
        sum += j * (fabs(from) * w0 + fabs(to) * w1);
    }
    energy->before += before / 2;
    energy->after += after / 2;
    energy->size += sum / 2;
}

static void check_energy(const view *s, const energies *energy, impact_receipt *r)
{
    const impact_outcome *o = s->o;
    const double works = o->work_compression + o->work_restitution + o->work_friction,
                 change = energy->after - energy->before - s->drive;
    const double all = energy->size + s->drive_size + s->least.energy,
                 done = s->least.energy + fabs(o->work_compression) + o->work_restitution - o->work_friction;
    if (s->c->law != IMPACT_NEWTON && s->c->restitution <= 1) note(&r->energy, below(-change, all));
    note(&r->energy, below(-o->work_friction, done));
    note_off(&r->energy, o->energy_before - energy->before, all);
    note_off(&r->energy, o->energy_after - energy->after, all);
    const double half = qvec3_dot(o->impulse, qvec3_add(s->before, s->after)) / 2;
    note_off(&r->power, change - works, all + done);
    note_off(&r->power, half - works, s->impulse * (s->size_before + s->size_after) + done);
}

/* ---- friction and restitution ---- */

/* The normal part of an impulse of that size, and how far it is outside of the cone. */
static double outside_cone(const view *s, qvec3 P, double size, double *along)
{
    const double mu = s->c->friction;
    *along = qvec3_dot(P, s->n);
    const double across = length(qvec3_axpy(-*along, s->n, P));
    double outside = below(*along, size);
    if (!s->c->friction_law) note(&outside, below(mu * *along - across, size * (1 + mu)));
    return outside;
}

static void check_approach(const view *s, double along, impact_receipt *r)
{
    const impact_outcome *o = s->o;
    const double u_before = qvec3_dot(s->before, s->n), u_after = qvec3_dot(s->after, s->n);
    note_off(&r->approach, u_before - o->normal_before, s->size_before);
    note_off(&r->approach, u_after - o->normal_after, s->size_before + s->size_after);
    note(&r->approach, below(u_after, s->size_before + s->size_after));
    note_off(&r->approach, along - o->impulse_normal, s->impulse);
}

static void check_law(const view *s, impact_receipt *r)
{
    const impact_outcome *o = s->o;
    const double eps = s->c->restitution, u_before = qvec3_dot(s->before, s->n), u_after = qvec3_dot(s->after, s->n);
    const double due = (1 + eps) * o->compression_impulse, back = eps * eps * fabs(o->work_compression);
    const double impulses = o->impulse_normal + due + s->least.impulse;
    switch (s->c->law) {
    case IMPACT_POISSON: note_off(&r->law, o->impulse_normal - due, impulses); break;
    case IMPACT_NEWTON:
        note_off(&r->law, u_after + eps * u_before, s->size_after + (eps > 1 ? eps : 1) * s->size_before);
        break;
    case IMPACT_STRONGE:
        if (o->compressions == 1)
            note_off(&r->law, o->work_restitution - back, fabs(o->work_compression) + back + s->least.energy);
        break;
    }
}

static bool sticks(unsigned char phase) { return phase == IMPACT_STICK_C || phase == IMPACT_STICK_R; }
static bool compresses(unsigned char phase)
{
    return phase == IMPACT_SLIP_C || phase == IMPACT_STICK_C || phase == IMPACT_TANGENTIAL;
}

/* ---- phase by phase ---- */

/* du = M dP by the bodies, of an impulse of that size; the size of its terms. */
static qvec3 velocity_change(const view *s, qvec3 P, double impulse, double *size)
{
    qvec3 u = {0, 0, 0};
    for (int i = 0; i < 2; i++) {
        const part *p = &s->part[i];
        if (!p->moves) continue;
        const qvec3 r = p->body->offset, torque = qvec3_cross(r, P);
        qvec3 w = {0, 0, 0};
        for (int k = 0; k < 3; k++) w = qvec3_axpy(qvec3_dot(p->axis[k], torque) * p->inverse_j[k], p->axis[k], w);
        u = qvec3_add(u, qvec3_axpy(p->inverse_mass, P, qvec3_cross(w, r)));
        *size += impulse * p->largest;
    }
    return u;
}

/* u_n = 0 where the phases around turn from compression to restitution or back, u_t = 0 before and after sticking. */
static void check_phases(const view *s, impact_receipt *r)
{
    const impact_outcome *o = s->o;
    qvec3 u = s->before, from = {0, 0, 0};
    double along, size = s->size_before;
    for (int i = 0; i < o->phase_count; i++) {
        const unsigned char phase = o->phases[i];
        const qvec3 P = qvec3_sub(o->phase_impulse[i], from);
        const bool last = i + 1 == o->phase_count;
        const unsigned char next = last ? phase : o->phases[i + 1];
        const double impulse = impulse_size(s, P), outside = outside_cone(s, P, impulse, &along);
        if (outside != 0) note(&r->path, outside * impulse / s->impulse);
        u = qvec3_add(u, velocity_change(s, P, impulse, &size));
        from = o->phase_impulse[i];
        const double un = qvec3_dot(u, s->n);
        const bool turns =
            !last && phase != IMPACT_REVERSAL && next != IMPACT_REVERSAL && compresses(phase) != compresses(next);
        if (turns) note_off(&r->path, un, size);
        if (sticks(phase) || sticks(next) || next == IMPACT_REVERSAL)
            note_off(&r->path, length(qvec3_axpy(-un, s->n, u)), size);
    }
    if (o->phase_count < IMPACT_MAX_PHASES) note_off(&r->path, length(qvec3_sub(from, o->impulse)), s->impulse);
}

/* ---- the way of a slip ---- */

static void make_felt_mass(const view *s, qvec3 t1, qvec3 t2, imp_felt_mass *f)
{
    const qvec3 e[3] = {t1, t2, s->n};
    *f = (imp_felt_mass){.friction = s->c->friction};
    for (int i = 0; i < 3; i++) {
        double size = 0;
        const qvec3 u = velocity_change(s, e[i], 1, &size);
        for (int k = 0; k < 3; k++) f->m[k][i] = qvec3_dot(e[k], u);
        f->rounding = fmax(f->rounding, size);
    }
}

/* The first slip, as far as each of its phases: what comes after a stop goes straight. */
static void check_hodograph(const view *s, impact_receipt *r)
{
    const impact_outcome *o = s->o;
    const qvec3 t = qvec3_axpy(-qvec3_dot(s->before, s->n), s->n, s->before), x = qvec3_cross(t, s->n);
    double size = s->size_before;
    const double speed = length(x);
    if (s->c->friction == 0 || s->c->friction_law || !(speed > DBL_EPSILON * size)) return;
    const qvec3 t1 = qvec3_scale(x, 1 / speed), t2 = qvec3_cross(s->n, t1);
    const imp_slip from = {0, speed, size};
    imp_felt_mass f;
    make_felt_mass(s, t1, t2, &f);
    qvec3 u = s->before, P = {0, 0, 0};
    for (int i = 0; i < o->phase_count && (o->phases[i] == IMPACT_SLIP_C || o->phases[i] == IMPACT_SLIP_R); i++) {
        const bool stops = i + 1 < o->phase_count && (sticks(o->phases[i + 1]) || o->phases[i + 1] == IMPACT_REVERSAL);
        double off = 0;
        if (stops) return;
        const qvec3 more = qvec3_sub(o->phase_impulse[i], P);
        u = qvec3_add(u, velocity_change(s, more, impulse_size(s, more), &size));
        P = o->phase_impulse[i];
        if (!imp_hodograph_residual(&f, from, (imp_slip){qvec3_dot(u, t1), qvec3_dot(u, t2), size}, &off)) continue;
        note(&r->hodograph, off);
        r->slips++;
    }
}

/* What rigid contacts keep; springs keep it to their own tolerance, and are left out. */
static void examine_contact(const view *s, impact_receipt *r)
{
    const impact_outcome *o = s->o;
    check_law(s, r);
    check_phases(s, r);
    if (o->phase_count == 0 || !sticks(o->phases[o->phase_count - 1])) return;
    const qvec3 t = qvec3_axpy(-qvec3_dot(s->after, s->n), s->n, s->after);
    r->stick = off(length(t), s->size_before + s->size_after);
}

double imp_receipt_make(const impact_collision *collision, const impact_outcome *outcome, const imp_least *least,
                        bool follows, impact_receipt *receipt)
{
    view s;
    energies energy = {0, 0, 0};
    double along;
    impact_receipt *r = receipt;
    *r = (impact_receipt){0};
    make_view(&s, collision, outcome, least);
    for (int i = 0; i < 2; i++) examine_body(&s, i, r, &energy);
    check_energy(&s, &energy, r);
    r->cone = outside_cone(&s, outcome->impulse, s.impulse, &along);
    check_approach(&s, along, r);
    if (!(collision->tangential_compliance > 0)) {
        examine_contact(&s, r);
        if (follows) check_hodograph(&s, r);
    }
    const double fields[] = {r->momentum, r->spin,     r->cone,  r->energy, r->power,
                             r->law,      r->approach, r->stick, r->path,   r->hodograph};
    for (int i = 0; i < 10; i++) note(&r->worst, fields[i]);
    return r->worst;
}

double impact_collide_receipt(const impact_collision *collision, const impact_outcome *outcome, impact_receipt *receipt)
{
    static const imp_least none = {0, 0, 0, 0};
    const bool fast = fabs(outcome->normal_before) >= IMP_COLLIDE_ORDINARY_APPROACH;
    if (fast && imp_collide_is_plain(collision)) return imp_receipt_make(collision, outcome, &none, true, receipt);
    const imp_units units = imp_units_of(collision);
    const impact_collision scaled = imp_units_scaled(collision, units);
    impact_outcome its = *outcome;
    imp_units_restore(&its, imp_units_inverse(units));
    const imp_least least = imp_units_least(units);
    return imp_receipt_make(&scaled, &its, &least, true, receipt);
}

double imp_receipt_brief(const imp_ready *ready, qvec3 n, double size, const impact_outcome *outcome, double *works)
{
    const impact_outcome *o = outcome;
    const imp_vectors v = imp_vectors_of(o->velocity[0], o->velocity[1]), w = imp_vectors_of(o->omega[0], o->omega[1]);
    const imp_vectors turn = imp_vectors_cross(&w, &ready->arm), u = {v.x + turn.x, v.y + turn.y, v.z + turn.z};
    const imp_lanes each = n.x * u.x + n.y * u.y + n.z * u.z;
    const double un = each[0] - each[1];
    *works = o->work_compression + o->work_restitution + o->work_friction;
    /* The work of a static body that moves; the impulse on body 1, its opposite on body 2. */
    double drive = 0;
    if (ready->mass[1] == 0) drive = o->impulse.x * u.x[1] + o->impulse.y * u.y[1] + o->impulse.z * u.z[1];
    if (ready->mass[0] == 0) drive = -(o->impulse.x * u.x[0] + o->impulse.y * u.y[0] + o->impulse.z * u.z[0]);
    const double all = o->energy_before + o->energy_after + fabs(drive);
    const double energy = fabs(o->energy_after - o->energy_before - *works - drive) / all;
    return (fabs(un - o->normal_after) / size + energy) / DBL_EPSILON;
}
