/* SPDX-License-Identifier: MIT */
#include <quat/spline.h>
#include <quat/jacobian.h>
#include <quat/rotation.h>
#include "quadrature.h"
#include <float.h>
#include <stdint.h>
#include <stdlib.h>

/* One key and the segment that follows it; body axes throughout. */
typedef struct key {
    double t, length; /* time, and the angle turned through so far */
    quat q;
    qvec3 omega; /* at the key */
    qvec3 turn;  /* rotation vector to the next key */
    qvec3 rate;  /* dr/dt at the end of the segment */
} key;

struct quat_spline {
    size_t n;
    quat_spline_end end;
    key keys[];
};

/* ---- how rotation vectors turn into angular velocity and acceleration ---- */

/* (d J_right(r)/dt) dr/dt for dr/dt = v: what the bending of J adds to the angular acceleration. Quadratic in v. With
 * J_right = 1 - b [r]x + c [r]x^2 and b'/a, c'/a the derivatives by a = |r|, over a. */
static qvec3 bending(qvec3 r, qvec3 v)
{
    const double a = qvec3_norm(r), a2 = a * a, rv = qvec3_dot(r, v);
    double db, dc, c;
    if (a < 0.3) {
        db = -1.0 / 12 + a2 * (1.0 / 180 - a2 * (1.0 / 6720 - a2 * (1.0 / 453600 - a2 / 47900160)));
        dc = -1.0 / 60 + a2 * (1.0 / 1260 - a2 * (1.0 / 60480 - a2 * (1.0 / 4989600 - a2 / 622702080)));
        c = 1.0 / 6 - a2 * (1.0 / 120 - a2 * (1.0 / 5040 - a2 * (1.0 / 362880 - a2 / 39916800)));
    } else {
        const double half = sin(0.5 * a) / a, b = 2 * half * half, sinc = sin(a) / a;
        c = (1 - sinc) / a2;
        db = (sinc - 2 * b) / a2;
        dc = (b - 3 * c) / a2;
    }
    const qvec3 rxv = qvec3_cross(r, v);
    qvec3 sum = qvec3_scale(rxv, -db * rv);
    sum = qvec3_axpy(dc * rv, qvec3_cross(r, rxv), sum);
    return qvec3_axpy(c, qvec3_cross(v, rxv), sum);
}

/* r, dr/dt and d2r/dt2 of the segment after k, of length h, at time s into it. */
static void cubic(const key *k, double h, double s, qvec3 r[3])
{
    const qvec3 slope = qvec3_scale(k->turn, 1 / h);
    /* r = omega s + a s^2 + b s^3 with r(h) = turn and r'(h) = rate */
    const qvec3 a = qvec3_scale(qvec3_sub(qvec3_scale(slope, 3), qvec3_add(qvec3_scale(k->omega, 2), k->rate)), 1 / h);
    const qvec3 b = qvec3_scale(qvec3_sub(qvec3_add(k->omega, k->rate), qvec3_scale(slope, 2)), 1 / (h * h));
    r[0] = qvec3_scale(qvec3_axpy(s, qvec3_axpy(s, b, a), k->omega), s);
    r[1] = qvec3_axpy(s, qvec3_axpy(3 * s, b, qvec3_scale(a, 2)), k->omega);
    r[2] = qvec3_axpy(6 * s, b, qvec3_scale(a, 2));
}

/* ---- small matrices ---- */

static qmat3 scaled(const qmat3 *a, double s)
{
    qmat3 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) r.m[i][j] = s * a->m[i][j];
    return r;
}

static qmat3 minus(const qmat3 *a, const qmat3 *b)
{
    qmat3 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) r.m[i][j] = a->m[i][j] - b->m[i][j];
    return r;
}

/* By cofactors; the diagonal blocks of the spline's system are far from singular unless it has no solution. */
static qmat3 inverse(const qmat3 *a)
{
    qmat3 r;
    const double d = qmat3_det(a);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int p = (j + 1) % 3, q = (j + 2) % 3, s = (i + 1) % 3, t = (i + 2) % 3;
            r.m[i][j] = (a->m[p][s] * a->m[q][t] - a->m[p][t] * a->m[q][s]) / d;
        }
    return r;
}

