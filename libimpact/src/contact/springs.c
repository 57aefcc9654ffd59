/* SPDX-License-Identifier: MIT
 *
 * The springs of a group, from the first closing until nothing presses and nothing approaches. Units: the mean of W_nn,
 * the greatest velocity and the greatest stiffness, the first two rounded to powers of two, so that units of the data
 * which are powers of two apart change no bit.
 */
#include "contact/springs.h"

#include <math.h>
#include <string.h>
#include "base/tolerances.h"
#include "contact/least.h"

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

static imp_spring_rows take_rows(impact_together_workspace *workspace, size_t width)
{
    return (imp_spring_rows){imp_encounter_take(workspace, width + 1, sizeof(int)),
                             imp_encounter_take(workspace, width * width, sizeof(int))};
}

static bool take_room(imp_springs *s, impact_together_workspace *workspace)
{
    const size_t n = (size_t)s->count, width = 3 * n;
    s->springs = imp_encounter_take(workspace, n, sizeof *s->springs);
    s->rows = take_rows(workspace, width);
    s->pressed = take_rows(workspace, width);
    s->stick = imp_encounter_take(workspace, 2 * n, sizeof *s->stick);
    s->inverse = imp_encounter_take(workspace, 4 * n * n, sizeof *s->inverse);
    s->now = imp_encounter_take(workspace, width, sizeof *s->now);
    s->scratch = imp_encounter_take(workspace, width, sizeof *s->scratch);
    s->factor = imp_encounter_take(workspace, 12 * n * n + 22 * n, sizeof *s->factor);
    s->wedge = imp_encounter_take(workspace, imp_encounter_wedge_size(n), sizeof *s->wedge);
    s->begin = imp_encounter_take(workspace, n, sizeof *s->begin);
    s->turning = imp_encounter_take(workspace, 2 * n * n + n, sizeof *s->turning);
    s->modes = imp_encounter_take(workspace, n, sizeof *s->modes);
    s->kept = imp_encounter_take(workspace, n, sizeof *s->kept);
    s->creep_room = imp_encounter_take(workspace, imp_springs_creep_size(n), sizeof *s->creep_room);
    s->bounces.room = imp_encounter_take(workspace, imp_springs_bounces_size(n), sizeof *s->bounces.room);
    s->cone = &workspace->cone;
    return !workspace->work.spent && imp_cone_reserve(s->cone, s->count);
}

static void pack_rows(imp_springs *s)
{
    const int width = 3 * s->count;
    const imp_spring_rows *r = &s->rows;
    int filled = 0;
    for (int i = 0; i < width; i++) {
        r->start[i] = filled;
        for (int j = 0; j < width; j++) {
            const double entry = s->w[(size_t)i * (size_t)width + (size_t)j];
            if (entry == 0 || (j % 3 > 0 && s->springs[j / 3].friction == 0)) continue;
            r->column[filled++] = j;
        }
    }
    r->start[width] = filled;
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
        c->none = c->rounding = IMP_SPRINGS_STILL;
        imp_springs_take_branch(s, i, IMP_SPRING_OPEN, 0, c->stiffness);
        for (int j = 0; j < 3; j++) c->u[j] = u0[3 * i + j];
    }
    pack_rows(s);
}

/* ---- the answer ---- */

/* What springs give back: of what those hold that load eps^2. */
static double stored_energy(const imp_springs *s)
{
    double sum = 0;
    for (int i = 0; i < s->count; i++) {
        const imp_spring *c = &s->springs[i];
        sum += (c->normal == IMP_SPRING_LOADS ? c->restitution * c->restitution : 1) * c->stored;
    }
    return sum;
}

