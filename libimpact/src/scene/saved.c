/* SPDX-License-Identifier: MIT */
#include "scene/saved.h"
#include "world/corner.h"

#include <string.h>

/* ---- memory ---- */

impact_status imp_saved_reserve(imp_saved *s, imp_arena *arena)
{
    s->bodies = imp_arena_take(arena, (size_t)s->body_count, sizeof *s->bodies);
    s->inside = imp_arena_take(arena, (size_t)s->inside_count, sizeof *s->inside);
    s->beyond = imp_arena_take(arena, 2 * (size_t)s->beyond_count, sizeof *s->beyond);
    s->islands = imp_arena_take(arena, (size_t)s->island_count, sizeof *s->islands);
    s->members = imp_arena_take(arena, (size_t)s->member_count, sizeof *s->members);
    s->pairs = imp_arena_take(arena, (size_t)s->pair_count, sizeof *s->pairs);
    const bool room = s->bodies && s->inside && s->beyond && s->islands && s->members && s->pairs;
    return room ? IMPACT_OK : IMPACT_ENOMEM;
}

void imp_saved_release(imp_saved *s, imp_arena *arena)
{
    imp_arena_give(arena, s->bodies);
    imp_arena_give(arena, s->inside);
    imp_arena_give(arena, s->beyond);
    imp_arena_give(arena, s->islands);
    imp_arena_give(arena, s->members);
    imp_arena_give(arena, s->pairs);
}

/* ---- the walk ---- */

static void walk_vector(imp_archive *a, qvec3 *v)
{
    imp_archive_double(a, &v->x);
    imp_archive_double(a, &v->y);
    imp_archive_double(a, &v->z);
}

static void walk_state(imp_archive *a, imp_state *s)
{
    walk_vector(a, &s->x);
    imp_archive_double(a, &s->q.w);
    imp_archive_double(a, &s->q.x);
    imp_archive_double(a, &s->q.y);
    imp_archive_double(a, &s->q.z);
    walk_vector(a, &s->v);
    walk_vector(a, &s->momentum);
}

static void walk_works(imp_archive *a, imp_works *w)
{
    imp_archive_double(a, &w->force);
    imp_archive_double(a, &w->damping);
    imp_archive_double(a, &w->sliding);
    imp_archive_double(a, &w->drive);
}

static const char *const residual_names[] = {NULL, "unit", "gap", "contact", "energy", "momentum", "loss_fallen"};
enum { RESIDUALS = sizeof residual_names / sizeof *residual_names };

/* The limits are the definition's. */
static void walk_receipt(imp_archive *a, impact_scene_residuals *r)
{
    double *const numbers[] = {&r->begin,  &r->end,      &r->unit,        &r->gap,          &r->contact,
                               &r->energy, &r->momentum, &r->loss_fallen, &r->failed_begin, &r->failed_end};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) imp_archive_double(a, numbers[k]);
    imp_archive_long(a, &r->stretches);
    int failed = RESIDUALS - 1;
    while (failed > 0 && !(r->failed && strcmp(r->failed, residual_names[failed]) == 0)) failed--;
    imp_archive_int(a, &failed, 0, RESIDUALS - 1);
    r->failed = residual_names[failed];
}

static void walk_usage(imp_archive *a, impact_usage *usage)
{
    enum { COUNTS = sizeof *usage / sizeof(long) };
    long counts[COUNTS];
    memcpy(counts, usage, sizeof counts);
    for (int k = 0; k < COUNTS; k++) imp_archive_long(a, &counts[k]);
    memcpy(usage, counts, sizeof counts);
}

static void walk_scalars(imp_archive *a, imp_saved *s)
{
    double *const numbers[] = {&s->t,           &s->impact_loss,        &s->greatest_energy,
                               &s->pile_error,  &s->impact_loss_fallen, &s->sliding_fallen,
                               &s->pile_parted, &s->energy_start};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) imp_archive_double(a, numbers[k]);
    imp_archive_bool(a, &s->begun);
    imp_archive_long(a, &s->next_sample);
    imp_archive_long(a, &s->event_count);
    imp_archive_long(a, &s->encounter_count);
    imp_archive_long(a, &s->steps);
    walk_works(a, &s->works);
    walk_receipt(a, &s->receipt);
    walk_usage(a, &s->usage);
}

/* No more of anything than bytes are left: each takes one at least. */
static void walk_counts(imp_archive *a, imp_saved *s)
{
    int *const counts[] = {&s->body_count,   &s->inside_count, &s->beyond_count,
                           &s->island_count, &s->member_count, &s->pair_count};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        const size_t left = a->at < a->size ? a->size - a->at : 0;
        imp_archive_int(a, counts[k], 0, a->reading && left < INT32_MAX ? (int)left : INT32_MAX);
    }
}

