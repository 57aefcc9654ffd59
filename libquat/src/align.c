/* SPDX-License-Identifier: MIT
 *
 * Wahba's problem. Of sum w |b - R a|^2 only -sum w b.R a depends on R, so lengths may be taken for weights: with unit
 * u along a, v along b and omega = w |a||b|, the same R minimises sum omega |r|^2, r = v - c, c = R u. For R to exp(d)
 * R
 *
 *     gradient  -sum omega c x r       Hessian  A^T A + E,   A the rows sqrt(omega) [c]x,
 *                                               E = sum omega ((r.c) I - sym(r c^T))
 *
 * and with A = Q T, F = T^-T E T^-1, Newton's step is d = T^-1 (I + F)^-1 Q^T (-sqrt(omega) r): neither A^T A nor the
 * profile matrix sum w b a^T is ever formed, so that vectors within an angle s of each other cost 1/s of the digits, as
 * in the data, and not 1/s^2. Where I + F is not positive, its eigenvalues count with their size: on the rotations the
 * sum has one minimum, its other stationary points are saddles, and such steps leave them.
 */
#include <quat/average.h>
#include <quat/rotation.h>
#include "attitude.h"
#include "weights.h"
#include <float.h>

/* Roundings in a row of r, in eps: half of one in each of u, v and the difference, 6.5 halves in R u (quat_rotate). */
static const double row_roundings = 5;
/* An answer that rounding may have turned by more than this, rad, is one of many: a quarter of a degree. */
static const double unknown_angle = 4e-3;
static const double longest_step = 1; /* rad: beyond, a quadratic says nothing of a circle */
enum { MAX_STEPS = 40 };

typedef struct sets {
    size_t n;
    const qvec3 *a, *b;
    const double *weights;
    double heaviest, total; /* omega is relative to the first; its sum */
    qvec3 ca, cb;           /* centres less the first points */
    qvec3 from_a, from_b;   /* the first points, or 0 */
    double sa, sb;          /* powers of two that keep products of lengths within the range of doubles */
} sets;

/* ---- the sets ---- */

static bool finite_sets(size_t n, const qvec3 a[], const qvec3 b[])
{
    for (size_t i = 0; i < n; i++)
        if (!qvec3_isfinite(a[i]) || !qvec3_isfinite(b[i])) return false;
    return true;
}

static qvec3 arm_a(const sets *s, size_t i) { return qvec3_sub(qvec3_sub(s->a[i], s->from_a), s->ca); }

static qvec3 arm_b(const sets *s, size_t i) { return qvec3_sub(qvec3_sub(s->b[i], s->from_b), s->cb); }

static double largest_component(qvec3 d) { return fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))); }

/* A power of two near 1/x. */
static double scale_near(double x) { return x > 0 && isfinite(x) ? ldexp(1, -ilogb(x) > 1000 ? 1000 : -ilogb(x)) : 1; }

/* The directions of pair i, and omega; 0 where a length is. */
static double pair_at(const sets *s, size_t i, qvec3 *u, qvec3 *v)
{
    const qvec3 a = qvec3_scale(arm_a(s, i), s->sa), b = qvec3_scale(arm_b(s, i), s->sb);
    const double la = qvec3_norm(a), lb = qvec3_norm(b);
    const quat_status first = qvec3_normalize(a, u), second = qvec3_normalize(b, v);
    const bool useful = first == QUAT_OK && second == QUAT_OK;
    if (!useful) return 0;
    return s->weights ? s->weights[i] * (la * lb / s->heaviest) : la * lb / s->heaviest;
}

/* Scales and the heaviest omega; QUAT_ERANGE when differences overflow, QUAT_EDOMAIN when every omega is 0. */
static quat_status weigh(sets *s, double heaviest_weight)
{
    double largest_a = 0, largest_b = 0, heaviest = 0;
    qvec3 u, v;
    for (size_t i = 0; i < s->n; i++) {
        largest_a = fmax(largest_a, largest_component(arm_a(s, i)));
        largest_b = fmax(largest_b, largest_component(arm_b(s, i)));
    }
    if (!isfinite(largest_a) || !isfinite(largest_b)) return QUAT_ERANGE;
    s->sa = scale_near(largest_a), s->sb = scale_near(largest_b);
    s->heaviest = heaviest_weight;
    for (size_t i = 0; i < s->n; i++) heaviest = fmax(heaviest, pair_at(s, i, &u, &v));
    if (!(heaviest > 0)) return QUAT_EDOMAIN;
    s->heaviest = heaviest_weight * heaviest;
    s->total = 0;
    for (size_t i = 0; i < s->n; i++) s->total += pair_at(s, i, &u, &v);
    return QUAT_OK;
}

