/* SPDX-License-Identifier: MIT
 *
 * The Taylor series of all contacts in tau, order by order, a prime being d/dtau and G = g F:
 *
 *     x' = -g u_n,  u' = W G,  p' = G                                  k + 1 from k
 *     lambda = kappa x^eta:   k x_0 lambda_k = sum_i (i eta - k + i) x_i lambda_(k-i)       (Leibniz)
 *     g = w:  w' = -u_n/2,  x = w w,  lambda = kappa x w
 *     s s = u_t . u_t,   g lambda = r s,   G_t = -mu r u_t             g = s: r = lambda
 *     (or g = s times a power of two, where s is next to nothing)
 *     straight: G_t = -mu g lambda e
 *     u_t that begins with 0: u_t = s e(theta), e theta' turning,  s' = G-acceleration along e,  s theta' = across it:
 *         order k gives theta_k from (diag((k + 1) |a|) + mu g lambda W_across) theta_k = rest, then s_(k+1)
 *
 * a, the acceleration at the beginning, is along e; it vanishes where stick gives way by and by (s ~ t^2). There the
 * series is asymptotic, and its last terms bound its length as they do elsewhere.
 */
#include "contact/springs.h"

#include <math.h>
#include <string.h>
#include "base/tolerances.h"

/* Terms that bound a step's length: of Hertz's force from its closing only every fifth is there. Of term k the part
 * k/IMP_SPRINGS_ORDER of the digits is asked, as of terms that fall geometrically. */
enum { LAST = 6 };

/* sum_(i=from)^to a_i b_(k-i) */
static double convolve(const double *a, const double *b, int k, int from, int to)
{
    double even = 0, odd = 0;
    int i = from;
    for (; i < to; i += 2) {
        even += a[i] * b[k - i];
        odd += a[i + 1] * b[k - i - 1];
    }
    return even + odd + (i == to ? a[i] * b[k - i] : 0);
}

static double cauchy(const double *a, const double *b, int k) { return convolve(a, b, k, 0, k); }

/* sum_i a_i a_(k-i), i = 1 ... k - 1 */
static double inner_square(const double *a, int k)
{
    double sum = 0;
    for (int i = 1; 2 * i < k; i++) sum += a[i] * a[k - i];
    sum *= 2;
    return k >= 2 && k % 2 == 0 ? sum + a[k / 2] * a[k / 2] : sum;
}

/* ---- normal ---- */

static double power_term(const imp_spring *c, double exponent, int k)
{
    if (k == 0) return c->kappa * pow(c->depth[0], exponent);
    double sum = 0;
    for (int i = 1; i <= k; i++) sum += (i * exponent - (k - i)) * c->depth[i] * c->force[k - i];
    return sum / (k * c->depth[0]);
}

static void find_force(const imp_springs *s, imp_spring *c, bool leads, int k)
{
    if (leads) {
        c->depth[k] = k == 0 ? c->x : inner_square(c->root, k) + 2 * c->root[0] * c->root[k];
        c->force[k] = c->kappa * cauchy(c->depth, c->root, k);
    } else {
        c->force[k] = s->exponent == 1 ? c->kappa * c->depth[k] : power_term(c, s->exponent, k);
    }
}

/* ---- slip ---- */

static void find_speed(imp_spring *c, int k)
{
    const double *x = c->velocity[1], *y = c->velocity[2];
    if (k == 0) {
        c->speed[0] = hypot(x[0], y[0]);
        return;
    }
    const double square = inner_square(x, k) + inner_square(y, k) + 2 * (x[0] * x[k] + y[0] * y[k]);
    c->speed[k] = (square - inner_square(c->speed, k)) / (2 * c->speed[0]);
}

/* stretch: of the factor where it leads, else 1. */
static void find_friction(imp_spring *c, bool leads, double stretch, int k)
{
    const double *ratio = c->force;
    if (!leads) {
        c->ratio[k] = (c->push[0][k] - convolve(c->speed, c->ratio, k, 1, k)) / c->speed[0];
        ratio = c->ratio;
    }
    for (int i = 1; i < 3; i++) c->push[i][k] = -c->friction * stretch * cauchy(ratio, c->velocity[i], k);
}

/* Cosine and sine of the angle, order k, its own term as it stands. */
static void find_turn(imp_spring *c, int k)
{
    if (k == 0) {
        c->cosine[0] = 1;
        c->sine[0] = 0;
        return;
    }
    double cosine = 0, sine = 0;
    for (int i = 1; i <= k; i++) {
        cosine -= i * c->angle[i] * c->sine[k - i];
        sine += i * c->angle[i] * c->cosine[k - i];
    }
    c->cosine[k] = cosine / k;
    c->sine[k] = sine / k;
}

