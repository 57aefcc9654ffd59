/* SPDX-License-Identifier: MIT
 *
 * One stretch of linear springs without friction: to the first event, a root of a series, or as far as those reach.
 */
#include "contact/springs_linear.h"

#include <math.h>
#include "base/tolerances.h"

/* ---- what is closed ---- */

/* Whether other contacts are closed than were. */
static bool change_places(imp_linear_springs *s)
{
    bool changed = false;
    for (int i = 0; i < s->count; i++) changed |= (s->line[i].normal == IMP_SPRING_OPEN) != (s->place[i] < 0);
    if (!changed) return false;
    s->closed_count = 0;
    for (int i = 0; i < s->count; i++) {
        const bool open = s->line[i].normal == IMP_SPRING_OPEN;
        s->place[i] = open ? -1 : s->closed_count;
        if (!open) s->closed[s->closed_count++] = i;
    }
    return true;
}

bool imp_linear_find_closed(imp_linear_springs *s)
{
    int filled = 0;
    if (!change_places(s)) return s->closed_count > 0;
    for (int c = 0; c < s->closed_count; c++) {
        const int j = s->closed[c], to = s->start[j + 1];
        s->closed_start[c] = filled;
        for (int e = s->start[j]; e < to; e++) {
            const int place = s->place[s->row[e]];
            s->closed_row[filled] = place;
            s->closed_value[filled] = s->value[e];
            filled += place >= 0; /* what is open is written over */
        }
    }
    s->closed_start[s->closed_count] = filled;
    return s->closed_count > 0;
}

/* to += f W's column */
static void add_column(const double *restrict value, const int *restrict row, int count, imp_term_pair f,
                       imp_term_pair *restrict to)
{
    for (int e = 0; e < count; e++) {
        to[row[e]].even += value[e] * f.even;
        to[row[e]].odd += value[e] * f.odd;
    }
}

/* ---- the series ---- */

/* What next terms are of the sums over W: -1/((k-1)k) and -1/(k(k+1)); of t^(k+1) and t^(k+2) integrals are
 * 1/(k+1) and 1/(k+2) of those, and their integrals 1/(k+2) and 1/(k+3). */
static void find_factors(imp_linear_springs *s)
{
    for (int m = 0; m < IMP_LINEAR_PAIRS; m++) {
        const int k = 2 * m;
        s->factor[m + 1] = (imp_term_pair){-1.0 / ((k + 1) * (k + 2)), -1.0 / ((k + 2) * (k + 3))};
        s->once[m] = (imp_term_pair){1.0 / (k + 1), 1.0 / (k + 2)};
        s->twice[m] = (imp_term_pair){1.0 / (k + 2), 1.0 / (k + 3)};
    }
}

static void begin_series(imp_linear_springs *s)
{
    if (s->factor[1].even == 0) find_factors(s);
    s->pairs = 1, s->hardest = 0;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        s->kappa[c] = l->kappa;
        s->hardest = l->kappa > s->hardest ? l->kappa : s->hardest;
        s->depth[c] = (imp_term_pair){l->x, -l->u};
        s->force[c] = (imp_term_pair){l->kappa * l->x, -l->kappa * l->u};
    }
}

/* The next two terms of what is closed. */
static void expand(imp_linear_springs *s)
{
    const int n = s->closed_count, *restrict column = s->closed_row, odd = s->pairs % 2;
    const double *restrict value = s->closed_value, *restrict kappa = s->kappa;
    const imp_term_pair factor = s->factor[s->pairs], *restrict last = &s->force[odd ? 0 : n];
    imp_term_pair *restrict next = &s->depth[s->pairs * n], *restrict force = &s->force[odd ? n : 0], most = {0, 0};
    for (int c = 0; c < n; c++) {
        imp_term_pair sum = {0, 0};
        for (int e = s->closed_start[c]; e < s->closed_start[c + 1]; e++) {
            sum.even += value[e] * last[column[e]].even;
            sum.odd += value[e] * last[column[e]].odd;
        }
        next[c] = (imp_term_pair){factor.even * sum.even, factor.odd * sum.odd};
        force[c] = (imp_term_pair){kappa[c] * next[c].even, kappa[c] * next[c].odd};
        const double even_size = fabs(next[c].even), odd_size = fabs(next[c].odd);
        most.even = even_size > most.even ? even_size : most.even;
        most.odd = odd_size > most.odd ? odd_size : most.odd;
    }
    s->greatest[s->pairs++] = most;
}

