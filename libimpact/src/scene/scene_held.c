/* SPDX-License-Identifier: MIT
 *
 * What is held now, and by which forces: of islands that an integrator moves the reactions are solved for at the
 * scene's time, of piles they are those of the step at hand, or those that proved its rest.
 */
#include "base/floats.h"
#include "scene/gliding.h"
#include "scene/scene_internal.h"

#include <string.h>

/* Rows go to the first `room` places, and are counted beyond. */
typedef struct held_rows {
    impact_held *held;
    int room, count;
} held_rows;

static void add_row(held_rows *rows, const impact_held *row)
{
    if (rows->count < rows->room) rows->held[rows->count] = *row;
    rows->count++;
}

static impact_held row_of(const imp_island *island, double t, const imp_held_contact *contact)
{
    const imp_body *bodies = island->world.bodies;
    return (impact_held){.t = t,
                         .body1 = bodies[contact->body1].index,
                         .body2 = bodies[contact->body2].index,
                         .mode = contact->mode == IMP_STICK ? IMPACT_HOLD_STICK : IMPACT_HOLD_SLIP,
                         .point = qvec3_add(island->motion.sampled[contact->body1].x, contact->r1),
                         .normal = contact->normal,
                         .force = contact->force};
}

/* A ball that rolls in closed form against friction of its turning: that is in its segment, not among the contacts. */
static void add_rolling(const imp_island *island, impact_held *row)
{
    const imp_held_contact *contact = &island->motion.held.contacts[0];
    const imp_body *body = &island->world.bodies[contact->body1];
    if (!island->rolls || !imp_is_rough(&island->world.pairs[contact->pair])) return;
    const qvec3 turns = island->scene->tracks.tracks[body->index].segment.spin_up;
    row->force = contact->force;
    row->moment = qvec3_sub(qvec3_scale(turns, body->moments.x), qvec3_cross(contact->r1, contact->force));
}

static impact_status exact_rows(imp_island *island, double t, held_rows *rows)
{
    const size_t count = (size_t)island->motion.held.count;
    imp_held_contact *contacts = imp_arena_take(island->world.arena, count + 1, sizeof *contacts);
    if (!contacts) return IMPACT_ENOMEM;
    const bool moves = island->moves && !island->rests && !island->rolls;
    const impact_status status = imp_motion_contacts(&island->motion, t, moves, island->motion.sampled, contacts);
    for (size_t c = 0; status == IMPACT_OK && c < count; c++) {
        impact_held row = row_of(island, t, &contacts[c]);
        add_rolling(island, &row);
        add_row(rows, &row);
    }
    imp_arena_give(island->world.arena, contacts);
    return status;
}

/* What a pile's last step held, where its bodies are now. */
static void pile_rows(const imp_island *island, double t, held_rows *rows)
{
    const imp_world *world = &island->world;
    const imp_pile_memories *held = imp_pile_held(island->pile);
    for (int k = 0; k < held->count; k++) {
        const imp_pile_memory *memory = &held->list[k];
        const imp_pair *pair = &world->pairs[memory->pair];
        const qvec3 u = memory->velocity, along = qvec3_axpy(-qvec3_dot(u, memory->normal), memory->normal, u);
        const qvec3 f = memory->reaction, friction = qvec3_axpy(-qvec3_dot(f, memory->normal), memory->normal, f);
        const bool slips = pair->law.friction == 0 || qvec3_norm(along) > world->slip_speed;
        const impact_held row = {.t = t,
                                 .body1 = world->bodies[pair->body1].index,
                                 .body2 = world->bodies[pair->body2].index,
                                 .mode = slips ? IMPACT_HOLD_SLIP : IMPACT_HOLD_STICK,
                                 .point = qvec3_add(island->motion.sampled[pair->body1].x, memory->arm1),
                                 .normal = memory->normal,
                                 .force = memory->reaction,
                                 .moment = qvec3_add(memory->moment, qvec3_cross(memory->rub, friction))};
        add_row(rows, &row);
    }
}

static void glide_row(imp_island *island, double t, held_rows *rows)
{
    impact_held row;
    if (!imp_island_glide_force(island, t, island->motion.sampled, &row)) return;
    row.t = t;
    add_row(rows, &row);
}

int imp_island_held_by_steps(const imp_island *island, double t, impact_held *held, int room)
{
    held_rows rows = {held, room, 0};
    if (island->stepped && !imp_island_lying(island)) pile_rows(island, t, &rows);
    return rows.count;
}

int impact_scene_held(const impact_scene *scene, impact_held *held, int room)
{
    const imp_floats floats = imp_floats_hold();
    held_rows rows = {held, room, 0};
    impact_status status = IMPACT_OK;
    for (int k = 0; status == IMPACT_OK && k < scene->island_count; k++) {
        imp_island *island = scene->islands[k];
        if (!island) continue;
        status = imp_island_look(island, scene->t, true);
        if (status != IMPACT_OK) break;
        if (imp_island_lying(island))
            glide_row(island, scene->t, &rows);
        else if (island->stepped)
            pile_rows(island, scene->t, &rows);
        else
            status = exact_rows(island, scene->t, &rows);
    }
    imp_floats_give_back(&floats);
    return status == IMPACT_OK ? rows.count : (int)status;
}
