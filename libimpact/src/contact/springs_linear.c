/* SPDX-License-Identifier: MIT
 *
 * Linear springs without friction, where speed is wanted: the equations of springs.h with normals alone,
 *
 *     delta' = -u,  u' = W F,  F = kappa (delta - base) or 0,      delta'' = -W F:   x_(k+2) = -(W F_k)/((k+1)(k+2))
 *
 * so that a term of all costs as many products as W has entries under what is closed. Modes (cosines of W K's
 * eigenvalues) would have to be found anew at each of some six events a contact, at n^3 each.
 *
 * Events are those of springs_changes.c. What takes long, as wedges do, is left to the general solver.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/tolerances.h"

/* Of depths: one more than velocities have. */
enum { TERMS = IMP_SPRINGS_TERMS };

typedef struct line {
    imp_spring_normal normal;
    double restitution, stiffness, own; /* own: W_nn */
    double x, base, kappa, deepest, tiny;
    double u0, u, p, stored, none; /* none: a velocity that is rounding of u's terms */
    imp_finding *finding;
} line;

typedef struct lines {
    int count;
    line *line;
    int *start, *column; /* W by rows without zeros */
    double *value;
    int *pressed_start, *pressed_column; /* W kappa under what is closed */
    double *pressed_value;
    double *depth;   /* TERMS rows of x's terms, of all contacts each */
    double *x, *sum; /* x at a step's end; its integral from the beginning */
    imp_terms power; /* h^k of the step */
    long events, steps;
} lines;

/* ---- changes: springs_changes.c says why ---- */

static double energy_of(const line *l) { return l->x > 0 ? 0.5 * l->kappa * l->x * l->x : 0; }

static void take_branch(line *l, imp_spring_normal normal, double base, double kappa)
{
    l->normal = normal;
    l->x += l->base - base;
    l->base = base;
    l->kappa = kappa;
    l->tiny = sqrt(2 * IMP_SPRINGS_ENERGY_LINEAR / (kappa * l->own));
}

static void turn_line(line *l)
{
    const double square = l->restitution * l->restitution;
    l->deepest = l->x;
    take_branch(l, IMP_SPRING_UNLOADS, (1 - square) * l->deepest, l->stiffness / square);
    l->x = square * l->deepest; /* without the difference's rounding */
    l->finding->compressions++;
}

static double line_again(const line *l) { return IMP_SPRINGS_PAST * l->restitution * l->restitution * l->deepest; }

/* What is due; whether anything was. */
static bool settle_line(line *l, bool pressed)
{
    if (l->normal == IMP_SPRING_OPEN) {
        if (l->x < l->tiny * (1 - IMP_SPRINGS_TOGETHER) || l->u >= (pressed ? 0 : -l->none)) return false;
        l->normal = l->deepest > 0 ? IMP_SPRING_UNLOADS : IMP_SPRING_LOADS;
        l->x = l->tiny; /* after a long flight x is rounded by far more */
    } else if (l->x <= l->tiny * (1 + IMP_SPRINGS_TOGETHER) && l->u >= 0) {
        l->normal = IMP_SPRING_OPEN;
    } else if (l->normal == IMP_SPRING_LOADS && l->restitution < 1 && l->u >= 0) {
        turn_line(l);
    } else if (l->normal == IMP_SPRING_UNLOADS && l->x >= line_again(l) && l->u < 0) {
        take_branch(l, IMP_SPRING_LOADS, 0, l->stiffness);
    } else {
        return false;
    }
    l->stored = energy_of(l);
    return true;
}

static bool any_pressed(const lines *s)
{
    for (int i = 0; i < s->count; i++)
        if (s->line[i].normal != IMP_SPRING_OPEN) return true;
    return false;
}

static void settle_lines(lines *s)
{
    const bool pressed = any_pressed(s);
    for (int i = 0; i < s->count; i++) s->events += settle_line(&s->line[i], pressed);
}

/* ---- the series ---- */

/* W's entries under what is closed, times kappa. */
static void press_lines(lines *s)
{
    int filled = 0;
    for (int i = 0; i < s->count; i++) {
        s->pressed_start[i] = filled;
        for (int e = s->start[i]; e < s->start[i + 1]; e++) {
            const line *l = &s->line[s->column[e]];
            if (l->normal == IMP_SPRING_OPEN) continue;
            s->pressed_column[filled] = s->column[e];
            s->pressed_value[filled++] = s->value[e] * l->kappa;
        }
    }
    s->pressed_start[s->count] = filled;
}

