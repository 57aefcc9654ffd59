/* SPDX-License-Identifier: MIT
 *
 * From the caller's bodies and contacts to groups, each to its solver, and back: impulses to velocities, and the
 * receipt. Groups share no moving body, so that none feels another.
 */
#include "contact/encounter.h"

#include <string.h>
#include "base/numbers.h"
#include "base/tolerances.h"
#include "contact/cone_assemble.h"
#include "contact/springs.h"

/* ---- one contact ---- */

double imp_encounter_unit(double value)
{
    int exponent;
    (void)frexp(value, &exponent);
    return value > 0 && isfinite(value) ? ldexp(1, exponent - 1) : 1;
}

qvec3 imp_encounter_turn(const impact_collider *body, qvec3 a)
{
    if (imp_encounter_is_static(body)) return (qvec3){0, 0, 0};
    const qvec3 j = body->moments, b = quat_rotate_inverse(body->orientation, a);
    return quat_rotate(body->orientation, (qvec3){b.x / j.x, b.y / j.y, b.z / j.z});
}

/* Of the first so many axes. */
static void find_row(const impact_collider *body, const qvec3 axes[3], int count, qvec3 arm, double sign,
                     double row[3][6])
{
    if (imp_encounter_is_static(body)) return;
    const double part = sign / sqrt(body->mass);
    const qvec3 j = body->moments, root = {sqrt(j.x), sqrt(j.y), sqrt(j.z)};
    for (int k = 0; k < count; k++) {
        const qvec3 line = qvec3_scale(axes[k], part);
        const qvec3 own = quat_rotate_inverse(body->orientation, qvec3_scale(qvec3_cross(arm, axes[k]), sign));
        const double numbers[6] = {line.x, line.y, line.z, own.x / root.x, own.y / root.y, own.z / root.z};
        memcpy(row[k], numbers, sizeof numbers);
    }
}

imp_contact imp_encounter_contact(const impact_encounter *encounter, int meeting, bool smooth)
{
    const impact_meeting *m = &encounter->meetings[meeting];
    imp_contact c = {.source = meeting,
                     .body = {m->body1, m->body2},
                     .arm = {m->offset1, m->offset2},
                     .friction = m->friction,
                     .restitution = m->restitution,
                     .stiffness = m->stiffness};
    (void)qvec3_normalize(m->normal, &c.axes[0]);
    if (!smooth) imp_cone_find_axes(c.axes[0], c.axes);
    for (int s = 0; s < 2; s++)
        find_row(&encounter->bodies[c.body[s]], c.axes, smooth ? 1 : 3, c.arm[s], s == 0 ? 1 : -1, c.row[s]);
    return c;
}

static qvec3 point_velocity(qvec3 velocity, qvec3 omega, qvec3 arm)
{
    return qvec3_add(velocity, qvec3_cross(omega, arm));
}

void imp_encounter_velocity(const imp_contact *contact, const qvec3 *velocity, const qvec3 *omega, double u[3])
{
    const int *b = contact->body;
    const qvec3 v = qvec3_sub(point_velocity(velocity[b[0]], omega[b[0]], contact->arm[0]),
                              point_velocity(velocity[b[1]], omega[b[1]], contact->arm[1]));
    for (int k = 0; k < 3; k++) u[k] = qvec3_dot(contact->axes[k], v);
}

/* ---- one group ---- */

/* What a call works on: velocities as they change, and what is found of each meeting. */
typedef struct plan {
    const impact_encounter *encounter;
    imp_order order;
    qvec3 *normal; /* of each meeting, unit */
    qvec3 *velocity, *omega;
    impact_meeting_outcome *meetings;
    impact_together_outcome *outcome;
} plan;

static void add_products(const imp_contact *a, const imp_contact *b, double *w, size_t width)
{
    for (int s = 0; s < 2; s++)
        for (int t = 0; t < 2; t++) {
            if (a->body[s] != b->body[t]) continue;
            for (size_t k = 0; k < 3; k++)
                for (size_t l = 0; l < 3; l++) {
                    double sum = 0;
                    for (int m = 0; m < 6; m++) sum += a->row[s][k][m] * b->row[t][l][m];
                    w[k * width + l] += sum;
                }
        }
}

