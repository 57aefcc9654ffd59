/* SPDX-License-Identifier: MIT
 *
 * elliptic: Jacobi's functions sn, cn, dn, and the periodic part of an elliptic integral of the third kind, by theta
 * series. Internal.
 *
 * With K, K' the complete integrals and q = exp(-pi K'/K), the series go in powers of q; where q > 0.1, Jacobi's
 * imaginary transformation (DLMF 20.7.30-33) turns them into series in exp(-pi K/K') < 0.014. So a handful of terms
 * gives every digit for every modulus, m = 1 among them, where the functions are tanh and sech.
 */
#ifndef IMP_ELLIPTIC_H
#define IMP_ELLIPTIC_H

#include <impact/tumble.h>

/* m = k^2 in [0, 1] and m1 = 1 - m: both given, since either may be tiny. */
void imp_elliptic_make(double m, double m1, impact_elliptic *elliptic);

/* sn, cn, dn of u, |u| <= K. */
void imp_elliptic_at(const impact_elliptic *elliptic, double u, double *sn, double *cn, double *dn);

/* The u in [-K, K] of these sn, cn >= 0, dn. */
double imp_elliptic_inverse(double sn, double cn, double dn);

/* Carlson's R_F(x, y, z), arguments >= 0 (Carlson 1995, algorithm 1); infinite when two of them are 0. */
double imp_elliptic_rf(double x, double y, double z);

/* p(u) = arg theta_4(pi (u + i y)/(2 K), q^2), with 0 <= y <= K' and w = K' - y; either may be infinite at m = 0. */
void imp_elliptic_phase_make(const impact_elliptic *elliptic, double y, double w, impact_elliptic_phase *phase);

/* p(u), |u| <= K; odd, of period 2 K. */
double imp_elliptic_phase_at(const impact_elliptic *elliptic, const impact_elliptic_phase *phase, double u);

#endif
