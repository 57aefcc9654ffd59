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

/* When restitution ends: at eps times the impulse of compression; at u_z = -eps u_z(0); at eps^2 times the work of
 * loading. */
typedef enum impact_law { IMPACT_POISSON, IMPACT_NEWTON, IMPACT_STRONGE } impact_law;

/* AUTO: closed form where the sliding direction does not turn or M_tt is isotropic, else the series; CVODE where only
 * that can. */
typedef enum impact_solver {
    IMPACT_SOLVER_AUTO,
    IMPACT_SOLVER_CLOSED_FORM,
    IMPACT_SOLVER_SERIES,
    IMPACT_SOLVER_CVODE
} impact_solver;

/* Whether an answer is checked by its receipt before it is returned. */
typedef enum impact_checking {
    IMPACT_CHECK_AUTO,   /* by impact_collide, but for the hodograph; not by impact_collide_many */
    IMPACT_CHECK_ALWAYS, /* by both, all of it */
    IMPACT_CHECK_NEVER   /* only that it is finite and gains no energy */
} impact_checking;

/* mu at the sliding speed given, m/s; finite and >= 0, smooth for speed > 0; mu(0) decides whether friction
 * can hold. */
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
    /* Other forces press the contact, u_n is 0 but for rounding (2^-48 of the speeds there). Where no pressure can
     * withstand them, since sliding friction draws the contact on (Painleve), it is an impact without approach, phase
     * TANGENTIAL; else nothing happens, as without `pressed`. */
    bool pressed;

    /* The rest may stay zero. */
    int series_order;                  /* Taylor series: 8 ... 32; 0: 22 */
    impact_friction_law *friction_law; /* in place of `friction`, by CVODE; NULL: constant friction */
    void *friction_context;
    /* eta^2, normal over tangential stiffness of the contact: by CVODE (always BDF), Stronge's law; 0: rigid. */
    double tangential_compliance;
    impact_checking checking;
    impact_collide_workspace *workspace; /* for CVODE; NULL: one is made for the call (it allocates), Adams at 1e-12 */
} impact_collision;

/* What happened in order: sliding or sticking in compression (C) and restitution (R). A reversal stands where sliding
 * came to a stop and went on at once in another direction, friction being too weak to hold. TANGENTIAL stands for the
 * first SLIP_C of what is compressed by its own friction, without approach. */
typedef enum impact_phase {
    IMPACT_SLIP_C = 1,
    IMPACT_STICK_C,
    IMPACT_SLIP_R,
    IMPACT_STICK_R,
    IMPACT_REVERSAL,
    IMPACT_TANGENTIAL
} impact_phase;

enum { IMPACT_MAX_PHASES = 16 };

typedef struct impact_outcome {
    qvec3 velocity[2], omega[2];        /* after the impact, world */
    qvec3 impulse;                      /* on body 1, N s, world; body 2 gets the negative */
    double impulse_normal;              /* along the normal, N s, > 0 */
    double impulse_tangential;          /* magnitude across it, N s; at most mu times impulse_normal */
    double normal_before, normal_after; /* u_z, normal relative velocity at the contact, m/s; before < 0 */
    double compression_impulse;         /* p_c, N s, summed over compressions */
    /* J: <= 0, >= 0, <= 0; their sum is the change of energy. A compliant contact's spring counts with friction. */
    double work_compression, work_restitution, work_friction;
    double energy_before, energy_after; /* kinetic, J, of the bodies that move */
    int compressions;                   /* how many times the contact was compressed */
    int phase_count;
    unsigned char phases[IMPACT_MAX_PHASES]; /* impact_phase values, in order; what does not fit is left out */
    qvec3 phase_impulse[IMPACT_MAX_PHASES];  /* on body 1 up to the end of each phase, N s, world */
    impact_solver solver;                    /* the one that answered */
    /* Of the contact's inverse mass matrix M: |M| |M^-1| / 3 by Frobenius norms, between a third and the whole of the
     * ratio of its largest eigenvalue to its smallest. 1 is best, and where there is no friction. */
    double conditioning;
    bool jammed;      /* friction drove the contact on into compression: u_z fell while it was < 0 */
    bool energy_rose; /* Newton's law only (or a restitution above 1): it can */
    bool second;      /* answered in 128-bit arithmetic, since the answer in double had not passed */
    /* An estimate, to first order, of the relative error of the velocities: eps times what the receipt left, times the
     * conditioning, at least 1 each. 0: not looked at. */
    double error;
} impact_outcome;

