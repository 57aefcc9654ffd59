/* SPDX-License-Identifier: MIT
 *
 * cone: Coulomb's law at many contacts at once, for impulses or for accelerations. Internal.
 *
 * Per contact c with normal n and friction mu, the velocities (or their rates) of its points being u = W r + q:
 *
 *     K   = {r : |r_t| <= mu r_n}        K* = {v : mu |v_t| <= v_n}
 *     û   = u + mu |u_t| n               K* contains û,  û . r = 0,  K contains r        (De Saxcé & Feng 1998)
 *
 * that is u_n >= 0, friction within its cone, and against the slip with all its force where there is any. A contact
 * without friction keeps its normal part alone; its friction is zero, its slip whatever W and q make of it.
 *
 * Contacts that also resist turning, by lengths tau (torsional) and rho (rolling), m: r = (r_n, r_t, m_n, m_t) with
 * moments about the normal and the tangents, u = (u_n, u_t, w_n, w_t) with how the bodies turn on each other:
 *
 *     K  = {r : |(r_t/mu, m_n/tau)| <= r_n,  |m_t| <= rho r_n}        (Goyal, Ruina & Papadopoulos 1991)
 *     K* = {v : |(mu v_t, tau w_n)| + rho |w_t| <= v_n}
 *     û  = u + (|(mu u_t, tau w_n)| + rho |w_t|) n                    (Acary & Bourrier 2021)
 *
 * A part whose mu, tau or rho is zero is left out: its force or moment is zero.
 */
#ifndef IMP_CONE_H
#define IMP_CONE_H

#include "base/arena.h"

/* Of one contact, m, >= 0. */
typedef struct imp_cone_lengths {
    double torsional, rolling; /* tau, rho */
} imp_cone_lengths;

/* Three numbers a contact: along its normal, then along two tangents; with lengths six, the moments about the same
 * axes after them. Units are the caller's, kept by W. What is said to have "width count" numbers has so many. */
/* Where no path leads to an answer. */
typedef enum imp_cone_effort {
    IMP_CONE_SWEEPS, /* the path on which friction sets in, then the long sweeps of cone_sweep.c */
    IMP_CONE_BRIEF,  /* none: the caller has another way, as a shorter step */
    IMP_CONE_WANDERS /* sweeps, then Newton from thousands of starts, up to seconds: nothing else is at hand */
} imp_cone_effort;

typedef struct imp_cone_problem {
    int count;                       /* contacts, >= 0 */
    const double *w;                 /* (width count)^2 by rows: symmetric, no eigenvalue under zero, of any rank */
    const double *q;                 /* width count: u without reactions */
    const double *friction;          /* count, >= 0 */
    const imp_cone_lengths *lengths; /* count; NULL: no contact resists turning */
    const double *last_r;            /* width count each: an answer of like modes to begin with; NULL: none */
    const double *last_u;
    bool near_last; /* of several answers the one by last_r: not r = 0, nor where paths lead; else UNSETTLED */
    imp_cone_effort effort;
    double work;   /* multiplications of its factorings after which paths end; 0: IMP_CONE_WORK */
    double enough; /* the residual that does; 0: as small as can be (cone_bodies.h: IMP_BODIES_ACCEPTED) */
} imp_cone_problem;

enum { IMP_CONE_WIDEST = 6 };

static inline int imp_cone_width(const imp_cone_problem *problem) { return problem->lengths ? IMP_CONE_WIDEST : 3; }

typedef enum imp_cone_status {
    IMP_CONE_SOLVED,
    IMP_CONE_INEXACT,     /* an answer is there, with a residual over the bound: told, not to be trusted silently */
    IMP_CONE_UNSETTLED,   /* no answer was found; none is excluded */
    IMP_CONE_NO_SOLUTION, /* none exists: `r` holds a direction that shows it, see imp_cone_outcome */
    IMP_CONE_BAD,         /* W, q or a friction is no number, or a friction is negative, or the room is too small */
    IMP_CONE_NO_ROOM      /* memory was wanted and refused (cone_bodies.h) */
} imp_cone_status;

/* Of the points that touch: with friction about the normal they stick while that and the points' is within its bound.
 */
typedef enum imp_cone_mode { IMP_CONE_OPEN, IMP_CONE_STICKS, IMP_CONE_SLIDES } imp_cone_mode;

