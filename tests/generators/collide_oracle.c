/* SPDX-License-Identifier: MIT */
#include "collide_oracle.h"

#include <quadmath.h>
#include <string.h>

typedef __float128 real;
typedef __complex128 complex;

enum { X, Y, N };

/* ---- M and the frame ---- */

typedef struct problem {
    real axis[3][3];       /* rows t1, t2, n */
    real a, b, c, d, m, k; /* M in that frame; k = m - c^2/a - d^2/b */
    real mu, eps, u[3];
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
    pr->a = dot(pr->axis[X], mf);
    pr->c = dot(pr->axis[N], mf);
    apply_M(collision, pr->axis[Y], mf);
    pr->b = dot(pr->axis[Y], mf);
    pr->d = dot(pr->axis[N], mf);
    apply_M(collision, pr->axis[N], mf);
    pr->m = dot(pr->axis[N], mf);
    pr->k = pr->m - pr->c * pr->c / pr->a - pr->d * pr->d / pr->b;
    pr->mu = collision->friction;
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
    for (int i = 0; i < 3; i++) pr->u[i] = dot(pr->axis[i], u);
}

/* ---- the hodograph ---- */

typedef struct arc {
    const problem *pr;
    complex root[4], gamma[4];
    real theta0, sign;      /* theta runs from theta0 in the sense of sign */
    real span;              /* to the direction where it ends */
    int end;                /* that root */
    real gamma_end, s0, T0; /* T0 > 0: |T| at theta0 */
    complex log_s0, log_T0; /* sums over the roots of gamma log sin and of log sin, at theta0 */
} arc;

static complex T_of(const problem *pr, complex t)
{
    return -pr->c * csinq(t) + pr->d * ccosq(t) + pr->mu * (pr->a - pr->b) * ccosq(t) * csinq(t);
}
static complex T_slope(const problem *pr, complex t)
{
    return -pr->c * ccosq(t) - pr->d * csinq(t) + pr->mu * (pr->a - pr->b) * ccosq(2 * t);
}
static complex R_of(const problem *pr, complex t)
{
    const complex x = ccosq(t), y = csinq(t);
    return pr->c * x + pr->d * y - pr->mu * (pr->a * x * x + pr->b * y * y);
}

/* h z^4 + (id - c) z^3 + (c + id) z - h = 0 by Aberth's method, then Newton on T itself. */
static bool find_roots(arc *ar)
{
    const problem *pr = ar->pr;
    const real h = pr->mu * (pr->a - pr->b) / 2;
    if (fabsq(h) < 1e-12Q * (fabsq(pr->c) + fabsq(pr->d))) return false;
    const complex i = 1.0iQ, p3 = i * pr->d - pr->c, p1 = pr->c + i * pr->d;
    complex z[4] = {1.1Q + 0.3iQ, -0.4Q + 0.9iQ, -0.8Q - 0.5iQ, 0.5Q - 1.2iQ};
    for (int sweep = 0; sweep < 500; sweep++) {
        real moved = 0;
        for (int n = 0; n < 4; n++) {
            const complex f = ((h * z[n] + p3) * z[n] * z[n] + p1) * z[n] - h;
            const complex g = (4 * h * z[n] + 3 * p3) * z[n] * z[n] + p1;
            complex sum = 0;
            for (int j = 0; j < 4; j++)
                if (j != n) sum += 1 / (z[n] - z[j]);
            const complex newton = f / g, step = newton / (1 - newton * sum);
            z[n] -= step;
            moved = fmaxq(moved, cabsq(step) / cabsq(z[n]));
        }
        if (moved < 1e-32Q) break;
    }
    for (int n = 0; n < 4; n++) {
        complex t = -i * clogq(z[n]);
        for (int j = 0; j < 3; j++) t -= T_of(pr, t) / T_slope(pr, t);
        if (fabsq(cimagq(t)) < 1e-24Q) t = crealq(t);
        ar->root[n] = t;
        ar->gamma[n] = R_of(pr, t) / T_slope(pr, t);
    }
    for (int n = 0; n < 4; n++)
        for (int j = 0; j < n; j++)
            if (cabsq(ar->root[n] - ar->root[j]) < 1e-6Q) return false;
    return true;
}

