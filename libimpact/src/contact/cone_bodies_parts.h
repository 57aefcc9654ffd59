/* SPDX-License-Identifier: MIT
 *
 * cone_bodies_parts: what the rooms of cone_bodies.h share: the problem, and Newton's search for the bodies' motion.
 * Internal.
 */
#ifndef IMP_CONE_BODIES_PARTS_H
#define IMP_CONE_BODIES_PARTS_H

#include "contact/cone_bodies.h"

typedef struct imp_bodies_problem {
    int count, n, width;              /* contacts; 6 bodies; numbers a contact */
    const imp_cone_row *rows, *turns; /* turns: divided by the units that make forces of moments */
    const imp_cone_lengths *lengths;
    const int (*couples)[2];            /* each contact's bodies; -1: does not move */
    const double *q, *friction, *least; /* least: NULL, or what reactions along normals are at least */
    imp_skyline *sky;
    double *x, *trial, *gradient, *step; /* 6 bodies each */
    double *r, *u, *offset, *pressed;    /* width contacts; offset: q + s */
    double *y, *lean;                    /* width contacts: r - rho û, and the slope of û_n - u_n in u, of x */
    double *own_q;                       /* with moments: q in their units */
    double *rolling;                     /* contacts, with moments: the slope of rolling's cone in them */
    double *stiffness, *mobility;        /* contacts */
    bool follows;                        /* s is that of x */
    imp_cone_outcome *outcome;
} imp_bodies_problem;

static inline double imp_bodies_products(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* P_C of three numbers, C being the part of K whose normal is at least that, and, unless slope is NULL, its derivative.
 */
void imp_bodies_project(double friction, double least, const double *v, double *to, double slope[3][3]);

/* G x at the contact, of its three rows of forces, or of moments. */
void imp_bodies_seen_by(const imp_bodies_problem *p, const imp_cone_row *row, int c, const double *x, double v[3]);

/* s = û_n - u_n of the contact's velocities u, and its slope in them (0 where there is none). */
double imp_bodies_slip(const imp_bodies_problem *p, int c, const double *u, double slope[6]);

/* x and u of the reactions r. */
void imp_bodies_effect(const imp_bodies_problem *p, const double *r);

/* A contact's stiffness as so many times the mass that it sees. */
void imp_bodies_stiffen(const imp_bodies_problem *p, double stiffness);

/* Newton's steps for x until the gradient is `enough` of its terms, or rounding. How many; -1: none led on. */
int imp_bodies_settle(const imp_bodies_problem *p, double enough);

/* What is struck anew is far from where the last step left it: contact by contact, there and back, r comes near. */
void imp_bodies_sweep(const imp_bodies_problem *p, int sweeps);

#endif
