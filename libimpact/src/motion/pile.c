/* SPDX-License-Identifier: MIT */
#include "motion/pile.h"
#include "base/tolerances.h"
#include "contact/persist_linear.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>
#include <quat/exponential.h>

/* ---- room ---- */

void imp_pile_open(imp_pile *pile, imp_arena *arena)
{
    *pile = (imp_pile){.arena = arena, .cone.arena = arena, .rest.arena = arena};
}

static void *replaced(imp_pile *pile, void *old, size_t count, size_t size, bool *there)
{
    imp_arena_give(pile->arena, old);
    void *room = imp_arena_take(pile->arena, count, size);
    *there = *there && room;
    return room;
}

static bool reserve_bodies(imp_pile *pile, const imp_world *world)
{
    const size_t bodies = (size_t)world->body_count, pairs = (size_t)world->pair_count;
    bool there = true;
    if (world->body_count <= pile->bodies && world->pair_count <= pile->pairs) return true;
    imp_state **states[] = {&pile->middle, &pile->whole, &pile->half, &pile->end};
    for (int k = 0; k < 4; k++) *states[k] = replaced(pile, *states[k], bodies, sizeof **states[k], &there);
    pile->loads = replaced(pile, pile->loads, bodies, sizeof *pile->loads, &there);
    pile->root = replaced(pile, pile->root, bodies, sizeof *pile->root, &there);
    pile->velocities = replaced(pile, pile->velocities, bodies, sizeof *pile->velocities, &there);
    pile->member = replaced(pile, pile->member, pairs, sizeof *pile->member, &there);
    for (int k = 0; k < 3; k++)
        pile->memory[k] = replaced(pile, pile->memory[k], pairs, sizeof *pile->memory[k], &there);
    pile->bodies = there ? world->body_count : 0;
    pile->pairs = there ? world->pair_count : 0;
    return there;
}

static bool reserve_contacts(imp_pile *pile, int contacts)
{
    const size_t count = (size_t)contacts, n = 3 * count;
    bool there = true;
    if (contacts <= pile->contacts_most) return true;
    pile->contacts = replaced(pile, pile->contacts, count, sizeof *pile->contacts, &there);
    pile->pair_of = replaced(pile, pile->pair_of, count, sizeof *pile->pair_of, &there);
    pile->rows = replaced(pile, pile->rows, count, sizeof *pile->rows, &there);
    pile->friction = replaced(pile, pile->friction, count, sizeof *pile->friction, &there);
    pile->pivots = replaced(pile, pile->pivots, 2 * count, sizeof *pile->pivots, &there);
    pile->w = replaced(pile, pile->w, n * n, sizeof *pile->w, &there);
    pile->gap = replaced(pile, pile->gap, count, sizeof *pile->gap, &there);
    double **vectors[] = {&pile->q, &pile->r, &pile->u, &pile->last_r, &pile->last_u};
    for (int k = 0; k < 5; k++) *vectors[k] = replaced(pile, *vectors[k], n, sizeof **vectors[k], &there);
    pile->contacts_most = there ? contacts : 0;
    return there && imp_cone_reserve(&pile->cone, contacts);
}

void imp_pile_begin(imp_pile *pile)
{
    pile->step = 0;
    if (pile->pairs > 0) memset(pile->memory[0], 0, sizeof *pile->memory[0] * (size_t)pile->pairs);
}

/* ---- motion ---- */

/* What moves goes on with its velocities for h. */
static void drift(const imp_world *world, const imp_state *velocities, double h, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        const qvec3 turn = qvec3_scale(imp_omega(body, &velocities[i]), h);
        states[i].x = qvec3_axpy(h, velocities[i].v, states[i].x);
        if (qvec3_norm(turn) == 0) continue;
        const quat next = quat_mul(quat_exp_pure(qvec3_scale(turn, 0.5)), states[i].q);
        (void)quat_normalize(next, &states[i].q);
    }
}

static void add_loads(const imp_world *world, const imp_load *loads, double h, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        states[i].v = qvec3_axpy(h * world->bodies[i].inverse_mass, loads[i].force, states[i].v);
        states[i].momentum = qvec3_axpy(h, loads[i].torque, states[i].momentum);
    }
}

/* A measure of the pile: its smallest body. */
static double smallest(const imp_world *world)
{
    double least = INFINITY;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) least = fmin(least, world->bodies[i].radius);
    return least;
}

/* ---- contacts ---- */

static int root_of(int *root, int i)
{
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
}

