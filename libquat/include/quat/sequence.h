/* SPDX-License-Identifier: MIT
 *
 * sequence: sequences of rotations as curves in S^3, where the sign tells what the rotation does not: Dirac's belt, the
 * band of Moebius, the ball under a hand. Conventions in quat.h; angles in radians, lengths in the ball's or belt's.
 */
#ifndef QUAT_SEQUENCE_H
#define QUAT_SEQUENCE_H

#include "integrate.h"
#include "rotation.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the belt: along y, its width along x; t = 0 ... 1 from the held end to the free one ---- */

/* A belt twisted by `angle` over its length (thesis, equation 14): (cos angle t/2, 0, sin angle t/2, 0). The curve of a
 * twist of 2 pi leads from 1 to -1, that of 4 pi from 1 to 1. NaN for infinite and NaN. */
QUAT_API quat quat_belt_twist(double angle, double t);

/* Undoing a twist of 4 pi without turning the ends: exp(pi t j) exp(pi t (cos pi s j + sin pi s i)). s = 0 is the
 * twist, s = 1 the constant 1; the ends t = 0 and t = 1 are 1 for every s, exactly. Any s and t; NaN for infinite and
 * NaN. There is no such family for 2 pi, whose ends are 1 and -1. */
QUAT_API quat quat_belt_untwist(double s, double t);
/* Where the centre line of that belt runs: the integral of q y q* from 0 to t, for a belt of length 1 that is nowhere
 * stretched or sheared. Its free end, (sin(pi s) (1 - cos(pi s))/2, cos(pi s)^2, 0), goes round a loop from (0, 1, 0)
 * and back without ever turning. Any s and t; NaN for infinite and NaN. */
QUAT_API qvec3 quat_belt_centre(double s, double t);
/* Frames and places at n evenly spaced t from 0 to 1 (n = 1: t = 0); either array may be NULL. */
QUAT_API void quat_belt_frames(double s, size_t n, quat q[], qvec3 centre[]);

/* ---- spinor discs ---- */

/* A twist by `angle` as arrows on a disc of radius pi (thesis, figures 7 to 9): one arrow for each turn by pi and one
 * for what is left, each no longer than pi; after 2 pi they point back. arrows[] gets the signed lengths of the first
 * `most` of them (may be NULL for most = 0); returns how many there are: 0 for angle 0, 2 for 2 pi, 4 for 4 pi. Their
 * sum is quat_spinor_place(angle). 0 for infinite and NaN. */
QUAT_API size_t quat_spinor_arrows(double angle, size_t most, double arrows[]);
/* Where the arrows end: with the sign of `angle`, twice the distance on S^3 from 1 to the twist's quaternion: 0 at 0
 * and at 4 pi, on the disc's rim at pi and 3 pi, farthest at 2 pi. NaN for infinite and NaN. */
QUAT_API double quat_spinor_place(double angle);

/* ---- bands ---- */

/* The frame along a band bent into a circle in the plane z = 0 and twisted by `twist` on the way round: x across the
 * band (outward at u = 0), y along it, z its normal; u = 1 is once round. exp(pi u k) exp(twist u j/2): for twist = pi,
 * Moebius' band, one round turns the normal over, two bring it back with q = -1, and only four bring back q. */
QUAT_API quat quat_band(double twist, double u);
/* The sign with which a curve given by n points comes back to its first one: what quat_unflip reports, without
 * changing the curve. Neighbours may have either sign, but must be so close that the curve goes by less than a right
 * angle on S^3 (half a turn) from one to the next. 1 for n < 2. */
QUAT_API int quat_loop_sign(size_t n, const quat q[]);

/* ---- a unit ball rolled under a flat hand; the hand's way counts from the ball's centre ---- */

/* Unit q after a straight stroke (dx, dy) of the hand: turned by |d| about z x d, in world axes. */
QUAT_API quat quat_roll(quat q, double dx, double dy);
/* The orientations along the hand's places, joined by straight strokes: out[0] = start (unit), n of them. */
QUAT_API void quat_roll_path(quat start, size_t n, const qvec2 hand[], quat out[]);
/* From 1, when the hand has gone round a circle of this radius by `angle` (positive: counter-clockwise seen from
 * above), from (radius, 0) on: exp(k angle/2) exp(-(k + radius i) angle/2), exact where strokes are a polygon. */
QUAT_API quat quat_roll_circle(double radius, double angle);
/* What one round counter-clockwise has turned the ball by, as a rotation vector: 2 pi (sqrt(1 + radius^2) - 1) about
 * (-radius, 0, -1): clockwise, though the ball was never turned about z. To 8 rounding units at every radius. */
QUAT_API qvec3 quat_roll_loop(double radius);

/* ---- chains ---- */

/* Rotation vectors turns[0], turns[1] ... one after the other from `start`, each in `parts` equal steps: a curve in
 * S^3 of legs parts + 1 points, continuous whatever the angles (turns longer than 2 pi go round). With QUAT_WORLD each
 * turn is about world axes, with QUAT_BODY about the body's own. QUAT_EARGUMENT for parts = 0 and an unknown frame;
 * QUAT_EDOMAIN for a start that cannot be normalised and for infinite or NaN turns; every out[] is 1 then (out[0]
 * alone for parts = 0). */
QUAT_API quat_status quat_chain(quat start, size_t legs, const qvec3 turns[], quat_frame frame, size_t parts,
                                quat out[]);

#ifdef __cplusplus
}
#endif

#endif
