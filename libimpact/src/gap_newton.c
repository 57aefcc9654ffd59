/* SPDX-License-Identifier: MIT
 *
 * Mixed primal/dual Newton. Unknowns are two surface points, each with its normal. Around a point, two of its axis
 * pairs (u, e) are free and the third, the one of the largest mass u e, follows from the surface's equation; of a free
 * pair the gentler half moves: u where de/du = (p - 1) |u|^(p-2) <= 1, else e. Solved: the normals oppose (2 equations,
 * in gnomonic coordinates about their bisector) and the points' difference is along them (2 equations).
 */
#include "gap_solver.h"
#include <string.h>

typedef struct vec {
    double v[3];
} vec;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static double norm(const double a[3]) { return sqrt(dot(a, a)); }

static void to_world(const double m[3][3], const double b[3], double w[3])
{
    for (int i = 0; i < 3; i++) w[i] = m[i][0] * b[0] + m[i][1] * b[1] + m[i][2] * b[2];
}

static void to_body(const double m[3][3], const double w[3], double b[3])
{
    for (int i = 0; i < 3; i++) b[i] = m[0][i] * w[0] + m[1][i] * w[1] + m[2][i] * w[2];
}

/* ---- one body: its point, normal and their derivatives along the two free pairs ---- */

typedef struct chart {
    double x[3], N[3];       /* world */
    double P[2][3], Q[2][3]; /* derivatives of x and N */
    int index[2];            /* the free pairs */
    bool primal[2];
} chart;

static double exponent(const impact_form *form, int i) { return form->nested && i < 2 ? form->p[0] : form->p[i]; }

/* de/du of a pair; infinite at u = 0 of p < 2. */
static double steepness(double p, double u, double e)
{
    if (p == 2) return 1;
    if (u == 0) return p < 2 && p > 1 ? INFINITY : p == 1 ? INFINITY : 0;
    return (p - 1) * e / u;
}

/* The pivot of a constraint over the pairs i and j: the heavier. */
static bool heavier(const impact_surface *s, int i, int j) { return s->u[i] * s->e[i] >= s->u[j] * s->e[j]; }

/* How pair i moves per unit of its gentler half. */
static void motion(const impact_form *form, const impact_surface *s, int i, bool *primal, double *du, double *de)
{
    const double slope = steepness(exponent(form, i), s->u[i], s->e[i]);
    *primal = slope <= 1;
    *du = *primal ? 1 : 1 / slope;
    *de = *primal ? slope : 1;
}

/* The pivot pair k answers du_i of pair i on the constraint sum m |u|^p = const. */
static void pivot_motion(const impact_form *form, const impact_surface *s, int i, int k, double du, double de,
                         double *duk, double *dek)
{
    const double pk = exponent(form, k), change = s->e[i] * du + s->u[i] * de;
    *duk = -change / (pk * s->e[k]);
    *dek = pk == 2 ? *duk : (pk - 1) * s->e[k] / s->u[k] * *duk;
}

static void plain_chart(const impact_form *form, const impact_surface *s, double x[3], double N[3], double P[2][3],
                        double Q[2][3], chart *c)
{
    int k = heavier(s, 0, 1) ? 0 : 1;
    if (heavier(s, 2, k)) k = 2;
    c->index[0] = (k + 1) % 3;
    c->index[1] = (k + 2) % 3;
    double inverse[3];
    for (int i = 0; i < 3; i++) {
        inverse[i] = form->p[i] / form->axis[i];
        x[i] = form->axis[i] * s->u[i];
        N[i] = inverse[i] * s->e[i];
    }
    for (int j = 0; j < 2; j++) {
        const int i = c->index[j], o = c->index[1 - j];
        double du, de, duk, dek;
        motion(form, s, i, &c->primal[j], &du, &de);
        pivot_motion(form, s, i, k, du, de, &duk, &dek);
        P[j][i] = form->axis[i] * du, P[j][k] = form->axis[k] * duk, P[j][o] = 0;
        Q[j][i] = inverse[i] * de, Q[j][k] = inverse[k] * dek, Q[j][o] = 0;
    }
}