/* S */
static double growth_of(const imp_linear_springs *s)
{
    double most = 0;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        most = l->kappa * l->column > most ? l->kappa * l->column : most;
    }
    return most;
}

/* The largest of the last two terms, as velocities have them. */
static imp_term_pair greatest_terms(const imp_linear_springs *s)
{
    const int order = 2 * s->pairs - 2;
    const imp_term_pair last = s->greatest[s->pairs - 1];
    return (imp_term_pair){order * last.even, (order + 1) * last.odd};
}

/* How far the terms that are made reach: of a sum of cosines and sines the last even and odd ones tell. */
static double reach_of(const imp_linear_springs *s, imp_term_pair most, double growth)
{
    const int order = 2 * s->pairs - 2; /* of velocities */
    const double digits = log2(IMP_SPRINGS_TRUNCATION);
    double h = sqrt(order * (order + 1) / (2 * growth));
    if (most.even > 0) h = fmin(h, exp2((digits - log2(most.even)) / (order - 1)));
    if (most.odd > 0) h = fmin(h, exp2((digits - log2(most.odd)) / order));
    return h;
}

/* Whether the terms that are made reach so far as the powers are of; *most: the last. What follows those is less than
 * a sum that falls by their ratio, twice its first. */
static bool reaches(const imp_linear_springs *s, double growth, imp_term_pair *most)
{
    const int order = 2 * s->pairs - 2;
    const double ratio = growth * s->power[2] / (order * (order + 1)), left = 2 * ratio;
    *most = greatest_terms(s);
    return left <= 1 && left * most->even * s->power[order - 1] <= IMP_SPRINGS_TRUNCATION &&
           left * most->odd * s->power[order] <= IMP_SPRINGS_TRUNCATION;
}

static void find_powers(imp_linear_springs *s, double h) { imp_springs_find_powers(h, 2 * s->pairs, s->power); }

/* Terms that reach so far, or as far as there are terms; returns how far. */
static double reach_for(imp_linear_springs *s, double growth, double far)
{
    imp_term_pair most;
    find_powers(s, far);
    while (!reaches(s, growth, &most)) {
        if (s->pairs == IMP_LINEAR_PAIRS) return fmin(far, reach_of(s, most, growth));
        expand(s);
        for (int k = 2 * s->pairs - 2; k < 2 * s->pairs; k++) s->power[k] = s->power[k - 2] * s->power[2];
    }
    return far;
}

/* Of what is closed the depth, or its velocity u = -x'. */
static void gather(const imp_linear_springs *s, int closed, double sign, imp_terms f)
{
    for (int m = 0; m < s->pairs; m++) {
        const imp_term_pair p = s->depth[m * s->closed_count + closed];
        f[2 * m] = sign * p.even;
        f[2 * m + 1] = sign * p.odd;
    }
}

static void gather_velocity(const imp_linear_springs *s, int closed, double sign, imp_terms f)
{
    gather(s, closed, -sign, f);
    for (int k = 0; k + 1 < 2 * s->pairs; k++) f[k] = (k + 1) * f[k + 1];
    f[2 * s->pairs - 1] = 0;
}

/* Minus the depth of what is open. */
static void gather_open(const imp_linear_springs *s, int i, imp_terms f)
{
    f[0] = -s->line[i].x;
    f[1] = s->line[i].u;
    for (int k = 2; k < 2 * s->pairs; k++) f[k] = 0;
    for (int e = s->start[i]; e < s->start[i + 1]; e++) {
        const int c = s->place[s->row[e]];
        if (c < 0) continue;
        const double factor = s->value[e] * s->line[s->row[e]].kappa;
        for (int m = 1; m < s->pairs; m++) {
            const imp_term_pair p = s->depth[(m - 1) * s->closed_count + c];
            f[2 * m] += factor * p.even;
            f[2 * m + 1] += factor * p.odd;
        }
    }
    for (int m = 1; m < s->pairs; m++) f[2 * m] *= -s->factor[m].even, f[2 * m + 1] *= -s->factor[m].odd;
}

