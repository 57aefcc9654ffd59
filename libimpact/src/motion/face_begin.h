/* SPDX-License-Identifier: MIT
 *
 * face_begin: whether a face that stands on another goes on standing under a load, and how else it begins to move.
 * Internal.
 *
 * Friction |tau(x)| <= mu p(x) all over the face has the resultants f = (F, M) with
 *
 *     f.d <= D(d) = int mu p |v + w z x x| dA     for every twist d = (v, w)
 *
 * a convex set, its limit surface (Goyal, Ruina & Papadopoulos 1991). At rest f = -L, L = (m pull, n.T), and p is the
 * linear pressure of that balance: its centre is at (c pull - n x T/m)/P. So it stands iff L.d <= D(d) for every d:
 *
 *     stands  iff  D >= 1 on the plane L.d = 1    D is convex: Newton's iteration for its least value, two unknowns
 *
 * (least value s: the load may grow s times). Else it begins to move with the acceleration a along which friction is
 * that of a face that moves (face_motion.h) in the limit of no speed; under a pressure that were given it would be
 *
 *     M a = L + f(a/|a|),   f(d) = -D'(d)    iff    a.M a/2 + D(a) - L.a is least   (Moreau: greatest dissipation)
 *
 * and is unique. The pressure follows friction, by the height c of the centre: three equations in a, Newton's
 * iteration. As a tends to 0 p tends to that at rest: it goes exactly where it does not stand.
 */
#ifndef IMP_FACE_BEGIN_H
#define IMP_FACE_BEGIN_H

#include "motion/face_motion.h"

typedef enum imp_face_begin {
    IMP_FACE_STANDS, /* the balance is that of rest */
    IMP_FACE_GOES,   /* and the acceleration's */
    IMP_FACE_NEITHER /* no pressure balances either: the body tips */
} imp_face_begin;

/* At rest with the load of y, whose velocities are not looked at. acceleration: of (v, w), in axes that stay; 0 where
 * it stands. */
imp_face_begin imp_face_begins(const imp_face_motion *motion, const double *y, double acceleration[3],
                               imp_face_balance *balance);
#endif