static void nested_chart(const impact_form *form, const impact_surface *s, double x[3], double N[3], double P[2][3],
                         double Q[2][3], chart *c)
{
    const double K = s->u[IMPACT_SECTION], eK = s->e[IMPACT_SECTION];
    impact_surface_point(form, s, x, N);
    /* pair 0: along the section */
    const int k = heavier(s, 0, 1) ? 0 : 1, i = 1 - k;
    double du, de, duk, dek;
    c->index[0] = i;
    motion(form, s, i, &c->primal[0], &du, &de);
    pivot_motion(form, s, i, k, du, de, &duk, &dek);
    P[0][i] = form->axis[i] * K * du, P[0][k] = form->axis[k] * K * duk, P[0][2] = 0;
    Q[0][i] = eK * de / form->axis[i], Q[0][k] = eK * dek / form->axis[k], Q[0][2] = 0;
    /* pair 1: along the profile */
    const bool top = heavier(s, 2, IMPACT_SECTION);
    const int free_pair = top ? IMPACT_SECTION : 2, pivot = top ? 2 : IMPACT_SECTION;
    c->index[1] = free_pair;
    motion(form, s, free_pair, &c->primal[1], &du, &de);
    pivot_motion(form, s, free_pair, pivot, du, de, &duk, &dek);
    const double dK = top ? du : duk, deK = top ? de : dek, dz = top ? duk : du, dez = top ? dek : de;
    for (int j = 0; j < 2; j++) {
        P[1][j] = form->axis[j] * dK * s->u[j];
        Q[1][j] = deK * s->e[j] / form->axis[j];
    }
    P[1][2] = form->axis[2] * dz;
    Q[1][2] = dez / form->axis[2];
}

static void make_chart(const impact_form *form, const impact_surface *s, chart *c)
{
    double x[3], N[3], P[2][3], Q[2][3];
    if (form->nested)
        nested_chart(form, s, x, N, P, Q, c);
    else
        plain_chart(form, s, x, N, P, Q, c);
    to_world(form->rotation, x, c->x);
    to_world(form->rotation, N, c->N);
    for (int j = 0; j < 2; j++) {
        to_world(form->rotation, P[j], c->P[j]);
        to_world(form->rotation, Q[j], c->Q[j]);
    }
}

/* ---- moving a surface point ---- */

static double signed_root(double value, double power)
{
    return value == 0 ? 0 : copysign(pow(fabs(value), power), value);
}

static double clamp_unit(double value) { return value > 1 ? 1 : value < -1 ? -1 : value; }

/* Moves the gentler half of a pair. p = 1 and steps through zero use u + e, along which both halves are gentle. */
static void move_pair(double p, bool primal, double step, double *u, double *e)
{
    if (p == 2) {
        *u = *e = clamp_unit(*u + step);
        return;
    }
    if (p == 1) {
        const double sum = *u + *e + step;
        *e = clamp_unit(sum);
        *u = clamp_unit(sum - *e);
        return;
    }
    const double old = primal ? *u : *e, moved = clamp_unit(old + step);
    const bool crosses = old != 0 && (moved > 0) != (old > 0) && (p < 2) == primal;
    if (crosses) {
        const double slope = steepness(p, *u, *e), other = primal ? slope * step : step / slope;
        primal = !primal;
        const double sum = clamp_unit(*u + *e + step + other);
        if (primal)
            *u = sum, *e = signed_root(*u, p - 1);
        else
            *e = sum, *u = signed_root(*e, 1 / (p - 1));
        return;
    }
    if (primal)
        *u = moved, *e = signed_root(moved, p - 1);
    else
        *e = moved, *u = signed_root(moved, 1 / (p - 1));
}

