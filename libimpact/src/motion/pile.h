/* SPDX-License-Identifier: MIT
 *
 * pile: bodies that touch, moved by steps of time where the exact method does not get on. Internal.
 *
 * Moreau & Jean's steps with theta = 1/2 (Jean 1999), of the second order while contacts and modes stay. From (x, v)
 * over h, G and M those of the middle:
 *
 *     x_m = x + h v/2      loads F and the contacts with a gap <= 0 at x_m
 *     u = W p + q,  q = G (v + h M^-1 F) + h b/2  and, along normals that approach at u_n < 0, less e u_n
 *     v' = v + h M^-1 F + M^-1 G^T p      x' = x + h (v + v')/2
 *
 * e u_n is none where the loads end that bounce within the step. b is the rate of G v at v (rates.h): u is what the
 * velocities are at the step's end, where bodies and contacts have turned; with G v alone what rocks would lose energy
 * in every step. Friction is against the slip of the middle: where that turns the problem is solved again with u_t + c,
 * c turning the first answer's slip into the mean of both ends'.
 *
 * Pairs with torsional or rolling friction have moments in the same problem (cone.h): c turns (mu u_t, tau w_n), and
 * w_t.
 *
 * Free flight in uniform gravity is exact. Places go as with the mean of both ends' velocities. With d what these
 * change by but for h times the mean acceleration of the step before, smooth motion is off by |d| h/12 then (the
 * trapezoid's h^3 a'/12, d being h^2 a'), and what jumps by d within the step, who knows when, by up to |d| h/2: the
 * measured error, which chooses the next. An impulse is in the mean of the step before: where the one before that is
 * nearer, it is that. What overlaps at the end, as it came after the middle, and has to be parted is error too. Where
 * what closes within a step strikes so hard that a quarter of a step of it is more than may be off, the step ends where
 * it closes, and what touches then of its island is struck at that instant, q = G v with neither loads nor time: the
 * next step begins with what that leaves. Overlaps that arrivals leave, and gaps by which held contacts open on round
 * bodies, h² in each step, are put back along normals, least in the metric of mass; what is parted pays for it by its
 * approach (pile_project.c). The limit h -> 0 is Coulomb's law with Newton's restitution, at simultaneous contacts
 * Moreau's.
 */
#ifndef IMP_PILE_H
#define IMP_PILE_H

#include "contact/cone_bodies.h"
#include "contact/rest.h"
#include "motion/pile_contacts.h"
#include "world/field.h"

/* What first strikes within the step that is tried. */
typedef struct imp_pile_strike {
    double allowed, span; /* m, s: what the step may err; how long it is */
    bool found;
    double time, approach; /* s from its begin, where the gap closes; m/s, at what rate */
} imp_pile_strike;

/* How fast a body's velocities changed, m/s^2 and 1/s^2. */
typedef struct imp_pile_rates {
    qvec3 v, omega;
} imp_pile_rates;

enum { IMP_PILE_RATES = 2 };

typedef struct imp_pile {
    imp_arena *arena; /* the pile's own */
    double tolerance; /* of the smallest body's radius: what a step may err */
    double longest;   /* of its natural time: a step at most */
    int bodies;       /* there is room for */
    double step;      /* s: to be tried next; 0: chosen anew */
    bool begun;
    imp_cone_workspace cone;
    imp_cone_bodies by_bodies;
    int *number; /* per body of the world: its own in an island, -1: it does not move */
    int *listed; /* and of an island's bodies by these numbers */
    imp_rest_workspace rest;
    imp_state *middle, *mean, *end, *projected;
    imp_state *from;                       /* where the last step began: with what strikes there struck */
    imp_pile_rates *rates[IMP_PILE_RATES]; /* per body: over the last step, and the one before; 0: there was none */
    imp_load *loads;
    imp_pile_contacts touching;
    imp_pile_memories memory[3]; /* as the accepted step left them, those before the step at hand, what it leaves */
    struct {
        imp_pile_memories memory;
        imp_pile_rates *rates[IMP_PILE_RATES];
        double step;
        bool begun;
    } kept; /* imp_pile_keep */
    imp_pile_strike strike;
    bool shortest;     /* it is so short that any error is allowed */
    int contacts_most; /* there is room for in: */
    imp_cone_contact *contacts;
    int *members, *pivots; /* members: the points' numbers in `touching` */
    imp_cone_row *rows;
    imp_cone_row *turns;
    int (*couples)[2]; /* by `number` */
    imp_cone_lengths *lengths;
    int widest, width; /* numbers a contact: that there is room for; of the island at hand, 3, or 6 with moments */
    double *bounce;    /* m/s, per contact, <= 0 */
    double *gap, *friction, *w, *q, *r, *u, *before, *last_r, *last_u, *lead, *bend;
    double *balance; /* of the question whether pressures balance */
    imp_rest_velocity *velocities;
    char message[160];
} imp_pile;

/* What one accepted step did. */
typedef struct imp_pile_step_result {
    double taken;                           /* s */
    double error;                           /* m: how far any body's point may be off for it; the measure */
    double force_work, damping, drive_work; /* J: of the loads and of driven surfaces */
    double sliding;                         /* J: what friction took of slip that stays or ends */
    int contacts;                           /* at its end */
    int coupled;                            /* of them between two bodies that move */
} imp_pile_step_result;

/* Nothing is taken from the arena before it is needed; all of it goes with the arena. */
void imp_pile_open(imp_pile *pile, imp_arena *arena, double tolerance);

/* s: in which the smallest body falls its radius; without gravity, in which the fastest goes as far. */
double imp_pile_natural_time(const imp_world *world, const imp_state *states);

/* The next step is the first: nothing of steps before is remembered. */
void imp_pile_begin(imp_pile *pile);

/* One step from time t of all bodies of the world that move, at most `most` long; the states are its end. Loads
 * are asked at (t, states). pile->from is where it began. IMPACT_ENOMEM; IMPACT_EDOMAIN: a load refused;
 * IMPACT_EUNSETTLED, with a message: a cone problem found no answer, however short the step. */
impact_status imp_pile_step(imp_pile *pile, imp_world *world, double t, double most, imp_state *states,
                            imp_pile_step_result *result);

/* Parts what overlaps, to rounding, in states that stand between the ends of a step, or are to rest: least in the
 * metric of mass. What the pile remembers stays. IMPACT_ENOMEM. */
impact_status imp_pile_part(imp_pile *pile, imp_world *world, imp_state *states);

/* Of what comes to rest where the last step ended: closes the gaps that it has left, to their square, too. */
impact_status imp_pile_lay_down(imp_pile *pile, imp_world *world, imp_state *states);

/* Keeps what the pile remembers, to take it back: the next step is then taken from there anew. IMPACT_ENOMEM. */
impact_status imp_pile_keep(imp_pile *pile);
impact_status imp_pile_take_back(imp_pile *pile);

/* The points that the last step held, or that were found touching when all were found to rest. */
static inline const imp_pile_memories *imp_pile_held(const imp_pile *pile) { return &pile->memory[0]; }

/* Whether all bodies of the world that move, being slower than rest_speed (m/s), can stand still where they are: proved
 * by reactions. IMPACT_ENOMEM, and false. */
impact_status imp_pile_rests(imp_pile *pile, imp_world *world, double t, const imp_state *states, double rest_speed,
                             bool *rests);

#endif
