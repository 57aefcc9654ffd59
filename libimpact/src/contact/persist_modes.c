/* SPDX-License-Identifier: MIT
 *
 * The modes of held contacts are what Coulomb's law in accelerations makes of them (cone.h):
 *
 *     K* contains û,  û . r = 0,  K contains r,   u = W r + q,   q = bias + (n' . slip) n
 *
 * for all contacts of bodies that hang together: r_n = 0 opens, friction within its cone sticks, on it slides, u_t
 * being where to. Contacts that slide at a speed s obey the same law of their velocities a time h on, which over h has
 * s/h + u for u. As h goes to 0 the direction of that is s's, whatever its size: their q has `far` of the largest
 * acceleration along s, so that it is off by 1/far of it; and what u then has across s is taken from q, which leaves
 * 1/far of that.
 *
 * A flat place shifts to where moments balance: forces on it move its body without turning it, and W is 1/m.
 *
 * The modes that a contact comes with are tried first, by one linear system, and are kept where they obey: at the ends
 * of slip and of pressure the law allows both, and who found that end knows which comes next. Where reactions are not
 * unique the law's own, amid what the cones allow, is what they stay next to from there on: friction gives way only
 * where none holds.
 */
#include "contact/cone_assemble.h"
#include "contact/persist_choice.h"
#include "contact/persist_flat.h"
#include "contact/persist_system.h"

#include <math.h>

/* ---- whether modes obey ---- */

/* The largest force of the island. */
static double greatest_force(const imp_persist *persist, int island)
{
    double scale = 0;
    for (int c = 0; c < persist->count; c++)
        if (persist->island[c] == island) scale = fmax(scale, qvec3_norm(persist->touches[c].force));
    return scale;
}

/* Whether the touch, solved for, pulls no more than rounding; nor slides without pressure, where that is no matter of
 * choice; and its friction is in its cone, against slip that begins on it. What rolls with a slip begun is asked. */
static bool obeys(const imp_touch *touch, const imp_pair *pair, double scale)
{
    const double rounding = IMP_MODE_ROUNDING * scale;
    const bool presses = touch->mode == IMP_SLIDE && !touch->redundant;
    if (touch->still) return true;
    if (touch->mode == IMP_ROLL && imp_is_onset(pair)) return false;
    if (touch->pressure < (presses ? rounding : -rounding)) return false;
    return touch->mode == IMP_ROLL ? touch->margin >= -rounding
                                   : !touch->onset || touch->drive >= 1 - IMP_DRIVE_ROUNDING;
}

static bool island_obeys(const imp_persist *persist, const imp_world *world, int island)
{
    const double scale = greatest_force(persist, island);
    for (int c = island; c < persist->count; c++)
        if (persist->island[c] == island &&
            !obeys(&persist->touches[c], &world->pairs[persist->touches[c].pair], scale))
            return false;
    return true;
}

static bool all_obey(const imp_persist *persist, const imp_world *world)
{
    for (int c = 0; c < persist->count; c++)
        if (persist->island[c] == c && !island_obeys(persist, world, c)) return false;
    return true;
}

/* ---- the cone problem of an island ---- */

typedef struct modes_room {
    int count;
    int *touch; /* which of the persist's each is */
    imp_cone_contact *contacts;
    imp_cone_row *rows;
    imp_cone_mode *modes;
    double *w, *q, *r, *u, *friction;
    double size; /* the largest part of q as the loads make it, m/s^2 */
    imp_cone_workspace cone;
} modes_room;

static bool take_modes_room(imp_arena *arena, size_t count, modes_room *room)
{
    const size_t n = 3 * count;
    *room = (modes_room){.touch = imp_arena_take(arena, count, sizeof *room->touch),
                         .contacts = imp_arena_take(arena, count, sizeof *room->contacts),
                         .rows = imp_arena_take(arena, count, sizeof *room->rows),
                         .modes = imp_arena_take(arena, count, sizeof *room->modes),
                         .w = imp_arena_take(arena, n * n + 3 * n + count, sizeof *room->w),
                         .cone = {.arena = arena}};
    if (!room->touch || !room->contacts || !room->rows || !room->modes || !room->w) return false;
    room->q = room->w + n * n, room->r = room->q + n, room->u = room->r + n, room->friction = room->u + n;
    return imp_cone_reserve(&room->cone, (int)count);
}

static void give_modes_room(imp_arena *arena, modes_room *room)
{
    imp_cone_release(&room->cone);
    imp_arena_give(arena, room->touch);
    imp_arena_give(arena, room->contacts);
    imp_arena_give(arena, room->rows);
    imp_arena_give(arena, room->modes);
    imp_arena_give(arena, room->w);
}