/* Where the pair stands: its gap (m), and whether that counts, within the bounds of a plane. */
static bool pair_gap(imp_world *world, int p, const imp_state *states, impact_contact *contact)
{
    return imp_world_gap(world, &world->pairs[p], states, contact) >= 0 &&
           imp_world_inside_bounds(world, &world->pairs[p], states, contact) >= 0;
}

/* Whether a contact that the last step held goes on: pressed by the loads, it would close within this one. What rolls
 * over a round body leaves it by h² in every step; it is held, not dropped and caught. */
static bool goes_on(const imp_pile *pile, const imp_world *world, int p, const imp_state *next, double h,
                    const impact_contact *contact)
{
    if (!next || !pile->memory[1][p].active) return false;
    return contact->gap + 0.5 * h * imp_world_gap_rate(world, &world->pairs[p], next, contact) <= 0;
}

/* The pairs whose gap is at most the slack, or that go on, into member; bodies that they tie get one root. next: the
 * velocities at the end under the loads alone, or NULL. */
static int find_closed(imp_pile *pile, imp_world *world, const imp_state *states, const imp_state *next, double h,
                       double slack)
{
    int count = 0;
    for (int i = 0; i < world->body_count; i++) pile->root[i] = i;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        impact_contact contact;
        const bool held = next && pile->memory[1][p].active;
        if (!held && imp_world_distance_bound(world, pair, states) > slack) continue;
        if (!pair_gap(world, p, states, &contact)) continue;
        if (!(contact.gap <= slack) && !goes_on(pile, world, p, next, h, &contact)) continue;
        pile->member[count++] = p;
        if (!world->bodies[pair->body1].is_static && !world->bodies[pair->body2].is_static)
            pile->root[root_of(pile->root, pair->body1)] = root_of(pile->root, pair->body2);
    }
    return count;
}

static int island_of(imp_pile *pile, const imp_world *world, int p)
{
    const imp_pair *pair = &world->pairs[p];
    return root_of(pile->root, world->bodies[pair->body1].is_static ? pair->body2 : pair->body1);
}

/* The closed contacts of one island, of member[first ...], to the front of the arrays, their gaps with them. Returns
 * how many; what is done is marked -1. */
static int gather_island(imp_pile *pile, imp_world *world, const imp_state *states, int first, int closed)
{
    const int island = island_of(pile, world, pile->member[first]);
    int count = 0;
    for (int k = first; k < closed; k++) {
        const int p = pile->member[k];
        if (p < 0 || island_of(pile, world, p) != island) continue;
        imp_pair *pair = &world->pairs[p];
        impact_contact contact;
        (void)imp_world_gap(world, pair, states, &contact);
        imp_cone_contact *own = &pile->contacts[count];
        *own = (imp_cone_contact){
            .body1 = pair->body1, .body2 = pair->body2, .arm1 = contact.offset1, .arm2 = contact.offset2};
        imp_cone_find_axes(contact.normal, own->axes);
        pile->friction[count] = pair->friction;
        pile->gap[count] = contact.gap;
        pile->pair_of[count++] = p;
        pile->member[k] = -1;
    }
    return count;
}

/* ---- one step, whole ---- */

static double part_of(const imp_cone_contact *contact, const double *v, int k)
{
    return qvec3_dot(contact->axes[k], (qvec3){v[0], v[1], v[2]});
}

/* What the contacts' memories hold, along their axes; one that was open begins open. */
static void recall_step(imp_pile *pile, int count, double h)
{
    for (int c = 0; c < count; c++) {
        const imp_pile_memory *m = &pile->memory[1][pile->pair_of[c]];
        const double r[3] = {m->reaction.x, m->reaction.y, m->reaction.z},
                     u[3] = {m->velocity.x, m->velocity.y, m->velocity.z};
        for (int k = 0; k < 3; k++) {
            pile->last_r[3 * c + k] = m->active ? h * part_of(&pile->contacts[c], r, k) : 0;
            pile->last_u[3 * c + k] = m->active ? part_of(&pile->contacts[c], u, k) : pile->q[3 * c + k];
        }
    }
}

static void remember_step(imp_pile *pile, int count, double h)
{
    for (int c = 0; c < count; c++) {
        imp_pile_memory *m = &pile->memory[1][pile->pair_of[c]];
        *m = (imp_pile_memory){.active = true, .fresh = true};
        for (int k = 0; k < 3; k++) {
            m->reaction = qvec3_axpy(pile->r[3 * c + k] / h, pile->contacts[c].axes[k], m->reaction);
            m->velocity = qvec3_axpy(pile->u[3 * c + k], pile->contacts[c].axes[k], m->velocity);
        }
    }
}

