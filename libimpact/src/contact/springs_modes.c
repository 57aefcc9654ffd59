/* SPDX-License-Identifier: MIT
 *
 * What sticks, and what the others' forces make of it.
 *
 * Sticking components S, forces D of the others: f_S = d lambda - W_SS^+ (W_SD f_D + W_SS d lambda), so that u_S' = 0.
 * The ratios d are zero where W_SS has full rank; where it has not, friction is not unique, and they keep it inside its
 * discs: springs_choose.c chooses them.
 *
 * Slip goes straight where nothing turns it: the response across it vanishes for every force that is there, each
 * against its own direction. Velocities tell its direction e to their rounding over |u_t|, and rounding grows with
 * impulses; the line that normal forces push it along, where they have one, is known from W alone. With v_d what that
 * of contact d does to u_t, it is at the angle
 *
 *     a = sum_d (v_d . e)(v_d x e) / sum_d (v_d . e)^2        (least sum_d (v_d x e')^2)
 *
 * from e, but for a^2. Where that is less than rounding, |a| |u_t| <= none, and a^2 is, e is taken to be it: slip that
 * is no more than rounding has no direction, and would be turned into that line.
 */
#include "contact/springs.h"

#include <float.h>
#include <math.h>
#include "base/tolerances.h"
#include "contact/least.h"

void imp_springs_pack_pressed(imp_springs *s)
{
    const int width = 3 * s->count;
    const imp_spring_rows *all = &s->rows, *own = &s->pressed;
    int filled = 0;
    for (int i = 0; i < width; i++) {
        own->start[i] = filled;
        for (int k = all->start[i]; k < all->start[i + 1]; k++)
            if (imp_springs_presses(&s->springs[all->column[k] / 3])) own->column[filled++] = all->column[k];
    }
    own->start[width] = filled;
}

double imp_springs_row(const imp_springs *s, int i)
{
    const imp_spring_rows *r = &s->pressed;
    const double *row = &s->w[(size_t)i * 3 * (size_t)s->count];
    double sum = 0;
    for (int k = r->start[i]; k < r->start[i + 1]; k++) sum += row[r->column[k]] * s->now[r->column[k]];
    return sum;
}

/* ---- what sticks ---- */

void imp_springs_tie(imp_springs *s)
{
    s->stick_count = 0;
    for (int i = 0; i < s->count; i++)
        if (imp_springs_presses(&s->springs[i]) && s->springs[i].slip == IMP_SPRING_STICKS)
            for (int j = 1; j < 3; j++) s->stick[s->stick_count++] = 3 * i + j;
    s->deficient = false;
    if (s->stick_count > 0)
        s->deficient = imp_least_inverse(s->w, 3 * s->count, s->stick, s->stick_count, IMP_SPRINGS_RANK, s->factor,
                                         s->inverse) < s->stick_count;
    s->chosen = s->chosen || s->deficient;
}

bool imp_springs_is_tied(const imp_springs *s)
{
    int n = 0;
    for (int i = 0; i < s->count; i++) {
        if (!imp_springs_presses(&s->springs[i]) || s->springs[i].slip != IMP_SPRING_STICKS) continue;
        if (n == s->stick_count || s->stick[n] != 3 * i + 1) return false;
        n += 2;
    }
    return n == s->stick_count;
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
        const bool slips = imp_springs_presses(c) && c->slip >= IMP_SPRING_SLIDES;
        s->now[3 * i] = imp_springs_presses(c) ? c->push[0][k] : 0;
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
        s->now[3 * i] = imp_springs_presses(c) ? c->kappa * pow(c->x, s->exponent) : 0;
        if (imp_springs_presses(c) && c->slip >= IMP_SPRING_SLIDES) find_direction(c, e);
        for (int j = 0; j < 2; j++) s->now[3 * i + 1 + j] = -c->friction * s->now[3 * i] * e[j];
    }
    hold_now(s);
}

/* ---- straight slip ---- */

/* The response across e at contact c to every component, stick answering. */
static void find_across(const imp_springs *s, int c, const double e[2], double *row)
{
    const int n = s->stick_count, width = 3 * s->count;
    for (int j = 0; j < width; j++)
        row[j] = e[0] * imp_springs_entry(s, 3 * c + 2, j) - e[1] * imp_springs_entry(s, 3 * c + 1, j);
    for (int a = 0; a < n; a++) {
        s->scratch[a] = 0;
        for (int b = 0; b < n; b++) s->scratch[a] += s->inverse[a * n + b] * row[s->stick[b]];
    }
    for (int a = 0; a < n; a++)
        for (int j = 0; j < width; j++) row[j] -= s->scratch[a] * imp_springs_entry(s, s->stick[a], j);
}