static void list_contacts(const imp_persist *persist, int island, modes_room *room)
{
    room->count = 0;
    for (int c = island; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        if (persist->island[c] != island) continue;
        imp_cone_contact *own = &room->contacts[room->count];
        *own = (imp_cone_contact){.body1 = touch->body1, .body2 = touch->body2, .arm1 = touch->r1, .arm2 = touch->r2};
        imp_cone_find_axes(touch->normal, own->axes);
        room->friction[room->count] = touch->friction;
        room->touch[room->count++] = c;
    }
}

/* A body that lies on a flat place has no other contact. */
static void lie_on_flat(const imp_world *world, const imp_touch *touch, const imp_state *states, const imp_load *loads,
                        modes_room *room)
{
    const double response = world->bodies[touch->body1].inverse_mass;
    const qvec3 holding = imp_flat_holding(world, touch->pair, states, loads);
    for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++) room->w[3 * k + l] = k == l ? response : 0;
        room->q[k] = -response * qvec3_dot(room->contacts[0].axes[k], holding);
    }
}

/* W and q. */
static void find_problem(const imp_persist *persist, const imp_world *world, const imp_state *states,
                         const imp_load *loads, modes_room *room)
{
    const imp_touch *first = &persist->touches[room->touch[0]];
    if (first->foot == IMP_FOOT_FLAT) {
        lie_on_flat(world, first, states, loads, room);
        return;
    }
    imp_cone_assemble(world, states, room->contacts, room->count, room->rows, room->w);
    for (int i = 0; i < room->count; i++) {
        const imp_touch *touch = &persist->touches[room->touch[i]];
        for (int k = 0; k < 3; k++) room->q[3 * i + k] = qvec3_dot(room->contacts[i].axes[k], touch->bias);
        room->q[3 * i] += qvec3_dot(touch->normal_rate, touch->slip);
    }
}

/* Whether it slides as it goes, whatever the law says of what begins. */
static bool slides_on(const imp_touch *touch)
{
    return touch->mode == IMP_SLIDE && !touch->onset && touch->friction > 0;
}

/* Adds to q, of what slides on, so much along its slip. */
static void send_far(const imp_persist *persist, modes_room *room, double far)
{
    for (int i = 0; i < room->count; i++) {
        const imp_touch *touch = &persist->touches[room->touch[i]];
        for (int k = 1; k < 3 && slides_on(touch); k++)
            room->q[3 * i + k] += far * qvec3_dot(room->contacts[i].axes[k], touch->direction);
    }
}

/* Takes from q what u has across the slip of what slides on; whether there was such. */
static bool straighten(const imp_persist *persist, modes_room *room)
{
    bool any = false;
    for (int i = 0; i < room->count; i++) {
        const imp_touch *touch = &persist->touches[room->touch[i]];
        if (!slides_on(touch)) continue;
        const qvec3 across = qvec3_cross(touch->normal, touch->direction);
        const double a1 = qvec3_dot(room->contacts[i].axes[1], across),
                     a2 = qvec3_dot(room->contacts[i].axes[2], across),
                     off = a1 * room->u[3 * i + 1] + a2 * room->u[3 * i + 2];
        room->q[3 * i + 1] -= off * a1;
        room->q[3 * i + 2] -= off * a2;
        any = true;
    }
    return any;
}

/* Modes are shown right by the linear system alone: what residual they are found with does not matter. */
static bool solve_law(const imp_persist *persist, modes_room *room)
{
    enum { ROUNDS = 3 };
    room->size = 0;
    for (int i = 0; i < 3 * room->count; i++) room->size = fmax(room->size, fabs(room->q[i]));
    send_far(persist, room, IMP_MODES_FAR * room->size);
    imp_cone_problem problem = {.count = room->count, .w = room->w, .q = room->q, .friction = room->friction};
    for (int k = 0; k < ROUNDS; k++) {
        const imp_cone_outcome o = imp_cone_solve(&problem, &room->cone, room->r, room->u, room->modes);
        if (o.status == IMP_CONE_NO_SOLUTION || o.status == IMP_CONE_BAD) return false;
        if (!straighten(persist, room)) return true;
    }
    return true;
}

/* ---- its answer ---- */

static qvec3 along_axes(const qvec3 axes[3], double normal, double t1, double t2)
{
    return qvec3_axpy(normal, axes[0], qvec3_axpy(t1, axes[1], qvec3_scale(axes[2], t2)));
}

/* Slip that begins, where it goes and how hard: not known yet of acceleration that is rounding's, when it goes against
 * the friction. */
