/* SPDX-License-Identifier: MIT
 *
 * collide: one frictional impact of two rigid bodies at one point. Pure; no allocation (but for the CVODE road).
 */
#ifndef IMPACT_COLLIDE_H
#define IMPACT_COLLIDE_H

#include <quat/quat.h>
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One body as the impact sees it. mass = INFINITY is static: its moments and velocities' changes are then ignored. */
typedef struct impact_collider {
    double mass;      /* kg, > 0 */
    qvec3 moments;    /* principal moments of inertia about the centre, kg m^2, > 0 */
    quat orientation; /* principal axes to world, unit */
    qvec3 offset;     /* contact point minus centre of mass, m, world */
    qvec3 velocity;   /* of the centre, m/s, world */
    qvec3 omega;      /* rad/s, world */
} impact_collider;

typedef enum impact_law { IMPACT_POISSON, IMPACT_NEWTON, IMPACT_STRONGE } impact_law;

typedef enum impact_solver {
    IMPACT_SOLVER_AUTO,
    IMPACT_SOLVER_CLOSED_FORM,
    IMPACT_SOLVER_SERIES,
    IMPACT_SOLVER_CVODE
} impact_solver;

typedef struct impact_collision {
    impact_collider body[2];
    qvec3 normal;       /* from body 2 to body 1, finite, non-zero; normalised on use */
    double friction;    /* mu >= 0 */
    double restitution; /* in [0, 1] */
    impact_law law;
    impact_solver solver;
} impact_collision;

/* What happened in order: sliding or sticking in compression (C) and restitution (R), and reversals between. */
typedef enum impact_phase {
    IMPACT_SLIP_C = 1,
    IMPACT_STICK_C,
    IMPACT_SLIP_R,
    IMPACT_STICK_R,
    IMPACT_REVERSAL
} impact_phase;

enum { IMPACT_MAX_PHASES = 16 };

typedef struct impact_outcome {
    qvec3 velocity[2], omega[2];  /* after the impact, world */
    qvec3 impulse;                /* on body 1, N s, world; body 2 gets the negative */
    double impulse_normal;        /* along the normal, N s */
    double impulse_tangential;    /* magnitude across it, N s */
    double normal_before, normal_after; /* u_z, normal relative velocity at the contact, m/s; before < 0 */
    double compression_impulse;   /* p_c, N s, summed over compressions */
    double work_compression, work_restitution, work_friction; /* J */
    double energy_before, energy_after; /* kinetic, J, of the bodies that move */
    int compressions;             /* how many times the contact was compressed */
    int phase_count;
    unsigned char phases[IMPACT_MAX_PHASES]; /* impact_phase values, in order */
    impact_solver solver;         /* the one that answered */
    double conditioning;          /* of the contact's inverse mass matrix M; 1 is best */
    bool energy_rose;             /* Newton's law only: it can */
} impact_outcome;

/* Solves one impact. IMPACT_OK; IMPACT_SEPARATING when the contact points do not approach (outcome: nothing changed);
 * negative: the outcome holds the velocities given and NaN elsewhere. */
IMPACT_API impact_status impact_collide(const impact_collision *collision, impact_outcome *outcome);

#ifdef __cplusplus
}
#endif

#endif
