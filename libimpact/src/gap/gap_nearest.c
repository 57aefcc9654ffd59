/* SPDX-License-Identifier: MIT
 *
 * The point of c + B - A nearest to 0, by simplices (Gilbert, Johnson & Keerthi 1988) whose nearest points come from
 * signed volumes (Montanari, Petrinic & Barbieri 2017). The normal is made of the features at the end: a face's, two
 * edges' cross, or the nearest point itself, at right angles to the edge it lies on.
 */
#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include "gap/gap_core.h"
#include <string.h>

typedef struct tips {
    int count;
    imp_core_tip tip[4];
    double share[4];
} tips;

static void take_off(const double a[3], const double b[3], double d[3])
{
    for (int k = 0; k < 3; k++) d[k] = a[k] - b[k];
}

static void nearest_of(const tips *s, double v[3])
{
    for (int k = 0; k < 3; k++) {
        v[k] = 0;
        for (int i = 0; i < s->count; i++) v[k] += s->share[i] * s->tip[i].w[k];
    }
}

static void keep_tips(tips *s, int i, int j, int k)
{
    const int index[3] = {i, j, k};
    imp_core_tip kept[3];
    int count = 0;
    for (int t = 0; t < 3; t++)
        if (index[t] >= 0) kept[count++] = s->tip[index[t]];
    memcpy(s->tip, kept, (size_t)count * sizeof kept[0]);
    s->count = count;
}

static void reduce_segment(tips *s)
{
    double t[3];
    take_off(s->tip[1].w, s->tip[0].w, t);
    const double square = imp_dot(t, t), part = -imp_dot(s->tip[0].w, t);
    if (!(part > 0) || !(square > 0)) {
        keep_tips(s, 0, -1, -1), s->share[0] = 1;
    } else if (part >= square) {
        keep_tips(s, 1, -1, -1), s->share[0] = 1;
    } else {
        s->share[1] = part / square, s->share[0] = 1 - s->share[1];
    }
}

/* The nearest of the subsets without one tip each, of those marked. */
static void reduce_to_best(tips *s, const bool *without, void (*reduce)(tips *))
{
    double least = INFINITY;
    tips best = *s;
    for (int i = 0; i < s->count; i++) {
        if (!without[i]) continue;
        tips part = {.count = 0};
        for (int j = 0; j < s->count; j++)
            if (j != i) part.tip[part.count++] = s->tip[j];
        double v[3];
        reduce(&part);
        nearest_of(&part, v);
        if (imp_dot(v, v) < least) least = imp_dot(v, v), best = part;
    }
    *s = best;
}

static void reduce_triangle(tips *s)
{
    double ab[3], ac[3], n[3], p[3][3], cross[3], area[3];
    take_off(s->tip[1].w, s->tip[0].w, ab);
    take_off(s->tip[2].w, s->tip[0].w, ac);
    imp_cross(ab, ac, n);
    const double square = imp_dot(n, n), high = square > 0 ? imp_dot(s->tip[0].w, n) / square : 0;
    bool without[3], all = square > 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) p[i][k] = s->tip[i].w[k] - high * n[k]; /* from 0's foot in the plane */
    for (int i = 0; i < 3; i++) {
        imp_cross(p[(i + 1) % 3], p[(i + 2) % 3], cross);
        area[i] = imp_dot(cross, n);
        without[i] = !(area[i] > 0);
        all = all && !without[i];
    }
    if (!all) {
        const bool any[3] = {true, true, true};
        reduce_to_best(s, square > 0 ? without : any, reduce_segment);
        return;
    }
    const double sum = area[0] + area[1] + area[2];
    for (int i = 0; i < 3; i++) s->share[i] = area[i] / sum;
}

/* True: 0 is inside. */
static bool reduce_tetrahedron(tips *s)
{
    double cross[3], part[4], edge[3][3];
    const double *a = s->tip[0].w, *b = s->tip[1].w, *c = s->tip[2].w, *d = s->tip[3].w;
    imp_cross(c, d, cross);
    part[0] = imp_dot(b, cross), part[1] = -imp_dot(a, cross);
    imp_cross(b, d, cross);
    part[2] = imp_dot(a, cross);
    imp_cross(b, c, cross);
    part[3] = -imp_dot(a, cross);
    for (int i = 0; i < 3; i++) take_off(s->tip[i + 1].w, a, edge[i]);
    imp_cross(edge[1], edge[2], cross);
    const double volume = imp_dot(edge[0], cross);
    bool without[4], all = true;
    for (int i = 0; i < 4; i++) {
        without[i] = !(volume > 0 ? part[i] > 0 : part[i] < 0);
        all = all && !without[i];
    }
    if (all) return true;
    if (volume == 0) without[0] = without[1] = without[2] = without[3] = true;
    reduce_to_best(s, without, reduce_triangle);
    return false;
}

