/* SPDX-License-Identifier: MIT
 *
 * collide, inside: how the impulse of an impact follows M, u-, friction and restitution, to first order.
 */
#ifndef IMP_COLLIDE_VARIATION_H
#define IMP_COLLIDE_VARIATION_H

#include "collide/collide_course.h"

/* What the impulse is a function of, in the frame and units of a course. */
typedef enum imp_parameter {
    IMP_BY_XX,
    IMP_BY_YY,
    IMP_BY_ZZ,
    IMP_BY_XY,
    IMP_BY_XZ,
    IMP_BY_YZ,
    IMP_BY_UX,
    IMP_BY_UY,
    IMP_BY_UZ,
    IMP_BY_MU,
    IMP_BY_EPS,
    IMP_PARAMETERS
} imp_parameter;

typedef struct imp_variation {
    imp_real P[3];                  /* the impulse */
    imp_real by[IMP_PARAMETERS][3]; /* its derivatives */
    bool tied;                      /* an event just happens: there are none */
} imp_variation;

/* Along the phases of an outcome (imp_real units: P_z of each phase's end in reached[]). The course is as
 * imp_course_start leaves it, in its principal frame. False: the phases were not followed to their end. */
bool imp_variation_make(const imp_course *start, const unsigned char *phases, const imp_real *reached, int count,
                        imp_variation *variation);

#endif
