/* SPDX-License-Identifier: MIT */
#include "scene/parting.h"
#include "contact/points.h"
#include "scene/following.h"
#include "scene/islands.h"
#include "scene/rolling.h"
#include "scene/scene_methods.h"
#include "scene/scene_points.h"
#include "scene/stepped.h"

static int root_of(const int *root, int i)
{
    while (root[i] != i) i = root[i];
    return i;
}

/* root[i]: the component of the island's body i; of a static one -1. How many there are. */
static int find_components(const imp_island *island, int *root)
{
    const imp_world *world = &island->world;
    int count = 0, last = -1;
    bool attracted = false;
    for (int k = 0; k < world->field_count; k++)
        attracted = attracted || world->fields[k].def.kind == IMPACT_FORCE_ATTRACTION;
    for (int i = 0; i < world->body_count; i++) {
        root[i] = world->bodies[i].is_static ? -1 : i;
        if (root[i] < 0) continue;
        if (attracted && last >= 0) root[i] = root_of(root, last);
        last = i;
    }
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (!imp_island_ties(island, pair) || world->bodies[pair->body2].is_static) continue;
        const int a = root_of(root, pair->body1), b = root_of(root, pair->body2);
        root[a < b ? b : a] = a < b ? a : b;
    }
    for (int i = 0; i < world->body_count; i++)
        if (root[i] >= 0) count += (root[i] = root_of(root, i)) == i;
    return count;
}

/* Whether a contact holds the component, or a force acts on it; or nothing is to fly in closed form. */
static bool is_tied(const imp_island *island, const int *root, int component)
{
    const imp_world *world = &island->world;
    if (imp_scene_integrates_all(&island->scene->methods)) return true;
    for (int p = 0; p < world->pair_count; p++)
        if (imp_island_ties(island, &world->pairs[p]) && root[world->pairs[p].body1] == component) return true;
    for (int k = 0; k < world->field_count; k++)
        if (world->fields[k].only < 0 || root[world->fields[k].only] == component) return true;
    return false;
}

/* Whether bodies that touch there go on by steps once they do. */
static bool has_flats(const imp_world *world, const imp_pair *pair)
{
    return !world->bodies[pair->body2].is_static || imp_pair_has_faces(world, pair) || imp_pair_can_lie(world, pair);
}

/* Whether the component goes on by steps: bodies that move, or have faces or flat places, touch each other in it, or
 * resist turning on a plane, until a ball but rolls there; by choice, any touches. One that has just begun its steps
 * has had to: taken back to where nothing settles it, it would begin them again, for ever. */
static bool stays_stepped(const imp_island *island, const int *root, int component)
{
    const imp_world *world = &island->world;
    const bool always = island->scene->piles == IMPACT_PILES_STEPS || island->t == island->met_since;
    for (int p = 0; island->stepped && p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        const bool rough = imp_is_rough(pair) && !imp_island_rolls_out(island, pair);
        const bool counts = pair->met && (always || rough || has_flats(world, pair));
        if (counts && root[pair->body1] == component) return true;
    }
    return false;
}

/* Of a pile all pairs go over, of others those that hold. */
static bool goes_over(const imp_island *island, const int *root, int component, const imp_pair *pair)
{
    const bool here = root[pair->body1] == component &&
                      (island->world.bodies[pair->body2].is_static || root[pair->body2] == component);
    return here && (island->stepped || imp_is_held(pair) || pair->footing.on == IMP_FOOT_FACE);
}

/* One component as an island of its own. */
static impact_status split_off(imp_island *island, const int *root, int component, imp_island **out)
{
    impact_scene *scene = island->scene;
    const imp_world *world = &island->world;
    imp_island *part = *out = imp_islands_spare(scene);
    if (!part) return IMPACT_ENOMEM;
    part->t = part->looked_at = island->t;
    part->stepped = stays_stepped(island, root, component);
    impact_status status = imp_island_reserve(part, world->body_count, world->pair_count);
    if (status != IMPACT_OK) return status;
    for (int i = 0; i < world->body_count; i++) {
        bool takes = root[i] == component;
        for (int p = 0; world->bodies[i].is_static && !takes && p < world->pair_count; p++)
            takes = world->pairs[p].body2 == i && goes_over(island, root, component, &world->pairs[p]);
        if (!takes) continue;
        const int own = imp_island_add_body(part, world->bodies[i].index, &island->states[i]);
        part->motion.resting[own] = island->motion.resting[i];
    }
    for (int p = 0; p < world->pair_count; p++) {
        if (!goes_over(island, root, component, &world->pairs[p])) continue;
        imp_pair *pair = &part->world.pairs[part->world.pair_count++];
        *pair = world->pairs[p];
        pair->body1 = imp_island_find(part, world->bodies[pair->body1].index);
        pair->body2 = imp_island_find(part, world->bodies[pair->body2].index);
    }
    status = imp_island_take_forces(part);
    return status == IMPACT_OK && part->stepped ? imp_island_resume_steps(part) : status;
}

