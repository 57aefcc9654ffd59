/* SPDX-License-Identifier: MIT
 *
 * crowd: which bodies of a scene can meet within a while, and which cannot. Those that cannot are moved apart from one
 * another (scene_crowd.c). Internal.
 */
#ifndef IMP_CROWD_H
#define IMP_CROWD_H

#include "world/world.h"

/* What is known of a body's path over the while. */
typedef enum imp_crowd_course {
    IMP_COURSE_STATIC,
    IMP_COURSE_REST,   /* at rest, and nothing that moves comes near */
    IMP_COURSE_FREE,   /* the parabola of its centre, and nothing comes near */
    IMP_COURSE_BOUNDED /* within `allowance` of where its centre is */
} imp_crowd_course;

typedef struct imp_crowd_body {
    imp_crowd_course course;
    double top_speed;       /* IMP_COURSE_BOUNDED: m/s; infinite otherwise */
    double allowance;       /* m */
    double speed, kinetic;  /* of the fastest point, m/s; J */
    double low[3], high[3]; /* the box that its bounding ball stays in */
    int parent;             /* towards the body that stands for its group */
    int group;              /* -1: static */
} imp_crowd_body;

typedef struct imp_crowd {
    imp_arena *arena;
    int body_count;
    imp_crowd_body *bodies;
    int *order; /* of the bodies that are no planes, by the low side of their boxes along x */
    int ordered;
    int *moving_before; /* body_count + 1: how many that move stand before each */
    int *first_pair;    /* of each body, as its pairs are with later ones */
    int *slot;          /* scratch, one for each body */

    int group_count;
    int *member_start, *members; /* of each group, in the order of the definition */
    int *pair_start, *pairs;     /* likewise: the world's pairs that can meet */
    int pair_count, pair_room;
    int meetings; /* pairs of bodies that move among them */
} imp_crowd;

impact_status imp_crowd_open(imp_crowd *crowd, const imp_world *world);
void imp_crowd_close(imp_crowd *crowd);

/* The world's pair of two bodies of which one moves. */
int imp_crowd_pair(const imp_crowd *crowd, const imp_world *world, int i, int j);

/* Divides the bodies into groups that cannot meet within the time. resting: per body; held: of each body, how many
 * contacts are. caution: how many times its group's greatest speed a body is given, unless its group's energy allows
 * less. */
impact_status imp_crowd_divide(imp_crowd *crowd, const imp_world *world, const imp_state *states, const bool *resting,
                               const int *held, double time, double caution);

#endif
