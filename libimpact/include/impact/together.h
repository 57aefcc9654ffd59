/* SPDX-License-Identifier: MIT
 *
 * together: an encounter, many contacts struck at one instant and answered together. Pure; it allocates where no
 * workspace is given. Equations: docs/together.md.
 */
#ifndef IMPACT_TOGETHER_H
#define IMPACT_TOGETHER_H

#include <stddef.h>
#include "collide.h"
#include "memory.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum impact_together_law {
    /* The limit of stiff springs whose stiffnesses keep their ratios, Coulomb's friction, Stronge's restitution. */
    IMPACT_TOGETHER_SPRINGS,
    /* All contacts compressed at once, then Poisson's restitution at once (Glocker & Pfeiffer); or Newton's, all at
     * once (Moreau). */
    IMPACT_TOGETHER_MOREAU,
    /* One after another in the order given, each by impact_collide, until none approaches: the order decides. */
    IMPACT_TOGETHER_SEQUENCE
} impact_together_law;

/* What answered: impact_collide (every contact alone), the springs' Taylor series, the cone solver, sweeps. Where
 * groups were answered by different ones: the last of this list. */
typedef enum impact_together_solver {
    IMPACT_TOGETHER_NONE, /* nothing approached */
    IMPACT_TOGETHER_ALONE,
    IMPACT_TOGETHER_SERIES,
    IMPACT_TOGETHER_CONE,
    IMPACT_TOGETHER_SWEEPS
} impact_together_solver;

/* One contact of the encounter; several of one pair of bodies are fine. Two with the same bodies, normal and offsets
 * are one: the first counts, and gets the impulse. */
typedef struct impact_meeting {
    int body1, body2;       /* indices into the bodies, different; one of them moves */
    qvec3 normal;           /* from body 2 to body 1, world, finite, non-zero; normalised on use */
    qvec3 offset1, offset2; /* contact point minus the bodies' centres of mass, m, world */
    double friction;        /* mu >= 0, of sliding and of sticking alike */
    double restitution;     /* in [0, 1]: Stronge's, Poisson's, or as `restitution` of the encounter says */
    double stiffness;       /* of the springs, any unit, > 0: only ratios count; not looked at by the other laws */
    /* Other forces press it, u_n is 0 but for rounding (2^-48 of the speeds there), and no pressures of the contacts
     * that touch can withstand them, as its sliding friction draws it on (Painleve): it is struck without approach,
     * phase TANGENTIAL; else nothing is changed by it. Not looked at by IMPACT_TOGETHER_SEQUENCE. */
    bool pressed;
} impact_meeting;

/* Memory kept from one encounter to the next; not shared between threads. */
typedef struct impact_together_workspace impact_together_workspace;

typedef struct impact_encounter {
    const impact_collider *bodies; /* their `offset` is not looked at */
    int body_count;
    const impact_meeting *meetings;
    int meeting_count;
    impact_together_law law;
    double exponent;                      /* of the springs, force ~ indentation^exponent: 1 ... 3; 0: Hertz's 3/2 */
    impact_law restitution;               /* which law IMPACT_TOGETHER_SEQUENCE restores by, and MOREAU: Newton's, or
                                           * by any other Poisson's */
    impact_together_workspace *workspace; /* NULL: one is made for the call */
} impact_encounter;

/* What became of one contact. */
typedef struct impact_meeting_outcome {
    qvec3 impulse;                      /* on body 1, N s, world; body 2 gets the negative */
    double normal_before, normal_after; /* u_n, normal relative velocity of the contact points, m/s */
    double work_compression, work_restitution, work_friction; /* J: <= 0, >= 0, <= 0 */
    int compressions;                                         /* how often it was compressed; 0: it took no part */
    int group;                               /* contacts that are tied by moving bodies share one, 0, 1, ... */
    int phase_count;                         /* impact_phase values in order; what does not fit is left out */
    unsigned char phases[IMPACT_MAX_PHASES]; /* by impact_collide and the springs; by Moreau TANGENTIAL alone */
    bool merged;                             /* the same as an earlier one, which has the impulse */
} impact_meeting_outcome;