bool imp_springs_is_free(const imp_springs *s, int contact)
{
    double *row = s->factor, *x = &row[3 * contact + 1], *y = x + 1, most = 0;
    find_across(s, contact, (double[]){0, -1}, row);
    const double xx = *x, xy = *y;
    find_across(s, contact, (double[]){1, 0}, row);
    const double least = 0.5 * (xx + *y - hypot(xx - *y, 2 * xy));
    for (int i = 0; i < s->stick_count; i++) most = fmax(most, imp_springs_entry(s, s->stick[i], s->stick[i]));
    return least > IMP_SPRINGS_RANK * fmax(most, imp_springs_mobility_along(s, contact));
}

/* A response across the slip of contact c that is rounding. */
static double no_response(const imp_springs *s, int c)
{
    double size = 0;
    for (int j = 0; j < 3 * s->count; j++)
        size = fmax(size, fmax(fabs(imp_springs_entry(s, 3 * c + 1, j)), fabs(imp_springs_entry(s, 3 * c + 2, j))));
    return IMP_SPRINGS_STRAIGHT * size;
}

/* Where what sticks leaves contact c but one way to go its slip is along that: a box that lies along a capsule and
 * sticks at one of two points slips at the other across it. */
static void take_only_way(imp_springs *s, int c)
{
    double *row = s->now, *along = s->springs[c].along;
    find_across(s, c, (double[]){0, -1}, row);
    const double xx = row[3 * c + 1];
    find_across(s, c, (double[]){1, 0}, row);
    const double angle = 0.5 * atan2(2 * row[3 * c + 1], xx - row[3 * c + 2]), bound = no_response(s, c);
    double e[2] = {cos(angle), sin(angle)};
    if (e[0] * along[0] + e[1] * along[1] < 0) e[0] = -e[0], e[1] = -e[1];
    find_across(s, c, e, row);
    for (int j = 0; j < 3 * s->count; j++)
        if (fabs(row[j]) > bound) return;
    along[0] = e[0], along[1] = e[1];
}

/* Slip of contact c along the line that normal forces push it along, where it is that but for its rounding. */
static void take_line_of_pressures(imp_springs *s, int c)
{
    imp_spring *own = &s->springs[c];
    double *across = s->factor, *row = s->now, both = 0, square = 0;
    const double e[2] = {own->along[0], own->along[1]};
    find_across(s, c, e, row);
    for (int d = 0; d < s->count; d++) across[d] = row[3 * d];
    find_across(s, c, (double[]){e[1], -e[0]}, row);
    for (int d = 0; d < s->count; d++) {
        if (!imp_springs_presses(&s->springs[d])) continue;
        both += across[d] * row[3 * d], square += row[3 * d] * row[3 * d];
    }
    const double angle = square > 0 ? both / square : 0;
    if (!(fabs(angle) * hypot(own->u[1], own->u[2]) <= own->none && angle * angle <= DBL_EPSILON)) return;
    own->along[0] = e[0] - angle * e[1], own->along[1] = e[1] + angle * e[0];
}

/* Whether nothing that presses turns the slip of contact c. */
static bool goes_straight(imp_springs *s, int c)
{
    double e[2], *row = s->now;
    find_direction(&s->springs[c], e);
    const double bound = no_response(s, c);
    find_across(s, c, e, row);
    for (int d = 0; d < s->count; d++) {
        const imp_spring *other = &s->springs[d];
        if (!imp_springs_presses(other)) continue;
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
        if (!imp_springs_presses(c) || c->slip < IMP_SPRING_SLIDES) continue;
        find_direction(c, c->along);
        if (c->slip == IMP_SPRING_BEGINS) take_only_way(s, i);
        if (!c->still) take_line_of_pressures(s, i);
        c->slip = IMP_SPRING_STRAIGHT;
    }
    bool again = true;
    while (again) {
        again = false;
        for (int i = 0; i < s->count; i++) {
            imp_spring *c = &s->springs[i];
            if (!imp_springs_presses(c) || c->slip != IMP_SPRING_STRAIGHT || goes_straight(s, i)) continue;
            c->slip = c->still ? IMP_SPRING_BEGINS : IMP_SPRING_SLIDES;
            again = true;
        }
    }
}
