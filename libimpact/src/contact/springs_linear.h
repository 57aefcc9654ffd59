/* SPDX-License-Identifier: MIT
 *
 * Linear springs without friction, where speed is wanted: the equations of springs.h with normals alone,
 *
 *     delta' = -u,  u' = W F,  F = kappa (delta - base) or 0,      delta'' = -W F:   x_(k+2) = -(W F_k)/((k+1)(k+2))
 *
 * Modes (cosines of W K's eigenvalues) would have to be found anew at each of some six events a contact, at n^3 each.
 * Only what is closed has series, whose terms cost as many products as W has entries among the closed; two of them, an
 * even and an odd one, go through W at once. What is open is pushed by their integrals, and has a series of its own
 * only where those leave room for it to close.
 *
 * Of many contacts some event comes soon, and few terms reach it: as many are made as a look ahead asks for, then more
 * as long as nothing happens. Time is in units of how far that looks, so that terms are what they add there, and a
 * bound of any is a sum of them. They are cut where the last are rounding and what follows falls by half from term to
 * term: sum |x_(k+2)| <= S sum |x_k|/((k+1)(k+2)), S the largest of kappa_j sum_i |W_ij| among the closed.
 */
#ifndef IMP_SPRINGS_LINEAR_H
#define IMP_SPRINGS_LINEAR_H

#include "contact/springs.h"

/* Terms of depths: one more than velocities have. */
enum { IMP_LINEAR_TERMS = IMP_SPRINGS_TERMS, IMP_LINEAR_PAIRS = IMP_LINEAR_TERMS / 2 };

/* x_k and x_(k+1), k even; or an impulse and its integral. */
typedef double imp_term_pair __attribute__((vector_size(16)));

typedef struct imp_linear_spring {
    imp_spring_normal normal;
    double restitution, stiffness, own; /* own: W_nn */
    double x, base, kappa, deepest, tiny;
    double u0, u, p, stored;
    imp_finding *finding;
} imp_linear_spring;

/* W_ij kappa_j, twice; the place of j. */
typedef struct imp_linear_entry {
    imp_term_pair value;
    size_t place;
} imp_linear_entry;

typedef struct imp_linear_springs {
    int count;
    imp_linear_spring *line;
    int *start, *row; /* W by columns, which are its rows too, without zeros */
    double *value;
    /* What is closed: the contacts; of each contact its place among them, or -1; their part of W kappa by rows. */
    int closed_count, *closed, *place;
    imp_linear_entry *entry, **entry_end;
    double *kappa; /* of each contact */
    double growth; /* S */
    int pairs;     /* of terms that are made */
    double unit;   /* of the time of the terms */
    imp_term_pair factor[IMP_LINEAR_PAIRS + 1], once[IMP_LINEAR_PAIRS],
        twice[IMP_LINEAR_PAIRS];           /* of terms to sums over W; of integrals to 1; of theirs */
    imp_term_pair sizes[IMP_LINEAR_PAIRS]; /* of those terms, from the second pair on: sums of |.| */
    double rest[2];                        /* of any x and its rate what terms from the seventh on make, at most */
    imp_term_pair *term, *last; /* IMP_LINEAR_PAIRS rows of x's terms, of all that is closed each; the last */
    imp_term_pair *push;        /* of what is closed: F's integral to the step's end, and that one's */
    imp_term_pair *gain;        /* of each contact: W times that */
    double *drawn;              /* of each contact: how much deeper those draw it that do, at most */
    long events, steps;
} imp_linear_springs;

/* ---- springs_linear.c ---- */

/* x from which an unloading spring is loaded on. */
double imp_linear_again(const imp_linear_spring *line);
double imp_linear_energy(const imp_linear_spring *line, double x);

/* ---- springs_linear_step.c ---- */

/* What is closed now; false: nothing is. */
bool imp_linear_find_closed(imp_linear_springs *s);
/* To the next event, or as far as the series reach, and what happens there. False: not settled. */
bool imp_linear_step(imp_linear_springs *s);

#endif