/* Both sets, as they are; statuses as quat_align's. */
static quat_status take_vectors(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], sets *s)
{
    double heaviest;
    *s = (sets){.n = n, .a = a, .b = b, .weights = weights};
    if (n == 0) return QUAT_EARGUMENT;
    if (!quat_weight_largest(n, weights, &heaviest) || !finite_sets(n, a, b)) return QUAT_EDOMAIN;
    return weigh(s, heaviest);
}

/* The centroid less the first point, so that sets far from the origin lose nothing. */
static qvec3 centroid(size_t n, const qvec3 a[], const double weights[], double heaviest)
{
    qvec3 sum = {0, 0, 0};
    double total = 0;
    for (size_t i = 0; i < n; i++) {
        const double w = quat_weight(weights, i, heaviest);
        sum = qvec3_axpy(w, qvec3_sub(a[i], a[0]), sum);
        total += w;
    }
    return qvec3_scale(sum, 1 / total);
}

static quat_status take_points(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], sets *s)
{
    double heaviest;
    *s = (sets){.n = n, .a = a, .b = b, .weights = weights};
    if (n == 0) return QUAT_EARGUMENT;
    if (!quat_weight_largest(n, weights, &heaviest) || !finite_sets(n, a, b)) return QUAT_EDOMAIN;
    s->from_a = a[0], s->from_b = b[0];
    s->ca = centroid(n, a, weights, heaviest), s->cb = centroid(n, b, weights, heaviest);
    return weigh(s, heaviest);
}

/* ---- starts ---- */

/* sum omega |v - R u|^2. */
static double misfit(const sets *s, quat q)
{
    double sum = 0;
    qvec3 u, v;
    for (size_t i = 0; i < s->n; i++) {
        const double omega = pair_at(s, i, &u, &v);
        const qvec3 r = qvec3_sub(v, quat_rotate(q, u));
        sum += omega * qvec3_dot(r, r);
    }
    return sum;
}

/* Davenport's (1968): the best of all, but for the digits that the profile matrix costs. */
static quat davenport(const sets *s)
{
    qmat3 m = {{{0}}};
    quat q;
    qvec3 u, v;
    for (size_t i = 0; i < s->n; i++) {
        const double omega = pair_at(s, i, &u, &v), from[3] = {u.x, u.y, u.z}, to[3] = {v.x, v.y, v.z};
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) m.m[j][k] += omega * to[j] * from[k];
    }
    quat_attitude(&m, &q);
    return q;
}

/* u x v by their difference or sum, the smaller: exact where they are nearly parallel. */
static qvec3 across(qvec3 u, qvec3 v)
{
    return qvec3_cross(u, qvec3_dot(u, v) > 0 ? qvec3_sub(v, u) : qvec3_add(v, u));
}

/* TRIAD (Black 1964) from the heaviest pair and the one that says most of the turn about it. */
static quat triad(const sets *s)
{
    size_t first = 0, second = 0;
    double heaviest = 0, most = 0;
    qvec3 u0, v0, u, v;
    quat q;
    for (size_t i = 0; i < s->n; i++) {
        const double omega = pair_at(s, i, &u, &v);
        if (omega > heaviest) heaviest = omega, first = i;
    }
    pair_at(s, first, &u0, &v0);
    for (size_t i = 0; i < s->n; i++) {
        const double omega = pair_at(s, i, &u, &v), says = omega * qvec3_norm(across(u0, u));
        if (says > most) most = says, second = i;
    }
    pair_at(s, second, &u, &v);
    quat_from_two_vectors(u0, v0, &q);
    const qvec3 from = quat_rotate(q, across(u0, u)), to = across(v0, v);
    const double angle = atan2(qvec3_dot(v0, qvec3_cross(from, to)), qvec3_dot(from, to));
    return quat_unit(quat_mul(quat_from_rotation_vector(qvec3_scale(v0, angle)), q));
}

/* ---- Newton's steps ---- */

/* What the sum is like about a rotation. */
typedef struct local {
    double T[3][4]; /* upper triangle, and Q^T (-sqrt(omega) r) */
    double E[3][3];
    double rest;                   /* sum omega |r|^2 */
    double W[3][3];                /* T^-1 */
    double value[4], vector[4][4]; /* of I + F */
    double turn[4][3], known[4];   /* W times the vectors; how well the data tell of these turns, rad */
    double error;                  /* by which rounding may have turned the rotation, rad */
} local;