/* ---- the rates at the keys ---- */

/* One row of the system for the corrections x: lower x[i-1] + diagonal x[i] + upper x[i+1] = right. side holds the
 * columns of the periodic spline's first unknown. */
typedef struct row {
    qmat3 lower, diagonal, upper, side;
    qvec3 right;
} row;

static void set_rates(quat_spline *s)
{
    for (size_t i = 0; i + 1 < s->n; i++) {
        const qmat3 j = quat_rotation_vector_jacobian_right_inverse(s->keys[i].turn);
        s->keys[i].rate = qmat3_apply(&j, s->keys[i + 1].omega);
    }
}

/* The angular acceleration at the start and at the end of segment i. */
static qvec3 acceleration_at(const quat_spline *s, size_t i, bool at_end)
{
    const key *const k = &s->keys[i];
    const double h = k[1].t - k[0].t;
    qvec3 r[3];
    cubic(k, h, at_end ? h : 0, r);
    if (!at_end) return r[2];
    const qmat3 j = quat_rotation_vector_jacobian_right(k->turn);
    return qvec3_add(qmat3_apply(&j, r[2]), bending(k->turn, k->rate));
}

/* What the acceleration at the end of segment i gains by a change of the angular velocity at its start (lower) and at
 * its end (diagonal, to which it is added). */
static void add_end_derivatives(const quat_spline *s, size_t i, row *r)
{
    const key *const k = &s->keys[i];
    const double h = k[1].t - k[0].t;
    const qmat3 j = quat_rotation_vector_jacobian_right(k->turn),
                ji = quat_rotation_vector_jacobian_right_inverse(k->turn);
    r->lower = scaled(&j, 2 / h);
    const qvec3 bent = bending(k->turn, k->rate);
    for (int c = 0; c < 3; c++) {
        /* bending is quadratic: its derivative is a difference without error */
        const qvec3 e = {ji.m[0][c], ji.m[1][c], ji.m[2][c]};
        const qvec3 d = qvec3_sub(qvec3_sub(bending(k->turn, qvec3_add(k->rate, e)), bent), bending(k->turn, e));
        r->diagonal.m[0][c] += d.x + (c == 0) * 4 / h;
        r->diagonal.m[1][c] += d.y + (c == 1) * 4 / h;
        r->diagonal.m[2][c] += d.z + (c == 2) * 4 / h;
    }
}

/* What it loses at the start of segment i: minus the derivatives of the acceleration there. */
static void add_start_derivatives(const quat_spline *s, size_t i, row *r)
{
    const key *const k = &s->keys[i];
    const double h = k[1].t - k[0].t;
    const qmat3 ji = quat_rotation_vector_jacobian_right_inverse(k->turn);
    r->upper = scaled(&ji, 2 / h);
    for (int c = 0; c < 3; c++) r->diagonal.m[c][c] += 4 / h;
}

/* Residual and derivatives at key i; before and after say which segments meet there. */
static void fill_row(const quat_spline *s, size_t before, size_t after, bool has_before, bool has_after, row *r)
{
    *r = (row){.right = {0, 0, 0}};
    if (has_before) {
        r->right = qvec3_sub(r->right, acceleration_at(s, before, true));
        add_end_derivatives(s, before, r);
    }
    if (has_after) {
        r->right = qvec3_add(r->right, acceleration_at(s, after, false));
        add_start_derivatives(s, after, r);
    }
}

