/* SPDX-License-Identifier: MIT
 *
 * motion: from one event of the world to the next, in closed form where flight has one, by the integrator elsewhere.
 * Internal.
 */
#ifndef IMP_MOTION_H
#define IMP_MOTION_H

#include "base/ode_in.h"
#include "contact/persist.h"
#include "motion/key.h"

typedef enum imp_end_kind {
    IMP_END_TIME,    /* the time asked for */
    IMP_END_GAP,     /* an open pair's gap fell to zero */
    IMP_END_RETURN,  /* a body that had passed beside a plane's bounds is before the plane again */
    IMP_END_BOUNDS,  /* a held contact left its plane's bounds */
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

/* Where samples go on the way: emit is called at every k/rate up to where the motion ends. */
typedef struct imp_sampler {
    double rate; /* 0: never */
    long next;   /* k of the next sample */
    bool (*emit)(void *context, double t, const imp_state *states);
    bool (*pulse)(void *context, double t); /* called at every step of the integrator; false stops */
    /* handed every piece of motion that is done, in order; false stops. NULL: no keys are wanted */
    bool (*piece)(void *context, const imp_piece *piece);
    void *context;
} imp_sampler;

/* Work since the start of the run, J. */
typedef struct imp_works {
    double force, damping, sliding, drive;
} imp_works;

typedef struct imp_motion {
    imp_world *world;
    double tolerance, rest_speed;
    bool *resting; /* per body: no longer watched for rest */
    imp_persist persist;
    imp_load *loads;
    imp_works works;
    char message[256];

    struct imp_flyer *flyers; /* bodies in closed form; absent until they are */
    struct imp_trace *trace;  /* the integrator's last step, for keys; absent until they are wanted */

    /* the integrator's side; absent until it is needed */
    impact_ode *ode; /* the one at work: adams or bdf */
    impact_ode *adams,
        *bdf; /* for smooth motion; for what is stiff: slow slip after an onset, forces that brake hard */
    int size, roots;
    double *y, *kept; /* the integrated state, and a copy while samples are interpolated */
    int *found;
    imp_state *scratch, *sampled;
    bool sliding;                      /* slip slows the clock: see motion_equations.c */
    bool creeping;                     /* contacts that move fast over flat places do */
    bool stiff;                        /* some slip has just begun */
    bool bounces;                      /* the stretch begins with an open pair that touches */
    double *probe;                     /* 4 size: of a step that is looked into */
    double relative, *absolute;        /* tolerances of the stretch */
    bool distrusted;                   /* a loss fell: the next stretch is for the other method */
    bool retried;                      /* that was done not long ago: */
    long steady_steps;                 /* steps since a loss fell */
    double last_fall, fallen, fell_at; /* J: by how much losses have fallen in steps that were kept; s: when first */
    long pace_steps;                   /* steps since time was looked at last, and when that was, s: */
    double pace_began;
    long steps_before; /* of the stretch at hand, before its contacts were put back; and when it began, s: */
    double began;
    double slip_scale;  /* m/s */
    double creep_scale; /* 1/s */
} imp_motion;

impact_status imp_motion_open(imp_motion *motion, imp_world *world, double tolerance, double rest_speed);
void imp_motion_close(imp_motion *motion); /* of one that was not opened: nothing */

/* A force's edge that was crossed in the same instant as the event that ended the last stretch and is not handled yet:
 * the restarted integrator would never see it. False when there is none. */
bool imp_motion_also_crossed(imp_motion *motion, imp_end *end);

/* motion_advance.c, by one of two roads below. */
/* Advances the states (consistent modes: see imp_persist_resolve) from *t to the next event, at most to t_end. */
impact_status imp_motion_advance(imp_motion *motion, double *t, double t_end, imp_state *states, imp_sampler *sampler,
                                 imp_end *end);
/* In closed form: motion_flight.c; by the integrator: motion_stretch.c. */
impact_status imp_motion_fly(imp_motion *motion, double *t, double t_end, imp_state *states, imp_sampler *sampler,
                             imp_end *end);
impact_status imp_motion_integrate(imp_motion *motion, double *t, double t_end, imp_state *states, imp_sampler *sampler,
                                   imp_end *end);

/* When the next sample is due; infinite when none is. */
double imp_motion_sample_time(const imp_sampler *sampler);
/* Emits one, with the held contacts put back exactly. */
impact_status imp_motion_emit(imp_motion *motion, imp_sampler *sampler, double t, const imp_state *states);

/* Nothing but uniform gravity acts, and nothing is held: the motion is in closed form. */
bool imp_motion_is_ballistic(const imp_motion *motion);
/* Sets every pair's slack, and whether one bounces, for the stretch that begins. */
void imp_motion_set_slack(imp_motion *motion, const imp_state *states);

/* Loads on every body; false, with a message, when a custom force refuses or gives a NaN. */
bool imp_motion_load(imp_motion *motion, double t, const imp_state *states);

#endif
