/* SPDX-License-Identifier: MIT */
#include "scene/scene_internal.h"
#include "world/drive.h"
#include "scene/scene_check.h"

#include <stdlib.h>
#include <string.h>

static double joined(impact_pair_rule rule, double a, double b)
{
    switch (rule) {
    case IMPACT_PRODUCT: return a * b;
    case IMPACT_GEOMETRIC_MEAN: return sqrt(a * b);
    case IMPACT_MINIMUM: return fmin(a, b);
    case IMPACT_MAXIMUM: return fmax(a, b);
    }
    return 0;
}

/* Three equal moments, but for the rounding of the formulas that gave them. */
static bool equal_moments(qvec3 m) { return fabs(m.x - m.y) <= 1e-14 * m.x && fabs(m.x - m.z) <= 1e-14 * m.x; }

static bool build_body(imp_arena *arena, const impact_body_def *def, imp_body *body, imp_state *state)
{
    *body = (imp_body){.name = imp_arena_copy(arena, def->name),
                       .shape = def->shape,
                       .is_static = def->is_static,
                       .mass = INFINITY,
                       .radius = impact_shape_bounding_radius(&def->shape) + qvec3_norm(def->shape_position),
                       .offset = def->shape_position,
                       .friction = def->friction,
                       .restitution = def->restitution,
                       .linear_rate = -log1p(-def->linear_damping),
                       .angular_rate = -log1p(-def->angular_damping)};
    *state = (imp_state){.x = def->position};
    quat_normalize(def->orientation, &state->q);
    quat_normalize(def->shape_orientation, &body->turn);
    body->shifted = imp_scene_shape_stands_aside(def);
    if (body->is_static) {
        imp_drive_make(def, body);
        return body->name != NULL;
    }
    body->mass = imp_scene_body_mass(def, &body->moments);
    body->inverse_mass = 1 / body->mass;
    body->inverse_moments = (qvec3){1 / body->moments.x, 1 / body->moments.y, 1 / body->moments.z};
    body->spherical = equal_moments(body->moments);
    state->v = def->velocity;
    state->momentum = imp_inertia(body, state->q, def->omega);
    return body->name != NULL;
}

static const impact_pair_def *find_own_rule(const impact_scene_def *def, int i, int j)
{
    for (int k = 0; k < def->pair_count; k++) {
        const int a = imp_scene_def_find(def, def->pairs[k].body1), b = imp_scene_def_find(def, def->pairs[k].body2);
        if ((a == i && b == j) || (a == j && b == i)) return &def->pairs[k];
    }
    return NULL;
}

/* Every two bodies of which one moves, in order; a moving body comes first, a plane last. */
static impact_status build_pairs(imp_world *world, const impact_scene_def *def)
{
    const int n = world->body_count;
    world->pairs = imp_arena_take(world->arena, (size_t)n * (size_t)n / 2 + 1, sizeof *world->pairs);
    if (!world->pairs) return IMPACT_ENOMEM;
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++) {
            const imp_body *a = &world->bodies[i], *b = &world->bodies[j];
            if (a->is_static && b->is_static) continue;
            const impact_pair_def *own = find_own_rule(def, i, j);
            imp_pair *pair = &world->pairs[world->pair_count++];
            *pair = (imp_pair){.body1 = a->is_static ? j : i,
                               .body2 = a->is_static ? i : j,
                               .friction = joined(def->friction_rule, a->friction, b->friction),
                               .restitution = joined(def->restitution_rule, a->restitution, b->restitution)};
            if (own && !isnan(own->friction)) pair->friction = own->friction;
            if (own && !isnan(own->restitution)) pair->restitution = own->restitution;
        }
    return IMPACT_OK;
}

static double *copy_times(imp_arena *arena, const impact_force_def *def)
{
    const size_t count = def->kind == IMPACT_FORCE_CUSTOM ? (size_t)def->switch_count : 0;
    double *times = imp_arena_take(arena, count + 1, sizeof *times);
    if (times && count > 0) memcpy(times, def->switches, count * sizeof *times);
    return times;
}

static impact_status build_fields(imp_world *world, const impact_scene_def *def)
{
    world->fields = imp_arena_take(world->arena, (size_t)def->force_count + 1, sizeof *world->fields);
    if (!world->fields) return IMPACT_ENOMEM;
    for (int k = 0; k < def->force_count; k++) {
        imp_field *field = &world->fields[world->field_count++];
        field->def = def->forces[k];
        field->only = def->forces[k].body ? imp_scene_def_find(def, def->forces[k].body) : -1;
        field->def.body = NULL;
        if (field->def.kind == IMPACT_FORCE_WIND) {
            const qvec3 d = field->def.direction;
            field->def.direction = qvec3_scale(d, 1 / qvec3_norm(d));
        }
        if (isnan(field->def.max_step)) field->def.max_step = IMP_MAX_STEP_OF_DURATION * def->duration;
        field->switches = copy_times(world->arena, &def->forces[k]);
        field->def.switches = NULL;
        field->name = imp_arena_copy(world->arena, def->forces[k].name ? def->forces[k].name : "force");
        field->slots = imp_field_slots(&field->def, world->body_count);
        field->inside = imp_arena_take(world->arena, (size_t)field->slots + 1, sizeof *field->inside);
        if (!field->name || !field->inside || !field->switches) return IMPACT_ENOMEM;
    }
    imp_field_enter(world, 0);
    return IMPACT_OK;
}

impact_status imp_scene_build(impact_scene *scene, const impact_scene_def *def)
{
    imp_world *world = &scene->world;
    const size_t n = (size_t)def->body_count;
    imp_arena *arena = world->arena;
    *world =
        (imp_world){.arena = arena, .gravity = def->gravity, .slip_speed = IMP_SLIP_OF_REST_SPEED * def->rest_speed};
    scene->name = imp_arena_copy(arena, def->name ? def->name : "scene");
    if (!scene->name) return IMPACT_ENOMEM;
    world->onset_speed = IMP_ONSET_OF_SLIP_SPEED * world->slip_speed;
    world->flat_height = IMP_LYING_OF_REST_HEIGHT * def->rest_height;
    world->bodies = imp_arena_take(arena, n, sizeof *world->bodies);
    scene->states = imp_arena_take(arena, n, sizeof *scene->states);
    scene->before = imp_arena_take(arena, n, sizeof *scene->before);
    if (!world->bodies || !scene->states || !scene->before) return IMPACT_ENOMEM;
    for (int i = 0; i < def->body_count; i++) {
        world->body_count++;
        if (!build_body(arena, &def->bodies[i], &world->bodies[i], &scene->states[i])) return IMPACT_ENOMEM;
        world->driven = world->driven || world->bodies[i].driven;
    }
    impact_status status = build_pairs(world, def);
    if (status == IMPACT_OK) status = build_fields(world, def);
    if (status == IMPACT_OK) status = imp_motion_open(&scene->motion, world, def->tolerance, def->rest_speed);
    scene->modes = imp_arena_take(arena, (size_t)world->pair_count + 1, sizeof *scene->modes);
    return status == IMPACT_OK && !scene->modes ? IMPACT_ENOMEM : status;
}
