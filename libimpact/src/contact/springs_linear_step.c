/* SPDX-License-Identifier: MIT
 *
 * One stretch of linear springs without friction: to the first event, a root of a series, or as far as those reach.
 */
#include "contact/springs_linear.h"

#include <math.h>
#include "base/tolerances.h"

static double below(double a) { return a < 0 ? a : 0; }

/* ---- what is closed ---- */

static void place_closed(imp_linear_springs *s)
{
    s->closed_count = 0;
    for (int i = 0; i < s->count; i++) {
        const bool open = s->line[i].normal == IMP_SPRING_OPEN;
        s->place[i] = open ? -1 : s->closed_count;
        if (!open) s->closed[s->closed_count++] = i;
        s->kappa[i] = s->line[i].kappa;
    }
}

bool imp_linear_find_closed(imp_linear_springs *s)
{
    imp_linear_entry *restrict entry = s->entry;
    const int *place = s->place;
    const double *kappa = s->kappa;
    place_closed(s);
    s->growth = 0;
    for (int c = 0; c < s->closed_count; c++) {
        const int i = s->closed[c], to = s->start[i + 1];
        double sum = 0;
        for (int e = s->start[i]; e < to; e++) {
            const int j = s->row[e];
            if (place[j] < 0) continue;
            const double own = s->value[e], value = own * kappa[j];
            entry->value = (imp_term_pair){value, value};
            (entry++)->place = (size_t)place[j];
            sum += fabs(own);
        }
        s->entry_end[c] = entry;
        s->growth = sum * kappa[i] > s->growth ? sum * kappa[i] : s->growth;
    }
    return s->closed_count > 0;
}

/* ---- the series ---- */

/* What next terms are of the sums over W kappa: -1/((k-1)k) and -1/(k(k+1)); integrals and theirs of t^k to 1:
 * 1/(k+1) and 1/((k+1)(k+2)). */
static void find_factors(imp_linear_springs *s)
{
    for (int m = 0; m < IMP_LINEAR_PAIRS; m++) {
        const int k = 2 * m;
        s->factor[m + 1] = (imp_term_pair){-1.0 / ((k + 1) * (k + 2)), -1.0 / ((k + 2) * (k + 3))};
        s->once[m] = (imp_term_pair){1.0 / (k + 1), 1.0 / (k + 2)};
        s->twice[m] = -s->factor[m + 1];
    }
}

static void begin_series(imp_linear_springs *s)
{
    if (s->factor[1][0] == 0) find_factors(s);
    s->pairs = 1, s->unit = 1;
    s->last = s->term;
    for (int c = 0; c < s->closed_count; c++) {
        const imp_linear_spring *l = &s->line[s->closed[c]];
        s->term[c] = (imp_term_pair){l->x, -l->u};
    }
}

static imp_term_pair size_of(imp_term_pair p) { return (imp_term_pair){fabs(p[0]), fabs(p[1])}; }

/* The next two terms of what is closed. */
static void expand(imp_linear_springs *s)
{
    const size_t n = (size_t)s->closed_count;
    const imp_term_pair factor = s->unit * s->unit * s->factor[s->pairs];
    const imp_term_pair *restrict last = s->last;
    imp_term_pair *restrict next = &s->term[(size_t)s->pairs * n], sizes = {0, 0};
    const imp_linear_entry *e = s->entry;
    for (size_t c = 0; c < n; c++) {
        const imp_linear_entry *const end = s->entry_end[c];
        imp_term_pair sum = {0, 0};
        for (; e != end; e++) sum += e->value * last[e->place];
        next[c] = sum *= factor;
        sizes += size_of(sum);
    }
    s->sizes[s->pairs++] = sizes;
    s->last = next;
}

/* Time in units that are so many times as long. */
static void change_unit(imp_linear_springs *s, double ratio)
{
    const int n = s->closed_count;
    const double square = ratio * ratio;
    imp_term_pair power = {1, ratio}, *term = s->term;
    for (int m = 0; m < s->pairs; m++, power *= square) {
        for (const imp_term_pair *end = term + n; term != end; term++) *term *= power;
        s->sizes[m] *= power;
    }
    s->unit *= ratio;
}

/* How far the terms that are made reach where they do not to 1: of a sum of cosines and sines the last ones tell. */
static double reach_of(const imp_linear_springs *s, double left, double last)
{
    const double some = left > 1 ? sqrt(1 / left) : 1;
    return last > IMP_SPRINGS_TRUNCATION ? fmin(some, pow(IMP_SPRINGS_TRUNCATION / last, 1.0 / (2 * s->pairs - 3)))
                                         : some;
}

