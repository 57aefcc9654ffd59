/* SPDX-License-Identifier: MIT */
#include "gap/gap_face.h"
#include "base/tolerances.h"
#include "shape/solid.h"
#include <string.h>

enum { UNKNOWNS = 5 };

/* a x = b of n unknowns by Gauss with complete pivoting; unknowns the equations do not see are left at zero. */
static inline void solve_pivoting(int n, double a[UNKNOWNS][UNKNOWNS], double b[UNKNOWNS], double x[UNKNOWNS])
{
    int column[UNKNOWNS] = {0, 1, 2, 3, 4}, rank = n;
    double first = 0;
    for (int k = 0; k < n; k++) {
        int row = k, col = k;
        double best = -1;
        for (int i = k; i < n; i++)
            for (int j = k; j < n; j++)
                if (fabs(a[i][j]) > best) best = fabs(a[i][j]), row = i, col = j;
        if (k == 0) first = best;
        if (!(best > IMP_GAP_RANK * first)) {
            rank = k;
            break;
        }
        if (row != k) {
            for (int j = 0; j < n; j++) {
                const double t = a[k][j];
                a[k][j] = a[row][j], a[row][j] = t;
            }
            const double t = b[k];
            b[k] = b[row], b[row] = t;
        }
        if (col != k) {
            for (int i = 0; i < n; i++) {
                const double t = a[i][k];
                a[i][k] = a[i][col], a[i][col] = t;
            }
            const int t = column[k];
            column[k] = column[col], column[col] = t;
        }
        const double inverse = 1 / a[k][k];
        for (int i = k + 1; i < n; i++) {
            const double f = a[i][k] * inverse;
            for (int j = k + 1; j < n; j++) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    double y[UNKNOWNS] = {0, 0, 0, 0, 0};
    for (int k = rank - 1; k >= 0; k--) {
        double sum = b[k];
        for (int j = k + 1; j < rank; j++) sum -= a[k][j] * y[j];
        y[k] = sum / a[k][k];
    }
    for (int k = 0; k < n; k++) x[column[k]] = y[k];
}

/* The same for all five, pivoting in rows alone, which is faster; false when a pivot is small. */
static bool solve_plainly(double a[UNKNOWNS][UNKNOWNS], double b[UNKNOWNS], double x[UNKNOWNS])
{
    for (int k = 0; k < UNKNOWNS; k++) {
        int row = k;
        for (int i = k + 1; i < UNKNOWNS; i++) row = fabs(a[i][k]) > fabs(a[row][k]) ? i : row;
        if (!(fabs(a[row][k]) > IMP_GAP_PIVOT)) return false;
        for (int j = k; j < UNKNOWNS; j++) {
            const double t = a[k][j];
            a[k][j] = a[row][j], a[row][j] = t;
        }
        const double t = b[k];
        b[k] = b[row], b[row] = t;
        const double inverse = 1 / a[k][k];
        for (int i = k + 1; i < UNKNOWNS; i++) {
            const double f = a[i][k] * inverse;
            for (int j = k + 1; j < UNKNOWNS; j++) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (int k = UNKNOWNS - 1; k >= 0; k--) {
        double sum = b[k];
        for (int j = k + 1; j < UNKNOWNS; j++) sum -= a[k][j] * x[j];
        x[k] = sum / a[k][k];
    }
    return true;
}

void imp_face_start(const imp_gap_solids *pair, const double n[3], const double (*x)[3], imp_surface s[2])
{
    for (int k = 0; k < 2; k++) {
        const double d[3] = {k ? -n[0] : n[0], k ? -n[1] : n[1], k ? -n[2] : n[2]};
        imp_chart_start(&pair->form[k], d, x ? x[k] : NULL, &s[k]);
    }
}

bool imp_face_look(const imp_gap_solids *pair, const imp_surface s[2], imp_face *face)
{
    for (int k = 0; k < 2; k++) imp_chart_make(&pair->form[k], &s[k], &face->chart[k]);
    const double *NA = face->chart[0].N, *NB = face->chart[1].N;
    const double a = 1 / imp_norm(NA), b = 1 / imp_norm(NB);
    for (int i = 0; i < 3; i++) face->m[i] = NA[i] * a - NB[i] * b;
    const double length = imp_norm(face->m);
    if (!(length > IMP_GAP_FACING)) return false;
    for (int i = 0; i < 3; i++) {
        face->m[i] /= length;
        face->v[i] = pair->c[i] + face->chart[1].x[i] - face->chart[0].x[i];
    }
    imp_across(face->m, face->t);
    face->vm = imp_dot(face->v, face->m);
    for (int k = 0; k < 2; k++) face->along[k] = imp_dot(face->chart[k].N, face->m);
    for (int j = 0; j < 2; j++) {
        face->vt[j] = imp_dot(face->v, face->t[j]);
        for (int k = 0; k < 2; k++) face->y[k][j] = imp_dot(face->chart[k].N, face->t[j]) / face->along[k];
    }
    return true;
}

/* What the equations see of P and Q, the motions of body k's point and normal. Rows 0 and 1: the normals oppose; 2 and
 * 3: v_t - v_m y_A = 0; 4: v_m = 0. */
static inline void respond(const imp_face *face, int k, const double P[3], const double Q[3], double length,
                           double row[UNKNOWNS])
{
    const double inverse = 1 / face->along[k], Qm = imp_dot(Q, face->m) * inverse, Pm = imp_dot(P, face->m),
                 side = k == 0 ? -1 : 1;
    for (int i = 0; i < 2; i++) {
        const double dy = imp_dot(Q, face->t[i]) * inverse - face->y[k][i] * Qm;
        double dv = side * (imp_dot(P, face->t[i]) - Pm * face->y[0][i]);
        if (k == 0) dv -= face->vm * dy;
        row[i] = -side * dy;
        row[2 + i] = dv * length;
    }
    row[4] = side * Pm * length;
}

/* Columns 0 to 3 of the matrix and its right-hand side, each column scaled to a largest entry of 1. */
static inline void set_up(const imp_gap_solids *pair, const imp_face *face, int rows, double a[UNKNOWNS][UNKNOWNS],
                          double b[UNKNOWNS], double scale[UNKNOWNS])
{
    const double length = 1 / pair->size;
    for (int c = 0; c < 4; c++) {
        const imp_chart *chart = &face->chart[c / 2];
        double row[UNKNOWNS], largest = 0;
        respond(face, c / 2, chart->P[c % 2], chart->Q[c % 2], length, row);
        for (int i = 0; i < rows; i++) largest = fabs(row[i]) > largest ? fabs(row[i]) : largest;
        scale[c] = largest > 0 ? 1 / largest : 0;
        for (int i = 0; i < rows; i++) a[i][c] = row[i] * scale[c];
    }
    for (int i = 0; i < 2; i++) {
        b[i] = face->y[1][i] - face->y[0][i];
        b[2 + i] = -(face->vt[i] - face->vm * face->y[0][i]) * length;
    }
    b[4] = -face->vm * length;
}

void imp_face_step(const imp_gap_solids *pair, const imp_face *face, double step[2][2])
{
    double a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS], x[UNKNOWNS], scale[UNKNOWNS];
    set_up(pair, face, 4, a, b, scale);
    solve_pivoting(4, a, b, x);
    for (int c = 0; c < 4; c++) step[c / 2][c % 2] = x[c] * scale[c];
}

void imp_face_strike(const imp_gap_solids *pair, const imp_face *face, const imp_drift *drift, double least,
                     double most, double step[2][2], double *dt)
{
    double a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS], x[UNKNOWNS], scale[UNKNOWNS], time[UNKNOWNS], part[UNKNOWNS];
    set_up(pair, face, UNKNOWNS, a, b, scale);
    respond(face, 0, drift->x[0], drift->N[0], 1 / pair->size, time);
    respond(face, 1, drift->x[1], drift->N[1], 1 / pair->size, part);
    double largest = 0;
    for (int i = 0; i < UNKNOWNS; i++) {
        time[i] += part[i];
        largest = fmax(largest, fabs(time[i]));
    }
    scale[4] = largest > 0 ? 1 / largest : 0;
    for (int i = 0; i < UNKNOWNS; i++) a[i][4] = time[i] * scale[4];
    *dt = least;
    if (least < most) {
        double work[UNKNOWNS][UNKNOWNS], right[UNKNOWNS];
        memcpy(work, a, sizeof work);
        memcpy(right, b, sizeof right);
        if (!solve_plainly(work, right, x)) {
            memcpy(work, a, sizeof work);
            memcpy(right, b, sizeof right);
            solve_pivoting(UNKNOWNS, work, right, x);
        }
        *dt = x[4] * scale[4];
    }
    if (!(*dt > least && *dt < most)) {
        *dt = *dt >= most ? most : least;
        for (int i = 0; i < 4; i++) b[i] -= time[i] * *dt;
        solve_pivoting(4, a, b, x);
    }
    for (int c = 0; c < 4; c++) step[c / 2][c % 2] = x[c] * scale[c];
}

bool imp_face_advance(const imp_gap_solids *pair, const imp_face *face, double step[2][2], imp_surface s[2],
                      double *taken)
{
    double largest = 0;
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++) {
            if (!(fabs(step[k][j]) < INFINITY)) return false;
            if (fabs(step[k][j]) > largest) largest = fabs(step[k][j]);
        }
    double scale = largest > IMP_GAP_STEP ? IMP_GAP_STEP / largest : 1;
    for (int k = 0; k < 2; k++) {
        double part = scale;
        for (int tries = 0;; tries++) {
            imp_surface moved = s[k];
            const double scaled[2] = {step[k][0] * part, step[k][1] * part};
            if (imp_chart_move(&pair->form[k], &face->chart[k], scaled, &moved)) {
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

/* What of d the point can do with the normal as it is; the ways to it. */
static void keep_flat(const imp_chart *chart, double d[3], double way[2])
{
    double kept[3] = {0, 0, 0};
    for (int j = 0; j < 2; j++) {
        const double square = imp_dot(chart->P[j], chart->P[j]);
        way[j] = imp_dot(chart->Q[j], chart->Q[j]) == 0 && square > 0 ? imp_dot(d, chart->P[j]) / square : 0;
        for (int i = 0; i < 3; i++) kept[i] += way[j] * chart->P[j][i];
    }
    memcpy(d, kept, sizeof kept);
}

/* The part of the way d, or of `part` of it, that the point goes before it is at a border; where it is then. */
static double slide(const imp_form *form, const imp_chart *chart, const double way[2], double part, const double d[3],
                    const imp_surface *from, imp_surface *to)
{
    const double step[2] = {part * way[0], part * way[1]};
    double gone[3];
    imp_chart there;
    *to = *from;
    if (!imp_chart_move(form, chart, step, to)) return 0;
    imp_chart_make(form, to, &there);
    for (int i = 0; i < 3; i++) gone[i] = there.x[i] - chart->x[i];
    return imp_dot(gone, d) / imp_dot(d, d);
}

bool imp_face_slide(const imp_gap_solids *pair, const imp_face *face, imp_surface s[2])
{
    double d[3], way[2][2], part[2];
    imp_surface to[2];
    for (int i = 0; i < 3; i++)
        d[i] = (face->y[1][0] - face->y[0][0]) * face->t[0][i] + (face->y[1][1] - face->y[0][1]) * face->t[1][i];
    keep_flat(&face->chart[0], d, way[0]);
    keep_flat(&face->chart[1], d, way[1]);
    const double length = imp_norm(d);
    if (!(length > 0)) return false;
    for (int i = 0; i < 3; i++) d[i] *= pair->size / length;
    for (int k = 0; k < 2; k++) {
        keep_flat(&face->chart[k], d, way[k]);
        part[k] = slide(&pair->form[k], &face->chart[k], way[k], 1, d, &s[k], &to[k]);
    }
    const int far = part[1] > part[0];
    if (!(part[1 - far] > 0)) return false;
    slide(&pair->form[far], &face->chart[far], way[far], part[1 - far], d, &s[far], &to[far]);
    memcpy(s, to, sizeof to);
    return true;
}

double imp_pair_gap(const imp_gap_solids *pair, const double n[3], double x[2][3])
{
    double h = 0, d[3], point[3], normal[3];
    imp_surface s;
    for (int k = 0; k < 2; k++) {
        const imp_form *form = &pair->form[k];
        const double world[3] = {k ? -n[0] : n[0], k ? -n[1] : n[1], k ? -n[2] : n[2]};
        imp_to_body(form->rotation, world, d);
        h += imp_form_support(form, d, &s);
        if (x) {
            imp_surface_point(form, &s, point, normal);
            imp_to_world(form->rotation, point, x[k]);
        }
    }
    return imp_dot(n, pair->c) - h;
}

/* H = P Q^-1 across m, for N scaled to length 1 along m. A flat surface has no finite H: its radii are then capped
 * softly at 1e3 sizes, H (1 + cap H)^-1. */
static void add_radii(const imp_gap_solids *pair, const imp_face *face, int k, double W[2][2])
{
    double P[2][2], Q[2][2];
    for (int j = 0; j < 2; j++) {
        const double Qm = imp_dot(face->chart[k].Q[j], face->m) / face->along[k];
        for (int i = 0; i < 2; i++) {
            P[i][j] = imp_dot(face->chart[k].P[j], face->t[i]);
            Q[i][j] = (imp_dot(face->chart[k].Q[j], face->t[i]) / face->along[k] - face->y[k][i] * Qm) * (k ? -1 : 1);
        }
    }
    double det = Q[0][0] * Q[1][1] - Q[0][1] * Q[1][0];
    const double cap = IMP_GAP_LEAST_CURVATURE / pair->size;
    bool flat = !(fabs(det) > IMP_GAP_FLAT * (fabs(Q[0][0] * Q[1][1]) + fabs(Q[0][1] * Q[1][0])));
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

static double stiffness(const imp_gap_solids *pair, const imp_face *face, double gap)
{
    double W[2][2] = {{gap, 0}, {0, gap}};
    add_radii(pair, face, 0, W);
    add_radii(pair, face, 1, W);
    const double off = 0.5 * (W[0][1] + W[1][0]), mean = 0.5 * (W[0][0] + W[1][1]), half = 0.5 * (W[0][0] - W[1][1]);
    const double larger = fabs(mean) + hypot(half, off);
    if (mean <= 0) return mean - hypot(half, off);
    return (W[0][0] * W[1][1] - off * off) / larger;
}

/* Whether the point x_A + part (x_B + c - x_A) is in body k, with room for rounding. */
static bool body_holds(const imp_gap_solids *pair, const imp_face *face, int k, double part)
{
    double world[3], body[3];
    for (int i = 0; i < 3; i++) world[i] = face->chart[k].x[i] + (k ? part - 1 : part) * face->v[i];
    const imp_form *form = &pair->form[k];
    imp_to_body(form->rotation, world, body);
    if (form->kind != IMP_FORM_QUADRIC) return imp_core_distance(form, body) <= IMP_WALK_INSIDE * pair->reach;
    const double thin = fmin(form->axis[0], fmin(form->axis[1], form->axis[2]));
    const double steepest = fmax(fmax(form->p[0], form->p[1]), fmax(form->p[2], form->p[3]));
    return imp_form_inside(form, body) <= 1 + IMP_GAP_INSIDE * steepest * pair->size / thin;
}

/* Whether the bodies are seen to have a point in common: a witness point in the other body, or the one midway in both.
 */
static bool share_a_point(const imp_gap_solids *pair, const imp_face *face)
{
    return (body_holds(pair, face, 0, 0.5) && body_holds(pair, face, 1, 0.5)) || body_holds(pair, face, 1, 0) ||
           body_holds(pair, face, 0, 1);
}

bool imp_face_judge(const imp_gap_solids *pair, const imp_face *face, imp_gap_bracket *meeting)
{
    meeting->gap = meeting->lower = imp_pair_gap(pair, face->m, NULL);
    const double slip = hypot(face->vt[0], face->vt[1]);
    meeting->upper = fmax(meeting->gap, meeting->gap > slip ? imp_norm(face->v) : face->vm + slip);
    if (!(meeting->upper - meeting->lower <= IMP_GAP_CLOSED * pair->reach)) return false;
    for (int k = 0; k < 2; k++) /* the points prove the upper end where they lie in their bodies */
        if (!imp_gap_holds(&pair->form[k], face->chart[k].x, IMP_GAP_OUTSIDE * pair->reach)) return false;
    meeting->stiffness = stiffness(pair, face, meeting->gap);
    /* Radii that add up to the depth, as at a point of a cone's axis, are capped by the second term (add_radii). */
    const double none =
        IMP_GAP_STIFFNESS * pair->size + IMP_GAP_LEAST_CURVATURE / pair->size * meeting->gap * meeting->gap;
    if (meeting->gap < 0 && !(meeting->stiffness >= -none)) return false;
    meeting->shares = meeting->gap >= 0 || share_a_point(pair, face);
    memcpy(meeting->n, face->m, sizeof meeting->n);
    for (int k = 0; k < 2; k++) memcpy(meeting->x[k], face->chart[k].x, sizeof meeting->x[k]);
    return true;
}
