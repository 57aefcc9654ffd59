/* SPDX-License-Identifier: MIT
 *
 * The reactions of held contacts: the linear system, and the directions of slip that begins from rest.
 */
#include "contact/persist_system.h"

#include <math.h>

/* What the reactions leave of each touch's tangential acceleration, and how far its friction is from the cone. */
static void finish_touches(imp_persist *persist)
{
    for (int a = 0; a < persist->count; a++) {
        imp_touch *touch = &persist->touches[a];
        const qvec3 rate = qvec3_add(touch->bias, imp_system_change(persist, touch));
        touch->slip_rate = qvec3_axpy(-qvec3_dot(rate, touch->normal), touch->normal, rate);
        const qvec3 tangential = qvec3_axpy(-touch->pressure, touch->normal, touch->force);
        touch->margin = touch->friction * touch->pressure - qvec3_norm(tangential);
    }
}

/* Where they are not unique, next to those that the pairs remember. */
static void solve_reactions(imp_persist *persist, const imp_world *world, const imp_state *states)
{
    for (int c = 0; c < persist->count; c++) {
        imp_touch *touch = &persist->touches[c];
        touch->force = world->pairs[touch->pair].rest.reaction;
        touch->wanted = qvec3_neg(qvec3_axpy(qvec3_dot(touch->normal_rate, touch->slip), touch->normal, touch->bias));
    }
    imp_system_solve(persist, world, states, true);
    finish_touches(persist);
}

/* The unit vector d and the least k >= 0 of (A + k) d = b, for A symmetric and positive definite, in two dimensions: k
 * by Newton on 1/|d(k)| = 1, which is concave and increasing, from k = 0. *drive = |A^-1 b|; below 1 there is no k: d
 * is then A^-1 b/drive. */
static void secular(double a11, double a12, double a22, double b1, double b2, double *d1, double *d2, double *drive)
{
    double k = 0;
    *drive = 0;
    for (int i = 0; i < 60; i++) {
        const double p = a11 + k, q = a22 + k, determinant = p * q - a12 * a12;
        *d1 = (q * b1 - a12 * b2) / determinant;
        *d2 = (p * b2 - a12 * b1) / determinant;
        const double size = hypot(*d1, *d2);
        if (i == 0) *drive = size;
        const double e1 = (q * *d1 - a12 * *d2) / determinant, e2 = (p * *d2 - a12 * *d1) / determinant;
        const double step = (size - 1) * size * size / (*d1 * e1 + *d2 * e2);
        *d1 /= size, *d2 /= size;
        if (!(step > IMP_SECULAR_STEP * (p + q))) return;
        k += step;
    }
}

/* Slip that begins from rest goes the way it is accelerated, slip_rate || direction, until it is fast enough to have a
 * direction of its own. The direction in which it does, with the pressure and the other touches' forces as they are;
 * sets the touch's drive. */
static qvec3 onset_direction(const imp_world *world, const imp_state *states, imp_touch *touch)
{
    const qvec3 t1 = imp_tangent(touch->normal), t2 = qvec3_cross(touch->normal, t1);
    const double grip = touch->friction * touch->pressure;
    const qvec3 k1 = imp_system_response(world, states, touch, touch, qvec3_scale(t1, grip));
    const qvec3 k2 = imp_system_response(world, states, touch, touch, qvec3_scale(t2, grip));
    const double a11 = qvec3_dot(t1, k1), a12 = qvec3_dot(t1, k2), a22 = qvec3_dot(t2, k2);
    const double x = qvec3_dot(t1, touch->direction), y = qvec3_dot(t2, touch->direction);
    const double b1 = qvec3_dot(t1, touch->slip_rate) + a11 * x + a12 * y,
                 b2 = qvec3_dot(t2, touch->slip_rate) + a12 * x + a22 * y;
    touch->drive = 0;
    if (!(grip > 0) || (b1 == 0 && b2 == 0)) return touch->direction;
    double d1, d2;
    secular(a11, a12, a22, b1, b2, &d1, &d2, &touch->drive);
    return qvec3_axpy(d1, t1, qvec3_scale(t2, d2));
}

static bool has_onset(const imp_persist *persist)
{
    for (int c = 0; c < persist->count; c++)
        if (persist->touches[c].onset) return true;
    return false;
}

/* ---- one contact after another: slow, but from anywhere ---- */

/* Turns every onset's direction to where it goes; the most that one turned. */
static double turn_each(imp_persist *persist, const imp_world *world, const imp_state *states)
{
    double turned = 0;
    for (int c = 0; c < persist->count; c++) {
        imp_touch *touch = &persist->touches[c];
        if (!touch->onset) continue;
        const qvec3 before = touch->direction;
        touch->direction = onset_direction(world, states, touch);
        turned = fmax(turned, qvec3_norm(qvec3_sub(touch->direction, before)));
    }
    return turned;
}

/* Solves with all directions as they are, and turns them, so often; the most that one turned last. */
static double turn_in_turns(imp_persist *persist, const imp_world *world, const imp_state *states, int turns)
{
    double turned = INFINITY;
    for (int c = 0; c < persist->count; c++) persist->touches[c].turning = false;
    for (int k = 0; k < turns && turned >= IMP_ONSET_TURNED; k++) {
        solve_reactions(persist, world, states);
        turned = turn_each(persist, world, states);
    }
    return turned;
}