static void walk_body(imp_archive *a, imp_saved_body *b)
{
    imp_archive_double(a, &b->t0);
    walk_state(a, &b->state);
    imp_archive_bool(a, &b->resting);
    imp_archive_bool(a, &b->told);
    imp_archive_int(a, &b->stalls, 0, INT32_MAX);
    imp_archive_double(a, &b->last_event);
    imp_archive_double(a, &b->patience.since);
    imp_archive_long(a, &b->patience.work);
}

static void walk_island(imp_archive *a, imp_saved_island *i)
{
    double *const numbers[] = {&i->t, &i->loss, &i->fallen, &i->looked_at, &i->slip_speed};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) imp_archive_double(a, numbers[k]);
    walk_works(a, &i->works);
    imp_archive_bool(a, &i->stepped);
    imp_archive_int(a, &i->member_count, 0, INT32_MAX);
    imp_archive_int(a, &i->pair_count, 0, INT32_MAX);
}

static void walk_member(imp_archive *a, imp_saved_member *m)
{
    imp_archive_int(a, &m->body, 0, INT32_MAX);
    walk_state(a, &m->state);
    imp_archive_bool(a, &m->resting);
}

/* Coefficients are the rules'; the cache and what is scratch begin anew. */
static void walk_pair(imp_archive *a, imp_pair *p)
{
    int mode = (int)p->mode, stage = (int)p->slip.stage, foot = (int)p->footing.on;
    double *const numbers[] = {&p->slip.mobility, &p->footing.spot[0], &p->footing.spot[1], &p->footing.spot[2],
                               &p->footing.lying};
    imp_archive_int(a, &p->body1, 0, INT32_MAX);
    imp_archive_int(a, &p->body2, 0, INT32_MAX);
    imp_archive_int(a, &mode, IMP_OPEN, IMP_STICK);
    imp_archive_int(a, &stage, IMP_SLIP_GROSS, IMP_SLIP_SLOW);
    imp_archive_int(a, &foot, IMP_FOOT_POINT, IMP_FOOT_FACE);
    imp_archive_int(a, &p->footing.line, 0, 2);
    imp_archive_int(a, &p->site.corner, 0, IMPACT_HULL_POINTS);
    imp_archive_int(a, &p->site.face, 0, 2 * IMPACT_HULL_POINTS);
    imp_archive_bool(a, &p->rest.still);
    imp_archive_bool(a, &p->met);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) imp_archive_double(a, numbers[k]);
    walk_vector(a, &p->slip.direction);
    walk_vector(a, &p->rest.reaction);
    p->mode = (imp_mode)mode;
    p->slip.stage = (imp_slip_stage)stage;
    p->footing.on = (imp_foot)foot;
}

impact_status imp_saved_walk(imp_saved *s, imp_archive *a, imp_arena *arena)
{
    walk_scalars(a, s);
    walk_counts(a, s);
    if (a->failed) return IMPACT_EARGUMENT;
    if (a->reading && imp_saved_reserve(s, arena) != IMPACT_OK) return IMPACT_ENOMEM;
    for (int k = 0; k < s->body_count; k++) walk_body(a, &s->bodies[k]);
    for (int k = 0; k < s->inside_count; k++) imp_archive_bool(a, &s->inside[k]);
    for (int k = 0; k < 2 * s->beyond_count; k++) imp_archive_int(a, &s->beyond[k], 0, INT32_MAX);
    for (int k = 0; k < s->island_count; k++) walk_island(a, &s->islands[k]);
    for (int k = 0; k < s->member_count; k++) walk_member(a, &s->members[k]);
    for (int k = 0; k < s->pair_count; k++) walk_pair(a, &s->pairs[k]);
    return a->failed ? IMPACT_EARGUMENT : IMPACT_OK;
}

/* ---- what can be ---- */

/* Of an energy that a start may have: what turns at 1e304 rad/s has steps that end in none. */
static bool is_state(const impact_scene *scene, int body, const imp_state *s)
{
    const imp_body *own = &scene->world.bodies[body];
    const double sum =
        s->x.x + s->x.y + s->x.z + s->v.x + s->v.y + s->v.z + s->momentum.x + s->momentum.y + s->momentum.z;
    if (!isfinite(sum) || !(fabs(quat_norm(s->q) - 1) < IMP_COLLIDE_UNIT)) return false;
    return own->is_static || fabs(imp_body_energy(own, s, scene->world.gravity)) < IMP_MOST_ENERGY;
}

static bool is_time(double t, const imp_saved *s) { return t >= 0 && t <= s->t; }