/* What this step did not hold is open. */
static void forget_open(imp_pile *pile, const imp_world *world)
{
    for (int p = 0; p < world->pair_count; p++) {
        imp_pile_memory *m = &pile->memory[1][p];
        m->active = m->fresh;
        m->fresh = false;
    }
}

/* Work of the static bodies' moving surfaces with the impulses. */
static double drive_work(const imp_pile *pile, const imp_world *world, int count)
{
    double work = 0;
    for (int c = 0; c < count && world->driven; c++) {
        const imp_cone_contact *own = &pile->contacts[c];
        const qvec3 v = imp_surface_velocity(&world->bodies[own->body2], own->arm2);
        for (int k = 0; k < 3; k++) work += pile->r[3 * c + k] * qvec3_dot(own->axes[k], v);
    }
    return work;
}

/* The impulses of one island over a step h: states have the velocities before, `next` those with the loads. */
static bool answer(imp_pile *pile, imp_world *world, const imp_state *states, int count, double h, imp_state *next,
                   imp_pile_step_result *result)
{
    imp_cone_contact_velocities(world, next, pile->contacts, count, pile->q);
    imp_cone_contact_velocities(world, states, pile->contacts, count, pile->u);
    for (int c = 0; c < count; c++) {
        const int p = pile->pair_of[c];
        if (!pile->memory[1][p].active) /* what is held does not bounce */
            pile->q[3 * c] += world->pairs[p].restitution * fmin(0, pile->u[3 * c]);
    }
    imp_cone_assemble(world, pile->middle, pile->contacts, count, pile->rows, pile->w);
    recall_step(pile, count, h);
    const imp_cone_problem problem = {.count = count,
                                      .w = pile->w,
                                      .q = pile->q,
                                      .friction = pile->friction,
                                      .last_r = pile->last_r,
                                      .last_u = pile->last_u};
    const imp_cone_outcome outcome = imp_cone_solve(&problem, &pile->cone, pile->r, pile->u, NULL);
    if (outcome.status != IMP_CONE_SOLVED && outcome.status != IMP_CONE_INEXACT) {
        snprintf(pile->message, sizeof pile->message, "the impulses of %d contacts are %s", count,
                 imp_cone_status_name(outcome.status));
        return false;
    }
    imp_cone_push(world, pile->contacts, count, pile->r, next);
    remember_step(pile, count, h);
    result->drive_work += drive_work(pile, world, count);
    for (int c = 0; c < count; c++)
        result->coupled +=
            !world->bodies[pile->contacts[c].body1].is_static && !world->bodies[pile->contacts[c].body2].is_static;
    result->contacts += count;
    return true;
}

/* From `from` over h to `to`. */
static impact_status step_once(imp_pile *pile, imp_world *world, double t, double h, const imp_state *from,
                               imp_state *to, imp_pile_step_result *result)
{
    const size_t bytes = sizeof *from * (size_t)world->body_count;
    result->contacts = result->coupled = 0;
    memcpy(pile->middle, from, bytes);
    drift(world, from, 0.5 * h, pile->middle);
    if (!imp_field_loads(world, t + 0.5 * h, pile->middle, pile->loads)) return IMPACT_EDOMAIN;
    memcpy(to, pile->middle, bytes);
    add_loads(world, pile->loads, h, to);
    for (int i = 0; i < world->body_count; i++) {
        result->force_work += h * pile->loads[i].work_rate;
        result->damping += h * pile->loads[i].damping_rate;
    }
    const int closed = find_closed(pile, world, pile->middle, to, h, IMP_PILE_SLACK * smallest(world));
    if (!reserve_contacts(pile, closed)) return IMPACT_ENOMEM;
    for (int k = 0; k < closed; k++) {
        if (pile->member[k] < 0) continue;
        const int count = gather_island(pile, world, pile->middle, k, closed);
        if (!answer(pile, world, pile->middle, count, h, to, result)) return IMPACT_EUNSETTLED;
    }
    forget_open(pile, world);
    drift(world, to, 0.5 * h, to); /* x' = x_m + h v'/2 */
    return IMPACT_OK;
}

/* ---- constraints put back ---- */

/* The pairs that were held at the end of the step, into member, with the islands that they make. */
static int find_held(imp_pile *pile, const imp_world *world)
{
    int count = 0;
    for (int i = 0; i < world->body_count; i++) pile->root[i] = i;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (!pile->memory[0][p].active) continue;
        pile->member[count++] = p;
        if (!world->bodies[pair->body1].is_static && !world->bodies[pair->body2].is_static)
            pile->root[root_of(pile->root, pair->body1)] = root_of(pile->root, pair->body2);
    }
    return count;
}

