/* SPDX-License-Identifier: MIT
 *
 * What bench_omega and its peers share: the motion q(t) = exp(z a t) exp(x b) exp(z c t), its angular velocity in body
 * axes, and what makes one of the other.
 */
#ifndef PEERS_OMEGA_H
#define PEERS_OMEGA_H

#include <quat/rotation.h>

static const double omega_duration = 10, omega_a = 2.3, omega_b = 0.7, omega_c = 1.1; /* s; rad/s, rad, rad/s */

static inline quat omega_truth(double t)
{
    const double a = omega_a * t / 2, b = omega_b / 2, c = omega_c * t / 2;
    return quat_mul(quat_mul((quat){cos(a), 0, 0, sin(a)}, (quat){cos(b), sin(b), 0, 0}), (quat){cos(c), 0, 0, sin(c)});
}

static inline qvec3 omega_at(double t)
{
    const double c = omega_c * t, s = sin(omega_b);
    return (qvec3){omega_a * s * sin(c), omega_a * s * cos(c), omega_a * cos(omega_b) + omega_c};
}

typedef struct omega_peer {
    const char *name; /* NULL ends the list */
    double setting;   /* steps, or tolerance */
    quat (*turn)(double setting);
} omega_peer;

/* Empty where the peer is not installed. */
extern const omega_peer omega_peers_gsl[], omega_peers_dop853[];

#endif