/* ---- which event comes first ---- */

typedef enum change { CHANGE_NONE, CHANGE_TURN, CHANGE_TOUCH, CHANGE_AGAIN } change;

typedef struct first_change {
    change what;
    imp_linear_spring *line;
    double when;
} first_change;

/* A series by its beginning: four terms, t in units of the time whose powers are given, and what later ones make of it
 * and of its first two rates, at most. */
typedef struct outline {
    double terms[4];
    const double *rest;
} outline;

static double below(double a) { return a < 0 ? a : 0; }
static double above(double a) { return a > 0 ? a : 0; }

/* Whether it is above 0 all along, but for its beginning. */
static bool outline_stays(const outline *o)
{
    const double *f = o->terms, takes = below(f[2]) + below(f[3]) - o->rest[0];
    return f[0] + below(f[1]) + takes > 0 || (f[0] >= 0 && f[1] + takes > 0);
}

/* Whether it falls, or bends down, all along. */
static bool outline_falls(const outline *o)
{
    const double *f = o->terms, more = above(f[3]);
    return f[1] + 2 * above(f[2]) + 3 * more + o->rest[1] < 0 || 2 * f[2] + 6 * more + o->rest[2] < 0;
}

/* Of what is closed. */
static outline outline_depth(const imp_linear_springs *s, int closed, double sign, double shift)
{
    const imp_term_pair first = s->depth[closed], second = s->depth[s->closed_count + closed];
    const double *h = s->power;
    return (outline){
        {sign * first.even + shift, sign * first.odd * h[1], sign * second.even * h[2], sign * second.odd * h[3]},
        s->rest};
}

static outline outline_rate(const imp_linear_springs *s, int closed, double sign)
{
    const imp_term_pair first = s->depth[closed], second = s->depth[s->closed_count + closed];
    const double *h = s->power;
    return (outline){{sign * first.odd * h[1], sign * 2 * second.even * h[2], sign * 3 * second.odd * h[3], 0},
                     s->rest + 1};
}

/* What terms from the fifth on make of any depth, and of its first rates, at most, in the time whose powers are given;
 * and of one for each unit of sum |W| what those from the seventh on make by forces. */
static void bound_rest(imp_linear_springs *s)
{
    double rest[4] = {0, 0, 0, 0}, open = 0;
    for (int m = 2; m < s->pairs; m++) {
        const imp_term_pair most = s->greatest[m];
        const int k = 2 * m + 1;
        const double even = most.even * s->power[2 * m], odd = most.odd * s->power[k], both = even + odd;
        rest[0] += both;
        rest[1] += k * both;
        rest[2] += k * (k - 1) * both;
        rest[3] += k * (k - 1) * (k - 2) * both;
        open -= s->factor[m + 1].even * both;
    }
    for (int k = 0; k < 4; k++) s->rest[k] = rest[k];
    s->rest_open = open * s->hardest * s->power[2];
}

/* f, whose outline is given, falls to 0 sooner. */
static void see_fall(imp_linear_springs *s, const outline *o, const imp_terms f, change what, imp_linear_spring *line,
                     first_change *first)
{
    bool found;
    const int order = 2 * s->pairs - 1;
    const double t = outline_falls(o) ? imp_springs_only_fall(f, order, first->when, &found)
                                      : imp_springs_first_fall(f, order, first->when, &found);
    if (!found) return;
    *first = (first_change){what, line, t};
    find_powers(s, t);
}

static void see_turn(imp_linear_springs *s, int closed, first_change *first)
{
    imp_terms f;
    const outline o = outline_rate(s, closed, 1);
    if (outline_stays(&o)) return;
    gather_velocity(s, closed, -1, f);
    see_fall(s, &o, f, CHANGE_TURN, &s->line[s->closed[closed]], first);
}