/* Gives the pivot the mass the others leave; false when they leave too little of it. */
static bool settle_pivot(double p, double rest, double *u, double *e)
{
    if (!(rest > 1e-3)) return false;
    if (p == 2) {
        *u = copysign(sqrt(rest), *u);
        *e = *u;
    } else if (p == 1) {
        *u = copysign(rest, *u);
    } else {
        *u = copysign(pow(rest, 1 / p), *u);
        *e = rest / *u;
    }
    return true;
}

static bool move_surface(const impact_form *form, const chart *c, const double step[2], impact_surface *s)
{
    for (int j = 0; j < 2; j++) {
        const int i = c->index[j];
        move_pair(exponent(form, i), c->primal[j], step[j], &s->u[i], &s->e[i]);
    }
    if (!form->nested) {
        const int i = c->index[0], o = c->index[1], k = 3 - i - o;
        return settle_pivot(form->p[k], 1 - s->u[i] * s->e[i] - s->u[o] * s->e[o], &s->u[k], &s->e[k]);
    }
    const int i = c->index[0], k = 1 - i, f = c->index[1], pivot = f == 2 ? IMPACT_SECTION : 2;
    if (f == IMPACT_SECTION && s->u[f] < 0) { /* through the pole: the section's other side */
        s->u[f] = -s->u[f], s->e[f] = -s->e[f];
        for (int j = 0; j < 2; j++) s->u[j] = -s->u[j], s->e[j] = -s->e[j];
    }
    return settle_pivot(form->p[0], 1 - s->u[i] * s->e[i], &s->u[k], &s->e[k]) &&
           settle_pivot(form->p[IMPACT_SECTION], 1 - s->u[f] * s->e[f], &s->u[pivot], &s->e[pivot]);
}

/* ---- the system ---- */