void imp_island_count_moving(imp_island *island)
{
    impact_scene *scene = island->scene;
    for (int i = 0; i < island->world.body_count; i++) {
        if (island->world.bodies[i].is_static) continue;
        imp_track *track = &scene->tracks.tracks[island->world.bodies[i].index];
        scene->moving += track->resting - island->motion.resting[i];
        track->resting = island->motion.resting[i];
    }
}

/* What is in none of the parts flies; a component alone stays the island it is. */
static impact_status make_parts(imp_island *island, imp_island **parts, bool *stays)
{
    impact_scene *scene = island->scene;
    int *root = scene->root; /* free between gatherings, but for its -1s */
    const int n = island->world.body_count, components = find_components(island, root);
    impact_status status = IMPACT_OK;
    imp_island **last = parts;
    for (int i = 0; status == IMPACT_OK && i < n; i++) {
        if (root[i] != i) continue;
        if (!is_tied(island, root, i)) {
            status = imp_island_fly(island, i);
        } else if (components == 1 && island->stepped == stays_stepped(island, root, i)) {
            *stays = true;
        } else {
            status = split_off(island, root, i, last);
            if (*last) last = &(*last)->next;
        }
    }
    for (int i = 0; i < n; i++) root[i] = -1;
    return status;
}

/* Whether bodies that resist turning on each other are held in it. */
static bool is_rough(const imp_island *part)
{
    for (int p = 0; p < part->world.pair_count; p++)
        if (imp_is_held(&part->world.pairs[p]) && imp_is_rough(&part->world.pairs[p])) return true;
    return false;
}

/* What leaves a pile has no modes yet: it joins the loose ones; so does what may need steps, seen when it is alone. */
static impact_status start_part(imp_island *part, const imp_island *whole, imp_island **loose)
{
    part->balance = imp_island_balance(part);
    if ((whole->stepped || is_rough(part)) && !part->stepped && !imp_island_all_rest(part)) {
        part->outside = whole->outside + imp_island_energy(whole) - imp_island_energy(part);
        part->next = *loose;
        *loose = part;
        return IMPACT_OK;
    }
    const impact_status status = imp_island_start(part);
    if (status != IMPACT_OK && part->number < 0) imp_islands_release(part);
    return status;
}

impact_status imp_island_part_ways(imp_island *island, imp_island **loose)
{
    imp_scene_drop_points(island);
    const impact_status told = imp_island_tell_pairs(island);
    *loose = NULL;
    imp_island_give_forces(island);
    imp_island_count_moving(island);
    bool stays = false;
    imp_island *parts = NULL;
    impact_status status = make_parts(island, &parts, &stays);
    for (imp_island *part = parts; part;) {
        imp_island *next = part->next;
        part->next = NULL;
        if (status == IMPACT_OK)
            status = start_part(part, island, loose);
        else
            imp_islands_release(part);
        part = next;
    }
    if (stays && status == IMPACT_OK) {
        imp_islands_give_account(island);
        island->balance = imp_island_balance(island);
        status = imp_island_start(island);
    }
    imp_island_look_ahead(island);
    if (!stays) imp_islands_release(island);
    return status == IMPACT_OK ? told : status;
}

bool imp_island_stays_together(imp_island *island)
{
    int *root = island->scene->root, first = 0;
    const int components = find_components(island, root);
    while (root[first] != first) first++;
    const bool stays = components == 1 && stays_stepped(island, root, first);
    for (int i = 0; i < island->world.body_count; i++) root[i] = -1;
    return stays;
}