/* Terms that reach to 1, or as far as there are terms; returns how far. What velocities' last are followed by is less
 * than a sum that falls by their ratio, twice its first. */
static double make_terms(imp_linear_springs *s)
{
    const double twice = 2 * s->growth * s->unit * s->unit, allowed = IMP_SPRINGS_TRUNCATION * s->unit;
    for (;; expand(s)) {
        const imp_term_pair sizes = s->sizes[s->pairs - 1];
        const double left = -twice * s->factor[s->pairs - 1][1],
                     last = (2 * s->pairs - 1) * (sizes[0] > sizes[1] ? sizes[0] : sizes[1]);
        if (left <= 1 && left * last <= allowed) return 1;
        if (s->pairs == IMP_LINEAR_PAIRS) return reach_of(s, left, last / s->unit);
    }
}

/* Of what is closed the depth's terms; as many. */
static int gather(const imp_linear_springs *s, int closed, double sign, imp_terms f)
{
    const imp_term_pair *term = &s->term[closed];
    for (int m = 0; m < s->pairs; m++, term += s->closed_count) {
        const imp_term_pair p = sign * *term;
        f[2 * m] = p[0], f[2 * m + 1] = p[1];
    }
    return 2 * s->pairs;
}

/* Those of its rate. */
static int gather_rate(const imp_linear_springs *s, int closed, double sign, imp_terms f)
{
    const imp_term_pair *term = &s->term[closed];
    imp_term_pair factor = {0, sign};
    f[0] = sign * (*term)[1];
    for (int m = 1; m < s->pairs; m++) {
        term += s->closed_count, factor += 2 * sign;
        const imp_term_pair p = factor * *term;
        f[2 * m - 1] = p[0], f[2 * m] = p[1];
    }
    return 2 * s->pairs - 1;
}

/* Those of minus the depth of what is open, which begins with the one given. */
static int gather_open(const imp_linear_springs *s, int i, double first, imp_terms f)
{
    imp_term_pair pair[IMP_LINEAR_PAIRS] = {{first, s->line[i].u * s->unit}};
    for (int e = s->start[i]; e < s->start[i + 1]; e++) {
        const int c = s->place[s->row[e]];
        if (c < 0) continue;
        const double factor = -s->unit * s->unit * s->value[e] * s->line[s->row[e]].kappa;
        const imp_term_pair *term = &s->term[c];
        for (int m = 1; m < s->pairs; m++, term += s->closed_count) pair[m] += factor * s->factor[m] * *term;
    }
    for (int m = 0; m < s->pairs; m++) f[2 * m] = pair[m][0], f[2 * m + 1] = pair[m][1];
    return 2 * s->pairs;
}

/* ---- which event comes first ---- */

typedef enum change { CHANGE_NONE, CHANGE_TURN, CHANGE_TOUCH, CHANGE_AGAIN } change;

typedef struct first_change {
    change what;
    imp_linear_spring *line;
    double when;
} first_change;

/* A depth by six terms, its rate by five. */
static void bound_rest(imp_linear_springs *s)
{
    double depth = 0, rate = 0, k = 7;
    for (int m = 3; m < s->pairs; m++, k += 2) {
        const double both = s->sizes[m][0] + s->sizes[m][1];
        depth += both;
        rate += k * both;
    }
    s->rest[0] = depth, s->rest[1] = rate;
}

/* Whether sign x, from `first` just above 0 where it is not yet, stays above. */
static bool depth_stays(const imp_linear_springs *s, int closed, double sign, double first)
{
    const imp_term_pair *term = &s->term[closed];
    const imp_term_pair a = sign * term[0], b = sign * term[s->closed_count], c = sign * term[2 * s->closed_count];
    const double f[5] = {first, a[1], b[0], b[1], c[0]};
    return imp_springs_begins_above(f, s->rest[0] - below(c[1]));
}

static bool rate_stays(const imp_linear_springs *s, int closed, double sign)
{
    const imp_term_pair *term = &s->term[closed], two = {2, 3}, four = {4, 5};
    const imp_term_pair a = sign * term[0], b = sign * two * term[s->closed_count],
                        c = sign * four * term[2 * s->closed_count];
    const double f[5] = {a[1], b[0], b[1], c[0], c[1]};
    return imp_springs_begins_above(f, s->rest[1]);
}

/* f may fall to 0 sooner, about when it is told, or 0. */
static void see_fall(const imp_terms f, int terms, double about, change what, imp_linear_spring *line,
                     first_change *first)
{
    bool found;
    if (about == 0 && imp_springs_is_clear(f, terms)) return;
    double t = imp_springs_lone_fall(f, terms - 1, about, &found);
    if (!found && !imp_springs_is_clear(f, terms)) t = imp_springs_first_fall(f, terms - 1, first->when, &found);
    if (found && t < first->when) *first = (first_change){what, line, t};
}

