/* SPDX-License-Identifier: MIT
 *
 * face_friction: the friction of a flat face that slides and turns on another under a pressure that is linear over it.
 * Internal.
 *
 * The face's plane has the velocity u = v + w z x x at the place x, and the pressure p = a + b.x. With the centre of
 * turning o, u(o) = 0, r = x - o, and a_o = a + b.o, Coulomb's friction per unit of its coefficient is
 *
 *     F = -sgn w  z x int p r/|r| dA        = -sgn w  z x closed int (r/|r|) (a_o/2 + b.r/3) r x dr
 *     M_o = -sgn w   int p |r| dA           = -sgn w      closed int |r| (a_o/3 + b.r/4) r x dr
 *
 * along the border, by the integral along each ray from o. On a side at the distance h from o, of normal n and
 * direction t, r = h n + s t and r x dr = h ds: there are but s^k/|r| and s^k |r| to be integrated, in closed form by
 * asinh and roots. On an arc Gauss's places stand, in panels that grow with their distance from the place nearest to o:
 * all that is singular is there. The sum over the border cancels as u (|o|/L)^3: from o far away, or with w = 0, the
 * plane integral itself is smooth, and Gauss's places over the area give it to rounding.
 *
 * A line along x at y = 0 has, per length, with u = w (d, s), d = v_x/w, s = x + v_y/w, rho = root(d^2 + s^2),
 *
 *     F = -sgn w int p (d, s)/rho dx        M = -sgn w int p x s/rho dx
 *
 * of s^k/rho alone, k = 0 ... 3; from o far away by Gauss's places.
 *
 * F and M are linear in (a, b): what is returned is their matrix. Lengths are of the order of 1.
 */
#ifndef IMP_FACE_FRICTION_H
#define IMP_FACE_FRICTION_H

#include <stdbool.h>

enum { IMP_FLAT_LINE = 2, IMP_FLAT_SIDES = 64 };

/* A convex polygon, counter-clockwise, a disc, or a line along x at y = 0, its ends from low to high. */
typedef struct imp_flat_face {
    int count; /* of corners; 0: a disc, IMP_FLAT_LINE: a line */
    double corner[IMP_FLAT_SIDES][2];
    double center[2], radius; /* the disc's */
} imp_flat_face;

/* A side, or an arc about the disc's centre from one angle to a greater. */
typedef struct imp_border {
    bool arc;
    double from[2], to[2];
    double begin, end;
} imp_border;

/* A convex part of a face. */
typedef struct imp_pressed {
    int count;
    bool line; /* its one side is all of it */
    imp_border border[IMP_FLAT_SIDES + 1];
    double center[2], radius; /* of its arcs */
    double middle[2], reach;  /* a place in the face, and how far its border is from there at most */
} imp_pressed;

/* The whole face; or what of it has the pressure a + b.x >= 0, p = (a, b_x, b_y): nothing, with count 0, where none is.
 */
void imp_press_all(const imp_flat_face *face, imp_pressed *pressed);
void imp_press_part(const imp_flat_face *face, const double p[3], imp_pressed *pressed);
/* The least pressure of the whole face. */
double imp_least_pressure(const imp_flat_face *face, const double p[3]);
/* How far the place is within a polygon's side, from its corner i to the next; and within the face's whole border; < 0
 * outside. */
double imp_side_spare(const imp_flat_face *face, int i, const double x[2]);
double imp_face_spare(const imp_flat_face *face, const double x[2]);

/* m[i][j]: the integral of f_i f_j, f = (1, x, y): the force and the moments x p of each of the three pressures; 0 for
 * y of a line. */
void imp_press_moments(const imp_pressed *pressed, double m[3][3]);

/* rub[i][j] of the pressure f_j: F_x, F_y and the moment about the origin, per unit of the friction coefficient; twist:
 * v_x, v_y at the origin and w, not all 0. */
void imp_press_rub(const imp_pressed *pressed, const double twist[3], double rub[3][3]);
/* The integral of 1/|u|, which is infinite only of a line that turns about a place in it: of no line. */
double imp_press_inverse_speed(const imp_pressed *pressed, const double twist[3]);

#endif
