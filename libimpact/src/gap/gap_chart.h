/* SPDX-License-Identifier: MIT
 *
 * gap_chart (internal): a point of one body's surface with its normal, and how both move. Of the point's axis pairs
 * (u, e) two are free and the third, the one of the largest mass u e, follows from the surface's equation; of a free
 * pair the gentler half moves: u where de/du = (p - 1) |u|^(p-2) <= 1, else e.
 */
#ifndef IMP_GAP_CHART_H
#define IMP_GAP_CHART_H

#include "shape/support.h"
#include <math.h>

typedef struct imp_chart {
    double x[3], N[3];       /* world */
    double P[2][3], Q[2][3]; /* derivatives of x and N along the two free pairs */
    int index[2];            /* the free pairs */
    bool primal[2];
} imp_chart;

/* The chart around a surface point. */
void imp_chart_make(const imp_form *form, const imp_surface *s, imp_chart *chart);

/* Moves the free halves; false when they leave the pivot too little mass. */
bool imp_chart_move(const imp_form *form, const imp_chart *chart, const double step[2], imp_surface *s);

/* The surface point whose normal is along d (world), near x (world, relative to the centre; NULL: any). */
void imp_chart_start(const imp_form *form, const double d[3], const double *x, imp_surface *s);

/* ---- vectors ---- */

static inline double imp_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline double imp_norm(const double a[3]) { return sqrt(imp_dot(a, a)); }

static inline void imp_cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1], c[1] = a[2] * b[0] - a[0] * b[2], c[2] = a[0] * b[1] - a[1] * b[0];
}

/* Two unit vectors across the unit n (Duff et al. 2017). */
static inline void imp_across(const double n[3], double t[2][3])
{
    const double sign = copysign(1, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    t[0][0] = 1 + sign * n[0] * n[0] * a, t[0][1] = sign * b, t[0][2] = -sign * n[0];
    t[1][0] = b, t[1][1] = sign + n[1] * n[1] * a, t[1][2] = -n[1];
}

static inline void imp_to_world(const double m[3][3], const double b[3], double w[3])
{
    for (int i = 0; i < 3; i++) w[i] = m[i][0] * b[0] + m[i][1] * b[1] + m[i][2] * b[2];
}

static inline void imp_to_body(const double m[3][3], const double w[3], double b[3])
{
    for (int i = 0; i < 3; i++) b[i] = m[0][i] * w[0] + m[1][i] * w[1] + m[2][i] * w[2];
}

#endif
