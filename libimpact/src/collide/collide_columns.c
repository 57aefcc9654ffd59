/* SPDX-License-Identifier: MIT
 *
 * The columns of the derivative of the velocities after an impact, one for each number x of the data, times x:
 *
 *   dV = dv +- (dP - dm/m P)/m,     dW = dw +- d(J^-1 (r x P)),     dP = sum_k dP/dk dk + P_i de_i
 *
 * with k = M, u-, mu, eps in the contact's frame e = (t1, t2, n). In a body's axes b(e) = r x e is the arm of e, its
 * part of M is e.f/m + sum b_i(e) b_i(f)/J_i, and a turn of the body by phi moves what it sees by -phi x. A normal that
 * turns by dn takes the frame with it: dt_i = -(t_i.dn) n, dn = sum (t_i.dn) t_i.
 */
#include "collide/collide_columns.h"

#include "base/tolerances.h"
#include "collide/collide_variation.h"

/* One body, in its axes. */
typedef struct side {
    const impact_collider *given;
    imp_real sign, inverse_mass, inverse_j[3], rho2; /* rho2: the mean moment over the mass */
    imp_vec axis[3], offset, arm[3];                 /* arm: of t1, t2, n */
    imp_vec velocity, omega;                         /* world */
    bool moves;
} side;

typedef struct situation {
    side side[2];
    imp_vec e[3];
    imp_real M[3][3], u[3], P[3]; /* in the frame; u before */
    imp_real unit, speed, scale;  /* of impulse and velocity in the variation; M_zz */
    imp_variation variation;
} situation;

/* What one number's relative change does before friction and restitution answer. */
typedef struct change {
    imp_real M[3][3], u[3], frame[2], mu, eps;      /* frame: dn along t1, t2 */
    imp_real mass[2], inertia[2][3];                /* relative */
    imp_vec velocity[2], omega[2], arm[2], turn[2]; /* velocities: world; the offset's change and the turn: axes */
} change;

static inline imp_real component(imp_vec v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }
static inline imp_vec unit_vector(int i) { return (imp_vec){i == 0, i == 1, i == 2}; }
static inline imp_vec local_of(const side *b, imp_vec v)
{
    return (imp_vec){imp_vec_dot(b->axis[0], v), imp_vec_dot(b->axis[1], v), imp_vec_dot(b->axis[2], v)};
}
static inline imp_vec weighed(const side *b, imp_vec v)
{
    return (imp_vec){v.x * b->inverse_j[0], v.y * b->inverse_j[1], v.z * b->inverse_j[2]};
}

/* ---- what the data change ---- */

/* M's change where each body's arms change by db[i], i = t1, t2, n. */
static void add_arms(const side *b, const imp_vec db[3], change *c)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            c->M[i][k] += imp_vec_dot(db[i], weighed(b, b->arm[k])) + imp_vec_dot(weighed(b, b->arm[i]), db[k]);
}

/* u's change where a body's point of contact moves by dv, world. */
static void add_velocity(const situation *s, const side *b, imp_vec dv, change *c)
{
    for (int i = 0; i < 3; i++) c->u[i] += b->sign * imp_vec_dot(s->e[i], dv);
}

static void change_mass(const situation *s, int body, change *c)
{
    c->mass[body] = 1;
    for (int i = 0; i < 3; i++) c->M[i][i] -= s->side[body].inverse_mass;
}

static void change_moment(const situation *s, int body, int k, change *c)
{
    const side *b = &s->side[body];
    c->inertia[body][k] = 1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) c->M[i][j] -= component(b->arm[i], k) * component(b->arm[j], k) * b->inverse_j[k];
}

static void change_offset(const situation *s, int body, imp_vec dr, change *c)
{
    const side *b = &s->side[body];
    imp_vec db[3];
    c->arm[body] = local_of(b, dr);
    for (int i = 0; i < 3; i++) db[i] = imp_vec_cross(c->arm[body], local_of(b, s->e[i]));
    add_arms(b, db, c);
    add_velocity(s, b, imp_vec_cross(b->omega, dr), c);
}