static imp_sliding begun_slip(const imp_touch *touch, const qvec3 axes[3], double size, const double *r,
                              const double *u)
{
    const double rate = hypot(u[1], u[2]), rubs = hypot(r[1], r[2]);
    if (!(touch->friction > 0)) return (imp_sliding){.age = IMP_SLIP_OLD};
    if (rate <= IMP_DRIVE_ROUNDING * size)
        return (imp_sliding){.age = IMP_SLIP_BEGUN, .direction = along_axes(axes, 0, -r[1] / rubs, -r[2] / rubs)};
    return (imp_sliding){
        .age = IMP_SLIP_TURNED, .direction = along_axes(axes, 0, u[1] / rate, u[2] / rate), .pull = rate / rubs};
}

static void take_mode(imp_pair *pair, const imp_touch *touch, const qvec3 axes[3], imp_cone_mode mode, double size,
                      const double *r, const double *u)
{
    pair->rest.reaction = along_axes(axes, r[0], r[1], r[2]);
    if (mode == IMP_CONE_OPEN) {
        pair->mode = IMP_OPEN;
    } else if (mode == IMP_CONE_STICKS) {
        pair->mode = IMP_ROLL;
        pair->slip.age = IMP_SLIP_BEGUN; /* until its reaction is chosen */
    } else if (!slides_on(touch)) {
        pair->mode = IMP_SLIDE;
        pair->slip = begun_slip(touch, axes, size, r, u);
    }
}

/* False where what slides on would be stopped at once: that is an impact. */
static bool take_modes(const imp_persist *persist, imp_world *world, const modes_room *room)
{
    double most = 0;
    for (int i = 0; i < room->count; i++) most = fmax(most, room->r[3 * i]);
    for (int i = 0; i < room->count; i++) {
        const imp_touch *touch = &persist->touches[room->touch[i]];
        const bool presses = room->r[3 * i] > IMP_PRESSED_OF_LOADS * most;
        if (presses && room->modes[i] == IMP_CONE_STICKS && slides_on(touch)) return false;
        take_mode(&world->pairs[touch->pair], touch, room->contacts[i].axes, presses ? room->modes[i] : IMP_CONE_OPEN,
                  room->size, &room->r[3 * i], &room->u[3 * i]);
    }
    return true;
}

/* The modes of every island that disobeys; false where the law is not solved. */
static bool find_modes(const imp_persist *persist, imp_world *world, const imp_state *states, const imp_load *loads,
                       modes_room *room)
{
    for (int c = 0; c < persist->count; c++) {
        if (persist->island[c] != c || island_obeys(persist, world, c)) continue;
        list_contacts(persist, c, room);
        find_problem(persist, world, states, loads, room);
        if (!solve_law(persist, room) || !take_modes(persist, world, room)) return false;
    }
    return true;
}

static impact_status solve_modes(imp_persist *persist, imp_world *world, const imp_state *states, const imp_load *loads)
{
    modes_room room;
    impact_status status = take_modes_room(persist->arena, (size_t)persist->count, &room) ? IMPACT_OK : IMPACT_ENOMEM;
    if (status == IMPACT_OK && !find_modes(persist, world, states, loads, &room)) status = IMPACT_EUNSETTLED;
    give_modes_room(persist->arena, &room);
    if (status == IMPACT_OK) status = imp_persist_reserve(persist, world, states);
    if (status != IMPACT_OK) return status;
    imp_persist_solve(persist, world, states, loads);
    status = imp_persist_choose(persist, world, states, loads);
    if (status != IMPACT_OK) return status;
    return all_obey(persist, world) ? IMPACT_OK : IMPACT_EUNSETTLED;
}

/* Sliding that has died out, here or because another contact's did, is rolling until its friction says otherwise. */
static void stop_slow_slides(imp_persist *persist, imp_world *world, const imp_state *states, const imp_load *loads)
{
    imp_persist_find_touches(persist, world, states, loads);
    for (int c = 0; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        if (slides_on(touch) && touch->speed <= world->slip_speed) world->pairs[touch->pair].mode = IMP_ROLL;
    }
}

impact_status imp_persist_resolve(imp_persist *persist, imp_world *world, const imp_state *states,
                                  const imp_load *loads)
{
    const impact_status status = imp_persist_reserve(persist, world, states);
    if (status != IMPACT_OK || persist->count == 0) return status;
    stop_slow_slides(persist, world, states, loads);
    imp_persist_solve(persist, world, states, loads);
    return all_obey(persist, world) ? IMPACT_OK : solve_modes(persist, world, states, loads);
}