/* One word for each: "poisson", "closed form", "slip-c" ...; "unknown" for any other value. */
IMPACT_API const char *impact_law_name(impact_law law);
IMPACT_API const char *impact_solver_name(impact_solver solver);
IMPACT_API const char *impact_phase_name(impact_phase phase);

/* The receipt of an answer: how far identities between a collision and its outcome are missed, each over the sizes of
 * its own terms, in units of eps = 2^-52. What rounding alone leaves is of the order of 1. */
typedef struct impact_receipt {
    double momentum; /* m (V - v) = +-P */
    double spin;     /* J (W - w) = +-(r x P) on each principal axis */
    double cone;     /* P_n >= 0, |P_t| <= mu P_n */
    double energy;   /* does not rise (Poisson, Stronge), friction's work is not > 0, energies as reported */
    double power;    /* change of energy = P.(u- + u+)/2 = sum of the works (and of a moving static body's) */
    double law;      /* of restitution */
    double approach; /* u_n before, after and P_n as reported; u_n after >= 0 */
    double stick;    /* u_t = 0 where the last phase sticks */
    double path;     /* each phase: its impulse in the cone; u_n = 0 at turns, u_t = 0 at stops; together the impulse */
    /* A slip that turns: |u_t| against its direction at the end of each phase, by the closed hodograph; of how many
     * phases that was known (roots that are apart, a direction that is not one of them). */
    double hodograph;
    int slips;
    double worst;
} impact_receipt;

/* The receipt's worst; NaN where anything is. It shares no formula with the solvers. Restitution by Stronge's law is
 * looked at where the contact was compressed once; of a compliant contact law, stick and path are left out, of a
 * friction law the cone: they stay 0. For outcomes of IMPACT_OK and IMPACT_SOFT. */
IMPACT_API double impact_collide_receipt(const impact_collision *collision, const impact_outcome *outcome,
                                         impact_receipt *receipt);

/* Whether impact_collide would take the collision: IMPACT_OK, or IMPACT_EDOMAIN (NaN or infinity) or IMPACT_EARGUMENT
 * (out of range) with the thing and its value in message[size], cut to fit; size 0: no message. */
IMPACT_API impact_status impact_collide_check(const impact_collision *collision, char *message, size_t size);

/* Moments and orientation for an impact_collider from an inertia tensor about the centre in world axes, kg m^2,
 * symmetric to 1e-9 of its largest entry and positive definite. IMPACT_EARGUMENT otherwise, IMPACT_EDOMAIN for a NaN or
 * infinity: *orientation = 1. */
IMPACT_API impact_status impact_principal_axes(const qmat3 *tensor, qvec3 *moments, quat *orientation);

/* A workspace for CVODE's road, of the method and relative tolerance given (1e-14 ... 1e-2). IMPACT_EABSENT in a build
 * without CVODE. */
IMPACT_API impact_status impact_collide_workspace_create(impact_ode_method method, double tolerance,
                                                         impact_collide_workspace **workspace);
/* The same in the caller's memory: see memory.h; NULL: malloc. IMPACT_ENOMEM when it is spent; an impact that needs
 * more later (the first with tangential compliance) answers so too. */
IMPACT_API impact_status impact_collide_workspace_create_with(const impact_allocator *allocator,
                                                              impact_ode_method method, double tolerance,
                                                              impact_collide_workspace **workspace);
IMPACT_API void impact_collide_workspace_destroy(impact_collide_workspace *workspace); /* NULL is fine */
/* CVODE's work since the workspace was made. */
IMPACT_API impact_ode_counts impact_collide_workspace_count(const impact_collide_workspace *workspace);
/* What it holds; of one that belongs to a scene: what the scene holds. */
IMPACT_API impact_memory impact_collide_workspace_memory(const impact_collide_workspace *workspace);

/* Solves one impact (docs/collide.md). IMPACT_OK: and the receipt passed; IMPACT_SEPARATING when the contact points do
 * not approach (outcome: nothing changed); IMPACT_SOFT: the best answer of all solvers, whose receipt did not pass:
 * impact_collide_receipt says which identity fails; negative: the outcome holds the velocities given and NaN elsewhere:
 * as impact_collide_check; IMPACT_EDOMAIN also where velocities or energies would leave double precision;
 * IMPACT_EARGUMENT also where a closed form was asked for and there is none; IMPACT_EABSENT for CVODE in a build
 * without it; IMPACT_EINTEGRATOR, IMPACT_EUNSETTLED, IMPACT_ENOMEM. A tangential velocity that is rounding of the
 * velocities given counts as none. Sources: Mirtich & Canny 1995; Stronge 2000; the series after Jorba & Zou 2005. */