/* a x = b by Gauss with complete pivoting; unknowns the equations do not see are left at zero. */
static void solve4(double a[4][4], double b[4], double x[4])
{
    int column[4] = {0, 1, 2, 3}, rank = 4;
    double first = 0;
    for (int k = 0; k < 4; k++) {
        int row = k, col = k;
        double best = -1;
        for (int i = k; i < 4; i++)
            for (int j = k; j < 4; j++)
                if (fabs(a[i][j]) > best) best = fabs(a[i][j]), row = i, col = j;
        if (k == 0) first = best;
        if (!(best > 1e-14 * first)) {
            rank = k;
            break;
        }
        if (row != k) {
            for (int j = 0; j < 4; j++) {
                const double t = a[k][j];
                a[k][j] = a[row][j], a[row][j] = t;
            }
            const double t = b[k];
            b[k] = b[row], b[row] = t;
        }
        if (col != k) {
            for (int i = 0; i < 4; i++) {
                const double t = a[i][k];
                a[i][k] = a[i][col], a[i][col] = t;
            }
            const int t = column[k];
            column[k] = column[col], column[col] = t;
        }
        const double inverse = 1 / a[k][k];
        for (int i = k + 1; i < 4; i++) {
            const double f = a[i][k] * inverse;
            for (int j = k + 1; j < 4; j++) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    double y[4] = {0, 0, 0, 0};
    for (int k = rank - 1; k >= 0; k--) {
        double sum = b[k];
        for (int j = k + 1; j < rank; j++) sum -= a[k][j] * y[j];
        y[k] = sum / a[k][k];
    }
    for (int k = 0; k < 4; k++) x[column[k]] = y[k];
}

/* Two unit vectors across the unit n (Duff et al. 2017). */
static void across(const double n[3], double t[2][3])
{
    const double sign = copysign(1, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    t[0][0] = 1 + sign * n[0] * n[0] * a, t[0][1] = sign * b, t[0][2] = -sign * n[0];
    t[1][0] = b, t[1][1] = sign + n[1] * n[1] * a, t[1][2] = -n[1];
}

typedef struct iterate {
    chart chart[2];
    double m[3], t[2][3];     /* bisector of the normals, and across it */
    double y[2][2], along[2]; /* gnomonic coordinates of both normals; their length along m */
    double v[3], vm, vt[2];   /* x_B + c - x_A and its parts */
} iterate;

/* False when the normals do not face each other. */
static bool look(const impact_pair *pair, const impact_surface s[2], iterate *it)
{
    for (int k = 0; k < 2; k++) make_chart(&pair->form[k], &s[k], &it->chart[k]);
    const double *NA = it->chart[0].N, *NB = it->chart[1].N;
    const double a = 1 / norm(NA), b = 1 / norm(NB);
    for (int i = 0; i < 3; i++) it->m[i] = NA[i] * a - NB[i] * b;
    const double length = norm(it->m);
    if (!(length > 0.2)) return false;
    for (int i = 0; i < 3; i++) {
        it->m[i] /= length;
        it->v[i] = pair->c[i] + it->chart[1].x[i] - it->chart[0].x[i];
    }
    across(it->m, it->t);
    it->vm = dot(it->v, it->m);
    for (int k = 0; k < 2; k++) it->along[k] = dot(it->chart[k].N, it->m);
    for (int j = 0; j < 2; j++) {
        it->vt[j] = dot(it->v, it->t[j]);
        for (int k = 0; k < 2; k++) it->y[k][j] = dot(it->chart[k].N, it->t[j]) / it->along[k];
    }
    return true;
}

/* One Newton step for the four free halves: step[body][pair]. */
static void newton_step(const impact_pair *pair, const iterate *it, double step[2][2])
{
    double a[4][4], b[4], x[4], scale[4];
    const double length = 1 / pair->size;
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++) {
            const int column = 2 * k + j;
            const double *P = it->chart[k].P[j], *Q = it->chart[k].Q[j];
            const double Qm = dot(Q, it->m) / it->along[k], Pm = dot(P, it->m), side = k == 0 ? -1 : 1;
            double largest = 0;
            for (int i = 0; i < 2; i++) {
                const double dy = dot(Q, it->t[i]) / it->along[k] - it->y[k][i] * Qm;
                a[i][column] = k == 0 ? dy : -dy;
                /* v_t - v_m y_A = 0 */
                double dv = side * (dot(P, it->t[i]) - Pm * it->y[0][i]);
                if (k == 0) dv -= it->vm * dy;
                a[2 + i][column] = dv * length;
                largest = fmax(largest, fmax(fabs(a[i][column]), fabs(a[2 + i][column])));
            }
            scale[column] = largest > 0 ? 1 / largest : 0;
            for (int i = 0; i < 4; i++) a[i][column] *= scale[column];
        }
    for (int i = 0; i < 2; i++) {
        b[i] = it->y[1][i] - it->y[0][i];
        b[2 + i] = -(it->vt[i] - it->vm * it->y[0][i]) * length;
    }
    solve4(a, b, x);
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++) step[k][j] = x[2 * k + j] * scale[2 * k + j];
}

static const double longest_step = 0.5, finest_step = 1e-10;
enum { MAX_ITERATIONS = 16, MORE_ITERATIONS = 8 }; /* more when the steps have become small */

/* Moves both points, halving the step until it stays on the surfaces. */
static bool advance(const impact_pair *pair, const iterate *it, double step[2][2], impact_surface s[2], double *taken)
{
    double largest = 0;
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++) largest = fmax(largest, fabs(step[k][j]));
    if (!(largest < INFINITY)) return false;
    double scale = largest > longest_step ? longest_step / largest : 1;
    for (int k = 0; k < 2; k++) {
        double part = scale;
        for (int tries = 0;; tries++) {
            impact_surface moved = s[k];
            const double scaled[2] = {step[k][0] * part, step[k][1] * part};
            if (move_surface(&pair->form[k], &it->chart[k], scaled, &moved)) {
                s[k] = moved;
                break;
            }
            if (tries == 20) return false;
            part /= 2;
        }
    }
    *taken = largest;
    return true;
}

