/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the closed hodograph, by which a slip can be told right without following it.
 */
#ifndef IMP_COLLIDE_HODOGRAPH_H
#define IMP_COLLIDE_HODOGRAPH_H

#include <stdbool.h>

/* The inverse mass M that a contact feels, in any frame whose third axis is the normal; rounding: the size of the terms
 * of its entries. */
typedef struct imp_felt_mass {
    double m[3][3], rounding, friction;
} imp_felt_mass;

/* A tangential velocity, and the size of its terms. */
typedef struct imp_slip {
    double x, y, size;
} imp_slip;

/* How far the slip from one to the other misses the hodograph, over what rounding of M and of both leaves of it, in
 * eps. False: not known, since it goes straight, or two directions that do not turn are too near to each other. */
bool imp_hodograph_residual(const imp_felt_mass *mass, imp_slip from, imp_slip to, double *residual);

#endif