static void report(const imp_springs *s, const units *unit, imp_group *group)
{
    for (int i = 0; i < s->count; i++) {
        for (int j = 0; j < 3; j++) group->p[3 * i + j] = s->springs[i].p[j] * (unit->velocity / unit->mobility);
        for (int j = 0; j < 3; j++) group->findings[i].work[j] *= unit->velocity * (unit->velocity / unit->mobility);
    }
    for (int i = 0; i < s->count; i++)
        group->error = fmax(group->error, s->springs[i].restitution - group->contacts[i].restitution);
    group->held = stored_energy(s) * unit->velocity * (unit->velocity / unit->mobility);
    group->events += s->events;
    group->steps += s->steps;
    group->chosen = group->chosen || s->chosen;
}

/* imp_encounter_wedged of the contacts that were pressed, whose pressures are in s->wedge then. */
static bool find_wedge(imp_springs *s)
{
    double *friction = s->scratch;
    bool *taken = (bool *)(friction + s->count);
    for (int i = 0; i < s->count; i++) {
        friction[i] = s->springs[i].friction;
        taken[i] = s->springs[i].p[0] > 0 || imp_springs_presses(&s->springs[i]);
    }
    const imp_wedge_question question = {s->count, s->w, friction, taken};
    return imp_encounter_wedged(&question, s->wedge);
}

/* In units of what more than all but a few take in all. */
static double spent_on(const imp_springs *s)
{
    return fmax((double)(s->events + s->steps) / IMP_SPRINGS_LONG, s->work / IMP_SPRINGS_MUCH);
}

/* Pressures r that balance have 0 = r . G v = sum r_n u_n as long as those contacts stick, or have no friction: their
 * dents keep sum r_n delta, and never all of them are let go. Whether they have stuck since half of what is spent. */
static bool have_stuck(const imp_springs *s, const double *r, double spent)
{
    for (int i = 0; i < s->count; i++) {
        const double weight = r[3 * i] * r[3 * i] * imp_springs_entry(s, 3 * i, 3 * i);
        if (weight > IMP_WEDGE_BALANCED && s->springs[i].loose > 0.5 * spent) return false;
    }
    return true;
}

/* Whether a group is wedged: when that is asked again; what was spent and the energy lost when it was last; the most
 * that springs have held since, and between the two times before; and how often in sequence next to none went. */
typedef struct wedge_watch {
    double next, asked, lost, most, before;
    int kept;
} wedge_watch;

/* Energy falls by dents and by friction alone; what comes loose, or to rest with nothing pressed, leaves none in the
 * springs. Whether it stays there, held by friction or swinging: losing on as it did since it was asked last, or giving
 * it back to the bodies, as what comes loose by and by does, they would not come to nothing before the group is given
 * up. What swings holds as much again and again. */
static bool keeps_energy(const imp_springs *s, double spent, wedge_watch *watch)
{
    enum { OFTEN = 2 };
    const double stored = stored_energy(s);
    double lost = -stored;
    for (int i = 0; i < s->count; i++)
        for (int j = 0; j < 3; j++) lost -= s->springs[i].finding->work[j];
    const double gone = fmax(lost - watch->lost, watch->before - watch->most), rate = gone / (spent - watch->asked);
    watch->kept = rate * IMP_SPRINGS_ASKED_LAST <= IMP_WEDGE_KEPT * stored ? watch->kept + 1 : 0;
    watch->lost = lost;
    watch->before = watch->most;
    watch->most = stored;
    watch->asked = spent;
    return watch->kept >= OFTEN;
}

/* What is wedged bounces in its dents for ever, or comes to rest in them; where it slips it may yet come loose, and is
 * waited for. */
static bool is_wedged(imp_springs *s, wedge_watch *watch)
{
    const double spent = spent_on(s);
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        if (!imp_springs_presses(c) || (c->friction > 0 && c->slip != IMP_SPRING_STICKS)) c->loose = spent;
    }
    watch->most = fmax(watch->most, stored_energy(s));
    if (spent < watch->next) return false;
    const bool last = spent >= IMP_SPRINGS_ASKED_LAST, keeps = keeps_energy(s, spent, watch);
    watch->next = last ? 2 * spent : fmin(2 * spent, IMP_SPRINGS_ASKED_LAST);
    return find_wedge(s) && (last || keeps || have_stuck(s, s->wedge, spent));
}