/* Gaussian elimination by blocks over rows first ... last; the side columns are carried along. */
static void eliminate(row *rows, size_t first, size_t last)
{
    for (size_t i = first; i <= last; i++) {
        row *const r = &rows[i];
        if (i > first) {
            const row *const above = &rows[i - 1];
            const qmat3 u = qmat3_mul(&r->lower, &above->upper), v = qmat3_mul(&r->lower, &above->side);
            r->diagonal = minus(&r->diagonal, &u);
            r->side = minus(&r->side, &v);
            r->right = qvec3_sub(r->right, qmat3_apply(&r->lower, above->right));
        }
        const qmat3 d = inverse(&r->diagonal);
        r->upper = qmat3_mul(&d, &r->upper);
        r->side = qmat3_mul(&d, &r->side);
        r->right = qmat3_apply(&d, r->right);
    }
    for (size_t i = last; i-- > first;) {
        row *const r = &rows[i];
        const qmat3 v = qmat3_mul(&r->upper, &rows[i + 1].side);
        r->right = qvec3_sub(r->right, qmat3_apply(&r->upper, rows[i + 1].right));
        r->side = minus(&r->side, &v);
    }
}

/* Open ends: rows first ... last are unknown, the others (clamped) stay. */
static void solve_open(const quat_spline *s, row *rows, size_t first, size_t last)
{
    for (size_t i = first; i <= last; i++) fill_row(s, i - 1, i, i > 0, i + 1 < s->n, &rows[i]);
    eliminate(rows, first, last);
}

/* Round a loop: rows 1 ... m - 1 in terms of the first unknown, which its own row then gives. */
static void solve_periodic(const quat_spline *s, row *rows)
{
    const size_t m = s->n - 1;
    for (size_t i = 0; i < m; i++) fill_row(s, (i + m - 1) % m, i, true, true, &rows[i]);
    rows[1].side = rows[1].lower;
    if (m > 2)
        rows[m - 1].side = rows[m - 1].upper;
    else
        for (int i = 0; i < 9; i++) rows[1].side.m[i / 3][i % 3] += rows[1].upper.m[i / 3][i % 3];
    row *const r = &rows[0];
    eliminate(rows, 1, m - 1);
    const qmat3 u = qmat3_mul(&r->upper, &rows[1].side), l = qmat3_mul(&r->lower, &rows[m - 1].side);
    qmat3 d = minus(&r->diagonal, &u);
    d = minus(&d, &l);
    qvec3 right = qvec3_sub(r->right, qmat3_apply(&r->upper, rows[1].right));
    right = qvec3_sub(right, qmat3_apply(&r->lower, rows[m - 1].right));
    const qmat3 di = inverse(&d);
    r->right = qmat3_apply(&di, right);
    for (size_t i = 1; i < m; i++) rows[i].right = qvec3_sub(rows[i].right, qmat3_apply(&rows[i].side, r->right));
}

/* Newton's method for the angular velocities at the keys, from zero: the first step is the linear spline's solution. */
static quat_status find_rates(quat_spline *s, row *rows)
{
    const bool clamped = s->end == QUAT_SPLINE_CLAMPED, periodic = s->end == QUAT_SPLINE_PERIODIC;
    const size_t first = clamped ? 1 : 0, last = s->n - (clamped || periodic ? 2 : 1);
    if (clamped && s->n == 2) return QUAT_OK;
    for (int round = 0; round < 50; round++) {
        double change = 0, size = 0;
        set_rates(s);
        if (periodic)
            solve_periodic(s, rows);
        else
            solve_open(s, rows, first, last);
        for (size_t i = first; i <= last; i++) {
            s->keys[i].omega = qvec3_add(s->keys[i].omega, rows[i].right);
            change = fmax(change, qvec3_norm(rows[i].right));
            size = fmax(size, qvec3_norm(s->keys[i].omega));
            if (!qvec3_isfinite(s->keys[i].omega)) return QUAT_NOT_CONVERGED;
        }
        if (periodic) s->keys[s->n - 1].omega = s->keys[0].omega;
        if (change <= 64 * DBL_EPSILON * size) return QUAT_OK;
    }
    return QUAT_NOT_CONVERGED;
}

/* ---- making one ---- */

/* Times between keys (s) whose squares stay in range, and the angle that one segment may whirl through: as many steps
 * as radians, at least, are needed for its length. */
static const double shortest = 1e-100, longest = 1e100, wildest = 1e5;

