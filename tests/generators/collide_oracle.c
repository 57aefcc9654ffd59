/* SPDX-License-Identifier: MIT */
#include "collide_oracle.h"

#include <string.h>
#include "collide_oracle_arc.h"

/* ---- M and the frame ---- */

typedef struct problem {
    real axis[3][3]; /* rows t1, t2, n */
    slip f;          /* M in that frame, friction and velocity */
    real k, eps;     /* k = m - c^2/a - d^2/b */
    impact_law law;
} problem;

static void cross(const real *a, const real *b, real *out)
{
    const real x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    out[0] = x, out[1] = y, out[2] = z;
}

static real dot(const real *a, const real *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static void read3(qvec3 v, real *out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

/* J^-1 v, world. */
static void turn_inertia(const impact_collider *body, const real *v, real *out)
{
    real w = body->orientation.w, x = body->orientation.x, y = body->orientation.y, z = body->orientation.z;
    const real n = sqrtq(w * w + x * x + y * y + z * z);
    w /= n, x /= n, y /= n, z /= n;
    const real r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    const real j[3] = {body->moments.x, body->moments.y, body->moments.z};
    real local[3];
    for (int i = 0; i < 3; i++) local[i] = (r[0][i] * v[0] + r[1][i] * v[1] + r[2][i] * v[2]) / j[i];
    for (int i = 0; i < 3; i++) out[i] = r[i][0] * local[0] + r[i][1] * local[1] + r[i][2] * local[2];
}

static void apply_M(const impact_collision *collision, const real *f, real *out)
{
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &collision->body[i];
        if (isinf(body->mass)) continue;
        real r[3], t[3], l[3];
        read3(body->offset, r);
        cross(r, f, t);
        turn_inertia(body, t, l);
        cross(l, r, t);
        for (int j = 0; j < 3; j++) out[j] += f[j] / body->mass + t[j];
    }
}

static void make_problem(const impact_collision *collision, problem *pr)
{
    real n[3], t1[3], t2[3], mf[3];
    read3(collision->normal, n);
    const real length = sqrtq(dot(n, n));
    for (int i = 0; i < 3; i++) n[i] /= length;
    const real e[3] = {fabsq(n[0]) < 0.6Q, fabsq(n[0]) >= 0.6Q, 0};
    cross(n, e, t1);
    const real l1 = sqrtq(dot(t1, t1));
    for (int i = 0; i < 3; i++) t1[i] /= l1;
    cross(n, t1, t2);
    apply_M(collision, t1, mf);
    const real xx = dot(t1, mf), xy = dot(t2, mf);
    apply_M(collision, t2, mf);
    const real yy = dot(t2, mf), angle = atan2q(2 * xy, xx - yy) / 2, cs = cosq(angle), sn = sinq(angle);
    for (int i = 0; i < 3; i++) {
        pr->axis[X][i] = cs * t1[i] + sn * t2[i];
        pr->axis[Y][i] = -sn * t1[i] + cs * t2[i];
        pr->axis[N][i] = n[i];
    }
    apply_M(collision, pr->axis[X], mf);
    pr->f.a = dot(pr->axis[X], mf);
    pr->f.c = dot(pr->axis[N], mf);
    apply_M(collision, pr->axis[Y], mf);
    pr->f.b = dot(pr->axis[Y], mf);
    pr->f.d = dot(pr->axis[N], mf);
    apply_M(collision, pr->axis[N], mf);
    pr->f.m = dot(pr->axis[N], mf);
    pr->k = pr->f.m - pr->f.c * pr->f.c / pr->f.a - pr->f.d * pr->f.d / pr->f.b;
    pr->f.mu = collision->friction;
    pr->eps = collision->restitution;
    pr->law = collision->law;
    real u[3] = {0, 0, 0};
    for (int i = 0; i < 2; i++) {
        real v[3], w[3], r[3], t[3];
        read3(collision->body[i].velocity, v);
        read3(collision->body[i].omega, w);
        read3(collision->body[i].offset, r);
        cross(w, r, t);
        for (int j = 0; j < 3; j++) u[j] += (i == 0 ? 1 : -1) * (v[j] + t[j]);
    }
    for (int i = 0; i < 3; i++) pr->f.u[i] = dot(pr->axis[i], u);
}

/* ---- the impact ---- */

typedef struct state {
    real u[3], P[3];     /* at this moment */
    real work, friction; /* so far, of normal impulse and of friction */
    real rate, climb;    /* on the arc: dp/dx and du_z/dp */
} state;

typedef struct run {
    problem pr;
    arc ar;
    state now;
    real p_c, p_r, work_c, work_r, low;
    bool compressing, ended, jammed;
    int compressions;
} run;

static real half_form(const problem *pr, const real *u) /* u' M^-1 u / 2 */
{
    const slip *f = &pr->f;
    const real rest = u[N] - f->c / f->a * u[X] - f->d / f->b * u[Y];
    return (u[X] * u[X] / f->a + u[Y] * u[Y] / f->b + rest * rest / pr->k) / 2;
}

/* The state that has u_t and p, and friction's work so far. */
static void complete(const run *rn, state *st)
{
    const slip *f = &rn->pr.f;
    st->P[X] = (st->u[X] - f->u[X] - f->c * st->P[N]) / f->a;
    st->P[Y] = (st->u[Y] - f->u[Y] - f->d * st->P[N]) / f->b;
    st->u[N] = f->u[N] + f->c * st->P[X] + f->d * st->P[Y] + f->m * st->P[N];
    st->work = half_form(&rn->pr, st->u) - half_form(&rn->pr, f->u) - st->friction;
}

static void book(run *rn, state st)
{
    const real dp = st.P[N] - rn->now.P[N], work = st.work - rn->now.work;
    if (rn->compressing)
        rn->p_c += dp, rn->work_c += work, rn->low = fminq(rn->low, st.work);
    else
        rn->p_r += dp, rn->work_r += work;
    rn->jammed = rn->jammed || (rn->compressing && st.u[N] < rn->now.u[N]);
    rn->now = st;
}

static void turn(run *rn)
{
    rn->compressing = !rn->compressing;
    rn->compressions += rn->compressing;
}

/* > 0 once the impact is over. */
static real over(const run *rn, const state *st)
{
    switch (rn->pr.law) {
    case IMPACT_POISSON: return rn->p_r + st->P[N] - rn->now.P[N] - rn->pr.eps * rn->p_c;
    case IMPACT_NEWTON: return st->u[N] + rn->pr.eps * rn->pr.f.u[N];
    case IMPACT_STRONGE: return st->work - (1 - rn->pr.eps * rn->pr.eps) * rn->low;
    }
    return 0;
}

/* ---- slip that turns ---- */

static state arc_state(const run *rn, real x)
{
    const slip *f = &rn->pr.f;
    const arc_place at = arc_at(&rn->ar, x);
    const real cs = cosq(at.theta), sn = sinq(at.theta);
    state st = {.u = {at.s * cs, at.s * sn}, .P = {0, 0, at.p}, .friction = -f->mu * at.ss};
    st.rate = at.rate;
    st.climb = f->m - f->mu * (f->c * cs + f->d * sn);
    complete(rn, &st);
    return st;
}

/* u_t = 0 at the end of the arc. */
static state end_state(const run *rn)
{
    const arc_edge last = rn->ar.edge[rn->ar.edges - 1];
    state st = {.P = {0, 0, last.p}, .friction = -rn->pr.f.mu * last.ss};
    complete(rn, &st);
    return st;
}

typedef enum sought { COMPRESSED, TURNED, OVER } sought;

static real measure(const run *rn, sought what, const state *st, real *slope)
{
    *slope = st->climb * st->rate;
    switch (what) {
    case COMPRESSED: return st->u[N];
    case TURNED: *slope = -*slope; return -st->u[N];
    case OVER:
        if (rn->pr.law == IMPACT_POISSON) *slope = st->rate;
        if (rn->pr.law == IMPACT_STRONGE) *slope = st->u[N] * st->rate;
        return over(rn, st);
    }
    return 0;
}

/* Newton's step in the variable that the measure is nearly linear in: the way, or the power of what is left that s goes
 * with. */
static real step_of(const arc *ar, real x, real value, real slope)
{
    const real by = value / slope, g = ar->gamma_end;
    if (x < 0) return log1pq(fmaxq(-by, -0.999Q));
    return g > 0 ? -log1pq(fmaxq(g * by, -0.999Q)) / g : -by;
}

/* The place between x1 and x2 where the measure comes up from below to 0, by Newton's method in a bracket. */
static state find(const run *rn, sought what, real x1, real x2, real *place)
{
    real slope, x;
    state st;
    while (
        arc_edge_between(&rn->ar, x1, x2, &x)) { /* to within one panel first: the integrals to its edges are known */
        st = arc_state(rn, x);
        if (measure(rn, what, &st, &slope) < 0)
            x1 = x;
        else
            x2 = x;
    }
    x = (x1 + x2) / 2;
    for (int i = 0; i < 300; i++) {
        st = arc_state(rn, x);
        const real value = measure(rn, what, &st, &slope);
        if (value < 0)
            x1 = x;
        else
            x2 = x;
        const real step = step_of(&rn->ar, x, value, slope), next = x + step;
        if (fabsq(step) < 1e-28Q * fmaxq(1, fabsq(x)) || x2 - x1 < 1e-30Q * fmaxq(1, fabsq(x))) break;
        x = next > x1 && next < x2 && i % 12 != 11 ? next : (x1 + x2) / 2;
    }
    *place = x;
    return st;
}

/* From x1 to x2 (u_z monotone between) through whatever happens there; at_end: x2 is where nothing is left. */
static void piece(run *rn, real x1, real x2, bool at_end)
{
    const state last = at_end ? end_state(rn) : arc_state(rn, x2);
    for (int i = 0; i < 8 && !rn->ended; i++) {
        if (rn->compressing) {
            if (last.u[N] < 0 || last.u[N] < rn->now.u[N]) {
                book(rn, last);
                return;
            }
            book(rn, find(rn, COMPRESSED, x1, x2, &x1));
            turn(rn);
            continue;
        }
        const bool turns = last.u[N] < 0 && last.u[N] < rn->now.u[N];
        real to = x2;
        const state there = turns ? find(rn, TURNED, x1, x2, &to) : last;
        if (over(rn, &there) >= 0) {
            book(rn, find(rn, OVER, x1, to, &to));
            rn->ended = true;
            return;
        }
        book(rn, there);
        if (!turns) return;
        x1 = to;
        turn(rn);
    }
}

/* The places where u_z turns, Z = m - mu (c cos + d sin) = 0, in order; how many. */
static int find_stops(const run *rn, real stops[2])
{
    const slip *f = &rn->pr.f;
    const arc *ar = &rn->ar;
    const real pull = f->mu * hypotq(f->c, f->d);
    int count = 0;
    if (pull <= f->m) return 0;
    for (int i = 0; i < 2; i++) {
        const real theta = atan2q(f->d, f->c) + (i ? 1 : -1) * acosq(f->m / pull);
        const real way = arc_wrapped(ar->sign * (theta - ar->theta0));
        if (way > 0 && way < ar->span) stops[count++] = arc_place_of(ar, way);
    }
    if (count == 2 && stops[0] > stops[1]) {
        const real swap = stops[0];
        stops[0] = stops[1], stops[1] = swap;
    }
    return count;
}

/* False: the arc is too long for the table. */
static bool follow_arc(run *rn)
{
    arc *ar = &rn->ar;
    real stops[2], x = ar->edge[0].x;
    const int count = find_stops(rn, stops);
    for (int i = 0; i < count && !rn->ended; i++) {
        if (!arc_extend(ar, stops[i])) return false;
        const real most = ar->edge[ar->edges - 1].x;
        if (stops[i] <= x || stops[i] >= most) continue;
        piece(rn, x, stops[i], false);
        x = stops[i];
    }
    while (!rn->ended) {
        const bool stops_there = ar->gamma_end > 0;
        const real next = stops_there ? INFINITY : fmaxq(fmaxq(x, -20) + 4, 1.5Q * x);
        if (!stops_there && next > 1e15Q) return false;
        if (!arc_extend(ar, next)) return false;
        piece(rn, x, stops_there ? ar->edge[ar->edges - 1].x : next, stops_there);
        if (stops_there) break;
        x = next;
    }
    return true;
}

/* ---- straight pieces ---- */

/* du_t/dp = (x, y), du_z/dp = Z, friction against the sliding when it rubs. */
typedef struct line {
    real x, y, Z;
    bool rubs;
} line;

/* p left until the impact is over on this line; INFINITY: never. */
static real left_on(const run *rn, const line *ln)
{
    const real uz = rn->now.u[N], eps = rn->pr.eps;
    real more;
    switch (rn->pr.law) {
    case IMPACT_POISSON: return fmaxq(eps * rn->p_c - rn->p_r, 0);
    case IMPACT_NEWTON:
        more = -eps * rn->pr.f.u[N] - uz;
        return more <= 0 ? 0 : ln->Z > 0 ? more / ln->Z : (real)INFINITY;
    case IMPACT_STRONGE:
        more = (1 - eps * eps) * rn->low - rn->now.work;
        if (more <= 0) return 0;
        if (uz * uz + 2 * ln->Z * more < 0) return INFINITY;
        return 2 * more / (uz + sqrtq(uz * uz + 2 * ln->Z * more));
    }
    return 0;
}

/* Follows the line for at most `room` of p. */
static void follow_line(run *rn, const line *ln, real room)
{
    while (!rn->ended) {
        const real zero = rn->compressing == (ln->Z > 0) && ln->Z != 0 ? -rn->now.u[N] / ln->Z : (real)INFINITY;
        const real end = rn->compressing ? (real)INFINITY : left_on(rn, ln), dp = fminq(room, fminq(zero, end));
        state st = rn->now;
        st.P[N] += dp;
        st.u[X] += ln->x * dp;
        st.u[Y] += ln->y * dp;
        if (ln->rubs)
            st.friction -= rn->pr.f.mu * dp * (hypotq(st.u[X], st.u[Y]) + hypotq(rn->now.u[X], rn->now.u[Y])) / 2;
        complete(rn, &st);
        book(rn, st);
        if (dp == end)
            rn->ended = true;
        else if (dp == zero)
            turn(rn);
        else
            return;
        room -= dp;
    }
}

/* Sliding in the direction (x, y), which does not turn, to the end of the impact or to u_t = 0. */
static void slide(run *rn)
{
    const slip *f = &rn->pr.f;
    const real s = hypotq(f->u[X], f->u[Y]), x = f->u[X] / s, y = f->u[Y] / s, along = f->c * x + f->d * y;
    const real R = along - f->mu * (f->a * x * x + f->b * y * y);
    const line ln = {R * x, R * y, f->m - f->mu * along, true};
    follow_line(rn, &ln, R < 0 ? s / -R : (real)INFINITY);
    if (rn->ended) return;
    rn->now.u[X] = rn->now.u[Y] = 0;
    complete(rn, &rn->now);
}

/* From u_t = 0 on; true when it slides. */
static bool from_rest(run *rn)
{
    const slip *f = &rn->pr.f;
    if (hypotq(f->c / f->a, f->d / f->b) <= f->mu) {
        follow_line(rn, &(line){0, 0, rn->pr.k, false}, INFINITY);
        return false;
    }
    /* |(mu M_tt + R)^-1 M_tz| = 1 by bisection. */
    real low = 0, high = hypotq(f->c, f->d);
    for (int i = 0; i < 120; i++) {
        const real R = (low + high) / 2;
        if (hypotq(f->c / (f->mu * f->a + R), f->d / (f->mu * f->b + R)) > 1)
            low = R;
        else
            high = R;
    }
    const real x = f->c / (f->mu * f->a + high), y = f->d / (f->mu * f->b + high);
    follow_line(rn, &(line){high * x, high * y, f->m - f->mu * (f->c * x + f->d * y), true}, INFINITY);
    return true;
}

/* ---- the door ---- */

static qvec3 write3(const real *v) { return (qvec3){(double)v[0], (double)v[1], (double)v[2]}; }

static void finish(const impact_collision *collision, const run *rn, oracle_outcome *outcome)
{
    real P[3];
    for (int i = 0; i < 3; i++)
        P[i] = rn->pr.axis[X][i] * rn->now.P[X] + rn->pr.axis[Y][i] * rn->now.P[Y] + rn->pr.axis[N][i] * rn->now.P[N];
    outcome->impulse = write3(P);
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &collision->body[i];
        outcome->velocity[i] = body->velocity;
        outcome->omega[i] = body->omega;
        if (isinf(body->mass)) continue;
        const real sign = i == 0 ? 1 : -1;
        real v[3], w[3], r[3], t[3], l[3];
        read3(body->velocity, v);
        read3(body->omega, w);
        read3(body->offset, r);
        cross(r, P, t);
        turn_inertia(body, t, l);
        for (int j = 0; j < 3; j++) v[j] += sign * P[j] / body->mass, w[j] += sign * l[j];
        outcome->velocity[i] = write3(v);
        outcome->omega[i] = write3(w);
    }
    outcome->compression_impulse = (double)rn->p_c;
    outcome->work_compression = (double)rn->work_c;
    outcome->work_restitution = (double)rn->work_r;
    outcome->work_friction = (double)rn->now.friction;
    outcome->normal_after = (double)rn->now.u[N];
    outcome->compressions = rn->compressions;
}