static real wrapped(real angle) /* into (0, 2 pi) */
{
    const real turn = 2 * M_PIq;
    return angle - turn * floorq(angle / turn);
}

/* A place on the arc: `way` from theta0 and `left` to the end, both exact near their own end. */
typedef struct place {
    real way, left;
} place;

/* log |sin((theta - root) / 2)|, with its argument when the root is not real. */
static complex log_sine(const arc *ar, int n, place at)
{
    const complex root = ar->root[n];
    if (n == ar->end) return logq(sinq(at.left / 2));
    const real A = (ar->theta0 - crealq(root) + ar->sign * at.way) / 2, B = -cimagq(root) / 2;
    if (B == 0) return logq(fabsq(sinq(A)));
    /* log sin(A + iB), its argument followed continuously in A. */
    const real argument = (B > 0 ? -1 : 1) * floorq(A / M_PIq) * M_PIq + atanq(tanhq(B) / tanq(A));
    const real size = sinq(A) * sinq(A) + sinhq(B) * sinhq(B);
    return logq(size) / 2 + 1.0iQ * argument;
}

static bool make_arc(arc *ar, const problem *pr)
{
    memset(ar, 0, sizeof *ar);
    ar->pr = pr;
    ar->s0 = hypotq(pr->u[X], pr->u[Y]);
    ar->theta0 = atan2q(pr->u[Y], pr->u[X]);
    const real T0 = crealq(T_of(pr, ar->theta0));
    /* On an invariant direction (a planar impact) the arc has no length. */
    const real size = fabsq(pr->c) + fabsq(pr->d) + pr->mu * (pr->a + pr->b);
    if (fabsq(T0) < 1e-20Q * size || !find_roots(ar)) return false;
    ar->sign = T0 > 0 ? 1 : -1;
    ar->span = 10;
    for (int n = 0; n < 4; n++) {
        if (cimagq(ar->root[n]) != 0) continue;
        const real way = wrapped(ar->sign * (crealq(ar->root[n]) - ar->theta0));
        if (way < ar->span) ar->span = way, ar->end = n;
    }
    ar->T0 = fabsq(T0);
    ar->gamma_end = crealq(ar->gamma[ar->end]);
    for (int n = 0; n < 4; n++) {
        const complex log_sin = log_sine(ar, n, (place){0, ar->span});
        ar->log_s0 += ar->gamma[n] * log_sin;
        ar->log_T0 += log_sin;
    }
    return true;
}

/* s and |T| at a place. */
static void look(const arc *ar, place at, real *s, real *T)
{
    complex log_s = -ar->log_s0, log_T = -ar->log_T0;
    for (int n = 0; n < 4; n++) {
        const complex log_sin = log_sine(ar, n, at);
        log_s += ar->gamma[n] * log_sin;
        log_T += log_sin;
    }
    *s = ar->s0 * expq(crealq(log_s));
    *T = ar->T0 * expq(crealq(log_T));
}

/* The variable of integration: q = left^power, from q_from at theta0 down to q_to. */
typedef struct range {
    real power, q_from, q_to;
} range;

/* dp and s dp of one node of tanh-sinh, at x, without the step. */
static bool node(const arc *ar, const range *rg, real x, real *p, real *ss)
{
    const real length = rg->q_from - rg->q_to, e = M_PI_2q * sinhq(x);
    /* Shares of the length that are left and done, each exact near its own end. */
    const real part = 1 / (1 + expq(2 * e)), done = 1 / (1 + expq(-2 * e));
    const real q = rg->q_to + length * part;
    place now = {0, rg->power == 1 ? q : powq(q, 1 / rg->power)};
    now.way = done < 0.5Q ? -ar->span * expm1q(log1pq(-length * done / rg->q_from) / rg->power) : ar->span - now.left;
    if (!(now.left > 0 && now.way > 0)) return false;
    real s, T;
    look(ar, now, &s, &T);
    *p = length * M_PI_2q * coshq(x) * 2 * part * done * s / T;
    if (rg->power != 1) *p *= now.left / (rg->power * q);
    *ss = *p * s;
    return finiteq(*p) && finiteq(*ss);
}