/* The quaternion's change dq = h q turns the body by twice h's vector part over |q|^2. */
static void change_orientation(const situation *s, int body, int k, change *c)
{
    const side *b = &s->side[body];
    const quat q = b->given->orientation;
    const imp_vec v = {q.x, q.y, q.z};
    const imp_real w = q.w, d = k == 0 ? w : component(v, k - 1), n2 = w * w + imp_vec_dot(v, v);
    /* (dq q*) of dq = d on entry k */
    const imp_vec e = k == 0 ? (imp_vec){0, 0, 0} : unit_vector(k - 1);
    const imp_vec h = k == 0 ? imp_vec_neg(v) : imp_vec_axpy(w, e, imp_vec_neg(imp_vec_cross(e, v)));
    imp_vec db[3];
    c->turn[body] = local_of(b, imp_vec_scale(h, 2 * d / n2));
    for (int i = 0; i < 3; i++) db[i] = imp_vec_cross(b->arm[i], c->turn[body]);
    add_arms(b, db, c);
}

static void change_normal(const situation *s, imp_vec given, int k, change *c)
{
    const imp_real size = imp_sqrt(imp_vec_dot(given, given)), d = component(given, k) / size;
    const imp_real x = d * component(s->e[0], k), y = d * component(s->e[1], k);
    const imp_real rate[3][3] = {{0, 0, -x}, {0, 0, -y}, {x, y, 0}}; /* de_i along e_j */
    c->frame[0] = x;
    c->frame[1] = y;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            c->u[i] += rate[i][j] * s->u[j];
            for (int l = 0; l < 3; l++) c->M[i][j] += rate[i][l] * s->M[l][j] + rate[j][l] * s->M[l][i];
        }
}

enum { OF_BODY = 17, DATA = 2 * OF_BODY + 5 };

static void change_body(const situation *s, int body, int k, change *c)
{
    const side *b = &s->side[body];
    if (k < 9) {
        const int i = k % 3;
        const imp_vec given = imp_vec_of(k < 3 ? b->given->offset : k < 6 ? b->given->velocity : b->given->omega);
        const imp_vec d = imp_vec_scale(unit_vector(i), component(given, i));
        if (k < 3) change_offset(s, body, d, c);
        if (k >= 3) *(k < 6 ? &c->velocity[body] : &c->omega[body]) = d;
        if (k >= 3) add_velocity(s, b, k < 6 ? d : imp_vec_cross(d, imp_vec_of(b->given->offset)), c);
    } else if (b->moves) {
        if (k == 9) change_mass(s, body, c);
        if (k >= 10 && k < 13) change_moment(s, body, k - 10, c);
        if (k >= 13) change_orientation(s, body, k - 13, c);
    }
}

/* Number k of the data. */
static change change_of(const situation *s, const impact_collision *given, int k)
{
    change c = {0};
    if (k < 2 * OF_BODY)
        change_body(s, k / OF_BODY, k % OF_BODY, &c);
    else if (k < 2 * OF_BODY + 3)
        change_normal(s, imp_vec_of(given->normal), k - 2 * OF_BODY, &c);
    else if (k == 2 * OF_BODY + 3)
        c.mu = given->friction;
    else
        c.eps = given->restitution;
    return c;
}

/* ---- what the impact answers ---- */

static imp_vec in_frame(const situation *s, const imp_real x[3])
{
    return imp_vec_axpy(x[0], s->e[0], imp_vec_axpy(x[1], s->e[1], imp_vec_scale(s->e[2], x[2])));
}

