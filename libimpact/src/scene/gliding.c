/* SPDX-License-Identifier: MIT */
#include "scene/gliding.h"
#include "base/tolerances.h"
#include "contact/held_flat.h"
#include "contact/held_spot.h"
#include "contact/points.h"
#include "motion/face_begin.h"
#include "motion/lying_steady.h"
#include "scene/scene_events.h"
#include "scene/scene_meeting.h"
#include "scene/scene_points.h"
#include "world/corner.h"

#include <string.h>

static double size_of(const double v[2]) { return hypot(v[0], v[1]); }

/* ---- whether it glides ---- */

/* Of a line's twist what its steps err by is none: along it friction is steep about none, v/w log(v/w); nor are
 * roundings of its roll. */
static void clear_errors(imp_lying *lying)
{
    double *y = lying->start, *v = &y[IMP_FACE_V], *w = &y[IMP_FACE_W], *roll = &y[IMP_FACE_ROLL];
    const double c = lying->motion.height, slip = size_of(v) + fabs(*w), rolls = c * fabs(*roll),
                 least = IMP_FACE_TOLERANCE * slip + IMP_LEVEL * rolls;
    for (int k = 0; k < 2; k++)
        if (fabs(v[k]) <= least) v[k] = 0;
    if (fabs(*w) <= least) *w = 0;
    if (rolls <= IMP_FACE_TOLERANCE * slip) *roll = 0;
}

/* Of the twist what is but a rounding of the rest is none; nor is what is slower than the rest speed. */
static void clear_roundings(imp_lying *lying, double slow)
{
    double *y = lying->start, *v = &y[IMP_FACE_V], *w = &y[IMP_FACE_W];
    const double speed = size_of(v);
    if (!(speed + fabs(*w) > slow)) v[0] = v[1] = *w = 0;
    if (fabs(*w) <= IMP_LEVEL * speed) *w = 0;
    if (speed <= IMP_LEVEL * fabs(*w)) v[0] = v[1] = 0;
    if (imp_lies_on_line(lying)) clear_errors(lying);
}

static bool find_lying(imp_island *island, const imp_pair *pair, double t, const imp_state *states, double slow,
                       imp_lying *lying)
{
    if (island->scene->piles == IMPACT_PILES_STEPS) return false;
    if (!imp_lying_find(&island->motion, pair, t, states, lying)) return false;
    lying->motion.still = island->scene->rest_speed / lying->size;
    clear_roundings(lying, slow / lying->size);
    return true;
}

/* From rest. Where the face reaches over a border it is not all of it that is pressed: what this says then holds of a
 * load that has no moment about the centre of pressure, as gravity has none (Jensen). */
static imp_face_begin begins(const imp_lying *lying, imp_face_balance *balance)
{
    double a[3];
    return imp_face_begins(&lying->motion, lying->start, a, balance);
}

/* Whether it moves, or begins to; and its face lies within what it lies on, or slides over its border in closed form.
 */
static bool glides(imp_island *island, const imp_lying *lying)
{
    const imp_face_motion *m = &lying->motion;
    const double *y = lying->start;
    double rate[IMP_FACE_STATE];
    imp_face_balance balance = {.p = {0}};
    imp_lying_steady s;
    const bool moves = imp_face_speed(m, y) > 0;
    if (!moves && begins(lying, &balance) != IMP_FACE_GOES) return false;
    if (imp_lying_find_steady(lying, 0, &s)) return true;
    if (moves && !imp_face_rates(m, y, rate, &balance)) return false;
    if (!(imp_face_margin(m, y, &balance) > 2 * IMP_FACE_MARGIN)) return false;
    imp_face_path path;
    island->glide = IMP_FACE_LONGEST;
    return imp_face_motion_step(m, y, &island->glide, &path);
}

/* Whether it stands, all of its face on what it lies on. */
static bool stands_on_all(const imp_lying *lying)
{
    imp_face_balance balance;
    return imp_face_speed(&lying->motion, lying->start) == 0 && begins(lying, &balance) == IMP_FACE_STANDS &&
           !imp_face_rolls(&lying->motion, lying->start, &balance) &&
           imp_face_margin(&lying->motion, lying->start, &balance) > 2 * IMP_FACE_MARGIN;
}

