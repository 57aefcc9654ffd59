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
 * as long as nothing happens. They are cut where the last are rounding and what follows falls by half from term to
 * term, as forces do: |F_(k+2)| <= S |F_k|/((k+1)(k+2)) in the largest, S the largest of kappa_j sum_i |W_ij|.
 */
#ifndef IMP_SPRINGS_LINEAR_H
#define IMP_SPRINGS_LINEAR_H

#include "contact/springs.h"

/* Terms of depths: one more than velocities have. */
enum { IMP_LINEAR_TERMS = IMP_SPRINGS_TERMS, IMP_LINEAR_PAIRS = IMP_LINEAR_TERMS / 2 };

/* x_k and x_(k+1), k even; or an impulse and its integral. */
typedef struct imp_term_pair {
    double even, odd;
} imp_term_pair;

typedef struct imp_linear_spring {
    imp_spring_normal normal;
    double restitution, stiffness, own; /* own: W_nn */
    double column;                      /* sum |W_in| */
    double x, base, kappa, deepest, tiny;
    double u0, u, p, stored;
    imp_finding *finding;
} imp_linear_spring;

typedef struct imp_linear_springs {
    int count;
    imp_linear_spring *line;
    int *start, *row; /* W by columns, which are its rows too, without zeros */
    double *value;
    /* What is closed: the contacts; of each contact its place among them, or -1; their part of W. */
    int closed_count, *closed, *place, *closed_start, *closed_row;
    double *closed_value;
    int pairs; /* of terms that are made */
    imp_term_pair factor[IMP_LINEAR_PAIRS + 1], once[IMP_LINEAR_PAIRS],
        twice[IMP_LINEAR_PAIRS];              /* of terms to sums over W; of integrals; of theirs */
    imp_term_pair greatest[IMP_LINEAR_PAIRS]; /* |.| of those terms, from the second pair on, the largest */
    double rest[4];                           /* of any x and its rates what terms from the fifth on make, at most */
    double rest_open, hardest;                /* of what is open, for each unit of sum |W|; the largest kappa */
    double *kappa;                            /* of what is closed */
    imp_term_pair *depth;                     /* IMP_LINEAR_PAIRS rows of x's terms, of all that is closed each */
    imp_term_pair *force;                     /* the last two of those rows times kappa */
    imp_term_pair *push;                      /* of what is closed: F's integral to the step's end, and that one's */
    imp_term_pair *gain;                      /* of each contact: W times that */
    imp_terms power;                          /* h^k of the step */
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
