/* SPDX-License-Identifier: MIT
 *
 * What sticks, and what the others' forces make of it.
 *
 * Sticking components S, forces D of the others: f_S = d lambda - W_SS^+ (W_SD f_D + W_SS d lambda), so that u_S' = 0.
 * The ratios d are zero where W_SS has full rank; where it has not, friction is not unique, and they keep it inside its
 * discs: a choice that the cone solver made.
 *
 * The least |sum G^T f| in M^-1 over the discs |f_c| <= mu lambda_c, lambda known, is a cone problem too: each normal
 * row is set apart, u_n = d (r_n - lambda), so that r_n = lambda; then u_t = 0 within the disc, or f against u_t on its
 * rim. It is convex: u_t' is unique.
 *
 * Slip goes straight where nothing turns it: the response across it vanishes for every force that is there, each
 * against its own direction; or where the contact is about to open, and too little of its friction is left. (Slip that
 * begins by and by there, from no acceleration, is a series that holds for no time.)
 */
#include "contact/springs.h"

#include <float.h>
#include <math.h>
#include "base/tolerances.h"
#include "contact/least.h"

static double entry(const imp_springs *s, int i, int j) { return s->w[(size_t)i * 3 * (size_t)s->count + (size_t)j]; }

static bool presses(const imp_spring *c) { return c->normal != IMP_SPRING_OPEN; }

double imp_springs_row(const imp_springs *s, int i)
{
    double sum = 0;
    for (int k = s->row_start[i]; k < s->row_start[i + 1]; k++) sum += s->value[k] * s->now[s->column[k]];
    return sum;
}

/* ---- what sticks ---- */

void imp_springs_tie(imp_springs *s)
{
    s->stick_count = 0;
    for (int i = 0; i < s->count; i++)
        if (presses(&s->springs[i]) && s->springs[i].slip == IMP_SPRING_STICKS)
            for (int j = 1; j < 3; j++) s->stick[s->stick_count++] = 3 * i + j;
    s->deficient = false;
    if (s->stick_count > 0)
        s->deficient = imp_least_inverse(s->w, 3 * s->count, s->stick, s->stick_count, IMP_SPRINGS_RANK, s->factor,
                                         s->inverse) < s->stick_count;
    s->chosen = s->chosen || s->deficient;
}

/* ---- forces ---- */

/* The sticking components of `now` from the others. */
static void hold_now(imp_springs *s)
{
    const int n = s->stick_count;
    for (int i = 0; i < n; i++) {
        const int contact = s->stick[i] / 3;
        s->now[s->stick[i]] = s->springs[contact].along[s->stick[i] % 3 - 1] * s->now[3 * contact];
    }
    for (int i = 0; i < n; i++) s->scratch[i] = imp_springs_row(s, s->stick[i]);
    for (int i = 0; i < n; i++) {
        double sum = 0;
        for (int j = 0; j < n; j++) sum += s->inverse[i * n + j] * s->scratch[j];
        s->now[s->stick[i]] -= sum;
    }
}

void imp_springs_hold(imp_springs *s, int k)
{
    for (int i = 0; i < s->count && k >= 0; i++) {
        const imp_spring *c = &s->springs[i];
        const bool slips = presses(c) && c->slip >= IMP_SPRING_SLIDES;
        s->now[3 * i] = presses(c) ? c->push[0][k] : 0;
        for (int j = 1; j < 3; j++) s->now[3 * i + j] = slips ? c->push[j][k] : 0;
    }
    hold_now(s);
    for (int i = 0; i < s->stick_count && k >= 0; i++)
        s->springs[s->stick[i] / 3].push[s->stick[i] % 3][k] = s->now[s->stick[i]];
}

static void find_direction(const imp_spring *c, double e[2])
{
    const double speed = hypot(c->u[1], c->u[2]);
    for (int j = 0; j < 2; j++) e[j] = c->slip == IMP_SPRING_SLIDES ? c->u[1 + j] / speed : c->along[j];
}

void imp_springs_forces(imp_springs *s)
{
    for (int i = 0; i < s->count; i++) {
        const imp_spring *c = &s->springs[i];
        double e[2] = {0, 0};
        s->now[3 * i] = presses(c) ? c->kappa * pow(c->x, s->exponent) : 0;
        if (presses(c) && c->slip >= IMP_SPRING_SLIDES) find_direction(c, e);
        for (int j = 0; j < 2; j++) s->now[3 * i + 1 + j] = -c->friction * s->now[3 * i] * e[j];
    }
    hold_now(s);
}

/* ---- what sticks and what slips ---- */

static bool within(const imp_springs *s, int i)
{
    const double bound = s->springs[i].friction * s->now[3 * i];
    return hypot(s->now[3 * i + 1], s->now[3 * i + 2]) <= bound;
}

static bool undecided(const imp_spring *c) { return presses(c) && c->friction > 0 && c->still; }

/* All that are still stick, if friction can hold them with the ratios there are. */
static bool all_stick(imp_springs *s)
{
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        if (!undecided(c)) continue;
        c->slip = IMP_SPRING_STICKS;
        c->along[0] = c->along[1] = 0;
    }
    imp_springs_tie(s);
    imp_springs_forces(s);
    for (int i = 0; i < s->count; i++)
        if (undecided(&s->springs[i]) && !within(s, i)) return false;
    return true;
}