/* Impulses of displacement along the normals, that take every gap to zero: the least that do, of those equations that
 * are independent. */
static void close_gaps(imp_pile *pile, const imp_world *world, const imp_state *states, int count)
{
    const size_t n = (size_t)count;
    imp_cone_assemble(world, states, pile->contacts, count, pile->rows, pile->w);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            pile->w[i * n + j] = pile->w[3 * (3 * i * n + j)]; /* to the front: none is lost */
    imp_linear linear = {.n = count,
                         .matrix = pile->w,
                         .spare = pile->w + n * n,
                         .scratch = pile->last_r,
                         .rows = pile->pivots,
                         .columns = pile->pivots + n};
    imp_linear_factor(&linear);
    for (int c = 0; c < count; c++) pile->last_u[c] = -pile->gap[c];
    imp_linear_solve(&linear, pile->last_u);
    memset(pile->r, 0, sizeof *pile->r * 3 * n);
    for (int c = 0; c < count; c++) pile->r[3 * c] = pile->last_u[c];
}

/* Gives the displacements those impulses, unless the equations that were left out are not met then: of contacts that
 * are more than motions not every gap can be zero. */
static void push_together(imp_pile *pile, imp_world *world, int count, double slack)
{
    double off = 0;
    imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
    imp_cone_contact_velocities(world, pile->middle, pile->contacts, count, pile->u);
    for (int c = 0; c < count; c++) off = fmax(off, fabs(pile->gap[c] + pile->u[3 * c]));
    if (off <= 0.1 * slack) return;
    for (int i = 0; i < 3 * count; i++) pile->r[i] = -pile->r[i];
    imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
}

/* Impulses of displacement along the normals, that part what overlaps: a cone problem without friction. */
static void part_overlaps(imp_pile *pile, const imp_world *world, const imp_state *states, int count)
{
    imp_cone_assemble(world, states, pile->contacts, count, pile->rows, pile->w);
    memset(pile->q, 0, sizeof *pile->q * 3 * (size_t)count);
    for (int c = 0; c < count; c++) pile->q[3 * c] = pile->gap[c], pile->friction[c] = 0;
    const imp_cone_problem problem = {.count = count, .w = pile->w, .q = pile->q, .friction = pile->friction};
    const imp_cone_outcome outcome = imp_cone_solve(&problem, &pile->cone, pile->r, pile->u, NULL);
    if (outcome.status != IMP_CONE_SOLVED && outcome.status != IMP_CONE_INEXACT)
        memset(pile->r, 0, sizeof *pile->r * 3 * (size_t)count);
}

/* Moves bodies along normals, least in the metric of mass: what is held to gap zero, where that can be; then overlaps
 * apart. Gaps within the slack may stay. */
static impact_status project_places(imp_pile *pile, imp_world *world, imp_state *states)
{
    const double slack = IMP_PILE_SLACK * smallest(world);
    for (int pass = 0; pass < 2; pass++) {
        const int closed = pass == 0 ? find_held(pile, world) : find_closed(pile, world, states, NULL, 0, 0);
        if (!reserve_contacts(pile, closed)) return IMPACT_ENOMEM;
        memcpy(pile->middle, states, sizeof *states * (size_t)world->body_count);
        for (int i = 0; i < world->body_count; i++) pile->middle[i].v = pile->middle[i].momentum = (qvec3){0, 0, 0};
        for (int k = 0; k < closed; k++) {
            if (pile->member[k] < 0) continue;
            const int count = gather_island(pile, world, states, k, closed);
            (pass == 0 ? close_gaps : part_overlaps)(pile, world, states, count);
            if (pass == 0)
                push_together(pile, world, count, slack);
            else
                imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
        }
        drift(world, pile->middle, 1, states);
    }
    return IMPACT_OK;
}

/* ---- the step that its error allows ---- */

/* How far apart any body's point stands in two ends of a step. */
static double apart(const imp_world *world, const imp_state *a, const imp_state *b)
{
    double most = 0;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        const quat turn = quat_mul(a[i].q, quat_conj(b[i].q));
        const double angle =
            body->shape.kind == IMPACT_SPHERE && !body->shifted ? 0 : 2 * qvec3_norm((qvec3){turn.x, turn.y, turn.z});
        most = fmax(most, qvec3_norm(qvec3_sub(a[i].x, b[i].x)) + body->radius * angle);
    }
    return most;
}

