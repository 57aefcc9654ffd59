/* SPDX-License-Identifier: MIT
 *
 * cmocka with the includes it wants, and comparisons that say what was wanted, what came, and by how much it is off.
 */
#ifndef NEAR_H
#define NEAR_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <quat/quat.h>

/* A NaN is never near. */
static inline void assert_near(double got, double wanted, double tolerance)
{
    if (fabs(got - wanted) <= tolerance) return;
    fail_msg("wanted %.17g, got %.17g: off by %.3g, allowed %.3g", wanted, got, fabs(got - wanted), tolerance);
}

static inline void assert_near3(qvec3 got, qvec3 wanted, double tolerance)
{
    if (qvec3_norm(qvec3_sub(got, wanted)) <= tolerance) return;
    fail_msg("wanted (%.17g, %.17g, %.17g), got (%.17g, %.17g, %.17g): off by %.3g, allowed %.3g", wanted.x, wanted.y,
             wanted.z, got.x, got.y, got.z, qvec3_norm(qvec3_sub(got, wanted)), tolerance);
}

static inline void assert_at_most(double got, double bound)
{
    if (got <= bound) return;
    fail_msg("got %.17g, allowed at most %.17g", got, bound);
}

#endif