/* The impulse's change, world. */
static imp_vec impulse_change(const situation *s, const change *c)
{
    const imp_real f = 1 / s->scale, v = 1 / s->speed;
    const imp_real of[IMP_PARAMETERS] = {c->M[0][0] * f, c->M[1][1] * f, c->M[2][2] * f, c->M[0][1] * f,
                                         c->M[0][2] * f, c->M[1][2] * f, c->u[0] * v,    c->u[1] * v,
                                         c->u[2] * v,    c->mu,          c->eps};
    const imp_real x = c->frame[0], y = c->frame[1], *P = s->P;
    imp_real d[3] = {x * P[2], y * P[2], -x * P[0] - y * P[1]};
    for (int k = 0; k < IMP_PARAMETERS; k++)
        for (int i = 0; i < 3; i++) d[i] += s->unit * s->variation.by[k][i] * of[k];
    return in_frame(s, d);
}

/* |dV|^2 + rho^2 |dW|^2 of a body that moves. */
static imp_real moved2(const situation *s, const change *c, imp_vec dP, int body)
{
    const side *b = &s->side[body];
    const imp_vec P = in_frame(s, s->P), arm = imp_vec_cross(b->offset, local_of(b, P)), turn = c->turn[body];
    if (!b->moves) return 0;
    const imp_vec dv = imp_vec_axpy(b->sign * b->inverse_mass, imp_vec_axpy(-c->mass[body], P, dP), c->velocity[body]);
    /* db = dr x P + r x dP - phi x (r x P) */
    imp_vec db = imp_vec_axpy(1, imp_vec_cross(b->offset, local_of(b, dP)),
                              imp_vec_axpy(1, imp_vec_cross(c->arm[body], local_of(b, P)), imp_vec_cross(arm, turn)));
    const imp_real *j = c->inertia[body];
    db = (imp_vec){db.x - j[0] * arm.x, db.y - j[1] * arm.y, db.z - j[2] * arm.z};
    const imp_vec spin = imp_vec_axpy(1, weighed(b, db), imp_vec_cross(turn, weighed(b, arm)));
    const imp_vec dw = imp_vec_axpy(b->sign, spin, local_of(b, c->omega[body]));
    return imp_vec_dot(dv, dv) + b->rho2 * imp_vec_dot(dw, dw);
}

/* ---- the impact ---- */

/* The axes of a body of three equal moments, which the impact itself does not ask for: its moments may change apart. */
static void own_axes(quat given, imp_vec axis[3])
{
    const imp_real w = given.w, x = given.x, y = given.y, z = given.z, f = 2 / (w * w + x * x + y * y + z * z);
    axis[0] = (imp_vec){1 - f * (y * y + z * z), f * (x * y + w * z), f * (x * z - w * y)};
    axis[1] = (imp_vec){f * (x * y - w * z), 1 - f * (x * x + z * z), f * (y * z + w * x)};
    axis[2] = (imp_vec){f * (x * z + w * y), f * (y * z - w * x), 1 - f * (x * x + y * y)};
}

static void make_side(const imp_ready *ready, const impact_collision *c, int i, const imp_frame *frame, side *b)
{
    b->given = &c->body[i];
    b->sign = i == 0 ? 1 : -1;
    b->moves = ready->mass[i] > 0;
    b->inverse_mass = ready->inverse_mass[i];
    b->rho2 = (ready->moments.x[i] + ready->moments.y[i] + ready->moments.z[i]) / 3 * b->inverse_mass;
    b->inverse_j[0] = ready->inverse_moments.x[i];
    b->inverse_j[1] = ready->inverse_moments.y[i];
    b->inverse_j[2] = ready->inverse_moments.z[i];
    for (int k = 0; k < 3; k++) b->axis[k] = imp_vectors_at(&ready->axis[k], i);
    b->offset = imp_vectors_at(&ready->offset, i);
    if (b->moves && b->inverse_j[0] == b->inverse_j[1] && b->inverse_j[1] == b->inverse_j[2]) {
        own_axes(b->given->orientation, b->axis);
        b->offset = local_of(b, imp_vectors_at(&ready->arm, i));
    }
    b->omega = imp_vectors_at(&ready->omega, i);
    b->arm[0] = imp_vec_cross(b->offset, local_of(b, frame->t1));
    b->arm[1] = imp_vec_cross(b->offset, local_of(b, frame->t2));
    b->arm[2] = imp_vec_cross(b->offset, local_of(b, frame->n));
}