static const char *body_fault(const imp_saved *s, const impact_scene *scene)
{
    if (s->body_count != scene->world.body_count) return "as many bodies as the scene has";
    int slots = 0;
    for (int k = 0; k < scene->world.field_count; k++) slots += scene->world.fields[k].slots;
    if (s->inside_count != slots) return "as many edges of forces as the scene has";
    for (int k = 0; k < s->body_count; k++) {
        if (!is_state(scene, k, &s->bodies[k].state)) return "a body's state";
        if (!is_time(s->bodies[k].t0, s)) return "the time of a body's state";
    }
    for (int k = 0; k < 2 * s->beyond_count; k++)
        if (s->beyond[k] >= s->body_count) return "a pair beside a plane";
    return NULL;
}

static const char *pair_fault(const imp_saved *s, const impact_scene *scene, const bool *here, const imp_pair *pair)
{
    const imp_body *bodies = scene->world.bodies;
    const double sum = pair->slip.mobility + pair->footing.spot[0] + pair->footing.spot[1] + pair->footing.spot[2] +
                       pair->footing.lying + pair->slip.direction.x + pair->slip.direction.y + pair->slip.direction.z +
                       pair->rest.reaction.x + pair->rest.reaction.y + pair->rest.reaction.z;
    const bool known = pair->body1 < s->body_count && pair->body2 < s->body_count && pair->body1 != pair->body2;
    if (!known || !here[pair->body1] || !here[pair->body2] || bodies[pair->body1].is_static)
        return "a contact's bodies";
    if (!bodies[pair->body2].is_static && pair->body2 < pair->body1) return "the order of a contact's bodies";
    const bool on_plane = bodies[pair->body2].shape.kind == IMPACT_PLANE || pair->site.face > 0;
    if (pair->site.corner > (on_plane ? imp_corner_count(&bodies[pair->body1]) : 0)) return "a contact's corner";
    if (pair->site.face > imp_corner_faces(&bodies[pair->body2])) return "a contact's face";
    return isfinite(sum) ? NULL : "a contact's numbers";
}

/* taken: bodies that move of the islands before; here: of this one. */
static const char *island_fault(const imp_saved *s, const impact_scene *scene, const imp_saved_island *island,
                                const imp_saved_member *members, const imp_pair *pairs, bool *taken, bool *here)
{
    int moving = 0;
    if (!is_time(island->t, s) || !is_time(island->looked_at, s)) return "an island's time";
    memset(here, 0, sizeof *here * (size_t)s->body_count);
    for (int m = 0; m < island->member_count; m++) {
        const int body = members[m].body;
        if (body >= s->body_count || (m > 0 && body <= members[m - 1].body)) return "an island's bodies";
        if (!is_state(scene, body, &members[m].state)) return "the state of a body in an island";
        here[body] = true;
        if (scene->world.bodies[body].is_static) continue;
        if (taken[body]) return "a body of one island alone";
        taken[body] = true;
        moving++;
    }
    if (moving == 0) return "a body that moves in each island";
    for (int p = 0; p < island->pair_count; p++) {
        const char *fault = pair_fault(s, scene, here, &pairs[p]);
        if (fault) return fault;
    }
    return NULL;
}

static const char *islands_fault(const imp_saved *s, const impact_scene *scene, bool *flags)
{
    int member = 0, pair = 0;
    if (s->island_count > 0 && !s->begun) return "islands of a scene that has begun";
    for (int k = 0; k < s->island_count; k++) {
        const imp_saved_island *island = &s->islands[k];
        if (island->member_count > s->member_count - member || island->pair_count > s->pair_count - pair)
            return "as many bodies and contacts as its islands have";
        const char *fault =
            island_fault(s, scene, island, &s->members[member], &s->pairs[pair], flags, flags + s->body_count);
        if (fault) return fault;
        member += island->member_count, pair += island->pair_count;
    }
    return member == s->member_count && pair == s->pair_count ? NULL
                                                              : "as many bodies and contacts as its islands have";
}

impact_status imp_saved_check(const imp_saved *s, const impact_scene *scene, const char **fault)
{
    *fault = s->t >= 0 && isfinite(s->t) && s->next_sample >= 0 ? body_fault(s, scene) : "a time";
    if (*fault) return IMPACT_EARGUMENT;
    bool *flags = imp_arena_take(scene->world.arena, 2 * (size_t)s->body_count, sizeof *flags);
    if (!flags) return IMPACT_ENOMEM;
    *fault = islands_fault(s, scene, flags);
    imp_arena_give(scene->world.arena, flags);
    return *fault ? IMPACT_EARGUMENT : IMPACT_OK;
}
