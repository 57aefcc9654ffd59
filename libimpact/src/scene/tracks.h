/* SPDX-License-Identifier: MIT
 *
 * tracks: where every body of a scene is going, and whom it may meet. Each body has its segment, and a fat box that
 * holds it for a while; two bodies are a pair only while their boxes overlap, and a pair's next contact is a function
 * of the two segments alone (motion/search.h): boxes decide when it is asked for, never what it is. Internal.
 */
#ifndef IMP_TRACKS_H
#define IMP_TRACKS_H

#include "motion/search.h"
#include "scene/queue.h"
#include "world/grid.h"

/* Two bodies whose boxes overlap, of which one moves; a moving one first, a plane last. */
typedef struct imp_near {
    int body[2];
    int place[2]; /* in each body's list */
    double t;     /* of the next contact, or of where the search for it goes on */
    bool touches; /* which of the two */
    bool beyond;  /* the first is behind a plane, beside its bounds */
    bool held;    /* an island's: nothing is searched for */
    qvec3 axis;   /* search.h */
} imp_near;

/* What a body's motion has asked for without getting on (stepped.c), and since when, s. */
typedef struct imp_patience {
    double since;
    long work;
} imp_patience;

/* A body's pair, and its other one. */
typedef struct imp_companion {
    int near, other;
} imp_companion;

/* What the pairs' other bodies ask stands side by side at the front. */
typedef struct imp_track {
    double leave;   /* when it leaves its box */
    double meet;    /* the first of its pairs' times */
    int first_near; /* that pair, or -1 */
    imp_companion *companions;
    int companion_count, companion_room;
    imp_segment segment;
    impact_tumble *tumble; /* room, for a body of unequal moments */
    int island;            /* or -1: alone */
    bool resting;          /* it has come to rest */
    bool told;             /* it rests, and has had its row since */
    long round;            /* of looking ahead: its last */
    int stalls;            /* events at the time of the last one, and that: */
    double last_event;
    imp_patience patience; /* it stays with the body, whichever islands it is in and whether it flies between them */
    double fatness;        /* of its box: the part of its radius that it goes before the box is made anew */
} imp_track;

/* A body without a box: the plane n . x = d. */
typedef struct imp_wide {
    int body;
    double n[3], d;
} imp_wide;

typedef struct imp_tracks {
    imp_world *world; /* bodies, gravity, slip_speed, usage */
    imp_track *tracks;
    int *paired_with; /* per body, scratch: one known to be its pair's other, or -1 */
    imp_near *near;
    int near_count, near_room, near_free; /* near_free: first of a list through place[0], or -1 */
    imp_grid grid;
    imp_wide *planes;
    int plane_count;
    imp_queue *queue; /* slot first_slot + i is body i's */
    int first_slot;
    long round; /* of looking ahead */
} imp_tracks;

impact_status imp_tracks_open(imp_tracks *tracks, imp_world *world, imp_queue *queue);

/* Every body's first segment; then all boxes and pairs. */
impact_status imp_tracks_begin(imp_tracks *tracks, double t, const imp_state *states);

/* Nobody has a box or a pair. */
void imp_tracks_clear(imp_tracks *tracks);
/* Everybody's box by his segment from t on, and all pairs, where there are none. */
impact_status imp_tracks_renew(imp_tracks *tracks, double t);

/* The body goes on by this segment from the time t: after all that change at t have been told so, a look ahead begins
 * and is made for each; a pair of two of them is searched for once. */
impact_status imp_tracks_follow(imp_tracks *tracks, int body, const imp_segment *segment, double t);
void imp_tracks_begin_look(imp_tracks *tracks);
void imp_tracks_look_ahead(imp_tracks *tracks, int body, double t);

/* The body stands elsewhere than a moment ago, by its segment at t: its pairs are made anew. */
impact_status imp_tracks_leap(imp_tracks *tracks, int body, double t);

/* At the body's time in the queue: what is due there. A pair that touches is returned, -1 for none; the rest is done.
 */
impact_status imp_tracks_due(imp_tracks *tracks, int body, double t, int *touching);

/* The pair's next contact is searched for anew. */
void imp_tracks_predict(imp_tracks *tracks, int near, double t);

/* The pair of two bodies, or -1. */
int imp_tracks_find(const imp_tracks *tracks, int i, int j);

#endif