/* No step goes on, or nothing is found that sticks: pressures of a wedge grow until what they leave of one another is
 * their rounding, and then it is told as that. */
static impact_status give_up(imp_springs *s, imp_group *group)
{
    group->wedged = find_wedge(s);
    return IMPACT_EUNSETTLED;
}

/* Whether velocities are known to what the receipt takes: rounding of impulses that balance one another, and what held
 * slips drift to beside them, is less. */
static bool is_known(const imp_springs *s)
{
    for (int i = 0; i < s->count; i++)
        if (s->springs[i].none > IMP_SPRINGS_KNOWN) return false;
    return true;
}

/* Whether all is at rest at its contacts, however it is pressed there: what is left of energy, of the springs and of
 * the motion that impulses could take, (1/2) u . W^+ u, is no more than a spring holds that counts as open. It never
 * rises, so that nothing more will come of it: in a wedge roundings of what was bounce on for ever. What ends by itself
 * does so before that is asked. */
static bool has_come_to_rest(imp_springs *s)
{
    const int width = 3 * s->count;
    double *x = s->now, energy = stored_energy(s);
    if (spent_on(s) < IMP_SPRINGS_ASKED || energy > IMP_SPRINGS_ENERGY) return false;
    for (int i = 0; i < width; i++) {
        x[i] = s->springs[i / 3].u[i % 3];
        if (x[i] * x[i] > 2 * IMP_SPRINGS_ENERGY * imp_springs_entry(s, i, i)) return false;
    }
    (void)imp_least_solve_pivoted(s->w, width, IMP_SPRINGS_RANK, s->factor, (int *)s->scratch, x);
    for (int i = 0; i < width; i++) energy += 0.5 * s->springs[i / 3].u[i % 3] * x[i];
    return energy <= IMP_SPRINGS_ENERGY;
}

/* Until all is apart, or at rest: IMPACT_OK; else IMPACT_EUNSETTLED. */
static impact_status follow(imp_springs *s, imp_group *group)
{
    wedge_watch watch = {.next = IMP_SPRINGS_ASKED};
    while (s->steps + s->events < group->patience && s->work < IMP_SPRINGS_WORK) {
        s->closing = -1;
        if (has_come_to_rest(s)) return IMPACT_OK;
        if (!imp_springs_settle(s)) return give_up(s, group);
        group->wedged = is_wedged(s, &watch);
        if (group->wedged) return IMPACT_EUNSETTLED;
        const bool pressed = imp_springs_pressed(s);
        if (pressed && !imp_springs_end_bounces(s)) {
            if (!imp_springs_step(s)) return give_up(s, group);
        } else if (pressed || !imp_springs_drift(s)) {
            return IMPACT_OK;
        }
    }
    return IMPACT_EUNSETTLED;
}

/* ---- what comes out of a wedge ---- */

/* x += angle x x, of three numbers so far apart: as axes that are turned by so little have them. */
static void turn_by(const double angle[3], double *x, size_t apart)
{
    const double before[3] = {x[0], x[apart], x[2 * apart]};
    for (size_t k = 0; k < 3; k++) {
        const size_t l = (k + 1) % 3, m = (k + 2) % 3;
        x[k * apart] += angle[l] * before[m] - angle[m] * before[l];
    }
}

/* The same bodies with normals that are turned by so much and less; golden sections, so that no two are turned alike.
 */
