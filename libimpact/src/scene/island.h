/* SPDX-License-Identifier: MIT
 *
 * island: bodies tied by held contacts or by forces between them, and the static ones they touch, as a world of their
 * own with its clock: what strikes and holds at one instant is settled in it (scene_strike.c, scene_hold.c), and from
 * one instant to the next it moves as its bodies' segments say. What meets at an instant is gathered in one island;
 * what is held in it afterwards stays together, and all else goes its own way (encounter.c). Internal.
 */
#ifndef IMP_ISLAND_H
#define IMP_ISLAND_H

#include "motion/motion.h"
#include "motion/pile.h"
#include "motion/segment.h"

/* kg m/s: the momentum that bodies had before impacts; what static ones gave, as it was booked; the sizes of all its
 * terms; and what of them the receipt has not looked at yet was off by at most. */
typedef struct imp_push {
    qvec3 had, given;
    double size, off;
} imp_push;

/* What is known of a pair at an instant. */
typedef struct imp_note {
    imp_mode mode; /* before it */
    bool struck;   /* it exchanged an impulse */
    bool settled;  /* it had its chance to be held again */
    bool rises;    /* body 1 tips over a side of its face that this point is not on */
} imp_note;

typedef struct imp_island {
    struct impact_scene *scene;
    struct imp_island *next; /* scratch: of a list */
    imp_world world;         /* bodies by their index, their pairs that touch, the forces that act on them */
    imp_motion motion;       /* of this world */
    imp_state *states;       /* at t */
    imp_state *before;       /* as the states were when the event at hand came */
    imp_note *notes;         /* of the pairs */
    imp_push pushed;
    int body_room, pair_room;
    double t;
    imp_end end;        /* what its segments end in */
    double impact_loss; /* J, not given to the scene yet; */
    double loss_before; /* as the receipt saw it last */
    double gained;      /* J: since then, by impacts whose law gave it, and by closing what lands */
    double balance;     /* J: energy + losses - what was given, when its motion began; of steps, of the one at hand */
    double looked_at;   /* s: by the receipt */
    long strides;       /* steps and events of encounters since its patience was asked last */
    bool unanswered;    /* scratch: at this instant the law of encounters has found no answer once */
    bool lies;          /* bodies with faces stay on each other, or no forces hold it: it is to be moved by steps */
    bool stepped;       /* it moves by steps (stepped.h): */
    imp_pile *pile;     /* absent until then */
    double met_since;   /* s: from when on its pairs are marked that touch (imp_pair.met) */
    double outside;     /* J: of all other bodies, for the rows of events */
    int number;         /* among the scene's; -1: of none */
    double glide;       /* tau: how long the next step of a body that glides is to be (gliding.h) */
    bool rests, rolls;  /* no integrator is at work: its bodies' segments say all */
    bool loses;         /* it rolls, and friction takes energy: what there was when its segment began, J */
    double begun_with;
    bool moves;   /* it has segments; false where its next step failed */
    bool leaving; /* scratch: its bodies go over to another */
} imp_island;

/* Room for so many bodies, pairs and the scene's forces; the rest as it was. */
impact_status imp_island_reserve(imp_island *island, int bodies, int pairs);
/* No body, no pair. */
void imp_island_clear(imp_island *island);

/* m/s: slip below it sticks, and one that begins is led up to a multiple of it. */
void imp_island_set_slip_speed(imp_island *island, double speed);

/* Adds the scene's body, by its state; its index in the island. To be added in the order of their indices. Slip that
 * the integrator cannot tell from none at the body's speed is none from there on. */
int imp_island_add_body(imp_island *island, int body, const imp_state *state);
/* The island's index of the scene's body, or -1. */
int imp_island_find(const imp_island *island, int body);
/* The forces that act on its bodies, with the scene's knowledge of who is within their edges; and back. */
impact_status imp_island_take_forces(imp_island *island);
void imp_island_give_forces(imp_island *island);

/* All its bodies' states at t, in a segment that covers it, held contacts put back exactly; parted: and what overlaps
 * between a pile's steps, by less than they err, moved apart: in motion.sampled. */
impact_status imp_island_look(imp_island *island, double t, bool parted);
/* States at island->t, where an integrator brought them, back to what the held contacts allow; no energy is booked:
 * the constraint's force has done as much on the way off as putting back undoes. */
void imp_island_put_back(imp_island *island);
/* Its own clock to t: states, put back, and works. */
void imp_island_go_to(imp_island *island, double t);

/* Its works since they were given to the scene last, as they are at t, J; what impacts took by t, when its bodies'
 * states then are in motion.sampled. */
imp_works imp_island_works(const imp_island *island, double t);
double imp_island_loss(const imp_island *island, double t);

/* Impacts begin; a static body gives an impulse; they have ended: bodies have the momentum that they had and were
 * given.
 */
void imp_island_begin_push(imp_island *island);
void imp_island_push(imp_island *island, qvec3 impulse);
void imp_island_end_push(imp_island *island);

/* Kinetic + potential of its bodies at its clock, J; and with all losses, less all that was given: it stays. */
double imp_island_energy(const imp_island *island);
double imp_island_balance(const imp_island *island);

#endif
