/* SPDX-License-Identifier: MIT
 *
 * Linear springs without friction, from the first closing until nothing presses and nothing approaches; equations in
 * springs_linear.h. Events are those of springs_changes.c. What takes long, as wedges do, is left to the general
 * solver.
 */
#include "contact/springs_linear.h"

#include <math.h>
#include "base/tolerances.h"

/* ---- changes: springs_changes.c says why ---- */

double imp_linear_energy(const imp_linear_spring *l, double x) { return x > 0 ? 0.5 * l->kappa * x * x : 0; }

double imp_linear_again(const imp_linear_spring *l)
{
    return IMP_SPRINGS_PAST * l->restitution * l->restitution * l->deepest;
}

static void take_branch(imp_linear_spring *l, imp_spring_normal normal, double base, double kappa)
{
    l->normal = normal;
    l->x += l->base - base;
    l->base = base;
    l->kappa = kappa;
    l->tiny = sqrt(2 * IMP_SPRINGS_ENERGY_LINEAR / (kappa * l->own));
}

static void turn_line(imp_linear_spring *l)
{
    const double square = l->restitution * l->restitution;
    l->deepest = l->x;
    take_branch(l, IMP_SPRING_UNLOADS, (1 - square) * l->deepest, l->stiffness / square);
    l->x = square * l->deepest; /* without the difference's rounding */
    l->finding->compressions++;
}

/* A velocity that is rounding of u's terms. */
static double rounding_of(const imp_linear_springs *s, int i)
{
    double terms = 0;
    for (int e = s->start[i]; e < s->start[i + 1]; e++) terms += fabs(s->value[e] * s->line[s->row[e]].p);
    return IMP_SPRINGS_STILL * (terms > 1 ? terms : 1);
}

/* What is due; whether anything was. */
static bool settle_line(imp_linear_springs *s, int i, bool pressed)
{
    imp_linear_spring *l = &s->line[i];
    if (l->normal == IMP_SPRING_OPEN) {
        if (l->x < l->tiny * (1 - IMP_SPRINGS_TOGETHER) || l->u >= 0) return false;
        if (!pressed && l->u >= -rounding_of(s, i)) return false;
        l->normal = l->deepest > 0 ? IMP_SPRING_UNLOADS : IMP_SPRING_LOADS;
        l->x = l->tiny; /* after a long flight x is rounded by far more */
    } else if (l->x <= l->tiny * (1 + IMP_SPRINGS_TOGETHER) && l->u >= 0) {
        l->normal = IMP_SPRING_OPEN;
    } else if (l->normal == IMP_SPRING_LOADS && l->restitution < 1 && l->u >= 0) {
        turn_line(l);
    } else if (l->normal == IMP_SPRING_UNLOADS && l->x >= imp_linear_again(l) && l->u < 0) {
        take_branch(l, IMP_SPRING_LOADS, 0, l->stiffness);
    } else {
        return false;
    }
    l->stored = imp_linear_energy(l, l->x);
    return true;
}

/* u = u0 + W p: without the rounding of the steps. */
static void find_line_velocities(imp_linear_springs *s)
{
    for (int i = 0; i < s->count; i++) s->line[i].u = s->line[i].u0;
    for (int j = 0; j < s->count; j++) {
        const double p = s->line[j].p;
        for (int e = s->start[j]; p != 0 && e < s->start[j + 1]; e++) s->line[s->row[e]].u += s->value[e] * p;
    }
}

/* Whether anything presses then. */
static bool settle_lines(imp_linear_springs *s)
{
    const bool pressed = s->closed_count > 0;
    if (!pressed) find_line_velocities(s);
    for (int i = 0; i < s->count; i++) s->events += settle_line(s, i, pressed);
    return imp_linear_find_closed(s);
}

