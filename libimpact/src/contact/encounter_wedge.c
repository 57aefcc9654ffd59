/* SPDX-License-Identifier: MIT
 *
 * Whether a motion v takes all of some contacts apart, friction notwithstanding: (G v)_n > mu |(G v)_t|. None does
 * where pressures of their own, r in K, sum r_n = 1, balance: G^T r = 0 (Gordan's theorem, over cones). Where one does
 * the cone problem of compression has a solution whatever the velocities are (Acary, Cadoux, Lemarechal & Malick 2011).
 * The least |G^T r|^2 = r . W r is looked for by Frank & Wolfe's steps, each to the extreme pressure
 *
 *     at the contact of the least m_c = w_n - mu |w_t|, w = W r, the pressure n - mu w_t/|w_t|
 *
 * All m_c > 0 is a proof that some does: v = M^-1 G^T r. Pressures that balance are one that none does, both but for
 * rounding of w. Without either f = r . W r is within 4 D^2/k of its least after k steps, D^2 the largest of s . W s
 * over extreme pressures s.
 */
#include "contact/encounter.h"

#include "base/tolerances.h"

typedef struct wedge {
    const imp_wedge_question *of;
    double *r, *w; /* 3 count each */
    double most;   /* s . W s */
} wedge;

static double entry_of(const wedge *g, int i, int j)
{
    return g->of->w[(size_t)i * 3 * (size_t)g->of->count + (size_t)j];
}

/* The extreme pressure at contact c against w; m_c. */
static double find_extreme(const wedge *g, int c, double pressure[3])
{
    const double mu = g->of->friction[c], *w = &g->w[3 * c], across = hypot(w[1], w[2]);
    pressure[0] = 1;
    for (int j = 1; j < 3; j++) pressure[j] = across > 0 ? -mu * w[j] / across : 0;
    return w[0] - mu * across;
}

/* r goes the part `along` of its way to the pressure at contact c. */
static void go_towards(wedge *g, int c, const double pressure[3], double along)
{
    const int width = 3 * g->of->count;
    for (int i = 0; i < width; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++) sum += entry_of(g, i, 3 * c + j) * pressure[j];
        g->r[i] *= 1 - along;
        g->w[i] += along * (sum - g->w[i]);
    }
    for (int j = 0; j < 3; j++) g->r[3 * c + j] += along * pressure[j];
}

static bool takes_part(const wedge *g, int c) { return !g->of->taken || g->of->taken[c]; }

/* One step; false: all are taken apart, or the pressures balance. *square: r . W r before it. */
static bool step_on(wedge *g, double *square)
{
    int least = -1;
    double margin = INFINITY, pressure[3], own = 0, other[3];
    *square = 0;
    for (int c = 0; c < g->of->count; c++) {
        for (int j = 0; j < 3; j++) *square += g->r[3 * c + j] * g->w[3 * c + j];
        if (!takes_part(g, c)) continue;
        const double m = find_extreme(g, c, other);
        if (m < margin) margin = m, least = c;
    }
    if (margin > IMP_WEDGE_BALANCED * g->most) *square = INFINITY;
    if (margin > IMP_WEDGE_BALANCED * g->most || *square <= IMP_WEDGE_BALANCED * g->most) return false;
    (void)find_extreme(g, least, pressure);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) own += pressure[i] * entry_of(g, 3 * least + i, 3 * least + j) * pressure[j];
    g->most = fmax(g->most, own);
    /* |r + a (s - r)|^2 in W is least at */
    const double length = *square - 2 * margin + own;
    go_towards(g, least, pressure, length > 0 ? fmin(1, (*square - margin) / length) : 1);
    return true;
}

double imp_encounter_wedged(const imp_wedge_question *question, double *room)
{
    const int width = 3 * question->count;
    wedge g = {.of = question, .r = room, .w = room + width};
    int first = 0;
    while (first < question->count && !takes_part(&g, first)) first++;
    if (first == question->count) return INFINITY;
    for (int i = 0; i < width; i++) g.r[i] = g.w[i] = 0;
    const double normal[3] = {1, 0, 0};
    go_towards(&g, first, normal, 1);
    g.most = entry_of(&g, 3 * first, 3 * first);
    double square = 0;
    const long steps = question->steps > 0 ? question->steps : IMP_WEDGE_STEPS;
    for (long k = 0; k < steps && step_on(&g, &square); k++) {
    }
    return square / g.most;
}
