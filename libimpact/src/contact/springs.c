/* SPDX-License-Identifier: MIT
 *
 * The springs of a group, from the first closing until nothing presses and nothing approaches. Units: the mean of W_nn,
 * the greatest velocity and the greatest stiffness, the first two rounded to powers of two, so that units of the data
 * which are powers of two apart change no bit.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/tolerances.h"

typedef struct units {
    double velocity, mobility, stiffness;
} units;

static units find_units(const imp_group *group)
{
    const size_t n = 3 * (size_t)group->count;
    units u = {0, 0, 0};
    for (int i = 0; i < group->count; i++) {
        const imp_contact *c = &group->contacts[i];
        for (int j = 0; j < (c->friction > 0 ? 3 : 1); j++) u.velocity = fmax(u.velocity, fabs(group->u0[3 * i + j]));
        u.mobility += group->w[(size_t)(3 * i) * (n + 1)] / group->count;
        u.stiffness = fmax(u.stiffness, c->stiffness);
    }
    return (units){imp_encounter_unit(u.velocity), imp_encounter_unit(u.mobility), u.stiffness};
}

/* ---- room ---- */

static bool take_room(imp_springs *s, impact_together_workspace *workspace)
{
    const size_t n = (size_t)s->count, width = 3 * n;
    s->springs = imp_encounter_take(workspace, n, sizeof *s->springs);
    s->row_start = imp_encounter_take(workspace, width + 1, sizeof *s->row_start);
    s->column = imp_encounter_take(workspace, width * width, sizeof *s->column);
    s->value = imp_encounter_take(workspace, width * width, sizeof *s->value);
    s->stick = imp_encounter_take(workspace, 2 * n, sizeof *s->stick);
    s->inverse = imp_encounter_take(workspace, 4 * n * n, sizeof *s->inverse);
    s->now = imp_encounter_take(workspace, width, sizeof *s->now);
    s->scratch = imp_encounter_take(workspace, width, sizeof *s->scratch);
    s->factor = imp_encounter_take(workspace, 12 * n * n + 10 * n, sizeof *s->factor);
    s->begin = imp_encounter_take(workspace, n, sizeof *s->begin);
    s->turning = imp_encounter_take(workspace, 2 * n * n + n, sizeof *s->turning);
    s->modes = imp_encounter_take(workspace, n, sizeof *s->modes);
    s->kept = imp_encounter_take(workspace, n, sizeof *s->kept);
    s->creep_room = imp_encounter_take(workspace, imp_springs_creep_size(n), sizeof *s->creep_room);
    s->cone = &workspace->cone;
    return !workspace->work.spent && imp_cone_reserve(s->cone, s->count);
}

/* W's rows without zeros and without columns that never push. */
static void pack_rows(imp_springs *s)
{
    const int width = 3 * s->count;
    int filled = 0;
    for (int i = 0; i < width; i++) {
        s->row_start[i] = filled;
        for (int j = 0; j < width; j++) {
            const double entry = s->w[(size_t)i * (size_t)width + (size_t)j];
            if (entry == 0 || (j % 3 > 0 && s->springs[j / 3].friction == 0)) continue;
            s->column[filled] = j;
            s->value[filled++] = entry;
        }
    }
    s->row_start[width] = filled;
}

static void set_up(imp_springs *s, const imp_group *group, const units *unit, double *w, double *u0)
{
    const size_t width = 3 * (size_t)group->count;
    for (size_t i = 0; i < width * width; i++) w[i] = group->w[i] / unit->mobility;
    for (size_t i = 0; i < width; i++) u0[i] = group->u0[i] / unit->velocity;
    s->w = w, s->u0 = u0;
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        if (group->contacts[i].slip > 0) u0[3 * i] = -IMP_SPRINGS_SEED;
        c->friction = group->contacts[i].friction;
        c->restitution = fmax(group->contacts[i].restitution, group->least);
        c->stiffness = group->contacts[i].stiffness / unit->stiffness;
        c->finding = &group->findings[i];
        c->none = IMP_SPRINGS_STILL;
        imp_springs_take_branch(s, i, IMP_SPRING_OPEN, 0, c->stiffness);
        for (int j = 0; j < 3; j++) c->u[j] = u0[3 * i + j];
    }
    pack_rows(s);
}

/* ---- the answer ---- */

static void report(const imp_springs *s, const units *unit, imp_group *group)
{
    for (int i = 0; i < s->count; i++) {
        for (int j = 0; j < 3; j++) group->p[3 * i + j] = s->springs[i].p[j] * (unit->velocity / unit->mobility);
        for (int j = 0; j < 3; j++) group->findings[i].work[j] *= unit->velocity * (unit->velocity / unit->mobility);
    }
    for (int i = 0; i < s->count; i++)
        group->error = fmax(group->error, s->springs[i].restitution - group->contacts[i].restitution);
    group->events += s->events;
    group->steps += s->steps;
    group->chosen = group->chosen || s->chosen;
}

/* Whether no motion takes the contacts that were pressed apart; rough: with friction against it. */
static bool are_wedged(imp_springs *s, bool rough)
{
    double *friction = s->factor, *room = friction + s->count;
    bool *taken = (bool *)(room + 6 * s->count);
    for (int i = 0; i < s->count; i++) {
        friction[i] = s->springs[i].friction;
        taken[i] = s->springs[i].p[0] > 0 || imp_springs_presses(&s->springs[i]);
    }
    const imp_wedge_question question = {s->count, s->w, rough ? friction : NULL, taken};
    return imp_encounter_wedged(&question, room);
}

/* Asked once after many events, or much of the work allowed, of the normals alone, and once after very many with
 * friction: what is wedged bounces in its dents for ever. */
static bool is_wedged(imp_springs *s, int *asked)
{
    const double spent = fmax((double)(s->events + s->steps) / IMP_SPRINGS_LONG, s->work / IMP_SPRINGS_MUCH);
    const bool now = *asked == 0 ? spent > 1 : *asked == 1 && spent > 10;
    return now && are_wedged(s, (*asked)++ == 1);
}

impact_status imp_springs_solve(imp_group *group, double exponent, impact_together_workspace *workspace)
{
    const size_t width = 3 * (size_t)group->count;
    imp_springs s = {.count = group->count, .exponent = exponent};
    double *w = imp_encounter_take(workspace, width * width, sizeof *w),
           *u0 = imp_encounter_take(workspace, width, sizeof *u0);
    if (!w || !u0 || !take_room(&s, workspace)) return IMPACT_ENOMEM;
    const units unit = find_units(group);
    set_up(&s, group, &unit, w, u0);
    int asked = 0;
    while (s.steps + s.events < group->patience && s.work < IMP_SPRINGS_WORK) {
        if (!imp_springs_settle(&s)) return IMPACT_EUNSETTLED;
        group->wedged = is_wedged(&s, &asked);
        if (group->wedged) return IMPACT_EUNSETTLED;
        if (imp_springs_pressed(&s)) {
            if (!imp_springs_step(&s)) return IMPACT_EUNSETTLED;
        } else if (!imp_springs_drift(&s)) {
            report(&s, &unit, group);
            return IMPACT_OK;
        }
    }
    return IMPACT_EUNSETTLED;
}