/* A bound of the angle of the segment after k. */
static double whirl(const key *k)
{
    return qvec3_norm(k->turn) + (qvec3_norm(k->omega) + qvec3_norm(k->rate)) * (k[1].t - k[0].t);
}

static quat_status copy_keys(quat_spline *s, const double t[], const quat q[])
{
    for (size_t i = 0; i < s->n; i++) {
        key *const k = &s->keys[i];
        *k = (key){.t = t[i]};
        if (!isfinite(t[i]) || quat_normalize(q[i], &k->q) != QUAT_OK) return QUAT_EDOMAIN;
        if (i == 0) continue;
        if (!(t[i] > t[i - 1])) return QUAT_EARGUMENT;
        if (!(t[i] - t[i - 1] >= shortest && t[i] - t[i - 1] <= longest)) return QUAT_ERANGE;
        k->q = quat_nearest(k->q, k[-1].q);
        k[-1].turn = quat_to_rotation_vector(quat_mul_compensated(quat_conj(k[-1].q), k->q));
    }
    return QUAT_OK;
}

static double speed(const key *k, double s)
{
    qvec3 r[3];
    cubic(k, k[1].t - k[0].t, s, r);
    const qmat3 j = quat_rotation_vector_jacobian_right(r[0]);
    return qvec3_norm(qmat3_apply(&j, r[1]));
}

/* The speed at s, and how far the rounding of the cubic's terms may put it off. */
static double rounded_speed(double s, void *context, double *error)
{
    const key *const k = context;
    *error = DBL_EPSILON * whirl(k) / (k[1].t - k[0].t);
    return speed(k, s);
}

/* The angle turned through from the key to time s after it. The speed has a kink where it passes through zero. */
static double part_length(const key *k, double s)
{
    double sum, noise;
    quat_quadrature(rounded_speed, (void *)k, 0, s, 1e-16, &sum, &noise); /* once for each of up to 40 halvings */
    return sum;
}

quat_status quat_spline_new(size_t n, const double t[], const quat q[], quat_spline_end end, qvec3 omega_first,
                            qvec3 omega_last, quat_spline **spline)
{
    *spline = NULL;
    if (end != QUAT_SPLINE_NATURAL && end != QUAT_SPLINE_CLAMPED && end != QUAT_SPLINE_PERIODIC) return QUAT_EARGUMENT;
    if (n < (end == QUAT_SPLINE_PERIODIC ? 3 : 2) || n > SIZE_MAX / 2 / sizeof(row)) return QUAT_EARGUMENT;
    quat_spline *const s = malloc(sizeof *s + n * sizeof(key));
    row *const rows = malloc(n * sizeof *rows);
    quat_status status = s && rows ? QUAT_OK : QUAT_ENOMEM;
    if (status == QUAT_OK) {
        s->n = n;
        s->end = end;
        status = copy_keys(s, t, q);
    }
    if (status == QUAT_OK && end == QUAT_SPLINE_PERIODIC && !quat_same_rotation(s->keys[0].q, s->keys[n - 1].q, 1e-9))
        status = QUAT_EARGUMENT;
    if (status == QUAT_OK && end == QUAT_SPLINE_CLAMPED) {
        if (!qvec3_isfinite(omega_first) || !qvec3_isfinite(omega_last)) status = QUAT_EDOMAIN;
        s->keys[0].omega = quat_rotate_inverse(s->keys[0].q, omega_first);
        s->keys[n - 1].omega = quat_rotate_inverse(s->keys[n - 1].q, omega_last);
    }
    if (status == QUAT_OK) status = find_rates(s, rows);
    free(rows);
    if (status == QUAT_OK) {
        set_rates(s);
        for (size_t i = 0; i + 1 < n; i++)
            if (!(whirl(&s->keys[i]) <= wildest)) status = QUAT_ERANGE;
    }
    if (status != QUAT_OK) {
        free(s);
        return status;
    }
    for (size_t i = 1; i < n; i++)
        s->keys[i].length = s->keys[i - 1].length + part_length(&s->keys[i - 1], s->keys[i].t - s->keys[i - 1].t);
    *spline = s;
    return QUAT_OK;
}