/* Three more rows of A and of its right-hand side into the triangle, by Householder's reflections. */
static void add_rows(double row[3][4], double T[3][4])
{
    for (int j = 0; j < 3; j++) {
        const double below = row[0][j] * row[0][j] + row[1][j] * row[1][j] + row[2][j] * row[2][j];
        if (below == 0) continue;
        const double norm = sqrt(T[j][j] * T[j][j] + below), head = T[j][j] + copysign(norm, T[j][j]);
        for (int k = j + 1; k < 4; k++) {
            const double dot = head * T[j][k] + row[0][j] * row[0][k] + row[1][j] * row[1][k] + row[2][j] * row[2][k];
            const double f = dot / (norm * fabs(head));
            T[j][k] -= f * head;
            for (int i = 0; i < 3; i++) row[i][k] -= f * row[i][j];
        }
        T[j][j] = -copysign(norm, T[j][j]);
    }
}

static void add_pair(double omega, qvec3 c, qvec3 r, local *l)
{
    const double root = sqrt(omega), along = qvec3_dot(r, c);
    const double x = root * c.x, y = root * c.y, z = root * c.z;
    double row[3][4] = {{0, -z, y, -root * r.x}, {z, 0, -x, -root * r.y}, {-y, x, 0, -root * r.z}};
    const double from[3] = {c.x, c.y, c.z}, off[3] = {r.x, r.y, r.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            l->E[i][j] += omega * ((i == j) * along - 0.5 * (off[i] * from[j] + off[j] * from[i]));
    l->rest += omega * qvec3_dot(r, r);
    add_rows(row, l->T);
}

/* T^-1; false when T is singular to rounding, A's directions all one. */
static bool invert(double T[3][4], double W[3][3])
{
    const double a = fabs(T[0][0]), b = fabs(T[1][1]), c = fabs(T[2][2]), largest = fmax(a, fmax(b, c));
    if (!(fmin(a, fmin(b, c)) > DBL_EPSILON * largest)) return false;
    for (int j = 0; j < 3; j++)
        for (int i = 2; i >= 0; i--) {
            double sum = i == j;
            for (int k = i + 1; k < 3; k++) sum -= T[i][k] * W[k][j];
            W[i][j] = i > j ? 0 : sum / T[i][i];
        }
    return true;
}

/* Eigenvalues and vectors of I + W^T E W; the fourth row and column only fill quat_eigen4's. */
static void decompose(local *l)
{
    double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int p = 0; p < 3; p++)
                for (int q = 0; q < 3; q++) m[i][j] += l->W[p][i] * l->E[p][q] * l->W[q][j];
    quat_eigen4(m, l->value, l->vector);
}

/* W |I + F|^-1 = sum W v_k v_k^T/|value_k|. To first order, rounded rows of r turn the answer by W |I + F|^-1 Q^T dr,
 * rounded rows of A by W |I + F|^-1 W^T dA^T r. */
static void find_errors(const sets *s, local *l)
{
    const double unit = row_roundings * DBL_EPSILON * sqrt(s->total), rest = sqrt(l->rest);
    l->error = row_roundings * DBL_EPSILON;
    for (int k = 0; k < 4; k++) {
        const double *const v = l->vector[k];
        double square = 0;
        for (int i = 0; i < 3; i++) {
            l->turn[k][i] = l->W[i][0] * v[0] + l->W[i][1] * v[1] + l->W[i][2] * v[2];
            square += l->turn[k][i] * l->turn[k][i];
        }
        l->known[k] = unit * (sqrt(square) + square * rest) / fabs(l->value[k]);
        if (square > 0) l->error = hypot(l->error, l->known[k]);
    }
}

/* Newton's step, along all that the data tell of. */
static qvec3 step_of(const local *l)
{
    qvec3 d = {0, 0, 0};
    for (int k = 0; k < 4; k++) {
        const double *const v = l->vector[k];
        if (!(l->known[k] <= unknown_angle)) continue;
        const double part = (v[0] * l->T[0][3] + v[1] * l->T[1][3] + v[2] * l->T[2][3]) / fabs(l->value[k]);
        d = qvec3_axpy(part, qvec3_make(l->turn[k][0], l->turn[k][1], l->turn[k][2]), d);
    }
    return d;
}