static void move_nearby(const imp_springs *s, double turn, double *w, double *u0)
{
    static const double golden = 0.6180339887498949;
    const size_t width = 3 * (size_t)s->count;
    for (size_t i = 0; i < width; i += 3) {
        double angle[3];
        for (size_t k = 0; k < 3; k++) angle[k] = turn * (fmod(golden * (double)(i + k + 1), 1) - 0.5);
        turn_by(angle, &u0[i], 1);
        for (size_t j = 0; j < width; j++) turn_by(angle, &w[i * width + j], width);
        for (size_t j = 0; j < width; j++) turn_by(angle, &w[j * width + i], 1);
    }
    for (size_t i = 0; i < width; i++) s->springs[i / 3].u[i % 3] = u0[i];
}

/* How far velocities are from those of the group's impulses, of the fastest. */
static double distance_of(const imp_springs *s, const units *unit, const imp_group *group)
{
    const int width = 3 * s->count;
    double most = 0;
    for (int i = 0; i < width; i++) {
        double sum = 0;
        for (int j = 0; j < width; j++) {
            const double p = s->springs[j / 3].p[j % 3] * (unit->velocity / unit->mobility);
            sum += group->w[(size_t)i * (size_t)width + (size_t)j] * (p - group->p[j]);
        }
        most = fmax(most, fabs(sum) / unit->velocity);
    }
    return most;
}

/* What is needed to solve the group once more: the solver as before its first step, its room. */
typedef struct again {
    imp_springs blank;
    const imp_group *group;
    units unit;
    double *w, *u0;
    imp_finding *findings;
} again;

/* With normals turned by so much, or in another unit of velocities; *off: how far from the group's impulses it ends.
 * Whether it comes apart. */
static bool comes_apart(again once_more, double turn, double *off)
{
    imp_springs *s = &once_more.blank;
    imp_group other = *once_more.group;
    other.findings = once_more.findings;
    memset(s->springs, 0, (size_t)s->count * sizeof *s->springs);
    if (turn == 0) once_more.unit.velocity *= IMP_SPRINGS_OTHER_UNIT;
    set_up(s, &other, &once_more.unit, once_more.w, once_more.u0);
    move_nearby(s, turn, once_more.w, once_more.u0);
    if (follow(s, &other) != IMPACT_OK) return false;
    *off = distance_of(s, &once_more.unit, once_more.group);
    return true;
}

/* All is apart. What is wedged does not come apart but by the rounding of pressures; where it slips it may, but after
 * hundreds of bounces each of which takes rounding further that is chance, where an answer in another unit is another
 * one, and what is nearby stays wedged: as of what lies in a plane, which its bounces leave by any digit that is not
 * zero. */
static bool has_come_apart(imp_springs *s, const again *once_more)
{
    double off;
    const bool known = is_known(s);
    if ((known && spent_on(s) < IMP_SPRINGS_CHANCY) || !find_wedge(s)) return true;
    if (!known) return false;
    if (comes_apart(*once_more, 0, &off) && off <= IMP_SPRINGS_CHANCE) return true;
    return comes_apart(*once_more, IMP_SPRINGS_NEARBY, &off) || comes_apart(*once_more, -IMP_SPRINGS_NEARBY, &off);
}

impact_status imp_springs_solve(imp_group *group, double exponent, impact_together_workspace *workspace)
{
    const size_t n = (size_t)group->count, width = 3 * n;
    imp_springs s = {.count = group->count, .exponent = exponent};
    double *w = imp_encounter_take(workspace, width * width, sizeof *w),
           *u0 = imp_encounter_take(workspace, width, sizeof *u0);
    imp_finding *findings = imp_encounter_take(workspace, n, sizeof *findings);
    if (!w || !u0 || !findings || !take_room(&s, workspace)) return IMPACT_ENOMEM;
    const imp_springs blank = s;
    const units unit = find_units(group);
    set_up(&s, group, &unit, w, u0);
    const impact_status status = follow(&s, group);
    report(&s, &unit, group);
    if (status != IMPACT_OK) return status;
    group->wedged = !has_come_apart(&s, &(again){blank, group, unit, w, u0, findings});
    return group->wedged ? IMPACT_EUNSETTLED : IMPACT_OK;
}
