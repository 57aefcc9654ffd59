/* SPDX-License-Identifier: MIT
 *
 * collide: one frictional impact of two rigid bodies at one point. Pure; no allocation (but for the CVODE road).
 */
#ifndef IMPACT_COLLIDE_H
#define IMPACT_COLLIDE_H

#include <stddef.h>
#include <quat/quat.h>
#include "ode.h"
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

/* mu at the sliding speed given, m/s; finite and >= 0, smooth for speed > 0; mu(0) decides whether friction can hold. */
typedef double impact_friction_law(double speed, void *context);

/* An integrator kept from one impact to the next; not shared between threads. */
typedef struct impact_collide_workspace impact_collide_workspace;

typedef struct impact_collision {
    impact_collider body[2];
    qvec3 normal;       /* from body 2 to body 1, finite, non-zero; normalised on use */
    double friction;    /* mu >= 0, of sliding and of sticking alike */
    double restitution; /* in [0, 1]; see any_restitution */
    impact_law law;
    impact_solver solver;
    bool any_restitution; /* take a restitution above 1 too */

    /* The rest may stay zero. */
    int series_order;                  /* Taylor series: 8 ... 32; 0: 22 */
    impact_friction_law *friction_law; /* in place of `friction`, by CVODE; NULL: constant friction */
    void *friction_context;
    double tangential_compliance; /* eta^2 = normal over tangential stiffness of the contact, by CVODE and Stronge's law; 0: rigid */
    impact_collide_workspace *workspace; /* for CVODE; NULL: one is made for the call (it allocates), Adams at 1e-12 */
} impact_collision;

/* What happened in order: sliding or sticking in compression (C) and restitution (R). A reversal stands where sliding came to a
 * stop and went on at once in another direction, friction being too weak to hold. */
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
    double impulse_normal;        /* along the normal, N s, > 0 */
    double impulse_tangential;    /* magnitude across it, N s; at most mu times impulse_normal */
    double normal_before, normal_after; /* u_z, normal relative velocity at the contact, m/s; before < 0 */
    double compression_impulse;   /* p_c, N s, summed over compressions */
    double work_compression, work_restitution, work_friction; /* J: <= 0, >= 0, <= 0; their sum is the change of energy */
    double energy_before, energy_after; /* kinetic, J, of the bodies that move */
    int compressions;             /* how many times the contact was compressed */
    int phase_count;
    unsigned char phases[IMPACT_MAX_PHASES]; /* impact_phase values, in order */
    impact_solver solver;         /* the one that answered */
    double conditioning;          /* of the contact's inverse mass matrix M: largest over smallest eigenvalue; 1 is best */
    bool jammed;                  /* friction drove the contact on into compression: u_z fell while it was < 0 */
    bool energy_rose;             /* Newton's law only (or a restitution above 1): it can */
} impact_outcome;

/* One word for each: "poisson", "closed form", "slip-c" ...; "unknown" for any other value. */
IMPACT_API const char *impact_law_name(impact_law law);
IMPACT_API const char *impact_solver_name(impact_solver solver);
IMPACT_API const char *impact_phase_name(impact_phase phase);

/* Whether impact_collide would take the collision: IMPACT_OK, or IMPACT_EDOMAIN (NaN or infinity) or IMPACT_EARGUMENT (out of range)
 * with the thing and its value in message[size], cut to fit; size 0: no message. */
IMPACT_API impact_status impact_collide_check(const impact_collision *collision, char *message, size_t size);

/* A workspace for CVODE's road, of the method and relative tolerance given (1e-14 ... 1e-2). IMPACT_EABSENT in a build without CVODE. */
IMPACT_API impact_status impact_collide_workspace_create(impact_ode_method method, double tolerance, impact_collide_workspace **workspace);
IMPACT_API void impact_collide_workspace_destroy(impact_collide_workspace *workspace); /* NULL is fine */
/* CVODE's work since the workspace was made. */
IMPACT_API impact_ode_counts impact_collide_workspace_count(const impact_collide_workspace *workspace);

/* Solves one impact. IMPACT_OK; IMPACT_SEPARATING when the contact points do not approach (outcome: nothing changed);
 * negative: the outcome holds the velocities given and NaN elsewhere. */
IMPACT_API impact_status impact_collide(const impact_collision *collision, impact_outcome *outcome);

#ifdef __cplusplus
}
#endif

#endif
