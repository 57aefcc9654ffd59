/* SPDX-License-Identifier: MIT
 *
 * With L in body axes, tau = L' in the world, I the principal moments:
 *
 *     I1 W1' = (I2 - I3) W2 W3 + tau1        I1 W1'' = (I2 - I3)(W2' W3 + W2 W3') + (tau' + tau x W)1
 *     m' = m x W      m'' = m' x W + m x W'      m''' = m'' x W + 2 m' x W' + m x W''
 *
 * and where tau does the work, (2 E)' = 2 tau.W <= 2 |tau| sqrt(2 E/I) with the least I: so the root of 2 E grows by
 * |tau| T/sqrt(I) at most, and W1 is no more than it over sqrt(I1). A slender body's slim axis has the least moment,
 * and |L|/I there says nothing of what it does.
 */
#include "motion/spin.h"

/* A bound of each component. */
typedef struct components {
    double of[3];
} components;

static components components_of(qvec3 v) { return (components){{fabs(v.x), fabs(v.y), fabs(v.z)}}; }
static double norm_of(components v) { return sqrt(v.of[0] * v.of[0] + v.of[1] * v.of[1] + v.of[2] * v.of[2]); }

/* Of a x b. */
static components cross_bound(components a, components b)
{
    components r;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        r.of[i] = a.of[j] * b.of[k] + a.of[k] * b.of[j];
    }
    return r;
}

/* Of what Euler's equation makes of products W2 W3, or their rates, and a torque. */
static components euler(const double I[3], components products, double torque)
{
    components r;
    for (int i = 0; i < 3; i++) r.of[i] = (fabs(I[(i + 1) % 3] - I[(i + 2) % 3]) * products.of[i] + torque) / I[i];
    return r;
}

static components rate_of(const double I[3], components w, double torque)
{
    return euler(I, (components){{w.of[1] * w.of[2], w.of[2] * w.of[0], w.of[0] * w.of[1]}}, torque);
}

/* No less than W over the window: by |L|, by the energy, and by how far its rate takes it. */
static components most_omega(const double I[3], qvec3 omega, double momentum, double torque, double window)
{
    const components now = components_of(omega);
    const double least = sqrt(fmin(I[0], fmin(I[1], I[2])));
    double energy = 0;
    components w;
    for (int i = 0; i < 3; i++) energy += I[i] * now.of[i] * now.of[i];
    const double root = sqrt(energy) + (torque > 0 ? torque * window / least : 0);
    for (int i = 0; i < 3; i++) w.of[i] = fmin(momentum / I[i], root / sqrt(I[i]));
    for (int round = 0; round < 2; round++) {
        const components rate = rate_of(I, w, torque);
        for (int i = 0; i < 3; i++) w.of[i] = fmin(w.of[i], now.of[i] + (rate.of[i] > 0 ? rate.of[i] * window : 0));
    }
    return w;
}

static qvec3 by_axes(qvec3 a, qvec3 b) { return (qvec3){a.x * b.x, a.y * b.y, a.z * b.z}; }

qvec3 imp_spin_rate(const imp_body *body, const imp_state *now, qvec3 torque)
{
    const qvec3 L = quat_rotate_inverse(now->q, now->momentum), tau = quat_rotate_inverse(now->q, torque);
    return by_axes(qvec3_add(tau, qvec3_cross(L, by_axes(L, body->inverse_moments))), body->inverse_moments);
}

imp_spin imp_spin_of(const imp_body *body, const imp_state *now, const qvec3 *fastest, double momentum,
                     imp_torques torques, double window)
{
    const double I[3] = {body->moments.x, body->moments.y, body->moments.z};
    const qvec3 omega = by_axes(quat_rotate_inverse(now->q, now->momentum), body->inverse_moments);
    const components w = fastest ? components_of(*fastest) : most_omega(I, omega, momentum, torques.most, window),
                     rate = rate_of(I, w, torques.most),
                     second = euler(I, cross_bound(rate, w), torques.rate + torques.most * norm_of(w));
    const double most = norm_of(w), turning = norm_of(rate), swing = norm_of(second);
    return (imp_spin){.omega = omega,
                      .rate = imp_spin_rate(body, now, torques.now),
                      .most = most,
                      .most_rate = turning,
                      .most_second = swing,
                      .second = most * most + turning,
                      .third = most * most * most + 3 * most * turning + swing};
}