/* int from theta0 to `at` of s/T and of s^2/T, by tanh-sinh (Takahasi & Mori 1974); at.left = 0 is the end itself (gamma_end > 0). */
static void integrate(const arc *ar, place at, real *p, real *ss)
{
    *p = *ss = 0;
    if (at.way <= 0) return;
    /* Near a weak end the integrand goes like left^(gamma - 1): take q = left^gamma as the variable. */
    const real g = ar->gamma_end, power = g > 0 && g < 1 ? g : 1;
    const range rg = {power, powq(ar->span, power), at.left > 0 ? powq(at.left, power) : 0};
    real sum_p = 0, sum_ss = 0;
    for (int level = 0; level < 9; level++) {
        const real h = 0.5Q / (1 << level), last_p = *p, last_ss = *ss;
        for (int side = -1; side <= 1; side += 2)
            for (int j = level == 0 ? side == 1 : 1, small = 0; j * h < 6.5Q && small < 3; j += level == 0 ? 1 : 2) {
                real dp, dss;
                if (!node(ar, &rg, side * j * h, &dp, &dss)) break;
                sum_p += dp;
                sum_ss += dss;
                /* Only the far ends may be cut off: the integrand need not be largest in the middle. */
                small = j * h > 3 && dp <= 1e-25Q * sum_p && dss <= 1e-25Q * sum_ss ? small + 1 : 0;
            }
        *p = sum_p * h;
        *ss = sum_ss * h;
        /* The error is about squared from level to level. */
        if (level > 1 && fabsq(*p - last_p) <= 1e-14Q * *p && fabsq(*ss - last_ss) <= 1e-14Q * *ss) break;
    }
}

/* ---- the impact ---- */

typedef struct state {
    real u[3], P[3];     /* at this moment */
    real work, friction; /* so far, of normal impulse and of friction */
} state;

typedef struct run {
    problem pr;
    arc ar;
    state now;
    real p_c, p_r, work_c, work_r, low;
    bool compressing, ended;
    int compressions;
} run;

static real half_form(const problem *pr, const real *u) /* u' M^-1 u / 2 */
{
    const real rest = u[N] - pr->c / pr->a * u[X] - pr->d / pr->b * u[Y];
    return (u[X] * u[X] / pr->a + u[Y] * u[Y] / pr->b + rest * rest / pr->k) / 2;
}

/* The state that has u_t and p, and friction's work so far. */
static void complete(const run *rn, state *st)
{
    const problem *pr = &rn->pr;
    st->P[X] = (st->u[X] - pr->u[X] - pr->c * st->P[N]) / pr->a;
    st->P[Y] = (st->u[Y] - pr->u[Y] - pr->d * st->P[N]) / pr->b;
    st->u[N] = pr->u[N] + pr->c * st->P[X] + pr->d * st->P[Y] + pr->m * st->P[N];
    st->work = half_form(pr, st->u) - half_form(pr, pr->u) - st->friction;
}

static state arc_state(const run *rn, place at)
{
    const arc *ar = &rn->ar;
    state st = {0};
    real s = 0, T = 0, ss;
    if (at.left > 0) look(ar, at, &s, &T);
    integrate(ar, at, &st.P[N], &ss);
    const real theta = ar->theta0 + ar->sign * at.way;
    st.u[X] = s * cosq(theta);
    st.u[Y] = s * sinq(theta);
    st.friction = -rn->pr.mu * ss;
    complete(rn, &st);
    return st;
}