/* sign x + shift; from just above 0 where it is not yet. */
static void see_depth(imp_linear_springs *s, int closed, double sign, double shift, change what, first_change *first)
{
    imp_terms f;
    imp_linear_spring *l = &s->line[s->closed[closed]];
    outline o = outline_depth(s, closed, sign, shift);
    if (!(o.terms[0] > 0)) o.terms[0] = IMP_SPRINGS_JUST * l->tiny;
    if (outline_stays(&o)) return;
    gather(s, closed, sign, f);
    f[0] = o.terms[0];
    see_fall(s, &o, f, what, l, first);
}

static void see_closed(imp_linear_springs *s, int closed, first_change *first)
{
    const imp_linear_spring *l = &s->line[s->closed[closed]];
    if (l->normal == IMP_SPRING_LOADS && l->restitution < 1) {
        see_turn(s, closed, first);
        return;
    }
    see_depth(s, closed, 1, -l->tiny, CHANGE_TOUCH, first);
    const double again = imp_linear_again(l);
    if (l->normal == IMP_SPRING_UNLOADS && l->x < again) see_depth(s, closed, -1, again, CHANGE_AGAIN, first);
}

/* The largest impulse of one contact before t. */
static double greatest_push(const imp_linear_springs *s, double t)
{
    double most = 0;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        const outline o = outline_depth(s, c, 1, 0);
        const double *f = o.terms, force = l->kappa * (f[0] + above(f[1]) + above(f[2]) + above(f[3]) + o.rest[0]);
        most = force > most ? force : most;
    }
    return t * most;
}

/* Minus the depth of what is open. */
static outline outline_open(const imp_linear_springs *s, int i, double rest[3])
{
    const imp_linear_spring *l = &s->line[i];
    const int n = s->closed_count;
    imp_term_pair first = {0, 0}, second = {0, 0};
    for (int e = s->start[i]; e < s->start[i + 1]; e++) {
        const int c = s->place[s->row[e]];
        if (c < 0) continue;
        const double factor = s->value[e] * s->kappa[c];
        first.even += factor * s->depth[c].even, first.odd += factor * s->depth[c].odd;
        second.even += factor * s->depth[n + c].even, second.odd += factor * s->depth[n + c].odd;
    }
    const double even = fabs(second.even) / 12 * s->power[4], odd = fabs(second.odd) / 20 * s->power[5];
    rest[0] = even + odd + l->column * s->rest_open, rest[1] = rest[2] = INFINITY;
    return (outline){{l->tiny - l->x, l->u * s->power[1], first.even / 2 * s->power[2], first.odd / 6 * s->power[3]},
                     rest};
}

/* What is open may close before t only if u gets below zero; nothing pulls, and no contact pushes by more than `most`.
 */
static void see_open(imp_linear_springs *s, int i, double most, first_change *first)
{
    imp_linear_spring *l = &s->line[i];
    imp_terms f;
    double rest[3];
    if (l->normal != IMP_SPRING_OPEN) return;
    const double fastest = (l->column - l->own) * most - l->u;
    if (!(fastest > 0) || l->x + fastest * first->when < l->tiny * (1 - IMP_SPRINGS_JUST)) return;
    outline o = outline_open(s, i, rest);
    if (!(o.terms[0] > 0)) o.terms[0] = IMP_SPRINGS_JUST * l->tiny;
    if (outline_stays(&o)) return;
    gather_open(s, i, f);
    f[0] = o.terms[0];
    see_fall(s, &o, f, CHANGE_TOUCH, l, first);
}

/* The one that seems to come first is looked for first: others have less time then. */
static first_change find_first(imp_linear_springs *s, int nearest, double far)
{
    first_change first = {CHANGE_NONE, NULL, far};
    find_powers(s, far);
    bound_rest(s);
    if (nearest >= 0) {
        see_closed(s, nearest, &first);
        bound_rest(s);
    }
    for (int c = 0; c < s->closed_count; c++)
        if (c != nearest) see_closed(s, c, &first);
    if (s->closed_count == s->count) return first;
    const double most = greatest_push(s, first.when);
    for (int i = 0; i < s->count; i++) see_open(s, i, most, &first);
    return first;
}

