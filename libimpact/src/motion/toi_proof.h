/* SPDX-License-Identifier: MIT
 *
 * toi_proof (internal): two moving bodies at one time, and proofs that there is no contact from one time to another.
 */
#ifndef IMP_TOI_PROOF_H
#define IMP_TOI_PROOF_H

#include "gap/gap_solver.h"

/* The question: what does not change on the way. */
typedef struct imp_chase {
    imp_gap_course course;
    bool plane[2];
    qvec3 omega[2]; /* of the bodies whose turning shows */
    double radius[2], length;
    qvec3 acceleration; /* of body 1 relative to body 2 */
    double turning;     /* the faster spin */
} imp_chase;

/* One time and what is known of it. */
typedef struct imp_instant {
    double t, gap, rate, tolerance; /* gap: the bracket's lower end */
    impact_solid body[2];
    imp_form form[2]; /* of the bodies but planes, in their own lengths */
    qvec3 c, v;       /* of body 1's position relative to body 2's */
    impact_contact contact;
    bool sketched; /* the contact holds but the bodies' supports along a normal that parts them */
} imp_instant;

/* The centres, or all of the bodies, at a time; exact: as impact_motion_at has them, to the last digit. */
void imp_instant_centres(const imp_chase *q, double t, imp_instant *at);
void imp_instant_place(const imp_chase *q, double t, bool exact, imp_instant *at);

/* Takes the supports along the unit n for the contact; false when they do not part the bodies, which are placed and no
 * planes. */
bool imp_instant_sketch(const imp_chase *q, qvec3 n, imp_instant *at);

/* Whether there is provably no contact between two instants without one. */
bool imp_toi_link(const imp_chase *q, const imp_instant *from, const imp_instant *to);

/* The steady turn that takes the unit n0 to n1 in the time T; they are less than a right angle apart. */
qvec3 imp_toi_turn(qvec3 n0, qvec3 n1, double T);

/* A step from an instant, at most limit, in which there is provably no contact: along its normal, which may turn
 * (trend: as it did before, rad/s), or for far bodies along a unit n with their bounding balls. */
double imp_toi_safe_step(const imp_chase *q, const imp_instant *at, qvec3 trend, double limit);
double imp_toi_ball_step(const imp_chase *q, const imp_instant *at, qvec3 n);

/* The receipt of a contact at an instant later than 0, the bodies placed there and the gap found: it is 0 to rounding,
 * and the bodies do not overlap a millionth of their length earlier. It knows nothing of how the search went: where a
 * step passed the contact, or two roots, it fails. */
bool imp_toi_holds(const imp_chase *q, const imp_instant *at);

#endif