typedef enum imp_cone_stage {
    IMP_CONE_LAST,   /* the modes of last time */
    IMP_CONE_PATH,   /* the central path */
    IMP_CONE_ARC,    /* the central path by arc length, round folds */
    IMP_CONE_EASED,  /* by way of W + alpha 1, alpha to 0 */
    IMP_CONE_SWEPT,  /* contact by contact */
    IMP_CONE_KINDLED /* the path on which friction sets in */
} imp_cone_stage;

/* The proof: with R = max |r_c|, Q = max |q_c| over the contacts and s = R/Q, the largest over the contacts of
 * |r - P_K(r - s û)|/R, which is zero of solutions alone, from W, q and r as given, sums taken in twice the precision.
 * Moments count as forces: over tau/mu (tau where mu = 0) and rho, turning times the same (imp_cone_units).
 * NO_SOLUTION: r is a direction d >= 0 along normals, W d = 0 to rounding and d . q < 0, so that d . u = d . q < 0
 * whatever the reactions, while u_n >= 0 wants d . u >= 0: reactions under `least_reactions` cannot solve it. */
typedef struct imp_cone_outcome {
    imp_cone_status status;
    imp_cone_stage stage;
    double residual;        /* the proof's, 1 */
    double least_reactions; /* NO_SOLUTION: -d . q/max |W d|, |d|_1 = 1: infinite where W d vanishes */
    int factorings, steps;  /* linear systems taken apart; Newton's steps */
    bool chosen;            /* the linear system at the answer has no full rank: reactions are not unique */
} imp_cone_outcome;

/* All that the solver needs, from an arena: nothing is allocated while it solves. */
typedef struct imp_cone_workspace {
    imp_arena *arena;
    int capacity, unknowns; /* contacts and their unknowns that there is room for */
    double *block;
    struct imp_cone_key *keys;
    int *indices;
} imp_cone_workspace;

/* Room for so many contacts, of the workspace's arena; false where that has no more. What was there is lost. */
bool imp_cone_reserve(imp_cone_workspace *workspace, int contacts);
bool imp_cone_reserve_turning(imp_cone_workspace *workspace, int contacts); /* of contacts with lengths */
void imp_cone_release(imp_cone_workspace *workspace);                       /* gives it back to the arena */

/* Solves the problem: r (reactions, on the side of u) and u, width count each, and the mode of each contact (count;
 * NULL if not wanted). The answer's bits depend neither on the contacts' order nor on anything but the problem. */
imp_cone_outcome imp_cone_solve(const imp_cone_problem *problem, imp_cone_workspace *workspace, double *r, double *u,
                                imp_cone_mode *modes);

/* The residual of any r, as in the outcome; u: of r, width count, written. */
double imp_cone_residual(const imp_cone_problem *problem, const double *r, double *u);

/* What the rounding of r alone may leave of the residual: a part of Q. */
double imp_cone_rounding(const imp_cone_problem *problem, const double *r);

/* P_K v, the nearest point of |r_t| <= mu r_n (mu = 0: of the half line along the normal), and, unless slope is NULL,
 * its derivative. */
void imp_cone_project(double friction, const double *v, double *to, double slope[3][3]);

/* What makes forces of a contact's moments, m: (1, 1, 1, mu/tau, 1/rho, 1/rho) of a contact with both, so that K is
 * |(r_t, s)| <= mu r_n and |b| <= r_n: two round cones that share r_n. Turning is divided by it. Without friction of
 * the points 1/tau, and |s| <= r_n; of a part that is left out 0. */
void imp_cone_units(double friction, imp_cone_lengths lengths, double units[6]);

/* P_K v of that K, six numbers in those units, and, unless slope is NULL, its derivative. rolling: 1; or, where the
 * units of b are so many times as large, |b| <= rolling r_n. */
void imp_cone_project_turning(double friction, imp_cone_lengths lengths, double rolling, const double *v, double *to,
                              double slope[6][6]);

/* û_n - u_n, u in the caller's units, width 3 (lengths NULL) or 6. */
double imp_cone_slip(double friction, const imp_cone_lengths *lengths, const double *u);

const char *imp_cone_status_name(imp_cone_status status);

#endif
