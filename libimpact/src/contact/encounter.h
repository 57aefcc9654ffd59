/* SPDX-License-Identifier: MIT
 *
 * encounter: the contacts of an encounter in an order of their own, in groups tied by moving bodies. Internal.
 *
 * Per contact the axes n, t1, t2; u = G v the velocity of body 1's point over body 2's along them, f the force or p the
 * impulse on body 1, body 2 getting the opposite:
 *
 *     u = u0 + W p,    W = G M^-1 G^T,    the rows of G M^-1/2 per body: six numbers
 */
#ifndef IMP_CONTACT_ENCOUNTER_H
#define IMP_CONTACT_ENCOUNTER_H

#include <math.h>
#include <stdint.h>
#include <impact/together.h>
#include "base/arena.h"
#include "contact/cone_bodies.h"
#include "contact/rest.h"

/* One contact of a group. */
typedef struct imp_contact {
    int source;          /* its place among the caller's meetings */
    int body[2];         /* among the caller's bodies */
    qvec3 axes[3];       /* n, t1, t2: world, orthonormal */
    qvec3 arm[2];        /* m, world */
    double row[2][3][6]; /* G M^-1/2; zero of a static body */
    double friction, restitution, stiffness;
    double slip; /* |u_t| where it is pressed and u_n is 0 but for rounding (encounter_pressed.c); else 0 */
} imp_contact;

/* What a solver finds of a contact, beside its impulse. */
typedef struct imp_finding {
    double work[3]; /* compression, restitution, friction */
    int compressions, phase_count;
    unsigned char phases[IMPACT_MAX_PHASES];
} imp_finding;

/* Contacts tied by moving bodies, in canonical order, with W and u0; the solvers write p, in N s, and the findings. */
typedef struct imp_group {
    int count;
    const imp_contact *contacts;
    const double *w;  /* (3 count)^2, symmetric to the bit, 1/kg */
    const double *u0; /* 3 count, m/s */
    double *p;        /* 3 count */
    imp_finding *findings;
    const impact_collider *bodies; /* the caller's; their velocities now: */
    qvec3 *velocity, *omega;
    long events, steps;
    bool chosen, wedged;
    double least;  /* springs: smaller restitutions count as this */
    long patience; /* springs: steps and events allowed */
    double error;  /* of velocities, of the fastest approach */
    double held;   /* springs: what they would still give back, J */
} imp_group;

/* Memory that is cut up anew each time. */
typedef struct imp_block {
    unsigned char *bytes;
    size_t size, used;
    bool spent; /* it was asked for more than it has */
} imp_block;

/* Room for so many bytes, of which none is used; what was there is lost. False: there is no more. */
bool imp_block_clear(imp_arena *arena, imp_block *block, size_t bytes);
/* count * size bytes of it, zeroed; NULL: there are no more. */
void *imp_block_take(imp_block *block, size_t count, size_t size);

struct impact_together_workspace {
    imp_arena *arena;
    imp_block plan, work; /* of a call; of one group */
    imp_cone_workspace cone;
    imp_cone_bodies bodies;
    imp_rest_workspace rest;
};

/* A workspace in the arena, with which it goes: not to be destroyed. */
impact_status imp_together_workspace_in(imp_arena *arena, impact_together_workspace **workspace);

/* count * size bytes of the group's work, zeroed; NULL: there is no more. */
void *imp_encounter_take(impact_together_workspace *workspace, size_t count, size_t size);

/* The contacts in canonical order, and each group together. */
typedef struct imp_order {
    int count;         /* contacts, without those that are the same as another */
    int *meeting;      /* count: places among the caller's meetings */
    int *group;        /* count, never falling: 0, 1, ... */
    int *merged;       /* meeting_count: where its impulse is; its own place where it has one */
    int groups, large; /* how many; contacts of the largest */
} imp_order;

/* order: its arrays given. keys[meeting_count + 2 body_count], parents[body_count + meeting_count]: scratch. */
void imp_encounter_sort(const impact_encounter *encounter, imp_order *order, uint64_t *keys, int *parents);

/* The first meeting of the same bodies at the same place: itself, or an earlier one. */
int imp_encounter_same(const impact_encounter *encounter, int meeting);

