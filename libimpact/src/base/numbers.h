/* SPDX-License-Identifier: MIT
 *
 * numbers: what every floor asks of them. Internal.
 */
#ifndef IMP_NUMBERS_H
#define IMP_NUMBERS_H

#include <math.h>
#include <stdbool.h>
#include <quat/quat.h>

#define IMP_PI 3.14159265358979323846

/* The worse of two residuals: one that is no number is worse than any, and remains. */
static inline double imp_worse(double worst, double part) { return isnan(worst) || part <= worst ? worst : part; }

static inline bool imp_all_finite(qvec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

#endif