static void expand_lines(lines *s)
{
    const int n = s->count;
    press_lines(s);
    for (int i = 0; i < n; i++) s->depth[i] = s->line[i].x, s->depth[n + i] = -s->line[i].u;
    for (int k = 0; k + 2 < TERMS; k++) {
        const double *x = &s->depth[k * n], part = -1.0 / ((k + 1) * (k + 2));
        double *next = &s->depth[(k + 2) * n];
        for (int i = 0; i < n; i++) {
            double sum = 0;
            for (int e = s->pressed_start[i]; e < s->pressed_start[i + 1]; e++)
                sum += s->pressed_value[e] * x[s->pressed_column[e]];
            next[i] = part * sum;
        }
    }
}

static double greatest_term(const double *terms, int n)
{
    double most = 0;
    for (int i = 0; i < n; i++) {
        const double size = fabs(terms[i]);
        most = size > most ? size : most;
    }
    return most;
}

/* How far they reach: of a sum of cosines and sines the last even and odd terms tell. */
static double reach_of_lines(const lines *s)
{
    const double most = log2(IMP_SPRINGS_TRUNCATION) / IMP_SPRINGS_ORDER;
    double h = IMP_SPRINGS_FARTHEST;
    for (int k = TERMS - 2; k < TERMS; k++) {
        const double size = k * greatest_term(&s->depth[k * s->count], s->count); /* of velocities */
        if (isnan(size)) return NAN;
        if (size > 0) h = fmin(h, exp2(most - log2(size) / (k - 1)));
    }
    return h;
}

/* Contact i's depth, or its velocity u = -x'. */
static void gather(const lines *s, int i, double sign, imp_terms f)
{
    for (int k = 0; k < TERMS; k++) f[k] = sign * s->depth[k * s->count + i];
}

static void gather_velocity(const lines *s, int i, double sign, imp_terms f)
{
    for (int k = 0; k + 1 < TERMS; k++) f[k] = -sign * (k + 1) * s->depth[(k + 1) * s->count + i];
    f[TERMS - 1] = 0;
}

/* ---- events ---- */

/* Sooner than *when: f falls to 0; from `just` where it is not above yet. The powers are of *when. */
static bool line_falls(lines *s, imp_terms f, double just, double *when)
{
    bool found;
    if (!(f[0] > 0)) f[0] = just;
    if (imp_springs_stay_above(f, TERMS, s->power)) return false;
    const double t = imp_springs_first_fall(f, TERMS - 1, *when, &found);
    if (!found) return false;
    *when = t;
    imp_springs_find_powers(t, s->power);
    return true;
}

typedef enum change { CHANGE_NONE, CHANGE_TURN, CHANGE_TOUCH, CHANGE_AGAIN } change;

static change first_change(lines *s, int i, double *when)
{
    const line *l = &s->line[i];
    const double just = IMP_SPRINGS_JUST * l->tiny;
    imp_terms f;
    if (l->normal == IMP_SPRING_LOADS && l->restitution < 1) {
        gather_velocity(s, i, -1, f);
        return line_falls(s, f, 0, when) ? CHANGE_TURN : CHANGE_NONE;
    }
    const double sign = l->normal == IMP_SPRING_OPEN ? -1 : 1;
    gather(s, i, sign, f);
    f[0] -= sign * l->tiny;
    const change touches = line_falls(s, f, just, when) ? CHANGE_TOUCH : CHANGE_NONE;
    if (l->normal != IMP_SPRING_UNLOADS || l->x >= line_again(l)) return touches;
    gather(s, i, -1, f);
    f[0] += line_again(l);
    return line_falls(s, f, just, when) ? CHANGE_AGAIN : touches;
}

/* ---- to there ---- */

static void find_line_velocities(lines *s)
{
    for (int i = 0; i < s->count; i++) {
        double sum = 0, terms = 0;
        for (int e = s->start[i]; e < s->start[i + 1]; e++) {
            const double term = s->value[e] * s->line[s->column[e]].p;
            sum += term;
            terms += fabs(term);
        }
        s->line[i].u = s->line[i].u0 + sum;
        s->line[i].none = IMP_SPRINGS_STILL * (terms > 1 ? terms : 1);
    }
}