/* ---- all together: Newton's method ---- */

/* What slip's acceleration is to friction: how its direction holds against being turned. */
static double pull_of(const imp_touch *touch)
{
    const double grip = touch->friction * touch->pressure;
    return grip > 0 ? qvec3_dot(touch->direction, touch->slip_rate) / grip : 0;
}

/* Takes the direction that was solved for; returns what the linear step left undone. */
static double take_turn(const imp_world *world, imp_touch *touch)
{
    const qvec3 across = qvec3_cross(touch->normal, touch->direction);
    const double turn = fmax(-0.5, fmin(0.5, touch->turn)), before = touch->pull, size = hypot(1, turn);
    touch->direction = qvec3_axpy(turn / size, across, qvec3_scale(touch->direction, 1 / size));
    touch->pull = pull_of(touch);
    const double response = world->bodies[touch->body1].inverse_mass + world->bodies[touch->body2].inverse_mass;
    return fabs(touch->turn) * (fabs(touch->turn) + fabs(touch->pull - before) / response);
}

/* From the directions and pulls as they are; false where it does not converge. */
static bool turn_together(imp_persist *persist, const imp_world *world, const imp_state *states)
{
    enum { STEPS = 12 };
    for (int k = 0; k < STEPS; k++) {
        double left = 0;
        for (int c = 0; c < persist->count; c++)
            persist->touches[c].turning = persist->touches[c].onset && persist->touches[c].friction > 0;
        solve_reactions(persist, world, states);
        for (int c = 0; c < persist->count; c++)
            if (persist->touches[c].turning) left = fmax(left, take_turn(world, &persist->touches[c]));
        if (left < IMP_ONSET_LEFT) return true;
        if (!(left < IMP_ONSET_FAR)) return false;
    }
    return false;
}

/* ---- both ---- */

/* Begins where slip went when it was last solved for; false where one of them begins anew. */
static bool recall_turns(imp_persist *persist, const imp_world *world)
{
    bool all = true;
    for (int c = 0; c < persist->count; c++) {
        imp_touch *touch = &persist->touches[c];
        if (!touch->onset) continue;
        const imp_pair *pair = &world->pairs[touch->pair];
        const qvec3 d =
            qvec3_axpy(-qvec3_dot(pair->slip.direction, touch->normal), touch->normal, pair->slip.direction);
        touch->direction = qvec3_scale(d, 1 / qvec3_norm(d));
        touch->pull = pair->slip.pull;
        all = all && pair->slip.age == IMP_SLIP_TURNED;
    }
    return all;
}

static void keep_turns(const imp_persist *persist, imp_world *world)
{
    for (int c = 0; c < persist->count; c++) {
        imp_touch touch = persist->touches[c];
        if (!touch.onset) continue;
        imp_pair *pair = &world->pairs[touch.pair];
        pair->slip = (imp_sliding){.age = IMP_SLIP_TURNED, .direction = touch.direction, .pull = touch.pull};
    }
}

/* Sets every onset's drive; whether all of them go on sliding. Newton's method also finds directions against which slip
 * would be accelerated: none of Coulomb's. */
static bool drive_onsets(imp_persist *persist, const imp_world *world, const imp_state *states)
{
    bool all = true;
    for (int c = 0; c < persist->count; c++) {
        imp_touch *touch = &persist->touches[c];
        if (!touch->onset) continue;
        onset_direction(world, states, touch);
        all = all && touch->drive >= 1 - IMP_DRIVE_ROUNDING;
    }
    return all;
}

/* Without knowledge of where slip went. */
static bool solve_anew(imp_persist *persist, imp_world *world, const imp_state *states)
{
    enum { TRIES = 4, FEW = 5, MANY = 50 };
    for (int k = 0; k < TRIES; k++) {
        recall_turns(persist, world);
        if (turn_in_turns(persist, world, states, FEW << k) < IMP_ONSET_TURNED) return true;
        for (int c = 0; c < persist->count; c++) persist->touches[c].pull = pull_of(&persist->touches[c]);
        if (turn_together(persist, world, states)) return true;
    }
    recall_turns(persist, world);
    return turn_in_turns(persist, world, states, MANY) < IMP_ONSET_TURNED;
}

/* The directions of slip that begins, and all reactions with them. */
static void solve_onsets(imp_persist *persist, imp_world *world, const imp_state *states)
{
    bool settled = recall_turns(persist, world) && turn_together(persist, world, states);
    bool good = settled && drive_onsets(persist, world, states);
    if (!good) {
        settled = solve_anew(persist, world, states);
        good = settled && drive_onsets(persist, world, states);
    }
    if (good) keep_turns(persist, world);
}

void imp_persist_solve(imp_persist *persist, imp_world *world, const imp_state *states, const imp_load *loads)
{
    imp_persist_find_touches(persist, world, states, loads);
    if (has_onset(persist))
        solve_onsets(persist, world, states);
    else
        solve_reactions(persist, world, states);
}
