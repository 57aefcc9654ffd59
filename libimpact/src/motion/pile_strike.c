/* SPDX-License-Identifier: MIT
 *
 * What strikes within a step. An open contact that closes at the rate w at the time tau is struck in the middle of the
 * step that finds it. Of the two bodies one has its speed changed by w/2 at least: places may be off by w h/4 or more,
 * however it rebounds. Where that may not be the step ends at tau = t_m + g/w, g the gap at t_m; there the same
 * impulses are exchanged without time, and places are off by what the rate w changes until then, the square of h.
 */
#include "base/tolerances.h"
#include "motion/pile_parts.h"

#include <string.h>

/* m/s, at which the point closes in the states; 0: it does not, was held, or the step may pass over it. */
static double strikes_at(const imp_pile *pile, const imp_world *world, const imp_state *states,
                         const imp_pile_point *point)
{
    double u[3];
    if (point->memory >= 0) return 0;
    imp_cone_contact_velocities(world, states, &point->contact, 1, u);
    return -u[0] * pile->strike.span > 4 * pile->strike.allowed ? -u[0] : 0;
}

/* Whether the point is struck within the step; what closes as it ends is left to the next. */
static bool note_strike(imp_pile_strike *strike, double closes, double approach)
{
    if (closes >= IMP_PILE_AT_END * strike->span) return false;
    if (strike->found && closes >= strike->time) return true;
    strike->found = true;
    strike->time = fmax(closes, 0);
    strike->approach = approach;
    return true;
}

void imp_pile_seek_strikes(imp_pile *pile, const imp_world *world, const imp_state *states, double time)
{
    imp_pile_contacts *touching = &pile->touching;
    int kept = 0;
    for (int k = 0; k < touching->count; k++) {
        const imp_pile_point *point = &touching->points[k];
        const double approach = strikes_at(pile, world, states, point);
        if (approach > 0 && !note_strike(&pile->strike, time + point->gap / approach, approach)) continue;
        touching->points[kept++] = *point;
    }
    touching->count = kept;
}

static bool is_struck(const imp_pile *pile, const imp_world *world, int count)
{
    for (int c = 0; c < count; c++)
        if (strikes_at(pile, world, pile->middle, &pile->touching.points[pile->members[c]]) > 0) return true;
    return false;
}

/* The islands that are struck; their pairs are not marked as held any more. */
static impact_status strike_islands(imp_pile *pile, imp_world *world, imp_state *next, imp_pile_step_result *result,
                                    bool *struck)
{
    for (int count; (count = imp_pile_gather_island(pile, world)) > 0;) {
        if (!is_struck(pile, world, count)) continue;
        const impact_status status = imp_pile_answer(pile, world, pile->middle, count, 0, next, result);
        if (status != IMPACT_OK) return status;
        for (int c = 0; c < count; c++) pile->touching.held[pile->touching.points[pile->members[c]].pair] = false;
        *struck = true;
    }
    return IMPACT_OK;
}

/* What is held of the others, after what the struck hold. */
static bool remember_others(imp_pile *pile)
{
    const imp_pile_memories *before = &pile->memory[1];
    imp_pile_memories *after = &pile->memory[2];
    for (int k = 0; k < before->count; k++) {
        const imp_pile_memory *m = &before->list[k];
        if (!pile->touching.held[m->pair]) continue;
        imp_pile_memory *list = imp_arena_grow(pile->arena, after->list, &after->room, after->count + 1, sizeof *list);
        if (!list) return false;
        after->list = list;
        list[after->count++] = *m;
    }
    return imp_pile_copy_memories(pile->arena, &pile->memory[0], after);
}

impact_status imp_pile_strike_now(imp_pile *pile, imp_world *world, imp_state *states, imp_pile_step_result *result,
                                  bool *struck)
{
    const size_t size = sizeof *states * (size_t)world->body_count;
    const double h = pile->strike.span;
    imp_pile_contacts *touching = &pile->touching;
    imp_state *next = pile->projected;
    imp_pile_step_result own = {.taken = 0};
    *struck = false;
    memcpy(pile->middle, states, size);
    memcpy(next, states, size);
    pile->memory[2].count = 0;
    if (!imp_pile_copy_memories(pile->arena, &pile->memory[1], &pile->memory[0])) return IMPACT_ENOMEM;
    imp_pile_contacts_mark(touching, world, &pile->memory[1]);
    if (!imp_pile_find_points(touching, world, states, states, 0, imp_pile_slack(pile, world), false) ||
        !imp_pile_reserve_contacts(pile, world, touching->count))
        return IMPACT_ENOMEM;
    imp_pile_recall(touching, world, states, h, &pile->memory[1]);
    imp_pile_place_friction(touching, world, &pile->memory[1], NULL, 0);
    const impact_status status = strike_islands(pile, world, next, &own, struck);
    if (status != IMPACT_OK || !*struck) return status;
    memcpy(states, next, size);
    result->error += own.error, result->sliding += own.sliding, result->drive_work += own.drive_work;
    return remember_others(pile) ? IMPACT_OK : IMPACT_ENOMEM;
}