/* Friction against cosine along + sine across. */
static void find_turned_friction(imp_spring *c, int k)
{
    const double against = -c->friction * cauchy(c->push[0], c->cosine, k),
                 across = -c->friction * cauchy(c->push[0], c->sine, k);
    c->push[1][k] = against * c->along[0] - across * c->along[1];
    c->push[2][k] = against * c->along[1] + across * c->along[0];
}

/* ---- one order ---- */

static const double *find_factor(const imp_springs *s)
{
    const imp_spring *c = &s->springs[s->leader];
    return s->lead == IMP_SPRING_ROOT ? c->root : s->lead == IMP_SPRING_SPEED ? c->speed : NULL;
}

static void find_pushes(imp_springs *s, const double *factor, int k)
{
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        if (c->normal == IMP_SPRING_OPEN) continue;
        const bool root = s->lead == IMP_SPRING_ROOT && s->leader == i,
                   speed = s->lead == IMP_SPRING_SPEED && s->leader == i;
        find_force(s, c, root, k);
        c->push[0][k] = factor ? s->stretch * cauchy(factor, c->force, k) : c->force[k];
        switch (c->slip) {
        case IMP_SPRING_SLIDES: find_friction(c, speed, speed ? s->stretch : 1, k); break;
        case IMP_SPRING_STRAIGHT:
            for (int j = 0; j < 2; j++) c->push[1 + j][k] = -c->friction * c->push[0][k] * c->along[j];
            break;
        case IMP_SPRING_BEGINS:
            c->angle[k] = 0;
            find_turn(c, k);
            find_turned_friction(c, k);
            break;
        case IMP_SPRING_SMOOTH:
        case IMP_SPRING_STICKS: break;
        }
    }
}

/* ---- slip that begins ---- */

void imp_springs_make_turning(imp_springs *s)
{
    const int n = s->begin_count;
    for (int d = 0; d < n; d++) {
        for (int i = 0; i < 3 * s->count; i++) s->now[i] = 0;
        const imp_spring *own = &s->springs[s->begin[d]];
        s->now[3 * s->begin[d] + 1] = -own->along[1];
        s->now[3 * s->begin[d] + 2] = own->along[0];
        imp_springs_hold(s, -1);
        for (int c = 0; c < n; c++) {
            const imp_spring *other = &s->springs[s->begin[c]];
            const int row = 3 * s->begin[c];
            s->turning[c * n + d] =
                other->along[0] * imp_springs_row(s, row + 2) - other->along[1] * imp_springs_row(s, row + 1);
        }
    }
}

void imp_springs_gauss(double *a, double *b, int n)
{
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[best * n + k])) best = i;
        for (int j = 0; j < n; j++) {
            const double swap = a[k * n + j];
            a[k * n + j] = a[best * n + j], a[best * n + j] = swap;
        }
        const double swap = b[k];
        b[k] = b[best], b[best] = swap;
        if (a[k * n + k] == 0) continue; /* nothing turns it: left as it is */
        for (int i = k + 1; i < n; i++) {
            const double part = a[i * n + k] / a[k * n + k];
            for (int j = k; j < n; j++) a[i * n + j] -= part * a[k * n + j];
            b[i] -= part * b[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++) b[k] -= a[k * n + j] * b[j];
        b[k] = a[k * n + k] == 0 ? 0 : b[k] / a[k * n + k];
    }
}

/* Of contact c the accelerations times g along its turned direction and across it, order k; ahead: with what order k of
 * them is now, else of the lower ones alone. */
static void turned_rates(const imp_spring *c, int k, double *along, double *across)
{
    double a = 0, b = 0;
    for (int i = 0; i <= k; i++) {
        const double x = (i + 1) * c->velocity[1][i + 1], y = (i + 1) * c->velocity[2][i + 1];
        const double r = x * c->along[0] + y * c->along[1], q = y * c->along[0] - x * c->along[1];
        a += r * c->cosine[k - i] + q * c->sine[k - i];
        b += q * c->cosine[k - i] - r * c->sine[k - i];
    }
    *along = a;
    *across = b;
}

static void find_accelerations(imp_springs *s, int i, int k)
{
    for (int j = 1; j < 3; j++) s->springs[i].velocity[j][k + 1] = imp_springs_row(s, 3 * i + j) / (k + 1);
}

