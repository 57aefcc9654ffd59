/* SPDX-License-Identifier: MIT
 *
 * motion: from one event of the world to the next, in closed form where flight has one, by the integrator elsewhere.
 * Internal.
 */
#ifndef IMPACT_MOTION_H
#define IMPACT_MOTION_H

#include <impact/ode.h>
#include "persist.h"

typedef enum impact_end_kind {
    IMPACT_END_TIME,    /* the time asked for */
    IMPACT_END_GAP,     /* an open pair's gap fell to zero */
    IMPACT_END_RETURN,  /* a body that had passed beside a plane's bounds is before the plane again */
    IMPACT_END_BOUNDS,  /* a held contact left its plane's bounds */
    IMPACT_END_LIFTOFF, /* a held contact's pressure fell to zero */
    IMPACT_END_SLIP,    /* a rolling contact's friction reached its cone */
    IMPACT_END_STICK,   /* a sliding contact's slip died out */
    IMPACT_END_EDGE,    /* a body crossed the edge of a field's reach */
    IMPACT_END_SLOW,    /* a body that rolls or rests became slower than the rest speed */
    IMPACT_END_RENEWAL  /* many steps of a held contact: it is to be put back exactly */
} impact_end_kind;

typedef struct impact_end {
    impact_end_kind kind;
    int index; /* pair, edge or body */
} impact_end;

/* Where samples go on the way: emit is called at every k/rate up to where the motion ends. */
typedef struct impact_sampler {
    double rate; /* 0: never */
    long next;   /* k of the next sample */
    bool (*emit)(void *context, double t, const impact_state *states);
    bool (*pulse)(void *context, double t); /* called at every step of the integrator; false stops */
    void *context;
} impact_sampler;

/* Work since the start of the run, J. */
typedef struct impact_works {
    double force, damping, sliding, drive;
} impact_works;

typedef struct impact_motion {
    impact_world *world;
    double tolerance, rest_speed;
    bool *resting; /* per body: no longer watched for rest */
    impact_persist persist;
    impact_load *loads;
    impact_works works;
    char message[256];

    struct impact_flyer *flyers; /* bodies in closed form; absent until they are */

    /* the integrator's side; absent until it is needed */
    impact_ode *ode; /* the one at work: adams or bdf */
    impact_ode *adams,
        *bdf; /* for smooth motion; for what is stiff: slow slip after an onset, forces that brake hard */
    int size, roots;
    double *y, *kept; /* the integrated state, and a copy while samples are interpolated */
    int *found;
    impact_state *scratch, *sampled;
    bool sliding;      /* slip slows the clock: see motion_equations.c */
    bool creeping;     /* contacts that move fast over flat places do */
    bool stiff;        /* some slip has just begun */
    long steps_before; /* of the stretch at hand, before its contacts were put back; and when it began, s: */
    double began;
    double slip_scale;  /* m/s */
    double creep_scale; /* 1/s */
} impact_motion;

impact_status impact_motion_open(impact_motion *motion, impact_world *world, double tolerance, double rest_speed);
void impact_motion_close(impact_motion *motion);

/* A force's edge that was crossed in the same instant as the event that ended the last stretch and is not handled yet:
 * the restarted integrator would never see it. False when there is none. */
bool impact_motion_also_crossed(impact_motion *motion, impact_end *end);

/* motion_advance.c, by one of two roads below. */
/* Advances the states (consistent modes: see impact_persist_resolve) from *t to the next event, at most to t_end. */
impact_status impact_motion_advance(impact_motion *motion, double *t, double t_end, impact_state *states,
                                    impact_sampler *sampler, impact_end *end);
/* In closed form: motion_flight.c; by the integrator: motion_stretch.c. */
impact_status impact_motion_fly(impact_motion *motion, double *t, double t_end, impact_state *states,
                                impact_sampler *sampler, impact_end *end);
impact_status impact_motion_integrate(impact_motion *motion, double *t, double t_end, impact_state *states,
                                      impact_sampler *sampler, impact_end *end);

/* When the next sample is due; infinite when none is. */
double impact_motion_sample_time(const impact_sampler *sampler);
/* Emits one, with the held contacts put back exactly. */
impact_status impact_motion_emit(impact_motion *motion, impact_sampler *sampler, double t, const impact_state *states);

/* Nothing but uniform gravity acts, and nothing is held: the motion is in closed form. */
bool impact_motion_is_ballistic(const impact_motion *motion);
/* Sets every pair's slack for the stretch that begins. */
void impact_motion_set_slack(impact_motion *motion, const impact_state *states);

/* Loads on every body; false, with a message, when a custom force refuses or gives a NaN. */
bool impact_motion_load(impact_motion *motion, double t, const impact_state *states);

#endif