/* The first positive zero of f0 + f1 t + f2 t^2, f0 > 0; else of what is left of it over t. */
static double zero_of(double f0, double f1, double f2)
{
    if (!(f0 > 0)) return f1 > 0 && f2 < 0 ? -f1 / f2 : INFINITY;
    const double square = f1 * f1 - 4 * f0 * f2, below = square >= 0 ? sqrt(square) - f1 : 0;
    return below > 0 ? 2 * f0 / below : INFINITY;
}

/* Whether that may be before t. */
static bool may_fall(double f0, double f1, double f2, double t)
{
    return !(f0 > 0) || !(f0 + (f1 + f2 * t) * t > 0) || (f1 < 0 && f2 > 0 && -f1 < 2 * f2 * t);
}

/* That time by six terms, of what three terms say: two steps of Newton's. */
static double look_closer(const imp_linear_springs *s, int closed, double t)
{
    const imp_linear_spring *l = &s->line[s->closed[closed]];
    imp_terms f;
    double when = t;
    const bool turns = l->normal == IMP_SPRING_LOADS && l->restitution < 1;
    if (turns)
        gather_velocity(s, closed, -1, f);
    else
        gather(s, closed, 1, f);
    f[0] -= turns ? 0 : l->tiny;
    for (int k = 0; k < 2; k++) {
        double value = 0, slope = 0;
        for (int m = 5; m >= 0; m--) slope = slope * when + value, value = value * when + f[m];
        when -= value / slope;
    }
    return when > t / 2 && when < 2 * t ? when : IMP_LINEAR_AHEAD * t;
}

/* About when something will happen first, by three terms each; of what is open by two. *nearest: of what is closed,
 * or -1. */
static double look_ahead(const imp_linear_springs *s, int *nearest)
{
    double soonest = IMP_SPRINGS_FARTHEST;
    *nearest = -1;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        const imp_term_pair first = s->depth[c], second = s->depth[s->closed_count + c];
        const bool turns = l->normal == IMP_SPRING_LOADS && l->restitution < 1;
        const double f0 = turns ? first.odd : first.even - l->tiny, f1 = turns ? 2 * second.even : first.odd,
                     f2 = turns ? 3 * second.odd : second.even;
        if (!may_fall(f0, f1, f2, soonest)) continue;
        const double t = zero_of(f0, f1, f2);
        if (t < soonest) soonest = t, *nearest = c;
    }
    for (int i = 0; i < s->count; i++) {
        const imp_linear_spring *l = &s->line[i];
        if (l->normal == IMP_SPRING_OPEN && l->x < 0 && l->x - l->u * soonest > 0) soonest = l->x / l->u, *nearest = -1;
    }
    return soonest;
}

/* ---- to there ---- */

static void note_line_phase(imp_linear_spring *l, bool compressed)
{
    imp_finding *f = l->finding;
    const impact_phase phase = compressed ? IMPACT_SLIP_C : IMPACT_SLIP_R;
    if (f->phase_count > 0 && f->phases[f->phase_count - 1] == phase) return;
    if (f->phase_count < IMPACT_MAX_PHASES) f->phases[f->phase_count++] = (unsigned char)phase;
}

static void book_line_energy(imp_linear_spring *l, double x)
{
    const double energy = imp_linear_energy(l, x), rise = energy - l->stored;
    l->finding->work[rise > 0 ? 0 : 1] -= rise;
    l->stored = energy;
}

static double depth_at(const imp_linear_springs *s, int closed, double t)
{
    double x = 0;
    for (int m = s->pairs - 1; m >= 0; m--) {
        const imp_term_pair p = s->depth[m * s->closed_count + closed];
        x = (x * t + p.odd) * t + p.even;
    }
    return x;
}