double impact_pair_gap(const impact_pair *pair, const double n[3], double x[2][3])
{
    double h = 0, d[3], point[3], normal[3];
    impact_surface s;
    for (int k = 0; k < 2; k++) {
        const impact_form *form = &pair->form[k];
        const double world[3] = {k ? -n[0] : n[0], k ? -n[1] : n[1], k ? -n[2] : n[2]};
        to_body(form->rotation, world, d);
        h += impact_form_support(form, d, &s);
        if (x) {
            impact_surface_point(form, &s, point, normal);
            to_world(form->rotation, point, x[k]);
        }
    }
    return dot(n, pair->c) - h;
}

/* H = P Q^-1 across m, for N scaled to length 1 along m. A flat surface has no finite H: its radii are then capped
 * softly at 1e3 sizes, H (1 + cap H)^-1. */
static void add_radii(const impact_pair *pair, const iterate *it, int k, double W[2][2])
{
    double P[2][2], Q[2][2];
    for (int j = 0; j < 2; j++) {
        const double Qm = dot(it->chart[k].Q[j], it->m) / it->along[k];
        for (int i = 0; i < 2; i++) {
            P[i][j] = dot(it->chart[k].P[j], it->t[i]);
            Q[i][j] = (dot(it->chart[k].Q[j], it->t[i]) / it->along[k] - it->y[k][i] * Qm) * (k ? -1 : 1);
        }
    }
    double det = Q[0][0] * Q[1][1] - Q[0][1] * Q[1][0];
    const double cap = 1e-3 / pair->size;
    bool flat = !(fabs(det) > 1e-6 * (fabs(Q[0][0] * Q[1][1]) + fabs(Q[0][1] * Q[1][0])));
    for (int j = 0; j < 2; j++) flat = flat || fabs(Q[0][j]) + fabs(Q[1][j]) < cap * (fabs(P[0][j]) + fabs(P[1][j]));
    if (flat) {
        for (int j = 0; j < 2; j++)
            for (int i = 0; i < 2; i++) Q[i][j] += cap * P[i][j];
        det = Q[0][0] * Q[1][1] - Q[0][1] * Q[1][0];
    }
    if (det == 0) return; /* neither point nor normal moves: a vertex */
    W[0][0] += (P[0][0] * Q[1][1] - P[0][1] * Q[1][0]) / det;
    W[0][1] += (P[0][1] * Q[0][0] - P[0][0] * Q[0][1]) / det;
    W[1][0] += (P[1][0] * Q[1][1] - P[1][1] * Q[1][0]) / det;
    W[1][1] += (P[1][1] * Q[0][0] - P[1][0] * Q[0][1]) / det;
}

static double stiffness(const impact_pair *pair, const iterate *it, double gap)
{
    double W[2][2] = {{gap, 0}, {0, gap}};
    add_radii(pair, it, 0, W);
    add_radii(pair, it, 1, W);
    const double off = 0.5 * (W[0][1] + W[1][0]), mean = 0.5 * (W[0][0] + W[1][1]), half = 0.5 * (W[0][0] - W[1][1]);
    const double larger = fabs(mean) + hypot(half, off);
    if (mean <= 0) return mean - hypot(half, off);
    return (W[0][0] * W[1][1] - off * off) / larger;
}

/* Whether the point x_A + part (x_B + c - x_A) is in body k, with room for rounding. */
static bool holds(const impact_pair *pair, const iterate *it, int k, double part)
{
    double world[3], body[3];
    for (int i = 0; i < 3; i++) world[i] = it->chart[k].x[i] + (k ? part - 1 : part) * it->v[i];
    const impact_form *form = &pair->form[k];
    to_body(form->rotation, world, body);
    const double thin = fmin(form->axis[0], fmin(form->axis[1], form->axis[2]));
    const double steepest = fmax(fmax(form->p[0], form->p[1]), fmax(form->p[2], form->p[3]));
    return impact_form_inside(form, body) <= 1 + 4e-15 * steepest * pair->size / thin;
}

/* Whether the bodies are seen to have a point in common: a witness point in the other body, or the one midway in both.
 */
