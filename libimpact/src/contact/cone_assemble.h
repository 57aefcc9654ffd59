/* SPDX-License-Identifier: MIT
 *
 * cone_assemble: the cone problem's W = G M^-1 G^T and velocities of bodies that touch. Internal.
 */
#ifndef IMP_CONE_ASSEMBLE_H
#define IMP_CONE_ASSEMBLE_H

#include "contact/cone.h"
#include "world/world.h"

/* Where two bodies touch. */
typedef struct imp_cone_contact {
    int body1, body2;
    qvec3 axes[3];    /* normal, from body 2 to body 1, and two tangents; world, orthonormal */
    qvec3 arm1, arm2; /* from the bodies' centres of mass, m */
    qvec3 rub;        /* from there to where friction acts, m: 0 of a point, less far out of a corner of a face */
} imp_cone_contact;

/* Of one contact the three rows of G M^(-1/2), of both bodies: force along an axis to (linear, angular) per root of
 * mass and of moments, in body axes; zero of a static one. */
typedef struct imp_cone_row {
    double side[2][3][6];
} imp_cone_row;

/* The normal and two tangents that depend on it alone. */
void imp_cone_find_axes(qvec3 normal, qvec3 axes[3]);

void imp_cone_find_rows(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts, int count,
                        imp_cone_row *rows);

/* The rows of moments about the axes; they have no linear part. */
void imp_cone_find_turns(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts, int count,
                         imp_cone_row *turns);

/* rows (count) and w ((3 count)^2, symmetric to the bit), 1/kg. */
void imp_cone_assemble(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts, int count,
                       imp_cone_row *rows, double *w);

/* Of the normals alone: w is count^2. */
void imp_cone_assemble_normals(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                               int count, imp_cone_row *rows, double *w);

/* The same with moments: w is (6 count)^2. */
void imp_cone_assemble_turning(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                               int count, imp_cone_row *rows, imp_cone_row *turns, double *w);

/* Lets each of n unknowns yield, by a little of what its own force moves: of reactions that are not unique those that
 * loads make are the answer then (docs/model.md). w: n^2. */
void imp_cone_let_yield(double *w, int n);

/* What the bodies' velocities are at the contacts, along their axes, across the normal where friction acts: 3 count,
 * m/s. */
void imp_cone_contact_velocities(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                                 int count, double *u);

/* The same with how the bodies turn on each other, 1/s: 6 count. */
void imp_cone_contact_turning(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                              int count, double *u);

/* Gives the bodies the contacts' impulses, N s. */
void imp_cone_push(const imp_world *world, const imp_cone_contact *contacts, int count, const double *r,
                   imp_state *states);

/* The same with moments, N m s: r is 6 count. */
void imp_cone_push_turning(const imp_world *world, const imp_cone_contact *contacts, int count, const double *r,
                           imp_state *states);

#endif