/* Of what is closed F's integral from the beginning to t, whose powers are given, and that one's. */
static void sum_up(imp_linear_springs *s, double t)
{
    const int n = s->closed_count;
    imp_term_pair by_even[IMP_LINEAR_PAIRS], by_odd[IMP_LINEAR_PAIRS]; /* what a term makes of both */
    for (int m = 0; m < s->pairs; m++) {
        const double even = t * s->power[2 * m] * s->once[m].even, odd = t * s->power[2 * m + 1] * s->once[m].odd;
        by_even[m] = (imp_term_pair){even, even * (s->twice[m].even * t)};
        by_odd[m] = (imp_term_pair){odd, odd * (s->twice[m].odd * t)};
    }
    for (int c = 0; c < n; c++) {
        imp_term_pair even = {0, 0}, odd = {0, 0};
        const imp_term_pair *term = &s->depth[s->pairs * n + c];
        for (int m = s->pairs - 1; m >= 0; m--) {
            term -= n;
            even.even += by_even[m].even * term->even;
            even.odd += by_even[m].odd * term->even;
            odd.even += by_odd[m].even * term->odd;
            odd.odd += by_odd[m].odd * term->odd;
        }
        s->push[c] = (imp_term_pair){s->kappa[c] * (even.even + odd.even), s->kappa[c] * (even.odd + odd.odd)};
    }
}

/* Where u changes its sign before t; what loads and will turn has no such time, and most have one at most. */
static int see_changes(const imp_linear_springs *s, int closed, double sign, double t, double *when)
{
    const imp_linear_spring *l = &s->line[s->closed[closed]];
    const outline o = outline_rate(s, closed, sign);
    imp_terms f;
    bool found;
    if ((l->normal == IMP_SPRING_LOADS && l->restitution < 1) || outline_stays(&o)) return 0;
    gather_velocity(s, closed, -sign, f);
    if (!(f[0] > 0) || !outline_falls(&o))
        return imp_springs_sign_changes(f, 2 * s->pairs - 2, t, when, IMP_SPRINGS_EXTREMES);
    *when = imp_springs_only_fall(f, 2 * s->pairs - 1, t, &found);
    return found;
}

/* The spring's work to t; where u changes its sign on the way the energy has an extreme. */
static void book_line(const imp_linear_springs *s, int closed, double t)
{
    imp_linear_spring *l = &s->line[s->closed[closed]];
    double when[IMP_SPRINGS_EXTREMES];
    const double rate = s->depth[closed].odd;
    bool compressed = rate > 0 || (rate == 0 && l->u < 0);
    const int changes = see_changes(s, closed, compressed ? 1 : -1, t, when);
    note_line_phase(l, compressed);
    for (int k = 0; k < changes; k++) {
        book_line_energy(l, depth_at(s, closed, when[k]));
        l->finding->compressions += compressed;
        compressed = !compressed;
        note_line_phase(l, compressed);
    }
    book_line_energy(l, l->x);
}

static void move_lines_on(imp_linear_springs *s, double t)
{
    sum_up(s, t);
    for (int i = 0; i < s->count; i++) s->gain[i] = (imp_term_pair){0, 0};
    for (int c = 0; c < s->closed_count; c++) {
        const int j = s->closed[c], from = s->start[j];
        add_column(&s->value[from], &s->row[from], s->start[j + 1] - from, s->push[c], s->gain);
        s->line[j].p += s->push[c].even;
    }
    for (int i = 0; i < s->count; i++) {
        imp_linear_spring *l = &s->line[i];
        l->x -= l->u * t + s->gain[i].odd;
        l->u += s->gain[i].even;
    }
    for (int c = 0; c < s->closed_count; c++) book_line(s, c, t);
}

bool imp_linear_step(imp_linear_springs *s)
{
    const double growth = growth_of(s);
    first_change first = {CHANGE_NONE, NULL, 0};
    begin_series(s);
    expand(s);
    expand(s);
    int nearest;
    double far = look_ahead(s, &nearest);
    far = IMP_LINEAR_AHEAD * (nearest >= 0 ? look_closer(s, nearest, far) : far);
    do {
        first = find_first(s, nearest, reach_for(s, growth, far));
        far *= 2;
    } while (first.what == CHANGE_NONE && s->pairs < IMP_LINEAR_PAIRS && far <= IMP_SPRINGS_FARTHEST);
    if (isnan(s->rest[0])) return false;
    s->steps++;
    move_lines_on(s, first.when);
    s->events += first.line != NULL;
    if (first.what == CHANGE_TURN) first.line->u = fmax(first.line->u, 0);
    if (first.what == CHANGE_TOUCH) first.line->x = first.line->tiny;
    if (first.what == CHANGE_AGAIN) first.line->x = fmax(first.line->x, imp_linear_again(first.line));
    return true;
}
