/* SPDX-License-Identifier: MIT
 *
 * lying_steady: the motions of what lies that are closed forms. Where its friction keeps its direction it has constant
 * accelerations:
 *
 *     slides along e    a = (pull - mu P) e, pull along e or none; until the slip or the face it lies on ends
 *     turns on the spot alpha = M/J, the friction of its face alone holding no force; on level ground
 *
 * A line that slides along itself or across rolls ever faster. What stands under loads that change does until they are
 * more than its face holds. Internal.
 */
#ifndef IMP_LYING_STEADY_H
#define IMP_LYING_STEADY_H

#include "motion/lying.h"

/* A motion of constant rates, in the face's units, until so many s from now. */
typedef struct imp_lying_steady {
    double a[2], alpha, roll, until; /* of the centre, about the normal, and about a line */
    bool fades, stands, breaks;      /* it ends in rest; it is none; what holds it ends then */
} imp_lying_steady;

/* How it goes on from lying->start, where that is one; what is slower than `slow`, in the face's units, fades out. */
bool imp_lying_find_steady(const imp_lying *lying, double slow, imp_lying_steady *s);

/* Whether what does not slip rolls, or begins to. */
bool imp_face_rolls(const imp_face_motion *m, const double *y, const imp_face_balance *balance);

#endif
