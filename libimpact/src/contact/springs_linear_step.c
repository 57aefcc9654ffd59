/* SPDX-License-Identifier: MIT
 *
 * One stretch of linear springs without friction: to the first event, a root of a series, or as far as those reach.
 */
#include "contact/springs_linear.h"

#include <math.h>
#include "base/tolerances.h"

/* ---- what is closed ---- */

bool imp_linear_find_closed(imp_linear_springs *s)
{
    int filled = 0;
    s->closed_count = 0;
    for (int i = 0; i < s->count; i++) {
        const bool open = s->line[i].normal == IMP_SPRING_OPEN;
        s->place[i] = open ? -1 : s->closed_count;
        if (!open) s->closed[s->closed_count++] = i;
    }
    for (int c = 0; c < s->closed_count; c++) {
        const int j = s->closed[c], to = s->start[j + 1];
        s->closed_start[c] = filled;
        for (int e = s->start[j]; e < to; e++) {
            const int place = s->place[s->row[e]];
            s->closed_row[filled] = place;
            s->closed_value[filled] = s->value[e] * s->line[s->row[e]].kappa;
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

/* What next terms are of the sums over W K: -1/((k-1)k) and -1/(k(k+1)). */
static void find_factors(imp_linear_springs *s)
{
    for (int m = 1; m < IMP_LINEAR_PAIRS; m++) {
        const int k = 2 * m;
        s->factor[m] = (imp_term_pair){-1.0 / ((k - 1) * k), -1.0 / (k * (k + 1))};
    }
}

static void begin_series(imp_linear_springs *s)
{
    if (s->factor[1].even == 0) find_factors(s);
    s->pairs = 1;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        s->depth[c] = (imp_term_pair){l->x, -l->u};
    }
}

/* The next two terms of what is closed. */
static void expand(imp_linear_springs *s)
{
    const int n = s->closed_count, *restrict column = s->closed_row;
    const double *restrict value = s->closed_value;
    const imp_term_pair factor = s->factor[s->pairs], *restrict last = &s->depth[(s->pairs - 1) * n];
    imp_term_pair *restrict next = &s->depth[s->pairs++ * n], most = {0, 0};
    for (int c = 0; c < n; c++) {
        imp_term_pair sum = {0, 0};
        for (int e = s->closed_start[c]; e < s->closed_start[c + 1]; e++) {
            sum.even += value[e] * last[column[e]].even;
            sum.odd += value[e] * last[column[e]].odd;
        }
        next[c] = (imp_term_pair){factor.even * sum.even, factor.odd * sum.odd};
        const double even = fabs(next[c].even), odd = fabs(next[c].odd);
        most.even = even > most.even ? even : most.even;
        most.odd = odd > most.odd ? odd : most.odd;
    }
    s->greatest = most;
}

/* S */
static double growth_of(const imp_linear_springs *s)
{
    double most = 0;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        most = fmax(most, l->kappa * l->column);
    }
    return most;
}

/* The largest of the last two terms, as velocities have them. */
static imp_term_pair greatest_terms(const imp_linear_springs *s)
{
    const int order = 2 * s->pairs - 2;
    return (imp_term_pair){order * s->greatest.even, (order + 1) * s->greatest.odd};
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

/* Whether the terms that are made reach so far as the powers are of; *most: the last. */
static bool reaches(const imp_linear_springs *s, double growth, imp_term_pair *most)
{
    const int order = 2 * s->pairs - 2;
    *most = greatest_terms(s);
    return most->even * s->power[order - 1] <= IMP_SPRINGS_TRUNCATION &&
           most->odd * s->power[order] <= IMP_SPRINGS_TRUNCATION && 2 * growth * s->power[2] <= order * (order + 1);
}

/* Terms that reach so far, or as far as there are terms; returns how far. */
static double reach_for(imp_linear_springs *s, double growth, double far)
{
    imp_term_pair most;
    imp_springs_find_powers(far, s->power);
    while (!reaches(s, growth, &most)) {
        if (s->pairs == IMP_LINEAR_PAIRS) return fmin(far, reach_of(s, most, growth));
        expand(s);
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

/* f falls to 0 sooner; from `just` where it is not above yet. The powers are of first->when. */
static void see_fall(imp_linear_springs *s, imp_terms f, double just, change what, imp_linear_spring *line,
                     first_change *first)
{
    bool found;
    const int terms = 2 * s->pairs;
    if (!(f[0] > 0)) f[0] = just;
    if (imp_springs_stay_above(f, terms, s->power)) return;
    const double t = imp_springs_first_fall(f, terms - 1, first->when, &found);
    if (!found) return;
    *first = (first_change){what, line, t};
    imp_springs_find_powers(t, s->power);
}

/* Of what is closed how far x and x' go from where they are, at most, in the time whose powers are given. */
static void bound_changes(imp_linear_springs *s)
{
    const int n = s->closed_count;
    for (int c = 0; c < n; c++) s->bound[c] = (imp_term_pair){fabs(s->depth[c].odd) * s->power[1], 0};
    for (int m = 1; m < s->pairs; m++) {
        const imp_term_pair *restrict terms = &s->depth[m * n];
        imp_term_pair *restrict bound = s->bound;
        const double even = s->power[2 * m], odd = s->power[2 * m + 1];
        const double even_rate = 2 * m * s->power[2 * m - 1], odd_rate = (2 * m + 1) * even;
        for (int c = 0; c < n; c++) {
            const double x = fabs(terms[c].even), y = fabs(terms[c].odd);
            bound[c].even += even * x + odd * y;
            bound[c].odd += even_rate * x + odd_rate * y;
        }
    }
}

static void see_closed(imp_linear_springs *s, int closed, first_change *first)
{
    imp_linear_spring *l = &s->line[s->closed[closed]];
    const imp_term_pair bound = s->bound[closed];
    imp_terms f;
    if (l->normal == IMP_SPRING_LOADS && l->restitution < 1) {
        if (s->depth[closed].odd > bound.odd) return;
        gather_velocity(s, closed, -1, f);
        see_fall(s, f, 0, CHANGE_TURN, l, first);
        return;
    }
    if (!(l->x - l->tiny > bound.even)) {
        gather(s, closed, 1, f);
        f[0] -= l->tiny;
        see_fall(s, f, IMP_SPRINGS_JUST * l->tiny, CHANGE_TOUCH, l, first);
    }
    const double again = imp_linear_again(l);
    if (l->normal != IMP_SPRING_UNLOADS || l->x >= again || again - l->x > bound.even) return;
    gather(s, closed, -1, f);
    f[0] += again;
    see_fall(s, f, IMP_SPRINGS_JUST * l->tiny, CHANGE_AGAIN, l, first);
}

/* The largest impulse of one contact before t. */
static double greatest_push(const imp_linear_springs *s, double t)
{
    double most = 0;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        const double force = l->kappa * (l->x + s->bound[c].even);
        most = force > most ? force : most;
    }
    return t * most;
}

/* What is open may close before t only if u gets below zero; nothing pulls, and no contact pushes by more than `most`.
 */
static void see_open(imp_linear_springs *s, int i, double most, first_change *first)
{
    imp_linear_spring *l = &s->line[i];
    imp_terms f;
    if (l->normal != IMP_SPRING_OPEN) return;
    const double fastest = (l->column - l->own) * most - l->u;
    if (!(fastest > 0) || l->x + fastest * first->when < l->tiny * (1 - IMP_SPRINGS_JUST)) return;
    gather_open(s, i, f);
    f[0] += l->tiny;
    see_fall(s, f, IMP_SPRINGS_JUST * l->tiny, CHANGE_TOUCH, l, first);
}

static first_change find_first(imp_linear_springs *s, double far)
{
    first_change first = {CHANGE_NONE, NULL, far};
    imp_springs_find_powers(far, s->power);
    bound_changes(s);
    for (int c = 0; c < s->closed_count; c++) see_closed(s, c, &first);
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

/* About when something will happen first, by three terms each; of what is open by two. */
static double look_ahead(const imp_linear_springs *s)
{
    double soonest = IMP_SPRINGS_FARTHEST;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        const imp_term_pair first = s->depth[c], second = s->depth[s->closed_count + c];
        const bool turns = l->normal == IMP_SPRING_LOADS && l->restitution < 1;
        const double t = turns ? zero_of(first.odd, 2 * second.even, 3 * second.odd)
                               : zero_of(first.even - l->tiny, first.odd, second.even);
        soonest = t < soonest ? t : soonest;
    }
    for (int i = 0; i < s->count; i++) {
        const imp_linear_spring *l = &s->line[i];
        if (l->normal == IMP_SPRING_OPEN && l->x < 0 && l->x - l->u * soonest > 0) soonest = l->x / l->u;
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
    const int n = s->closed_count, last = s->pairs - 1;
    imp_term_pair first[IMP_LINEAR_PAIRS], second[IMP_LINEAR_PAIRS];
    for (int m = 0; m <= last; m++) {
        const int k = 2 * m;
        first[m] = (imp_term_pair){s->power[k + 1] / (k + 1), m < last ? s->power[k + 2] / (k + 2) : 0};
        second[m] = (imp_term_pair){first[m].even * t / (k + 2), first[m].odd * t / (k + 3)};
    }
    for (int c = 0; c < n; c++) {
        imp_term_pair p = {0, 0}, q = {0, 0};
        for (int m = last; m >= 0; m--) {
            const imp_term_pair term = s->depth[m * n + c];
            p.even += first[m].even * term.even, p.odd += first[m].odd * term.odd;
            q.even += second[m].even * term.even, q.odd += second[m].odd * term.odd;
        }
        const double kappa = s->line[s->closed[c]].kappa;
        s->push[c] = (imp_term_pair){kappa * (p.even + p.odd), kappa * (q.even + q.odd)};
    }
}

/* The spring's work to t; where u changes its sign on the way the energy has an extreme. What loads and will turn has
 * none before that. */
static void book_line(const imp_linear_springs *s, int closed, double t)
{
    imp_linear_spring *l = &s->line[s->closed[closed]];
    double when[IMP_SPRINGS_EXTREMES];
    const double rate = s->depth[closed].odd;
    bool compressed = rate > 0 || (rate == 0 && l->u < 0);
    int changes = 0;
    if ((l->normal != IMP_SPRING_LOADS || l->restitution == 1) && fabs(rate) <= s->bound[closed].odd) {
        imp_terms f;
        gather_velocity(s, closed, 1, f);
        changes = imp_springs_sign_changes(f, 2 * s->pairs - 2, t, when, IMP_SPRINGS_EXTREMES);
    }
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
    double far = IMP_LINEAR_AHEAD * look_ahead(s);
    do {
        first = find_first(s, reach_for(s, growth, far));
        far *= 2;
    } while (first.what == CHANGE_NONE && s->pairs < IMP_LINEAR_PAIRS && far <= IMP_SPRINGS_FARTHEST);
    if (isnan(s->bound[0].even)) return false;
    s->steps++;
    move_lines_on(s, first.when);
    s->events += first.line != NULL;
    if (first.what == CHANGE_TURN) first.line->u = fmax(first.line->u, 0);
    if (first.what == CHANGE_TOUCH) first.line->x = first.line->tiny;
    if (first.what == CHANGE_AGAIN) first.line->x = fmax(first.line->x, imp_linear_again(first.line));
    return true;
}