static void book(run *rn, state st)
{
    const real dp = st.P[N] - rn->now.P[N], work = st.work - rn->now.work;
    if (rn->compressing)
        rn->p_c += dp, rn->work_c += work, rn->low = fminq(rn->low, st.work);
    else
        rn->p_r += dp, rn->work_r += work;
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
    case IMPACT_NEWTON: return st->u[N] + rn->pr.eps * rn->pr.u[N];
    case IMPACT_STRONGE: return st->work - (1 - rn->pr.eps * rn->pr.eps) * rn->low;
    }
    return 0;
}

typedef enum sought { COMPRESSED, TURNED, OVER } sought;

static real measure(const run *rn, sought what, const state *st)
{
    switch (what) {
    case COMPRESSED: return st->u[N];
    case TURNED: return -st->u[N];
    case OVER: return over(rn, st);
    }
    return 0;
}

/* A place by x = log(span / left) */
static place place_at(const arc *ar, real x) { return (place){-ar->span * expm1q(-x), ar->span * expq(-x)}; }

/* The place between x1 and x2 where the measure, negative at x1, comes to 0: Illinois' false position. */
static real find(const run *rn, sought what, real x1, real x2)
{
    state st = arc_state(rn, place_at(&rn->ar, x1));
    real f1 = measure(rn, what, &st);
    st = arc_state(rn, place_at(&rn->ar, x2));
    real f2 = measure(rn, what, &st);
    if (f1 >= 0) return x1;
    for (int i = 0; i < 200 && x2 - x1 > 1e-24Q * x2; i++) {
        real x = x1 - f1 * (x2 - x1) / (f2 - f1);
        if (i % 4 == 3 || !(x > x1 && x < x2)) x = (x1 + x2) / 2;
        st = arc_state(rn, place_at(&rn->ar, x));
        const real f = measure(rn, what, &st);
        if (f == 0) return x;
        if (f < 0) {
            x1 = x, f1 = f;
            f2 /= 2;
        } else {
            x2 = x, f2 = f;
            f1 /= 2;
        }
        if (fabsq(f) < 1e-23Q * (fabsq(rn->pr.u[N]) + fabsq(rn->low))) return x;
    }
    return (x1 + x2) / 2;
}

/* From x1 to x2 (uz monotone between); x2 < 0: to the very end. */
static void piece(run *rn, real x1, real x2)
{
    for (int i = 0; i < 8 && !rn->ended; i++) {
        const state last = arc_state(rn, x2 < 0 ? (place){rn->ar.span, 0} : place_at(&rn->ar, x2));
        const real far = x2 < 0 ? 60 / fminq(1, rn->ar.gamma_end) : x2;
        if (rn->compressing) {
            if (last.u[N] < 0 || (last.u[N] < rn->now.u[N])) {
                book(rn, last);
                return;
            }
            x1 = find(rn, COMPRESSED, x1, far);
            book(rn, arc_state(rn, place_at(&rn->ar, x1)));
            turn(rn);
            continue;
        }
        const bool turns = last.u[N] < 0 && last.u[N] < rn->now.u[N];
        const real to = turns ? find(rn, TURNED, x1, far) : far;
        const state there = turns ? arc_state(rn, place_at(&rn->ar, to)) : last;
        if (over(rn, &there) >= 0) {
            book(rn, arc_state(rn, place_at(&rn->ar, find(rn, OVER, x1, to))));
            rn->ended = true;
            return;
        }
        book(rn, there);
        if (!turns) return;
        x1 = to;
        turn(rn);
    }
}