/* Under forces that may move it later. */
static bool stands_for_now(const imp_lying *lying)
{
    return imp_field_unsteady(lying->moves->world) && stands_on_all(lying);
}

static impact_status tell_slide(imp_island *island, int p, const imp_lying *lying, impact_event_kind kind)
{
    const imp_pair *pair = &island->world.pairs[p];
    const imp_held_contact contact = {.pair = p,
                                      .body1 = pair->body1,
                                      .body2 = pair->body2,
                                      .normal = lying->normal,
                                      .r1 = qvec3_scale(lying->normal, -lying->motion.height * lying->size)};
    impact_event event = imp_scene_event_of_contact(island, kind, &contact);
    event.phases = "slide";
    return imp_scene_record(island, &event);
}

/* ---- tipping ---- */

/* Where the pressure would have to be so that friction holds the body, or brakes its slide, without tipping it. */
static void wanted_center(const imp_face_motion *m, const double *y, double center[2])
{
    const double *v = &y[IMP_FACE_V], speed = size_of(v), pull = size_of(m->load.pull),
                 hold = m->friction * m->load.press;
    const double *along = speed > 0 ? v : m->load.pull, size = speed > 0 ? speed : pull;
    const double part = size > 0 ? (speed > 0 ? hold : fmin(hold, pull)) / (m->load.press * size) : 0;
    for (int k = 0; k < 2; k++) center[k] = m->height * part * along[k];
}

/* Whether that is on no place of the face: the body, which does not turn on it, tips over this side. */
static bool tips_over(const imp_lying *lying, int *side)
{
    const imp_flat_face *face = &lying->motion.face;
    double center[2], least = IMP_FACE_MARGIN;
    wanted_center(&lying->motion, lying->start, center);
    *side = -1;
    for (int i = 0; i < face->count && lying->start[IMP_FACE_W] == 0; i++) {
        const double spare = imp_side_spare(face, i, center);
        if (spare <= least) least = spare, *side = i;
    }
    return *side >= 0;
}

/* The points that are not on that side are about to rise. */
static void let_rise(imp_island *island, int first, int end, const imp_lying *lying, int side)
{
    for (int p = first; p < end; p++) {
        const qvec3 at = island->world.pairs[p].site.contact.offset1;
        const double x[2] = {qvec3_dot(lying->axis[0], at) / lying->size, qvec3_dot(lying->axis[1], at) / lying->size};
        island->notes[p].rises = imp_side_spare(&lying->motion.face, side, x) > IMP_TIP_SIDE;
    }
}

static bool is_of(const imp_pair *pair, int body) { return pair->body1 == body || pair->body2 == body; }

/* Whether another contact of the pair's body stays. */
static bool is_held_elsewhere_too(imp_island *island, const imp_pair *pair)
{
    for (int p = 0; p < island->world.pair_count; p++) {
        const imp_pair *other = &island->world.pairs[p];
        if (is_of(other, pair->body1) && !imp_same_bodies(other, pair) &&
            (imp_is_held(other) || imp_scene_point_stays(island, p)))
            return true;
    }
    return false;
}

/* The force of its face and where it acts, from the centre of mass; the moment there, about the normal. */
static bool force_of_glide(const imp_lying *lying, qvec3 *force, qvec3 *arm, double *moment)
{
    double rate[IMP_FACE_STATE];
    const double *y = lying->start;
    imp_face_balance balance = {.p = {0}};
    const bool moves = imp_face_speed(&lying->motion, y) > 0;
    if (moves ? !imp_face_rates(&lying->motion, y, rate, &balance) : begins(lying, &balance) == IMP_FACE_NEITHER)
        return false;
    imp_lying_force(lying, y, &balance, force, arm, moment);
    return true;
}

/* Whether another body will press on it: where the friction of its glide brakes it against one that touches. Of two
 * that go on as they do under their loads alone none knows, and each bounce, lower than what touches, would be another.
 */
