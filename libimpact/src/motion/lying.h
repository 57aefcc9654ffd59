/* SPDX-License-Identifier: MIT
 *
 * lying: a body of the world that lies with a face on a static one, or with a line about which it is round, as its
 * face's motion (face_motion.h); and back. Internal.
 */
#ifndef IMP_LYING_H
#define IMP_LYING_H

#include "motion/face_motion.h"
#include "motion/motion.h"

typedef struct imp_lying {
    imp_face_motion motion;
    const imp_body *body;
    imp_state level;       /* the body exactly on the face, moving along it alone */
    qvec3 normal, axis[2]; /* axis[0] along its line */
    qvec3 inertia;         /* J n, kg m^2 */
    qvec3 rolled;          /* of a line: I e; 0 of a face */
    double size;           /* m */
    imp_motion *moves;     /* of the loads, from t0 on */
    double t0;
    int index;                    /* the body's */
    double start[IMP_FACE_STATE]; /* y of the level state */
} imp_lying;

/* The pair's body 1 on its static body 2 at t, where both have a face there, or the first such a line, and it is
 * pressed on; false where not: also where the surface moves, turning, or of a line rolling, has friction of its own, or
 * a force cannot be had. lying stays where it is. */
bool imp_lying_find(imp_motion *motion, const imp_pair *pair, double t, const imp_state *states, imp_lying *lying);

static inline bool imp_lies_on_line(const imp_lying *lying) { return lying->motion.rolling > 0; }

/* The body with y. */
imp_state imp_lying_state(const imp_lying *lying, const double *y);
/* The force on it and the place where it acts, from the centre of mass; the moment there, about the normal. */
void imp_lying_force(const imp_lying *lying, const double *y, const imp_face_balance *balance, qvec3 *force, qvec3 *arm,
                     double *moment);

/* Where the path is to end, s in (-1, 0]: at its end, where stride.t_end is, or beyond the first edge of a force. */
double imp_lying_end(const imp_lying *lying, const imp_face_path *path, imp_end *end);
/* How long, in tau, the next step is to be so that the first edge that the path, continued, comes to lies between its
 * last node and its end: no rate is asked for beyond it. Infinite: there is none as far as the next step may go, or the
 * path is of another time. */
double imp_lying_until_edge(const imp_lying *lying, const imp_face_path *path);
/* A path to s as the step of a motion, of an island in which this body alone moves: from motion->stride.t on, which is
 * then at its end. IMPACT_ENOMEM. */
impact_status imp_motion_next_lying(imp_motion *motion, const imp_lying *lying, const imp_face_path *path, double s,
                                    imp_state *states);

#endif