/* w (zero before): the same products whichever of the contacts comes first, so that it is symmetric to the bit. */
static void find_mobility(const imp_contact *contacts, int count, double *w)
{
    const size_t width = 3 * (size_t)count;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++)
            add_products(&contacts[i], &contacts[j], &w[3 * ((size_t)i * width + (size_t)j)], width);
}

/* Bytes of a group's work: what the springs take, who take most; linear: what springs_linear.c does. */
static size_t group_bytes(size_t n, bool linear)
{
    const size_t own = n * (sizeof(imp_spring) + sizeof(imp_contact) + 2 * sizeof(imp_finding) + 1024) + 4096;
    const size_t rooms = imp_springs_creep_size(n) + imp_springs_bounces_size(n) + imp_encounter_wedge_size(n),
                 more = linear ? 0 : sizeof(double) * rooms + n * sizeof(imp_spring);
    return own + more + n * n * (linear ? 48 : 2 * 72 + 2 * 9 * 4 + 4 * 8 + 12 * 8 + 2 * 8);
}

static void take_finding(const imp_finding *f, impact_meeting_outcome *m)
{
    m->work_compression += f->work[0], m->work_restitution += f->work[1], m->work_friction += f->work[2];
    m->compressions += f->compressions;
    if (m->phase_count > 0) return;
    m->phase_count = f->phase_count;
    memcpy(m->phases, f->phases, sizeof m->phases);
}

/* To what is there of the meetings. */
static void take_answer(plan *call, const imp_group *group)
{
    for (int i = 0; i < group->count; i++) {
        const imp_contact *c = &group->contacts[i];
        impact_meeting_outcome *m = &call->meetings[c->source];
        m->impulse = qvec3_add(m->impulse, imp_encounter_impulse(c, &group->p[3 * i]));
        take_finding(&group->findings[i], m);
        if (!imp_encounter_is_drawn(group, i)) continue;
        m->phases[0] = IMPACT_TANGENTIAL; /* as it was compressed first, sliding */
        if (m->phase_count == 0) m->phase_count = 1;
    }
    call->outcome->error = fmax(call->outcome->error, group->error);
    call->outcome->events += group->events;
    call->outcome->steps += group->steps;
    call->outcome->chosen = call->outcome->chosen || group->chosen;
}

/* Whether any does, or is pressed and may be drawn. */
static bool approaches(const imp_group *group)
{
    for (int i = 0; i < group->count; i++)
        if (group->u0[3 * i] < 0 || group->contacts[i].slip > 0) return true;
    return false;
}

static void set_solver(plan *call, impact_together_solver solver)
{
    if (solver > call->outcome->solver) call->outcome->solver = solver;
}

/* The contacts from .. from + count of the order, all of one group. */
static bool make_group(plan *call, int from, int count, bool linear, impact_together_workspace *workspace,
                       imp_group *group)
{
    const size_t n = (size_t)count;
    if (!imp_block_clear(workspace->arena, &workspace->work, group_bytes(n, linear))) return false;
    imp_contact *contacts = imp_encounter_take(workspace, n, sizeof *contacts);
    double *w = linear ? NULL : imp_encounter_take(workspace, 9 * n * n, sizeof *w),
           *u0 = imp_encounter_take(workspace, 3 * n, sizeof *u0);
    *group = (imp_group){.count = count,
                         .contacts = contacts,
                         .w = w,
                         .u0 = u0,
                         .p = imp_encounter_take(workspace, 3 * n, sizeof *group->p),
                         .findings = imp_encounter_take(workspace, n, sizeof *group->findings),
                         .bodies = call->encounter->bodies,
                         .velocity = call->velocity,
                         .omega = call->omega};
    if (!group->findings) return false;
    for (int i = 0; i < count; i++) {
        contacts[i] = imp_encounter_contact(call->encounter, call->order.meeting[from + i], linear);
        imp_encounter_velocity(&contacts[i], call->velocity, call->omega, &u0[3 * i]);
        if (call->encounter->meetings[contacts[i].source].pressed) imp_encounter_press(group, &contacts[i], &u0[3 * i]);
    }
    if (!linear) find_mobility(contacts, count, w);
    return true;
}