static bool share_a_point(const impact_pair *pair, const iterate *it)
{
    return (holds(pair, it, 0, 0.5) && holds(pair, it, 1, 0.5)) || holds(pair, it, 1, 0) || holds(pair, it, 0, 1);
}

/* Closes the bracket at the point reached and says whether it is an answer. */
static bool judge(const impact_pair *pair, const iterate *it, impact_meeting *meeting)
{
    meeting->gap = meeting->lower = impact_pair_gap(pair, it->m, NULL);
    const double slip = hypot(it->vt[0], it->vt[1]);
    meeting->upper = fmax(meeting->gap, meeting->gap > slip ? norm(it->v) : it->vm + slip);
    if (!(meeting->upper - meeting->lower <= 2e-14 * pair->reach)) return false;
    meeting->stiffness = stiffness(pair, it, meeting->gap);
    if (meeting->gap < 0 && !(meeting->stiffness >= -1e-12 * pair->size && share_a_point(pair, it))) return false;
    memcpy(meeting->n, it->m, sizeof meeting->n);
    for (int k = 0; k < 2; k++) memcpy(meeting->x[k], it->chart[k].x, sizeof meeting->x[k]);
    return true;
}

/* Takes the gentler half of each pair from the point x (body axes) where the surface point came from the normal alone.
 */
static void use_point(const impact_form *form, const double x[3], impact_surface *s)
{
    int pivot = 0;
    double heaviest = -1, rest = 1;
    for (int i = 0; i < 3; i++) {
        const double p = form->p[i], u = clamp_unit(x[i] / form->axis[i]), size = fabs(u);
        if (p == 1) {
            const bool face = size > 1e-7;
            s->u[i] = face ? u : 0;
            if (face) s->e[i] = copysign(1, u);
        } else if (size > 0 && (p - 1) * pow(size, p - 2) <= 1) {
            s->u[i] = u, s->e[i] = signed_root(u, p - 1);
        }
        if (s->u[i] * s->e[i] > heaviest) heaviest = s->u[i] * s->e[i], pivot = i;
    }
    for (int i = 0; i < 3; i++)
        if (i != pivot) rest -= s->u[i] * s->e[i];
    settle_pivot(form->p[pivot], fmax(rest, 0.01), &s->u[pivot], &s->e[pivot]);
}

static void start(const impact_pair *pair, const double n[3], const double (*x)[3], impact_surface s[2])
{
    for (int k = 0; k < 2; k++) {
        const impact_form *form = &pair->form[k];
        const double world[3] = {k ? -n[0] : n[0], k ? -n[1] : n[1], k ? -n[2] : n[2]};
        double d[3];
        to_body(form->rotation, world, d);
        impact_form_support(form, d, &s[k]);
        if (!x || form->nested) continue;
        to_body(form->rotation, x[k], d);
        use_point(form, d, &s[k]);
    }
}

bool impact_gap_newton(const impact_pair *pair, const double n[3], const double (*x)[3], impact_meeting *meeting)
{
    impact_surface s[2];
    start(pair, n, x, s);
    double last = INFINITY;
    int settled = 0; /* how often it has: while the bracket is wider than rounding, a few more steps may close it */
    for (int i = 0, end = MAX_ITERATIONS; i < end; i++) {
        iterate it;
        if (!look(pair, s, &it)) return settled > 0;
        if (i == MAX_ITERATIONS - 1 && last < 1e-2) end += MORE_ITERATIONS;
        if (last < finest_step || i == end - 1) {
            impact_meeting now;
            if (judge(pair, &it, &now)) {
                if (settled++ == 0 || now.upper - now.lower < meeting->upper - meeting->lower) *meeting = now;
                if (meeting->upper - meeting->lower <= 1e-15 * pair->reach || settled == 4) return true;
            }
        }
        double step[2][2];
        newton_step(pair, &it, step);
        if (!advance(pair, &it, step, s, &last)) return settled > 0;
    }
    return settled > 0;
}
