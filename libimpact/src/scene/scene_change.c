/* SPDX-License-Identifier: MIT
 *
 * What a host changes between runs: an impulse on a body, and where a body is. Both are encounters at the scene's time:
 * what hangs together with the body is gathered, changed, and settled as after an impact. The energy that comes or goes
 * with the change is work of forces in the account.
 */
#include "base/floats.h"
#include "scene/arrivals.h"
#include "scene/coarser.h"
#include "scene/gather.h"
#include "scene/stepped.h"
#include "contact/held_still.h"
#include "world/world_gap.h"

#include <stdio.h>

/* ---- refusals ---- */

static impact_status refuse(impact_scene *scene, int body, const char *words)
{
    snprintf(scene->message, sizeof scene->message, "body '%s': %s", scene->world.bodies[body].name, words);
    return IMPACT_EARGUMENT;
}

static impact_status check_movable(impact_scene *scene, int body)
{
    scene->message[0] = '\0';
    if (body < 0 || body >= scene->world.body_count) {
        snprintf(scene->message, sizeof scene->message, "there is no body %d: the scene has %d", body,
                 scene->world.body_count);
        return IMPACT_EARGUMENT;
    }
    if (scene->world.bodies[body].is_static) return refuse(scene, body, "it is static, nothing moves it");
    return IMPACT_OK;
}

static impact_status check_finite(impact_scene *scene, int body, const char *what, qvec3 v)
{
    if (isfinite(v.x + v.y + v.z)) return IMPACT_OK;
    snprintf(scene->message, sizeof scene->message, "body '%s': %s = (%g, %g, %g): must be finite",
             scene->world.bodies[body].name, what, v.x, v.y, v.z);
    return IMPACT_EDOMAIN;
}

/* Energies stay within double precision: their sums with others do too. */
static impact_status check_energy(impact_scene *scene, int body, const imp_state *state)
{
    if (fabs(imp_body_energy(&scene->world.bodies[body], state, scene->world.gravity)) < IMP_MOST_ENERGY)
        return IMPACT_OK;
    return refuse(scene, body, "its energy lies beyond double precision");
}

/* ---- overlaps ---- */

/* How far the body in this state would overlap the other one, m; <= 0: not, but for what a start may have too. */
static double overlap_of(impact_scene *scene, int body, const imp_state *state, int other)
{
    const imp_body *b1 = &scene->world.bodies[body], *b2 = &scene->world.bodies[other];
    const imp_state *s2 = &scene->states[other];
    impact_contact contact;
    if (imp_gap_of(b1, state, b2, s2, scene->world.gaps, &scene->world.usage, &contact) < 0) return INFINITY;
    const double size = imp_place_scale(b1, state->x, b2, s2->x, contact.normal);
    if (contact.gap >= -IMP_OVERLAP_AT_START * size) return 0;
    const qvec3 local = quat_rotate_inverse(s2->q, contact.offset2);
    const bool beside = b2->shape.kind == IMPACT_PLANE && (fabs(local.x) > b2->shape.a || fabs(local.y) > b2->shape.b);
    return beside ? 0 : -contact.gap;
}

static impact_status check_overlap(impact_scene *scene, int body, const imp_state *state, int other)
{
    const double overlap = other == body ? 0 : overlap_of(scene, body, state, other);
    if (!(overlap > 0)) return IMPACT_OK;
    snprintf(scene->message, sizeof scene->message, "body '%s': there it overlaps '%s' by %.6g m",
             scene->world.bodies[body].name, scene->world.bodies[other].name, overlap);
    return IMPACT_EDOMAIN;
}

static impact_status check_overlaps_at(impact_scene *scene, int body, const imp_state *state)
{
    imp_tracks *tracks = &scene->tracks;
    const double r = scene->world.bodies[body].radius;
    const qvec3 x = state->x;
    const imp_box box = {{x.x - r, x.y - r, x.z - r}, {x.x + r, x.y + r, x.z + r}};
    impact_status status = imp_grid_query(&tracks->grid, &box);
    for (int k = 0; status == IMPACT_OK && k < tracks->grid.found_count; k++)
        status = check_overlap(scene, body, state, tracks->grid.found[k]);
    for (int k = 0; status == IMPACT_OK && k < tracks->plane_count; k++)
        status = check_overlap(scene, body, state, tracks->planes[k].body);
    return status;
}

/* ---- the change ---- */

/* Kinetic + potential of all bodies, J. */
static double whole_energy(const impact_scene *scene)
{
    return imp_world_kinetic_energy(&scene->world, scene->states) + imp_field_potential(&scene->world, scene->states);
}

/* Before the first run nothing is held, and no island is made. */
static impact_status change_before_the_start(impact_scene *scene, int body, const imp_state *state)
{
    imp_tracks *tracks = &scene->tracks;
    imp_field_locate(&scene->world, scene->t, scene->states, false);
    const double energy = whole_energy(scene);
    scene->states[body] = *state;
    imp_field_locate(&scene->world, scene->t, scene->states, false);
    scene->works.force += whole_energy(scene) - energy;
    const imp_segment s =
        imp_segment_fly(&scene->world.bodies[body], scene->t, state, scene->world.gravity, tracks->tracks[body].tumble);
    const impact_status status = imp_tracks_follow(tracks, body, &s, scene->t);
    return status == IMPACT_OK ? imp_tracks_leap(tracks, body, scene->t) : status;
}

/* What hangs together with the body now, and what touches that. */
static impact_status gather_round(impact_scene *scene, int body, imp_island **island)
{
    imp_gather_member(scene, body);
    const impact_status status = imp_gather(scene, -1, scene->t, scene->piles == IMPACT_PILES_STEPS, island);
    if (status == IMPACT_OK) (*island)->outside = imp_gather_energy_outside(scene, *island, scene->t);
    return status;
}