/* Whether its springs are linear and smooth. */
static bool is_linear(const plan *call, int from, int count)
{
    const impact_encounter *e = call->encounter;
    bool linear = e->law == IMPACT_TOGETHER_SPRINGS && e->exponent == 1;
    for (int i = from; linear && i < from + count; i++) linear = e->meetings[call->order.meeting[i]].friction == 0;
    return linear;
}

/* Springs of a group whose restitutions under `least` count as that. */
static impact_status solve_springs(plan *call, int from, int count, double least, long patience,
                                   impact_together_workspace *workspace, imp_group *group)
{
    const double exponent = call->encounter->exponent == 0 ? 1.5 : call->encounter->exponent;
    const bool linear = is_linear(call, from, count);
    impact_status status = IMPACT_EUNSETTLED;
    for (int general = !linear; general < 2 && status == IMPACT_EUNSETTLED; general++) {
        if (!make_group(call, from, count, !general, workspace, group)) return IMPACT_ENOMEM;
        if (!approaches(group)) return IMPACT_SEPARATING;
        group->least = least;
        group->patience = patience;
        status = general ? imp_springs_solve(group, exponent, workspace) : imp_springs_solve_linear(group, workspace);
    }
    return status;
}

/* What unloads is 1/eps times as stiff in time as what loads, and where it stays pressed it swings that much faster:
 * smaller restitutions are taken where that does not take long. */
static impact_status solve_as_hard_as_can_be(plan *call, int from, int count, impact_together_workspace *workspace,
                                             imp_group *group)
{
    bool small = false;
    for (int i = from; i < from + count; i++)
        small = small || call->encounter->meetings[call->order.meeting[i]].restitution < IMP_SPRINGS_LEAST;
    impact_status status = IMPACT_EUNSETTLED;
    if (small) status = solve_springs(call, from, count, IMP_SPRINGS_HARDEST, IMP_SPRINGS_TRIED, workspace, group);
    if (status != IMPACT_EUNSETTLED) return status;
    return solve_springs(call, from, count, IMP_SPRINGS_LEAST, IMP_SPRINGS_STEPS, workspace, group);
}

static impact_status solve_with_moreau(plan *call, int from, int count, impact_together_workspace *workspace,
                                       imp_group *group)
{
    if (!make_group(call, from, count, false, workspace, group)) return IMPACT_ENOMEM;
    const imp_rebound rebound =
        call->encounter->restitution == IMPACT_NEWTON ? IMP_REBOUND_NEWTON : IMP_REBOUND_POISSON;
    return approaches(group) ? imp_moreau_solve(group, rebound, workspace) : IMPACT_SEPARATING;
}

/* By how much of the fastest approach velocities have changed from group->u0, and what springs hold might change them:
 * (1/2) u^2/W_nn at the most. */
static double ending_error(const plan *call, const imp_group *group, double held, const double *after)
{
    double fastest = 0, changed = 0, mobility = 0;
    for (int i = 0; i < group->count; i++) {
        fastest = fmax(fastest, -call->meetings[group->contacts[i].source].normal_before);
        mobility = fmax(mobility, group->w[(size_t)(3 * i) * (3 * (size_t)group->count + 1)]);
    }
    for (int i = 0; i < 3 * group->count; i++) changed = fmax(changed, fabs(after[i] - group->u0[i]));
    return (changed + sqrt(2 * held * mobility)) / fastest;
}

/* What springs have left to do when the work that they are allowed is spent comes to its end at once, by what stops all
 * approach; what they hold is lost. Energy falls by no more than was left, and the error tells what that can be: no
 * answer where it is as much as they approach. */
