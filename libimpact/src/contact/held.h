/* SPDX-License-Identifier: MIT
 *
 * held: contacts that are held after the bounces died out: their reactions while rolling or sliding, when a mode
 * ends, and the constraints put back exactly. Strictly convex bodies on planes and on each other. Internal.
 */
#ifndef IMP_HELD_H
#define IMP_HELD_H

#include "world/field.h"

/* One held contact at one instant. */
typedef struct imp_held_contact {
    int pair, body1, body2;
    imp_mode mode;
    double friction;
    qvec3 normal;        /* from body 2 to body 1 */
    qvec3 r1, r2;        /* contact point from each centre */
    qvec3 normal_rate;   /* d(normal)/dt as the contact moves, 1/s */
    imp_foot foot;       /* flat: r1 is the centre of pressure */
    double spot_rate[3]; /* spot, line: its rate, 1/s */
    double point_speed;  /* spot, line: how fast the contact moves over the surface, in semi-axes, 1/s */
    double spare;        /* flat: above 0 while r1 stays on the face */
    qvec3 slip;          /* tangential velocity of body 1's contact point over body 2's, m/s */
    double speed;        /* |slip| */
    bool incipient;      /* sliding from rest, too slow for a direction of its own */
    bool still;          /* as its pair: the force is the pair's reaction */
    qvec3 direction;     /* unit of slip; of incipient slip, of its acceleration */
    qvec3 bias;          /* relative acceleration of the contact points without reactions, m/s^2 */
    qvec3 wanted;        /* change of the relative acceleration (or velocity) that the reactions are to make */
    /* solved for: */
    double pressure; /* normal force, N */
    qvec3 force;     /* on body 1, N */
    double margin;   /* rolling: friction x pressure - |tangential force|, N */
    double hold;     /* of incipient slip: friction that would hold it over what there is; below 1 it sticks again */
    bool turning;    /* of incipient slip: the direction is solved for too, linearised about what it is: */
    double mobility; /* slip's acceleration over the friction, 1/kg */
    double turn;     /* the angle from direction about the normal */
    bool redundant;  /* its reaction is not unique */
    bool unmet;      /* no reactions of its island do what is wanted */
    qvec3 slip_rate; /* tangential relative acceleration of the contact points, m/s^2 */
} imp_held_contact;

/* Whether its place on body 1 is integrated along. */
static inline bool imp_held_contact_is_followed(const imp_held_contact *contact)
{
    return contact->foot == IMP_FOOT_SPOT || contact->foot == IMP_FOOT_LINE;
}

/* What forces do to a body. */
typedef struct imp_effect {
    qvec3 linear, angular; /* m/s^2, 1/s^2 (of impulses: m/s, 1/s) */
} imp_effect;

typedef struct imp_held {
    imp_arena *arena; /* set by who opens it */
    int capacity;     /* contacts there is room for */
    int count;        /* held contacts now */
    imp_held_contact *contacts;
    struct imp_unknown *unknowns; /* 3 capacity */
    double *matrix, *right;       /* 2 (3 capacity)^2 and 6 capacity */
    int *order;                   /* 6 capacity */
    int *island;                  /* capacity; contacts of the same number share bodies */
    int bodies;                   /* bodies there is room for */
    int *first;                   /* per body: scratch */
    imp_effect *effects;          /* per body: of the reactions that were solved for */
} imp_held;

/* Room for every pair of the world that is held now; the place of contact of those newly held that carry it. */
impact_status imp_held_reserve(imp_held *held, imp_world *world, const imp_state *states);
/* Room for so many contacts, among so many bodies. */
impact_status imp_held_make_room(imp_held *held, int contacts_needed, int bodies_needed);
void imp_held_free(imp_held *held);

/* Geometry of every held contact, and what its points do under the loads without reactions. */
void imp_held_find_contacts(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads);

/* Geometry and reactions of every held contact under the loads (held_solve.c). */
void imp_held_solve(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads);

/* Adds the reactions that were solved for to the loads of their bodies; what is still has no load left. */
void imp_held_add_reactions(const imp_held *held, imp_load *loads);

/* The part of a held pair's d2(gap)/dt2 that its own reaction, as solved for, makes; 0 for a pair that is not held. */
double imp_held_own_acceleration(const imp_held *held, const imp_world *world, const imp_state *states, int pair);

/* Where the pair touches, and no more. */
imp_held_contact imp_held_meet(const imp_world *world, int pair, const impact_contact *contact);
/* The contact as it is, whether held or not; its bias without any reaction. */
imp_held_contact imp_held_contact_at(imp_world *world, int pair, const imp_state *states, const imp_load *loads);

/* Lets the contact's pair slide from rest, against the friction as solved for. */
void imp_held_begin_slide(imp_pair *pair, const imp_held_contact *contact);

/* Newton's rounds to take gaps to zero: each leaves the square of what it began with, and that is an integrator's
 * error.
 */
enum { IMP_HELD_ROUNDS = 2 };

/* One such round: the least displacements, in the measure of masses and inertias, that take the gaps of the held
 * contacts to zero, without slip where they roll. */
void imp_held_close_gaps(imp_held *held, imp_world *world, imp_state *states);
/* The impulses, held->effects by body, that take all velocity from the held contacts, none of it applied: along
 * normals, and across where they stick. */
void imp_held_find_stop(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads);
/* Puts positions and velocities back on the held contacts exactly. */
void imp_held_project(imp_held *held, imp_world *world, imp_state *states, const imp_load *loads);
/* The velocities alone. */
void imp_held_project_velocities(imp_held *held, imp_world *world, imp_state *states, const imp_load *loads);

/* Gives what is held the modes of Coulomb's law (held_modes.c), and solves for the reactions: what pulls is opened,
 * what can rolls and what must slides. IMPACT_EUNSETTLED: no answer was found. */
impact_status imp_held_resolve(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads);

/* Unit vector against a contact's friction as solved for: the way it would slide if the friction gave way. */
qvec3 imp_against_friction(const imp_held_contact *contact);

/* Normal relative velocity at a contact, m/s; < 0: approaching. */
double imp_held_approach(const imp_world *world, const imp_held_contact *contact, const imp_state *states);

/* What the drives give the world through the held contacts as they are solved for: their forces' power, W, or their
 * impulses' work, J. */
double imp_held_drive_power(const imp_held *held, const imp_world *world);

#endif