static void follow_arc(run *rn)
{
    const problem *pr = &rn->pr;
    arc *ar = &rn->ar;
    real stops[2];
    int count = 0;
    const real pull = pr->mu * hypotq(pr->c, pr->d);
    if (pull > pr->m) {
        for (int i = 0; i < 2; i++) {
            const real theta = atan2q(pr->d, pr->c) + (i ? 1 : -1) * acosq(pr->m / pull);
            const real way = wrapped(ar->sign * (theta - ar->theta0));
            if (way < ar->span) stops[count++] = -logq(1 - way / ar->span);
        }
        if (count == 2 && stops[0] > stops[1]) {
            const real swap = stops[0];
            stops[0] = stops[1], stops[1] = swap;
        }
    }
    real x = 0;
    for (int i = 0; i < count && !rn->ended; i++) {
        piece(rn, x, stops[i]);
        x = stops[i];
    }
    if (rn->ended) return;
    if (ar->gamma_end > 0) {
        piece(rn, x, -1);
        return;
    }
    /* The slip goes on for ever: look further and further ahead. */
    for (int i = 0; i < 400 && !rn->ended; i++, x += 2) piece(rn, x, x + 2);
}

/* ---- from u_t = 0 on ---- */

static void straight(run *rn, real R, real Z, real x, real y)
{
    (void)R;
    while (!rn->ended) {
        state st = rn->now;
        real dp;
        if (rn->compressing)
            dp = -st.u[N] / Z;
        else if (rn->pr.law == IMPACT_POISSON)
            dp = rn->pr.eps * rn->p_c - rn->p_r;
        else if (rn->pr.law == IMPACT_NEWTON)
            dp = (-rn->pr.eps * rn->pr.u[N] - st.u[N]) / Z;
        else {
            const real more = (1 - rn->pr.eps * rn->pr.eps) * rn->low - st.work;
            dp = more > 0 ? 2 * more / (st.u[N] + sqrtq(st.u[N] * st.u[N] + 2 * Z * more)) : 0;
        }
        st.P[N] += dp;
        st.u[X] += R * x * dp;
        st.u[Y] += R * y * dp;
        st.friction -= R == 0 ? 0 : rn->pr.mu * (hypotq(rn->now.u[X], rn->now.u[Y]) + R * dp / 2) * dp;
        complete(rn, &st);
        book(rn, st);
        if (rn->compressing)
            turn(rn);
        else
            rn->ended = true;
    }
}

static bool from_rest(run *rn)
{
    const problem *pr = &rn->pr;
    if (hypotq(pr->c / pr->a, pr->d / pr->b) <= pr->mu) {
        straight(rn, 0, pr->k, 0, 0);
        return false;
    }
    /* |(mu M_tt + R)^-1 M_tz| = 1 by bisection. */
    real low = 0, high = hypotq(pr->c, pr->d);
    for (int i = 0; i < 120; i++) {
        const real R = (low + high) / 2;
        if (hypotq(pr->c / (pr->mu * pr->a + R), pr->d / (pr->mu * pr->b + R)) > 1)
            low = R;
        else
            high = R;
    }
    const real x = pr->c / (pr->mu * pr->a + high), y = pr->d / (pr->mu * pr->b + high);
    straight(rn, high, pr->m - pr->mu * (pr->c * x + pr->d * y), x, y);
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

bool oracle_collide(const impact_collision *collision, oracle_outcome *outcome)
{
    memset(outcome, 0, sizeof *outcome);
    run rn;
    memset(&rn, 0, sizeof rn);
    make_problem(collision, &rn.pr);
    rn.compressing = true;
    rn.compressions = 1;
    for (int i = 0; i < 3; i++) rn.now.u[i] = rn.pr.u[i];
    const problem *pr = &rn.pr;
    if (hypotq(pr->u[X], pr->u[Y]) > 0) {
        if (!make_arc(&rn.ar, &rn.pr)) return false;
        const real Z = pr->m - pr->mu * (pr->c * pr->u[X] + pr->d * pr->u[Y]) / rn.ar.s0;
        outcome->jammed = Z < 0;
        follow_arc(&rn);
        if (!rn.ended && rn.ar.gamma_end <= 0) return false;
        outcome->stuck = !rn.ended;
        outcome->turned = (double)rn.ar.span;
    }
    if (!rn.ended) outcome->reversed = from_rest(&rn) && outcome->stuck;
    finish(collision, &rn, outcome);
    return true;
}