static bool is_pressed_elsewhere_too(imp_island *island, const imp_pair *pair, const imp_lying *lying)
{
    double moment;
    qvec3 force, arm;
    if (!force_of_glide(lying, &force, &arm, &moment)) return false;
    imp_load *load = &island->motion.loads[pair->body1];
    const imp_load alone = *load;
    load->force = qvec3_add(alone.force, force);
    load->torque = qvec3_add(qvec3_axpy(moment, lying->normal, alone.torque), qvec3_cross(arm, force));
    bool pressed = false;
    for (int p = 0; p < island->world.pair_count && !pressed; p++) {
        const imp_pair *other = &island->world.pairs[p];
        imp_meeting m;
        if (!is_of(other, pair->body1) || imp_same_bodies(other, pair) || !imp_scene_meets(island, p, &m)) continue;
        imp_scene_press(island, &m);
        pressed = m.acceleration < 0 && imp_scene_dies_out(island, &m, m.velocity);
    }
    *load = alone;
    return pressed;
}

/* A corner that was held goes on as part of the face, and has not lifted off. */
static void lie(imp_island *island, int p)
{
    imp_pair *pair = &island->world.pairs[p];
    pair->footing.on = IMP_FOOT_FACE;
    pair->mode = island->notes[p].mode = IMP_OPEN;
    imp_end_incipient(pair);
    pair->site.corner = pair->site.face = 0;
}

/* It is told when it comes to rest, when its contact is made, and when it begins to slip. */
static impact_status tell_of_lying(imp_island *island, int p, const imp_lying *lying, bool stands, bool lay_before)
{
    const int body = island->world.pairs[p].body1;
    const bool stood = island->motion.resting[body];
    island->motion.resting[body] = stands;
    if (!stands && (stood || !lay_before))
        return tell_slide(island, p, lying, stood ? IMPACT_EVENT_SLIP : IMPACT_EVENT_CONTACT);
    if (!stands || stood) return IMPACT_OK;
    const impact_event event = imp_scene_event_of_body(island, IMPACT_EVENT_REST, body);
    return imp_scene_record(island, &event);
}

/* Lays the body of the pair whose points are first ... end - 1 exactly on its face: it glides there, or may rest. */
static impact_status lay(imp_island *island, int first, int end, bool lay_before, bool *any)
{
    imp_world *world = &island->world;
    int stay = 0;
    imp_lying lying;
    for (int p = first; p < end; p++) stay += world->pairs[p].site.placed && imp_scene_point_stays(island, p);
    if (stay < 3 || !world->bodies[world->pairs[first].body2].is_static) return IMPACT_OK;
    if (is_held_elsewhere_too(island, &world->pairs[first])) return IMPACT_OK;
    if (!find_lying(island, &world->pairs[first], island->t, island->states, island->scene->rest_speed, &lying))
        return IMPACT_OK;
    const int body = world->pairs[first].body1;
    const imp_state now = imp_lying_state(&lying, lying.start);
    imp_island_push(island, qvec3_scale(qvec3_sub(now.v, island->states[body].v), world->bodies[body].mass));
    island->states[body] = now;
    int side;
    const bool stands = stands_for_now(&lying);
    if (!stands && !glides(island, &lying)) {
        if (tips_over(&lying, &side)) let_rise(island, first, end, &lying, side), *any = true;
        return IMPACT_OK;
    }
    if (!stands && is_pressed_elsewhere_too(island, &world->pairs[first], &lying)) return IMPACT_OK;
    for (int p = first; p < end; p++) lie(island, p);
    *any = true;
    return tell_of_lying(island, first, &lying, stands, lay_before);
}

impact_status imp_island_lay(imp_island *island, bool lay_before, bool *any)
{
    const imp_world *world = &island->world;
    impact_status status = IMPACT_OK;
    *any = false;
    for (int first = 0, end; status == IMPACT_OK && first < world->pair_count; first = end) {
        for (end = first + 1; end < world->pair_count; end++)
            if (!imp_same_bodies(&world->pairs[end], &world->pairs[first])) break;
        status = lay(island, first, end, lay_before, any);
    }
    return status;
}