static void see_turn(const imp_linear_springs *s, int closed, double about, first_change *first)
{
    imp_terms f;
    if (rate_stays(s, closed, 1)) return;
    const int terms = gather_rate(s, closed, 1, f);
    see_fall(f, terms, about, CHANGE_TURN, &s->line[s->closed[closed]], first);
}

/* sign x + shift; from just above 0 where it is not yet. */
static void see_depth(const imp_linear_springs *s, int closed, double sign, double shift, double about, change what,
                      first_change *first)
{
    imp_terms f;
    imp_linear_spring *l = &s->line[s->closed[closed]];
    const double begins = sign * l->x + shift, above = begins > 0 ? begins : IMP_SPRINGS_JUST * l->tiny;
    if (depth_stays(s, closed, sign, above)) return;
    const int terms = gather(s, closed, sign, f);
    f[0] = above;
    see_fall(f, terms, about, what, l, first);
}

static bool will_turn(const imp_linear_spring *l) { return l->normal == IMP_SPRING_LOADS && l->restitution < 1; }

static void see_closed(const imp_linear_springs *s, int closed, double about, first_change *first)
{
    const imp_linear_spring *l = &s->line[s->closed[closed]];
    if (will_turn(l)) {
        see_turn(s, closed, about, first);
        return;
    }
    see_depth(s, closed, 1, -l->tiny, about, CHANGE_TOUCH, first);
    const double again = imp_linear_again(l);
    if (l->normal == IMP_SPRING_UNLOADS && l->x < again) see_depth(s, closed, -1, again, 0, CHANGE_AGAIN, first);
}

/* What is open moves by -u t - W Q to t. Nothing pulls, so that Q'' = kappa x >= 0, and of those that draw it deeper Q
 * is at most its last value's part of time: between its place and one on that line it comes no further. */
static void see_open(const imp_linear_springs *s, int i, double t, first_change *first)
{
    imp_linear_spring *l = &s->line[i];
    imp_terms f;
    const double off = l->tiny - l->x, above = off > 0 ? off : IMP_SPRINGS_JUST * l->tiny;
    if (above + below(l->u * t - s->drawn[i]) > 0) return;
    const int terms = gather_open(s, i, above, f);
    see_fall(f, terms, 0, CHANGE_TOUCH, l, first);
}

/* Of what is closed F's integral to t, and that one's. */
static void sum_up(imp_linear_springs *s, double t)
{
    const int n = s->closed_count;
    const double time = t * s->unit, square = t * t;
    imp_term_pair part[2 * IMP_LINEAR_PAIRS], power = {time, time * t}, *restrict push = s->push;
    for (int m = 0; m < s->pairs; m++, power *= square) {
        part[2 * m] = power * s->once[m];
        part[2 * m + 1] = power * time * s->twice[m];
    }
    for (int c = 0; c < n; c++) {
        imp_term_pair first = {0, 0}, second = {0, 0};
        const imp_term_pair *term = &s->term[s->pairs * n + c];
        for (const imp_term_pair *p = part + 2 * s->pairs; p != part;) {
            term -= n, p -= 2;
            first += *term * p[0];
            second += *term * p[1];
        }
        push[c] = s->kappa[s->closed[c]] * (imp_term_pair){first[0] + first[1], second[0] + second[1]};
    }
}

/* What that makes of all velocities and depths. */
static void find_gains(imp_linear_springs *s)
{
    imp_term_pair *restrict gain = s->gain;
    double *restrict drawn = s->drawn;
    const int *restrict row = s->row;
    const double *restrict value = s->value;
    for (int i = 0; i < s->count; i++) gain[i] = (imp_term_pair){0, 0}, drawn[i] = 0;
    for (int c = 0; c < s->closed_count; c++) {
        const int j = s->closed[c], to = s->start[j + 1];
        const imp_term_pair push = s->push[c];
        for (int e = s->start[j]; e < to; e++) {
            gain[row[e]] += value[e] * push;
            drawn[row[e]] -= below(value[e]) * push[1];
        }
    }
}

static void push_to(imp_linear_springs *s, double t)
{
    sum_up(s, t);
    find_gains(s);
}

