/* SPDX-License-Identifier: MIT
 *
 * search_window (internal): the search for contact over a window of two segments, two bodies at one time in it, and the
 * proof that nothing touches between two such times.
 */
#ifndef IMP_SEARCH_WINDOW_H
#define IMP_SEARCH_WINDOW_H

#include "gap/gap_solver.h"
#include "motion/search.h"

/* A stretch of two segments, of bodies but planes, and what holds all over it. */
typedef struct imp_window {
    const imp_search *of;
    double t0, t1;
    bool turns[2];    /* the body's turning shows */
    imp_spin spin[2]; /* of what turns */
    double longest;   /* s: the faster body turns by IMP_WINDOW_TURN */
    double jerk;      /* of both centres, m/s^3; 0: parabolas */
    imp_form form[2];
} imp_window;

/* One time and what is known of it. */
typedef struct imp_instant {
    double t, gap, rate, tolerance; /* gap: the bracket's lower end */
    imp_state state[2];
    impact_solid body[2];
    imp_form form[2]; /* in their own lengths */
    qvec3 arm[2];     /* from the centre of mass to the form's, world */
    qvec3 c, v;       /* of body 1's centre of mass relative to body 2's */
    qvec3 omega[2];   /* of what turns */
    impact_contact contact;
    bool sketched; /* the contact holds but the bodies' supports along a normal that parts them */
} imp_instant;

/* The window from t on, no longer than until the faster body has turned by IMP_WINDOW_TURN. */
void imp_window_open(const imp_search *search, double t, double end, imp_window *window);

void imp_instant_place(const imp_window *w, double t, imp_instant *at);
/* What follows from its contact, whose offsets are from the centres of mass, or from the shapes'. */
void imp_instant_take(const imp_window *w, imp_instant *at);
void imp_instant_note(const imp_window *w, imp_instant *at);
/* Takes the supports along the unit n for the contact; false when they do not part the bodies. */
bool imp_instant_sketch(const imp_window *w, qvec3 n, imp_instant *at);

/* Whether there is provably no contact between two instants without one. */
bool imp_search_link(const imp_window *w, const imp_instant *from, const imp_instant *to);

/* Before t there is no contact. */
typedef struct imp_reached {
    double t;
    bool touches; /* at t, and the bodies come nearer */
    bool cleared; /* t is the window's end */
    bool known;   /* the contact at t is, and the bodies do not touch */
    impact_contact contact;
} imp_reached;

/* From t, up to the end, or to where the faster body has turned by IMP_WINDOW_TURN, or as far as it comes. Bodies that
 * touch at t stay there. known: the contact at t; NULL: not known. No planes, and gaps by Newton. A function of the
 * segments, t and end alone. */
imp_reached imp_search_window(const imp_search *search, double t, double end, const impact_contact *known);

#endif