/* ---- what is held, and lies ---- */

static void bring_onto(imp_island *island, int body, const imp_lying *lying)
{
    const imp_state now = imp_lying_state(lying, lying->start);
    const double energy = imp_scene_undriven_energy(island);
    imp_island_push(island, qvec3_scale(qvec3_sub(now.v, island->states[body].v), island->world.bodies[body].mass));
    island->states[body] = now;
    island->impact_loss += energy - imp_scene_undriven_energy(island);
}

/* Held no more. */
static void let_lie(imp_pair *pair)
{
    pair->mode = IMP_OPEN;
    imp_end_incipient(pair);
    pair->footing.on = IMP_FOOT_FACE;
}

/* ---- flat places ---- */

/* It lies on the plane's face as what has faces does, but for how it came there and what holds it afterwards: at one
 * point, which resists no torque, so that it stands too by its face where there are forces. */
static impact_status glide_on_flat(imp_island *island, int p)
{
    imp_lying lying;
    imp_pair *pair = &island->world.pairs[p];
    const int body = pair->body1;
    const bool forced = island->world.field_count > 0;
    if (!imp_is_held(pair) || pair->footing.on != IMP_FOOT_FLAT || pair->rest.still ||
        (island->motion.resting[body] && !forced) || !imp_flat_lies(&island->world, pair, island->states))
        return IMPACT_OK;
    if (!find_lying(island, pair, island->t, island->states, island->scene->rest_speed, &lying)) return IMPACT_OK;
    const bool stands = forced && stands_on_all(&lying);
    if (!stands && !glides(island, &lying)) return IMPACT_OK;
    bring_onto(island, body, &lying);
    let_lie(pair);
    return tell_of_lying(island, p, &lying, stands, true);
}

impact_status imp_island_glide_on_flats(imp_island *island)
{
    impact_status status = IMPACT_OK;
    for (int p = 0; status == IMPACT_OK && p < island->world.pair_count; p++) status = glide_on_flat(island, p);
    return status;
}

bool imp_island_hold_flat(imp_island *island, int p)
{
    imp_pair *pair = &island->world.pairs[p];
    const imp_body *body = &island->world.bodies[pair->body1];
    const imp_state *state = &island->states[pair->body1];
    impact_held held;
    imp_foot foot = IMP_FOOT_POINT;
    if (imp_pair_has_faces(&island->world, pair)) return false;
    if (imp_island_glide_force(island, island->t, island->states, &held)) {
        const qvec3 at = quat_rotate_inverse(state->q, qvec3_sub(held.point, state->x));
        imp_spot_on(&body->shape, at, pair->footing.spot);
        foot = IMP_FOOT_SPOT;
    }
    pair->footing.on = foot;
    pair->mode = island->motion.resting[pair->body1] ? IMP_STICK : IMP_SLIDE;
    return true;
}

/* ---- lines ---- */

/* The other end of the line that the pair holds one of; or NULL. */
static imp_pair *other_end(imp_island *island, const imp_pair *pair)
{
    for (int p = 0; p < island->world.pair_count; p++) {
        imp_pair *other = &island->world.pairs[p];
        if (other != pair && other->site.corner > 0 && imp_same_bodies(other, pair) && imp_is_held(other)) return other;
    }
    return NULL;
}

/* Whether anything but the line holds its body. */
static bool is_held_beside_line(const imp_island *island, const imp_pair *pair)
{
    for (int p = 0; p < island->world.pair_count; p++) {
        const imp_pair *other = &island->world.pairs[p];
        if (is_of(other, pair->body1) && !imp_same_bodies(other, pair) && imp_is_held(other)) return true;
    }
    return false;
}

/* What is held at both ends of a line, about which it is round, lies on all of it, where it slides or turns there, or
 * stands under forces. What but rolls is held on. */
