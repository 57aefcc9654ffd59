/* SPDX-License-Identifier: MIT
 *
 * What sticks and what slips of the contacts that press and are still.
 *
 * The least |sum G^T f| in M^-1 over the discs |f_c| <= mu lambda_c, lambda known, is a cone problem: each normal row
 * is set apart, u_n = d (r_n - lambda), so that r_n = lambda; then u_t = 0 within the disc, or f against u_t on its
 * rim. It is convex: u_t' is unique.
 *
 * Where u_t' = 0 leaves f free, friction holds as long as some f does (springs_centre.c), up to 1 + IMP_SPRINGS_OVER of
 * the bounds: slip that sets in by and by, from no acceleration, is begun that little later, when directions can be
 * told by its accelerations. Where f is unique it begins against f at once.
 */
#include "contact/springs.h"

#include <float.h>
#include <math.h>
#include "base/tolerances.h"

static bool undecided(const imp_spring *c) { return imp_springs_presses(c) && c->friction > 0 && c->still; }

/* The sticking contacts' friction without ratios of its own: of least norm; forces as of now. */
static void hold_plainly(imp_springs *s)
{
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        if (imp_springs_presses(c) && c->slip == IMP_SPRING_STICKS) c->along[0] = c->along[1] = 0;
    }
    imp_springs_tie(s);
    imp_springs_forces(s);
}

/* The greatest part of its bound that friction takes, forces as of now; *where: at which contact. */
static double greatest_part(const imp_springs *s, int *where)
{
    double most = 0;
    for (int i = 0; i < s->count; i++) {
        const imp_spring *c = &s->springs[i];
        if (!imp_springs_presses(c) || c->slip != IMP_SPRING_STICKS) continue;
        const double part = hypot(s->now[3 * i + 1], s->now[3 * i + 2]) / (c->friction * s->now[3 * i]);
        if (!(part <= most)) most = part, *where = i;
    }
    return most;
}

bool imp_springs_is_over(const imp_springs *s)
{
    int where;
    return s->deficient && greatest_part(s, &where) > 1 + IMP_SPRINGS_OVER;
}

/* What sticks holds, plainly or as well as it can; false: friction of *where would have to be more than its bound. */
static bool hold(imp_springs *s, int *where)
{
    hold_plainly(s);
    const double plain = greatest_part(s, where);
    if (!s->deficient) return plain <= 1;
    if (plain <= 0.5) return true; /* with half of what there is to spare there is no need to look further */
    imp_springs_centre(s);
    imp_springs_forces(s);
    return greatest_part(s, where) <= 1 + 0.5 * IMP_SPRINGS_OVER;
}

/* From no acceleration, against the friction that held it. */
static void begin_weakly(imp_spring *c, double x, double y)
{
    const double size = hypot(x, y);
    c->slip = IMP_SPRING_BEGINS;
    c->weak = true;
    c->along[0] = -x / size, c->along[1] = -y / size;
}

/* Contacts begin to slip until friction holds the others. */
static void hold_what_can_be(imp_springs *s)
{
    int where = 0;
    while (!hold(s, &where) && s->deficient)
        begin_weakly(&s->springs[where], s->now[3 * where + 1], s->now[3 * where + 2]);
}

/* All that are still stick, if friction can hold them. */
static bool all_stick(imp_springs *s)
{
    int where;
    for (int i = 0; i < s->count; i++)
        if (undecided(&s->springs[i])) s->springs[i].slip = IMP_SPRING_STICKS;
    return hold(s, &where);
}

/* The cone problem of the undecided contacts: which[n], w, q and frictions of the solver's room. */
static imp_cone_problem make_discs(imp_springs *s, const int *which, int n, double *w, double *q, double *friction)
{
    const size_t width = 3 * (size_t)n;
    double mean = 0;
    for (int a = 0; a < n; a++) {
        for (int j = 1; j < 3; j++) s->now[3 * which[a] + j] = 0;
        mean += imp_springs_entry(s, 3 * which[a] + 1, 3 * which[a] + 1) / n;
    }
    for (size_t i = 0; i < width * width; i++) w[i] = 0;
    for (int a = 0; a < n; a++) {
        const size_t row = 3 * (size_t)a;
        friction[a] = s->springs[which[a]].friction;
        w[row * width + row] = mean;
        q[row] = -mean * s->now[3 * which[a]];
        for (size_t j = 1; j < 3; j++) {
            q[row + j] = imp_springs_row(s, 3 * which[a] + (int)j);
            for (int b = 0; b < n; b++)
                for (size_t k = 1; k < 3; k++)
                    w[(row + j) * width + 3 * (size_t)b + k] =
                        imp_springs_entry(s, 3 * which[a] + (int)j, 3 * which[b] + (int)k);
        }
    }
    return (imp_cone_problem){.count = n, .w = w, .q = q, .friction = friction};
}

