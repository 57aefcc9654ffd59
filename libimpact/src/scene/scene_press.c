/* SPDX-License-Identifier: MIT
 *
 * Of pairs c that touch and do not part, without friction, with a = W r + q their gaps' second rates under the loads
 * (q) and reactions r:
 *
 *     0 <= r  complements  a >= 0          what presses c together: -(a_c - W_cc r_c) = W_cc r_c where r_c > 0
 */
#include "scene/scene_press.h"
#include "contact/cone_assemble.h"

typedef struct press_room {
    imp_cone_contact *contacts;
    imp_cone_row *rows;
    double *w, *q, *r, *a, *friction;
    int *of; /* which of the meetings each is */
} press_room;

static bool take_press_room(imp_arena *arena, size_t count, press_room *room)
{
    const size_t n = 3 * count;
    *room = (press_room){.contacts = imp_arena_take(arena, count, sizeof *room->contacts),
                         .rows = imp_arena_take(arena, count, sizeof *room->rows),
                         .w = imp_arena_take(arena, n * n, sizeof *room->w),
                         .q = imp_arena_take(arena, n, sizeof *room->q),
                         .r = imp_arena_take(arena, n, sizeof *room->r),
                         .a = imp_arena_take(arena, n, sizeof *room->a),
                         .friction = imp_arena_take(arena, count, sizeof *room->friction),
                         .of = imp_arena_take(arena, count, sizeof *room->of)};
    return room->contacts && room->rows && room->w && room->q && room->r && room->a && room->friction && room->of;
}

static void give_press_room(imp_arena *arena, press_room *room)
{
    imp_arena_give(arena, room->contacts);
    imp_arena_give(arena, room->rows);
    imp_arena_give(arena, room->w);
    imp_arena_give(arena, room->q);
    imp_arena_give(arena, room->r);
    imp_arena_give(arena, room->a);
    imp_arena_give(arena, room->friction);
    imp_arena_give(arena, room->of);
}

/* Those that do not part, under the loads alone; how many. */
static int list_pressed(imp_island *island, imp_meeting *met, int count, press_room *room)
{
    int n = 0;
    for (int c = 0; c < count; c++) {
        imp_meeting *m = &met[c];
        m->own = 0, m->pressed = false;
        imp_scene_press(island, m);
        if (m->velocity > island->world.slip_speed) continue;
        imp_cone_contact *own = &room->contacts[n];
        *own = (imp_cone_contact){
            .body1 = m->contact.body1, .body2 = m->contact.body2, .arm1 = m->contact.r1, .arm2 = m->contact.r2};
        imp_cone_find_axes(m->contact.normal, own->axes);
        room->q[3 * n] = m->acceleration, room->q[3 * n + 1] = room->q[3 * n + 2] = 0;
        room->friction[n] = 0;
        room->of[n++] = c;
    }
    return n;
}

static impact_status press_in(imp_island *island, imp_meeting *met, int count, press_room *room)
{
    imp_world *world = &island->world;
    impact_status status = imp_scene_load(island);
    const int n = status == IMPACT_OK ? list_pressed(island, met, count, room) : 0;
    imp_cone_workspace cone = {.arena = world->arena};
    if (n > 1 && !imp_cone_reserve(&cone, n)) status = IMPACT_ENOMEM;
    if (n > 1 && status == IMPACT_OK) {
        imp_cone_assemble(world, island->states, room->contacts, n, room->rows, room->w);
        const imp_cone_problem problem = {
            .count = n, .w = room->w, .q = room->q, .friction = room->friction, .effort = IMP_CONE_BRIEF};
        const imp_cone_outcome outcome = imp_cone_solve(&problem, &cone, room->r, room->a, NULL);
        const bool solved = outcome.status == IMP_CONE_SOLVED || outcome.status == IMP_CONE_INEXACT;
        for (int k = 0; solved && k < n; k++) {
            const double own = room->w[3 * k * (3 * n + 1)] * room->r[3 * k];
            met[room->of[k]].own = own;
            met[room->of[k]].acceleration = room->a[3 * k] - own;
        }
    }
    imp_cone_release(&cone);
    return status == IMPACT_OK ? imp_scene_load_with_reactions(island) : status;
}

impact_status imp_scene_press_all(imp_island *island, imp_meeting *met, int count)
{
    press_room room;
    const impact_status status = take_press_room(island->world.arena, (size_t)count, &room)
                                     ? press_in(island, met, count, &room)
                                     : IMPACT_ENOMEM;
    give_press_room(island->world.arena, &room);
    return status;
}
