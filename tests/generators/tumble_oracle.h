/* SPDX-License-Identifier: MIT
 *
 * Torque-free rotation and elliptic functions in 128-bit arithmetic, by other ways than the library's: Taylor series of
 * Euler's equations and of the quaternion's; the textbook's period, 4 K/omega_p from energy and momentum; sn, cn, dn by
 * the descending Landen transformation; theta functions by their defining series. gcc with libquadmath.
 */
#ifndef TUMBLE_ORACLE_H
#define TUMBLE_ORACLE_H

#include <quat/quat.h>

/* The orientation after t, its sign continuous but for whole periods, which are not integrated: each turns the body
 * by the same angle about the momentum as the first does. */
quat oracle_tumble(qvec3 moments, quat orientation, qvec3 momentum, double t);

/* How far rounded data carry: the sum over the moments and the momentum's body components of the changes that one
 * rounding (2^-53) of each makes in the orientation after t. */
double oracle_tumble_sensitivity(qvec3 moments, quat orientation, qvec3 momentum, double t);

/* From the angular velocity in the body's axes: orientation and angular velocity (body axes) after t. */
void oracle_tumble_omega(qvec3 moments, quat orientation, qvec3 omega, double t, quat *q, qvec3 *omega_t);

/* How much larger than themselves relative changes of the moments and of omega's components come out: the sums of the
 * changes of the orientation, rad, and of omega_t, relative to its size. */
void oracle_tumble_omega_sensitivity(qvec3 moments, quat orientation, qvec3 omega, double t, double *of_q,
                                     double *of_omega);

/* 4 K/omega_p. */
double oracle_tumble_period(qvec3 moments, quat orientation, qvec3 momentum);

/* K for m1 = 1 - m. */
double oracle_elliptic_k(double m1);

/* sn, cn, dn of u. */
void oracle_elliptic(double m1, double u, double *sn, double *cn, double *dn);

/* arg theta_4(pi (u + i f K')/(2 K), q^2), 0 <= f <= 1. */
double oracle_elliptic_phase(double m1, double u, double f);

#endif
