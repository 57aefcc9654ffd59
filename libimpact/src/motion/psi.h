/* SPDX-License-Identifier: MIT
 *
 * psi: the concave lower bound of a gap from which bodies take a step that no contact is in; search.c says where its
 * terms come from. Internal.
 */
#ifndef IMP_PSI_H
#define IMP_PSI_H

#include "world/world.h"

/* One turning body's part of it: m and its derivatives now. */
typedef struct imp_turning {
    const imp_body *body;
    qvec3 m, rate, second;
    double h;
} imp_turning;

typedef struct imp_psi {
    double gap, slope; /* psi and its derivative at 0 */
    double speed;      /* n.v */
    double bend, jerk; /* of -T^2/2, without what turns, and of -T^3/6 */
    double spread;     /* no less than the turning's part of the bend, either way */
    imp_turning body[2];
    int count;
} imp_psi;

/* The largest T up to the limit, or next to it, for which psi is known to be >= 0 all the way. */
double imp_psi_safe_step(const imp_psi *p, double limit);

#endif