/* Whether both vertices differ: no side of a feature, where two edges cross. */
static bool diagonal(const tips *s, int i, int j)
{
    const int *v = s->tip[i].vertex, *u = s->tip[j].vertex;
    return v[0] != u[0] && v[1] != u[1];
}

/* The direction of a side of the simplex: of a body's edge where the other's vertex stays. */
static void side_of(const imp_core_pair *pair, const tips *s, int i, int j, double t[3])
{
    const int *v = s->tip[i].vertex, *u = s->tip[j].vertex;
    double from[3], to[3];
    const int body = v[0] == u[0] ? 1 : 0;
    if (v[1 - body] != u[1 - body]) {
        take_off(s->tip[j].w, s->tip[i].w, t);
        return;
    }
    imp_core_place(pair, body, v[body], from);
    imp_core_place(pair, body, u[body], to);
    take_off(body ? to : from, body ? from : to, t);
}

/* A vector along the normal that the simplex fixes, or of v made normal to its side. */
static bool normal_of(const imp_core_pair *pair, const tips *s, const double v[3], double n[3])
{
    double t[3], u[3];
    memcpy(n, v, 3 * sizeof *n);
    if (s->count == 1) return false;
    side_of(pair, s, 0, 1, t);
    if (s->count == 2) {
        for (int again = 0; again < 2; again++) {
            const double part = imp_dot(n, t) / imp_dot(t, t);
            for (int k = 0; k < 3; k++) n[k] -= part * t[k];
        }
        return false;
    }
    side_of(pair, s, 0, 2, u);
    if (diagonal(s, 0, 1))
        side_of(pair, s, 1, 2, t);
    else if (diagonal(s, 0, 2))
        side_of(pair, s, 1, 2, u);
    imp_core_cross(t, u, n);
    if (imp_dot(n, v) < 0)
        for (int k = 0; k < 3; k++) n[k] = -n[k];
    return true;
}

static void give_points(const imp_core_pair *pair, const tips *s, double x[2][3])
{
    memset(x, 0, 2 * sizeof x[0]);
    for (int i = 0; i < s->count; i++)
        for (int body = 0; body < 2; body++) {
            double p[3];
            imp_core_place(pair, body, s->tip[i].vertex[body], p);
            for (int k = 0; k < 3; k++) x[body][k] += s->share[i] * p[k];
        }
}

static void offer_normal(const imp_core_pair *pair, const double n[3], bool firm, imp_core_gap *answer)
{
    const double length = imp_norm(n);
    imp_core_tip tip;
    if (!(length > 0)) return;
    const double unit[3] = {n[0] / length, n[1] / length, n[2] / length};
    const double g = imp_core_height_between(pair, unit, &tip);
    if (!(g > answer->lower)) return;
    answer->lower = g, answer->firm = firm;
    memcpy(answer->n, unit, sizeof unit);
}

bool imp_core_nearest(const imp_core_pair *pair, imp_core_gap *answer)
{
    tips s = {.count = 0};
    double v[3], n[3], square = INFINITY;
    memcpy(v, answer->n, sizeof v);
    for (int step = 0; step < IMP_CORE_STEPS; step++) {
        imp_core_tip tip;
        bool known = false;
        imp_core_height_between(pair, v, &tip);
        for (int i = 0; i < s.count; i++)
            known = known || (s.tip[i].vertex[0] == tip.vertex[0] && s.tip[i].vertex[1] == tip.vertex[1]);
        if (known || (s.count > 0 && imp_dot(v, v) - imp_dot(v, tip.w) <= IMP_CORE_CLOSED * pair->reach * imp_norm(v)))
            break;
        const tips before = s;
        s.tip[s.count++] = tip, s.share[0] = 1;
        if (s.count == 4 ? reduce_tetrahedron(&s) : false) return false;
        if (s.count == 3) reduce_triangle(&s);
        if (s.count == 2) reduce_segment(&s);
        double next[3];
        nearest_of(&s, next);
        if (!(imp_dot(next, next) < square)) {
            s = before;
            break;
        }
        square = imp_dot(next, next);
        memcpy(v, next, sizeof v);
        if (!(square > 0)) return false;
    }
    answer->upper = imp_norm(v);
    give_points(pair, &s, answer->x);
    offer_normal(pair, v, false, answer);
    const bool firm = normal_of(pair, &s, v, n);
    offer_normal(pair, n, firm, answer);
    return true;
}
