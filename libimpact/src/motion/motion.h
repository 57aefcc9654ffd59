/* SPDX-License-Identifier: MIT
 *
 * motion: the motion of an island (of a world of few bodies) that has no closed form: the integrator, step by step,
 * each step a segment (dense.h); and the loads and reactions at one instant. Internal.
 */
#ifndef IMP_MOTION_H
#define IMP_MOTION_H

#include "base/ode_in.h"
#include "contact/held.h"
#include "motion/dense.h"

typedef enum imp_end_kind {
    IMP_END_TIME,    /* nothing: the motion goes on */
    IMP_END_GAP,     /* an open pair's gap fell to zero: no integrator says so, but a search (search.h) */
    IMP_END_BOUNDS,  /* a held contact left its plane's bounds, or its face's border; of a corner: or another landed */
    IMP_END_LIFTOFF, /* a held contact's pressure fell to zero */
    IMP_END_SLIP,    /* a rolling contact's friction reached its cone */
    IMP_END_STICK,   /* a sliding contact's slip died out */
    IMP_END_EDGE,    /* a body crossed the edge of a field's reach */
    IMP_END_SLOW,    /* a body that rolls or rests became slower than the rest speed, or one at rest faster */
    IMP_END_RENEWAL  /* many steps of a held contact: it is to be put back exactly */
} imp_end_kind;

typedef struct imp_end {
    imp_end_kind kind;
    int index; /* pair, edge or body */
} imp_end;

/* Work since the start of the run, J. */
typedef struct imp_works {
    double force, damping, sliding, drive;
} imp_works;

/* Where the integrator stands in its stretch: one run of it, between two starts. */
typedef struct imp_stride {
    double t, tau;      /* now; tau is its variable */
    double from, t_end; /* where the stretch began, and will end at the latest */
    double began;       /* where the motion began that the steps are counted of */
    long steps;
    int still;    /* steps in a row that did not advance */
    bool passed;  /* the last step ended at a root that is no event */
    bool stood;   /* it was shorter, by its own variable, than t's rounding */
    bool restart; /* the next step begins a new stretch */
} imp_stride;

typedef struct imp_motion {
    imp_world *world;
    impact_motion_method method;
    double tolerance, step, rest_speed;
    bool *resting; /* per body: no longer watched for rest */
    imp_held held;
    imp_load *loads;
    imp_works works;
    char message[256];

    int room;        /* of the arrays over bodies */
    imp_dense dense; /* the last step */
    imp_stride stride;
    impact_ode_counts counted; /* in the world's usage already */
    long last_rates;           /* right-hand sides asked for by the last step */

    /* the integrator's side; absent until it is needed */
    impact_ode *ode; /* the one at work: motion_method.c */
    impact_ode *adams, *bdf, *rk4, *lobatto, *dop853;
    int size, roots;
    double *y, *kept; /* the integrated state, and a copy while samples are interpolated; */
    imp_held_contact *kept_contacts;
    imp_pair *kept_pairs;
    int kept_room[2];
    int *found;
    imp_state *scratch, *sampled;
    bool sliding;             /* slip slows the clock: see motion_equations.c */
    bool following;           /* contacts that move fast over flat places do */
    bool stiff;               /* some slip has just begun */
    bool bounces;             /* the motion begins with an open pair that touches */
    double slip_scale;        /* m/s */
    double point_speed_scale; /* 1/s */

    /* what is seen of its own work: motion_guard.h */
    double *probe;                     /* 4 size: of a step that is looked into */
    double relative, *absolute;        /* tolerances of the stretch */
    bool distrusted;                   /* a loss fell: the next stretch is for the other method */
    bool retried;                      /* that was done not long ago: */
    long steady_steps;                 /* steps since a loss fell */
    double last_fall, fallen, fell_at; /* J: by how much losses have fallen in steps that were kept; s: when first */
    long pace_steps;                   /* steps since time was looked at last, and when that was, s: */
    double pace_began;
} imp_motion;

/* Room for so many bodies in all that is kept of each. */
bool imp_motion_reserve(imp_motion *motion, imp_arena *arena, int bodies);
/* Nothing has happened yet in this world. */
void imp_motion_reset(imp_motion *motion, imp_world *world, const impact_methods *methods, double rest_speed);
/* Room for the integrated state of the world as it is; integrators of another size are of no use. */
impact_status imp_motion_make_room(imp_motion *motion);
/* Frees the integrators and what belongs to them; and all. */
void imp_motion_forget(imp_motion *motion);
void imp_motion_close(imp_motion *motion);

/* A force's edge that was crossed in the same instant as the event that ended the last stretch and is not handled yet:
 * the restarted integrator would never see it. False when there is none. */
bool imp_motion_also_crossed(imp_motion *motion, imp_end *end);

/* The motion begins anew at t (consistent modes: see imp_held_resolve), and is followed to t_end at most: that alone
 * of what is asked bears on how the integrator steps. renewed: only put back exactly, the count of its steps goes on.
 */
void imp_motion_depart(imp_motion *motion, double t, double t_end, bool renewed);
/* The next step: its polynomial in motion->dense, the states at its end, and what ends it. */
impact_status imp_motion_next(imp_motion *motion, imp_state *states, imp_end *end);
/* States and works at t, in the last step; the motion has to depart anew from there. */
void imp_motion_go_to(imp_motion *motion, double t, imp_state *states);
/* Places and velocities at t are put back to what the held contacts allow, which the integrator's error has left.
 * IMPACT_EDOMAIN: a load was refused; IMPACT_ENOMEM. */
impact_status imp_motion_put_back(imp_motion *motion, double t, imp_state *states);
/* Works at t, in the last step. */
imp_works imp_motion_works(const imp_motion *motion, double t);
/* The states at t, in the last step, with the held contacts put back exactly; nothing else changes. */
impact_status imp_motion_look(imp_motion *motion, double t, imp_state *states);

/* What is held at t, where the states are, with the reactions that hold then: contacts has room for held.count.
 * moves: t lies in the last step. Nothing else changes. */
impact_status imp_motion_contacts(imp_motion *motion, double t, bool moves, const imp_state *states,
                                  imp_held_contact *contacts);

/* Loads on every body; false, with a message, when a custom force refuses or gives a NaN. */
bool imp_motion_load(imp_motion *motion, double t, const imp_state *states);

#endif