static impact_status end_springs(plan *call, int from, int count, impact_together_workspace *workspace,
                                 imp_group *group)
{
    const double held = group->held;
    imp_encounter_push(group, group->p);
    take_answer(call, group);
    if (!make_group(call, from, count, false, workspace, group)) return IMPACT_ENOMEM;
    double *after = imp_encounter_take(workspace, 3 * (size_t)count, sizeof *after);
    if (!after) return IMPACT_ENOMEM;
    const impact_status status = imp_moreau_solve(group, IMP_REBOUND_NONE, workspace);
    if (status < 0) return status;
    imp_encounter_look(group, after);
    group->error = ending_error(call, group, held, after);
    if (!(group->error < 1)) return IMPACT_EUNSETTLED;
    if (status == IMPACT_OK) take_answer(call, group);
    call->outcome->error = fmax(call->outcome->error, group->error);
    call->outcome->ended_early = true;
    return IMPACT_SOFT;
}

static impact_status solve_group(plan *call, int from, int count, impact_together_workspace *workspace)
{
    const bool springs = call->encounter->law == IMPACT_TOGETHER_SPRINGS;
    imp_group group = {.count = 0};
    const impact_status status = springs ? solve_as_hard_as_can_be(call, from, count, workspace, &group)
                                         : solve_with_moreau(call, from, count, workspace, &group);
    if (group.wedged) call->outcome->wedged = group.contacts[0].source;
    if (springs && status == IMPACT_EUNSETTLED && !group.wedged) {
        set_solver(call, IMPACT_TOGETHER_SERIES);
        return end_springs(call, from, count, workspace, &group);
    }
    if (status != IMPACT_OK) {
        call->outcome->events += group.events, call->outcome->steps += group.steps; /* they were made in vain */
        return status;
    }
    if (springs && !imp_encounter_strikes(&group)) return IMPACT_SEPARATING;
    set_solver(call, springs ? IMPACT_TOGETHER_SERIES : IMPACT_TOGETHER_CONE);
    if (springs) imp_encounter_push(&group, group.p);
    take_answer(call, &group);
    return IMPACT_OK;
}

/* ---- one contact after another ---- */

/* A meeting by impact_collide, with the velocities of now. */
static impact_status solve_alone(plan *call, int meeting)
{
    const impact_meeting *m = &call->encounter->meetings[meeting];
    const impact_collision c = imp_encounter_collision(call->encounter, meeting, call->velocity, call->omega);
    impact_outcome o;
    const impact_status status = impact_collide(&c, &o);
    if (status < 0 || status == IMPACT_SEPARATING) return status;
    impact_meeting_outcome *own = &call->meetings[meeting];
    own->impulse = qvec3_add(own->impulse, o.impulse);
    own->work_compression += o.work_compression;
    own->work_restitution += o.work_restitution;
    own->work_friction += o.work_friction;
    own->compressions += o.compressions;
    if (own->phase_count == 0) {
        own->phase_count = o.phase_count;
        memcpy(own->phases, o.phases, sizeof own->phases);
    }
    const int pair[2] = {m->body1, m->body2};
    for (int k = 0; k < 2; k++) {
        if (imp_encounter_is_static(&call->encounter->bodies[pair[k]])) continue;
        call->velocity[pair[k]] = o.velocity[k];
        call->omega[pair[k]] = o.omega[k];
    }
    call->outcome->events++;
    return status;
}

static double normal_velocity(const plan *call, int meeting)
{
    const impact_meeting *m = &call->encounter->meetings[meeting];
    return qvec3_dot(call->normal[meeting],
                     qvec3_sub(point_velocity(call->velocity[m->body1], call->omega[m->body1], m->offset1),
                               point_velocity(call->velocity[m->body2], call->omega[m->body2], m->offset2)));
}