static void note_line(line *l, impact_phase phase)
{
    imp_finding *f = l->finding;
    if (f->phase_count > 0 && f->phases[f->phase_count - 1] == phase) return;
    if (f->phase_count < IMPACT_MAX_PHASES) f->phases[f->phase_count++] = (unsigned char)phase;
}

static void book_line_energy(line *l, double energy)
{
    const double rise = energy - l->stored;
    l->finding->work[rise > 0 ? 0 : 1] -= rise;
    l->stored = energy;
}

static double depth_at(const lines *s, int i, double t)
{
    double x = 0;
    for (int k = TERMS - 1; k >= 0; k--) x = x * t + s->depth[k * s->count + i];
    return x;
}

/* The spring's work to t; where u changes its sign on the way the energy has an extreme. What loads and will turn has
 * none before that. */
static void book_line(const lines *s, int i, double t)
{
    line *l = &s->line[i];
    const double x = l->x;
    double when[IMP_SPRINGS_EXTREMES];
    bool compressed = s->depth[s->count + i] > 0 || (s->depth[s->count + i] == 0 && l->u < 0);
    int changes = 0;
    if (l->normal != IMP_SPRING_LOADS || l->restitution == 1) {
        imp_terms f;
        gather_velocity(s, i, 1, f);
        changes = imp_springs_sign_changes(f, TERMS - 2, t, when, IMP_SPRINGS_EXTREMES);
    }
    note_line(l, compressed ? IMPACT_SLIP_C : IMPACT_SLIP_R);
    for (int k = 0; k < changes; k++) {
        l->x = depth_at(s, i, when[k]);
        book_line_energy(l, energy_of(l));
        l->finding->compressions += compressed;
        compressed = !compressed;
        note_line(l, compressed ? IMPACT_SLIP_C : IMPACT_SLIP_R);
    }
    l->x = x;
    book_line_energy(l, energy_of(l));
}

/* Depths at t, and their integrals up to it. */
static void sum_terms(lines *s, double t)
{
    const int n = s->count;
    for (int i = 0; i < n; i++) s->x[i] = s->sum[i] = 0;
    for (int k = TERMS - 1; k >= 0; k--) {
        const double *terms = &s->depth[k * n], power = s->power[k],
                     part = k + 1 < TERMS ? power * t / (k + 1) : 0; /* p has the velocities' order */
        for (int i = 0; i < n; i++) {
            s->x[i] += power * terms[i];
            s->sum[i] += part * terms[i];
        }
    }
}

static void move_lines_on(lines *s, double t)
{
    imp_springs_find_powers(t, s->power);
    sum_terms(s, t);
    for (int i = 0; i < s->count; i++) {
        line *l = &s->line[i];
        l->x = s->x[i];
        if (l->normal != IMP_SPRING_OPEN) l->p += l->kappa * s->sum[i];
    }
    find_line_velocities(s);
    for (int i = 0; i < s->count; i++)
        if (s->line[i].normal != IMP_SPRING_OPEN) book_line(s, i, t);
}

static bool step_lines(lines *s)
{
    expand_lines(s);
    double when = reach_of_lines(s);
    s->steps++;
    if (isnan(when)) return false;
    imp_springs_find_powers(when, s->power);
    line *first = NULL;
    change what = CHANGE_NONE;
    for (int i = 0; i < s->count; i++) {
        const change own = first_change(s, i, &when);
        if (own != CHANGE_NONE) first = &s->line[i], what = own;
    }
    move_lines_on(s, when);
    s->events += first != NULL;
    if (what == CHANGE_TURN) first->u = fmax(first->u, 0);
    if (what == CHANGE_TOUCH) first->x = first->tiny;
    if (what == CHANGE_AGAIN) first->x = fmax(first->x, line_again(first));
    return true;
}

/* Nothing presses: to the next closing. False: there is none. */
static bool drift_lines(lines *s)
{
    double soonest = INFINITY;
    line *next = NULL;
    for (int i = 0; i < s->count; i++) {
        line *l = &s->line[i];
        const double time = l->u < -l->none ? fmax(0, l->tiny - l->x) / -l->u : INFINITY;
        if (time < soonest) soonest = time, next = l;
    }
    if (!next) return false;
    for (int i = 0; i < s->count; i++) s->line[i].x -= s->line[i].u * soonest;
    next->x = next->tiny;
    return true;
}

/* ---- the whole ---- */