typedef struct impact_together_outcome {
    /* The caller's room; a NULL is not written. */
    qvec3 *velocity, *omega;          /* body_count each: after the encounter, world */
    impact_meeting_outcome *meetings; /* meeting_count */
    /* Kinetic, J, of the bodies that move. */
    double energy_before, energy_after;
    /* The receipt: the largest of what the answer misses momentum, spin, cones, energy, works and separation by, over
     * the sizes of their own terms. Rounding leaves 1e-15 to 1e-13. */
    double residual;
    double
        error;  /* of velocities, of the fastest approach: springs take a restitution under .001 as more if they must */
    int groups; /* of contacts tied by moving bodies */
    long events;      /* springs: changes of a contact's mode; sequence: impacts; these and steps also without answer */
    long steps;       /* springs: Taylor steps; Moreau: linear systems */
    bool ended_early; /* springs: the work allowed was spent; what was left ended at once, and error tells what by */
    bool energy_rose; /* not by springs: Moreau's law with different restitutions, and Newton's, can */
    bool chosen;      /* reactions are not unique; those of least norm where they could be chosen */
    int wedged;       /* IMPACT_EUNSETTLED: a contact of a group whose contacts no motion takes apart; -1: none */
    impact_together_solver solver;
} impact_together_outcome;

/* "springs", "moreau", "sequence"; "none", "alone", "series", "cone", "sweeps"; "unknown" for any other value. */
IMPACT_API const char *impact_together_law_name(impact_together_law law);
IMPACT_API const char *impact_together_solver_name(impact_together_solver solver);

/* A workspace in the allocator's memory (memory.h; NULL: malloc). IMPACT_EARGUMENT: one function without the other;
 * IMPACT_ENOMEM. */
IMPACT_API impact_status impact_together_workspace_create(const impact_allocator *allocator,
                                                          impact_together_workspace **workspace);
IMPACT_API void impact_together_workspace_destroy(impact_together_workspace *workspace); /* NULL is fine */
IMPACT_API impact_memory impact_together_workspace_memory(const impact_together_workspace *workspace);

/* Whether impact_collide_together would take the encounter: IMPACT_OK, or IMPACT_EDOMAIN (NaN or infinity) or
 * IMPACT_EARGUMENT (out of range) with the thing and its value in message[size], cut to fit; size 0: no message. */
IMPACT_API impact_status impact_collide_together_check(const impact_encounter *encounter, char *message, size_t size);

/* Solves one encounter. Contacts are grouped by the moving bodies they share; a group of one contact is answered by
 * impact_collide (springs: Stronge's law, Moreau: Poisson's or Newton's). The bits of the answer depend neither on the
 * numbering of bodies nor on the order of contacts (but by the law SEQUENCE). IMPACT_OK: and the receipt passed;
 * IMPACT_SEPARATING: no contact approaches, nothing changed; IMPACT_SOFT: the receipt did not pass, `residual` says by
 * how much, or springs were ended early, which `error` tells the doubt of. Below zero nothing is answered, and
 * velocities are those given: as impact_collide_together_check; IMPACT_EUNSETTLED (the contacts are wedged, the cone
 * problem found no answer, or springs that were ended early leave in doubt as much as what approached);
 * IMPACT_EINTEGRATOR, IMPACT_ENOMEM. Sources: Darboux 1880; Keller 1986; Stronge 2000; Liu, Zhao & Brogliato 2008;
 * Moreau 1988; Glocker & Pfeiffer 1995. */
IMPACT_API impact_status impact_collide_together(const impact_encounter *encounter, impact_together_outcome *outcome);

#ifdef __cplusplus
}
#endif

#endif