/* Down the caller's list, again and again, until what approaches is rounding. */
static impact_status solve_sequence(plan *call)
{
    const impact_encounter *e = call->encounter;
    double fastest = 0;
    for (int i = 0; i < e->meeting_count; i++) fastest = fmax(fastest, -normal_velocity(call, i));
    if (fastest == 0) return IMPACT_SEPARATING;
    bool struck = true, soft = false;
    for (int sweep = 0; struck && sweep < IMP_SEQUENCE_SWEEPS; sweep++) {
        struck = false;
        for (int i = 0; i < e->meeting_count; i++) {
            if (call->order.merged[i] != i || normal_velocity(call, i) >= -IMP_SEQUENCE_STILL * fastest) continue;
            const impact_status status = solve_alone(call, i);
            if (status < 0) return status;
            soft = soft || status == IMPACT_SOFT;
            struck = true;
        }
    }
    set_solver(call, IMPACT_TOGETHER_SWEEPS);
    return struck ? IMPACT_EUNSETTLED : soft ? IMPACT_SOFT : IMPACT_OK;
}

/* ---- all ---- */

static impact_status solve_groups(plan *call, impact_together_workspace *workspace)
{
    const imp_order *o = &call->order;
    impact_status whole = IMPACT_SEPARATING;
    for (int from = 0, to; from < o->count; from = to) {
        for (to = from + 1; to < o->count && o->group[to] == o->group[from]; to++) {
        }
        const bool alone = to == from + 1;
        const impact_status status =
            alone ? solve_alone(call, o->meeting[from]) : solve_group(call, from, to - from, workspace);
        if (status < 0) return status;
        if (alone && status != IMPACT_SEPARATING) set_solver(call, IMPACT_TOGETHER_ALONE);
        if (status == IMPACT_SOFT || whole == IMPACT_SEPARATING) whole = status;
    }
    return whole;
}

static bool make_plan(plan *call, imp_order *order, uint64_t **keys, int **parents,
                      impact_together_workspace *workspace)
{
    const size_t bodies = (size_t)call->encounter->body_count, meetings = (size_t)call->encounter->meeting_count;
    const size_t bytes =
        bodies * (2 * sizeof(qvec3) + 24) + meetings * (sizeof(impact_meeting_outcome) + sizeof(qvec3) + 64) + 1024;
    imp_block *block = &workspace->plan;
    if (!imp_block_clear(workspace->arena, block, bytes)) return false;
    call->velocity = imp_block_take(block, bodies, sizeof *call->velocity);
    call->omega = imp_block_take(block, bodies, sizeof *call->omega);
    call->normal = imp_block_take(block, meetings, sizeof *call->normal);
    call->meetings = imp_block_take(block, meetings, sizeof *call->meetings);
    order->meeting = imp_block_take(block, meetings, sizeof(int));
    order->group = imp_block_take(block, meetings, sizeof(int));
    order->merged = imp_block_take(block, meetings, sizeof(int));
    *keys = imp_block_take(block, meetings + 2 * bodies, sizeof **keys);
    *parents = imp_block_take(block, bodies + meetings, sizeof **parents);
    return *parents;
}

double imp_encounter_energy(const impact_encounter *encounter, const qvec3 *velocity, const qvec3 *omega)
{
    double sum = 0;
    for (int b = 0; b < encounter->body_count; b++) {
        const impact_collider *body = &encounter->bodies[b];
        if (imp_encounter_is_static(body)) continue;
        const qvec3 own = quat_rotate_inverse(body->orientation, omega[b]), j = body->moments;
        sum += 0.5 * body->mass * qvec3_dot(velocity[b], velocity[b]) +
               0.5 * (j.x * own.x * own.x + j.y * own.y * own.y + j.z * own.z * own.z);
    }
    return sum;
}

static void hand_over(const plan *call, const impact_together_outcome *outcome)
{
    const impact_encounter *e = call->encounter;
    for (int b = 0; b < e->body_count; b++) {
        if (outcome->velocity) outcome->velocity[b] = call->velocity[b];
        if (outcome->omega) outcome->omega[b] = call->omega[b];
    }
    for (int i = 0; i < e->meeting_count && outcome->meetings; i++) outcome->meetings[i] = call->meetings[i];
}