static void put_state_of(imp_island *island, int body, const imp_state *state)
{
    const int i = imp_island_find(island, body);
    const double energy = imp_island_energy(island);
    imp_held_wake(&island->world);
    island->states[i] = *state;
    island->motion.resting[i] = false;
    for (int custom = 0; custom < 2; custom++) imp_field_locate(&island->world, island->t, island->states, custom);
    island->motion.works.force += imp_island_energy(island) - energy;
}

/* The body touches none of the others any more. */
static void tear_off(imp_island *island, int body)
{
    imp_world *world = &island->world;
    const int i = imp_island_find(island, body);
    int kept = 0;
    for (int p = 0; p < world->pair_count; p++)
        if (world->pairs[p].body1 != i && world->pairs[p].body2 != i) world->pairs[kept++] = world->pairs[p];
    world->pair_count = kept;
}

static bool touches_any(impact_scene *scene, int body)
{
    const imp_track *track = &scene->tracks.tracks[body];
    for (int k = 0; k < track->companion_count; k++)
        if (imp_gather_touches(scene, &scene->tracks.near[track->companions[k].near], scene->t)) return true;
    return false;
}

/* Taken from where it is, and put down where it is to be: two encounters. */
static impact_status move_body(impact_scene *scene, int body, const imp_state *state)
{
    imp_island *island;
    impact_status status = gather_round(scene, body, &island);
    if (status != IMPACT_OK) return status;
    tear_off(island, body);
    put_state_of(island, body, state);
    if (island->stepped) status = imp_island_begin_steps(island);
    if (status == IMPACT_OK) status = imp_scene_conclude(island);
    if (status == IMPACT_OK) status = imp_tracks_leap(&scene->tracks, body, scene->t);
    if (status != IMPACT_OK || !touches_any(scene, body)) return status;
    status = gather_round(scene, body, &island);
    return status == IMPACT_OK ? imp_scene_conclude(island) : status;
}

static impact_status push_body(impact_scene *scene, int body, const imp_state *state)
{
    imp_island *island;
    const impact_status status = gather_round(scene, body, &island);
    if (status != IMPACT_OK) return status;
    put_state_of(island, body, state);
    return imp_scene_conclude(island);
}

typedef impact_status change_function(impact_scene *scene, int body, const imp_state *state);

static impact_status change(impact_scene *scene, int body, const imp_state *state, change_function *function)
{
    if (!scene->begun) function = change_before_the_start;
    impact_status status = function(scene, body, state);
    if (status == IMPACT_OK) status = imp_scene_look(scene, scene->t);
    if (status == IMPACT_ENOMEM) imp_arena_explain(scene->world.arena, scene->message, sizeof scene->message);
    return status;
}

/* ---- set ---- */

static impact_status set_state(impact_scene *scene, int body, const impact_sample *sample)
{
    impact_status status = check_movable(scene, body);
    if (status == IMPACT_OK) status = check_finite(scene, body, "position", sample->position);
    if (status == IMPACT_OK) status = check_finite(scene, body, "velocity", sample->velocity);
    if (status == IMPACT_OK) status = check_finite(scene, body, "omega", sample->omega);
    if (status != IMPACT_OK) return status;
    imp_state state = {.x = sample->position, .v = sample->velocity};
    if (quat_normalize(sample->orientation, &state.q) != QUAT_OK)
        return refuse(scene, body, "orientation cannot be normalised");
    state.momentum = imp_inertia(&scene->world.bodies[body], state.q, sample->omega);
    status = check_energy(scene, body, &state);
    if (status == IMPACT_OK) status = check_overlaps_at(scene, body, &state);
    return status == IMPACT_OK ? change(scene, body, &state, move_body) : status;
}

impact_status impact_scene_set_state(impact_scene *scene, int body, const impact_sample *sample)
{
    const imp_floats floats = imp_floats_hold();
    impact_status status = imp_coarser_follow(scene);
    if (status == IMPACT_OK) status = set_state(scene, body, sample);
    if (status == IMPACT_OK && scene->coarser)
        imp_coarser_changed(scene, impact_scene_set_state(scene->coarser, body, sample));
    imp_floats_give_back(&floats);
    return status;
}

/* ---- push ---- */

static impact_status push(impact_scene *scene, int body, qvec3 impulse, qvec3 point)
{
    impact_status status = check_movable(scene, body);
    if (status == IMPACT_OK) status = check_finite(scene, body, "impulse", impulse);
    if (status == IMPACT_OK) status = check_finite(scene, body, "point", point);
    if (status != IMPACT_OK) return status;
    imp_state state = scene->states[body];
    state.v = qvec3_axpy(scene->world.bodies[body].inverse_mass, impulse, state.v);
    state.momentum = qvec3_add(state.momentum, qvec3_cross(qvec3_sub(point, state.x), impulse));
    status = check_energy(scene, body, &state);
    return status == IMPACT_OK ? change(scene, body, &state, push_body) : status;
}

impact_status impact_scene_push(impact_scene *scene, int body, qvec3 impulse, qvec3 point)
{
    const imp_floats floats = imp_floats_hold();
    impact_status status = imp_coarser_follow(scene);
    if (status == IMPACT_OK) status = push(scene, body, impulse, point);
    if (status == IMPACT_OK && scene->coarser)
        imp_coarser_changed(scene, impact_scene_push(scene->coarser, body, impulse, point));
    imp_floats_give_back(&floats);
    return status;
}
