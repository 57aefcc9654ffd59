/* SPDX-License-Identifier: MIT */
#include "scene/scene_internal.h"
#include "world/surface_velocity.h"
#include "scene/scene_check.h"
#include "shape/solid.h"

#include <string.h>

/* An octahedron meets others and is held with its corners, edges and faces: as the polyhedron that it is. (As a smooth
 * body its one lowest point would jump from corner to corner as it tips over an edge.) */
static impact_status build_shape(const impact_shape *given, imp_arena *arena, imp_body *body)
{
    body->shape = *given;
    if (!imp_is_octahedron(given)) return IMPACT_OK;
    const double a = given->a, b = given->b, c = given->c;
    const qvec3 corners[] = {{a, 0, 0}, {-a, 0, 0}, {0, b, 0}, {0, -b, 0}, {0, 0, c}, {0, 0, -c}};
    const impact_allocator allocator = imp_arena_allocator(arena);
    impact_hull *hull;
    const impact_status status = impact_hull_create(corners, 6, 0, &allocator, &hull, NULL, 0);
    if (status == IMPACT_EARGUMENT) return IMPACT_OK; /* so thin that rounding has its corners in a plane */
    impact_shape *kept = imp_arena_take(arena, 1, sizeof *kept);
    if (status != IMPACT_OK || !kept) return kept ? status : IMPACT_ENOMEM;
    *kept = *given;
    body->given = kept;
    return impact_shape_polyhedron(hull, &body->shape);
}

static void build_body(const impact_body_def *def, char *name, imp_body *body, imp_state *state)
{
    *body = (imp_body){.name = name,
                       .user = def->user,
                       .is_static = def->is_static,
                       .mass = INFINITY,
                       .radius = impact_shape_bounding_radius(&def->shape) + qvec3_norm(def->shape_position),
                       .inner = imp_shape_inner_radius(&def->shape),
                       .offset = def->shape_position,
                       .trail = def->trail,
                       .friction = def->friction,
                       .restitution = def->restitution,
                       .torsional = def->torsional_friction,
                       .rolling = def->rolling_friction,
                       .linear_rate = -log1p(-def->linear_damping),
                       .angular_rate = -log1p(-def->angular_damping)};
    *state = (imp_state){.x = def->position};
    quat_normalize(def->orientation, &state->q);
    quat_normalize(def->shape_orientation, &body->turn);
    body->shifted = imp_scene_shape_stands_aside(def);
    if (body->is_static) {
        imp_surface_velocity_make(def, body);
        return;
    }
    qvec3 moments;
    body->mass = imp_scene_body_mass(def, &moments);
    body->inverse_mass = 1 / body->mass;
    imp_body_give_moments(body, moments);
    state->v = def->velocity;
    state->momentum = imp_inertia(body, state->q, def->omega);
}

static double *copy_times(imp_arena *arena, const impact_force_def *def)
{
    const size_t count = def->kind == IMPACT_FORCE_CUSTOM ? (size_t)def->switch_count : 0;
    double *times = imp_arena_take(arena, count + 1, sizeof *times);
    if (times && count > 0) memcpy(times, def->switches, count * sizeof *times);
    return times;
}

static impact_status build_fields(imp_world *world, const impact_scene_def *def, const imp_names *names)
{
    world->fields = imp_arena_take(world->arena, (size_t)def->force_count + 1, sizeof *world->fields);
    if (!world->fields) return IMPACT_ENOMEM;
    for (int k = 0; k < def->force_count; k++) {
        imp_field *field = &world->fields[world->field_count++];
        field->def = def->forces[k];
        field->only = imp_names_find(names, def->forces[k].body);
        field->def.body = NULL;
        if (field->def.kind == IMPACT_FORCE_WIND) {
            const qvec3 d = field->def.direction;
            field->def.direction = qvec3_scale(d, 1 / qvec3_norm(d));
        }
        if (isnan(field->def.max_step)) field->def.max_step = IMP_MAX_STEP_OF_DURATION * def->duration;
        if (field->def.kind != IMPACT_FORCE_CUSTOM) field->def.switch_count = 0; /* they are a law's own */
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

static impact_status build_bodies(impact_scene *scene, const impact_scene_def *def)
{
    imp_world *world = &scene->world;
    imp_arena *arena = world->arena;
    const size_t n = (size_t)def->body_count;
    world->bodies = imp_arena_take(arena, n, sizeof *world->bodies);
    scene->states = imp_arena_take(arena, n, sizeof *scene->states);
    scene->members = imp_arena_take(arena, n, sizeof *scene->members);
    scene->root = imp_arena_take(arena, n, sizeof *scene->root);
    if (!world->bodies || !scene->states || !scene->members || !scene->root) return IMPACT_ENOMEM;
    for (int i = 0; i < def->body_count; i++) {
        imp_body *body = &world->bodies[i];
        world->body_count++;
        scene->root[i] = -1;
        build_body(&def->bodies[i], scene->names.names[i], body, &scene->states[i]);
        const impact_status status = build_shape(&def->bodies[i].shape, arena, body);
        if (status != IMPACT_OK) return status;
        body->index = i;
        world->driven = world->driven || body->driven;
        scene->movable += !body->is_static;
    }
    scene->moving = scene->movable;
    return IMPACT_OK;
}

impact_status imp_scene_build(impact_scene *scene, const impact_scene_def *def)
{
    imp_world *world = &scene->world;
    *world = (imp_world){.arena = world->arena,
                         .gravity = def->gravity,
                         .gaps = &scene->gaps,
                         .slip_speed = IMP_SLIP_OF_REST_SPEED * def->rest_speed};
    scene->name = imp_arena_copy(world->arena, def->name ? def->name : "scene");
    if (!scene->name) return IMPACT_ENOMEM;
    world->incipient_speed = IMP_INCIPIENT_OF_SLIP_SPEED * world->slip_speed;
    world->flat_height = IMP_LYING_OF_REST_HEIGHT * def->rest_height;
    scene->queue.arena = world->arena;
    impact_status status = build_bodies(scene, def);
    if (status == IMPACT_OK) status = build_fields(world, def, &scene->names);
    scene->unsteady = imp_field_unsteady(world);
    if (status == IMPACT_OK) status = imp_rules_open(&scene->rules, world->arena, def, &scene->names);
    if (status == IMPACT_OK) status = imp_account_open(&scene->account, world->arena, def->body_count);
    if (status == IMPACT_OK && imp_queue_add(&scene->queue) < 0) status = IMPACT_ENOMEM;
    if (status == IMPACT_OK) status = imp_tracks_open(&scene->tracks, world, &scene->queue);
    return status;
}