static void look(const sets *s, quat q, local *l)
{
    qvec3 u, v;
    *l = (local){.error = INFINITY};
    for (size_t i = 0; i < s->n; i++) {
        const double omega = pair_at(s, i, &u, &v);
        const qvec3 c = quat_rotate(q, u);
        if (omega > 0) add_pair(omega, c, qvec3_sub(v, c), l);
    }
    if (!invert(l->T, l->W)) return;
    decompose(l);
    find_errors(s, l);
}

/* The best rotation: the better of two starts, then steps until they are within the error. */
static quat_status best_rotation(const sets *s, quat *q)
{
    const quat start = davenport(s), other = triad(s);
    local l;
    *q = misfit(s, other) < misfit(s, start) ? other : start;
    for (int step = 0; step < MAX_STEPS; step++) {
        look(s, *q, &l);
        if (isinf(l.error)) return QUAT_NOT_UNIQUE;
        const qvec3 d = step_of(&l);
        const double size = qvec3_norm(d), part = size > longest_step ? longest_step / size : 1;
        *q = quat_mul(quat_from_rotation_vector(qvec3_scale(d, part)), *q);
        quat_normalize(*q, q);
        if (size <= l.error) return l.error <= unknown_angle ? QUAT_OK : QUAT_NOT_UNIQUE;
    }
    return QUAT_NOT_CONVERGED;
}

/* Root mean square of |b - R a|, weighted; infinite when it overflows. */
static double residual_of(const sets *s, quat q, double heaviest)
{
    const double scale = fmin(s->sa, s->sb);
    double sum = 0, total = 0;
    for (size_t i = 0; i < s->n; i++) {
        const double w = quat_weight(s->weights, i, heaviest);
        const qvec3 u = qvec3_scale(arm_a(s, i), scale), v = qvec3_scale(arm_b(s, i), scale);
        sum = hypot(sum, sqrt(w) * qvec3_norm(qvec3_sub(v, quat_rotate(q, u))));
        total += w;
    }
    return sum / sqrt(total) / scale;
}

static quat_status fit(const sets *s, quat *q, double *residual)
{
    double heaviest;
    const quat_status status = best_rotation(s, q);
    if (q->w < 0) *q = quat_neg(*q);
    if (residual && quat_weight_largest(s->n, s->weights, &heaviest)) *residual = residual_of(s, *q, heaviest);
    return status;
}

/* ---- what is public ---- */

quat_status quat_align(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat *q, double *residual)
{
    sets s;
    *q = quat_identity();
    if (residual) *residual = NAN;
    const quat_status status = take_vectors(n, a, b, weights, &s);
    return status == QUAT_OK ? fit(&s, q, residual) : status;
}

static quat_status keep_still(qvec3 shift, qvec3 *out, quat *q, double *residual)
{
    *q = quat_identity();
    *out = shift;
    if (residual) *residual = NAN;
    return QUAT_ERANGE;
}

quat_status quat_align_points(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat *q, qvec3 *shift,
                              double *residual)
{
    sets s;
    const qvec3 none = {0, 0, 0};
    *q = quat_identity();
    *shift = none;
    if (residual) *residual = NAN;
    quat_status status = take_points(n, a, b, weights, &s);
    const bool one_point = status == QUAT_EDOMAIN && s.sa > 0; /* all points of a set coincide: any rotation will do */
    if (status < 0 && !one_point) return status;
    double heaviest;
    quat_weight_largest(n, weights, &heaviest);
    status = one_point ? QUAT_NOT_UNIQUE : fit(&s, q, NULL);
    const qvec3 ca = qvec3_add(a[0], s.ca), cb = qvec3_add(b[0], s.cb);
    *shift = qvec3_sub(cb, quat_rotate(*q, ca));
    if (!qvec3_isfinite(*shift)) return keep_still(none, shift, q, residual);
    if (residual) *residual = residual_of(&s, *q, heaviest);
    return status;
}

static double error_at(const sets *s, quat q)
{
    local l;
    quat unit;
    if (quat_normalize(q, &unit) != QUAT_OK) return NAN;
    look(s, unit, &l);
    return l.error;
}

double quat_align_error(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat q)
{
    sets s;
    return take_vectors(n, a, b, weights, &s) == QUAT_OK ? error_at(&s, q) : NAN;
}

double quat_align_points_error(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat q)
{
    sets s;
    return take_points(n, a, b, weights, &s) == QUAT_OK ? error_at(&s, q) : NAN;
}