/* The angles' terms of order k, from forces in which they are zero yet. */
static void turn_beginnings(imp_springs *s, int k)
{
    const int n = s->begin_count;
    double *matrix = s->turning + n * n, *angles = matrix + n * n;
    if (k > 0) {
        for (int c = 0; c < n; c++) {
            const int i = s->begin[c];
            imp_spring *own = &s->springs[i];
            double along, across;
            find_accelerations(s, i, k);
            turned_rates(own, k, &along, &across);
            /* s theta' = across, its part by theta_k apart */
            double turned = 0;
            for (int j = 1; j < k; j++) turned += j * own->angle[j] * own->speed[k - j + 1];
            angles[c] = across - turned;
            for (int d = 0; d < n; d++) {
                const imp_spring *other = &s->springs[s->begin[d]];
                matrix[c * n + d] = s->turning[c * n + d] * other->friction * other->push[0][0];
            }
            matrix[c * n + c] += (own->weak ? 0 : (k + 1) * own->speed[1]);
        }
        imp_springs_gauss(matrix, angles, n);
        for (int c = 0; c < n; c++) {
            imp_spring *own = &s->springs[s->begin[c]];
            own->angle[k] = angles[c];
            find_turn(own, k);
            find_turned_friction(own, k);
        }
        imp_springs_hold(s, k);
    }
    for (int c = 0; c < n; c++) {
        double along, across;
        find_accelerations(s, s->begin[c], k);
        turned_rates(&s->springs[s->begin[c]], k, &along, &across);
        s->springs[s->begin[c]].speed[k + 1] = k == 0 && s->springs[s->begin[c]].weak ? 0 : along / (k + 1);
    }
}

/* ---- all orders ---- */

/* The contact whose w or s would vanish first at its present rate, if it has one. */
static void choose_lead(imp_springs *s)
{
    double nearest = INFINITY;
    s->lead = IMP_SPRING_TIME;
    imp_springs_forces(s);
    for (int i = 0; i < s->count; i++) {
        const imp_spring *c = &s->springs[i];
        if (c->normal == IMP_SPRING_OPEN) continue;
        const double time = s->exponent == 1.5 ? c->x / fabs(c->u[0]) : INFINITY;
        if (time < nearest) nearest = time, s->lead = IMP_SPRING_ROOT, s->leader = i;
        if (c->slip != IMP_SPRING_SLIDES) continue;
        const double speed = hypot(c->u[1], c->u[2]),
                     rate = hypot(imp_springs_row(s, 3 * i + 1), imp_springs_row(s, 3 * i + 2));
        if (speed / rate < nearest) nearest = speed / rate, s->lead = IMP_SPRING_SPEED, s->leader = i;
    }
}

static void begin(imp_springs *s)
{
    s->begin_count = 0;
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        if (imp_springs_presses(c) && c->slip == IMP_SPRING_BEGINS && !c->summed) {
            c->summed = true;
            c->u[1] = c->u[2] = 0;
        }
        for (int j = 0; j < 3; j++) c->velocity[j][0] = c->u[j];
        c->depth[0] = c->x;
        c->speed[0] = 0;
        if (c->normal != IMP_SPRING_OPEN && c->slip == IMP_SPRING_SLIDES) find_speed(c, 0);
        if (c->normal != IMP_SPRING_OPEN && c->slip == IMP_SPRING_BEGINS) s->begin[s->begin_count++] = i;
    }
    if (s->lead == IMP_SPRING_ROOT) s->springs[s->leader].root[0] = sqrt(s->springs[s->leader].x);
}

static void step_order(imp_springs *s, const double *factor, int k)
{
    find_pushes(s, factor, k);
    imp_springs_hold(s, k);
    if (s->begin_count > 0) {
        if (k == 0) {
            imp_springs_make_turning(s);
            imp_springs_hold(s, 0);
        }
        turn_beginnings(s, k);
    }
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        const bool closed = c->normal != IMP_SPRING_OPEN;
        c->velocity[0][k + 1] = imp_springs_row(s, 3 * i) / (k + 1);
        c->depth[k + 1] = -(factor ? s->stretch * cauchy(factor, c->velocity[0], k) : c->velocity[0][k]) / (k + 1);
        if (!closed || (c->slip != IMP_SPRING_SLIDES && c->slip != IMP_SPRING_STRAIGHT)) continue;
        find_accelerations(s, i, k);
        if (c->slip == IMP_SPRING_SLIDES) find_speed(c, k + 1);
    }
    if (s->lead == IMP_SPRING_ROOT) {
        imp_spring *c = &s->springs[s->leader];
        c->root[k + 1] = -c->velocity[0][k] / (2 * (k + 1));
    }
}