double imp_pile_natural_time(const imp_world *world, const imp_state *states)
{
    const double size = smallest(world), g = qvec3_norm(world->gravity);
    double speed = 0;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) speed = fmax(speed, qvec3_norm(states[i].v));
    return size / (sqrt(g * size) + (g > 0 ? 0 : speed) + 1e-300);
}

static impact_status try_step(imp_pile *pile, imp_world *world, double t, double h, const imp_state *states,
                              imp_pile_step_result *result)
{
    const size_t memories = sizeof *pile->memory[0] * (size_t)world->pair_count;
    imp_pile_step_result scratch = {.taken = 0};
    *result = (imp_pile_step_result){.taken = h};
    memcpy(pile->memory[1], pile->memory[0], memories);
    impact_status status = step_once(pile, world, t, 0.5 * h, states, pile->half, result);
    if (status == IMPACT_OK) status = step_once(pile, world, t + 0.5 * h, 0.5 * h, pile->half, pile->end, result);
    if (status != IMPACT_OK) return status;
    memcpy(pile->memory[2], pile->memory[1], memories);
    memcpy(pile->memory[1], pile->memory[0], memories);
    status = step_once(pile, world, t, h, states, pile->whole, &scratch);
    result->error = apart(world, pile->whole, pile->end);
    return status;
}

impact_status imp_pile_step(imp_pile *pile, imp_world *world, double t, double most, imp_state *states,
                            imp_pile_step_result *result)
{
    if (!reserve_bodies(pile, world)) return IMPACT_ENOMEM;
    const double natural = imp_pile_natural_time(world, states), wanted = IMP_PILE_ERROR * smallest(world);
    const double least = IMP_PILE_SHORTEST * natural;
    if (!(pile->step > 0)) pile->step = IMP_PILE_FIRST * natural;
    double h = fmin(most, fmin(pile->step, IMP_PILE_LONGEST * natural));
    impact_status status = try_step(pile, world, t, h, states, result);
    while (h > least && (status == IMPACT_EUNSETTLED || (status == IMPACT_OK && result->error > wanted))) {
        h *= 0.5;
        status = try_step(pile, world, t, h, states, result);
    }
    if (status != IMPACT_OK) return status;
    memcpy(states, pile->end, sizeof *states * (size_t)world->body_count);
    memcpy(pile->memory[0], pile->memory[2], sizeof *pile->memory[0] * (size_t)world->pair_count);
    /* h³ where modes stay, h where they change: doubled where the first would allow as much */
    pile->step = result->error < 0.1 * wanted ? 2 * h : h;
    return project_places(pile, world, states);
}

/* ---- rest ---- */

static bool is_touched(const imp_pile *pile, const imp_world *world, int body, int closed)
{
    for (int k = 0; k < closed; k++) {
        const imp_pair *pair = &world->pairs[pile->member[k]];
        if (pair->body1 == body || pair->body2 == body) return true;
    }
    return false;
}

/* The reactions that balance the loads of those that were gathered last. */
static void remember_rest(imp_pile *pile, int count)
{
    for (int c = 0; c < count; c++) {
        imp_pile_memory *m = &pile->memory[0][pile->pair_of[c]];
        *m = (imp_pile_memory){.active = true};
        for (int k = 0; k < 3; k++)
            m->reaction = qvec3_axpy(pile->r[3 * c + k], pile->contacts[c].axes[k], m->reaction);
    }
}

bool imp_pile_rests(imp_pile *pile, imp_world *world, double t, const imp_state *states, double rest_speed)
{
    if (!reserve_bodies(pile, world) || !imp_field_loads(world, t, states, pile->loads)) return false;
    const int closed = find_closed(pile, world, states, NULL, 0, IMP_PILE_SLACK * smallest(world));
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        if (qvec3_norm(states[i].v) + body->radius * qvec3_norm(imp_omega(body, &states[i])) > rest_speed) return false;
        if (!is_touched(pile, world, i, closed)) return false;
    }
    if (!reserve_contacts(pile, closed) || !imp_rest_reserve(&pile->rest, closed, world->body_count)) return false;
    for (int k = 0; k < closed; k++) pile->memory[0][pile->member[k]].active = true;
    for (int k = 0; k < closed; k++) {
        if (pile->member[k] < 0) continue;
        const int count = gather_island(pile, world, states, k, closed);
        const imp_rest_outcome outcome = imp_rest_solve(world, states, pile->contacts, pile->friction, count,
                                                        pile->loads, &pile->rest, pile->r, pile->velocities);
        if (outcome.status != IMP_REST_RESTS) return false;
        remember_rest(pile, count);
    }
    return true;
}