void quat_spline_free(quat_spline *spline) { free(spline); }

/* ---- using it ---- */

/* The segment that holds t, by bisection; t inside the range. */
static const key *segment(const quat_spline *s, double t)
{
    size_t low = 0, high = s->n - 1;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (s->keys[middle].t <= t)
            low = middle;
        else
            high = middle;
    }
    return &s->keys[low];
}

static quat inside(const quat_spline *s, double t, qvec3 *omega, qvec3 *acceleration)
{
    const key *const k = segment(s, t);
    qvec3 r[3];
    cubic(k, k[1].t - k[0].t, t - k->t, r);
    const quat q = t == k[1].t ? k[1].q : quat_mul(k->q, quat_from_rotation_vector(r[0]));
    const qmat3 j = quat_rotation_vector_jacobian_right(r[0]);
    if (omega) *omega = quat_rotate(q, qmat3_apply(&j, r[1]));
    /* in world axes d(R w)/dt = R (dw/dt + w x w): the body's own rate, turned */
    if (acceleration) *acceleration = quat_rotate(q, qvec3_add(qmat3_apply(&j, r[2]), bending(r[0], r[1])));
    return q;
}

quat quat_spline_state(const quat_spline *spline, double t, qvec3 *omega, qvec3 *acceleration)
{
    const key *const first = &spline->keys[0], *const last = &spline->keys[spline->n - 1];
    const qvec3 zero = {0, 0, 0}, none = {NAN, NAN, NAN};
    const bool outside = t < first->t || t > last->t;
    if (!isfinite(t)) {
        if (omega) *omega = none;
        if (acceleration) *acceleration = none;
        return quat_make(NAN, NAN, NAN, NAN);
    }
    if (outside && spline->end == QUAT_SPLINE_PERIODIC) {
        const double period = last->t - first->t, loops = floor((t - first->t) / period);
        const double back = fmin(fmax(t - loops * period, first->t), last->t);
        const quat q = inside(spline, back, omega, acceleration);
        return quat_dot(first->q, last->q) < 0 && fmod(loops, 2) != 0 ? quat_neg(q) : q;
    }
    if (outside) {
        if (omega) *omega = zero;
        if (acceleration) *acceleration = zero;
        return t < first->t ? first->q : last->q;
    }
    return inside(spline, t, omega, acceleration);
}

quat quat_spline_at(const quat_spline *spline, double t) { return quat_spline_state(spline, t, NULL, NULL); }

double quat_spline_length(const quat_spline *spline, double t)
{
    const key *const first = &spline->keys[0], *const last = &spline->keys[spline->n - 1];
    if (isnan(t)) return t;
    if (t <= first->t) return 0;
    if (t >= last->t) return last->length;
    const key *const k = segment(spline, t);
    return fmin(k->length + part_length(k, t - k->t), k[1].length);
}

double quat_spline_time_at(const quat_spline *spline, double length)
{
    const key *const last = &spline->keys[spline->n - 1], *k = &spline->keys[0];
    if (isnan(length)) return length;
    if (length <= 0) return k->t;
    if (length >= last->length) return last->t;
    while (k[1].length <= length) k++;
    /* Newton, kept between the bounds by bisection: the speed may vanish */
    double low = 0, high = k[1].t - k[0].t, s = high * (length - k->length) / (k[1].length - k->length);
    for (int round = 0; round < 100 && high - low > 4 * DBL_EPSILON * (fabs(k->t) + high); round++) {
        const double off = k->length + part_length(k, s) - length;
        if (off == 0) break;
        if (off > 0)
            high = s;
        else
            low = s;
        const double v = speed(k, s), next = v > 0 ? s - off / v : low;
        const bool good = next > low && next < high;
        if (good && fabs(next - s) <= 2 * DBL_EPSILON * (fabs(k->t) + high)) return k->t + next;
        s = good ? next : 0.5 * (low + high);
    }
    return k->t + s;
}