/* What every meeting has, before (`after` false) and after. */
static void note_meetings(const plan *call, bool after)
{
    for (int i = 0; i < call->encounter->meeting_count; i++) {
        impact_meeting_outcome *m = &call->meetings[i];
        *(after ? &m->normal_after : &m->normal_before) = normal_velocity(call, i);
        m->merged = call->order.merged[i] != i;
    }
    for (int k = 0; k < call->order.count; k++) call->meetings[call->order.meeting[k]].group = call->order.group[k];
    for (int i = 0; i < call->encounter->meeting_count; i++)
        call->meetings[i].group = call->meetings[call->order.merged[i]].group;
}

static impact_status solve_plan(plan *call, impact_together_workspace *workspace)
{
    uint64_t *keys;
    int *parents;
    impact_together_outcome *o = call->outcome;
    const impact_encounter *e = call->encounter;
    if (!make_plan(call, &call->order, &keys, &parents, workspace)) return IMPACT_ENOMEM;
    for (int b = 0; b < e->body_count; b++)
        call->velocity[b] = e->bodies[b].velocity, call->omega[b] = e->bodies[b].omega;
    for (int i = 0; i < e->meeting_count; i++) (void)qvec3_normalize(e->meetings[i].normal, &call->normal[i]);
    imp_encounter_sort(e, &call->order, keys, parents);
    o->groups = call->order.groups;
    o->energy_before = imp_encounter_energy(e, call->velocity, call->omega);
    note_meetings(call, false);
    impact_status status = e->law == IMPACT_TOGETHER_SEQUENCE ? solve_sequence(call) : solve_groups(call, workspace);
    if (status < 0) return status;
    note_meetings(call, true);
    o->energy_after = imp_encounter_energy(e, call->velocity, call->omega);
    const impact_together_outcome whole = {.velocity = call->velocity,
                                           .omega = call->omega,
                                           .meetings = call->meetings,
                                           .energy_before = o->energy_before,
                                           .energy_after = o->energy_after};
    o->residual = imp_encounter_receipt(e, &whole);
    double works = 0;
    for (int i = 0; i < e->meeting_count; i++) {
        const impact_meeting_outcome *m = &call->meetings[i];
        works += m->work_compression + m->work_restitution + m->work_friction;
    }
    o->energy_rose = works > IMP_ENCOUNTER_RECEIPT * o->energy_before;
    hand_over(call, o);
    return status == IMPACT_OK && !(o->residual <= IMP_ENCOUNTER_RECEIPT) ? IMPACT_SOFT : status;
}

/* Nothing is answered: the velocities given, NaN elsewhere. */
static void hand_back(const impact_encounter *e, impact_together_outcome *o)
{
    for (int b = 0; b < e->body_count && e->bodies; b++) {
        if (o->velocity) o->velocity[b] = e->bodies[b].velocity;
        if (o->omega) o->omega[b] = e->bodies[b].omega;
    }
    const impact_meeting_outcome none = {.impulse = {NAN, NAN, NAN}, .normal_before = NAN, .normal_after = NAN};
    for (int i = 0; i < e->meeting_count && o->meetings; i++) o->meetings[i] = none;
    o->energy_before = o->energy_after = o->residual = o->error = NAN;
}

impact_status impact_collide_together(const impact_encounter *encounter, impact_together_outcome *outcome)
{
    *outcome = (impact_together_outcome){
        .velocity = outcome->velocity, .omega = outcome->omega, .meetings = outcome->meetings, .wedged = -1};
    impact_together_workspace *workspace = encounter->workspace;
    impact_status status = impact_collide_together_check(encounter, NULL, 0);
    if (status == IMPACT_OK && !workspace) status = impact_together_workspace_create(NULL, &workspace);
    plan call = {.encounter = encounter, .outcome = outcome};
    if (status == IMPACT_OK) status = solve_plan(&call, workspace);
    if (status < 0) hand_back(encounter, outcome);
    if (workspace != encounter->workspace) impact_together_workspace_destroy(workspace);
    return status;
}