static impact_status glide_on_line(imp_island *island, int p)
{
    imp_lying lying;
    imp_pair *pair = &island->world.pairs[p], *other;
    const int body = pair->body1;
    const bool forced = island->world.field_count > 0;
    if (!imp_is_held(pair) || pair->site.corner == 0 || !(other = other_end(island, pair)) || pair->rest.still ||
        (island->motion.resting[body] && !forced) || is_held_beside_line(island, pair))
        return IMPACT_OK;
    if (!find_lying(island, pair, island->t, island->states, island->scene->rest_speed, &lying) ||
        !imp_lies_on_line(&lying))
        return IMPACT_OK;
    const bool rests = forced && stands_on_all(&lying);
    if (!rests && (!glides(island, &lying) || is_pressed_elsewhere_too(island, pair, &lying))) return IMPACT_OK;
    const bool stuck = pair->mode == IMP_STICK && other->mode == IMP_STICK && !rests;
    bring_onto(island, body, &lying);
    let_lie(pair);
    let_lie(other);
    if (stuck) island->motion.resting[body] = true; /* it is from then on that it slips */
    return tell_of_lying(island, p, &lying, rests, true);
}

/* What lies is not among what is held: others of the island may be. */
impact_status imp_island_glide_on_lines(imp_island *island)
{
    impact_status status = IMPACT_OK;
    bool any = false;
    for (int p = 0; status == IMPACT_OK && p < island->world.pair_count; p++) {
        const bool held = imp_is_held(&island->world.pairs[p]);
        status = glide_on_line(island, p);
        any = any || (held && !imp_is_held(&island->world.pairs[p]));
    }
    if (status != IMPACT_OK || !any) return status;
    return imp_held_reserve(&island->motion.held, &island->world, island->states);
}

bool imp_island_hold_line(imp_island *island, int p)
{
    imp_pair *pair = &island->world.pairs[p];
    if (pair->site.corner == 0) return false;
    pair->footing.on = IMP_FOOT_POINT;
    pair->mode = island->motion.resting[pair->body1] ? IMP_STICK : IMP_SLIDE;
    pair->site.side = (qvec3){0, 0, 0};
    return true;
}

void imp_island_stop_on_line(imp_island *island, int p)
{
    imp_lying lying;
    const imp_pair *pair = &island->world.pairs[p];
    if (!find_lying(island, pair, island->t, island->states, INFINITY, &lying)) return;
    island->states[pair->body1] = imp_lying_state(&lying, lying.start);
}

bool imp_island_may_lie(imp_island *island)
{
    const imp_pile_memories *held = imp_pile_held(island->pile);
    int moving = 0;
    imp_lying lying;
    for (int i = 0; i < island->world.body_count; i++) moving += !island->world.bodies[i].is_static;
    if (moving != 1 || held->count < 3) return false;
    for (int k = 1; k < held->count; k++)
        if (held->list[k].pair != held->list[0].pair) return false;
    const imp_pair *pair = &island->world.pairs[held->list[0].pair];
    return island->world.bodies[pair->body2].is_static &&
           find_lying(island, pair, island->t, island->states, island->scene->rest_speed, &lying) &&
           (stands_for_now(&lying) || (!island->motion.resting[pair->body1] && glides(island, &lying)));
}

imp_pair *imp_island_lying(const imp_island *island)
{
    for (int p = 0; p < island->world.pair_count; p++)
        if (island->world.pairs[p].footing.on == IMP_FOOT_FACE) return &island->world.pairs[p];
    return NULL;
}

/* ---- its segments ---- */

static qvec3 along_face(const imp_lying *lying, const double a[2])
{
    return qvec3_add(qvec3_scale(lying->axis[0], lying->size * a[0]), qvec3_scale(lying->axis[1], lying->size * a[1]));
}

static void end_with(imp_island *island, imp_end_kind kind)
{
    island->end = (imp_end){kind, (int)(imp_island_lying(island) - island->world.pairs)};
}

/* Nothing goes on from here: it is to be settled anew. */
static imp_segment ends_here(imp_island *island, const imp_pair *pair)
{
    end_with(island, IMP_END_BOUNDS);
    imp_segment s = imp_segment_rest(island->t, &island->states[pair->body1]);
    s.t1 = island->t;
    return s;
}