/* The one that seems to come first, and when, is looked for first. Pushes and gains are those to its time. */
static first_change find_first(imp_linear_springs *s, int nearest, double soonest)
{
    first_change first = {CHANGE_NONE, NULL, 1};
    const double reach = make_terms(s);
    if (reach < 1) change_unit(s, reach);
    bound_rest(s);
    if (nearest >= 0) see_closed(s, nearest, soonest < s->unit ? soonest / s->unit : 0, &first);
    for (int c = 0; c < s->closed_count; c++)
        if (c != nearest) see_closed(s, c, 0, &first);
    push_to(s, first.when);
    const double closed = first.when;
    for (int i = 0; i < s->count; i++)
        if (s->place[i] < 0) see_open(s, i, closed * s->unit, &first);
    if (first.when < closed) push_to(s, first.when);
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
    const bool turns = will_turn(l);
    const int terms = turns ? gather_rate(s, closed, 1, f) : gather(s, closed, 1, f);
    f[0] -= turns ? 0 : l->tiny;
    for (int k = 0; k < 2; k++) {
        double value = 0, slope = 0;
        for (int m = terms - 1; m >= 0; m--) slope = slope * when + value, value = value * when + f[m];
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
        const imp_term_pair first = s->term[c], second = s->term[s->closed_count + c];
        const bool turns = will_turn(l);
        const double f0 = turns ? first[1] : first[0] - l->tiny, f1 = turns ? 2 * second[0] : first[1],
                     f2 = turns ? 3 * second[1] : second[0];
        if (!may_fall(f0, f1, f2, soonest)) continue;
        const double t = zero_of(f0, f1, f2);
        if (t < soonest) soonest = t, *nearest = c;
    }
    for (int i = 0; i < s->count; i++) {
        const imp_linear_spring *l = &s->line[i];
        if (s->place[i] < 0 && l->x < 0 && l->x - l->u * soonest > 0) soonest = l->x / l->u, *nearest = -1;
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
    imp_terms f;
    double x = 0;
    for (int k = gather(s, closed, 1, f) - 1; k >= 0; k--) x = x * t + f[k];
    return x;
}

/* Where u changes its sign before t; what loads and will turn has no such time, and most have one at most. */
static int see_changes(const imp_linear_springs *s, int closed, double sign, double t, double *when)
{
    const imp_linear_spring *l = &s->line[s->closed[closed]];
    imp_terms f;
    bool found = false;
    if (will_turn(l) || rate_stays(s, closed, sign)) return 0;
    const int terms = gather_rate(s, closed, sign, f);
    if (imp_springs_is_clear(f, terms)) return 0;
    if (f[0] > 0) *when = imp_springs_lone_fall(f, terms - 1, 0, &found);
    return found ? *when < t : imp_springs_sign_changes(f, terms - 1, t, when, IMP_SPRINGS_EXTREMES);
}

/* The spring's work to t; where u changes its sign on the way the energy has an extreme. */
static void book_line(const imp_linear_springs *s, int closed, double t)
{
    imp_linear_spring *l = &s->line[s->closed[closed]];
    double when[IMP_SPRINGS_EXTREMES];
    const double rate = s->term[closed][1];
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

/* By the gains to t; false: they are none. */
static bool move_lines_on(imp_linear_springs *s, double t)
{
    const double time = t * s->unit;
    double sum = 0;
    for (int i = 0; i < s->count; i++) {
        imp_linear_spring *l = &s->line[i];
        l->x -= l->u * time + s->gain[i][1];
        l->u += s->gain[i][0];
        sum += l->x;
    }
    for (int c = 0; c < s->closed_count; c++) {
        s->line[s->closed[c]].p += s->push[c][0];
        book_line(s, c, t);
    }
    return isfinite(sum);
}

bool imp_linear_step(imp_linear_springs *s)
{
    int nearest;
    begin_series(s);
    expand(s);
    expand(s);
    double soonest = look_ahead(s, &nearest);
    if (nearest >= 0) soonest = look_closer(s, nearest, soonest);
    change_unit(s, IMP_LINEAR_AHEAD * soonest);
    first_change first = find_first(s, nearest, soonest);
    while (first.what == CHANGE_NONE && s->pairs < IMP_LINEAR_PAIRS && 2 * s->unit <= IMP_SPRINGS_FARTHEST) {
        change_unit(s, 2);
        first = find_first(s, nearest, soonest);
    }
    if (!move_lines_on(s, first.when)) return false;
    s->steps++;
    s->events += first.line != NULL;
    if (first.what == CHANGE_TURN) first.line->u = fmax(first.line->u, 0);
    if (first.what == CHANGE_TOUCH) first.line->x = first.line->tiny;
    if (first.what == CHANGE_AGAIN) first.line->x = fmax(first.line->x, imp_linear_again(first.line));
    return true;
}
