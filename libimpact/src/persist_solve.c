/* SPDX-License-Identifier: MIT
 *
 * The reactions of held contacts: the linear system, and the directions of slip that begins from rest.
 */
#include "persist_system.h"

#include <math.h>

/* What the reactions leave of each touch's tangential acceleration, and how far its friction is from the cone. */
static void finish_touches(impact_persist *persist, const impact_world *world, const impact_state *states)
{
    for (int a = 0; a < persist->count; a++) {
        impact_touch *touch = &persist->touches[a];
        qvec3 rate = touch->bias;
        for (int b = 0; b < persist->count; b++)
            if (persist->island[a] == persist->island[b])
                rate = qvec3_add(rate, impact_system_response(world, states, touch, &persist->touches[b],
                                                              persist->touches[b].force));
        touch->slip_rate = qvec3_axpy(-qvec3_dot(rate, touch->normal), touch->normal, rate);
        const qvec3 tangential = qvec3_axpy(-touch->pressure, touch->normal, touch->force);
        touch->margin = touch->friction * touch->pressure - qvec3_norm(tangential);
    }
}

static void solve_reactions(impact_persist *persist, const impact_world *world, const impact_state *states)
{
    for (int c = 0; c < persist->count; c++) {
        impact_touch *touch = &persist->touches[c];
        touch->wanted = qvec3_neg(qvec3_axpy(qvec3_dot(touch->normal_rate, touch->slip), touch->normal, touch->bias));
    }
    impact_system_solve(persist, world, states, true);
    finish_touches(persist, world, states);
}

/* The unit vector d and the least k >= 0 of (A + k) d = b, for A symmetric and positive definite, in two dimensions: k by Newton on
 * 1/|d(k)| = 1, which is concave and increasing, from k = 0. *drive = |A^-1 b|; below 1 there is no k: d is then A^-1 b/drive. */
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
        if (!(step > 1e-16 * (p + q))) return;
        k += step;
    }
}

/* Slip that begins from rest goes the way it is accelerated, slip_rate || direction, until it is fast enough to have a direction of its
 * own. Turns the touch's direction there, with the pressure as it is; returns by how much. */
static double turn_onset(const impact_world *world, const impact_state *states, impact_touch *touch)
{
    const qvec3 t1 = impact_tangent(touch->normal), t2 = qvec3_cross(touch->normal, t1);
    const double grip = touch->friction * touch->pressure;
    const qvec3 k1 = impact_system_response(world, states, touch, touch, qvec3_scale(t1, grip));
    const qvec3 k2 = impact_system_response(world, states, touch, touch, qvec3_scale(t2, grip));
    const double a11 = qvec3_dot(t1, k1), a12 = qvec3_dot(t1, k2), a22 = qvec3_dot(t2, k2);
    const double x = qvec3_dot(t1, touch->direction), y = qvec3_dot(t2, touch->direction);
    const double b1 = qvec3_dot(t1, touch->slip_rate) + a11 * x + a12 * y,
                 b2 = qvec3_dot(t2, touch->slip_rate) + a12 * x + a22 * y;
    if (!(grip > 0) || (b1 == 0 && b2 == 0)) {
        touch->drive = 0;
        return 0;
    }
    double d1, d2;
    secular(a11, a12, a22, b1, b2, &d1, &d2, &touch->drive);
    touch->direction = qvec3_axpy(d1, t1, qvec3_scale(t2, d2));
    return hypot(d1 - x, d2 - y);
}

void impact_persist_solve(impact_persist *persist, impact_world *world, const impact_state *states,
                          const impact_load *loads)
{
    enum { TURNS = 50 };
    impact_persist_find_touches(persist, world, states, loads);
    for (int turn = 0; turn < TURNS; turn++) {
        solve_reactions(persist, world, states);
        double turned = 0;
        for (int c = 0; c < persist->count; c++)
            if (persist->touches[c].onset) turned = fmax(turned, turn_onset(world, states, &persist->touches[c]));
        if (turned < 1e-15) return;
    }
}