IMPACT_API impact_status impact_collide(const impact_collision *collision, impact_outcome *outcome);

/* Solves count impacts into outcomes[count] and, when wanted, statuses[count], on so many threads (1 ... 256; 0: as
 * many as the machine has). The answers are the same bits for any number of threads. Returns the first failure, else
 * IMPACT_OK; separating pairs are no failure. A workspace given in a collision serves as a pattern: each thread makes
 * its own of the same method and tolerance. Friction laws are called from several threads at once. IMPACT_EARGUMENT:
 * threads out of range. */
IMPACT_API impact_status impact_collide_many(const impact_collision *collisions, size_t count, int threads,
                                             impact_outcome *outcomes, impact_status *statuses);

/* How far the velocities after the impact follow its data, to first order: each number x of the data (both bodies', the
 * normal, friction, restitution) changed by the part h of itself moves them by h c_x of their size; the root of the sum
 * of all c_x^2, which is what changes up or down at random come to. Times 2^-52 it is what rounding of the data alone
 * leaves open: it knows of M, of slim bodies, of velocities that nearly vanish. The size of velocities is the root of
 * the sum over both bodies of |v|^2 + rho^2 |omega|^2, rho^2 the mean moment over the mass.
 * By the derivative of the flow (Leine & Nijmeijer 2004); in 128 bits where M is ill-conditioned; by differences, to
 * 1e-5, where CVODE answers alone. INFINITY where the answer jumps or has no derivative to the last bits of the data:
 * the impact ends just as the contact is compressed again, or u_n only touches 0, or Newton's value. Where it has one
 * on each side, that of the phases that are: sticking or not, an end of sliding at an event. From u_t = 0 where
 * friction does not hold, near both (along the slip). 1 where the points do not approach, 0 where nothing moves; NaN
 * where impact_collide refuses. */
IMPACT_API double impact_collide_sensitivity(const impact_collision *collision);

/* ---- sliding itself, as data for plotting ---- */

/* The inverse mass that the contact feels, M = [[a, 0, c], [0, b, d], [c, d, m]], 1/kg, in the frame (t1, t2, n) with
 * the principal tangential axes; and mu. From impact_flow_make, or filled by hand (t1, t2, n are only carried along).
 */
typedef struct impact_flow {
    qvec3 t1, t2, n;
    double a, b, c, d, m;
    double friction;
} impact_flow;

/* The flow of a collision; velocity[3]: the relative velocity of the contact points along (t1, t2, n), m/s. Status as
 * impact_collide, but approach is not asked for. */
IMPACT_API impact_status impact_flow_make(const impact_collision *collision, impact_flow *flow, double velocity[3]);

typedef struct impact_flow_point {
    double p;            /* normal impulse so far, N s */
    double velocity[3];  /* along (t1, t2, n), m/s */
    double impulse[2];   /* tangential impulse along (t1, t2), N s */
    double speed, theta; /* |u_t|, and its angle from t1, rad, in (-pi, pi]; 0 where u_t = 0 */
    bool stick;          /* u_t = 0 and friction holds it there */
} impact_flow_point;

/* points[count]: the flow from velocity[3] at count >= 2 equal steps of p from 0 to p_end > 0 (N s): sliding, stopping,
 * sticking or sliding on, without regard to compression and restitution. IMPACT_EARGUMENT, IMPACT_EDOMAIN: M not
 * positive definite, mu < 0, p_end
 * <= 0, count < 2, NaN; IMPACT_EUNSETTLED: the series did not settle. */
IMPACT_API impact_status impact_flow_sample(const impact_flow *flow, const double velocity[3], double p_end, int count,
                                            impact_flow_point *points);

/* A direction in which sliding does not turn. */
typedef struct impact_flow_direction {
    double theta; /* from t1, rad, in [0, 2 pi) */
    double rate;  /* R = d|u_t|/dp there, 1/kg: negative where sliding ends */
    double climb; /* Z = du_n/dp, 1/kg */
    double pull;  /* dT/dtheta, 1/kg: negative where directions nearby turn to this one */
} impact_flow_direction;

/* Up to 4 directions in order of theta; returns how many: 0 where every direction is one (a = b, c = d = 0) or M is not
 * positive definite. */
IMPACT_API int impact_flow_directions(const impact_flow *flow, impact_flow_direction directions[4]);

#ifdef __cplusplus
}
#endif

#endif
