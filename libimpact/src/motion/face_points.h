/* SPDX-License-Identifier: MIT
 *
 * face_points: how the friction of a few points is that of the face they bear. Internal.
 *
 * A face that slides with v at its middle and turns with w has at x the velocity u = v + w z x x, and, per unit of
 * mu N/area, evenly pressed, the friction
 *
 *     F = -int u/|u| dA = -(A v + w z x B)      M = -int x x u/|u| dA = -(B x v + w C)
 *     A = int 1/|u| dA      B = int x/|u| dA      C = int |x|^2/|u| dA
 *
 * So points that rub at y_i, with the strength s times their part n_i of the pressure, do to it what the face does if
 * their sums over s n_i/|u_i| are A, B and C. With y_i = k (x_i - m) + B/A, x_i where they bear, that is
 *
 *     m = sum x_i n_i/|u_i| over S      k^2 sum |x_i - m|^2 n_i/|u_i| = S (C/A - |B/A|^2)      s = A/S
 *
 * S = sum n_i/|u_i|: solved in turn with the |u_i|. Where the pressure is so uneven that a point would have to rub
 * where nothing slides, or farther out than it bears, there are none.
 */
#ifndef IMP_FACE_POINTS_H
#define IMP_FACE_POINTS_H

#include "contact/points.h"
#include "motion/face_friction.h"

typedef struct imp_face_points {
    int count;
    double bear[IMP_POINTS][2], part[IMP_POINTS]; /* x_i from the centre of pressure; n_i, of the sum 1 */
    double rub[IMP_POINTS][2];                    /* y_i from there */
    double k, strength;
} imp_face_points;

/* Where the points rub, and how strongly: of a face about the origin, no line, of the order of 1 in length; twist: v_x,
 * v_y there and w, not all 0. False: there are no such places. */
bool imp_points_as_face(const imp_flat_face *face, const double twist[3], imp_face_points *points);

#endif