/* The largest of the velocities' terms of order k; NaN where one is. */
static double last_term(const imp_springs *s, int k)
{
    double size = 0;
    for (int i = 0; i < s->count; i++) {
        const imp_spring *c = &s->springs[i];
        const bool slips = c->normal != IMP_SPRING_OPEN && c->slip >= IMP_SPRING_SLIDES;
        for (int j = 0; j < (slips ? 3 : 1); j++)
            if (!(fabs(c->velocity[j][k]) <= size)) size = fabs(c->velocity[j][k]);
        if (isnan(size)) return NAN;
    }
    return size;
}

/* The recurrence of x^eta carries errors on as (1/r)^k, r = x_0/|x_1| about where x was 0 or will be, though the terms
 * themselves fall where contacts closed together: no step goes farther than some r. */
static double reach_of_powers(const imp_springs *s)
{
    double reach = INFINITY;
    for (int i = 0; i < s->count && s->exponent != 1; i++) {
        const imp_spring *c = &s->springs[i];
        const bool leads = s->lead == IMP_SPRING_ROOT && s->leader == i;
        if (c->normal == IMP_SPRING_OPEN || leads) continue;
        reach = fmin(reach, IMP_SPRINGS_REACH * c->depth[0] / fabs(c->depth[1]));
    }
    return reach;
}

/* Of W's entries each order's products; of each contact that presses a dozen sums of products over the orders. */
static double work_of_step(const imp_springs *s)
{
    int pressed = 0;
    for (int i = 0; i < s->count; i++) pressed += imp_springs_presses(&s->springs[i]);
    return IMP_SPRINGS_ORDER * (s->pressed.start[3 * s->count] + 6.0 * IMP_SPRINGS_ORDER * pressed);
}

/* How far tau = h is in time, at the beginning's rate. */
static double time_of(const imp_springs *s, double h)
{
    const double *factor = find_factor(s);
    return factor ? s->stretch * factor[0] * h : h;
}

/* Whether slip turns so fast that a step covers hardly any of the time in which forces and its own speed change. */
static bool is_stiff(const imp_springs *s, double h)
{
    const imp_spring *leader = &s->springs[s->leader];
    if (s->lead != IMP_SPRING_SPEED && s->begin_count == 0) return false;
    if (s->lead == IMP_SPRING_SPEED && fabs(leader->speed[1]) * h > IMP_CREEP_CHANGE * leader->speed[0]) return false;
    return time_of(s, h) * imp_springs_pace(s) < IMP_CREEP_STIFF;
}

static double expand_along_lead(imp_springs *s)
{
    begin(s);
    const double *factor = find_factor(s);
    for (int k = 0; k < IMP_SPRINGS_ORDER; k++) step_order(s, factor, k);
    s->work += work_of_step(s);
    double h = reach_of_powers(s);
    for (int k = IMP_SPRINGS_ORDER - LAST + 1; k <= IMP_SPRINGS_ORDER; k++) {
        const double size = last_term(s, k);
        if (!isfinite(size)) return NAN;
        if (size > 0) h = fmin(h, exp(log(IMP_SPRINGS_TRUNCATION) / IMP_SPRINGS_ORDER - log(size) / k));
    }
    return h;
}

/* Where slip that leads is all but rounding tau goes so far that the last terms are less than a double holds, and bound
 * nothing: then g is so many times as great that it is of order 1, as tau is then. */
static double expand_in_powers(imp_springs *s)
{
    choose_lead(s);
    s->stretch = 1;
    const double h = expand_along_lead(s);
    if (s->lead != IMP_SPRING_SPEED || !(h > IMP_SPRINGS_HELD_BY_DOUBLES)) return h;
    s->stretch = 1 / imp_encounter_unit(s->springs[s->leader].speed[0]);
    return expand_along_lead(s);
}

double imp_springs_expand(imp_springs *s)
{
    for (int i = 0; i < s->count; i++) s->springs[i].creeps = s->springs[i].creeps && s->creeping;
    s->creeping = false;
    const double h = expand_in_powers(s);
    if (!is_stiff(s, h) || s->work < s->creep_due) return h;
    const double before = s->work, far = imp_springs_creep(s, isnan(h) ? 0 : time_of(s, h));
    s->creeping = far > 0;
    if (s->creeping) return far;
    s->creep_due = s->work + (s->work - before);
    return expand_in_powers(s);
}
