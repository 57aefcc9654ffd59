/* SPDX-License-Identifier: MIT
 *
 * Whether a motion v takes all of some contacts apart, friction notwithstanding: (G v)_n > mu |(G v)_t|. None does
 * where pressures of their own, r in K, sum r_n = 1, balance: G^T r = 0 (Gordan's theorem, over cones). Where one does
 * the cone problem of compression has a solution whatever the velocities are (Acary, Cadoux, Lemarechal & Malick 2011).
 * The least |G^T r|^2 = r . W r is looked for among a few extreme pressures s_i and all between them (Wolfe 1976):
 *
 *     r = sum a_i s_i, sum a_i = 1, of least r . W r:   (D^2 1 1^T + S) a ~ 1,   S_ij = s_i . W s_j,  D^2 their largest
 *
 * where some a_i <= 0 r goes towards it as far as all a_i >= 0, and those with 0 go. Then comes the extreme pressure
 *
 *     at the contact of the least m_c = w_n - mu |w_t|, w = W r, the pressure n - mu w_t/|w_t|
 *
 * All m_c > 0 is a proof that some motion does: v = M^-1 G^T r. Pressures that balance are one that none does, both but
 * for rounding of w.
 */
#include "contact/encounter.h"

#include <string.h>
#include "base/tolerances.h"

/* The extreme pressure at a contact, and what of it is in r: now, and where that is least. */
typedef struct extreme {
    double pressure[3], part, wanted;
    int contact;
} extreme;

typedef struct wedge {
    const imp_wedge_question *of;
    double *r, *w; /* 3 count each */
    double most;   /* D^2 */
    int count;     /* extremes in r */
    extreme *extremes;
    double *factor; /* of D^2 1 1^T + S: lower triangle, by rows */
} wedge;

/* No more extremes than W has rows, and one, are independent. */
static size_t most_extremes(size_t contacts) { return 3 * contacts + 1; }

size_t imp_encounter_wedge_size(size_t contacts)
{
    const size_t most = most_extremes(contacts);
    return 6 * contacts + most * sizeof(extreme) / sizeof(double) + most * (most + 1) / 2 + 1;
}

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

static double product_of(const wedge *g, const extreme *a, const extreme *b)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum += a->pressure[i] * entry_of(g, 3 * a->contact + i, 3 * b->contact + j) * b->pressure[j];
    return sum;
}

/* r and w of the extremes' parts; r . W r. */
static double find_pressures(wedge *g)
{
    const int width = 3 * g->of->count;
    double square = 0;
    for (int i = 0; i < width; i++) g->r[i] = g->w[i] = 0;
    for (int k = 0; k < g->count; k++) {
        const extreme *e = &g->extremes[k];
        for (int j = 0; j < 3; j++) g->r[3 * e->contact + j] += e->part * e->pressure[j];
        for (int i = 0; i < width; i++)
            for (int j = 0; j < 3; j++) g->w[i] += e->part * entry_of(g, i, 3 * e->contact + j) * e->pressure[j];
    }
    for (int i = 0; i < width; i++) square += g->r[i] * g->w[i];
    return square;
}

/* The parts that are wanted, by Cholesky; false: the extremes are not told apart. */
static bool want_least(wedge *g)
{
    double sum = 0;
    for (int i = 0; i < g->count; i++) {
        double *row = &g->factor[i * (i + 1) / 2];
        g->extremes[i].wanted = 1;
        for (int j = 0; j <= i; j++) {
            const double *other = &g->factor[j * (j + 1) / 2];
            double left = g->most + product_of(g, &g->extremes[i], &g->extremes[j]);
            for (int k = 0; k < j; k++) left -= row[k] * other[k];
            if (i == j && !(left > IMP_WEDGE_ROUNDING * g->most)) return false;
            row[j] = i == j ? sqrt(left) : left / other[j];
            if (j < i) g->extremes[i].wanted -= row[j] * g->extremes[j].wanted;
        }
        g->extremes[i].wanted /= row[i];
    }
    for (int i = g->count - 1; i >= 0; i--) {
        for (int k = i + 1; k < g->count; k++)
            g->extremes[i].wanted -= g->factor[k * (k + 1) / 2 + i] * g->extremes[k].wanted;
        g->extremes[i].wanted /= g->factor[i * (i + 1) / 2 + i];
        sum += g->extremes[i].wanted;
    }
    for (int i = 0; i < g->count; i++) g->extremes[i].wanted /= sum;
    return true;
}

/* r as far towards what is wanted as all parts are >= 0; whether that is all the way. Those without a part go. */
static bool go_there(wedge *g)
{
    double along = 1;
    int left = 0, last = -1;
    for (int i = 0; i < g->count; i++) {
        const extreme *e = &g->extremes[i];
        if (e->wanted > 0 || !(e->part / (e->part - e->wanted) < along)) continue;
        along = e->part / (e->part - e->wanted);
        last = i;
    }
    for (int i = 0; i < g->count; i++) {
        extreme e = g->extremes[i];
        e.part += along * (e.wanted - e.part);
        if (i != last && e.part > 0) g->extremes[left++] = e;
    }
    g->count = left;
    return last < 0;
}

static bool takes_part(const wedge *g, int c) { return !g->of->taken || g->of->taken[c]; }

static void add_extreme(wedge *g, int c)
{
    extreme *e = &g->extremes[g->count];
    *e = (extreme){.contact = c, .part = g->count == 0};
    (void)find_extreme(g, c, e->pressure);
    g->most = fmax(g->most, product_of(g, e, e));
    g->count++;
}

/* One step; false: all are taken apart (*loose), or the pressures balance, or are the least. */
static bool step_on(wedge *g, bool *loose)
{
    int least = -1;
    double margin = INFINITY, other[3];
    const double square = find_pressures(g), none = IMP_WEDGE_BALANCED * g->most;
    for (int c = 0; c < g->of->count; c++) {
        const double m = takes_part(g, c) ? find_extreme(g, c, other) : INFINITY;
        if (m < margin) margin = m, least = c;
    }
    *loose = margin > none;
    if (*loose || square <= none || (size_t)g->count == most_extremes((size_t)g->of->count)) return false;
    add_extreme(g, least);
    do {
        if (!want_least(g)) return false;
    } while (!go_there(g));
    return true;
}

bool imp_encounter_wedged(const imp_wedge_question *question, double *room)
{
    const size_t contacts = (size_t)question->count, most = most_extremes(contacts);
    wedge g = {.of = question, .r = room, .w = room + 3 * contacts, .factor = room + 6 * contacts};
    g.extremes = (extreme *)(g.factor + most * (most + 1) / 2 + 1);
    int first = 0;
    while (first < question->count && !takes_part(&g, first)) first++;
    if (first == question->count) return false;
    memset(g.w, 0, 3 * contacts * sizeof *g.w);
    add_extreme(&g, first);
    bool loose = false;
    for (int k = 0; k < IMP_WEDGE_STEPS && step_on(&g, &loose); k++) {
    }
    return !loose;
}