static void make_situation(const imp_ready *ready, const impact_collision *c, const imp_frame *frame, imp_vec u,
                           situation *s)
{
    const imp_real f = frame->scale, M[3][3] = {{frame->a * f, 0, frame->c * f},
                                                {0, frame->b * f, frame->d * f},
                                                {frame->c * f, frame->d * f, f}};
    s->e[0] = frame->t1;
    s->e[1] = frame->t2;
    s->e[2] = frame->n;
    s->scale = f;
    for (int i = 0; i < 2; i++) make_side(ready, c, i, frame, &s->side[i]);
    for (int i = 0; i < 3; i++) {
        s->u[i] = imp_vec_dot(u, s->e[i]);
        for (int k = 0; k < 3; k++) s->M[i][k] = M[i][k];
    }
    s->speed = -s->u[2];
    s->unit = s->speed / f;
}

/* u_t that is rounding of the velocities given is none, as where the impact was solved. */
static imp_real slip_of(const imp_ready *ready, imp_real x, imp_real y)
{
    const imp_lanes each =
        imp_vectors_size(&ready->velocity) + imp_vectors_size(&ready->omega) * imp_vectors_size(&ready->arm);
    const imp_real s = imp_sqrt(x * x + y * y);
    return s > DBL_MIN + IMP_COLLIDE_STANDS * (each[0] + each[1]) ? s : 0;
}

/* False: not followed. */
static bool vary(situation *s, const imp_ready *ready, const imp_frame *frame, const impact_collision *c,
                 const impact_outcome *o)
{
    imp_course start;
    imp_real reached[IMPACT_MAX_PHASES];
    const bool slides = slip_of(ready, s->u[0], s->u[1]) > 0;
    imp_course_start(&start, frame, c, slides ? s->u[0] / s->speed : 0, slides ? s->u[1] / s->speed : 0);
    for (int i = 0; i < o->phase_count; i++)
        reached[i] = imp_vec_dot(imp_vec_of(o->phase_impulse[i]), frame->n) / s->unit;
    if (!imp_variation_make(&start, o->phases, reached, o->phase_count, &s->variation)) return false;
    for (int i = 0; i < 3; i++) s->P[i] = s->variation.P[i] * s->unit;
    return true;
}

/* sum of |V|^2 + rho^2 |W|^2, of each column and of the answer itself. */
static imp_real all_columns2(const situation *s, const impact_collision *given)
{
    imp_real sum = 0;
    for (int k = 0; k < DATA; k++) {
        const change c = change_of(s, given, k);
        const imp_vec dP = impulse_change(s, &c);
        sum += moved2(s, &c, dP, 0) + moved2(s, &c, dP, 1);
    }
    return sum;
}

static imp_real answer2(const situation *s, const impact_outcome *o)
{
    imp_real sum = 0;
    for (int i = 0; i < 2; i++) {
        const imp_vec v = imp_vec_of(o->velocity[i]), w = imp_vec_of(o->omega[i]);
        if (s->side[i].moves) sum += imp_vec_dot(v, v) + s->side[i].rho2 * imp_vec_dot(w, w);
    }
    return sum;
}

double imp_columns_sensitivity(const impact_collision *collision, const impact_outcome *outcome)
{
    imp_ready ready;
    imp_frame frame;
    situation s;
    imp_ready_make(collision, &ready);
    imp_frame_principal(imp_frame_normal(collision), &ready, &frame);
    make_situation(&ready, collision, &frame, imp_ready_velocity(&ready), &s);
    if (outcome->phase_count == IMPACT_MAX_PHASES || !(s.speed > 0) || !vary(&s, &ready, &frame, collision, outcome))
        return NAN;
    if (s.variation.tied) return INFINITY;
    const imp_real sum = all_columns2(&s, collision);
    return sum == 0 ? 0 : (double)imp_sqrt(sum / answer2(&s, outcome));
}