/* One contact's answer; size: of accelerations. Whether it slips from none: its friction is on the rim. */
static bool take_disc(imp_spring *c, imp_cone_mode mode, const double *r, const double *a, double size)
{
    const double rate = hypot(a[1], a[2]), held = hypot(r[1], r[2]);
    c->weak = rate <= IMP_SPRINGS_WEAK * size;
    c->slip = c->weak ? IMP_SPRING_STICKS : IMP_SPRING_BEGINS;
    for (int j = 0; j < 2; j++) c->along[j] = !c->weak ? a[1 + j] / rate : held > 0 ? -r[1 + j] / held : 0;
    return c->weak && mode == IMP_CONE_SLIDES && held > 0;
}

/* Reactions of what is still are unique: those on their rims begin to slip weakly, the others have no ratios. */
static void take_rims(imp_springs *s, const int *which, int n, const imp_cone_mode *modes)
{
    for (int k = 0; k < n; k++) {
        imp_spring *c = &s->springs[which[k]];
        if (modes[k] == IMP_CONE_SLIDES)
            c->slip = IMP_SPRING_BEGINS;
        else if (c->slip == IMP_SPRING_STICKS)
            c->along[0] = c->along[1] = 0;
    }
    imp_springs_tie(s);
}

/* One of Newton's steps for the directions of what begins; returns the most that one is turned by. */
static double turn_to_accelerations(imp_springs *s)
{
    const int n = s->begin_count;
    double *matrix = s->turning + n * n, *angle = matrix + n * n, most = 0;
    imp_springs_make_turning(s);
    imp_springs_forces(s);
    for (int c = 0; c < n; c++) {
        const int i = s->begin[c];
        const double *e = s->springs[i].along, x = imp_springs_row(s, 3 * i + 1), y = imp_springs_row(s, 3 * i + 2);
        for (int d = 0; d < n; d++) {
            const int j = s->begin[d];
            matrix[c * n + d] = s->turning[c * n + d] * s->springs[j].friction * s->now[3 * j];
        }
        matrix[c * n + c] += x * e[0] + y * e[1];
        angle[c] = y * e[0] - x * e[1];
    }
    imp_springs_gauss(matrix, angle, n);
    for (int c = 0; c < n; c++) most = fmax(most, fabs(angle[c]));
    for (int c = 0; c < n; c++) {
        double *e = s->springs[s->begin[c]].along;
        const double part = most > 0.5 ? 0.5 / most : 1, cosine = cos(part * angle[c]), sine = sin(part * angle[c]);
        const double x = cosine * e[0] - sine * e[1], y = sine * e[0] + cosine * e[1];
        e[0] = x, e[1] = y;
    }
    return most;
}

/* What begins, from accelerations, along these to rounding: the cone solver is good to 1e-13 of the largest, and
 * accelerations of slip that has just given way are little more; but friction turns with its direction, and tells it by
 * what it leaves across. */
static void point_beginnings(imp_springs *s)
{
    s->begin_count = 0;
    for (int i = 0; i < s->count; i++)
        if (imp_springs_presses(&s->springs[i]) && s->springs[i].slip == IMP_SPRING_BEGINS && !s->springs[i].weak)
            s->begin[s->begin_count++] = i;
    for (int turn = 0; turn < 8 && s->begin_count > 0 && turn_to_accelerations(s) > 4 * DBL_EPSILON; turn++) {
    }
}

bool imp_springs_choose(imp_springs *s)
{
    if (all_stick(s)) return true;
    int n = 0, *which = s->begin;
    for (int i = 0; i < s->count; i++)
        if (undecided(&s->springs[i])) which[n++] = i;
    const size_t width = 3 * (size_t)n;
    double *w = s->factor, *q = w + width * width, *r = q + width, *a = r + width, *friction = a + width;
    const imp_cone_problem problem = make_discs(s, which, n, w, q, friction);
    imp_cone_mode *modes = s->modes;
    const imp_cone_outcome o = imp_cone_solve(&problem, s->cone, r, a, modes);
    s->work += o.factorings * (double)(width * width * width);
    if (o.status != IMP_CONE_SOLVED && o.status != IMP_CONE_INEXACT) return false;
    double size = 0;
    for (size_t i = 0; i < width; i++) size = fmax(size, fabs(q[i]));
    for (int k = 0; k < n; k++) {
        const bool rim = take_disc(&s->springs[which[k]], modes[k], &r[3 * k], &a[3 * k], size);
        modes[k] = rim ? IMP_CONE_SLIDES : IMP_CONE_STICKS;
    }
    imp_springs_tie(s);
    if (s->deficient)
        hold_what_can_be(s);
    else
        take_rims(s, which, n, modes);
    point_beginnings(s);
    return true;
}