static double normal_product(const imp_contact *a, const imp_contact *b)
{
    double sum = 0;
    for (int s = 0; s < 2; s++)
        for (int t = 0; t < 2; t++)
            for (int m = 0; m < 6 && a->body[s] == b->body[t]; m++) sum += a->row[s][0][m] * b->row[t][0][m];
    return sum;
}

static bool lay_out_lines(lines *s, const imp_contact *contacts, impact_together_workspace *workspace)
{
    const size_t n = (size_t)s->count;
    s->line = imp_encounter_take(workspace, n, sizeof *s->line);
    s->start = imp_encounter_take(workspace, n + 1, sizeof *s->start);
    s->column = imp_encounter_take(workspace, n * n, sizeof *s->column);
    s->value = imp_encounter_take(workspace, n * n, sizeof *s->value);
    s->pressed_start = imp_encounter_take(workspace, n + 1, sizeof *s->pressed_start);
    s->pressed_column = imp_encounter_take(workspace, n * n, sizeof *s->pressed_column);
    s->pressed_value = imp_encounter_take(workspace, n * n, sizeof *s->pressed_value);
    s->depth = imp_encounter_take(workspace, TERMS * n, sizeof *s->depth);
    s->x = imp_encounter_take(workspace, n, sizeof *s->x);
    s->sum = imp_encounter_take(workspace, n, sizeof *s->sum);
    if (!s->sum) return false;
    int filled = 0;
    for (int i = 0; i < s->count; i++) {
        s->start[i] = filled;
        for (int j = 0; j < s->count; j++) {
            /* whichever comes first, so that it is symmetric to the bit */
            const double entry =
                i < j ? normal_product(&contacts[i], &contacts[j]) : normal_product(&contacts[j], &contacts[i]);
            if (entry == 0) continue;
            s->column[filled] = j;
            s->value[filled++] = entry;
            if (i == j) s->line[i].own = entry;
        }
    }
    s->start[s->count] = filled;
    return true;
}

typedef struct line_units {
    double velocity, mobility, stiffness;
} line_units;

static line_units find_line_units(const lines *s, const imp_group *group)
{
    line_units u = {0, 0, 0};
    for (int i = 0; i < s->count; i++) {
        u.velocity = fmax(u.velocity, fabs(group->u0[3 * i]));
        u.mobility += s->line[i].own / s->count;
        u.stiffness = fmax(u.stiffness, group->contacts[i].stiffness);
    }
    return (line_units){imp_encounter_unit(u.velocity), imp_encounter_unit(u.mobility), u.stiffness};
}

static void set_up_lines(lines *s, const imp_group *group, line_units unit)
{
    for (int e = 0; e < s->start[s->count]; e++) s->value[e] /= unit.mobility;
    for (int i = 0; i < s->count; i++) {
        line *l = &s->line[i];
        l->own /= unit.mobility;
        l->u = l->u0 = group->u0[3 * i] / unit.velocity;
        l->restitution = fmax(group->contacts[i].restitution, group->least);
        l->stiffness = group->contacts[i].stiffness / unit.stiffness;
        l->finding = &group->findings[i];
        l->none = IMP_SPRINGS_STILL;
        take_branch(l, IMP_SPRING_OPEN, 0, l->stiffness);
    }
}

static void report_lines(const lines *s, line_units unit, imp_group *group)
{
    const double impulse = unit.velocity / unit.mobility;
    for (int i = 0; i < s->count; i++) {
        group->p[3 * i] = s->line[i].p * impulse;
        for (int j = 0; j < 2; j++) group->findings[i].work[j] *= unit.velocity * impulse;
        group->error = fmax(group->error, s->line[i].restitution - group->contacts[i].restitution);
    }
    group->events += s->events;
    group->steps += s->steps;
}

impact_status imp_springs_solve_linear(imp_group *group, impact_together_workspace *workspace)
{
    lines s = {.count = group->count};
    if (!lay_out_lines(&s, group->contacts, workspace)) return IMPACT_ENOMEM;
    const line_units unit = find_line_units(&s, group);
    set_up_lines(&s, group, unit);
    while (s.steps + s.events < fmin(IMP_SPRINGS_LONG, group->patience)) {
        settle_lines(&s);
        if (any_pressed(&s)) {
            if (!step_lines(&s)) return IMPACT_EUNSETTLED;
        } else if (!drift_lines(&s)) {
            report_lines(&s, unit, group);
            return IMPACT_OK;
        }
    }
    return IMPACT_EUNSETTLED;
}
