/* SPDX-License-Identifier: MIT
 *
 * pile_contacts: where the bodies of a pile touch, and what is remembered of it from step to step. Internal.
 */
#ifndef IMP_PILE_CONTACTS_H
#define IMP_PILE_CONTACTS_H

#include "contact/cone_assemble.h"
#include "contact/points.h"

/* A point at which two bodies touch. */
typedef struct imp_pile_point {
    int pair;
    impact_feature feature[2];
    imp_bearer bearer;
    imp_cone_contact contact;
    double gap;      /* m */
    double nearer;   /* how much nearer to the centre of pressure its friction acts, of the way; 0: not */
    bool slides;     /* its face does: then */
    qvec3 aside;     /* how far beside that, m, and */
    double strength; /* how many times as strong; else 0 and 1 */
    int memory;      /* the number of what is remembered of it, imp_pile_recall; -1: nothing */
    bool taken;      /* scratch: it is an island's */
    bool parts;      /* scratch: it is to be parted */
} imp_pile_point;

/* What a step held there; world axes. */
typedef struct imp_pile_memory {
    int pair;
    impact_feature feature[2];
    double gap; /* m */
    qvec3 arm1, arm2, rub, normal;
    qvec3 reaction, velocity; /* N (impulse over h), m/s */
    qvec3 moment, turning;    /* N m, 1/s: of pairs that resist turning */
    bool taken;               /* scratch: it is a point's */
} imp_pile_memory;

typedef struct imp_pile_memories {
    imp_pile_memory *list;
    int count, room;
} imp_pile_memories;

typedef struct imp_pile_contacts {
    imp_arena *arena;
    int bodies, pairs; /* there is room for */
    imp_pile_point *points;
    int count, room;
    int *root;  /* per body: bodies that points tie have the same */
    bool *held; /* per pair: remembered */
} imp_pile_contacts;

bool imp_pile_contacts_reserve(imp_pile_contacts *contacts, const imp_world *world);

/* The pairs that the memory names. */
void imp_pile_contacts_mark(imp_pile_contacts *contacts, const imp_world *world, const imp_pile_memories *memories);

/* All points whose gap is at most the slack, or, of the pairs marked as held, that close within half of the step h at
 * the velocities `next` (NULL: none; with what bodies overlap most at). Pressed by the loads, what rolls over a round
 * body leaves it by h² in every step: it is held, not dropped and caught. held_only: of the marked pairs alone, all
 * points that come as near as that. False: there is no room. */
bool imp_pile_find_points(imp_pile_contacts *contacts, imp_world *world, const imp_state *states, const imp_state *next,
                          double h, double slack, bool held_only);

/* The island of the first point that is in none yet: the points' numbers into `members` (count), which are taken then.
 * How many; 0: all are taken. */
int imp_pile_take_island(imp_pile_contacts *contacts, const imp_world *world, int *members);

/* Finds what is remembered of each point, those that are each other's nearest first, as of a rim's sixteen points, all
 * of the same features, some open and close: of its pair what has its features; else what was where it is, as far as
 * points of the pair move in h at the velocities of the states: on a border a point has the features of one side or the
 * other, and is held whichever. */
void imp_pile_recall(imp_pile_contacts *contacts, const imp_world *world, const imp_state *states, double h,
                     imp_pile_memories *memories);

/* Where the friction of each pair's points acts, and how strong it is, by the pressures that are remembered, or of an
 * even one, and the slip of the states; without (NULL), and of faces that slide slower than the least, m/s, as at rest.
 */
void imp_pile_place_friction(imp_pile_contacts *contacts, const imp_world *world, const imp_pile_memories *memories,
                             const imp_state *states, double least);

/* The same by pressures r, each contact's first of width numbers: of those points (count members, copied to own).
 * False: they are where it acts. */
bool imp_pile_shift_friction(imp_pile_contacts *contacts, const int *members, int count, const double *r, int width,
                             imp_cone_contact *own);

/* One more; NULL: there is no room. */
imp_pile_memory *imp_pile_remember(imp_arena *arena, imp_pile_memories *memories, const imp_pile_point *point);
bool imp_pile_copy_memories(imp_arena *arena, imp_pile_memories *to, const imp_pile_memories *from);

#endif
