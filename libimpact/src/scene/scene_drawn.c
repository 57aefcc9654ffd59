/* SPDX-License-Identifier: MIT
 *
 * Contact A slides at u_n = 0, the contacts H beside it are held: H's reactions answer a pressure at A so that they
 * stay held, each as it slides or rolls. With F the response of the bodies alone, f_A = n - mu e,
 *
 *     H r_H = -F_HA,      d(u_n)/d(lambda) = n . (F_AA + F_AH r_H)
 *
 * Under zero each pressure makes the need for it greater: with stiff springs at A and H, whatever their ratios, the
 * determinant of that response times those of H alone is the sign that a real exponent of growth takes.
 */
#include "scene/scene_drawn.h"
#include "collide/collide_tangential.h"
#include "contact/persist_system.h"

#include <float.h>
#include <string.h>

bool imp_scene_held_elsewhere(const imp_world *world, const imp_touch *touch)
{
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        const int body[2] = {pair->body1, pair->body2};
        if (p == touch->pair || !imp_is_held(pair)) continue;
        for (int k = 0; k < 2; k++)
            if (!world->bodies[body[k]].is_static && (body[k] == touch->body1 || body[k] == touch->body2)) return true;
    }
    return false;
}

/* Whether friction makes no normal velocity of the body's point: it stands in line with the centre. */
static bool is_in_line(const imp_body *body, qvec3 arm, qvec3 normal)
{
    return body->is_static || qvec3_norm(qvec3_cross(arm, normal)) <= 4 * DBL_EPSILON * qvec3_norm(arm);
}

static bool both_in_line(const imp_world *world, const imp_touch *touch)
{
    return is_in_line(&world->bodies[touch->body1], touch->r1, touch->normal) &&
           is_in_line(&world->bodies[touch->body2], touch->r2, touch->normal);
}

static bool may_slide(const imp_island *island, const imp_meeting *m)
{
    return m->touch.friction > 0 && fabs(m->velocity) <= island->world.slip_speed && island->scene->compliance == 0;
}

static bool slides(const imp_island *island, const imp_touch *touch)
{
    return touch->speed > island->world.slip_speed && !touch->flat && !touch->lined;
}

/* ---- with contacts beside it ---- */

/* The place of the pair among those held, or -1. */
static int find_held(const imp_persist *persist, int pair)
{
    for (int c = 0; c < persist->count; c++)
        if (persist->touches[c].pair == pair) return c;
    return -1;
}

/* What is held answers the touch's pressure as it moves now, not as it did before an impact. */
static void ask_contacts(const imp_island *island, imp_persist *persist, const imp_touch *touch, qvec3 force)
{
    for (int c = 0; c < persist->count; c++) {
        imp_touch *beside = &persist->touches[c];
        const bool stands = beside->friction > 0 && beside->speed <= island->world.slip_speed;
        if (!beside->onset) beside->mode = stands ? IMP_ROLL : IMP_SLIDE;
        beside->still = beside->turning = false;
        beside->wanted = qvec3_neg(imp_system_response(&island->world, island->states, beside, touch, force));
    }
}

/* d(u_n)/d(lambda), m/s^2 for 1 N, of the touch, which slides; the reactions that were solved for stay as they are. */
static double response_of(imp_island *island, const imp_touch *touch, bool *known)
{
    imp_persist *persist = &island->motion.persist;
    const size_t count = (size_t)persist->count;
    imp_touch *kept = imp_arena_take(island->world.arena, count, sizeof *kept);
    const qvec3 against = qvec3_scale(touch->slip, -touch->friction / touch->speed),
                force = qvec3_add(touch->normal, against);
    const int own = find_held(persist, touch->pair);
    *known = kept != NULL;
    if (!kept) return 0;
    memcpy(kept, persist->touches, count * sizeof *kept);
    if (own >= 0) persist->touches[own] = persist->touches[--persist->count];
    ask_contacts(island, persist, touch, force);
    imp_system_solve(persist, &island->world, island->states, true);
    const qvec3 change = qvec3_add(imp_system_response(&island->world, island->states, touch, touch, force),
                                   imp_system_change(persist, touch));
    persist->count = (int)count;
    memcpy(persist->touches, kept, count * sizeof *kept);
    imp_arena_give(island->world.arena, kept);
    return qvec3_dot(touch->normal, change);
}

/* ---- both questions ---- */

/* The pressure that holds the pair now; 0 where it is not held, or was until an impact changed how it moves. */
static double pressure_of(const imp_island *island, const imp_touch *touch)
{
    const imp_persist *persist = &island->motion.persist;
    const int own = find_held(persist, touch->pair);
    return own >= 0 && persist->touches[own].mode == IMP_SLIDE ? persist->touches[own].pressure : 0;
}

/* A held contact whose pressure is lambda would, let go, part at -response lambda: with a response under zero pressed
 * contacts have a pressure under zero. side: 1 pressed, -1 lifted. */
static bool draws_beside(imp_island *island, const imp_meeting *m, double side)
{
    const imp_touch *touch = &m->touch;
    const double pressure = pressure_of(island, touch);
    bool known;
    if (side * (pressure != 0 ? pressure : m->acceleration) >= 0) return false;
    if (pressure > 0 && both_in_line(&island->world, touch)) return false; /* round bodies that go on as they were */
    return response_of(island, touch, &known) < 0 && known;
}

static bool draws(imp_island *island, imp_meeting *m, double side)
{
    if (!may_slide(island, m)) return false;
    const bool beside = imp_scene_held_elsewhere(&island->world, &m->touch);
    if (!beside && both_in_line(&island->world, &m->touch)) return false;
    imp_scene_press(island, m);
    if (!slides(island, &m->touch)) return false;
    if (beside) return draws_beside(island, m, side);
    if (side * m->acceleration >= 0) return false;
    const impact_collision collision = imp_scene_collision(island, m);
    return imp_collide_draws(&collision);
}

bool imp_scene_jams(imp_island *island, imp_meeting *m) { return draws(island, m, 1); }

bool imp_scene_lifts(imp_island *island, imp_meeting *m) { return draws(island, m, -1); }
