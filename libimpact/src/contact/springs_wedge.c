/* SPDX-License-Identifier: MIT
 *
 * Whether a motion v takes all contacts that were pressed apart, friction notwithstanding: (G v)_n > mu |(G v)_t|. None
 * does where pressures of their own, r in K, sum r_n = 1, balance: G^T r = 0 (Gordan's theorem, over cones). The least
 * |G^T r|^2 = r . W r is looked for by Frank & Wolfe's steps, each to the extreme pressure
 *
 *     at the contact of the least m_c = w_n - mu |w_t|, w = W r, the pressure n - mu w_t/|w_t|
 *
 * All m_c > 0 is a proof: v = M^-1 G^T r does. Without one f = r . W r is within 4 D^2/k of its least after k steps,
 * D^2 the largest of s . W s over extreme pressures s: what is under that is taken for none.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/tolerances.h"

typedef struct wedge {
    const imp_springs *s;
    bool rough;    /* with friction */
    double *r, *w; /* 3 count each */
    double most;   /* s . W s */
} wedge;

static bool was_pressed(const imp_spring *c) { return c->p[0] > 0 || c->normal != IMP_SPRING_OPEN; }

/* The extreme pressure at contact c against w; m_c. */
static double find_extreme(const wedge *g, int c, double pressure[3])
{
    const double mu = g->rough ? g->s->springs[c].friction : 0, *w = &g->w[3 * c], across = hypot(w[1], w[2]);
    pressure[0] = 1;
    for (int j = 1; j < 3; j++) pressure[j] = across > 0 ? -mu * w[j] / across : 0;
    return w[0] - mu * across;
}

/* r goes the part `along` of its way to the pressure at contact c. */
static void go_towards(wedge *g, int c, const double pressure[3], double along)
{
    const int width = 3 * g->s->count;
    for (int i = 0; i < width; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++) sum += imp_springs_entry(g->s, i, 3 * c + j) * pressure[j];
        g->r[i] *= 1 - along;
        g->w[i] += along * (sum - g->w[i]);
    }
    for (int j = 0; j < 3; j++) g->r[3 * c + j] += along * pressure[j];
}

/* One step; false: all are taken apart. *square: r . W r before it. */
static bool step_on(wedge *g, double *square)
{
    int least = -1;
    double margin = INFINITY, pressure[3], own = 0, other[3];
    *square = 0;
    for (int c = 0; c < g->s->count; c++) {
        for (int j = 0; j < 3; j++) *square += g->r[3 * c + j] * g->w[3 * c + j];
        if (!was_pressed(&g->s->springs[c])) continue;
        const double m = find_extreme(g, c, other);
        if (m < margin) margin = m, least = c;
    }
    if (margin > 0) return false;
    (void)find_extreme(g, least, pressure);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            own += pressure[i] * imp_springs_entry(g->s, 3 * least + i, 3 * least + j) * pressure[j];
    g->most = fmax(g->most, own);
    /* |r + a (s - r)|^2 in W is least at */
    const double length = *square - 2 * margin + own;
    go_towards(g, least, pressure, length > 0 ? fmin(1, (*square - margin) / length) : 1);
    return true;
}

bool imp_springs_wedged(imp_springs *s, bool rough)
{
    const int width = 3 * s->count;
    wedge g = {.s = s, .rough = rough, .r = s->factor, .w = s->factor + width};
    int first = 0;
    while (first < s->count && !was_pressed(&s->springs[first])) first++;
    if (first == s->count) return false;
    for (int i = 0; i < width; i++) g.r[i] = g.w[i] = 0;
    const double normal[3] = {1, 0, 0};
    go_towards(&g, first, normal, 1);
    double square = 0;
    for (int k = 0; k < IMP_WEDGE_STEPS; k++)
        if (!step_on(&g, &square)) return false;
    return square <= 4 * g.most / IMP_WEDGE_STEPS;
}