/* The cone problem of the undecided contacts: which[n], w, q and frictions of the solver's room. */
static imp_cone_problem make_discs(imp_springs *s, const int *which, int n, double *w, double *q, double *friction)
{
    const size_t width = 3 * (size_t)n;
    double mean = 0;
    for (int a = 0; a < n; a++) {
        for (int j = 1; j < 3; j++) s->now[3 * which[a] + j] = 0;
        mean += entry(s, 3 * which[a] + 1, 3 * which[a] + 1) / n;
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
                    w[(row + j) * width + 3 * (size_t)b + k] = entry(s, 3 * which[a] + (int)j, 3 * which[b] + (int)k);
        }
    }
    return (imp_cone_problem){.count = n, .w = w, .q = q, .friction = friction};
}

/* One contact's answer; size: of accelerations. */
static void take_disc(imp_spring *c, imp_cone_mode mode, const double *r, const double *a, double size)
{
    const double rate = hypot(a[1], a[2]), held = hypot(r[1], r[2]);
    if (mode == IMP_CONE_STICKS || (rate == 0 && held == 0)) {
        c->slip = IMP_SPRING_STICKS;
        for (int j = 0; j < 2; j++) c->along[j] = r[1 + j] / r[0];
        return;
    }
    c->slip = IMP_SPRING_BEGINS;
    c->weak = rate <= IMP_SPRINGS_WEAK * size && held > 0;
    for (int j = 0; j < 2; j++) c->along[j] = c->weak ? -r[1 + j] / held : a[1 + j] / rate;
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
    if (o.status != IMP_CONE_SOLVED && o.status != IMP_CONE_INEXACT) return false;
    double size = 0;
    for (size_t i = 0; i < width; i++) size = fmax(size, fabs(q[i]));
    for (int k = 0; k < n; k++) take_disc(&s->springs[which[k]], modes[k], &r[3 * k], &a[3 * k], size);
    imp_springs_tie(s);
    for (int k = 0; k < n; k++) /* of full rank: no choice */
        if (!s->deficient && s->springs[which[k]].slip == IMP_SPRING_STICKS)
            s->springs[which[k]].along[0] = s->springs[which[k]].along[1] = 0;
    return true;
}

/* ---- straight slip ---- */

/* The response across e at contact c to every component, stick answering. */
static void find_across(imp_springs *s, int c, const double e[2], double *row)
{
    const int n = s->stick_count, width = 3 * s->count;
    for (int j = 0; j < width; j++) row[j] = e[0] * entry(s, 3 * c + 2, j) - e[1] * entry(s, 3 * c + 1, j);
    for (int a = 0; a < n; a++) {
        s->scratch[a] = 0;
        for (int b = 0; b < n; b++) s->scratch[a] += s->inverse[a * n + b] * row[s->stick[b]];
    }
    for (int a = 0; a < n; a++)
        for (int j = 0; j < width; j++) row[j] -= s->scratch[a] * entry(s, s->stick[a], j);
}

/* Whether the contact opens before its friction could change a velocity by more than rounding: in the time x/u_n its
 * force falls from lambda to nothing. */
static bool is_spent(const imp_springs *s, int c)
{
    const imp_spring *own = &s->springs[c];
    if (!(own->u[0] > 0)) return false;
    const double left = own->friction * own->kappa * pow(own->x, s->exponent) * own->x / own->u[0];
    return left * fmax(entry(s, 3 * c + 1, 3 * c + 1), entry(s, 3 * c + 2, 3 * c + 2)) <= IMP_SPRINGS_SPENT;
}

/* Whether nothing that presses turns the slip of contact c. */
static bool goes_straight(imp_springs *s, int c)
{
    double e[2], size = 0, *row = s->now;
    if (is_spent(s, c)) return true;
    find_direction(&s->springs[c], e);
    for (int j = 0; j < 3 * s->count; j++)
        size = fmax(size, fmax(fabs(entry(s, 3 * c + 1, j)), fabs(entry(s, 3 * c + 2, j))));
    const double bound = IMP_SPRINGS_STRAIGHT * size;
    find_across(s, c, e, row);
    for (int d = 0; d < s->count; d++) {
        const imp_spring *other = &s->springs[d];
        if (!presses(other)) continue;
        double along[2] = {0, 0}, part = row[3 * d];
        if (other->slip >= IMP_SPRING_SLIDES) {
            find_direction(other, along);
            part -= other->friction * (along[0] * row[3 * d + 1] + along[1] * row[3 * d + 2]);
            const double turned = other->friction * (along[0] * row[3 * d + 2] - along[1] * row[3 * d + 1]);
            if (other->slip != IMP_SPRING_STRAIGHT && fabs(turned) > bound) return false;
        }
        if (fabs(part) > bound) return false;
    }
    return true;
}

void imp_springs_straighten(imp_springs *s)
{
    for (int i = 0; i < s->count; i++) { /* all that slip, until one is found that does not */
        imp_spring *c = &s->springs[i];
        if (!presses(c) || c->slip < IMP_SPRING_SLIDES) continue;
        find_direction(c, c->along);
        c->slip = IMP_SPRING_STRAIGHT;
    }
    bool again = true;
    while (again) {
        again = false;
        for (int i = 0; i < s->count; i++) {
            imp_spring *c = &s->springs[i];
            if (!presses(c) || c->slip != IMP_SPRING_STRAIGHT || goes_straight(s, i)) continue;
            c->slip = c->still ? IMP_SPRING_BEGINS : IMP_SPRING_SLIDES;
            again = true;
        }
    }
}