/* Nothing presses: to the next closing. False: there is none. */
static bool drift_lines(imp_linear_springs *s)
{
    double soonest = INFINITY;
    imp_linear_spring *next = NULL;
    for (int i = 0; i < s->count; i++) {
        imp_linear_spring *l = &s->line[i];
        const double time = l->u < -rounding_of(s, i) ? fmax(0, l->tiny - l->x) / -l->u : INFINITY;
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
        for (int t = 0; t < 2; t++) {
            if (a->body[s] != b->body[t]) continue;
            for (int m = 0; m < 6; m++) sum += a->row[s][0][m] * b->row[t][0][m];
        }
    return sum;
}

static bool take_line_room(imp_linear_springs *s, impact_together_workspace *workspace)
{
    const size_t n = (size_t)s->count;
    s->line = imp_encounter_take(workspace, n, sizeof *s->line);
    s->start = imp_encounter_take(workspace, n + 1, sizeof *s->start);
    s->row = imp_encounter_take(workspace, n * n, sizeof *s->row);
    s->value = imp_encounter_take(workspace, n * n, sizeof *s->value);
    s->closed = imp_encounter_take(workspace, n, sizeof *s->closed);
    s->place = imp_encounter_take(workspace, n, sizeof *s->place);
    s->entry = imp_encounter_take(workspace, n * n, sizeof *s->entry);
    s->entry_end = imp_encounter_take(workspace, n, sizeof *s->entry_end);
    s->term = imp_encounter_take(workspace, IMP_LINEAR_PAIRS * n, sizeof *s->term);
    s->push = imp_encounter_take(workspace, n, sizeof *s->push);
    s->gain = imp_encounter_take(workspace, n, sizeof *s->gain);
    s->kappa = imp_encounter_take(workspace, n, sizeof *s->kappa);
    s->drawn = imp_encounter_take(workspace, n, sizeof *s->drawn);
    return !workspace->work.spent;
}

static void lay_out_lines(imp_linear_springs *s, const imp_contact *contacts)
{
    const int n = s->count;
    imp_linear_entry *whole = s->entry; /* each product once, so that it is symmetric to the bit */
    int filled = 0;
    for (int i = 0; i < n; i++)
        for (int j = i; j < n; j++)
            whole[i * n + j].value[0] = whole[j * n + i].value[0] = normal_product(&contacts[i], &contacts[j]);
    for (int i = 0; i < n; i++) {
        s->start[i] = filled;
        for (int j = 0; j < n; j++) {
            if (whole[i * n + j].value[0] == 0) continue;
            s->row[filled] = j;
            s->value[filled++] = whole[i * n + j].value[0];
        }
        s->line[i].own = whole[i * n + i].value[0];
    }
    s->start[n] = filled;
}

typedef struct line_units {
    double velocity, mobility, stiffness;
} line_units;

static line_units find_line_units(const imp_linear_springs *s, const imp_group *group)
{
    line_units u = {0, 0, 0};
    for (int i = 0; i < s->count; i++) {
        u.velocity = fmax(u.velocity, fabs(group->u0[3 * i]));
        u.mobility += s->line[i].own / s->count;
        u.stiffness = fmax(u.stiffness, group->contacts[i].stiffness);
    }
    return (line_units){imp_encounter_unit(u.velocity), imp_encounter_unit(u.mobility), u.stiffness};
}

static void set_up_lines(imp_linear_springs *s, const imp_group *group, line_units unit)
{
    for (int e = 0; e < s->start[s->count]; e++) s->value[e] /= unit.mobility;
    for (int i = 0; i < s->count; i++) {
        imp_linear_spring *l = &s->line[i];
        l->own /= unit.mobility;
        l->u = l->u0 = group->u0[3 * i] / unit.velocity;
        l->restitution = fmax(group->contacts[i].restitution, group->least);
        l->stiffness = group->contacts[i].stiffness / unit.stiffness;
        l->finding = &group->findings[i];
        take_branch(l, IMP_SPRING_OPEN, 0, l->stiffness);
        if (l->u < 0) l->x = l->tiny; /* all touch: those that approach close at one time */
        s->place[i] = -1;
    }
}

static void report_lines(const imp_linear_springs *s, line_units unit, imp_group *group)
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
    imp_linear_springs s = {.count = group->count};
    if (!take_line_room(&s, workspace)) return IMPACT_ENOMEM;
    lay_out_lines(&s, group->contacts);
    const line_units unit = find_line_units(&s, group);
    set_up_lines(&s, group, unit);
    while (s.steps + s.events < fmin(IMP_SPRINGS_LONG, group->patience)) {
        if (settle_lines(&s)) {
            if (!imp_linear_step(&s)) return IMPACT_EUNSETTLED;
        } else if (!drift_lines(&s)) {
            report_lines(&s, unit, group);
            return IMPACT_OK;
        }
    }
    return IMPACT_EUNSETTLED;
}