/* The meeting as one impact, of the bodies with the velocities given (NULL: their own). */
impact_collision imp_encounter_collision(const impact_encounter *encounter, int meeting, const qvec3 *velocity,
                                         const qvec3 *omega);

/* The axes, arms and rows of the meeting; the frictions and so on copied. Without friction (smooth) the normal alone.
 */
imp_contact imp_encounter_contact(const impact_encounter *encounter, int meeting, bool smooth);

/* The relative velocity of the contact's points along its axes. */
void imp_encounter_velocity(const imp_contact *contact, const qvec3 *velocity, const qvec3 *omega, double u[3]);

/* The power of two at or under the value; 1 where that is none. */
double imp_encounter_unit(double value);

/* The receipt's residual of the outcome, which has velocities, meetings and energies. It shares no formula with the
 * solvers. */
double imp_encounter_receipt(const impact_encounter *encounter, const impact_together_outcome *outcome);

/* Kinetic energy of the bodies that move, J. */
double imp_encounter_energy(const impact_encounter *encounter, const qvec3 *velocity, const qvec3 *omega);

static inline bool imp_encounter_is_static(const impact_collider *body) { return isinf(body->mass); }

/* J^-1 a, for a vector in the world frame; 0 for a static body. */
qvec3 imp_encounter_turn(const impact_collider *body, qvec3 a);

/* ---- encounter_wedge.c ---- */

typedef struct imp_wedge_question {
    int count;
    const double *w;        /* (3 count)^2 */
    const double *friction; /* count */
    const bool *taken;      /* count: which take part; NULL: all */
} imp_wedge_question;

/* Doubles of room for n contacts. */
size_t imp_encounter_wedge_size(size_t n);
/* Whether no motion takes the contacts apart, friction against it. room: begins with pressures, 3 count, sum r_n = 1,
 * that then balance but for rounding. */
bool imp_encounter_wedged(const imp_wedge_question *question, double *room);

/* ---- encounter_mend.c: velocities of the bodies as impulses change them ---- */

qvec3 imp_encounter_impulse(const imp_contact *contact, const double p[3]); /* world */
/* The impulses p[3 count] change the velocities. */
void imp_encounter_push(const imp_group *group, const double *p);
/* The velocities of the contacts now, u[3 count]. */
void imp_encounter_look(const imp_group *group, double *u);
/* p has pushed, after which contacts have the velocities `after` but for rounding and the residual of the answer that
 * both are (imp_cone_outcome): that is taken away, and p changed. */
void imp_encounter_mend(const imp_group *group, const double *after, double residual, double *p,
                        impact_together_workspace *workspace);

/* ---- encounter_share.c ---- */

typedef struct imp_share_question {
    const double *u;         /* 3 count: the velocities that the impulses leave */
    double speed, still;     /* m/s: the fastest before; what of them is rounding */
    int bodies;              /* that move */
    const int (*couples)[2]; /* count: of each contact the two, 0 .. bodies - 1; -1: one that does not */
} imp_share_question;

/* group->p to those impulses of least norm that leave the same velocities, modes[count] to what these say; false, and
 * both stay, where they are not found. */
bool imp_encounter_share(const imp_group *group, const imp_share_question *question, imp_cone_mode *modes,
                         impact_together_workspace *workspace);

/* ---- encounter_pressed.c ---- */

/* Sets the slip of a contact that other forces press, which moves at u[3]. */
void imp_encounter_press(const imp_group *group, imp_contact *contact, const double *u);
/* By group->p: whether a contact with such slip is drawn on, its impulse more than its seed's; whether any is; whether
 * any is, or approached. */
bool imp_encounter_is_drawn(const imp_group *group, int contact);
bool imp_encounter_draws(const imp_group *group);
bool imp_encounter_strikes(const imp_group *group);

/* ---- encounter_moreau.c: compression and restitution by the cone solver; the velocities are pushed ---- */

typedef enum imp_rebound { IMP_REBOUND_POISSON, IMP_REBOUND_NEWTON, IMP_REBOUND_NONE } imp_rebound;

/* IMPACT_SEPARATING: nothing approaches, nor does friction draw: they are not. */
impact_status imp_moreau_solve(imp_group *group, imp_rebound rebound, impact_together_workspace *workspace);

#endif