/* False: outside of the oracle. */
static bool solve(run *rn, oracle_outcome *outcome)
{
    const slip *f = &rn->pr.f;
    if (f->mu == 0) {
        follow_line(rn, &(line){f->c, f->d, f->m, false}, INFINITY);
        return true;
    }
    if (hypotq(f->u[X], f->u[Y]) > 0) {
        if (arc_is_straight(f)) {
            slide(rn);
        } else {
            if (!arc_make(&rn->ar, f) || !follow_arc(rn)) return false;
            outcome->turned = (double)rn->ar.span;
        }
        outcome->stuck = !rn->ended;
    }
    if (!rn->ended) outcome->reversed = from_rest(rn) && outcome->stuck;
    return true;
}

bool oracle_collide(const impact_collision *collision, oracle_outcome *outcome)
{
    memset(outcome, 0, sizeof *outcome);
    run rn;
    memset(&rn, 0, sizeof rn);
    make_problem(collision, &rn.pr);
    rn.compressing = true;
    rn.compressions = 1;
    for (int i = 0; i < 3; i++) rn.now.u[i] = rn.pr.f.u[i];
    const bool solved = solve(&rn, outcome);
    arc_free(&rn.ar);
    outcome->jammed = rn.jammed;
    if (solved) finish(collision, &rn, outcome);
    return solved;
}