/* A stay to where its load is to be looked at again, or more than the face holds; or a force's edge or switch is
 * before. */
static void stay_to_end(imp_island *island, const imp_lying *lying, imp_lying_steady *s)
{
    double y[IMP_FACE_STATE];
    imp_face_path path = {.c = {[1][IMP_FACE_TIME] = s->until}};
    memcpy(path.c[0], lying->start, sizeof path.c[0]);
    path.c[0][IMP_FACE_TIME] = s->until;
    imp_face_at(&path, imp_lying_end(lying, &path, &island->end), y);
    s->until = y[IMP_FACE_TIME];
    if (island->end.kind == IMP_END_TIME) end_with(island, s->breaks ? IMP_END_BOUNDS : IMP_END_RENEWAL);
}

/* A step to an edge, or one whose end is as its path has it: what changed behind the last node is not missed. */
static bool step_to_end(imp_island *island, const imp_lying *lying, imp_face_path *path, double *to)
{
    while (imp_face_motion_step(&lying->motion, lying->start, &island->glide, path)) {
        *to = imp_lying_end(lying, path, &island->end);
        if (island->end.kind != IMP_END_TIME || !(imp_face_end_miss(&lying->motion, path) > 1)) return true;
        island->glide = 0.5 * path->length;
    }
    return false;
}

impact_status imp_island_glide_on(imp_island *island, imp_segment *segment, bool *closed)
{
    const imp_pair *pair = imp_island_lying(island);
    imp_motion *motion = &island->motion;
    const double t = island->t;
    imp_lying lying;
    imp_lying_steady s;
    imp_face_path path;
    *closed = true;
    const bool found = find_lying(island, pair, t, island->states, 0, &lying);
    if (!found) {
        *segment = ends_here(island, pair);
        return IMPACT_OK;
    }
    const imp_state start = imp_lying_state(&lying, lying.start);
    if (imp_lying_find_steady(&lying, island->scene->rest_speed / lying.size, &s)) {
        const bool sticks = s.fades && lying.motion.friction > 0;
        end_with(island, sticks ? IMP_END_STICK : isfinite(s.until) ? IMP_END_BOUNDS : IMP_END_TIME);
        if (s.stands) stay_to_end(island, &lying, &s);
        const qvec3 spin_up = qvec3_axpy(s.roll, lying.axis[0], qvec3_scale(lying.normal, s.alpha));
        *segment = imp_segment_roll(t, t + s.until, &start, along_face(&lying, s.a), spin_up);
        return IMPACT_OK;
    }
    double to;
    if (!step_to_end(island, &lying, &path, &to)) {
        *segment = ends_here(island, pair);
        return IMPACT_OK;
    }
    *closed = false;
    if (island->end.kind == IMP_END_TIME) island->glide = fmin(island->glide, imp_lying_until_edge(&lying, &path));
    const impact_status status = imp_motion_next_lying(motion, &lying, &path, to, island->states);
    if (status == IMPACT_OK) *segment = imp_segment_dense(&motion->dense, 0, &start);
    return status;
}

bool imp_island_glide_force(imp_island *island, double t, const imp_state *states, impact_held *held)
{
    const imp_pair *pair = imp_island_lying(island);
    imp_lying lying;
    double moment;
    qvec3 force, arm;
    if (!find_lying(island, pair, t, states, 0, &lying) || !force_of_glide(&lying, &force, &arm, &moment)) return false;
    *held = (impact_held){.body1 = island->world.bodies[pair->body1].index,
                          .body2 = island->world.bodies[pair->body2].index,
                          .mode = island->motion.resting[pair->body1] ? IMPACT_HOLD_STICK : IMPACT_HOLD_SLIP,
                          .point = qvec3_add(states[pair->body1].x, arm),
                          .normal = lying.normal,
                          .force = force,
                          .moment = qvec3_scale(lying.normal, moment)};
    return true;
}
